//! Finds the reason why an analysis stops: which formula, which lock-up, which bifurcation.

use super::errors::{self, StartVerdict};
use super::stop::{SingularPosition, Stop, StopCause, Warning, WarningCause};
use crate::analysis::state::{Fault, Horizon, Kinematics, Singular, State};
use crate::limits::explain::{NAMED, SEEN};
use crate::limits::redundancy::NO_SHARE;
use crate::limits::singular::NEAR_FOLD;
use mechc_ir::program::BoundaryRegisters;
use mechc_ir::{ConstraintSystem, DeclarationId, DeclarationKind, Monitor, MonitorKind};

/// A position closer to a singular one than this is called singular, or as close as steps could get.
const NEAR: f64 = 1e-2;
/// A relative curvature below this is called zero near a singular position.
const FLAT: f64 = 1e-3;
/// A curve has a cusp if its radius of curvature is below this part of its body's size, and its tangent vanishes.
const CUSP: f64 = 1e-2;
/// A formula has reached the end of a function's domain, or a pole, if at most this part of its terms is left.
const VANISHED: f64 = 1e-6;
/// A formula that ends is the explanation if it does so within this many of the last steps.
const STEPS_AHEAD: f64 = 1000.0;
/// Largest deviation from a parabola, which is four times as large at twice the distance from zero, for an event function.
const PARABOLA: f64 = 0.25;

/// Returns why no step leads on from the last accepted state, where even one as small as `h` (s) towards `target` (s) failed.
pub fn find_stop(kinematics: &mut Kinematics, state: &State, fault: Fault, [h, target]: [f64; 2]) -> Box<Stop> {
    find_stop_near_fold(kinematics, state, fault, [h, target], None)
}

/// Returns why no step leads on, as [`find_stop`] does, where the mechanism comes to the end of its reach at the time `fold` (s).
pub fn find_stop_near_fold(
    kinematics: &mut Kinematics,
    state: &State,
    fault: Fault,
    [h, target]: [f64; 2],
    fold: Option<f64>,
) -> Box<Stop> {
    let determined = kinematics.determined();
    let system = determined.system();
    if let Fault::NotFinite { .. } | Fault::Condition { .. } = fault {
        return without_value(system, fault).at(state.t + h);
    }
    if let Fault::Check { index } = fault {
        return StopCause::RedundantRow { check: index }.at(state.t);
    }
    // a formula that ends just ahead, or at the end of the step, explains more than the equations do
    let just_ahead = f64::min(state.t + STEPS_AHEAD * h, target);
    if let Some(fault) = fault_at(kinematics, state, just_ahead) {
        return without_value(system, fault).at(state.t);
    }
    kinematics.restore(state);
    let residual = kinematics.largest_residual();
    let singular = kinematics.worst();
    if let Some(index) = contact_that_ends(kinematics, fault, singular.sigma) {
        return end_of_contact(kinematics, index, state.t);
    }
    let stop = if singular.sigma < NEAR {
        singular_position(kinematics, state, &singular, fold)
    } else if let Some(fault) = fault_at(kinematics, state, target) {
        without_value(system, fault).at(target)
    } else if let Some(at_boundary) = boundary_reached(kinematics, state) {
        at_boundary
    } else {
        StopCause::NoStep { driver: fastest_driver(kinematics, state, just_ahead) }.at(state.t)
    };
    Box::new(Stop { residual: Some(residual), ..*stop })
}

/// Returns the cause of a formula that has no value, or not one that it may have.
pub fn without_value(system: &ConstraintSystem, fault: Fault) -> StopCause {
    match fault {
        Fault::NotFinite { row } => StopCause::NotFinite { declarations: vec![system.rows()[row].declaration] },
        Fault::Condition { index } => StopCause::Condition { index },
        Fault::Monitor { index } => StopCause::NoContact { monitor: index },
        Fault::Check { index } => StopCause::RedundantRow { check: index },
        Fault::Singular
        | Fault::Uncertain
        | Fault::TooFar
        | Fault::Choice
        | Fault::DomainBoundary
        | Fault::Edge { .. } => StopCause::NoStep { driver: None },
    }
}

/// Returns the index of the monitor of the contact that ends at the current position.
fn contact_that_ends(kinematics: &Kinematics, fault: Fault, sigma: f64) -> Option<usize> {
    let monitors = kinematics.system().monitors();
    match fault {
        // a curvature that reaches zero makes the position singular, one that jumps past zero does not
        Fault::Monitor { index } if monitors[index].kind != MonitorKind::Curvature || sigma > NEAR => Some(index),
        _ => centers_that_meet(kinematics).or_else(|| vanishing(kinematics, MonitorKind::Tangents)),
    }
}

/// Returns the stop at the singular position that was set; `fold` is when the mechanism comes to the end of its reach (s).
fn singular_position(kinematics: &Kinematics, state: &State, singular: &Singular, fold: Option<f64>) -> Box<Stop> {
    let system = kinematics.system();
    let (left, right) = (&singular.left, &singular.right);
    // the driver's share is small near a bifurcation that is narrowly missed
    let (driver, t) = match fold.zip(heaviest_driver(system, left)) {
        Some((t, row)) => (Some(row), t),
        None => (driver_in(system, left), time_of_fold(kinematics.span(), state, right)),
    };
    let singular = SingularPosition {
        joints: joints_in(system, left),
        columns: columns_in(right),
        flat_contact: flat_contact(kinematics),
    };
    match driver {
        Some(driver) => StopCause::LockUp { driver, singular }.at(t),
        None => StopCause::Bifurcation { singular }.at(t),
    }
}

/// Returns the time (s) of a fold ahead: there q* − q ∝ √(t* − t), so t* − t = q̇ / 2q̈. Returns the time of the state if the fold is not ahead
/// or is too far.
fn time_of_fold(span: f64, state: &State, right: &[f64]) -> f64 {
    let fastest = (0..right.len()).max_by(|&a, &b| right[a].abs().total_cmp(&right[b].abs()));
    let left = fastest.map_or(0.0, |k| 0.5 * state.qd[k] / state.qdd[k]);
    if left > 0.0 && left < NEAR_FOLD * span { state.t + left } else { state.t }
}

/// Returns the stop at a contact that ends at a time (s), by its monitor, at the position that was set or just behind it.
pub fn end_of_contact(kinematics: &Kinematics, index: usize, t: f64) -> Box<Stop> {
    let system = kinematics.system();
    let monitors = system.monitors();
    let Monitor { kind, declaration, .. } = monitors[index];
    let is_flat = matches!(system.declarations()[declaration].kind, DeclarationKind::Joint(joint) if joint.has_face());
    let of_contact = |k: &usize| monitors[*k].kind == MonitorKind::Curvature && monitors[*k].declaration == declaration;
    let curvature = (0..monitors.len()).find(of_contact).map_or(0.0, |k| kinematics.monitored(k).abs());
    // with `T` the tangent and `B` its derivative the radius is T²/B across; where the argument alone rests it is no less than usual
    let tangent = kinematics.monitored(index);
    if kind == MonitorKind::Tangents && is_flat && tangent * tangent < CUSP * curvature {
        StopCause::Undercut { monitor: index }.at(t)
    } else {
        StopCause::NoContact { monitor: index }.at(t)
    }
}

/// Returns the stop at a bifurcation that is not passed.
pub fn stop_at_bifurcation(kinematics: &mut Kinematics, state: &State) -> Box<Stop> {
    kinematics.restore(state);
    let singular = kinematics.worst();
    let system = kinematics.system();
    let joints = joints_in(system, &singular.left);
    let cause = match driver_in(system, &singular.left) {
        Some(driver) => StopCause::RestInDeadPoint { driver, joints },
        None => StopCause::Bifurcation {
            singular: SingularPosition { joints, columns: columns_in(&singular.right), flat_contact: None },
        },
    };
    cause.at(state.t)
}

/// Returns the warning of a bifurcation that is passed.
pub fn warn_of_passage(kinematics: &mut Kinematics, state: &State) -> Warning {
    kinematics.restore(state);
    let singular = kinematics.worst();
    let system = kinematics.system();
    let driver = driver_in(system, &singular.left);
    let (joints, columns) = (joints_in(system, &singular.left), columns_in(&singular.right));
    Warning { t: state.t, cause: WarningCause::Passed { driver, joints, columns } }
}

/// Returns the warning of a singular position that the motion has missed by a part of the lengths, at the state that is nearest to it; `None`
/// if no body could have gone another way: a contact may run fast along its curve.
pub fn warn_of_miss(kinematics: &mut Kinematics, state: &State, within: f64, t: f64) -> Option<Warning> {
    kinematics.restore(state);
    let singular = kinematics.worst();
    let system = kinematics.system();
    let (joints, columns) = (joints_in(system, &singular.left), columns_in(&singular.right));
    let moves_bodies = columns.iter().any(|&column| system.body_of(column).is_some());
    moves_bodies.then_some(Warning { t, cause: WarningCause::NearChangePoint { joints, columns, within } })
}

/// Returns the index of the monitor of a line of centres that vanishes, or nearly so, at the current position.
pub fn centers_that_meet(kinematics: &Kinematics) -> Option<usize> {
    vanishing(kinematics, MonitorKind::LineOfCenters)
}

/// Returns the index of the monitor of a kind whose quantity vanishes, or nearly so, at the current position.
fn vanishing(kinematics: &Kinematics, kind: MonitorKind) -> Option<usize> {
    let monitors = kinematics.system().monitors();
    (0..monitors.len()).find(|&k| monitors[k].kind == kind && kinematics.monitored(k).abs() < FLAT)
}

/// Returns the joint at whose contact the relative curvature vanishes, or nearly so, at the current position.
fn flat_contact(kinematics: &Kinematics) -> Option<DeclarationId> {
    vanishing(kinematics, MonitorKind::Curvature).map(|k| kinematics.system().monitors()[k].declaration)
}

/// Returns the stop of a motion that did not reach `target` (s) within `steps` steps.
pub fn find_stop_of_haste(kinematics: &mut Kinematics, state: &State, steps: u64, target: f64) -> Box<Stop> {
    let determined = kinematics.determined();
    let system = determined.system();
    match fault_at(kinematics, state, target) {
        Some(fault) => without_value(system, fault).at(target),
        None => StopCause::TooFast { driver: fastest_driver(kinematics, state, target), target, steps }.at(state.t),
    }
}

/// Returns the stop at the nearest domain boundary, if the state has reached it or nearly so.
fn boundary_reached(kinematics: &mut Kinematics, state: &State) -> Option<Box<Stop>> {
    kinematics.restore(state);
    let span = kinematics.span();
    let boundaries = kinematics.boundaries().to_vec();
    let mut left = |boundary: &BoundaryRegisters| {
        let [gauge, slope] = gauge_at(kinematics, boundary, state, 0.0);
        f64::min(gauge.abs() / kinematics.largest_term(boundary), VANISHED / NEAR_FOLD * (gauge / slope).abs() / span)
    };
    // a boundary of time alone is explained by its driver, the fastest one
    let of_motion = boundaries.iter().enumerate().filter(|(_, boundary)| !boundary.on_time);
    let nearest = of_motion.map(|(index, boundary)| (index, left(boundary))).min_by(|a, b| a.1.total_cmp(&b.1));
    let index = nearest.filter(|(_, left)| *left < VANISHED).map(|(index, _)| index)?;
    let corner = corner_ahead(kinematics, &boundaries[index], state);
    let system = kinematics.system();
    let declarations = system.domain_boundaries()[index].declarations.clone();
    let has_tangent = declarations.iter().any(|&declaration| errors::has_tangent(system, declaration));
    Some(match corner.filter(|_| has_tangent) {
        Some(left) => StopCause::PositionJump { declarations, jump: None, is_corner: true }.at(state.t + left),
        None => StopCause::NotFinite { declarations }.at(state.t),
    })
}

/// Returns the time (s) until an event function touches zero without a change of sign, at a corner of its formula; `None` if it crosses zero.
fn corner_ahead(kinematics: &mut Kinematics, boundary: &BoundaryRegisters, state: &State) -> Option<f64> {
    let [gauge, slope] = gauge_at(kinematics, boundary, state, 0.0);
    let left = -2.0 * gauge / slope;
    let [before, _] = gauge_at(kinematics, boundary, state, -left);
    // twice as far from it a parabola that touches zero has four times its value; a line has three times that
    (left > 0.0 && (before / gauge - 4.0).abs() < PARABOLA).then_some(left)
}

/// Returns an event function and its slope a time `after` (s) later, at constant velocity.
fn gauge_at(kinematics: &mut Kinematics, boundary: &BoundaryRegisters, state: &State, after: f64) -> [f64; 2] {
    let q: Vec<f64> = state.q.iter().zip(&state.qd).map(|(q, qd)| q + after * qd).collect();
    kinematics.set_time(state.t + after);
    // a fault of the position shows in the event function
    let _ = kinematics.set_position(&q);
    kinematics.set_velocity(&state.qd);
    kinematics.gauge(boundary)
}

/// Returns why a formula has no value at a time (s), at the position of the state.
fn fault_at(kinematics: &mut Kinematics, state: &State, t: f64) -> Option<Fault> {
    kinematics.set_time(t);
    kinematics.set_position(&state.q).err()
}

/// Returns the stop at a position so near to a singular one that rounding hides its derivatives.
pub fn uncertain(system: &ConstraintSystem, left: &[f64], t: f64) -> Box<Stop> {
    StopCause::Uncertain { declarations: declarations_in(system, left) }.at(t)
}

/// Returns the stop of a start in a singular position.
///
/// `elsewhere` is whether the equations are independent at a time nearby, where that is known.
pub fn singular_start(
    system: &ConstraintSystem,
    singular: &Singular,
    elsewhere: Option<bool>,
    horizon: Horizon,
) -> Box<Stop> {
    let Singular { left, right, .. } = singular;
    let verdict = match (elsewhere, driver_in(system, left)) {
        (Some(false), _) => StartVerdict::Always,
        (Some(true), Some(row)) => StartVerdict::LockUp(row),
        (Some(true), None) => StartVerdict::Bifurcation,
        (None, _) => StartVerdict::Unknown,
    };
    let (declarations, columns) = (declarations_in(system, left), columns_in(right));
    StopCause::SingularStart { verdict, declarations, free: right.clone(), columns, horizon }.at(horizon.from)
}

/// Returns the driver's row that weighs most in a dependency, if one takes part.
pub fn driver_in(system: &ConstraintSystem, left: &[f64]) -> Option<usize> {
    let largest = left.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    heaviest_driver(system, left).filter(|&row| left[row].abs() > SEEN * largest)
}

/// Returns the driver's row that weighs most in a dependency, however small its weight.
fn heaviest_driver(system: &ConstraintSystem, left: &[f64]) -> Option<usize> {
    let drivers = (0..left.len()).filter(|&row| system.is_driver(row) && left[row].abs() > 0.0);
    drivers.max_by(|&a, &b| left[a].abs().total_cmp(&left[b].abs()))
}

/// Returns the joints and constraints of the dependency, by decreasing weight.
fn joints_in(system: &ConstraintSystem, left: &[f64]) -> Vec<DeclarationId> {
    let all = declarations_in(system, left);
    all.into_iter().filter(|&k| system.declarations()[k].kind != DeclarationKind::Driver).collect()
}

/// Returns the declarations of the dependency, by decreasing weight.
fn declarations_in(system: &ConstraintSystem, left: &[f64]) -> Vec<DeclarationId> {
    let largest = left.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    let mut rows: Vec<usize> = (0..left.len()).filter(|&row| left[row].abs() > NAMED * largest).collect();
    let weight = |row: usize| (left[row].abs() / largest / NO_SHARE).round();
    rows.sort_by(|&a, &b| weight(b).total_cmp(&weight(a)));
    let mut joints: Vec<DeclarationId> = Vec::new();
    for row in rows {
        let declaration = system.rows()[row].declaration;
        if !joints.contains(&declaration) {
            joints.push(declaration);
        }
    }
    joints
}

/// Returns the coordinates that the free motion moves.
fn columns_in(right: &[f64]) -> Vec<usize> {
    let fastest = right.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    (0..right.len()).filter(|&column| right[column].abs() > NAMED * fastest).collect()
}

/// Returns the row of the driver that prescribes the fastest motion from the state on, or by a jump up to a time `t` just ahead (s).
fn fastest_driver(kinematics: &mut Kinematics, state: &State, t: f64) -> Option<usize> {
    let determined = kinematics.determined();
    let system = determined.system();
    kinematics.restore(state);
    // the prescribed speeds are finite even where those of the mechanism are not
    let _ = kinematics.derivatives(&mut state.clone());
    let speeds: Vec<f64> = (0..system.rows().len()).map(|row| kinematics.prescribed_speed(row)).collect();
    kinematics.set_time(t);
    let is_set = kinematics.set_position(&state.q).is_ok();
    let speed = |row: usize| {
        let jump = if is_set && t > state.t { kinematics.residual(row) / (t - state.t) } else { 0.0 };
        f64::max(speeds[row], jump)
    };
    let drivers = (0..system.rows().len()).filter(|&row| system.is_driver(row) && speed(row) > 0.0);
    drivers.max_by(|&a, &b| speed(a).total_cmp(&speed(b)))
}
