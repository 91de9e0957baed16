//! The language server, as a client sees it.

#![cfg(feature = "lsp")]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

mod client;
mod disk;
mod live;
mod memory;
mod pipe;
mod storms;
mod writing;

use client::Client;
use mechc::Memory;
use mechc_ide::lsp::SessionEnd;
use serde_json::{Value, json};

const URI: &str = "file:///work/slider_crank.mech";
const TEXT: &str = include_str!("../../examples/slider_crank.mech");

fn pushed_to() -> Client {
    Client::new(&json!({}), Memory::default())
}

fn pulling() -> Client {
    let diagnostics = json!({
        "textDocument": { "diagnostic": {} },
        "workspace": { "diagnostics": { "refreshSupport": true } },
    });
    Client::new(&diagnostics, Memory::default())
}

/// Where something stands in a text, as the protocol says it (in UTF-16; all before it on its line is ASCII).
fn position(text: &str, what: &str) -> Value {
    let at = text.find(what).expect("it is there");
    let line = text[..at].matches('\n').count();
    json!({ "line": line, "character": at - text[..at].rfind('\n').map_or(0, |end| end + 1) })
}

/// The edit that writes something else in the place of the first of some words.
fn edit(text: &mut String, from: &str, to: &str) -> Value {
    let start = position(text, from);
    let end = json!({ "line": start["line"], "character": start["character"].as_u64().unwrap() + from.len() as u64 });
    *text = text.replacen(from, to, 1);
    json!([{ "range": { "start": start, "end": end }, "text": to }])
}

#[test]
fn diagnostics_follow_edits() {
    let (mut client, mut text) = (pushed_to(), TEXT.to_owned());
    client.open(URI, &text);
    let change = edit(&mut text, "crank.pin, rod", "crank.pn, rod");
    client.change(URI, &change);
    insta::assert_snapshot!(client.published(URI).1.join("\n"), @"31:34 E0201 `crank` has no point `pn`");
    let change = edit(&mut text, "crank.pn, rod", "crank.pin, rod");
    client.change(URI, &change);
    assert_eq!(client.published(URI), (3, vec![]));
    client.end();
}

#[test]
fn the_proof_comes_behind_the_words_and_stays_while_they_are_typed() {
    let (mut client, mut text) = (pushed_to(), TEXT.to_owned());
    let driver = text.lines().find(|line| line.contains("driver")).expect("a driver").to_owned();
    text = text.replacen(&driver, "", 1);
    client.open(URI, &text);
    let (_, reported) = client.published(URI);
    insta::assert_snapshot!(reported.join("\n"), @"5:11 E0502 1 degree of freedom is left in mechanism `slider_crank`");
    // a line more above it: no empty list comes in between
    let change = edit(&mut text, "mechanism slider_crank {", "\nmechanism slider_crank {");
    client.change(URI, &change);
    let (version, reported) = client.published(URI);
    insta::assert_snapshot!(format!("{version}: {}", reported.join("\n")), @"2: 5:1 E0502 1 degree of freedom is left in mechanism `slider_crank`");
    client.end();
}

#[test]
fn incomplete_measures_keep_proof_diagnostics() {
    let (mut client, mut text) = (pushed_to(), TEXT.to_owned());
    let driver = text.lines().find(|line| line.contains("driver")).expect("a driver").to_owned();
    text = text.replacen(&driver, "    // more", 1);
    client.open(URI, &text);
    let reported = |(_, reported): (i64, Vec<String>)| {
        reported.iter().map(|message| message[..].split(' ').nth(1).unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(reported(client.published(URI)), ["E0502"]);
    let change = edit(&mut text, "// more", "measure half = 2 *");
    client.change(URI, &change);
    assert_eq!(reported(client.published(URI)), ["E0101", "E0502"]);
    // a joint that is typed: what moves is not known, and known again with its last letter
    let change = edit(&mut text, "measure half = 2 *", "joint half: revolute(");
    client.change(URI, &change);
    assert_eq!(reported(client.published(URI)), ["E0101"]);
    let change = edit(&mut text, "joint half: revolute(", "measure half = 2");
    client.change(URI, &change);
    assert_eq!(reported(client.published(URI)), ["E0502"], "never an empty list");
    client.end();
}

#[test]
fn pulling_clients_get_no_pushes() {
    let (mut client, mut text) = (pulling(), TEXT.to_owned());
    let driver = text.lines().find(|line| line.contains("driver")).expect("a driver").to_owned();
    text = text.replacen(&driver, "", 1);
    client.open(URI, &text);
    let first = client.pulled(URI);
    if first.is_empty() {
        client.asked("workspace/diagnostic/refresh");
        assert_eq!(client.pulled(URI).len(), 1);
    }
    let change = edit(&mut text, "50 mm", "50 mms");
    client.change(URI, &change);
    insta::assert_snapshot!(client.pulled(URI).join("\n"), @"6:29 E0202 `mms` is not a unit");
    client.end();
}

#[test]
fn a_name_is_hovered_and_the_declarations_are_listed() {
    let mut client = pushed_to();
    client.open(URI, TEXT);
    let place = json!({ "textDocument": { "uri": URI }, "position": position(TEXT, "revolute") });
    insta::assert_snapshot!(client.request("textDocument/hover", place)["contents"]["value"].as_str().unwrap(), @r"
    ```mech
    revolute(P, Q)
    ```

    two points coincide, and the bodies turn about them

    2 equations

    `Φ = r_i^P − r_j^Q`
    ");
    let symbols = client.request("textDocument/documentSymbol", json!({ "textDocument": { "uri": URI } }));
    let names = |list: &Value| {
        let name = |symbol: &Value| symbol["name"].as_str().unwrap().to_owned();
        list.as_array().unwrap().iter().map(name).collect::<Vec<_>>()
    };
    assert_eq!(names(&symbols), ["slider_crank"]);
    assert_eq!(names(&symbols[0]["children"])[3..5], ["ground", "crank"]);
    client.end();
}

#[test]
fn sessions_follow_the_protocol() {
    const NOT_INITIALIZED: i32 = -32002;
    const INVALID_REQUEST: i32 = -32600;
    const METHOD_NOT_FOUND: i32 = -32601;
    const INVALID_PARAMS: i32 = -32602;
    let mut client = Client::before_initialize(Memory::default());
    assert_eq!(client.refused("textDocument/hover", json!({})), NOT_INITIALIZED);
    client.notify("textDocument/didOpen", json!({ "textDocument": 3 }));
    let server = client.request("initialize", json!({ "capabilities": {} }));
    assert_eq!(server["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(client.refused("initialize", json!({ "capabilities": {} })), INVALID_REQUEST);
    assert_eq!(client.refused("textDocument/nothing", json!({})), METHOD_NOT_FOUND);
    assert_eq!(client.refused("textDocument/hover", json!({ "position": 7 })), INVALID_PARAMS);
    client.notify("textDocument/didChange", json!({ "textDocument": {} }));
    let nowhere = json!({ "textDocument": { "uri": URI }, "position": { "line": 1, "character": 1 } });
    assert_eq!(client.request("textDocument/hover", nowhere), Value::Null);
    assert_eq!(client.request("shutdown", Value::Null), Value::Null);
    assert_eq!(client.refused("shutdown", Value::Null), INVALID_REQUEST);
    client.notify("exit", Value::Null);
    assert_eq!(client.vanish(), SessionEnd::Well);
}

#[test]
fn vanished_clients_end_the_server() {
    assert_eq!(pushed_to().vanish(), SessionEnd::Early);
}

/// A mechanism whose results are known behind its motion.
const SWING: &str = "mechanism swing {
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point tip = (50 mm, 0) }
    joint pivot: revolute(ground.O, arm.O)
    driver motor: rotation(pivot) = 30 deg * sin(t)
    result top = max(y(arm.tip)) in mm
    analysis from 0 s to 2 s every 0.1 s
}
";

#[test]
fn results_refresh_lenses() {
    let able = json!({
        "workspace": { "codeLens": { "refreshSupport": true } },
        "experimental": { "commands": { "commands": ["mechc.run", "mechc.check"] } },
    });
    let mut client = Client::new(&able, Memory::default());
    client.open(URI, SWING);
    client.asked("workspace/codeLens/refresh");
    let lenses = client.request("textDocument/codeLens", json!({ "textDocument": { "uri": URI } }));
    let shown = |lens: &Value| format!("{} {}", lens["range"]["start"]["line"], lens["command"]);
    let shown: Vec<String> = lenses.as_array().unwrap().iter().map(shown).collect();
    insta::assert_snapshot!(shown.join("\n"), @r#"
    0 {"title":"run","command":"mechc.run","arguments":["file:///work/slider_crank.mech","swing"]}
    0 {"title":"check","command":"mechc.check","arguments":["file:///work/slider_crank.mech","swing"]}
    5 {"title":"25 mm","command":""}
    "#);
    client.end();
    // who has no such commands is not offered them
    let mut client = pushed_to();
    client.open(URI, SWING);
    assert_eq!(client.request("textDocument/codeLens", json!({ "textDocument": { "uri": URI } })), json!([]));
    client.end();
}

#[test]
fn hints_tokens_and_signatures_are_in_the_words_of_the_protocol() {
    let mut client = pushed_to();
    let text = SWING.replace("arm", "𝛼rm");
    client.open(URI, &text);
    let document = json!({ "uri": URI });
    let line = json!({ "start": { "line": 2, "character": 0 }, "end": { "line": 3, "character": 0 } });
    let params = json!({ "textDocument": document, "range": line });
    let hints = client.request("textDocument/inlayHint", params.clone());
    insta::assert_snapshot!(hints, @r#"[{"position":{"line":2,"character":13},"label":"+3","tooltip":"3 coordinates","paddingLeft":true}]"#);
    let tokens = client.request("textDocument/semanticTokens/range", params);
    insta::assert_snapshot!(tokens, @r#"{"data":[2,4,4,10,0,0,5,4,2,1,0,7,5,10,0,0,6,1,3,1,0,11,5,10,0,0,6,3,3,1,0,10,2,9,6]}"#);
    let all = client.request("textDocument/semanticTokens/full", json!({ "textDocument": document }));
    assert!(all["data"].as_array().unwrap().len() > 100);
    let position = position(&text, "𝛼rm.O)");
    let help = client.request("textDocument/signatureHelp", json!({ "textDocument": document, "position": position }));
    insta::assert_snapshot!(format!("{} {}", help["signatures"][0]["label"], help["activeParameter"]), @r#""revolute(P, Q)" 1"#);
    client.end();
}

/// What hints count by the text alone is what the equations are.
#[test]
fn example_counts_match_equations() {
    let mut visited = 0;
    for folder in ["examples", "tests/cases"] {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|ending| ending != "mech") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let uri = format!("file://{}", path.display());
            let counted = counted(&uri, &text, &path);
            for (shown, system) in counted {
                assert_eq!(shown, system, "{}", path.display());
                visited += 1;
            }
        }
    }
    assert!(visited > 50, "{visited}");
}

/// The hints `NDOF = …` of a text's mechanisms, each with that of the equations.
fn counted(uri: &str, text: &str, path: &std::path::Path) -> Vec<(String, String)> {
    use mechc::Parsed;
    let mut files = Memory::default();
    for beside in std::fs::read_dir(path.parent().unwrap()).unwrap() {
        let beside = beside.unwrap().path();
        if let Ok(text) = std::fs::read_to_string(&beside) {
            files = files.with(beside.display().to_string(), &text);
        }
    }
    let systems = Parsed::new(&path.display().to_string(), text).check_each(&files);
    let systems = systems.iter().map(|checked| checked.equations_text().expect("it is sound")).map(|text| {
        let numbers = text.lines().next().unwrap().rsplit_once(": ").unwrap().1.split(' ');
        let numbers: Vec<i64> = numbers.filter_map(|word| word.parse().ok()).collect();
        format!("NDOF = {}", numbers[0] - numbers[1])
    });
    let systems: Vec<String> = systems.collect();
    let mut client = Client::new(&json!({}), files);
    client.open(uri, text);
    let everything = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 1_000_000, "character": 0 } });
    let params = json!({ "textDocument": { "uri": uri }, "range": everything });
    let hints = client.request("textDocument/inlayHint", params);
    client.end();
    let labels = hints.as_array().unwrap().iter().map(|hint| hint["label"].as_str().unwrap().replace('−', "-"));
    let shown: Vec<String> = labels.filter(|label| label.starts_with("NDOF")).collect();
    assert_eq!(shown.len(), systems.len(), "{uri}");
    shown.into_iter().zip(systems).collect()
}

#[cfg(unix)]
#[test]
fn server_ends_with_its_parent_process() {
    use std::io::Read;
    use std::process::{Command, Stdio};
    use std::sync::mpsc::channel;
    use std::time::Duration;
    let folder = tempfile::tempdir().expect("a folder");
    // an editor that dies without a word; what the server reads from is open for writing in the server itself
    let editor = r#"mkfifo in; exec 3<>in; "$0" lsp <&3 &
        body='{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"processId":'$$',"capabilities":{}}}'
        printf 'Content-Length: %d\r\n\r\n%s' ${#body} "$body" >&3; wait"#;
    let mut command = Command::new("sh");
    command.args(["-c", editor, env!("CARGO_BIN_EXE_mechc")]).current_dir(folder.path()).stdout(Stdio::piped());
    let mut process = command.spawn().expect("it starts");
    let mut output = process.stdout.take().expect("it is piped");
    let (tell, reported) = channel();
    std::thread::spawn(move || {
        let mut bytes = [0; 4096];
        while let Ok(count @ 1..) = output.read(&mut bytes) {
            let _ = tell.send(String::from_utf8_lossy(&bytes[..count]).into_owned());
        }
    });
    let mut heard = String::new();
    while !heard.contains("serverInfo") {
        heard += &reported.recv_timeout(Duration::from_secs(240)).expect("an answer");
    }
    assert!(
        reported
            .recv_timeout(Duration::from_secs(2))
            .is_err_and(|why| why == std::sync::mpsc::RecvTimeoutError::Timeout)
    );
    process.kill().expect("it is there");
    process.wait().expect("it ends");
    let ended = reported.recv_timeout(Duration::from_secs(240));
    assert_eq!(ended, Err(std::sync::mpsc::RecvTimeoutError::Disconnected), "the server is there still");
}
