//! Text to tree: what was written, with its places, and no meaning. And back: [`format()`].
//!
//! The grammar is `grammar/mech.pest`; the words in it are those of `vocabulary`. This room knows words and precedences; it
//! does not know which names exist, or what a joint is.

pub mod ast;
mod build;
mod depth;
mod errors;
pub mod format;
mod formula;
mod grammar;
mod intended;
mod mends;
mod outline;
mod parse;
mod tokens;
mod trivia;

pub use build::{is_name, normalized};
pub use depth::DEEPEST;
pub use format::{format, formatted};
pub use parse::{Parsed, parse, parse_expression};
pub use tokens::keywords_in;
pub use trivia::{Comment, Trivia};
