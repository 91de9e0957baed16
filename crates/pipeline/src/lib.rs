//! The façade: stages from text to rows, each owned, cheap to clone, and free to go to another thread.
//!
//! ```text
//! Sources ──▶ Parsed ──check──▶ Checked ──compile──▶ Compiled ──run──▶ Run ──▶ rows
//! ```
//!
//! A stage reports its diagnostics and goes on with what is sound. The crate joins the crates below it; it opens no file, reads no clock and
//! writes to no terminal.

mod angles;
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
mod parameters;
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

pub use checked::{Checked, Choice};
pub use compiled::{Compiled, Redundant};
pub use controls::{Jog, Knob, size_of_unit};
pub use drag_handles::Crank;
pub use emit::RustOptions;
pub use evaluator::{Adjustable, Adjusting, AskedPlace, InputMotion};
pub use formula::{Formula, NAMES};
pub use initial_pose::Drawn;
pub use lowering::lowered;
pub use mechc_engine::sweep::SweptColumn;
pub use mechc_expr::math::Vectors;
pub use model_import::imported;
pub use options::{RunOptions, Stand};
pub use parameters::Settable;
pub use parsed::Parsed;
pub use queries::{Declaration, Interface};
pub use refinement::CurveTolerance;
pub use run::{Assembly, Run, StartReport};
pub use slider_range::Varied;
pub use sweep::{Sweep, SweepOptions, Variants, VaryOptions};
pub use times::{AskedTimes, seconds};
pub use tolerancing::{Affected, Deviation, Shown, Tolerance, Tolerancing, Verified};
pub use visualization::Seen;
