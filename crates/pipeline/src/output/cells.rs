//! Cells of tables, column by column.

/// The type of the cells of a column.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// Whole numbers, none missing.
    Whole,
    /// Numbers, of which some may be missing.
    Number,
    /// Words, none missing.
    Word,
}

/// A column of a sheet.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SheetColumn {
    /// Name.
    pub name: String,
    /// Unit of the numbers; `1` for pure numbers, and for cells that are no numbers.
    pub unit: String,
    /// Type of the cells.
    pub kind: Kind,
}

/// Cells of a column.
#[derive(Clone, PartialEq, Debug)]
pub enum Cells {
    /// Whole numbers.
    Whole(Vec<u64>),
    /// Numbers; those that are not finite are missing.
    Numbers(Vec<f64>),
    /// Words.
    Words(Vec<&'static str>),
}

impl Cells {
    /// Returns an empty column.
    #[must_use]
    pub fn none(kind: Kind) -> Cells {
        match kind {
            Kind::Whole => Cells::Whole(Vec::new()),
            Kind::Number => Cells::Numbers(Vec::new()),
            Kind::Word => Cells::Words(Vec::new()),
        }
    }

    /// Returns the number of cells.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Cells::Whole(cells) => cells.len(),
            Cells::Numbers(cells) => cells.len(),
            Cells::Words(cells) => cells.len(),
        }
    }
}
