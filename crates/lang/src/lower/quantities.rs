//! Kinematic quantities `K(q)` of positions (`elements.md`, "Kinematic quantities").

use super::Lowering;
use crate::model::{AxisId, Direction, Frame, JointId, PointId};
use mechc_expr::{ExprId, Unary};

impl Lowering<'_> {
    /// Returns x (part 0) or y (part 1) of a point, or from one point to another (m).
    pub(super) fn coordinate_between(&mut self, from: Option<PointId>, to: PointId, part: usize) -> ExprId {
        let Some(from) = from else { return self.position(to)[part] };
        if self.view.is_none() {
            let (end, start) = (self.position(to)[part], self.position(from)[part]);
            return self.graph.sub(end, start);
        }
        let ends = [from, to];
        let [start, end] = self.relative_to(None, |l| ends.map(|point| l.position(point)));
        let offset = self.difference(end, start);
        self.vector_in_view(offset)[part]
    }

    /// Returns the direction of a body or axis, or the angle from one to another (rad).
    pub(super) fn angle_between(&mut self, from: Option<Direction>, to: Direction) -> ExprId {
        let Some(from) = from else { return self.angle(to) };
        if self.view.is_none() {
            let (end, start) = (self.angle(to), self.angle(from));
            return self.graph.sub(end, start);
        }
        let turn = self.turn(self.frame_of(from), self.frame_of(to));
        let [start, end] = [from, to].map(|direction| match direction {
            Direction::Frame(_) => self.graph.constant(0.0),
            Direction::Axis(axis) => self.local_angle(axis),
        });
        let theta = self.graph.sub(end, start);
        self.graph.add(turn, theta)
    }

    fn frame_of(&self, direction: Direction) -> Frame {
        match direction {
            Direction::Frame(frame) => frame,
            Direction::Axis(axis) => self.model[axis].frame,
        }
    }

    /// Returns the angle from one frame to another (rad). The view only decides its sign.
    fn turn(&mut self, from: Frame, to: Frame) -> ExprId {
        let view = self.view;
        let observer = view.map(Frame::Part);
        if observer.is_none() || observer == Some(from) || observer == Some(to) {
            let [start, end] = [from, to].map(|frame| self.frame_coordinate(frame, 2));
            return self.graph.sub(end, start);
        }
        let turn = self.relative_to(None, |l| l.turn(from, to));
        self.with_handedness(view, turn)
    }

    fn angle(&mut self, direction: Direction) -> ExprId {
        match direction {
            Direction::Frame(frame) => self.frame_coordinate(frame, 2),
            Direction::Axis(axis) => {
                let phi = self.frame_coordinate(self.model[axis].frame, 2);
                let theta = self.local_angle(axis);
                self.graph.add(phi, theta)
            }
        }
    }

    /// Returns `√(dᵀd)` (m).
    pub(super) fn distance(&mut self, p: PointId, q: PointId) -> ExprId {
        let (p, q) = (self.position(p), self.position(q));
        let d = self.difference(q, p);
        let square = self.dot(d, d);
        self.graph.unary(Unary::Sqrt, square)
    }

    /// Returns `(φ_j + θ_j) − (φ_i + θ_i)` (rad).
    pub(super) fn rotation(&mut self, joint: JointId, axes: Option<(AxisId, AxisId)>) -> ExprId {
        let frames = self.model[joint].frames(self.model);
        let turn = self.turn(frames[0], frames[1]);
        match axes {
            None => turn,
            Some((u, v)) => {
                let (theta_i, theta_j) = (self.local_angle(u), self.local_angle(v));
                let theta = self.graph.sub(theta_j, theta_i);
                self.graph.add(turn, theta)
            }
        }
    }

    /// Returns `v_iᵀ d` (m).
    pub(super) fn displacement(&mut self, a: AxisId, b: AxisId) -> ExprId {
        let (origin, other) = (self.position(self.model[a].origin), self.position(self.model[b].origin));
        let d = self.difference(other, origin);
        let v = self.direction(a);
        self.dot(v, d)
    }
}
