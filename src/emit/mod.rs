//! A constraint system as code for other programs.
//!
//! What is emitted is the program that the interpreter runs, operation by operation, so that both give the same bits (the sign of a zero
//! in `phi_t`, which is `-nu`, aside).

mod names;
mod rust;
mod slice;
mod tables;

pub use rust::rust;
