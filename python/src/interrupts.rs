//! Long computations: they hold no lock of Python, and Ctrl-C cancels them.

use crate::exit::{detached, park_at_exit};
use mechc::Cancel;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Interval at which signals are checked.
pub const CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Longest wait for cancelled work to end, so that Ctrl-C responds within a tenth of a second. Work that takes longer, such as a proof, ends by
/// itself later.
const PATIENCE: Duration = Duration::from_millis(30);

/// Stack size, that of a main thread (bytes): nested texts are parsed by recursion.
const STACK: usize = 8 << 20;

/// Does work on another thread; a signal that Python raises cancels it.
pub fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
) -> PyResult<T> {
    let (cancel, (sender, receiver)) = (Cancel::default(), channel());
    let token = cancel.clone();
    let working = move || {
        // the receiver is dropped after a cancellation
        let _ = sender.send(work(&token));
    };
    let worker = thread::Builder::new().stack_size(STACK).spawn(working);
    let worker = worker.map_err(|why| PyRuntimeError::new_err(format!("no thread could be started: {why}")))?;
    let done = detached(py, move || {
        loop {
            match receiver.recv_timeout(CHECK_INTERVAL) {
                Ok(result) => return Ok(Some(result)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(signal) = pending_signal() {
                        cancel.cancel();
                        let _ = receiver.recv_timeout(PATIENCE);
                        return Err(signal);
                    }
                }
            }
        }
    })?;
    done.ok_or_else(|| {
        PyRuntimeError::new_err(worker.join().map_or_else(|why| panic_message(&*why), |()| panic_message(&"")))
    })
}

/// Returns the exception of a pending signal.
fn pending_signal() -> Option<PyErr> {
    park_at_exit();
    Python::attach(|py| Python::check_signals(py).err())
}

/// Returns the message for a panic of the worker.
fn panic_message(why: &(dyn Any + Send)) -> String {
    let text = why.downcast_ref::<&str>().copied().or_else(|| why.downcast_ref::<String>().map(String::as_str));
    format!("mechc broke down, which is a mistake of its own: {}", text.unwrap_or("no reason is known"))
}
