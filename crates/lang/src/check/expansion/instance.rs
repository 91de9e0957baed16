//! Instances: mechanisms as they are checked, with their parts.

use crate::check::scope::name_of;
use mechc_syntax::ast::{ItemKind, Mechanism};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// The indices of the copies of a repeated declaration.
pub(in crate::check) type Copies = Rc<FxHashSet<Vec<i64>>>;

/// A mechanism as it is checked.
pub(in crate::check) struct Instance<'t> {
    /// The mechanism in the text.
    pub mechanism: &'t Mechanism,
    /// The mechanism with expanded repetitions, and paths into parts as names; `None` if it has neither.
    pub written: Option<Mechanism>,
    /// The parts, in the order of the tree.
    pub parts: Vec<Rc<Instance<'t>>>,
    /// The numbers of the parts by their names.
    pub part_named: FxHashMap<String, usize>,
    /// The paths into parts that formulas use.
    pub paths: Vec<String>,
    /// The params that determine repetitions.
    pub deciding: Rc<FxHashSet<String>>,
    /// The indices of the copies of repeated declarations.
    pub copies: FxHashMap<&'t str, Copies>,
    /// The number of declarations, including those of parts.
    pub count: usize,
}

impl<'t> Instance<'t> {
    /// Returns an instance without repetitions and parts.
    pub fn plain(mechanism: &'t Mechanism) -> Instance<'t> {
        Instance {
            mechanism,
            written: None,
            parts: Vec::new(),
            part_named: FxHashMap::default(),
            paths: Vec::new(),
            deciding: Rc::default(),
            copies: FxHashMap::default(),
            count: mechanism.items.len(),
        }
    }

    /// Returns the tree to check.
    pub fn tree(&self) -> &Mechanism {
        self.written.as_ref().unwrap_or(self.mechanism)
    }

    /// Returns whether it differs from the text.
    pub fn is_expanded(&self) -> bool {
        self.written.is_some()
    }

    /// Returns a part.
    pub fn part(&self, name: &str) -> Option<&Rc<Instance<'t>>> {
        self.part_named.get(name).map(|&k| &self.parts[k])
    }

    /// Returns whether the text declares a name, repeated or not.
    pub fn declares(&self, name: &str) -> bool {
        name == "ground" || self.names().any(|declared| declared == name)
    }

    /// Returns whether the text declares a part of a name.
    pub fn is_a_part(&self, name: &str) -> bool {
        self.mechanism.items.iter().any(|item| matches!(&item.kind, ItemKind::Part(part) if part.name.text == name))
    }

    /// Returns the names that the text declares.
    pub fn names(&self) -> impl Iterator<Item = &'t str> {
        self.mechanism.items.iter().filter_map(name_of).map(|name| name.text.as_str())
    }

    /// Returns the name of the mechanism.
    pub fn mechanism_name(&self) -> &'t str {
        &self.mechanism.name.text
    }
}
