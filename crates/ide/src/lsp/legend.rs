//! What the numbers of semantic tokens stand for.

use crate::TokenKind;

/// The types of the protocol for the kinds of names and words.
pub(super) const OF_KINDS: &[(TokenKind, &str)] = &[
    (TokenKind::Mechanism, "class"),
    (TokenKind::Part, "namespace"),
    (TokenKind::Body, "struct"),
    (TokenKind::Feature, "property"),
    (TokenKind::Equation, "event"),
    (TokenKind::Function, "function"),
    (TokenKind::Argument, "parameter"),
    (TokenKind::Value, "variable"),
    (TokenKind::JointKind, "type"),
    (TokenKind::Unit, "enumMember"),
    (TokenKind::Keyword, "keyword"),
];

/// The legend: types, in the order of their numbers.
pub(super) fn types() -> Vec<&'static str> {
    OF_KINDS.iter().map(|(_, name)| *name).collect()
}

/// The legend: modifiers, in the order of their bits.
pub(super) const MODIFIERS: [&str; 3] = ["declaration", "readonly", "defaultLibrary"];
