//! Tables with a header line: samples of inputs with a column of times, and variants with a column for each param. Faults have locations in
//! the file.

use super::table_file::{between_commas, number};
use mechc_syntax::normalized;
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::{FileId, Source, Span};
use mechc_text::vocabulary::{CompoundUnit, Dimension, Unit};

/// The words for a table and its rows in messages.
#[derive(Clone, Copy)]
struct TableWording {
    /// The plural of the rows.
    many: &'static str,
    /// The singular of a number in them.
    one: &'static str,
    /// An example of the units.
    example: &'static str,
    /// The required columns.
    least: &'static str,
}

const SAMPLES: TableWording = TableWording {
    many: "samples",
    one: "sample",
    example: "`turn [deg]`, `feed [mm/s]`",
    least: "two rows are needed at least",
};
const VARIANTS: TableWording = TableWording {
    many: "variants",
    one: "value",
    example: "`rod [mm]`, `speed [rpm]`",
    least: "a line that names the params is needed, and a row for each variant",
};

/// The content of a file of samples.
pub(in crate::check) struct Samples {
    /// The times (s), ascending.
    pub times: Vec<f64>,
    /// The columns except that of the times.
    pub columns: Vec<Column>,
}

/// A column of numbers.
pub struct Column {
    /// The name of the input or param.
    pub name: String,
    /// The location of the header's cell.
    pub span: Span,
    /// The dimension of its unit, if it has one.
    pub dimension: Option<Dimension>,
    /// The values, in SI units.
    pub values: Vec<f64>,
}

/// A cell of a line with its location, without surrounding white space and quotes.
struct Cell<'a> {
    text: &'a str,
    span: Span,
}

/// The header of a column.
pub(super) struct ColumnHeader<'a> {
    /// The name as it is written.
    pub name: &'a str,
    /// The location of its cell.
    pub span: Span,
    unit: Option<CompoundUnit>,
}

/// Returns a unit of factors joined by `*` and `/`, each with its power.
fn unit_named(text: &str) -> Option<CompoundUnit> {
    let (mut units, mut rest, mut sign) = (Vec::new(), text, 1);
    loop {
        let end = rest.find(['*', '/']).unwrap_or(rest.len());
        let (name, power) = match rest[..end].split_once('^') {
            None => (rest[..end].trim(), 1),
            Some((name, power)) => {
                (name.trim(), power.trim().parse().ok().filter(|power: &i32| (-9..=9).contains(power))?)
            }
        };
        units.push((Unit::named(name)?, sign * power));
        if end == rest.len() {
            return Some(CompoundUnit::new(units));
        }
        sign = if rest[end..].starts_with('/') { -1 } else { 1 };
        rest = &rest[end + 1..];
    }
}

/// The header line of samples, with the file behind it.
pub(super) struct SampleFile<'a> {
    source: &'a Source,
    file: FileId,
    heads: Vec<ColumnHeader<'a>>,
    /// The number of the column of times.
    at: usize,
}

/// Reads the header line of samples.
///
/// # Errors
/// The faults of the line.
pub(in crate::check) fn header(source: &Source, file: FileId) -> Result<SampleFile<'_>, Vec<Diagnostic>> {
    let (line, heads) = heads(source, file, SAMPLES)?;
    let at = time_column(&heads, line.span)?;
    if heads.len() == 1 {
        let help = "each input that is told has a column of its own, behind a comma: `t,turn [deg]`";
        return Err(vec![fault(Code::E0416, "the samples are of no input", line.span, "times alone").help(help)]);
    }
    Ok(SampleFile { source, file, heads, at })
}

/// Reads a table of variants: a column for each param that varies.
///
/// # Errors
/// The faults of the table.
pub fn variants(source: &Source, file: FileId) -> Result<Vec<Column>, Vec<Diagnostic>> {
    let (line, heads) = heads(source, file, VARIANTS)?;
    let numbers = |head: &ColumnHeader<'_>| number(head.name).is_some();
    if heads.iter().all(numbers) {
        let help = "the first line names the params, each with its unit: `rod [mm],speed [rpm]`";
        return Err(vec![fault(Code::E0416, "the variants are of no param", line.span, "numbers alone").help(help)]);
    }
    let Rows { columns, places } = Rows::read(source, file, &heads, VARIANTS)?;
    if places.is_empty() {
        return Err(vec![fault(
            Code::E0413,
            "the variants have no row",
            line.span,
            "the first line, and none behind it",
        )]);
    }
    Ok(heads.iter().zip(columns).map(|(head, values)| head.column(values)).collect())
}

/// Returns the first line of a table, and the headers of its columns.
fn heads(
    source: &Source,
    file: FileId,
    words: TableWording,
) -> Result<(Line<'_>, Vec<ColumnHeader<'_>>), Vec<Diagnostic>> {
    let Some(line) = lines(source, file).next() else {
        let start_of_file = Span { file, start: 0, end: 0 };
        let message = format!("the {} are empty", words.many);
        return Err(vec![fault(Code::E0413, &message, start_of_file, words.least)]);
    };
    let one = |fault: Box<Diagnostic>| vec![*fault];
    line.has_commas(words).map_err(one)?;
    let cells = line.cells(words).map_err(one)?;
    let heads = cells.iter().map(|cell| head(cell, words)).collect::<Result<Vec<_>, _>>().map_err(one)?;
    for (k, head) in heads.iter().enumerate() {
        if let Some(first) = heads[..k].iter().find(|other| other.name == head.name) {
            let message = format!("column `{}` stands there twice", head.name);
            return Err(vec![fault(Code::E0203, &message, head.span, "again").also(first.span, "first here")]);
        }
    }
    Ok((line, heads))
}

/// The rows below the header line.
struct Rows {
    /// The numbers of each column (SI).
    columns: Vec<Vec<f64>>,
    /// The locations, by row and column.
    places: Vec<Vec<Span>>,
}

impl Rows {
    /// Reads the rows, without blank lines.
    fn read(
        source: &Source,
        file: FileId,
        heads: &[ColumnHeader<'_>],
        words: TableWording,
    ) -> Result<Rows, Vec<Diagnostic>> {
        let mut rows = Rows { columns: vec![Vec::new(); heads.len()], places: Vec::new() };
        for line in lines(source, file).skip(1) {
            let cells = line.cells(words).map_err(|fault| vec![*fault])?;
            let row = row_of(&line, &cells, heads, words)?;
            for (column, (value, head)) in rows.columns.iter_mut().zip(row.into_iter().zip(heads)) {
                column.push(head.unit.as_ref().map_or(value, |unit| unit.to_si(value)));
            }
            rows.places.push(cells.iter().map(|cell| cell.span).collect());
        }
        Ok(rows)
    }
}

impl<'a> SampleFile<'a> {
    /// Returns the headers except that of the times.
    pub fn columns(&self) -> impl Iterator<Item = &ColumnHeader<'a>> {
        self.heads.iter().enumerate().filter(|(k, _)| *k != self.at).map(|(_, head)| head)
    }

    /// Reads the rows, without blank lines.
    ///
    /// # Errors
    /// The faults of the rows.
    pub fn rows(&self) -> Result<Samples, Vec<Diagnostic>> {
        let Rows { columns: mut values, places } = Rows::read(self.source, self.file, &self.heads, SAMPLES)?;
        let times = values.remove(self.at);
        let rows: Vec<Span> = places.iter().map(|cells| cells[self.at]).collect();
        rising(&times, &rows, self.heads[self.at].span)?;
        let columns = self.columns().zip(values).map(|(head, values)| head.column(values)).collect();
        Ok(Samples { times, columns })
    }
}

impl ColumnHeader<'_> {
    /// Returns the path of the input. Spaces in indices are ignored.
    pub fn path(&self) -> String {
        normalized(self.name).chars().filter(|c| !c.is_whitespace()).collect()
    }

    fn column(&self, values: Vec<f64>) -> Column {
        let (name, span, dimension) = (self.path(), self.span, self.unit.as_ref().map(CompoundUnit::dimension));
        Column { name, span, dimension, values }
    }

    /// Returns a suggestion if the brackets are not written as those of a unit.
    pub fn suggestion(&self) -> Option<String> {
        let (name, rest) = self.name.rsplit_once('[')?;
        let text = rest.strip_suffix(']').unwrap_or(rest).trim();
        unit_named(text)?;
        let why = match (&self.unit, rest.ends_with(']')) {
            (Some(_), _) => "a column has one unit",
            (None, true) => "a unit stands behind a space",
            (None, false) => "a unit stands between brackets",
        };
        Some(format!("{why}: `{} [{text}]`", name.trim()))
    }
}

/// A line that is not blank, without surrounding white space.
struct Line<'a> {
    text: &'a str,
    span: Span,
}

/// Returns the lines that are not blank.
fn lines(source: &Source, file: FileId) -> impl Iterator<Item = Line<'_>> {
    let mut at = 0;
    source.text.split('\n').filter_map(move |line| {
        let start = at + (line.len() - line.trim_start().len());
        at += line.len() + 1;
        let text = line.trim();
        let span = Span { file, start: start as u32, end: (start + text.len()) as u32 };
        (!text.is_empty()).then_some(Line { text, span })
    })
}

impl<'a> Line<'a> {
    /// Returns the cells of the line.
    ///
    /// # Errors
    /// A quote is not closed.
    fn cells(&self, words: TableWording) -> Result<Vec<Cell<'a>>, Box<Diagnostic>> {
        let (mut from, mut cells) = (self.span.start as usize, Vec::new());
        for part in between_commas(self.text) {
            let (begin, text) = (from + (part.len() - part.trim_start().len()), part.trim());
            let span = Span { start: begin as u32, end: (begin + text.len()) as u32, ..self.span };
            if text.matches('"').count() % 2 == 1 {
                let help = "a cell in quotes ends with a quote in its line";
                let message = format!("a quote of the {} is not closed", words.many);
                return Err(Box::new(fault(Code::E0416, &message, span, "opened here").help(help)));
            }
            cells.push(Cell { text: text.trim_matches('"'), span });
            from += part.len() + 1;
        }
        Ok(cells)
    }

    /// Returns the separator of the line if it is not a comma.
    fn other_separator(&self) -> Option<&'static str> {
        const OTHERS: [(char, &str); 2] = [(';', "semicolons"), ('\t', "tabs")];
        let found = OTHERS.iter().find(|(separator, _)| self.text.contains(*separator));
        let is_spaced = || {
            !self.text.contains(',') && self.text.split(' ').skip(1).any(|word| word == "t")
                || self.text.strip_prefix("t ").is_some_and(|rest| rest.starts_with(|c: char| c.is_alphabetic()))
        };
        found.map(|(_, name)| *name).or_else(|| is_spaced().then_some("spaces"))
    }

    /// Checks that commas separate the columns of the first line.
    ///
    /// # Errors
    /// Another separator is used.
    fn has_commas(&self, words: TableWording) -> Result<(), Box<Diagnostic>> {
        match self.other_separator().filter(|_| !self.text.contains(',')) {
            Some(found) => Err(Box::new(self.separated_by(found, words))),
            None => Ok(()),
        }
    }

    fn separated_by(&self, found: &str, words: TableWording) -> Diagnostic {
        let message = format!("the {} are separated by {found}", words.many);
        fault(Code::E0416, &message, self.span, &format!("{found}, and no commas")).help(SEPARATORS)
    }
}

/// The format of columns and numbers.
const SEPARATORS: &str = "columns are separated by commas, and decimals written with a point";

/// Reads a header `NAME` or `NAME [UNIT]`.
fn head<'a>(cell: &Cell<'a>, words: TableWording) -> Result<ColumnHeader<'a>, Box<Diagnostic>> {
    let Some((name, unit)) = cell.text.strip_suffix(']').and_then(|text| text.rsplit_once(" [")) else {
        return Ok(ColumnHeader { name: cell.text, span: cell.span, unit: None });
    };
    if let Some(unit) = unit_named(unit) {
        return Ok(ColumnHeader { name: name.trim(), span: cell.span, unit: Some(unit) });
    }
    let message = format!("`{unit}` is not a unit");
    let help = format!("units stand in brackets behind the name, joined by `*` and `/`: {}", words.example);
    Err(Box::new(fault(Code::E0202, &message, cell.span, "the unit of this column").help(help)))
}

/// Returns the number of the column of times.
fn time_column(heads: &[ColumnHeader<'_>], line: Span) -> Result<usize, Vec<Diagnostic>> {
    let Some(at) = heads.iter().position(|head| head.name == "t") else {
        let help = "the first line names the columns: `t` or `t [ms]` for the times, and the inputs".to_owned();
        let is_time = |head: &&ColumnHeader<'_>| head.name.split('[').next().is_some_and(|name| name.trim() == "t");
        let help = heads.iter().find(is_time).and_then(ColumnHeader::suggestion).unwrap_or(help);
        return Err(vec![fault(Code::E0416, "the samples have no column `t`", line, "the first line").help(help)]);
    };
    match heads[at].unit.as_ref().map(CompoundUnit::dimension) {
        Some(dimension) if !dimension.is(Dimension::TIME) => {
            let message = format!("the times of samples are a time, found {}", dimension.in_words());
            Err(vec![fault(Code::E0402, &message, heads[at].span, "the times")])
        }
        _ => Ok(at),
    }
}

/// Returns the numbers of a line.
fn row_of(
    line: &Line<'_>,
    cells: &[Cell<'_>],
    heads: &[ColumnHeader<'_>],
    words: TableWording,
) -> Result<Vec<f64>, Vec<Diagnostic>> {
    if cells.len() != heads.len() {
        if let Some(found) = line.other_separator().filter(|_| cells.len() == 1) {
            return Err(vec![line.separated_by(found, words)]);
        }
        let count = if cells.len() == 1 { "1 cell".to_owned() } else { format!("{} cells", cells.len()) };
        let message = format!("a row of {} has {count}, and the first line {}", words.many, heads.len());
        return Err(vec![fault(Code::E0416, &message, line.span, "this row").help(SEPARATORS)]);
    }
    let value = |(cell, head): (&Cell<'_>, &ColumnHeader<'_>)| {
        number(cell.text).ok_or_else(|| {
            let message = format!("a {} of `{}` is not a number", words.one, head.name);
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
    use super::{Samples, header};
    use mechc_text::source::Sources;

    fn read(text: &str) -> Result<Samples, String> {
        let mut sources = Sources::default();
        let file = sources.add("samples.csv", text);
        header(sources.get(file), file).and_then(|headed| headed.rows()).map_err(|faults| faults[0].message.clone())
    }

    #[test]
    fn columns_come_in_any_order_with_units() {
        let samples = read("turn [deg],t [ms], feed [mm/s] ,\"a\"\r\n90,0,1,0\n\n180,500,2,1e-3\n")
            .unwrap_or_else(|fault| panic!("{fault}"));
        assert_eq!(samples.times, [0.0, 0.5]);
        let names: Vec<&str> = samples.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["turn", "feed", "a"]);
        assert!((samples.columns[0].values[1] - std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(samples.columns[1].values, [0.001, 0.002]);
        assert!(samples.columns[2].dimension.is_none());
    }

    #[test]
    fn faults_are_reported() {
        let fault = |text: &str| read(text).err().expect("a fault");
        assert_eq!(fault(""), "the samples are empty");
        assert_eq!(fault("turn\n1\n2\n"), "the samples have no column `t`");
        assert_eq!(fault("t,turn\n0,1\n"), "samples need two rows at least, found 1");
        assert_eq!(fault("t,turn\n0,1\n0,2\n"), "the times of samples do not rise");
        assert_eq!(fault("t,turn\n0,1\n1,x\n"), "a sample of `turn` is not a number");
        assert_eq!(fault("t,turn\n0,1\n1,2,3\n"), "a row of samples has 3 cells, and the first line 2");
        assert_eq!(fault("t [mm],turn\n0,1\n1,2\n"), "the times of samples are a time, found a length");
        assert_eq!(fault("t,turn [degs]\n0,1\n1,2\n"), "`degs` is not a unit");
        assert_eq!(fault("t,turn,turn\n0,1,2\n"), "column `turn` stands there twice");
        assert_eq!(fault("t\n0\n1\n"), "the samples are of no input");
        for quotes in ["t,\"turn\n0,1\n1,2\n", "t,turn\n0,1\n1,\"2\n"] {
            assert_eq!(fault(quotes), "a quote of the samples is not closed");
        }
        assert_eq!(fault("t;turn [deg]\n0;0,5\n1;2\n"), "the samples are separated by semicolons");
        assert_eq!(fault("t\tturn\n0\t1\n1\t2\n"), "the samples are separated by tabs");
        assert_eq!(fault("t turn\n0 1\n1 2\n"), "the samples are separated by spaces");
        assert_eq!(fault("turn [deg] t\n0 1\n1 2\n"), "the samples are separated by spaces");
        assert_eq!(fault("t,turn\n0;1\n1;2\n"), "the samples are separated by semicolons");
    }
}
