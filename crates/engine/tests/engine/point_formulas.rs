//! Formulas of points: what each of them is as numbers, which point a name means, where bodies are drawn, and what is set from outside.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, compile, run, text_of};
use mechc::{Choice, Memory, Parsed, RustOptions, Sources};
use mechc_expr::math;
use mechc_syntax as syntax;
use std::f64::consts::PI;

/// The values of measures at the start, beside declarations, with the ground's points in `ground` and a body `arm` that rests there.
fn values(declarations: &str, ground: &str, measures: &[&str]) -> Vec<f64> {
    let mut text = format!("mechanism m {{ {declarations} ground {{ {ground} point origin = (0, 0) }}\n");
    text += "body arm { point O = (0, 0) } joint main: revolute(ground.origin, arm.O) driver motor: rotation(main) = 0 * t\n";
    for (k, measure) in measures.iter().enumerate() {
        text += &format!("measure value_{k} = {measure}\n");
    }
    text += "analysis from 0 s to 1 s every 1 s }";
    let outcome = run("points", &text, Span::default()).expect_success();
    assert!(outcome.diagnostics.is_empty(), "{}", outcome.text());
    (0..measures.len()).map(|k| outcome.column(&format!("value_{k}"))[0]).collect()
}

/// The coordinates (mm) of a formula of points, in all the places where one may stand.
fn place_of(declarations: &str, formula: &str) -> [f64; 2] {
    let declared = format!("{declarations} param drawn = {formula}");
    let ground =
        format!("point P = {formula} axis along_x = {formula} along (1, 0) axis to_it = (1 km, 1 km) to {formula}");
    let places = ["drawn", "ground.P", &format!("({formula})"), &format!("0 * drawn + {formula}")];
    let mut measures = vec!["drawn.x".to_owned(), "drawn.y".to_owned()];
    measures.extend(places.iter().flat_map(|place| [format!("x({place})"), format!("y({place})")]));
    measures.push("distance(drawn, ground.P)".to_owned());
    let measures: Vec<&str> = measures.iter().map(String::as_str).collect();
    let found = values(&declared, &ground, &measures);
    for pair in found[..found.len() - 1].chunks(2) {
        assert!((pair[0] - found[0]).abs() < 1e-15 && (pair[1] - found[1]).abs() < 1e-15, "{formula}: {found:?}");
    }
    assert_eq!(found.last(), Some(&0.0), "{formula}");
    [found[0] * 1e3, found[1] * 1e3]
}

fn is_near(found: &[f64], wanted: &[f64], what: &str) {
    let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == wanted.len() && off < 1e-12, "{what}: {found:?}, not {wanted:?}");
}

const TWO_POINTS: &str = "param A = (20 mm, 10 mm) param B = (-40 mm, 90 mm) param k = 3 param r = 25 mm";

#[test]
fn point_operations_match_coordinates() {
    let cases: &[(&str, [f64; 2])] = &[
        ("A", [20.0, 10.0]),
        ("(A)", [20.0, 10.0]),
        ("-A", [-20.0, -10.0]),
        ("A + B", [-20.0, 100.0]),
        ("A - B + (1 mm, 2 mm)", [61.0, -78.0]),
        ("2 * A", [40.0, 20.0]),
        ("A * k / 2", [30.0, 15.0]),
        ("k * 2 / 3 * (A - B) / 4", [30.0, -40.0]),
        ("r / 5 mm * A", [100.0, 50.0]),
        ("mid(A, B)", [-10.0, 50.0]),
        ("mid(A, (0, 30 mm)) - A", [-10.0, 10.0]),
        ("polar(r, 90 deg)", [0.0, 25.0]),
        ("A + polar(r, direction(A, B))", [20.0 - 15.0, 10.0 + 20.0]),
        ("polar(length(A, B), 180 deg)", [-100.0, 0.0]),
        ("(A.x, B.y)", [20.0, 90.0]),
        ("(2 * A.y + r, -B.x)", [45.0, 40.0]),
        ("1.5 * -(A + (0, A.y))", [-30.0, -30.0]),
        ("if_then", [20.0, 25.0]),
    ];
    for &(formula, wanted) in cases {
        let declared = format!("{TWO_POINTS} param if_then = (if k > 2 then A.x else 0, r)");
        is_near(&place_of(&declared, formula), &wanted, formula);
    }
}

#[test]
fn length_and_direction_match_the_difference() {
    let found = values(
        TWO_POINTS,
        "",
        &[
            "length(A, B)",
            "length(A, A)",
            "length((0, 0), (3 mm, 4 mm))",
            "A.x + length(A, B) - 2 * r",
            "length(mid(A, B), B)",
        ],
    );
    is_near(&found, &[0.1, 0.0, 0.005, 0.07, 0.05], "lengths");
    let found = values(
        TWO_POINTS,
        "",
        &["direction(A, B)", "direction(B, A)", "direction((0, 0), (1 mm, 1 mm))", "direction(A, A + (0, -1 mm))"],
    );
    is_near(&found, &[math::atan2(0.8, -0.6), math::atan2(-0.8, 0.6), PI / 4.0, -PI / 2.0], "directions");
}

#[test]
fn a_direction_is_above_minus_pi() {
    let left = "param A = (10 mm, 0) param B = (-10 mm, -0) param C = (5 mm, -0)";
    let formulas =
        ["direction(A, -A)", "direction(A, B)", "direction(C, B)", "direction(A, -1 * A)", "direction(A, 0 * A)"];
    assert_eq!(values(left, "", &formulas), [PI; 5]);
    assert_eq!(values(left, "", &["direction(A, B - (0, 1e-30 m))"]), [-PI], "what lies below is below");
}

#[test]
fn plain_points_are_in_metres() {
    let found =
        values("param A = (0.5, 2) param k = 2 * A.x + 1", "point P = A / 2", &["k", "x(ground.P)", "A.x + 1 mm"]);
    is_near(&found, &[2.0, 0.25, 0.501], "plain");
}

#[test]
fn points_stand_in_functions_and_tables() {
    let declared =
        "param A = (20 mm, 10 mm) fn f(u) = u * A.x + length(A, (0, 10 mm)) table g = spline [(0, 0), (1, 1)]";
    let found = values(declared, "point A = (g(0.5) * 1 m, f(2))", &["f(3)", "x(ground.A)", "y(ground.A)"]);
    is_near(&found, &[0.08, 0.5, 0.06], "functions");
}

#[test]
fn points_of_the_body_shadow_those_of_the_mechanism() {
    let of = |features: &str, point: &str| -> [f64; 2] {
        let (x, y) = (format!("x(ground.{point})"), format!("y(ground.{point})"));
        let found = values(
            "param A = (20 mm, 10 mm) param r = 3 mm fn f(u) = u + A.x table g = spline [(0, 0), (1, 1)]",
            features,
            &[&x, &y],
        );
        [found[0] * 1e3, found[1] * 1e3]
    };
    // its own, and in its own formula the mechanism's
    is_near(&of("point A = A + (1 mm, 0) point P = A", "P"), &[21.0, 10.0], "the own point first");
    is_near(&of("point A = (A.x, A.x) point P = (A.x, A.y)", "P"), &[20.0, 20.0], "in coordinates too");
    is_near(&of("point A", "A"), &[20.0, 10.0], "alone");
    is_near(&of("point P = Q point Q = R / 2 point R = (2 mm, 4 mm)", "P"), &[1.0, 2.0], "in any order");
    // numbers, functions and tables keep their meaning
    is_near(&of("point r = (r, 0) point P = 2 * A / (r / 1 mm) point Q = (r, 2 * r)", "Q"), &[3.0, 6.0], "a number");
    is_near(&of("point r = (r, 0) point P = 2 * (A - r)", "P"), &[34.0, 20.0], "where only a point can stand");
    is_near(
        &of("point f = (1 mm, 0) point g = (2 mm, 0) point P = (f(1 mm), g(0.5) * 1 mm)", "P"),
        &[21.0, 0.5],
        "a call",
    );
    // a function knows nothing of the body in which it is called
    is_near(&of("point A = (7 mm, 0) point P = (f(1 mm), A.x)", "P"), &[21.0, 7.0], "a function");
    // units and constants too
    is_near(
        &of("point mm = (5 mm, 0) point m = mid(mm, mm) point P = m - (2 * mm, 0.001 * m)", "P"),
        &[3.0, -1.0],
        "a unit",
    );
}

#[test]
fn words_of_points_are_names_elsewhere() {
    // as texts were written before there were these words
    let declared = "param length = 50 mm param direction = 30 deg param mid = length / 2 param toward = 2";
    let found = values(
        declared,
        "point polar = (length, mid) point toward = (toward * mid, 0)",
        &["x(ground.polar)", "x(ground.toward)"],
    );
    is_near(&found, &[0.05, 0.05], "params and points");
    // a function of the file hides one of the language
    let hidden = "fn length(u) = 2 * u fn mid(u) = 3 * u table polar = spline [(0, 0), (1, 2)] fn direction(u) = -u";
    let measures = ["length(3)", "mid(2)", "polar(0.5)", "direction(4)", "x(ground.P)"];
    is_near(&values(hidden, "point P = (length(2), mid(1))", &measures), &[6.0, 6.0, 1.0, -4.0, 4.0], "functions");
    // and bodies have any name
    let text = "mechanism toward { ground { point at = (0, 0) } body toward at (0, 0, 0) { point toward = (0, 0) }
        body mid at toward.toward toward (1 m, 0) { point O = (0, 0) }
        joint polar: revolute(ground.at, toward.toward) joint length: revolute(toward.toward, mid.O)
        driver direction: rotation(polar) = t driver d: rotation(length) = t analysis from 0 to 1 every 1 }";
    run("names", text, Span::default()).expect_success();
}

#[test]
fn params_may_share_names_with_functions() {
    let declared = "param A = (30 mm, 40 mm) param length = length((0, 0), A) param twice = 2 * length";
    is_near(&values(declared, "", &["twice", "length"]), &[0.1, 0.05], "a param `length`");
}

// ---- where bodies are drawn

/// The start of the bodies of a mechanism whose poses are estimates of nothing: each body is held where it is drawn.
fn poses(text: &str) -> Vec<String> {
    let parsed = Parsed::new("poses", text);
    let checked = parsed.check(&Choice::default(), &Memory::default());
    let text = checked.model_text().unwrap_or_else(|| panic!("{:?}", checked.diagnostics()));
    text.lines().filter(|line| line.starts_with("body ")).map(str::to_owned).collect()
}

#[test]
fn a_body_is_drawn_at_a_point_with_an_angle_or_toward_another() {
    let found = poses(
        "mechanism m { ground { point G = (1 m, 2 m) }
            body a at ((3 m, 4 m), 30 deg) { point P = (1 m, 0) }
            body b at (a.P, 0) { point P = (0, 1 m) }
            body c at ground.G toward (1 m, 5 m) { point P = (2 m, 0) point Q = (2 m, 7 m) }
            body d at (c.P + mid((0, 0), (2 m, 2 m)), -10 deg) { point P = (0, 0) }
            body e at c.P toward c.Q { point P = (0, 0) }
            body f at (-2 * b.P, direction(a.P, b.P)) { point P = (0, 0) } }",
    );
    let wanted = [
        ("a", [3.0, 4.0, PI / 6.0]),
        ("b", [3.0 + 0.75_f64.sqrt(), 4.5, 0.0]),
        ("c", [1.0, 2.0, PI / 2.0]),
        ("d", [2.0, 5.0, -PI / 18.0]),
        ("e", [1.0, 4.0, PI]),
        ("f", [-2.0 * (3.0 + 0.75_f64.sqrt()), -11.0, PI / 2.0]),
    ];
    for (line, (name, pose)) in found.iter().zip(wanted) {
        let numbers = line.strip_prefix(&format!("body {name} at (")).expect("in the order of the text");
        let numbers: Vec<f64> =
            numbers.trim_end_matches(')').split(", ").map(|n| n.parse().expect("a number")).collect();
        is_near(&numbers, &pose, name);
    }
    assert_eq!(found.len(), wanted.len());
}

#[test]
fn poses_may_depend_on_later_ones() {
    let found = poses(
        "mechanism m { body a at (b.P, 1) { point P = (0, 0) } body b at (c.P, 0) { point P = (1, 0) }
            body c at (5, 6, 0) { point P = (1, 1) } }",
    );
    assert_eq!(found, ["body a at (7, 7, 1)", "body b at (6, 7, 0)", "body c at (5, 6, 0)"]);
}

/// A four-bar as it is drawn, and the same with its numbers written out.
#[test]
fn drawn_four_bar_matches_its_numbers() {
    const REST: &str = "joint main: revolute(ground.A, crank.A) joint pin: revolute(crank.B, coupler.B)
        joint knee: revolute(coupler.C, rocker.C) joint pivot: revolute(ground.D, rocker.D)
        driver motor: rotation(main) = 1 rev/s * t measure px = x(coupler.P) measure py = y(coupler.P)
        analysis from 0 s to 1 s every 10 ms }";
    let drawn = format!(
        "mechanism m {{
            param A = (0, 0)           param D = (80 mm, 0)
            param B = (10 mm, 30 mm)   param C = (70 mm, 60 mm)
            ground       {{ point A = A   point D = D }}
            body crank   {{ point A = A   point B = B }}
            body coupler {{ point B = B   point C = C   point P = mid(B, C) + polar(20 mm, 90 deg + direction(B, C)) }}
            body rocker  {{ point C = C   point D }} {REST}"
    );
    let (x, y) = (40.0 - 20.0 / 5.0_f64.sqrt(), 45.0 + 40.0 / 5.0_f64.sqrt());
    let written = format!(
        "mechanism m {{
            ground       {{ point A = (0, 0)   point D = (80 mm, 0) }}
            body crank   {{ point A = (0, 0)   point B = (10 mm, 30 mm) }}
            body coupler {{ point B = (10 mm, 30 mm)   point C = (70 mm, 60 mm)   point P = ({x} mm, {y} mm) }}
            body rocker  {{ point C = (70 mm, 60 mm)   point D = (80 mm, 0) }} {REST}"
    );
    same_rows(&run("drawn", &drawn, Span::default()), &run("written", &written, Span::default()), 1e-12);
}

#[test]
fn placed_bodies_move_as_drawn_ones() {
    let text = text_of("tests/cases/drawn_four_bar.mech");
    let numbers = [
        ("at A toward B", "at (20 mm, 10 mm, atan2(30, 10))"),
        ("length(A, B)", "hypot(10 mm, 30 mm)"),
        ("direction(A, B)", "atan2(30, 10)"),
        ("mid(A, D)", "(60 mm, 10 mm)"),
        ("D + 1.5 * (C - D) - (0, D.y / 2)", "(85 mm, 95 mm)"),
    ];
    let mut written = text.clone();
    for (formula, numbers) in numbers {
        assert!(written.contains(formula), "{formula}");
        written = written.replace(formula, numbers);
    }
    same_rows(&run("drawn", &text, Span::default()), &run("written", &written, Span::default()), 1e-12);
}

fn same_rows(one: &Outcome, other: &Outcome, tolerance: f64) {
    assert!(one.succeeded() && other.succeeded(), "{}{}", one.text(), other.text());
    assert_eq!(one.columns, other.columns);
    assert!(!one.rows.is_empty() && one.rows.len() == other.rows.len());
    for (k, column) in one.columns.iter().enumerate() {
        let size = one.rows.iter().map(|row| row[k].abs()).fold(1.0, f64::max);
        for (a, b) in one.rows.iter().zip(&other.rows) {
            assert!((a[k] - b[k]).abs() <= tolerance * size, "{column} at {}: {} and {}", a[0], a[k], b[k]);
        }
    }
}

#[test]
fn curves_circles_and_joints_take_points() {
    let drawn = "mechanism m { param O = (0, 0) param C = (10 mm, 5 mm) param F = (0, 60 mm)
        ground { point O point u = (7 mm, 3 mm) axis way = O along (0, 1) axis up = O to F }
        body cam { point O = O point u = C curve rim(u) = u + polar(30 mm, u) + u * (0, 0) circle disc = mid(O, C) radius length(O, C) }
        body follower at (F, 0) { point tip = (0, 0) axis way = tip along (0, 1) }
        joint main: revolute(O, cam.O) joint guide: translational(ground.up, follower.way)
        joint touch: point_follower(follower.tip, cam.rim)
        driver motor: rotation(main) = 1 rev/s * t measure gap = distance(mid(F, C), follower.tip)
        analysis from 0 s to 0.5 s every 0.1 s }";
    let written = "mechanism m {
        ground { point O = (0, 0) axis way = (0, 0) along (0, 1) axis up = (0, 0) to (0, 60 mm) }
        body cam { point O = (0, 0) curve rim(u) = (10 mm + 30 mm * cos(u), 5 mm + 30 mm * sin(u)) circle disc = (5 mm, 2.5 mm) radius 1 mm }
        body follower at (0, 60 mm, 0) { point tip = (0, 0) axis way = tip along (0, 1) }
        joint main: revolute((0, 0), cam.O) joint guide: translational(ground.up, follower.way)
        joint touch: point_follower(follower.tip, cam.rim)
        driver motor: rotation(main) = 1 rev/s * t measure gap = distance((5 mm, 32.5 mm), follower.tip)
        analysis from 0 s to 0.5 s every 0.1 s }";
    same_rows(&run("drawn", drawn, Span::default()), &run("written", written, Span::default()), 1e-12);
}

// ---- from outside, and to emitted code

/// The first value of a measure, or what is said.
fn with_settings(text: &str, set: &[&str]) -> Result<f64, String> {
    let choice = Choice { set: set.iter().map(|&set| set.to_owned()).collect(), ..Choice::default() };
    let checked = Parsed::new("set.mech", text).check(&choice, &Memory::default());
    let messages = |diagnostics: &mechc::Diagnostics| {
        let texts = diagnostics.iter().map(|d| format!("{}: {}", d.code, d.message));
        texts.collect::<Vec<_>>().join("; ")
    };
    let model = checked.model_text().ok_or_else(|| messages(checked.diagnostics()))?;
    let value = |name: &str| {
        let line = model.lines().find_map(|line| line.trim().strip_prefix(&format!("{name} = ")));
        line.map(|line| line.split(' ').next().expect("a number").parse::<f64>().expect("a number"))
    };
    Ok(value("A.x").expect("A.x") * 1e6 + value("A.y").expect("A.y") * 1e3)
}

#[test]
fn points_are_set_whole_or_by_coordinate() {
    let text = "mechanism m { param A = (10 mm, 2 mm) param p = (1 m, 2 m) param r = 3 mm body b { point P = A point Q = p } driver d: x(b.P) = t }";
    // x in micrometres and thousands, y in millimetres: 10 mm and 2 mm are 10002
    let cases: &[(&[&str], f64)] = &[
        (&[], 10_002.0),
        (&["A=(12mm,0)"], 12_000.0),
        (&["A.x=12mm"], 12_002.0),
        (&["A.y = 5mm", "A.x=1cm"], 10_005.0),
        (&["A=(12mm,7mm)", "A.x=3mm"], 3_007.0),
        (&["A.x=3mm", "A=(12mm,7mm)"], 12_007.0),
        (&["A=polar(4mm, 90deg) + (1mm, 0)"], 1_004.0),
        (&["A=-2 * (1mm, 3mm)"], -2_006.0),
        (&["A.y=0", "p.x=2mm"], 10_000.0),
    ];
    for &(set, wanted) in cases {
        let found = with_settings(text, set).unwrap_or_else(|why| panic!("{set:?}: {why}"));
        assert!((found - wanted).abs() < 1e-9, "{set:?}: {found}");
    }
    let messages: &[(&str, &str)] = &[
        ("A=5mm", "E0302: expected a point, found a number"),
        ("A.x=5", "E0402: the coordinate `A.x` must be a length, found a pure number"),
        ("A.x=5s", "E0402: the coordinate `A.x` must be a length, found a time"),
        ("A=(5,0)", "E0402: a coordinate must be a length, found a pure number"),
        ("A=(p.x,0)", "E0706: a value from outside the file cannot name `p`"),
        ("A=p", "E0706: a value from outside the file cannot name `p`"),
        ("A.x=(1mm,0)", "E0302: expected a number, found a point"),
        ("A.z=5mm", "E0703: mechanism `m` has no parameter `A.z`"),
        ("B.x=5mm", "E0703: mechanism `m` has no parameter `B.x`"),
        ("r.x=5mm", "E0703: the parameter `r` is a number, and has no `x`"),
        ("r=(5mm,0)", "E0302: expected a number, found a point"),
    ];
    for &(set, wanted) in messages {
        assert_eq!(with_settings(text, &[set]), Err(wanted.to_owned()), "{set}");
    }
}

#[test]
fn coordinates_are_parameters_of_emitted_code() {
    let text = "mechanism m { param A = (10 mm, 20 mm) param B = A + (0, 5 mm) param C = (A.x, 3 mm) param a_x = 2 mm
        ground { point A point B point C } body b { point O = (a_x, 0) }
        joint j: revolute(ground.B, b.O) driver d: rotation(j) = t measure across = x(ground.C) }";
    let (compiled, outcome) = compile("emitted", text);
    let compiled = compiled.unwrap_or_else(|| panic!("{}", outcome.text()));
    let rust = compiled.rust(&RustOptions::new("a.mech")).0.expect("it starts");
    let fields: Vec<&str> = rust.lines().filter_map(|line| line.trim().strip_prefix("pub ")).collect();
    let fields: Vec<&str> = fields.iter().filter_map(|field| field.strip_suffix(": f64,")).collect();
    assert_eq!(fields[..4], ["a_x_2", "a_y", "c_y", "a_x"], "{rust}");
    assert!(compiled.latex("a.mech").contains("A_{x}"));
    assert!(compiled.json("a.mech").contains("\"A.x\""));
}

#[test]
fn formatting_keeps_points() {
    let text = "mechanism m {
    param A = (20 mm, 10 mm)
    param B = A + polar(3 mm, 90 deg)

    ground {
        point  A
        point  base = mid(A, B) - (A.x, 2 * B.y)
        axis   way  = A + (1 mm, 0) to -B
        circle rim  = (A + B) / 2 radius length(A, B)
        curve  k(u) = A + polar(1 mm, u) at 1
    }
    body crank at A toward B - (1 mm, 0) {
        point A = (0, 0)
    }
    body rod at (crank.A, 30 deg) {
        point A
    }
}
";
    let mut sources = Sources::default();
    let file = sources.add("a.mech", text);
    let parsed = syntax::parse(&sources, file);
    assert!(parsed.faults.is_empty(), "{:?}", parsed.faults);
    assert_eq!(syntax::format(&parsed.tree), text);
}
