//! Diagnostics of derivatives by inputs and parameters.

use crate::model::Declared;
use mechc_syntax::ast::Name;
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::Span;

pub fn derivative_by_too_many(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "`der` by inputs and parameters is nested deeper than two")
        .at(span, "a third one")
        .help("two of them may be nested, with up to two time derivatives")
}

pub fn derivative_of_jerk(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "`der` by an input or parameter stands with more than two time derivatives")
        .at(span, "a third time derivative")
        .help("the derivative of an acceleration is the last that is computed")
}

/// A derivative of a force if a load holds a third time derivative.
pub fn derivative_through_a_jerk(span: Span, load: &Declared) -> Diagnostic {
    Diagnostic::new(
        Code::E0310,
        format!("forces have no derivatives by inputs and parameters beside load `{}`", load.name),
    )
    .at(span, "of a force")
    .also(load.span, "holds a third time derivative")
    .help("the derivative of an acceleration is the last that is computed")
}

pub fn not_a_variable(span: Span, found: &str) -> Diagnostic {
    super::wrong_kind(span, "the name of an input or parameter", found)
        .help("`der(e, NAME)` is the derivative of e by what is called NAME; `der(e)` is the one by time")
}

pub fn by_time(name: &Name) -> Diagnostic {
    super::wrong_kind(name.span, "the name of an input or parameter", "the time")
        .help("`der(e)` is the derivative by time")
}

pub fn by_point(name: &Name, span: Span) -> Diagnostic {
    super::wrong_kind(span, "the name of a number", "a point")
        .help(format!("a derivative is taken by one of its coordinates: `{0}.x`, `{0}.y`", name.text))
}

pub fn by_deciding(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("there is no derivative by `{}`, which decides what is repeated", name.text))
        .at(name.span, "a whole number of declarations hangs on it")
        .help("run it with another value: `--set`")
}

/// `--by` with a parameter that determines repetitions.
pub fn column_by_deciding(name: &str) -> Diagnostic {
    Diagnostic::new(Code::E0706, format!("there is no derivative by `{name}`, which decides what is repeated"))
        .help("run it with another value: `--set`")
}

/// `--by` without a variable: `found` is the kind of the name, `suggestion` a suggestion, `candidates` the variables.
pub fn no_column_by(
    mechanism: &str,
    name: &str,
    found: Option<&str>,
    suggestion: Option<&str>,
    candidates: &[&str],
) -> Diagnostic {
    let message = match found {
        None => format!("mechanism `{mechanism}` has no input or parameter `{name}`"),
        Some(found) => format!("`{name}` is {found} of mechanism `{mechanism}`, and no input or parameter"),
    };
    let help = suggestion.map(|name| format!("was `{name}` meant?"));
    let listed = || match candidates {
        [] => "derivatives are taken by inputs and parameters, and there are none".to_owned(),
        _ => format!("derivatives are taken by {}", super::some_of(candidates)),
    };
    Diagnostic::new(Code::E0703, message).help(help.unwrap_or_else(listed))
}

/// `der(e, front.reach)` with `front: lever(reach = …)`, and the names in that formula.
pub fn by_bound(span: Span, path: &str, binding: Span, made_of: &[String]) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("`{path}` is bound where its mechanism is used"))
        .at(span, "not free")
        .also(binding, "bound here")
        .help(free_instead(made_of))
}

/// `--by front.reach` with such a binding.
pub fn column_by_bound(path: &str, binding: Span, made_of: &[String]) -> Diagnostic {
    Diagnostic::new(
        Code::E0708,
        format!("there is no derivative by `{path}`, which is bound where its mechanism is used"),
    )
    .at(binding, "bound here")
    .help(free_instead(made_of))
}

fn free_instead(made_of: &[String]) -> String {
    let names: Vec<&str> = made_of.iter().map(String::as_str).collect();
    match names.as_slice() {
        [] => "its binding names no param or input: take the binding away, or make it of a param".to_owned(),
        names => format!("take the derivative by what the binding is made of: {}", super::list(names)),
    }
}

/// `--by` with a part; `free` are its params and inputs that are not bound.
pub fn column_by_part(path: &str, free: &[String]) -> Diagnostic {
    let names: Vec<&str> = free.iter().map(String::as_str).take(MOST_NAMES).collect();
    let more = if free.len() > names.len() { ", for example" } else { "" };
    let help = match names.as_slice() {
        [] => "all that it has is bound".to_owned(),
        names => format!("derivatives are taken by one of its params or inputs{more}: {}", super::list(names)),
    };
    Diagnostic::new(Code::E0703, format!("`{path}` is a part, and no input or parameter")).help(help)
}

/// The largest number of listed names.
const MOST_NAMES: usize = 8;
