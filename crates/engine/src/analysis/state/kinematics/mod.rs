//! Computations at one state: residual, correction, velocity, acceleration.

mod derivatives;
mod fault;
mod residuals;
mod row;
mod slopes;
mod switches;

use super::equilibration::needs_nearby_slope;
use super::linear::{BlockLu, Factored, Singular};
use crate::solver::{Equations, Solver, Values};
use derivatives::Spread;
pub use fault::Fault;
use mechc_expr::math::Vectors;
use mechc_ir::layout::{self, ColumnContent};
use mechc_ir::program::{Program, Register, Registers, Stage};
use mechc_ir::structure::Determined;
use mechc_ir::{ConstraintSystem, DeclarationKind};
use mechc_text::cancel::Cancel;
pub use row::Unknown;
use row::Varied;
use std::sync::Arc;

/// A time with the coordinates and their derivatives.
#[derive(Clone, PartialEq, Debug)]
pub struct State {
    /// (s)
    pub t: f64,
    /// [m, rad]
    pub q: Vec<f64>,
    /// [m/s, rad/s]
    pub qd: Vec<f64>,
    /// [m/s², rad/s²]
    pub qdd: Vec<f64>,
    /// [m/s³, rad/s³]; zero where no measure needs it.
    pub qddd: Vec<f64>,
}

impl State {
    pub fn new(t: f64, q: Vec<f64>) -> State {
        let zero = vec![0.0; q.len()];
        State { t, q, qd: zero.clone(), qdd: zero.clone(), qddd: zero }
    }

    /// Returns a coordinate with its time derivatives, by their orders.
    pub fn tower(&self, k: usize) -> [f64; 4] {
        [self.q[k], self.qd[k], self.qdd[k], self.qddd[k]]
    }

    /// Takes over another state without allocating.
    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        self.q.copy_from_slice(&other.q);
        self.qd.copy_from_slice(&other.qd);
        self.qdd.copy_from_slice(&other.qdd);
        self.qddd.copy_from_slice(&other.qddd);
    }
}

/// A mechanism's program with its registers and factors.
#[derive(Clone)]
pub struct Kinematics {
    determined: Arc<Determined>,
    program: Arc<Program>,
    registers: Registers,
    linear: BlockLu,
    span: f64,
    tolerance: f64,
    cancel: Cancel,
    /// Rows whose slope may vanish though nothing about the mechanism does, as that of `sin(angle(b))`.
    bent: Vec<usize>,
    /// Rows whose slopes are also evaluated near a position; includes those of `bent`.
    with_nearby_slopes: Vec<usize>,
    nearby: Vec<f64>,
    /// By row: its largest term near the position; 0 if it is not evaluated there.
    nearby_terms: Vec<f64>,
    doubt: Spread,
    /// Start of assembly, if it differs from the file's estimates.
    other_estimates: Option<Vec<f64>>,
    variations: Varied,
    /// Contents of the columns of a row.
    holds: Vec<ColumnContent>,
    /// Vector instructions of the solver.
    vectors: Vectors,
}

impl Kinematics {
    /// Creates an evaluator of a mechanism for an analysis of the given span (s).
    pub fn new(
        determined: Arc<Determined>,
        program: Arc<Program>,
        span: f64,
        tolerance: f64,
        cancel: Cancel,
    ) -> Kinematics {
        let system = determined.system();
        let params = system.param_values();
        let (registers, linear) = (program.start(&params), BlockLu::new(system, determined.blocks()));
        let bent = (0..system.rows().len()).filter(|&row| is_bent(system, row)).collect();
        let with_nearby_slopes = (0..system.rows().len()).filter(|&row| needs_nearby_slope(system, row)).collect();
        let n = system.coordinates().len();
        let other_estimates = None;
        let holds = layout::holds(system);
        let (nearby, nearby_terms) = (vec![0.0; n], vec![0.0; n]);
        let (doubt, variations) = (Spread::new(n), Varied::new(system, &holds));
        Kinematics {
            determined,
            program,
            registers,
            linear,
            span,
            tolerance,
            cancel,
            bent,
            with_nearby_slopes,
            nearby,
            nearby_terms,
            doubt,
            other_estimates,
            variations,
            holds,
            vectors: Vectors::default(),
        }
    }

    /// Returns the same state with other equations left out. Allocates.
    #[must_use]
    pub fn with_equations(&self, determined: Arc<Determined>, program: Arc<Program>) -> Kinematics {
        let other = Kinematics::new(determined, program, self.span, self.tolerance, self.cancel.clone());
        Kinematics { vectors: self.vectors, other_estimates: self.other_estimates.clone(), ..other }
    }

    /// Returns the vector instructions of the solver; the widest available ones by default.
    pub fn vectors(&self) -> Vectors {
        self.vectors
    }

    /// Selects the vector instructions that solve for rows; results are equal bit for bit.
    pub fn use_vectors(&mut self, vectors: Vectors) {
        self.vectors = vectors;
    }

    pub fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// Returns the time span of the analysis (s).
    pub fn span(&self) -> f64 {
        self.span
    }

    /// Returns whether the analysis was cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Returns the mechanism, shared, so that it can be used while the state changes.
    pub fn determined(&self) -> Arc<Determined> {
        Arc::clone(&self.determined)
    }

    pub fn linear(&self) -> &BlockLu {
        &self.linear
    }

    /// Returns the estimates from which assembly starts [m, rad]: those of the file unless others were given.
    pub fn estimates(&self) -> Vec<f64> {
        let of_file = || self.program.outputs.estimates.iter().map(|&register| self.registers.get(register)).collect();
        self.other_estimates.clone().unwrap_or_else(of_file)
    }

    /// Takes other estimates than those of the file.
    pub fn begin_from(&mut self, estimates: &[f64]) {
        self.other_estimates = Some(estimates.to_vec());
    }

    pub fn set_time(&mut self, t: f64) {
        self.registers.set(self.program.inputs.time, t);
        self.program.run(Stage::Time, &mut self.registers);
    }

    /// Evaluates Φ and Φ_q at a position.
    pub fn set_position(&mut self, q: &[f64]) -> Result<(), Fault> {
        self.registers.set_all(self.program.inputs.coordinates[0], q);
        self.program.run(Stage::Position, &mut self.registers);
        if let Some(index) = self.broken_condition() {
            return Err(Fault::Condition { index });
        }
        match (0..q.len()).find(|&row| !self.phi(row).is_finite()) {
            Some(row) => Err(Fault::NotFinite { row }),
            None => Ok(()),
        }
    }

    /// Returns an entry of Φ at the current position.
    pub fn phi(&self, row: usize) -> f64 {
        self.registers.get(self.program.outputs.phi[row])
    }

    /// Returns an entry of Φ_q, by its position in the pattern.
    pub fn phi_q(&self, position: usize) -> f64 {
        self.registers.get(self.program.outputs.phi_q[position])
    }

    /// Returns the value of a register.
    pub fn value(&self, register: Register) -> f64 {
        self.registers.get(register)
    }

    /// Returns a solver for rows, with elimination orders that suit the position that was factored; `None` where it would be too large.
    pub fn solver(&self) -> Option<Solver> {
        Solver::new(&self.determined, &self.program, self)
    }

    /// Returns a solver as [`Kinematics::solver`] does, for emission as code, by a program for this system with the same registers.
    pub fn solver_for_code_of(&self, program: &Program) -> Option<Solver> {
        Solver::for_code(&self.determined, program, self)
    }

    /// Returns a solver as [`Kinematics::solver`] does, for some columns of several variants at once.
    pub fn solver_of_variants(&self, is_requested: &dyn Fn(u32) -> bool) -> Option<Solver> {
        Solver::for_variants(&self.determined, &self.program, self, is_requested)
    }

    /// Returns whether the smoothness of the equations does not depend on where the motion is: no formula of them has branches or ends, and none
    /// may lose its slope.
    pub fn is_smooth(&self) -> bool {
        let system = self.system();
        let has_branches = !self.program.switches().is_empty() || !self.program.tables().is_empty();
        let is_watched = !system.checks().is_empty() || !system.domain_boundaries().is_empty();
        let depends_on_motion = |positive| system.graph().dependence(positive).highest_order().is_some();
        let on_the_way = system.conditions().iter().any(|condition| depends_on_motion(condition.positive));
        let is_varied = system.has_signals() || system.all_variations().is_some() || !system.open_contacts().is_empty();
        !(has_branches || is_watched || on_the_way || is_varied || !self.bent.is_empty())
    }

    /// Returns whether the equations are smooth, and what time alone decides goes straight on, so that steps show all of the motion.
    pub fn is_plain(&self) -> bool {
        self.is_smooth() && self.signals().is_empty()
    }

    /// Returns the program with its registers, whose switches stand as they are in this step.
    pub fn program(&self) -> (&Program, &Registers) {
        (&self.program, &self.registers)
    }

    /// Chooses the orders of elimination by the position that was factored. Allocates.
    pub fn choose_orders(&mut self) {
        self.linear.choose_orders();
    }

    /// Factors Φ_q at the current position.
    pub fn factor(&mut self) -> Result<(), Fault> {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        let coordinates = self.program.inputs.coordinates[0];
        self.linear.equilibration().turn(|column| registers.get(coordinates + column as u32));
        match self.linear.factor(|position| registers.get(outputs.phi_q[position])) {
            Factored::Regular => Ok(()),
            Factored::Singular => match self.not_finite_slope() {
                Some(row) => Err(Fault::NotFinite { row }),
                None => Err(Fault::Singular),
            },
        }
    }

    fn not_finite_slope(&self) -> Option<usize> {
        let pattern = self.system().phi_q();
        (0..self.system().rows().len())
            .find(|&row| pattern.range(row).any(|position| !self.phi_q(position).is_finite()))
    }

    /// Computes Newton's correction of the position; returns its largest scaled entry.
    pub fn correction(&mut self, delta: &mut [f64]) -> f64 {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        self.linear.solve(|row| -registers.get(outputs.phi[row]), delta)
    }

    /// Solves `Φ_q x = right` with the present factors.
    pub fn solve(&mut self, right: &[f64], x: &mut [f64]) {
        self.linear.solve(|row| right[row], x);
    }

    /// Solves `Φ_qᵀ λ = needed` with the present factors.
    pub fn solve_for_multipliers(&mut self, needed: &[f64], multipliers: &mut [f64]) {
        self.linear.solve_for_multipliers(|column| needed[column], multipliers);
    }

    /// Computes Newton's correction of the coordinates that follow without iteration from the others; returns its largest scaled entry.
    pub fn explicit_correction(&mut self, delta: &mut [f64]) -> f64 {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        self.linear.solve_explicit(|row| -registers.get(outputs.phi[row]), delta)
    }

    /// Evaluates and factors at a state again.
    pub fn restore(&mut self, state: &State) {
        self.set_time(state.t);
        // the state was computed once, so that neither can fail now
        let _ = self.set_position(&state.q);
        let _ = self.factor();
    }

    /// Returns the nearness to a singular position, as far as it is below `limit`.
    pub fn nearness(&mut self, limit: f64) -> f64 {
        self.linear.nearness(limit)
    }

    /// Returns the most nearly singular block where Φ_q was factored.
    pub fn worst(&mut self) -> Singular {
        self.linear.worst()
    }
}

impl Equations for Kinematics {
    fn set_position(&mut self, q: &[f64]) -> bool {
        Kinematics::set_position(self, q).is_ok()
    }

    fn phi(&self, row: usize) -> f64 {
        Kinematics::phi(self, row)
    }

    fn slope(&self, position: usize) -> f64 {
        self.phi_q(position)
    }
}

impl Values for Kinematics {
    fn entry(&self, position: usize) -> f64 {
        let pattern = self.system().phi_q();
        let column = pattern.entries()[position].0 as usize;
        self.phi_q(position) * self.linear.column_scale(column) / self.linear.row_norm(pattern.row_of(position))
    }

    fn row_norm(&self, row: usize) -> f64 {
        self.linear.row_norm(row)
    }
}

/// Returns whether a row may lose its slope by its formula alone: it is written by hand, of no distance, and no slope is constant.
fn is_bent(system: &ConstraintSystem, row: usize) -> bool {
    let declaration = system.declaration_of(row);
    let by_hand = !matches!(declaration.kind, DeclarationKind::Joint(_)) && declaration.points.is_empty();
    by_hand && !system.phi_q().row(row).iter().any(|&(_, slope)| system.graph().dependence(slope).is_constant())
}
