//! What a step costs: position, velocity and acceleration of all bodies at one output time.
//!
//! ```sh
//! cargo bench -p mechc-benches
//! ```
//!
//! `docs/speed.md` tells how to read what it prints. Before anything is timed, the ways that are compared must agree.

#![allow(clippy::expect_used, clippy::panic)] // a bench fails by panicking
#![allow(clippy::default_constructed_unit_structs)] // this four-bar has no parameters, others have

mod closed_form;
mod copies;
mod forces;
mod mechanisms;
mod newton;
mod sweeps;
mod timing;

/// Emitted modules, each in one of its own, that `emit.rs` has made.
macro_rules! emitted_modules {
    ($($name:ident),*) => {$(
        #[allow(clippy::all, clippy::pedantic, clippy::disallowed_methods, dead_code, missing_docs, unused_imports)] // generated
        mod $name {
            include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
        }
    )*};
}
emitted_modules!(andrews, followed, four_bar, jansen);

use closed_form::closed_form;
use mechanisms::compile;
use mechc::{Compiled, Run, RunOptions, TableFormat, TableWriter, Times};
use newton::{Dense, Linear, Newton, Sparse};
use std::f64::consts::PI;
use std::hint::black_box;
use timing::{Table, median, per_step};

/// Times a turn, both ends counted.
const STEPS: u32 = 1001;
/// The same for variants side by side.
const VARIANT_TIMES: u32 = 360;
/// Unknowns beyond which a dense matrix is not worth waiting for.
const LARGEST_DENSE: usize = 200;
/// Steps that are enough to time the ways that take long.
const A_FEW_STEPS: u32 = 12;

fn main() {
    println!("closed form of the four-bar, by hand: {:.0} ns a step\n", floor());
    agree();
    emitted(floor());
    follow(floor());
    single(floor());
    beside_emitted();
    sweeps::sweeps(floor());
    output();
    set_up();
    forces::forces();
    four_bars(floor());
    scissor_lifts(floor());
}

/// ns a step of the closed form, measured anew beside what is held against it: the machine may have got faster or slower.
fn floor() -> f64 {
    median(9, || per_step(STEPS, by_hand))
}

fn by_hand() {
    for t in turn() {
        black_box(closed_form(black_box(t)));
    }
}

/// One turn of the four-bar's crank.
fn turn() -> impl Iterator<Item = f64> {
    (0..STEPS).map(|k| PI * f64::from(k) / f64::from(STEPS - 1))
}

/// Every number of every way is that of the closed form, to 1e-9.
fn agree() {
    let compiled = compile(&mechanisms::four_bars(1));
    let (determined, program) = compiled.inside();
    let mut motion = started(&compiled, &Times::listed(0.0, turn().collect()));
    let start = coordinates(&motion);
    let mut dense = Newton::new(Dense::new(&determined), &determined, &program, &start);
    let mut sparse = Newton::new(Sparse::new(&determined), &determined, &program, &start);
    let mut state = four_bar::assemble(&four_bar::Params::default()).expect("it assembles");
    for t in turn() {
        let row = motion.next_row().expect("a row").expect("it moves");
        four_bar::step(t, &mut state).expect("it moves");
        let emitted = state.row();
        let ways =
            [("mechc", &row[1..]), ("emitted", &emitted[1..]), ("dense", &dense.step(t)), ("sparse", &sparse.step(t))];
        for (name, got) in ways {
            for (k, (a, b)) in got.iter().zip(closed_form(t)).enumerate() {
                assert!((a - b).abs() < 1e-9, "{name}, number {k} at t = {t}: {a} instead of {b}");
            }
        }
    }
}

/// The four-bar as it is emitted: one at a time, and in 16 lanes.
fn emitted(floor: f64) {
    use four_bar::{Params, assemble, lanes, step};
    let alone = median(21, || {
        let mut state = assemble(&Params::default()).expect("it assembles");
        per_step(STEPS, || {
            for t in turn() {
                step(black_box(t), &mut state).expect("it moves");
                black_box(state.q());
            }
        })
    });
    let together = median(21, || {
        let mut states = lanes::assemble(&[Params::default(); lanes::LANES]).expect("they assemble").0;
        let all = per_step(STEPS, || {
            for t in turn() {
                let done = lanes::step_each(black_box(&[t; lanes::LANES]), &mut states);
                assert!(black_box(done).iter().all(Result::is_ok));
                black_box(states.q());
            }
        });
        all / lanes::LANES as f64
    });
    println!("the four-bar as emitted Rust");
    for (name, time) in [("one at a time", alone), ("16 lanes, each", together)] {
        println!("  {name:<16} {time:>6.0} ns {:>7.2} x", time / floor);
    }
    println!();
}

/// A four-bar that follows its input, beside the same by time: a thousand samples a second.
fn follow(floor: f64) {
    use followed::{Inputs, Params, START_TIME, assemble, follow, step};
    let start = assemble(&Params::default()).expect("it assembles");
    let times: Vec<f64> = (1..=STEPS).map(|k| START_TIME + 1e-3 * f64::from(k)).collect();
    let inputs: Vec<Inputs> = times.iter().map(|t| Inputs::at(*t, &Params::default())).collect();
    let by_time = median(21, || {
        let mut state = start.clone();
        per_step(STEPS, || {
            for t in &times {
                step(black_box(*t), &mut state).expect("it moves");
                black_box(state.q());
            }
        })
    });
    let by_inputs = median(21, || {
        let mut state = start.clone();
        per_step(STEPS, || {
            for inputs in &inputs {
                follow(black_box(inputs), &mut state).expect("it moves");
                black_box(state.q());
            }
        })
    });
    println!("a four-bar with an input, as emitted Rust");
    for (name, time) in [("step", by_time), ("follow", by_inputs)] {
        println!("  {name:<16} {time:>6.0} ns {:>7.2} x", time / floor);
    }
    println!("  follow takes {:.2} times as long as step\n", by_inputs / by_time);
}

/// Mechanisms of one loop or a few.
fn single(floor: f64) {
    let mut table = Table::new("one mechanism, 1001 times a turn", floor);
    for (name, text) in mechanisms::singles() {
        let compiled = compile(&text);
        table.row(name, 1.0, &ways(&compiled, STEPS));
    }
}

/// The same in lanes, beside what is emitted of them, one time after the other: the times of one mechanism, and variants side by side.
fn beside_emitted() {
    macro_rules! emitted {
        ($module:ident, $text:expr, $every:expr, $params:expr) => {{
            let [from, to, _] = compile($text).analysis().expect("an analysis");
            let times = turn_of(from, to);
            let scalar = median(21, || {
                let mut state = $module::assemble(&$module::Params::default()).expect("it assembles");
                per_step(STEPS, || {
                    for t in &times {
                        $module::step(black_box(*t), &mut state).expect("it moves");
                        black_box(state.row());
                    }
                })
            });
            let [own, step] = $every;
            [scalar, in_lanes($text, &times), sweeps::row_of_variants($text.replace(own, step), $params, VARIANT_TIMES)]
        }};
    }
    println!("mechc beside emitted Rust, one at a time");
    let andrews = ["every 0.5 ms", "every 30 ms / 359"];
    let jansen = ["every 25 ms", "every 2 s / 359"];
    let both = [
        ("Andrews", emitted!(andrews, mechanisms::ANDREWS, andrews, ["rr=6.9 mm..7.1 mm", "dd=27.9 mm..28.1 mm"])),
        ("Jansen", emitted!(jansen, mechanisms::JANSEN, jansen, ["lj=49.5 mm..50.5 mm", "lm=14.8 mm..15.2 mm"])),
    ];
    for (name, [scalar, times, variants]) in both {
        println!("  {name:<8} emitted                  {scalar:>6.0} ns");
        println!("           1001 times in lanes      {times:>6.0} ns {:>7.2} x", times / scalar);
        println!("           variants, {VARIANT_TIMES} times each {variants:>6.0} ns {:>7.2} x", variants / scalar);
    }
    println!();
}

/// ns a row of one mechanism at some times.
fn in_lanes(text: &str, times: &[f64]) -> f64 {
    let compiled = compile(text);
    median(21, || {
        let mut motion = started(&compiled, &Times::listed(times[0], times.to_vec()));
        per_step(STEPS, || {
            while let Some(row) = motion.next_row() {
                black_box(row.expect("it moves"));
            }
        })
    })
}

/// So many times from one to another (s).
fn turn_of(from: f64, to: f64) -> Vec<f64> {
    (0..STEPS).map(|k| from + (to - from) * f64::from(k) / f64::from(STEPS - 1)).collect()
}

fn four_bars(floor: f64) {
    let mut table = Table::new("N four-bars; per four-bar", floor);
    for n in [1, 10, 100, 1_000, 10_000] {
        let compiled = compile(&mechanisms::four_bars(n));
        table.row(&n.to_string(), n as f64, &ways(&compiled, STEPS));
    }
}

fn scissor_lifts(floor: f64) {
    let mut table = Table::new("scissor lift of N cells; per cell", floor);
    for n in [1, 10, 100, 1_000, 10_000] {
        let compiled = compile(&mechanisms::scissor_lift(n));
        table.row(&n.to_string(), n as f64, &ways(&compiled, STEPS));
    }
}

/// ns a step: mechc, and the same Newton with a dense LU (where that can be waited for) and with a sparse one.
fn ways(compiled: &Compiled, steps: u32) -> [Option<f64>; 3] {
    let (determined, program) = compiled.inside();
    let n = determined.system().coordinates().len();
    let [from, to, _] = compiled.analysis().expect("an analysis");
    let every = (to - from) / f64::from(steps - 1);
    let times = Times::grid(from, to, every).expect("a grid");
    let start = coordinates(&started(compiled, &times));
    let rounds = if n > 2_000 { 3 } else { 9 };
    let library = median(rounds, || {
        let mut motion = started(compiled, &times);
        per_step(steps, || {
            while let Some(row) = motion.next_row() {
                black_box(row.expect("it moves"));
            }
        })
    });
    let few = if n > 2_000 { A_FEW_STEPS } else { 100 };
    let dense = (n <= LARGEST_DENSE).then(|| {
        let mut newton = Newton::new(Dense::new(&determined), &determined, &program, &start);
        followed(&mut newton, few, from, every)
    });
    let mut newton = Newton::new(Sparse::new(&determined), &determined, &program, &start);
    let sparse = followed(&mut newton, few, from, every);
    [Some(library), dense, Some(sparse)]
}

/// ns a step of a Newton, after some steps that are not counted.
fn followed<L: Linear>(newton: &mut Newton<'_, L>, steps: u32, from: f64, every: f64) -> f64 {
    let mut k = 0;
    median(3, || {
        per_step(steps, || {
            for _ in 0..steps {
                k += 1;
                black_box(newton.step(black_box(from + f64::from(k) * every)));
            }
        })
    })
}

fn started(compiled: &Compiled, times: &Times) -> Run {
    compiled.run(times, &RunOptions::default()).0.expect("it assembles")
}

/// The assembled ones.
fn coordinates(run: &Run) -> Vec<f64> {
    run.assembly().coordinates.iter().map(|(_, q, _)| *q).collect()
}

/// From text to the first row.
fn set_up() {
    println!("set-up, from text to the first row");
    for (name, text) in [
        ("four-bar", mechanisms::four_bars(1)),
        ("999 bodies: 333 four-bars", mechanisms::four_bars(333)),
        ("1,000 bodies: scissor lift", mechanisms::scissor_lift(500)),
        ("9,999 bodies: 3,333 four-bars", mechanisms::four_bars(3_333)),
        ("10,000 bodies: scissor lift", mechanisms::scissor_lift(5_000)),
    ] {
        let time = median(3, || {
            per_step(1, || {
                let compiled = compile(&text);
                let mut motion = started(&compiled, &Times::listed(0.0, vec![0.0]));
                black_box(motion.next_row().expect("a row").expect("it moves"));
            })
        });
        println!("  {name:<32} {:>9.2} ms", time * 1e-6);
    }
    println!();
}

/// Rows of the four-bar as text.
fn output() {
    println!("the four-bar's table, 28 numbers a row, solving not counted");
    let compiled = compile(&mechanisms::four_bars(1));
    let motion = started(&compiled, &Times::listed(0.0, turn().collect()));
    let columns = motion.columns().to_vec();
    let units: Vec<String> = motion.units().iter().map(|unit| unit.text.clone()).collect();
    let units: Vec<&str> = units.iter().map(String::as_str).collect();
    let rows: Vec<Vec<f64>> = motion.map(|row| row.expect("it moves")).collect();
    for (name, format) in [("CSV", TableFormat::Csv), ("JSON", TableFormat::Json), ("Parquet", TableFormat::Parquet)] {
        let time = median(9, || {
            per_step(STEPS, || {
                let mut table = TableWriter::new(std::io::sink(), format, &columns, &units).expect("a sink");
                for row in &rows {
                    table.row(row).expect("a sink");
                }
                table.finish().expect("a sink");
            })
        });
        println!("  {name:<32} {time:>9.0} ns a row");
    }
    println!();
}
