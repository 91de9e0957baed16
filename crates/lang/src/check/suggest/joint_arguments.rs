//! Suggestions for joint arguments in another order, or for another kind of joint.

use crate::check::errors;
use crate::check::formulas::{Feature, Formulas};
use crate::check::scope::Entity;
use crate::model::Frame;
use mechc_syntax::ast::{Expr, ExprKind, Name};
use mechc_text::diag::{Applicability, Edit, Fix};
use mechc_text::vocabulary::{FeatureWord, JointSpec};

impl Formulas<'_> {
    /// Reports a joint whose first two arguments are swapped or belong to another kind of joint.
    pub(in crate::check) fn refuses_arguments(&mut self, kind: &Name, spec: &JointSpec, arguments: &[Expr]) -> bool {
        let [first, second, ..] = arguments else { return false };
        let (Some(a), Some(b)) = (self.feature_of(first), self.feature_of(second)) else { return false };
        let [one, other] = spec.features.map(FeatureWord::word);
        let fix = if !a.is(one) && a.is(other) && b.is(one) {
            self.swapped(first, second)
        } else if spec.features == [FeatureWord::Point, FeatureWord::Curve]
            && matches!(a, Feature::Circle(_))
            && b.is("curve")
        {
            Fix::replace(kind.span, "cam", "a circle on a curve is a `cam`", Applicability::Probably)
        } else {
            return false;
        };
        self.reporter.report(errors::wrong_kind(first.span, Feature::with_article(one), a.noun()).fix(fix));
        true
    }

    fn swapped(&self, first: &Expr, second: &Expr) -> Fix {
        let [one, other] = [first, second].map(|e| self.reporter.text(e.span).to_owned());
        let message = format!("the other way round: `{other}, {one}`");
        let edits = vec![Edit { span: first.span, text: other }, Edit { span: second.span, text: one }];
        Fix { message, edits, applies: Applicability::Probably }
    }

    /// Returns the feature of `owner.feature`, if it is declared.
    fn feature_of(&self, e: &Expr) -> Option<Feature> {
        let ExprKind::Member { owner, feature } = &e.kind else { return None };
        self.common.features.get(&self.frame_of(owner)?)?.get(&feature.text)
    }

    /// Returns the body of a name, or the ground, without diagnostics.
    pub(in crate::check) fn frame_of(&self, owner: &Name) -> Option<Frame> {
        match self.scope.entity(owner) {
            _ if owner.text == "ground" => Some(self.address.ground),
            Some(Entity::Body(k)) => Some(*self.bodies.get(k)?),
            _ => None,
        }
    }
}
