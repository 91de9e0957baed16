//! Random texts with parts, repetition, inputs and drawn points: no panic, what is repeated is what is written out, and a part is what it
//! is alone. The fuzzer makes the same texts (`fuzz/src`), and more of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::fuzz::composed::composed;
use crate::fuzz::oracles::{a_part_is_what_it_is_alone, repetition_is_what_is_written_out};
use crate::support::random::Random;
use mechc::{Choice, Memory, Parsed};
use std::time::{Duration, Instant};

/// Texts that are tried.
const TEXTS: u64 = 40;

/// By when what is too large is told, by a build that is not optimised.
const SOON: Duration = Duration::from_secs(300);

/// Bytes that make one.
const BYTES: usize = 900;

fn bytes(seed: u64) -> Vec<u8> {
    let mut random = Random::new(seed);
    // what rarely happens is asked for by the highest bytes
    let highest = random.of(&[200, 235, 256]);
    (0..BYTES).map(|_| random.below(highest) as u8).collect()
}

#[test]
fn repetitions_match_copies_by_hand() {
    let compared = (0..TEXTS).map(|seed| composed(&bytes(seed))).filter(repetition_is_what_is_written_out).count();
    assert!(compared > 25, "only {compared} have rows");
}

#[test]
fn parts_match_single_mechanisms() {
    let compared = (0..TEXTS).map(|seed| composed(&bytes(seed)).part).filter(a_part_is_what_it_is_alone).count();
    assert!(compared > 20, "only {compared} have rows");
}

#[test]
fn formatting_keeps_the_meaning_of_composed_texts() {
    for seed in 0..TEXTS {
        let text = composed(&bytes(seed)).text;
        let parsed = Parsed::new("text", &text);
        let formatted = parsed.formatted().unwrap_or_else(|| panic!("{seed} is refused:\n{text}"));
        let equations = |text: &str| {
            let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
            Parsed::new("text", text).check(&choice, &Memory::default()).equations_text()
        };
        assert_eq!(equations(&formatted), equations(&text), "{seed}:\n{text}");
    }
}

/// What is said of a text that is too large: just that.
fn too_large(text: &str) {
    let begun = Instant::now();
    let checked = Parsed::new("text", text)
        .check(&Choice { mechanism: Some("top".to_owned()), ..Choice::default() }, &Memory::default());
    let reported: Vec<&str> = checked.diagnostics().iter().map(|message| message.code.as_str()).collect();
    assert!(!reported.is_empty() && reported.iter().all(|code| *code == "E0208"), "{reported:?}: {text}");
    assert!(begun.elapsed() < SOON, "{:?}: {text}", begun.elapsed());
}

#[test]
fn excessive_sizes_are_reported_early() {
    let leaf = |copies: &str| {
        format!(
            "mechanism leaf {{ param n = 1 body b[k in 0..{copies}] {{ point O = (0, 0) }} driver d[k in 0..{copies}]: angle(b[k]) = t }}\n"
        )
    };
    too_large(&format!("mechanism top {{ part p[i in 0..1000]: leaf() }}\n{}", leaf("1000")));
    too_large(&format!(
        "mechanism top {{ part p[i in 0..1000, j in 0..1000]: leaf()  measure x = x(p[3, 4].b[0].O) }}\n{}",
        leaf("2")
    ));
    // twice as many on every level, all the same, and each another one
    for bound in ["", "n = 2 * n"] {
        let level = |k: u32| {
            let name = if k == 0 { "top".to_owned() } else { format!("m{k}") };
            let inner = if k == 31 { "leaf".to_owned() } else { format!("m{}", k + 1) };
            format!("mechanism {name} {{ param n = 1  part a: {inner}({bound})  part b: {inner}() }}\n")
        };
        too_large(&((0..32).map(level).collect::<String>() + &leaf("n")));
    }
}
