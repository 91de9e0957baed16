//! Diagnostics for a mechanism that is not determined.

use super::Subsystem;
use super::count::table;
use crate::{
    ConstraintSystem, CoordinateKind, Declaration, DeclarationId, DeclarationKind, JointSpec, Owner,
    PartWithDerivatives, PointId,
};
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::vocabulary::JointMotion;
use rustc_hash::FxHashMap;

/// Number of names that one message lists at most.
const LISTED: usize = 8;

/// Number of drivers that one message suggests at most.
const MOST_DRIVERS: usize = 3;

pub fn count(system: &ConstraintSystem, too_many: &Subsystem, too_few: &Subsystem) -> Diagnostic {
    let ndof = system.ndof();
    let message = match ndof {
        1 => "1 degree of freedom is left".to_owned(),
        -1 => "there is 1 equation too many".to_owned(),
        n if n > 0 => format!("{n} degrees of freedom are left"),
        n => format!("there are {} equations too many", -n),
    };
    let label = format!("{} coordinates, {} equations", system.coordinates().len(), system.rows().len());
    let diagnostic = Diagnostic::new(Code::E0502, format!("{message} in mechanism `{}`", system.name()))
        .at(system.span(), label)
        .note(table(system));
    let diagnostic = with_data(diagnostic, system, &competing(system, too_many), &too_few.columns);
    if ndof > 0 {
        let free = free_quantities(system, &too_few.columns);
        diagnostic.help(drivers_to_add(system, &too_few.columns, &free, ndof)).drives(free)
    } else {
        match duplicate_joint(system) {
            Some([first, second]) => {
                let (first, second) = (&system.declarations()[first], &system.declarations()[second]);
                diagnostic.also(first.span, "joins the same points").also(second.span, "said twice").help(format!(
                    "take the {} `{}` away",
                    second.kind.noun(),
                    second.name
                ))
            }
            None => diagnostic.help(what_to_take_away(system)),
        }
    }
}

/// Returns two joints of one kind that join the same points.
fn duplicate_joint(system: &ConstraintSystem) -> Option<[DeclarationId; 2]> {
    let mut joint_at: FxHashMap<(&str, Vec<PointId>), DeclarationId> = FxHashMap::default();
    for (k, declaration) in system.declarations().pairs().filter(|(_, one)| one.points.len() == 2) {
        let DeclarationKind::Joint(joint) = declaration.kind else { continue };
        let mut points = declaration.points.clone();
        points.sort_unstable();
        if let Some(first) = joint_at.insert((joint.name(), points), k) {
            return Some([first, k]);
        }
    }
    None
}

/// Returns quantities that joints leave free and no equation fixes, such as `rotation(main)`.
fn free_quantities(system: &ConstraintSystem, free: &[u32]) -> Vec<String> {
    let mut quantities: Vec<String> = Vec::new();
    let mut first_row = 0;
    for declaration in system.declarations() {
        let rows = first_row..first_row + declaration.rows;
        first_row = rows.end;
        let DeclarationKind::Joint(JointSpec { motion: Some(motion), .. }) = declaration.kind else { continue };
        let freedom = match motion {
            JointMotion::Rotation => CoordinateKind::Angle,
            JointMotion::Displacement => CoordinateKind::Length,
        };
        // a pin at the origin of a body leaves the angle out of its equations, although the body turns
        let owners = rows
            .flat_map(|row| system.phi_q().row(row))
            .map(|(column, _)| system.coordinates()[*column as usize].owner);
        let mut owners: Vec<Owner> = owners.collect();
        owners.dedup();
        let moves = free.iter().any(|&column| {
            let coordinate = &system.coordinates()[column as usize];
            coordinate.kind == freedom && owners.contains(&coordinate.owner)
        });
        if moves {
            quantities.push(format!("{}({})", motion.quantity(), declaration.name));
        }
    }
    quantities.truncate(MOST_DRIVERS);
    quantities
}

/// Suggests drivers for the free quantities, or for bodies if there are none.
fn drivers_to_add(system: &ConstraintSystem, free: &[u32], quantities: &[String], ndof: isize) -> String {
    let count = if ndof == 1 { "a driver".to_owned() } else { format!("{ndof} drivers or joints") };
    if quantities.is_empty() {
        let bodies = free.iter().filter_map(|&column| system.body_of(column as usize));
        let mut names: Vec<&str> = bodies.map(|body| system.bodies()[body].name.as_str()).collect();
        names.dedup();
        names.truncate(MOST_DRIVERS);
        return match names.as_slice() {
            [] => format!("add {count}"),
            _ => format!(
                "add {count} for {}",
                names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
            ),
        };
    }
    let drivers: Vec<String> = quantities.iter().map(|driven| format!("`driver NAME: {driven} = …`")).collect();
    format!("add {count}: {}", drivers.join(" or "))
}

fn what_to_take_away(system: &ConstraintSystem) -> String {
    let drivers: Vec<String> = system
        .declarations()
        .iter()
        .filter(|declaration| declaration.kind == DeclarationKind::Driver)
        .map(|declaration| format!("`{}`", declaration.name))
        .collect();
    match drivers.len() {
        0 => "take a joint or constraint away, or use one that leaves more freedom".to_owned(),
        1..=LISTED => {
            format!("take a joint away, or a driver ({}), or use joints that leave more freedom", drivers.join(", "))
        }
        _ => "take a joint or driver away, or use joints that leave more freedom".to_owned(),
    }
}

pub fn structure(system: &ConstraintSystem, too_many: &Subsystem, too_few: &Subsystem) -> Diagnostic {
    let columns = &too_few.columns;
    let competing = competing(system, too_many);
    let mut free: Vec<_> = columns.iter().map(|&column| system.owner_span(column as usize)).collect();
    free.dedup();
    let mut diagnostic =
        Diagnostic::new(Code::E0503, "one part of the mechanism has too many equations, another one too few");
    for (k, declaration) in competing.iter().take(LISTED).enumerate() {
        let text = "one of too many equations for the same bodies";
        diagnostic = if k == 0 { diagnostic.at(declaration.span, text) } else { diagnostic.also(declaration.span, "") };
    }
    for &span in free.iter().take(LISTED) {
        diagnostic = diagnostic.also(span, "not fixed by enough equations");
    }
    let shown: Vec<String> = columns
        .iter()
        .take(LISTED)
        .map(|&column| format!("`{}`", system.coordinates()[column as usize].name))
        .collect();
    let diagnostic = diagnostic
        .note(format!("nothing fixes {}", shown.join(", ")))
        .help("move one of the equations to the part that lacks one");
    with_data(diagnostic, system, &competing, columns)
}

/// Returns the declarations whose equations include one too many.
fn competing<'s>(system: &'s ConstraintSystem, too_many: &Subsystem) -> Vec<&'s Declaration> {
    let mut declarations: Vec<DeclarationId> =
        too_many.rows.iter().map(|&row| system.rows()[row as usize].declaration).collect();
    declarations.dedup();
    declarations.into_iter().map(|k| &system.declarations()[k]).collect()
}

fn with_data(
    diagnostic: Diagnostic,
    system: &ConstraintSystem,
    competing: &[&Declaration],
    free: &[u32],
) -> Diagnostic {
    let redundant: Vec<String> = competing.iter().map(|declaration| declaration.name.clone()).collect();
    let free: Vec<String> = free.iter().map(|&column| system.coordinates()[column as usize].name.clone()).collect();
    diagnostic
        .datum("coordinates", system.coordinates().len())
        .datum("equations", system.rows().len())
        .datum("ndof", system.ndof())
        .redundant(redundant)
        .datum("free", free)
}

/// Reports a part whose text differentiates although its own equations do not determine it.
pub fn not_determined_alone(part: &PartWithDerivatives) -> Diagnostic {
    let message = format!("part `{}` is not determined alone, so its text cannot differentiate by names", part.name);
    let mut diagnostic = Diagnostic::new(Code::E0508, message);
    for (k, span) in part.places.iter().take(LISTED).enumerate() {
        let text = "by the equations of this mechanism alone";
        diagnostic = if k == 0 { diagnostic.at(*span, text) } else { diagnostic.also(*span, "and here") };
    }
    for (name, span) in &part.used_at {
        diagnostic = diagnostic.in_part(name, *span);
    }
    let help = match &part.from_outside {
        Some(text) => format!("differentiate in the outermost mechanism, by all equations: `{text}`"),
        None => format!(
            "differentiate in the outermost mechanism, by an input or param that is not bound: `der({}.…, NAME)`",
            part.name
        ),
    };
    diagnostic.note("it moves together with its surroundings").help(help)
}
