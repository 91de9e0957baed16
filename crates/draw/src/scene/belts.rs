//! Belts and chains: tangents and arcs around two pulleys, which are discs.

use super::drawing::{Drawing, Layer, shape};
use super::plane::{Contour, Path, Segment, Vector, distance};
use super::{Alignment, Attachment, Look, Node, Shape, gears};
use mechc_lang::model::{CircleId, Joint};
use mechc_text::vocabulary::JointSymbol;

pub(super) fn draw(drawing: &mut Drawing, number: usize) {
    let joint = &drawing.features.model.joints[number];
    for circle in joint.circles().filter(|circle| !is_drawn(drawing, number, *circle)).collect::<Vec<_>>() {
        let disc = drawing.features.circle(circle);
        gears::disc(drawing, &disc);
    }
    let mut discs = joint.circles().map(|circle| drawing.features.circle(circle));
    let (Some(first), Some(second)) = (discs.next(), discs.next()) else { return };
    let (from, to, poses) = (first.center, second.center, drawing.motion.poses(0));
    let apart = distance(from.position(poses), to.position(poses));
    if let Some(belt) = around([first.radius, second.radius], apart, joint.has_word("crossed")) {
        let attachment = Attachment::Between { from, to, alignment: Alignment::Start };
        let declaration = drawing.first.joints + number;
        drawing.add(Layer::Slots, Node { declaration, attachment, shapes: vec![belt] });
    }
}

/// Returns whether another joint draws a circle: a gear, a rack or an earlier belt.
fn is_drawn(drawing: &Drawing, number: usize, circle: CircleId) -> bool {
    let draws = |(k, other): (usize, &Joint)| match other.spec.symbol {
        JointSymbol::Gear | JointSymbol::RingGear | JointSymbol::Rack => true,
        JointSymbol::Belt => k < number,
        _ => false,
    };
    let of_circle = |(_, other): &(usize, &Joint)| other.circles().any(|one| one == circle);
    drawing.features.model.joints.iter().enumerate().filter(of_circle).any(draws)
}

/// Returns a belt around circles whose centres are at 0 and at `apart` (m) on the x axis; `None` if it has no tangents.
pub(super) fn around([r, s]: [f64; 2], apart: f64, is_crossed: bool) -> Option<Shape> {
    // The normal of a tangent is at an angle of this cosine and sine to the line of centres.
    let side = if is_crossed { -1.0 } else { 1.0 };
    let cos = (r - side * s) / apart;
    let sin = Some(mechc_expr::math::sqrt(1.0 - cos * cos)).filter(|sin| *sin > 0.0)?;
    let on_first = |upper: f64| [r * cos, upper * r * sin];
    let on_second = |upper: f64| [apart + side * s * cos, upper * side * s * sin];
    let arc = |to: Vector, radius: f64, is_left: bool| Segment::Arc { to, radius, is_left };
    let segments = vec![
        Segment::Line(on_second(1.0)),
        arc([apart + s, 0.0], s, is_crossed),
        arc(on_second(-1.0), s, is_crossed),
        Segment::Line(on_first(-1.0)),
        arc([-r, 0.0], r, false),
        arc(on_first(1.0), r, false),
    ];
    Some(shape(Look::Belt, Path::Lines(vec![Contour { start: on_first(1.0), segments, is_closed: true }])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the ends of the tangents: the first one from its start, the second one to its end.
    fn tangents(radii: [f64; 2], is_crossed: bool) -> Option<[[Vector; 2]; 2]> {
        let Path::Lines(contours) = around(radii, 100.0, is_crossed)?.path else { return None };
        let ends: Vec<Vector> = contours[0].segments.iter().map(|segment| segment.end()).collect();
        Some([[contours[0].start, ends[0]], [ends[2], ends[3]]])
    }

    #[test]
    fn spans_touch_both_pulleys() {
        for is_crossed in [false, true] {
            let radii = [20.0, 50.0];
            for [p, q] in tangents(radii, is_crossed).expect("tangents") {
                let along = [q[0] - p[0], q[1] - p[1]];
                for (at, [x, y]) in [(0.0, p), (0.0, q), (100.0, p), (100.0, q)] {
                    let radius = if at == 0.0 { radii[0] } else { radii[1] };
                    let is_on_it = (distance([x, y], [at, 0.0]) - radius).abs() < 1e-9;
                    let is_normal = ((x - at) * along[0] + y * along[1]).abs() < 1e-6;
                    assert_eq!(is_on_it, is_normal, "{is_crossed}: {at} {x} {y}");
                }
            }
        }
    }

    #[test]
    fn pulleys_that_overlap_have_no_crossed_belt() {
        assert!(tangents([60.0, 50.0], true).is_none());
        assert!(tangents([60.0, 50.0], false).is_some());
        assert!(tangents([160.0, 50.0], false).is_none());
    }
}
