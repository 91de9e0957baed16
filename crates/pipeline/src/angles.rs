//! Which numbers without a dimension are angles, as far as the words of their formulas tell.

use mechc_lang::check::Library;
use mechc_syntax::ast::{Expr, ItemKind, Mechanism};
use mechc_text::source::{Sources, Span};

/// Words that make an angle of a pure number, or of a time.
const WORDS: [&str; 4] = ["deg", "rad", "rev", "rpm"];
/// A formula names a param that names another one, and so on, so often at the most.
const DEEPEST: u32 = 8;

/// The texts that tell them.
#[derive(Clone, Debug)]
pub(super) struct Angles {
    library: Library,
    sources: Sources,
}

impl Angles {
    pub fn of(library: &Library, sources: &Sources) -> Angles {
        Angles { library: library.clone(), sources: sources.clone() }
    }

    /// Whether the param or input is one that is declared by a name, where its dimension lets it be one.
    pub fn has(&self, name: Span) -> bool {
        let mut mechanisms = self.library.files().iter().flat_map(|file| &file.read.tree.mechanisms);
        mechanisms
            .any(|tree| formulas(tree).any(|(span, _, formula)| span == name && self.is_one(tree, formula, DEEPEST)))
    }

    fn is_one(&self, tree: &Mechanism, formula: &Expr, depth: u32) -> bool {
        let words = self.sources.text(formula.span).split(|c: char| !(c.is_alphanumeric() || c == '_'));
        // a unit may stand right behind its number
        let mut words = words.map(|word| word.trim_start_matches(|c: char| c.is_ascii_digit()));
        let of_named = |word: &str| {
            depth > 0 && formulas(tree).any(|(_, name, formula)| name == word && self.is_one(tree, formula, depth - 1))
        };
        words.any(|word| WORDS.contains(&word) || of_named(word))
    }
}

/// What is declared by a formula: the place of its name, its name, the formula.
fn formulas(tree: &Mechanism) -> impl Iterator<Item = (Span, &str, &Expr)> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Param { name, value } | ItemKind::Input { name, value } => {
            Some((name.span, name.text.as_str(), value))
        }
        _ => None,
    })
}
