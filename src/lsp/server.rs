//! The loop: messages and what the pool has done, one after the other. It alone owns what changes.

use super::answers::{Failure, Method, TABLE};
use super::capabilities::{self, Ability, Client, Refreshes};
use super::convert::{self, Texts};
use super::documents::{Document, Documents};
use super::lines::Position;
use super::log::Log;
use super::parent::{self, Parent};
use super::pool::{Kind, Pool, caught};
use super::stages::{Found, Shown};
use super::views::{Event, Meant, Views, Written};
use crate::cancel::Cancel;
use crate::ide::{self, DiagnosticStage, Snapshot};
use crate::world::World;
use crossbeam_channel::{Receiver, Sender, select, unbounded};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError};
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
    let views = Views::new(snapshot.buffers().clone(), tell);
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
    Found {
        path: Arc<Path>,
        revision: u64,
        stage: DiagnosticStage,
        found: Result<Option<Found>, String>,
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
    shown: BTreeMap<Arc<Path>, Shown>,
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
    views: Views,
    /// Of the server's own requests.
    next_id: i32,
    /// What the client has open.
    folders: Vec<PathBuf>,
    /// The edits that the client has not yet answered, and who waits for that.
    pub(super) edits: HashMap<RequestId, Sender<Written>>,
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
        let meant = Meant { path: self.file_of(uri), uri: uri.to_owned(), mechanism };
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
        let place = self.range_end(document, letters.map(char::len_utf8).sum::<usize>() as u32);
        let uri = document.uri.clone();
        let selection = json!({ "start": place, "end": place });
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
        let (texts, done) = (self.texts(), self.done.clone());
        self.pool.begin(method.kind, move || {
            let answer = caught(|| (method.answer)(&texts, params)).unwrap_or_else(|why| Err(Failure::Panicked(why)));
            // the server may have ended
            let _ = done.send(Task::Answered(id, answer));
        });
    }

    fn texts(&self) -> Texts {
        let encoding = self.client.encoding;
        let (snapshot, documents) = (self.snapshot.clone(), self.documents.clone());
        Texts { snapshot, documents, encoding, client: self.client.clone(), closed: Arc::default() }
    }

    /// The file of a URI.
    fn file_of(&self, uri: &str) -> Arc<Path> {
        convert::file_of(uri, &self.documents, &self.snapshot)
    }

    fn notification(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        if self.state != State::Running {
            return;
        }
        let done = match method.as_str() {
            "initialized" => {
                self.began();
                Some(())
            }
            "textDocument/didOpen" => self.opened(&params),
            "textDocument/didChange" => self.changed(&params),
            "textDocument/didClose" => self.closed(&params),
            "workspace/didChangeWorkspaceFolders" => {
                self.changed_folders(&params);
                Some(())
            }
            "workspace/didChangeWatchedFiles" => self.changed_behind(&params),
            "$/cancelRequest" => self.cancelled(&params),
            "mechc/cursor" => self.pointed(&params),
            "mechc/view/close" => self.left(&params),
            _ => Some(()),
        };
        if done.is_none() {
            self.log.did(|| format!("`{method}` is not as the protocol says: {params}"));
        }
    }

    fn opened(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let (uri, text) = (given.get("uri")?.as_str()?, given.get("text")?.as_str()?);
        let version = version_of(given);
        let path = self.file_of(uri);
        let mut document = Document::new(uri.to_owned(), version, text);
        if let Some(open) = self.documents.get(&path) {
            // what is shown of it is still shown
            document = Document::clone(open);
            (document.uri, document.version) = (uri.to_owned(), version);
            self.edit(&path, &mut document, None, text);
        }
        self.documents.set(Arc::clone(&path), document);
        let opening = self.revision;
        self.shown.entry(Arc::clone(&path)).or_insert_with(|| Shown::of_opening(opening));
        self.replace(&path);
        Some(())
    }

    fn changed(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let path = self.file_of(given.get("uri")?.as_str()?);
        let mut document = Document::clone(self.documents.get(&path)?);
        document.version = version_of(given);
        let changes = params.get("contentChanges")?.as_array()?;
        // all of them or none
        for (range, text) in changes.iter().map(change).collect::<Option<Vec<_>>>()? {
            self.edit(&path, &mut document, range, text);
        }
        self.documents.set(Arc::clone(&path), document);
        self.replace(&path);
        Some(())
    }

    /// Edits a text, and moves along what is shown of it.
    fn edit(&mut self, path: &Path, document: &mut Document, range: Option<[Position; 2]>, text: &str) {
        let moved = document.edit(range, text, self.client.encoding);
        for (other, shown) in &mut self.shown {
            if **other == *path {
                shown.edit(path, &moved);
            } else {
                shown.edit_elsewhere(path, &moved);
            }
        }
    }

    fn closed(&mut self, params: &Value) -> Option<()> {
        let uri = params.get("textDocument")?.get("uri")?.as_str()?;
        let path = self.documents.close(uri)?;
        self.shown.remove(&path)?;
        self.answer_pulls(Some(&path));
        if !self.client.pulls_diagnostics {
            self.tell(uri, Value::Null, &[]);
        }
        self.replace(&path);
        Some(())
    }

    /// The session has begun: the files of the client's folders are looked for.
    fn began(&mut self) {
        if self.client.can(Ability::WatchedFiles) {
            let watchers = json!([{ "globPattern": "**/*.mech" }, { "globPattern": "**/*.csv" }]);
            let method = "workspace/didChangeWatchedFiles";
            let registration = json!({ "id": "files", "method": method, "registerOptions": { "watchers": watchers } });
            self.ask_with("client/registerCapability", json!({ "registrations": [registration] }));
        }
        self.look_for_files();
    }

    fn look_for_files(&mut self) {
        let (folders, world, done) = (self.folders.clone(), Arc::clone(self.snapshot.buffers()), self.done.clone());
        std::mem::take(&mut self.search).cancel();
        let cancel = self.search.clone();
        self.pool.begin(Kind::Files, move || {
            let files = caught(|| ide::files_in(&folders, &*world, &cancel)).unwrap_or_default();
            if !cancel.is_cancelled() {
                let _ = done.send(Task::Files(files));
            }
        });
    }

    fn changed_folders(&mut self, params: &Value) {
        let paths = |name: &str| {
            let list = params.pointer(&format!("/event/{name}")).and_then(Value::as_array);
            let uris = list.into_iter().flatten().filter_map(|folder| folder.get("uri")?.as_str());
            uris.map(super::uri::path_of).collect::<Vec<_>>()
        };
        let removed = paths("removed");
        self.folders.retain(|folder| !removed.contains(folder));
        self.folders.extend(paths("added"));
        self.look_for_files();
    }

    /// Files on the disk are others, or gone, or new.
    fn changed_behind(&mut self, params: &Value) -> Option<()> {
        for change in params.get("changes")?.as_array()? {
            let path = self.file_of(change.get("uri")?.as_str()?);
            if self.documents.get(&path).is_none() {
                self.replace(&path);
            }
        }
        Some(())
    }

    fn cancelled(&mut self, params: &Value) -> Option<()> {
        let id: RequestId = serde_json::from_value(params.get("id")?.clone()).ok()?;
        let pull = self.pulls.iter().position(|pull| pull.id == id);
        let is_pending = self.pending.remove(&id).is_some() || pull.map(|at| self.pulls.remove(at)).is_some();
        if is_pending {
            self.refuse(id, ErrorCode::RequestCanceled, "the client cancelled it");
        }
        Some(())
    }

    /// A file's text is another one: what was begun for the old snapshot ends, and all open texts that this concerns are looked at.
    fn replace(&mut self, path: &Arc<Path>) {
        self.end_work();
        self.edited = Some(Arc::clone(path));
        let text = self.documents.get(path).map(|document| Arc::clone(document.text()));
        let before = self.snapshot.clone();
        self.snapshot = self.snapshot.with_text(path, text);
        self.revision += 1;
        self.views.turn_to(self.snapshot.buffers().clone());
        // the edited text first
        let others: Vec<Arc<Path>> = self.documents.paths().filter(|other| *other != path).cloned().collect();
        for path in std::iter::once(path).chain(&others) {
            let is_same = self.snapshot.is_same(&before, path);
            if let Some(shown) = self.shown.get_mut(path).filter(|shown| !is_same || shown.next().is_some()) {
                shown.begin_again();
                self.look(path);
            }
        }
    }

    /// Ends what is being done for the snapshot.
    fn end_work(&mut self) {
        self.snapshot.cancel();
        self.motions.drain(..).for_each(|(cancel, _)| cancel.cancel());
        self.due.clear();
    }

    /// Begins the next stage of a text.
    fn look(&mut self, path: &Arc<Path>) {
        match self.shown.get(path).and_then(Shown::next) {
            Some(DiagnosticStage::Motion) => self.due.push((Arc::clone(path), Instant::now() + MOTION_DELAY)),
            Some(stage) => self.begin_stage(path, stage),
            None => {}
        }
    }

    fn begin_stage(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let (path, revision, snapshot) = (Arc::clone(path), self.revision, self.snapshot.clone());
        let done = self.done.clone();
        let work = move || {
            let begin = Instant::now();
            let motion = || {
                let cancel = Cancel::default();
                let _ = done.send(Task::Began(revision, cancel.clone()));
                cancel
            };
            let found = caught(|| found(&snapshot, &path, stage, &motion));
            let _ = done.send(Task::Found { path, revision, stage, found, took: begin.elapsed() });
        };
        let kind = match stage {
            DiagnosticStage::Words => Kind::Words,
            DiagnosticStage::Proof => Kind::Proof,
            DiagnosticStage::Motion => Kind::Motion,
        };
        self.pool.begin(kind, work);
    }

    /// How long nothing need be done if nobody says anything.
    fn patience(&self) -> Duration {
        let now = Instant::now();
        let next = self.due.iter().map(|(_, from)| from.saturating_duration_since(now)).min();
        let next = next.unwrap_or(IDLE).min(if self.motions.is_empty() { IDLE } else { TICK });
        if self.parent.is_some() { next.min(parent::TICK) } else { next }
    }

    fn begin_due_motions(&mut self) {
        let now = Instant::now();
        let due: Vec<_> = self.due.extract_if(.., |(_, from)| *from <= now).collect();
        for (path, _) in due {
            self.begin_stage(&path, DiagnosticStage::Motion);
        }
    }

    fn end_long_motions(&mut self) {
        let now = Instant::now();
        self.motions.iter().filter(|(_, end)| *end < now).for_each(|(cancel, _)| cancel.cancel());
        self.motions.retain(|(cancel, _)| !cancel.is_cancelled());
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
            Task::Found { path, revision, stage, found, took } => {
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

    /// Takes in what a stage found of a text, shows it, and begins the next one.
    fn take(&mut self, path: &Arc<Path>, stage: DiagnosticStage, found: Result<Option<Found>, String>) {
        let found = found.unwrap_or_else(|why| {
            self.log.did(|| format!("{stage:?} of {} panicked: {why}", path.display()));
            None
        });
        // a motion that took too long, a file that cannot be read, a mistake of ours: of that nothing is said
        let found = found.unwrap_or(Found { said: Vec::new(), goes_on: false });
        let Some(shown) = self.shown.get_mut(path) else { return };
        let is_new = shown.take(stage, found);
        self.refresh(path, stage);
        if stage == DiagnosticStage::Words {
            self.answer_pulls(Some(path));
        }
        // for the words of the text that was edited it asks by itself
        let is_asked_for = stage == DiagnosticStage::Words && self.edited.as_ref() == Some(path);
        match self.client.pulls_diagnostics {
            true if is_new && !is_asked_for => self.ask("workspace/diagnostic/refresh"),
            false if is_new => self.push(path),
            _ => {}
        }
        self.look(path);
        if stage == DiagnosticStage::Words {
            self.learn_names(path);
        }
    }

    /// Makes the list of a text's names, which most requests ask for, before anybody does.
    fn learn_names(&self, path: &Arc<Path>) {
        let (path, snapshot) = (Arc::clone(path), self.snapshot.clone());
        self.pool.begin(Kind::Request, move || {
            // a mistake of ours is met again, and told, by who asks
            let _ = caught(|| ide::learn_names(&snapshot, &path));
        });
    }

    /// Has the client ask again for what a stage has changed, and it would not by itself.
    fn refresh(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let Refreshes { hints, lenses, tokens } = self.client.refreshes;
        // of the text that was edited it asks for hints and tokens by itself
        let is_of_another = stage == DiagnosticStage::Words && self.edited.as_ref() != Some(path);
        let wanted = [
            (hints && is_of_another, "workspace/inlayHint/refresh"),
            (tokens && is_of_another, "workspace/semanticTokens/refresh"),
            // results are known with the motion
            (lenses && stage == DiagnosticStage::Motion, "workspace/codeLens/refresh"),
        ];
        for (_, method) in wanted.into_iter().filter(|(is_wanted, _)| *is_wanted) {
            self.ask(method);
        }
    }

    fn pull(&mut self, id: RequestId, params: &Value) {
        let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
        let Some(uri) = uri else {
            self.refuse(id, ErrorCode::InvalidParams, "it names no text");
            return;
        };
        let path = self.file_of(uri);
        let known = params.get("previousResultId").and_then(Value::as_str).map(str::to_owned);
        let pull = Pull { id, path, known };
        match self.shown.get(&pull.path).map(Shown::next) {
            // until its words are known
            Some(Some(DiagnosticStage::Words)) => self.pulls.push(pull),
            _ => self.answer_pull(pull),
        }
    }

    /// Answers those who wait for the words of a text, or of all.
    fn answer_pulls(&mut self, path: Option<&Path>) {
        let is_it = |pull: &mut Pull| path.is_none_or(|path| *pull.path == *path);
        let answered: Vec<Pull> = self.pulls.extract_if(.., is_it).collect();
        for pull in answered {
            self.answer_pull(pull);
        }
    }

    fn answer_pull(&self, pull: Pull) {
        let Some(shown) = self.shown.get(&pull.path) else {
            self.answer(pull.id, json!({ "kind": "full", "items": [] }));
            return;
        };
        let version = shown.version();
        let report = if pull.known.as_ref() == Some(&version) {
            json!({ "kind": "unchanged", "resultId": version })
        } else {
            json!({ "kind": "full", "resultId": version, "items": self.diagnostics(&pull.path) })
        };
        self.answer(pull.id, report);
    }

    fn diagnostics(&self, path: &Path) -> Vec<Value> {
        let texts = self.texts();
        let said = self.shown.get(path).map(Shown::all).unwrap_or_default();
        let said = said.iter().filter_map(|said| texts.diagnostic(path, said));
        said.filter_map(|said| serde_json::to_value(said).ok()).collect()
    }

    fn push(&self, path: &Path) {
        if let Some(document) = self.documents.get(path) {
            self.tell(&document.uri, json!(document.version), &self.diagnostics(path));
        }
    }

    fn tell(&self, uri: &str, version: Value, diagnostics: &[Value]) {
        let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
        if !version.is_null() {
            params["version"] = version;
        }
        self.send(Notification { method: "textDocument/publishDiagnostics".to_owned(), params });
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

/// What a stage finds of a text; nothing where it was cancelled.
fn found(snapshot: &Snapshot, path: &Path, stage: DiagnosticStage, motion: &dyn Fn() -> Cancel) -> Option<Found> {
    let said = ide::diagnostics(snapshot, path, stage, motion)?;
    let goes_on = match stage {
        DiagnosticStage::Words => snapshot.may_be_proven(path)?,
        DiagnosticStage::Proof => snapshot.proven(path)?.iter().any(|proven| proven.assembly.is_some()),
        DiagnosticStage::Motion => false,
    };
    Some(Found { said, goes_on })
}

/// A change of a text: where, and to what.
fn change(given: &Value) -> Option<(Option<[Position; 2]>, &str)> {
    let range = match given.get("range").filter(|range| !range.is_null()) {
        None => None,
        Some(range) => Some([position(range.get("start")?)?, position(range.get("end")?)?]),
    };
    Some((range, given.get("text")?.as_str()?))
}

fn version_of(document: &Value) -> i32 {
    document.get("version").and_then(Value::as_i64).and_then(|version| version.try_into().ok()).unwrap_or_default()
}

fn position(given: &Value) -> Option<Position> {
    let number = |name: &str| given.get(name)?.as_u64().map(|number| number.min(u64::from(u32::MAX)) as u32);
    Some((number("line")?, number("character")?))
}
