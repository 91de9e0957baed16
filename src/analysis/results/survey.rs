//! A look at one formula in one stretch of the motion.

use super::formulas::{Cell, Formula, Point};
use super::places::Places;
use crate::analysis::follow::Stretch;
use crate::analysis::state::State;
use crate::program::Range;
use crate::tolerances::results::survey::{ALIKE, MOST_CELLS, NOTHING, OPAQUE, ROUNDING, SHORTEST, SOLVED};

use std::rc::Rc;

/// Where nothing is known.
const ANYTHING: Range =
    Range { low: f64::NEG_INFINITY, high: f64::INFINITY, may_switch: true, is_resolved: false, crosses_knots: true };

/// How large a formula is over the analysis so far.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Scale {
    /// The largest value less the least.
    pub range: f64,
    /// The largest magnitude of a value, or of the numbers that it is a sum of: the unit of rounding.
    pub weight: f64,
    /// The time of the analysis (s).
    pub span: f64,
}

impl Scale {
    /// Values that differ by no more than this are the same: what rounding makes of a value that rests is no change.
    pub fn alike(self) -> f64 {
        self.gap(ALIKE)
    }

    /// Whether all values that were seen are the same, but for rounding.
    pub fn rests(self) -> bool {
        self.range <= self.gap(0.0)
    }

    /// A part of the range, but no less than what rounding makes of a value.
    pub fn gap(self, part: f64) -> f64 {
        f64::max(part * self.range, ROUNDING * self.weight).max(NOTHING)
    }
}

/// Why there is no number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Trouble {
    /// The formula has no value at a time (s).
    Missing(f64),
    /// It could not be found out around a time (s).
    Unknown(f64),
    /// It is of a time (s) at which a row would be more rounding than digits.
    Uncertain(f64),
}

impl Trouble {
    fn t(self) -> f64 {
        match self {
            Trouble::Missing(t) | Trouble::Unknown(t) | Trouble::Uncertain(t) => t,
        }
    }
}

/// A look at one formula in one stretch.
pub(super) struct Survey<'r> {
    pub formula: &'r mut Formula,
    pub places: &'r mut Places,
    pub stretch: &'r Stretch,
    pub trouble: &'r mut Option<Trouble>,
    pub cells: &'r mut usize,
    pub seen: &'r mut [f64; 2],
    /// When these were seen first (s).
    pub seen_at: &'r mut [f64; 2],
    pub shortest: f64,
}

/// A stretch as a formula sees it.
pub(super) struct Root {
    pub whole: Cell,
    /// Its halves with what the formula can be in them; none where its middle cannot be had.
    pub parts: Vec<(Cell, Range)>,
}

impl Survey<'_> {
    /// The formula in the middle of a cell; none where it cannot be had.
    pub fn middle(&mut self, cell: &Cell) -> Option<Rc<Point>> {
        if cell.is_empty() {
            return None;
        }
        self.point(&[&cell.a, &cell.b], cell.middle())
    }

    /// The formula at a time (s) between two points.
    pub fn point(&mut self, ends: &[&Rc<Point>; 2], t: f64) -> Option<Rc<Point>> {
        self.between(ends.map(|point| &point.state), t)
    }

    /// The formula at a time (s) of the stretch.
    pub fn point_of_stretch(&mut self, t: f64) -> Option<Rc<Point>> {
        let ends @ [from, to] = [&self.stretch.from, &self.stretch.to];
        match [from, to].into_iter().find(|end| end.t.total_cmp(&t).is_eq()) {
            Some(end) => Some(self.formula.at(end.clone(), self.places)),
            None => self.between(ends, t),
        }
    }

    fn between(&mut self, [a, b]: [&State; 2], t: f64) -> Option<Rc<Point>> {
        *self.cells += if self.formula.moves() { SOLVED } else { 1 };
        let state = if self.formula.moves() {
            let solved = self.places.solve(self.stretch, [a, b], t);
            if solved.is_none() && b.t - a.t > self.shortest * OPAQUE / SHORTEST {
                self.meet(Trouble::Unknown(t));
            }
            solved?
        } else {
            State { t, ..a.clone() }
        };
        let point = self.formula.at(state, self.places);
        self.see(&point).then_some(point)
    }

    /// Takes note of a value; says whether there is one.
    pub fn see(&mut self, point: &Point) -> bool {
        let value = point.sample.value;
        if !value.is_finite() {
            self.meet(Trouble::Missing(point.state.t));
            return false;
        }
        if value < self.seen[0] {
            (self.seen[0], self.seen_at[0]) = (value, point.state.t);
        }
        if value > self.seen[1] {
            (self.seen[1], self.seen_at[1]) = (value, point.state.t);
        }
        true
    }

    /// What the formula can be in a cell; anything where the states at its ends do not tell the motion between.
    pub fn range(&mut self, cell: &Cell) -> Range {
        self.formula.look_at(cell);
        let range = self.formula.range(0);
        let is_known = !self.formula.moves()
            || self.places.signals_are_resolved([cell.a.state.t, cell.b.state.t]) && !self.formula.turns_far(cell);
        if is_known { range } else { ANYTHING }
    }

    /// The same, resolved only where the slope does not jump either.
    pub fn smooth_range(&mut self, cell: &Cell) -> Range {
        let range = self.range(cell);
        let is_smooth = !range.is_resolved || self.formula.derivatives() == 0 || !self.formula.range(1).may_switch;
        Range { is_resolved: range.is_resolved && is_smooth, ..range }
    }

    /// Whether a cell may be cut in two. One that is too short for that, and in which the formula may be anything, has no value.
    pub fn goes_on(&mut self, cell: &Cell, widest: f64) -> bool {
        if *self.cells > MOST_CELLS {
            self.meet(Trouble::Unknown(cell.a.state.t));
        }
        if self.trouble.is_some() {
            return false;
        }
        let goes_on = cell.length() > self.shortest && !cell.is_empty();
        if !goes_on && !widest.is_finite() {
            self.formula.look_at(cell);
            let range = self.formula.range(0);
            if !(range.low.is_finite() && range.high.is_finite()) {
                self.meet(Trouble::Missing(cell.a.state.t));
            }
        }
        goes_on
    }

    pub fn meet(&mut self, trouble: Trouble) {
        if self.trouble.is_none_or(|known| trouble.t() < known.t()) {
            *self.trouble = Some(trouble);
        }
    }
}
