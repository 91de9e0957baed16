//! Refuses computations whose rows do not fit into memory before they begin. Limits and messages are in `mechc/memory.py`.

use pyo3::prelude::*;

/// Rows up to this size are not checked (bytes).
const SMALL: u64 = 64 << 20;

/// The computation that rows belong to; the help of messages depends on it.
#[derive(Clone, Copy)]
pub enum Computation {
    Run,
    Sweep,
    /// The variants that a sweep computes at once.
    Block,
    At,
}

impl Computation {
    fn name(self) -> &'static str {
        match self {
            Computation::Run => "run",
            Computation::Sweep => "sweep",
            Computation::Block => "block",
            Computation::At => "at",
        }
    }
}

/// Refuses rows of numbers that do not fit into the memory that is free.
pub fn refuse_beyond(py: Python<'_>, (rows, columns): (u64, usize), computation: Computation) -> PyResult<()> {
    if rows.saturating_mul(columns as u64).saturating_mul(8) > SMALL {
        py.import("mechc.memory")?.getattr("refuse_beyond")?.call1((rows, columns, computation.name()))?;
    }
    Ok(())
}

/// Returns the exception for rows of numbers that do not fit into memory.
pub fn too_large(py: Python<'_>, (rows, columns): (u64, usize), computation: Computation) -> PyErr {
    let made = py.import("mechc.memory").and_then(|memory| memory.getattr("too_large"));
    match made.and_then(|made| made.call1((rows, columns, computation.name()))) {
        Ok(why) => PyErr::from_value(why),
        Err(why) => why,
    }
}
