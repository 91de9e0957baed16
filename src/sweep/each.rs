//! A number for each of the variants that go side by side.

use crate::program::LaneValues;

/// So many variants go side by side.
pub const LANES: usize = 16;

/// A number for each of them.
pub type Each = LaneValues<LANES>;

/// Nothing, for each.
pub(super) const ZERO: Each = LaneValues([0.0; LANES]);
