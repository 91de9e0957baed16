//! Live pages of texts: a workshop for each, whose files are the editor's buffers. A page whose text the editor closes follows the file.
//!
//! What pages ask is answered in threads of their own, and new versions are looked at a moment after the last keystroke: who types waits
//! for none of it.

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use mechc_engine::analysis::Times;
use mechc_live::{Host, MotionRequest, Server, RunningServer, LiveSession, WriteRequest};
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

/// A page is told of another text once nobody has typed for so long.
const DELAY: Duration = Duration::from_millis(120);
/// How often it is looked whether a page is still there, of one that nothing is told.
const PULSE: Duration = Duration::from_secs(2);
/// A client that has not said by then whether it has edited a text does not say it: its user may be asked first.
const EDITED: Duration = Duration::from_secs(60);

/// What pages have for the client.
pub(super) enum Event {
    /// It is told something.
    Tell(&'static str, Value),
    /// A text is to stand in the place of that of a file.
    WriteRequest(PendingWrite),
    /// A place of a file (UTF-16) is to be shown.
    Show(Arc<Path>, u32),
}

/// A text that is to stand in the place of another one.
pub(super) struct PendingWrite {
    pub path: Arc<Path>,
    /// The one that the page shows: another one is not edited.
    pub before: String,
    pub text: String,
    pub done: Sender<WriteOutcome>,
}

/// What came of it: whether that text was still the one, or why the client did not edit it.
pub(super) type WriteOutcome = Result<bool, String>;

/// The pages of a session.
pub(super) struct LivePages {
    shared: Arc<Shared>,
    /// Says that some text is another one; made with the first page.
    wake: Option<Sender<()>>,
}

struct Shared {
    /// The editor's buffers as of now, with the files behind them.
    buffers: Mutex<Arc<dyn World>>,
    open: Mutex<Vec<Arc<LivePage>>>,
    tell: Sender<Event>,
}

struct LivePage {
    path: Arc<Path>,
    mechanism: Option<String>,
    session: Arc<LiveSession>,
    serving: Mutex<Option<RunningServer>>,
    /// Whether a panel is told of what is new.
    has_panel: AtomicBool,
}

/// A text whose page is meant: the file, as the client calls it, and which mechanism of it.
pub(super) struct PageId {
    pub path: Arc<Path>,
    pub uri: String,
    pub mechanism: Option<String>,
}

impl LivePages {
    pub fn new(buffers: Arc<dyn World>, tell: Sender<Event>) -> LivePages {
        let shared = Shared { buffers: Mutex::new(buffers), open: Mutex::default(), tell };
        LivePages { shared: Arc::new(shared), wake: None }
    }

    /// The buffers are others by now.
    pub fn turn_to(&self, buffers: Arc<dyn World>) {
        let Some(wake) = &self.wake else {
            *lock(&self.shared.buffers) = buffers;
            return;
        };
        *lock(&self.shared.buffers) = buffers;
        // one that is full wakes anyway
        let _ = wake.try_send(());
    }

    /// The address of a page in a browser.
    pub fn address(&mut self, meant: PageId) -> Result<Value, String> {
        let view = self.view(meant);
        let mut serving = lock(&view.serving);
        if serving.is_none() {
            let served = Server::bind(0).and_then(|server| server.serve(&view.session));
            *serving = Some(served.map_err(|error| error.to_string())?);
        }
        Ok(json!({ "url": serving.as_ref().map(RunningServer::url) }))
    }

    /// The page itself, for a panel of the editor, which asks in its name.
    pub fn panel(&mut self, meant: PageId) -> Value {
        let uri = meant.uri.clone();
        let view = self.view(meant);
        let page = json!({ "html": mechc_live::page::shell() });
        if view.has_panel.swap(true, Ordering::AcqRel) {
            // one that is made anew asks by itself what there is
            return page;
        }
        let (weak, told_of) = (Arc::downgrade(&view.session), self.shared.tell.clone());
        let tell = move || {
            let mut told = None;
            while let Some(session) = weak.upgrade() {
                let news = session.news(told.as_ref(), PULSE);
                if let Some(news) = &news {
                    let mut params = news.told();
                    params["uri"] = json!(uri);
                    if told_of.send(Event::Tell("mechc/view/news", params)).is_err() {
                        return;
                    }
                }
                told = news.or(told);
            }
        };
        let _ = thread::Builder::new().name("live news".to_owned()).spawn(tell);
        page
    }

    /// A panel is closed; of its page there is nothing left, unless a browser has it too.
    pub fn leave(&self, path: &Path, mechanism: Option<&str>) {
        let is_left = |view: &LivePage| *view.path == *path && view.mechanism.as_deref() == mechanism;
        lock(&self.shared.open).retain(|view| !is_left(view) || lock(&view.serving).is_some());
    }

    /// What a panel asks; it is answered when it is known.
    pub fn ask(&mut self, meant: PageId, asked: &Value, answer: impl FnOnce(Result<Value, String>) + Send + 'static) {
        let view = self.view(meant);
        let body = asked.to_string();
        let work = move || {
            answer(match MotionRequest::of(body.as_bytes()) {
                Ok(asked) => {
                    Ok(json!({ "data": mechc_live::page::base64(&view.session.answer(&asked, &Cancel::default())) }))
                }
                Err(why) => Err(why.to_owned()),
            });
        };
        let _ = thread::Builder::new().name("live answer".to_owned()).stack_size(8 << 20).spawn(work);
    }

    /// Values that a panel writes.
    pub fn write(&mut self, meant: PageId, write: &Value, answer: impl FnOnce(Result<Value, String>) + Send + 'static) {
        let view = self.view(meant);
        let body = write.to_string();
        let work = move || {
            answer(WriteRequest::of(body.as_bytes()).map(|write| view.session.write(&write)).map_err(str::to_owned));
        };
        let _ = thread::Builder::new().name("live write".to_owned()).stack_size(8 << 20).spawn(work);
    }

    /// The cursor is at a place of a file (UTF-16).
    pub fn point(&self, path: &Path, at: u32) {
        let open: Vec<Arc<LivePage>> = lock(&self.shared.open).clone();
        for view in open {
            view.session.point(path, at);
        }
    }

    fn view(&mut self, meant: PageId) -> Arc<LivePage> {
        let PageId { path, mechanism, .. } = meant;
        if self.wake.is_none() {
            let (wake, woken) = bounded(1);
            let shared = Arc::downgrade(&self.shared);
            let look = move || look(&woken, &shared);
            if thread::Builder::new().name("live look".to_owned()).spawn(look).is_ok() {
                self.wake = Some(wake);
            }
        }
        let mut open = lock(&self.shared.open);
        if let Some(view) = open.iter().find(|view| view.path == path && view.mechanism == mechanism) {
            return Arc::clone(view);
        }
        let choice = Choice { mechanism: mechanism.clone(), pictures_forces: true, ..Choice::default() };
        let host = Editor { shared: Arc::clone(&self.shared), path: Arc::clone(&path) };
        let session = Arc::new(LiveSession::new(&path, choice, (Redundant::Refused, false), Box::new(host)));
        let view = LivePage { path, mechanism, session, serving: Mutex::default(), has_panel: AtomicBool::default() };
        let view = Arc::new(view);
        open.push(Arc::clone(&view));
        view
    }
}

impl Drop for LivePages {
    fn drop(&mut self) {
        // their hosts hold what holds them
        lock(&self.shared.open).clear();
    }
}

/// Looks at all texts that have pages, a moment after the last keystroke.
fn look(woken: &Receiver<()>, shared: &std::sync::Weak<Shared>) {
    while woken.recv().is_ok() {
        while woken.recv_timeout(DELAY).is_ok() {}
        let Some(shared) = shared.upgrade() else { return };
        let open: Vec<Arc<LivePage>> = lock(&shared.open).clone();
        for view in open {
            view.session.look();
        }
    }
}

/// The editor as the host of a page.
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
            let said = Diagnostic::new(Code::E0705, "it is not said which times to compute");
            said.help("add `analysis from 0 s to 1 s every 10 ms` to the file").into()
        })
    }

    /// The editor changes its text, which its user saves.
    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String> {
        // what is typed from here on makes it another text than this one, which is looked at again where the client's edits come in
        let before = self.world().read(&self.path).map_err(|why| why.to_string())?;
        let before = String::from_utf8_lossy(&before.bytes).into_owned();
        if !is_due() {
            return Ok(false);
        }
        let (done, written) = bounded(1);
        let writing = PendingWrite { path: Arc::clone(&self.path), before, text: text.to_owned(), done };
        let gone = || "the editor is gone".to_owned();
        self.shared.tell.send(Event::WriteRequest(writing)).map_err(|_| gone())?;
        written.recv_timeout(EDITED).map_err(|why| match why {
            RecvTimeoutError::Timeout => "nothing was written: the editor does not say whether it did".to_owned(),
            RecvTimeoutError::Disconnected => gone(),
        })?
    }

    fn show(&self, at: u32) {
        let _ = self.shared.tell.send(Event::Show(Arc::clone(&self.path), at));
    }
}

/// What of a text is another one in a new text: where, and what stands there.
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
    fn only_what_differs_is_edited() {
        assert_eq!(difference("a = 50 mm // µ", "a = 62.5 mm // µ"), (4..6, "62.5"));
        assert_eq!(difference("aaa", "aa"), (2..3, ""));
        assert_eq!(difference("µµ", "µaµ"), (2..2, "a"));
        assert_eq!(difference("a", "a"), (1..1, ""));
    }
}
