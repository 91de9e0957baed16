//! Whatever is typed and asked in whatever order: each request is answered once, nothing breaks, and afterwards the server knows what
//! one does that was just started.

use super::client::Client;
use crate::support::random::Random;
use mechc::{Cancel, Contents, World};
use mechc_ide::lsp::methods;
use mechc_ide::{self as ide, DiagnosticStage, Snapshot};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What is not known by then is not known at all.
const PATIENCE: Duration = Duration::from_secs(30);

/// What requests may be refused with: the text was changed, or the request cancelled.
const REFUSALS: [i32; 2] = [-32801, -32800];

/// What names nothing gets no other name.
const REQUEST_FAILED: i32 = -32803;

/// Requests that take what an answer gave; made up, they may be refused as such.
const INVALID_PARAMS: i32 = -32602;

/// What two servers that know the same answer alike.
const COMPARED: [&str; 7] = [
    "textDocument/completion",
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/hover",
    "textDocument/inlayHint",
    "textDocument/semanticTokens/full",
    "textDocument/codeAction",
];

const TYPED: [&str; 24] = [
    "{",
    "}",
    "(",
    ")",
    "\"",
    "//",
    "\n",
    "\r\n",
    "\r",
    " ",
    ".",
    ",",
    "=",
    "3",
    " mm",
    "a",
    "µ",
    "𝛼",
    "🦀\u{200d}",
    "\u{200b}",
    "body b at (0, 0, 0) {",
    "param p = 1",
    "use \"other.mech\"",
    "joint j: revolute(",
];

/// Files that can be changed under who reads them.
#[derive(Default)]
struct Shelf(Mutex<BTreeMap<PathBuf, Arc<[u8]>>>);

impl Shelf {
    fn put(&self, path: &str, text: Option<&str>) {
        let mut files = self.0.lock().expect("nobody panics");
        match text {
            Some(text) => drop(files.insert(path.into(), text.as_bytes().into())),
            None => drop(files.remove(Path::new(path))),
        }
    }
}

impl World for Shelf {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        let files = self.0.lock().expect("nobody panics");
        let bytes = files.get(path).cloned().ok_or(io::ErrorKind::NotFound)?;
        Ok(Contents { bytes, version: 0 })
    }
}

/// A session with what it should know: the texts, kept by rules of its own.
struct Session {
    client: Client,
    world: Arc<Shelf>,
    texts: BTreeMap<String, String>,
    random: Random,
    asked: Vec<(i32, &'static str)>,
}

impl Session {
    fn new(seed: u64) -> Session {
        let world = Arc::new(Shelf::default());
        let client = client(&world);
        Session { client, world, texts: BTreeMap::new(), random: Random::new(seed), asked: Vec::new() }
    }

    fn open(&mut self, uri: &str, text: &str) {
        self.texts.insert(uri.to_owned(), text.to_owned());
        self.client.open(uri, text);
    }

    fn close(&mut self, uri: &str) {
        self.texts.remove(uri);
        self.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    }

    /// A file is another one, or none, and the client tells so.
    fn put(&mut self, path: &str, text: Option<&str>) {
        self.world.put(path, text);
        let change = json!({ "uri": format!("file://{path}"), "type": if text.is_some() { 2 } else { 3 } });
        self.client.notify("workspace/didChangeWatchedFiles", json!({ "changes": [change] }));
    }

    fn change(&mut self, uri: &str, [start, end]: [(usize, usize); 2], new: &str) {
        let position = |(line, character): (usize, usize)| json!({ "line": line, "character": character });
        let range = json!({ "start": position(start), "end": position(end) });
        self.client.change(uri, &json!([{ "range": range, "text": new }]));
        let text = self.texts.get_mut(uri).expect("it is open");
        let [start, end] = [start, end].map(|position| offset(text, position));
        text.replace_range(start.min(end)..start.max(end), new);
    }

    /// A change somewhere, also where there is no text, backwards, or within a character.
    fn change_at_random(&mut self, uri: &str) {
        let text = self.texts[uri].clone();
        let near = |random: &mut Random| {
            let (line, column) = position(&text, random.below(text.len() + 1));
            let (line, column) = (line + [0, 0, 0, 0, 1][random.below(5)], column + [0, 0, 0, 1, 90][random.below(5)]);
            if random.below(50) == 0 { (line + 1_000, column) } else { (line, column) }
        };
        let start = near(&mut self.random);
        let end = match self.random.below(8) {
            0 => near(&mut self.random),
            1 => (start.0, start.1 + self.random.below(12)),
            _ => start,
        };
        let typed = if self.random.below(3) == 0 { "" } else { TYPED[self.random.below(TYPED.len())] };
        self.change(uri, [start, end], typed);
    }

    /// Any request, at any place.
    fn ask_at_random(&mut self, uri: &str) {
        let all: Vec<&'static str> = methods().collect();
        let method = all[self.random.below(all.len())];
        let text = self.texts.get(uri).map_or("", String::as_str);
        let places = [0, 1].map(|_| position(text, self.random.below(text.len() + 1)));
        let id = self.client.send_request(method, anything(uri, places));
        self.asked.push((id, method));
        if self.random.below(10) == 0 {
            self.client.notify("$/cancelRequest", json!({ "id": id }));
        }
    }

    /// All that was asked is answered, each once.
    fn expect_answers(&mut self) {
        for (id, method) in std::mem::take(&mut self.asked) {
            if let Err(error) = self.client.response(id).response_result {
                let is_made_up = method.ends_with("/resolve") && error.code == INVALID_PARAMS;
                let is_no_name = method.to_lowercase().ends_with("rename") && error.code == REQUEST_FAILED;
                assert!(REFUSALS.contains(&error.code) || is_made_up || is_no_name, "{method}: {error:?}");
            }
        }
        let more = self.client.answers_left();
        assert!(more.is_empty(), "answered twice: {more:?}");
    }

    /// What is known of all texts equals what one knows that was just started.
    fn expect_fresh(&mut self) {
        self.expect_answers();
        let mut fresh = client(&self.world);
        for (uri, text) in &self.texts {
            fresh.open(uri, text);
        }
        for (uri, text) in &self.texts {
            let expected = messages(&self.texts, uri, &self.world);
            self.client.pulls_until(uri, &expected, PATIENCE);
            fresh.pulls_until(uri, &expected, PATIENCE);
            for _ in 0..10 {
                let place = position(text, self.random.below(text.len() + 1));
                for method in COMPARED {
                    let params = anything(uri, [place; 2]);
                    let begin = Instant::now();
                    // values of results come with the motion, which one of the two may still follow
                    let (own, other) = loop {
                        let [own, other] =
                            [&mut self.client, &mut fresh].map(|client| client.request(method, params.clone()));
                        if own == other || begin.elapsed() > PATIENCE {
                            break (own, other);
                        }
                        std::thread::sleep(Duration::from_millis(50));
                    };
                    assert_eq!(own, other, "{method} at {place:?} of\n{text}");
                }
            }
        }
        fresh.end();
    }

    fn end(mut self) {
        self.expect_answers();
        self.client.end();
    }
}

fn client(world: &Arc<Shelf>) -> Client {
    let pulls = json!({
        "textDocument": { "diagnostic": {} },
        "workspace": { "diagnostics": { "refreshSupport": true } },
    });
    Client::over(&pulls, world.clone())
}

/// Params that fit requests of every kind.
fn anything(uri: &str, [start, end]: [(usize, usize); 2]) -> Value {
    let position = |(line, character): (usize, usize)| json!({ "line": line, "character": character });
    let range = json!({ "start": position(start.min(end)), "end": position(start.max(end)) });
    json!({
        "textDocument": { "uri": uri },
        "position": position(start),
        "positions": [position(start), position(end)],
        "range": range,
        "context": { "includeDeclaration": true, "diagnostics": [], "triggerKind": 1, "isRetrigger": false },
        "newName": "other",
        "query": "a",
        "ch": "}",
        "options": { "tabSize": 4, "insertSpaces": true },
        "command": "none",
        "previousResultIds": [],
    })
}

/// What all stages say of a text, found without a server: line and column as the protocol counts them, code, message.
fn messages(texts: &BTreeMap<String, String>, uri: &str, world: &Arc<Shelf>) -> Vec<String> {
    let mut snapshot = Snapshot::new(Arc::clone(world) as Arc<dyn World>);
    let path = |uri: &str| -> Arc<Path> { Path::new(uri.strip_prefix("file://").expect("a file")).into() };
    for (uri, text) in texts {
        snapshot = snapshot.with_text(&path(uri), Some(text.as_str().into()));
    }
    let text = &texts[uri];
    let of = |stage| ide::diagnostics(&snapshot, &path(uri), stage, &Cancel::default).expect("nobody cancels it");
    let line = |said: ide::EditorDiagnostic| {
        let (line, column) = position(text, said.range.start as usize);
        format!("{}:{} {} {}", line + 1, column + 1, said.code, said.message)
    };
    [DiagnosticStage::Words, DiagnosticStage::Proof, DiagnosticStage::Motion]
        .into_iter()
        .flat_map(of)
        .map(line)
        .collect()
}

/// The lines of a text with the byte at which each begins, their ends left out.
fn lines(text: &str) -> Vec<(usize, &str)> {
    let (mut lines, mut start, mut at) = (Vec::new(), 0, 0);
    while at < text.len() {
        let length = if text[at..].starts_with("\r\n") { 2 } else { usize::from(text[at..].starts_with(['\r', '\n'])) };
        if length > 0 {
            lines.push((start, &text[start..at]));
            start = at + length;
        }
        at += length.max(text[at..].chars().next().map_or(1, char::len_utf8) * usize::from(length == 0));
    }
    lines.push((start, &text[start..]));
    lines
}

/// Line and column, in UTF-16, of the character at a byte.
fn position(text: &str, byte: usize) -> (usize, usize) {
    let byte = (0..=byte.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).expect("0 is one");
    let lines = lines(text);
    let line = lines.iter().rposition(|(start, _)| *start <= byte).expect("the first one");
    (line, text[lines[line].0..byte].encode_utf16().count())
}

/// The byte of a position, which need not be there.
fn offset(text: &str, (line, column): (usize, usize)) -> usize {
    let Some(&(start, line)) = lines(text).get(line) else { return text.len() };
    let mut units = 0;
    for (at, c) in line.char_indices() {
        units += c.len_utf16();
        if units > column {
            return start + at;
        }
    }
    start + line.len()
}

fn examples() -> Vec<(String, String)> {
    let files = std::fs::read_dir("examples").expect("the folder is there").map(|file| file.expect("a file").path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "mech")).collect();
    files.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a text");
        (format!("file:///work/{}", path.file_name().expect("a name").to_string_lossy()), text)
    };
    files.into_iter().map(read).collect()
}

/// Types a text from its beginning, with requests at random places: all of it, or some of it.
fn type_all(uri: &str, text: &str, seed: u64, every: usize) {
    let mut session = Session::new(seed);
    session.open(uri, "");
    let ends: Vec<usize> = (1..=text.len()).filter(|&at| text.is_char_boundary(at)).step_by(every).collect();
    let mut typed = 0;
    for (k, end) in ends.into_iter().chain([text.len()]).enumerate() {
        let at = position(&session.texts[uri], typed);
        session.change(uri, [at; 2], &text[typed..end]);
        typed = end;
        session.ask_at_random(uri);
        // a server that is left behind does less
        if k % 16 == 0 {
            session.expect_answers();
        }
    }
    session.expect_fresh();
    session.end();
}

#[test]
fn a_text_is_typed_with_requests_in_between() {
    for (k, (uri, text)) in examples().iter().enumerate() {
        type_all(uri, text, k as u64, 23 + k);
    }
}

#[test]
#[ignore = "it takes minutes"]
fn every_text_is_typed_character_by_character() {
    for (k, (uri, text)) in examples().iter().enumerate() {
        type_all(uri, text, k as u64, 1);
    }
}

fn edit_at_random(seed: u64, rounds: usize) {
    let examples = examples();
    let mut session = Session::new(seed);
    let texts = [
        ("file:///work/a.mech", examples[seed as usize % examples.len()].1.replace('\n', "\r\n")),
        ("file:///work/other.mech", examples[(seed as usize + 3) % examples.len()].1.clone()),
    ];
    for round in 0..rounds {
        for (uri, text) in &texts {
            if session.texts.contains_key(*uri) {
                session.close(uri);
            }
            session.open(uri, text);
        }
        for _ in 0..12 {
            let uri = texts[session.random.below(2)].0;
            session.change_at_random(uri);
            session.ask_at_random(uri);
        }
        session.expect_answers();
        if round % 4 == 3 {
            session.expect_fresh();
        }
    }
    session.end();
}

#[test]
fn random_edits_keep_other_answers() {
    for seed in 1..5 {
        edit_at_random(seed, 4);
    }
}

#[test]
#[ignore = "it takes minutes"]
fn many_random_edits_keep_other_answers() {
    for seed in 100..200 {
        edit_at_random(seed, 12);
    }
}

#[test]
fn used_files_may_vanish_and_return() {
    const PART: &str = "mechanism arm {\n body bar at (0, 0, 0) { point P = (0, 0) }\n}\n";
    let main = "use \"part.mech\"\nmechanism m {\n part a: arm()\n}\n";
    let mut session = Session::new(7);
    session.put("/work/part.mech", Some(PART));
    session.open("file:///work/main.mech", main);
    session.expect_fresh();
    session.put("/work/part.mech", None);
    session.expect_fresh();
    session.open("file:///work/part.mech", &PART.replace("arm", "leg"));
    session.expect_fresh();
    session.change("file:///work/part.mech", [(0, 10), (0, 13)], "arm");
    session.expect_fresh();
    // it is renamed under the editor, which goes on with its text
    session.put("/work/renamed.mech", Some(PART));
    session.close("file:///work/part.mech");
    session.expect_fresh();
    session.change("file:///work/main.mech", [(0, 5), (0, 9)], "renamed");
    session.expect_fresh();
    session.put("/work/renamed.mech", Some("no mechanism"));
    session.expect_fresh();
    session.end();
}

#[test]
fn requests_on_closed_texts_are_answered() {
    let (uri, text) = &examples()[0];
    let mut session = Session::new(3);
    for _ in 0..20 {
        session.open(uri, text);
        let id = session.client.send_request("textDocument/diagnostic", json!({ "textDocument": { "uri": uri } }));
        session.asked.push((id, "textDocument/diagnostic"));
        session.close(uri);
    }
    let begin = Instant::now();
    session.end();
    assert!(begin.elapsed() < PATIENCE);
}
