//! Work on pieces that come one after the other, done by several threads and handed back in order.
//!
//! Without the feature `threads` a piece is done when it is given; nothing else differs.

use std::sync::Arc;
#[cfg(feature = "threads")]
use std::sync::mpsc::{Receiver, Sender, channel};
#[cfg(feature = "threads")]
use std::thread;

/// What is made of a piece.
type Work<P, T> = dyn Fn(P) -> T + Send + Sync;

/// Pieces that are under way are at most so many times the threads.
#[cfg(feature = "threads")]
const AHEAD: usize = 2;

/// What is made of pieces that are given one after the other.
pub struct Relay<P, T> {
    work: Arc<Work<P, T>>,
    /// They take turns: so what they make comes in order.
    #[cfg(feature = "threads")]
    hands: Vec<Hand<P, T>>,
    /// How many pieces were given to them, and how many handed back.
    #[cfg(feature = "threads")]
    given: usize,
    #[cfg(feature = "threads")]
    taken: usize,
}

impl<P: Send + 'static, T: Send + 'static> Relay<P, T> {
    /// Work on pieces by so many threads; the one that gives them does it if there is one alone.
    #[must_use]
    pub fn new(jobs: usize, work: impl Fn(P) -> T + Send + Sync + 'static) -> Relay<P, T> {
        let work: Arc<Work<P, T>> = Arc::new(work);
        #[cfg(not(feature = "threads"))]
        let _ = jobs;
        Relay {
            #[cfg(feature = "threads")]
            hands: (0..jobs).filter(|_| jobs > 1).map_while(|_| Hand::new(&work)).collect(),
            work,
            #[cfg(feature = "threads")]
            given: 0,
            #[cfg(feature = "threads")]
            taken: 0,
        }
    }

    /// Gives a piece; hands back what was made of an earlier one where enough are under way.
    #[cfg(feature = "threads")]
    pub fn give(&mut self, piece: P) -> Option<T> {
        if self.hands.is_empty() {
            return Some((self.work)(piece));
        }
        let made = if self.given - self.taken >= AHEAD * self.hands.len() { self.take() } else { None };
        let next = self.given % self.hands.len();
        self.given += 1;
        if !self.hands[next].give(piece) {
            self.break_down(next);
        }
        made
    }

    /// Gives a piece and hands back what was made of it.
    #[cfg(not(feature = "threads"))]
    #[allow(clippy::unnecessary_wraps)] // with threads there may be nothing yet
    pub fn give(&mut self, piece: P) -> Option<T> {
        Some((self.work)(piece))
    }

    /// Hands back what was made of the next piece that is under way; nothing if none is.
    #[cfg(feature = "threads")]
    pub fn take(&mut self) -> Option<T> {
        if self.taken == self.given {
            return None;
        }
        let next = self.taken % self.hands.len();
        self.taken += 1;
        let made = self.hands[next].made.recv().ok();
        if made.is_none() {
            self.break_down(next);
        }
        made
    }

    /// As nothing is under way.
    #[cfg(not(feature = "threads"))]
    #[allow(clippy::unused_self)] // with threads there are some
    pub fn take(&mut self) -> Option<T> {
        None
    }

    /// Passes on that a thread has broken down.
    #[cfg(feature = "threads")]
    fn break_down(&mut self, hand: usize) {
        let Hand { pieces, thread, .. } = self.hands.swap_remove(hand);
        drop(pieces);
        if let Err(panic) = thread.join() {
            std::panic::resume_unwind(panic);
        }
    }
}

/// A thread with what goes to it and what comes from it; it ends when nothing can go to it any more.
#[cfg(feature = "threads")]
struct Hand<P, T> {
    pieces: Sender<P>,
    made: Receiver<T>,
    thread: thread::JoinHandle<()>,
}

#[cfg(feature = "threads")]
impl<P: Send + 'static, T: Send + 'static> Hand<P, T> {
    /// One more, if the system gives it.
    fn new(work: &Arc<Work<P, T>>) -> Option<Hand<P, T>> {
        let ((pieces, given), (ready, made)) = (channel(), channel());
        let work = Arc::clone(work);
        let thread = thread::Builder::new().spawn(move || {
            for piece in given {
                // nobody waits for what cannot be sent
                let _ = ready.send(work(piece));
            }
        });
        Some(Hand { pieces, made, thread: thread.ok()? })
    }

    /// Whether it takes a piece.
    fn give(&self, piece: P) -> bool {
        self.pieces.send(piece).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::Relay;

    #[test]
    fn what_is_made_comes_in_order_whatever_it_takes() {
        for jobs in [1, 2, 5] {
            let mut relay = Relay::new(jobs, |piece: u64| {
                // later pieces are done sooner
                (0..(100 - piece) * 1000).for_each(|k| {
                    std::hint::black_box(k);
                });
                piece * piece
            });
            let mut made: Vec<u64> = (0..100).filter_map(|piece| relay.give(piece)).collect();
            made.extend(std::iter::from_fn(|| relay.take()));
            assert_eq!(made, (0..100).map(|piece| piece * piece).collect::<Vec<_>>(), "{jobs}");
        }
    }

    #[test]
    #[cfg(feature = "threads")]
    fn a_panic_is_passed_on() {
        let panicked = std::panic::catch_unwind(|| {
            let mut relay = Relay::new(2, |piece: u64| assert!(piece < 5, "broken"));
            (0..100).filter_map(|piece| relay.give(piece)).count()
        });
        assert!(panicked.is_err());
    }
}
