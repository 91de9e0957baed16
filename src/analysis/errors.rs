//! What is said of an analysis that cannot be completed.

use super::assembly::Moved;
use super::kinematics::Fault;
use crate::diag::{Code, Diagnostic};
use crate::ir::{ConstraintSystem, DeclarationKind};

/// Labels of one message at most.
const LISTED: usize = 6;

/// A time as a reader wants it.
fn at(t: f64) -> String {
    format!("t = {} s", short(t))
}

/// Ten digits at most.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    format!("{rounded}")
}

/// `3.2 mm`, `1.4 m`.
fn length(metres: f64) -> String {
    let (value, unit) = match metres.abs() {
        m if m >= 1e3 => (metres / 1e3, "km"),
        m if m >= 1.0 => (metres, "m"),
        m if m >= 1e-3 => (metres * 1e3, "mm"),
        _ => (metres * 1e6, "um"),
    };
    format!("{} {unit}", three_digits(value))
}

fn three_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    format!("{rounded}")
}

fn degrees(radians: f64) -> String {
    format!("{} deg", three_digits(radians.to_degrees()))
}

fn named(system: &ConstraintSystem, row: usize) -> String {
    let declaration = system.declaration_of(row);
    format!("{} `{}`", declaration.kind.noun(), declaration.name)
}

pub fn too_large(system: &ConstraintSystem, size: usize, largest: usize) -> Diagnostic {
    Diagnostic::new(
        Code::E0208,
        format!("{size} coordinates have to be solved together; this version solves up to {largest} of them"),
    )
    .at(system.span, "one closed chain of bodies")
}

/// A formula that has no value, or not one that it may have.
pub fn no_value(system: &ConstraintSystem, fault: Fault, t: f64) -> Diagnostic {
    match fault {
        Fault::NotFinite { row } => {
            let declaration = system.declaration_of(row);
            let message =
                format!("the formula of {} or a derivative of it is not finite at {}", named(system, row), at(t));
            Diagnostic::new(Code::E0605, message).at(declaration.span, "infinite or not a number").datum("t", t)
        }
        Fault::Condition { index } => condition(system, index, t),
        Fault::Singular | Fault::TooFar => cannot_follow(system, t, None),
    }
}

pub fn measure_not_finite(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let measure = &system.measures[index];
    Diagnostic::new(Code::E0605, format!("measure `{}` or a derivative of it is not finite at {}", measure.name, at(t)))
        .at(measure.span, "infinite or not a number")
        .datum("t", t)
}

fn condition(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let condition = &system.conditions[index];
    let message = if condition.is_distance {
        format!("the distance of `{}` is not positive at {}", condition.owner, at(t))
    } else {
        format!("the interval of a motion in `{}` is empty at {}", condition.owner, at(t))
    };
    let diagnostic = Diagnostic::new(Code::E0606, message).at(condition.span, "reaches zero").datum("t", t);
    if condition.is_distance { diagnostic.help("a distance must stay above zero") } else { diagnostic }
}

pub fn cannot_follow(system: &ConstraintSystem, t: f64, driver: Option<usize>) -> Diagnostic {
    let message = format!("the motion cannot be followed beyond {}", at(t));
    let diagnostic = Diagnostic::new(Code::E0604, message)
        .help("look for a driver that jumps there, or becomes too fast")
        .datum("t", t);
    match driver {
        Some(row) => diagnostic.at(system.declaration_of(row).span, "the fastest driver there"),
        None => diagnostic.at(system.span, "in this mechanism"),
    }
}

/// A motion that would take too many steps to the next output time.
pub fn too_fast(system: &ConstraintSystem, t: f64, target: f64, steps: u64, driver: Option<usize>) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0604, format!("the motion is too fast to follow near {}", at(t)))
        .note(format!("{steps} steps did not reach the next output time, {}", at(target)))
        .help(
            "a driver grows without bound there, or was meant in another unit; else take smaller steps with `--every`",
        )
        .datum("t", t);
    match driver {
        Some(row) => diagnostic.at(system.declaration_of(row).span, "the fastest driver there"),
        None => diagnostic.at(system.span, "in this mechanism"),
    }
}

fn with_places(mut diagnostic: Diagnostic, system: &ConstraintSystem, joints: &[usize], text: &str) -> Diagnostic {
    for (k, &declaration) in joints.iter().take(LISTED).enumerate() {
        let span = system.declarations[declaration].span;
        let text = if k == 0 { text } else { "" };
        diagnostic = if diagnostic.labels.is_empty() { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    diagnostic
}

fn bodies_of(system: &ConstraintSystem, bodies: &[usize]) -> String {
    let names: Vec<String> =
        bodies.iter().take(LISTED).map(|&body| format!("`{}`", system.bodies[body].name)).collect();
    names.join(", ")
}

pub fn lock_up(system: &ConstraintSystem, driver: usize, joints: &[usize], bodies: &[usize], t: f64) -> Diagnostic {
    let declaration = system.declaration_of(driver);
    let diagnostic = Diagnostic::new(
        Code::E0602,
        format!("the mechanism locks up at {}: driver `{}` cannot move on", at(t), declaration.name),
    )
    .at(declaration.span, "drives into a dead point");
    with_places(diagnostic, system, joints, "these hold it there")
        .note(format!("the bodies that would have to jump: {}", bodies_of(system, bodies)))
        .help("let the driver turn back before that time, drive another joint, or change a length")
        .datum("t", t)
}

pub fn bifurcation(system: &ConstraintSystem, joints: &[usize], bodies: &[usize], t: f64) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::E0603,
        format!("two branches of the motion meet at {}, and nothing decides between them", at(t)),
    );
    with_places(diagnostic, system, joints, "these leave it open")
        .note(format!("the bodies that could go either way: {}", bodies_of(system, bodies)))
        .help("change a length a little, or stop before that time")
        .datum("t", t)
}

/// An equation whose derivatives by all coordinates vanish where it should fix something.
pub fn without_effect(system: &ConstraintSystem, row: usize, t: f64) -> Diagnostic {
    let message =
        format!("the equation of {} fixes nothing in the assembled position at {}", named(system, row), at(t));
    Diagnostic::new(Code::E0504, message)
        .at(system.declaration_of(row).span, "no small motion of any body changes it there")
        .datum("t", t)
}

pub fn singular_start(system: &ConstraintSystem, joints: &[usize], columns: &[usize], t: f64) -> Diagnostic {
    let mut bodies: Vec<usize> = columns.iter().map(|&column| system.coordinates[column].body).collect();
    bodies.dedup();
    let diagnostic = Diagnostic::new(
        Code::E0504,
        format!("the equations are not independent in the assembled position at {}", at(t)),
    );
    with_places(diagnostic, system, joints, "these depend on each other there")
        .note(format!("the bodies that are left free to move: {}", bodies_of(system, &bodies)))
        .help("a dead point or change point: start at another time; else one of these joints is redundant")
        .datum("t", t)
        .datum("coordinates", system.coordinates.len())
        .datum("equations", system.rows.len())
        .datum("ndof", system.ndof())
        .datum("redundant", names(joints.iter().map(|&k| &system.declarations[k].name)))
        .datum("free", names(columns.iter().map(|&k| &system.coordinates[k].name)))
}

fn names<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    names.cloned().collect()
}

/// Residuals of the worst rows of an assembly that failed.
pub fn cannot_assemble(system: &ConstraintSystem, worst: &[(usize, f64, f64)], t: f64) -> Diagnostic {
    let (row, _, residual) = worst.first().copied().unwrap_or((0, 0.0, 0.0));
    let gap = |row: usize, off: f64, scaled: f64| match system.declaration_of(row).kind {
        DeclarationKind::Joint("revolute" | "translational" | "revolute_translational") if off.is_finite() => {
            format!("does not close, by {}", length(scaled * system.length))
        }
        _ => format!("is not met, by {} of the mechanism's size", three_digits(scaled)),
    };
    let mut diagnostic = Diagnostic::new(
        Code::E0601,
        format!("the mechanism cannot be assembled at {}: {} stays open", at(t), named(system, row)),
    )
    .datum("t", t)
    .datum("residual", residual);
    let mut said: Vec<usize> = Vec::new();
    for &(row, off, scaled) in worst {
        let declaration = system.rows[row].declaration;
        if said.contains(&declaration) || said.len() == LISTED {
            continue;
        }
        let span = system.declarations[declaration].span;
        let text = gap(row, off, scaled);
        diagnostic = if said.is_empty() { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
        said.push(declaration);
    }
    diagnostic.help("check the lengths of the links between these, the driver's first value, and the estimates in `at`")
}

/// A remark where assembly moved a body so far that its branch may not be the one meant.
pub fn far_estimates(system: &ConstraintSystem, moved: &Moved, t: f64) -> Option<Diagnostic> {
    if moved.perturbed {
        let message = format!("the estimates do not say which way the mechanism is assembled at {}", at(t));
        return Some(
            Diagnostic::new(Code::N0601, message)
                .at(system.span, "one of several positions was taken")
                .help("give estimates in `at` that are nearer to the position meant"),
        );
    }
    let (far, turned) = (moved.length > system.length, moved.angle > std::f64::consts::FRAC_PI_2);
    if !far && !turned {
        return None;
    }
    let body = if far { moved.length_body } else { moved.angle_body };
    let body = &system.bodies[body];
    let how =
        if far { format!("moved by {}", length(moved.length)) } else { format!("turned by {}", degrees(moved.angle)) };
    Some(
        Diagnostic::new(Code::N0601, format!("the assembly at {} {how} the body `{}`", at(t), body.name))
            .at(body.span, "far from its estimate")
            .help("if this is not the branch meant, give better estimates in `at`"),
    )
}

impl Moved {
    /// In a sentence.
    #[must_use]
    pub fn in_words(&self, system: &ConstraintSystem) -> String {
        format!(
            "assembled: moved by at most {} (`{}`) and {} (`{}`) from the estimates",
            length(self.length),
            system.bodies[self.length_body].name,
            degrees(self.angle),
            system.bodies[self.angle_body].name,
        )
    }
}
