//! Requests and responses, as bytes on a connection. Whoever sends too much, or too slowly, is sent away.

use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

/// No head is longer (bytes).
const LONGEST_HEAD: usize = 16 << 10;
/// Nor has more headers.
const MOST_HEADERS: usize = 64;
/// No body is longer (bytes).
const LONGEST_BODY: usize = 1 << 20;
/// A request that has begun is there within this time.
const PATIENCE: Duration = Duration::from_secs(5);
/// So long a connection may wait for its next request.
const IDLE: Duration = Duration::from_secs(30);

/// The first lines of a request.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Head {
    /// As it is written.
    pub method: String,
    /// As it is written.
    pub target: String,
    /// Names in small letters.
    pub headers: Vec<(String, String)>,
    /// Of the body (bytes).
    pub length: usize,
    /// Whether the connection is to stay.
    pub keeps: bool,
}

/// Why there is no request.
#[derive(Debug)]
pub(super) enum Fault {
    /// It is told so, with this status.
    Refused(u16),
    /// There is nobody to tell.
    Gone,
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Fault {
        match error.kind() {
            io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => Fault::Refused(408),
            _ => Fault::Gone,
        }
    }
}

/// What can be waited for so long and no longer.
pub(super) trait Patient: Read + Write {
    /// Reading ends with an error after this time.
    fn wait_at_most(&mut self, time: Duration) -> io::Result<()>;
}

/// A connection, with what has been read of it and not been used.
pub(super) struct Connection<S> {
    stream: S,
    read: Vec<u8>,
}

impl<S: Patient> Connection<S> {
    pub fn new(stream: S) -> Connection<S> {
        Connection { stream, read: Vec::new() }
    }

    pub fn stream(&mut self) -> &mut S {
        &mut self.stream
    }

    /// The head of the next request. The time for it begins with its first byte.
    pub fn head(&mut self) -> Result<(Head, Instant), Fault> {
        let mut until = Instant::now() + if self.read.is_empty() { IDLE } else { PATIENCE };
        let mut has_begun = !self.read.is_empty();
        loop {
            if let Some((head, used)) = parsed(&self.read)? {
                self.read.drain(..used);
                return Ok((head, until));
            }
            if self.read.len() >= LONGEST_HEAD {
                return Err(Fault::Refused(431));
            }
            match self.more(until, LONGEST_HEAD) {
                // nobody waits for an answer to nothing
                Err(Fault::Refused(408)) if !has_begun => return Err(Fault::Gone),
                other => other?,
            }
            if !has_begun {
                (has_begun, until) = (true, Instant::now() + PATIENCE);
            }
        }
    }

    /// The body of a request whose head was read.
    pub fn body(&mut self, head: &Head, until: Instant) -> Result<Vec<u8>, Fault> {
        if head.length > LONGEST_BODY {
            return Err(Fault::Refused(413));
        }
        while self.read.len() < head.length {
            self.more(until, head.length)?;
        }
        let rest = self.read.split_off(head.length);
        Ok(std::mem::replace(&mut self.read, rest))
    }

    /// Reads on, up to so many bytes in all.
    fn more(&mut self, until: Instant, most: usize) -> Result<(), Fault> {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(Fault::Refused(408));
        }
        self.stream.wait_at_most(left)?;
        let mut buffer = [0; 4096];
        let wanted = buffer.len().min(most.saturating_sub(self.read.len()).max(1));
        match self.stream.read(&mut buffer[..wanted])? {
            0 => Err(Fault::Gone),
            count => {
                self.read.extend(&buffer[..count]);
                Ok(())
            }
        }
    }
}

/// A head that is whole, and how long it is.
fn parsed(bytes: &[u8]) -> Result<Option<(Head, usize)>, Fault> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    let used = match request.parse(bytes) {
        Ok(httparse::Status::Complete(used)) => used,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(Fault::Refused(431)),
        Err(_) => return Err(Fault::Refused(400)),
    };
    let bad = || Fault::Refused(400);
    let (method, target) = (request.method.ok_or_else(bad)?.to_owned(), request.path.ok_or_else(bad)?.to_owned());
    let mut read = Vec::with_capacity(request.headers.len());
    for header in request.headers.iter() {
        let value = std::str::from_utf8(header.value).map_err(|_| bad())?;
        read.push((header.name.to_ascii_lowercase(), value.to_owned()));
    }
    let all = |name: &str| -> Vec<&str> {
        read.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str()).collect()
    };
    // where a body ends must be beyond doubt
    if !all("transfer-encoding").is_empty() {
        return Err(Fault::Refused(501));
    }
    let length = match all("content-length").as_slice() {
        [] => 0,
        [text] if !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit()) => {
            text.parse().map_err(|_| Fault::Refused(413))?
        }
        _ => return Err(bad()),
    };
    let closes = all("connection").iter().any(|value| value.eq_ignore_ascii_case("close"));
    let keeps = request.version == Some(1) && !closes;
    Ok(Some((Head { method, target, headers: read, length, keeps }, used)))
}

/// What every response says: nothing is kept, guessed, framed or told to others.
const ALWAYS: &str = "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
    Content-Security-Policy: frame-ancestors 'none'\r\nX-Frame-Options: DENY\r\nCross-Origin-Opener-Policy: same-origin\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\n";

/// What a response holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Html,
    Json,
    Bytes,
    Lines,
}

impl Kind {
    fn media_type(self) -> &'static str {
        match self {
            Kind::Html => "text/html; charset=utf-8",
            Kind::Json => "application/json",
            Kind::Bytes => "application/octet-stream",
            Kind::Lines => "text/plain; charset=utf-8",
        }
    }
}

/// The head of a response; without a length it ends with the connection.
pub(super) fn head_of(status: u16, kind: Kind, length: Option<usize>, keeps: bool) -> String {
    let length = length.map_or_else(String::new, |length| format!("Content-Length: {length}\r\n"));
    let stays = if keeps { "keep-alive" } else { "close" };
    let (reason, kind) = (reason(status), kind.media_type());
    format!("HTTP/1.1 {status} {reason}\r\nContent-Type: {kind}\r\n{length}Connection: {stays}\r\n{ALWAYS}\r\n")
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        501 => "Not Implemented",
        _ => "Service Unavailable",
    }
}

#[cfg(test)]
mod tests {
    use super::{Connection, Fault, Head, LONGEST_BODY, LONGEST_HEAD, Patient, head_of};
    use std::io::{self, Cursor, Read, Write};
    use std::time::Duration;

    /// What somebody sends, so many bytes at a time; then nothing more comes.
    struct Sent(Cursor<Vec<u8>>, usize);

    impl Read for Sent {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let most = buffer.len().min(self.1);
            match self.0.read(&mut buffer[..most])? {
                0 => Err(io::ErrorKind::WouldBlock.into()),
                count => Ok(count),
            }
        }
    }

    impl Write for Sent {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Patient for Sent {
        fn wait_at_most(&mut self, _: Duration) -> io::Result<()> {
            Ok(())
        }
    }

    fn connection(sent: impl Into<Vec<u8>>, at_a_time: usize) -> Connection<Sent> {
        Connection::new(Sent(Cursor::new(sent.into()), at_a_time))
    }

    fn head(sent: &str) -> Result<Head, Fault> {
        connection(sent, 7).head().map(|(head, _)| head)
    }

    fn refused(sent: &str) -> Option<u16> {
        match head(sent) {
            Err(Fault::Refused(status)) => Some(status),
            _ => None,
        }
    }

    #[test]
    fn requests_are_read_one_after_the_other() {
        let sent = "POST /motion HTTP/1.1\r\nHost: a\r\nContent-Length: 3\r\n\r\nabcGET / HTTP/1.1\r\nHOST: b\r\n\r\n";
        for at_a_time in [1, 2, 5, 1000] {
            let mut connection = connection(sent, at_a_time);
            let (first, until) = connection.head().expect("a head");
            assert_eq!((first.method.as_str(), first.target.as_str(), first.length), ("POST", "/motion", 3));
            assert_eq!(connection.body(&first, until).expect("a body"), b"abc");
            let (second, _) = connection.head().expect("a head");
            assert_eq!((second.target.as_str(), second.headers[0].0.as_str(), second.keeps), ("/", "host", true));
        }
    }

    #[test]
    fn what_is_no_request_is_refused() {
        assert_eq!(refused("\0\0\r\n\r\n"), Some(400));
        assert_eq!(refused("GET / HTTP/2\r\n\r\n"), Some(400));
        assert_eq!(refused("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), Some(501));
        for length in ["-1", "1, 1", "0x1", "+1", " ", "1\r\nContent-Length: 2"] {
            assert_eq!(refused(&format!("POST / HTTP/1.1\r\nContent-Length: {length}\r\n\r\n")), Some(400), "{length}");
        }
        let beyond = "POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n\r\n";
        assert_eq!(refused(beyond), Some(413));
    }

    #[test]
    fn what_is_too_long_is_refused_and_not_read_on() {
        assert_eq!(refused(&format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(LONGEST_HEAD))), Some(431));
        assert_eq!(refused(&format!("GET / HTTP/1.1\r\n{}", "a: b\r\n".repeat(100))), Some(431));
        let sent = format!("POST / HTTP/1.1\r\nContent-Length: {}\r\n\r\n", LONGEST_BODY + 1);
        let mut connection = connection(sent, 100);
        let (head, until) = connection.head().expect("a head");
        assert!(matches!(connection.body(&head, until), Err(Fault::Refused(413))));
    }

    #[test]
    fn who_sends_nothing_more_is_not_waited_for() {
        assert!(matches!(head(""), Err(Fault::Gone)));
        assert_eq!(refused("GET / HTTP/1.1\r\nHost: a\r\n"), Some(408));
        let mut connection = connection("POST / HTTP/1.1\r\nContent-Length: 5\r\n\r\nabc", 100);
        let (head, until) = connection.head().expect("a head");
        assert!(matches!(connection.body(&head, until), Err(Fault::Refused(408))));
    }

    #[test]
    fn every_response_is_for_its_page_alone() {
        for status in [200, 403, 404, 503] {
            let head = head_of(status, super::Kind::Html, Some(0), false);
            for wanted in [
                "Referrer-Policy: no-referrer",
                "X-Content-Type-Options: nosniff",
                "frame-ancestors 'none'",
                "no-store",
            ] {
                assert!(head.contains(wanted), "{head}");
            }
            assert!(!head.to_lowercase().contains("access-control"), "{head}");
        }
    }
}
