//! Velocities and accelerations at pins and traced points, as arrows.

use super::keyframes::{Animation, Key};
use super::picture::PIXELS;
use super::picture::Picture;
use crate::scene::{Anchor, Motion, Pen, Point, Scene, Vector, direction, distance, length, minus, plus, times};
use crate::view::text::{decimal, escape};

/// Length of the longest arrow of a kind as a part of the picture's shorter side.
const LONGEST: f64 = 0.2;
/// Length below which an arrow is not drawn (px).
const LEAST: f64 = 2.0;
/// Length and half the width of a full head (px).
const HEAD: [f64; 2] = [9.0, 3.4];
/// Length from which on an arrow has a full head (px).
const FULL_HEAD_AT: f64 = 18.0;
/// Left edge of the legend, and length of its arrows (px).
pub(super) const LEGEND: f64 = 12.0;
const LEGEND_ARROW: f64 = 26.0;

/// Number of rows that are sampled for the longest arrow.
pub(super) const SAMPLED_ROWS: usize = 200;
/// Points slower than this part of the fastest one are at rest.
const AT_REST: f64 = 1e-9;

/// Kind of arrows: its name, and its vector for a point in a row.
type ArrowKind = (&'static str, fn(&Motion, usize, &Point) -> Vector);

const ARROW_KINDS: [ArrowKind; 2] = [("velocity", velocity), ("acceleration", acceleration)];

impl Picture<'_> {
    /// Adds the arrows of the last moment, in the scale of the whole motion.
    pub fn add_vectors(&mut self, moments: &Motion, motion: &Motion) {
        let row = moments.len() - 1;
        let points = self.distinct(self.moving_points([moments, motion]), moments);
        for (word, of) in ARROW_KINDS {
            let Some(scale) = self.arrow_scale(&points, [moments, motion], (word, of)) else { continue };
            for pin in &points {
                let from = self.to_pixels(moments.poses(row)[pin.frame].transform(pin.at));
                let [x, y] = times(scale, of(moments, row, pin));
                self.add_vector(word, &pin.name, from, [x, -y]);
            }
        }
    }

    /// Adds the arrows of the whole motion. The line and the head of each arrow have separate tracks.
    pub fn add_moving_vectors(&mut self, motion: &Motion) {
        let points = self.distinct(self.moving_points([motion, motion]), motion);
        for (word, of) in ARROW_KINDS {
            let Some(scale) = self.arrow_scale(&points, [motion, motion], (word, of)) else { continue };
            for pin in &points {
                let arrows: Vec<[Vector; 2]> = (0..motion.len())
                    .map(|row| {
                        let [x, y] = times(scale, of(motion, row, pin));
                        [self.to_pixels(motion.poses(row)[pin.frame].transform(pin.at)), [x, -y]]
                    })
                    .collect();
                self.add_moving_vector(word, &pin.name, &arrows, &motion.times);
            }
        }
    }

    /// Adds an arrow with its starts and vectors (px) at some times (s). Its line and its head have separate tracks.
    pub(super) fn add_moving_vector(&mut self, word: &'static str, name: &str, arrows: &[[Vector; 2]], times: &[f64]) {
        if arrows.iter().all(|[_, vector]| length(*vector) < LEAST) {
            return;
        }
        self.styles.vectors.insert(word);
        let turn = |vector: Vector| direction(vector).to_degrees();
        let line =
            |[from, vector]: &[Vector; 2]| Key { at: *from, turn: turn(*vector), stretch: [length(*vector), 1.0] };
        let size = |vector: Vector| (length(vector) / FULL_HEAD_AT).min(1.0);
        let head = |[from, vector]: &[Vector; 2]| Key {
            at: plus(*from, *vector),
            turn: turn(*vector),
            stretch: [size(*vector); 2],
        };
        let [long, wide] = HEAD;
        let name = escape(name).into_owned();
        let lines = Animation::new(arrows.iter().map(line).collect(), &[[1.0, 0.0]], times, false);
        let heads = Animation::new(arrows.iter().map(head).collect(), &[[-long, wide]], times, false);
        for (animation, d) in [(lines, "M0 0L1 0".to_owned()), (heads, format!("M0 0L{0} {wide}L{0} -{wide}Z", -long))]
        {
            let attributes = self.add_animation(&animation);
            self.body +=
                &format!("<g{attributes}><path class=\"vector {word}\" data-name=\"{name}\" d=\"{d}\"/></g>\n");
        }
    }

    /// Returns the pixels per unit, from the longest arrow of two motions, and adds the legend. Returns `None` if all points are at rest.
    fn arrow_scale(&mut self, points: &[Point], motions: [&Motion; 2], (word, of): ArrowKind) -> Option<f64> {
        let longest = points.iter().map(|point| longest_of(of, point, motions)).fold(0.0, f64::max);
        if longest <= 0.0 {
            return None;
        }
        let (unit, line) = if word == "velocity" { ("m/s", 1.0) } else { ("m/s²", 0.0) };
        self.add_legend(word, longest, unit, line);
        Some(self.longest_arrow() / longest)
    }

    /// Returns the length of the longest arrow (px).
    pub(super) fn longest_arrow(&self) -> f64 {
        LONGEST * self.drawing_size()[0].min(self.drawing_size()[1])
    }

    /// Adds the legend of a kind of arrows, with its largest value, at a line counted from the bottom.
    pub(super) fn add_legend(&mut self, word: &'static str, longest: f64, unit: &str, line: f64) {
        let y = self.legend_line(line) - 0.35 * self.letters();
        self.add_vector(word, word, [LEGEND, y], [LEGEND_ARROW, 0.0]);
        self.add_legend_text(word, longest, unit, line);
    }

    /// Returns the baseline of a line of the legend (px).
    pub(super) fn legend_line(&self, line: f64) -> f64 {
        self.drawing_size()[1] - (0.6 + 1.3 * line) * self.letters()
    }

    /// Adds the text of a line of the legend.
    pub(super) fn add_legend_text(&mut self, words: &str, longest: f64, unit: &str, line: f64) {
        self.styles.labels = Some(self.letters());
        self.body += &format!(
            "<text class=\"legend\" x=\"{}\" y=\"{}\">{words}, at most {} {unit}</text>\n",
            decimal(LEGEND + LEGEND_ARROW + 6.0, PIXELS),
            decimal(self.legend_line(line), PIXELS),
            three_digits(longest)
        );
    }

    /// Returns the points that have arrows.
    fn moving_points(&self, motions: [&Motion; 2]) -> Vec<Point> {
        moving_points(self.scene, &self.options.traces, motions)
    }

    /// Keeps one of the points that coincide along the whole motion.
    fn distinct(&self, points: Vec<Point>, motion: &Motion) -> Vec<Point> {
        let rows: Vec<usize> = motion.sampled(3).collect();
        let mut occupied: Vec<Vec<Vector>> = Vec::new();
        let mut is_free = |point: &Point| {
            let at: Vec<Vector> =
                rows.iter().map(|row| self.to_pixels(motion.poses(*row)[point.frame].transform(point.at))).collect();
            let coincides = |other: &Vec<Vector>| other.iter().zip(&at).all(|(a, b)| distance(*a, *b) < 0.5);
            let is_free = !occupied.iter().any(coincides);
            occupied.extend(is_free.then_some(at));
            is_free
        };
        points.into_iter().filter(|point| is_free(point)).collect()
    }

    pub(super) fn add_vector(&mut self, word: &'static str, name: &str, from: Vector, vector: Vector) {
        let far = length(vector);
        if far < LEAST {
            return;
        }
        self.styles.vectors.insert(word);
        let along = times(1.0 / far, vector);
        let [long, wide] = HEAD.map(|part| part * (far / FULL_HEAD_AT).min(1.0));
        let tip = plus(from, vector);
        let base = minus(tip, times(long, along));
        let side = times(wide, [-along[1], along[0]]);
        let pair = |[x, y]: Vector| format!("{} {}", decimal(x, PIXELS), decimal(y, PIXELS));
        self.body += &format!(
            "<path class=\"vector {word}\" data-name=\"{}\" d=\"M{}L{}M{}L{}L{}Z\"/>\n",
            escape(name),
            pair(from),
            pair(base),
            pair(tip),
            pair(plus(base, side)),
            pair(minus(base, side)),
        );
    }
}

/// Returns whether any point of a moving mechanism has arrows, the points of `traces` included.
#[must_use]
pub fn has_vectors(scene: &Scene, traces: &[(String, Anchor)], motion: &Motion) -> bool {
    !moving_points(scene, traces, [motion, motion]).is_empty()
}

/// Returns the points that have arrows: pins and traced points that move, and for a body without these its other named points that move.
fn moving_points(scene: &Scene, traces: &[(String, Anchor)], motions: [&Motion; 2]) -> Vec<Point> {
    let pens = scene.traces.iter().filter_map(|trace| match trace.pen {
        Pen::Point(anchor) => Some((scene.declarations.get(trace.declaration)?.name.clone(), anchor)),
        Pen::Columns { .. } => None,
    });
    let pens: Vec<(String, Anchor)> = pens.chain(traces.iter().cloned()).collect();
    let is_at = |point: &Point, anchor: &Anchor| point.frame == anchor.frame && distance(point.at, anchor.at) <= 0.0;
    let mut points: Vec<(Point, bool)> = Vec::new();
    for point in &scene.points {
        let is_traced = pens.iter().any(|(_, anchor)| is_at(point, anchor));
        points.push((point.clone(), point.is_pin || is_traced));
    }
    for (name, anchor) in pens {
        if !points.iter().any(|(point, _)| is_at(point, &anchor)) {
            let Anchor { frame, at } = anchor;
            points.push((Point { declaration: frame, name, frame, at, is_pin: false }, true));
        }
    }
    let speeds: Vec<f64> = points.iter().map(|(point, _)| longest_of(velocity, point, motions)).collect();
    let least = AT_REST * speeds.iter().copied().fold(0.0, f64::max);
    let points_in_motion =
        points.into_iter().zip(speeds).filter(|((point, _), speed)| point.frame > 0 && *speed > least);
    let moving_points: Vec<(Point, bool)> = points_in_motion.map(|(point, _)| point).collect();
    let has_preferred =
        |frame: usize| moving_points.iter().any(|(point, is_preferred)| *is_preferred && point.frame == frame);
    let is_chosen = |(point, is_preferred): &&(Point, bool)| *is_preferred || !has_preferred(point.frame);
    moving_points.iter().filter(is_chosen).map(|(point, _)| point.clone()).collect()
}

/// Returns the length of a point's longest vector of a kind.
fn longest_of(of: fn(&Motion, usize, &Point) -> Vector, point: &Point, motions: [&Motion; 2]) -> f64 {
    let rows = motions.into_iter().flat_map(|motion| motion.sampled(SAMPLED_ROWS).map(move |row| (motion, row)));
    let lengths = rows.map(|(motion, row)| length(of(motion, row, point)));
    lengths.filter(|length| length.is_finite()).fold(0.0, f64::max)
}

/// Formats a number with three significant digits.
fn three_digits(value: f64) -> String {
    match value {
        _ if !(1e-3..1e6).contains(&value) => format!("{value:.2e}"),
        _ if value >= 100.0 => decimal(value, 0),
        _ if value >= 10.0 => decimal(value, 1),
        _ if value >= 1.0 => decimal(value, 2),
        _ if value >= 0.1 => decimal(value, 3),
        _ if value >= 0.01 => decimal(value, 4),
        _ => decimal(value, 5),
    }
}

fn velocity(motion: &Motion, row: usize, point: &Point) -> Vector {
    motion.rates(row)[point.frame].velocity(&motion.poses(row)[point.frame], point.at)
}

fn acceleration(motion: &Motion, row: usize, point: &Point) -> Vector {
    let (pose, rate) = (&motion.poses(row)[point.frame], &motion.rates(row)[point.frame]);
    motion.accelerations(row)[point.frame].acceleration(rate, pose, point.at)
}
