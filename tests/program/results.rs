//! Results as the command line tells and writes them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

/// What the command line says on standard error and writes, in a folder with a file `m.mech`.
fn messages(folder: &std::path::Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_mechc"));
    let output = command.current_dir(folder).args(arguments).output().expect("it runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn results_are_printed_and_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "mechanism m {
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point tip = (1 m, 0) }
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = 1 rad/s * t
    result high = max(y(arm.tip)) in mm
    result turned[k in 0..2] = last(angle(arm)) * k in deg
    analysis from 0 s to 2 s every 0.1 s
}";
    std::fs::write(folder.path().join("m.mech"), text).expect("it is written");
    let run = |more: &[&str]| messages(folder.path(), &[&["run", "m.mech", "-o", "m.csv"], more].concat());
    let (code, reported) = run(&["--results", "r.json"]);
    // the digits that are certain
    let wanted = "high      = 1000 mm\nturned[0] = 0 deg\nturned[1] = 114.59155902616 deg\n";
    assert_eq!((code, reported), (Some(0), wanted.to_owned()));
    let written = std::fs::read_to_string(folder.path().join("r.json")).expect("results");
    assert_eq!(written, "{\"high\": 1.0,\n \"turned[0]\": 0.0,\n \"turned[1]\": 2.0}\n");
    // diagnostics for programs are not mixed with anything else
    assert_eq!(run(&["--message-format", "json"]), (Some(0), String::new()));
    // times alone have no results
    assert_eq!(run(&["--at", "1", "--results", "r.json"]), (Some(0), String::new()));
    assert_eq!(std::fs::read_to_string(folder.path().join("r.json")).expect("results"), "{}\n");
    // the interval is the one of the command line
    let (_, reported) = run(&["--from", "0", "--to", "0.5"]);
    assert!(reported.starts_with("high      = 479.4255386042 mm\n"), "{reported}");
    for refused in [["--results", "m.csv"], ["--results", "./m.csv"], ["--results", "r.txt"], ["--results", "m.mech"]] {
        assert_eq!(run(&refused).0, Some(2), "{refused:?}");
    }
    assert_eq!(run(&["--results", "nowhere/r.json"]).0, Some(4));
    let (_, reported) = messages(folder.path(), &["run", "m.mech", "--results", "-"]);
    assert!(reported.contains("both go to standard output"), "{reported}");
}
