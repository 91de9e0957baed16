//! Boundaries of domains: times at which formulas of time reach the end of the domain of a function.

use super::error::Error;
use super::limits::{
    FEWEST_LOOKS, GROWTH, LEAD, MOMENT, MOST_HALVINGS, MOST_LOOKS, PASSED, ROUNDING, SLOW, SPEED_JUMP,
};
use super::neighbours::bisect;
use super::numbers::{Numbers, difference, larger, largest, predicted};
use super::reach::reach;
use super::solution::Solution;
use super::state::{State, Timed};
use super::work::{Work, of_reaching};

/// Largest number of evaluations for the search for `boundaries` boundaries and the check of one.
pub const fn most_work<M: Timed>(boundaries: usize) -> usize {
    2 + boundaries * (MOST_HALVINGS + 3) + 2 * MOST_LOOKS * of_reaching::<M>()
}

/// A mechanism whose formulas of time have domain boundaries.
pub trait BoundedDomain: Timed {
    /// Gauges of all boundaries, then their slopes.
    type Gauges: Numbers;

    /// Returns the gauges, which are zero where the domain of a formula of time may end, then their slopes.
    fn gauges(&self, t: f64) -> Self::Gauges;
}

/// Returns the first unchecked boundary in a step, with its time: where a gauge changes its sign, or touches zero.
pub fn first_boundary<M: BoundedDomain>(
    m: &M,
    from: f64,
    to: f64,
    passed: &M::Passed,
    work: &mut Work,
) -> Option<(usize, f64)> {
    work.add(2);
    let (first, last) = (m.gauges(from), m.gauges(to));
    let boundaries = passed.as_ref().len();
    let ends = first.as_ref().iter().zip(last.as_ref());
    let (gauges, slopes) = (ends.clone().take(boundaries), ends.skip(boundaries));
    let mut found = None;
    for ((boundary, passed), ((a, b), slopes)) in passed.as_ref().iter().enumerate().zip(gauges.zip(slopes)) {
        let sign = 1.0_f64.copysign(*a);
        // 1 if a positive slope leads the gauge away from zero in the direction of the step, else −1
        let rising = (sign * (to - from)).signum();
        let is_crossed = sign * b < 0.0;
        let comes_and_goes = rising * slopes.0 < 0.0 && rising * slopes.1 > 0.0;
        if !is_crossed && !comes_and_goes {
            continue;
        }
        let is_before = |t: f64| {
            let (value, slope) = gauge(boundary, t, m, work);
            if is_crossed { sign * value > 0.0 } else { rising * slope < 0.0 }
        };
        let [_, at] = bisect([from, to], MOST_HALVINGS, is_before);
        let is_new = (at - passed).abs() > PASSED * M::SPAN;
        let is_first = found.is_none_or(|(_, known): (usize, f64)| (at - known) * (to - from) < 0.0);
        if is_new && is_first && is_zero(boundary, at, m, work) {
            found = Some((boundary, at));
        }
    }
    found
}

/// Returns the gauge of a boundary and its slope.
fn gauge<M: BoundedDomain>(boundary: usize, t: f64, m: &M, work: &mut Work) -> (f64, f64) {
    work.add(1);
    let all = m.gauges(t);
    let all = all.as_ref();
    let of = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
    (of(boundary), of(boundary + all.len() / 2))
}

/// Returns whether a gauge is zero at a time, within rounding.
fn is_zero<M: BoundedDomain>(boundary: usize, t: f64, m: &M, work: &mut Work) -> bool {
    let moment = MOMENT * f64::EPSILON * t.abs() + f64::MIN_POSITIVE;
    let (here, _) = gauge(boundary, t, m, work);
    let mut changes = |t: f64| {
        let ratio = gauge(boundary, t, m, work).0 / here;
        let is_alike = ratio > 0.5 && ratio < 2.0;
        !is_alike
    };
    here.abs() <= ROUNDING * f64::EPSILON || changes(t - moment) || changes(t + moment)
}

/// Record of probes on both sides of a boundary, from far to near.
struct Probes {
    count: usize,
    /// Number of probes that show a jump.
    jumps: usize,
    /// Numbers of probes in which velocities and accelerations have grown.
    growths: [usize; 2],
    /// Largest velocity of the last probe, scaled; infinite before the first.
    last_speed: f64,
    /// Largest acceleration of the last probe, scaled; infinite before the first.
    last_acceleration: f64,
    /// Deviation of the first probe from a smooth motion, scaled.
    widest: f64,
    /// Deviation of the last probe from a smooth motion, scaled.
    rest: f64,
}

impl Probes {
    /// Adds a probe at a distance on both sides.
    fn add<M: Timed>(&mut self, before: &Solution<M>, after: &Solution<M>, distance: f64) {
        let scales = M::scales();
        let speed = larger(largest(&before.qd, scales), largest(&after.qd, scales));
        let force = larger(largest(&before.qdd, scales), largest(&after.qdd, scales));
        let (mut change_of_q, mut change) = (difference(&after.q, &before.q), difference(&after.qd, &before.qd));
        let rates = before.qd.as_ref().iter().zip(after.qd.as_ref());
        let bends = before.qdd.as_ref().iter().zip(after.qdd.as_ref());
        let parts = change_of_q.as_mut().iter_mut().zip(change.as_mut());
        for ((change_of_q, change), ((v, w), (a, b))) in parts.zip(rates.zip(bends)) {
            let bend = distance * distance * (b - a) / 3.0;
            *change_of_q = *change_of_q - distance * (v + w) + bend;
            *change -= distance * (a + b);
        }
        self.rest = larger(largest(&change, scales), largest(&change_of_q, scales) / M::SPAN);
        if self.count == 0 {
            self.widest = self.rest;
        }
        self.jumps += usize::from(self.rest > SPEED_JUMP * larger(speed, SLOW / M::SPAN));
        let [of_speed, of_force] = &mut self.growths;
        *of_speed += usize::from(speed > GROWTH * self.last_speed);
        *of_force += usize::from(force > GROWTH * self.last_acceleration);
        (self.last_speed, self.last_acceleration) = (speed, force);
        self.count += 1;
    }

    /// Checks that the motion continues smoothly.
    fn verdict<M: Timed>(&self) -> Result<(), Error> {
        let [of_speed, of_force] = self.growths;
        let is_seen = self.count >= FEWEST_LOOKS;
        if is_seen && of_speed + 1 == self.count && self.last_speed > SLOW / M::SPAN {
            return Err(Error::NotANumber);
        }
        if is_seen && self.jumps == self.count && self.rest > 0.5 * self.widest {
            return Err(Error::NotSmooth);
        }
        if is_seen && self.count == MOST_LOOKS && of_force + 1 == self.count {
            return Err(Error::NotANumber);
        }
        Ok(())
    }
}

/// Probes at both sides of a boundary, next to the state: whether the motion goes on smoothly.
pub fn check_boundary<M: Timed>(state: &mut State<M>, boundary: usize, t: f64, work: &mut Work) -> Result<(), Error> {
    if let Some(passed) = state.passed.as_mut().get_mut(boundary) {
        *passed = t;
    }
    let (mut before, mut after) = (*state.at(), *state.at());
    let (mut at, mut distance) = (Solution::ZERO, LEAD * M::SPAN);
    let mut probes = Probes {
        count: 0,
        jumps: 0,
        growths: [0, 0],
        last_speed: f64::INFINITY,
        last_acceleration: f64::INFINITY,
        widest: 0.0,
        rest: 0.0,
    };
    for _ in 0..MOST_LOOKS {
        let found = probe(t - distance, &before, &state.model, &mut at, work);
        if found {
            before.clone_from(&at);
            if probes.count == 0 {
                after.clone_from(&at);
            }
        }
        if found && probe(t + distance, &after, &state.model, &mut at, work) {
            after.clone_from(&at);
            probes.add(&before, &after, distance);
        }
        distance *= 0.25;
    }
    probes.verdict::<M>()
}

/// Solves at a time close to a solution. Returns whether that succeeded.
fn probe<M: Timed>(t: f64, near: &Solution<M>, m: &M, at: &mut Solution<M>, work: &mut Work) -> bool {
    let tears = [&near.q, &near.qd, &near.qdd].map(M::tears);
    let guess = predicted(&tears[0], &tears[1], &tears[2], t - near.t);
    reach(&guess, near, t, m, at, work).is_ok()
}
