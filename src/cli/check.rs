//! `mechc check`: proves that a mechanism is determined, and reports on it.

use super::arguments::CheckArguments;
use super::failure::Failure;
use super::files;
use super::report::Reporter;
use super::timings::Timings;
use super::{fix, input};
use mechc_engine::analysis::Times;
use mechc_pipeline::{Assembly, Compiled, RunOptions};
use mechc_text::diag::{readable, visible};

pub(super) fn check(arguments: &CheckArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let input = &arguments.input;
    let parsed = if arguments.fix { fix::fix(input, reporter)? } else { input::parsed(input, reporter)? };
    let compiled = input::compiled(&parsed, input, arguments.allow_redundant, reporter, &mut Timings::new(false))?;
    if let Some([from, to, _]) = compiled.analysis() {
        let refused = compiled.refused_results([from, to]);
        reporter.require((!refused.has_errors()).then_some(()), refused)?;
    }
    let from = compiled.first_time();
    let (run, diagnostics) = compiled.run(&Times::listed(from, vec![from]), &RunOptions::default());
    let run = reporter.require(run, diagnostics)?;
    let report = report(&compiled, run.assembly());
    if arguments.fix && input.file == "-" {
        // standard output has the fixed text
        Reporter::print_text(&report);
        return Ok(());
    }
    files::print(&visible(&report))
}

/// Rounds to nine significant digits, enough to compare with a drawing.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value) + 0.0
}

/// Lists the drivers with their equations as they are written.
fn drivers(compiled: &Compiled) -> String {
    let drivers = compiled.drivers();
    let width = drivers.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    drivers.iter().fold(String::new(), |all, (name, text)| all + &format!("  {name:<width$}  {text}\n"))
}

fn report(compiled: &Compiled, assembly: &Assembly) -> String {
    let mut text = format!("mechanism {} is determined: NDOF = 0\n\n", compiled.name());
    text += &compiled.counts();
    text += "\n";
    let drivers = drivers(compiled);
    if !drivers.is_empty() {
        text += &format!("\ndrivers\n{drivers}");
    }
    let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
    if !results.is_empty() {
        text += &format!("\nresults\n  {}\n", results.join("\n  "));
    }
    text += "\norder of solution\n";
    text += &compiled.order_of_solution();
    text += &format!("\nat t = {} s\n  {}\n", readable(assembly.t), assembly.moved);
    text += &format!("  distance to a singular position: {:.2} (1 is far, 0 is singular)\n", assembly.conditioning);
    for (name, q, unit) in &assembly.coordinates {
        // less than the size of an atom is rounding error
        let q = if q.abs() < 1e-12 { 0.0 } else { *q };
        let value = format!("{} {unit}", readable(nine_digits(q)));
        text += &format!("  {name} = {}\n", value.trim_end());
    }
    text
}
