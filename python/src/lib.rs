//! `mechc._mechc`: binds the library to Python. It converts arguments and results, the latter to arrays and Arrow streams, and releases
//! Python's lock during computations, which Ctrl-C interrupts. It computes nothing itself.
//!
//! The public interface is in `mechc/*.py`, with its documentation.

mod at;
mod errors;
mod evaluator;
mod exit;
mod export;
mod files;
mod interrupts;
mod mechanism;
mod memory;
mod option_spelling;
mod run;
mod stream;
mod sweep;
mod table;
mod tolerance;

use pyo3::prelude::*;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The module.
#[pymodule(gil_used = true)]
mod _mechc {
    #[pymodule_export]
    use super::at::{_unpickle_at, At};
    #[pymodule_export]
    use super::evaluator::Evaluator;
    #[pymodule_export]
    use super::exit::_at_exit;
    #[pymodule_export]
    use super::mechanism::Mechanism;
    #[pymodule_export]
    use super::sweep::Sweep;
    #[pymodule_export]
    use super::table::{Column, Table};

    use super::errors::Report;
    use super::{Bound, PyAnyMethods, PyModule, PyModuleMethods, PyResult, Python, pyfunction};
    use mechc::Sources;

    /// A time with its unit (s).
    #[pyfunction]
    fn seconds(py: Python<'_>, text: &str) -> PyResult<f64> {
        let mut sources = Sources::default();
        mechc::seconds("at", text, &mut sources).map_err(|why| Report::from(why).to_exception(py))
    }

    /// Returns a message with options spelled as in Python.
    #[pyfunction]
    fn _in_python(text: &str) -> String {
        let diagnostic = mechc::Diagnostic::new(mechc::Code::E0706, text);
        super::option_spelling::in_python(&diagnostic).message
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.py().import("atexit")?.call_method1("register", (module.getattr("_at_exit")?,))?;
        module.add("LARGEST_FILE", super::files::LARGEST)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
