//! The server: connections on this machine's loopback addresses, each with its thread, limited to what a few pages need.

use super::auth::{Endpoint, ServerIdentity, authorize};
use super::http::{Connection, ContentType, Fault, TimedStream, response_head};
use super::requests::{MotionRequest, WriteRequest, parse_position};
use super::session::LiveSession;
use mechc_draw::view::page as html;
use mechc_text::cancel::Cancel;
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// The maximum number of open connections, of all pages together.
const MAX_CONNECTIONS: usize = 64;
/// The maximum number of connections that receive events.
const MAX_LISTENERS: usize = 24;
/// The interval of empty lines in a stream of events; a page that has closed the connection is noticed by them.
const HEARTBEAT: Duration = Duration::from_secs(2);
/// The time after which a client that reads nothing is disconnected.
const SEND_TIMEOUT: Duration = Duration::from_secs(10);
/// The interval of checks whether a client still waits for its response.
const DISCONNECT_CHECK: Duration = Duration::from_millis(100);
/// The number of ports to try for one that is free in both address families, unless a port is given.
const MAX_PORT_TRIES: usize = 16;
/// Bytes of randomness in a token.
const TOKEN_BYTES: usize = 24;

/// A server that listens and does not answer yet.
pub struct Server {
    listeners: Vec<TcpListener>,
    identity: ServerIdentity,
}

/// A server that answers until it is dropped.
pub struct RunningServer {
    addresses: Vec<SocketAddr>,
    has_ended: Arc<AtomicBool>,
    page_requested: Arc<AtomicBool>,
    url: String,
}

impl Server {
    /// Listens at a port of `127.0.0.1`, and of `::1` if the machine has it; 0 chooses a free port.
    ///
    /// # Errors
    /// The port is in use, or there is no source of randomness.
    pub fn bind(port: u16) -> io::Result<Server> {
        let mut random = [0; TOKEN_BYTES];
        getrandom::fill(&mut random).map_err(|why| io::Error::other(why.to_string()))?;
        let mut token = String::new();
        for byte in random {
            token += &format!("{byte:02x}");
        }
        let mut tries = 0;
        loop {
            tries += 1;
            let first = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            let free_port = first.local_addr()?.port();
            let second = match TcpListener::bind((Ipv6Addr::LOCALHOST, free_port)) {
                Ok(second) => Some(second),
                // another program must not answer at `localhost` in this server's place
                Err(error) if error.kind() == io::ErrorKind::AddrInUse && port == 0 && tries < MAX_PORT_TRIES => {
                    continue;
                }
                Err(error) if error.kind() == io::ErrorKind::AddrInUse => return Err(error),
                // not every machine has these addresses
                Err(_) => None,
            };
            let listeners = std::iter::once(first).chain(second).collect();
            let identity = ServerIdentity { port: free_port, token: token.clone() };
            return Ok(Server { listeners, identity });
        }
    }

    /// Returns the port.
    #[must_use]
    pub fn port(&self) -> u16 {
        self.identity.port
    }

    /// Answers the requests of pages from a session, on threads of its own.
    ///
    /// # Errors
    /// A thread cannot be started.
    pub fn serve(self, session: &Arc<LiveSession>) -> io::Result<RunningServer> {
        let Server { listeners, identity } = self;
        let url = format!("http://127.0.0.1:{}/#{}", identity.port, identity.token);
        let addresses = listeners.iter().map(TcpListener::local_addr).collect::<io::Result<_>>()?;
        let (has_ended, page_requested): (Arc<AtomicBool>, Arc<AtomicBool>) = Default::default();
        let shared = Arc::new(ServerState {
            session: Arc::clone(session),
            identity,
            has_ended: Arc::clone(&has_ended),
            page_requested: Arc::clone(&page_requested),
            open: Arc::default(),
            listening: Arc::default(),
        });
        for listener in listeners {
            let shared = Arc::clone(&shared);
            thread::Builder::new().name("live page".to_owned()).spawn(move || accept(&listener, &shared))?;
        }
        Ok(RunningServer { addresses, has_ended, page_requested, url })
    }
}

impl RunningServer {
    /// Returns the address of the page, with the token after `#`.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Returns a flag that is set once the page has been requested.
    #[must_use]
    pub fn page_requested(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.page_requested)
    }
}

impl Drop for RunningServer {
    fn drop(&mut self) {
        self.has_ended.store(true, Ordering::Release);
        for address in &self.addresses {
            // a connection wakes the thread that waits for one
            let _ = TcpStream::connect_timeout(address, Duration::from_millis(100));
        }
    }
}

struct ServerState {
    session: Arc<LiveSession>,
    identity: ServerIdentity,
    has_ended: Arc<AtomicBool>,
    page_requested: Arc<AtomicBool>,
    open: Arc<AtomicUsize>,
    listening: Arc<AtomicUsize>,
}

/// A slot of a limited number; dropping it frees the slot.
struct Slot(Arc<AtomicUsize>);

impl Slot {
    fn take(count: &Arc<AtomicUsize>, max: usize) -> Option<Slot> {
        let slot = Slot(Arc::clone(count));
        (count.fetch_add(1, Ordering::AcqRel) < max).then_some(slot)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

fn accept(listener: &TcpListener, shared: &Arc<ServerState>) {
    loop {
        let connection = listener.accept();
        if shared.has_ended.load(Ordering::Acquire) {
            return;
        }
        let Ok((stream, _)) = connection else {
            // the cause may be temporary, as when too many files are open
            thread::sleep(Duration::from_millis(20));
            continue;
        };
        // when all slots are taken, the connection is closed by dropping it
        let Some(slot) = Slot::take(&shared.open, MAX_CONNECTIONS) else { continue };
        let shared = Arc::clone(shared);
        let answer = move || {
            let _slot = slot;
            handle_connection(stream, &shared);
        };
        let _ = thread::Builder::new().name("live connection".to_owned()).spawn(answer);
    }
}

impl TimedStream for TcpStream {
    fn limit_reads(&mut self, time: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(time))
    }
}

/// Answers the requests of a connection, one after the other.
fn handle_connection(stream: TcpStream, shared: &ServerState) {
    if stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(SEND_TIMEOUT))).is_err() {
        return;
    }
    let mut connection = Connection::new(stream);
    loop {
        match handle_request(&mut connection, shared) {
            Ok(true) => {}
            Ok(false) | Err(Fault::Closed) => break,
            Err(Fault::Refused(status)) => {
                let _ =
                    connection.stream().write_all(response_head(status, ContentType::Lines, Some(0), false).as_bytes());
                break;
            }
        }
    }
    close(connection.stream());
}

/// Closes a connection so that the response arrives even if a part of the request was never read.
fn close(stream: &mut TcpStream) {
    let _ = stream.shutdown(Shutdown::Write);
    let _ = stream.set_read_timeout(Some(Duration::from_millis(100)));
    let mut rest = [0; 4096];
    for _ in 0..16 {
        if !stream.read(&mut rest).is_ok_and(|count| count > 0) {
            break;
        }
    }
}

/// Answers a request; returns whether the connection stays open.
fn handle_request(connection: &mut Connection<TcpStream>, shared: &ServerState) -> Result<bool, Fault> {
    let (head, until) = connection.head()?;
    // a body is read only once its request is authorized
    let endpoint = authorize(&head, &shared.identity).map_err(Fault::Refused)?;
    let body = connection.body(&head, until)?;
    let session = &shared.session;
    let (kind, bytes) = match endpoint {
        Endpoint::Page => {
            shared.page_requested.store(true, Ordering::Release);
            (ContentType::Html, html::shell().into_bytes())
        }
        Endpoint::Events => {
            stream_events(connection.stream(), shared)?;
            return Ok(false);
        }
        Endpoint::Motion => {
            let request = MotionRequest::parse(&body).map_err(|_| Fault::Refused(400))?;
            (ContentType::Bytes, while_connected(connection.stream(), |cancel| session.answer(&request, cancel)))
        }
        Endpoint::Show => {
            session.show(parse_position(&body).map_err(|_| Fault::Refused(400))?);
            (ContentType::Json, b"{}".to_vec())
        }
        Endpoint::Write => {
            let write = WriteRequest::parse(&body).map_err(|_| Fault::Refused(400))?;
            (ContentType::Json, session.write(&write).to_string().into_bytes())
        }
    };
    let stream = connection.stream();
    stream.write_all(response_head(200, kind, Some(bytes.len()), head.keep_alive).as_bytes())?;
    stream.write_all(&bytes)?;
    Ok(head.keep_alive)
}

/// Runs work for a client, and cancels it if the client closes the connection.
fn while_connected<T>(stream: &TcpStream, work: impl FnOnce(&Cancel) -> T) -> T {
    let cancel = Cancel::default();
    let (ends, has_ended) = channel::<()>();
    let disconnected = cancel.clone();
    thread::scope(|scope| {
        let watch = move || {
            while has_ended.recv_timeout(DISCONNECT_CHECK) == Err(RecvTimeoutError::Timeout) {
                if is_closed(stream) {
                    disconnected.cancel();
                }
            }
        };
        // without this thread the work runs to its end
        let _ = thread::Builder::new().name("live watch".to_owned()).spawn_scoped(scope, watch);
        let result = work(&cancel);
        drop(ends);
        result
    })
}

/// Returns whether the client has closed a connection. No other thread may read or write it meanwhile.
fn is_closed(stream: &TcpStream) -> bool {
    let peeked = stream.set_nonblocking(true).and_then(|()| stream.peek(&mut [0]));
    let is_closed = match peeked {
        Ok(count) => count == 0,
        Err(error) => error.kind() != io::ErrorKind::WouldBlock,
    };
    // a connection that cannot be made blocking again is of no use
    stream.set_nonblocking(false).is_err() || is_closed
}

/// Sends a page a line of JSON for every new version of the texts, until the page disconnects.
fn stream_events(stream: &mut TcpStream, shared: &ServerState) -> Result<(), Fault> {
    let _slot = Slot::take(&shared.listening, MAX_LISTENERS).ok_or(Fault::Refused(503))?;
    stream.write_all(response_head(200, ContentType::Lines, None, false).as_bytes())?;
    let mut last = None;
    while !shared.has_ended.load(Ordering::Acquire) {
        let status = shared.session.wait_for_change(last.as_ref(), HEARTBEAT);
        let line = match &status {
            Some(status) => status.to_json().to_string(),
            None => String::new(),
        };
        stream.write_all(format!("{line}\n").as_bytes())?;
        last = status.or(last);
    }
    Ok(())
}
