//! Placement of parts: the mount of each part, and the pose of its ground on the mount.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{FormulaSite, describe};
use crate::model::Frame;
use mechc_syntax::ast::{Expr, ExprKind};

impl Builder<'_, '_> {
    /// Sets the mounts of parts, and their poses as far as these use no points of bodies, which do not exist yet.
    pub(super) fn mount_parts(&mut self) {
        for k in 0..self.formulas.parts.len() {
            let written = self.formulas.part_declarations[k];
            let Some(id) = self.formulas.parts[k].address.part else { continue };
            match written.on.as_ref().map(|on| self.carrier_of(on)) {
                Some(Some(mount)) => self.formulas.model.parts[id.index()].mount = mount,
                Some(None) => {
                    self.formulas.common.broken_poses.insert(Frame::Part(id));
                }
                None => {}
            }
        }
        self.report_mount_cycles();
        for k in 0..self.formulas.parts.len() {
            if !self.is_placed_by_features(k) {
                self.place_part(k);
            }
        }
        self.in_parts(|part| part.mount_parts());
    }

    fn carrier_of(&mut self, on: &Expr) -> Option<Frame> {
        if let ExprKind::Name(name) = &on.kind {
            return self.formulas.body(name);
        }
        self.formulas.reporter.report(errors::wrong_kind(on.span, "a body", describe(on)));
        None
    }

    /// Reports parts that carry each other or themselves.
    fn report_mount_cycles(&mut self) {
        let carriers: Vec<Option<usize>> = (0..self.formulas.parts.len())
            .map(|k| self.formulas.part_declarations[k].on.as_ref().and_then(|_| self.part_holding(self.mount_of(k)?)))
            .collect();
        for cycle in cycles(&carriers) {
            let parts: Vec<_> = cycle
                .iter()
                .map(|&k| {
                    let part = self.formulas.part_declarations[k];
                    let on = part.on.as_ref().map_or(part.name.span, |on| on.span);
                    (&part.name, on, matches!(self.mount_of(k), Some(Frame::Part(_))))
                })
                .collect();
            self.formulas.reporter.report(errors::carries_itself(&parts));
            for k in cycle {
                let Some(id) = self.formulas.parts[k].address.part else { continue };
                self.formulas.model.parts[id.index()].mount = self.formulas.address.ground;
                self.formulas.common.broken_poses.insert(Frame::Part(id));
            }
        }
    }

    fn mount_of(&self, part: usize) -> Option<Frame> {
        Some(self.formulas.model[self.formulas.parts[part].address.part?].mount)
    }

    /// Returns the part of this text to which a frame belongs.
    pub(super) fn part_holding(&self, frame: Frame) -> Option<usize> {
        let outwards =
            std::iter::successors(self.formulas.model.part_of(frame), |part| self.formulas.model[*part].within);
        let part = outwards.into_iter().find(|part| self.formulas.model[*part].within == self.formulas.address.part)?;
        self.formulas.parts.iter().position(|child| child.address.part == Some(part))
    }

    /// Returns whether the pose of a part uses points of bodies.
    pub(super) fn is_placed_by_features(&self, part: usize) -> bool {
        let is_feature = |e: &Expr| matches!(&e.kind, ExprKind::Member { owner, .. } if self.formulas.scope.point_param(owner).is_none());
        self.formulas.part_declarations[part].at.iter().flat_map(Expr::parts).any(is_feature)
    }

    /// Sets the pose of a part on its mount, or marks the pose as broken.
    pub(super) fn place_part(&mut self, part: usize) {
        let (Some(at), Some(id)) = (&self.formulas.part_declarations[part].at, self.formulas.parts[part].address.part)
        else {
            return;
        };
        let site = FormulaSite::Mount(self.formulas.model[id].mount);
        match self.formulas.at_site(site, None, |formulas| formulas.pose_of_part(at)) {
            Some(pose) => self.formulas.model.parts[id.index()].pose = pose,
            None => {
                self.formulas.common.broken_poses.insert(Frame::Part(id));
            }
        }
    }

    // ---- places

    /// Returns whether a frame moves relative to this text's ground.
    pub(in crate::check) fn moves(&self, frame: Frame) -> bool {
        let mut chain = self.formulas.model.carrier_chain(frame);
        chain.find_map(|frame| match frame {
            _ if frame == self.formulas.address.ground => Some(false),
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
