//! Live pages of open texts: what an editor's panel asks, and a browser over the address.

use super::client::Client;
use super::{TEXT, URI, edit, position, pushed_to};
use lsp_server::Message;
use mechc::Memory;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;

fn text() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

/// What a panel is answered: the JSON before the table.
fn requested(client: &mut Client, set: &Value) -> String {
    let params = json!({ "textDocument": { "uri": URI }, "asked": { "page": "panel", "set": set } });
    let answer = client.request("mechc/view/ask", params);
    decoded(answer["data"].as_str().expect("a text"))
}

/// The letters behind Base64, as far as they are some.
fn decoded(text: &str) -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut count, mut bytes) = (0_u32, 0, Vec::new());
    for letter in text.bytes().filter(|letter| *letter != b'=') {
        bits = bits << 6 | letters.iter().position(|other| *other == letter).expect("a letter") as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn news(client: &mut Client) -> Value {
    match client.wait_for(
        |reported| matches!(reported, Message::Notification(reported) if reported.method == "mechc/view/news"),
    ) {
        Message::Notification(reported) => reported.params,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_panel_follows_the_text_and_the_cursor() {
    let (mut client, mut own) = (pushed_to(), TEXT.to_owned());
    client.open(URI, &own);
    let panel = client.request("mechc/view/panel", text());
    assert!(panel["html"].as_str().is_some_and(|html| html.contains("<script>")));
    assert_eq!(news(&mut client)["version"], 1);
    assert!(requested(&mut client, &json!([])).contains("slider_crank"));
    let change = edit(&mut own, "mechanism slider_crank", "mechanism another_name");
    client.change(URI, &change);
    assert_eq!(news(&mut client)["version"], 2);
    assert!(requested(&mut client, &json!([])).contains("another_name"), "the page has the text of before");
    let mut pointed = text();
    pointed["position"] = position(&own, "another_name");
    client.notify("mechc/cursor", pointed);
    assert_eq!(news(&mut client)["at"], own.find("another_name").expect("it is there"));
    client.end();
}

#[test]
fn panels_of_closed_texts_follow_the_file() {
    let on_disk = TEXT.replace("mechanism slider_crank", "mechanism on_disk");
    let mut client = Client::new(&json!({}), Memory::default().with("/work/slider_crank.mech", on_disk.as_str()));
    let mut own = TEXT.to_owned();
    client.open(URI, &own);
    client.request("mechc/view/panel", text());
    assert_eq!(news(&mut client)["version"], 1);
    client.notify("textDocument/didClose", text());
    assert_eq!(news(&mut client)["version"], 2);
    assert!(requested(&mut client, &json!([])).contains("on_disk"), "the page has the text that was closed");
    // what it writes opens the text again
    let change = json!({ "name": "rod_length", "old": value_of("rod_length"), "value": 321.5 });
    let mut params = text();
    params["asked"] = json!({ "version": 2, "changes": [change], "sure": false });
    let write = client.send_request("mechc/view/write", params);
    let asked_for = edited(&mut client, &json!({ "applied": true }));
    assert!(asked_for["changes"][URI].is_array(), "{asked_for}");
    assert_eq!(result(&mut client, write), json!({ "written": true }));
    client.open(URI, &own);
    let change = edit(&mut own, "mechanism slider_crank", "mechanism another_name");
    client.change(URI, &change);
    assert!(news(&mut client)["version"].as_u64() > Some(2), "a panel that was there before is told nothing");
    assert!(requested(&mut client, &json!([])).contains("another_name"));
    client.notify("mechc/view/close", text());
    client.end();
}

/// What the text says of a param.
fn value_of(param: &str) -> &'static str {
    let line = TEXT.lines().find(|line| line.contains(&format!("param {param}"))).expect("a param");
    line.split_once("= ").expect("a value").1.split("//").next().expect("a value").trim()
}

#[test]
fn panel_writes_are_text_edits() {
    let mut client = pushed_to();
    client.open(URI, TEXT);
    let change = json!({ "name": "rod_length", "old": value_of("rod_length"), "value": 321.5 });
    let write = json!({ "version": 1, "changes": [change], "sure": false });
    let mut params = text();
    params["asked"] = write;
    let write = client.send_request("mechc/view/write", params.clone());
    let edit = edited(&mut client, &json!({ "applied": true }))["changes"][URI][0].clone();
    assert!("321.5".contains(edit["newText"].as_str().expect("a text")), "{edit}");
    assert_eq!(result(&mut client, write), json!({ "written": true }));
    params["asked"]["version"] = json!(7);
    let refused = client.request("mechc/view/write", params);
    assert!(refused["refused"].as_str().is_some_and(|why| why.contains("another by now")), "{refused}");
    client.end();
}

/// The edit that the client is asked for next, which it answers.
fn edited(client: &mut Client, answer: &Value) -> Value {
    let message =
        client.wait_for(|sent| matches!(sent, Message::Request(sent) if sent.method == "workspace/applyEdit"));
    let Message::Request(sent) = message else { panic!("it is one") };
    client.answer(sent.id, answer.clone());
    sent.params["edit"].clone()
}

fn result(client: &mut Client, request: i32) -> Value {
    client.response(request).response_result.expect("it is answered")
}

#[test]
fn edits_carry_versions() {
    let capabilities = json!({ "workspace": { "workspaceEdit": { "documentChanges": true } } });
    let mut client = Client::new(&capabilities, Memory::default());
    let mut own = TEXT.to_owned();
    client.open(URI, &own);
    let change = edit(&mut own, "mechanism slider_crank", "mechanism another_name");
    client.change(URI, &change);
    client.request("mechc/view/panel", text());
    let change = json!({ "name": "rod_length", "old": value_of("rod_length"), "value": 321.5 });
    let version = news(&mut client)["version"].clone();
    let mut params = text();
    params["asked"] = json!({ "version": version, "changes": [change], "sure": false });
    for (answer, wanted) in [
        (json!({ "applied": false, "failureReason": "a version is old" }), "did not take the edit: a version is old"),
        (json!({ "applied": false }), "did not take the edit"),
        (json!({ "applied": true }), "written"),
    ] {
        let write = client.send_request("mechc/view/write", params.clone());
        let edit = edited(&mut client, &answer)["documentChanges"][0].clone();
        assert_eq!(edit["textDocument"], json!({ "uri": URI, "version": 2 }));
        assert!("321.5".contains(edit["edits"][0]["newText"].as_str().expect("a text")), "{edit}");
        let reported = result(&mut client, write);
        let says = reported["refused"].as_str().unwrap_or("written");
        assert!(says.contains(wanted), "{reported}");
    }
    client.end();
}

#[test]
fn cursors_in_used_files_highlight() {
    const MAIN: &str = "use \"arm.mech\"
mechanism disc {
    part one: arm()
    driver motor: rotation(one.axle) = 1 rad/s * t
    analysis from 0 s to 1 s every 100 ms
}
";
    const ARM: &str = "mechanism arm {
    ground { point O = (0, 0) }
    body bar { point O = (0, 0) point P = (20 mm, 0) }
    joint axle: revolute(ground.O, bar.O)
}
";
    let [uri, used, other] = ["disc", "arm", "other"].map(|name| format!("file:///work/{name}.mech"));
    let mut client = pushed_to();
    for (uri, text) in [(&used, ARM), (&other, ARM), (&uri, MAIN)] {
        client.open(uri, text);
    }
    let page = json!({ "textDocument": { "uri": uri } });
    client.request("mechc/view/panel", page.clone());
    assert_eq!(news(&mut client)["version"], 1);
    let mut ask = page;
    ask["asked"] = json!({ "page": "panel" });
    client.request("mechc/view/ask", ask);
    let mut pointed = |uri: &str, text: &str, what: &str| {
        let place = json!({ "textDocument": { "uri": uri }, "position": position(text, what) });
        client.notify("mechc/cursor", place);
        let news = news(&mut client);
        (news["at"].clone(), news["file"].clone())
    };
    let at = |text: &str, what: &str| json!(text.find(what).expect("it is there"));
    assert_eq!(pointed(&uri, MAIN, "motor"), (at(MAIN, "motor"), Value::Null));
    let (place, file) = pointed(&used, ARM, "bar");
    assert_eq!(place, at(ARM, "bar"));
    assert!(file.as_str().is_some_and(|name| name.ends_with("arm.mech")), "{file}");
    // what the page does not show is not lit, nor what was lit before
    assert_eq!(pointed(&other, ARM, "bar"), (Value::Null, Value::Null));
    client.end();
}

#[test]
fn browsers_get_the_same_page() {
    let mut client = pushed_to();
    client.open(URI, TEXT);
    let url = client.request("mechc/view", text())["url"].as_str().expect("an address").to_owned();
    assert_eq!(client.request("mechc/view", text())["url"], url.as_str(), "a text has one address");
    let (address, token) = url.trim_start_matches("http://").split_once("/#").expect("a token");
    let ask = |path: &str, body: &str| {
        let mut stream = TcpStream::connect(address).expect("it listens");
        let length = body.len();
        let head =
            format!("Host: {address}\r\nOrigin: http://{address}\r\nX-Mechc-Token: {token}\r\nConnection: close");
        write!(stream, "POST {path} HTTP/1.1\r\n{head}\r\nContent-Length: {length}\r\n\r\n{body}").expect("it is sent");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("an answer");
        String::from_utf8_lossy(&answer).into_owned()
    };
    assert!(ask("/motion", r#"{"page":"a"}"#).contains("slider_crank"));
    let at = TEXT.find("body").expect("a body");
    assert!(ask("/show", &json!({ "at": at }).to_string()).starts_with("HTTP/1.1 200"));
    let message =
        client.wait_for(|sent| matches!(sent, Message::Request(sent) if sent.method == "window/showDocument"));
    let Message::Request(sent) = message else { panic!("it is one") };
    assert_eq!(sent.params["selection"]["start"], position(TEXT, "body"));
    client.end();
}
