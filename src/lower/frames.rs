//! Points and directions in the global frame: `r^P = r + A(φ) s'`, `v = A(φ) v'` (`elements.md`, "Notation").

use super::Lowering;
use crate::expr::{Binary, ExprId, Symbol, Unary};
use crate::model::{AxisId, Frame, PointId};

/// A vector of two expressions.
pub(super) type Vector = [ExprId; 2];

impl Lowering<'_> {
    /// A frame's coordinate: 0 for x (m), 1 for y (m), 2 for φ (rad); zero for the ground.
    pub(super) fn frame_coordinate(&mut self, frame: Frame, part: u32) -> ExprId {
        match frame {
            Frame::Ground => self.graph.constant(0.0),
            Frame::Body(body) if self.as_drawn => {
                let pose = self.model[body].pose[part as usize];
                self.formula(pose)
            }
            Frame::Body(body) => {
                let index = 3 * body.index() as u32 + part;
                self.graph.symbol(Symbol::Coordinate { index, order: 0 })
            }
        }
    }

    /// A vector fixed in a frame, turned into the global one.
    pub(super) fn turned(&mut self, frame: Frame, [x, y]: Vector) -> Vector {
        if frame == Frame::Ground {
            return [x, y];
        }
        let phi = self.frame_coordinate(frame, 2);
        let graph = &mut self.graph;
        let (cos, sin) = (graph.unary(Unary::Cos, phi), graph.unary(Unary::Sin, phi));
        let (xc, ys) = (graph.mul(x, cos), graph.mul(y, sin));
        let (xs, yc) = (graph.mul(x, sin), graph.mul(y, cos));
        [graph.sub(xc, ys), graph.add(xs, yc)]
    }

    /// A point in the global frame (m).
    pub(super) fn global(&mut self, point: PointId) -> Vector {
        let point = &self.model[point];
        let frame = point.frame;
        let local = point.at.map(|id| self.formula(id));
        self.placed(frame, local)
    }

    /// A point of a frame in the global one (m).
    pub(super) fn placed(&mut self, frame: Frame, local: Vector) -> Vector {
        let [x, y] = self.turned(frame, local);
        let origin = [0, 1].map(|part| self.frame_coordinate(frame, part));
        [self.graph.add(origin[0], x), self.graph.add(origin[1], y)]
    }

    /// An axis' unit direction in its frame.
    fn local_direction(&mut self, axis: AxisId) -> Vector {
        let [x, y] = self.model[axis].direction.map(|id| self.formula(id));
        let length = self.graph.binary(Binary::Hypot, x, y);
        [self.graph.div(x, length), self.graph.div(y, length)]
    }

    /// An axis' unit direction in the global frame.
    pub(super) fn direction(&mut self, axis: AxisId) -> Vector {
        let local = self.local_direction(axis);
        self.turned(self.model[axis].frame, local)
    }

    /// The angle θ of an axis in its frame (rad).
    pub(super) fn local_angle(&mut self, axis: AxisId) -> ExprId {
        let [x, y] = self.model[axis].direction.map(|id| self.formula(id));
        self.graph.binary(Binary::Atan2, y, x)
    }

    /// `b − a`
    pub(super) fn minus(&mut self, b: Vector, a: Vector) -> Vector {
        [self.graph.sub(b[0], a[0]), self.graph.sub(b[1], a[1])]
    }

    /// `aᵀ b`
    pub(super) fn dot(&mut self, a: Vector, b: Vector) -> ExprId {
        let (x, y) = (self.graph.mul(a[0], b[0]), self.graph.mul(a[1], b[1]));
        self.graph.add(x, y)
    }

    /// `(v^⊥)ᵀ d`, the signed distance of `d` to the left of `v`.
    pub(super) fn left_of(&mut self, v: Vector, d: Vector) -> ExprId {
        let (right, left) = (self.graph.mul(v[1], d[0]), self.graph.mul(v[0], d[1]));
        self.graph.sub(left, right)
    }
}
