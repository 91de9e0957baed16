//! A measure that has no value at some times leaves its cells empty there, and nothing else suffers.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, run};
use proptest::prelude::*;

/// A crank that turns steadily, with what is measured.
fn crank(declarations: &str) -> Outcome {
    let text = format!(
        "mechanism machine {{
            ground {{ point O = (0, 0) }}
            body crank at (0, 0, 0) {{ point O = (0, 0) point P = (1 m, 0) }}
            joint main: revolute(ground.O, crank.O)
            driver motor: rotation(main) = t
            {declarations}
            analysis from 0 s to 2 s every 0.1 s
        }}"
    );
    run("machine", &text, Span::default())
}

fn column(outcome: &Outcome, name: &str) -> Vec<f64> {
    let k = outcome.columns.iter().position(|column| column == name).expect("a column");
    outcome.rows.iter().map(|row| row[k]).collect()
}

/// The rows in which a column has no value.
fn missing(outcome: &Outcome, name: &str) -> Vec<usize> {
    let cells = column(outcome, name);
    assert!(cells.iter().all(|value| value.is_finite() || value.is_nan()), "{name}: {cells:?}");
    (0..cells.len()).filter(|&k| cells[k].is_nan()).collect()
}

#[test]
fn missing_measures_are_reported_once() {
    let table = "table bend = spline [(0, 0), (0.5, 1), (0.95, 0)]";
    let with = crank(&format!(
        "{table} measure pole = 1 / (t - 0.5) measure root = sqrt(1.25 - t) measure edge = sqrt(abs(t - 0.3)) measure left = bend(t)
         measure fine = sin(t)"
    ));
    assert_eq!(with.rows.len(), 21);
    assert_eq!(with.codes(), ["W0603"; 3], "{}", with.text());
    assert_eq!(missing(&with, "pole"), [5]);
    assert_eq!(missing(&with, "root"), (13..21).collect::<Vec<usize>>());
    assert!(missing(&with, "edge").is_empty());
    assert_eq!(missing(&with, "left"), (10..21).collect::<Vec<usize>>());
    assert_eq!(missing(&with, "left.dd"), (10..21).collect::<Vec<usize>>());
    let reported: Vec<(f64, u64)> = with
        .diagnostics
        .iter()
        .map(|one| (one.data["t"].as_f64().expect("a time"), one.data["rows"].as_u64().expect("a count")))
        .collect();
    assert_eq!([reported[0], reported[1]], [(0.5, 1), (1.3, 8)]);
    let without = crank("measure fine = sin(t)");
    for name in &without.columns {
        let bits = |outcome: &Outcome| column(outcome, name).iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
        assert_eq!(bits(&with), bits(&without), "{name}");
    }
}

/// A jerk that is not finite leaves the motion as it is; only what is measured of it has no value.
#[test]
fn missing_jerks_stop_no_motion() {
    let text = |lift: &str, declarations: &str| {
        format!(
            "mechanism m {{
                body b {{ point P = (0, 0) }}
                driver dx: x(b.P) = {lift}
                driver dy: y(b.P) = 0
                driver da: angle(b) = t
                {declarations}
                analysis from 0 to 1 every 0.25
            }}"
        )
    };
    for (lift, stops) in [("t^2.5", 0), ("abs(t - 0.5)^2.5", 2)] {
        let plain = run("m", &text(lift, ""), Span::default()).expect_success();
        let with = "measure a = der(der(x(b.P)))  measure v = speed(b.P)  result r = max(a)";
        let found = run("m", &text(lift, with), Span::default()).expect_success();
        for name in ["b.x", "b.x.d", "b.x.dd"] {
            assert_eq!(column(&plain, name), column(&found, name), "{lift} {name}");
        }
        assert_eq!(column(&found, "a"), column(&found, "b.x.dd"));
        assert_eq!(missing(&found, "a.d"), [stops], "{lift}");
        assert_eq!(found.codes().iter().filter(|&&code| code != "W0603").count(), 0, "{:?}", found.codes());
    }
}

#[test]
fn a_table_that_a_driver_leaves_stays_an_error() {
    let declarations = "table bend = spline [(0, 0), (0.5, 1), (0.95, 0)] function way(u) = bend(u)
        body arm at (0, 0, 0) { point O = (0, 0) } joint pin: revolute(ground.O, arm.O)";
    let declarations = format!("{declarations} measure first = way(t) driver other: rotation(pin) = way(t)");
    let outcome = crank(&declarations.replace("function way(u) =", "fn way(u) ="));
    assert_eq!(outcome.codes().last().map(ToString::to_string), Some("E0608".to_owned()), "{}", outcome.text());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A value that is not finite is reported at the declaration of its formula.
    #[test]
    fn the_declaration_that_holds_a_formula_is_named(which in 0..4_usize, at in 0.15..1.9_f64, kind in 0..3_usize) {
        let broken = ["sqrt(abs(t - AT))", "1e-3 / (t - AT)", "sqrt(AT - t)"][kind].replace("AT", &at.to_string());
        let term = |k: usize| if k == which { format!(" + 0.05 * ({broken})") } else { String::new() };
        let text = format!(
            "mechanism chain {{
                ground {{ point O = (0, 0) }}
                body a at (0, 0, 0) {{ point O = (0, 0) point P = (1, 0) }}
                body b at (1, 0, 0) {{ point O = (0, 0) point P = (1, 0) }}
                body c at (2, 0, 0) {{ point O = (0, 0) point P = (1, 0) }}
                joint ja: revolute(ground.O, a.O)
                joint jb: revolute(a.P, b.O)
                joint jc: revolute(b.P, c.O)
                driver d0: rotation(ja) = 0.2 * t{}
                driver d1: rotation(jb) = 0.3 * t{}
                driver d2: rotation(jc) = 0.1 * t{}
                measure d3 = t{}
                analysis from 0 s to 2 s every 0.1 s
            }}",
            term(0), term(1), term(2), term(3)
        );
        let outcome = run("chain", &text, Span::default());
        if which == 3 {
            prop_assert!(outcome.rows.len() == 21, "{}", outcome.text());
        } else {
            let diagnostic = outcome.diagnostics.iter().last().expect("told");
            let label = diagnostic.labels.first().expect("a label");
            let named = &text[label.span.start as usize..label.span.end as usize];
            prop_assert_eq!(named, format!("d{which}"), "{}", outcome.text());
            // what grows without bound may be too fast before it is infinite
            let is_reported = diagnostic.code.as_str() == "E0605" || (kind == 1 && diagnostic.code.as_str() == "E0604");
            prop_assert!(is_reported, "{}", outcome.text());
        }
    }
}
