//! The exit of the interpreter. Python ends a thread that takes its lock then by unwinding the stack, which aborts the process in Rust code. So a
//! thread that returns from work without the lock is parked before it takes the lock.

use pyo3::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, ThreadId};
use std::time::Duration;

/// The thread on which the interpreter exits, once that has begun.
static EXITING: OnceLock<ThreadId> = OnceLock::new();

/// Number of threads that work without the lock.
static DETACHED: AtomicUsize = AtomicUsize::new(0);

/// Time after which a thread that was about to take the lock when the exit began holds it.
const GRACE: Duration = Duration::from_millis(10);

/// Records that the interpreter is about to exit; `atexit` calls it on the thread that exits.
#[pyfunction]
pub fn _at_exit(py: Python<'_>) {
    if EXITING.set(thread::current().id()).is_ok() && DETACHED.load(Ordering::SeqCst) > 0 {
        py.detach(|| thread::sleep(GRACE));
    }
}

/// Does work without Python's lock.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    DETACHED.fetch_add(1, Ordering::SeqCst);
    let result = py.detach(|| {
        let result = work();
        park_at_exit();
        result
    });
    DETACHED.fetch_sub(1, Ordering::SeqCst);
    result
}

/// Returns whether the exit has begun.
pub fn has_begun() -> bool {
    EXITING.get().is_some()
}

/// Parks the thread if the interpreter exits on another one; call it before taking the lock.
pub fn park_at_exit() {
    while EXITING.get().is_some_and(|thread| *thread != thread::current().id()) {
        thread::park();
    }
}
