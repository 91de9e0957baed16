//! The pool of threads for requests and stages.

use crossbeam_channel::{Sender, unbounded};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// The stack of a thread (bytes), as large as that of a program's main thread.
const STACK: usize = 8 << 20;

/// A kind of work. Each kind has its own threads, so that quick work never waits for slow work.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum TaskKind {
    /// The first stage of diagnostics, while the user types.
    Words,
    /// A request.
    Request,
    /// A request that needs a proof or checks changed texts.
    Slow,
    /// The search for files.
    Files,
    /// The second stage, which does not stop at once when it is cancelled.
    Proof,
    /// The third stage, which may take long.
    Motion,
}

/// The name and number of threads of each kind.
const THREADS: [(TaskKind, &str, usize); 6] = [
    (TaskKind::Words, "words", 1),
    (TaskKind::Request, "request", 2),
    (TaskKind::Slow, "slow", 1),
    (TaskKind::Files, "files", 1),
    (TaskKind::Proof, "proof", 1),
    (TaskKind::Motion, "motion", 1),
];

type Work = Box<dyn FnOnce() + Send>;

/// A pool of threads.
pub(super) struct Pool {
    queues: [Sender<Work>; THREADS.len()],
}

impl Pool {
    /// Starts the threads; they end when the pool is dropped and their work is done.
    pub fn new() -> Pool {
        Pool { queues: THREADS.map(|(_, name, count)| workers(name, count)) }
    }

    /// Runs work as soon as a thread of its kind is free.
    pub fn start(&self, kind: TaskKind, work: impl FnOnce() + Send + 'static) {
        // the receiving threads live as long as the channel
        let _ = self.queues[kind as usize].send(Box::new(work));
    }
}

fn workers(name: &str, count: usize) -> Sender<Work> {
    let (sender, receiver) = unbounded::<Work>();
    for _ in 0..count {
        let receiver = receiver.clone();
        let work = move || receiver.iter().for_each(|work| work());
        // if no more threads can be started, the others do the work
        let _ = thread::Builder::new().name(name.to_owned()).stack_size(STACK).spawn(work);
    }
    sender
}

/// Runs work and returns its result, or the message of its panic.
pub(super) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| panic_message(&*panic))
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without words".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Pool, THREADS, TaskKind, catch_panic};
    use crossbeam_channel::unbounded;

    #[test]
    fn a_panic_is_reported_and_the_next_work_is_done() {
        let (pool, (sender, receiver)) = (Pool::new(), unbounded());
        for k in 0..10 {
            let sender = sender.clone();
            pool.start(TaskKind::Request, move || {
                let message = catch_panic(|| assert!(k % 2 == 0, "odd {k}")).err();
                sender.send((k, message)).expect("it is open");
            });
        }
        let mut outcomes: Vec<_> = receiver.iter().take(10).collect();
        outcomes.sort();
        assert_eq!(outcomes[3], (3, Some("odd 3".to_owned())));
        assert_eq!(outcomes.iter().filter(|(_, message)| message.is_none()).count(), 5);
    }

    #[test]
    fn each_kind_has_its_threads() {
        for (k, (kind, ..)) in THREADS.into_iter().enumerate() {
            assert_eq!(kind as usize, k);
        }
    }

    #[test]
    fn words_do_not_wait_for_a_proof() {
        let (pool, (sender, receiver)) = (Pool::new(), unbounded());
        let (until, end) = unbounded::<()>();
        // the proof lasts until the words are done
        pool.start(TaskKind::Proof, move || assert!(end.recv().is_err()));
        pool.start(TaskKind::Words, move || sender.send("words").expect("it is open"));
        assert_eq!(receiver.recv(), Ok("words"));
        drop(until);
    }
}
