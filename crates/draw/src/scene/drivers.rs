//! Symbols of drivers: an arrow around a pin that is turned or along a moving part, a cylinder for a driven distance.

use super::drawing::{Drawing, Layer};
use super::plane::{Vector, minus, plus, times};
use super::symbols::{BLOCK, Symbols};
use super::{Anchor, Attachment, Node, Shape, pins};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{AxisId, Direction, EquationForm, Mechanism, Named, Quantity};
use std::f64::consts::PI;

/// Start and end of the arrow around a pin (rad), and its radius (symbol units).
const ARC: [f64; 2] = [0.15 * PI, 0.85 * PI];
const RADIUS: f64 = 1.75;
/// Start and end of a straight arrow (symbol units).
const STRAIGHT: [f64; 2] = [1.1, 3.4];
/// A motion that returns by more than this part of its way goes to and fro.
const TO_AND_FRO: f64 = 0.02;

/// Sense of a motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Sense {
    Forward,
    Back,
    Both,
}

pub(super) fn draw(drawing: &mut Drawing) {
    let model = drawing.features.model;
    for (number, equation) in model.equations.iter().enumerate() {
        let declaration = drawing.first.equations + number;
        match equation.form {
            EquationForm::Distance(p, q, _) if equation.driver => pins::cylinder(drawing, declaration, [p, q]),
            EquationForm::Distance(p, q, length) => {
                let (from, to) = (drawing.features.point(p), drawing.features.point(q));
                let poses = drawing.motion.poses(0);
                let apart = super::distance(from.position(poses), to.position(poses));
                let length = drawing.features.value(length);
                let length = if length.is_finite() { length } else { apart };
                pins::massless_link(drawing, declaration, [p, q], length);
            }
            EquationForm::Equality(left, right) if equation.driver => {
                let driven = first_quantity(model, left).or_else(|| first_quantity(model, right));
                if let Some(quantity) = driven {
                    add_arrow(drawing, declaration, quantity);
                }
            }
            EquationForm::Equality(..) => {}
        }
    }
}

/// Returns the first kinematic quantity of a formula.
fn first_quantity(model: &Mechanism, formula: ExprId) -> Option<Quantity> {
    model.graph.symbols_of_all(&[formula]).into_iter().find_map(|symbol| match symbol {
        Symbol::Named(k) => match model.named[k as usize] {
            Named::Quantity(_, quantity) => Some(quantity),
            _ => None,
        },
        _ => None,
    })
}

fn add_arrow(drawing: &mut Drawing, declaration: usize, quantity: Quantity) {
    let model = drawing.features.model;
    match quantity {
        Quantity::Rotation(joint, _) => {
            let Some([p, q]) = model[joint].pin() else { return };
            let (p, q) = (drawing.features.point(p), drawing.features.point(q));
            add_arc_arrow(drawing, declaration, p, [p.frame, q.frame]);
        }
        Quantity::Angle(from, to) => {
            let frames = [from.map_or(0, |from| frame_of(drawing, from)), frame_of(drawing, to)];
            let at = pivot(drawing, frames);
            add_arc_arrow(drawing, declaration, at, frames);
        }
        Quantity::Displacement(_, a, b) => add_slider_arrow(drawing, declaration, [a, b]),
        Quantity::X(from, to) | Quantity::Y(from, to) => {
            let axis = if matches!(quantity, Quantity::X(..)) { [1.0, 0.0] } else { [0.0, 1.0] };
            let (base, tip) = (from.map(|point| drawing.features.point(point)), drawing.features.point(to));
            let along = |row: usize| {
                let poses = drawing.motion.poses(row);
                let vector = minus(tip.position(poses), base.map_or([0.0; 2], |base| base.position(poses)));
                super::dot(axis, vector)
            };
            let sense = sense_of(drawing, along);
            let shapes = straight_arrow(drawing, [0.0; 2], axis, sense);
            drawing.add(Layer::Arrows, Node { declaration, attachment: Attachment::Upright(tip), shapes });
        }
        _ => {}
    }
}

/// Returns the pin between the two frames of an angle.
pub(super) fn angle_pivot(drawing: &Drawing, from: Option<Direction>, to: Direction) -> Anchor {
    pivot(drawing, [from.map_or(0, |from| frame_of(drawing, from)), frame_of(drawing, to)])
}

/// Returns the frame of a direction.
pub(super) fn frame_of(drawing: &Drawing, direction: Direction) -> usize {
    match direction {
        Direction::Frame(frame) => drawing.features.frame(frame),
        Direction::Axis(axis) => drawing.features.axis(axis).frame,
    }
}

/// Returns the pin between two frames, or the first position of the second frame.
fn pivot(drawing: &Drawing, frames: [usize; 2]) -> Anchor {
    let model = drawing.features.model;
    let pin = model.joints.iter().find_map(|joint| {
        let [p, q] = joint.pin()?.map(|point| drawing.features.point(point));
        if [p.frame, q.frame] == frames { Some(p) } else { ([q.frame, p.frame] == frames).then_some(q) }
    });
    let first = || drawing.outlines[frames[1]].positions.first().copied().unwrap_or([0.0; 2]);
    pin.unwrap_or_else(|| Anchor { frame: frames[1], at: first() })
}

/// Adds an arrow around an anchor for the rotation of one frame against another.
fn add_arc_arrow(drawing: &mut Drawing, declaration: usize, at: Anchor, [first, second]: [usize; 2]) {
    let angle = |row: usize| {
        let poses = drawing.motion.poses(row);
        poses[second].phi - poses[first].phi
    };
    let [from, to] = ARC;
    let (from, to, is_double) = match sense_of(drawing, angle) {
        Sense::Forward => (from, to, false),
        Sense::Back => (to, from, false),
        Sense::Both => (from, to, true),
    };
    // several drivers about one position have concentric arrows
    let count = drawing.arrows_at(at);
    let radius = RADIUS + 0.8 * count as f64;
    let shapes = Symbols { unit: drawing.unit }.arc_arrow([0.0; 2], radius, from, to, is_double);
    drawing.add(Layer::Arrows, Node { declaration, attachment: Attachment::Upright(at), shapes });
}

/// Adds an arrow next to a slider.
fn add_slider_arrow(drawing: &mut Drawing, declaration: usize, [a, b]: [AxisId; 2]) {
    let [guide, slider] = [a, b].map(|axis| drawing.features.axis(axis));
    let origin = Anchor { frame: slider.frame, at: slider.at };
    let along = |row: usize| super::dot(guide.along, minus(drawing.position_in(origin, guide.frame, row), guide.at));
    let sense = sense_of(drawing, along);
    // the side without hatching
    let side =
        if guide.along[0] < -1e-3 || (guide.along[0].abs() <= 1e-3 && guide.along[1] < 0.0) { -1.0 } else { 1.0 };
    let poses = drawing.motion.poses(0);
    let has_same_sense =
        super::dot(poses[guide.frame].rotate(guide.along), poses[slider.frame].rotate(slider.along)) >= 0.0;
    let direction = if has_same_sense { slider.along } else { times(-1.0, slider.along) };
    let lateral = times(side * (BLOCK[1] + 0.6) * drawing.unit, super::left(direction));
    let start = plus(plus(slider.at, lateral), times(-2.2 * drawing.unit, direction));
    let shapes = straight_arrow(drawing, start, direction, sense);
    drawing.add_fixed(Layer::Arrows, declaration, slider.frame, shapes);
}

fn straight_arrow(drawing: &Drawing, from: Vector, along: Vector, sense: Sense) -> Vec<Shape> {
    let [begin, end] = STRAIGHT.map(|part| part * drawing.unit);
    let along = if sense == Sense::Back { times(-1.0, along) } else { along };
    let position = |part: f64| plus(from, times(part, along));
    Symbols { unit: drawing.unit }.arrow(position(begin), position(end), sense == Sense::Both)
}

/// Returns the sense in which a number changes along the motion.
fn sense_of(drawing: &Drawing, of: impl Fn(usize) -> f64) -> Sense {
    let values: Vec<f64> = drawing.motion.sampled(super::drawing::SAMPLED_ROWS).map(of).collect();
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite());
    let (up, down) = steps.fold((0.0, 0.0), |(up, down): (f64, f64), step| (up + step.max(0.0), down - step.min(0.0)));
    if down <= TO_AND_FRO * up {
        Sense::Forward
    } else if up <= TO_AND_FRO * down {
        Sense::Back
    } else {
        Sense::Both
    }
}
