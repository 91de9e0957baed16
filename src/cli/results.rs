//! Results of a run: told on standard error, and written as one JSON object.

use super::endings;
use super::failure::{Failure, unusable};
use super::files::{Output, is_standard_output};
use super::spared::{Spared, is_same};
use mechc_engine::analysis::Answers;
use mechc_ir::layout::ColumnUnit;
use mechc_text::diag::{Diagnostic, readable};
use std::io::Write;
use std::path::Path;

/// The one form that results are written in.
const FORMS: [(&str, ()); 1] = [("json", ())];

/// Opens the output of `--results`, which is not that of the table.
pub(super) fn open(name: Option<&str>, table: &str, spared: &Spared<'_>) -> Result<Option<Output>, Failure> {
    let Some(name) = name else { return Ok(None) };
    endings::form(None, name, &FORMS, ()).map_err(|_| not_json(name))?;
    let are_files = !is_standard_output(name) && !is_standard_output(table);
    let is_same = if are_files {
        is_same(Path::new(table), Path::new(name))
    } else {
        is_standard_output(name) && is_standard_output(table)
    };
    if is_same {
        let place = if is_standard_output(name) { "standard output".to_owned() } else { format!("`{table}`") };
        let link = if are_files && name != table { format!(": `{name}` is the same file") } else { String::new() };
        return Err(unusable(format!("the table and the results would both go to {place}{link}"))
            .help("name another file: `--results OUT.json`")
            .into());
    }
    Output::open(name, spared).map(Some)
}

fn not_json(name: &str) -> Diagnostic {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy()).unwrap_or_default();
    unusable(format!("`{name}` ends in `.{ending}`, and results are written as JSON alone"))
        .help("name a file that ends in `.json`, or one without an ending")
}

/// Writes one flat object, name to number in SI.
pub(super) fn write(output: &mut Output, names: &[(String, ColumnUnit)], answers: &Answers) -> Result<(), Failure> {
    let lines: Vec<String> = names
        .iter()
        .zip(&answers.values)
        .map(|((name, _), value)| {
            format!("{}: {}", serde_json::Value::from(name.as_str()), serde_json::Value::from(*value))
        })
        .collect();
    let written = output.writer().write_all(format!("{{{}}}\n", lines.join(",\n ")).as_bytes());
    written.map_err(|error| output.failure(&error))
}

/// A line for each, in the unit that it is told in.
pub(super) fn told(names: &[(String, ColumnUnit)], answers: &Answers) -> String {
    let width = names.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let line = |(((name, unit), value), digits): ((&(String, ColumnUnit), &Option<f64>), &u32)| match value {
        Some(value) => {
            let unit_text = if unit.text == "1" { String::new() } else { format!(" {}", unit.text) };
            format!("{name:<width$} = {}{unit_text}\n", readable(with_digits(unit.printed(*value), *digits)))
        }
        None => format!("{name:<width$} = null\n"),
    };
    names.iter().zip(&answers.values).zip(&answers.digits).map(line).collect()
}

/// The number nearest to another one that has so many significant digits; 0 where there are none.
fn with_digits(value: f64, digits: u32) -> f64 {
    if digits == 0 {
        return 0.0;
    }
    let text = format!("{value:.*e}", digits as usize - 1);
    text.parse().unwrap_or(value)
}
