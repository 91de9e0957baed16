//! What tolerances make of measures and results: derivatives against differences of motions that are led over, sums by hand, corners, and
//! what cannot be asked.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![allow(clippy::disallowed_methods)] // what is wanted need not have the same bits everywhere

use crate::support;
use crate::support::sweeps::ROCKER;

use mechc::{
    Cancel, Checked, Choice, Compiled, CornerReport, OutputSensitivity, Parsed, Redundant, RunOptions, SweepOptions,
    Times, Tolerance, Tolerancing,
};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;

struct Subject {
    parsed: Parsed,
    choice: Choice,
    checked: Checked,
    compiled: Compiled,
}

fn subject_with(text: &str, choice: Choice) -> Subject {
    let parsed = Parsed::new("text.mech", text);
    let choice = Choice { lead: true, ..choice };
    let checked = parsed.check(&choice, &WORLD);
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{:?} {messages:?}", checked.diagnostics()));
    Subject { parsed, choice, checked, compiled }
}

fn subject(text: &str, results: &[&str]) -> Subject {
    subject_with(text, Choice { results: results.iter().map(|&of| of.to_owned()).collect(), ..Choice::default() })
}

/// Returns the messages of an error.
fn reported(why: mechc::Error) -> String {
    why.diagnostics.into_iter().map(|diagnostic| diagnostic.message).collect::<Vec<_>>().join("; ")
}

impl Subject {
    fn tolerancing(&self, requested: &[&str]) -> Result<Tolerancing<'_>, String> {
        let requested: Vec<String> = requested.iter().map(|&of| of.to_owned()).collect();
        self.checked.tolerancing(&requested, &self.choice, &WORLD).map_err(reported)
    }

    fn affected(&self, requested: &[&str]) -> (Vec<Tolerance>, Vec<OutputSensitivity>) {
        let of = self.tolerancing(requested).unwrap_or_else(|why| panic!("{why}"));
        let affected = of.sensitivities(&self.compiled, &SweepOptions::default()).map_err(reported);
        (of.tolerances().to_vec(), affected.unwrap_or_else(|why| panic!("{why}")))
    }

    fn verified(&self, requested: &[&str]) -> (Vec<Tolerance>, Vec<OutputSensitivity>, CornerReport) {
        let of = self.tolerancing(requested).unwrap_or_else(|why| panic!("{why}"));
        let options = SweepOptions { jobs: Some(1), ..SweepOptions::default() };
        let affected = of.sensitivities(&self.compiled, &options).map_err(reported).expect("it runs");
        let mut count = 0;
        let verified = of.verify(&self.compiled, &affected, &options, |more| count += more);
        assert_eq!(count, of.count(&affected), "as many as were told before");
        (of.tolerances().to_vec(), affected, verified.map_err(reported).expect("it runs"))
    }

    /// What is affected, as `run --lead --set` has it with a param of another value (SI); no numbers where it does not come to its end.
    fn at(&self, affected: &[OutputSensitivity], (name, value, unit): (&str, f64, &str)) -> Vec<f64> {
        let mut choice = self.choice.clone();
        choice.set.push(format!("{name}={value}{unit}"));
        let nothing = vec![f64::NAN; affected.len()];
        let checked = self.parsed.check(&choice, &WORLD);
        let Some(compiled) = checked.compile(Redundant::Refused, &Cancel::default()).0 else { return nothing };
        let columns = compiled.columns();
        let mut times: Vec<f64> = affected.iter().filter_map(|of| of.at).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let from = compiled.analysis().expect("an analysis")[0];
        let rows = rows(&compiled, &Times::listed(from, times.clone())).0;
        let results = rows_and_results(&compiled);
        let mut results = results.into_iter();
        let of = |of: &OutputSensitivity| match of.at {
            None => results.next().unwrap_or(f64::NAN),
            Some(t) => {
                let column = columns.iter().position(|column| *column == of.name).expect("a column");
                let row = times.iter().position(|time| time.total_cmp(&t).is_eq()).expect("a row");
                rows.get(row).map_or(f64::NAN, |row| row[column])
            }
        };
        affected.iter().map(of).collect()
    }

    /// The derivatives of what is affected by a tolerance, by differences, and how far these are certain.
    fn differences(&self, affected: &[OutputSensitivity], of: &Tolerance) -> Vec<(f64, f64)> {
        let unit = behind_a_number(&of.si);
        let step = 2e-3 * if of.nominal == 0.0 { 0.01 } else { of.nominal.abs() };
        let slopes = |h: f64| -> Vec<f64> {
            let [more, less] = [h, -h].map(|h| self.at(affected, (&of.name, of.nominal + h, unit.as_str())));
            more.iter().zip(&less).map(|(more, less)| (more - less) / (2.0 * h)).collect()
        };
        let [coarse, middle, fine] = [step, 0.5 * step, 0.25 * step].map(slopes);
        let richer = |coarse: f64, fine: f64| (4.0 * fine - coarse) / 3.0;
        let one = |k: usize| {
            let [first, second] = [richer(coarse[k], middle[k]), richer(middle[k], fine[k])];
            (second, (second - first).abs())
        };
        (0..affected.len()).map(one).collect()
    }
}

/// A unit behind a number: ` m`, `/s`.
fn behind_a_number(unit: &str) -> String {
    match unit.strip_prefix('1') {
        Some(rest) => rest.to_owned(),
        None => format!(" {unit}"),
    }
}

const WORLD: Folder = Folder;

/// The folder of the examples.
struct Folder;

impl mechc::World for Folder {
    fn read(&self, path: &std::path::Path) -> std::io::Result<mechc::Contents> {
        Ok(mechc::Contents { bytes: std::fs::read(support::root().join("examples").join(path))?.into(), version: 0 })
    }
}

fn rows(compiled: &Compiled, times: &Times) -> (Vec<Vec<f64>>, Option<mechc::Run>) {
    let Some(mut run) = compiled.run(times, &RunOptions::default()).0 else { return (Vec::new(), None) };
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) => rows.push(row.to_vec()),
            Err(_) => return (rows, None),
        }
    }
    (rows, Some(run))
}

fn rows_and_results(compiled: &Compiled) -> Vec<f64> {
    let run = rows(compiled, &compiled.times().expect("an analysis")).1;
    let values = run.and_then(|mut run| run.results()).unwrap_or_default().values;
    values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// Compares derivatives with differences; gives how many there are, and how many of them are known.
#[track_caller]
fn compare(subject: &Subject, requested: &[&str]) -> (usize, usize) {
    let (tolerances, affected) = subject.affected(requested);
    let (mut all, mut known) = (0, 0);
    for (j, tolerance) in tolerances.iter().enumerate() {
        for (of, (wanted, certain)) in affected.iter().zip(subject.differences(&affected, tolerance)) {
            // what differences do not agree on among themselves, as beside an edge, is not looked at
            let size = f64::max(wanted.abs(), 1e-3 * of.nominal.abs() / tolerance.nominal.abs().max(1e-3));
            if (certain.is_nan() || certain > 1e-4 * size) && wanted.abs() > 1e-9 {
                continue;
            }
            all += 1;
            let Some(slope) = of.slopes[j] else { continue };
            known += 1;
            let off = (slope - wanted).abs();
            assert!(
                off <= 1e-3 * size + 10.0 * certain + 1e-9,
                "{} by {}: {slope:e}, and by differences {wanted:e} ± {certain:e}",
                of.name,
                tolerance.name
            );
        }
    }
    (all, known)
}

/// An arm that a driver turns once a second, and a slider on its way.
fn arm(declarations: &str) -> String {
    format!(
        "mechanism m {{
    param reach = 2 m
    param rate = 1 rev/s
    param begin = 0
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) point tip = (reach, 0) }}
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = begin + rate * t
    {declarations}
}}"
    )
}

const FOUR_BAR: &str = "mechanism four_bar {
    param ground_length  = 100 mm
    param crank_length   = 30 mm
    param coupler_length = 90 mm
    param rocker_length  = 70 mm
    param pen = (45 mm, 20 mm)
    ground { point O = (0, 0)  point C = (ground_length, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (crank_length, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) {
        point A = (0, 0)  point B = (coupler_length, 0)  point P = pen
    }
    body rocker at (100 mm, 0, 80 deg) { point C = (0, 0)  point B = (rocker_length, 0) }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute(coupler.B, rocker.B)
    joint back:  revolute(ground.C, rocker.C)
    driver motor: rotation(main) = 30 deg + 1 rev/s * t
    measure height = y(coupler.P) in mm
    measure lean = angle(rocker) in deg
    result swing = max(lean) - min(lean) in deg
    result when = argmax(height)
    result rise = max(der(height))
    result push = max(abs(der(der(height))))
    result level = mean(height) in mm
    result rough = rms(der(der(lean)))
    result path = integral(speed(coupler.P))
    result begin = first(height) in mm
    result end = last(der(lean))
    result middle = at(height, 0.4)
    result both = swing * level / first(height) + when / 1 s
    analysis from 0 s to 0.9 s every 50 ms
}";

#[test]
fn derivatives_match_differences() {
    let subject = subject(FOUR_BAR, &[]);
    let requested = [
        "ground_length=0.1mm",
        "crank_length=0.1mm",
        "coupler_length=0.1mm",
        "rocker_length=0.1mm",
        "pen.x=0.1mm",
        "pen.y=0.1mm",
    ];
    let (all, known) = compare(&subject, &requested);
    // the peak of accelerations is found less exactly by some
    assert!(all > 70 && known as f64 > 0.9 * all as f64, "{known} of {all}");
}

/// Each example by its first param: its measures, its results, and such of its measures.
#[test]
fn derivatives_of_examples_match_differences() {
    let (mut all, mut known, mut texts) = (0, 0, 0);
    for path in support::files("examples", "mech") {
        let text = std::fs::read_to_string(&path).expect("an example");
        let own = Parsed::new("text.mech", text.as_str()).check(&Choice::default(), &WORLD);
        let Some(compiled) = own.compile(Redundant::Refused, &Cancel::default()).0 else { continue };
        let (system, _) = compiled.inside();
        let system = system.system();
        let is_word = |name: &String| name.chars().all(|c| c.is_alphanumeric() || c == '_');
        let mut names = system.measures().iter().map(|measure| measure.name.clone());
        let Some(measure) = names.rfind(is_word) else { continue };
        let of = |name: &str, formula: &str| format!("{name} = {formula}").replace('M', &measure);
        let results =
            [of("zz_most", "max(M)"), of("zz_least", "min(M)"), of("zz_mean", "mean(M)"), of("zz_last", "last(M)")];
        let choice = Choice { results: results.to_vec(), ..Choice::default() };
        let subject = subject_with(&text, choice);
        let params: Vec<String> = system.params().iter().take(1).map(|param| param.name.clone()).collect();
        let sizes = system
            .params()
            .iter()
            .map(|param| format!("{}{}", 1e-3 * param.value.abs().max(1e-3), behind_a_number(&param.unit())));
        let requested: Vec<String> = params.iter().zip(sizes).map(|(name, size)| format!("{name}={size}")).collect();
        let requested: Vec<&str> = requested.iter().map(String::as_str).collect();
        // one that decides what is repeated
        if subject.tolerancing(&requested).is_err() {
            continue;
        }
        let found = compare(&subject, &requested);
        println!("{}: {} of {}", path.display(), found.1, found.0);
        (all, known, texts) = (all + found.0, known + found.1, texts + 1);
    }
    println!("{known} of {all} in {texts}");
    assert!(texts > 15 && known as f64 > 0.75 * all as f64, "{known} of {all} in {texts} texts");
}

#[track_caller]
fn near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() <= 1e-9 * wanted.abs().max(1e-3), "{found} instead of {wanted}");
}

/// `x = r cos b`, so `x_r = cos b` and `x_b = −r sin b`.
#[test]
fn sums_match_manual_ones() {
    let text =
        arm("result far = first(x(arm.tip)) analysis from 0 to 1 every 0.1").replace("begin = 0", "begin = 60 deg");
    let subject = subject(&text, &[]);
    let (tolerances, affected) = subject.affected(&["reach=-200mm..100mm", "begin=0.01 rad"]);
    let of = &affected[0];
    near(of.nominal, 1.0);
    let root = 3.0_f64.sqrt();
    near(of.slopes[0].expect("a derivative"), 0.5);
    near(of.slopes[1].expect("a derivative"), -root);
    let sums = of.deviation(&tolerances, false).expect("all are known");
    let turned = 0.01 * root;
    for (found, wanted) in sums.contributions.iter().zip([[-0.1, 0.05], [-turned, turned]]) {
        (0..2).for_each(|end| near(found[end], wanted[end]));
    }
    near(sums.worst[0], -0.1 - turned);
    near(sums.worst[1], 0.05 + turned);
    let half = (0.075_f64.powi(2) + turned.powi(2)).sqrt();
    near(sums.statistical[0], -0.025 - half);
    near(sums.statistical[1], -0.025 + half);
    near(sums.sigma, half / root);
    near(sums.shares[0], (0.075 / half).powi(2));
    near(sums.shares[1], (turned / half).powi(2));
    near(of.deviation(&tolerances, true).expect("all are known").sigma, half / 3.0);
}

/// A range that is all on one side, and one that is nothing.
#[test]
fn ranges_may_lie_on_one_side() {
    let text = arm("result far = first(x(arm.tip)) analysis from 0 to 1 every 0.1");
    let subject = subject(&text, &[]);
    let (tolerances, affected, verified) = subject.verified(&["reach=-10mm..-5mm", "rate=0rpm"]);
    let sums = affected[0].deviation(&tolerances, false).expect("all are known");
    near(sums.worst[0], -0.01);
    near(sums.worst[1], -0.005);
    near(sums.sigma, 0.0025 / 3.0_f64.sqrt());
    assert_eq!(sums.shares, [1.0, 0.0]);
    assert_eq!((verified.variants, verified.are_all_corners), (2, true));
    assert!(verified.is_linear(0, &affected[0], &sums));
    // nothing at all is off
    let (tolerances, affected, verified) = subject.verified(&["reach=0mm"]);
    let sums = affected[0].deviation(&tolerances, false).expect("all are known");
    assert_eq!((sums.worst, sums.sigma, sums.shares.clone()), ([0.0; 2], 0.0, vec![0.0]));
    assert!(verified.variants == 1 && verified.is_linear(0, &affected[0], &sums));
}

/// Results of formulas of time, by a param `p`: their derivatives, or nothing where they have none that is known.
#[track_caller]
fn by_p(p: f64, cases: &[(&str, Option<f64>)]) {
    let mut declarations = format!("param p = {p} param q = 1 analysis from 0 to 1 every 0.1\n");
    for (k, (formula, _)) in cases.iter().enumerate() {
        let _ = writeln!(declarations, "result a{k} = {formula}");
    }
    let subject = subject(&arm(&declarations), &[]);
    let (_, affected) = subject.affected(&["p=0.01"]);
    for (of, (formula, wanted)) in affected.iter().zip(cases) {
        match (of.slopes[0], wanted) {
            (None, None) => {}
            (Some(found), Some(wanted)) => {
                assert!((found - wanted).abs() <= 1e-6, "{formula}: {found} instead of {wanted}");
            }
            (found, wanted) => panic!("{formula}: {found:?} instead of {wanted:?}"),
        }
    }
}

#[test]
fn isolated_extrema_have_derivatives() {
    let two = "if t < 0.5 then p * sin(tau * t)^2 else q * sin(tau * t)^2";
    // two that are alike, one of which goes with p
    by_p(
        1.0,
        &[(&format!("max({two})"), None), (&format!("argmax({two})"), None), ("min(p * sin(tau * t)^2)", Some(0.0))],
    );
    by_p(1.1, &[(&format!("max({two})"), Some(1.0)), (&format!("argmax({two})"), Some(0.0))]);
    by_p(0.9, &[(&format!("max({two})"), Some(0.0))]);
    // two that are alike, and go alike
    by_p(1.0, &[("max(p * sin(tau * t)^2)", Some(1.0)), ("argmax(p * sin(tau * t)^2)", Some(0.0))]);
    // a dwell that goes with p as a whole, and one that is tilted
    let rise = "step5(t, 0.2, 0, 0.5, 1)";
    by_p(
        0.0,
        &[
            (&format!("max((1 + p) * {rise})"), Some(1.0)),
            (&format!("max({rise} + p * (t - 0.6))"), None),
            (&format!("max({rise} + p * t^2 * (1 - t))"), None),
            (&format!("max(-{rise} + p * (1 - t))"), None),
        ],
    );
    // it begins at an edge that goes with p
    by_p(0.5, &[("max(step5(t, 0.2, 0, p, 1))", Some(0.0)), ("argmax(step5(t, 0.2, 0, p, 1))", Some(1.0))]);
    // a rise and a return that meet, without a dwell between
    let meet = "if t < p then step5(t, 0.2, 0, p, 1) else step5(t, p, 1, 1, 0)";
    by_p(
        0.5,
        &[
            (&format!("argmax({meet})"), Some(1.0)),
            (&format!("argmax({})", meet.replace("step5", "harmonic")), Some(1.0)),
        ],
    );
    // at an edge that stays, which a turn passes
    by_p(0.0, &[("argmax(p * t - (t - 0.5)^2 + max(t - 0.5, 0)^3)", Some(0.5))]);
    // flat to the fourth order
    by_p(0.0, &[("max(p * t - (t - 0.5)^4)", Some(0.5)), ("max(p * sin(t) - (t - 0.5)^2)", Some(0.5_f64.sin()))]);
    // its time: −ė_p/ë
    by_p(0.0, &[("argmax(p * t - (t - 0.5)^2)", Some(0.5)), ("argmin((t - 0.3 - p)^2)", Some(1.0))]);
}

#[test]
fn extrema_at_fixed_edges_have_derivatives() {
    by_p(
        0.4,
        &[
            // bends that stay, and go with p
            ("max(if t < 0.4 then p * t else p * (0.8 - t))", Some(0.4)),
            ("max(-abs(t - p) + 0.3 * t)", None),
            ("min(abs(t - p))", None),
            ("max(-abs(t - 0.5) + p * t)", Some(0.5)),
            // jumps likewise
            ("max(if t < p then t else 0)", None),
            ("max(if t < 0.5 then 0 else p * (1 - t))", Some(0.5)),
            ("max(if t < 0.5 then p * t else 0)", Some(0.5)),
            // also where nothing but the condition holds p
            ("min(if t < p then -t else t)", None),
            ("min(if x(arm.tip) < p * 1 m then -x(arm.tip) else x(arm.tip))", None),
            ("argmin(if x(arm.tip) < p * 1 m then -x(arm.tip) else x(arm.tip))", Some(-0.5 / (TAU * 0.96_f64.sqrt()))),
            // elsewhere they do not matter
            ("max(abs(t - p))", Some(-1.0)),
            ("max(if t < p then -1 else -(t - 0.7)^2 + p * t^2)", Some((0.7_f64 / 0.6).min(1.0).powi(2))),
        ],
    );
}

/// What rests behind an edge has not turned there, and what stands at an edge goes to one side as it does not to the other.
#[test]
fn extrema_at_moving_edges_have_no_derivative() {
    by_p(
        1.0,
        &[
            // the time is that of the jump
            ("argmin(if t < 0.5 * p then 2 + sin(t) else -3)", Some(0.5)),
            ("argmax(if t < 0.5 * p then -sin(t) else 3)", Some(0.5)),
            // times at an edge, and beside one
            ("last(abs(p - t))", None),
            ("at(abs(y(arm.tip) / 1 m - p), 1/12)", None),
            ("at(abs(y(arm.tip) / 1 m - p), 0.1)", Some(-1.0)),
            ("last(if p * t < 1 then 1 else 2)", None),
            ("max(if p * t < 1 then 1 else 2)", None),
            ("last(mod(p * t, 1))", None),
            ("at(mod(p * t, 1), 0.5)", Some(0.5)),
            ("first(atan2(p * t, 1))", Some(0.0)),
            ("last(hypot(p - t, 0 * t))", None),
            ("last(hypot(p - t, t))", Some(0.0)),
            // a turn at the end is one within the analysis to one side alone
            ("argmin(cos(p * 180 deg * t))", None),
            ("min(cos(p * 180 deg * t))", Some(0.0)),
            ("argmax(sin(p * 80 deg * t))", Some(0.0)),
            ("argmin((t - 1)^2 * p)", Some(0.0)),
        ],
    );
}

/// A switch goes with a param through a table as it does through any other function, and so does the motion.
#[test]
fn a_param_moves_a_switch_through_a_table() {
    let lift = "table lift = spline [(0 s, 0), (0.5 s, p), (1 s, 0.4)] ";
    let of = |declarations: &str, results: &str| {
        let text = arm(&format!("param p = 0.6 {declarations} {results} analysis from 0 s to 1 s every 0.1 s"));
        subject(&text, &[]).affected(&["p=0.01"]).1.iter().map(|of| of.slopes[0].is_some()).collect::<Vec<bool>>()
    };
    let results = "result a = integral(if lift(t) > 0.5 then 1 else 0) result b = mean(sign(lift(t) - 0.5))
        result c = integral(mod(lift(t), 0.4)) result d = integral(lift(t)) result e = max(lift(t))";
    assert_eq!(of(lift, results), [false, false, false, true, true]);
    // and a knot that goes takes the jump of the third derivative along
    let knot = "param k = 0.3 table q = spline [(0, 0), (p/2, 1), (1, 0)] ";
    let results =
        "result a = integral(der(der(der(q(t/1 s))))) result b = max(-t/1 s * der(der(der(q(t/1 s)))) * 1 s^3)
        result c = max(q(t/1 s)) result d = integral(q(t/1 s))";
    assert_eq!(of(knot, results), [false, false, true, true]);
}

#[test]
fn integrals_without_moving_jumps_have_derivatives() {
    by_p(
        0.4,
        &[
            ("integral(if t < p then 2 else 0)", None),
            ("mean(if t < p then 2 else 0)", None),
            ("rms(if t < p then 2 else 0)", None),
            // as much up as down
            ("integral(if abs(t - 0.5) < p then 1 else 0)", None),
            ("integral(if y(arm.tip) > p * 1 m then 1 else 0)", None),
            ("integral(3 * p * t - mod(3 * p * t, 1))", None),
            ("integral(sign(t - p) * (t - p))", Some(2.0 * 0.4 - 1.0)),
            // bends, and jumps that stay
            ("integral(max(t - p, 0))", Some(-0.6)),
            ("integral(abs(t - p))", Some(2.0 * 0.4 - 1.0)),
            ("integral(if t < 0.5 then p else 0)", Some(0.5)),
            ("integral(if y(arm.tip) > 1 m then p else 0)", Some(1.0 / 3.0)),
            ("mean(p * t^2)", Some(1.0 / 3.0)),
            ("rms(p * t)", Some((1.0_f64 / 3.0).sqrt())),
            ("integral(p * integral(p * t))", Some(0.4)),
        ],
    );
}

#[test]
fn analysis_ends_may_depend_on_params() {
    let text = arm("param p = 0.8 analysis from 0.1 * p to p every 0.1
        result a = last(t^2) result b = max(t^2) result c = argmax(t^2) result d = integral(t) result e = mean(t)
        result f = first(t) result g = argmin(t) result h = at(t^2, p / 2) result i = max(t * (1.2 - t)) result j = rms(t)");
    let subject_of = subject(&text, &[]);
    let of = |options: &SweepOptions| -> Vec<Option<f64>> {
        let tolerancing = subject_of.tolerancing(&["p=0.01"]).expect("a tolerance");
        let affected = tolerancing.sensitivities(&subject_of.compiled, options).map_err(reported).expect("it runs");
        affected.iter().map(|of| of.slopes[0]).collect()
    };
    // the mean of squares is 0.37 p², and that of t 0.55 p
    let wanted = [1.6, 1.6, 1.0, 0.8 * 0.99, 0.55, 0.1, 0.1, 0.4, 0.0, 0.37_f64.sqrt()];
    for (found, wanted) in of(&SweepOptions::default()).iter().zip(wanted) {
        near(found.expect("a derivative"), wanted);
    }
    // ends that are said beside the text stay
    let times =
        mechc::RequestedTimes { from: Some(0.08), to: Some(0.8), every: Some(0.1), ..mechc::RequestedTimes::default() };
    let stays = of(&SweepOptions { times, ..SweepOptions::default() });
    let wanted = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0];
    for (found, wanted) in stays.iter().zip(wanted) {
        near(found.expect("a derivative"), wanted);
    }
}

#[test]
fn derivatives_beyond_the_highest_order_are_missing() {
    let text = arm("measure jerk = der(der(der(x(arm.tip)))) result a = max(jerk) result b = max(der(der(x(arm.tip))))
        analysis from 0 to 1 every 0.1");
    let (_, affected) = subject(&text, &[]).affected(&["reach=1mm"]);
    let names: Vec<&str> = affected.iter().map(|of| of.name.as_str()).collect();
    assert_eq!(names, ["jerk", "a", "b"]);
    assert_eq!((affected[0].slopes[0], affected[1].slopes[0]), (None, None));
    near(affected[2].slopes[0].expect("a derivative"), TAU * TAU);
    assert_eq!(affected[0].deviation(&[], false), None, "a sum of what is not known");
}

/// Where nothing is in the way, peaks and means of forces have derivatives, and so have peaks of accelerations that are short beside the analysis.
#[test]
fn peaks_of_forces_and_accelerations_have_derivatives() {
    let text = "mechanism driven {
        param a = 30 mm
        ground { point A = (0, 0) point D = (100 mm, 0) point S = (50 mm, 90 mm) }
        body crank at (0, 0, 60 deg) { point A = (0, 0) point B = (a, 0) mass 0.3 kg at (a / 2, 0) inertia 1e-4 kg * m^2 }
        body coupler at (15 mm, 26 mm, 20 deg) {
            point B = (0, 0) point C = (90 mm, 0) point P = (40 mm, 30 mm)
            mass 0.5 kg at (40 mm, 10 mm) inertia 5e-4 kg * m^2
        }
        body rocker at (100 mm, 0, 110 deg) { point D = (0, 0) point C = (60 mm, 0) mass 0.2 kg at (30 mm, 0) inertia 1e-4 kg * m^2 }
        joint ja: revolute(ground.A, crank.A)
        joint jb: revolute(crank.B, coupler.B)
        joint jc: revolute(coupler.C, rocker.C)
        joint jd: revolute(ground.D, rocker.D)
        driver motor: rotation(ja) = 60 deg + 60 rpm * t
        gravity (0, -9.81 m/s^2)
        load spring: -200 N/m * (distance(coupler.P, ground.S) - 30 mm) on distance(coupler.P, ground.S)
        measure torque = effort(motor)
        result peak = max(torque)
        result most = max(abs(torque))
        result side = max(abs(force_x(ja)))
        result whole = max(hypot(force_x(ja), force_y(ja)))
        result middle = mean(force_x(ja))
        result fastest = max(der(der(y(coupler.P))))
        analysis from 0 s to 1 s every 0.01 s
    }";
    assert_eq!(compare(&subject(text, &[]), &["a=0.1mm"]), (7, 7), "the torque itself, and six results");
    let claw = support::text_of("examples/film_claw.mech");
    let requested =
        ["up = max(der(der(y(claw.P))))", "down = min(der(der(y(claw.P))))", "along = max(der(der(x(claw.P))))"];
    let (_, affected) = subject(&claw, &requested).affected(&["C.y=0.1mm"]);
    let slopes: Vec<f64> = affected.iter().rev().take(3).filter_map(|of| of.slopes[0]).collect();
    // by differences of 1 um and of 0.1 um
    for (found, wanted) in slopes.iter().rev().zip([2509.7, 1345.1, -11058.0]) {
        assert!((found - wanted).abs() < 1e-4 * wanted.abs(), "{found} instead of {wanted}");
    }
    assert_eq!(slopes.len(), 3);
}

/// What cannot go with a param makes nothing jump, whatever stands in it.
#[test]
fn fixed_jumps_keep_the_derivative_of_a_mean_force() {
    let text = support::text_of("examples/compressor.mech");
    let subject = subject(&text, &[]);
    let (_, affected) = subject.affected(&["rod_length=0.1mm"]);
    let by = |name: &str| affected.iter().find(|of| of.name == name).expect("a result").slopes[0];
    assert!(by("mean_torque").is_some_and(|slope| slope.abs() < 1e-9), "the work of a turn stays");
    assert!(by("swing").is_some() && by("variation").is_some());
    // where the valve opens
    assert_eq!(by("peak"), None);
    let (_, known) = compare(&subject, &["rod_length=0.1mm"]);
    assert!(known >= 5, "{known}");
}

/// A force that jumps where a load does.
#[test]
fn load_jumps_leave_no_derivative() {
    let text = arm("param push = 10 N param from = 0.5 m
        load work: if x(arm.tip) > from then push else 0 on x(arm.tip)
        result peak = max(effort(motor)) result always = integral(effort(motor)) result drop = min(effort(motor))
        analysis from 0 to 0.9 every 0.1");
    let subject = subject(&text, &[]);
    let (tolerances, affected) = subject.affected(&["push=1N", "from=1mm"]);
    assert_eq!(tolerances.len(), 2);
    let by = |name: &str, k: usize| affected.iter().find(|of| of.name == name).expect("a result").slopes[k];
    // the whole turn is symmetrical but for its last tenth
    assert_eq!((by("peak", 1), by("always", 1)), (None, None));
    let (_, known) = compare(&subject, &["push=1N"]);
    assert!(known >= 2, "{known}");
}

#[test]
fn measures_report_their_largest_deviation() {
    let text = arm("measure wide = x(arm.tip) measure flat = 3 measure off = 1 / (y(arm.tip) - 2 m)
        analysis from 0 to 1 every 0.05");
    let subject = subject(&text, &[]);
    let (tolerances, affected) = subject.affected(&["reach=1mm", "begin=1deg"]);
    let wide = &affected[0];
    // |cos u| 1 mm + 2 m |sin u| 1°: the largest at the rows is that of the tangent near 88°
    let size = |t: f64| (TAU * t).cos().abs() * 1e-3 + 2.0 * (TAU * t).sin().abs() * 1f64.to_radians();
    let most = (0..=20).map(|k| 0.05 * f64::from(k)).max_by(|a, b| size(*a).total_cmp(&size(*b))).expect("rows");
    near(size(wide.at.expect("a time")), size(most));
    let sums = wide.deviation(&tolerances, false).expect("all are known");
    near(sums.worst[1], size(most));
    assert_eq!((affected[1].at, affected[1].slopes[0]), (Some(0.0), Some(0.0)));
    // at a quarter turn it has no value, and that row is no row of it
    let off = &affected[2];
    assert!(off.nominal.is_finite() && off.at.is_some_and(|t| (t - 0.25).abs() > 0.01), "{off:?}");
}

/// One that has a formula goes with what it is made of, unless it may be off itself.
#[test]
fn dependent_params_may_have_tolerances() {
    let text = arm("param half = 1 m result far = first(x(arm.tip)) analysis from 0 to 1 every 0.1")
        .replace("reach = 2 m", "reach = 2 * half");
    let subject = subject(&text, &[]);
    let (_, affected, verified) = subject.verified(&["half=1mm"]);
    near(affected[0].slopes[0].expect("a derivative"), 2.0);
    near(verified.found[0].expect("a corner")[1], 0.002);
    let (_, affected, verified) = subject.verified(&["half=1mm", "reach=1mm"]);
    assert_eq!(affected[0].slopes, [Some(0.0), Some(1.0)]);
    near(verified.found[0].expect("a corner")[1], 0.001);
}

#[test]
fn points_and_part_params_may_have_tolerances() {
    let leg = ROCKER.replace("mechanism rocker", "mechanism leg");
    let text = format!(
        "{leg}\nmechanism pair {{
    param apart = 300 mm
    param rod = 90 mm
    part leg[k in 0..2]: leg(coupler_length = rod) at (k * apart, 0, 0)
    part other: leg() at (0, apart, 10 deg) mirrored
    measure gap = distance(leg[0].coupler.P, leg[1].coupler.P) in mm
    result near = min(distance(leg[0].coupler.P, other.coupler.P)) in mm
    analysis from 0 s to 0.9 s every 50 ms
}}"
    );
    let subject = subject_with(&text, Choice { mechanism: Some("pair".to_owned()), ..Choice::default() });
    let (tolerances, _) = subject.affected(&["leg.crank_length=0.1mm", "other.pen.x=0.1mm", "rod=0.1mm"]);
    let names: Vec<&str> = tolerances.iter().map(|of| of.name.as_str()).collect();
    assert_eq!(names, ["leg[0].crank_length", "leg[1].crank_length", "other.pen.x", "rod"]);
    let (all, known) = compare(&subject, &["leg[1].crank_length=0.1mm", "other.pen.x=0.1mm", "rod=0.1mm", "apart=1mm"]);
    assert!(all > 10 && known == all, "{known} of {all}");
    let why = subject.tolerancing(&["leg[0].coupler_length=1mm"]).map(|_| ()).expect_err("it is bound");
    assert!(why.contains("coupler_length"), "{why}");
}

/// So many params, whose sum is a result.
fn sum_of(count: usize) -> (String, Vec<String>) {
    let params: Vec<String> = (0..count).map(|k| format!("param p{k} = {}\n", k + 1)).collect();
    let params = params.concat();
    let sum: Vec<String> = (0..count).map(|k| format!("{} * p{k}", k % 3)).collect();
    let text =
        arm(&format!("{params} result all = first({}) + 0 * max(t) analysis from 0 to 1 every 1", sum.join(" + ")));
    (text, (0..count).map(|k| format!("p{k}={}", 0.01 * (k + 1) as f64)).collect())
}

#[test]
fn all_corners_of_twelve_are_run_and_of_more_the_worst_with_a_sample() {
    for (count, variants, are_all) in [(1, 2, true), (12, 4096, true), (13, 10_002, false)] {
        let (text, requested) = sum_of(count);
        let requested: Vec<&str> = requested.iter().map(String::as_str).collect();
        let (tolerances, affected, verified) = subject(&text, &[]).verified(&requested);
        assert_eq!((verified.variants, verified.are_all_corners), (variants, are_all), "{count}");
        let sums = affected[0].deviation(&tolerances, false).expect("all are known");
        let wanted: f64 = (0..count).map(|k| (k % 3) as f64 * 0.01 * (k + 1) as f64).sum();
        near(sums.worst[1], wanted);
        let found = verified.found[0].expect("corners");
        near(found[0], -wanted);
        near(found[1], wanted);
        assert!(verified.lost.is_none() && verified.is_linear(0, &affected[0], &sums));
    }
}

#[test]
fn corners_reveal_nonlinearity() {
    let text = arm("result far = first(x(arm.tip)) result up = first(y(arm.tip)) analysis from 0 to 1 every 0.1");
    let (tolerances, affected, verified) = subject(&text, &[]).verified(&["begin=0.3 rad"]);
    let sums: Vec<_> = affected.iter().map(|of| of.deviation(&tolerances, false).expect("known")).collect();
    assert_eq!(sums[0].worst, [0.0, 0.0], "at the end of its reach");
    let found = verified.found[0].expect("corners");
    near(found[0], 2.0 * 0.3_f64.cos() - 2.0);
    assert!(!verified.is_linear(0, &affected[0], &sums[0]));
    // 0.6 by derivatives, 2 sin 0.3 = 0.591
    assert!(verified.is_linear(1, &affected[1], &sums[1]));
    near(verified.found[1].expect("corners")[1], 2.0 * 0.3_f64.sin());
}

/// What is a difference of large numbers is off by their rounding, which no derivative tells.
#[test]
fn rounding_changes_are_linear() {
    let text = arm("measure off = x(arm.tip)^2 / reach + y(arm.tip)^2 / reach - reach analysis from 0 to 1 every 0.07");
    let (tolerances, affected, verified) = subject(&text, &[]).verified(&["reach=0.3m", "begin=0.2 rad"]);
    let deviation = affected[0].deviation(&tolerances, false).expect("known");
    let [low, high] = verified.found[0].expect("corners");
    let [worst_low, worst_high] = deviation.worst;
    assert!(f64::max(high - worst_high, worst_low - low) > 0.05 * worst_high.max(-worst_low), "{low} to {high}");
    assert!(verified.is_linear(0, &affected[0], &deviation));
}

#[test]
fn corners_that_do_not_run_are_reported() {
    let subject = subject(FOUR_BAR, &[]);
    // with 30 mm more all links would lie on one line; with 35 mm more it locks
    let (_, affected, verified) = subject.verified(&["crank_length=0mm..35mm"]);
    let (count, set, status) = verified.lost.expect("one of the corners locks");
    assert_eq!((count, set, status), (1, vec!["crank_length=0.065 m".to_owned()], "E0602"));
    assert!(verified.found.iter().all(Option::is_some), "{:?}", affected.iter().map(|of| &of.name).collect::<Vec<_>>());
}

/// A corner at which a result has no value is told, and linear is not enough then.
#[test]
fn corners_without_a_value_are_reported() {
    let text = arm(
        "result far = sqrt(first(x(arm.tip)) / 1 m - 2) result up = first(x(arm.tip)) analysis from 0 to 1 every 0.1",
    );
    let subject = subject_with(&text, Choice { set: vec!["reach=2.5 m".to_owned()], ..Choice::default() });
    let (tolerances, affected, verified) = subject.verified(&["reach=0.6m"]);
    assert_eq!(verified.missing, [Some((1, vec!["reach=1.9 m".to_owned()])), None]);
    let sums: Vec<_> = affected.iter().map(|of| of.deviation(&tolerances, false).expect("known")).collect();
    assert!(!verified.is_linear(0, &affected[0], &sums[0]) && verified.is_linear(1, &affected[1], &sums[1]));
}

/// Where a formula of results has a kink or a jump at the nominal values, what derivatives say of one side does not hold for the other.
#[test]
fn a_result_at_a_kink_of_results_has_no_derivative() {
    by_p(
        2.0,
        &[
            ("abs(max(p * sin(tau * t)) - 2)", None),
            ("abs(max(p * sin(tau * t)) - 2.001)", Some(-1.0)),
            ("min(max(p * sin(tau * t)), 2)", None),
            ("max(max(p * sin(tau * t)), 1.9)", Some(1.0)),
            ("max(max(p * sin(tau * t)), 2.1)", Some(0.0)),
            ("if max(p * sin(tau * t)) > 2 then 1 else 0", None),
            ("if max(p * sin(tau * t)) > 1.5 then max(p * sin(tau * t)) else 0", Some(1.0)),
            ("mod(max(p * sin(tau * t)), 2)", None),
            ("mod(max(p * sin(tau * t)), 1.5)", Some(1.0)),
            ("(max(p * sin(tau * t)) - 2)^2", Some(0.0)),
            ("abs(max(p * sin(tau * t)) - 2)^3", Some(0.0)),
            ("abs(max(sin(tau * t)) - 1)", Some(0.0)),
            ("abs(p - 2) + max(sin(tau * t)) * abs(p - max(2 * sin(tau * t)))", None),
            ("max(sin(tau * t)) * abs(p - 1)", Some(1.0)),
            ("1e6 * abs(max(p * sin(tau * t)) - 1000)", Some(-1e6)),
        ],
    );
}

/// With what is set beside the text, the nominal one is that.
#[test]
fn set_values_are_nominal() {
    let text = arm("result far = first(x(arm.tip)) analysis from 0 to 1 every 0.1");
    let subject = subject_with(&text, Choice { set: vec!["reach=3m".to_owned()], ..Choice::default() });
    let (tolerances, affected, verified) = subject.verified(&["reach=1mm"]);
    near(tolerances[0].nominal, 3.0);
    near(affected[0].nominal, 3.0);
    let found = verified.found[0].expect("corners");
    near(found[1], 0.001);
}

#[test]
fn invalid_tolerances_are_refused() {
    let text = arm("param count = 2 param A = (1 m, 2 m) input turn = 3
        measure wide[k in 0..count] = x(arm.tip) * k result far = first(x(arm.tip)) analysis from 0 to 1 every 0.1");
    let subject = subject(&text, &[]);
    for (requested, wanted) in [
        (vec!["reach"], "`--tol reach` does not say what may be off, and how far"),
        (vec!["=1mm"], "`--tol =1mm` does not say what may be off, and how far"),
        (vec!["reach="], "`--tol reach=` does not say how far it may be off"),
        (vec!["reach=..1mm"], "`--tol reach=..1mm` does not say how far it may be off"),
        (vec!["length=1mm"], "mechanism `m` has no parameter `length`"),
        (vec!["turn=1"], "mechanism `m` has no parameter `turn`"),
        (vec!["reach=1"], "the parameter `reach` must be a length, found a pure number"),
        (vec!["reach=1mm..1rad"], "the parameter `reach` must be a length, found an angle"),
        (vec!["reach=-1mm"], "the tolerance of `reach` is negative: `-1mm`"),
        (vec!["reach=±-1mm"], "the tolerance of `reach` is negative: `-1mm`"),
        (vec!["reach=1mm..-1mm"], "the tolerance of `reach` goes from `1mm` down to `-1mm`"),
        (vec!["reach=1mm", "reach=2mm"], "`reach` has two tolerances"),
        (vec!["count=1"], "`count` decides what is repeated, and cannot be a little off"),
    ] {
        let messages = subject.tolerancing(&requested).map(|_| ()).expect_err("it is refused");
        assert_eq!(messages, wanted, "{requested:?}");
    }
    for requested in
        ["reach=0/0*1mm", "reach=1e400mm", "reach=nan mm", "reach=inf", "reach=x(arm.tip)", "A=(1mm,1mm)", "A=1mm"]
    {
        assert!(subject.tolerancing(&[requested]).is_err(), "{requested}");
    }
    let bare = self::subject(&arm("analysis from 0 to 1 every 0.1"), &[]);
    let tolerancing = bare.tolerancing(&["reach=1mm"]).expect("a tolerance");
    let why = tolerancing.sensitivities(&bare.compiled, &SweepOptions::default()).map(|_| ()).map_err(reported);
    assert_eq!(why, Err("there is no measure and no result that could be off".to_owned()));
    // signs and spaces as one writes them
    for requested in ["reach=±1mm", " reach = +/- 1 mm", "reach=+-1mm", "reach=-1mm..1mm", "reach=1e-3 m"] {
        let (tolerances, _) = subject.affected(&[requested]);
        assert_eq!(tolerances[0].range, [-0.001, 0.001], "{requested}");
    }
    let (tolerances, _) = subject.affected(&["begin=1deg", "rate=1rpm"]);
    near(tolerances[0].range[1], FRAC_PI_2 / 90.0);
    assert_eq!((tolerances[0].unit.0.as_str(), tolerances[1].unit.0.as_str()), ("deg", "rpm"));
}

/// A tolerance on a literal zero has the dimension that the zero stands for, and no other.
#[test]
fn tolerances_of_a_zero_have_its_dimension() {
    let text = |more: &str| arm(&format!("param off = 0 driver other: x(arm.tip) = 1 m + off {more}"));
    let text = |more: &str| {
        text(more)
            .replace("joint main: revolute(ground.O, arm.O)", "driver up: y(arm.tip) = 1 m")
            .replace("rotation(main)", "angle(arm)")
    };
    let with = "measure far = x(arm.tip) analysis from 0 to 1 every 0.5";
    let of_length = subject(&text(with), &[]);
    let (tolerances, affected) = of_length.affected(&["off=1mm"]);
    assert_eq!((tolerances[0].si.as_str(), affected[0].slopes[0]), ("m", Some(1.0)));
    let verified = of_length.verified(&["off=1mm"]).2;
    near(verified.found[0].expect("corners")[1], 0.001);
    assert_eq!(of_length.tolerancing(&["off=1"]).map(|_| ()), Err("this adds a length and a pure number".to_owned()));
    let of_both = subject(&text(with).replace("begin + rate", "off + rate"), &[]);
    for requested in ["off=0.1", "off=1mm", "off=-1mm..0"] {
        assert!(of_both.tolerancing(&[requested]).is_err(), "{requested}");
    }
}

/// Params that follow others: measures differentiate along their formulas, a tolerance moves one param alone.
#[test]
fn tolerances_change_nothing_that_is_measured() {
    let text = "mechanism m {
        param a = 2
        param two = a^2
        param three = two + a
        body b { point P = (0, 0) }
        driver x: x(b.P) = a * two + three
        driver y: y(b.P) = two * three
        driver turn: angle(b) = t
        measure right = x(b.P)
        measure slope = der(x(b.P), a)
        measure own = der(y(b.P), three)
        result up = max(y(b.P))
        result steep = max(slope)
        analysis from 0 to 1 every 1
    }";
    let subject = subject(text, &[]);
    let found = |requested: &[&str]| -> Vec<(f64, Vec<f64>)> {
        let slopes = |of: OutputSensitivity| of.slopes.into_iter().map(|slope| slope.expect("a number")).collect();
        subject.affected(requested).1.into_iter().map(|of| (of.nominal, slopes(of))).collect()
    };
    let check = |requested: &[&str], wanted: [&[f64]; 5]| {
        let nominal = [14.0, 17.0, 4.0, 24.0, 17.0];
        for (k, (value, slopes)) in found(requested).into_iter().enumerate() {
            near(value, nominal[k]);
            assert_eq!(slopes.len(), wanted[k].len());
            slopes.iter().zip(wanted[k]).for_each(|(found, wanted)| near(*found, *wanted));
        }
    };
    check(&["a=0.1"], [&[17.0], &[14.0], &[4.0], &[44.0], &[14.0]]);
    check(&["two=0.1"], [&[3.0], &[1.0], &[1.0], &[10.0], &[1.0]]);
    check(&["two=0.1", "a=0.1"], [&[3.0, 5.0], &[1.0, 10.0], &[1.0, 0.0], &[10.0, 4.0], &[1.0, 10.0]]);
    let all = ["a=0.1", "two=0.1", "three=0.1"];
    check(&all, [&[4.0, 2.0, 1.0], &[10.0, 1.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 6.0, 4.0], &[10.0, 1.0, 0.0]]);
    let (_, affected, verified) = subject.verified(&all);
    let are_verified: Vec<bool> = verified.found.iter().map(Option::is_some).collect();
    assert_eq!(are_verified, [true, false, true, true, false]);
    assert!(affected.iter().zip(are_verified).all(|(of, is_verified)| of.is_verifiable == is_verified));
}

/// A param that moves nothing has a derivative of nothing, whatever rounding leaves of it.
#[test]
fn rounding_is_no_sensitivity() {
    let text = "mechanism two {
        param gap = 100 mm
        param la = 40 mm
        ground { point O = (0, 0) }
        body base { point O = (0, 0) point H = (gap, 0) point S = (gap, 70 mm) }
        body arm at (gap, 0, 0) { point O = (0, 0) point tip = (la, 0) }
        joint main: revolute(ground.O, base.O)
        joint hinge: revolute(base.H, arm.O)
        driver mot: rotation(main) = 30 rpm * t
        driver sw: rotation(hinge) = 60 rpm * t
        measure reach = distance(base.S, arm.tip)
        result most = max(reach)
        result least = min(reach)
        result avg = mean(reach)
        result far = max(x(arm.O, arm.tip))
        analysis from 0 s to 1 s every 0.1 s
    }";
    let (_, affected) = subject(text, &[]).affected(&["gap=1mm", "la=0.1mm"]);
    for of in &affected {
        let [gap, la] = of.slopes[..] else { panic!("{} has two", of.name) };
        assert!(gap.expect("a derivative").abs() <= 1e-12, "{}: {gap:?}", of.name);
        assert!(la.expect("a derivative").abs() > 0.1, "{}: {la:?}", of.name);
    }
    let [most, far] = ["most", "far"].map(|name| affected.iter().find(|of| of.name == name).expect("a result"));
    near(most.slopes[1].expect("a derivative"), 1.0);
    near(far.slopes[1].expect("a derivative"), 1.0);
}

/// The direction of an axis has a length, which params alone decide: `T = 2 (1 + ph²) ẍ`.
#[test]
fn param_conditions_are_no_kinks() {
    let text = "mechanism guide {
        param ph = 0.17
        ground { axis w = (0, 0) along (1, ph) }
        body S { axis w = (0, 0) along (1, 0) point Q = (0, 0) mass 2 kg }
        joint g: translational(ground.w, S.w)
        driver d: x(S.Q) = 0.1 * sin(6 * t)
        measure T = effort(d)
        result z = max(T)
        analysis from 0 s to 1 s every 20 ms
    }";
    let (_, affected) = subject(text, &[]).affected(&["ph=0.001"]);
    let z = affected.iter().find(|of| of.name == "z").expect("a result");
    near(z.slopes[0].expect("a derivative"), 4.0 * 0.17 * 3.6);
}

/// What rests has all its times in common: each of them may go its own way with a param, and a result of extremes then has no derivative.
#[test]
fn params_may_set_rests_moving() {
    let text = "mechanism rest {
        param la = 100 mm
        param nominal = 100 mm
        param speed = 0 rpm
        ground { point O = (0, 0) }
        body arm { point O = (0, 0) point tip = (la, 0) }
        body still at (0, 0, 0.7) { point O = (0, 0) point tip = (la, 0) }
        joint main: revolute(ground.O, arm.O)
        joint side: revolute(ground.O, still.O)
        driver mot: rotation(main) = 90 deg/s * t
        driver held: rotation(side) = 0.7 + speed * t
        measure off = x(arm.tip) - nominal * cos(90 deg/s * t)
        result band = max(off) - min(off)
        result worst = max(abs(off))
        result stroke = max(x(still.tip)) - min(x(still.tip))
        result long = max(distance(ground.O, arm.tip))
        analysis from 0 s to 4 s every 0.1 s
    }";
    let (_, affected) = subject(text, &[]).affected(&["la=1mm", "speed=1rpm"]);
    let slopes = |name: &str| &affected.iter().find(|of| of.name == name).expect("a result").slopes;
    assert_eq!((slopes("band")[0], slopes("worst")[0], slopes("stroke")[1]), (None, None, None));
    near(slopes("long")[0].expect("all its times go alike"), 1.0);
    near(slopes("stroke")[0].expect("nothing is moved by it"), 0.0);
}

/// An arm that turns as time goes, with a measure and a param `a`.
fn stepped(measure: &str, a: f64) -> String {
    format!(
        "mechanism m {{
            param a = {a}
            ground {{ point O = (0, 0) }}
            body b {{ point O = (0, 0) }}
            joint main: revolute(ground.O, b.O)
            driver d: rotation(main) = t
            measure e = {measure}
            analysis from 0 to 1 every 0.1
        }}"
    )
}

#[test]
fn measures_with_moving_jumps_have_no_derivative() {
    let measures = ["if rotation(main) < a then 1 else 2", "sign(rotation(main) - a)", "mod(rotation(main) - a, 1)"];
    for measure in measures {
        for a in [0.5, 0.35, 0.72] {
            let (_, affected) = subject(&stepped(measure, a), &[]).affected(&["a=0.06"]);
            assert_eq!((affected[0].name.as_str(), &affected[0].slopes), ("e", &vec![None]), "{measure}, {a}");
        }
    }
    // at a corner it is on the other side of its jump
    let (_, _, verified) = subject(&stepped(measures[0], 0.5), &[]).verified(&["a=0.06"]);
    assert_eq!(verified.found[0], Some([-1.0, 0.0]));
}

#[test]
fn measures_with_fixed_kinks_have_derivatives() {
    let continuous = "if rotation(main) < a then a * rotation(main) else a * a";
    for (measure, slope) in
        [(continuous, 1.0), ("if rotation(main) < 0.5 then a else 2 * a", 2.0), ("a * sign(t - 0.3)", 1.0)]
    {
        let (_, affected) = subject(&stepped(measure, 0.52), &[]).affected(&["a=0.01"]);
        let found = affected[0].slopes[0].expect("a derivative");
        assert!((found.abs() - slope).abs() < 0.05, "{measure}: {found}");
    }
}

#[test]
fn distant_constants_hide_no_derivative() {
    for (formula, slope) in [("a * sin(3 * rotation(main))", 1.0), ("sin(3 * rotation(main) + a)", 0.0)] {
        for other in ["-2", "-100", "-1e5"] {
            let peak = format!("peak = max(if t < 0.8 then {formula} else {other})");
            let (_, affected) = subject(&stepped("x(b.O)", 0.3), &[&peak]).affected(&["a=0.001"]);
            let found = affected.iter().find(|of| of.name == "peak").expect("the result").slopes[0];
            let found = found.unwrap_or_else(|| panic!("{formula}, {other}"));
            assert!((found - slope).abs() < 1e-9, "{formula}, {other}: {found}");
        }
    }
}
