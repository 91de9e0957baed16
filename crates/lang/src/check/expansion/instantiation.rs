//! Instantiation: before the check, each part becomes an instance of its mechanism, with expanded repetitions. Equal instances of one text
//! are shared.

use super::instance::Instance;
use super::repetition::{Expander, MOST, Numbers, broken, named, needs_expansion};
use crate::check::errors;
use crate::check::formulas::{BoundParam, Formulas};
use crate::check::library::{Library, LookupError};
use crate::check::options::CheckOptions;
use crate::check::scope::{indices, name_of, visit_free_names};
use mechc_syntax::ast::{self, Expr, Item, ItemKind, Mechanism, MechanismName};
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::hash_map::Entry;
use std::rc::Rc;

/// The largest depth of parts in parts.
const DEEPEST: usize = 32;

/// Returns the instance of a mechanism that is checked on its own, and the diagnostics of its ranges and parts.
pub(in crate::check) fn instance_of<'t>(
    tree: &'t Mechanism,
    options: &'t CheckOptions,
    sources: &Sources,
) -> (Rc<Instance<'t>>, Diagnostics) {
    let mut instantiation = Instantiation {
        library: &options.library,
        options,
        sources,
        outlines: FxHashMap::default(),
        instances: FxHashMap::default(),
        around: Vec::new(),
        diagnostics: Diagnostics::default(),
        is_too_large: false,
    };
    let deciding = instantiation.deciding(tree);
    let bound: Vec<(String, f64)> = options.bound.iter().filter(|(name, _)| deciding.contains(name)).cloned().collect();
    let instance = instantiation.instance(tree, "", &bound);
    (instance, instantiation.diagnostics)
}

/// The text of a mechanism, and the bound values that determine its ranges.
type Key = (*const Mechanism, Vec<(String, u64)>);

/// The properties of a mechanism that do not depend on the values of its params.
#[derive(Clone, Default)]
struct RepetitionOutline {
    /// The params that determine repetitions.
    deciding: Rc<FxHashSet<String>>,
    /// The least number of declarations after expansion.
    fewest: usize,
}

struct Instantiation<'t, 's> {
    library: &'t Library,
    options: &'s CheckOptions,
    sources: &'s Sources,
    /// The outlines, by the text of a mechanism.
    outlines: FxHashMap<*const Mechanism, RepetitionOutline>,
    /// The instances that have been made.
    instances: FxHashMap<Key, Rc<Instance<'t>>>,
    /// The mechanisms around the current one, the outermost first.
    around: Vec<&'t Mechanism>,
    diagnostics: Diagnostics,
    /// True if the excess of declarations has been reported.
    is_too_large: bool,
}

impl<'t> Instantiation<'t, '_> {
    /// Returns the instance of a mechanism with bound values of the params that determine its ranges.
    fn instance(&mut self, tree: &'t Mechanism, path: &str, bound: &[(String, f64)]) -> Rc<Instance<'t>> {
        if !needs_expansion(tree) {
            return Rc::new(Instance::plain(tree));
        }
        // Overrides may differ between paths.
        let key = (std::ptr::from_ref(tree), bound.iter().map(|(name, x)| (name.clone(), x.to_bits())).collect());
        let is_shared = self.options.settings.is_empty();
        if is_shared && let Some(instance) = self.instances.get(&key) {
            return Rc::clone(instance);
        }
        self.around.push(tree);
        let instance = Rc::new(self.written_out(tree, path, bound));
        self.around.pop();
        if is_shared {
            self.instances.insert(key, Rc::clone(&instance));
        }
        instance
    }

    fn written_out(&mut self, tree: &'t Mechanism, path: &str, bound: &[(String, f64)]) -> Instance<'t> {
        let deciding = self.deciding(tree);
        let definitions = definitions_of(tree);
        let mut formulas = Formulas::new(&definitions, self.options, self.sources);
        path.clone_into(&mut formulas.scope.path);
        formulas.bound.params = bound
            .iter()
            .map(|(name, value)| BoundParam { name, bound: formulas.number_bound(*value), span: None })
            .collect();
        formulas.scope.collect(&mut formulas.reporter);
        formulas.definitions();
        // The whole mechanism is reported with the same diagnostics.
        formulas.reporter.diagnostics = Diagnostics::default();
        let mut writer = Expander::new(tree, formulas);
        let copies = writer.all_copies(tree);
        self.is_too_large |= writer.is_too_large();
        let (mut by_name, mut count) = (FxHashMap::default(), writer.count());
        for (item, copies) in tree.items.iter().zip(&copies) {
            let (ItemKind::Part(part), Some(copies)) = (&item.kind, copies) else { continue };
            let mechanism = self.mechanism_of(part);
            let fewest = mechanism.map_or(0, |mechanism| self.outline(mechanism).fewest);
            for numbers in copies {
                // Checked before it is expanded.
                self.must_be_small_enough(count.saturating_add(fewest), part);
                if self.is_too_large {
                    self.diagnostics.extend(writer.into_diagnostics());
                    return too_large(tree, item, deciding);
                }
                let instance = mechanism.and_then(|mechanism| self.part(mechanism, part, path, numbers, &mut writer));
                count += instance.as_ref().map_or(0, |instance| instance.count);
                self.must_be_small_enough(count, part);
                if self.is_too_large {
                    self.diagnostics.extend(writer.into_diagnostics());
                    return too_large(tree, item, deciding);
                }
                by_name.insert(named(&part.name, numbers).text, instance);
            }
        }
        let ((found, reported), copies, paths) = writer.written(tree, &copies, by_name.clone());
        self.diagnostics.extend(reported);
        let (mut parts, mut part_named) = (Vec::new(), FxHashMap::default());
        for item in &found.items {
            let ItemKind::Part(part) = &item.kind else { continue };
            if let Some(Some(instance)) = by_name.remove(&part.name.text) {
                part_named.insert(part.name.text.clone(), parts.len());
                parts.push(instance);
            }
        }
        Instance { mechanism: tree, written: Some(found), parts, part_named, paths, deciding, copies, count }
    }

    fn find(&self, name: &MechanismName) -> Result<&'t Mechanism, LookupError> {
        let found = self.library.find(name.prefix.as_ref(), &name.name, self.sources)?;
        Ok(self.library.tree(found))
    }

    /// Returns the mechanism of a part, unless that contains itself or is too deep.
    fn mechanism_of(&mut self, part: &'t ast::Part) -> Option<&'t Mechanism> {
        let mechanism = match self.find(&part.mechanism) {
            Ok(mechanism) => mechanism,
            Err(LookupError::Said) => return None,
            Err(LookupError::Told(why)) => {
                self.diagnostics.push(*why);
                return None;
            }
        };
        if let Some(first) = self.around.iter().position(|around| around.name.span == mechanism.name.span) {
            let circle: Vec<&str> = self.around[first..].iter().map(|around| around.name.text.as_str()).collect();
            self.diagnostics.push(errors::contains_itself(&part.mechanism, &circle));
            return None;
        }
        if self.around.len() > DEEPEST {
            self.diagnostics.push(errors::too_many_levels(&part.mechanism, DEEPEST));
            return None;
        }
        Some(mechanism)
    }

    fn part(
        &mut self,
        mechanism: &'t Mechanism,
        part: &'t ast::Part,
        path: &str,
        numbers: &Numbers<'t>,
        writer: &mut Expander<'t, '_>,
    ) -> Option<Rc<Instance<'t>>> {
        let deciding = self.deciding(mechanism);
        let mut bound = Vec::new();
        for binding in part.bindings.iter().filter(|binding| deciding.contains(&binding.name.text)) {
            bound.push((binding.name.text.clone(), writer.number(&binding.value, numbers)?));
        }
        let name = named(&part.name, numbers).text;
        let before = self.diagnostics.len();
        let instance = self.instance(mechanism, &format!("{path}{name}."), &bound);
        self.diagnostics.annotate_part(before, &format!("{path}{name}"), part.name.span);
        Some(instance)
    }

    fn must_be_small_enough(&mut self, count: usize, part: &ast::Part) {
        if count > MOST && !self.is_too_large {
            self.is_too_large = true;
            let label = format!("with this part there are {count} or more");
            self.diagnostics.push(errors::too_many_declarations(part.name.span, MOST, &label));
        }
    }

    /// Returns the params on which ranges and indices depend in a mechanism and its parts, also through other params and functions.
    fn deciding(&mut self, tree: &'t Mechanism) -> Rc<FxHashSet<String>> {
        self.outline(tree).deciding
    }

    /// Returns the outline of a mechanism. Iterative, as the depth of parts is only limited elsewhere.
    fn outline(&mut self, tree: &'t Mechanism) -> RepetitionOutline {
        let mut open = vec![(tree, false)];
        while let Some((tree, are_parts_visited)) = open.pop() {
            let key = std::ptr::from_ref(tree);
            if are_parts_visited {
                let outline = self.outline_with_parts(tree);
                self.outlines.insert(key, outline);
            } else if let Entry::Vacant(unknown) = self.outlines.entry(key) {
                // The value on a cycle of mechanisms, which is reported elsewhere.
                unknown.insert(RepetitionOutline::default());
                open.push((tree, true));
                open.extend(parts_of(tree).filter_map(|part| Some((self.find(&part.mechanism).ok()?, false))));
            }
        }
        self.outlines.get(&std::ptr::from_ref(tree)).cloned().unwrap_or_default()
    }

    fn outline_with_parts(&self, tree: &'t Mechanism) -> RepetitionOutline {
        let mut open: Vec<&'t Expr> = Vec::new();
        let mut fewest = tree.items.iter().filter(|item| item.ranges.is_empty()).count();
        if needs_expansion(tree) {
            let ranges = tree.items.iter().flat_map(|item| &item.ranges);
            open.extend(ranges.flat_map(|range| [&range.from, &range.to]));
            open.extend(tree.items.iter().flat_map(Item::formulas).flat_map(indices));
        }
        for item in &tree.items {
            let ItemKind::Part(part) = &item.kind else { continue };
            let Ok(mechanism) = self.find(&part.mechanism) else { continue };
            let Some(inside) = self.outlines.get(&std::ptr::from_ref(mechanism)) else { continue };
            let bindings = part.bindings.iter().filter(|binding| inside.deciding.contains(&binding.name.text));
            open.extend(bindings.map(|binding| &binding.value));
            if item.ranges.is_empty() {
                fewest = fewest.saturating_add(inside.fewest);
            }
        }
        RepetitionOutline { deciding: Rc::new(needed_by(tree, open)), fewest }
    }
}

/// Returns the declarations of parts in a mechanism.
fn parts_of(tree: &Mechanism) -> impl Iterator<Item = &ast::Part> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Part(part) => Some(&**part),
        _ => None,
    })
}

/// Returns a mechanism that is not examined any further, because of one of its parts.
fn too_large<'t>(tree: &'t Mechanism, part: &Item, deciding: Rc<FxHashSet<String>>) -> Instance<'t> {
    let items = vec![broken(part, &Vec::new())];
    let written = Mechanism { items, docs: Vec::new(), name: tree.name.clone(), span: tree.span };
    Instance { written: Some(written), deciding, ..Instance::plain(tree) }
}

/// Returns the names that formulas use, directly or through other definitions.
fn needed_by<'t>(tree: &'t Mechanism, mut open: Vec<&'t Expr>) -> FxHashSet<String> {
    let mut needed = FxHashSet::default();
    while let Some(e) = open.pop() {
        visit_free_names(
            e,
            |_| false,
            |name, _| {
                if needed.insert(name.text.clone()) {
                    let is_it = |item: &&Item| name_of(item).is_some_and(|other| other.text == name.text);
                    open.extend(tree.items.iter().filter(is_it).flat_map(Item::formulas));
                }
            },
        );
    }
    needed
}

/// Returns a mechanism with the declarations that ranges may use.
pub(in crate::check) fn definitions_of(tree: &Mechanism) -> Mechanism {
    let is_definition =
        |item: &&Item| matches!(item.kind, ItemKind::Param { .. } | ItemKind::Function { .. } | ItemKind::Table { .. });
    let items = tree.items.iter().filter(is_definition).cloned().collect();
    Mechanism { items, docs: Vec::new(), name: tree.name.clone(), span: tree.span }
}
