//! `mechc` compiles `.mech` files: planar mechanisms, described by bodies, joints and drivers.
//!
//! ```text
//! Sources ──▶ Parsed ──check──▶ Checked ──compile──▶ Compiled ──run──▶ Run ──▶ rows
//! ```
//!
//! Each stage is owned, can be sent to another thread, and is cheap to clone. A stage that can go on returns what it made with all
//! [`Diagnostics`], which [`render()`] formats; all else fails with an [`Error`], which holds diagnostics and the texts that they point into.
//!
//! ```
//! use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
//!
//! let parsed = Parsed::new("disc.mech", "
//!     mechanism disc {
//!         ground { point O = (0, 0) }
//!         body wheel { point O = (0, 0) }
//!         joint axle: revolute(ground.O, wheel.O)
//!         driver motor: rotation(axle) = 90 deg/s * t
//!     }");
//! let checked = parsed.check(&Choice::default(), &Memory::default());
//! assert!(checked.diagnostics().is_empty());
//! let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
//! let compiled = compiled.expect("it is determined");
//! let (run, _) = compiled.run(&Times::listed(0.0, vec![1.0]), &RunOptions::default());
//! let row = run.expect("it assembles").next().expect("a row").expect("it moves");
//! assert_eq!(compiled.columns()[3], "wheel.phi");
//! assert_eq!(row[3], std::f64::consts::FRAC_PI_2);
//! ```
//!
//! `ARCHITECTURE.md` describes the crates behind it, and what each must not depend on.

#[cfg(feature = "cli")]
pub mod cli;

pub use mechc_emit::{CrateFile, MARK, NOT_IN_ALL};
pub use mechc_engine::analysis::{Answers, TOLERANCE, Times};
pub use mechc_engine::sweep::{Levels, Method, Numbers, Points, Sampling, Status, Swept, Varying};
pub use mechc_ir::layout::ColumnUnit;
pub use mechc_lang::check::{DeclaredName, Meaning, NameId, NameKind, Symbols, Use};
#[cfg(feature = "live")]
pub use mechc_live::page::{picture, render as page};
pub use mechc_pipeline::output::{TableFormat, TableWriter};
pub use mechc_pipeline::{
    Assembly, Checked, Choice, Compiled, CornerReport, CurveTolerance, Deviation, DisplayUnit, EvaluationPoint,
    EvaluatorOptions, Formula, InputMotion, MechanismEvaluator, OutputSensitivity, Parsed, Redundant, RequestedTimes,
    Requirements, Run, RunOptions, RustOptions, SettableParam, Sweep, SweepOptions, SweptColumn, Tolerance,
    Tolerancing, Variants, VaryOptions, Vectors, Visualization, import_model, seconds,
};
pub use mechc_syntax::{Comment, Trivia};
pub use mechc_text::cancel::Cancel;
pub use mechc_text::diag::{
    Applicability, Code, Color, Diagnostic, Diagnostics, Edit, Error, ErrorKind, Fix, Format, Label, OptionText,
    Severity, fixed, render,
};
pub use mechc_text::source::{Encoding, FileId, Source, Sources, Span};
pub use mechc_text::vocabulary::{Category, Word, words};
pub use mechc_text::world::{Contents, Memory, World};
