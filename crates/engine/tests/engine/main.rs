//! The numerics: assembly, motion, results, sweeps, against closed forms and references.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../../../../tests/support/mod.rs"]
mod support;

mod batch_results;
mod batches;
mod branches;
mod bridges;
mod continuation;
mod derivatives;
mod domain_boundaries;
mod edges;
mod elements;
mod even_contacts;
mod force_laws;
mod fuzz;
mod injected_faults;
mod inputs;
mod measure_quantities;
mod missing_values;
mod near_bifurcations;
mod nearness;
mod order;
mod parallel_map;
mod parameter_derivatives;
mod parametric;
mod part_derivatives;
mod point_formulas;
mod properties;
mod pulses;
mod random_parts;
mod redundant;
mod result_derivatives;
mod results;
mod robustness;
mod row_units;
mod solver;
mod squeezer;
mod starts;
mod sweep;
mod tolerance;
mod vectors;
mod windows;
