//! Lengths without a unit beside lengths with one.
//!
//! A plain formula is taken in metres. Where all lengths are plain that is what was meant, or all are too large alike; but
//! a plain one that dwarfs those with a unit has lost its own.

use super::Checker;
use super::errors::{self, WithoutUnit};
use super::mentions::formulas;
use super::names::Entity;
use crate::expr::ExprId;
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, ItemKind};
use crate::vocabulary::{Dimension, Unit};
use rustc_hash::FxHashMap;

/// A plain length that is larger than this many times the largest one with a unit has lost its unit: millimetres that are
/// taken for metres are a thousand times too large, inches 39 times.
const TIMES: f64 = 25.0;

/// The lengths of a mechanism, as they are come upon.
#[derive(Default)]
pub(super) struct Lengths {
    /// The largest with a unit (m).
    with_unit: f64,
    plain: Vec<Plain>,
}

/// A length whose formula holds no unit.
#[derive(Clone, Copy)]
struct Plain {
    /// In metres.
    value: f64,
    span: Span,
    /// The parameter that it is, with its sign at most.
    param: Option<usize>,
    is_number: bool,
}

impl Checker<'_> {
    /// Remembers a constant length.
    pub(super) fn remember_length(&mut self, e: &Expr, id: ExprId, judged: bool) {
        let Some(value) = self.constant_value(id).filter(|value| *value != 0.0) else { return };
        if judged {
            self.lengths.with_unit = self.lengths.with_unit.max(value.abs());
        } else {
            let param = self.param_alone(e);
            let is_number = e.bare_number().is_some();
            self.lengths.plain.push(Plain { value, span: e.span, param, is_number });
        }
    }

    /// Remembers the numbers and parameters of a sum that is a plain length and moves: `230 + 60 * t`.
    pub(super) fn remember_lengths_in_a_sum(&mut self, e: &Expr, judged: bool) {
        let ExprKind::Sum(first, rest) = &e.bare().kind else { return };
        if judged {
            return;
        }
        for term in std::iter::once(&**first).chain(rest.iter().map(|(_, term)| term)) {
            let param = self.param_alone(term);
            let number = || param.and_then(|k| self.params[k]).and_then(|value| self.constant_value(value.id));
            let value = term.bare_number().or_else(number).filter(|value| *value != 0.0);
            // a unit behind it alone would leave the other terms without one
            self.lengths.plain.extend(value.map(|value| Plain { value, span: term.span, param, is_number: false }));
        }
    }

    fn param_alone(&self, e: &Expr) -> Option<usize> {
        match &e.bare().kind {
            ExprKind::Negate(inner) => self.param_alone(inner),
            ExprKind::Name(name) => match self.entity(name) {
                Some(Entity::Param(k)) => Some(k),
                _ => None,
            },
            _ => None,
        }
    }

    /// Warns of those plain lengths that dwarf all with a unit.
    pub(super) fn warn_of_plain_lengths(&mut self) {
        let largest = self.lengths.with_unit;
        if largest == 0.0 {
            return;
        }
        let is_dwarfing = |value: f64| value.abs() > TIMES * largest;
        if !self.lengths.plain.iter().any(|length| is_dwarfing(length.value)) {
            return;
        }
        let params: Vec<(&str, &Expr)> = self.items().iter().filter_map(|item| as_param(&item.kind)).collect();
        let mut without: Vec<WithoutUnit<'_>> = Vec::new();
        for &Plain { value, span, param, is_number } in &self.lengths.plain {
            let (name, span, is_number) = match param.map(|k| params[k]) {
                // what was set from outside is mended there
                Some((name, formula)) => {
                    let is_set = self.settings.iter().any(|setting| setting.name == name);
                    (Some(name), formula.span, !is_set && formula.bare_number().is_some())
                }
                None => (None, span, is_number),
            };
            without.push(WithoutUnit { value, span, name, is_number });
        }
        without.sort_by_key(|length| length.span);
        without.dedup_by_key(|length| length.span);
        without.sort_by_key(|length| !is_dwarfing(length.value));
        let dwarfing = without.partition_point(|length| is_dwarfing(length.value));
        self.report(errors::no_unit_of_length(&without, dwarfing, largest, self.usual_unit_of_length()));
    }

    /// The unit in which most lengths of the mechanism are written.
    fn usual_unit_of_length(&self) -> &'static str {
        let mut counts: FxHashMap<&'static str, usize> = FxHashMap::default();
        for e in self.items().iter().flat_map(formulas) {
            let mut open = vec![e];
            while let Some(e) = open.pop() {
                if let ExprKind::Literal { unit: Some((name, 1)), .. } = &e.kind
                    && let Some(unit) = Unit::named(&name.text).filter(|unit| unit.dimension.is(Dimension::LENGTH))
                {
                    *counts.entry(unit.word.name).or_default() += 1;
                }
                open.extend(e.children());
            }
        }
        counts.into_iter().max_by_key(|&(name, count)| (count, name)).map_or("mm", |(name, _)| name)
    }
}

fn as_param(kind: &ItemKind) -> Option<(&str, &Expr)> {
    match kind {
        ItemKind::Param { name, value } => Some((&name.text, value)),
        _ => None,
    }
}
