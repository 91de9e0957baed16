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
    /// Work on pieces by so many threads, each of which begins it with memory of its own. The one that asks for pieces is among them: instead of
    /// waiting it works.
    #[must_use]
    pub fn new<W>(jobs: usize, pieces: Range<u64>, begin: impl Fn() -> W + Send + Sync + 'static) -> Crew<T>
    where
        W: FnMut(u64) -> Option<T> + Send + 'static,
    {
        let own = Box::new(begin());
        #[cfg(feature = "threads")]
        let hands = (jobs > 1).then(|| Hands::new(jobs as u64, &pieces, begin));
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

impl<T> Iterator for Crew<T> {
    type Item = T;

    /// What was made of the next piece; `None` behind the last one, and behind the first one of which nothing was made.
    fn next(&mut self) -> Option<T> {
        let piece = self.pieces.next()?;
        #[cfg(feature = "threads")]
        let made = match &self.hands {
            Some(hands) => hands.shared.handed_out(piece, &mut self.own),
            None => (self.own)(piece),
        };
        #[cfg(not(feature = "threads"))]
        let made = (self.own)(piece);
        if made.is_none() {
            self.pieces.start = self.pieces.end;
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
    /// Nobody waits any more, or a thread has broken down.
    has_ended: bool,
}

#[cfg(feature = "threads")]
impl<T> State<T> {
    /// The next piece that nobody has begun, if it is not too far ahead.
    fn begun_next(&mut self) -> Option<u64> {
        if self.is_far_ahead() || self.has_ended { None } else { self.left.next() }
    }

    fn is_far_ahead(&self) -> bool {
        self.left.start >= self.bound
    }
}

#[cfg(feature = "threads")]
impl<T: Send + 'static> Hands<T> {
    /// All of some threads but the one that asks.
    fn new<W>(jobs: u64, pieces: &Range<u64>, begin: impl Fn() -> W + Send + Sync + 'static) -> Hands<T>
    where
        W: FnMut(u64) -> Option<T>,
    {
        let bound = pieces.start.saturating_add(AHEAD * jobs);
        let state = State { left: pieces.clone(), bound, done: BTreeMap::new(), has_ended: false };
        let shared = Arc::new(Shared { state: Mutex::new(state), done: Condvar::new(), handed_out: Condvar::new() });
        let begin = Arc::new(begin);
        let start = |_| {
            let (shared, begin) = (Arc::clone(&shared), Arc::clone(&begin));
            // a system that gives fewer threads has the same done by fewer
            thread::Builder::new().spawn(move || shared.work(&*begin)).ok()
        };
        Hands { threads: (1..jobs).map_while(start).collect(), shared }
    }
}

#[cfg(feature = "threads")]
impl<T> Shared<T> {
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does pieces until there are none, or nobody waits for them.
    fn work<W: FnMut(u64) -> Option<T>>(&self, begin: &impl Fn() -> W) {
        // who waits for a piece must not wait for a thread that broke down
        let _end = EndOnPanic(self);
        let mut work = begin();
        while let Some(piece) = self.next_piece() {
            let made = work(piece);
            self.state().done.insert(piece, made);
            self.done.notify_one();
        }
    }

    fn next_piece(&self) -> Option<u64> {
        let must_wait = |state: &mut State<T>| !state.has_ended && state.is_far_ahead();
        let waited = self.handed_out.wait_while(self.state(), must_wait);
        waited.unwrap_or_else(PoisonError::into_inner).begun_next()
    }

    /// What was made of a piece; does others as long as it is missing, or that one, if nobody has begun it.
    fn handed_out(&self, piece: u64, own: &mut Work<T>) -> Option<T> {
        let mut state = self.state();
        while !state.has_ended && !state.done.contains_key(&piece) {
            let Some(next) = state.begun_next() else {
                state = self.done.wait(state).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            drop(state);
            let made = own(next);
            state = self.state();
            state.done.insert(next, made);
        }
        let made = state.done.remove(&piece).flatten();
        state.bound = state.bound.saturating_add(1);
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
    #[cfg(feature = "threads")]
    use std::sync::{Mutex, mpsc};
    #[cfg(feature = "threads")]
    use std::thread;
    #[cfg(feature = "threads")]
    use std::time::Duration;

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
            let found: Vec<u64> = Crew::new(jobs, 3..100, move || work).collect();
            assert_eq!(found, (3..100).map(|piece| piece * piece).collect::<Vec<_>>(), "{jobs}");
        }
    }

    #[test]
    fn nothing_comes_behind_what_was_not_made() {
        for jobs in [1, 3] {
            let mut crew = Crew::new(jobs, 0..100, || |piece| (piece < 20).then_some(piece));
            assert_eq!(crew.by_ref().count(), 20);
            assert_eq!(crew.next(), None);
        }
    }

    #[test]
    fn few_pieces_are_done_ahead() {
        let begun = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&begun);
        let mut crew = Crew::new(2, 0..1_000_000, move || {
            let count = Arc::clone(&count);
            move |piece| {
                count.fetch_add(1, Ordering::Relaxed);
                Some(piece)
            }
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
    fn who_asks_works_too_instead_of_waiting() {
        let asker = thread::current().id();
        let (told, worked) = mpsc::channel();
        let worked = Arc::new(Mutex::new(worked));
        let begin = move || {
            let (told, worked) = (told.clone(), Arc::clone(&worked));
            move |piece| {
                if thread::current().id() == asker {
                    told.send(()).ok()?;
                } else {
                    // no other thread does anything before the one that asks
                    let worked = worked.lock().expect("nobody panics");
                    worked.recv_timeout(Duration::from_secs(60)).ok()?;
                }
                Some(piece)
            }
        };
        assert_eq!(Crew::new(2, 0..2, begin).collect::<Vec<u64>>(), [0, 1]);
    }

    #[test]
    fn each_thread_has_memory_of_its_own() {
        for jobs in [1, 3] {
            let begun = Arc::new(AtomicU64::new(0));
            let count = Arc::clone(&begun);
            let begin = move || {
                let of = count.fetch_add(1, Ordering::Relaxed);
                let mut done = 0;
                move |_| {
                    done += 1;
                    Some((of, done))
                }
            };
            let made: Vec<(u64, u64)> = Crew::new(jobs, 0..100, begin).collect();
            assert!(begun.load(Ordering::Relaxed) <= jobs as u64);
            for of in 0..jobs as u64 {
                // what one thread counts comes in order
                let counted = made.iter().filter(|(by, _)| *by == of).map(|(_, done)| *done);
                assert!(counted.eq(1..=made.iter().filter(|(by, _)| *by == of).count() as u64), "{jobs} {made:?}");
            }
            assert_eq!(made.len(), 100);
        }
    }

    #[test]
    #[cfg(feature = "threads")]
    fn a_panic_is_passed_on() {
        let panicked = std::panic::catch_unwind(|| {
            let work = |piece| {
                assert!(piece < 5, "broken");
                Some(piece)
            };
            Crew::new(2, 0..10, move || work).count()
        });
        assert!(panicked.is_err());
    }
}
