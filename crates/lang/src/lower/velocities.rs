//! Velocities and contacts, from which the quantities of measures are made, the angle at a point, and where it exists.
//!
//! A velocity is the time derivative of a position in the ground's frame, so that all formulas here follow from those of positions.

use super::Lowering;
use super::frames::Vector;
use crate::model::{Frame, JointId, PartId, PointId, Profile, Quantity};
use mechc_expr::{Binary, Comparison, ExprId, Symbol, Unary};
use mechc_ir::ConstraintSystem;
use std::f64::consts::PI;

/// Distances below this part of the mechanism's size, and speeds below this part of it per duration of the analysis, are zero; the
/// inverse is the largest distance of an instant centre, in sizes of the mechanism.
pub(super) const NOTHING: f64 = 1e-9;
/// Relative rotations up to this many roundings of the fastest motion are zero.
const ROUNDING: f64 = 64.0;

/// The point in which two bodies touch.
pub(super) struct Contact {
    /// The position in the ground's frame (m).
    pub at: Vector,
    /// A common tangent of both profiles, of any length.
    pub tangent: Vector,
}

impl Lowering<'_> {
    /// Returns the time derivative of a position or direction.
    pub(super) fn rate(&mut self, of: Vector) -> Vector {
        let rates = ConstraintSystem::time_derivatives(&mut self.graph, &of, 3);
        [rates[0], rates[1]]
    }

    pub(super) fn length(&mut self, [x, y]: Vector) -> ExprId {
        self.graph.binary(Binary::Hypot, x, y)
    }

    /// Returns the vectors from the second of three points to the two others (m).
    fn arms(&mut self, [p, q, r]: [PointId; 3]) -> [Vector; 2] {
        let [p, q, r] = [p, q, r].map(|point| self.position(point));
        [self.difference(p, q), self.difference(r, q)]
    }

    /// Returns the angle at the second of three points, from the first to the third, in (−π, π] (rad).
    pub(super) fn corner_angle(&mut self, view: Option<PartId>, points: [PointId; 3]) -> ExprId {
        let [to_p, to_r] = self.arms(points);
        let (across, along) = (self.left_of(to_p, to_r), self.dot(to_p, to_r));
        let across = self.with_handedness(view, across);
        let angle = self.graph.binary(Binary::Atan2, across, along);
        // Opposite arms stand at π, whichever sign the zero has. The angle to the opposite of the arm has the same derivatives.
        let back = self.graph.neg(along);
        let from_behind = self.graph.binary(Binary::Atan2, across, back);
        let pi = self.graph.constant(PI);
        let opposite = self.graph.sub(pi, from_behind);
        let zero = self.graph.constant(0.0);
        let on_line = self.graph.compare(Comparison::Equal, across, zero);
        let behind = self.graph.compare(Comparison::Less, along, zero);
        let is_opposite = self.graph.and(on_line, behind);
        self.graph.select(is_opposite, opposite, angle)
    }

    /// Returns the angular velocity of a frame (rad/s) and the velocity of its origin (m/s), relative to another frame.
    pub(super) fn relative(&mut self, of: Frame, from: Frame) -> (ExprId, Vector) {
        let origin = [0, 1].map(|part| self.frame_coordinate(of, part));
        let [velocity, other] = [of, from].map(|frame| self.point_velocity(frame, origin));
        let rates = [of, from].map(|frame| self.angular_velocity(frame));
        (self.graph.sub(rates[0], rates[1]), self.difference(velocity, other))
    }

    fn angular_velocity(&mut self, frame: Frame) -> ExprId {
        let phi = self.frame_coordinate(frame, 2);
        ConstraintSystem::time_derivatives(&mut self.graph, &[phi], 3)[0]
    }

    /// Returns the velocity of the point of a frame that is momentarily at a position (m/s): `ṙ + φ̇ (p − r)^⊥`.
    pub(super) fn point_velocity(&mut self, frame: Frame, place: Vector) -> Vector {
        let origin = [0, 1].map(|part| self.frame_coordinate(frame, part));
        let (velocity, turning) = (self.rate(origin), self.angular_velocity(frame));
        let [x, y] = self.difference(place, origin);
        let (across, along) = (self.graph.mul(turning, y), self.graph.mul(turning, x));
        [self.graph.sub(velocity[0], across), self.graph.add(velocity[1], along)]
    }

    /// Returns the point of contact of a follower, cam or flat follower; `None` for other joints.
    pub(super) fn contact(&mut self, joint: JointId) -> Option<Contact> {
        let on = |lowering: &mut Self, profile: Profile| {
            let frame = profile.frame(lowering.model);
            let u = lowering.contact_argument(joint);
            let local = lowering.profile_point(profile, u);
            let (at, tangent) =
                (lowering.transform_point(frame, local.at), lowering.transform_vector(frame, local.tangent));
            Contact { at, tangent }
        };
        let joined = &self.model[joint];
        let profile = joined.profiles().next().filter(|_| joined.spec.has_contact())?;
        // A face has a direction even where the curve has none.
        let face = joined.features[1].axis().map(|face| self.direction(face));
        let contact = on(self, profile);
        Some(Contact { tangent: face.unwrap_or(contact.tangent), ..contact })
    }

    /// Returns the position of a contact in the ground's frame (m).
    pub(super) fn contact_position(&mut self, joint: JointId) -> Option<Vector> {
        self.contact(joint).map(|contact| contact.at)
    }

    /// Returns the first coordinate of a joint.
    fn contact_argument(&mut self, joint: JointId) -> ExprId {
        let index = self.numbering.of_joint(joint).start;
        self.graph.symbol(Symbol::Coordinate { index, order: 0 })
    }

    /// Returns a placeholder for a quantity that a joint does not have; `check` rejects these.
    pub(super) fn placeholder(&mut self) -> ExprId {
        self.graph.constant(0.0)
    }

    /// Returns a number that is greater than zero where a quantity exists; constantly 1 for quantities that always do.
    pub(super) fn existence(&mut self, quantity: Quantity) -> ExprId {
        let length = NOTHING * self.largest_size;
        match quantity {
            Quantity::Corner(points) => {
                let arms = self.arms(points).map(|arm| self.length(arm));
                let shorter = self.graph.binary(Binary::Min, arms[0], arms[1]);
                self.minus_constant(shorter, length)
            }
            Quantity::Measured(measured) => self.measured_existence(measured),
            _ => self.graph.constant(1.0),
        }
    }

    /// Returns a bound of the rounding in a body's angular velocity (rad/s). All bodies are solved for together, so that a body at rest has
    /// the rounding of the fastest one.
    pub(super) fn rounding_of_turning(&mut self) -> ExprId {
        let mut fastest = self.graph.constant(0.0);
        for body in self.model.body_ids() {
            for (part, index) in self.numbering.pose(body).into_iter().enumerate() {
                let rate = self.graph.symbol(Symbol::Coordinate { index, order: 1 });
                let size = self.graph.unary(Unary::Abs, rate);
                let size = if part == 2 { size } else { self.per_size(size) };
                fastest = self.graph.binary(Binary::Max, fastest, size);
            }
        }
        let part = self.graph.constant(ROUNDING * f64::EPSILON);
        self.graph.mul(part, fastest)
    }

    /// Returns a speed (m/s) as the angular velocity (rad/s) of a body of the mechanism's size.
    fn per_size(&mut self, speed: ExprId) -> ExprId {
        let size = if self.largest_size > 0.0 { self.largest_size } else { 1.0 };
        let size = self.graph.constant(1.0 / size);
        self.graph.mul(size, speed)
    }

    pub(super) fn minus_constant(&mut self, value: ExprId, limit: f64) -> ExprId {
        let limit = self.graph.constant(limit);
        self.graph.sub(value, limit)
    }

    /// Returns the duration of the model's analysis (s); 1 s without one.
    pub(super) fn duration(&self) -> f64 {
        self.model.analysis.map(|analysis| analysis.to - analysis.from).filter(|length| *length > 0.0).unwrap_or(1.0)
    }
}
