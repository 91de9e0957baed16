//! The numerics: assembly, motion, results, sweeps, against closed forms and references.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../emitted/compiling.rs"]
mod compiling;
#[path = "../support/mod.rs"]
mod support;

mod batches;
mod batch_results;
mod branches;
mod bridges;
mod injected_faults;
mod parameter_derivatives;
mod random_parts;
mod parallel_map;
mod derivatives;
mod edges;
mod elements;
mod even_contacts;
mod emitted_inputs;
mod force_laws;
mod fuzz;
mod inputs;
mod continuation;
mod measure_quantities;
mod missing_values;
mod near_bifurcations;
mod nearness;
mod nested_params;
mod order;
mod part_derivatives;
mod point_formulas;
mod properties;
mod pulses;
mod redundant;
mod results;
mod domain_boundaries;
mod robustness;
mod row_units;
mod slopes;
mod solver;
mod squeezer;
mod starts;
mod sweep;
mod tolerance;
mod result_derivatives;
mod vectors;
mod windows;
