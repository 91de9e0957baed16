//! Solves at a time, on the branches that hold there.

use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Fault;
use super::limits::{ACCURACY, MOST_BRANCHES, STEEP, STEEPEST};
use super::measured::Measured;
use super::numbers::{larger, largest};
use super::solution::{Along, Solution, Solved};
use super::work::Work;

/// Solves at a time from a guess; `from` is the previous solution of the motion.
pub fn reach<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    work: &mut Work,
) -> Result<(), Fault> {
    let of_time = sides_at(t, m, work);
    if !M::OF_MOTION {
        return find(guess, from, t, m, &of_time, at, work);
    }
    let mut sides = from.sides;
    for _ in 0..MOST_BRANCHES {
        sides = with_time::<M>(&sides, &of_time);
        find(guess, from, t, m, &sides, at, work)?;
        let now = sides_ahead(at, m);
        if now == sides {
            return Ok(());
        }
        sides = now;
    }
    Err(Fault::TooFar)
}

/// Solves on given branches of formulas.
pub fn find<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
    work: &mut Work,
) -> Result<(), Fault> {
    work.add(1);
    m.solve(guess, t, sides, at);
    if !at.is_settled || !at.holds {
        work.add(2);
        find_with_pivoting(from, t, m, sides, at)?;
    }
    if !m.conditions_hold(&at.q, t, sides) {
        return Err(Fault::NotANumber);
    }
    if !m.redundant_rows_hold(&at.q, t, sides) {
        return Err(Fault::LeftOut);
    }
    at.monitors = m.monitors(&at.q, t, sides);
    at.sides = *sides;
    at.along.note(m, t);
    at.measures.leave_out();
    if at.is_finite() { Ok(()) } else { Err(Fault::NotANumber) }
}

/// Solves by pivoting, then again by the operations from that position; keeps the result of pivoting if they fail again.
#[cold]
#[inline(never)]
fn find_with_pivoting<M: Solved>(
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
) -> Result<(), Fault> {
    let q = M::Along::predicted(m, from, t - from.t);
    let pivoted = m.pivoted(&q, t, sides, at)?;
    m.solve(&M::tears(&pivoted.q), t, sides, at);
    let first = pivoted.first;
    if !at.is_settled || !at.holds {
        *at = pivoted;
    }
    at.first = first;
    Ok(())
}

/// Returns the relative rounding error of velocities and accelerations per unit of steepness. The closer a position is to a
/// singular one, the more rounding is amplified.
pub fn rounding<M: Solved>(at: &Solution<M>, m: &M) -> f64 {
    let (t, sides, scales) = (at.t, &at.sides, M::scales());
    let slopes = m.phi_q(&at.q, t, sides);
    let mut norms = at.q;
    norms.as_mut().fill(f64::MIN_POSITIVE);
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let norm = norms.as_mut().get_mut(row);
        if let (Some(norm), Some(scale)) = (norm, scales.as_ref().get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
    let nu = m.nu(&at.q, t, sides);
    let velocity = ratio(largest(&at.qd, scales), largest(&nu, &norms));
    let gamma = m.gamma(&at.q, &at.qd, t, sides);
    let acceleration = ratio(largest(&at.qdd, scales), largest(&gamma, &norms));
    let amplified = larger(larger(velocity, acceleration), 1.0);
    f64::EPSILON * amplified
}

/// Returns whether a solution lies on the branch of `from`; `steepness` is how much steeper the parameters make the
/// equations than those of the file.
pub fn stays_on_branch<M: Solved>(
    from: &Solution<M>,
    at: &mut Solution<M>,
    m: &M,
    is_wanted: bool,
    steepness: f64,
    work: &mut Work,
) -> bool {
    let steepest = at.steepest / steepness;
    if at.monitors != from.monitors || at.is_negative != from.is_negative || steepest > STEEPEST {
        return false;
    }
    if steepest > STEEP {
        at.measures.leave_varied_out();
    }
    if !is_wanted || steepest <= STEEP {
        return true;
    }
    work.add(1);
    let is_in_doubt = steepest * rounding(at, m) > ACCURACY;
    !is_in_doubt
}
