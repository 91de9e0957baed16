//! Suggestions: what a text with an error or a doubtful value probably intends, as fixes of diagnostics.

mod degrees;
pub(super) mod edits;
mod kinds;
pub(super) mod lost_rate;
pub(super) mod missing_unit;
pub(super) mod names;
