//! The words of the language in the grammars of `editors/`, and what else of these files agrees with each other.
//! `UPDATE_GOLDENS=1 cargo test --test program editors` writes the words, those of the fuzzers' dictionary too.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

mod consistency;
mod words;

use crate::support::golden;
use std::collections::BTreeSet;
use std::fs;

/// A file of `editors/` is what it is made of.
fn holds(path: &str, made: impl FnOnce(&str) -> String) {
    let path = format!("editors/{path}");
    let written = fs::read_to_string(&path).unwrap_or_default();
    golden::holds(&path, &made(&written));
}

/// Line of the fuzzers' dictionary before what is written by hand.
const OTHERS: &str = "# operators, numbers and declarations\n";

#[test]
fn the_dictionary_of_the_fuzzers_has_every_word() {
    let path = "fuzz/mech.dict";
    let written = fs::read_to_string(path).unwrap();
    let (_, others) = written.split_once(OTHERS).expect("what is written by hand");
    let mut words = String::new();
    for name in mechc_text::vocabulary::words().map(|word| word.name).collect::<BTreeSet<&str>>() {
        let escaped: Vec<String> = name.bytes().map(escaped).collect();
        words += &format!("\"{}\"\n", escaped.concat());
    }
    golden::holds(path, &format!("# words of the language, for the target `text`\n{words}{OTHERS}{others}"));
}

/// A byte as libFuzzer reads it.
fn escaped(byte: u8) -> String {
    if byte.is_ascii() { char::from(byte).to_string() } else { format!("\\x{byte:02x}") }
}
