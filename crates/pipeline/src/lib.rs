//! The façade: stages from text to rows, each owned, cheap to clone, and free to go to another thread.
//!
//! ```text
//! Sources ──▶ Parsed ──check──▶ Checked ──compile──▶ Compiled ──run──▶ Run ──▶ rows
//! ```
//!
//! A stage reports its diagnostics and goes on with what is sound. The crate joins the crates below it; it opens no file, reads no clock and
//! writes to no terminal.

mod batch;
mod checked;
mod column_selection;
mod compiled;
mod continuation;
mod controls;
mod drag_handles;
mod emit;
mod evaluator;
mod faulty_outputs;
mod formula;
mod imports;
mod initial_pose;
mod lowering;
mod model_import;
mod option_reader;
mod options;
pub mod output;
mod param_table;
mod parameters;
mod parametric;
mod parsed;
mod part_backtrace;
mod queries;
mod refinement;
mod run;
mod slider_range;
mod sweep;
mod times;
mod tolerancing;
mod visualization;

pub use checked::{Checked, Choice, Requirements};
pub use compiled::{Compiled, Redundant};
pub use controls::{InputControl, ParamControl, size_of_unit};
pub use drag_handles::DragHandle;
pub use emit::RustOptions;
pub use evaluator::{EvaluationPoint, EvaluatorOptions, InputMotion, MechanismEvaluator, NotReached};
pub use formula::{Formula, NAMES};
pub use initial_pose::InitialPose;
pub use lowering::lower_model;
pub use mechc_engine::sweep::SweptColumn;
pub use mechc_expr::math::Vectors;
pub use model_import::import_model;
pub use options::{Configuration, RunOptions};
pub use parameters::SettableParam;
pub use parametric::ParametricMechanism;
pub use parsed::Parsed;
pub use queries::{Declaration, Interface};
pub use refinement::CurveTolerance;
pub use run::{Assembly, Run, StartReport};
pub use slider_range::SliderRange;
pub use sweep::{Sweep, SweepOptions, Variants, VaryOptions};
pub use times::{RequestedTimes, seconds};
pub use tolerancing::{CornerReport, Deviation, DisplayUnit, OutputSensitivity, Tolerance, Tolerancing};
pub use visualization::Visualization;
