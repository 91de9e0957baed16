//! Compound units, and the units in which measures and traces are printed.

use super::Formulas;
use super::value::Dim;
use crate::check::errors::{self, Reporter};
use crate::model::{Dimension, Units};
use mechc_syntax::ast::{Expr, Factor, Name, WrittenUnit};
use mechc_text::diag::Diagnostic;
use mechc_text::vocabulary::{CompoundUnit, Unit};

impl Formulas<'_> {
    /// Returns the units in which a formula is printed; `None` if the unit after `in` does not fit, which is reported.
    pub(in crate::check) fn units(&mut self, formula: &Expr, dim: Dim, written: Option<&WrittenUnit>) -> Option<Units> {
        let settled = dim.settled();
        let Some(written) = written else {
            return Some(Units::si(settled));
        };
        let dimension = determined_dimension(dim);
        let unit = compound(&mut self.reporter, written, errors::not_a_unit_to_print_in)?;
        let unit_dimension = unit.dimension();
        if let Some(dimension) = dimension.filter(|dimension| !dimension.is(unit_dimension)) {
            let text = self.reporter.text(written.span);
            self.reporter.report(errors::not_printed_in(
                text,
                [written.span, formula.span],
                [unit_dimension, dimension],
            ));
            return None;
        }
        let hertz = unit.factors().zip(&written.factors).find(|((unit, _), _)| unit.word.name == "Hz");
        if let Some((_, written)) = hertz.filter(|_| settled.is_angular()) {
            self.reporter.report(errors::turning_in_hertz(written.name.span, formula.span));
            return None;
        }
        let joule = unit.factors().zip(&written.factors).find(|((unit, _), _)| unit.word.name == "J");
        if let Some((_, written)) = joule.filter(|_| unit_dimension.is(Dimension::ENERGY) && self.is_torque(formula)) {
            self.reporter.report(errors::torque_in_joules(written.name.span, formula.span));
            return None;
        }
        self.warn_of_numbers_printed(formula, written);
        Some(Units::of(&unit, settled))
    }
}

/// Returns the dimension of a formula; `None` if it fits any, as a number without a unit does.
pub(in crate::check) fn determined_dimension(dim: Dim) -> Option<Dimension> {
    match dim {
        Dim::Of(dimension) => Some(dimension),
        Dim::Plain { read, fits: true } if !read.is(Dimension::PURE) => Some(read),
        Dim::Plain { .. } | Dim::Any => None,
    }
}

/// Returns the unit of a product. Names that are not units are reported.
pub(in crate::check) fn compound(
    reporter: &mut Reporter<'_>,
    written: &WrittenUnit,
    not_a_unit: impl Fn(&Name) -> Diagnostic,
) -> Option<CompoundUnit> {
    let mut factors = Vec::new();
    for of in &written.factors {
        let power = if of.factor == Factor::Divide { -of.power } else { of.power };
        match Unit::named(&of.name.text) {
            Some(unit) => factors.push((unit, power)),
            None => reporter.report(not_a_unit(&of.name)),
        }
    }
    (factors.len() == written.factors.len()).then(|| CompoundUnit::new(factors))
}
