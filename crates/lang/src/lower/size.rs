//! Sizes of bodies, by which residuals and steps are scaled.
//!
//! One length for the whole mechanism is not enough: with many small loops far apart, or a small linkage on a large machine, good positions
//! would look singular.

use super::used_features::UsedFeatures;
use crate::model::{Body, Curve, Frame, Joint, Mechanism, Named};
use mechc_expr::{ExprId, Symbol};
use mechc_text::vocabulary::ArgumentSpec;

use rustc_hash::FxHashMap;

/// Frames with more points are measured by their bounding box, so that the time stays linear.
const MANY_POINTS: usize = 500;
/// Largest ratio of the size from features without equations to that from the others for which the former counts.
const IN_PROPORTION: f64 = 10.0;
/// Smaller sizes (m) are zero.
const SMALLEST: f64 = 1e-12;
/// Samples that represent a whole curve.
const PLACES_ON_CURVE: u32 = 16;

/// Returns the size of each body (m): the largest distance between two of its features.
///
/// Points that no equation uses are drawn or measured and may lie anywhere. They count only if the size with them is in proportion to the
/// size without them.
pub(super) fn body_sizes(model: &Mechanism) -> Vec<f64> {
    let mut values = Vec::new();
    model.graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    });
    let value = |id: ExprId| values[id.index()];
    let all = sizes_by_features(model, &value, None);
    let Some(used) = sizes_by_features(model, &value, Some(&UsedFeatures::new(model))) else {
        return all.unwrap_or_else(|| vec![fallback_size(model, value); model.bodies.len()]);
    };
    let Some(all) = all else {
        return used;
    };
    let in_proportion = |all: f64, used: f64| all <= IN_PROPORTION * used && used <= IN_PROPORTION * all;
    all.into_iter().zip(used).map(|(all, used)| if in_proportion(all, used) { all } else { used }).collect()
}

/// Returns the sizes of bodies from all features or from the used ones; `None` if no body has two features apart.
///
/// A body without two features apart takes the size of the largest body to which a joint connects it, else that of the largest body of its
/// part. The ground of a part has no size, like the ground.
fn sizes_by_features(
    model: &Mechanism,
    value: &impl Fn(ExprId) -> f64,
    uses: Option<&UsedFeatures>,
) -> Option<Vec<f64>> {
    let points = feature_positions(model, value, uses);
    let mut sizes = vec![0.0; model.bodies.len()];
    for (frame, points) in &points {
        if let Frame::Body(body) = frame {
            sizes[body.index()] = extent(points);
        }
    }
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    if !is_size(largest) {
        return None;
    }
    let from_features = sizes.clone();
    let size_of = |frame: Frame| match frame {
        Frame::Body(body) => from_features[body.index()],
        Frame::Ground | Frame::Part(_) => 0.0,
    };
    for joint in &model.joints {
        let frames = joint.frames(model);
        for (frame, other) in [(frames[0], frames[1]), (frames[1], frames[0])] {
            if let Frame::Body(body) = model.carrier(frame)
                && !is_size(from_features[body.index()])
            {
                sizes[body.index()] = f64::max(sizes[body.index()], size_of(other));
            }
        }
    }
    let largest_in_parts = part_sizes(model, &sizes);
    let around = |body: &Body| {
        let mut parts = model.parts_around(body.part).map(|part| largest_in_parts[part.index()]);
        parts.find(|&size| is_size(size)).unwrap_or(largest)
    };
    let filled = sizes.iter().zip(&model.bodies).map(|(&size, body)| if is_size(size) { size } else { around(body) });
    Some(filled.collect())
}

/// Returns the size of the largest body of each part, including the parts in it (m); 0 if it has no bodies.
pub(super) fn part_sizes(model: &Mechanism, sizes: &[f64]) -> Vec<f64> {
    let mut largest = vec![0.0; model.parts.len()];
    for (body, &size) in model.bodies.iter().zip(sizes) {
        for part in model.parts_around(body.part) {
            largest[part.index()] = f64::max(largest[part.index()], size);
        }
    }
    largest
}

/// Returns the distance (m) from each body's origin to the nearest feature that equations use. By this lever the origin moves when the body
/// turns a little, however small the body is.
pub(super) fn frame_offsets(model: &Mechanism) -> Vec<f64> {
    let mut values = Vec::new();
    model.graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    });
    let points = feature_positions(model, &|id: ExprId| values[id.index()], Some(&UsedFeatures::new(model)));
    let mut distances = vec![0.0; model.bodies.len()];
    for (frame, points) in &points {
        if let Frame::Body(body) = frame {
            let all =
                points.iter().map(|[x, y]| mechc_expr::math::hypot(*x, *y)).filter(|distance| distance.is_finite());
            let nearest = all.fold(f64::INFINITY, f64::min);
            distances[body.index()] = if nearest.is_finite() { nearest } else { 0.0 };
        }
    }
    distances
}

/// Returns the positions of features in each frame (m).
fn feature_positions(
    model: &Mechanism,
    value: &impl Fn(ExprId) -> f64,
    uses: Option<&UsedFeatures>,
) -> FxHashMap<Frame, Vec<[f64; 2]>> {
    let counts = |list: fn(&UsedFeatures) -> &[bool], k: usize| uses.is_none_or(|uses| list(uses)[k]);
    let mut points: FxHashMap<Frame, Vec<[f64; 2]>> = FxHashMap::default();
    for (_, point) in model.points.iter().enumerate().filter(|(k, _)| counts(|uses| &uses.points, *k)) {
        let (frame, place) = model.in_carrier(value, point.frame, point.at.map(value));
        points.entry(frame).or_default().push(place);
    }
    for (_, circle) in model.circles.iter().enumerate().filter(|(k, _)| counts(|uses| &uses.circles, *k)) {
        let (frame, [x, y]) = model.in_carrier(value, circle.frame, model[circle.center].at.map(value));
        let radius = value(circle.radius);
        let ends = [[x + radius, y], [x - radius, y], [x, y + radius], [x, y - radius]];
        points.entry(frame).or_default().extend(ends);
    }
    for (_, curve) in model.curves.iter().enumerate().filter(|(k, _)| counts(|uses| &uses.curves, *k)) {
        let frame = model.carrier(curve.frame);
        let in_carrier = sample_curve(model, curve).map(|place| model.in_carrier(value, curve.frame, place).1);
        points.entry(frame).or_default().extend(in_carrier);
    }
    points
}

/// Returns sample points of a curve (m) over one turn of its argument.
fn sample_curve<'m>(model: &'m Mechanism, curve: &'m Curve) -> impl Iterator<Item = [f64; 2]> + 'm {
    (0..PLACES_ON_CURVE).filter_map(move |k| {
        let u = std::f64::consts::PI * (2.0 * f64::from(k) / f64::from(PLACES_ON_CURVE) - 1.0);
        let place = curve.at.map(|id| {
            model.graph.value(id, |symbol| match symbol {
                Symbol::Param(k) => model.params[k as usize].value,
                Symbol::Shift(_) => 0.0,
                Symbol::Named(k) if model.named[k as usize] == Named::Argument => u,
                _ => f64::NAN,
            })
        });
        place.iter().all(|x| x.is_finite()).then_some(place)
    })
}

/// Returns one size (m) for all bodies if none has a size: the largest of offsets from origins, link lengths, and the extents of the ground
/// and of the bodies' positions; 1 m if all are zero.
fn fallback_size(model: &Mechanism, value: impl Fn(ExprId) -> f64) -> f64 {
    let ground = feature_positions(model, &value, None).get(&Frame::Ground).map_or(0.0, |points| extent(points));
    let of_a_body = model.points.iter().filter(|point| point.frame != Frame::Ground);
    let offsets = of_a_body.map(|point| mechc_expr::math::hypot(value(point.at[0]), value(point.at[1])));
    let is_length = |joint: &&Joint| {
        matches!(joint.spec.arguments.first(), Some(ArgumentSpec::Length(_) | ArgumentSpec::Offset(_)))
    };
    let links = model.joints.iter().filter(is_length).filter_map(|joint| Some(value(joint.value()?).abs()));
    let places: Vec<[f64; 2]> = model.bodies.iter().map(|body| [value(body.pose[0]), value(body.pose[1])]).collect();
    let size = offsets.chain(links).chain([ground, extent(&places)]).fold(0.0, f64::max);
    if is_size(size) { size } else { 1.0 }
}

fn is_size(length: f64) -> bool {
    length.is_finite() && length > SMALLEST
}

fn extent(points: &[[f64; 2]]) -> f64 {
    if points.len() <= MANY_POINTS {
        let mut largest: f64 = 0.0;
        for (k, a) in points.iter().enumerate() {
            for b in &points[k + 1..] {
                largest = largest.max(mechc_expr::math::hypot(a[0] - b[0], a[1] - b[1]));
            }
        }
        return largest;
    }
    let side = |k: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        high - low
    };
    mechc_expr::math::hypot(side(0), side(1))
}
