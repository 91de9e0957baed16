//! Limits from both sides of position, velocity and acceleration at a time at which a formula may have none.
//!
//! States are taken at equal distances before and after it, ever nearer. The differences that a smooth motion has over such a distance are
//! subtracted, so that the rest vanishes with a higher power of the distance. A rest that stays at all distances is a jump; one that grows
//! without bound as the distance vanishes is not finite there.

use crate::analysis::state::State;
use crate::limits::domain_boundaries::GROWTH;
use crate::limits::jumps::{ACCELERATION_JUMP, POSITION_JUMP, REST, VELOCITY_JUMP};
use mechc_ir::{ConstraintSystem, CoordinateKind};

/// Number of distances that are examined.
const MOST: usize = 16;
/// Number of distances with resolved values that a decision requires.
const FEWEST: usize = 3;
/// Smallest distance, in units in the last place of the time.
const NEAREST: f64 = 64.0;
/// Error of the time of an edge that is hidden by rounding, as a part of the span.
const MISPLACED: f64 = 1e-8;
/// Amplification of rounding in computed values.
const UNCERTAIN: f64 = 64.0;
/// A change of acceleration is significant if rounding is at most this part of it.
const EXACT: f64 = 0.1;

/// Comparison of the two sides.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Verdict {
    /// The motion goes on.
    Smooth,
    Acceleration,
    Velocity {
        column: usize,
    },
    /// A coordinate that would have to change by so much [m, rad].
    Position {
        column: usize,
        by: f64,
    },
    /// A contact finds no tangent on the other side.
    Corner,
    /// A velocity or acceleration grows without bound.
    NotFinite,
}

/// Differences between the states of a pair.
#[derive(Clone, Copy)]
struct Pair {
    /// Remainder of each difference in units of what is allowed, and the coordinate where it is largest.
    position: f64,
    position_column: usize,
    velocity: f64,
    velocity_column: usize,
    acceleration: f64,
    /// Remainders of position and velocity, scaled.
    rests: [f64; 2],
    /// True if rounding is small enough for the acceleration to be judged.
    is_exact: bool,
    /// The largest velocity and acceleration, scaled.
    fastest: f64,
    hardest: f64,
    /// Rounding error of the acceleration.
    noise: f64,
}

/// Largest correction that the equations require beyond a time that has a state before it and none after it.
#[derive(Clone, Copy)]
pub(super) struct Gap {
    /// The correction, scaled.
    pub size: f64,
    pub column: usize,
    /// The correction of the coordinate [m, rad].
    pub by: f64,
}

/// Pairs of states, from far to near.
pub(super) struct OneSidedLimits {
    before: State,
    after: State,
    pairs: [Option<Pair>; MOST],
    count: usize,
    /// Numbers of states found before the time, and after it.
    found: [usize; 2],
    /// Sizes of the gaps, by distance.
    gaps: [Option<f64>; MOST],
    /// The last gap.
    last_gap: Gap,
    bodies: Vec<bool>,
    span: f64,
}

impl OneSidedLimits {
    pub fn new(state: &State) -> OneSidedLimits {
        OneSidedLimits {
            before: state.clone(),
            after: state.clone(),
            pairs: [None; MOST],
            count: 0,
            found: [0; 2],
            gaps: [None; MOST],
            last_gap: Gap { size: 0.0, column: 0, by: 0.0 },
            bodies: vec![true; state.q.len()],
            span: 1.0,
        }
    }

    pub fn begin(&mut self, system: &ConstraintSystem, span: f64) {
        for (is_of_body, coordinate) in self.bodies.iter_mut().zip(system.coordinates()) {
            // only bodies count: a contact may move along its curve at any speed
            *is_of_body = coordinate.kind != CoordinateKind::Argument;
        }
        (self.pairs, self.gaps) = ([None; MOST], [None; MOST]);
        (self.count, self.found, self.span) = (0, [0; 2], span);
    }

    /// Returns the nearest states before and after the time.
    pub fn sides(&self) -> [&State; 2] {
        [&self.before, &self.after]
    }

    /// Takes the state at a distance before the time.
    pub fn take_before(&mut self, state: &State) {
        self.before.copy_from(state);
    }

    /// Takes the state at a distance after it.
    pub fn take_after(&mut self, state: &State) {
        self.after.copy_from(state);
    }

    /// Returns whether states at a distance (s) from a time are still needed.
    pub fn needs_nearer(&self, distance: f64, t: f64) -> bool {
        self.count < MOST && distance > NEAREST * f64::EPSILON * t.abs()
    }

    /// Takes the states `before` and `after`, where there are any, with the rounding of the formula in each.
    pub fn take(&mut self, distance: f64, rounding: [Option<f64>; 2], scale: impl Fn(usize) -> f64) {
        for (found, rounding) in self.found.iter_mut().zip(rounding) {
            *found += usize::from(rounding.is_some());
        }
        if let [Some(a), Some(b)] = rounding {
            self.pairs[self.count] = Some(self.pair(distance, a.max(b), scale));
        }
        self.count += 1;
    }

    /// Returns the state next to which another one before the time is sought, or one after it; `None` if none has been found yet.
    pub fn nearest(&self, is_after: bool) -> Option<&State> {
        let has_state = |side: usize| self.found[side] > 0;
        match (is_after && has_state(1), has_state(0)) {
            (true, _) => Some(&self.after),
            (false, true) => Some(&self.before),
            (false, false) => None,
        }
    }

    /// Records a gap.
    pub fn take_gap(&mut self, gap: Gap) {
        self.gaps[self.count] = Some(gap.size);
        self.last_gap = gap;
    }

    fn pair(&self, d: f64, rounding: f64, scale: impl Fn(usize) -> f64) -> Pair {
        let (a, b) = (&self.before, &self.after);
        let n = a.q.len();
        let largest =
            |x: &[f64], y: &[f64]| (0..n).map(|k| f64::max(x[k].abs(), y[k].abs()) / scale(k)).fold(0.0, f64::max);
        let (fastest, hardest) = (largest(&a.qd, &b.qd), largest(&a.qdd, &b.qdd));
        let wide = |f: &dyn Fn(usize) -> f64, counts: &dyn Fn(usize) -> bool| {
            let rests = (0..n).filter(|&k| counts(k)).map(|k| (f(k).abs() / scale(k), k));
            rests.fold((0.0, 0), |best, one| if one.0 > best.0 { one } else { best })
        };
        let bend = |k: usize| d * d * (b.qdd[k] - a.qdd[k]) / 3.0;
        let place = |k: usize| b.q[k] - a.q[k] - d * (a.qd[k] + b.qd[k]) + bend(k);
        let speed = |k: usize| b.qd[k] - a.qd[k] - d * (a.qdd[k] + b.qdd[k]);
        let (position, position_column) = wide(&place, &|_| true);
        let (velocity, velocity_column) = wide(&speed, &|k| self.bodies[k]);
        let (acceleration, _) = wide(&|k| b.qdd[k] - a.qdd[k], &|k| self.bodies[k]);
        let allowed = [
            POSITION_JUMP + UNCERTAIN * rounding * d * fastest + MISPLACED * self.span * velocity,
            VELOCITY_JUMP.max(UNCERTAIN * rounding) * fastest.max(REST / self.span),
            ACCELERATION_JUMP * hardest.max(REST * fastest.max(REST / self.span) / self.span),
        ];
        let noise = UNCERTAIN * rounding * fastest / d;
        Pair {
            position: position / allowed[0],
            position_column,
            velocity: velocity / allowed[1],
            velocity_column,
            rests: [position, velocity],
            acceleration: acceleration / allowed[2].max(noise),
            is_exact: noise <= allowed[2] || noise <= EXACT * acceleration,
            fastest,
            hardest,
            noise,
        }
    }

    fn pairs(&self) -> impl DoubleEndedIterator<Item = &Pair> + Clone {
        self.pairs.iter().flatten()
    }

    /// Returns how the two sides compare; `has_tangent` is true if a contact may have come to a corner.
    pub fn verdict(&self, has_tangent: bool) -> Verdict {
        if self.pairs().count() < FEWEST {
            let [before, after] = self.found;
            if before < FEWEST || after > 0 {
                return Verdict::Smooth;
            }
            let gaps = self.gaps.iter().flatten().copied();
            return if has_tangent {
                Verdict::Corner
            } else if grows(gaps.clone()) || shrinks(gaps.clone()) {
                Verdict::NotFinite
            } else if gaps.clone().count() >= FEWEST && gaps.into_iter().all(|gap| gap > POSITION_JUMP) {
                let Gap { column, by, .. } = self.last_gap;
                Verdict::Position { column, by }
            } else {
                Verdict::Smooth
            };
        }
        let stays = |size: fn(&Pair) -> f64, order: usize| {
            self.pairs().all(|pair| size(pair) > 1.0) && !shrinks(self.pairs().map(|pair| pair.rests[order]))
        };
        let all_grow = |size: fn(&Pair) -> f64| grows(self.pairs().map(size));
        let Some(nearest) = self.pairs().next_back() else {
            return Verdict::Smooth;
        };
        if all_grow(|pair| pair.fastest) && nearest.fastest > REST / self.span {
            Verdict::NotFinite
        } else if stays(|pair| pair.position, 0) {
            let column = nearest.position_column;
            Verdict::Position { column, by: self.after.q[column] - self.before.q[column] }
        } else if stays(|pair| pair.velocity, 1) {
            Verdict::Velocity { column: nearest.velocity_column }
        } else if all_grow(|pair| if pair.hardest > pair.noise { pair.hardest } else { 0.0 }) {
            Verdict::NotFinite
        } else if self.pairs().filter(|pair| pair.is_exact).count() >= FEWEST
            && self.pairs().filter(|pair| pair.is_exact).all(|pair| pair.acceleration > 1.0)
        {
            Verdict::Acceleration
        } else {
            Verdict::Smooth
        }
    }
}

/// Returns whether sizes, from far to near, grow steadily at the end.
fn grows(sizes: impl DoubleEndedIterator<Item = f64> + Clone) -> bool {
    let mut last = f64::INFINITY;
    let nearest = sizes.rev().take(FEWEST + 2);
    nearest.clone().count() == FEWEST + 2
        && nearest.into_iter().all(|size| {
            let is_less = size * GROWTH <= last && size > 0.0;
            last = size;
            is_less
        })
}

/// Returns whether sizes, from far to near, become smaller steadily at the end.
fn shrinks(sizes: impl DoubleEndedIterator<Item = f64> + Clone) -> bool {
    let mut last = 0.0;
    let nearest = sizes.rev().take(FEWEST + 2);
    nearest.clone().count() == FEWEST + 2
        && nearest.into_iter().all(|size| {
            let is_more = size >= last * GROWTH;
            last = size;
            is_more
        })
}
