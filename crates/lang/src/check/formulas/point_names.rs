//! Names of points: those of the body around a formula, and those of the mechanism.

use super::Formulas;
use super::formula_scope::{FormulaScope, FormulaSite, InitialPoint};
use super::references::Feature;
use crate::check::errors;
use crate::check::scope::{BrokenName, Entity, Expected, Space, coordinate, point_kinds};
use crate::model::{Frame, PointId};
use mechc_syntax::ast::{Expr, ExprKind, Name};
use mechc_text::diag::Diagnostic;
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// A point of the body around a formula.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) enum BodyPoint {
    Point(PointId),
    /// A broken declaration, which has been reported.
    Broken,
}

/// The entity of a name or `body.feature` where a point is expected.
pub(super) enum PointLookup {
    Point(InitialPoint),
    /// A broken declaration, which has been reported.
    Broken,
    /// Not a point.
    NotAPoint,
}

impl<'a> Formulas<'a> {
    /// Returns the points of a body that the formula of each one uses.
    pub(in crate::check) fn uses_of_points<'n>(
        &mut self,
        frame: Frame,
        points: &[(&'n Name, Option<&'a Expr>)],
    ) -> Vec<(&'n Name, Vec<(usize, Span)>)> {
        // A duplicate name keeps its first meaning.
        let mut positions = FxHashMap::default();
        for (k, (name, _)) in points.iter().enumerate() {
            positions.entry(name.text.as_str()).or_insert(k);
        }
        let outer = std::mem::replace(&mut self.current.site, FormulaSite::Inside(frame));
        let uses = points.iter().map(|&(name, formula)| {
            let mut uses = Vec::new();
            if let Some(formula) = formula {
                let hidden = |name: &str| self.scope.hides(name);
                point_kinds::names_in(formula, Expected::Point, hidden, |used, expected| {
                    let is_local = used.text != name.text && self.body_point(used, expected).is_some();
                    uses.extend(positions.get(used.text.as_str()).filter(|_| is_local).map(|&k| (k, used.span)));
                });
            }
            (name, uses)
        });
        let uses = uses.collect();
        self.current.site = outer;
        uses
    }

    // ---- sites of formulas

    /// Runs `read` at a site. A formula that mixes points of two frames is reported.
    pub(in crate::check) fn at_site<T>(
        &mut self,
        site: FormulaSite,
        defined: Option<&'a str>,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        self.in_scope(FormulaScope { site, defined, ..FormulaScope::default() }, read)
    }

    /// Runs `read` for the formula of a curve, with its argument.
    pub(in crate::check) fn at_curve<T>(
        &mut self,
        frame: Frame,
        argument: &'a str,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        self.in_scope(
            FormulaScope { site: FormulaSite::Inside(frame), argument: Some(argument), ..FormulaScope::default() },
            read,
        )
    }

    fn in_scope<T>(&mut self, scope: FormulaScope<'a>, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let site = scope.site;
        let outer = std::mem::replace(&mut self.current, scope);
        let value = read(self);
        let FormulaScope { of_body, of_mechanism, .. } = std::mem::replace(&mut self.current, outer);
        match (site, of_body, of_mechanism) {
            (FormulaSite::Inside(frame), Some(inner), Some(other)) if self.is_placed(frame) => {
                let body = self.frame_name(frame).to_owned();
                self.reporter.report(errors::two_frames(&body, inner, other));
                None
            }
            _ => value,
        }
    }

    fn is_placed(&self, frame: Frame) -> bool {
        match frame {
            Frame::Ground | Frame::Part(_) => false,
            Frame::Body(body) => self.model[body].pose_span.is_some(),
        }
    }

    /// Returns the point of the body around a formula that a name stands for.
    pub(in crate::check) fn body_point(&self, name: &Name, expected: Expected) -> Option<BodyPoint> {
        let FormulaSite::Inside(frame) = self.current.site else { return None };
        if self.current.defined == Some(name.text.as_str())
            || expected == Expected::Number
            || expected == Expected::Either
                && (self.current.argument == Some(&name.text) || self.scope.is_number_name(name))
        {
            return None;
        }
        match self.common.features.get(&frame)?.get(&name.text)? {
            Feature::Point(Some(point)) => Some(BodyPoint::Point(point)),
            Feature::Point(None) | Feature::Broken => Some(BodyPoint::Broken),
            _ => None,
        }
    }

    /// Returns whether a formula is a point, by its form and names.
    pub(in crate::check) fn is_point(&self, e: &Expr) -> bool {
        point_kinds::is_point(
            e,
            |name| self.scope.hides(name),
            |e| match &e.kind {
                ExprKind::Name(name) => {
                    self.body_point(name, Expected::Either).is_some() || self.scope.point_param(name).is_some()
                }
                ExprKind::Member { owner, feature } => self.is_drawn_feature(owner, feature),
                _ => false,
            },
        )
    }

    /// Returns whether `owner.feature` is a point of a body, and not a coordinate.
    fn is_drawn_feature(&self, owner: &Name, feature: &Name) -> bool {
        if self.body_point(owner, Expected::Point).is_some() {
            return false;
        }
        let frame = match self.scope.entity(owner) {
            _ if owner.text == "ground" => self.address.ground,
            Some(Entity::Body(k)) => match self.bodies.get(k) {
                Some(&frame) => frame,
                None => return false,
            },
            _ => return false,
        };
        let found = self.common.features.get(&frame).and_then(|space| space.get(&feature.text));
        matches!(found, Some(Feature::Point(_)))
    }

    /// Records that the current formula uses a point of its body.
    pub(super) fn record_body_point(&mut self, name: &Name) {
        if self.body_point(name, Expected::Point).is_some() {
            self.current.of_body.get_or_insert(name.span);
        }
    }

    /// Evaluates a lone `point A`.
    pub(in crate::check) fn point_of_the_mechanism(&mut self, name: &Name) -> Option<InitialPoint> {
        match self.lookup_point(name, Expected::Point) {
            PointLookup::Point(drawn) => Some(drawn),
            PointLookup::Broken => None,
            PointLookup::NotAPoint => {
                self.no_point_to_take(name);
                None
            }
        }
    }

    // ---- dimensions

    /// Returns whether the name of a point makes a formula dimensional.
    pub(super) fn is_dimensional_point(&self, name: &Name, expected: Expected) -> bool {
        match self.body_point(name, expected) {
            Some(BodyPoint::Point(point)) => self.common.dimensional_points.contains(&point),
            Some(BodyPoint::Broken) => false,
            None => {
                self.scope.point_param(name).and_then(|k| self.params[k].drawn).is_some_and(|drawn| drawn.dimensional)
            }
        }
    }

    /// Looks up a name where a point is expected.
    pub(super) fn lookup_point(&mut self, name: &Name, expected: Expected) -> PointLookup {
        if let Some(point) = self.body_point(name, expected) {
            self.current.of_body.get_or_insert(name.span);
            return match point {
                BodyPoint::Broken => PointLookup::Broken,
                BodyPoint::Point(point) => {
                    let (at, dimensional) = (self.model[point].at, self.common.dimensional_points.contains(&point));
                    PointLookup::Point(InitialPoint { at, dimensional })
                }
            };
        }
        match self.scope.point_param(name) {
            Some(k) => {
                self.current.of_mechanism.get_or_insert(name.span);
                self.params[k].drawn.map_or(PointLookup::Broken, PointLookup::Point)
            }
            None => PointLookup::NotAPoint,
        }
    }

    /// Returns the entity of a name that is not a point. `Err` if it is broken, which has been reported.
    fn non_point_entity(&self, name: &Name) -> Result<Option<Entity>, BrokenName> {
        match self.scope.resolve(name)? {
            Some(Entity::Param(k)) if self.params[k].value.is_none() => Err(BrokenName),
            entity => Ok(entity),
        }
    }

    /// Reports that the mechanism has no point for a lone `point A`.
    fn no_point_to_take(&mut self, name: &Name) {
        let Ok(entity) = self.non_point_entity(name) else { return };
        let candidates = self.scope.point_param_names(&self.reporter);
        let diagnostic = errors::no_point_to_take(name, entity.map(Entity::noun), &candidates);
        self.reporter.report(diagnostic);
    }

    /// Reports a name in a formula of points that is not a point.
    pub(super) fn no_point_named(&mut self, name: &Name) {
        let Ok(entity) = self.non_point_entity(name) else { return };
        let space_of_body = match self.current.site {
            FormulaSite::Inside(frame) => self.common.features.get(&frame),
            _ => None,
        };
        if space_of_body.is_some_and(Space::is_incomplete) {
            return;
        }
        let feature =
            space_of_body.and_then(|space| space.get(&name.text)).filter(|_| self.current.defined != Some(&name.text));
        let found = match (feature, entity) {
            (Some(feature), _) => Some(feature.noun()),
            (None, Some(Entity::Param(_))) => Some("a number"),
            (None, Some(entity)) => Some(entity.noun()),
            (None, None) if self.scope.is_number_name(name) => Some("a number"),
            (None, None) => None,
        };
        let Some(found) = found else {
            let is_other = |name: &&str| self.current.defined != Some(*name);
            let mut candidates = space_of_body.map_or_else(Vec::new, |space| {
                space.suggestions(&self.reporter, |feature| matches!(feature, Feature::Point(_)))
            });
            candidates.retain(is_other);
            candidates.extend(self.scope.point_param_names(&self.reporter));
            let diagnostic = errors::unknown_point(name, &candidates);
            self.reporter.report(diagnostic);
            return;
        };
        let diagnostic = errors::wrong_kind(name.span, "a point", found);
        self.reporter.report(match entity {
            Some(Entity::Body(_)) if feature.is_none() && self.current.site.takes_drawn_points() => {
                diagnostic.help(format!("name one of its points: `{}.…`", name.text))
            }
            Some(Entity::Param(_)) => {
                diagnostic.help(format!("a point is written `(x, y)`: `({}, 0)`, say", name.text))
            }
            _ => diagnostic,
        });
    }

    pub(super) fn is_named_point(&self, name: &Name) -> bool {
        self.body_point(name, Expected::Point).is_some() || self.scope.point_param(name).is_some()
    }

    /// Returns the diagnostic of `owner.feature` where a point of the drawing is expected.
    pub(super) fn no_place(&self, span: Span, owner: &Name, feature: &Name) -> Diagnostic {
        match coordinate(feature) {
            Some(_) if self.is_named_point(owner) => errors::coordinate_as_point(span, owner),
            None if self.is_named_point(owner) => errors::no_coordinate(owner, feature),
            _ if self.scope.is_body(owner) => errors::moving_point(span, &owner.text, &feature.text),
            _ => errors::wrong_kind(span, "a point", &self.describe_member(owner, feature)),
        }
    }
}
