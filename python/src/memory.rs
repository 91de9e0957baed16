//! What does not fit into memory is refused before it is begun; how much there is, and what is said, is in `mechc/memory.py`.

use pyo3::prelude::*;

/// What is smaller is not looked at (bytes).
const SMALL: u64 = 64 << 20;

/// What rows are of, as messages tell what to do instead.
#[derive(Clone, Copy)]
pub enum Of {
    Run,
    Sweep,
    /// The variants that a sweep computes side by side.
    Block,
    At,
}

impl Of {
    fn name(self) -> &'static str {
        match self {
            Of::Run => "run",
            Of::Sweep => "sweep",
            Of::Block => "block",
            Of::At => "at",
        }
    }
}

/// Refuses rows of numbers that do not fit into the memory that is free.
pub fn refuse_beyond(py: Python<'_>, (rows, columns): (u64, usize), of: Of) -> PyResult<()> {
    if rows.saturating_mul(columns as u64).saturating_mul(8) > SMALL {
        py.import("mechc.memory")?.getattr("refuse_beyond")?.call1((rows, columns, of.name()))?;
    }
    Ok(())
}

/// That rows of numbers do not fit.
pub fn too_large(py: Python<'_>, (rows, columns): (u64, usize), of: Of) -> PyErr {
    let made = py.import("mechc.memory").and_then(|room| room.getattr("too_large"));
    match made.and_then(|made| made.call1((rows, columns, of.name()))) {
        Ok(why) => PyErr::from_value(why),
        Err(why) => why,
    }
}
