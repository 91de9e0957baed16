//! The third stage: a mechanism that is determined, with the operations that evaluate it.

use super::again::Again;
use super::lead::Leading;
use super::over::FromOwn;
use super::used_at::UsedAt;
use mechc_emit as emit;
use mechc_engine::analysis::{self, Horizon, Times};
use mechc_ir::layout::{self, ColumnUnit, RowLayout};
use mechc_ir::program::Program;
use mechc_ir::structure::{self, Determined};
use mechc_ir::{ConstraintSystem, DeclarationKind, Mechanics};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use std::sync::{Arc, OnceLock};

/// What becomes of equations that follow from others.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Redundant {
    /// They are an error.
    #[default]
    Refused,
    /// They are left out, and checked at every time.
    LeftOut,
}

/// A mechanism that is shown to be determined.
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
/// let checked = Parsed::of("disc.mech", text).check(&Choice::default(), &Memory::default());
/// let (compiled, said) = checked.compile(Redundant::Refused, &Cancel::default());
/// let compiled = compiled.expect("it is determined");
/// assert!(said.is_empty());
/// assert_eq!(compiled.drivers(), [("motor".to_owned(), "rotation(axle) = 90 deg/s * t".to_owned())]);
/// ```
#[derive(Clone)]
pub struct Compiled {
    sources: Sources,
    determined: Arc<Determined>,
    program: Arc<OnceLock<Arc<Program>>>,
    /// Where it begins, if it has parts, or is told other inputs than its own.
    leading: Option<Arc<Leading>>,
    used_at: UsedAt,
    redundant: Redundant,
    /// What it takes to have it once more, with more.
    again: Option<Again>,
    /// From where it is led, if it is led over to values of its params.
    over: Option<Arc<FromOwn>>,
}

impl Compiled {
    pub(super) fn of(
        sources: Sources,
        system: ConstraintSystem,
        redundant: Redundant,
        leading: Option<Arc<Leading>>,
        used_at: UsedAt,
        cancel: &Cancel,
    ) -> (Option<Compiled>, Diagnostics) {
        if cancel.is_cancelled() {
            return (None, Diagnostics::default());
        }
        let horizon = Horizon::of_analysis(system.analysis());
        match analysis::determine(system, redundant == Redundant::LeftOut, horizon) {
            _ if cancel.is_cancelled() => (None, Diagnostics::default()),
            Err(why) => (None, used_at.told(why)),
            Ok((determined, said)) => {
                let (determined, said) = (Arc::new(determined), used_at.told(said));
                let (program, again, over) = Default::default();
                let compiled = Compiled { sources, determined, program, leading, used_at, redundant, again, over };
                (Some(compiled), said)
            }
        }
    }

    /// The same, with what it takes to have it once more.
    pub(super) fn with_again(self, again: Option<Again>) -> Compiled {
        Compiled { again, ..self }
    }

    /// The same, to be led over from the values of its text, if it is.
    pub(super) fn led_over(self, over: Option<Arc<FromOwn>>) -> Compiled {
        Compiled { over, ..self }
    }

    /// The same mechanism with its inputs as signals, where it has any: its measures have the derivatives that they have here.
    pub(super) fn signals(&self, cancel: &Cancel) -> Result<Option<Compiled>, Diagnostics> {
        let Some(again) = self.again.as_ref().filter(|_| !self.system().inputs().is_empty()) else {
            return Ok(None);
        };
        let mut system = again.with_signals()?;
        system.align_measures(self.system().measures());
        if self.system().by_params().len() > 0 {
            system.derive_by_params();
        }
        let (compiled, said) =
            Compiled::of(self.sources.clone(), system, self.redundant, None, self.used_at.clone(), cancel);
        compiled.map(Some).ok_or(said)
    }

    /// Its equations with its inputs as signals, where it has any.
    pub(super) fn with_signals(&self) -> Option<ConstraintSystem> {
        self.again.as_ref().filter(|_| !self.system().inputs().is_empty())?.with_signals().ok()
    }

    /// The same mechanism, whose equations are differentiated by its parameters too.
    pub(super) fn by_params(&self) -> Result<Compiled, Diagnostics> {
        let mut system = self.determined.whole().clone();
        system.derive_by_params();
        let leading = self.leading.clone();
        let (compiled, said) = Compiled::of(
            self.sources.clone(),
            system,
            self.redundant,
            leading,
            self.used_at.clone(),
            &Cancel::default(),
        );
        compiled.map(|compiled| compiled.with_again(self.again.clone())).ok_or(said)
    }

    /// The same mechanism with all that joints exert and drivers supply; none where it has no masses and loads, or where left-out
    /// equations leave that open.
    pub(super) fn with_reactions(&self) -> Option<Compiled> {
        let (system, again) = self.again.as_ref()?.with_reactions()?;
        let (leading, used_at) = (self.leading.clone(), self.used_at.clone());
        let (compiled, _) =
            Compiled::of(self.sources.clone(), system, self.redundant, leading, used_at, &Cancel::default());
        Some(compiled?.with_again(Some(again)))
    }

    /// The texts that its diagnostics speak of.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The name of the mechanism.
    #[must_use]
    pub fn name(&self) -> &str {
        self.system().name()
    }

    /// First time, last time and step of the file's analysis (s), if it has one.
    #[must_use]
    pub fn analysis(&self) -> Option<[f64; 3]> {
        self.system().analysis()
    }

    /// The output times of the file's analysis, if it has one.
    #[must_use]
    pub fn times(&self) -> Option<Times> {
        self.analysis().and_then(|[from, to, every]| Times::grid(from, to, every))
    }

    /// The names of the columns of its rows: `t`; coordinates and measures; their first and second derivatives.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        layout::columns(self.system()).into_iter().map(|column| column.name).collect()
    }

    /// The units of those columns, in which their numbers are printed; the rows themselves are in SI.
    #[must_use]
    pub fn units(&self) -> Vec<ColumnUnit> {
        layout::columns(self.system()).into_iter().map(|column| column.unit).collect()
    }

    /// The names of its coordinates, in order; their columns stand behind that of the time.
    #[must_use]
    pub fn coordinates(&self) -> Vec<&str> {
        self.system().coordinates().iter().map(|coordinate| coordinate.name.as_str()).collect()
    }

    /// The names of the results, numbers for the whole analysis, with the units in which they are told.
    #[must_use]
    pub fn results(&self) -> Vec<(String, ColumnUnit)> {
        layout::results(self.system())
    }

    /// By body, the columns of its x, y and phi, of their first and of their second time derivatives.
    #[must_use]
    pub fn columns_of_poses(&self) -> Vec<[[usize; 3]; 3]> {
        let (system, layout) = (self.system(), RowLayout::new(self.system()));
        system.bodies().ids().map(|body| layout.pose(system, body)).collect()
    }

    /// What is wrong with results of an analysis from one time to another (s).
    #[must_use]
    pub fn refused_results(&self, interval: [f64; 2]) -> Diagnostics {
        analysis::refused_results(self.system(), interval)
    }

    /// Coordinates less equations.
    #[must_use]
    pub fn ndof(&self) -> isize {
        self.system().ndof()
    }

    /// How many coordinates and equations there are, by body and declaration, as a table.
    #[must_use]
    pub fn counts(&self) -> String {
        structure::table(self.system())
    }

    /// The coordinates in the order in which they are solved for, with what each comes from; a line each.
    #[must_use]
    pub fn order_of_solution(&self) -> String {
        structure::order_of_solution(&self.determined)
    }

    /// Each driver with its equation as it is written.
    #[must_use]
    pub fn drivers(&self) -> Vec<(String, String)> {
        let written = |text: &str| text.split_whitespace().collect::<Vec<&str>>().join(" ");
        self.system()
            .declarations()
            .iter()
            .filter(|declaration| declaration.kind == DeclarationKind::Driver)
            .filter_map(|driver| Some((driver.name.clone(), written(self.sources.text(driver.written?)))))
            .collect()
    }

    /// Lays out the operations, which the first run would do.
    pub fn prepare(&self) {
        let _ = self.program();
    }

    /// The equations typeset for a report; the file is named in it.
    #[must_use]
    pub fn latex(&self, file: &str) -> String {
        let (system, mechanics) = self.with_mechanics();
        emit::latex(&system, mechanics.as_ref(), true, file)
    }

    /// The whole constraint system as data for other programs; the file is named in it.
    #[must_use]
    pub fn json(&self, file: &str) -> String {
        let (system, mechanics) = self.with_mechanics();
        emit::json(&system, mechanics.as_ref(), true, &self.sources, file)
    }

    /// The system with all that joints exert, and what that follows from, where it has masses and loads.
    fn with_mechanics(&self) -> (ConstraintSystem, Option<Mechanics>) {
        let with_reactions = self.with_reactions();
        let mut system = with_reactions.as_ref().unwrap_or(self).system().clone();
        let mechanics = system.mechanics();
        (system, mechanics)
    }

    /// What leads it to the inputs that it is told, if it is told any, and whether redundant equations are left out there too.
    pub(super) fn leading(&self) -> Option<(&Leading, bool)> {
        self.leading.as_deref().map(|leading| (leading, self.redundant == Redundant::LeftOut))
    }

    /// From where it is led, if it is led over to values of its params.
    pub(super) fn over(&self) -> Option<&FromOwn> {
        self.over.as_deref()
    }

    /// Where its parts are used.
    pub(super) fn used_at(&self) -> &UsedAt {
        &self.used_at
    }

    /// The parts that ask for derivatives by their own equations and move together with what is around them.
    ///
    /// # Errors
    /// Those that are not determined alone.
    pub(super) fn coupled_parts(&self) -> Result<Vec<String>, Diagnostics> {
        self.determined.coupled_parts()
    }

    /// The constraint system.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// The system with the proof that it is determined.
    #[must_use]
    pub fn determined(&self) -> &Arc<Determined> {
        &self.determined
    }

    /// The compiled operations of the system.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        self.program.get_or_init(|| Arc::new(Program::new(self.system())))
    }
}

/// For tests of what is inside.
#[doc(hidden)]
impl Compiled {
    #[must_use]
    pub fn inside(&self) -> (Arc<Determined>, Arc<Program>) {
        (Arc::clone(&self.determined), Arc::clone(self.program()))
    }
}
