//! A mechanism and all that its parts bring along, before anything of it is checked: each part is an instance of a mechanism, with what
//! is repeated in it written out. Instances of one text that come out the same are one.

use super::bindings::BoundParam;
use super::errors;
use super::instance::Instance;
use super::library::{Library, NotKnown};
use super::mentions::{formulas, indices, mentioned, name_of};
use super::repetition::{MOST, Numbers, Writer, named, needs_writing};
use super::{Checker, Surroundings};
use crate::diag::Diagnostics;
use crate::source::Sources;
use crate::syntax::ast::{self, Expr, Item, ItemKind, Mechanism, MechanismName};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// Levels of parts within parts.
const DEEPEST: usize = 32;

/// The instance of a mechanism that stands alone, and what is wrong with its ranges and parts.
pub(super) fn instance_of<'t>(
    tree: &'t Mechanism,
    surroundings: &'t Surroundings,
    sources: &Sources,
) -> (Rc<Instance<'t>>, Diagnostics) {
    let mut builder = Builder {
        library: &surroundings.library,
        surroundings,
        sources,
        deciding: FxHashMap::default(),
        known: FxHashMap::default(),
        around: Vec::new(),
        diagnostics: Diagnostics::default(),
        is_too_large: false,
    };
    let deciding = builder.deciding(tree);
    let bound: Vec<(String, f64)> =
        surroundings.bound.iter().filter(|(name, _)| deciding.contains(name)).cloned().collect();
    let instance = builder.instance(tree, "", &bound);
    (instance, builder.diagnostics)
}

/// The text of a mechanism, and what is bound of what decides its ranges.
type Key = (*const Mechanism, Vec<(String, u64)>);

struct Builder<'t, 's> {
    library: &'t Library,
    surroundings: &'s Surroundings,
    sources: &'s Sources,
    /// By the text of a mechanism.
    deciding: FxHashMap<*const Mechanism, Rc<FxHashSet<String>>>,
    /// By the text of a mechanism, and what is bound of what decides its ranges.
    known: FxHashMap<Key, Rc<Instance<'t>>>,
    /// The mechanisms around the one at hand, the outermost first.
    around: Vec<&'t Mechanism>,
    diagnostics: Diagnostics,
    /// Which has been said.
    is_too_large: bool,
}

impl<'t> Builder<'t, '_> {
    /// With what is bound of the params that decide its ranges.
    fn instance(&mut self, tree: &'t Mechanism, path: &str, bound: &[(String, f64)]) -> Rc<Instance<'t>> {
        if !needs_writing(tree) {
            return Rc::new(Instance::plain(tree));
        }
        // what is set from outside may be another thing for every path
        let key = (std::ptr::from_ref(tree), bound.iter().map(|(name, x)| (name.clone(), x.to_bits())).collect());
        let is_shared = self.surroundings.settings.is_empty();
        if is_shared && let Some(known) = self.known.get(&key) {
            return Rc::clone(known);
        }
        self.around.push(tree);
        let instance = Rc::new(self.written_out(tree, path, bound));
        self.around.pop();
        if is_shared {
            self.known.insert(key, Rc::clone(&instance));
        }
        instance
    }

    fn written_out(&mut self, tree: &'t Mechanism, path: &str, bound: &[(String, f64)]) -> Instance<'t> {
        let deciding = self.deciding(tree);
        let definitions = definitions_of(tree);
        let mut checker = Checker::new(&definitions, self.surroundings, self.sources);
        path.clone_into(&mut checker.path);
        checker.bound_params = bound
            .iter()
            .map(|(name, value)| BoundParam { name, bound: checker.number_bound(*value), span: None })
            .collect();
        checker.collect(&definitions);
        checker.definitions();
        // the same is told of the whole
        checker.diagnostics = Diagnostics::default();
        let mut writer = Writer::new(tree, checker);
        let copies = writer.all_copies(tree);
        self.is_too_large |= writer.is_too_large();
        let (mut by_name, mut count) = (FxHashMap::default(), writer.count());
        for (item, copies) in tree.items.iter().zip(&copies) {
            let (ItemKind::Part(part), Some(copies)) = (&item.kind, copies) else { continue };
            let mechanism = self.mechanism_of(part);
            for numbers in copies {
                let instance = mechanism
                    .filter(|_| !self.is_too_large)
                    .and_then(|mechanism| self.part(mechanism, part, path, numbers, &mut writer));
                count += instance.as_ref().map_or(0, |instance| instance.count);
                let instance = instance.filter(|_| self.is_small_enough(count, part));
                by_name.insert(named(&part.name, numbers).text, instance);
            }
        }
        if self.is_too_large {
            // what cannot be is not looked at any further
            for instance in by_name.values_mut() {
                *instance = None;
            }
        }
        let ((found, said), copies, paths) = writer.written(tree, &copies, by_name.clone());
        self.diagnostics.extend(said);
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

    fn find(&self, name: &MechanismName) -> Result<&'t Mechanism, NotKnown> {
        let found = self.library.find(name.prefix.as_ref(), &name.name, self.sources)?;
        Ok(self.library.tree(found))
    }

    /// The mechanism that a part is, unless that contains itself or is too deep.
    fn mechanism_of(&mut self, part: &'t ast::Part) -> Option<&'t Mechanism> {
        let mechanism = match self.find(&part.mechanism) {
            Ok(mechanism) => mechanism,
            Err(NotKnown::Said) => return None,
            Err(NotKnown::Told(why)) => {
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
        writer: &mut Writer<'t, '_>,
    ) -> Option<Rc<Instance<'t>>> {
        let deciding = self.deciding(mechanism);
        let mut bound = Vec::new();
        for binding in part.bindings.iter().filter(|binding| deciding.contains(&binding.name.text)) {
            bound.push((binding.name.text.clone(), writer.number(&binding.value, numbers)?));
        }
        let name = named(&part.name, numbers).text;
        let told = self.diagnostics.len();
        let instance = self.instance(mechanism, &format!("{path}{name}."), &bound);
        self.diagnostics.label_from(told, part.name.span, &errors::in_part(&format!("{path}{name}")));
        Some(instance)
    }

    fn is_small_enough(&mut self, count: usize, part: &ast::Part) -> bool {
        if count > MOST && !self.is_too_large {
            self.is_too_large = true;
            self.diagnostics.push(errors::too_many_declarations(part.name.span, MOST));
        }
        !self.is_too_large
    }

    /// The params that the bounds of ranges and the numbers of copies are made of, in a mechanism and in its parts, through other params
    /// and functions too.
    fn deciding(&mut self, tree: &'t Mechanism) -> Rc<FxHashSet<String>> {
        let key = std::ptr::from_ref(tree);
        if let Some(known) = self.deciding.get(&key) {
            return Rc::clone(known);
        }
        // in a circle of mechanisms, which is told elsewhere
        self.deciding.insert(key, Rc::default());
        let mut open: Vec<&'t Expr> = Vec::new();
        if needs_writing(tree) {
            let ranges = tree.items.iter().flat_map(|item| &item.ranges);
            open.extend(ranges.flat_map(|range| [&range.from, &range.to]));
            open.extend(tree.items.iter().flat_map(formulas).flat_map(indices));
            for item in &tree.items {
                let ItemKind::Part(part) = &item.kind else { continue };
                let Ok(mechanism) = self.find(&part.mechanism) else { continue };
                let inside = self.deciding(mechanism);
                let bindings = part.bindings.iter().filter(|binding| inside.contains(&binding.name.text));
                open.extend(bindings.map(|binding| &binding.value));
            }
        }
        let deciding = Rc::new(needed_by(tree, open));
        self.deciding.insert(key, Rc::clone(&deciding));
        deciding
    }
}

/// The names that formulas mention, those that the formulas of these mention, and so on.
fn needed_by<'t>(tree: &'t Mechanism, mut open: Vec<&'t Expr>) -> FxHashSet<String> {
    let mut needed = FxHashSet::default();
    while let Some(e) = open.pop() {
        mentioned(
            e,
            |_| false,
            |name, _| {
                if needed.insert(name.text.clone()) {
                    let is_it = |item: &&Item| name_of(item).is_some_and(|other| other.text == name.text);
                    open.extend(tree.items.iter().filter(is_it).flat_map(formulas));
                }
            },
        );
    }
    needed
}

/// What the bounds of ranges may speak of.
fn definitions_of(tree: &Mechanism) -> Mechanism {
    let is_definition =
        |item: &&Item| matches!(item.kind, ItemKind::Param { .. } | ItemKind::Function { .. } | ItemKind::Table { .. });
    let items = tree.items.iter().filter(is_definition).cloned().collect();
    Mechanism { items, docs: Vec::new(), name: tree.name.clone(), span: tree.span }
}
