//! From one output time to the next, in steps that the solver chooses by its own error.
//!
//! Each step predicts `q + h q̇ + h²/2 q̈`, corrects by Newton, and is accepted only if the way between is smooth: the
//! first correction is small, so is one between the ends, and no block's determinant changes its sign. Else it is halved. So the branch followed does not depend on the output times.

use super::errors;
use super::kinematics::{Fault, Kinematics, State};
use super::singular;
use crate::diag::Diagnostic;

/// Largest first correction of a step, scaled.
const LARGEST_CORRECTION: f64 = 0.05;
/// Largest correction between the ends of a step, on the curve through both, scaled.
const LARGEST_BETWEEN: f64 = 1e-3;
/// Largest predicted motion of a step, scaled: a coordinate's way in sizes of its body, or its turn in radians.
const LARGEST_MOTION: f64 = 0.5;
/// Corrections of a step at most.
const ITERATIONS: usize = 4;
/// A correction below this leaves nothing to the next one, convergence being quadratic.
const SETTLED: f64 = 1e-7;
/// Steps over the whole span at least, so that what happens in it is met.
const FEWEST_STEPS: f64 = 64.0;
/// The golden ratio's fraction: its multiples never come close to a period.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Smallest step, as a part of the whole span.
const SMALLEST_STEP: f64 = 1e-12;
/// A position nearer to a singular one than this is not stepped to.
const NEAREST: f64 = 1e-6;
/// Where a row is printed, what rounding makes of it must stay below the accuracy promised.
const ACCURACY: f64 = 1e-9;
/// Steps from one output time to the next at most: what takes more is not meant.
const MOST_STEPS: u64 = 1_000_000;

/// A motion in progress: rows at ascending times, computed without allocating.
pub struct Motion<'m, 'd> {
    kinematics: &'m mut Kinematics<'d>,
    state: &'m mut State,
    trial: State,
    delta: Vec<f64>,
    middle: Vec<f64>,
    signs: Vec<bool>,
    trial_signs: Vec<bool>,
    /// The step that the error allows (s).
    h: f64,
    smallest: f64,
    largest: f64,
    /// Where the last step was looked into, from 0 to 1.
    probe: f64,
    begun: bool,
    row: Vec<f64>,
}

/// How well a step went.
struct Accepted {
    first_correction: f64,
    between: f64,
}

impl<'m, 'd> Motion<'m, 'd> {
    pub(super) fn new(kinematics: &'m mut Kinematics<'d>, state: &'m mut State, span: f64) -> Motion<'m, 'd> {
        let n = state.q.len();
        let blocks = kinematics.linear().blocks();
        let smallest = SMALLEST_STEP * span;
        Motion {
            trial: state.clone(),
            delta: vec![0.0; n],
            middle: vec![0.0; n],
            signs: vec![true; blocks],
            trial_signs: vec![true; blocks],
            h: span / FEWEST_STEPS,
            smallest,
            largest: span / FEWEST_STEPS,
            probe: 0.0,
            begun: false,
            row: vec![0.0; kinematics.row_length()],
            kinematics,
            state,
        }
    }

    /// Goes on to time `t` (s), not before the last one, and gives its row, in the order of `Started::columns`.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn row_at(&mut self, t: f64) -> Result<&[f64], Box<Diagnostic>> {
        if !self.begun {
            self.begin()?;
        }
        if t <= self.state.t {
            self.row_at_rest()?;
        }
        let mut steps = 0;
        while self.state.t < t {
            steps += 1;
            if steps > MOST_STEPS {
                return Err(Box::new(singular::explain_haste(self.kinematics, self.state, MOST_STEPS, t)));
            }
            let left = t - self.state.t;
            // no crumb at the end
            let (h, next) = if self.h >= 0.999 * left { (left, t) } else { (self.h, self.state.t + self.h) };
            match self.try_step(h, next, next >= t) {
                Ok(accepted) => self.accept(h, &accepted),
                Err(fault) => self.shorten(h, fault, t)?,
            }
        }
        if self.row.iter().all(|value| value.is_finite()) { Ok(&self.row) } else { Err(Box::new(self.explain_row(t))) }
    }

    /// A row has been computed that holds something which is no number: a measure, since the coordinates are finite.
    fn explain_row(&mut self, t: f64) -> Diagnostic {
        let column = self.row.iter().position(|value| !value.is_finite()).unwrap_or(0);
        errors::measure_not_finite(self.kinematics.system(), self.kinematics.measure_of_column(column), t)
    }

    /// Derivatives at the start.
    fn begin(&mut self) -> Result<(), Box<Diagnostic>> {
        self.begun = true;
        self.kinematics.restore(self.state);
        self.kinematics.linear().signs(&mut self.signs);
        if let Err(fault) = self.kinematics.derivatives(self.state) {
            return Err(Box::new(self.explain_start(fault)));
        }
        Ok(())
    }

    fn explain_start(&mut self, fault: Fault) -> Diagnostic {
        let t = self.state.t;
        singular::explain(self.kinematics, self.state, fault, 0.0, t)
    }

    /// The row of the state that has been reached already: the start.
    fn row_at_rest(&mut self) -> Result<(), Box<Diagnostic>> {
        self.kinematics.restore(self.state);
        match self.kinematics.derivatives(self.state).and_then(|()| Self::trustworthy(self.kinematics, self.state)) {
            Ok(()) => self.kinematics.write_row(self.state, &mut self.row),
            Err(fault) => return Err(Box::new(self.explain_start(fault))),
        }
        Ok(())
    }

    /// A step of length `h` to time `t`, whose row is written if it is wanted.
    fn try_step(&mut self, h: f64, t: f64, wanted: bool) -> Result<Accepted, Fault> {
        self.predict(h, t)?;
        let first_correction = self.correct()?;
        self.kinematics.linear().signs(&mut self.trial_signs);
        if self.trial_signs != self.signs {
            return Err(Fault::Singular);
        }
        self.keep_away()?;
        self.kinematics.derivatives(&mut self.trial)?;
        if wanted {
            Self::trustworthy(self.kinematics, &self.trial)?;
            self.kinematics.write_row(&self.trial, &mut self.row);
        }
        let between = self.correction_between(h)?;
        Ok(Accepted { first_correction, between })
    }

    /// Taylor's predictor, which costs nothing: both derivatives are known.
    fn predict(&mut self, h: f64, t: f64) -> Result<(), Fault> {
        self.trial.t = t;
        let mut motion: f64 = 0.0;
        for k in 0..self.trial.q.len() {
            let step = h * (self.state.qd[k] + 0.5 * h * self.state.qdd[k]);
            self.trial.q[k] = self.state.q[k] + step;
            motion = motion.max(step.abs() / self.kinematics.linear().column_scale(k));
        }
        if motion <= LARGEST_MOTION { Ok(()) } else { Err(Fault::TooFar) }
    }

    /// Newton, until the full Φ is below the tolerance; gives the first correction.
    fn correct(&mut self) -> Result<f64, Fault> {
        self.kinematics.set_time(self.trial.t);
        self.kinematics.set_position(&self.trial.q)?;
        let mut first = None;
        for _ in 0..ITERATIONS {
            self.kinematics.factor()?;
            let size = self.kinematics.correction(&mut self.delta);
            let bound = if first.is_none() { LARGEST_CORRECTION } else { 0.25 * LARGEST_CORRECTION };
            if size.is_nan() || size > bound {
                return Err(Fault::TooFar);
            }
            first.get_or_insert(size);
            for (q, delta) in self.trial.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            self.kinematics.set_position(&self.trial.q)?;
            if size <= SETTLED && self.kinematics.violated().is_none() {
                self.kinematics.factor()?;
                return Ok(first.unwrap_or(size));
            }
        }
        Err(Fault::TooFar)
    }

    /// No step ends too near to a singular position.
    fn keep_away(&mut self) -> Result<(), Fault> {
        if self.kinematics.nearness(NEAREST) < NEAREST { Err(Fault::Singular) } else { Ok(()) }
    }

    /// What is printed must not be rounding: `q` is known to eps/σ, and a position that is wrong by so much has
    /// derivatives that are wrong by as much again as the equations amplify, which near a dead point is 1/σ too.
    fn trustworthy(kinematics: &mut Kinematics<'_>, state: &State) -> Result<(), Fault> {
        let sigma = kinematics.nearness(f64::EPSILON.sqrt() / ACCURACY.sqrt());
        let uncertain = f64::EPSILON / sigma * kinematics.amplification(state);
        if uncertain > ACCURACY { Err(Fault::Singular) } else { Ok(()) }
    }

    /// Newton's correction between the ends, on the quintic that both ends give, with the factors of the end.
    ///
    /// The place wanders from step to step, so that no period of a driver can hide from it.
    fn correction_between(&mut self, h: f64) -> Result<f64, Fault> {
        self.probe = (self.probe + GOLDEN).fract();
        let x = 0.3 + 0.4 * self.probe;
        let (x2, x3, rest) = (x * x, x * x * x, 1.0 - x);
        // the quintic Hermite basis: value, slope and curvature at the end, then at the start
        let end = x3 * (10.0 + x * (6.0 * x - 15.0));
        let end_slope = h * x3 * (x * (7.0 - 3.0 * x) - 4.0);
        let end_curvature = h * h * 0.5 * x3 * rest * rest;
        let start_slope = h * (x + x3 * (x * (8.0 - 3.0 * x) - 6.0));
        let start_curvature = h * h * 0.5 * x2 * rest * rest * rest;
        let (a, b) = (&*self.state, &self.trial);
        for k in 0..self.middle.len() {
            self.middle[k] = a.q[k]
                + end * (b.q[k] - a.q[k])
                + start_slope * a.qd[k]
                + start_curvature * a.qdd[k]
                + end_slope * b.qd[k]
                + end_curvature * b.qdd[k];
        }
        self.kinematics.set_time(a.t + x * h);
        self.kinematics.set_position(&self.middle)?;
        let size = self.kinematics.correction(&mut self.delta);
        if size <= LARGEST_BETWEEN { Ok(size) } else { Err(Fault::TooFar) }
    }

    fn accept(&mut self, h: f64, accepted: &Accepted) {
        self.state.copy_from(&self.trial);
        self.signs.copy_from_slice(&self.trial_signs);
        // the predictor's error grows with h³, the curve's between with h⁶
        let calm = accepted.first_correction < LARGEST_CORRECTION / 12.0 && accepted.between < LARGEST_BETWEEN / 100.0;
        if calm {
            // a step cut short by an output time says little of a longer one
            self.h = self.h.max(2.0 * h).min(self.largest);
        } else {
            self.h = self.h.min(h);
        }
    }

    fn shorten(&mut self, h: f64, fault: Fault, target: f64) -> Result<(), Box<Diagnostic>> {
        self.h = 0.5 * h;
        let vanishes = self.state.t + self.h <= self.state.t;
        if self.h < self.smallest || vanishes {
            return Err(Box::new(singular::explain(self.kinematics, self.state, fault, h, target)));
        }
        Ok(())
    }
}
