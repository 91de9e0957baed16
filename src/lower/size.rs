//! The size of a mechanism, against which residuals and steps are judged.

use crate::expr::Symbol;
use crate::model::{Frame, JointKind, Mechanism};
use rustc_hash::FxHashMap;

/// Frames with more points than this are measured by their bounding box, to stay linear.
const MANY_POINTS: usize = 500;

/// The largest distance between two features of one body or of the ground [m].
///
/// Where no frame has two features apart, what else the file says of sizes serves: offsets from a body's origin, links'
/// lengths, the bodies' places; 1 m if there is nothing.
pub(super) fn characteristic_length(model: &Mechanism) -> f64 {
    let mut values = Vec::new();
    model.graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        _ => f64::NAN,
    });
    let value = |id: crate::expr::ExprId| values[id.index()];
    let mut frames: FxHashMap<Frame, Vec<[f64; 2]>> = FxHashMap::default();
    for point in &model.points {
        frames.entry(point.frame).or_default().push(point.at.map(value));
    }
    // a maximum does not depend on the order of the map
    let within_frames = frames.values().map(|points| extent(points)).fold(0.0, f64::max);
    if is_size(within_frames) {
        return within_frames;
    }
    let offsets = frames
        .iter()
        .filter(|(frame, _)| **frame != Frame::Ground)
        .flat_map(|(_, points)| points)
        .map(|&[x, y]| crate::math::hypot(x, y));
    let links = model.joints.iter().filter_map(|joint| match joint.kind {
        JointKind::RevoluteRevolute(_, _, length) => Some(value(length)),
        JointKind::RevoluteTranslational(_, _, offset) => Some(value(offset).abs()),
        _ => None,
    });
    let places: Vec<[f64; 2]> = model.bodies.iter().map(|body| [value(body.pose[0]), value(body.pose[1])]).collect();
    let size = offsets.chain(links).chain([extent(&places)]).fold(0.0, f64::max);
    if is_size(size) { size } else { 1.0 }
}

fn is_size(length: f64) -> bool {
    length.is_finite() && length > 1e-12
}

fn extent(points: &[[f64; 2]]) -> f64 {
    if points.len() <= MANY_POINTS {
        let mut largest: f64 = 0.0;
        for (k, a) in points.iter().enumerate() {
            for b in &points[k + 1..] {
                largest = largest.max(crate::math::hypot(a[0] - b[0], a[1] - b[1]));
            }
        }
        return largest;
    }
    let side = |k: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        high - low
    };
    crate::math::hypot(side(0), side(1))
}
