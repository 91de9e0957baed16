//! Semantic tokens: the kind of each name and word, which an editor's grammar cannot tell. Comments, numbers and signs are left to it.

use super::snapshot::Snapshot;
use mechc_lang::check::{Meaning, NameKind};
use mechc_pipeline::Checked;
use mechc_text::vocabulary::{Category, Word};
use std::ops::Range;
use std::path::Path;

/// A name or word of a text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SemanticToken {
    /// The range of the token.
    pub range: Range<u32>,
    /// The kind of token.
    pub kind: TokenKind,
    /// True if it is declared here.
    pub declares: bool,
    /// True if its value is constant.
    pub is_constant: bool,
    /// True if it is a word of the language.
    pub is_of_language: bool,
}

/// The kinds of names and words.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum TokenKind {
    /// A mechanism.
    Mechanism,
    /// A part, or the prefix of a file's mechanisms.
    Part,
    /// A body, or the ground.
    Body,
    /// A point, axis, circle or curve.
    Feature,
    /// A joint, constraint or driver.
    Equation,
    /// A function or table, a quantity or reduction.
    Function,
    /// The argument of a function, or the index of a repetition.
    Argument,
    /// A param, input, measure, trace or result, or a constant of the language.
    Value,
    /// A kind of joint.
    JointKind,
    /// A unit.
    Unit,
    /// A keyword.
    Keyword,
}

/// Returns the names and words of a range of a file, in order and without overlaps.
#[must_use]
pub fn tokens(snapshot: &Snapshot, path: &Path, range: &Range<u32>) -> Option<Vec<SemanticToken>> {
    let checked = snapshot.checked(path)?;
    let mut tokens: Vec<SemanticToken> = checked.mechanisms.iter().flat_map(of_mechanism).collect();
    tokens.retain(|token| range.start < token.range.end && token.range.start < range.end);
    // a name that both uses and declares, as in `point A`, counts as a declaration
    tokens.sort_by_key(|token| (token.range.start, !token.declares));
    let mut end = 0;
    tokens.retain(|token| {
        let is_free = token.range.start >= end;
        end = end.max(token.range.end);
        is_free
    });
    Some(tokens)
}

fn of_mechanism(checked: &Checked) -> Vec<SemanticToken> {
    let (symbols, file) = (checked.symbols(), checked.file());
    let token = |used: mechc_lang::check::Use| {
        let (kind, is_constant, is_of_language) = match used.meaning {
            Meaning::Word(word) => of_word(word),
            Meaning::Declared(id) => {
                let kind = symbols.get(id).kind;
                (of_name(kind)?, kind == NameKind::Param, false)
            }
        };
        let range = used.span.start..used.span.end;
        // the ground is declared by its keyword
        let kind =
            if used.declares && checked.sources().text(used.span) == "ground" { TokenKind::Keyword } else { kind };
        Some(SemanticToken { range, kind, declares: used.declares, is_constant, is_of_language })
    };
    symbols.uses().filter(|used| used.span.file == file && used.span.start < used.span.end).filter_map(token).collect()
}

fn of_name(kind: NameKind) -> Option<TokenKind> {
    Some(match kind {
        NameKind::Mechanism => TokenKind::Mechanism,
        NameKind::Part | NameKind::Prefix => TokenKind::Part,
        NameKind::Ground | NameKind::Body => TokenKind::Body,
        NameKind::Point | NameKind::Axis | NameKind::Circle | NameKind::Curve => TokenKind::Feature,
        NameKind::Joint | NameKind::Constraint | NameKind::Driver | NameKind::Load => TokenKind::Equation,
        NameKind::Function | NameKind::Table => TokenKind::Function,
        NameKind::Argument => TokenKind::Argument,
        NameKind::Param
        | NameKind::Input
        | NameKind::Measure
        | NameKind::Trace
        | NameKind::Result
        | NameKind::Requirement => TokenKind::Value,
        NameKind::Broken => return None,
    })
}

fn of_word(word: &Word) -> (TokenKind, bool, bool) {
    match word.category {
        Category::Keyword => (TokenKind::Keyword, false, false),
        Category::Function | Category::Motion | Category::Quantity | Category::Reduction => {
            (TokenKind::Function, false, true)
        }
        Category::Joint => (TokenKind::JointKind, false, true),
        Category::Unit => (TokenKind::Unit, true, true),
        Category::Constant => (TokenKind::Value, true, true),
    }
}

#[cfg(test)]
mod tests {
    use super::{SemanticToken, tokens};
    use crate::testing::at_cursor;

    fn shown(text: &str) -> String {
        let (snapshot, position) = at_cursor(&format!("{text}$0"));
        let found = tokens(&snapshot, &position.path, &(0..u32::MAX)).expect("tokens");
        let line = |token: &SemanticToken| {
            let word = &text[token.range.start as usize..token.range.end as usize];
            let marks = [
                (token.declares, " declared"),
                (token.is_constant, " constant"),
                (token.is_of_language, " of the language"),
            ];
            let marks: String = marks.iter().filter(|(is, _)| *is).map(|(_, mark)| *mark).collect();
            format!("{word} {:?}{marks}\n", token.kind)
        };
        found.iter().map(line).collect()
    }

    #[test]
    fn names_and_words_have_kinds() {
        insta::assert_snapshot!(shown("\
mechanism m {
    param A = (5 mm, 0)
    fn f(in) = in * 2 + pi
    ground { point A }
    body to at (0, 0, 0) { point at = (3 mm, 0) }
    joint j[k in 0..2]: revolute(ground.A, to.at)
    measure y = max(y(to.at), 3 mm) in mm
    analysis from 0 s to 1 s every 1 s
}
"), @r"
        mechanism Keyword
        m Mechanism declared
        param Keyword
        A Value declared constant
        mm Unit constant of the language
        fn Keyword
        f Function declared
        in Argument declared
        in Argument
        pi Value constant of the language
        ground Keyword declared
        point Keyword
        A Feature declared
        body Keyword
        to Body declared
        at Keyword
        point Keyword
        at Feature declared
        mm Unit constant of the language
        joint Keyword
        j Equation declared
        k Argument declared
        in Keyword
        revolute JointKind of the language
        ground Body
        A Feature
        to Body
        at Feature
        measure Keyword
        y Value declared
        max Function of the language
        y Function of the language
        to Body
        at Feature
        mm Unit constant of the language
        in Keyword
        mm Unit constant of the language
        analysis Keyword
        from Keyword
        s Unit constant of the language
        to Keyword
        s Unit constant of the language
        every Keyword
        s Unit constant of the language
        ");
    }

    #[test]
    fn a_broken_text_keeps_the_rest() {
        insta::assert_snapshot!(shown("\
mechanism m {
    param a = 5 mm
    joint j revolute(ground.A, to.at
    body to at at (0, 0, 0
    joint k: rack_pinion(at, to.at, 0 mm, left
    measure b = a
"), @r"
        mechanism Keyword
        m Mechanism declared
        param Keyword
        a Value declared constant
        mm Unit constant of the language
        joint Keyword
        ground Keyword
        body Keyword
        at Keyword
        at Keyword
        joint Keyword
        left Keyword
        measure Keyword
        b Value declared
        a Value constant
        ");
    }
}
