//! `mechc check`: is it a determined mechanism, and what was found?

use super::arguments::CheckArguments;
use super::failure::Failure;
use super::files::{self, Output};
use super::report::Reporter;
use super::timings::Timings;
use super::{fix, input};
use crate::analysis::{self, Started};
use crate::ir::{ConstraintSystem, DeclarationKind};
use crate::program::Program;
use crate::source::Sources;
use crate::structure::{self, Determined};

pub(super) fn check(arguments: &CheckArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let input = &arguments.input;
    let file =
        if arguments.fix { fix::fix(input, reporter)? } else { files::read(&input.file, &mut reporter.sources)? };
    let determined =
        input::determined_text(file, input, arguments.allow_redundant, reporter, &mut Timings::new(false))?;
    let system = determined.system();
    let program = Program::new(system);
    let t = system.analysis.map_or(0.0, |[from, ..]| from);
    let started = analysis::start(&determined, &program, t, analysis::TOLERANCE)?;
    reporter.print(&started.remarks());
    let report = report(&determined, started, t, &reporter.sources);
    if arguments.fix && input.file == "-" {
        // the mended text is there
        Reporter::say(&report);
        return Ok(());
    }
    Output::write("-", &report)
}

/// As many as a reader compares with a drawing.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value) + 0.0
}

/// Each driver with its equation as it is written.
fn drivers(system: &ConstraintSystem, sources: &Sources) -> String {
    let drivers: Vec<(&str, String)> = system
        .declarations
        .iter()
        .filter(|declaration| declaration.kind == DeclarationKind::Driver)
        .filter_map(|driver| Some((driver.name.as_str(), sources.text(driver.written?))))
        .map(|(name, text)| (name, text.split_whitespace().collect::<Vec<&str>>().join(" ")))
        .collect();
    let width = drivers.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    drivers.iter().fold(String::new(), |all, (name, text)| all + &format!("  {name:<width$}  {text}\n"))
}

fn report(determined: &Determined, mut started: Started<'_>, t: f64, sources: &Sources) -> String {
    let system = determined.system();
    let moved = started.moved().in_words(system);
    let conditioning = started.conditioning();
    let mut text = format!("mechanism {} is determined: NDOF = 0\n\n", system.name);
    text += &structure::table(system);
    text += "\n";
    let drivers = drivers(system, sources);
    if !drivers.is_empty() {
        text += &format!("\ndrivers\n{drivers}");
    }
    text += "\norder of solution\n";
    text += &structure::order_of_solution(determined);
    text += &format!("\nat t = {t} s\n  {moved}\n");
    text += &format!("  distance to a singular position: {conditioning:.2} (1 is far, 0 is singular)\n");
    for (coordinate, q) in system.coordinates.iter().zip(started.q()) {
        // less than an atom is nothing
        let q = if q.abs() < 1e-12 { 0.0 } else { *q };
        let value = format!("{} {}", nine_digits(q), coordinate.kind.unit());
        text += &format!("  {} = {}\n", coordinate.name, value.trim_end());
    }
    text
}
