//! Quantities of measures that speak of velocities and accelerations, and the angle at a point; with where they exist.
//!
//! A velocity is the time derivative of a place as it is seen from the ground, so that all of these follow from the formulas of
//! places, and their own derivatives from them.

use super::Lowering;
use super::frames::Vector;
use crate::model::{Frame, JointId, JointKind, PartId, PointId, Profile, Quantity};
use mechc_expr::{Binary, Comparison, ExprId, Symbol, Unary};
use mechc_ir::ConstraintSystem;
use mechc_ir::tolerances::determinacy::velocities::{NOTHING, ROUNDING};
use std::f64::consts::PI;

/// Where two bodies touch.
struct Contact {
    /// In the ground's frame (m).
    at: Vector,
    /// Along both lines; of any length.
    tangent: Vector,
}

impl Lowering<'_> {
    /// The time derivative of a place or direction.
    fn rate(&mut self, of: Vector) -> Vector {
        let rates = ConstraintSystem::time_derivatives(&mut self.graph, &of, 3);
        [rates[0], rates[1]]
    }

    pub(super) fn length(&mut self, [x, y]: Vector) -> ExprId {
        self.graph.binary(Binary::Hypot, x, y)
    }

    /// The length of a point's velocity (m/s).
    pub(super) fn speed(&mut self, point: PointId) -> ExprId {
        let at = self.global(point);
        let velocity = self.rate(at);
        self.length(velocity)
    }

    /// Of a point's path, positive to the left (1/m): `(v^⊥)ᵀ a / |v|³`
    pub(super) fn path_curvature(&mut self, point: PointId) -> ExprId {
        let at = self.global(point);
        let velocity = self.rate(at);
        let acceleration = self.rate(velocity);
        let (turning, speed) = (self.left_of(velocity, acceleration), self.length(velocity));
        let three = self.graph.constant(3.0);
        let cube = self.graph.pow(speed, three);
        self.graph.div(turning, cube)
    }

    /// From one point to two others (m).
    fn arms(&mut self, [p, q, r]: [PointId; 3]) -> [Vector; 2] {
        let [p, q, r] = [p, q, r].map(|point| self.global(point));
        [self.minus(p, q), self.minus(r, q)]
    }

    /// The angle at the second of three points, from the first to the third, in (−π, π] (rad).
    pub(super) fn corner(&mut self, view: Option<PartId>, points: [PointId; 3]) -> ExprId {
        let [to_p, to_r] = self.arms(points);
        let (across, along) = (self.left_of(to_p, to_r), self.dot(to_p, to_r));
        let across = self.handed(view, across);
        let angle = self.graph.binary(Binary::Atan2, across, along);
        // opposite to each other they stand at π, with either zero; seen from behind it has the same derivatives
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

    /// How fast a frame turns (rad/s), and the velocity of its origin (m/s), as seen from another.
    fn relative(&mut self, of: Frame, from: Frame) -> (ExprId, Vector) {
        let origin = [0, 1].map(|part| self.frame_coordinate(of, part));
        let [own, other] = [of, from].map(|frame| self.point_velocity(frame, origin));
        let rates = [of, from].map(|frame| self.turning(frame));
        (self.graph.sub(rates[0], rates[1]), self.minus(own, other))
    }

    fn turning(&mut self, frame: Frame) -> ExprId {
        let phi = self.frame_coordinate(frame, 2);
        ConstraintSystem::time_derivatives(&mut self.graph, &[phi], 3)[0]
    }

    /// The velocity of the point of a frame that is at a place now (m/s): `ṙ + φ̇ (p − r)^⊥`
    fn point_velocity(&mut self, frame: Frame, place: Vector) -> Vector {
        let origin = [0, 1].map(|part| self.frame_coordinate(frame, part));
        let (velocity, turning) = (self.rate(origin), self.turning(frame));
        let [x, y] = self.minus(place, origin);
        let (across, along) = (self.graph.mul(turning, y), self.graph.mul(turning, x));
        [self.graph.sub(velocity[0], across), self.graph.add(velocity[1], along)]
    }

    /// x (part 0) or y (part 1) of the instant centre of a frame relative to another (m): where their points have one velocity.
    pub(super) fn pole(&mut self, of: Frame, from: Frame, part: u32) -> ExprId {
        let (turning, velocity) = self.relative(of, from);
        let origin = self.frame_coordinate(of, part);
        let graph = &mut self.graph;
        if part == 0 {
            let way = graph.div(velocity[1], turning);
            graph.sub(origin, way)
        } else {
            let way = graph.div(velocity[0], turning);
            graph.add(origin, way)
        }
    }

    /// Where a follower, cam or flat follower touches; a joint of another kind touches nowhere.
    fn contact(&mut self, joint: JointId) -> Option<Contact> {
        let on = |lowering: &mut Self, profile: Profile| {
            let frame = profile.frame(lowering.model);
            let u = lowering.contact_argument(joint);
            let local = lowering.local(profile, u);
            let (at, tangent) = (lowering.placed(frame, local.at), lowering.turned(frame, local.tangent));
            Contact { at, tangent }
        };
        match self.model[joint].kind {
            JointKind::PointFollower(_, profile) | JointKind::Cam(profile, _) => Some(on(self, profile)),
            JointKind::FlatFollower(profile, face) => {
                // the face has a direction where the curve has none
                let tangent = self.direction(face);
                Some(Contact { tangent, ..on(self, profile) })
            }
            _ => None,
        }
    }

    /// The place of a contact in the ground's frame (m).
    pub(super) fn contact_place(&mut self, joint: JointId) -> Option<Vector> {
        self.contact(joint).map(|contact| contact.at)
    }

    /// The first coordinate that a joint brings along.
    fn contact_argument(&mut self, joint: JointId) -> ExprId {
        let index = self.numbering.own(joint).start;
        self.graph.symbol(Symbol::Coordinate { index, order: 0 })
    }

    /// Between the common normal at a contact and the velocity of a frame's point there, 0 to 90° (rad).
    pub(super) fn pressure_angle(&mut self, joint: JointId, frame: Frame) -> ExprId {
        let Some(Contact { at, tangent }) = self.contact(joint) else { return self.nothing() };
        let velocity = self.point_velocity(frame, at);
        let (along, across) = (self.dot(tangent, velocity), self.left_of(tangent, velocity));
        let [along, across] = [along, across].map(|part| self.graph.unary(Unary::Abs, part));
        self.graph.binary(Binary::Atan2, along, across)
    }

    /// The speed at which the bodies of a contact slide on each other (m/s).
    pub(super) fn slip(&mut self, joint: JointId) -> ExprId {
        let Some(Contact { at, tangent }) = self.contact(joint) else { return self.nothing() };
        let [first, second] = self.model[joint].kind.frames(self.model).map(|frame| self.point_velocity(frame, at));
        let sliding = self.minus(second, first);
        let (along, length) = (self.dot(tangent, sliding), self.length(tangent));
        let slip = self.graph.div(along, length);
        self.graph.unary(Unary::Abs, slip)
    }

    /// What is asked of a joint that does not have it; `check` refuses that.
    fn nothing(&mut self) -> ExprId {
        self.graph.constant(0.0)
    }

    /// What is above zero where a quantity exists; none for those that always do.
    pub(super) fn existence(&mut self, quantity: Quantity) -> ExprId {
        let length = NOTHING * self.largest_size;
        match quantity {
            Quantity::Corner(points) => {
                let arms = self.arms(points).map(|arm| self.length(arm));
                let shorter = self.graph.binary(Binary::Min, arms[0], arms[1]);
                self.beyond(shorter, length)
            }
            Quantity::Curvature(point) => {
                let speed = self.speed(point);
                self.beyond(speed, length / self.duration())
            }
            Quantity::PressureAngle(joint, frame) => {
                let Some(Contact { at, .. }) = self.contact(joint) else { return self.nothing() };
                let velocity = self.point_velocity(frame, at);
                let speed = self.length(velocity);
                self.beyond(speed, length / self.duration())
            }
            Quantity::Pole(of, from, _) => {
                let (turning, velocity) = self.relative(of, from);
                let farthest = self.graph.constant(self.largest_size / NOTHING);
                let (turning, speed) = (self.graph.unary(Unary::Abs, turning), self.length(velocity));
                let limit = self.graph.mul(turning, farthest);
                let (is_near, rounding) = (self.graph.sub(limit, speed), self.rounding_of_turning());
                let turns = self.graph.sub(turning, rounding);
                self.graph.binary(Binary::Min, is_near, turns)
            }
            _ => self.graph.constant(1.0),
        }
    }

    /// What rounding may make of how fast a body turns (rad/s): all bodies are solved for together, so that one that rests has the rounding of
    /// the fastest.
    fn rounding_of_turning(&mut self) -> ExprId {
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

    /// A speed (m/s) as the turning (rad/s) of something as large as the mechanism.
    fn per_size(&mut self, speed: ExprId) -> ExprId {
        let size = if self.largest_size > 0.0 { self.largest_size } else { 1.0 };
        let size = self.graph.constant(1.0 / size);
        self.graph.mul(size, speed)
    }

    fn beyond(&mut self, value: ExprId, limit: f64) -> ExprId {
        let limit = self.graph.constant(limit);
        self.graph.sub(value, limit)
    }

    /// How long the file's analysis takes (s); a second without one.
    fn duration(&self) -> f64 {
        self.model.analysis.map(|analysis| analysis.to - analysis.from).filter(|length| *length > 0.0).unwrap_or(1.0)
    }
}
