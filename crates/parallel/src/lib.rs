//! Work that falls into pieces, done by several threads and handed out in order: pieces by their numbers, pieces that come one
//! after the other (`relay.rs`), and shares that hold what is borrowed (`shares.rs`).
//!
//! Without the feature `threads` the pieces are done one after the other, when they are asked for; nothing else differs.

mod relay;
mod shares;

pub use relay::Relay;
pub use shares::in_shares;
#[cfg(feature = "threads")]
use std::collections::BTreeMap;
use std::ops::Range;
#[cfg(feature = "threads")]
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
#[cfg(feature = "threads")]
use std::thread;

/// What is made of a piece by its number; nothing where the work is to end. It may have memory of its own.
type Work<T> = Box<dyn FnMut(u64) -> Option<T> + Send>;

/// Pieces that are done and not yet handed out are at most so many times the threads: a bound of the memory that they take.
#[cfg(feature = "threads")]
const AHEAD: u64 = 2;

/// How many threads this machine does at once.
#[must_use]
pub fn usual_jobs() -> usize {
    #[cfg(feature = "threads")]
    let jobs = thread::available_parallelism().map_or(1, usize::from);
    #[cfg(not(feature = "threads"))]
    let jobs = 1;
    jobs
}

/// What is made of pieces, in their order.
pub struct Crew<T> {
    pieces: Range<u64>,
    /// The work of the thread that asks for them.
    own: Work<T>,
    #[cfg(feature = "threads")]
    hands: Option<Hands<T>>,
}

impl<T: Send + 'static> Crew<T> {
    /// Work on pieces by so many threads, or fewer where there are fewer pieces, each of which starts it with memory of its own. The one that
    /// asks for pieces is among them: it works where it would wait for others. The others begin at once.
    #[must_use]
    pub fn new<W>(jobs: usize, pieces: Range<u64>, start: impl Fn() -> W + Send + Sync + 'static) -> Crew<T>
    where
        W: FnMut(u64) -> Option<T> + Send + 'static,
    {
        let own = Box::new(start());
        #[cfg(feature = "threads")]
        let jobs = (jobs as u64).min(pieces.end.saturating_sub(pieces.start));
        #[cfg(feature = "threads")]
        let hands = (jobs > 1).then(|| Hands::new(jobs, &pieces, start));
        #[cfg(not(feature = "threads"))]
        let _ = jobs;
        Crew {
            pieces,
            own,
            #[cfg(feature = "threads")]
            hands,
        }
    }
}

impl<T> Crew<T> {
    /// Nobody begins a piece any more, and nothing is handed out.
    pub fn end(&mut self) {
        self.pieces = 0..0;
        #[cfg(feature = "threads")]
        if let Some(hands) = &self.hands {
            hands.shared.end();
        }
    }

    fn made(&mut self, piece: u64) -> Option<T> {
        #[cfg(feature = "threads")]
        if let Some(hands) = &self.hands {
            return hands.shared.handed_out(piece, &mut self.own);
        }
        (self.own)(piece)
    }
}

impl<T> Iterator for Crew<T> {
    type Item = T;

    /// What was made of the next piece; `None` behind the last one, behind the first one of which nothing was made, and behind a panic. One of
    /// another thread is passed on where its piece would come.
    fn next(&mut self) -> Option<T> {
        // there are no others unless something is made of this one
        let mut pieces = std::mem::take(&mut self.pieces);
        let made = pieces.next().and_then(|piece| self.made(piece));
        if made.is_some() {
            self.pieces = pieces;
        } else {
            #[cfg(feature = "threads")]
            drop(self.hands.take());
        }
        made
    }
}

/// The other threads.
#[cfg(feature = "threads")]
struct Hands<T> {
    shared: Arc<Shared<T>>,
    threads: Vec<thread::JoinHandle<()>>,
}

/// What the threads and who asks for the pieces share.
#[cfg(feature = "threads")]
struct Shared<T> {
    state: Mutex<State<T>>,
    /// A piece was done.
    done: Condvar,
    /// A piece was handed out.
    handed_out: Condvar,
}

#[cfg(feature = "threads")]
struct State<T> {
    /// Those that nobody has begun.
    left: Range<u64>,
    /// None from here on is begun yet.
    bound: u64,
    done: BTreeMap<u64, Option<T>>,
    /// Nobody waits any more.
    has_ended: bool,
}

#[cfg(feature = "threads")]
impl<T> State<T> {
    fn is_far_ahead(&self) -> bool {
        self.left.start >= self.bound
    }

    /// The next piece that nobody has begun, if it is not too far ahead.
    fn begun_next(&mut self) -> Option<u64> {
        if self.has_ended || self.is_far_ahead() { None } else { self.left.next() }
    }

    /// Keeps what was made of a piece; behind one of which nothing was made none is begun.
    fn put(&mut self, piece: u64, made: Option<T>) {
        if made.is_none() {
            self.left.end = self.left.end.min(piece);
        }
        self.done.insert(piece, made);
    }
}

#[cfg(feature = "threads")]
impl<T: Send + 'static> Hands<T> {
    /// All of some threads but the one that asks.
    fn new<W>(jobs: u64, pieces: &Range<u64>, start: impl Fn() -> W + Send + Sync + 'static) -> Hands<T>
    where
        W: FnMut(u64) -> Option<T>,
    {
        let bound = pieces.start.saturating_add(AHEAD.saturating_mul(jobs));
        let state = State { left: pieces.clone(), bound, done: BTreeMap::new(), has_ended: false };
        let shared = Arc::new(Shared { state: Mutex::new(state), done: Condvar::new(), handed_out: Condvar::new() });
        let start = Arc::new(start);
        let spawned = |_| {
            let (shared, start) = (Arc::clone(&shared), Arc::clone(&start));
            // a system that gives fewer threads has the same done by fewer
            thread::Builder::new().spawn(move || shared.work(&*start)).ok()
        };
        Hands { threads: (1..jobs).map_while(spawned).collect(), shared }
    }
}

#[cfg(feature = "threads")]
impl<T> Shared<T> {
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does pieces until there are none, or nobody waits for them.
    fn work<W: FnMut(u64) -> Option<T>>(&self, start: &impl Fn() -> W) {
        let mut work = start();
        while let Some(piece) = self.next_piece() {
            let mut begun = Begun { shared: self, piece, made: None };
            begun.made = work(piece);
        }
    }

    fn next_piece(&self) -> Option<u64> {
        let must_wait = |state: &mut State<T>| !state.has_ended && state.is_far_ahead();
        let waited = self.handed_out.wait_while(self.state(), must_wait);
        waited.unwrap_or_else(PoisonError::into_inner).begun_next()
    }

    /// Does a piece that nobody has begun, on the thread that asks; whether there was one, not too far ahead.
    fn work_ahead(&self, own: &mut Work<T>) -> bool {
        let Some(piece) = self.state().begun_next() else { return false };
        let made = own(piece);
        self.state().put(piece, made);
        true
    }

    /// What was made of a piece. As long as it is missing others are done, or that one, if nobody has begun it.
    fn handed_out(&self, piece: u64, own: &mut Work<T>) -> Option<T> {
        let is_missing = |state: &State<T>| !state.done.contains_key(&piece);
        while is_missing(&self.state()) && self.work_ahead(own) {}
        // until something is handed out there is nothing else to do
        let waited = self.done.wait_while(self.state(), |state| is_missing(state));
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        let made = state.done.remove(&piece).flatten();
        state.bound = state.bound.saturating_add(1);
        drop(state);
        self.handed_out.notify_one();
        made
    }

    fn end(&self) {
        self.state().has_ended = true;
        self.handed_out.notify_all();
    }
}

/// A piece that another thread works on. Who waits for it must not wait for one that breaks down: of its piece nothing was made.
#[cfg(feature = "threads")]
struct Begun<'s, T> {
    shared: &'s Shared<T>,
    piece: u64,
    made: Option<T>,
}

#[cfg(feature = "threads")]
impl<T> Drop for Begun<'_, T> {
    fn drop(&mut self) {
        self.shared.state().put(self.piece, self.made.take());
        self.shared.done.notify_one();
    }
}

#[cfg(feature = "threads")]
impl<T> Drop for Hands<T> {
    /// Waits for the threads, and passes on that one of them has broken down.
    fn drop(&mut self) {
        self.shared.end();
        let ended: Vec<thread::Result<()>> = self.threads.drain(..).map(thread::JoinHandle::join).collect();
        if let Some(panic) = ended.into_iter().find_map(Result::err).filter(|_| !thread::panicking()) {
            std::panic::resume_unwind(panic);
        }
    }
}
