//! Continuation: follows a mechanism whose inputs go along straight lines from where its own inputs have it to where others do, along the branch.

use crate::analysis::assemble::{Solving, Started, Unassembled};
use crate::analysis::explain::{Stop, StopCause, Warning};
use crate::analysis::state::{Horizon, Times};
use crate::solver::Solver;
use mechc_ir::ConstraintSystem;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use std::sync::Arc;

/// Distance before and behind a kink at which the mechanism is examined, as a part of the path.
const KINK_OFFSET: f64 = 1e-9;
/// Largest difference of the positions before and behind a kink, scaled.
const KINK: f64 = 1e-6;
/// Maximum number of kinks on one path.
const MOST_KINKS: usize = 1000;

/// Horizon of a continuation: a fraction of the path, from 0 to 1, stands for time.
pub(super) const WAY: Horizon = Horizon { from: 0.0, span: 1.0 };

/// Options of a continuation.
#[derive(Clone, Debug)]
pub struct ContinuationOptions {
    /// Bounds each row of Φ, scaled.
    pub tolerance: f64,
    /// True to go on beyond bifurcations.
    pub pass_bifurcations: bool,
    /// Time of the start (s), for diagnostics about it.
    pub t: f64,
    /// Cancels the continuation.
    pub cancel: Cancel,
}

impl ContinuationOptions {
    /// Returns the options for an unassembled mechanism that starts at a time (s).
    pub(super) fn new(unassembled: &Unassembled, t: f64) -> ContinuationOptions {
        let Unassembled { tolerance, pass_bifurcations, ref cancel, .. } = *unassembled;
        ContinuationOptions { tolerance, pass_bifurcations, t, cancel: cancel.clone() }
    }
}

/// Outcome of a continuation: the positions that it reached, and why it stopped.
pub struct PathOutcome {
    /// Coordinates [m, rad] at the requested fractions of the path, as far as it got.
    pub reached: Vec<Vec<f64>>,
    /// Warnings about the start.
    pub warnings: Diagnostics,
    /// Bifurcations that were passed; each `t` is a fraction of the path.
    pub passed: Vec<Warning>,
    /// Stop before the end; its `t` is a fraction of the path.
    pub stopped: Option<Box<Stop>>,
}

/// Assembles the start of all paths of a mechanism whose parameters say where the paths lead. `stands` [m, rad] is their common start,
/// whatever the parameters are.
///
/// # Errors
/// The mechanism cannot be assembled there.
pub fn start_of_paths(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    stands: &[f64],
    options: &ContinuationOptions,
) -> Result<Started, Box<Stop>> {
    Continuation::new(determined, program, Solving::New, options).whole(WAY).assemble_at(stands, Solving::New)
}

/// Continues a mechanism to the end of its path, from the start and with the solver that [`start_of_paths`] made for the same mechanism.
///
/// # Errors
/// It cannot be assembled at 0.
pub fn continue_from(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    stands: &[f64],
    solver: Option<Arc<Solver>>,
    options: &ContinuationOptions,
) -> Result<PathOutcome, Box<Stop>> {
    let solving = Solving::With(solver);
    let continuation = Continuation::new(determined, program, solving.clone(), options);
    let started = continuation.whole(WAY).assemble_at(stands, solving)?;
    Ok(continuation.run(started, &[1.0]))
}

/// Mechanism to be continued, with the options.
pub(super) struct Continuation<'l> {
    determined: &'l Arc<Determined>,
    program: &'l Arc<Program>,
    solving: Solving,
    options: &'l ContinuationOptions,
}

impl<'l> Continuation<'l> {
    pub fn new(
        determined: &'l Arc<Determined>,
        program: &'l Arc<Program>,
        solving: Solving,
        options: &'l ContinuationOptions,
    ) -> Continuation<'l> {
        Continuation { determined, program, solving, options }
    }

    /// Returns the mechanism, to be assembled where a horizon begins.
    pub fn whole(&self, horizon: Horizon) -> Unassembled {
        let ContinuationOptions { tolerance, pass_bifurcations, ref cancel, .. } = *self.options;
        let (determined, program) = (Arc::clone(self.determined), Arc::clone(self.program));
        Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel: cancel.clone() }
    }

    /// Follows the mechanism from a start at 0 to some fractions of the path.
    pub fn run(&self, mut started: Started, parts: &[f64]) -> PathOutcome {
        let options = self.options;
        let warnings = started.far_estimates_at(options.t);
        let mut way = PathOutcome { reached: Vec::new(), warnings, passed: Vec::new(), stopped: None };
        let mut from = (0.0, started.q().to_vec());
        for _ in 0..MOST_KINKS {
            let count = way.reached.len();
            let PathOutcome { reached, passed, .. } = &mut way;
            way.stopped = self.follow(started, from.0, &parts[count..], reached, passed);
            let Some(stop) = &way.stopped else { return way };
            if let Some(last) = way.reached[count..].last() {
                from = (parts[way.reached.len() - 1], last.clone());
            }
            if !stop.is_jump() || options.cancel.is_cancelled() {
                return way;
            }
            let Some((behind, beyond)) = self.beyond_kink(stop.t, from.0, &from.1) else { return way };
            way.stopped = None;
            while parts.get(way.reached.len()).is_some_and(|&part| part <= behind) {
                way.reached.push(beyond.q().to_vec());
            }
            if way.reached.len() == parts.len() {
                return way;
            }
            from = (behind, beyond.q().to_vec());
            started = beyond;
        }
        way.stopped = Some(StopCause::NoStep { driver: None }.at(from.0));
        way
    }

    /// Assembles the mechanism at a fraction of the path, from a position [m, rad].
    fn at(&self, part: f64, q: &[f64]) -> Option<Started> {
        self.whole(WAY.beginning(part)).assemble_at(q, self.solving.clone()).ok()
    }

    /// Returns the start just behind a velocity jump at a fraction of the path, with its own fraction; `None` if the position jumps too.
    /// `q` is the position at `last`, the last fraction that was reached.
    fn beyond_kink(&self, part: f64, last: f64, q: &[f64]) -> Option<(f64, Started)> {
        let (before, behind) = ((part - KINK_OFFSET).max(last), (part + KINK_OFFSET).min(1.0));
        let restarted = self.at(last, q)?;
        let mut there = Vec::new();
        let stopped = self.follow(restarted, last, &[before], &mut there, &mut Vec::new());
        let near = there.pop().filter(|_| stopped.is_none())?;
        let beyond = self.at(behind, &near)?;
        is_the_same(self.determined.system(), &near, beyond.q()).then_some((behind, beyond))
    }

    /// Appends the positions at some fractions of the path, and the bifurcations that are passed. Returns the stop if the motion ends
    /// before the last fraction.
    fn follow(
        &self,
        started: Started,
        from: f64,
        parts: &[f64],
        reached: &mut Vec<Vec<f64>>,
        passed: &mut Vec<Warning>,
    ) -> Option<Box<Stop>> {
        let layout = RowLayout::new(started.system());
        let mut motion = started.into_motion(&Times::listed(from, parts.to_vec()));
        if self.options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        let mut stopped = None;
        for _ in parts {
            match motion.next_row() {
                Some(Ok(row)) => {
                    reached.push(layout.position(row).to_vec());
                    continue;
                }
                Some(Err(stop)) => stopped = Some(stop),
                // cancelled: the reason is of no use
                None => stopped = Some(StopCause::NoStep { driver: None }.at(from)),
            }
            break;
        }
        passed.extend(motion.take_warnings().into_iter().filter(Warning::is_passage));
        stopped
    }
}

fn is_the_same(system: &ConstraintSystem, a: &[f64], b: &[f64]) -> bool {
    let scale = |k: usize| system.coordinates()[k].scale;
    (0..a.len()).all(|k| (a[k] - b[k]).abs() <= KINK * scale(k))
}
