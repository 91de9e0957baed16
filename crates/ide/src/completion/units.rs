//! The units behind a number: of the dimension that fits there first.

use super::cursor::{PartialUnit, Cursor};
use super::item::{CompletionItem, CompletionItemKind, Template};
use super::expected::{Expected, wanted};
use crate::trial_edits::faults;
use crate::location::FilePosition;
use crate::snapshot::Snapshot;
use mechc_text::diag::Severity;
use mechc_text::vocabulary::{Dimension, UNITS, Unit};
use std::sync::Arc;

/// Longer texts are not checked with each dimension that a number could have (bytes).
const LONGEST: usize = 32_768;

/// What is tried: the units in which drawings and drives are mostly written, which come first.
const TRIED: &[(&str, Dimension)] = &[
    ("mm", Dimension::LENGTH),
    ("deg", Dimension::PURE),
    ("s", Dimension::TIME),
    ("rpm", Dimension::RATE),
    ("mm/s", Dimension::SPEED),
];

/// Rates, which are written with `/`.
const RATES: &[(&str, Dimension, &str)] = &[
    ("deg/s", Dimension::RATE, "degrees in a second"),
    ("rad/s", Dimension::RATE, "radians in a second"),
    ("mm/s", Dimension::SPEED, "millimetres in a second"),
    ("m/s", Dimension::SPEED, "metres in a second"),
];

/// All units, in a good order for the number before the cursor.
pub(super) fn behind_number(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
    let like = in_sum(cursor);
    let known = like.map(|unit| unit.dimension).or_else(|| known(cursor));
    let fitting = known.map_or_else(|| tried(snapshot, position, cursor), |dimension| vec![dimension]);
    let is_right_behind = cursor.text[..cursor.word.start].ends_with(|c: char| c.is_ascii_digit());
    let space = if is_right_behind && cursor.word.is_empty() { " " } else { "" };
    let fits = |dimension: Dimension| fitting.iter().any(|fitting| fitting.is(dimension));
    let mut items: Vec<CompletionItem> = Vec::new();
    for unit in UNITS {
        let is_like = like.is_some_and(|like| std::ptr::eq(like, unit));
        let is_usual = TRIED.iter().any(|(usual, _)| *usual == unit.word.name);
        let rank = if is_like { 0 } else { u8::from(!fits(unit.dimension)) * 4 + u8::from(!is_usual) + 1 };
        items.push(
            CompletionItem::word(&unit.word, rank).inserts(Template::plain(format!("{space}{}", unit.word.name))),
        );
    }
    for (text, dimension, meaning) in RATES {
        let rank = u8::from(!fits(*dimension)) * 4 + 2;
        let insert = Template::plain(format!("{space}{text}"));
        items.push(CompletionItem::new(*text, CompletionItemKind::Unit, rank).detail(*meaning).inserts(insert));
    }
    items.sort_by_key(|item| item.rank);
    items
}

/// How a compound unit can go on, of which some is written: times first, since most are rates. What is a rate already, or of a dimension
/// that the unit has, makes no sense there.
pub(super) fn going_on(begun: &PartialUnit) -> Vec<CompletionItem> {
    let rank = |dimension: Dimension| match dimension {
        it if begun.dimensions.iter().any(|known| known.is(it)) => None,
        it if it.is(Dimension::TIME) => Some(1),
        it if it.is(Dimension::LENGTH) => Some(2),
        it if it.is(Dimension::PURE) => Some(3),
        _ => None,
    };
    let mut items: Vec<CompletionItem> = UNITS
        .iter()
        .filter_map(|unit| {
            let is_usual = TRIED.iter().any(|(usual, _)| *usual == unit.word.name);
            let insert = Template::plain(unit.word.name);
            Some(CompletionItem::word(&unit.word, 2 * rank(unit.dimension)? - u8::from(is_usual)).inserts(insert))
        })
        .collect();
    items.sort_by_key(|item| item.rank);
    items
}

/// The units in which a measure, trace or result can be printed.
pub(super) fn printed() -> Vec<CompletionItem> {
    UNITS.iter().map(|unit| CompletionItem::word(&unit.word, 1)).collect()
}

/// The unit of the term before, where the number is one of a sum or compared.
fn in_sum(cursor: &Cursor<'_>) -> Option<&'static Unit> {
    let is_sum = matches!(cursor.back(2)?, "+" | "-" | "<" | ">" | "<=" | ">=" | "==" | "!=");
    let is_number = cursor.back(4)?.starts_with(|c: char| c.is_ascii_digit());
    Unit::named(cursor.back(3)?).filter(|_| is_sum && is_number)
}

/// The dimension that the place asks for.
fn known(cursor: &Cursor<'_>) -> Option<Dimension> {
    // as a factor it may have any
    if matches!(cursor.back(2), Some("*" | "/" | "^")) {
        return None;
    }
    wanted(cursor).into_iter().find_map(|wanted| match wanted {
        Expected::Number(dimension) => dimension,
        Expected::Point => Some(Dimension::LENGTH),
        _ => None,
    })
}

/// The dimensions with which the text has the fewest faults: what uses the number tells what it is.
fn tried(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Vec<Dimension> {
    if cursor.text.len() > LONGEST {
        return Vec::new();
    }
    let mut counts = Vec::new();
    for (unit, dimension) in TRIED {
        let text = [&cursor.text[..cursor.word.start], " ", unit, " ", &cursor.text[cursor.word.end..]].concat();
        let tried = snapshot.supposing(&position.path, text.into());
        let found = faults(&tried, &[Arc::clone(&position.path)]);
        counts.push((found.iter().filter(|said| said.severity != Severity::Note).count(), *dimension));
    }
    let least = counts.iter().map(|(count, _)| *count).min();
    counts.iter().filter(|(count, _)| Some(*count) == least).map(|(_, dimension)| *dimension).collect()
}
