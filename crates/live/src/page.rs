//! The page of what was seen: what each crate knows, put together.

use mechc_draw::view::page::{Column, Page, Variant, Vary};
use mechc_draw::view::svg;
use mechc_ir::layout::{ColumnKind, ColumnUnit};
use mechc_pipeline::Seen;
use mechc_text::source::Sources;

pub use mechc_draw::view::page::{base64, shell};

/// The page of one motion.
#[must_use]
pub fn written(seen: &Seen, sources: &Sources) -> String {
    of_one(seen, sources).written()
}

/// A picture of one motion, which moves where nothing can be computed.
#[must_use]
pub fn picture(seen: &Seen) -> String {
    svg::animated(&seen.scene, &seen.motion, &svg::Options::default())
}

/// The page of what varies; `first` is the variant that it begins with.
#[must_use]
pub fn written_with(first: &Seen, vary: Vec<Vary>, variants: Vec<Variant>, sources: &Sources) -> String {
    made(first, vary, variants, sources).written()
}

/// The page of one motion, not yet written.
pub(super) fn of_one<'a>(seen: &'a Seen, sources: &'a Sources) -> Page<'a> {
    made(seen, Vec::new(), vec![variant(seen)], sources)
}

fn made<'a>(first: &'a Seen, vary: Vec<Vary>, variants: Vec<Variant<'a>>, sources: &'a Sources) -> Page<'a> {
    let kinds = first.kinds.iter().map(|kind| word(*kind));
    let columns = first.columns.iter().zip(&first.units).zip(kinds);
    let columns = columns.map(|((name, unit), kind)| Column { kind, ..column(name, unit) }).collect();
    let texts = first.texts.iter().map(|id| (*id, sources.get(*id))).collect();
    Page { texts, columns, vary, variants }
}

/// A motion among those of a page.
#[must_use]
pub fn variant(seen: &Seen) -> Variant<'_> {
    Variant {
        scene: &seen.scene,
        motion: &seen.motion,
        all_rows: seen.all_rows,
        results: seen.results.iter().map(|(name, unit, value)| (column(name, unit), *value)).collect(),
        messages: seen.messages().collect(),
    }
}

fn column<'a>(name: &'a str, unit: &'a ColumnUnit) -> Column<'a> {
    Column { name, unit: &unit.text, scale: unit.scale(), kind: "" }
}

fn word(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Time => "time",
        ColumnKind::Body => "body",
        ColumnKind::Joint => "joint",
        ColumnKind::Reaction => "reaction",
        ColumnKind::Measure => "measure",
        ColumnKind::Rate => "rate",
        ColumnKind::Variation => "variation",
    }
}
