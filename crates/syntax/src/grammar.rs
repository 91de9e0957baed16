//! The parser that `grammar/mech.pest` generates. Everything else in this crate is built on it and on [`super::tokens`].

pub(super) use generated::{Grammar, Rule};

/// In a module of its own because its items carry no documentation.
#[allow(missing_docs)]
mod generated {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/mech.pest"]
    pub struct Grammar;
}
