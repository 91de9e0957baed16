//! Transport of messages over standard input and output.
//!
//! An invalid message is answered with an error, as the protocol requires, and the next one is read.

use crossbeam_channel::{Receiver, Sender, unbounded};
use lsp_server::{Connection, ErrorCode, Message, Notification};
use serde_json::{Value, json};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::thread::{self, JoinHandle};

/// The internal method that stands for the error response to an invalid message, with `code`, `message` and the `id` if it has one.
const REFUSED: &str = "$/mechc/refused";

/// The maximum length of a message (bytes).
const MAX_MESSAGE: u64 = 1 << 30;

/// The thread that writes to the pipe.
pub(super) struct Transport {
    writer: JoinHandle<()>,
}

impl Transport {
    /// Waits until all messages are written.
    pub fn finish(self) {
        // a writer that panicked has nothing more to write
        let _ = self.writer.join();
    }
}

/// Opens a connection over standard input and output.
pub(super) fn standard() -> (Connection, Transport) {
    let (to_server, receiver) = unbounded();
    let (sender, to_client) = unbounded();
    let refuse = sender.clone();
    thread::spawn(move || {
        let input = BufReader::with_capacity(1 << 16, io::stdin());
        read_all(input, &to_server, |refused| drop(refuse.send(Message::Notification(refused))));
    });
    let writer = thread::spawn(move || write_all(&to_client, &mut io::stdout()));
    (Connection { sender, receiver }, Transport { writer })
}

/// Reads messages to the end of the input.
fn read_all(mut input: impl BufRead, to_server: &Sender<Message>, refuse: impl Fn(Notification)) {
    while let Ok(Some(frame)) = frame(&mut input) {
        match message(&frame) {
            Ok(message) => {
                let is_last = matches!(&message, Message::Notification(n) if n.method == "exit");
                if to_server.send(message).is_err() || is_last {
                    return;
                }
            }
            Err(refused) => refuse(refused),
        }
    }
}

/// Writes messages until the channel is closed or the output fails.
fn write_all(to_client: &Receiver<Message>, output: &mut impl Write) {
    for message in to_client {
        let written = match &message {
            Message::Notification(refused) if refused.method == REFUSED => write_refusal(&refused.params, output),
            message => message.write(output),
        };
        if written.is_err() {
            return;
        }
    }
}

fn write_refusal(refused: &Value, output: &mut impl Write) -> io::Result<()> {
    let error = json!({ "code": refused["code"], "message": refused["message"] });
    let text = json!({ "jsonrpc": "2.0", "id": refused["id"], "error": error }).to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

/// Reads the bytes of the next message; `None` at the end of the input.
///
/// # Errors
/// The input cannot be read, or a message has no valid length.
fn frame(input: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut length: Option<u64> = None;
    loop {
        let mut line = Vec::new();
        if input.by_ref().take(1 << 16).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim_end_matches(['\r', '\n']);
        if line.is_empty() && length.is_some() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok();
        }
    }
    let length = length.filter(|length| *length <= MAX_MESSAGE).ok_or(io::ErrorKind::InvalidData)?;
    let mut bytes = Vec::new();
    let read = input.take(length).read_to_end(&mut bytes)?;
    Ok((read as u64 == length).then_some(bytes))
}

/// Parses a message.
///
/// # Errors
/// The refusal to send if the bytes are not a valid message.
fn message(bytes: &[u8]) -> Result<Message, Notification> {
    let refused = |code: ErrorCode, why: &str, id: Value| Notification {
        method: REFUSED.to_owned(),
        params: json!({ "code": code as i32, "message": why, "id": id }),
    };
    match serde_json::from_slice(bytes) {
        // `lsp-server` parses a request with an invalid id as a notification
        Ok(Message::Notification(notification)) if bytes.windows(4).any(|four| four == br#""id""#) => {
            let id = serde_json::from_slice::<Value>(bytes).ok().and_then(|value| value.get("id").cloned());
            let why = "an id is a string or a whole number of 32 bits";
            id.map_or(Ok(Message::Notification(notification)), |id| Err(refused(ErrorCode::InvalidRequest, why, id)))
        }
        Ok(message) => Ok(message),
        Err(error) if serde_json::from_slice::<Value>(bytes).is_err() => {
            Err(refused(ErrorCode::ParseError, &error.to_string(), Value::Null))
        }
        Err(_) => Err(refused(ErrorCode::InvalidRequest, "it is neither a request nor an answer", Value::Null)),
    }
}

#[cfg(test)]
mod tests {
    use super::{read_all, write_all};
    use crossbeam_channel::unbounded;
    use lsp_server::Message;

    fn framed(texts: &[&str]) -> Vec<u8> {
        texts.iter().flat_map(|text| format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes()).collect()
    }

    /// Returns the methods of the messages that are read, and the text written back.
    fn read(input: &[u8]) -> (Vec<String>, String) {
        let (to_server, server) = unbounded();
        let (refuse, refused) = unbounded();
        read_all(input, &to_server, |message| refuse.send(Message::Notification(message)).expect("it is open"));
        drop((to_server, refuse));
        let method = |message: Message| match message {
            Message::Request(request) => request.method,
            Message::Notification(notification) => notification.method,
            Message::Response(_) => "an answer".to_owned(),
        };
        let mut written = Vec::new();
        write_all(&refused, &mut written);
        (server.iter().map(method).collect(), String::from_utf8(written).expect("a text"))
    }

    #[test]
    fn invalid_messages_are_refused_and_the_next_one_is_read() {
        let good = r#"{"jsonrpc":"2.0","id":1,"method":"shutdown"}"#;
        let (methods, written) = read(&framed(&["{\"jsonrpc\":", "[]", "{}", good]));
        assert_eq!(methods, ["shutdown"]);
        assert_eq!(written.matches("\"id\":null").count(), 3, "{written}");
        assert_eq!(written.matches("-32700").count(), 1, "{written}");
        assert_eq!(written.matches("-32600").count(), 2, "{written}");
    }

    #[test]
    fn a_request_with_a_bad_id_is_refused_by_that_id() {
        let big = r#"{"jsonrpc":"2.0","id":5000000000,"method":"shutdown"}"#;
        let in_text = r#"{"jsonrpc":"2.0","method":"a","params":{"id":1}}"#;
        let (methods, written) = read(&framed(&[big, in_text]));
        assert_eq!(methods, ["a"]);
        assert!(written.contains("\"id\":5000000000,\"error\""), "{written}");
    }

    #[test]
    fn reading_ends_with_the_input_or_exit() {
        let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
        assert_eq!(read(&framed(&[exit, exit])).0, ["exit"]);
        assert!(read(b"Content-Length: 100\r\n\r\n{}").0.is_empty());
        assert!(read(b"Content-Length: many\r\n\r\n{}").0.is_empty());
        assert!(read(b"").0.is_empty());
        let header = b"content-type: x\r\nCONTENT-LENGTH:33\r\n\r\n";
        assert_eq!(read(&[header, exit.as_bytes()].concat()).0, ["exit"]);
    }
}
