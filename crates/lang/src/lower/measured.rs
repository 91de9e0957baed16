//! Quantities of the motion, which only measures may hold. Their words, arguments and dimensions are in the vocabulary.
//!
//! A new quantity is an entry of `QUANTITIES` in `mechc-text`, and a line in `FORMULAS` with its formula here.

use super::Lowering;
use super::velocities::{Contact, NOTHING};
use crate::model::{Frame, JointId, Measured, PartId, PointId};
use mechc_expr::{Binary, ExprId, Unary};

/// The formula of a quantity, by the name of the quantity.
struct Formula {
    name: &'static str,
    /// Returns the value (SI).
    value: Value,
    /// Returns a number that is greater than zero where the quantity exists; `None` if it always does.
    existence: Option<Value>,
    /// True if the value depends on the frame of who asks.
    is_relative: bool,
}

type Value = fn(&mut Lowering<'_>, &Measured) -> ExprId;

const FORMULAS: &[Formula] = &[
    Formula { name: "curvature", value: curvature, existence: Some(moves), is_relative: true },
    Formula { name: "pole_x", value: |l, of| pole(l, of, 0), existence: Some(turns), is_relative: true },
    Formula { name: "pole_y", value: |l, of| pole(l, of, 1), existence: Some(turns), is_relative: true },
    Formula { name: "speed", value: speed, existence: None, is_relative: true },
    Formula { name: "pressure_angle", value: pressure_angle, existence: Some(contact_moves), is_relative: true },
    Formula { name: "slip", value: slip, existence: None, is_relative: false },
];

impl Lowering<'_> {
    /// Returns the value of a quantity relative to the ground of a part.
    pub(super) fn measured(&mut self, view: Option<PartId>, of: Measured) -> ExprId {
        match formula(&of) {
            Some(Formula { value, is_relative: true, .. }) => self.relative_to(view, |l| value(l, &of)),
            Some(Formula { value, .. }) => value(self, &of),
            None => self.placeholder(),
        }
    }

    /// Returns a number that is greater than zero where a quantity exists.
    pub(super) fn measured_existence(&mut self, of: Measured) -> ExprId {
        match formula(&of).and_then(|formula| formula.existence) {
            Some(existence) => existence(self, &of),
            None => self.graph.constant(1.0),
        }
    }
}

fn formula(of: &Measured) -> Option<&'static Formula> {
    FORMULAS.iter().find(|formula| formula.name == of.word.word.name)
}

/// Returns the length of a point's velocity (m/s).
fn speed(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some(point) = of.points().next() else { return l.placeholder() };
    speed_of(l, point)
}

fn speed_of(l: &mut Lowering<'_>, point: PointId) -> ExprId {
    let at = l.position(point);
    let velocity = l.rate(at);
    l.length(velocity)
}

/// Returns the curvature of a point's path, positive to the left (1/m): `(v^⊥)ᵀ a / |v|³`.
fn curvature(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some(point) = of.points().next() else { return l.placeholder() };
    let at = l.position(point);
    let velocity = l.rate(at);
    let acceleration = l.rate(velocity);
    let (turning, speed) = (l.left_of(velocity, acceleration), l.length(velocity));
    let three = l.graph.constant(3.0);
    let cube = l.graph.pow(speed, three);
    l.graph.div(turning, cube)
}

/// Positive where a point is not at rest.
fn moves(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some(point) = of.points().next() else { return l.placeholder() };
    let speed = speed_of(l, point);
    exceeds_rest(l, speed)
}

fn exceeds_rest(l: &mut Lowering<'_>, speed: ExprId) -> ExprId {
    let slowest = NOTHING * l.largest_size / l.duration();
    l.minus_constant(speed, slowest)
}

fn two_frames(of: &Measured) -> Option<[Frame; 2]> {
    let mut frames = of.frames();
    Some([frames.next()?, frames.next()?])
}

/// Returns x (part 0) or y (part 1) of the instant centre of a frame relative to another (m): the point where their velocities are equal.
fn pole(l: &mut Lowering<'_>, of: &Measured, part: u32) -> ExprId {
    let Some([frame, from]) = two_frames(of) else { return l.placeholder() };
    let (turning, velocity) = l.relative(frame, from);
    let origin = l.frame_coordinate(frame, part);
    if part == 0 {
        let offset = l.graph.div(velocity[1], turning);
        l.graph.sub(origin, offset)
    } else {
        let offset = l.graph.div(velocity[0], turning);
        l.graph.add(origin, offset)
    }
}

/// Positive where two frames turn against each other, so that their instant centre is not too far away.
fn turns(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some([frame, from]) = two_frames(of) else { return l.placeholder() };
    let (turning, velocity) = l.relative(frame, from);
    let farthest = l.graph.constant(l.largest_size / NOTHING);
    let (turning, speed) = (l.graph.unary(Unary::Abs, turning), l.length(velocity));
    let limit = l.graph.mul(turning, farthest);
    let (is_near, rounding) = (l.graph.sub(limit, speed), l.rounding_of_turning());
    let turns = l.graph.sub(turning, rounding);
    l.graph.binary(Binary::Min, is_near, turns)
}

fn contact_and_frame(of: &Measured) -> Option<(JointId, Frame)> {
    Some((of.joints().next()?, of.frames().next()?))
}

/// Returns the angle between the common normal at a contact and the velocity of a frame's point there, 0 to π/2 (rad).
fn pressure_angle(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some((joint, frame)) = contact_and_frame(of) else { return l.placeholder() };
    let Some(Contact { at, tangent }) = l.contact(joint) else { return l.placeholder() };
    let velocity = l.point_velocity(frame, at);
    let (along, across) = (l.dot(tangent, velocity), l.left_of(tangent, velocity));
    let [along, across] = [along, across].map(|part| l.graph.unary(Unary::Abs, part));
    l.graph.binary(Binary::Atan2, along, across)
}

/// Positive where a frame's point at a contact is not at rest.
fn contact_moves(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some((joint, frame)) = contact_and_frame(of) else { return l.placeholder() };
    let Some(Contact { at, .. }) = l.contact(joint) else { return l.placeholder() };
    let velocity = l.point_velocity(frame, at);
    let speed = l.length(velocity);
    exceeds_rest(l, speed)
}

/// Returns the sliding speed of the bodies at a contact (m/s).
fn slip(l: &mut Lowering<'_>, of: &Measured) -> ExprId {
    let Some(joint) = of.joints().next() else { return l.placeholder() };
    let Some(Contact { at, tangent }) = l.contact(joint) else { return l.placeholder() };
    let [first, second] = l.model[joint].frames(l.model).map(|frame| l.point_velocity(frame, at));
    let sliding = l.difference(second, first);
    let (along, length) = (l.dot(tangent, sliding), l.length(tangent));
    let slip = l.graph.div(along, length);
    l.graph.unary(Unary::Abs, slip)
}

#[cfg(test)]
mod tests {
    use super::{FORMULAS, Formula};
    use mechc_text::vocabulary::{MOST_ARGUMENTS, QUANTITIES, QuantityArgument, QuantityWord};

    #[test]
    fn every_measured_quantity_has_its_formula() {
        for quantity in QUANTITIES {
            let Some(spec) = quantity.measured() else { continue };
            let formula = FORMULAS.iter().find(|formula| formula.name == quantity.word.name);
            let formula = formula.unwrap_or_else(|| panic!("no formula of `{}`", quantity.word.name));
            assert_eq!(formula.existence.is_some(), spec.may_not_exist, "`{}`", formula.name);
            assert!(spec.arguments.len() <= MOST_ARGUMENTS, "`{}`", formula.name);
            let left_out = spec.arguments.iter().position(|kind| *kind == QuantityArgument::BodyOrGround);
            assert!(left_out.is_none_or(|k| k + 1 == spec.arguments.len()), "`{}`", formula.name);
        }
        for Formula { name, .. } in FORMULAS {
            assert!(QuantityWord::named(name).is_some_and(|word| word.measured().is_some()), "`{name}` is no quantity");
        }
    }
}
