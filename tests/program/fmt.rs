//! Files that `mechc fmt` formats, and what it tells of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use std::fs;
use std::path::Path;

const LOOSE: &str = "mechanism m{param a=1}\n";
const NEAT: &str = "mechanism m {\n    param a = 1\n}\n";

/// The exit code, what it printed, and what it said, of `mechc fmt` in a folder.
fn fmt(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_mechc"));
    let output = command.current_dir(folder).arg("fmt").args(arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("a code"), text(output.stdout), text(output.stderr))
}

#[test]
fn only_changed_files_are_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let read = |name: &str| fs::read_to_string(at(name)).expect("a text");
    for inner in ["inner/.hidden", "inner/target", "inner/node_modules"] {
        fs::create_dir_all(at(inner)).unwrap();
    }
    let texts = [
        ("neat.mech", NEAT),
        ("loose.mech", LOOSE),
        ("marked.mech", "\u{feff}mechanism m{param a=1}\r\n"),
        ("notes.txt", LOOSE),
        ("inner/broken.mech", "mechanism m{param a=}\n"),
        ("inner/loose.mech", LOOSE),
        ("inner/LOUD.MECH", LOOSE),
        ("inner/.hidden/loose.mech", LOOSE),
        ("inner/.hidden.mech", LOOSE),
        ("inner/target/loose.mech", LOOSE),
        ("inner/node_modules/loose.mech", LOOSE),
    ];
    for (name, text) in texts {
        fs::write(at(name), text).unwrap();
    }
    let (code, diff, diagnostics) = fmt(folder.path(), &["--check", "."]);
    assert_eq!((code, diff.matches("+    param a = 1").count()), (1, 4), "{diff}{diagnostics}");
    assert!(diagnostics.contains("E0101"), "{diagnostics}");
    for (name, text) in texts {
        assert_eq!(read(name), text, "{name} is only looked at");
    }
    let old = fs::metadata(at("neat.mech")).unwrap().modified().unwrap();
    let (code, printed, diagnostics) = fmt(folder.path(), &[".", "loose.mech"]);
    assert_eq!((code, printed.as_str(), diagnostics.matches("formatted `").count()), (1, "", 4), "{diagnostics}");
    for changed in ["loose.mech", "inner/loose.mech", "inner/LOUD.MECH"] {
        assert_eq!(read(changed), NEAT, "{changed}");
    }
    assert_eq!(read("marked.mech"), format!("\u{feff}{}", NEAT.replace('\n', "\r\n")));
    let built = ["inner/target/loose.mech", "inner/node_modules/loose.mech"];
    let hidden = ["inner/.hidden/loose.mech", "inner/.hidden.mech"];
    for kept in ["notes.txt", "inner/broken.mech"].into_iter().chain(hidden).chain(built) {
        assert!(texts.contains(&(kept, &read(kept))), "{kept}");
    }
    let (code, diff, _) = fmt(folder.path(), &["--check", "inner/target"]);
    assert_eq!(
        (code, diff.matches("+    param a = 1").count()),
        (1, 1),
        "a folder that is named is looked into: {diff}"
    );
    assert_eq!(fs::metadata(at("neat.mech")).unwrap().modified().unwrap(), old, "it is not written");
    assert_eq!(fmt(folder.path(), &["--check", "inner/loose.mech", "neat.mech"]), (0, String::new(), String::new()));
}

#[test]
fn unformattable_files_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("empty")).unwrap();
    for (bad, wanted, code) in [("missing.mech", "E0701", 4), ("empty", "no `.mech` file is in it", 4)] {
        fs::write(at("loose.mech"), LOOSE).unwrap();
        let (exit, _, diagnostics) = fmt(folder.path(), &[bad, "loose.mech"]);
        assert_eq!(exit, code, "{diagnostics}");
        assert!(diagnostics.contains(wanted), "{diagnostics}");
        assert_eq!(fs::read_to_string(at("loose.mech")).unwrap(), NEAT);
    }
    fs::write(at("latin1.mech"), b"mechanism caf\xe9 {}").unwrap();
    let (exit, _, diagnostics) = fmt(folder.path(), &["latin1.mech"]);
    assert!(exit == 1 && diagnostics.contains("E0102"), "{diagnostics}");
    assert_eq!(fmt(folder.path(), &[]).0, 2);
}

#[test]
fn standard_input_is_formatted_to_standard_output() {
    let run = |arguments: &[&str], text: &str| {
        let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_mechc"));
        let output = command.arg("fmt").args(arguments).write_stdin(text).output().expect("it runs");
        (output.status.code(), String::from_utf8(output.stdout).expect("text"))
    };
    assert_eq!(run(&["-"], LOOSE), (Some(0), NEAT.to_owned()));
    assert_eq!(run(&["-"], "mechanism m{param a=}"), (Some(1), String::new()));
    let (code, diff) = run(&["-", "--check"], LOOSE);
    assert_eq!(code, Some(1));
    assert!(
        diff.starts_with("--- <stdin>\n+++ <stdin>\n@@ -1 +1,3 @@\n-mechanism m{param a=1}\n+mechanism m {\n"),
        "{diff}"
    );
    assert_eq!(run(&["-", "--check"], NEAT), (Some(0), String::new()));
}

#[cfg(unix)]
#[test]
fn permissions_and_links_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("linked")).unwrap();
    for name in ["real.mech", "beyond.mech"] {
        fs::write(at(name), LOOSE).unwrap();
    }
    fs::set_permissions(at("real.mech"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.mech", at("link.mech")).unwrap();
    symlink("../beyond.mech", at("linked/beyond.mech")).unwrap();
    symlink(".", at("linked/circle")).unwrap();
    fs::write(at("linked/own.mech"), NEAT).unwrap();
    assert_eq!(fmt(folder.path(), &["link.mech", "linked"]).0, 0);
    assert!(fs::symlink_metadata(at("link.mech")).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(at("real.mech")).unwrap(), NEAT, "a link that is named is written through");
    assert_eq!(fs::metadata(at("real.mech")).unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(fs::read_to_string(at("beyond.mech")).unwrap(), LOOSE, "one that is met in a folder is passed over");
}

/// `patch` takes a name up to a tab, and ends lines at `\n` alone.
#[test]
fn a_diff_is_one_that_patch_takes() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a b.mech"), "mechanism a {\r\n  param x1 = 1 // a\rb\r\n}\r").unwrap();
    let (code, diff, _) = fmt(folder.path(), &["--check", "a b.mech"]);
    assert_eq!(code, 1);
    let wanted = "--- a b.mech\t\n+++ a b.mech\t\n@@ -1,3 +1,3 @@\n mechanism a {\r\n-  param x1 = 1 // a\rb\r\n-}\r\n\
        \\ No newline at end of file\n+    param x1 = 1   // a\rb\r\n+}\r\n";
    assert_eq!(diff, wanted);
}
