//! What is said of an analysis that cannot be completed.

use super::assembly::Moved;
use super::kinematics::Fault;
use super::redundancy::Dependent;
use super::singular::StartVerdict;
use crate::diag::{Code, Diagnostic, Diagnostics};
use crate::ir::{ConditionKind, ConstraintSystem, CoordinateKind, DeclarationKind, Fit, WatchKind};

/// Labels of one message at most.
const LISTED: usize = 6;

/// Gears may be off by this part of the larger radius.
const LARGEST_MISFIT: f64 = 1e-6;

/// Columns that one message names at most.
const MOST_COLUMNS: usize = 12;

/// A time as a reader wants it.
fn at(t: f64) -> String {
    format!("t = {} s", short(t))
}

/// Ten digits at most.
fn short(value: f64) -> String {
    readable(format!("{value:.9e}").parse().unwrap_or(value))
}

/// With an exponent where there would be more zeros than digits.
fn readable(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e10).contains(&size) { format!("{value}") } else { format!("{value:e}") }
}

/// `3.2 mm`, `1.4 m`.
///
/// Less than an atom is nothing.
fn length(metres: f64) -> String {
    let (value, unit) = match metres.abs() {
        m if m < 1e-12 => (0.0, "m"),
        m if m >= 1e3 => (metres / 1e3, "km"),
        m if m >= 1.0 => (metres, "m"),
        m if m >= 1e-3 => (metres * 1e3, "mm"),
        _ => (metres * 1e6, "um"),
    };
    format!("{} {unit}", three_digits(value))
}

pub fn three_digits(value: f64) -> String {
    readable(format!("{value:.2e}").parse().unwrap_or(value))
}

fn degrees(radians: f64) -> String {
    let rounded = if radians.abs() < 1e-12 { 0.0 } else { radians };
    format!("{} deg", three_digits(rounded.to_degrees()))
}

fn named(system: &ConstraintSystem, row: usize) -> String {
    let declaration = system.declaration_of(row);
    format!("{} `{}`", declaration.kind.noun(), declaration.name)
}

pub fn too_large(system: &ConstraintSystem, size: usize, largest: usize) -> Diagnostic {
    Diagnostic::new(
        Code::E0505,
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
        Fault::Watch { index } => no_contact(system, index, t),
        Fault::Check { index } => ceases_to_hold(system, index, t),
        Fault::Singular | Fault::Uncertain | Fault::TooFar | Fault::Edge { .. } => cannot_follow(system, t, None),
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
    let diagnostic = |code: Code, what: &str| Diagnostic::new(code, format!("{what} at {}", at(t))).datum("t", t);
    let owner = &condition.owner;
    match condition.kind {
        ConditionKind::Distance => diagnostic(Code::E0606, &format!("the distance of `{owner}` is not positive"))
            .at(condition.span, "reaches zero")
            .help("a distance must stay above zero"),
        ConditionKind::Interval => diagnostic(Code::E0606, &format!("the interval of a motion in `{owner}` is empty"))
            .at(condition.span, "reaches zero"),
        ConditionKind::Range(table) => {
            let table = &system.graph.tables()[table.index()];
            let ends = [table.knots.first(), table.knots.last()];
            let [first, last] = ends.map(|end| end.map_or(f64::NAN, |&end| system.value_at(end, &[])));
            diagnostic(Code::E0608, &format!("table `{}` is left in `{owner}`", table.name))
                .at(condition.span, format!("out of its range, {} to {}", short(first), short(last)))
                .help("add rows, or let it repeat: `periodic spline`")
        }
    }
}

/// `joint `contact``, `driver `motor` and `brake``.
fn named_all(system: &ConstraintSystem, declarations: &[usize]) -> String {
    let names: Vec<String> = declarations
        .iter()
        .take(LISTED)
        .map(|&k| format!("{} `{}`", system.declarations[k].kind.noun(), system.declarations[k].name))
        .collect();
    names.join(" and ")
}

/// Whether a row is about places, or about angles alone.
pub fn gap_kind(system: &ConstraintSystem, row: usize) -> CoordinateKind {
    let mut kinds = system.phi_q.row(row).iter().map(|&(column, _)| system.coordinates[column as usize].kind);
    if kinds.any(|kind| kind == CoordinateKind::Length) { CoordinateKind::Length } else { CoordinateKind::Angle }
}

/// Equations that depend on others: a message for each declaration that wrote them.
pub fn too_many(system: &ConstraintSystem, dependents: &[Dependent]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for group in dependents.chunk_by(|a, b| system.rows[a.row].declaration == system.rows[b.row].declaration) {
        let widest = group.iter().filter_map(|one| Some((one, one.open?))).max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        diagnostics.push(match widest {
            Some((one, (by, t))) => conflicting(system, group, one, by, t),
            None => redundant(system, group),
        });
    }
    diagnostics
}

/// The declarations that a group of rows of one declaration depends on, in order.
fn depends_on(system: &ConstraintSystem, group: &[Dependent]) -> Vec<usize> {
    let own = group.first().map(|one| system.rows[one.row].declaration);
    let rows = group.iter().flat_map(|one| &one.on).map(|&(row, _)| system.rows[row].declaration);
    let mut declarations: Vec<usize> = rows.filter(|&declaration| Some(declaration) != own).collect();
    declarations.sort_unstable();
    declarations.dedup();
    declarations
}

fn count_data(diagnostic: Diagnostic, system: &ConstraintSystem, declaration: usize) -> Diagnostic {
    let (n, m) = (system.coordinates.len(), system.rows.len());
    diagnostic
        .note(format!("{n} coordinates, {m} equations: NDOF = {}", system.ndof()))
        .datum("coordinates", n)
        .datum("equations", m)
        .datum("ndof", system.ndof())
        .datum("redundant", vec![system.declarations[declaration].name.clone()])
}

fn redundant(system: &ConstraintSystem, group: &[Dependent]) -> Diagnostic {
    let on = depends_on(system, group);
    let index = group.first().map_or(0, |one| system.rows[one.row].declaration);
    let declaration = &system.declarations[index];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let message = match group.len() {
        k if k == declaration.rows => format!("{noun} `{name}` is redundant: the others hold it already"),
        1 => format!("1 equation of {noun} `{name}` is redundant: the others hold it already"),
        k => format!("{k} equations of {noun} `{name}` are redundant: the others hold them already"),
    };
    let mut diagnostic = Diagnostic::new(Code::E0506, message).at(declaration.span, "says nothing new");
    for (k, &other) in on.iter().take(LISTED).enumerate() {
        let text = if k == 0 { "it follows from these" } else { "" };
        diagnostic = diagnostic.also(system.declarations[other].span, text);
    }
    count_data(diagnostic, system, index)
        .help(mend(system, group))
        .help("or allow it: `--allow-redundant` leaves it out, and checks at every time that it holds")
}

/// What to write instead of a redundant joint, constraint or driver.
fn mend(system: &ConstraintSystem, group: &[Dependent]) -> String {
    let index = group.first().map_or(0, |one| system.rows[one.row].declaration);
    let declaration = &system.declarations[index];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let whole = format!("take the {noun} `{name}` away");
    if group.len() == declaration.rows {
        return whole;
    }
    match declaration.kind {
        DeclarationKind::Joint("revolute") => format!(
            "let the pin of `{name}` slide along the line between the pins of its link: \
             `joint {name}: revolute_translational(P, axis)`, with an axis along that line"
        ),
        DeclarationKind::Joint("translational") => format!(
            "let `{name}` hold a point on the axis, and not the angle too: `joint {name}: revolute_translational(P, axis)`"
        ),
        DeclarationKind::Joint("weld") => {
            format!("let `{name}` hold the point, and not the angle too: `joint {name}: revolute(P, Q)`")
        }
        _ => whole,
    }
}

fn conflicting(system: &ConstraintSystem, group: &[Dependent], one: &Dependent, by: f64, t: f64) -> Diagnostic {
    let on = depends_on(system, group);
    let index = system.rows[one.row].declaration;
    let declaration = &system.declarations[index];
    let by = if gap_kind(system, one.row) == CoordinateKind::Length { length(by) } else { degrees(by) };
    let others = named_all(system, &on[..on.len().min(3)]);
    let more = if on.len() > 3 { " and others" } else { "" };
    let message = format!("{} `{}` cannot hold beside {others}{more}", declaration.kind.noun(), declaration.name);
    let mut diagnostic =
        Diagnostic::new(Code::E0507, message).at(declaration.span, format!("off by {by} at {}", at(t)));
    for &other in on.iter().take(LISTED) {
        diagnostic = diagnostic.also(system.declarations[other].span, "");
    }
    count_data(diagnostic, system, index)
        .help(format!("take one of them away, or make `{}` agree with the others", declaration.name))
        .datum("t", t)
}

/// What is said of equations that are left out because that was allowed.
pub fn left_out(system: &ConstraintSystem, dependents: &[Dependent]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for group in dependents.chunk_by(|a, b| system.rows[a.row].declaration == system.rows[b.row].declaration) {
        let index = group.first().map_or(0, |one| system.rows[one.row].declaration);
        let declaration = &system.declarations[index];
        let what = if group.len() == 1 { "1 equation".to_owned() } else { format!("{} equations", group.len()) };
        let message = format!(
            "{what} of {} `{}` left out: the others hold it already",
            declaration.kind.noun(),
            declaration.name
        );
        let diagnostic = Diagnostic::new(Code::W0502, message).at(declaration.span, "checked at every time");
        diagnostics.push(diagnostic.help(mend(system, group)));
    }
    diagnostics
}

/// An equation that was left out and does not follow from the others any more.
pub fn ceases_to_hold(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let declaration = &system.declarations[system.checks[index].declaration];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    Diagnostic::new(Code::E0611, format!("{noun} `{name}`, which was left out, ceases to hold at {}", at(t)))
        .at(declaration.span, "redundant at the start, but not here")
        .help(format!("`{name}` conflicts with the others: take one of them away"))
        .datum("t", t)
}

fn in_units(system: &ConstraintSystem, column: usize, value: f64) -> String {
    match system.coordinates[column].kind {
        CoordinateKind::Length => length(value),
        CoordinateKind::Angle => degrees(value),
        CoordinateKind::Argument => three_digits(value),
    }
}

/// A position that would have to change in no time.
///
/// It is a corner if only the tangents of a contact do not agree.
pub fn position_jump(
    system: &ConstraintSystem,
    behind: &[usize],
    is_corner: bool,
    (column, by): (usize, f64),
    t: f64,
) -> Diagnostic {
    let is_contact =
        |k: &usize| matches!(system.declarations[*k].kind, DeclarationKind::Joint("cam" | "flat_follower"));
    if let Some(&joint) = behind.iter().find(|k| is_corner && is_contact(k)) {
        let joint = &system.declarations[joint];
        let message = format!("the contact of `{}` comes to a corner of its curve at {}", joint.name, at(t));
        return Diagnostic::new(Code::E0609, message)
            .at(joint.span, "the tangent of the curve jumps there")
            .help("round the corner: a curve under a cam or flat follower needs a tangent everywhere")
            .datum("t", t);
    }
    let message = format!("{} jumps at {}", named_all(system, behind), at(t));
    let how = format!("`{}` would have to jump by {}", system.coordinates[column].name, in_units(system, column, by));
    with_places(Diagnostic::new(Code::E0609, message), system, behind, &how)
        .help("let the two branches meet there, or lead from one to the other with `step5(t, t0, v0, t1, v1)`")
        .datum("t", t)
}

/// A velocity that would have to change in no time.
pub fn velocity_jump(
    system: &ConstraintSystem,
    behind: &[usize],
    column: usize,
    [before, after]: [f64; 2],
    t: f64,
) -> Diagnostic {
    let message = format!("the velocity of {} jumps at {}: there is no acceleration", named_all(system, behind), at(t));
    let velocity = |value: f64| format!("{}/s", in_units(system, column, value));
    let how = format!("`{}.d` jumps from {} to {}", system.coordinates[column].name, velocity(before), velocity(after));
    with_places(Diagnostic::new(Code::E0609, message), system, behind, &how)
        .help("motions that begin and end at rest: `step`, `harmonic`; smooth to the acceleration: `step5`, `cycloidal`, `modsine`")
        .datum("t", t)
}

/// An acceleration that has two values at one time.
pub fn acceleration_jump(system: &ConstraintSystem, behind: &[usize], columns: &[String], t: f64) -> Diagnostic {
    let message = format!("the acceleration of {} jumps at {}", named_all(system, behind), at(t));
    let mut shown: Vec<String> = columns.iter().take(MOST_COLUMNS).map(|name| format!("`{name}`")).collect();
    if columns.len() > MOST_COLUMNS {
        shown.push(format!("{} more", columns.len() - MOST_COLUMNS));
    }
    let of_contact =
        |k: &usize| matches!(system.declarations[*k].kind, DeclarationKind::Joint("cam" | "flat_follower"));
    let help = if behind.iter().any(of_contact) {
        "at such a time a row holds the later side; a curve under a cam or flat follower needs a third derivative: `step7`"
    } else {
        "at such a time a row holds the later side; smooth to the acceleration are `step5`, `cycloidal`, `modsine`, `spline`"
    };
    with_places(Diagnostic::new(Code::W0601, message), system, behind, "jumps there, and maybe again later")
        .note(format!("columns that jump: {}", shown.join(", ")))
        .help(help)
        .datum("t", t)
}

/// A contact where a tangent vanishes, or gears whose centres meet.
pub fn no_contact(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let watch = &system.watches[index];
    let joint = &system.declarations[watch.declaration];
    let diagnostic = |message: String| Diagnostic::new(Code::E0607, message).datum("t", t);
    match watch.kind {
        WatchKind::LineOfCenters => diagnostic(format!("the centres of `{}` meet at {}", joint.name, at(t)))
            .at(joint.span, "there is no line of centres")
            .help("hold the gears apart by a carrier"),
        WatchKind::Curvature => {
            diagnostic(format!("the relative curvature at the contact `{}` changes its sign at {}", joint.name, at(t)))
                .at(joint.span, "the curves would go through each other behind it")
                .help("let the curve bend one way all along the contact")
        }
        WatchKind::Tangents => diagnostic(format!(
            "a curve has no tangent at the contact `{}` at {}",
            joint.name,
            at(t)
        ))
        .at(joint.span, "the derivative of the curve by its argument vanishes there")
        .help(
            "give another first estimate: `curve k(u) = (…) at …`; or write the curve so that it nowhere rests as \
                     its argument goes on",
        ),
    }
}

/// Why a contact is singular, and what to do about it.
pub fn equal_curvatures(diagnostic: Diagnostic, system: &ConstraintSystem, joint: usize) -> Diagnostic {
    let name = &system.declarations[joint].name;
    match system.declarations[joint].kind {
        DeclarationKind::Joint("flat_follower") => {
            diagnostic.note(format!("at the contact `{name}` the curve is as flat as the face")).help(
                "a flat face needs a curve that is round all the way it touches it: without hollows and straight parts",
            )
        }
        _ => diagnostic
            .note(format!("at the contact `{name}` the curvatures of the two curves are equal"))
            .help("a roller must be smaller than the hollows of its cam, and a hollow one larger than what runs in it"),
    }
}

/// A warning where the centres of gears, or of a pinion and its rack, are not as far apart as the radii have it.
pub fn misfit(system: &ConstraintSystem, fit: &Fit, q: &[f64], t: f64) -> Option<Diagnostic> {
    let [distance, wanted, radius] = [fit.distance, fit.wanted, fit.radius].map(|id| system.value_at(id, q));
    let off = distance - wanted;
    if off.abs() <= LARGEST_MISFIT * radius {
        return None;
    }
    let joint = &system.declarations[fit.declaration];
    if distance < -LARGEST_MISFIT * radius {
        let message =
            format!("the pinion of `{}` is on the other side of its rack than is said at {}", joint.name, at(t));
        return Some(
            Diagnostic::new(Code::W0501, message)
                .at(joint.span, "it turns the other way there")
                .help("left and right are seen along the direction of the rack's axis"),
        );
    }
    let (what, why) = match joint.kind {
        DeclarationKind::Joint("gear") => ("centres", "the sum of the radii"),
        DeclarationKind::Joint("internal_gear") => ("centres", "the difference of the radii"),
        _ => ("centre and axis", "the radius"),
    };
    let message = format!(
        "the {what} of `{}` are {} apart at {}, {why} is {}",
        joint.name,
        digits_that_differ(distance, wanted),
        at(t),
        digits_that_differ(wanted, distance)
    );
    Some(
        Diagnostic::new(Code::W0501, message)
            .at(joint.span, format!("off by {}", length(off)))
            .help("a gear or rack does not hold its distance: the joints of its bodies must"),
    )
}

/// A length (m) with as many digits as tell it from another.
fn digits_that_differ(value: f64, other: f64) -> String {
    if value.abs() < 1e-12 {
        return "0 mm".to_owned();
    }
    let digits = (3..=9).find(|&digits| format!("{value:.digits$e}") != format!("{other:.digits$e}")).unwrap_or(9);
    let rounded: f64 = format!("{:.digits$e}", value * 1e3).parse().unwrap_or(value);
    format!("{rounded} mm")
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

/// The bodies that coordinates are of, and what they do; where no coordinate is a body's, the contacts and meshes.
fn owners(system: &ConstraintSystem, columns: &[usize], what: &str) -> String {
    let of_bodies: Vec<usize> = columns.iter().copied().filter(|&k| system.body_of(k).is_some()).collect();
    let (columns, noun) = if of_bodies.is_empty() { (columns, "contacts") } else { (of_bodies.as_slice(), "bodies") };
    let mut names: Vec<String> = columns.iter().map(|&column| format!("`{}`", system.owner_name(column))).collect();
    names.dedup();
    names.truncate(LISTED);
    format!("the {noun} that {what}: {}", names.join(", "))
}

pub fn lock_up(system: &ConstraintSystem, driver: usize, joints: &[usize], columns: &[usize], t: f64) -> Diagnostic {
    let declaration = system.declaration_of(driver);
    let diagnostic = Diagnostic::new(
        Code::E0602,
        format!("the mechanism locks up at {}: driver `{}` cannot move on", at(t), declaration.name),
    )
    .at(declaration.span, "drives into a dead point");
    with_places(diagnostic, system, joints, "these hold it there")
        .note(owners(system, columns, "would have to jump"))
        .help("let the driver turn back before that time, drive another joint, or change a length")
        .datum("t", t)
}

pub fn bifurcation(system: &ConstraintSystem, joints: &[usize], columns: &[usize], t: f64) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Code::E0603,
        format!("two branches of the motion meet at {}, and nothing decides between them", at(t)),
    );
    with_places(diagnostic, system, joints, "these leave it open")
        .note(owners(system, columns, "could go either way"))
        .help("go on along the branch that continues smoothly with `--pass-bifurcations`; or change a length a little")
        .datum("t", t)
}

/// A driver that turns back exactly in a dead point.
pub fn driver_rests(system: &ConstraintSystem, driver: usize, joints: &[usize], t: f64, passed: bool) -> Diagnostic {
    let declaration = system.declaration_of(driver);
    let code = if passed { Code::W0602 } else { Code::E0602 };
    let message =
        format!("driver `{}` rests in a dead point at {}: two motions go on from there", declaration.name, at(t));
    let diagnostic =
        Diagnostic::new(code, message).at(declaration.span, "comes to rest, and the mechanism may go either way");
    let diagnostic = with_places(diagnostic, system, joints, "these are in line there").datum("t", t);
    if passed {
        diagnostic.note("the one that continues smoothly was taken")
    } else {
        diagnostic.help("let the driver turn back before that time; or go on smoothly with `--pass-bifurcations`")
    }
}

/// A bifurcation beyond which the motion was followed.
pub fn passed(system: &ConstraintSystem, joints: &[usize], columns: &[usize], t: f64) -> Diagnostic {
    let message = format!("two branches of the motion meet at {}; the one that continues smoothly was taken", at(t));
    with_places(Diagnostic::new(Code::W0602, message), system, joints, "these leave it open")
        .note(owners(system, columns, "could have gone either way"))
        .datum("t", t)
}

/// A position whose derivatives are more rounding than digits.
pub fn uncertain(system: &ConstraintSystem, joints: &[usize], t: f64) -> Diagnostic {
    let message = format!("the position at {} is too near to a singular one for its accelerations to be known", at(t));
    with_places(Diagnostic::new(Code::E0610, message), system, joints, "these nearly depend on each other there")
        .note("nine digits are printed or none")
        .help("leave this time out: other output times may be printed")
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

pub fn singular_start(
    system: &ConstraintSystem,
    joints: &[usize],
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
    with_places(Diagnostic::new(Code::E0504, message), system, joints, "these depend on each other there")
        .help(help)
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
