//! Efforts and reactions that outputs use.

use super::Formulas;
use super::quantities::describe;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::Entity;
use crate::model::{Declared, EquationId, Force, JointId, Named};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name};
use mechc_text::vocabulary::QuantityWord;

impl Formulas<'_> {
    /// Evaluates `effort(D)`, `force_x(J)`, `force_y(J)` or `torque(J)`.
    pub(in crate::check) fn force(
        &mut self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        if !context.measures {
            self.reporter.report(errors::force_in(context.place, &format!("`{}`", name.text), e.span));
            return None;
        }
        let [argument] = arguments else {
            let word = QuantityWord::named(&name.text)?;
            self.reporter.report(errors::argument_count(
                &name.text,
                Some(&word.word),
                e.span,
                word.takes,
                arguments.len(),
            ));
            return None;
        };
        let force = match name.text.as_str() {
            "effort" => Force::Effort(self.equation_named(argument)?),
            "force_x" => Force::ReactionX(self.joint_with_reaction("force_x", argument)?),
            "force_y" => Force::ReactionY(self.joint_with_reaction("force_y", argument)?),
            _ => Force::ReactionTorque(self.joint_with_reaction("torque", argument)?),
        };
        let dimension = self.model.dimension_of_force(force);
        // A force holds accelerations.
        let id = self.name_symbol(Named::Force(self.address.part, force), 2);
        let is_plain = matches!(force, Force::Effort(equation) if self.common.plain_equations.contains(&equation));
        let dim = if is_plain { Dim::Plain { read: dimension, fits: true } } else { Dim::Of(dimension) };
        Some(Value { id, dim })
    }

    /// Returns a constraint or driver; `None` if it is broken, which has been reported.
    fn equation_named(&mut self, e: &Expr) -> Option<EquationId> {
        let ExprKind::Name(name) = &e.bare().kind else {
            self.reporter.report(errors::wrong_kind(e.span, "a driver or constraint", describe(e)));
            return None;
        };
        match self.scope.resolve(name).ok()? {
            Some(Entity::Equation(k)) => self.equations.get(k).copied().flatten(),
            Some(entity) => {
                let joint = matches!(entity, Entity::Joint(_)).then_some(name.text.as_str());
                let driver = joint.and_then(|joint| self.scope.driver_of(joint));
                self.reporter.report(errors::effort_of_no_equation(name, entity.noun(), joint, driver.as_deref()));
                None
            }
            None => {
                let candidates = self.scope.suggestions(&self.reporter, |entity| matches!(entity, Entity::Equation(_)));
                let diagnostic = errors::unknown("driver or constraint", name, &candidates);
                self.reporter.report(diagnostic);
                None
            }
        }
    }

    /// Returns a joint of a kind whose reaction has a component.
    fn joint_with_reaction(&mut self, component: &str, e: &Expr) -> Option<JointId> {
        let (joint, name) = self.joint_named(component, e)?;
        let kind = self.model[joint].spec;
        if kind.has_quantity(component) {
            return Some(joint);
        }
        let Declared { name: joint_name, span } = self.model[joint].declared.clone();
        let diagnostic = if kind.has_force() {
            let driver = self.scope.driver_of(&name.text);
            errors::no_torque(&joint_name, kind.name(), name.span, span, driver.as_deref())
        } else {
            errors::no_force(&joint_name, kind.name(), name.span, span)
        };
        self.reporter.report(diagnostic);
        None
    }

    /// Returns whether a formula holds a force, also within derivatives.
    pub(in crate::check) fn holds_force(&self, id: ExprId) -> bool {
        self.holds_named(id, |named| matches!(named, Named::Force(..)))
    }

    /// Returns whether a formula holds a named symbol of some kind, also within derivatives and held inputs.
    pub(super) fn holds_named(&self, id: ExprId, accepts: impl Fn(&Named) -> bool) -> bool {
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            for symbol in self.model.graph.symbols(id) {
                let Symbol::Named(k) = symbol else { continue };
                match self.model.named.get(k as usize) {
                    Some(named) if accepts(named) => return true,
                    Some(Named::Derivative(inner) | Named::By(inner, _)) => open.push(*inner),
                    _ => {}
                }
            }
        }
        false
    }

    /// Returns whether a formula is a torque, as far as it shows; joules are not a unit of torque.
    pub(super) fn is_torque(&self, e: &Expr) -> bool {
        match &e.kind {
            ExprKind::Paren(inner) | ExprKind::Negate(inner) => self.is_torque(inner),
            ExprKind::Call { name, arguments, .. }
                if self.scope.quantity_word(name).is_some_and(QuantityWord::is_force) =>
            {
                name.text == "torque" || name.text == "effort" && arguments.first().is_some_and(|of| self.turns(of))
            }
            ExprKind::Call { name, arguments, .. } => {
                let keeps = ["abs", "min", "max", "mean", "rms", "first", "last", "at", "hypot"];
                keeps.contains(&name.text.as_str()) && arguments.first().is_some_and(|of| self.is_torque(of))
            }
            ExprKind::Sum(first, _) => self.is_torque(first),
            ExprKind::Product(first, rest) => {
                let factors = || std::iter::once((Factor::Times, &**first)).chain(rest.iter().map(|(f, e)| (*f, e)));
                let torques = factors().filter(|(factor, e)| *factor == Factor::Times && self.is_torque(e)).count();
                let others = factors().filter(|(_, e)| e.bare_number().is_some()).count();
                torques == 1 && torques + others == rest.len() + 1
            }
            ExprKind::Name(name) => match self.scope.entity(name) {
                Some(Entity::Measure(k)) => match self.home_of(Entity::Measure(k)) {
                    (home, Entity::Measure(k)) => home.measures.get(k).is_some_and(|of| home.is_torque(of.value)),
                    _ => false,
                },
                _ => false,
            },
            _ => false,
        }
    }

    /// Returns whether a driver or constraint works on an angle.
    fn turns(&self, e: &Expr) -> bool {
        let ExprKind::Name(name) = &e.bare().kind else { return false };
        let Some(Entity::Equation(k)) = self.scope.entity(name) else { return false };
        let equation = self.equations.get(k).copied().flatten();
        equation.is_some_and(|equation| self.model[equation].dimension.is_angular())
    }
}
