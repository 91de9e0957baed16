//! Refinement of a motion for pictures and cut lines, independent of its output times: finds rows so near to each other that the curves between
//! them deviate less from the motion than a tolerance.
//!
//! The motion is refined in windows, each no longer than all before it together. A window begins with the ends of the motion's own steps. Each
//! interval between two rows is checked at three times, and subdivided if a curve deviates there. Lines end where a formula goes to infinity,
//! jumps or has no value.
//!
//! Refinement ends with the motion; or after a window that draws nothing new, if the ends of all later steps are on the lines so far. If there are
//! too many rows before that, lines end there, and a warning reports it.

use crate::options::RunOptions;
use crate::visualization::Visualization;
use crate::{Checked, Compiled};
use mechc_draw::scene::{
    Anchor, DrawnLine, Gaps, Motion, Pen, RETRACE_TOLERANCE, Track, Vector, bounds, distance, is_finite, length,
};
use mechc_engine::analysis::{Follower, Horizon, Started, Times};
use mechc_expr::math::median;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};

/// The curves that are drawn along a motion, with the tolerance of their deviation.
#[derive(Clone, Debug)]
pub struct CurveTolerance {
    /// Points whose lines are drawn in addition to the traces of the text.
    pub pens: Vec<Pen>,
    /// Tolerance of lines (m).
    pub tolerance: f64,
    /// Columns that are plotted.
    pub columns: Vec<String>,
    /// True if bodies are shown at all times, so that the motion is refined to its end even if no line needs that.
    pub is_animated: bool,
    /// Limit of the number of rows.
    pub most_rows: usize,
}

impl CurveTolerance {
    /// Returns the tolerance of a moving picture of a visualization.
    #[must_use]
    pub fn of_picture(visualization: &Visualization, pens: Vec<Pen>) -> CurveTolerance {
        let [low, high] = visualization.scene.extent;
        let off = PICTURE_TOLERANCE * distance(low, high);
        CurveTolerance { pens, tolerance: off, columns: Vec::new(), is_animated: true, most_rows: MAX_ROWS }
    }

    /// Returns the tolerance of cut lines, where a length of 1 becomes `scale`.
    #[must_use]
    pub fn to_cut(scale: f64, pens: Vec<Pen>) -> CurveTolerance {
        let off = CUT_TOLERANCE / scale.max(1.0);
        CurveTolerance { pens, tolerance: off, columns: Vec::new(), is_animated: false, most_rows: MAX_ROWS }
    }
}

/// Tolerances: of cut lines (m of paper), and of a picture, as a fraction of its size.
const CUT_TOLERANCE: f64 = 1e-7;
const PICTURE_TOLERANCE: f64 = 1e-5;
/// Fractions of an interval that are checked: uneven, so that a periodic deviation is not missed at the same phase each time.
const CHECK_FRACTIONS: [f64; 3] = [0.23, 0.52, 0.76];
/// The motion begins with at least this many intervals.
const INTERVALS: u32 = 96;
/// Shortest interval, as a fraction of the motion.
const SHORTEST: f64 = 1e-13;
/// Limit of the rows of the first window if refinement may end early; a later one has no more rows than all before it. A step is expected to
/// take this many rows.
const FIRST_ROWS: usize = 10_000;
const ROWS_OF_A_STEP: usize = 10;
/// Limits of the rows, and of their numbers.
const MAX_ROWS: usize = 100_000;
const MAX_NUMBERS: usize = 20_000_000;
/// Output times are checked, too, if there are no more than these.
const MAX_OUTPUT_TIMES: u64 = 2000;
/// Number of states that are compared with the lines at once.
const COMPARE_BATCH: usize = 256;
/// A curve that is farther away than this many sizes of the mechanism goes to infinity.
const FAR_SIZES: f64 = 1000.0;
/// Tolerance of bodies, as a fraction of the mechanism's size.
const BODY_TOLERANCE: f64 = 2e-5;
/// Lower bounds of tolerances. Of lines: as a fraction of the mechanism's size, or of the distance from it. Of columns: as a fraction of the range
/// of most values, or of the distance from its middle.
const MIN_OF_SIZE: f64 = 2e-11;
const MIN_OF_DISTANCE: f64 = 1e-10;
const MIN_OF_RANGE: f64 = 2e-4;
const MIN_OF_VALUE: f64 = 1e-3;

/// The subject of a track.
#[derive(Clone, PartialEq, Debug)]
enum Subject {
    /// A body, in a moving picture.
    Body,
    /// The line of a pen.
    Line(Pen),
    /// A column of a plot.
    Column(String),
}

/// A curve that is drawn along the motion, with its tolerance.
struct TrackedCurve {
    subject: Subject,
    track: Track,
    /// Tolerance, and as a fraction of the distance from the middle.
    tolerances: [f64; 2],
    /// A point near the curve, and the distance from there at which the curve goes to infinity.
    reach: (Vector, f64),
}

/// State of a curve between two adjacent rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Interval {
    Unresolved,
    Resolved,
    Gap,
}

impl Checked {
    /// Refines the motion of a visualization until curves are within their tolerance, and draws its scene anew. Returns warnings of curves that end
    /// before the motion does.
    pub fn refine_motion(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        visualization: &mut Visualization,
        tolerance: &CurveTolerance,
    ) -> Diagnostics {
        let mut diagnostics = Diagnostics::default();
        if visualization.motion.rows().is_empty() {
            return diagnostics;
        }
        // each pass over the motion begins here
        let (Ok(mut started), _) = compiled.start(Horizon::of(times), options) else { return diagnostics };
        // a run reports the conditioning of its start, which restores the factors there; do the same for the same bits
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let pass_bifurcations = options.pass_bifurcations;
        let refinement = Refinement { compiled, started, pass_bifurcations, times, visualization, tolerance };
        let Some((motion, (cut_off, end))) = refinement.run() else { return diagnostics };
        for subject in &cut_off {
            diagnostics.push(visualization.early_end(subject, end, refinement.max_rows()));
        }
        visualization.motion = motion;
        if let Some(scene) = self.redrawn(visualization) {
            visualization.scene = scene;
        }
        diagnostics
    }
}

impl Visualization {
    /// Warns of a curve that ends at a time (s) before the motion does.
    fn early_end(&self, subject: &Subject, t: f64, most: usize) -> Diagnostic {
        let scene = &self.scene;
        let (what, name) = match subject {
            Subject::Body => ("the moving picture".to_owned(), None),
            Subject::Column(name) => (format!("the plot of `{name}`"), Some(name)),
            Subject::Line(pen) => {
                let trace = scene.traces.iter().find(|trace| trace.pen == *pen).map(|trace| trace.declaration);
                let is_pen = |anchor: &Anchor| *pen == Pen::Point(*anchor);
                let mut points = scene.points.iter();
                let point = points.find(|point| is_pen(&Anchor { frame: point.frame, at: point.at }));
                let named = trace.or(point.map(|point| point.declaration));
                let name = named.map(|declaration| &scene.declarations[declaration].name);
                (name.map_or_else(|| "a line".to_owned(), |name| format!("the line of `{name}`")), name)
            }
        };
        let at = readable(format!("{t:.5e}").parse().unwrap_or(t));
        let does = if *subject == Subject::Body { "is not exact" } else { "is not drawn" };
        let diagnostic = Diagnostic::new(Code::W0701, format!("{what} {does} beyond t = {at} s"))
            .note(format!("to draw more of it within its tolerance takes more than {most} positions"))
            .help(format!("draw a shorter motion, as with `--to {at}s`"))
            .datum("t", t);
        let declaration = name.and_then(|name| scene.declarations.iter().find(|declaration| declaration.name == *name));
        match declaration {
            Some(declaration) => diagnostic.at(declaration.span, "this one"),
            None => diagnostic,
        }
    }
}

struct Refinement<'s> {
    compiled: &'s Compiled,
    started: Started,
    pass_bifurcations: bool,
    times: &'s Times,
    visualization: &'s Visualization,
    tolerance: &'s CurveTolerance,
}

/// The ends of the motion's steps, read ahead of the refinement.
struct StepEnds {
    steps: Follower,
    /// Times (s) after the refined part.
    upcoming: Vec<f64>,
    /// Number of ends within the refined part.
    passed: usize,
    /// True if all steps are read.
    is_complete: bool,
}

impl StepEnds {
    /// Reads at least as many steps ahead as have passed, so that the total work of all passes is a small multiple of the motion.
    fn look_ahead(&mut self, least: usize) {
        while !self.is_complete && self.upcoming.len() < self.passed.max(least) {
            match self.steps.next_segment() {
                Ok(Some(stretch)) => self.upcoming.push(stretch.to.t),
                _ => self.is_complete = true,
            }
        }
    }

    /// Drops the ends up to a time (s).
    fn pass(&mut self, t: f64) {
        let passed = self.upcoming.partition_point(|end| *end <= t);
        self.upcoming.drain(..passed);
        self.passed += passed;
    }
}

/// The refined part of a motion.
struct Refined {
    motion: Motion,
    curves: Vec<TrackedCurve>,
    /// For each curve: for each row but the last, whether a gap follows.
    gaps: Vec<Vec<bool>>,
}

impl Refinement<'_> {
    /// Refines the motion; returns the curves that end before it does, and the time of that (s).
    fn run(&self) -> Option<(Motion, (Vec<Subject>, f64))> {
        let mut steps = StepEnds { steps: self.steps(), upcoming: Vec::new(), passed: 0, is_complete: false };
        let mut refined: Option<Refined> = None;
        let first_rows = if self.may_end_early() { FIRST_ROWS } else { self.max_rows() };
        let is_complete = loop {
            let before_window = refined.as_ref().map(|refined| &refined.motion);
            let before = before_window.and_then(|motion| motion.times.last().copied());
            steps.look_ahead(first_rows / ROWS_OF_A_STEP);
            let mut window = self.at(self.times_of_window(&steps, before));
            window.set_total_duration(self.span());
            let Some(&end) = window.times.last() else { break true };
            let mut curves = self.curves(&window, [&window, &self.rows_behind(end)]);
            for (curve, before) in curves.iter_mut().zip(refined.iter().flat_map(|refined| &refined.curves)) {
                // all windows agree on what is far away, and a window at rest does not tighten the tolerance
                curve.reach = before.reach;
                curve.tolerances[0] = curve.tolerances[0].max(before.tolerances[0]);
            }
            let rows = before_window.map_or(0, Motion::len);
            let left = self.max_rows().saturating_sub(rows);
            let max_rows = left.min(rows.max(first_rows));
            let (window, intervals) = self.resolved(window, &curves, max_rows);
            let reached = window.times.last().copied()?;
            let is_whole = steps.is_complete && reached >= end;
            let is_full = reached < end && max_rows == left;
            let is_repeated = !is_whole && !is_full && self.draws_nothing_new(refined.as_ref(), &window);
            refined = Some(Refined::joined(refined, window, curves, &intervals));
            if is_whole || is_full || is_repeated {
                break !is_full;
            }
            steps.pass(reached);
        };
        let refined = refined?;
        let end = refined.motion.times.last().copied()?;
        let cut_off = if is_complete { Vec::new() } else { self.cut_off(&refined, end) };
        Some((refined.into_motion(&self.rows_behind(end), self.tolerance.tolerance), (cut_off, end)))
    }

    /// Returns whether only lines are drawn, which may repeat themselves.
    fn may_end_early(&self) -> bool {
        !self.tolerance.is_animated && self.tolerance.columns.is_empty()
    }

    /// Returns the limit of the number of rows.
    fn max_rows(&self) -> usize {
        self.tolerance.most_rows.min(MAX_NUMBERS / self.visualization.columns.len().max(1))
    }

    /// Returns the duration from the first to the last time (s).
    fn span(&self) -> f64 {
        self.times.last() - self.times.from()
    }

    /// Returns the motion from its start, with a row for each of some times.
    fn motion(&self, times: &Times) -> Follower {
        let mut motion = self.started.clone().into_motion(times);
        if self.pass_bifurcations {
            motion.pass_bifurcations();
        }
        motion
    }

    /// Returns the motion from its start, for its steps.
    fn steps(&self) -> Follower {
        let last = Times::listed(self.times.from(), vec![self.times.last()]);
        self.motion(&last.within_analysis_to(Some(self.times.end())))
    }

    /// Returns the first times of the next window, from the end of the one before it on: the ends of steps, even times, and the output times; towards
    /// a stop of the motion at decreasing intervals.
    fn times_of_window(&self, steps: &StepEnds, before: Option<f64>) -> Vec<f64> {
        let (first, last, is_last) = (self.times.from(), self.times.last(), steps.is_complete);
        let from = before.unwrap_or(first);
        let mut times: Vec<f64> = before.iter().chain(&steps.upcoming).copied().collect();
        let has_stopped = is_last && self.visualization.stopped.is_some();
        let reached = times.iter().copied().fold(from, f64::max);
        let to = if is_last && !has_stopped { last } else { reached };
        // if the motion stops in the first window, the even times span the part before the stop
        let end = if has_stopped && before.is_none() { to } else { last };
        let even = (0..=INTERVALS).map(|k| first + (end - first) * f64::from(k) / f64::from(INTERVALS));
        times.extend(even.filter(|t| (from..=to).contains(t)));
        if self.times.len() <= MAX_OUTPUT_TIMES {
            times.extend(self.times.iter().filter(|t| (from..=to).contains(t)));
        }
        if has_stopped && to < last {
            let mut left = to - times.iter().copied().filter(|t| *t < to).fold(first, f64::max);
            while left > SHORTEST * self.span() {
                left *= 0.25;
                times.push(to - left);
            }
        }
        times
    }

    /// Returns the motion at some times, as far as it gets.
    fn at(&self, mut times: Vec<f64>) -> Motion {
        times.sort_by(f64::total_cmp);
        times.dedup();
        let count = times.len();
        times.push(self.times.last());
        let listed = Times::listed(self.times.from(), times).within_analysis_to(Some(self.times.end()));
        let (mut motion, mut rows) = (self.motion(&listed), Vec::new());
        while rows.len() < count
            && let Some(Ok(row)) = motion.next_row()
        {
            rows.push(row.to_vec());
        }
        self.motion_of(rows)
    }

    fn motion_of(&self, rows: Vec<Vec<f64>>) -> Motion {
        let edges = self.visualization.motion.edges.clone();
        Motion::of_rows(&self.compiled.columns_of_poses(), &self.visualization.columns, rows, edges)
    }

    /// Returns the rows of the visualization after a time (s).
    fn rows_behind(&self, t: f64) -> Motion {
        let visualization = &self.visualization.motion;
        let first = visualization.times.partition_point(|time| *time <= t);
        visualization.moments(&(first..visualization.len()).collect::<Vec<usize>>())
    }

    /// Returns the curves that are drawn: bodies, all pens and columns; with tolerances that follow from the rows of some motions.
    fn curves(&self, window: &Motion, motions: [&Motion; 2]) -> Vec<TrackedCurve> {
        let scene = &self.visualization.scene;
        let [low, high] = scene.extent;
        let size = distance(low, high);
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        let points = |track: &Track| -> Vec<Vector> {
            let rows = motions.iter().flat_map(|motion| (0..motion.len()).map(|row| track.in_row(motion, row)));
            rows.filter(|point| is_finite(*point)).collect()
        };
        let bodies = (1..window.frames()).flat_map(|frame| {
            [[0.0; 2], [size, 0.0]].map(|at| TrackedCurve {
                subject: Subject::Body,
                track: window.track(&Pen::Point(Anchor { frame, at })),
                tolerances: [BODY_TOLERANCE * size, 0.0],
                reach: (middle, f64::INFINITY),
            })
        });
        let pen_curve = |pen: &Pen| {
            let track = window.track(pen);
            let points = points(&track);
            let (far, extent) = match pen {
                Pen::Point(_) => (f64::INFINITY, bounds(points).map_or(0.0, |[low, high]| distance(low, high))),
                Pen::Columns { .. } => {
                    let near = median(points.iter().map(|point| distance(*point, middle)).collect());
                    (FAR_SIZES * near.max(size), near.min(size))
                }
            };
            let tolerance =
                self.tolerance.tolerance.min(PICTURE_TOLERANCE * extent).max(MIN_OF_SIZE * extent.max(size));
            TrackedCurve {
                subject: Subject::Line(pen.clone()),
                track,
                tolerances: [tolerance, MIN_OF_DISTANCE],
                reach: (middle, far),
            }
        };
        let column_curve = |name: &String| {
            let track = window.column_track(name);
            let mut values: Vec<f64> = points(&track).into_iter().map(|[value, _]| value).collect();
            values.sort_by(f64::total_cmp);
            let at = |part: usize| values.get(part * values.len().saturating_sub(1) / 10).copied().unwrap_or(0.0);
            // a column that goes to infinity has a range, too
            let range = if at(9) > at(1) { at(9) - at(1) } else { at(10) - at(0) };
            let (tolerances, reach) = ([MIN_OF_RANGE * range, MIN_OF_VALUE], ([at(5), 0.0], f64::INFINITY));
            TrackedCurve { subject: Subject::Column(name.clone()), track, tolerances, reach }
        };
        let pens = scene.traces.iter().map(|trace| &trace.pen).chain(&self.tolerance.pens).map(pen_curve);
        bodies.chain(pens).chain(self.tolerance.columns.iter().map(column_curve)).collect()
    }

    /// Adds the rows to a window that its curves need; returns the states of its intervals. Cuts its end off if there are too many rows.
    fn resolved(&self, mut window: Motion, curves: &[TrackedCurve], max_rows: usize) -> (Motion, Vec<Vec<Interval>>) {
        let least = SHORTEST * self.span();
        let mut intervals = vec![vec![Interval::Unresolved; curves.len()]; window.len().saturating_sub(1)];
        loop {
            let checked_rows: Vec<f64> = window
                .times
                .windows(2)
                .zip(&intervals)
                .filter(|(_, interval)| interval.contains(&Interval::Unresolved))
                .flat_map(|(ends, _)| CHECK_FRACTIONS.map(|part| ends[0] + part * (ends[1] - ends[0])))
                .collect();
            if checked_rows.is_empty() {
                return (window, intervals);
            }
            if window.len() + checked_rows.len() > max_rows {
                intervals.truncate(intervals.len() / 2);
                window.truncate(intervals.len() + 1);
                continue;
            }
            let between = self.at(checked_rows);
            (window, intervals) = subdivide(&window, &intervals, &between, curves, least);
        }
    }

    /// Returns whether a window, and all after it, only draws what is refined already.
    fn draws_nothing_new(&self, refined: Option<&Refined>, window: &Motion) -> bool {
        let Some(refined) = refined else { return false };
        if !self.may_end_early() {
            return false;
        }
        let is_line = |number: &usize| matches!(refined.curves[*number].subject, Subject::Line(_));
        let numbers = (0..refined.curves.len()).filter(is_line);
        let lines: Vec<(&TrackedCurve, DrawnLine)> = numbers.map(|number| refined.line(number)).collect();
        let are_on = |(curve, line): &(&TrackedCurve, DrawnLine)| {
            (0..window.len()).all(|row| curve.passes_line(line, window, row))
        };
        lines.iter().all(are_on) && window.times.last().is_some_and(|t| self.stays_on(&lines, *t))
    }

    /// Returns whether curves are on lines at the ends of all steps after a time (s).
    fn stays_on(&self, lines: &[(&TrackedCurve, DrawnLine)], from: f64) -> bool {
        let (mut steps, mut started) = (self.steps(), self.started.clone());
        let mut is_last = lines.is_empty();
        while !is_last {
            let mut rows = Vec::new();
            while !is_last && rows.len() < COMPARE_BATCH {
                match steps.next_segment() {
                    Ok(Some(stretch)) if stretch.to.t > from => {
                        rows.extend(stretch.middle.iter().chain([&stretch.to]).map(|state| started.row_of(state)));
                    }
                    Ok(Some(_)) => {}
                    _ => is_last = true,
                }
            }
            let motion = self.motion_of(rows);
            let stays_on = |row: usize| lines.iter().all(|(curve, line)| curve.passes_line(line, &motion, row));
            if !(0..motion.len()).all(stays_on) {
                return false;
            }
        }
        true
    }

    /// Returns the curves that end with the refined part (s), although they go on; of bodies only the first.
    fn cut_off(&self, refined: &Refined, end: f64) -> Vec<Subject> {
        let is_cut = |number: &usize| match refined.curves[*number].subject {
            Subject::Body => self.tolerance.is_animated,
            Subject::Column(_) => true,
            Subject::Line(_) => !self.stays_on(&[refined.line(*number)], end),
        };
        let mut cut_off: Vec<Subject> =
            (0..refined.curves.len()).filter(is_cut).map(|number| refined.curves[number].subject.clone()).collect();
        cut_off.dedup();
        cut_off
    }
}

impl Refined {
    /// Appends a window, which begins with the last row before it.
    fn joined(
        before: Option<Refined>,
        window: Motion,
        curves: Vec<TrackedCurve>,
        intervals: &[Vec<Interval>],
    ) -> Refined {
        let (motion, mut gaps) = match before {
            Some(Refined { motion, gaps, .. }) => {
                (motion.merged(&window.moments(&(1..window.len()).collect::<Vec<usize>>())), gaps)
            }
            None => (window, vec![Vec::new(); curves.len()]),
        };
        for (number, gaps) in gaps.iter_mut().enumerate() {
            gaps.extend(intervals.iter().map(|interval| interval[number] == Interval::Gap));
        }
        Refined { motion, curves, gaps }
    }

    /// Returns a curve, and the line that it has drawn.
    fn line(&self, number: usize) -> (&TrackedCurve, DrawnLine<'_>) {
        let (curve, motion) = (&self.curves[number], &self.motion);
        let is_there = |row: &usize| {
            !self.gaps[number][*row] && [*row, row + 1].iter().all(|row| is_finite(curve.track.in_row(motion, *row)))
        };
        let rows = (0..self.gaps[number].len()).filter(is_there);
        let pieces = rows.map(|row| [motion.times[row], motion.times[row + 1]]).collect();
        (curve, DrawnLine::new(motion, curve.track.clone(), pieces))
    }

    /// Returns the motion with more rows after it, where no curve is drawn.
    fn into_motion(self, rest: &Motion, off: f64) -> Motion {
        let mut motion = self.motion.merged(rest);
        for (curve, mut behind) in self.curves.into_iter().zip(self.gaps) {
            behind.extend((0..rest.len()).map(|_| true));
            if curve.subject != Subject::Body {
                motion.set_gaps(curve.track, Gaps { behind, reach: curve.reach });
            }
        }
        motion.off = off;
        motion
    }
}

/// Subdivides the unresolved intervals of a motion at the times that were checked, unless all curves deviate little enough there.
fn subdivide(
    motion: &Motion,
    intervals: &[Vec<Interval>],
    between: &Motion,
    curves: &[TrackedCurve],
    least: f64,
) -> (Motion, Vec<Vec<Interval>>) {
    let (mut kept, mut states) = (Vec::new(), Vec::new());
    let mut next = 0;
    for (row, (ends, before)) in motion.times.windows(2).zip(intervals).enumerate() {
        let first = next;
        while between.times.get(next).is_some_and(|t| *t < ends[1]) {
            next += 1;
        }
        let checked_rows = first..next;
        if checked_rows.is_empty() {
            // without rows between its ends, as after a stop, an interval cannot be improved
            let settle = |state: &Interval| if *state == Interval::Unresolved { Interval::Resolved } else { *state };
            states.push(before.iter().map(settle).collect());
            continue;
        }
        let is_short = ends[1] - ends[0] <= least;
        let state_of = curves.iter().zip(before).map(|(curve, before)| match before {
            Interval::Unresolved => curve.state(motion, row, between, checked_rows.clone(), is_short),
            settled => *settled,
        });
        let judged: Vec<Interval> = state_of.collect();
        if judged.contains(&Interval::Unresolved) {
            kept.extend(checked_rows.clone());
            states.extend(std::iter::repeat_n(judged, checked_rows.len() + 1));
        } else {
            states.push(judged);
        }
    }
    (motion.merged(&between.moments(&kept)), states)
}

impl TrackedCurve {
    /// Returns the tolerance at a point.
    fn tolerance_at(&self, point: Vector) -> f64 {
        let [absolute, relative] = self.tolerances;
        absolute.max(relative * distance(point, self.reach.0))
    }

    /// Returns whether the curve goes to infinity at a point.
    fn is_far(&self, point: Vector) -> bool {
        distance(point, self.reach.0) > self.reach.1
    }

    /// Returns whether the curve is on a line in a row, or is not drawn there.
    fn passes_line(&self, line: &DrawnLine, motion: &Motion, row: usize) -> bool {
        let point = self.track.in_row(motion, row);
        !is_finite(point) || self.is_far(point) || line.passes(point, RETRACE_TOLERANCE * self.tolerance_at(point))
    }

    /// Returns the state of the interval after a row, given rows between its ends.
    fn state(
        &self,
        motion: &Motion,
        row: usize,
        between: &Motion,
        checked_rows: std::ops::Range<usize>,
        is_short: bool,
    ) -> Interval {
        let ends = [row, row + 1].map(|row| self.track.in_row(motion, row));
        let points: Vec<(f64, Vector)> =
            checked_rows.map(|row| (between.times[row], self.track.in_row(between, row))).collect();
        // a point that is not finite is not near, either
        let is_near = |point: &Vector| distance(*point, self.reach.0) <= self.reach.1;
        if !ends.iter().chain(points.iter().map(|(_, point)| point)).any(is_near) {
            return Interval::Gap;
        }
        let holds = |(t, point): &(f64, Vector)| {
            let drawn = self.track.between(motion, row, *t)[0];
            distance(drawn, *point) <= self.tolerance_at(*point)
        };
        if ends.iter().copied().all(is_finite) && points.iter().all(holds) {
            return Interval::Resolved;
        }
        let [from, to] = [motion.times[row], motion.times[row + 1]];
        // the curve has practically reached the end of its domain
        let is_at_end = ends.iter().any(|end| !is_finite(*end)) && {
            let near = if is_finite(ends[0]) { (row, from) } else { (row + 1, to) };
            let gap = length(self.track.between(motion, near.0.min(row), near.1)[1]) * (to - from);
            gap <= self.tolerances[0] && !points.iter().any(|(_, point)| is_finite(*point))
        };
        match (is_short, is_at_end) {
            (false, false) => Interval::Unresolved,
            (true, false) if distance(ends[0], ends[1]) <= 4.0 * self.tolerance_at(ends[0]) => Interval::Resolved,
            _ => Interval::Gap,
        }
    }
}
