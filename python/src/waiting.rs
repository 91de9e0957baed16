//! While something is computed Python goes on: no lock is held, and Ctrl-C is looked for.

use mechc::Cancel;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// So often Ctrl-C is looked for.
pub const LOOK: Duration = Duration::from_millis(50);

/// What a main thread has: deep texts are read by recursion.
const STACK: usize = 8 << 20;

/// Does some work on another thread; a signal that Python raises ends it early.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(&Cancel) -> T + Send) -> PyResult<T> {
    let cancel = Cancel::default();
    let mut signal = None;
    let done = py.detach(|| {
        thread::scope(|scope| {
            let (tell, told) = channel::<()>();
            let worker = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || {
                // dropped at its end, however that comes
                let _tell = tell;
                work(&cancel)
            });
            let worker = worker.map_err(|why| format!("no thread could be started: {why}"))?;
            while told.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if signal.is_none() {
                    signal = raised();
                    if signal.is_some() {
                        cancel.cancel();
                    }
                }
            }
            worker.join().map_err(|why| broken(&*why))
        })
    });
    match (signal, done) {
        (Some(signal), _) => Err(signal),
        (None, Ok(made)) => Ok(made),
        (None, Err(why)) => Err(PyRuntimeError::new_err(why)),
    }
}

/// A signal that Python raises, if there is one.
fn raised() -> Option<PyErr> {
    Python::attach(|py| Python::check_signals(py).err())
}

/// What is said of a worker that broke down, which none should.
fn broken(why: &(dyn Any + Send)) -> String {
    let text = why.downcast_ref::<&str>().copied().or_else(|| why.downcast_ref::<String>().map(String::as_str));
    format!("mechc broke down, which is a mistake of its own: {}", text.unwrap_or("no reason is known"))
}
