//! A constraint system as code for other programs.
//!
//! What is emitted is the program that the interpreter runs, operation by operation, so that both give the same bits.

mod names;
mod rust;
mod slice;

pub use rust::rust;
