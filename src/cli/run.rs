//! `mechc run`: the kinematic analysis, as a table.

use super::arguments::{Following, Format, RunArguments};
use super::failure::{Failure, unusable};
use super::files::Output;
use super::input;
use super::output_format;
use super::progress::Progress;
use super::report::Reporter;
use super::results;
use super::timings::{Phase, Timings};
use mechc_engine::analysis::Answers;
use mechc_ir::layout::ColumnUnit;
use mechc_pipeline::output::{TableFormat, TableWriter};
use mechc_pipeline::{Choice, Requirements, Run, RunOptions};
use mechc_text::diag::Diagnostics;
use std::io::IsTerminal;
use std::mem::ManuallyDrop;

pub(super) fn run(arguments: &RunArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = format(arguments)?;
    let mut timings = Timings::new(arguments.timings);
    // the process ends with the command, so dropping a large mechanism first would only take time
    let parsed = ManuallyDrop::new(input::parsed(&arguments.input, reporter)?);
    timings.end(Phase::Parse);
    let choice = Choice {
        by: arguments.by.clone(),
        lead: arguments.lead,
        reactions: arguments.reactions,
        results: arguments.result.clone(),
        requirements: Requirements::Judged,
        ..input::choice(&arguments.input)
    };
    let compiled = input::compiled_as(&parsed, &choice, arguments.following.allow_redundant, reporter, &mut timings)?;
    let compiled = ManuallyDrop::new(compiled);
    let requested =
        input::requested_times(&arguments.interval, &arguments.at, compiled.analysis(), &mut reporter.sources)?;
    let times = requested.times()?;
    let columns = compiled.select_columns(&arguments.columns)?;
    let output = Output::open(&arguments.output, &reporter.protected())?;
    let results = results::open(arguments.results.as_deref(), &arguments.output, &reporter.protected())?;
    if format == TableFormat::Parquet && output.is_terminal() {
        return Err(unusable("a Parquet table is not for a terminal".to_owned()).help("name a file with `-o`").into());
    }
    compiled.prepare();
    timings.end(Phase::Program);
    let Following { tolerance, pass_bifurcations, .. } = arguments.following;
    let vectors = arguments.vectors.unwrap_or_default();
    let options = RunOptions { tolerance, pass_bifurcations, vectors, ..RunOptions::default() };
    let (run, diagnostics) = compiled.run(&times, &options);
    let run = reporter.require(run, diagnostics)?;
    let names = compiled.results();
    let outcome = Table { output, format, columns, timings, results, names: &names }.write(run)?;
    reporter.print(&outcome.remarks);
    if let Some(note) = compiled.unjudged_requirements().filter(|_| !arguments.at.is_empty()) {
        reporter.print(&note.into());
    }
    if !reporter.is_machine_readable() {
        Reporter::print_text(&results::format_lines(&names, &outcome.answers));
    }
    Reporter::print_text(&outcome.timings);
    outcome.result?;
    if outcome.answers.failures.is_empty() {
        return Ok(());
    }
    let mut failures = Diagnostics::default();
    failures.extend(outcome.answers.failures);
    Err(failures.into())
}

/// The outcome of writing the rows.
struct TableOutcome {
    /// Warnings and notes.
    remarks: Diagnostics,
    /// The results of the whole analysis.
    answers: Answers,
    /// The text of `--timings`.
    timings: String,
    /// The reason why the motion stopped, if it did.
    result: Result<(), Failure>,
}

/// The table to write.
struct Table<'n> {
    output: Output,
    format: TableFormat,
    /// The indices of the columns to write.
    columns: Vec<usize>,
    timings: Timings,
    /// The output of `--results`.
    results: Option<Output>,
    /// The names and units of the results.
    names: &'n [(String, ColumnUnit)],
}

impl Table<'_> {
    /// Writes the rows as they are computed. If the motion stops, the rows before are kept.
    fn write(mut self, mut run: Run) -> Result<TableOutcome, Failure> {
        let columns: Vec<String> = self.columns.iter().map(|&k| run.columns()[k].clone()).collect();
        let units: Vec<ColumnUnit> = self.columns.iter().map(|&k| run.units()[k].clone()).collect();
        let (indices, count) = (&self.columns, run.times().len());
        if std::io::stderr().is_terminal()
            && let Some(text) = size_notice(count, columns.len(), self.format)
        {
            Reporter::print_text(&text);
        }
        let mut progress = Progress::new(count, self.output.is_standard());
        let (mut stopped, mut rows) = (Ok(()), 0);
        let timings = &mut self.timings;
        let written = (|| {
            let texts: Vec<&str> = units.iter().map(|unit| unit.text.as_str()).collect();
            let mut table = TableWriter::new(self.output.writer(), self.format, &columns, &texts)?;
            let mut printed = Vec::with_capacity(columns.len());
            while let Some(row) = run.next_row() {
                timings.end(Phase::Solve);
                match row {
                    Ok(row) => {
                        printed.clear();
                        printed.extend(units.iter().zip(indices).map(|(unit, &k)| unit.printed(row[k])));
                        table.row(&printed)?;
                    }
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
        self.timings.end(Phase::Write);
        let answers = run.results().unwrap_or_default();
        if !answers.values.is_empty() {
            self.timings.end(Phase::Results);
        }
        if let Some(results) = &mut self.results {
            results::write(results, self.names, &answers)?;
        }
        self.output.close_with(self.results)?;
        self.timings.end(Phase::Write);
        let mut remarks = run.take_warnings();
        answers.notes.iter().for_each(|note| remarks.push(note.clone()));
        Ok(TableOutcome { remarks, answers, timings: self.timings.text(rows), result: stopped })
    }
}

/// The size from which a table is announced before it is written (bytes).
const LARGE: f64 = 1e10;

/// The rough size of a number with its separator in a table (bytes).
const IN_TEXT: f64 = 16.0;
const IN_PARQUET: f64 = 8.0;

/// Returns the notice that precedes a very large table.
fn size_notice(rows: u64, columns: usize, format: TableFormat) -> Option<String> {
    let number = if format == TableFormat::Parquet { IN_PARQUET } else { IN_TEXT };
    let bytes = rows as f64 * columns as f64 * number;
    let (size, unit) = if bytes < 1e12 { (bytes / 1e9, "GB") } else { (bytes / 1e12, "TB") };
    let size = if size < 1e4 { format!("{size:.0}") } else { format!("{size:.1e}") };
    (bytes >= LARGE).then(|| format!("writing {rows} rows of {columns} columns, about {size} {unit}\n"))
}

/// Returns the format of the table.
fn format(arguments: &RunArguments) -> Result<TableFormat, Failure> {
    let option = arguments.format.map(|format| match format {
        Format::Csv => TableFormat::Csv,
        Format::Json => TableFormat::Json,
        Format::Parquet => TableFormat::Parquet,
    });
    output_format::choose(option, &arguments.output, &FORMATS, TableFormat::Csv)
}

/// The formats by extension.
const FORMATS: [(&str, TableFormat); 3] =
    [("csv", TableFormat::Csv), ("json", TableFormat::Json), ("parquet", TableFormat::Parquet)];

#[cfg(test)]
mod tests {
    use super::size_notice;
    use mechc_pipeline::output::TableFormat;

    #[test]
    fn only_very_large_tables_have_a_notice() {
        assert_eq!(size_notice(1_000_000, 28, TableFormat::Csv), None);
        assert_eq!(size_notice(1_000_000_000, 1, TableFormat::Parquet), None);
        let notice = |rows, format| size_notice(rows, 28, format).expect("it is large");
        assert_eq!(notice(30_000_000, TableFormat::Csv), "writing 30000000 rows of 28 columns, about 13 GB\n");
        assert_eq!(notice(100_000_000, TableFormat::Parquet), "writing 100000000 rows of 28 columns, about 22 GB\n");
        assert_eq!(notice(10_000_000_000, TableFormat::Json), "writing 10000000000 rows of 28 columns, about 4 TB\n");
        assert!(notice(u64::MAX, TableFormat::Csv).ends_with("about 8.3e9 TB\n"));
    }
}
