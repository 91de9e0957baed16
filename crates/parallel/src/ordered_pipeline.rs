//! Ordered pipeline: pieces arrive one after the other, several threads process them, and results return in order of arrival.
//!
//! Without the feature `threads` each piece is processed when it is submitted; the results are the same.

use std::sync::Arc;
#[cfg(feature = "threads")]
use std::sync::mpsc::{Receiver, Sender, channel};
#[cfg(feature = "threads")]
use std::thread;

/// Computes the result of a piece.
type Work<P, T> = dyn Fn(P) -> T + Send + Sync;

/// Limit of pieces in flight, as a multiple of the number of threads.
#[cfg(feature = "threads")]
const PIECES_PER_THREAD: usize = 2;

/// Processes pieces on several threads and returns the results in order of submission.
pub struct OrderedPipeline<P, T> {
    work: Arc<Work<P, T>>,
    /// The threads take turns, which keeps the results in order.
    #[cfg(feature = "threads")]
    workers: Vec<Worker<P, T>>,
    /// Numbers of pieces that were submitted and of results that were returned.
    #[cfg(feature = "threads")]
    submitted: usize,
    #[cfg(feature = "threads")]
    returned: usize,
}

impl<P: Send + 'static, T: Send + 'static> OrderedPipeline<P, T> {
    /// Creates a pipeline with `jobs` threads. With one job the calling thread does the work.
    #[must_use]
    pub fn new(jobs: usize, work: impl Fn(P) -> T + Send + Sync + 'static) -> OrderedPipeline<P, T> {
        let work: Arc<Work<P, T>> = Arc::new(work);
        #[cfg(not(feature = "threads"))]
        let _ = jobs;
        OrderedPipeline {
            #[cfg(feature = "threads")]
            workers: (0..jobs).filter(|_| jobs > 1).map_while(|_| Worker::new(&work)).collect(),
            work,
            #[cfg(feature = "threads")]
            submitted: 0,
            #[cfg(feature = "threads")]
            returned: 0,
        }
    }

    /// Submits a piece. Returns the oldest result once enough pieces are in flight.
    #[cfg(feature = "threads")]
    pub fn give(&mut self, piece: P) -> Option<T> {
        if self.workers.is_empty() {
            return Some((self.work)(piece));
        }
        let result =
            if self.submitted - self.returned >= PIECES_PER_THREAD * self.workers.len() { self.take() } else { None };
        let next = self.submitted % self.workers.len();
        self.submitted += 1;
        if !self.workers[next].give(piece) {
            self.propagate_panic(next);
        }
        result
    }

    /// Submits a piece and returns its result.
    #[cfg(not(feature = "threads"))]
    #[allow(clippy::unnecessary_wraps)] // with threads there may be no result yet
    pub fn give(&mut self, piece: P) -> Option<T> {
        Some((self.work)(piece))
    }

    /// Returns the next result of the pieces in flight, or `None` if there are none.
    #[cfg(feature = "threads")]
    pub fn take(&mut self) -> Option<T> {
        if self.returned == self.submitted {
            return None;
        }
        let next = self.returned % self.workers.len();
        self.returned += 1;
        let result = self.workers[next].results.recv().ok();
        if result.is_none() {
            self.propagate_panic(next);
        }
        result
    }

    /// Returns `None`: no piece is in flight.
    #[cfg(not(feature = "threads"))]
    #[allow(clippy::unused_self)] // with threads there are pieces in flight
    pub fn take(&mut self) -> Option<T> {
        None
    }

    /// Continues the panic of a thread.
    #[cfg(feature = "threads")]
    fn propagate_panic(&mut self, worker: usize) {
        let Worker { pieces, thread, .. } = self.workers.swap_remove(worker);
        drop(pieces);
        if let Err(panic) = thread.join() {
            std::panic::resume_unwind(panic);
        }
    }
}

/// A thread with its channels. It ends when its input is closed.
#[cfg(feature = "threads")]
struct Worker<P, T> {
    pieces: Sender<P>,
    results: Receiver<T>,
    thread: thread::JoinHandle<()>,
}

#[cfg(feature = "threads")]
impl<P: Send + 'static, T: Send + 'static> Worker<P, T> {
    /// Starts a thread, or returns `None` if the system refuses one.
    fn new(work: &Arc<Work<P, T>>) -> Option<Worker<P, T>> {
        let ((pieces, input), (output, results)) = (channel(), channel());
        let work = Arc::clone(work);
        let thread = thread::Builder::new().spawn(move || {
            for piece in input {
                // the receiver is gone: the result is not needed
                let _ = output.send(work(piece));
            }
        });
        Some(Worker { pieces, results, thread: thread.ok()? })
    }

    /// Sends a piece to the thread. Returns whether it accepts one.
    fn give(&self, piece: P) -> bool {
        self.pieces.send(piece).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::OrderedPipeline;

    #[test]
    fn results_come_in_order_of_submission() {
        for jobs in [1, 2, 5] {
            let mut relay = OrderedPipeline::new(jobs, |piece: u64| {
                // later pieces take less time
                (0..(100 - piece) * 1000).for_each(|k| {
                    std::hint::black_box(k);
                });
                piece * piece
            });
            let mut results: Vec<u64> = (0..100).filter_map(|piece| relay.give(piece)).collect();
            results.extend(std::iter::from_fn(|| relay.take()));
            assert_eq!(results, (0..100).map(|piece| piece * piece).collect::<Vec<_>>(), "{jobs}");
        }
    }

    #[test]
    #[cfg(feature = "threads")]
    fn a_panic_continues_in_the_caller() {
        let outcome = std::panic::catch_unwind(|| {
            let mut relay = OrderedPipeline::new(2, |piece: u64| assert!(piece < 5, "broken"));
            (0..100).filter_map(|piece| relay.give(piece)).count()
        });
        assert!(outcome.is_err());
    }
}
