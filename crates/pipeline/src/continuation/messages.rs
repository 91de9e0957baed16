//! Messages of continuations: a path that does not reach its target (E0612), and a bifurcation that a path passes (W0602).

use mechc_engine::analysis::{Stop, Warning};
use mechc_ir::{ConstraintSystem, PartStart};
use mechc_lang::model::ContinuedParam;
use mechc_text::diag::{Code, Diagnostic, readable};
use mechc_text::source::Span;

/// A message lists at most this many params or inputs.
const MAX_LISTED: usize = 8;

/// A param or input that changes along a path, as messages list it.
pub(crate) struct ContinuationTarget {
    param: ContinuedParam,
    /// SI unit; empty for a pure number.
    unit: String,
}

impl ContinuationTarget {
    /// Returns those of some params and inputs that change along the path.
    pub fn from_params(params: &[ContinuedParam]) -> Vec<ContinuationTarget> {
        let moving = params.iter().filter(|param| param.line[0].total_cmp(&param.line[1]).is_ne());
        let target = |param: &ContinuedParam| {
            let unit = match param.dimension.display_unit() {
                unit if unit == "1" => String::new(),
                unit => unit,
            };
            ContinuationTarget { param: param.clone(), unit }
        };
        moving.map(target).collect()
    }

    /// Returns the value at a fraction of the path, with its unit.
    fn value_at(&self, fraction: f64) -> String {
        let [from, to] = self.param.line;
        let value = from + (to - from) * fraction;
        let text = readable(format!("{value:.9e}").parse().unwrap_or(value));
        if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) }
    }
}

/// Reports a path that stops at a fraction of it from 0 to 1, and why, by the equations along the path; the path of a part, or of the whole
/// if `part` is `None`. `times` holds the times (s) at both ends.
pub(crate) fn stopped_path(
    part: Option<&PartStart>,
    targets: &[ContinuationTarget],
    times: [f64; 2],
    mechanism_span: Span,
    fraction: f64,
    (stop, system): (&Stop, &ConstraintSystem),
) -> Diagnostic {
    let why = stop.explain(system);
    let what = if stop.is_dead_point() { "a dead point" } else { why.code.title() };
    let location = location(targets, fraction);
    let message = match part {
        None => format!("on the way to {} there is {what}{location}", destination(targets)),
        Some(part) => format!("on the way of the part `{}` to its inputs there is {what}{location}", part.name),
    };
    let mut diagnostic = Diagnostic::new(Code::E0612, message);
    for (k, input) in targets.iter().take(MAX_LISTED).enumerate() {
        let [from, to, location] = [0.0, 1.0, fraction].map(|fraction| input.value_at(fraction));
        let text = format!("{}led from {from} to {to}, and got to {location}", name_prefix(input, targets));
        let span = input.param.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    let stop = why.labels.first().map_or(mechanism_span, |label| label.span);
    diagnostic = if targets.is_empty() { diagnostic.at(stop, "stops it") } else { diagnostic.also(stop, "stops it") };
    let (tried, mend) = match part {
        None => (
            "the estimates in `at` alone are tried instead, which may mean another branch",
            if is_of_params(targets) {
                "set a value from before that"
            } else {
                "give the input a formula of its own from which a way leads to what is given"
            },
        ),
        Some(_) => (
            "the part is assembled with the whole instead, which may mean another branch",
            "give the part's input a formula of its own from which a way leads to what it is bound to",
        ),
    };
    if let Some(part) = part {
        diagnostic = diagnostic.in_part(&part.name, part.span);
    }
    diagnostic.note(tried).help(mend).datum("part", fraction).datum("t", times[0] + (times[1] - times[0]) * fraction)
}

/// Returns the name of a param if others are declared at its place, as the coordinates of a point are.
fn name_prefix(input: &ContinuationTarget, targets: &[ContinuationTarget]) -> String {
    let ContinuationTarget { param, .. } = input;
    let at_same_place = targets.iter().filter(|other| other.param.declared.span == param.declared.span).count();
    if at_same_place > 1 { format!("`{}` ", param.declared.name) } else { String::new() }
}

/// Reports a bifurcation that a path passes at a fraction of it from 0 to 1; of a part, or of the whole if `part` is `None`.
pub(crate) fn passed_bifurcation(
    part: Option<&PartStart>,
    targets: &[ContinuationTarget],
    times: [f64; 2],
    fraction: f64,
    (warning, system): (&Warning, &ConstraintSystem),
) -> Diagnostic {
    let what = warning.explain(system);
    let location = location(targets, fraction);
    let path = match part {
        None => format!("on the way to {}", destination(targets)),
        Some(part) => format!("on the way of the part `{}` to its inputs", part.name),
    };
    let message =
        format!("{path} two branches of the motion meet{location}; the one that continues smoothly was taken");
    let mut diagnostic = Diagnostic::new(Code::W0602, message);
    for (k, input) in targets.iter().take(MAX_LISTED).enumerate() {
        let [from, to, location] = [0.0, 1.0, fraction].map(|fraction| input.value_at(fraction));
        let text = format!("{}led from {from} to {to}, by way of {location}", name_prefix(input, targets));
        let span = input.param.declared.span;
        diagnostic = if k == 0 { diagnostic.at(span, text) } else { diagnostic.also(span, text) };
    }
    for (k, label) in what.labels.iter().enumerate() {
        let is_first = k == 0 && targets.is_empty();
        let text = label.text.clone();
        diagnostic = if is_first { diagnostic.at(label.span, text) } else { diagnostic.also(label.span, text) };
    }
    if let Some(part) = part {
        diagnostic = diagnostic.in_part(&part.name, part.span);
    }
    diagnostic = what.notes.iter().cloned().fold(diagnostic, Diagnostic::note);
    diagnostic.datum("part", fraction).datum("t", times[0] + (times[1] - times[0]) * fraction)
}

/// Describes a place on the path by the values of all that changes: any of them may be the one that matters.
fn location(targets: &[ContinuationTarget], fraction: f64) -> String {
    let value = |input: &ContinuationTarget| format!("`{}` = {}", input.param.declared.name, input.value_at(fraction));
    let values: Vec<String> = targets.iter().take(MAX_LISTED).map(value).collect();
    if values.is_empty() { String::new() } else { format!(" at {}", values.join(", ")) }
}

fn is_of_params(targets: &[ContinuationTarget]) -> bool {
    targets.iter().any(|target| target.param.param.is_some())
}

/// Describes the end of the path.
fn destination(targets: &[ContinuationTarget]) -> &'static str {
    if is_of_params(targets) { "the values that are set" } else { "the inputs that are given" }
}
