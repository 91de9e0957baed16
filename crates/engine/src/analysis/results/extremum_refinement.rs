//! Refinement of the time of an extremum on a grid, like that of the solver's tearing variables (`crates/runtime/src/grid.rs`): from any start the
//! formula is sampled at the same times, so that the extremum has the same bits.

use crate::limits::lanes::{BORDER, ITERATIONS};
use mechc_expr::math::grid::{bound_at_first, going_on, next_point, on_grid};
use mechc_expr::math::power_of_two_below;

/// Width of a cell of the time grid, as a part of the span, rounded down to a power of two.
pub const CELL: f64 = 1.0 / 16_777_216.0;
/// Times farther from 0 than this many cells have no grid.
const MOST_CELLS: f64 = 1_125_899_906_842_624.0;
/// Largest distance of the refined extremum from the start, in cells.
pub const FARTHEST: f64 = 4_096.0;
/// Distance on both sides at which slopes are taken for an unknown second derivative, in cells.
const APART: f64 = 64.0;

/// The value and time derivatives of a formula at a time; those that do not exist are NaN.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// The value.
    pub value: f64,
    /// The first time derivative (1/s).
    pub first: f64,
    /// The second time derivative (1/s²).
    pub second: f64,
}

impl Sampled {
    /// A sample without any value.
    pub const NOTHING: Sampled = Sampled { value: f64::NAN, first: f64::NAN, second: f64::NAN };
}

/// The largest number of samples that one step of the refinement needs.
pub const MOST_LOOKS: usize = 3;

/// The refinement of an extremum on the grid.
#[derive(Clone, Copy, Debug)]
pub struct Settling {
    /// The grid point (s).
    t: f64,
    /// The first grid point (s).
    start: f64,
    /// The width of a grid cell (s).
    cell: f64,
    /// The largest correction, in cells, that counts as converged.
    bound: f64,
    /// The number of corrections that are left.
    left: usize,
    /// True if the second derivative of the formula is available.
    has_second: bool,
}

/// The outcome of one step of the refinement.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Turning {
    /// The refinement continues at another grid point.
    On,
    /// The refinement has converged: the time (s) of the extremum and its value.
    Settled([f64; 2]),
    /// The refinement does not converge.
    Lost,
}

impl Settling {
    /// Starts near a time (s) of an analysis of duration `span` (s), for a formula with an available slope. Returns `None` if the time is too large
    /// for the grid.
    #[must_use]
    pub fn near(t: f64, span: f64, has_second: bool) -> Option<Settling> {
        let cell = CELL * power_of_two_below(span);
        let is_fine = span > 0.0 && t.abs() <= MOST_CELLS * cell;
        let start = on_grid(t, cell);
        let (bound, left) = (bound_at_first(BORDER), ITERATIONS);
        is_fine.then_some(Settling { t: start, start, cell, bound, left, has_second })
    }

    /// Returns the number of times at which the formula has to be sampled.
    #[must_use]
    pub fn looks(&self) -> usize {
        if self.has_second { 1 } else { MOST_LOOKS }
    }

    /// Returns a sample time (s): the grid point, or a time on either side of it.
    #[must_use]
    pub fn time(&self, look: usize) -> f64 {
        match look {
            0 => self.t,
            1 => self.t - APART * self.cell,
            _ => self.t + APART * self.cell,
        }
    }

    /// Takes one step of the refinement from the samples at the times of [`Settling::time`].
    pub fn go_on(&mut self, samples: &[Sampled]) -> Turning {
        let Sampled { value, first, second } = self.at_point(samples);
        let correction = -first / second;
        let (beyond, from_begin) = (correction.abs() / self.cell, (self.t + correction - self.start).abs() / self.cell);
        if !(correction.is_finite() && from_begin <= FARTHEST) || self.left == 0 {
            return Turning::Lost;
        }
        if beyond <= self.bound {
            return Turning::Settled([self.t + correction, value + 0.5 * first * correction]);
        }
        let (bound, cells) = going_on(beyond, self.bound, BORDER);
        self.t = next_point(self.t, correction, self.cell, cells, BORDER);
        (self.bound, self.left) = (bound, self.left - 1);
        Turning::On
    }

    /// Returns the sample at the grid point; without a second derivative, the difference quotient of the slopes on both sides replaces it.
    fn at_point(&self, samples: &[Sampled]) -> Sampled {
        match *samples {
            [at] => at,
            [at, before, behind] => Sampled { second: (behind.first - before.first) / (2.0 * APART * self.cell), ..at },
            _ => Sampled::NOTHING,
        }
    }
}
