//! Cams and their followers.

use super::drawing::{Drawing, Layer, shape};
use super::features::Features;
use super::plane::{Path, Vector, bounds, distance, dot, minus, plus, times};
use super::symbols::PIN;
use super::{Anchor, Contact, Look, Shape, Touch};
use mechc_lang::model::{AxisId, JointKind, PointId, Profile};
use std::f64::consts::{FRAC_PI_2, PI};

/// Length of a face beyond the contact (symbol units).
const BEYOND: f64 = 1.0;
/// Tolerance of the line that shows a profile (symbol units).
const OFF: f64 = 0.008;

pub(super) fn point_follower(drawing: &mut Drawing, number: usize, p: PointId, profile: Profile) {
    let declaration = drawing.first.joints + number;
    let used = arguments(drawing, number, "u");
    shown_profile(drawing, profile, used, false);
    let at = drawing.features.point(p);
    let point = drawing.shown(&[p]);
    let tip = Shape { path: Path::Circle { at: at.at, radius: PIN * drawing.unit }, look: Look::Roller, point };
    drawing.add_fixed(Layer::Pins, declaration, at.frame, vec![tip]);
    drawing.outlines[at.frame].is_shown = true;
}

pub(super) fn cam(drawing: &mut Drawing, number: usize, [k, m]: [Profile; 2]) {
    let used = ["u", "w"].map(|part| arguments(drawing, number, part));
    let roller = roller(&drawing.features, [k, m]);
    shown_profile(drawing, k, used[0], roller == Some(0));
    shown_profile(drawing, m, used[1], roller == Some(1));
    let declaration = drawing.first.joints + number;
    let marks = [k, m].map(|profile| match profile {
        Profile::Circle(circle) => Some(drawing.features.circle(circle)),
        Profile::Curve(_) => None,
    });
    // the contact point is fixed to no frame: a mark in the middle of the roller stands for the joint
    let marked = marks.into_iter().flatten().min_by(|a, b| a.radius.total_cmp(&b.radius));
    let mark = marked.map(|disc| center_mark(disc.center, disc.radius.min(drawing.unit)));
    let frame = marked.map_or(0, |disc| disc.center.frame);
    drawing.add_fixed(Layer::Blocks, declaration, frame, mark.into_iter().collect());
}

pub(super) fn flat_follower(drawing: &mut Drawing, number: usize, profile: Profile, face: AxisId) {
    let declaration = drawing.first.joints + number;
    shown_profile(drawing, profile, arguments(drawing, number, "u"), false);
    let line = drawing.features.axis(face);
    let contact = drawing.own_coordinate(number, "u");
    let on_face = |row: usize| {
        let place = drawing.features.on_profile(profile, contact.as_ref().map_or(f64::NAN, |u| u[row]));
        dot(line.along, minus(drawing.seen(place, line.frame, row), line.at))
    };
    let [low, high] = drawing.range(on_face);
    let [low, high] = if low <= high { [low.min(0.0), high.max(0.0)] } else { [0.0, 0.0] };
    let beyond = BEYOND * drawing.unit;
    let ends = [low - beyond, high + beyond].map(|along| plus(line.at, times(along, line.along)));
    let bar = shape(Look::Face, Path::line(ends));
    if line.frame == 0 {
        drawing.add_fixed(Layer::Ground, declaration, 0, vec![bar]);
    } else {
        drawing.add_fixed(Layer::Blocks, declaration, line.frame, vec![bar]);
        drawing.outlines[line.frame].is_shown = true;
    }
}

/// Returns the contacts whose cam can be told from the follower. A curve on a curve has no cam.
pub(super) fn contacts(features: &Features, first_joint: usize) -> Vec<Contact> {
    let model = features.model;
    let carrier = |profile: Profile| features.frame(profile.frame(model));
    let contact = |(number, joint): (usize, &mechc_lang::model::Joint)| {
        let (cam, follower, touch) = match joint.kind {
            JointKind::PointFollower(p, profile) => {
                let tip = features.point(p);
                (carrier(profile), tip.frame, Touch::Tip(tip.at))
            }
            JointKind::FlatFollower(profile, face) => {
                let line = features.axis(face);
                (carrier(profile), line.frame, Touch::Face(line.at, line.along))
            }
            JointKind::Cam(k, m) => {
                let (cam, roller, part) = if roller(features, [k, m])? == 0 { (m, k, "u") } else { (k, m, "w") };
                let argument = format!("{}.{part}", joint.declared.name);
                (carrier(cam), carrier(roller), rolling(features, roller, argument))
            }
            _ => return None,
        };
        Some(Contact { declaration: first_joint + number, cam, follower, touch })
    };
    model.joints.iter().enumerate().filter_map(contact).collect()
}

/// Returns which of two profiles is the roller: the smaller one of two circles.
fn roller(features: &Features, profiles: [Profile; 2]) -> Option<usize> {
    let [k, m] = profiles.map(|profile| match profile {
        Profile::Circle(circle) => features.circle(circle).radius,
        Profile::Curve(_) => f64::INFINITY,
    });
    (k.min(m).is_finite()).then_some(usize::from(m <= k))
}

fn rolling(features: &Features, profile: Profile, argument: String) -> Touch {
    let [ahead, aside, back] = [0.0, FRAC_PI_2, PI].map(|w| features.on_profile(profile, w).at);
    let centre = times(0.5, plus(ahead, back));
    Touch::Roller { centre, arms: [minus(ahead, centre), minus(aside, centre)], argument }
}

/// Returns the range of a contact's argument along the motion.
fn arguments(drawing: &Drawing, number: usize, part: &str) -> Option<[f64; 2]> {
    let values = drawing.own_coordinate(number, part)?;
    let [low, high] = drawing.range(|row| values[row]);
    (low <= high).then_some([low, high])
}

/// Draws a profile unless it is drawn already: filled if it is closed and on a body, otherwise as a line.
fn shown_profile(drawing: &mut Drawing, profile: Profile, used: Option<[f64; 2]>, is_roller: bool) {
    let before = drawing.profiles.len();
    let number = drawing.profile(profile, used);
    if number < before {
        return;
    }
    let known = &drawing.profiles[number];
    let (frame, is_closed) = (known.frame, known.is_closed);
    let declaration = if frame > 0 { frame } else { known.declaration };
    let is_filled = is_closed && frame > 0;
    let look = if is_roller {
        Look::Roller
    } else if is_filled {
        Look::Cam
    } else {
        Look::Track
    };
    let path = match profile {
        Profile::Circle(circle) => {
            let disc = drawing.features.circle(circle);
            Path::Circle { at: disc.center.at, radius: disc.radius }
        }
        Profile::Curve(_) => {
            let places: Vec<Vector> = known.samples.iter().map(|sample| sample.at).collect();
            let kept = simplified(&places, OFF * drawing.unit);
            if is_closed { Path::polygon(kept.into_iter().skip(1)) } else { Path::line(kept) }
        }
    };
    drawing.outlines[frame].is_shown |= is_filled || is_roller;
    let layer = if frame == 0 { Layer::Ground } else { Layer::Wheels };
    let (places, is_disc) = (path.places(), is_filled || is_roller);
    if is_disc && let Some([low, high]) = bounds(places.iter().copied()) {
        let middle = times(0.5, plus(low, high));
        let radius = places.iter().map(|place| distance(*place, middle)).fold(f64::INFINITY, f64::min);
        drawing.outlines[frame].discs.push((middle, radius));
    }
    drawing.add_fixed(layer, declaration, frame, vec![shape(look, path)]);
}

/// Returns a cross in the centre of a disc, which makes its rotation visible.
fn center_mark(center: Anchor, size: f64) -> Shape {
    let half = 0.35 * size;
    let [x, y] = center.at;
    shape(Look::Pitch, Path::strokes([[[x - half, y], [x + half, y]], [[x, y - half], [x, y + half]]]))
}

/// Simplifies a polygon with at most `off` between it and the result (Douglas–Peucker algorithm).
pub(super) fn simplified(places: &[Vector], off: f64) -> Vec<Vector> {
    if places.len() < 3 {
        return places.to_vec();
    }
    let mut is_kept = vec![false; places.len()];
    let last = places.len() - 1;
    (is_kept[0], is_kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let farthest = (from + 1..to).map(|k| (from_segment(places[k], places[from], places[to]), k));
        if let Some((away, k)) = farthest.max_by(|a, b| a.0.total_cmp(&b.0))
            && away > off
        {
            is_kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    places.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept).map(|(place, _)| *place).collect()
}

/// Returns the distance of a position from a segment.
fn from_segment(place: Vector, from: Vector, to: Vector) -> f64 {
    let way = minus(to, from);
    let square = dot(way, way);
    let part = if square > 0.0 { (dot(minus(place, from), way) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(place, plus(from, times(part, way)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_keeps_what_matters() {
        let circle: Vec<Vector> = (0..=360).map(|k| super::super::polar(1.0, f64::from(k).to_radians())).collect();
        let kept = simplified(&circle, 1e-3);
        assert!(kept.len() < 130, "{} corners", kept.len());
        for place in &circle {
            let nearest =
                kept.windows(2).map(|pair| from_segment(*place, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
            assert!(nearest <= 1e-3);
        }
    }
}
