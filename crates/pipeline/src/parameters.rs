//! Params and inputs that options can set, with their SI values.

use crate::option_reader::si_unit;
use crate::{Checked, Compiled};
use mechc_lang::check::{self, Amount};
use mechc_lang::model::Dimension;
use mechc_syntax::{self as syntax, ast::ItemKind};
use mechc_text::diag::Error;
use mechc_text::source::Sources;

/// A param or an input that an option can set.
#[derive(Clone, PartialEq, Debug)]
pub struct SettableParam {
    /// Path: `crank_length`, `A.x`, `leg[1].la`.
    pub name: String,
    /// SI unit of its values, as a formula has it; empty for a pure number.
    pub unit: String,
    /// Value (SI) by the text; that of an input is at the first time of the analysis.
    pub value: f64,
    /// Dimension of its values.
    pub(crate) dimension: Dimension,
}

impl SettableParam {
    /// Evaluates a formula (SI) that an option gives; messages call it `what` and the name of the param.
    ///
    /// # Errors
    /// The text is no formula of numbers and units, or has another dimension.
    pub fn read(&self, option: &str, what: &str, text: &str, sources: &mut Sources) -> Result<f64, Error> {
        let file = sources.add_option(option, text);
        let value = syntax::parse_expression(sources, file)
            .and_then(|formula| check::amount(&formula, &format!("{what} `{}`", self.name), self.dimension, sources));
        value.map_err(|why| Error::new(why, sources))
    }

    /// Returns its time derivative of an order, as something to be set.
    #[must_use]
    pub fn by_time(&self, order: u32) -> SettableParam {
        let per = if order == 1 { "s".to_owned() } else { format!("s^{order}") };
        let dimension = self.dimension.over(Dimension::TIME.to_the(f64::from(order)));
        SettableParam { name: self.name.clone(), unit: format!("{}/{per}", self.unit), value: 0.0, dimension }
    }
}

impl Checked {
    /// Returns the params, in the order of the text, then those of parts; empty if the mechanism has errors.
    #[must_use]
    pub fn settable_params(&self) -> Vec<SettableParam> {
        let (Some(tree), Some(model)) = (self.tree(), self.model()) else { return Vec::new() };
        let mut params: Vec<SettableParam> = Vec::new();
        for declared_value in &self.declaration_info().values {
            let declared = tree.items.iter().find_map(|item| match &item.kind {
                ItemKind::Param { name, .. } if Some(name.span) == declared_value.name => Some(&name.text),
                _ => None,
            });
            let Some(name) = declared else { continue };
            match &declared_value.amount {
                Amount::Number { si, dimension, .. } => {
                    let unit = si_unit(*dimension);
                    params.push(SettableParam { name: name.clone(), unit, value: *si, dimension: *dimension });
                }
                Amount::Point(at) => params.extend(["x", "y"].into_iter().zip(at).map(|(axis, &value)| {
                    let (name, unit) = (format!("{name}.{axis}"), "m".to_owned());
                    SettableParam { name, unit, value, dimension: Dimension::LENGTH }
                })),
            }
        }
        let count = params.len();
        for param in &model.params {
            let name = &param.declared.name;
            match params[..count].iter_mut().find(|param| param.name == *name) {
                // the value in the model is the one that is computed with
                Some(listed) => listed.value = param.value,
                None if name.contains('.') => {
                    let unit = si_unit(param.dimension);
                    params.push(SettableParam {
                        name: name.clone(),
                        unit,
                        value: param.value,
                        dimension: param.dimension,
                    });
                }
                None => {}
            }
        }
        params
    }

    /// Returns the inputs of the compiled mechanism.
    #[must_use]
    pub fn settable_inputs(&self, compiled: &Compiled) -> Vec<SettableParam> {
        let jogs = self.input_controls(compiled, &[compiled.first_time()]).into_iter();
        let inputs = jogs.zip(compiled.system().inputs());
        inputs
            .map(|(jog, input)| SettableParam {
                name: jog.name,
                unit: jog.unit,
                value: jog.values[0],
                dimension: input.dimension,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::{Choice, Parsed, Redundant};
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;

    #[test]
    fn formulas_have_the_dimension_of_the_param() {
        let text = "mechanism lever {
            param length = 50 mm
            input slide  = 0.1 m/s * t
            ground { axis way = (0, 0) along (1, 0) }
            body block { axis way = (0, 0) along (1, 0) }
            joint guide: translational(ground.way, block.way)
            driver motor: displacement(guide) = slide + 0 * length
        }";
        let checked = Parsed::new("lever.mech", text).check(&Choice::default(), &Memory::default());
        let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
        let (params, inputs) = (checked.settable_params(), checked.settable_inputs(&compiled));
        let rate = inputs[0].by_time(1);
        assert_eq!(rate.unit, "m/s");
        let read = |param: &super::SettableParam, text: &str| {
            let mut sources = mechc_text::source::Sources::default();
            let first_message = |why: mechc_text::diag::Error| why.first().expect("an error").message.clone();
            param.read("--set it", "the value of", text, &mut sources).map_err(first_message)
        };
        assert_eq!(read(&params[0], "2 * (20 mm + 1 cm)"), Ok(0.06));
        assert_eq!(read(&inputs[0], "20 mm"), Ok(0.02));
        assert_eq!(read(&rate, "20 mm/s"), Ok(0.02));
        assert_eq!((read(&rate, "0"), read(&params[0], "0")), (Ok(0.0), Ok(0.0)));
        assert_eq!(
            read(&params[0], "45"),
            Err("the value of `length` must be a length, found a pure number".to_owned())
        );
        let wrong = "the value of `slide` must be a speed (m/s), found a length";
        assert_eq!(read(&rate, "20 mm"), Err(wrong.to_owned()));
        assert_eq!(read(&params[0], "t"), Err("time `t` may not stand in the value of `length`".to_owned()));
        assert!(read(&params[0], "1 m) + (1 m").is_err());
        assert!(read(&params[0], "length").is_err());
    }

    #[test]
    fn params_and_inputs_are_in_si() {
        let text = "mechanism lever {
            param length = 50 mm
            param lean   = 30 deg
            param count  = 2
            param A      = (10 mm, 20 mm)
            input turn   = 60 rpm * t + 90 deg
            ground { point O = A }
            body bar[k in 0..count] { point O = (0, 0) point P = (length, 0) }
            joint pin[k in 0..count]: revolute(ground.O, bar[k].O)
            driver motor[k in 0..count]: rotation(pin[k]) = turn + k * lean
            analysis from 1 s to 2 s every 1 s
        }";
        let checked = Parsed::new("lever.mech", text).check(&Choice::default(), &Memory::default());
        let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
        let described = |params: Vec<super::SettableParam>| -> Vec<String> {
            params.into_iter().map(|param| format!("{} = {:.3} {}", param.name, param.value, param.unit)).collect()
        };
        assert_eq!(
            described(checked.settable_params()),
            ["length = 0.050 m", "lean = 0.524 rad", "count = 2.000 ", "A.x = 0.010 m", "A.y = 0.020 m"]
        );
        assert_eq!(described(checked.settable_inputs(&compiled)), ["turn = 7.854 rad"]);
    }
}
