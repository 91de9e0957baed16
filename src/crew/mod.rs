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
use std::sync::Arc;
#[cfg(feature = "threads")]
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
#[cfg(feature = "threads")]
use std::thread;

/// What is made of a piece by its number; nothing where the work is to end.
type Work<T> = dyn Fn(u64) -> Option<T> + Send + Sync;

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
    work: Arc<Work<T>>,
    pieces: Range<u64>,
    #[cfg(feature = "threads")]
    hands: Option<Hands<T>>,
}

impl<T: Send + 'static> Crew<T> {
    /// Work on pieces by so many threads; the one that asks for them is not among these unless there is one alone.
    #[must_use]
    pub fn new(jobs: usize, pieces: Range<u64>, work: impl Fn(u64) -> Option<T> + Send + Sync + 'static) -> Crew<T> {
        let work: Arc<Work<T>> = Arc::new(work);
        #[cfg(feature = "threads")]
        let hands = (jobs > 1).then(|| Hands::new(jobs, &pieces, &work)).filter(|hands| !hands.threads.is_empty());
        #[cfg(not(feature = "threads"))]
        let _ = jobs;
        Crew {
            work,
            pieces,
            #[cfg(feature = "threads")]
            hands,
        }
    }
}

impl<T> Iterator for Crew<T> {
    type Item = T;

    /// What was made of the next piece; `None` behind the last one, and behind the first one of which nothing was made.
    fn next(&mut self) -> Option<T> {
        let piece = self.pieces.next()?;
        #[cfg(feature = "threads")]
        let made = match &mut self.hands {
            Some(hands) => hands.shared.handed_out(piece),
            None => (self.work)(piece),
        };
        #[cfg(not(feature = "threads"))]
        let made = (self.work)(piece);
        if made.is_none() {
            self.pieces.start = self.pieces.end;
        }
        made
    }
}

/// The threads.
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
    /// Nobody waits any more, or a thread has broken down.
    has_ended: bool,
}

#[cfg(feature = "threads")]
impl<T: Send + 'static> Hands<T> {
    fn new(jobs: usize, pieces: &Range<u64>, work: &Arc<Work<T>>) -> Hands<T> {
        let bound = pieces.start + AHEAD * jobs as u64;
        let state = State { left: pieces.clone(), bound, done: BTreeMap::new(), has_ended: false };
        let shared = Arc::new(Shared { state: Mutex::new(state), done: Condvar::new(), handed_out: Condvar::new() });
        let start = |_| {
            let (shared, work) = (Arc::clone(&shared), Arc::clone(work));
            // a system that gives fewer threads has the same done by fewer
            thread::Builder::new().spawn(move || shared.work(&*work)).ok()
        };
        Hands { threads: (0..jobs).map_while(start).collect(), shared }
    }
}

#[cfg(feature = "threads")]
impl<T> Shared<T> {
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does pieces until there are none, or nobody waits for them.
    fn work(&self, work: &Work<T>) {
        // who waits for a piece must not wait for a thread that broke down
        let _end = EndOnPanic(self);
        while let Some(piece) = self.next_piece() {
            let made = work(piece);
            self.state().done.insert(piece, made);
            self.done.notify_one();
        }
    }

    fn next_piece(&self) -> Option<u64> {
        let is_far_ahead = |state: &mut State<T>| !state.has_ended && state.left.start >= state.bound;
        let waited = self.handed_out.wait_while(self.state(), is_far_ahead);
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        if state.has_ended { None } else { state.left.next() }
    }

    fn handed_out(&self, piece: u64) -> Option<T> {
        let is_missing = |state: &mut State<T>| !state.has_ended && !state.done.contains_key(&piece);
        let mut state = self.done.wait_while(self.state(), is_missing).unwrap_or_else(PoisonError::into_inner);
        let made = state.done.remove(&piece).flatten();
        state.bound += 1;
        drop(state);
        self.handed_out.notify_one();
        made
    }

    fn end(&self) {
        self.state().has_ended = true;
        self.done.notify_all();
        self.handed_out.notify_all();
    }
}

/// Ends all work when its thread panics.
#[cfg(feature = "threads")]
struct EndOnPanic<'s, T>(&'s Shared<T>);

#[cfg(feature = "threads")]
impl<T> Drop for EndOnPanic<'_, T> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.end();
        }
    }
}

#[cfg(feature = "threads")]
impl<T> Drop for Hands<T> {
    /// Waits for the threads, and passes on that one of them has broken down.
    fn drop(&mut self) {
        self.shared.end();
        for thread in self.threads.drain(..) {
            if let Err(panic) = thread.join()
                && !thread::panicking()
            {
                std::panic::resume_unwind(panic);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Crew;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn pieces_come_in_order_whatever_they_take() {
        for jobs in [1, 2, 7] {
            let work = |piece: u64| {
                // later pieces are done sooner
                (0..(100 - piece) * 1000).for_each(|k| {
                    std::hint::black_box(k);
                });
                Some(piece * piece)
            };
            let found: Vec<u64> = Crew::new(jobs, 3..100, work).collect();
            assert_eq!(found, (3..100).map(|piece| piece * piece).collect::<Vec<_>>(), "{jobs}");
        }
    }

    #[test]
    fn nothing_comes_behind_what_was_not_made() {
        for jobs in [1, 3] {
            let mut crew = Crew::new(jobs, 0..100, |piece| (piece < 20).then_some(piece));
            assert_eq!(crew.by_ref().count(), 20);
            assert_eq!(crew.next(), None);
        }
    }

    #[test]
    fn few_pieces_are_done_ahead() {
        let begun = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&begun);
        let mut crew = Crew::new(2, 0..1_000_000, move |piece| {
            count.fetch_add(1, Ordering::Relaxed);
            Some(piece)
        });
        for _ in 0..10 {
            crew.next();
        }
        let begun_then = begun.load(Ordering::Relaxed);
        drop(crew);
        assert!((10..=14).contains(&begun_then), "{begun_then}");
    }

    #[test]
    #[cfg(feature = "threads")]
    fn a_panic_is_passed_on() {
        let panicked = std::panic::catch_unwind(|| {
            Crew::new(2, 0..10, |piece| {
                assert!(piece < 5, "broken");
                Some(piece)
            })
            .count()
        });
        assert!(panicked.is_err());
    }
}
