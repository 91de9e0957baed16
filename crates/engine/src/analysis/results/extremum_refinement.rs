//! The time at which a formula turns, settled on a grid, as the tears of the solver are on theirs (`math/grid.rs`): whichever way led to it, what
//! is said of it is computed at the same times, and has the same bits.

use mechc_expr::math::grid::{bound_at_first, going_on, next_point, on_grid};
use mechc_expr::math::power_of_two_below;
use mechc_ir::tolerances::results::turns::{APART, BORDER, CELL, FARTHEST, ITERATIONS, MOST_CELLS};

/// A formula at a time: its value and time derivatives; those that it has not are no numbers.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// The value.
    pub value: f64,
    /// Its first time derivative (1/s).
    pub first: f64,
    /// Its second one (1/s²).
    pub second: f64,
}

impl Sampled {
    /// Of a formula of which nothing is known.
    pub const NOTHING: Sampled = Sampled { value: f64::NAN, first: f64::NAN, second: f64::NAN };
}

/// The most times at which a formula has to be looked at to settle a turn.
pub const MOST_LOOKS: usize = 3;

/// A turn on its way to where it settles.
#[derive(Clone, Copy, Debug)]
pub struct Settling {
    /// The grid point (s).
    t: f64,
    /// Where it began (s), and the width of a cell (s).
    begun: f64,
    cell: f64,
    /// With which largest correction it ends, in cells.
    bound: f64,
    /// How many corrections it may still take.
    left: u32,
    /// Whether the second derivative of the formula is known.
    knows_bends: bool,
}

/// What becomes of a turn at a grid point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Turning {
    /// It goes on to another one.
    On,
    /// It stays: the time (s) of the extremum and its value.
    Settled([f64; 2]),
    /// It does not settle.
    Lost,
}

impl Settling {
    /// Near a time (s) of an analysis of so long a span (s), of a formula whose slope is known, and perhaps its second derivative; none where
    /// times are too late for the grid.
    #[must_use]
    pub fn near(t: f64, span: f64, knows_bends: bool) -> Option<Settling> {
        let cell = CELL * power_of_two_below(span);
        let is_fine = span > 0.0 && t.abs() <= MOST_CELLS * cell;
        let begun = on_grid(t, cell);
        let (bound, left) = (bound_at_first(BORDER), ITERATIONS);
        is_fine.then_some(Settling { t: begun, begun, cell, bound, left, knows_bends })
    }

    /// How many times there are at which the formula has to be looked at.
    #[must_use]
    pub fn looks(&self) -> usize {
        if self.knows_bends { 1 } else { MOST_LOOKS }
    }

    /// These times (s), by their numbers: the grid point, and those beside it.
    #[must_use]
    pub fn time(&self, look: usize) -> f64 {
        match look {
            0 => self.t,
            1 => self.t - APART * self.cell,
            _ => self.t + APART * self.cell,
        }
    }

    /// Goes on by what the formula is at these times.
    pub fn go_on(&mut self, samples: &[Sampled]) -> Turning {
        let Sampled { value, first, second } = self.at_point(samples);
        let off = -first / second;
        let (beyond, from_begin) = (off.abs() / self.cell, (self.t + off - self.begun).abs() / self.cell);
        if !(off.is_finite() && from_begin <= FARTHEST) || self.left == 0 {
            return Turning::Lost;
        }
        if beyond <= self.bound {
            return Turning::Settled([self.t + off, value + 0.5 * first * off]);
        }
        let (bound, cells) = going_on(beyond, self.bound, BORDER);
        self.t = next_point(self.t, off, self.cell, cells, BORDER);
        (self.bound, self.left) = (bound, self.left - 1);
        Turning::On
    }

    /// The formula at the grid point; its second derivative, where that is not known, by how the slope goes on to both sides.
    fn at_point(&self, samples: &[Sampled]) -> Sampled {
        match *samples {
            [at] => at,
            [at, before, behind] => Sampled { second: (behind.first - before.first) / (2.0 * APART * self.cell), ..at },
            _ => Sampled::NOTHING,
        }
    }
}
