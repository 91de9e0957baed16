//! Requirements: bounds that a number of the whole analysis keeps, or a quantity at all times of it.
//!
//! The excess over a bound is a formula of reductions, as a result is: for a quantity `e` and an upper bound `b` it is `max(e − b)`.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{Context, Value, measure_context};
use crate::model::{Bound, Declared, Dimension, GuardKind, ReductionKind, Requirement, RequirementTimes, Units};
use mechc_expr::{Comparison, ExprId};
use mechc_syntax::ast::{self, ComparisonSign, Expr, ExprKind, ItemKind};
use mechc_text::source::Span;
use mechc_text::vocabulary::{CompoundUnit, Unit};

/// Part of the largest excess from which on a bound counts as exceeded, where the first such time is found: rounding at a value that rests
/// on its bound does not count.
const FIRST_EXCESS: f64 = 1e-9;

/// A side of a comparison.
type Side<'e> = (&'e Expr, Value);

/// A formula with the bounds that a requirement sets for it; true for an upper bound.
struct Bounded<'e> {
    value: Side<'e>,
    bounds: Vec<(bool, ExprId)>,
}

impl Builder<'_, '_> {
    /// Checks the requirements, and lists them if they are to be judged: those of a part where it is declared. They follow the results.
    pub(super) fn requirements(&mut self) {
        let (named, reductions, conditions) = (
            self.formulas.model.named.len(),
            self.formulas.model.reductions.len(),
            self.formulas.model.conditions.len(),
        );
        self.list_requirements();
        if !self.formulas.options.judges_requirements {
            self.formulas.model.named.truncate(named);
            self.formulas.model.reductions.truncate(reductions);
            self.formulas.model.conditions.truncate(conditions);
            self.formulas.model.requirements.clear();
        }
    }

    fn list_requirements(&mut self) {
        let mut parts = 0..self.formulas.parts.len();
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Requirement(requirement) => {
                    self.requirement(item.span, requirement);
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.list_requirements());
                    }
                }
                _ => {}
            }
        }
    }

    fn requirement(&mut self, span: Span, requirement: &ast::Requirement) -> Option<()> {
        let judged = requirement.formulas().any(|side| self.formulas.is_dimensional(side));
        let context = Context { place: "a requirement", results: true, ..measure_context(judged) };
        let conditions = self.formulas.model.conditions.len();
        let values: Vec<Option<Value>> =
            requirement.formulas().map(|side| self.formulas.formula(side, &context)).collect();
        let conditions = self.formulas.conditions_in_time(conditions, "");
        let values: Vec<Value> = values.into_iter().collect::<Option<_>>()?;
        let context = Context { judged: values.iter().any(|value| self.formulas.counts(*value, &context)), ..context };
        let sides: Vec<Side<'_>> = requirement.formulas().zip(values).collect();
        for side in &sides[1..] {
            self.formulas.unify("this compares", (sides[0].0.span, sides[0].1), (side.0.span, side.1), &context)?;
        }
        let is_one_number = sides.iter().all(|(_, value)| self.formulas.is_of_whole_analysis(value.id));
        let reduced = sides.iter().find(|(_, value)| self.formulas.holds_reduction(value.id));
        if let Some((reduced, _)) = reduced.filter(|_| !is_one_number) {
            let moving = sides.iter().find(|(_, value)| !self.formulas.is_of_whole_analysis(value.id));
            self.formulas
                .reporter
                .report(errors::requirement_of_both(moving.map_or(span, |(e, _)| e.span), reduced.span));
            return None;
        }
        let Bounded { value: (formula, value), bounds } = self.bounded(requirement, &sides)?;
        let dimension = sides.iter().map(|(_, value)| value.dim.settled()).reduce(Dimension::marked_by)?;
        let units = units_of_sides(&sides, dimension);
        let text = self.formulas.reporter.text(requirement_text(requirement));
        let named = requirement.name.as_ref().map(|name| format!("{}{}", self.formulas.scope.path, name.text));
        let declared = Declared { name: named.unwrap_or_else(|| text.to_owned()), span };
        let bounds = bounds.into_iter().map(|(is_upper, bound)| {
            let graph = &mut self.formulas.model.graph;
            let excess = if is_upper { graph.sub(value.id, bound) } else { graph.sub(bound, value.id) };
            if is_one_number {
                return Bound { is_upper, excess, value: value.id, bound, times: None };
            }
            let reduced = |builder: &mut Self, kind, of| {
                builder.formulas.reduction_symbol(kind, of, [None; 2], formula.span, &conditions)
            };
            let largest = reduced(self, ReductionKind::Max, excess);
            let worst = reduced(self, ReductionKind::ArgMax, excess);
            let graph = &mut self.formulas.model.graph;
            let [part, one, zero] = [FIRST_EXCESS, 1.0, 0.0].map(|number| graph.constant(number));
            let noticeable = graph.mul(part, largest);
            let is_exceeded = graph.compare(Comparison::Less, noticeable, excess);
            let indicator = graph.select(is_exceeded, one, zero);
            let first = reduced(self, ReductionKind::ArgMax, indicator);
            let value = reduced(self, ReductionKind::At(worst), value.id);
            let bound = reduced(self, ReductionKind::At(worst), bound);
            Bound { is_upper, excess: largest, value, bound, times: Some(RequirementTimes { first, worst }) }
        });
        let bounds = bounds.collect();
        let formula = self.formulas.reporter.text(formula.span).to_owned();
        self.formulas.model.requirements.push(Requirement { declared, formula, bounds, units });
        Some(())
    }

    /// Returns the formula that a requirement bounds, with its bounds.
    fn bounded<'e>(&mut self, requirement: &'e ast::Requirement, sides: &[Side<'e>]) -> Option<Bounded<'e>> {
        use ComparisonSign::{Equal, GreaterEqual, LessEqual};
        let signs: Vec<ComparisonSign> = requirement.rest.iter().map(|side| side.sign).collect();
        let within = requirement.within.as_ref().and_then(|_| sides.last().copied());
        match (signs.as_slice(), within) {
            ([Equal], Some((written, within))) => {
                if self.formulas.decided(within.id, GuardKind::Sign).is_some_and(|within| within < 0.0) {
                    self.formulas.reporter.report(errors::negative_tolerance(written.span));
                    return None;
                }
                let graph = &mut self.formulas.model.graph;
                let wanted = sides[1].1.id;
                let (least, most) = (graph.sub(wanted, within.id), graph.add(wanted, within.id));
                Some(Bounded { value: sides[0], bounds: vec![(false, least), (true, most)] })
            }
            ([Equal], None) => {
                let wanted = self.formulas.reporter.text(sides[1].0.span).to_owned();
                self.formulas.reporter.report(errors::equal_without_tolerance(
                    requirement.rest[0].span,
                    sides[1].0.span,
                    &wanted,
                ));
                None
            }
            ([sign @ (LessEqual | GreaterEqual)], None) => {
                // `3 mm <= gap` bounds the gap
                let is_reversed = self.is_fixed(sides[0].1) && !self.is_fixed(sides[1].1);
                let (value, bound) = if is_reversed { (sides[1], sides[0]) } else { (sides[0], sides[1]) };
                let is_upper = (*sign == LessEqual) != is_reversed;
                Some(Bounded { value, bounds: vec![(is_upper, bound.1.id)] })
            }
            ([LessEqual, LessEqual], None) => {
                Some(Bounded { value: sides[1], bounds: vec![(false, sides[0].1.id), (true, sides[2].1.id)] })
            }
            ([GreaterEqual, GreaterEqual], None) => {
                Some(Bounded { value: sides[1], bounds: vec![(true, sides[0].1.id), (false, sides[2].1.id)] })
            }
            (_, Some((written, _))) if !signs.contains(&Equal) => {
                self.formulas.reporter.report(errors::tolerance_of_no_equality(written.span));
                None
            }
            _ => {
                let is_bound = |side: &&ast::ComparedSide| matches!(side.sign, LessEqual | GreaterEqual);
                let wrong = requirement.rest.iter().find(|side| !is_bound(side)).or(requirement.rest.last())?;
                self.formulas.reporter.report(errors::no_bound(wrong.sign, wrong.span));
                None
            }
        }
    }

    /// Returns whether a formula is one of params alone.
    fn is_fixed(&self, value: Value) -> bool {
        self.formulas.model.graph.dependence(value.id).is_constant()
    }
}

/// Returns the span of all that a requirement compares.
fn requirement_text(requirement: &ast::Requirement) -> Span {
    requirement.formulas().fold(requirement.first.span, |span, side| span.to(side.span))
}

/// Returns the units in which a requirement is reported: that of the first number among its sides with a unit that fits, or else SI.
fn units_of_sides(sides: &[Side<'_>], dimension: Dimension) -> Units {
    let unit = |e: &Expr| match &e.kind {
        ExprKind::Literal { unit: Some((name, power)), .. } => Some((Unit::named(&name.text)?, *power)),
        _ => None,
    };
    let mut units = sides.iter().flat_map(|(side, _)| side.parts().filter_map(unit));
    let fitting = units.find(|(unit, power)| unit.dimension.to_the(f64::from(*power)).is(dimension));
    fitting.map_or_else(|| Units::si(dimension), |unit| Units::of(&CompoundUnit::new(vec![unit]), dimension))
}
