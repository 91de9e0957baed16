//! Pins with their supports on the ground, welds, and links that are not bodies.

use super::drawing::{Drawing, Layer, shape};
use super::plane::{Path, Vector, distance, rectangle};
use super::symbols::{Symbols, THIN_BAR};
use super::{Alignment, Anchor, Attachment, Look, Node, Pin};
use mechc_lang::model::PointId;

/// Supports closer than this are one support (symbol units).
const SAME_SUPPORT: f64 = 0.3;

pub(super) fn revolute(drawing: &mut Drawing, declaration: usize, [p, q]: [PointId; 2]) {
    pin(drawing, declaration, [p, q], drawing.features.point(p));
    let (p, q) = (drawing.features.point(p), drawing.features.point(q));
    for anchor in [p, q] {
        drawing.pins.push(Pin { declaration, anchor });
        if anchor.frame == 0 {
            foot(drawing, declaration, anchor.at);
        }
    }
}

/// Adds a pin that moves with the first body, or with the second if the first is the ground.
fn pin(drawing: &mut Drawing, declaration: usize, points: [PointId; 2], at: Anchor) {
    let other = drawing.features.point(points[1]);
    let at = if at.frame == 0 { other } else { at };
    let point = drawing.point_index(&points);
    let pin = Symbols { unit: drawing.unit }.pin(at.at, point);
    drawing.add_fixed(Layer::Pins, declaration, at.frame, vec![pin]);
}

/// Adds a pin of one body; on the ground it has a support.
pub(super) fn single_pin(drawing: &mut Drawing, declaration: usize, point: PointId) {
    let at = drawing.features.point(point);
    let point = drawing.point_index(&[point]);
    let pin = Symbols { unit: drawing.unit }.pin(at.at, point);
    drawing.add_fixed(Layer::Pins, declaration, at.frame, vec![pin]);
    drawing.pins.push(Pin { declaration, anchor: at });
    if at.frame == 0 {
        foot(drawing, declaration, at.at);
    }
}

/// Adds the support of a pin on the ground, unless one is near.
fn foot(drawing: &mut Drawing, declaration: usize, at: Vector) {
    let near = SAME_SUPPORT * drawing.unit;
    if drawing.feet.iter().any(|other| distance(*other, at) <= near) {
        return;
    }
    drawing.feet.push(at);
    let shapes = Symbols { unit: drawing.unit }.foot(at);
    drawing.add_fixed(Layer::Feet, declaration, 0, shapes);
}

pub(super) fn weld(drawing: &mut Drawing, declaration: usize, [p, q]: [PointId; 2]) {
    let (first, second) = (drawing.features.point(p), drawing.features.point(q));
    let symbols = Symbols { unit: drawing.unit };
    if first.frame == 0 || second.frame == 0 {
        let at = if first.frame == 0 { first.at } else { second.at };
        foot(drawing, declaration, at);
    }
    let mut shapes = symbols.weld(first.at);
    shapes[0].point = drawing.point_index(&[p, q]);
    drawing.add_fixed(Layer::Pins, declaration, first.frame, shapes);
}

pub(super) fn massless_link(drawing: &mut Drawing, declaration: usize, [p, q]: [PointId; 2], length: f64) {
    let (from, to) = (drawing.features.point(p), drawing.features.point(q));
    let reach = THIN_BAR * drawing.unit;
    let bar = rectangle([0.5 * length, 0.0], [1.0, 0.0], 0.5 * length, reach);
    let attachment = Attachment::Between { from, to, alignment: Alignment::Start };
    drawing.add(Layer::Links, Node { declaration, attachment, shapes: vec![shape(Look::MasslessLink, bar)] });
    single_pin(drawing, declaration, p);
    single_pin(drawing, declaration, q);
}

/// Adds the symbol of a driven distance: a cylinder with its rod between two pins.
pub(super) fn cylinder(drawing: &mut Drawing, declaration: usize, [p, q]: [PointId; 2]) {
    let (from, to) = (drawing.features.point(p), drawing.features.point(q));
    let apart = |row: usize| {
        let poses = drawing.motion.poses(row);
        distance(from.position(poses), to.position(poses))
    };
    let [least, most] = drawing.range(apart);
    if !(least.is_finite() && least > 0.0) {
        return;
    }
    let symbols = Symbols { unit: drawing.unit };
    let length = 0.62 * least;
    let rod = (most - length + 0.1 * least).min(0.95 * least);
    let mut node = |alignment, shapes| {
        drawing
            .add(Layer::Links, Node { declaration, attachment: Attachment::Between { from, to, alignment }, shapes });
    };
    if length + rod < most {
        // the distance is longer than one rod can reach
        node(Alignment::Stretch, vec![shape(Look::Rod, Path::line([[0.0, 0.0], [1.0, 0.0]]))]);
    }
    node(Alignment::End, vec![symbols.rod(rod)]);
    node(Alignment::Start, vec![symbols.cylinder(length)]);
    single_pin(drawing, declaration, p);
    single_pin(drawing, declaration, q);
}
