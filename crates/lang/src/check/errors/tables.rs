//! Diagnostics of tables and their columns.

use super::dimensions::{format_value, usual_unit};
use super::list;
use super::names::suggest_unit;
use crate::model::Dimension;
use mechc_syntax::ast::{ColumnName, ColumnWord, Name};
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix, nearest, readable};
use mechc_text::source::Span;

pub fn not_a_unit_of_a_column(name: &Name) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text)).at(name.span, "the unit of a column");
    suggest_unit(diagnostic, name)
}

pub fn not_a_unit_to_print_in(name: &Name) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0202, format!("`{}` is not a unit", name.text))
        .at(name.span, "only units, `*`, `/` and powers may stand behind `in`");
    suggest_unit(diagnostic, name)
}

/// A unit after `in` of another dimension than the formula, with the locations and dimensions of both.
pub fn not_printed_in(unit: &str, [at, formula]: [Span; 2], [unit_dimension, found]: [Dimension; 2]) -> Diagnostic {
    let expected = unit_dimension.in_words();
    Diagnostic::new(Code::E0402, format!("what is printed in `{unit}` must be {expected}, found {}", found.in_words()))
        .at(at, expected)
        .also(formula, found.in_words())
        .help(if found.is(Dimension::PURE) {
            "leave `in` out, or name a unit of angle: `in deg`".to_owned()
        } else {
            format!("name a unit of its dimension: `in {}`", usual_unit(found))
        })
}

/// An angular velocity in hertz.
pub fn turning_in_hertz(at: Span, formula: Span) -> Diagnostic {
    Diagnostic::new(Code::E0402, "a turning speed is not printed in `Hz`")
        .at(at, "1 per second")
        .also(formula, "radians per second")
        .help("name a unit of turning speed: `in rpm` or `in rev/s`")
}

/// A column that a file does not have.
pub fn no_column(path: &Name, column: &ColumnName, header: &[&str]) -> Diagnostic {
    let (message, expected) = match &column.kind {
        ColumnWord::Number(number) => (format!("`{}` has no column {number}", path.text), None),
        ColumnWord::Named(name) => (format!("`{}` has no column `{name}`", path.text), Some(name)),
    };
    let diagnostic = Diagnostic::new(Code::E0201, message).at(column.span, "not in its first line");
    let Some(name) = expected else {
        return diagnostic.help(match header.len() {
            1 => "it has 1 column; columns are separated by commas".to_owned(),
            count => format!("it has {count} columns"),
        });
    };
    match nearest(name, header.iter().copied()) {
        Some(suggestion) => diagnostic.fix(Fix::replace(
            column.span,
            format!("\"{suggestion}\""),
            format!("did you mean `{suggestion}`?"),
            Applicability::Probably,
        )),
        None => diagnostic.help(format!("its first line has {}", list(header))),
    }
}

/// A duplicate name of a column in a file's header.
pub fn column_twice(path: &Name, span: Span, name: &str, [first, second]: [usize; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0203, format!("`{}` has two columns `{name}`", path.text))
        .at(span, "which of them?")
        .help(format!("take one by its number: {} or {}", first + 1, second + 1))
}

pub fn row_of(span: Span, found: usize) -> Diagnostic {
    Diagnostic::new(Code::E0301, format!("a row of a table is an argument and a value, found {found} parts"))
        .at(span, format!("found {found}"))
        .help("a row is written `(argument, value)`")
}

/// A file that was not read, as the mechanism was checked without its files.
pub fn no_table_file(path: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0701, format!("cannot read `{}`: there is no such file", path.text))
        .at(path.span, "named here")
}

pub fn empty_table_file(path: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0413, format!("the file `{}` holds no row", path.text))
        .at(path.span, "named here")
        .help("a row is an argument and a value, separated by a comma")
}

pub fn too_few_rows(name: &Name, periodic: bool, least: usize, found: usize) -> Diagnostic {
    let what = if periodic { "a periodic table" } else { "a table" };
    Diagnostic::new(Code::E0413, format!("table `{}` has too few rows: {what} needs {least}, found {found}", name.text))
        .at(name.span, format!("found {found}"))
}

pub fn not_rising(name: &Name, [here, before]: [f64; 2], rows: [Span; 2]) -> Diagnostic {
    let (this, last) = (readable(here), readable(before));
    let message = format!("the arguments of table `{}` do not rise: {this} follows {last}", name.text);
    let text = if here < before { "smaller than the one before" } else { "the same as the one before" };
    Diagnostic::new(Code::E0414, message)
        .at(rows[0], text)
        .also(rows[1], "the row before")
        .help("arguments must rise from row to row")
}

pub fn ends_differ(name: &Name, ends: [Span; 2], [last, first]: [f64; 2], dimension: Dimension) -> Diagnostic {
    let [last, first] = [last, first].map(|value| format_value(value, dimension));
    let message = format!("periodic table `{}` ends with {last}, and begins with {first}", name.text);
    let diagnostic = Diagnostic::new(Code::E0415, message).at(ends[0], "the last row");
    diagnostic.also(ends[1], "the first row").help("its last row repeats the first value, one period on")
}

pub fn out_of_table(name: &Name, value: f64, ends: [f64; 2], dimension: Dimension, span: Span) -> Diagnostic {
    let [value, first, last] = [value, ends[0], ends[1]].map(|value| format_value(value, dimension));
    let message = format!("{value} is not in the range of table `{}`, {first} to {last}", name.text);
    Diagnostic::new(Code::E0417, message).at(span, "out of range").help("a `periodic spline` repeats; a spline ends")
}
