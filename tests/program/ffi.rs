//! Emitted crates for C: the header stands alone, in C and in C++, and what a program in C prints has the bits of `mechc run`.
//! Where there is no compiler for C, nothing is looked at, and the test says so.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{all_rows, compile_number};
use mechc::{CrateFile, RustOptions};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const C: [&str; 6] = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic"];
const CPP: [&str; 6] = ["-std=c++11", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic"];

/// A mechanism as a crate for C, in a folder of its own.
struct Crate {
    folder: tempfile::TempDir,
    library: &'static str,
    has_params: bool,
    has_inputs: bool,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Crate {
    fn of(path: &str, library: &'static str) -> Crate {
        let path = Path::new(path);
        let text = fs::read_to_string(path).expect("a text");
        let compiled = compile_number(path, &text, 0).0.expect("determined");
        let options = RustOptions { with_sensitivities: true, for_c: true, ..RustOptions::new("machine.mech") };
        let folder = tempfile::tempdir().expect("a folder");
        let (files, diagnostics) = compiled.package(library, &options);
        for CrateFile { path, text } in files.unwrap_or_else(|| panic!("{diagnostics:?}")) {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, text).expect("written");
        }
        let rows = all_rows(&compiled, &compiled.times().expect("an analysis")).0;
        let functions = fs::read_to_string(folder.path().join("src/unsafe_c.rs")).expect("a file");
        let has = |name: &str| functions.contains(&format!("fn {library}_{name}("));
        let (has_params, has_inputs) = (has("params_default"), has("follow"));
        Crate { folder, library, has_params, has_inputs, columns: compiled.columns().clone(), rows }
    }

    fn header(&self) -> PathBuf {
        self.folder.path().join(format!("include/{}.h", self.library))
    }

    /// Builds the library, with some options of cargo's; gives the path of the static one.
    fn build(&self, options: &[&str]) -> PathBuf {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ffi");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--offline", "--quiet"]).args(options).current_dir(self.folder.path());
        let output = cargo.env("CARGO_TARGET_DIR", &target).env("RUSTFLAGS", "-D warnings").output().expect("cargo");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let profile = if options.contains(&"--release") { "release" } else { "debug" };
        target.join(profile).join(format!("lib{}.a", self.library))
    }

    /// The program with the names of this mechanism.
    fn program(&self) -> String {
        let params = if self.has_params { [", &params", "&params, "] } else { [""; 2] };
        let follow = if self.has_inputs { FOLLOW } else { "" };
        let program = PROGRAM.replace("FOLLOW", follow);
        let held = if self.has_params { "m_params params = m_params_default();" } else { "" };
        let program = program.replace("HELD", held);
        let program = program.replace("PARAMS_BEHIND", params[0]).replace("PARAMS_BEFORE", params[1]);
        let program = program.replace("m_.h", &format!("{}.h", self.library));
        program.replace("M_", &format!("{}_", self.library.to_uppercase())).replace("m_", &format!("{}_", self.library))
    }

    /// What the program prints of the mechanism at some times, linked with a library.
    fn printed(&self, library: &Path, has_std: bool, times: &[f64]) -> String {
        let [source, binary] = ["main.c", "main"].map(|name| self.folder.path().join(name));
        fs::write(&source, self.program()).expect("written");
        // Rust's own library asks for this on a machine where it can unwind, as firmware cannot
        let unwinding = self.folder.path().join("unwinding.c");
        fs::write(&unwinding, "void rust_eh_personality(void);\nvoid rust_eh_personality(void) {}\n").expect("written");
        let mut sources = vec![source.as_path()];
        sources.extend((!has_std).then_some(unwinding.as_path()));
        let libraries = ["-lpthread", "-ldl", "-lm"].map(Path::new);
        let paths = [&sources[..], &[library], &libraries[..], &[Path::new("-o"), &binary]].concat();
        compile("cc", &C, self, &paths);
        let mut child = Command::new(&binary).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
        let mut input = child.stdin.take().expect("an input");
        for t in times {
            writeln!(input, "{t:?}").expect("written");
        }
        drop(input);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{}: the number of what was not as it should be", self.library);
        String::from_utf8(output.stdout).expect("text")
    }
}

/// Whether there is a compiler; the test says if there is none.
fn is_there(compiler: &str) -> bool {
    let is_there = Command::new(compiler).arg("--version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        println!("there is no `{compiler}` here: nothing was looked at");
    }
    is_there
}

/// Runs a compiler of C, which has nothing to say.
fn compile(compiler: &str, options: &[&str], of: &Crate, paths: &[&Path]) {
    let include = of.folder.path().join("include");
    let output = Command::new(compiler).args(options).arg("-I").arg(include).args(paths).output().expect("it runs");
    let diagnostics = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && diagnostics.is_empty(), "{}: {diagnostics}", of.library);
}

/// What C asks of any mechanism: whatever is wrong is refused, and then the rows at the times that it reads, as bits.
const PROGRAM: &str = r#"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "m_.h"

#define CHECK(number, is_so) if (!(is_so)) return number

static m_state state, none;
static double list[M_COLUMNS + 1];

int main(void) {
    double t, value;
    int32_t assembly;
    HELD
    CHECK(1, m_step(&state, 0.0) == M_NOT_ASSEMBLED);
    CHECK(2, m_assemble(NULLPARAMS_BEHIND) == M_BAD_POINTER);
    CHECK(3, m_assemble(&statePARAMS_BEHIND) == M_OK);
    CHECK(4, m_step(NULL, 0.0) == M_BAD_POINTER);
    CHECK(5, m_step((m_state *)((char *)&state + 1), 0.0) == M_BAD_POINTER);
    CHECK(6, m_step(&state, NAN) == M_NOT_A_NUMBER);
    CHECK(7, m_step(&state, INFINITY) == M_NOT_A_NUMBER);
    CHECK(8, m_row(&state, NULL, M_COLUMNS) == M_BAD_POINTER);
    CHECK(9, m_row(&state, list, M_COLUMNS + 1) == M_WRONG_LENGTH);
    CHECK(10, m_row(&none, list, M_COLUMNS) == M_NOT_ASSEMBLED);
    CHECK(11, m_value(&state, M_COLUMNS, &value) == M_NO_SUCH_COLUMN);
    CHECK(12, m_value(&state, M_COLUMN_T, NULL) == M_BAD_POINTER);
    CHECK(13, m_value(&state, M_COLUMN_T, &value) == M_OK && value == M_START_TIME);
    CHECK(14, m_step_within(&state, M_START_TIME + 1000 * M_LONGEST_STEP, 0) == M_ON_THE_WAY);
    CHECK(16, m_most_work(M_MOST_STEPS) == M_MOST_WORK && M_MOST_WORK_TO_ASSEMBLE < M_MOST_WORK);
    CHECK(17, m_assembly(&state, &assembly) == M_OK && assembly == M_ASSEMBLY_LED);
    /* after an error all of a state is as it was */
    none = state;
    CHECK(18, m_step(&state, 1e300) == M_TOO_FAR && memcmp(&state, &none, sizeof state) == 0);
    memset(&none, 0, sizeof none);
    CHECK(15, strlen(m_message(M_LOCK_UP)) > 0 && strlen(m_message(-1)) > 0);
    FOLLOW
    while (scanf("%lf", &t) == 1) {
        m_state copy = state;
        CHECK(30, m_step(&copy, t) == M_OK);
        CHECK(31, m_step(&state, t) == M_OK && m_row(&state, list, M_COLUMNS) == M_OK);
        for (size_t k = 0; k < M_COLUMNS; k++) {
            uint64_t bits;
            CHECK(32, m_value(&copy, k, &value) == M_OK && (value == list[k] || isnan(value)));
            memcpy(&bits, &list[k], sizeof bits);
            printf("%" PRIx64 "\n", bits);
        }
    }
    return 0;
}
"#;

/// And of one with inputs.
const FOLLOW: &str = r"
    {
        m_inputs inputs;
        static double by[M_INPUTS * M_COORDINATES];
        m_state led = state, copy;
        double changes[M_INPUTS];
        CHECK(20, m_inputs_at(NAN, PARAMS_BEFORE&inputs) == M_NOT_A_NUMBER);
        CHECK(21, m_inputs_at(M_START_TIME, PARAMS_BEFORENULL) == M_BAD_POINTER);
        CHECK(22, m_inputs_at(M_START_TIME + 0.01, PARAMS_BEFORE&inputs) == M_OK);
        CHECK(23, m_follow(&led, NULL) == M_BAD_POINTER && m_follow(&none, &inputs) == M_NOT_ASSEMBLED);
        CHECK(24, m_follow(&led, &inputs) == M_OK && m_step(&state, M_START_TIME + 0.01) == M_OK);
        CHECK(25, m_row(&led, list, M_COLUMNS) == M_OK && m_value(&state, 1, &value) == M_OK);
        CHECK(26, fabs(list[1] - value) < 1e-9);
        CHECK(27, m_influence(&led, by, 1) == M_WRONG_LENGTH);
        CHECK(28, m_influence(&led, by, M_INPUTS * M_COORDINATES) == M_OK);
        CHECK(29, m_inputs_of(&led, &inputs) == M_OK && m_step(&state, M_START_TIME) == M_OK);
        for (int k = 0; k < M_INPUTS; k++) changes[k] = 0.0;
        CHECK(33, m_set_largest_change(&led, changes, M_INPUTS + 1) == M_WRONG_LENGTH);
        CHECK(34, m_set_largest_change(&led, changes, M_INPUTS) == M_OK);
        CHECK(35, m_follow_within(&led, &inputs, 0) == M_ON_THE_WAY && m_follow(&led, &inputs) == M_OK);
        CHECK(36, m_inputs_at(M_START_TIME + 0.02, PARAMS_BEFORE&inputs) == M_OK);
        copy = led;
        CHECK(37, m_follow(&led, &inputs) == M_TOO_FAR && memcmp(&led, &copy, sizeof led) == 0);
        CHECK(38, M_MOST_WORK_TO_FOLLOW < m_most_work(M_MOST_STEPS_TO_FOLLOW));
    }";

/// Mechanisms with what is rare: odd names, tables, formulas with branches, parts with params and inputs, none at all.
const MECHANISMS: [(&str, &str); 7] = [
    ("examples/slider_crank.mech", "slider_crank"),
    ("examples/table_driven.mech", "table_driven"),
    ("examples/parallel_robot.mech", "parallel_robot"),
    ("tests/following/platform.mech", "platform"),
    ("tests/slopes/drive.mech", "drive"),
    ("tests/stages/odd_names/input.mech", "odd_names"),
    ("tests/stages/everything/input.mech", "everything"),
];

#[test]
fn the_header_stands_alone_in_c_and_in_cpp() {
    for (path, library) in MECHANISMS {
        let made = Crate::of(path, library);
        let main = made.folder.path().join("main.c");
        fs::write(&main, made.program()).expect("written");
        for (compiler, options, language) in [("cc", C, "c"), ("c++", CPP, "c++")] {
            if is_there(compiler) {
                let options = [&options[..], &["-fsyntax-only", "-x", language]].concat();
                compile(compiler, &options, &made, &[&made.header()]);
                compile(compiler, &options, &made, &[&main]);
            }
        }
    }
}

#[test]
fn rows_that_c_prints_have_the_bits_of_the_interpreter() {
    if !is_there("cc") {
        return;
    }
    for (path, library) in MECHANISMS {
        let made = Crate::of(path, library);
        let rows: Vec<&Vec<f64>> = made.rows.iter().step_by(1 + made.rows.len() / 40).collect();
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let printed = made.printed(&made.build(&[]), true, &times);
        let mut bits = printed.lines().map(|line| f64::from_bits(u64::from_str_radix(line, 16).expect("bits")));
        for row in rows {
            for (name, expected) in made.columns.iter().zip(row) {
                let value = bits.next().expect("a number");
                let is_same = value.to_bits() == expected.to_bits() || (value.is_nan() && expected.is_nan());
                assert!(is_same, "{library}: {name} at {} s is {value:?}, not {expected:?}", row[0]);
            }
        }
        assert!(bits.next().is_none());
    }
}

#[test]
fn no_std_gives_the_same_results() {
    if !is_there("cc") {
        return;
    }
    let made = Crate::of("tests/following/four_bar.mech", "four_bar");
    let with = made.printed(&made.build(&["--release"]), true, &[0.0, 0.01]);
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ffi/release/libfour_bar.a");
    fs::remove_file(target).expect("gone");
    // a library alone: what a program of this machine is linked from is no firmware
    let options = ["--release", "--no-default-features"];
    assert_eq!(made.printed(&made.build(&options), false, &[0.0, 0.01]), with);
}

#[test]
fn all_but_one_file_is_safe() {
    let made = Crate::of("examples/slider_crank.mech", "slider_crank");
    let lib = fs::read_to_string(made.folder.path().join("src/lib.rs")).expect("a file");
    assert!(lib.contains("#![deny(unsafe_code)]") && lib.matches("allow(unsafe_code)").count() == 1, "{lib}");
    assert!(lib.contains("#[allow(unsafe_code)] // what C calls\n#[rustfmt::skip]\nmod unsafe_c;"), "{lib}");
    let mechanism = fs::read_to_string(made.folder.path().join("src/mechanism.rs")).expect("a file");
    assert!(!mechanism.contains("unsafe"));
}
