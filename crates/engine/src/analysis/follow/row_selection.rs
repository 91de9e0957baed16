//! Selection of the equations that are solved, where there are more than are needed.
//!
//! A row that is left out is a sum of the others, `Φ_q,out = Σ w Φ_q,kept`. Where the rows that are kept come near to depending on each other, and
//! all rows together do not, a weight grows: the row that it belongs to is left out instead, which makes the volume that the kept rows span larger by
//! that factor (S. A. Goreinov et al., *How to find a good submatrix*, 2010). In a singular position of all rows no weight grows.

use super::checkpoint::Checkpoint;
use super::rows::RowBatch;
use crate::analysis::state::{Kinematics, State};
use crate::limits::redundancy::{HEAVY, MOST_EXCHANGES};
use crate::solver::Solver;
use mechc_expr::ExprId;
use mechc_ir::program::{Program, Register, Registers, Stage};
use mechc_ir::structure::Determined;
use std::sync::Arc;

/// Largest weight of a row in a left-out one at the end of a step, both scaled: it bounds the loss of digits.
const LARGEST_WEIGHT: f64 = 10.0;

/// Equations that are solved, with their solver.
pub struct SelectedRows {
    determined: Arc<Determined>,
    program: Arc<Program>,
    pub solver: Option<Arc<Solver>>,
}

impl SelectedRows {
    /// Returns the kinematics of these equations, in all else like another one.
    pub fn kinematics(&self, like: &Kinematics) -> Kinematics {
        like.with_equations(Arc::clone(&self.determined), Arc::clone(&self.program))
    }

    /// Returns the row that these equations have in place of one of others; `None` if it is left out.
    pub fn row_in_place_of(&self, row: usize, other: &Determined) -> Option<usize> {
        let row = *other.kept().get(row)?;
        self.determined.kept().binary_search(&row).ok()
    }
}

/// Selects the equations that are solved, and monitors that they stay independent.
pub struct RowSelection {
    program: Program,
    registers: Registers,
    /// By row of the whole, its slopes.
    slopes: Vec<Vec<(usize, Register)>>,
    /// The rows of the whole that are solved, in order.
    kept: Vec<usize>,
    /// The slopes of a row that is left out, by coordinate, and its weights, by row that is solved.
    slope: Vec<f64>,
    weights: Vec<f64>,
    /// All selections so far.
    cached: Vec<Arc<SelectedRows>>,
    current: Option<Arc<SelectedRows>>,
}

impl RowSelection {
    /// Returns the selection of a system that leaves out some equations; `None` where all are needed.
    pub fn new(kinematics: &Kinematics) -> Option<RowSelection> {
        let determined = kinematics.determined();
        let whole = determined.whole();
        if determined.left_out().is_empty() || whole.has_signals() {
            return None;
        }
        let n = whole.coordinates().len();
        let entries: Vec<ExprId> = whole.phi_q().entries().iter().map(|&(_, slope)| slope).collect();
        let (program, registers) = Program::of_formulas(whole.graph(), [whole.params().len(), n, 0, 0], &entries);
        let slopes = (0..whole.rows().len())
            .map(|row| {
                let columns = whole.phi_q().row(row).iter().map(|&(column, _)| column as usize);
                columns.zip(whole.phi_q().range(row).map(|position| registers[position])).collect()
            })
            .collect();
        let registers = program.start(&whole.param_values());
        let kept = determined.kept();
        let (slope, weights) = (vec![0.0; n], vec![0.0; n]);
        Some(RowSelection { program, registers, slopes, kept, slope, weights, cached: Vec::new(), current: None })
    }

    /// Returns the selection, if it differs from the equations at the start.
    pub fn current(&self) -> Option<&Arc<SelectedRows>> {
        self.current.as_ref()
    }

    /// Returns whether the selection is good at a state, where its equations were factored.
    pub fn is_good(&mut self, kinematics: &mut Kinematics, state: &State) -> bool {
        self.heaviest(kinematics, state).is_none_or(|(_, _, weight)| weight <= LARGEST_WEIGHT)
    }

    /// Returns the exchange with the largest weight: a row that is left out and a row that is solved, both by their index among all rows,
    /// and the scaled weight of the latter in the former; `None` if no row is left out.
    fn heaviest(&mut self, kinematics: &mut Kinematics, state: &State) -> Option<(usize, usize, f64)> {
        let determined = kinematics.determined();
        let inputs = self.program.inputs;
        self.registers.set(inputs.time, state.t);
        self.registers.set_all(inputs.coordinates[0], &state.q);
        self.program.run(Stage::Measures, &mut self.registers);
        let mut heaviest: Option<(usize, usize, f64)> = None;
        for &row in determined.left_out() {
            self.slope.fill(0.0);
            let mut norm = 0.0;
            for &(column, register) in &self.slopes[row] {
                let slope = self.registers.get(register);
                self.slope[column] = slope;
                let scaled = slope * kinematics.linear().column_scale(column);
                norm += scaled * scaled;
            }
            let norm = norm.sqrt();
            kinematics.solve_for_multipliers(&self.slope, &mut self.weights);
            for (index, (&kept, weight)) in self.kept.iter().zip(&self.weights).enumerate() {
                let weight = weight.abs() * kinematics.linear().row_norm(index) / norm;
                if weight > heaviest.map_or(0.0, |(_, _, largest)| largest) {
                    heaviest = Some((row, kept, weight));
                }
            }
        }
        heaviest
    }

    /// Selects the equations anew for a state; returns whether they changed. Allocates.
    pub fn choose(&mut self, kinematics: &mut Kinematics, state: &State) -> bool {
        let mut is_changed = false;
        for _ in 0..MOST_EXCHANGES {
            kinematics.restore(state);
            let heaviest = self.heaviest(kinematics, state).filter(|(_, _, weight)| *weight > HEAVY);
            let Some((out, kept, _)) = heaviest else {
                break;
            };
            let determined = kinematics.determined();
            let mut left_out: Vec<usize> = determined.left_out().iter().copied().filter(|&row| row != out).collect();
            left_out.push(kept);
            left_out.sort_unstable();
            let Some(chosen) = self.chosen(kinematics, &left_out, state) else {
                break;
            };
            *kinematics = chosen.kinematics(kinematics);
            kinematics.restore(state);
            kinematics.measure_slopes(&state.q);
            kinematics.restore(state);
            kinematics.choose_orders();
            self.kept = kinematics.determined().kept();
            self.current = Some(chosen);
            is_changed = true;
        }
        kinematics.restore(state);
        is_changed
    }

    /// Returns the selection that leaves out some rows of the whole, from the cache or built for a state.
    fn chosen(&mut self, kinematics: &Kinematics, left_out: &[usize], state: &State) -> Option<Arc<SelectedRows>> {
        let cached = self.cached.iter().find(|cached| cached.determined.left_out() == left_out);
        if let Some(cached) = cached {
            return Some(Arc::clone(cached));
        }
        let determined = Arc::new(kinematics.determined().with_rows_dropped(left_out)?);
        let program = Arc::new(Program::new(determined.system()));
        let mut other = kinematics.with_equations(Arc::clone(&determined), Arc::clone(&program));
        other.restore(state);
        other.choose_orders();
        let solver = other.solver().map(Arc::new);
        let chosen = Arc::new(SelectedRows { determined, program, solver });
        self.cached.push(Arc::clone(&chosen));
        Some(chosen)
    }

    /// Returns the batch that solves for rows with the selected equations, measured against a span (s); `None` without a solver.
    pub fn batch(&self, kinematics: &Kinematics, origin: Checkpoint, span: f64) -> Option<RowBatch> {
        let solver = self.current.as_ref()?.solver.clone()?;
        Some(RowBatch::new(kinematics, solver, origin, span))
    }
}
