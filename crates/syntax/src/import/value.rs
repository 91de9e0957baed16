//! A model file as values with their places, and the grammar of it, `grammar/adm.pest`.
//!
//! A value is data and nothing else: what a key means is for `fields` to ask.

pub(super) use grammar::{Grammar, Rule};
use mechc_text::source::Span;

/// The generated parser, in a module of its own because its items carry no documentation.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/adm.pest"]
    pub struct Grammar;
}

/// A value with its place.
#[derive(Debug)]
pub(super) struct Value {
    pub span: Span,
    pub kind: Kind,
}

/// Kinds of values.
#[derive(Debug)]
pub(super) enum Kind {
    Null,
    Bool,
    Number(f64),
    Text(Quoted),
    List(Vec<Value>),
    Object(Vec<(Quoted, Value)>),
}

/// A decoded string, with the position of each of its bytes in the file.
#[derive(Clone, Debug)]
pub(super) struct Quoted {
    pub text: String,
    /// Span with its quotes.
    pub span: Span,
    /// Offset in the file of each byte of the text and of its end; empty if the text has no escapes.
    pub places: Vec<u32>,
}

impl Quoted {
    /// Returns the span of a range of the text.
    pub fn place(&self, start: usize, end: usize) -> Span {
        let offset = |at: usize| match self.places.get(at) {
            Some(&place) => place,
            None => (self.span.start + 1 + at as u32).min(self.span.end),
        };
        Span { file: self.span.file, start: offset(start), end: offset(end) }
    }
}

impl Value {
    /// Returns a key's value, the last one if it is repeated; `None` if this is no object or lacks the key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.member(key).map(|(_, value)| value)
    }

    /// Returns a key with its value.
    pub fn member(&self, key: &str) -> Option<&(Quoted, Value)> {
        match &self.kind {
            Kind::Object(members) => members.iter().rev().find(|(name, _)| name.text == key),
            _ => None,
        }
    }

    /// Returns the kind of the value for messages, with its article: `a number`.
    pub fn describe(&self) -> &'static str {
        match &self.kind {
            Kind::Null => "`null`",
            Kind::Bool => "a truth value",
            Kind::Number(_) => "a number",
            Kind::Text(_) => "a string",
            Kind::List(_) => "a list",
            Kind::Object(_) => "an object",
        }
    }
}
