//! The language: texts, formatting, words, messages.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../../../../tests/support/mod.rs"]
mod support;

mod dimensions;
mod features;
mod fixes;
mod fmt;
mod format;
mod generated_names;
mod import;
mod mistakes;
mod parts;
mod printing;
mod stack;
mod vocabulary;
