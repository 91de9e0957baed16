//! The licences of the crates that the program carries, as they stand in the crates themselves.
//! `UPDATE_GOLDENS=1 cargo test --test program licenses` writes them anew, which a new crate or version asks for.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support::golden;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Of several licences that may be chosen from, the first of these is; files of the others are left out then.
const CHOSEN: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];
/// Files of licences that need not be chosen where there is another one.
const OTHERS: [&str; 7] = ["APACHE", "ZLIB", "0BSD", "BSD", "UNLICENSE", "COPYING", "LICENSE-MIT"];

/// Where the program is used.
const PLATFORMS: [&str; 5] = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-pc-windows-msvc",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
];

struct Carried {
    name: String,
    licence: String,
    folder: PathBuf,
}

fn cargo(arguments: &[&str]) -> String {
    let made = Command::new(env!("CARGO")).args(arguments).arg("--locked").output().expect("cargo runs");
    assert!(made.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&made.stderr));
    String::from_utf8(made.stdout).expect("text")
}

/// All crates that are built into the program on one platform or another.
fn carried() -> Vec<Carried> {
    let all: Value = serde_json::from_str(&cargo(&["metadata", "--format-version", "1"])).expect("JSON");
    let mut folders = BTreeMap::new();
    for package in all["packages"].as_array().expect("packages") {
        let text = |name: &str| package[name].as_str().unwrap_or_default().to_owned();
        let folder = Path::new(&text("manifest_path")).parent().expect("a folder").to_owned();
        folders.insert(format!("{} {}", text("name"), text("version")), (text("license"), folder));
    }
    let mut tree =
        vec!["tree", "--package", "mechc", "-e", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];
    tree.extend(PLATFORMS.iter().flat_map(|platform| ["--target", platform]));
    let tree = cargo(&tree);
    let mut names: Vec<String> = tree.lines().filter_map(name_of).collect();
    names.sort();
    names.dedup();
    let carried = names.into_iter().filter(|name| !name.starts_with("mechc")).map(|name| {
        let (licence, folder) = folders.remove(&name).expect("a package");
        Carried { name, licence, folder }
    });
    carried.collect()
}

/// `libm 0.2.16` of `libm v0.2.16 (*)`.
fn name_of(line: &str) -> Option<String> {
    let mut words = line.split_whitespace();
    let (name, version) = (words.next()?, words.next()?);
    Some(format!("{name} {}", version.strip_prefix('v')?))
}

/// Crates without a text of their own, each of one repository with another one, whose licence it has.
const AS: [(&str, &str); 1] = [("pulp-wasm-simd-flag", "pulp ")];

/// The texts to be said of a crate, one of all.
fn texts(carried: &Carried, all: &[Carried]) -> Vec<String> {
    let other = AS.iter().find(|(name, _)| carried.name.starts_with(name)).map(|(_, other)| *other);
    let carried = other.and_then(|other| all.iter().find(|one| one.name.starts_with(other))).unwrap_or(carried);
    let entries = fs::read_dir(&carried.folder).expect("the crate's folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| {
        ["LICENSE", "LICENCE", "COPYING", "UNLICENSE", "NOTICE"]
            .iter()
            .any(|word| name.to_uppercase().starts_with(word))
    });
    names.sort();
    if let Some(chosen) = CHOSEN.iter().find(|chosen| names.iter().any(|name| name.to_uppercase().starts_with(*chosen)))
    {
        names.retain(|name| {
            let name = name.to_uppercase();
            name.starts_with(chosen) || (!OTHERS.iter().any(|other| name.contains(other)) && name != "LICENSE")
        });
    }
    names.iter().map(|name| plain(&fs::read_to_string(carried.folder.join(name)).expect("text"))).collect()
}

/// Without spaces at the ends of lines, and blank lines at the ends of the text.
fn plain(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned()
}

#[test]
fn the_program_prints_all_licences() {
    let all = carried();
    assert!(all.len() > 50, "only {} crates", all.len());
    let mut diagnostics: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut made =
        "Crates, on one platform or another; where a licence may be chosen, it is the one whose text stands below\n\n"
            .to_owned();
    for one in &all {
        made += &format!("    {}: {}\n", one.name, one.licence);
        let texts = texts(one, &all);
        assert!(!texts.is_empty(), "{} has no text of its licence", one.name);
        for text in texts {
            diagnostics.entry(text).or_default().push(one.name.clone());
        }
    }
    let mut diagnostics: Vec<(String, Vec<String>)> = diagnostics.into_iter().collect();
    diagnostics.sort_by(|(_, a), (_, b)| a.cmp(b));
    for (text, names) in diagnostics {
        made += &format!("\n\n{}\n\n{text}\n", names.join(", "));
    }
    golden::holds("src/cli/licenses.txt", &made);
}

#[test]
fn they_are_printed() {
    let mut mechc = assert_cmd::Command::new(env!("CARGO_BIN_EXE_mechc"));
    let printed = mechc.arg("--licenses").assert().success().stderr("").get_output().stdout.clone();
    let printed = String::from_utf8(printed).expect("text");
    for wanted in ["mechc 0", "uPlot", "    libm ", "    clap ", "Permission is hereby granted", "Apache License"] {
        assert!(printed.contains(wanted), "{wanted}");
    }
    let mut mechc = assert_cmd::Command::new(env!("CARGO_BIN_EXE_mechc"));
    mechc.args(["--licenses", "check"]).assert().code(2);
}
