//! The generator of texts for the fuzzer, which is not subject to the lints here.

#![allow(dead_code, clippy::pedantic, clippy::disallowed_methods)]

#[path = "../../../../fuzz/src/composed.rs"]
pub mod composed;
#[path = "../../../../fuzz/src/generate.rs"]
pub mod generate;
#[path = "../../../../fuzz/src/oracles.rs"]
pub mod oracles;
