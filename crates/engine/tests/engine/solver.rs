//! Rows that are solved for several at a time.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::{fuzz, support};

use crate::support::random::Random;
use crate::support::{all_rows, compile, compiled, files, stem, text_of};
use mechc::{Cancel, Compiled, TOLERANCE, Times, Vectors};
use mechc_engine::analysis::{self, Horizon};
use mechc_engine::solver::{Batch, Bend, Lanes, Segment, Solver};
use mechc_ir::program::Stage;
use std::fs;
use std::path::Path;
use std::sync::Arc;

fn rows(compiled: &Compiled, times: &Times) -> Vec<Vec<f64>> {
    let (rows, stop) = all_rows(compiled, times);
    assert!(stop.is_none(), "{stop:?}");
    rows
}

/// Four-bars side by side, so many that threads are worth while.
fn four_bars(n: usize) -> String {
    let mut text = "mechanism many { ground {\n".to_owned();
    for k in 0..n {
        text += &format!("point A{k} = ({}, 0) point B{k} = ({}, 0)\n", 5 * k, 5 * k + 4);
    }
    text += "}\n";
    for k in 0..n {
        let x = 5.0 * k as f64;
        text += &format!(
            "body crank{k} at ({x}, 0, 0.5) {{ point A = (0, 0) point C = (1, 0) }}
             body coupler{k} at ({}, 0.48, 0.78) {{ point C = (0, 0) point D = (3.5, 0) }}
             body rocker{k} at ({}, 1.5, 1.8) {{ point B = (-1.5, 0) point D = (1.5, 0) }}
             joint main{k}: revolute(ground.A{k}, crank{k}.A)
             joint pin{k}: revolute(crank{k}.C, coupler{k}.C)
             joint knee{k}: revolute(coupler{k}.D, rocker{k}.D)
             joint pivot{k}: revolute(ground.B{k}, rocker{k}.B)
             driver motor{k}: rotation(main{k}) = 0.5 + {} * t\n",
            x + 0.88,
            x + 3.7,
            1.0 + 0.001 * k as f64,
        );
    }
    text + "analysis from 0 to 2 every 0.01 }"
}

#[test]
fn rows_do_not_depend_on_other_rows() {
    let case = |name: &str| text_of(format!("tests/cases/{name}.mech"));
    let mut texts: Vec<(String, String)> =
        ["four_bar", "andrews", "jansen", "digger", "slots"].map(|name| (name.to_owned(), case(name))).to_vec();
    texts.push(("many".to_owned(), four_bars(150)));
    for (name, text) in texts {
        let compiled = compiled(&name, &text);
        let [from, to, _] = compiled.analysis().expect("an analysis");
        let all: Vec<f64> = (0..=700).map(|k| from + (to - from) * f64::from(k) / 700.0).collect();
        let seventh: Vec<f64> = all.iter().step_by(7).copied().collect();
        let (all, seventh) = (Times::listed(from, all), Times::listed(from, seventh));
        let (many, few) = (rows(&compiled, &all), rows(&compiled, &seventh));
        // the first row is that of the assembled start
        for (k, (a, b)) in many.iter().step_by(7).zip(&few).enumerate().skip(1) {
            let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(a), bits(b), "{name}, row {k}: {a:?}\n{b:?}");
        }
    }
}

/// A random mechanism whose bodies have masses.
fn made(seed: u64) -> String {
    let mut random = Random::new(seed);
    let bytes: Vec<u8> = (0..600).map(|_| random.below(255) as u8).collect();
    let text = fuzz::generate::text(&bytes);
    let mut heavy = String::new();
    for line in text.lines() {
        heavy += line;
        heavy += "\n";
        if line.starts_with("body ") {
            heavy += &format!("mass {} inertia {}\n", random.between(0.5, 2.0), random.between(0.1, 1.0));
        }
    }
    let end = heavy.rfind('}').expect("a mechanism");
    heavy.replace_range(end.., "gravity (1, -9.8)\n}\n");
    heavy
}

/// Holds rows of some of so many times against the rows of all of them, bit by bit; gives how many there are of these.
fn have_equal_bits(name: &str, compiled: &Compiled, count: u32) -> usize {
    let [from, to, _] = compiled.analysis().expect("an analysis");
    let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(count);
    let (all, _) = all_rows(compiled, &Times::listed(from, (0..=count).map(at).collect()));
    for (first, step) in [(1, 3), (2, 17), (5, count), (count / 2, count), (count - 1, count), (1, 1)] {
        let reached = (first..=count).step_by(step as usize).map(at).filter(|t| all.iter().any(|row| row[0] == *t));
        let (some, _) = all_rows(compiled, &Times::listed(from, reached.collect()));
        for row in some {
            let whole = all.iter().find(|whole| whole[0] == row[0]).expect("the same time");
            for (k, (a, b)) in row.iter().zip(whole).enumerate() {
                let (column, t) = (&compiled.columns()[k], row[0]);
                assert_eq!(a.to_bits(), b.to_bits(), "{name}, {column} at {t}: {a} and {b}, from {first} by {step}");
            }
        }
    }
    all.len()
}

#[test]
fn rows_of_random_mechanisms_do_not_depend_on_other_rows() {
    let mut visited = 0;
    for seed in 0..8 {
        let text = made(seed);
        if let Some(compiled) = support::compile_with_forces(Path::new("made"), &text, 0) {
            visited += usize::from(have_equal_bits(&text, &compiled, 40) > 1);
        }
    }
    assert!(visited > 4, "{visited}");
}

#[test]
fn rows_with_large_rounding_do_not_depend_on_other_rows() {
    let compiled = compiled("gear", include_str!("gear_under_great_forces.mech"));
    for count in [20, 10, 2, 100] {
        assert_eq!(have_equal_bits("gear", &compiled, count), count as usize + 1);
    }
}

#[test]
fn short_rows_and_long_ones_hold_the_same() {
    // short ones are turned from columns, the others are written number by number
    let [few, many] = [20, 150].map(|n| compiled("some", &four_bars(n)));
    let times = Times::grid(0.0, 2.0, 0.01).expect("a grid");
    let place = |name: &String| many.columns().iter().position(|other| other == name).expect("the same names");
    let places: Vec<usize> = few.columns().iter().map(place).collect();
    for (k, (short, long)) in rows(&few, &times).iter().zip(rows(&many, &times)).enumerate() {
        for (value, &place) in short.iter().zip(&places) {
            assert_eq!(value.to_bits(), long[place].to_bits(), "row {k}, {}", many.columns()[place]);
        }
    }
}

#[test]
fn every_case_is_solved_for_in_lanes() {
    let mut visited = 0;
    for path in files("tests/cases", "mech") {
        let name = stem(&path);
        let text = fs::read_to_string(&path).expect("a text");
        let (Some(compiled), _) = compile(&name, &text) else {
            continue;
        };
        let (determined, program) = compiled.inside();
        let Some(times) = compiled.times() else {
            continue;
        };
        visited += 1;
        let wanted = rows(&compiled, &times);
        let params: Vec<f64> = determined.system().params().iter().map(|param| param.value).collect();
        let started = analysis::start(
            Arc::clone(&determined),
            Arc::clone(&program),
            Horizon::of(&times),
            TOLERANCE,
            &Cancel::default(),
        );
        let started = started.expect("it assembles");
        let solver = started.solver().expect("it is small");
        let layout = solver.layout();
        let (mut lanes, mut found) = (Lanes::<1>::new(solver, Vectors::BASE), vec![0.0; layout.stride]);
        let bounds = vec![1e8; determined.system().rows().len()];
        let mut others = 0;
        for want in wanted.iter().skip(1) {
            let q = &want[layout.coordinates[0] as usize..][..determined.system().coordinates().len()];
            let curve: Vec<[f64; 6]> = q.iter().map(|&q| [q, 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
            let bends = vec![Bend::NONE; solver.tears().len()];
            let batch =
                Batch { times: [want[0]], from: want[0], length: 1.0, curve: &curve, bends: &bends, bounds: &bounds };
            // which branches formulas take
            let mut scalars = program.start(&params);
            scalars.set(program.inputs.time, want[0]);
            scalars.set_all(program.inputs.coordinates[0], q);
            program.run(Stage::Time, &mut scalars);
            program.run(Stage::Position, &mut scalars);
            let [holds] = lanes.run(solver, &program, &scalars, &batch, &mut found);
            if !holds {
                // the order of elimination does not suit every position
                others += 1;
                continue;
            }
            // at an edge of a formula accelerations have two values
            for (k, (a, b)) in found.iter().zip(want).take(layout.coordinates[2] as usize).enumerate() {
                assert!(
                    (a - b).abs() <= 1e-9 * (1.0 + b.abs()),
                    "{name}, column {k} at {}: {a} instead of {b}",
                    want[0]
                );
            }
        }
        assert!(10 * others <= wanted.len(), "{name}: {others} of {} rows have no lane", wanted.len());
    }
    assert!(visited > 20, "only {visited} cases");
}

/// A solver with what it needs to be run at any time.
struct Bench {
    compiled: Compiled,
    started: analysis::Started,
    scalars: mechc_ir::program::Registers,
    bounds: Vec<f64>,
}

impl Bench {
    fn new(name: &str, text: &str) -> Bench {
        let compiled = compiled(name, text);
        let (determined, program) = compiled.inside();
        let params: Vec<f64> = determined.system().params().iter().map(|param| param.value).collect();
        let bounds = vec![1e8; determined.system().rows().len()];
        let horizon = Horizon::of(&Times::listed(0.0, vec![0.0]));
        let scalars = program.start(&params);
        let started = analysis::start(determined, program, horizon, TOLERANCE, &Cancel::default());
        Bench { compiled, started: started.expect("it assembles"), scalars, bounds }
    }

    fn solver(&self) -> &Solver {
        self.started.solver().expect("it is small")
    }

    /// The bits of the row of one of the lanes, Newton beginning so far from a position everywhere.
    fn row<const W: usize>(&self, lanes: &mut Lanes<W>, times: [f64; W], lane: usize, q: &[f64], off: f64) -> Vec<u64> {
        let (_, program) = self.compiled.inside();
        let curve: Vec<[f64; 6]> = q.iter().map(|q| [q + off, 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
        let stride = self.solver().layout().stride;
        let mut rows = vec![0.0; W * stride];
        let batch = Batch { times, from: times[0], length: 1.0, curve: &curve, bends: &[], bounds: &self.bounds };
        let holds = lanes.run(self.solver(), &program, &self.scalars, &batch, &mut rows);
        assert!(holds[lane], "at {}", times[lane]);
        rows[lane * stride..][..stride].iter().map(|value| value.to_bits()).collect()
    }
}

#[test]
fn tears_on_borders_do_not_depend_on_the_guess() {
    let bench = Bench::new("four-bar", &four_bars(1));
    let q = bench.started.q();
    let tears = || bench.solver().segments().iter().flat_map(Segment::tears);
    assert_eq!(tears().count(), 2);
    let (mut alone, mut together) =
        (Lanes::<1>::new(bench.solver(), Vectors::BASE), Lanes::<16>::new(bench.solver(), Vectors::default()));
    for (number, tear) in tears().enumerate() {
        let column = (bench.solver().layout().coordinates[0] + bench.solver().tears()[number]) as usize;
        let mut in_cells = |t: f64| f64::from_bits(bench.row(&mut alone, [t], 0, q, 0.0)[column]) / tear.cell;
        for beyond in [3.5, 14.5, 40.5] {
            // the last time before the tear comes to a border, to the last digit
            let (mut before, mut behind) = (0.0, 1e-5);
            let way = (in_cells(behind) - in_cells(before)).signum();
            let border = in_cells(before).floor() + way * beyond;
            for _ in 0..80 {
                let middle = 0.5 * (before + behind);
                *(if way * (in_cells(middle) - border) < 0.0 { &mut before } else { &mut behind }) = middle;
            }
            assert!((in_cells(before) - border).abs() < 1e-6, "the border is met");
            for t in [before, behind, 0.5 * (before + behind)] {
                let mut alone = Lanes::<1>::new(bench.solver(), Vectors::BASE);
                let want = bench.row(&mut alone, [t], 0, q, 0.0);
                for k in -100..=100 {
                    let off = tear.cell * 0.37 * f64::from(k);
                    assert_eq!(bench.row(&mut alone, [t], 0, q, off), want, "tear {number} at {t}, alone from {off:e}");
                    // beside others, which have farther to go
                    let times = std::array::from_fn(|lane| if lane == 7 { t } else { 1e-3 * lane as f64 });
                    let got = bench.row(&mut together, times, 7, q, off);
                    assert_eq!(got, want, "tear {number} at {t}, in lanes from {off:e}");
                }
            }
        }
    }
}
