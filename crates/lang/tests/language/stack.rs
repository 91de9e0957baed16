//! No input overflows a small stack.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

#[path = "../../../../tests/support/deep_texts.rs"]
mod deep_texts;

use deep_texts::{deep_texts, run_all_stages};
use mechc::{Choice, Memory, Parsed, Sources};
use mechc_expr::math;
use mechc_lang::check;
use mechc_lang::model::Mechanism;
use mechc_syntax as syntax;
use proptest::collection::vec;
use proptest::prelude::*;
use std::thread;

/// The stack of a page's WebAssembly, and of the main thread where stacks are smallest, is 1 MiB (`tests/wasm` runs with that). The frames
/// of a build that is not optimised are several times as large.
const STACK: usize = if cfg!(debug_assertions) { 4 << 20 } else { 1 << 20 };

/// What is refused, though it is not for its depth: each branch has its own condition for what is in it, and so they multiply.
const TOO_LARGE: &str = "functions with branches";

#[test]
fn deepest_texts_run_on_a_small_stack() {
    let all = deep_texts();
    assert!(all.len() > 20);
    for deep in all {
        let name = deep.name;
        let way = thread::Builder::new().name(name.to_owned()).stack_size(STACK);
        let went = way.spawn(move || run_all_stages(&deep)).expect("a thread").join().expect("no panic");
        match went {
            Ok(_) => assert_ne!(name, TOO_LARGE),
            Err(messages) => assert!(name == TOO_LARGE && messages.contains("E0410"), "{name}: {messages}"),
        }
    }
}

/// A chain of functions in a text, what is said in front of it, and where its last one is called.
fn chained(members: &[(u8, f64)], first: &str, rest: &str) -> String {
    let mut text = format!("mechanism chained {{ fn f0(u) = {first}\n");
    for (k, &(kind, c)) in members.iter().enumerate() {
        let body = match kind {
            0 => format!("{c} * sin(f{k}(u)) + 0.5"),
            1 => format!("f{k}(u + {c})"),
            2 => format!("f{k}(u) * cos(f{k}(u) + {c}) - f{k}(u) / 3"),
            3 => format!("f{k}(f0(u) * {c})"),
            _ => format!("(1 + (f{k}(u) - {c}) * (1 - f0(u)))"),
        };
        text += &format!("fn f{}(u) = {body}\n", k + 1);
    }
    text + &rest.replace("LAST", &format!("f{}", members.len())) + "}"
}

/// The value of the last member of such a chain whose first function gives its argument.
fn value(members: &[(u8, f64)], u: f64) -> f64 {
    let Some((&(kind, c), before)) = members.split_last() else {
        return u;
    };
    match kind {
        0 => c * math::sin(value(before, u)) + 0.5,
        1 => value(before, u + c),
        2 => {
            let f = value(before, u);
            f * math::cos(f + c) - f / 3.0
        }
        3 => value(before, u * c),
        _ => 1.0 + (value(before, u) - c) * (1.0 - u),
    }
}

/// The model of a text, and the codes of what is said of it.
fn checked(text: &str) -> (Option<Mechanism>, Vec<&'static str>) {
    let mut sources = Sources::default();
    let file = sources.add("chained", text);
    let parsed = syntax::parse(&sources, file);
    assert!(parsed.faults.is_empty());
    let (model, messages) = check::check(&parsed.tree.mechanisms[0], &check::CheckOptions::default(), &sources);
    (model, messages.iter().map(|one| one.code.as_str()).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn calls_that_are_put_off_have_their_values(members in vec((0_u8..5, 0.1_f64..0.9), 1..400)) {
        let rest = "param p = 1 * LAST(0.3) param q = if LAST(0.4) < 1e9 then LAST(0.5) else 1 / 0 body b { point O = (0, 0) }";
        let (model, codes) = checked(&chained(&members, "u", rest));
        let model = model.ok_or_else(|| TestCaseError::fail(format!("{codes:?}")))?;
        for (param, u) in model.params.iter().zip([0.3, 0.5]) {
            let (found, wanted) = (param.value, value(&members, u));
            // rounding grows along the chain only where the values do
            prop_assert!((found - wanted).abs() <= 1e-6 * (1.0 + wanted.abs()), "{found} instead of {wanted}");
        }
    }
}

#[test]
fn long_chains_are_reported_as_short_ones() {
    let body = "body b { point O = (0, 0) } driver d: angle(b) =";
    let cases = [
        ("u", "param p = if LAST(1) > 1e9 then 1 / 0 else 2", vec![]),
        ("u", "param p = if LAST(1) < 1e9 then 1 / 0 else 2", vec!["E0404"]),
        ("1 / (u - u)", "param p = LAST(1) + LAST(2)", vec!["E0404"]),
        ("sin(u + 1 m)", "param p = LAST(1 s)", vec!["E0401"]),
    ];
    for (first, rest, wanted) in cases {
        for count in [3, 40, 70, 140, 900] {
            let (_, codes) = checked(&chained(&vec![(0, 0.5); count], first, &format!("{rest} {body} t")));
            assert_eq!(codes, wanted, "{first}, {rest}, {count} functions");
        }
    }
    // what must be positive is asked once
    for count in [3, 40, 70, 140, 900] {
        let (model, codes) =
            checked(&chained(&vec![(0, 0.5); count], "step(u, 0, 0, u + 1, 1)", &format!("{body} LAST(t) + LAST(t)")));
        let requested = model.map(|model| model.conditions.len());
        assert_eq!((requested, codes), (Some(1), vec![]), "{count} functions");
    }
}

#[test]
fn part_nesting_is_reported_on_a_small_stack() {
    let level = |k: usize| format!("mechanism m{k} {{ part a: m{}() }}\n", k + 1);
    let text = (0..4000).map(level).collect::<String>() + "mechanism m4000 { body b { point O = (0, 0) } }";
    let check = move || {
        let choice = Choice { mechanism: Some("m0".to_owned()), ..Choice::default() };
        let checked = Parsed::new("levels", &text).check(&choice, &Memory::default());
        checked.diagnostics().iter().map(|message| message.code.as_str()).collect::<Vec<_>>()
    };
    let reported =
        thread::Builder::new().stack_size(STACK / 2).spawn(check).expect("a thread").join().expect("no panic");
    assert_eq!(reported, ["E0209"]);
}
