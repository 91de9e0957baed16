//! The end of the interpreter. A thread that would take Python's lock then is ended by Python in the midst of what it does, with all that stands
//! on its stack, which is no end for what is written in Rust: it ends the process. So who comes back from work without the lock stays away.

use pyo3::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, ThreadId};
use std::time::Duration;

/// The thread that ends the interpreter, once that has begun.
static ENDS: OnceLock<ThreadId> = OnceLock::new();

/// How many threads work without the lock.
static AWAY: AtomicUsize = AtomicUsize::new(0);

/// Who was about to take the lock when the end began has it by then.
const GRACE: Duration = Duration::from_millis(10);

/// The interpreter is about to end; called by `atexit` on the thread that ends it.
#[pyfunction]
pub fn _end(py: Python<'_>) {
    if ENDS.set(thread::current().id()).is_ok() && AWAY.load(Ordering::SeqCst) > 0 {
        py.detach(|| thread::sleep(GRACE));
    }
}

/// Does some work without Python's lock.
pub fn away<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    AWAY.fetch_add(1, Ordering::SeqCst);
    let made = py.detach(|| {
        let made = work();
        stay_away_at_the_end();
        made
    });
    AWAY.fetch_sub(1, Ordering::SeqCst);
    made
}

/// Whether the end has begun.
pub fn has_begun() -> bool {
    ENDS.get().is_some()
}

/// To be called before the lock is taken: comes back unless the interpreter ends on another thread.
pub fn stay_away_at_the_end() {
    while ENDS.get().is_some_and(|thread| *thread != thread::current().id()) {
        thread::park();
    }
}
