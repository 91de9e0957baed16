//! `mechc formula`: what it prints reads back, and has the values that it says.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use assert_cmd::Command;
use mechc::Sources;
use mechc_expr::{ExprId, Printer, Symbol};
use mechc_lang::check::{self, FormulaOfTime};
use mechc_syntax as syntax;
use proptest::prelude::*;

/// A formula as the command line takes it.
fn read(text: &str) -> FormulaOfTime {
    let mut sources = Sources::default();
    let file = sources.add_option("EXPR", text);
    let tree =
        syntax::parse_expression(&sources, file).unwrap_or_else(|_| panic!("{text} does not follow the grammar"));
    check::formula_of_time(&tree, &sources).unwrap_or_else(|found| panic!("{text}: {:?}", found.iter().next()))
}

fn value(formula: &FormulaOfTime, id: ExprId, t: f64) -> f64 {
    formula.graph.value(id, |_| t)
}

/// The formula and its first two derivatives.
fn derived(formula: &mut FormulaOfTime) -> [ExprId; 3] {
    let mut roots = [formula.value; 3];
    for k in 1..3 {
        let of = roots[k - 1];
        roots[k] =
            formula.graph.derivatives(&[of], |graph, symbol| (symbol == Symbol::Time).then(|| graph.constant(1.0)))[0];
    }
    roots
}

/// The largest number that comes up on the way to a value.
fn size(formula: &FormulaOfTime, id: ExprId, t: f64) -> f64 {
    let mut values = Vec::new();
    formula.graph.extend_values(&mut values, |_| t);
    formula.graph.reachable(&[id]).iter().map(|id| values[id.index()].abs()).fold(1.0, f64::max)
}

/// Formulas without poles where numbers are moderate.
fn formulas() -> impl Strategy<Value = String> {
    let number = (-40_i32..40).prop_map(|k| format!("{}", f64::from(k) / 8.0));
    let leaf = prop_oneof![4 => Just("t".to_owned()), 2 => number, 1 => Just("pi".to_owned())];
    leaf.prop_recursive(4, 24, 3, |inner| {
        let (a, b) = (inner.clone(), inner.clone());
        let binary = (a, b, 0..7_usize).prop_map(|(a, b, k)| match k {
            0 | 1 => format!("({a}) + {b}"),
            2 => format!("({a}) - ({b})"),
            3 | 4 => format!("({a}) * ({b})"),
            5 => format!("({a}) / (2 + sin({b}))"),
            _ => format!("hypot({a}, 1 + ({b})^2)"),
        });
        let unary = (inner.clone(), 0..12_usize).prop_map(|(a, k)| match k {
            0 => format!("sin({a})"),
            1 => format!("cos({a})"),
            2 => format!("exp(sin({a}))"),
            3 => format!("sqrt(1 + ({a})^2)"),
            4 => format!("ln(2 + cos({a}))"),
            5 => format!("atan({a})"),
            6 => format!("tanh({a})"),
            7 => format!("-({a})"),
            8 => format!("({a})^3"),
            9 => format!("(1 + ({a})^2)^-2"),
            10 => format!("(2 + sin({a}))^1.5"),
            _ => format!("({a})^2 / 3"),
        });
        let choice =
            (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| format!("(if {a} < {b} then {c} else {a})"));
        prop_oneof![4 => binary, 4 => unary, 1 => choice]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn reordered_formulas_keep_their_values(text in formulas()) {
        let Ok(mut formula) = std::panic::catch_unwind(|| read(&text)) else { return Err(TestCaseError::reject("a constant without value")) };
        let roots = derived(&mut formula);
        prop_assume!(formula.graph.written_size(&roots) < 3000);
        for root in roots {
            let tidy = formula.graph.tidied(root);
            let printed = Printer::new(&formula.graph, |_| "t".to_owned()).text(tidy);
            prop_assert!(!printed.contains("+ -") && !printed.contains("- -"), "{}", printed);
            let back = read(&printed);
            for t in [-1.3, -0.4, 0.31, 0.77, 1.9] {
                let (wanted, found) = (value(&formula, root, t), value(&back, back.value, t));
                let size = size(&formula, root, t).max(self::size(&back, back.value, t));
                if size < 1e5 {
                    let error = (wanted - found).abs();
                    prop_assert!(error <= 1e-9 * size, "{} at {}: {} became {} by {}", text, t, wanted, found, printed);
                }
            }
        }
    }
}

/// What was printed for a formula: the texts of C, C', C'' with the named parts put in, and the rows.
fn printed(text: &str, times: &[f64]) -> ([String; 3], Vec<[f64; 4]>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.args(["formula", text]);
    for t in times {
        command.args(["--at".to_owned(), t.to_string()]);
    }
    let output = command.output().expect("it runs");
    assert!(output.status.success(), "{text}: {}", String::from_utf8_lossy(&output.stderr));
    let output = String::from_utf8(output.stdout).expect("text");
    let mut parts: Vec<(String, String)> = Vec::new();
    let mut rows = Vec::new();
    for line in output.lines() {
        if let Some((name, text)) = line.split_once(" = ") {
            parts.push((name.trim().to_owned(), text.to_owned()));
        } else if line.starts_with(|c: char| c == ' ' || c == '-' || c.is_ascii_digit()) {
            let row: Vec<f64> = line.split_whitespace().map(|cell| cell.parse().expect("a number")).collect();
            rows.push(row.try_into().expect("four columns"));
        }
    }
    // a part may hold those before it, and the formula itself
    let named: Vec<(String, String)> = parts[3..].iter().chain(&parts[..1]).cloned().collect();
    let texts = [0, 1, 2].map(|k| {
        let mut text = parts[k].1.clone();
        for _ in 0..=named.len() {
            for (name, part) in named.iter().rev() {
                text = put_in(&text, name, part);
            }
        }
        text
    });
    (texts, rows)
}

/// A text with a name replaced.
fn put_in(text: &str, name: &str, part: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(name) {
        let after = &rest[at + name.len()..];
        let whole = !rest[..at].ends_with(is_word) && !after.starts_with(is_word);
        out += &rest[..at];
        out += &if whole { format!("({part})") } else { name.to_owned() };
        rest = after;
    }
    out + rest
}

#[test]
fn rows_and_texts_agree_with_each_other_and_with_differences() {
    let formulas = [
        "(1.5 * sin(t) + 3 * t^2)^2",
        "7",
        "-t",
        "20 mm * sin(60 rpm * t)",
        "30 deg + 2 * t",
        "step(t, 0.1, 0, 1.7, 2)",
        "step5(t, 0.1, 0, 1.7, 2)",
        "step7(t, 0, 0, 2, 90 deg)",
        "harmonic(t, 0, -1, 2, 1)",
        "cycloidal(t, 0 s, 0, 2 s, 20 mm)",
        "modsine(t, 0, 0, 2, 1)",
        "poly(t, 1, 1, 2, 3, 4)",
        "if t < 1 then t^2 else 2 * t - 1",
        "mod(t, 0.5) * t",
        "atan2(sin(t), 2 + cos(t))",
        "t^t",
        "ln(t)^2 / t",
        "exp(-t) * sin(3 * t) * sqrt(1 + t^2)",
        "max(sin(t), cos(t)) + abs(t - 1.1) + min(t, 1, 2 * t)",
        "asin(t / 3) * acos(t / 4) - tan(t / 5) + log10(t) + sinh(t) / cosh(t)",
        "((sin(t) + cos(2 * t)) * (1 + t^3) * exp(sin(t^2)) / (2 + sin(t)))^3 + hypot(t, 1 + t)^2.5",
    ];
    let times = [0.23, 0.61, 1.37, 1.83];
    for text in formulas {
        let (texts, rows) = printed(text, &times);
        assert_eq!(rows.len(), times.len(), "{text}");
        let original = read(text);
        let back = texts.each_ref().map(|text| read(text));
        for row in rows {
            let t = row[0];
            assert_eq!(row[1], value(&original, original.value, t) + 0.0, "{text} at {t}");
            for (k, formula) in back.iter().enumerate() {
                let (found, wanted) = (value(formula, formula.value, t), row[k + 1]);
                let size = size(formula, formula.value, t);
                assert!((found - wanted).abs() <= 1e-12 * size, "{text} at {t}: {wanted}, and {found} by {}", texts[k]);
            }
            let h = 1e-5;
            for k in 0..2 {
                let at = |t: f64| value(&back[k], back[k].value, t);
                let difference = (at(t + h) - at(t - h)) / (2.0 * h);
                let error = (difference - row[k + 2]).abs();
                assert!(error < 1e-6 * (1.0 + difference.abs()), "{text} at {t}: {} and {difference}", row[k + 2]);
            }
        }
    }
}

#[test]
fn large_formulas_end_soon() {
    let sum: Vec<String> = (1..4000).map(|k| format!("sin({k}*t)")).collect();
    let product: Vec<String> = (1..1500).map(|k| format!("(1+sin({k}*t)/9)")).collect();
    let deep = format!("{}t{}", "sin(2*".repeat(190), ")".repeat(190));
    let nested = (0..60).fold("t".to_owned(), |inner, _| format!("sin({inner})*cos(t)+t"));
    for text in
        [sum.join("+"), product.join("*"), deep, nested, format!("t{}", "*t".repeat(20_000)), "-".repeat(190) + "t"]
    {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
        let output = command.args(["formula", &text, "--at", "0.5"]).output().expect("it runs");
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{}: {error}", &text[..40.min(text.len())]);
        let size = output.stdout.len();
        assert!(size < 2_000_000, "{size} bytes for {}", &text[..40.min(text.len())]);
    }
    let too_deep = format!("{}t{}", "(".repeat(400), ")".repeat(400));
    let output = Command::new(env!("CARGO_BIN_EXE_mechc")).args(["formula", &too_deep]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("E0103"));
}
