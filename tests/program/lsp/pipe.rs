//! The server as an editor starts it: a process of its own, with messages over its standard input and output.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

/// What has not come by then does not come at all.
const PATIENCE: Duration = Duration::from_secs(60);

pub struct Pipe {
    child: Child,
    input: Option<ChildStdin>,
    /// With the moment at which each was there.
    messages: Receiver<(Instant, Value)>,
    next_id: i64,
}

impl Pipe {
    /// A server, with an editor that asks for diagnostics and counts in UTF-16.
    pub fn open(binary: &Path) -> Pipe {
        Pipe::open_with(binary, &[])
    }

    /// The same with options.
    pub fn open_with(binary: &Path, options: &[&str]) -> Pipe {
        let mut command = Command::new(binary);
        let mut child =
            command.arg("lsp").args(options).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
        let (sender, messages) = mpsc::channel();
        let mut output = BufReader::new(child.stdout.take().expect("it is piped"));
        thread::spawn(move || {
            while let Some(message) = read(&mut output) {
                if sender.send((Instant::now(), message)).is_err() {
                    return;
                }
            }
        });
        let input = child.stdin.take();
        let mut pipe = Pipe { child, input, messages, next_id: 0 };
        let capabilities = json!({
            "textDocument": { "diagnostic": {} },
            "workspace": { "diagnostics": { "refreshSupport": true } },
        });
        pipe.request("initialize", &json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        pipe.notify("initialized", &json!({}));
        pipe
    }

    /// The number of its process.
    #[allow(dead_code)] // not every one who uses it looks at its memory
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        let input = self.input.as_mut().expect("it is open");
        write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).expect("it reads");
        input.flush().expect("it reads");
    }

    pub fn notify(&mut self, method: &str, params: &Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The answer to a request, and when it was there; what else comes before is passed over.
    pub fn request(&mut self, method: &str, params: &Value) -> (Instant, Value) {
        self.next_id += 1;
        let id = self.next_id;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        let (at, answer) = self.wait_for(|message| message["id"] == id && message.get("method").is_none());
        (at, answer["result"].clone())
    }

    /// The next message of some kind, and when it was there; the server's own requests are answered.
    pub fn wait_for(&mut self, is_it: impl Fn(&Value) -> bool) -> (Instant, Value) {
        loop {
            let (at, message) = self.messages.recv_timeout(PATIENCE).expect("a message in time");
            if message.get("method").is_some() && message.get("id").is_some() {
                self.send(&json!({ "jsonrpc": "2.0", "id": message["id"], "result": null }));
            }
            if is_it(&message) {
                return (at, message);
            }
        }
    }

    /// What has come up to now.
    #[allow(dead_code)] // not every one who uses it needs silence
    pub fn pass_over(&mut self) {
        while let Ok((_, message)) = self.messages.try_recv() {
            if message.get("method").is_some() && message.get("id").is_some() {
                self.send(&json!({ "jsonrpc": "2.0", "id": message["id"], "result": null }));
            }
        }
    }

    /// Ends it as the protocol says; whether it ended well.
    pub fn end(mut self) -> bool {
        self.request("shutdown", &Value::Null);
        self.notify("exit", &Value::Null);
        self.child.wait().expect("it ends").success()
    }

    /// Closes its input, as an editor does that dies; whether it ended well.
    #[allow(dead_code)] // not every one who uses it dies
    pub fn vanish(mut self) -> bool {
        self.input = None;
        self.child.wait().expect("it ends").success()
    }
}

fn read(output: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        if line.trim().is_empty() {
            break;
        }
        if let Some(value) = line.strip_prefix("Content-Length: ") {
            length = value.trim().parse().ok()?;
        }
    }
    let mut bytes = vec![0; length];
    output.read_exact(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}
