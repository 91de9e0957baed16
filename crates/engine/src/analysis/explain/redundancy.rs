//! Too many equations: which of them are redundant, and which conflict with the others.
//!
//! All equations of a part are assembled together by least squares. There each one is taken in turn, joints first and drivers last, and
//! depends on those before it or not. Whether a dependent one is redundant or conflicts with them is decided at nearby times too: two
//! drivers may agree at the start and part at once.

use super::errors;
use super::evaluator::Evaluator;
use super::orthonormal::Basis;
use crate::limits::assembly::NEARBY;
use crate::limits::explain::YIELDING;
use crate::limits::redundancy::{HEAVY, LARGEST_OPENING, MOST_EXCHANGES, NO_SHARE};
use mechc_ir::structure::Subsystem;

/// An equation that depends on others.
#[derive(Clone, Debug)]
pub struct Dependent {
    /// Its row.
    pub row: usize,
    /// The rows it depends on.
    pub on: Vec<usize>,
    /// Gap if the others are met (m or rad, by its coordinates), and the first time of it (s); `None` if the equation holds.
    pub open: Option<(f64, f64)>,
    /// True if it holds, but not wherever the others let the mechanism go: it fixes something, though it has no slope where it does.
    pub touches: bool,
}

/// Returns the equations of a part that depend on those before them, from the start at `t` on over a span of time (s); `None` if they have
/// no values. If all hold, others may be reported in place of some without which the rest would nearly depend on each other.
pub fn dependents(evaluator: &mut Evaluator<'_>, part: &Subsystem, times: [f64; 2]) -> Option<Vec<Dependent>> {
    let basis = basis_of_start(evaluator, part, times)?;
    let start = evaluator.q.clone();
    let dependents = judged(evaluator, part, &basis, times)?;
    if dependents.iter().any(|dependent| dependent.touches) {
        return Some(dependents);
    }
    let there = evaluator.q.clone();
    let other = well_chosen(basis.clone(), |k| evaluator.system.is_driver(part.rows[k] as usize));
    if other.kept == basis.kept {
        return Some(dependents);
    }
    evaluator.q = start;
    let others = judged(evaluator, part, &other, times)?;
    if others.iter().all(|dependent| dependent.open.is_none() && !dependent.touches) {
        return Some(others);
    }
    evaluator.q = there;
    Some(dependents)
}

/// Returns the equations that depend on those of a basis, and whether they hold together with them.
fn judged(
    evaluator: &mut Evaluator<'_>,
    part: &Subsystem,
    basis: &Basis,
    [t, span]: [f64; 2],
) -> Option<Vec<Dependent>> {
    let row = |k: usize| part.rows[k] as usize;
    let mut dependents: Vec<Dependent> = basis
        .dependent
        .iter()
        .map(|(k, on)| Dependent {
            row: row(*k),
            on: on.iter().map(|&(k, _)| row(k)).collect(),
            open: None,
            touches: false,
        })
        .collect();
    let kept: Vec<u32> = basis.kept.iter().map(|&k| part.rows[k]).collect();
    for t in times_nearby(t, span) {
        let before = evaluator.q.clone();
        let met = evaluator.assemble(&kept, &part.columns, None, t)?;
        // a singular position has only half the digits
        let is_singular = || basis_of(&met.jacobian, part.columns.len()).kept.len() < kept.len();
        let holds = |limit: f64| met.residual.iter().all(|open| open.abs() <= limit);
        let rows: Vec<u32> = dependents.iter().map(|dependent| dependent.row as u32).collect();
        let all = evaluator.linear(&rows, &part.columns, None, t)?.residual;
        if holds(LARGEST_OPENING) && all.iter().all(|open| open.abs() <= LARGEST_OPENING) {
            continue;
        }
        let limit = if is_singular() { LARGEST_OPENING.sqrt() } else { LARGEST_OPENING };
        // the kept equations may lead to another branch than all together
        if kept.len() >= part.columns.len() && all_hold(evaluator, part, &before, t)? {
            continue;
        }
        let is_met = holds(limit);
        for dependent in dependents.iter_mut().filter(|dependent| dependent.open.is_none()) {
            let open = evaluator.linear(&[dependent.row as u32], &part.columns, None, t)?.residual[0].abs();
            if is_met && open <= limit {
                continue;
            }
            if is_met && closes(evaluator, &kept, dependent.row, part, t)? {
                dependent.touches = true;
                continue;
            }
            dependent.open = Some((gap_of_declaration(evaluator, part, dependent.row, t)?, t));
        }
    }
    if dependents.iter().any(|dependent| dependent.open.is_some()) {
        add_hidden(evaluator, part, t, &mut dependents);
    }
    Some(dependents)
}

/// Returns whether all equations of a part can be met from a position; if so, the evaluator moves there.
fn all_hold(evaluator: &mut Evaluator<'_>, part: &Subsystem, from: &[f64], t: f64) -> Option<bool> {
    let q = std::mem::replace(&mut evaluator.q, from.to_vec());
    let met = evaluator.assemble(&part.rows, &part.columns, None, t)?;
    let hold = met.residual.iter().all(|open| open.abs() <= LARGEST_OPENING);
    if !hold {
        evaluator.q = q;
    }
    Some(hold)
}

/// Returns whether an equation can be met along a motion that others leave free, though it changes in second order only; if so, the
/// evaluator moves there.
fn closes(evaluator: &mut Evaluator<'_>, kept: &[u32], row: usize, part: &Subsystem, t: f64) -> Option<bool> {
    if kept.len() >= part.columns.len() {
        return Some(false);
    }
    let q = evaluator.q.clone();
    let all: Vec<u32> = kept.iter().copied().chain([row as u32]).collect();
    let met = evaluator.assemble(&all, &part.columns, None, t)?;
    let closes = met.residual.iter().all(|open| open.abs() <= LARGEST_OPENING);
    if !closes {
        evaluator.q = q;
    }
    Some(closes)
}

/// Returns how far all rows of a row's declaration are off where they are least off, with all other equations met.
fn gap_of_declaration(evaluator: &mut Evaluator<'_>, part: &Subsystem, row: usize, t: f64) -> Option<f64> {
    let system = evaluator.system;
    let is_of_declaration = |other: &u32| system.rows()[*other as usize].declaration == system.rows()[row].declaration;
    let rows = part.rows.iter().filter(|row| is_of_declaration(row));
    let q = evaluator.q.clone();
    let weights = evaluator.linear(&part.rows, &part.columns, None, t)?.weights;
    let weight = |(row, weight): (&u32, &f64)| if is_of_declaration(row) { weight * YIELDING } else { *weight };
    let weights: Vec<f64> = part.rows.iter().zip(&weights).map(weight).collect();
    evaluator.assemble(&part.rows, &part.columns, Some(&weights), t)?;
    let kind = errors::gap_kind(system, row);
    let of_kind = rows.map(|&row| row as usize).filter(|&row| errors::gap_kind(system, row) == kind);
    let gap = of_kind.map(|row| evaluator.gap(row)).map(|gap| gap * gap).sum::<f64>().sqrt();
    evaluator.q = q;
    Some(gap)
}

/// Returns the start at `t` and some times shortly after it, over a span of time (s).
pub fn times_nearby(t: f64, span: f64) -> impl Iterator<Item = f64> {
    std::iter::once(t).chain(NEARBY.map(|part| t + part * span))
}

/// Returns the basis at the start, or shortly after where fewer equations depend on others: a start may be in a singular position.
fn basis_of_start(evaluator: &mut Evaluator<'_>, part: &Subsystem, [t, span]: [f64; 2]) -> Option<Basis> {
    let mut best: Option<(Basis, Vec<f64>)> = None;
    for (k, t) in times_nearby(t, span).enumerate() {
        if k > 0 {
            // least squares would stay in line as drawn
            evaluator.nudge(&part.columns);
        }
        evaluator.assemble(&part.rows, &part.columns, None, t)?;
        let jacobian = evaluator.linear(&part.rows, &part.columns, None, t)?.jacobian;
        let basis = basis_of(&jacobian, part.columns.len());
        if best.as_ref().is_none_or(|(best, _)| basis.kept.len() > best.kept.len()) {
            let is_whole = basis.span.is_whole();
            best = Some((basis, evaluator.q.clone()));
            if is_whole {
                break;
            }
        }
    }
    let (basis, q) = best?;
    evaluator.q = q;
    Some(basis)
}

/// Exchanges rows of a basis until no dependent row has a large weight of a kept one, without which less would be nearly dependent. Drivers stay.
fn well_chosen(mut basis: Basis, is_driver: impl Fn(usize) -> bool) -> Basis {
    for _ in 0..MOST_EXCHANGES {
        let weights =
            basis.dependent.iter().enumerate().flat_map(|(index, (_, on))| on.iter().map(move |on| (index, *on)));
        let heavy = weights.filter(|(_, (k, weight))| weight.abs() > HEAVY && !is_driver(*k));
        let Some((index, (heaviest, _))) = heavy.max_by(|(_, (_, a)), (_, (_, b))| a.abs().total_cmp(&b.abs())) else {
            break;
        };
        basis.exchange(index, heaviest, NO_SHARE);
    }
    basis.dependent.sort_unstable_by_key(|&(k, _)| k);
    basis
}

/// Adds equations that take part in a conflict only near the position where it was found: a driven crank that is just in line has no part
/// in the location of its tip there, and has one nearby.
fn add_hidden(evaluator: &mut Evaluator<'_>, part: &Subsystem, t: f64, dependents: &mut [Dependent]) {
    evaluator.nudge(&part.columns);
    let Some(linear) = evaluator.linear(&part.rows, &part.columns, None, t) else {
        return;
    };
    let nearby = basis_of(&linear.jacobian, part.columns.len()).dependent;
    for dependent in dependents.iter_mut().filter(|dependent| dependent.open.is_some()) {
        let found = nearby.iter().find(|(k, _)| part.rows[*k] as usize == dependent.row);
        let on = found.into_iter().flat_map(|(_, on)| on).map(|&(k, _)| part.rows[k] as usize);
        dependent.on.extend(on);
        dependent.on.sort_unstable();
        dependent.on.dedup();
    }
}

/// Returns the basis of the rows of a Jacobian over `n` coordinates.
pub fn basis_of(jacobian: &[f64], n: usize) -> Basis {
    Basis::new(jacobian, n, NO_SHARE)
}
