//! Emitted Rust in the making, what compiles it, and what the interpreter makes of the same points.

#![allow(dead_code)] // each test file uses its part

use crate::support::random::Random;
use crate::support::{all_rows, compile_number, compile_with_forces, compile_without_redundant};
use mechc::{Compiled, RustOptions};
use mechc_ir::layout::RowLayout;
use mechc_ir::program::Stage;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

/// Points at which each module is compared.
pub const POINTS: u64 = 3;

/// What is emitted.
pub struct Emitted {
    pub name: String,
    pub compiled: Compiled,
    /// The same with what all joints exert and all drivers supply; none where nothing weighs and nothing is loaded.
    with_forces: Option<Compiled>,
}

impl Emitted {
    pub fn new(name: String, path: &Path, number: usize) -> Option<Emitted> {
        Emitted::of(name, &fs::read_to_string(path).expect("a text"), path, number)
    }

    pub fn of(name: String, text: &str, path: &Path, number: usize) -> Option<Emitted> {
        let (compiled, _) = compile_number(path, text, number);
        let with_forces = compile_with_forces(path, text, number);
        compiled.map(|compiled| Emitted { name, compiled, with_forces })
    }

    /// The first mechanism of a text, whose redundant equations are left out.
    pub fn without_redundant(name: String, text: &str) -> Emitted {
        let (compiled, outcome) = compile_without_redundant(&name, text);
        let compiled = compiled.unwrap_or_else(|| panic!("{}\n{text}", outcome.text()));
        Emitted { name, compiled, with_forces: None }
    }

    /// The module, with so many lanes if any are wanted.
    pub fn text(&self, lanes: Option<usize>) -> String {
        let file = format!("{}.mech", self.name);
        let (text, said) = self.compiled.rust(&RustOptions { lanes, ..RustOptions::new(file) });
        text.unwrap_or_else(|| panic!("{}: {said:?}", self.name))
    }

    /// How many lanes it has where all are looked at: the examples show what there is to see.
    pub fn lanes(&self) -> Option<usize> {
        ["examples_", "rim_", "following_", "slopes_"].iter().any(|group| self.name.starts_with(group)).then_some(3)
    }

    /// What the interpreter says of the forces in each of its rows; nothing where there are none.
    pub fn forces(&self) -> Vec<Vec<f64>> {
        let Some((compiled, times)) = self.with_forces.as_ref().and_then(|all| Some((all, all.times()?))) else {
            return Vec::new();
        };
        let ((determined, _), (rows, _)) = (compiled.inside(), all_rows(compiled, &times));
        let system = determined.system();
        let first = RowLayout::new(system).reactions as usize;
        rows.into_iter().map(|row| row[first..first + system.reactions().len()].to_vec()).collect()
    }

    /// The rows of the interpreter, and whether it came to the end.
    pub fn rows(&self) -> (Vec<Vec<f64>>, bool) {
        let Some(times) = self.compiled.times() else {
            return (Vec::new(), true);
        };
        let (rows, stop) = all_rows(&self.compiled, &times);
        (rows, stop.is_none())
    }
}

/// The library that some modules ask for, of the version that `Cargo.lock` has: built for these tests alone, where nothing else is.
static LIBM: LazyLock<PathBuf> = LazyLock::new(|| {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("libm");
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let output = Command::new(env!("CARGO"))
        .args([
            "build",
            "--offline",
            "--locked",
            "--package",
            "libm",
            "--message-format",
            "json",
            "--manifest-path",
            manifest,
        ])
        .arg("--target-dir")
        .arg(target)
        .output()
        .expect("cargo is there");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let told = String::from_utf8(output.stdout).expect("text");
    let artifacts = told.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let mut files = artifacts
        .filter(|artifact| artifact["target"]["name"] == "libm")
        .filter_map(|artifact| artifact["filenames"].as_array().cloned())
        .flatten()
        .filter_map(|file| file.as_str().map(PathBuf::from));
    files.find(|file| file.extension().is_some_and(|ending| ending == "rlib")).expect("a library")
});

/// Runs rustc, or what takes its arguments, on a source; it has nothing to say.
pub fn compile(compiler: &str, arguments: &[&str], source: &Path) -> Result<(), String> {
    let Output { status, stderr, .. } = Command::new(compiler)
        .args(["--edition", "2024"])
        .args(arguments)
        .arg("--extern")
        .arg(format!("libm={}", LIBM.display()))
        .arg(source)
        .output()
        .expect("it is there, as cargo is");
    if status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&stderr).into_owned()) }
}

/// Coordinates, velocities and a time that are the same wherever they are made.
pub fn point(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>, f64) {
    let mut random = Random::new(seed);
    (random.vector(n, 1.0), random.vector(n, 3.0), random.part())
}

/// What the interpreter makes of a point: Φ, Φ_q, Φ_t, ν, γ, as bits.
pub fn interpreted(compiled: &Compiled, seed: u64) -> Vec<u64> {
    let (determined, program) = compiled.inside();
    let system = determined.system();
    let params: Vec<f64> = system.params().iter().map(|param| param.value).collect();
    let mut registers = program.start(&params);
    let (q, qd, t) = point(system.coordinates().len(), seed);
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
        bits(outputs.nu(), -1.0),
        bits(outputs.nu(), 1.0),
        bits(outputs.gamma(), 1.0),
    ]
    .concat()
}

pub fn bits_of(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { (value + 0.0).to_bits() }
}

/// What a program prints that has a module and its names. The module is what firmware could have, and clippy has nothing to say of it.
pub fn printed(module: &str, program: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let [firmware, source, binary] = ["firmware.rs", "main.rs", "main"].map(|name| folder.path().join(name));
    fs::write(&firmware, format!("#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings)]\n{module}"))
        .expect("written");
    let out = folder.path().join("firmware.rmeta");
    let arguments = ["--crate-type", "lib", "--emit", "metadata", "-o", &out.to_string_lossy()];
    compile("clippy-driver", &arguments, &firmware).unwrap_or_else(|why| panic!("{why}"));
    fs::write(folder.path().join("machine.rs"), module).expect("written");
    let head = "#![allow(dead_code, unused_imports)]\nmod machine;\nuse machine::*;\n";
    fs::write(&source, format!("{head}{program}")).expect("written");
    compile("rustc", &["-o", &binary.to_string_lossy()], &source).unwrap_or_else(|why| panic!("{why}"));
    let output = Command::new(&binary).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text").lines().map(str::to_owned).collect()
}
