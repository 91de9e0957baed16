//! The program and what it writes: command line, emitted code, pictures, tables, editors.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../emitted/compiling.rs"]
mod compiling;
#[path = "../support/mod.rs"]
mod support;

mod architecture;
mod cli;
mod columns;
mod crates;
mod display_units;
mod editors;
mod emitted_inputs;
mod emitted_rust;
mod ffi;
mod files;
mod fmt;
mod formula;
mod layers;
mod licenses;
mod live;
mod lsp;
mod nested_params;
mod outputs;
mod pictures;
mod results;
mod sheets;
mod slopes;
mod tolerance;
mod vary;
mod writers;
