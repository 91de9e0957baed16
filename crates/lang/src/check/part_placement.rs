//! Placement of parts: the mount of each part, and the pose of its ground on the mount.

use super::formula_scope::{FormulaSite, Position};
use super::quantities::describe;
use super::{Checker, errors};
use crate::model::{Frame, Placement};
use mechc_expr::{ExprId, Graph};
use mechc_syntax::ast::{Expr, ExprKind};

impl Checker<'_> {
    /// Sets the mounts of parts, and their poses as far as these use no points of bodies, which do not exist yet.
    pub(super) fn mount_parts(&mut self) {
        for k in 0..self.parts.len() {
            let written = self.part_declarations[k];
            let Some(id) = self.parts[k].address.part else { continue };
            match written.on.as_ref().map(|on| self.carrier_of(on)) {
                Some(Some(mount)) => self.model.parts[id.index()].mount = mount,
                Some(None) => {
                    self.common.broken_poses.insert(Frame::Part(id));
                }
                None => {}
            }
        }
        self.report_mount_cycles();
        for k in 0..self.parts.len() {
            if !self.is_placed_by_features(k) {
                self.place_part(k);
            }
        }
        self.in_parts(Checker::mount_parts);
    }

    fn carrier_of(&mut self, on: &Expr) -> Option<Frame> {
        if let ExprKind::Name(name) = &on.kind {
            return self.body(name);
        }
        self.reporter.report(errors::wrong_kind(on.span, "a body", describe(on)));
        None
    }

    /// Reports parts that carry each other or themselves.
    fn report_mount_cycles(&mut self) {
        let carriers: Vec<Option<usize>> = (0..self.parts.len())
            .map(|k| self.part_declarations[k].on.as_ref().and_then(|_| self.part_holding(self.mount_of(k)?)))
            .collect();
        for cycle in cycles(&carriers) {
            let parts: Vec<_> = cycle
                .iter()
                .map(|&k| {
                    let part = self.part_declarations[k];
                    let on = part.on.as_ref().map_or(part.name.span, |on| on.span);
                    (&part.name, on, matches!(self.mount_of(k), Some(Frame::Part(_))))
                })
                .collect();
            self.reporter.report(errors::carries_itself(&parts));
            for k in cycle {
                let Some(id) = self.parts[k].address.part else { continue };
                self.model.parts[id.index()].mount = self.address.ground;
                self.common.broken_poses.insert(Frame::Part(id));
            }
        }
    }

    fn mount_of(&self, part: usize) -> Option<Frame> {
        Some(self.model[self.parts[part].address.part?].mount)
    }

    /// Returns the part of this text to which a frame belongs.
    pub(super) fn part_holding(&self, frame: Frame) -> Option<usize> {
        let outwards = std::iter::successors(self.model.part_of(frame), |part| self.model[*part].within);
        let part = outwards.into_iter().find(|part| self.model[*part].within == self.address.part)?;
        self.parts.iter().position(|child| child.address.part == Some(part))
    }

    /// Returns whether the pose of a part uses points of bodies.
    pub(super) fn is_placed_by_features(&self, part: usize) -> bool {
        let is_feature =
            |e: &Expr| matches!(&e.kind, ExprKind::Member { owner, .. } if self.scope.point_param(owner).is_none());
        self.part_declarations[part].at.iter().flat_map(Expr::parts).any(is_feature)
    }

    /// Sets the pose of a part on its mount, or marks the pose as broken.
    pub(super) fn place_part(&mut self, part: usize) {
        let (Some(at), Some(id)) = (&self.part_declarations[part].at, self.parts[part].address.part) else { return };
        let site = FormulaSite::Mount(self.model[id].mount);
        match self.at_site(site, None, |checker| checker.pose_of_part(at)) {
            Some(pose) => self.model.parts[id.index()].pose = pose,
            None => {
                self.common.broken_poses.insert(Frame::Part(id));
            }
        }
    }

    fn pose_of_part(&mut self, at: &Expr) -> Option<[ExprId; 3]> {
        let (place, phi) = self.place_and_angle(at)?;
        let ([x, y], phi) = (place?, phi?);
        Some([x, y, phi])
    }

    // ---- places

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
    pub(super) fn is_place_broken(&self, frame: Frame) -> bool {
        let carrier = |frame: &Frame| match *frame {
            frame if frame == self.address.ground => None,
            Frame::Ground => None,
            Frame::Body(body) => self.model[body].part.filter(|part| Some(*part) != self.address.part).map(Frame::Part),
            Frame::Part(part) => Some(self.model[part].mount),
        };
        std::iter::successors(Some(frame), carrier).any(|frame| self.common.broken_poses.contains(&frame))
    }

    /// Returns the drawn placement of a frame in this text's frame.
    pub(super) fn drawn_frame(&mut self, frame: Frame) -> Placement {
        let mut graph = std::mem::replace(&mut self.model.graph, Graph::new());
        let placement = self.model.drawn(&mut graph, &mut |_, id| id, self.address.part, frame);
        self.model.graph = graph;
        placement
    }

    /// Returns whether a frame moves relative to this text's ground.
    pub(super) fn moves(&self, frame: Frame) -> bool {
        let mut chain = self.model.carrier_chain(frame);
        chain.find_map(|frame| match frame {
            _ if frame == self.address.ground => Some(false),
            Frame::Body(_) => Some(true),
            Frame::Ground => Some(false),
            Frame::Part(_) => None,
        }) == Some(true)
    }
}

/// Returns the cycles of a graph in which each node has at most one successor.
fn cycles(next: &[Option<usize>]) -> Vec<Vec<usize>> {
    let mut walks: Vec<Option<usize>> = vec![None; next.len()];
    let mut found = Vec::new();
    for start in 0..next.len() {
        let (mut path, mut at) = (Vec::new(), Some(start));
        while let Some(k) = at.filter(|&k| walks[k].is_none()) {
            walks[k] = Some(start);
            path.push(k);
            at = next[k];
        }
        let first = at.filter(|&k| walks[k] == Some(start)).and_then(|k| path.iter().position(|&other| other == k));
        found.extend(first.map(|first| path.split_off(first)));
    }
    found
}
