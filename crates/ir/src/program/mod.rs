//! Programs: expressions compiled to straight-line operations, and their evaluation.
//!
//! A program has one register file and a list of operations per [`Stage`]. Registers live through all stages, so the acceleration reuses
//! what the position has computed. The graph holds common subexpressions once; sine and cosine of an angle are computed together.
//!
//! Each branch of a formula is decided by a [`Switch`], whose result can be frozen while a step is tried, and checked when the step is done.
//!
//! Operations that depend on parameters alone run once, in the prologue; those that depend on time alone run once per time and not once per
//! iteration.

mod compile;
mod evaluate;
mod formulas;
mod interval_eval;
mod lanes;
mod op;
mod range_bounds;
mod tables;
mod time_terms;

pub use evaluate::{FrozenSwitches, Registers, truth};
pub use interval_eval::Enclosure;
pub use lanes::{LaneMachine, LaneValues};
pub use op::{Machine, Op, RegisterList};
pub use range_bounds::{Range, Ranges, Restriction};
pub use time_terms::Signal;

use crate::With;
use rustc_hash::FxHashSet;

/// Index of a register, which holds one number.
pub type Register = u32;

impl Stage {
    /// Returns whether operations of this stage enter the equations along the motion, so that they must be smooth within a step. In other
    /// stages a formula takes the branch that the equations are on.
    #[must_use]
    pub fn can_switch(self) -> bool {
        !matches!(self, Stage::Prologue | Stage::Forces | Stage::Variation | Stage::Measures | Stage::DomainBoundaries)
    }
}

/// Stages of evaluation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stage {
    /// Once: operations that depend on parameters alone, and the estimates.
    Prologue,
    /// Once per time: operations that depend on time alone.
    Time,
    /// Once per iteration: `Φ`, `Φ_q`, conditions and monitors.
    Position,
    /// `ν`.
    Velocity,
    /// `γ`; needs `q̇`.
    Acceleration,
    /// The right side of the jerk equation; needs `q̈`.
    Jerk,
    /// The forces that the multipliers balance; needs `q̈`. At a jump of a load the later side counts.
    Forces,
    /// The right sides of the variations; each needs `q̇`, `q̈` and the variations before it. Branches are those of the equations.
    Variation,
    /// The measures; needs all derivatives of `q`.
    Measures,
    /// The domain boundaries, where they are evaluated; needs `q̇`.
    DomainBoundaries,
}

/// All stages, in the order of evaluation.
pub const STAGES: [Stage; 10] = [
    Stage::Prologue,
    Stage::Time,
    Stage::Position,
    Stage::Velocity,
    Stage::Acceleration,
    Stage::Jerk,
    Stage::Forces,
    Stage::Variation,
    Stage::Measures,
    Stage::DomainBoundaries,
];

/// A column of a spline table.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Column {
    /// First arguments of the pieces, followed by the end of the last piece.
    Knots,
    /// Coefficients of one degree, 0 to 3, one per piece.
    Coefficient(u8),
}

impl Column {
    /// All columns of a table.
    pub const ALL: [Column; 5] =
        [Column::Knots, Column::Coefficient(0), Column::Coefficient(1), Column::Coefficient(2), Column::Coefficient(3)];
}

/// Registers of a table; each column is a run of consecutive registers.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TableLayout {
    /// Name.
    pub name: String,
    /// Number of pieces, one less than knots.
    pub pieces: u32,
    /// First knot.
    pub knots: Register,
    /// First register of each coefficient column.
    pub coefficients: [Register; 4],
    /// Registers of the number of whole periods that arguments of a periodic table lie beyond its range.
    pub periods: Vec<Register>,
    /// Registers of its third derivatives, which jump at the knots.
    pub thirds: Vec<Register>,
}

impl TableLayout {
    /// Returns the registers of a column.
    #[must_use]
    pub fn column(&self, column: Column) -> std::ops::Range<Register> {
        match column {
            Column::Knots => self.knots..self.knots + self.pieces + 1,
            Column::Coefficient(order) => {
                let first = self.coefficients[usize::from(order)];
                first..first + self.pieces
            }
        }
    }
}

/// Registers of the inputs; each field is the start of a run of registers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Inputs {
    /// First parameter.
    pub params: Register,
    /// Time (s).
    pub time: Register,
    /// First of `q`, `q̇`, `q̈`, `q⃛`.
    pub coordinates: [Register; 4],
    /// Number of coordinates.
    pub n: u32,
    /// First signal; value, rate and acceleration of each are adjacent.
    pub signals: Register,
    /// First derivative of `q` with respect to each input signal, then each parameter if requested; `n` for each.
    pub slopes: Register,
    /// Number of signals.
    pub count: u32,
    /// First variation: `q`, `q̇` and `q̈` of each, one after the other.
    pub varied: Register,
    /// First multiplier, one per equation if forces are requested; followed by the variations of all multipliers.
    pub multipliers: Register,
}

/// Registers of the slopes of left-out equations.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct CheckSlopeRegisters {
    /// Slopes with respect to coordinates, in the order of [`crate::CheckSlopes::pattern`].
    pub coordinates: Vec<Register>,
    /// Slopes with respect to each input, one entry per check.
    pub inputs: Vec<Vec<Register>>,
    /// Slopes with respect to each parameter, one entry per check.
    pub params: Vec<Vec<Register>>,
}

impl Inputs {
    /// Returns the first register of a variation of `q` (order 0), `q̇` (1) or `q̈` (2).
    #[must_use]
    pub fn varied(&self, variation: u32, order: u32) -> Register {
        self.varied + (3 * variation + order) * self.n
    }

    /// Returns the first register of the varied multipliers of a variation.
    #[must_use]
    pub fn varied_multipliers(&self, variation: u32) -> Register {
        self.multipliers + (1 + variation) * self.n
    }
}

impl Inputs {
    /// Returns the registers of all signals.
    #[must_use]
    pub fn all_signals(&self) -> std::ops::Range<Register> {
        self.signals..self.signals + ORDERS * self.count
    }

    /// Returns the register of a signal's value (order 0), rate (1) or acceleration (2).
    #[must_use]
    pub fn signal(&self, signal: u32, order: u32) -> Register {
        self.signals + ORDERS * signal + order
    }
}

/// Number of values per signal: value, rate, acceleration.
const ORDERS: u32 = 3;

/// Registers of the results. `n` is the number of coordinates.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Outputs {
    /// Estimates of the coordinates, `n`.
    pub estimates: Vec<Register>,
    /// `Φ`, `n`.
    pub phi: Vec<Register>,
    /// `Φ_q`, in the order of the entries of its pattern.
    pub phi_q: Vec<Register>,
    /// Right sides of the differentiated equations, in the order of [`With`].
    pub right_sides: Vec<RightSideRegisters>,
    /// `p` of `Φ_qᵀ λ = p`, `n`; empty if forces are not requested.
    pub forces: Vec<Register>,
    /// Right sides of each variation of `q`, `q̇` and `q̈`, `n` each.
    pub variations: Vec<[Vec<Register>; 3]>,
    /// Right sides of the varied multipliers of each variation; empty where it has none.
    pub varied_forces: Vec<Vec<Register>>,
    /// Derivative columns.
    pub appended: Vec<Register>,
    /// Reactions and efforts, if they are tabulated.
    pub reactions: Vec<Register>,
    /// Values of the measures.
    pub measures: Vec<Register>,
    /// First time derivatives of the measures that have one.
    pub measures_d: Vec<Register>,
    /// Second time derivatives of the measures that have one.
    pub measures_dd: Vec<Register>,
    /// Formulas that must be positive.
    pub conditions: Vec<Register>,
    /// Entries of `Φ` that are checked instead of solved.
    pub checks: Vec<Register>,
    /// Slopes of the checks.
    pub check_slopes: CheckSlopeRegisters,
    /// Quantities that keep their signs along a branch.
    pub watches: Vec<Register>,
    /// Domain boundaries.
    pub domain_boundaries: Vec<BoundaryRegisters>,
    /// Terms of the sum of each row, which scale its rounding.
    pub terms: Vec<Vec<Register>>,
}

/// Registers of a right side.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct RightSideRegisters {
    /// Variable of differentiation.
    pub with: With,
    /// Entries, `n`.
    pub entries: Vec<Register>,
}

impl Outputs {
    /// Returns `ν`, `n` registers.
    #[must_use]
    pub fn nu(&self) -> &[Register] {
        self.right_side(With::Time(1))
    }

    /// Returns `γ`, `n` registers.
    #[must_use]
    pub fn gamma(&self) -> &[Register] {
        self.right_side(With::Time(2))
    }

    /// Returns the right side of the jerk equation, `n` registers; empty if it has none.
    #[must_use]
    pub fn jerk(&self) -> &[Register] {
        self.right_side(With::Time(3))
    }

    /// Returns for each input the right side for the derivatives of `q` with respect to it, `n` registers.
    pub fn by_inputs(&self) -> impl Iterator<Item = &[Register]> {
        self.all_with(|with| matches!(with, With::Input(_)))
    }

    /// Returns for each parameter the right side for the derivatives of `q` with respect to it, if requested.
    pub fn by_params(&self) -> impl Iterator<Item = &[Register]> {
        self.all_with(|with| matches!(with, With::Param(_)))
    }

    fn right_side(&self, with: With) -> &[Register] {
        self.all_with(|other| other == with).next().unwrap_or_default()
    }

    fn all_with(&self, is_selected: impl Fn(With) -> bool) -> impl Iterator<Item = &[Register]> {
        self.right_sides.iter().filter(move |side| is_selected(side.with)).map(|side| side.entries.as_slice())
    }

    /// Calls `show` with every register of a result.
    fn all(&self, mut show: impl FnMut(Register)) {
        let lists = [&self.estimates, &self.phi, &self.phi_q, &self.forces];
        let more = [&self.measures, &self.measures_d, &self.measures_dd, &self.conditions, &self.checks, &self.watches];
        let more = more.into_iter().chain([&self.appended, &self.reactions, &self.check_slopes.coordinates]);
        let slopes = self.check_slopes.inputs.iter().chain(&self.check_slopes.params);
        let varied = self.variations.iter().flatten().chain(&self.varied_forces);
        let sides = self.right_sides.iter().map(|side| &side.entries);
        let more_lists = sides.chain(&self.terms).chain(varied).chain(slopes);
        lists.into_iter().chain(more).chain(more_lists).flatten().for_each(|&register| show(register));
        for boundary in &self.domain_boundaries {
            [boundary.gauge].iter().chain(&boundary.slope).chain(&boundary.terms).for_each(|&register| show(register));
        }
    }
}

/// Registers of a domain boundary.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct BoundaryRegisters {
    /// The event function.
    pub gauge: Register,
    /// Its time derivative; `None` where the motion decides.
    pub slope: Option<Register>,
    /// Terms of its sum, which scale its rounding.
    pub terms: Vec<Register>,
}

impl BoundaryRegisters {
    /// Returns whether it depends on time alone.
    #[must_use]
    pub fn is_of_time(&self) -> bool {
        self.slope.is_some()
    }
}

/// Straight-line operations that evaluate a constraint system.
#[derive(Clone, Debug)]
pub struct Program {
    operations: Vec<Vec<Op>>,
    tables: Vec<TableLayout>,
    /// Switches of the equations, in order of evaluation.
    switches: Vec<Switch>,
    constants: Vec<(Register, f64)>,
    registers: usize,
    /// Registers of the inputs.
    pub inputs: Inputs,
    /// Registers of the results.
    pub outputs: Outputs,
}

/// An operation whose result jumps: a comparison, a rounding, the piece of a table.
///
/// A frozen switch keeps its result, so that formulas continue smoothly beyond the edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Switch {
    /// The operation.
    pub op: Op,
    /// Register of its result.
    pub to: Register,
    /// True if it depends on time alone.
    pub on_time: bool,
}

impl Program {
    /// Returns the program with signals as inputs: without the operations that compute them from the text's formulas. Registers keep their indices.
    #[must_use]
    pub fn with_signals_as_inputs(&self) -> Program {
        let signals = self.inputs.all_signals();
        let mut is_read = vec![false; self.registers];
        self.outputs.all(|register| is_read[register as usize] = true);
        let mut operations = self.operations.clone();
        for stage in STAGES.into_iter().rev() {
            let mut kept: Vec<Op> = Vec::new();
            for &op in self.stage(stage).iter().rev() {
                let is_needed = |&to: &Register| is_read[to as usize] && !signals.contains(&to);
                if op.writes().iter().any(is_needed) {
                    for register in self.reads(op) {
                        is_read[register as usize] = true;
                    }
                    kept.push(op);
                }
            }
            kept.reverse();
            operations[stage as usize] = kept;
        }
        let writes = |op: &Op| op.writes()[0];
        let written: FxHashSet<Register> = operations.iter().flatten().map(writes).collect();
        let stays = |switch: &Switch| written.contains(&switch.to);
        let switches = self.switches.iter().copied().filter(stays).collect();
        Program { operations, switches, ..self.clone() }
    }

    /// Returns the program without right sides for parameters.
    #[must_use]
    pub fn without_params(&self) -> Program {
        let mut program = self.clone();
        program.outputs.right_sides.retain(|side| !matches!(side.with, With::Param(_)));
        program
    }

    /// Returns the program without reaction columns.
    #[must_use]
    pub fn without_reactions(&self) -> Program {
        let mut program = self.clone();
        program.outputs.reactions.clear();
        program
    }

    /// Returns the tables, by number.
    #[must_use]
    pub fn tables(&self) -> &[TableLayout] {
        &self.tables
    }

    /// Returns the switches of the equations.
    #[must_use]
    pub fn switches(&self) -> &[Switch] {
        &self.switches
    }

    /// Returns the operations of a stage.
    #[must_use]
    pub fn stage(&self, stage: Stage) -> &[Op] {
        &self.operations[stage as usize]
    }

    /// Returns the registers that hold constants, with their values.
    #[must_use]
    pub fn constants(&self) -> &[(Register, f64)] {
        &self.constants
    }

    /// Returns for each register the operation that writes it, with its stage; `None` for inputs and constants.
    #[must_use]
    pub fn definitions(&self) -> Vec<Option<(Stage, Op)>> {
        let mut definitions = vec![None; self.registers];
        for stage in STAGES {
            for &op in self.stage(stage) {
                for register in op.writes() {
                    definitions[register as usize] = Some((stage, op));
                }
            }
        }
        definitions
    }

    /// Returns the number of registers.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// Returns the registers that an operation reads, with those of the table columns that it looks into.
    pub fn reads(&self, op: Op) -> impl Iterator<Item = Register> + use<> {
        let cells = op.column().map_or(0..0, |(table, column)| self.tables[table as usize].column(column));
        cells.chain(op.reads())
    }
}
