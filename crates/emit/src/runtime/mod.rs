//! What goes along with emitted code, compiled and tested here as it stands.

#![allow(dead_code)] // each mechanism has its part of it
// halving ends where two times are neighbours, and a piece is a whole number
#![allow(clippy::float_cmp, clippy::cast_sign_loss)]
// what an associated type gives is asked for by a closure, which names no trait
#![allow(clippy::redundant_closure_for_method_calls, clippy::struct_field_names)]

pub mod assemble;
pub mod branches;
pub mod equations;
pub mod error;
pub mod explain;
pub mod follow;
pub mod forces;
pub mod forces_led;
pub mod hold_apart;
pub mod lane_follow;
pub mod lane_newton;
pub mod lane_pivots;
pub mod lane_solutions;
pub mod lane_strain;
pub mod lanes;
pub mod left_out;
pub mod listed;
pub mod listed_more;
pub mod measured;
pub mod newton;
pub mod numbers;
pub mod pivoted_forces;
pub mod pivoted_slopes;
pub mod pivoting;
pub mod pivots;
pub mod reach;
pub mod rims;
pub mod sensitivity;
pub mod sensitivity_led;
pub mod so_far;
pub mod solution;
pub mod state;
pub mod step;
pub mod tables;
pub mod track;
pub mod watched;
pub mod way;
pub mod way_list;
pub mod work;

#[path = "functions/either.rs"]
pub mod either;
#[path = "functions/greater.rs"]
pub mod greater;
#[path = "functions/lesser.rs"]
pub mod lesser;
#[path = "functions/pick.rs"]
pub mod pick;
#[path = "functions/piece.rs"]
pub mod piece;
#[path = "functions/select.rs"]
pub mod select;
#[path = "functions/sign.rs"]
pub mod sign;

mod tests;

use crate::limits::values as limits;
use mechc_expr::math::{blocks, grid, hermite, neighbours};
use mechc_ir::program::codes;

/// The sine and cosine as they go along.
mod sine_and_cosine {
    pub use mechc_expr::math::sin_cos;
}
