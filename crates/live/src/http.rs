//! HTTP requests and responses as bytes on a connection. A client that sends too much, or too slowly, is disconnected.

use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

/// The maximum length of a head (bytes).
const MAX_HEAD: usize = 16 << 10;
/// The maximum number of headers.
const MAX_HEADERS: usize = 64;
/// The maximum length of a body (bytes).
const MAX_BODY: usize = 1 << 20;
/// The time within which a request must arrive, from its first byte.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// The time that a connection may wait for its next request.
const IDLE_TIMEOUT: Duration = Duration::from_secs(30);

/// The request line and headers of a request.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Head {
    /// The method, as it is written.
    pub method: String,
    /// The target, as it is written.
    pub target: String,
    /// Headers, with names in lower case.
    pub headers: Vec<(String, String)>,
    /// The length of the body (bytes).
    pub length: usize,
    /// True if the connection stays open after the response.
    pub keep_alive: bool,
}

/// The reason why a request cannot be read.
#[derive(Debug)]
pub(super) enum Fault {
    /// The client gets a response with this status.
    Refused(u16),
    /// The client has closed the connection.
    Closed,
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Fault {
        match error.kind() {
            io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => Fault::Refused(408),
            _ => Fault::Closed,
        }
    }
}

/// A stream whose reads can be limited in time.
pub(super) trait TimedStream: Read + Write {
    /// Makes reads fail after this time.
    fn limit_reads(&mut self, time: Duration) -> io::Result<()>;
}

/// A connection, with the bytes that were read and not used yet.
pub(super) struct Connection<S> {
    stream: S,
    buffer: Vec<u8>,
}

impl<S: TimedStream> Connection<S> {
    pub fn new(stream: S) -> Connection<S> {
        Connection { stream, buffer: Vec::new() }
    }

    pub fn stream(&mut self) -> &mut S {
        &mut self.stream
    }

    /// Reads the head of the next request; returns it with the instant by which the whole request must arrive.
    pub fn head(&mut self) -> Result<(Head, Instant), Fault> {
        let mut until = Instant::now() + if self.buffer.is_empty() { IDLE_TIMEOUT } else { REQUEST_TIMEOUT };
        let mut has_begun = !self.buffer.is_empty();
        loop {
            if let Some((head, used)) = parse_head(&self.buffer)? {
                self.buffer.drain(..used);
                return Ok((head, until));
            }
            if self.buffer.len() >= MAX_HEAD {
                return Err(Fault::Refused(431));
            }
            match self.fill(until, MAX_HEAD) {
                // a client that has sent nothing waits for no response
                Err(Fault::Refused(408)) if !has_begun => return Err(Fault::Closed),
                other => other?,
            }
            if !has_begun {
                (has_begun, until) = (true, Instant::now() + REQUEST_TIMEOUT);
            }
        }
    }

    /// Reads the body of a request whose head was read.
    pub fn body(&mut self, head: &Head, until: Instant) -> Result<Vec<u8>, Fault> {
        if head.length > MAX_BODY {
            return Err(Fault::Refused(413));
        }
        while self.buffer.len() < head.length {
            self.fill(until, head.length)?;
        }
        let rest = self.buffer.split_off(head.length);
        Ok(std::mem::replace(&mut self.buffer, rest))
    }

    /// Reads more bytes into the buffer, up to `max` in all.
    fn fill(&mut self, until: Instant, max: usize) -> Result<(), Fault> {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(Fault::Refused(408));
        }
        self.stream.limit_reads(left)?;
        let mut buffer = [0; 4096];
        let size = buffer.len().min(max.saturating_sub(self.buffer.len()).max(1));
        match self.stream.read(&mut buffer[..size])? {
            0 => Err(Fault::Closed),
            count => {
                self.buffer.extend(&buffer[..count]);
                Ok(())
            }
        }
    }
}

/// Parses a complete head; returns it with its length. An incomplete head gives `None`.
fn parse_head(bytes: &[u8]) -> Result<Option<(Head, usize)>, Fault> {
    let mut raw_headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut request = httparse::Request::new(&mut raw_headers);
    let used = match request.parse(bytes) {
        Ok(httparse::Status::Complete(used)) => used,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(Fault::Refused(431)),
        Err(_) => return Err(Fault::Refused(400)),
    };
    let bad = || Fault::Refused(400);
    let (method, target) = (request.method.ok_or_else(bad)?.to_owned(), request.path.ok_or_else(bad)?.to_owned());
    let mut headers = Vec::with_capacity(request.headers.len());
    for header in request.headers.iter() {
        let value = std::str::from_utf8(header.value).map_err(|_| bad())?;
        headers.push((header.name.to_ascii_lowercase(), value.to_owned()));
    }
    let all = |name: &str| -> Vec<&str> {
        headers.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str()).collect()
    };
    // the end of a body must be unambiguous, or two requests could be confused
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
    let keep_alive = request.version == Some(1) && !closes;
    Ok(Some((Head { method, target, headers, length, keep_alive }, used)))
}

/// Headers of every response: nothing is cached, sniffed, framed or shared with other origins.
const SECURITY_HEADERS: &str = "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
    Content-Security-Policy: frame-ancestors 'none'\r\nX-Frame-Options: DENY\r\nCross-Origin-Opener-Policy: same-origin\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\n";

/// The content of a response.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum ContentType {
    Html,
    Json,
    Bytes,
    Lines,
}

impl ContentType {
    fn media_type(self) -> &'static str {
        match self {
            ContentType::Html => "text/html; charset=utf-8",
            ContentType::Json => "application/json",
            ContentType::Bytes => "application/octet-stream",
            ContentType::Lines => "text/plain; charset=utf-8",
        }
    }
}

/// Formats the head of a response; without a length the response ends with the connection.
pub(super) fn response_head(status: u16, content: ContentType, length: Option<usize>, keep_alive: bool) -> String {
    let length = length.map_or_else(String::new, |length| format!("Content-Length: {length}\r\n"));
    let connection = if keep_alive { "keep-alive" } else { "close" };
    let (reason, content) = (reason(status), content.media_type());
    format!(
        "HTTP/1.1 {status} {reason}\r\nContent-Type: {content}\r\n{length}Connection: {connection}\r\n{SECURITY_HEADERS}\r\n"
    )
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
    use super::{Connection, Fault, Head, MAX_BODY, MAX_HEAD, TimedStream, response_head};
    use std::io::{self, Cursor, Read, Write};
    use std::time::Duration;

    /// A client that sends at most a number of bytes at a time, and then nothing more.
    struct Client(Cursor<Vec<u8>>, usize);

    impl Read for Client {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let most = buffer.len().min(self.1);
            match self.0.read(&mut buffer[..most])? {
                0 => Err(io::ErrorKind::WouldBlock.into()),
                count => Ok(count),
            }
        }
    }

    impl Write for Client {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl TimedStream for Client {
        fn limit_reads(&mut self, _: Duration) -> io::Result<()> {
            Ok(())
        }
    }

    fn connection(sent: impl Into<Vec<u8>>, at_a_time: usize) -> Connection<Client> {
        Connection::new(Client(Cursor::new(sent.into()), at_a_time))
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
            assert_eq!((second.target.as_str(), second.headers[0].0.as_str(), second.keep_alive), ("/", "host", true));
        }
    }

    #[test]
    fn invalid_requests_are_refused() {
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
    fn long_requests_are_refused_unread() {
        assert_eq!(refused(&format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(MAX_HEAD))), Some(431));
        assert_eq!(refused(&format!("GET / HTTP/1.1\r\n{}", "a: b\r\n".repeat(100))), Some(431));
        let sent = format!("POST / HTTP/1.1\r\nContent-Length: {}\r\n\r\n", MAX_BODY + 1);
        let mut connection = connection(sent, 100);
        let (head, until) = connection.head().expect("a head");
        assert!(matches!(connection.body(&head, until), Err(Fault::Refused(413))));
    }

    #[test]
    fn an_incomplete_request_times_out() {
        assert!(matches!(head(""), Err(Fault::Closed)));
        assert_eq!(refused("GET / HTTP/1.1\r\nHost: a\r\n"), Some(408));
        let mut connection = connection("POST / HTTP/1.1\r\nContent-Length: 5\r\n\r\nabc", 100);
        let (head, until) = connection.head().expect("a head");
        assert!(matches!(connection.body(&head, until), Err(Fault::Refused(408))));
    }

    #[test]
    fn every_response_has_the_security_headers() {
        for status in [200, 403, 404, 503] {
            let head = response_head(status, super::ContentType::Html, Some(0), false);
            for header in [
                "Referrer-Policy: no-referrer",
                "X-Content-Type-Options: nosniff",
                "frame-ancestors 'none'",
                "no-store",
            ] {
                assert!(head.contains(header), "{head}");
            }
            assert!(!head.to_lowercase().contains("access-control"), "{head}");
        }
    }
}
