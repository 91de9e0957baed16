//! Times at which a motion on a bridge comes to the singular position.

use super::CERTAIN;
use super::bridge::Bridge;
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Determinant, Kinematics};
use mechc_expr::math::{GoldenSection, boundary};
use std::convert::Infallible;

/// Number of samples of a bridge to find a singular position that is reached twice.
const PLACES_BETWEEN: usize = 24;
/// A determinant changes its sign, rather than touches zero, if it is below this part of its values at the ends.
const BEYOND_ZERO: f64 = -1e-6;
/// A more accurate curve decides where the determinant is below this part.
const NEARLY_ZERO: f64 = 1e-2;
/// Number of samples of an even contact to find its minimum.
const LOOKS: usize = 80;
/// Number of Newton steps to the minimum.
const NEWTON_STEPS: usize = 8;
/// Distance of the two points of a difference quotient, as a part of the bridge.
const SPREAD: f64 = 0.08;

/// The minimum's slope by central differences of sixth order, and its curvature, by the distance of the places in `SPREAD`.
const SLOPE: [f64; 3] = [45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0];
const CURVATURE: [f64; 4] = [-490.0 / 180.0, 270.0 / 180.0, -27.0 / 180.0, 2.0 / 180.0];

/// Returns the time at which the singular position is reached: a determinant changes its sign there, or else comes nearest to zero.
pub(super) fn singular_time(kinematics: &mut Kinematics, step: &mut Step, bridge: &Bridge) -> f64 {
    let (low, high) = (bridge.from.t, bridge.to.t);
    kinematics.restore(&bridge.to);
    if let Some(block) = step.signs().block_that_turned(kinematics) {
        return boundary(low, high, |t| {
            kinematics.restore(&bridge.state_at(t));
            step.signs().has_turned(kinematics, block)
        });
    }
    let mut sigma = |t: f64| -> Result<f64, Infallible> {
        kinematics.restore(&bridge.state_at(t));
        Ok(kinematics.nearness(1.0))
    };
    let Ok(mut section) = GoldenSection::new([low, f64::NAN], [high, f64::NAN], &mut sigma);
    for _ in 0..LOOKS {
        let Ok(()) = section.narrow(&mut sigma);
    }
    least_time(kinematics, step, bridge, section.middle())
}

/// Returns the time near `t` at which the determinant that is least there has its minimum. Its sign tells the sides of zero apart, so it is
/// smooth where singular values have an edge, and its slope vanishes there to more digits than its value.
fn least_time(kinematics: &mut Kinematics, step: &mut Step, bridge: &Bridge, t: f64) -> f64 {
    kinematics.restore(&bridge.state_at(t));
    let Some(block) = kinematics.linear().worst_block() else { return t };
    let unit = step.signs().determinants()[block];
    let mut value = |t: f64| {
        let state = bridge.state_at(t);
        step.try_state(&state);
        // the curve is not exact; at the singular position itself it is better than nothing
        if step.correct(kinematics).is_err() {
            kinematics.restore(&state);
        }
        kinematics.linear().determinant(block).relative_to(unit)
    };
    let spread = SPREAD * bridge.length();
    let mut at = t;
    for _ in 0..NEWTON_STEPS {
        let (mut slope, mut curvature) = (0.0, CURVATURE[0] * value(at));
        for k in 0..SLOPE.len() {
            let way = (k + 1) as f64 * spread;
            let (before, after) = (value(at - way), value(at + way));
            slope += SLOPE[k] * (after - before);
            curvature += CURVATURE[k + 1] * (after + before);
        }
        let change = spread * slope / curvature;
        at -= change;
        // a minimum farther away is another one
        if at.is_nan() || (at - t).abs() > spread {
            return t;
        }
        if change.abs() <= f64::EPSILON * spread {
            break;
        }
    }
    at
}

/// Refines the singular time of a bridge by a finer curve. A determinant that has one sign at both ends and the other one between shows
/// that the singular position is reached twice.
pub(super) fn settle_times(kinematics: &mut Kinematics, step: &mut Step, bridge: &mut Bridge) {
    let units = [&bridge.from, &bridge.to].map(|end| {
        kinematics.restore(end);
        (0..kinematics.linear().blocks()).map(|k| kinematics.linear().determinant(k)).collect::<Vec<Determinant>>()
    });
    let (from, to) = (bridge.from.t, bridge.to.t);
    let changes = |k: &usize| units[0][*k].is_positive() != units[1][*k].is_positive();
    if let Some(block) = (0..units[0].len()).find(changes) {
        bridge.look_for_exact(kinematics, step);
        let at = boundary(from, to, |t| relative_determinant(kinematics, bridge, block, units[0][block], t) < 0.0);
        if (at - bridge.at).abs() > CERTAIN * (to - from) {
            bridge.at = at;
        }
        return;
    }
    let places = (1..PLACES_BETWEEN).map(|k| from + (to - from) * k as f64 / PLACES_BETWEEN as f64);
    let places: Vec<f64> = std::iter::once(bridge.at).chain(places).collect();
    for (block, unit) in units[0].iter().copied().enumerate() {
        let deepest = |kinematics: &mut Kinematics, bridge: &Bridge| {
            let parts = places.iter().map(|&t| (relative_determinant(kinematics, bridge, block, unit, t), t));
            parts.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, bridge.at))
        };
        if deepest(kinematics, bridge).0 > NEARLY_ZERO {
            continue;
        }
        bridge.look_for_exact(kinematics, step);
        let (least, between) = deepest(kinematics, bridge);
        if least < BEYOND_ZERO {
            let at = boundary(from, between, |t| relative_determinant(kinematics, bridge, block, unit, t) < 0.0);
            let second = boundary(between, to, |t| relative_determinant(kinematics, bridge, block, unit, t) >= 0.0);
            (bridge.at, bridge.again) = (at, Some(second));
            return;
        }
    }
}

/// Returns a block's determinant at a time, relative to that at the start of the bridge, `unit`.
fn relative_determinant(kinematics: &mut Kinematics, bridge: &Bridge, block: usize, unit: Determinant, t: f64) -> f64 {
    kinematics.restore(&bridge.best_state_at(t));
    kinematics.linear().determinant(block).relative_to(unit) / unit.relative_to(unit)
}
