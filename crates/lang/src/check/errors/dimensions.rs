//! Diagnostics of dimensions, units and values.

use crate::check::suggest::edits::{is_bare_number, with_factors, with_unit};
use crate::check::suggest::lost_rate::{Part, polar, suggest_rate_unit};
use crate::model::Dimension;
use mechc_syntax::ast::Name;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix, readable};
use mechc_text::source::Span;

/// The largest number of locations of one kind after the first one.
pub(super) const MOST_PLACES: usize = 4;

/// The text of a term is shown if it is a bare number. A factor is suggested if the second term can take it.
pub fn unlike(
    what: &str,
    [first, second]: [Part; 2],
    texts: [&str; 2],
    has_time: bool,
    takes_factor: bool,
) -> Diagnostic {
    let [one, other] = [(first, texts[0]), (second, texts[1])];
    let fix = [(one, other), (other, one)].into_iter().find_map(|((one, text), (other, other_text))| {
        if !one.dimension.is(Dimension::PURE) {
            return None;
        }
        if is_bare_number(text) {
            return with_unit(one.span, text, &usual_unit(other.dimension));
        }
        let words = "a rate times a time is a pure number, as an angle is: `… * t`";
        other.dimension.is(Dimension::RATE).then(|| with_factors(other.span, other_text, ["", " * t"], words))
    });
    let mended = suggest_rate_unit(first.dimension, second, texts[1])
        .or_else(|| suggest_rate_unit(second.dimension, first, texts[0]));
    let upside_down =
        || unit_above(first.dimension, second, texts[1]).or_else(|| unit_above(second.dimension, first, texts[0]));
    let fix = mended.filter(|_| has_time).or_else(upside_down).or(fix);
    let fix = fix.or_else(|| scaled(first.dimension, second, texts[1]).filter(|_| takes_factor));
    let polar = polar(first, second, texts).filter(|_| what.starts_with("the coordinates"));
    // The fix is only an explanation if time is not allowed.
    let is_factor = fix.as_ref().is_some_and(|fix| fix.message.ends_with("t`"));
    let (fix, help) = if is_factor && !has_time { (None, fix.map(|fix| fix.message)) } else { (fix, None) };
    Diagnostic::new(Code::E0401, format!("{what} {} and {}", first.dimension.in_words(), second.dimension.in_words()))
        .at(second.span, second.dimension.in_words())
        .also(first.span, first.dimension.in_words())
        .fix_if(fix)
        .help_if(help)
        .help_if(polar)
}

/// Suggests a unit for `1/3 s` where a time is expected: the unit binds tighter than the division.
fn unit_above(like: Dimension, term: Part, text: &str) -> Option<Fix> {
    let (above, below) = text.split_once('/')?;
    let (number, unit) = below.trim().split_once(' ')?;
    let is_number = |text: &str| text.trim().parse::<f64>().is_ok();
    let is_so = is_number(above) && is_number(number) && like.times(term.dimension).is(Dimension::PURE);
    let mended = format!("{} {} / {number}", above.trim(), unit.trim());
    let message = format!("a unit belongs to the number before it: `{mended}`");
    is_so.then(|| Fix::replace(term.span, &mended, message, Applicability::Probably))
}

/// The largest number of characters of a text in a message.
const LONGEST_SHOWN: usize = 40;

/// Suggests a factor that gives a term the dimension of another one.
fn scaled(like: Dimension, term: Part, text: &str) -> Option<Fix> {
    let factor = like.over(term.dimension);
    let is_whole = [factor.length, factor.time, factor.mass].iter().all(|power| (power - power.round()).abs() < 1e-9);
    let unit = usual_factor(factor);
    let [before, behind] = match unit.strip_prefix("1/") {
        Some(divisor) => {
            let divisor = divisor.trim_start_matches('(').trim_end_matches(')');
            let one = if divisor.contains(['*', '/']) { format!("(1 {divisor})") } else { format!("1 {divisor}") };
            [String::new(), format!(" / {one}")]
        }
        None => [format!("1 {unit} * "), String::new()],
    };
    let shown = if text.chars().count() <= LONGEST_SHOWN && !text.contains(['+', '-', '\n']) { text } else { "(…)" };
    let words = format!("a factor makes {} of it: `{before}{shown}{behind}`", like.in_words());
    is_whole.then(|| with_factors(term.span, text, [&before, &behind], &words))
}

/// Returns the usual unit of a factor. A rate is that of an angle.
fn usual_factor(factor: Dimension) -> String {
    let unit = factor.unit();
    if factor.is(Dimension::RATE) { "rad/s".to_owned() } else { unit }
}

/// Returns the usual unit of a quantity.
pub(super) fn usual_unit(dimension: Dimension) -> String {
    if dimension.is(Dimension::LENGTH) { "mm".to_owned() } else { dimension.unit().replace("1/s", "rad/s") }
}

/// Returns a value (SI) for readers, without rounding in its last digits.
pub fn format_value(value: f64, dimension: Dimension) -> String {
    let (value, unit) = if dimension.is(Dimension::LENGTH) && value.abs() < 1.0 {
        (value * 1e3, "mm".to_owned())
    } else if dimension.is(Dimension::PURE) {
        (value, String::new())
    } else {
        (value, dimension.unit())
    };
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    format!("{} {unit}", readable(rounded)).trim_end().to_owned()
}

/// `text` is that of the term.
pub fn wrong_dimension(place: &str, expected: Dimension, found: Part, text: &str) -> Diagnostic {
    let units = |d: Dimension| {
        if d.is(Dimension::LENGTH) {
            Some("`mm`, `m`")
        } else if d.is(Dimension::TIME) {
            Some("`s`, `ms`")
        } else {
            None
        }
    };
    let is_angle =
        place.contains("angle") || place.contains("`sin`") || place.contains("`cos`") || place.contains("`tan`");
    let factors = |factors: [&str; 2], words: &str| Some(with_factors(found.span, text, factors, words));
    let mut fix = None;
    let help = if expected.is(Dimension::PURE) && is_angle && found.dimension.is(Dimension::TIME) {
        let words = "an angular speed makes an angle of a time: `1 rad/s * t`";
        fix = factors(["1 rad/s * ", ""], words);
        Some(words.to_owned())
    } else if expected.is(Dimension::PURE) && is_angle {
        Some("units of angle: `deg`, `rad`".to_owned())
    } else if expected.is(Dimension::PURE) {
        let words = format!("divide it by {} to get a pure number", one(found.dimension));
        let unit = one(found.dimension).trim_matches('`').to_owned();
        let unit = if unit.contains('/') { format!("({unit})") } else { unit };
        // An exponent binds tighter than a division.
        let [open, close] = if place.contains("exponent") { ["(", ")"] } else { ["", ""] };
        fix = factors([open, &format!(" / {unit}{close}")], &words);
        Some(words)
    } else if place.contains("phase") {
        Some("it is measured along the pitch circles: an angle times a radius, as `30 deg * 20 mm`".to_owned())
    } else {
        if found.dimension.is(Dimension::PURE) && units(expected).is_some() {
            fix = with_unit(found.span, text, &usual_unit(expected));
        }
        units(expected).map(|units| {
            format!("units of {}: {units}", expected.in_words().trim_start_matches("an ").trim_start_matches("a "))
        })
    };
    Diagnostic::new(
        Code::E0402,
        format!("{place} must be {}, found {}", expected.in_words(), found.dimension.in_words()),
    )
    .at(found.span, found.dimension.in_words())
    .help_if(help)
    .change(fix)
}

/// Returns a unit value such as `1 s`, `1 m` or `1 m/s`.
fn one(dimension: Dimension) -> String {
    let unit = dimension.unit();
    if unit.starts_with('1') { format!("`{unit}`") } else { format!("`1 {unit}`") }
}

pub fn exponent(span: Span, base: Part) -> Diagnostic {
    Diagnostic::new(Code::E0403, format!("{} takes a constant exponent only", base.dimension.in_words()))
        .at(span, "not constant")
        .also(base.span, base.dimension.in_words())
        .help("divide the base by a unit first: `(… / 1 mm)^…`")
}

pub fn not_finite(span: Span, value: f64) -> Diagnostic {
    let what = if value.is_nan() { "not a number" } else { "infinite" };
    Diagnostic::new(Code::E0404, format!("this constant is {what}"))
        .at(span, what)
        .help("look for a division by zero, a root or logarithm of what is not positive, or a number beyond 1.8e308")
}

/// Returns the diagnostic of `acos` or `asin` of a value beyond 1.
pub fn no_such_angle(argument: Span, function: &str, value: f64) -> Diagnostic {
    let number = readable(value);
    let which = if function == "acos" { "cosine" } else { "sine" };
    Diagnostic::new(Code::E0404, format!("no angle has the {which} {number}"))
        .at(argument, format!("{number}, and the {which} of an angle is between -1 and 1"))
        .help("a triangle with these lengths does not close: one side is longer than the other two together, or a ratio is upside down")
}

pub fn zero_direction(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0405, "an axis needs a direction, and this one has length zero")
        .at(span, "no direction")
        .help("take two points that differ, or a direction: `along (1, 0)` is that of x, `along (0, 1)` that of y")
}

pub fn not_positive_length(what: &str, span: Span, value: f64) -> Diagnostic {
    let value = format_value(value, Dimension::LENGTH);
    Diagnostic::new(Code::E0406, format!("{what} must be positive, it is {value}"))
        .at(span, value)
        .help("a direction is given by the order of points, or by an angle; a length has no sign")
}

pub fn curve_is_a_point(name: &Name, argument: &str, at: Span) -> Diagnostic {
    Diagnostic::new(Code::E0411, format!("curve `{}` does not depend on its argument `{argument}`", name.text))
        .at(at, "the same point for every value")
        .help(format!("a circle of radius r about the origin is `(r * cos({argument}), r * sin({argument}))`"))
}
