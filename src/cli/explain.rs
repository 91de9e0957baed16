//! `mechc explain`: the page of a diagnostic's code, or the list of all codes.

use super::arguments::ExplainArguments;
use super::failure::Failure;
use super::files;
use crate::diag::{Code, Diagnostic, nearest};

pub(super) fn explain(arguments: &ExplainArguments) -> Result<(), Failure> {
    match &arguments.code {
        None => files::print(&list()),
        Some(name) => match Code::named(name) {
            Some(code) => files::print(code.page()),
            None => Err(unknown(name).into()),
        },
    }
}

/// Every code with its title, below its area.
fn list() -> String {
    let mut text = String::new();
    for area in Code::ALL.chunk_by(|a, b| a.area() == b.area()) {
        let gap = if text.is_empty() { "" } else { "\n" };
        text += &format!("{gap}{}\n", area.first().map_or("", |code| code.area()));
        for code in area {
            text += &format!("  {code}  {}\n", code.title());
        }
    }
    text
}

fn unknown(name: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0706, format!("there is no code `{name}`"));
    match nearest(&name.to_uppercase(), Code::ALL.iter().map(|code| code.as_str())) {
        Some(code) => diagnostic.help(format!("was `{code}` meant? `mechc explain` lists all codes")),
        None => diagnostic.help("`mechc explain` lists all codes"),
    }
}
