//! A mechanism that is assembled at its first time: what can be followed from there on.

use super::assembly::{self, Moved};
use super::branches::{self, Doubt};
use super::errors::{far_estimates, misfit};
use crate::analysis::state::{Horizon, Kinematics, State};
use crate::cancel::Cancel;
use crate::diag::{Diagnostic, Diagnostics};
use crate::ir::ConstraintSystem;
use crate::math::Vectors;
use crate::program::Program;
use crate::solver::Solver;
use crate::structure::Determined;
use crate::tolerances::TOLERANCE;
use std::sync::Arc;

/// A mechanism that is assembled at its first time, in a position of full rank.
#[derive(Clone)]
pub struct Started {
    kinematics: Kinematics,
    state: State,
    moved: Moved,
    /// Why this may not be the position that the estimates mean.
    doubt: Option<Doubt>,
    /// What solves for the rows; none where it would be too large, or nobody asks for them.
    solver: Option<Arc<Solver>>,
}

/// Assembles a mechanism at the first time of a horizon.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn start(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    tolerance: f64,
    cancel: &Cancel,
) -> Result<Started, Box<Diagnostic>> {
    start_from(determined, program, horizon, None, tolerance, cancel)
}

/// As [`start`], from other estimates [m, rad] than those of the file, if there are any.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn start_from(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    estimates: Option<&[f64]>,
    tolerance: f64,
    cancel: &Cancel,
) -> Result<Started, Box<Diagnostic>> {
    started((determined, program), horizon, estimates, (tolerance, cancel), Kinematics::solver)
}

/// As [`start_from`], without what solves for rows, which takes longer than all else: for who only asks for the position.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn assemble_from(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    estimates: Option<&[f64]>,
    tolerance: f64,
    cancel: &Cancel,
) -> Result<Started, Box<Diagnostic>> {
    started((determined, program), horizon, estimates, (tolerance, cancel), |_| None)
}

/// As [`start_from`], of a mechanism of which other values were assembled before, whose solver solves for these rows too; from where it has been
/// led, so that nobody doubts that this is the position which is meant.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn start_led(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    (from, solver): (&[f64], Option<Arc<Solver>>),
    tolerance: f64,
    cancel: &Cancel,
) -> Result<Started, Box<Diagnostic>> {
    let mut kinematics = kinematics((determined, program), horizon, Some(from), (tolerance, cancel));
    let (state, moved) = assembly::assemble(&mut kinematics, horizon.from)?;
    kinematics.choose_orders();
    Ok(Started { kinematics, state, moved, doubt: None, solver })
}

/// Where the bodies of a mechanism that cannot be assembled at the first time of a horizon come nearest to that, from the file's estimates or
/// from others: all is closed but what is told to be open. None where that is not known, or hopeless [m, rad].
#[must_use]
pub fn nearest(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    estimates: Option<&[f64]>,
    cancel: &Cancel,
) -> Option<Vec<f64>> {
    let mut kinematics = kinematics((determined, program), horizon, estimates, (TOLERANCE, cancel));
    assembly::nearest(&mut kinematics, horizon.from)
}

/// A mechanism before it is assembled, which begins at estimates.
fn kinematics(
    (determined, program): (Arc<Determined>, Arc<Program>),
    horizon: Horizon,
    estimates: Option<&[f64]>,
    (tolerance, cancel): (f64, &Cancel),
) -> Kinematics {
    let mut kinematics = Kinematics::new(determined, program, horizon.span, tolerance, cancel.clone());
    if let Some(estimates) = estimates {
        kinematics.begin_from(estimates);
    }
    kinematics
}

fn started(
    (determined, program): (Arc<Determined>, Arc<Program>),
    horizon: Horizon,
    estimates: Option<&[f64]>,
    (tolerance, cancel): (f64, &Cancel),
    solver: impl FnOnce(&Kinematics) -> Option<Solver>,
) -> Result<Started, Box<Diagnostic>> {
    let mut kinematics = kinematics((determined, program), horizon, estimates, (tolerance, cancel));
    let (state, moved) = assembly::assemble(&mut kinematics, horizon.from)?;
    // by the position at the start, which is what was factored last
    kinematics.choose_orders();
    let solver = solver(&kinematics).map(Arc::new);
    let estimates = kinematics.estimates();
    let doubt = if moved.perturbed { None } else { branches::doubt(&mut kinematics, &estimates, &state) };
    Ok(Started { kinematics, state, moved, doubt, solver })
}

impl Started {
    /// What is to be said of the assembly: whether it moved bodies far, and whether gears fit.
    #[must_use]
    pub fn remarks(&self) -> Diagnostics {
        let (system, state) = (self.kinematics.system(), &self.state);
        let mut diagnostics = self.far_estimates_at(state.t);
        diagnostics.extend(system.fits().iter().filter_map(|fit| misfit(system, fit, &state.q, state.t)));
        diagnostics
    }

    /// Whether the assembly moved bodies far, said of a time (s).
    #[must_use]
    pub fn far_estimates_at(&self, t: f64) -> Diagnostics {
        let (system, from) = (self.kinematics.system(), self.kinematics.estimates());
        let ends = [from.as_slice(), &self.state.q];
        let mut diagnostics = Diagnostics::default();
        diagnostics.extend(far_estimates(system, self.moved.perturbed, self.doubt, ends, t));
        diagnostics
    }

    /// The equations.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        self.kinematics.system()
    }

    /// From now on rows are solved for with these vector instructions, which changes no bit.
    pub fn use_vectors(&mut self, vectors: Vectors) {
        self.kinematics.use_vectors(vectors);
    }

    /// How far assembly moved the bodies from their estimates.
    #[must_use]
    pub fn moved(&self) -> &Moved {
        &self.moved
    }

    /// The assembled coordinates [m, rad].
    #[must_use]
    pub fn q(&self) -> &[f64] {
        &self.state.q
    }

    /// The velocities at the start [m/s, rad/s]; none where they have no values.
    #[must_use]
    pub fn velocities(&mut self) -> Option<Vec<f64>> {
        let mut state = self.state.clone();
        self.kinematics.restore(&state);
        self.kinematics.derivatives(&mut state).ok()?;
        Some(state.qd)
    }

    /// The smallest singular value of any block of the scaled `Φ_q` at the start: 1 is best, 0 a singular position.
    #[must_use]
    pub fn conditioning(&mut self) -> f64 {
        self.kinematics.restore(&self.state);
        self.kinematics.worst().sigma
    }

    /// What solves for rows; none where it would be too large, or is left out.
    #[must_use]
    pub fn solver(&self) -> Option<&Solver> {
        self.solver.as_deref()
    }

    /// The same, for others to hold.
    #[must_use]
    pub fn shared_solver(&self) -> Option<Arc<Solver>> {
        self.solver.clone()
    }

    /// The same operations, to be written as code; by a program that may leave inputs open, and has the same registers.
    #[must_use]
    pub fn solver_for_code_of(&mut self, program: &Program) -> Option<Solver> {
        self.kinematics.restore(&self.state);
        self.kinematics.solver_for_code_of(program)
    }

    /// What solves for some columns of several variants at once; none where it would be too large.
    #[must_use]
    pub fn solver_of_variants(&mut self, is_wanted: &dyn Fn(u32) -> bool) -> Option<Solver> {
        self.kinematics.restore(&self.state);
        self.kinematics.solver_of_variants(is_wanted)
    }

    /// Whether the equations are smooth wherever the motion is, and nothing is looked at beside them.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.kinematics.is_plain()
    }

    /// By row of `Φ`: what may be left of it at the start.
    #[must_use]
    pub fn bounds(&mut self) -> Vec<f64> {
        self.kinematics.restore(&self.state);
        let mut inverses = vec![0.0; self.state.q.len()];
        self.kinematics.write_bounds(&mut inverses);
        inverses.iter().map(|inverse| 1.0 / inverse).collect()
    }

    /// What a motion from the start on needs: what evaluates it, the state there, and what solves for its rows.
    #[must_use]
    pub fn into_parts(self) -> (Kinematics, State, Option<Arc<Solver>>) {
        (self.kinematics, self.state, self.solver)
    }

    /// The same, to be followed by another one too.
    #[must_use]
    pub fn parts(&self) -> (Kinematics, State, Option<Arc<Solver>>) {
        (self.kinematics.clone(), self.state.clone(), self.solver.clone())
    }
}
