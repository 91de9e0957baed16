//! `mechc tolerance`: the effect of small errors of params on measures and results.

use super::arguments::{ContributionFormat, ToleranceArguments};
use super::failure::Failure;
use super::files::{CachedDisk, Output};
use super::input;
use super::output_format;
use super::progress::Progress;
use super::report::Reporter;
use super::summary::VariantCommand;
use super::tolerance_table::ToleranceTable;
use mechc_pipeline::{Choice, Redundant, SweepOptions};

pub(super) fn tolerance(arguments: &ToleranceArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = output_format::choose(arguments.format, &arguments.output, &FORMATS, ContributionFormat::Table)?;
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, CachedDisk::default());
    let choice = Choice { lead: true, results: arguments.result.clone(), ..input::choice(&arguments.input) };
    let checked = input::checked_in(&parsed, &choice, &world, reporter)?;
    let following = &arguments.following;
    let (compiled, diagnostics) = input::prove(&checked, following.allow_redundant);
    let compiled = reporter.require(compiled, diagnostics)?;
    let tolerancing = checked.tolerancing(&arguments.tol, &choice, &world)?;
    let options = SweepOptions {
        times: input::time_options(&arguments.interval, &[], &mut reporter.sources)?,
        redundant: if following.allow_redundant { Redundant::LeftOut } else { Redundant::Refused },
        tolerance: following.tolerance,
        pass_bifurcations: following.pass_bifurcations,
        jobs: arguments.jobs,
        ..SweepOptions::default()
    };
    let output = Output::open(&arguments.output, &reporter.protected())?;
    let affected = tolerancing.sensitivities(&compiled, &options)?;
    let verified = if arguments.verify {
        let mut progress = Progress::counting("variants", tolerancing.count(&affected), false);
        let verified = tolerancing.verify(&compiled, &affected, &options, |count| progress.advance(count));
        progress.finish();
        Some(verified?)
    } else {
        None
    };
    let tolerances = tolerancing.tolerances().to_vec();
    let table = ToleranceTable { tolerances, affected, normal: arguments.normal, verified };
    let text = match format {
        ContributionFormat::Table => table.table(),
        ContributionFormat::Csv => table.csv(),
        ContributionFormat::Json => table.json(),
    };
    output.close_with_text(&text)?;
    if !reporter.is_machine_readable() {
        let ToleranceArguments { input, interval, result, following, .. } = arguments;
        let command = VariantCommand { input, interval, at: &[], result, following };
        Reporter::print_text(&table.remarks(|settings| command.format(settings)));
    }
    Ok(())
}

/// The formats by extension.
const FORMATS: [(&str, ContributionFormat); 3] =
    [("txt", ContributionFormat::Table), ("csv", ContributionFormat::Csv), ("json", ContributionFormat::Json)];
