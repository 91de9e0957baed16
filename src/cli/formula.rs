//! `mechc formula`: a formula of time and its first two derivatives, as text and as numbers.

use super::arguments::FormulaArguments;
use super::failure::{Failure, unusable};
use super::files;
use super::report::Reporter;
use mechc_engine::analysis::Times;
use mechc_expr::number;
use mechc_pipeline::{self as stages, Formula, NAMES};
use mechc_text::diag::{Diagnostics, Error};

pub(super) fn formula(arguments: &FormulaArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    if matches!(arguments.formula.trim(), "" | "-") {
        return Err(unusable("there is no formula on the command line")
            .help("write it in quotes: `mechc formula '2 * t^2'`")
            .into());
    }
    let formula = Formula::parse(&arguments.formula, &mut reporter.sources)?;
    reporter.print(formula.remarks());
    let at = |text: &String| stages::seconds("--at", text, &mut reporter.sources);
    let times = arguments.at.iter().map(at).collect::<Result<Vec<f64>, Error>>()?;
    let (mut rows, mut failed) = (Vec::new(), Diagnostics::default());
    for t in Times::listed(0.0, times).iter() {
        match formula.values(t) {
            Ok(values) => rows.push([t, values[0], values[1], values[2]]),
            Err(why) => failed.extend(why.diagnostics),
        }
    }
    let mut text = formula.text();
    if let Some(dimension) = formula.dimension() {
        text += &format!("\n{dimension}\n");
    }
    if !rows.is_empty() {
        text += &format!("\n{}", table(&rows));
    }
    files::print(&text)?;
    if failed.is_empty() { Ok(()) } else { Err(failed.into()) }
}

/// Formats columns of numbers with aligned decimal points.
fn table(rows: &[[f64; 4]]) -> String {
    let mut columns = Vec::new();
    for (k, name) in ["t"].into_iter().chain(NAMES).enumerate() {
        let cells: Vec<(String, String)> = rows.iter().map(|row| split_at_point(row[k] + 0.0)).collect();
        let before = cells.iter().map(|(before, _)| before.len()).max().unwrap_or(0);
        let after = cells.iter().map(|(_, after)| after.len()).max().unwrap_or(0);
        let width = (before + after).max(name.len());
        let mut column = vec![format!("{name:<width$}")];
        column.extend(cells.iter().map(|(b, a)| format!("{:<width$}", format!("{b:>before$}{a}"))));
        columns.push(column);
    }
    let lines = (0..=rows.len()).map(|row| {
        let cells: Vec<&str> = columns.iter().map(|column| column[row].as_str()).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    });
    lines.collect()
}

/// Splits a number before its decimal point or exponent.
fn split_at_point(value: f64) -> (String, String) {
    let text = number(value);
    let at = text.find(['.', 'e']).unwrap_or(text.len());
    let (before, after) = text.split_at(at);
    (before.to_owned(), after.to_owned())
}
