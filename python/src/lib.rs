//! `mechc._mechc`: the library's stages as Python sees them. Thin: what is computed is the library's; here stand the doors, what keeps
//! Python responsive while something is computed, and how results become arrays and Arrow streams.
//!
//! What a user calls is in `mechc/*.py`, with its documentation.

mod at;
mod ending;
mod errors;
mod evaluator;
mod exported;
mod files;
mod mechanism;
mod memory;
mod run;
mod stream;
mod sweep;
mod table;
mod tolerance;
mod waiting;
mod words;

use pyo3::prelude::*;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The module.
#[pymodule(gil_used = true)]
mod _mechc {
    #[pymodule_export]
    use super::at::{_at_again, At};
    #[pymodule_export]
    use super::ending::_end;
    #[pymodule_export]
    use super::evaluator::Evaluator;
    #[pymodule_export]
    use super::mechanism::Mechanism;
    #[pymodule_export]
    use super::sweep::Sweep;
    #[pymodule_export]
    use super::table::{Column, Table};

    use super::errors::Said;
    use super::{Bound, PyAnyMethods, PyModule, PyModuleMethods, PyResult, Python, pyfunction};
    use mechc::Sources;

    /// A time with its unit (s).
    #[pyfunction]
    fn seconds(py: Python<'_>, text: &str) -> PyResult<f64> {
        let mut sources = Sources::default();
        mechc::seconds("at", text, &mut sources).map_err(|why| Said::from(why).raised(py))
    }

    /// A message with options in Python's words.
    #[pyfunction]
    fn _in_python(text: &str) -> String {
        let diagnostic = mechc::Diagnostic::new(mechc::Code::E0706, text);
        super::words::in_python(&diagnostic).message
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.py().import("atexit")?.call_method1("register", (module.getattr("_end")?,))?;
        module.add("LARGEST_FILE", super::files::LARGEST)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
