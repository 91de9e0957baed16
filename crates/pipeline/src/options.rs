//! Options of a run, and the configurations that a mechanism may have.

use mechc_engine::analysis::TOLERANCE;
use mechc_expr::math::Vectors;
use mechc_text::cancel::Cancel;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Tolerance of each row of Φ, scaled.
    pub tolerance: f64,
    /// True if a motion continues beyond bifurcations, along the smooth branch, with a warning each time.
    pub pass_bifurcations: bool,
    /// The vector instructions of the solver; they change no bit.
    pub vectors: Vectors,
    /// Cancels the run.
    pub cancel: Cancel,
}

/// The configuration of a mechanism at a time.
#[derive(Clone, PartialEq, Debug)]
pub struct Configuration {
    /// Time (s).
    pub t: f64,
    /// Coordinates [m, rad].
    pub q: Vec<f64>,
}

impl Default for RunOptions {
    fn default() -> RunOptions {
        RunOptions {
            tolerance: TOLERANCE,
            pass_bifurcations: false,
            vectors: Vectors::default(),
            cancel: Cancel::default(),
        }
    }
}

/// Returns a name in normal form without white space.
pub(crate) fn spaceless(name: &str) -> String {
    mechc_syntax::normalized(name).chars().filter(|c| !c.is_whitespace()).collect()
}
