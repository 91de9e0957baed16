//! Computed information on a declaration: its position and value at the start, its equations. Only results that are cached or quick to
//! compute are used.

use super::numbers::{degrees, in_unit, short, with_unit};
use super::snapshot::{MotionOutcome, Proof, ResultValue, Snapshot};
use mechc_lang::check::{Amount, DeclaredName, NameKind};
use mechc_pipeline::{Assembly, Checked, Compiled};
use mechc_syntax::ast::{ExprKind, ItemKind};
use mechc_text::vocabulary::{Dimension, Unit};
use std::path::Path;
use std::sync::Arc;

/// The maximum number of names for which a hover waits for a proof; larger mechanisms are proven in the background only.
const MAX_NAMES_TO_WAIT_FOR: usize = 300;

/// A declaration to describe.
pub(super) struct Subject<'a> {
    /// The kind of the declaration.
    pub kind: NameKind,
    /// Its path in the whole mechanism, with indices as far as they are written: `front.crank.A`.
    pub path: &'a str,
    pub checked: &'a Checked,
}

/// Describes a declaration in paragraphs of Markdown.
pub(super) fn declaration_info(snapshot: &Snapshot, path: &Path, subject: &Subject<'_>) -> Vec<String> {
    let proofs = proofs_of(snapshot, path, subject.checked);
    let start = proofs.as_ref().and_then(Start::new);
    let found: Vec<Option<String>> = match subject.kind {
        NameKind::Body => vec![start.as_ref().and_then(|start| start.pose(subject.path))],
        NameKind::Point => vec![start.as_ref().and_then(|start| start.position(subject.path))],
        NameKind::Joint | NameKind::Constraint | NameKind::Driver => {
            vec![equations(subject, start.as_ref()), start.as_ref().and_then(|start| start.positions_of(subject.path))]
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

/// Returns the proofs of a file with the index of a mechanism, if they are cached or quick to compute.
fn proofs_of(snapshot: &Snapshot, path: &Path, checked: &Checked) -> Option<(Arc<Vec<Proof>>, usize)> {
    let file = snapshot.checked(path)?;
    let number = file.mechanisms.iter().position(|other| other.span() == checked.span())?;
    let names: usize = file.mechanisms.iter().map(|other| other.symbols().iter().count()).sum();
    let is_quick = names <= MAX_NAMES_TO_WAIT_FOR;
    // diagnostics of a part belong to its use, but its mechanism has a position by itself too
    let proofs = match checked.is_part_of_another() {
        true if is_quick => snapshot.standalone_proofs(path),
        true => None,
        false => snapshot.cached_proofs(path).or_else(|| if is_quick { snapshot.proofs(path) } else { None }),
    };
    Some((proofs?, number))
}

/// A mechanism in its assembled position.
struct Start<'a> {
    proof: &'a Proof,
    compiled: &'a Compiled,
    assembly: &'a Assembly,
}

impl Start<'_> {
    fn new((proofs, number): &(Arc<Vec<Proof>>, usize)) -> Option<Start<'_>> {
        let proof = proofs.get(*number)?;
        let (compiled, assembly) = (proof.compiled.as_ref()?, proof.assembly.as_ref()?);
        Some(Start { proof, compiled, assembly })
    }

    /// Formats the time, and the copy if it is not the subject itself: `At t = 0 s:`.
    fn when(&self, subject: &str, copy: &str) -> String {
        let copy = if subject == copy { String::new() } else { format!(", `{copy}`") };
        format!("At t = {} s{copy}:", short(self.assembly.t))
    }

    fn pose(&self, body: &str) -> Option<String> {
        let copy = self.compiled.first_copy(body)?;
        let coordinate = |end: &str| {
            let name = format!("{copy}.{end}");
            self.assembly.coordinates.iter().find(|(coordinate, ..)| *coordinate == name).map(|(_, value, _)| *value)
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

    /// Formats the positions of a joint's points.
    fn positions_of(&self, joint: &str) -> Option<String> {
        let copy = self.compiled.first_copy(joint)?;
        let position = |point: String| {
            let [x, y] = self.compiled.place_of(&point, self.assembly)?;
            Some(format!("`{point}` = ({}, {}) m", short(x), short(y)))
        };
        let positions: Vec<String> = self.compiled.points_of(&copy).into_iter().filter_map(position).collect();
        (!positions.is_empty()).then(|| format!("{} {}", self.when(joint, &copy), positions.join(", ")))
    }

    /// Formats the value of a measure, input or coordinate of a trace.
    fn value(&self, name: &str) -> Option<String> {
        if let Some((value, unit)) = self.compiled.input_at(name, self.assembly.t) {
            return Some(self.format_value(name, name, value, &unit));
        }
        let trace = name
            .rsplit_once('.')
            .and_then(|(trace, axis)| Some(format!("{}.{axis}", self.compiled.first_copy(trace)?)));
        let copy = self.compiled.first_copy(name).or(trace)?;
        let column = self.compiled.columns().iter().position(|column| *column == copy)?;
        let row = self.proof.first_row()?;
        let unit = self.compiled.units().into_iter().nth(column)?;
        Some(self.format_value(name, &copy, unit.printed(*row.get(column)?), &unit.text))
    }

    fn format_value(&self, name: &str, copy: &str, value: f64, unit: &str) -> String {
        let value = if value.is_finite() { with_unit(value, unit) } else { "no value".to_owned() };
        let dimension = dimension_of(unit).map_or(String::new(), |dimension| format!(", {}", dimension.in_words()));
        let axis = name.rsplit_once('.').map_or("", |(_, axis)| axis);
        let axis = if ["x", "y"].contains(&axis) { format!("{axis} = ") } else { String::new() };
        format!("{} {axis}{value}{dimension}", self.when(name, copy))
    }
}

/// Formats the equations of a declaration, if they are cached or quick to compute.
fn equations(subject: &Subject<'_>, start: Option<&Start<'_>>) -> Option<String> {
    let is_small = subject.checked.symbols().iter().count() <= MAX_NAMES_TO_WAIT_FOR;
    let text = match start {
        Some(start) => start.compiled.equations_of(&start.compiled.first_copy(subject.path)?),
        None if is_small => subject.checked.equations_of(subject.path),
        None => None,
    };
    Some(format!("```text\n{}\n```", text?))
}

fn value_of_param(subject: &Subject<'_>) -> Option<String> {
    let symbols = subject.checked.symbols();
    let param = symbols.iter().find(|(_, name)| name.kind == NameKind::Param && name.name == subject.path);
    let Some((_, DeclaredName { span: name, .. })) = param else { return value_in_part(subject) };
    let value = subject.checked.declaration_info().values.iter().find(|value| value.name == Some(*name))?;
    Some(match &value.amount {
        Amount::Point([x, y]) => format!("= ({}, {}) m, a point", short(*x), short(*y)),
        Amount::Number { si, dimension, unit } => {
            let mut forms = vec![with_unit(*si, &dimension.display_unit())];
            forms.extend(unit.as_ref().and_then(|unit| in_unit(*si, unit)));
            format!("= {}, {}", forms.join(" = "), dimension.in_words())
        }
    })
}

/// Formats the value of a param of a part: the bound one, if there is one.
fn value_in_part(subject: &Subject<'_>) -> Option<String> {
    if let Some(bound) = bound_in_part(subject) {
        return Some(bound);
    }
    let (value, dimension) = subject.checked.param_in_part(subject.path)?;
    Some(format!("= {}, {}", with_unit(value, &dimension.display_unit()), dimension.in_words()))
}

/// Formats the binding of a param of a part: the value of a number, or the formula as it is written.
fn bound_in_part(subject: &Subject<'_>) -> Option<String> {
    let (part, name) = subject.path.rsplit_once('.')?;
    let part = part.split('[').next()?;
    let bindings = subject.checked.tree()?.items.iter().find_map(|item| match &item.kind {
        ItemKind::Part(item) if item.name.text == part => Some(&item.bindings),
        _ => None,
    })?;
    let bound = bindings.iter().find(|binding| binding.name.text == name && binding.coordinate.is_none())?;
    let text = subject.checked.sources().text(bound.value.span);
    let number = match &bound.value.bare().kind {
        ExprKind::Literal { value, unit: Some((unit, power)) } => Unit::named(&unit.text).map(|unit| {
            let dimension = unit.dimension.to_the(f64::from(*power));
            let si = with_unit(unit.to_si(*value, *power), &dimension.display_unit());
            format!("= {si}, {}", dimension.in_words())
        }),
        _ => None,
    };
    Some(number.unwrap_or_else(|| format!("= `{text}`, bound where `{part}` is used")))
}

fn result(snapshot: &Snapshot, path: &Path, subject: &Subject<'_>) -> Option<String> {
    let (motions, is_outdated) = snapshot.last_motions(path);
    let motions = motions?;
    let find = |motion: &MotionOutcome| motion.results.iter().position(|result| result.name == subject.path);
    let (motion, number) = motions.iter().find_map(|motion| Some((motion, find(motion)?)))?;
    let (is_outdated, ResultValue { value, unit, .. }) = (is_outdated || motion.is_cut_short, &motion.results[number]);
    let value = value.map_or_else(|| "no value".to_owned(), |value| with_unit(value, unit));
    let dimension = dimension_of(unit).map_or(String::new(), |dimension| format!(", {}", dimension.in_words()));
    Some(format!("= {value}{dimension}{}", if is_outdated { " (before the last edits)" } else { "" }))
}

fn slopes(subject: &Subject<'_>) -> Option<String> {
    let [first, second] = subject.checked.slopes_of(subject.path)?;
    let name = subject.path;
    Some(format!("With its derivatives:\n\n```text\n{name}' = {first}\n{name}'' = {second}\n```"))
}

/// Parses the dimension of a unit in the form of tables: `mm/s^2`, `m/(s*…)`.
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
        assert_eq!(words("deg").as_deref(), Some("an angle"));
        assert_eq!(words("nothing"), None);
    }
}
