//! A client in memory: what an editor would say, and what it would show.

use lsp_server::{Connection, Message, Notification, Request, Response};
use mechc::{Memory, World};
use mechc_ide::lsp::{Log, SessionEnd, serve};
use serde_json::{Value, json};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// What is not answered by then is not answered at all.
const PATIENCE: Duration = Duration::from_secs(20);

pub struct Client {
    connection: Connection,
    server: JoinHandle<SessionEnd>,
    next_id: i32,
    /// What came while something else was waited for.
    waiting: VecDeque<Message>,
    /// The texts that are open, with their versions.
    versions: BTreeMap<String, i32>,
}

impl Client {
    /// An editor with some abilities, that has said `initialized`.
    pub fn new(capabilities: &Value, files: Memory) -> Client {
        Client::over(capabilities, Arc::new(files))
    }

    /// The same, over files that may change.
    pub fn over(capabilities: &Value, files: Arc<dyn World>) -> Client {
        let mut client = Client::serving(files);
        client.request("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        client.notify("initialized", json!({}));
        client
    }

    pub fn before_initialize(files: Memory) -> Client {
        Client::serving(Arc::new(files))
    }

    fn serving(files: Arc<dyn World>) -> Client {
        let (connection, other) = Connection::memory();
        let server = thread::spawn(move || serve(other, files, Log::none()));
        Client { connection, server, next_id: 0, waiting: VecDeque::new(), versions: BTreeMap::new() }
    }

    pub fn send_request(&mut self, method: &str, params: Value) -> i32 {
        self.next_id += 1;
        let request = Request { id: self.next_id.into(), method: method.to_owned(), params };
        self.connection.sender.send(request.into()).expect("the server is there");
        self.next_id
    }

    /// The answer to a request, as it is.
    pub fn response(&mut self, id: i32) -> Response {
        let is_it = |message: &Message| matches!(message, Message::Response(response) if response.id == id.into());
        match self.wait_for(is_it) {
            Message::Response(response) => response,
            _ => unreachable!("it is an answer"),
        }
    }

    /// The result of a request.
    pub fn request(&mut self, method: &str, params: Value) -> Value {
        let id = self.send_request(method, params);
        self.response(id).response_result.unwrap_or_else(|error| panic!("{method}: {error:?}"))
    }

    /// The code of the error that a request is answered with.
    pub fn refused(&mut self, method: &str, params: Value) -> i32 {
        let id = self.send_request(method, params);
        self.response(id).response_result.expect_err("it is refused").code
    }

    /// Answers a request of the server.
    pub fn answer(&self, id: lsp_server::RequestId, result: Value) {
        let response = Response { id, response_result: Ok(result) };
        self.connection.sender.send(response.into()).expect("the server is there");
    }

    pub fn notify(&self, method: &str, params: Value) {
        let notification = Notification { method: method.to_owned(), params };
        self.connection.sender.send(notification.into()).expect("the server is there");
    }

    /// The next message of the server of some kind; the others wait.
    pub fn wait_for(&mut self, is_it: impl Fn(&Message) -> bool) -> Message {
        if let Some(at) = self.waiting.iter().position(&is_it) {
            return self.waiting.remove(at).expect("it is there");
        }
        loop {
            let message = self.connection.receiver.recv_timeout(PATIENCE).expect("a message in time");
            if is_it(&message) {
                return message;
            }
            self.waiting.push_back(message);
        }
    }

    pub fn open(&mut self, uri: &str, text: &str) {
        self.versions.insert(uri.to_owned(), 1);
        let document = json!({ "uri": uri, "languageId": "mech", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Edits a text; a change without a range is the whole text.
    pub fn change(&mut self, uri: &str, changes: &Value) {
        let version = self.versions.get_mut(uri).expect("it is open");
        *version += 1;
        let document = json!({ "uri": uri, "version": version });
        self.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// What the server next says of a text: its version and each diagnostic, as a line.
    pub fn published(&mut self, uri: &str) -> (i64, Vec<String>) {
        let message = self.wait_for(|message| match message {
            Message::Notification(reported) => {
                reported.method == "textDocument/publishDiagnostics" && reported.params["uri"] == uri
            }
            _ => false,
        });
        let Message::Notification(reported) = message else { unreachable!("it is one") };
        let diagnostics = reported.params["diagnostics"].as_array().expect("a list");
        (reported.params["version"].as_i64().unwrap_or_default(), diagnostics.iter().map(line).collect())
    }

    /// Asks for the diagnostics of a text.
    pub fn pulled(&mut self, uri: &str) -> Vec<String> {
        let report = self.request("textDocument/diagnostic", json!({ "textDocument": { "uri": uri } }));
        report["items"].as_array().expect("a list").iter().map(line).collect()
    }

    /// Asks for the diagnostics of a text until they are what they should be: `line:column code message` of each.
    pub fn pulls_until(&mut self, uri: &str, expected: &[String], patience: Duration) {
        let begin = Instant::now();
        loop {
            let report = self.request("textDocument/diagnostic", json!({ "textDocument": { "uri": uri } }));
            let mut reported: Vec<String> = report["items"].as_array().expect("a list").iter().map(line).collect();
            let mut expected = expected.to_vec();
            reported.sort();
            expected.sort();
            if reported == expected {
                return;
            }
            assert!(begin.elapsed() < patience, "it says\n{}\nand not\n{}", reported.join("\n"), expected.join("\n"));
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Answers that nobody has taken, and those that come while the server still works.
    pub fn answers_left(&mut self) -> Vec<Response> {
        // what was asked before this is answered before, or never
        self.request("textDocument/diagnostic", json!({ "textDocument": { "uri": "file:///none.mech" } }));
        let (answers, others) =
            std::mem::take(&mut self.waiting).into_iter().partition(|m| matches!(m, Message::Response(_)));
        self.waiting = others;
        let answers: VecDeque<Message> = answers;
        let answer = |message| if let Message::Response(answer) = message { Some(answer) } else { None };
        answers.into_iter().filter_map(answer).collect()
    }

    /// What the server asks, which is answered with nothing.
    pub fn asked(&mut self, method: &str) {
        let message = self.wait_for(|message| matches!(message, Message::Request(asked) if asked.method == method));
        let Message::Request(asked) = message else { unreachable!("it is one") };
        let answer = Response { id: asked.id, response_result: Ok(Value::Null) };
        self.connection.sender.send(answer.into()).expect("the server is there");
    }

    /// Ends as the protocol says.
    pub fn end(mut self) {
        assert_eq!(self.request("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        assert_eq!(self.server.join().expect("it does not panic"), SessionEnd::Well, "it ended in order");
    }

    /// Goes without a word; what the server takes that for.
    pub fn vanish(self) -> SessionEnd {
        drop(self.connection);
        self.server.join().expect("it does not panic")
    }
}

/// `3:5 E0201 no …`, from 1.
fn line(diagnostic: &Value) -> String {
    let start = &diagnostic["range"]["start"];
    let [line, column] = ["line", "character"].map(|name| start[name].as_u64().expect("a number") + 1);
    let message = diagnostic["message"].as_str().expect("a text");
    let code = diagnostic["code"].as_str().expect("a code");
    format!("{line}:{column} {code} {}", message.lines().next().unwrap_or_default())
}
