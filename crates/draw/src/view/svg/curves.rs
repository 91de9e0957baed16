//! Traces as smooth cubic curves through positions and velocities, with as few pieces as possible.

use super::picture::{PIXELS_PER_METER, Picture};
use super::style::TRACE_COLORS;
use crate::scene::{Motion, Pen, Stroke, Track, Vector, bounds, distance, is_finite, minus, plus, times};
use crate::view::text::{decimal, escape};

/// Tolerance of a curve (px), the same as a part of the picture's shorter side, and for cutting (m of paper).
const TOLERANCE: f64 = 0.03;
const TOLERANCE_OF_SIDE: f64 = 4e-5;
const TOLERANCE_OF_PAPER: f64 = 0.4e-6;
/// Limit of nodes that one curve replaces, and of halvings of a piece.
const MOST_NODES: usize = 64;
const MOST_HALVINGS: u32 = 16;
/// Size below which a trace is at rest (px).
const AT_REST: f64 = 0.15;

impl Picture<'_> {
    /// Adds the traces of the text and those of the options.
    pub fn add_traces(&mut self, motion: &Motion) {
        let scene = self.scene;
        let mut color = 0;
        for trace in &scene.traces {
            let name = self.name(trace.declaration);
            let d = self.path_data(&trace.pen, motion);
            self.add_trace(name, &d, &mut color);
        }
        for (name, anchor) in &self.options.traces {
            let is_traced = scene.traces.iter().any(|trace| trace.pen == Pen::Point(*anchor));
            if !is_traced {
                let d = self.path_data(&Pen::Point(*anchor), motion);
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
        self.styles.traces.insert(number);
        self.body += &format!("<path class=\"trace t{number}\" data-name=\"{}\" d=\"{d}\"/>\n", escape(name));
    }

    /// Writes the path of a pen.
    fn path_data(&self, pen: &Pen, motion: &Motion) -> String {
        let track = motion.track(pen);
        let stretches = motion.strokes(pen);
        stretches.iter().map(|stretch| self.stroke_data(&track, stretch, motion)).collect()
    }

    fn stroke_data(&self, track: &Track, stretch: &Stroke, motion: &Motion) -> String {
        let [width, height] = self.drawing_size();
        let (mut off, mut decimals) = (TOLERANCE.min(TOLERANCE_OF_SIDE * width.min(height)), self.pixel_decimals);
        if self.options.scale.is_some() {
            off = TOLERANCE_OF_PAPER * PIXELS_PER_METER;
        }
        while decimals < 9 && last_decimal(decimals) > 0.5 * off {
            decimals += 1;
        }
        let node = |t: f64| {
            let [at, velocity] = track.at(motion, t);
            let [x, y] = if is_finite(velocity) { velocity } else { [0.0; 2] };
            CurvePoint { t, at: self.to_pixels(at), velocity: [self.scale * x, -self.scale * y] }
        };
        let text = curve(&stretch.pieces, &node, off, decimals);
        if stretch.is_closed && !text.is_empty() { text + "Z" } else { text }
    }
}

/// Returns the value of the last decimal.
fn last_decimal(decimals: usize) -> f64 {
    (0..decimals).fold(1.0, |step, _| 0.1 * step)
}

/// A position of a curve (px) at a time (s), with its velocity (px/s).
#[derive(Clone, Copy, Debug)]
struct CurvePoint {
    t: f64,
    at: Vector,
    velocity: Vector,
}

/// Returns the inner control points of the cubic from one node to another.
fn handles(from: &CurvePoint, to: &CurvePoint) -> [Vector; 2] {
    let third = (to.t - from.t) / 3.0;
    [plus(from.at, times(third, from.velocity)), minus(to.at, times(third, to.velocity))]
}

/// Returns whether the cubic between two nodes is within a tolerance (px) of a third node at its time.
fn is_near([from, to]: [&CurvePoint; 2], node: &CurvePoint, off: f64) -> bool {
    let [b, c] = handles(from, to);
    let s = (node.t - from.t) / (to.t - from.t);
    let r = 1.0 - s;
    let mix = |part: usize| {
        let ends = r * r * r * from.at[part] + s * s * s * to.at[part];
        ends + 3.0 * r * s * (r * b[part] + s * c[part])
    };
    distance([mix(0), mix(1)], node.at) <= off
}

/// Adds the nodes of a piece, without the first one, such that the cubics between them keep the tolerance (px).
fn add_nodes(
    of: &dyn Fn(f64) -> CurvePoint,
    [from, to]: [CurvePoint; 2],
    off: f64,
    depth: u32,
    nodes: &mut Vec<CurvePoint>,
) {
    let time = |part: f64| from.t + part * (to.t - from.t);
    let is_within_tolerance = [0.25, 0.5, 0.75].into_iter().all(|part| is_near([&from, &to], &of(time(part)), off));
    if is_within_tolerance || depth >= MOST_HALVINGS {
        nodes.push(to);
        return;
    }
    let middle = of(time(0.5));
    add_nodes(of, [from, middle], off, depth + 1, nodes);
    add_nodes(of, [middle, to], off, depth + 1, nodes);
}

/// Writes a smooth curve along intervals of time (s) with as few cubics as possible.
fn curve(pieces: &[[f64; 2]], of: &dyn Fn(f64) -> CurvePoint, off: f64, decimals: usize) -> String {
    let pair = |position| pair(position, decimals);
    let Some([begin, _]) = pieces.first() else { return String::new() };
    // times continue from piece to piece, though the motion may begin anew between them
    let mut parts: Vec<Vec<CurvePoint>> = vec![vec![of(*begin)]];
    for ends @ [from, _] in pieces {
        let is_new = parts.last().and_then(|part| part.last()).is_none_or(|last| (last.t - from).abs() > 0.0);
        if is_new {
            parts.push(vec![of(*from)]);
        }
        if let Some(part) = parts.last_mut() {
            add_nodes(of, ends.map(of), 0.5 * off, 0, part);
        }
    }
    let all = || parts.iter().flatten();
    let is_at_rest = bounds(all().map(|node| node.at)).is_none_or(|[low, high]| distance(low, high) <= AT_REST);
    if is_at_rest {
        return String::new();
    }
    let mut text = all().next().map_or_else(String::new, |first| format!("M{}", pair(first.at)));
    for nodes in &parts {
        let (mut from, last) = (0, nodes.len() - 1);
        while from < last {
            let is_within_tolerance = |to: usize| {
                let between = nodes[from + 1..to].iter().copied();
                let middles = nodes[from..=to].windows(2).map(|ends| of(0.5 * (ends[0].t + ends[1].t)));
                between.chain(middles).all(|node| is_near([&nodes[from], &nodes[to]], &node, off))
            };
            let mut to = from + 1;
            while to < last && to - from < MOST_NODES && is_within_tolerance(to + 1) {
                to += 1;
            }
            let [b, c] = handles(&nodes[from], &nodes[to]);
            text += &format!("C{} {} {}", pair(b), pair(c), pair(nodes[to].at));
            from = to;
        }
    }
    text
}

fn pair([x, y]: Vector, decimals: usize) -> String {
    format!("{} {}", decimal(x, decimals), decimal(y, decimals))
}

#[cfg(test)]
mod tests {
    use super::{CurvePoint, curve};
    use crate::scene::polar;
    use std::f64::consts::PI;

    #[test]
    fn a_circle_takes_few_pieces() {
        let turn = |t: f64| 2.0 * PI * t;
        let node =
            |t: f64| CurvePoint { t, at: polar(100.0, turn(t)), velocity: polar(200.0 * PI, turn(t) + 0.5 * PI) };
        let pieces: Vec<[f64; 2]> = (0..100).map(|k| [f64::from(k), f64::from(k + 1)].map(|t| 0.01 * t)).collect();
        for pieces in [&pieces[..], &[[0.0, 1.0]]] {
            let d = curve(pieces, &node, 0.02, 2);
            let count = d.matches('C').count();
            assert!((8..=20).contains(&count), "{count} pieces: {d}");
        }
        let rest = |t: f64| CurvePoint { t, at: [1.0; 2], velocity: [0.0; 2] };
        assert!(curve(&pieces, &rest, 0.02, 2).is_empty(), "what rests has no path");
    }
}
