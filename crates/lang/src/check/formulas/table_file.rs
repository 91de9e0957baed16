//! A table's file: two columns of numbers separated by commas, or two of several. Faults have locations in the file.

use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::{FileId, Source, Span};

/// The cells of a row that a table takes.
#[derive(Clone, Copy)]
pub(super) enum Picked {
    /// Both cells of a row of two.
    Both,
    /// Two cells by their numbers, from 0.
    Two {
        /// The columns of the argument and of the value.
        cells: [usize; 2],
        /// True if they are named, so that the first line is a header.
        by_name: bool,
    },
}

/// Returns the cells of the first line that is not blank, as names.
pub(super) fn first_line(source: &Source) -> Vec<&str> {
    let line = source.text.split('\n').find(|line| !line.trim().is_empty()).unwrap_or_default();
    cells(line).collect()
}

/// Splits a line at commas, except within quotes.
pub(super) fn between_commas(line: &str) -> impl Iterator<Item = &str> {
    let mut is_quoted = false;
    line.split(move |c| {
        is_quoted ^= c == '"';
        c == ',' && !is_quoted
    })
}

/// Returns the cells of a line, without quotes.
fn cells(line: &str) -> impl Iterator<Item = &str> {
    between_commas(line).map(|cell| {
        let cell = cell.trim();
        cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
    })
}

/// Returns the rows with their locations, and the faults of others, each kind once. The header and blank lines are skipped.
pub(in crate::check) fn read(
    source: &Source,
    file: FileId,
    picked: Picked,
) -> (Vec<([f64; 2], Span)>, Vec<Diagnostic>) {
    let mut rows = Vec::new();
    let mut faults: Vec<(Diagnostic, usize)> = Vec::new();
    let mut at = 0;
    let mut may_be_header = true;
    for line in source.text.split('\n') {
        let span = Span { file, start: at as u32, end: (at + line.trim_end().len()) as u32 };
        at += line.len() + 1;
        if line.trim().is_empty() {
            continue;
        }
        match numbers(line, picked) {
            _ if may_be_header && matches!(picked, Picked::Two { by_name: true, .. }) => {}
            Some(row) => rows.push((row, span)),
            None if may_be_header && is_header(line, picked) => {}
            None => {
                let fault = match picked {
                    Picked::Both => not_two_numbers(line, span),
                    Picked::Two { cells, .. } => not_numbers_there(line, span, cells),
                };
                match faults.iter_mut().find(|(other, _)| other.help == fault.help) {
                    Some((_, more)) => *more += 1,
                    None => faults.push((fault, 0)),
                }
            }
        }
        may_be_header = false;
    }
    let reported = |(fault, more): (Diagnostic, usize)| match more {
        0 => fault,
        1 => fault.note("1 more row like it"),
        more => fault.note(format!("{more} more rows like it")),
    };
    (rows, faults.into_iter().map(reported).collect())
}

fn numbers(line: &str, picked: Picked) -> Option<[f64; 2]> {
    match picked {
        Picked::Both => {
            let mut cells = line.split(',').map(|cell| number(cell.trim()));
            let (first, second) = (cells.next()??, cells.next()??);
            cells.next().is_none().then_some([first, second])
        }
        Picked::Two { cells: [first, second], .. } => {
            let cell = |at: usize| cells(line).nth(at).and_then(number);
            Some([cell(first)?, cell(second)?])
        }
    }
}

/// Parses a finite decimal number; `inf`, `nan` and the like are rejected.
pub(in crate::check) fn number(cell: &str) -> Option<f64> {
    let plain = cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    cell.parse().ok().filter(|value: &f64| plain && value.is_finite())
}

/// Returns whether no cell of a line is a number.
fn is_header(line: &str, picked: Picked) -> bool {
    let begins_a_number = |part: &str| {
        part.trim_start_matches(['"', '\'']).starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
    };
    match picked {
        Picked::Both => !line.split([',', ';', '\t']).map(str::trim).any(begins_a_number),
        Picked::Two { cells: picked, .. } => {
            picked.iter().all(|&at| cells(line).nth(at).is_some_and(|cell| !cell.is_empty() && !begins_a_number(cell)))
        }
    }
}

fn not_two_numbers(line: &str, span: Span) -> Diagnostic {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    let help = if line.contains(';') || line.contains('\t') {
        "columns are separated by commas, and decimals written with a point"
    } else if cells.len() > 2 && cells.iter().all(|cell| cell.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.'))
    {
        "write numbers without separators between their thousands, and decimals with a point;\nof a wider table name two columns: `columns 1, 3`"
    } else if cells.len() == 1 {
        "a row is an argument and a value, separated by a comma"
    } else {
        "a row is two numbers, as in `0.5,12.25`; units go behind the file's name: `spline \"lift.csv\" (deg, mm)`"
    };
    let label = match cells.iter().find(|cell| number(cell).is_none()) {
        _ if cells.len() != 2 => format!("found {}", parts(cells.len())),
        Some(cell) if cell.parse().is_ok_and(|value: f64| value.is_infinite()) && cell.contains(['e', 'E']) => {
            format!("`{cell}` is too large")
        }
        Some(cell) => format!("`{cell}` is not a number"),
        None => String::new(),
    };
    Diagnostic::new(Code::E0416, "this row of a table is not two numbers").at(span, label).help(help)
}

/// Reports a row in which a selected column is missing, or holds no number.
fn not_numbers_there(line: &str, span: Span, picked: [usize; 2]) -> Diagnostic {
    let count = cells(line).count();
    let label = match picked.iter().find(|&&at| cells(line).nth(at).is_none_or(|cell| number(cell).is_none())) {
        Some(&at) if at >= count => format!("found {}, and none in column {}", parts(count), at + 1),
        Some(&at) => match cells(line).nth(at).unwrap_or_default() {
            "" => format!("column {} is empty", at + 1),
            cell => format!("`{}` is not a number", shown(cell)),
        },
        None => String::new(),
    };
    Diagnostic::new(Code::E0416, "this row of a table is not two numbers").at(span, label).help(
        "each of the two columns holds a number in every row, with a decimal point; columns are separated by commas",
    )
}

/// Returns a cell, shortened for a message.
fn shown(cell: &str) -> String {
    const LONGEST: usize = 80;
    let text: String = cell.chars().take(LONGEST).collect();
    if text.len() < cell.len() { text + "…" } else { text }
}

fn parts(count: usize) -> String {
    if count == 1 { "1 part".to_owned() } else { format!("{count} parts") }
}
