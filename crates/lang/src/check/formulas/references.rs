//! References to features of bodies: `body.point`, `body.axis`, and names where these are expected.

use super::Formulas;
use super::quantities::describe;
use crate::check::errors;
use crate::check::scope::{Entity, coordinate};
use crate::model::{AxisId, CircleId, CurveId, Frame, PointId};
use mechc_syntax::ast::{Expr, ExprKind, Name};

/// A feature that a name of a body stands for; `None` if it is broken, which has been reported.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::check) enum Feature {
    Point(Option<PointId>),
    Axis(Option<AxisId>),
    Circle(Option<CircleId>),
    Curve(Option<CurveId>),
    /// Its declaration does not follow the grammar, which has been reported.
    Broken,
}

impl Feature {
    /// Returns whether it can stand where a feature of that kind is expected. A circle can stand for a curve.
    pub fn is(self, what: &str) -> bool {
        match self {
            Feature::Point(_) => what == "point",
            Feature::Axis(_) => what == "axis",
            Feature::Circle(_) => ["circle", "curve"].contains(&what),
            Feature::Curve(_) => what == "curve",
            Feature::Broken => false,
        }
    }

    /// Returns the noun of the keyword that declares it.
    pub fn with_article(keyword: &str) -> &'static str {
        match keyword {
            "point" => "a point",
            "axis" => "an axis",
            "circle" => "a circle",
            _ => "a curve or a circle",
        }
    }

    pub fn noun(self) -> &'static str {
        match self {
            Feature::Point(_) => "a point",
            Feature::Axis(_) => "an axis",
            Feature::Circle(_) => "a circle",
            Feature::Curve(_) => "a curve",
            Feature::Broken => "a feature that cannot be read",
        }
    }
}

impl Formulas<'_> {
    /// Returns a point of a body or of the ground, or one of the ground by a formula of points.
    pub(in crate::check) fn point(&mut self, e: &Expr) -> Option<PointId> {
        match &e.kind {
            ExprKind::Tuple(_) => self.unnamed_point(self.address.ground, e),
            ExprKind::Member { owner, feature }
                if coordinate(feature).is_some() && self.scope.point_param(owner).is_some() =>
            {
                self.reporter.report(errors::coordinate_as_point(e.span, owner));
                None
            }
            ExprKind::Member { owner, feature } => {
                let frame = self.body(owner)?;
                self.point_named(frame, feature)
            }
            _ if self.is_point(e) => self.unnamed_point(self.address.ground, e),
            ExprKind::Name(name) => {
                self.bare_name(name, "point");
                None
            }
            _ => {
                self.reporter.report(errors::wrong_kind(e.span, "a point", describe(e)));
                None
            }
        }
    }

    pub(super) fn point_named(&mut self, frame: Frame, name: &Name) -> Option<PointId> {
        match self.feature(frame, name, "point", |feature| matches!(feature, Feature::Point(_)))? {
            Feature::Point(point) => point,
            other => {
                self.reporter.report(errors::wrong_kind(name.span, "a point", other.noun()));
                None
            }
        }
    }

    /// Returns an axis of a body or of the ground.
    pub(in crate::check) fn axis(&mut self, e: &Expr) -> Option<AxisId> {
        match &e.kind {
            ExprKind::Member { owner, feature } => {
                let frame = self.body(owner)?;
                match self.feature(frame, feature, "axis", |feature| matches!(feature, Feature::Axis(_)))? {
                    Feature::Axis(axis) => axis,
                    Feature::Point(_) => {
                        let diagnostic = errors::wrong_kind(feature.span, "an axis", "a point");
                        let fix = self.suggest_feature(e, |feature| matches!(feature, Feature::Axis(_)));
                        let owner = self.frame_name(frame);
                        let help =
                            format!("an axis is declared in `{owner}`: `axis way = {} along (1, 0)`", feature.text);
                        self.reporter.report(if fix.is_some() {
                            diagnostic.fix_if(fix)
                        } else {
                            diagnostic.help(help)
                        });
                        None
                    }
                    other => {
                        self.reporter.report(errors::wrong_kind(feature.span, "an axis", other.noun()));
                        None
                    }
                }
            }
            ExprKind::Name(name) => {
                self.bare_name(name, "axis");
                None
            }
            _ => {
                self.reporter.report(errors::wrong_kind(e.span, "an axis", describe(e)));
                None
            }
        }
    }

    /// Reports a name alone where `body.feature` is expected.
    pub(in crate::check) fn bare_name(&mut self, name: &Name, what: &str) {
        let Ok(entity) = self.scope.resolve(name) else { return };
        if entity == Some(Entity::Trace) && what == "point" {
            self.scope.trace_in_a_formula(&mut self.reporter, name.span, "a point", name);
            return;
        }
        let expected = if what == "axis" { "an axis".to_owned() } else { format!("a {what}") };
        let other_owners = self.owners_in_arguments(name.span);
        let owners: Vec<String> = std::iter::once(self.address.ground)
            .chain(self.bodies.iter().copied())
            .filter(|&frame| !other_owners.contains(&self.frame_name(frame)))
            .filter(|frame| self.common.features.get(frame).is_some_and(|space| space.get(&name.text).is_some()))
            .map(|frame| format!("`{}.{}`", self.frame_name(frame), name.text))
            .collect();
        let help = match (owners.is_empty(), entity) {
            (false, _) => format!("was {} meant?", owners.join(" or ")),
            (true, Some(Entity::Body(_))) => match &self.features_of(name, |feature| feature.is(what))[..] {
                [] => format!("name one of its features: `{}.…`", name.text),
                names => format!("name one of its features: {}", names.join(", ")),
            },
            _ => format!("outside a body {expected} is written `body.{}`", name.text),
        };
        let found = match self.scope.describe_name(name) {
            "a name" => format!("the name `{}`", name.text),
            noun => noun.to_owned(),
        };
        self.reporter.report(errors::wrong_kind(name.span, &expected, &found).help(help));
    }

    pub(in crate::check) fn feature(
        &mut self,
        frame: Frame,
        name: &Name,
        what: &str,
        expected: impl Fn(Feature) -> bool,
    ) -> Option<Feature> {
        let space = self.common.features.get(&frame)?;
        match space.get(&name.text) {
            Some(Feature::Broken) => return None,
            None if space.is_incomplete() => return None,
            None => {}
            feature => return feature,
        }
        let candidates = space.suggestions(&self.reporter, expected);
        let diagnostic = errors::unknown_feature(what, self.frame_name(frame), name, &candidates);
        self.reporter.report(diagnostic);
        None
    }

    /// Describes `owner.feature` for a message.
    pub(super) fn describe_member(&self, owner: &Name, feature: &Name) -> String {
        let space = self.frame_of(owner).and_then(|frame| self.common.features.get(&frame));
        let found = space.and_then(|space| space.get(&feature.text));
        if let (None, Some(Entity::Joint(_))) = (space, self.scope.entity(owner)) {
            return "a coordinate of a joint, which is a column of the table and stands in no formula".to_owned();
        }
        found.map_or("a feature of a body", Feature::noun).to_owned()
    }
}
