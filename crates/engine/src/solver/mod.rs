//! The determined system as straight-line operations that solve it.
//!
//! What is solved at compile time, and how:
//!
//! - Blocks that depend on each other make a component; components are independent.
//! - In a block, equations with a pivot that is a number (`±1` mostly) give their coordinate once the others are known: such
//!   coordinates become assignments. What is left is a few *tears*, guessed from the motion so far, and as many equations,
//!   solved by Newton.
//! - The linear systems, of Newton, velocity, acceleration and jerk, are eliminated symbolically in an order that is chosen once
//!   ([`Order`]); numbers fold, and what nothing needs is left out. Velocity and acceleration share the factors.
//!
//! A tear's iterates lie on a grid, coarse beside rounding and fine beside convergence: Newton steps from the grid point next to the
//! solution, whichever way that was found. So the numbers do not depend on where the iteration
//! began (`math/grid.rs`).
//!
//! The operations work on several times at once, as [`Lanes`]; each lane has the bits that it would have alone.

mod build;
mod components;
mod constant_folding;
mod derivative_solves;
mod elimination;
mod instruction;
mod lane_invariants;
mod lanes;
mod multiplier_solves;
mod optimize;
mod order;
mod peephole;
mod pivoting;
mod predictor;
mod schedule;
mod symbolic_values;
mod tape;
mod tear;
mod variants;

pub use instruction::{Instruction, from_bits};
pub use lanes::{Batch, CHUNK, Lanes};
use mechc_ir::tolerances::solving::solver::{LARGEST_MULTIPLIER, MOST_OPERATIONS};
pub use order::{BlockEntry, Order};
pub use pivoting::{BlockTables, Equations, Pivoting};
pub use predictor::Bend;
pub use variants::{VariantBatch, VariantLanes};

use mechc_ir::layout::RowLayout;
use mechc_ir::program::{Program, Register};
use mechc_ir::structure::Determined;
use std::ops::Range;

/// Operations that solve a constraint system at given times: position, velocity, acceleration, measures.
#[derive(Clone, Debug)]
pub struct Solver {
    /// Those of all components one behind the other: they are read in a row, time and again.
    instructions: Vec<Instruction>,
    /// So many of them, the first ones, are run once for numbers and parameters; none where nothing is set apart.
    prologue_len: usize,
    /// What there is to run, component by component, and last the measures that join components, from what these have stored.
    segments: Vec<Segment>,
    registers: usize,
    /// Scales of the multipliers that are watched.
    weights: Vec<f64>,
    tears: Vec<u32>,
    /// What its operations note of pivots; empty unless they are asked to.
    pivots: Vec<Pivot>,
    turns: Vec<Turn>,
    layout: RowLayout,
}

/// A pivot that is no number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pivot {
    /// Which of [`Solver::turns`] it counts for.
    pub turn: u32,
    /// What makes one over it a pure number.
    pub weight: f64,
}

/// A block whose determinant changes with the position.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Turn {
    /// The block, by its number.
    pub block: u32,
    /// Whether the determinant is negative where its pivots are positive.
    pub is_negative: bool,
}

/// Of a register, while a solver is laid out: that what it holds is fixed.
const PROLOGUE: Register = 1 << 31;

/// Blocks that depend on each other, in an order of solution, as operations.
#[derive(Clone, Debug, Default)]
struct Component {
    /// What only numbers and parameters lead to, where that is set apart, and how many registers it has of its own, each of them [`FIXED`].
    prologue: Vec<Instruction>,
    prologue_registers: usize,
    instructions: Vec<Instruction>,
    segments: Vec<Segment>,
    registers: usize,
}

/// Instructions that are run once, or until their tears have settled.
#[derive(Clone, Debug)]
pub enum Segment {
    /// Instructions that are run once.
    Once(Range<usize>),
    /// Instructions that are run until the tears stay where they are.
    Newton {
        /// The loop's instructions.
        instructions: Range<usize>,
        /// What it solves for.
        tears: Vec<Tear>,
    },
}

impl Segment {
    /// Its instructions.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        match self {
            Segment::Once(range) | Segment::Newton { instructions: range, .. } => range.clone(),
        }
    }

    /// What it solves for.
    #[must_use]
    pub fn tears(&self) -> &[Tear] {
        match self {
            Segment::Once(_) => &[],
            Segment::Newton { tears, .. } => tears,
        }
    }

    /// Whether it is run until its tears have settled.
    #[must_use]
    pub fn is_loop(&self) -> bool {
        matches!(self, Segment::Newton { .. })
    }

    /// The same, of instructions that stand so many places further on.
    fn shifted(self, by: usize) -> Segment {
        let shifted = |range: Range<usize>| range.start + by..range.end + by;
        match self {
            Segment::Once(range) => Segment::Once(shifted(range)),
            Segment::Newton { instructions, tears } => Segment::Newton { instructions: shifted(instructions), tears },
        }
    }

    /// The same with other registers.
    #[must_use]
    pub fn renumbered(mut self, new: impl Fn(Register) -> Register) -> Segment {
        if let Segment::Newton { tears, .. } = &mut self {
            for tear in tears {
                (tear.x, tear.delta) = (new(tear.x), new(tear.delta));
            }
        }
        self
    }
}

/// A coordinate that Newton solves for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Tear {
    /// Where its value stands.
    pub x: Register,
    /// Where the correction of it stands.
    pub delta: Register,
    /// What a change is judged against (m, or 1 rad).
    pub scale: f64,
    /// The width of a cell of its grid.
    pub cell: f64,
    /// One over [`Tear::scale`].
    pub per_scale: f64,
    /// One over [`Tear::cell`].
    pub per_cell: f64,
}

impl Tear {
    /// Of a coordinate that is judged against a scale (m, or 1 rad).
    fn new(x: Register, delta: Register, scale: f64) -> Tear {
        let cell = build::cell(scale);
        Tear { x, delta, scale, cell, per_scale: 1.0 / scale, per_cell: 1.0 / cell }
    }
}

/// What a solver is laid out for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Purpose {
    /// To be run here: registers are used again and again.
    Lanes,
    /// The same for variants in the lanes: with notes of the pivots, and every multiplier watched.
    Variants,
    /// To be written as code: with notes of the pivots, which tell branches apart, and a register of its own for every value.
    Code,
}

/// What is known of `Φ_q` where the orders of elimination are chosen.
pub trait Values {
    /// An entry by its position in the pattern, in scaled terms.
    fn entry(&self, position: usize) -> f64;
    /// The norm of a row in the scaled `Φ_q`.
    fn row_norm(&self, row: usize) -> f64;
}

impl Solver {
    /// Lays the solution of a system out; none where that takes too many operations.
    #[must_use]
    pub fn new(determined: &Determined, program: &Program, values: &impl Values) -> Option<Solver> {
        build::build(determined, program, values, (Purpose::Lanes, &|_| true))
    }

    /// As [`Solver::new`] to be written as code: with notes of the pivots, which tell branches apart, and with a register of its own
    /// for every value.
    #[must_use]
    pub fn for_code(determined: &Determined, program: &Program, values: &impl Values) -> Option<Solver> {
        build::build(determined, program, values, (Purpose::Code, &|_| true))
    }

    /// The same operations as those of [`Solver::new`], with notes of the pivots, for variants of a mechanism side by side; only what leads to
    /// some columns.
    #[must_use]
    pub fn for_variants(
        determined: &Determined,
        program: &Program,
        values: &impl Values,
        is_wanted: &dyn Fn(u32) -> bool,
    ) -> Option<Solver> {
        let whole = build::build(determined, program, values, (Purpose::Variants, &|_| true))?;
        // what joins components is read where it was left
        let read = |instruction: &Instruction| match *instruction {
            Instruction::Column { column, .. } => Some(column),
            _ => None,
        };
        let joining: Vec<u32> = whole.instructions.iter().filter_map(read).collect();
        let is_kept = |column: u32| is_wanted(column) || joining.contains(&column);
        build::build(determined, program, values, (Purpose::Variants, &is_kept))
    }

    /// What there is to run, in order.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The scale of a multiplier that is watched.
    #[must_use]
    pub fn weight(&self, number: u32) -> f64 {
        self.weights[number as usize]
    }

    /// What its operations note of pivots.
    #[must_use]
    pub fn pivots(&self) -> &[Pivot] {
        &self.pivots
    }

    /// The blocks whose determinants change with the position, by the numbers that pivots have.
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// Where its rows hold what.
    #[must_use]
    pub fn layout(&self) -> &RowLayout {
        &self.layout
    }

    /// The coordinates that Newton solves for.
    #[must_use]
    pub fn tears(&self) -> &[u32] {
        &self.tears
    }

    /// All instructions.
    #[must_use]
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// The program's registers that they load.
    pub fn loads(&self) -> impl Iterator<Item = Register> {
        self.instructions.iter().filter_map(|instruction| match *instruction {
            Instruction::Load { from, .. } => Some(from),
            _ => None,
        })
    }

    /// The columns in which they leave what only numbers and parameters lead to.
    fn prologue_columns(&self) -> impl Iterator<Item = u32> {
        stored_columns(&self.instructions[..self.prologue_len])
    }

    /// Which columns have one number at all times.
    pub fn is_prologue_column(&self) -> impl Fn(u32) -> bool + use<> {
        let is_among = self.column_mask(self.prologue_columns());
        move |column| is_among[column as usize]
    }

    /// Which columns they leave something in.
    pub fn is_stored_column(&self) -> impl Fn(u32) -> bool + use<> {
        let is_stored = self.column_mask(stored_columns(&self.instructions));
        move |column| is_stored[column as usize]
    }

    /// By column: whether it is among some.
    fn column_mask(&self, columns: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut is_among = vec![false; self.layout.stride];
        columns.for_each(|column| is_among[column as usize] = true);
        is_among
    }

    /// How many registers they need.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }
}

/// The columns in which instructions leave something.
fn stored_columns(instructions: &[Instruction]) -> impl Iterator<Item = u32> {
    instructions.iter().filter_map(|instruction| match *instruction {
        Instruction::Store { column, .. } => Some(column),
        _ => None,
    })
}
