//! A page with sliders: a mechanism solved for each value of what varies.

use super::MOST_ROWS;
use crate::cli::arguments::ViewArguments;
use crate::cli::failure::{Failure, unusable};
use crate::cli::files::{AskedOnce, Output};
use crate::cli::input;
use crate::cli::progress::Progress;
use crate::cli::report::Reporter;
use crate::cli::times;
use mechc_draw::scene::{Motion, Pose, bounds};
use mechc_draw::view::page::{LONGEST, Variant, Vary};
use mechc_engine::analysis::Times;
use mechc_live::page;
use mechc_pipeline::{Checked, Choice, Compiled, Parsed, RunOptions, Seen, Varied};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::Sources;
use std::mem::ManuallyDrop;

/// So many numbers all tables have together at the most, which is more than goes into a page; the rest need not be kept.
const MOST_NUMBERS: usize = 10_000_000;

pub(super) fn view(arguments: &ViewArguments, output: &str, reporter: &mut Reporter) -> Result<(), Failure> {
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, AskedOnce::default());
    let choice = Choice { pictures_forces: true, ..input::choice(&arguments.input) };
    let own = input::checked_in(&parsed, &choice, &world, reporter)?;
    let varied = own.varied(&arguments.vary, &choice, &world).map_err(|(sources, said)| {
        reporter.sources = sources;
        said
    })?;
    let file = Output::open(output, &reporter.spared())?;
    let solver = Solver { arguments, parsed: &parsed, choice: &choice, world: &world, varied: &varied };
    let (variants, first) = solver.all(reporter)?;
    let text = solver.page(&variants, first, &reporter.sources)?;
    file.close_with_text(&text)?;
    solver.tell(&variants, text.len(), reporter);
    match &variants[first].stopped {
        Some((sources, why)) => {
            reporter.sources = sources.clone();
            let with = solver.settings(first).join(", ");
            let told =
                why.iter().cloned().map(|why| if why.is_error() { why.note(format!("with {with}")) } else { why });
            let mut said = Diagnostics::default();
            said.extend(told);
            Err(said.into())
        }
        None => Ok(()),
    }
}

/// A variant as it is shown.
struct Solved {
    seen: Seen,
    /// Why its motion is not there, or not all of it, with the texts that this speaks of.
    stopped: Option<(Sources, Diagnostics)>,
}

/// What the variants have in common.
struct Solver<'s> {
    arguments: &'s ViewArguments,
    parsed: &'s Parsed,
    choice: &'s Choice,
    world: &'s AskedOnce,
    varied: &'s [Varied],
}

impl Solver<'_> {
    fn count(&self) -> usize {
        self.varied.iter().map(|varied| varied.values.len()).product()
    }

    /// Which value of each that varies a variant has: in the order of the product, the last fastest.
    fn places(&self, variant: usize) -> Vec<usize> {
        let mut rest = variant;
        let place = |varied: &Varied| {
            let place = rest % varied.values.len();
            rest /= varied.values.len();
            place
        };
        let mut places: Vec<usize> = self.varied.iter().rev().map(place).collect();
        places.reverse();
        places
    }

    /// What sets a variant, as messages and the check have it.
    fn settings(&self, variant: usize) -> Vec<String> {
        let places = self.places(variant);
        self.varied.iter().zip(places).map(|(varied, place)| varied.settings[place].clone()).collect()
    }

    /// All variants, and which of them is the first to be shown.
    fn all(&self, reporter: &mut Reporter) -> Result<(Vec<Solved>, usize), Failure> {
        let first = self.varied.iter().fold(0, |place, varied| place * varied.values.len() + varied.nearest);
        let (checked, made, said) = self.made(first, MOST_ROWS);
        reporter.sources = checked.sources().clone();
        let begun = match made {
            // it is told at the end, when the page is there
            Some(at_rest) if !has_moved(&at_rest) => at_rest,
            made => reporter.settle(made, said)?,
        };
        let most = (MOST_NUMBERS / (self.count() * begun.columns.len())).clamp(2, MOST_ROWS);
        let progress = &mut Progress::of("variants", self.count() as u64, false);
        let mut all = Vec::with_capacity(self.count());
        for variant in 0..self.count() {
            let (checked, made, said) = self.made(variant, most);
            let errors = match made.as_ref().and_then(|seen| seen.stopped.clone()) {
                Some(stop) => stop.into(),
                None if made.as_ref().is_some_and(has_moved) => Diagnostics::default(),
                None => errors_of(&said),
            };
            let stopped = (!errors.is_empty()).then(|| (checked.sources().clone(), errors));
            let seen = made.unwrap_or_else(|| without_picture(said, &begun));
            if seen.columns != begun.columns {
                progress.finish();
                return Err(of_other_columns(&self.settings(variant)).into());
            }
            all.push((checked, Solved { seen, stopped }));
            progress.tick();
        }
        progress.finish();
        Ok((alike(all), first))
    }

    /// A variant and its motion, if it has one, with what is to be said of it.
    fn made(&self, variant: usize, most: usize) -> (ManuallyDrop<Checked>, Option<Seen>, Diagnostics) {
        let choice = Choice { varied: self.settings(variant), ..self.choice.clone() };
        // see `run`: nothing is taken apart before the process ends
        let checked = ManuallyDrop::new(self.parsed.check(&choice, self.world));
        let mut said = checked.diagnostics().clone();
        if !checked.is_sound() {
            return (checked, None, said);
        }
        let (compiled, more) = input::proven(&checked, self.arguments.allow_redundant);
        said.extend(more);
        let pass_bifurcations = self.arguments.pass_bifurcations;
        let options = RunOptions { pass_bifurcations, ..RunOptions::default() };
        let times = match &compiled {
            None => None,
            Some(compiled) => match self.times(&checked, compiled) {
                Ok(times) => Some((compiled, times)),
                Err(why) => {
                    said.extend(why);
                    None
                }
            },
        };
        let seen = times.as_ref().and_then(|(compiled, times)| {
            let (seen, more) = checked.seen(compiled, times, &options, most);
            said.extend(more);
            seen
        });
        let from = times.as_ref().map_or(0.0, |(_, times)| times.from());
        let seen = seen.or_else(|| checked.seen_at_rest(compiled.as_ref(), (from, &options), &said));
        (checked, seen, said)
    }

    /// Its times, which may depend on what varies.
    fn times(&self, checked: &Checked, compiled: &Compiled) -> Result<Times, Diagnostics> {
        let (arguments, mut sources) = (self.arguments, checked.sources().clone());
        let asked = times::asked((&arguments.interval, &arguments.at), compiled.analysis(), &mut sources);
        let times = asked.and_then(|asked| Ok(asked.whole()?));
        times.map_err(|why| match why {
            Failure::Said(said) => said,
            Failure::ReaderGone => Diagnostics::default(),
        })
    }

    fn page(&self, variants: &[Solved], first: usize, sources: &Sources) -> Result<String, Failure> {
        let vary = |varied: &Varied| {
            let Varied { name, unit, values, nearest, own, .. } = varied.clone();
            Vary { name, unit, values, nearest, own }
        };
        let shown: Vec<Variant> = variants.iter().map(|solved| page::variant(&solved.seen)).collect();
        let text = page::written_with(&variants[first].seen, self.varied.iter().map(vary).collect(), shown, sources);
        if text.len() > LONGEST {
            let said =
                format!("the page of {} variants would have {} MB", variants.len(), text.len().div_ceil(1_000_000));
            let help = format!("it has {} at most: ask for fewer values", LONGEST / 1_000_000);
            return Err(unusable(said).help(help).into());
        }
        Ok(text)
    }

    /// How large the page is, and which variants are not whole.
    fn tell(&self, variants: &[Solved], size: usize, reporter: &mut Reporter) {
        let broken: Vec<usize> = (0..variants.len()).filter(|&variant| variants[variant].stopped.is_some()).collect();
        let why = broken.first().and_then(|&variant| Some((variant, variants[variant].stopped.as_ref()?)));
        if reporter.is_for_programs() {
            if let Some((_, (sources, said))) = why {
                reporter.sources = sources.clone();
                reporter.print(said);
            }
            return;
        }
        let count = variants.len();
        let mut told = format!("{count} variants, {} kB\n", size.div_ceil(1000));
        if let Some((variant, (_, said))) = why {
            let with = self.settings(variant).join(", ");
            told += &format!("{} of them cannot be shown whole; the first is that with {with}:\n", broken.len());
            if let Some(error) = said.iter().find(|said| said.is_error()) {
                told += &format!("  {}[{}]: {}\n", error.severity().as_str(), error.code, error.message);
            }
        }
        Reporter::say(&told);
    }
}

/// Whether there is a motion, be it whole or not.
fn has_moved(seen: &Seen) -> bool {
    !seen.motion.rows().is_empty()
}

fn errors_of(said: &Diagnostics) -> Diagnostics {
    let mut errors = Diagnostics::default();
    for error in said.iter().filter(|said| said.is_error()) {
        errors.push(error.clone());
    }
    errors
}

/// What is seen of a variant that is not sound: nothing but its text.
fn without_picture(said: Diagnostics, begun: &Seen) -> Seen {
    let mut scene = begun.scene.clone();
    scene.frames.truncate(1);
    scene.points.clear();
    scene.nodes.clear();
    scene.traces.clear();
    scene.profiles.clear();
    scene.contacts.clear();
    scene.named.clear();
    let motion = Motion::still(vec![Pose::default()]);
    let results = begun.results.iter().map(|(name, unit, _)| (name.clone(), unit.clone(), None)).collect();
    Seen { scene, motion, all_rows: 0, stopped: None, said, results, ..begun.clone() }
}

/// All have symbols of one size and the extent of all, so that nothing jumps when a slider moves.
fn alike(all: Vec<(ManuallyDrop<Checked>, Solved)>) -> Vec<Solved> {
    let mut units: Vec<f64> =
        all.iter().filter(|(_, solved)| has_moved(&solved.seen)).map(|(_, solved)| solved.seen.scene.unit).collect();
    units.sort_by(f64::total_cmp);
    let unit = units.get(units.len() / 2).copied();
    let redrawn = |(checked, mut solved): (ManuallyDrop<Checked>, Solved)| {
        let seen = &solved.seen;
        let scene = unit.filter(|_| has_moved(seen)).and_then(|unit| checked.drawn_with_symbols(seen, unit));
        solved.seen.scene = scene.unwrap_or(solved.seen.scene);
        solved
    };
    let mut all: Vec<Solved> = all.into_iter().map(redrawn).collect();
    let drawn = all.iter().map(|solved| &solved.seen.scene).filter(|scene| !scene.nodes.is_empty());
    if let Some(extent) = bounds(drawn.flat_map(|scene| scene.extent)) {
        for solved in &mut all {
            solved.seen.scene.extent = extent;
        }
    }
    all
}

fn of_other_columns(settings: &[String]) -> Diagnostic {
    unusable(format!("with {} there are other columns, and one page cannot show both", settings.join(", ")))
        .help("write a page for each, with `--set`")
}
