//! The loop: messages and what the pool has done, one after the other. It alone owns what changes.

mod notifications;
mod publish_diagnostics;
mod scheduling;

use self::notifications::position;
use super::handlers::{Failure, Method, TABLE};
use super::capabilities::{self, Client};
use super::convert::{self, ProtocolContext};
use super::documents::{Document, Documents};
use super::log::Log;
use super::parent::Parent;
use super::pool::{Pool, caught};
use super::published::{StageResult, PublishedDiagnostics};
use super::live_pages::{Event, PageId, LivePages, WriteOutcome};
use crate::{DiagnosticStage, Snapshot};
use crossbeam_channel::{Receiver, Sender, select, unbounded};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError};
use mechc_text::cancel::Cancel;
use mechc_text::world::World;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A motion is followed for so long at most; of what comes later nothing is said.
const MOTION_LIMIT: Duration = Duration::from_secs(10);

/// The request for diagnostics, which may have to wait for them.
pub(super) const PULL: &str = "textDocument/diagnostic";

/// The requests of live pages: their address for a browser, or the page for a panel; what a panel asks and writes.
pub(super) const VIEWS: [&str; 4] = ["mechc/view", "mechc/view/panel", "mechc/view/ask", "mechc/view/write"];

/// A motion is followed once nobody has typed for so long: what has begun does not end at once, and takes from the next keystroke's words.
const MOTION_DELAY: Duration = Duration::from_millis(250);

/// How often it is looked whether a motion takes too long.
const TICK: Duration = Duration::from_millis(200);

/// How long nothing at all is done where nobody says anything.
const IDLE: Duration = Duration::from_secs(3600);

/// How a session came to its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ended {
    /// As the protocol says.
    Well,
    /// The client was gone before it had said so.
    Early,
    /// The client's process is gone, though its end of the pipe is not.
    Left,
    /// There was no session: nobody spoke the protocol.
    Unbegun,
}

/// Serves a client until that says that it is enough, or is gone.
#[must_use]
pub fn serve(connection: Connection, world: Arc<dyn World>, log: Log) -> Ended {
    let Connection { sender, receiver } = connection;
    let (done, tasks) = unbounded();
    let snapshot = Snapshot::new(world);
    let (tell, events) = unbounded();
    let views = LivePages::new(snapshot.buffers().clone(), tell);
    let mut server = Server {
        client: Client::of(&Value::Null),
        state: State::New,
        sender,
        done,
        pool: Pool::new(),
        log,
        documents: Documents::default(),
        snapshot,
        shown: BTreeMap::new(),
        edited: None,
        revision: 0,
        motions: Vec::new(),
        search: Cancel::default(),
        due: Vec::new(),
        views,
        pending: HashMap::new(),
        pulls: Vec::new(),
        next_id: 0,
        folders: Vec::new(),
        edits: HashMap::new(),
        parent: None,
    };
    server.run(&receiver, &tasks, &events)
}

/// How far a session has come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    New,
    Running,
    ShutDown,
}

/// What the pool has done.
enum Task {
    Answered(RequestId, Result<Value, Failure>),
    /// What a live page asked for is known.
    Viewed(RequestId, Result<Value, String>),
    /// The files of the client's folders.
    Files(Vec<Arc<Path>>),
    /// A motion of a revision is begun, with what ends it.
    Began(u64, Cancel),
    StageResult {
        path: Arc<Path>,
        revision: u64,
        stage: DiagnosticStage,
        found: Result<Option<StageResult>, String>,
        took: Duration,
    },
}

/// A request that is being answered.
struct Pending {
    method: &'static Method,
    /// For those that are begun again.
    params: Value,
}

/// A request for diagnostics that waits for the words of the text as it is.
struct Pull {
    id: RequestId,
    path: Arc<Path>,
    /// What the client has.
    known: Option<String>,
}

pub(super) struct Server {
    pub(super) client: Client,
    state: State,
    sender: Sender<Message>,
    done: Sender<Task>,
    pool: Pool,
    log: Log,
    pub(super) documents: Documents,
    snapshot: Snapshot,
    shown: BTreeMap<Arc<Path>, PublishedDiagnostics>,
    /// The text that was opened or edited last.
    edited: Option<Arc<Path>>,
    /// Counts the changes of the snapshot.
    revision: u64,
    /// The motions that are being followed, and until when.
    motions: Vec<(Cancel, Instant)>,
    /// Ends the search for files.
    search: Cancel,
    /// Those that are to be followed, and from when on.
    due: Vec<(Arc<Path>, Instant)>,
    pending: HashMap<RequestId, Pending>,
    pulls: Vec<Pull>,
    /// The live pages.
    views: LivePages,
    /// Of the server's own requests.
    next_id: i32,
    /// What the client has open.
    folders: Vec<PathBuf>,
    /// The edits that the client has not yet answered, and who waits for that.
    pub(super) edits: HashMap<RequestId, Sender<WriteOutcome>>,
    /// The process of the client, where that is the one that began this one.
    parent: Option<Parent>,
}

impl Server {
    fn run(&mut self, receiver: &Receiver<Message>, tasks: &Receiver<Task>, events: &Receiver<Event>) -> Ended {
        loop {
            select! {
                recv(receiver) -> message => match message {
                    Err(_) => return self.ended_early(),
                    Ok(message) => {
                        self.log.message('<', &message);
                        match message {
                            Message::Request(request) => self.request(request),
                            Message::Response(response) => self.edited(response),
                            Message::Notification(notification) if notification.method == "exit" => {
                                return if self.state == State::ShutDown { Ended::Well } else { self.ended_early() };
                            }
                            Message::Notification(notification) => self.notification(notification),
                        }
                    }
                },
                recv(tasks) -> task => task.map_or((), |task| self.task(task)),
                recv(events) -> event => event.map_or((), |event| self.event(event)),
                default(self.patience()) => {}
            }
            if self.parent.as_ref().is_some_and(Parent::is_gone) {
                return Ended::Left;
            }
            self.end_long_motions();
            self.begin_due_motions();
        }
    }

    fn ended_early(&self) -> Ended {
        if self.state == State::New { Ended::Unbegun } else { Ended::Early }
    }

    fn send(&self, message: impl Into<Message>) {
        let message = message.into();
        self.log.message('>', &message);
        // a client that is gone is seen by the next message that it does not send
        let _ = self.sender.send(message);
    }

    fn answer(&self, id: RequestId, result: Value) {
        self.send(Response { id, response_result: Ok(result) });
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, message: &str) {
        let error = ResponseError { code: code as i32, message: message.to_owned(), data: None };
        self.send(Response { id, response_result: Err(error) });
    }

    fn request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        match (self.state, method.as_str()) {
            (State::New, "initialize") => {
                self.client = Client::of(&params);
                self.folders = capabilities::folders(&params);
                self.parent = Parent::of(&params);
                self.state = State::Running;
                self.answer(id, capabilities::of_server(&self.client));
            }
            (State::New, _) => self.refuse(id, ErrorCode::ServerNotInitialized, "the first request is `initialize`"),
            (State::Running, "initialize") => self.refuse(id, ErrorCode::InvalidRequest, "it is initialized already"),
            (State::Running, "shutdown") => {
                self.state = State::ShutDown;
                self.end_work();
                self.answer_pulls(None);
                self.answer(id, Value::Null);
            }
            (State::Running, PULL) => self.pull(id, &params),
            (State::Running, name) if VIEWS.contains(&name) => self.view(id, name, &params),
            (State::Running, name) => match TABLE.iter().find(|method| method.name == name) {
                Some(method) => self.begin(id, method, params),
                None => self.refuse(id, ErrorCode::MethodNotFound, &format!("there is no method `{name}`")),
            },
            (State::ShutDown, _) => self.refuse(id, ErrorCode::InvalidRequest, "it is shut down"),
        }
    }

    /// A request of a live page.
    fn view(&mut self, id: RequestId, name: &str, params: &Value) {
        let Some(uri) = params.pointer("/textDocument/uri").and_then(Value::as_str) else {
            self.refuse(id, ErrorCode::InvalidParams, "it names no text");
            return;
        };
        let mechanism = params.get("mechanism").and_then(Value::as_str).map(str::to_owned);
        let meant = PageId { path: self.file_of(uri), uri: uri.to_owned(), mechanism };
        let done = self.done.clone();
        let answer = {
            let id = id.clone();
            move |answer| {
                let _ = done.send(Task::Viewed(id, answer));
            }
        };
        match name {
            "mechc/view/panel" => {
                let panel = self.views.panel(meant);
                self.answer(id, panel);
            }
            "mechc/view/ask" => self.views.ask(meant, &params["asked"], answer),
            "mechc/view/write" => self.views.write(meant, &params["asked"], answer),
            _ => answer(self.views.address(meant)),
        }
    }

    /// The cursor of the client is elsewhere.
    fn pointed(&mut self, params: &Value) -> Option<()> {
        let path = self.file_of(params.get("textDocument")?.get("uri")?.as_str()?);
        let document = self.documents.get(&path)?;
        let at = document.offset(position(params.get("position")?)?, self.client.encoding) as usize;
        let before = document.text().get(..at)?;
        self.views.point(&path, before.encode_utf16().count() as u32);
        Some(())
    }

    /// A panel is closed.
    fn left(&mut self, params: &Value) -> Option<()> {
        let path = self.file_of(params.pointer("/textDocument/uri")?.as_str()?);
        self.views.leave(&path, params.get("mechanism").and_then(Value::as_str));
        Some(())
    }

    /// The text of a file: what the client has open, or what is on the disk.
    pub(super) fn text_of(&self, path: &Path) -> Option<Document> {
        if let Some(document) = self.documents.get(path) {
            return Some(Document::clone(document));
        }
        let contents = self.snapshot.buffers().read(path).ok()?;
        Some(Document::new(super::uri::uri_of(path), 0, std::str::from_utf8(&contents.bytes).ok()?))
    }

    /// Has the client show a place of a file (UTF-16).
    fn show(&mut self, path: &Path, at: u32) {
        let Some(document) = &self.text_of(path) else { return };
        let mut left = at as usize;
        let letters = document.text().chars().take_while(|c| {
            let is_before = left > 0;
            left = left.saturating_sub(c.len_utf16());
            is_before
        });
        let position = self.range_end(document, letters.map(char::len_utf8).sum::<usize>() as u32);
        let uri = document.uri.clone();
        let selection = json!({ "start": position, "end": position });
        self.ask_with("window/showDocument", json!({ "uri": uri, "takeFocus": false, "selection": selection }));
    }

    pub(super) fn range_end(&self, document: &Document, at: u32) -> Value {
        let (line, character) = document.position(at, self.client.encoding);
        json!({ "line": line, "character": character })
    }

    /// Hands a request to the pool.
    fn begin(&mut self, id: RequestId, method: &'static Method, params: Value) {
        let kept = if method.is_retried { params.clone() } else { Value::Null };
        self.pending.insert(id.clone(), Pending { method, params: kept });
        let (context, done) = (self.context(), self.done.clone());
        self.pool.begin(method.kind, move || {
            let answer = caught(|| (method.answer)(&context, params)).unwrap_or_else(|why| Err(Failure::Panicked(why)));
            // the server may have ended
            let _ = done.send(Task::Answered(id, answer));
        });
    }

    fn context(&self) -> ProtocolContext {
        let encoding = self.client.encoding;
        let (snapshot, documents) = (self.snapshot.clone(), self.documents.clone());
        ProtocolContext { snapshot, documents, encoding, client: self.client.clone(), closed: Arc::default() }
    }

    /// The file of a URI.
    fn file_of(&self, uri: &str) -> Arc<Path> {
        convert::file_of(uri, &self.documents, &self.snapshot)
    }

    fn task(&mut self, task: Task) {
        match task {
            Task::Answered(id, answer) => self.answered(id, answer),
            Task::Viewed(id, Ok(answer)) => self.answer(id, answer),
            Task::Viewed(id, Err(why)) => self.refuse(id, ErrorCode::RequestFailed, &why),
            Task::Files(files) => {
                self.log.did(|| format!("{} files are in the folders", files.len()));
                self.snapshot = self.snapshot.with_files(files);
            }
            Task::Began(revision, motion) if revision == self.revision => {
                self.motions.push((motion, Instant::now() + MOTION_LIMIT));
            }
            Task::Began(_, motion) => motion.cancel(),
            Task::StageResult { path, revision, stage, found, took } => {
                if revision == self.revision && self.state == State::Running {
                    self.log.did(|| format!("{stage:?} of {} took {:.3} ms", path.display(), took.as_secs_f64() * 1e3));
                    self.take(&path, stage, found);
                }
            }
        }
    }

    /// What a live page has for the client.
    fn event(&mut self, event: Event) {
        match event {
            Event::Tell(method, params) => self.send(Notification { method: method.to_owned(), params }),
            Event::Write(writing) => self.write(writing),
            Event::Show(path, at) => self.show(&path, at),
        }
    }

    fn answered(&mut self, id: RequestId, answer: Result<Value, Failure>) {
        let Some(Pending { method, params }) = self.pending.remove(&id) else { return };
        match answer {
            Ok(answer) => self.answer(id, answer),
            Err(Failure::Modified) if method.is_retried && self.state == State::Running => {
                self.begin(id, method, params);
            }
            Err(Failure::Modified) => self.refuse(id, ErrorCode::ContentModified, "the text was changed"),
            Err(Failure::Params(why)) => self.refuse(id, ErrorCode::InvalidParams, &why),
            Err(Failure::Refused(why)) => self.refuse(id, ErrorCode::RequestFailed, &why),
            Err(Failure::Panicked(why)) => {
                self.log.did(|| format!("`{}` panicked: {why}", method.name));
                self.refuse(id, ErrorCode::InternalError, &format!("`{}` failed: {why}", method.name));
            }
        }
    }

    /// A request of the server, whose answer says nothing.
    fn ask(&mut self, method: &str) {
        self.ask_with(method, Value::Null);
    }

    pub(super) fn ask_with(&mut self, method: &str, params: Value) -> RequestId {
        self.next_id += 1;
        let id = RequestId::from(self.next_id);
        self.send(Request { id: id.clone(), method: method.to_owned(), params });
        id
    }
}
