//! Every emitted module, each by its name: it stands alone, formatted and with nothing that the compiler or clippy has to say; and
//! compiled it gives the bits of the interpreter, at random points and along the whole motion.
//! `cargo test --test listed four_bar` compiles and compares one.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

#[path = "../emitted/compiling.rs"]
mod compiling;
#[path = "../emitted/texts.rs"]
mod texts;

use crate::named_tests::{Tests, is_requested};
use crate::support::{files, mechanisms, stem};
use compiling::{Emitted, POINTS, bits_of, compile, interpreted, point};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, OnceLock};

/// Modules that one run of rustc compiles: few, so that several runs share the machine, and enough that they are not many.
const BATCH: usize = 12;

/// So many modules of each kind are compiled unless this variable is set.
const A_DOZEN: usize = 12;
const ALL: &str = "MECHC_TEST_ALL_MODULES";

/// A module that is made when it is first asked for.
struct Module {
    name: String,
    make: Box<dyn Fn(String) -> Emitted + Send + Sync>,
    made: OnceLock<Made>,
}

/// A module with the rows of the interpreter, and whether it came to the end.
struct Made {
    emitted: Emitted,
    text: String,
    rows: Vec<Vec<f64>>,
    /// What it says of the forces in these, where there are any.
    forces: Vec<Vec<f64>>,
    ends_well: bool,
}

impl Module {
    fn new(name: impl Into<String>, make: impl Fn(String) -> Emitted + Send + Sync + 'static) -> Module {
        Module { name: name.into(), make: Box::new(make), made: OnceLock::new() }
    }

    fn made(&self) -> &Made {
        self.made.get_or_init(|| {
            let emitted = (self.make)(self.name.clone());
            let text = emitted.text(emitted.lanes());
            let ((rows, ends_well), forces) = (emitted.rows(), emitted.forces());
            Made { emitted, text, rows, forces, ends_well }
        })
    }
}

/// Modules that are compiled together, into a program that runs the one it is told.
struct Batch {
    modules: Vec<Module>,
    folder: tempfile::TempDir,
    binary: OnceLock<Result<PathBuf, String>>,
}

impl Batch {
    fn binary(&self) -> &Path {
        let made = self.binary.get_or_init(|| {
            for module in &self.modules {
                fs::write(self.folder.path().join(format!("{}.rs", module.name)), &module.made().text)
                    .expect("written");
            }
            fs::write(self.folder.path().join("random.rs"), include_str!("../support/random.rs")).expect("written");
            let (source, binary) = (self.folder.path().join("main.rs"), self.folder.path().join("main"));
            fs::write(&source, main_of(&self.modules)).expect("written");
            compile("rustc", &["-C", "opt-level=0", "-o", &binary.to_string_lossy()], &source).map(|()| binary)
        });
        made.as_ref().unwrap_or_else(|why| panic!("{why}"))
    }
}

/// What is not determined alone: a leg of the example `parallel_robot`, whose end the platform holds.
const HELD_BY_OTHERS: &str = "leg";

/// What has measures that only `run` computes: how forces change with params.
const FOR_RUN_ALONE: &str = "slider_crank_closed_form";

/// Examples, reference cases and the stages; formulas with rims; and one that takes several functions.
fn determined() -> Vec<Module> {
    let folders = [
        "examples",
        "tests/cases",
        "tests/cases_forces",
        "tests/forces",
        "tests/stages",
        "tests/following",
        "tests/slopes",
    ];
    let mut paths = folders.map(|folder| files(folder, "mech")).concat();
    paths.retain(|path| stem(path) != FOR_RUN_ALONE);
    let mut list: Vec<Module> = Vec::new();
    for path in paths {
        let names = mechanisms(&fs::read_to_string(&path).expect("a text"));
        let name = format!("{}_{}", stem(path.parent().expect("a folder")), stem(&path));
        for number in (0..names.len()).filter(|&number| names[number] != HELD_BY_OTHERS) {
            let name = if names.len() > 1 { format!("{name}_{number}") } else { name.clone() };
            let path = path.clone();
            list.push(Module::new(name, move |name| Emitted::new(name, &path, number).expect("determined")));
        }
    }
    let alone = [("lift", texts::scissor_lift(50)), ("ends_at_an_edge", texts::ends_at_an_edge())];
    let texts = texts::with_rims().into_iter().chain(alone.map(|(name, text)| (name.to_owned(), text)));
    list.extend(texts.map(|(name, text)| {
        Module::new(name, move |name| Emitted::of(name, &text, Path::new("text"), 0).expect("determined"))
    }));
    list
}

/// Mechanisms whose equations that follow from others are left out, and checked.
fn with_checks() -> Vec<Module> {
    let mut list = Vec::new();
    let mut add = |name: String, text: String| {
        list.push(Module::new(name, move |name| Emitted::without_redundant(name, &text)));
    };
    for seed in 1..=3_usize {
        let (_, random, _) = point(8, seed as u64);
        add(format!("planets{seed}"), texts::planets(seed + 1, &random));
        add(format!("examples_cranks{seed}"), texts::cranks(seed + 2, &random));
    }
    // a check with branches, and one that fails on the way
    for name in ["kinked", "parts_later"] {
        let text = fs::read_to_string(format!("tests/cli/redundant/{name}.mech")).expect("a text");
        add(format!("examples_{name}"), text);
    }
    list
}

fn stands_alone(batch: &Batch, number: usize) {
    let (folder, module) = (batch.folder.path(), &batch.modules[number]);
    let (name, text) = (&module.name, &module.made().text);
    let path = folder.join(format!("{name}_formatted.rs"));
    fs::write(&path, text).expect("written");
    let formatted =
        Command::new("rustfmt").args(["--check", "--edition", "2024"]).arg(&path).output().expect("rustfmt");
    assert!(formatted.status.success(), "{}", String::from_utf8_lossy(&formatted.stdout));
    let alone = folder.join(format!("{name}_alone.rs"));
    let head = "#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings)]\n";
    fs::write(&alone, format!("{head}{text}")).expect("written");
    let out = folder.join(format!("{name}.rmeta"));
    // rustc with clippy's lints: neither has anything to say
    let arguments = ["--crate-type", "lib", "--emit", "metadata", "-o", &out.to_string_lossy()];
    compile("clippy-driver", &arguments, &alone).unwrap_or_else(|why| panic!("{why}"));
    if name == "lift" {
        assert!(text.contains("        solve_"), "the loop calls no functions");
    }
}

fn has_the_bits_of_the_interpreter(batch: &Batch, number: usize) {
    let module = &batch.modules[number];
    let (name, Made { emitted, rows, forces, ends_well, .. }) = (&module.name, module.made());
    let output = Command::new(batch.binary()).arg(name).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let mut lines = text.lines();
    let mut next = || lines.next().expect("a line a point or time");
    for seed in 1..=POINTS {
        compare(name, next(), &interpreted(&emitted.compiled, seed));
    }
    let bits = |row: &Vec<f64>| row.iter().copied().map(bits_of).collect::<Vec<u64>>();
    for (k, row) in rows.iter().enumerate() {
        compare(name, next(), &bits(row));
        if let Some(forces) = forces.get(k) {
            compare(name, next(), &bits(forces));
        }
    }
    if !ends_well {
        let error = next();
        let errors = ["LockUp", "Bifurcation", "Divergence", "NotANumber", "Inconsistent", "NotSmooth"];
        assert!(errors.contains(&error), "{error}");
        assert!(!name.ends_with("parts_later") || error == "Inconsistent", "{error}");
    }
    assert_eq!(lines.next(), None);
}

fn is_checked_on_its_way(batch: &Batch, number: usize) {
    let module = &batch.modules[number];
    let Made { emitted, rows, ends_well, .. } = module.made();
    let checks = emitted.compiled.inside().0.system().checks().len();
    assert!(checks > 0 && rows.len() > 2, "{checks} checks, {} rows", rows.len());
    assert_eq!(*ends_well, !module.name.ends_with("parts_later"));
}

/// A program that prints what the module that it is told makes of random points and of the motion.
fn main_of(modules: &[Module]) -> String {
    let mut main = "#![forbid(unsafe_code)]\n#![allow(dead_code)]\n".to_owned();
    let mut calls = String::new();
    for module in modules {
        let name = &module.name;
        let Made { emitted, rows, forces, ends_well, .. } = module.made();
        // where the motion ends, a time beyond it must be refused
        let beyond = rows.last().map_or(0.0, |row| row[0]) + 1.0;
        let times: Vec<f64> = rows.iter().map(|row| row[0]).chain((!ends_well).then_some(beyond)).collect();
        let times = format!("{times:?} as [f64; {}]", times.len());
        writeln!(
            main,
            "#[path = \"{name}.rs\"]\nmod {name};\n{}",
            function_of(name, &times, emitted.lanes(), !forces.is_empty())
        )
        .expect("a string takes everything");
        writeln!(calls, "        Some(\"{name}\") => run_{name}(),").expect("a string takes everything");
    }
    main + &format!(
        "mod random;
fn points(n: usize) -> Vec<(Vec<f64>, Vec<f64>, f64)> {{
    let point = |mut random: random::Random| (random.vector(n, 1.0), random.vector(n, 3.0), random.part());
    (1..={POINTS}_u64).map(|seed| point(random::Random::new(seed))).collect()
}}
fn print(values: &[f64]) {{
    let bits: Vec<String> = values.iter().map(|v| if v.is_nan() {{ f64::NAN.to_bits() }} else {{ (v + 0.0).to_bits() }}).map(|b| b.to_string()).collect();
    println!(\"{{}}\", bits.join(\" \"));
}}
fn main() {{
    match std::env::args().nth(1).as_deref() {{
{calls}        name => panic!(\"no module {{name:?}}\"),
    }}
}}
"
    )
}

/// The function for one module, at some times and in some lanes.
fn function_of(name: &str, times: &str, lanes: Option<usize>, has_forces: bool) -> String {
    let forces = if has_forces { format!("; print(&{name}::forces(&state));") } else { String::new() };
    let mut text = format!(
        "fn run_{name}() {{
    for (q, qd, t) in points({name}::N) {{
        let (q, qd): ({name}::Q, {name}::Qd) = (q.try_into().unwrap(), qd.try_into().unwrap());
        let p = {name}::Params::default();
        let parts: [&[f64]; 5] = [&{name}::phi(&q, t, &p), &{name}::phi_q(&q, t, &p), &{name}::phi_t(&q, t, &p), &{name}::nu(&q, t, &p), &{name}::gamma(&q, &qd, t, &p)];
        print(&parts.concat());
    }}
    let mut state = {name}::assemble(&{name}::Params::default()).unwrap();
    for t in {times} {{
        match {name}::step(t, &mut state) {{
            Ok(()) => {{ print(&state.row()){forces} }}
            Err(error) => println!(\"{{error:?}}\"),
        }}
    }}
"
    );
    if let Some(lanes) = lanes {
        text += &format!(
            "    let params = [{name}::Params::default(); {lanes}];
    let (mut state, mut all) = ({name}::assemble(&params[0]).unwrap(), {name}::lanes::assemble(&params).unwrap().0);
    for t in {times} {{
        let alone = {name}::step(t, &mut state);
        for (k, result) in {name}::lanes::step_each(&[t; {lanes}], &mut all).into_iter().enumerate() {{
            assert_eq!(result, alone);
            assert_eq!(all.get(k).unwrap().row().map(f64::to_bits), state.row().map(f64::to_bits), \"lane {{k}} at {{t}}\");
        }}
    }}
"
        );
    }
    text + "}\n"
}

/// Compares numbers that a module has printed with what they should be, bit for bit.
fn compare(name: &str, line: &str, want: &[u64]) {
    let got: Vec<u64> = line.trim().split(' ').map(|bits| bits.parse().expect("bits")).collect();
    assert_eq!(got.len(), want.len(), "{name}");
    for (k, (a, b)) in got.iter().zip(want).enumerate() {
        assert_eq!(a, b, "{name}, value {k}: {} and {}", f64::from_bits(*a), f64::from_bits(*b));
    }
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let (determined, with_checks) = (determined(), with_checks());
    let count = determined.len();
    assert!(count >= 70, "{count} modules");
    // those that are not asked for are not compiled with the others
    let groups = |name: &str| ["alone", "bits", "checked"].map(|group| format!("{group}::{name}"));
    // to compile all of them takes minutes: a dozen stand for them unless all are asked for
    let is_all = std::env::var_os(ALL).is_some();
    let is_wanted = |module: &Module| groups(&module.name).iter().any(|name| is_requested(name));
    let checked: Vec<String> = with_checks.iter().map(|module| module.name.clone()).collect();
    let chosen = |every: usize| move |(k, _): &(usize, Module)| is_all || k % every == 0;
    let determined = determined.into_iter().enumerate().filter(chosen(count / A_DOZEN)).map(|(_, module)| module);
    let with_checks = with_checks.into_iter().enumerate().filter(chosen(checked.len() / 2)).map(|(_, module)| module);
    let mut left = determined.chain(with_checks).filter(is_wanted).peekable();
    let mut batches = Vec::new();
    while left.peek().is_some() {
        let (modules, folder) = (left.by_ref().take(BATCH).collect(), tempfile::tempdir().expect("a folder"));
        batches.push(Arc::new(Batch { modules, folder, binary: OnceLock::new() }));
    }
    // one of each batch after the other, so that no two wait for the same run of rustc while another could begin
    let turns = (0..BATCH).flat_map(|number| batches.iter().map(move |batch| (batch, number)));
    for (batch, number) in turns.filter(|(batch, number)| *number < batch.modules.len()) {
        let name = &batch.modules[number].name;
        let [alone, bits, is_checked] = groups(name);
        let of = |test: fn(&Batch, usize)| {
            let batch = Arc::clone(batch);
            move || test(&batch, number)
        };
        tests.add(bits, of(has_the_bits_of_the_interpreter));
        tests.add(alone, of(stands_alone));
        if checked.contains(name) {
            tests.add(is_checked, of(is_checked_on_its_way));
        }
    }
    // each folder goes with the last test of its batch
    drop(batches);
}
