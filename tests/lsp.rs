//! The language server, as a client sees it.

#![cfg(feature = "lsp")]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

#[path = "lsp/client.rs"]
mod client;

use client::Client;
use mechc::Memory;
use serde_json::{Value, json};

const URI: &str = "file:///work/slider_crank.mech";
const TEXT: &str = include_str!("../examples/slider_crank.mech");

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
fn a_mistake_is_told_where_it_is_and_gone_when_it_is_mended() {
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
    let (_, told) = client.published(URI);
    insta::assert_snapshot!(told.join("\n"), @"5:11 E0502 1 degree of freedom is left in mechanism `slider_crank`");
    // a line more above it: no empty list comes in between
    let change = edit(&mut text, "mechanism slider_crank {", "\nmechanism slider_crank {");
    client.change(URI, &change);
    let (version, told) = client.published(URI);
    insta::assert_snapshot!(format!("{version}: {}", told.join("\n")), @"2: 5:1 E0502 1 degree of freedom is left in mechanism `slider_crank`");
    client.end();
}

#[test]
fn who_pulls_is_told_to_ask_again_and_never_told_by_itself() {
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
fn sessions_go_as_the_protocol_says() {
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
    assert!(client.vanish());
}

#[test]
fn who_vanishes_ends_it() {
    assert!(!pushed_to().vanish());
}
