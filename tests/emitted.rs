//! Emitted Rust: compiled, and compared with the interpreter bit for bit at random points.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use mechc::emit;
use mechc::program::{Program, Stage};
use mechc::source::Sources;
use mechc::structure::Determined;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{compile, files, stem};

/// Points at which each module is compared.
const POINTS: u64 = 5;

/// Everything that is emitted here: examples, reference cases and the stages.
fn systems() -> Vec<(String, Determined)> {
    let paths = [files("examples", "mech"), files("tests/cases", "mech"), files("tests/stages", "mech")].concat();
    let systems: Vec<(String, Determined)> = paths
        .iter()
        .filter_map(|path| {
            let mut sources = Sources::default();
            let text = fs::read_to_string(path).expect("a text");
            let (determined, _) = compile(&mut sources, &stem(path), &text);
            let folder = stem(path.parent().expect("a folder"));
            determined.map(|determined| (format!("{folder}_{}", stem(path)), determined))
        })
        .collect();
    assert!(systems.len() >= 35, "{} systems", systems.len());
    systems
}

fn module(name: &str, determined: &Determined) -> String {
    emit::rust(determined.system(), &Program::new(determined.system()), &format!("{name}.mech"))
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
fn interpreted(determined: &Determined, seed: u64) -> Vec<u64> {
    let system = determined.system();
    let program = Program::new(system);
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

#[test]
fn every_module_compiles_alone_and_gives_the_same_bits() {
    let folder = tempfile::tempdir().expect("a folder");
    let systems = systems();
    let mut main = "#![forbid(unsafe_code)]\n#![deny(warnings)]\n#![allow(dead_code)]\n".to_owned();
    let mut calls = String::new();
    for (name, determined) in &systems {
        let path = folder.path().join(format!("{name}.rs"));
        fs::write(&path, module(name, determined)).expect("written");
        let formatted =
            Command::new("rustfmt").args(["--check", "--edition", "2024"]).arg(&path).output().expect("rustfmt");
        assert!(formatted.status.success(), "{name}: {}", String::from_utf8_lossy(&formatted.stdout));
        writeln!(main, "mod {name};").expect("a string takes everything");
        writeln!(
            calls,
            "    for line in points({name}::N) {{
        let (q, qd, t) = line;
        let (q, qd): ([f64; {name}::N], [f64; {name}::N]) = (q.try_into().unwrap(), qd.try_into().unwrap());
        let p = {name}::Params::default();
        let parts: [&[f64]; 5] = [&{name}::phi(&q, t, &p), &{name}::phi_q(&q, t, &p), &{name}::phi_t(&q, t, &p), &{name}::nu(&q, t, &p), &{name}::gamma(&q, &qd, t, &p)];
        print(\"{name}\", &parts.concat());
    }}"
        )
        .expect("a string takes everything");
        let flags = ["--crate-type", "lib", "--emit", "metadata", "-F", "unsafe_code", "-D", "warnings"];
        let out = folder.path().join("alone.rmeta");
        // rustc with clippy's lints: neither has anything to say
        compiler("clippy-driver", &[&flags[..], &["-o", &out.to_string_lossy()]].concat(), &path);
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
    let source = folder.path().join("main.rs");
    fs::write(&source, main).expect("written");
    let binary = folder.path().join("all");
    rustc(&["-C", "opt-level=1", "-o", &binary.to_string_lossy()], &source);
    let output = Command::new(&binary).output().expect("it runs");
    let text = String::from_utf8(output.stdout).expect("text");
    let mut lines = text.lines();
    for (name, determined) in &systems {
        for seed in 1..=POINTS {
            let line = lines.next().expect("a line a point");
            let got: Vec<u64> = line.split(' ').skip(1).map(|bits| bits.parse().expect("bits")).collect();
            let want = interpreted(determined, seed);
            assert!(line.starts_with(name.as_str()));
            for (k, (a, b)) in got.iter().zip(&want).enumerate() {
                assert_eq!(a, b, "{name}, value {k}: {} and {}", f64::from_bits(*a), f64::from_bits(*b));
            }
            assert_eq!(got.len(), want.len(), "{name}");
        }
    }
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

/// The mechanism of a folder of stages.
fn stage(name: &str) -> Determined {
    let mut sources = Sources::default();
    let text = fs::read_to_string(format!("tests/stages/{name}/input.mech")).expect("a text");
    compile(&mut sources, name, &text).0.expect("determined")
}

#[test]
fn goldens_are_what_is_emitted() {
    for name in ["everything", "odd_names", "slider_crank"] {
        let path = format!("tests/emitted/{name}.rs");
        let emitted = module(name, &stage(name));
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
        let determined = stage(stringify!($module));
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
            assert_eq!(got, interpreted(&determined, seed), stringify!($module));
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
