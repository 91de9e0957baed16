//! Plane geometry: vectors, poses, and the paths of shapes.

use mechc_expr::math;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Position or displacement (m), or a direction.
pub type Vector = [f64; 2];

/// Pose of a frame in the ground's frame, or its rate.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Pose {
    /// Origin (m).
    pub at: Vector,
    /// Direction of the x axis (rad), not wrapped.
    pub phi: f64,
}

impl Pose {
    /// Converts a vector of the frame to the ground's frame.
    #[must_use]
    pub fn rotate(&self, [x, y]: Vector) -> Vector {
        let (sin, cos) = math::sin_cos(self.phi);
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// Converts a position of the frame to the ground's frame.
    #[must_use]
    pub fn transform(&self, local: Vector) -> Vector {
        plus(self.at, self.rotate(local))
    }

    /// Converts a vector of the ground's frame to this frame.
    #[must_use]
    pub fn inverse_rotate(&self, [x, y]: Vector) -> Vector {
        let (sin, cos) = math::sin_cos(self.phi);
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// Converts a position of the ground's frame to this frame.
    #[must_use]
    pub fn inverse_transform(&self, global: Vector) -> Vector {
        self.inverse_rotate(minus(global, self.at))
    }

    /// Returns the velocity of a point of the frame [m/s], where `self` is the frame's rate [m/s, rad/s] and `pose` its pose.
    #[must_use]
    pub fn velocity(&self, pose: &Pose, local: Vector) -> Vector {
        let arm = pose.rotate(local);
        plus(self.at, times(self.phi, left(arm)))
    }

    /// Returns the acceleration of a point of the frame [m/s²], where `self` is the frame's acceleration, `rate` its rate and `pose` its
    /// pose.
    #[must_use]
    pub fn acceleration(&self, rate: &Pose, pose: &Pose, local: Vector) -> Vector {
        let arm = pose.rotate(local);
        plus(self.velocity(pose, local), times(-rate.phi * rate.phi, arm))
    }
}

/// Returns `a + b`.
#[must_use]
pub fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

/// Returns `a − b`.
#[must_use]
pub fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns `k a`.
#[must_use]
pub fn times(k: f64, a: Vector) -> Vector {
    [k * a[0], k * a[1]]
}

/// Returns `aᵀ b`.
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns `(a^⊥)ᵀ b`, the component of `b` to the left of `a` times the length of `a`.
#[must_use]
pub fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Rotates a vector by 90° to the left.
#[must_use]
pub fn left(a: Vector) -> Vector {
    [-a[1], a[0]]
}

/// Returns the length of a vector.
#[must_use]
pub fn length(a: Vector) -> f64 {
    math::hypot(a[0], a[1])
}

/// Returns the distance of two positions.
#[must_use]
pub fn distance(a: Vector, b: Vector) -> f64 {
    length(minus(a, b))
}

/// Returns the distance of a position from a segment.
#[must_use]
pub fn distance_to_segment(position: Vector, [from, to]: [Vector; 2]) -> f64 {
    let chord = minus(to, from);
    let square = dot(chord, chord);
    let part = if square > 0.0 { (dot(minus(position, from), chord) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(position, plus(from, times(part, chord)))
}

/// Returns the vector of length 1 in the same direction, or the x direction for a zero vector.
#[must_use]
pub fn unit(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 { times(1.0 / length, a) } else { [1.0, 0.0] }
}

/// Returns the direction of a vector (rad), in (−π, π].
#[must_use]
pub fn direction(a: Vector) -> f64 {
    math::atan2(a[1], a[0])
}

/// Returns the vector of a length in a direction (rad).
#[must_use]
pub fn polar(length: f64, direction: f64) -> Vector {
    let (sin, cos) = math::sin_cos(direction);
    [length * cos, length * sin]
}

/// Returns whether both coordinates are finite.
#[must_use]
pub fn is_finite(a: Vector) -> bool {
    a[0].is_finite() && a[1].is_finite()
}

/// Returns the lower and upper corner of the bounding box of all finite positions, or `None` if there are none.
#[must_use]
pub fn bounds(positions: impl IntoIterator<Item = Vector>) -> Option<[Vector; 2]> {
    positions.into_iter().filter(|position| is_finite(*position)).fold(None, |corners: Option<[Vector; 2]>, [x, y]| {
        let [low, high] = corners.unwrap_or([[x, y]; 2]);
        Some([[low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]])
    })
}

/// A polyline with arcs, open or closed.
#[derive(Clone, PartialEq, Debug)]
pub struct Contour {
    /// First position.
    pub start: Vector,
    /// Segments in order.
    pub segments: Vec<Segment>,
    /// True if it ends where it begins.
    pub is_closed: bool,
}

/// A segment of a contour.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Segment {
    /// Straight line to a position.
    Line(Vector),
    /// Arc to a position, at most a semicircle.
    Arc {
        /// End.
        to: Vector,
        /// Radius of the circle (m).
        radius: f64,
        /// True if it turns to the left.
        is_left: bool,
    },
}

impl Segment {
    /// Returns the end of the segment.
    #[must_use]
    pub fn end(self) -> Vector {
        match self {
            Segment::Line(to) | Segment::Arc { to, .. } => to,
        }
    }
}

/// A path that is drawn as one.
#[derive(Clone, PartialEq, Debug)]
pub enum Path {
    /// Circle.
    Circle {
        /// Centre (m).
        at: Vector,
        /// Radius (m).
        radius: f64,
    },
    /// Contours, filled by the even-odd rule.
    Lines(Vec<Contour>),
}

impl Path {
    /// Creates an open polyline; without positions the path is empty.
    #[must_use]
    pub fn line(positions: impl IntoIterator<Item = Vector>) -> Path {
        Path::Lines(Contour::new(positions, false).into_iter().collect())
    }

    /// Creates a closed polygon; without positions the path is empty.
    #[must_use]
    pub fn polygon(positions: impl IntoIterator<Item = Vector>) -> Path {
        Path::Lines(Contour::new(positions, true).into_iter().collect())
    }

    /// Creates separate straight lines.
    #[must_use]
    pub fn strokes(strokes: impl IntoIterator<Item = [Vector; 2]>) -> Path {
        let contour =
            |[start, end]: [Vector; 2]| Contour { start, segments: vec![Segment::Line(end)], is_closed: false };
        Path::Lines(strokes.into_iter().map(contour).collect())
    }

    /// Creates an arc around a centre between two directions (rad), less than a full turn apart.
    #[must_use]
    pub fn arc(at: Vector, radius: f64, from: f64, to: f64) -> Path {
        let middle = 0.5 * (from + to);
        let position = |angle| plus(at, polar(radius, angle));
        let arc = |angle| Segment::Arc { to: position(angle), radius, is_left: to > from };
        Path::Lines(vec![Contour { start: position(from), segments: vec![arc(middle), arc(to)], is_closed: false }])
    }

    /// Returns positions whose hull contains the path, apart from bulges of arcs.
    #[must_use]
    pub fn positions(&self) -> Vec<Vector> {
        match self {
            Path::Circle { at, radius } => {
                (0..8).map(|k| plus(*at, polar(*radius, f64::from(k) * TAU / 8.0))).collect()
            }
            Path::Lines(contours) => contours
                .iter()
                .flat_map(|one| std::iter::once(one.start).chain(one.segments.iter().map(|part| part.end())))
                .collect(),
        }
    }

    /// Returns positions along the path, at most a step (m) apart.
    #[must_use]
    pub fn sampled(&self, step: f64) -> Vec<Vector> {
        let mut samples = Vec::new();
        match self {
            Path::Circle { at, radius } => add_arc(&mut samples, *at, *radius, [0.0, TAU], step),
            Path::Lines(contours) => contours.iter().for_each(|contour| contour.add_samples(&mut samples, step)),
        }
        samples
    }

    /// Returns the path in the ground's frame, for a path in the frame with this pose.
    #[must_use]
    pub fn transform(&self, pose: &Pose) -> Path {
        match self {
            Path::Circle { at, radius } => Path::Circle { at: pose.transform(*at), radius: *radius },
            Path::Lines(contours) => Path::Lines(contours.iter().map(|one| one.transform(pose)).collect()),
        }
    }
}

impl Contour {
    fn new(positions: impl IntoIterator<Item = Vector>, is_closed: bool) -> Option<Contour> {
        let mut positions = positions.into_iter();
        let start = positions.next()?;
        Some(Contour { start, segments: positions.map(Segment::Line).collect(), is_closed })
    }

    fn add_samples(&self, samples: &mut Vec<Vector>, step: f64) {
        let mut from = self.start;
        let closing = self.is_closed.then_some(Segment::Line(self.start));
        for segment in self.segments.iter().copied().chain(closing) {
            let chord = minus(segment.end(), from);
            match segment {
                Segment::Line(_) => {
                    let count = interval_count(length(chord), step);
                    samples.extend((0..=count).map(|k| plus(from, times(f64::from(k) / f64::from(count), chord))));
                }
                Segment::Arc { to, radius, is_left } => {
                    let half = 0.5 * length(chord);
                    let away = (radius * radius - half * half).max(0.0).sqrt() * if is_left { 1.0 } else { -1.0 };
                    let center = plus(plus(from, times(0.5, chord)), times(away, left(unit(chord))));
                    let [begin, end] = [from, to].map(|position| direction(minus(position, center)));
                    // at most a semicircle, either way
                    let turn = if is_left { end - begin } else { begin - end };
                    let turn = turn - TAU * math::floor(turn / TAU);
                    add_arc(samples, center, radius, [begin, begin + if is_left { turn } else { -turn }], step);
                }
            }
            from = segment.end();
        }
    }

    fn transform(&self, pose: &Pose) -> Contour {
        let segment = |segment: &Segment| match *segment {
            Segment::Line(to) => Segment::Line(pose.transform(to)),
            Segment::Arc { to, radius, is_left } => Segment::Arc { to: pose.transform(to), radius, is_left },
        };
        Contour { start: pose.transform(self.start), segments: self.segments.iter().map(segment).collect(), ..*self }
    }
}

/// Adds positions on a circle between two directions (rad).
fn add_arc(samples: &mut Vec<Vector>, at: Vector, radius: f64, [from, to]: [f64; 2], step: f64) {
    let count = interval_count(radius * (to - from).abs(), step);
    let angle = |k: u32| from + (to - from) * f64::from(k) / f64::from(count);
    samples.extend((0..=count).map(|k| plus(at, polar(radius, angle(k)))));
}

/// Returns the number of intervals of a length, each at most a step long.
fn interval_count(length: f64, step: f64) -> u32 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 1 and 1000
    let count = (length / step).clamp(0.0, 999.0) as u32;
    count + 1
}

/// Returns the corners of the convex hull, counter-clockwise. Positions closer than `near` (m) count once.
#[must_use]
pub fn hull(positions: &[Vector], near: f64) -> Vec<Vector> {
    let mut sorted: Vec<Vector> = positions.iter().copied().filter(|position| is_finite(*position)).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut distinct: Vec<Vector> = Vec::with_capacity(sorted.len());
    for position in sorted {
        let near_in_x = distinct.iter().rev().take_while(|other| position[0] - other[0] <= near);
        if !near_in_x.into_iter().any(|other| distance(*other, position) <= near) {
            distinct.push(position);
        }
    }
    if distinct.len() < 3 {
        return distinct;
    }
    let half = |positions: &mut dyn Iterator<Item = Vector>| {
        let mut chain: Vec<Vector> = Vec::new();
        for position in positions {
            while let [.., a, b] = chain[..] {
                let width = distance(a, position).max(near);
                if cross(minus(b, a), minus(position, a)) > near * width {
                    break;
                }
                chain.pop();
            }
            chain.push(position);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut distinct.iter().copied());
    lower.extend(half(&mut distinct.iter().rev().copied()));
    lower
}

/// Returns the outline of everything within a distance of a convex polygon: a disc for one corner, a bar for two, a rounded plate for more.
#[must_use]
pub fn around(corners: &[Vector], reach: f64) -> Path {
    match corners {
        [] => Path::Lines(Vec::new()),
        [at] => Path::Circle { at: *at, radius: reach },
        _ => {
            let count = corners.len();
            let outward = |k: usize| {
                let along = unit(minus(corners[(k + 1) % count], corners[k]));
                times(-reach, left(along))
            };
            let start = plus(corners[0], outward(0));
            let mut segments = Vec::with_capacity(3 * count);
            for k in 0..count {
                let corner = corners[(k + 1) % count];
                let (before, after) = (outward(k), outward((k + 1) % count));
                segments.push(Segment::Line(plus(corner, before)));
                let turn = direction(after) - direction(before);
                let turn = turn - TAU * math::floor(turn / TAU);
                if turn > FRAC_PI_2 * 1.9 {
                    // a semicircle could be drawn on either side
                    let middle = plus(corner, polar(reach, direction(before) + 0.5 * turn.min(PI)));
                    segments.push(Segment::Arc { to: middle, radius: reach, is_left: true });
                }
                segments.push(Segment::Arc { to: plus(corner, after), radius: reach, is_left: true });
            }
            Path::Lines(vec![Contour { start, segments, is_closed: true }])
        }
    }
}

/// Returns a rectangle around a centre, from half its length along a direction of length 1 and half its width.
#[must_use]
pub fn rectangle(at: Vector, along: Vector, half: f64, across: f64) -> Path {
    let (x, y) = (times(half, along), times(across, left(along)));
    Path::polygon([minus(minus(at, x), y), minus(plus(at, x), y), plus(plus(at, x), y), plus(minus(at, x), y)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_corners_and_nothing_between() {
        let square = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.0], [1.0, 1.0], [0.5, 0.5], [0.0, 1.0], [0.0, 1e-15]];
        assert_eq!(hull(&square, 1e-9), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(hull(&[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]], 1e-9), [[0.0, 0.0], [2.0, 2.0]], "a bar");
        assert_eq!(hull(&[[3.0, 4.0]; 5], 1e-9).len(), 1);
        assert!(hull(&[[f64::NAN, 0.0]], 1e-9).is_empty());
    }

    #[test]
    fn what_lies_around_a_polygon_keeps_its_distance() {
        for corners in [vec![[0.0, 0.0], [3.0, 0.0]], vec![[0.0, 0.0], [4.0, 0.0], [1.0, 2.0]]] {
            for position in around(&corners, 0.5).positions() {
                let nearest = |k: usize| {
                    let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                    let chord = minus(b, a);
                    let part = (dot(minus(position, a), chord) / dot(chord, chord)).clamp(0.0, 1.0);
                    distance(position, plus(a, times(part, chord)))
                };
                let least = (0..corners.len()).map(nearest).fold(f64::INFINITY, f64::min);
                assert!((least - 0.5).abs() < 1e-12, "{position:?} is {least} away");
            }
        }
    }

    #[test]
    fn samples_are_on_the_path() {
        let bar = around(&[[0.0, 0.0], [3.0, 0.0]], 0.5);
        let samples = bar.sampled(0.05);
        for [x, y] in &samples {
            let off = distance([*x, *y], [x.clamp(0.0, 3.0), 0.0]);
            assert!((off - 0.5).abs() < 1e-12, "{x}, {y} is {off} away");
        }
        assert!(samples.windows(2).all(|pair| distance(pair[0], pair[1]) <= 0.05 + 1e-12));
        assert!(distance(samples[0], samples[samples.len() - 1]) < 1e-12, "all around");
        for to in [-2.0, 2.0] {
            let arc = Path::arc([1.0, 1.0], 2.0, 0.3, 0.3 + to);
            let inner = [1.0, 1.0];
            assert!(arc.sampled(0.1).iter().all(|position| (distance(*position, inner) - 2.0).abs() < 1e-12));
        }
    }

    #[test]
    fn velocities_and_accelerations_are_slopes() {
        let at = |t: f64| Pose { at: [t * t, 3.0 * t], phi: 0.5 * t * t };
        let (rate, acceleration) = (Pose { at: [2.0, 3.0], phi: 1.0 }, Pose { at: [2.0, 0.0], phi: 1.0 });
        let (local, h) = ([0.3, -0.2], 1e-4);
        let [before, now, after] = [1.0 - h, 1.0, 1.0 + h].map(|t| at(t).transform(local));
        let slope = times(0.5 / h, minus(after, before));
        let bend = times(1.0 / (h * h), minus(plus(before, after), times(2.0, now)));
        assert!(distance(slope, rate.velocity(&at(1.0), local)) < 1e-6);
        assert!(distance(bend, acceleration.acceleration(&rate, &at(1.0), local)) < 1e-5);
    }
}
