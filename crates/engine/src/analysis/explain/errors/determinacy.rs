//! Diagnostics of too many equations, too few, or both.

use super::{LISTED, at, degrees, gap_kind, length, with_places};
use crate::analysis::explain::freedom::Freedom;
use crate::analysis::explain::redundancy::Dependent;
use crate::analysis::explain::sharing::Shared;
use crate::limits::explain::MOST_NAMED;
use mechc_expr::ExprId;
use mechc_ir::{ConstraintSystem, CoordinateKind, Declaration, DeclarationId, DeclarationKind, PointId};
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::vocabulary::JointMotion;

/// Equations that depend on others: a message for each declaration that wrote them.
pub fn too_many(system: &ConstraintSystem, dependents: &[Dependent]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for (group, stuck) in grouped(system, dependents) {
        let widest = group.iter().filter_map(|one| Some((one, one.open?))).max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        diagnostics.push(match widest {
            Some((one, (by, t))) => conflicting(system, group, one, by, t),
            None => redundant(system, group, &stuck),
        });
    }
    diagnostics
}

/// Returns the groups of dependent rows by declaration, each with the drivers to which it leaves no motion; these drivers get no diagnostic
/// of their own.
fn grouped<'d>(system: &ConstraintSystem, dependents: &'d [Dependent]) -> Vec<(&'d [Dependent], Vec<DeclarationId>)> {
    let groups = by_declaration(system, dependents);
    let reason_of = |group: &[Dependent]| {
        let on = depends_on(system, group);
        let overlaps = |other: &&[Dependent]| {
            !is_driver(system, declaration_of(system, other))
                && depends_on(system, other).iter().any(|k| on.contains(k))
        };
        groups.iter().copied().find(overlaps).filter(|_| is_stuck(system, group)).map(|one| declaration_of(system, one))
    };
    let stuck_by = |group: &[Dependent]| {
        let index = declaration_of(system, group);
        let stuck = groups.iter().filter(|other| reason_of(other) == Some(index));
        stuck.map(|other| declaration_of(system, other)).collect()
    };
    groups.iter().filter(|group| reason_of(group).is_none()).map(|&group| (group, stuck_by(group))).collect()
}

fn by_declaration<'d>(system: &ConstraintSystem, dependents: &'d [Dependent]) -> Vec<&'d [Dependent]> {
    dependents.chunk_by(|a, b| system.rows()[a.row].declaration == system.rows()[b.row].declaration).collect()
}

/// Returns the declaration of a group of rows of one declaration.
fn declaration_of(system: &ConstraintSystem, group: &[Dependent]) -> DeclarationId {
    system.rows()[group[0].row].declaration
}

fn is_driver(system: &ConstraintSystem, declaration: DeclarationId) -> bool {
    system.declarations()[declaration].kind == DeclarationKind::Driver
}

/// Returns whether a group is a driver's that conflicts with joints alone: they leave it nothing to move.
fn is_stuck(system: &ConstraintSystem, group: &[Dependent]) -> bool {
    is_driver(system, declaration_of(system, group))
        && group.iter().any(|one| one.open.is_some())
        && !depends_on(system, group).iter().any(|&k| is_driver(system, k))
}

/// Returns the declarations that a group of rows of one declaration depends on, in order.
fn depends_on(system: &ConstraintSystem, group: &[Dependent]) -> Vec<DeclarationId> {
    let declaration = declaration_of(system, group);
    let rows = group.iter().flat_map(|one| &one.on).map(|&row| system.rows()[row].declaration);
    let mut declarations: Vec<DeclarationId> = rows.filter(|&other| other != declaration).collect();
    declarations.sort_unstable();
    declarations.dedup();
    declarations
}

fn count_data(diagnostic: Diagnostic, system: &ConstraintSystem, declaration: DeclarationId) -> Diagnostic {
    let (n, m) = (system.coordinates().len(), system.rows().len());
    diagnostic
        .note(format!("{n} coordinates, {m} equations: NDOF = {}", system.ndof()))
        .datum("coordinates", n)
        .datum("equations", m)
        .datum("ndof", system.ndof())
        .redundant(vec![system.declarations()[declaration].name.clone()])
}

fn headline_of_redundant(system: &ConstraintSystem, group: &[Dependent]) -> String {
    let declaration = &system.declarations()[declaration_of(system, group)];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    match group.len() {
        k if k == declaration.rows => format!("{noun} `{name}` is redundant"),
        1 => format!("1 equation of {noun} `{name}` is redundant"),
        k => format!("{k} equations of {noun} `{name}` are redundant"),
    }
}

/// Returns the diagnostic of a redundant group. If drivers are stuck, the group is what leaves them no motion.
fn redundant(system: &ConstraintSystem, group: &[Dependent], stuck: &[DeclarationId]) -> Diagnostic {
    let on = depends_on(system, group);
    let index = declaration_of(system, group);
    let declaration = &system.declarations()[index];
    let them = if group.len() == 1 || group.len() == declaration.rows { "it" } else { "them" };
    let message = format!("{}: the others hold {them} already", headline_of_redundant(system, group));
    let mut diagnostic = Diagnostic::new(Code::E0506, message).at(declaration.span, "says nothing new");
    diagnostic = with_places(diagnostic, system, &on, ["it follows from this", "it follows from these"]);
    if !stuck.is_empty() {
        diagnostic = with_places(diagnostic, system, stuck, NOTHING_TO_MOVE);
        return count_data(diagnostic, system, index).help(take_away(declaration));
    }
    count_data(diagnostic, system, index)
        .help(mend(system, group))
        .help("or allow it: `--allow-redundant` leaves it out, and checks at every time that it holds")
}

fn take_away(declaration: &Declaration) -> String {
    format!("take the {} `{}` away", declaration.kind.noun(), declaration.name)
}

/// Suggests a replacement for a redundant joint, constraint or driver.
fn mend(system: &ConstraintSystem, group: &[Dependent]) -> String {
    let index = declaration_of(system, group);
    let declaration = &system.declarations()[index];
    let name = &declaration.name;
    let whole = take_away(declaration);
    let [one] = group else { return whole };
    if declaration.rows == 1 {
        return whole;
    }
    let DeclarationKind::Joint(joint) = declaration.kind else { return whole };
    match joint.motion {
        Some(JointMotion::Rotation) => sliding_pin(system, index).unwrap_or_else(|| {
            format!(
                "let the pin of `{name}` slide along the line between the pins of its link: \
                 `joint {name}: revolute_translational(P, axis)`, with an axis along that line"
            )
        }),
        Some(JointMotion::Displacement) => {
            let axes: Vec<&String> = declaration.axes.iter().map(|&axis| &system.axes()[axis].name).collect();
            match (gap_kind(system, one.row), axes.as_slice()) {
                (CoordinateKind::Length, [a, b]) => {
                    format!("let `{name}` hold the angle only: `constraint {name}: angle({a}, {b}) = 0`")
                }
                (_, [_, b]) if system.point_name(declaration.points[0]).is_some() => format!(
                    "let `{name}` hold a point on the axis, and not the angle too: \
                 `joint {name}: revolute_translational({}, {b})`",
                    system.point_name(declaration.points[0]).unwrap_or_default()
                ),
                _ => format!(
                    "let `{name}` hold a point on the axis, and not the angle too: \
                 `joint {name}: revolute_translational(P, axis)`"
                ),
            }
        }
        None if joint.holds_points_together() => {
            let names: Option<Vec<String>> = declaration.points.iter().map(|&k| system.point_name(k)).collect();
            let points = names.map_or("P, Q".to_owned(), |names| names.join(", "));
            format!("let `{name}` hold the point, and not the angle too: `joint {name}: revolute({points})`")
        }
        None => whole,
    }
}

/// Suggests a slot for a link of two pins, one of which is a redundant joint: the link's length is redundant, so the pin may slide along it.
fn sliding_pin(system: &ConstraintSystem, index: DeclarationId) -> Option<String> {
    let joint = &system.declarations()[index];
    let &[p, q] = joint.points.as_slice() else {
        return None;
    };
    [(p, q), (q, p)].into_iter().find_map(|(pin, other)| {
        let body = system.points()[pin].body?;
        let on_body = |point: &&PointId| system.points()[**point].body == Some(body);
        let pins: Vec<PointId> =
            system.declarations().iter().filter_map(|one| one.points.iter().find(on_body)).copied().collect();
        let &[far] = pins.iter().copied().filter(|&one| one != pin).collect::<Vec<PointId>>().as_slice() else {
            return None;
        };
        let (body, from, to) =
            (&system.bodies()[body].name, system.points()[far].name.as_ref()?, system.points()[pin].name.as_ref()?);
        Some(format!(
            "let its pin slide along `{body}`: write `axis {0}_slot = {from} to {to}` in `{body}`, \
             and `joint {0}: revolute_translational({1}, {body}.{0}_slot)`",
            joint.name,
            system.point_name(other)?
        ))
    })
}

fn conflicting(system: &ConstraintSystem, group: &[Dependent], one: &Dependent, by: f64, t: f64) -> Diagnostic {
    let on = depends_on(system, group);
    let index = system.rows()[one.row].declaration;
    let declaration = &system.declarations()[index];
    let diagnostic = Diagnostic::new(Code::E0507, headline_of_conflict(system, group, false))
        .at(declaration.span, gap_in_words(system, one.row, by, t));
    let diagnostic = with_places(diagnostic, system, &on, ["", ""]);
    let help = if on.is_empty() {
        "draw the bodies in `at` nearer to the position meant, or take it away".to_owned()
    } else if is_stuck(system, group) {
        "check the lengths of these links, or take one of the joints away".to_owned()
    } else {
        format!("take one of them away, or make `{}` agree with the others", declaration.name)
    };
    let diagnostic = count_data(diagnostic, system, index).help(help).datum("t", t).datum("open", by);
    if meshes(declaration.kind) { diagnostic.help(MESHES_AS_DRAWN) } else { diagnostic }
}

/// Returns the headline for declarations that conflict; `is_free` is true if anything can move.
fn headline_of_conflict(system: &ConstraintSystem, group: &[Dependent], is_free: bool) -> String {
    let on = depends_on(system, group);
    let declaration = &system.declarations()[declaration_of(system, group)];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    match on.len() {
        0 => format!("no motion of the bodies changes {noun} `{name}`, which does not hold"),
        _ if !is_free && is_stuck(system, group) => {
            let leave = if on.len() == 1 { "leaves" } else { "leave" };
            format!("{noun} `{name}` has nothing to move: {} {leave} no motion", by_kinds(system, &on))
        }
        _ => format!("{noun} `{name}` cannot hold beside {}", by_kinds(system, &on)),
    }
}

/// Joints, constraints and drivers by their names.
fn by_kinds(system: &ConstraintSystem, declarations: &[DeclarationId]) -> String {
    let kinds =
        declarations.chunk_by(|&a, &b| system.declarations()[a].kind.noun() == system.declarations()[b].kind.noun());
    let parts: Vec<String> = kinds
        .map(|group| {
            let noun = system.declarations()[group[0]].kind.noun();
            let names: Vec<String> =
                group.iter().take(3).map(|&k| format!("`{}`", system.declarations()[k].name)).collect();
            let more = if group.len() > 3 { format!(" and {} more", group.len() - 3) } else { String::new() };
            let plural = if group.len() > 1 { "s" } else { "" };
            format!("{noun}{plural} {}{more}", names.join(", "))
        })
        .collect();
    parts.join(" and ")
}

/// Returns the diagnostics of redundant equations that are left out because the user allows it.
pub fn left_out(system: &ConstraintSystem, dependents: &[Dependent]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for group in by_declaration(system, dependents) {
        let index = declaration_of(system, group);
        let declaration = &system.declarations()[index];
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

/// Returns a diagnostic of the first requested force that is not determined.
pub fn shared_force(system: &ConstraintSystem, shared: &[Shared]) -> Option<Diagnostic> {
    let reactions = system.reactions().iter().map(|of| (of.value, format!("`{}`", of.name), of.span));
    let measures = system.measures().iter().map(|of| (of.value, format!("measure `{}`", of.name), of.span));
    let results = system.results().reductions.iter().map(|of| (of.of, "what a result asks for".to_owned(), of.span));
    let of = |value: ExprId| shared.iter().find(|shared| shared.formula == value);
    let mut requested = reactions.chain(measures).chain(results);
    let (shared, name, span) = requested.find_map(|(value, name, span)| Some((of(value)?, name, span)))?;
    let mut of_loop: Vec<DeclarationId> = shared.rows.iter().map(|&row| system.rows()[row].declaration).collect();
    of_loop.dedup();
    of_loop.retain(|&declaration| system.declarations()[declaration].span != span);
    let message = format!("{name} is not determined: its loop has redundant equations");
    let diagnostic = Diagnostic::new(Code::E0509, message).at(span, "asks how the load is shared");
    let diagnostic = with_places(diagnostic, system, &of_loop, ["shares it in any way", "these share it in any way"]);
    Some(
        diagnostic
            .help("replace a redundant joint by one that leaves more freedom, or ask for forces outside of the loop"),
    )
}

/// Returns the diagnostic of a part that has too many equations for a search of redundant ones.
pub fn too_large(mut diagnostic: Diagnostic, rows: usize, limit: usize) -> Diagnostic {
    diagnostic.help.clear();
    diagnostic
        .note(format!("redundant equations are looked for among up to {limit} that hang together, and here are {rows}"))
        .help("leave redundant joints away by hand; or drive parts of the mechanism on their own, so that fewer equations hang together")
}

/// Returns the diagnostic of an equation that holds in a position in which no small motion changes it, though the equations on which it
/// depends do not imply it.
pub fn touching(system: &ConstraintSystem, dependent: &Dependent, t: f64) -> Diagnostic {
    let group = std::slice::from_ref(dependent);
    let (index, on) = (declaration_of(system, group), depends_on(system, group));
    let declaration = &system.declarations()[index];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let message = format!("the equations are not independent, at {} or at any other time", at(t));
    let diagnostic = Diagnostic::new(Code::E0504, message)
        .at(declaration.span, "holds, but no small motion of any body changes it there");
    let diagnostic = with_places(diagnostic, system, &on, ["beside this", "beside these"]);
    count_data(diagnostic, system, index)
        .note(format!(
            "what {noun} `{name}` fixes it fixes at the end of its reach, where the motion is not determined"
        ))
        .help(format!("change a length, so that {noun} `{name}` is not stretched out; or put a joint in its place"))
        .datum("t", t)
}

/// Returns the diagnostic of an equation that was left out and no longer follows from the others.
pub fn ceases_to_hold(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let declaration = &system.declarations()[system.checks()[index].declaration];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    Diagnostic::new(Code::E0611, format!("{noun} `{name}`, which was left out, ceases to hold at {}", at(t)))
        .at(declaration.span, "redundant at the start, but not here")
        .help(format!("`{name}` conflicts with the others: take one of them away"))
        .datum("t", t)
}

/// Help for equations that do not close.
const NEARER_TO_THE_START: &str = "draw the bodies nearer to where they are when the motion begins";
/// Help for redundant gears that do not fit.
const MESHES_AS_DRAWN: &str =
    "it meshes as the poses in `at` have it: write these as formulas, or with twelve digits, so that all fit";

fn meshes(kind: DeclarationKind) -> bool {
    matches!(kind, DeclarationKind::Joint(joint) if joint.rolls())
}

/// Returns the diagnostic of an equation that was left out and does not hold where the others are assembled.
pub fn does_not_hold(system: &ConstraintSystem, index: usize, t: f64) -> Diagnostic {
    let declaration = &system.declarations()[system.checks()[index].declaration];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let message = format!("the mechanism cannot be assembled at {}: {noun} `{name}` does not hold there", at(t));
    Diagnostic::new(Code::E0601, message)
        .at(declaration.span, "redundant, and open where all others are closed")
        .help(if meshes(declaration.kind) { MESHES_AS_DRAWN } else { NEARER_TO_THE_START })
        .datum("t", t)
}

/// Labels at drivers that have no motion to prescribe.
const NOTHING_TO_MOVE: [&str; 2] = ["has nothing left to move", "have nothing left to move"];
/// Largest number of redundant declarations in a headline.
const MAX_LISTED_FAULTS: usize = 2;

/// Adds the free motions to the diagnostic of a system with too few equations.
pub fn too_few(mut diagnostic: Diagnostic, system: &ConstraintSystem, freedom: &Freedom) -> Diagnostic {
    if freedom.degrees() == 0 {
        return diagnostic;
    }
    diagnostic.notes.extend(freedom.in_words(system));
    let helps = freedom.helps();
    if !helps.is_empty() {
        diagnostic.help = helps;
        diagnostic.drives = freedom.drives().to_vec();
    }
    diagnostic
}

/// Returns a diagnostic of redundant equations together with coordinates that no equation fixes.
pub fn too_many_and_too_few(system: &ConstraintSystem, dependents: &[Dependent], freedom: &Freedom) -> Diagnostic {
    let groups = grouped(system, dependents);
    let faults: Vec<Culprit> = groups.iter().map(|(group, _)| fault_of(system, group)).collect();
    let named: Vec<DeclarationId> = faults.iter().map(|fault| fault.declaration).collect();
    let is_conflict = groups.iter().any(|(group, _)| group.iter().any(|one| one.open.is_some()));
    let mut diagnostic = headline_of_both(system, &faults, freedom.degrees());
    let on: Vec<DeclarationId> =
        groups.iter().flat_map(|(group, _)| depends_on(system, group)).filter(|k| !named.contains(k)).collect();
    let label = if is_conflict {
        ["it conflicts with this", "it conflicts with these"]
    } else {
        ["this holds it already", "these hold it already"]
    };
    diagnostic = with_places(diagnostic, system, &on, label);
    for (_, stuck) in &groups {
        diagnostic = with_places(diagnostic, system, stuck, NOTHING_TO_MOVE);
    }
    for &body in freedom.moving().iter().take(MOST_NAMED) {
        diagnostic = diagnostic.also(system.bodies()[body].span, "can still move");
    }
    let (n, m) = (system.coordinates().len(), system.rows().len());
    diagnostic = diagnostic.note(format!("{n} coordinates, {m} equations: NDOF = {}", system.ndof()));
    diagnostic.notes.extend(freedom.in_words(system));
    if let Some((group, stuck)) = groups.first() {
        let declaration = &system.declarations()[declaration_of(system, group)];
        let mend = if is_conflict || !stuck.is_empty() { take_away(declaration) } else { mend(system, group) };
        diagnostic = diagnostic.help(mend);
    }
    diagnostic.help.extend(freedom.helps());
    let named = named.iter().map(|&k| system.declarations()[k].name.clone()).collect::<Vec<String>>();
    let free = freedom.moving().iter().map(|&body| system.bodies()[body].name.clone()).collect::<Vec<String>>();
    diagnostic
        .drives(freedom.drives().to_vec())
        .datum("coordinates", n)
        .datum("equations", m)
        .datum("ndof", system.ndof())
        .redundant(named)
        .datum("free", free)
}

/// Returns a diagnostic whose headline names the faults of declarations and the degrees of freedom that are left.
fn headline_of_both(system: &ConstraintSystem, faults: &[Culprit], degrees: usize) -> Diagnostic {
    let left = match degrees {
        1 => "1 degree of freedom is left".to_owned(),
        n => format!("{n} degrees of freedom are left"),
    };
    let headlines: Vec<&str> = faults.iter().take(MAX_LISTED_FAULTS).map(|fault| fault.headline.as_str()).collect();
    let more = match faults.len().saturating_sub(MAX_LISTED_FAULTS) {
        0 => String::new(),
        more => format!(", so are {more} more"),
    };
    let mut diagnostic = Diagnostic::new(Code::E0503, format!("{}{more}, and yet {left}", headlines.join(", ")));
    for (k, fault) in faults.iter().enumerate().take(LISTED) {
        let span = system.declarations()[fault.declaration].span;
        diagnostic = if k == 0 { diagnostic.at(span, &fault.label) } else { diagnostic.also(span, &fault.label) };
    }
    diagnostic
}

/// A declaration of dependent rows, with the words for its fault.
struct Culprit {
    declaration: DeclarationId,
    headline: String,
    /// Label at its span.
    label: String,
}

fn fault_of(system: &ConstraintSystem, group: &[Dependent]) -> Culprit {
    let declaration = declaration_of(system, group);
    let widest = group.iter().filter_map(|one| Some((one, one.open?))).max_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let (headline, label) = match widest {
        Some((one, (by, t))) => (headline_of_conflict(system, group, true), gap_in_words(system, one.row, by, t)),
        None => (headline_of_redundant(system, group), "says nothing new".to_owned()),
    };
    Culprit { declaration, headline, label }
}

/// Describes how far a row is off at a time (s).
fn gap_in_words(system: &ConstraintSystem, row: usize, by: f64, t: f64) -> String {
    let by = if gap_kind(system, row) == CoordinateKind::Length { length(by) } else { degrees(by) };
    format!("off by {by} at {}", at(t))
}
