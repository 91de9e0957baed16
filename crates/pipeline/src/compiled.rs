//! The third stage: a mechanism that is proved determined, with the operations that evaluate it. Follows no motion.

use crate::continuation::Continuation;
use crate::continuation::StartSolver;
use crate::lowering::lower_model;
use crate::part_backtrace::PartBacktrace;
use mechc_emit as emit;
use mechc_engine::analysis::{self, Horizon, Times};
use mechc_ir::layout::{self, ColumnUnit, RowLayout};
use mechc_ir::program::Program;
use mechc_ir::structure::{self, Determined};
use mechc_ir::{ConstraintSystem, DeclarationKind, Mechanics};
use mechc_lang::lower::{Inputs, LowerOptions, TabulatedForces};
use mechc_lang::model::Mechanism;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::Sources;
use std::sync::{Arc, OnceLock};

/// The treatment of redundant equations.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Redundant {
    /// They are an error.
    #[default]
    Refused,
    /// They are left out of the solution, and checked at every time.
    LeftOut,
}

/// A mechanism that is proved determined.
///
/// ```
/// use mechc::{Cancel, Choice, Memory, Parsed, Redundant};
///
/// let text = "mechanism disc {
///      ground { point O = (0, 0) }
///      body wheel { point O = (0, 0) }
///      joint axle: revolute(ground.O, wheel.O)
///      driver motor: rotation(axle) = 90 deg/s * t
///  }";
/// let checked = Parsed::new("disc.mech", text).check(&Choice::default(), &Memory::default());
/// let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
/// let compiled = compiled.expect("it is determined");
/// assert!(diagnostics.is_empty());
/// assert_eq!(compiled.drivers(), [("motor".to_owned(), "rotation(axle) = 90 deg/s * t".to_owned())]);
/// ```
#[derive(Clone)]
pub struct Compiled {
    origin: Origin,
    determined: Arc<Determined>,
    program: Arc<OnceLock<Arc<Program>>>,
    /// Present if it is continued from nominal values of its params.
    continuation: Option<Arc<Continuation>>,
    /// True if its equations are those of other values of its params, with values bound to them.
    is_bound: bool,
}

/// The source of a compiled mechanism, except for its equations.
#[derive(Clone)]
pub(crate) struct Origin {
    pub sources: Sources,
    pub model: Arc<Mechanism>,
    pub forces: TabulatedForces,
    /// Finds its starting position, if it has parts or is given inputs.
    pub start_solver: Option<Arc<StartSolver>>,
    pub backtrace: PartBacktrace,
    pub redundant: Redundant,
}

impl Origin {
    /// Returns the equations of its model.
    pub fn lowered(&self, inputs: Inputs) -> ConstraintSystem {
        lower_model(&self.model, &LowerOptions { inputs, forces: self.forces })
    }

    /// Compiles it with these equations.
    pub fn compile(self, system: ConstraintSystem, cancel: &Cancel) -> (Option<Compiled>, Diagnostics) {
        if cancel.is_cancelled() {
            return (None, Diagnostics::default());
        }
        let horizon = Horizon::of_analysis(system.analysis());
        match analysis::determine(system, self.redundant == Redundant::LeftOut, horizon) {
            _ if cancel.is_cancelled() => (None, Diagnostics::default()),
            Err(why) => (None, self.backtrace.annotate_all(why)),
            Ok((determined, diagnostics)) => {
                let diagnostics = self.backtrace.annotate_all(diagnostics);
                let (program, continuation, is_bound) = Default::default();
                let determined = Arc::new(determined);
                let compiled = Compiled { origin: self, determined, program, continuation, is_bound };
                (Some(compiled), diagnostics)
            }
        }
    }
}

impl Compiled {
    /// Returns its source.
    pub(crate) fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Returns it with values of all its params (SI); `origin` has the model with these values.
    pub(crate) fn bound(&self, origin: Origin, values: &[f64]) -> Compiled {
        let determined = Arc::new(self.determined.with_values(values));
        Compiled { origin, determined, is_bound: true, ..self.clone() }
    }

    /// Returns the mechanism compiled from its model, if values are bound to its equations: their estimates may follow from other values.
    pub(crate) fn unbound(&self, cancel: &Cancel) -> Option<Compiled> {
        let system = self.is_bound.then(|| self.origin.lowered(Inputs::Inlined))?;
        let compiled = self.origin.clone().compile(system, cancel).0?;
        Some(compiled.with_continuation(self.continuation.clone()))
    }

    /// Returns it with a continuation from nominal values, if there is one.
    pub(crate) fn with_continuation(self, continuation: Option<Arc<Continuation>>) -> Compiled {
        Compiled { continuation, ..self }
    }

    /// Compiles the mechanism with its inputs as signals, and measures differentiated as here; `None` if it has no inputs.
    pub(crate) fn signals(&self, cancel: &Cancel) -> Result<Option<Compiled>, Diagnostics> {
        let Some(mut system) = self.with_signals() else { return Ok(None) };
        system.align_measures(self.system().measures());
        if self.system().by_params().len() > 0 {
            system.derive_by_params();
        }
        let (compiled, diagnostics) = Origin { start_solver: None, ..self.origin.clone() }.compile(system, cancel);
        compiled.map(Some).ok_or(diagnostics)
    }

    /// Returns the equations with inputs as signals, if it has any.
    pub(crate) fn with_signals(&self) -> Option<ConstraintSystem> {
        (!self.system().inputs().is_empty()).then(|| self.origin.lowered(Inputs::Signals))
    }

    /// Compiles the mechanism with its equations differentiated by its params.
    pub(crate) fn by_params(&self) -> Result<Compiled, Diagnostics> {
        let mut system = self.determined.whole().clone();
        system.derive_by_params();
        let (compiled, diagnostics) = self.origin.clone().compile(system, &Cancel::default());
        compiled.ok_or(diagnostics)
    }

    /// Compiles the mechanism with all reactions of joints and efforts of drivers. `None` if it has no masses and loads, or if redundant equations
    /// leave the reactions undetermined.
    pub(crate) fn with_reactions(&self) -> Option<Compiled> {
        if !self.origin.model.has_forces() {
            return None;
        }
        let forces = TabulatedForces { reactions: true, ..self.origin.forces };
        let origin = Origin { forces, ..self.origin.clone() };
        let system = origin.lowered(Inputs::Inlined);
        origin.compile(system, &Cancel::default()).0
    }

    /// Returns the texts that its diagnostics point into.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.origin.sources
    }

    /// Returns the name of the mechanism.
    #[must_use]
    pub fn name(&self) -> &str {
        self.system().name()
    }

    /// Returns first time, last time and step (s) of the text's analysis, if it has one.
    #[must_use]
    pub fn analysis(&self) -> Option<[f64; 3]> {
        self.system().analysis()
    }

    /// Returns the output times of the text's analysis, if it has one.
    #[must_use]
    pub fn times(&self) -> Option<Times> {
        self.analysis().and_then(|[from, to, every]| Times::grid(from, to, every))
    }

    /// Returns the names of the columns of its rows: `t`; coordinates and measures; their first and second derivatives.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        layout::columns(self.system()).into_iter().map(|column| column.name).collect()
    }

    /// Returns the units in which the columns are printed; rows themselves are in SI.
    #[must_use]
    pub fn units(&self) -> Vec<ColumnUnit> {
        layout::columns(self.system()).into_iter().map(|column| column.unit).collect()
    }

    /// Returns the names of the coordinates; their columns follow that of the time, in the same order.
    #[must_use]
    pub fn coordinates(&self) -> Vec<&str> {
        self.system().coordinates().iter().map(|coordinate| coordinate.name.as_str()).collect()
    }

    /// Returns the names of the results, each with the unit in which it is printed.
    #[must_use]
    pub fn results(&self) -> Vec<(String, ColumnUnit)> {
        layout::results(self.system())
    }

    /// Returns a note if there are requirements, for a run at single times, which judges none.
    #[must_use]
    pub fn unjudged_requirements(&self) -> Option<Diagnostic> {
        let requirements = &self.system().results().requirements;
        let count = match requirements.len() {
            1 => "the requirement is not judged".to_owned(),
            count => format!("{count} requirements are not judged"),
        };
        let note = Diagnostic::new(Code::N0606, format!("{count}: only some times are computed"));
        requirements.first().map(|first| note.at(first.span, "over the whole analysis"))
    }

    /// For each body, returns the columns of x, y and phi, of their first, and of their second time derivatives.
    #[must_use]
    pub fn columns_of_poses(&self) -> Vec<[[usize; 3]; 3]> {
        let (system, layout) = (self.system(), RowLayout::new(self.system()));
        system.bodies().ids().map(|body| layout.pose(system, body)).collect()
    }

    /// Returns the errors and warnings of the results over an interval of time (s).
    #[must_use]
    pub fn refused_results(&self, interval: [f64; 2]) -> Diagnostics {
        analysis::refused_results(self.system(), interval)
    }

    /// Returns the number of coordinates less that of equations.
    #[must_use]
    pub fn ndof(&self) -> isize {
        self.system().ndof()
    }

    /// Returns a table of the numbers of coordinates and equations, by body and declaration.
    #[must_use]
    pub fn counts(&self) -> String {
        structure::table(self.system())
    }

    /// Returns the order of solution: a line for each coordinate, with the equations that determine it.
    #[must_use]
    pub fn order_of_solution(&self) -> String {
        structure::order_of_solution(&self.determined)
    }

    /// Returns each driver with its equation as it is written.
    #[must_use]
    pub fn drivers(&self) -> Vec<(String, String)> {
        let written = |text: &str| text.split_whitespace().collect::<Vec<&str>>().join(" ");
        self.system()
            .declarations()
            .iter()
            .filter(|declaration| declaration.kind == DeclarationKind::Driver)
            .filter_map(|driver| Some((driver.name.clone(), written(self.origin.sources.text(driver.written?)))))
            .collect()
    }

    /// Lays out the operations now, and not in the first run.
    pub fn prepare(&self) {
        let _ = self.program();
    }

    /// Returns the equations as LaTeX; `file` is named in the output.
    #[must_use]
    pub fn latex(&self, file: &str) -> String {
        let (system, mechanics) = self.with_mechanics();
        emit::latex(&system, mechanics.as_ref(), true, file)
    }

    /// Returns the constraint system as JSON; `file` is named in the output.
    #[must_use]
    pub fn json(&self, file: &str) -> String {
        let (system, mechanics) = self.with_mechanics();
        emit::json(&system, mechanics.as_ref(), true, &self.origin.sources, file)
    }

    /// Returns the system with its reactions, and with the mechanics that give them, if it has masses and loads.
    fn with_mechanics(&self) -> (ConstraintSystem, Option<Mechanics>) {
        let with_reactions = self.with_reactions();
        let mut system = with_reactions.as_ref().unwrap_or(self).system().clone();
        let mechanics = system.mechanics();
        (system, mechanics)
    }

    /// Returns what finds its starting position, and whether redundant equations are left out there too.
    pub(crate) fn start_solver(&self) -> Option<(&StartSolver, bool)> {
        let Origin { start_solver, redundant, .. } = &self.origin;
        start_solver.as_deref().map(|start_solver| (start_solver, *redundant == Redundant::LeftOut))
    }

    /// Returns the continuation from nominal values of its params, if it has one.
    pub(crate) fn continuation(&self) -> Option<&Continuation> {
        self.continuation.as_deref()
    }

    /// Returns the places where its parts are used.
    pub(crate) fn backtrace(&self) -> &PartBacktrace {
        &self.origin.backtrace
    }

    /// Returns the constraint system.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// Returns the system with the proof that it is determined.
    #[must_use]
    pub fn determined(&self) -> &Arc<Determined> {
        &self.determined
    }

    /// Returns the operations of the system.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        self.program.get_or_init(|| Arc::new(Program::new(self.system())))
    }
}

/// Internals for tests.
#[doc(hidden)]
impl Compiled {
    #[must_use]
    pub fn inside(&self) -> (Arc<Determined>, Arc<Program>) {
        (Arc::clone(&self.determined), Arc::clone(self.program()))
    }
}
