//! Solver that runs bytecode.

use super::bytecode_interpreter::{Arrays, ConstantPool, Results, run};
use super::grid::on_grid;
use super::limits::ITERATIONS;
use super::measured::Measured;
use super::newton::Newton;
use super::solution::{Along, Solution, Solved};

/// A section of the bytecode, and the coordinates for which it is iterated, as ranges in their lists.
pub struct Segment {
    /// Range in the bytecode.
    pub code: [usize; 2],
    /// Range in the list of coordinates.
    pub tears: [usize; 2],
}

/// A coordinate that Newton solves for.
pub struct NewtonCoordinate {
    /// Registers of the coordinate and of its correction.
    pub registers: [usize; 2],
    /// Width of a cell of its grid, and its scale.
    pub sizes: [f64; 2],
}

/// Program of a solver.
pub struct Listing {
    /// Segments in order.
    pub segments: &'static [Segment],
    /// The coordinates that Newton solves for.
    pub newton: &'static [NewtonCoordinate],
    /// Bytecode.
    pub code: &'static [u32],
}

/// Results of a solver with Newton iterations.
pub trait Settled: Results {
    /// Records the outcome of a Newton iteration.
    fn settled(&mut self, newton: &Newton);
}

/// Solves with `REGISTERS` registers.
pub fn solve<B: ConstantPool, const REGISTERS: usize>(
    listing: &Listing,
    guess: &[f64],
    inputs: &Arrays<'_>,
    out: &mut impl Settled,
) {
    let mut v = [0.0; REGISTERS];
    for Segment { code: [from, to], tears: [first, last] } in listing.segments {
        let code = listing.code.get(*from..*to).unwrap_or(&[]);
        let tears = listing.newton.get(*first..*last).unwrap_or(&[]);
        if tears.is_empty() {
            run::<B>(code, guess, inputs, &mut v, out);
            continue;
        }
        let mut newton = Newton::new();
        correct(&mut v, tears, |x, _, cell| on_grid(x, cell));
        for _ in 0..ITERATIONS {
            run::<B>(code, guess, inputs, &mut v, out);
            for NewtonCoordinate { registers, sizes } in tears {
                newton.record(v.get(registers[1]).copied().unwrap_or(f64::NAN), sizes[0], sizes[1]);
            }
            if newton.is_done() {
                break;
            }
            correct(&mut v, tears, |x, delta, cell| newton.next(x, delta, cell));
        }
        correct(&mut v, tears, |x, delta, _| x + delta);
        out.settled(&newton);
    }
}

/// Replaces the value of each coordinate by a function of its value, its correction, and the width of its cells.
fn correct(v: &mut [f64], tears: &[NewtonCoordinate], other: impl Fn(f64, f64, f64) -> f64) {
    for NewtonCoordinate { registers, sizes } in tears {
        let delta = v.get(registers[1]).copied().unwrap_or(f64::NAN);
        if let Some(x) = v.get_mut(registers[0]) {
            *x = other(*x, delta, sizes[0]);
        }
    }
}

/// Results of the solver, by their columns: the first is the time.
impl<M: Solved> Results for Solution<M> {
    fn store(&mut self, column: usize, value: f64) {
        let mut rest = column.wrapping_sub(1);
        let [values, rates, accelerations] = self.measures.lists_mut();
        let lists = [self.q.as_mut(), values, self.qd.as_mut(), rates, self.qdd.as_mut(), accelerations];
        let slopes = self.along.slopes_mut().iter_mut().map(|slopes| slopes.as_mut());
        for list in lists.into_iter().chain(slopes).chain([self.joined.as_mut()]) {
            if let Some(place) = list.get_mut(rest) {
                // 0 instead of -0
                *place = value + 0.0;
                return;
            }
            rest = rest.wrapping_sub(list.len());
        }
    }

    fn stored(&self, column: usize) -> f64 {
        let mut rest = column.wrapping_sub(1);
        let [values, rates, accelerations] = self.measures.lists();
        let lists = [self.q.as_ref(), values, self.qd.as_ref(), rates, self.qdd.as_ref(), accelerations];
        let slopes = self.along.slopes().iter().map(|slopes| slopes.as_ref());
        for list in lists.into_iter().chain(slopes).chain([self.joined.as_ref()]) {
            if let Some(value) = list.get(rest) {
                return *value;
            }
            rest = rest.wrapping_sub(list.len());
        }
        f64::NAN
    }

    fn bounded(&mut self, size: f64, bound: f64) {
        self.holds &= size <= bound;
    }

    fn pivoted(&mut self, turn: usize, inverse: f64, weight: f64) {
        self.pivot(turn, inverse, weight);
    }
}

impl<M: Solved> Settled for Solution<M> {
    fn settled(&mut self, newton: &Newton) {
        self.note(newton);
    }
}
