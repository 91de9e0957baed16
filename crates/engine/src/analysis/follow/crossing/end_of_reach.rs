//! End of reach: whether there is a position for every time on the path over a singular one, or the driver requires a little more there
//! than the mechanism reaches.
//!
//! Let all equations be met but for `λ w`, with `w` the dependency of the rows at the singular position. Then λ is a smooth function of the way along
//! the free motion and of time, with an extremum on that way, the fold. There λ is how much the mechanism reaches beyond what the driver requires,
//! and its sign against the curvature decides whether a position exists. As an extremum it has twice the digits of the curve on which it is sought.

use super::bridge::Bridge;
use crate::analysis::state::Kinematics;
use mechc_expr::math::boundary;

/// Maximum number of corrections of a position near the curve.
const CORRECTIONS: usize = 60;
/// Largest ratio of a correction to the previous one.
const CONTRACTS: f64 = 0.7;
/// A smaller correction, scaled, does not affect λ.
const SETTLED: f64 = 1e-13;
/// A correction that no longer shrinks is rounding if it is below this many times the rounding.
const ROUNDING: f64 = 1e3;
/// Number of times within the bridge at which the direction of the free motion is evaluated.
const SAMPLES: usize = 9;
/// Number of parabolas that search for an extremum in time near the singular position.
const PARABOLAS_IN_TIME: usize = 2;
/// Number of parabolas that search for an extremum along the free motion.
const PARABOLAS: usize = 3;
/// Width of each parabola, as a part of the previous one.
const NARROWER: f64 = 0.05;
/// Rows take part in a dependency from this part of the largest share on.
const TAKES_PART: f64 = 0.1;
/// Values within this many times the residual tolerance are not distinguished from zero.
const MARGIN: f64 = 4.0;

/// A function's extremum near a place.
struct Extremum {
    place: f64,
    value: f64,
    /// Half of its second derivative.
    bend: f64,
}

/// Bordered system for all states of a bridge, with the factors of its end.
struct Fold<'b> {
    bridge: &'b Bridge,
    /// By row: factor of λ.
    across: Vec<f64>,
    /// By coordinate: weight in the measure of the way along the free motion.
    along: Vec<f64>,
    /// `Φ_q⁻¹ across`
    answer: Vec<f64>,
    /// The middle of the ways at the samples, and how far they are from it.
    middle: f64,
    extent: f64,
}

/// Returns the time at which the mechanism comes to the end of its reach, if at some time on a bridge no position meets the equations to
/// their tolerance. Where that cannot be decided they are taken to be met.
pub fn end_of_reach(kinematics: &mut Kinematics, bridge: &Bridge) -> Option<f64> {
    kinematics.restore(&bridge.to);
    let n = bridge.to.q.len();
    let singular = kinematics.worst();
    let linear = kinematics.linear();
    let across: Vec<f64> = (0..n).map(|row| singular.left[row] * linear.row_norm(row)).collect();
    let along: Vec<f64> = (0..n).map(|column| singular.right[column] / linear.column_scale(column)).collect();
    let mut bounds = vec![0.0; n];
    kinematics.write_bounds(&mut bounds);
    let largest = singular.left.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    let takes_part = |row: &usize| singular.left[*row].abs() > TAKES_PART * largest;
    let linear = kinematics.linear();
    let limit = (0..n).filter(takes_part).map(|row| 1.0 / (bounds[row] * linear.row_norm(row))).fold(0.0, f64::max);
    let mut answer = vec![0.0; n];
    kinematics.solve(&across, &mut answer);
    let mut fold = Fold { bridge, across, along, answer, middle: 0.0, extent: 0.0 };
    fold.take_extent();
    let worst = time_of_worst_lack(kinematics, &fold);
    if lack(kinematics, &fold, worst)? <= MARGIN * limit {
        return None;
    }
    // a position exists where the curve leads away from the fold
    let lacks = |t: f64| lack(kinematics, &fold, t).is_some_and(|lack| lack > 0.0);
    Some(boundary(bridge.from.t, worst, lacks))
}

/// Returns the time at which the lack of reach is largest, near that of the singular position.
fn time_of_worst_lack(kinematics: &mut Kinematics, fold: &Fold<'_>) -> f64 {
    let Bridge { from, to, at, .. } = fold.bridge;
    let side = f64::min(at - from.t, to.t - at);
    let extremum = extremum(PARABOLAS_IN_TIME, *at, [0.25 * side, side], |t| lack(kinematics, fold, t));
    // a lack that is least there is largest at the ends, where positions exist
    extremum.filter(|extremum| extremum.bend < 0.0).map_or(*at, |extremum| extremum.place)
}

/// Returns how much more the driver requires at a time than the mechanism reaches, scaled; negative where it reaches more, `None` where the
/// equations have no fold near the bridge.
fn lack(kinematics: &mut Kinematics, fold: &Fold<'_>, t: f64) -> Option<f64> {
    let state = fold.bridge.state_at(t);
    let around = [0.5 * fold.extent, 4.0 * fold.extent];
    let found = extremum(PARABOLAS, fold.middle, around, |way| open_across(kinematics, fold, &state.q, t, way))?;
    Some(if found.bend > 0.0 { found.value } else { -found.value })
}

/// Returns λ, the residual of the dependency where all other equations hold, at a time and a place on the free motion's way.
fn open_across(kinematics: &mut Kinematics, fold: &Fold<'_>, from: &[f64], t: f64, way: f64) -> Option<f64> {
    let answers = dot(&fold.along, &fold.answer);
    let mut q = from.to_vec();
    let (mut right, mut delta) = (vec![0.0; q.len()], vec![0.0; q.len()]);
    let (mut open, mut last) = (0.0, f64::INFINITY);
    kinematics.set_time(t);
    for _ in 0..CORRECTIONS {
        kinematics.set_position(&q).ok()?;
        for (row, right) in right.iter_mut().enumerate() {
            *right = open * fold.across[row] - kinematics.phi(row);
        }
        kinematics.solve(&right, &mut delta);
        let change = (way - dot(&fold.along, &q) - dot(&fold.along, &delta)) / answers;
        open += change;
        for ((q, delta), answer) in q.iter_mut().zip(&mut delta).zip(&fold.answer) {
            *delta += change * answer;
            *q += *delta;
        }
        let size = kinematics.linear().largest(&delta);
        if size <= SETTLED {
            return Some(open);
        }
        // corrections by rounding do not vanish, but are small
        if size.is_nan() || size > CONTRACTS * last {
            return (size <= ROUNDING * SETTLED).then_some(open);
        }
        last = size;
    }
    None
}

impl Fold<'_> {
    /// Measures how far the free motion goes over the bridge.
    fn take_extent(&mut self) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let bridge = self.bridge;
        for sample in 0..SAMPLES {
            let part = sample as f64 / (SAMPLES - 1) as f64;
            let state = bridge.state_at(bridge.from.t + part * (bridge.to.t - bridge.from.t));
            let way = dot(&self.along, &state.q);
            (least, most) = (least.min(way), most.max(way));
        }
        (self.middle, self.extent) = (0.5 * (least + most), 0.5 * (most - least));
    }
}

/// Returns the extremum near a location by parabolas, the first one over `reach` to both sides; `None` where it is further off than
/// `farthest`, or where the function has none.
fn extremum(
    parabolas: usize,
    near: f64,
    [reach, farthest]: [f64; 2],
    mut value: impl FnMut(f64) -> Option<f64>,
) -> Option<Extremum> {
    let (mut place, mut reach, mut bend) = (near, reach, 0.0);
    for parabola in 0..parabolas {
        let (before, after) = (value(place - reach)?, value(place + reach)?);
        if parabola == 0 {
            bend = 0.5 * (before + after) - value(place)?;
        }
        let step = -0.25 * reach * (after - before) / bend;
        place += step;
        // NaN if the function is flat
        if place.is_nan() || (place - near).abs() > farthest {
            return None;
        }
        reach *= NARROWER;
        bend *= NARROWER * NARROWER;
    }
    Some(Extremum { place, value: value(place)?, bend })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
