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
    let escaped = |name: &str| -> String {
        name.bytes().map(|b| if b.is_ascii() { char::from(b).to_string() } else { format!("\\x{b:02x}") }).collect()
    };
    let names: BTreeSet<&str> = mechc_text::vocabulary::words().map(|word| word.name).collect();
    let words: String = names.into_iter().map(|name| format!("\"{}\"\n", escaped(name))).collect();
    golden::holds(path, &format!("# words of the language, for the target `text`\n{words}{OTHERS}{others}"));
}
