//! A formatted text has the comments of the text that it was made from, each once.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use mechc::Parsed;
use std::path::{Path, PathBuf};

/// The comments of a text, sorted: one within a declaration moves above it.
fn comments(text: &str) -> Vec<String> {
    let parsed = Parsed::of("text.mech", text);
    let text_of = |comment: &mechc::Comment| {
        let text = parsed.sources().text(comment.span);
        // what documents a declaration is written with one space
        if comment.is_doc { text.replace(' ', "") } else { text.to_owned() }
    };
    let mut list: Vec<String> = parsed.trivia().comments.iter().map(text_of).collect();
    list.sort();
    list
}

/// The text formatted, where it follows the grammar; formatted once more it stays as it is.
fn formatted(text: &str) -> Option<String> {
    let parsed = Parsed::of("text.mech", text);
    let once = parsed.formatted()?;
    let again = Parsed::of("text.mech", &once);
    assert!(again.faults().is_empty(), "{once}");
    assert_eq!(again.formatted().as_ref(), Some(&once), "formatted twice, from\n{text}");
    Some(once)
}

fn check(text: &str) -> bool {
    let Some(once) = formatted(text) else { return false };
    assert_eq!(comments(&once), comments(text), "{text}\n{once}");
    true
}

fn files(folder: PathBuf, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(path, found);
        } else if path.extension().is_some_and(|ending| ending == "mech") {
            found.push(path);
        }
    }
}

fn texts() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in ["examples", "tests/cases", "tests/ui"] {
        files(root.join(folder), &mut found);
    }
    found.sort();
    found.iter().filter_map(|path| std::fs::read_to_string(path).ok()).collect()
}

#[test]
fn no_comment_of_any_file_is_lost_or_doubled() {
    let checked = texts().iter().filter(|text| check(text)).count();
    assert!(checked > 100, "only {checked} files");
}

#[test]
fn a_comment_may_stand_wherever_a_line_ends() {
    for text in texts().iter().filter(|text| text.len() < 4_000).step_by(40) {
        let ends: Vec<usize> = text.match_indices([' ', '\n']).map(|(at, _)| at).collect();
        for (k, at) in ends.iter().enumerate().step_by(11) {
            let (before, behind) = text.split_at(*at);
            if !before.lines().last().unwrap_or_default().contains("//") {
                check(&format!("{before} // number {k}\n{behind}"));
                check(&format!("{before}\n// line {k}\n{behind}"));
            }
        }
    }
}

#[test]
fn comments_stay_where_they_stood() {
    let text = "// the file
/// the mechanism
mechanism arm { // its head
    // above r
    param r = 30 mm // behind r
    param long = 1 mm /* no comment */ // E
}
";
    assert!(formatted(text).is_none(), "there is one kind of comment");
    let text = "// the file
/// the mechanism
mechanism arm {
    // above r
    /// documents r
    param r    = 30 mm // behind r
    param long = 1 mm

    // the ground
    ground {
        point O = (0, 0) // behind O
        // at the end of the ground
    } // behind the ground
    body b {
        // nothing yet
    }

    // at the end
} // behind the mechanism

// behind all
";
    assert_eq!(formatted(text).as_deref(), Some(text));
    let text = "mechanism arm { // head
    param r = 30 mm + // within
        2 mm // behind
    ground { // of the ground
        point O = (0, 0)
    }
}
";
    let wanted = "mechanism arm {
    // head
    // within
    param r = 30 mm + 2 mm // behind

    ground {
        // of the ground
        point O = (0, 0)
    }
}
";
    assert_eq!(formatted(text).as_deref(), Some(wanted));
}
