//! A table's file: two columns of numbers separated by commas, each fault with its place in the file.

use crate::diag::{Code, Diagnostic};
use crate::source::{FileId, Source, Span};

/// The rows with their places, and what is wrong with the others, each kind of fault once. A header line and blank lines
/// are passed over.
pub(super) fn read(source: &Source, file: FileId) -> (Vec<([f64; 2], Span)>, Vec<Diagnostic>) {
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
        match numbers(line) {
            Some(row) => rows.push((row, span)),
            None if may_be_header && is_header(line) => {}
            None => {
                let fault = not_two_numbers(line, span);
                match faults.iter_mut().find(|(known, _)| known.help == fault.help) {
                    Some((_, more)) => *more += 1,
                    None => faults.push((fault, 0)),
                }
            }
        }
        may_be_header = false;
    }
    let told = |(fault, more): (Diagnostic, usize)| match more {
        0 => fault,
        1 => fault.note("1 more row like it"),
        more => fault.note(format!("{more} more rows like it")),
    };
    (rows, faults.into_iter().map(told).collect())
}

fn numbers(line: &str) -> Option<[f64; 2]> {
    let mut cells = line.split(',').map(|cell| number(cell.trim()));
    let (first, second) = (cells.next()??, cells.next()??);
    cells.next().is_none().then_some([first, second])
}

/// A finite number as programs write it: `inf`, `nan` and the like are none.
pub(super) fn number(cell: &str) -> Option<f64> {
    let plain = cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    cell.parse().ok().filter(|value: &f64| plain && value.is_finite())
}

/// A line none of whose parts is a number.
fn is_header(line: &str) -> bool {
    let parts = line.split([',', ';', '\t']).map(str::trim).filter(|part| !part.is_empty());
    let begins_a_number = |part: &str| part.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    !parts.clone().any(|part| begins_a_number(part.trim_start_matches(['"', '\''])))
}

fn not_two_numbers(line: &str, span: Span) -> Diagnostic {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    let help = if line.contains(';') || line.contains('\t') {
        "columns are separated by commas, and decimals written with a point"
    } else if cells.len() > 2 && cells.iter().all(|cell| cell.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.'))
    {
        "write numbers without separators between their thousands, and decimals with a point"
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

fn parts(count: usize) -> String {
    if count == 1 { "1 part".to_owned() } else { format!("{count} parts") }
}
