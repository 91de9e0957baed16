//! Results of batched variants: they have the bits of single runs, whichever way they are computed; those in doubt are computed by single
//! runs.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support::sweeps::{Subject, bits, bits_of, subject, vary};
use mechc::{Choice, Method, Status, SweepOptions, VaryOptions, Vectors};

const FOUR_BAR: &str = "mechanism four_bar {
    param base = 4
    param arm = 1
    param rod = 3.5
    param lever = 3
    param pen_x = 1.75
    param start = 0.5
    param speed = 2
    ground { point A = (0, 0) point B = (base, 0) point O = (1, -2) }
    body crank at (0, 0, 0.5) { point A = (0, 0) point C = (arm, 0) }
    body coupler at (0.88, 0.48, 0.78) { point C = (0, 0) point D = (rod, 0) point pen = (pen_x, 1.2) }
    body rocker at (3.7, 1.5, 1.8) { point B = (-lever / 2, 0) point D = (lever / 2, 0) }
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.C, coupler.C)
    joint knee: revolute(coupler.D, rocker.D)
    joint pivot: revolute(ground.B, rocker.B)
    driver motor: rotation(main) = start + speed * t
    analysis from 0 to 3.1 every 0.31
}";

const SLIDER: &str = "mechanism slider {
    param arm = 1
    param rod = 3
    param off = 0.4
    param speed = 2
    ground { point O = (0, 0) point G = (0, off) axis way = G along (1, 0) }
    body crank at (0, 0, 1) { point O = (0, 0) point C = (arm, 0) }
    body link at (0.5, 0.8, -0.2) { point C = (0, 0) point P = (rod, 0) }
    body block at (3.3, 0.4, 0) { point P = (0, 0) axis way = P along (1, 0) }
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, link.C)
    joint knee: revolute(link.P, block.P)
    joint guide: translational(ground.way, block.way)
    driver motor: rotation(main) = 1 + speed * t
    analysis from 0 to 3.1 every 0.31
}";

/// Results of each kind, of places, velocities and accelerations.
const KINDS: [&str; 17] = [
    "top = max(y(coupler.pen))",
    "left = min(x(coupler.D))",
    "when = argmax(x(coupler.pen))",
    "stroke = max(x(rocker.D)) - min(x(rocker.D))",
    "begins = first(y(coupler.pen))",
    "ends = last(der(x(coupler.pen)))",
    "between = at(x(coupler.pen), 1.1)",
    "swing = max(angle(rocker)) - min(angle(rocker))",
    "middle = mean(y(coupler.pen))",
    "area = integral(der(x(coupler.pen)))",
    "way = integral(hypot(der(x(coupler.pen)), der(y(coupler.pen))))",
    "fastest = max(der(y(coupler.pen)))",
    "hardest = min(der(der(x(coupler.pen))))",
    "pace = max(hypot(der(x(coupler.pen)), der(y(coupler.pen))))",
    "peak = max(hypot(der(der(x(coupler.pen))), der(der(y(coupler.pen)))) / 9.81)",
    "reach = max(hypot(x(coupler.pen) - x(rocker.B), y(coupler.pen)))",
    "swiftest = argmax(2 * hypot(der(x(coupler.D)), der(y(coupler.D))))",
];

fn of(text: &str, results: &[&str]) -> Subject {
    let results = results.iter().map(|&result| result.to_owned()).collect();
    subject(text, Choice { results, ..Choice::default() })
}

fn sampled(ranges: &[&str], sample: u64) -> VaryOptions {
    VaryOptions { sample: Some(sample), method: Some(Method::Random), ..vary(ranges) }
}

/// Compares the results of each variant with those alone; gives how many went side by side, and how many completed.
fn compare(subject: &Subject, requested: &VaryOptions) -> (usize, usize) {
    let variants = subject.variants(requested);
    let block = subject.sweep(&variants, &SweepOptions::default());
    let mut complete = 0;
    for k in 0..block.len() {
        let settings = variants.settings(k as u64);
        let (status, results, _) = subject.run_single(settings.clone());
        let swept: Vec<f64> = block.results.iter().map(|column| column[k]).collect();
        assert_eq!(block.statuses[k], status, "{settings:?}");
        assert_eq!(bits(&swept), bits(&results), "{settings:?}: {swept:?} instead of {results:?}");
        complete += usize::from(status == Status::Ok);
    }
    (block.answered, complete)
}

/// Requires that results of plain variants take the batch path: the other tests pass even if each is found alone.
#[test]
fn results_of_plain_variants_are_found_side_by_side() {
    let ranges = ["rod=3.4..3.6", "lever=2.9..3.1", "base=3.9..4.1", "pen_x=0..2"];
    for kind in KINDS {
        let (abreast, complete) = compare(&of(FOUR_BAR, &[kind]), &sampled(&ranges, 20));
        // two extrema may be nearly as large
        assert!(abreast >= 18 && complete == 20, "{kind}: {abreast} of {complete}");
    }
    let (abreast, complete) = compare(&of(FOUR_BAR, &KINDS), &sampled(&ranges, 40));
    assert!(abreast >= 32 && complete == 40, "{abreast} of {complete}");
}

#[test]
fn linkage_results_match_single_runs() {
    let ranges = ["base=2..5", "arm=0.3..2", "rod=1.5..5", "lever=1.5..5", "pen_x=-2..4", "start=0..6", "speed=-4..4"];
    let mut all = 0;
    for kinds in KINDS.chunks(3) {
        let (abreast, complete) = compare(&of(FOUR_BAR, kinds), &sampled(&ranges, 120));
        assert!(abreast <= complete, "{abreast} of {complete}");
        all += abreast;
    }
    assert!(all > 60, "{all} went side by side");
}

#[test]
fn slider_results_match_single_runs() {
    let kinds =
        ["far = max(x(block.P))", "near = min(x(block.P))", "when = argmin(x(block.P))", "v = max(der(x(block.P)))"];
    let subject = of(SLIDER, &kinds);
    let (abreast, complete) = compare(&subject, &sampled(&["arm=0.8..1.2", "rod=2.5..4", "off=-0.5..0.5"], 60));
    assert_eq!((abreast, complete), (60, 60));
    // the rod may just be too short
    let (abreast, complete) = compare(&subject, &sampled(&["arm=0.2..3", "rod=0.5..4", "off=-2..2"], 90));
    assert!(abreast > 10 && abreast <= complete, "{abreast} of {complete}");
}

/// Extrema at both ends, at one of them to rounding, flat ones, two that are as large: which it is must not depend on the way.
#[test]
fn extrema_in_doubt_are_found_alone() {
    let kinds = ["far = max(x(crank.C))", "when = argmax(x(crank.C))", "least = min(y(crank.C))"];
    let subject = of(FOUR_BAR, &kinds);
    let off = [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1];
    let about = |name: &str, value: f64| {
        let values = off.iter().flat_map(|off| [value - off, value + off]).map(|value| format!("{value}"));
        format!("{name}={}", values.collect::<Vec<_>>().join(","))
    };
    // it begins at its extremum, it ends there, it comes to one twice
    for requested in [
        vec![about("start", std::f64::consts::PI), "speed=2".to_owned()],
        vec![about("start", -6.2), "speed=2".to_owned()],
        vec![about("start", 0.05), format!("speed={}", 2.0 * std::f64::consts::PI / 3.1)],
        vec!["start=1".to_owned(), about("speed", (2.0 * std::f64::consts::PI - 1.0) / 3.1)],
        vec!["start=1,-1".to_owned(), about("speed", 4.0 * std::f64::consts::PI / 3.1)],
        vec!["start=0.3".to_owned(), "speed=1e-9,1e-6,1e-3,0,10,40".to_owned()],
    ] {
        let requested: Vec<&str> = requested.iter().map(String::as_str).collect();
        let (abreast, complete) = compare(&subject, &vary(&requested));
        assert!(abreast <= complete, "{requested:?}");
    }
}

/// Results match single runs where the branch is in doubt or the motion stops.
#[test]
fn results_near_singularities_match_single_runs() {
    let subject = of(FOUR_BAR, &KINDS[..4]);
    let off = [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1];
    for (name, value) in [("lever", 1.5), ("rod", 6.0), ("arm", 2.5)] {
        let values = off.iter().flat_map(|off| [value - off, value + off]).map(|value| format!("{value}"));
        let requested = format!("{name}={}", values.collect::<Vec<_>>().join(","));
        let (abreast, complete) = compare(&subject, &vary(&[&requested]));
        assert!(abreast <= complete, "{requested}");
    }
    // what stops beside what does not
    let (abreast, complete) = compare(&subject, &vary(&["rod=3.5,0,-3.4,9,1.9,3.6,1e300,3.45,2.2", "lever=3,0,2.95"]));
    assert!(abreast > 4 && abreast <= complete, "{abreast} of {complete}");
}

/// A length has a kink where it is zero: there a variant is in doubt. Curves with a cusp, a point that rests or comes to the centre, in many
/// variants beside those.
#[test]
fn lengths_near_zero_match_single_runs() {
    let kinds = [
        "least = min(hypot(x(crank.C) - x(crank.A), y(crank.C)))",
        "slowest = min(hypot(der(x(coupler.pen)), der(y(coupler.pen))))",
        "when = argmin(hypot(der(x(coupler.D)), der(y(coupler.D))))",
        "nearest = min(hypot(x(coupler.pen) - 1, y(coupler.pen) - 1.2))",
        "farthest = max(hypot(x(coupler.pen) - 1, y(coupler.pen) - 1.2))",
        "begins = first(hypot(x(coupler.pen), y(coupler.pen)))",
        "ends = last(hypot(der(x(coupler.pen)), der(y(coupler.pen))))",
        "between = at(hypot(der(x(coupler.pen)), der(y(coupler.pen))), 1.1)",
        "hardest = max(hypot(der(der(x(coupler.D))), der(der(y(coupler.D)))))",
    ];
    let mut all = 0;
    for kinds in kinds.chunks(3) {
        let (abreast, complete) =
            compare(&of(FOUR_BAR, kinds), &sampled(&["rod=2.5..4.5", "lever=2..3.5", "pen_x=-1..3", "start=0..6"], 24));
        assert!(abreast <= complete, "{abreast} of {complete}");
        all += abreast;
    }
    assert!(all > 12, "{all} went side by side");
    // the end of the crank at the centre of what it turns about
    let (_, complete) =
        compare(&of(FOUR_BAR, &["zero = max(hypot(x(crank.A), y(crank.A)))"]), &sampled(&["rod=3.4..3.6"], 6));
    assert_eq!(complete, 6);
}

/// Distances, magnitudes, and lengths of which one leg rests, are lengths too; with what goes through zero, and what may.
#[test]
fn distances_and_magnitudes_are_found_side_by_side() {
    let kinds = [
        "far = max(distance(coupler.pen, ground.O))",
        "near = min(distance(coupler.pen, ground.O))",
        "when = argmax(distance(rocker.D, ground.O) / base)",
        "pace = max(speed(coupler.pen))",
        "wide = max(abs(x(coupler.pen)))",
        "hardest = max(abs(der(der(x(coupler.D)))))",
        "reach = max(hypot(x(coupler.D), 1))",
        "root = min(sqrt(x(coupler.D)^2 + 4 * y(coupler.D)^2 + 0.1))",
    ];
    let mut all = 0;
    for kind in kinds {
        let subject = of(FOUR_BAR, &[kind]);
        let (abreast, complete) = compare(&subject, &sampled(&["rod=3.4..3.6", "lever=2.9..3.1"], 12));
        assert!(abreast >= 10 && complete == 12, "{kind}: {abreast} of {complete}");
        let ranges = ["rod=2.5..4.5", "lever=2..3.5", "pen_x=-1..3", "start=0..6", "speed=-2..2"];
        let (abreast, complete) = compare(&subject, &sampled(&ranges, 24));
        assert!(abreast <= complete, "{kind}: {abreast} of {complete}");
        all += abreast;
    }
    assert!(all > 40, "{all} went side by side");
}

/// What rests has its largest value and its least one at both ends, and nothing tells it from one that moves a little but how much.
#[test]
fn rests_are_found_in_batches() {
    let kinds = [
        "pace = max(speed(crank.C))",
        "slowest = min(speed(crank.C))",
        "radius = max(distance(crank.C, crank.A))",
        "when = argmin(distance(crank.C, ground.A))",
        "square = max(x(crank.C)^2 + y(crank.C)^2)",
    ];
    for kind in kinds {
        let (abreast, complete) = compare(&of(FOUR_BAR, &[kind]), &sampled(&["rod=3.4..3.6", "arm=0.8..1.1"], 12));
        assert!(abreast >= 10 && complete == 12, "{kind}: {abreast} of {complete}");
    }
    // the closing of a loop leaves more than rounding, so that it may be alone
    let (_, complete) =
        compare(&of(FOUR_BAR, &["long = max(distance(coupler.C, rocker.D))"]), &sampled(&["rod=3.4..3.6"], 6));
    assert_eq!(complete, 6);
    // nearly at rest, about a centre that is nearly its own
    let kinds = [
        "far = max(hypot(x(crank.C) - base * pen_x, y(crank.C)))",
        "when = argmax(hypot(x(crank.C) - pen_x, y(crank.C)))",
    ];
    let (_, complete) =
        compare(&of(FOUR_BAR, &kinds), &vary(&["pen_x=0,1e-17,1e-16,3e-16,1e-15,1e-14,1e-12,1e-9,1e-6"]));
    assert_eq!(complete, 9);
}

/// Results that are not smooth, are nested or have a window run alone, with rows and without.
#[test]
fn ineligible_results_run_alone() {
    let requested = sampled(&["rod=3.4..3.6", "lever=2.9..3.1"], 6);
    for other in [
        "far = max(abs(x(coupler.pen)) + y(coupler.pen))",
        "slope = max(x(coupler.pen) / y(coupler.pen))",
        "mean_height = mean(y(coupler.pen), to 1)",
        "middle = mean(abs(x(coupler.pen)))",
        "off = max(x(coupler.pen) + t)",
    ] {
        let subject = of(FOUR_BAR, &["top = max(y(coupler.pen))", other]);
        let (abreast, complete) = compare(&subject, &requested);
        assert_eq!((abreast, complete), (0, 6), "{other}");
    }
    // outside the analysis
    let subject = of(FOUR_BAR, &["late = at(x(coupler.pen), speed)"]);
    let (abreast, complete) = compare(&subject, &vary(&["speed=1,2,3,3.2,-1"]));
    assert_eq!((abreast, complete), (3, 3));
}

#[test]
fn threads_vectors_rows_and_shares_change_no_bit_of_results() {
    let subject = of(FOUR_BAR, &KINDS);
    let variants = subject.variants(&sampled(&["rod=2..4", "lever=1.4..4", "arm=0.5..1.5"], 100));
    let whole = subject.sweep(&variants, &SweepOptions { jobs: Some(1), ..SweepOptions::default() });
    assert!((20..100).contains(&whole.answered), "{}", whole.answered);
    for name in Vectors::NAMES {
        let Some(vectors) = Vectors::named(name) else { continue };
        for jobs in [1, 2, 16] {
            let swept =
                subject.sweep(&variants, &SweepOptions { jobs: Some(jobs), vectors, ..SweepOptions::default() });
            assert_eq!(bits_of(&swept), bits_of(&whole), "{name}, {jobs} threads");
        }
    }
    let beside = subject.sweep(&variants, &subject.all_columns());
    let all = |columns: &[Vec<f64>]| columns.iter().flat_map(|column| bits(column)).collect::<Vec<_>>();
    assert_eq!(all(&beside.results), all(&whole.results));
    for skip in [1, 7, 33] {
        let share = subject.sweep(&variants, &SweepOptions { skip, take: Some(20), ..SweepOptions::default() });
        for (column, known) in share.results.iter().zip(&whole.results) {
            assert_eq!(bits(column), bits(&known[skip as usize..skip as usize + 20]), "from {skip} on");
        }
    }
}

/// A sweep with `until` ends at the same variant as single runs.
#[test]
fn the_variant_that_is_looked_for_is_the_same() {
    let until = Choice { until: Some("max(y(coupler.pen)) > 2.45".to_owned()), ..Choice::default() };
    let subject = subject(FOUR_BAR, until);
    let variants = subject.variants(&sampled(&["rod=3.4..3.6", "lever=2.9..3.1", "pen_x=0..2"], 100));
    let found = subject.sweep(&variants, &SweepOptions::default());
    let beside = subject.sweep(&variants, &subject.all_columns());
    assert!((1..100).contains(&found.len()), "{}", found.len());
    assert_eq!((found.len(), found.answered), (beside.len(), found.len()));
}
