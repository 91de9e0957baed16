//! The numerics: assembly, motion, results, sweeps, against closed forms and references.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../emitted/compiling.rs"]
mod compiling;
#[path = "../support/mod.rs"]
mod support;

mod abreast;
mod abreast_results;
mod branches;
mod bridges;
mod broken;
mod by;
mod composed;
mod crew;
mod derivatives;
mod edges;
mod elements;
mod even_contacts;
mod following;
mod force_laws;
mod fuzz;
mod inputs;
mod led;
mod measured;
mod missing;
mod near_bifurcations;
mod nearness;
mod nested;
mod order;
mod own_derivatives;
mod points;
mod properties;
mod pulses;
mod redundant;
mod results;
mod rims;
mod robustness;
mod row_units;
mod slopes;
mod solver;
mod squeezer;
mod starts;
mod sweep;
mod tolerance;
mod varied_results;
mod vectors;
mod windows;
