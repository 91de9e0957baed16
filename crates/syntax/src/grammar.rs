//! The parser that is generated from `grammar/mech.pest`. The rest of this crate builds on it and on [`super::lexer`].

pub(super) use generated::{Grammar, Rule};

/// Generated code, in a module of its own because its items have no documentation.
#[allow(missing_docs)]
mod generated {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/mech.pest"]
    pub struct Grammar;
}
