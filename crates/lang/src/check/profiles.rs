//! Circles and curves: the profiles of wheels and contacts.

use super::features::Feature;
use super::formula::{Context, Dim, Value};
use super::formula_scope::{FormulaSite, InitialPoint};
use super::quantities::describe;
use super::suggest::edits;
use super::{Checker, errors};
use crate::model::{Circle, CircleId, Curve, CurveId, Frame, Named, Profile};
use mechc_expr::Dependence;
use mechc_syntax::ast::{self, Expr, ExprKind, FeatureKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::Keyword;

impl<'a> Checker<'a> {
    pub(super) fn profiles_of(&mut self, frame: Frame, features: &'a [ast::Feature]) {
        for feature in features {
            let settled = match &feature.kind {
                FeatureKind::Circle { center, radius } => {
                    Feature::Circle(self.circle_feature(frame, &feature.name, center, radius))
                }
                FeatureKind::Curve { argument, at, estimate } => {
                    Feature::Curve(self.curve_feature(frame, &feature.name, argument, at, estimate.as_deref()))
                }
                _ => continue,
            };
            self.settle(frame, &feature.name, settled);
        }
    }

    fn circle_feature(&mut self, frame: Frame, name: &Name, center: &Expr, radius: &Expr) -> Option<CircleId> {
        let center = self.at_site(FormulaSite::Inside(frame), None, |checker| checker.place(frame, center));
        let radius = self.at_site(FormulaSite::Inside(frame), None, |checker| checker.radius(radius));
        let (center, radius) = (center?, radius?);
        Some(self.model.add_circle(Circle { frame, name: name.text.clone(), span: name.span, center, radius }))
    }

    fn curve_feature(
        &mut self,
        frame: Frame,
        name: &Name,
        argument: &'a Name,
        at: &Expr,
        estimate: Option<&Expr>,
    ) -> Option<CurveId> {
        let id = self.name_symbol(Named::Argument, 0);
        let value = Value { id, dim: Dim::PURE };
        let before = self.model.conditions.len();
        let pair = self.at_curve(frame, &argument.text, |checker| {
            checker.place_of(at, "curve", "a curve", Some((&argument.text, value)))
        });
        // Conditions of the argument only apply at a contact.
        let mut conditions = self.model.conditions.split_off(before);
        for condition in &mut conditions {
            condition.owner.clone_from(&name.text);
        }
        let estimate = match estimate {
            None => None,
            Some(estimate) => Some(self.at_site(FormulaSite::Inside(frame), None, |checker| {
                checker.angle(estimate, "the estimate of a curve's argument")
            })?),
        };
        let pair = pair?.at;
        if !pair.iter().any(|&id| self.model.graph.dependence(id).on(Dependence::NAMED)) {
            self.reporter.report(errors::curve_is_a_point(name, &argument.text, at.span));
            return None;
        }
        let curve = Curve {
            frame,
            name: name.text.clone(),
            span: name.span,
            argument: argument.text.clone(),
            at: pair,
            estimate,
            conditions,
        };
        Some(self.model.add_curve(curve))
    }

    /// Returns a circle of a body or of the ground.
    pub(super) fn circle(&mut self, e: &Expr) -> Option<CircleId> {
        let is_circle = |feature| matches!(feature, Feature::Circle(_));
        match self.feature_at(e, "circle", is_circle)? {
            (Feature::Circle(circle), _) => circle,
            (other, span) => {
                let diagnostic = errors::wrong_kind(span, "a circle", other.noun());
                self.reporter.report(diagnostic.fix_if(self.suggest_profile(e, is_circle)));
                None
            }
        }
    }

    /// Returns a curve of a body or of the ground, or a circle in its place.
    pub(super) fn profile(&mut self, e: &Expr) -> Option<Profile> {
        let is_profile = |feature| matches!(feature, Feature::Circle(_) | Feature::Curve(_));
        match self.feature_at(e, "curve", is_profile)? {
            (Feature::Circle(circle), _) => circle.map(Profile::Circle),
            (Feature::Curve(curve), _) => curve.map(Profile::Curve),
            (other, span) => {
                let diagnostic = errors::wrong_kind(span, "a curve or a circle", other.noun());
                self.reporter.report(diagnostic.fix_if(self.suggest_profile(e, is_profile)));
                None
            }
        }
    }

    /// Returns the feature of `body.feature`, with the location of its name.
    fn feature_at(&mut self, e: &Expr, what: &str, expected: impl Fn(Feature) -> bool) -> Option<(Feature, Span)> {
        match &e.kind {
            ExprKind::Member { owner, feature } => {
                let frame = self.body(owner)?;
                self.feature(frame, feature, what, expected).map(|found| (found, feature.span))
            }
            ExprKind::Name(name) => {
                self.bare_name(name, what);
                None
            }
            _ => {
                let expected = format!("a {what}");
                self.reporter.report(errors::wrong_kind(e.span, &expected, describe(e)));
                None
            }
        }
    }

    /// Evaluates `(x, y)`, whose dimensions are judged together, or another formula of points, with an argument if given.
    pub(super) fn place_of(
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
                    self.reporter.report(edits::with_preferred_fix(diagnostic, self.suggest_decimal_point(parts, 2)));
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
}
