//! A mechanism that is assembled at its first time, from which its motion can be followed.

use super::assembly::{self, Assembled, Moved};
use super::branches::{self, Doubt};
use super::errors::far_estimates;
use crate::analysis::explain::Stop;
use crate::analysis::explain::errors::misfit;
use crate::analysis::state::{Horizon, Kinematics, SignalBounds, State};
use crate::solver::Solver;
use mechc_expr::math::Vectors;
use mechc_ir::ConstraintSystem;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use std::sync::Arc;

/// A mechanism that is assembled at its first time, in a position of full rank.
#[derive(Clone)]
pub struct Started {
    kinematics: Kinematics,
    state: State,
    moved: Moved,
    /// Doubt that this is the position that the estimates mean.
    doubt: Option<Doubt>,
    /// Solver for rows; `None` if it would be too large, or no rows are requested.
    solver: Option<Arc<Solver>>,
}

/// Choice of the solver for the rows of an assembled mechanism.
#[derive(Clone)]
pub enum Solving {
    /// A solver that is made for the position found.
    New,
    /// A given solver of the same equations; `None` if only positions are requested.
    With(Option<Arc<Solver>>),
}

/// A mechanism that is to be assembled.
#[derive(Clone)]
pub struct Unassembled {
    /// Its equations.
    pub determined: Arc<Determined>,
    /// Operations that evaluate them.
    pub program: Arc<Program>,
    /// Time of assembly, and the span of the analysis.
    pub horizon: Horizon,
    /// Bounds each row of Φ, scaled.
    pub tolerance: f64,
    /// True if bifurcations are passed between where it is drawn and where it begins.
    pub pass_bifurcations: bool,
    /// Ends it.
    pub cancel: Cancel,
}

impl Unassembled {
    /// Closes the equations from the estimates of the file, or from others [m, rad], with the drivers where they are at that time.
    ///
    /// # Errors
    /// It cannot be assembled, starts in a singular position, or a formula has no value there.
    pub fn close(&self, estimates: Option<&[f64]>, solving: Solving) -> Result<Started, Box<Stop>> {
        self.close_with(self.kinematics(estimates), solving)
    }

    /// Closes the equations from the estimates of what evaluates them.
    ///
    /// # Errors
    /// As [`Unassembled::close`].
    pub fn close_with(&self, mut kinematics: Kinematics, solving: Solving) -> Result<Started, Box<Stop>> {
        let Assembled { state, moved, is_perturbed } = assembly::assemble(&mut kinematics, self.horizon.from, None)?;
        let mut started = Started::new(kinematics, state, moved, solving);
        started.doubt = if is_perturbed {
            Some(Doubt::Perturbed)
        } else {
            let (kinematics, state) = (&mut started.kinematics, &started.state);
            let estimates = kinematics.estimates();
            branches::doubt(kinematics, &estimates, state).map(Doubt::Far)
        };
        Ok(started)
    }

    /// Assembles at a position [m, rad] to which the mechanism was followed, which is the intended one.
    ///
    /// # Errors
    /// As [`Unassembled::close`].
    pub fn assemble_at(&self, q: &[f64], solving: Solving) -> Result<Started, Box<Stop>> {
        self.assemble_at_with(self.kinematics(Some(q)), q, solving)
    }

    /// Assembles at a position [m, rad] with a given evaluator, whose estimates may differ.
    ///
    /// # Errors
    /// As [`Unassembled::close`].
    pub fn assemble_at_with(
        &self,
        mut kinematics: Kinematics,
        q: &[f64],
        solving: Solving,
    ) -> Result<Started, Box<Stop>> {
        let Assembled { state, moved, .. } = assembly::assemble(&mut kinematics, self.horizon.from, Some(q))?;
        Ok(Started::new(kinematics, state, moved, solving))
    }

    /// Returns an evaluator of the equations before assembly, with the estimates of the file or with others [m, rad].
    #[must_use]
    pub fn kinematics(&self, estimates: Option<&[f64]>) -> Kinematics {
        let (determined, program) = (Arc::clone(&self.determined), Arc::clone(&self.program));
        let mut kinematics =
            Kinematics::new(determined, program, self.horizon.span, self.tolerance, self.cancel.clone());
        if let Some(estimates) = estimates {
            kinematics.begin_from(estimates);
        }
        kinematics
    }

    /// Returns the position [m, rad] in which the bodies come nearest to being assembled, from the file's estimates or from others, if
    /// assembly fails: all is closed but the open loop that is reported. `None` if no such position is found, or the gap is hopeless.
    #[must_use]
    pub fn nearest(&self, estimates: Option<&[f64]>) -> Option<Vec<f64>> {
        assembly::nearest(&mut self.kinematics(estimates), self.horizon.from)
    }
}

impl Started {
    fn new(mut kinematics: Kinematics, state: State, moved: Moved, solving: Solving) -> Started {
        // by the position at the start, which is what was factored last
        kinematics.choose_orders();
        let solver = match solving {
            Solving::New => kinematics.solver().map(Arc::new),
            Solving::With(solver) => solver,
        };
        Started { kinematics, state, moved, doubt: None, solver }
    }

    /// Returns diagnostics of the assembly: bodies that moved far, and gears that do not fit.
    #[must_use]
    pub fn remarks(&self) -> Diagnostics {
        let (system, state) = (self.kinematics.system(), &self.state);
        let mut diagnostics = self.far_estimates_at(state.t);
        diagnostics.extend(system.fits().iter().filter_map(|fit| misfit(system, fit, &state.q, state.t)));
        diagnostics
    }

    /// Returns diagnostics of bodies that the assembly moved far, at a time (s).
    #[must_use]
    pub fn far_estimates_at(&self, t: f64) -> Diagnostics {
        let (system, from) = (self.kinematics.system(), self.kinematics.estimates());
        let ends = [from.as_slice(), &self.state.q];
        let mut diagnostics = Diagnostics::default();
        diagnostics.extend(self.doubt.map(|doubt| far_estimates(system, doubt, ends, t)));
        diagnostics
    }

    /// Returns it with the reason why this may not be the position that the estimates mean.
    #[must_use]
    pub fn with_doubt(self, doubt: Option<Doubt>) -> Started {
        Started { doubt, ..self }
    }

    /// Returns the doubt that this is the position that the estimates mean, if there is one.
    #[must_use]
    pub fn doubt(&self) -> Option<Doubt> {
        self.doubt
    }

    /// Returns the equations.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        self.kinematics.system()
    }

    /// Selects the vector instructions that solve for rows; results are equal bit for bit.
    pub fn use_vectors(&mut self, vectors: Vectors) {
        self.kinematics.use_vectors(vectors);
    }

    /// Tells from now on how far the start is from these estimates [m, rad], rather than from those that it was assembled from.
    #[must_use]
    pub fn moved_from(self, estimates: &[f64]) -> Started {
        let moved = assembly::moved(self.kinematics.system(), estimates, &self.state.q);
        Started { moved, ..self }
    }

    /// Returns the displacement of the bodies from their estimates in assembly.
    #[must_use]
    pub fn moved(&self) -> &Moved {
        &self.moved
    }

    /// Returns the largest scaled displacement from the estimates of the coordinates that iteration solves for, and of those that follow.
    #[must_use]
    pub fn moved_in_loops(&self) -> f64 {
        let estimates = self.kinematics.estimates();
        branches::moved_in_loops(&self.kinematics.determined(), &estimates, &self.state.q)
    }

    /// Returns the assembled coordinates [m, rad].
    #[must_use]
    pub fn q(&self) -> &[f64] {
        &self.state.q
    }

    /// Returns the velocities at the start [m/s, rad/s]; `None` if they have no values.
    #[must_use]
    pub fn velocities(&mut self) -> Option<Vec<f64>> {
        let mut state = self.state.clone();
        self.kinematics.restore(&state);
        self.kinematics.derivatives(&mut state).ok()?;
        Some(state.qd)
    }

    /// Returns the smallest singular value of any block of the scaled `Φ_q` at the start: 1 is best, 0 a singular position.
    #[must_use]
    pub fn conditioning(&mut self) -> f64 {
        self.kinematics.restore(&self.state);
        self.kinematics.worst().sigma
    }

    /// Returns the row of a state that the motion from here has passed, which is not solved for anew.
    #[must_use]
    pub fn row_of(&mut self, state: &State) -> Vec<f64> {
        let mut row = vec![0.0; self.kinematics.row_length()];
        self.kinematics.restore(state);
        self.kinematics.write_given_row(state, &mut row);
        row
    }

    /// Returns the solver for rows; `None` if it would be too large, or is omitted.
    #[must_use]
    pub fn solver(&self) -> Option<&Solver> {
        self.solver.as_deref()
    }

    /// Returns the solver as a shared pointer.
    #[must_use]
    pub fn shared_solver(&self) -> Option<Arc<Solver>> {
        self.solver.clone()
    }

    /// Returns the solver's operations for emission as code, by a program that may leave inputs open, and has the same registers.
    #[must_use]
    pub fn solver_for_code_of(&mut self, program: &Program) -> Option<Solver> {
        self.kinematics.restore(&self.state);
        self.kinematics.solver_for_code_of(program)
    }

    /// Returns a solver for some columns of several variants at once; `None` if it would be too large.
    #[must_use]
    pub fn solver_of_variants(&mut self, is_requested: &dyn Fn(u32) -> bool) -> Option<Solver> {
        self.kinematics.restore(&self.state);
        self.kinematics.solver_of_variants(is_requested)
    }

    /// Returns whether the equations are smooth wherever the motion is.
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        self.kinematics.is_smooth()
    }

    /// Returns whether the equations are smooth, and what time alone decides goes straight on.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.kinematics.is_plain()
    }

    /// Returns the terms of the equations that time alone decides and that are not linear in it, with the conditions that time alone decides.
    pub fn signal_bounds(&mut self) -> SignalBounds {
        SignalBounds::with_conditions(&mut self.kinematics, &self.state)
    }

    /// By row of `Φ`: its largest residual at the start.
    #[must_use]
    pub fn bounds(&mut self) -> Vec<f64> {
        self.kinematics.restore(&self.state);
        let mut inverses = vec![0.0; self.state.q.len()];
        self.kinematics.write_bounds(&mut inverses);
        inverses.iter().map(|inverse| 1.0 / inverse).collect()
    }

    /// Returns the evaluator, the state at the start, and the solver, which a motion needs.
    #[must_use]
    pub fn into_parts(self) -> (Kinematics, State, Option<Arc<Solver>>) {
        (self.kinematics, self.state, self.solver)
    }

    /// Returns clones of the evaluator, the state at the start, and the solver.
    #[must_use]
    pub fn parts(&self) -> (Kinematics, State, Option<Arc<Solver>>) {
        (self.kinematics.clone(), self.state.clone(), self.solver.clone())
    }
}
