//! Features of a mechanism as numbers in the frames of bodies. The grounds of parts are resolved to the frames that carry them.

use super::plane::{Pose, Vector, minus, plus, unit};
use super::{Anchor, Sample};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{AxisId, CircleId, Frame, Joint, Mechanism, Named, PartId, PointId, Profile};

/// A directed line of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub frame: usize,
    /// Point on the line (m).
    pub at: Vector,
    /// Direction, of length 1.
    pub along: Vector,
}

/// A circle of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub center: Anchor,
    /// Radius (m).
    pub radius: f64,
}

/// The ground of a part.
pub(super) struct PartFrame {
    /// Frame that carries the part.
    pub frame: usize,
    /// Pose in that frame.
    pub pose: Pose,
    pub is_mirrored: bool,
}

/// A mechanism with the values of its formulas of parameters.
pub(super) struct Features<'m> {
    pub model: &'m Mechanism,
    values: Vec<f64>,
}

/// Step of the argument for the difference quotient of a tangent.
const STEP: f64 = 1e-5;

impl<'m> Features<'m> {
    pub fn new(model: &'m Mechanism) -> Features<'m> {
        let mut values = Vec::new();
        model.graph.extend_values(&mut values, |symbol| parameter(model, symbol).unwrap_or(f64::NAN));
        Features { model, values }
    }

    /// Returns the value of a formula of parameters, in SI.
    pub fn value(&self, formula: ExprId) -> f64 {
        self.values[formula.index()]
    }

    /// Returns the value of a joint (m or rad) in the handedness of the ground, or 0 if it has none.
    pub fn signed_value(&self, joint: &Joint) -> f64 {
        let value = joint.value().map_or(0.0, |value| self.value(value));
        if self.model.is_mirrored(joint.part) { -value } else { value }
    }

    /// Returns the index of the frame that carries a frame.
    pub fn frame(&self, frame: Frame) -> usize {
        frame_index(self.model.carrier(frame))
    }

    pub fn point(&self, id: PointId) -> Anchor {
        let point = &self.model[id];
        self.resolve(point.frame, point.at.map(|part| self.value(part)))
    }

    pub fn axis(&self, id: AxisId) -> Line {
        let axis = &self.model[id];
        let origin = &self.model[axis.origin];
        let start = origin.at.map(|part| self.value(part));
        let end = plus(start, axis.direction.map(|part| self.value(part)));
        let (from, to) = (self.resolve(axis.frame, start), self.resolve(axis.frame, end));
        Line { frame: from.frame, at: from.at, along: unit(minus(to.at, from.at)) }
    }

    pub fn circle(&self, id: CircleId) -> Disc {
        let circle = &self.model[id];
        Disc { center: self.point(circle.center), radius: self.value(circle.radius) }
    }

    /// Converts a position of a frame to the frame that carries it.
    pub fn resolve(&self, frame: Frame, position: Vector) -> Anchor {
        let (frame, at) = self.model.in_carrier(&|id| self.value(id), frame, position);
        Anchor { frame: frame_index(frame), at }
    }

    /// Returns the ground of a part in the frame that carries it.
    pub fn part_frame(&self, part: Option<PartId>) -> PartFrame {
        let frame = part.map_or(Frame::Ground, Frame::Part);
        let [origin, ahead] = [[0.0, 0.0], [1.0, 0.0]].map(|position| self.resolve(frame, position));
        let phi = super::plane::direction(minus(ahead.at, origin.at));
        PartFrame { frame: origin.frame, pose: Pose { at: origin.at, phi }, is_mirrored: self.model.is_mirrored(part) }
    }

    /// Returns the position on a profile in the frame that carries it; not finite where its formulas have no value.
    pub fn on_profile(&self, profile: Profile, u: f64) -> Anchor {
        match profile {
            Profile::Circle(id) => {
                let circle = &self.model[id];
                let center = self.model[circle.center].at.map(|part| self.value(part));
                self.resolve(circle.frame, plus(center, super::plane::polar(self.value(circle.radius), u)))
            }
            Profile::Curve(id) => {
                let curve = &self.model[id];
                let argument = |k: u32| self.model.named[k as usize] == Named::Argument;
                let position = curve.at.map(|part| {
                    self.model.graph.value(part, |symbol| match symbol {
                        Symbol::Named(k) if argument(k) => u,
                        other => parameter(self.model, other).unwrap_or(f64::NAN),
                    })
                });
                self.resolve(curve.frame, position)
            }
        }
    }

    /// Returns the position on a profile with its tangent.
    pub fn sample(&self, profile: Profile, u: f64) -> Sample {
        let [before, at, after] = [u - STEP, u, u + STEP].map(|u| self.on_profile(profile, u).at);
        let tangent = minus(after, before).map(|difference| difference / (2.0 * STEP));
        Sample { u, at, tangent }
    }
}

/// Returns the index of a body, or 0 for the ground.
fn frame_index(frame: Frame) -> usize {
    match frame {
        Frame::Body(body) => body.index() + 1,
        Frame::Ground | Frame::Part(_) => 0,
    }
}

fn parameter(model: &Mechanism, symbol: Symbol) -> Option<f64> {
    match symbol {
        Symbol::Param(k) => model.params.get(k as usize).map(|param| param.value),
        Symbol::Shift(_) => Some(0.0),
        _ => None,
    }
}

/// Returns the poses of all frames as the text draws them, the ground first.
#[must_use]
pub fn drawn_poses(model: &Mechanism) -> Vec<Pose> {
    let mut graph = model.graph.clone();
    let bodies: Vec<_> =
        model.body_ids().map(|body| model.drawn(&mut graph, &mut |_, e| e, None, Frame::Body(body))).collect();
    let mut values = Vec::new();
    graph.extend_values(&mut values, |symbol| parameter(model, symbol).unwrap_or(0.0));
    let value = |id: ExprId| values[id.index()];
    let pose =
        |placement: &mechc_lang::model::Placement| Pose { at: placement.at.map(value), phi: value(placement.phi) };
    std::iter::once(Pose::default()).chain(bodies.iter().map(pose)).collect()
}
