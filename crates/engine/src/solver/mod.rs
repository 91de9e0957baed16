//! Compiles a determined system to straight-line instructions that solve it, and runs them.
//!
//! How a system is solved:
//!
//! - Blocks that depend on each other make a component; components are independent.
//! - In a block, equations with a constant pivot, mostly `±1`, give their coordinate by assignment once the others are solved. A few *tears* remain,
//!   guessed from the motion so far, with as many equations, which Newton solves.
//! - The linear systems of Newton, velocity, acceleration and jerk are eliminated symbolically in one order (`order`), with constant folding,
//!   dead-code elimination and register allocation. Velocity and acceleration share the factors.
//!
//! A tear's iterates lie on a grid, coarse compared with rounding and fine compared with convergence: the last Newton step begins at the grid point
//! nearest to the solution. So the numbers do not depend on the initial guess (`crates/runtime/src/grid.rs`).
//!
//! The instructions run at several times or for several variants, as [`Lanes`]; each lane has the bits that it has alone.
//!
//! The solver knows the constraint system and its operations, but neither motion, steps nor events.

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
pub(crate) use lanes::CHUNK;
pub use lanes::{Batch, Lanes};
pub(crate) use order::{BlockEntry, Order};
pub use pivoting::BlockTables;
pub(crate) use pivoting::{Equations, Pivoting};
pub use predictor::Bend;
pub(crate) use variants::{VariantBatch, VariantLanes};

use crate::limits::solver::LARGEST_MULTIPLIER;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::{Program, Register};
use mechc_ir::structure::Determined;
use std::ops::Range;

/// Maximum number of operations of an elimination that is compiled.
const MOST_OPERATIONS: usize = 30_000_000;

/// The instructions that solve a constraint system at given times: position, velocity, acceleration, measures.
#[derive(Clone, Debug)]
pub struct Solver {
    /// The instructions of all components, contiguous because they are read in sequence.
    instructions: Vec<Instruction>,
    /// The number of leading instructions, the prologue, that run once for numbers and parameters; 0 without a prologue.
    prologue_len: usize,
    /// The segments in order of execution: by component, and last the shared outputs, which read the stored columns of components.
    segments: Vec<Segment>,
    registers: usize,
    /// The weights of checked multipliers.
    weights: Vec<f64>,
    tears: Vec<u32>,
    /// The variable pivots; empty for [`Purpose::Lanes`].
    pivots: Vec<Pivot>,
    turns: Vec<Turn>,
    /// The number of monitors; 0 unless the purpose is [`Purpose::Variants`].
    monitors: usize,
    layout: RowLayout,
}

/// A pivot that is not constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pivot {
    /// The index in [`Solver::turns`] of its block.
    pub turn: u32,
    /// The scale that makes its inverse dimensionless.
    pub weight: f64,
}

/// A block whose determinant depends on the position.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Turn {
    /// The number of the block.
    pub block: u32,
    /// True if the determinant is negative if the product of its variable pivots is positive.
    pub is_negative: bool,
}

/// The flag of a register of the prologue while a solver is generated.
const PROLOGUE: Register = 1 << 31;

/// The instructions of blocks that depend on each other, in an order of solution.
#[derive(Clone, Debug, Default)]
struct Component {
    /// The instructions that depend on numbers and parameters alone, if they are hoisted, and the number of their registers, each with the flag
    /// [`PROLOGUE`].
    prologue: Vec<Instruction>,
    prologue_registers: usize,
    instructions: Vec<Instruction>,
    segments: Vec<Segment>,
    registers: usize,
}

/// Instructions that run once, or until their tears converge.
#[derive(Clone, Debug)]
pub enum Segment {
    /// Instructions that run once.
    Once(Range<usize>),
    /// Instructions that run until the tears converge.
    Newton {
        /// The instructions of the loop.
        instructions: Range<usize>,
        /// The tears that it solves for.
        tears: Vec<Tear>,
    },
}

impl Segment {
    /// Returns the range of its instructions.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        match self {
            Segment::Once(range) | Segment::Newton { instructions: range, .. } => range.clone(),
        }
    }

    /// Returns the tears that it solves for.
    #[must_use]
    pub fn tears(&self) -> &[Tear] {
        match self {
            Segment::Once(_) => &[],
            Segment::Newton { tears, .. } => tears,
        }
    }

    /// Returns whether it is a Newton loop.
    #[must_use]
    pub(crate) fn is_loop(&self) -> bool {
        matches!(self, Segment::Newton { .. })
    }

    /// Moves the segment by a number of instructions.
    fn shifted(self, by: usize) -> Segment {
        let shifted = |range: Range<usize>| range.start + by..range.end + by;
        match self {
            Segment::Once(range) => Segment::Once(shifted(range)),
            Segment::Newton { instructions, tears } => Segment::Newton { instructions: shifted(instructions), tears },
        }
    }

    /// Replaces the registers.
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
    /// The register of its value.
    pub x: Register,
    /// The register of its correction.
    pub delta: Register,
    /// The scale of its changes (m, or 1 rad).
    pub scale: f64,
    /// The width of a grid cell (m or rad).
    pub cell: f64,
    /// The inverse of [`Tear::scale`].
    pub per_scale: f64,
    /// The inverse of [`Tear::cell`].
    pub per_cell: f64,
}

impl Tear {
    /// Creates a tear with a scale (m, or 1 rad).
    fn new(x: Register, delta: Register, scale: f64) -> Tear {
        let cell = build::cell(scale);
        Tear { x, delta, scale, cell, per_scale: 1.0 / scale, per_cell: 1.0 / cell }
    }
}

/// The purpose that a solver is generated for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Purpose {
    /// Lanes at several times: registers are reused.
    Lanes,
    /// Lanes of several variants: registers are reused, pivots and monitors are recorded, and every multiplier is checked.
    Variants,
    /// Emitted code: the pivots, which distinguish branches, are recorded, and every value has its own register.
    Code,
}

/// Reference values of `Φ_q`, by which orders of elimination are chosen.
pub(crate) trait Values {
    /// Returns a scaled entry by its position in the pattern.
    fn entry(&self, position: usize) -> f64;
    /// Returns the norm of a row of the scaled `Φ_q`.
    fn row_norm(&self, row: usize) -> f64;
}

impl Solver {
    /// Generates a solver for lanes at several times; returns `None` if that takes too many instructions.
    #[must_use]
    pub(crate) fn new(determined: &Determined, program: &Program, reference: &impl Values) -> Option<Solver> {
        build::build(determined, program, reference, Purpose::Lanes, &|_| true)
    }

    /// Generates a solver for emitted code, which records the pivots and has a register for every value; returns `None` if that takes too many
    /// instructions.
    #[must_use]
    pub(crate) fn for_code(determined: &Determined, program: &Program, reference: &impl Values) -> Option<Solver> {
        build::build(determined, program, reference, Purpose::Code, &|_| true)
    }

    /// Generates a solver for lanes of variants, with the operations of [`Solver::new`], which records pivots and monitors and computes only what
    /// these and the requested columns depend on. Returns `None` if that takes too many instructions.
    #[must_use]
    pub(crate) fn for_variants(
        determined: &Determined,
        program: &Program,
        reference: &impl Values,
        is_requested: &dyn Fn(u32) -> bool,
    ) -> Option<Solver> {
        let whole = build::build(determined, program, reference, Purpose::Variants, &|_| true)?;
        // shared outputs read columns, which must be stored too
        let read = |instruction: &Instruction| match *instruction {
            Instruction::Column { column, .. } => Some(column),
            _ => None,
        };
        let shared: Vec<u32> = whole.instructions.iter().filter_map(read).collect();
        let is_kept = |column: u32| is_requested(column) || shared.contains(&column);
        build::build(determined, program, reference, Purpose::Variants, &is_kept)
    }

    /// Returns the segments in order of execution.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Returns the weight of a checked multiplier: its product with the multiplier is dimensionless.
    #[must_use]
    pub fn weight(&self, number: u32) -> f64 {
        self.weights[number as usize]
    }

    /// Returns the variable pivots, if they are recorded.
    #[must_use]
    pub fn pivots(&self) -> &[Pivot] {
        &self.pivots
    }

    /// Returns the blocks whose determinants depend on the position, in the order of [`Pivot::turn`].
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// Returns the layout of its rows.
    #[must_use]
    pub fn layout(&self) -> &RowLayout {
        &self.layout
    }

    /// Returns the coordinates that Newton solves for.
    #[must_use]
    pub fn tears(&self) -> &[u32] {
        &self.tears
    }

    /// Returns all instructions.
    #[must_use]
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// Returns the program's registers that the instructions load.
    pub(crate) fn loads(&self) -> impl Iterator<Item = Register> {
        self.instructions.iter().filter_map(|instruction| match *instruction {
            Instruction::Load { from, .. } => Some(from),
            _ => None,
        })
    }

    /// Returns the columns that the prologue stores.
    fn prologue_columns(&self) -> impl Iterator<Item = u32> {
        stored_columns(&self.instructions[..self.prologue_len])
    }

    /// Returns a predicate: whether a column is stored by the prologue, and so is equal at all times.
    pub(crate) fn is_prologue_column(&self) -> impl Fn(u32) -> bool + use<> {
        let is_among = self.column_mask(self.prologue_columns());
        move |column| is_among[column as usize]
    }

    /// Returns a predicate: whether a column is stored.
    pub(crate) fn is_stored_column(&self) -> impl Fn(u32) -> bool + use<> {
        let is_stored = self.column_mask(stored_columns(&self.instructions));
        move |column| is_stored[column as usize]
    }

    /// Returns by column whether it is among `columns`.
    fn column_mask(&self, columns: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut is_among = vec![false; self.layout.stride];
        columns.for_each(|column| is_among[column as usize] = true);
        is_among
    }

    /// Returns the number of registers.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }
}

/// Returns the columns that instructions store.
fn stored_columns(instructions: &[Instruction]) -> impl Iterator<Item = u32> {
    instructions.iter().filter_map(|instruction| match *instruction {
        Instruction::Store { column, .. } => Some(column),
        _ => None,
    })
}
