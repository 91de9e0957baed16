//! Domain boundaries: where a root, a power or an arc cosine of time reaches the end of its domain, both sides decide what is reported; where
//! one of the motion does, the run ends.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, run};
use mechc::Diagnostic;
use proptest::prelude::*;

/// A block on a slide that is driven, in metres, over two seconds.
fn slide(formula: &str, every: &str) -> Outcome {
    let text = format!(
        "mechanism slide {{
            ground {{ axis way = (0, 0) along (1, 0) }}
            body block {{ axis way = (0, 0) along (1, 0) }}
            joint guide: translational(ground.way, block.way)
            driver push: displacement(guide) = {formula}
            analysis from 0 s to 2 s every {every}
        }}"
    );
    run("slide", &text, Span::default())
}

/// A pin on a curve that runs along x at one metre per second.
fn on_curve(formula: &str, every: &str) -> Outcome {
    let text = format!(
        "mechanism pin {{
            body a {{ point P = (0, 0) }}
            driver x: x(a.P) = t
            constraint y: y(a.P) = {formula}
            constraint p: angle(a) = 0
            analysis from 0 s to 2 s every {every}
        }}"
    );
    run("pin", &text, Span::default())
}

/// The only diagnostic, of the given code.
fn only<'o>(outcome: &'o Outcome, code: &str, of: &str) -> &'o Diagnostic {
    assert_eq!(outcome.codes(), [code], "{of}: {}", outcome.text());
    outcome.diagnostics.iter().next().expect("one")
}

fn time_of(diagnostic: &Diagnostic) -> f64 {
    diagnostic.data.get("t").and_then(serde_json::Value::as_f64).expect("a time")
}

/// Formulas in a variable `U` with a zero at `C`, each with the code that is reported there and a word of its message.
const KINDS: &[(&str, Option<(&str, &str)>)] = &[
    ("0.3 * sqrt((U - C)^2)", Some(("E0609", "velocity"))),
    ("0.1 * acos(cos(3 * (U - C)))", Some(("E0609", "velocity"))),
    ("0.1 * asin(cos(2 * (U - C)))", Some(("E0609", "velocity"))),
    ("hypot(U - C, (U - C)^2)", Some(("E0609", "velocity"))),
    ("sqrt(sin(U - C)^2)", Some(("E0609", "velocity"))),
    ("sqrt(U^2 - 2 * C * U + C^2 + 0 * U)", Some(("E0609", "velocity"))),
    ("0.1 * atan2(U - C, -1)", Some(("E0609", "jumps"))),
    ("0.1 * atan2(U - C, 2 * (U - C))", Some(("E0609", "jumps"))),
    ("((U - C)^2)^0.25", Some(("E0605", "not finite"))),
    ("((U - C)^2)^(1/3)", Some(("E0605", "not finite"))),
    ("((U - C)^2)^0.75", Some(("E0605", "not finite"))),
    ("sqrt(abs(U - C))", Some(("E0605", "not finite"))),
    ("sign(U - C) * abs(U - C)^(1/3)", Some(("E0605", "not finite"))),
    ("(U - C) * sqrt((U - C)^2)", Some(("W0601", "acceleration"))),
    ("sqrt((U - C)^4)", None),
    ("sqrt((U - C)^6)", None),
    ("hypot((U - C)^2, (U - C)^3)", None),
    ("((U - C)^2)^2.5", None),
    ("sin(U - C) / (U - C)", None),
    ("sin(atan2(U - C, -1))", None),
];

/// Formulas that keep away from the ends of the domains of their functions.
const AWAY: &[&str] = &[
    "sqrt((U - C)^2 + 1e-4)",
    "0.1 * acos(0.999 * cos(2 * (U - C)))",
    // its poles lie behind the end
    "0.01 * tan(0.5 * (U - C))",
    "sqrt(1 + U^2)",
    // the pole lies in the branch that is not taken
    "if abs(U - C) > 1e-3 then sin(U - C) / (U - C) else 1 - (U - C)^2 / 6",
];

fn holds(outcome: &Outcome, reported: Option<(&str, &str)>, c: f64, of: &str) {
    let Some((code, word)) = reported else {
        assert!(outcome.diagnostics.is_empty() && outcome.succeeded(), "{of}: {}", outcome.text());
        return;
    };
    let diagnostic = only(outcome, code, of);
    assert!(diagnostic.message.contains(word), "{of}: {}", diagnostic.message);
    let found = time_of(diagnostic);
    assert!((found - c).abs() < 1e-8, "{of}: {found} instead of {c}");
    if code != "W0601" {
        assert!(outcome.rows.iter().all(|row| row[0] < c + 1e-8), "{of}: a row behind the end");
    }
}

#[test]
fn both_sides_of_a_rim_of_time_decide() {
    let away = AWAY.iter().take(4).map(|kind| (*kind, None));
    for (kind, reported) in KINDS.iter().copied().chain(away) {
        let formula = kind.replace('U', "t").replace('C', "0.70013");
        for every in ["0.1 s", "0.7 s", "10 ms"] {
            holds(&slide(&formula, every), reported, 0.70013, &format!("{formula} every {every}"));
        }
    }
}

#[test]
fn a_rim_of_the_motion_ends_it() {
    let c = 0.70013;
    for kind in KINDS.iter().map(|(kind, _)| *kind) {
        let formula = format!("1 m * ({})", kind.replace('U', "(x(a.P) / 1 m)").replace('C', "0.70013"));
        for every in ["0.1 s", "0.7 s"] {
            let (outcome, of) = (on_curve(&formula, every), format!("{formula} every {every}"));
            let diagnostic = only(&outcome, "E0605", &of);
            let found = time_of(diagnostic);
            // intervals of terms that cancel are wide
            let within = if kind.contains("U^2 - 2") { 1e-5 } else { 1e-7 };
            assert!((found - c).abs() < within, "{of}: {found} instead of {c}");
            assert!(outcome.rows.iter().all(|row| row[0] < found), "{of}: a row behind the end");
            assert!(outcome.rows.last().is_some_and(|row| row[0] > c - 0.71), "{of}: {} rows", outcome.rows.len());
        }
    }
}

#[test]
fn motions_that_keep_away_from_rims_go_on() {
    for kind in AWAY {
        let formula = format!("1 m * ({})", kind.replace('U', "(x(a.P) / 1 m)").replace('C', "0.70013"));
        for every in ["0.1 s", "0.7 s"] {
            holds(&on_curve(&formula, every), None, 0.70013, &format!("{formula} every {every}"));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_inner_zeros_are_reported(kind in 0..KINDS.len(), c in 0.1..1.0_f64, every in 0.011..0.9_f64, slope in -0.5..0.5_f64) {
        let (kind, reported) = KINDS[kind];
        let formula = format!("{slope} * t + 0.05 * ({})", kind.replace('U', "t").replace('C', &c.to_string()));
        holds(&slide(&formula, &format!("{every} s")), reported, c, &formula);
    }
}
