//! Emitted Rust: goldens, what is in the objects, and how the functions answer. `tests/listed/modules.rs` compiles all modules there are and
//! compares them with the interpreter.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::compiling::{Emitted, POINTS, bits_of, compile, interpreted, point};
use mechc::RustOptions;
use std::fs;
use std::path::{Path, PathBuf};

/// What firmware is built with.
const FIRMWARE: [&str; 6] = ["--crate-type", "lib", "--emit", "obj", "-C", "panic=abort"];

#[test]
fn modules_cannot_panic() {
    let folder = tempfile::tempdir().expect("a folder");
    let kinds = [("slider_crank", "3"), ("slider_crank", "s"), ("everything", "3"), ("contacts", "s"), ("tables", "z")];
    for (name, level) in kinds {
        let emitted = Emitted::new(name.to_owned(), &stage_path(name), 0).expect("determined");
        let object = object(folder.path(), name, &emitted.text(Some(4)), level);
        assert!(has_symbol(&object, b"assemble") && has_symbol(&object, b"step"), "{name} has no functions");
        assert!(!has_symbol(&object, b"panic"), "{name} refers to the panicking machinery at level {level}");
    }
    let followed = [
        ("following/four_bar", "3"),
        ("following/platform", "s"),
        ("following/slider_crank", "3"),
        // measures that are derivatives; params in structures
        ("slopes/asked", "s"),
        ("slopes/drive", "3"),
    ];
    for (file, level) in followed {
        let path = PathBuf::from(format!("tests/{file}.mech"));
        let name = path.file_stem().expect("a name").to_str().expect("a name");
        let emitted = Emitted::new(name.to_owned(), &path, 0).expect("determined");
        let options = RustOptions { with_sensitivities: true, lanes: Some(2), ..RustOptions::new("machine.mech") };
        let text = emitted.compiled.rust(&options).0.expect("a module");
        let object = object(folder.path(), name, &text, level);
        assert!(["follow", "influence"].iter().all(|word| has_symbol(&object, word.as_bytes())), "{name}");
        assert!(!has_symbol(&object, b"panic"), "{name} refers to the panicking machinery at level {level}");
    }
    // what is looked for is what there would be
    let panics = "pub fn at(values: &[f64], k: usize) -> f64 { values[k] }\n";
    assert!(has_symbol(&object(folder.path(), "panics", panics, "3"), b"panic"));
}

/// What a text is compiled to for firmware.
fn object(folder: &Path, name: &str, text: &str, level: &str) -> Vec<u8> {
    let (path, object) = (folder.join(format!("{name}.rs")), folder.join(format!("{name}.o")));
    fs::write(&path, format!("#![no_std]\n{text}")).expect("written");
    let level = format!("opt-level={level}");
    let out = object.to_string_lossy();
    let arguments = [&FIRMWARE[..], &["-C", &level, "-o", &out]].concat();
    compile("rustc", &arguments, &path).unwrap_or_else(|why| panic!("{name}: {why}"));
    fs::read(&object).expect("an object")
}

/// Whether an object's names hold a word.
fn has_symbol(object: &[u8], word: &[u8]) -> bool {
    object.windows(word.len()).any(|bytes| bytes == word)
}

fn stage_path(name: &str) -> PathBuf {
    PathBuf::from(format!("tests/stages/{name}/input.mech"))
}

/// The mechanism of a folder of stages.
fn stage(name: &str) -> Emitted {
    Emitted::new(name.to_owned(), &stage_path(name), 0).expect("determined")
}

#[allow(clippy::pedantic, dead_code, unused_imports)] // code of another hand
#[path = "../emitted/slider_crank.rs"]
#[rustfmt::skip]
mod slider_crank;

/// Returns a mechanism with so many measures, each of some eighty operations.
fn with_measures(count: usize) -> Emitted {
    let text = format!(
        "mechanism many {{
    ground {{ point O = (0, 0) }}
    body wheel {{ point O = (0, 0)  point P = (1 m, 0) }}
    joint axle: revolute(ground.O, wheel.O)
    driver motor: rotation(axle) = t * 1 rad/s
    measure wave[k in 0..{count}] = sin(k * t / 1 s) * cos(x(wheel.P) * (k + 1) / 1 m) * exp(t / 1 s) * y(wheel.P)
}}"
    );
    Emitted::of("many".to_owned(), &text, Path::new("many.mech"), 0).expect("determined")
}

#[test]
fn large_mechanisms_are_errors() {
    let just_fits = with_measures(1250);
    assert!(just_fits.text(None).contains("pub fn step"));
    for (count, operations, do_equations_fit) in [(1251, "100051", true), (2600, "207971", false)] {
        let large = with_measures(count).compiled;
        let (module, messages) = large.rust(&RustOptions::new("many.mech"));
        let [error] = messages.iter().collect::<Vec<_>>()[..] else { panic!("{messages:?}") };
        assert!(module.is_none() && error.code.as_str() == "E0706" && error.message.contains(operations), "{error:?}");
        assert!(error.help[0].contains("mechc run"), "{error:?}");
        assert_eq!(error.help.iter().any(|help| help.contains("--with equations")), do_equations_fit);
        let equations = RustOptions { with_motion: false, ..RustOptions::new("many.mech") };
        assert_eq!(large.rust(&equations).0.is_some(), do_equations_fit);
    }
}

/// What comes behind what was generated: the same files for all mechanisms.
const GOES_ALONG: &str = "\n/// What solves the equations and follows the motion, the same for all mechanisms.\n";

/// Constructs whose code is that of the motion too; of the others it is that of the equations.
const OF_MOTION: [&str; 7] = ["branches_of_motion", "branches_of_time", "forces", "inputs", "loop", "plain", "rims"];

#[test]
fn generated_constructs_match_goldens() {
    let paths = support::files("tests/emitted/constructs", "mech");
    assert!(OF_MOTION.iter().all(|name| paths.iter().any(|path| support::stem(path) == *name)));
    for path in paths {
        let name = support::stem(&path);
        let emitted = Emitted::new(name.clone(), &path, 0).expect("determined");
        let with_motion = OF_MOTION.contains(&name.as_str());
        let options = RustOptions { with_motion, ..RustOptions::new(format!("{name}.mech")) };
        let text = emitted.compiled.rust(&options).0.expect("a module");
        let (generated, _) = text.split_once(GOES_ALONG).unwrap_or((&text, ""));
        support::golden::holds(path.with_extension("rs"), generated);
    }
}

/// A whole module, which tests here run.
#[test]
fn golden_matches_emission() {
    let path = Path::new("tests/stages/slider_crank/input.mech");
    let emitted = Emitted::new("slider_crank".to_owned(), path, 0).expect("determined");
    support::golden::holds("tests/emitted/slider_crank.rs", &emitted.text(Some(4)));
}

/// Compares a golden, as cargo has compiled it, with the interpreter at a random point.
macro_rules! agrees {
    ($module:ident) => {
        let compiled = stage(stringify!($module)).compiled;
        for seed in 1..=POINTS {
            let (q, qd, t) = point($module::N, seed);
            let (q, qd) = (q.try_into().unwrap(), qd.try_into().unwrap());
            let p = $module::Params::default();
            let got: Vec<u64> = $module::phi(&q, t, &p)
                .into_iter()
                .chain($module::phi_q(&q, t, &p))
                .chain($module::phi_t(&q, t, &p))
                .chain($module::nu(&q, t, &p))
                .chain($module::gamma(&q, &qd, t, &p))
                .map(bits_of)
                .collect();
            assert_eq!(got, interpreted(&compiled, seed), stringify!($module));
            let dense = $module::phi_q_dense(&q, t, &p);
            for ((row, column), value) in $module::PHI_Q_PATTERN.into_iter().zip($module::phi_q(&q, t, &p)) {
                assert_eq!(bits_of(dense[row][column]), bits_of(value));
            }
        }
    };
}

#[test]
fn goldens_agree_with_the_interpreter() {
    agrees!(slider_crank);
}

#[test]
fn lanes_of_variants_have_the_bits_of_each_alone() {
    use slider_crank::{Params, assemble, lanes, step};
    let params: [Params; 4] =
        std::array::from_fn(|k| Params { crank_length: 0.05 + 0.004 * k as f64, ..Params::default() });
    let mut all = lanes::assemble(&params).expect("the file's does").0;
    let mut each = params.map(|params| assemble(&params).expect("it assembles"));
    for row in 0..60 {
        // each at times of its own; now and then a long way, for which a step is not enough
        let times: [f64; 4] =
            std::array::from_fn(|k| 0.001 * f64::from(row) * (1.0 + k as f64) + 0.03 * f64::from(row % 7 / 6));
        let done = lanes::step_each(&times, &mut all);
        for (k, state) in each.iter_mut().enumerate() {
            assert_eq!(step(times[k], state), done[k]);
            let lane = all.get(k).expect("a lane");
            assert_eq!(lane.row().map(f64::to_bits), state.row().map(f64::to_bits), "lane {k} at {}", times[k]);
        }
    }
    assert!(all.get(4).is_none());
}

#[test]
fn far_times_are_reached_in_parts() {
    use slider_crank::{Error, LONGEST_STEP, Params, Progress, assemble, step, step_within};
    let mut far = assemble(&Params::default()).expect("it assembles");
    let mut whole = far.clone();
    assert_eq!(step(1e6, &mut far), Err(Error::TooFar), "nothing diverges");
    assert_eq!(format!("{far:?}"), format!("{whole:?}"), "and nothing has changed");
    assert_eq!(step_within(far.t(), &mut far.clone(), 0), Ok(Progress::REACHED), "it is there");
    assert_eq!(step_within(f64::NAN, &mut far, 0), Err(Error::NotANumber));
    // a deadline is kept, and all is as in one go
    let mut parts = whole.clone();
    let t = 50.5 * LONGEST_STEP;
    step(t, &mut whole).expect("it moves");
    let mut calls = 0;
    let mut before = parts.t();
    loop {
        let progress = step_within(t, &mut parts, 3).expect("it moves");
        let part = (parts.t() - before) / (t - before);
        assert!((progress.fraction - part).abs() < 1e-12, "{progress:?} is not {part}");
        if progress.is_reached() {
            break;
        }
        assert!(parts.t() - before <= 3.0 * LONGEST_STEP * (1.0 + 1e-12), "more than three steps");
        (before, calls) = (parts.t(), calls + 1);
        assert!(calls < 100);
    }
    assert!(calls >= 16, "{calls} calls");
    assert_eq!(parts.row().map(f64::to_bits), whole.row().map(f64::to_bits));
}

#[test]
fn errors_keep_the_state() {
    use slider_crank::{Error, Params, assemble, step};
    let mut state = assemble(&Params::default()).expect("it assembles");
    step(0.01, &mut state).expect("it moves");
    let row = state.row();
    for t in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(step(t, &mut state), Err(Error::NotANumber));
        assert_eq!(state.row(), row);
    }
    let nan = Params { speed: f64::NAN, ..Params::default() };
    assert_eq!(assemble(&nan).err(), Some(Error::NotANumber));
    // a rod that does not reach
    let short = Params { rod_length: 0.02, ..Params::default() };
    assert_eq!(assemble(&short).err(), Some(Error::Divergence));
    // it turns a while, and then comes to its dead point
    let locks = Params { rod_length: 0.045, ..Params::default() };
    let mut state = assemble(&locks).expect("it assembles");
    step(0.002, &mut state).expect("it moves");
    let before = state.clone();
    assert_eq!(step(0.02, &mut state), Err(Error::LockUp));
    assert_eq!(format!("{state:?}"), format!("{before:?}"), "all of it is as it was");
}
