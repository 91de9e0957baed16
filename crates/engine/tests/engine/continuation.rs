//! Continuation from the nominal inputs of a mechanism to given ones: it follows the straight line between them, on the branch of the
//! estimates.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use mechc::{Cancel, Choice, Compiled, Diagnostics, Memory, Parsed, Redundant, RunOptions, Sources, Times};
use mechc_engine::analysis::{self, ContinuationOptions, Horizon, PathOutcome};
use mechc_expr::math::{acos, cos, sin};
use mechc_ir::program::Program;
use mechc_lang::check;
use mechc_lang::lower::{InputPath, Inputs, LowerOptions};
use mechc_pipeline as lower;
use mechc_syntax as syntax;
use std::f64::consts::PI;
use std::sync::Arc;

/// Lengths of a four-bar's links (mm), ground first, and the angles (deg) at which coupler and rocker are drawn: near to where they are with
/// the crank at 30 deg.
struct Links {
    lengths: [f64; 4],
    angles: [f64; 2],
}

/// The crank turns around, and the rocker does not; drawn on one side of the line from crank pin to rocker pivot or on the other.
const CRANK_ROCKER: [Links; 2] = [
    Links { lengths: [100.0, 30.0, 90.0, 70.0], angles: [40.0, 80.0] },
    Links { lengths: [100.0, 30.0, 90.0, 70.0], angles: [-70.0, -110.0] },
];

/// Every link turns around, so that no estimate serves for all of the motion.
const DRAG_LINK: [Links; 2] = [
    Links { lengths: [30.0, 70.0, 80.0, 60.0], angles: [181.0, 145.0] },
    Links { lengths: [30.0, 70.0, 80.0, 60.0], angles: [-83.0, -48.0] },
];

/// No link turns around.
const ROCKING: Links = Links { lengths: [150.0, 30.0, 90.0, 70.0], angles: [40.0, 80.0] };

fn four_bar(links: &Links, declarations: &str, driver: &str) -> String {
    let ([ground, crank, coupler, rocker], [coupler_angle, rocker_angle]) = (links.lengths, links.angles);
    let (x, y) = (crank * cos(30_f64.to_radians()), crank * sin(30_f64.to_radians()));
    format!(
        "mechanism four_bar {{
            {declarations}
            ground {{ point O = (0, 0)  point C = ({ground} mm, 0) }}
            body crank at (0, 0, 30 deg) {{ point O = (0, 0)  point A = ({crank} mm, 0) }}
            body coupler at ({x} mm, {y} mm, {coupler_angle} deg) {{ point A = (0, 0)  point B = ({coupler} mm, 0) }}
            body rocker at ({ground} mm, 0, {rocker_angle} deg) {{ point C = (0, 0)  point B = ({rocker} mm, 0) }}
            joint main:  revolute(ground.O, crank.O)
            joint left:  revolute(crank.A, coupler.A)
            joint right: revolute(coupler.B, rocker.B)
            joint back:  revolute(ground.C, rocker.C)
            driver motor: rotation(main) = {driver}
            analysis from 0 s to 1 s every 0.5 s
        }}"
    )
}

fn compiled(text: &str, inputs: &[&str], samples: Option<&str>) -> Compiled {
    let world = samples.map_or_else(Memory::default, |text| Memory::default().with("samples.csv", text));
    let inputs = inputs.iter().map(|input| (*input).to_owned()).collect();
    let choice = Choice { inputs, samples: samples.map(|_| "samples.csv".into()), ..Choice::default() };
    let checked = Parsed::new("four_bar.mech", text).check(&choice, &world);
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{:?} {messages:?}", checked.diagnostics()))
}

/// The rows of some times, as far as they come, and what is said.
fn run(compiled: &Compiled, times: &Times) -> (Vec<Vec<f64>>, Diagnostics) {
    let (run, mut messages) = compiled.run(times, &RunOptions::default());
    let Some(mut run) = run else { return (Vec::new(), messages) };
    let rows = run.by_ref().map_while(Result::ok).collect();
    messages.extend(run.take_warnings());
    (rows, messages)
}

/// The first row, of which nothing is said.
fn first_row(compiled: &Compiled, t: f64) -> Vec<f64> {
    let (mut rows, messages) = run(compiled, &Times::listed(t, vec![t]));
    assert!(messages.is_empty(), "{messages:?}");
    rows.remove(0)
}

fn codes(messages: &Diagnostics) -> Vec<&'static str> {
    messages.iter().map(|message| message.code.as_str()).collect()
}

/// Positions agree; velocities are of other motions.
fn same_place(a: &[f64], b: &[f64]) -> bool {
    a[1..10].iter().zip(&b[1..10]).all(|(a, b)| (a - b).abs() < 1e-11)
}

const TURN: &str = "input turn = 30 deg";

/// Returns the last row of a motion whose driver leads from the text's input to another one.
fn followed(text: impl Fn(&str, &str) -> String, target: f64) -> Vec<f64> {
    let text = text("", &format!("30 deg + ({target} deg - 30 deg) * t / 1 s"));
    let (rows, messages) = run(&compiled(&text, &[], None), &Times::listed(0.0, vec![0.0, 1.0]));
    assert!(messages.is_empty() && rows.len() == 2, "{messages:?}");
    rows[1].clone()
}

#[test]
fn the_start_is_on_the_branch_of_the_file() {
    for links in CRANK_ROCKER.iter().chain(&DRAG_LINK) {
        let text = |declarations: &str, driver: &str| four_bar(links, declarations, driver);
        for target in [31.0, 100.0, 180.0, 250.0, 359.0, 800.0, -75.0, -500.0] {
            let led = compiled(&text(TURN, "turn"), &[&format!("turn={target} deg")], None);
            let wanted = followed(text, target);
            assert!(same_place(&first_row(&led, 0.0), &wanted), "{target} deg, {:?}", links.lengths);
            // and so is that of a driver which begins there
            let alone = compiled(&text("", &format!("{target} deg + 0 rad/s * t")), &[], None);
            assert!(same_place(&first_row(&alone, 0.0), &wanted), "{target} deg, {:?}", links.lengths);
        }
    }
}

#[test]
fn samples_begin_by_continuation() {
    let text = |declarations: &str, driver: &str| four_bar(&CRANK_ROCKER[1], declarations, driver);
    let samples = "t,turn [deg]\n0,250\n1,300\n2,310\n";
    let sampled = compiled(&text(TURN, "turn"), &[], Some(samples));
    assert!(same_place(&first_row(&sampled, 0.0), &followed(text, 250.0)));
    assert!(same_place(&first_row(&sampled, 1.0), &followed(text, 300.0)));
    // a time outside of them is told as ever, and not that something on the way to it went wrong
    let (rows, messages) = run(&sampled, &Times::listed(-1.0, vec![-1.0]));
    assert_eq!((rows.len(), codes(&messages)), (0, vec!["E0608"]));
}

#[test]
fn time_changes_with_the_inputs() {
    let text = |declarations: &str, driver: &str| four_bar(&CRANK_ROCKER[1], declarations, driver);
    let both = text("input turn = 30 deg + 5 deg/s * t\n fn more(u) = 20 deg/s * u", "turn + more(t)");
    // 30 deg at 0 s by its own input, 300 deg - 100 deg at 5 s by the other
    let led = compiled(&both, &["turn=300 deg - 40 deg/s * t"], None);
    assert!(same_place(&first_row(&led, 5.0), &followed(text, 200.0)));
    // an input that is not set keeps its formula
    let two = text("input turn = 30 deg\n input more = 20 deg/s * t", "turn + more");
    assert!(same_place(&first_row(&compiled(&two, &["turn=100 deg"], None), 5.0), &followed(text, 200.0)));
}

#[test]
fn setting_an_input_to_its_formula_changes_no_row() {
    let text = four_bar(&CRANK_ROCKER[1], "input turn = 30 deg + 90 deg/s * t", "turn");
    let times = Times::grid(0.0, 1.0, 0.01).expect("a grid");
    let (own, messages) = run(&compiled(&text, &[], None), &times);
    let (reported, _) = run(&compiled(&text, &["turn=30 deg + 90 deg/s * t"], None), &times);
    assert!(own.len() == 101 && messages.is_empty(), "{messages:?}");
    assert!(own == reported, "the rows differ");
}

/// A crank that cannot turn all around: its ground is too long.
fn rocking(declarations: &str, driver: &str) -> String {
    four_bar(&ROCKING, declarations, driver)
}

#[test]
fn dead_points_on_the_path_fall_back_to_estimates() {
    // -30 deg is there, and so is 330 deg, but not on the way round
    let text = rocking(TURN, "turn");
    assert!(run(&compiled(&text, &["turn=-30 deg"], None), &Times::listed(0.0, vec![0.0])).1.is_empty());
    let (rows, messages) = run(&compiled(&text, &["turn=330 deg"], None), &Times::listed(0.0, vec![0.0]));
    assert_eq!((rows.len(), codes(&messages)), (1, vec!["E0612"]));
    let reported = messages.iter().next().expect("a diagnostic");
    assert!(reported.message.starts_with("on the way to the inputs that are given there is a dead point at `turn` = "));
    // the pins are in one line with the pivots where (90 + 70)² = 30² + 150² - 2·30·150 cos(turn)
    let limit = acos((30.0 * 30.0 + 150.0 * 150.0 - 160.0 * 160.0) / (2.0 * 30.0 * 150.0));
    let part = reported.data["part"].as_f64().expect("a number");
    let (from, to) = (30_f64.to_radians(), 330_f64.to_radians());
    assert!((from + (to - from) * part - limit).abs() < 1e-6, "{part}");
    assert_eq!(reported.labels[0].text, "led from 0.5235987756 rad to 5.759586532 rad, and got to 1.817743041 rad");
    // where there is no position, that is told too
    let (rows, messages) = run(&compiled(&text, &["turn=180 deg"], None), &Times::listed(0.0, vec![0.0]));
    assert_eq!((rows.len(), codes(&messages)), (0, vec!["E0612", "E0601"]));
}

#[test]
fn derivatives_by_params_of_inputs_change_no_path() {
    // `twice` follows from another param, so that it is differentiated by a shift
    let text = rocking("param once = 15 deg  param twice = 2 * once  input turn = twice + 1 rad/s * t", "turn");
    let choice = Choice { inputs: vec!["turn=330 deg".to_owned()], by: vec!["twice".to_owned()], ..Choice::default() };
    let checked = Parsed::new("four_bar.mech", &text).check(&choice, &Memory::default());
    let (differentiated, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    let differentiated = differentiated.unwrap_or_else(|| panic!("{messages:?}"));
    let stopped = |compiled: &Compiled| {
        let (rows, messages) = run(compiled, &Times::listed(0.0, vec![0.0]));
        assert_eq!((rows.len(), codes(&messages)), (1, vec!["E0612"]));
        messages.iter().next().and_then(|message| message.data["part"].as_f64()).expect("a number")
    };
    assert_eq!(stopped(&differentiated), stopped(&compiled(&text, &["turn=330 deg"], None)));
}

#[test]
fn a_kink_on_the_way_is_passed_and_a_jump_is_not() {
    let text = |declarations: &str, driver: &str| four_bar(&CRANK_ROCKER[1], declarations, driver);
    let kinked = text(TURN, "30 deg + abs(turn - 90 deg) * 2 - 120 deg");
    let led = compiled(&kinked, &["turn=190 deg"], None);
    assert!(same_place(&first_row(&led, 0.0), &followed(text, 110.0)));
    // many of them, one right at the end
    let many = text("input turn = 0", "30 deg + abs(mod(turn + 0.5, 1) - 0.5) * 100 deg");
    assert!(same_place(&first_row(&compiled(&many, &["turn=20.5"], None), 0.0), &followed(text, 80.0)));
    let jumping = text(TURN, "if turn < 90 deg then turn else turn + 20 deg");
    let (rows, messages) = run(&compiled(&jumping, &["turn=150 deg"], None), &Times::listed(0.0, vec![0.0]));
    assert!(rows.len() == 1 && codes(&messages)[0] == "E0612", "{messages:?}");
}

#[test]
fn incomplete_files_start_from_estimates() {
    // its own input has no value, or no position
    for own in ["1 / (1 - 1) * 1 deg", "sqrt(-1 - 0 * t / 1 s)", "120 deg"] {
        let text = rocking(&format!("input turn = {own}"), "turn");
        let world = Memory::default();
        let choice = Choice { inputs: vec!["turn=30 deg".to_owned()], ..Choice::default() };
        let checked = Parsed::new("a.mech", &text).check(&choice, &world);
        if !checked.is_sound() {
            assert_eq!(codes(checked.diagnostics()), ["E0404"], "{own}");
            continue;
        }
        assert_eq!(run(&compiled(&text, &["turn=30 deg"], None), &Times::listed(0.0, vec![0.0])).0.len(), 1, "{own}");
    }
}

#[test]
fn far_estimates_are_reported_at_the_nominal_start() {
    let text = four_bar(&Links { angles: [40.0, -100.0], ..CRANK_ROCKER[0] }, TURN, "turn");
    let (rows, messages) = run(&compiled(&text, &["turn=100 deg"], None), &Times::listed(3.0, vec![3.0]));
    assert_eq!((rows.len(), codes(&messages)), (1, vec!["N0601"]));
    assert!(messages.iter().all(|message| message.message.ends_with("at t = 0 s")), "{messages:?}");
}

#[test]
fn emitted_code_starts_as_a_run() {
    let text = four_bar(&DRAG_LINK[1], TURN, "turn");
    let led = compiled(&text, &["turn=250 deg + 0 rad/s * t"], None);
    let (code, messages) = led.rust(&mechc::RustOptions::new("four_bar"));
    assert!(messages.is_empty(), "{messages:?}");
    let code = code.expect("code");
    for value in &first_row(&led, 0.0)[4..10] {
        let digits = format!("{value:?}");
        assert!(code.contains(&digits[..digits.len().min(14)]), "{value} is not in the code");
    }
}

#[test]
fn inputs_are_continued_to_numbers() {
    let text = four_bar(&DRAG_LINK[1], "input turn = 30 deg\n input more = 20 deg/s * t", "turn + more + 1 deg/s * t");
    let mut sources = Sources::default();
    let file = sources.add("four_bar.mech", text);
    let tree = syntax::parse(&sources, file).tree;
    // time goes from 1 s to 3 s, and the other input is not set: 21 deg are added at first, and 63 deg at last
    let targets = [("turn".to_owned(), 250_f64.to_radians())];
    let (model, messages) = check::check(&tree.mechanisms[0], &check::CheckOptions::default(), &sources);
    let model = model.unwrap_or_else(|| panic!("{messages:?}"));
    let path = InputPath::new(&model, [1.0, 3.0], &targets).expect("both inputs have values");
    let continued = path.continued(&model);
    let lines: Vec<(&str, [f64; 2])> = continued.iter().map(|led| (led.declared.name.as_str(), led.line)).collect();
    assert_eq!(lines, [("turn", [30.0, 250.0]), ("more", [20.0, 60.0])].map(|(n, l)| (n, l.map(f64::to_radians))));
    let on_path = LowerOptions { inputs: Inputs::AlongPath(path), ..LowerOptions::default() };
    let system = lower::lower_model(&model, &on_path);
    let (determined, _) = analysis::determine(system, false, Horizon::of_analysis(None)).expect("determined");
    let program = Arc::new(Program::new(determined.system()));
    let (cancel, t) = (Cancel::default(), 1.0);
    let options = ContinuationOptions { tolerance: mechc::TOLERANCE, pass_bifurcations: false, t, cancel };
    let way = analysis::lead(&Arc::new(determined), &program, None, &[0.25, 1.0], &options);
    let Ok(PathOutcome { reached, stopped: None, .. }) = way else { panic!("it is led") };
    assert_eq!(reached.len(), 2);
    let q = [&[0.0][..], &reached[1]].concat();
    assert!(same_place(&q, &followed(|d, driver| four_bar(&DRAG_LINK[1], d, driver), 313.0)));
}

#[test]
fn cancelled_runs_report_nothing() {
    let cancel = Cancel::default();
    let led = compiled(&rocking(TURN, "turn"), &["turn=330 deg"], None);
    cancel.cancel();
    let (run, messages) = led.run(&Times::listed(0.0, vec![0.0]), &RunOptions { cancel, ..RunOptions::default() });
    assert!(run.is_none() && messages.is_empty());
}

/// A parallelogram, which folds at a half turn and at a whole one.
fn parallelogram(name: &str, input: &str) -> String {
    format!(
        "mechanism {name} {{
            input turn = {input}
            ground {{ point A = (0, 0)  point B = (2 m, 0) }}
            body crank at (0, 0, 45 deg) {{ point A = (0, 0)  point C = (1 m, 0) }}
            body coupler at (0.7 m, 0.7 m, 0) {{ point C = (0, 0)  point D = (2 m, 0) }}
            body rocker at (2 m, 0, 45 deg) {{ point B = (0, 0)  point D = (1 m, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint C: revolute(crank.C, coupler.C)
            joint D: revolute(coupler.D, rocker.D)
            joint B: revolute(ground.B, rocker.B)
            driver motor: rotation(A) = turn
        }}\n"
    )
}

/// Returns the messages of a continuation, and the fractions of its path at which they occur.
fn messages_on_path(compiled: &Compiled, pass_bifurcations: bool) -> (Vec<(String, f64)>, Vec<f64>) {
    let options = RunOptions { pass_bifurcations, ..RunOptions::default() };
    let (run, messages) = compiled.run(&Times::listed(0.0, vec![0.0]), &options);
    let row = run.expect("it starts").next().expect("a row").expect("it stands");
    let reported = messages.iter().map(|message| {
        let whole = format!("{} {}", message.code.as_str(), message.message);
        (whole, message.data["part"].as_f64().expect("a part"))
    });
    (reported.collect(), row)
}

#[test]
fn bifurcations_that_are_passed_on_the_way_are_reported() {
    let led = compiled(&parallelogram("m", "45 deg"), &["turn=405 deg"], None);
    let (reported, row) = messages_on_path(&led, true);
    let wanted = [(PI, 0.375), (2.0 * PI, 0.875)];
    assert_eq!(reported.len(), wanted.len(), "{reported:?}");
    for ((message, part), (place, at)) in reported.iter().zip(wanted) {
        let begins = "W0602 on the way to the inputs that are given two branches of the motion meet at `turn` = ";
        let number = message.strip_prefix(begins).and_then(|rest| rest.split(" rad;").next()).expect("a place");
        assert!((number.parse::<f64>().expect("a number") - place).abs() < 1e-5, "{message}");
        assert!((part - at).abs() < 1e-6, "{part}");
    }
    // it is the parallelogram still
    assert!((row[3] - 405_f64.to_radians()).abs() < 1e-12 && (row[9] - row[3]).abs() < 1e-9, "{row:?}");
    // where they are not passed the way ends there
    let (reported, _) = messages_on_path(&led, false);
    assert!(
        reported.len() == 1 && reported[0].0.starts_with("E0612") && (reported[0].1 - 0.375).abs() < 1e-6,
        "{reported:?}"
    );
    let short = compiled(&parallelogram("m", "45 deg"), &["turn=170 deg"], None);
    assert!(messages_on_path(&short, true).0.is_empty());
}

#[test]
fn parts_report_passed_bifurcations_and_their_use() {
    let text = format!(
        "mechanism whole {{
            part near: linkage(turn = 100 deg) at (0, 0, 0)
            part far: linkage(turn = 200 deg) at (0, 5 m, 30 deg) mirrored
            part other: linkage(turn = -200 deg) at (0, 9 m, 0)
        }}\n{}",
        parallelogram("linkage", "45 deg")
    );
    let options = RunOptions { pass_bifurcations: true, ..RunOptions::default() };
    let whole = compiled(&text, &[], None);
    let (run, messages) = whole.run(&Times::listed(0.0, vec![0.0]), &options);
    assert!(run.is_some());
    let reported: Vec<(&str, f64)> = messages
        .iter()
        .map(|message| {
            assert_eq!(message.code.as_str(), "W0602");
            let used = message.labels.iter().find(|label| label.text.starts_with("in part `"));
            let part = used.expect("where it is used").text.split('`').nth(1).expect("a name");
            assert!(message.message.contains(&format!("of the part `{part}` to its inputs")), "{}", message.message);
            (part, message.data["part"].as_f64().expect("a part"))
        })
        .collect();
    let wanted = [("far", 135.0 / 155.0), ("other", 45.0 / 245.0), ("other", 225.0 / 245.0)];
    assert_eq!(reported.iter().map(|(part, _)| *part).collect::<Vec<_>>(), wanted.map(|(part, _)| part));
    for ((_, found), (_, wanted)) in reported.iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-6, "{reported:?}");
    }
}

/// A mechanism with params that are set, led to them from its own values.
fn led_over(text: &str, set: &[&str]) -> Compiled {
    let set = set.iter().map(|set| (*set).to_owned()).collect();
    let checked =
        Parsed::new("four_bar.mech", text).check(&Choice { set, lead: true, ..Choice::default() }, &Memory::default());
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{:?} {messages:?}", checked.diagnostics()))
}

const START: &str = "param start = 30 deg";

#[test]
fn set_params_are_continued_along_the_branch() {
    for links in CRANK_ROCKER.iter().chain(&DRAG_LINK) {
        let text = |declarations: &str, driver: &str| four_bar(links, declarations, driver);
        for target in [31.0, 180.0, 359.0, -75.0, -500.0] {
            let set = format!("start={target} deg");
            let wanted = followed(text, target);
            assert!(same_place(&first_row(&led_over(&text(START, "start"), &[&set]), 0.0), &wanted), "{target} deg");
            // a param that follows from another goes as well, and so does one that is set instead of following
            let follows = text("param half = 15 deg\n param start = 2 * half", "start");
            let half = format!("half={} deg", target / 2.0);
            assert!(same_place(&first_row(&led_over(&follows, &[&half]), 0.0), &wanted), "{target} deg");
            assert!(same_place(&first_row(&led_over(&follows, &[&set]), 0.0), &wanted), "{target} deg");
        }
    }
}

/// The line of centres of gears turns on where its drawn direction passes ±180°, and beyond a turn of the params.
#[test]
fn lines_of_centers_are_continued_past_half_a_turn() {
    let text = |tilt: &str| {
        format!(
            "mechanism gears {{
                param tilt = {tilt}
                ground {{ point O = (0, 0)  circle c = O radius 63 mm }}
                body carrier at (0, 0, tilt) {{ point O = (0, 0) point pin = (40 mm, 0) }}
                body planet at (40 mm * cos(tilt), 40 mm * sin(tilt), 0) {{ point P = (0, 0) circle c = P radius 23 mm }}
                joint b: revolute(ground.O, carrier.O)
                joint d: revolute(carrier.pin, planet.P)
                joint mesh: internal_gear(planet.c, ground.c)
                driver m2: rotation(b) = tilt + 1 rad/s * t
                measure turn = angle(planet)
                analysis from 0 s to 1 s every 0.5 s
            }}"
        )
    };
    for (drawn, tilt) in [("13 deg", "-1 deg"), ("13 deg", "0"), ("-5 deg", "170 deg"), ("100 deg", "-70 deg")] {
        let led = led_over(&text(drawn), &[&format!("tilt={tilt}")]);
        let drawn_there = compiled(&text(tilt), &[], None);
        let times = drawn_there.times().expect("an analysis");
        let (found, messages) = run(&led, &times);
        assert_eq!(codes(&messages), [""; 0], "{drawn} to {tilt}");
        let (wanted, _) = run(&drawn_there, &times);
        let column = led.columns().iter().position(|column| column == "turn").expect("a column");
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found[column] - wanted[column]).abs() < 1e-9, "{drawn} to {tilt}");
        }
    }
}

#[test]
fn inputs_are_continued_after_params() {
    for links in CRANK_ROCKER.iter().chain(&DRAG_LINK) {
        let text = |declarations: &str, driver: &str| four_bar(links, declarations, driver);
        let (set, inputs) = (vec!["start=-100 deg".to_owned()], vec!["turn=310 deg".to_owned()]);
        let choice = Choice { set, inputs, lead: true, ..Choice::default() };
        let both = text("param start = 0 deg\n input turn = 30 deg", "start + turn");
        let checked = Parsed::new("four_bar.mech", both.as_str()).check(&choice, &Memory::default());
        let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
        assert!(same_place(&first_row(&compiled, 0.0), &followed(text, 210.0)));
    }
}

#[test]
fn lengths_and_points_are_continued() {
    let text = "mechanism m {
        param A = (30 mm, 0)
        param coupler_length = 90 mm
        ground { point O = (0, 0)  point C = (100 mm, 0) }
        body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = A }
        body coupler at (26 mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (coupler_length, 0) }
        body rocker at (100 mm, 0, 80 deg) { point C = (0, 0)  point B = (70 mm, 0) }
        joint main:  revolute(ground.O, crank.O)
        joint left:  revolute(crank.A, coupler.A)
        joint right: revolute(coupler.B, rocker.B)
        joint back:  revolute(ground.C, rocker.C)
        driver motor: rotation(main) = 30 deg
    }";
    let row = first_row(&led_over(text, &["coupler_length=100mm", "A.y=10mm"]), 0.0);
    let place = |body: usize, [x, y]: [f64; 2]| {
        let [at, to, phi] = [row[1 + 3 * body], row[2 + 3 * body], row[3 + 3 * body]];
        [at + cos(phi) * x - sin(phi) * y, to + sin(phi) * x + cos(phi) * y]
    };
    for (one, other) in [(place(0, [0.03, 0.01]), place(1, [0.0; 2])), (place(1, [0.1, 0.0]), place(2, [0.07, 0.0]))] {
        assert!(mechc_expr::math::hypot(one[0] - other[0], one[1] - other[1]) < 1e-12, "{row:?}");
    }
    // at 145.5 mm coupler and rocker lie in one line
    let (rows, messages) = run(&led_over(text, &["coupler_length=300mm"]), &Times::listed(0.0, vec![0.0]));
    assert_eq!((rows.len(), codes(&messages)), (0, vec!["E0612", "E0601"]));
    let reported = messages.iter().next().expect("a diagnostic");
    assert!(
        reported
            .message
            .starts_with("on the way to the values that are set there is a dead point at `coupler_length` = 0.1455238")
    );
}
