//! Completion of units after a number; those of the fitting dimension come first.

use super::cursor::{Cursor, PartialUnit};
use super::expected::{Expected, expected};
use super::item::{CompletionItem, CompletionItemKind, Template};
use crate::location::FilePosition;
use crate::snapshot::Snapshot;
use crate::trial_edits::word_diagnostics;
use mechc_text::diag::Severity;
use mechc_text::vocabulary::{Dimension, UNITS, Unit};
use std::sync::Arc;

/// The maximum length of a text that is checked with each dimension that a number could have (bytes).
const MAX_LENGTH: usize = 32_768;

/// The usual units of drawings and drives. They come first, and their dimensions are tried.
const USUAL: &[(&str, Dimension)] = &[
    ("mm", Dimension::LENGTH),
    ("deg", Dimension::PURE),
    ("s", Dimension::TIME),
    ("rpm", Dimension::RATE),
    ("mm/s", Dimension::SPEED),
];

/// Rates that are written with `/`, with their meaning.
const RATES: &[(&str, Dimension, &str)] = &[
    ("deg/s", Dimension::RATE, "degrees in a second"),
    ("rad/s", Dimension::RATE, "radians in a second"),
    ("mm/s", Dimension::SPEED, "millimetres in a second"),
    ("m/s", Dimension::SPEED, "metres in a second"),
];

/// Proposes all units, ordered by how well they fit the number before the cursor.
pub(super) fn after_number(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
    let like = in_sum(cursor);
    let dimension = like.map(|unit| unit.dimension).or_else(|| expected_dimension(cursor));
    let fitting = dimension.map_or_else(|| best_dimensions(snapshot, position, cursor), |dimension| vec![dimension]);
    let is_right_behind = cursor.text[..cursor.word.start].ends_with(|c: char| c.is_ascii_digit());
    let space = if is_right_behind && cursor.word.is_empty() { " " } else { "" };
    let fits = |dimension: Dimension| fitting.iter().any(|fitting| fitting.is(dimension));
    let mut items: Vec<CompletionItem> = Vec::new();
    for unit in UNITS {
        let is_like = like.is_some_and(|like| std::ptr::eq(like, unit));
        let is_usual = USUAL.iter().any(|(usual, _)| *usual == unit.word.name);
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

/// Proposes units that continue a compound unit: units of time first, since most compound units are rates. Dimensions that the unit
/// already has are left out.
pub(super) fn continuations(partial: &PartialUnit) -> Vec<CompletionItem> {
    let rank = |dimension: Dimension| match dimension {
        it if partial.dimensions.iter().any(|used| used.is(it)) => None,
        it if it.is(Dimension::TIME) => Some(1),
        it if it.is(Dimension::LENGTH) => Some(2),
        it if it.is(Dimension::PURE) => Some(3),
        _ => None,
    };
    let mut items: Vec<CompletionItem> = UNITS
        .iter()
        .filter_map(|unit| {
            let is_usual = USUAL.iter().any(|(usual, _)| *usual == unit.word.name);
            let insert = Template::plain(unit.word.name);
            Some(CompletionItem::word(&unit.word, 2 * rank(unit.dimension)? - u8::from(is_usual)).inserts(insert))
        })
        .collect();
    items.sort_by_key(|item| item.rank);
    items
}

/// Proposes the units in which a measure, trace or result can be printed.
pub(super) fn printed() -> Vec<CompletionItem> {
    UNITS.iter().map(|unit| CompletionItem::word(&unit.word, 1)).collect()
}

/// Returns the unit of the term before, if the number is added to it or compared with it.
fn in_sum(cursor: &Cursor<'_>) -> Option<&'static Unit> {
    let is_sum = matches!(cursor.back(2)?, "+" | "-" | "<" | ">" | "<=" | ">=" | "==" | "!=");
    let is_number = cursor.back(4)?.starts_with(|c: char| c.is_ascii_digit());
    Unit::named(cursor.back(3)?).filter(|_| is_sum && is_number)
}

/// Returns the dimension that the position requires.
fn expected_dimension(cursor: &Cursor<'_>) -> Option<Dimension> {
    // a factor may have any dimension
    if matches!(cursor.back(2), Some("*" | "/" | "^")) {
        return None;
    }
    expected(cursor).into_iter().find_map(|kind| match kind {
        Expected::Number(dimension) => dimension,
        Expected::Point => Some(Dimension::LENGTH),
        _ => None,
    })
}

/// Returns the dimensions with which the text has the fewest diagnostics, since uses of the number reveal its dimension.
fn best_dimensions(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Vec<Dimension> {
    if cursor.text.len() > MAX_LENGTH {
        return Vec::new();
    }
    let mut counts = Vec::new();
    for (unit, dimension) in USUAL {
        let text = [&cursor.text[..cursor.word.start], " ", unit, " ", &cursor.text[cursor.word.end..]].concat();
        let trial = snapshot.with_trial_text(&position.path, text.into());
        let diagnostics = word_diagnostics(&trial, &[Arc::clone(&position.path)]);
        counts
            .push((diagnostics.iter().filter(|diagnostic| diagnostic.severity != Severity::Note).count(), *dimension));
    }
    let least = counts.iter().map(|(count, _)| *count).min();
    counts.iter().filter(|(count, _)| Some(*count) == least).map(|(_, dimension)| *dimension).collect()
}
