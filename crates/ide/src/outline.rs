//! The declarations of a file, as a tree.

use super::snapshot::Snapshot;
use mechc_lang::check::{NameId, NameKind, Symbols};
use std::ops::Range;
use std::path::Path;

/// An entry of the outline.
#[derive(Clone, PartialEq, Debug)]
pub struct OutlineEntry {
    /// The name of the declaration.
    pub name: String,
    /// The kind of declaration.
    pub kind: NameKind,
    /// The range of the whole declaration, in bytes.
    pub range: Range<u32>,
    /// The range of its name, in bytes.
    pub name_range: Range<u32>,
    /// The declarations in it.
    pub inside: Vec<OutlineEntry>,
}

/// Returns the mechanisms of a file with their declarations.
#[must_use]
pub fn outline(snapshot: &Snapshot, path: &Path) -> Option<Vec<OutlineEntry>> {
    let checked = snapshot.checked(path)?;
    Some(checked.mechanisms.iter().filter_map(|checked| of_mechanism(checked.symbols())).collect())
}

fn of_mechanism(symbols: &Symbols) -> Option<OutlineEntry> {
    let mut inside: Vec<(NameId, Option<NameId>)> = Vec::new();
    for (id, name) in symbols.iter() {
        if !matches!(name.kind, NameKind::Mechanism | NameKind::Argument | NameKind::Prefix) {
            inside.push((id, name.owner));
        }
    }
    let (mechanism, _) = symbols.iter().next()?;
    let mut entry = of_name(symbols, mechanism);
    for &(id, _) in inside.iter().filter(|(_, owner)| owner.is_none()) {
        entry.inside.push(of_name(symbols, id));
    }
    let top_level: Vec<NameId> = inside.iter().filter(|(_, owner)| owner.is_none()).map(|(id, _)| *id).collect();
    for (id, owner) in inside.iter().filter_map(|&(id, owner)| Some((id, owner?))) {
        // ids are in the order of declaration, so the list is sorted
        if let Ok(at) = top_level.binary_search(&owner) {
            entry.inside[at].inside.push(of_name(symbols, id));
        }
    }
    Some(entry)
}

fn of_name(symbols: &Symbols, id: NameId) -> OutlineEntry {
    let name = symbols.get(id);
    let (declaration, name_span) = (name.declaration, name.span);
    OutlineEntry {
        name: name.name.clone(),
        kind: name.kind,
        range: declaration.start..declaration.end,
        name_range: name_span.start..name_span.end,
        inside: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{OutlineEntry, outline};
    use crate::testing::{FOUR_BAR, at_cursor};

    fn written(entries: &[OutlineEntry], depth: usize) -> String {
        let line = |entry: &OutlineEntry| {
            format!("{}{:?} {}\n{}", "  ".repeat(depth), entry.kind, entry.name, written(&entry.inside, depth + 1))
        };
        entries.iter().map(line).collect()
    }

    #[test]
    fn points_are_nested_in_their_bodies() {
        let (snapshot, position) = at_cursor(&format!("{FOUR_BAR}$0"));
        insta::assert_snapshot!(written(&outline(&snapshot, &position.path).expect("an outline"), 0), @r"
        Mechanism four_bar
          Param crank_length
          Ground ground
            Point A
            Point D
          Body crank
            Point A
            Point B
          Body coupler
            Point B
            Point C
          Body rocker
            Point D
            Point C
          Joint main
          Joint pin
          Joint knee
          Joint pivot
          Driver motor
        ");
    }
}
