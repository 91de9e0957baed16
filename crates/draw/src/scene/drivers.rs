//! Symbols of drivers: an arrow around a pin that is turned or along a moving part, a cylinder for a driven distance.

use super::drawing::{Drawing, Layer};
use super::plane::{Vector, minus, plus, times};
use super::symbols::{BLOCK, Symbols};
use super::{Anchor, Node, Place, Shape, pins};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{AxisId, Direction, EquationForm, JointKind, Mechanism, Named, Quantity};
use std::f64::consts::PI;

/// Start and end of the arrow around a pin (rad), and its radius (symbol units).
const TURN: [f64; 2] = [0.15 * PI, 0.85 * PI];
const RADIUS: f64 = 1.75;
/// Start and end of a straight arrow (symbol units).
const STRAIGHT: [f64; 2] = [1.1, 3.4];
/// A motion that returns by more than this part of its way goes to and fro.
const TO_AND_FRO: f64 = 0.02;

/// Sense of a motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Way {
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
                let apart = super::distance(from.placed(poses), to.placed(poses));
                let length = drawing.features.value(length);
                let length = if length.is_finite() { length } else { apart };
                pins::massless_link(drawing, declaration, [p, q], length);
            }
            EquationForm::Equality(left, right) if equation.driver => {
                let driven = quantity_of(model, left).or_else(|| quantity_of(model, right));
                if let Some(quantity) = driven {
                    arrow(drawing, declaration, quantity);
                }
            }
            EquationForm::Equality(..) => {}
        }
    }
}

/// Returns the first kinematic quantity of a formula.
fn quantity_of(model: &Mechanism, formula: ExprId) -> Option<Quantity> {
    model.graph.symbols_of_all(&[formula]).into_iter().find_map(|symbol| match symbol {
        Symbol::Named(k) => match model.named[k as usize] {
            Named::Quantity(_, quantity) => Some(quantity),
            _ => None,
        },
        _ => None,
    })
}

fn arrow(drawing: &mut Drawing, declaration: usize, quantity: Quantity) {
    let model = drawing.features.model;
    match quantity {
        Quantity::Rotation(joint, _) => {
            let JointKind::Revolute(p, q) = model[joint].kind else { return };
            let (p, q) = (drawing.features.point(p), drawing.features.point(q));
            turning(drawing, declaration, p, [p.frame, q.frame]);
        }
        Quantity::Angle(from, to) => {
            let frames = [from.map_or(0, |from| frame_of(drawing, from)), frame_of(drawing, to)];
            let at = pivot(drawing, frames);
            turning(drawing, declaration, at, frames);
        }
        Quantity::Displacement(_, a, b) => sliding(drawing, declaration, [a, b]),
        Quantity::X(from, to) | Quantity::Y(from, to) => {
            let axis = if matches!(quantity, Quantity::X(..)) { [1.0, 0.0] } else { [0.0, 1.0] };
            let (base, tip) = (from.map(|point| drawing.features.point(point)), drawing.features.point(to));
            let along = |row: usize| {
                let poses = drawing.motion.poses(row);
                let way = minus(tip.placed(poses), base.map_or([0.0; 2], |base| base.placed(poses)));
                super::dot(axis, way)
            };
            let way = way_of(drawing, along);
            let shapes = straight(drawing, [0.0; 2], axis, way);
            drawing.add(Layer::Arrows, Node { declaration, place: Place::Upright(tip), shapes });
        }
        _ => {}
    }
}

/// Returns the pin between the two frames of an angle.
pub(super) fn pivot_of(drawing: &Drawing, from: Option<Direction>, to: Direction) -> Anchor {
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
    let found = model.joints.iter().find_map(|joint| {
        let JointKind::Revolute(p, q) = joint.kind else { return None };
        let (p, q) = (drawing.features.point(p), drawing.features.point(q));
        if [p.frame, q.frame] == frames { Some(p) } else { ([q.frame, p.frame] == frames).then_some(q) }
    });
    let first = || drawing.outlines[frames[1]].places.first().copied().unwrap_or([0.0; 2]);
    found.unwrap_or_else(|| Anchor { frame: frames[1], at: first() })
}

/// Adds an arrow around an anchor for the rotation of one frame against another.
fn turning(drawing: &mut Drawing, declaration: usize, at: Anchor, [first, second]: [usize; 2]) {
    let turned = |row: usize| {
        let poses = drawing.motion.poses(row);
        poses[second].phi - poses[first].phi
    };
    let [from, to] = TURN;
    let (from, to, is_double) = match way_of(drawing, turned) {
        Way::Forward => (from, to, false),
        Way::Back => (to, from, false),
        Way::Both => (from, to, true),
    };
    // several drivers about one position have concentric arrows
    let taken = drawing.arrows_at(at);
    let radius = RADIUS + 0.8 * taken as f64;
    let shapes = Symbols { unit: drawing.unit }.turning([0.0; 2], radius, from, to, is_double);
    drawing.add(Layer::Arrows, Node { declaration, place: Place::Upright(at), shapes });
}

/// Adds an arrow next to a slider.
fn sliding(drawing: &mut Drawing, declaration: usize, [a, b]: [AxisId; 2]) {
    let [guide, slider] = [a, b].map(|axis| drawing.features.axis(axis));
    let origin = Anchor { frame: slider.frame, at: slider.at };
    let along = |row: usize| super::dot(guide.along, minus(drawing.seen(origin, guide.frame, row), guide.at));
    let way = way_of(drawing, along);
    // the side without hatching
    let side =
        if guide.along[0] < -1e-3 || (guide.along[0].abs() <= 1e-3 && guide.along[1] < 0.0) { -1.0 } else { 1.0 };
    let poses = drawing.motion.poses(0);
    let is_same = super::dot(poses[guide.frame].turned(guide.along), poses[slider.frame].turned(slider.along)) >= 0.0;
    let direction = if is_same { slider.along } else { times(-1.0, slider.along) };
    let beside = times(side * (BLOCK[1] + 0.6) * drawing.unit, super::left(direction));
    let start = plus(plus(slider.at, beside), times(-2.2 * drawing.unit, direction));
    let shapes = straight(drawing, start, direction, way);
    drawing.add_fixed(Layer::Arrows, declaration, slider.frame, shapes);
}

fn straight(drawing: &Drawing, from: Vector, along: Vector, way: Way) -> Vec<Shape> {
    let [begin, end] = STRAIGHT.map(|part| part * drawing.unit);
    let along = if way == Way::Back { times(-1.0, along) } else { along };
    let place = |part: f64| plus(from, times(part, along));
    Symbols { unit: drawing.unit }.arrow(place(begin), place(end), way == Way::Both)
}

/// Returns the sense in which a number changes along the motion.
fn way_of(drawing: &Drawing, of: impl Fn(usize) -> f64) -> Way {
    let values: Vec<f64> = drawing.motion.sampled(super::drawing::LOOKED_AT).map(of).collect();
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite());
    let (up, down) = steps.fold((0.0, 0.0), |(up, down): (f64, f64), step| (up + step.max(0.0), down - step.min(0.0)));
    if down <= TO_AND_FRO * up {
        Way::Forward
    } else if up <= TO_AND_FRO * down {
        Way::Back
    } else {
        Way::Both
    }
}
