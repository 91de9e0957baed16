//! Batches of sweep variants: each lane has the bits of a single run, and so do variants that leave their lane because their branch is in
//! doubt.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support::sweeps::{Subject, bits, bits_of, compare_all, count, have_equal_bits, subject, vary};
use mechc::{
    Cancel, Choice, EvaluationPoint, EvaluatorOptions, InputMotion, Memory, Method, Parsed, RequestedTimes, Status,
    SweepOptions, Swept, Variants, VaryOptions, Vectors,
};
use std::collections::VecDeque;

/// A four-bar that is turned once, or to and fro, by what is said of it.
fn four_bar(turn: &str, every: &str) -> String {
    format!(
        "mechanism four_bar {{
            param base = 4
            param arm = 1
            param rod = 3.5
            param lever = 3
            param pen_x = 1.75
            param speed = 2
            param rise = speed^2 / 4 + 1
            ground {{ point A = (0, 0) point B = (base, 0) }}
            body crank at (0, 0, 0.5) {{ point A = (0, 0) point C = (arm, 0) }}
            body coupler at (0.88, 0.48, 0.78) {{ point C = (0, 0) point D = (rod, 0) point pen = (pen_x, rise / 2) }}
            body rocker at (3.7, 1.5, 1.8) {{ point B = (-lever / 2, 0) point D = (lever / 2, 0) }}
            joint main: revolute(ground.A, crank.A)
            joint pin: revolute(crank.C, coupler.C)
            joint knee: revolute(coupler.D, rocker.D)
            joint pivot: revolute(ground.B, rocker.B)
            driver motor: rotation(main) = {turn}
            measure height = y(coupler.pen)
            measure reach = hypot(x(coupler.pen), y(coupler.pen))
            analysis from 0 to 3.15 every {every}
        }}"
    )
}

const TURNS: &str = "0.5 + speed * t";

fn sampled(ranges: &[&str], sample: u64, method: Method) -> VaryOptions {
    VaryOptions { sample: Some(sample), method: Some(method), ..vary(ranges) }
}

/// Values about one, as a list that `--vary` reads.
fn about(name: &str, value: f64) -> String {
    let off = [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1];
    let values = off.iter().flat_map(|off| [value - off, value + off]).map(|value| format!("{value}"));
    format!("{name}={}", values.collect::<Vec<_>>().join(","))
}

fn compare(subject: &Subject, requested: &VaryOptions) -> (Vec<(Status, usize)>, usize) {
    compare_all(subject, &subject.variants(requested))
}

/// Requires that plain variants take the batch path: the other tests pass even if every variant runs alone.
#[test]
fn plain_variants_are_batched() {
    let ranges = ["rod=3.4..3.6", "lever=2.9..3.1", "base=3.9..4.1", "speed=1..3", "pen_x=-1..2"];
    for every in ["0.05", "1.575"] {
        let subject = subject(&four_bar(TURNS, every), Choice::default());
        for method in [Method::Sobol, Method::Random] {
            let (found, batched) = compare(&subject, &sampled(&ranges, 40, method));
            assert_eq!((count(&found, Status::Ok), batched), (40, 40), "every {every}: {found:?}");
        }
    }
}

/// Drivers of any smooth formula go in lanes; where one turns back, or has a pulse that no output time shows, steps are shorter.
#[test]
fn smooth_drivers_are_batched() {
    let turns = [
        ("0.5 + speed * sin(2 * t)", ["rod=3.4..3.6", "speed=0.2..0.6"]),
        ("0.5 + 0.3 * sin(t) * cos(5 * t) + speed * t^2 / 9", ["lever=2.9..3.1", "base=3.9..4.1"]),
        ("0.5 + speed * sin(11 * t)", ["rod=3.4..3.6", "lever=2.9..3.1"]),
        ("0.5 + speed * exp(-((t - 1.6) / 0.01)^2)", ["rod=3.4..3.6", "lever=2.9..3.1"]),
    ];
    for (turn, ranges) in turns {
        for every in ["0.05", "0.63"] {
            let subject = subject(&four_bar(turn, every), Choice::default());
            let (found, in_lanes) = compare(&subject, &sampled(&ranges, 40, Method::Sobol));
            assert_eq!((count(&found, Status::Ok), in_lanes), (40, 40), "{turn} every {every}: {found:?}");
        }
    }
}

/// A swinging carrier with two gears on it, of which the big one is driven.
const GEARS: &str = "mechanism gears {
    param big_radius = 0.6
    param small_radius = 0.25
    param speed = 1
    ground { point O = (0, 0) }
    body carrier at (0, 0, 0.3) { point O = (0, 0) point pin = (big_radius + small_radius, 0) }
    body big at (0, 0, 0) { point O = (0, 0) circle pitch = O radius big_radius }
    body small at (0.8, 0.29, 1.5) { point O = (0, 0) circle pitch = O radius small_radius }
    joint hub: revolute(ground.O, carrier.O)
    joint axle: revolute(ground.O, big.O)
    joint pin: revolute(carrier.pin, small.O)
    joint mesh: gear(big.pitch, small.pitch, 0.1)
    driver swing: rotation(hub) = 0.3 + 0.5 * t
    driver motor: rotation(axle) = 0.1 - 0.8 * speed * t
    measure spin = angle(carrier, small)
    result farthest = max(spin)
    analysis from 0 to 4 every 0.1
}";

/// A crank-slider whose slider, a rack, turns a pinion.
const RACK: &str = "mechanism rack {
    param arm = 1
    param rod = 3
    param pitch_radius = 0.4
    param speed = 2
    ground { point O = (0, 0) point P = (3, 0.5) axis way = (0, 0) along (1, 0) }
    body crank at (0, 0, 1) { point O = (0, 0) point C = (arm, 0) }
    body link at (0.5, 0.8, -0.3) { point C = (0, 0) point D = (rod, 0) }
    body bar at (3.4, 0, 0) { point D = (0, 0) axis way = D along (1, 0) }
    body pinion at (3, 0.5, 0) { point P = (0, 0) circle pitch = P radius pitch_radius point pen = (pitch_radius, 0) }
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, link.C)
    joint knee: revolute(link.D, bar.D)
    joint guide: translational(ground.way, bar.way)
    joint axle: revolute(ground.P, pinion.P)
    joint mesh: rack_pinion(pinion.pitch, bar.way)
    driver motor: rotation(main) = 1 + speed * t
    measure height = y(pinion.pen)
    analysis from 0 to 3.1 every 0.1
}";

/// Gears and racks go in lanes, monitors and all; a slider that locks up stops as it does alone.
#[test]
fn gears_and_racks_are_batched() {
    let sine = GEARS.replace("0.3 + 0.5 * t", "0.3 + 0.5 * sin(speed * t)");
    for (text, ranges) in [
        (GEARS, ["small_radius=0.1..0.4", "big_radius=0.3..0.9", "speed=-2..2"]),
        (&sine, ["small_radius=0.1..0.4", "big_radius=0.3..0.9", "speed=0.5..2"]),
        (RACK, ["arm=0.5..1.2", "pitch_radius=0.2..0.6", "speed=-2..2"]),
    ] {
        let subject = subject(text, Choice::default());
        let (found, in_lanes) = compare(&subject, &sampled(&ranges, 40, Method::Random));
        assert_eq!((count(&found, Status::Ok), in_lanes), (40, 40), "{ranges:?}: {found:?}");
    }
    let locking = subject(RACK, Choice::default());
    let (found, in_lanes) = compare(&locking, &sampled(&["arm=0.5..2", "rod=0.8..3", "speed=0..3"], 64, Method::Sobol));
    assert!(found.len() >= 2 && in_lanes > 8 && in_lanes <= count(&found, Status::Ok), "{in_lanes} of {found:?}");
}

/// A four-bar with masses, weights, a spring and a load that has a value only while the pen is high enough.
fn loaded(load: &str) -> String {
    let text = four_bar(TURNS, "0.1")
        .replace("(0, 0, 0.5) {", "(0, 0, 0.5) { mass 2 inertia 0.1")
        .replace("(0.88, 0.48, 0.78) {", "(0.88, 0.48, 0.78) { mass rod inertia 0.2")
        .replace(
            "measure height",
            "gravity (0, -9.81) load push: {load} measure torque = effort(motor) measure height",
        );
    text.replace("{load}", load)
}

/// Reactions and efforts go in lanes, whatever branches the loads have; a load without a value stops a variant, whichever columns are
/// requested.
#[test]
fn forces_are_batched() {
    let choice = || Choice { reactions: true, results: vec!["most = max(torque)".to_owned()], ..Choice::default() };
    let ranges = ["rod=3.4..3.6", "pen_x=-1..2", "speed=1..3"];
    for load in [
        "-3 N/m * (distance(ground.B, coupler.pen) - 2 m) on distance(ground.B, coupler.pen)",
        "if der(angle(rocker)) > 0 then -speed * angle(rocker) else 0 on rotation(pivot)",
    ] {
        let subject = subject(&loaded(load), choice());
        let (found, in_lanes) = compare(&subject, &sampled(&ranges, 40, Method::Sobol));
        assert_eq!((count(&found, Status::Ok), in_lanes), (40, 40), "{load}: {found:?}");
    }
    let subject = subject(&loaded("3 N * m * sqrt((y(coupler.pen) - 0.6 m) / 1 m) on rotation(pivot)"), choice());
    let (variants, all) = (subject.variants(&sampled(&ranges, 40, Method::Sobol)), subject.all_columns());
    let (found, in_lanes) = compare_all(&subject, &variants);
    assert!(found.len() == 2 && in_lanes > 4 && in_lanes <= count(&found, Status::Ok), "{in_lanes} of {found:?}");
    let whole = subject.sweep(&variants, &all);
    for columns in [Some(vec![4, 5]), None] {
        let swept = subject.sweep(&variants, &SweepOptions { columns, ..all.clone() });
        assert_eq!(swept.statuses, whole.statuses);
        assert_eq!(bits_of(&swept).2[..4], bits_of(&whole).2[..4], "params and results");
    }
}

/// Points of an evaluator at any time go in lanes, with rates and accelerations; they have the bits of single queries.
#[test]
fn evaluated_points_match_single_queries() {
    let text = four_bar("turn", "0.5").replace("param base", "input turn = 0.5 + 2 * t param base");
    let text = text.replace("measure reach", "measure drift = der(rotation(main)) * (1 + t) measure reach");
    let checked = Parsed::new("text.mech", &text).check(&Choice::default(), &Memory::default());
    for (t, has_accelerations) in [(0.0, false), (0.0, true), (1.25, false), (1.25, true)] {
        let options = EvaluatorOptions {
            inputs: vec!["turn".to_owned()],
            has_accelerations,
            params: vec!["rod".to_owned(), "arm".to_owned()],
            ..EvaluatorOptions::default()
        };
        let evaluator = checked.evaluator(&options, &Cancel::default()).expect("it is determined");
        let point = |k: usize| {
            let x = k as f64;
            let motion = InputMotion { value: 0.1 * x - 1.0, rate: 1.0 - 0.05 * x, acceleration: 0.3 * x };
            (motion, vec![3.3 + 0.01 * x, if k == 5 { 2.9 } else { 1.0 }])
        };
        let (mut rows, none) = (Vec::new(), Cancel::default());
        let ask = |k: usize, at: &mut EvaluationPoint| {
            let (motion, params) = point(k);
            *at = EvaluationPoint { t: Some(t), inputs: vec![motion], params };
        };
        evaluator.evaluate_each(70, ask, &none, |row| rows.push(row.map(<[f64]>::to_vec).ok()));
        let times = RequestedTimes { from: Some(t), at: vec![t], ..RequestedTimes::default() };
        for (k, row) in rows.iter().enumerate() {
            let ((motion, params), mut alone) = (point(k), None);
            let followed = evaluator.follow(&[motion], &params, &times, &none, |row| alone = Some(row.to_vec()));
            let alone = alone.filter(|_| followed.is_ok());
            assert_eq!(row.as_deref().map(bits), alone.as_deref().map(bits), "point {k} at {t}, {has_accelerations}");
        }
        assert!(rows.iter().flatten().count() > 40, "most points can be reached");
    }
}

/// A pulse that turns the crank through a dead point and back between two output times stops each variant, in lanes or alone.
#[test]
fn pulses_between_rows_stop_batches_as_single_runs() {
    let text = four_bar("-1.85 + speed * exp(-((t - 1.6) / 0.02)^2)", "0.63")
        .replace("revolute(ground.B, rocker.B)", "revolute(rocker.B, ground.B)")
        .replace("rotation(main)", "rotation(pivot)");
    let subject = subject(&text, Choice::default());
    let (found, _) = compare(&subject, &sampled(&["speed=0.02..1", "rod=3.4..3.6"], 16, Method::Sobol));
    assert!(found.len() >= 2, "some stop and some do not: {found:?}");
}

#[test]
fn batched_linkages_match_single_runs() {
    let ranges = ["base=2..5", "arm=0.3..2", "rod=1.5..5", "lever=1.5..5", "speed=-2..2"];
    let mut all = 0;
    for every in ["0.15", "1.05"] {
        let subject = subject(&four_bar(TURNS, every), Choice::default());
        let (found, batched) = compare(&subject, &sampled(&ranges, 96, Method::Sobol));
        assert!(found.len() >= 3, "{found:?}");
        all += batched;
        // one that leaves its lane has not been taken for another one that did not
        assert!(batched <= count(&found, Status::Ok), "{found:?}");
    }
    assert!(all > 20, "{all} went side by side");
}

/// Where the shortest and the longest link are together as long as the other two all links come to lie on one line: there and next to it the
/// branch is in doubt.
#[test]
fn at_change_points_no_branch_is_guessed() {
    for every in ["0.21", "1.575"] {
        let subject = subject(&four_bar(TURNS, every), Choice::default());
        // arm + base = rod + lever, arm + rod = base + lever, arm + lever = base + rod
        for requested in [about("lever", 1.5), about("rod", 6.0), about("lever", 6.5), about("arm", 2.5)] {
            let (found, batched) = compare(&subject, &vary(&[&requested]));
            assert!(count(&found, Status::Ok) >= batched, "{requested}: {found:?}");
            assert!(found.iter().any(|(status, _)| !status.is_complete()), "{requested}: {found:?}");
        }
        // a parallelogram, or nearly one
        let requested = ["arm=1", "lever=1", &about("base", 3.5)];
        compare(&subject, &vary(&requested));
    }
}

/// The rocker is driven: there are two dead points, and what is asked for ends just before one, at it, or beyond.
#[test]
fn batches_stop_at_dead_points_as_single_runs_do() {
    let text = four_bar(TURNS, "0.315").replace("revolute(ground.B, rocker.B)", "revolute(rocker.B, ground.B)");
    let text = text.replace("rotation(main) = 0.5 + speed * t", "rotation(pivot) = -1.85 + speed * t / 10");
    let subject = subject(&text, Choice::default());
    // with a crank of 1 its dead points are where crank and coupler are in line: at 4.5 and 2.5 from the base
    let angle = |reach: f64| mechc_expr::math::acos((16.0 + 9.0 - reach * reach) / 24.0);
    let mut stopped = 0;
    for dead in [angle(4.5), angle(2.5)] {
        // the rocker stands at π less the angle in the triangle
        let from_start = 1.85 - (std::f64::consts::PI - dead);
        let (found, _) = compare(&subject, &vary(&[&about("speed", 10.0 * from_start / 3.15)]));
        stopped += found.iter().filter(|(status, _)| !status.is_complete()).map(|(_, count)| count).sum::<usize>();
        let (found, _) = compare(&subject, &vary(&[&about("rod", 3.5), "speed=-3,3"]));
        stopped += found.iter().filter(|(status, _)| !status.is_complete()).map(|(_, count)| count).sum::<usize>();
    }
    assert!(stopped > 20, "{stopped} stopped");
}

/// Variants on both sides of the end of reach match single runs.
#[test]
fn batches_assemble_at_the_end_of_reach() {
    let subject = subject(&four_bar(TURNS, "0.5"), Choice::default());
    // at the start the crank's pin is so far from the base
    let (sin, cos) = mechc_expr::math::sin_cos(0.5);
    let way = mechc_expr::math::hypot(4.0 - cos, sin);
    for requested in [about("rod", way - 3.0), about("lever", way - 3.5), about("rod", way + 3.0)] {
        let (found, batched) = compare(&subject, &vary(&[&requested]));
        assert!(count(&found, Status::Ok) >= batched && found.len() >= 2, "{requested}: {found:?}");
    }
}

/// Rows are known to be there without being followed once more; what is asked of the whole motion is as it is alone.
#[test]
fn lane_results_match_single_runs() {
    let results = ["top = max(height)", "when = argmax(height)", "mean_reach = mean(reach)", "late = at(height, 3)"];
    let results = results.iter().map(|&result| result.to_owned()).collect();
    let subject = subject(&four_bar(TURNS, "0.45"), Choice { results, ..Choice::default() });
    let requested = sampled(&["rod=2..4", "lever=2..4", "pen_x=-1..2"], 24, Method::Sobol);
    let (found, batched) = compare(&subject, &requested);
    assert!(batched > 8 && batched <= count(&found, Status::Ok), "{batched} of {found:?}");
    let alone = subject.sweep(&subject.variants(&requested), &SweepOptions::default());
    let beside = subject.sweep(&subject.variants(&requested), &subject.all_columns());
    // results are in doubt earlier than rows
    assert!(alone.abreast > 8 && alone.abreast <= batched, "{} of {batched}", alone.abreast);
    assert_eq!(alone.statuses, beside.statuses);
    for (alone, beside) in alone.results.iter().zip(&beside.results) {
        assert!(have_equal_bits(alone, beside), "{alone:?} {beside:?}");
    }
}

/// A variant that stops, or is no valid mechanism, does not change the others.
#[test]
fn leaving_a_lane_does_not_affect_others() {
    let subject = subject(&four_bar(TURNS, "0.315"), Choice::default());
    let rods = ["3.5", "0", "-3.4", "9", "1.9", "3.6", "1e300", "3.45", "2.2", "0.1"];
    let requested = [format!("rod={}", rods.join(",")), "lever=3,0,2.95".to_owned()];
    let (found, batched) = compare(&subject, &vary(&[&requested[0], &requested[1]]));
    assert!(found.len() >= 3 && batched >= 5, "{batched} of {found:?}");
}

#[test]
fn threads_vectors_and_columns_change_no_bit() {
    let subject = subject(&four_bar(TURNS, "0.21"), Choice::default());
    let variants = subject.variants(&sampled(&["rod=2..4", "lever=1.4..4", "arm=0.5..1.5"], 100, Method::Sobol));
    let all = subject.all_columns();
    let whole = subject.sweep(&variants, &SweepOptions { jobs: Some(1), ..all.clone() });
    assert!((20..100).contains(&whole.abreast), "{}", whole.abreast);
    for name in Vectors::NAMES {
        let Some(vectors) = Vectors::named(name) else { continue };
        for jobs in [1, 2, 16] {
            let swept = subject.sweep(&variants, &SweepOptions { jobs: Some(jobs), vectors, ..all.clone() });
            assert_eq!(bits_of(&swept), bits_of(&whole), "{name}, {jobs} threads");
        }
    }
    for columns in [vec![4, 5], vec![0], vec![9, 1, 9], Vec::new()] {
        let swept = subject.sweep(&variants, &SweepOptions { columns: Some(columns.clone()), ..all.clone() });
        assert_eq!(swept.statuses, whole.statuses);
        for (column, from) in swept.columns.iter().zip(&columns) {
            assert!(have_equal_bits(column, &whole.columns[*from]), "column {from} of {columns:?}");
        }
    }
    // other groups, other neighbours
    for skip in [1, 7, 33] {
        let share = subject.sweep(&variants, &SweepOptions { skip, take: Some(20), ..all.clone() });
        let first: usize = whole.lengths[..skip as usize].iter().sum();
        let rows: usize = share.lengths.iter().sum();
        for (column, known) in share.columns.iter().zip(&whole.columns) {
            assert!(have_equal_bits(column, &known[first..first + rows]), "from {skip} on");
        }
    }
}

/// Compares a block with its variants, one after the other.
fn assert_holds_those_alone(subject: &Subject, variants: &Variants, block: &Swept) {
    for (k, number) in (block.first..).take(block.len()).enumerate() {
        let (status, _, rows) = subject.run_single(variants.settings(number));
        assert_eq!((block.statuses[k], block.lengths[k]), (status, rows.len()));
        let first: usize = block.lengths[..k].iter().sum();
        for (at, row) in rows.iter().enumerate() {
            let swept: Vec<f64> = block.columns.iter().map(|column| column[first + at]).collect();
            assert!(have_equal_bits(&swept, row), "{number}, row {at}");
        }
    }
}

/// Columns are written where those of other variants stood before, of which some have one number throughout: another one, or the same.
#[test]
fn memory_that_held_other_variants_holds_these() {
    let subject = subject(&four_bar(TURNS, "1.575"), Choice::default());
    let rods = (0..40).map(|k| format!("{}", 3.4 + 0.005 * f64::from(k))).collect::<Vec<_>>().join(",");
    for requested in [["speed=1,2,2,1,3", &format!("rod={rods}")], ["speed=1,2,2,1,3", &format!("rod={rods},9")]] {
        let variants = subject.variants(&vary(&requested));
        // each is dropped before the next one is made, or stays for a while, as threads have it that read
        for (jobs, stay) in [(1, 0), (3, 4)] {
            let options = SweepOptions { jobs: Some(jobs), ..subject.all_columns() };
            let mut blocks =
                subject.checked.sweep(&subject.compiled, &variants, &options, |block| block).expect("times");
            let mut read: VecDeque<Swept> = blocks.by_ref().take(stay).collect();
            let mut count = 0;
            loop {
                read.extend(blocks.next());
                let Some(block) = read.pop_front() else { break };
                assert!(block.len() <= 64, "several blocks have the same memory");
                assert_holds_those_alone(&subject, &variants, &block);
                count += block.len() as u64;
            }
            assert_eq!(count, variants.points().count());
        }
    }
}

/// What is the same for all variants is learned from those that come first, of which none gets to its end, or not all; where a crank's length or
/// its speed varies, its place or its turn is not the same.
#[test]
fn shared_values_match_single_runs() {
    let subject = subject(&four_bar(TURNS, "0.045"), Choice::default());
    let locking = (0..36).map(|k| 1.5 + 0.0125 * f64::from(k));
    let turning = (0..40).map(|k| 3.4 + 0.005 * f64::from(k));
    let rods = locking.chain(turning).map(|rod| format!("{rod}")).collect::<Vec<_>>().join(",");
    for more in ["pen_x=1", "pen_x=1,2", "arm=1,0.95", "speed=2,1.9"] {
        for requested in [[more, &format!("rod={rods}")], [&format!("rod={rods}"), more]] {
            let (found, batched) = compare(&subject, &vary(&requested));
            assert!(batched >= 40 && count(&found, Status::Ok) < 150 && found.len() == 2, "{batched} of {found:?}");
        }
    }
}

/// A motion with so many rows keeps no numbers but the times.
#[test]
fn long_motions_match_single_runs() {
    let subject = subject(&four_bar(TURNS, "0.00008"), Choice::default());
    assert!(subject.all_columns().columns.expect("all").len() * 39_375 > 1 << 20);
    let (found, batched) = compare(&subject, &vary(&["rod=3.4,3.5,3.6"]));
    assert_eq!((count(&found, Status::Ok), batched), (3, 3));
}

/// Rows that are near to each other are led on by velocities alone: they are the same ones, also where variants are much faster than the file's own
/// values have it, lock up, or come by where branches meet.
#[test]
fn close_rows_match_single_runs() {
    let driven = four_bar(TURNS, "0.015").replace("revolute(ground.B, rocker.B)", "revolute(rocker.B, ground.B)");
    let driven = driven.replace("rotation(main) = 0.5 + speed * t", "rotation(pivot) = -1.85 + speed * t / 10");
    let shapes = ["base=2..5", "arm=0.3..2", "rod=1.5..5", "lever=1.5..5", "speed=-20..20"];
    let sampled = sampled(&shapes, 150, Method::Random);
    let (changing, locking) = (vary(&[&about("rod", 6.0), "lever=2.9,3"]), vary(&["speed=-3..3:40", "rod=3.4..3.6:3"]));
    for (text, requested, least) in [
        (four_bar(TURNS, "0.015"), sampled, 20),
        (four_bar(TURNS, "0.015"), changing, 1),
        (four_bar("0.5 - 3 * speed * t", "0.005"), vary(&["rod=3.4..3.6:5", "speed=0..9:7"]), 20),
        (driven, locking, 1),
    ] {
        let subject = subject(&text, Choice::default());
        let (variants, all) = (subject.variants(&requested), subject.all_columns());
        let (found, batched) = compare_all(&subject, &variants);
        assert!(batched >= least, "{batched} of {found:?}");
        let whole = subject.sweep(&variants, &all);
        // positions of the last body, and its velocities
        for columns in [vec![7, 8, 9], vec![18, 19]] {
            let swept = subject.sweep(&variants, &SweepOptions { columns: Some(columns.clone()), ..all.clone() });
            assert!(swept.abreast >= least, "{} of {:?}", swept.abreast, swept.statuses);
            assert_eq!((&swept.statuses, &swept.lengths), (&whole.statuses, &whole.lengths));
            for (column, from) in swept.columns.iter().zip(&columns) {
                assert!(have_equal_bits(column, &whole.columns[*from]), "column {from} of {requested:?}");
            }
        }
    }
}

/// Of a zero the text's check decides other things than of other values; times may be a list that begins later than the motion; and a text
/// may say nothing but values.
#[test]
fn individual_zeros_and_times_match_single_runs() {
    let text = four_bar(TURNS, "0.5").replace("param rise", "param P = (0.4, 0.3) param rise");
    let text = text.replace("point pen = (pen_x, rise / 2)", "point pen = P + (pen_x, 0)");
    let subject = subject(&text, Choice::default());
    for requested in [["P.x=0,0.1,-0.2", "pen_x=0.5,0"], ["P.x=-0.1,0", "P.y=0,0.2"], ["speed=0,1,2", "rod=3.4,3.5"]] {
        let (found, batched) = compare(&subject, &vary(&requested));
        assert!(
            batched >= 1 && batched < found.iter().map(|(_, count)| count).sum(),
            "{requested:?}: {batched} of {found:?}"
        );
    }
    let variants = subject.variants(&vary(&["rod=3.3..3.7:9"]));
    let all = subject.sweep(&variants, &subject.all_columns());
    let times = RequestedTimes { at: vec![1.5, 3.0], ..RequestedTimes::default() };
    let some = subject.sweep(&variants, &SweepOptions { times, ..subject.all_columns() });
    assert_eq!((some.abreast, &some.lengths), (9, &vec![2; 9]));
    let rows = all.lengths[0];
    for (some, all) in some.columns.iter().zip(&all.columns) {
        let wanted: Vec<f64> = (0..9).flat_map(|k| [all[k * rows + 3], all[k * rows + 6]]).collect();
        assert!(have_equal_bits(some, &wanted));
    }
}

/// On the way to its params a mechanism may come over an edge, or to an end, that it does not meet at either of its ends.
#[test]
fn events_in_batches_match_single_runs() {
    for (from, to) in [
        ("(arm, 0)", "(arm - mod(arm, 1) + mod(arm, 1), 0)"),
        ("(arm, 0)", "(abs(arm - 1.2) + 0.8, 0)"),
        ("(base, 0)", "(4 + sqrt((arm - 1.1) * (arm - 1.3) + 0.0001), 0)"),
        // smooth, but not linear in the params
        ("(base, 0)", "(4 + arm * lever / 100, 0)"),
        ("(base, 0)", "(4 + 0.1 * sin(9 * arm), 0)"),
    ] {
        let text = four_bar(TURNS, "0.5").replace(from, to);
        let (found, batched) =
            compare(&subject(&text, Choice::default()), &vary(&["arm=1,1.05,1.21,1.4,2.1", "lever=3,3.1"]));
        let is_smooth = to.contains("lever") || to.contains("sin");
        assert!(batched > 0 || !is_smooth, "{to}: {found:?}");
    }
}

/// Variants that batches do not support run alone.
#[test]
fn complex_variants_run_alone() {
    let plain = four_bar(TURNS, "0.5");
    let requested = vary(&["rod=3.45,3.55", "speed=1.5"]);
    let of = |text: &str| compare(&subject(text, Choice::default()), &requested).1;
    assert_eq!(of(&plain), 2);
    for (from, to) in [
        // a driver with an edge
        ("0.5 + speed * t", "0.5 + max(speed * t, 1)"),
        // an analysis that goes with a param, and a formula that is decided by one
        ("every 0.5", "every speed / 3"),
        ("/ 4 + 1", "/ 4 + (if speed < 1.7 then 1 else 2)"),
    ] {
        let text = plain.replace(from, to);
        assert_ne!(text, plain);
        let went = of(&text);
        // what stays the same decides nothing: the speed is the same in both variants
        let wanted = if from.starts_with("every") || from.starts_with('/') { 2 } else { 0 };
        assert_eq!(went, wanted, "{to}");
    }
    let two = vary(&["rod=3.45", "speed=1.5,1.9"]);
    for (from, to) in [("every 0.5", "every speed / 3"), ("/ 4 + 1", "/ 4 + (if speed < 1.7 then 1 else 2)")] {
        let subject = subject(&plain.replace(from, to), Choice::default());
        assert_eq!(compare_one_by_one(&subject, &two), 1, "{to}");
    }
}

/// Compares as [`compare`] does, for variants with other times; returns the number of variants that ran in batches.
fn compare_one_by_one(subject: &Subject, requested: &VaryOptions) -> usize {
    compare(subject, requested).1
}
