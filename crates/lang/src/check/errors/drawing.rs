//! Diagnostics of drawn poses, times and missing units.

use super::dimensions::{MOST_PLACES, format_value};
use super::list;
use crate::check::suggest::edits::{is_bare_number, with_factors};
use crate::model::Dimension;
use mechc_text::diag::{Applicability, Code, Diagnostic, Edit, Fix, readable};
use mechc_text::source::Span;

/// Gears whose drawn poses give no direction between their centres.
pub fn centers_coincide(circles: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0412, "the centres of these circles coincide as the bodies are drawn")
        .at(circles[1], "its centre is that of the other one")
        .also(circles[0], "the other one")
        .help("give the bodies poses in `at` that show in which direction one lies from the other")
}

/// A pinion whose drawn pose gives no side of its rack.
pub fn center_on_the_rack(arguments: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0412, "the centre of this pinion lies on the axis of its rack as the bodies are drawn")
        .at(arguments[0], "on neither side")
        .also(arguments[1], "of this axis")
        .help("give poses in `at` that show the side, or say it: `rack_pinion(c, a, phase, left)`")
}

pub fn side_without_phase(side: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("expected a phase before `{side}`"))
        .at(span, "the third argument is a length")
        .fix(Fix::insert(
            span,
            "0 mm, ",
            format!("write the phase too: `rack_pinion(c, a, 0 mm, {side})`"),
            Applicability::Probably,
        ))
}

/// Another formula where one of some words may stand, which say `what`.
pub fn no_word(words: &[&str], what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("expected {}", list(words).replace(" and ", " or "))).at(span, what)
}

pub fn step_not_positive(span: Span, value: f64) -> Diagnostic {
    let value = readable(value);
    Diagnostic::new(Code::E0407, format!("the analysis needs a positive step, it is {value} s"))
        .at(span, format!("{value} s"))
        .help("`every` is the time from one row to the next")
}

/// Takes the locations and texts of the start and the end.
pub fn ends_before_start(spans: [Span; 2], texts: [&str; 2], from: f64, to: f64) -> Diagnostic {
    let is_duration = to > 0.0;
    let after = readable(from + to);
    let [from, to] = [from, to].map(readable);
    let edit = |k: usize, text: &str| Edit { span: spans[k], text: text.to_owned() };
    let message = format!("the other way round: `from {to} s to {from} s`");
    let edits = vec![edit(0, texts[1]), edit(1, texts[0])];
    let reversed = Fix { message, edits, applies: Applicability::Probably };
    let unit = if texts.iter().all(|text| is_bare_number(text)) { "" } else { " s" };
    let end = Fix::replace(
        spans[1],
        format!("{after}{unit}"),
        format!("`to` is a time, and no duration: `from {from} s to {after} s`"),
        Applicability::Probably,
    );
    Diagnostic::new(Code::E0408, format!("the analysis ends at {to} s, before its start at {from} s"))
        .at(spans[1], "the end")
        .change(is_duration.then_some(end))
        .change(Some(reversed))
        .help(if is_duration {
            format!("`to` is a time, and no duration: `from {from} s to {after} s`; or the other way round: `from {to} s to {from} s`")
        } else {
            format!("the other way round: `from {to} s to {from} s`")
        })
}

pub fn empty_interval(function: &str, span: Span, ends: [f64; 2], dimension: Dimension) -> Diagnostic {
    let [from, to] = ends.map(|end| format_value(end, dimension));
    Diagnostic::new(
        Code::E0409,
        format!("`{function}` needs an interval that goes forward, this one is from {from} to {to}"),
    )
    .at(span, "the end of the interval")
    .help("the arguments are `(u, u0, v0, u1, v1)`, with `u0 < u1`")
}

pub fn too_large(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0410, "written out, this formula is too large")
        .at(span, "more than a million parts")
        .help("functions that call each other several times with different arguments multiply; name common parts")
}

/// `text` is that of the number.
pub fn degrees(span: Span, value: f64, text: &str) -> Diagnostic {
    let value = readable(value);
    let words = format!("write `{value} deg`, or `{value} rad` if radians are meant");
    let unit =
        |unit: &str| Fix::append(span, format!(" {unit}"), format!("write `{value} {unit}`"), Applicability::Probably);
    let is_bare = is_bare_number(text);
    Diagnostic::new(Code::W0401, format!("{value} rad is more than a turn; degrees were probably meant"))
        .at(span, "a bare number is in radians")
        .help(words)
        .change(is_bare.then(|| unit("deg")))
        .change(is_bare.then(|| unit("rad")))
}

/// A formula in the place of a direction; `angle` is the text of its angle, if it has one.
pub fn no_direction(span: Span, found: &str, angle: Option<&str>) -> Diagnostic {
    let pair = |angle: &str| format!("(cos({angle}), sin({angle}))");
    let fix = angle.map(|angle| {
        let message = format!("the direction of an angle is `{}`", pair(angle));
        Fix::replace(span, pair(angle), message, Applicability::Probably)
    });
    Diagnostic::new(Code::E0302, format!("expected a direction `(dx, dy)`, found {found}"))
        .at(span, format!("this is {found}"))
        .fix_if(fix)
}

/// A bare number next to a measure printed in a unit of angle. Takes the term, the number to which the unit is appended, and their texts.
pub fn number_as_radians(
    [term, number]: [Span; 2],
    [text, number_text]: [&str; 2],
    measure: Span,
    unit: &str,
) -> Diagnostic {
    let is_number = is_bare_number(number_text);
    let written = |unit: &str| {
        if is_number { format!("`{number_text} {unit}`") } else { format!("`({text}) * 1 {unit}`") }
    };
    let fix = |unit: &str| {
        let message = format!("write {}", written(unit));
        if is_number {
            Fix::append(number, format!(" {unit}"), message, Applicability::Probably)
        } else {
            with_factors(term, text, ["", &format!(" * 1 {unit}")], &message)
        }
    };
    let radians = if unit.contains('/') || unit == "rpm" { "rad/s" } else { "rad" };
    let diagnostic = Diagnostic::new(
        Code::W0401,
        format!("the bare number `{text}` is in {radians}, beside what is printed in {unit}"),
    )
    .at(term, format!("in {radians}"))
    .also(measure, format!("printed in {unit}"));
    let declared = (number != term).then_some(number);
    let diagnostic = declared.into_iter().fold(diagnostic, |diagnostic, number| diagnostic.also(number, "this number"));
    diagnostic
        .help(format!("write {}, or {} if radians are meant", written(unit), written(radians)))
        .change(Some(fix(unit)))
        .change(Some(fix(radians)))
}

/// A length without a unit.
#[derive(Clone, Copy)]
pub struct PlainLength<'a> {
    /// The magnitude (m).
    pub value: f64,
    pub span: Span,
    /// The parameter's name, if it is one.
    pub name: Option<&'a str>,
    /// True if it is a number to which a unit can be appended.
    pub is_number: bool,
}

/// Lengths without a unit in the order of the text, much larger than the largest one with a unit (m).
pub fn no_unit_of_length(lengths: &[PlainLength<'_>], largest: f64, unit: &str) -> Diagnostic {
    let taken = |plain: &PlainLength<'_>| format!("taken as {}", format_value(plain.value, Dimension::LENGTH));
    let first = &lengths[0];
    let (what, largest) = (
        first.name.map_or("a length".to_owned(), |name| format!("`{name}`")),
        format_value(largest, Dimension::LENGTH),
    );
    let message = format!("{what} has no unit and is {}; the largest length with a unit is {largest}", taken(first));
    let mut diagnostic = Diagnostic::new(Code::W0402, message).at(first.span, "no unit, so in metres");
    for plain in lengths.iter().skip(1).take(MOST_PLACES) {
        diagnostic = diagnostic.also(plain.span, taken(plain));
    }
    // The place of a unit in a formula is up to its author.
    let written = |unit: &str| match lengths {
        [only] if only.is_number => format!("`{} {unit}`", readable(only.value)),
        _ => format!("`{unit}` behind the numbers that have no unit"),
    };
    let numbers: Vec<Span> = lengths.iter().filter(|plain| plain.is_number).map(|plain| plain.span).collect();
    let with = |unit: &str| {
        let edit = |span: &Span| Edit { span: Span { start: span.end, ..*span }, text: format!(" {unit}") };
        let message = format!("write {}", written(unit));
        Fix { message, edits: numbers.iter().map(edit).collect(), applies: Applicability::Probably }
    };
    let can_be_written = !numbers.is_empty();
    diagnostic
        .help(format!("write {}; if metres are meant, `m`", written(unit)))
        .change(can_be_written.then(|| with(unit)))
        .change(can_be_written.then(|| with("m")))
}
