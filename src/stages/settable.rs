//! What of a mechanism can be set from outside, in SI: its params, and its inputs.

use super::varied::{is_of_angles, si_unit};
use super::{Checked, Compiled};
use crate::check::Amount;
use crate::syntax::ast::ItemKind;

/// A param or an input, as an option sets it.
#[derive(Clone, PartialEq, Debug)]
pub struct Settable {
    /// Its path: `crank_length`, `A.x`, `leg[1].la`.
    pub name: String,
    /// The SI unit of its values, as a formula has it; empty for a pure number.
    pub unit: String,
    /// What it is by the text (SI); of an input, at the first time of the analysis.
    pub value: f64,
}

impl Checked {
    /// Its params, in the order of the text, then those of its parts; nothing where it is not sound.
    #[must_use]
    pub fn settable_params(&self) -> Vec<Settable> {
        let (Some(tree), Some(model)) = (self.tree(), self.model()) else { return Vec::new() };
        let mut found: Vec<Settable> = Vec::new();
        for known in &self.known().values {
            let declared = tree.items.iter().find_map(|item| match &item.kind {
                ItemKind::Param { name, value } if Some(name.span) == known.name => Some((&name.text, value.span)),
                _ => None,
            });
            let Some((name, formula)) = declared else { continue };
            let is_angle = is_of_angles(self.sources().text(formula));
            match &known.amount {
                Amount::Number { si, dimension, is_angle: is_known_angle, .. } => {
                    let unit = si_unit(*dimension, is_angle || *is_known_angle);
                    found.push(Settable { name: name.clone(), unit, value: *si });
                }
                Amount::Point(at) => found.extend(["x", "y"].into_iter().zip(at).map(|(axis, &value)| {
                    let (name, unit) = (format!("{name}.{axis}"), "m".to_owned());
                    Settable { name, unit, value }
                })),
            }
        }
        let own = found.len();
        for param in &model.params {
            let name = &param.declared.name;
            match found[..own].iter_mut().find(|known| known.name == *name) {
                // what the model holds is what is computed with
                Some(known) => known.value = param.value,
                None if name.contains('.') => {
                    let unit = si_unit(param.dimension, false);
                    found.push(Settable { name: name.clone(), unit, value: param.value });
                }
                None => {}
            }
        }
        found
    }

    /// The inputs of what it was compiled to.
    #[must_use]
    pub fn settable_inputs(&self, compiled: &Compiled) -> Vec<Settable> {
        let first = compiled.analysis().map_or(0.0, |[from, ..]| from);
        let jogs = self.jogs(compiled, &[first]).into_iter();
        jogs.map(|jog| Settable { name: jog.name, unit: jog.unit, value: jog.values[0] }).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::{Cancel, Choice, Memory, Parsed, Redundant};

    #[test]
    fn params_and_inputs_are_told_in_si() {
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
        let checked = Parsed::of("lever.mech", text).check(&Choice::default(), &Memory::default());
        let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
        let of = |settable: Vec<super::Settable>| -> Vec<String> {
            settable.into_iter().map(|of| format!("{} = {:.3} {}", of.name, of.value, of.unit)).collect()
        };
        assert_eq!(
            of(checked.settable_params()),
            ["length = 0.050 m", "lean = 0.524 rad", "count = 2.000 ", "A.x = 0.010 m", "A.y = 0.020 m"]
        );
        assert_eq!(of(checked.settable_inputs(&compiled)), ["turn = 7.854 rad"]);
    }
}
