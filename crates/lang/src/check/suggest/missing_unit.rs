//! Lengths without a unit in mechanisms that also have lengths with one.
//!
//! A plain formula is in metres, which is intended if all lengths are plain. Plain lengths that are much larger than those with a unit, and
//! would have a similar size with that unit, probably lack it.

use crate::check::errors::{self, PlainLength};
use crate::check::formulas::{Context, Formulas, Value};
use crate::check::scope::Entity;
use mechc_expr::ExprId;
use mechc_expr::math;
use mechc_syntax::ast::{Expr, ExprKind, Item};
use mechc_text::vocabulary::{Dimension, UNITS, Unit};
use rustc_hash::FxHashMap;

/// The ratio to the largest length with a unit from which a plain length probably lacks its unit.
const DWARFS: f64 = 10.0;
/// Numbers below this are written in metres, not in millimetres or inches.
const IN_METRES: f64 = 1.0;

impl<'a> Formulas<'a> {
    /// Records a length; `judged` says whether its formula holds a unit.
    pub(in crate::check) fn record_length_term(&mut self, e: &Expr, id: ExprId, judged: bool) {
        if judged {
            self.record_length(id);
        } else {
            self.record_plain_length(e, id);
        }
    }

    /// Records the numbers with which lengths are compared in a formula without units.
    pub(in crate::check) fn record_compared_lengths(&mut self, [a, b]: [(&Expr, Value); 2], context: &Context<'_>) {
        for ((_, value), (other, number)) in [(a, b), (b, a)] {
            let is_length = value.dim.settled().is(Dimension::LENGTH);
            let is_one = is_length && self.number_of(value.id).is_none();
            if !context.judged && is_one && self.number_of(number.id).is_some() {
                self.record_plain_length(other, number.id);
            }
        }
    }

    /// Records a constant length with a unit.
    fn record_length(&mut self, id: ExprId) {
        if let Some(value) = self.number_of(id).map(f64::abs).filter(|value| *value > 0.0) {
            let [least, most] = self.lengths.with_unit.unwrap_or([value; 2]);
            self.lengths.with_unit = Some([least.min(value), most.max(value)]);
        }
    }

    /// Records a length without a unit: a constant, or the constant terms of a sum.
    fn record_plain_length(&mut self, e: &Expr, id: ExprId) {
        if let Some(value) = self.number_of(id).map(f64::abs) {
            let plain = self.plain_root(e).unwrap_or(PlainLength { value, span: e.span, name: None, is_number: false });
            self.lengths.plain.extend(Some(plain).filter(|plain| plain.value > 0.0));
        } else if let ExprKind::Sum(first, rest) = &e.bare().kind {
            for term in std::iter::once(&**first).chain(rest.iter().map(|(_, term)| term)) {
                let plain = self.plain_root(term).filter(|plain| plain.value > 0.0);
                // Next to a unit the other terms need theirs too.
                self.lengths.plain.extend(plain.map(|plain| PlainLength { is_number: false, ..plain }));
            }
        }
    }

    /// Returns the number or parameter that a formula consists of apart from its sign, also through parameters that are aliases.
    pub(in crate::check) fn plain_root(&mut self, e: &Expr) -> Option<PlainLength<'a>> {
        let mut found: Option<PlainLength<'a>> = None;
        let mut e = e;
        loop {
            match &e.kind {
                ExprKind::Paren(inner) | ExprKind::Negate(inner) => e = inner,
                ExprKind::Literal { value, unit: None } => {
                    let name = found.and_then(|plain| plain.name);
                    let is_number = found.is_none_or(|plain| plain.is_number);
                    return Some(PlainLength { value: value.abs(), span: e.span, name, is_number });
                }
                ExprKind::Name(name) => {
                    let Some(Entity::Param(k)) = self.scope.entity(name) else { return found };
                    let (name, formula, is_in_the_text) = self.effective_formula(k)?;
                    let value = self.params[k].value.and_then(|value| self.number_of(value.id))?.abs();
                    let is_number = is_in_the_text && found.is_none_or(|plain| plain.is_number);
                    found = Some(PlainLength { value, span: formula.span, name: Some(name), is_number });
                    e = formula;
                }
                _ => return found.map(|plain| PlainLength { is_number: false, ..plain }),
            }
        }
    }

    /// Returns a parameter's name, its formula, and whether this formula stands in the text and is not an override.
    fn effective_formula(&self, k: usize) -> Option<(&'a str, &'a Expr, bool)> {
        let (name, value) = self.params[k].written?;
        let setting = self.settings_of(name).pop().map(|(_, setting)| setting);
        Some((&name.text, setting.map_or(value, |setting| &setting.value), setting.is_none()))
    }

    /// Warns of plain lengths that are much larger than all lengths with a unit, and would be similar to them in that unit.
    pub(in crate::check) fn warn_of_plain_lengths(&mut self) {
        let Some([least, most]) = self.lengths.with_unit else { return };
        let plain = &self.lengths.plain;
        let dwarfs = plain.iter().any(|length| length.value > DWARFS * most);
        if !dwarfs || plain.iter().any(|length| length.value < IN_METRES) {
            return;
        }
        let unit = usual_unit_of_length(self.scope.items()).unwrap_or(&UNITS[0]);
        let is_off = |value: f64| math::ln((value / most).max(least / value).max(1.0));
        let is_off_with = |factor: f64| plain.iter().map(|length| is_off(factor * length.value)).sum::<f64>();
        if is_off_with(unit.to_si(1.0, 1)) >= is_off_with(1.0) {
            return;
        }
        let mut plain = std::mem::take(&mut self.lengths.plain);
        plain.sort_by_key(|length| length.span);
        plain.dedup_by_key(|length| length.span);
        self.reporter.report(errors::no_unit_of_length(&plain, most, unit.word.name));
    }
}

/// Returns the unit in which most lengths of a mechanism are written; `None` without such a unit.
#[must_use]
pub fn usual_unit_of_length(items: &[Item]) -> Option<&'static Unit> {
    let mut counts: FxHashMap<&'static str, (usize, &'static Unit)> = FxHashMap::default();
    for e in items.iter().flat_map(Item::formulas) {
        let mut open = vec![e];
        while let Some(e) = open.pop() {
            if let ExprKind::Literal { unit: Some((name, 1)), .. } = &e.kind
                && let Some(unit) = Unit::named(&name.text).filter(|unit| unit.dimension.is(Dimension::LENGTH))
            {
                counts.entry(unit.word.name).or_insert((0, unit)).0 += 1;
            }
            open.extend(e.children());
        }
    }
    let most = counts.into_values().max_by_key(|&(count, unit)| (count, unit.word.name));
    most.map(|(_, unit)| unit)
}
