//! The loop of the server: it handles messages and the results of the pool one after the other, and alone owns all mutable state.

mod notifications;
mod publish_diagnostics;
mod scheduling;

use self::notifications::position;
use super::capabilities::{self, Client};
use super::convert::{self, ProtocolContext};
use super::documents::{Document, Documents};
use super::handlers::{Failure, Method, TABLE};
use super::live_pages::{Event, LivePages, PageId, WriteOutcome};
use super::log::Log;
use super::parent::Parent;
use super::pool::{Pool, catch_panic};
use super::published::{PublishedDiagnostics, StageResult};
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

/// The time after which a motion is cancelled.
const MOTION_LIMIT: Duration = Duration::from_secs(10);

/// The request for diagnostics; its response may have to wait for a stage.
pub(super) const PULL: &str = "textDocument/diagnostic";

/// The requests of live pages: the address for a browser, the page for a panel, and the panel's requests for data and for writing.
pub(super) const LIVE_PAGE_METHODS: [&str; 4] =
    ["mechc/view", "mechc/view/panel", "mechc/view/ask", "mechc/view/write"];

/// The pause in typing after which a motion is run: a cancelled motion does not end at once and delays the diagnostics of the next edit.
const MOTION_DELAY: Duration = Duration::from_millis(250);

/// The interval of checks whether a motion takes too long.
const MOTION_CHECK: Duration = Duration::from_millis(200);

/// The time for which an idle server waits.
const IDLE: Duration = Duration::from_secs(3600);

/// The way in which a session ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SessionEnd {
    /// The client sent `shutdown` and `exit`, as the protocol requires.
    Well,
    /// The input ended without `shutdown`.
    Early,
    /// The client's process ended while its end of the pipe is still open.
    Left,
    /// The client did not speak the protocol.
    Unbegun,
}

/// Serves a client until it ends the session or disappears.
#[must_use]
pub fn serve(connection: Connection, world: Arc<dyn World>, log: Log) -> SessionEnd {
    let Connection { sender, receiver } = connection;
    let (task_sender, tasks) = unbounded();
    let snapshot = Snapshot::new(world);
    let (event_sender, events) = unbounded();
    let live_pages = LivePages::new(snapshot.buffers().clone(), event_sender);
    let mut server = Server {
        client: Client::from_params(&Value::Null),
        state: State::New,
        sender,
        task_sender,
        pool: Pool::new(),
        log,
        documents: Documents::default(),
        snapshot,
        published: BTreeMap::new(),
        edited: None,
        revision: 0,
        motions: Vec::new(),
        search: Cancel::default(),
        due_motions: Vec::new(),
        live_pages,
        pending: HashMap::new(),
        pulls: Vec::new(),
        next_id: 0,
        folders: Vec::new(),
        edits: HashMap::new(),
        parent: None,
    };
    server.run(&receiver, &tasks, &events)
}

/// The state of a session.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum State {
    New,
    Running,
    ShutDown,
}

/// A message from the pool to the loop.
enum Task {
    Answered(RequestId, Result<Value, Failure>),
    /// The answer to a live page's request.
    LivePageAnswered(RequestId, Result<Value, String>),
    /// The files of the client's folders.
    Files(Vec<Arc<Path>>),
    /// A motion of a revision has begun; the flag cancels it.
    MotionStarted(u64, Cancel),
    /// A stage of a revision has finished.
    StageFinished {
        path: Arc<Path>,
        revision: u64,
        stage: DiagnosticStage,
        result: Result<Option<StageResult>, String>,
        duration: Duration,
    },
}

/// A request that the pool is answering.
struct Pending {
    method: &'static Method,
    /// The params, for methods that are retried.
    params: Value,
}

/// A request for diagnostics that waits for the first stage.
struct Pull {
    id: RequestId,
    path: Arc<Path>,
    /// The version of the diagnostics that the client has.
    client_version: Option<String>,
}

pub(super) struct Server {
    pub(super) client: Client,
    state: State,
    sender: Sender<Message>,
    task_sender: Sender<Task>,
    pool: Pool,
    log: Log,
    pub(super) documents: Documents,
    snapshot: Snapshot,
    published: BTreeMap<Arc<Path>, PublishedDiagnostics>,
    /// The text that was opened or edited last.
    edited: Option<Arc<Path>>,
    /// The number of changes of the snapshot so far.
    revision: u64,
    /// The motions that are running, with their deadlines.
    motions: Vec<(Cancel, Instant)>,
    /// Cancels the search for files.
    search: Cancel,
    /// The motions to run, with the times at which they are due.
    due_motions: Vec<(Arc<Path>, Instant)>,
    pending: HashMap<RequestId, Pending>,
    pulls: Vec<Pull>,
    /// The live pages.
    live_pages: LivePages,
    /// The id of the server's next request.
    next_id: i32,
    /// The folders that the client has open.
    folders: Vec<PathBuf>,
    /// The edits that the client has not answered yet, with the channels for their outcomes.
    pub(super) edits: HashMap<RequestId, Sender<WriteOutcome>>,
    /// The process of the client, if it is the parent of this one.
    parent: Option<Parent>,
}

impl Server {
    fn run(&mut self, receiver: &Receiver<Message>, tasks: &Receiver<Task>, events: &Receiver<Event>) -> SessionEnd {
        loop {
            select! {
                recv(receiver) -> message => match message {
                    Err(_) => return self.ended_early(),
                    Ok(message) => {
                        self.log.message('<', &message);
                        match message {
                            Message::Request(request) => self.handle_request(request),
                            Message::Response(response) => self.finish_edit(response),
                            Message::Notification(notification) if notification.method == "exit" => {
                                return if self.state == State::ShutDown { SessionEnd::Well } else { self.ended_early() };
                            }
                            Message::Notification(notification) => self.handle_notification(notification),
                        }
                    }
                },
                recv(tasks) -> task => task.map_or((), |task| self.handle_task(task)),
                recv(events) -> event => event.map_or((), |event| self.handle_event(event)),
                default(self.next_wakeup()) => {}
            }
            if self.parent.as_ref().is_some_and(Parent::has_ended) {
                return SessionEnd::Left;
            }
            self.cancel_long_motions();
            self.start_due_motions();
        }
    }

    fn ended_early(&self) -> SessionEnd {
        if self.state == State::New { SessionEnd::Unbegun } else { SessionEnd::Early }
    }

    fn send(&self, message: impl Into<Message>) {
        let message = message.into();
        self.log.message('>', &message);
        // the end of the input tells when the client has gone
        let _ = self.sender.send(message);
    }

    fn answer(&self, id: RequestId, result: Value) {
        self.send(Response { id, response_result: Ok(result) });
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, message: &str) {
        let error = ResponseError { code: code as i32, message: message.to_owned(), data: None };
        self.send(Response { id, response_result: Err(error) });
    }

    fn handle_request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        match (self.state, method.as_str()) {
            (State::New, "initialize") => {
                self.client = Client::from_params(&params);
                self.folders = capabilities::folders(&params);
                self.parent = Parent::from_params(&params);
                self.state = State::Running;
                self.answer(id, capabilities::initialize_result(&self.client));
            }
            (State::New, _) => self.refuse(id, ErrorCode::ServerNotInitialized, "the first request is `initialize`"),
            (State::Running, "initialize") => self.refuse(id, ErrorCode::InvalidRequest, "it is initialized already"),
            (State::Running, "shutdown") => {
                self.state = State::ShutDown;
                self.cancel_work();
                self.answer_pulls(None);
                self.answer(id, Value::Null);
            }
            (State::Running, PULL) => self.pull(id, &params),
            (State::Running, name) if LIVE_PAGE_METHODS.contains(&name) => self.handle_live_page(id, name, &params),
            (State::Running, name) => match TABLE.iter().find(|method| method.name == name) {
                Some(method) => self.start(id, method, params),
                None => self.refuse(id, ErrorCode::MethodNotFound, &format!("there is no method `{name}`")),
            },
            (State::ShutDown, _) => self.refuse(id, ErrorCode::InvalidRequest, "it is shut down"),
        }
    }

    /// Handles a request of a live page.
    fn handle_live_page(&mut self, id: RequestId, name: &str, params: &Value) {
        let Some(uri) = params.pointer("/textDocument/uri").and_then(Value::as_str) else {
            self.refuse(id, ErrorCode::InvalidParams, "it names no text");
            return;
        };
        let mechanism = params.get("mechanism").and_then(Value::as_str).map(str::to_owned);
        let page = PageId { path: self.file_of(uri), uri: uri.to_owned(), mechanism };
        let task_sender = self.task_sender.clone();
        let answer = {
            let id = id.clone();
            move |answer| {
                let _ = task_sender.send(Task::LivePageAnswered(id, answer));
            }
        };
        match name {
            "mechc/view/panel" => {
                let panel = self.live_pages.panel(page);
                self.answer(id, panel);
            }
            "mechc/view/ask" => self.live_pages.ask(page, &params["asked"], answer),
            "mechc/view/write" => self.live_pages.write(page, &params["asked"], answer),
            _ => answer(self.live_pages.address(page)),
        }
    }

    /// Passes the position of the client's cursor to the live pages.
    fn cursor_moved(&mut self, params: &Value) -> Option<()> {
        let path = self.file_of(params.get("textDocument")?.get("uri")?.as_str()?);
        let document = self.documents.get(&path)?;
        let at = document.offset(position(params.get("position")?)?, self.client.encoding) as usize;
        let before = document.text().get(..at)?;
        self.live_pages.set_cursor(&path, before.encode_utf16().count() as u32);
        Some(())
    }

    /// Handles the closing of a panel.
    fn panel_closed(&mut self, params: &Value) -> Option<()> {
        let path = self.file_of(params.pointer("/textDocument/uri")?.as_str()?);
        self.live_pages.close_panel(&path, params.get("mechanism").and_then(Value::as_str));
        Some(())
    }

    /// Returns the text of a file: the open one, or the one on disk.
    pub(super) fn text_of(&self, path: &Path) -> Option<Document> {
        if let Some(document) = self.documents.get(path) {
            return Some(Document::clone(document));
        }
        let contents = self.snapshot.buffers().read(path).ok()?;
        Some(Document::new(super::uri::uri_of(path), 0, std::str::from_utf8(&contents.bytes).ok()?))
    }

    /// Asks the client to show a position of a file (UTF-16).
    fn show(&mut self, path: &Path, at: u32) {
        let Some(document) = &self.text_of(path) else { return };
        let mut left = at as usize;
        let letters = document.text().chars().take_while(|c| {
            let is_before = left > 0;
            left = left.saturating_sub(c.len_utf16());
            is_before
        });
        let position = self.position_json(document, letters.map(char::len_utf8).sum::<usize>() as u32);
        let uri = document.uri.clone();
        let selection = json!({ "start": position, "end": position });
        self.send_request("window/showDocument", json!({ "uri": uri, "takeFocus": false, "selection": selection }));
    }

    pub(super) fn position_json(&self, document: &Document, at: u32) -> Value {
        let (line, character) = document.position(at, self.client.encoding);
        json!({ "line": line, "character": character })
    }

    /// Hands a request to the pool.
    fn start(&mut self, id: RequestId, method: &'static Method, params: Value) {
        let retry_params = if method.is_retried { params.clone() } else { Value::Null };
        self.pending.insert(id.clone(), Pending { method, params: retry_params });
        let (context, task_sender) = (self.context(), self.task_sender.clone());
        self.pool.start(method.kind, move || {
            let answer =
                catch_panic(|| (method.answer)(&context, params)).unwrap_or_else(|why| Err(Failure::Panicked(why)));
            // the server may have ended
            let _ = task_sender.send(Task::Answered(id, answer));
        });
    }

    fn context(&self) -> ProtocolContext {
        let encoding = self.client.encoding;
        let (snapshot, documents) = (self.snapshot.clone(), self.documents.clone());
        ProtocolContext { snapshot, documents, encoding, client: self.client.clone(), closed: Arc::default() }
    }

    /// Returns the file of a URI.
    fn file_of(&self, uri: &str) -> Arc<Path> {
        convert::file_of(uri, &self.documents, &self.snapshot)
    }

    fn handle_task(&mut self, task: Task) {
        match task {
            Task::Answered(id, answer) => self.finish_request(id, answer),
            Task::LivePageAnswered(id, Ok(answer)) => self.answer(id, answer),
            Task::LivePageAnswered(id, Err(why)) => self.refuse(id, ErrorCode::RequestFailed, &why),
            Task::Files(files) => {
                self.log.action(|| format!("{} files are in the folders", files.len()));
                self.snapshot = self.snapshot.with_files(files);
            }
            Task::MotionStarted(revision, motion) if revision == self.revision => {
                self.motions.push((motion, Instant::now() + MOTION_LIMIT));
            }
            Task::MotionStarted(_, motion) => motion.cancel(),
            Task::StageFinished { path, revision, stage, result, duration } => {
                if revision == self.revision && self.state == State::Running {
                    self.log.action(|| {
                        format!("{stage:?} of {} took {:.3} ms", path.display(), duration.as_secs_f64() * 1e3)
                    });
                    self.finish_stage(&path, stage, result);
                }
            }
        }
    }

    /// Handles an event of a live page.
    fn handle_event(&mut self, event: Event) {
        match event {
            Event::Notify(method, params) => self.send(Notification { method: method.to_owned(), params }),
            Event::Write(write) => self.apply_edit(write),
            Event::Show(path, at) => self.show(&path, at),
        }
    }

    fn finish_request(&mut self, id: RequestId, answer: Result<Value, Failure>) {
        let Some(Pending { method, params }) = self.pending.remove(&id) else { return };
        match answer {
            Ok(answer) => self.answer(id, answer),
            Err(Failure::Modified) if method.is_retried && self.state == State::Running => {
                self.start(id, method, params);
            }
            Err(Failure::Modified) => self.refuse(id, ErrorCode::ContentModified, "the text was changed"),
            Err(Failure::Params(why)) => self.refuse(id, ErrorCode::InvalidParams, &why),
            Err(Failure::Refused(why)) => self.refuse(id, ErrorCode::RequestFailed, &why),
            Err(Failure::Panicked(why)) => {
                self.log.action(|| format!("`{}` panicked: {why}", method.name));
                self.refuse(id, ErrorCode::InternalError, &format!("`{}` failed: {why}", method.name));
            }
        }
    }

    /// Sends a request whose response is ignored.
    fn send_plain_request(&mut self, method: &str) {
        self.send_request(method, Value::Null);
    }

    pub(super) fn send_request(&mut self, method: &str, params: Value) -> RequestId {
        self.next_id += 1;
        let id = RequestId::from(self.next_id);
        self.send(Request { id: id.clone(), method: method.to_owned(), params });
        id
    }
}
