//! Over a singular position: from the last state that is well clear of it to one as far beyond, never solving at it.
//!
//! Beyond a lock-up there is no such state. Beyond a bifurcation the prediction from before leads to the branch that goes on
//! smoothly, since the other ones are far from it there. Between the two states the motion is the quintic through both,
//! which also tells when the singular position is reached.

use super::finer::Finer;
use super::march::Motion;
use crate::analysis::explain::{errors, singular};
use crate::analysis::state::{Determinant, Fault, State};
use crate::math::GOLDEN;
use crate::tolerances::solving::trust::SLOW;

use crate::diag::Diagnostic;
use crate::tolerances::singular::bridge::{
    BEYOND, BEYOND_ZERO, CERTAIN, CLEAR, EXACT, LARGEST_BETWEEN, LARGEST_CORRECTION, LOOKS, NEARLY_ZERO, NEWTON_STEPS,
    OPEN, PLACES, PLACES_BETWEEN, SOLVABLE, SPREAD, STEP_BACK, STEPS_BACK,
};

/// The minimum's slope by central differences of sixth order, and its curvature, by the distance of the places in `SPREAD`.
const SLOPE: [f64; 3] = [45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0];
const CURVATURE: [f64; 4] = [-490.0 / 180.0, 270.0 / 180.0, -27.0 / 180.0, 2.0 / 180.0];

/// The way over a singular position.
#[derive(Clone, Debug)]
pub struct Bridge {
    pub from: State,
    pub to: State,
    /// When the singular position is reached (s).
    pub at: f64,
    /// When another one is, or the same again by a motion that turns back just beyond it (s).
    again: Option<f64>,
    /// A curve for rows that the quintic is not exact enough for, and whether it has been looked for.
    finer: Option<Finer>,
    is_searched: bool,
    /// The same for what nothing else serves, over a shorter way.
    narrow: Option<Finer>,
    is_narrow_searched: bool,
}

impl Bridge {
    /// A row of its own: bridges are rare.
    fn new(from: &State, to: &State) -> Bridge {
        Bridge {
            from: from.clone(),
            to: to.clone(),
            at: from.t,
            again: None,
            finer: None,
            is_searched: false,
            narrow: None,
            is_narrow_searched: false,
        }
    }

    /// The state at a time between, by the quintic with value, slope and curvature of both ends.
    pub fn state_at(&self, t: f64) -> State {
        let h = self.to.t - self.from.t;
        let x = (t - self.from.t) / h;
        let mut state = self.from.clone();
        state.t = t;
        for k in 0..state.q.len() {
            let (a, b) = (&self.from, &self.to);
            let (slope, bend) = (h * a.qd[k], 0.5 * h * h * a.qdd[k]);
            let value = b.q[k] - a.q[k] - slope - bend;
            let first = h * b.qd[k] - slope - 2.0 * bend;
            let second = 0.5 * h * h * b.qdd[k] - bend;
            let c = [
                a.q[k],
                slope,
                bend,
                10.0 * value - 4.0 * first + second,
                -15.0 * value + 7.0 * first - 2.0 * second,
                6.0 * value - 3.0 * first + second,
            ];
            let derivative = |order: usize| -> f64 {
                let factor = |j: usize| (j + 1 - order..=j).map(|i| i as f64).product::<f64>();
                (order..c.len()).rev().fold(0.0, |sum, j| sum * x + c[j] * factor(j))
            };
            state.q[k] = derivative(0);
            state.qd[k] = derivative(1) / h;
            state.qdd[k] = derivative(2) / (h * h);
            state.qddd[k] = (derivative(3) + third_beside(h, [a.qddd[k], b.qddd[k]], c, x)) / (h * h * h);
        }
        state
    }
}

/// Where something begins that is not at `low` and is at `high`.
fn boundary(mut low: f64, mut high: f64, mut is_beyond: impl FnMut(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if is_beyond(middle) { high = middle } else { low = middle }
    }
}

/// What the third derivative gains over that of a quintic, `c`, where it is known at both ends too: the quintic leaves only a
/// few digits of it. What is added is x³ (1 − x)³ (α + β x), which changes neither value, slope nor curvature there.
fn third_beside(h: f64, third: [f64; 2], c: [f64; 6], x: f64) -> f64 {
    let cube = h * h * h;
    let at_start = (cube * third[0] - 6.0 * c[3]) / 6.0;
    let at_end = -(cube * third[1] - 6.0 * c[3] - 24.0 * c[4] - 60.0 * c[5]) / 6.0;
    let constant = 6.0 - x * (72.0 - x * (180.0 - x * 120.0));
    let linear = x * (24.0 - x * (180.0 - x * (360.0 - x * 210.0)));
    at_start * constant + (at_end - at_start) * linear
}

impl Bridge {
    /// The same by a finer curve, if one has been found.
    pub fn best_state_at(&self, t: f64) -> State {
        let finer = self.finer.as_ref().or(self.narrow.as_ref());
        finer.map_or_else(|| self.state_at(t), |finer| finer.state_at(t))
    }
}

impl Motion {
    /// Keeps the state that was just accepted if it is clear of every singular position.
    pub fn keep_if_clear(&mut self) {
        if self.is_clear() {
            self.clear.copy_from(&self.state);
        }
    }

    /// Whether the position that was factored is clear of every singular one.
    pub fn is_clear(&mut self) -> bool {
        self.kinematics.linear().smallest_pivot() > 10.0 * CLEAR || self.kinematics.nearness(CLEAR) >= CLEAR
    }

    fn explain_bridge(&mut self, bridge: &Bridge, at: f64) -> Diagnostic {
        singular::explain_contact(&mut self.kinematics, &bridge.state_at(at), self.pass)
    }

    /// What there is to do where no further step can be made: goes on beyond a bifurcation if that is wanted.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn pass_or_explain(&mut self, fault: Fault, h: f64, target: f64) -> Result<(), Box<Diagnostic>> {
        let is_singular = matches!(fault, Fault::Singular | Fault::TooFar | Fault::Watch { .. });
        self.fold = None;
        let bridge = if is_singular { self.bridge_ahead() } else { None };
        let Some(bridge) = bridge else {
            return Err(Box::new(singular::explain_fold(
                &mut self.kinematics,
                &self.state,
                fault,
                [h, target],
                self.fold,
            )));
        };
        if !self.pass {
            let diagnostic = self.explain_bridge(&bridge, bridge.at);
            // rows before the singular position may lie on it
            self.bridge = Some(bridge);
            return Err(Box::new(diagnostic));
        }
        for at in [Some(bridge.at), bridge.again].into_iter().flatten() {
            // what comes behind the last row is not passed
            if at <= self.last + CERTAIN * (bridge.to.t - bridge.from.t) {
                let diagnostic = self.explain_bridge(&bridge, at);
                self.remarks.push(diagnostic);
            }
        }
        self.state.copy_from(&bridge.to);
        self.clear.copy_from(&bridge.to);
        self.kinematics.restore(&self.state);
        self.begin_determinants();
        self.kinematics.sides(&mut self.sides);
        self.h = (bridge.to.t - bridge.from.t).min(self.span);
        self.bridge = Some(bridge);
        Ok(())
    }

    /// A way over the singular position that the steps have come up to, if the motion goes on there. One that begins beside it
    /// is looked at from before its start.
    fn bridge_ahead(&mut self) -> Option<Bridge> {
        let bridge = self.bridge_from_clear();
        if bridge.is_none() && self.fold.is_none() && self.go_before_start() {
            return self.bridge_from_clear();
        }
        bridge
    }

    /// Looks for a clear state before the first time, if the motion is not clear of singular positions there; says whether there
    /// is one.
    fn go_before_start(&mut self) -> bool {
        self.kinematics.restore(&self.clear);
        let mut state = self.clear.clone();
        // of the start only the position has been kept
        let is_start = state.qd.iter().all(|speed| *speed == 0.0);
        if !is_start || self.kinematics.derivatives(&mut state).is_err() {
            return false;
        }
        if self.is_clear() {
            self.clear = state;
            return true;
        }
        for _ in 0..STEPS_BACK {
            // the other branch is no farther than twice that
            let way = self.kinematics.nearness(STEP_BACK).min(STEP_BACK);
            let linear = self.kinematics.linear();
            let (speed, bend) = (linear.largest(&state.qd), linear.largest(&state.qdd));
            let h = f64::min(way / speed, (way / bend).sqrt());
            self.trial.t = state.t - h;
            for k in 0..state.q.len() {
                self.trial.q[k] = state.q[k] - h * (state.qd[k] - 0.5 * h * state.qdd[k]);
            }
            let is_found = self.correct().is_ok()
                && self.same_branch().is_ok()
                && self.kinematics.derivatives(&mut self.trial).is_ok();
            if !is_found {
                return false;
            }
            state.copy_from(&self.trial);
            if self.is_clear() {
                self.clear = state;
                return true;
            }
        }
        false
    }

    /// A state beyond the singular position, to which the prediction from the last clear one leads.
    fn bridge_from_clear(&mut self) -> Option<Bridge> {
        self.kinematics.restore(&self.state);
        // without a line of centres there is nothing beyond
        if self.state.t <= self.clear.t || singular::centers_that_meet(&self.kinematics).is_some() {
            return None;
        }
        self.come_closer();
        let (near, way) = (self.state.t, self.state.t - self.clear.t);
        for part in BEYOND {
            let bridge = self.bridge_to(near + part * way);
            // what is beyond the end of its reach is not come to by going further
            if bridge.is_some() || self.fold.is_some() {
                return bridge;
            }
        }
        None
    }

    /// Brings the clear state as near to the singular position as it may be: the shorter the bridge, the better its middle.
    fn come_closer(&mut self) {
        let way = self.state.t - self.clear.t;
        self.kinematics.restore(&self.clear);
        let enough = way * CLEAR / self.kinematics.nearness(1.0);
        if enough >= way {
            return;
        }
        let h = way - enough;
        self.trial.t = self.clear.t + h;
        for k in 0..self.trial.q.len() {
            self.trial.q[k] = self.clear.q[k] + h * (self.clear.qd[k] + 0.5 * h * self.clear.qdd[k]);
        }
        if self.correct().is_ok() && self.kinematics.derivatives(&mut self.trial).is_ok() {
            self.clear.copy_from(&self.trial);
        }
    }

    fn bridge_to(&mut self, t: f64) -> Option<Bridge> {
        let h = t - self.clear.t;
        self.trial.t = t;
        let mut way: f64 = 0.0;
        for k in 0..self.trial.q.len() {
            let (first, second) = (h * self.clear.qd[k], 0.5 * h * h * self.clear.qdd[k]);
            self.trial.q[k] = self.clear.q[k] + first + second;
            // a motion that turns back has a way too
            way = way.max((first.abs() + second.abs()) / self.kinematics.linear().column_scale(k));
        }
        let correction = self.correct().ok()?;
        self.kinematics.derivatives(&mut self.trial).ok()?;
        let is_clear = self.kinematics.nearness(CLEAR) >= 0.3 * CLEAR;
        let mut bridge = Bridge::new(&self.clear, &self.trial);
        if correction > LARGEST_CORRECTION * way || !is_clear || !self.holds(&bridge, LARGEST_BETWEEN * way) {
            return None;
        }
        bridge.at = self.singular_time(&bridge);
        if let Some(fold) = self.end_of_reach(&bridge) {
            self.fold = Some(fold);
            return None;
        }
        self.settle_times(&mut bridge);
        Some(bridge)
    }

    /// Whether the curve over a bridge leaves corrections of at most `limit`, scaled, with the factors of its end.
    fn holds(&mut self, bridge: &Bridge, limit: f64) -> bool {
        PLACES.into_iter().all(|place| {
            let state = bridge.state_at(bridge.from.t + place * (bridge.to.t - bridge.from.t));
            self.kinematics.set_time(state.t);
            self.kinematics.set_position(&state.q).is_ok() && self.kinematics.correction(&mut self.delta) <= limit
        })
    }

    /// When the singular position is reached: where a determinant changes its sign, or else where it comes nearest to zero.
    fn singular_time(&mut self, bridge: &Bridge) -> f64 {
        let (mut low, mut high) = (bridge.from.t, bridge.to.t);
        self.set(&bridge.to);
        let is_beyond = |motion: &Self, k: usize| {
            motion.kinematics.linear().determinant(k).is_positive() != motion.determinants[k].is_positive()
        };
        let crossing = (0..self.determinants.len()).find(|&k| is_beyond(self, k));
        if let Some(block) = crossing {
            return boundary(low, high, |t| {
                self.set(&bridge.state_at(t));
                is_beyond(self, block)
            });
        }
        let sigma = |motion: &mut Self, t: f64| {
            motion.set(&bridge.state_at(t));
            motion.kinematics.nearness(1.0)
        };
        let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_left, mut at_right) = (sigma(self, left), sigma(self, right));
        for _ in 0..LOOKS {
            if at_left < at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = sigma(self, left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = sigma(self, right);
            }
        }
        self.least_time(bridge, 0.5 * (low + high))
    }

    /// Puts the time of a bridge right by a finer curve, and looks whether a determinant that has one sign at both ends has the
    /// other one between: then the singular position is come to twice.
    fn settle_times(&mut self, bridge: &mut Bridge) {
        let units = [&bridge.from, &bridge.to].map(|end| {
            self.set(end);
            self.determinants_here()
        });
        // what a determinant is at a time, against that at the start of the bridge
        let part = |motion: &mut Self, bridge: &Bridge, block: usize, t: f64| {
            let unit = units[0][block];
            motion.set(&bridge.best_state_at(t));
            motion.kinematics.linear().determinant(block).beside(unit) / unit.beside(unit)
        };
        let (from, to) = (bridge.from.t, bridge.to.t);
        let changes = |k: &usize| units[0][*k].is_positive() != units[1][*k].is_positive();
        if let Some(block) = (0..units[0].len()).find(changes) {
            self.look_for_exact(bridge);
            let at = boundary(from, to, |t| part(self, bridge, block, t) < 0.0);
            if (at - bridge.at).abs() > CERTAIN * (to - from) {
                bridge.at = at;
            }
            return;
        }
        let places = (1..PLACES_BETWEEN).map(|k| from + (to - from) * k as f64 / PLACES_BETWEEN as f64);
        let places: Vec<f64> = std::iter::once(bridge.at).chain(places).collect();
        for block in 0..units[0].len() {
            let deepest = |motion: &mut Self, bridge: &Bridge| {
                let parts = places.iter().map(|&t| (part(motion, bridge, block, t), t));
                parts.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, bridge.at))
            };
            if deepest(self, bridge).0 > NEARLY_ZERO {
                continue;
            }
            self.look_for_exact(bridge);
            let (least, between) = deepest(self, bridge);
            if least < BEYOND_ZERO {
                bridge.at = boundary(from, between, |t| part(self, bridge, block, t) < 0.0);
                bridge.again = Some(boundary(between, to, |t| part(self, bridge, block, t) >= 0.0));
                return;
            }
        }
    }

    /// Looks for a curve over a bridge that is more exact than the quintic.
    fn look_for_exact(&mut self, bridge: &mut Bridge) {
        self.look_for_finer(bridge);
        self.look_for_narrow(bridge);
    }

    fn determinants_here(&mut self) -> Vec<Determinant> {
        let mut determinants = self.determinants.clone();
        self.kinematics.linear().determinants(&mut determinants);
        determinants
    }

    /// When the determinant that is least at about `t` has its minimum: its sign tells the sides of zero apart, so that it is
    /// smooth where singular values have an edge, and its slope vanishes there to more digits than it does.
    fn least_time(&mut self, bridge: &Bridge, t: f64) -> f64 {
        self.set(&bridge.state_at(t));
        let Some(block) = self.kinematics.linear().worst_block() else { return t };
        let unit = self.determinants[block];
        let mut value = |t: f64| {
            let state = bridge.state_at(t);
            self.trial.copy_from(&state);
            // the curve is not exact; at the singular position itself it is better than nothing
            if self.correct().is_err() {
                self.set(&state);
            }
            self.kinematics.linear().determinant(block).beside(unit)
        };
        let spread = SPREAD * (bridge.to.t - bridge.from.t);
        let mut at = t;
        for _ in 0..NEWTON_STEPS {
            let (mut slope, mut curvature) = (0.0, CURVATURE[0] * value(at));
            for k in 0..SLOPE.len() {
                let way = (k + 1) as f64 * spread;
                let (before, after) = (value(at - way), value(at + way));
                slope += SLOPE[k] * (after - before);
                curvature += CURVATURE[k + 1] * (after + before);
            }
            let step = spread * slope / curvature;
            at -= step;
            // it is that minimum, or none that this finds
            if at.is_nan() || (at - t).abs() > spread {
                return t;
            }
            if step.abs() <= f64::EPSILON * spread {
                break;
            }
        }
        at
    }

    /// Evaluates and factors at a state, which may be singular.
    fn set(&mut self, state: &State) {
        self.kinematics.restore(state);
    }

    /// The row of a time on a bridge, if it is on one; where the bridge is not passed, on its way up to the singular position.
    pub fn row_on_bridge(&mut self, t: f64) -> Option<Result<(), Box<Diagnostic>>> {
        let is_on = |bridge: &&Bridge| {
            let end = if self.pass { bridge.to.t } else { bridge.at - CERTAIN * (bridge.to.t - bridge.from.t) };
            t > bridge.from.t && t < end
        };
        let bridge = self.bridge.as_ref().filter(is_on)?;
        let state = bridge.state_at(t);
        if self.given_row(&state)
            || self.solved_row(&state, EXACT)
            || self.finer_row(t)
            || self.solved_row(&state, SOLVABLE)
        {
            return Some(Ok(()));
        }
        // it may be certain as it is found without the bridge
        if !self.pass {
            return None;
        }
        Some(Err(Box::new(errors::uncertain(self.kinematics.system(), &[], t))))
    }

    /// Writes the row of a time on a bridge whose curve is not exact enough, by solving from it, if it is at least so far from
    /// the singular position.
    fn solved_row(&mut self, state: &State, nearest: f64) -> bool {
        self.trial.copy_from(state);
        let is_solved = self.correct().is_ok()
            && self.kinematics.nearness(nearest) >= nearest
            && self.kinematics.derivatives(&mut self.trial).is_ok();
        if is_solved {
            self.kinematics.write_row(&self.trial, &mut self.row);
        }
        is_solved
    }

    /// Writes the row of a time on a long bridge by its finer curve, if that is exact there.
    fn finer_row(&mut self, t: f64) -> bool {
        let Some(mut bridge) = self.bridge.take() else {
            return false;
        };
        self.look_for_finer(&mut bridge);
        let state = bridge.finer.as_ref().map(|finer| finer.state_at(t));
        self.bridge = Some(bridge);
        let Some(state) = state else {
            return false;
        };
        self.given_row(&state)
    }

    fn look_for_finer(&mut self, bridge: &mut Bridge) {
        if !bridge.is_searched {
            (bridge.is_searched, bridge.finer) = (true, self.finer_curve(bridge));
        }
    }

    /// Looks for a curve over a shorter way, if there is none over the whole bridge that is exact: a motion that turns back beside
    /// the singular position is there for long.
    fn look_for_narrow(&mut self, bridge: &mut Bridge) {
        if bridge.finer.is_none() && !bridge.is_narrow_searched {
            bridge.is_narrow_searched = true;
            bridge.narrow = [EXACT, SOLVABLE].into_iter().find_map(|nearest| self.narrow_curve(bridge, nearest));
        }
    }

    /// A curve between the states that are so near to the singular position.
    fn narrow_curve(&mut self, bridge: &Bridge, nearest: f64) -> Option<Finer> {
        let mut is_near = |t: f64| {
            self.set(&bridge.state_at(t));
            self.kinematics.nearness(nearest) < nearest
        };
        let last = bridge.again.unwrap_or(bridge.at);
        let from = boundary(bridge.from.t, bridge.at, &mut is_near);
        let to = boundary(last, bridge.to.t, |t| !is_near(t));
        let [from, to] = [from, to].map(|t| self.solved_state(&bridge.state_at(t)));
        self.finer_curve(&Bridge::new(&from?, &to?))
    }

    fn solved_state(&mut self, state: &State) -> Option<State> {
        self.trial.copy_from(state);
        self.correct().ok()?;
        self.kinematics.derivatives(&mut self.trial).ok()?;
        Some(self.trial.clone())
    }

    /// Writes the row of a time on a bridge by a curve over a shorter way, if that is exact there.
    pub fn narrow_row(&mut self, t: f64) -> bool {
        let Some(mut bridge) = self.bridge.take() else {
            return false;
        };
        self.look_for_narrow(&mut bridge);
        let state = bridge.narrow.as_ref().map(|narrow| narrow.state_at(t));
        self.bridge = Some(bridge);
        state.is_some_and(|state| self.given_row(&state))
    }

    /// Writes the row of a state on a curve, if the equations hold there, and those of velocity and acceleration with them.
    fn given_row(&mut self, state: &State) -> bool {
        self.kinematics.restore(state);
        if self.kinematics.violated().is_some() {
            return false;
        }
        self.kinematics.write_given_row(state, &mut self.row);
        let linear = self.kinematics.linear();
        let (speed, bend) = (linear.largest(&state.qd), linear.largest(&state.qdd));
        let fastest = f64::max(SLOW * bend.max(speed * speed), 1.0);
        (0..state.q.len()).all(|row| {
            let (velocity, acceleration) = self.kinematics.left_open(row, state);
            velocity <= OPEN[0] * f64::max(SLOW * speed, 1.0) && acceleration <= OPEN[1] * fastest
        })
    }
}
