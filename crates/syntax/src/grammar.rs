//! The parser that is generated from `grammar/mech.pest`. The rest of this crate builds on it and on [`super::lexer`].

pub(super) use generated::{Grammar, Rule};
use mechc_text::vocabulary::Keyword;

/// Returns the keyword that a rule consists of or begins with: `kw_param`, `param`, `ground_head`, `to`.
pub(super) fn keyword_of(rule: Rule) -> Option<&'static Keyword> {
    let rule = format!("{rule:?}");
    let word = rule.trim_start_matches("kw_").trim_end_matches("_head");
    Keyword::named(if word == "function" { "fn" } else { word })
}

/// Generated code, in a module of its own because its items have no documentation.
#[allow(missing_docs)]
mod generated {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/mech.pest"]
    pub struct Grammar;
}
