//! A step from a state to a trial state.
//!
//! Each step predicts `q + h q̇ + h²/2 q̈`, corrects by Newton, and is accepted only if the way between is smooth: the
//! first correction is small, so is one between the ends, and no block's determinant changes its sign or touches zero. Else it
//! is halved. So the branch followed does not depend on the output times.

mod branch;
mod newton;
mod step_length;
mod touch;

use crate::analysis::state::{Fault, Kinematics, State};
use crate::limits::step_control::{LARGEST_BETWEEN, LARGEST_MOTION};
use branch::Branch;
pub use branch::Signs;
use mechc_expr::math::{GOLDEN, along, parabola, predicted, quintic};
use step_length::Length;

/// Closest distance to a singular position at the end of a step.
const NEAREST: f64 = 1e-6;

/// The state, the state that is tried from there, and the way between.
pub struct Step {
    state: State,
    trial: State,
    branch: Branch,
    length: Length,
    /// Each coordinate between the ends, as a polynomial of the part of the step.
    curve: Vec<[f64; 6]>,
    /// Number from 0 to 1 that the last probe was made of.
    probe: f64,
    /// Newton's last correction, and a position near the state.
    delta: Vec<f64>,
    place: Vec<f64>,
}

/// Corrections of an accepted step.
pub struct Accepted {
    pub first_correction: f64,
    pub between: f64,
    pub motion: f64,
}

/// Start of a step, to which a motion can go back.
#[derive(Clone)]
pub struct Mark {
    pub state: State,
    signs: Signs,
    h: f64,
}

/// Returns a coordinate of a state with its first and second derivatives.
fn end(state: &State, k: usize) -> [f64; 3] {
    [state.q[k], state.qd[k], state.qdd[k]]
}

/// Returns the quintic of a coordinate with value, slope and curvature of two states, `h` (s) apart.
pub fn quintic_between(a: &State, b: &State, k: usize, h: f64) -> [f64; 6] {
    quintic(end(a, k), end(b, k), h)
}

/// Writes the position to which the derivatives of a state lead in a time `h` (s).
pub fn write_prediction(from: &State, h: f64, q: &mut [f64]) {
    for (k, q) in q.iter_mut().enumerate() {
        *q = predicted(end(from, k), h);
    }
}

impl Step {
    /// Returns the step at the start of a motion over a span (s).
    pub fn new(kinematics: &Kinematics, state: State, span: f64) -> Step {
        let n = state.q.len();
        Step {
            trial: state.clone(),
            state,
            branch: Branch::new(kinematics),
            length: Length::new(span),
            curve: vec![[0.0; 6]; n],
            probe: 0.0,
            delta: vec![0.0; n],
            place: vec![0.0; n],
        }
    }

    /// Goes on from the same state with other equations, by steps of a length (s) at first.
    pub fn change_equations(&mut self, kinematics: &mut Kinematics, h: f64) -> Result<(), Fault> {
        self.branch = Branch::new(kinematics);
        self.begin_branch(kinematics);
        self.branch.record_monitor_signs(kinematics);
        self.length.set(h);
        self.derive_state(kinematics)
    }

    /// Returns the state of the motion.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the time of the state (s).
    pub fn t(&self) -> f64 {
        self.state.t
    }

    /// Returns the trial state.
    pub fn trial(&self) -> &State {
        &self.trial
    }

    /// Each coordinate between the ends, as a polynomial of the part of the step.
    pub fn curve(&self) -> &[[f64; 6]] {
        &self.curve
    }

    /// Newton's last correction of a state [m, rad].
    pub fn delta(&self) -> &[f64] {
        &self.delta
    }

    /// Returns the time at which the next step towards a time ends, as far as the error allows (s).
    pub fn end_towards(&self, t: f64) -> f64 {
        self.length.end_towards(self.state.t, t)
    }

    /// Returns the length that the error allows (s).
    pub fn h(&self) -> f64 {
        self.length.h()
    }

    /// Goes to another state, from which steps may have a length (s).
    pub fn go_to(&mut self, kinematics: &mut Kinematics, state: &State, h: f64) {
        self.state.copy_from(state);
        kinematics.restore(&self.state);
        self.begin_branch(kinematics);
        self.branch.record_monitor_signs(kinematics);
        self.length.set(h);
    }

    /// Returns a mark of the state from which the next step begins.
    pub fn mark(&self) -> Mark {
        Mark { state: self.state.clone(), signs: self.branch.signs().clone(), h: self.length.h() }
    }

    /// Writes the mark into another one.
    pub fn write_mark(&self, mark: &mut Mark) {
        mark.state.copy_from(&self.state);
        mark.signs.copy_from(self.branch.signs());
        mark.h = self.length.h();
    }

    /// Goes back to a mark; positions are evaluated there by [`Step::restore_branch`].
    pub fn go_back(&mut self, to: &Mark) {
        self.state.copy_from(&to.state);
        self.length.set(to.h);
    }

    /// Evaluates and factors where a motion has gone back to, which is on the branch that it was on.
    pub fn restore_branch(&mut self, kinematics: &mut Kinematics, to: &Mark) {
        kinematics.restore(&self.state);
        self.begin_branch(kinematics);
        // the signs as accepted: so near to a singular position new ones may be rounding
        self.branch.take_signs(&to.signs);
    }

    /// Takes the determinants where the state was factored; there are none before to compare with.
    pub fn begin_branch(&mut self, kinematics: &Kinematics) {
        self.branch.begin(kinematics);
    }

    /// Takes the signs of the monitors where the state was set.
    pub fn record_monitor_signs(&mut self, kinematics: &Kinematics) {
        self.branch.record_monitor_signs(kinematics);
    }

    /// Checks that the position that was factored is on the branch of the state: all determinants and monitors have kept their signs.
    pub fn same_branch(&mut self, kinematics: &Kinematics) -> Result<(), Fault> {
        self.branch.compare(kinematics)
    }

    /// Checks that the monitors have the signs of the state where a position was set.
    pub fn check_monitors(&mut self, kinematics: &Kinematics) -> Result<(), Fault> {
        self.branch.compare_sides(kinematics)
    }

    /// Returns the signs of the state's branch.
    pub fn signs(&self) -> &Signs {
        self.branch.signs()
    }

    /// Computes the derivatives of the state where it was factored.
    pub fn derive_state(&mut self, kinematics: &mut Kinematics) -> Result<(), Fault> {
        kinematics.derivatives(&mut self.state)
    }

    /// Computes the derivatives of the trial state where it was factored.
    pub fn derive_trial(&mut self, kinematics: &mut Kinematics) -> Result<(), Fault> {
        kinematics.derivatives(&mut self.trial)
    }

    /// Predicts the trial position by Taylor's polynomial with both derivatives of the state; returns the largest motion, scaled.
    pub fn predict(&mut self, kinematics: &Kinematics, h: f64, t: f64) -> Result<f64, Fault> {
        self.trial.t = t;
        for k in 0..self.trial.q.len() {
            self.delta[k] = h * (self.state.qd[k] + 0.5 * h * self.state.qdd[k]);
            self.trial.q[k] = self.state.q[k] + self.delta[k];
        }
        // explicit coordinates have no branches, and may move as far as the predictor is right
        let motion = kinematics.linear().largest_judged_implicit(&self.delta);
        if motion <= LARGEST_MOTION { Ok(motion) } else { Err(Fault::TooFar) }
    }

    /// Predicts from another state, without a limit on the distance.
    pub fn predict_from(&mut self, from: &State, h: f64, t: f64) {
        self.trial.t = t;
        write_prediction(from, h, &mut self.trial.q);
    }

    /// Predicts from the state, without a limit on the distance.
    pub fn predict_freely(&mut self, h: f64, t: f64) {
        self.trial.t = t;
        write_prediction(&self.state, h, &mut self.trial.q);
    }

    /// Tries a state that is known nearly.
    pub fn try_state(&mut self, state: &State) {
        self.trial.copy_from(state);
    }

    /// Tries a position at a time (s).
    pub fn try_position(&mut self, t: f64, q: impl Iterator<Item = f64>) {
        self.trial.t = t;
        for (coordinate, q) in self.trial.q.iter_mut().zip(q) {
            *coordinate = q;
        }
    }

    /// Returns the next fraction of the step to be checked. It wanders from step to step, so that no period of a driver can hide from it.
    pub fn next_probe(&mut self) -> f64 {
        self.probe = (self.probe + GOLDEN).fract();
        0.3 + 0.4 * self.probe
    }

    /// Returns the number from 0 to 1 that the last probe was made of.
    pub fn probe(&self) -> f64 {
        self.probe
    }

    /// Continues the sequence of probes from a value that [`Step::probe`] returned.
    pub fn set_probe(&mut self, probe: f64) {
        self.probe = probe;
    }

    /// Sets the curve to the quintics with value, slope and curvature of both ends.
    pub fn draw_curve(&mut self, h: f64) {
        for (k, curve) in self.curve.iter_mut().enumerate() {
            *curve = quintic_between(&self.state, &self.trial, k, h);
        }
    }

    /// Sets the curve of some coordinates to the way from another state to where the motion is, `h` (s) later.
    pub fn draw_way_since(&mut self, before: &State, h: f64, columns: impl Iterator<Item = usize>) {
        for k in columns {
            self.curve[k] = quintic_between(before, &self.state, k, h);
        }
    }

    /// Sets the curve of some coordinates to the parabola of the state's derivatives, over a time `h` (s).
    pub fn extrapolate_curve(&mut self, h: f64, columns: impl Iterator<Item = usize>) {
        for k in columns {
            self.curve[k] = parabola(end(&self.state, k), h);
        }
    }

    /// Computes Newton's correction between the ends of a step, on the quintic through both, with the factors of the end; returns its size, scaled.
    pub fn correction_between(&mut self, kinematics: &mut Kinematics, h: f64) -> Result<f64, Fault> {
        let x = self.next_probe();
        self.draw_curve(h);
        self.correction_at(kinematics, h, x)
    }

    /// Computes Newton's correction at a place of the curve, given as a part of the step, with the factors of its end; returns its size, scaled.
    pub fn correction_at(&mut self, kinematics: &mut Kinematics, h: f64, x: f64) -> Result<f64, Fault> {
        self.set_on_curve(kinematics, h, x)?;
        kinematics.correction(&mut self.delta);
        let size = kinematics.linear().largest_judged(&self.delta);
        if size <= LARGEST_BETWEEN { Ok(size) } else { Err(Fault::TooFar) }
    }

    /// Evaluates at a place of the curve, given as a part of the step.
    pub fn set_on_curve(&mut self, kinematics: &mut Kinematics, h: f64, x: f64) -> Result<(), Fault> {
        for (place, curve) in self.place.iter_mut().zip(&self.curve) {
            *place = along(curve, x);
        }
        kinematics.set_time(self.state.t + x * h);
        kinematics.set_position(&self.place)
    }

    /// Tries a place of the curve of a step from a time, of a length (s).
    pub fn try_on_curve(&mut self, [from, length]: [f64; 2], t: f64) {
        let x = (t - from) / length;
        self.trial.t = t;
        for (q, curve) in self.trial.q.iter_mut().zip(&self.curve) {
            *q = along(curve, x);
        }
    }

    /// Takes what was solved for otherwise at the end of a step, position and derivatives, as the trial state; returns its distance from
    /// the prediction, scaled.
    pub fn take_solved<'a>(
        &mut self,
        kinematics: &Kinematics,
        derivatives: impl IntoIterator<Item = &'a [f64]>,
    ) -> f64 {
        let Step { trial, place, .. } = self;
        for (place, predicted) in place.iter_mut().zip(&trial.q) {
            *place = *predicted;
        }
        let State { q, qd, qdd, qddd, .. } = trial;
        for (values, solved) in [q, qd, qdd, qddd].into_iter().zip(derivatives) {
            values.copy_from_slice(solved);
        }
        for (place, q) in self.place.iter_mut().zip(&self.trial.q) {
            *place = q - *place;
        }
        kinematics.linear().largest_judged(&self.place)
    }

    /// Goes to the state that was tried, from which scales are taken anew.
    pub fn accept(&mut self, kinematics: &mut Kinematics) {
        self.state.copy_from(&self.trial);
        kinematics.measure_slopes(&self.state.q);
    }

    /// Takes the determinants of the state that was just accepted, after a step of length `h`, and chooses the next length.
    pub fn commit(&mut self, kinematics: &Kinematics, h: f64, accepted: &Accepted) {
        self.branch.keep(kinematics, h);
        self.length.adapt(kinematics, h, accepted);
    }

    /// Halves the length of a step that was refused; returns whether it has become too short.
    pub fn halve(&mut self, h: f64) -> bool {
        self.length.halve(h, self.state.t)
    }
}

/// Rejects a position too near to a singular one for a step to end there.
pub fn reject_near_singular(kinematics: &mut Kinematics) -> Result<(), Fault> {
    if kinematics.nearness(NEAREST) < NEAREST { Err(Fault::Singular) } else { Ok(()) }
}
