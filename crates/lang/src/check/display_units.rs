//! Compound units, and the units in which measures and traces are printed.

use super::Checker;
use super::entity::Entity;
use super::errors;
use super::formula::{Dim, Value};
use super::variables;
use crate::model::{Dimension, Units};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name, WrittenUnit};
use mechc_text::diag::Diagnostic;
use mechc_text::vocabulary::{CompoundUnit, Constant, NamedConstant, Unit};

impl Checker<'_> {
    /// Returns the unit of a product. Names that are not units are reported.
    pub(super) fn compound(
        &mut self,
        written: &WrittenUnit,
        not_a_unit: impl Fn(&Name) -> Diagnostic,
    ) -> Option<CompoundUnit> {
        let mut factors = Vec::new();
        for of in &written.factors {
            let power = if of.factor == Factor::Divide { -of.power } else { of.power };
            match Unit::named(&of.name.text) {
                Some(unit) => factors.push((unit, power)),
                None => self.report(not_a_unit(&of.name)),
            }
        }
        (factors.len() == written.factors.len()).then(|| CompoundUnit::new(factors))
    }

    /// Returns the units in which a formula is printed; `None` if the unit after `in` does not fit, which is reported.
    pub(super) fn units(
        &mut self,
        formula: &Expr,
        dimension: Option<Dimension>,
        angle: i32,
        written: Option<&WrittenUnit>,
    ) -> Option<Units> {
        let Some(written) = written else {
            return Some(Units::si(dimension.unwrap_or(Dimension::PURE), angle == 1));
        };
        let unit = self.compound(written, errors::not_a_unit_to_print_in)?;
        let unit_dimension = unit.dimension();
        if let Some(dimension) = dimension.filter(|dimension| !dimension.is(unit_dimension)) {
            let text = self.sources.text(written.span);
            self.report(errors::not_printed_in(text, [written.span, formula.span], [unit_dimension, dimension]));
            return None;
        }
        let hertz = unit.factors().zip(&written.factors).find(|((unit, _), _)| unit.word.name == "Hz");
        if let Some((_, written)) = hertz.filter(|_| angle == 1) {
            self.report(errors::turning_in_hertz(written.name.span, formula.span));
            return None;
        }
        let joule = unit.factors().zip(&written.factors).find(|((unit, _), _)| unit.word.name == "J");
        if let Some((_, written)) = joule.filter(|_| unit_dimension.is(Dimension::ENERGY) && self.is_torque(formula)) {
            self.report(errors::torque_in_joules(written.name.span, formula.span));
            return None;
        }
        self.warn_of_numbers_printed(formula, written);
        Some(Units::of(&unit, angle == 1))
    }

    /// Returns the exponent of angles in a formula, as far as it shows: 1 for an angle or angular velocity.
    pub(super) fn angle_power(&self, e: &Expr) -> i32 {
        let most = |list: &[Expr]| list.iter().map(|part| self.angle_power(part)).max().unwrap_or(0);
        match &e.kind {
            ExprKind::Paren(inner) | ExprKind::Negate(inner) => self.angle_power(inner),
            ExprKind::Literal { unit: Some((unit, power)), .. } => {
                Unit::named(&unit.text).map_or(0, |unit| angle_power_of(unit).saturating_mul(*power))
            }
            ExprKind::Name(name) => self.angle_power_of_name(name),
            ExprKind::Call { name, arguments, .. } => match name.text.as_str() {
                "angle" | "rotation" | "pressure_angle" | "asin" | "acos" | "atan" | "atan2" => 1,
                "der" if arguments.len() == 2 => {
                    let by = variables::as_derivative(e).map_or(0, |(_, by)| self.angle_power_of_variable(by));
                    self.angle_power(&arguments[0]).saturating_sub(by)
                }
                "der" | "abs" | "min" | "max" | "mod" | "mean" | "rms" | "first" | "last" | "at" => most(arguments),
                _ => 0,
            },
            ExprKind::Sum(first, rest) => {
                rest.iter().map(|(_, term)| self.angle_power(term)).fold(self.angle_power(first), i32::max)
            }
            ExprKind::Product(first, rest) => rest.iter().fold(self.angle_power(first), |power, (factor, term)| {
                let exponent = self.angle_power(term);
                if *factor == Factor::Divide { power.saturating_sub(exponent) } else { power.saturating_add(exponent) }
            }),
            ExprKind::Power(base, exponent) => match exponent.bare_number() {
                // A fractional exponent does not give an angle.
                Some(exponent) => self.angle_power(base).saturating_mul(exponent as i32),
                None => 0,
            },
            ExprKind::If { arms, otherwise } => {
                arms.iter().map(|(_, value)| self.angle_power(value)).fold(self.angle_power(otherwise), i32::max)
            }
            _ => 0,
        }
    }

    /// Returns the exponent of angles in the variable of a derivative.
    fn angle_power_of_variable(&self, by: &Expr) -> i32 {
        match &by.bare().kind {
            ExprKind::Name(name) => match self.entity(name) {
                Some(entity @ Entity::Input(_)) => match self.home_of(entity) {
                    (home, Entity::Input(k)) => home.angle_power(home.inputs[k].formula),
                    _ => 0,
                },
                _ => self.angle_power_of_name(name),
            },
            _ => 0,
        }
    }

    fn angle_power_of_name(&self, name: &Name) -> i32 {
        match self.entity(name) {
            Some(Entity::Param(k)) => self.params.get(k).map_or(0, |param| param.angle),
            Some(Entity::Measure(k)) => self.measure_state(k).map_or(0, |measure| measure.angle),
            Some(Entity::Result(k)) => self.result_state(k).map_or(0, |result| result.angle),
            Some(_) => 0,
            None => match Constant::named(&name.text) {
                Some(Constant { stands_for: NamedConstant::Number(_), .. }) => 1,
                Some(_) => 0,
                None => Unit::named(&name.text).map_or(0, angle_power_of),
            },
        }
    }
}

/// Returns the dimension of a formula; `None` if it fits any, as a number without a unit does.
pub(super) fn determined_dimension(value: Value) -> Option<Dimension> {
    match value.dim {
        Dim::Of(dimension) => Some(dimension),
        Dim::Plain { read, fits: true } if !read.is(Dimension::PURE) => Some(read),
        Dim::Plain { .. } | Dim::Any => None,
    }
}

fn angle_power_of(unit: &Unit) -> i32 {
    i32::from(unit.measures_angle())
}
