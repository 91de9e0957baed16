//! The sizes of bodies, against which residuals and steps are judged.
//!
//! A length for the whole mechanism would not do: where many small loops stand far apart, or a small linkage sits on a
//! large machine, it would make good positions look singular.

use super::uses::Uses;
use crate::model::{Body, Curve, Frame, JointKind, Mechanism, Named};
use mechc_expr::{ExprId, Symbol};
use mechc_ir::tolerances::scales::size::{IN_PROPORTION, MANY_POINTS, PLACES_ON_CURVE, SMALLEST};

use rustc_hash::FxHashMap;

/// The size of each body (m): the largest distance between two of its features.
///
/// A point that no equation uses is drawn or measured: it may lie a little off, or far away, which is nothing to the motion.
/// What such points say counts only as far as it is in proportion to what those say that are used.
pub(super) fn of_bodies(model: &Mechanism) -> Vec<f64> {
    let mut values = Vec::new();
    model.graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    });
    let value = |id: ExprId| values[id.index()];
    let all = by_features(model, &value, None);
    let Some(used) = by_features(model, &value, Some(&Uses::of(model))) else {
        return all.unwrap_or_else(|| vec![other_size(model, value); model.bodies.len()]);
    };
    let Some(all) = all else {
        return used;
    };
    let in_proportion = |all: f64, used: f64| all <= IN_PROPORTION * used && used <= IN_PROPORTION * all;
    all.into_iter().zip(used).map(|(all, used)| if in_proportion(all, used) { all } else { used }).collect()
}

/// The sizes of bodies by all features, or by those that are used; none where no body has two apart.
///
/// A body without two features apart takes the size of the largest body that a joint holds it to, then that of the
/// largest one at all. What carries a part counts as its ground does: for nothing; and the largest body is that of the part.
fn by_features(model: &Mechanism, value: &impl Fn(ExprId) -> f64, uses: Option<&Uses>) -> Option<Vec<f64>> {
    let points = places(model, value, uses);
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
    let own = sizes.clone();
    let size_of = |frame: Frame| match frame {
        Frame::Body(body) => own[body.index()],
        Frame::Ground | Frame::Part(_) => 0.0,
    };
    for joint in &model.joints {
        let frames = joint.kind.frames(model);
        for (frame, other) in [(frames[0], frames[1]), (frames[1], frames[0])] {
            if let Frame::Body(body) = model.carrier(frame)
                && !is_size(own[body.index()])
            {
                sizes[body.index()] = f64::max(sizes[body.index()], size_of(other));
            }
        }
    }
    let of_parts = of_parts(model, &sizes);
    let around = |body: &Body| {
        let mut parts = model.parts_around(body.part).map(|part| of_parts[part.index()]);
        parts.find(|&size| is_size(size)).unwrap_or(largest)
    };
    let filled = sizes.iter().zip(&model.bodies).map(|(&size, body)| if is_size(size) { size } else { around(body) });
    Some(filled.collect())
}

/// The size of the largest body of each part, with those of its own parts (m); 0 where there is none.
pub(super) fn of_parts(model: &Mechanism, sizes: &[f64]) -> Vec<f64> {
    let mut largest = vec![0.0; model.parts.len()];
    for (body, &size) in model.bodies.iter().zip(sizes) {
        for part in model.parts_around(body.part) {
            largest[part.index()] = f64::max(largest[part.index()], size);
        }
    }
    largest
}

/// How far each body's frame lies from the features that equations use (m): as far as that goes a body's origin moves when it
/// turns a little, however small the body.
pub(super) fn of_frames(model: &Mechanism) -> Vec<f64> {
    let mut values = Vec::new();
    model.graph.extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].value,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    });
    let points = places(model, &|id: ExprId| values[id.index()], Some(&Uses::of(model)));
    let mut distances = vec![0.0; model.bodies.len()];
    for (frame, points) in &points {
        if let Frame::Body(body) = frame {
            let all = points.iter().map(|[x, y]| mechc_expr::math::hypot(*x, *y)).filter(|way| way.is_finite());
            let nearest = all.fold(f64::INFINITY, f64::min);
            distances[body.index()] = if nearest.is_finite() { nearest } else { 0.0 };
        }
    }
    distances
}

/// The places of features in each frame (m).
fn places(model: &Mechanism, value: &impl Fn(ExprId) -> f64, uses: Option<&Uses>) -> FxHashMap<Frame, Vec<[f64; 2]>> {
    let counts = |list: fn(&Uses) -> &[bool], k: usize| uses.is_none_or(|uses| list(uses)[k]);
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
        let in_carrier = places_on(model, curve).map(|place| model.in_carrier(value, curve.frame, place).1);
        points.entry(frame).or_default().extend(in_carrier);
    }
    points
}

/// Some places on a curve (m), over one turn of its argument.
fn places_on<'m>(model: &'m Mechanism, curve: &'m Curve) -> impl Iterator<Item = [f64; 2]> + 'm {
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

/// A size for all bodies where none has one of its own, by what else the file says of sizes: offsets from a body's origin,
/// lengths of links, the extent of the ground, the bodies' places; 1 m if there is nothing.
fn other_size(model: &Mechanism, value: impl Fn(ExprId) -> f64) -> f64 {
    let ground = places(model, &value, None).get(&Frame::Ground).map_or(0.0, |points| extent(points));
    let of_a_body = model.points.iter().filter(|point| point.frame != Frame::Ground);
    let offsets = of_a_body.map(|point| mechc_expr::math::hypot(value(point.at[0]), value(point.at[1])));
    let links = model.joints.iter().filter_map(|joint| match joint.kind {
        JointKind::RevoluteRevolute(_, _, length) => Some(value(length)),
        JointKind::RevoluteTranslational(_, _, offset) => Some(value(offset).abs()),
        _ => None,
    });
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
