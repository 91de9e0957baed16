//! Tables of `mechc tolerance` against samples of variants.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking
#![allow(clippy::disallowed_methods)] // what is wanted need not have the same bits everywhere

use crate::support::random::Random;
use crate::support::sweeps::ROCKER;
use assert_cmd::Command;
use std::f64::consts::TAU;

fn mechc(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_mechc")).args(arguments).output().expect("it runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// Of the height of the rocker's pen (m) at a time, over all variants: how many, their mean, their standard deviation, the least and the largest.
fn spread(file: &str, at: &str, vary: &[&str]) -> (usize, f64, f64, [f64; 2]) {
    let rows = mechc(&[&["sweep", file, "--rows", "--columns", "height", "--at", at], vary].concat());
    // it is printed in millimetres
    let height = |row: &str| 1e-3 * row.rsplit(',').next().expect("a cell").parse::<f64>().expect("a number");
    let heights: Vec<f64> = rows.lines().skip(1).map(height).collect();
    let count = heights.len() as f64;
    let mean = heights.iter().sum::<f64>() / count;
    let square = heights.iter().map(|height| (height - mean).powi(2)).sum::<f64>() / count;
    let ends = [f64::min, f64::max].map(|pick| heights.iter().copied().reduce(pick).expect("a height"));
    (heights.len(), mean, square.sqrt(), ends)
}

/// What may be off: by 0.02 mm each, from values in millimetres.
const OFF: [(&str, f64); 4] =
    [("crank_length", 30.0), ("coupler_length", 90.0), ("rocker_length", 70.0), ("pen.x", 45.0)];

/// What `mechc tolerance` says of the height.
fn height(file: &str, more: &[&str]) -> serde_json::Value {
    let tol = OFF.map(|(name, _)| format!("{name}=0.02mm"));
    let tol: Vec<&str> = tol.iter().flat_map(|tol| ["--tol", tol]).collect();
    let table = mechc(&[&["tolerance", file, "--format", "json"], &tol[..], more].concat());
    let table: serde_json::Value = serde_json::from_str(&table).expect("an object");
    table["affected"].as_array().expect("a list").iter().find(|of| of["name"] == "height").expect("a measure").clone()
}

/// A table of `mechc tolerance` against a sample of a hundred thousand variants: no number of it is from the same formulas.
#[test]
fn tables_match_uniform_sampling() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.mech").to_string_lossy().into_owned();
    std::fs::write(&file, ROCKER).unwrap();
    let uniform = height(&file, &[]);
    let number = |key: &str| uniform[key].as_f64().expect("a number");
    let (at, nominal, wanted) = (number("t").to_string(), number("nominal"), number("sigma"));
    let ranges = OFF.map(|(name, value)| format!("{name}={}mm..{}mm", value - 0.02, value + 0.02));
    let vary: Vec<&str> = ranges.iter().flat_map(|range| ["--vary", range]).collect();
    // pseudo-random points leave one over the root of twice their count open, 0.7 %
    for (count, method, near) in [("100000", "sobol", 2e-3), ("10000", "random", 0.03)] {
        let sample = ["--method", method, "--seed", "5", "--sample", count];
        let (found, mean, sigma, ends) = spread(&file, &at, &[&vary[..], &sample].concat());
        assert_eq!(found.to_string(), count);
        assert!((sigma / wanted - 1.0).abs() < near, "{sigma} instead of {wanted}");
        assert!((mean - nominal).abs() < 2.0 * near * wanted, "{mean} instead of {nominal}");
        for (k, end) in ends.iter().enumerate() {
            let part = (end - nominal) / uniform["worst"][k].as_f64().expect("an end");
            // four together come near their worst, and never beyond but for what is not linear
            assert!((0.8..1.002).contains(&part), "{part} of the worst case");
        }
    }
}

/// What is spread normally, as a table of variants by Box and Muller.
#[test]
fn tables_match_normal_sampling() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (file, variants) = (inside("a.mech"), inside("v.csv"));
    std::fs::write(&file, ROCKER).unwrap();
    let normal = height(&file, &["--normal"]);
    let mut random = Random::new(11);
    let mut table = OFF.map(|(name, _)| format!("{name} [mm]")).join(",") + "\n";
    for _ in 0..10_000 {
        let row = OFF.map(|(_, value)| {
            let (size, turn) = ((-2.0 * random.part().ln()).sqrt(), TAU * random.part());
            (value + 0.02 / 3.0 * size * turn.cos()).to_string()
        });
        table += &(row.join(",") + "\n");
    }
    std::fs::write(&variants, table).unwrap();
    let at = normal["t"].as_f64().expect("a time").to_string();
    let (count, _, sigma, _) = spread(&file, &at, &["--vary", &format!("@{variants}")]);
    let wanted = normal["sigma"].as_f64().expect("a number");
    assert!(count == 10_000 && (sigma / wanted - 1.0).abs() < 0.03, "{sigma} instead of {wanted}");
}
