//! Parsing of a text to its tree, and of the parts of texts that options consist of.

#![allow(clippy::redundant_closure_for_method_calls)] // a method of one builder is not general enough for all

use super::ast::{Expr, File, Item};
use super::build::Piece;
use super::depth::STACK;
use super::errors;
use super::grammar::Rule;
use super::lexer::{Lexer, Token, tokens};
use super::reader;
use super::reuse::PreviousTree;
use super::sync_points::SyncPoints;
use super::trivia::{self, Trivia};
use mechc_text::diag::Diagnostics;
use mechc_text::source::{FileId, Sources};
use rustc_hash::FxHashSet;

/// The result of parsing a text, with or without faults.
#[derive(Clone, PartialEq, Debug)]
pub struct ParsedText {
    /// Everything that follows the grammar, with the spans of everything that does not.
    pub tree: File,
    /// Comments and blank lines.
    pub trivia: Trivia,
    /// Syntax errors, in order of position.
    pub faults: Diagnostics,
    /// First bytes of the declarations of mechanisms that have a fault, reported or not.
    pub(super) faulty: FxHashSet<u32>,
}

impl ParsedText {
    /// Creates a text that cannot be read.
    #[must_use]
    pub fn unread(faults: Diagnostics) -> ParsedText {
        let tree = File { uses: Vec::new(), mechanisms: Vec::new() };
        ParsedText { tree, trivia: Trivia::default(), faults, faulty: FxHashSet::default() }
    }
}

/// Parses a file.
#[must_use]
pub fn parse(sources: &Sources, file: FileId) -> ParsedText {
    read(sources, file, None)
}

/// Parses an edited file with the help of its previous tree; the result is that of [`parse`].
#[must_use]
pub fn reparse(old: &ParsedText, old_text: &str, sources: &Sources, file: FileId) -> ParsedText {
    let texts = [old_text, &sources.get(file).text];
    read(sources, file, Some(&PreviousTree::new(&old.tree, &old.faulty, texts, file)))
}

fn read(sources: &Sources, file: FileId, previous: Option<&PreviousTree<'_>>) -> ParsedText {
    let source = sources.get(file);
    let mut tokens: Vec<Token<'_>> = Lexer::new(&source.text, 0).collect();
    let trivia = trivia::of(&source.text, file, &tokens);
    tokens.retain(|token| !token.is_comment());
    let sync = SyncPoints::new(&source.text, tokens);
    // once for the whole text: a stack of its own takes longer than most declarations
    let (tree, mut faults, faulty) = stacker::maybe_grow(STACK, STACK, || reader::read(source, file, &sync, previous));
    if tree.mechanisms.is_empty() && faults.is_empty() {
        faults.push(errors::no_mechanism(sources.end_of(file)));
    }
    faults.sort_by_span();
    ParsedText { tree, trivia, faults, faulty }
}

/// Parses a formula alone, as in an option of the command line.
///
/// # Errors
/// Syntax errors.
pub fn parse_expression(sources: &Sources, file: FileId) -> Result<Expr, Diagnostics> {
    let source = sources.get(file);
    let tokens = tokens(&source.text);
    let piece = Piece::new(source, file, &tokens);
    stacker::maybe_grow(STACK, STACK, || piece.read(Rule::expression_only, |builder, pair| builder.whole_formula(pair)))
        .map_err(|refused| (*piece.fault(refused, true)).into())
}

/// Parses a declaration without a block alone, as in an option of the command line.
///
/// # Errors
/// Syntax errors.
pub fn parse_declaration(sources: &Sources, file: FileId) -> Result<Item, Diagnostics> {
    let source = sources.get(file);
    let tokens = tokens(&source.text);
    let piece = Piece::new(source, file, &tokens);
    stacker::maybe_grow(STACK, STACK, || {
        piece.read(Rule::only_item, |builder, pair| builder.plain_item(builder.only(pair)?))
    })
    .map_err(|refused| (*piece.fault(refused, true)).into())
}

#[cfg(test)]
mod tests {
    use super::parse;
    use crate::ast::{FeatureKind, ItemKind};
    use crate::grammar::{Grammar, Rule};
    use crate::lexer::tokens;
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
    const MORE: &str = include_str!("../../../examples/cam_with_dwells.mech");
    const USES: &str = "/// Both.\nuse \"a.mech\" // of one\nuse\n\"../b.mech\" as\nuse use \"c.mech\" as mechanisms /// m\nmechanism m { body use { point as = (0, 0) } }\nmechanism n {}";

    #[test]
    fn texts_follow_the_grammar_if_they_have_no_faults() {
        let (mut state, mut refused) = (1, 0);
        for k in 0..900 {
            let text = damaged([TEXT, MORE, USES][k % 3], &mut state);
            let is_in_the_grammar = Grammar::parse(Rule::file, &text).is_ok();
            let faults = parsed(&text).faults;
            // a text that follows the grammar may still be no formula
            let is_let_pass = faults
                .iter()
                .all(|f| f.code == Code::E0309 || f.message.contains("unit") && !f.message.starts_with("expected"));
            assert_eq!(is_in_the_grammar, faults.is_empty() || is_let_pass, "{text}\n{faults:?}");
            refused += usize::from(!is_in_the_grammar);
        }
        assert!(refused > 400, "only {refused} texts were broken");
        for text in [TEXT, MORE, USES, include_str!("../../../tests/stages/everything/input.mech")] {
            assert!(Grammar::parse(Rule::file, text).is_ok() && parsed(text).faults.is_empty(), "{text}");
        }
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
    fn connecting_words_may_be_names() {
        let text = "mechanism m {\n param at = 2 kg\n param to = 1 m/s^2\n body b at (0, 0, 0) { mass 3 kg mass at at (0, 0) mass 2 * at mass (3) mass if 1 < 2 then to else to mass at mass\n to }\n gravity to * (0, 1)\n}";
        let parsed = parsed(text);
        assert!(parsed.faults.is_empty() && parsed.tree.mechanisms[0].items.len() == 4, "{:?}", parsed.faults);
    }

    #[test]
    fn long_heads_are_heads() {
        let ranges = (0..40).map(|k| format!("k{k} in 0..1")).collect::<Vec<_>>().join(", ");
        assert!(parsed(&format!("mechanism m {{ body b[{ranges}] {{ point P }} }}")).faults.is_empty());
        let text = format!("mechanism m {{ body b[{ranges}] {{ point P = }} body c at ( {{ point P }} joint }}");
        assert_eq!(parsed(&text).faults.len(), 3);
    }

    #[test]
    fn many_faults_take_linear_time() {
        let text = format!("mechanism m {{\n{}}}", "param r = 3 +\n".repeat(5_000));
        assert_eq!(parsed(&text).faults.len(), 5_000);
        let text = "use \"a.mech\" as\n".repeat(5_000);
        assert_eq!(parsed(&text).faults.len(), 5_000);
        let text = "joint ".repeat(100_000);
        assert!(!parsed(&text).faults.is_empty());
        let text = "a ".repeat(100_000);
        assert!(!parsed(&text).faults.is_empty());
        let text = "mechanism a ".repeat(20_000);
        assert!(!parsed(&text).faults.is_empty());
        let text = "{ ".repeat(100_000);
        assert!(!parsed(&text).faults.is_empty());
    }

    #[test]
    fn deep_texts_are_refused_and_the_deepest_are_parsed() {
        let faults = |formula: &str| parsed(&format!("mechanism m {{ param p = {formula}\n}}")).faults;
        for open in ["(", "a[", "if ", "if a then ", "if a then b else (", "-(", "f(", "not (", "-", "2^"] {
            let codes: Vec<Code> = faults(&open.repeat(100_000)).iter().map(|fault| fault.code).collect();
            let is_refused = codes == [Code::E0103];
            assert!(is_refused || codes == [Code::E0101] && ["-", "2^"].contains(&open), "{open}: {codes:?}");
        }
        let nested =
            |open: &str, close: &str, levels: usize| format!("{}a{}", open.repeat(levels), close.repeat(levels));
        for (open, close, levels) in [("(", ")", 199), ("if a then b else (", ")", 99), ("if a then ", " else b", 199)]
        {
            assert!(faults(&nested(open, close, levels)).is_empty(), "{open}");
            let too_deep = faults(&nested(open, close, levels + 3));
            assert_eq!(too_deep.iter().map(|fault| fault.code).collect::<Vec<_>>(), [Code::E0103], "{open}");
        }
    }

    /// Returns a text that is parsed in shares, with an insertion in the middle.
    fn long(middle: &str) -> String {
        let one = |k: usize| {
            let middle = if k == 2_000 { middle } else { "" };
            format!(
                "    /// Number {k}.\n    body b{k} at ({k}, 0, 0) {{ point P = (0, 0) }} // joint\n    joint j{k}: revolute(ground.O, b{k}.P)\n{middle}"
            )
        };
        format!("mechanism long {{\n    ground {{ point O = (0, 0) }}\n{}}}\n", (0..4_000).map(one).collect::<String>())
    }

    #[test]
    fn long_texts_are_parsed_like_short_ones() {
        let whole = parsed(&long(""));
        assert!(whole.faults.is_empty() && whole.tree.mechanisms[0].items.len() == 8_001);
        let last = |text: &str| {
            let parsed = parsed(text);
            let mechanism = parsed.tree.mechanisms.last().expect("a mechanism").clone();
            (
                parsed.faults.iter().map(|fault| fault.code).collect::<Vec<_>>(),
                mechanism.name.text,
                mechanism.items.len(),
            )
        };
        let all = |count, codes: &[Code]| (codes.to_vec(), "long".to_owned(), count);
        assert_eq!(last(&long("    param p = 1\n")), all(8_002, &[]));
        assert_eq!(last(&long("    param p = \n")), all(8_002, &[Code::E0101]));
        assert_eq!(last(&long("    joint j: revolute(ground.O\n")), all(8_002, &[Code::E0101]));
        // the declarations behind a superfluous brace are reported once
        assert_eq!(last(&long("    }\n")), all(8_001, &[Code::E0101]));
        assert_eq!(last(&long("}\nmechanism n {\n")), (Vec::new(), "n".to_owned(), 3_998));
        let docs = |text: &str, k: usize| parsed(text).tree.mechanisms[0].items[k].docs.clone();
        assert_eq!(docs(&long(""), 7_999), ["Number 3999."]);
    }
}
