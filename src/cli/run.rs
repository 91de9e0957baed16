//! `mechc run`: the kinematic analysis, as a table.

use super::arguments::{Following, Format, RunArguments};
use super::endings;
use super::failure::{Failure, unusable};
use super::files::Output;
use super::input;
use super::progress::Progress;
use super::report::Reporter;
use super::results;
use super::times;
use super::timings::{Phase, Timings};
use mechc_engine::analysis::Answers;
use mechc_ir::layout::ColumnUnit;
use mechc_pipeline::output::{TableFormat, TableWriter};
use mechc_pipeline::{Choice, Run, RunOptions};
use mechc_text::diag::Diagnostics;
use std::io::IsTerminal;
use std::mem::ManuallyDrop;

pub(super) fn run(arguments: &RunArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = format(arguments)?;
    let mut timings = Timings::new(arguments.timings);
    // the process ends with the command: to take a large mechanism apart first would only take time
    let parsed = ManuallyDrop::new(input::parsed(&arguments.input, reporter)?);
    timings.end(Phase::Parse);
    let choice = Choice {
        by: arguments.by.clone(),
        lead: arguments.lead,
        reactions: arguments.reactions,
        results: arguments.result.clone(),
        ..input::choice(&arguments.input)
    };
    let compiled = input::compiled_as(&parsed, &choice, arguments.following.allow_redundant, reporter, &mut timings)?;
    let compiled = ManuallyDrop::new(compiled);
    let asked = times::asked((&arguments.interval, &arguments.at), compiled.analysis(), &mut reporter.sources)?;
    let times = asked.times()?;
    let wanted = compiled.chosen_columns(&arguments.columns)?;
    let output = Output::open(&arguments.output, &reporter.spared())?;
    let results = results::open(arguments.results.as_deref(), &arguments.output, &reporter.spared())?;
    if format == TableFormat::Parquet && output.is_terminal() {
        return Err(unusable("a Parquet table is not for a terminal".to_owned()).help("name a file with `-o`").into());
    }
    compiled.prepare();
    timings.end(Phase::Program);
    let Following { tolerance, pass_bifurcations, .. } = arguments.following;
    let vectors = arguments.vectors.unwrap_or_default();
    let options = RunOptions { tolerance, pass_bifurcations, vectors, ..RunOptions::default() };
    let (run, said) = compiled.run(&times, &options);
    let run = reporter.settle(run, said)?;
    let names = compiled.results();
    let ended = Table { output, format, wanted, timings, results, names: &names }.write(run)?;
    reporter.print(&ended.remarks);
    if !reporter.is_for_programs() {
        Reporter::say(&results::told(&names, &ended.answers));
    }
    Reporter::say(&ended.timings);
    ended.result
}

/// How the rows came to an end.
struct Ended {
    /// What there is to say beside them.
    remarks: Diagnostics,
    /// The numbers for the whole analysis.
    answers: Answers,
    /// What the clock says.
    timings: String,
    /// Why the motion stopped, if it did.
    result: Result<(), Failure>,
}

/// Where the rows go, and how.
struct Table<'n> {
    output: Output,
    format: TableFormat,
    /// The columns that are wanted.
    wanted: Vec<usize>,
    timings: Timings,
    /// Where the results go, if they are wanted, and what they are called.
    results: Option<Output>,
    names: &'n [(String, ColumnUnit)],
}

impl Table<'_> {
    /// Writes the rows as they come. Where the motion cannot go on, the rows before are kept.
    fn write(mut self, mut run: Run) -> Result<Ended, Failure> {
        let columns: Vec<String> = self.wanted.iter().map(|&k| run.columns()[k].clone()).collect();
        let units: Vec<ColumnUnit> = self.wanted.iter().map(|&k| run.units()[k].clone()).collect();
        let (wanted, count) = (&self.wanted, run.times().len());
        if std::io::stderr().is_terminal()
            && let Some(text) = beforehand(count, columns.len(), self.format)
        {
            Reporter::say(&text);
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
                        printed.extend(units.iter().zip(wanted).map(|(unit, &k)| unit.printed(row[k])));
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
        let mut remarks = run.take_remarks();
        answers.notes.iter().for_each(|note| remarks.push(note.clone()));
        Ok(Ended { remarks, answers, timings: self.timings.text(rows), result: stopped })
    }
}

/// From so many bytes on a table is told beforehand.
const LARGE: f64 = 1e10;

/// What a number takes in a table, with what parts it from the next, more or less: some are all digits, some nothing but 0.0 (bytes).
const IN_TEXT: f64 = 16.0;
const IN_PARQUET: f64 = 8.0;

/// What is said of a very large table before it is written.
fn beforehand(rows: u64, columns: usize, format: TableFormat) -> Option<String> {
    let number = if format == TableFormat::Parquet { IN_PARQUET } else { IN_TEXT };
    let bytes = rows as f64 * columns as f64 * number;
    let (size, unit) = if bytes < 1e12 { (bytes / 1e9, "GB") } else { (bytes / 1e12, "TB") };
    let size = if size < 1e4 { format!("{size:.0}") } else { format!("{size:.1e}") };
    (bytes >= LARGE).then(|| format!("writing {rows} rows of {columns} columns, about {size} {unit}\n"))
}

/// The form of the table.
fn format(arguments: &RunArguments) -> Result<TableFormat, Failure> {
    let said = arguments.format.map(|format| match format {
        Format::Csv => TableFormat::Csv,
        Format::Json => TableFormat::Json,
        Format::Parquet => TableFormat::Parquet,
    });
    endings::form(said, &arguments.output, &FORMS, TableFormat::Csv)
}

/// The forms by their endings.
const FORMS: [(&str, TableFormat); 3] =
    [("csv", TableFormat::Csv), ("json", TableFormat::Json), ("parquet", TableFormat::Parquet)];

#[cfg(test)]
mod tests {
    use super::beforehand;
    use mechc_pipeline::output::TableFormat;

    #[test]
    fn only_what_is_very_large_is_told_beforehand() {
        assert_eq!(beforehand(1_000_000, 28, TableFormat::Csv), None);
        assert_eq!(beforehand(1_000_000_000, 1, TableFormat::Parquet), None);
        let told = |rows, format| beforehand(rows, 28, format).expect("it is large");
        assert_eq!(told(30_000_000, TableFormat::Csv), "writing 30000000 rows of 28 columns, about 13 GB\n");
        assert_eq!(told(100_000_000, TableFormat::Parquet), "writing 100000000 rows of 28 columns, about 22 GB\n");
        assert_eq!(told(10_000_000_000, TableFormat::Json), "writing 10000000000 rows of 28 columns, about 4 TB\n");
        assert!(told(u64::MAX, TableFormat::Csv).ends_with("about 8.3e9 TB\n"));
    }
}
