//! Diagnostics of results without a value, with gaps, or with few certain digits.

use super::interval_search::NoValueCause;
use crate::analysis::explain::errors::{at, short};
use mechc_ir::layout::ColumnUnit;
use mechc_ir::{Bound, Outcome, Reduction, Requirement};
use mechc_text::diag::{Code, Diagnostic};

/// Reports a result without a value: because of a reduction in its formula (`cause`), or else because the formula itself is not finite.
pub fn result_without_value(outcome: &Outcome, cause: Option<NoValueCause>) -> Diagnostic {
    let name = &outcome.name;
    let (message, label) = match cause {
        Some(NoValueCause::Missing(t)) => (
            format!("result `{name}` has no value: what it speaks of has none at {}", at(t)),
            "infinite or undefined there",
        ),
        Some(NoValueCause::Nowhere(_)) => {
            (format!("result `{name}` has no value: what it speaks of has none at any time"), "infinite or undefined")
        }
        Some(NoValueCause::Unbounded(t)) => (
            format!("result `{name}` has no value: what it speaks of grows without bound at {}", at(t)),
            "infinite there",
        ),
        Some(NoValueCause::Window(t)) => (
            format!(
                "result `{name}` has no value: its window does not lie in the analysis, or ends before it begins, at {}",
                at(t)
            ),
            "no time of the analysis",
        ),
        Some(NoValueCause::Unknown(t)) => (
            format!("result `{name}` has no value: none of its digits is certain around {}", at(t)),
            "not certain enough",
        ),
        Some(NoValueCause::Uncertain(t)) => (
            format!("result `{name}` has no value: the position at {} is too near to a singular one", at(t)),
            "more rounding than digits there",
        ),
        None if outcome.unknown_is_false => (
            format!("`{name}` is not known"),
            "of an extremum that two times share, of a kink or jump that moves, of what has no value at some times, or of too many derivatives",
        ),
        None => (format!("result `{name}` has no value"), "its formula is infinite or undefined"),
    };
    let diagnostic = Diagnostic::new(Code::N0604, message).at(outcome.span, label);
    match cause {
        Some(cause) => diagnostic.datum("t", cause.t()),
        None => diagnostic,
    }
}

/// Reports that a result leaves out the times at which a formula has no value, of which `t` (s) is the first.
pub fn result_with_gaps(outcome: &Outcome, t: f64) -> Diagnostic {
    let message = format!("result `{}` leaves out the times at which what it speaks of has no value", outcome.name);
    Diagnostic::new(Code::N0605, message).at(outcome.span, format!("such as {}", at(t))).datum("t", t)
}

/// Reports that few digits of a result are certain.
pub fn result_with_few_digits(outcome: &Outcome, digits: u32) -> Diagnostic {
    let which = if digits == 1 { "one digit".to_owned() } else { format!("{digits} digits") };
    Diagnostic::new(
        Code::N0605,
        format!("only {which} of result `{}` {} certain", outcome.name, if digits == 1 { "is" } else { "are" }),
    )
    .at(outcome.span, "no more are told")
    .datum("digits", f64::from(digits))
}

/// Reports that results have no value because the motion ends before the analysis.
pub fn results_without_motion(first: &Outcome, count: usize, why: &Diagnostic) -> Diagnostic {
    let which = if count == 1 { format!("result `{}` has", first.name) } else { format!("the {count} results have") };
    Diagnostic::new(Code::N0604, format!("{which} no value: the motion does not come to the end of the analysis"))
        .at(first.span, "over the whole analysis")
        .note(why.message.clone())
}

/// Reports a value that is requested at a time (s) outside the analysis.
pub fn at_outside(reduction: &Reduction, t: f64, [from, to]: [f64; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0422, format!("{} is outside the analysis", at(t)))
        .at(reduction.span, format!("the analysis goes from {} to {}", at(from), at(to)))
        .datum("t", t)
}

/// Reports a requirement whose bound is exceeded: with the value and the bound there, and for a quantity the first time (s) and that of the
/// largest excess.
pub fn requirement_fails(
    requirement: &Requirement,
    bound: &Bound,
    values: [f64; 2],
    times: Option<[f64; 2]>,
) -> Diagnostic {
    let Requirement { name, span, formula, units, .. } = requirement;
    let unit = ColumnUnit::from_units(units, 0);
    let in_unit = |si: f64| match short(unit.printed(si)) {
        number if unit.text == "1" => number,
        number => format!("{number} {}", unit.text),
    };
    let [value, limit] = values.map(in_unit);
    let side = if bound.is_upper { "more" } else { "less" };
    let reached = format!("`{formula}` is {value}, {side} than {limit}");
    let diagnostic = match times {
        None => Diagnostic::new(Code::E0613, format!("the requirement `{name}` does not hold")).at(*span, reached),
        Some([first, worst]) => {
            Diagnostic::new(Code::E0613, format!("the requirement `{name}` does not hold, first at {}", at(first)))
                .at(*span, format!("{reached}, at {}", at(worst)))
                .datum("t", first)
        }
    };
    diagnostic.datum("value", values[0]).datum("bound", values[1])
}

/// Reports a requirement whose value does not exist.
pub fn requirement_without_value(requirement: &Requirement, cause: Option<NoValueCause>) -> Diagnostic {
    let Requirement { name, span, formula, .. } = requirement;
    let label = cause.map_or_else(|| "infinite or undefined".to_owned(), |cause| format!("see {}", at(cause.t())));
    Diagnostic::new(Code::E0613, format!("the requirement `{name}` does not hold: `{formula}` has no value"))
        .at(*span, label)
}
