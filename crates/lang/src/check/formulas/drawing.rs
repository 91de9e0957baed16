//! Positions of frames and points in the drawing.

use super::Formulas;
use super::formula_scope::Position;
use crate::model::{BodyId, Frame, Placement};
use mechc_expr::Graph;

impl Formulas<'_> {
    /// Returns the position of a drawn point of a frame relative to another frame; `None` if a pose is broken.
    pub(super) fn drawn_from(&mut self, seer: Frame, frame: Frame, [x, y]: Position) -> Option<Position> {
        if frame == seer {
            // The text of a mirrored part uses its own handedness.
            let is_mirrored_in_parent =
                self.model.is_mirrored(self.model.part_of(frame)) != self.model.is_mirrored(self.address.part);
            return Some([x, if is_mirrored_in_parent { self.model.graph.neg(y) } else { y }]);
        }
        let place = self.drawn_place(frame, [x, y])?;
        if seer == self.address.ground {
            return Some(place);
        }
        if self.is_place_broken(seer) {
            return None;
        }
        let seer = Placement { is_mirrored: false, ..self.drawn_frame(seer) };
        let graph = &mut self.model.graph;
        let offset = [0, 1].map(|axis| graph.sub(place[axis], seer.at[axis]));
        Some(seer.turned_back(graph, offset))
    }

    /// Returns whether a frame has no drawn position, as its pose or that of a carrier is broken.
    pub(in crate::check) fn is_place_broken(&self, frame: Frame) -> bool {
        let carrier = |frame: &Frame| match *frame {
            frame if frame == self.address.ground => None,
            Frame::Ground => None,
            Frame::Body(body) => self.model[body].part.filter(|part| Some(*part) != self.address.part).map(Frame::Part),
            Frame::Part(part) => Some(self.model[part].mount),
        };
        std::iter::successors(Some(frame), carrier).any(|frame| self.common.broken_poses.contains(&frame))
    }

    /// Returns the drawn placement of a frame in this text's frame.
    pub(in crate::check) fn drawn_frame(&mut self, frame: Frame) -> Placement {
        let mut graph = std::mem::replace(&mut self.model.graph, Graph::new());
        let placement = self.model.drawn(&mut graph, &mut |_, id| id, self.address.part, frame);
        self.model.graph = graph;
        placement
    }

    /// Returns the body of a frame, if it belongs to this text.
    pub(in crate::check) fn local_body(&self, frame: Frame) -> Option<BodyId> {
        match frame {
            Frame::Body(body) if self.model[body].part == self.address.part => Some(body),
            _ => None,
        }
    }
}
