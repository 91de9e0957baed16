//! Elimination with partial pivoting, for positions where the fixed order of `solve` loses digits.

use super::blocks::{self, Blocks};
use super::branches::sides_near;
use super::error::Fault;
use super::grid::{bound_at_first, going_on, next_point, on_grid};
use super::limits::{BORDER, ITERATIONS, MOST_SHORTER, MOST_TRIALS, NEAR};
use super::numbers::{Flags, Numbers, larger, largest};
use super::solution::{Along, Solution, Solved};
use super::work::Work;

/// Equations that can be solved by elimination with partial pivoting.
pub trait Pivoting: Solved {
    /// Workspace for the elimination of the largest block.
    type Work: Numbers;
    /// A flag for each block of equations.
    type Blocks: Flags;
    /// Derivatives of coordinates, velocities and accelerations by inputs and parameters that measures hold.
    type Varied: Numbers;
    /// A right side for each derivative by the variable of the motion.
    type Rights: AsRef<[Self::Q]>;

    /// Largest residual of an equation, relative to the norm of its row.
    const TOLERANCE: f64;
    /// True if measures hold third derivatives of the coordinates.
    const HAS_JERK: bool = false;
    /// True for each derivative by inputs and parameters that is one by two of them.
    const IS_BY_TWO: &'static [bool] = &[];

    /// Returns the blocks of the equations.
    fn blocks() -> &'static Blocks<'static>;

    /// Returns the blocks whose determinants change.
    fn turning() -> &'static [usize];

    /// Returns the width of a cell of each coordinate's grid.
    fn cells() -> &'static Self::Q;

    /// Returns the right side of the jerk equation.
    fn jerk(&self, _orders: [&Self::Q; 3], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// Returns the right sides for the derivatives by inputs and parameters, as far as the derivatives before them are
    /// solved.
    fn varied_right(
        &self,
        _orders: [&Self::Q; 3],
        _varied: &Self::Varied,
        _t: f64,
        _sides: &Self::Sides,
    ) -> Self::Varied {
        Self::Varied::ZERO
    }

    /// Returns the transposed matrix, if forces are needed.
    fn transposed() -> Option<&'static Transposed> {
        None
    }

    /// Returns the loads that the multipliers have to balance, by coordinate.
    fn needed(&self, _orders: [&Self::Q; 4], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// Returns the right sides for the derivatives by the variable of the motion.
    fn rights(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Rights;

    /// Returns the measures, from the coordinates with their first three derivatives, their variations, and the
    /// multipliers.
    fn measured(&self, orders: [&Self::Q; 4], varied: &Self::Varied, multipliers: &Self::Q, t: f64) -> Self::Measures;
}

/// The transposed matrix, an equation for each coordinate.
pub struct Transposed {
    /// Blocks of its equations.
    pub blocks: &'static Blocks<'static>,
    /// Index of each of its entries among those of the matrix.
    pub places: &'static [usize],
}

/// Solves from a position nearby. All coordinates stay on a grid during Newton's iteration.
pub fn solve_with_pivoting<M: Pivoting>(m: &M, q: &M::Q, t: f64, sides: &M::Sides) -> Result<Solution<M>, Fault> {
    let mut at = Solution::near(q, t);
    let mut elimination = Elimination::<M>::new();
    if !settle(m, &mut at, sides, &mut elimination) {
        return Err(at.fault());
    }
    let slopes = m.phi_q(&at.q, t, sides);
    let (qd, pivot) = elimination.solve(&slopes, &m.nu(&at.q, t, sides));
    let (qdd, _) = elimination.solve(&slopes, &m.gamma(&at.q, &qd, t, sides));
    let orders = [&at.q, &qd, &qdd];
    let qddd = elimination.third_derivatives(m, &slopes, orders, t, sides);
    let rights = m.rights(&at.q, t, sides);
    for (slopes_by, right) in at.along.slopes_mut().iter_mut().zip(rights.as_ref()) {
        *slopes_by = without_signs_of_zero(elimination.solve(&slopes, right).0);
    }
    let varied = vary(m, &mut elimination, &slopes, orders, t, sides);
    let multipliers = elimination.multipliers(m, &slopes, [&at.q, &qd, &qdd, &qddd], t, sides);
    at.measures = m.measured([&at.q, &qd, &qdd, &qddd], &varied, &multipliers, t);
    (at.qd, at.qdd) = (without_signs_of_zero(qd), without_signs_of_zero(qdd));
    at.holds = is_next_to_nothing::<M>(&m.phi(&at.q, t, sides), &slopes, &at.q);
    at.q = without_signs_of_zero(at.q);
    at.steepest = 1.0 / pivot;
    let negative = elimination.is_negative.as_ref();
    for (turned, block) in at.is_negative.as_mut().iter_mut().zip(M::turning()) {
        *turned = negative.get(*block).copied().unwrap_or(false);
    }
    if at.holds { Ok(at) } else { Err(Fault::TooFar) }
}

/// Solves by Newton's iteration from far away, with equations scaled by the effect of their coordinates. Each correction is
/// so short that nothing moves by more than its scale, and that the residual decreases. Returns `None` if it does not
/// converge.
pub fn close<M: Pivoting>(m: &M, q: &M::Q, t: f64, work: &mut Work) -> Option<M::Q> {
    let (mut q, mut elimination) = (*q, Elimination::<M>::new());
    let mut sides = sides_near(&q, t, m, work);
    for _ in 0..MOST_TRIALS {
        let (slopes, residual) = (m.phi_q(&q, t, &sides), m.phi(&q, t, &sides));
        let norms = norms::<M>(&slopes);
        let mut right = residual;
        right.as_mut().iter_mut().for_each(|value| *value = -*value);
        let (x, _) = elimination.solve(&slopes, &right);
        work.add(1);
        let size = largest(&x, M::scales());
        if !size.is_finite() {
            return None;
        }
        let left = largest(&residual, &norms);
        let mut part = f64::min(1.0, 1.0 / size);
        let mut next = q;
        for _ in 0..MOST_SHORTER {
            next = q;
            next.as_mut().iter_mut().zip(x.as_ref()).for_each(|(q, x)| *q += part * x);
            if size <= NEAR {
                return Some(next);
            }
            work.add(1);
            sides = m.sides_of_motion(&next, t, &sides);
            if largest(&m.phi(&next, t, &sides), &norms) < (1.0 - 0.25 * part) * left {
                break;
            }
            part *= 0.5;
        }
        q = next;
    }
    None
}

/// Returns the largest change of each equation by a change of the coordinates by their scales.
fn norms<M: Pivoting>(slopes: &M::Entries) -> M::Q {
    let mut norms = M::Q::ZERO;
    norms.as_mut().fill(f64::MIN_POSITIVE);
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        if let (Some(norm), Some(scale)) = (norms.as_mut().get_mut(row), M::scales().as_ref().get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    norms
}

/// Runs Newton's iteration. Returns whether it has converged.
fn settle<M: Pivoting>(m: &M, at: &mut Solution<M>, sides: &M::Sides, elimination: &mut Elimination<M>) -> bool {
    let mut bound = bound_at_first(BORDER);
    for (q, cell) in at.q.as_mut().iter_mut().zip(M::cells().as_ref()) {
        *q = on_grid(*q, *cell);
    }
    for iteration in 0..ITERATIONS {
        let slopes = m.phi_q(&at.q, at.t, sides);
        let mut right = m.phi(&at.q, at.t, sides);
        right.as_mut().iter_mut().for_each(|value| *value = -*value);
        let (x, _) = elimination.solve(&slopes, &right);
        if iteration == 0 {
            at.first = largest(&x, M::scales());
        }
        let corrected = at.q.as_mut().iter_mut().zip(x.as_ref());
        let size = largest(&x, M::cells());
        if size <= bound {
            corrected.for_each(|(q, x)| *q += x);
            return true;
        }
        let (next, cells) = going_on(size, bound, BORDER);
        corrected.zip(M::cells().as_ref()).for_each(|((q, x), cell)| *q = next_point(*q, *x, *cell, cells, BORDER));
        bound = next;
    }
    false
}

/// Returns the derivatives of the coordinates, their velocities and accelerations by inputs and parameters: those by one
/// before those by two, each order from those before.
fn vary<M: Pivoting>(
    m: &M,
    elimination: &mut Elimination<M>,
    slopes: &M::Entries,
    orders: [&M::Q; 3],
    t: f64,
    sides: &M::Sides,
) -> M::Varied {
    let mut varied = M::Varied::ZERO;
    let n = M::scales().as_ref().len();
    for by_two in [false, true] {
        for order in 0..3 {
            let rights = m.varied_right(orders, &varied, t, sides);
            for (number, _) in M::IS_BY_TWO.iter().enumerate().filter(|(_, of)| **of == by_two) {
                let first = (3 * number + order) * n;
                let mut right = M::Q::ZERO;
                let given = rights.as_ref().iter().skip(first);
                right.as_mut().iter_mut().zip(given).for_each(|(to, from)| *to = *from);
                let (x, _) = elimination.solve(slopes, &right);
                let places = varied.as_mut().iter_mut().skip(first);
                places.zip(x.as_ref()).for_each(|(place, x)| *place = *x);
            }
        }
    }
    varied
}

/// Workspace for solving linear equations in blocks.
pub struct Elimination<M: Pivoting> {
    work: M::Work,
    is_negative: M::Blocks,
}

impl<M: Pivoting> Elimination<M> {
    /// Creates an empty workspace.
    pub fn new() -> Self {
        Self { work: M::Work::ZERO, is_negative: M::Blocks::NONE }
    }

    /// Returns the solution for a right side, and the smallest pivot.
    pub fn solve(&mut self, slopes: &M::Entries, right: &M::Q) -> (M::Q, f64) {
        let mut x = M::Q::ZERO;
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let pivot = blocks::solve(M::blocks(), slopes.as_ref(), right.as_ref(), x.as_mut(), work, is_negative);
        (x, pivot)
    }

    /// Returns the third derivatives of the coordinates; 0 if measures do not need them.
    pub fn third_derivatives(
        &mut self,
        m: &M,
        slopes: &M::Entries,
        orders: [&M::Q; 3],
        t: f64,
        sides: &M::Sides,
    ) -> M::Q {
        if M::HAS_JERK { self.solve(slopes, &m.jerk(orders, t, sides)).0 } else { M::Q::ZERO }
    }

    /// Returns the multipliers of a state; 0 if forces are not needed.
    pub fn multipliers(&mut self, m: &M, slopes: &M::Entries, orders: [&M::Q; 4], t: f64, sides: &M::Sides) -> M::Q {
        let mut multipliers = M::Q::ZERO;
        let Some(Transposed { blocks, places }) = M::transposed() else { return multipliers };
        let mut across = *slopes;
        for (entry, place) in across.as_mut().iter_mut().zip(*places) {
            *entry = slopes.as_ref().get(*place).copied().unwrap_or(f64::NAN);
        }
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let needed = m.needed(orders, t, sides);
        blocks::solve(blocks, across.as_ref(), needed.as_ref(), multipliers.as_mut(), work, is_negative);
        multipliers
    }
}

/// Returns whether the residuals are within the tolerance and the rounding error of the coordinates.
fn is_next_to_nothing<M: Pivoting>(values: &M::Q, slopes: &M::Entries, q: &M::Q) -> bool {
    let mut bounds = M::Q::ZERO;
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let bound = bounds.as_mut().get_mut(row);
        let sizes = (M::scales().as_ref().get(column), q.as_ref().get(column), bound);
        if let (Some(scale), Some(q), Some(bound)) = sizes {
            *bound += M::TOLERANCE * (slope * scale).abs() + 8.0 * f64::EPSILON * (slope * q).abs();
        }
    }
    let mut pairs = values.as_ref().iter().zip(bounds.as_ref());
    pairs.all(|(value, bound)| value.abs() <= *bound)
}

/// Replaces -0 by 0.
pub fn without_signs_of_zero<N: Numbers>(mut values: N) -> N {
    values.as_mut().iter_mut().for_each(|value| *value += 0.0);
    values
}
