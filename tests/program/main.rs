//! The program and what it writes: command line, emitted code, pictures, tables, editors.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../support/mod.rs"]
mod support;

mod architecture;
mod cli;
mod columns;
mod crates;
mod editors;
mod emitted_rust;
mod ffi;
mod files;
mod layers;
mod licenses;
mod live;
mod lsp;
mod outputs;
mod pictures;
mod sheets;
mod vary;
mod writers;
