//! Random texts with parts, repetition, inputs and drawn points: no panic, what is repeated is what is written out, and a part is what it
//! is alone. The fuzzer makes the same texts (`fuzz/src`), and more of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![allow(dead_code)] // what is shared with the fuzzer is not all used here

#[path = "../fuzz/src/composed.rs"]
mod composed;
#[path = "../fuzz/src/generate.rs"]
mod generate;
#[path = "../fuzz/src/oracles.rs"]
mod oracles;
#[path = "support/random.rs"]
mod random;

use random::Random;
use std::panic::catch_unwind;

/// Texts that are tried.
const TEXTS: u64 = 150;

/// Bytes that make one.
const BYTES: usize = 900;

fn bytes(seed: u64) -> Vec<u8> {
    let mut random = Random::new(seed);
    // what rarely happens is asked for by the highest bytes
    let highest = random.of(&[200, 235, 256]);
    (0..BYTES).map(|_| random.below(highest) as u8).collect()
}

#[test]
fn texts_with_parts_and_repetition_mean_what_they_say() {
    let (mut repeated, mut alone) = (0, 0);
    let first = std::env::var("FIRST").map_or(0, |n| n.parse().unwrap());
    let texts = std::env::var("TEXTS").map_or(TEXTS, |n| n.parse().unwrap());
    let mut faults = Vec::new();
    for seed in first..first + texts {
        let composed = composed::composed(&bytes(seed));
        match catch_unwind(|| oracles::repetition_is_what_is_written_out(&composed)) {
            Ok(compared) => repeated += u32::from(compared),
            Err(_) => faults.push(format!("{seed} R")),
        }
        match catch_unwind(|| oracles::a_part_is_what_it_is_alone(&composed.part)) {
            Ok(compared) => alone += u32::from(compared),
            Err(_) => faults.push(format!("{seed} P")),
        }
    }
    println!("{repeated} {alone} of {texts}");
    assert!(faults.is_empty(), "{faults:?}");
}
