//! Guesses which dimensionless params and inputs are angles, by the unit words of their formulas.

use mechc_lang::check::Library;
use mechc_syntax::ast::{Expr, ItemKind, Mechanism};
use mechc_text::source::{Sources, Span};

/// Words that make an angle of a pure number, or of a time.
const WORDS: [&str; 4] = ["deg", "rad", "rev", "rpm"];
/// Depth to which names in a formula are followed.
const MAX_DEPTH: u32 = 8;

/// The texts whose formulas decide.
#[derive(Clone, Debug)]
pub(crate) struct Angles {
    library: Library,
    sources: Sources,
}

impl Angles {
    pub fn new(library: &Library, sources: &Sources) -> Angles {
        Angles { library: library.clone(), sources: sources.clone() }
    }

    /// Returns whether the param or input whose name is at a span is an angle, provided that it is dimensionless.
    pub fn has(&self, name: Span) -> bool {
        let mut mechanisms = self.library.files().iter().flat_map(|file| &file.read.tree.mechanisms);
        mechanisms.any(|tree| {
            formulas(tree).any(|(span, _, formula)| span == name && self.is_angle(tree, formula, MAX_DEPTH))
        })
    }

    fn is_angle(&self, tree: &Mechanism, formula: &Expr, depth: u32) -> bool {
        let words = self.sources.text(formula.span).split(|c: char| !(c.is_alphanumeric() || c == '_'));
        // a unit may follow its number without a space
        let mut words = words.map(|word| word.trim_start_matches(|c: char| c.is_ascii_digit()));
        let of_named = |word: &str| {
            depth > 0
                && formulas(tree).any(|(_, name, formula)| name == word && self.is_angle(tree, formula, depth - 1))
        };
        words.any(|word| WORDS.contains(&word) || of_named(word))
    }
}

/// Returns the params and inputs of a mechanism: span of the name, name, formula.
fn formulas(tree: &Mechanism) -> impl Iterator<Item = (Span, &str, &Expr)> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Param { name, value } | ItemKind::Input { name, value } => {
            Some((name.span, name.text.as_str(), value))
        }
        _ => None,
    })
}
