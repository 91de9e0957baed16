//! Live pages of texts: a session for each, whose files are the editor's buffers. The page of a closed text follows the file on disk.
//!
//! Requests of pages are answered on threads of their own, and sessions reload a moment after the last keystroke, so typing waits for
//! none of it.

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use mechc_engine::analysis::Times;
use mechc_live::{Host, LiveSession, MotionRequest, RunningServer, Server, WriteRequest};
use mechc_pipeline::{Choice, Compiled, Redundant};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::Sources;
use mechc_text::world::World;
use serde_json::{Value, json};
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// The pause in typing after which pages reload.
const RELOAD_DELAY: Duration = Duration::from_millis(120);
/// The interval of checks whether a session without news still exists.
const SESSION_CHECK: Duration = Duration::from_secs(2);
/// The time to wait for the client's response to an edit; it may ask its user first.
const EDIT_TIMEOUT: Duration = Duration::from_secs(60);

/// A message of a page to the client.
pub(super) enum Event {
    /// A notification.
    Notify(&'static str, Value),
    /// A new text for a file.
    Write(PendingWrite),
    /// A position of a file (UTF-16) to show.
    Show(Arc<Path>, u32),
}

/// A new text for a file, to be written by the client.
pub(super) struct PendingWrite {
    pub path: Arc<Path>,
    /// The text that the page shows; a different one is not edited.
    pub before: String,
    pub text: String,
    pub outcome: Sender<WriteOutcome>,
}

/// The outcome of write: whether the text was still the expected one, or why the client did not edit it.
pub(super) type WriteOutcome = Result<bool, String>;

/// The live pages of an editor's session.
pub(super) struct LivePages {
    shared: Arc<Shared>,
    /// Wakes the thread that reloads sessions; created with the first page.
    wake: Option<Sender<()>>,
}

struct Shared {
    /// The editor's current buffers.
    buffers: Mutex<Arc<dyn World>>,
    open: Mutex<Vec<Arc<LivePage>>>,
    events: Sender<Event>,
}

struct LivePage {
    path: Arc<Path>,
    mechanism: Option<String>,
    session: Arc<LiveSession>,
    server: Mutex<Option<RunningServer>>,
    /// True if a thread notifies a panel of changes.
    has_panel: AtomicBool,
}

/// The identity of a page: a file with its URI, and a mechanism of it.
pub(super) struct PageId {
    pub path: Arc<Path>,
    pub uri: String,
    pub mechanism: Option<String>,
}

impl LivePages {
    pub fn new(buffers: Arc<dyn World>, events: Sender<Event>) -> LivePages {
        let shared = Shared { buffers: Mutex::new(buffers), open: Mutex::default(), events };
        LivePages { shared: Arc::new(shared), wake: None }
    }

    /// Replaces the buffers and wakes the thread that reloads sessions.
    pub fn set_buffers(&self, buffers: Arc<dyn World>) {
        let Some(wake) = &self.wake else {
            *lock(&self.shared.buffers) = buffers;
            return;
        };
        *lock(&self.shared.buffers) = buffers;
        // a full channel wakes the thread anyway
        let _ = wake.try_send(());
    }

    /// Returns the address of a page for a browser.
    pub fn address(&mut self, id: PageId) -> Result<Value, String> {
        let page = self.page(id);
        let mut server = lock(&page.server);
        if server.is_none() {
            let running = Server::bind(0).and_then(|server| server.serve(&page.session));
            *server = Some(running.map_err(|error| error.to_string())?);
        }
        Ok(json!({ "url": server.as_ref().map(RunningServer::url) }))
    }

    /// Returns the page itself for a panel of the editor, which sends the page's requests.
    pub fn panel(&mut self, id: PageId) -> Value {
        let uri = id.uri.clone();
        let page = self.page(id);
        let html = json!({ "html": mechc_live::page::shell() });
        if page.has_panel.swap(true, Ordering::AcqRel) {
            // a panel that is opened again requests the state by itself
            return html;
        }
        let (weak, events) = (Arc::downgrade(&page.session), self.shared.events.clone());
        let notify = move || {
            let mut last = None;
            while let Some(session) = weak.upgrade() {
                let status = session.wait_for_change(last.as_ref(), SESSION_CHECK);
                if let Some(status) = &status {
                    let mut params = status.to_json();
                    params["uri"] = json!(uri);
                    if events.send(Event::Notify("mechc/view/news", params)).is_err() {
                        return;
                    }
                }
                last = status.or(last);
            }
        };
        let _ = thread::Builder::new().name("live news".to_owned()).spawn(notify);
        html
    }

    /// Closes the session of a panel, unless a browser has the page too.
    pub fn close_panel(&self, path: &Path, mechanism: Option<&str>) {
        let is_closed = |page: &LivePage| *page.path == *path && page.mechanism.as_deref() == mechanism;
        lock(&self.shared.open).retain(|page| !is_closed(page) || lock(&page.server).is_some());
    }

    /// Answers a panel's request for data on a thread of its own.
    pub fn ask(&mut self, id: PageId, request: &Value, answer: impl FnOnce(Result<Value, String>) + Send + 'static) {
        let page = self.page(id);
        let body = request.to_string();
        let work = move || {
            answer(match MotionRequest::parse(body.as_bytes()) {
                Ok(request) => {
                    let response = page.session.answer(&request, &Cancel::default());
                    Ok(json!({ "data": mechc_live::page::base64(&response) }))
                }
                Err(why) => Err(why.to_owned()),
            });
        };
        let _ = thread::Builder::new().name("live answer".to_owned()).stack_size(8 << 20).spawn(work);
    }

    /// Writes the values of a panel's request, on a thread of its own.
    pub fn write(&mut self, id: PageId, write: &Value, answer: impl FnOnce(Result<Value, String>) + Send + 'static) {
        let page = self.page(id);
        let body = write.to_string();
        let work = move || {
            answer(WriteRequest::parse(body.as_bytes()).map(|write| page.session.write(&write)).map_err(str::to_owned));
        };
        let _ = thread::Builder::new().name("live write".to_owned()).stack_size(8 << 20).spawn(work);
    }

    /// Passes the position of the cursor in a file (UTF-16) to all pages.
    pub fn set_cursor(&self, path: &Path, at: u32) {
        let open: Vec<Arc<LivePage>> = lock(&self.shared.open).clone();
        for page in open {
            page.session.set_cursor(path, at);
        }
    }

    fn page(&mut self, id: PageId) -> Arc<LivePage> {
        let PageId { path, mechanism, .. } = id;
        if self.wake.is_none() {
            let (wake, woken) = bounded(1);
            let shared = Arc::downgrade(&self.shared);
            let reload = move || reload_sessions(&woken, &shared);
            if thread::Builder::new().name("live reload".to_owned()).spawn(reload).is_ok() {
                self.wake = Some(wake);
            }
        }
        let mut open = lock(&self.shared.open);
        if let Some(page) = open.iter().find(|page| page.path == path && page.mechanism == mechanism) {
            return Arc::clone(page);
        }
        let choice = Choice { mechanism: mechanism.clone(), pictures_forces: true, ..Choice::default() };
        let host = Editor { shared: Arc::clone(&self.shared), path: Arc::clone(&path) };
        let session = Arc::new(LiveSession::new(&path, choice, Redundant::Refused, false, Box::new(host)));
        let page = LivePage { path, mechanism, session, server: Mutex::default(), has_panel: AtomicBool::default() };
        let page = Arc::new(page);
        open.push(Arc::clone(&page));
        page
    }
}

impl Drop for LivePages {
    fn drop(&mut self) {
        // hosts hold `Shared`, which holds the pages: the cycle must be broken
        lock(&self.shared.open).clear();
    }
}

/// Reloads the sessions of all pages a moment after the last keystroke.
fn reload_sessions(woken: &Receiver<()>, shared: &std::sync::Weak<Shared>) {
    while woken.recv().is_ok() {
        while woken.recv_timeout(RELOAD_DELAY).is_ok() {}
        let Some(shared) = shared.upgrade() else { return };
        let open: Vec<Arc<LivePage>> = lock(&shared.open).clone();
        for page in open {
            page.session.reload();
        }
    }
}

/// The host of a page: the editor.
struct Editor {
    shared: Arc<Shared>,
    path: Arc<Path>,
}

impl Host for Editor {
    fn world(&self) -> Arc<dyn World> {
        Arc::clone(&lock(&self.shared.buffers))
    }

    fn times(&self, compiled: &Compiled, _: &mut Sources) -> Result<Times, Diagnostics> {
        compiled.times().ok_or_else(|| {
            let diagnostic = Diagnostic::new(Code::E0705, "it is not said which times to compute");
            diagnostic.help("add `analysis from 0 s to 1 s every 10 ms` to the file").into()
        })
    }

    /// Asks the editor to change its text, which the user saves.
    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
        // if the user types from here on, the server finds a text other than `before` and does not edit it
        let before = self.world().read(&self.path).map_err(|why| why.to_string())?;
        let before = String::from_utf8_lossy(&before.bytes).into_owned();
        if !is_due() {
            return Ok(false);
        }
        let (outcome, written) = bounded(1);
        let write = PendingWrite { path: Arc::clone(&self.path), before, text: text.to_owned(), outcome };
        let gone = || "the editor is gone".to_owned();
        self.shared.events.send(Event::Write(write)).map_err(|_| gone())?;
        written.recv_timeout(EDIT_TIMEOUT).map_err(|why| match why {
            RecvTimeoutError::Timeout => "nothing was written: the editor does not say whether it did".to_owned(),
            RecvTimeoutError::Disconnected => gone(),
        })?
    }

    fn show(&self, at: u32) {
        let _ = self.shared.events.send(Event::Show(Arc::clone(&self.path), at));
    }
}

/// Returns the range of the old text that differs from the new one, and its replacement.
pub(super) fn difference<'n>(old: &str, new: &'n str) -> (Range<u32>, &'n str) {
    let same = |mut pairs: Box<dyn Iterator<Item = (char, char)> + '_>| -> usize {
        pairs.by_ref().take_while(|(a, b)| a == b).map(|(a, _)| a.len_utf8()).sum()
    };
    let before = same(Box::new(old.chars().zip(new.chars())));
    let behind = same(Box::new(old[before..].chars().rev().zip(new[before..].chars().rev())));
    (before as u32..(old.len() - behind) as u32, &new[before..new.len() - behind])
}

fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::difference;

    #[test]
    fn only_the_difference_is_edited() {
        assert_eq!(difference("a = 50 mm // µ", "a = 62.5 mm // µ"), (4..6, "62.5"));
        assert_eq!(difference("aaa", "aa"), (2..3, ""));
        assert_eq!(difference("µµ", "µaµ"), (2..2, "a"));
        assert_eq!(difference("a", "a"), (1..1, ""));
    }
}
