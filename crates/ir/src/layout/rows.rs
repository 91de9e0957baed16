//! Positions of the contents of a row.

use crate::{BodyId, ConstraintSystem, With};
use mechc_expr::math::WIDE;
use std::ops::Range;

/// Adjacent columns of one kind in a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Section {
    /// Time.
    Time,
    /// All coordinates, differentiated the given number of times with respect to time.
    Coordinates(usize),
    /// Reactions of joints and efforts of drivers.
    Reactions,
    /// The measures that have a time derivative of the given order.
    Measures(usize),
    /// Derivatives with columns of their own.
    DerivativeColumn,
    /// Derivatives of `q` with respect to each input, then each parameter.
    Slopes,
    /// The variations: `q`, `q̇` and `q̈` of each, one after the other.
    Varied,
    /// The multipliers, if forces are requested, followed by the variations of all multipliers.
    Multipliers,
}

/// Sections of the table, in order.
const PRINTED: [Section; 9] = [
    Section::Time,
    Section::Coordinates(0),
    Section::Reactions,
    Section::Measures(0),
    Section::Coordinates(1),
    Section::Measures(1),
    Section::Coordinates(2),
    Section::Measures(2),
    Section::DerivativeColumn,
];

/// Sections that only measures need, after the table.
const UNPRINTED: [Section; 4] = [Section::Coordinates(3), Section::Slopes, Section::Varied, Section::Multipliers];

/// Content of a column.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ColumnContent {
    /// Time.
    Time,
    /// A coordinate, differentiated `order` times with respect to time.
    Coordinate {
        /// Number of the coordinate.
        index: usize,
        /// Order of the time derivative.
        order: usize,
    },
    /// A reaction or effort, by its position among all of them.
    Reaction(usize),
    /// A measure, differentiated `order` times with respect to time.
    Measure {
        /// Number of the measure.
        index: usize,
        /// Order of the time derivative.
        order: usize,
    },
    /// A derivative with a column of its own, by its number.
    DerivativeColumn(usize),
    /// A derivative of a coordinate with respect to an input or a parameter.
    Slope {
        /// Number of the coordinate.
        of: usize,
        /// Variable of differentiation.
        by: With,
    },
    /// An entry of a variation.
    Varied,
    /// A multiplier, or a variation of one.
    Multiplier,
}

/// Returns the contents of the table's columns, in order.
#[must_use]
pub fn holds(system: &ConstraintSystem) -> Vec<ColumnContent> {
    PRINTED.into_iter().flat_map(|section| section.holds(system)).collect()
}

/// Returns the contents of all columns of a row, in order: those of the table, then those that only the solver uses.
#[must_use]
pub fn row_contents(system: &ConstraintSystem) -> Vec<ColumnContent> {
    PRINTED.into_iter().chain(UNPRINTED).flat_map(|section| section.holds(system)).collect()
}

/// Returns the indices of the measures that have a time derivative of an order.
fn measures_with(system: &ConstraintSystem, order: usize) -> impl Iterator<Item = usize> {
    (0..system.measures().len()).filter(move |&index| system.measures()[index].has(order))
}

impl Section {
    /// Returns the number of columns.
    fn length(self, system: &ConstraintSystem) -> usize {
        let n = system.coordinates().len();
        match self {
            Section::Time => 1,
            Section::Coordinates(3) if system.jerk().is_none() => 0,
            Section::Coordinates(_) => n,
            Section::Reactions => system.reactions().len(),
            Section::Measures(order) => measures_with(system, order).count(),
            Section::DerivativeColumn => system.derivative_columns().len(),
            Section::Slopes => n * system.slopes().len(),
            Section::Varied => 3 * n * system.variations().len(),
            Section::Multipliers => system.required_forces().len() * (1 + system.variations().len()),
        }
    }

    fn holds(self, system: &ConstraintSystem) -> Vec<ColumnContent> {
        match self {
            Section::Time => vec![ColumnContent::Time],
            Section::Coordinates(3) if system.jerk().is_none() => Vec::new(),
            Section::Coordinates(order) => {
                (0..system.coordinates().len()).map(|index| ColumnContent::Coordinate { index, order }).collect()
            }
            Section::Reactions => (0..system.reactions().len()).map(ColumnContent::Reaction).collect(),
            Section::Measures(order) => {
                measures_with(system, order).map(|index| ColumnContent::Measure { index, order }).collect()
            }
            Section::DerivativeColumn => {
                (0..system.derivative_columns().len()).map(ColumnContent::DerivativeColumn).collect()
            }
            Section::Slopes => {
                let of_each = |by| (0..system.coordinates().len()).map(move |of| ColumnContent::Slope { of, by });
                system.slopes().into_iter().flat_map(of_each).collect()
            }
            Section::Varied => vec![ColumnContent::Varied; self.length(system)],
            Section::Multipliers => vec![ColumnContent::Multiplier; self.length(system)],
        }
    }
}

/// Column positions in a row: first the columns of the table, then those that only measures need.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RowLayout {
    /// First column of `q`, `q̇`, `q̈`, `q⃛`.
    pub coordinates: [u32; 4],
    /// First column of reactions and efforts.
    pub reactions: u32,
    /// First column of the measures, and of their first and second derivatives.
    pub measures: [u32; 3],
    /// First of the derivative columns, which follow all other columns of the table.
    pub appended: u32,
    /// First column of the variations: `q`, `q̇` and `q̈` of each, one after the other.
    pub varied: u32,
    /// First column of the multipliers, which are followed by their variations.
    pub multipliers: u32,
    /// True if there are columns for `q⃛`.
    pub has_jerk: bool,
    /// First column of the derivatives of `q` with respect to each input, then each parameter.
    pub slopes: u32,
    /// Number of columns of the table.
    pub printed: usize,
    /// Number of all columns, rounded up to whole cache lines.
    pub stride: usize,
    /// Number of coordinates.
    n: u32,
    /// Number of reaction columns.
    reaction_count: u32,
}

impl RowLayout {
    /// Creates the layout of a system's rows.
    #[must_use]
    pub fn new(system: &ConstraintSystem) -> RowLayout {
        let mut layout = RowLayout {
            coordinates: [0; 4],
            reactions: 0,
            measures: [0; 3],
            appended: 0,
            varied: 0,
            multipliers: 0,
            has_jerk: system.jerk().is_some(),
            slopes: 0,
            printed: PRINTED.iter().map(|section| section.length(system)).sum(),
            stride: 0,
            n: system.coordinates().len() as u32,
            reaction_count: system.reactions().len() as u32,
        };
        for section in PRINTED.into_iter().chain(UNPRINTED) {
            let first = layout.stride as u32;
            match section {
                Section::Time => {}
                Section::Coordinates(order) => layout.coordinates[order] = first,
                Section::Reactions => layout.reactions = first,
                Section::Measures(order) => layout.measures[order] = first,
                Section::DerivativeColumn => layout.appended = first,
                Section::Slopes => layout.slopes = first,
                Section::Varied => layout.varied = first,
                Section::Multipliers => layout.multipliers = first,
            }
            layout.stride += section.length(system);
        }
        layout.stride = layout.stride.next_multiple_of(WIDE);
        layout
    }

    /// Returns the coordinates in a row (m, rad).
    #[must_use]
    pub fn position<'r>(&self, row: &'r [f64]) -> &'r [f64] {
        let first = self.coordinates[0] as usize;
        &row[first..first + self.n as usize]
    }

    /// Returns the columns of reactions and efforts.
    #[must_use]
    pub fn reactions(&self) -> Range<usize> {
        self.reactions as usize..(self.reactions + self.reaction_count) as usize
    }

    /// Returns the column of a coordinate, differentiated `order` times with respect to time.
    #[must_use]
    pub fn coordinate(&self, index: u32, order: usize) -> u32 {
        self.coordinates[order] + index
    }

    /// Returns the column of a varied coordinate, differentiated `order` times with respect to time.
    #[must_use]
    pub fn varied(&self, variation: u32, order: u32, index: u32) -> u32 {
        self.varied + (3 * variation + order) * self.n + index
    }

    /// Returns the column of the multiplier of a row of `Φ`.
    #[must_use]
    pub fn multiplier(&self, row: u32) -> u32 {
        self.multipliers + row
    }

    /// Returns the column of a varied multiplier.
    #[must_use]
    pub fn varied_multiplier(&self, variation: u32, row: u32) -> u32 {
        self.multiplier((1 + variation) * self.n + row)
    }

    /// Returns the order of the time derivative (0 to 2) of the coordinates that a column of the table stands with.
    #[must_use]
    pub fn order_of(&self, column: usize) -> usize {
        let [_, first, second, _] = self.coordinates.map(|first| first as usize);
        usize::from(column >= first) + usize::from(column >= second)
    }

    /// Returns the columns of x, y and phi of a body, and of their first and second time derivatives.
    #[must_use]
    pub fn pose(&self, system: &ConstraintSystem, body: BodyId) -> [[usize; 3]; 3] {
        let [positions, rates, accelerations, _] = self.coordinates;
        let pose = system.pose_of(body);
        [positions, rates, accelerations].map(|first| pose.map(|coordinate| first as usize + coordinate))
    }
}
