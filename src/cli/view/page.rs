//! The page of what was seen: what each room knows, put together.

use crate::analysis::ColumnUnit;
use crate::source::Sources;
use crate::stages::Seen;
use crate::view::page::{Column, Page, Variant};

/// The page of one motion.
pub(super) fn written(seen: &Seen, sources: &Sources) -> String {
    let columns = seen.columns.iter().zip(&seen.units).map(|(name, unit)| column(name, unit)).collect();
    let texts = seen.texts.iter().map(|id| (*id, sources.get(*id))).collect();
    Page { texts, columns, vary: Vec::new(), variants: vec![variant(seen)] }.written()
}

fn variant(seen: &Seen) -> Variant<'_> {
    Variant {
        scene: &seen.scene,
        motion: &seen.motion,
        all_rows: seen.all_rows,
        results: seen.results.iter().map(|(name, unit, value)| (column(name, unit), *value)).collect(),
        messages: seen.messages().collect(),
    }
}

fn column<'a>(name: &'a str, unit: &'a ColumnUnit) -> Column<'a> {
    Column { name, unit: &unit.text, scale: unit.scale() }
}
