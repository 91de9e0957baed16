//! Diagnostics of mechanisms.

mod dimensions;
mod drawing;
mod forces;
pub mod library;
mod misplaced;
mod names;
mod parts;
mod points;
mod repetition;
mod reporter;
mod results;
mod tables;
mod variables;

pub use dimensions::*;
pub use drawing::*;
pub use forces::*;
pub use misplaced::*;
pub use names::*;
pub use parts::*;
pub use points::*;
pub use repetition::*;
pub use reporter::Reporter;
pub use results::{
    REDUCES, derivative_of_result, equal_without_tolerance, negative_tolerance, no_bound, outside_reduction,
    reduction_in, requirement_of_both, result_in, signed_bound, tolerance_of_no_equality, variation_of_result,
    window_ends_early, window_of_no_reduction,
};
pub use tables::*;
pub use variables::*;

use mechc_syntax::ast::Name;
use mechc_text::diag::{Code, Diagnostic, Fix, nearest};
use mechc_text::source::Span;
use mechc_text::vocabulary::Word;

fn nearest_name(expected: &Name, names: &[&str]) -> Option<Fix> {
    nearest(&expected.text, names.iter().copied()).map(|name| Fix::suggest(expected.span, name))
}

/// `word` is given for words of the language.
pub fn argument_count(what: &str, word: Option<&Word>, span: Span, expected: &str, found: usize) -> Diagnostic {
    Diagnostic::new(Code::E0301, format!("`{what}` takes {expected}, found {found}"))
        .at(span, format!("found {found}"))
        .help_if(word.map(|word| format!("it is written {}", word.written())))
}

pub fn wrong_kind(span: Span, expected: &str, found: &str) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("expected {expected}, found {found}")).at(span, format!("this is {found}"))
}

pub fn empty(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0501, format!("mechanism `{}` has no body that could move", name.text))
        .at(name.span, "empty")
        .help("declare a body: `body crank at (0, 0, 0) { … }`")
}

/// Lists as many names as a message has room for.
fn some_of(names: &[&str]) -> String {
    const MOST: usize = 24;
    match names.get(..MOST) {
        Some(first) if names.len() > MOST => format!("{}, … ({} in all)", first.join(", "), names.len()),
        _ => names.join(", "),
    }
}

/// Lists names as `a`, `b` and `c`.
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}
