//! `mechc sweep`: many variants of a mechanism, as a table.

use super::arguments::{MethodChoice, SheetFormat, SweepArguments};
use super::failure::{ANALYSIS, Failure, unusable};
use super::files::{CachedDisk, Output};
use super::input;
use super::interrupts;
use super::output_format;
use super::progress::Progress;
use super::report::Reporter;
use super::summary::{Summary, VariantCommand};
use mechc_engine::sweep::{Method, Status, Swept};
use mechc_ir::layout::ColumnUnit;
use mechc_pipeline::output::{Cells, Kind, Made, Sheet, SheetColumn, SheetWriter, TableFormat};
use mechc_pipeline::{Checked, Choice, Compiled, Redundant, SweepOptions, SweptColumn, Variants, VaryOptions};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, readable};
use std::path::Path;

/// The number of variants from which `--yes` is required.
const MANY: u64 = 1_000_000_000;

pub(super) fn sweep(arguments: &SweepArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = format(arguments)?;
    refuse_options_without_rows(arguments)?;
    refuse_shared_standard_input(arguments)?;
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, CachedDisk::default());
    let choice = choice(arguments);
    let checked = input::checked_in(&parsed, &choice, &world, reporter)?;
    let (compiled, diagnostics) = input::prove(&checked, arguments.following.allow_redundant);
    let compiled = reporter.require(compiled, diagnostics)?;
    let variants = checked.variants(&vary(arguments), &choice, &world)?;
    reporter.sources = variants.sources().clone();
    reporter.named_files.extend(variants.named_files().iter().cloned());
    let redundant = if arguments.following.allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    let compiled = checked.widest(&variants, redundant).unwrap_or(compiled);
    let table = Table::new(arguments, format, &compiled, &variants)?;
    let range = range(arguments, &variants)?;
    let options = SweepOptions {
        times: input::time_options(&arguments.interval, &arguments.at, &mut reporter.sources)?,
        columns: table.columns.clone(),
        redundant,
        tolerance: arguments.following.tolerance,
        pass_bifurcations: arguments.following.pass_bifurcations,
        jobs: arguments.jobs,
        digits: arguments.digits,
        skip: range[0],
        take: Some(range[1] - range[0]),
        vectors: arguments.vectors.unwrap_or_default(),
        cancel: Cancel::default(),
    };
    let rows = options.times.over(compiled.analysis())?.times()?.len();
    let output = Output::open(&arguments.output, &reporter.protected())?;
    if format == TableFormat::Parquet && output.is_terminal() {
        return Err(unusable("a Parquet table is not for a terminal".to_owned()).help("name a file with `-o`").into());
    }
    if !reporter.is_machine_readable() {
        Reporter::print_text(&table.size_text(range[1] - range[0], rows));
    }
    let job = SweepJob { arguments, variants: &variants, options, table, range };
    job.write(&checked, &compiled, output, reporter)
}

/// Refuses options that do not go together with or without `--rows`.
fn refuse_options_without_rows(arguments: &SweepArguments) -> Result<(), Failure> {
    if !arguments.rows && !arguments.at.is_empty() {
        let refusal = unusable("results are of the whole analysis, and `--at` asks for single times");
        return Err(refusal
            .help("add `--rows` for the rows at these times, or measure with `--result 'NAME = at(…, T)'`")
            .into());
    }
    if arguments.rows && !arguments.result.is_empty() && arguments.until.is_none() {
        let refusal = unusable("`--rows` tabulates rows, and `--result` asks for a number of the whole analysis");
        return Err(refusal.help("leave one of them out").into());
    }
    if arguments.rows && arguments.until.is_some() && !arguments.at.is_empty() {
        let refusal = unusable("`--until` looks at results of the whole analysis, and `--at` asks for single times");
        return Err(refusal.help("leave one of them out").into());
    }
    Ok(())
}

fn refuse_shared_standard_input(arguments: &SweepArguments) -> Result<(), Failure> {
    let tables = arguments.vary.iter().filter(|text| text.trim() == "@-").count();
    let samples = arguments.input.samples.as_deref() == Some(Path::new("-"));
    if tables + usize::from(samples) + usize::from(arguments.input.file == "-") > 1 {
        let refusal = unusable("standard input cannot be two things at once");
        return Err(refusal.help("give all but one of them as files").into());
    }
    Ok(())
}

fn choice(arguments: &SweepArguments) -> Choice {
    Choice {
        lead: true,
        results: arguments.result.clone(),
        until: arguments.until.clone(),
        by: arguments.by.clone(),
        reactions: arguments.reactions,
        ..input::choice(&arguments.input)
    }
}

fn variant_command(arguments: &SweepArguments) -> VariantCommand<'_> {
    let SweepArguments { input, interval, at, result, following, .. } = arguments;
    VariantCommand { input, interval, at, result, following }
}

fn vary(arguments: &SweepArguments) -> VaryOptions {
    let method = arguments.method.map(|method| match method {
        MethodChoice::Sobol => Method::Sobol,
        MethodChoice::Random => Method::Random,
    });
    VaryOptions { params: arguments.vary.clone(), sample: arguments.sample, method, seed: arguments.seed }
}

/// Returns the first requested variant, and one past the last.
fn range(arguments: &SweepArguments, variants: &Variants) -> Result<[u64; 2], Failure> {
    let count = variants.points().count();
    if arguments.skip >= count {
        let refusal = unusable(format!("there are {count} variants, and {} are to be passed over", arguments.skip));
        return Err(refusal.help("give `--skip` a smaller number").into());
    }
    let last = arguments.take.map_or(count, |take| arguments.skip.saturating_add(take).min(count));
    if last == arguments.skip {
        return Err(unusable("no variant is to be taken").help("give `--take` a larger number").into());
    }
    if last - arguments.skip > MANY && !arguments.yes {
        let refusal = unusable(format!("these are {} variants", last - arguments.skip));
        return Err(refusal.help("add `--yes` if that is meant, or take a share with `--skip K --take N`").into());
    }
    Ok([arguments.skip, last])
}

/// Returns the format of the table.
fn format(arguments: &SweepArguments) -> Result<TableFormat, Failure> {
    let option = arguments.format.map(|format| match format {
        SheetFormat::Csv => TableFormat::Csv,
        SheetFormat::Json => TableFormat::Json,
        SheetFormat::Parquet => TableFormat::Parquet,
    });
    output_format::choose(option, &arguments.output, &FORMATS, TableFormat::Csv)
}

/// The formats by extension.
const FORMATS: [(&str, TableFormat); 5] = [
    ("csv", TableFormat::Csv),
    ("json", TableFormat::Json),
    ("ndjson", TableFormat::Json),
    ("jsonl", TableFormat::Json),
    ("parquet", TableFormat::Parquet),
];

/// The rough size of a number with its separator in a table (bytes).
const IN_TEXT: f64 = 20.0;
const IN_PARQUET: f64 = 8.0;

/// The table to write.
#[derive(Clone)]
struct Table {
    sheet: Sheet,
    format: TableFormat,
    /// The indices of a run's columns; `None` for a table of results.
    columns: Option<Vec<usize>>,
    units: Vec<ColumnUnit>,
}

impl Table {
    fn new(
        arguments: &SweepArguments,
        format: TableFormat,
        compiled: &Compiled,
        variants: &Variants,
    ) -> Result<Table, Failure> {
        let column = |name: &str, unit: &str, kind| SheetColumn { name: name.to_owned(), unit: unit.to_owned(), kind };
        let mut columns = vec![column("variant", "1", Kind::Whole)];
        let params = variants.points().params().iter().zip(variants.units());
        columns.extend(params.map(|(name, unit)| column(name, unit, Kind::Number)));
        let (mut indices, mut units) = (None, Vec::new());
        if arguments.rows {
            let (names, all) = (compiled.columns(), compiled.units());
            let chosen = compiled.select_columns(&arguments.columns)?;
            units.extend(chosen.iter().map(|&k| all[k].clone()));
            columns.extend(chosen.iter().map(|&k| column(&names[k], &all[k].text, Kind::Number)));
            indices = Some(chosen);
        } else {
            let results = compiled.variant_results();
            columns.extend(results.iter().map(|(name, unit)| column(name, unit, Kind::Number)));
            if arguments.digits {
                columns.push(column("digits", "1", Kind::Whole));
            }
            columns.push(column("status", "1", Kind::Word));
            columns.push(column("stopped", "s", Kind::Number));
        }
        let duplicate =
            columns.iter().enumerate().find(|(k, of)| columns[..*k].iter().any(|other| other.name == of.name));
        match duplicate {
            None => Ok(Table { sheet: Sheet::new(format, columns), format, columns: indices, units }),
            Some((_, of)) => Err(duplicate_column(&of.name).into()),
        }
    }

    /// Formats the number of rows and bytes that the table will have.
    fn size_text(&self, variants: u64, rows: u64) -> String {
        let lines = if self.columns.is_some() { variants as f64 * rows as f64 } else { variants as f64 };
        let columns = self.sheet.columns().len();
        let number = if self.format == TableFormat::Parquet { IN_PARQUET } else { IN_TEXT };
        let size = size(lines * columns as f64 * number);
        let plural = if variants == 1 { "" } else { "s" };
        if self.columns.is_some() {
            format!("{variants} variant{plural}: {} rows of {columns} columns at most, about {size}\n", readable(lines))
        } else {
            format!("{variants} variant{plural}: {columns} columns, about {size}\n")
        }
    }

    /// Converts a block to cells.
    fn cells(&self, block: Swept) -> Vec<Cells> {
        let units = self.columns.as_ref().map(|_| self.units.as_slice());
        let cells = |column| match column {
            SweptColumn::Whole(numbers) => Cells::Whole(numbers),
            SweptColumn::Numbers(numbers) => Cells::Numbers(numbers.to_vec()),
            SweptColumn::Words(words) => Cells::Words(words),
        };
        block.tabulated(units).into_iter().map(cells).collect()
    }
}

/// Formats a number of bytes.
fn size(bytes: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let (of, unit) = units.into_iter().find(|(of, _)| bytes >= *of).unwrap_or((1.0, "bytes"));
    let count = bytes / of;
    if count >= 1e4 { format!("{count:.1e} {unit}") } else { format!("{count:.0} {unit}") }
}

fn duplicate_column(name: &str) -> Diagnostic {
    unusable(format!("two columns of the table would be called `{name}`")).help(
        "the table has columns of its own: `variant`, `digits`, `status`, `stopped`; give that param or result another name",
    )
}

/// An encoded block, with what the summary counts of it.
struct EncodedBlock {
    made: Made,
    first: u64,
    statuses: Vec<Status>,
    rows: usize,
    /// Number of completed variants without a value for each result, and the first of them.
    without_value: Vec<(u64, u64)>,
}

/// Returns, for each result, the number of completed variants of a block without a value, and the first of them.
fn count_missing(block: &Swept) -> Vec<(u64, u64)> {
    let counted = block.without_value().map(|mut those| {
        let first = those.next()?;
        Some((1 + those.count() as u64, first))
    });
    counted.map(Option::unwrap_or_default).collect()
}

/// A sweep to run and write.
struct SweepJob<'s> {
    arguments: &'s SweepArguments,
    variants: &'s Variants,
    options: SweepOptions,
    table: Table,
    range: [u64; 2],
}

impl SweepJob<'_> {
    fn write(
        self,
        checked: &Checked,
        compiled: &Compiled,
        mut output: Output,
        reporter: &Reporter,
    ) -> Result<(), Failure> {
        let cancel = self.options.cancel.clone();
        interrupts::stop_gracefully(&cancel);
        let table = self.table.clone();
        let make = move |block: Swept| {
            let (first, statuses, rows) = (block.first, block.statuses.clone(), block.lengths.iter().sum());
            let without_value = if table.columns.is_none() { count_missing(&block) } else { Vec::new() };
            EncodedBlock { made: table.sheet.made(table.cells(block)), first, statuses, rows, without_value }
        };
        let mut sweep = checked.sweep(compiled, self.variants, &self.options, make)?;
        let [first, last] = self.range;
        let results = compiled.variant_results().into_iter().map(|(name, _)| name);
        let mut summary = Summary::new(results.collect());
        let progress = &mut Progress::counting("variants", last - first, output.is_standard());
        let written = (|| {
            let mut writer = SheetWriter::new(output.writer(), &self.table.sheet)?;
            for EncodedBlock { made, first, statuses, rows, without_value } in sweep.by_ref() {
                writer.write(made)?;
                progress.advance(statuses.len() as u64);
                summary.add(first, &statuses, rows);
                summary.add_without_value(&without_value);
            }
            writer.finish().map(|_| ())
        })();
        progress.finish();
        if let Err(error) = written {
            return Err(output.failure(&error));
        }
        let done = summary.count();
        // an existing file is worth more than an empty table
        let is_empty = done == 0 && interrupts::exit_code().is_some();
        if !is_empty {
            output.close()?;
        }
        if !reporter.is_machine_readable() {
            let command = |variant| variant_command(self.arguments).format(&self.variants.settings(variant));
            Reporter::print_text(&summary.text(&command));
            if self.arguments.until.is_some() && !cancel.is_cancelled() {
                Reporter::print_text(&self.until_text(sweep.found_match().then(|| first + done - 1)));
            }
        }
        match interrupts::exit_code() {
            Some(code) if first + done < last => {
                let rest = self.arguments.take.map(|_| format!(" --take {}", last - first - done)).unwrap_or_default();
                Reporter::print_text(&format!(
                    "interrupted: {done} of {} variants are written; go on with `--skip {}{rest}`\n",
                    last - first,
                    first + done
                ));
                reporter.set_exit_code(code);
            }
            _ if summary.completed() == 0 => reporter.set_exit_code(ANALYSIS),
            _ => {}
        }
        Ok(())
    }

    /// Formats which variant meets the condition of `--until`, if one does.
    fn until_text(&self, found: Option<u64>) -> String {
        let condition = self.arguments.until.as_deref().unwrap_or_default().trim();
        match found {
            Some(variant) => {
                let settings = self.variants.settings(variant).join(", ");
                format!("variant {variant} is the first with `{condition}`: {settings}\n")
            }
            None => format!("no variant that ran to its end was found with `{condition}`\n"),
        }
    }
}
