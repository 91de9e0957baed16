//! Tests that are made of lists of files and codes: a new file is a new test.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "../support/named_tests.rs"]
mod named_tests;
#[path = "../support/mod.rs"]
mod support;

mod explain;
mod modules;
mod references;
mod sensitivities;
mod sessions;
mod stages;
mod ui;

fn main() {
    let mut tests = named_tests::Tests::default();
    references::list(&mut tests);
    explain::list(&mut tests);
    modules::list(&mut tests);
    sensitivities::list(&mut tests);
    sessions::list(&mut tests);
    stages::list(&mut tests);
    ui::list(&mut tests);
    tests.run()
}
