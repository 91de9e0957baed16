//! Plots of columns over time, one below the other, with a common time axis.

use super::style::{self, TRACE_COLORS};
use super::{Options, Theme};
use crate::scene::{Scene, Vector, distance_to_segment, minus, plus, times};
use crate::view::text::{decimal, escape};
use std::fmt::Write;

/// A column of the table, in its printed unit.
#[derive(Clone, PartialEq, Debug)]
pub struct Plot<'p> {
    /// Name.
    pub name: &'p str,
    /// Unit; `1` for a pure number.
    pub unit: &'p str,
    /// Values by row; a missing one is not finite.
    pub values: Vec<f64>,
}

/// Width of a file and height of a plot, unless the size is given (px).
const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 150.0;
/// Space to the left, above each plot, to the right and below the last one (px).
const LEFT: f64 = 78.0;
const ABOVE: f64 = 34.0;
const RIGHT: f64 = 22.0;
const BELOW: f64 = 46.0;
/// Size of letters (px).
const LETTERS: f64 = 14.0;
/// Tolerance of a curve at rows that it skips (px).
const TOLERANCE: f64 = 0.1;
/// Change in its unit, or relative to itself, below which a value is constant.
const AT_REST: f64 = 1e-12;

/// Values beyond this many times the usual range of a column run to infinity and are shown this far beyond the range. The usual range
/// leaves out this part of the time below it, and above it.
const FAR: f64 = 40.0;
const BEYOND: f64 = 0.5;
const MOSTLY: f64 = 0.08;

/// Writes plots of some columns over the times `rows` (s).
#[must_use]
pub fn plots(scene: &Scene, rows: &[f64], plots: &[Plot], options: &Options) -> String {
    let count = plots.len().max(1) as f64;
    let [width, height] = options.size.unwrap_or([WIDTH, count * (ABOVE + HEIGHT) + BELOW]);
    let frame = [(width - LEFT - RIGHT).max(1.0), ((height - BELOW) / count - ABOVE).max(1.0)];
    let axis = Axis::new(rows.iter().copied(), 10.0_f64.min(frame[0] / 60.0), 0.0);
    let mut body = String::new();
    for (k, plot) in plots.iter().enumerate() {
        let top = k as f64 * (ABOVE + frame[1]) + ABOVE;
        add_plot(&mut body, k, plot, rows, &axis, [top, frame[0], frame[1]]);
    }
    let bottom = height - BELOW;
    for (part, text) in axis.ticks() {
        let x = decimal(LEFT + part * frame[0], 2);
        let _ = writeln!(body, "<text class=\"below\" x=\"{x}\" y=\"{}\">{text}</text>", decimal(bottom + 18.0, 2));
    }
    let middle = decimal(LEFT + 0.5 * frame[0], 2);
    let _ = writeln!(body, "<text class=\"below\" x=\"{middle}\" y=\"{}\">t [s]</text>", decimal(bottom + 38.0, 2));
    let theme: Theme = options.theme;
    let [width, height] = [width, height].map(|side| decimal(side, 2));
    let sheet = style::plot_sheet(plots.len().min(TRACE_COLORS), theme, LETTERS);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
         aria-labelledby=\"title\">\n<title id=\"title\">{} over time</title>\n<style>\n{sheet}</style>\n\
         <rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n{body}</svg>\n",
        escape(&scene.name)
    )
}

/// Adds a plot with the top, the width and the height of its frame (px).
fn add_plot(body: &mut String, k: usize, plot: &Plot, rows: &[f64], time: &Axis, [top, wide, high]: [f64; 3]) {
    let [low_end, high_end] = shown_range(rows, &plot.values);
    let values = Axis::new([low_end, high_end].into_iter(), (high / 28.0).max(2.0), 0.05);
    let name = escape(plot.name);
    let unit = if plot.unit == "1" { String::new() } else { format!(" [{}]", escape(plot.unit)) };
    let _ = writeln!(body, "<g data-name=\"{name}\"><title>{name}{unit}</title>");
    let mut lines = String::new();
    for (part, _) in time.ticks() {
        let _ = write!(lines, "M{} {}v{}", decimal(LEFT + part * wide, 2), decimal(top, 2), decimal(high, 2));
    }
    let mut words = String::new();
    for (part, text) in values.ticks() {
        let y = top + (1.0 - part) * high;
        let _ = write!(lines, "M{} {}h{}", decimal(LEFT, 2), decimal(y, 2), decimal(wide, 2));
        let _ = writeln!(
            words,
            "<text class=\"beside\" x=\"{}\" y=\"{}\">{text}</text>",
            decimal(LEFT - 8.0, 2),
            decimal(y + 0.35 * LETTERS, 2)
        );
    }
    let _ = writeln!(body, "<path class=\"grid\" d=\"{lines}\"/>\n{}", words.trim_end());
    let _ = writeln!(
        body,
        "<path class=\"axes\" d=\"M{} {}v{}h{}\"/>",
        decimal(LEFT, 2),
        decimal(top, 2),
        decimal(high, 2),
        decimal(wide, 2)
    );
    let to_picture = |(t, value): (&f64, &f64)| [LEFT + time.part(*t) * wide, top + (1.0 - values.part(*value)) * high];
    let positions: Vec<Vector> = rows.iter().zip(&plot.values).map(to_picture).collect();
    let stretches = positions.split(|[_, y]| !y.is_finite());
    let visible = stretches.flat_map(|positions| clip(positions, [top, top + high]));
    let d: String = visible.map(|positions| polyline(&positions)).collect();
    let _ = writeln!(body, "<path class=\"curve t{}\" d=\"{d}\"/>", k % TRACE_COLORS);
    let _ = writeln!(
        body,
        "<text class=\"name\" x=\"{}\" y=\"{}\">{name}{unit}</text>\n</g>",
        decimal(LEFT, 2),
        decimal(top - 9.0, 2)
    );
}

/// Returns the least and the greatest value that a plot shows, which exclude what runs to infinity.
fn shown_range(rows: &[f64], values: &[f64]) -> [f64; 2] {
    // each value has the weight of the time around it
    let time = |k: usize| {
        let (before, after) = (rows[k.saturating_sub(1)], rows[(k + 1).min(rows.len() - 1)]);
        0.5 * (after - before)
    };
    let finite = rows.iter().zip(values).enumerate().filter(|(_, (_, value))| value.is_finite());
    let mut weighted: Vec<(f64, f64)> = finite.map(|(k, (_, value))| (*value, time(k))).collect();
    weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(least), Some(greatest)) = (weighted.first(), weighted.last()) else { return [f64::NAN; 2] };
    let (least, greatest) = (least.0, greatest.0);
    // only a broken column runs to infinity
    if weighted.len() == values.len() {
        return [least, greatest];
    }
    let all: f64 = weighted.iter().map(|(_, time)| time).sum();
    let at_part = |part: f64| {
        let mut sum = 0.0;
        let quantile = weighted.iter().find(|(_, time)| {
            sum += time;
            sum >= part * all
        });
        quantile.map_or(greatest, |(value, _)| *value)
    };
    let [low, high] = [MOSTLY, 1.0 - MOSTLY].map(at_part);
    let range = high - low;
    let is_far = |value: f64| (value - low).abs() > FAR * range && range > AT_REST * low.abs().max(high.abs());
    [
        if is_far(least) { least.max(low - BEYOND * range) } else { least },
        if is_far(greatest) { greatest.min(high + BEYOND * range) } else { greatest },
    ]
}

/// Returns the parts of a line (px) between the top and the bottom of its plot.
fn clip(positions: &[Vector], [top, bottom]: [f64; 2]) -> Vec<Vec<Vector>> {
    let mut parts: Vec<Vec<Vector>> = Vec::new();
    let is_in = |[_, y]: Vector| top <= y && y <= bottom;
    if let [only] = positions {
        return if is_in(*only) { vec![vec![*only]] } else { Vec::new() };
    }
    let mut is_open = false;
    for ends in positions.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let rise = to[1] - from[1];
        let crossings = [top, bottom].map(|y| (y - from[1]) / rise);
        let [first, last] = [crossings[0].min(crossings[1]), crossings[0].max(crossings[1])];
        let [first, last] = if rise.abs() > 0.0 { [first.max(0.0), last.min(1.0)] } else { [0.0, 1.0] };
        if first > last || (rise.abs() <= 0.0 && !is_in(from)) {
            is_open = false;
            continue;
        }
        let at = |part: f64| if part >= 1.0 { to } else { plus(from, times(part, minus(to, from))) };
        if !(is_open && first <= 0.0) {
            parts.push(vec![at(first)]);
        }
        if let Some(part) = parts.last_mut() {
            part.push(at(last));
        }
        is_open = last >= 1.0;
    }
    parts
}

/// Writes a line through positions (px), simplified, or a dot for a single one.
fn polyline(positions: &[Vector]) -> String {
    let (Some(first), last) = (positions.first(), positions.len().saturating_sub(1)) else { return String::new() };
    let pair = |[x, y]: Vector| format!("{} {}", decimal(x, 2), decimal(y, 2));
    if last == 0 {
        return format!("M{}h0", pair(*first));
    }
    let mut is_kept = vec![false; positions.len()];
    (is_kept[0], is_kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |k: usize| distance_to_segment(positions[k], [positions[from], positions[to]]);
        let farthest = (from + 1..to).map(|k| (k, off(k))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = farthest.filter(|(_, off)| *off > TOLERANCE) {
            is_kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    let corners: Vec<String> =
        positions.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept).map(|(position, _)| pair(*position)).collect();
    format!("M{}", corners.join("L"))
}

/// An axis with its range, and the step between its ticks: `units` times a power of ten.
struct Axis {
    low: f64,
    high: f64,
    units: i64,
    power: i32,
}

impl Axis {
    /// Creates an axis over all finite values, with a margin as a part of their range and at most a number of ticks.
    fn new(values: impl Iterator<Item = f64>, marks: f64, margin: f64) -> Axis {
        let finite = values.filter(|value| value.is_finite());
        let [low, high] =
            finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
        let [low, high] = if low <= high { [low, high] } else { [0.0, 1.0] };
        let size = low.abs().max(high.abs());
        let span = high - low;
        let margin = if span > AT_REST * size.max(1.0) {
            margin * span
        } else if size > AT_REST {
            0.1 * size
        } else {
            1.0
        };
        let (low, high) = (low - margin, high + margin);
        let (units, power) = step((high - low) / marks.max(1.0));
        Axis { low, high, units, power }
    }

    /// Returns the position of a value along the axis, from 0 to 1.
    fn part(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Returns the position of each tick along the axis, with its number.
    fn ticks(&self) -> Vec<(f64, String)> {
        let step: f64 = power_of_ten(self.units, self.power);
        let slack = 1e-9;
        let mut k = -mechc_expr::math::floor(-(self.low / step - slack));
        let mut ticks = Vec::new();
        while k <= self.high / step + slack {
            #[allow(clippy::cast_possible_truncation)] // few marks, and none of them far from others
            let units = k as i64 * self.units;
            let value = power_of_ten(units, self.power);
            let text = match self.power {
                _ if units == 0 => "0".to_owned(),
                0..=5 => decimal(value, 0),
                #[allow(clippy::cast_sign_loss)] // negative
                -5..=-1 => decimal(value, -self.power as usize),
                power => format!("{units}e{power}"),
            };
            // a minus sign is as wide as a digit
            ticks.push((self.part(value), text.replace('-', "\u{2212}")));
            k += 1.0;
            if ticks.len() > 100 {
                break;
            }
        }
        ticks
    }
}

/// Returns the least of 1, 2, 5 times a power of ten that is at least a positive number.
fn step(least: f64) -> (i64, i32) {
    let text = format!("{least:e}");
    let (digits, power) = text.split_once('e').unwrap_or(("1", "0"));
    let (digits, power): (f64, i32) = (digits.parse().unwrap_or(1.0), power.parse().unwrap_or(0));
    match digits {
        _ if digits <= 1.0 => (1, power),
        _ if digits <= 2.0 => (2, power),
        _ if digits <= 5.0 => (5, power),
        _ => (1, power + 1),
    }
}

/// Returns the number nearest to `units` times a power of ten.
fn power_of_ten(units: i64, power: i32) -> f64 {
    format!("{units}e{power}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::{Axis, polyline};

    fn marks(values: &[f64], most: f64) -> Vec<String> {
        Axis::new(values.iter().copied(), most, 0.0).ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn marks_are_round_numbers() {
        assert_eq!(marks(&[0.0, 1.0], 5.0), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(marks(&[-30.0, 110.0], 5.0), ["0", "50", "100"]);
        assert_eq!(marks(&[-3e-9, 3e-9], 3.0), ["−2e-9", "0", "2e-9"].map(|text| text.replace('-', "−")));
        assert_eq!(marks(&[0.0, 2e7], 2.0), ["0", "1e7", "2e7"]);
        assert_eq!(marks(&[5.0, 5.0, f64::NAN], 2.0), ["4.5", "5", "5.5"], "what rests is in the middle");
        assert!(!marks(&[f64::NAN], 5.0).is_empty(), "no value");
    }

    #[test]
    fn lines_keep_what_they_would_miss() {
        let positions: Vec<[f64; 2]> = (0..=100).map(|k| [f64::from(k), if k == 50 { 9.0 } else { 0.0 }]).collect();
        assert_eq!(polyline(&positions), "M0 0L49 0L50 9L51 0L100 0");
        assert_eq!(polyline(&positions[..1]), "M0 0h0");
        assert_eq!(polyline(&[]), "");
    }
}
