//! Warnings of bare numbers that were probably intended in degrees, or in another unit of angle than radians.

use crate::check::errors;
use crate::check::formulas::{Context, Dim, Formulas};
use crate::check::scope::Entity;
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name, WrittenUnit};
use mechc_text::source::Span;
use mechc_text::vocabulary::Unit;
use std::f64::consts::TAU;

/// The depth to which a term is examined: formulas nest deeper than a second recursion has stack for.
const LEVELS: usize = 8;

impl Formulas<'_> {
    /// Warns of bare numbers beyond one turn among the terms of an angle.
    pub(in crate::check) fn warn_of_degrees_in(&mut self, e: &Expr) {
        match &e.bare().kind {
            ExprKind::Sum(first, rest) => {
                for term in std::iter::once(&**first).chain(rest.iter().map(|(_, term)| term)) {
                    self.warn_of_degrees(term);
                }
            }
            _ => self.warn_of_degrees(e),
        }
    }

    pub(in crate::check) fn warn_of_degrees(&mut self, e: &Expr) {
        if let Some(value) = e.bare_number()
            && value.abs() > TAU
        {
            self.reporter.report(errors::degrees(e.span, value, self.reporter.text(e.span)));
        }
    }

    /// Warns of bare numbers among terms of equal dimension, if another term is printed in degrees or the like: the numbers are in radians.
    #[inline(never)] // its frame is not to stand on the stack of those who nest
    pub(in crate::check) fn warn_of_numbers_as_radians<'e>(
        &mut self,
        terms: impl Iterator<Item = &'e Expr> + Clone,
        context: &Context<'_>,
    ) {
        let Some((measure, unit)) = terms.clone().find_map(|term| self.printed_unit(term, context, LEVELS)) else {
            return;
        };
        self.warn_of_bare_numbers(terms, measure, &unit);
    }

    /// Warns of bare numbers among the terms of a formula that is printed in degrees or the like: the numbers are in radians.
    pub(in crate::check) fn warn_of_numbers_printed(&mut self, formula: &Expr, written: &WrittenUnit) {
        let ExprKind::Sum(first, rest) = &formula.bare().kind else { return };
        let terms = std::iter::once(&**first).chain(rest.iter().map(|(_, term)| term));
        if is_of_degrees(written) && !terms.clone().all(|term| self.is_bare(term, LEVELS)) {
            let unit = self.reporter.text(written.span);
            self.warn_of_bare_numbers(terms, written.span, unit);
        }
    }

    fn warn_of_bare_numbers<'e>(&mut self, terms: impl Iterator<Item = &'e Expr>, printed: Span, unit: &str) {
        for term in terms {
            if self.is_bare(term, LEVELS) && self.common.reported_radians.insert(term.span) {
                let root = self.plain_root(term).filter(|root| root.is_number);
                let number = root.map_or(term.span, |root| root.span);
                let texts = [term.span, number].map(|span| self.reporter.text(span));
                self.reporter.report(errors::number_as_radians([term.span, number], texts, printed, unit));
            }
        }
    }

    /// Returns whether a formula consists of nonzero numbers without units, also through params.
    fn is_bare(&self, e: &Expr, levels: usize) -> bool {
        let Some(levels) = levels.checked_sub(1) else { return false };
        match &e.kind {
            ExprKind::Literal { value, unit: None } => *value != 0.0,
            ExprKind::Paren(inner) | ExprKind::Negate(inner) => self.is_bare(inner, levels),
            ExprKind::Sum(first, rest) => {
                self.is_bare(first, levels) && rest.iter().all(|(_, term)| self.is_bare(term, levels))
            }
            ExprKind::Product(first, rest) => {
                self.is_bare(first, levels) && rest.iter().all(|(_, term)| self.is_bare(term, levels))
            }
            ExprKind::Name(name) => match self.scope.entity(name) {
                Some(Entity::Param(k)) => self.params.get(k).is_some_and(|param| {
                    let is_plain = |dim| matches!(dim, Dim::Plain { read, .. } if read.is_without_angles());
                    param.value.is_some_and(|value| is_plain(value.dim))
                }),
                _ => false,
            },
            _ => false,
        }
    }

    /// Returns the measure that makes a formula an angle printed in degrees or the like, and that unit.
    fn printed_unit(&self, e: &Expr, context: &Context<'_>, levels: usize) -> Option<(Span, String)> {
        let levels = levels.checked_sub(1)?;
        match &e.kind {
            ExprKind::Paren(inner) | ExprKind::Negate(inner) => self.printed_unit(inner, context, levels),
            ExprKind::Name(name) => {
                let argument = context.argument.filter(|(argument, _)| *argument == name.text);
                let unit = match argument {
                    Some(_) => context.printed?,
                    // Formulas that are expanded are examined where they are declared.
                    None if self.reporter.caller.is_none() => self.unit_of(name)?,
                    None => return None,
                };
                Some((name.span, self.reporter.text(unit).to_owned()))
            }
            ExprKind::Sum(first, rest) => {
                let mut terms = std::iter::once(&**first).chain(rest.iter().map(|(_, term)| term));
                terms.find_map(|term| self.printed_unit(term, context, levels))
            }
            ExprKind::Product(first, rest) => {
                let is_scaled = |factor: Factor, e: &Expr| factor == Factor::Times && !self.is_bare(e, levels);
                let mut factors = std::iter::once((Factor::Times, &**first)).chain(rest.iter().map(|(f, e)| (*f, e)));
                let (_, scaled) = factors.clone().find(|(factor, e)| is_scaled(*factor, e))?;
                let others = factors.all(|(_, e)| std::ptr::eq(e, scaled) || self.is_bare(e, levels));
                self.printed_unit(scaled, context, levels).filter(|_| others)
            }
            ExprKind::If { arms, otherwise } => {
                let mut values = arms.iter().map(|(_, value)| value).chain(std::iter::once(&**otherwise));
                values.find_map(|value| self.printed_unit(value, context, levels))
            }
            ExprKind::Call { name, arguments, .. } => match (name.text.as_str(), arguments.as_slice()) {
                ("der", [of]) => {
                    let (measure, unit) = self.printed_unit(of, context, levels)?;
                    (!unit.contains('/')).then(|| (measure, format!("{unit}/s")))
                }
                ("abs" | "min" | "max" | "mod" | "mean" | "rms" | "first" | "last", arguments) => {
                    arguments.iter().find_map(|argument| self.printed_unit(argument, context, levels))
                }
                ("at", [of, _]) => self.printed_unit(of, context, levels),
                _ => None,
            },
            _ => None,
        }
    }

    /// Returns the unit of angle in which a measure or result is printed, unless it is the radian.
    fn unit_of(&self, name: &Name) -> Option<Span> {
        let written = match self.scope.entity(name)? {
            Entity::Measure(k) => self.measure_state(k)?.unit,
            Entity::Result(k) => self.result_state(k)?.unit,
            _ => None,
        }?;
        is_of_degrees(written).then_some(written.span)
    }

    /// Returns the unit of angle of an argument that is such a name.
    pub(in crate::check) fn unit_of_argument(&self, e: &Expr, context: &Context<'_>) -> Option<Span> {
        let bare = match &e.bare().kind {
            ExprKind::Negate(inner) => inner.bare(),
            _ => e.bare(),
        };
        let ExprKind::Name(name) = &bare.kind else { return None };
        match context.argument.filter(|(argument, _)| *argument == name.text) {
            Some(_) => context.printed,
            None => self.unit_of(name),
        }
    }
}

/// Returns whether a unit holds a unit of angle other than the radian.
fn is_of_degrees(written: &WrittenUnit) -> bool {
    let mut units = written.factors.iter().filter_map(|factor| Unit::named(&factor.name.text));
    units.any(|unit| unit.dimension.is_angular() && unit.word.name != "rad")
}
