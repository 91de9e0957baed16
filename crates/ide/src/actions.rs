//! What can be done about a place: fixes of what is wrong there, and changes that keep what the text means.

use super::completion::{free, free_name};
use super::diagnostics::{DiagnosticStage, ProposedFix, EditorDiagnostic, diagnostics};
use super::trial_edits::{applied, faults, first_new, text_of};
use super::location::{Change, FilePosition, FileRange};
use super::snapshot::Snapshot;
use mechc_syntax::ast::{Expr, ExprKind, Factor, Item, ItemKind, Mechanism};
use mechc_text::cancel::Cancel;
use mechc_text::source::Span;
use mechc_text::vocabulary::{Dimension, Unit};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// What can be done.
#[derive(Clone, PartialEq, Debug)]
pub struct Action {
    /// As it is offered.
    pub title: String,
    /// What it is.
    pub kind: ActionKind,
    /// Whether it is what was meant, beyond doubt.
    pub is_preferred: bool,
    /// What it mends.
    pub mends: Option<EditorDiagnostic>,
    /// What it changes.
    pub changes: Vec<Change>,
}

/// What an action is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ActionKind {
    /// Mends a fault.
    Fix,
    /// Makes all fixes of a file that always apply.
    FixAll,
    /// Gives a number a name.
    Extract,
    /// Adds what takes a freedom.
    Drive,
}

/// What can be done about a stretch of a file: fixes of what its words and the proof say there, and refactorings.
#[must_use]
pub fn actions(snapshot: &Snapshot, path: &Arc<Path>, range: &Range<u32>) -> Option<Vec<Action>> {
    let words = diagnostics(snapshot, path, DiagnosticStage::Words, &Cancel::default)?;
    let proof = diagnostics(snapshot, path, DiagnosticStage::Proof, &Cancel::default)?;
    let mut all: Vec<&EditorDiagnostic> = words.iter().collect();
    all.extend(proof.iter().filter(|said| !words.contains(said)));
    let touches = |said: &&EditorDiagnostic| said.range.start <= range.end && range.start <= said.range.end;
    let mut found: Vec<Action> = all.iter().copied().filter(touches).flat_map(of_fault).collect();
    found.extend(fix_all(path, &all));
    found.extend(extract_param(snapshot, path, range));
    let position = FilePosition { path: Arc::clone(path), offset: range.start };
    found.extend(drive_joint(snapshot, &position).unwrap_or_default());
    Some(found)
}

fn of_fault(said: &EditorDiagnostic) -> Vec<Action> {
    let action = |fix: &ProposedFix| Action {
        title: if fix.message.is_empty() { format!("mend: {}", said.message) } else { fix.message.clone() },
        kind: ActionKind::Fix,
        is_preferred: fix.is_certain,
        mends: Some(said.clone()),
        changes: fix.changes.clone(),
    };
    said.fixes.iter().map(action).collect()
}

/// All fixes of a file that always apply; of those that overlap the first one.
fn fix_all(path: &Arc<Path>, all: &[&EditorDiagnostic]) -> Option<Action> {
    let mut changes: Vec<Change> = Vec::new();
    for fix in all.iter().flat_map(|said| &said.fixes).filter(|fix| fix.is_certain) {
        let is_free = |new: &Change| changes.iter().all(|old| !overlap(&old.location, &new.location));
        let is_here = |change: &Change| change.location.path == *path;
        if fix.changes.iter().all(|change| is_here(change) && is_free(change)) {
            changes.extend(fix.changes.iter().cloned());
        }
    }
    changes.sort_by_key(|change| change.location.start);
    let title = "make all fixes that always apply".to_owned();
    (!changes.is_empty()).then_some(Action {
        title,
        kind: ActionKind::FixAll,
        is_preferred: false,
        mends: None,
        changes,
    })
}

/// Whether two stretches share text, or a place where something would be put in.
fn overlap(a: &FileRange, b: &FileRange) -> bool {
    a.path == b.path && (a.start < b.end && b.start < a.end || a.start == b.start)
}

/// A number with its unit becomes a param, in front of the declaration that needs it, if the text then checks as before.
fn extract_param(snapshot: &Snapshot, path: &Arc<Path>, range: &Range<u32>) -> Option<Action> {
    let parsed = snapshot.parsed(path)?;
    let holds = |start: u32, end: u32| start <= range.start && range.end <= end;
    let mechanism = parsed.tree().mechanisms.iter().find(|one| holds(one.span.start, one.span.end))?;
    let item = mechanism.items.iter().find(|item| holds(item.span.start, item.span.end))?;
    let Quantity { span, dimension } = quantities(item).into_iter().find(|one| holds(one.span.start, one.span.end))?;
    // a param that is only this number has a name already
    if matches!(&item.kind, ItemKind::Param { value, .. } if value.bare().span == span) {
        return None;
    }
    let name = free_name(mechanism, &[name_for(item, span, dimension)]);
    let text = text_of(snapshot, path)?;
    let value = text.get(span.start as usize..span.end as usize)?;
    let (at, before, behind) = place_for_param(mechanism, item, &text)?;
    let stretch = |start: u32, end: u32| FileRange { path: Arc::clone(path), start, end };
    let changes = vec![
        Change { location: stretch(at, at), text: format!("{before}param {name} = {value}{behind}") },
        Change { location: stretch(span.start, span.end), text: name.clone() },
    ];
    let after = applied(snapshot, &changes)?;
    let files = [Arc::clone(path)];
    let is_as_before = first_new(&faults(snapshot, &files), &faults(&after, &files)).is_none();
    let title = format!("extract `{value}` into a param");
    is_as_before.then_some(Action { title, kind: ActionKind::Extract, is_preferred: false, mends: None, changes })
}

/// A number with all of its unit: `90 deg/s`.
#[derive(Clone, Copy)]
struct Quantity {
    span: Span,
    dimension: Dimension,
}

/// The numbers with units in the formulas of a declaration; of a product its longest stretch first.
fn quantities(item: &Item) -> Vec<Quantity> {
    let mut found = Vec::new();
    for e in item.formulas().into_iter().flat_map(Expr::parts) {
        match &e.kind {
            ExprKind::Product(first, rest) => found.extend(compound(first, rest)),
            _ => found.extend(plain(e)),
        }
    }
    found.sort_by_key(|one: &Quantity| (one.span.start, std::cmp::Reverse(one.span.end)));
    found
}

/// A number with the unit right behind it.
fn plain(e: &Expr) -> Option<Quantity> {
    let ExprKind::Literal { unit: Some((unit, power)), .. } = &e.kind else { return None };
    let dimension = Unit::named(&unit.text)?.dimension.to_the(f64::from(*power));
    Some(Quantity { span: e.span, dimension })
}

/// The numbers of a product that units are multiplied with, or divided by, behind them. One that something is divided by ends with its
/// own unit: `1 / 2 s * m` multiplies with metres.
fn compound(first: &Expr, rest: &[(Factor, Expr)]) -> Vec<Quantity> {
    let mut found: Vec<Quantity> = plain(first).into_iter().collect();
    let mut is_open = !found.is_empty();
    for (factor, operand) in rest {
        let begun = plain(operand).filter(|_| *factor == Factor::Times);
        let last = found.last_mut().filter(|_| is_open).zip(unit(operand));
        is_open = begun.is_some() || last.is_some();
        match (begun, last) {
            (Some(begun), _) => found.push(begun),
            (None, Some((last, dimension))) => {
                last.span = last.span.to(operand.span);
                last.dimension = match factor {
                    Factor::Times => last.dimension.times(dimension),
                    Factor::Over => last.dimension.over(dimension),
                };
            }
            (None, None) => {}
        }
    }
    found
}

/// The dimension of a unit that stands alone, with its power.
fn unit(e: &Expr) -> Option<Dimension> {
    match &e.kind {
        ExprKind::Name(name) => Some(Unit::named(&name.text)?.dimension),
        ExprKind::Power(base, power) => Some(unit(base)?.to_the(power.bare_number()?)),
        _ => None,
    }
}

/// A name for a number of a declaration.
fn name_for(item: &Item, quantity: Span, dimension: Dimension) -> &'static str {
    const NAMES: &[(Dimension, &str)] = &[
        (Dimension::PURE, "angle"),
        (Dimension::LENGTH, "length"),
        (Dimension::TIME, "duration"),
        (Dimension::RATE, "rate"),
        (Dimension::ANGULAR_ACCELERATION, "angular_acceleration"),
        (Dimension::SPEED, "speed"),
        (Dimension::ACCELERATION, "acceleration"),
    ];
    match &item.kind {
        ItemKind::Analysis { every, .. } if every.span.start <= quantity.start => "time_step",
        ItemKind::Analysis { from, .. } if quantity.end <= from.span.end => "start_time",
        ItemKind::Analysis { .. } => "end_time",
        _ => NAMES.iter().find(|(known, _)| known.is(dimension)).map_or("amount", |(_, name)| name),
    }
}

/// Where a param goes, and what stands around it: behind the last one before a declaration, else in front of what comes first.
fn place_for_param(mechanism: &Mechanism, item: &Item, text: &str) -> Option<(u32, String, String)> {
    let is_before = |other: &&Item| matches!(other.kind, ItemKind::Param { .. }) && other.span.end <= item.span.start;
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    if let Some(param) = mechanism.items.iter().rfind(is_before) {
        let Some(indent) = indent_of(text, param.span) else {
            return Some((param.span.end, " ".to_owned(), String::new()));
        };
        // a comment behind the param stays on its line
        return Some((end_of_line(text, param.span)?, format!("{end}{indent}"), String::new()));
    }
    let first = mechanism.items.first()?;
    let Some(indent) = indent_of(text, first.span) else {
        return Some((first.span.start, String::new(), " ".to_owned()));
    };
    // the lines of documentation above belong to the declaration
    let line = first.span.start as usize - indent.len();
    let lines = text.get(..line)?.split_inclusive('\n').rev();
    let docs = lines.take_while(|line| line.trim_start().starts_with("///")).map(str::len).sum::<usize>();
    Some(((line - docs) as u32, indent.to_owned(), end.to_owned()))
}

/// What stands before a declaration on its line, where that is only white space.
fn indent_of(text: &str, declaration: Span) -> Option<&str> {
    let before = text.get(..declaration.start as usize)?;
    let indent = before.get(before.rfind('\n')? + 1..)?;
    indent.trim().is_empty().then_some(indent)
}

/// The end of a declaration, or of the comment behind it.
fn end_of_line(text: &str, declaration: Span) -> Option<u32> {
    let behind = text.get(declaration.end as usize..)?;
    let rest = behind.find(['\n', '\r']).unwrap_or(behind.len());
    let is_comment = behind.get(..rest)?.trim_start().starts_with("//");
    Some(declaration.end + if is_comment { rest as u32 } else { 0 })
}

/// Drivers for the joint at a place, each for one of its copies, where the proof says that they would take what is left free.
fn drive_joint(snapshot: &Snapshot, position: &FilePosition) -> Option<Vec<Action>> {
    let parsed = snapshot.parsed(&position.path)?;
    let holds = |start: u32, end: u32| start <= position.offset && position.offset <= end;
    let mechanism = parsed.tree().mechanisms.iter().find(|one| holds(one.span.start, one.span.end))?;
    let item = mechanism.items.iter().find(|item| holds(item.span.start, item.span.end))?;
    let ItemKind::Joint { name, .. } = &item.kind else { return None };
    let text = text_of(snapshot, &position.path)?;
    let last = mechanism.items.iter().rfind(|item| matches!(item.kind, ItemKind::Joint { .. }))?;
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let before = indent_of(&text, last.span).map_or(" ".to_owned(), |indent| format!("{end}{indent}"));
    let driver = free_name(mechanism, &["motor", "drive", "feed"]);
    let at = end_of_line(&text, last.span)?;
    let action = |(driven, formula): (String, String)| {
        let copy = copy_of(&name.text, &driven)?;
        let position = FileRange { path: Arc::clone(&position.path), start: at, end: at };
        let changes = vec![Change { location, text: format!("{before}driver {driver}: {driven} = {formula}") }];
        let title = format!("drive `{copy}`");
        Some(Action { title, kind: ActionKind::Drive, is_preferred: false, mends: None, changes })
    };
    Some(free(snapshot, position)?.into_iter().filter_map(action).collect())
}

/// The joint that a quantity is about, if it is the one of a name, or a copy of it: `pin[1]` of `rotation(pin[1])`.
fn copy_of<'d>(name: &str, driven: &'d str) -> Option<&'d str> {
    let joint = driven.split_once('(')?.1.strip_suffix(')')?;
    let numbers = joint.strip_prefix(name)?;
    (numbers.is_empty() || numbers.starts_with('[')).then_some(joint)
}

#[cfg(test)]
mod tests {
    use super::{Action, actions};
    use crate::trial_edits::{applied, text_of};
    use crate::testing::{FOUR_BAR, at_cursor};
    use crate::{DiagnosticStage, Snapshot, diagnostics};
    use mechc_text::cancel::Cancel;
    use std::path::Path;

    /// All that is offered at a cursor, each with the lines that it writes.
    fn offered(text: &str) -> String {
        let (snapshot, position) = at_cursor(text);
        let range = position.offset..position.offset;
        let found = actions(&snapshot, &position.path, &range).expect("a file");
        let before = count(&snapshot, &position.path);
        let told = |action: &Action| {
            let after = applied(&snapshot, &action.changes).expect("it can be made");
            assert!(count(&after, &position.path) <= before, "{} brings faults", action.title);
            let [old, new] = [&snapshot, &after].map(|one| text_of(one, &position.path).expect("a text"));
            let mark = if action.is_preferred { "!" } else { "" };
            let written = new.lines().filter(|line| !old.lines().any(|old| old == *line));
            format!("{:?}{mark} {}\n{}", action.kind, action.title, written.collect::<Vec<_>>().join("\n"))
        };
        found.iter().map(told).collect::<Vec<_>>().join("\n")
    }

    /// How many faults the first two stages find.
    fn count(snapshot: &Snapshot, path: &Path) -> usize {
        let of = |stage| diagnostics(snapshot, path, stage, &Cancel::default).expect("a file").len();
        of(DiagnosticStage::Words) + of(DiagnosticStage::Proof)
    }

    fn with(from: &str, to: &str) -> String {
        assert!(FOUR_BAR.contains(from), "{from}");
        FOUR_BAR.replacen(from, to, 1)
    }

    #[test]
    fn what_is_wrong_is_mended() {
        insta::assert_snapshot!(offered(&with("crank.B, c", "crnk$0.B, c")), @r"
        Fix was `crank` meant?
            joint pin:   revolute(crank.B, coupler.B)
        ");
        let twice = with("60 deg + 90", "60° + 90").replacen("revolute(crank.B,", "revolute($0crank.B;", 1);
        insta::assert_snapshot!(offered(&twice), @r"
        FixAll make all fixes that always apply
            joint pin:   revolute(crank.B, coupler.B)
            driver motor: rotation(main) = 60 deg + 90 deg/s * t
        ");
    }

    #[test]
    fn a_number_becomes_a_param() {
        insta::assert_snapshot!(offered(&with("(80 mm, 0)", "(8$00 mm, 0)")), @r"
        Extract extract `80 mm` into a param
            param length = 80 mm
                point C = (length, 0)
        ");
        insta::assert_snapshot!(offered(&with("every 0.1 s", "every 0.1 $0s")), @r"
        Extract extract `0.1 s` into a param
            param time_step = 0.1 s
            analysis from 0 s to 4 s every time_step
        ");
        insta::assert_snapshot!(offered(&with("    param crank_length = 30 mm\n", "").replace("crank_length", "3$00 mm")), @r"
        Extract extract `30 mm` into a param
            param length = 30 mm
                point B = (length, 0)
        ");
        insta::assert_snapshot!(offered("mechanism m { body b { point P = (1$0 m, 0) } driver d: angle(b) = 1 rad/s * t }"), @r"
        Extract extract `1 m` into a param
        mechanism m { param length = 1 m body b { point P = (length, 0) } driver d: angle(b) = 1 rad/s * t }
        ");
        insta::assert_snapshot!(offered(&with("crank_length = 30 mm", "crank_length = 3$00 mm // long")), @"");
        insta::assert_snapshot!(offered(&with("crank_length = 30 mm", "crank_length = 30 mm // long").replacen("80 mm", "80$0 mm", 1)), @r"
        Extract extract `80 mm` into a param
            param length = 80 mm
                point C = (length, 0)
        ");
    }

    #[test]
    fn a_number_is_taken_with_all_of_its_unit() {
        insta::assert_snapshot!(offered(&with("90 deg/s", "90 deg/$0s")), @r"
        Extract extract `90 deg/s` into a param
            param rate = 90 deg/s
            driver motor: rotation(main) = 60 deg + rate * t
        ");
        insta::assert_snapshot!(offered(&with("60 deg +", "6$00 deg +")), @r"
        Extract extract `60 deg` into a param
            param angle = 60 deg
            driver motor: rotation(main) = angle + 90 deg/s * t
        ");
        let with_measure = |formula: &str| with("    analysis", &format!("    measure v = {formula}\n    analysis"));
        insta::assert_snapshot!(offered(&with_measure("x(crank.B) + 9.81 m/s^$02 * t^2")), @r"
        Extract extract `9.81 m/s^2` into a param
            param acceleration = 9.81 m/s^2
            measure v = x(crank.B) + acceleration * t^2
        ");
        insta::assert_snapshot!(offered(&with_measure("x(crank.B) / 2 $0s / s * s")), @r"
        Extract extract `2 s` into a param
            param duration = 2 s
            measure v = x(crank.B) / duration / s * s
        ");
        insta::assert_snapshot!(offered(&with_measure("angle(crank) * 3 mm/s * 2 $0s")), @r"
        Extract extract `2 s` into a param
            param duration = 2 s
            measure v = angle(crank) * 3 mm/s * duration
        ");
    }

    #[test]
    fn a_joint_is_driven_from_where_it_is_drawn() {
        let free = with("    driver motor: rotation(main) = 60 deg + 90 deg/s * t\n", "");
        insta::assert_snapshot!(offered(&free.replacen("joint main", "joint ma$0in", 1)), @r"
        Drive drive `main`
            driver motor: rotation(main) = 60 deg + 60 deg/s * t
        ");
        insta::assert_snapshot!(offered(&free.replacen("joint pivot", "joint pi$0vot", 1)), @r"
        Drive drive `pivot`
            driver motor: rotation(pivot) = 100 deg + 60 deg/s * t
        ");
        // of a repeated joint each copy
        let chain = "\
mechanism chain {
    ground { point O = (0, 0) }
    body link[k in 0..2] at (k * 100 mm, 0, 0) {
        point A = (0, 0)
        point B = (100 mm, 0)
    }
    joint root: revolute(ground.O, link[0].A)
    joint pi$0n[k in 0..1]: revolute(link[k].B, link[k + 1].A)
    driver motor: rotation(root) = 60 deg/s * t
}
";
        insta::assert_snapshot!(offered(chain), @r"
        Drive drive `pin[0]`
            driver drive: rotation(pin[0]) = 60 deg/s * t
        ");
        // all is driven already
        assert_eq!(offered(&with("joint main", "joint ma$0in")), "");
    }
}
