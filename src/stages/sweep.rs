//! Many variants of one mechanism, each led over to its params along the branch.

use super::checked::UNTIL;
use super::abreast::Abreast;
use super::families::{Families, Places};
use super::over::Reached;
use super::{AskedTimes, Checked, Compiled, Redundant, RunOptions, Variants, Vectors};
use crate::analysis::{Asked, Started, Times};
use crate::cancel::Cancel;
use crate::crew::{Crew, usual_jobs};
use crate::diag::{Code, Diagnostic, Diagnostics};
use crate::sweep::{Group, LANES, OneVariant, Status, Swept};
use std::sync::{Arc, OnceLock};

/// Numbers that a piece of work holds, more or less: 2 MB.
const NUMBERS: u64 = 1 << 18;
/// Variants of a piece at the most, so that the first come soon.
const MOST: u64 = 256;
/// And at least: so many are computed side by side.
const LEAST: u64 = 16;

/// How a sweep is made.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// What is asked of the times.
    pub times: AskedTimes,
    /// The columns whose rows are wanted, by their numbers; results alone where this is nothing.
    pub columns: Option<Vec<usize>>,
    /// What becomes of equations that follow from others.
    pub redundant: Redundant,
    /// As a run has it.
    pub tolerance: f64,
    /// As a run has it.
    pub pass_bifurcations: bool,
    /// So many threads; as many as the machine does at once where nothing is said.
    pub jobs: Option<usize>,
    /// So many variants are passed over.
    pub skip: u64,
    /// So many are computed at the most.
    pub take: Option<u64>,
    /// As a run has it.
    pub vectors: Vectors,
    /// Ends it.
    pub cancel: Cancel,
}

impl Default for SweepOptions {
    fn default() -> SweepOptions {
        let RunOptions { tolerance, pass_bifurcations, vectors, cancel, .. } = RunOptions::default();
        let (times, redundant) = (AskedTimes::default(), Redundant::default());
        let (columns, jobs, skip, take) = (None, None, 0, None);
        SweepOptions { times, columns, redundant, tolerance, pass_bifurcations, jobs, skip, take, vectors, cancel }
    }
}

/// A sweep in progress: what was made of its blocks, in the order of the variants.
pub struct Sweep<T> {
    crew: Crew<(T, bool)>,
    has_ended: bool,
}

impl Compiled {
    /// The names of the results that a sweep tabulates, with their units in SI.
    #[must_use]
    pub fn results_of_variants(&self) -> Vec<(String, String)> {
        let outcomes = self.system().results().outcomes.iter().filter(|outcome| outcome.name != UNTIL);
        outcomes.map(|outcome| (outcome.name.clone(), outcome.units.si.clone())).collect()
    }
}

impl Checked {
    /// Computes variants of it, and gives what is made of each block of them on the threads that compute. The sweep ends behind the variant
    /// that is looked for, if one is.
    ///
    /// It is sound, as the text has it; `compiled` is made of it.
    ///
    /// # Errors
    /// The times are not said, where all variants have the same.
    pub fn sweep<T: Send + 'static>(
        &self,
        compiled: &Compiled,
        variants: &Variants,
        options: &SweepOptions,
        make: impl Fn(Swept) -> T + Send + Sync + 'static,
    ) -> Result<Sweep<T>, Box<Diagnostic>> {
        let times = options.times.over(compiled.analysis())?.times()?;
        let numbers = match &options.columns {
            Some(columns) => times.len() * columns.len() as u64,
            None => compiled.results().len() as u64 + 1,
        };
        let size = (NUMBERS / numbers.max(1) / LEAST * LEAST).clamp(LEAST, MOST);
        let end = variants.points().count();
        let first = options.skip.min(end);
        let last = options.take.map_or(end, |take| first.saturating_add(take).min(end));
        let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
        let until = results.iter().position(|name| name == UNTIL);
        let jobs = options.jobs.unwrap_or_else(usual_jobs).max(1);
        let names = compiled.columns();
        let columns = options.columns.iter().flatten().map(|&column| names[column].clone()).collect();
        let count = results.len();
        let families = Families::of((self, variants), options.redundant, [columns, results], first);
        let (own, variants, options) = (self.clone(), variants.clone(), options.clone());
        let abreast = OnceLock::new();
        let sweeping = Arc::new(Sweeping { own, families, variants, options, results: count, until, first, abreast });
        let pieces = 0..(last - first).div_ceil(size);

        let work = move |piece: u64| {
            let begin = first + piece * size;
            let (block, is_found) = sweeping.block(begin..(begin + size).min(last))?;
            Some((make(block), is_found))
        };
        Ok(Sweep { crew: Crew::new(jobs, pieces, work), has_ended: false })
    }
}

impl<T: Send + 'static> Iterator for Sweep<T> {
    type Item = T;

    /// What was made of the next block; `None` behind the last one, behind the one with the variant that is looked for, and when it was cancelled.
    fn next(&mut self) -> Option<T> {
        if self.has_ended {
            return None;
        }
        let (made, is_found) = self.crew.next()?;
        self.has_ended = is_found;
        Some(made)
    }
}

/// What all variants have in common.
struct Sweeping {
    own: Checked,
    families: Families,
    variants: Variants,
    options: SweepOptions,
    /// How many results there are, that of the variant that is looked for among them.
    results: usize,
    /// The number of the result that is 1 for the variant that is looked for.
    until: Option<usize>,
    /// The number of the first variant.
    first: u64,
    /// What variants share that go side by side, once somebody has asked; nothing where they go alone.
    abreast: OnceLock<Option<Abreast>>,
}

impl Sweeping {
    /// Some variants, up to the one that is looked for, and whether it is among them; nothing when it was cancelled.
    fn block(&self, variants: std::ops::Range<u64>) -> Option<(Swept, bool)> {
        let columns = self.options.columns.as_ref().map_or(0, Vec::len);
        let points = self.variants.points();
        let mut block = Swept::new(
            variants.start,
            points.params().len(),
            self.results - usize::from(self.until.is_some()),
            columns,
        );
        let mut params = vec![0.0; points.params().len()];
        let mut abreast = self.abreast().map(|abreast| (abreast, Group::new(&abreast.together), [false; LANES]));
        for number in variants.clone() {
            if let Some((abreast, group, done)) = &mut abreast {
                let lane = (number - variants.start) as usize % LANES;
                if lane == 0 {
                    let side_by_side = number..variants.end.min(number + LANES as u64);
                    *done = self.follow_abreast(abreast, group, side_by_side);
                }
                if done[lane] && !self.options.cancel.is_cancelled() {
                    points.values(number, &mut params);
                    block.push_columns(&params, (0..columns).map(|place| group.column(place, lane)));
                    continue;
                }
            }
            points.values(number, &mut params);
            let mut variant = self.variant(&params);
            if self.options.cancel.is_cancelled() {
                return None;
            }
            let found = self.until.map(|until| variant.results.remove(until));
            block.push(&params, &variant);
            if found == Some(1.0) {
                return Some((block, true));
            }
        }
        Some((block, false))
    }

    /// What variants share that go side by side; nothing where they go alone.
    fn abreast(&self) -> Option<&Abreast> {
        let new = || {
            let columns = self.options.columns.as_ref().filter(|_| self.results == 0)?;
            let times = self.options.times.over(self.own.model()?.analysis.map(|of| [of.from, of.to, of.every]));
            let times = times.and_then(|times| times.times()).ok()?;
            Abreast::of(
                &self.own,
                (&self.variants, self.first),
                &self.families,
                (&times, columns),
                &self.run_options(),
            )
        };
        self.abreast.get_or_init(new).as_ref()
    }

    /// Follows some variants side by side; says which have all their rows.
    fn follow_abreast(
        &self,
        abreast: &Abreast,
        group: &mut Group<'_>,
        variants: std::ops::Range<u64>,
    ) -> [bool; LANES] {
        let mut params = vec![0.0; self.variants.points().params().len()];
        let values: Vec<Option<Vec<f64>>> = variants
            .map(|number| {
                self.variants.points().values(number, &mut params);
                abreast.values(&params)
            })
            .collect();
        group.follow(&values, &self.options.cancel)
    }

    /// A variant as `run --lead --set` has it.
    fn variant(&self, params: &[f64]) -> OneVariant {
        let mut variant = OneVariant {
            status: Status::Ok,
            stopped: f64::NAN,
            results: vec![f64::NAN; self.results],
            rows: Vec::new(),
        };
        if let Err(why) = self.run(params, &mut variant) {
            variant.status = Status::Stopped(why.code);
            variant.stopped = why.data.get("t").and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN);
        }
        variant
    }

    fn run(&self, params: &[f64], variant: &mut OneVariant) -> Result<(), Box<Diagnostic>> {
        let options = self.run_options();
        if self.own.is_told() {
            return self.run_by_all_stages(params, variant);
        }
        let family = self.families.that_of(params, &self.own, &self.variants);
        let (model, said) = self.own.model_led_to(self.variants.read_settings(params), self.variants.sources());
        let model = model.ok_or_else(|| first_error(&said))?;
        let times = self.options.times.over(model.analysis.map(|of| [of.from, of.to, of.every]))?.times()?;
        let values: Vec<f64> = model.params.iter().map(|param| param.value).collect();
        match family.from_own.lead_values(&values, &times, &options) {
            Reached::There(started) => self.follow(*started?, (&times, &options), &family.places, variant),
            Reached::Refused(said) => Err(first_error(&said)),
            Reached::Nowhere => {
                variant.status = Status::Reassembled;
                self.run_by_all_stages(params, variant)
            }
        }
    }

    /// Follows a variant that is where it was led to.
    fn follow(
        &self,
        mut started: Started,
        (times, options): (&Times, &RunOptions),
        places: &Places,
        variant: &mut OneVariant,
    ) -> Result<(), Box<Diagnostic>> {
        // what a run tells of its start looks at the same factors
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let interval = times.interval().filter(|_| self.results > 0);
        let asked = interval.map(|interval| started.asked(interval, options.pass_bifurcations, &options.cancel));
        let mut motion = started.into_motion(times);
        if options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        while let Some(row) = motion.next_row() {
            self.push_row(row?, places, variant);
        }
        let answers = asked.and_then(Asked::answer).unwrap_or_default();
        write_results(&answers.values, places, variant);
        Ok(())
    }

    /// As [`Sweeping::run`], all of it made anew but what it is led from.
    fn run_by_all_stages(&self, params: &[f64], variant: &mut OneVariant) -> Result<(), Box<Diagnostic>> {
        let options = self.run_options();
        let checked = self.own.led_to(self.variants.read_settings(params), self.variants.sources());
        if !checked.is_sound() {
            return Err(first_error(checked.diagnostics()));
        }
        let (compiled, said) = checked.compile(self.options.redundant, &options.cancel);
        let family = self.families.that_of(params, &self.own, &self.variants);
        let compiled = compiled.ok_or_else(|| first_error(&said))?.led_over(Some(Arc::clone(&family.from_own)));
        let places = self.families.places_in(&compiled);
        let times = self.options.times.over(compiled.analysis())?.times()?;
        let (run, said) = compiled.run(&times, &options);
        let mut run = run.ok_or_else(|| first_error(&said))?;
        if said.iter().any(|said| said.code == Code::E0612) {
            variant.status = Status::Reassembled;
        }
        while let Some(row) = run.next_row() {
            self.push_row(row?, &places, variant);
        }
        write_results(&run.results().unwrap_or_default().values, &places, variant);
        Ok(())
    }

    fn run_options(&self) -> RunOptions {
        let SweepOptions { tolerance, pass_bifurcations, vectors, ref cancel, .. } = self.options;
        RunOptions { tolerance, pass_bifurcations, vectors, cancel: cancel.clone(), ..RunOptions::default() }
    }

    fn push_row(&self, row: &[f64], places: &Places, variant: &mut OneVariant) {
        let Some(columns) = &self.options.columns else { return };
        match places {
            Places::Same => variant.rows.extend(columns.iter().map(|&column| row[column])),
            Places::Others { columns, .. } => {
                variant.rows.extend(columns.iter().map(|column| column.map_or(f64::NAN, |column| row[column])));
            }
        }
    }
}

fn write_results(values: &[Option<f64>], places: &Places, variant: &mut OneVariant) {
    for (k, into) in variant.results.iter_mut().enumerate() {
        let place = match places {
            Places::Same => Some(k),
            Places::Others { results, .. } => results[k],
        };
        *into = place.and_then(|place| values.get(place).copied().flatten()).unwrap_or(f64::NAN);
    }
}

/// The first error of what is said, but for that of a way that does not get there; there is one where something could not be made.
fn first_error(said: &Diagnostics) -> Box<Diagnostic> {
    let error = said.iter().find(|said| said.is_error() && said.code != Code::E0612).cloned();
    // what was cancelled says nothing, and nobody looks at it
    Box::new(error.unwrap_or_else(|| Diagnostic::new(Code::E0601, "it was not made")))
}
