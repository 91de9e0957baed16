//! Emitted Rust: compiled, and compared with the interpreter bit for bit at random points.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use mechc::rooms::program::Stage;
use mechc::{Compiled, LARGEST_STRAIGHT, RustOptions};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{all_rows, compile_number, compile_without_redundant, files, mechanisms, stem};

/// Points at which each module is compared.
const POINTS: u64 = 3;

/// What is emitted.
struct Emitted {
    name: String,
    compiled: Compiled,
}

impl Emitted {
    fn new(name: String, path: &Path, number: usize) -> Option<Emitted> {
        Emitted::of(name, &fs::read_to_string(path).expect("a text"), path, number)
    }

    fn of(name: String, text: &str, path: &Path, number: usize) -> Option<Emitted> {
        let (compiled, _) = compile_number(path, text, number);
        compiled.map(|compiled| Emitted { name, compiled })
    }

    /// The first mechanism of a text, whose redundant equations are left out.
    fn without_redundant(name: String, text: &str) -> Emitted {
        let (compiled, outcome) = compile_without_redundant(&name, text);
        let compiled = compiled.unwrap_or_else(|| panic!("{}\n{text}", outcome.text()));
        Emitted { name, compiled }
    }

    /// The module, with so many lanes if any are wanted.
    fn text(&self, lanes: Option<usize>) -> String {
        self.text_of(lanes, LARGEST_STRAIGHT)
    }

    /// The same with operations as numbers beyond so many.
    fn text_of(&self, lanes: Option<usize>, largest_straight: usize) -> String {
        let file = format!("{}.mech", self.name);
        let (text, said) = self.compiled.rust(&RustOptions { lanes, largest_straight, ..RustOptions::of(file) });
        text.unwrap_or_else(|| panic!("{}: {said:?}", self.name))
    }

    /// How many lanes it has where all are looked at: the examples show what there is to see.
    fn lanes(&self) -> Option<usize> {
        (self.name.starts_with("examples_") || self.name.starts_with("rim_")).then_some(3)
    }

    /// Beyond how many operations they are written as numbers: the stages are, as if they were large.
    fn largest_straight(&self) -> usize {
        if self.name.ends_with("_input") { 0 } else { LARGEST_STRAIGHT }
    }

    /// The rows of the interpreter, and whether it came to the end.
    fn rows(&self) -> (Vec<Vec<f64>>, bool) {
        let Some(times) = self.compiled.times() else {
            return (Vec::new(), true);
        };
        let (rows, stop) = all_rows(&self.compiled, &times);
        (rows, stop.is_none())
    }
}

/// A scissor lift of so many cells, driven at its upper end: one block, whose loop is too long for one function.
fn scissor_lift(cells: usize) -> String {
    let (sin, cos) = mechc::rooms::math::sin_cos(0.5);
    let mut text = "mechanism lift {\n ground { point O = (0, 0) axis floor = O along (1, 0) }\n".to_owned();
    for k in 0..cells {
        let y = (k as f64 + 0.5) * sin;
        for (bar, x, phi) in [("a", 0.5 * cos + 0.003, 0.5), ("b", 0.5 * cos, -0.5)] {
            text += &format!(
                " body {bar}{k} at ({x}, {y}, {phi}) {{ point L = (-0.5, 0) point M = (0, 0) point R = (0.5, 0) }}\n"
            );
        }
        text += &format!(" joint m{k}: revolute(a{k}.M, b{k}.M)\n");
    }
    for (k, next) in (1..cells).enumerate() {
        text += &format!(" joint l{k}: revolute(b{k}.L, a{next}.L)\n joint r{k}: revolute(a{k}.R, b{next}.R)\n");
    }
    text += " joint base: revolute(ground.O, a0.L)\n joint roll: revolute_translational(b0.R, ground.floor)\n";
    let (top, height) = (cells - 1, cells as f64 * sin);
    text + &format!(" driver lift: y(a{top}.R) = {height} + 0.1 * sin(t)\n analysis from 0 to 1 every 0.1\n}}")
}

/// Formulas that come to the end of what their functions take, smoothly and not, and measures that have no value at times.
fn with_rims() -> Vec<Emitted> {
    let formulas = [
        ("root", "0.3 * sqrt((t - 0.70013)^2)"),
        ("arc", "0.1 * acos(cos(3 * (t - 0.70013)))"),
        ("cusp", "((t - 0.70013)^2)^0.25"),
        ("hidden", "(t - 0.70013) * sqrt((t - 0.70013)^2 + 1e-6)"),
        ("smooth", "sqrt((t - 0.70013)^4) + 0.1 * hypot((t - 1.1)^2, (t - 1.10007)^3)"),
        ("steep", "if t < 0.5 then 0.2 * abs(t - 1) else 0.1 + 0.2 * (0.5 - t) + (t - 0.5)^2 * sqrt((t - 0.9001)^2)"),
    ];
    let all = formulas.iter().map(|(name, formula)| {
        let text = format!(
            "mechanism slide {{
                ground {{ axis way = (0, 0) along (1, 0) }}
                body block {{ axis way = (0, 0) along (1, 0) }}
                joint guide: translational(ground.way, block.way)
                table bend = spline [(0, 0), (0.5, 1), (0.95, 0)]
                driver push: displacement(guide) = {formula}
                measure left = bend(t)
                measure pole = 1 / (t - 0.5)
                analysis from 0 s to 2 s every 0.1 s
            }}"
        );
        Emitted::of(format!("rim_{name}"), &text, Path::new(name), 0)
    });
    all.map(|emitted| emitted.expect("determined")).collect()
}

/// Everything that is emitted here: examples, reference cases and the stages, and one that takes several functions.
fn all() -> Vec<Emitted> {
    let paths = [files("examples", "mech"), files("tests/cases", "mech"), files("tests/stages", "mech")].concat();
    let lift = Emitted::of("lift".to_owned(), &scissor_lift(50), Path::new("lift"), 0).expect("determined");
    assert!(lift.text(None).contains("        solve_"), "the loop calls no functions");
    let all: Vec<Emitted> = paths
        .iter()
        .flat_map(|path| {
            let names = mechanisms(&fs::read_to_string(path).expect("a text"));
            let folder = stem(path.parent().expect("a folder"));
            let name = format!("{folder}_{}", stem(path));
            let several = names.len() > 1;
            (0..names.len()).filter_map(move |number| {
                let name = if several { format!("{name}_{number}") } else { name.clone() };
                Emitted::new(name, path, number)
            })
        })
        .chain([lift])
        .chain(with_rims())
        .collect();
    assert!(all.len() >= 70, "{} systems", all.len());
    all
}

/// Where cargo has put the libraries of this test.
fn libraries() -> PathBuf {
    std::env::current_exe().expect("a path").parent().expect("a folder").to_owned()
}

fn libm() -> PathBuf {
    let found = fs::read_dir(libraries()).expect("a folder").filter_map(|entry| {
        let path = entry.ok()?.path();
        let is_library = path.extension().is_some_and(|ending| ending == "rlib");
        (is_library && stem(&path).starts_with("liblibm-")).then_some(path)
    });
    found.max_by_key(|path| fs::metadata(path).and_then(|data| data.modified()).ok()).expect("libm is a dependency")
}

fn rustc(arguments: &[&str], source: &Path) {
    compiler("rustc", arguments, source);
}

fn compiler(compiler: &str, arguments: &[&str], source: &Path) {
    let output = Command::new(compiler)
        .args(["--edition", "2024"])
        .args(arguments)
        .arg("--extern")
        .arg(format!("libm={}", libm().display()))
        .arg(source)
        .output()
        .expect("rustc is there, as cargo is");
    assert!(output.status.success(), "{}: {}", source.display(), String::from_utf8_lossy(&output.stderr));
}

/// Coordinates, velocities and a time that are the same wherever they are made.
fn point(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>, f64) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let q = (0..n).map(|_| next()).collect();
    let qd = (0..n).map(|_| 3.0 * next()).collect();
    (q, qd, next().abs())
}

/// What the interpreter makes of a point: Φ, Φ_q, Φ_t, ν, γ, as bits.
fn interpreted(compiled: &Compiled, seed: u64) -> Vec<u64> {
    let (determined, program) = compiled.inside();
    let system = determined.system();
    let params: Vec<f64> = system.params.iter().map(|param| param.value).collect();
    let mut registers = program.start(&params);
    let (q, qd, t) = point(system.coordinates.len(), seed);
    registers.set(program.inputs.time, t);
    registers.set_all(program.inputs.coordinates[0], &q);
    registers.set_all(program.inputs.coordinates[1], &qd);
    for stage in [Stage::Time, Stage::Position, Stage::Velocity, Stage::Acceleration] {
        program.run(stage, &mut registers);
    }
    let outputs = &program.outputs;
    let bits = |list: &[u32], sign: f64| -> Vec<u64> {
        // a zero has no sign that anybody could ask for
        list.iter().map(|&register| bits_of(sign * registers.get(register))).collect()
    };
    [
        bits(&outputs.phi, 1.0),
        bits(&outputs.phi_q, 1.0),
        bits(&outputs.nu, -1.0),
        bits(&outputs.nu, 1.0),
        bits(&outputs.gamma, 1.0),
    ]
    .concat()
}

fn bits_of(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { (value + 0.0).to_bits() }
}

/// The emitted modules in a folder, each formatted, and with nothing that the compiler or clippy has to say.
fn write_modules(all: &[Emitted], folder: &Path) {
    let half = all.len().div_ceil(2);
    std::thread::scope(|scope| {
        for part in all.chunks(half) {
            scope.spawn(move || part.iter().for_each(|emitted| write_module(emitted, folder)));
        }
    });
}

fn write_module(emitted: &Emitted, folder: &Path) {
    let (name, text) = (&emitted.name, emitted.text_of(emitted.lanes(), emitted.largest_straight()));
    let path = folder.join(format!("{name}.rs"));
    fs::write(&path, &text).expect("written");
    let formatted =
        Command::new("rustfmt").args(["--check", "--edition", "2024"]).arg(&path).output().expect("rustfmt");
    assert!(formatted.status.success(), "{name}: {}", String::from_utf8_lossy(&formatted.stdout));
    let alone = folder.join(format!("{name}_alone.rs"));
    fs::write(&alone, format!("#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings)]\n{text}")).expect("written");
    let out = folder.join(format!("{name}.rmeta"));
    // rustc with clippy's lints: neither has anything to say
    compiler("clippy-driver", &["--crate-type", "lib", "--emit", "metadata", "-o", &out.to_string_lossy()], &alone);
}

/// A program that prints what all modules make of random points and of the motion.
fn write_main(all: &[(Emitted, Vec<Vec<f64>>, bool)], folder: &Path) -> PathBuf {
    let mut main = "#![forbid(unsafe_code)]\n#![allow(dead_code)]\n".to_owned();
    let mut calls = String::new();
    for (emitted, rows, ends_well) in all {
        let name = &emitted.name;
        // where the motion ends, a time beyond it must be refused
        let beyond = rows.last().map_or(0.0, |row| row[0]) + 1.0;
        let times: Vec<f64> = rows.iter().map(|row| row[0]).chain((!ends_well).then_some(beyond)).collect();
        writeln!(main, "#[path = \"{name}.rs\"]\nmod {name};").expect("a string takes everything");
        writeln!(
            calls,
            "    for (q, qd, t) in points({name}::N) {{
        let (q, qd): ({name}::Q, {name}::Qd) = (q.try_into().unwrap(), qd.try_into().unwrap());
        let p = {name}::Params::default();
        let parts: [&[f64]; 5] = [&{name}::phi(&q, t, &p), &{name}::phi_q(&q, t, &p), &{name}::phi_t(&q, t, &p), &{name}::nu(&q, t, &p), &{name}::gamma(&q, &qd, t, &p)];
        print(\"{name}\", &parts.concat());
    }}
    let mut state = {name}::assemble(&{name}::Params::default()).unwrap();
    for t in {times:?} as [f64; {}] {{
        match {name}::step(t, &mut state) {{
            Ok(()) => print(\"{name}\", &state.row()),
            Err(error) => println!(\"{name} {{error:?}}\"),
        }}
    }}",
            times.len()
        )
        .expect("a string takes everything");
        if let Some(lanes) = emitted.lanes() {
            writeln!(
                calls,
                "    let params = [{name}::Params::default(); {lanes}];
    let (mut state, mut all) = ({name}::assemble(&params[0]).unwrap(), {name}::lanes::assemble(&params).unwrap().0);
    for t in {times:?} as [f64; {}] {{
        let alone = {name}::step(t, &mut state);
        for (k, result) in {name}::lanes::step_each(&[t; {lanes}], &mut all).into_iter().enumerate() {{
            assert_eq!(result, alone);
            assert_eq!(all.get(k).unwrap().row().map(f64::to_bits), state.row().map(f64::to_bits), \"{name} {{t}}\");
        }}
    }}",
                times.len()
            )
            .expect("a string takes everything");
        }
    }
    write!(
        main,
        "fn points(n: usize) -> Vec<(Vec<f64>, Vec<f64>, f64)> {{
    (1..={POINTS}_u64).map(|seed| point(n, seed)).collect()
}}
fn point(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>, f64) {{
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1;
    let mut next = || {{
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }};
    let q = (0..n).map(|_| next()).collect();
    let qd = (0..n).map(|_| 3.0 * next()).collect();
    (q, qd, next().abs())
}}
fn print(name: &str, values: &[f64]) {{
    let bits: Vec<String> = values.iter().map(|v| if v.is_nan() {{ f64::NAN.to_bits() }} else {{ (v + 0.0).to_bits() }}).map(|b| b.to_string()).collect();
    println!(\"{{name}} {{}}\", bits.join(\" \"));
}}
fn main() {{
{calls}}}
"
    )
    .expect("a string takes everything");
    let source = folder.join("main.rs");
    fs::write(&source, main).expect("written");
    source
}

#[test]
fn every_module_stands_alone_and_gives_the_bits_of_the_interpreter() {
    stand_alone_and_agree(all());
}

#[test]
fn what_is_left_out_is_checked_and_the_rest_has_the_bits_of_the_interpreter() {
    let mut all: Vec<Emitted> = Vec::new();
    for seed in 1..=3 {
        let (_, random, _) = point(8, seed);
        all.push(Emitted::without_redundant(format!("planets{seed}_input"), &planets(seed as usize + 1, &random)));
        all.push(Emitted::without_redundant(format!("examples_cranks{seed}"), &cranks(seed as usize + 2, &random)));
    }
    // a check with branches, and one that fails on the way
    for name in ["kinked", "parts_later"] {
        let text = fs::read_to_string(format!("tests/cli/redundant/{name}.mech")).expect("a text");
        all.push(Emitted::without_redundant(format!("examples_{name}"), &text));
    }
    for emitted in &all {
        let ((determined, _), (rows, ends_well)) = (emitted.compiled.inside(), emitted.rows());
        let checks = determined.system().checks.len();
        assert!(checks > 0 && rows.len() > 2, "{}: {checks} checks, {} rows", emitted.name, rows.len());
        assert_eq!(ends_well, !emitted.name.ends_with("parts_later"), "{}", emitted.name);
    }
    let last = stand_alone_and_agree(all);
    assert_eq!(last.as_deref(), Some("examples_parts_later Inconsistent"));
}

/// A planetary gear with so many planets, of which one would do.
fn planets(count: usize, random: &[f64]) -> String {
    let (sun, planet, turn) = (24.0 + 8.0 * random[0], 18.0 + 6.0 * random[1], 40.0 * random[2]);
    let (arm, ring) = (sun + planet, sun + 2.0 * planet);
    let mut text = format!(
        "mechanism planets {{\n ground {{ point O = (0, 0) circle ring = O radius {ring} mm }}
 body sun at (0, 0, {turn} deg) {{ point O = (0, 0) circle c = O radius {sun} mm }}
 joint axle: revolute(ground.O, sun.O)\n joint hub: revolute(ground.O, carrier.O)
 driver motor: rotation(axle) = {turn} deg + 300 deg/s * t + 20 deg * sin(7 rad/s * t)
 measure spin = angle(p0) - angle(carrier)\n analysis from 0 s to 0.6 s every 50 ms\n"
    );
    let mut pins = String::new();
    for k in 0..count {
        let (sin, cos) = mechc::rooms::math::sin_cos(std::f64::consts::TAU * k as f64 / count as f64);
        let (x, y) = (arm * cos, arm * sin);
        pins += &format!(" point pin{k} = ({x} mm, {y} mm)");
        text += &format!(
            " body p{k} at ({x} mm, {y} mm, {} deg) {{ point O = (0, 0) circle c = O radius {planet} mm }}
 joint pin{k}: revolute(carrier.pin{k}, p{k}.O)
 joint outer{k}: gear(sun.c, p{k}.c)\n joint inner{k}: internal_gear(ground.ring, p{k}.c)\n",
            90.0 * random[3 + k]
        );
    }
    text + &format!(" body carrier at (0, 0, 0) {{ point O = (0, 0){pins} }}\n}}\n")
}

/// A seat on so many parallel cranks, of which two would do.
fn cranks(count: usize, random: &[f64]) -> String {
    let (length, turn) = (0.3 + 0.1 * random[0], 60.0 + 10.0 * random[1]);
    let (mut ground, mut seat, mut rest) = (String::new(), String::new(), String::new());
    let (sin, cos) = mechc::rooms::math::sin_cos(turn.to_radians());
    for k in 0..count {
        let (x, y) = (k as f64 + 0.3 * random[2 + k], 0.4 * random[7 - k]);
        ground += &format!(" point P{k} = ({x} m, {y} m)");
        seat += &format!(" point P{k} = ({x} m, {y} m)");
        rest += &format!(
            " body c{k} at ({x} m, {y} m, {turn} deg) {{ point O = (0, 0) point P = (r, 0) }}
 joint low{k}: revolute(ground.P{k}, c{k}.O)\n joint high{k}: revolute(c{k}.P, seat.P{k})\n"
        );
    }
    format!(
        "mechanism cranks {{\n param r = {length} m\n ground {{{ground} }}
 body seat at ({} m, {} m, 0) {{{seat} }}\n{rest} driver motor: rotation(low0) = {turn} deg + 50 deg * sin(3 rad/s * t)
 analysis from 0 s to 1 s every 0.1 s\n}}\n",
        length * cos,
        length * sin,
    )
}

/// Compiles modules and compares them with the interpreter; gives the last line that a module printed.
fn stand_alone_and_agree(all: Vec<Emitted>) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    write_modules(&all, folder.path());
    let all: Vec<(Emitted, Vec<Vec<f64>>, bool)> = all
        .into_iter()
        .map(|emitted| {
            let (rows, ends_well) = emitted.rows();
            (emitted, rows, ends_well)
        })
        .collect();
    let source = write_main(&all, folder.path());
    let binary = folder.path().join("all");
    rustc(&["-C", "opt-level=0", "-o", &binary.to_string_lossy()], &source);
    let output = Command::new(&binary).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let mut lines = text.lines();
    for (Emitted { name, compiled }, rows, ends_well) in &all {
        let mut next =
            || lines.next().and_then(|line| line.strip_prefix(name.as_str())).expect("a line a point or time");
        for seed in 1..=POINTS {
            compare(name, next(), &interpreted(compiled, seed));
        }
        for row in rows {
            compare(name, next(), &row.iter().copied().map(bits_of).collect::<Vec<u64>>());
        }
        if !ends_well {
            let error = next();
            let errors = [" LockUp", " Bifurcation", " Divergence", " NotANumber", " Inconsistent", " NotSmooth"];
            assert!(errors.contains(&error), "{name}: {error}");
        }
    }
    assert_eq!(lines.next(), None);
    text.lines().last().map(str::to_owned)
}

/// Compares numbers that a module has printed with what they should be, bit for bit.
fn compare(name: &str, line: &str, want: &[u64]) {
    let got: Vec<u64> = line.trim().split(' ').map(|bits| bits.parse().expect("bits")).collect();
    assert_eq!(got.len(), want.len(), "{name}");
    for (k, (a, b)) in got.iter().zip(want).enumerate() {
        assert_eq!(a, b, "{name}, value {k}: {} and {}", f64::from_bits(*a), f64::from_bits(*b));
    }
}

/// What firmware is built with.
const FIRMWARE: [&str; 6] = ["--crate-type", "lib", "--emit", "obj", "-C", "panic=abort"];

#[test]
fn nothing_in_a_module_can_panic() {
    let folder = tempfile::tempdir().expect("a folder");
    let kinds = [("slider_crank", "3"), ("slider_crank", "s"), ("everything", "3"), ("contacts", "s"), ("tables", "z")];
    for (name, level) in kinds {
        let emitted = Emitted::new(name.to_owned(), &stage_path(name), 0).expect("determined");
        // as lines, with lanes; and as numbers
        for text in [emitted.text(Some(4)), emitted.text_of(None, 0)] {
            let object = object(folder.path(), name, &text, level);
            assert!(has_symbol(&object, b"assemble") && has_symbol(&object, b"step"), "{name} has no functions");
            assert!(!has_symbol(&object, b"panic"), "{name} refers to the panicking machinery at level {level}");
        }
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
    rustc(&[&FIRMWARE[..], &["-C", &level, "-o", &object.to_string_lossy()]].concat(), &path);
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

#[allow(clippy::pedantic, dead_code)] // code of another hand
#[path = "emitted/everything.rs"]
#[rustfmt::skip]
mod everything;
#[allow(clippy::pedantic, dead_code)]
#[path = "emitted/odd_names.rs"]
#[rustfmt::skip]
mod odd_names;
#[allow(clippy::pedantic, dead_code)]
#[path = "emitted/slider_crank.rs"]
#[rustfmt::skip]
mod slider_crank;

/// What a reviewer reads, and the benchmark runs.
const GOLDENS: [&str; 4] = ["everything", "odd_names", "slider_crank", "four_bar"];

#[test]
fn goldens_are_what_is_emitted() {
    for name in GOLDENS {
        let (path, emitted) = if name == "four_bar" {
            let bench = Path::new("benches/steps/four_bar.mech");
            let emitted = Emitted::new("four_bar".to_owned(), bench, 0).expect("determined");
            ("benches/steps/four_bar.rs".to_owned(), emitted.text(Some(16)))
        } else {
            (format!("tests/emitted/{name}.rs"), stage(name).text((name == "slider_crank").then_some(4)))
        };
        if std::env::var_os("UPDATE_GOLDENS").is_some() {
            fs::write(&path, &emitted).expect("written");
        }
        let golden = fs::read_to_string(&path).expect("a golden");
        assert!(golden == emitted, "{path} is not what is emitted now; UPDATE_GOLDENS=1 cargo test writes it");
    }
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
    agrees!(everything);
    agrees!(odd_names);
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
fn a_time_that_is_far_away_is_told_as_that_and_reached_in_parts() {
    use slider_crank::{Error, LONGEST_STEP, Params, assemble, step, step_within};
    let mut far = assemble(&Params::default()).expect("it assembles");
    let mut whole = far.clone();
    assert_eq!(step(1e6, &mut far), Err(Error::TooFar), "nothing diverges");
    assert!(far.t() > 100.0 && far.t() < 1e6);
    assert_eq!(step_within(far.t(), &mut far.clone(), 0), Ok(()), "it is there");
    assert_eq!(step_within(f64::NAN, &mut far, 0), Err(Error::NotANumber));
    // a deadline is kept, and all is as in one go
    let mut parts = whole.clone();
    let t = 50.5 * LONGEST_STEP;
    step(t, &mut whole).expect("it moves");
    let mut calls = 0;
    let mut before = parts.t();
    while let Err(error) = step_within(t, &mut parts, 3) {
        assert_eq!(error, Error::TooFar);
        assert!(parts.t() - before <= 3.0 * LONGEST_STEP * (1.0 + 1e-12), "more than three steps");
        (before, calls) = (parts.t(), calls + 1);
        assert!(calls < 100);
    }
    assert!(calls >= 16, "{calls} calls");
    assert_eq!(parts.row().map(f64::to_bits), whole.row().map(f64::to_bits));
}

#[test]
fn what_cannot_be_is_an_error_and_leaves_the_state_as_it_was() {
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
    assert_eq!(step(0.02, &mut state), Err(Error::LockUp));
    let [x, y] = [state.q()[0], state.q()[1]];
    assert!(state.t() < 0.02 && x.is_finite() && y.is_finite());
}
