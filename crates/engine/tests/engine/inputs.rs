//! Inputs: what they are by the text, by a formula from outside, by samples.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};

/// A crank and a slider on rails of their own, with what they do.
fn machine(inputs: &str, [turn, feed]: [&str; 2]) -> String {
    format!(
        "mechanism machine {{
            param gain = 2
            fn    double(u) = gain * u
            {inputs}
            ground {{ point O = (0, 0)  axis way = (0, 0) along (1, 0) }}
            body crank at (0, 0, 0) {{ point O = (0, 0)  point pin = (50 mm, 0) }}
            body rod at (50 mm, 0, 0) {{ point pin = (0, 0)  point eye = (150 mm, 0) }}
            body slide at (200 mm, 0, 0) {{ point eye = (0, 0)  axis way = eye along (1, 0) }}
            body bed at (0, 0, 0) {{ axis way = (0, 0) along (1, 0) }}
            joint main:  revolute(ground.O, crank.O)
            joint big:   revolute(crank.pin, rod.pin)
            joint small: revolute(rod.eye, slide.eye)
            joint guide: translational(ground.way, slide.way)
            joint rails: translational(ground.way, bed.way)
            driver motor: rotation(main) = {turn}
            driver drive: displacement(rails) = {feed}
            measure sum = {turn} + ({feed}) / 1 mm
            analysis from 0 s to 1 s every 40 ms
        }}"
    )
}

const INPUTS: &str = "input turn = 30 deg + 1 rev/s * t
            input feed = 10 mm + 5 mm/s * t";

/// The rows of a text, or the codes of what is wrong with it.
fn rows(text: &str, choice: &Choice, world: &Memory) -> Result<Vec<Vec<u64>>, Vec<&'static str>> {
    let checked = Parsed::new("machine.mech", text).check(choice, world);
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    let codes =
        || checked.diagnostics().iter().chain(messages.iter()).map(|fault| fault.code.as_str()).collect::<Vec<_>>();
    let compiled = compiled.ok_or_else(codes)?;
    let [from, to, every] = compiled.analysis().expect("times");
    let times = Times::grid(from, to, every).expect("a grid");
    let (run, messages) = compiled.run(&times, &RunOptions::default());
    let mut run = run.ok_or_else(|| messages.iter().map(|fault| fault.code.as_str()).collect::<Vec<_>>())?;
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) => rows.push(row.iter().map(|value| value.to_bits()).collect()),
            Err(why) => return Err(vec![why.first().expect("an error").code.as_str()]),
        }
    }
    Ok(rows)
}

fn reported(inputs: &[&str], samples: Option<&str>) -> (Choice, Memory) {
    let inputs = inputs.iter().map(|input| (*input).to_owned()).collect();
    let world = samples.map_or_else(Memory::default, |text| Memory::default().with("samples.csv", text));
    (Choice { inputs, samples: samples.map(|_| "samples.csv".into()), ..Choice::default() }, world)
}

/// The rows of a mechanism whose inputs are told something are those of one in which that is written.
fn is_the_same_as(inputs: &[&str], samples: Option<&str>, definitions: &str, written: [&str; 2]) {
    let (choice, world) = reported(inputs, samples);
    let with_inputs = rows(&machine(INPUTS, ["turn", "feed"]), &choice, &world).expect("rows");
    let without = rows(&machine(definitions, written), &Choice::default(), &Memory::default()).expect("rows");
    assert!(with_inputs.len() > 20);
    assert!(with_inputs == without, "the rows differ: {definitions}");
}

#[test]
fn unset_inputs_use_their_formula() {
    is_the_same_as(&[], None, "", ["30 deg + 1 rev/s * t", "10 mm + 5 mm/s * t"]);
}

#[test]
fn inputs_use_the_given_formula() {
    let formulas = ["turn=double(t / 1 s) - 0.5", " feed = 0.02 * t"];
    is_the_same_as(&formulas, None, "", ["double(t / 1 s) - 0.5", "20 mm/s * t"]);
}

#[test]
fn samples_are_joined_by_the_splines_of_tables() {
    let samples = "feed [mm], t [ms], turn [deg]\n10,0,30\n12,400,90\n13,1000,200\n";
    let definitions = "table turn = spline [(0 s, 30 deg), (400 ms, 90 deg), (1000 ms, 200 deg)]
            table feed = spline [(0 s, 10 mm), (400 ms, 12 mm), (1000 ms, 13 mm)]";
    is_the_same_as(&[], Some(samples), definitions, ["turn(t)", "feed(t)"]);
    // one by samples, the other by a formula
    let samples = "t,turn\n0,0.5\n2,1.5\n";
    let definitions = "table turn = spline [(0 s, 0.5), (2 s, 1.5)]";
    is_the_same_as(&["feed=0.03"], Some(samples), definitions, ["turn(t)", "30 mm"]);
}

#[test]
fn lines_may_end_in_carriage_returns() {
    let of = |end: &str| {
        let (choice, world) = reported(&[], Some(&["t,turn", "0,0.5", "2,1.5", ""].join(end)));
        rows(&machine(INPUTS, ["turn", "feed"]), &choice, &world)
    };
    let wanted = of("\n").expect("rows");
    assert!(of("\r") == Ok(wanted.clone()) && of("\r\n") == Ok(wanted));
    // where the fault is, is told by lines as an editor shows them
    let (choice, world) = reported(&[], Some("t,turn\r0,0.5\r2,x\r"));
    let checked = Parsed::new("machine.mech", &machine(INPUTS, ["turn", "feed"])).check(&choice, &world);
    let fault = checked.diagnostics().iter().next().expect("a fault");
    let span = fault.labels.first().expect("a place").span;
    assert_eq!(checked.sources().get(span.file).position(span.start), (3, 3));
}

#[test]
fn sample_headers_report_missing_columns() {
    let of = |header: &str| {
        // a column that belongs to no input may have any contents
        let (choice, world) = reported(&[], Some(&format!("{header}\n0,zero\n1,one\n")));
        let checked = Parsed::new("machine.mech", &machine(INPUTS, ["turn", "feed"])).check(&choice, &world);
        let reported: Vec<String> = checked
            .diagnostics()
            .iter()
            .map(|fault| format!("{} {}; {}", fault.code, fault.message, fault.help.join("; ")))
            .collect();
        reported.join(" | ")
    };
    let no_input = |shown: &str, help: &str| format!("E0703 mechanism `machine` has no input `{shown}`; {help}");
    assert_eq!(of("t,turn[deg]"), no_input("turn[deg]", "a unit stands behind a space: `turn [deg]`"));
    assert_eq!(of("t,turn [deg"), no_input("turn [deg", "a unit stands between brackets: `turn [deg]`"));
    assert_eq!(of("t,turn [deg] [rad]"), no_input("turn [deg] [rad]", "a column has one unit: `turn [deg]`"));
    assert_eq!(of("t,note"), no_input("note", "its inputs are turn, feed"));
    let no_times = "E0416 the samples have no column `t`; a unit stands behind a space: `t [ms]`";
    assert_eq!(of("t[ms],turn"), no_times);
}

#[test]
fn a_formula_from_outside_names_no_part() {
    let text = "mechanism r { input own = t / 1 s part a[k in 0..2]: lever() part b: lever(turn = own) }
        mechanism lever { input turn = t / 1 s ground { point O = (0, 0) } body b { point O = (0, 0) }
            joint j: revolute(ground.O, b.O) driver d: rotation(j) = turn }";
    let of = |input: &str| {
        let checked = Parsed::new("r.mech", text).check(&reported(&[input], None).0, &Memory::default());
        checked.diagnostics().iter().map(|fault| fault.message.clone()).collect::<Vec<_>>().join(" | ")
    };
    assert_eq!(of("own=2 * t / 1 s"), "");
    assert_eq!(of("own=a[0]"), "expected a number, found a part");
    assert_eq!(of("own=a[1].turn"), "expected a number, found something in a part");
    assert_eq!(of("own=nobody[0]"), "nothing of this name is repeated");
    // what is told of a part's input is told by its path
    assert_eq!(of("a[1].turn=3 mm"), "the input `a[1].turn` must be a pure number, found a length");
}

#[test]
fn impossible_inputs_are_reported() {
    let of = |inputs: &[&str], samples: Option<&str>| {
        let (choice, world) = reported(inputs, samples);
        rows(&machine(INPUTS, ["turn", "feed"]), &choice, &world).expect_err("a fault")
    };
    assert_eq!(of(&["turns=3"], None), ["E0703"]);
    assert_eq!(of(&["turn"], None), ["E0706"]);
    assert_eq!(of(&["turn=3", "turn=4"], None), ["E0706"]);
    assert_eq!(of(&["turn=3 mm"], None), ["E0402"]);
    assert_eq!(of(&["turn=x(crank.pin)"], None), ["E0307"]);
    assert_eq!(of(&["turn=feed / 1 mm"], None), ["E0306"]);
    assert_eq!(of(&["turn=3"], Some("t,turn\n0,1\n1,2\n")), ["E0706"]);
    assert_eq!(of(&[], Some("t,turns\n0,1\n1,2\n")), ["E0703"]);
    assert_eq!(of(&[], Some("t,turn [mm]\n0,1\n1,2\n")), ["E0402"]);
    assert_eq!(of(&[], Some("t,turn\n0,1\n0,2\n")), ["E0414"]);
    assert_eq!(of(&[], Some("t,turn\n0,one\n1,2\n")), ["E0416"]);
    // a time outside the samples is told when it is reached
    assert_eq!(of(&[], Some("t,turn\n0,1\n0.5,2\n")), ["E0608"]);
    assert_eq!(of(&[], Some("t,turn\n0.5,1\n2,2\n")), ["E0608"]);
}

#[test]
fn inputs_are_allowed_where_time_is() {
    let codes = |change: (&str, &str)| {
        let text = machine(INPUTS, ["turn", "feed"]);
        assert!(text.contains(change.0));
        rows(&text.replacen(change.0, change.1, 1), &Choice::default(), &Memory::default()).err()
    };
    assert_eq!(codes(("double(u) = gain * u", "double(u) = turn * u")), None);
    assert_eq!(codes(("gain = 2", "gain = turn")), Some(vec!["E0306"]));
    assert_eq!(codes(("(50 mm, 0)", "(feed, 0)")), Some(vec!["E0306"]));
    assert_eq!(codes(("5 mm/s * t", "turn * 5 mm")), Some(vec!["E0306"]));
    assert_eq!(codes(("driver drive", "constraint drive")), Some(vec!["E0306"]));
    assert_eq!(codes(("input feed = 10 mm + 5 mm/s * t", "input feed = x(crank.pin)")), Some(vec!["E0307"]));
    // a function that holds an input may not stand in one
    let through = (
        "double(u) = gain * u\n            input turn = 30 deg",
        "double(u) = feed * u\n            input turn = double(1) / 1 mm",
    );
    assert_eq!(codes(through), Some(vec!["E0306"]));
    assert_eq!(codes(("1 rev/s * t", "1 rev/s * t + turn")), Some(vec!["E0206"]));
}

const CRANKS: &str = "mechanism cranks {
    param n = 2
    input turn[k in 0..n] = 1 rad/s * t
    body b[k in 0..n] { point O = (0, 0) }
    joint p[k in 0..n]: revolute((0, 0), b[k].O)
    driver d[k in 0..n]: angle(b[k]) = turn[k]
    analysis from 0 s to 1 s every 0.5 s
}";

/// The last angles of the cranks.
fn last_angles(inputs: &[&str], samples: Option<&str>) -> Result<[f64; 2], Vec<&'static str>> {
    let (choice, world) = reported(inputs, samples);
    let rows = rows(CRANKS, &choice, &world)?;
    let row = rows.last().expect("a row");
    Ok([row[3], row[6]].map(f64::from_bits))
}

#[test]
fn repeated_inputs_are_set_together_or_singly() {
    assert_eq!(last_angles(&[], None), Ok([1.0, 1.0]));
    assert_eq!(last_angles(&["turn=5*t"], None), Ok([5.0, 5.0]));
    assert_eq!(last_angles(&["turn[1]=5*t"], None), Ok([1.0, 5.0]));
    assert_eq!(last_angles(&["turn[ 0 ]=5*t"], Some("t,turn[1]\n0,0\n1,3\n")), Ok([5.0, 3.0]));
    assert_eq!(last_angles(&["turn[2]=5*t"], None), Err(vec!["E0703"]));
    assert_eq!(last_angles(&["turn=5*t", "turn[1]=t"], None), Err(vec!["E0706"]));
    assert_eq!(last_angles(&["turn=5 mm"], None), Err(vec!["E0402"]));
    assert_eq!(last_angles(&["turn=5*t"], Some("t,turn[1]\n0,0\n1,3\n")), Err(vec!["E0706"]));
}

#[test]
fn counts_are_no_parameters_of_emitted_code() {
    let parsed = Parsed::new("cranks.mech", CRANKS);
    let (compiled, _) = parsed
        .check(&Choice { set: vec!["n=3".to_owned()], ..Choice::default() }, &Memory::default())
        .compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.expect("a mechanism");
    let is_a_body = |column: &&String| column.starts_with("b[") && column.split('.').count() == 2;
    assert_eq!(compiled.columns().iter().filter(is_a_body).count(), 9);
    let (rust, _) = compiled.rust(&mechc::RustOptions::new("cranks"));
    assert!(!rust.expect("code").contains("pub n: f64"), "`n` is a field of the parameters");
}
