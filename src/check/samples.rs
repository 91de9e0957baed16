//! Samples of inputs: a CSV file with a column of times and one for each input, each fault with its place in the file.

use super::table_file::{between_commas, number};
use crate::diag::{Code, Diagnostic};
use crate::source::{FileId, Source, Span};
use crate::vocabulary::{CompoundUnit, Dimension, Unit};

/// What a file of samples holds.
pub(super) struct Samples {
    /// In seconds, rising.
    pub times: Vec<f64>,
    /// But for that of the times.
    pub columns: Vec<Column>,
}

/// A column of samples.
pub(super) struct Column {
    /// The input that it is of.
    pub name: String,
    /// Of the cell of its header.
    pub span: Span,
    /// Of its unit, if it has one.
    pub dimension: Option<Dimension>,
    /// In SI.
    pub values: Vec<f64>,
}

/// A part of a line with its place, without the white space and quotes around it.
struct Cell<'a> {
    text: &'a str,
    span: Span,
}

/// What a header says of a column.
struct Head<'a> {
    name: &'a str,
    span: Span,
    unit: Option<CompoundUnit>,
}

/// Units joined by `*` and `/`, each with its power.
fn unit_named(text: &str) -> Option<CompoundUnit> {
    let (mut units, mut rest, mut sign) = (Vec::new(), text, 1);
    loop {
        let end = rest.find(['*', '/']).unwrap_or(rest.len());
        let (name, power) = match rest[..end].split_once('^') {
            None => (rest[..end].trim(), 1),
            Some((name, power)) => (name.trim(), power.trim().parse().ok().filter(|power: &i32| power.abs() < 10)?),
        };
        units.push((Unit::named(name)?, sign * power));
        if end == rest.len() {
            return Some(CompoundUnit::new(units));
        }
        sign = if rest[end..].starts_with('/') { -1 } else { 1 };
        rest = &rest[end + 1..];
    }
}

/// Reads samples; blank lines are passed over.
///
/// # Errors
/// What is wrong with them, each kind of fault once.
pub(super) fn read(source: &Source, file: FileId) -> Result<Samples, Vec<Diagnostic>> {
    let mut lines = lines(source, file);
    let Some(header) = lines.next() else {
        let nothing = Span { file, start: 0, end: 0 };
        return Err(vec![fault(Code::E0413, "the samples are empty", nothing, "two rows are needed at least")]);
    };
    let heads = header.iter().map(head).collect::<Result<Vec<_>, _>>().map_err(|fault| vec![*fault])?;
    let at = time_column(&heads, &header)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); heads.len()];
    let mut rows: Vec<Span> = Vec::new();
    for cells in lines {
        let row = row_of(&cells, &heads)?;
        for (column, (value, head)) in columns.iter_mut().zip(row.into_iter().zip(&heads)) {
            column.push(head.unit.as_ref().map_or(value, |unit| unit.to_si(value)));
        }
        rows.push(cells[at].span);
    }
    let times = columns.remove(at);
    rising(&times, &rows, heads[at].span)?;
    let others = heads.iter().enumerate().filter(|(k, _)| *k != at).map(|(_, head)| head);
    let column = |(head, values): (&Head<'_>, Vec<f64>)| Column {
        // the numbers of a copy may be written with spaces
        name: super::normalized(head.name).chars().filter(|c| !c.is_whitespace()).collect(),
        span: head.span,
        dimension: head.unit.as_ref().map(CompoundUnit::dimension),
        values,
    };
    Ok(Samples { times, columns: others.zip(columns).map(column).collect() })
}

/// The cells of the lines that hold something.
fn lines(source: &Source, file: FileId) -> impl Iterator<Item = Vec<Cell<'_>>> {
    let mut at = 0;
    source.text.split('\n').filter_map(move |line| {
        let start = at;
        at += line.len() + 1;
        (!line.trim().is_empty()).then(|| cells(line, start, file))
    })
}

fn cells(line: &str, start: usize, file: FileId) -> Vec<Cell<'_>> {
    let (mut from, mut cells) = (start, Vec::new());
    for part in between_commas(line) {
        let (begin, text) = (from + (part.len() - part.trim_start().len()), part.trim());
        let span = Span { file, start: begin as u32, end: (begin + text.len()) as u32 };
        cells.push(Cell { text: text.trim_matches('"'), span });
        from += part.len() + 1;
    }
    cells
}

/// `NAME` or `NAME [UNIT]`
fn head<'a>(cell: &Cell<'a>) -> Result<Head<'a>, Box<Diagnostic>> {
    let Some((name, unit)) = cell.text.strip_suffix(']').and_then(|text| text.rsplit_once(" [")) else {
        return Ok(Head { name: cell.text, span: cell.span, unit: None });
    };
    if let Some(unit) = unit_named(unit) {
        return Ok(Head { name: name.trim(), span: cell.span, unit: Some(unit) });
    }
    let message = format!("`{unit}` is not a unit");
    let help = "units stand in brackets behind the name, joined by `*` and `/`: `turn [deg]`, `feed [mm/s]`";
    Err(Box::new(fault(Code::E0202, &message, cell.span, "the unit of this column").help(help)))
}

/// The number of the column of times.
fn time_column(heads: &[Head<'_>], header: &[Cell<'_>]) -> Result<usize, Vec<Diagnostic>> {
    for (k, head) in heads.iter().enumerate() {
        if let Some(first) = heads[..k].iter().find(|other| other.name == head.name) {
            let message = format!("column `{}` stands there twice", head.name);
            return Err(vec![fault(Code::E0203, &message, head.span, "again").also(first.span, "first here")]);
        }
    }
    let Some(at) = heads.iter().position(|head| head.name == "t") else {
        let whole = header.first().zip(header.last()).map(|(first, last)| first.span.to(last.span));
        let whole = whole.unwrap_or(Span { file: heads[0].span.file, start: 0, end: 0 });
        let help = "the first line names the columns: `t` or `t [ms]` for the times, and the inputs";
        return Err(vec![fault(Code::E0416, "the samples have no column `t`", whole, "the first line").help(help)]);
    };
    match heads[at].unit.as_ref().map(CompoundUnit::dimension) {
        Some(dimension) if !dimension.is(Dimension::TIME) => {
            let message = format!("the times of samples are a time, found {}", dimension.in_words());
            Err(vec![fault(Code::E0402, &message, heads[at].span, "the times")])
        }
        _ => Ok(at),
    }
}

/// The numbers of a line.
fn row_of(cells: &[Cell<'_>], heads: &[Head<'_>]) -> Result<Vec<f64>, Vec<Diagnostic>> {
    if let (Some(first), Some(last)) = (cells.first(), cells.last())
        && cells.len() != heads.len()
    {
        let message = format!("a row of samples has {} cells, and the first line {}", cells.len(), heads.len());
        let help = "columns are separated by commas, and decimals written with a point";
        return Err(vec![fault(Code::E0416, &message, first.span.to(last.span), "this row").help(help)]);
    }
    let value = |(cell, head): (&Cell<'_>, &Head<'_>)| {
        number(cell.text).ok_or_else(|| {
            let message = format!("a sample of `{}` is not a number", head.name);
            let label = if cell.text.is_empty() { "empty".to_owned() } else { format!("`{}`", cell.text) };
            vec![fault(Code::E0416, &message, cell.span, &label).also(head.span, "the column")]
        })
    };
    cells.iter().zip(heads).map(value).collect()
}

fn rising(times: &[f64], rows: &[Span], head: Span) -> Result<(), Vec<Diagnostic>> {
    if times.len() < 2 {
        let message = format!("samples need two rows at least, found {}", times.len());
        return Err(vec![fault(Code::E0413, &message, head, "the times")]);
    }
    match (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
        None => Ok(()),
        Some(k) => {
            let text = if times[k] < times[k - 1] { "before the one above" } else { "the same as the one above" };
            let diagnostic = fault(Code::E0414, "the times of samples do not rise", rows[k], text);
            Err(vec![diagnostic.also(rows[k - 1], "the row before")])
        }
    }
}

fn fault(code: Code, message: &str, span: Span, label: &str) -> Diagnostic {
    Diagnostic::new(code, message).at(span, label)
}

#[cfg(test)]
mod tests {
    use super::{Samples, read};
    use crate::source::Sources;

    fn of(text: &str) -> Result<Samples, String> {
        let mut sources = Sources::default();
        let file = sources.add("samples.csv", text);
        read(sources.get(file), file).map_err(|faults| faults[0].message.clone())
    }

    #[test]
    fn columns_come_in_any_order_with_units() {
        let samples = of("turn [deg],t [ms], feed [mm/s] ,\"a\"\r\n90,0,1,0\n\n180,500,2,1e-3\n")
            .unwrap_or_else(|fault| panic!("{fault}"));
        assert_eq!(samples.times, [0.0, 0.5]);
        let names: Vec<&str> = samples.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["turn", "feed", "a"]);
        assert!((samples.columns[0].values[1] - std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(samples.columns[1].values, [0.001, 0.002]);
        assert!(samples.columns[2].dimension.is_none());
    }

    #[test]
    fn faults_are_told() {
        let fault = |text: &str| of(text).err().expect("a fault");
        assert_eq!(fault(""), "the samples are empty");
        assert_eq!(fault("turn\n1\n2\n"), "the samples have no column `t`");
        assert_eq!(fault("t,turn\n0,1\n"), "samples need two rows at least, found 1");
        assert_eq!(fault("t,turn\n0,1\n0,2\n"), "the times of samples do not rise");
        assert_eq!(fault("t,turn\n0,1\n1,x\n"), "a sample of `turn` is not a number");
        assert_eq!(fault("t,turn\n0,1\n1,2,3\n"), "a row of samples has 3 cells, and the first line 2");
        assert_eq!(fault("t [mm],turn\n0,1\n1,2\n"), "the times of samples are a time, found a length");
        assert_eq!(fault("t,turn [degs]\n0,1\n1,2\n"), "`degs` is not a unit");
        assert_eq!(fault("t,turn,turn\n0,1,2\n"), "column `turn` stands there twice");
    }
}
