//! The effect of tolerances on measures and results, as a readable table, CSV and JSON.

use mechc_pipeline::{CornerReport, Deviation, DisplayUnit, OutputSensitivity, Tolerance};
use mechc_text::diag::readable;
use serde_json::{Map, Value, json};

/// Significant digits in the readable table.
const DIGITS: usize = 5;

/// The tolerances with the measures and results that they affect.
pub(super) struct ToleranceTable {
    pub tolerances: Vec<Tolerance>,
    pub affected: Vec<OutputSensitivity>,
    /// True if params are distributed normally, and not uniformly.
    pub normal: bool,
    pub verified: Option<CornerReport>,
}

/// The columns of the CSV form.
const COLUMNS: [&str; 13] = [
    "name",
    "t",
    "nominal",
    "unit",
    "kind",
    "param",
    "tolerance_low",
    "tolerance_high",
    "param_unit",
    "derivative",
    "low",
    "high",
    "share",
];

/// A nominal value smaller than this fraction of its deviation is shown as 0.
const NEGLIGIBLE: f64 = 1e-9;

impl ToleranceTable {
    fn deviation(&self, of: &OutputSensitivity) -> Option<Deviation> {
        of.deviation(&self.tolerances, self.normal)
    }

    /// Returns whether the verified range agrees with the derivatives; `None` if it was not verified.
    fn is_linear(&self, k: usize, deviation: Option<&Deviation>) -> Option<bool> {
        let verified = self.verified.as_ref().filter(|_| self.affected[k].is_verifiable)?;
        Some(verified.is_linear(k, &self.affected[k], deviation?))
    }

    /// Formats the readable table.
    pub fn table(&self) -> String {
        let blocks: Vec<Vec<[String; 5]>> = (0..self.affected.len()).map(|k| self.block(k)).collect();
        let mut widths = [0; 5];
        for line in blocks.iter().flatten() {
            widths.iter_mut().zip(line).for_each(|(width, cell)| *width = cell.chars().count().max(*width));
        }
        let mut text = String::new();
        for (of, block) in self.affected.iter().zip(&blocks) {
            text += if text.is_empty() { "" } else { "\n" };
            let at = of.at.map(|t| format!(" at {} s", short(t))).unwrap_or_default();
            let nominal = if of.nominal.is_finite() {
                let worst = self.deviation(of).map_or(0.0, |all| f64::max(-all.worst[0], all.worst[1]));
                let is_negligible = of.nominal.abs() < NEGLIGIBLE * worst;
                in_unit(if is_negligible { 0.0 } else { of.nominal }, &of.display_unit(&self.tolerances))
            } else {
                "null".to_owned()
            };
            text += &format!("{} = {nominal}{at}\n", of.name);
            for line in block {
                let cells = line.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
                text += format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end();
                text += "\n";
            }
        }
        text
    }

    /// Formats the lines of a measure or result.
    fn block(&self, k: usize) -> Vec<[String; 5]> {
        let (of, deviation) = (&self.affected[k], self.deviation(&self.affected[k]));
        let shown = of.display_unit(&self.tolerances);
        let amount = |ends: [f64; 2]| between(ends.map(|end| end / shown.size), &shown.text);
        let mut lines = vec![["param", "tolerance", "derivative", "contributes", "share"].map(str::to_owned)];
        for (j, by) in self.tolerances.iter().enumerate() {
            let slope = of.slopes[j].map(|slope| shown.slope(slope, by));
            let derivative = slope.map_or("unknown".to_owned(), |(slope, unit)| number_with_unit(slope, &unit));
            let contributes = of.slopes[j].map_or(String::new(), |slope| amount(by.times(slope)));
            let share = deviation.as_ref().map_or(String::new(), |all| format!("{:.0} %", 100.0 * all.shares[j]));
            let range = by.range.map(|off| off / by.unit.1);
            lines.push([by.name.clone(), between(range, &by.unit.0), derivative, contributes, share]);
        }
        let sum =
            |name: &str, amount: String, more: String| [name.to_owned(), String::new(), String::new(), amount, more];
        if let Some(all) = &deviation {
            lines.push(sum("worst case", amount(all.worst), String::new()));
            let sigma = in_unit(all.sigma, &shown);
            lines.push(sum("statistical", amount(all.statistical), format!("σ = {sigma}")));
        }
        if let Some(verified) = &self.verified {
            let what = if verified.are_all_corners { "corners" } else { "samples" };
            let found = verified.found[k].map_or("null".to_owned(), &amount);
            let is_linear = self.is_linear(k, deviation.as_ref());
            let more = if is_linear == Some(false) { "linear is not enough" } else { "" };
            lines.push(sum(what, found, more.to_owned()));
        }
        lines
    }

    /// Formats a line for each contribution and each sum, with all numbers in SI.
    pub fn csv(&self) -> String {
        let mut text = COLUMNS.join(",") + "\n";
        for (k, of) in self.affected.iter().enumerate() {
            let begin = [of.name.clone(), of.at.map_or(String::new(), number), number(of.nominal), of.si.clone()];
            let mut line = |rest: [String; 9]| {
                let cells: Vec<String> = begin.iter().chain(&rest).map(|cell| quoted(cell)).collect();
                text += &(cells.join(",") + "\n");
            };
            let deviation = self.deviation(of);
            for (j, by) in self.tolerances.iter().enumerate() {
                let [low, high] = by.range.map(number);
                let slope = of.slopes[j].map_or(String::new(), number);
                let [from, to] =
                    of.slopes[j].map_or([String::new(), String::new()], |slope| by.times(slope).map(number));
                let share = deviation.as_ref().map_or(String::new(), |all| number(all.shares[j]));
                line(["param".to_owned(), by.name.clone(), low, high, by.si.clone(), slope, from, to, share]);
            }
            let mut sum = |kind: &str, ends: [f64; 2]| {
                let ([low, high], none) = (ends.map(number), String::new);
                line([kind.to_owned(), none(), none(), none(), none(), none(), low, high, none()]);
            };
            if let Some(all) = deviation {
                sum("worst", all.worst);
                sum("statistical", all.statistical);
                sum("sigma", [-all.sigma, all.sigma]);
            }
            if let Some(verified) = &self.verified {
                let kind = if verified.are_all_corners { "corners" } else { "samples" };
                sum(kind, verified.found[k].unwrap_or([f64::NAN; 2]));
            }
        }
        text
    }

    /// Formats a JSON object with all numbers in SI.
    pub fn json(&self) -> String {
        let tolerance = |of: &Tolerance| json!({ "param": of.name, "nominal": of.nominal, "low": of.range[0], "high": of.range[1], "unit": of.si });
        let mut all = Map::new();
        all.insert("tolerances".to_owned(), self.tolerances.iter().map(tolerance).collect());
        all.insert("spread".to_owned(), json!(if self.normal { "normal" } else { "uniform" }));
        all.insert("affected".to_owned(), (0..self.affected.len()).map(|k| self.object(k)).collect());
        if let Some(CornerReport { variants, are_all_corners, lost, .. }) = &self.verified {
            let lost = lost.as_ref().map_or(0, |(count, ..)| *count);
            let what = if *are_all_corners { "corners" } else { "samples" };
            all.insert("verified_by".to_owned(), json!({ "what": what, "variants": variants, "lost": lost }));
        }
        // an object of numbers and texts always serializes
        serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
    }

    fn object(&self, k: usize) -> Value {
        let of = &self.affected[k];
        let deviation = self.deviation(of);
        let contribution = |(j, by): (usize, &Tolerance)| {
            let ends = of.slopes[j].map(|slope| by.times(slope));
            json!({
                "param": by.name,
                "derivative": of.slopes[j],
                "low": ends.map(|ends| ends[0]),
                "high": ends.map(|ends| ends[1]),
                "share": deviation.as_ref().map(|all| all.shares[j]),
            })
        };
        let mut object = Map::new();
        let mut add = |name: &str, value: Value| object.insert(name.to_owned(), value);
        add("name", json!(of.name));
        add("kind", json!(if of.at.is_some() { "measure" } else { "result" }));
        add("t", json!(of.at));
        add("nominal", json!(of.nominal));
        add("unit", json!(of.si));
        add("contributions", self.tolerances.iter().enumerate().map(contribution).collect());
        add("worst", json!(deviation.as_ref().map(|all| all.worst)));
        add("statistical", json!(deviation.as_ref().map(|all| all.statistical)));
        add("sigma", json!(deviation.as_ref().map(|all| all.sigma)));
        if let Some(verified) = &self.verified {
            add("verified", json!(verified.found[k]));
            add("missing", json!(verified.missing(k)));
            add("is_linear", json!(self.is_linear(k, deviation.as_ref())));
        }
        Value::Object(object)
    }

    /// Formats remarks on missing values and derivatives, and on the verification.
    pub fn remarks(&self, command: impl Fn(&[String]) -> String) -> String {
        let mut text = String::new();
        for of in &self.affected {
            let unknown: Vec<&str> = of
                .slopes
                .iter()
                .zip(&self.tolerances)
                .filter(|(slope, _)| slope.is_none())
                .map(|(_, by)| by.name.as_str())
                .collect();
            if !of.nominal.is_finite() {
                text += &format!("`{}` has no value, and so no derivatives\n", of.name);
            } else if !unknown.is_empty() {
                let why = match of.at {
                    None => {
                        "it is of an extremum that two times share, of a kink or jump that goes with the param, of what has no value at some times, or of too many derivatives"
                    }
                    Some(_) if of.unknown[0] == 0 => "it jumps at a time that goes with the param",
                    Some(_) => "it needs too many derivatives, or is too near a singular position at all times",
                };
                text += &format!("`{}` has no derivative by {}: {why}\n", of.name, unknown.join(", "));
            } else if of.unknown[0] > 0 {
                let [unknown, all] = of.unknown;
                text +=
                    &format!("`{}` has no derivatives at {unknown} of {all} times, which count for nothing\n", of.name);
            }
        }
        let Some(verified) = &self.verified else { return text };
        let what = match (verified.are_all_corners, verified.variants) {
            (true, 1) => "corner was",
            (true, _) => "corners were",
            (false, _) => "corners and samples were",
        };
        text += &format!("{} {what} run\n", verified.variants);
        if let Some((count, set, status)) = &verified.lost {
            text += &format!(
                "{count} of them did not run on this branch, and are not in the table; the first ({status}): {}\n",
                command(set)
            );
        }
        for of in self.affected.iter().filter(|of| !of.is_verifiable) {
            text += &format!(
                "`{}` is not verified: it is differentiated by what a param follows that has values of its own there\n",
                of.name
            );
        }
        for (of, missing) in self.affected.iter().zip(&verified.missing) {
            if let Some((count, set)) = missing {
                text += &format!("`{}` has no value in {count} of them; the first: {}\n", of.name, command(set));
            }
        }
        text
    }
}

/// Formats a range: `±0.05 mm`, or `-0.1..0 mm`.
fn between([low, high]: [f64; 2], unit: &str) -> String {
    let [low, high] = [low, high].map(short);
    match low.strip_prefix('-') {
        Some(size) if size == high => format!("±{high}{}", unit_suffix(unit)),
        _ if low == high => format!("{low}{}", unit_suffix(unit)),
        _ => format!("{low}..{high}{}", unit_suffix(unit)),
    }
}

fn in_unit(value: f64, DisplayUnit { text, size }: &DisplayUnit) -> String {
    number_with_unit(value / size, text)
}

fn number_with_unit(value: f64, unit: &str) -> String {
    short(value) + &unit_suffix(unit)
}

/// Formats a unit after a number.
fn unit_suffix(unit: &str) -> String {
    if unit.is_empty() || unit == "1" { String::new() } else { format!(" {unit}") }
}

/// Formats a number with few digits.
fn short(value: f64) -> String {
    let few = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    // −0 would surprise a reader
    readable(few + 0.0)
}

/// Formats a number for CSV; empty if it is not finite.
fn number(value: f64) -> String {
    if value.is_finite() { readable(value + 0.0) } else { String::new() }
}

/// Quotes a cell of CSV.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{between, quoted, short};

    #[test]
    fn amounts_are_short() {
        assert_eq!(between([-0.05, 0.05], "mm"), "±0.05 mm");
        assert_eq!(between([-0.1, 0.0], "mm"), "-0.1..0 mm");
        assert_eq!(between([-1.234_567e-7, 2.0], "1"), "-1.2346e-7..2");
        assert_eq!(between([0.0, -0.0], "deg"), "0 deg");
        assert_eq!(short(1.0 / 3.0), "0.33333");
        assert_eq!(quoted("a,b"), "\"a,b\"");
    }
}
