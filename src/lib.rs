//! `mechc` compiles `.mech` files: planar mechanisms, described by bodies, joints and drivers.
//!
//! The rooms in the order in which a text passes through them:
//!
//! ```text
//! text ─syntax▶ tree ─check▶ model ─lower▶ ConstraintSystem ─structure▶ Determined ─program▶ operations
//!                                                                            └──analysis▶ Started ▶ rows ─output▶ table
//! ```
//!
//! `import` makes a tree from the model files of another program.
//!
//! Each stage has its own types, and a later one cannot hold what an earlier one should have refused. See
//! `ARCHITECTURE.md` for what each room knows and must not know.

pub mod source;

pub mod math;

pub mod diag;

pub mod syntax;

pub mod expr;

pub mod model;

pub mod check;

pub mod ir;

pub mod lower;

pub mod structure;

pub mod program;

pub mod solver;

pub mod analysis;

pub mod emit;

pub mod output;

pub mod import;

pub mod cli;

use analysis::Times;
use check::Surroundings;
use diag::{Diagnostic, Diagnostics};
use emit::Motion;
use program::Program;
use solver::BlockTables;
use source::Sources;
use structure::Determined;
use syntax::ast;

/// Checks, lowers and proves one mechanism of a parsed file: the system, if it is determined, and all that is to be
/// said of it.
///
/// ```
/// use mechc::{analysis::{self, Times}, check::Surroundings, program::Program, source::Sources, syntax};
///
/// let mut sources = Sources::default();
/// let file = sources.add("disc.mech", "
///     mechanism disc {
///         ground { point O = (0, 0) }
///         body wheel { point O = (0, 0) }
///         joint axle: revolute(ground.O, wheel.O)
///         driver motor: rotation(axle) = 90 deg/s * t
///     }");
/// let tree = syntax::parse(&sources, file).expect("it follows the grammar");
/// let (determined, _) = mechc::compile(&tree.mechanisms[0], &Surroundings::default(), &sources);
/// let determined = determined.expect("it is determined");
/// let program = Program::new(determined.system());
/// let mut started = analysis::start(&determined, &program, 0.0, analysis::TOLERANCE).expect("it assembles");
/// let row = started.motion(&Times::listed(0.0, vec![1.0])).next_row().expect("a row").expect("it moves").to_vec();
/// assert_eq!(row[3], std::f64::consts::FRAC_PI_2);
/// ```
#[must_use]
pub fn compile(
    mechanism: &ast::Mechanism,
    surroundings: &Surroundings,
    sources: &Sources,
) -> (Option<Determined>, Diagnostics) {
    let (model, mut diagnostics) = check::check(mechanism, surroundings, sources);
    let determined = model.and_then(|model| match analysis::determine(lower::lower(&model), false) {
        Ok((determined, _)) => Some(determined),
        Err(why) => {
            diagnostics.extend(why);
            None
        }
    });
    (determined, diagnostics)
}

/// Assembles a mechanism at the first time of its analysis, or at 0 s, and gives what it takes to follow its motion in emitted code,
/// with what is to be said of the assembly; nothing where that would take too many operations.
///
/// # Errors
/// It cannot be assembled.
pub fn motion(determined: &Determined, program: &Program) -> Result<(Option<Motion>, Diagnostics), Box<Diagnostic>> {
    let analysis = determined.system().analysis;
    let times = analysis.and_then(|[from, to, every]| Times::grid(from, to, every));
    let from = analysis.map_or(0.0, |[from, ..]| from);
    let mut started = analysis::start(determined, program, from, analysis::TOLERANCE)?;
    let motion = started.solver_for_code().map(|solver| Motion {
        solver,
        blocks: BlockTables::new(determined),
        q: started.q().to_vec(),
        bounds: started.bounds(),
        from,
        to: times.map(|times| times.at(times.len().saturating_sub(1))),
        tolerance: analysis::TOLERANCE,
    });
    Ok((motion, started.remarks()))
}
