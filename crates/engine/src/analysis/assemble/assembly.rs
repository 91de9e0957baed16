//! Assembly from the estimates of the file: finds a position that satisfies every equation at the first time.
//!
//! First Newton's method with damped steps; where that fails, Levenberg–Marquardt, which also works through singular
//! positions, from the estimates and then from perturbed ones. The result is assembled, or an error.

use super::search::{Noise, levenberg_marquardt};
use crate::analysis::explain::{Stop, StopCause, open_loop, singular};
use crate::analysis::state::{Fault, Horizon, Kinematics, State, behind_start};
use crate::limits::assembly::{AGREES, LARGEST_DENSE, LARGEST_STEP, MOST_STEPS, NEARBY, NUDGE, SAME};
use crate::limits::redundancy::LARGEST_OPENING;
use mechc_ir::{BodyId, ConstraintSystem, CoordinateKind, MonitorKind};
use std::f64::consts::PI;

/// Smallest damping of a Newton step before another method is tried.
const SMALLEST_DAMPING: f64 = 1e-3;
/// A smaller correction, scaled, needs no further step.
const SETTLED: f64 = 1e-7;
/// Sizes of the perturbations of estimates, scaled, one attempt after another.
const PERTURBATIONS: [f64; 6] = [0.01, 0.05, 0.1, 0.2, 0.4, 0.8];
/// A start closer to a singular position than this is singular, and an equation whose slope is below this part of the slope nearby fixes nothing:
/// there q is accurate only to the square root of the tolerance.
const SINGULAR_START: f64 = 1e-5;
/// A tangent shorter than this, in sizes of its body, vanishes.
const VANISHING_TANGENT: f64 = 1e-7;

/// Displacement of the bodies from their estimates in assembly.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Moved {
    /// Largest move of a body's origin in x or y (m).
    pub length: f64,
    /// Body that moved furthest.
    pub length_body: BodyId,
    /// Largest turn (rad).
    pub angle: f64,
    /// Body that turned furthest.
    pub angle_body: BodyId,
}

/// A position that satisfies every equation.
pub struct Assembled {
    /// Position and time.
    pub state: State,
    /// Displacement from the estimates.
    pub moved: Moved,
    /// True if the estimates led nowhere, and others near them had to be tried.
    pub is_perturbed: bool,
}

/// Assembles at time `t`, from the estimates or from a position that is known to be near.
pub fn assemble(kinematics: &mut Kinematics, t: f64, near: Option<&[f64]>) -> Result<Assembled, Box<Stop>> {
    let determined = kinematics.determined();
    let system = determined.system();
    let estimates = kinematics.estimates();
    let from = near.unwrap_or(&estimates);
    set_start(kinematics, t);
    if let Err(fault @ (Fault::NotFinite { .. } | Fault::Condition { .. })) = kinematics.set_position(from) {
        return Err(singular::without_value(system, fault).at(t));
    }
    let start = explicit_first(kinematics, from);
    let (q, is_perturbed) = match assembled(kinematics, &start) {
        Some(q) => (q, false),
        None => by_least_squares(kinematics, &start, t)?,
    };
    let moved = moved(system, &estimates, &q);
    refuse_vanishing_tangents(kinematics, &q, t)?;
    refuse_singular(kinematics, &q, t)?;
    Ok(Assembled { state: State::new(t, q), moved, is_perturbed })
}

/// Rows of all equations, those that are left out among them, each with the value of `Φ` at some position.
pub type Residuals = Vec<(usize, f64)>;

/// Returns the residuals of the drivers at the estimates, at time `t`: by row, `Φ` there. `None` if nothing is to be driven: the estimates
/// agree with the drivers, or have no value, or every coordinate follows from others without iteration.
pub fn driver_residuals(kinematics: &mut Kinematics, t: f64) -> Option<Residuals> {
    let determined = kinematics.determined();
    if determined.system().has_signals() || determined.blocks().iter().all(|block| block.explicit) {
        return None;
    }
    let estimates = kinematics.estimates();
    let residuals = residuals_of_drivers(kinematics, t, &estimates)?;
    let system = kinematics.system();
    let kept = driving_rows(system).into_iter().map(|row| kinematics.residual(row));
    let left_out = driving_checks(system).into_iter().map(|k| kinematics.check(k).abs() / system.checks()[k].scale);
    kept.chain(left_out).any(|open| open > AGREES).then_some(residuals)
}

/// Returns `Φ` of the rows of drivers, and of others that time moves, at a position, including those that are left out; `None` if one has
/// no value. The position is factored.
fn residuals_of_drivers(kinematics: &mut Kinematics, t: f64, q: &[f64]) -> Option<Residuals> {
    set_start(kinematics, t);
    kinematics.set_position(q).ok()?;
    // blocks may well be singular there
    let _ = kinematics.factor();
    let (determined, system) = (kinematics.determined(), kinematics.system());
    let numbers = determined.kept();
    let kept = driving_rows(system).into_iter().map(|row| (numbers[row], kinematics.phi(row)));
    let left_out = driving_checks(system).into_iter().map(|k| (determined.left_out()[k], kinematics.check(k)));
    Some(kept.chain(left_out).collect())
}

/// Returns the rows that are solved and drive the mechanism.
fn driving_rows(system: &ConstraintSystem) -> Vec<usize> {
    let rows = system.rows();
    (0..rows.len()).filter(|&k| system.drives(rows[k].declaration, rows[k].phi)).collect()
}

/// Returns the equations that are left out and drive the mechanism, by their number among the checks.
fn driving_checks(system: &ConstraintSystem) -> Vec<usize> {
    let checks = system.checks();
    (0..checks.len()).filter(|&k| system.drives(checks[k].declaration, checks[k].phi)).collect()
}

/// Returns the position to which the estimates lead if drivers let go, and the residuals of the drivers there; `None` if nothing closes.
pub fn close_without_drivers(kinematics: &mut Kinematics, t: f64) -> Option<(Vec<f64>, Residuals)> {
    let mut q = kinematics.estimates();
    if q.len() > LARGEST_DENSE {
        return None;
    }
    set_start(kinematics, t);
    let driving = driving_rows(kinematics.system());
    let columns: Vec<u32> = (0..q.len() as u32).collect();
    let rows: Vec<u32> = columns.iter().copied().filter(|&row| !driving.contains(&(row as usize))).collect();
    levenberg_marquardt(kinematics, &mut q, &rows, &columns);
    let residuals = residuals_of_drivers(kinematics, t, &q)?;
    (kinematics.hold_nearly(&rows, LARGEST_OPENING) && kinematics.turned_lines().is_empty()).then_some((q, residuals))
}

/// Sets the start time; at a switch its later side counts.
fn set_start(kinematics: &mut Kinematics, t: f64) {
    let span = kinematics.span();
    kinematics.settle_time(behind_start(t, span));
    kinematics.freeze(true, false);
    kinematics.set_time(t);
}

/// Returns the position in which all loops but the reported one are closed, if [`assemble`] finds no position.
pub fn nearest(kinematics: &mut Kinematics, t: f64) -> Option<Vec<f64>> {
    let estimates = kinematics.estimates();
    set_start(kinematics, t);
    kinematics.set_position(&estimates).ok()?;
    let start = explicit_first(kinematics, &estimates);
    kinematics.set_position(&start).ok()?;
    let q = least_squares(kinematics, start).q;
    open_loop::opened(&kinematics.determined(), &q, t)
}

/// Returns the displacement of the bodies from one position to another.
pub(super) fn moved(system: &ConstraintSystem, from: &[f64], to: &[f64]) -> Moved {
    let mut moved = Moved::default();
    for (k, (a, b)) in from.iter().zip(to).enumerate() {
        let Some(body) = system.body_of(k) else {
            continue;
        };
        let way = (b - a).abs();
        match system.coordinates()[k].kind {
            CoordinateKind::Length if way > moved.length => (moved.length, moved.length_body) = (way, body),
            CoordinateKind::Angle if way > moved.angle => (moved.angle, moved.angle_body) = (way, body),
            _ => {}
        }
    }
    moved
}

/// Returns the estimates after correcting the coordinates that follow from others without iteration: a driven crank, the locations of the
/// bodies on it. So their estimates may be far off.
fn explicit_first(kinematics: &mut Kinematics, estimates: &[f64]) -> Vec<f64> {
    let mut q = estimates.to_vec();
    let mut delta = vec![0.0; q.len()];
    for _ in 0..MOST_STEPS {
        if kinematics.set_position(&q).is_err() {
            return estimates.to_vec();
        }
        // other blocks may well be singular still
        let _ = kinematics.factor();
        let size = kinematics.explicit_correction(&mut delta);
        if !size.is_finite() {
            return estimates.to_vec();
        }
        for (q, delta) in q.iter_mut().zip(&delta) {
            *q += delta;
        }
        if size <= SETTLED {
            return q;
        }
    }
    estimates.to_vec()
}

/// Returns the position at which Newton's method arrives, with every line of centres pointing from the first centre to the second: the equations
/// alone would let it point the other way.
fn assembled(kinematics: &mut Kinematics, start: &[f64]) -> Option<Vec<f64>> {
    let q = newton(kinematics, start)?;
    let turned = kinematics.turned_lines();
    if turned.is_empty() {
        return kinematics.broken_check().is_none().then_some(q);
    }
    let mut flipped = q;
    for theta in turned {
        flipped[theta] += if flipped[theta] > start[theta] { -PI } else { PI };
    }
    let q = newton(kinematics, &flipped)?;
    (kinematics.turned_lines().is_empty() && kinematics.broken_check().is_none()).then_some(q)
}

/// Damped Newton, judged by the size of the next correction with the same factors (P. Deuflhard, *Newton Methods for
/// Nonlinear Problems*, 2004, section 3.3): the judgement does not depend on how rows are scaled.
fn newton(kinematics: &mut Kinematics, start: &[f64]) -> Option<Vec<f64>> {
    let n = start.len();
    let (mut q, mut trial) = (start.to_vec(), start.to_vec());
    let (mut delta, mut next) = (vec![0.0; n], vec![0.0; n]);
    kinematics.set_position(&q).ok()?;
    for _ in 0..MOST_STEPS {
        kinematics.factor().ok()?;
        let size = kinematics.correction(&mut delta);
        if !size.is_finite() {
            return None;
        }
        let mut damping = f64::min(1.0, LARGEST_STEP / kinematics.linear().largest_implicit(&delta));
        loop {
            for k in 0..n {
                trial[k] = q[k] + damping * delta[k];
            }
            let smaller = kinematics.set_position(&trial).is_ok() && {
                let next_size = kinematics.correction(&mut next);
                next_size <= (1.0 - 0.25 * damping) * size || size <= SETTLED
            };
            if smaller {
                break;
            }
            damping *= 0.5;
            if damping < SMALLEST_DAMPING {
                return None;
            }
        }
        q.copy_from_slice(&trial);
        if size <= SETTLED && kinematics.violated().is_none() {
            return Some(q);
        }
    }
    None
}

/// Returns the assembled position, and whether the estimates had to be perturbed to find it.
fn by_least_squares(kinematics: &mut Kinematics, estimates: &[f64], t: f64) -> Result<(Vec<f64>, bool), Box<Stop>> {
    let mut nearest = None;
    let mut noise = Noise::new();
    let mut start = estimates.to_vec();
    let mut is_moved = vec![true; estimates.len()];
    for size in std::iter::once(0.0).chain(PERTURBATIONS) {
        if kinematics.is_cancelled() {
            break;
        }
        for (k, start) in start.iter_mut().enumerate() {
            let offset = size * kinematics.linear().column_scale(k) * noise.next();
            *start = if is_moved[k] { estimates[k] + offset } else { *start };
        }
        let Rest { q, open } = least_squares(kinematics, start.clone());
        if let Some(polished) = assembled(kinematics, &q) {
            return Ok((polished, size > 0.0));
        }
        let _ = kinematics.set_position(&q);
        let _ = kinematics.factor();
        let is_closed = kinematics.violated().is_none() && kinematics.turned_lines().is_empty();
        if is_closed && kinematics.broken_check().is_none() {
            // assembled, but Newton does not settle: a singular position
            return Ok((q, size > 0.0));
        }
        if let Some(open) = open {
            // blocks that close without the open one keep their positions
            start.copy_from_slice(&q);
            let determined = kinematics.determined();
            let needed = determined.needed_by(open).into_iter().flat_map(|block| &determined.blocks()[block].columns);
            is_moved.fill(false);
            needed.for_each(|&column| is_moved[column as usize] = true);
        }
        nearest.get_or_insert(q);
    }
    let q = nearest.unwrap_or_else(|| estimates.to_vec());
    Err(find_stop(kinematics, &q, t))
}

/// Returns the stop where `q` is as near to an assembled position as it comes: the loop that stays open.
fn find_stop(kinematics: &mut Kinematics, q: &[f64], t: f64) -> Box<Stop> {
    if let Err(fault) = kinematics.set_position(q) {
        return singular::without_value(kinematics.system(), fault).at(t);
    }
    if let Some(open) = open_loop::found(&kinematics.determined(), q, t) {
        return StopCause::OpenLoop(Box::new(open)).at(t);
    }
    let _ = kinematics.factor();
    if kinematics.violated().is_none()
        && let Some(index) = kinematics.broken_check()
    {
        return StopCause::RedundantRowAtStart { check: index }.at(t);
    }
    let open = |row: usize| kinematics.residual(row);
    let worst = (0..q.len()).max_by(|&a, &b| open(a).total_cmp(&open(b))).unwrap_or(0);
    StopCause::NotAssembled { row: worst, residual: open(worst) }.at(t)
}

/// Refuses a position in which a tangent vanishes: parallel tangents mean nothing there, and the root is spurious.
fn refuse_vanishing_tangents(kinematics: &mut Kinematics, q: &[f64], t: f64) -> Result<(), Box<Stop>> {
    let determined = kinematics.determined();
    let system = determined.system();
    if kinematics.set_position(q).is_err() {
        return Ok(());
    }
    let vanishes = |k: &usize| {
        system.monitors()[*k].kind == MonitorKind::Tangents && kinematics.monitored(*k).abs() < VANISHING_TANGENT
    };
    match (0..system.monitors().len()).find(vanishes) {
        Some(monitor) => Err(StopCause::NoContact { monitor }.at(t)),
        None => Ok(()),
    }
}

/// Checks that the equations are independent where the motion starts.
fn refuse_singular(kinematics: &mut Kinematics, q: &[f64], t: f64) -> Result<(), Box<Stop>> {
    let determined = kinematics.determined();
    let system = determined.system();
    kinematics.measure_slopes(q);
    let factored = kinematics.set_position(q).and_then(|()| kinematics.factor());
    if let Err(fault @ (Fault::NotFinite { .. } | Fault::Condition { .. })) = factored {
        return Err(singular::without_value(system, fault).at(t));
    }
    if let Some(row) = kinematics.row_without_slope(SINGULAR_START) {
        return Err(StopCause::WithoutEffect { row }.at(t));
    }
    if factored.is_ok() && kinematics.nearness(SINGULAR_START) > SINGULAR_START {
        return Ok(());
    }
    let vectors = kinematics.worst();
    let elsewhere = independent_elsewhere(kinematics, q, &vectors.right, t)
        .or_else(|| independent_without(kinematics, q, singular::driver_in(system, &vectors.left)?, &vectors.right, t));
    Err(singular::singular_start(system, &vectors, elsewhere, Horizon { from: t, span: kinematics.span() }))
}

/// Returns whether the equations are independent in a position nearby; `None` if there is no other one.
fn independent_elsewhere(kinematics: &mut Kinematics, q: &[f64], free: &[f64], t: f64) -> Option<bool> {
    independent_later(kinematics, q, t).or_else(|| {
        kinematics.set_time(t);
        independent_nearby(kinematics, q, free)
    })
}

/// Returns whether the equations are independent near a position, where its free motion leads if a driver lets go; `None` if it leads nowhere.
fn independent_without(kinematics: &mut Kinematics, q: &[f64], driver: usize, free: &[f64], t: f64) -> Option<bool> {
    if q.len() > LARGEST_DENSE {
        return None;
    }
    kinematics.set_time(t);
    let columns: Vec<u32> = (0..q.len() as u32).collect();
    let rows: Vec<u32> = columns.iter().copied().filter(|&row| row as usize != driver).collect();
    [NUDGE, -NUDGE].into_iter().find_map(|way| {
        let mut near = moved_along(kinematics, q, free, way);
        levenberg_marquardt(kinematics, &mut near, &rows, &columns);
        independent_where(kinematics, q, &near, &rows)
    })
}

/// Returns whether the equations are independent near a position, where its free motion leads; `None` if it leads nowhere.
fn independent_nearby(kinematics: &mut Kinematics, q: &[f64], free: &[f64]) -> Option<bool> {
    [NUDGE, -NUDGE].into_iter().find_map(|way| {
        let start = moved_along(kinematics, q, free, way);
        independent_at(kinematics, q, start)
    })
}

/// Returns a position moved along a free motion, scaled.
fn moved_along(kinematics: &Kinematics, q: &[f64], free: &[f64], way: f64) -> Vec<f64> {
    (0..q.len()).map(|k| q[k] + way * free[k] * kinematics.linear().column_scale(k)).collect()
}

/// Returns whether the equations are independent at a time nearby; `None` if no position can be had there, as when every driver rests.
fn independent_later(kinematics: &mut Kinematics, q: &[f64], t: f64) -> Option<bool> {
    let span = kinematics.span();
    NEARBY.into_iter().flat_map(|part| [part, -part]).find_map(|part| {
        kinematics.set_time(t + part * span);
        independent_at(kinematics, q, q.to_vec())
    })
}

/// Returns whether the equations are independent where least squares lead from a start; `None` if that is `q` again, or nowhere.
fn independent_at(kinematics: &mut Kinematics, q: &[f64], start: Vec<f64>) -> Option<bool> {
    let near = least_squares(kinematics, start).q;
    let all: Vec<u32> = (0..q.len() as u32).collect();
    independent_where(kinematics, q, &near, &all)
}

/// Returns whether the equations are independent in a position where some of them hold; `None` if it is `q`, or they do not hold.
fn independent_where(kinematics: &mut Kinematics, q: &[f64], near: &[f64], rows: &[u32]) -> Option<bool> {
    let far = |k: usize| (near[k] - q[k]).abs() > SAME * kinematics.linear().column_scale(k);
    let moved = (0..q.len()).any(far);
    let holds = kinematics.set_position(near).is_ok() && {
        let _ = kinematics.factor();
        kinematics.hold_nearly(rows, LARGEST_OPENING)
    };
    (moved && holds).then(|| kinematics.nearness(SINGULAR_START) > SINGULAR_START)
}

/// Minimum that least squares reach.
struct Rest {
    q: Vec<f64>,
    /// Number of the first block that stays open, if blocks were minimized one by one.
    open: Option<usize>,
}

/// Levenberg–Marquardt on the whole or block by block.
fn least_squares(kinematics: &mut Kinematics, mut q: Vec<f64>) -> Rest {
    let n = q.len();
    if n > LARGEST_DENSE {
        return block_by_block(kinematics, q);
    }
    let all: Vec<u32> = (0..n as u32).collect();
    levenberg_marquardt(kinematics, &mut q, &all, &all);
    Rest { q, open: None }
}

/// Minimizes block by block, up to the first that stays open: those behind it may depend on it. Those that are closed take no time.
fn block_by_block(kinematics: &mut Kinematics, mut q: Vec<f64>) -> Rest {
    let determined = kinematics.determined();
    let mut is_there = kinematics.set_position(&q).is_ok();
    let _ = kinematics.factor();
    for (number, block) in determined.blocks().iter().enumerate().filter(|(_, block)| block.rows.len() <= LARGEST_DENSE)
    {
        if !is_there {
            break;
        }
        if kinematics.hold(&block.rows) {
            continue;
        }
        levenberg_marquardt(kinematics, &mut q, &block.rows, &block.columns);
        is_there = kinematics.set_position(&q).is_ok();
        let _ = kinematics.factor();
        if is_there && !kinematics.hold(&block.rows) {
            return Rest { q, open: Some(number) };
        }
    }
    Rest { q, open: None }
}
