//! Calls of kinematic quantities, and the references to features that they take.

use super::formula::{Context, Dim, Value};
use super::names::Entity;
use super::{Checker, errors};
use crate::model::{AxisId, Direction, Frame, JointId, JointKind, Named, PointId, Quantity};
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, Name};
use crate::vocabulary::QuantityWord;

impl Checker<'_> {
    /// `x(P)`, `angle(b, c)`, `rotation(J)` …
    pub(super) fn quantity(
        &mut self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        if !context.quantities {
            self.report(errors::quantity_in(context.place, &name.text, e.span));
            return None;
        }
        let quantity = match (name.text.as_str(), arguments) {
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
                match self.model[joint].kind {
                    JointKind::Translational(a, b) => Quantity::Displacement(joint, a, b),
                    _ => return None,
                }
            }
            (what, _) => {
                let quantity = QuantityWord::named(what)?;
                let found = arguments.len();
                self.report(errors::argument_count(what, Some(&quantity.word), e.span, quantity.takes, found));
                return None;
            }
        };
        let dim = match quantity {
            Quantity::Angle(..) | Quantity::Rotation(..) => Dim::PURE,
            _ => Dim::LENGTH,
        };
        Some(Value { id: self.name_symbol(Named::Quantity(quantity), 0), dim })
    }

    pub(super) fn two_points(&mut self, p: &Expr, q: &Expr) -> Option<(PointId, PointId)> {
        let (p, q) = (self.point(p), self.point(q));
        Some((p?, q?))
    }

    /// A body, the ground, or an axis.
    fn direction(&mut self, e: &Expr) -> Option<Direction> {
        match &e.kind {
            ExprKind::Paren(inner) => self.direction(inner),
            ExprKind::Name(name) => self.body(name).map(Direction::Frame),
            ExprKind::Member { .. } => self.axis(e).map(Direction::Axis),
            _ => {
                let found = Self::describe(e);
                self.report(errors::wrong_kind(e.span, "a body or an axis", found));
                None
            }
        }
    }

    fn rotation_between(&mut self, joint: &Expr, u: &Expr, v: &Expr) -> Option<Quantity> {
        let joint = self.joint_with("rotation", joint);
        let (u_id, v_id) = (self.axis(u), self.axis(v));
        let (joint, u_id, v_id) = (joint?, u_id?, v_id?);
        let frames = self.model[joint].kind.frames(&self.model);
        for (axis, e, frame) in [(u_id, u, frames[0]), (v_id, v, frames[1])] {
            if self.model[axis].frame != frame {
                let wanted = self.model.frame_name(frame).to_owned();
                let (joint, axis) = (self.model[joint].declared.name.clone(), self.model[axis].name.clone());
                self.report(errors::axes_elsewhere(&joint, &axis, e.span, &wanted));
                return None;
            }
        }
        Some(Quantity::Rotation(joint, Some((u_id, v_id))))
    }

    /// A joint of the kind that has the quantity.
    fn joint_with(&mut self, quantity: &str, e: &Expr) -> Option<JointId> {
        let ExprKind::Name(name) = &e.bare().kind else {
            let found = Self::describe(e);
            self.report(errors::wrong_kind(e.span, "a joint", found));
            return None;
        };
        let joint = match self.resolve(name).ok()? {
            Some(Entity::Joint(k)) => self.joints.get(k).copied().flatten()?,
            Some(entity) => {
                let diagnostic = errors::wrong_kind(name.span, "a joint", entity.noun());
                self.report(self.joint_for(quantity, name, diagnostic));
                return None;
            }
            None => {
                let known = self.suggestions(|entity| matches!(entity, Entity::Joint(_)));
                let diagnostic = errors::unknown("joint", name, &known);
                self.report(diagnostic);
                return None;
            }
        };
        let kind = self.model[joint].kind;
        let (fits, wanted) = match quantity {
            "rotation" => (matches!(kind, JointKind::Revolute(..)), "revolute"),
            _ => (matches!(kind, JointKind::Translational(..)), "translational"),
        };
        if fits {
            return Some(joint);
        }
        let declared = self.model[joint].declared.clone();
        self.report(errors::joint_without(quantity, wanted, &declared.name, kind.word(), name.span, declared.span));
        None
    }

    /// A body of that name, or the ground.
    pub(super) fn body(&mut self, name: &Name) -> Option<Frame> {
        if name.text == "ground" {
            return Some(Frame::Ground);
        }
        match self.resolve(name).ok()? {
            Some(Entity::Body(k)) => Some(Frame::Body(self.bodies[k])),
            Some(entity) => {
                self.report(errors::wrong_kind(name.span, "a body", entity.noun()));
                None
            }
            None => {
                self.unknown_body(name);
                None
            }
        }
    }

    /// What stands in the place of something else.
    pub(super) fn describe(e: &Expr) -> &'static str {
        match &e.bare().kind {
            ExprKind::Literal { .. } => "a number",
            ExprKind::Tuple(_) => "a literal point",
            ExprKind::Member { .. } => "a feature of a body",
            ExprKind::Name(_) => "a name",
            ExprKind::Not(_) | ExprKind::Compare(..) | ExprKind::And(_) | ExprKind::Or(_) => "a condition",
            _ => "a formula",
        }
    }

    /// What a name in the place of a feature stands for.
    pub(super) fn describe_name(&self, name: &Name) -> &'static str {
        self.entity(name).map_or("a name", Entity::noun)
    }

    /// Every frame that a quantity speaks of.
    pub(super) fn frames_of(&self, quantity: Quantity) -> Vec<Frame> {
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
            Quantity::Rotation(joint, _) | Quantity::Displacement(joint, ..) => {
                self.model[joint].kind.frames(&self.model).to_vec()
            }
        }
    }

    /// Says that a span holds something of the wrong kind.
    pub(super) fn wrong_kind(&mut self, span: Span, wanted: &str, found: &str) {
        self.report(errors::wrong_kind(span, wanted, found));
    }
}
