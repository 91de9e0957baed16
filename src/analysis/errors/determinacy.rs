//! Too many equations, too few, or both.

use super::{LISTED, at, degrees, gap_kind, length, named_all};
use crate::analysis::freedom::Freedom;
use crate::analysis::redundancy::Dependent;
use crate::diag::{Code, Diagnostic, Diagnostics};
use crate::ir::{ConstraintSystem, CoordinateKind, DeclarationKind};

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
    let rows = group.iter().flat_map(|one| &one.on).map(|&row| system.rows[row].declaration);
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

fn headline_of_redundant(system: &ConstraintSystem, group: &[Dependent]) -> String {
    let declaration = &system.declarations[group.first().map_or(0, |one| system.rows[one.row].declaration)];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    match group.len() {
        k if k == declaration.rows => format!("{noun} `{name}` is redundant"),
        1 => format!("1 equation of {noun} `{name}` is redundant"),
        k => format!("{k} equations of {noun} `{name}` are redundant"),
    }
}

fn redundant(system: &ConstraintSystem, group: &[Dependent]) -> Diagnostic {
    let on = depends_on(system, group);
    let index = group.first().map_or(0, |one| system.rows[one.row].declaration);
    let declaration = &system.declarations[index];
    let them = if group.len() == 1 || group.len() == declaration.rows { "it" } else { "them" };
    let message = format!("{}: the others hold {them} already", headline_of_redundant(system, group));
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
        DeclarationKind::Joint("revolute") => sliding_pin(system, index).unwrap_or_else(|| {
            format!(
                "let the pin of `{name}` slide along the line between the pins of its link: \
                 `joint {name}: revolute_translational(P, axis)`, with an axis along that line"
            )
        }),
        DeclarationKind::Joint("translational") => format!(
            "let `{name}` hold a point on the axis, and not the angle too: `joint {name}: revolute_translational(P, axis)`"
        ),
        DeclarationKind::Joint("weld") => {
            format!("let `{name}` hold the point, and not the angle too: `joint {name}: revolute(P, Q)`")
        }
        _ => whole,
    }
}

/// A link of two pins, one of which is a redundant joint: its length is what says nothing new, so let the pin slide along it.
fn sliding_pin(system: &ConstraintSystem, index: usize) -> Option<String> {
    let joint = &system.declarations[index];
    let &[p, q] = joint.points.as_slice() else {
        return None;
    };
    let full_name = |point: usize| {
        let point = &system.points[point];
        let owner = point.body.map_or("ground", |body| system.bodies[body].name.as_str());
        point.name.as_ref().map(|name| format!("{owner}.{name}"))
    };
    [(p, q), (q, p)].into_iter().find_map(|(own, other)| {
        let body = system.points[own].body?;
        let on_body = |point: &&usize| system.points[**point].body == Some(body);
        let pins: Vec<usize> =
            system.declarations.iter().filter_map(|one| one.points.iter().find(on_body)).copied().collect();
        let &[far] = pins.iter().copied().filter(|&pin| pin != own).collect::<Vec<usize>>().as_slice() else {
            return None;
        };
        let (body, from, to) =
            (&system.bodies[body].name, system.points[far].name.as_ref()?, system.points[own].name.as_ref()?);
        Some(format!(
            "let its pin slide along `{body}`: write `axis slot = {from} to {to}` in `{body}`, \
             and `joint {}: revolute_translational({}, {body}.slot)`",
            joint.name,
            full_name(other)?
        ))
    })
}

fn conflicting(system: &ConstraintSystem, group: &[Dependent], one: &Dependent, by: f64, t: f64) -> Diagnostic {
    let on = depends_on(system, group);
    let index = system.rows[one.row].declaration;
    let declaration = &system.declarations[index];
    let by = gap_in_words(system, one.row, by);
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

/// Bodies that can move, marked at most.
const MOST_MOVING: usize = 3;

/// What values add to a count that leaves freedom.
pub fn too_few(mut diagnostic: Diagnostic, system: &ConstraintSystem, freedom: &Freedom) -> Diagnostic {
    if freedom.degrees() == 0 {
        return diagnostic;
    }
    diagnostic.notes.extend(freedom.in_words(system));
    let helps = freedom.helps();
    if !helps.is_empty() {
        diagnostic.help = helps;
    }
    diagnostic
}

/// Equations too many beside coordinates that nothing fixes.
pub fn too_many_and_too_few(system: &ConstraintSystem, dependents: &[Dependent], freedom: &Freedom) -> Diagnostic {
    let groups: Vec<&[Dependent]> =
        dependents.chunk_by(|a, b| system.rows[a.row].declaration == system.rows[b.row].declaration).collect();
    let faults: Vec<(usize, String, String)> = groups.iter().map(|group| fault_of(system, group)).collect();
    let left = match freedom.degrees() {
        1 => "1 degree of freedom is left".to_owned(),
        n => format!("{n} degrees of freedom are left"),
    };
    let more = if faults.len() > 1 { format!(" (and {} more)", faults.len() - 1) } else { String::new() };
    let headline = faults.first().map_or(String::new(), |(_, headline, _)| headline.clone());
    let mut diagnostic = Diagnostic::new(Code::E0503, format!("{headline}{more}, and yet {left}"));
    for (k, (declaration, _, label)) in faults.iter().enumerate().take(LISTED) {
        let span = system.declarations[*declaration].span;
        diagnostic = if k == 0 { diagnostic.at(span, label) } else { diagnostic.also(span, label) };
    }
    let named: Vec<usize> = faults.iter().map(|fault| fault.0).collect();
    let on: Vec<usize> =
        groups.iter().flat_map(|group| depends_on(system, group)).filter(|k| !named.contains(k)).collect();
    for (k, &other) in on.iter().take(LISTED).enumerate() {
        diagnostic =
            diagnostic.also(system.declarations[other].span, if k == 0 { "these hold it already" } else { "" });
    }
    for &body in freedom.moving().iter().take(MOST_MOVING) {
        diagnostic = diagnostic.also(system.bodies[body].span, "can still move");
    }
    for sentence in freedom.in_words(system) {
        diagnostic = diagnostic.note(sentence);
    }
    if let Some(group) = groups.first() {
        diagnostic = diagnostic.help(mend(system, group));
    }
    for help in freedom.helps() {
        diagnostic = diagnostic.help(help);
    }
    let names = |list: Vec<usize>| list.iter().map(|&k| system.declarations[k].name.clone()).collect::<Vec<String>>();
    let free = freedom.moving().iter().map(|&body| system.bodies[body].name.clone()).collect::<Vec<String>>();
    diagnostic
        .datum("coordinates", system.coordinates.len())
        .datum("equations", system.rows.len())
        .datum("ndof", system.ndof())
        .datum("redundant", names(named))
        .datum("free", free)
}

/// The declaration of a group of dependent rows, what is the matter with it, and a word beside its place.
fn fault_of(system: &ConstraintSystem, group: &[Dependent]) -> (usize, String, String) {
    let index = group.first().map_or(0, |one| system.rows[one.row].declaration);
    let declaration = &system.declarations[index];
    let widest = group.iter().filter_map(|one| Some((one, one.open?))).max_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    match widest {
        Some((one, (by, t))) => {
            let by = gap_in_words(system, one.row, by);
            let on = depends_on(system, group);
            let others = named_all(system, &on[..on.len().min(3)]);
            (index, format!("{noun} `{name}` cannot hold beside {others}"), format!("off by {by} at {}", at(t)))
        }
        None => (index, headline_of_redundant(system, group), "says nothing new".to_owned()),
    }
}

fn gap_in_words(system: &ConstraintSystem, row: usize, by: f64) -> String {
    if gap_kind(system, row) == CoordinateKind::Length { length(by) } else { degrees(by) }
}
