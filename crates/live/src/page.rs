//! Builds HTML pages and pictures from visualizations.

use mechc_draw::view::page::{Column, Page, Variant, Vary};
use mechc_draw::view::svg;
use mechc_ir::layout::{ColumnKind, ColumnUnit};
use mechc_pipeline::Visualization;
use mechc_text::source::Sources;

pub use mechc_draw::view::page::{base64, shell};

/// Renders the page of one motion as HTML.
#[must_use]
pub fn render(seen: &Visualization, sources: &Sources) -> String {
    single_page(seen, sources).written()
}

/// Renders an animated SVG of one motion, for viewers without scripts.
#[must_use]
pub fn picture(seen: &Visualization) -> String {
    svg::animated(&seen.scene, &seen.motion, &svg::Options::default())
}

/// Renders the page of several variants as HTML; `first` is the one that it shows at first.
#[must_use]
pub fn render_variants(first: &Visualization, vary: Vec<Vary>, variants: Vec<Variant>, sources: &Sources) -> String {
    build(first, vary, variants, sources).written()
}

/// Builds the page of one motion.
pub(super) fn single_page<'a>(seen: &'a Visualization, sources: &'a Sources) -> Page<'a> {
    build(seen, Vec::new(), vec![variant(seen)], sources)
}

fn build<'a>(first: &'a Visualization, vary: Vec<Vary>, variants: Vec<Variant<'a>>, sources: &'a Sources) -> Page<'a> {
    let kinds = first.kinds.iter().map(|kind| kind_name(*kind));
    let columns = first.columns.iter().zip(&first.units).zip(kinds);
    let columns = columns.map(|((name, unit), kind)| Column { kind, ..column(name, unit) }).collect();
    let texts = first.texts.iter().map(|id| (*id, sources.get(*id))).collect();
    Page { texts, columns, vary, variants }
}

/// Converts a motion to a variant of a page.
#[must_use]
pub fn variant(seen: &Visualization) -> Variant<'_> {
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

fn kind_name(kind: ColumnKind) -> &'static str {
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
