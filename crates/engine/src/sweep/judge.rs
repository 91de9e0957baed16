//! Where variants stand side by side, and whether the next place of each is beyond doubt on the branch that it is on.

// what is done in every lane reads best, and vectorises best, with the lane's number
#![allow(clippy::needless_range_loop)]

use super::each::{Each, LANES, PART, ZERO};
use crate::solver::Abreast;
use mechc_expr::math::max;
use mechc_ir::program::LaneValues;
use mechc_ir::tolerances::solving::variants::{LARGEST_CHANGE, LARGEST_GAP, LARGEST_MOTION, NEAREST, PART_OF_DISTANCE};

/// Where variants stand.
#[derive(Clone)]
pub(super) struct Stand {
    pub t: f64,
    /// By coordinate that steps are judged by: value, velocity, and acceleration where that is known.
    pub tracked: Vec<[Each; 3]>,
    /// By turn of the solver: one over the determinant.
    pub determinants: Vec<Each>,
    /// How near to a singular position that is.
    pub nearness: Each,
}

/// What is known of each place that steps lead to, by which they are judged, and from which they lead on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Known {
    /// Positions and velocities, which are enough where places are near to each other.
    Velocities,
    /// Accelerations too.
    Accelerations,
}

impl Known {
    /// How many numbers of each coordinate.
    pub const fn orders(self) -> usize {
        match self {
            Known::Velocities => 2,
            Known::Accelerations => 3,
        }
    }
}

/// A coordinate that steps are judged by.
pub(super) struct Tracked {
    /// Its columns in a row: value, velocity, acceleration.
    pub columns: [u32; 3],
    /// One over what a change of it is judged against.
    pub per_scale: f64,
}

/// How near to a singular position it is, as far as pivots tell, of which one over the smallest is this; `unit` is what makes that a
/// singular value.
#[inline]
pub(super) fn nearness(unit: f64, steepest: f64) -> f64 {
    unit / if steepest > 1.0 { steepest } else { 1.0 }
}

/// By variant: how much is in doubt; nothing where it is 0.
pub(super) struct Doubts(pub Each);

impl Doubts {
    /// The lanes in which there are some: mostly none.
    pub fn lanes(&self) -> impl Iterator<Item = usize> {
        // all are looked at together first
        let is_any = self.0.0.iter().fold(0, |any, doubts| any | doubts.to_bits()) != 0;
        (0..if is_any { LANES } else { 0 }).filter(|&k| self.0.0[k] != 0.0)
    }
}

impl Stand {
    /// All at one place, at rest.
    pub fn of(t: f64, q: &[f64], determinants: &[f64], nearness: f64) -> Stand {
        Stand {
            t,
            tracked: q.iter().map(|&q| [LaneValues([q; LANES]), ZERO, ZERO]).collect(),
            determinants: determinants.iter().map(|&of| LaneValues([of; LANES])).collect(),
            nearness: LaneValues([nearness; LANES]),
        }
    }

    /// Takes over what was solved for.
    #[inline(always)]
    #[allow(clippy::inline_always)] // it is compiled for several kinds of processors
    pub fn take(&mut self, (tracked, known): (&[Tracked], Known), unit: f64, t: f64, from: &Abreast<LANES>) {
        self.t = t;
        for (own, of) in self.tracked.iter_mut().zip(tracked) {
            for (to, &column) in own.iter_mut().zip(&of.columns[..known.orders()]) {
                *to = *from.column(column);
            }
        }
        self.determinants.copy_from_slice(from.determinants());
        for part in 0..LANES / PART {
            let mut near = *from.steepest().part::<PART>(part);
            for k in 0..PART {
                near[k] = nearness(unit, near[k]);
            }
            *self.nearness.part_mut(part) = near;
        }
    }

    /// Takes over where one variant stands.
    pub fn copy_lane(&mut self, from: &Stand, lane: usize) {
        for (to, from) in self.tracked.iter_mut().zip(&from.tracked) {
            to[0].0[lane] = from[0].0[lane];
        }
        for (to, from) in self.determinants.iter_mut().zip(&from.determinants) {
            to.0[lane] = from.0[lane];
        }
        self.nearness.0[lane] = from.nearness.0[lane];
    }
}

/// Adds what is in doubt of a step from one place to the next, of a length (s) if it is one of time.
///
/// Nothing is where both ends are far from singular positions, which the motion between does not come up to; the first correction is small
/// beside the distance to them, for so far off are other branches; no determinant has turned, or changed by much; and both ends' velocities,
/// with accelerations where these are known, lead to where positions are.
#[inline(always)]
#[allow(clippy::inline_always)] // it is compiled for several kinds of processors
pub(super) fn of_step(
    (tracked, known): (&[Tracked], Known),
    [now, next]: [&Stand; 2],
    (h, first_corrections): (Option<f64>, &Each),
    doubts: &mut Doubts,
) {
    for part in 0..LANES / PART {
        let (mut motion, mut gap) = ([0.0; PART], [0.0; PART]);
        for ((now, next), of) in now.tracked.iter().zip(&next.tracked).zip(tracked) {
            let [[x, v, a], [y, w, b]] = [now, next].map(|at| at.each_ref().map(|each| each.part::<PART>(part)));
            for k in 0..PART {
                motion[k] = max(motion[k], (y[k] - x[k]).abs() * of.per_scale);
            }
            let mut way = [0.0; PART];
            match (h, known) {
                (None, _) => continue,
                (Some(h), Known::Velocities) => {
                    for k in 0..PART {
                        way[k] = 0.5 * h * (v[k] + w[k]);
                    }
                }
                (Some(h), Known::Accelerations) => {
                    let (half, twelfth) = (0.5 * h, h * h * (1.0 / 12.0));
                    for k in 0..PART {
                        way[k] = half * (v[k] + w[k]) + twelfth * (a[k] - b[k]);
                    }
                }
            }
            for k in 0..PART {
                gap[k] = max(gap[k], (y[k] - x[k] - way[k]).abs() * of.per_scale);
            }
        }
        let (from, to) = (*now.nearness.part::<PART>(part), *next.nearness.part::<PART>(part));
        let (corrections, mut in_doubt) = (*first_corrections.part::<PART>(part), *doubts.0.part::<PART>(part));
        for k in 0..PART {
            let (least, most) = if from[k] < to[k] { (from[k], to[k]) } else { (to[k], from[k]) };
            // all of it is looked at, in all lanes at once
            let (is_far, is_near_guess) = (least >= NEAREST, corrections[k] <= PART_OF_DISTANCE * least);
            let (is_short, is_inside) = (motion[k] <= LARGEST_MOTION, motion[k] <= most);
            let is_led_to = gap[k] <= LARGEST_GAP;
            in_doubt[k] += if is_far & is_near_guess & is_short & is_inside & is_led_to { 0.0 } else { 1.0 };
        }
        *doubts.0.part_mut(part) = in_doubt;
    }
    for (now, next) in now.determinants.iter().zip(&next.determinants) {
        for part in 0..LANES / PART {
            let (from, to) = (*now.part::<PART>(part), *next.part::<PART>(part));
            let mut in_doubt = *doubts.0.part::<PART>(part);
            for k in 0..PART {
                // both are of one sign, and neither is more than so many times the other
                let (product, a, b) = (from[k] * to[k], from[k].abs(), to[k].abs());
                let is_alike = product > 0.0 && a <= LARGEST_CHANGE * b && b <= LARGEST_CHANGE * a;
                in_doubt[k] += if is_alike { 0.0 } else { 1.0 };
            }
            *doubts.0.part_mut(part) = in_doubt;
        }
    }
}
