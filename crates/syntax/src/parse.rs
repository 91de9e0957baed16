//! Parsing of a text to its tree. A text that follows the grammar is parsed at once; any other one declaration by declaration
//! ([`by_declarations`]). Both ways give the same tree for a text without faults.

#![allow(clippy::redundant_closure_for_method_calls)] // a method of one reader is not general enough for all

use super::ast::{Expr, File, Item};
use super::build::Piece;
use super::depth::STACK;
use super::errors;
use super::grammar::Rule;
use super::parallel::parse_parallel;
use super::recovery::by_declarations;
use super::reuse::PreviousTree;
use super::trivia::{self, Trivia};
use mechc_text::diag::Diagnostics;
use mechc_text::source::{FileId, Sources};

/// The result of parsing a text, with or without faults.
#[derive(Clone, PartialEq, Debug)]
pub struct ParsedText {
    /// Everything that follows the grammar, with the spans of everything that does not.
    pub tree: File,
    /// Comments and blank lines.
    pub trivia: Trivia,
    /// Syntax errors, in order of position.
    pub faults: Diagnostics,
}

/// Parses a file.
#[must_use]
pub fn parse(sources: &Sources, file: FileId) -> ParsedText {
    let source = sources.get(file);
    let whole = Piece { source, file, range: 0..source.text.len() };
    // once for the whole text: a stack of its own takes longer than most declarations
    let (tree, faults) = stacker::maybe_grow(STACK, STACK, || {
        let at_once = || whole.read(Rule::file, |reader, pair| reader.file(pair)).ok();
        let read = parse_parallel(source, file).or_else(at_once);
        read.map_or_else(|| by_declarations(source, file, None), |tree| (tree, Diagnostics::default()))
    });
    with_all(sources, file, tree, faults)
}

/// Parses an edited file with the help of its previous tree; the result is that of [`parse`].
#[must_use]
pub fn reparse(old: &ParsedText, old_text: &str, sources: &Sources, file: FileId) -> ParsedText {
    let source = sources.get(file);
    let (tree, faults) = stacker::maybe_grow(STACK, STACK, || {
        by_declarations(source, file, Some(PreviousTree::new(&old.tree, [old_text, &source.text], file)))
    });
    with_all(sources, file, tree, faults)
}

/// Adds trivia to a tree, and checks that a file has a mechanism.
fn with_all(sources: &Sources, file: FileId, tree: File, mut faults: Diagnostics) -> ParsedText {
    if tree.mechanisms.is_empty() && faults.is_empty() {
        faults.push(errors::no_mechanism(sources.end_of(file)));
    }
    faults.sort_by_span();
    ParsedText { tree, trivia: trivia::of(&sources.get(file).text, file), faults }
}

/// Parses a formula alone, as in an option of the command line.
///
/// # Errors
/// Syntax errors.
pub fn parse_expression(sources: &Sources, file: FileId) -> Result<Expr, Diagnostics> {
    let source = sources.get(file);
    let piece = Piece { source, file, range: 0..source.text.len() };
    stacker::maybe_grow(STACK, STACK, || piece.read(Rule::expression_only, |reader, pair| reader.whole_formula(pair)))
        .map_err(|refused| (*piece.fault(refused, true)).into())
}

/// Parses a declaration without a block alone, as in an option of the command line.
///
/// # Errors
/// Syntax errors.
pub fn parse_declaration(sources: &Sources, file: FileId) -> Result<Item, Diagnostics> {
    let source = sources.get(file);
    let piece = Piece { source, file, range: 0..source.text.len() };
    stacker::maybe_grow(STACK, STACK, || {
        piece.read(Rule::only_item, |reader, pair| reader.plain_item(reader.only(pair)?))
    })
    .map_err(|refused| (*piece.fault(refused, true)).into())
}

#[cfg(test)]
mod tests {
    use super::parse;
    use crate::ast::{FeatureKind, ItemKind};
    use crate::grammar::{Grammar, Rule};
    use crate::tokens::tokens;
    use mechc_text::diag::Code;
    use mechc_text::source::Sources;
    use pest::Parser;

    fn parsed(text: &str) -> super::ParsedText {
        let mut sources = Sources::default();
        let file = sources.add("text.mech", text);
        parse(&sources, file)
    }

    /// Returns the next pseudo-random number.
    fn next(state: &mut u64) -> usize {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 33) as usize
    }

    /// Returns a text with a random word left out, repeated, or replaced by another one.
    fn damaged(text: &str, state: &mut u64) -> String {
        let tokens = tokens(text);
        let (k, other) = (next(state) % tokens.len(), next(state) % tokens.len());
        let word = match next(state) % 3 {
            0 => String::new(),
            1 => format!("{0} {0}", tokens[k].text),
            _ => tokens[other].text.to_owned(),
        };
        format!("{}{word}{}", &text[..tokens[k].start], &text[tokens[k].end()..])
    }

    const TEXT: &str = include_str!("../../../examples/table_driven.mech");
    const USES: &str = "/// Both.\nuse \"a.mech\" // of one\nuse\n\"../b.mech\" as\nuse use \"c.mech\" as mechanisms /// m\nmechanism m { body use { point as = (0, 0) } }\nmechanism n {}";
    const MORE: &str = include_str!("../../../examples/cam_with_dwells.mech");

    #[test]
    fn a_text_without_faults_has_one_tree_both_ways() {
        for text in [TEXT, MORE, USES, include_str!("../../../tests/stages/everything/input.mech")] {
            let mut sources = Sources::default();
            let file = sources.add("text.mech", text);
            let (tree, faults) = super::by_declarations(sources.get(file), file, None);
            assert!(faults.is_empty(), "{faults:?}");
            assert_eq!(parse(&sources, file).tree, tree);
        }
    }

    #[test]
    fn recovery_matches_the_grammar_on_valid_texts() {
        let (mut state, mut refused) = (1, 0);
        for k in 0..900 {
            let text = damaged([TEXT, MORE, USES][k % 3], &mut state);
            let is_in_the_grammar = Grammar::parse(Rule::file, &text).is_ok();
            let mut sources = Sources::default();
            let file = sources.add("text.mech", text.as_str());
            let (_, faults) = super::by_declarations(sources.get(file), file, None);
            // a text that follows the grammar may still be no formula
            let is_let_pass = faults
                .iter()
                .all(|f| f.code == Code::E0309 || f.message.contains("unit") && !f.message.starts_with("expected"));
            assert_eq!(is_in_the_grammar, faults.is_empty() || is_let_pass, "{text}\n{faults:?}");
            refused += usize::from(!is_in_the_grammar);
        }
        assert!(refused > 400, "only {refused} texts were broken");
    }

    #[test]
    fn faults_affect_only_their_declaration() {
        let text = "mechanism m {\n ground { point A = (0, 0 point B = (1, 0) }\n param r = 3 3\n param s = 4\n joint j revolute(a, b)\n body c at (0 { point P = (0, 0) }\n}";
        let parsed = parsed(text);
        assert_eq!(parsed.faults.len(), 4, "{:?}", parsed.faults);
        let items = &parsed.tree.mechanisms[0].items;
        assert_eq!(items.len(), 5);
        let ItemKind::Ground { features } = &items[0].kind else { panic!("the ground is whole") };
        assert_eq!(features[0].kind, FeatureKind::Broken);
        assert_eq!((features[0].name.text.as_str(), features[1].name.text.as_str()), ("A", "B"));
        assert!(matches!(&items[1].kind, ItemKind::Broken { names, .. } if names[0].text == "r"));
        assert!(matches!(&items[2].kind, ItemKind::Param { name, .. } if name.text == "s"));
        assert!(matches!(&items[3].kind, ItemKind::Broken { names, .. } if names[0].text == "j"));
        assert!(
            matches!(&items[4].kind, ItemKind::Body { name, pose: None, features } if name.text == "c" && features.len() == 1)
        );
    }

    #[test]
    fn a_use_at_fault_spoils_no_other_and_no_mechanism() {
        let text = "use \"a.mech\" as 3\nuse b.mech\nuse \"c.mech\" as\nuse \"d.mech\" as d;\nuse \"e.mech\" as e\nmechanism m { param a = 1 }\nuse \"f.mech\"";
        let parsed = parsed(text);
        assert_eq!(parsed.faults.len(), 5, "{:?}", parsed.faults);
        let used =
            parsed.tree.uses.iter().map(|used| (used.path.as_ref().map_or("", |path| &path.text), used.is_broken));
        assert_eq!(
            used.collect::<Vec<_>>(),
            [("a.mech", true), ("", true), ("c.mech", true), ("d.mech", true), ("e.mech", false), ("f.mech", false)]
        );
        assert_eq!(parsed.tree.mechanisms[0].items.len(), 1);
    }

    #[test]
    fn many_faults_take_linear_time() {
        let text = format!("mechanism m {{\n{}}}", "param r = 3 +\n".repeat(5_000));
        assert_eq!(parsed(&text).faults.len(), 5_000);
        let text = "use \"a.mech\" as\n".repeat(5_000);
        assert_eq!(parsed(&text).faults.len(), 5_000);
        let text = "joint ".repeat(100_000);
        assert!(!parsed(&text).faults.is_empty());
        let text = "{ ".repeat(100_000);
        assert!(!parsed(&text).faults.is_empty());
    }
}
