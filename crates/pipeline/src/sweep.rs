//! Many variants of one mechanism, each led over to its params along the branch.

use super::abreast::{Abreast, Side};
use super::families::{Families, Places};
use super::over::Reached;
use super::{AskedTimes, Checked, Compiled, Redundant, RunOptions, Variants, Vectors};
use mechc_engine::analysis::{Asked, Started, Times};
use mechc_engine::sweep::{LANES, OneVariant, PART, Spare, Status, Swept, Team};
use mechc_lang::check::UNTIL;
use mechc_parallel::{Crew, usual_jobs};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Numbers that a piece of work holds, more or less: half a megabyte, which stays where the processor has it at hand.
const NUMBERS: u64 = 1 << 16;
/// What is done once for each column of a piece is worth so many rows; then it may hold so many numbers, 4 MB.
const ROWS: u64 = 1 << 14;
const NUMBERS_OF_MANY_COLUMNS: u64 = 1 << 19;
/// Variants of a piece at the most, so that the first come soon; of those of which all rows are wanted, each takes less time.
const MOST: u64 = 256;
const MOST_WITH_ROWS: u64 = 512;
/// A sweep has so many pieces if it can, so that each of many threads gets some.
const FEWEST_PIECES: u64 = 32;
/// Rows of one variant are held until it is done: no more numbers than 2 GiB hold.
const MOST_OF_A_VARIANT: u64 = 1 << 28;
/// A thread keeps the memory of so many blocks: who reads one has it while the next is made.
const KEPT: usize = 2;
/// All lanes are used as long as a piece holds no more numbers than this: 32 MB.
const MOST_NUMBERS: u64 = 1 << 22;

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
    /// So many threads, of which the one that asks for blocks is one; as many as the machine does at once where nothing is said.
    pub jobs: Option<usize>,
    /// Whether it is told how many digits of results are certain; such variants go alone.
    pub digits: bool,
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
        let (columns, jobs, digits, skip, take) = (None, None, false, 0, None);
        SweepOptions {
            times,
            columns,
            redundant,
            tolerance,
            pass_bifurcations,
            jobs,
            digits,
            skip,
            take,
            vectors,
            cancel,
        }
    }
}

/// How many of `count` variants a piece of work holds, and no more than `most`, of each of which there are so many numbers, in so many columns.
fn variants_of_a_piece((numbers, columns): (u64, u64), count: u64, most: u64) -> u64 {
    let lanes = LANES as u64;
    let wanted = ROWS.saturating_mul(columns).clamp(NUMBERS, NUMBERS_OF_MANY_COLUMNS);
    let all = (wanted / numbers).min(count / FEWEST_PIECES).min(most) / lanes * lanes;
    let all = all.max(lanes);
    let fewer = [all, PART as u64].into_iter().find(|variants| variants * numbers <= MOST_NUMBERS);
    fewer.unwrap_or(1)
}

/// The variants that are computed, in pieces of work.
#[derive(Clone, Copy)]
struct Pieces {
    first: u64,
    /// Behind the last one.
    end: u64,
    /// How many each has, but for the last.
    size: u64,
}

impl Pieces {
    /// Those of `count` variants that are asked for.
    fn of(options: &SweepOptions, count: u64, numbers: (u64, u64), most: u64) -> Pieces {
        let first = options.skip.min(count);
        let end = options.take.map_or(count, |take| first.saturating_add(take).min(count));
        Pieces { first, end, size: variants_of_a_piece(numbers, end - first, most) }
    }

    fn count(&self) -> u64 {
        (self.end - self.first).div_ceil(self.size)
    }

    /// Those of a piece, by its number.
    fn variants(&self, piece: u64) -> Range<u64> {
        let begin = self.first + piece * self.size;
        begin..begin.saturating_add(self.size).min(self.end)
    }
}

/// A sweep in progress: what was made of its blocks, in the order of the variants.
pub struct Sweep<T> {
    crew: Crew<(T, Option<End>)>,
    end: Option<End>,
}

/// Why a sweep ends before its last variant is done.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum End {
    /// The variant that is looked for is the last of what was made.
    Found,
    Cancelled,
}

impl<T> Sweep<T> {
    /// Whether the last variant of what it gave is the one that is looked for.
    #[must_use]
    pub fn has_found(&self) -> bool {
        self.end == Some(End::Found)
    }
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
    /// The times are not said, or a variant would have more rows at them than are held at once.
    pub fn sweep<T: Send + 'static>(
        &self,
        compiled: &Compiled,
        variants: &Variants,
        options: &SweepOptions,
        make: impl Fn(Swept) -> T + Send + Sync + 'static,
    ) -> Result<Sweep<T>, Box<Diagnostic>> {
        let times = options.times.over(compiled.analysis())?.times()?;
        let (rows, width, most) = match &options.columns {
            Some(columns) => (times.len(), columns.len() as u64, MOST_WITH_ROWS),
            None => (1, compiled.results().len() as u64 + 1, MOST),
        };
        let numbers = rows.saturating_mul(width);
        if numbers > MOST_OF_A_VARIANT {
            return Err(Box::new(too_many_rows(rows, width)));
        }
        let pieces = Pieces::of(options, variants.points().count(), (numbers.max(1), width), most);
        let first = pieces.first;
        let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
        let until = results.iter().position(|name| name == UNTIL);
        let jobs = options.jobs.unwrap_or_else(usual_jobs).max(1);
        let names = compiled.columns();
        let columns = options.columns.iter().flatten().map(|&column| names[column].clone()).collect();
        let all = results.len();
        let families = Families::of((self, variants), options.redundant, [columns, results], first);
        let (own, variants, options) = (self.clone(), variants.clone(), options.clone());
        let (abreast, without_until) = (OnceLock::new(), OnceLock::new());
        let sweeping =
            Sweeping { own, families, variants, options, results: all, until, first, abreast, without_until };
        let (sweeping, make) = (Arc::new(sweeping), Arc::new(make));
        let start = move || {
            let (mut worker, make) = (Worker::of(&sweeping), Arc::clone(&make));
            move |piece: u64| {
                let (block, end) = worker.block(pieces.variants(piece))?;
                Some((make(block), end))
            }
        };
        Ok(Sweep { crew: Crew::new(jobs, 0..pieces.count(), start), end: None })
    }
}

impl<T: Send + 'static> Iterator for Sweep<T> {
    type Item = T;

    /// What was made of the next block; `None` behind the last one, behind the one with the variant that is looked for, and when it was
    /// cancelled: the last block holds what was done of it by then.
    fn next(&mut self) -> Option<T> {
        let (made, end) = self.crew.next()?;
        self.end = end;
        if end.is_some() {
            self.crew.end();
        }
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
    /// The same without what a variant is looked for by, once one has stopped.
    without_until: OnceLock<Box<Sweeping>>,
}

/// Who computes blocks one after the other, in memory of his own, which comes back to him.
struct Worker {
    sweeping: Arc<Sweeping>,
    /// Variants that go side by side, once some have.
    side: Option<Side>,
    /// Memory of columns that are done with.
    spare: Arc<Spare>,
}

/// Variants that went side by side.
struct Done<'d> {
    team: &'d Team,
    /// Which of them have all their rows, or all their results where no rows are wanted.
    lanes: [bool; LANES],
    /// How many rows each has.
    rows: usize,
    /// By column: what was written of all of them, row after row; nothing where all that is wanted of all is there, and stands in the block.
    aside: Option<Vec<Vec<f64>>>,
}

impl<'d> Done<'d> {
    /// Follows variants, by their params.
    fn of(of: &Abreast, side: &'d mut Side, block: &mut Swept, params: &[f64], sweeping: &Sweeping) -> Done<'d> {
        let (count, rows) = (params.len() / sweeping.width(), of.rows());
        let before = block.columns.first().map_or(0, |column| column.len());
        let lanes = of.follow(side, params, block.room(count, rows), &sweeping.options.cancel);
        let team = &side.team;
        let is_whole = (0..count).all(|lane| lanes[lane] && sweeping.has_all(team, lane));
        Done { team, lanes, rows, aside: (!is_whole).then(|| block.take_room(before)) }
    }
}

impl Worker {
    /// One who has computed nothing yet.
    fn of(sweeping: &Arc<Sweeping>) -> Worker {
        Worker { sweeping: Arc::clone(sweeping), side: None, spare: Arc::new(Spare::new(KEPT)) }
    }

    /// Some variants, up to the one that is looked for, or to where it was cancelled, and why the sweep ends there, if it does; nothing where
    /// that is before the first.
    fn block(&mut self, variants: Range<u64>) -> Option<(Swept, Option<End>)> {
        let Worker { sweeping, side, spare } = self;
        let (points, abreast, width) = (sweeping.variants.points(), sweeping.abreast(), sweeping.width());
        let mut beside = abreast.map(|abreast| (abreast, side.get_or_insert_with(|| abreast.side())));
        let mut block = sweeping.empty_block(variants.start);
        let rows = (variants.end - variants.start) as usize * abreast.map_or(0, Abreast::rows);
        block.reserve(rows, spare);
        let mut params = vec![0.0; width * LANES];
        let mut end = None;
        for first in variants.clone().step_by(LANES) {
            let count = (variants.end - first).min(LANES as u64) as usize;
            for (number, params) in (first..variants.end).zip(params.chunks_exact_mut(width)) {
                points.values(number, params);
            }
            let params = &params[..count * width];
            let done = beside.as_mut().map(|(abreast, side)| Done::of(abreast, side, &mut block, params, sweeping));
            end = sweeping.push_all(&mut block, params, done.as_ref());
            if end.is_some() {
                break;
            }
        }
        let is_empty = end == Some(End::Cancelled) && block.is_empty();
        (!is_empty).then_some((block, end))
    }
}

impl Sweeping {
    /// One that is to begin with a variant.
    fn empty_block(&self, first: u64) -> Swept {
        let results = self.results - usize::from(self.until.is_some());
        let columns = self.options.columns.as_ref().map_or(0, Vec::len);
        let params = self.variants.points().params().len();
        Swept { digits: self.options.digits.then(Vec::new), ..Swept::new(first, params, results, columns) }
    }

    /// How many values a variant has, one at least.
    fn width(&self) -> usize {
        self.variants.points().params().len().max(1)
    }

    /// Adds variants, some of which went side by side, by their params; up to the one that is looked for, or to where it was cancelled.
    fn push_all(&self, block: &mut Swept, params: &[f64], done: Option<&Done<'_>>) -> Option<End> {
        let width = self.width();
        let count = params.len() / width;
        if let Some(done) = done.filter(|done| done.aside.is_none()) {
            block.push_abreast((count, done.rows), params);
            (0..count).filter_map(|lane| done.team.results(lane)).for_each(|known| block.push_results_abreast(known));
            return None;
        }
        for (lane, params) in params.chunks_exact(width).enumerate() {
            if self.options.cancel.is_cancelled() {
                return Some(End::Cancelled);
            }
            let before = block.len();
            let found = self.push_one(block, params, done.filter(|done| done.lanes[lane]).map(|done| (done, lane)));
            if self.options.cancel.is_cancelled() {
                // of this one not all may be there
                block.truncate(before);
                return Some(End::Cancelled);
            }
            if found == Some(1.0) {
                return Some(End::Found);
            }
        }
        None
    }

    /// Whether all that is wanted of a variant that went side by side is there, and none is looked for.
    fn has_all(&self, team: &Team, lane: usize) -> bool {
        self.results == 0 || self.until.is_none() && team.results(lane).is_some()
    }

    /// Adds a variant, by its params: what has all its rows, side by side, wants its results alone, unless they are known too. Gives the result that
    /// tells whether it is looked for.
    fn push_one(&self, block: &mut Swept, params: &[f64], beside: Option<(&Done<'_>, usize)>) -> Option<f64> {
        let beside = beside.and_then(|(done, lane)| match done.team.results(lane) {
            Some(results) => Some((done, lane, (results.to_vec(), 0), true)),
            None => Some((done, lane, self.results_of(params)?, false)),
        });
        let Some((done, lane, (mut results, digits), is_known)) = beside else {
            let mut variant = self.variant(params);
            let found = self.until.map(|until| variant.results.remove(until));
            block.push(params, &variant);
            return found;
        };
        let found = self.until.map(|until| results.remove(until));
        for (column, from) in block.columns.iter_mut().zip(done.aside.iter().flatten()) {
            column.extend(from[lane * done.rows..(lane + 1) * done.rows].iter().copied());
        }
        block.push_abreast((1, done.rows), params);
        if is_known {
            block.push_results_abreast(&results);
        } else {
            block.push_results(&results);
            block.push_digits(digits);
        }
        found
    }

    /// The results of a variant which is known to have all its rows, and how many digits of them are certain; nothing where they cannot be had
    /// without these.
    fn results_of(&self, params: &[f64]) -> Option<(Vec<f64>, u32)> {
        let options = self.run_options();
        let family = self.families.that_of(params, &self.own, &self.variants);
        let (model, _) = self.own.model_led_to(self.variants.read_settings(params), self.variants.sources());
        let model = model?;
        let times = self.options.times.over(model.analysis.map(|of| [of.from, of.to, of.every])).ok()?.times().ok()?;
        let values: Vec<f64> = model.params.iter().map(|param| param.value).collect();
        let Reached::There(Ok(mut started)) = family.from_own.lead_values(&values, &times, &options) else {
            return None;
        };
        let asked = self.asked(&mut started, &times, &options);
        let mut results = vec![f64::NAN; self.results];
        let answers = asked.and_then(Asked::answer).unwrap_or_default();
        write_results(&answers.values, &family.places, &mut results);
        Some((results, answers.certain_digits()))
    }

    /// What results are computed from, where there are any.
    fn asked(&self, started: &mut Started, times: &Times, options: &RunOptions) -> Option<Asked> {
        // what a run tells of its start looks at the same factors
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let interval = times.interval().filter(|_| self.results > 0);
        interval.map(|interval| started.asked(interval, options.pass_bifurcations, &options.cancel))
    }

    /// What variants share that go side by side; nothing where they go alone.
    fn abreast(&self) -> Option<&Abreast> {
        let new = || {
            let columns = self.options.columns.as_deref();
            let wants_results = self.results > 0 && !self.options.digits;
            if columns.is_none() && !wants_results {
                return None;
            }
            let (variants, wanted) = ((&self.variants, self.first), (&self.options.times, columns, wants_results));
            Abreast::of(&self.own, variants, &self.families, wanted, &self.run_options())
        };
        self.abreast.get_or_init(new).as_ref()
    }

    /// A variant as `run --lead --set` has it. What it is looked for by decides nothing of it: where that is what stopped it, as a place that this
    /// variant does not have, it does not hold.
    fn variant(&self, params: &[f64]) -> OneVariant {
        let variant = self.variant_with_all(params);
        let Some(until) = self.until.filter(|_| matches!(variant.status, Status::Stopped(_))) else { return variant };
        let mut variant =
            self.without_until.get_or_init(|| Box::new(self.made_without(until))).variant_with_all(params);
        variant.results.insert(until, f64::NAN);
        variant
    }

    /// The same without a result that variants are looked for by, by its number.
    fn made_without(&self, until: usize) -> Sweeping {
        let own = self.own.without_until();
        let families = self.families.without(until, (&own, &self.variants), self.first);
        let (variants, options) = (self.variants.clone(), self.options.clone());
        let (results, first) = (self.results - 1, self.first);
        let (abreast, without_until) = (OnceLock::new(), OnceLock::new());
        Sweeping { own, families, variants, options, results, until: None, first, abreast, without_until }
    }

    /// The same with all that it is asked, what it is looked for by among it.
    fn variant_with_all(&self, params: &[f64]) -> OneVariant {
        let mut variant = OneVariant {
            status: Status::Ok,
            stopped: f64::NAN,
            results: vec![f64::NAN; self.results],
            digits: 0,
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
            Reached::Nowhere(_) => {
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
        let mut asked = self.asked(&mut started, times, options);
        // of rows that nobody wants all that matters is whether there are any
        let early = asked.take_if(|_| self.options.columns.is_none()).and_then(Asked::answer);
        if !early.as_ref().is_some_and(|answers| answers.has_all_rows) {
            let mut motion = started.into_motion(times);
            if options.pass_bifurcations {
                motion.pass_bifurcations();
            }
            while let Some(row) = motion.next_row() {
                self.push_row(row?, places, variant);
            }
        }
        let answers = early.or_else(|| asked.and_then(Asked::answer)).unwrap_or_default();
        write_results(&answers.values, places, &mut variant.results);
        variant.digits = answers.certain_digits();
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
        let answers = run.results().unwrap_or_default();
        write_results(&answers.values, &places, &mut variant.results);
        variant.digits = answers.certain_digits();
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

fn write_results(values: &[Option<f64>], places: &Places, results: &mut [f64]) {
    for (k, into) in results.iter_mut().enumerate() {
        let place = match places {
            Places::Same => Some(k),
            Places::Others { results, .. } => results[k],
        };
        *into = place.and_then(|place| values.get(place).copied().flatten()).unwrap_or(f64::NAN);
    }
}

fn too_many_rows(rows: u64, width: u64) -> Diagnostic {
    let said = format!("a variant would have {rows} rows of {width} numbers, more than are held at once");
    let help = "take a larger step with `--every`, or fewer columns;\n`mechc run --lead --set …` writes the rows of one variant as they come";
    Diagnostic::new(Code::E0706, said).help(help)
}

/// The first error of what is said, but for that of a way that does not get there; there is one where something could not be made.
fn first_error(said: &Diagnostics) -> Box<Diagnostic> {
    let error = said.iter().find(|said| said.is_error() && said.code != Code::E0612).cloned();
    // what was cancelled says nothing, and nobody looks at it
    Box::new(error.unwrap_or_else(|| Diagnostic::new(Code::E0601, "it was not made")))
}

#[cfg(test)]
mod tests {
    use super::{FEWEST_PIECES, LANES, MOST, MOST_NUMBERS, MOST_WITH_ROWS, variants_of_a_piece};

    #[test]
    fn pieces_fill_lanes_and_little_memory() {
        let all = [1, 2, 400, 9_720, 131_072, 131_073, 500_000, 600_000, 1 << 40];
        let all = all.into_iter().flat_map(|numbers| [(numbers, 1), (numbers, 40), (numbers, numbers)]);
        let counts = [0, 1, 33, 1_000, 8_000, 100_000, u64::MAX];
        for ((size, count), most) in
            all.flat_map(|size| counts.map(|count| (size, count))).zip([MOST, MOST_WITH_ROWS].into_iter().cycle())
        {
            let ((numbers, _), variants) = (size, variants_of_a_piece(size, count, most));
            let of = format!("{variants} of {count} with {size:?}");
            assert!(variants == 1 || variants * numbers <= MOST_NUMBERS, "{of}");
            assert!((1..=most).contains(&variants), "{of}");
            let could_be_more = LANES as u64 * numbers <= MOST_NUMBERS;
            assert!(!could_be_more || variants.is_multiple_of(LANES as u64), "{of}");
            // no thread waits while another one has all of it
            assert!(variants <= LANES as u64 || count / variants >= FEWEST_PIECES, "{of}");
        }
    }

    #[test]
    fn many_variants_with_few_numbers_make_large_pieces() {
        assert_eq!(variants_of_a_piece((1, 1), 1_000_000, MOST), MOST);
        assert_eq!(variants_of_a_piece((3, 3), 1_000_000, MOST_WITH_ROWS), MOST_WITH_ROWS);
        assert_eq!(variants_of_a_piece((3, 3), 3_200, MOST_WITH_ROWS), 96);
    }
}
