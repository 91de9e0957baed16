//! What the features of a mechanism are in the frames of bodies, in numbers: parts' grounds are folded into what carries them.

use super::plane::{Pose, Vector, minus, plus, unit};
use super::{Anchor, Sample};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{AxisId, CircleId, Frame, Mechanism, Named, PartId, PointId, Profile};

/// A directed line of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub frame: usize,
    /// A point of it (m).
    pub at: Vector,
    /// Its direction, of length 1.
    pub along: Vector,
}

/// A circle of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub center: Anchor,
    /// (m)
    pub radius: f64,
}

/// The numbers of a mechanism's constants.
pub(super) struct Features<'m> {
    pub model: &'m Mechanism,
    values: Vec<f64>,
}

/// The argument's change over which a tangent is taken.
const SMALL: f64 = 1e-5;

impl<'m> Features<'m> {
    pub fn of(model: &'m Mechanism) -> Features<'m> {
        let mut values = Vec::new();
        model.graph.extend_values(&mut values, |symbol| parameter(model, symbol).unwrap_or(f64::NAN));
        Features { model, values }
    }

    /// A formula of parameters, in SI.
    pub fn value(&self, formula: ExprId) -> f64 {
        self.values[formula.index()]
    }

    /// The number of what carries a frame.
    pub fn frame(&self, frame: Frame) -> usize {
        number(self.model.carrier(frame))
    }

    pub fn point(&self, id: PointId) -> Anchor {
        let point = &self.model[id];
        self.placed(point.frame, point.at.map(|part| self.value(part)))
    }

    pub fn axis(&self, id: AxisId) -> Line {
        let axis = &self.model[id];
        let origin = &self.model[axis.origin];
        let start = origin.at.map(|part| self.value(part));
        let end = plus(start, axis.direction.map(|part| self.value(part)));
        let (from, to) = (self.placed(axis.frame, start), self.placed(axis.frame, end));
        Line { frame: from.frame, at: from.at, along: unit(minus(to.at, from.at)) }
    }

    pub fn circle(&self, id: CircleId) -> Disc {
        let circle = &self.model[id];
        Disc { center: self.point(circle.center), radius: self.value(circle.radius) }
    }

    /// A place of a frame, in what carries it.
    pub fn placed(&self, frame: Frame, place: Vector) -> Anchor {
        let (frame, at) = self.model.in_carrier(&|id| self.value(id), frame, place);
        Anchor { frame: number(frame), at }
    }

    /// Where the frame of a part's text is in what carries the part, and whether it is mirrored there.
    pub fn text_of(&self, part: Option<PartId>) -> (usize, Pose, bool) {
        let frame = part.map_or(Frame::Ground, Frame::Part);
        let [origin, ahead] = [[0.0, 0.0], [1.0, 0.0]].map(|place| self.placed(frame, place));
        let phi = super::plane::direction(minus(ahead.at, origin.at));
        (origin.frame, Pose { at: origin.at, phi }, self.model.is_mirrored(part))
    }

    /// A place on a profile, in what carries it; not finite where its formulas have no value.
    pub fn on_profile(&self, profile: Profile, u: f64) -> Anchor {
        match profile {
            Profile::Circle(id) => {
                let circle = &self.model[id];
                let center = self.model[circle.center].at.map(|part| self.value(part));
                self.placed(circle.frame, plus(center, super::plane::polar(self.value(circle.radius), u)))
            }
            Profile::Curve(id) => {
                let curve = &self.model[id];
                let argument = |k: u32| self.model.named[k as usize] == Named::Argument;
                let place = curve.at.map(|part| {
                    self.model.graph.value(part, |symbol| match symbol {
                        Symbol::Named(k) if argument(k) => u,
                        other => parameter(self.model, other).unwrap_or(f64::NAN),
                    })
                });
                self.placed(curve.frame, place)
            }
        }
    }

    /// A place on a profile with its tangent.
    pub fn sample(&self, profile: Profile, u: f64) -> Sample {
        let [before, at, behind] = [u - SMALL, u, u + SMALL].map(|u| self.on_profile(profile, u).at);
        let tangent = minus(behind, before).map(|way| way / (2.0 * SMALL));
        Sample { u, at, tangent }
    }
}

/// The number of a body, or of the ground.
fn number(frame: Frame) -> usize {
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

/// Where all frames are drawn, by the poses as they are written; the ground first.
#[must_use]
pub fn drawn_poses(model: &Mechanism) -> Vec<Pose> {
    let mut graph = model.graph.clone();
    let bodies: Vec<_> =
        model.body_ids().map(|body| model.drawn(&mut graph, &mut |_, e| e, None, Frame::Body(body))).collect();
    let mut values = Vec::new();
    graph.extend_values(&mut values, |symbol| parameter(model, symbol).unwrap_or(0.0));
    let value = |id: ExprId| values[id.index()];
    let pose = |place: &mechc_lang::model::Placement| Pose { at: place.at.map(value), phi: value(place.phi) };
    std::iter::once(Pose::default()).chain(bodies.iter().map(pose)).collect()
}
