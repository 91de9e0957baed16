//! What helps to write, as a client sees it.

use super::client::Client;
use super::position;
use mechc::Memory;
use serde_json::{Value, json};

const LEVER: &str = "mechanism lever {\n    param reach = 80 mm\n    ground { point O = (0, 0) }\n    body arm { point O = (0, 0)  point tip = (reach, 0) }\n    joint pivot: revolute(ground.O, arm.O)\n    driver motor: rotation(pivot) = 1 rad/s * t\n}\n";
const USER: &str =
    "use \"lever.mech\"\nmechanism pair {\n    part left: lever(reach = 60 mm)\n    measure a1 = x(left.arm.tip)\n}\n";
const URI: &str = "file:///w/user.mech";

/// A folder with two files, of which none is open.
fn in_folder(capabilities: &Value) -> Client {
    let files = Memory::default().with("/w/lever.mech", LEVER).with("/w/user.mech", USER);
    let mut client = Client::before_initialize(files);
    let folders = json!([{ "uri": "file:///w", "name": "w" }]);
    client.request("initialize", json!({ "capabilities": capabilities, "workspaceFolders": folders }));
    client.notify("initialized", json!({}));
    client
}

fn at(uri: &str, text: &str, what: &str) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": position(text, what) })
}

fn with(mut params: Value, name: &str, value: Value) -> Value {
    params[name] = value;
    params
}

/// A text after edits of the protocol, which do not overlap (in UTF-16; the lines are ASCII).
fn edited(text: &str, edits: &Value) -> String {
    let lines: Vec<usize> = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
    let offset = |position: &Value| {
        lines[position["line"].as_u64().unwrap() as usize] + position["character"].as_u64().unwrap() as usize
    };
    let mut edits: Vec<&Value> = edits.as_array().expect("edits").iter().collect();
    edits.sort_by_key(|edit| std::cmp::Reverse(offset(&edit["range"]["start"])));
    let mut text = text.to_owned();
    for edit in edits {
        let range = offset(&edit["range"]["start"])..offset(&edit["range"]["end"]);
        text.replace_range(range, edit["newText"].as_str().expect("a text"));
    }
    text
}

/// An answer that is not empty, once the folder has been looked through, which goes on beside all else.
fn some(client: &mut Client, method: &str, params: &Value) -> Value {
    let found = (0..200).find_map(|_| {
        let found = client.request(method, params.clone());
        let is_some = found.as_array().is_some_and(|found| !found.is_empty());
        if !is_some {
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        is_some.then_some(found)
    });
    found.expect("it is found")
}

#[test]
fn definitions_reach_unopened_files() {
    let mut client = in_folder(&json!({}));
    client.open(URI, USER);
    let found = client.request("textDocument/definition", at(URI, USER, "tip"));
    assert_eq!(found["uri"], "file:///w/lever.mech");
    assert_eq!(found["range"]["start"], position(LEVER, "tip"));
    let links = client.request("textDocument/documentLink", json!({ "textDocument": { "uri": URI } }));
    assert_eq!(links[0]["target"], "file:///w/lever.mech");
    let found = some(&mut client, "workspace/symbol", &json!({ "query": "tip" }));
    assert_eq!((&found[0]["name"], &found[0]["containerName"]), (&json!("tip"), &json!("lever.arm")));
    client.end();
}

#[test]
fn uses_are_found_in_files_of_the_folder() {
    let mut client = in_folder(&json!({}));
    let uri = "file:///w/lever.mech";
    client.open(uri, LEVER);
    let context = json!({ "includeDeclaration": false });
    let requested = with(at(uri, LEVER, "tip"), "context", context);
    assert_eq!(some(&mut client, "textDocument/references", &requested)[0]["uri"], URI);
    client.end();
}

#[test]
fn renames_span_files_or_explain() {
    const REQUEST_FAILED: i32 = -32803;
    let mut client = in_folder(&json!({}));
    client.open(URI, USER);
    let place = at(URI, USER, "arm.tip");
    assert_eq!(client.request("textDocument/prepareRename", place.clone())["start"], position(USER, "arm.tip"));
    let edit = client.request("textDocument/rename", with(place.clone(), "newName", json!("bar")));
    assert_eq!(edited(USER, &edit["changes"][URI]), USER.replace("arm", "bar"));
    assert_eq!(edited(LEVER, &edit["changes"]["file:///w/lever.mech"]), LEVER.replace("arm", "bar"));
    assert_eq!(client.refused("textDocument/rename", with(place, "newName", json!("reach"))), REQUEST_FAILED);
    assert_eq!(client.refused("textDocument/prepareRename", at(URI, USER, "measure")), REQUEST_FAILED);
    client.end();
}

#[test]
fn completions_have_placeholders() {
    let text = "mechanism m {\n    body 𝛼 { point P = (0, 0) }\n    joint j: rev\n    measure w = x(𝛼.)\n}\n";
    let snippets = json!({ "textDocument": { "completion": { "completionItem": { "snippetSupport": true } } } });
    let mut texts = Vec::new();
    for capabilities in [snippets, json!({})] {
        let mut client = in_folder(&capabilities);
        client.open(URI, text);
        let place = json!({ "textDocument": { "uri": URI }, "position": { "line": 2, "character": 16 } });
        let items = client.request("textDocument/completion", place);
        let item = items.as_array().expect("a list").iter().find(|item| item["label"] == "revolute").expect("a joint");
        texts.push(item["textEdit"]["newText"].as_str().expect("a text").to_owned());
        assert_eq!(item["textEdit"]["range"]["start"]["character"], 13);
        // in UTF-16 the letter before the dot is two
        let place = json!({ "textDocument": { "uri": URI }, "position": { "line": 3, "character": 21 } });
        let items = client.request("textDocument/completion", place);
        assert_eq!((&items[0]["label"], &items[0]["textEdit"]["range"]["end"]["character"]), (&json!("P"), &json!(21)));
        client.end();
    }
    assert_eq!(texts, ["revolute(${1:P}, ${2:Q})", "revolute("]);
}

#[test]
fn actions_match_requested_kinds() {
    let text = USER.replace("left.arm.tip", "left.arn.tip");
    let mut client = in_folder(&json!({}));
    client.open(URI, &text);
    let start = position(&text, "arn.tip");
    let actions = |client: &mut Client, only: Value| {
        let context = json!({ "diagnostics": [], "only": only });
        let requested =
            json!({ "textDocument": { "uri": URI }, "range": { "start": start, "end": start }, "context": context });
        client.request("textDocument/codeAction", requested)
    };
    let offered = actions(&mut client, json!(["quickfix"]));
    assert_eq!(edited(&text, &offered[0]["edit"]["changes"][URI]), USER, "{offered}");
    assert!(offered[0]["diagnostics"][0]["message"].as_str().expect("a text").contains("arn"), "{offered}");
    assert_eq!(actions(&mut client, json!(["source"])), json!([]));
    client.end();
}

#[test]
fn texts_are_formatted_folded_and_selected() {
    let text = "mechanism m {\nparam a=3 mm\n}\n";
    let mut client = in_folder(&json!({ "textDocument": { "foldingRange": { "lineFoldingOnly": true } } }));
    client.open(URI, text);
    let options = json!({ "tabSize": 4, "insertSpaces": true });
    let document = json!({ "uri": URI });
    let edits = client.request("textDocument/formatting", json!({ "textDocument": document, "options": options }));
    assert_eq!(edited(text, &edits), "mechanism m {\n    param a = 3 mm\n}\n");
    let typed =
        json!({ "textDocument": document, "options": options, "ch": "}", "position": { "line": 2, "character": 1 } });
    assert_eq!(client.request("textDocument/onTypeFormatting", typed), edits);
    let folds = client.request("textDocument/foldingRange", json!({ "textDocument": document }));
    assert_eq!((&folds[0]["startLine"], &folds[0]["endLine"]), (&json!(0), &json!(1)));
    let positions = json!([position(text, "3 mm")]);
    let selected =
        client.request("textDocument/selectionRange", json!({ "textDocument": document, "positions": positions }));
    let outer = (0..3).fold(&selected[0], |inner, _| &inner["parent"]);
    assert_eq!(outer["range"]["start"], json!({ "line": 0, "character": 13 }));
    client.end();
}

#[test]
fn capable_clients_watch_files() {
    let mut client = in_folder(&json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } }));
    client.asked("client/registerCapability");
    client.end();
}
