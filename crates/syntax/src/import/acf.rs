//! A settings file: the times of an analysis.

use super::build;
use super::errors;
use super::fields::{Fields, Number};
use super::value::{Kind, Value};
use crate::ast::{Expr, ExprKind, Factor, Item, ItemKind};
use mechc_text::diag::Diagnostics;

/// Largest number of steps; beyond about 2⁵³ `f64` does not hold every whole number.
const MOST_STEPS: f64 = 9e15;

/// Maximum number of digits of a step that is written as a number.
const STEP_DIGITS: usize = 6;

/// Reads the analysis of a settings file; `None`, with diagnostics, if its times are not usable.
pub(super) fn read(value: &Value, diagnostics: &mut Diagnostics) -> Option<Item> {
    let Kind::Object(members) = &value.kind else {
        let message = format!("settings must be an object, found {}", value.describe());
        diagnostics.push(errors::fault(value.span, message, "expected `{`"));
        return None;
    };
    let place = members.first().map_or(value.span, |(key, _)| key.span);
    let fields = Fields::new(value, "the settings file", place);
    simulation(value, diagnostics);
    let end = fields.number_with("tend", (|t| t > 0.0, "positive"), diagnostics);
    let whole = |n: f64| (1.0..=MOST_STEPS).contains(&n) && n % 1.0 == 0.0;
    let steps = fields.number_with("outputSteps", (whole, "a positive whole number"), diagnostics);
    let (end, steps) = (end?, steps?);
    let from = build::quantity(0.0, "s", end.span, build::Zero::WithUnit);
    let to = build::quantity(end.value, "s", end.span, build::Zero::WithUnit);
    let every = step(end, steps);
    let span = value.span;
    Some(Item { docs: Vec::new(), span, ranges: Vec::new(), kind: ItemKind::Analysis { from, to, every } })
}

fn simulation(value: &Value, diagnostics: &mut Diagnostics) {
    let Some(simulation) = value.get("simulation") else {
        return;
    };
    let wanted = "`Kinematics` or `Dynamics`";
    match &simulation.kind {
        Kind::Text(text) if text.text == "Kinematics" => {}
        Kind::Text(text) if text.text == "Dynamics" => diagnostics.push(errors::only_kinematics(text.span)),
        Kind::Text(text) => {
            let message = format!("`simulation` must be {wanted}, found `{}`", text.text);
            diagnostics.push(errors::fault(text.span, message, format!("expected {wanted}")));
        }
        _ => diagnostics.push(errors::wrong_type("simulation", wanted, simulation)),
    }
}

/// Returns the step as a number (`10 ms`) if `short_step` finds one, else as a quotient (`5 s / 333`).
fn step(end: Number, steps: Number) -> Expr {
    let span = end.span.to(steps.span);
    if let Some((value, unit)) = short_step(end.value, steps.value as i128) {
        return build::quantity(value, unit, span, build::Zero::WithUnit);
    }
    let end = build::quantity(end.value, "s", end.span, build::Zero::WithUnit);
    let steps = build::number(steps.value, steps.span);
    Expr { kind: ExprKind::Product(Box::new(end), vec![(Factor::Divide, steps)]), span }
}

/// Returns `end / steps` as a number and unit if it has at most `STEP_DIGITS` digits.
fn short_step(end: f64, steps: i128) -> Option<(f64, &'static str)> {
    // the shortest decimal that reads back to the time, as digits and a power of ten
    let scientific = format!("{end:e}");
    let (mantissa, exponent) = scientific.split_once('e')?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let mut digits: i128 = format!("{whole}{fraction}").parse().ok()?;
    let mut exponent = exponent.parse::<i32>().ok()? - i32::try_from(fraction.len()).ok()?;
    for _ in 0..=STEP_DIGITS {
        if digits % steps == 0 {
            break;
        }
        digits = digits.checked_mul(10)?;
        exponent -= 1;
    }
    if digits % steps != 0 {
        return None;
    }
    let mut digits = digits / steps;
    while digits % 10 == 0 && digits != 0 {
        digits /= 10;
        exponent += 1;
    }
    let written = digits.to_string();
    if written.len() > STEP_DIGITS {
        return None;
    }
    // the power of ten of its first digit
    let size = exponent + i32::try_from(written.len()).ok()? - 1;
    let (shift, unit) = match size {
        0.. => (0, "s"),
        -3..0 => (3, "ms"),
        _ => (6, "us"),
    };
    let value = format!("{written}e{}", exponent + shift).parse().ok()?;
    Some((value, unit))
}
