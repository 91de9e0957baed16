//! Diagnostics of a start that cannot be assembled.

use super::{at, cut_list, degrees, length, named, three_digits, with_places};
use crate::analysis::explain::open_loop::{FaultyLink, FaultyLinkKind, OpenLoop};
use mechc_expr::math;
use mechc_ir::{ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind};
use mechc_text::diag::{Code, Diagnostic};
use serde_json::{Value, json};

/// Help for a gap of another order of magnitude than the mechanism.
const FAR_OFF: &str =
    "that is far more than the mechanism's size: look for a length whose unit is missing or another one";

/// Returns the diagnostic of a loop that does not close.
pub fn open_loop(system: &ConstraintSystem, open: &OpenLoop, t: f64) -> Diagnostic {
    let declaration = &system.declarations()[open.at];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let is_joint = matches!(declaration.kind, DeclarationKind::Joint(_));
    if open.is_unreachable(system) {
        return without_value(system, open, t);
    }
    let by = if open.kind == CoordinateKind::Length { length(open.by) } else { degrees(open.by) };
    // a loop stays open, a body misses what is prescribed
    let open_word = if is_joint { "open" } else { "off" };
    let message = format!("the mechanism cannot be assembled at {}: {noun} `{name}` stays {open_word} by {by}", at(t));
    let mut diagnostic = Diagnostic::new(Code::E0601, message)
        .at(declaration.span, format!("{open_word} by {by}"))
        .datum("t", t)
        .datum("residual", open.residual)
        .datum("lengths", open.links.iter().map(|link| link_as_data(system, link)).collect::<Vec<_>>());
    let others: Vec<DeclarationId> = open.declarations.iter().copied().filter(|&k| k != open.at).collect();
    diagnostic = with_places(diagnostic, system, &others, ["beside this", "the loop goes through these"]);
    for (too_short, what) in [(true, "too short"), (false, "too long")] {
        let links = open.links.iter().filter(|link| link.too_short == too_short);
        let names: Vec<String> = links.map(|link| link_in_words(system, link)).collect();
        if !names.is_empty() {
            diagnostic = diagnostic.note(format!("{what}: {}", cut_list(&names)));
        }
    }
    if open.is_far(system) {
        return diagnostic.help(FAR_OFF);
    }
    let driver = open.declarations.iter().find(|&&k| system.declarations()[k].kind == DeclarationKind::Driver);
    let driver = driver
        .map_or(String::new(), |&k| format!(", or begin with another value of `{}`", system.declarations()[k].name));
    let mend = if open.links.is_empty() {
        format!(
            "look at what these joints hold{driver}; estimates in `at` that are nearer to the position meant may help too"
        )
    } else {
        let least = at_least(open.by);
        let least = if open.kind == CoordinateKind::Length { length(least) } else { degrees(least) };
        format!("change one of these lengths, by {least} at least, and by more where it stands across the gap{driver}")
    };
    diagnostic.help(mend)
}

/// Returns the diagnostic of an equation that no motion brings nearer to its prescribed value.
fn without_value(system: &ConstraintSystem, open: &OpenLoop, t: f64) -> Diagnostic {
    let declaration = &system.declarations()[open.at];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let message =
        format!("the mechanism cannot be assembled at {}: {noun} `{name}` does not hold in any position", at(t));
    let (label, help) = match declaration.kind {
        DeclarationKind::Joint(_) => ("no motion brings its bodies nearer to each other", FAR_OFF),
        _ => (
            "no motion brings its two sides nearer to each other",
            "look at the values that its two sides can have, and at their units",
        ),
    };
    Diagnostic::new(Code::E0601, message)
        .at(declaration.span, label)
        .help(help)
        .datum("t", t)
        .datum("residual", open.residual)
}

/// Rounds up to three digits.
fn at_least(value: f64) -> f64 {
    let digit = math::pow(10.0, math::log10(value).floor() - 2.0);
    (value / digit).ceil() * digit
}

/// Returns a length, its owner, and the declarations between which it lies.
fn link_as_data(system: &ConstraintSystem, link: &FaultyLink) -> Value {
    let is = if link.too_short { "too short" } else { "too long" };
    match link.of {
        FaultyLinkKind::Declaration(k) => {
            json!({ "of": system.declarations()[k].name, "length": link.length, "is": is })
        }
        FaultyLinkKind::Body(body, ends) => {
            let of = body.map_or("ground", |body| &system.bodies()[body].name);
            let [from, to] = ends.map(|k| &system.declarations()[k].name);
            json!({ "of": of, "from": from, "to": to, "length": link.length, "is": is })
        }
    }
}

/// `coupler` (40 mm from `front` to `back`)
fn link_in_words(system: &ConstraintSystem, link: &FaultyLink) -> String {
    let length = length(link.length);
    match link.of {
        FaultyLinkKind::Declaration(k) => format!("`{}` ({length})", system.declarations()[k].name),
        FaultyLinkKind::Body(body, [from, to]) => {
            let body = body.map_or("the ground".to_owned(), |body| format!("`{}`", system.bodies()[body].name));
            let [from, to] = [from, to].map(|k| &system.declarations()[k].name);
            format!("{body} ({length} from `{from}` to `{to}`)")
        }
    }
}

/// Returns a diagnostic of a position that is not found, without a cause.
pub fn cannot_assemble(system: &ConstraintSystem, row: usize, residual: f64, t: f64) -> Diagnostic {
    let message = format!("the mechanism cannot be assembled at {}: {} stays open", at(t), named(system, row));
    Diagnostic::new(Code::E0601, message)
        .at(system.declaration_of(row).span, format!("is not met, by {} of the mechanism's size", three_digits(residual)))
        .help("give estimates in `at` that are nearer to the position meant; or check the lengths and the driver's first value")
        .datum("t", t)
        .datum("residual", residual)
}
