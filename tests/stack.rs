//! No input overflows a small stack.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

#[path = "support/deepest.rs"]
mod deepest;

use deepest::{all_ways, deepest};
use std::thread;

/// The stack of a page's WebAssembly, and of the main thread where stacks are smallest, is 1 MiB (`tests/wasm` runs with that). The frames
/// of a build that is not optimised are several times as large.
const STACK: usize = if cfg!(debug_assertions) { 4 << 20 } else { 1 << 20 };

/// What is refused, though it is not for its depth: each branch has its own condition for what is in it, and so they multiply.
const TOO_LARGE: &str = "functions with branches";

#[test]
fn what_is_deepest_does_with_a_small_stack() {
    let all = deepest();
    assert!(all.len() > 20);
    for deep in all {
        let name = deep.name;
        let way = thread::Builder::new().name(name.to_owned()).stack_size(STACK);
        let went = way.spawn(move || all_ways(&deep)).expect("a thread").join().expect("no panic");
        match went {
            Ok(_) => assert_ne!(name, TOO_LARGE),
            Err(said) => assert!(name == TOO_LARGE && said.contains("E0410"), "{name}: {said}"),
        }
    }
}
