//! The way from one start to another: a mechanism whose inputs go along straight lines is followed from where its own inputs have it to
//! where others do, along the branch.

use super::errors;
use super::{Started, Times, start_from};
use crate::cancel::Cancel;
use crate::diag::{Code, Diagnostic, Diagnostics};
use crate::ir::ConstraintSystem;
use crate::program::Program;
use crate::structure::Determined;
use std::sync::Arc;

/// How far before and behind a kink, as a part of the way, the mechanism is looked at.
const BESIDE_A_KINK: f64 = 1e-9;
/// By so much, scaled, a position may differ before and behind a kink.
const KINK: f64 = 1e-6;
/// Kinks on one way at most.
const MOST_KINKS: usize = 1000;

/// How a mechanism is led.
#[derive(Clone, Debug)]
pub struct LeadOptions {
    /// Bounds each row of Φ, scaled.
    pub tolerance: f64,
    /// Go on beyond bifurcations.
    pub pass_bifurcations: bool,
    /// When the way begins, for what is said of that start (s).
    pub t: f64,
    /// Ends it.
    pub cancel: Cancel,
}

/// Where a mechanism was led to.
pub struct Arrived {
    /// The coordinates [m, rad].
    pub q: Vec<f64>,
    /// What is to be said of where it began.
    pub remarks: Diagnostics,
}

/// Why a mechanism cannot be led.
pub enum NotLed {
    /// There is no start from which it could be.
    NotStarted(Box<Diagnostic>),
    /// It did not come farther than to a part of the way.
    Stopped {
        /// From 0 to 1.
        part: f64,
        /// What happens there.
        why: Box<Diagnostic>,
    },
}

/// Follows a mechanism, in whose equations a straight way from 0 to 1 stands for time, from its estimates, or from others, to the end of the way.
///
/// # Errors
/// It cannot be assembled at 0, or its motion ends before 1. A velocity that jumps on the way is no reason: there is no time.
pub fn lead(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    from: Option<&[f64]>,
    options: &LeadOptions,
) -> Result<Arrived, NotLed> {
    let LeadOptions { tolerance, cancel, .. } = options;
    let again = |part: f64, from: &[f64]| {
        start_from(Arc::clone(determined), Arc::clone(program), part, Some(from), *tolerance, cancel)
    };
    let started = start_from(Arc::clone(determined), Arc::clone(program), 0.0, from, *tolerance, cancel);
    let mut started = started.map_err(NotLed::NotStarted)?;
    let remarks = started.far_estimates_at(options.t);
    let mut from = (0.0, started.q().to_vec());
    for _ in 0..MOST_KINKS {
        let (part, why) = match follow(started, from.0, 1.0, options) {
            Ok(q) => return Ok(Arrived { q, remarks }),
            Err(stopped) => stopped,
        };
        let stopped = |why| Err(NotLed::Stopped { part, why });
        if why.code != Code::E0609 || cancel.is_cancelled() {
            return stopped(why);
        }
        let (before, behind) = ((part - BESIDE_A_KINK).max(from.0), (part + BESIDE_A_KINK).min(1.0));
        let Ok(q) = again(from.0, &from.1).map_err(drop).and_then(|s| follow(s, from.0, before, options).map_err(drop))
        else {
            return stopped(why);
        };
        let Ok(beyond) = again(behind, &q) else { return stopped(why) };
        if !is_the_same(determined.system(), &q, beyond.q()) {
            return stopped(why);
        }
        if behind >= 1.0 {
            return Ok(Arrived { q: beyond.q().to_vec(), remarks });
        }
        from = (behind, beyond.q().to_vec());
        started = beyond;
    }
    Err(NotLed::Stopped { part: from.0, why: Box::new(errors::cannot_follow(determined.system(), from.0, None)) })
}

/// The position at a part of the way; or where the motion ends before, and why.
fn follow(started: Started, from: f64, to: f64, options: &LeadOptions) -> Result<Vec<f64>, (f64, Box<Diagnostic>)> {
    let n = started.q().len();
    let mut motion = started.into_motion(&Times::listed(from, vec![to]));
    if options.pass_bifurcations {
        motion.pass_bifurcations();
    }
    let part_of = |why: &Diagnostic| why.data.get("t").and_then(serde_json::Value::as_f64).unwrap_or(from);
    match motion.next_row() {
        Some(Ok(row)) => Ok(row[1..=n].to_vec()),
        Some(Err(why)) => Err((part_of(&why), why)),
        None => Err((from, Box::new(Diagnostic::new(Code::E0604, "the way was not followed to its end")))),
    }
}

fn is_the_same(system: &ConstraintSystem, a: &[f64], b: &[f64]) -> bool {
    let scale = |k: usize| system.coordinates[k].scale;
    (0..a.len()).all(|k| (a[k] - b[k]).abs() <= KINK * scale(k))
}
