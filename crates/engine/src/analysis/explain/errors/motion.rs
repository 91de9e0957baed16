//! Diagnostics of a motion that cannot continue: formulas without a value, jumps, excessive speed.

use super::{at, in_units, named_all, short, with_places};
use crate::analysis::state::Unknown;
use mechc_expr::{Symbol, TableId};
use mechc_ir::{Condition, ConditionKind, ConstraintSystem, ContactForce, DeclarationId, DeclarationKind, LoadForce};
use mechc_text::diag::{Code, Diagnostic};

/// Columns that one message names at most.
const MOST_COLUMNS: usize = 12;

/// Reason why a force or derivative may have no value.
const NO_FORCE: &str = "infinite, undefined, or too near to a singular position";

/// Returns the diagnostic of a formula of some declarations that has no value, or a derivative without one.
pub fn formula_not_finite(system: &ConstraintSystem, declarations: &[DeclarationId], t: f64) -> Diagnostic {
    let named = named_all(system, declarations);
    let message = format!("the formula of {named} or a derivative of it is not finite at {}", at(t));
    with_places(Diagnostic::new(Code::E0605, message), system, declarations, ["infinite or not a number"; 2])
        .datum("t", t)
}

/// Returns the diagnostic of a load without a value, of which a condition may not hold.
pub fn load_not_finite(system: &ConstraintSystem, load: &LoadForce, broken: Option<usize>, t: f64) -> Diagnostic {
    if let Some(broken) = broken {
        return condition(system, &load.conditions[broken], t);
    }
    Diagnostic::new(Code::E0605, format!("load `{}` is not finite at {}", load.name, at(t)))
        .at(load.span, "infinite or not a number")
        .datum("t", t)
}

/// Returns a warning that a load works on a distance of zero, at `t` (s) for the first time.
pub fn load_without_direction(load: &LoadForce, t: f64) -> Diagnostic {
    Diagnostic::new(Code::W0603, format!("load `{}` has no direction at {}", load.name, at(t)))
        .at(load.span, "works on a distance that is 0 there")
        .note("what depends on it has no value there; everything else is as good as ever")
        .help("points that a joint holds together have no distance; a force on one of them is a load on `x(P)` and one on `y(P)`")
        .datum("t", t)
}

/// Returns a warning that a contact would have to pull with a force (N, below zero), at `t` (s) for the first time.
pub fn contact_pulls(system: &ConstraintSystem, contact: &ContactForce, force: f64, t: f64) -> Diagnostic {
    let declaration = &system.declarations()[contact.declaration];
    let message = format!("contact `{}` would have to pull at {}", declaration.name, at(t));
    let label = format!("its bodies would part, unless they are held together by {} N", short(-force));
    let mut diagnostic = Diagnostic::new(Code::W0604, message).at(declaration.span, label);
    if !contact.is_sided {
        diagnostic = diagnostic.note("before, the point pressed on the other side of the curve, which is open");
    }
    diagnostic
        .help("press them together: a spring is a load on a distance or displacement, as in `load spring: -k * K on K`")
        .help("where a groove or a lid holds the follower on both sides nothing is wrong")
        .datum("t", t)
}

/// Returns whether a declaration is a contact that needs a tangent of its curve.
pub fn has_tangent(system: &ConstraintSystem, declaration: DeclarationId) -> bool {
    matches!(system.declarations()[declaration].kind, DeclarationKind::Joint(joint) if joint.has_tangent())
}

/// Returns a warning that a quantity has no value in some rows, the first of them at `t` (s).
pub fn without_value(system: &ConstraintSystem, what: Unknown, t: f64, rows: u64) -> Diagnostic {
    let place = at(t);
    let how_many = if rows == 1 { "in 1 row".to_owned() } else { format!("in {rows} rows, first at {place}") };
    let (message, span, why, cells) = match what {
        Unknown::Measure(index) => {
            let measure = &system.measures()[index];
            let message = format!("measure `{}` or a derivative of it has no value at {place}", measure.name);
            let symbols = system.graph().symbols(measure.value);
            let holds_forces = symbols.iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)));
            let why = if holds_forces { NO_FORCE } else { "infinite or undefined" };
            (message, measure.span, why, "its")
        }
        Unknown::Derivative(index) => {
            let variable = &system.variables()[index];
            let message = format!("derivatives by `{}` have no value at {place}", variable.name);
            (message, variable.span, NO_FORCE, "their")
        }
        Unknown::Forces => {
            let message = format!("reactions and efforts have no value at {place}");
            (message, system.span(), NO_FORCE, "their")
        }
    };
    Diagnostic::new(Code::W0603, message)
        .at(span, format!("{why} {how_many}"))
        .note(format!("{cells} cells are empty there; everything else is as good as ever"))
        .datum("t", t)
        .datum("rows", rows as usize)
}

/// Returns the diagnostic of a condition of a formula that does not hold.
pub fn condition(system: &ConstraintSystem, condition: &Condition, t: f64) -> Diagnostic {
    let diagnostic = |code: Code, what: &str| Diagnostic::new(code, format!("{what} at {}", at(t))).datum("t", t);
    let owner = &condition.owner;
    let ends = |table: TableId| {
        let knots = &system.graph().tables()[table.index()].knots;
        [knots.first(), knots.last()].map(|end| end.map_or(f64::NAN, |&end| system.value_at(end, &[])))
    };
    match condition.kind {
        ConditionKind::Distance => diagnostic(Code::E0606, &format!("the distance of `{owner}` is not positive"))
            .at(condition.span, "reaches zero")
            .help("a distance must stay above zero"),
        ConditionKind::Interval => diagnostic(Code::E0606, &format!("the interval of a motion in `{owner}` is empty"))
            .at(condition.span, "no later than its beginning there")
            .help("the arguments are `(u, u0, v0, u1, v1)`, and `u0 < u1` must hold at all times"),
        ConditionKind::Range(table) => {
            let [first, last] = ends(table);
            let table = &system.graph().tables()[table.index()];
            diagnostic(Code::E0608, &format!("table `{}` does not reach as far as `{owner}` goes", table.name))
                .at(condition.span, format!("leaves its range, {} to {} in SI units", short(first), short(last)))
                .help("add rows, or let the analysis end before; a table that ends as it begins can repeat: `periodic spline`")
        }
        ConditionKind::Samples(table) => {
            let [first, last] = ends(table);
            let [from, to] = [first, last].map(short);
            diagnostic(Code::E0608, &format!("the motion leaves the samples of `{owner}`"))
                .at(condition.span, format!("from {from} s to {to} s"))
                .help(format!("add rows, or let the analysis go from {from} s to {to} s"))
        }
    }
}

/// Returns the diagnostic of a position that would have to change in no time.
///
/// `is_corner` is true if only the tangents of a contact do not agree. `column` would have to jump by `by` [m, rad].
pub fn position_jump(
    system: &ConstraintSystem,
    behind: &[DeclarationId],
    is_corner: bool,
    column: usize,
    by: f64,
    t: f64,
) -> Diagnostic {
    if let Some(&joint) = behind.iter().find(|&&k| is_corner && has_tangent(system, k)) {
        let joint = &system.declarations()[joint];
        let message = format!("the contact of `{}` comes to a corner of its curve at {}", joint.name, at(t));
        return Diagnostic::new(Code::E0609, message)
            .at(joint.span, "the tangent of the curve jumps there")
            .help("round the corner: a curve under a cam or flat follower needs a tangent everywhere")
            .datum("t", t);
    }
    let message = format!("{} jumps at {}", named_all(system, behind), at(t));
    let how = format!("`{}` would have to jump by {}", system.coordinates()[column].name, in_units(system, column, by));
    with_places(Diagnostic::new(Code::E0609, message), system, behind, [&how; 2])
        .help("let the two branches meet there, or lead from one to the other with `step5(t, t0, v0, t1, v1)`")
        .datum("t", t)
}

/// Returns the diagnostic of a velocity that would have to change in no time.
pub fn velocity_jump(
    system: &ConstraintSystem,
    behind: &[DeclarationId],
    column: usize,
    [before, after]: [f64; 2],
    t: f64,
) -> Diagnostic {
    let message = format!("the velocity of {} jumps at {}: there is no acceleration", named_all(system, behind), at(t));
    let velocity = |value: f64| format!("{}/s", in_units(system, column, value));
    let how =
        format!("`{}.d` jumps from {} to {}", system.coordinates()[column].name, velocity(before), velocity(after));
    with_places(Diagnostic::new(Code::E0609, message), system, behind, [&how; 2])
        .help("motions that begin and end at rest: `step`, `harmonic`; smooth to the acceleration: `step5`, `cycloidal`, `modsine`")
        .datum("t", t)
}

/// Returns the warning of an acceleration that has two values at one time.
pub fn acceleration_jump(
    system: &ConstraintSystem,
    behind: &[DeclarationId],
    columns: &[String],
    t: f64,
) -> Diagnostic {
    let message = format!("the acceleration of {} jumps at {}", named_all(system, behind), at(t));
    let mut shown: Vec<String> = columns.iter().take(MOST_COLUMNS).map(|name| format!("`{name}`")).collect();
    if columns.len() > MOST_COLUMNS {
        shown.push(format!("{} more", columns.len() - MOST_COLUMNS));
    }
    let help = if behind.iter().any(|&k| has_tangent(system, k)) {
        "at such a time a row holds the later side; a curve under a cam or flat follower needs a third derivative: `step7`"
    } else {
        "at such a time a row holds the later side; smooth to the acceleration are `step5`, `cycloidal`, `modsine`, `spline`"
    };
    with_places(Diagnostic::new(Code::W0601, message), system, behind, ["jumps there, and maybe again later"; 2])
        .note(format!("columns that jump: {}", shown.join(", ")))
        .help(help)
        .datum("t", t)
}

/// Returns the diagnostic of a motion that no step continues at `t` (s); `driver` is the row of the fastest driver.
pub fn cannot_follow(system: &ConstraintSystem, t: f64, driver: Option<usize>) -> Diagnostic {
    let message = format!("the motion cannot be followed beyond {}", at(t));
    let diagnostic = Diagnostic::new(Code::E0604, message)
        .help("look for a driver that jumps there, or becomes too fast")
        .datum("t", t);
    match driver {
        Some(row) => diagnostic.at(system.declaration_of(row).span, "the fastest driver there"),
        None => diagnostic.at(system.span(), "in this mechanism"),
    }
}

/// Returns the diagnostic of a motion that would take too many steps to the next output time.
pub fn too_fast(system: &ConstraintSystem, t: f64, target: f64, steps: u64, driver: Option<usize>) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0604, format!("the motion is too fast to follow near {}", at(t)))
        .note(format!("{steps} steps did not reach the next output time, {}", at(target)))
        .help(
            "a driver grows without bound there, or was meant in another unit; else take smaller steps with `--every`",
        )
        .datum("t", t);
    match driver {
        Some(row) => diagnostic.at(system.declaration_of(row).span, "the fastest driver there"),
        None => diagnostic.at(system.span(), "in this mechanism"),
    }
}
