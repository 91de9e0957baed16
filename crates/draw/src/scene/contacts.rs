//! Cams and their followers.

use super::drawing::{Drawing, Layer, shape};
use super::features::Features;
use super::plane::{Path, Vector, bounds, distance, distance_to_segment, dot, minus, plus, times};
use super::symbols::PIN;
use super::{Anchor, Contact, Look, Shape, Touch};
use mechc_lang::model::{AxisId, JointFeature, PointId, Profile};
use std::f64::consts::{FRAC_PI_2, PI};

/// Length of a face beyond the contact (symbol units).
const BEYOND: f64 = 1.0;
/// Tolerance of the line that shows a profile (symbol units).
const TOLERANCE: f64 = 0.008;

/// Draws a contact: a point or a profile on a profile, or a profile at a face.
pub(super) fn draw(drawing: &mut Drawing, number: usize, features: [JointFeature; 2]) {
    match features {
        [JointFeature::Point(p), JointFeature::Profile(profile)] => point_follower(drawing, number, p, profile),
        [JointFeature::Profile(k), JointFeature::Profile(m)] => cam(drawing, number, [k, m]),
        [JointFeature::Profile(profile), JointFeature::Axis(face)] => flat_follower(drawing, number, profile, face),
        _ => {}
    }
}

fn point_follower(drawing: &mut Drawing, number: usize, p: PointId, profile: Profile) {
    let declaration = drawing.first.joints + number;
    let range = arguments(drawing, number, "u");
    draw_profile(drawing, profile, range, false);
    let at = drawing.features.point(p);
    let point = drawing.point_index(&[p]);
    let tip = Shape { path: Path::Circle { at: at.at, radius: PIN * drawing.unit }, look: Look::Roller, point };
    drawing.add_fixed(Layer::Pins, declaration, at.frame, vec![tip]);
    drawing.outlines[at.frame].is_shown = true;
}

fn cam(drawing: &mut Drawing, number: usize, [k, m]: [Profile; 2]) {
    let range = ["u", "w"].map(|part| arguments(drawing, number, part));
    let roller = roller(&drawing.features, [k, m]);
    draw_profile(drawing, k, range[0], roller == Some(0));
    draw_profile(drawing, m, range[1], roller == Some(1));
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

fn flat_follower(drawing: &mut Drawing, number: usize, profile: Profile, face: AxisId) {
    let declaration = drawing.first.joints + number;
    draw_profile(drawing, profile, arguments(drawing, number, "u"), false);
    let line = drawing.features.axis(face);
    let contact = drawing.joint_coordinate(number, "u");
    let on_face = |row: usize| {
        let position = drawing.features.on_profile(profile, contact.as_ref().map_or(f64::NAN, |u| u[row]));
        dot(line.along, minus(drawing.position_in(position, line.frame, row), line.at))
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
        let (cam, follower, touch) = match joint.features {
            _ if !joint.spec.has_contact() => return None,
            [JointFeature::Point(p), JointFeature::Profile(profile)] => {
                let tip = features.point(p);
                (carrier(profile), tip.frame, Touch::Tip(tip.at))
            }
            [JointFeature::Profile(profile), JointFeature::Axis(face)] => {
                let line = features.axis(face);
                (carrier(profile), line.frame, Touch::Face(line.at, line.along))
            }
            [JointFeature::Profile(k), JointFeature::Profile(m)] => {
                let (cam, roller, part) = if roller(features, [k, m])? == 0 { (m, k, "u") } else { (k, m, "w") };
                let argument = format!("{}.{part}", joint.declared.name);
                (carrier(cam), carrier(roller), roller_touch(features, roller, argument))
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

fn roller_touch(features: &Features, profile: Profile, argument: String) -> Touch {
    let [ahead, quarter, back] = [0.0, FRAC_PI_2, PI].map(|w| features.on_profile(profile, w).at);
    let centre = times(0.5, plus(ahead, back));
    Touch::Roller { centre, arms: [minus(ahead, centre), minus(quarter, centre)], argument }
}

/// Returns the range of a contact's argument along the motion.
fn arguments(drawing: &Drawing, number: usize, part: &str) -> Option<[f64; 2]> {
    let values = drawing.joint_coordinate(number, part)?;
    let [low, high] = drawing.range(|row| values[row]);
    (low <= high).then_some([low, high])
}

/// Draws a profile unless it is drawn already: filled if it is closed and on a body, otherwise as a line.
fn draw_profile(drawing: &mut Drawing, profile: Profile, range: Option<[f64; 2]>, is_roller: bool) {
    let before = drawing.profiles.len();
    let number = drawing.profile(profile, range);
    if number < before {
        return;
    }
    let existing = &drawing.profiles[number];
    let (frame, is_closed) = (existing.frame, existing.is_closed);
    let declaration = if frame > 0 { frame } else { existing.declaration };
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
            let positions: Vec<Vector> = existing.samples.iter().map(|sample| sample.at).collect();
            let corners = simplify(&positions, TOLERANCE * drawing.unit);
            if is_closed { Path::polygon(corners.into_iter().skip(1)) } else { Path::line(corners) }
        }
    };
    drawing.outlines[frame].is_shown |= is_filled || is_roller;
    let layer = if frame == 0 { Layer::Ground } else { Layer::Wheels };
    let (positions, is_disc) = (path.positions(), is_filled || is_roller);
    if is_disc && let Some([low, high]) = bounds(positions.iter().copied()) {
        let middle = times(0.5, plus(low, high));
        let radius = positions.iter().map(|position| distance(*position, middle)).fold(f64::INFINITY, f64::min);
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
pub(super) fn simplify(positions: &[Vector], off: f64) -> Vec<Vector> {
    if positions.len() < 3 {
        return positions.to_vec();
    }
    let mut is_kept = vec![false; positions.len()];
    let last = positions.len() - 1;
    (is_kept[0], is_kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let farthest = (from + 1..to).map(|k| (distance_to_segment(positions[k], [positions[from], positions[to]]), k));
        if let Some((away, k)) = farthest.max_by(|a, b| a.0.total_cmp(&b.0))
            && away > off
        {
            is_kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    positions.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept).map(|(position, _)| *position).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_keeps_what_matters() {
        let circle: Vec<Vector> = (0..=360).map(|k| super::super::polar(1.0, f64::from(k).to_radians())).collect();
        let corners = simplify(&circle, 1e-3);
        assert!(corners.len() < 130, "{} corners", corners.len());
        for position in &circle {
            let nearest = corners
                .windows(2)
                .map(|pair| distance_to_segment(*position, [pair[0], pair[1]]))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= 1e-3);
        }
    }
}
