//! The way of a text in owned stages: each can be kept, cloned for little, sent to another thread, and gives the next one.
//!
//! ```text
//! Sources ──▶ Parsed ──check──▶ Checked ──compile──▶ Compiled ──run──▶ Run ──▶ rows
//! ```
//!
//! None stops the ones after it from speaking of what is whole. What is to be said of a stage is on it, or comes beside it.

mod abreast;
mod adjustable;
mod again;
mod angles;
mod asked;
mod beside;
mod checked;
mod chosen;
mod compiled;
mod constant;
mod cranks;
mod drawn;
mod emitted;
mod families;
mod formula;
mod imported;
mod knobs;
mod known;
mod lead;
mod lines;
mod lowered;
mod options;
pub mod output;
mod outputs;
mod over;
mod own;
mod parsed;
mod refinement;
mod run;
mod seen;
mod settable;
mod sweep;
mod times;
mod tolerance;
mod tolerancing;
mod used;
mod used_at;
mod varied;
mod vary;

pub use adjustable::{Adjustable, Adjusting, AskedPlace, InputMotion};
pub use checked::{Checked, Choice};
pub use compiled::{Compiled, Redundant};
pub use constant::seconds;
pub use cranks::Crank;
pub use drawn::Drawn;
pub use emitted::RustOptions;
pub use formula::{Formula, NAMES};
pub use imported::imported;
pub use knobs::{Jog, Knob, size_of_unit};
pub use known::{Declaration, Interface};
pub use lowered::lowered;
pub use mechc_engine::sweep::SweptColumn;
pub use mechc_expr::math::Vectors;
pub use options::{RunOptions, Stand};
pub use parsed::Parsed;
pub use refinement::CurveTolerance;
pub use run::{Assembly, Run};
pub use seen::Seen;
pub use settable::Settable;
pub use sweep::{Sweep, SweepOptions};
pub use times::AskedTimes;
pub use tolerance::{Affected, Deviation, Shown, Tolerance, Verified};
pub use tolerancing::Tolerancing;
pub use varied::Varied;
pub use vary::{Variants, VaryOptions};
