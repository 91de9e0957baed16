//! Text to tree: what was written, with its places, and no meaning. And back: [`format()`].
//!
//! The grammar is `grammar/mech.pest`. This room knows words and precedences; it does not know which names exist,
//! which units there are, or what a joint is.

pub mod ast;
mod build;
mod depth;
mod errors;
pub mod format;
mod formula;
mod grammar;
mod mends;
mod outline;
mod parse;
mod tokens;
mod trivia;

pub use build::{is_name, normalized};
pub use depth::DEEPEST;
pub use format::format;
pub use parse::{Parsed, parse, parse_expression};
pub use trivia::{Comment, Trivia};

/// Words that begin a declaration, where every formula before them has ended.
const DECLARATIONS: &[&str] = &[
    "mechanism",
    "param",
    "fn",
    "table",
    "ground",
    "body",
    "point",
    "axis",
    "circle",
    "curve",
    "joint",
    "driver",
    "constraint",
    "measure",
    "analysis",
];

/// Those of them that stand in a body or the ground.
const FEATURES: &[&str] = &["point", "axis", "circle", "curve"];
