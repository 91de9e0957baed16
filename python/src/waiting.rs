//! While something is computed Python goes on: no lock is held, and Ctrl-C is looked for.

use crate::ending::{away, stay_away_at_the_end};
use mechc::Cancel;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// So often Ctrl-C is looked for.
pub const LOOK: Duration = Duration::from_millis(50);

/// So long work may take to end once it is not wanted any more: who pressed the keys has an answer a tenth of a second later. What goes on
/// for longer, as a proof that is under way, is left to end by itself.
const PATIENCE: Duration = Duration::from_millis(30);

/// What a main thread has: deep texts are read by recursion.
const STACK: usize = 8 << 20;

/// Does some work on another thread; a signal that Python raises ends it early.
pub fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
) -> PyResult<T> {
    let (cancel, (tell, told)) = (Cancel::default(), channel());
    let its_own = cancel.clone();
    let working = move || {
        // who waited may have gone
        let _ = tell.send(work(&its_own));
    };
    let worker = thread::Builder::new().stack_size(STACK).spawn(working);
    let worker = worker.map_err(|why| PyRuntimeError::new_err(format!("no thread could be started: {why}")))?;
    let done = away(py, move || {
        loop {
            match told.recv_timeout(LOOK) {
                Ok(made) => return Ok(Some(made)),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(signal) = raised() {
                        cancel.cancel();
                        let _ = told.recv_timeout(PATIENCE);
                        return Err(signal);
                    }
                }
            }
        }
    })?;
    done.ok_or_else(|| PyRuntimeError::new_err(worker.join().map_or_else(|why| broken(&*why), |()| broken(&""))))
}

/// A signal that Python raises, if there is one.
fn raised() -> Option<PyErr> {
    stay_away_at_the_end();
    Python::attach(|py| Python::check_signals(py).err())
}

/// What is said of a worker that broke down, which none should.
fn broken(why: &(dyn Any + Send)) -> String {
    let text = why.downcast_ref::<&str>().copied().or_else(|| why.downcast_ref::<String>().map(String::as_str));
    format!("mechc broke down, which is a mistake of its own: {}", text.unwrap_or("no reason is known"))
}
