//! `mechc sweep`: many variants of a mechanism, as a table.

use super::arguments::{MethodChoice, SheetFormat, SweepArguments};
use super::endings;
use super::failure::{ANALYSIS, Failure, unusable};
use super::files::{AskedOnce, Output};
use super::input;
use super::interrupts;
use super::progress::Progress;
use super::report::Reporter;
use super::summary::{Again, Summary};
use super::times;
use mechc_engine::sweep::{Method, Status, Swept};
use mechc_ir::layout::ColumnUnit;
use mechc_pipeline::output::{Cells, Kind, Made, Sheet, SheetColumn, SheetWriter, TableFormat};
use mechc_pipeline::{Checked, Choice, Compiled, Redundant, SweepOptions, SweptColumn, Variants, VaryOptions};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, readable};
use std::path::Path;

/// More variants than this are asked about.
const MANY: u64 = 1_000_000_000;

pub(super) fn sweep(arguments: &SweepArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = format(arguments)?;
    refuse_what_needs_rows(arguments)?;
    refuse_two_of_standard_input(arguments)?;
    let (parsed, world) = (input::parsed(&arguments.input, reporter)?, AskedOnce::default());
    let choice = choice(arguments);
    let checked = input::checked_in(&parsed, &choice, &world, reporter)?;
    let (compiled, said) = input::proven(&checked, arguments.following.allow_redundant);
    let compiled = reporter.settle(compiled, said)?;
    let variants = checked.variants(&vary(arguments), &choice, &world).map_err(|(sources, said)| {
        reporter.sources = sources;
        said
    })?;
    reporter.sources = variants.sources().clone();
    reporter.named.extend(variants.named_files().iter().cloned());
    let redundant = if arguments.following.allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
    let compiled = checked.widest(&variants, redundant).unwrap_or(compiled);
    let table = Table::of(arguments, format, &compiled, &variants)?;
    let range = range(arguments, &variants)?;
    let options = SweepOptions {
        times: times::said((&arguments.interval, &arguments.at), &mut reporter.sources)?,
        columns: table.wanted.clone(),
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
    let output = Output::open(&arguments.output, &reporter.spared())?;
    if format == TableFormat::Parquet && output.is_terminal() {
        return Err(unusable("a Parquet table is not for a terminal".to_owned()).help("name a file with `-o`").into());
    }
    if !reporter.is_for_programs() {
        Reporter::say(&table.told(range[1] - range[0], rows));
    }
    let sweeping = Sweeping { arguments, variants: &variants, options, table, range };
    sweeping.write(&checked, &compiled, output, reporter)
}

/// What cannot be said without rows.
fn refuse_what_needs_rows(arguments: &SweepArguments) -> Result<(), Failure> {
    if !arguments.rows && !arguments.at.is_empty() {
        let said = unusable("results are of the whole analysis, and `--at` asks for single times");
        return Err(said
            .help("add `--rows` for the rows at these times, or measure with `--result 'NAME = at(…, T)'`")
            .into());
    }
    if arguments.rows && !arguments.result.is_empty() && arguments.until.is_none() {
        let said = unusable("`--rows` tabulates rows, and `--result` asks for a number of the whole analysis");
        return Err(said.help("leave one of them out").into());
    }
    if arguments.rows && arguments.until.is_some() && !arguments.at.is_empty() {
        let said = unusable("`--until` looks at results of the whole analysis, and `--at` asks for single times");
        return Err(said.help("leave one of them out").into());
    }
    Ok(())
}

fn refuse_two_of_standard_input(arguments: &SweepArguments) -> Result<(), Failure> {
    let tables = arguments.vary.iter().filter(|text| text.trim() == "@-").count();
    let samples = arguments.input.samples.as_deref() == Some(Path::new("-"));
    if tables + usize::from(samples) + usize::from(arguments.input.file == "-") > 1 {
        let said = unusable("standard input cannot be two things at once");
        return Err(said.help("give all but one of them as files").into());
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

fn again(arguments: &SweepArguments) -> Again<'_> {
    let SweepArguments { input, interval, at, result, following, .. } = arguments;
    Again { input, interval, at, result, following }
}

fn vary(arguments: &SweepArguments) -> VaryOptions {
    let method = arguments.method.map(|method| match method {
        MethodChoice::Sobol => Method::Sobol,
        MethodChoice::Random => Method::Random,
    });
    VaryOptions { params: arguments.vary.clone(), sample: arguments.sample, method, seed: arguments.seed }
}

/// The first variant that is asked for, and the one behind the last.
fn range(arguments: &SweepArguments, variants: &Variants) -> Result<[u64; 2], Failure> {
    let count = variants.points().count();
    if arguments.skip >= count {
        let said = unusable(format!("there are {count} variants, and {} are to be passed over", arguments.skip));
        return Err(said.help("give `--skip` a smaller number").into());
    }
    let last = arguments.take.map_or(count, |take| arguments.skip.saturating_add(take).min(count));
    if last == arguments.skip {
        return Err(unusable("no variant is to be taken").help("give `--take` a larger number").into());
    }
    if last - arguments.skip > MANY && !arguments.yes {
        let said = unusable(format!("these are {} variants", last - arguments.skip));
        return Err(said.help("add `--yes` if that is meant, or take a share with `--skip K --take N`").into());
    }
    Ok([arguments.skip, last])
}

/// The form of the table.
fn format(arguments: &SweepArguments) -> Result<TableFormat, Failure> {
    let said = arguments.format.map(|format| match format {
        SheetFormat::Csv => TableFormat::Csv,
        SheetFormat::Json => TableFormat::Json,
        SheetFormat::Parquet => TableFormat::Parquet,
    });
    endings::form(said, &arguments.output, &FORMS, TableFormat::Csv)
}

/// The forms by their endings.
const FORMS: [(&str, TableFormat); 5] = [
    ("csv", TableFormat::Csv),
    ("json", TableFormat::Json),
    ("ndjson", TableFormat::Json),
    ("jsonl", TableFormat::Json),
    ("parquet", TableFormat::Parquet),
];

/// What a number takes in a table, with what parts it from the next, more or less (bytes).
const IN_TEXT: f64 = 20.0;
const IN_PARQUET: f64 = 8.0;

/// The table that is written.
#[derive(Clone)]
struct Table {
    sheet: Sheet,
    format: TableFormat,
    /// The columns of a run that it has, and their units; results instead where this is nothing.
    wanted: Option<Vec<usize>>,
    units: Vec<ColumnUnit>,
}

impl Table {
    fn of(
        arguments: &SweepArguments,
        format: TableFormat,
        compiled: &Compiled,
        variants: &Variants,
    ) -> Result<Table, Failure> {
        let column = |name: &str, unit: &str, kind| SheetColumn { name: name.to_owned(), unit: unit.to_owned(), kind };
        let mut columns = vec![column("variant", "1", Kind::Whole)];
        let params = variants.points().params().iter().zip(variants.units());
        columns.extend(params.map(|(name, unit)| column(name, unit, Kind::Number)));
        let (mut wanted, mut units) = (None, Vec::new());
        if arguments.rows {
            let (names, all) = (compiled.columns(), compiled.units());
            let chosen = compiled.chosen_columns(&arguments.columns)?;
            units.extend(chosen.iter().map(|&k| all[k].clone()));
            columns.extend(chosen.iter().map(|&k| column(&names[k], &all[k].text, Kind::Number)));
            wanted = Some(chosen);
        } else {
            let results = compiled.results_of_variants();
            columns.extend(results.iter().map(|(name, unit)| column(name, unit, Kind::Number)));
            if arguments.digits {
                columns.push(column("digits", "1", Kind::Whole));
            }
            columns.push(column("status", "1", Kind::Word));
            columns.push(column("stopped", "s", Kind::Number));
        }
        let twice = columns.iter().enumerate().find(|(k, of)| columns[..*k].iter().any(|other| other.name == of.name));
        match twice {
            None => Ok(Table { sheet: Sheet::new(format, columns), format, wanted, units }),
            Some((_, of)) => Err(named_twice(&of.name).into()),
        }
    }

    /// How many rows and bytes it will have.
    fn told(&self, variants: u64, rows: u64) -> String {
        let lines = if self.wanted.is_some() { variants as f64 * rows as f64 } else { variants as f64 };
        let columns = self.sheet.columns().len();
        let number = if self.format == TableFormat::Parquet { IN_PARQUET } else { IN_TEXT };
        let size = size(lines * columns as f64 * number);
        let plural = if variants == 1 { "" } else { "s" };
        if self.wanted.is_some() {
            format!("{variants} variant{plural}: {} rows of {columns} columns at most, about {size}\n", readable(lines))
        } else {
            format!("{variants} variant{plural}: {columns} columns, about {size}\n")
        }
    }

    /// The cells of a block.
    fn cells(&self, block: Swept) -> Vec<Cells> {
        let units = self.wanted.as_ref().map(|_| self.units.as_slice());
        let cells = |column| match column {
            SweptColumn::Whole(numbers) => Cells::Whole(numbers),
            SweptColumn::Numbers(numbers) => Cells::Numbers(numbers.to_vec()),
            SweptColumn::Words(words) => Cells::Words(words),
        };
        block.tabulated(units).into_iter().map(cells).collect()
    }
}

/// A number of bytes, to be read.
fn size(bytes: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let (of, unit) = units.into_iter().find(|(of, _)| bytes >= *of).unwrap_or((1.0, "bytes"));
    let count = bytes / of;
    if count >= 1e4 { format!("{count:.1e} {unit}") } else { format!("{count:.0} {unit}") }
}

fn named_twice(name: &str) -> Diagnostic {
    unusable(format!("two columns of the table would be called `{name}`")).help(
        "the table has columns of its own: `variant`, `digits`, `status`, `stopped`; give that param or result another name",
    )
}

/// What a block leaves behind when it is written.
struct Written {
    made: Made,
    first: u64,
    statuses: Vec<Status>,
    rows: usize,
    /// By result of the table: how many have no value of it though they ran to their end, and the first of them.
    without_value: Vec<(u64, u64)>,
}

/// By result: how many variants of a block have no value of it though they ran to their end, and the first of them.
fn lacking(block: &Swept) -> Vec<(u64, u64)> {
    let counted = block.without_value().map(|mut those| {
        let first = those.next()?;
        Some((1 + those.count() as u64, first))
    });
    counted.map(Option::unwrap_or_default).collect()
}

/// A sweep that is to be written.
struct Sweeping<'s> {
    arguments: &'s SweepArguments,
    variants: &'s Variants,
    options: SweepOptions,
    table: Table,
    range: [u64; 2],
}

impl Sweeping<'_> {
    fn write(
        self,
        checked: &Checked,
        compiled: &Compiled,
        mut output: Output,
        reporter: &Reporter,
    ) -> Result<(), Failure> {
        let cancel = self.options.cancel.clone();
        interrupts::end_gracefully(&cancel);
        let table = self.table.clone();
        let make = move |block: Swept| {
            let (first, statuses, rows) = (block.first, block.statuses.clone(), block.lengths.iter().sum());
            let without_value = if table.wanted.is_none() { lacking(&block) } else { Vec::new() };
            Written { made: table.sheet.made(table.cells(block)), first, statuses, rows, without_value }
        };
        let mut sweep = checked.sweep(compiled, self.variants, &self.options, make)?;
        let [first, last] = self.range;
        let results = compiled.results_of_variants().into_iter().map(|(name, _)| name);
        let mut summary = Summary::of(results.collect());
        let progress = &mut Progress::of("variants", last - first, output.is_standard());
        let written = (|| {
            let mut writer = SheetWriter::new(output.writer(), &self.table.sheet)?;
            for Written { made, first, statuses, rows, without_value } in sweep.by_ref() {
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
        // what stands under the name is better than a table of nothing
        let is_nothing = done == 0 && interrupts::caught().is_some();
        if !is_nothing {
            output.close()?;
        }
        if !reporter.is_for_programs() {
            let command = |variant| again(self.arguments).command(&self.variants.settings(variant));
            Reporter::say(&summary.text(&command));
            if self.arguments.until.is_some() && !cancel.is_cancelled() {
                Reporter::say(&self.told_until(sweep.has_found().then(|| first + done - 1)));
            }
        }
        match interrupts::caught() {
            Some(code) if first + done < last => {
                let rest = self.arguments.take.map(|_| format!(" --take {}", last - first - done)).unwrap_or_default();
                Reporter::say(&format!(
                    "interrupted: {done} of {} variants are written; go on with `--skip {}{rest}`\n",
                    last - first,
                    first + done
                ));
                reporter.end_with(code);
            }
            _ if summary.completed() == 0 => reporter.end_with(ANALYSIS),
            _ => {}
        }
        Ok(())
    }

    /// Which variant was found, if one was.
    fn told_until(&self, found: Option<u64>) -> String {
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
