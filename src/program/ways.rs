//! Ways through a formula: which branch is taken where it may change, and which piece of a table where an argument may lie in several.

use super::Op;
use super::Program;
use super::enclose::Interval;
use crate::tolerances::results::ranges::{BESIDE_A_SEAM, MOST_AT_ONCE};

/// One way: at each switch that is met, in the order in which they are, the result that is taken and the last one that it may have; these are whole
/// numbers.
#[derive(Clone, Default, Debug)]
pub(super) struct Ways {
    taken: Vec<[f64; 2]>,
    met: usize,
}

impl Ways {
    /// Begins with the first of all ways.
    pub fn begin(&mut self) {
        self.taken.clear();
        self.met = 0;
    }

    /// The one that is taken of those from one to another; none where these are too many.
    pub fn take(&mut self, results: Interval) -> Option<f64> {
        let Interval { low, high } = results;
        let is_few = high - low <= MOST_AT_ONCE;
        if !is_few {
            return None;
        }
        if self.met == self.taken.len() {
            self.taken.push([low, high]);
        }
        self.met += 1;
        Some(self.taken[self.met - 1][0])
    }

    /// Goes on to the next way; false where that was the last.
    pub fn go_on(&mut self) -> bool {
        self.met = 0;
        while let Some([result, last]) = self.taken.last_mut() {
            if *result < *last {
                *result += 1.0;
                return true;
            }
            self.taken.pop();
        }
        false
    }
}

/// Lets the argument of a table be in one piece alone, behind the operation that asks which one it is in.
pub(super) fn stay_in_piece(program: &Program, op: Op, piece: f64, v: &mut [Interval]) {
    let Op::Piece { table, a, .. } = op else { return };
    let layout = &program.tables()[table as usize];
    let last = layout.pieces - 1;
    // pieces are small whole numbers, and none is below 0
    #[allow(clippy::cast_sign_loss)]
    let piece = piece as u32;
    let knot = |k: u32| v[(layout.knots + k) as usize].low;
    // the first and the last piece go on for ever, but where the next one is the other end's
    let is_periodic = !layout.periods.is_empty();
    let beyond = if is_periodic { BESIDE_A_SEAM * (knot(last + 1) - knot(0)) } else { f64::INFINITY };
    let low = if piece > 0 { knot(piece) } else { knot(0) - beyond };
    let high = if piece < last { knot(piece + 1) } else { knot(last + 1) + beyond };
    let argument = &mut v[a as usize];
    let [low, high] = [argument.low.max(low), argument.high.min(high)];
    *argument = Interval { low: low.min(high), high: low.max(high) };
}
