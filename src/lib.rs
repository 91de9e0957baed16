//! `mechc` compiles `.mech` files: planar mechanisms, described by bodies, joints and drivers.
//!
//! The rooms in the order in which a text passes through them:
//!
//! ```text
//! text ─syntax▶ tree ─check▶ model ─lower▶ ConstraintSystem ─structure▶ Determined ─program▶ operations
//!                                                                            └──analysis▶ Started ▶ rows ─output▶ table
//! ```
//!
//! Each stage has its own types, and a later one cannot hold what an earlier one should have refused. See
//! `ARCHITECTURE.md` for what each room knows and must not know.

pub mod source;

pub mod math;

pub mod diag;

pub mod syntax;

pub mod expr;

pub mod model;

pub mod check;

pub mod ir;

pub mod lower;

pub mod structure;

pub mod program;

pub mod analysis;

pub mod output;

pub mod cli;
