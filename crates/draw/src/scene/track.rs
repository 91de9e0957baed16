//! Position of a pen along a motion, in rows and between them, by as many derivatives as the table has; and the strokes that it draws
//! without gaps.

use super::motion::{Gaps, Motion, Track};
use super::plane::{Pose, Vector, bounds, distance, dot, is_finite, length, minus, plus};
use super::{Anchor, Pen};
use mechc_expr::math;
use std::ops::Range;

impl Track {
    /// Returns the position of a pen (m) and its velocity (m/s) at a time (s) between a row and the next one; not finite where it has no
    /// position.
    #[must_use]
    pub fn between(&self, motion: &Motion, row: usize, t: f64) -> [Vector; 2] {
        let [pose, rate] = motion.pose_between(self.frame, row, t);
        let Some(columns) = &self.columns else {
            return [pose.transform(self.pose.at), rate.velocity(&pose, self.pose.at)];
        };
        let [x, y] = columns.map(|columns| column_between(motion, columns, row, t));
        let at = self.pose.transform(self.mirrored([x[0], y[0]]));
        let velocity = self.pose.rotate(self.mirrored([x[1], y[1]]));
        [pose.transform(at), plus(rate.velocity(&pose, at), pose.rotate(velocity))]
    }

    /// Returns the position (m) and the velocity (m/s) at any time (s).
    #[must_use]
    pub fn at(&self, motion: &Motion, t: f64) -> [Vector; 2] {
        self.between(motion, motion.row_at(t).min(motion.len().saturating_sub(2)), t)
    }

    /// Returns the position in a row (m).
    #[must_use]
    pub fn in_row(&self, motion: &Motion, row: usize) -> Vector {
        let Some(columns) = &self.columns else { return motion.poses(row)[self.frame].transform(self.pose.at) };
        let local = columns.map(|[value, ..]| cell(motion, value, row));
        motion.poses(row)[self.frame].transform(self.pose.transform(self.mirrored(local)))
    }

    fn mirrored(&self, [x, y]: Vector) -> Vector {
        [x, if self.is_mirrored { -y } else { y }]
    }
}

/// Returns a number of the table; a missing column is zero.
fn cell(motion: &Motion, column: Option<usize>, row: usize) -> f64 {
    let Some(column) = column else { return 0.0 };
    motion.rows().get(row).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN)
}

/// Returns the value and the derivative of a column between two rows.
fn column_between(motion: &Motion, columns: [Option<usize>; 3], row: usize, t: f64) -> [f64; 2] {
    let next = (row + 1).min(motion.len().saturating_sub(1));
    let [from, to] = [row, next].map(|row| columns.map(|column| cell(motion, column, row)));
    let h = motion.times[next] - motion.times[row];
    // in a row the row decides, whatever follows
    let part = (t - motion.times[row]) / h;
    match part > 0.0 {
        true if motion.is_short(row) => {
            let difference = to[0] - from[0];
            [from[0] + part * difference, difference / h]
        }
        true => between([from, to], h, part),
        false => [from[0], from[1]],
    }
}

/// Returns a value and its derivative at `part` of the way between two rows that are `h` (s) apart. The interpolation uses the derivatives
/// that are finite at both ends.
fn between([from, to]: [[f64; 3]; 2], h: f64, part: f64) -> [f64; 2] {
    let ends = [from, to];
    let are_finite = |order: usize| ends.iter().all(|end| end[order].is_finite());
    let [[a, slope_a, _], [b, slope_b, _]] = ends;
    let curve = match [are_finite(1), are_finite(2)] {
        [true, true] => math::quintic(from, to, h),
        [true, false] => math::cubic([a, slope_a], [b, slope_b], h),
        [false, _] => math::parabola([a, (b - a) / h, 0.0], h),
    };
    let [value, slope, _] = math::value_and_derivatives(&curve, part);
    [value, slope / h]
}

/// A stroke that a pen draws without a gap.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Stroke {
    /// Intervals of time (s), none across a row; each begins where the one before it ends.
    pub pieces: Vec<[f64; 2]>,
    /// True if the stroke ends where it begins.
    pub is_closed: bool,
}

/// Number of parts of a piece; in each the line has at most one point nearest to a position.
const PARTS: u32 = 8;
/// Number of bisections for the time of the nearest point.
const HALVINGS: u32 = 60;
/// Distance from its start at which a line closes, in tolerances.
const CLOSING_TOLERANCE: f64 = 2.0;
/// Distance from its start beyond which a line has left it, as a part of its size.
const LEAVING_DISTANCE: f64 = 1e-3;
/// Distance within which a line retraces itself, in tolerances.
pub const RETRACE_TOLERANCE: f64 = 7.0;
/// Limit of the tolerance of lines, as a part of their size.
const RELATIVE_TOLERANCE: f64 = 1e-5;

/// A line with a tree of bounding boxes, which tells quickly whether it passes a position.
#[derive(Clone, Debug)]
pub struct DrawnLine<'m> {
    motion: &'m Motion,
    track: Track,
    /// Intervals of time (s) between two rows, ascending.
    pieces: Vec<[f64; 2]>,
    /// Bounding boxes of the pieces, then of pairs of them, of groups of four, and so on up to one box for all.
    boxes: Vec<Vec<[Vector; 2]>>,
}

impl<'m> DrawnLine<'m> {
    /// Creates the line of a track over intervals of time (s), none across a row.
    #[must_use]
    pub fn new(motion: &'m Motion, track: Track, pieces: Vec<[f64; 2]>) -> DrawnLine<'m> {
        let box_of = |ends: &[f64; 2]| {
            let [low, high] = bounds((0..=PARTS).map(|k| track.at(motion, part_of(*ends, k))[0]))?;
            // a quick piece leaves the box of its samples by at most half of the way between two of them
            let slack = 0.25 * distance(low, high);
            Some([low.map(|value| value - slack), high.map(|value| value + slack)])
        };
        let nowhere = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let mut boxes = vec![pieces.iter().map(|ends| box_of(ends).unwrap_or(nowhere)).collect::<Vec<_>>()];
        while let Some(level) = boxes.last().filter(|level| level.len() > 1) {
            let around = |pair: &[[Vector; 2]]| {
                pair.iter().fold(nowhere, |[low, high], [other_low, other_high]| {
                    let of = |k: usize| (low[k].min(other_low[k]), high[k].max(other_high[k]));
                    let [(low_x, high_x), (low_y, high_y)] = [of(0), of(1)];
                    [[low_x, low_y], [high_x, high_y]]
                })
            };
            boxes.push(level.chunks(2).map(around).collect());
        }
        DrawnLine { motion, track, pieces, boxes }
    }

    /// Returns whether the line passes within a distance (m) of a position.
    #[must_use]
    pub fn passes(&self, position: Vector, off: f64) -> bool {
        self.piece_range_passes(0..self.pieces.len(), position, off)
    }

    /// Returns whether some pieces of the line pass within a distance (m) of a position.
    fn piece_range_passes(&self, pieces: Range<usize>, position: Vector, off: f64) -> bool {
        let mut boxes = vec![(self.boxes.len() - 1, 0)];
        while let Some((level, number)) = boxes.pop() {
            let span = (number << level)..((number + 1) << level);
            let Some([low, high]) = self.boxes[level].get(number) else { continue };
            let is_near = (0..2).all(|k| position[k] >= low[k] - off && position[k] <= high[k] + off);
            if !is_near || span.end <= pieces.start || span.start >= pieces.end {
                continue;
            }
            match level.checked_sub(1) {
                Some(below) => boxes.extend([(below, 2 * number), (below, 2 * number + 1)]),
                None if self.piece_passes(self.pieces[number], position, off) => return true,
                None => {}
            }
        }
        false
    }

    fn piece_passes(&self, ends: [f64; 2], position: Vector, off: f64) -> bool {
        (0..PARTS).any(|k| {
            let nearest = self.nearest(position, [part_of(ends, k), part_of(ends, k + 1)], off);
            distance(self.at(nearest), position) <= off
        })
    }

    fn at(&self, t: f64) -> Vector {
        self.track.at(self.motion, t)[0]
    }

    /// Returns the time at which the line is nearest to a position within a short interval, or one at which it is at most `enough` (m)
    /// away.
    fn nearest(&self, position: Vector, [mut from, mut to]: [f64; 2], enough: f64) -> f64 {
        let look = |t: f64| {
            let [at, velocity] = self.track.at(self.motion, t);
            let difference = minus(at, position);
            (length(difference), dot(velocity, difference) < 0.0)
        };
        let [first, last] = [look(from), look(to)];
        if first.0 <= enough || !first.1 || last.1 {
            return if first.0 < last.0 { from } else { to };
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            let (away, comes_nearer) = look(middle);
            if away <= enough {
                return middle;
            }
            if comes_nearer { from = middle } else { to = middle }
        }
        to
    }
}

/// Returns the time (s) of part `k` of an interval.
fn part_of([from, to]: [f64; 2], k: u32) -> f64 {
    if k == PARTS { to } else { from + (to - from) * f64::from(k) / f64::from(PARTS) }
}

impl Motion {
    /// Returns the track of a pen.
    #[must_use]
    pub fn track(&self, pen: &Pen) -> Track {
        match pen {
            Pen::Point(Anchor { frame, at }) => {
                Track { frame: *frame, pose: Pose { at: *at, phi: 0.0 }, columns: None, is_mirrored: false }
            }
            Pen::Columns { name, frame, pose, is_mirrored } => {
                let columns = ["x", "y"].map(|part| self.derivatives(&format!("{name}.{part}")));
                Track { frame: *frame, pose: *pose, columns: Some(columns), is_mirrored: *is_mirrored }
            }
        }
    }

    /// Returns the track of a column, whose x coordinate is the column's value.
    #[must_use]
    pub fn column_track(&self, name: &str) -> Track {
        let columns = Some([self.derivatives(name), [None; 3]]);
        Track { frame: 0, pose: Pose::default(), columns, is_mirrored: false }
    }

    /// Returns the times of all rows (s), with `steps` equal steps from each row to the next.
    #[must_use]
    pub fn times_between(&self, steps: u32) -> Vec<f64> {
        let pairs = self.times.windows(2);
        let between = |ends: &[f64]| {
            let [from, to] = [ends[0], ends[1]];
            (0..steps).map(move |k| from + (to - from) * f64::from(k) / f64::from(steps))
        };
        pairs.flat_map(between).chain(self.times.last().copied()).collect()
    }

    /// Returns the values of a column at some times (s), in SI. They are NaN where the column has no value, and between rows where it has a
    /// gap.
    #[must_use]
    pub fn column_at(&self, name: &str, times: &[f64]) -> Vec<f64> {
        let track = self.column_track(name);
        let gaps = self.gaps(&track);
        let value = |t: &f64| {
            let row = self.row_at(*t);
            let is_gap =
                self.times.get(row).is_some_and(|from| from < t) && gaps.is_some_and(|gaps| gaps.is_behind(row));
            if is_gap { f64::NAN } else { track.between(self, row, *t)[0][0] }
        };
        times.iter().map(value).collect()
    }

    /// Returns the strokes of a pen. A line that retraces itself is drawn once, a line at rest not at all.
    #[must_use]
    pub fn strokes(&self, pen: &Pen) -> Vec<Stroke> {
        let track = self.track(pen);
        let gaps = self.gaps(&track);
        let mut strokes: Vec<Stroke> = Vec::new();
        let mut is_open = false;
        for (row, ends) in self.times.windows(2).enumerate() {
            let is_there = !gaps.is_some_and(|gaps| gaps.is_behind(row))
                && [row, row + 1].into_iter().all(|row| is_finite(track.in_row(self, row)));
            if is_there && !is_open {
                strokes.push(Stroke::default());
            }
            is_open = is_there;
            if let Some(stroke) = strokes.last_mut().filter(|_| is_there) {
                stroke.pieces.push([ends[0], ends[1]]);
            }
        }
        let pieces: Vec<[f64; 2]> = strokes.iter().flat_map(|stroke| &stroke.pieces).copied().collect();
        match self.return_to_start(&DrawnLine::new(self, track, pieces), gaps) {
            Some((piece, t)) => close_strokes(strokes, piece, t),
            None => strokes,
        }
    }

    /// Returns the piece and the time (s) at which a line is back at its start and from then on only retraces itself.
    fn return_to_start(&self, line: &DrawnLine, gaps: Option<&Gaps>) -> Option<(usize, f64)> {
        let start = line.at(line.pieces.first()?[0]);
        // the median is not affected by what goes to infinity
        let mut distances: Vec<f64> = line.pieces.iter().map(|[_, t]| distance(line.at(*t), start)).collect();
        distances.sort_by(f64::total_cmp);
        let size = 2.0 * distances[distances.len() / 2];
        let off = self.off.min(RELATIVE_TOLERANCE * size);
        let mut retrace = Retrace { line, gaps, off: RETRACE_TOLERANCE * off, compared: 0, last_return: 0 };
        let mut has_left = false;
        for (number, piece) in line.pieces.iter().enumerate() {
            for k in 0..PARTS {
                let times = [part_of(*piece, k), part_of(*piece, k + 1)];
                let ends = times.map(|t| line.at(t));
                let apart = ends.map(|end| distance(end, start));
                if !has_left {
                    has_left = apart[1] > LEAVING_DISTANCE * size;
                    continue;
                }
                let reach = 2.0 * distance(ends[0], ends[1]) + CLOSING_TOLERANCE * off;
                if apart[0].min(apart[1]) > reach {
                    continue;
                }
                let back = line.nearest(start, times, 0.0);
                let is_back = distance(line.at(back), start) <= CLOSING_TOLERANCE * off;
                if is_back && retrace.is_complete(number, back) {
                    return Some((number, back));
                }
            }
        }
        None
    }
}

/// Check whether a line that is back at its start retraces itself.
///
/// The end of each piece is found on the line only once, however often the line comes back: what lies on a part of the line lies on a
/// longer part, too.
struct Retrace<'l, 'm> {
    line: &'l DrawnLine<'m>,
    gaps: Option<&'l Gaps>,
    /// Tolerance of the ends of pieces (m).
    off: f64,
    /// Number of ends that are already found on the line.
    compared: usize,
    /// Piece in which the line came back last.
    last_return: usize,
}

impl Retrace<'_, '_> {
    /// Returns whether the line retraces itself from a time (s) in a piece on.
    fn is_complete(&mut self, number: usize, back: f64) -> bool {
        let pieces = &self.line.pieces;
        let next = 2 * number + 1;
        // an end that was off the line is compared with what the line has drawn since
        let mut first = if self.compared > next { self.last_return } else { 0 };
        (self.compared, self.last_return) = (self.compared.max(next), number);
        while self.compared < 2 * pieces.len() {
            let t = pieces[self.compared / 2][self.compared % 2];
            let is_compared = t.total_cmp(&pieces[(self.compared - 1) / 2][(self.compared - 1) % 2]).is_eq();
            let is_on = |position: Vector| {
                self.gaps.is_some_and(|gaps| gaps.is_far(position))
                    || self.line.piece_range_passes(first..number, position, self.off)
                    || self.line.piece_passes([pieces[number][0], back], position, self.off)
            };
            if !is_compared && !is_on(self.line.at(t)) {
                return false;
            }
            self.compared += 1;
            first = 0;
        }
        true
    }
}

/// Ends strokes at a time (s) in one of their pieces, at which the line is back at its start.
fn close_strokes(strokes: Vec<Stroke>, piece: usize, back: f64) -> Vec<Stroke> {
    let (mut result, mut remaining): (Vec<Stroke>, usize) = (Vec::new(), piece);
    for mut stroke in strokes {
        let count = stroke.pieces.len();
        if remaining < count {
            let [from, _] = stroke.pieces[remaining];
            stroke.pieces.truncate(remaining);
            stroke.pieces.extend((back > from).then_some([from, back]));
            result.extend(Some(stroke).filter(|stroke| !stroke.pieces.is_empty()));
            break;
        }
        remaining -= count;
        result.push(stroke);
    }
    match result.as_mut_slice() {
        [stroke] => stroke.is_closed = true,
        [first, .., last] => {
            // the line returns to a start in the middle of a stroke
            last.pieces.append(&mut first.pieces);
            result.swap_remove(0);
        }
        [] => {}
    }
    result
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn columns_are_interpolated_by_their_finite_derivatives() {
        // t⁴ from 1 to 2
        let end = |t: f64| [t * t * t * t, 4.0 * t * t * t, 12.0 * t * t];
        let [value, slope] = between([end(1.0), end(2.0)], 1.0, 0.5);
        assert!((value - 5.0625).abs() < 1e-12 && (slope - 13.5).abs() < 1e-12, "{value}, {slope}");
        // t³ without accelerations
        let end = |t: f64| [t * t * t, 3.0 * t * t, f64::NAN];
        let [value, slope] = between([end(1.0), end(3.0)], 2.0, 0.25);
        assert!((value - 3.375).abs() < 1e-12 && (slope - 6.75).abs() < 1e-12, "{value}, {slope}");
        let [value, slope] = between([[1.0, f64::NAN, 0.0], [2.0, 0.0, 0.0]], 0.5, 0.25);
        assert!((value - 1.25).abs() < 1e-12 && (slope - 2.0).abs() < 1e-12, "{value}, {slope}");
    }
}
