//! Start of a mechanism: closes it as it is drawn, and follows it to its first time.
//!
//! The branch of a motion is decided once, by the drawing: the equations are closed with the drivers where the drawing has them, and
//! then the drivers are moved to where they begin, along that branch. To any other first time the motion is followed from there.

use super::continuation::{Continuation, ContinuationOptions, PathOutcome, WAY};
use crate::analysis::assemble::{Doubt, Solving, Started, Unassembled, close_without_drivers, driver_residuals};
use crate::analysis::explain::{Stop, StopCause, Warning, WarningCause};
use crate::analysis::state::{Horizon, Times};
use mechc_expr::math;
use mechc_ir::Homotopy;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A closure that moves nothing farther than this, scaled, agrees with the drawing.
const AS_DRAWN: f64 = 0.01;
/// A closure by another direction is taken if its motion is shorter by this factor.
const CLEARLY: f64 = 0.5;
/// Maximum number of whole turns.
const MOST_TURNS: f64 = 100.0;

/// Assembles a mechanism at the first time of a horizon, from its estimates.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn start(
    determined: Arc<Determined>,
    program: Arc<Program>,
    horizon: Horizon,
    tolerance: f64,
    cancel: &Cancel,
) -> Result<Started, Box<Stop>> {
    let cancel = cancel.clone();
    let whole = Unassembled { determined, program, horizon, tolerance, pass_bifurcations: false, cancel };
    start_from(&whole, None, Solving::New)
}

/// Assembles a mechanism from the estimates of its file, or from others [m, rad]: closed as it is drawn, then driven to its start.
///
/// Where the drawing closes clearly better with the drivers where they begin, as of a crank that is not drawn, it means that. Where it closes
/// neither way, or no way leads on, it is closed with its drivers left out, and driven from there; else it is closed from the estimates with
/// the drivers where they begin. Both leave the branch in doubt, which [`Started::remarks`] reports.
///
/// # Errors
/// It cannot be assembled, starts in a singular position, or a formula has no value there.
pub fn start_from(whole: &Unassembled, estimates: Option<&[f64]>, solving: Solving) -> Result<Started, Box<Stop>> {
    let (mut kinematics, t) = (whole.kinematics(estimates), whole.horizon.from);
    let Some(residuals) = driver_residuals(&mut kinematics, t) else { return whole.close_with(kinematics, solving) };
    let drawn = kinematics.estimates();
    let closed = close_and_drive(whole, &drawn, &residuals);
    if let Some(Closed { q, doubt, .. }) = closed.as_ref().filter(|closed| closed.moved <= AS_DRAWN) {
        return Ok(whole.assemble_at_with(kinematics, q, solving)?.with_doubt(*doubt));
    }
    let begun = whole.close_with(kinematics.clone(), Solving::With(None));
    let begun =
        begun.map(|begun| Closed { moved: begun.moved_in_loops(), doubt: begun.doubt(), q: begun.q().to_vec() });
    let is_better = |begun: &&Closed| match &closed {
        None => begun.doubt.is_none() && begun.moved <= AS_DRAWN && !is_round(whole, &residuals),
        Some(closed) if closed.doubt.is_some() => begun.moved < closed.moved,
        Some(closed) => begun.doubt.is_none() && begun.moved < CLEARLY * closed.moved,
    };
    let better = begun.as_ref().ok().filter(is_better);
    if let Some(Closed { q, doubt, .. }) = better.or(closed.as_ref()) {
        return Ok(whole.assemble_at_with(kinematics, q, solving)?.with_doubt(*doubt));
    }
    let free = close_without_drivers(&mut kinematics, t);
    let (q, doubt) = match free.and_then(|(q, residuals)| close_and_drive(whole, &q, &residuals)) {
        Some(closed) => (closed.q, Doubt::DriversLeftOut),
        None => match (begun, whole.determined.start()) {
            (Err(_), Some(q)) => (q.to_vec(), Doubt::NotDriven),
            (begun, _) => (begun?.q, Doubt::NotDriven),
        },
    };
    Ok(whole.assemble_at_with(kinematics, &q, solving)?.with_doubt(Some(doubt)))
}

/// Follows a mechanism, in whose equations a fraction of a straight path, from 0 to 1, stands for time, from its estimates, or from a
/// position, to some fractions of the path, which rise and are above 0. A velocity that jumps on the path is no reason to stop: there is no
/// time.
///
/// # Errors
/// It cannot be assembled at 0.
pub fn lead(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    stands: Option<&[f64]>,
    parts: &[f64],
    options: &ContinuationOptions,
) -> Result<PathOutcome, Box<Stop>> {
    let continuation = Continuation::new(determined, program, Solving::New, options);
    let started = match stands {
        Some(q) => continuation.whole(WAY).assemble_at(q, Solving::New)?,
        None => start_from(&continuation.whole(WAY), None, Solving::New)?,
    };
    Ok(continuation.run(started, parts))
}

/// A mechanism at its start, and what closing it took.
struct Closed {
    /// Its coordinates at the start [m, rad].
    q: Vec<f64>,
    /// Distance by which closing moved what it had to iterate for, scaled.
    moved: f64,
    /// Doubt that it closed as it is drawn.
    doubt: Option<Doubt>,
}

/// Closes a mechanism with these residuals of rows of `Φ` as it is drawn [m, rad], and continues it to where they vanish; `None` if it does
/// not close there, or no way leads on. If a way of more than half a turn ends at a dead point, the shortest way is taken, which leaves in
/// doubt what is turned with it.
fn close_and_drive(whole: &Unassembled, drawn: &[f64], residuals: &[(usize, f64)]) -> Option<Closed> {
    let rows = whole.determined.whole().rows();
    let turns = |&(row, from): &(usize, f64)| if rows[row].unit.is_angle() { from / TAU } else { 0.0 };
    let beyond = |turns: f64| (-math::floor(-f64::max(turns.abs() - MOST_TURNS, 0.0))).copysign(turns);
    close_and_continue(whole, drawn, residuals, |residual| beyond(turns(residual))).or_else(|| {
        let nearest = |residual: &(usize, f64)| math::floor(turns(residual) + 0.5);
        let shortest =
            if is_round(whole, residuals) { close_and_continue(whole, drawn, residuals, nearest) } else { None };
        shortest.map(|closed| Closed { doubt: Some(Doubt::ShortestWay), ..closed })
    })
}

/// Returns whether a driver begins more than half a turn away from where it is drawn.
fn is_round(whole: &Unassembled, residuals: &[(usize, f64)]) -> bool {
    let rows = whole.determined.whole().rows();
    residuals.iter().any(|&(row, from)| rows[row].unit.is_angle() && from.abs() > PI)
}

/// Closes a mechanism as it is drawn [m, rad], and continues it to where so many whole turns are left of each residual: the last step of
/// the assembly turns what follows without iteration. `None` if it does not close there, or no way leads on.
fn close_and_continue(
    whole: &Unassembled,
    drawn: &[f64],
    residuals: &[(usize, f64)],
    turns: impl Fn(&(usize, f64)) -> f64,
) -> Option<Closed> {
    let t = whole.horizon.from;
    let lines = residuals.iter().map(|residual| (residual.0, [residual.1, TAU * turns(residual)])).collect();
    let way = along(whole, &Homotopy::Residuals { t, lines }).ok()?;
    let options = ContinuationOptions::new(&way, t);
    let continuation = Continuation::new(&way.determined, &way.program, Solving::With(None), &options);
    let closed = way.close(Some(drawn), Solving::With(None)).ok()?;
    let (doubt, moved) = (closed.doubt(), closed.moved_in_loops());
    if doubt == Some(Doubt::Perturbed) {
        return None;
    }
    let mut way = continuation.run(closed, &[1.0]);
    let passed = if way.passed.is_empty() { None } else { Some(Doubt::Passed) };
    Some(Closed { q: way.reached.pop()?, moved, doubt: doubt.or(passed) })
}

/// Follows a mechanism from its start at a time (s) to the first time of its horizon, later or earlier; with the bifurcations that were
/// passed on the way, where these are passed.
///
/// # Errors
/// The motion does not get there, or cannot begin there.
pub fn follow_to(whole: &Unassembled, (started, start): (Started, f64)) -> Result<(Started, Vec<Warning>), Box<Stop>> {
    let to = whole.horizon.from;
    let solver = started.shared_solver();
    let (q, passed) = if to < start {
        follow_back(whole, &started, start)?
    } else {
        let layout = RowLayout::new(started.system());
        let mut motion = started.into_motion(&Times::listed(start, vec![to]));
        if whole.pass_bifurcations {
            motion.pass_bifurcations();
        }
        let q = match motion.next_row() {
            Some(row) => row.map(|row| layout.position(row).to_vec()).map_err(|stop| stop.before_start(start))?,
            None => return Err(StopCause::NoStep { driver: None }.at(start)),
        };
        let passed = motion.take_warnings().into_iter().filter(Warning::is_passage);
        (q, passed.map(|warning| warning.before_start(start)).collect())
    };
    Ok((whole.assemble_at(&q, Solving::With(solver))?, passed))
}

/// Returns the position [m, rad] at a time before the start of a motion, and the bifurcations that were passed: the motion is followed
/// back, along a straight line of time.
fn follow_back(whole: &Unassembled, started: &Started, start: f64) -> Result<(Vec<f64>, Vec<Warning>), Box<Stop>> {
    let to = whole.horizon.from;
    let back = along(whole, &Homotopy::Time([start, to]))?;
    let options = ContinuationOptions::new(&back, start);
    let continuation = Continuation::new(&back.determined, &back.program, Solving::With(None), &options);
    let mut way = continuation.run(back.assemble_at(started.q(), Solving::With(None))?, &[1.0]);
    let time_of = |fraction: f64| start + (to - start) * fraction;
    match (way.reached.pop(), way.stopped) {
        (Some(q), _) => {
            let passed = way.passed.into_iter().map(|warning| Warning {
                t: time_of(warning.t),
                cause: WarningCause::PassedBeforeStart { from: start, is_backward: true, warning: Box::new(warning) },
            });
            Ok((q, passed.collect()))
        }
        (None, Some(stop)) => {
            let t = time_of(stop.t);
            Err(StopCause::BeforeStart { from: start, is_backward: true, stop }.at(t))
        }
        (None, None) => Err(StopCause::NoStep { driver: None }.at(start)),
    }
}

/// Returns a mechanism whose equations go along a homotopy, from 0 to 1 in place of time.
///
/// # Errors
/// These equations do not determine it.
fn along(whole: &Unassembled, homotopy: &Homotopy) -> Result<Unassembled, Box<Stop>> {
    let determined = whole
        .determined
        .along(homotopy)
        .map_err(|refused| StopCause::Undetermined(Box::new(refused.diagnostic)).at(whole.horizon.from))?;
    let program = Arc::new(Program::new(determined.system()));
    Ok(Unassembled { determined: Arc::new(determined), program, horizon: WAY, ..whole.clone() })
}
