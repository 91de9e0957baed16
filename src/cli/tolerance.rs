//! `mechc tolerance`: what small errors of params make of measures and results.

use super::arguments::{ContributionFormat, ToleranceArguments};
use super::contributions::Contributions;
use super::endings;
use super::failure::Failure;
use super::files::{AskedOnce, Output};
use super::input;
use super::progress::Progress;
use super::report::Reporter;
use super::summary::Again;
use super::times;
use mechc_pipeline::{Choice, Redundant, SweepOptions};
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;

pub(super) fn tolerance(arguments: &ToleranceArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = endings::form(arguments.format, &arguments.output, &FORMS, ContributionFormat::Table)?;
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, AskedOnce::default());
    let choice = Choice { lead: true, results: arguments.result.clone(), ..input::choice(&arguments.input) };
    let checked = input::checked_in(&parsed, &choice, &world, reporter)?;
    let following = &arguments.following;
    let (compiled, said) = input::proven(&checked, following.allow_redundant);
    let compiled = reporter.settle(compiled, said)?;
    let tolerancing = said_in(checked.tolerancing(&arguments.tol, &choice, &world), reporter)?;
    let options = SweepOptions {
        times: times::said((&arguments.interval, &[]), &mut reporter.sources)?,
        redundant: if following.allow_redundant { Redundant::LeftOut } else { Redundant::Refused },
        tolerance: following.tolerance,
        pass_bifurcations: following.pass_bifurcations,
        jobs: arguments.jobs,
        ..SweepOptions::default()
    };
    let output = Output::open(&arguments.output, &reporter.spared())?;
    let affected = said_in(tolerancing.affected(&compiled, &options), reporter)?;
    let verified = if arguments.verify {
        let mut progress = Progress::of("variants", tolerancing.count(&affected), false);
        let verified = tolerancing.verified(&compiled, &affected, &options, |count| progress.advance(count));
        progress.finish();
        Some(said_in(verified, reporter)?)
    } else {
        None
    };
    let tolerances = tolerancing.tolerances().to_vec();
    let contributions = Contributions { tolerances, affected, normal: arguments.normal, verified };
    let text = match format {
        ContributionFormat::Table => contributions.table(),
        ContributionFormat::Csv => contributions.csv(),
        ContributionFormat::Json => contributions.json(),
    };
    output.close_with_text(&text)?;
    if !reporter.is_for_programs() {
        let ToleranceArguments { input, interval, result, following, .. } = arguments;
        let again = Again { input, interval, at: &[], result, following };
        Reporter::say(&contributions.remarks(|settings| again.command(settings)));
    }
    Ok(())
}

/// What was made; or what is wrong, told of the texts that it speaks of.
fn said_in<T>(made: Result<T, (Sources, Diagnostics)>, reporter: &mut Reporter) -> Result<T, Failure> {
    made.map_err(|(sources, said)| {
        reporter.sources = sources;
        said.into()
    })
}

/// The forms by their endings.
const FORMS: [(&str, ContributionFormat); 3] =
    [("txt", ContributionFormat::Table), ("csv", ContributionFormat::Csv), ("json", ContributionFormat::Json)];
