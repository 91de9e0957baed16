//! Controls of a page: the params and inputs that a user can change by hand.

use crate::option_reader::{number_and_unit, si_unit, unit_without_angles, written};
use crate::queries::item_named;
use crate::{Checked, Compiled, Formula};
use mechc_engine::sweep::round_to_15_digits;
use mechc_expr::{ExprId, Symbol};
use mechc_ir::{ConstraintSystem, Input};
use mechc_lang::check::{Amount, usual_unit_of_length};
use mechc_lang::model::Dimension;
use mechc_syntax::ast::{Expr, ExprKind, ItemKind};
use mechc_text::source::{Sources, Span};
use mechc_text::vocabulary::Unit;
use rustc_hash::FxHashMap;

/// A control of a param, or of a coordinate of a param that is a point.
#[derive(Clone, PartialEq, Debug)]
pub struct ParamControl {
    /// Path of the param.
    pub name: String,
    /// Unit in which the param is written. If its formula is no single number: the unit of a param that the formula names, or SI. Empty for a pure
    /// number.
    pub unit: String,
    /// Dimension as an SI unit, in which angles are pure numbers.
    pub dimension: String,
    /// Value in that unit, by the text and the settings.
    pub value: f64,
    /// Formula of the text, if it is more than a number.
    pub formula: Option<String>,
    /// Span of the formula, if it can be replaced.
    pub editable_span: Option<Span>,
    /// True if that formula gives the other coordinate of a point, too.
    pub is_half: bool,
    /// Span of the formula, if there is one.
    pub formula_span: Option<Span>,
    /// Path of the control of all copies, if this one is of a single copy of a part.
    pub of: Option<String>,
    /// True if continuation can change the value; counts of declarations jump.
    pub is_continuous: bool,
}

/// A control of an input.
#[derive(Clone, PartialEq, Debug)]
pub struct InputControl {
    /// Path of the input.
    pub name: String,
    /// SI unit; empty for a pure number.
    pub unit: String,
    /// Unit of its kind in which its formula is written; else its SI unit.
    pub written: String,
    /// Dimension as an SI unit, in which angles are pure numbers.
    pub dimension: String,
    /// Values (SI) at the requested times.
    pub values: Vec<f64>,
    /// Formula, as it is written.
    pub formula: String,
}

impl Checked {
    /// Returns the controls of params in the order of the text, then those of parts. Copies of parts have a control of all copies, followed by
    /// one for each. Empty if the mechanism has errors.
    #[must_use]
    pub fn param_controls(&self) -> Vec<ParamControl> {
        let (Some(tree), Some(model)) = (self.tree(), self.model()) else { return Vec::new() };
        let usual = usual_unit_of_length(&tree.items).map(|unit| unit.word.name);
        let mut knobs = Vec::new();
        for value in &self.declaration_info().values {
            let declared = tree.items.iter().find_map(|item| match &item.kind {
                ItemKind::Param { name, value: formula } if Some(name.span) == value.name => Some((name, formula)),
                _ => None,
            });
            let Some((name, formula)) = declared else { continue };
            let kind = |dimension: Dimension| ValueKind { dimension, usual: usual.filter(|_| dimension.is(LENGTH)) };
            match &value.amount {
                Amount::Number { si, dimension, unit } => {
                    let unit = unit.as_ref().map(|unit| unit.per_second(0));
                    let unit = unit.or_else(|| unit_of_named(formula, self, &knobs, *dimension));
                    knobs.push(self.knob(&name.text, formula, *si, &kind(*dimension), unit));
                }
                Amount::Point(at) => {
                    let parts = coordinates(formula);
                    for (k, axis) in ["x", "y"].into_iter().enumerate() {
                        let formula = parts.map_or(formula, |parts| &parts[k]);
                        let knob = self.knob(&format!("{}.{axis}", name.text), formula, at[k], &kind(LENGTH), None);
                        // a plain 0 has the unit of the other coordinate
                        let other = parts.and_then(|parts| number_and_unit(self.sources().text(parts[1 - k].span)));
                        let is_plain = knob.unit.is_empty();
                        let unit = other.filter(|_| is_plain).map_or(knob.unit, |(_, unit)| unit.to_owned());
                        // the origin has the usual unit of the text
                        let is_origin = unit.is_empty() && at.iter().all(|at| *at == 0.0);
                        let unit = usual.filter(|_| is_origin).map_or(unit, str::to_owned);
                        knobs.push(ParamControl { unit, is_half: parts.is_none(), ..knob });
                    }
                }
            }
        }
        let is_listed = |name: &str| knobs.iter().any(|knob| knob.name == name);
        let of_parts = model.params.iter().filter(|param| param.declared.name.contains('.'));
        let of_parts = of_parts.filter(|param| !is_listed(&param.declared.name));
        let of_parts = of_parts.map(|param| self.knob_of_part(&param.declared.name, param.value, param.dimension));
        knobs.extend(with_all_copies(of_parts.collect()));
        knobs
    }

    fn knob(&self, name: &str, formula: &Expr, si: f64, kind: &ValueKind, unit: Option<String>) -> ParamControl {
        let text = self.sources().text(formula.span);
        let place = Some(formula.span);
        let param = self.param_in_part(name);
        let si = param.map_or(si, |(value, _)| value);
        let dimension = unit_without_angles(kind.dimension);
        let name = name.to_owned();
        if let Some((number, unit)) = number_and_unit(text) {
            let value = if self.is_set(&name) { in_unit(si, unit) } else { number };
            let (unit, leads) = (unit.to_owned(), param.is_some());
            let (formula, is_half, of) = (None, false, None);
            return ParamControl {
                name,
                unit,
                dimension,
                value,
                formula,
                editable_span: place,
                is_half,
                formula_span: place,
                of,
                is_continuous: leads,
            };
        }
        let unit = unit.or_else(|| kind.usual.map(str::to_owned)).unwrap_or_else(|| si_unit(kind.dimension));
        let value = in_unit(si, &unit);
        let (formula, is_half, of) = (Some(text.to_owned()), false, None);
        ParamControl {
            name,
            unit,
            dimension,
            value,
            formula,
            editable_span: place,
            is_half,
            formula_span: place,
            of,
            is_continuous: true,
        }
    }

    /// Returns the control of a param of a part, in the unit in which its formula is written.
    fn knob_of_part(&self, name: &str, si: f64, dimension: Dimension) -> ParamControl {
        let source = self.part_source(name);
        let text = source.as_ref().map(|source| self.sources().text(source.formula.span));
        let number = text.and_then(number_and_unit);
        let unit = number.map(|(_, unit)| unit).filter(|unit| !unit.is_empty());
        let usual = || source.as_ref().and_then(|source| source.usual).filter(|_| dimension.is(LENGTH));
        let unit = unit.or_else(usual).map_or_else(|| si_unit(dimension), str::to_owned);
        let (value, dimension) = (in_unit(si, &unit), unit_without_angles(dimension));
        let formula = text.filter(|_| number.is_none()).map(str::to_owned);
        let stands = source.as_ref().map(|source| source.formula.span);
        let (is_half, is_bound) = source.map_or((false, true), |source| (source.is_half, source.is_bound));
        let (name, place, of) = (name.to_owned(), stands.filter(|_| !is_bound), None);
        ParamControl {
            name,
            unit,
            dimension,
            value,
            formula,
            editable_span: place,
            is_half,
            formula_span: stands,
            of,
            is_continuous: true,
        }
    }

    /// Returns the formula of a param of a part: the binding where the part is declared, or the formula in its own mechanism.
    fn part_source(&self, path: &str) -> Option<ParamSource<'_>> {
        let mut tree = self.tree()?;
        let mut names = path.split('.').map(|name| name.split('[').next().unwrap_or_default());
        let mut name = names.next()?;
        loop {
            match &item_named(tree, name)?.kind {
                ItemKind::Param { value, .. } => {
                    let axis = names.next().map(|axis| usize::from(axis == "y"));
                    let coordinate = axis.zip(coordinates(value)).map(|(axis, parts)| &parts[axis]);
                    let usual = usual_unit_of_length(&tree.items).map(|unit| unit.word.name);
                    let is_half = axis.is_some() && coordinate.is_none();
                    return Some(ParamSource { formula: coordinate.unwrap_or(value), is_half, is_bound: false, usual });
                }
                ItemKind::Part(part) => {
                    name = names.next()?;
                    let bound =
                        part.bindings.iter().find(|bound| bound.name.text == name && bound.coordinate.is_none());
                    if let Some(bound) = bound {
                        return Some(ParamSource {
                            formula: &bound.value,
                            is_half: false,
                            is_bound: true,
                            usual: None,
                        });
                    }
                    tree = self.mechanism(&part.mechanism)?;
                }
                _ => return None,
            }
        }
    }

    /// Returns whether a setting replaces the formula of a param, or of a coordinate of it.
    fn is_set(&self, name: &str) -> bool {
        let is_param =
            |path: &str| path == name || name.strip_prefix(path).is_some_and(|axis| [".x", ".y"].contains(&axis));
        self.check_options.settings.iter().any(|setting| is_param(&setting.path))
    }
}

/// The formula of a param of a part, or of a coordinate of it.
struct ParamSource<'t> {
    formula: &'t Expr,
    /// True if the formula gives both coordinates of a point.
    is_half: bool,
    /// True if the formula is a binding of the part, in which other names are valid.
    is_bound: bool,
    /// The unit of lengths in the surrounding text.
    usual: Option<&'static str>,
}

/// Adds a control of all copies before those of single copies.
fn with_all_copies(knobs: Vec<ParamControl>) -> Vec<ParamControl> {
    let mut all: Vec<(String, Vec<ParamControl>)> = Vec::new();
    let mut indices: FxHashMap<String, usize> = FxHashMap::default();
    for knob in knobs {
        let name = without_copy_indices(&knob.name);
        let index = *indices.entry(name.clone()).or_insert(all.len());
        if index == all.len() {
            all.push((name, Vec::new()));
        }
        all[index].1.push(knob);
    }
    let of_all = |(name, copies): (String, Vec<ParamControl>)| {
        let are_copies = copies.len() > 1;
        let first =
            copies.first().filter(|_| are_copies).map(|first| ParamControl { name: name.clone(), ..first.clone() });
        first
            .into_iter()
            .chain(copies.into_iter().map(move |copy| ParamControl { of: are_copies.then(|| name.clone()), ..copy }))
    };
    all.into_iter().flat_map(of_all).collect()
}

/// Returns the path of a param of a part without indices of copies.
fn without_copy_indices(path: &str) -> String {
    path.split('.').map(|name| name.split('[').next().unwrap_or_default()).collect::<Vec<_>>().join(".")
}

/// The kind of a value, which decides its unit.
struct ValueKind {
    dimension: Dimension,
    /// The unit in which the text writes this dimension.
    usual: Option<&'static str>,
}

/// Returns the unit of the first param of the same dimension that a formula names.
fn unit_of_named(formula: &Expr, checked: &Checked, knobs: &[ParamControl], dimension: Dimension) -> Option<String> {
    let is_number = dimension.is(Dimension::PURE) && !dimension.is_angle();
    let dimension = unit_without_angles(dimension);
    let text = checked.sources().text(formula.span);
    let mut words = text.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.')));
    let named = words.find_map(|word| {
        knobs.iter().find(|knob| knob.name == word && knob.dimension == dimension && !knob.unit.is_empty())
    });
    named.filter(|_| !is_number).map(|knob| knob.unit.clone())
}

/// Returns the unit of the first number in a formula that has a dimension.
fn unit_of_literals(formula: &Expr, dimension: Dimension) -> Option<String> {
    let fits = |unit: &&Unit| unit.dimension.is(dimension) && unit.dimension.is_angular() == dimension.is_angular();
    if let ExprKind::Literal { unit: Some((name, 1)), .. } = &formula.kind {
        return Unit::named(&name.text).filter(fits).map(|unit| unit.word.name.to_owned());
    }
    formula.children().into_iter().find_map(|part| unit_of_literals(part, dimension))
}

/// Converts a value (SI) to a unit.
fn in_unit(si: f64, unit: &str) -> f64 {
    round_to_15_digits(si / size_of_unit(unit))
}

/// Returns the SI value of one of a unit; NaN for what is no unit.
#[must_use]
pub fn size_of_unit(unit: &str) -> f64 {
    if unit.is_empty() {
        return 1.0;
    }
    let formula = Formula::parse(&written(1.0, unit), &mut Sources::default());
    formula.ok().and_then(|formula| formula.values(0.0).ok()).map_or(f64::NAN, |[value, ..]| value)
}

const LENGTH: Dimension = Dimension::LENGTH;

/// Returns the coordinates of a point that is written as a pair.
fn coordinates(formula: &Expr) -> Option<&[Expr; 2]> {
    match &formula.kind {
        ExprKind::Tuple(parts) => parts.as_slice().try_into().ok(),
        ExprKind::Paren(inner) => coordinates(inner),
        _ => None,
    }
}

impl Checked {
    /// Returns the controls of inputs, with their values at some times (s).
    #[must_use]
    pub fn input_controls(&self, compiled: &Compiled, times: &[f64]) -> Vec<InputControl> {
        let system = compiled.system();
        let formula = |span: Span| {
            let items =
                self.library().files().iter().flat_map(|file| &file.read.tree.mechanisms).flat_map(|m| &m.items);
            let mut inputs = items.filter_map(|item| match &item.kind {
                ItemKind::Input { name, value } if name.span == span => Some(value),
                _ => None,
            });
            inputs.next()
        };
        let jog = |input: &Input| {
            let formula = formula(input.span);
            let text = formula.map_or("", |formula| self.sources().text(formula.span));
            let whole = number_and_unit(text).map(|(_, unit)| unit.to_owned()).filter(|unit| !unit.is_empty());
            let written = whole.or_else(|| unit_of_literals(formula?, input.dimension));
            let si = si_unit(input.dimension);
            InputControl {
                name: input.name.clone(),
                written: written.unwrap_or_else(|| si.clone()),
                dimension: unit_without_angles(input.dimension),
                unit: if si.starts_with('/') { format!("1{si}") } else { si },
                values: times.iter().map(|&t| at_time(system, input.formulas[0], t)).collect(),
                formula: text.to_owned(),
            }
        };
        system.inputs().iter().map(jog).collect()
    }
}

/// Evaluates a formula of time at `t` (s).
pub(crate) fn at_time(system: &ConstraintSystem, formula: ExprId, t: f64) -> f64 {
    system.graph().value(formula, |symbol| match symbol {
        Symbol::Param(k) => system.params()[k as usize].value,
        Symbol::Time => t,
        Symbol::Shift(_) => 0.0,
        _ => f64::NAN,
    })
}

#[cfg(test)]
mod tests {
    use crate::{Choice, Parsed, Redundant};
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;

    #[test]
    fn copies_have_a_control_for_all_and_for_each() {
        let text = "mechanism legs {
            param speed = 60 rpm
            part leg[k in 0..2]: leg() at (k * 200 mm, 0, 0)
            part one: leg(rod = 50 mm) at (0, 200 mm, 0)
            driver motor[k in 0..2]: rotation(leg[k].axle) = speed * t
            driver other: rotation(one.axle) = speed * t
        }
        mechanism leg {
            param rod = 40 mm
            param half = 40 mm / 2
            param P = (0, 3 mm)
            ground { point O = (0, 0) }
            body bar { point O = (0, 0) point M = (half, 0) point P = P point Q = (rod, 0) }
            joint axle: revolute(ground.O, bar.O)
        }";
        let checked = Parsed::new("legs.mech", text)
            .check(&Choice { mechanism: Some("legs".to_owned()), ..Choice::default() }, &Memory::default());
        let knobs = checked.param_controls();
        let controls: Vec<_> =
            knobs.iter().map(|k| (k.name.as_str(), k.value, k.unit.as_str(), k.of.as_deref())).collect();
        let of_copies = |name: &'static str, value, copies: [&'static str; 2]| {
            let [first, second] = copies.map(|copy| (copy, value, "mm", Some(name)));
            [(name, value, "mm", None), first, second]
        };
        let copies = [
            of_copies("leg.rod", 40.0, ["leg[0].rod", "leg[1].rod"]),
            of_copies("leg.half", 20.0, ["leg[0].half", "leg[1].half"]),
            of_copies("leg.P.x", 0.0, ["leg[0].P.x", "leg[1].P.x"]),
            of_copies("leg.P.y", 3.0, ["leg[0].P.y", "leg[1].P.y"]),
        ];
        let one = [("one.half", 20.0, "mm", None), ("one.P.x", 0.0, "mm", None), ("one.P.y", 3.0, "mm", None)];
        let expected: Vec<_> =
            std::iter::once(("speed", 60.0, "rpm", None)).chain(copies.concat()).chain(one).collect();
        assert_eq!(controls, expected);
        let place = |name: &str| knobs.iter().find(|knob| knob.name == name).and_then(|knob| knob.editable_span);
        let text_of = |name: &str| place(name).map(|place| checked.sources().text(place));
        assert_eq!(text_of("leg.rod"), Some("40 mm"));
        assert_eq!(text_of("one.P.x"), Some("0"));
        assert_eq!(place("leg[1].rod"), place("leg.rod"));
        assert_eq!(
            knobs.iter().find(|knob| knob.name == "leg.half").and_then(|k| k.formula.as_deref()),
            Some("40 mm / 2")
        );
    }

    #[test]
    fn params_have_the_units_of_their_formulas() {
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
        let checked = Parsed::new("lever.mech", text).check(&Choice::default(), &Memory::default());
        let knobs = checked.param_controls();
        let controls: Vec<_> =
            knobs.iter().map(|k| (k.name.as_str(), k.value, k.unit.as_str(), k.is_continuous)).collect();
        assert_eq!(
            controls,
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
        let place = knobs[5].editable_span.expect("a place");
        assert_eq!(checked.sources().text(place), "10 mm");
    }

    #[test]
    fn inputs_have_the_units_of_their_formulas() {
        let text = "mechanism press {
            param speed = 60 rpm
            input a = 60 deg + 10 deg/s * t
            input b = 5 mm
            input c = 0.5 + speed * t
            input d = 2
            input e = 30 deg/s
            input f = 20 mm * sin(90 deg/s * t)
            ground { point O = (0, 0) axis way = (0, 0) along (1, 0) }
            body wheel { point O = (0, 0) }
            body slide { point P = (0, 0) axis way = (0, 0) along (1, 0) }
            joint axle: revolute(ground.O, wheel.O)
            joint guide: translational(ground.way, slide.way)
            driver motor: rotation(axle) = a + c + d * 1 rad + e * t
            driver piston: displacement(guide) = b + f
            analysis from 0 s to 1 s every 100 ms
        }";
        let checked = Parsed::new("press.mech", text).check(&Choice::default(), &Memory::default());
        let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
        let compiled = compiled.unwrap_or_else(|| panic!("{diagnostics:?}"));
        let jogs = checked.input_controls(&compiled, &[0.0]);
        let controls: Vec<_> =
            jogs.iter().map(|jog| (jog.name.as_str(), jog.written.as_str(), jog.dimension.as_str())).collect();
        let expected = [("a", "deg", ""), ("b", "mm", "m"), ("c", "rad", ""), ("e", "deg/s", "/s"), ("f", "mm", "m")];
        let without = |(name, ..): &&(&str, &str, &str)| *name != "d";
        assert_eq!(controls.iter().filter(without).copied().collect::<Vec<_>>(), expected);
    }
}
