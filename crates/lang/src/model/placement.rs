//! Frames in frames: where a point of one is in another, and what becomes of left and right.

use super::{Frame, Mechanism, PartId};
use mechc_expr::{ExprId, Graph, Unary, unary_value};

/// A frame in another one.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Where its origin is (m).
    pub at: [ExprId; 2],
    /// The direction of its x axis (rad).
    pub phi: ExprId,
    /// Whether its y axis points to the right of its x axis.
    pub is_mirrored: bool,
}

impl Placement {
    /// That of a frame in itself.
    #[must_use]
    pub fn identity(graph: &mut Graph) -> Placement {
        let zero = graph.constant(0.0);
        Placement { at: [zero; 2], phi: zero, is_mirrored: false }
    }

    /// A vector of the frame, in the other one.
    #[must_use]
    pub fn turned(&self, graph: &mut Graph, [x, y]: [ExprId; 2]) -> [ExprId; 2] {
        let y = if self.is_mirrored { graph.neg(y) } else { y };
        let (cos, sin) = (graph.unary(Unary::Cos, self.phi), graph.unary(Unary::Sin, self.phi));
        let (xc, ys) = (graph.mul(x, cos), graph.mul(y, sin));
        let (xs, yc) = (graph.mul(x, sin), graph.mul(y, cos));
        [graph.sub(xc, ys), graph.add(xs, yc)]
    }

    /// A point of the frame, in the other one.
    #[must_use]
    pub fn placed(&self, graph: &mut Graph, local: [ExprId; 2]) -> [ExprId; 2] {
        let [x, y] = self.turned(graph, local);
        [graph.add(self.at[0], x), graph.add(self.at[1], y)]
    }

    /// What is an angle in the frame, as a difference of angles in the other one.
    #[must_use]
    pub fn angle(&self, graph: &mut Graph, phi: ExprId) -> ExprId {
        if self.is_mirrored { graph.neg(phi) } else { phi }
    }

    /// A frame that stands in this one, in the other one.
    #[must_use]
    pub fn of(&self, graph: &mut Graph, inner: &Placement) -> Placement {
        let at = self.placed(graph, inner.at);
        let turn = self.angle(graph, inner.phi);
        let phi = graph.add(self.phi, turn);
        Placement { at, phi, is_mirrored: self.is_mirrored != inner.is_mirrored }
    }

    /// A frame of the other one, seen in this one: x and y of a vector from this frame's origin on.
    #[must_use]
    pub fn seen(&self, graph: &mut Graph, [x, y]: [ExprId; 2]) -> [ExprId; 2] {
        let (cos, sin) = (graph.unary(Unary::Cos, self.phi), graph.unary(Unary::Sin, self.phi));
        let (xc, ys) = (graph.mul(x, cos), graph.mul(y, sin));
        let (xs, yc) = (graph.mul(x, sin), graph.mul(y, cos));
        let (along, across) = (graph.add(xc, ys), graph.sub(yc, xs));
        [along, if self.is_mirrored { graph.neg(across) } else { across }]
    }
}

impl Mechanism {
    /// A place in a frame (m), in the frame of the body that carries it, or in the ground's, as tables have these.
    pub fn in_carrier(
        &self,
        value: &impl Fn(ExprId) -> f64,
        mut frame: Frame,
        [mut x, mut y]: [f64; 2],
    ) -> (Frame, [f64; 2]) {
        let mut is_mirrored = self.is_mirrored(self.part_of(frame));
        while let Frame::Part(part) = frame {
            let part = &self[part];
            if is_mirrored != self.is_mirrored(part.within) {
                (y, is_mirrored) = (-y, !is_mirrored);
            }
            let [x0, y0, phi] = part.pose.map(value);
            let (sin, cos) = (unary_value(Unary::Sin, phi), unary_value(Unary::Cos, phi));
            [x, y] = [x0 + x * cos - y * sin, y0 + x * sin + y * cos];
            frame = part.mount;
        }
        (frame, [x, if is_mirrored { -y } else { y }])
    }

    /// Where a frame is drawn, in the frame of a part, or of the ground, that it stands in: by the poses as written. `formula` carries a
    /// formula of the mechanism over into the graph.
    #[must_use]
    pub fn drawn(
        &self,
        graph: &mut Graph,
        formula: &mut dyn FnMut(&mut Graph, ExprId) -> ExprId,
        within: Option<PartId>,
        frame: Frame,
    ) -> Placement {
        let base = within.map_or(Frame::Ground, Frame::Part);
        if frame == base {
            return Placement::identity(graph);
        }
        match frame {
            // nothing of a part speaks of what is around it
            Frame::Ground => Placement::identity(graph),
            Frame::Body(body) => {
                let body = &self[body];
                let text = self.drawn(graph, formula, within, body.part.map_or(Frame::Ground, Frame::Part));
                let [x, y, phi] = body.pose.map(|id| formula(graph, id));
                text.of(graph, &Placement { at: [x, y], phi, is_mirrored: false })
            }
            Frame::Part(part) => {
                let part = &self[part];
                let mount = self.drawn(graph, formula, within, part.mount);
                // to who declares the part, what carries it is like everything in his text
                let is_mirrored = self.is_mirrored(part.within) != self.is_mirrored(within);
                Mechanism::on_mount(graph, formula, Placement { is_mirrored, ..mount }, part)
            }
        }
    }

    /// Where a part's frame is, if its mount is where it is in the handedness of the text that declares the part.
    #[must_use]
    pub fn on_mount(
        graph: &mut Graph,
        formula: &mut dyn FnMut(&mut Graph, ExprId) -> ExprId,
        mount: Placement,
        part: &super::Part,
    ) -> Placement {
        let [x, y, phi] = part.pose.map(|id| formula(graph, id));
        mount.of(graph, &Placement { at: [x, y], phi, is_mirrored: part.is_turned_over })
    }
}
