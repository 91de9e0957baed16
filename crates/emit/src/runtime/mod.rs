//! The runtime that emitted code carries along, compiled and tested here unchanged.

#![allow(dead_code)] // each mechanism has its part of it
// halving ends where two times are neighbours, and a piece is a whole number
#![allow(clippy::float_cmp, clippy::cast_sign_loss)]
// closures are needed where the trait of an associated type is not in scope
#![allow(clippy::redundant_closure_for_method_calls, clippy::struct_field_names)]

pub mod assemble;
pub mod branches;
mod checks;
mod derivatives;
pub mod domain_boundaries;
pub mod equations;
pub mod error;
pub mod explain;
pub mod follow;
mod functions;
mod input_path;
pub mod lane_following;
pub mod lane_newton;
pub mod lane_solutions;
pub mod lanes;
pub mod measured;
pub mod newton;
pub mod numbers;
pub mod pivoting;
pub mod reach;
mod reactions;
pub mod solution;
mod solver_records;
pub mod state;
pub mod step;
pub mod track;
pub mod work;

mod tests;

use solver_records::running_max;

use crate::limits::values as limits;
use mechc_expr::math::{blocks, grid, hermite, neighbours};
