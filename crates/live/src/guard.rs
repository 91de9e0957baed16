//! Who may ask, and what: a function of a request's head.
//!
//! Anybody on the machine, and every page of every site that its user looks at, can reach the port. So a request must be meant for this
//! server by its `Host` (a name of another site may lead here), and whatever tells or writes something must come from a page of this
//! server (`Origin`) that has the token. The token is in the fragment of the address, which no browser sends anywhere.

use super::http::Head;
use std::hint::black_box;

/// What tells this server from others.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ours {
    /// The port that it listens at.
    pub port: u16,
    /// What only its own pages know.
    pub token: String,
}

/// What is asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Call {
    /// The page, which holds nothing of the text.
    Page,
    /// To be told whenever there is another version of the texts.
    Events,
    /// A motion, or a position by hand.
    Motion,
    /// To write values into the file.
    Write,
    /// To show a place of the file in the editor.
    Show,
}

/// The header with the token.
const TOKEN: &str = "x-mechc-token";

/// What a request asks for, or the status with which it is refused.
pub(super) fn admitted(head: &Head, ours: &Ours) -> Result<Call, u16> {
    let host = only(head, "host").filter(|host| names(ours.port).any(|name| name == *host)).ok_or(403_u16)?;
    let path = head.target.split_once('?').map_or(head.target.as_str(), |(path, _)| path);
    let call = match path {
        "/" => Call::Page,
        "/events" => Call::Events,
        "/motion" => Call::Motion,
        "/write" => Call::Write,
        "/show" => Call::Show,
        _ => return Err(404),
    };
    match (call, head.method.as_str()) {
        (Call::Page, "GET") => return Ok(Call::Page),
        (Call::Events | Call::Motion | Call::Write | Call::Show, "POST") => {}
        _ => return Err(405),
    }
    let is_of_our_page = only(head, "origin").is_some_and(|origin| origin.strip_prefix("http://") == Some(host));
    let has_token = only(head, TOKEN).is_some_and(|token| is_the_same(token.as_bytes(), ours.token.as_bytes()));
    if is_of_our_page && has_token { Ok(call) } else { Err(403) }
}

/// The port that addresses leave out.
const USUAL: u16 = 80;

/// What the server is called.
fn names(port: u16) -> impl Iterator<Item = String> {
    let named = move |name| [Some(format!("{name}:{port}")), (port == USUAL).then(|| str::to_owned(name))];
    ["127.0.0.1", "[::1]", "localhost"].into_iter().flat_map(named).flatten()
}

/// The value of a header that is there once.
fn only<'h>(head: &'h Head, name: &str) -> Option<&'h str> {
    let mut values = head.headers.iter().filter(|(other, _)| other == name).map(|(_, value)| value.as_str());
    values.next().filter(|_| values.next().is_none())
}

/// In a time that does not tell how much of it is right.
fn is_the_same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |apart, (a, b)| black_box(apart | (a ^ b))) == 0
}

#[cfg(test)]
mod tests {
    use super::{Call, Ours, admitted};
    use crate::http::Head;

    const TOKEN: &str = "0123456789abcdef";

    fn head(method: &str, target: &str, headers: &[(&str, &str)]) -> Head {
        let headers = headers.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        Head { method: method.to_owned(), target: target.to_owned(), headers, length: 0, keeps: true }
    }

    fn asked(method: &str, target: &str, headers: &[(&str, &str)]) -> Result<Call, u16> {
        admitted(&head(method, target, headers), &Ours { port: 4321, token: TOKEN.to_owned() })
    }

    const OURS: [(&str, &str); 3] =
        [("host", "127.0.0.1:4321"), ("origin", "http://127.0.0.1:4321"), ("x-mechc-token", TOKEN)];

    #[test]
    fn our_own_page_gets_what_it_asks_for() {
        assert_eq!(asked("GET", "/", &OURS[..1]), Ok(Call::Page));
        assert_eq!(asked("GET", "/?vscode=1", &OURS[..1]), Ok(Call::Page));
        assert_eq!(asked("POST", "/events", &OURS), Ok(Call::Events));
        assert_eq!(asked("POST", "/motion", &OURS), Ok(Call::Motion));
        assert_eq!(asked("POST", "/write", &OURS), Ok(Call::Write));
        assert_eq!(asked("POST", "/show", &OURS), Ok(Call::Show));
        for host in ["localhost:4321", "[::1]:4321"] {
            let origin = format!("http://{host}");
            let headers = [("host", host), ("origin", &origin), ("x-mechc-token", TOKEN)];
            assert_eq!(asked("POST", "/motion", &headers), Ok(Call::Motion));
        }
    }

    #[test]
    fn the_usual_port_is_left_out_of_addresses() {
        let at = |port, host: &str| {
            let origin = format!("http://{host}");
            let headers = [("host", host), ("origin", origin.as_str()), ("x-mechc-token", TOKEN)];
            admitted(&head("POST", "/motion", &headers), &Ours { port, token: TOKEN.to_owned() })
        };
        for host in ["127.0.0.1", "[::1]", "localhost", "127.0.0.1:80"] {
            assert_eq!(at(80, host), Ok(Call::Motion), "{host}");
        }
        for host in ["127.0.0.1:8080", "evil.example", "evil.example:80", ""] {
            assert_eq!(at(80, host), Err(403), "{host}");
        }
        assert_eq!(at(8080, "127.0.0.1"), Err(403));
    }

    #[test]
    fn what_is_meant_for_another_host_is_refused() {
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
            assert_eq!(asked("GET", "/", &[("host", host)]), Err(403), "{host}");
            let headers = [("host", host), OURS[1], OURS[2]];
            assert_eq!(asked("POST", "/motion", &headers), Err(403), "{host}");
        }
        assert_eq!(asked("GET", "/", &[]), Err(403));
        assert_eq!(asked("GET", "/", &[OURS[0], ("host", "evil.example")]), Err(403), "two hosts");
        assert_eq!(asked("GET", "/", &[OURS[0], OURS[0]]), Err(403), "two hosts");
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
                let headers = [OURS[0], ("origin", origin), OURS[2]];
                assert_eq!(asked("POST", path, &headers), Err(403), "{path} {origin}");
            }
            assert_eq!(asked("POST", path, &[OURS[0], OURS[2]]), Err(403), "without an origin");
            assert_eq!(asked("POST", path, &[OURS[0], OURS[1], OURS[1], OURS[2]]), Err(403), "two origins");
        }
    }

    #[test]
    fn without_the_token_nothing_is_told_and_nothing_written() {
        for path in ["/events", "/motion", "/write", "/show"] {
            assert_eq!(asked("POST", path, &OURS[..2]), Err(403));
            for token in ["", "0123456789abcdee", "0123456789abcde", "0123456789abcdef0", "0123456789ABCDEF"] {
                let headers = [OURS[0], OURS[1], ("x-mechc-token", token)];
                assert_eq!(asked("POST", path, &headers), Err(403), "{token}");
            }
            let in_the_address = format!("{path}?x-mechc-token={TOKEN}");
            assert_eq!(asked("POST", &in_the_address, &OURS[..2]), Err(403));
        }
    }

    #[test]
    fn there_is_nothing_else() {
        for path in ["/..", "/../etc/passwd", "/%2e%2e/", "//", "/events/", "/lever.mech", "*", "http://127.0.0.1/", ""]
        {
            assert_eq!(asked("GET", path, &OURS), Err(404), "{path}");
            assert_eq!(asked("POST", path, &OURS), Err(404), "{path}");
        }
        for method in ["GET", "HEAD", "OPTIONS", "PUT", "DELETE", "post", "CONNECT"] {
            assert_eq!(asked(method, "/write", &OURS), Err(405), "{method}");
        }
        assert_eq!(asked("POST", "/", &OURS), Err(405));
    }
}
