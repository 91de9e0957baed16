//! A mechanism as it is checked, with its parts.

use super::mentions::name_of;
use mechc_syntax::ast::{ItemKind, Mechanism};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// The numbers of the copies of what is repeated.
pub(super) type Copies = Rc<FxHashSet<Vec<i64>>>;

/// A mechanism as it is checked.
pub(super) struct Instance<'t> {
    /// Its text.
    pub mechanism: &'t Mechanism,
    /// With repeated declarations written out, and paths into parts as names; nothing where it has neither.
    pub written: Option<Mechanism>,
    /// In the order in which its tree has them.
    pub parts: Vec<Rc<Instance<'t>>>,
    /// Their numbers, by their names.
    pub part_named: FxHashMap<String, usize>,
    /// What its formulas name in its parts.
    pub paths: Vec<String>,
    /// The params that decide what is repeated.
    pub deciding: Rc<FxHashSet<String>>,
    /// Of what is repeated: the numbers of its copies.
    pub copies: FxHashMap<&'t str, Copies>,
    /// Its declarations, and those of its parts.
    pub count: usize,
}

impl<'t> Instance<'t> {
    /// One without anything repeated, and without parts.
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

    /// What is checked.
    pub fn tree(&self) -> &Mechanism {
        self.written.as_ref().unwrap_or(self.mechanism)
    }

    /// Whether it differs from its text.
    pub fn is_written_out(&self) -> bool {
        self.written.is_some()
    }

    /// One of its parts.
    pub fn part(&self, name: &str) -> Option<&Rc<Instance<'t>>> {
        self.part_named.get(name).map(|&k| &self.parts[k])
    }

    /// Whether its text declares a name, be it repeated or not.
    pub fn declares(&self, name: &str) -> bool {
        name == "ground" || self.names().any(|known| known == name)
    }

    /// Whether its text declares a part of a name.
    pub fn is_a_part(&self, name: &str) -> bool {
        self.mechanism.items.iter().any(|item| matches!(&item.kind, ItemKind::Part(part) if part.name.text == name))
    }

    /// The names that its text declares.
    pub fn names(&self) -> impl Iterator<Item = &'t str> {
        self.mechanism.items.iter().filter_map(name_of).map(|name| name.text.as_str())
    }

    /// The name of its mechanism.
    pub fn mechanism_name(&self) -> &'t str {
        &self.mechanism.name.text
    }
}
