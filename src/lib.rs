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

pub mod vocabulary;

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

#[cfg(feature = "cli")]
pub mod cli;

use analysis::Times;
use check::Surroundings;
use diag::{Diagnostic, Diagnostics};
use emit::{Motion, Reference};
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
/// let tree = syntax::parse(&sources, file).tree;
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

/// The motion over the file's analysis, or over the first second where it has none, as `mechc run` computes it, with what is to be said
/// of it: if it stops on its way, why.
///
/// # Errors
/// It cannot be assembled, or has no derivatives at its first time.
pub fn reference(determined: &Determined, program: &Program) -> Result<(Reference, Diagnostics), Box<Diagnostic>> {
    // without an analysis the last time is left out: only that of an analysis belongs to what was before an edge
    let analysis = determined.system().analysis;
    let [from, to, every] = analysis.unwrap_or([0.0, 1.0, 0.1]);
    let times = Times::grid(from, to, every).unwrap_or_else(|| Times::listed(from, vec![from]));
    let count = if analysis.is_some() { times.len() } else { times.len() - 1 };
    let mut started = analysis::start(determined, program, from, analysis::TOLERANCE)?;
    let columns = started.columns();
    let wanted = (MOST_NUMBERS / columns.len()).clamp(2, MOST_ROWS) as u64;
    // spread evenly, the first and the last among them
    let is_wanted = |k: u64| k == 0 || k * (wanted - 1) / (count - 1) > (k - 1) * (wanted - 1) / (count - 1);
    let (mut rows, mut last, mut number) = (Vec::new(), Vec::new(), 0);
    let (mut stopped, mut why) = (None, None);
    let mut motion = started.motion(&times);
    while number < count
        && let Some(row) = motion.next_row()
    {
        match row {
            Ok(row) if is_wanted(number) => rows.push(row.to_vec()),
            Ok(row) => row.clone_into(&mut last),
            Err(diagnostic) if number == 0 => return Err(diagnostic),
            Err(diagnostic) => {
                stopped = Some(diagnostic.message.clone());
                why = Some(*diagnostic);
                break;
            }
        }
        number += 1;
    }
    if rows.last().map(|row| row[0]) < last.first().copied() {
        rows.push(last);
    }
    let mut remarks = motion.take_remarks();
    remarks.extend(why);
    Ok((Reference { columns, rows, steps: number - 1, every, stopped }, remarks))
}

/// Rows and numbers of a reference at most.
const MOST_ROWS: usize = 20;
const MOST_NUMBERS: usize = 20_000;
