//! Params that take values one after the other: what `--vary NAME=A..B:N` says, read.

use super::checked::{TOL, VARY};
use super::{Checked, Choice, Formula, Parsed};
use mechc_engine::sweep::{evenly, rounded};
use mechc_lang::check::Amount;
use mechc_lang::model::{Dimension, Units};
use mechc_syntax as syntax;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Severity, readable};
use mechc_text::source::Sources;
use mechc_text::vocabulary::Unit;
use mechc_text::world::World;

/// Of so many values one can still choose with a slider.
const MOST_VALUES: usize = 201;
/// So many params may vary at once.
const MOST_PARAMS: usize = 2;
/// So many variants are solved at the most.
const MOST_VARIANTS: usize = 1000;
/// What a value may be away from a number to be taken for it, as a part of the step from one value to the next.
const SAME: f64 = 1e-9;

/// Words that make an angle of a pure number.
const ANGLES: [&str; 3] = ["deg", "rad", "rev"];

const EXAMPLE: &str = "as in `--vary rod_length=120mm..180mm:13`";

/// What is found of something asked for; what is wrong otherwise, with the texts that the diagnostics speak of.
pub(super) type Found<T> = Result<T, (Sources, Diagnostics)>;

/// A param with the values that it takes.
#[derive(Clone, PartialEq, Debug)]
pub struct Varied {
    /// Its name.
    pub name: String,
    /// The unit of its values; `1` for a pure number.
    pub unit: String,
    /// In that unit, rising.
    pub values: Vec<f64>,
    /// What sets it to each of them, as a [`Choice`] takes it.
    pub settings: Vec<String>,
    /// Which of them is nearest to the file's own value.
    pub nearest: usize,
    /// The file's own value in that unit, where it is known and none of them.
    pub own: Option<f64>,
}

/// One `NAME=A..B:N` in its parts.
struct Asked {
    name: String,
    ends: [String; 2],
    count: usize,
}

impl Checked {
    /// What is to vary of it, be it sound or not; `choice` is what it was checked with.
    ///
    /// # Errors
    /// Something cannot vary so; with the texts that the diagnostics speak of.
    pub fn varied(&self, asked: &[String], choice: &Choice, world: &dyn World) -> Found<Vec<Varied>> {
        let own = |why: Box<Diagnostic>| (self.sources().clone(), Diagnostics::from(*why));
        let asked = read(asked).map_err(own)?;
        refuse_twice(asked.iter().map(|asked| &asked.name), choice).map_err(own)?;
        let reader = Reader { parsed: &self.parsed, own: self, choice, world, option: VARY };
        asked.iter().map(|asked| reader.varied(asked)).collect()
    }
}

fn read(asked: &[String]) -> Result<Vec<Asked>, Box<Diagnostic>> {
    if asked.len() > MOST_PARAMS {
        let said = format!("{} params are to vary, and a page has sliders for {MOST_PARAMS} at most", asked.len());
        return Err(unusable(said).help("set the others with `--set`").into());
    }
    let asked = asked.iter().map(|text| Asked::of(text)).collect::<Result<Vec<_>, _>>()?;
    let variants: usize = asked.iter().map(|asked| asked.count).product();
    if variants > MOST_VARIANTS {
        let counts: Vec<String> = asked.iter().map(|asked| asked.count.to_string()).collect();
        let said = format!("{} are {variants} variants, and a page has {MOST_VARIANTS} at most", counts.join(" × "));
        return Err(unusable(said).help("ask for fewer values").into());
    }
    Ok(asked)
}

/// Each param is told once, and none of a copy before that of all copies, which would hide it.
pub(super) fn refuse_twice<'n>(
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
        if let Some(hidden) = before.find(|one| is_of_a_copy(one, name)) {
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

/// Whether a param is that of a copy of parts, where another one is that of all copies.
fn is_of_a_copy(one: &str, all: &str) -> bool {
    let without_numbers: String = one
        .split('[')
        .enumerate()
        .map(|(k, part)| if k == 0 { part } else { part.split_once(']').map_or("", |(_, rest)| rest) })
        .collect();
    one.contains('[') && without_numbers == all
}

impl Asked {
    fn of(text: &str) -> Result<Asked, Box<Diagnostic>> {
        let parts = text.split_once('=').and_then(|(name, rest)| {
            let (interval, count) = rest.rsplit_once(':')?;
            let (first, last) = interval.split_once("..")?;
            Some((name, [first, last], count.trim()))
        });
        let Some((name, ends, count)) = parts.filter(|(name, ..)| !name.trim().is_empty()) else {
            return Err(unusable(format!("`{VARY} {text}` does not say what varies from where to where"))
                .help(format!("write `{VARY} NAME=A..B:N`, {EXAMPLE}: so many values, evenly from A to B"))
                .into());
        };
        let known = count.parse().ok().filter(|count| (2..=MOST_VALUES).contains(count));
        let Some(count) = known else {
            return Err(unusable(format!("`{count}` is no number of values for `{}`", name.trim()))
                .help(format!("a whole number from 2 to {MOST_VALUES} is wanted, {EXAMPLE}"))
                .into());
        };
        Ok(Asked { name: spaceless(name), ends: ends.map(|end| end.trim().to_owned()), count })
    }
}

/// Reads what is asked for, with the mechanism that it is asked of.
pub(super) struct Reader<'r> {
    pub parsed: &'r Parsed,
    pub own: &'r Checked,
    pub choice: &'r Choice,
    pub world: &'r dyn World,
    /// The option that says what varies.
    pub option: &'static str,
}

impl Reader<'_> {
    fn varied(&self, asked: &Asked) -> Found<Varied> {
        let Asked { name, ends: [first, last], count } = asked;
        let [(low, a, _), (high, b, _)] = [self.number(name, first)?, self.number(name, last)?];
        let (checked, si) = ([low, high], [a, b]);
        let unusable = |why: Diagnostic| (self.own.sources().clone(), why.into());
        let of_param = |checked: &Checked| checked.param_in_part(name);
        if checked.iter().any(Checked::is_sound) && checked.iter().all(|checked| of_param(checked).is_none()) {
            return Err(unusable(decides(name)));
        }
        let dimension = checked.iter().find_map(of_param).map_or(Dimension::PURE, |(_, dimension)| dimension);
        let (ends, unit) = same_unit(first, last)
            .unwrap_or_else(|| (si, si_unit(dimension, is_of_angles(first) || is_of_angles(last))));
        let values = grid(ends, *count);
        if values.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(unusable(too_near(name, first, last)));
        }
        let settings = values.iter().map(|value| format!("{name}={}", written(*value, &unit))).collect();
        let own = self.own_value(name).map(|own| ends[0] + (own - si[0]) / (si[1] - si[0]) * (ends[1] - ends[0]));
        let nearest = own.map_or(0, |own| nearest(&values, own));
        let step = (values[1] - values[0]).abs();
        let own = own.filter(|own| own.is_finite() && (own - values[nearest]).abs() > SAME * step).map(rounded);
        let unit = if unit.is_empty() || unit.starts_with('/') { format!("1{unit}") } else { unit };
        Ok(Varied { name: name.clone(), unit, values, settings, nearest, own })
    }

    /// The mechanism with a value of what varies. What is wrong with the formula itself is an error; what is wrong with the mechanism
    /// because of the value is that of a variant.
    pub fn with(&self, name: &str, formula: &str) -> Found<Checked> {
        let set = vec![format!("{name}={formula}")];
        let choice = match self.option {
            TOL => Choice { off: set, ..self.choice.clone() },
            _ => Choice { varied: set, ..self.choice.clone() },
        };
        let checked = self.parsed.check(&choice, self.world);
        let sources = checked.sources();
        let is_of_option = |said: &&Diagnostic| {
            let source = said.labels.first().map(|label| sources.get(label.span.file));
            said.severity() == Severity::Error
                && source.is_some_and(|source| source.is_option && source.name.starts_with(self.option))
        };
        let mut wrong = Diagnostics::default();
        checked.diagnostics().iter().filter(is_of_option).for_each(|said| wrong.push(said.clone()));
        if wrong.is_empty() { Ok(checked) } else { Err((sources.clone(), wrong)) }
    }

    /// The same for a number, with its value in SI, and its dimension, if it has one.
    pub fn number(&self, name: &str, formula: &str) -> Found<(Checked, f64, Option<Dimension>)> {
        let found = self.with(name, formula).and_then(|checked| {
            let (value, dimension) = self.value(formula)?;
            Ok((checked, value, dimension))
        });
        let of_a_point = || (self.own.sources().clone(), self.of_a_point(name, formula).into());
        found.map_err(|why| if self.is_point(name) { of_a_point() } else { why })
    }

    fn is_point(&self, name: &str) -> bool {
        let x = format!("{name}.x");
        self.own.settable_params().iter().any(|param| param.name == x)
    }

    /// A point varies by its coordinates.
    fn of_a_point(&self, name: &str, formula: &str) -> Diagnostic {
        let option = self.option;
        unusable(format!("`{name}` is a point, and `{option}` takes numbers: `{formula}` cannot be said of it"))
            .help(format!("say it of a coordinate: `{option} {name}.x=…`, `{option} {name}.y=…`, or both"))
    }

    /// The value of a formula in SI, and its dimension, if it has one.
    pub fn value(&self, formula: &str) -> Found<(f64, Option<Dimension>)> {
        let mut sources = self.own.sources().clone();
        let value = Formula::of(formula, &mut sources).and_then(|formula| {
            let [value, ..] = formula.values(0.0).map_err(|why| *why)?;
            Ok((value, formula.known_dimension()))
        });
        value.map_err(|said| (sources, said))
    }

    /// The file's own value in SI, as far as it is known.
    fn own_value(&self, name: &str) -> Option<f64> {
        let written = || {
            let is_it = |name_at| self.own.sources().text(name_at) == name;
            let value = self.own.known().values.iter().find(|value| value.name.is_some_and(is_it))?;
            match value.amount {
                Amount::Number { si, .. } => Some(si),
                Amount::Point(_) => None,
            }
        };
        self.own.param_in_part(name).map(|(value, _)| value).or_else(written)
    }
}

/// Two numbers of one unit, where the ends are nothing else; zero is of any unit.
fn same_unit(first: &str, last: &str) -> Option<([f64; 2], String)> {
    let [(a, first), (b, last)] = [number_and_unit(first)?, number_and_unit(last)?];
    let unit = match (first, last) {
        _ if first == last => first,
        ("", unit) if a == 0.0 => unit,
        (unit, "") if b == 0.0 => unit,
        _ => return None,
    };
    Some(([a, b], unit.to_owned()))
}

/// `40 mm`, `-1.5e3`, `90 deg/s`, `3e-4 kg*m^2`, `-(3 mm)`: what a slider can show in the unit in which it is written.
pub(super) fn number_and_unit(text: &str) -> Option<(f64, &str)> {
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

/// Units, and powers of them, with `*` and `/` between, or behind a `/`.
fn is_unit(text: &str) -> bool {
    text.strip_prefix('/').unwrap_or(text).split(['*', '/']).map(str::trim).all(|part| {
        let (word, power) = part.split_once('^').unwrap_or((part, "1"));
        Unit::named(word.trim_end()).is_some() && power.trim_start().parse::<i32>().is_ok()
    })
}

/// The SI unit of a dimension, empty for a pure number.
pub(super) fn si_unit(dimension: Dimension, is_angle: bool) -> String {
    match Units::si(dimension, is_angle).si {
        unit if unit == "1" => String::new(),
        unit => unit.strip_prefix('1').map_or(unit.clone(), str::to_owned),
    }
}

/// Whether a formula has a word that makes an angle of a pure number.
pub(super) fn is_of_angles(formula: &str) -> bool {
    formula.split(|c: char| !c.is_alphabetic()).any(|word| ANGLES.contains(&word))
}

/// A value as a formula.
pub(super) fn written(value: f64, unit: &str) -> String {
    let value = readable(value);
    if unit.is_empty() || unit.starts_with('/') { format!("{value}{unit}") } else { format!("{value} {unit}") }
}

/// So many values from end to end, evenly, rising.
fn grid(ends: [f64; 2], count: usize) -> Vec<f64> {
    let count = count as u64;
    let mut values: Vec<f64> = (0..count).map(|k| evenly(ends, k, count)).collect();
    if ends[0] > ends[1] {
        values.reverse();
    }
    values
}

fn nearest(values: &[f64], wanted: f64) -> usize {
    let away = |k: &usize| (values[*k] - wanted).abs();
    (0..values.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
}

pub(super) fn spaceless(name: &str) -> String {
    syntax::normalized(name).chars().filter(|c| !c.is_whitespace()).collect()
}

fn decides(name: &str) -> Diagnostic {
    unusable(format!("`{name}` decides what is repeated, and cannot vary on a page"))
        .help("write a page for each of its values, with `--set`")
}

fn too_near(name: &str, first: &str, last: &str) -> Diagnostic {
    unusable(format!("`{name}` does not vary from `{first}` to `{last}`")).help("two different values are wanted")
}

pub(super) fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}

#[cfg(test)]
mod tests {
    use super::{Varied, grid, number_and_unit};
    use crate::{Choice, Parsed};
    use mechc_text::world::Memory;

    const LEVER: &str = "mechanism lever {
        param length = 50 mm
        param offset = length / 4
        param speed = 60 rpm
        param count = 2
        param A = (10 mm, 0)
        ground { point O = A }
        body bar[k in 0..count] at (0, 0, k * 1 deg) { point O = (offset, 0) point P = (length, 0) }
    }";

    fn varied(asked: &[&str], set: &[&str]) -> Result<Vec<Varied>, Vec<String>> {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        let (world, choice) = (Memory::default(), Choice { set: owned(set), ..Choice::default() });
        let checked = Parsed::of("lever.mech", LEVER).check(&choice, &world);
        checked
            .varied(&owned(asked), &choice, &world)
            .map_err(|(_, said)| said.iter().map(|said| said.message.clone()).collect())
    }

    fn one(asked: &str) -> Varied {
        varied(&[asked], &[]).expect("it can vary").remove(0)
    }

    #[test]
    fn values_are_those_that_a_user_types() {
        let length = one("length = 40mm .. 60 mm:5");
        assert_eq!((length.name.as_str(), length.unit.as_str()), ("length", "mm"));
        assert_eq!(length.values, [40.0, 45.0, 50.0, 55.0, 60.0]);
        assert_eq!(length.settings[1], "length=45 mm");
        assert_eq!((length.nearest, length.own), (2, None));
        assert_eq!(grid([0.1, 0.3], 3), [0.1, 0.2, 0.3]);
        assert_eq!(grid([3.0, -1.0], 3), [-1.0, 1.0, 3.0]);
    }

    #[test]
    fn units_are_those_that_are_written_or_else_si() {
        for (asked, unit, values, setting) in [
            ("speed=0..10 rpm:2", "rpm", [0.0, 10.0], "speed=10 rpm"),
            ("length=40mm..0.06m:2", "m", [0.04, 0.06], "length=0.06 m"),
            ("length=2*20mm..60mm:2", "m", [0.04, 0.06], "length=0.06 m"),
            ("speed=1/s..180 deg/s / 30:2", "rad/s", [0.104_719_755_119_659_77, 1.0], "speed=1 rad/s"),
            ("A.x=-1e1mm..5mm:2", "mm", [-10.0, 5.0], "A.x=5 mm"),
        ] {
            let found = one(asked);
            assert_eq!((found.unit.as_str(), found.settings[1].as_str()), (unit, setting), "{asked}");
            assert!(found.values.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", found.values);
        }
    }

    #[test]
    fn the_own_value_is_met_or_told() {
        let between = one("length=40mm..60mm:4");
        assert_eq!((between.nearest, between.own), (1, Some(50.0)));
        let following = one("offset=10mm..20mm:3");
        assert_eq!((following.nearest, following.own), (0, Some(12.5)));
        assert_eq!(one("speed=1rpm..2rpm:2").nearest, 1);
    }

    #[test]
    fn what_cannot_vary_is_refused() {
        for (asked, set, wanted) in [
            (
                &["length=40mm..60mm"][..],
                &[][..],
                "`--vary length=40mm..60mm` does not say what varies from where to where",
            ),
            (&["length=40mm:3"], &[], "`--vary length=40mm:3` does not say what varies from where to where"),
            (&["length=1mm..2mm:1"], &[], "`1` is no number of values for `length`"),
            (&["length=1mm..2mm:x"], &[], "`x` is no number of values for `length`"),
            (&["length=5mm..0.5e1mm:3"], &[], "`length` does not vary from `5mm` to `0.5e1mm`"),
            (&["length=1..2mm:3"], &[], "the parameter `length` must be a length, found a pure number"),
            (&["length=1mm..2:3"], &[], "the parameter `length` must be a length, found a pure number"),
            (&["lenght=1mm..2mm:3"], &[], "mechanism `lever` has no parameter `lenght`"),
            (&["length=1mm..speed:3"], &[], "a value from outside the file cannot name `speed`"),
            (&["A=1mm..2mm:3"], &[], "`A` is a point, and `--vary` takes numbers: `1mm` cannot be said of it"),
            (
                &["A=(1mm, 0)..(2mm, 0):3"],
                &[],
                "`A` is a point, and `--vary` takes numbers: `(1mm, 0)` cannot be said of it",
            ),
            (&["count=1..4:4"], &[], "`count` decides what is repeated, and cannot vary on a page"),
            (&["length=1mm..2mm:3", "length = 1mm..3mm:3"], &[], "`length` is to vary twice"),
            (&["length=1mm..2mm:3"], &["length=3mm"], "`length` is set, and is to vary"),
            (
                &["length=1mm..2mm:40", "speed=1rpm..2rpm:40"],
                &[],
                "40 × 40 are 1600 variants, and a page has 1000 at most",
            ),
            (&["a", "b", "c"], &[], "3 params are to vary, and a page has sliders for 2 at most"),
        ] {
            let said = varied(asked, set).expect_err("it is refused");
            assert_eq!(said.first().map(String::as_str), Some(wanted), "{said:?}");
        }
    }

    #[test]
    fn numbers_are_told_from_formulas() {
        for (text, wanted) in [
            ("40mm", Some((40.0, "mm"))),
            ("-.5e1 m", Some((-5.0, "m"))),
            ("3", Some((3.0, ""))),
            ("90 deg/s", Some((90.0, "deg/s"))),
            ("2*3mm", None),
            ("1/3", None),
            ("2 mm^2", Some((2.0, "mm^2"))),
            ("3e-4 kg*m^2", Some((3e-4, "kg*m^2"))),
            ("2 N*s/m", Some((2.0, "N*s/m"))),
            ("2 N * s / m", Some((2.0, "N * s / m"))),
            ("3/s", Some((3.0, "/s"))),
            ("(3 mm)", Some((3.0, "mm"))),
            ("-( 3 mm )", Some((-3.0, "mm"))),
            ("3 mm/rod", None),
            ("3 mm*2", None),
            ("(3 mm) + (4 mm)", None),
            ("2 mm^k", None),
            ("inf", None),
            ("4 mm + 1 mm", None),
        ] {
            assert_eq!(number_and_unit(text), wanted, "{text}");
        }
    }
}
