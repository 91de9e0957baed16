//! Limits that several crates use, each with its meaning, unit and value.

/// Default span (s): examined if no analysis is given, and the unit of steps and speeds if the span is 0.
pub const DEFAULT_SPAN: f64 = 1.0;

/// Largest change of the residual, as a part of all changes with an input or a parameter, scaled: rounding.
pub const MISSES: f64 = 1e-8;
