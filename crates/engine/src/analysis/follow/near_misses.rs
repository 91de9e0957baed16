//! Near misses of change points. If a length is slightly off, two branches that would cross become two that turn away from each other: with
//! `s` the way of the driver they are `x² = s² + ε`, and the least singular value goes with `√(s² + ε)`. The motion goes on along one of
//! them. For a four-bar `ε` is about three times the relative error of the link.

use crate::analysis::explain::{Warning, singular};
use crate::analysis::state::{Kinematics, State};

/// Distance from a change point, as a part of the lengths, within which it is reported: drawings are rounded so.
const WITHIN: f64 = 5e-4;
/// Error of the lengths, as a part of the square of the driver's motion in which the mechanism turns away.
const OF_LENGTHS: f64 = 1.0 / 3.0;
/// A position farther from a singular one than this is far away.
const FAR: f64 = 0.1;
/// Largest least singular value, as a part of the largest one before: some mechanisms are never far away.
const FALLS: f64 = 0.4;
/// Largest relative change of the speed of drivers meanwhile.
const EVEN: f64 = 0.3;

/// Watches for change points that a motion just misses.
pub struct NearMisses {
    /// The last two states that were come to.
    last: [Look; 2],
    /// The second of these.
    state: State,
    /// The one that is nearest to a singular position.
    nearest: State,
    /// Scratch state.
    scratch: State,
    /// The largest singular value since the last least one.
    highest: f64,
    /// True if rows are handed out, which the warning accompanies; a motion that is followed for its results alone is not monitored.
    is_watching: bool,
    is_reported: bool,
    found: Option<Miss>,
}

/// A change point that was missed.
#[derive(Clone, Copy)]
struct Miss {
    /// Time (s).
    t: f64,
    /// Distance from the change point, as a fraction of the lengths.
    within: f64,
}

/// Nearness of a state to a singular position.
#[derive(Clone, Copy)]
struct Look {
    t: f64,
    sigma: f64,
}

impl Look {
    const NONE: Look = Look { t: f64::NEG_INFINITY, sigma: f64::NEG_INFINITY };
}

impl NearMisses {
    pub fn new(state: &State) -> NearMisses {
        NearMisses {
            last: [Look::NONE; 2],
            state: state.clone(),
            nearest: state.clone(),
            scratch: state.clone(),
            highest: 0.0,
            is_watching: false,
            is_reported: false,
            found: None,
        }
    }

    /// Begins to watch: from now on rows are handed out.
    pub fn watch(&mut self) {
        self.is_watching = true;
    }

    /// Forgets the last states, which the next one does not continue.
    pub fn forget(&mut self) {
        (self.last, self.highest) = ([Look::NONE; 2], 0.0);
    }

    /// Looks at a state that was just come to, where it was factored, with what it was factored with left as it is.
    pub fn take(&mut self, kinematics: &mut Kinematics, state: &State) {
        // if equations were left out, the others come near to singular positions that all together do not have
        if !self.is_watching || self.is_reported || !kinematics.system().checks().is_empty() {
            return;
        }
        if state.t <= self.last[1].t {
            self.forget();
        }
        let sigma = kinematics.nearness(FAR).min(FAR);
        let now = Look { t: state.t, sigma };
        let [before, least] = self.last;
        if let Some([turning, t]) = least_between([before, least, now]).filter(|_| least.sigma <= FALLS * self.highest)
        {
            let then = required_speed(kinematics, &mut self.state);
            self.scratch.copy_from(state);
            let speed = required_speed(kinematics, &mut self.scratch);
            // a driver that turns back before a dead point comes near to one as well
            let is_even = (speed - then).abs() <= EVEN * speed;
            let within = OF_LENGTHS * turning * speed * speed;
            if is_even && within <= WITHIN {
                self.nearest.copy_from(&self.state);
                (self.is_reported, self.found) = (true, Some(Miss { t, within }));
            }
            kinematics.restore(state);
        }
        self.highest = if least.sigma < before.sigma && least.sigma < sigma { sigma } else { self.highest.max(sigma) };
        self.last = [least, now];
        self.state.copy_from(state);
    }

    /// Takes the warning of a near miss up to a time (s); the motion stays where it is, `here`.
    pub fn take_warning(&mut self, kinematics: &mut Kinematics, here: &State, t: f64) -> Option<Warning> {
        let Miss { t, within } = self.found.take_if(|miss| miss.t <= t)?;
        let why = singular::warn_of_miss(kinematics, &self.nearest, within, t);
        kinematics.restore(here);
        self.is_reported = why.is_some();
        why
    }
}

/// Returns the square of the time in which the motion turns away from a singular position that it is nearest to at about the second of
/// three states (s²), and the time of that minimum (s).
fn least_between([a, b, c]: [Look; 3]) -> Option<[f64; 2]> {
    if !(b.sigma < a.sigma && b.sigma <= c.sigma && b.sigma < FAR) {
        return None;
    }
    let square = |look: Look| look.sigma * look.sigma;
    // the parabola through all three
    let [left, right] = [a, c].map(|look| (square(look) - square(b)) / (look.t - b.t));
    let bend = (right - left) / (c.t - a.t);
    let slope = left - bend * (a.t - b.t);
    let (offset, down) = (-0.5 * slope / bend, 0.25 * slope * slope / bend);
    Some([(square(b) - down).max(0.0) / bend, b.t + offset])
}

/// Returns the largest speed that the equations prescribe in a state, scaled (1/s).
fn required_speed(kinematics: &mut Kinematics, state: &mut State) -> f64 {
    kinematics.restore(state);
    // the prescribed speeds are finite even where those of the mechanism are not
    let _ = kinematics.derivatives(state);
    (0..kinematics.system().rows().len()).map(|row| kinematics.prescribed_speed(row)).fold(0.0, f64::max)
}
