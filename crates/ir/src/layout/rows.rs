//! Where a row holds what.

use crate::{BodyId, ConstraintSystem, With};
use mechc_expr::math::WIDE;
use std::ops::Range;

/// Columns that stand together in a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Stretch {
    /// Time.
    Time,
    /// All coordinates, differentiated so many times by time.
    Coordinates(usize),
    /// What joints exert and drivers supply.
    Reactions,
    /// The measures that can be differentiated so many times by time, likewise.
    Measures(usize),
    /// Derivatives that were asked for as columns of their own.
    Appended,
    /// The derivatives of `q` by each input, and then by each parameter.
    Slopes,
    /// The variations: for each `q`, `q̇` and `q̈`, one behind the other.
    Varied,
    /// The multipliers, where forces are asked for; behind them how these vary, variation by variation.
    Multipliers,
}

/// The stretches of the table, in their order.
const PRINTED: [Stretch; 9] = [
    Stretch::Time,
    Stretch::Coordinates(0),
    Stretch::Reactions,
    Stretch::Measures(0),
    Stretch::Coordinates(1),
    Stretch::Measures(1),
    Stretch::Coordinates(2),
    Stretch::Measures(2),
    Stretch::Appended,
];

/// What only measures need, behind the table.
const UNPRINTED: [Stretch; 4] = [Stretch::Coordinates(3), Stretch::Slopes, Stretch::Varied, Stretch::Multipliers];

/// What a column holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Holds {
    /// Time.
    Time,
    /// A coordinate, differentiated so many times by time.
    Coordinate {
        /// Its number.
        index: usize,
        /// How many times.
        order: usize,
    },
    /// What a joint exerts or a driver supplies, by its place among all of these.
    Reaction(usize),
    /// A measure, likewise.
    Measure {
        /// Its number.
        index: usize,
        /// How many times.
        order: usize,
    },
    /// A derivative that was asked for as a column of its own, by its number.
    Appended(usize),
    /// The derivative of a coordinate by an input or a parameter.
    Slope {
        /// The number of the coordinate.
        of: usize,
        /// What it is by.
        by: With,
    },
    /// A part of a variation.
    Varied,
    /// A multiplier, or how one varies.
    Multiplier,
}

/// What the columns of the table hold, in order.
#[must_use]
pub fn holds(system: &ConstraintSystem) -> Vec<Holds> {
    PRINTED.into_iter().flat_map(|stretch| stretch.holds(system)).collect()
}

/// What all columns of a row hold, in order: those of the table, and what stands behind it.
#[must_use]
pub fn row_holds(system: &ConstraintSystem) -> Vec<Holds> {
    PRINTED.into_iter().chain(UNPRINTED).flat_map(|stretch| stretch.holds(system)).collect()
}

/// The measures that have a time derivative of some order.
fn measures_with(system: &ConstraintSystem, order: usize) -> impl Iterator<Item = usize> {
    (0..system.measures().len()).filter(move |&index| system.measures()[index].has(order))
}

impl Stretch {
    /// How many columns it has.
    fn length(self, system: &ConstraintSystem) -> usize {
        let n = system.coordinates().len();
        match self {
            Stretch::Time => 1,
            Stretch::Coordinates(3) if system.jerk().is_none() => 0,
            Stretch::Coordinates(_) => n,
            Stretch::Reactions => system.reactions().len(),
            Stretch::Measures(order) => measures_with(system, order).count(),
            Stretch::Appended => system.appended().len(),
            Stretch::Slopes => n * system.slopes().len(),
            Stretch::Varied => 3 * n * system.variations().len(),
            Stretch::Multipliers => system.needed_forces().len() * (1 + system.variations().len()),
        }
    }

    fn holds(self, system: &ConstraintSystem) -> Vec<Holds> {
        match self {
            Stretch::Time => vec![Holds::Time],
            Stretch::Coordinates(3) if system.jerk().is_none() => Vec::new(),
            Stretch::Coordinates(order) => {
                (0..system.coordinates().len()).map(|index| Holds::Coordinate { index, order }).collect()
            }
            Stretch::Reactions => (0..system.reactions().len()).map(Holds::Reaction).collect(),
            Stretch::Measures(order) => {
                measures_with(system, order).map(|index| Holds::Measure { index, order }).collect()
            }
            Stretch::Appended => (0..system.appended().len()).map(Holds::Appended).collect(),
            Stretch::Slopes => {
                let of_each = |by| (0..system.coordinates().len()).map(move |of| Holds::Slope { of, by });
                system.slopes().into_iter().flat_map(of_each).collect()
            }
            Stretch::Varied => vec![Holds::Varied; self.length(system)],
            Stretch::Multipliers => vec![Holds::Multiplier; self.length(system)],
        }
    }
}

/// Where a row holds what. Rows are in the order of the table, with what only measures need behind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RowLayout {
    /// First column of `q`, `q̇`, `q̈`, `q⃛`.
    pub coordinates: [u32; 4],
    /// First column of what joints exert and drivers supply.
    pub reactions: u32,
    /// First column of the measures, and of their first and second derivatives.
    pub measures: [u32; 3],
    /// First of the derivatives that stand behind all other columns of the table.
    pub appended: u32,
    /// First column of the variations: for each `q`, `q̇` and `q̈`, one behind the other.
    pub varied: u32,
    /// First column of the multipliers; behind them how these vary, variation by variation.
    pub multipliers: u32,
    /// Whether there are columns for `q⃛`.
    pub has_jerk: bool,
    /// First column of the derivatives of `q` by each input and parameter.
    pub slopes: u32,
    /// Columns that the table has.
    pub printed: usize,
    /// All columns, filled up to whole lines of the processor's memory.
    pub stride: usize,
    /// How many coordinates there are.
    n: u32,
    /// How many columns of reactions.
    reacting: u32,
}

impl RowLayout {
    /// The layout of a system's rows.
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
            printed: PRINTED.iter().map(|stretch| stretch.length(system)).sum(),
            stride: 0,
            n: system.coordinates().len() as u32,
            reacting: system.reactions().len() as u32,
        };
        for stretch in PRINTED.into_iter().chain(UNPRINTED) {
            let first = layout.stride as u32;
            match stretch {
                Stretch::Time => {}
                Stretch::Coordinates(order) => layout.coordinates[order] = first,
                Stretch::Reactions => layout.reactions = first,
                Stretch::Measures(order) => layout.measures[order] = first,
                Stretch::Appended => layout.appended = first,
                Stretch::Slopes => layout.slopes = first,
                Stretch::Varied => layout.varied = first,
                Stretch::Multipliers => layout.multipliers = first,
            }
            layout.stride += stretch.length(system);
        }
        layout.stride = layout.stride.next_multiple_of(WIDE);
        layout
    }

    /// The coordinates in a row (m, rad).
    #[must_use]
    pub fn position<'r>(&self, row: &'r [f64]) -> &'r [f64] {
        let first = self.coordinates[0] as usize;
        &row[first..first + self.n as usize]
    }

    /// The columns of what joints exert and drivers supply.
    #[must_use]
    pub fn reactions(&self) -> Range<usize> {
        self.reactions as usize..(self.reactions + self.reacting) as usize
    }

    /// The column of a coordinate, differentiated so many times by time.
    #[must_use]
    pub fn coordinate(&self, index: u32, order: usize) -> u32 {
        self.coordinates[order] + index
    }

    /// The column of how a coordinate, differentiated so many times by time, changes in a variation.
    #[must_use]
    pub fn varied(&self, variation: u32, order: u32, index: u32) -> u32 {
        self.varied + (3 * variation + order) * self.n + index
    }

    /// The column of the multiplier of a row of `Φ`.
    #[must_use]
    pub fn multiplier(&self, row: u32) -> u32 {
        self.multipliers + row
    }

    /// The column of how that changes in a variation.
    #[must_use]
    pub fn varied_multiplier(&self, variation: u32, row: u32) -> u32 {
        self.multiplier((1 + variation) * self.n + row)
    }

    /// How many times a column of the table is differentiated by time, as far as it stands with coordinates that are.
    #[must_use]
    pub fn order_of(&self, column: usize) -> usize {
        let [_, first, second, _] = self.coordinates.map(|first| first as usize);
        usize::from(column >= first) + usize::from(column >= second)
    }

    /// The columns of x, y and phi of a body; of their first, and of their second time derivatives.
    #[must_use]
    pub fn pose(&self, system: &ConstraintSystem, body: BodyId) -> [[usize; 3]; 3] {
        let [places, rates, accelerations, _] = self.coordinates;
        let pose = system.pose_of(body);
        [places, rates, accelerations].map(|first| pose.map(|coordinate| first as usize + coordinate))
    }
}
