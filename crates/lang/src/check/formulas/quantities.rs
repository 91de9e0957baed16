//! Calls of kinematic quantities, and the references to features in them.

use super::Formulas;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::Entity;
use crate::model::{
    AxisId, Condition, ConditionKind, Direction, Frame, Joint, JointId, Measured, MeasuredArgument, Named, PointId,
    Quantity,
};
use mechc_syntax::ast::{Expr, ExprKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{MOST_ARGUMENTS, MeasuredQuantity, QuantityArgument, QuantityWord};

impl Formulas<'_> {
    /// Evaluates `x(P)`, `angle(b, c)`, `rotation(J)` …
    pub(in crate::check) fn quantity(
        &mut self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        if !self.quantity_may_stand(e, name, arguments, context) {
            return None;
        }
        if QuantityWord::named(&name.text).is_some_and(QuantityWord::is_force) {
            return self.force(e, name, arguments, context);
        }
        let quantity = self.quantity_called(e, name, arguments)?;
        if quantity.may_not_exist() {
            self.require_existence(quantity, e.span);
        }
        let id = self.name_symbol(Named::Quantity(self.address.part, quantity), quantity.order());
        Some(Value { id, dim: Dim::Of(quantity.dimension()) })
    }

    /// Returns whether kinematic quantities, and this one, are allowed in a formula; otherwise reports it.
    fn quantity_may_stand(&mut self, e: &Expr, name: &Name, arguments: &[Expr], context: &Context<'_>) -> bool {
        if !context.quantities && context.results {
            let what = format!("the kinematic quantity `{}`", name.text);
            let text = self.reporter.text(e.span);
            self.reporter.report(errors::outside_reduction(&what, e.span, text));
            return false;
        }
        // Computed forces report themselves where they are not allowed.
        let word = QuantityWord::named(&name.text).filter(|word| !word.is_force());
        let Some(word) = word else { return true };
        if !context.quantities {
            self.reporter.report(errors::quantity_in(context.place, &name.text, e.span));
            return false;
        }
        if !context.measures && (word.gives_way() || name.text == "angle" && arguments.len() == 3) {
            let diagnostic = errors::quantity_of_measures(context.place, &name.text, e.span);
            let fix = self.suggest_joint_rate(e, name, arguments, context);
            self.reporter.report(diagnostic.instead_if(fix));
            return false;
        }
        true
    }

    /// Returns the called quantity with its arguments.
    fn quantity_called(&mut self, e: &Expr, name: &Name, arguments: &[Expr]) -> Option<Quantity> {
        Some(match (name.text.as_str(), arguments) {
            ("x", [p]) => Quantity::X(None, self.point(p)?),
            ("y", [p]) => Quantity::Y(None, self.point(p)?),
            ("x", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                Quantity::X(Some(p), q)
            }
            ("y", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                Quantity::Y(Some(p), q)
            }
            ("distance", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                Quantity::Distance(p, q)
            }
            ("angle", [b]) => Quantity::Angle(None, self.direction(b)?),
            ("angle", [b, c]) => {
                let (b, c) = (self.direction(b), self.direction(c));
                Quantity::Angle(Some(b?), c?)
            }
            ("rotation", [joint]) => Quantity::Rotation(self.joint_with("rotation", joint)?, None),
            ("rotation", [joint, u, v]) => self.rotation_between(joint, u, v)?,
            ("displacement", [joint]) => {
                let joint = self.joint_with("displacement", joint)?;
                let [a, b] = self.model[joint].guide()?;
                Quantity::Displacement(joint, a, b)
            }
            ("angle", [p, q, r]) => {
                let [p, q, r] = [p, q, r].map(|point| self.point(point));
                Quantity::Corner([p?, q?, r?])
            }
            (what, _) => {
                let word = QuantityWord::named(what)?;
                let measured = word.measured().filter(|spec| spec.accepts(arguments.len()));
                if let Some(spec) = measured {
                    let arguments = self.measured_arguments(what, spec, arguments)?;
                    return Some(Quantity::Measured(Measured { word, arguments }));
                }
                let found = arguments.len();
                self.reporter.report(errors::argument_count(what, Some(&word.word), e.span, word.takes, found));
                return None;
            }
        })
    }

    /// Returns the arguments of a quantity of the motion.
    fn measured_arguments(
        &mut self,
        quantity: &str,
        spec: MeasuredQuantity,
        arguments: &[Expr],
    ) -> Option<[Option<MeasuredArgument>; MOST_ARGUMENTS]> {
        let (mut found, mut is_complete) = ([None; MOST_ARGUMENTS], true);
        for (k, (kind, place)) in spec.arguments.iter().zip(&mut found).enumerate() {
            *place = match (kind, arguments.get(k)) {
                (QuantityArgument::Point, Some(e)) => self.point(e).map(MeasuredArgument::Point),
                (QuantityArgument::Contact, Some(e)) => self.joint_with(quantity, e).map(MeasuredArgument::Joint),
                (_, Some(e)) => self.body_of(e).map(MeasuredArgument::Frame),
                (_, None) => Some(MeasuredArgument::Frame(self.address.ground)),
            };
            is_complete &= place.is_some();
        }
        is_complete.then_some(found)
    }

    /// Adds the condition that a quantity exists, in the current branch.
    fn require_existence(&mut self, quantity: Quantity, span: Span) {
        let exists = self.name_symbol(Named::Exists(self.address.part, quantity), quantity.order());
        let one = self.model.graph.constant(1.0);
        let positive = self.branch.guard.map_or(exists, |guard| self.model.graph.select(guard, exists, one));
        let kind = ConditionKind::Existence;
        self.model.conditions.push(Condition { positive, kind, span, owner: String::new() });
    }

    /// Returns a body or the ground.
    fn body_of(&mut self, e: &Expr) -> Option<Frame> {
        if let ExprKind::Name(name) = &e.bare().kind {
            return self.body(name);
        }
        self.reporter.report(errors::wrong_kind(e.span, "a body", describe(e)));
        None
    }

    pub(super) fn two_points(&mut self, p: &Expr, q: &Expr) -> Option<(PointId, PointId)> {
        let (p, q) = (self.point(p), self.point(q));
        Some((p?, q?))
    }

    /// Returns the direction of a body, the ground or an axis.
    fn direction(&mut self, e: &Expr) -> Option<Direction> {
        match &e.kind {
            ExprKind::Paren(inner) => self.direction(inner),
            ExprKind::Name(name) => self.body(name).map(Direction::Frame),
            ExprKind::Member { .. } => self.axis(e).map(Direction::Axis),
            _ => {
                let found = describe(e);
                self.reporter.report(errors::wrong_kind(e.span, "a body or an axis", found));
                None
            }
        }
    }

    fn rotation_between(&mut self, joint: &Expr, u: &Expr, v: &Expr) -> Option<Quantity> {
        let joint = self.joint_with("rotation", joint);
        let (u_id, v_id) = (self.axis(u), self.axis(v));
        let (joint, u_id, v_id) = (joint?, u_id?, v_id?);
        let frames = self.model[joint].frames(&self.model);
        for (axis, e, frame) in [(u_id, u, frames[0]), (v_id, v, frames[1])] {
            if self.model[axis].frame != frame {
                let expected = self.frame_name(frame).to_owned();
                let (joint, axis) = (self.model[joint].declared.name.clone(), self.model[axis].name.clone());
                self.reporter.report(errors::axes_elsewhere(&joint, &axis, e.span, &expected));
                return None;
            }
        }
        Some(Quantity::Rotation(joint, Some((u_id, v_id))))
    }

    /// Returns a joint of a kind that has the quantity.
    fn joint_with(&mut self, quantity: &str, e: &Expr) -> Option<JointId> {
        let (joint, name) = self.joint_named(quantity, e)?;
        let Joint { spec, declared, .. } = &self.model[joint];
        if spec.has_quantity(quantity) {
            return Some(joint);
        }
        let diagnostic = errors::joint_without(quantity, &declared.name, spec, name.span, declared.span);
        self.reporter.report(diagnostic);
        None
    }

    /// Returns the joint that an argument names, of any kind.
    pub(super) fn joint_named<'e>(&mut self, quantity: &str, e: &'e Expr) -> Option<(JointId, &'e Name)> {
        let ExprKind::Name(name) = &e.bare().kind else {
            let found = describe(e);
            self.reporter.report(errors::wrong_kind(e.span, "a joint", found));
            return None;
        };
        let joint = match self.scope.resolve(name).ok()? {
            Some(Entity::Joint(k)) => self.joints.get(k).copied().flatten()?,
            Some(entity) => {
                let diagnostic = errors::wrong_kind(name.span, "a joint", entity.noun());
                self.reporter.report(self.suggest_joint(quantity, name, diagnostic));
                return None;
            }
            None => {
                let candidates = self.scope.suggestions(&self.reporter, |entity| matches!(entity, Entity::Joint(_)));
                let diagnostic = errors::unknown("joint", name, &candidates);
                self.reporter.report(diagnostic);
                return None;
            }
        };
        Some((joint, name))
    }

    /// Returns the body of a name, or the ground.
    pub(in crate::check) fn body(&mut self, name: &Name) -> Option<Frame> {
        if name.text == "ground" {
            return Some(self.address.ground);
        }
        match self.scope.resolve(name).ok()? {
            Some(Entity::Body(k)) => self.bodies.get(k).copied(),
            Some(entity) => {
                self.reporter.report(errors::wrong_kind(name.span, "a body", entity.noun()));
                None
            }
            None => {
                self.unknown_body(name);
                None
            }
        }
    }

    /// Returns every frame on which a quantity depends.
    pub(in crate::check) fn frames_of(&self, quantity: Quantity) -> Vec<Frame> {
        let point = |p: PointId| self.model[p].frame;
        let axis = |a: AxisId| self.model[a].frame;
        let direction = |d: Direction| match d {
            Direction::Frame(frame) => frame,
            Direction::Axis(a) => axis(a),
        };
        match quantity {
            Quantity::X(p, q) | Quantity::Y(p, q) => p.into_iter().chain([q]).map(point).collect(),
            Quantity::Distance(p, q) => vec![point(p), point(q)],
            Quantity::Angle(a, b) => a.into_iter().chain([b]).map(direction).collect(),
            Quantity::Corner(points) => points.map(point).to_vec(),
            Quantity::Measured(measured) => {
                let joined = measured.joints().flat_map(|joint| self.model[joint].frames(&self.model));
                measured.points().map(point).chain(measured.frames()).chain(joined).collect()
            }
            Quantity::Rotation(joint, _) | Quantity::Displacement(joint, ..) => {
                self.model[joint].frames(&self.model).to_vec()
            }
        }
    }
}

/// Describes a formula for a message.
pub(in crate::check) fn describe(e: &Expr) -> &'static str {
    match &e.bare().kind {
        ExprKind::Literal { .. } => "a number",
        ExprKind::Tuple(_) => "a literal point",
        ExprKind::Member { .. } => "a feature of a body",
        ExprKind::Name(_) => "a name",
        ExprKind::Path(segments) if segments.iter().any(|one| !one.indices.is_empty()) => "a path with brackets",
        ExprKind::Path(_) => "a path that goes on",
        ExprKind::Not(_) | ExprKind::Compare(..) | ExprKind::And(_) | ExprKind::Or(_) => "a condition",
        _ => "a formula",
    }
}
