//! The server: connections on this machine's own addresses, each with a thread, and no more of them than a few pages have.

use super::asked::{Question, Write as Written, place_of};
use super::guard::{Call, Ours, admitted};
use super::http::{Connection, Fault, Kind, Patient, head_of};
use super::workshop::Workshop;
use mechc_draw::view::page as html;
use mechc_text::cancel::Cancel;
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// So many connections are open at once at the most, of all pages together.
const MOST_CONNECTIONS: usize = 64;
/// So many of them are told of new versions.
const MOST_LISTENERS: usize = 24;
/// So often a page that has nothing to be told is told that: who does not hear it any more is gone.
const PULSE: Duration = Duration::from_secs(2);
/// Who takes nothing for so long is gone.
const SENDING: Duration = Duration::from_secs(10);
/// Who waits for an answer is looked at so often, whether it is still there.
const LOOK: Duration = Duration::from_millis(100);
/// Where no port is asked for, so many are tried for one that is free in both families of addresses.
const MOST_PORTS: usize = 16;
/// Bytes of randomness in a token.
const TOKEN: usize = 24;

/// Listens, and answers nobody yet.
pub struct Server {
    listeners: Vec<TcpListener>,
    ours: Ours,
}

/// A server that answers until it is dropped.
pub struct Serving {
    addresses: Vec<SocketAddr>,
    has_ended: Arc<AtomicBool>,
    has_been_seen: Arc<AtomicBool>,
    url: String,
}

impl Server {
    /// Listens at a port of `127.0.0.1` and of `::1`, where the machine has that; 0 is any that is free.
    ///
    /// # Errors
    /// Somebody else listens there, or there is no randomness.
    pub fn bind(port: u16) -> io::Result<Server> {
        let mut random = [0; TOKEN];
        getrandom::fill(&mut random).map_err(|why| io::Error::other(why.to_string()))?;
        let mut token = String::new();
        for byte in random {
            token += &format!("{byte:02x}");
        }
        let mut tries = 0;
        loop {
            tries += 1;
            let first = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            let found = first.local_addr()?.port();
            let second = match TcpListener::bind((Ipv6Addr::LOCALHOST, found)) {
                Ok(second) => Some(second),
                // another program must not answer there in our name
                Err(error) if error.kind() == io::ErrorKind::AddrInUse && port == 0 && tries < MOST_PORTS => continue,
                Err(error) if error.kind() == io::ErrorKind::AddrInUse => return Err(error),
                // not every machine has these addresses
                Err(_) => None,
            };
            let listeners = std::iter::once(first).chain(second).collect();
            let ours = Ours { port: found, token: token.clone() };
            return Ok(Server { listeners, ours });
        }
    }

    /// The port.
    #[must_use]
    pub fn port(&self) -> u16 {
        self.ours.port
    }

    /// Answers what pages ask of a workshop, in threads of its own.
    ///
    /// # Errors
    /// There are no threads.
    pub fn serve(self, workshop: &Arc<Workshop>) -> io::Result<Serving> {
        let Server { listeners, ours } = self;
        let url = format!("http://127.0.0.1:{}/#{}", ours.port, ours.token);
        let addresses = listeners.iter().map(TcpListener::local_addr).collect::<io::Result<_>>()?;
        let (has_ended, has_been_seen): (Arc<AtomicBool>, Arc<AtomicBool>) = Default::default();
        let shared = Arc::new(Shared {
            workshop: Arc::clone(workshop),
            ours,
            has_ended: Arc::clone(&has_ended),
            has_been_seen: Arc::clone(&has_been_seen),
            open: Arc::default(),
            listening: Arc::default(),
        });
        for listener in listeners {
            let shared = Arc::clone(&shared);
            thread::Builder::new().name("live page".to_owned()).spawn(move || accept(&listener, &shared))?;
        }
        Ok(Serving { addresses, has_ended, has_been_seen, url })
    }
}

impl Serving {
    /// The address of the page, with the token behind `#`.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Whether somebody has come to see the page, from now on.
    #[must_use]
    pub fn seen(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.has_been_seen)
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Release);
        for address in &self.addresses {
            // who waits for a connection looks up
            let _ = TcpStream::connect_timeout(address, Duration::from_millis(100));
        }
    }
}

struct Shared {
    workshop: Arc<Workshop>,
    ours: Ours,
    has_ended: Arc<AtomicBool>,
    has_been_seen: Arc<AtomicBool>,
    open: Arc<AtomicUsize>,
    listening: Arc<AtomicUsize>,
}

/// One of some places, which is free again when this is dropped.
struct Place(Arc<AtomicUsize>);

impl Place {
    fn take(of: &Arc<AtomicUsize>, most: usize) -> Option<Place> {
        let place = Place(Arc::clone(of));
        (of.fetch_add(1, Ordering::AcqRel) < most).then_some(place)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    loop {
        let connection = listener.accept();
        if shared.has_ended.load(Ordering::Acquire) {
            return;
        }
        let Ok((stream, _)) = connection else {
            // too many files are open, say: others may close theirs
            thread::sleep(Duration::from_millis(20));
            continue;
        };
        // who comes when all places are taken is sent away by the connection being closed
        let Some(place) = Place::take(&shared.open, MOST_CONNECTIONS) else { continue };
        let shared = Arc::clone(shared);
        let answer = move || {
            let _place = place;
            attend(stream, &shared);
        };
        let _ = thread::Builder::new().name("live connection".to_owned()).spawn(answer);
    }
}

impl Patient for TcpStream {
    fn wait_at_most(&mut self, time: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(time))
    }
}

/// Answers one request after the other.
fn attend(stream: TcpStream, shared: &Shared) {
    if stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(SENDING))).is_err() {
        return;
    }
    let mut connection = Connection::new(stream);
    loop {
        match answered(&mut connection, shared) {
            Ok(true) => {}
            Ok(false) | Err(Fault::Gone) => break,
            Err(Fault::Refused(status)) => {
                let _ = connection.stream().write_all(head_of(status, Kind::Lines, Some(0), false).as_bytes());
                break;
            }
        }
    }
    leave(connection.stream());
}

/// Closes a connection so that what was sent arrives, also where something was never read.
fn leave(stream: &mut TcpStream) {
    let _ = stream.shutdown(Shutdown::Write);
    let _ = stream.set_read_timeout(Some(Duration::from_millis(100)));
    let mut rest = [0; 4096];
    for _ in 0..16 {
        if !stream.read(&mut rest).is_ok_and(|count| count > 0) {
            break;
        }
    }
}

/// Answers a request; says whether the connection stays.
fn answered(connection: &mut Connection<TcpStream>, shared: &Shared) -> Result<bool, Fault> {
    let (head, until) = connection.head()?;
    // nothing of a body is read before it is known whose it is
    let call = admitted(&head, &shared.ours).map_err(Fault::Refused)?;
    let body = connection.body(&head, until)?;
    let workshop = &shared.workshop;
    let (kind, bytes) = match call {
        Call::Page => {
            shared.has_been_seen.store(true, Ordering::Release);
            (Kind::Html, html::shell().into_bytes())
        }
        Call::Events => {
            tell(connection.stream(), shared)?;
            return Ok(false);
        }
        Call::Motion => {
            let question = Question::of(&body).map_err(|_| Fault::Refused(400))?;
            (Kind::Bytes, while_there(connection.stream(), |cancel| workshop.answer(&question, cancel)))
        }
        Call::Show => {
            workshop.show(place_of(&body).map_err(|_| Fault::Refused(400))?);
            (Kind::Json, b"{}".to_vec())
        }
        Call::Write => {
            let write = Written::of(&body).map_err(|_| Fault::Refused(400))?;
            (Kind::Json, workshop.write(&write).to_string().into_bytes())
        }
    };
    let stream = connection.stream();
    stream.write_all(head_of(200, kind, Some(bytes.len()), head.keeps).as_bytes())?;
    stream.write_all(&bytes)?;
    Ok(head.keeps)
}

/// Works for who waits at the other end of a connection; if nobody does any more, the work is cancelled.
fn while_there<T>(stream: &TcpStream, work: impl FnOnce(&Cancel) -> T) -> T {
    let cancel = Cancel::default();
    let (ends, has_ended) = channel::<()>();
    let gone = cancel.clone();
    thread::scope(|scope| {
        let watch = move || {
            while has_ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if is_gone(stream) {
                    gone.cancel();
                }
            }
        };
        // without it the work is only not cancelled
        let _ = thread::Builder::new().name("live watch".to_owned()).spawn_scoped(scope, watch);
        let made = work(&cancel);
        drop(ends);
        made
    })
}

/// Whether a connection has been closed at its other end. Nobody else reads or writes meanwhile.
fn is_gone(stream: &TcpStream) -> bool {
    let looked = stream.set_nonblocking(true).and_then(|()| stream.peek(&mut [0]));
    let is_gone = match looked {
        Ok(count) => count == 0,
        Err(error) => error.kind() != io::ErrorKind::WouldBlock,
    };
    // where it cannot be as it was, it is of no use
    stream.set_nonblocking(false).is_err() || is_gone
}

/// Tells a page of every version of the texts, until it goes.
fn tell(stream: &mut TcpStream, shared: &Shared) -> Result<(), Fault> {
    let _place = Place::take(&shared.listening, MOST_LISTENERS).ok_or(Fault::Refused(503))?;
    stream.write_all(head_of(200, Kind::Lines, None, false).as_bytes())?;
    let mut told = None;
    while !shared.has_ended.load(Ordering::Acquire) {
        let news = shared.workshop.news(told.as_ref(), PULSE);
        let line = match &news {
            Some(news) => news.told().to_string(),
            None => String::new(),
        };
        stream.write_all(format!("{line}\n").as_bytes())?;
        told = news.or(told);
    }
    Ok(())
}
