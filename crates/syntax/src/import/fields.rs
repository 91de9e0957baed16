//! Typed access to keys of JSON objects: numbers, vectors, strings. Each mistake is reported once, with its span, and reading continues.

use super::errors;
use super::value::{Kind, Quoted, Value};
use mechc_text::diag::{Diagnostic, Diagnostics, readable};
use mechc_text::source::Span;

/// An object whose keys are asked for.
pub(super) struct Fields<'a> {
    object: &'a Value,
    /// Description for messages: "constraint `rev`".
    what: String,
    /// Span for messages about missing keys: a word of the object rather than all its lines.
    place: Span,
}

/// A number with its place.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Number {
    pub value: f64,
    pub span: Span,
}

/// Several numbers with the place of them all.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Vector<const N: usize> {
    pub values: [f64; N],
    pub span: Span,
}

impl<'a> Fields<'a> {
    pub fn new(object: &'a Value, what: impl Into<String>, place: Span) -> Fields<'a> {
        Fields { object, what: what.into(), place }
    }

    /// Returns a required value, or reports its absence.
    pub fn required(&self, key: &str, help: &str, diagnostics: &mut Diagnostics) -> Option<&'a Value> {
        let value = self.object.get(key);
        if value.is_none() {
            diagnostics.push(errors::missing(&self.what, key, self.place, help));
        }
        value
    }

    pub fn number(&self, key: &str, diagnostics: &mut Diagnostics) -> Option<Number> {
        let value = self.required(key, &format!("`\"{key}\": …`, a number"), diagnostics)?;
        let Kind::Number(number) = value.kind else {
            diagnostics.push(errors::wrong_type(key, "a number", value));
            return None;
        };
        Some(Number { value: number, span: value.span })
    }

    /// Returns a number that must hold a condition.
    pub fn number_with(
        &self,
        key: &str,
        (holds, wanted): (impl Fn(f64) -> bool, &str),
        diagnostics: &mut Diagnostics,
    ) -> Option<Number> {
        let number = self.number(key, diagnostics)?;
        if !holds(number.value) {
            let message = format!("`{key}` must be {wanted}, it is {}", readable(number.value));
            diagnostics.push(errors::fault(number.span, message, format!("expected {wanted}")));
            return None;
        }
        Some(number)
    }

    pub fn vector<const N: usize>(&self, key: &str, example: &str, diagnostics: &mut Diagnostics) -> Option<Vector<N>> {
        let value = self.required(key, &format!("`\"{key}\": {example}`"), diagnostics)?;
        let wanted = format!("a list of {N} numbers");
        let Kind::List(list) = &value.kind else {
            diagnostics.push(errors::wrong_type(key, &wanted, value));
            return None;
        };
        let mut sound = true;
        let mut numbers = Vec::new();
        for item in list {
            if let Kind::Number(number) = item.kind {
                // −0 and 0 are one place
                numbers.push(number + 0.0);
            } else {
                diagnostics.push(errors::wrong_type(key, &wanted, item));
                sound = false;
            }
        }
        if !sound {
            return None;
        }
        let values = <[f64; N]>::try_from(numbers).ok();
        if values.is_none() {
            let message = format!("`{key}` must be {wanted}, found {}", list.len());
            diagnostics.push(errors::fault(value.span, message, format!("expected {wanted}")));
        }
        Some(Vector { values: values?, span: value.span })
    }

    pub fn text(&self, key: &str, help: &str, diagnostics: &mut Diagnostics) -> Option<&'a Quoted> {
        let value = self.required(key, help, diagnostics)?;
        if let Kind::Text(text) = &value.kind {
            return Some(text);
        }
        let quoted = match value.kind {
            Kind::Number(number) => Some(format!("write it in quotes: `\"{key}\": \"{number}\"`")),
            _ => None,
        };
        diagnostics.push(errors::wrong_type(key, "a string", value).help_if(quoted));
        None
    }

    /// Returns a required list, or reports its absence.
    pub fn list(&self, key: &str, diagnostics: &mut Diagnostics) -> Option<&'a [Value]> {
        let value = self.required(key, &format!("`\"{key}\": […]`"), diagnostics)?;
        if let Kind::List(list) = &value.kind {
            return Some(list);
        }
        diagnostics.push(errors::wrong_type(key, "a list", value));
        None
    }
}

/// Returns a `name` that may be missing but not of another type.
pub(super) fn name_of<'a>(object: &'a Value, diagnostics: &mut Diagnostics) -> Option<&'a Quoted> {
    let value = object.get("name")?;
    if let Kind::Text(text) = &value.kind {
        return Some(text);
    }
    diagnostics.push(errors::wrong_type("name", "a string", value));
    None
}

/// Returns a word of an object to point at: its name, else its first key, else its opening brace.
pub(super) fn location_of(object: &Value) -> Span {
    match &object.kind {
        Kind::Object(members) => {
            let name = members.iter().find(|(key, value)| key.text == "name" && matches!(value.kind, Kind::Text(_)));
            let first = name.map(|(_, value)| value.span).or_else(|| members.first().map(|(key, _)| key.span));
            first.unwrap_or(object.span)
        }
        _ => object.span,
    }
}

/// Says of a list's items that are no objects that they should be, and gives the others.
pub(super) fn objects<'a>(key: &str, list: &'a [Value], diagnostics: &mut Diagnostics) -> Vec<&'a Value> {
    let (objects, others): (Vec<_>, Vec<_>) = list.iter().partition(|item| matches!(item.kind, Kind::Object(_)));
    let faults = others.into_iter().map(|other| errors::wrong_type(key, "a list of objects", other));
    diagnostics.extend(faults.collect::<Vec<Diagnostic>>());
    objects
}
