//! Who may know whom: each room knows only the rooms before it (`ARCHITECTURE.md`).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use std::fs;
use support::files;

/// Each room with the rooms that it may name.
const ROOMS: &[(&str, &[&str])] = &[
    ("source", &[]),
    ("math", &[]),
    ("vocabulary", &[]),
    ("diag", &["source"]),
    ("expr", &["math"]),
    ("syntax", &["source", "vocabulary", "diag"]),
    ("model", &["source", "vocabulary", "expr"]),
    ("check", &["source", "math", "vocabulary", "diag", "expr", "syntax", "model"]),
    ("ir", &["source", "expr"]),
    ("lower", &["expr", "model", "ir", "math"]),
    ("structure", &["ir", "expr", "diag"]),
    ("program", &["ir", "expr", "math"]),
    ("solver", &["program", "structure", "ir", "expr", "math"]),
    ("analysis", &["solver", "program", "structure", "ir", "expr", "diag", "math"]),
    ("emit", &["source", "solver", "program", "structure", "ir", "expr"]),
    ("output", &[]),
    ("import", &["source", "vocabulary", "diag", "syntax"]),
];

#[test]
fn rooms_know_only_those_before_them() {
    let all: Vec<&str> = ROOMS.iter().map(|(room, _)| *room).chain(["cli"]).collect();
    let mut seen = 0;
    for path in files("src", "rs") {
        let inside = path.strip_prefix(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).expect("below src").to_owned();
        let first = inside.iter().next().expect("a name").to_string_lossy().into_owned();
        let room = first.trim_end_matches(".rs");
        let Some((_, allowed)) = ROOMS.iter().find(|(name, _)| *name == room) else {
            assert!(matches!(room, "lib" | "main" | "cli"), "the room `{room}` is not in the list");
            continue;
        };
        seen += 1;
        let text = fs::read_to_string(&path).expect("a text");
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let hidden = ["crate::{", "super::super", "mechc::"].iter().find(|form| line.contains(**form));
            assert!(hidden.is_none(), "{}: a room is named as `crate::room::…`, not by {hidden:?}", inside.display());
            for used in line.split("crate::").skip(1) {
                let used: String = used.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                if used == room || !all.contains(&used.as_str()) {
                    continue;
                }
                assert!(allowed.contains(&used.as_str()), "{}: `{room}` must not know `{used}`", inside.display());
            }
        }
    }
    assert!(seen > 30, "only {seen} files were looked at");
}

/// What a file may use of the platform: threads, which are gone without their feature.
const PLATFORM: &[(&str, &str)] = &[("analysis/rows.rs", "std::thread")];

#[test]
fn rooms_know_no_files_threads_clock_or_environment() {
    let mut allowed = 0;
    for path in files("src", "rs") {
        let inside = path.strip_prefix(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).expect("below src").to_owned();
        // the command line, and what becomes part of an emitted crate
        if ["cli", "emit/package", "main.rs"].iter().any(|place| inside.starts_with(place)) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a text");
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            for used in ["fs", "thread", "time", "env", "net", "process", "io::stdout", "io::stderr", "io::stdin"] {
                let used = format!("std::{used}");
                let is_allowed = PLATFORM.iter().any(|&(place, known)| inside.ends_with(place) && used == known);
                allowed += usize::from(is_allowed && line.contains(&used));
                assert!(is_allowed || !line.contains(&used), "{}: {used} is for the command line", inside.display());
            }
        }
    }
    assert!(allowed > 0, "nothing was found where something is");
}
