//! A mechanism as a page asks for it: checked, proven, assembled, followed.

use super::host::Host;
use super::shelf::Shelf;
use mechc_engine::analysis::Times;
use mechc_pipeline::{Checked, Choice, Compiled, Crank, Jog, Knob, Parsed, Redundant, RunOptions, Seen, Stand};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Color, Diagnostics, Format, render};
use mechc_text::source::Sources;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Of more rows some are left out.
const MOST_ROWS: usize = 2000;
/// So much of the way to a dead point is gone: at the point itself nothing can be told.
const BEFORE_A_DEAD_POINT: [f64; 3] = [1.0 - 1e-6, 1.0 - 1e-4, 1.0 - 1e-2];

/// What came of a mechanism, whatever is wrong with it.
pub(super) struct Solved {
    pub sources: Sources,
    pub checked: Option<Checked>,
    compiled: Option<Compiled>,
    times: Option<Times>,
    said: Diagnostics,
    /// Its motion, once somebody has asked for it.
    watched: Mutex<Option<Arc<Watched>>>,
    /// Where it stood when it was moved by hand last.
    stand: Mutex<Option<Stand>>,
}

/// The motion of a mechanism, or what there is to see instead.
pub(super) struct Watched {
    pub seen: Option<Seen>,
    /// All that is said of the mechanism.
    said: Diagnostics,
}

impl Solved {
    fn nothing(sources: Sources, said: Diagnostics) -> Solved {
        let (watched, stand) = Default::default();
        Solved { sources, checked: None, compiled: None, times: None, said, watched, stand }
    }

    pub fn is_sound(&self) -> bool {
        self.checked.as_ref().is_some_and(Checked::is_sound)
    }

    /// All that is said, as `run` prints it.
    pub fn rendered(&self) -> String {
        let watched = lock(&self.watched).clone();
        rendered(watched.as_ref().map_or(&self.said, |watched| &watched.said), &self.sources)
    }

    pub fn knobs(&self) -> Vec<Knob> {
        self.checked.as_ref().map(Checked::knobs).unwrap_or_default()
    }

    pub fn cranks(&self) -> Vec<Crank> {
        let from = self.times.as_ref().map_or(0.0, Times::from);
        self.compiled.as_ref().map(|compiled| compiled.cranks(from)).unwrap_or_default()
    }

    /// The inputs, with what they are at some times (s).
    pub fn jogs(&self, times: &[f64]) -> Vec<Jog> {
        let both = self.checked.as_ref().zip(self.compiled.as_ref());
        both.map(|(checked, compiled)| checked.jogs(compiled, times)).unwrap_or_default()
    }
}

/// Makes them of the texts of a version.
pub(super) struct Solver<'s> {
    /// The file, if it could be read.
    pub parsed: &'s Result<Parsed, (Sources, Diagnostics)>,
    pub shelf: &'s Shelf,
    /// What of it is shown.
    pub choice: &'s Choice,
    pub redundant: Redundant,
    pub pass_bifurcations: bool,
    /// Who says the times of a mechanism.
    pub host: &'s dyn Host,
}

impl Solver<'_> {
    /// The file as it is.
    pub fn own(&self, cancel: &Cancel) -> Solved {
        self.solved(self.choice, cancel)
    }

    /// With params that are set; nothing if it is given up.
    pub fn set(&self, own: &Solved, set: &[(String, String)], cancel: &Cancel) -> Option<Solved> {
        let solved = self.solved(&self.choice(own, set), cancel);
        (!cancel.is_cancelled()).then_some(solved)
    }

    /// What `run --lead --set …` has; what decides how many bodies there are is set without being led.
    fn choice(&self, own: &Solved, set: &[(String, String)]) -> Choice {
        let knobs = own.knobs();
        let leads = |(name, _): &(String, String)| knobs.iter().any(|knob| knob.name == *name && knob.leads);
        let is_led = |knob: &Knob| knob.leads || self.held(&knob.name).is_none();
        let mut choice = Choice { lead: set.iter().all(leads) && knobs.iter().all(is_led), ..self.choice.clone() };
        choice.set.extend(set.iter().map(|(name, formula)| format!("{name}={formula}")));
        choice
    }

    /// What the command sets a param to, or a point of which it is a coordinate, as it was told.
    pub fn held(&self, name: &str) -> Option<&str> {
        let is_it = |path: &str| {
            let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
            name.strip_prefix(path.as_str()).is_some_and(|axis| ["", ".x", ".y"].contains(&axis))
        };
        let said = |set: &&String| set.split_once('=').is_some_and(|(path, _)| is_it(path));
        self.choice.set.iter().rev().find(said).map(String::as_str)
    }

    fn options(&self, stand: Option<Stand>, cancel: &Cancel) -> RunOptions {
        let pass_bifurcations = self.pass_bifurcations;
        RunOptions { pass_bifurcations, stand, cancel: cancel.clone(), ..RunOptions::default() }
    }

    fn solved(&self, choice: &Choice, cancel: &Cancel) -> Solved {
        let parsed = match self.parsed {
            Ok(parsed) => parsed,
            Err((sources, said)) => return Solved::nothing(sources.clone(), said.clone()),
        };
        let checked = parsed.check(choice, self.shelf);
        let (mut said, mut sources) = (checked.diagnostics().clone(), checked.sources().clone());
        let (compiled, more) = checked.compile(self.redundant, cancel);
        said.extend(more);
        let times = compiled.as_ref().map(|compiled| self.host.times(compiled, &mut sources));
        let times = times.and_then(|times| times.map_err(|why| said.extend(why)).ok());
        let (watched, stand) = Default::default();
        Solved { sources, checked: Some(checked), compiled, times, said, watched, stand }
    }

    /// Its motion; symbols and extent are those of the file as it is, so that nothing jumps under a hand. Nothing if it is given up.
    pub fn watched(&self, solved: &Solved, own: Option<&Seen>, cancel: &Cancel) -> Option<Arc<Watched>> {
        if let Some(known) = &*lock(&solved.watched) {
            return Some(Arc::clone(known));
        }
        let mut said = solved.said.clone();
        let options = self.options(None, cancel);
        let seen = solved.checked.as_ref().and_then(|checked| {
            let (compiled, times) = (solved.compiled.as_ref(), solved.times.as_ref());
            let moving = compiled.zip(times).and_then(|(compiled, times)| {
                let (seen, more) = checked.seen_beside(compiled, times, &options, MOST_ROWS, own);
                said.extend(more);
                seen
            });
            let from = times.map_or(0.0, Times::from);
            let mut at_rest = || {
                let mut seen = checked.seen_at_rest(compiled, (from, &options), &said)?;
                seen.scene.extent = own.map_or(seen.scene.extent, |own| own.scene.extent);
                Some(seen)
            };
            moving.or_else(&mut at_rest)
        });
        let watched = Arc::new(Watched { seen, said });
        (!cancel.is_cancelled()).then(|| Arc::clone(lock(&solved.watched).insert(watched)))
    }

    /// Its picture at a time alone, which is there sooner than the motion; nothing where it does not get there, or is given up.
    pub fn glimpse(&self, solved: &Solved, own: &Seen, t: f64, cancel: &Cancel) -> Option<Seen> {
        let (checked, compiled) = solved.checked.as_ref().zip(solved.compiled.as_ref())?;
        let from = solved.times.as_ref().map(Times::from).filter(|from| *from <= t)?;
        checked.glimpse(compiled, [from, t], &self.options(None, cancel), own).filter(|_| !cancel.is_cancelled())
    }

    /// A mechanism whose inputs are moved by hand while time stands still: how far they got, what is to be said, and the row there, a
    /// column each; nothing if it is given up.
    pub fn jogged(
        &self,
        solved: &Solved,
        set: &[(String, String)],
        t: f64,
        inputs: &[(String, f64)],
        cancel: &Cancel,
    ) -> Option<(Value, Option<String>, Vec<Vec<f64>>)> {
        let stays = |said: String| Some((json!([]), Some(said), Vec::new()));
        let Some(compiled) = &solved.compiled else { return stays(solved.rendered()) };
        let stand = match self.stand(solved, compiled, t, cancel) {
            Ok(stand) => stand,
            Err(_) if cancel.is_cancelled() => return None,
            Err(said) => return stays(rendered(&said, &solved.sources)),
        };
        let own = solved.jogs(&[t]);
        let inputs: Vec<Moved> = inputs.iter().filter_map(|(name, to)| Moved::of(&own, name, *to)).collect();
        let (mut told, mut part) = (None, 1.0);
        for shortened in std::iter::once(1.0).chain(BEFORE_A_DEAD_POINT) {
            let gone = part * if part < 1.0 { shortened } else { 1.0 };
            let RowAttempt { row, said, sources, stopped_path: stop } =
                self.row_with(solved, set, (&stand, &inputs, gone), cancel);
            if cancel.is_cancelled() {
                return None;
            }
            match (row, stop) {
                (Some(row), None) => {
                    let reached: Vec<Value> = inputs.iter().map(|moved| json!([moved.name, moved.at(gone)])).collect();
                    let told = told.or_else(|| (!said.is_empty()).then(|| rendered(&said, &sources)));
                    return Some((json!(reached), told, row.into_iter().map(|value| vec![value]).collect()));
                }
                (_, stop) => {
                    told = told.or_else(|| Some(rendered(&without_fallback(&said), &sources)));
                    part = stop.map_or(part, |stop| gone * stop).min(1.0 - f64::EPSILON);
                }
            }
        }
        stays(told.unwrap_or_default())
    }

    /// Where it stands at a time, with its own inputs.
    fn stand(&self, solved: &Solved, compiled: &Compiled, t: f64, cancel: &Cancel) -> Result<Stand, Diagnostics> {
        let mut known = lock(&solved.stand);
        if let Some(stand) = known.as_ref().filter(|stand| stand.t.to_bits() == t.to_bits()) {
            return Ok(stand.clone());
        }
        let stand = compiled.stand(t, &self.options(None, cancel))?;
        *known = Some(stand.clone());
        Ok(stand)
    }

    /// The row where inputs have gone a part of their way, if they get there.
    fn row_with(
        &self,
        solved: &Solved,
        set: &[(String, String)],
        (stand, inputs, gone): (&Stand, &[Moved], f64),
        cancel: &Cancel,
    ) -> RowAttempt {
        let Ok(parsed) = self.parsed else { return RowAttempt::default() };
        let mut choice = self.choice(solved, set);
        let is_moved = |told: &String| {
            told.split_once('=').is_some_and(|(name, _)| inputs.iter().any(|moved| moved.name == name.trim()))
        };
        choice.inputs.retain(|told| !is_moved(told));
        choice.inputs.extend(inputs.iter().map(|moved| moved.told(gone)));
        let checked = parsed.check(&choice, self.shelf);
        let sources = checked.sources().clone();
        let mut said = checked.diagnostics().clone();
        let (compiled, more) = checked.compile(self.redundant, cancel);
        said.extend(more);
        let times = Times::listed(stand.t, vec![stand.t]);
        let mut stopped_path = None;
        let run = compiled.and_then(|compiled| {
            let (run, report) = compiled.run_with_report(&times, &self.options(Some(stand.clone()), cancel));
            said.extend(report.diagnostics);
            stopped_path = report.stopped_path;
            run
        });
        let row = run.and_then(|mut run| match run.next()? {
            Ok(row) => Some(row),
            Err(why) => {
                said.push(*why);
                None
            }
        });
        RowAttempt { row, said, sources, stopped_path }
    }
}

/// The row at inputs that are moved by hand, if they get there.
#[derive(Default)]
struct RowAttempt {
    row: Option<Vec<f64>>,
    said: Diagnostics,
    sources: Sources,
    /// The fraction of the inputs' path, from 0 to 1, at which it stopped.
    stopped_path: Option<f64>,
}

/// An input on its way, by hand.
struct Moved {
    name: String,
    unit: String,
    /// From and to (SI).
    line: [f64; 2],
}

impl Moved {
    fn of(own: &[Jog], name: &str, to: f64) -> Option<Moved> {
        let jog = own.iter().find(|jog| jog.name == name)?;
        Some(Moved { name: jog.name.clone(), unit: jog.unit.clone(), line: [*jog.values.first()?, to] })
    }

    fn at(&self, part: f64) -> f64 {
        let [from, to] = self.line;
        if part < 1.0 { from + (to - from) * part } else { to }
    }

    /// As `--input` takes it.
    fn told(&self, part: f64) -> String {
        let (name, value) = (&self.name, self.at(part));
        match self.unit.strip_prefix('1') {
            Some(per) => format!("{name}={value}{per}"),
            None if self.unit.is_empty() => format!("{name}={value}"),
            None => format!("{name}={value} {}", self.unit),
        }
    }
}

/// What stopped a way, without what came of trying something else.
fn without_fallback(said: &Diagnostics) -> Diagnostics {
    let stop = said.iter().find(|said| said.code == Code::E0612).cloned();
    match stop {
        None => said.clone(),
        Some(mut stop) => {
            // the page stays where it got to
            (stop.notes, stop.help) = (Vec::new(), Vec::new());
            stop.into()
        }
    }
}

fn rendered(said: &Diagnostics, sources: &Sources) -> String {
    said.iter().map(|one| render(one, sources, Format::Human, Color::Never)).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
