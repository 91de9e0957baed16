//! Reads a sweep. A producer thread collects the blocks that it computes with others. The reader waits for them without Python's lock, and
//! checks for Ctrl-C on the thread that opened the stream.
//!
//! Threads do not survive a fork. A reader in a forked process starts a new producer with the next variant.

use super::block::{Block, JoinedBlocks};
use super::{Summary, SweepPlan};
use crate::exit::{detached, park_at_exit};
use crate::interrupts::CHECK_INTERVAL;
use crate::memory::{self, Computation};
use crate::table::{Values, batch};
use arrow_array::{RecordBatch, RecordBatchReader};
use arrow_schema::{ArrowError, SchemaRef};
use mechc::{Cancel, SweepOptions};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::thread::{self, JoinHandle, ThreadId};
use std::time::{Duration, Instant};

/// Least number of rows or numbers of a batch that is not the last: few large batches are read faster than many small ones. A block that is
/// large by itself needs no copy.
const ROWS: usize = 1 << 13;
const NUMBERS: usize = 1 << 17;

/// Interval at which a thread tries interrupted while another one reads.
const RETRY_INTERVAL: Duration = Duration::from_millis(1);

/// Number of finished blocks that wait beside the one being sent: none, as more would displace others from the processor's cache.
const AHEAD: usize = 0;

/// The sweep that is read, and the summary that the reader fills.
pub struct Source {
    pub plan: Arc<SweepPlan>,
    pub summary: Arc<Mutex<Summary>>,
}

/// A stream in progress.
pub struct Reader {
    source: Source,
    /// Called with the number of variants that are done, and that of all.
    progress: Option<Py<PyAny>>,
    last_report: Instant,
    producer: Option<Producer>,
    /// The next variant.
    next: u64,
    has_ended: bool,
    /// The thread that opened the stream; only there signals are checked and progress is reported.
    opened_on: ThreadId,
}

/// The thread that collects blocks, one of those that compute them.
struct Producer {
    blocks: Receiver<Block>,
    cancel: Cancel,
    thread: JoinHandle<()>,
    /// The process that it belongs to.
    process: u32,
}

impl Producer {
    /// Starts a thread that collects the blocks from a variant on.
    fn start(plan: &Arc<SweepPlan>, from: u64) -> Result<Producer, PyErr> {
        let cancel = Cancel::default();
        let [_, last] = plan.range;
        let options =
            SweepOptions { skip: from, take: Some(last - from), cancel: cancel.clone(), ..plan.options.clone() };
        let units = plan.units.clone();
        let make = move |swept| Block::new(swept, units.as_deref());
        let sweep = plan.checked.sweep(&plan.compiled, &plan.variants, &options, make);
        let sweep = sweep.map_err(|why| PyRuntimeError::new_err(why.to_string()))?;
        let (sender, blocks) = sync_channel(AHEAD);
        let producer = move || {
            for block in sweep {
                if sender.send(block).is_err() {
                    break;
                }
            }
        };
        let thread = thread::Builder::new().spawn(producer).map_err(|why| PyRuntimeError::new_err(why.to_string()))?;
        Ok(Producer { blocks, cancel, thread, process: std::process::id() })
    }

    /// Cancels the thread and joins it; returns whether it did not panic. Handles that a fork copied are leaked.
    fn end(self) -> bool {
        let Producer { blocks, cancel, thread, process } = self;
        if process == std::process::id() {
            cancel.cancel();
            drop(blocks);
            thread.join().is_ok()
        } else {
            std::mem::forget((blocks, cancel, thread));
            true
        }
    }
}

impl Reader {
    pub fn new(source: Source, progress: Option<Py<PyAny>>) -> Reader {
        let [next, _] = source.plan.range;
        let (producer, has_ended, opened_on) = (None, false, thread::current().id());
        Reader { source, progress, last_report: Instant::now(), producer, next, has_ended, opened_on }
    }

    /// Reads all remaining variants as columns.
    pub fn all(&mut self, py: Python<'_>) -> PyResult<Vec<Values>> {
        let (mut joined, plan) = (JoinedBlocks::new(&self.source.plan), Arc::clone(&self.source.plan));
        let (most, columns) = plan.size();
        // a sweep that may end early is checked as it grows
        if !plan.has_until {
            memory::refuse_beyond(py, (most, columns), Computation::Sweep)?;
            joined.reserve(most).map_err(|_| memory::too_large(py, (most, columns), Computation::Sweep))?;
        }
        let mut checked = 0;
        while let Some(block) = detached(py, || self.block())? {
            joined.add(block).map_err(|_| memory::too_large(py, (joined.rows as u64, columns), Computation::Sweep))?;
            if plan.has_until && joined.rows > 2 * checked {
                // the next check is at twice the size
                checked = joined.rows;
                memory::refuse_beyond(py, (checked as u64, columns), Computation::Sweep)?;
            }
        }
        Ok(joined.values())
    }

    /// Returns the next block; `None` behind the last one.
    fn block(&mut self) -> PyResult<Option<Block>> {
        let [first, last] = self.source.plan.range;
        if self.has_ended || self.next >= last {
            self.end();
            return Ok(None);
        }
        if self.producer.as_ref().is_none_or(|producer| producer.process != std::process::id()) {
            let old = self.producer.replace(Producer::start(&self.source.plan, self.next)?);
            if let Some(old) = old {
                old.end();
            }
        }
        loop {
            let Some(producer) = &self.producer else { return Ok(None) };
            match producer.blocks.recv_timeout(CHECK_INTERVAL) {
                Ok(block) => {
                    self.count_statuses(&block);
                    self.report_progress(first, last)?;
                    return Ok(Some(block));
                }
                Err(RecvTimeoutError::Timeout) => self.check_signals()?,
                Err(RecvTimeoutError::Disconnected) => {
                    let is_sound = self.end();
                    // only a sweep that ends behind a variant with a condition ends early
                    return if self.source.plan.has_until && is_sound {
                        Ok(None)
                    } else {
                        let message =
                            format!("mechc broke down at variant {}, which is a mistake of its own", self.next);
                        Err(PyRuntimeError::new_err(message))
                    };
                }
            }
        }
    }

    fn count_statuses(&mut self, block: &Block) {
        let mut summary = self.source.summary.lock().unwrap_or_else(PoisonError::into_inner);
        for (number, status) in (block.first..).zip(&block.statuses) {
            summary.entry(status.as_str()).or_insert((0, number)).0 += 1;
        }
        self.next += block.statuses.len() as u64;
    }

    /// Returns whether the lock may be taken: another thread may hold it while it waits for this one.
    fn may_take_lock(&self) -> bool {
        thread::current().id() == self.opened_on
    }

    fn check_signals(&mut self) -> PyResult<()> {
        if !self.may_take_lock() {
            return Ok(());
        }
        park_at_exit();
        let signal = Python::try_attach(|py| py.check_signals().err()).flatten();
        match signal {
            None => Ok(()),
            Some(signal) => {
                self.end();
                Err(signal)
            }
        }
    }

    /// Reports progress, at most once per [`CHECK_INTERVAL`] before the end.
    fn report_progress(&mut self, first: u64, last: u64) -> PyResult<()> {
        if !self.may_take_lock() || (self.last_report.elapsed() < CHECK_INTERVAL && self.next < last) {
            return Ok(());
        }
        self.last_report = Instant::now();
        let (done, all) = (self.next - first, last - first);
        let progress = &self.progress;
        park_at_exit();
        let called = Python::try_attach(|py| {
            py.check_signals()?;
            progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (done, all)).map(|_| ()))
        });
        let called = called.unwrap_or(Ok(()));
        if called.is_err() {
            self.end();
        }
        called
    }

    /// Ends the sweep; returns whether no thread panicked.
    fn end(&mut self) -> bool {
        self.has_ended = true;
        self.producer.take().is_none_or(Producer::end)
    }

    /// Returns the next batch; `None` at the end.
    fn batch(&mut self) -> Option<PyResult<RecordBatch>> {
        let mut joined = JoinedBlocks::new(&self.source.plan);
        let width = self.source.plan.headers.len();
        while joined.rows < ROWS && joined.rows * width < NUMBERS {
            match self.block() {
                Ok(Some(block)) => {
                    if joined.add(block).is_err() {
                        let size = (joined.rows as u64, width);
                        park_at_exit();
                        return Python::try_attach(|py| Err(memory::too_large(py, size, Computation::Block)));
                    }
                }
                Ok(None) => break,
                Err(why) => return Some(Err(why)),
            }
        }
        if joined.rows == 0 {
            return None;
        }
        let gaps = std::mem::take(&mut joined.gaps);
        let made = batch(&self.source.plan.schema, &joined.values(), &gaps);
        Some(made.map_err(|why| PyRuntimeError::new_err(why.to_string())))
    }
}

/// A reader as an Arrow stream. Arrow requires callers to read from one thread at a time, which not all obey: a second thread waits without
/// Python's lock until the first is done.
pub struct SharedReader {
    reader: Mutex<Reader>,
    schema: SchemaRef,
}

impl SharedReader {
    pub fn new(reader: Reader) -> SharedReader {
        let schema = Arc::clone(&reader.source.plan.schema);
        SharedReader { reader: Mutex::new(reader), schema }
    }
}

impl Iterator for SharedReader {
    type Item = Result<RecordBatch, ArrowError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut reader = loop {
            match self.reader.try_lock() {
                Ok(reader) => break reader,
                Err(TryLockError::Poisoned(poisoned)) => break poisoned.into_inner(),
                Err(TryLockError::WouldBlock) => {
                    park_at_exit();
                    Python::try_attach(|py| detached(py, || thread::sleep(RETRY_INTERVAL)));
                }
            }
        };
        reader.batch().map(|batch| batch.map_err(to_arrow_error))
    }
}

impl RecordBatchReader for SharedReader {
    fn schema(&self) -> SchemaRef {
        Arc::clone(&self.schema)
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.end();
    }
}

/// Converts an exception to an error of Arrow, which is only text; a keyboard interrupt is raised interrupted in the interpreter.
fn to_arrow_error(why: PyErr) -> ArrowError {
    park_at_exit();
    let text = Python::try_attach(|py| {
        if why.is_instance_of::<pyo3::exceptions::PyKeyboardInterrupt>(py) {
            let interrupted = py.import("_thread").and_then(|thread| thread.call_method0("interrupt_main"));
            return if interrupted.is_ok() { "interrupted".to_owned() } else { why.to_string() };
        }
        why.to_string()
    });
    ArrowError::ExternalError(text.unwrap_or_else(|| "interrupted".to_owned()).into())
}
