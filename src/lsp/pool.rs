//! Threads for the work of requests and stages.

use crossbeam_channel::{Sender, unbounded};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// Stack of a thread (bytes): as much as a program's first one has.
const STACK: usize = 8 << 20;

/// As many threads for requests and quick stages; one more follows motions, which take long.
const THREADS: usize = 2;

type Work = Box<dyn FnOnce() + Send>;

/// Where work is handed in.
pub(super) struct Pool {
    quick: Sender<Work>,
    slow: Sender<Work>,
}

impl Pool {
    /// Begins with its threads; they end when it is dropped and their work is done.
    pub fn new() -> Pool {
        Pool { quick: workers("quick", THREADS), slow: workers("slow", 1) }
    }

    /// What somebody waits for.
    pub fn soon(&self, work: impl FnOnce() + Send + 'static) {
        // the threads are there as long as their channel
        let _ = self.quick.send(Box::new(work));
    }

    /// What may take long.
    pub fn later(&self, work: impl FnOnce() + Send + 'static) {
        let _ = self.slow.send(Box::new(work));
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
    use super::{Pool, caught};
    use crossbeam_channel::unbounded;

    #[test]
    fn a_panic_is_told_and_the_next_work_is_done() {
        let (pool, (sender, receiver)) = (Pool::new(), unbounded());
        for k in 0..10 {
            let sender = sender.clone();
            pool.soon(move || {
                let told = caught(|| assert!(k % 2 == 0, "odd {k}")).err();
                sender.send((k, told)).expect("it is open");
            });
        }
        let mut told: Vec<_> = receiver.iter().take(10).collect();
        told.sort();
        assert_eq!(told[3], (3, Some("odd 3".to_owned())));
        assert_eq!(told.iter().filter(|(_, told)| told.is_none()).count(), 5);
    }
}
