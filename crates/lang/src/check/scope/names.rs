//! The names of a mechanism: declarations, duplicates, and cycles of definitions.

use super::Scope;
use super::entity::Entity;
use super::free_names::{uses_in, uses_of_argument};
use crate::check::errors::{self, Reporter};
use mechc_syntax::ast::{Expr, ExprKind, FeatureKind, ItemKind, Mechanism, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, Dimension, SubstituteKind, Unit, gives_way, is_called, substitute_name};
use rustc_hash::{FxHashMap, FxHashSet};

/// The number of named declarations of each kind.
#[derive(Clone, Copy, Default, Debug)]
pub(in crate::check) struct Count {
    pub params: usize,
    pub functions: usize,
    pub tables: usize,
    pub inputs: usize,
    pub bodies: usize,
    pub joints: usize,
    pub equations: usize,
    pub measures: usize,
    pub results: usize,
    pub parts: usize,
}

/// The name may be that of a broken declaration, which has been reported.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) struct BrokenName;

/// A name space.
#[derive(Clone, Debug)]
pub(in crate::check) struct Space<T> {
    entries: FxHashMap<String, (T, Span)>,
    order: Vec<String>,
    /// True if it holds a declaration whose name could not be parsed.
    is_incomplete: bool,
}

/// Definitions by their positions.
pub(in crate::check) struct DefinitionOrder {
    /// All definitions, each after those that it uses.
    pub order: Vec<usize>,
    /// Definitions that depend on themselves, also indirectly.
    pub on_cycles: Vec<usize>,
}

impl<T: Copy> Space<T> {
    pub fn new() -> Space<T> {
        Space { entries: FxHashMap::default(), order: Vec::new(), is_incomplete: false }
    }

    /// Declares a name; `Err` with the location of the first declaration of a duplicate.
    pub fn declare(&mut self, name: &Name, entity: T) -> Result<(), Span> {
        if let Some(&(_, first)) = self.entries.get(&name.text) {
            return Err(first);
        }
        self.entries.insert(name.text.clone(), (entity, name.span));
        self.order.push(name.text.clone());
        Ok(())
    }

    /// Records a declaration whose name could not be parsed.
    pub fn declare_nameless(&mut self) {
        self.is_incomplete = true;
    }

    /// Returns whether an undeclared name may be one that could not be parsed.
    pub fn is_incomplete(&self) -> bool {
        self.is_incomplete
    }

    /// Replaces the entity of a declared name.
    pub fn replace(&mut self, name: &str, entity: T) {
        if let Some(entry) = self.entries.get_mut(name) {
            entry.0 = entity;
        }
    }

    /// Returns the entity of a name, if it is declared.
    pub fn get(&self, name: &str) -> Option<T> {
        self.entries.get(name).map(|&(entity, _)| entity)
    }

    pub fn span(&self, name: &str) -> Option<Span> {
        self.entries.get(name).map(|&(_, span)| span)
    }

    /// Returns the names to suggest from; none after many errors, when the search would take long.
    pub fn suggestions(&self, reporter: &Reporter<'_>, expected: impl Fn(T) -> bool) -> Vec<&str> {
        if reporter.suggests_names() { self.names(expected).collect() } else { Vec::new() }
    }

    /// Returns the names of the entities that `expected` accepts, in order of declaration.
    pub fn names(&self, expected: impl Fn(T) -> bool) -> impl Iterator<Item = &str> {
        self.order.iter().filter(move |name| self.get(name).is_some_and(&expected)).map(String::as_str)
    }
}

impl Scope<'_> {
    /// Declares the names of the mechanism. A duplicate keeps its first meaning.
    pub fn collect(&mut self, reporter: &mut Reporter<'_>) {
        let mechanism = self.tree;
        let mut count = Count::default();
        let next = |count: &mut usize| {
            *count += 1;
            *count - 1
        };
        for item in &mechanism.items {
            let (name, entity) = match &item.kind {
                ItemKind::Param { name, .. } => (name, Entity::Param(next(&mut count.params))),
                ItemKind::Function { name, .. } => (name, Entity::Function(next(&mut count.functions))),
                ItemKind::Table { name, .. } => (name, Entity::Table(next(&mut count.tables))),
                ItemKind::Input { name, .. } => (name, Entity::Input(next(&mut count.inputs))),
                ItemKind::Body { name, .. } => (name, Entity::Body(next(&mut count.bodies))),
                ItemKind::Joint { name, .. } => (name, Entity::Joint(next(&mut count.joints))),
                ItemKind::Equation { name, .. } => (name, Entity::Equation(next(&mut count.equations))),
                ItemKind::Load { name, .. } => (name, Entity::Load),
                ItemKind::Measure { name, .. } => (name, Entity::Measure(next(&mut count.measures))),
                ItemKind::Trace { name, .. } => (name, Entity::Trace),
                ItemKind::Part(part) => (&part.name, Entity::Part(next(&mut count.parts))),
                ItemKind::Result { name, .. } => (name, Entity::Result(next(&mut count.results))),
                ItemKind::Requirement(requirement) => match &requirement.name {
                    Some(name) => (name, Entity::Requirement),
                    None => continue,
                },
                ItemKind::Broken { names, .. } => {
                    self.collect_broken(names);
                    continue;
                }
                ItemKind::Ground { .. } | ItemKind::Gravity { .. } | ItemKind::Analysis { .. } => continue,
            };
            let callable = matches!(entity, Entity::Function(_) | Entity::Table(_));
            let is_reserved = is_constant(name) || callable && is_called(&name.text) && !gives_way(&name.text);
            if is_reserved {
                let uses = uses_in(mechanism, name, callable);
                let kind = match &item.kind {
                    ItemKind::Param { value, .. } => {
                        SubstituteKind::of_value(value.parts().find_map(dimension_written))
                    }
                    _ => entity.kind_of_name(),
                };
                self.report_reserved(reporter, name, kind, &uses);
            }
            // The name is declared all the same, so that its uses are not reported too.
            if let Err(first) = self.space.declare(name, entity)
                && !is_reserved
            {
                reporter.report(errors::declared_twice(name, first));
            }
        }
        self.count = count;
        for item in &mechanism.items {
            match &item.kind {
                ItemKind::Function { argument, value, .. } => self.argument_name(reporter, argument, value),
                ItemKind::Ground { features } | ItemKind::Body { features, .. } => {
                    for feature in features {
                        if let FeatureKind::Curve { argument, at, .. } = &feature.kind {
                            self.argument_name(reporter, argument, at);
                        }
                    }
                }
                _ => {}
            }
        }
        only_once(reporter, mechanism);
    }

    /// Reports a name of the language, with a suggestion of a free name.
    fn report_reserved(&self, reporter: &mut Reporter<'_>, name: &Name, kind: SubstituteKind, uses: &[Span]) {
        let words = reporter.suggests_names().then(|| words_of(reporter.text(self.tree.span)));
        let instead = words.and_then(|words| substitute_name(kind, |name| !words.contains(name)));
        reporter.report(errors::reserved(name, instead, uses));
    }

    /// Declares the names of a broken declaration, so that their uses are not reported.
    fn collect_broken(&mut self, names: &[Name]) {
        if names.is_empty() {
            self.space.declare_nameless();
        }
        for name in names {
            // A duplicate keeps its first meaning.
            let _ = self.space.declare(name, Entity::Broken);
        }
    }

    /// Reports an argument of a function or curve that has the name of a declaration.
    fn argument_name(&self, reporter: &mut Reporter<'_>, argument: &Name, formula: &Expr) {
        let uses = || uses_of_argument(argument, formula);
        if is_constant(argument) {
            self.report_reserved(reporter, argument, SubstituteKind::Argument, &uses());
        } else if let Some(declared) = self.span(&argument.text) {
            let is_free = |name: &&str| self.get(name).is_none();
            let free = ["u", "v", "w", "x", "y", "z"].into_iter().find(is_free);
            reporter.report(errors::hidden_name(argument, declared, free, &uses()));
        }
    }
}

fn only_once(reporter: &mut Reporter<'_>, mechanism: &Mechanism) {
    let (mut ground, mut gravity, mut analysis) = (None, None, None);
    for item in &mechanism.items {
        let (first, word) = match item.kind {
            ItemKind::Ground { .. } => (&mut ground, "ground"),
            ItemKind::Gravity { .. } => (&mut gravity, "gravity"),
            ItemKind::Analysis { .. } => (&mut analysis, "analysis"),
            _ => continue,
        };
        match *first {
            None => *first = Some(item.span),
            Some(span) => reporter.report(errors::second(word, item.span, span)),
        }
    }
}

/// Returns whether a name is that of a constant of the language, of the time or of the ground.
pub(in crate::check) fn is_constant(name: &Name) -> bool {
    Constant::named(&name.text).is_some()
}

/// Returns every word of a text.
fn words_of(text: &str) -> FxHashSet<&str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect()
}
/// Returns the dimension of a number with its unit.
fn dimension_written(e: &Expr) -> Option<Dimension> {
    match &e.kind {
        ExprKind::Literal { unit: Some((unit, power)), .. } => {
            Unit::named(&unit.text).map(|unit| unit.dimension.to_the(f64::from(*power)))
        }
        _ => None,
    }
}

/// Returns definitions in order of dependence, and reports cycles.
///
/// `uses` lists for each definition the positions of those that it uses, with the locations of their names.
pub(in crate::check) fn ordered(
    reporter: &mut Reporter<'_>,
    definitions: &[(&Name, Vec<(usize, Span)>)],
) -> DefinitionOrder {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
        Broken,
    }
    let mut marks = vec![Mark::New; definitions.len()];
    let mut order = Vec::new();
    for start in 0..definitions.len() {
        if marks[start] != Mark::New {
            continue;
        }
        // An explicit stack: a chain of definitions may be long.
        let mut path = vec![(start, 0)];
        marks[start] = Mark::Open;
        while let Some((at, next)) = path.last_mut() {
            let at = *at;
            let Some(&(used, _)) = definitions[at].1.get(*next) else {
                if marks[at] == Mark::Open {
                    marks[at] = Mark::Done;
                    order.push(at);
                }
                path.pop();
                continue;
            };
            *next += 1;
            match marks[used] {
                Mark::New => {
                    marks[used] = Mark::Open;
                    path.push((used, 0));
                }
                Mark::Open => {
                    let from = path.iter().position(|&(k, _)| k == used).unwrap_or(0);
                    let mut circle: Vec<usize> = path[from..].iter().map(|&(k, _)| k).collect();
                    // The cycle is reported at the definition that comes first in the text.
                    let first = (0..circle.len()).min_by_key(|&k| definitions[circle[k]].0.span).unwrap_or(0);
                    circle.rotate_left(first);
                    let names: Vec<&Name> = circle.iter().map(|&k| definitions[k].0).collect();
                    reporter.report(errors::circle(&names));
                    for k in circle {
                        marks[k] = Mark::Broken;
                    }
                }
                Mark::Done | Mark::Broken => {}
            }
        }
    }
    let on_cycles = (0..definitions.len()).filter(|&k| marks[k] == Mark::Broken).collect();
    DefinitionOrder { order, on_cycles }
}
