//! Formulas of drawn poses: what stands after `at`.

use super::Formulas;
use super::formula_scope::Position;
use super::value::Context;
use crate::check::errors;
use crate::check::suggest::edits;
use mechc_expr::ExprId;
use mechc_syntax::ast::{DrawnPose, Expr, ExprKind};
use mechc_text::vocabulary::Keyword;

/// The place in messages.
const PLACE: &str = "the estimate of a pose";

impl Formulas<'_> {
    /// Evaluates the pose of a body.
    pub(in crate::check) fn pose(&mut self, pose: &DrawnPose) -> Option<[ExprId; 3]> {
        let (place, phi) = match &pose.toward {
            Some(toward) => self.pose_toward(&pose.at, toward),
            None => self.place_and_angle(&pose.at)?,
        };
        let ([x, y], phi) = (place?, phi?);
        Some([x, y, phi])
    }

    pub(in crate::check) fn pose_of_part(&mut self, at: &Expr) -> Option<[ExprId; 3]> {
        let (place, phi) = self.place_and_angle(at)?;
        let ([x, y], phi) = (place?, phi?);
        Some([x, y, phi])
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
        self.reporter.report(diagnostic.instead_if(fix));
    }
}
