//! A number for each of the variants that go side by side.

use mechc_ir::program::LaneValues;

/// So many variants go side by side.
pub const LANES: usize = 32;

/// So many of them are a part of the lanes; parts in which nobody goes are left out.
pub const PART: usize = crate::solver::PART;

/// A number for each of them.
pub type Each = LaneValues<LANES>;

/// Nothing, for each.
pub(super) const ZERO: Each = LaneValues([0.0; LANES]);

/// In how many parts of the lanes, the first ones, there are some.
pub(super) fn parts_of(those: &[bool; LANES]) -> usize {
    those.iter().rposition(|&is_there| is_there).map_or(0, |last| last / PART + 1)
}
