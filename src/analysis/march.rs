//! From one output time to the next, in steps that the solver chooses by its own error.
//!
//! Each step predicts `q + h q̇ + h²/2 q̈`, corrects by Newton, and is accepted only if the way between is smooth: the
//! first correction is small, so is one between the ends, and no block's determinant changes its sign or touches zero. Else it
//! is halved. So the branch followed does not depend on the output times.

use super::GOLDEN;
use super::bridge::Bridge;
use super::determinant::Determinant;
use super::edges::{Edge, Restless, behind_start};
use super::kinematics::{Fault, Kinematics, State};
use super::rims::Rims;
use super::rows::{Bookmark, Output};
use super::signals::Signals;
use super::singular;
use super::times::Times;
use super::touch::Before;
use super::trust::Trust;
use crate::diag::{Diagnostic, Diagnostics};
use crate::ir::{DeclarationId, IdVec};
use crate::program::Enclosure;
use crate::solver::Solver;
use crate::tolerances::steps::march::{
    FEWEST_STEPS, FEWEST_STEPS_NEAR, ILL, ITERATIONS, LARGEST_BETWEEN, LARGEST_CORRECTION, LARGEST_MOTION, NEAREST,
    SETTLED, SMALLEST_STEP,
};

use std::sync::Arc;

/// A motion in progress: rows at ascending times, computed without allocating.
#[allow(clippy::struct_excessive_bools)] // what has begun, what is wanted, what the row is worth: nothing of them follows from another
pub struct Motion {
    pub(super) rims: Rims,
    pub(super) kinematics: Kinematics,
    pub(super) state: State,
    pub(super) trial: State,
    pub(super) delta: Vec<f64>,
    pub(super) middle: Vec<f64>,
    /// Each block's determinant at the state, at the state that is tried, and at the one before.
    pub(super) determinants: Vec<Determinant>,
    pub(super) trial_determinants: Vec<Determinant>,
    pub(super) determinants_before: Vec<Determinant>,
    /// What else is known of the way up to the state.
    pub(super) way_before: Before,
    /// The sign of what is watched.
    pub(super) sides: Vec<bool>,
    pub(super) trial_sides: Vec<bool>,
    /// The time that the steps are measured against (s).
    pub(super) span: f64,
    /// The last time (s).
    pub(super) last: f64,
    /// What time alone asks for.
    pub(super) signals: Signals,
    /// What may happen in time, and along the motion.
    pub(super) in_time: Enclosure,
    pub(super) along: Enclosure,
    /// Each coordinate between the ends of a step, as a polynomial of the part of the step.
    pub(super) curve: Vec<[f64; 6]>,
    /// Each coordinate's middle and reach in a part of a step.
    pub(super) boxes: Vec<[f64; 2]>,
    /// By switch.
    pub(super) restless: Vec<Restless>,
    pub(super) switches_before: Vec<f64>,
    /// An edge of the motion that a longer step has met.
    pub(super) met: Option<Edge>,
    /// The earlier side of the edge that is being crossed.
    pub(super) before: State,
    pub(super) row_before: Vec<f64>,
    /// How fast velocities and accelerations changed, scaled, over the last step (1/s², 1/s³).
    pub(super) velocity_change: f64,
    pub(super) acceleration_change: f64,
    /// The largest velocity and acceleration so far, scaled (1/s, 1/s²).
    pub(super) fastest: f64,
    pub(super) hardest: f64,
    /// Declarations of which it has been said that they make an acceleration jump.
    pub(super) warned: IdVec<DeclarationId, bool>,
    pub(super) remarks: Diagnostics,
    /// Times at which accelerations have jumped (s), if anybody asks for them.
    pub(super) edges: Option<Vec<f64>>,
    /// Whether to go on beyond bifurcations.
    pub(super) pass: bool,
    /// The last state that was clear of singular positions.
    pub(super) clear: State,
    /// The way over the last singular position.
    pub(super) bridge: Option<Bridge>,
    /// The same, where it was only looked for to hold a row against it.
    pub(super) spare_bridge: Option<Bridge>,
    /// Up to this time (s) there is none: the motion is clear again then.
    pub(super) clear_ahead: f64,
    /// When the mechanism comes to the end of its reach, where that is nearly far enough for what is asked for (s).
    pub(super) fold: Option<f64>,
    /// The last row on that way which was found without it.
    pub(super) plain: Option<Bookmark>,
    /// The step that the error allows (s).
    pub(super) h: f64,
    smallest: f64,
    /// Where the last step was looked into, from 0 to 1.
    pub(super) probe: f64,
    pub(super) begun: bool,
    /// What the row is worth.
    pub(super) trust: Trust,
    /// Whether it is near a position that may be a bifurcation to pass.
    pub(super) is_near: bool,
    pub(super) row: Vec<f64>,
    pub(super) output: Output,
}

/// How well a step went.
pub(super) struct Accepted {
    pub first_correction: f64,
    pub between: f64,
    pub motion: f64,
}

impl Motion {
    pub(super) fn new(mut kinematics: Kinematics, state: State, solver: Option<Arc<Solver>>, times: Times) -> Motion {
        let span = times.span();
        let output = Output::new(&kinematics, &state, solver, times);
        let n = state.q.len();
        let blocks = kinematics.linear().blocks();
        let watches = kinematics.system().watches.len();
        let smallest = SMALLEST_STEP * span;
        let signals = Signals::new(&mut kinematics, &state);
        let rims = Rims::new(&kinematics, &state);
        let switches = kinematics.switches();
        let [in_time, along] = kinematics.enclosures();
        Motion {
            rims,
            // what happens in no time at all is measured by the second
            span: if span > 0.0 { span } else { 1.0 },
            last: state.t + span,
            signals,
            in_time,
            along,
            curve: vec![[0.0; 6]; n],
            boxes: vec![[0.0; 2]; n],
            restless: vec![Restless::NEVER; switches.len()],
            switches_before: vec![0.0; switches.len()],
            met: None,
            before: state.clone(),
            row_before: vec![0.0; kinematics.row_length()],
            velocity_change: 0.0,
            acceleration_change: 0.0,
            fastest: 0.0,
            hardest: 0.0,
            warned: kinematics.system().declarations.map(|_| false),
            remarks: Diagnostics::default(),
            edges: None,
            trial: state.clone(),
            pass: false,
            clear: state.clone(),
            bridge: None,
            spare_bridge: None,
            clear_ahead: f64::NEG_INFINITY,
            fold: None,
            plain: None,
            delta: vec![0.0; n],
            middle: vec![0.0; n],
            determinants: vec![Determinant::ONE; blocks],
            trial_determinants: vec![Determinant::ONE; blocks],
            determinants_before: vec![Determinant::ONE; blocks],
            way_before: Before::UNKNOWN,
            sides: vec![true; watches],
            trial_sides: vec![true; watches],
            h: span / FEWEST_STEPS_NEAR,
            smallest,
            probe: 0.0,
            begun: false,
            trust: Trust::Certain,
            is_near: false,
            row: vec![0.0; kinematics.row_length()],
            output,
            kinematics,
            state,
        }
    }

    /// Goes on beyond bifurcations, along the branch that continues smoothly, with a remark each time.
    pub fn pass_bifurcations(&mut self) {
        self.pass = true;
    }

    /// A step, as far as the error and the next edge allow, which is gone over.
    pub(super) fn step_towards(&mut self, t: f64) -> Result<(), Box<Diagnostic>> {
        let edge = self.step_to_edge(t)?;
        edge.map_or(Ok(()), |edge| self.cross(edge))
    }

    /// The same, up to the edge.
    pub(super) fn step_to_edge(&mut self, t: f64) -> Result<Option<Edge>, Box<Diagnostic>> {
        let left = t - self.state.t;
        // no crumb at the end
        let next = if self.h >= 0.999 * left { t } else { self.state.t + self.h };
        let edge = self.next_edge(next, next >= t)?;
        let next = edge.map_or(next, |edge| edge.t);
        let h = next - self.state.t;
        if h <= 0.0 {
            return Ok(edge);
        }
        match self.try_step(h, next, next >= t, self.met.is_some_and(|met| met.t <= next)) {
            Ok(accepted) => {
                self.accept(h, &accepted);
                Ok(edge)
            }
            Err(fault) => self.give_way(h, fault, t).map(|()| None),
        }
    }

    /// What there is to do where a step of length `h` on the way to `target` was refused.
    pub(super) fn give_way(&mut self, h: f64, fault: Fault, target: f64) -> Result<(), Box<Diagnostic>> {
        match fault {
            Fault::Edge { t, switch } if self.rests_on_edge(switch) => {
                self.leave_alone(switch, t);
                Ok(())
            }
            Fault::Edge { t, .. } if self.locate(t) => Ok(()),
            Fault::Rim => self.cross_rim(),
            fault => self.shorten(h, fault, target),
        }
    }

    /// From now on it remembers at which times accelerations jump.
    pub fn keep_edges(&mut self) {
        self.edges.get_or_insert_default();
    }

    /// These times (s), ascending, each once.
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        let mut edges = self.edges.clone().unwrap_or_default();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        edges
    }

    /// What there is to say beside the rows so far, each thing once.
    pub fn take_remarks(&mut self) -> Diagnostics {
        self.say_what_is_missing();
        std::mem::take(&mut self.remarks)
    }

    /// Derivatives at the start.
    pub(super) fn begin(&mut self) -> Result<(), Box<Diagnostic>> {
        self.begun = true;
        self.kinematics.restore(&self.state);
        if !self.kinematics.switches().is_empty() {
            // which way it goes on decides on which side of an edge it begins
            let _ = self.kinematics.derivatives(&mut self.state);
            self.settle(Some(behind_start(self.state.t, self.span)));
            self.kinematics.restore(&self.state);
        }
        self.begin_determinants();
        self.kinematics.sides(&mut self.sides);
        if let Err(fault) = self.kinematics.derivatives(&mut self.state) {
            return Err(Box::new(self.explain_start(fault)));
        }
        Ok(())
    }

    pub(super) fn explain_start(&mut self, fault: Fault) -> Diagnostic {
        let t = self.state.t;
        singular::explain(&mut self.kinematics, &self.state, fault, 0.0, t)
    }

    /// A step of length `h` to time `t`, whose row is written if it is wanted.
    fn try_step(&mut self, h: f64, t: f64, wanted: bool, to_edge_of_motion: bool) -> Result<Accepted, Fault> {
        let motion = self.predict(h, t)?;
        let first_correction = self.correct()?;
        if !to_edge_of_motion && let Some(switch) = self.edge_met() {
            return Err(Fault::Edge { t, switch });
        }
        self.same_branch()?;
        self.keep_away()?;
        self.kinematics.derivatives(&mut self.trial)?;
        if wanted {
            self.trust = Trust::of(&mut self.kinematics, &self.trial);
            self.is_near = self.pass && !self.is_clear();
            self.kinematics.write_row(&self.trial, &mut self.row);
        }
        let between = self.correction_between(h)?;
        self.look_at_signals(h)?;
        if !to_edge_of_motion {
            self.look_between(h, between)?;
        }
        self.look_for_rims(h)?;
        self.look_for_touch(h, motion)?;
        Ok(Accepted { first_correction, between, motion })
    }

    /// Whether the position that was factored is on the branch of the state: every determinant, and what is watched, has
    /// kept its sign.
    pub(super) fn same_branch(&mut self) -> Result<(), Fault> {
        self.kinematics.linear().determinants(&mut self.trial_determinants);
        self.kinematics.sides(&mut self.trial_sides);
        if let Some(index) = (0..self.sides.len()).find(|&k| self.sides[k] != self.trial_sides[k]) {
            return Err(Fault::Watch { index });
        }
        let mut pairs = self.trial_determinants.iter().zip(&self.determinants);
        if pairs.all(|(trial, now)| trial.is_positive() == now.is_positive()) { Ok(()) } else { Err(Fault::Singular) }
    }

    /// Taylor's predictor, which costs nothing: both derivatives are known. Gives the largest motion, scaled.
    pub(super) fn predict(&mut self, h: f64, t: f64) -> Result<f64, Fault> {
        self.trial.t = t;
        for k in 0..self.trial.q.len() {
            self.delta[k] = h * (self.state.qd[k] + 0.5 * h * self.state.qdd[k]);
            self.trial.q[k] = self.state.q[k] + self.delta[k];
        }
        // what follows without iteration has no branches, and may go as far as the predictor is right
        let motion = self.kinematics.linear().largest_judged_implicit(&self.delta);
        if motion <= LARGEST_MOTION { Ok(motion) } else { Err(Fault::TooFar) }
    }

    /// Newton, until the full Φ is below the tolerance; gives the first correction.
    pub(super) fn correct(&mut self) -> Result<f64, Fault> {
        self.kinematics.set_time(self.trial.t);
        self.kinematics.set_position(&self.trial.q)?;
        let mut first = None;
        for _ in 0..ITERATIONS {
            self.kinematics.factor()?;
            self.kinematics.correction(&mut self.delta);
            let size = self.kinematics.linear().largest_judged(&self.delta);
            let bound = if first.is_none() { LARGEST_CORRECTION } else { 0.25 * LARGEST_CORRECTION };
            if size.is_nan() || size > bound {
                return Err(Fault::TooFar);
            }
            first.get_or_insert(size);
            for (q, delta) in self.trial.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            self.kinematics.set_position(&self.trial.q)?;
            if size <= SETTLED && size <= self.settled() && self.kinematics.violated().is_none() {
                let broken = self.kinematics.broken_check();
                self.kinematics.factor()?;
                if let Some(index) = broken {
                    // beside a singular position it is the position that is not known, and not the equation that does not hold
                    let is_near = self.kinematics.nearness(ILL) < ILL;
                    return Err(if is_near { Fault::Singular } else { Fault::Check { index } });
                }
                return Ok(first.unwrap_or(size));
            }
        }
        Err(Fault::TooFar)
    }

    /// A correction below this leaves nothing to the next one: near a singular position what it leaves is larger by as much as
    /// that is near, and no correction is smaller than rounding.
    fn settled(&mut self) -> f64 {
        if self.kinematics.linear().smallest_pivot() > 10.0 * ILL {
            return SETTLED;
        }
        let sigma = self.kinematics.nearness(ILL);
        if sigma < ILL { f64::max(SETTLED * sigma, 10.0 * f64::EPSILON / sigma) } else { SETTLED }
    }

    /// No step ends too near to a singular position.
    pub(super) fn keep_away(&mut self) -> Result<(), Fault> {
        if self.kinematics.nearness(NEAREST) < NEAREST { Err(Fault::Singular) } else { Ok(()) }
    }

    /// The place of a step that is looked at next, as a part of the step.
    pub(super) fn next_probe(&mut self) -> f64 {
        self.probe = (self.probe + GOLDEN).fract();
        0.3 + 0.4 * self.probe
    }

    /// Newton's correction between the ends, on the quintic that both ends give, with the factors of the end.
    ///
    /// The place wanders from step to step, so that no period of a driver can hide from it.
    fn correction_between(&mut self, h: f64) -> Result<f64, Fault> {
        let x = self.next_probe();
        self.draw_curve(h);
        self.correction_at(h, x)
    }

    /// Evaluates at a place of the curve, given as a part of the step.
    pub(super) fn set_on_curve(&mut self, h: f64, x: f64) -> Result<(), Fault> {
        for (middle, curve) in self.middle.iter_mut().zip(&self.curve) {
            *middle = along(curve, x);
        }
        self.kinematics.set_time(self.state.t + x * h);
        self.kinematics.set_position(&self.middle)
    }

    /// Newton's correction at a place of the curve, given as a part of the step, with the factors of its end.
    pub(super) fn correction_at(&mut self, h: f64, x: f64) -> Result<f64, Fault> {
        self.set_on_curve(h, x)?;
        self.kinematics.correction(&mut self.delta);
        let size = self.kinematics.linear().largest_judged(&self.delta);
        if size <= LARGEST_BETWEEN { Ok(size) } else { Err(Fault::TooFar) }
    }

    /// The quintic with value, slope and curvature of both ends, by its coefficients.
    pub(super) fn draw_curve(&mut self, h: f64) {
        for (k, curve) in self.curve.iter_mut().enumerate() {
            *curve = quintic(&self.state, &self.trial, k, h);
        }
    }

    pub(super) fn accept(&mut self, h: f64, accepted: &Accepted) {
        if !self.kinematics.switches().is_empty() {
            let (a, b, linear) = (&self.state, &self.trial, self.kinematics.linear());
            let change = |a: &[f64], b: &[f64]| {
                let scaled = |k: usize| (b[k] - a[k]).abs() / linear.column_scale(k);
                (0..a.len()).map(scaled).fold(0.0, f64::max)
            };
            // a motion that begins and ends at rest within the step is fast between
            let swing = |k: usize| (b.q[k] - a.q[k] - 0.5 * h * (a.qd[k] + b.qd[k])).abs() / linear.column_scale(k);
            let swing = (0..a.q.len()).map(swing).fold(0.0, f64::max);
            let (faster, harder) = (2.0 * swing / h, 6.0 * swing / (h * h));
            self.velocity_change = f64::max(change(&a.qd, &b.qd) / h, harder);
            self.acceleration_change = f64::max(change(&a.qdd, &b.qdd) / h, 6.0 * harder / h);
            self.fastest = self.fastest.max(linear.largest(&b.qd)).max(faster);
            self.hardest = self.hardest.max(linear.largest(&b.qdd)).max(harder);
        }
        self.state.copy_from(&self.trial);
        self.kinematics.measure_slopes(&self.state.q);
        self.keep_if_clear();
        self.keep_determinants(h);
        // a singular value changes by no more than the motion, or little more
        let longest = self.span / FEWEST_STEPS;
        let is_near = 2.0 * accepted.motion * longest >= self.kinematics.linear().smallest_pivot() * h;
        let longest = if is_near { self.span / FEWEST_STEPS_NEAR } else { longest };
        // the predictor's error grows with h³, the curve's between with h⁶
        let calm = accepted.first_correction < LARGEST_CORRECTION / 12.0 && accepted.between < LARGEST_BETWEEN / 100.0;
        if calm {
            // a step cut short by an output time says little of a longer one
            self.h = self.h.max(2.0 * h).min(longest);
        } else {
            self.h = self.h.min(h).min(longest);
        }
    }

    fn shorten(&mut self, h: f64, fault: Fault, target: f64) -> Result<(), Box<Diagnostic>> {
        self.h = 0.5 * h;
        let vanishes = self.state.t + self.h <= self.state.t;
        if self.h < self.smallest || vanishes {
            if let Some(why) = self.end_at_rim(h) {
                return Err(why);
            }
            return self.pass_or_explain(fault, h, target);
        }
        Ok(())
    }
}

/// The quintic of a coordinate with value, slope and curvature of two states, `h` (s) apart, by its coefficients.
pub(super) fn quintic(a: &State, b: &State, k: usize, h: f64) -> [f64; 6] {
    let (way, slope, bend) = (b.q[k] - a.q[k], h * a.qd[k], 0.5 * h * h * a.qdd[k]);
    // what is left of value, slope and half the curvature at the end
    let (value, first, second) = (way - slope - bend, h * b.qd[k] - slope - 2.0 * bend, 0.5 * h * h * b.qdd[k] - bend);
    let cubic = 10.0 * value - 4.0 * first + second;
    let quartic = -15.0 * value + 7.0 * first - 2.0 * second;
    let quintic = 6.0 * value - 3.0 * first + second;
    [a.q[k], slope, bend, cubic, quartic, quintic]
}

/// A coordinate on its curve, at a part of the step.
pub(super) fn along(curve: &[f64; 6], x: f64) -> f64 {
    curve.iter().rev().fold(0.0, |sum, c| sum * x + c)
}
