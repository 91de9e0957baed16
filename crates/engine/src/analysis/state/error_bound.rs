//! Error bounds of a row: whether its numbers hold digits, and not only rounding.
//!
//! The verdict uses the state of the row alone, so it does not depend on how the state was reached, nor on the other output times.

use super::kinematics::{Kinematics, State};
use crate::limits::error_bound::{ACCURACY, SLOW};

/// A velocity is in doubt if its error may exceed this, relative to its size or 1.
const VELOCITY: f64 = 1e-8;
/// An acceleration is in doubt if its error may exceed this, relative to its size or 1.
const ACCELERATION: f64 = 4e-7;
/// Distance from a singular position beyond which rounding stays small.
const FAR: f64 = 1.5e-3;

/// Accuracy of the numbers of a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Trust {
    /// All numbers have the promised digits.
    Certain,
    /// The position is known; velocities or accelerations may be wrong, if rounding happens to add up.
    Doubtful,
    /// Derivatives are more rounding than digits.
    Uncertain,
}

impl Trust {
    pub fn is_certain(self) -> bool {
        self == Trust::Certain
    }

    /// Judges a state that was just computed.
    ///
    /// Rounding leaves an error of eps/σ in `q`, with σ the smallest singular value of a block of the scaled `Φ_q`. The equations
    /// amplify it in the derivatives, near a dead point by 1/σ; near a bifurcation velocities are off by eps/σ², accelerations by eps/σ³.
    pub fn of(kinematics: &mut Kinematics, state: &State) -> Trust {
        let sigma = kinematics.nearness(f64::EPSILON.sqrt() / ACCURACY.sqrt());
        let uncertain = f64::EPSILON / sigma * kinematics.amplification(state);
        if uncertain > ACCURACY {
            return Trust::Uncertain;
        }
        if !kinematics.compute_error_bounds(state, FAR) {
            return Trust::Certain;
        }
        let [velocity, acceleration] = kinematics.doubt();
        if are_small(kinematics, state, [velocity, acceleration], [VELOCITY, ACCELERATION]) {
            Trust::Certain
        } else {
            Trust::Doubtful
        }
    }
}

/// Returns whether the error bounds of velocities and accelerations of a state are within limits.
pub fn are_small(kinematics: &Kinematics, state: &State, off: [&[f64]; 2], limits: [f64; 2]) -> bool {
    let off = |order: usize, k: usize| off[order - 1][k];
    are_within(kinematics, [&state.qd, &state.qdd], off, limits)
}

/// Returns whether two states, each by its position, velocity and acceleration, differ by no more than a part of the motion. One coordinate that rests
/// differs by the rounding of others that do not.
pub fn are_alike(kinematics: &Kinematics, a: [&[f64]; 3], b: [&[f64]; 3], part: f64) -> bool {
    let [q, qd, qdd] = a;
    let scale = |k: usize| kinematics.linear().column_scale(k);
    let is_place = q.iter().zip(b[0]).enumerate().all(|(k, (a, b))| (a - b).abs() <= part * (scale(k) + a.abs()));
    is_place && are_within(kinematics, [qd, qdd], |order, k| a[order][k] - b[order][k], [part; 2])
}

/// Returns whether errors of velocities and accelerations, given by order and coordinate, are within limits.
fn are_within(
    kinematics: &Kinematics,
    [qd, qdd]: [&[f64]; 2],
    off: impl Fn(usize, usize) -> f64,
    limits: [f64; 2],
) -> bool {
    let linear = kinematics.linear();
    let (speed, bend) = (linear.largest(qd), linear.largest(qdd));
    let is_small = |order: usize, x: &[f64], fastest: f64| {
        let is_small = |k: usize| {
            let scale = linear.column_scale(k);
            off(order, k).abs() / scale <= limits[order - 1] * f64::max(1.0 + x[k].abs() / scale, SLOW * fastest)
        };
        (0..x.len()).all(is_small)
    };
    is_small(1, qd, speed) && is_small(2, qdd, bend.max(speed * speed))
}
