//! The way from one start to another: a mechanism whose inputs go along straight lines is followed from where its own inputs have it to
//! where others do, along the branch.

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

/// The way as a time.
pub(super) const WAY: Horizon = Horizon { from: 0.0, span: 1.0 };

/// How a mechanism is led.
#[derive(Clone, Debug)]
pub struct ContinuationOptions {
    /// Bounds each row of Φ, scaled.
    pub tolerance: f64,
    /// Go on beyond bifurcations.
    pub pass_bifurcations: bool,
    /// When the way begins, for what is said of that start (s).
    pub t: f64,
    /// Ends it.
    pub cancel: Cancel,
}

impl ContinuationOptions {
    /// The options of one that is to be assembled.
    pub(super) fn of(unassembled: &Unassembled, t: f64) -> ContinuationOptions {
        let Unassembled { tolerance, pass_bifurcations, ref cancel, .. } = *unassembled;
        ContinuationOptions { tolerance, pass_bifurcations, t, cancel: cancel.clone() }
    }
}

/// How far a mechanism was led.
pub struct PathOutcome {
    /// The coordinates [m, rad] at the parts of the way that were asked for, as far as it got.
    pub reached: Vec<Vec<f64>>,
    /// What is to be said of where it began.
    pub warnings: Diagnostics,
    /// Bifurcations that were passed; each `t` is a fraction of the path.
    pub passed: Vec<Warning>,
    /// Stop before the end; its `t` is a fraction of the path.
    pub stopped: Option<Box<Stop>>,
}

/// What begins all ways of a mechanism whose parameters say where they lead: it stands at their beginning, whatever these are.
///
/// # Errors
/// It does not stand there.
pub fn start_of_paths(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    stands: &[f64],
    options: &ContinuationOptions,
) -> Result<Started, Box<Stop>> {
    Continuation::new(determined, program, Solving::New, options).whole(WAY).assemble_at(stands, Solving::New)
}

/// Leads a mechanism to the end of its path, from the start and with the solver that [`start_of_paths`] made for the same mechanism.
///
/// # Errors
/// It cannot be assembled at 0.
pub fn continue_from(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    (stands, solver): (&[f64], Option<Arc<Solver>>),
    options: &ContinuationOptions,
) -> Result<PathOutcome, Box<Stop>> {
    let solving = Solving::With(solver);
    let leader = Continuation::new(determined, program, solving.clone(), options);
    let started = leader.whole(WAY).assemble_at(stands, solving)?;
    Ok(leader.lead(started, &[1.0]))
}

/// What is led, and how.
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

    /// What is led, to be assembled where a horizon begins.
    pub fn whole(&self, horizon: Horizon) -> Unassembled {
        let ContinuationOptions { tolerance, pass_bifurcations, ref cancel, .. } = *self.options;
        let (determined, program) = (Arc::clone(self.determined), Arc::clone(self.program));
        Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel: cancel.clone() }
    }

    /// Follows it from a start at 0 to some parts of the way.
    pub fn lead(&self, mut started: Started, parts: &[f64]) -> PathOutcome {
        let options = self.options;
        let warnings = started.far_estimates_at(options.t);
        let mut way = PathOutcome { reached: Vec::new(), warnings, passed: Vec::new(), stopped: None };
        let mut from = (0.0, started.q().to_vec());
        for _ in 0..MOST_KINKS {
            let known = way.reached.len();
            let PathOutcome { reached, passed, .. } = &mut way;
            way.stopped = self.follow(started, from.0, &parts[known..], reached, passed);
            let Some(stop) = &way.stopped else { return way };
            if let Some(last) = way.reached[known..].last() {
                from = (parts[way.reached.len() - 1], last.clone());
            }
            if !stop.is_jump() || options.cancel.is_cancelled() {
                return way;
            }
            let Some((behind, beyond)) = self.beyond_kink(stop.t, &from) else { return way };
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

    /// Assembled at a part of the way, where it stands.
    fn at(&self, part: f64, q: &[f64]) -> Option<Started> {
        self.whole(WAY.beginning(part)).assemble_at(q, self.solving.clone()).ok()
    }

    /// The start just behind a place where a velocity jumps, with its part of the way; none where the position is another one there.
    fn beyond_kink(&self, part: f64, (known, q): &(f64, Vec<f64>)) -> Option<(f64, Started)> {
        let (before, behind) = ((part - KINK_OFFSET).max(*known), (part + KINK_OFFSET).min(1.0));
        let again = self.at(*known, q)?;
        let mut there = Vec::new();
        let stopped = self.follow(again, *known, &[before], &mut there, &mut Vec::new());
        let near = there.pop().filter(|_| stopped.is_none())?;
        let beyond = self.at(behind, &near)?;
        is_the_same(self.determined.system(), &near, beyond.q()).then_some((behind, beyond))
    }

    /// Adds the positions at some parts of the way, and the bifurcations that are passed; says where the motion ends before the last, and
    /// why.
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
