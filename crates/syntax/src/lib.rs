//! Parsing of texts to trees, with spans and without meaning; and formatting ([`format()`]).
//!
//! The grammar is `grammar/mech.pest`; its words are those of `vocabulary`. This crate knows words and precedences. It does not know which
//! names exist, or what a joint is.

// the parser that pest generates without its `std` needs this crate
extern crate alloc;

pub mod ast;
mod build;
mod depth;
mod errors;
pub mod format;
mod formula;
mod grammar;
pub mod import;
mod keywords;
mod lexer;
mod parse;
mod reader;
mod reuse;
mod shift_spans;
mod suggest;
mod sync_points;
mod trivia;

pub use build::{is_name, normalized};
pub use depth::DEEPEST;
pub use format::{format, formatted};
pub use keywords::{begins_declaration, keywords_in};
pub use lexer::{LexemeKind, Lexer, Token, is_word_char, tokens};
pub use parse::{ParsedText, parse, parse_declaration, parse_expression, reparse};
pub use trivia::{Comment, Trivia};
