//! Values of params that options give as formulas: `--vary`, `--tol`, `--set`. Reads numbers, their units and dimensions, and tries them in
//! the mechanism.

use crate::checked::TOL;
use crate::options::spaceless;
use crate::{Checked, Choice, Formula, Parsed};
use mechc_lang::model::Dimension;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error, Severity, readable};
use mechc_text::vocabulary::Unit;
use mechc_text::world::World;

/// A number that an option gives as a formula.
#[derive(Clone, Copy)]
pub(crate) struct OptionNumber {
    /// Value in SI.
    pub si: f64,
    /// Dimension, if numbers without units are pure.
    pub dimension: Dimension,
    /// True if the formula has a unit of length, time or mass.
    pub is_dimensional: bool,
}

/// Refuses params that are given twice, and a param of one copy before that of all copies, which would overwrite it.
pub(crate) fn refuse_duplicates<'n>(
    names: impl Iterator<Item = &'n String>,
    choice: &Choice,
) -> Result<(), Box<Diagnostic>> {
    let names: Vec<&String> = names.collect();
    let set: Vec<String> =
        choice.set.iter().filter_map(|set| set.split_once('=')).map(|(set, _)| spaceless(set)).collect();
    for (k, &name) in names.iter().enumerate() {
        if names[..k].contains(&name) {
            return Err(unusable(format!("`{name}` is to vary twice"))
                .help("say it once, or name another param")
                .into());
        }
        let mut before = names[..k].iter().copied().chain(&set);
        if let Some(hidden) = before.find(|one| is_of_copy(one, name)) {
            return Err(unusable(format!("`{hidden}` would be what `{name}` is, which is that of all copies"))
                .help(format!("leave `{hidden}` out, or say it behind `{name}`"))
                .into());
        }
        if set.contains(name) {
            return Err(unusable(format!("`{name}` is set, and is to vary"))
                .help("leave `--set` or `--vary` out")
                .into());
        }
    }
    Ok(())
}

/// Returns whether `one` is the param of one copy of a part, and `all` that of all copies.
fn is_of_copy(one: &str, all: &str) -> bool {
    let without_numbers: String = one
        .split('[')
        .enumerate()
        .map(|(k, part)| if k == 0 { part } else { part.split_once(']').map_or("", |(_, rest)| rest) })
        .collect();
    one.contains('[') && without_numbers == all
}

/// Reads the values that an option gives to params, and tries them in the mechanism.
pub(crate) struct OptionReader<'r> {
    pub parsed: &'r Parsed,
    pub checked: &'r Checked,
    pub choice: &'r Choice,
    pub world: &'r dyn World,
    /// The option that messages name.
    pub option: &'static str,
}

impl OptionReader<'_> {
    /// Checks the mechanism with a param set to a formula. Errors in the formula itself are returned as errors; errors that the value causes
    /// in the mechanism stay in its diagnostics.
    pub fn check_with(&self, name: &str, formula: &str) -> Result<Checked, Error> {
        let set = vec![format!("{name}={formula}")];
        let choice = match self.option {
            TOL => Choice { deviations: set, ..self.choice.clone() },
            _ => Choice { varied: set, ..self.choice.clone() },
        };
        let checked = self.parsed.check(&choice, self.world);
        let sources = checked.sources();
        let is_of_option = |diagnostic: &&Diagnostic| {
            let source = diagnostic.labels.first().map(|label| sources.get(label.span.file));
            diagnostic.severity() == Severity::Error
                && source.is_some_and(|source| source.is_option && source.name.starts_with(self.option))
        };
        let mut wrong = Diagnostics::default();
        checked.diagnostics().iter().filter(is_of_option).for_each(|diagnostic| wrong.push(diagnostic.clone()));
        if wrong.is_empty() { Ok(checked) } else { Err(Error::new(wrong, sources)) }
    }

    /// Checks the mechanism with a param set to a number; returns it with the value (SI) and its dimension, if it has one.
    pub fn number(&self, name: &str, formula: &str) -> Result<(Checked, OptionNumber), Error> {
        let number = self.check_with(name, formula).and_then(|checked| {
            let number = self.value(formula)?;
            Ok((checked, number))
        });
        let refused = || Error::new(self.point_needs_axis(name, formula), self.checked.sources());
        number.map_err(|why| if self.is_point(name) { refused() } else { why })
    }

    fn is_point(&self, name: &str) -> bool {
        let x = format!("{name}.x");
        self.checked.settable_params().iter().any(|param| param.name == x)
    }

    /// Reports that a point varies by its coordinates.
    fn point_needs_axis(&self, name: &str, formula: &str) -> Diagnostic {
        let option = self.option;
        unusable(format!("`{name}` is a point, and `{option}` takes numbers: `{formula}` cannot be said of it"))
            .help(format!("say it of a coordinate: `{option} {name}.x=…`, `{option} {name}.y=…`, or both"))
    }

    /// Returns the value of a formula.
    pub fn value(&self, formula: &str) -> Result<OptionNumber, Error> {
        let mut sources = self.checked.sources().clone();
        let formula = Formula::parse(formula, &mut sources)?;
        let [si, ..] = formula.values(0.0)?;
        let is_dimensional = formula.known_dimension().is_some();
        Ok(OptionNumber { si, dimension: formula.pure_dimension(), is_dimensional })
    }
}

/// Splits `40 mm`, `-1.5e3`, `90 deg/s`, `3e-4 kg*m^2`, `-(3 mm)` into number and unit, so that a slider can show the unit as it is written.
pub(crate) fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    if let Some(inner) = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) {
        return number_and_unit(inner);
    }
    if let Some(behind) = text.strip_prefix('-').map(str::trim_start).filter(|behind| behind.starts_with('(')) {
        return number_and_unit(behind).map(|(value, unit)| (-value, unit));
    }
    let ends = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
    // the longest beginning that is a number; words such as `inf` are none
    let is_numeric = |part: &str| part.ends_with(|c: char| c.is_ascii_digit() || c == '.');
    let (value, unit) = ends
        .map(|end| text.split_at(end))
        .find_map(|(number, unit)| Some((number.parse::<f64>().ok().filter(|_| is_numeric(number))?, unit.trim())))?;
    (unit.is_empty() || is_unit(unit)).then_some((value, unit))
}

/// Returns whether a text is a product or quotient of units and their powers; it may begin with `/`.
fn is_unit(text: &str) -> bool {
    text.strip_prefix('/').unwrap_or(text).split(['*', '/']).map(str::trim).all(|part| {
        let (word, power) = part.split_once('^').unwrap_or((part, "1"));
        Unit::named(word.trim_end()).is_some() && power.trim_start().parse::<i32>().is_ok()
    })
}

/// Returns the SI unit of a dimension as it follows a number; empty for a pure number that is no angle.
pub(crate) fn si_unit(dimension: Dimension) -> String {
    behind_number(&dimension.display_unit())
}

/// Returns the SI unit of a dimension as it follows a number, in which angles are pure numbers.
pub(crate) fn unit_without_angles(dimension: Dimension) -> String {
    behind_number(&dimension.unit())
}

fn behind_number(unit: &str) -> String {
    unit.strip_prefix('1').unwrap_or(unit).to_owned()
}

/// Writes a value with its unit as a formula.
pub(crate) fn written(value: f64, unit: &str) -> String {
    let value = readable(value);
    if unit.is_empty() || unit.starts_with('/') { format!("{value}{unit}") } else { format!("{value} {unit}") }
}

/// Reports an option that cannot be used.
pub(crate) fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}
