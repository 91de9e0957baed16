//! How a motion is followed.

use mechc_engine::analysis::TOLERANCE;
use mechc_expr::math::Vectors;
use mechc_text::cancel::Cancel;

/// How a motion is followed.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Bounds each row of Φ, scaled.
    pub tolerance: f64,
    /// Go on beyond bifurcations, along the branch that continues smoothly, with a remark each time.
    pub pass_bifurcations: bool,
    /// Where a mechanism that is told its inputs is led from; its own start if nothing is said.
    pub stand: Option<Stand>,
    /// The vector instructions that rows are solved for with, which change no bit.
    pub vectors: Vectors,
    /// Ends it.
    pub cancel: Cancel,
}

/// Where a mechanism stands at a time.
#[derive(Clone, PartialEq, Debug)]
pub struct Stand {
    /// When (s).
    pub t: f64,
    /// Its coordinates [m, rad].
    pub q: Vec<f64>,
}

impl Default for RunOptions {
    fn default() -> RunOptions {
        RunOptions {
            tolerance: TOLERANCE,
            pass_bifurcations: false,
            stand: None,
            vectors: Vectors::default(),
            cancel: Cancel::default(),
        }
    }
}
