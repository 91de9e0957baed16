//! Diagnostics of singular positions, at the start and on the way, and of contacts that end.

use super::{at, named, names, owners, with_places};
use mechc_ir::{ConstraintSystem, DeclarationId, DeclarationKind, MonitorKind};
use mechc_text::diag::{Code, Diagnostic};

/// Kind of singular position in which a mechanism starts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum StartVerdict {
    /// The equations depend on each other wherever the mechanism is.
    Always,
    /// A driver cannot move on; its row.
    LockUp(usize),
    /// Two branches meet.
    Bifurcation,
    /// Undecided, since nothing moves.
    Unknown,
}

/// Returns the diagnostic of a contact where a tangent vanishes, or of gears whose centres meet.
pub fn no_contact(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let monitor = &system.monitors()[index];
    let joint = &system.declarations()[monitor.declaration];
    let diagnostic = |message: String| Diagnostic::new(Code::E0607, message).datum("t", t);
    match monitor.kind {
        MonitorKind::LineOfCenters => diagnostic(format!("the centres of `{}` meet at {}", joint.name, at(t)))
            .at(joint.span, "there is no line of centres")
            .help("hold the gears apart by a carrier"),
        MonitorKind::Curvature => {
            diagnostic(format!("the relative curvature at the contact `{}` changes its sign at {}", joint.name, at(t)))
                .at(joint.span, "beyond it the two would go through each other")
                .help("let the curve bend one way all along the contact")
        }
        MonitorKind::Tangents => {
            diagnostic(format!("a curve has no tangent at the contact `{}` at {}", joint.name, at(t)))
                .at(joint.span, "the derivative of the curve by its argument vanishes there")
                .help(
                    "write the curve so that it nowhere rests as its argument goes on; or touch it elsewhere: \
             `curve k(u) = (…) at …` says where the contact is looked for first",
                )
        }
    }
}

/// Returns the diagnostic of a flat follower whose curve has a cusp where it touches.
pub fn undercut(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let joint = &system.declarations()[system.monitors()[index].declaration];
    let message = format!(
        "the curve at the contact `{}` is undercut at {}: its radius of curvature comes down to 0 mm",
        joint.name,
        at(t)
    );
    Diagnostic::new(Code::E0607, message)
        .at(joint.span, "the curve has a cusp there, and no face can touch what comes behind it")
        .help("make the base circle larger or the rise gentler, so that the radius of curvature is positive all round")
        .datum("t", t)
}

/// Explains why a contact is singular, and suggests a remedy.
pub fn equal_curvatures(diagnostic: Diagnostic, system: &ConstraintSystem, joint: DeclarationId) -> Diagnostic {
    let name = &system.declarations()[joint].name;
    match system.declarations()[joint].kind {
        DeclarationKind::Joint(joint) if joint.has_face() => {
            diagnostic.note(format!("at the contact `{name}` the curve is as flat as the face")).help(
                "a flat face needs a curve that is round all the way it touches it: without hollows and straight parts",
            )
        }
        _ => diagnostic
            .note(format!("at the contact `{name}` the curvatures of the two curves are equal"))
            .help("a roller must be smaller than the hollows of its cam, and a hollow one larger than what runs in it"),
    }
}

pub fn lock_up(
    system: &ConstraintSystem,
    driver: usize,
    joints: &[DeclarationId],
    columns: &[usize],
    t: f64,
) -> Diagnostic {
    let declaration = system.declaration_of(driver);
    let diagnostic = Diagnostic::new(
        Code::E0602,
        format!("the mechanism locks up at {}: driver `{}` cannot move on", at(t), declaration.name),
    )
    .at(declaration.span, "drives into a dead point");
    with_places(diagnostic, system, joints, ["this holds it there", "these hold it there"])
        .note(owners(system, columns, "would have to jump"))
        .help("let the driver turn back before that time, drive another joint, or change a length")
        .datum("t", t)
}

pub fn bifurcation(system: &ConstraintSystem, joints: &[DeclarationId], columns: &[usize], t: f64) -> Diagnostic {
    let message = if system.checks().is_empty() {
        format!("two branches of the motion meet at {}, and nothing decides between them", at(t))
    } else {
        format!("branches of the motion meet at {}: in first order nothing decides, not even what was left out", at(t))
    };
    let diagnostic = Diagnostic::new(Code::E0603, message);
    let diagnostic = with_places(diagnostic, system, joints, ["this leaves it open", "these leave it open"])
        .note(owners(system, columns, "could go either way"));
    diagnostic
        .help("go on along the branch that continues smoothly with `--pass-bifurcations`; or change a length a little")
        .datum("t", t)
}

/// Returns the diagnostic of a driver that turns back exactly in a dead point.
pub fn driver_rests(
    system: &ConstraintSystem,
    driver: usize,
    joints: &[DeclarationId],
    t: f64,
    passed: bool,
) -> Diagnostic {
    let declaration = system.declaration_of(driver);
    let code = if passed { Code::W0602 } else { Code::E0602 };
    let message =
        format!("driver `{}` rests in a dead point at {}: two motions go on from there", declaration.name, at(t));
    let diagnostic =
        Diagnostic::new(code, message).at(declaration.span, "comes to rest, and the mechanism may go either way");
    let diagnostic =
        with_places(diagnostic, system, joints, ["this holds it there", "these hold it there"]).datum("t", t);
    if passed {
        diagnostic.note("the one that continues smoothly was taken")
    } else {
        diagnostic.help("let the driver turn back before it gets there, or drive another joint; or go on smoothly with `--pass-bifurcations`")
    }
}

/// Returns the warning of a bifurcation beyond which the motion was followed.
pub fn passed(system: &ConstraintSystem, joints: &[DeclarationId], columns: &[usize], t: f64) -> Diagnostic {
    let message = format!("two branches of the motion meet at {}; the one that continues smoothly was taken", at(t));
    with_places(Diagnostic::new(Code::W0602, message), system, joints, ["this leaves it open", "these leave it open"])
        .note(owners(system, columns, "could have gone either way"))
        .datum("t", t)
}

/// Returns the warning of a bifurcation that a motion has missed by a part of the lengths.
pub fn near_change_point(
    system: &ConstraintSystem,
    joints: &[DeclarationId],
    columns: &[usize],
    within: f64,
    t: f64,
) -> Diagnostic {
    let message = format!("the motion passes within {within:.0e} of a change point at {}", at(t));
    let places = ["this nearly leaves it open", "these nearly leave it open"];
    with_places(Diagnostic::new(Code::W0605, message), system, joints, places)
        .note(owners(system, columns, "could nearly have gone either way"))
        .help(
            "a length that is off by such a part decides: where lengths are rounded and the branches should meet, make them equal and go on with `--pass-bifurcations`",
        )
        .datum("t", t)
        .datum("within", within)
}

/// Returns the diagnostic of a position whose derivatives are more rounding than digits.
pub fn uncertain(system: &ConstraintSystem, joints: &[DeclarationId], t: f64) -> Diagnostic {
    let message = format!("the position at {} is too near to a singular one for its accelerations to be known", at(t));
    with_places(
        Diagnostic::new(Code::E0610, message),
        system,
        joints,
        ["this nearly fixes nothing there", "these nearly depend on each other there"],
    )
    .note("fewer than nine digits of the accelerations would be certain")
    .help("leave this time out: other output times may be printed")
    .datum("t", t)
}

/// Returns the diagnostic of an equation whose derivatives by all coordinates vanish where it should fix something.
pub fn without_effect(system: &ConstraintSystem, row: usize, t: f64) -> Diagnostic {
    let message =
        format!("the equation of {} fixes nothing in the assembled position at {}", named(system, row), at(t));
    Diagnostic::new(Code::E0504, message)
        .at(system.declaration_of(row).span, "no small motion of any body changes it there")
        .datum("t", t)
}

pub fn singular_start(
    system: &ConstraintSystem,
    joints: &[DeclarationId],
    columns: &[usize],
    verdict: StartVerdict,
    t: f64,
) -> Diagnostic {
    let (message, help) = match verdict {
        StartVerdict::Always => (
            format!("the equations are not independent, at {} or at any other time", at(t)),
            "one of these joints is redundant, and a driver or joint is missing that fixes what is left free"
                .to_owned(),
        ),
        StartVerdict::LockUp(row) => (
            format!(
                "the mechanism starts in a dead point at {}: driver `{}` cannot move it",
                at(t),
                system.declaration_of(row).name
            ),
            "start at another time, drive another joint, or change a length".to_owned(),
        ),
        StartVerdict::Bifurcation => (
            format!("the mechanism starts where two branches of its motion meet, at {}", at(t)),
            "start at another time, with estimates that show the branch".to_owned(),
        ),
        StartVerdict::Unknown => (
            format!("the equations are not independent in the assembled position at {}", at(t)),
            "a dead point or change point: start at another time; else one of these joints is redundant".to_owned(),
        ),
    };
    with_places(
        Diagnostic::new(Code::E0504, message),
        system,
        joints,
        ["this fixes nothing there", "these depend on each other there"],
    )
    .help(help)
    .datum("t", t)
    .datum("coordinates", system.coordinates().len())
    .datum("equations", system.rows().len())
    .datum("ndof", system.ndof())
    .redundant(names(joints.iter().map(|&k| &system.declarations()[k].name)))
    .datum("free", names(columns.iter().map(|&k| &system.coordinates()[k].name)))
}
