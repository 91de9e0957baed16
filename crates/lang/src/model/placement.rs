//! Poses of frames relative to other frames, with their handedness.

use super::{Frame, Mechanism, PartId};
use mechc_expr::{ExprId, Graph, Unary, unary_value};

/// The pose of an inner frame relative to an outer one.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The position of the inner frame's origin (m).
    pub at: [ExprId; 2],
    /// The direction of the inner frame's x axis (rad).
    pub phi: ExprId,
    /// True if the inner frame is left-handed relative to the outer one.
    pub is_mirrored: bool,
}

impl Placement {
    /// Returns the placement of a frame relative to itself.
    #[must_use]
    pub fn identity(graph: &mut Graph) -> Placement {
        let zero = graph.constant(0.0);
        Placement { at: [zero; 2], phi: zero, is_mirrored: false }
    }

    /// Returns a vector of the inner frame in the outer frame.
    #[must_use]
    pub fn turned(&self, graph: &mut Graph, [x, y]: [ExprId; 2]) -> [ExprId; 2] {
        let y = if self.is_mirrored { graph.neg(y) } else { y };
        let (cos, sin) = (graph.unary(Unary::Cos, self.phi), graph.unary(Unary::Sin, self.phi));
        let (xc, ys) = (graph.mul(x, cos), graph.mul(y, sin));
        let (xs, yc) = (graph.mul(x, sin), graph.mul(y, cos));
        [graph.sub(xc, ys), graph.add(xs, yc)]
    }

    /// Returns a point of the inner frame in the outer frame.
    #[must_use]
    pub fn placed(&self, graph: &mut Graph, local: [ExprId; 2]) -> [ExprId; 2] {
        let [x, y] = self.turned(graph, local);
        [graph.add(self.at[0], x), graph.add(self.at[1], y)]
    }

    /// Returns an angle of the inner frame as an angle of the outer frame, with the sign of its handedness.
    #[must_use]
    pub fn angle(&self, graph: &mut Graph, phi: ExprId) -> ExprId {
        if self.is_mirrored { graph.neg(phi) } else { phi }
    }

    /// Returns the placement relative to the outer frame of a frame that is placed in the inner frame.
    #[must_use]
    pub fn compose(&self, graph: &mut Graph, inner: &Placement) -> Placement {
        let at = self.placed(graph, inner.at);
        let turn = self.angle(graph, inner.phi);
        let phi = graph.add(self.phi, turn);
        Placement { at, phi, is_mirrored: self.is_mirrored != inner.is_mirrored }
    }

    /// Returns a vector of the outer frame in the inner frame.
    #[must_use]
    pub fn turned_back(&self, graph: &mut Graph, [x, y]: [ExprId; 2]) -> [ExprId; 2] {
        let (cos, sin) = (graph.unary(Unary::Cos, self.phi), graph.unary(Unary::Sin, self.phi));
        let (xc, ys) = (graph.mul(x, cos), graph.mul(y, sin));
        let (xs, yc) = (graph.mul(x, sin), graph.mul(y, cos));
        let (along, across) = (graph.add(xc, ys), graph.sub(yc, xs));
        [along, if self.is_mirrored { graph.neg(across) } else { across }]
    }
}

impl Mechanism {
    /// Returns a point of a frame (m) in the right-handed frame of the body or ground that carries it, as tables use it, with that frame.
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

    /// Returns the placement of a frame relative to the ground of a part, or to the ground, in the poses as written. `formula` imports a
    /// formula of the mechanism into the graph.
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
            // The text of a part refers to nothing outside the part.
            Frame::Ground => Placement::identity(graph),
            Frame::Body(body) => {
                let body = &self[body];
                let text = self.drawn(graph, formula, within, body.part.map_or(Frame::Ground, Frame::Part));
                let [x, y, phi] = body.pose.map(|id| formula(graph, id));
                text.compose(graph, &Placement { at: [x, y], phi, is_mirrored: false })
            }
            Frame::Part(part) => {
                let part = &self[part];
                let mount = self.drawn(graph, formula, within, part.mount);
                // The mount has the handedness of the text that declares the part, as everything in that text.
                let is_mirrored = self.is_mirrored(part.within) != self.is_mirrored(within);
                Mechanism::on_mount(graph, formula, Placement { is_mirrored, ..mount }, part)
            }
        }
    }

    /// Returns the placement of a part's ground on its mount, where the mount has the handedness of the text that declares the part.
    #[must_use]
    pub fn on_mount(
        graph: &mut Graph,
        formula: &mut dyn FnMut(&mut Graph, ExprId) -> ExprId,
        mount: Placement,
        part: &super::Part,
    ) -> Placement {
        let [x, y, phi] = part.pose.map(|id| formula(graph, id));
        mount.compose(graph, &Placement { at: [x, y], phi, is_mirrored: part.is_mirrored_in_parent })
    }
}
