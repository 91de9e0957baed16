//! Results of a run: lines on standard error, and a JSON object in a file.

use super::failure::{Failure, unusable};
use super::files::{Output, is_standard_output};
use super::output_format;
use super::protected_paths::{ProtectedPaths, is_same};
use mechc_engine::analysis::Answers;
use mechc_ir::layout::ColumnUnit;
use mechc_text::diag::{Diagnostic, readable};
use std::io::Write;
use std::path::Path;

/// The format in which results are written, by extension.
const FORMATS: [(&str, ()); 1] = [("json", ())];

/// Opens the output of `--results`, which must differ from that of the table.
pub(super) fn open(name: Option<&str>, table: &str, protected: &ProtectedPaths<'_>) -> Result<Option<Output>, Failure> {
    let Some(name) = name else { return Ok(None) };
    output_format::choose(None, name, &FORMATS, ()).map_err(|_| not_json(name))?;
    let are_files = !is_standard_output(name) && !is_standard_output(table);
    let is_same = if are_files {
        is_same(Path::new(table), Path::new(name))
    } else {
        is_standard_output(name) && is_standard_output(table)
    };
    if is_same {
        let output = if is_standard_output(name) { "standard output".to_owned() } else { format!("`{table}`") };
        let link = if are_files && name != table { format!(": `{name}` is the same file") } else { String::new() };
        return Err(unusable(format!("the table and the results would both go to {output}{link}"))
            .help("name another file: `--results OUT.json`")
            .into());
    }
    Output::open(name, protected).map(Some)
}

fn not_json(name: &str) -> Diagnostic {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy()).unwrap_or_default();
    unusable(format!("`{name}` ends in `.{ending}`, and results are written as JSON alone"))
        .help("name a file that ends in `.json`, or one without an ending")
}

/// Writes a flat JSON object of names and numbers in SI.
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

/// Formats a line for each result, in its unit.
pub(super) fn format_lines(names: &[(String, ColumnUnit)], answers: &Answers) -> String {
    let width = names.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let line = |(((name, unit), value), digits): ((&(String, ColumnUnit), &Option<f64>), &u32)| match value {
        Some(value) => {
            let unit_text = if unit.text == "1" { String::new() } else { format!(" {}", unit.text) };
            format!("{name:<width$} = {}{unit_text}\n", readable(round_to_digits(unit.printed(*value), *digits)))
        }
        None => format!("{name:<width$} = null\n"),
    };
    names.iter().zip(&answers.values).zip(&answers.digits).map(line).collect()
}

/// Rounds a number to some significant digits; 0 if there are none.
fn round_to_digits(value: f64, digits: u32) -> f64 {
    if digits == 0 {
        return 0.0;
    }
    let text = format!("{value:.*e}", digits as usize - 1);
    text.parse().unwrap_or(value)
}
