//! Diagnostics of repeated declarations and of their copies.

use mechc_syntax::ast::{Name, PathSegment};
use mechc_syntax::format::expression;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix, readable};
use mechc_text::source::Span;
use mechc_text::vocabulary::Unit;

/// Adds `for k = 2`, the copy in which the error is.
fn of_copy(diagnostic: Diagnostic, numbers: &[(&str, i64)]) -> Diagnostic {
    if numbers.is_empty() {
        return diagnostic;
    }
    let numbers: Vec<String> = numbers.iter().map(|(index, k)| format!("`{index}` = {k}")).collect();
    diagnostic.note(format!("for {}", numbers.join(", ")))
}

pub fn not_whole(place: &str, span: Span, value: f64, numbers: &[(&str, i64)]) -> Diagnostic {
    let value = readable(value);
    let diagnostic = Diagnostic::new(Code::E0208, format!("{place} must be a whole number, it is {value}"));
    of_copy(diagnostic.at(span, value), numbers)
}

pub fn no_such_copy(copy: &str, span: Span, ends: [Option<String>; 2], numbers: &[(&str, i64)]) -> Diagnostic {
    let candidates = match ends {
        [Some(first), Some(last)] => format!("they go from `{first}` to `{last}`"),
        _ => "its range is empty".to_owned(),
    };
    of_copy(Diagnostic::new(Code::E0208, format!("there is no `{copy}`")).at(span, candidates), numbers)
}

pub fn which_copy(name: &Name, first: Option<&str>) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0208, format!("`{}` is repeated: this does not say which one", name.text));
    let help = first.map(|first| format!("write its number behind it: `{first}`"));
    diagnostic.at(name.span, "one of several").help_if(help)
}

pub fn not_repeated(name: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0208, format!("`{}` is not repeated, there is only one", name.text))
        .at(name.span, "takes no number in brackets")
        .help("what is repeated is declared with a range: `body link[k in 0..3] …`")
}

/// `arm.tip.x`, or an index after a declaration that is not repeated; `is_declared` if the first name is declared.
pub fn invalid_path(span: Span, segments: &[PathSegment], is_declared: bool) -> Diagnostic {
    match segments {
        [owner, point, coordinate] if ["x", "y"].contains(&coordinate.name.text.as_str()) => {
            let indices: Vec<String> = owner.indices.iter().map(expression).collect();
            let brackets = if indices.is_empty() { String::new() } else { format!("[{}]", indices.join(", ")) };
            let text = format!("{}({}{brackets}.{})", coordinate.name.text, owner.name.text, point.name.text);
            let message = format!("a coordinate of a point is written `{text}`");
            Diagnostic::new(Code::E0302, "expected a number, found a path that goes on behind a point")
                .at(span, "a body has points, and they have nothing of their own")
                .fix(Fix::replace(span, text, message, Applicability::Probably))
        }
        [_, _, _, ..] => Diagnostic::new(Code::E0208, "a path is a body, and a feature of it")
            .at(span, "goes on")
            .help("the number stands behind what is repeated: `link[2].pin`"),
        [_, feature] if !feature.indices.is_empty() => {
            Diagnostic::new(Code::E0208, format!("`{}` is not repeated, there is only one", feature.name.text))
                .at(feature.name.span, "takes no number in brackets")
                .help("a body is repeated with all its features, and the number stands behind it: `link[2].pin`")
        }
        [owner, ..] if is_declared => not_repeated(&owner.name),
        _ => Diagnostic::new(Code::E0208, "nothing of this name is repeated")
            .at(span, "this takes one of several")
            .help("what is repeated is declared with a range: `body link[k in 0..3] …`"),
    }
}

/// An index with the name of something else; `free` are words that nothing has as its name.
pub fn index_is_taken(name: &Name, free: &[&str]) -> Diagnostic {
    let examples: Vec<String> = free.iter().map(|word| format!("`{word}`")).collect();
    let examples = if examples.is_empty() { String::new() } else { format!(": {}", examples.join(", ")) };
    let message = match Unit::named(&name.text) {
        Some(_) => format!("the index `{}` has the name of a unit", name.text),
        None => format!("the index `{}` hides what has that name already", name.text),
    };
    Diagnostic::new(Code::E0207, message)
        .at(name.span, "not free")
        .help(format!("choose a name that nothing else has{examples}"))
}

pub fn too_many_indices(span: Span, most: usize) -> Diagnostic {
    Diagnostic::new(Code::E0208, format!("a declaration has {most} indices at the most")).at(span, "one more")
}

pub fn too_many_declarations(span: Span, most: usize, label: &str) -> Diagnostic {
    Diagnostic::new(Code::E0208, format!("written out, the mechanism has more than {most} declarations"))
        .at(span, label)
}
