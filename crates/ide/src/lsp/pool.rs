//! Threads for the work of requests and stages.

use crossbeam_channel::{Sender, unbounded};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// Stack of a thread (bytes): as much as a program's first one has.
const STACK: usize = 8 << 20;

/// What work is for; each kind has threads of its own, so that none waits for one that takes longer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum TaskKind {
    /// What is said while somebody types.
    Words,
    /// What somebody asked for.
    Request,
    /// What somebody asked for that takes a proof, or checks of what would be.
    Slow,
    /// Which files there are.
    Files,
    /// What is said right after; it is not cancelled at once.
    Proof,
    /// What may take long.
    Motion,
}

/// Each kind with its number of threads.
const THREADS: [(TaskKind, &str, usize); 6] = [
    (TaskKind::Words, "words", 1),
    (TaskKind::Request, "request", 2),
    (TaskKind::Slow, "weighed", 1),
    (TaskKind::Files, "files", 1),
    (TaskKind::Proof, "proof", 1),
    (TaskKind::Motion, "motion", 1),
];

type Work = Box<dyn FnOnce() + Send>;

/// Where work is handed in.
pub(super) struct Pool {
    queues: [Sender<Work>; THREADS.len()],
}

impl Pool {
    /// Begins with its threads; they end when it is dropped and their work is done.
    pub fn new() -> Pool {
        Pool { queues: THREADS.map(|(_, name, count)| workers(name, count)) }
    }

    /// Does something as soon as a thread of its kind is free.
    pub fn begin(&self, kind: TaskKind, work: impl FnOnce() + Send + 'static) {
        // the threads are there as long as their channel
        let _ = self.queues[kind as usize].send(Box::new(work));
    }
}

fn workers(name: &str, count: usize) -> Sender<Work> {
    let (sender, receiver) = unbounded::<Work>();
    for _ in 0..count {
        let receiver = receiver.clone();
        let work = move || receiver.iter().for_each(|work| work());
        // a machine that has no more threads serves with those that it has
        let _ = thread::Builder::new().name(name.to_owned()).stack_size(STACK).spawn(work);
    }
    sender
}

/// What work gives, or the words with which it panicked.
pub(super) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| words(&*panic))
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without words".to_owned())
}

#[cfg(test)]
mod tests {
    use super::{TaskKind, Pool, THREADS, caught};
    use crossbeam_channel::unbounded;

    #[test]
    fn a_panic_is_told_and_the_next_work_is_done() {
        let (pool, (sender, receiver)) = (Pool::new(), unbounded());
        for k in 0..10 {
            let sender = sender.clone();
            pool.begin(TaskKind::Request, move || {
                let told = caught(|| assert!(k % 2 == 0, "odd {k}")).err();
                sender.send((k, told)).expect("it is open");
            });
        }
        let mut told: Vec<_> = receiver.iter().take(10).collect();
        told.sort();
        assert_eq!(told[3], (3, Some("odd 3".to_owned())));
        assert_eq!(told.iter().filter(|(_, told)| told.is_none()).count(), 5);
    }

    #[test]
    fn each_kind_finds_its_threads() {
        for (k, (kind, ..)) in THREADS.into_iter().enumerate() {
            assert_eq!(kind as usize, k);
        }
    }

    #[test]
    fn words_do_not_wait_for_a_proof() {
        let (pool, (sender, receiver)) = (Pool::new(), unbounded());
        let (until, end) = unbounded::<()>();
        // it takes until the words are there
        pool.begin(TaskKind::Proof, move || assert!(end.recv().is_err()));
        pool.begin(TaskKind::Words, move || sender.send("words").expect("it is open"));
        assert_eq!(receiver.recv(), Ok("words"));
        drop(until);
    }
}
