//! What a long session keeps, and how it ends, seen from outside.

use super::pipe::Pipe;
use serde_json::json;
use std::path::Path;

const URI: &str = "file:///work/jansen_leg.mech";
const TEXT: &str = include_str!("../../../examples/jansen_leg.mech");

/// Edits before anything is measured: caches are filled, and the allocator has what it takes.
const BEFORE: usize = 1_000;

/// So many edits come until somebody rests: then a motion is followed, and kept.
const REST_EVERY: usize = 400;

/// Longer than it takes to begin with a motion.
const REST: std::time::Duration = std::time::Duration::from_millis(300);

/// What may be kept of all that follow (bytes).
const LARGEST_GROWTH: i64 = 10_000_000;

/// The memory of a process that is in use (bytes).
fn resident(pipe: &Pipe) -> i64 {
    let reported = std::fs::read_to_string(format!("/proc/{}/statm", pipe.id())).expect("it runs");
    let pages = reported.split(' ').nth(1).and_then(|pages| pages.parse::<i64>().ok()).expect("a number");
    pages * 4096
}

/// Types a comment into a text and takes it back, again and again.
fn type_for_long(pipe: &mut Pipe, version: &mut usize, edits: usize) {
    let line = TEXT.lines().position(|line| line.contains("body")).expect("a body");
    for k in 0..edits {
        *version += 1;
        let (start, end) = if k % 10 < 5 { (0, 0) } else { (0, 2) };
        let range = json!({ "start": { "line": line, "character": start }, "end": { "line": line, "character": end } });
        let text = if k % 10 < 5 { "//" } else { "" };
        let document = json!({ "uri": URI, "version": version });
        let change = json!({ "range": range, "text": text });
        pipe.notify("textDocument/didChange", &json!({ "textDocument": document, "contentChanges": [change] }));
        if k % REST_EVERY == 0 {
            std::thread::sleep(REST);
        }
        if k % 7 == 0 {
            pipe.request("textDocument/diagnostic", &json!({ "textDocument": { "uri": URI } }));
        }
        if k % 11 == 0 {
            let place = json!({ "textDocument": { "uri": URI }, "position": { "line": line + 1, "character": 10 } });
            pipe.request("textDocument/hover", &place);
        }
    }
}

fn grows_little(edits: usize) {
    let mut pipe = Pipe::open(Path::new(env!("CARGO_BIN_EXE_mechc")));
    let document = json!({ "uri": URI, "languageId": "mech", "version": 1, "text": TEXT });
    pipe.notify("textDocument/didOpen", &json!({ "textDocument": document }));
    let mut version = 1;
    type_for_long(&mut pipe, &mut version, BEFORE);
    let before = resident(&pipe);
    type_for_long(&mut pipe, &mut version, edits);
    let growth = resident(&pipe) - before;
    println!("{edits} edits: from {:.1} MB by {:.1} MB", before as f64 / 1e6, growth as f64 / 1e6);
    assert!(growth < LARGEST_GROWTH, "it has grown by {growth} bytes");
    assert!(pipe.end());
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_edits() {
    grows_little(2_000);
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "it takes minutes"]
fn memory_does_not_grow_with_a_hundred_thousand_edits() {
    grows_little(100_000);
}

#[test]
fn dead_editors_end_the_server() {
    let mut pipe = Pipe::open(Path::new(env!("CARGO_BIN_EXE_mechc")));
    let document = json!({ "uri": URI, "languageId": "mech", "version": 1, "text": TEXT });
    pipe.notify("textDocument/didOpen", &json!({ "textDocument": document }));
    assert!(!pipe.vanish(), "that is no end in order");
}
