//! Random texts with parts, repetition, inputs and drawn points: no panic, what is repeated is what is written out, and a part is what it
//! is alone. The fuzzer makes the same texts (`fuzz/src`), and more of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![allow(dead_code)] // what is shared with the fuzzer is not all used here
#![allow(clippy::pedantic, clippy::disallowed_methods)] // it is written for the fuzzer, which knows nothing of these

#[path = "../fuzz/src/composed.rs"]
mod composed;
#[path = "../fuzz/src/generate.rs"]
mod generate;
#[path = "../fuzz/src/oracles.rs"]
mod oracles;
#[path = "support/random.rs"]
mod random;

use composed::composed;
use mechc::{Choice, Memory, Parsed};
use oracles::{a_part_is_what_it_is_alone, repetition_is_what_is_written_out};
use random::Random;

/// Texts that are tried.
const TEXTS: u64 = 40;

/// Bytes that make one.
const BYTES: usize = 900;

fn bytes(seed: u64) -> Vec<u8> {
    let mut random = Random::new(seed);
    // what rarely happens is asked for by the highest bytes
    let highest = random.of(&[200, 235, 256]);
    (0..BYTES).map(|_| random.below(highest) as u8).collect()
}

#[test]
fn what_is_repeated_is_what_is_written_out_by_hand() {
    let compared = (0..TEXTS).map(|seed| composed(&bytes(seed))).filter(repetition_is_what_is_written_out).count();
    assert!(compared > 25, "only {compared} have rows");
}

#[test]
fn parts_are_what_they_are_alone() {
    let compared = (0..TEXTS).map(|seed| composed(&bytes(seed)).part).filter(a_part_is_what_it_is_alone).count();
    assert!(compared > 20, "only {compared} have rows");
}

#[test]
fn composed_texts_are_formatted_to_what_they_mean() {
    for seed in 0..TEXTS {
        let text = composed(&bytes(seed)).text;
        let parsed = Parsed::of("text", &text);
        let formatted = parsed.formatted().unwrap_or_else(|| panic!("{seed} is refused:\n{text}"));
        let equations = |text: &str| {
            let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
            Parsed::of("text", text).check(&choice, &Memory::default()).equations_text()
        };
        assert_eq!(equations(&formatted), equations(&text), "{seed}:\n{text}");
    }
}
