//! Text to tree: what was written, with its places, and no meaning. And back: [`format()`].
//!
//! The grammar is `grammar/mech.pest`; the words in it are those of `vocabulary`. This room knows words and precedences; it
//! does not know which names exist, or what a joint is.

pub mod ast;
mod depth;
mod errors;
pub mod format;
mod formula;
mod mends;
mod parse;
mod recover;

pub use depth::DEEPEST;
pub use format::format;
pub use parse::{is_name, normalized, parse, parse_expression};
