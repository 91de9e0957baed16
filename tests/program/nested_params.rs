//! Params of parts in emitted code: structures in structures, and arrays of them, that are set as `mechc run --set` sets them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::compiling::{bits_of, compile};
use crate::support::all_rows;
use mechc::{Cancel, Choice, Compiled, Memory, Parsed, Redundant, RustOptions};
use std::fmt::Write;
use std::fs;
use std::process::Command;

/// What is set, as the command line and as Rust have it (SI).
const SET: [(&str, &str, f64); 12] = [
    ("speed=1.5", "speed", 1.5),
    ("leg_1=0.3", "leg_1", 0.3),
    ("pair[1].foot=0.7", "pair[1].foot", 0.7),
    ("pair[0].left.reach=0.35", "pair[0].left.reach", 0.35),
    ("pair[1].right.A.y=-0.25", "pair[1].right.a_y", -0.25),
    ("grid[1,2].A.x=0.125", "grid[1][2].a_x", 0.125),
    ("grid[0,1].reach=0.9", "grid[0][1].reach", 0.9),
    ("late[2].reach=0.45", "late_2.reach", 0.45),
    ("one.A.x=0.0625", "one.a_x", 0.0625),
    ("by.reach=0.75", "by.reach", 0.75),
    ("uneven[0].arm[0].reach=0.55", "uneven_0.arm[0].reach", 0.55),
    ("uneven[1].arm[1].A.y=0.875", "uneven_1.arm[1].a_y", 0.875),
];

fn compiled(set: &[String]) -> Compiled {
    let text = fs::read_to_string("tests/slopes/nested.mech").expect("a text");
    let choice = Choice { mechanism: Some("nested".to_owned()), set: set.to_vec(), ..Choice::default() };
    let checked = Parsed::new("nested.mech", &text).check(&choice, &Memory::default());
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{:?} {messages:?}", checked.diagnostics()))
}

/// Whether each row that is printed when these are set has the bits of `mechc run`.
fn holds(set: &[(&str, &str, f64)]) {
    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("nested.mech") };
    let module = compiled(&[]).rust(&options).0.expect("a module");
    let mut sets = String::new();
    for (_, path, value) in set {
        writeln!(sets, "    p.{path} = {value:?};").expect("a string takes everything");
    }
    let reported: Vec<String> = set.iter().map(|(reported, ..)| with_unit(reported)).collect();
    let wanted = compiled(&reported);
    let (rows, stop) = all_rows(&wanted, &wanted.times().expect("times"));
    assert!(stop.is_none() && rows.len() == 21, "{stop:?}");
    let program = format!(
        "#![allow(dead_code)]\nmod machine;\nuse machine::*;
fn main() {{
    let mut p = Params::default();
{sets}    let mut state = assemble(&p).unwrap();
    for k in 0..=20 {{
        step(0.05 * f64::from(k), &mut state).unwrap();
        let row: Vec<String> = state.row().iter().map(|x| x.to_bits().to_string()).collect();
        println!(\"{{}}\", row.join(\" \"));
    }}
    p.speed = f64::NAN;
    assert_eq!(sensitivity(&p, &state), Err(Error::NotANumber));
    p = Params::default();
    p.grid[1][2].reach = f64::NAN;
    assert!(assemble(&p).is_err());
}}
"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let [source, binary] = ["main.rs", "main"].map(|name| folder.path().join(name));
    fs::write(folder.path().join("machine.rs"), module).expect("written");
    fs::write(&source, program).expect("written");
    compile("rustc", &["-o", &binary.to_string_lossy()], &source).unwrap_or_else(|why| panic!("{why}"));
    let output = Command::new(&binary).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), rows.len());
    for (line, row) in lines.iter().zip(&rows) {
        for ((column, bits), wanted) in wanted.columns().iter().zip(line.split(' ')).zip(row).skip(1) {
            let found = f64::from_bits(bits.parse().expect("bits"));
            assert_eq!(bits_of(found), bits_of(*wanted), "{column} at t = {}: {found}, not {wanted}", row[0]);
        }
    }
}

/// A value with its unit: all are lengths, but for the speed.
fn with_unit(reported: &str) -> String {
    if reported.starts_with("speed") { format!("{reported} rad/s") } else { format!("{reported} m") }
}

#[test]
fn nested_params_match_run() {
    holds(&SET);
}

#[test]
fn default_params_match_the_text() {
    holds(&[]);
}
