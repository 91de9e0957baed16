//! Traces: smooth curves through the rows, by places and velocities.

use super::picture::Picture;
use super::style::TRACE_COLORS;
use crate::scene::{Anchor, Motion, Pen, Vector, distance, is_finite, minus, plus, times};
use crate::view::text::{escaped, number};

/// What a curve may be off from the rows that it does not name (px).
const OFF: f64 = 0.15;
/// Rows that one piece goes over at most.
const LONGEST: usize = 64;

impl Picture<'_> {
    /// The paths that the text asks for, and those that the picture does.
    pub fn add_traces(&mut self, motion: &Motion) {
        let scene = self.scene;
        let mut color = 0;
        for trace in &scene.traces {
            let name = self.name(trace.declaration);
            let d = match &trace.pen {
                Pen::Point(anchor) => self.path_of(*anchor, motion),
                Pen::Columns { .. } => self.polyline(&trace.path(motion)),
            };
            self.add_trace(name, &d, &mut color);
        }
        for (name, anchor) in &self.options.traces {
            let is_known = scene.traces.iter().any(|trace| trace.pen == Pen::Point(*anchor));
            if !is_known {
                let d = self.path_of(*anchor, motion);
                self.add_trace(name, &d, &mut color);
            }
        }
    }

    fn add_trace(&mut self, name: &str, d: &str, color: &mut usize) {
        if d.is_empty() {
            return;
        }
        let number = *color % TRACE_COLORS;
        *color += 1;
        self.used.traces.insert(number);
        self.body += &format!("<path class=\"trace t{number}\" data-name=\"{}\" d=\"{d}\"/>\n", escaped(name));
    }

    /// The path of a point of a frame.
    fn path_of(&self, anchor: Anchor, motion: &Motion) -> String {
        let turned = |[x, y]: Vector| [self.scale * x, -self.scale * y];
        let place = |row: usize| self.placed(motion.poses(row)[anchor.frame].placed(anchor.at));
        let velocity = |row: usize| {
            let (pose, rate) = (&motion.poses(row)[anchor.frame], &motion.rates(row)[anchor.frame]);
            turned(rate.velocity(pose, anchor.at))
        };
        let places: Vec<Vector> = (0..motion.len()).map(place).collect();
        let velocities: Vec<Vector> = (0..motion.len()).map(velocity).collect();
        curve(&places, &velocities, &motion.times, self.pixels)
    }

    /// A path of which nothing but places is known; with gaps where there is none.
    fn polyline(&self, places: &[Vector]) -> String {
        let mut text = String::new();
        let (mut is_down, mut last) = (false, [f64::NAN; 2]);
        for place in places {
            if !is_finite(*place) {
                is_down = false;
                continue;
            }
            let at = self.placed(*place);
            if is_down && distance(at, last) < 2.0 * OFF {
                continue;
            }
            text += &format!("{}{}", if is_down { "L" } else { "M" }, pair(at, self.pixels));
            (is_down, last) = (true, at);
        }
        text
    }
}

/// A smooth curve through places (px) with velocities (px/s) at times (s), in as few pieces as it takes.
fn curve(places: &[Vector], velocities: &[Vector], times_of: &[f64], decimals: usize) -> String {
    let pair = |place| pair(place, decimals);
    let Some(first) = places.first() else { return String::new() };
    let handles = |from: usize, to: usize| {
        let third = (times_of[to] - times_of[from]) / 3.0;
        [plus(places[from], times(third, velocities[from])), minus(places[to], times(third, velocities[to]))]
    };
    let holds = |from: usize, to: usize| {
        let [b, c] = handles(from, to);
        (from + 1..to).all(|k| {
            let s = (times_of[k] - times_of[from]) / (times_of[to] - times_of[from]);
            let r = 1.0 - s;
            let mix = |part: usize| {
                let ends = r * r * r * places[from][part] + s * s * s * places[to][part];
                ends + 3.0 * r * s * (r * b[part] + s * c[part])
            };
            distance([mix(0), mix(1)], places[k]) <= OFF
        })
    };
    let mut text = format!("M{}", pair(*first));
    let (mut from, last) = (0, places.len() - 1);
    let mut has_moved = false;
    while from < last {
        let mut to = from + 1;
        while to < last && to - from < LONGEST && holds(from, to + 1) {
            to += 1;
        }
        let [b, c] = handles(from, to);
        has_moved |= [b, c, places[to]].iter().any(|place| distance(*place, *first) > OFF);
        text += &format!("C{} {} {}", pair(b), pair(c), pair(places[to]));
        from = to;
    }
    if has_moved { text } else { String::new() }
}

fn pair([x, y]: Vector, decimals: usize) -> String {
    format!("{} {}", number(x, decimals), number(y, decimals))
}

#[cfg(test)]
mod tests {
    use super::curve;

    #[test]
    fn a_circle_takes_few_pieces() {
        let rows: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.01).collect();
        let turn = |t: &f64| 2.0 * std::f64::consts::PI * t;
        let places: Vec<[f64; 2]> = rows.iter().map(|t| crate::scene::polar(100.0, turn(t))).collect();
        let velocities: Vec<[f64; 2]> =
            rows.iter().map(|t| crate::scene::polar(200.0 * std::f64::consts::PI, turn(t) + turn(&0.25))).collect();
        let d = curve(&places, &velocities, &rows, 2);
        let pieces = d.matches('C').count();
        assert!((4..=10).contains(&pieces), "{pieces} pieces: {d}");
        assert!(curve(&[[1.0, 1.0]; 5], &[[0.0; 2]; 5], &rows[..5], 2).is_empty(), "what rests has no path");
    }
}
