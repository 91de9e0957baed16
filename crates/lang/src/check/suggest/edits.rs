//! Edits that correct a dimension or a name.

use mechc_syntax::ast::{Expr, Name};
use mechc_text::diag::{Applicability, Edit, Fix};
use mechc_text::source::Span;

/// Returns whether a text is only a number.
pub(in crate::check) fn is_bare_number(text: &str) -> bool {
    text.parse::<f64>().is_ok()
}

/// Suggests a unit after a bare number.
pub(in crate::check) fn with_unit(span: Span, text: &str, unit: &str) -> Option<Fix> {
    let words = format!("a unit is missing: `{text} {unit}`");
    is_bare_number(text).then(|| Fix::append(span, format!(" {unit}"), words, Applicability::Probably))
}

/// Suggests factors before and after a formula, with parentheses around it where necessary.
pub(in crate::check) fn with_factors(span: Span, text: &str, [before, behind]: [&str; 2], words: &str) -> Fix {
    let is_sum = text.contains(['+', '-']) || text.starts_with("if");
    let [open, close] = if is_sum { ["(", ")"] } else { ["", ""] };
    let edit = |at: u32, text: String| Edit { span: Span { start: at, end: at, ..span }, text };
    let edits = vec![edit(span.start, format!("{before}{open}")), edit(span.end, format!("{close}{behind}"))];
    let edits = edits.into_iter().filter(|edit| !edit.text.is_empty()).collect();
    Fix { message: words.to_owned(), edits, applies: Applicability::Probably }
}

/// Suggests another name at a declaration and its uses.
pub(in crate::check) fn suggest_rename(name: &Name, uses: &[Span], free: &str, message: String) -> Fix {
    let places = std::iter::once(&name.span).chain(uses);
    let edits = places.map(|&span| Edit { span, text: free.to_owned() }).collect();
    Fix { message, edits, applies: Applicability::Probably }
}

/// Suggests the missing angle of `at (0, 0)`.
pub(in crate::check) fn suggest_pose_angle(parts: &[Expr]) -> Option<Fix> {
    let [_, y] = parts else { return None };
    Some(Fix::append(y.span, ", 0 deg", "a pose has an angle too: `at (x, y, 0 deg)`", Applicability::Probably))
}
