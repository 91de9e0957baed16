//! Poses of all frames in the rows of a table, and between the rows.

use super::plane::{Pose, Vector, distance, minus, plus, times};
use mechc_expr::math;
use rustc_hash::FxHashMap;

/// Rows closer than this part of the whole motion are joined by straight lines.
const SHORT_INTERVAL: f64 = 2e-12;
/// Default of [`Motion::off`] (m).
const DEFAULT_TOLERANCE: f64 = 1e-7;
/// Tolerance, in steps, by which an evenly spaced time may miss its row.
const ROW_SLACK: f64 = 1e-6;

/// Poses of all frames with first and second derivatives at some times, and the rows of the table that pictures read.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// Times (s), ascending.
    pub times: Vec<f64>,
    /// Times at which accelerations may jump (s), ascending.
    pub edges: Vec<f64>,
    frames: usize,
    /// Poses by row, the ground first in each.
    poses: Vec<Pose>,
    rates: Vec<Pose>,
    accelerations: Vec<Pose>,
    /// Rows of the table, all columns in SI.
    rows: Vec<Vec<f64>>,
    columns: FxHashMap<String, usize>,
    /// Tolerance of lines between rows (m).
    pub off: f64,
    /// Rows closer than this (s) are joined by straight lines.
    short: f64,
    gaps: Vec<(Track, Gaps)>,
}

/// Source of a moving position, or of a column's value, resolved to columns of the table.
#[derive(Clone, PartialEq, Debug)]
pub struct Track {
    /// Frame that carries the point or the coordinates of the columns.
    pub(super) frame: usize,
    /// Position in that frame; of columns the pose of their coordinates.
    pub(super) pose: Pose,
    /// Columns of value, rate and acceleration of x, then of y, as far as the table has them; `None` for a point of a frame.
    pub(super) columns: Option<[[Option<usize>; 3]; 2]>,
    pub(super) is_mirrored: bool,
}

/// Intervals in which a track is not drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Gaps {
    /// True for each row, except the last, after which nothing is drawn until the next one: the track goes to infinity, jumps, has no value
    /// or is not accurate enough.
    pub behind: Vec<bool>,
    /// Centre of the track and the distance from it (m) beyond which the track goes to infinity.
    pub reach: (Vector, f64),
}

impl Gaps {
    /// Returns whether nothing is drawn between a row and the next one.
    #[must_use]
    pub fn is_behind(&self, row: usize) -> bool {
        self.behind.get(row).copied().unwrap_or(false)
    }

    /// Returns whether a position lies on the way to infinity.
    #[must_use]
    pub fn is_far(&self, position: Vector) -> bool {
        let (middle, far) = self.reach;
        distance(position, middle) > far
    }
}

impl Motion {
    /// Creates a motion from a table whose first column is time. `bodies` are the frames after the ground; for each it holds the columns of
    /// x, y and phi, then of their first and of their second derivatives.
    #[must_use]
    pub fn of_rows(bodies: &[[[usize; 3]; 3]], columns: &[String], rows: Vec<Vec<f64>>, edges: Vec<f64>) -> Motion {
        let named = columns.iter().cloned().enumerate().map(|(k, name)| (name, k)).collect();
        let poses_of = |order: usize| {
            let mut poses = Vec::with_capacity(rows.len() * (bodies.len() + 1));
            for row in &rows {
                poses.push(Pose::default());
                poses.extend(bodies.iter().map(|columns| {
                    let [x, y, phi] = columns[order].map(|column| row.get(column).copied().unwrap_or(0.0));
                    Pose { at: [x, y], phi }
                }));
            }
            poses
        };
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let span = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
        let [poses, rates, accelerations] = [0, 1, 2].map(poses_of);
        let (frames, gaps) = (bodies.len() + 1, Vec::new());
        let short = SHORT_INTERVAL * span;
        Motion {
            times,
            edges,
            frames,
            poses,
            rates,
            accelerations,
            rows,
            columns: named,
            off: DEFAULT_TOLERANCE,
            short,
            gaps,
        }
    }

    /// Creates a motion of a single moment without velocities.
    #[must_use]
    pub fn still(poses: Vec<Pose>) -> Motion {
        let rest = vec![Pose::default(); poses.len()];
        let (rates, accelerations) = (rest.clone(), rest);
        Motion { times: vec![0.0], frames: poses.len(), poses, rates, accelerations, ..Motion::default() }
    }

    /// Returns one row as a motion.
    #[must_use]
    pub fn moment(&self, row: usize) -> Motion {
        self.moments(&[row])
    }

    /// Returns some rows as a motion.
    #[must_use]
    pub fn moments(&self, rows: &[usize]) -> Motion {
        let of = |list: fn(&Motion, usize) -> &[Pose]| rows.iter().flat_map(|&row| list(self, row)).copied().collect();
        Motion {
            times: rows.iter().map(|&row| self.times[row]).collect(),
            frames: self.frames,
            poses: of(Motion::poses),
            rates: of(Motion::rates),
            accelerations: of(Motion::accelerations),
            rows: rows.iter().filter_map(|&row| self.rows.get(row).cloned()).collect(),
            edges: Vec::new(),
            columns: self.columns.clone(),
            off: self.off,
            short: self.short,
            gaps: Vec::new(),
        }
    }

    /// Keeps the first `len` rows and removes all gaps.
    pub fn truncate(&mut self, len: usize) {
        self.times.truncate(len);
        for poses in [&mut self.poses, &mut self.rates, &mut self.accelerations] {
            poses.truncate(len * self.frames);
        }
        self.rows.truncate(len);
        self.gaps.clear();
    }

    /// Appends the last row of another motion with the same frames and columns.
    pub fn append_last_row(&mut self, other: &Motion) {
        let Some(last) = other.len().checked_sub(1) else { return };
        self.times.push(other.times[last]);
        self.poses.extend_from_slice(other.poses(last));
        self.rates.extend_from_slice(other.rates(last));
        self.accelerations.extend_from_slice(other.accelerations(last));
        self.rows.extend(other.rows.get(last).cloned());
    }

    /// Returns this motion merged, by time, with the rows of another one with the same frames and columns, without gaps.
    #[must_use]
    pub fn merged(&self, other: &Motion) -> Motion {
        let mut all: Vec<(&Motion, usize)> =
            [self, other].iter().flat_map(|one| (0..one.len()).map(|row| (*one, row))).collect();
        all.sort_by(|(a, row), (b, other)| a.times[*row].total_cmp(&b.times[*other]));
        let of =
            |list: fn(&Motion, usize) -> &[Pose]| all.iter().flat_map(|(one, row)| list(one, *row)).copied().collect();
        Motion {
            times: all.iter().map(|(one, row)| one.times[*row]).collect(),
            edges: self.edges.clone(),
            frames: self.frames,
            poses: of(Motion::poses),
            rates: of(Motion::rates),
            accelerations: of(Motion::accelerations),
            rows: all.iter().filter_map(|(one, row)| one.rows.get(*row).cloned()).collect(),
            columns: self.columns.clone(),
            off: self.off,
            short: self.short,
            gaps: Vec::new(),
        }
    }

    /// Sets the gaps of a track.
    pub fn set_gaps(&mut self, track: Track, gaps: Gaps) {
        self.gaps.push((track, gaps));
    }

    /// Returns the gaps of a track, or `None` if none were set.
    #[must_use]
    pub fn gaps(&self, track: &Track) -> Option<&Gaps> {
        self.gaps.iter().find(|(existing, _)| existing == track).map(|(_, gaps)| gaps)
    }

    /// Sets the duration (s) of the whole motion, of which this is a part.
    pub fn set_total_duration(&mut self, span: f64) {
        self.short = SHORT_INTERVAL * span;
    }

    /// Returns the columns of a value, its rate and its acceleration.
    pub(super) fn derivatives(&self, name: &str) -> [Option<usize>; 3] {
        ["", ".d", ".dd"].map(|order| self.columns.get(&format!("{name}{order}")).copied())
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the number of frames, the ground included.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Returns the poses of all frames in a row.
    #[must_use]
    pub fn poses(&self, row: usize) -> &[Pose] {
        &self.poses[row * self.frames..][..self.frames]
    }

    /// Returns the velocities of all frames in a row [m/s, rad/s].
    #[must_use]
    pub fn rates(&self, row: usize) -> &[Pose] {
        &self.rates[row * self.frames..][..self.frames]
    }

    /// Returns the accelerations of all frames in a row [m/s², rad/s²].
    #[must_use]
    pub fn accelerations(&self, row: usize) -> &[Pose] {
        &self.accelerations[row * self.frames..][..self.frames]
    }

    /// Returns the values of a column by row, or `None` if the table has no column of that name.
    #[must_use]
    pub fn column<'m>(&'m self, name: &str) -> Option<impl Iterator<Item = f64> + use<'m>> {
        let column = *self.columns.get(name)?;
        Some(self.rows.iter().map(move |row| row[column]))
    }

    /// Returns the value of a column in a row, in SI, or NaN if the table has no column of that name.
    #[must_use]
    pub fn value(&self, column: &str, row: usize) -> f64 {
        let column = self.columns.get(column).copied();
        column.zip(self.rows.get(row)).and_then(|(column, row)| row.get(column)).copied().unwrap_or(f64::NAN)
    }

    /// Returns the rows of the table, all columns in SI; a still motion has none.
    #[must_use]
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    /// Returns at most `most` rows, evenly spaced in time, with the first and the last.
    pub fn sampled(&self, most: usize) -> impl Iterator<Item = usize> + use<> {
        let (count, last) = (self.len().min(most.max(1)), self.len().saturating_sub(1));
        let mut rows: Vec<usize> = (0..count).map(|k| k * last / (count - 1).max(1)).collect();
        if count < self.len() && count > 1 {
            let [from, to] = [self.times[0], self.times[last]];
            let each = (to - from) / (count - 1) as f64;
            rows = (0..count).map(|k| self.row_at(from + (k as f64 + ROW_SLACK) * each)).collect();
            rows.dedup();
        }
        rows.into_iter()
    }

    /// Returns whether the next row comes so soon that derivatives, which may be unbounded there, are of no use.
    pub(super) fn is_short(&self, row: usize) -> bool {
        self.times.get(row + 1).is_some_and(|next| next - self.times[row] <= self.short)
    }

    /// Returns the last row at or before a time (s).
    #[must_use]
    pub fn row_at(&self, t: f64) -> usize {
        self.times.partition_point(|&time| time <= t).saturating_sub(1)
    }

    /// Writes the poses of all frames at a time (s). Between rows it evaluates the quintic Hermite curve, but not across an edge.
    pub fn write_poses(&self, t: f64, poses: &mut Vec<Pose>) {
        poses.clear();
        let row = self.row_at(t);
        poses.extend((0..self.frames).map(|frame| self.pose_between(frame, row, t)[0]));
    }

    /// Returns the pose of a frame and its rate at a time (s) between a row and the next one.
    pub(super) fn pose_between(&self, frame: usize, row: usize, t: f64) -> [Pose; 2] {
        let state = |row: usize| [self.poses(row)[frame], self.rates(row)[frame], self.accelerations(row)[frame]];
        let Some(&begin) = self.times.get(row) else { return [Pose::default(); 2] };
        let from = state(row);
        let Some(&end) = self.times.get(row + 1).filter(|_| t > begin) else { return [from[0], from[1]] };
        let (to, h) = (state(row + 1), end - begin);
        if self.is_short(row) {
            return chord(from[0], to[0], h, (t - begin) / h);
        }
        let next_edge = self.edges.partition_point(|edge| *edge <= begin);
        match self.edges.get(next_edge).filter(|edge| **edge < end) {
            None => quintic(from, to, h, (t - begin) / h),
            // each side of the edge continues from its own row
            Some(&edge) if t <= edge => taylor(from, t - begin),
            Some(_) => taylor(to, t - end),
        }
    }
}

/// Returns the pose at `part` of the straight way between two poses that are `h` (s) apart, and the rate.
fn chord(from: Pose, to: Pose, h: f64, part: f64) -> [Pose; 2] {
    let (difference, turn) = (minus(to.at, from.at), to.phi - from.phi);
    let pose = Pose { at: plus(from.at, times(part, difference)), phi: from.phi + part * turn };
    [pose, Pose { at: times(1.0 / h, difference), phi: turn / h }]
}

/// Returns the pose and its rate a time `h` (s) later, from velocity and acceleration.
fn taylor([pose, rate, acceleration]: [Pose; 3], h: f64) -> [Pose; 2] {
    let at = plus(pose.at, times(h, plus(rate.at, times(0.5 * h, acceleration.at))));
    let later = Pose { at, phi: math::predicted([pose.phi, rate.phi, acceleration.phi], h) };
    [later, Pose { at: plus(rate.at, times(h, acceleration.at)), phi: rate.phi + h * acceleration.phi }]
}

/// Returns the pose and its rate at `part` of the quintic Hermite curve between two poses that are `h` (s) apart.
fn quintic(from: [Pose; 3], to: [Pose; 3], h: f64, part: f64) -> [Pose; 2] {
    let coordinate = |of: fn(&Pose) -> f64| {
        let [from, to] = [&from, &to].map(|end| end.each_ref().map(of));
        let [value, slope, _] = math::value_and_derivatives(&math::quintic(from, to, h), part);
        [value, slope / h]
    };
    let parts = [coordinate(|pose| pose.at[0]), coordinate(|pose| pose.at[1]), coordinate(|pose| pose.phi)];
    [0, 1].map(|order| Pose { at: [parts[0][order], parts[1][order]], phi: parts[2][order] })
}

#[cfg(test)]
mod tests {
    use super::{Motion, Pose};

    /// Columns of the body's pose, rates and accelerations.
    const BODY: [[[usize; 3]; 3]; 1] = [[[1, 2, 3], [5, 6, 7], [8, 9, 10]]];

    fn names() -> Vec<String> {
        ["t", "b.x", "b.y", "b.phi", "m", "b.x.d", "b.y.d", "b.phi.d", "b.x.dd", "b.y.dd", "b.phi.dd"]
            .map(str::to_owned)
            .to_vec()
    }

    /// x = t⁵, y = t², phi = 3t.
    fn row(t: f64) -> Vec<f64> {
        let t3 = t * t * t;
        vec![t, t3 * t * t, t * t, 3.0 * t, 0.0, 5.0 * t3 * t, 2.0 * t, 3.0, 20.0 * t3, 2.0, 0.0]
    }

    #[test]
    fn between_rows_a_motion_is_the_quintic_through_both() {
        let motion = Motion::of_rows(&BODY, &names(), vec![row(0.0), row(1.0), row(3.0)], Vec::new());
        let mut poses = Vec::new();
        for t in [0.0, 0.25, 1.0, 1.7, 3.0] {
            motion.write_poses(t, &mut poses);
            let expected = row(t);
            let Pose { at: [x, y], phi } = poses[1];
            for (actual, expected) in [x, y, phi].into_iter().zip(&expected[1..4]) {
                assert!((actual - expected).abs() < 1e-9, "{actual} at {t}, not {expected}");
            }
        }
        assert_eq!(motion.column("m").map(Iterator::count), Some(3));
        assert!(motion.column("none").is_none());
    }

    #[test]
    fn nothing_is_drawn_across_an_edge() {
        // at rest until 0.5, then constant acceleration
        let late = vec![1.0, 0.125, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0];
        let motion = Motion::of_rows(&BODY, &names(), vec![vec![0.0; 11], late], vec![0.5]);
        let mut poses = Vec::new();
        for (t, x) in [(0.4, 0.0), (0.5, 0.0), (0.75, 0.03125)] {
            motion.write_poses(t, &mut poses);
            assert!((poses[1].at[0] - x).abs() < 1e-12, "{} at {t}", poses[1].at[0]);
        }
    }

    #[test]
    fn samples_hold_both_ends() {
        let motion = Motion::of_rows(&BODY, &names(), (0..10).map(|k| row(f64::from(k))).collect(), Vec::new());
        assert_eq!(motion.sampled(4).collect::<Vec<_>>(), [0, 3, 6, 9]);
        assert_eq!(motion.sampled(99).count(), 10);
        assert_eq!(motion.sampled(1).collect::<Vec<_>>(), [0]);
    }
}
