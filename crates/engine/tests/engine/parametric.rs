//! Params that take other values without another check: stages with bound values have the bits of stages that are checked with them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use mechc::{Cancel, Checked, Choice, Compiled, Memory, Parsed, Redundant, RunOptions, Times};

const FOUR_BAR: &str = "mechanism four_bar {
    param crank_length = 30 mm
    param ratio = 3
    param coupler_length = ratio * crank_length
    param pivot = (100 mm, -5 mm)
    param stop = 400 ms
    ground { point O = (0, 0)  point C = pivot }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (crank_length, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (coupler_length, 0)  point P = (45 mm, 20 mm) }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute_revolute(coupler.B, ground.C, 70 mm)
    driver motor: rotation(main) = 30 deg + 1 rev/s * t
    measure height = y(coupler.P) in mm
    result top = max(height)
    analysis from 0 s to stop every 50 ms
}";

/// The stages with params set as `run --lead --set` sets them.
fn checked_with(parsed: &Parsed, settings: &[(&str, &str)]) -> (Checked, Compiled) {
    let set = settings.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let checked = parsed.check(&Choice { set, lead: true, ..Choice::default() }, &Memory::default());
    let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("determined");
    (checked, compiled)
}

/// The rows, the results, and the error at which the motion stops.
fn outcome(compiled: &Compiled, times: &Times) -> (Vec<Vec<u64>>, Vec<Option<u64>>, Vec<String>) {
    let (run, said) = compiled.run(times, &RunOptions::default());
    let mut said: Vec<String> = said.iter().map(|said| said.message.clone()).collect();
    let Some(mut run) = run else { return (Vec::new(), Vec::new(), said) };
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) => rows.push(row.iter().map(|value| value.to_bits()).collect()),
            Err(why) => said.extend(why.diagnostics.iter().map(|said| said.message.clone())),
        }
    }
    let results = run.results().map(|found| found.values).unwrap_or_default();
    (rows, results.into_iter().map(|value| value.map(f64::to_bits)).collect(), said)
}

#[test]
fn bound_stages_have_the_bits_of_checked_ones() {
    let parsed = Parsed::new("text.mech", FOUR_BAR);
    let names = ["crank_length", "pivot.y", "stop", "ratio"].map(str::to_owned);
    let nominal = parsed.check(&Choice::default(), &Memory::default());
    let parametric = nominal.parametric(&names, Redundant::Refused, &Cancel::default()).expect("params are numbers");
    let mut bound = 0;
    for values in [
        ["31 mm", "-5 mm", "0.4 s", "3"],
        ["25 mm", "12.5 mm", "700 ms", "3.25"],
        ["34 mm", "-30 mm", "1 s", "2.5"],
        // no path leads to a crank that is too long
        ["95 mm", "-5 mm", "1 s", "3"],
        ["30 mm", "1 mm", "0.25 s", "3"],
        // a point on the axis is checked anew
        ["30 mm", "0 mm", "0.25 s", "3"],
    ] {
        let Some((checked, compiled, _)) = parametric.with(&values) else { continue };
        bound += 1;
        let settings: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(values).collect();
        let (anew, compiled_anew) = checked_with(&parsed, &settings);
        assert_eq!(compiled.analysis(), compiled_anew.analysis(), "{values:?}");
        let times = compiled_anew.times().expect("an analysis");
        assert_eq!(outcome(&compiled, &times), outcome(&compiled_anew, &times), "{values:?}");
        assert_eq!(checked.param_controls(), anew.param_controls(), "{values:?}");
    }
    assert!(bound >= 4, "{bound}");
}

#[test]
fn what_is_no_number_of_the_param_is_checked_anew() {
    let parsed = Parsed::new("text.mech", FOUR_BAR);
    let nominal = parsed.check(&Choice::default(), &Memory::default());
    let names = ["crank_length".to_owned()];
    let parametric = nominal.parametric(&names, Redundant::Refused, &Cancel::default()).expect("a number");
    for wrong in ["31 kg", "31 deg/s", "nonsense", "", "-30 mm +", "0 mm"] {
        assert!(parametric.with(&[wrong]).is_none(), "{wrong}");
    }
    assert!(parametric.with(&["-30 mm"]).is_some(), "a crank drawn the other way");
    for unknown in ["length", "pivot", "motor"] {
        assert!(nominal.parametric(&[unknown.to_owned()], Redundant::Refused, &Cancel::default()).is_none());
    }
}

#[test]
fn what_replaces_a_zero_is_checked_anew() {
    let text =
        FOUR_BAR.replace("param stop", "param off = 0\n param stop").replace("30 deg + 1 rev/s", "off + 1 rev/s");
    let nominal = Parsed::new("text.mech", &text).check(&Choice::default(), &Memory::default());
    let parametric = nominal.parametric(&["off".to_owned()], Redundant::Refused, &Cancel::default());
    assert!(parametric.expect("a number").with(&["0.1"]).is_none());
}

#[test]
fn settings_of_options_are_kept() {
    let parsed = Parsed::new("text.mech", FOUR_BAR);
    let set = vec!["crank_length=28 mm".to_owned()];
    let nominal = parsed.check(&Choice { set, lead: true, ..Choice::default() }, &Memory::default());
    let names = ["ratio".to_owned()];
    let parametric = nominal.parametric(&names, Redundant::Refused, &Cancel::default()).expect("a number");
    let (_, compiled, _) = parametric.with(&["2.9"]).expect("a number");
    let (_, anew) = checked_with(&parsed, &[("crank_length", "28 mm"), ("ratio", "2.9")]);
    let times = anew.times().expect("an analysis");
    assert_eq!(outcome(&compiled, &times), outcome(&anew, &times));
}

#[test]
fn examples_with_bound_params_have_the_bits_of_checked_ones() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut bound = 0;
    for entry in std::fs::read_dir(folder).expect("examples") {
        let path = entry.expect("an example").path();
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        if path.extension().is_none_or(|ending| ending != "mech") || text.contains("csv") {
            continue;
        }
        let parsed = Parsed::new("text.mech", &text);
        let nominal = parsed.check(&Choice::default(), &Memory::default());
        let controls = nominal.param_controls();
        let continuous = controls.iter().filter(|control| control.is_continuous && control.formula.is_none());
        for control in continuous.take(2) {
            let names = [control.name.clone()];
            let parametric = nominal.parametric(&names, Redundant::Refused, &Cancel::default());
            for factor in [1.01, 0.7, 4.0] {
                let value = format!("{} {}", control.value * factor, control.unit);
                let with = parametric.as_ref().and_then(|parametric| parametric.with(&[&value]));
                let Some((_, compiled, _)) = with else { continue };
                let (_, anew) = checked_with(&parsed, &[(&control.name, &value)]);
                let case = format!("{} {} = {value}", path.display(), control.name);
                assert_eq!(compiled.analysis(), anew.analysis(), "{case}");
                let [from, to, _] = anew.analysis().unwrap_or([0.0, 1.0, 0.1]);
                let times = Times::grid(from, to, (to - from) / 4.0).expect("a grid");
                assert_eq!(outcome(&compiled, &times), outcome(&anew, &times), "{case}");
                bound += 1;
            }
        }
    }
    assert!(bound > 60, "{bound}");
}
