//! `mechc` compiles `.mech` files: planar mechanisms, described by bodies, joints and drivers.
//!
//! ```text
//! Sources ──▶ Parsed ──check──▶ Checked ──compile──▶ Compiled ──run──▶ Run ──▶ rows
//! ```
//!
//! Each stage is owned, can be sent to another thread, and is cloned for little. What is to be said of a text is on its stages as
//! [`Diagnostics`]; [`render()`] writes them.
//!
//! ```
//! use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
//!
//! let parsed = Parsed::of("disc.mech", "
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
//! The rooms behind it are described in `ARCHITECTURE.md`, with what each knows and must not know.

// what only the command line, tests of rooms and later rooms ask for
#![cfg_attr(not(all(feature = "rooms", feature = "cli")), allow(dead_code, unused_imports))]

// what pest generates without its `std` asks for it
extern crate alloc;

mod analysis;
mod cancel;
mod check;
#[cfg(feature = "cli")]
pub mod cli;
mod crew;
mod diag;
mod emit;
mod estimates;
mod expr;
mod ide;
mod import;
mod ir;
mod layout;
#[cfg(feature = "live")]
mod live;
mod lower;
#[cfg(feature = "lsp")]
mod lsp;
mod math;
mod model;
mod output;
mod program;
mod scene;
mod solver;
mod source;
mod stages;
mod structure;
mod sweep;
mod syntax;
mod tolerances;
mod view;
mod vocabulary;
mod world;

pub use analysis::{Answers, TOLERANCE, Times};
pub use cancel::Cancel;
pub use check::{DeclaredName, Meaning, NameId, NameKind, Symbols, Use};
pub use diag::{
    Applies, Blame, Code, Color, Diagnostic, Diagnostics, Edit, Fix, Format, Label, Severity, fixed, render,
};
pub use emit::{CrateFile, LARGEST_STRAIGHT, MARK, NOT_IN_ALL};
pub use layout::ColumnUnit;
#[cfg(feature = "live")]
pub use live::page::{picture, written as page};
pub use output::{TableFormat, TableWriter};
pub use source::{Encoding, FileId, Source, Sources, Span};
pub use stages::{
    Adjustable, Adjusting, Affected, AskedPlace, AskedTimes, Assembly, Checked, Choice, Compiled, CurveTolerance,
    Deviation, Formula, InputMotion, Parsed, Redundant, Run, RunOptions, RustOptions, Seen, Settable, Shown, Sweep,
    SweepOptions, SweptColumn, Tolerance, Tolerancing, Variants, VaryOptions, Vectors, Verified, imported, seconds,
};
pub use sweep::{Levels, Method, Numbers, Points, Sampling, Status, Swept, Varying};
pub use syntax::{Comment, Trivia};
pub use vocabulary::{Category, Word, words};
pub use world::{Contents, Memory, World};

/// The rooms behind the façade, for the project's own tests and benchmarks of what is inside: nothing here is promised.
#[cfg(feature = "rooms")]
#[doc(hidden)]
#[rustfmt::skip]
#[allow(missing_docs)]
pub mod rooms {
    pub mod analysis { pub use crate::analysis::*; }
    pub mod check { pub use crate::check::*; }
    pub mod crew { pub use crate::crew::*; }
    pub mod diag { pub use crate::diag::*; }
    pub mod emit { pub use crate::emit::*; }
    pub mod expr { pub use crate::expr::*; }
    pub mod ide { pub use crate::ide::*; }
    pub mod import { pub use crate::import::*; }
    pub mod ir { pub use crate::ir::*; }
    pub mod layout { pub use crate::layout::*; }
    pub mod lower { pub use crate::stages::lowered; }
    #[cfg(feature = "lsp")]
    pub mod lsp { pub use crate::lsp::*; }
    pub mod math { pub use crate::math::*; }
    pub mod model { pub use crate::model::*; }
    pub mod program { pub use crate::program::*; }
    pub mod scene { pub use crate::scene::*; }
    pub mod solver { pub use crate::solver::*; }
    pub mod structure { pub use crate::structure::*; }
    pub mod syntax { pub use crate::syntax::*; }
    pub mod view { pub use crate::view::*; }
    pub mod vocabulary { pub use crate::vocabulary::*; }
}
