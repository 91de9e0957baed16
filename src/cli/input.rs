//! Reads a file and options into a determined mechanism, the first step of most commands.

use super::arguments::{Input, Interval};
use super::failure::{Failure, unusable};
use super::files::{self, Disk};
use super::report::Reporter;
use super::timings::{Phase, Timings};
use mechc_pipeline::{Checked, Choice, Compiled, Parsed, Redundant, RequestedTimes};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use mechc_text::world::World;
use std::mem::ManuallyDrop;
use std::path::Path;

/// Checks and proves the mechanism of a command; prints its warnings.
pub(super) fn compiled(
    parsed: &Parsed,
    input: &Input,
    allow_redundant: bool,
    reporter: &mut Reporter,
    timings: &mut Timings,
) -> Result<Compiled, Failure> {
    compiled_as(parsed, &choice(input), allow_redundant, reporter, timings)
}

/// Checks and proves the mechanism of a choice; prints its warnings.
pub(super) fn compiled_as(
    parsed: &Parsed,
    choice: &Choice,
    allow_redundant: bool,
    reporter: &mut Reporter,
    timings: &mut Timings,
) -> Result<Compiled, Failure> {
    // see `run`: nothing is dropped before the process ends
    let checked = ManuallyDrop::new(checked_in(parsed, choice, &Disk, reporter)?);
    timings.end(Phase::Check);
    let (compiled, diagnostics) = prove(&checked, allow_redundant);
    let compiled = reporter.require(compiled, diagnostics)?;
    timings.end(Phase::Prove);
    Ok(compiled)
}

/// Proves a mechanism; returns it with its diagnostics.
pub(super) fn prove(checked: &Checked, allow_redundant: bool) -> (Option<Compiled>, Diagnostics) {
    let redundant = if allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    checked.compile(redundant, &Cancel::default())
}

/// Reads and checks the mechanism of a command without proving it; prints its warnings.
pub(super) fn model(input: &Input, reporter: &mut Reporter) -> Result<Checked, Failure> {
    let parsed = parsed(input, reporter)?;
    checked(&parsed, input, reporter)
}

/// Reads the file of a command.
pub(super) fn parsed(input: &Input, reporter: &mut Reporter) -> Result<Parsed, Failure> {
    if input.file == "-" && input.samples.as_deref() == Some(Path::new("-")) {
        return Err(unusable("standard input cannot be both the mechanism and the samples")
            .help("give one of them as a file")
            .into());
    }
    let file = files::read(&input.file, &mut reporter.sources)?;
    reporter.named_files.extend(input.samples.clone().filter(|path| path != Path::new("-")));
    Ok(Parsed::from_source(reporter.sources.clone(), file, path(input)))
}

/// Returns the path to which names in a command's file are relative: the current folder for standard input.
pub(super) fn path(input: &Input) -> &Path {
    if input.file == "-" { Path::new("") } else { Path::new(&input.file) }
}

/// Checks the mechanism of a command; prints its warnings.
pub(super) fn checked(parsed: &Parsed, input: &Input, reporter: &mut Reporter) -> Result<Checked, Failure> {
    checked_in(parsed, &choice(input), &Disk, reporter)
}

/// Returns the choice that the options of a command make.
pub(super) fn choice(input: &Input) -> Choice {
    Choice {
        mechanism: input.mechanism.clone(),
        set: input.set.clone(),
        inputs: input.signals.clone(),
        samples: input.samples.clone(),
        ..Choice::default()
    }
}

/// Checks the mechanism of a choice; prints its warnings.
pub(super) fn checked_in(
    parsed: &Parsed,
    choice: &Choice,
    world: &dyn World,
    reporter: &mut Reporter,
) -> Result<Checked, Failure> {
    let checked = parsed.check(choice, world);
    reporter.sources = checked.sources().clone();
    reporter.named_files.extend(checked.named_files());
    let diagnostics = checked.diagnostics().clone();
    reporter.require(checked.is_sound().then_some(checked), diagnostics)
}

/// Returns the times of a command's options, completed by the file's analysis.
pub(super) fn requested_times(
    interval: &Interval,
    at: &[String],
    analysis: Option<[f64; 3]>,
    sources: &mut Sources,
) -> Result<RequestedTimes, Failure> {
    Ok(time_options(interval, at, sources)?.over(analysis)?)
}

/// Returns the times of a command's options.
pub(super) fn time_options(
    interval: &Interval,
    at: &[String],
    sources: &mut Sources,
) -> Result<RequestedTimes, Failure> {
    Ok(RequestedTimes::from_options([&interval.from, &interval.to, &interval.every], at, sources)?)
}
