//! Code actions: fixes of diagnostics, and refactorings that keep the meaning of the text.

use super::completion::{free_name, free_quantities};
use super::diagnostics::{DiagnosticStage, EditorDiagnostic, ProposedFix, diagnostics};
use super::location::{Change, FilePosition, FileRange};
use super::snapshot::Snapshot;
use super::trial_edits::{apply, first_new, text_of, word_diagnostics};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Item, ItemKind, Mechanism};
use mechc_text::cancel::Cancel;
use mechc_text::source::Span;
use mechc_text::vocabulary::{Dimension, Unit};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A code action.
#[derive(Clone, PartialEq, Debug)]
pub struct Action {
    /// The title in menus.
    pub title: String,
    /// The kind of action.
    pub kind: ActionKind,
    /// True if it is certainly what the user intends.
    pub is_preferred: bool,
    /// The diagnostic that it fixes.
    pub fixes: Option<EditorDiagnostic>,
    /// The changes that it makes.
    pub changes: Vec<Change>,
}

/// The kinds of actions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ActionKind {
    /// Fixes a diagnostic.
    Fix,
    /// Applies all fixes of a file that always apply.
    FixAll,
    /// Extracts a number into a param.
    Extract,
    /// Adds a driver for a free joint.
    Drive,
}

/// Returns the actions for a range of a file: fixes of the diagnostics of the first two stages, and refactorings.
#[must_use]
pub fn actions(snapshot: &Snapshot, path: &Arc<Path>, range: &Range<u32>) -> Option<Vec<Action>> {
    let words = diagnostics(snapshot, path, DiagnosticStage::Words, &Cancel::default)?;
    let proof = diagnostics(snapshot, path, DiagnosticStage::Proof, &Cancel::default)?;
    let mut all: Vec<&EditorDiagnostic> = words.iter().collect();
    all.extend(proof.iter().filter(|diagnostic| !words.contains(diagnostic)));
    let touches =
        |diagnostic: &&EditorDiagnostic| diagnostic.range.start <= range.end && range.start <= diagnostic.range.end;
    let mut actions: Vec<Action> = all.iter().copied().filter(touches).flat_map(fixes_of).collect();
    actions.extend(fix_all(path, &all));
    actions.extend(extract_param(snapshot, path, range));
    let position = FilePosition { path: Arc::clone(path), offset: range.start };
    actions.extend(drive_joint(snapshot, &position).unwrap_or_default());
    Some(actions)
}

fn fixes_of(diagnostic: &EditorDiagnostic) -> Vec<Action> {
    let action = |fix: &ProposedFix| Action {
        title: if fix.message.is_empty() { format!("mend: {}", diagnostic.message) } else { fix.message.clone() },
        kind: ActionKind::Fix,
        is_preferred: fix.is_certain,
        fixes: Some(diagnostic.clone()),
        changes: fix.changes.clone(),
    };
    diagnostic.fixes.iter().map(action).collect()
}

/// Returns an action that applies all certain fixes of a file; of fixes that overlap, only the first is applied.
fn fix_all(path: &Arc<Path>, all: &[&EditorDiagnostic]) -> Option<Action> {
    let mut changes: Vec<Change> = Vec::new();
    for fix in all.iter().flat_map(|diagnostic| &diagnostic.fixes).filter(|fix| fix.is_certain) {
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
        fixes: None,
        changes,
    })
}

/// Returns whether two ranges share text or a point of insertion.
fn overlap(a: &FileRange, b: &FileRange) -> bool {
    a.path == b.path && (a.start < b.end && b.start < a.end || a.start == b.start)
}

/// Extracts a number with its unit into a param before the declaration that uses it, if this adds no diagnostic.
fn extract_param(snapshot: &Snapshot, path: &Arc<Path>, range: &Range<u32>) -> Option<Action> {
    let parsed = snapshot.parsed(path)?;
    let holds = |start: u32, end: u32| start <= range.start && range.end <= end;
    let mechanism = parsed.tree().mechanisms.iter().find(|one| holds(one.span.start, one.span.end))?;
    let item = mechanism.items.iter().find(|item| holds(item.span.start, item.span.end))?;
    let Quantity { span, dimension } = quantities(item).into_iter().find(|one| holds(one.span.start, one.span.end))?;
    // a param whose value is only this number names it already
    if matches!(&item.kind, ItemKind::Param { value, .. } if value.bare().span == span) {
        return None;
    }
    let name = free_name(mechanism, &[suggest_name(item, span, dimension)]);
    let text = text_of(snapshot, path)?;
    let value = text.get(span.start as usize..span.end as usize)?;
    let Insertion { at, before, behind } = param_insertion(mechanism, item, &text)?;
    let range_at = |start: u32, end: u32| FileRange { path: Arc::clone(path), start, end };
    let changes = vec![
        Change { location: range_at(at, at), text: format!("{before}param {name} = {value}{behind}") },
        Change { location: range_at(span.start, span.end), text: name.clone() },
    ];
    let after = apply(snapshot, &changes)?;
    let files = [Arc::clone(path)];
    let is_as_before = first_new(&word_diagnostics(snapshot, &files), &word_diagnostics(&after, &files)).is_none();
    let title = format!("extract `{value}` into a param");
    is_as_before.then_some(Action { title, kind: ActionKind::Extract, is_preferred: false, fixes: None, changes })
}

/// A number with its whole unit: `90 deg/s`.
#[derive(Clone, Copy)]
struct Quantity {
    span: Span,
    dimension: Dimension,
}

/// Returns the numbers with units in the formulas of a declaration, in order; of nested ones the longest first.
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

/// Returns a number that is directly followed by its unit.
fn plain(e: &Expr) -> Option<Quantity> {
    let ExprKind::Literal { unit: Some((unit, power)), .. } = &e.kind else { return None };
    let dimension = Unit::named(&unit.text)?.dimension.to_the(f64::from(*power));
    Some(Quantity { span: e.span, dimension })
}

/// Returns the numbers of a product with the units that multiply or divide them. A number in a divisor ends with its direct unit:
/// `1 / 2 s * m` multiplies by metres.
fn compound(first: &Expr, rest: &[(Factor, Expr)]) -> Vec<Quantity> {
    let mut found: Vec<Quantity> = plain(first).into_iter().collect();
    let mut is_open = !found.is_empty();
    for (factor, operand) in rest {
        let number = plain(operand).filter(|_| *factor == Factor::Times);
        let last = found.last_mut().filter(|_| is_open).zip(unit(operand));
        is_open = number.is_some() || last.is_some();
        match (number, last) {
            (Some(number), _) => found.push(number),
            (None, Some((last, dimension))) => {
                last.span = last.span.to(operand.span);
                last.dimension = match factor {
                    Factor::Times => last.dimension.times(dimension),
                    Factor::Divide => last.dimension.over(dimension),
                };
            }
            (None, None) => {}
        }
    }
    found
}

/// Returns the dimension of a unit with its power, without a number.
fn unit(e: &Expr) -> Option<Dimension> {
    match &e.kind {
        ExprKind::Name(name) => Some(Unit::named(&name.text)?.dimension),
        ExprKind::Power(base, power) => Some(unit(base)?.to_the(power.bare_number()?)),
        _ => None,
    }
}

/// Suggests a name for a number of a declaration.
fn suggest_name(item: &Item, quantity: Span, dimension: Dimension) -> &'static str {
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
        _ => NAMES.iter().find(|(other, _)| other.is(dimension)).map_or("amount", |(_, name)| name),
    }
}

/// An offset for new text, with the white space before and behind it.
struct Insertion {
    at: u32,
    before: String,
    behind: String,
}

/// Returns where to insert a param: after the last param before a declaration, else before the first declaration.
fn param_insertion(mechanism: &Mechanism, item: &Item, text: &str) -> Option<Insertion> {
    let insertion = |at, before, behind| Some(Insertion { at, before, behind });
    let is_before = |other: &&Item| matches!(other.kind, ItemKind::Param { .. }) && other.span.end <= item.span.start;
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    if let Some(param) = mechanism.items.iter().rfind(is_before) {
        let Some(indent) = indent_of(text, param.span) else {
            return insertion(param.span.end, " ".to_owned(), String::new());
        };
        // a trailing comment of the param stays on its line
        return insertion(end_of_line(text, param.span)?, format!("{end}{indent}"), String::new());
    }
    let first = mechanism.items.first()?;
    let Some(indent) = indent_of(text, first.span) else {
        return insertion(first.span.start, String::new(), " ".to_owned());
    };
    // doc comments above belong to the declaration
    let line = first.span.start as usize - indent.len();
    let lines = text.get(..line)?.split_inclusive('\n').rev();
    let docs = lines.take_while(|line| line.trim_start().starts_with("///")).map(str::len).sum::<usize>();
    insertion((line - docs) as u32, indent.to_owned(), end.to_owned())
}

/// Returns the text before a declaration on its line, if it is only white space.
fn indent_of(text: &str, declaration: Span) -> Option<&str> {
    let before = text.get(..declaration.start as usize)?;
    let indent = before.get(before.rfind('\n')? + 1..)?;
    indent.trim().is_empty().then_some(indent)
}

/// Returns the end of a declaration, including a trailing comment.
fn end_of_line(text: &str, declaration: Span) -> Option<u32> {
    let behind = text.get(declaration.end as usize..)?;
    let rest = behind.find(['\n', '\r']).unwrap_or(behind.len());
    let is_comment = behind.get(..rest)?.trim_start().starts_with("//");
    Some(declaration.end + if is_comment { rest as u32 } else { 0 })
}

/// Returns actions that drive the joint at a position, one per copy, if the proof suggests them.
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
        let location = FileRange { path: Arc::clone(&position.path), start: at, end: at };
        let changes = vec![Change { location, text: format!("{before}driver {driver}: {driven} = {formula}") }];
        let title = format!("drive `{copy}`");
        Some(Action { title, kind: ActionKind::Drive, is_preferred: false, fixes: None, changes })
    };
    Some(free_quantities(snapshot, position)?.into_iter().filter_map(action).collect())
}

/// Returns the joint of a driven quantity, if it is a given joint or a copy of it: `pin[1]` of `rotation(pin[1])`.
fn copy_of<'d>(name: &str, driven: &'d str) -> Option<&'d str> {
    let joint = driven.split_once('(')?.1.strip_suffix(')')?;
    let numbers = joint.strip_prefix(name)?;
    (numbers.is_empty() || numbers.starts_with('[')).then_some(joint)
}

#[cfg(test)]
mod tests {
    use super::{Action, actions};
    use crate::testing::{FOUR_BAR, at_cursor};
    use crate::trial_edits::{apply, text_of};
    use crate::{DiagnosticStage, Snapshot, diagnostics};
    use mechc_text::cancel::Cancel;
    use std::path::Path;

    /// Lists the actions at a cursor, each with the lines that it writes.
    fn offered(text: &str) -> String {
        let (snapshot, position) = at_cursor(text);
        let range = position.offset..position.offset;
        let found = actions(&snapshot, &position.path, &range).expect("a file");
        let before = count(&snapshot, &position.path);
        let describe = |action: &Action| {
            let after = apply(&snapshot, &action.changes).expect("it can be made");
            assert!(count(&after, &position.path) <= before, "{} adds a diagnostic", action.title);
            let [old, new] = [&snapshot, &after].map(|one| text_of(one, &position.path).expect("a text"));
            let mark = if action.is_preferred { "!" } else { "" };
            let written = new.lines().filter(|line| !old.lines().any(|old| old == *line));
            format!("{:?}{mark} {}\n{}", action.kind, action.title, written.collect::<Vec<_>>().join("\n"))
        };
        found.iter().map(describe).collect::<Vec<_>>().join("\n")
    }

    /// Counts the diagnostics of the first two stages.
    fn count(snapshot: &Snapshot, path: &Path) -> usize {
        let of = |stage| diagnostics(snapshot, path, stage, &Cancel::default).expect("a file").len();
        of(DiagnosticStage::Words) + of(DiagnosticStage::Proof)
    }

    fn with(from: &str, to: &str) -> String {
        assert!(FOUR_BAR.contains(from), "{from}");
        FOUR_BAR.replacen(from, to, 1)
    }

    #[test]
    fn diagnostics_are_fixed() {
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
    fn a_joint_is_driven_from_its_drawn_position() {
        let free = with("    driver motor: rotation(main) = 60 deg + 90 deg/s * t\n", "");
        insta::assert_snapshot!(offered(&free.replacen("joint main", "joint ma$0in", 1)), @r"
        Drive drive `main`
            driver motor: rotation(main) = 60 deg + 60 deg/s * t
        ");
        insta::assert_snapshot!(offered(&free.replacen("joint pivot", "joint pi$0vot", 1)), @r"
        Drive drive `pivot`
            driver motor: rotation(pivot) = 100 deg + 60 deg/s * t
        ");
        // each copy of a repeated joint can be driven
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
        // nothing is free
        assert_eq!(offered(&with("joint main", "joint ma$0in")), "");
    }
}
