//! Literal points and directions, lengths and angles, as features, joints and poses use them.

use super::Formulas;
use super::dimensions::require_dimension;
use super::formula_scope::InitialPoint;
use super::quantities::describe;
use super::value::{Context, Value};
use crate::check::errors;
use crate::check::scope::Expected;
use crate::model::{Dimension, Frame, GuardKind, Point, PointId};
use mechc_expr::ExprId;
use mechc_syntax::ast::{Expr, ExprKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::Keyword;

impl<'a> Formulas<'a> {
    /// Evaluates `(x, y)`, whose dimensions are judged together, or another formula of points, with an argument if given.
    pub(in crate::check) fn place_of(
        &mut self,
        e: &Expr,
        what: &str,
        place: &'static str,
        argument: Option<(&str, Value)>,
    ) -> Option<InitialPoint> {
        match &e.kind {
            ExprKind::Tuple(parts) => {
                if let [x, y] = parts.as_slice() {
                    let name = argument.map(|(name, _)| name);
                    let context = Context { argument, ..self.pair_context([x, y], place, name) };
                    let at = self.lengths_in([x, y], &context)?;
                    Some(InitialPoint { at, dimensional: context.judged })
                } else {
                    let word = Keyword::named(what).map(|keyword| &keyword.word);
                    let diagnostic = errors::argument_count(what, word, e.span, "two lengths", parts.len());
                    self.reporter.report(diagnostic.instead_if(self.suggest_decimal_point(parts, 2)));
                    None
                }
            }
            _ if self.is_point(e) => self.point_formula(e, &Context { argument, ..Context::constant(place) }),
            ExprKind::Name(name) => {
                self.no_point_named(name);
                None
            }
            ExprKind::Member { owner, feature } => {
                let diagnostic = self.no_place(e.span, owner, feature);
                self.reporter.report(diagnostic);
                None
            }
            ExprKind::Paren(_) => {
                self.reporter.report(errors::argument_count(
                    what,
                    Keyword::named(what).map(|keyword| &keyword.word),
                    e.span,
                    "two lengths",
                    1,
                ));
                None
            }
            _ => {
                self.reporter.report(errors::wrong_kind(e.span, "a point `(x, y)`", describe(e)));
                None
            }
        }
    }

    /// Returns the point where an axis starts or ends: a named point of the frame, or a formula of points.
    pub(in crate::check) fn place(&mut self, frame: Frame, e: &Expr) -> Option<PointId> {
        match &e.kind {
            ExprKind::Name(name)
                if self.body_point(name, Expected::Point).is_some() || self.scope.point_param(name).is_none() =>
            {
                self.record_body_point(name);
                self.point_named(frame, name)
            }
            ExprKind::Member { owner, feature } if self.is_feature_of_frame(frame, owner, feature) => {
                self.reporter.report(errors::redundant_owner(e.span, &owner.text, &feature.text));
                None
            }
            _ => self.unnamed_point(frame, e),
        }
    }

    /// Returns whether `arm.tip` stands within the braces of `arm`.
    fn is_feature_of_frame(&self, frame: Frame, owner: &Name, feature: &Name) -> bool {
        let is_there = || self.common.features.get(&frame).is_some_and(|space| space.get(&feature.text).is_some());
        self.frame_name(frame) == owner.text && is_there()
    }

    pub(super) fn unnamed_point(&mut self, frame: Frame, e: &Expr) -> Option<PointId> {
        let at = self.place_of(e, "point", "a point", None)?.at;
        Some(self.model.add_point(Point { frame, name: None, span: e.span, at }))
    }

    pub(super) fn lengths_in(&mut self, parts: [&Expr; 2], context: &Context<'_>) -> Option<[ExprId; 2]> {
        let values = parts.map(|part| self.formula(part, context));
        self.two_lengths(parts, values, context)
    }

    /// Evaluates the two coordinates of a point, whose dimensions are judged together.
    pub(super) fn two_lengths(
        &mut self,
        parts: [&Expr; 2],
        [x, y]: [Option<Value>; 2],
        context: &Context<'_>,
    ) -> Option<[ExprId; 2]> {
        let (x, y) = (x?, y?);
        self.unify("the coordinates of a point are", (parts[0].span, x), (parts[1].span, y), context)?;
        for part in parts {
            if !context.judged && self.reject_angle("a coordinate", part) {
                return None;
            }
        }
        for (part, value) in parts.into_iter().zip([x, y]) {
            require_dimension(&mut self.reporter, "a coordinate", Dimension::LENGTH, part.span, value.dim, context)?;
            self.record_length_term(part, value.id, context.judged);
        }
        Some([x.id, y.id])
    }

    pub(in crate::check) fn pair_context(
        &self,
        parts: [&Expr; 2],
        place: &'static str,
        argument: Option<&str>,
    ) -> Context<'static> {
        let judged = parts.iter().any(|part| self.is_dimensional_with(argument, part));
        Context { judged, ..Context::constant(place) }
    }

    /// Evaluates a constant angle, with a warning if it was probably intended in degrees.
    pub(in crate::check) fn angle(&mut self, e: &Expr, place: &str) -> Option<ExprId> {
        self.warn_of_degrees_in(e);
        let (id, _) = self.constant_by(e, place, Dimension::PURE, GuardKind::Finite)?;
        Some(id)
    }

    pub(in crate::check) fn direction_of(&mut self, e: &Expr) -> Option<[ExprId; 2]> {
        let ExprKind::Tuple(parts) = &e.kind else {
            self.reporter.report(errors::no_direction(e.span, describe(e), self.angle_of_place(e)));
            return None;
        };
        let [dx, dy] = parts.as_slice() else {
            self.reporter.report(errors::argument_count(
                "along",
                Keyword::named("along").map(|keyword| &keyword.word),
                e.span,
                "two numbers",
                parts.len(),
            ));
            return None;
        };
        let context = self.pair_context([dx, dy], "a direction", None);
        let (x, y) = (self.formula(dx, &context), self.formula(dy, &context));
        let (x, y) = (x?, y?);
        self.unify("the two parts of the direction are", (dx.span, x), (dy.span, y), &context)?;
        self.not_zero([x.id, y.id], e.span)
    }

    /// Returns the text of the angle of a position given by distance and angle.
    fn angle_of_place(&self, e: &Expr) -> Option<&'a str> {
        match &e.bare().kind {
            ExprKind::Call { name, arguments, .. } if name.text == "polar" => {
                arguments.get(1).map(|angle| self.reporter.text(angle.span))
            }
            _ => None,
        }
    }

    pub(in crate::check) fn not_zero(&mut self, direction: [ExprId; 2], span: Span) -> Option<[ExprId; 2]> {
        let [x, y] = direction.map(|id| self.decided(id, GuardKind::Sign));
        if x? == 0.0 && y? == 0.0 {
            self.reporter.report(errors::zero_direction(span));
            return None;
        }
        Some(direction)
    }

    pub(in crate::check) fn positive_length(&mut self, e: &Expr, what: &str) -> Option<ExprId> {
        let (id, value) = self.constant_by(e, what, Dimension::LENGTH, GuardKind::Sign)?;
        if value <= 0.0 {
            self.reporter.report(errors::not_positive_length(what, e.span, value));
            return None;
        }
        Some(id)
    }
}
