//! The count of coordinates and equations, as a table.

use crate::{ConstraintSystem, Declaration, DeclarationKind, Owner};

/// Longer lists are shortened in the middle.
const LONGEST: usize = 40;

/// Returns a table of coordinates and equations by body, joint, constraint and driver, with their difference.
#[must_use]
pub fn table(system: &ConstraintSystem) -> String {
    let kind_of = |declaration: &Declaration| match declaration.kind {
        DeclarationKind::Joint(joint) => joint.name().to_owned(),
        other => other.noun().to_owned(),
    };
    let mut owners: Vec<[String; 3]> =
        system.bodies().iter().map(|body| ["body".to_owned(), body.name.clone(), "3".to_owned()]).collect();
    for owned in system.coordinates().chunk_by(|a, b| a.owner == b.owner) {
        if let Owner::Joint(joint) = owned[0].owner {
            let declaration = &system.declarations()[joint];
            owners.push([kind_of(declaration), declaration.name.clone(), owned.len().to_string()]);
        }
    }
    let equations: Vec<[String; 3]> = system
        .declarations()
        .iter()
        .map(|declaration| [kind_of(declaration), declaration.name.clone(), declaration.rows.to_string()])
        .collect();
    let (n, m) = (system.coordinates().len(), system.rows().len());
    let mut rows = vec![["coordinates".to_owned(), String::new(), n.to_string()]];
    rows.extend(cut(owners));
    rows.push(["equations".to_owned(), String::new(), m.to_string()]);
    rows.extend(cut(equations));
    rows.push(["NDOF".to_owned(), format!("{n} - {m}"), system.ndof().to_string()]);
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let (first, second, third) = (width(0) + 2, width(1), width(2));
    rows.iter()
        .map(|[kind, name, count]| {
            let is_total = matches!(kind.as_str(), "coordinates" | "equations" | "NDOF");
            let kind = if is_total { kind.clone() } else { format!("  {kind}") };
            format!("{kind:<first$}  {name:<second$}  {count:>third$}")
        })
        .collect::<Vec<_>>()
        .join("\n")
}

fn cut(mut rows: Vec<[String; 3]>) -> Vec<[String; 3]> {
    if rows.len() > LONGEST {
        let left_out = rows.len() - LONGEST;
        let middle = [String::new(), format!("… {left_out} more"), String::new()];
        rows.splice(LONGEST / 2..LONGEST / 2 + left_out, [middle]);
    }
    rows
}
