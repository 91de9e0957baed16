//! Overrides of params and inputs from outside the file, such as `--set` and `--input`. Those of parts are named by paths.

use super::Formulas;
use mechc_syntax::ast::{Binding, ItemKind, Name};
use mechc_syntax::normalized;
use mechc_text::source::Span;

impl Formulas<'_> {
    /// Returns the paths of all params or inputs, each with the location of its binding if it is bound.
    pub(super) fn settable_names(&self, of: fn(&ItemKind) -> Option<&Name>) -> Vec<(String, Option<Span>)> {
        let mut found = Vec::new();
        self.add_settable("", &[], of, &mut found);
        found
    }

    fn add_settable(
        &self,
        path: &str,
        bindings: &[Binding],
        of: fn(&ItemKind) -> Option<&Name>,
        found: &mut Vec<(String, Option<Span>)>,
    ) {
        for name in self.scope.items().iter().filter_map(|item| of(&item.kind)) {
            let binding =
                bindings.iter().find(|binding| binding.name.text == name.text && binding.coordinate.is_none());
            found.push((format!("{path}{}", name.text), binding.map(|binding| binding.span)));
        }
        for (child, part) in self.parts.iter().zip(&self.part_declarations) {
            child.add_settable(&format!("{path}{}.", part.name.text), &part.bindings, of, found);
        }
    }
}

/// Returns whether the path of an override names `full`, or all copies of it if the path leaves the indices out. Spaces are ignored.
#[must_use]
pub fn override_matches(full: &str, path: &str) -> bool {
    let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
    if path == full {
        return true;
    }
    let path = normalized(&path);
    let (mut segments, mut named) = (full.split('.'), path.split('.'));
    loop {
        match (segments.next(), named.next()) {
            (None, None) => return true,
            (Some(segment), Some(other)) => {
                let is_it = segment == other || segment.split_once('[').is_some_and(|(base, _)| base == other);
                if !is_it {
                    return false;
                }
            }
            _ => return false,
        }
    }
}
