//! A mechanism that is compiled once for all values of some of its inputs and params: for who asks again and again, as an optimiser or a
//! controller does. What it gives depends on what it is asked alone, not on what it was asked before.

use super::beside::{Aim, Aimed, Beside};
use super::over::{FromOwn, Reached};
use super::varied::unusable;
use super::{AskedTimes, Checked, Compiled, Redundant, RunOptions, Variants};
use mechc_engine::analysis::{Answers, Asked, Times};
use mechc_engine::sweep::{LANES, Levels, Points, Varying};
use mechc_lang::check::{SetInputs, Surroundings};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};
use mechc_text::source::Sources;
use std::sync::Arc;

/// What is to be adjusted, and how it is followed then.
#[derive(Clone, Debug)]
pub struct Adjusting {
    /// Inputs, by their names.
    pub inputs: Vec<String>,
    /// Whether inputs may have accelerations; else they have none, whatever is asked, and places may be looked at side by side.
    pub bend: bool,
    /// Params, by their names.
    pub params: Vec<String>,
    /// What becomes of equations that follow from others.
    pub redundant: Redundant,
    /// As a run has it.
    pub tolerance: f64,
    /// As a run has it.
    pub pass_bifurcations: bool,
}

impl Default for Adjusting {
    fn default() -> Adjusting {
        let RunOptions { tolerance, pass_bifurcations, .. } = RunOptions::default();
        let (inputs, bend, params, redundant) = Default::default();
        Adjusting { inputs, bend, params, redundant, tolerance, pass_bifurcations }
    }
}

/// What an input is at a moment (SI).
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct InputMotion {
    /// Its value.
    pub value: f64,
    /// By time.
    pub rate: f64,
    /// By time, twice.
    pub acceleration: f64,
}

/// A place that is asked for.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct AskedPlace {
    /// When (s); at the first time of the analysis where nothing is said.
    pub t: Option<f64>,
    /// What inputs are there, at that time.
    pub inputs: Vec<InputMotion>,
    /// What params are there (SI).
    pub params: Vec<f64>,
}

/// A mechanism whose inputs and params can be adjusted.
///
/// ```
/// use mechc::{Adjusting, AskedTimes, Cancel, Choice, Memory, Parsed, InputMotion};
///
/// let text = "mechanism disc {
///      input turn = 90 deg/s * t
///      ground { point O = (0, 0) }
///      body wheel { point O = (0, 0) }
///      joint axle: revolute(ground.O, wheel.O)
///      driver motor: rotation(axle) = turn
///  }";
/// let checked = Parsed::of("disc.mech", text).check(&Choice::default(), &Memory::default());
/// let adjusting = Adjusting { inputs: vec!["turn".to_owned()], ..Adjusting::default() };
/// let disc = checked.adjustable(&adjusting, &Cancel::default()).expect("it is determined");
/// let turn = InputMotion { value: 0.3, rate: 2.0, acceleration: 0.0 };
/// let (once, mut row) = (AskedTimes { at: vec![0.0], ..AskedTimes::default() }, Vec::new());
/// let found = disc.follow(&[turn], &[], &once, &Cancel::default(), |found| row.extend_from_slice(found));
/// assert!(found.is_ok());
/// assert_eq!((row[3], row[6]), (0.3, 2.0));
/// ```
#[derive(Clone)]
pub struct Adjustable(Arc<Shared>);

struct Shared {
    checked: Checked,
    compiled: Compiled,
    from_own: FromOwn,
    /// Its own values of all params of the model (SI).
    own: Vec<f64>,
    /// By input: the first of its params.
    inputs: Vec<usize>,
    /// The params, where there are any.
    params: Option<Variants>,
    adjusting: Adjusting,
    /// How many columns it has.
    columns: usize,
    /// What places share that are looked at side by side.
    beside: Beside,
}

/// What the last params lead to, if that was asked for just before: these, and the values of all.
type Before = Option<(Vec<f64>, Values)>;

impl Checked {
    /// The same with inputs and params that can be adjusted; it is sound.
    ///
    /// # Errors
    /// There is none of such a name, or it is not determined; with the texts that the diagnostics speak of.
    pub fn adjustable(&self, adjusting: &Adjusting, cancel: &Cancel) -> Result<Adjustable, (Sources, Diagnostics)> {
        let own = |why: Diagnostic| (self.sources().clone(), Diagnostics::from(why));
        let t = self.model().and_then(|model| model.analysis).map_or(0.0, |analysis| analysis.from);
        let set_inputs = SetInputs { t, names: adjusting.inputs.clone(), bend: adjusting.bend };
        let open = adjusting.params.clone();
        let surroundings = Surroundings { set_inputs: Some(set_inputs), open, ..(*self.surroundings).clone() };
        let Some(number) = self.number else { return Err((self.sources().clone(), self.diagnostics().clone())) };
        let checked =
            Checked::in_surroundings(self.parsed.clone(), number, surroundings, false, Diagnostics::default());
        let refused = |said: &Diagnostics| (checked.sources().clone(), said.clone());
        let (compiled, said) = checked.compile(adjusting.redundant, cancel);
        let Some((compiled, model)) = compiled.zip(checked.model()) else {
            return Err(refused(if checked.is_sound() { &said } else { checked.diagnostics() }));
        };
        let first_param = |name: &String| {
            let is_it = |led: &&mechc_lang::model::Led| led.declared.name == *name;
            model.led.iter().find(is_it).and_then(|led| led.param).map(|k| k as usize)
        };
        let unknown = |name: &String, what: &str| {
            let said = format!("there is no {what} `{name}` that could be adjusted");
            own(Diagnostic::new(Code::E0703, said))
        };
        let inputs = adjusting.inputs.iter().map(|name| first_param(name).ok_or_else(|| unknown(name, "input")));
        let inputs = inputs.collect::<Result<Vec<usize>, _>>()?;
        if let Some(name) = adjusting.params.iter().find(|name| first_param(name).is_none()) {
            return Err(if self.settable_params().iter().any(|of| of.name == *name) {
                let said = format!(
                    "`{name}` decides what is repeated, and nothing leads from one number of bodies to another"
                );
                own(unusable(said).help("set it when the mechanism is loaded"))
            } else {
                unknown(name, "param")
            });
        }
        let own = model.params.iter().map(|param| param.value).collect();
        let beside = Beside::of(model.led.iter().filter_map(|led| led.param).collect());
        let params = self.params_to_adjust(&adjusting.params)?;
        let (led, redundant) = (checked.clone(), adjusting.redundant);
        let from_own = FromOwn::new(move |options| led.stands(redundant, options));
        let (adjusting, columns) = (adjusting.clone(), compiled.columns().len());
        let shared = Shared { checked, compiled, from_own, own, inputs, params, adjusting, columns, beside };
        Ok(Adjustable(Arc::new(shared)))
    }

    /// The params of some names, each of which takes a number in SI.
    fn params_to_adjust(&self, names: &[String]) -> Result<Option<Variants>, (Sources, Diagnostics)> {
        if names.is_empty() {
            return Ok(None);
        }
        let known = self.settable_params();
        let of = |name: &String| known.iter().find(|of| of.name == *name);
        let values: Vec<f64> = names.iter().filter_map(|name| Some(of(name)?.value)).collect();
        let units = names.iter().map(|name| of(name).map_or(String::new(), |of| of.unit.clone())).collect();
        let own = Varying { params: (0..names.len()).collect(), values: Levels::Listed(values) };
        let Some(points) = Points::new(names.to_vec(), vec![own]) else { return Ok(None) };
        Variants::of(points, units, self.sources().clone(), "--set").map(Some)
    }
}

impl Adjustable {
    /// What it is compiled to: its columns, their units, the names of its results.
    #[must_use]
    pub fn compiled(&self) -> &Compiled {
        &self.0.compiled
    }

    /// Follows it at the times that are asked for, as options of a run ask, with its inputs set at the first of them, and its params (SI)
    /// over those of its text, to which it is led along the branch. Each row goes to `row`, in SI and the order of its columns. Gives the
    /// results, as [`super::Run::results`] does.
    ///
    /// Values are in the order in which they were asked for.
    ///
    /// # Errors
    /// Why it does not get there, or cannot go on: no way leads there (E0612), for instance.
    pub fn follow(
        &self,
        inputs: &[InputMotion],
        params: &[f64],
        times: &AskedTimes,
        cancel: &Cancel,
        row: impl FnMut(&[f64]),
    ) -> Result<Answers, Box<Diagnostic>> {
        let (values, analysis) = self.0.values(params)?;
        let aim = self.0.aim(values, times.over(analysis)?.times()?, inputs);
        self.0.follow(&aim, cancel, row)
    }

    /// Where it is at each of so many places, which `ask` writes: the row of each, in SI and the order of its columns, goes to `found` in
    /// their order, with the bits that [`Adjustable::follow`] gives it alone; or why it does not get there. Places of which nothing is in
    /// doubt are looked at side by side. It ends when it is cancelled.
    pub fn at_each(
        &self,
        count: usize,
        mut ask: impl FnMut(usize, &mut AskedPlace),
        cancel: &Cancel,
        mut found: impl FnMut(Result<&[f64], Box<Diagnostic>>),
    ) {
        let (mut place, mut before, mut row) = (AskedPlace::default(), None, Vec::new());
        let (shared, options) = (&*self.0, self.0.options(cancel));
        for first in (0..count).step_by(LANES) {
            let mut aim = |number| {
                ask(number, &mut place);
                shared.aim_at(&place, &mut before)
            };
            let aims: Vec<Aimed> = (first..count.min(first + LANES)).map(&mut aim).collect();
            let side = shared.beside.follow(&aims, (&shared.from_own, shared.columns), &options);
            for (lane, aim) in aims.into_iter().enumerate() {
                let is_known = side.as_ref().is_some_and(|side| side.write_row(lane, &mut row));
                let alone = |aim: Aim| if is_known { Ok(()) } else { shared.last_row(&aim, cancel, &mut row) };
                let is_there = aim.and_then(alone);
                if cancel.is_cancelled() {
                    return;
                }
                found(is_there.map(|()| &row[..shared.columns]));
            }
            if let Some(side) = side {
                shared.beside.give_back(side);
            }
        }
    }
}

/// Of all params (SI), and first time, last time and step of the analysis (s), if there is one.
type Values = (Vec<f64>, Option<[f64; 3]>);

impl Shared {
    fn options(&self, cancel: &Cancel) -> RunOptions {
        let Adjusting { tolerance, pass_bifurcations, .. } = self.adjusting;
        RunOptions { tolerance, pass_bifurcations, cancel: cancel.clone(), ..RunOptions::default() }
    }

    /// What inputs make of values, set at the first of some times.
    fn aim(&self, mut values: Vec<f64>, times: Times, inputs: &[InputMotion]) -> Aim {
        for (&first, &InputMotion { value, rate, acceleration }) in self.inputs.iter().zip(inputs) {
            let of_input = [value, times.from(), rate, acceleration];
            let count = if self.adjusting.bend { 4 } else { 3 };
            values[first..first + count].copy_from_slice(&of_input[..count]);
        }
        Aim { values, times }
    }

    /// What a place asks for.
    fn aim_at(&self, place: &AskedPlace, before: &mut Before) -> Aimed {
        let is_it =
            |params: &[f64]| params.iter().map(|of| of.to_bits()).eq(place.params.iter().map(|of| of.to_bits()));
        let known = match before.take().filter(|(params, _)| is_it(params)) {
            Some(known) => known,
            None => (place.params.clone(), self.values(&place.params)?),
        };
        let (values, analysis) = &before.insert(known).1;
        let at = place.t.unwrap_or_else(|| analysis.map_or(0.0, |[from, ..]| from));
        if let Some([from, ..]) = analysis.filter(|[from, ..]| place.inputs.is_empty() && at < *from) {
            let said =
                format!("`t` is {} s, before the first time of the analysis at {} s", readable(at), readable(from));
            let help = "the motion begins there: ask for later times";
            return Err(Box::new(Diagnostic::new(Code::E0706, said).help(help)));
        }
        // inputs are what they are at that time, and not before
        let from = (!place.inputs.is_empty()).then_some(at);
        let times = AskedTimes { from, at: vec![at], ..AskedTimes::default() }.over(*analysis)?.times()?;
        Ok(self.aim(values.clone(), times, &place.inputs))
    }

    /// Of several rows the last one, which is that of the time.
    fn last_row(&self, aim: &Aim, cancel: &Cancel, row: &mut Vec<f64>) -> Result<(), Box<Diagnostic>> {
        row.resize(self.columns, f64::NAN);
        let keep = |found: &[f64]| {
            row.clear();
            row.extend_from_slice(found);
        };
        self.follow(aim, cancel, keep).map(|_| ())
    }

    fn follow(&self, aim: &Aim, cancel: &Cancel, mut row: impl FnMut(&[f64])) -> Result<Answers, Box<Diagnostic>> {
        let (options, Aim { values, times }) = (self.options(cancel), aim);
        let mut started = match self.from_own.lead_values(values, times, &options) {
            Reached::There(started) => *started?,
            Reached::Refused(said) => return Err(first_error(said)),
            Reached::Nowhere(why) => return Err(lost(why)),
        };
        // what a run tells of its start looks at the same factors
        let _ = started.conditioning();
        let has_results = !self.compiled.system().results().outcomes.is_empty();
        let interval = times.interval().filter(|_| has_results);
        let asked = interval.map(|interval| started.asked(interval, options.pass_bifurcations, cancel));
        let mut motion = started.into_motion(times);
        if options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        while let Some(found) = motion.next_row() {
            row(found?);
        }
        Ok(asked.and_then(Asked::answer).unwrap_or_default())
    }

    /// The values of all params of the model, with its own inputs, and first time, last time and step of its analysis (s).
    fn values(&self, params: &[f64]) -> Result<Values, Box<Diagnostic>> {
        let Some(variants) = &self.params else { return Ok((self.own.clone(), self.compiled.analysis())) };
        let (model, said) = self.checked.model_led_to(variants.read_settings(params), variants.sources());
        let model = model.ok_or_else(|| first_error(said))?;
        let analysis = model.analysis.map(|of| [of.from, of.to, of.every]);
        Ok((model.params.iter().map(|param| param.value).collect(), analysis))
    }
}

/// That no way leads there. Nothing else is tried then.
fn lost(why: Option<Box<Diagnostic>>) -> Box<Diagnostic> {
    match why {
        Some(why) => Box::new(Diagnostic { notes: Vec::new(), ..*why }),
        None => Box::new(Diagnostic::new(
            Code::E0612,
            "it does not stand with its own values, and so no way leads to others",
        )),
    }
}

/// The first error of what is said; there is one where something could not be made.
fn first_error(said: Diagnostics) -> Box<Diagnostic> {
    let error = said.into_iter().find(Diagnostic::is_error);
    // what was cancelled says nothing, and nobody looks at it
    Box::new(error.unwrap_or_else(|| Diagnostic::new(Code::E0601, "it was not made")))
}
