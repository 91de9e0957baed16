//! A sweep while it is read. A thread of its own computes its blocks with others and takes them; who reads waits for them, holds no lock of
//! Python meanwhile, and looks for Ctrl-C, where signals are its concern.
//!
//! Threads do not come along when a process forks. A reader that finds itself in another process begins anew with the variant that is next.

use super::block::{Block, Gathered};
use super::{Summary, Whole};
use crate::ending::{away, stay_away_at_the_end};
use crate::memory::{self, Of};
use crate::table::{Values, batch};
use crate::waiting::LOOK;
use arrow_array::{RecordBatch, RecordBatchReader};
use arrow_schema::{ArrowError, SchemaRef};
use mechc::{Cancel, SweepOptions};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::thread::{self, JoinHandle, ThreadId};
use std::time::{Duration, Instant};

/// A batch has at least so many rows, or numbers, if that many come: few large batches are read faster than many small ones, and a block that is
/// large by itself needs no copy.
const ROWS: usize = 1 << 13;
const NUMBERS: usize = 1 << 17;

/// Who waits for another one that reads looks again after this.
const TURN: Duration = Duration::from_millis(1);

/// Blocks that wait to be read, beside the one that is done: none, for each that is in use takes another's place in the processor's memory.
const AHEAD: usize = 0;

/// What is read, and where it is told what became of it.
pub struct Source {
    pub whole: Arc<Whole>,
    pub summary: Arc<Mutex<Summary>>,
}

/// A stream in progress.
pub struct Reader {
    source: Source,
    /// Called with how many variants are done, and how many there are.
    progress: Option<Py<PyAny>>,
    told: Instant,
    pump: Option<Pump>,
    /// The next variant.
    next: u64,
    has_ended: bool,
    /// On this thread Python may be asked for signals: it has asked for the stream.
    reads_on: ThreadId,
}

/// The thread that takes blocks, one of those that compute them.
struct Pump {
    blocks: Receiver<Block>,
    cancel: Cancel,
    thread: JoinHandle<()>,
    /// The process that it belongs to.
    process: u32,
}

impl Pump {
    /// Takes the blocks from a variant on.
    fn start(whole: &Arc<Whole>, from: u64) -> Result<Pump, PyErr> {
        let cancel = Cancel::default();
        let [_, last] = whole.range;
        let options =
            SweepOptions { skip: from, take: Some(last - from), cancel: cancel.clone(), ..whole.options.clone() };
        let units = whole.units.clone();
        let make = move |swept| Block::of(swept, units.as_deref());
        let sweep = whole.checked.sweep(&whole.compiled, &whole.variants, &options, make);
        let sweep = sweep.map_err(|why| PyRuntimeError::new_err(why.to_string()))?;
        let (tell, blocks) = sync_channel(AHEAD);
        let pump = move || {
            for block in sweep {
                if tell.send(block).is_err() {
                    break;
                }
            }
        };
        let thread = thread::Builder::new().spawn(pump).map_err(|why| PyRuntimeError::new_err(why.to_string()))?;
        Ok(Pump { blocks, cancel, thread, process: std::process::id() })
    }

    /// Ends it, and waits for that; what another process has left behind is left alone. Whether it has not broken down.
    fn end(self) -> bool {
        let Pump { blocks, cancel, thread, process } = self;
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
        let [next, _] = source.whole.range;
        let (pump, has_ended, reads_on) = (None, false, thread::current().id());
        Reader { source, progress, told: Instant::now(), pump, next, has_ended, reads_on }
    }

    /// All that is left, as columns.
    pub fn all(&mut self, py: Python<'_>) -> PyResult<Vec<Values>> {
        let (mut gathered, whole) = (Gathered::new(&self.source.whole), Arc::clone(&self.source.whole));
        let (most, columns) = whole.size();
        // one that may end early has as many rows as it comes to
        if !whole.has_until {
            memory::refuse_beyond(py, (most, columns), Of::Sweep)?;
            gathered.reserve(most).map_err(|_| memory::too_large(py, (most, columns), Of::Sweep))?;
        }
        let mut looked_at = 0;
        while let Some(block) = away(py, || self.block())? {
            gathered.add(block).map_err(|_| memory::too_large(py, (gathered.rows as u64, columns), Of::Sweep))?;
            if whole.has_until && gathered.rows > 2 * looked_at {
                // as much again is to fit
                looked_at = gathered.rows;
                memory::refuse_beyond(py, (looked_at as u64, columns), Of::Sweep)?;
            }
        }
        Ok(gathered.values())
    }

    /// The next block; nothing behind the last one.
    fn block(&mut self) -> PyResult<Option<Block>> {
        let [first, last] = self.source.whole.range;
        if self.has_ended || self.next >= last {
            self.end();
            return Ok(None);
        }
        if self.pump.as_ref().is_none_or(|pump| pump.process != std::process::id()) {
            let old = self.pump.replace(Pump::start(&self.source.whole, self.next)?);
            if let Some(old) = old {
                old.end();
            }
        }
        loop {
            let Some(pump) = &self.pump else { return Ok(None) };
            match pump.blocks.recv_timeout(LOOK) {
                Ok(block) => {
                    self.take_note(&block);
                    self.tell(first, last)?;
                    return Ok(Some(block));
                }
                Err(RecvTimeoutError::Timeout) => self.look_for_signals()?,
                Err(RecvTimeoutError::Disconnected) => {
                    let is_sound = self.end();
                    // it ends early behind a variant that is looked for, and never otherwise
                    return if self.source.whole.has_until && is_sound {
                        Ok(None)
                    } else {
                        let said = format!("mechc broke down at variant {}, which is a mistake of its own", self.next);
                        Err(PyRuntimeError::new_err(said))
                    };
                }
            }
        }
    }

    fn take_note(&mut self, block: &Block) {
        let mut summary = self.source.summary.lock().unwrap_or_else(PoisonError::into_inner);
        for (number, status) in (block.first..).zip(&block.statuses) {
            summary.entry(status.as_str()).or_insert((0, number)).0 += 1;
        }
        self.next += block.statuses.len() as u64;
    }

    /// Whether Python may be asked for something on this thread: another one may wait for this one while it holds the lock.
    fn may_ask(&self) -> bool {
        thread::current().id() == self.reads_on
    }

    fn look_for_signals(&mut self) -> PyResult<()> {
        if !self.may_ask() {
            return Ok(());
        }
        stay_away_at_the_end();
        let signal = Python::try_attach(|py| py.check_signals().err()).flatten();
        match signal {
            None => Ok(()),
            Some(signal) => {
                self.end();
                Err(signal)
            }
        }
    }

    /// Tells how far it is, not more often than anybody can see.
    fn tell(&mut self, first: u64, last: u64) -> PyResult<()> {
        if !self.may_ask() || (self.told.elapsed() < LOOK && self.next < last) {
            return Ok(());
        }
        self.told = Instant::now();
        let (done, all) = (self.next - first, last - first);
        let progress = &self.progress;
        stay_away_at_the_end();
        let told = Python::try_attach(|py| {
            py.check_signals()?;
            progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (done, all)).map(|_| ()))
        });
        let told = told.unwrap_or(Ok(()));
        if told.is_err() {
            self.end();
        }
        told
    }

    /// Ends it; whether nothing has broken down.
    fn end(&mut self) -> bool {
        self.has_ended = true;
        self.pump.take().is_none_or(Pump::end)
    }

    /// The next batch.
    fn batch(&mut self) -> Option<PyResult<RecordBatch>> {
        let mut gathered = Gathered::new(&self.source.whole);
        let width = self.source.whole.heads.len();
        while gathered.rows < ROWS && gathered.rows * width < NUMBERS {
            match self.block() {
                Ok(Some(block)) => {
                    if gathered.add(block).is_err() {
                        let size = (gathered.rows as u64, width);
                        stay_away_at_the_end();
                        return Python::try_attach(|py| Err(memory::too_large(py, size, Of::Block)));
                    }
                }
                Ok(None) => break,
                Err(why) => return Some(Err(why)),
            }
        }
        if gathered.rows == 0 {
            return None;
        }
        let gaps = std::mem::take(&mut gathered.gaps);
        let made = batch(&self.source.whole.schema, &gathered.values(), &gaps);
        Some(made.map_err(|why| PyRuntimeError::new_err(why.to_string())))
    }
}

/// A reader as Arrow's stream. Arrow asks of who reads one to do so by one thread at a time, which not all keep to: whoever comes while
/// another one reads waits, and holds no lock of Python meanwhile.
pub struct InTurns {
    reader: Mutex<Reader>,
    schema: SchemaRef,
}

impl InTurns {
    pub fn new(reader: Reader) -> InTurns {
        let schema = Arc::clone(&reader.source.whole.schema);
        InTurns { reader: Mutex::new(reader), schema }
    }
}

impl Iterator for InTurns {
    type Item = Result<RecordBatch, ArrowError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut reader = loop {
            match self.reader.try_lock() {
                Ok(reader) => break reader,
                Err(TryLockError::Poisoned(poisoned)) => break poisoned.into_inner(),
                Err(TryLockError::WouldBlock) => {
                    stay_away_at_the_end();
                    Python::try_attach(|py| away(py, || thread::sleep(TURN)));
                }
            }
        };
        reader.batch().map(|batch| batch.map_err(told))
    }
}

impl RecordBatchReader for InTurns {
    fn schema(&self) -> SchemaRef {
        Arc::clone(&self.schema)
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.end();
    }
}

/// Who reads a stream is told in words; a signal is raised once more, for the interpreter to tell it itself.
fn told(why: PyErr) -> ArrowError {
    stay_away_at_the_end();
    let text = Python::try_attach(|py| {
        if why.is_instance_of::<pyo3::exceptions::PyKeyboardInterrupt>(py) {
            let again = py.import("_thread").and_then(|thread| thread.call_method0("interrupt_main"));
            return if again.is_ok() { "interrupted".to_owned() } else { why.to_string() };
        }
        why.to_string()
    });
    ArrowError::ExternalError(text.unwrap_or_else(|| "interrupted".to_owned()).into())
}
