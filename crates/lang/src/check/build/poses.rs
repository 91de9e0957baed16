//! Drawn poses of bodies: the formulas after `at`, which may depend on the poses of other bodies.

use super::Builder;
use crate::check::formulas::FormulaSite;
use crate::check::scope::{DefinitionOrder, ordered};
use crate::model::Frame;
use mechc_syntax::ast::{DrawnPose, Expr, ExprKind, Item, ItemKind, Name};
use mechc_syntax::keywords_in;
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

impl<'a> Builder<'_, 'a> {
    /// Evaluates the poses of all bodies, each after those that it uses.
    pub(in crate::check) fn poses(&mut self) {
        // In their own frames they depend on nothing outside.
        self.in_parts(|part| part.poses());
        let mut poses = Vec::new();
        for item in self.formulas.scope.items() {
            if let ItemKind::Body { name, pose, .. } = &item.kind {
                poses.push((item, name, pose.as_ref()));
            }
        }
        let uses = self.uses_of_poses(&poses);
        let mut is_sound = vec![false; poses.len()];
        let DefinitionOrder { order, on_cycles } = ordered(&mut self.formulas.reporter, &uses);
        self.break_places_of_parts(on_cycles.iter().filter_map(|k| k.checked_sub(poses.len())));
        for k in order {
            // Parts follow the bodies.
            let Some(&(item, _, pose)) = poses.get(k) else {
                let part = k - poses.len();
                if self.is_placed_by_features(part) {
                    self.place_part(part);
                }
                continue;
            };
            is_sound[k] = match pose {
                Some(pose) => {
                    let drawn = self.formulas.at_site(FormulaSite::Drawing, None, |formulas| formulas.pose(pose));
                    if let (Some(drawn), Some(Frame::Body(id))) = (drawn, self.formulas.bodies.get(k)) {
                        self.formulas.model.bodies[id.index()].pose = drawn;
                    }
                    drawn.is_some()
                }
                None => !self.has_unread_pose(item),
            };
            if !is_sound[k] {
                self.formulas.common.broken_poses.insert(self.formulas.bodies[k]);
            }
        }
        // Poses on a cycle are broken.
        let broken = self.formulas.bodies.iter().zip(is_sound).filter(|(_, is_sound)| !is_sound);
        self.formulas.common.broken_poses.extend(broken.map(|(&body, _)| body));
    }

    /// Returns the bodies that the pose of each one uses.
    fn uses_of_poses(
        &self,
        poses: &[(&'a Item, &'a Name, Option<&'a DrawnPose>)],
    ) -> Vec<(&'a Name, Vec<(usize, Span)>)> {
        let mut positions = FxHashMap::default();
        for (k, (_, name, _)) in poses.iter().enumerate() {
            positions.entry(name.text.as_str()).or_insert(k);
        }
        for (k, part) in self.formulas.part_declarations.iter().enumerate() {
            positions.entry(part.name.text.as_str()).or_insert(poses.len() + k);
        }
        // The position of what is in a part depends on that of the part.
        let position = |name: &Name| positions.get(name.text.split('.').next().unwrap_or_default()).copied();
        let uses = poses.iter().map(|&(_, name, pose)| {
            (name, self.owners_in(pose.into_iter().flat_map(DrawnPose::parts).collect(), position))
        });
        let mut uses: Vec<_> = uses.collect();
        for (part, child) in self.formulas.part_declarations.iter().zip(&self.formulas.parts) {
            // A rejected mount has been reported.
            let is_mounted =
                child.address.part.is_some_and(|id| self.formulas.model[id].mount != self.formulas.address.ground);
            let mount = part.on.as_ref().filter(|_| is_mounted).and_then(|on| match &on.kind {
                ExprKind::Name(name) => position(name).map(|k| (k, name.span)),
                _ => None,
            });
            uses.push((
                &part.name,
                mount.into_iter().chain(self.owners_in(part.at.iter().collect(), position)).collect(),
            ));
        }
        uses
    }

    /// Returns the owners of the features that formulas use, by their positions.
    fn owners_in(&self, mut open: Vec<&Expr>, position: impl Fn(&Name) -> Option<usize>) -> Vec<(usize, Span)> {
        let mut uses = Vec::new();
        while let Some(e) = open.pop() {
            if let ExprKind::Member { owner, .. } = &e.kind
                && self.formulas.scope.point_param(owner).is_none()
            {
                uses.extend(position(owner).map(|k| (k, owner.span)));
            }
            open.extend(e.children());
        }
        uses
    }

    /// Marks the poses of parts on a cycle as broken.
    fn break_places_of_parts(&mut self, parts: impl Iterator<Item = usize>) {
        for part in parts {
            self.formulas.common.broken_poses.extend(self.formulas.parts[part].address.part.map(Frame::Part));
        }
    }

    /// Returns whether a body has a pose that does not follow the grammar, which has been reported.
    fn has_unread_pose(&self, item: &Item) -> bool {
        let head = self.formulas.reporter.text(item.span).split('{').next().unwrap_or_default();
        keywords_in(head).any(|(_, keyword)| keyword.word.name == "at")
    }
}
