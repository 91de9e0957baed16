//! Everything that can be said of one state: what the equations leave open there, the corrections and derivatives that their
//! factors give, how near it is to a singular position, and what its numbers are worth. Nothing here knows of another state.

mod aslant;
mod dense;
mod determinant;
mod kinematics;
mod least_squares;
mod linear;
mod scoped;
mod sparse;
mod times;
mod trust;
mod yardstick;

pub use aslant::aslant;
pub use determinant::Determinant;
pub use kinematics::{Fault, Kinematics, State, Unknown};
pub use least_squares::{Evaluated, Linear, minimize};
pub use linear::Singular;
pub use times::{Horizon, Times, behind_start, shortly_after};
pub use trust::{Trust, are_alike, are_small};
