//! The kinematic quantities `K(q)` (`elements.md`, "Kinematic quantities").

use super::Lowering;
use crate::expr::{ExprId, Unary};
use crate::model::{AxisId, Direction, JointId, PointId};

impl Lowering<'_> {
    /// x (part 0) or y (part 1) of a point, or from one point to another (m).
    pub(super) fn coordinate_between(&mut self, from: Option<PointId>, to: PointId, part: usize) -> ExprId {
        let end = self.global(to)[part];
        match from {
            None => end,
            Some(from) => {
                let start = self.global(from)[part];
                self.graph.sub(end, start)
            }
        }
    }

    /// Direction of a body or axis, or the angle from one to another (rad).
    pub(super) fn angle_between(&mut self, from: Option<Direction>, to: Direction) -> ExprId {
        let end = self.angle(to);
        match from {
            None => end,
            Some(from) => {
                let start = self.angle(from);
                self.graph.sub(end, start)
            }
        }
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
        let [phi_i, phi_j] = frames.map(|frame| self.frame_coordinate(frame, 2));
        let turn = self.graph.sub(phi_j, phi_i);
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
