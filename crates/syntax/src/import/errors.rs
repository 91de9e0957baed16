//! Diagnostics for a model file that cannot be translated, and for what its translation changed or left out.

use super::value::{Rule, Value};
use crate::DEEPEST;
use mechc_text::diag::{Code, Diagnostic, nearest, readable};
use mechc_text::source::{FileId, Span};
use pest::error::{Error, ErrorVariant, InputLocation};

/// Reports a fault at a span, with a label.
pub(super) fn fault(span: Span, message: impl Into<String>, label: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::E0707, message).at(span, label)
}

// ---- no JSON

pub(super) fn empty_file(span: Span) -> Diagnostic {
    fault(span, "the file is empty", "the file ends here").help("a model is a JSON object: `{\"name\": …}`")
}

pub(super) fn file_too_deep(span: Span) -> Diagnostic {
    fault(span, format!("the file nests deeper than {DEEPEST}"), "one level too many")
}

pub(super) fn number_not_finite(span: Span) -> Diagnostic {
    fault(span, "this number is not finite", "not finite")
}

/// Reports a text that the parser of JSON rejects.
pub(super) fn not_json(error: &Error<Rule>, text: &str, file: FileId) -> Diagnostic {
    let offset = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    let rest = text.get(offset..).unwrap_or("");
    let found = rest.trim_start();
    let start = offset + rest.len() - found.len();
    if text.trim().is_empty() {
        return empty_file(Span { file, start: start as u32, end: start as u32 });
    }
    if found.starts_with('"')
        && let Some(broken) = broken_string(found, start, file)
    {
        return broken;
    }
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let length = match found.chars().next() {
        None => 0,
        Some(c) if is_word(c) => found.find(|c| !is_word(c)).unwrap_or(found.len()),
        Some(c) => c.len_utf8(),
    };
    let word = found.get(..length).unwrap_or("");
    let span = Span { file, start: start as u32, end: (start + length) as u32 };
    let expected = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => expectation(positives),
        ErrorVariant::CustomError { message } => message.clone(),
    };
    let shown = if word.is_empty() { "the end of the file".to_owned() } else { format!("`{word}`") };
    fault(span, format!("expected {expected}, found {shown}"), format!("expected {expected}"))
        .help_if(suggestion(word, text, start))
}

/// Reports a string that does not end, or that has an invalid escape.
fn broken_string(text: &str, start: usize, file: FileId) -> Option<Diagnostic> {
    let span = |from: usize, length: usize| {
        let start = (start + from) as u32;
        Span { file, start, end: start + length as u32 }
    };
    let mut characters = text.char_indices().skip(1);
    while let Some((at, c)) = characters.next() {
        match c {
            '"' => return None,
            '\n' | '\r' => break,
            '\\' => {
                let (_, escaped) = characters.next()?;
                let digits = text.get(at + 2..at + 6).unwrap_or("");
                let has_digits = digits.len() == 4 && digits.bytes().all(|b| b.is_ascii_hexdigit());
                if !"\"\\/bfnrtu".contains(escaped) || escaped == 'u' && !has_digits {
                    let help = "a backslash itself is written `\\\\`";
                    let length = 1 + escaped.len_utf8();
                    return Some(fault(span(at, length), "an unknown escape in a string", "no escape").help(help));
                }
            }
            _ => {}
        }
    }
    let help = "a string ends with `\"` on the line where it begins";
    Some(fault(span(0, 1), "a string does not end", "it begins here").help(help))
}

fn expectation(rules: &[Rule]) -> String {
    let mut words: Vec<&str> = Vec::new();
    for rule in rules {
        let word = match rule {
            Rule::document | Rule::object | Rule::list | Rule::word | Rule::arithmetic => "a value",
            // any value may stand there
            Rule::string | Rule::number | Rule::paren | Rule::sign if rules.contains(&Rule::list) => "",
            Rule::string | Rule::member => "a name in quotes",
            Rule::number | Rule::paren | Rule::sign => "a number",
            Rule::comma => "`,`",
            Rule::colon => "`:`",
            Rule::close => "`}`",
            Rule::right => "`]`",
            Rule::right_paren => "`)`",
            Rule::EOI => "the end of the file",
            _ => "",
        };
        if !word.is_empty() && !words.contains(&word) {
            words.push(word);
        }
    }
    let last = words.pop().unwrap_or("a value");
    if words.is_empty() { last.to_owned() } else { format!("{} or {last}", words.join(", ")) }
}

fn suggestion(found: &str, text: &str, at: usize) -> Option<String> {
    let before = text.get(..at).unwrap_or("").trim_end();
    let help = if matches!(found, "]" | "}") && before.ends_with(',') {
        "the last `,` is one too many"
    } else if found == "'" {
        "strings stand in double quotes"
    } else if found == "/" {
        "JSON has no comments"
    } else {
        return None;
    };
    Some(help.to_owned())
}

// ---- keys and values

/// Reports a value of the wrong type.
pub(super) fn wrong_type(key: &str, expected: &str, found: &Value) -> Diagnostic {
    let message = format!("`{key}` must be {expected}, found {}", found.describe());
    fault(found.span, message, format!("expected {expected}"))
}

/// Reports a missing key.
pub(super) fn missing(what: &str, key: &str, place: Span, help: &str) -> Diagnostic {
    fault(place, format!("{what} has no `{key}`"), format!("`{key}` is missing")).help(format!("add {help}"))
}

pub(super) fn unknown_type(name: &str, span: Span, types: &[&str]) -> Diagnostic {
    let help = match nearest(name, types.iter().copied()) {
        Some(near) => format!("was `{near}` meant?"),
        None => format!("the types are {}", types.join(", ")),
    };
    fault(span, format!("an unknown type of constraint: `{name}`"), "unknown").help(help)
}

pub(super) fn no_such_body(key: &str, number: f64, span: Span, count: usize) -> Diagnostic {
    let there = match count {
        0 => "there are no bodies".to_owned(),
        1 => "there is 1 body".to_owned(),
        _ => format!("there are {count} bodies"),
    };
    fault(span, format!("`{key}` is {}, and {there}", readable(number)), "no such body")
        .help("a body is named by its position in the list of bodies, from 1")
}

pub(super) fn with_itself(name: &str, first: Span, second: Span) -> Diagnostic {
    fault(second, format!("constraint `{name}` joins a body with itself"), "the same body").also(first, "this body")
}

// ---- formulas

/// Reports a formula that is too deep or too large for the language.
pub(super) fn formula_too_deep(span: Span) -> Diagnostic {
    fault(span, format!("the formula nests deeper than {DEEPEST}"), "one level too many")
}

pub(super) fn formula_too_large(span: Span) -> Diagnostic {
    fault(span, "written out, this formula is too large", "here it grows")
        .help("functions like `floor` and `round` name their argument twice; nest fewer of them")
}

// ---- notes on a translation that succeeded

/// Reports a name that had to be changed.
pub(super) fn renamed(what: &str, old: &str, new: &str, span: Span, why: &str) -> Diagnostic {
    Diagnostic::new(Code::N0702, format!("the {what} `{old}` is called `{new}`")).at(span, why)
}

/// Reports that an item without a name got one.
pub(super) fn named(what: &str, new: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::N0702, format!("the {what} without a name is called `{new}`")).at(span, "it has no `name`")
}

/// Reports what a kinematic model does not support.
pub(super) fn left_behind(what: &[String], places: Vec<Span>) -> Diagnostic {
    let listed = match what.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    };
    let note = Diagnostic::new(Code::N0701, format!("not carried over: {listed}"))
        .note("they do not enter into a kinematic analysis");
    places.into_iter().fold(note, |note, span| note.at(span, "left out"))
}

/// Reports a settings file that asks for dynamics.
pub(super) fn only_kinematics(span: Span) -> Diagnostic {
    Diagnostic::new(Code::N0701, "only the kinematics will be analysed, not the dynamics").at(span, "asks for dynamics")
}
