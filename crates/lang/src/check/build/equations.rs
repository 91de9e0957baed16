//! Measures, constraints, drivers and the analysis.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{Context, Dim, Value, determined_dimension, require_dimension};
use crate::model::{
    Analysis, Condition, ConditionKind, Dimension, Equation, EquationForm, GuardKind, Named, PointId, Quantity,
};
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::QuantityWord;

impl Builder<'_, '_> {
    pub(in crate::check) fn equations(&mut self) {
        let (mut parts, mut numbers) = (0..self.formulas.parts.len(), 0..);
        self.formulas.equations.resize(self.formulas.scope.count.equations, None);
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Equation { driver, name, left, right } => {
                    let k = numbers.next().unwrap_or_default();
                    if let Some((form, dim)) = self.equation(*driver, name, [left, right]) {
                        let (declared, written) = (self.formulas.scope.declared(name), left.span.to(right.span));
                        let driver = *driver && self.drives(form);
                        let dimension = dim.settled();
                        let equation = Equation { declared, driver, form, dimension, written };
                        let id = self.formulas.model.add_equation(equation);
                        self.formulas.common.plain_equations.extend((!matches!(dim, Dim::Of(_))).then_some(id));
                        self.formulas.equations[k] = Some(id);
                    }
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.equations());
                    }
                }
                _ => {}
            }
        }
        self.formulas.import_equations();
    }

    /// Returns whether a driver of the text drives the whole mechanism. If a part's input follows bodies, it is a constraint.
    fn drives(&self, form: EquationForm) -> bool {
        let sides = match form {
            EquationForm::Equality(left, right) => [left, right],
            EquationForm::Distance(_, _, distance) => [distance, distance],
        };
        let on_time = |id: ExprId| self.formulas.model.graph.dependence(id).on(Dependence::TIME);
        let has_bound_inputs = !self.formulas.bound.inputs.is_empty();
        !has_bound_inputs || sides.into_iter().any(on_time) || self.quantities_in(sides).len() <= 1
    }

    /// Evaluates an equation. Returns its form and the dimension of its sides.
    fn equation(&mut self, driver: bool, name: &Name, sides: [&Expr; 2]) -> Option<(EquationForm, Dim)> {
        let [left, right] = sides;
        if !sides.iter().any(|side| self.formulas.scope.holds_quantity(side)) {
            // A wrong name explains more than a missing quantity.
            let context = self.equation_context(driver, sides);
            let (a, b) = (self.formulas.formula(left, &context), self.formulas.formula(right, &context));
            if a.is_some() && b.is_some() {
                self.formulas.reporter.report(errors::no_quantity(driver, name, left.span.to(right.span)));
            }
            return None;
        }
        for (side, other) in [(left, right), (right, left)] {
            if is_an_angle(other) || is_an_angle(side) {
                self.formulas.warn_of_degrees_in(side);
            }
            if is_a_length(other) && self.formulas.reject_angle("what equals a length", side) {
                return None;
            }
        }
        let context = self.equation_context(driver, sides);
        let conditions = self.formulas.model.conditions.len();
        let (a, b) = (self.formulas.formula(left, &context), self.formulas.formula(right, &context));
        for condition in &mut self.formulas.model.conditions[conditions..] {
            condition.owner = format!("{}{}", self.formulas.scope.path, name.text);
        }
        let (a, b) = match (a, b) {
            (Some(a), Some(b)) => (a, b),
            // The dimension of a broken side is that of the other side.
            (Some(side), None) => {
                self.unlike_a_quantity((left.span, side.dim), right, &context);
                return None;
            }
            (None, Some(side)) => {
                self.unlike_a_quantity((right.span, side.dim), left, &context);
                return None;
            }
            (None, None) => return None,
        };
        let what = format!("the two sides of {} `{}` are", if driver { "driver" } else { "constraint" }, name.text);
        let unify = if !context.judged && is_a_curve([a, b]) {
            a.dim
        } else {
            self.formulas.unify(&what, (left.span, a), (right.span, b), &context)?
        };
        for (side, value, other) in [(left, a, right), (right, b, left)] {
            if is_a_length(other) {
                self.formulas.record_length_term(side, value.id, context.judged);
            }
        }
        if !self.has_moving_body([a.id, b.id]) {
            self.formulas.reporter.report(errors::no_moving_body(driver, name, left.span.to(right.span)));
            return None;
        }
        // `distance` alone on the left, and no quantity on the right.
        if let Some(ends) = self.as_distance(left, a.id)
            && !self.formulas.scope.holds_quantity(right)
        {
            return self.distance_equation(name, ends, right, b.id);
        }
        let dim = if context.judged { unify } else { self.plain_dimension([(left, a), (right, b)]) };
        let dim =
            [a, b].into_iter().fold(dim, |dim, side| dim.map(|dimension| dimension.marked_by(side.dim.settled())));
        if driver && dim.settled().is_angle() {
            self.mark_inputs_as_angles([a.id, b.id]);
        }
        Some((EquationForm::Equality(a.id, b.id), dim))
    }

    /// Marks inputs that are numbers as angles, as a driver of an angle holds them.
    fn mark_inputs_as_angles(&mut self, sides: [ExprId; 2]) {
        let symbols = sides.into_iter().flat_map(|side| self.formulas.model.graph.symbols(side));
        let inputs = symbols.filter_map(|symbol| match symbol {
            Symbol::Signal { index, .. } => Some(index as usize),
            _ => None,
        });
        for index in inputs.collect::<Vec<usize>>() {
            let dimension = &mut self.formulas.model.inputs[index].dimension;
            if dimension.is(Dimension::PURE) {
                *dimension = dimension.marked_by(Dimension::ANGLE);
            }
        }
    }

    /// Evaluates the equation of a distance, which must be positive.
    fn distance_equation(
        &mut self,
        name: &Name,
        (p, q): (PointId, PointId),
        right: &Expr,
        distance: ExprId,
    ) -> Option<(EquationForm, Dim)> {
        match self.formulas.decided(distance, GuardKind::Sign) {
            Some(value) if value <= 0.0 => {
                self.formulas.reporter.report(errors::not_positive_length("a distance", right.span, value));
                return None;
            }
            Some(_) => {}
            None => self.formulas.model.conditions.push(Condition {
                positive: distance,
                kind: ConditionKind::Distance,
                span: right.span,
                owner: format!("{}{}", self.formulas.scope.path, name.text),
            }),
        }
        Some((EquationForm::Distance(p, q, distance), Dim::LENGTH))
    }

    /// Returns the dimension of a plain equation: that of a side with quantities. A side of numbers and time fits any dimension.
    fn plain_dimension(&self, sides: [(&Expr, Value); 2]) -> Dim {
        let telling =
            sides.into_iter().filter(|(side, _)| self.formulas.scope.holds_quantity(side)).map(|(_, value)| value);
        let telling: Vec<Value> = telling.collect();
        let determined = telling.iter().find_map(|&value| determined_dimension(value.dim));
        // If numbers hide it on both sides, the first dimension that is not a pure number.
        let read = || telling.iter().map(|value| value.dim).find(|dim| !dim.settled().is(Dimension::PURE));
        determined.map(Dim::Of).or_else(read).unwrap_or(Dim::PURE)
    }

    /// Reports a side of an equation that cannot agree with the other one, as it is a single quantity of another dimension.
    fn unlike_a_quantity(&mut self, side: (Span, Dim), other: &Expr, context: &Context<'_>) {
        if let ExprKind::Call { name, .. } = &other.bare().kind
            && let Some(quantity) = QuantityWord::named(&name.text).filter(|quantity| !quantity.gives_way())
        {
            let dimension = if is_an_angle(other) { Dimension::PURE } else { Dimension::LENGTH };
            let place = format!("what equals this `{}`", quantity.word.name);
            let _ = require_dimension(&mut self.formulas.reporter, &place, dimension, side.0, side.1, context);
        }
    }

    fn equation_context(&self, driver: bool, sides: [&Expr; 2]) -> Context<'static> {
        Context {
            judged: sides.iter().any(|side| self.formulas.is_dimensional(side)),
            time: driver,
            inputs: driver,
            quantities: true,
            ..Context::constant(if driver { "a driver" } else { "a constraint" })
        }
    }

    fn quantities_in(&self, ids: [ExprId; 2]) -> Vec<Quantity> {
        let graph = &self.formulas.model.graph;
        ids.into_iter()
            .filter(|&id| graph.dependence(id).on(Dependence::NAMED))
            .flat_map(|id| graph.symbols(id))
            .flat_map(|symbol| match symbol {
                Symbol::Named(k) => match self.formulas.model.named[k as usize] {
                    Named::Quantity(_, quantity) => vec![quantity],
                    _ => Vec::new(),
                },
                _ => Vec::new(),
            })
            .collect()
    }

    pub(super) fn has_moving_body(&self, ids: [ExprId; 2]) -> bool {
        self.quantities_in(ids)
            .into_iter()
            .any(|quantity| self.formulas.frames_of(quantity).iter().any(|&frame| self.moves(frame)))
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

    pub(in crate::check) fn analysis(&mut self) {
        let found = self.formulas.scope.items().iter().find_map(|item| match &item.kind {
            ItemKind::Analysis { from, to, every } => Some((item.span, from, to, every)),
            _ => None,
        });
        let Some((span, from, to, every)) = found else {
            return;
        };
        // other values of params may lead to other times, which are judged again then
        let [start, end, step] = [(from, "the start"), (to, "the end"), (every, "the step")].map(|(e, which)| {
            self.formulas.constant_by(e, &format!("{which} of the analysis"), Dimension::TIME, GuardKind::Finite)
        });
        if let Some((_, value)) = step
            && value <= 0.0
        {
            self.formulas.reporter.report(errors::step_not_positive(every.span, value));
            return;
        }
        let (Some((first, start)), Some((last, end)), Some((between, step))) = (start, end, step) else {
            return;
        };
        if end < start {
            let texts = [from.span, to.span].map(|span| self.formulas.reporter.text(span));
            self.formulas.reporter.report(errors::ends_before_start([from.span, to.span], texts, start, end));
            return;
        }
        self.formulas.model.analysis =
            Some(Analysis { from: start, to: end, every: step, formulas: [first, last, between], span });
    }
}

/// Returns whether the sides of an equation are powers of lengths: a curve such as `y(P) = x(P)^2`, whose coordinates are numbers of
/// metres.
fn is_a_curve(sides: [Value; 2]) -> bool {
    sides.into_iter().all(|side| match side.dim {
        Dim::Of(dimension) => Dimension::LENGTH.to_the(dimension.length).is(dimension) && dimension.length.abs() > 0.0,
        _ => false,
    })
}

/// Returns whether a side of an equation is a length.
fn is_a_length(side: &Expr) -> bool {
    match &side.bare().kind {
        ExprKind::Call { name, .. } => matches!(name.text.as_str(), "x" | "y" | "distance" | "displacement"),
        _ => false,
    }
}

/// Returns whether a side of an equation is an angle or a sum of angles.
fn is_an_angle(side: &Expr) -> bool {
    match &side.bare().kind {
        ExprKind::Call { name, .. } => matches!(name.text.as_str(), "angle" | "rotation"),
        ExprKind::Negate(inner) => is_an_angle(inner),
        ExprKind::Sum(first, rest) => is_an_angle(first) || rest.iter().any(|(_, term)| is_an_angle(term)),
        _ => false,
    }
}
