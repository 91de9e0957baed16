//! What is printed in another unit than SI, and the paths of points.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::support::{Span, compiled, run};
use mechc_expr::math::sin_cos;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::process::Command;

/// An arm of 50 mm that turns once a second, with what is measured beside it.
fn arm(declarations: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) point tip = (50 mm, 0) }}
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = 60 rpm * t
    {declarations}
    analysis from 0 s to 1 s every 0.125 s
}}"
    )
}

/// The table that the command line prints of a text, as JSON.
fn printed(text: &str) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.mech"), text).expect("it is written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    let output = command.current_dir(&folder).args(["run", "m.mech", "--format", "json"]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("it is JSON")
}

/// The unit and the numbers of a column.
fn column(table: &serde_json::Value, name: &str) -> (String, Vec<f64>) {
    let at = table["columns"].as_array().unwrap().iter().position(|column| column == name).expect(name);
    let rows = table["rows"].as_array().unwrap();
    let values = rows.iter().map(|row| row[at].as_f64().unwrap()).collect();
    (table["units"][at].as_str().unwrap().to_owned(), values)
}

fn assert_close(found: &[f64], wanted: &[f64], what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}");
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() <= 1e-12 * wanted.abs().max(1.0), "{what}: {found}, not {wanted}");
    }
}

#[test]
fn measures_are_printed_in_their_unit() {
    let table = printed(
        &arm("measure si = y(arm.tip)
    measure mm = y(arm.tip) in mm
    measure of_mm = 2 * mm_too
    measure mm_too = y(arm.tip) in mm
    measure turned = rotation(main) in deg
    measure speed = der(rotation(main)) in rpm
    measure square = si^2 in cm^2
    measure bend = 1 / (si + 1 m) in 1/mm
    measure pull = der(der(si)) in mm/s^2")
        .replace("measure mm =", "measure milli ="),
    );
    let si = ["si", "si.d", "si.dd"].map(|name| column(&table, name));
    for (name, unit, (_, si)) in [
        ("milli", "mm", &si[0]),
        ("milli.d", "mm/s", &si[1]),
        ("milli.dd", "mm/s^2", &si[2]),
        ("pull", "mm/s^2", &si[2]),
    ] {
        let (found, values) = column(&table, name);
        assert_eq!(found, unit, "{name}");
        assert_close(&values, &si.iter().map(|value| value * 1e3).collect::<Vec<_>>(), name);
    }
    // who uses a measure sees SI
    let (unit, twice) = column(&table, "of_mm");
    assert_eq!(unit, "m");
    assert_close(&twice, &si[0].1.iter().map(|value| 2.0 * value).collect::<Vec<_>>(), "of_mm");
    let (unit, turned) = column(&table, "turned");
    assert_eq!((unit.as_str(), turned.len()), ("deg", 9));
    assert_close(&turned, &(0..9).map(|k| 45.0 * f64::from(k)).collect::<Vec<_>>(), "turned");
    assert_eq!(column(&table, "turned.d").0, "deg/s");
    let (unit, speed) = column(&table, "speed");
    assert_eq!(unit, "rpm");
    assert_close(&speed, &[60.0; 9], "speed");
    assert_close(&column(&table, "square").1, &si[0].1.iter().map(|y| y * y * 1e4).collect::<Vec<_>>(), "square");
    let (unit, bend) = column(&table, "bend");
    assert_eq!(unit, "1/mm");
    assert_close(&bend, &si[0].1.iter().map(|y| 1e-3 / (y + 1.0)).collect::<Vec<_>>(), "bend");
}

#[test]
fn columns_have_units() {
    let table = printed(&arm("measure ratio = sin(rotation(main)) trace path = arm.tip in mm"));
    let all: Vec<String> =
        table["units"].as_array().unwrap().iter().map(|unit| unit.as_str().unwrap().to_owned()).collect();
    let wanted = "s m m rad 1 mm mm m/s m/s rad/s 1/s mm/s mm/s m/s^2 m/s^2 rad/s^2 1/s^2 mm/s^2 mm/s^2";
    assert_eq!(all.join(" "), wanted);
    assert_eq!(table["columns"].as_array().unwrap().len(), all.len());
}

#[test]
fn a_trace_stands_among_the_measures_in_order() {
    let text =
        arm("measure a = t trace path = arm.tip measure b = 2 * t trace half = (x(arm.tip) / 2, y(arm.tip) / 2)");
    let outcome = run("m", &text, Span::default()).expect_success();
    let names: Vec<&str> = outcome.columns[4..10].iter().map(String::as_str).collect();
    assert_eq!(names, ["a", "path.x", "path.y", "b", "half.x", "half.y"]);
    for (k, t) in outcome.column("t").into_iter().enumerate() {
        let (sin, cos) = sin_cos(TAU * t);
        for (name, wanted) in [
            ("path.x", 0.05 * cos),
            ("path.y", 0.05 * sin),
            ("half.y", 0.025 * sin),
            ("path.x.d", -0.05 * TAU * sin),
            ("path.y.dd", -0.05 * TAU * TAU * sin),
        ] {
            assert!((outcome.column(name)[k] - wanted).abs() < 1e-12, "{name} at {t}");
        }
    }
}

/// Texts in which the new words are names.
#[test]
fn words_that_open_declarations_are_names_elsewhere() {
    let text = "mechanism trace {
    param trace = 50 mm
    param columns = 2
    fn opened(u) = u * trace
    ground { point trace = (0, 0) }
    body columns_of { point trace = (0, 0) point columns = (trace, 0) axis in = trace along (1, 0) }
    joint main: revolute(ground.trace, columns_of.trace)
    driver motor: rotation(main) = columns * 30 rpm * t
    measure of_trace = x(columns_of.columns) / trace
    measure next = trace
    trace path = columns_of.columns
    measure again = columns
    analysis from 0 s to 1 s every 0.5 s
}";
    let outcome = run("m", text, Span::default()).expect_success();
    assert_close(&outcome.column("of_trace"), &[1.0, -1.0, 1.0], "of_trace");
    assert_close(&outcome.column("path.x"), &[0.05, -0.05, 0.05], "path.x");
    assert_close(&outcome.column("again"), &[2.0; 3], "again");
}

#[test]
fn emitted_code_documents_si_units() {
    let compiled = compiled("m", &arm("measure high = y(arm.tip) in mm measure path_x = t trace path = arm.tip"));
    let (code, _) = compiled.rust(&mechc::RustOptions::new("m.mech"));
    let code = code.expect("it assembles");
    assert!(code.contains("/// `high`, in m; tables have it in mm, line 6\n    pub const HIGH: usize = 0;"), "{code}");
    assert!(code.contains("all in SI."));
    // the name that is no path stays
    assert!(code.contains("/// `path_x`, line 6\n    pub const PATH_X: usize = 1;"));
    assert!(code.contains("/// `path.x`, line 6\n    pub const PATH_X_2: usize = 2;"));
    assert!(code.contains("pub const PATH_Y: usize = 3;"));
}

#[test]
fn columns_of_a_wider_file_are_picked() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = "note,\"angle, told\",time\nstart,0,0\n,90,1\n\"a, b\",180,2\n";
    fs::write(folder.path().join("log.csv"), file).expect("it is written");
    let text = "mechanism m {
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) }
    joint main: revolute(ground.O, arm.O)
    table by_number = spline \"log.csv\" columns 3, 2 (s, deg)
    table by_name = spline \"log.csv\" columns \"time\", \"angle, told\" (s, deg)
    table rates = spline \"log.csv\" columns 3, 2 (s, deg/s)
    driver motor: rotation(main) = by_number(t)
    measure same = by_name(t) - by_number(t)
    measure rate = rates(t)
    analysis from 0 s to 2 s every 0.5 s
}";
    let outcome = support::run_in(folder.path(), "m.mech", text, Span::default()).expect_success();
    assert_close(&outcome.column("arm.phi"), &[0.0, PI / 4.0, PI / 2.0, 0.75 * PI, PI], "arm.phi");
    assert_close(&outcome.column("same"), &[0.0; 5], "same");
    assert_close(&outcome.column("rate"), &outcome.column("arm.phi"), "rate");
}
