//! What is known of a declaration beyond its text: where it is at the start, what it comes to there, its equations. Only what is there
//! already, or is quickly had.

use super::numbers::{degrees, in_unit, short, si_unit, with_unit};
use super::snapshot::{MotionOutcome, Proof, Snapshot};
use mechc_lang::check::{Amount, DeclaredName, NameKind};
use mechc_pipeline::{Assembly, Checked, Compiled};
use mechc_syntax::ast::{ExprKind, ItemKind};
use mechc_text::vocabulary::{Dimension, Unit};
use std::path::Path;
use std::sync::Arc;

/// With more names than this a mechanism is proven in the background alone; of a smaller one that is quick enough to wait for.
const QUICK: usize = 300;

/// A declaration of a mechanism.
pub(super) struct Subject<'a> {
    /// What it declares.
    pub kind: NameKind,
    /// How the whole mechanism names it, with its parts and the numbers of copies as far as they are written: `front.crank.A`.
    pub path: &'a str,
    pub checked: &'a Checked,
}

/// What is known of a declaration, in paragraphs of Markdown.
pub(super) fn facts(snapshot: &Snapshot, path: &Path, subject: &Subject<'_>) -> Vec<String> {
    let proven = proven_of(snapshot, path, subject.checked);
    let start = proven.as_ref().and_then(Start::of);
    let found: Vec<Option<String>> = match subject.kind {
        NameKind::Body => vec![start.as_ref().and_then(|start| start.pose(subject.path))],
        NameKind::Point => vec![start.as_ref().and_then(|start| start.position(subject.path))],
        NameKind::Joint | NameKind::Constraint | NameKind::Driver => {
            vec![equations(subject, start.as_ref()), start.as_ref().and_then(|start| start.places_of(subject.path))]
        }
        NameKind::Param => vec![value_of_param(subject)],
        NameKind::Measure | NameKind::Input => vec![start.as_ref().and_then(|start| start.value(subject.path))],
        NameKind::Trace => ["x", "y"]
            .into_iter()
            .map(|axis| start.as_ref().and_then(|start| start.value(&format!("{}.{axis}", subject.path))))
            .collect(),
        NameKind::Result => vec![result(snapshot, path, subject)],
        NameKind::Function => vec![slopes(subject)],
        NameKind::Mechanism => vec![start.as_ref().map(|start| format!("```text\n{}\n```", start.compiled.counts()))],
        _ => Vec::new(),
    };
    found.into_iter().flatten().collect()
}

/// What is proven of a mechanism, if that is known, or quickly had.
fn proven_of(snapshot: &Snapshot, path: &Path, checked: &Checked) -> Option<(Arc<Vec<Proof>>, usize)> {
    let file = snapshot.checked(path)?;
    let number = file.mechanisms.iter().position(|other| other.span() == checked.span())?;
    let names: usize = file.mechanisms.iter().map(|other| other.symbols().iter().count()).sum();
    let is_quick = names <= QUICK;
    // what is said of a part is said where it is used, but it has a position of its own too
    let proven = match checked.is_part_of_another() {
        true if is_quick => snapshot.proven_alone(path),
        true => None,
        false => snapshot.proven_now(path).or_else(|| if is_quick { snapshot.proven(path) } else { None }),
    };
    Some((proven?, number))
}

/// A mechanism in the position in which it was assembled.
struct Start<'a> {
    proven: &'a Proof,
    compiled: &'a Compiled,
    assembly: &'a Assembly,
}

impl Start<'_> {
    fn of((all, number): &(Arc<Vec<Proof>>, usize)) -> Option<Start<'_>> {
        let proven = all.get(*number)?;
        let (compiled, assembly) = (proven.compiled.as_ref()?, proven.assembly.as_ref()?);
        Some(Start { proven, compiled, assembly })
    }

    /// `At t = 0 s`, and of which copy.
    fn when(&self, subject: &str, copy: &str) -> String {
        let copy = if subject == copy { String::new() } else { format!(", `{copy}`") };
        format!("At t = {} s{copy}:", short(self.assembly.t))
    }

    fn pose(&self, body: &str) -> Option<String> {
        let copy = self.compiled.first_copy(body)?;
        let coordinate = |end: &str| {
            let name = format!("{copy}.{end}");
            self.assembly.coordinates.iter().find(|(known, ..)| *known == name).map(|(_, value, _)| *value)
        };
        let [x, y, phi] = [coordinate("x")?, coordinate("y")?, coordinate("phi")?];
        let (x, y) = (with_unit(x, "m"), with_unit(y, "m"));
        let phi = format!("{} = {}", with_unit(phi, "rad"), degrees(phi));
        Some(format!("{} x = {x}, y = {y}, phi = {phi}", self.when(body, &copy)))
    }

    fn position(&self, point: &str) -> Option<String> {
        let (owner, name) = point.rsplit_once('.')?;
        let copy = if owner.ends_with("ground") { owner.to_owned() } else { self.compiled.first_copy(owner)? };
        let copy = format!("{copy}.{name}");
        let [x, y] = self.compiled.place_of(&copy, self.assembly)?;
        Some(format!(
            "{} x = {}, y = {} in the ground's frame",
            self.when(point, &copy),
            with_unit(x, "m"),
            with_unit(y, "m")
        ))
    }

    /// Where the points of a joint are.
    fn places_of(&self, joint: &str) -> Option<String> {
        let copy = self.compiled.first_copy(joint)?;
        let position = |point: String| {
            let [x, y] = self.compiled.place_of(&point, self.assembly)?;
            Some(format!("`{point}` = ({}, {}) m", short(x), short(y)))
        };
        let places: Vec<String> = self.compiled.points_of(&copy).into_iter().filter_map(position).collect();
        (!places.is_empty()).then(|| format!("{} {}", self.when(joint, &copy), places.join(", ")))
    }

    /// Of a measure or input.
    fn value(&self, name: &str) -> Option<String> {
        if let Some((value, unit)) = self.compiled.input_at(name, self.assembly.t) {
            return Some(self.valued(name, name, value, &unit));
        }
        let trace = name
            .rsplit_once('.')
            .and_then(|(trace, axis)| Some(format!("{}.{axis}", self.compiled.first_copy(trace)?)));
        let copy = self.compiled.first_copy(name).or(trace)?;
        let column = self.compiled.columns().iter().position(|column| *column == copy)?;
        let row = self.proven.first_row()?;
        let unit = self.compiled.units().into_iter().nth(column)?;
        Some(self.valued(name, &copy, unit.printed(*row.get(column)?), &unit.text))
    }

    fn valued(&self, name: &str, copy: &str, value: f64, unit: &str) -> String {
        let value = if value.is_finite() { with_unit(value, unit) } else { "no value".to_owned() };
        let dimension = dimension_of(unit).map_or(String::new(), |dimension| format!(", {}", dimension.in_words()));
        let axis = name.rsplit_once('.').map_or("", |(_, axis)| axis);
        let axis = if ["x", "y"].contains(&axis) { format!("{axis} = ") } else { String::new() };
        format!("{} {axis}{value}{dimension}", self.when(name, copy))
    }
}

/// The equations of a declaration, where they are there or quickly had.
fn equations(subject: &Subject<'_>, start: Option<&Start<'_>>) -> Option<String> {
    let is_small = subject.checked.symbols().iter().count() <= QUICK;
    let text = match start {
        Some(start) => start.compiled.equations_of(&start.compiled.first_copy(subject.path)?),
        None if is_small => subject.checked.equations_of(subject.path),
        None => None,
    };
    Some(format!("```text\n{}\n```", text?))
}

fn value_of_param(subject: &Subject<'_>) -> Option<String> {
    let symbols = subject.checked.symbols();
    let own = symbols.iter().find(|(_, name)| name.kind == NameKind::Param && name.name == subject.path);
    let Some((_, DeclaredName { span: name, .. })) = own else { return value_in_part(subject) };
    let value = subject.checked.known().values.iter().find(|value| value.name == Some(*name))?;
    Some(match &value.amount {
        Amount::Point([x, y]) => format!("= ({}, {}) m, a point", short(*x), short(*y)),
        Amount::Number { si, dimension, is_angle, unit } => {
            let mut forms = vec![with_unit(*si, &si_unit(*dimension, *is_angle))];
            forms.extend(unit.as_ref().and_then(|unit| in_unit(*si, unit)));
            let what =
                if *is_angle && dimension.is(Dimension::PURE) { "an angle".to_owned() } else { dimension.in_words() };
            format!("= {}, {what}", forms.join(" = "))
        }
    })
}

/// Of a param of a part, with what is bound of it there.
fn value_in_part(subject: &Subject<'_>) -> Option<String> {
    if let Some(bound) = bound_in_part(subject) {
        return Some(bound);
    }
    let (value, dimension) = subject.checked.param_in_part(subject.path)?;
    Some(format!("= {}, {}", with_unit(value, &si_unit(dimension, false)), dimension.in_words()))
}

/// What is bound of a param of a part: a number as such, a formula as it is written.
fn bound_in_part(subject: &Subject<'_>) -> Option<String> {
    let (part, name) = subject.path.rsplit_once('.')?;
    let part = part.split('[').next()?;
    let bindings = subject.checked.tree()?.items.iter().find_map(|item| match &item.kind {
        ItemKind::Part(known) if known.name.text == part => Some(&known.bindings),
        _ => None,
    })?;
    let bound = bindings.iter().find(|binding| binding.name.text == name && binding.coordinate.is_none())?;
    let text = subject.checked.sources().text(bound.value.span);
    let number = match &bound.value.bare().kind {
        ExprKind::Literal { value, unit: Some((unit, power)) } => Unit::named(&unit.text).map(|unit| {
            let dimension = unit.dimension.to_the(f64::from(*power));
            let si = with_unit(unit.to_si(*value, *power), &si_unit(dimension, unit.is_of_angle()));
            format!("= {si}, {}", dimension.in_words())
        }),
        _ => None,
    };
    Some(number.unwrap_or_else(|| format!("= `{text}`, bound where `{part}` is used")))
}

fn result(snapshot: &Snapshot, path: &Path, subject: &Subject<'_>) -> Option<String> {
    let (moved, is_of_before) = snapshot.moved_last(path);
    let moved = moved?;
    let of = |moved: &MotionOutcome| moved.results.iter().position(|(name, ..)| name == subject.path);
    let (moved, number) = moved.iter().find_map(|moved| Some((moved, of(moved)?)))?;
    let (is_of_before, (_, value, unit)) = (is_of_before || moved.is_cut_short, &moved.results[number]);
    let value = value.map_or_else(|| "no value".to_owned(), |value| with_unit(value, unit));
    let dimension = dimension_of(unit).map_or(String::new(), |dimension| format!(", {}", dimension.in_words()));
    Some(format!("= {value}{dimension}{}", if is_of_before { " (before the last edits)" } else { "" }))
}

fn slopes(subject: &Subject<'_>) -> Option<String> {
    let [first, second] = subject.checked.slopes_of(subject.path)?;
    let name = subject.path;
    Some(format!("With its derivatives:\n\n```text\n{name}' = {first}\n{name}'' = {second}\n```"))
}

/// The dimension of a unit as tables have it: `mm/s^2`, `m/(s*…)`.
fn dimension_of(unit: &str) -> Option<Dimension> {
    let (mut dimension, mut divides, mut rest) = (Dimension::PURE, false, unit);
    while !rest.is_empty() {
        let end = rest.find(['*', '/', '(', ')']).unwrap_or(rest.len());
        let (factor, behind) = rest.split_at(end);
        if !factor.is_empty() && factor != "1" {
            let (name, power) = factor.split_once('^').unwrap_or((factor, "1"));
            let of_unit = Unit::named(name)?.dimension.to_the(power.parse().ok()?);
            dimension = if divides { dimension.over(of_unit) } else { dimension.times(of_unit) };
        }
        let is_in_brackets = divides && behind.starts_with('*') && unit.contains('(');
        divides = behind.starts_with('/') || behind.starts_with('(') && divides || is_in_brackets;
        rest = behind.get(1..).unwrap_or_default();
    }
    Some(dimension)
}

#[cfg(test)]
mod tests {
    use super::{Dimension, dimension_of};

    #[test]
    fn units_of_tables_have_dimensions() {
        let words = |unit: &str| dimension_of(unit).map(Dimension::in_words);
        assert_eq!(words("mm/s").as_deref(), Some("a speed (m/s)"));
        assert_eq!(words("m/s^2").as_deref(), Some("an acceleration (m/s^2)"));
        assert_eq!(words("1/s").as_deref(), Some("a rate (1/s)"));
        assert_eq!(words("1/(m*s)").as_deref(), Some("a quantity in 1/(m*s)"));
        assert_eq!(words("deg").as_deref(), Some("a pure number"));
        assert_eq!(words("nothing"), None);
    }
}
