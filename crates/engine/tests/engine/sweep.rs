//! Each variant of a sweep is what `run --lead --set` makes of it, to the bit, however the sweep is divided.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support;

use crate::support::sweeps::{bits, bits_of, compare, count, join, subject, vary};
use mechc::{Cancel, Choice, Memory, Method, Parsed, Redundant, RunOptions, Status, SweepOptions, VaryOptions};

/// A four-bar, whose crank turns fully where it is shortest and shortest and longest together are no longer than the other two.
const FOUR_BAR: &str = "mechanism four_bar {
    param ground_length  = 100 mm
    param crank_length   = 30 mm
    param coupler_length = 90 mm
    param rocker_length  = 70 mm
    param share = 1 / 2
    param speed = 60 rpm
    ground { point O = (0, 0)  point C = (ground_length, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (crank_length, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) {
        point A = (0, 0)  point B = (coupler_length, 0)  point pen = (share * coupler_length, 20 mm)
    }
    body rocker at (100 mm, 0, 80 deg) { point C = (0, 0)  point B = (rocker_length, 0) }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute(coupler.B, rocker.B)
    joint back:  revolute(ground.C, rocker.C)
    driver motor: rotation(main) = 30 deg + speed * t
    measure height = y(coupler.pen) in mm
    result swing = max(angle(rocker)) - min(angle(rocker)) in deg
    result pause = ground_length / (rocker_length - 70 mm + 1 mm)
    analysis from 0 s to 1 / (speed / 60 rpm) * 1 s every 50 ms
}";

#[test]
fn variants_match_single_runs() {
    let subject = subject(FOUR_BAR, Choice::default());
    let ranges = ["crank_length=10mm..60mm", "coupler_length=60mm..140mm", "speed=10rpm..100rpm", "share=-1..2"];
    for (method, seed) in [(Method::Sobol, None), (Method::Random, Some(3))] {
        let sample = VaryOptions { sample: Some(40), method: Some(method), seed, ..vary(&ranges) };
        let found = compare(&subject, &subject.variants(&sample));
        assert!(count(&found, Status::Ok) > 10, "{found:?}");
        assert!(found.iter().any(|(status, _)| !status.is_complete()), "all turn fully: {found:?}");
    }
}

/// Variants that are of no use beside each other, and the others do not feel it.
#[test]
fn errors_of_one_variant_do_not_affect_others() {
    let subject = subject(FOUR_BAR, Choice { set: vec!["speed=30rpm".to_owned()], ..Choice::default() });
    // in order: nothing wrong, cannot close, locks, a pole of a result, a negative length, all collinear once a turn
    let lengths = ["30mm", "400mm", "75mm", "-30mm", "40mm", "60mm"];
    let rockers = ["70mm", "69mm", "80mm"];
    let requested = [format!("crank_length={}", lengths.join(",")), format!("rocker_length={}", rockers.join(", "))];
    let variants = subject.variants(&vary(&[&requested[0], &requested[1]]));
    assert_eq!(variants.points().count(), 18);
    let found = compare(&subject, &variants);
    assert!(count(&found, Status::Ok) >= 3, "{found:?}");
    assert!(found.iter().filter(|(status, _)| !status.is_complete()).count() >= 2, "{found:?}");
}

/// A literal zero fits any dimension, other values do not.
#[test]
fn what_replaces_a_zero_has_a_dimension() {
    let text = FOUR_BAR.replace("param speed", "param off = 0\n param speed").replace("speed * t", "speed * t + off");
    let text = text.replace("share * coupler_length", "share * coupler_length + off");
    let subject = subject(&text, Choice::default());
    let found = compare(&subject, &subject.variants(&vary(&["off=-1,0,1"])));
    assert_eq!(count(&found, Status::Ok), 1, "{found:?}");
}

#[test]
fn threads_and_shares_change_no_bit() {
    let subject = subject(FOUR_BAR, Choice::default());
    let variants = subject.variants(&vary(&["crank_length=20mm..50mm:7", "rocker_length=50mm..90mm:11"]));
    let options = subject.all_columns();
    let whole = bits_of(&subject.sweep(&variants, &SweepOptions { jobs: Some(1), ..options.clone() }));
    for jobs in [2, 16] {
        assert_eq!(bits_of(&subject.sweep(&variants, &SweepOptions { jobs: Some(jobs), ..options.clone() })), whole);
    }
    let mut shares = subject.sweep(&variants, &SweepOptions { take: Some(5), ..options.clone() });
    for (skip, take) in [(5, Some(33)), (38, Some(1)), (39, None)] {
        let share = subject.sweep(&variants, &SweepOptions { skip, take, ..options.clone() });
        assert_eq!(share.first, skip);
        join(&mut shares, share);
    }
    assert_eq!(bits_of(&shares), whole);
}

#[test]
fn results_match_with_and_without_rows() {
    let subject = subject(FOUR_BAR, Choice { results: vec!["top = max(height)".to_owned()], ..Choice::default() });
    assert_eq!(
        subject.compiled.variant_results().iter().map(|(name, unit)| format!("{name} {unit}")).collect::<Vec<_>>(),
        ["swing rad", "pause 1", "top m"]
    );
    let variants = subject.variants(&vary(&["share=0..1:5"]));
    let alone = subject.sweep(&variants, &SweepOptions::default());
    let beside = subject.sweep(&variants, &subject.all_columns());
    assert_eq!((alone.results.clone(), alone.statuses), (beside.results, beside.statuses));
    assert!(alone.columns.is_empty() && alone.lengths == [0; 5]);
    // the pen is farther out the larger its share is
    assert!(alone.results[2].windows(2).all(|pair| pair[0] < pair[1]), "{:?}", alone.results[2]);
}

/// The fewest digits of a variant's results; the numbers are those without them.
#[test]
fn digits_of_results_are_reported() {
    let results = vec!["top = max(height)".to_owned(), "pole = integral(abs(t - 0.1)^(-0.9))".to_owned()];
    let variants = vary(&["share=0..1:5"]);
    let of = |results: &[String], digits| {
        let subject = subject(FOUR_BAR, Choice { results: results.to_vec(), ..Choice::default() });
        subject.sweep(&subject.variants(&variants), &SweepOptions { digits, ..SweepOptions::default() })
    };
    let [plain, reported, with_pole] = [of(&results[..1], false), of(&results[..1], true), of(&results, true)];
    assert_eq!((plain.digits, plain.results), (None, reported.results));
    assert!(reported.digits.expect("digits").iter().all(|digits| *digits > 9));
    assert!(with_pole.digits.expect("digits").iter().all(|digits| (1..6).contains(digits)));
}

/// Scales and the order of elimination are those of the file's own values; so with these a variant is the file.
#[test]
fn nominal_variant_matches_the_file() {
    let subject = subject(FOUR_BAR, Choice::default());
    let block = subject.sweep(&subject.variants(&vary(&["share=0.5", "speed=60rpm"])), &subject.all_columns());
    let plain = subject.parsed.check(&Choice::default(), &Memory::default());
    let compiled = plain.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
    let (run, _) = compiled.run(&compiled.times().expect("an analysis"), &RunOptions::default());
    let mut run = run.expect("it assembles");
    let rows: Vec<Vec<f64>> = run.by_ref().map(|row| row.expect("it moves")).collect();
    assert_eq!(block.lengths, [rows.len()]);
    for (at, row) in rows.iter().enumerate() {
        assert_eq!(bits(&block.columns.iter().map(|column| column[at]).collect::<Vec<_>>()), bits(row), "row {at}");
    }
}

/// The first and the last param of each example, as the file has them and a little beside: parts, gears, cams, tables, points.
#[test]
fn variants_of_examples_match_single_runs() {
    let mut found = 0;
    for path in support::files("examples", "mech") {
        let text = std::fs::read_to_string(&path).expect("an example");
        let own = Parsed::new("text.mech", text.as_str()).check(&Choice::default(), &Memory::default());
        // what uses other files is told so
        let Some(compiled) = own.compile(Redundant::Refused, &Cancel::default()).0 else { continue };
        let inside = compiled.inside().0;
        let params = inside.system().params();
        for param in params.first().into_iter().chain(params.last()) {
            let unit = Some(param.unit()).filter(|unit| unit != "1").unwrap_or_default();
            let (value, beside) = (param.value, 1.02 * param.value + 1e-4);
            let subject = subject(&text, Choice::default());
            let requested = vary(&[&format!("{}={value} {unit},{beside} {unit}", param.name)]);
            if subject.compiled.times().is_none() {
                continue;
            }
            let Ok(variants) = subject.variants_in(&requested, &Memory::default()) else { continue };
            found += count(&compare(&subject, &variants), Status::Ok);
        }
    }
    assert!(found > 30, "only {found} were completed: this shows little");
}

#[test]
fn a_sweep_ends_at_the_variant_that_is_looked_for() {
    let until = |condition: &str| {
        let choice = Choice { until: Some(condition.to_owned()), ..Choice::default() };
        let subject = subject(FOUR_BAR, choice);
        let variants = subject.variants(&vary(&["crank_length=20mm..40mm:21"]));
        [1, 3].map(|jobs| {
            let block = subject.sweep(&variants, &SweepOptions { jobs: Some(jobs), ..SweepOptions::default() });
            assert_eq!(block.results.len(), 2, "what is looked for is no column");
            block.len()
        })
    };
    assert_eq!(until("crank_length > 30.5 mm"), [12; 2]);
    let by_swing = until("swing > 50 deg");
    assert!(by_swing[0] == by_swing[1] && (2..21).contains(&by_swing[0]), "{by_swing:?}");
    assert_eq!(until("swing > 500 deg"), [21; 2]);
}

/// A condition may ask for what some variants do not have: a time behind their ends, a copy beyond their number.
#[test]
fn until_conditions_change_no_variant() {
    let lift = include_str!("../../../../examples/scissor_lift.mech");
    for (text, varied, condition) in [
        (FOUR_BAR, "speed=30rpm,120rpm,60rpm", "at(height, 0.9 s) > 1 m"),
        (lift, "cells=2,1,3", "max(y(up[1].low)) > 10 m"),
    ] {
        let swept = |until: Option<&str>, has_rows: bool| {
            let subject = subject(text, Choice { until: until.map(str::to_owned), ..Choice::default() });
            let options = if has_rows { subject.all_columns() } else { SweepOptions::default() };
            subject.sweep(&subject.variants(&vary(&[varied])), &options)
        };
        for has_rows in [false, true] {
            let block = swept(Some(condition), has_rows);
            assert_eq!(block.statuses, [Status::Ok; 3], "{condition}");
            assert!(bits_of(&block) == bits_of(&swept(None, has_rows)), "{condition}, rows: {has_rows}");
        }
    }
}

#[test]
fn a_cancelled_sweep_gives_whole_variants_and_ends() {
    let subject = subject(FOUR_BAR, Choice::default());
    let variants = subject.variants(&vary(&["crank_length=20mm..40mm:100000"]));
    let cancel = Cancel::default();
    let options = SweepOptions { cancel: cancel.clone(), jobs: Some(2), ..SweepOptions::default() };
    let mut sweep = subject.checked.sweep(&subject.compiled, &variants, &options, |block| block).expect("times");
    let first = sweep.next().expect("a block");
    assert!(first.len() >= 16 && first.statuses.iter().all(|status| *status == Status::Ok));
    cancel.cancel();
    assert!(sweep.count() < 20);
}

#[test]
fn tables_of_variants_are_read() {
    let subject = subject(FOUR_BAR, Choice::default());
    let world = Memory::default().with("v.csv", "speed [rpm], crank_length [mm]\n60,30\n90,20.5\n");
    let variants = subject.variants_in(&vary(&["@v.csv", "share=0,1"]), &world).expect("a table");
    assert_eq!(variants.points().params(), ["speed", "crank_length", "share"]);
    assert_eq!(variants.units().collect::<Vec<_>>(), ["rad/s", "m", "1"]);
    assert_eq!(variants.settings(3), ["speed=9.42477796076938 rad/s", "crank_length=0.0205 m", "share=1"]);
    assert_eq!(variants.points().count(), 4);
    for (text, wanted) in [
        ("", "the variants are empty"),
        ("speed [rpm]\n", "the variants have no row"),
        ("60,30\n90,20\n", "the variants are of no param"),
        ("speed [rpm]\nfast\n", "a value of `speed` is not a number"),
        ("speed [rpm],crank_length\n60,30\n", "the parameter `crank_length` must be a length, found a pure number"),
        ("pace [rpm]\n60\n", "mechanism `four_bar` has no parameter `pace`"),
    ] {
        let world = Memory::default().with("v.csv", text);
        assert_eq!(subject.variants_in(&vary(&["@v.csv"]), &world).expect_err("refused"), wanted, "{text:?}");
    }
}

/// The value that is tried stands in no text; the header does.
#[test]
fn column_errors_are_reported_at_the_header() {
    let text = FOUR_BAR.replacen("param ", "param pen = (1 mm, 2 mm) param ", 1);
    let subject = subject(&text, Choice::default());
    for (header, help) in [
        ("pen [mm]", "`pen` is a point: `--set pen=(12mm,0)`, or one of its coordinates: `--set pen.x=12mm`"),
        ("crank_length [s]", "units of length: `mm`, `m`"),
        ("cranklength [mm]", "was `crank_length` meant?"),
        ("crank_length (mm)", "a unit stands in brackets behind the name: `rod [mm]`"),
    ] {
        let world = Memory::default().with("v.csv", format!("speed [rpm],{header}\n60,30\n"));
        let requested = vary(&["@v.csv"]);
        let mechc::Error { sources, diagnostics, .. } =
            subject.checked.variants(&requested, &subject.choice, &world).expect_err("that column is wrong");
        let one = diagnostics.iter().next().expect("a word of it");
        let span = one.labels[0].span;
        assert_eq!((sources.get(span.file).name.as_str(), sources.text(span)), ("v.csv", header));
        assert_eq!(one.help, [help], "{header}");
    }
}

#[test]
fn invalid_variations_are_refused() {
    let subject = subject(FOUR_BAR, Choice { set: vec!["share=1".to_owned()], ..Choice::default() });
    let sampled = |params: &[&str], sample| VaryOptions { sample: Some(sample), ..vary(params) };
    for (requested, wanted) in [
        (vary(&["crank_length"]), "`--vary crank_length` does not say what varies"),
        (vary(&["crank_length="]), "`--vary crank_length=` does not say what varies"),
        (vary(&["crank_length=..3mm:2"]), "`--vary crank_length=..3mm:2` does not say from where to where"),
        (vary(&["crank_length=1mm..3mm:0"]), "`0` is no number of values for `crank_length`"),
        (vary(&["crank_length=1mm..3mm:two"]), "`two` is no number of values for `crank_length`"),
        (vary(&["crank_length=1mm..3mm"]), "it is not said how many values `crank_length` has"),
        (
            sampled(&["crank_length=1mm..3mm", "speed=1rpm..2rpm:3"], 5),
            "`speed` has a number of values, and `crank_length` has none",
        ),
        (sampled(&["speed=1rpm..2rpm:3"], 5), "there is no range to take a sample of"),
        (sampled(&["speed=1rpm..2rpm"], 0), "a sample has one variant at least"),
        (
            VaryOptions { seed: Some(1), ..vary(&["speed=1rpm..2rpm:3"]) },
            "`--seed` says how a sample is taken, and there is none",
        ),
        (vary(&["speed=1rpm,2mm"]), "the parameter `speed` must be an angular velocity (rad/s), found a length"),
        (vary(&["speed=1rpm,2rpm", "speed=3rpm,4rpm"]), "`speed` is to vary twice"),
        (vary(&["share=0..1:3"]), "`share` is set, and is to vary"),
        (vary(&["pace=1..2:3"]), "mechanism `four_bar` has no parameter `pace`"),
        (vary(&["@no.csv"]), "cannot read `no.csv`: entity not found"),
        (
            vary(&["crank_length=1mm..2mm:9000000000", "speed=1rpm..2rpm:9000000000"]),
            "there are more variants than can be counted",
        ),
    ] {
        let diagnostics = subject.variants_in(&requested, &Memory::default()).expect_err("it is refused");
        assert_eq!(diagnostics, wanted);
    }
}
