//! The last stage: a motion in progress, row by row.

use super::Compiled;
use super::lead::{Begin, Outset};
use super::options::{RunOptions, Stand};
use super::used_at::UsedAt;
use mechc_engine::analysis::{self, Answers, Asked, Follower, Horizon, Solving, Started, Times, Unassembled};
use mechc_ir::layout::{ColumnUnit, RowLayout};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};
use std::sync::Arc;

/// The position in which a mechanism was assembled.
#[derive(Clone, PartialEq, Debug)]
pub struct Assembly {
    /// When (s).
    pub t: f64,
    /// Each coordinate: its name, its value (SI), its unit.
    pub coordinates: Vec<(String, f64, &'static str)>,
    /// How far the bodies moved from their estimates, in words.
    pub moved: String,
    /// The distance to a singular position: 1 is far, 0 is singular.
    pub conditioning: f64,
}

/// A motion, which owns all it needs: an iterator over its rows.
///
/// ```
/// # use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
/// # let text = "mechanism disc {
/// #     ground { point O = (0, 0) }
/// #     body wheel { point O = (0, 0) }
/// #     joint axle: revolute(ground.O, wheel.O)
/// #     driver motor: rotation(axle) = 90 deg/s * t
/// # }";
/// # let checked = Parsed::of("disc.mech", text).check(&Choice::default(), &Memory::default());
/// # let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
/// # let compiled = compiled.expect("it is determined");
/// let times = Times::grid(0.0, 2.0, 0.5).expect("a grid");
/// let (run, _) = compiled.run(&times, &RunOptions::default());
/// let run = run.expect("it assembles");
/// assert_eq!(run.columns()[..4], ["t", "wheel.x", "wheel.y", "wheel.phi"]);
/// let turned: Vec<f64> = run.map(|row| row.expect("it moves")[3]).collect();
/// assert_eq!(turned.len(), 5);
/// assert!((turned[4] - std::f64::consts::PI).abs() < 1e-12);
/// ```
pub struct Run {
    motion: Follower,
    columns: Arc<[String]>,
    units: Arc<[ColumnUnit]>,
    assembly: Assembly,
    times: Times,
    cancel: Cancel,
    has_ended: bool,
    has_stopped: bool,
    /// What results are computed from; none where there are none.
    asked: Option<Asked>,
    results: usize,
    used_at: UsedAt,
}

impl Compiled {
    /// Assembles it at the first of some times, and gives what follows it; with what is to be said of that. Nothing where it cannot
    /// be assembled, starts in a singular position, a formula has no value there, or it is cancelled.
    ///
    /// A mechanism that is told its inputs begins where these lead it. An error may stand beside a run: no way leads there (E0612), and it
    /// was assembled from the file's estimates alone.
    #[must_use]
    pub fn run(&self, times: &Times, options: &RunOptions) -> (Option<Run>, Diagnostics) {
        Run::of(self, times, options)
    }

    /// Where it stands at a time (s), as [`Compiled::run`] begins there, with what is to be said of that; in less time, as nothing will
    /// follow.
    ///
    /// ```
    /// # use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions};
    /// # let text = "mechanism disc {
    /// #     ground { point O = (0, 0) }
    /// #     body wheel { point O = (0, 0) }
    /// #     joint axle: revolute(ground.O, wheel.O)
    /// #     driver motor: rotation(axle) = 90 deg/s * t
    /// # }";
    /// # let checked = Parsed::of("disc.mech", text).check(&Choice::default(), &Memory::default());
    /// # let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
    /// # let compiled = compiled.expect("it is determined");
    /// let (assembly, said) = compiled.assembled(1.0, &RunOptions::default());
    /// assert!(said.is_empty());
    /// assert_eq!(assembly.expect("it assembles").coordinates[2].1, std::f64::consts::FRAC_PI_2);
    /// ```
    #[must_use]
    pub fn assembled(&self, t: f64, options: &RunOptions) -> (Option<Assembly>, Diagnostics) {
        let horizon = Horizon::of_analysis(self.analysis()).beginning(t);
        let (started, mut said) = self.started(horizon, options, Solving::With(None));
        match started {
            _ if options.cancel.is_cancelled() => (None, Diagnostics::default()),
            Ok(mut started) => {
                said.extend(self.used_at().told(started.remarks()));
                (Some(assembly(self, &mut started, t)), said)
            }
            Err(why) => {
                said.push(self.used_at().tell(*why));
                (None, said)
            }
        }
    }

    /// A time (s) of its analysis, followed from another one.
    pub(super) fn one_time(&self, from: f64, t: f64) -> Times {
        Times::listed(from, vec![t]).within_analysis_to(self.analysis().map(|[_, to, _]| to))
    }

    /// Where it stands at a time (s), followed from the first time of its analysis.
    ///
    /// # Errors
    /// It does not get there.
    pub fn stand(&self, t: f64, options: &RunOptions) -> Result<Stand, Diagnostics> {
        let from = self.analysis().map_or(t, |[from, ..]| from.min(t));
        let (run, said) = self.run(&self.one_time(from, t), options);
        let layout = RowLayout::new(self.system());
        match run.and_then(|mut run| run.next()) {
            Some(Ok(row)) => Ok(Stand { t, q: layout.position(&row).to_vec() }),
            Some(Err(why)) => Err((*why).into()),
            None => Err(said),
        }
    }

    /// Assembles it at the first time of a horizon, from the file's estimates, or from where the inputs that it is told lead it; with what is to be
    /// said of the way.
    pub(super) fn start(
        &self,
        horizon: Horizon,
        options: &RunOptions,
    ) -> (Result<Started, Box<Diagnostic>>, Diagnostics) {
        self.started(horizon, options, Solving::New)
    }

    fn started(
        &self,
        horizon: Horizon,
        options: &RunOptions,
        solving: Solving,
    ) -> (Result<Started, Box<Diagnostic>>, Diagnostics) {
        let (beginning, mut said) = self.begins(horizon, options);
        let started = match beginning {
            Beginning::Started(started) => return (*started, said),
            Beginning::At(Begin::Position(q), at) => self.unassembled(at, options).assemble_at(&q, solving),
            Beginning::At(Begin::Estimates(drawn), at) => {
                let whole = self.unassembled(at, options);
                // where no way leads to what is told or set, the estimates alone are tried
                let started = if said.has_errors() {
                    whole.close(drawn.as_deref(), solving)
                } else {
                    analysis::start_from(&whole, drawn.as_deref(), solving)
                };
                // parts that begin elsewhere than they are drawn are no estimates of the text
                let started = started.map(|started| match drawn {
                    Some(_) => started.moved_from(&whole.kinematics(None).estimates()),
                    None => started,
                });
                started.map_err(|why| self.with_analysis_proposed(why, horizon)).and_then(|started| {
                    if at.from.total_cmp(&horizon.from).is_eq() {
                        return Ok(started);
                    }
                    let whole = self.unassembled(horizon, options);
                    said.extend(started.far_estimates_at(at.from));
                    let (started, passed) = analysis::follow_to(&whole, (started, at.from))?;
                    said.extend(passed);
                    Ok(started)
                })
            }
        };
        (started, said)
    }

    /// Where it comes nearest to being assembled at a time (s), if it cannot be assembled there: its coordinates [m, rad].
    pub(super) fn nearest(&self, t: f64, options: &RunOptions) -> Option<Vec<f64>> {
        let horizon = Horizon::of_analysis(self.analysis()).beginning(t);
        let (from, at) = match self.begins(horizon, options).0 {
            Beginning::Started(started) => (started.ok().map(|started| started.q().to_vec()), horizon),
            Beginning::At(Begin::Position(q), at) => (Some(q), at),
            Beginning::At(Begin::Estimates(drawn), at) => (drawn, at),
        };
        self.unassembled(at, options).nearest(from.as_deref())
    }

    /// The first time of the text's own analysis (s), or 0: there the drawing decides which branch is followed.
    fn first_time(&self) -> f64 {
        self.analysis().map_or(0.0, |[from, ..]| from)
    }

    /// What is to be assembled at the first time of a horizon.
    pub(super) fn unassembled(&self, horizon: Horizon, options: &RunOptions) -> Unassembled {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let (determined, program) = (Arc::clone(self.determined()), Arc::clone(self.program()));
        Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel: cancel.clone() }
    }

    /// Where the values of its params lead it, the inputs that it is told, and its parts; with what is to be said of the way.
    fn begins(&self, horizon: Horizon, options: &RunOptions) -> (Beginning, Diagnostics) {
        let is_told = self.leading().is_some_and(|(leading, _)| leading.is_told);
        let stand = options.stand.as_ref().filter(|_| is_told);
        let (outset, mut said) = match (stand, self.over()) {
            // who stands somewhere has got there with the params that are set
            (Some(stand), _) => (Outset::At(stand.t, stand.q.clone()), Diagnostics::default()),
            (None, None) => (Outset::Own(self.first_time()), Diagnostics::default()),
            (None, Some(over)) => match over.lead(self.system(), horizon, options) {
                (Some(Ok(started)), said) if is_told => (Outset::At(horizon.from, started.q().to_vec()), said),
                (Some(started), said) => return (Beginning::Started(Box::new(started)), said),
                (None, said) => (Outset::Estimates, said),
            },
        };
        // inputs that are told may have no value at the text's own first time
        let is_there = is_told || self.first_time().total_cmp(&horizon.from).is_eq();
        let at = if is_there { horizon } else { Horizon::of_analysis(self.analysis()).beginning(self.first_time()) };
        let Some((leading, leave_out)) = self.leading() else {
            return (Beginning::At(Begin::Estimates(None), at), said);
        };
        let (begin, more) = leading.begin((self.determined(), self.program()), at, &outset, leave_out, options);
        said.extend(more);
        (Beginning::At(begin, at), said)
    }

    /// Why it cannot start, with a mend where a text without an analysis has no values at 0 s.
    fn with_analysis_proposed(&self, why: Box<Diagnostic>, horizon: Horizon) -> Box<Diagnostic> {
        let has_no_value = matches!(why.code, Code::E0605 | Code::E0606 | Code::E0608);
        if self.analysis().is_some() || horizon.from.total_cmp(&0.0).is_eq() || !has_no_value {
            return why;
        }
        let [from, to] = [horizon.from, horizon.from + horizon.span].map(readable);
        let mend = format!(
            "without an analysis the motion begins at 0 s;\nadd `analysis from {from} s to {to} s every 10 ms` to the file"
        );
        Box::new(why.help(mend))
    }
}

/// How far it is known where a mechanism begins.
enum Beginning {
    /// Assembled, or why it cannot be.
    Started(Box<Result<Started, Box<Diagnostic>>>),
    /// So, at the first time of a horizon.
    At(Begin, Horizon),
}

impl Run {
    fn of(compiled: &Compiled, times: &Times, options: &RunOptions) -> (Option<Run>, Diagnostics) {
        let refused = times.interval().map(|interval| analysis::refused_results(compiled.system(), interval));
        if let Some(refused) = refused.filter(Diagnostics::has_errors) {
            return (None, refused);
        }
        let (started, mut said) = compiled.start(Horizon::of(times), options);
        let mut started = match started {
            _ if options.cancel.is_cancelled() => return (None, Diagnostics::default()),
            Ok(started) => started,
            Err(why) => {
                said.push(compiled.used_at().tell(*why));
                return (None, said);
            }
        };
        said.extend(compiled.used_at().told(started.remarks()));
        started.use_vectors(options.vectors);
        let assembly = assembly(compiled, &mut started, times.from());
        let results = compiled.system().results().outcomes.len();
        let interval = times.interval().filter(|_| results > 0);
        let asked = interval.map(|interval| started.asked(interval, options.pass_bifurcations, &options.cancel));
        let mut motion = started.into_motion(times);
        if options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        let (columns, units) = (compiled.columns().into(), compiled.units().into());
        let (times, cancel) = (times.clone(), options.cancel.clone());
        let run = Run {
            motion,
            columns,
            units,
            assembly,
            times,
            cancel,
            has_ended: false,
            has_stopped: false,
            asked,
            results,
            used_at: compiled.used_at().clone(),
        };
        (Some(run), said)
    }

    /// The names of the numbers of a row.
    #[must_use]
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The units in which the numbers of a row are printed; the row itself is in SI.
    #[must_use]
    pub fn units(&self) -> &[ColumnUnit] {
        &self.units
    }

    /// The position at the first time.
    #[must_use]
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// The output times.
    #[must_use]
    pub fn times(&self) -> &Times {
        &self.times
    }

    /// The next row, in SI and the order of [`Run::columns`], without a copy; `None` behind the last one, and when it was cancelled.
    ///
    /// # Errors
    /// Why the motion cannot go on; nothing comes behind that.
    pub fn next_row(&mut self) -> Option<Result<&[f64], Box<Diagnostic>>> {
        if self.has_ended || self.cancel.is_cancelled() {
            return None;
        }
        let row = self.motion.next_row();
        self.has_ended = !matches!(row, Some(Ok(_)));
        self.has_stopped |= matches!(row, Some(Err(_)));
        row.map(|row| row.map_err(|why| Box::new(self.used_at.tell(*why))))
    }

    /// The results, in the order of [`Compiled::results`]; none at all where only some times were asked for or it was cancelled, and each
    /// without a value once the motion has stopped. The motion is followed once more for them, the first time that they are asked for.
    pub fn results(&mut self) -> Option<Answers> {
        let asked = self.asked.take()?;
        if self.has_stopped {
            let count = self.results;
            return Some(Answers { values: vec![None; count], digits: vec![0; count], ..Answers::default() });
        }
        let Answers { values, digits, notes, has_all_rows } = asked.answer()?;
        let mut said = Diagnostics::default();
        said.extend(notes);
        let notes = self.used_at.told(said).into_iter().collect();
        Some(Answers { values, digits, notes, has_all_rows })
    }

    /// From now on it remembers at which times accelerations jump.
    pub fn keep_edges(&mut self) {
        self.motion.keep_edges();
    }

    /// The times (s) at which accelerations have jumped, or have been seen to jump behind the last row; ascending.
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        self.motion.edges()
    }

    /// What there is to say beside the rows so far, each thing once.
    pub fn take_remarks(&mut self) -> Diagnostics {
        self.used_at.told(self.motion.take_remarks())
    }
}

impl Iterator for Run {
    type Item = Result<Vec<f64>, Box<Diagnostic>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().map(|row| row.map(<[f64]>::to_vec))
    }
}

fn assembly(compiled: &Compiled, started: &mut analysis::Started, t: f64) -> Assembly {
    let system = compiled.system();
    let conditioning = started.conditioning();
    let coordinates = system.coordinates().iter().zip(started.q());
    let coordinates = coordinates.map(|(c, &q)| (c.name.clone(), q, c.kind.unit())).collect();
    Assembly { t, coordinates, moved: started.moved().in_words(system), conditioning }
}

#[cfg(test)]
mod tests {
    use crate::{Choice, Compiled, Parsed, Redundant, RunOptions};
    use mechc_engine::analysis::Times;
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;

    fn compiled(cancel: &Cancel) -> Option<Compiled> {
        let text = include_str!("../../../examples/hoeken.mech");
        let checked = Parsed::of("hoeken.mech", text).check(&Choice::default(), &Memory::default());
        checked.compile(Redundant::Refused, cancel).0
    }

    #[test]
    fn what_is_cancelled_gives_nothing_and_says_nothing() {
        let cancel = Cancel::default();
        let compiled_now = compiled(&cancel).expect("it is determined");
        let options = RunOptions { cancel: cancel.clone(), ..RunOptions::default() };
        let times = Times::grid(0.0, 1e9, 1.0).expect("a grid");
        let mut run = compiled_now.run(&times, &options).0.expect("it assembles");
        assert!(run.next_row().is_some_and(|row| row.is_ok()));
        cancel.cancel();
        assert!(run.next_row().is_none(), "it went on, or was told why");
        let (run, said) = compiled_now.run(&times, &options);
        assert!(run.is_none() && said.is_empty());
        assert!(compiled(&cancel).is_none());
    }

    #[test]
    fn stages_go_to_other_threads() {
        fn goes<T: Send + Sync + Clone>() {}
        fn moves<T: Send>() {}
        goes::<Parsed>();
        goes::<crate::Checked>();
        goes::<Compiled>();
        moves::<crate::Run>();
    }
}
