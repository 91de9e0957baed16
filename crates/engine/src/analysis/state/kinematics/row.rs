//! Rows of the result, with the forces and the variations of a state.

use super::derivatives::rates;
use super::{Kinematics, State};
use crate::analysis::state::linear::BlockLu;
use crate::solver::Pivoting;
use mechc_expr::{Dependence, ExprId};
use mechc_ir::ConstraintSystem;
use mechc_ir::layout::{self, ColumnContent};
use mechc_ir::program::{Program, Register, Registers, Stage};
use mechc_ir::structure::Determined;
use std::sync::Arc;

/// Closest distance to a singular position at which derivatives with respect to inputs and parameters are computed: they grow there,
/// and each order amplifies rounding.
const TRUSTED: f64 = 1e-3;

/// Data for derivatives by inputs and parameters.
#[derive(Clone)]
pub(super) struct Varied {
    /// A variation of all coordinates.
    solution: Vec<f64>,
    /// By column of a row, whether it may have no value at a position.
    columns: Vec<bool>,
}

/// Returns whether a column may lack a value at a valid position: reactions, efforts, derivatives by inputs or params, measures of either.
fn may_be_missing(system: &ConstraintSystem, holds: &ColumnContent) -> bool {
    let is_of_solution = |id: ExprId| {
        let dependence = system.graph().dependence(id);
        dependence.highest_varied_order().is_some() || dependence.on(Dependence::FORCES)
    };
    match *holds {
        ColumnContent::Time
        | ColumnContent::Coordinate { .. }
        | ColumnContent::Slope { .. }
        | ColumnContent::Varied
        | ColumnContent::Multiplier => false,
        ColumnContent::Measure { index, order } => {
            system.measures()[index].derivative(order).is_some_and(is_of_solution)
        }
        ColumnContent::Reaction(_) | ColumnContent::DerivativeColumn(_) => true,
    }
}

/// Quantity that may have no value at a position where the mechanism has one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Unknown {
    /// A measure, by its index.
    Measure(usize),
    /// All derivatives by one variable, by its index.
    Derivative(usize),
    /// All reactions and efforts.
    Forces,
}

impl Varied {
    pub fn new(system: &ConstraintSystem, holds: &[ColumnContent]) -> Varied {
        if system.all_variations().is_none() && system.forces().is_none() {
            return Varied { solution: Vec::new(), columns: Vec::new() };
        }
        let columns = holds.iter().map(|holds| may_be_missing(system, holds)).collect();
        Varied { solution: vec![0.0; system.coordinates().len()], columns }
    }
}

impl Kinematics {
    /// Writes a result row of a state whose derivatives were just computed.
    pub fn write_row(&mut self, state: &State, row: &mut [f64]) {
        self.vary(state);
        self.write_columns(state, row);
    }

    /// Returns whether a column of a row may have no value: a force, or a derivative by an input or parameter.
    pub fn may_be_missing(&self, column: usize) -> bool {
        self.variations.columns.get(column).copied().unwrap_or(false)
    }

    /// Returns the same equations and scales with the variations that results need; `None` if they need none.
    pub fn with_variations_of_results(&self) -> Option<Kinematics> {
        let determined = Arc::new(self.determined.with_result_variations()?);
        let program = Arc::new(Program::new(determined.system()));
        let params = determined.system().param_values();
        let holds = layout::holds(determined.system());
        let (registers, variations) = (program.start(&params), Varied::new(determined.system(), &holds));
        Some(Kinematics { determined, program, registers, variations, holds, ..self.clone() })
    }

    /// Computes the forces and variations of a state that was solved for, where they can be trusted.
    pub fn vary_at(&mut self, state: &State) {
        self.set_time(state.t);
        let is_regular = self.set_position(&state.q).is_ok() && self.factor().is_ok();
        self.set_derivatives(state);
        if is_regular {
            self.vary(state);
        } else {
            self.leave_variations_out();
        }
    }

    /// Returns the changes of a coordinate, its velocity and its acceleration in a variation.
    pub fn variation(&self, number: u32, coordinate: usize) -> [f64; 3] {
        [0, 1, 2].map(|order| self.registers.get(self.program.inputs.varied(number, order) + coordinate as u32))
    }

    /// Returns the multiplier of a row, where forces have been computed.
    pub fn multiplier(&self, row: usize) -> f64 {
        self.registers.get(self.program.inputs.multipliers + row as Register)
    }

    /// Returns the change of a row's multiplier in a variation, where forces have been computed.
    pub fn varied_multiplier(&self, number: u32, row: usize) -> f64 {
        self.registers.get(self.program.inputs.varied_multipliers(number) + row as Register)
    }

    /// Computes the forces and variations of a state whose derivatives were just computed, where they can be trusted.
    fn vary(&mut self, state: &State) {
        if !self.has_more_to_solve() {
            return;
        }
        self.registers.set_all(self.program.inputs.coordinates[2], &state.qdd);
        if self.linear.nearness(TRUSTED) < TRUSTED {
            self.leave_variations_out();
            return;
        }
        solve_for_more(&self.determined, &self.program, &mut self.registers, &mut self.variations, &mut self.linear);
    }

    /// Returns whether there is more to solve for than the motion.
    fn has_more_to_solve(&self) -> bool {
        self.system().forces().is_some() || !self.system().variations().is_empty()
    }

    /// Marks forces and variations as missing at this position.
    fn leave_variations_out(&mut self) {
        let inputs = self.program.inputs;
        let (variations, has_forces) = (self.system().variations().len() as u32, self.system().forces().is_some());
        let last = if has_forces { inputs.varied_multipliers(variations) } else { inputs.varied(variations, 0) };
        for register in inputs.varied..last {
            self.registers.set(register, f64::NAN);
        }
        // measures share subexpressions with the right sides
        self.program.run(Stage::Forces, &mut self.registers);
        self.program.run(Stage::Variation, &mut self.registers);
    }

    fn write_columns(&mut self, state: &State, row: &mut [f64]) {
        let (program, registers) = (&*self.program, &mut self.registers);
        let [_, _, qdd, _] = program.inputs.coordinates;
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Measures, registers);
        let outputs = &program.outputs;
        let none = Vec::new();
        let lists = [
            (&state.q, &outputs.reactions, &outputs.measures),
            (&state.qd, &none, &outputs.measures_d),
            (&state.qdd, &none, &outputs.measures_dd),
        ];
        let mut cells = row.iter_mut();
        let mut put = |value: f64| {
            if let Some(cell) = cells.next() {
                // print 0 rather than −0
                *cell = value + 0.0;
            }
        };
        put(state.t);
        for (coordinates, reactions, measures) in lists {
            for &value in coordinates {
                put(value);
            }
            for &register in reactions.iter().chain(measures) {
                put(registers.get(register));
            }
        }
        for &register in &outputs.appended {
            put(registers.get(register));
        }
    }

    /// Solves for a row with partial pivoting, from the position that it holds (m, rad); returns whether the solution holds.
    pub fn pivoted_row(&mut self, pivoting: &mut Pivoting, state: &mut State, row: &mut [f64]) -> bool {
        self.set_time(state.t);
        if !pivoting.position(self, &mut state.q) || self.violated().is_some() {
            return false;
        }
        rates(&self.program, &mut self.registers, state, |registers, right, x| {
            pivoting.solve(|row| registers.get(right[row]), x);
        });
        let is_finite = self.all_finite(state).is_ok();
        if is_finite {
            self.registers.set_all(self.program.inputs.coordinates[2], &state.qdd);
            solve_for_more(&self.determined, &self.program, &mut self.registers, &mut self.variations, pivoting);
            self.write_columns(state, row);
        }
        is_finite
    }

    /// Writes a result row of a state whose derivatives were found otherwise than by solving; its position must have been set.
    pub fn write_given_row(&mut self, state: &State, row: &mut [f64]) {
        self.set_derivatives(state);
        if self.has_more_to_solve() {
            match self.factor() {
                Ok(()) => self.vary(state),
                Err(_) => self.leave_variations_out(),
            }
        }
        self.write_columns(state, row);
    }

    /// Returns the quantity without a value if a cell of a result row is empty; it must be a cell of a measure, derivative or force.
    pub fn unknown_in(&self, column: usize) -> Unknown {
        match self.holds.get(column) {
            Some(&ColumnContent::Measure { index, .. }) => Unknown::Measure(index),
            Some(&ColumnContent::DerivativeColumn(k)) => {
                Unknown::Derivative(self.system().derivative_columns()[k].variable as usize)
            }
            _ => Unknown::Forces,
        }
    }

    /// Returns the length of a result row.
    pub fn row_length(&self) -> usize {
        self.holds.len()
    }
}

/// Solutions with `Φ_q` and with its transpose.
trait BothWays {
    /// `Φ_q x = b`, b by rows.
    fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]);
    /// `Φ_qᵀ λ = p`, p by coordinates.
    fn solve_for_multipliers(&mut self, needed: impl Fn(usize) -> f64, multipliers: &mut [f64]);
}

impl BothWays for BlockLu {
    fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) {
        BlockLu::solve(self, right, x);
    }

    fn solve_for_multipliers(&mut self, needed: impl Fn(usize) -> f64, multipliers: &mut [f64]) {
        BlockLu::solve_for_multipliers(self, needed, multipliers);
    }
}

impl BothWays for Pivoting {
    fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) {
        Pivoting::solve(self, right, x);
    }

    fn solve_for_multipliers(&mut self, needed: impl Fn(usize) -> f64, multipliers: &mut [f64]) {
        Pivoting::solve_for_multipliers(self, needed, multipliers);
    }
}

/// Solves for what a state needs besides its motion, whose derivatives are set: multipliers, variations, and variations of multipliers. The
/// results stay in their registers.
fn solve_for_more(
    determined: &Determined,
    program: &Program,
    registers: &mut Registers,
    varied: &mut Varied,
    factored: &mut impl BothWays,
) {
    let outputs = &program.outputs;
    program.run(Stage::Forces, registers);
    if !outputs.forces.is_empty() {
        factored.solve_for_multipliers(|column| registers.get(outputs.forces[column]), &mut varied.solution);
        registers.set_all(program.inputs.multipliers, &varied.solution);
    }
    vary(determined, program, registers, varied, |registers, right, x| {
        factored.solve(|row| registers.get(right[row]), x);
    });
    let variations = determined.system().variations();
    for by_two in [false, true] {
        let required = (0..).zip(&outputs.varied_forces).filter(|(_, right)| !right.is_empty());
        let mut of_kind = required.filter(|(k, _)| variations[*k as usize].by.1.is_some() == by_two).peekable();
        if of_kind.peek().is_none() {
            continue;
        }
        // variations by two variables follow from those by one
        program.run(Stage::Variation, registers);
        for (variation, right) in of_kind {
            factored.solve_for_multipliers(|column| registers.get(right[column]), &mut varied.solution);
            registers.set_all(program.inputs.varied_multipliers(variation), &varied.solution);
        }
    }
}

/// Solves for the variations of a state whose derivatives are set, by a closure that solves `Φ_q x = b` for a right side: those by one
/// variable, then those by two, each order from those before. The results stay in their registers.
fn vary(
    determined: &Determined,
    program: &Program,
    registers: &mut Registers,
    Varied { solution, .. }: &mut Varied,
    mut solve: impl FnMut(&Registers, &[Register], &mut [f64]),
) {
    let variations = determined.system().variations();
    for by_two in [false, true] {
        for order in 0..3 {
            let of_kind = || (0..variations.len()).filter(|&k| variations[k].by.1.is_some() == by_two);
            if of_kind().next().is_none() {
                break;
            }
            program.run(Stage::Variation, registers);
            for k in of_kind() {
                let right = &program.outputs.variations[k][order];
                solve(registers, right, solution);
                registers.set_all(program.inputs.varied(k as u32, order as u32), solution);
            }
        }
    }
}
