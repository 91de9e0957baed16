//! Diagnostics of an analysis that cannot be completed.

mod assembly;
mod determinacy;
mod motion;
mod singularity;
mod spacing;

pub use assembly::*;
pub use determinacy::*;
pub use motion::*;
pub use singularity::*;
pub use spacing::*;

use crate::limits::printed::NOTHING;
use mechc_ir::{ConstraintSystem, CoordinateKind, DeclarationId};
use mechc_text::diag::{Diagnostic, readable};

/// Labels of one message at most.
const LISTED: usize = 8;

/// Formats a time as `t = 0.1 s`.
pub fn at(t: f64) -> String {
    format!("t = {} s", short(t))
}

/// Formats a number with at most ten digits.
pub fn short(value: f64) -> String {
    readable(format!("{value:.9e}").parse().unwrap_or(value))
}

/// Formats a length, such as `3.2 mm` or `1.4 m`.
///
/// A length below that of an atom is zero.
#[must_use]
pub fn length(metres: f64) -> String {
    // 0.99999 m are 1 m
    let rounded: f64 = format!("{metres:.2e}").parse().unwrap_or(metres);
    let (value, unit) = match rounded.abs() {
        m if m < NOTHING => (0.0, "m"),
        m if m >= 1e3 => (rounded / 1e3, "km"),
        m if m >= 1.0 => (rounded, "m"),
        m if m >= 1e-4 => (rounded * 1e3, "mm"),
        _ => (rounded * 1e6, "µm"),
    };
    format!("{} {unit}", three_digits(value))
}

pub fn three_digits(value: f64) -> String {
    readable(format!("{value:.2e}").parse().unwrap_or(value))
}

pub fn degrees(radians: f64) -> String {
    let rounded = if radians.abs() < NOTHING { 0.0 } else { radians };
    format!("{} deg", three_digits(rounded.to_degrees()))
}

pub fn in_units(system: &ConstraintSystem, column: usize, value: f64) -> String {
    match system.coordinates()[column].kind {
        CoordinateKind::Length => length(value),
        CoordinateKind::Angle => degrees(value),
        CoordinateKind::Argument => three_digits(value),
    }
}

pub fn named(system: &ConstraintSystem, row: usize) -> String {
    let declaration = system.declaration_of(row);
    format!("{} `{}`", declaration.kind.noun(), declaration.name)
}

/// Names declarations, such as ``joint `contact` and driver `motor` ``.
pub fn named_all(system: &ConstraintSystem, declarations: &[DeclarationId]) -> String {
    let names: Vec<String> = declarations
        .iter()
        .take(LISTED)
        .map(|&k| format!("{} `{}`", system.declarations()[k].kind.noun(), system.declarations()[k].name))
        .collect();
    names.join(" and ")
}

/// Returns whether a row is about places, or about angles alone.
pub fn gap_kind(system: &ConstraintSystem, row: usize) -> CoordinateKind {
    let mut kinds = system.phi_q().row(row).iter().map(|&(column, _)| system.coordinates()[column as usize].kind);
    if kinds.any(|kind| kind == CoordinateKind::Length) { CoordinateKind::Length } else { CoordinateKind::Angle }
}

/// Adds to a diagnostic that it happens on the way from the mechanism's own first time (s) to the requested one.
pub fn before_start(diagnostic: Diagnostic, from: f64) -> Diagnostic {
    Diagnostic { message: format!("on the way from {} s: {}", short(from), diagnostic.message), ..diagnostic }
}

/// Marks declarations; the label at the first holds for it alone or for all of them.
pub fn with_places(
    mut diagnostic: Diagnostic,
    system: &ConstraintSystem,
    declarations: &[DeclarationId],
    [of_one, of_all]: [&str; 2],
) -> Diagnostic {
    for (k, &declaration) in declarations.iter().take(LISTED).enumerate() {
        let span = system.declarations()[declaration].span;
        let text = match (k, declarations.len()) {
            (0, 1) => of_one,
            (0, _) => of_all,
            _ => "",
        };
        diagnostic = if diagnostic.labels.is_empty() { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    diagnostic
}

/// Returns the bodies of coordinates and their fate, in a sentence; the contacts and meshes if no coordinate belongs to a body.
pub fn owners(system: &ConstraintSystem, columns: &[usize], what: &str) -> String {
    let of_bodies: Vec<usize> = columns.iter().copied().filter(|&k| system.body_of(k).is_some()).collect();
    let (columns, noun) = if of_bodies.is_empty() { (columns, "contacts") } else { (of_bodies.as_slice(), "bodies") };
    let mut names: Vec<String> = columns.iter().map(|&column| format!("`{}`", system.owner_name(column))).collect();
    names.dedup();
    names.truncate(LISTED);
    format!("the {noun} that {what}: {}", names.join(", "))
}

pub fn names<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    names.cloned().collect()
}

/// Joins names for a sentence; cuts a long list.
pub fn cut_list(names: &[String]) -> String {
    let left_out = names.len().saturating_sub(LISTED);
    let shown = names[..names.len() - left_out].join(", ");
    if left_out > 0 { format!("{shown} and {left_out} more") } else { shown }
}
