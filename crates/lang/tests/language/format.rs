//! What `syntax::format` prints reads back as the same tree, and looks as a person would write it.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::shape::{file_shape, shape};
use crate::support::{files, text_of};
use mechc::{Color, Diagnostics, Format, render};
use mechc::{Sources, Span};
use mechc_syntax::ast::File;
use mechc_syntax::ast::{ComparisonSign, Expr, ExprKind, Factor, Name, Sign, Window};
use mechc_syntax::format::expression;
use mechc_syntax::{ParsedText, format, parse, parse_expression};
use proptest::prelude::*;
use std::fs;

// ---- files

fn read<T>(text: &str, parse: impl Fn(&Sources, mechc::FileId) -> Result<T, Diagnostics>) -> Result<T, String> {
    let mut sources = Sources::default();
    let file = sources.add("text.mech", text);
    parse(&sources, file).map_err(|faults| {
        let faults: String = faults.iter().map(|d| render(d, &sources, Format::Human, Color::Never)).collect();
        format!("{faults}\n{text}")
    })
}

/// The tree of a text without faults.
fn whole(parsed: ParsedText) -> Result<File, Diagnostics> {
    if parsed.faults.is_empty() { Ok(parsed.tree) } else { Err(parsed.faults) }
}

/// Formats a text, after a check that the result is the same file and that formatting it again changes nothing.
fn formatted(name: &str, text: &str) -> String {
    let read_file = |text: &str| read(text, |sources, file| whole(parse(sources, file)));
    let tree = read_file(text).unwrap_or_else(|faults| panic!("{name}: {faults}"));
    let once = format(&tree);
    let again = read_file(&once).unwrap_or_else(|faults| panic!("{name}, formatted: {faults}"));
    assert_eq!(file_shape(&again), file_shape(&tree), "{name}:\n{once}");
    assert_eq!(format(&again), once, "{name} changes when it is formatted twice");
    assert!(once.lines().all(|line| line.trim_end() == line), "{name}: spaces at the end of a line\n{once}");
    once
}

#[test]
fn files_read_back() {
    for folder in ["examples", "tests/cases", "tests/ui/ok"] {
        for path in files(folder, "mech") {
            formatted(&path.display().to_string(), &fs::read_to_string(&path).expect("a text"));
        }
    }
}

/// Also what is refused later, as long as it follows the grammar.
#[test]
fn files_with_mistakes_read_back_too() {
    let mut visited = 0;
    for path in files("tests/ui", "mech") {
        let text = fs::read_to_string(&path).expect("a text");
        if read(&text, |sources, file| whole(parse(sources, file))).is_ok() {
            formatted(&path.display().to_string(), &text);
            visited += 1;
        }
    }
    assert!(visited > 50, "only {visited} files follow the grammar");
}

/// A file that was written in the style of the formatter, without `//` comments, stays as it is.
#[test]
fn formatted_files_stay_unchanged() {
    for name in ["cam_point_follower", "gear_pair", "rack_and_pinion", "drawn_phase", "translational_driver"] {
        let text = text_of(format!("tests/cases/{name}.mech"));
        assert_eq!(formatted(name, &text), text, "{name}");
    }
}

#[test]
fn one_of_everything() {
    insta::assert_snapshot!(formatted("everything", include_str!("../../../../tests/format/everything.mech")));
}

#[test]
fn a_tree_without_declarations() {
    assert_eq!(
        formatted("empty", "mechanism  a{}mechanism b {ground{}}"),
        "mechanism a {}\n\nmechanism b {\n    ground {}\n}\n"
    );
}

/// Parentheses that go must not make a formula look nested deeper than it is.
#[test]
fn conditions_in_a_long_chain() {
    let arms = "if t < 1 then (if t < 2 then 3 else 4) else ".repeat(250);
    let text = formatted("chain", &format!("mechanism chain {{ param a = {arms} 5 }}"));
    assert!(!text.contains('('), "{text}");
}

// ---- formulas

/// The text of a formula that was read from `text`.
fn respelled(text: &str) -> String {
    expression(&read(text, parse_expression).unwrap_or_else(|faults| panic!("{faults}")))
}

#[test]
fn only_needed_parentheses_stay() {
    for text in [
        "a - (b - c)",
        "a + (b + c)",
        "a / (b * c)",
        "a * (b / c)",
        "(a + b) * -c",
        "-(a * b) + c",
        "-a * b",
        "(-x)^2",
        "-x^2",
        "2^-1",
        "2^-x^2",
        "(a^b)^c",
        "a^b^c",
        "a^(b * c)",
        "(50 mm)^2",
        "50 mm^2",
        "(50 mm^2)^3",
        "2^(3 mm)",
        "2^-(3 mm)",
        "x^(2 rad)^2",
        "1 / 2 s",
        "a - -b",
        "--a",
        "2 * (if t < 1 then 2 else 3)",
        "(if t < 1 then 2 else 3) + 1",
        "if t < 1 then 1 else 2 + 3",
        "if a < b and (c < d or not e > f) then 1 else if not (a < b and c > d) then 2 else 3",
        "if (a or b) and c or not not d then if e then 1 else 2 else 3",
        "f((a, b), if c then d else e, ground.O)",
        "((a, b), c)",
        "30 deg/s * t",
        "9.81 m/s^2 * t^2 / 2",
        "a / 30 deg / s",
        "1 rev / 30 ms * t",
        "50 mm / speed",
    ] {
        assert_eq!(respelled(text), text);
    }
}

#[test]
fn superfluous_parentheses_are_removed() {
    for (text, wanted) in [
        ("((a))", "a"),
        ("((a + b) + c)", "a + b + c"),
        ("(a * b) / (c)", "a * b / c"),
        ("(a * b) + (-c)", "a * b + -c"),
        ("-(a^2)", "-a^2"),
        ("a^(b^c)", "a^b^c"),
        ("2^(-1)", "2^-1"),
        ("(sin(x))^2", "sin(x)^2"),
        ("((a, b))", "(a, b)"),
        (
            "if (a < b) and (c and d) then (1) else (if e then 2 else 3)",
            "if a < b and c and d then 1 else if e then 2 else 3",
        ),
        ("50mm ^ 2", "50 mm^2"),
        ("2rad/s*t", "2 rad/s * t"),
        ("(t * 2 rad) / s", "t * 2 rad/s"),
    ] {
        assert_eq!(respelled(text), wanted, "{text}");
    }
}

#[test]
fn numbers_are_short() {
    for (text, wanted) in [
        ("38.0", "38"),
        (".5e1", "5"),
        ("1E+3", "1000"),
        ("1e-3", "0.001"),
        ("0.00025", "0.00025"),
        ("123456789", "123456789"),
        ("0.1", "0.1"),
        ("1e-12", "1e-12"),
        ("1.5e+100", "1.5e100"),
        ("1e999", "1e999"),
        ("0.0617138900142764496358948458001", "0.06171389001427645"),
    ] {
        assert_eq!(respelled(text), wanted);
    }
}

/// Whether parentheses must stand around what is in them, found by leaving them away.
fn needed(text: &str, span: Span, inner: &Expr, whole: &str) -> bool {
    // a number with a unit as a base looks better in them, even where its unit has a power
    if matches!(inner.kind, ExprKind::Literal { unit: Some(_), .. }) {
        return true;
    }
    let mut without = text.to_owned();
    without.replace_range(span.start as usize..=span.start as usize, " ");
    without.replace_range(span.end as usize - 1..span.end as usize, " ");
    read(&without, parse_expression).map_or(true, |e| shape(&e) != whole)
}

fn parentheses<'a>(e: &'a Expr, found: &mut Vec<(Span, &'a Expr)>) {
    if let ExprKind::Paren(inner) = &e.kind {
        found.push((e.span, inner));
    }
    for child in e.children() {
        parentheses(child, found);
    }
}

fn expr(kind: ExprKind) -> Expr {
    let file = Sources::default().add("none", "");
    Expr { kind, span: Span { file, start: 0, end: 0 } }
}

fn name(text: &str) -> Name {
    Name { text: text.to_owned(), span: expr(ExprKind::Tuple(Vec::new())).span }
}

fn leaf() -> impl Strategy<Value = Expr> {
    let value = prop_oneof![
        (0_u32..100).prop_map(f64::from),
        0.0..1000.0,
        proptest::num::f64::POSITIVE | proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL,
    ];
    let unit = proptest::option::of((prop_oneof![Just("mm"), Just("s"), Just("deg")], prop_oneof![Just(1), -3..4]));
    prop_oneof![
        (value, unit).prop_map(|(value, unit)| {
            ExprKind::Literal { value, unit: unit.map(|(unit, power)| (name(unit), power)) }
        }),
        prop_oneof![Just("t"), Just("s"), Just("to"), Just("from"), Just("größe_1")]
            .prop_map(|text| ExprKind::Name(name(text))),
        Just(ExprKind::Member { owner: name("ground"), feature: name("O") }),
    ]
    .prop_map(expr)
}

fn tree() -> impl Strategy<Value = Expr> {
    leaf().prop_recursive(6, 80, 4, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        let list = |least: usize| proptest::collection::vec(inner.clone(), least..4);
        let sign = prop_oneof![Just(Sign::Plus), Just(Sign::Minus)];
        let factor = prop_oneof![Just(Factor::Times), Just(Factor::Divide)];
        let comparison = prop_oneof![
            Just(ComparisonSign::Less),
            Just(ComparisonSign::LessEqual),
            Just(ComparisonSign::Greater),
            Just(ComparisonSign::GreaterEqual),
            Just(ComparisonSign::Equal),
            Just(ComparisonSign::NotEqual),
        ];
        let terms = proptest::collection::vec((sign, inner.clone()), 1..4);
        let factors = proptest::collection::vec((factor, inner.clone()), 1..4);
        let bound = || inner.clone().prop_map(Some);
        let bounds = prop_oneof![(bound(), bound()), (bound(), Just(None)), (Just(None), bound())];
        let bounds = bounds.prop_map(|(from, to)| Some(Box::new(Window { from, to, span: name("f").span })));
        let arms = proptest::collection::vec((inner.clone(), inner.clone()), 1..3);
        prop_oneof![
            boxed().prop_map(ExprKind::Negate),
            boxed().prop_map(ExprKind::Not),
            (boxed(), terms).prop_map(|(first, rest)| ExprKind::Sum(first, rest)),
            (boxed(), factors).prop_map(|(first, rest)| ExprKind::Product(first, rest)),
            (boxed(), boxed()).prop_map(|(base, exponent)| ExprKind::Power(base, exponent)),
            (boxed(), comparison, boxed()).prop_map(|(a, comparison, b)| ExprKind::Compare(a, comparison, b)),
            list(2).prop_map(ExprKind::And),
            list(2).prop_map(ExprKind::Or),
            list(2).prop_map(ExprKind::Tuple),
            list(0).prop_map(|arguments| ExprKind::Call { name: name("f"), arguments, window: None }),
            (list(1), bounds).prop_map(|(arguments, window)| ExprKind::Call { name: name("f"), arguments, window }),
            (arms, boxed()).prop_map(|(arms, otherwise)| ExprKind::If { arms, otherwise }),
        ]
        .prop_map(expr)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_tree_that_was_never_written_reads_back(e in tree()) {
        let text = expression(&e);
        let again = read(&text, parse_expression).unwrap_or_else(|faults| panic!("{faults}"));
        let whole = shape(&e);
        prop_assert_eq!(&shape(&again), &whole, "{}", text);
        prop_assert_eq!(expression(&again), text.clone());
        let mut found = Vec::new();
        parentheses(&again, &mut found);
        for (span, inner) in found {
            prop_assert!(needed(&text, span, inner, &whole), "{} at {}", text, span.start);
        }
    }
}
