//! Joints, measures, constraints, drivers and the analysis.

use super::formula::Context;
use super::{Checker, declared, errors};
use crate::expr::{Dependence, ExprId, Symbol};
use crate::model::{
    Analysis, Condition, ConditionKind, Dimension, Equation, EquationForm, Frame, Joint, JointKind, Measure, Named,
    PointId, Quantity,
};
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, ItemKind, Name};

const JOINTS: &[&str] = &["revolute", "translational", "weld", "revolute_revolute", "revolute_translational"];

/// Joints of the language that this version reads only.
const LATER_JOINTS: &[&str] = &["gear", "internal_gear", "rack_pinion", "point_follower", "cam", "flat_follower"];

impl Checker<'_> {
    pub(super) fn joints(&mut self) {
        for item in self.items() {
            if let ItemKind::Joint { name, kind, arguments, call_span } = &item.kind {
                let joint = self.joint_kind(name, kind, arguments, *call_span);
                let id = joint.map(|kind| self.model.add_joint(Joint { declared: declared(name), kind }));
                self.joints.push(id);
            }
        }
    }

    fn joint_kind(&mut self, name: &Name, kind: &Name, arguments: &[Expr], span: Span) -> Option<JointKind> {
        let joint = match (kind.text.as_str(), arguments) {
            ("revolute", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                JointKind::Revolute(p, q)
            }
            ("translational", [a, b]) => {
                let (a, b) = (self.axis(a), self.axis(b));
                JointKind::Translational(a?, b?)
            }
            ("weld", [p, q]) => {
                let (p, q) = self.two_points(p, q)?;
                JointKind::Weld(p, q, self.model.graph.constant(0.0))
            }
            ("weld", [p, q, angle]) => {
                let points = self.two_points(p, q);
                let angle = self.angle(angle, "the angle of a weld");
                let (p, q) = points?;
                JointKind::Weld(p, q, angle?)
            }
            ("revolute_revolute", [p, q, length]) => {
                let points = self.two_points(p, q);
                let length = self.positive_length(length, "the length of the link");
                let (p, q) = points?;
                JointKind::RevoluteRevolute(p, q, length?)
            }
            ("revolute_translational", [p, a]) => {
                let (p, a) = (self.point(p), self.axis(a));
                JointKind::RevoluteTranslational(p?, a?, self.model.graph.constant(0.0))
            }
            ("revolute_translational", [p, a, offset]) => {
                let (p, a) = (self.point(p), self.axis(a));
                let offset = self.constant(offset, "the offset from the axis", Dimension::LENGTH);
                JointKind::RevoluteTranslational(p?, a?, offset?.0)
            }
            (word, _) if JOINTS.contains(&word) => {
                let wanted = match word {
                    "revolute" => "two points",
                    "translational" => "two axes",
                    "weld" => "two points, and an angle if it is not 0",
                    "revolute_revolute" => "two points and a length",
                    _ => "a point and an axis, and an offset if it is not 0",
                };
                self.report(errors::argument_count(word, span, wanted, arguments.len()));
                return None;
            }
            (word, _) if LATER_JOINTS.contains(&word) => {
                self.report(errors::not_available(&format!("the joint `{word}`"), kind.span));
                return None;
            }
            _ => {
                let known: Vec<&str> = JOINTS.iter().chain(LATER_JOINTS).copied().collect();
                let listed = format!("the joints are {}", errors::list(&known));
                let mut diagnostic = errors::unknown("kind of joint", kind, &known);
                if diagnostic.help.is_empty() {
                    diagnostic = diagnostic.help(listed);
                }
                self.report(diagnostic);
                return None;
            }
        };
        let frames = joint.frames(&self.model);
        if frames[0] == frames[1] {
            let frame = self.model.frame_name(frames[0]).to_owned();
            self.report(errors::joint_with_itself(name, &frame, [arguments[0].span, arguments[1].span]));
            return None;
        }
        Some(joint)
    }

    fn positive_length(&mut self, e: &Expr, what: &str) -> Option<ExprId> {
        let (id, value) = self.constant(e, what, Dimension::LENGTH)?;
        if value <= 0.0 {
            self.report(errors::not_positive_length(what, e.span, value));
            return None;
        }
        Some(id)
    }

    /// Measures, in the order in which they need each other; listed in that of the text.
    pub(super) fn measures(&mut self, order: &[usize]) {
        let mut values = vec![None; self.measures.len()];
        for &k in order {
            let judged = self.measures[k].dimensional;
            let context =
                Context { judged, time: true, quantities: true, measures: true, ..Context::constant("a measure") };
            let conditions = self.model.conditions.len();
            values[k] = self.formula(self.measures[k].value, &context);
            let name = &self.measures[k].name.text;
            for condition in &mut self.model.conditions[conditions..] {
                condition.owner.clone_from(name);
            }
            self.measures[k].sound = values[k].is_some();
        }
        for (state, value) in self.measures.iter().zip(values) {
            if let Some(value) = value {
                let measure = Measure { declared: declared(state.name), value: value.id };
                self.model.measures.push(measure);
            }
        }
    }

    pub(super) fn equations(&mut self) {
        for item in self.items() {
            if let ItemKind::Equation { driver, name, left, right } = &item.kind {
                let form = self.equation(*driver, name, [left, right]);
                if let Some(form) = form {
                    let equation = Equation { declared: declared(name), driver: *driver, form };
                    self.model.equations.push(equation);
                }
            }
        }
    }

    fn equation(&mut self, driver: bool, name: &Name, sides: [&Expr; 2]) -> Option<EquationForm> {
        let [left, right] = sides;
        if !sides.iter().any(|side| Self::holds_quantity(side)) {
            // a name that is wrong explains more than the want of a quantity
            let context = self.equation_context(driver, sides);
            let (a, b) = (self.formula(left, &context), self.formula(right, &context));
            if a.is_some() && b.is_some() {
                self.report(errors::no_quantity(driver, name, left.span.to(right.span)));
            }
            return None;
        }
        for (side, other) in [(left, right), (right, left)] {
            if is_an_angle(other) {
                self.warn_of_degrees(side);
            }
        }
        let context = self.equation_context(driver, sides);
        let conditions = self.model.conditions.len();
        let (a, b) = (self.formula(left, &context), self.formula(right, &context));
        for condition in &mut self.model.conditions[conditions..] {
            condition.owner.clone_from(&name.text);
        }
        let (a, b) = (a?, b?);
        self.alike("the two sides are", (left.span, a.dim), (right.span, b.dim), &context)?;
        if !self.a_body_moves([a.id, b.id]) {
            self.report(errors::nobody_moves(name, left.span.to(right.span)));
            return None;
        }
        // `distance` alone on the left, and no quantity on the right
        if let Some((p, q)) = self.as_distance(left, a.id)
            && !Self::holds_quantity(right)
        {
            let constant = self.constant_value(b.id);
            if let Some(value) = constant.filter(|&value| value <= 0.0) {
                self.report(errors::not_positive_length("a distance", right.span, value));
                return None;
            }
            if constant.is_none() {
                self.model.conditions.push(Condition {
                    positive: b.id,
                    kind: ConditionKind::Distance,
                    span: right.span,
                    owner: name.text.clone(),
                });
            }
            return Some(EquationForm::SquaredDistance(p, q, b.id));
        }
        Some(EquationForm::Difference(a.id, b.id))
    }

    fn equation_context(&self, driver: bool, sides: [&Expr; 2]) -> Context<'static> {
        Context {
            judged: sides.iter().any(|side| self.is_dimensional(side)),
            time: driver,
            quantities: true,
            ..Context::constant(if driver { "a driver" } else { "a constraint" })
        }
    }

    fn quantities_in(&self, ids: [ExprId; 2]) -> Vec<Quantity> {
        let graph = &self.model.graph;
        ids.into_iter()
            .filter(|&id| graph.dependence(id).on(Dependence::NAMED))
            .flat_map(|id| graph.symbols(id))
            .filter_map(|symbol| match symbol {
                Symbol::Named(k) => match self.model.named[k as usize] {
                    Named::Quantity(quantity) => Some(quantity),
                    _ => None,
                },
                _ => None,
            })
            .collect()
    }

    fn a_body_moves(&self, ids: [ExprId; 2]) -> bool {
        self.quantities_in(ids)
            .into_iter()
            .any(|quantity| self.frames_of(quantity).iter().any(|&frame| frame != Frame::Ground))
    }

    fn as_distance(&self, written: &Expr, id: ExprId) -> Option<(PointId, PointId)> {
        match &written.bare().kind {
            ExprKind::Call { name, .. } if name.text == "distance" => match self.quantities_in([id, id]).first() {
                Some(&Quantity::Distance(p, q)) => Some((p, q)),
                _ => None,
            },
            _ => None,
        }
    }

    pub(super) fn analysis(&mut self) {
        let found = self.items().iter().find_map(|item| match &item.kind {
            ItemKind::Analysis { from, to, every } => Some((item.span, from, to, every)),
            _ => None,
        });
        let Some((span, from, to, every)) = found else {
            return;
        };
        let start = self.constant(from, "the start of the analysis", Dimension::TIME);
        let end = self.constant(to, "the end of the analysis", Dimension::TIME);
        let step = self.constant(every, "the step of the analysis", Dimension::TIME);
        if let Some((_, value)) = step
            && value <= 0.0
        {
            self.report(errors::step_not_positive(every.span, value));
            return;
        }
        let (Some((_, start)), Some((_, end)), Some((_, step))) = (start, end, step) else {
            return;
        };
        if end < start {
            self.report(errors::ends_before_start(to.span, start, end));
            return;
        }
        self.model.analysis = Some(Analysis { from: start, to: end, every: step, span });
    }
}

/// Whether a side of an equation is an angle and nothing else.
fn is_an_angle(side: &Expr) -> bool {
    match &side.bare().kind {
        ExprKind::Call { name, .. } => matches!(name.text.as_str(), "angle" | "rotation"),
        ExprKind::Negate(inner) => is_an_angle(inner),
        _ => false,
    }
}
