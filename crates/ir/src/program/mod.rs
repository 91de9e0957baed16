//! From expressions to straight-line operations, and their evaluation.
//!
//! A program is one file of registers and a list of operations per [`Stage`]. Registers live through all stages, so
//! that what the position needed is not computed again for the acceleration. Common subexpressions are computed once
//! (the graph has them once), sine and cosine of an angle together.
//!
//! Where a formula has branches, the program has a [`Switch`]: its result can be frozen while a step is tried, and looked
//! at when the step is done.
//!
//! What depends on parameters alone is computed once, in the prologue; what depends on time alone, once per time and
//! not once per iteration.

#[allow(missing_docs)] // each is the number of the operation whose name it has
pub mod codes;
/// The text of the file, for emitted code that carries it along.
pub const CODES: &str = include_str!("codes.rs");
mod compile;
mod evaluate;
mod formulas;
mod interval_eval;
mod lanes;
mod op;
mod range_bounds;
mod tables;
mod time_terms;

pub use evaluate::{Frozen, Registers, truth};
pub use interval_eval::Enclosure;
pub use lanes::{LaneMachine, LaneValues};
pub use op::{Few, Machine, Op};
pub use range_bounds::{Hold, Range, Ranges};
pub use time_terms::Signal;

use crate::With;
use rustc_hash::FxHashSet;

/// A place for one number.
pub type Register = u32;

impl Stage {
    /// Whether what is computed here enters the equations as the motion goes on, so that it must be smooth within a step.
    /// A measure takes the branch it is on.
    #[must_use]
    pub fn can_switch(self) -> bool {
        !matches!(self, Stage::Prologue | Stage::Forces | Stage::Variation | Stage::Measures | Stage::Rims)
    }
}

/// When operations are run.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stage {
    /// Once: what depends on parameters alone, the estimates too.
    Prologue,
    /// Once per time: what depends on time alone.
    Time,
    /// Once per iteration: `Φ`, `Φ_q`, the conditions, what is watched.
    Position,
    /// `ν`.
    Velocity,
    /// `γ`; needs `q̇`.
    Acceleration,
    /// The right side of the jerk equation; needs `q̈`.
    Jerk,
    /// What the multipliers have to hold; needs `q̈`. At a jump of a load the later side counts.
    Forces,
    /// The right sides of the variations, each of which needs `q̇`, `q̈` and the variations before it. A branch is the one that the
    /// equations are on.
    Variation,
    /// The measures; needs all derivatives of `q`.
    Measures,
    /// The rims, where they are asked for; needs `q̇`.
    Rims,
}

/// All stages, in the order in which they may be run.
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
    Stage::Rims,
];

/// A column of a table.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Column {
    /// Where each piece begins, and where the last one ends.
    Knots,
    /// A coefficient of each piece, 0 to 3.
    Coefficient(u8),
}

impl Column {
    /// All columns of a table.
    pub const ALL: [Column; 5] =
        [Column::Knots, Column::Coefficient(0), Column::Coefficient(1), Column::Coefficient(2), Column::Coefficient(3)];

    /// Its place among all.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Column::Knots => 0,
            Column::Coefficient(order) => 1 + u32::from(order),
        }
    }
}

/// Where a table's columns stand: each is a run of registers.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TableLayout {
    /// Its name.
    pub name: String,
    /// One less than there are knots.
    pub pieces: u32,
    /// First knot.
    pub knots: Register,
    /// First of each coefficient.
    pub coefficients: [Register; 4],
    /// Of a periodic one: where it stands how many whole periods its arguments are beyond its range.
    pub periods: Vec<Register>,
    /// Where third derivatives of it stand, which jump at its knots.
    pub thirds: Vec<Register>,
}

impl TableLayout {
    /// The registers of a column.
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

/// Where a program finds its inputs; each is a run of registers.
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
    /// First signal: value, rate and acceleration of each, one behind the other.
    pub signals: Register,
    /// First of the derivatives of `q` by each input that is a signal, and then by each parameter where these are asked for; `n` for each.
    pub slopes: Register,
    /// Number of signals.
    pub count: u32,
    /// First of the variations: for each `q`, `q̇` and `q̈`, one behind the other.
    pub varied: Register,
    /// First multiplier, one for each equation where forces are asked for; behind them how these vary, variation by variation.
    pub multipliers: Register,
}

/// How equations that were left out change.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct PlacedCheckSlopes {
    /// With the coordinates: by the pattern of [`crate::CheckSlopes`].
    pub coordinates: Vec<Register>,
    /// With each input, one entry per check.
    pub inputs: Vec<Vec<Register>>,
    /// With each parameter, likewise.
    pub params: Vec<Vec<Register>>,
}

impl Inputs {
    /// First register of a variation of `q` (order 0), `q̇` or `q̈`.
    #[must_use]
    pub fn varied(&self, variation: u32, order: u32) -> Register {
        self.varied + (3 * variation + order) * self.n
    }

    /// First register of how the multipliers vary.
    #[must_use]
    pub fn varied_multipliers(&self, variation: u32) -> Register {
        self.multipliers + (1 + variation) * self.n
    }
}

impl Inputs {
    /// The registers of all signals.
    #[must_use]
    pub fn all_signals(&self) -> std::ops::Range<Register> {
        self.signals..self.signals + ORDERS * self.count
    }

    /// The register of a signal's value, rate or acceleration.
    #[must_use]
    pub fn signal(&self, signal: u32, order: u32) -> Register {
        self.signals + ORDERS * signal + order
    }
}

/// What is given of a signal: value, rate, acceleration.
const ORDERS: u32 = 3;

/// Where a program leaves its results.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Outputs {
    /// Where assembly starts, `n`.
    pub estimates: Vec<Register>,
    /// `Φ`, `n`.
    pub phi: Vec<Register>,
    /// `Φ_q`, in the order of its pattern's entries.
    pub phi_q: Vec<Register>,
    /// The right sides of the equations for the derivatives of `q`, in the order of what these are by.
    pub right_sides: Vec<PlacedSide>,
    /// `p` of `Φ_qᵀ λ = p`, `n`, or none where nobody asks for forces.
    pub forces: Vec<Register>,
    /// The right sides of each variation of `q`, `q̇` and `q̈`, `n` each.
    pub variations: Vec<[Vec<Register>; 3]>,
    /// Likewise of the multipliers; none of variations that have none.
    pub varied_forces: Vec<Vec<Register>>,
    /// By part of whose own equations there are variations: the entries of its matrix, row by row.
    pub scopes: Vec<Vec<Register>>,
    /// Derivatives that stand behind all other columns.
    pub appended: Vec<Register>,
    /// What joints exert and drivers supply, where that is tabulated.
    pub reactions: Vec<Register>,
    /// Measures' values.
    pub measures: Vec<Register>,
    /// Measures' first derivatives, where they have one.
    pub measures_d: Vec<Register>,
    /// Measures' second derivatives, where they have one.
    pub measures_dd: Vec<Register>,
    /// Formulas that must be positive.
    pub conditions: Vec<Register>,
    /// Entries of `Φ` that follow from the others.
    pub checks: Vec<Register>,
    /// How they change.
    pub check_slopes: PlacedCheckSlopes,
    /// Quantities that keep their signs.
    pub watches: Vec<Register>,
    /// Where formulas come to the end of what their functions take.
    pub rims: Vec<PlacedRim>,
    /// For each row, the terms of its sum, against whose size its rounding is judged.
    pub terms: Vec<Vec<Register>>,
}

/// Where a right side is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct PlacedSide {
    /// What `Φ = 0` was differentiated with.
    pub with: With,
    /// Its entries, `n`.
    pub entries: Vec<Register>,
}

impl Outputs {
    /// `ν`, `n`.
    #[must_use]
    pub fn nu(&self) -> &[Register] {
        self.right_side(With::Time(1))
    }

    /// `γ`, `n`.
    #[must_use]
    pub fn gamma(&self) -> &[Register] {
        self.right_side(With::Time(2))
    }

    /// Right side of the jerk equation, `n`, or none.
    #[must_use]
    pub fn jerk(&self) -> &[Register] {
        self.right_side(With::Time(3))
    }

    /// By input: the right side of the equation for the derivatives of `q` by it, `n`.
    pub fn by_inputs(&self) -> impl Iterator<Item = &[Register]> {
        self.all_with(|with| matches!(with, With::Input(_)))
    }

    /// Likewise by parameter, where that is asked for.
    pub fn by_params(&self) -> impl Iterator<Item = &[Register]> {
        self.all_with(|with| matches!(with, With::Param(_)))
    }

    fn right_side(&self, wanted: With) -> &[Register] {
        self.all_with(|with| with == wanted).next().unwrap_or_default()
    }

    fn all_with(&self, is_wanted: impl Fn(With) -> bool) -> impl Iterator<Item = &[Register]> {
        self.right_sides.iter().filter(move |side| is_wanted(side.with)).map(|side| side.entries.as_slice())
    }

    /// Shows every register of a result.
    fn all(&self, mut show: impl FnMut(Register)) {
        let lists = [&self.estimates, &self.phi, &self.phi_q, &self.forces];
        let more = [&self.measures, &self.measures_d, &self.measures_dd, &self.conditions, &self.checks, &self.watches];
        let more = more.into_iter().chain([&self.appended, &self.reactions, &self.check_slopes.coordinates]);
        let slopes = self.check_slopes.inputs.iter().chain(&self.check_slopes.params);
        let varied = self.variations.iter().flatten().chain(&self.varied_forces);
        let sides = self.right_sides.iter().map(|side| &side.entries);
        let more_lists = sides.chain(&self.terms).chain(varied).chain(slopes);
        lists.into_iter().chain(more).chain(more_lists).flatten().for_each(|&register| show(register));
        for rim in &self.rims {
            [rim.gauge, rim.slope].iter().chain(&rim.terms).for_each(|&register| show(register));
        }
    }
}

/// Where a quantity stands at whose zero a formula may have an edge.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct PlacedRim {
    /// The quantity.
    pub gauge: Register,
    /// Its time derivative.
    pub slope: Register,
    /// The terms of its sum, against whose size its rounding is judged.
    pub terms: Vec<Register>,
    /// Whether it depends on time alone.
    pub on_time: bool,
}

/// Operations that evaluate a constraint system.
#[derive(Clone, Debug)]
pub struct Program {
    operations: Vec<Vec<Op>>,
    tables: Vec<TableLayout>,
    /// Where the right side of an equation may have an edge, in order of evaluation.
    switches: Vec<Switch>,
    constants: Vec<(Register, f64)>,
    registers: usize,
    /// Where the inputs go.
    pub inputs: Inputs,
    /// Where the results are.
    pub outputs: Outputs,
}

/// An operation whose result goes in jumps: a comparison, a rounding, the piece of a table.
///
/// While registers are frozen its result stays, so that what is computed from it goes on smoothly beyond its edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Switch {
    /// The operation.
    pub op: Op,
    /// Where its result stands.
    pub to: Register,
    /// Whether it depends on time alone.
    pub on_time: bool,
}

impl Program {
    /// The same with its signals as inputs: without the operations that say what they are by the text. Registers stay what they are.
    #[must_use]
    pub fn with_signals_given(&self) -> Program {
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

    /// The same without results by parameter.
    #[must_use]
    pub fn without_params(&self) -> Program {
        let mut program = self.clone();
        program.outputs.right_sides.retain(|side| !matches!(side.with, With::Param(_)));
        program
    }

    /// The same without what joints exert and drivers supply, as columns of their own.
    #[must_use]
    pub fn without_reactions(&self) -> Program {
        let mut program = self.clone();
        program.outputs.reactions.clear();
        program
    }

    /// The tables, by their number.
    #[must_use]
    pub fn tables(&self) -> &[TableLayout] {
        &self.tables
    }

    /// Where the equations may have edges.
    #[must_use]
    pub fn switches(&self) -> &[Switch] {
        &self.switches
    }

    /// The operations of a stage.
    #[must_use]
    pub fn stage(&self, stage: Stage) -> &[Op] {
        &self.operations[stage as usize]
    }

    /// The numbers that stand in registers from the start.
    #[must_use]
    pub fn constants(&self) -> &[(Register, f64)] {
        &self.constants
    }

    /// What each register is written by, if by an operation, and when.
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

    /// How many registers it needs.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// The registers that an operation reads, tables' columns too.
    pub fn reads(&self, op: Op) -> impl Iterator<Item = Register> + use<> {
        let cells = op.column().map_or(0..0, |(table, column)| self.tables[table as usize].column(column));
        cells.chain(op.reads())
    }
}
