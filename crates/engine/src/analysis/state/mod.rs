//! Computations at one state: residuals of the equations, the corrections and derivatives that the factors of the Jacobian give, the nearness to
//! a singular position, and error bounds. This module must not know other states.

mod dense;
mod determinant;
mod equilibration;
mod error_bound;
mod kinematics;
mod least_squares;
mod linear;
mod output_times;
mod signal_bounds;
mod sparse;

pub use determinant::Determinant;
pub use error_bound::{Trust, are_alike, are_small};
pub use kinematics::{Fault, Kinematics, State, Unknown};
pub use least_squares::{Evaluated, Linear, minimize};
pub use linear::Singular;
pub use output_times::{Horizon, Times, behind_start, shortly_after};
pub use signal_bounds::SignalBounds;

use mechc_expr::math::GOLDEN;

/// Returns by how much a coordinate moves, from 0.5 to 1.5, where all move to a generic position: the amounts differ, so that nothing
/// cancels.
pub fn aslant(column: usize) -> f64 {
    0.5 + (GOLDEN * column as f64).fract()
}
