//! The symbols of params, tables and coordinates.

use super::letters::{Set, Style, symbol};
use mechc_expr::TableId;
use mechc_ir::{ConstraintSystem, Owner};

/// Returns a parameter's symbol.
pub(super) fn param(system: &ConstraintSystem, number: usize) -> Set {
    let name = &system.params()[number].name;
    match name.split_once('.') {
        None => symbol(name, Style::Italic, number),
        // a coordinate of a point
        Some((point, coordinate)) => {
            let Set { text, width } = symbol(point, Style::Italic, number);
            Set { text: format!("{text}_{{{coordinate}}}"), width: width + 0.4 }
        }
    }
}

/// Returns a table's symbol.
pub(super) fn table_name(system: &ConstraintSystem, table: TableId) -> Set {
    symbol(&system.graph().tables()[table.index()].name, Style::Upright, table.index())
}

/// Returns a coordinate's symbol, or that of a derivative of it: `\dot{\phi}_{\mathrm{crank}}`.
pub(super) fn coordinate(system: &ConstraintSystem, index: usize, order: u8) -> Set {
    let name = &system.coordinates()[index].name;
    let field = name.rsplit('.').next().unwrap_or(name);
    let letter = match field {
        "phi" | "theta" => format!(r"\{field}"),
        field => symbol(field, Style::Italic, index).text,
    };
    let dotted = match order {
        0 => letter,
        order => format!(r"\{}ot{{{letter}}}", "d".repeat(usize::from(order))),
    };
    let number = match system.coordinates()[index].owner {
        Owner::Body(body) => body.index(),
        Owner::Joint(joint) => system.bodies().len() + joint.index(),
    };
    let owner = symbol(system.owner_name(index), Style::Upright, number);
    Set { text: format!("{dotted}_{{{}}}", owner.text), width: 0.7 + 0.72 * owner.width }
}
