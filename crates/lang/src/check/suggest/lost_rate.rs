//! Suggestions for rates that lack a part of their unit, such as `60 mm * t` where a length is expected.

use crate::model::Dimension;
use mechc_text::diag::{Applicability, Edit, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::Unit;

/// A term of a formula in a message.
#[derive(Clone, Copy)]
pub struct Part {
    pub span: Span,
    pub dimension: Dimension,
}

/// Suggests the unit that gives a number times a power of time the dimension `like`.
pub(in crate::check) fn suggest_rate_unit(like: Dimension, found: Part, text: &str) -> Option<Fix> {
    let (head, power) = number_times_time(text)?;
    let number = head.split_whitespace().next()?;
    let unit = head[number.len()..].trim();
    number.parse::<f64>().ok()?;
    let per = if power == 1 { "s".to_owned() } else { format!("s^{power}") };
    let missing = found.dimension.over(like);
    let added = if unit.is_empty() && found.dimension.is(Dimension::TIME.to_the(f64::from(power))) {
        let of = if like.is(Dimension::LENGTH) {
            "mm"
        } else if like.is(Dimension::PURE) {
            "rad"
        } else {
            return None;
        };
        format!(" {of}/{per}")
    } else if Unit::named(unit.split(['/', '^', '*']).next()?.trim()).is_some() && missing.is(Dimension::TIME) {
        "/s".to_owned()
    } else if Unit::named(unit).is_some() && missing.is(Dimension::TIME.to_the(2.0)) {
        "/s^2".to_owned()
    } else {
        return None;
    };
    let what = match (power, like.is(Dimension::LENGTH)) {
        (1, true) => "a speed times a time is a length",
        (1, false) => "an angular speed times a time is an angle",
        (_, true) => "an acceleration times a time squared is a length",
        (_, false) => "an angular acceleration times a time squared is an angle",
    };
    let at = found.span.start + head.len() as u32;
    let message = format!("{what}: `{head}{added}{}`", &text[head.len()..]);
    let edit = Edit { span: Span { start: at, end: at, ..found.span }, text: added };
    Some(Fix { message, edits: vec![edit], applies: Applicability::Probably })
}

/// Splits `60 mm * t` into `60 mm` and 1, and `60 * t^2` into `60` and 2.
fn number_times_time(text: &str) -> Option<(&str, u8)> {
    let (head, tail) = text.rsplit_once('*')?;
    let power = match tail.replace(' ', "").as_str() {
        "t" => 1,
        "t^2" => 2,
        _ => return None,
    };
    let head = head.trim_end();
    // In a sum or call it is ambiguous what lacks the unit.
    let is_plain = head.chars().all(|c| c.is_alphanumeric() || " ./^µ".contains(c));
    is_plain.then_some((head, power))
}

/// Suggests a formula in polar coordinates if the terms are a length and an angle.
pub(in crate::check) fn polar(first: Part, second: Part, [length, angle]: [&str; 2]) -> Option<String> {
    let is_angle = angle.split_whitespace().last().is_some_and(|unit| ["deg", "rad", "mrad", "rev"].contains(&unit));
    let are_both = first.dimension.is(Dimension::LENGTH) && second.dimension.is(Dimension::PURE) && is_angle;
    are_both
        .then(|| format!("a point of a distance and an angle is `({length} * cos({angle}), {length} * sin({angle}))`"))
}
