//! The states of all lanes at a time, and the acceptance test of a step from one to the next: the new state must be on the same branch.

// loops over lane indices read best, and vectorise best
#![allow(clippy::needless_range_loop)]

use super::{CHUNK, LANES, NEAREST, PART_OF_DISTANCE, PerLane, ZERO};
use crate::solver::VariantLanes;
use mechc_expr::math::max;
use mechc_ir::program::LaneValues;

/// Largest motion in a step, scaled.
const LARGEST_MOTION: f64 = 0.5;
/// Largest deviation of velocities and accelerations at both ends of a step from the change of positions, scaled.
const LARGEST_GAP: f64 = 1e-3;
/// Largest factor by which a determinant changes in a step.
const LARGEST_CHANGE: f64 = 2.0;

/// The states of all lanes at one time.
#[derive(Clone)]
pub(super) struct LaneStates {
    /// The time (s).
    pub t: f64,
    /// By tracked coordinate: value, velocity, and acceleration where [`TrackedDerivatives`] includes it.
    pub tracked: Vec<[PerLane; 3]>,
    /// The values whose signs distinguish branches: inverse determinants of blocks, and monitors.
    pub branch_values: Vec<PerLane>,
    /// The distance to a singular position: an estimate of the smallest singular value of the scaled `Φ_q`.
    pub singular_distance: PerLane,
}

/// The derivatives of tracked coordinates that steps compute, compare and extrapolate from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum TrackedDerivatives {
    /// Positions and velocities, enough for states that are close to each other.
    Velocities,
    /// Positions, velocities and accelerations.
    Accelerations,
}

impl TrackedDerivatives {
    /// Returns the count of numbers for each coordinate, its value included.
    pub const fn orders(self) -> usize {
        match self {
            TrackedDerivatives::Velocities => 2,
            TrackedDerivatives::Accelerations => 3,
        }
    }
}

/// A coordinate that the acceptance test compares.
pub(super) struct TrackedCoordinate {
    /// Its columns in a row: value, velocity, acceleration.
    pub columns: [u32; 3],
    /// The inverse of its scale (1/m, or 1/rad).
    pub per_scale: f64,
}

/// Returns the estimated distance to a singular position, from the largest inverse pivot. `pivot_scale` converts a smallest pivot into a
/// singular value.
#[inline]
pub(super) fn singular_distance(pivot_scale: f64, max_inverse_pivot: f64) -> f64 {
    pivot_scale / if max_inverse_pivot > 1.0 { max_inverse_pivot } else { 1.0 }
}

/// By lane, the count of failed checks; a lane with 0 is accepted.
pub(super) struct Rejections(pub PerLane);

impl Rejections {
    /// Returns the rejected lanes, mostly none.
    pub fn lanes(&self) -> impl Iterator<Item = usize> {
        // one test for all lanes first
        let is_any = self.0.0.iter().fold(0, |any, count| any | count.to_bits()) != 0;
        (0..if is_any { LANES } else { 0 }).filter(|&k| self.0.0[k] != 0.0)
    }
}

impl LaneStates {
    /// Creates equal states for all lanes, at rest.
    pub fn at_rest(t: f64, q: &[f64], branch_values: &[f64], singular_distance: f64) -> LaneStates {
        LaneStates {
            t,
            tracked: q.iter().map(|&q| [LaneValues([q; LANES]), ZERO, ZERO]).collect(),
            branch_values: branch_values.iter().map(|&inverse| LaneValues([inverse; LANES])).collect(),
            singular_distance: LaneValues([singular_distance; LANES]),
        }
    }

    /// Copies the solution at a time (s).
    #[inline(always)]
    #[allow(clippy::inline_always)] // compiled for several vector instruction sets
    pub fn record(
        &mut self,
        tracked: &[TrackedCoordinate],
        derivatives: TrackedDerivatives,
        pivot_scale: f64,
        t: f64,
        solution: &VariantLanes<LANES>,
    ) {
        self.t = t;
        for (state, coordinate) in self.tracked.iter_mut().zip(tracked) {
            for (to, &column) in state.iter_mut().zip(&coordinate.columns[..derivatives.orders()]) {
                *to = *solution.column(column);
            }
        }
        self.branch_values.copy_from_slice(solution.branch_values());
        for chunk in 0..LANES / CHUNK {
            let mut distance = *solution.max_inverse_pivots().part::<CHUNK>(chunk);
            for k in 0..CHUNK {
                distance[k] = singular_distance(pivot_scale, distance[k]);
            }
            *self.singular_distance.part_mut(chunk) = distance;
        }
    }

    /// Copies the state of one lane.
    pub fn copy_lane(&mut self, from: &LaneStates, lane: usize) {
        for (to, from) in self.tracked.iter_mut().zip(&from.tracked) {
            to[0].0[lane] = from[0].0[lane];
        }
        for (to, from) in self.branch_values.iter_mut().zip(&from.branch_values) {
            to.0[lane] = from.0[lane];
        }
        self.singular_distance.0[lane] = from.singular_distance.0[lane];
    }
}

/// Counts the checks that fail for a step between two states, of length `h` (s), or of a continuation at constant time if that is `None`.
///
/// A step is accepted if both ends are far from singular positions, and farther than the motion between them; the first correction is small
/// compared with that distance, since other branches are farther away; no determinant changes its sign, or its size by much; and the
/// velocities of both ends, with accelerations where they are tracked, integrate to the change of position.
#[inline(always)]
#[allow(clippy::inline_always)] // compiled for several vector instruction sets
pub(super) fn check_step(
    tracked: &[TrackedCoordinate],
    derivatives: TrackedDerivatives,
    [now, next]: [&LaneStates; 2],
    h: Option<f64>,
    first_corrections: &PerLane,
    rejections: &mut Rejections,
) {
    for chunk in 0..LANES / CHUNK {
        let (mut motion, mut gap) = ([0.0; CHUNK], [0.0; CHUNK]);
        for ((now, next), coordinate) in now.tracked.iter().zip(&next.tracked).zip(tracked) {
            let [[x, v, a], [y, w, b]] =
                [now, next].map(|state| state.each_ref().map(|values| values.part::<CHUNK>(chunk)));
            for k in 0..CHUNK {
                motion[k] = max(motion[k], (y[k] - x[k]).abs() * coordinate.per_scale);
            }
            let mut increment = [0.0; CHUNK];
            match (h, derivatives) {
                (None, _) => continue,
                (Some(h), TrackedDerivatives::Velocities) => {
                    for k in 0..CHUNK {
                        increment[k] = 0.5 * h * (v[k] + w[k]);
                    }
                }
                (Some(h), TrackedDerivatives::Accelerations) => {
                    let (half, twelfth) = (0.5 * h, h * h * (1.0 / 12.0));
                    for k in 0..CHUNK {
                        increment[k] = half * (v[k] + w[k]) + twelfth * (a[k] - b[k]);
                    }
                }
            }
            for k in 0..CHUNK {
                gap[k] = max(gap[k], (y[k] - x[k] - increment[k]).abs() * coordinate.per_scale);
            }
        }
        let from = *now.singular_distance.part::<CHUNK>(chunk);
        let to = *next.singular_distance.part::<CHUNK>(chunk);
        let (corrections, mut counts) = (*first_corrections.part::<CHUNK>(chunk), *rejections.0.part::<CHUNK>(chunk));
        for k in 0..CHUNK {
            let (least, most) = if from[k] < to[k] { (from[k], to[k]) } else { (to[k], from[k]) };
            // no check is skipped, so that all lanes do the same
            let (is_far, is_near_guess) = (least >= NEAREST, corrections[k] <= PART_OF_DISTANCE * least);
            let (is_short, is_inside) = (motion[k] <= LARGEST_MOTION, motion[k] <= most);
            let is_consistent = gap[k] <= LARGEST_GAP;
            counts[k] += if is_far & is_near_guess & is_short & is_inside & is_consistent { 0.0 } else { 1.0 };
        }
        *rejections.0.part_mut(chunk) = counts;
    }
    for (now, next) in now.branch_values.iter().zip(&next.branch_values) {
        for chunk in 0..LANES / CHUNK {
            let (from, to) = (*now.part::<CHUNK>(chunk), *next.part::<CHUNK>(chunk));
            let mut counts = *rejections.0.part::<CHUNK>(chunk);
            for k in 0..CHUNK {
                // equal signs, and neither is larger than the other by more than a factor
                let (product, a, b) = (from[k] * to[k], from[k].abs(), to[k].abs());
                let is_similar = product > 0.0 && a <= LARGEST_CHANGE * b && b <= LARGEST_CHANGE * a;
                counts[k] += if is_similar { 0.0 } else { 1.0 };
            }
            *rejections.0.part_mut(chunk) = counts;
        }
    }
}
