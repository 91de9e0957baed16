//! Authorization of requests: a function of a request's head.
//!
//! Every program on the machine, and every web page that its user opens, can reach the port. A request must therefore name this server in
//! `Host`, since another site's name may resolve to this address. A request that reads or writes data must also come from a page of this
//! server (`Origin`) that has the token. The token is in the fragment of the address, which browsers never send.

use super::http::Head;
use std::hint::black_box;

/// The port and token by which requests for this server are recognized.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ServerIdentity {
    /// The port that the server listens at.
    pub port: u16,
    /// The secret that only pages of this server have.
    pub token: String,
}

/// An endpoint of the server.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Endpoint {
    /// The page itself, which contains no data of the text.
    Page,
    /// A stream of notifications about new versions of the texts.
    Events,
    /// A motion, a preview or a position by hand.
    Motion,
    /// Writing values into the file.
    Write,
    /// Showing a position of the file in the editor.
    Show,
}

/// The header with the token.
const TOKEN: &str = "x-mechc-token";

/// Returns the endpoint that a request may use, or the status with which it is refused.
pub(super) fn authorize(head: &Head, server: &ServerIdentity) -> Result<Endpoint, u16> {
    let host =
        single_header(head, "host").filter(|host| host_names(server.port).any(|name| name == *host)).ok_or(403_u16)?;
    let path = head.target.split_once('?').map_or(head.target.as_str(), |(path, _)| path);
    let endpoint = match path {
        "/" => Endpoint::Page,
        "/events" => Endpoint::Events,
        "/motion" => Endpoint::Motion,
        "/write" => Endpoint::Write,
        "/show" => Endpoint::Show,
        _ => return Err(404),
    };
    match (endpoint, head.method.as_str()) {
        (Endpoint::Page, "GET") => return Ok(Endpoint::Page),
        (Endpoint::Events | Endpoint::Motion | Endpoint::Write | Endpoint::Show, "POST") => {}
        _ => return Err(405),
    }
    let has_our_origin =
        single_header(head, "origin").is_some_and(|origin| origin.strip_prefix("http://") == Some(host));
    let has_token = single_header(head, TOKEN).is_some_and(|token| is_equal(token.as_bytes(), server.token.as_bytes()));
    if has_our_origin && has_token { Ok(endpoint) } else { Err(403) }
}

/// The default port of HTTP, which addresses may leave out.
const DEFAULT_PORT: u16 = 80;

/// Returns the values of `Host` that name this server.
fn host_names(port: u16) -> impl Iterator<Item = String> {
    let named = move |name| [Some(format!("{name}:{port}")), (port == DEFAULT_PORT).then(|| str::to_owned(name))];
    ["127.0.0.1", "[::1]", "localhost"].into_iter().flat_map(named).flatten()
}

/// Returns the value of a header that occurs exactly once.
fn single_header<'h>(head: &'h Head, name: &str) -> Option<&'h str> {
    let mut values = head.headers.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str());
    values.next().filter(|_| values.next().is_none())
}

/// Compares in constant time, so that the duration does not reveal how many bytes are right.
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |difference, (a, b)| black_box(difference | (a ^ b))) == 0
}

#[cfg(test)]
mod tests {
    use super::{Endpoint, ServerIdentity, authorize};
    use crate::http::Head;

    const TOKEN: &str = "0123456789abcdef";

    fn head(method: &str, target: &str, headers: &[(&str, &str)]) -> Head {
        let headers = headers.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        Head { method: method.to_owned(), target: target.to_owned(), headers, length: 0, keep_alive: true }
    }

    fn send(method: &str, target: &str, headers: &[(&str, &str)]) -> Result<Endpoint, u16> {
        authorize(&head(method, target, headers), &ServerIdentity { port: 4321, token: TOKEN.to_owned() })
    }

    const VALID_HEADERS: [(&str, &str); 3] =
        [("host", "127.0.0.1:4321"), ("origin", "http://127.0.0.1:4321"), ("x-mechc-token", TOKEN)];

    #[test]
    fn the_servers_page_is_authorized() {
        assert_eq!(send("GET", "/", &VALID_HEADERS[..1]), Ok(Endpoint::Page));
        assert_eq!(send("GET", "/?vscode=1", &VALID_HEADERS[..1]), Ok(Endpoint::Page));
        assert_eq!(send("POST", "/events", &VALID_HEADERS), Ok(Endpoint::Events));
        assert_eq!(send("POST", "/motion", &VALID_HEADERS), Ok(Endpoint::Motion));
        assert_eq!(send("POST", "/write", &VALID_HEADERS), Ok(Endpoint::Write));
        assert_eq!(send("POST", "/show", &VALID_HEADERS), Ok(Endpoint::Show));
        for host in ["localhost:4321", "[::1]:4321"] {
            let origin = format!("http://{host}");
            let headers = [("host", host), ("origin", &origin), ("x-mechc-token", TOKEN)];
            assert_eq!(send("POST", "/motion", &headers), Ok(Endpoint::Motion));
        }
    }

    #[test]
    fn the_default_port_may_be_left_out() {
        let at = |port, host: &str| {
            let origin = format!("http://{host}");
            let headers = [("host", host), ("origin", origin.as_str()), ("x-mechc-token", TOKEN)];
            authorize(&head("POST", "/motion", &headers), &ServerIdentity { port, token: TOKEN.to_owned() })
        };
        for host in ["127.0.0.1", "[::1]", "localhost", "127.0.0.1:80"] {
            assert_eq!(at(80, host), Ok(Endpoint::Motion), "{host}");
        }
        for host in ["127.0.0.1:8080", "evil.example", "evil.example:80", ""] {
            assert_eq!(at(80, host), Err(403), "{host}");
        }
        assert_eq!(at(8080, "127.0.0.1"), Err(403));
    }

    #[test]
    fn requests_for_another_host_are_refused() {
        let elsewhere = [
            "",
            "evil.example",
            "evil.example:4321",
            "127.0.0.1",
            "127.0.0.1:4322",
            "localhost",
            "LOCALHOST.evil:4321",
            "127.0.0.1:4321.evil.example",
            "0.0.0.0:4321",
            "127.0.0.2:4321",
            " 127.0.0.1:4321",
            "127.0.0.1:4321/",
        ];
        for host in elsewhere {
            assert_eq!(send("GET", "/", &[("host", host)]), Err(403), "{host}");
            let headers = [("host", host), VALID_HEADERS[1], VALID_HEADERS[2]];
            assert_eq!(send("POST", "/motion", &headers), Err(403), "{host}");
        }
        assert_eq!(send("GET", "/", &[]), Err(403));
        assert_eq!(send("GET", "/", &[VALID_HEADERS[0], ("host", "evil.example")]), Err(403), "two hosts");
        assert_eq!(send("GET", "/", &[VALID_HEADERS[0], VALID_HEADERS[0]]), Err(403), "two hosts");
    }

    #[test]
    fn a_page_of_another_site_is_refused() {
        let others = [
            "",
            "null",
            "http://evil.example",
            "https://127.0.0.1:4321",
            "http://127.0.0.1",
            "http://127.0.0.1:4322",
            "http://localhost:4321",
            "http://127.0.0.1:4321/",
            "http://evil.example/http://127.0.0.1:4321",
        ];
        for path in ["/events", "/motion", "/write", "/show"] {
            for origin in others {
                let headers = [VALID_HEADERS[0], ("origin", origin), VALID_HEADERS[2]];
                assert_eq!(send("POST", path, &headers), Err(403), "{path} {origin}");
            }
            assert_eq!(send("POST", path, &[VALID_HEADERS[0], VALID_HEADERS[2]]), Err(403), "without an origin");
            assert_eq!(
                send("POST", path, &[VALID_HEADERS[0], VALID_HEADERS[1], VALID_HEADERS[1], VALID_HEADERS[2]]),
                Err(403),
                "two origins"
            );
        }
    }

    #[test]
    fn requests_without_the_token_are_refused() {
        for path in ["/events", "/motion", "/write", "/show"] {
            assert_eq!(send("POST", path, &VALID_HEADERS[..2]), Err(403));
            for token in ["", "0123456789abcdee", "0123456789abcde", "0123456789abcdef0", "0123456789ABCDEF"] {
                let headers = [VALID_HEADERS[0], VALID_HEADERS[1], ("x-mechc-token", token)];
                assert_eq!(send("POST", path, &headers), Err(403), "{token}");
            }
            let in_the_address = format!("{path}?x-mechc-token={TOKEN}");
            assert_eq!(send("POST", &in_the_address, &VALID_HEADERS[..2]), Err(403));
        }
    }

    #[test]
    fn other_paths_and_methods_are_refused() {
        for path in ["/..", "/../etc/passwd", "/%2e%2e/", "//", "/events/", "/lever.mech", "*", "http://127.0.0.1/", ""]
        {
            assert_eq!(send("GET", path, &VALID_HEADERS), Err(404), "{path}");
            assert_eq!(send("POST", path, &VALID_HEADERS), Err(404), "{path}");
        }
        for method in ["GET", "HEAD", "OPTIONS", "PUT", "DELETE", "post", "CONNECT"] {
            assert_eq!(send(method, "/write", &VALID_HEADERS), Err(405), "{method}");
        }
        assert_eq!(send("POST", "/", &VALID_HEADERS), Err(405));
    }
}
