//! Mechanisms as they are checked: repetitions written out, and parts with the mechanisms that they are of.
//!
//! This layer owns `Expander`, which writes an `Instance`. It uses formulas for the bounds of ranges and for indices, and builds no model.

mod instance;
mod instantiation;
mod repetition;

pub(in crate::check) use instance::Instance;
pub(in crate::check) use instantiation::{definitions_of, instance_of};
