//! No input makes it panic, overflow the stack or hang: it answers with a result or a diagnostic.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::random::Random;
use crate::support::{Outcome, Span, compiled, run};
use mechc::{Choice, Memory, Parsed};
use std::fmt::Write;

/// A pendulum whose driver is a formula, with more declarations before it.
fn pendulum(declarations: &str, formula: &str) -> String {
    format!(
        "mechanism pendulum {{
            {declarations}
            ground {{ point O = (0, 0) }}
            body bar {{ point O = (0, 0) point tip = (1, 0) }}
            joint main: revolute(ground.O, bar.O)
            driver motor: rotation(main) = {formula}
            analysis from 0 to 0.2 every 0.1
        }}"
    )
}

fn check(declarations: &str, formula: &str) -> Outcome {
    run("pendulum", &pendulum(declarations, formula), Span::default())
}

#[test]
fn nesting_is_capped_before_anything_recurses() {
    let n = 100_000;
    for formula in [
        format!("{}t{}", "(".repeat(n), ")".repeat(n)),
        "(".repeat(n),
        format!("{}t", "-".repeat(n)),
        format!("t{}", "^t".repeat(n)),
        format!("{}t", "if t < 1 then ".repeat(n)),
        format!("if {} t < 1 then t else t", "not ".repeat(n)),
        format!("{}t{}", "sin(".repeat(n), ")".repeat(n)),
    ] {
        assert_eq!(check("", &formula).codes(), ["E0103"], "{}", &formula[..40]);
    }
    let deep = 190;
    check("", &format!("{}t{}", "(".repeat(deep), ")".repeat(deep))).expect_success();
    check("", &format!("{}t", "-".repeat(deep))).expect_success();
    check("", &format!("0.1{}", "^1".repeat(deep))).expect_success();
}

#[test]
fn broken_chains_of_conditions_are_refused_at_once() {
    let broken = format!("{}@", "if t then t else if t then ".repeat(90));
    assert_eq!(check("", &broken).codes(), ["E0101"]);
}

#[test]
fn long_flat_texts_take_linear_time() {
    let n = 50_000;
    check("", &format!("t{}", " + 1e-6".repeat(n))).expect_success();
    check("", &format!("t{}", " * 1".repeat(n))).expect_success();
    let chain: String = (0..n).fold(String::new(), |mut chain, k| {
        write!(chain, "if t > {} then t else ", n - k).expect("a string takes everything");
        chain
    });
    check("", &(chain + "t")).expect_success();
    let params: String = (1..n).fold("param p0 = 1e-9\n".to_owned(), |mut params, k| {
        writeln!(params, "param p{k} = p{} + 1e-9", k - 1).expect("a string takes everything");
        params
    });
    check(&params, &format!("p{} * t", n - 1)).expect_success();
}

#[test]
fn functions_that_share_stay_linear() {
    let n = 5_000;
    let chain = |body: &str| -> String {
        (1..n).fold("fn f0(u) = u / 2\n".to_owned(), |mut functions, k| {
            let body = body.replace("BEFORE", &format!("f{}", k - 1));
            writeln!(functions, "fn f{k}(u) = {body}").expect("a string takes everything");
            functions
        })
    };
    // written out, the last one would have 2^5000 parts
    check(&chain("(BEFORE(u) + BEFORE(u)) / 2"), &format!("f{}(t)", n - 1)).expect_success();
    let unshared = check(&chain("BEFORE(u + 1) + BEFORE(2 * u)"), &format!("f{}(t)", n - 1));
    assert_eq!(unshared.codes().last(), Some(&"E0410"), "{}", unshared.text());
}

#[test]
fn random_text_is_answered() {
    let mut numbers = Random::new(12345);
    let mut random = || numbers.below(usize::MAX);
    let words = [
        "mechanism",
        "m",
        "{",
        "}",
        "(",
        ")",
        ",",
        "=",
        "param",
        "body",
        "b",
        "at",
        "point",
        "P",
        "joint",
        "j",
        ":",
        "revolute",
        "ground",
        ".",
        "driver",
        "rotation",
        "t",
        "1",
        "2.5",
        "mm",
        "s",
        "+",
        "-",
        "*",
        "/",
        "^",
        "if",
        "then",
        "else",
        "and",
        "not",
        "<",
        "//",
        "\n",
        "measure",
        "der",
        "x",
        "analysis",
        "from",
        "to",
        "every",
        "\"",
        "µm",
        "é",
        "axis",
        "along",
        "curve",
        "table",
        "[",
        "]",
        "spline",
        "fn",
        "f",
        "sin",
        "distance",
        "constraint",
        "0",
    ];
    for _ in 0..300 {
        let length = 1 + random() % 60;
        let text: String = (0..length).map(|_| words[random() % words.len()].to_owned() + " ").collect();
        for text in [text.clone(), format!("mechanism m {{ {text} }}"), check_body(&text)] {
            let _ = run("random", &text, Span::default()).text();
        }
    }
    let ascii: String = (0..1_000_000).map(|_| char::from(32 + (random() % 95) as u8)).collect();
    assert!(!run("ascii", &ascii, Span::default()).text().is_empty());
}

fn check_body(formula: &str) -> String {
    pendulum("", formula)
}

#[test]
fn ten_thousand_bodies_are_proven_in_no_time() {
    let n = 10_000;
    let mut text = "mechanism many { ground { point O = (0, 0) }\n".to_owned();
    for k in 0..n {
        writeln!(
            text,
            "body b{k} {{ point O = (0, 0) point P = (0.1, 0) }} joint j{k}: revolute({}, b{k}.O) driver d{k}: angle(b{k}) = t + {k}",
            if k == 0 { "ground.O".to_owned() } else { format!("b{}.P", k - 1) }
        )
        .expect("a string takes everything");
    }
    text += "}";
    let (determined, _) = compiled("many", &text).inside();
    assert_eq!(determined.blocks().len(), 3 * n, "every coordinate can be solved for on its own");
}

#[test]
fn many_distant_four_bars_are_as_accurate_as_one() {
    let text = |n: usize| -> String {
        let mut text = "mechanism fleet {\n".to_owned();
        for k in 0..n {
            let y = 10 * k;
            writeln!(
                text,
                "body crank{k} at (0, {y}, 0.5) {{ point A = (0, 0) point C = (1, 0) }}
                body coupler{k} at (0.88, {y}.48, 0.78) {{ point C = (0, 0) point D = (3.5, 0) }}
                body rocker{k} at (3.7, {}.5, 1.8) {{ point B = (-1.5, 0) point D = (1.5, 0) }}
                joint main{k}: revolute((0, {y}), crank{k}.A)
                joint pin{k}: revolute(crank{k}.C, coupler{k}.C)
                joint knee{k}: revolute(coupler{k}.D, rocker{k}.D)
                joint pivot{k}: revolute((4, {y}), rocker{k}.B)
                driver motor{k}: rotation(main{k}) = 0.5 + 2 * t",
                y + 1
            )
            .expect("a string takes everything");
        }
        text + "analysis from 0 s to 0.2 s every 0.1 s }"
    };
    let one = run("one", &text(1), Span::default()).expect_success();
    let many = run("many", &text(300), Span::default()).expect_success();
    for (a, b) in one.column("rocker0.phi").iter().zip(many.column("rocker299.phi")) {
        assert!((a - b).abs() < 1e-9, "{a} and {b}");
    }
}

#[test]
fn many_mistakes_are_reported_quickly() {
    let params: String = (0..3_000).fold(String::new(), |mut params, k| {
        writeln!(params, "param p{k} = q{k}").expect("a string takes everything");
        params
    });
    let outcome = check(&params, "t");
    assert_eq!(outcome.codes().len(), 3_000);
    assert!(outcome.text().contains("was `p0` meant?"));
    let features: String = (0..3_000).fold(String::new(), |mut features, k| {
        writeln!(features, "point P{k} = (0, 0)").expect("a string takes everything");
        features
    });
    let constraints: String = (0..3_000).fold(String::new(), |mut constraints, k| {
        writeln!(constraints, "constraint c{k}: x(b.Q{k}) = 0").expect("a string takes everything");
        constraints
    });
    let outcome =
        run("flood", &format!("mechanism flood {{ body b {{ {features} }} {constraints} }}"), Span::default());
    assert_eq!(outcome.codes().len(), 3_000);
}

#[test]
fn a_chain_of_functions_with_other_arguments_stays_linear() {
    let chain: String = (1..3_000).fold("fn f0(u) = u\n".to_owned(), |mut functions, k| {
        writeln!(functions, "fn f{k}(u) = f{}(u + 1e-9)", k - 1).expect("a string takes everything");
        functions
    });
    check(&chain, "f2999(t)").expect_success();
}

#[test]
fn printing_stays_linear_where_parts_are_shared() {
    let chain: String = (1..40).fold("param p0 = 1\n".to_owned(), |mut params, k| {
        writeln!(params, "param p{k} = sin(p{0}) * p{0} + p{0} / 2", k - 1).expect("a string takes everything");
        params
    });
    let text = pendulum(&chain, "p39 * t").replace("body bar {", "body bar at (p39, 0, 0) {");
    let checked = Parsed::new("chain", &text).check(&Choice::default(), &Memory::default());
    assert!(checked.model_text().expect("sound").len() < 20_000);
    assert!(checked.equations_text().expect("sound").len() < 20_000);
}

#[test]
fn large_rings_are_solved() {
    let n = 4_001;
    let ring: String = (0..n).fold(String::new(), |mut text, k| {
        let next = (k + 1) % n;
        writeln!(text, "body b{k} {{ point O = (0, 0) }} constraint y{k}: y(b{k}.O) = 0").expect("text");
        writeln!(text, "constraint p{k}: angle(b{k}) = 0").expect("text");
        writeln!(text, "driver x{k}: x(b{k}.O) + 0.5 * x(b{next}.O) = t").expect("text");
        text
    });
    let outcome =
        run("ring", &format!("mechanism ring {{ {ring} analysis from 0 s to 1 s every 0.5 s }}"), Span::default());
    let rows = outcome.expect_success();
    for (t, x) in rows.column("t").into_iter().zip(rows.column("b2000.x")) {
        assert!((x - t / 1.5).abs() < 1e-12, "{x} at t = {t}");
    }
}

#[test]
fn tables_of_many_rows_and_edges_by_the_thousand() {
    let rows: String = (0..2_000).fold(String::new(), |mut rows, k| {
        write!(rows, "({k}, {}), ", k * 7 % 13).expect("text");
        rows
    });
    let table = format!("table lift = spline [{rows}]");
    check(&table, "lift(1000 * t)").expect_success();
    check("fn saw(u) = if u - u < 0 then 1 else mod(u, 1)^2 * (1 - mod(u, 1))^2", "saw(3000 * t)").expect_success();
    // a switch that stands on its edge all the time
    check("fn still(u) = if sin(u)^2 + cos(u)^2 < 1 then 0 else 0 * u", "still(t) + t").expect_success();
}

#[test]
fn a_search_for_a_contact_ends() {
    // the further from the turn, the nearer the curve comes to the point
    let text = "mechanism far {
        ground { curve k(u) = (10 mm, 10 mm / (1 + u^2)) }
        body b { point P = (0, 0) point Q = (10 mm, 0) }
        joint c: point_follower(b.Q, ground.k)
        driver d: angle(b) = 0.1 + t
        driver f: y(b.P) = 1 mm
        analysis from 0 s to 0.1 s every 0.1 s
    }";
    let outcome = run("far", text, Span::default());
    assert!(outcome.codes().iter().all(|code| code.starts_with('E')), "{}", outcome.text());
}

#[test]
fn start_time_does_not_depend_on_the_span() {
    // the motion from 1 s to 2 s lies within the first billionth of the analysis
    let text = pendulum("", "step5(t, 1, 0, 2, 1)").replace("to 0.2 every 0.1", "to 1e10 every 1e9");
    let outcome = run("ages", &text, Span::default());
    assert_eq!(outcome.column("bar.phi").first(), Some(&0.0), "{}", outcome.text());
}

#[test]
fn a_contact_that_rests_on_an_edge_does_not_stop_a_fast_motion() {
    let text = "mechanism fast {
        ground { circle fixed = (4.666946257106101, -0.5107073581072674) radius 3.109375 }
        body still at (-0.73, 0, -2.4) {
            point hub = (-2.3898222906255238, 1.89552179925518)
            curve face(u) = (
                -0.48145727850169595 + (-0.04088903192938645 * u + 1.47 * (if u < 0 then u^2 / 2 else u^2)),
                3.961508060221506 - 1.2024299782909929 * u
            ) at 0.25
        }
        body plate at (2.3, 2.6, -1.65) {
            point tip = (4.3, -2.767)
            point pin = (1.9, -0.6)
            circle rim = (1.5, -3.6) radius 3.641
        }
        body roller at (0.3, 2.6, 1.1) {
            point pin = (-1.1, -2)
            circle rim = (-8.2, -3.6) radius 4.1
        }
        joint hinge: revolute((2.3125, 0.2708333333333333), still.hub)
        joint rest: cam(ground.fixed, still.face)
        joint swing: revolute(plate.pin, roller.pin)
        joint touch: cam(plate.rim, roller.rim)
        driver right: x(plate.tip) = -0.75 - 0.5 * cycloidal(t, 2.2, 0, 3.9, 1)
        driver up: y(plate.tip) = -1.5
        driver turn: angle(plate) = -1.65 + 3.9 * ((7 * t)^2 + 2.3 * sin(7 * t))
        analysis from 0 to 2.234 every 0.279
    }";
    // `still` touches at `u = 0` throughout, so that rounding decides which of its branches holds
    run("fast", text, Span { to: None, every: None }).expect_success();
}

#[test]
fn rests_on_edges_cost_little_time() {
    let text = "
        mechanism made {
        ground {
        point point2 = (2.4791666666666665, -1.0208333333333333)
        curve curve6(u) = (-2.3125 + (-2.352721369948153 * u - 1.5637136260590934 * (if u < 0 then u^2 / 2 else u^2)), -2.1666666666666665 + (1.8360817781390586 * u + -2.0037138368842906 * (if u < 0 then u^2 / 2 else u^2))) at 0
        point point16 = (-2.6458333333333335, -2.6458333333333335)
        point point17 = (-2.6458333333333335, -2.6458333333333335)
        point point18 = (-2.6458333333333335, -2.6458333333333335)
        point point19 = (-2.6458333333333335, -2.6458333333333335)
        point point20 = (-2.6458333333333335, -2.6458333333333335)
        }
        body b1 at (-2.3958333333333335, 2.0833333333333335, 1.4375) {
        point point3 = (-2.4287332177114456, -5.244304591805233)
        point point5 = (-4.201223899515751, -0.6474273631706541)
        point point9 = (-6.892467010188676, -5.39852080918557)
        axis spline13 = (-3.364158839304768, -4.381806755530929) along (-0.276892338016583, 0.9609009486662557)
        point point15 = (-4.720440618332038, -0.3807331479030456)
        }
        body b8 at (-0.5416666666666666, -1.3541666666666667, 1.9791666666666667) {
        point point10 = (-4.797954175078146, -0.7355954767837682)
        circle circle12 = (-4.797954175078146, -0.7355954767837682) radius 3.671875
        }
        joint _4: revolute(ground.point2, b1.point3)
        joint at7: point_follower(b1.point5, ground.curve6)
        joint j11: revolute(b1.point9, b8.point10)
        joint _14: rack_pinion(b8.circle12, b1.spline13, 0, left)
        measure m0 = der(y(b1.point15))
        measure m1 = der(y(ground.point17))
        measure m2 = der(y(ground.point19))
        analysis from 0 to 0.125 every 0.015625
        }
    ";
    let rows = run("rest", text, Span::default()).expect_success().rows;
    assert_eq!(rows.len(), 9);
    assert!(rows.iter().all(|row| (1..9).all(|k| (row[k] - rows[0][k]).abs() < 1e-12)), "{rows:?}");
}

#[test]
fn faults_at_missing_braces_stay_in_the_text() {
    for end in ["", "\n", "    "] {
        let text = format!(
            "mechanism press param stroke = 3 mm table lift = spline \"a\" body ram {{ point O = (0, 0) x{end}"
        );
        let outcome = run("press", &text, Span::default());
        assert!(!outcome.diagnostics.is_empty());
        for label in outcome.diagnostics.iter().flat_map(|diagnostic| &diagnostic.labels) {
            assert!(label.span.start <= label.span.end && label.span.end as usize <= text.len(), "{}", outcome.text());
        }
    }
}
