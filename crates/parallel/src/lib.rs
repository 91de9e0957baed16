//! Ordered parallel computation: results of numbered pieces ([`ParallelMap`]), of pieces that arrive one after the other
//! ([`OrderedPipeline`]), and of ranges with borrowed data ([`scoped_chunks`]).
//!
//! Without the feature `threads` the calling thread computes each piece when it is requested; the results are the same.

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

/// Computes the result of a piece from its number, or `None` to end the work. It may own state.
type Work<T> = Box<dyn FnMut(u64) -> Option<T> + Send>;

/// Limit of finished results that are not yet delivered, as a multiple of the number of threads; it bounds the memory that they take.
#[cfg(feature = "threads")]
const AHEAD: u64 = 2;

/// Returns the number of threads that this machine runs at once.
#[must_use]
pub fn usual_jobs() -> usize {
    #[cfg(feature = "threads")]
    let jobs = thread::available_parallelism().map_or(1, usize::from);
    #[cfg(not(feature = "threads"))]
    let jobs = 1;
    jobs
}

/// Iterator over the results of numbered pieces, in their order, which several threads compute ahead.
pub struct Crew<T> {
    pieces: Range<u64>,
    /// The work of the calling thread.
    own: Work<T>,
    #[cfg(feature = "threads")]
    hands: Option<Hands<T>>,
}

impl<T: Send + 'static> Crew<T> {
    /// Starts work on `pieces` with at most `jobs` threads, the calling thread included: it computes a piece itself where it would wait for
    /// the others. Each thread calls `start` once for state of its own. The other threads begin at once.
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
    /// Ends the work: no thread begins another piece, and the iterator returns `None` from now on.
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

    /// Returns the result of the next piece; `None` after the last piece, after the first piece without a result, and after a panic. A
    /// panic of another thread continues here, where the result of its piece would come.
    fn next(&mut self) -> Option<T> {
        // an early return or a panic leaves no pieces behind
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

/// State that the threads and the iterator share.
#[cfg(feature = "threads")]
struct Shared<T> {
    state: Mutex<State<T>>,
    /// Signals that a piece is finished.
    done: Condvar,
    /// Signals that a result was delivered.
    handed_out: Condvar,
}

#[cfg(feature = "threads")]
struct State<T> {
    /// Pieces that no thread has begun.
    left: Range<u64>,
    /// First piece that no thread may begin yet.
    bound: u64,
    done: BTreeMap<u64, Option<T>>,
    /// True once no result is needed any more.
    has_ended: bool,
}

#[cfg(feature = "threads")]
impl<T> State<T> {
    fn is_far_ahead(&self) -> bool {
        self.left.start >= self.bound
    }

    /// Takes the next piece that no thread has begun, if it is not too far ahead.
    fn begun_next(&mut self) -> Option<u64> {
        if self.has_ended || self.is_far_ahead() { None } else { self.left.next() }
    }

    /// Stores the result of a piece. No thread begins a piece after one without a result.
    fn put(&mut self, piece: u64, made: Option<T>) {
        if made.is_none() {
            self.left.end = self.left.end.min(piece);
        }
        self.done.insert(piece, made);
    }
}

#[cfg(feature = "threads")]
impl<T: Send + 'static> Hands<T> {
    /// Starts `jobs - 1` threads; the calling thread is the remaining one.
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
            // if the system refuses a thread, fewer threads do the work
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

    /// Computes pieces until none is left or no result is needed any more.
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

    /// Computes the next piece that no thread has begun on the calling thread. Returns whether there was one that is not too far ahead.
    fn work_ahead(&self, own: &mut Work<T>) -> bool {
        let Some(piece) = self.state().begun_next() else { return false };
        let made = own(piece);
        self.state().put(piece, made);
        true
    }

    /// Returns the result of a piece. While it is missing, the calling thread computes other pieces, or this one if no thread has begun it.
    fn handed_out(&self, piece: u64, own: &mut Work<T>) -> Option<T> {
        let is_missing = |state: &State<T>| !state.done.contains_key(&piece);
        while is_missing(&self.state()) && self.work_ahead(own) {}
        // nothing else may begin until a result is delivered
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

/// A piece that another thread computes. When a panic drops it, it stores `None`, so that the iterator does not wait for ever.
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
    /// Waits for the threads and continues a panic of one of them.
    fn drop(&mut self) {
        self.shared.end();
        let ended: Vec<thread::Result<()>> = self.threads.drain(..).map(thread::JoinHandle::join).collect();
        if let Some(panic) = ended.into_iter().find_map(Result::err).filter(|_| !thread::panicking()) {
            std::panic::resume_unwind(panic);
        }
    }
}
