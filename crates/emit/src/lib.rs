//! Back ends for a constraint system: a Rust module or crate with a C interface, LaTeX for reports, JSON for other programs.
//!
//! Emitted Rust performs the operations of the interpreter, those of the program and those of the solver, one by one, so
//! that both give the same bits (the sign of a zero in `phi_t`, which is `-nu`, aside).

mod c;
mod code;
mod equations;
mod errors;
mod json;
mod latex;
mod limits;
mod names;
mod operand;
mod operations;
mod package;
mod params;
mod print;
#[cfg(test)]
// emitted code follows the default lints; only its generic types implement `Clone` by hand
#[allow(clippy::expl_impl_clone_on_copy, clippy::needless_for_each)]
mod runtime;
mod runtime_files;
mod rust;
mod solution;
mod tables;
mod text;

pub use json::json;
pub use latex::latex;
pub use package::{MARK, NOT_IN_ALL, Reference, package};
pub use rust::rust;

use mechc_engine::solver::{BlockTables, Solver};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Program, STAGES};
use mechc_text::source::Sources;

/// Largest number of [operations](TranslationUnit::operations) that are emitted; rustc compiles as many in seconds.
pub const LARGEST_STRAIGHT: usize = 100_000;

/// A file of an emitted crate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrateFile {
    /// Path in the crate, with `/`.
    pub path: String,
    /// Contents; one of the first lines contains [`MARK`].
    pub text: String,
}

/// Mechanism to emit, with the options of its code.
pub struct TranslationUnit<'u> {
    /// System, which must be determined.
    pub system: &'u ConstraintSystem,
    /// Program that evaluates the system.
    pub program: &'u Program,
    /// Source texts of the mechanism.
    pub sources: &'u Sources,
    /// Name of the mechanism's file in `sources`.
    pub file: &'u str,
    /// Solver of the motion, if requested.
    pub motion: Option<EmittedMotion>,
    /// Number of lanes that are solved at once, in addition to the code for a single one.
    pub lanes: Option<usize>,
    /// True if parameters and inputs have the C layout.
    pub for_c: bool,
    /// System with its inputs as signals, if it has inputs and is to be solved.
    pub following: Option<Following<'u>>,
}

impl TranslationUnit<'_> {
    /// Returns the number of operations of its equations and of its solver, the one with derivatives by parameters if it has both.
    #[must_use]
    pub fn operations(&self) -> usize {
        let solver = self.motion.as_ref().map(|motion| motion.sensitive.as_ref().unwrap_or(&motion.solver));
        operations_of_equations(self.program) + solver.map_or(0, |solver| solver.instructions().len())
    }

    /// Returns whether it gives the forces of joints and drivers.
    fn has_forces(&self) -> bool {
        self.motion.as_ref().is_some_and(|motion| motion.forced.is_some())
    }

    /// Returns whether it gives the derivatives of the coordinates by parameters.
    fn has_sensitivity(&self) -> bool {
        self.motion.as_ref().is_some_and(|motion| motion.sensitive.is_some())
    }
}

/// A mechanism whose inputs are signals, beside the one whose inputs follow the text.
pub struct Following<'u> {
    /// Unit whose inputs are signals; its program does not evaluate the input formulas of the file.
    pub unit: Box<TranslationUnit<'u>>,
    /// The program that evaluates the inputs by the text; registers as in `unit`.
    pub by_text: &'u Program,
}

/// Solver data for following the motion from the assembled start.
pub struct EmittedMotion {
    /// The operations that solve the system, laid out for code.
    pub solver: Solver,
    /// Operations that also give the derivatives of the coordinates by parameters, if requested.
    pub sensitive: Option<Solver>,
    /// Operations that also give what joints exert and drivers supply; `None` without masses and loads.
    pub forced: Option<Solver>,
    /// Tables for elimination with partial pivoting; `None` if a block is too large.
    pub blocks: Option<BlockTables>,
    /// The assembled position [m, rad].
    pub q: Vec<f64>,
    /// The bound on the residual of each row of `Φ`, in the row's unit.
    pub bounds: Vec<f64>,
    /// The first time (s).
    pub from: f64,
    /// The last time (s), where the earlier side of an edge counts; `None` if the file has no analysis.
    pub to: Option<f64>,
    /// Largest scaled residual of the parts of rows of `Φ`.
    pub tolerance: f64,
}

/// Returns the number of operations of a program, which evaluates the equations.
#[must_use]
pub fn operations_of_equations(program: &Program) -> usize {
    STAGES.iter().map(|stage| program.stage(*stage).len()).sum()
}

/// Returns why a measure's formula is not written for others; `None` if it is.
fn not_written(system: &mechc_ir::ConstraintSystem, formula: mechc_expr::ExprId) -> Option<&'static str> {
    let is_varied = system.graph().dependence(formula).is_varied();
    is_varied.then_some("a derivative by an input or parameter, which only a run computes")
}
