//! Where a pen is along a motion: in its rows, and between two of them on the curve through both, by as many derivatives as the table has;
//! and the stretches that it draws without a gap.

use super::plane::{Pose, Vector, bounds, distance, dot, is_finite, minus, plus};
use super::{Anchor, Motion, Pen};
use crate::math;

/// What tells where a pen is, or what a column is worth: where in the table that stands.
#[derive(Clone, PartialEq, Debug)]
pub struct Track {
    /// What it moves with: a point of a frame, or the origin of what columns are read in.
    frame: usize,
    /// Where it is there; of columns, where their frame is.
    pose: Pose,
    /// Of columns: value, rate and acceleration of x, then of y; none where the table has none.
    columns: Option<[[Option<usize>; 3]; 2]>,
    is_mirrored: bool,
}

impl Track {
    /// Where a pen is (m), and its velocity (m/s), at a time (s) that is not before a row and not behind the next one; not finite where
    /// it has no place.
    #[must_use]
    pub fn between(&self, motion: &Motion, row: usize, t: f64) -> [Vector; 2] {
        let [pose, rate] = motion.pose_between(self.frame, row, t);
        let Some(columns) = &self.columns else {
            return [pose.placed(self.pose.at), rate.velocity(&pose, self.pose.at)];
        };
        let [x, y] = columns.map(|columns| column_between(motion, columns, row, t));
        let at = self.pose.placed(self.mirrored([x[0], y[0]]));
        let way = self.pose.turned(self.mirrored([x[1], y[1]]));
        [pose.placed(at), plus(rate.velocity(&pose, at), pose.turned(way))]
    }

    /// The same at any time.
    #[must_use]
    pub fn at(&self, motion: &Motion, t: f64) -> [Vector; 2] {
        self.between(motion, motion.row_at(t).min(motion.len().saturating_sub(2)), t)
    }

    /// Where it is in a row.
    #[must_use]
    pub fn in_row(&self, motion: &Motion, row: usize) -> Vector {
        let Some(columns) = &self.columns else { return motion.poses(row)[self.frame].placed(self.pose.at) };
        let local = columns.map(|[value, ..]| cell(motion, value, row));
        motion.poses(row)[self.frame].placed(self.pose.placed(self.mirrored(local)))
    }

    fn mirrored(&self, [x, y]: Vector) -> Vector {
        [x, if self.is_mirrored { -y } else { y }]
    }
}

/// A number of the table; what has no column is zero.
fn cell(motion: &Motion, column: Option<usize>, row: usize) -> f64 {
    let Some(column) = column else { return 0.0 };
    motion.rows().get(row).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN)
}

/// A column and its derivative between two rows.
fn column_between(motion: &Motion, columns: [Option<usize>; 3], row: usize, t: f64) -> [f64; 2] {
    let next = (row + 1).min(motion.len().saturating_sub(1));
    let [from, to] = [row, next].map(|row| columns.map(|column| cell(motion, column, row)));
    let h = motion.times[next] - motion.times[row];
    // in a row it is what the row says, whatever comes behind that
    let part = (t - motion.times[row]) / h;
    match part > 0.0 {
        true if motion.is_short(row) => {
            let way = to[0] - from[0];
            [from[0] + part * way, way / h]
        }
        true => between([from, to], h, part),
        false => [from[0], from[1]],
    }
}

/// A value and its derivative at a part of the way between two rows, `h` (s) apart, each with its derivatives as far as they are known.
fn between([from, to]: [[f64; 3]; 2], h: f64, part: f64) -> [f64; 2] {
    if from.iter().chain(&to).all(|value| value.is_finite()) {
        let [value, slope, _] = math::value_and_slopes(&math::quintic(from, to, h), part);
        return [value, slope / h];
    }
    let ([a, slope_a, _], [b, slope_b, _]) = (from, to);
    if !(slope_a.is_finite() && slope_b.is_finite()) {
        return [a + part * (b - a), (b - a) / h];
    }
    let rest = 1.0 - part;
    let ends = rest * rest * (1.0 + 2.0 * part) * a + part * part * (1.0 + 2.0 * rest) * b;
    let value = ends + h * part * rest * (rest * slope_a - part * slope_b);
    let ways = rest * (1.0 - 3.0 * part) * slope_a - part * (2.0 - 3.0 * part) * slope_b;
    [value, 6.0 * part * rest * (b - a) / h + ways]
}

/// A part of what a pen draws, without a gap.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Stroke {
    /// Stretches of time (s), none of which goes over a row; each begins where the one before it ends.
    pub pieces: Vec<[f64; 2]>,
    /// Whether it ends where it begins.
    pub is_closed: bool,
}

/// Places that are looked at in a piece to find where a line closes.
const LOOKED_AT: u32 = 8;
/// Halvings by which the moment is found at which a line closes.
const HALVINGS: u32 = 60;
/// A line closes if it comes nearer to where it begins than this many times what it may be off, once it has been farther away than this
/// part of its size. What is drawn once more may be off the closed line by so many times what it may be off.
const CLOSED: f64 = 2.0;
const AWAY: f64 = 1e-3;
const ONCE_MORE: f64 = 7.0;
/// Lines are never more off than this part of their size.
const OFF: f64 = 1e-5;

impl Motion {
    /// What tells where a pen is.
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

    /// What tells what a column is worth, as x of a place.
    #[must_use]
    pub fn track_of_column(&self, name: &str) -> Track {
        let columns = Some([self.derivatives(name), [None; 3]]);
        Track { frame: 0, pose: Pose::default(), columns, is_mirrored: false }
    }

    /// The times of all rows (s), with so many steps from one to the next.
    #[must_use]
    pub fn times_between(&self, steps: u32) -> Vec<f64> {
        let pairs = self.times.windows(2);
        let between = |ends: &[f64]| {
            let [from, to] = [ends[0], ends[1]];
            (0..steps).map(move |k| from + (to - from) * f64::from(k) / f64::from(steps))
        };
        pairs.flat_map(between).chain(self.times.last().copied()).collect()
    }

    /// What a column is worth at some times (s), in SI; not a number where it has no value, and between rows where it has a gap.
    #[must_use]
    pub fn column_at(&self, name: &str, times: &[f64]) -> Vec<f64> {
        let (track, gaps) = (self.track_of_column(name), self.gaps(name));
        let value = |t: &f64| {
            let row = self.row_at(*t);
            let [from, to] = [row, row + 1].map(|row| self.times.get(row).copied().unwrap_or(f64::NAN));
            let is_gap = from < *t && *t < to && gaps.iter().any(|gap| gap.total_cmp(&from).is_eq());
            if is_gap { f64::NAN } else { track.between(self, row, *t)[0][0] }
        };
        times.iter().map(value).collect()
    }

    /// The stretches that a pen draws; where it retraces a closed line, that line once. Nothing of what rests.
    #[must_use]
    pub fn strokes(&self, pen: &Pen) -> Vec<Stroke> {
        let track = self.track(pen);
        let gaps = match pen {
            Pen::Point(_) => &[][..],
            Pen::Columns { name, .. } => self.gaps(name),
        };
        let mut stretches: Vec<Stroke> = Vec::new();
        let mut is_open = false;
        for (row, ends) in self.times.windows(2).enumerate() {
            let is_there = !gaps.iter().any(|gap| gap.total_cmp(&ends[0]).is_eq())
                && [row, row + 1].into_iter().all(|row| is_finite(track.in_row(self, row)));
            if is_there && !is_open {
                stretches.push(Stroke::default());
            }
            is_open = is_there;
            if let Some(stretch) = stretches.last_mut().filter(|_| is_there) {
                stretch.pieces.push([ends[0], ends[1]]);
            }
        }
        self.close(&track, stretches)
    }

    /// Joins what ends where it begins.
    fn close(&self, track: &Track, mut stretches: Vec<Stroke>) -> Vec<Stroke> {
        let at = |t: f64| track.at(self, t)[0];
        let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else { return stretches };
        let (Some([begin, _]), Some([_, end])) = (first.pieces.first(), last.pieces.last()) else { return stretches };
        // what goes to infinity is not so large
        let start = at(*begin);
        let pieces = stretches.iter().flat_map(|stretch| &stretch.pieces);
        let mut away: Vec<f64> = pieces.map(|[_, t]| distance(at(*t), start)).collect();
        away.sort_by(f64::total_cmp);
        let size = 2.0 * away.get(away.len() / 2).copied().unwrap_or(0.0);
        let off = self.off.min(OFF * size);
        if stretches.len() > 1 {
            // the motion comes back to where it began in the middle of a stretch
            let is_back = distance(start, at(*end)) <= CLOSED * off;
            if is_back && let Some(mut last) = stretches.pop() {
                last.pieces.append(&mut stretches[0].pieces);
                stretches[0] = last;
            }
            return stretches;
        }
        if let Some(stretch) = stretches.first_mut() {
            self.close_one(track, stretch, [size, off]);
        }
        stretches
    }

    /// Ends a stretch where it has come back to where it began, if all behind that is on the line so far.
    fn close_one(&self, track: &Track, stretch: &mut Stroke, [size, off]: [f64; 2]) {
        let at = |t: f64| track.at(self, t)[0];
        let Some(&[begin, _]) = stretch.pieces.first() else { return };
        let start = at(begin);
        let mut is_away = false;
        for number in 0..stretch.pieces.len() {
            let [from, to] = stretch.pieces[number];
            let time = |k: u32| from + (to - from) * f64::from(k) / f64::from(LOOKED_AT);
            for k in 1..=LOOKED_AT {
                let [before, t] = [time(k - 1), if k == LOOKED_AT { to } else { time(k) }];
                if !is_away {
                    is_away = distance(at(t), start) > AWAY * size;
                    continue;
                }
                let reach = distance(at(before), at(t));
                if distance(at(t), start).min(distance(at(before), start)) > 2.0 * reach + CLOSED * off {
                    continue;
                }
                let back = self.nearest(track, start, [before, t]);
                if distance(at(back), start) > CLOSED * off {
                    continue;
                }
                let mut loop_so_far: Vec<[f64; 2]> = stretch.pieces[..number].to_vec();
                loop_so_far.extend((back > from).then_some([from, back]));
                let rest = [back, to].into_iter().chain(stretch.pieces[number + 1..].iter().flatten().copied());
                if self.goes_on_along(track, &loop_so_far, rest, ONCE_MORE * off) {
                    *stretch = Stroke { pieces: loop_so_far, is_closed: true };
                    return;
                }
            }
        }
    }

    /// When a track is nearest to a place, in a short time.
    fn nearest(&self, track: &Track, place: Vector, [mut from, mut to]: [f64; 2]) -> f64 {
        let comes_nearer = |t: f64| {
            let [at, velocity] = track.at(self, t);
            dot(velocity, minus(at, place)) < 0.0
        };
        let ends = [from, to];
        if comes_nearer(from) && !comes_nearer(to) {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (from + to);
                if comes_nearer(middle) { from = middle } else { to = middle }
            }
            return to;
        }
        let off = |t: f64| distance(track.at(self, t)[0], place);
        if off(ends[0]) < off(ends[1]) { ends[0] } else { ends[1] }
    }

    /// Whether a track is on a line, but for so much (m), at all of some times (s).
    fn goes_on_along(&self, track: &Track, line: &[[f64; 2]], mut at: impl Iterator<Item = f64>, off: f64) -> bool {
        // a piece is within half of how far a quick way between its ends would lead; most are too far away to be looked at
        let pieces: Vec<([f64; 2], [Vector; 2])> = line
            .iter()
            .map(|ends @ [from, to]| {
                let places = (0..=LOOKED_AT).map(|k| from + (to - from) * f64::from(k) / f64::from(LOOKED_AT));
                let places = places.map(|t| track.at(self, t)[0]);
                (*ends, bounds(places).unwrap_or([[f64::NAN; 2]; 2]))
            })
            .collect();
        at.all(|t| {
            let place = track.at(self, t)[0];
            pieces.iter().any(|([from, to], [low, high])| {
                let slack = 0.25 * distance(*low, *high) + off;
                let is_near = (0..2).all(|k| place[k] >= low[k] - slack && place[k] <= high[k] + slack);
                is_near
                    && (0..LOOKED_AT).any(|k| {
                        let time = |k: u32| from + (to - from) * f64::from(k) / f64::from(LOOKED_AT);
                        let ends = [time(k), time(k + 1)];
                        distance(track.at(self, self.nearest(track, place, ends))[0], place) <= off
                    })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn columns_go_on_by_what_is_known_of_them() {
        // t⁴ from 1 to 2
        let end = |t: f64| [t * t * t * t, 4.0 * t * t * t, 12.0 * t * t];
        let [value, slope] = between([end(1.0), end(2.0)], 1.0, 0.5);
        assert!((value - 5.0625).abs() < 1e-12 && (slope - 13.5).abs() < 1e-12, "{value}, {slope}");
        // t³, whose accelerations are missing
        let end = |t: f64| [t * t * t, 3.0 * t * t, f64::NAN];
        let [value, slope] = between([end(1.0), end(3.0)], 2.0, 0.25);
        assert!((value - 3.375).abs() < 1e-12 && (slope - 6.75).abs() < 1e-12, "{value}, {slope}");
        let [value, slope] = between([[1.0, f64::NAN, 0.0], [2.0, 0.0, 0.0]], 0.5, 0.25);
        assert!((value - 1.25).abs() < 1e-12 && (slope - 2.0).abs() < 1e-12, "{value}, {slope}");
    }
}
