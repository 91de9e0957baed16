//! From a file and its options to a determined mechanism: what all commands begin with.

use super::arguments::Input;
use super::failure::{Failure, unusable};
use super::files::{self, Disk};
use super::report::Reporter;
use super::timings::{Phase, Timings};
use mechc_pipeline::{Checked, Choice, Compiled, Parsed, Redundant};
use mechc_text::cancel::Cancel;
use mechc_text::diag::Diagnostics;
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

/// The same of what is chosen.
pub(super) fn compiled_as(
    parsed: &Parsed,
    choice: &Choice,
    allow_redundant: bool,
    reporter: &mut Reporter,
    timings: &mut Timings,
) -> Result<Compiled, Failure> {
    // see `run`: nothing is taken apart before the process ends
    let checked = ManuallyDrop::new(checked_in(parsed, choice, &Disk, reporter)?);
    timings.end(Phase::Check);
    let (compiled, said) = proven(&checked, allow_redundant);
    let compiled = reporter.settle(compiled, said)?;
    timings.end(Phase::Prove);
    Ok(compiled)
}

/// The proof of a mechanism, with what is to be said of it.
pub(super) fn proven(checked: &Checked, allow_redundant: bool) -> (Option<Compiled>, Diagnostics) {
    let redundant = if allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    checked.compile(redundant, &Cancel::default())
}

/// Reads and checks the mechanism of a command, which need not be determined; prints its warnings.
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
    reporter.named.extend(input.samples.clone().filter(|path| path != Path::new("-")));
    Ok(Parsed::of_source(reporter.sources.clone(), file, path(input)))
}

/// Beside which the files are that a command's file names: the current folder for standard input.
pub(super) fn path(input: &Input) -> &Path {
    if input.file == "-" { Path::new("") } else { Path::new(&input.file) }
}

/// Checks the mechanism of a command, and prints its warnings.
pub(super) fn checked(parsed: &Parsed, input: &Input, reporter: &mut Reporter) -> Result<Checked, Failure> {
    checked_in(parsed, &choice(input), &Disk, reporter)
}

/// What the options of a command choose.
pub(super) fn choice(input: &Input) -> Choice {
    Choice {
        mechanism: input.mechanism.clone(),
        set: input.set.clone(),
        inputs: input.signals.clone(),
        samples: input.samples.clone(),
        ..Choice::default()
    }
}

/// Checks what is chosen, and prints its warnings.
pub(super) fn checked_in(
    parsed: &Parsed,
    choice: &Choice,
    world: &dyn World,
    reporter: &mut Reporter,
) -> Result<Checked, Failure> {
    let checked = parsed.check(choice, world);
    reporter.sources = checked.sources().clone();
    reporter.named.extend(checked.named_files());
    let said = checked.diagnostics().clone();
    reporter.settle(checked.is_sound().then_some(checked), said)
}
