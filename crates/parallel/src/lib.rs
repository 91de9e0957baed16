//! Ordered parallel computation: results of numbered pieces ([`ParallelMap`]), of pieces that arrive one after the other
//! ([`OrderedPipeline`]), and of ranges with borrowed data ([`scoped_chunks`]).
//!
//! Without the feature `threads` the calling thread computes each piece when it is requested; the results are the same.

mod ordered_pipeline;
mod scoped_chunks;

pub use ordered_pipeline::OrderedPipeline;
pub use scoped_chunks::scoped_chunks;
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
const RESULTS_PER_THREAD: u64 = 2;

/// Returns the number of threads that this machine runs at once.
#[must_use]
pub fn default_jobs() -> usize {
    #[cfg(feature = "threads")]
    let jobs = thread::available_parallelism().map_or(1, usize::from);
    #[cfg(not(feature = "threads"))]
    let jobs = 1;
    jobs
}

/// Iterator over the results of numbered pieces, in their order, which several threads compute ahead.
pub struct ParallelMap<T> {
    pieces: Range<u64>,
    /// The work of the calling thread.
    local_work: Work<T>,
    #[cfg(feature = "threads")]
    workers: Option<Workers<T>>,
}

impl<T: Send + 'static> ParallelMap<T> {
    /// Starts work on `pieces` with at most `jobs` threads, the calling thread included: it computes a piece itself where it would wait for
    /// the others. Each thread calls `start` once for state of its own. The other threads begin at once.
    #[must_use]
    pub fn new<W>(jobs: usize, pieces: Range<u64>, start: impl Fn() -> W + Send + Sync + 'static) -> ParallelMap<T>
    where
        W: FnMut(u64) -> Option<T> + Send + 'static,
    {
        let local_work = Box::new(start());
        #[cfg(feature = "threads")]
        let jobs = (jobs as u64).min(pieces.end.saturating_sub(pieces.start));
        #[cfg(feature = "threads")]
        let workers = (jobs > 1).then(|| Workers::new(jobs, &pieces, start));
        #[cfg(not(feature = "threads"))]
        let _ = jobs;
        ParallelMap {
            pieces,
            local_work,
            #[cfg(feature = "threads")]
            workers,
        }
    }
}

impl<T> ParallelMap<T> {
    /// Ends the work: no thread begins another piece, and the iterator returns `None` from now on.
    pub fn end(&mut self) {
        self.pieces = 0..0;
        #[cfg(feature = "threads")]
        if let Some(workers) = &self.workers {
            workers.shared.end();
        }
    }

    fn result(&mut self, piece: u64) -> Option<T> {
        #[cfg(feature = "threads")]
        if let Some(workers) = &self.workers {
            return workers.shared.deliver(piece, &mut self.local_work);
        }
        (self.local_work)(piece)
    }
}

impl<T> Iterator for ParallelMap<T> {
    type Item = T;

    /// Returns the result of the next piece; `None` after the last piece, after the first piece without a result, and after a panic. A
    /// panic of another thread continues here, where the result of its piece would come.
    fn next(&mut self) -> Option<T> {
        // an early return or a panic leaves no pieces behind
        let mut pieces = std::mem::take(&mut self.pieces);
        let result = pieces.next().and_then(|piece| self.result(piece));
        if result.is_some() {
            self.pieces = pieces;
        } else {
            #[cfg(feature = "threads")]
            drop(self.workers.take());
        }
        result
    }
}

/// The other threads.
#[cfg(feature = "threads")]
struct Workers<T> {
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
    delivered: Condvar,
}

#[cfg(feature = "threads")]
struct State<T> {
    /// Pieces that no thread has begun.
    pending: Range<u64>,
    /// First piece that no thread may begin yet.
    limit: u64,
    done: BTreeMap<u64, Option<T>>,
    /// True once no result is needed any more.
    is_ended: bool,
}

#[cfg(feature = "threads")]
impl<T> State<T> {
    fn is_far_ahead(&self) -> bool {
        self.pending.start >= self.limit
    }

    /// Takes the next piece that no thread has begun, if it is not too far ahead.
    fn take_next(&mut self) -> Option<u64> {
        if self.is_ended || self.is_far_ahead() { None } else { self.pending.next() }
    }

    /// Stores the result of a piece. No thread begins a piece after one without a result.
    fn store(&mut self, piece: u64, result: Option<T>) {
        if result.is_none() {
            self.pending.end = self.pending.end.min(piece);
        }
        self.done.insert(piece, result);
    }
}

#[cfg(feature = "threads")]
impl<T: Send + 'static> Workers<T> {
    /// Starts `jobs - 1` threads; the calling thread is the remaining one.
    fn new<W>(jobs: u64, pieces: &Range<u64>, start: impl Fn() -> W + Send + Sync + 'static) -> Workers<T>
    where
        W: FnMut(u64) -> Option<T>,
    {
        let limit = pieces.start.saturating_add(RESULTS_PER_THREAD.saturating_mul(jobs));
        let state = State { pending: pieces.clone(), limit, done: BTreeMap::new(), is_ended: false };
        let shared = Arc::new(Shared { state: Mutex::new(state), done: Condvar::new(), delivered: Condvar::new() });
        let start = Arc::new(start);
        let spawned = |_| {
            let (shared, start) = (Arc::clone(&shared), Arc::clone(&start));
            // if the system refuses a thread, fewer threads do the work
            thread::Builder::new().spawn(move || shared.work(&*start)).ok()
        };
        Workers { threads: (1..jobs).map_while(spawned).collect(), shared }
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
            let mut in_progress = InProgress { shared: self, piece, result: None };
            in_progress.result = work(piece);
        }
    }

    fn next_piece(&self) -> Option<u64> {
        let must_wait = |state: &mut State<T>| !state.is_ended && state.is_far_ahead();
        let waited = self.delivered.wait_while(self.state(), must_wait);
        waited.unwrap_or_else(PoisonError::into_inner).take_next()
    }

    /// Computes the next piece that no thread has begun on the calling thread. Returns whether there was one that is not too far ahead.
    fn work_ahead(&self, local_work: &mut Work<T>) -> bool {
        let Some(piece) = self.state().take_next() else { return false };
        let result = local_work(piece);
        self.state().store(piece, result);
        true
    }

    /// Returns the result of a piece. While it is missing, the calling thread computes other pieces, or this one if no thread has begun it.
    fn deliver(&self, piece: u64, local_work: &mut Work<T>) -> Option<T> {
        let is_missing = |state: &State<T>| !state.done.contains_key(&piece);
        while is_missing(&self.state()) && self.work_ahead(local_work) {}
        // nothing else may begin until a result is delivered
        let waited = self.done.wait_while(self.state(), |state| is_missing(state));
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        let result = state.done.remove(&piece).flatten();
        state.limit = state.limit.saturating_add(1);
        drop(state);
        self.delivered.notify_one();
        result
    }

    fn end(&self) {
        self.state().is_ended = true;
        self.delivered.notify_all();
    }
}

/// A piece that another thread computes. When a panic drops it, it stores `None`, so that the iterator does not wait for ever.
#[cfg(feature = "threads")]
struct InProgress<'s, T> {
    shared: &'s Shared<T>,
    piece: u64,
    result: Option<T>,
}

#[cfg(feature = "threads")]
impl<T> Drop for InProgress<'_, T> {
    fn drop(&mut self) {
        self.shared.state().store(self.piece, self.result.take());
        self.shared.done.notify_one();
    }
}

#[cfg(feature = "threads")]
impl<T> Drop for Workers<T> {
    /// Waits for the threads and continues a panic of one of them.
    fn drop(&mut self) {
        self.shared.end();
        let results: Vec<thread::Result<()>> = self.threads.drain(..).map(thread::JoinHandle::join).collect();
        if let Some(panic) = results.into_iter().find_map(Result::err).filter(|_| !thread::panicking()) {
            std::panic::resume_unwind(panic);
        }
    }
}
