//! Where results go: never over what was read, never half, and in a form that their ending says.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![cfg(unix)] // links and signals

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::Duration;

const SLIDER_CRANK: &str = "examples/slider_crank.mech";

fn mechc(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.current_dir(folder);
    command
}

/// What is in a folder and below, hidden files too.
fn inside(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("it can be read").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            found.insert(name.clone() + "/", Vec::new());
            found.extend(inside(&path).into_iter().map(|(below, text)| (format!("{name}/{below}"), text)));
        } else {
            found.insert(name, fs::read(&path).expect("it can be read"));
        }
    }
    found
}

// ---- interruptions

fn interrupt(child: &mut Child, signal: i32) -> ExitStatus {
    let sent = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().expect("it runs");
    assert!(sent.success());
    child.wait().expect("it ends")
}

/// Whether whoever runs the tests ignores a signal (`nohup`, a job of a service): the command does then too.
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).expect("a mask") >> (signal - 1) & 1 == 1)
}

/// Interrupts a command at several moments, and holds the folder to what it was. Says how often something half done was there.
fn interrupted(folder: &Path, arguments: &[&str], moments: u64) -> usize {
    let before = inside(folder);
    let mut half_done = 0;
    for signal in [2_i32, 15, 1].into_iter().filter(|signal| !is_ignored(*signal)) {
        for moment in 0..moments {
            // not evenly, and the first ones while the program is still starting
            let delay = 1 + moment * moment * 7 + (moment * 37 + u64::from(signal.unsigned_abs()) * 11) % 13;
            let mut command = mechc(folder);
            let mut child = command.args(arguments).stderr(Stdio::null()).spawn().expect("it runs");
            sleep(Duration::from_millis(delay));
            // the later ones when something half done is there, whenever that is
            while moment > moments / 2 && inside(folder).len() == before.len() {
                assert!(child.try_wait().expect("a state").is_none(), "{arguments:?} ends before it writes");
                sleep(Duration::from_millis(1));
            }
            half_done += usize::from(inside(folder).len() > before.len());
            let status = interrupt(&mut child, signal);
            // before it has begun to listen the signal itself ends it
            let is_interrupted = status.code() == Some(128 + signal) || status.signal() == Some(signal);
            assert!(is_interrupted, "{arguments:?}, signal {signal} after {delay} ms: {status}");
            assert!(inside(folder) == before, "{arguments:?}, signal {signal} after {delay} ms leaves something");
        }
    }
    half_done
}

#[test]
fn interrupted_runs_keep_the_old_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::copy(SLIDER_CRANK, path.join("a.mech")).unwrap();
    fs::write(path.join("old.csv"), "precious").unwrap();
    fs::create_dir(path.join("below")).unwrap();
    for out in ["old.csv", "below/new.parquet"] {
        let half_done = interrupted(path, &["run", "a.mech", "--every", "1e-9", "-o", out], 7);
        assert!(half_done > 3, "only {half_done} times something was half done");
    }
}

#[test]
fn an_interrupted_crate_leaves_no_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(SLIDER_CRANK, folder.path().join("a.mech")).unwrap();
    let before = inside(folder.path());
    // whichever moment: all of it or nothing
    for moment in 0..30_u64 {
        let mut command = mechc(folder.path());
        let mut child =
            command.args(["emit", "a.mech", "--crate", "enc"]).stderr(Stdio::null()).spawn().expect("it runs");
        sleep(Duration::from_millis(3 * moment));
        let status = interrupt(&mut child, 2);
        let now = inside(folder.path());
        if now != before {
            let written = now.keys().filter(|name| name.starts_with("enc/")).count();
            assert_eq!(written, 12, "{status}, signal after {} ms: {:?}", 3 * moment, now.keys());
            fs::remove_dir_all(folder.path().join("enc")).unwrap();
        }
    }
}

#[test]
fn ignored_signals_stay_ignored() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(SLIDER_CRANK, folder.path().join("a.mech")).unwrap();
    let before = inside(folder.path());
    let mut child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$0\" run a.mech --every 1e-9 -o out.csv", env!("CARGO_BIN_EXE_mechc")])
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .expect("it runs");
    // it has begun, and ignores what it is to ignore
    while inside(folder.path()) == before {
        sleep(Duration::from_millis(1));
    }
    let hung_up = Command::new("kill").args(["-1".to_owned(), child.id().to_string()]).status().expect("it runs");
    assert!(hung_up.success());
    sleep(Duration::from_millis(200));
    assert!(child.try_wait().expect("a state").is_none(), "a hang-up was to be ignored");
    // who runs the tests may ignore what a keyboard sends
    assert_eq!(interrupt(&mut child, 15).code(), Some(143));
    assert!(inside(folder.path()) == before);
}

// ---- what was read

/// Runs a command that must be refused as wrong usage, and touches nothing.
fn refused(folder: &Path, arguments: &[&str], stdin: Option<&str>) -> String {
    let before = inside(folder);
    let stdin = stdin.map_or(Stdio::null(), |name| fs::File::open(folder.join(name)).expect("a file").into());
    let output = mechc(folder).args(arguments).stdin(stdin).output().expect("it runs");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
    assert!(text.contains("E0706"), "{arguments:?}: {text}");
    assert!(inside(folder) == before, "{arguments:?} touches something");
    text
}

#[test]
fn inputs_are_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::create_dir(path.join("below")).unwrap();
    fs::copy("tests/cases/table_file.mech", path.join("a.mech")).unwrap();
    for table in ["table_file_table.csv", "table_file_table2.csv"] {
        fs::copy(Path::new("tests/cases").join(table), path.join(table)).unwrap();
    }
    for file in ["wiper.adm", "wiper.acf"] {
        fs::copy(Path::new("tests/import").join(file), path.join(file)).unwrap();
    }
    let absolute = |name: &str| path.join(name).to_string_lossy().into_owned();
    // each file by several ways
    let ways = |name: &str| {
        let (soft, hard, twice) = (format!("soft_{name}"), format!("hard_{name}"), format!("below/twice_{name}"));
        if !path.join(&soft).exists() {
            std::os::unix::fs::symlink(name, path.join(&soft)).unwrap();
            std::os::unix::fs::symlink(format!("../{soft}"), path.join(&twice)).unwrap();
            fs::hard_link(path.join(name), path.join(&hard)).unwrap();
        }
        [name.to_owned(), format!("./{name}"), format!("below/../{name}"), absolute(name), soft, hard, twice]
    };
    for out in ways("a.mech") {
        let run = refused(path, &["run", "a.mech", "--format", "csv", "-o", &out], None);
        assert!(run.contains("was read"), "{run}");
        refused(path, &["run", "soft_a.mech", "--format", "json", "-o", &out], None);
        refused(path, &["run", "-", "--format", "csv", "-o", &out], Some("a.mech"));
        refused(path, &["emit", "a.mech", "--format", "rust", "-o", &out], None);
        refused(path, &["dump", "a.mech", "--stage", "ast", "-o", &out], None);
        refused(path, &["dump", "a.mech", "--stage", "ir", "-o", &out], None);
    }
    for table in ["table_file_table.csv", "table_file_table2.csv"] {
        for out in ways(table) {
            let text = refused(path, &["run", "a.mech", "-o", &out], None);
            assert!(text.contains(&out), "{text}");
            refused(path, &["emit", "a.mech", "--format", "json", "-o", &out], None);
        }
    }
    for file in ["wiper.adm", "wiper.acf"] {
        for out in ways(file) {
            refused(path, &["import", "wiper.adm", "--acf", "wiper.acf", "-o", &out], None);
        }
    }
    // a file of a crate that looks as if mechc had written it
    let text = fs::read_to_string(SLIDER_CRANK).unwrap();
    fs::create_dir(path.join("enc")).unwrap();
    fs::write(path.join("enc/README.md"), format!("// Written by mechc 0.1.0\n{text}")).unwrap();
    refused(path, &["emit", "enc/README.md", "--crate", "enc"], None);
    // a copy is another file
    fs::copy(path.join("a.mech"), path.join("copy.csv")).unwrap();
    let output = mechc(path).args(["run", "a.mech", "-o", "copy.csv"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(fs::read_to_string(path.join("copy.csv")).unwrap().starts_with("t,"));
}

const LEVER: &str = "mechanism lever {
    input turn = 60 rpm * t
    ground { point O = (0, 0) }
    body b { point O = (0, 0) }
    joint j: revolute(ground.O, b.O)
    driver d: rotation(j) = turn
    result top = last(angle(b))
    analysis from 0 s to 1 s every 0.5 s
}
";

#[test]
fn named_files_are_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::create_dir(path.join("below")).unwrap();
    fs::write(path.join("lever.mech"), format!("use \"below/far.mech\"\n{LEVER}")).unwrap();
    fs::write(path.join("below/far.mech"), "mechanism far { table way = spline \"far.csv\" }").unwrap();
    for table in ["near.csv", "other.csv", "samples.csv", "below/far.csv"] {
        fs::write(path.join(table), "t,turn\n0,0\n1,1\n2,4\n").unwrap();
    }
    let tables = "table near = spline \"near.csv\"";
    let user = format!(
        "use \"lever.mech\" as legs\nmechanism o {{ {tables} part a: legs.lever(turn = near(1) * t / 1 s) result top = a.top \
         input more = t analysis from 0 s to 1 s every 0.5 s }}\n\
         mechanism other {{ table other = spline \"other.csv\" table gone = spline \"gone.csv\" }}\n"
    );
    fs::write(path.join("o.mech"), user).unwrap();
    std::os::unix::fs::symlink("near.csv", path.join("soft.csv")).unwrap();
    // one that is not there yet is named all the same, and so is one of a mechanism that is not asked for
    let named =
        ["lever.mech", "near.csv", "soft.csv", "other.csv", "gone.csv", "below/far.mech", "below/../below/far.csv"];
    for out in named {
        let chosen = ["o.mech", "--mechanism", "o", "-o", out];
        for command in [
            &["run", "--format", "csv"][..],
            &["run", "--format", "parquet"],
            &["run", "--results", "r.json", "--format", "json"],
            &["emit", "--format", "rust"],
            &["emit", "--format", "latex"],
            &["emit", "--format", "json"],
            &["dump", "--stage", "ast"],
            &["dump", "--stage", "model"],
            &["dump", "--stage", "ir"],
        ] {
            refused(path, &[command, &chosen[..]].concat(), None);
        }
    }
    // results have an ending of their own
    fs::copy(path.join("near.csv"), path.join("near.json")).unwrap();
    fs::write(path.join("j.mech"), LEVER.replacen('{', "{ table near = spline \"near.json\"", 1)).unwrap();
    refused(path, &["run", "j.mech", "--results", "near.json", "-o", "new.csv"], None);
    // samples that the command does not need
    let samples = ["--samples", "samples.csv", "-o", "samples.csv"];
    refused(path, &[&["dump", "lever.mech", "--stage", "ast"], &samples[..]].concat(), None);
    refused(path, &[&["run", "lever.mech"], &samples[..]].concat(), None);
    let written = mechc(path).args(["dump", "o.mech", "--stage", "ast", "-o", "new.mech"]).output().expect("it runs");
    assert_eq!(written.status.code(), Some(0), "{}", String::from_utf8_lossy(&written.stderr));
}

// ---- pipes and devices

/// A command of the shell, with what it says; one that takes too long is ended.
fn shell(folder: &Path, command: &str) -> (i32, String, String) {
    let mechc = env!("CARGO_BIN_EXE_mechc");
    let limited = format!("mechc() {{ timeout 600 {mechc} \"$@\"; }}\n{command}");
    let output = Command::new("bash").args(["-c", &limited]).current_dir(folder).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends"), text(output.stdout), text(output.stderr))
}

#[test]
fn pipes_and_devices_are_streamed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("a.mech"), LEVER).unwrap();
    let (_, table, _) = shell(path, "mechc run a.mech");
    assert!(table.starts_with("t,b.x,") && table.lines().count() == 4, "{table}");
    for command in [
        "mechc run a.mech -o /dev/stdout --format csv | cat",
        "mechc run a.mech -o /dev/stdout",
        "mechc run a.mech -o >(cat); sleep 0.3",
        "mechc run a.mech -o /dev/fd/3 3>&1",
        "mechc run a.mech -o /dev/stdout > f; cat f",
        "mechc run a.mech -o /dev/fd/3 3> f; cat f",
    ] {
        let (code, out, diagnostics) = shell(path, command);
        assert_eq!((code, out.as_str()), (0, table.as_str()), "{command}: {diagnostics}");
    }
    // what stands in a file already stays there
    let (code, out, diagnostics) =
        shell(path, "{ echo before; mechc run a.mech -o /dev/stdout; echo behind; } > f; cat f");
    assert_eq!((code, out), (0, format!("before\n{table}behind\n")), "{diagnostics}");
    let (code, out, diagnostics) = shell(path, "mechc run a.mech -o t.csv --results /dev/stdout | cat");
    assert_eq!((code, out.as_str()), (0, "{\"top\": 6.283185307179586}\n"), "{diagnostics}");
    assert_eq!(fs::read_to_string(path.join("t.csv")).expect("a table"), table);
    let (code, _, diagnostics) = shell(path, "mechc run a.mech --results /dev/stdout");
    assert!(code == 2 && diagnostics.contains("would both go to standard output"), "{diagnostics}");
}

#[cfg(unix)]
#[test]
fn outputs_that_are_one_file_by_a_link_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::copy(SLIDER_CRANK, path.join("a.mech")).unwrap();
    fs::write(path.join("t.json"), "precious").unwrap();
    let prepare = "ln -s t.json r.json; ln t.json h.json; ln -s gone.json to_gone.json; mkdir one; ln -s one two";
    shell(path, prepare);
    for (table, results) in [
        ("t.json", "t.json"),
        ("t.json", "./t.json"),
        ("t.json", "r.json"),
        ("t.json", "h.json"),
        ("gone.json", "to_gone.json"),
        ("one/t.json", "two/t.json"),
    ] {
        let (code, _, diagnostics) = shell(path, &format!("mechc run a.mech -o {table} --results {results}"));
        assert!(
            code == 2 && diagnostics.contains("E0706") && diagnostics.contains("would both go to"),
            "{table} {results}: {diagnostics}"
        );
        assert_eq!(fs::read_to_string(path.join("t.json")).unwrap(), "precious");
        assert!(!path.join("gone.json").exists() && !path.join("one/t.json").exists(), "{table} {results}");
    }
    let (code, _, diagnostics) = shell(path, "mechc run a.mech -o one/t.json --results two/r.json");
    assert!(code == 0 && path.join("one/r.json").exists(), "{diagnostics}");
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("secret.txt"), "root:x:0:0\n").unwrap();
    fs::write(path.join("uses.mech"), "use \"secret.txt\"\nmechanism m { }\n").unwrap();
    let (code, _, diagnostics) = shell(path, "mechc check uses.mech");
    assert!(code == 1 && diagnostics.contains("holds no mechanism") && !diagnostics.contains("root"), "{diagnostics}");
    let text = "use \"a\u{1b}[31m.mech\"\nmechanism m { // \u{1b}[2J\u{7}\n param b\u{1b} = \u{9b}31m 2 \u{202e} x\u{7f}\r y }\n";
    fs::write(path.join("a.mech"), text).unwrap();
    for options in ["", "--message-format short", "--message-format json"] {
        for set in ["", "--set $'a\\x1b[31m=1\\x07'"] {
            let (code, out, diagnostics) = shell(path, &format!("mechc check a.mech {options} {set}"));
            assert_eq!(code, 1, "{diagnostics}");
            let is_raw = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
            assert!(!out.contains(is_raw) && !diagnostics.contains(is_raw), "{options} {set}: {out:?} {diagnostics:?}");
        }
    }
}

#[test]
fn samples_come_from_standard_input_and_pipes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("a.mech"), LEVER).unwrap();
    fs::write(path.join("s.csv"), "t,turn\n0,0\n1,1\n2,4\n").unwrap();
    let (code, table, diagnostics) = shell(path, "mechc run a.mech --samples s.csv");
    assert_eq!(code, 0, "{diagnostics}");
    for command in [
        "mechc run a.mech --samples - < s.csv",
        "cat s.csv | mechc run a.mech --samples -",
        "mechc run a.mech --samples <(cat s.csv)",
        "mechc run - --samples s.csv < a.mech",
        "mechc run <(cat a.mech) --samples s.csv",
    ] {
        let (code, out, diagnostics) = shell(path, command);
        assert_eq!((code, out.as_str()), (0, table.as_str()), "{command}: {diagnostics}");
    }
    let (code, _, diagnostics) = shell(path, "echo 't;turn' | mechc run a.mech --samples -");
    assert!(code == 1 && diagnostics.contains("<stdin>:1:1"), "{diagnostics}");
    let (code, _, diagnostics) = shell(path, "mechc run - --samples - < a.mech");
    assert!(code == 2 && diagnostics.contains("cannot be both the mechanism and the samples"), "{diagnostics}");
}

#[test]
fn named_files_are_regular_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    assert!(Command::new("mkfifo").arg(path.join("pipe")).status().expect("it runs").success());
    for (named, why) in [
        ("/dev/zero", "it is a pipe or a device, no file"),
        ("pipe", "it is a pipe or a device, no file"),
        (".", "is a directory"),
    ] {
        fs::write(path.join("use.mech"), format!("use \"{named}\"\n{LEVER}")).unwrap();
        let table = format!("{{ table way = spline \"{named}\"");
        fs::write(path.join("table.mech"), LEVER.replacen('{', &table, 1)).unwrap();
        for (text, place) in [("use.mech", "use.mech:1:5"), ("table.mech", "table.mech:1:38")] {
            let (code, _, diagnostics) = shell(path, &format!("mechc check {text}"));
            let message = format!("cannot read `{named}`: {why}");
            assert!(
                code == 1 && diagnostics.contains(&message) && diagnostics.contains(place),
                "{named} {text}: {code} {diagnostics}"
            );
        }
    }
    // what has no end is not read to its end
    fs::write(path.join("a.mech"), LEVER).unwrap();
    for command in ["mechc check /dev/zero", "mechc run a.mech --samples /dev/zero"] {
        let (code, _, diagnostics) = shell(path, command);
        assert!(
            code == 4 && diagnostics.contains("cannot read `/dev/zero`: it is larger than 1 GiB"),
            "{command}: {code} {diagnostics}"
        );
    }
}

// ---- endings

#[test]
fn endings_select_the_format_or_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::copy(SLIDER_CRANK, path.join("a.mech")).unwrap();
    for out in ["x.xlsx", "x.png", "x.pdf", "x.csv.gz", "x.txt", "X.TEX", "x.mech"] {
        let text = refused(path, &["run", "a.mech", "-o", out], None);
        assert!(text.contains("`.csv`, `.json` and `.parquet`") && text.contains("--format"), "{text}");
    }
    for out in ["x.csv", "x.py", "x.c"] {
        let text = refused(path, &["emit", "a.mech", "-o", out], None);
        assert!(text.contains("`.rs`, `.tex` and `.json`"), "{text}");
    }
    let text = refused(path, &["run", "a.mech", "--results", "x.txt"], None);
    assert!(text.contains("as JSON alone") && !text.contains("--format"), "{text}");
    // whatever is wrong with the file, the ending is told first
    refused(path, &["run", "missing.mech", "-o", "x.xlsx"], None);
    let written = |arguments: &[&str], out: &str| {
        let output = mechc(path).args(arguments).args(["-o", out]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{out}: {}", String::from_utf8_lossy(&output.stderr));
        fs::read(path.join(out)).unwrap_or_default()
    };
    let run = |more: &[&str], out: &str| written(&[&["run", "a.mech", "--every", "10 ms"], more].concat(), out);
    let (csv, json, parquet) = (run(&[], "a.csv"), run(&[], "a.json"), run(&[], "a.parquet"));
    assert!(csv.starts_with(b"t,") && json.starts_with(b"{") && parquet.starts_with(b"PAR1"));
    assert_eq!(run(&[], "A.CSV"), csv);
    assert_eq!(run(&[], "plain"), csv);
    assert_eq!(run(&["--format", "csv"], "x.xlsx"), csv);
    assert_eq!(run(&["--format", "json"], "x.csv"), json, "what is said counts");
    assert_eq!(run(&["--format", "parquet"], "x"), parquet);
    run(&[], "/dev/null");
    // a link to it, whatever it is called
    std::os::unix::fs::symlink("/dev/null", path.join("nothing.log")).unwrap();
    run(&[], "nothing.log");
    let emit = |more: &[&str], out: &str| written(&[&["emit", "a.mech"], more].concat(), out);
    assert!(emit(&[], "a.rs").starts_with(b"//!") && emit(&[], "a.tex").starts_with(b"%"));
    assert_eq!(emit(&["--format", "rust"], "x.inc"), emit(&[], "plain"));
}
