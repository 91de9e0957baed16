//! Circles and curves: the profiles of wheels and contacts.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{Dim, Feature, FormulaSite, Value, describe};
use crate::model::{Circle, CircleId, Curve, CurveId, Frame, Named, Profile};
use mechc_expr::Dependence;
use mechc_syntax::ast::{self, Expr, ExprKind, FeatureKind, Name};
use mechc_text::source::Span;

impl<'a> Builder<'_, 'a> {
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
        let center = self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| formulas.place(frame, center));
        let radius = self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| {
            formulas.positive_length(radius, "the radius of a circle")
        });
        let (center, radius) = (center?, radius?);
        Some(self.formulas.model.add_circle(Circle { frame, name: name.text.clone(), span: name.span, center, radius }))
    }

    fn curve_feature(
        &mut self,
        frame: Frame,
        name: &Name,
        argument: &'a Name,
        at: &Expr,
        estimate: Option<&Expr>,
    ) -> Option<CurveId> {
        let id = self.formulas.name_symbol(Named::Argument, 0);
        let value = Value { id, dim: Dim::PURE };
        let before = self.formulas.model.conditions.len();
        let pair = self.formulas.at_curve(frame, &argument.text, |formulas| {
            formulas.place_of(at, "curve", "a curve", Some((&argument.text, value)))
        });
        // Conditions of the argument only apply at a contact.
        let mut conditions = self.formulas.model.conditions.split_off(before);
        for condition in &mut conditions {
            condition.owner.clone_from(&name.text);
        }
        let estimate = match estimate {
            None => None,
            Some(estimate) => Some(self.formulas.at_site(FormulaSite::Inside(frame), None, |formulas| {
                formulas.angle(estimate, "the estimate of a curve's argument")
            })?),
        };
        let pair = pair?.at;
        if !pair.iter().any(|&id| self.formulas.model.graph.dependence(id).on(Dependence::NAMED)) {
            self.formulas.reporter.report(errors::curve_is_a_point(name, &argument.text, at.span));
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
        Some(self.formulas.model.add_curve(curve))
    }

    /// Returns a circle of a body or of the ground.
    pub(in crate::check) fn circle(&mut self, e: &Expr) -> Option<CircleId> {
        let is_circle = |feature| matches!(feature, Feature::Circle(_));
        match self.feature_at(e, "circle", is_circle)? {
            (Feature::Circle(circle), _) => circle,
            (other, span) => {
                let diagnostic = errors::wrong_kind(span, "a circle", other.noun());
                self.formulas.reporter.report(diagnostic.fix_if(self.formulas.suggest_feature(e, is_circle)));
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
                self.formulas.reporter.report(diagnostic.fix_if(self.formulas.suggest_feature(e, is_profile)));
                None
            }
        }
    }

    /// Returns the feature of `body.feature`, with the location of its name.
    fn feature_at(&mut self, e: &Expr, what: &str, expected: impl Fn(Feature) -> bool) -> Option<(Feature, Span)> {
        match &e.kind {
            ExprKind::Member { owner, feature } => {
                let frame = self.formulas.body(owner)?;
                self.formulas.feature(frame, feature, what, expected).map(|found| (found, feature.span))
            }
            ExprKind::Name(name) => {
                self.formulas.bare_name(name, what);
                None
            }
            _ => {
                let expected = format!("a {what}");
                self.formulas.reporter.report(errors::wrong_kind(e.span, &expected, describe(e)));
                None
            }
        }
    }
}
