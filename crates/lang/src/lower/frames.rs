//! Points and directions relative to the ground or to a part, the *view*: `r^P = r + A(φ) s'`, `v = A(φ) v'` (`elements.md`, "Notation").

use super::Lowering;
use crate::model::{Axis, AxisId, Frame, Mechanism, PartId, Placement, PointId};
use mechc_expr::{Binary, Comparison, ExprId, Symbol, Unary};

/// A vector of two expressions.
pub(super) type Vector = [ExprId; 2];

impl Lowering<'_> {
    /// Runs `work` with positions relative to the ground of a part, or to the ground.
    pub(super) fn relative_to<T>(&mut self, view: Option<PartId>, work: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.view, view);
        let result = work(self);
        self.view = outer;
        result
    }

    /// Returns whether a frame's coordinates need no transformation: the view is the ground, and the frame belongs to no part.
    fn is_plain(&self, frame: Frame) -> bool {
        self.view.is_none() && self.model.part_of(frame).is_none()
    }

    /// Returns a frame's coordinate in the view: 0 for x (m), 1 for y (m), 2 for φ (rad). Those of the ground are zero.
    pub(super) fn frame_coordinate(&mut self, frame: Frame, part: u32) -> ExprId {
        match frame {
            Frame::Ground if self.view.is_none() => self.graph.constant(0.0),
            Frame::Body(body) if self.as_drawn && self.is_plain(frame) => {
                let pose = self.model[body].pose[part as usize];
                self.formula(pose)
            }
            Frame::Body(body) if !self.as_drawn && self.view.is_none() => {
                let index = self.numbering.pose(body)[part as usize];
                self.graph.symbol(Symbol::Coordinate { index, order: 0 })
            }
            _ => {
                let Placement { at, phi, .. } = self.placement(frame);
                [at[0], at[1], phi][part as usize]
            }
        }
    }

    /// Returns the placement of a frame in the view.
    fn placement(&mut self, frame: Frame) -> Placement {
        let Some(view) = self.view else {
            return if self.as_drawn { self.drawn(None, frame) } else { self.absolute(frame) };
        };
        if self.as_drawn {
            return self.drawn(Some(view), frame);
        }
        if frame == Frame::Part(view) {
            return Placement::identity(&mut self.graph);
        }
        if let Frame::Part(part) = frame
            && self.stands_on(self.model[part].mount, view)
        {
            let mount = self.placement(self.model[part].mount);
            return self.on_mount(part, mount, Some(view));
        }
        let (inner, base) = (self.absolute(frame), self.absolute(Frame::Part(view)));
        let offset = self.difference(inner.at, base.at);
        let at = base.turned_back(&mut self.graph, offset);
        let turn = self.graph.sub(inner.phi, base.phi);
        let phi = base.angle(&mut self.graph, turn);
        Placement { at, phi, is_mirrored: inner.is_mirrored != base.is_mirrored }
    }

    /// Returns whether a frame is fixed to the ground of a part by mounts alone.
    fn stands_on(&self, mut frame: Frame, view: PartId) -> bool {
        while let Frame::Part(part) = frame {
            if part == view {
                return true;
            }
            frame = self.model[part].mount;
        }
        false
    }

    /// Returns the placement of a frame in the ground's frame.
    pub(super) fn absolute(&mut self, frame: Frame) -> Placement {
        match frame {
            Frame::Ground => Placement::identity(&mut self.graph),
            Frame::Body(body) => {
                let pose = self.numbering.pose(body);
                let [x, y, phi] = pose.map(|index| self.graph.symbol(Symbol::Coordinate { index, order: 0 }));
                let is_mirrored = self.model.is_mirrored(self.model[body].part);
                Placement { at: [x, y], phi, is_mirrored }
            }
            Frame::Part(part) => {
                let mount = self.absolute(self.model[part].mount);
                self.on_mount(part, mount, None)
            }
        }
    }

    /// Returns the placement of a frame in the right-handed frame of the body that carries it, as tables use it.
    pub(super) fn in_carrier(&mut self, frame: Frame) -> Placement {
        match frame {
            Frame::Part(part) => {
                let mount = self.in_carrier(self.model[part].mount);
                self.on_mount(part, mount, None)
            }
            Frame::Ground | Frame::Body(_) => {
                let is_mirrored = self.model.is_mirrored(self.model.part_of(frame));
                Placement { is_mirrored, ..Placement::identity(&mut self.graph) }
            }
        }
    }

    /// Returns the placement in a view of a part's ground, from that of its mount.
    fn on_mount(&mut self, part: PartId, mount: Placement, view: Option<PartId>) -> Placement {
        let model = self.model;
        let part = &model[part];
        // The mount has the handedness of the text that declares the part, as everything in that text.
        let is_mirrored = model.is_mirrored(part.within) != model.is_mirrored(view);
        let (imported, inputs, named) = (&mut self.imported, &self.options.inputs, &self.named);
        let mut formula = |graph: &mut _, id| imported.formula(graph, model, inputs, named, id);
        Mechanism::on_mount(&mut self.graph, &mut formula, Placement { is_mirrored, ..mount }, part)
    }

    /// Returns the drawn placement of a frame in that of a part or of the ground.
    pub(super) fn drawn(&mut self, within: Option<PartId>, frame: Frame) -> Placement {
        let model = self.model;
        let (imported, inputs, named) = (&mut self.imported, &self.options.inputs, &self.named);
        let mut formula = |graph: &mut _, id| imported.formula(graph, model, inputs, named, id);
        model.drawn(&mut self.graph, &mut formula, within, frame)
    }

    /// Returns a vector of a frame in the view.
    pub(super) fn transform_vector(&mut self, frame: Frame, [x, y]: Vector) -> Vector {
        if !self.is_plain(frame) {
            let placement = self.placement(frame);
            return placement.turned(&mut self.graph, [x, y]);
        }
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

    /// Returns the position of a point in the view (m).
    pub(super) fn position(&mut self, point: PointId) -> Vector {
        let point = &self.model[point];
        let frame = point.frame;
        let local = point.at.map(|id| self.formula(id));
        self.transform_point(frame, local)
    }

    /// Returns a point of a frame in the view (m).
    pub(super) fn transform_point(&mut self, frame: Frame, local: Vector) -> Vector {
        let [x, y] = self.transform_vector(frame, local);
        let origin = [0, 1].map(|part| self.frame_coordinate(frame, part));
        [self.graph.add(origin[0], x), self.graph.add(origin[1], y)]
    }

    /// Returns a vector of the ground's frame in the view.
    pub(super) fn vector_in_view(&mut self, vector: Vector) -> Vector {
        let Some(view) = self.view else { return vector };
        let base = self.absolute(Frame::Part(view));
        base.turned_back(&mut self.graph, vector)
    }

    /// Returns a signed value of the ground's frame with the sign of a part's handedness.
    pub(super) fn with_handedness(&mut self, part: Option<PartId>, value: ExprId) -> ExprId {
        if self.model.is_mirrored(part) { self.graph.neg(value) } else { value }
    }

    /// Returns the unit direction of an axis in its frame.
    pub(super) fn unit_direction(&mut self, axis: &Axis) -> Vector {
        let [x, y] = axis.direction.map(|id| self.formula(id));
        let length = self.graph.binary(Binary::Hypot, x, y);
        [self.graph.div(x, length), self.graph.div(y, length)]
    }

    /// Returns the unit direction of an axis in the view.
    pub(super) fn direction(&mut self, axis: AxisId) -> Vector {
        let axis = &self.model[axis];
        let local = self.unit_direction(axis);
        self.transform_vector(axis.frame, local)
    }

    /// Returns the angle θ of an axis in its frame (rad), in (−π, π]; if the view mirrors the frame, the angle of the mirror image.
    pub(super) fn local_angle(&mut self, axis: AxisId) -> ExprId {
        let model = self.model;
        let [x, y] = model[axis].direction.map(|id| self.formula(id));
        let part = model.part_of(model[axis].frame);
        if model.is_mirrored(part) == model.is_mirrored(self.view) {
            return self.graph.binary(Binary::Atan2, y, x);
        }
        let image = self.graph.neg(y);
        let angle = self.graph.binary(Binary::Atan2, image, x);
        // `atan2` of a negative zero is −π.
        let [zero, pi] = [0.0, std::f64::consts::PI].map(|value| self.graph.constant(value));
        let on_line = self.graph.compare(Comparison::Equal, y, zero);
        let behind = self.graph.compare(Comparison::Less, x, zero);
        let is_opposite = self.graph.and(on_line, behind);
        self.graph.select(is_opposite, pi, angle)
    }

    /// Returns `b − a`.
    pub(super) fn difference(&mut self, b: Vector, a: Vector) -> Vector {
        [self.graph.sub(b[0], a[0]), self.graph.sub(b[1], a[1])]
    }

    /// Returns `aᵀ b`.
    pub(super) fn dot(&mut self, a: Vector, b: Vector) -> ExprId {
        let (x, y) = (self.graph.mul(a[0], b[0]), self.graph.mul(a[1], b[1]));
        self.graph.add(x, y)
    }

    /// Returns `(v^⊥)ᵀ d`: for a unit vector `v` the signed distance of `d` to its left.
    pub(super) fn left_of(&mut self, v: Vector, d: Vector) -> ExprId {
        let (right, left) = (self.graph.mul(v[1], d[0]), self.graph.mul(v[0], d[1]));
        self.graph.sub(left, right)
    }
}
