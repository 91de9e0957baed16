//! Drawn poses of bodies: the formulas after `at`, which may depend on the poses of other bodies.

use super::formula::Context;
use super::formula_scope::{FormulaSite, Position};
use super::names::{DefinitionOrder, ordered};
use super::suggest::edits;
use super::{Checker, errors};
use crate::model::Frame;
use mechc_expr::ExprId;
use mechc_syntax::ast::{DrawnPose, Expr, ExprKind, Item, ItemKind, Name};
use mechc_syntax::keywords_in;
use mechc_text::source::Span;
use mechc_text::vocabulary::Keyword;
use rustc_hash::FxHashMap;

/// The place in messages.
const PLACE: &str = "the estimate of a pose";

impl<'a> Checker<'a> {
    /// Evaluates the poses of all bodies, each after those that it uses.
    pub(super) fn poses(&mut self) {
        // In their own frames they depend on nothing outside.
        self.in_parts(Checker::poses);
        let mut poses = Vec::new();
        for item in self.scope.items() {
            if let ItemKind::Body { name, pose, .. } = &item.kind {
                poses.push((item, name, pose.as_ref()));
            }
        }
        let uses = self.uses_of_poses(&poses);
        let mut is_sound = vec![false; poses.len()];
        let DefinitionOrder { order, on_cycles } = ordered(&mut self.reporter, &uses);
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
                Some(pose) => self.at_site(FormulaSite::Drawing, None, |checker| checker.pose(k, pose)).is_some(),
                None => !self.has_unread_pose(item),
            };
            if !is_sound[k] {
                self.common.broken_poses.insert(self.bodies[k]);
            }
        }
        // Poses on a cycle are broken.
        let broken = self.bodies.iter().zip(is_sound).filter(|(_, is_sound)| !is_sound);
        self.common.broken_poses.extend(broken.map(|(&body, _)| body));
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
        for (k, part) in self.part_declarations.iter().enumerate() {
            positions.entry(part.name.text.as_str()).or_insert(poses.len() + k);
        }
        // The position of what is in a part depends on that of the part.
        let position = |name: &Name| positions.get(name.text.split('.').next().unwrap_or_default()).copied();
        let uses = poses.iter().map(|&(_, name, pose)| {
            (name, self.owners_in(pose.into_iter().flat_map(DrawnPose::parts).collect(), position))
        });
        let mut uses: Vec<_> = uses.collect();
        for (part, child) in self.part_declarations.iter().zip(&self.parts) {
            // A rejected mount has been reported.
            let is_mounted = child.address.part.is_some_and(|id| self.model[id].mount != self.address.ground);
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
                && self.scope.point_param(owner).is_none()
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
            self.common.broken_poses.extend(self.parts[part].address.part.map(Frame::Part));
        }
    }

    /// Returns whether a body has a pose that does not follow the grammar, which has been reported.
    fn has_unread_pose(&self, item: &Item) -> bool {
        let head = self.reporter.text(item.span).split('{').next().unwrap_or_default();
        keywords_in(head).any(|(_, keyword)| keyword.word.name == "at")
    }

    fn pose(&mut self, body: usize, pose: &DrawnPose) -> Option<()> {
        let (place, phi) = match &pose.toward {
            Some(toward) => self.pose_toward(&pose.at, toward),
            None => self.place_and_angle(&pose.at)?,
        };
        let ([x, y], phi) = (place?, phi?);
        if let Some(Frame::Body(id)) = self.bodies.get(body) {
            self.model.bodies[id.index()].pose = [x, y, phi];
        }
        Some(())
    }

    /// Evaluates `(x, y, phi)` or `(P, phi)`.
    pub(super) fn place_and_angle(&mut self, at: &Expr) -> Option<(Option<Position>, Option<ExprId>)> {
        let ExprKind::Tuple(parts) = &at.kind else {
            self.wrong_pose(at, &[]);
            return None;
        };
        Some(match parts.as_slice() {
            [x, y, phi] => {
                let context = self.pair_context([x, y], PLACE, None);
                let place = self.lengths_in([x, y], &context);
                (place, self.angle(phi, "the angle of a pose"))
            }
            [point, phi] if self.is_intended_as_point(point) => {
                let place = self.drawn_point_of(point);
                (place, self.angle(phi, "the angle of a pose"))
            }
            parts => {
                self.wrong_pose(at, parts);
                return None;
            }
        })
    }

    /// Evaluates `at A toward B`.
    fn pose_toward(&mut self, from: &Expr, to: &Expr) -> (Option<Position>, Option<ExprId>) {
        let (p, q) = (self.drawn_point_of(from), self.drawn_point_of(to));
        let (Some(p), Some(q)) = (p, q) else { return (None, None) };
        let offset = [0, 1].map(|k| self.model.graph.sub(q[k], p[k]));
        (Some(p), self.direction_of_vector(offset, "`toward`", from.span.to(to.span)))
    }

    fn drawn_point_of(&mut self, e: &Expr) -> Option<Position> {
        match &e.kind {
            ExprKind::Name(name) if !self.is_point(e) => {
                self.no_point_named(name);
                None
            }
            _ => self.point_formula(e, &Context::constant(PLACE)).map(|drawn| drawn.at),
        }
    }

    /// Returns whether a formula is a point, or an unknown name or feature.
    fn is_intended_as_point(&self, e: &Expr) -> bool {
        self.is_point(e)
            || match &e.kind {
                ExprKind::Name(name) => !self.scope.is_number_name(name),
                ExprKind::Member { owner, .. } => self.scope.point_param(owner).is_none(),
                _ => false,
            }
    }

    fn wrong_pose(&mut self, e: &Expr, parts: &[Expr]) {
        if parts.is_empty() && self.is_point(e) {
            self.reporter.report(errors::no_angle_of_pose(e.span, self.reporter.text(e.span)));
            return;
        }
        let found = if parts.is_empty() { 1 } else { parts.len() };
        let word = Keyword::named("at").map(|keyword| &keyword.word);
        let diagnostic = errors::argument_count("at", word, e.span, "two lengths and an angle", found);
        let fix = self.suggest_decimal_point(parts, 3).or_else(|| edits::suggest_pose_angle(parts));
        self.reporter.report(edits::with_preferred_fix(diagnostic, fix));
    }
}
