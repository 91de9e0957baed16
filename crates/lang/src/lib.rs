//! The language: from the tree of a text to the checked model of a mechanism, and from that to its constraint system.

pub mod check;
pub mod estimates;
pub mod lower;
pub mod model;
pub mod settable_inputs;
