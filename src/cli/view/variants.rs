//! `--vary`: a page with sliders, for which the mechanism is solved with each value of the params that vary.

use super::MAX_ROWS;
use crate::cli::arguments::ViewArguments;
use crate::cli::failure::{Failure, unusable};
use crate::cli::files::{CachedDisk, Output};
use crate::cli::input;
use crate::cli::progress::Progress;
use crate::cli::report::Reporter;
use mechc_draw::scene::{Motion, Pose, bounds};
use mechc_draw::view::page::{LONGEST, Variant, Vary};
use mechc_engine::analysis::Times;
use mechc_live::page;
use mechc_pipeline::{Checked, Choice, Compiled, Parsed, RunOptions, SliderRange, Visualization};
use mechc_text::diag::{Diagnostic, Diagnostics, Error};
use mechc_text::source::Sources;
use std::mem::ManuallyDrop;

/// The maximum number of values in all tables together, which is more than fits into a page.
const MAX_VALUES: usize = 10_000_000;

pub(super) fn view(arguments: &ViewArguments, output: &str, reporter: &mut Reporter) -> Result<(), Failure> {
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, CachedDisk::default());
    let choice = Choice { pictures_forces: true, ..input::choice(&arguments.input) };
    let nominal = input::checked_in(&parsed, &choice, &world, reporter)?;
    let varied = nominal.slider_ranges(&arguments.vary, &choice, &world)?;
    let file = Output::open(output, &reporter.protected())?;
    let solver = VariantSolver { arguments, parsed: &parsed, choice: &choice, world: &world, varied: &varied };
    let (variants, first) = solver.solve_all(reporter)?;
    let text = solver.page(&variants, first, &reporter.sources)?;
    file.close_with_text(&text)?;
    solver.print_summary(&variants, text.len(), reporter);
    match &variants[first].stopped {
        Some(why) => {
            let with = solver.settings(first).join(", ");
            let with_settings = why
                .diagnostics
                .iter()
                .cloned()
                .map(|why| if why.is_error() { why.note(format!("with {with}")) } else { why });
            let mut diagnostics = Diagnostics::default();
            diagnostics.extend(with_settings);
            Err(Error::new(diagnostics, &why.sources).into())
        }
        None => Ok(()),
    }
}

/// A solved variant.
struct SolvedVariant {
    visualization: Visualization,
    /// The reason why its motion is missing or incomplete.
    stopped: Option<Error>,
}

/// The outcome of solving a variant.
struct Attempt {
    checked: ManuallyDrop<Checked>,
    visualization: Option<Visualization>,
    diagnostics: Diagnostics,
}

/// Solves the variants of a mechanism.
struct VariantSolver<'s> {
    arguments: &'s ViewArguments,
    parsed: &'s Parsed,
    choice: &'s Choice,
    world: &'s CachedDisk,
    varied: &'s [SliderRange],
}

impl VariantSolver<'_> {
    fn count(&self) -> usize {
        self.varied.iter().map(|varied| varied.values.len()).product()
    }

    /// Returns the index of each param's value in a variant; the last param varies fastest.
    fn value_indices(&self, variant: usize) -> Vec<usize> {
        let mut rest = variant;
        let index = |varied: &SliderRange| {
            let index = rest % varied.values.len();
            rest /= varied.values.len();
            index
        };
        let mut indices: Vec<usize> = self.varied.iter().rev().map(index).collect();
        indices.reverse();
        indices
    }

    /// Returns the settings of a variant, as `--set` takes them.
    fn settings(&self, variant: usize) -> Vec<String> {
        let indices = self.value_indices(variant);
        self.varied.iter().zip(indices).map(|(varied, index)| varied.settings[index].clone()).collect()
    }

    /// Solves all variants; returns them with the index of the one to show first.
    fn solve_all(&self, reporter: &mut Reporter) -> Result<(Vec<SolvedVariant>, usize), Failure> {
        let first = self.varied.iter().fold(0, |index, varied| index * varied.values.len() + varied.nearest);
        let Attempt { checked, visualization: solved, diagnostics } = self.solve(first, MAX_ROWS);
        reporter.sources = checked.sources().clone();
        let template = match solved {
            // its diagnostics follow once the page is written
            Some(at_rest) if !has_motion(&at_rest) => at_rest,
            solved => reporter.require(solved, diagnostics)?,
        };
        let max_rows = (MAX_VALUES / (self.count() * template.columns.len())).clamp(2, MAX_ROWS);
        let progress = &mut Progress::counting("variants", self.count() as u64, false);
        let mut all = Vec::with_capacity(self.count());
        for variant in 0..self.count() {
            let Attempt { checked, visualization: solved, diagnostics } = self.solve(variant, max_rows);
            let errors = match solved.as_ref().and_then(|solved| solved.stopped.clone()) {
                Some(stop) => stop.into(),
                None if solved.as_ref().is_some_and(has_motion) => Diagnostics::default(),
                None => errors_of(&diagnostics),
            };
            let stopped = (!errors.is_empty()).then(|| Error::new(errors, checked.sources()));
            let visualization = solved.unwrap_or_else(|| without_picture(diagnostics, &template));
            if visualization.columns != template.columns {
                progress.finish();
                return Err(different_columns(&self.settings(variant)).into());
            }
            all.push((checked, SolvedVariant { visualization, stopped }));
            progress.tick();
        }
        progress.finish();
        Ok((unify_scenes(all), first))
    }

    /// Solves a variant; returns its visualization, if there is one, with its diagnostics.
    fn solve(&self, variant: usize, max_rows: usize) -> Attempt {
        let choice = Choice { varied: self.settings(variant), ..self.choice.clone() };
        // see `run`: nothing is dropped before the process ends
        let checked = ManuallyDrop::new(self.parsed.check(&choice, self.world));
        let mut diagnostics = checked.diagnostics().clone();
        if !checked.is_sound() {
            return Attempt { checked, visualization: None, diagnostics };
        }
        let (compiled, more) = input::prove(&checked, self.arguments.allow_redundant);
        diagnostics.extend(more);
        let pass_bifurcations = self.arguments.pass_bifurcations;
        let options = RunOptions { pass_bifurcations, ..RunOptions::default() };
        let times = match &compiled {
            None => None,
            Some(compiled) => match self.times(&checked, compiled) {
                Ok(times) => Some((compiled, times)),
                Err(why) => {
                    diagnostics.extend(why);
                    None
                }
            },
        };
        let moving = times.as_ref().and_then(|(compiled, times)| {
            let (moving, more) = checked.visualize(compiled, times, &options, max_rows);
            diagnostics.extend(more);
            moving
        });
        let from = times.as_ref().map_or(0.0, |(_, times)| times.from());
        let visualization =
            moving.or_else(|| checked.static_visualization(compiled.as_ref(), (from, &options), &diagnostics));
        Attempt { checked, visualization, diagnostics }
    }

    /// Returns the times of a variant, which may depend on its params.
    fn times(&self, checked: &Checked, compiled: &Compiled) -> Result<Times, Diagnostics> {
        let (arguments, mut sources) = (self.arguments, checked.sources().clone());
        let requested = input::requested_times(&arguments.interval, &arguments.at, compiled.analysis(), &mut sources);
        let times = requested.and_then(|times| Ok(times.whole()?));
        times.map_err(Failure::into_diagnostics)
    }

    fn page(&self, variants: &[SolvedVariant], first: usize, sources: &Sources) -> Result<String, Failure> {
        let vary = |varied: &SliderRange| {
            let SliderRange { name, unit, values, nearest, nominal, .. } = varied.clone();
            Vary { name, unit, values, nearest, nominal }
        };
        let shown: Vec<Variant> = variants.iter().map(|solved| page::variant(&solved.visualization)).collect();
        let text = page::render_variants(
            &variants[first].visualization,
            self.varied.iter().map(vary).collect(),
            shown,
            sources,
        );
        if text.len() > LONGEST {
            let message =
                format!("the page of {} variants would have {} MB", variants.len(), text.len().div_ceil(1_000_000));
            let help = format!("it has {} at most: ask for fewer values", LONGEST / 1_000_000);
            return Err(unusable(message).help(help).into());
        }
        Ok(text)
    }

    /// Prints the size of the page, and which variants are incomplete.
    fn print_summary(&self, variants: &[SolvedVariant], size: usize, reporter: &mut Reporter) {
        let incomplete: Vec<usize> =
            (0..variants.len()).filter(|&variant| variants[variant].stopped.is_some()).collect();
        let why = incomplete.first().and_then(|&variant| Some((variant, variants[variant].stopped.as_ref()?)));
        if reporter.is_machine_readable() {
            if let Some((_, why)) = why {
                reporter.print_error(why);
            }
            return;
        }
        let count = variants.len();
        let mut text = format!("{count} variants, {} kB\n", size.div_ceil(1000));
        if let Some((variant, why)) = why {
            let with = self.settings(variant).join(", ");
            text += &format!("{} of them cannot be shown whole; the first is that with {with}:\n", incomplete.len());
            if let Some(error) = why.diagnostics.iter().find(|diagnostic| diagnostic.is_error()) {
                text += &format!("  {}[{}]: {}\n", error.severity().as_str(), error.code, error.message);
            }
        }
        Reporter::print_text(&text);
    }
}

/// Returns whether there is a motion, complete or not.
fn has_motion(visualization: &Visualization) -> bool {
    !visualization.motion.rows().is_empty()
}

fn errors_of(diagnostics: &Diagnostics) -> Diagnostics {
    let mut errors = Diagnostics::default();
    for error in diagnostics.iter().filter(|diagnostic| diagnostic.is_error()) {
        errors.push(error.clone());
    }
    errors
}

/// Returns the empty visualization of an unsound variant, which shows only its text and diagnostics.
fn without_picture(diagnostics: Diagnostics, template: &Visualization) -> Visualization {
    let mut scene = template.scene.clone();
    scene.frames.truncate(1);
    scene.points.clear();
    scene.nodes.clear();
    scene.traces.clear();
    scene.profiles.clear();
    scene.contacts.clear();
    scene.named.clear();
    let motion = Motion::still(vec![Pose::default()]);
    let results = template.results.iter().map(|(name, unit, _)| (name.clone(), unit.clone(), None)).collect();
    Visualization { scene, motion, all_rows: 0, stopped: None, diagnostics, results, ..template.clone() }
}

/// Gives all variants the same size of symbols and a common extent, so that the picture does not jump when a slider moves.
fn unify_scenes(all: Vec<(ManuallyDrop<Checked>, SolvedVariant)>) -> Vec<SolvedVariant> {
    let mut units: Vec<f64> = all
        .iter()
        .filter(|(_, solved)| has_motion(&solved.visualization))
        .map(|(_, solved)| solved.visualization.scene.unit)
        .collect();
    units.sort_by(f64::total_cmp);
    let unit = units.get(units.len() / 2).copied();
    let redrawn = |(checked, mut solved): (ManuallyDrop<Checked>, SolvedVariant)| {
        let visualization = &solved.visualization;
        let scene = unit.filter(|_| has_motion(visualization));
        let scene = scene.and_then(|unit| checked.scene_with_symbols(visualization, unit));
        solved.visualization.scene = scene.unwrap_or(solved.visualization.scene);
        solved
    };
    let mut all: Vec<SolvedVariant> = all.into_iter().map(redrawn).collect();
    let drawn = all.iter().map(|solved| &solved.visualization.scene).filter(|scene| !scene.nodes.is_empty());
    if let Some(extent) = bounds(drawn.flat_map(|scene| scene.extent)) {
        for solved in &mut all {
            solved.visualization.scene.extent = extent;
        }
    }
    all
}

fn different_columns(settings: &[String]) -> Diagnostic {
    unusable(format!("with {} there are other columns, and one page cannot show both", settings.join(", ")))
        .help("write a page for each, with `--set`")
}
