//! The cells of tables, column by column.

/// What the cells of a column are.
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
    /// Its name.
    pub name: String,
    /// The unit of its numbers; `1` for pure numbers, and for what is no number.
    pub unit: String,
    /// What its cells are.
    pub kind: Kind,
}

/// Some cells of a column.
#[derive(Clone, PartialEq, Debug)]
pub enum Cells {
    /// Whole numbers.
    Whole(Vec<u64>),
    /// Numbers; what is not finite is missing.
    Numbers(Vec<f64>),
    /// Words.
    Words(Vec<&'static str>),
}

impl Cells {
    /// None yet.
    #[must_use]
    pub fn none(kind: Kind) -> Cells {
        match kind {
            Kind::Whole => Cells::Whole(Vec::new()),
            Kind::Number => Cells::Numbers(Vec::new()),
            Kind::Word => Cells::Words(Vec::new()),
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Cells::Whole(cells) => cells.len(),
            Cells::Numbers(cells) => cells.len(),
            Cells::Words(cells) => cells.len(),
        }
    }
}
