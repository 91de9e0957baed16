//! `mechc run`: the kinematic analysis, as a table.

use super::arguments::{Format, RunArguments};
use super::failure::Failure;
use super::files::Output;
use super::input;
use super::progress::Progress;
use super::report::Reporter;
use super::timings::{Phase, Timings};
use crate::analysis::{self, Started, Times};
use crate::diag::{Code, Diagnostic, Diagnostics, readable};
use crate::output::{TableFormat, TableWriter};
use crate::program::Program;
use crate::source::Sources;
use std::path::Path;

pub(super) fn run(arguments: &RunArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let mut timings = Timings::new(arguments.timings);
    let determined = input::determined(&arguments.input, arguments.allow_redundant, reporter, &mut timings)?;
    let times = times(arguments, determined.system().analysis, &mut reporter.sources)?;
    let output = Output::open(&arguments.output)?;
    if format(arguments) == TableFormat::Parquet && output.is_terminal() {
        return Err(unusable("a Parquet table is not for a terminal".to_owned()).help("name a file with `-o`").into());
    }
    let program = Program::new(determined.system());
    timings.end(Phase::Program);
    let mut started = analysis::start(&determined, &program, times.from(), arguments.tolerance)?;
    reporter.print(&started.remarks());
    let table = Table { output, format: format(arguments), timings };
    let ended = table.write(&mut started, &times, arguments.pass_bifurcations)?;
    reporter.print(&ended.remarks);
    Reporter::say(&ended.timings);
    ended.result
}

/// How the rows came to an end.
struct Ended {
    /// What there is to say beside them.
    remarks: Diagnostics,
    /// What the clock says.
    timings: String,
    /// Why the motion stopped, if it did.
    result: Result<(), Failure>,
}

/// Where the rows go, and how.
struct Table {
    output: Output,
    format: TableFormat,
    timings: Timings,
}

impl Table {
    /// Writes the rows as they come. Where the motion cannot go on, the rows before are kept.
    fn write(mut self, started: &mut Started<'_>, times: &Times, pass: bool) -> Result<Ended, Failure> {
        let columns = started.columns();
        let mut progress = Progress::new(times.len(), self.output.is_standard());
        let mut motion = started.motion(times);
        if pass {
            motion.pass_bifurcations();
        }
        let (mut stopped, mut rows) = (Ok(()), 0);
        let timings = &mut self.timings;
        let written = (|| {
            let mut table = TableWriter::new(self.output.writer(), self.format, &columns)?;
            while let Some(row) = motion.next_row() {
                timings.end(Phase::Solve);
                match row {
                    Ok(row) => table.row(row)?,
                    Err(diagnostic) => {
                        stopped = Err(diagnostic.into());
                        break;
                    }
                }
                timings.end(Phase::Write);
                rows += 1;
                progress.tick();
            }
            table.finish().map(|_| ())
        })();
        progress.finish();
        if let Err(error) = written {
            return Err(self.output.failure(&error));
        }
        self.output.close()?;
        self.timings.end(Phase::Write);
        Ok(Ended { remarks: motion.take_remarks(), timings: self.timings.text(rows), result: stopped })
    }
}

fn format(arguments: &RunArguments) -> TableFormat {
    let ending = Path::new(&arguments.output).extension();
    let ends_in = |wanted: &str| ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
    match arguments.format {
        Some(Format::Json) => TableFormat::Json,
        Some(Format::Parquet) => TableFormat::Parquet,
        None if ends_in("json") => TableFormat::Json,
        None if ends_in("parquet") => TableFormat::Parquet,
        Some(Format::Csv) | None => TableFormat::Csv,
    }
}

/// The output times: those of the command line over those of the file.
fn times(arguments: &RunArguments, analysis: Option<[f64; 3]>, sources: &mut Sources) -> Result<Times, Failure> {
    let mut given =
        |option: &str, text: &Option<String>| text.as_ref().map(|text| input::time(option, text, sources)).transpose();
    let from = given("--from", &arguments.from)?.or(analysis.map(|[from, ..]| from));
    let to = given("--to", &arguments.to)?.or(analysis.map(|[_, to, _]| to));
    let every = given("--every", &arguments.every)?.or(analysis.map(|[.., every]| every));
    let listed =
        arguments.at.iter().map(|text| input::time("--at", text, sources)).collect::<Result<Vec<f64>, Failure>>()?;
    let earliest = listed.iter().copied().reduce(f64::min);
    if let Some(earliest) = earliest {
        let from = from.unwrap_or(earliest);
        if earliest < from {
            return Err(unusable(format!(
                "`--at` {} s is before the start of the analysis at {} s",
                readable(earliest),
                readable(from)
            ))
            .help("start earlier with `--from`")
            .into());
        }
        return Ok(Times::listed(from, listed));
    }
    let (Some(from), Some(to), Some(every)) = (from, to, every) else {
        return Err(Diagnostic::new(Code::E0705, "it is not said which times to compute")
            .help("add `analysis from 0 s to 1 s every 10 ms` to the file,\nor give `--from T --to T --every H`, or `--at T`")
            .into());
    };
    let [first, last, step] = [from, to, every].map(readable);
    if every <= 0.0 {
        return Err(unusable(format!("the step must be positive, it is {step} s")).into());
    }
    if to < from {
        return Err(unusable(format!("the analysis would end at {last} s, before its start at {first} s")).into());
    }
    Times::grid(from, to, every)
        .ok_or_else(|| unusable(format!("a step of {step} s is too small to get from {first} s to {last} s")).into())
}

fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}
