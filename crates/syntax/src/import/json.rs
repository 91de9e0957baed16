//! JSON to values with their places.

use super::errors;
use super::value::{Grammar, Kind, Quoted, Rule, Value};
use crate::DEEPEST;
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Sources, Span};
use pest::Parser;
use pest::iterators::Pair;

/// Returns the value that a file holds.
///
/// # Errors
/// The first fault: nested too deep, or no JSON.
pub(super) fn read(file: FileId, sources: &Sources) -> Result<Value, Box<Diagnostic>> {
    let text = &sources.get(file).text;
    measure(text, file)?;
    let mut pairs =
        Grammar::parse(Rule::document, text).map_err(|error| Box::new(errors::not_json(&error, text, file)))?;
    let value = pairs.next().and_then(|document| document.into_inner().next());
    value.map_or_else(|| Err(Box::new(errors::empty_file(sources.end_of(file)))), |pair| build(&pair, file))
}

/// Refuses a text that nests deeper than [`DEEPEST`], before anything recurses.
fn measure(text: &str, file: FileId) -> Result<(), Box<Diagnostic>> {
    let mut depth = 0_usize;
    let (mut in_string, mut escaped) = (false, false);
    for (at, byte) in text.bytes().enumerate() {
        if in_string {
            // a string ends on its line, or is no string
            in_string = byte != b'\n' && (escaped || byte != b'"');
            escaped = byte == b'\\' && !escaped;
            continue;
        }
        match byte {
            b'"' => (in_string, escaped) = (true, false),
            b'[' | b'{' | b'(' => depth += 1,
            b']' | b'}' | b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let span = Span { file, start: at as u32, end: at as u32 + 1 };
            return Err(Box::new(errors::file_too_deep(span)));
        }
    }
    Ok(())
}

fn build(pair: &Pair<'_, Rule>, file: FileId) -> Result<Value, Box<Diagnostic>> {
    let span = span_of(pair, file);
    let kind = match pair.as_rule() {
        Rule::object => {
            let members = pair.clone().into_inner().filter(|inner| inner.as_rule() == Rule::member);
            Kind::Object(members.filter_map(|inner| member(inner, file).transpose()).collect::<Result<_, _>>()?)
        }
        Rule::list => {
            let values = pair.clone().into_inner().filter(|inner| !is_mark(inner.as_rule()));
            Kind::List(values.map(|inner| build(&inner, file)).collect::<Result<_, _>>()?)
        }
        Rule::string => Kind::Text(text(pair, file)),
        Rule::word if pair.as_str() == "null" => Kind::Null,
        Rule::word => Kind::Bool,
        _ => {
            let number = sum(pair.clone());
            if !number.is_finite() {
                return Err(Box::new(errors::number_not_finite(span)));
            }
            Kind::Number(number)
        }
    };
    Ok(Value { span, kind })
}

/// Returns a pair's place, without the white space that the parser may have taken in behind it.
fn span_of(pair: &Pair<'_, Rule>, file: FileId) -> Span {
    let start = pair.as_span().start();
    let end = start + pair.as_str().trim_end().len();
    Span { file, start: start as u32, end: end as u32 }
}

fn is_mark(rule: Rule) -> bool {
    matches!(rule, Rule::comma | Rule::colon | Rule::close | Rule::right | Rule::right_paren | Rule::EOI)
}

fn member(pair: Pair<'_, Rule>, file: FileId) -> Result<Option<(Quoted, Value)>, Box<Diagnostic>> {
    let mut parts = pair.into_inner().filter(|part| !is_mark(part.as_rule()));
    match (parts.next(), parts.next()) {
        (Some(key), Some(value)) => Ok(Some((text(&key, file), build(&value, file)?))),
        _ => Ok(None),
    }
}

/// Returns the value of `a + b * c …`; products before sums, each from the left.
fn sum(pair: Pair<'_, Rule>) -> f64 {
    let (mut total, mut product): (f64, Option<f64>) = (0.0, None);
    let (mut operator, mut sign) = ("+", 1.0);
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::sign => sign = if part.as_str() == "-" { -sign } else { sign },
            Rule::operator => operator = part.as_str(),
            Rule::number | Rule::paren => {
                let value = sign * operand(part);
                sign = 1.0;
                product = Some(match (operator, product) {
                    ("*", Some(before)) => before * value,
                    ("/", Some(before)) => before / value,
                    (_, before) => {
                        total += before.unwrap_or(0.0);
                        if operator == "-" { -value } else { value }
                    }
                });
            }
            _ => {}
        }
    }
    total + product.unwrap_or(0.0)
}

fn operand(pair: Pair<'_, Rule>) -> f64 {
    if pair.as_rule() == Rule::number {
        return pair.as_str().parse().unwrap_or(f64::NAN);
    }
    pair.into_inner().find(|inner| inner.as_rule() == Rule::arithmetic).map_or(f64::NAN, sum)
}

/// Decodes the escapes.
fn text(pair: &Pair<'_, Rule>, file: FileId) -> Quoted {
    let span = span_of(pair, file);
    let written = pair.as_str().get(1..pair.as_str().len().saturating_sub(1)).unwrap_or("");
    if !written.contains('\\') {
        return Quoted { text: written.to_owned(), span, places: Vec::new() };
    }
    let mut decoded = Quoted { text: String::new(), span, places: Vec::new() };
    let mut rest = written;
    while let Some((character, length)) = next_character(rest) {
        let place = span.start + 1 + (written.len() - rest.len()) as u32;
        decoded.places.extend(std::iter::repeat_n(place, character.len_utf8()));
        decoded.text.push(character);
        rest = rest.get(length..).unwrap_or("");
    }
    decoded.places.push(span.end.saturating_sub(1));
    decoded
}

/// Returns the character that a text begins with, and how many bytes it takes there.
fn next_character(text: &str) -> Option<(char, usize)> {
    let mut characters = text.chars();
    let first = characters.next()?;
    if first != '\\' {
        return Some((first, first.len_utf8()));
    }
    let character = match characters.next()? {
        'b' => '\u{8}',
        'f' => '\u{c}',
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        'u' => return Some(code_point(text)),
        other => other,
    };
    Some((character, 2))
}

/// Returns the character of `\u0074`, or of a pair of surrogates; half a pair stands for no character.
fn code_point(text: &str) -> (char, usize) {
    let unit = |at: usize| {
        let digits = text.get(at..at + 6).and_then(|escape| escape.strip_prefix("\\u"))?;
        u32::from_str_radix(digits, 16).ok()
    };
    let first = unit(0).unwrap_or(0xfffd);
    if let (0xd800..0xdc00, Some(second @ 0xdc00..0xe000)) = (first, unit(6)) {
        let both = 0x10000 + ((first - 0xd800) << 10) + (second - 0xdc00);
        return (char::from_u32(both).unwrap_or('\u{fffd}'), 12);
    }
    (char::from_u32(first).unwrap_or('\u{fffd}'), 6)
}
