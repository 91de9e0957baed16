//! How long an editor waits for the language server: a typed session, at the pipe of the binary. See `docs/speed.md`.

#![allow(clippy::expect_used, clippy::panic)] // a benchmark that cannot run says so by panicking

#[path = "../../tests/program/lsp/pipe.rs"]
mod pipe;

use pipe::Pipe;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[path = "../steps/copies.rs"]
mod copies;

const URI: &str = "file:///bench/four_bars.mech";

/// Keystrokes, or requests, of each kind.
const TIMES: usize = 100;

/// From one keystroke to the next: that is typed fast.
const PAUSE: Duration = Duration::from_millis(100);

/// Longer than any stage takes.
const REST: Duration = Duration::from_millis(300);

fn main() {
    // `cargo bench` adds an argument of its own
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let sizes: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let binary = arguments.iter().find(|argument| argument.parse::<usize>().is_err()).map(PathBuf::from);
    let binary = binary.unwrap_or_else(|| PathBuf::from(env!("CARGO_BIN_EXE_mechc")));
    println!("{:<52} {:>9} {:>9} {:>9}", "milliseconds", "median", "95 %", "longest");
    for bodies in if sizes.is_empty() { vec![20, 2000] } else { sizes } {
        let mut session = Session::open(&binary, bodies);
        session.print_all(bodies);
        assert!(session.pipe.end(), "it ends as the protocol says");
    }
}

struct Session {
    pipe: Pipe,
    text: String,
    version: usize,
    /// Whether anything but `null` is known of a method's answer.
    completes: bool,
}

impl Session {
    fn open(binary: &std::path::Path, bodies: usize) -> Session {
        let mut pipe = Pipe::open(binary);
        // at least so many
        let text = copies::four_bars(bodies.div_ceil(3));
        let document = json!({ "uri": URI, "languageId": "mech", "version": 1, "text": text });
        pipe.notify("textDocument/didOpen", &json!({ "textDocument": document }));
        let mut session = Session { pipe, text, version: 1, completes: false };
        assert_eq!(session.pull().1["items"], json!([]), "it is without fault");
        let place = session.place(session.text.len() / 2);
        session.completes = !session.pipe.request("textDocument/completion", &place).1.is_null();
        session
    }

    fn print_all(&mut self, bodies: usize) {
        let label = |what: &str| format!("{bodies:>5} bodies: {what}");
        self.print(&label("keystroke to words, right"), |session, k| session.type_number(k, "1"));
        self.print(&label("keystroke to words, wrong"), |session, k| session.type_number(k, "("));
        self.print(&label("keystroke to proof, proven"), |session, k| session.toggle_driver(k).1);
        self.print(&label("keystroke to proof, refused"), |session, k| session.toggle_driver(k).0);
        self.print(&label("hover, at rest"), |session, k| session.ask("textDocument/hover", k));
        self.print(&label("hover, right behind a keystroke"), |session, k| {
            session.type_silently(k);
            session.ask("textDocument/hover", k)
        });
        if self.completes {
            self.print(&label("completion, at rest"), |session, k| session.ask("textDocument/completion", k));
            self.print(&label("completion, right behind a keystroke"), |session, k| {
                session.type_silently(k);
                session.ask("textDocument/completion", k)
            });
        }
    }

    fn print(&mut self, what: &str, mut step: impl FnMut(&mut Session, usize) -> Duration) {
        std::thread::sleep(REST);
        self.pipe.pass_over();
        let mut times: Vec<f64> = Vec::with_capacity(TIMES);
        for k in 0..TIMES {
            std::thread::sleep(PAUSE);
            times.push(step(self, k).as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        let at = |percent: usize| times[(times.len() - 1) * percent / 100];
        println!("{what:<52} {:9.3} {:9.3} {:9.3}", at(50), at(95), at(100));
    }

    /// Where the words of some mechanism stand in the text.
    fn find(&self, k: usize, words: &str) -> usize {
        let from = self.text.len() / TIMES * k;
        let found = self.text[from..].find(words).map(|at| from + at);
        found.or_else(|| self.text.rfind(words)).expect("it is there")
    }

    /// What names a place, for requests.
    fn place(&self, at: usize) -> Value {
        json!({ "textDocument": { "uri": URI }, "position": self.position(at) })
    }

    fn position(&self, at: usize) -> Value {
        let before = &self.text[..at];
        let line = before.matches('\n').count();
        json!({ "line": line, "character": at - before.rfind('\n').map_or(0, |end| end + 1) })
    }

    /// Writes something in the place of a stretch; gives the moment before.
    fn edit(&mut self, at: usize, length: usize, new: &str) -> Instant {
        self.version += 1;
        let change = json!({ "range": { "start": self.position(at), "end": self.position(at + length) }, "text": new });
        self.text.replace_range(at..at + length, new);
        let document = json!({ "uri": URI, "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        let begin = Instant::now();
        self.pipe.notify("textDocument/didChange", &params);
        begin
    }

    /// Asks what is wrong, which is answered as soon as the words are known.
    fn pull(&mut self) -> (Instant, Value) {
        self.pipe.request("textDocument/diagnostic", &json!({ "textDocument": { "uri": URI } }))
    }

    /// Types a character into a number, sees what is wrong, and takes it back.
    fn type_number(&mut self, k: usize, typed: &str) -> Duration {
        let at = self.find(k, " = 0.5 + ") + " = 0.5".len();
        let begin = self.edit(at, 0, typed);
        let (end, report) = self.pull();
        assert_eq!(report["items"].as_array().map(Vec::is_empty), Some(typed == "1"), "{report}");
        std::thread::sleep(PAUSE);
        self.edit(at, typed.len(), "");
        self.pull();
        end - begin
    }

    /// Types a digit into a formula and takes it back, without waiting.
    fn type_silently(&mut self, k: usize) {
        let at = self.find(k, " = 0.5") + " = 0.5".len();
        let is_typed = self.text[at..].starts_with('1');
        self.edit(at, usize::from(is_typed), if is_typed { "" } else { "1" });
    }

    /// Makes a driver a comment, and a driver again; until it is told that a degree of freedom is left, and until that is gone.
    fn toggle_driver(&mut self, k: usize) -> (Duration, Duration) {
        let at = self.find(k, "driver motor");
        let refused = self.until_refresh(at, 0, "//", 1);
        std::thread::sleep(PAUSE);
        let proven = self.until_refresh(at, 2, "", 0);
        (refused, proven)
    }

    fn until_refresh(&mut self, at: usize, length: usize, new: &str, faults: usize) -> Duration {
        let begin = self.edit(at, length, new);
        let (end, _) = self.pipe.wait_for(|message| message["method"] == "workspace/diagnostic/refresh");
        let (_, report) = self.pull();
        assert_eq!(report["items"].as_array().map(Vec::len), Some(faults), "{report}");
        end - begin
    }

    fn ask(&mut self, method: &str, k: usize) -> Duration {
        let place = self.place(self.find(k, "revolute(crank") + "revolute(cr".len());
        let begin = Instant::now();
        let (end, answer) = self.pipe.request(method, &place);
        assert!(!answer.is_null(), "{method} knows nothing");
        end - begin
    }
}
