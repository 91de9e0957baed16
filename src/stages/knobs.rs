//! What of a mechanism can be turned by hand: its params, and its inputs.

use super::known::item_named;
use super::varied::{is_of_angles, number_and_unit, si_unit, written};
use super::{Checked, Compiled, Formula};
use crate::check::{Amount, usual_unit_of_length};
use crate::expr::{ExprId, Symbol};
use crate::ir::{BodyId, ConstraintSystem, Declaration, Input};
use crate::model::Dimension;
use crate::source::{Sources, Span};
use crate::sweep::rounded;
use crate::syntax::ast::{Expr, ExprKind, ItemKind};

/// A param, or a coordinate of one that is a point, as an option sets it.
#[derive(Clone, PartialEq, Debug)]
pub struct Knob {
    /// Its path.
    pub name: String,
    /// The unit that it is written in; where that is no single number, the one of what the formula names, or SI. Empty for a pure number.
    pub unit: String,
    /// Its dimension as an SI unit, in which angles are pure numbers.
    pub dimension: String,
    /// What it is by the text and what is set in it, in that unit.
    pub value: f64,
    /// What the text says, where that is more than a number.
    pub formula: Option<String>,
    /// Where the text says it; nothing of what another mechanism declares.
    pub place: Option<Span>,
    /// Where any text says it.
    pub stands: Option<Span>,
    /// Whether a mechanism can be led from one value to another: what decides how often something is there jumps.
    pub leads: bool,
}

/// An input.
#[derive(Clone, PartialEq, Debug)]
pub struct Jog {
    /// Its path.
    pub name: String,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// What it is at some times (SI).
    pub values: Vec<f64>,
    /// The formula, as it is written.
    pub formula: String,
}

/// A body that a driver turns by its angle alone.
#[derive(Clone, PartialEq, Debug)]
pub struct Crank {
    /// Its number among the bodies.
    pub body: usize,
    /// Around which of its points, where it is joined to the ground (m).
    pub pivot: [f64; 2],
    /// The input that its driver speaks of; nothing where time alone turns it.
    pub input: Option<String>,
}

impl Checked {
    /// What can be set of it, in the order of the text, then what can be set in parts; nothing where it is not sound.
    #[must_use]
    pub fn knobs(&self) -> Vec<Knob> {
        let (Some(tree), Some(model)) = (self.tree(), self.model()) else { return Vec::new() };
        let usual = usual_unit_of_length(&tree.items).map(|unit| unit.word.name);
        let mut knobs = Vec::new();
        for value in &self.known().values {
            let declared = tree.items.iter().find_map(|item| match &item.kind {
                ItemKind::Param { name, value: formula } if Some(name.span) == value.name => Some((name, formula)),
                _ => None,
            });
            let Some((name, formula)) = declared else { continue };
            let of = |dimension, is_angle| Kind { dimension, is_angle, usual: usual.filter(|_| dimension == LENGTH) };
            match &value.amount {
                Amount::Number { si, dimension, is_angle, unit } => {
                    let unit = unit.as_ref().map(|unit| unit.per_second(0));
                    let unit = unit.or_else(|| unit_of_named(formula, self, &knobs, (*dimension, *is_angle)));
                    knobs.push(self.knob(&name.text, formula, *si, (of(*dimension, *is_angle), unit)));
                }
                Amount::Point(at) => {
                    let parts = coordinates(formula);
                    for (k, axis) in ["x", "y"].into_iter().enumerate() {
                        let formula = parts.map_or(formula, |parts| &parts[k]);
                        let knob =
                            self.knob(&format!("{}.{axis}", name.text), formula, at[k], (of(LENGTH, false), None));
                        // a plain 0 is of the unit beside it
                        let beside = parts.and_then(|parts| number_and_unit(self.sources().text(parts[1 - k].span)));
                        let is_plain = knob.unit.is_empty();
                        let beside = beside.filter(|_| is_plain).map_or(knob.unit, |(_, unit)| unit.to_owned());
                        // and what is nothing else, of that of the others
                        let is_origin = beside.is_empty() && at.iter().all(|at| *at == 0.0);
                        let unit = usual.filter(|_| is_origin).map_or(beside, str::to_owned);
                        knobs.push(Knob { unit, place: knob.place.filter(|_| parts.is_some()), ..knob });
                    }
                }
            }
        }
        let own = knobs.len();
        for param in &model.params {
            let name = &param.declared.name;
            if name.contains('.') && !knobs[..own].iter().any(|knob| knob.name == *name) {
                knobs.push(self.knob_of_part(name, param.value, param.dimension));
            }
        }
        knobs
    }

    fn knob(&self, name: &str, formula: &Expr, si: f64, (kind, unit): (Kind, Option<String>)) -> Knob {
        let text = self.sources().text(formula.span);
        let place = Some(formula.span);
        let param = self.param_in_part(name);
        let si = param.map_or(si, |(value, _)| value);
        let dimension = si_unit(kind.dimension, false);
        let name = name.to_owned();
        if let Some((number, unit)) = number_and_unit(text) {
            let value = if self.is_set(&name) { in_unit(si, unit) } else { number };
            let (unit, leads) = (unit.to_owned(), param.is_some());
            return Knob { name, unit, dimension, value, formula: None, place, stands: place, leads };
        }
        let unit =
            unit.or_else(|| kind.usual.map(str::to_owned)).unwrap_or_else(|| si_unit(kind.dimension, kind.is_angle));
        let value = in_unit(si, &unit);
        Knob { name, unit, dimension, value, formula: Some(text.to_owned()), place, stands: place, leads: true }
    }

    /// A param of a part: in the unit in which some text says it.
    fn knob_of_part(&self, name: &str, si: f64, dimension: Dimension) -> Knob {
        let stands = self.said_of_part(name);
        let said = stands.and_then(|formula| number_and_unit(self.sources().text(formula.span)));
        let unit = said.map(|(_, unit)| unit).filter(|unit| !unit.is_empty()).map(str::to_owned);
        let unit = unit.unwrap_or_else(|| si_unit(dimension, false));
        let (value, dimension) = (in_unit(si, &unit), si_unit(dimension, false));
        let stands = stands.map(|formula| formula.span);
        Knob { name: name.to_owned(), unit, dimension, value, formula: None, place: None, stands, leads: true }
    }

    /// The formula that says what a param of a part is: where the part is declared, or in its own mechanism.
    fn said_of_part(&self, path: &str) -> Option<&Expr> {
        let mut tree = self.tree()?;
        let mut names = path.split('.').map(|name| name.split('[').next().unwrap_or_default());
        let mut name = names.next()?;
        loop {
            match &item_named(tree, name)?.kind {
                ItemKind::Param { value, .. } => {
                    let axis = names.next().map(|axis| usize::from(axis == "y"));
                    return Some(axis.zip(coordinates(value)).map_or(value, |(axis, parts)| &parts[axis]));
                }
                ItemKind::Part(part) => {
                    name = names.next()?;
                    let bound =
                        part.bindings.iter().find(|bound| bound.name.text == name && bound.coordinate.is_none());
                    if let Some(bound) = bound {
                        return Some(&bound.value);
                    }
                    tree = self.mechanism(&part.mechanism)?;
                }
                _ => return None,
            }
        }
    }

    /// Whether something else than the text says what a param, or a coordinate of one, is.
    fn is_set(&self, name: &str) -> bool {
        let is_it =
            |path: &str| path == name || name.strip_prefix(path).is_some_and(|axis| [".x", ".y"].contains(&axis));
        self.surroundings.settings.iter().any(|setting| is_it(&setting.path))
    }
}

/// What a param is by its value.
struct Kind {
    dimension: Dimension,
    is_angle: bool,
    /// The unit in which its text writes what is of this dimension.
    usual: Option<&'static str>,
}

/// The unit of the first param that a formula names and that is of its dimension.
fn unit_of_named(
    formula: &Expr,
    of: &Checked,
    knobs: &[Knob],
    (dimension, is_angle): (Dimension, bool),
) -> Option<String> {
    let dimension = si_unit(dimension, false);
    let text = of.sources().text(formula.span);
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.')));
    let named = words.find_map(|word| {
        knobs.iter().find(|knob| knob.name == word && knob.dimension == dimension && !knob.unit.is_empty())
    });
    named.filter(|_| !dimension.is_empty() || is_angle).map(|knob| knob.unit.clone())
}

/// A value (SI) in a unit.
fn in_unit(si: f64, unit: &str) -> f64 {
    rounded(si / size_of_unit(unit))
}

/// What one of a unit is in SI; not a number of what is none.
#[must_use]
pub fn size_of_unit(unit: &str) -> f64 {
    if unit.is_empty() {
        return 1.0;
    }
    let formula = Formula::of(&written(1.0, unit), &mut Sources::default());
    formula.ok().and_then(|formula| formula.values(0.0).ok()).map_or(f64::NAN, |[value, ..]| value)
}

const LENGTH: Dimension = Dimension::LENGTH;

/// Both coordinates of a point that is written as such.
fn coordinates(formula: &Expr) -> Option<&[Expr; 2]> {
    match &formula.kind {
        ExprKind::Tuple(parts) => parts.as_slice().try_into().ok(),
        ExprKind::Paren(inner) => coordinates(inner),
        _ => None,
    }
}

impl Checked {
    /// The inputs of what it was compiled to, with what they are at some times (s).
    #[must_use]
    pub fn jogs(&self, compiled: &Compiled, times: &[f64]) -> Vec<Jog> {
        let system = compiled.system();
        let formula = |span: Span| {
            let items =
                self.library().files().iter().flat_map(|file| &file.read.tree.mechanisms).flat_map(|m| &m.items);
            let mut inputs = items.filter_map(|item| match &item.kind {
                ItemKind::Input { name, value } if name.span == span => Some(self.sources().text(value.span)),
                _ => None,
            });
            inputs.next().unwrap_or_default()
        };
        let jog = |input: &Input| Jog {
            name: input.name.clone(),
            unit: match input.unit.as_str() {
                "1" if is_of_angles(formula(input.span)) || compiled.turns(input) => "rad".to_owned(),
                "1" => String::new(),
                unit => unit.to_owned(),
            },
            values: times.iter().map(|&t| at_time(system, input.formulas[0], t)).collect(),
            formula: formula(input.span).to_owned(),
        };
        system.inputs().iter().map(jog).collect()
    }
}

impl Compiled {
    /// The bodies that can be turned by hand.
    #[must_use]
    pub fn cranks(&self) -> Vec<Crank> {
        let system = self.system();
        let crank = |row: usize| {
            let [(column, _)] = system.phi_q().row(row) else { return None };
            let body = system.body_of(*column as usize)?;
            let [_, _, phi] = system.pose_of(body);
            let input = system.inputs().iter().find(|input| self.speaks_of(row, input)).map(|input| input.name.clone());
            let pivot = system.declarations().iter().find_map(|joint| self.pivot(joint, body))?;
            (phi == *column as usize).then_some(Crank { body: body.index(), pivot, input })
        };
        (0..system.rows().len()).filter(|&row| system.is_driver(row)).filter_map(crank).collect()
    }

    /// Whether a driver turns something by an input.
    fn turns(&self, input: &Input) -> bool {
        let system = self.system();
        let is_angle = |&(column, _): &(u32, ExprId)| {
            system.body_of(column as usize).is_some_and(|body| system.pose_of(body)[2] == column as usize)
        };
        (0..system.rows().len())
            .filter(|&row| system.is_driver(row) && system.phi_q().row(row).iter().all(is_angle))
            .any(|row| self.speaks_of(row, input))
    }

    /// Whether the formula of a driver's row names an input.
    fn speaks_of(&self, row: usize, input: &Input) -> bool {
        let written = self.system().declaration_of(row).written.map(|span| self.sources().text(span));
        let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
        written.is_some_and(|written| written.split(|c| !is_name(c)).any(|word| word == input.name))
    }

    /// Where a joint holds a body to the ground.
    fn pivot(&self, joint: &Declaration, body: BodyId) -> Option<[f64; 2]> {
        let system = self.system();
        let [one, other] = joint.points.as_slice() else { return None };
        let on_body = match [one, other].map(|point| system.points()[*point].body) {
            [None, Some(on)] if on == body => other,
            [Some(on), None] if on == body => one,
            _ => return None,
        };
        Some(system.points()[*on_body].at.map(|id| system.value_at(id, &[])))
    }
}

/// The value of a formula of time.
fn at_time(system: &ConstraintSystem, formula: ExprId, t: f64) -> f64 {
    system.graph().value(formula, |symbol| match symbol {
        Symbol::Param(k) => system.params()[k as usize].value,
        Symbol::Time => t,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    })
}

#[cfg(test)]
mod tests {
    use crate::stages::{Choice, Parsed};
    use crate::world::Memory;

    #[test]
    fn params_are_told_as_they_are_written() {
        let text = "mechanism lever {
            param length = 50 mm
            param half = length / 2
            param speed = -60 rpm
            param turning = 90 deg/s
            param count = 2
            param A = (10 mm, 0)
            param B = (0, 0)
            ground { point O = A }
            body bar[k in 0..count] at (0, 0, k * 1 deg) { point O = (half, 0) point P = (length, 0) }
        }";
        let checked = Parsed::of("lever.mech", text).check(&Choice::default(), &Memory::default());
        let knobs = checked.knobs();
        let told: Vec<_> = knobs.iter().map(|k| (k.name.as_str(), k.value, k.unit.as_str(), k.leads)).collect();
        assert_eq!(
            told,
            [
                ("length", 50.0, "mm", true),
                ("half", 25.0, "mm", true),
                ("speed", -60.0, "rpm", true),
                ("turning", 90.0, "deg/s", true),
                ("count", 2.0, "", false),
                ("A.x", 10.0, "mm", true),
                ("A.y", 0.0, "mm", true),
                ("B.x", 0.0, "mm", true),
                ("B.y", 0.0, "mm", true),
            ]
        );
        assert_eq!(knobs[1].formula.as_deref(), Some("length / 2"));
        let place = knobs[5].place.expect("a place");
        assert_eq!(checked.sources().text(place), "10 mm");
    }
}
