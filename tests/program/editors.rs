//! The words of the language in the grammars of `editors/`, and what else of these files agrees with each other.
//! `UPDATE_GOLDENS=1 cargo test --test program editors` writes the words.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

mod consistency;
mod words;

use crate::support::golden;
use std::fs;

/// A file of `editors/` is what it is made of.
fn holds(path: &str, made: impl FnOnce(&str) -> String) {
    let path = format!("editors/{path}");
    let written = fs::read_to_string(&path).unwrap_or_default();
    golden::holds(&path, &made(&written));
}
