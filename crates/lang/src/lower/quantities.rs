//! The kinematic quantities `K(q)` (`elements.md`, "Kinematic quantities").

use super::Lowering;
use crate::model::{AxisId, Direction, Frame, JointId, PointId};
use mechc_expr::{ExprId, Unary};

impl Lowering<'_> {
    /// x (part 0) or y (part 1) of a point, or from one point to another (m).
    pub(super) fn coordinate_between(&mut self, from: Option<PointId>, to: PointId, part: usize) -> ExprId {
        let Some(from) = from else { return self.global(to)[part] };
        if self.view.is_none() {
            let (end, start) = (self.global(to)[part], self.global(from)[part]);
            return self.graph.sub(end, start);
        }
        let ends = [from, to];
        let [start, end] = self.seen_from(None, |l| ends.map(|point| l.global(point)));
        let way = self.minus(end, start);
        self.seen(way)[part]
    }

    /// Direction of a body or axis, or the angle from one to another (rad).
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

    /// How far a frame is turned from another (rad): between two that move what carries the observer has no part in it.
    fn turn(&mut self, from: Frame, to: Frame) -> ExprId {
        let view = self.view;
        let own = view.map(Frame::Part);
        if own.is_none() || own == Some(from) || own == Some(to) {
            let [start, end] = [from, to].map(|frame| self.frame_coordinate(frame, 2));
            return self.graph.sub(end, start);
        }
        let turn = self.seen_from(None, |l| l.turn(from, to));
        self.handed(view, turn)
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

    /// `√(dᵀd)` (m)
    pub(super) fn distance(&mut self, p: PointId, q: PointId) -> ExprId {
        let (p, q) = (self.global(p), self.global(q));
        let d = self.minus(q, p);
        let square = self.dot(d, d);
        self.graph.unary(Unary::Sqrt, square)
    }

    /// `(φ_j + θ_j) − (φ_i + θ_i)` (rad)
    pub(super) fn rotation(&mut self, joint: JointId, axes: Option<(AxisId, AxisId)>) -> ExprId {
        let frames = self.model[joint].kind.frames(self.model);
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

    /// `v_iᵀ d` (m)
    pub(super) fn displacement(&mut self, a: AxisId, b: AxisId) -> ExprId {
        let (origin, other) = (self.global(self.model[a].origin), self.global(self.model[b].origin));
        let d = self.minus(other, origin);
        let v = self.direction(a);
        self.dot(v, d)
    }
}
