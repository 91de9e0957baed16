//! What is said of a mechanism that is not determined.

use super::count::table;
use super::matching::Matching;
use crate::diag::{Code, Diagnostic};
use crate::ir::{ConstraintSystem, Declaration, DeclarationKind};

/// Names that one message lists before it stops.
const LISTED: usize = 8;

pub fn count(system: &ConstraintSystem) -> Diagnostic {
    let ndof = system.ndof();
    let message = match ndof {
        1 => "1 degree of freedom is left".to_owned(),
        -1 => "there is 1 equation too many".to_owned(),
        n if n > 0 => format!("{n} degrees of freedom are left"),
        n => format!("there are {} equations too many", -n),
    };
    let label = format!("{} coordinates, {} equations", system.coordinates.len(), system.rows.len());
    let diagnostic = Diagnostic::new(Code::E0502, format!("{message} in mechanism `{}`", system.name))
        .at(system.span, label)
        .note(table(system))
        .datum("coordinates", system.coordinates.len())
        .datum("equations", system.rows.len())
        .datum("ndof", ndof);
    if ndof > 0 { diagnostic.help(drivers_to_add(system, ndof)) } else { diagnostic.help(what_to_take_away(system)) }
}

fn drivers_to_add(system: &ConstraintSystem, ndof: isize) -> String {
    let count = if ndof == 1 { "a driver".to_owned() } else { format!("{ndof} drivers or joints") };
    let joint = system.declarations.iter().find_map(|declaration| match declaration.kind {
        DeclarationKind::Joint("revolute") => Some(format!("rotation({})", declaration.name)),
        DeclarationKind::Joint("translational") => Some(format!("displacement({})", declaration.name)),
        _ => None,
    });
    match joint {
        Some(quantity) => format!("add {count}: `driver NAME: {quantity} = …`"),
        None => format!("add {count}"),
    }
}

fn what_to_take_away(system: &ConstraintSystem) -> String {
    let drivers: Vec<String> = system
        .declarations
        .iter()
        .filter(|declaration| declaration.kind == DeclarationKind::Driver)
        .map(|declaration| format!("`{}`", declaration.name))
        .collect();
    match drivers.len() {
        0 => "take a joint or constraint away, or use one that leaves more freedom".to_owned(),
        1..=LISTED => format!("take a driver away ({}), or use joints that leave more freedom", drivers.join(", ")),
        _ => "take a driver away, or use joints that leave more freedom".to_owned(),
    }
}

pub fn structure(system: &ConstraintSystem, matching: &Matching) -> Diagnostic {
    let rows = matching.overdetermined_rows(&system.phi_q);
    let columns = matching.free_columns(&system.phi_q);
    let mut competing: Vec<&Declaration> = Vec::new();
    for &row in &rows {
        let declaration = system.declaration_of(row as usize);
        if !competing.iter().any(|known| known.span == declaration.span) {
            competing.push(declaration);
        }
    }
    let mut free: Vec<usize> = columns.iter().map(|&column| system.coordinates[column as usize].body).collect();
    free.dedup();
    let mut diagnostic =
        Diagnostic::new(Code::E0503, "one part of the mechanism has too many equations, another one too few");
    for (k, declaration) in competing.iter().take(LISTED).enumerate() {
        let text = "one of too many equations for the same bodies";
        diagnostic = if k == 0 { diagnostic.at(declaration.span, text) } else { diagnostic.also(declaration.span, "") };
    }
    for &body in free.iter().take(LISTED) {
        diagnostic = diagnostic.also(system.bodies[body].span, "not fixed by enough equations");
    }
    let names: Vec<String> = competing.iter().map(|declaration| declaration.name.clone()).collect();
    let coordinates: Vec<String> =
        columns.iter().map(|&column| system.coordinates[column as usize].name.clone()).collect();
    let shown: Vec<String> = coordinates.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    diagnostic
        .note(format!("nothing fixes {}", shown.join(", ")))
        .help("move one of the equations to the part that lacks one")
        .datum("coordinates", system.coordinates.len())
        .datum("equations", system.rows.len())
        .datum("ndof", 0)
        .datum("redundant", names)
        .datum("free", coordinates)
}
