//! The tree-sitter grammar of `.mech` files.

use tree_sitter_language::LanguageFn;

unsafe extern "C" {
    fn tree_sitter_mech() -> *const ();
}

/// The grammar, as [`tree_sitter::Parser::set_language`](https://docs.rs/tree-sitter) takes it.
// SAFETY: the function is the one that src/parser.c defines, which gives a language
pub const LANGUAGE: LanguageFn = unsafe { LanguageFn::from_raw(tree_sitter_mech) };

/// What gives code its colours.
pub const HIGHLIGHTS_QUERY: &str = include_str!("../../queries/highlights.scm");

/// Which names belong to which declaration.
pub const LOCALS_QUERY: &str = include_str!("../../queries/locals.scm");

/// Other languages within.
pub const INJECTIONS_QUERY: &str = include_str!("../../queries/injections.scm");
