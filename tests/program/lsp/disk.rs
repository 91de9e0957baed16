//! What happens to files under the editor, and what the server writes down: seen from outside, over real files.

use super::pipe::Pipe;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const PART: &str = "mechanism lever {
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point tip = (50 mm, 0) }
    joint pivot: revolute(ground.O, arm.O)
}
";

const WHOLE: &str = "use \"lever.mech\"

mechanism whole {
    part front: lever()
    driver motor: rotation(front.pivot) = 30 deg * sin(t)
    measure height = y(front.arm.tip)
}
";

fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

fn binary() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_mechc"))
}

fn open(pipe: &mut Pipe, uri: &str, text: &str) {
    let document = json!({ "uri": uri, "languageId": "mech", "version": 1, "text": text });
    pipe.notify("textDocument/didOpen", &json!({ "textDocument": document }));
}

fn codes(pipe: &mut Pipe, uri: &str) -> Vec<String> {
    let (_, report) = pipe.request("textDocument/diagnostic", &json!({ "textDocument": { "uri": uri } }));
    let items = report["items"].as_array().expect("a list").iter();
    items.map(|item| item["code"].as_str().expect("a code").to_owned()).collect()
}

fn insert(pipe: &mut Pipe, uri: &str, version: i64, at: (usize, usize), text: &str) {
    let position = json!({ "line": at.0, "character": at.1 });
    let change = json!({ "range": { "start": position, "end": position }, "text": text });
    let document = json!({ "uri": uri, "version": version });
    pipe.notify("textDocument/didChange", &json!({ "textDocument": document, "contentChanges": [change] }));
}

#[test]
fn used_file_changes_refresh_pulls() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().canonicalize().expect("it is there");
    let [part, whole] = ["lever.mech", "whole.mech"].map(|name| path.join(name));
    fs::write(&part, PART).expect("it is written");
    let mut pipe = Pipe::open(binary());
    open(&mut pipe, &uri(&whole), WHOLE);
    assert!(codes(&mut pipe, &uri(&whole)).is_empty());
    fs::write(&part, PART.replace("tip", "top")).expect("it is written");
    let change = json!({ "uri": uri(&part), "type": 2 });
    pipe.notify("workspace/didChangeWatchedFiles", &json!({ "changes": [change] }));
    pipe.wait_for(|message| message["method"] == "workspace/diagnostic/refresh");
    assert_eq!(codes(&mut pipe, &uri(&whole)), ["E0201"]);
    assert!(pipe.end());
}

#[test]
#[cfg(unix)]
fn linked_texts_survive_deleted_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().canonicalize().expect("it is there");
    let [real, link] = ["real", "link"].map(|name| path.join(name));
    fs::create_dir(&real).expect("it is made");
    fs::write(real.join("lever.mech"), PART).expect("it is written");
    std::os::unix::fs::symlink(&real, &link).expect("it is made");
    let mut pipe = Pipe::open(binary());
    let uri = uri(&link.join("lever.mech"));
    open(&mut pipe, &uri, PART);
    fs::remove_dir_all(&real).expect("it goes");
    insert(&mut pipe, &uri, 2, (2, 15), "x");
    assert!(!codes(&mut pipe, &uri).is_empty(), "the edit was lost");
    fs::create_dir(&real).expect("it is made");
    fs::write(real.join("lever.mech"), PART).expect("it is written");
    let range = json!({ "start": { "line": 2, "character": 15 }, "end": { "line": 2, "character": 16 } });
    let document = json!({ "uri": uri, "version": 3 });
    let change = json!({ "range": range, "text": "" });
    pipe.notify("textDocument/didChange", &json!({ "textDocument": document, "contentChanges": [change] }));
    // of a free body nothing but that is said
    assert!(codes(&mut pipe, &uri).iter().all(|code| code == "E0502"));
    assert!(pipe.end());
}

#[test]
fn logs_have_messages_and_times() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("lsp.log");
    let mut pipe = Pipe::open_with(binary(), &["--stdio", "--log", &log.to_string_lossy()]);
    open(&mut pipe, "file:///lever.mech", PART);
    codes(&mut pipe, "file:///lever.mech");
    assert!(pipe.end());
    let text = fs::read_to_string(&log).expect("it is written");
    for line in text.lines() {
        let (time, rest) = line.trim_start().split_once(' ').expect("a time and more");
        assert!(time.parse::<f64>().is_ok_and(|time| time >= 0.0), "{line}");
        let (mark, diagnostics) = rest.split_once(' ').expect("a mark and what was said");
        let is_message = || serde_json::from_str::<Value>(diagnostics).is_ok_and(|value| value.is_object());
        assert!(mark == "·" || ["<", ">"].contains(&mark) && is_message(), "{line}");
    }
    for expected in ["< {\"id\":1,\"method\":\"initialize\"", "> {\"id\":1,\"result\"", "· Words of /lever.mech took"]
    {
        assert!(text.contains(expected), "{expected} is missing in\n{text}");
    }
}

#[test]
fn a_log_that_cannot_be_written_is_reported() {
    let output = Command::new(binary()).args(["lsp", "--log", "/nowhere/lsp.log"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write `/nowhere/lsp.log`"));
}

#[test]
fn plain_text_clients_get_an_explanation() {
    let mut child = Command::new(binary());
    child.arg("lsp").stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let output = child.output().expect("it runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("an editor starts it"), "{output:?}");
    assert!(output.stdout.is_empty());
}
