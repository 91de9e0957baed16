//! Refines a motion for pictures and cut lines, whatever its output times are: finds rows so near to each other that the curves between them
//! are those of the mechanism.
//!
//! The motion is taken in windows, each no longer than all before it together. The rows of a window are at first the ends of the motion's own steps. Each
//! interval between two rows is looked at in three places; where a curve is off there, it is subdivided. So nothing is drawn that was not
//! looked at, and lines end where a formula goes to infinity, jumps or has no value.
//!
//! The refinement ends with the motion; or behind a window in which nothing was drawn anew, if all ends of the steps behind it lie on the
//! lines so far. Where there are too many rows before that, lines end there, and a warning says so.

use crate::options::RunOptions;
use crate::visualization::Seen;
use crate::{Checked, Compiled};
use mechc_draw::scene::{
    Anchor, DrawnLine, Gaps, Motion, Pen, RETRACE_TOLERANCE, Track, Vector, bounds, distance, is_finite, length,
};
use mechc_engine::analysis::{Follower, Horizon, Started, Times};
use mechc_expr::math::median;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};

/// Which curves are drawn along a motion, and what they may be off.
#[derive(Clone, Debug)]
pub struct CurveTolerance {
    /// Points whose lines are drawn beside the traces of the text.
    pub pens: Vec<Pen>,
    /// What lines may be off (m).
    pub off: f64,
    /// Columns that are plotted.
    pub columns: Vec<String>,
    /// Whether bodies are shown at all times, so that the motion has to be refined to its end although no line needs that.
    pub is_animated: bool,
    /// The motion has no more rows than these.
    pub most_rows: usize,
}

impl CurveTolerance {
    /// Returns the tolerance of a moving picture of what was seen.
    #[must_use]
    pub fn of_picture(seen: &Seen, pens: Vec<Pen>) -> CurveTolerance {
        let [low, high] = seen.scene.extent;
        let off = OFF_OF_PICTURE * distance(low, high);
        CurveTolerance { pens, off, columns: Vec::new(), is_animated: true, most_rows: MOST_ROWS }
    }

    /// Returns the tolerance of what is cut, where a length of 1 becomes `scale`.
    #[must_use]
    pub fn to_cut(scale: f64, pens: Vec<Pen>) -> CurveTolerance {
        let off = OFF_TO_CUT / scale.max(1.0);
        CurveTolerance { pens, off, columns: Vec::new(), is_animated: false, most_rows: MOST_ROWS }
    }
}

/// How far what is drawn may be off the motion: what is cut (m of paper), and a picture, as a part of its size.
const OFF_TO_CUT: f64 = 1e-7;
const OFF_OF_PICTURE: f64 = 1e-5;
/// Where an interval is looked at, as parts of it: not evenly, so that what repeats itself is not met in one place again and again.
const LOOKED_AT: [f64; 3] = [0.23, 0.52, 0.76];
/// The motion begins with so many intervals at least.
const INTERVALS: u32 = 96;
/// Intervals are no shorter than this part of the motion.
const SHORTEST: f64 = 1e-13;
/// The first window of what may end early has no more rows than these; those behind it have no more than all before them. A step is expected
/// to take so many rows.
const FIRST_ROWS: usize = 10_000;
const ROWS_OF_A_STEP: usize = 10;
/// So many rows are kept, with so many numbers at most.
const MOST_ROWS: usize = 100_000;
const MOST_NUMBERS: usize = 20_000_000;
/// Output times that are looked at, too.
const MOST_OUTPUT_TIMES: u64 = 2000;
/// So many states are compared with the lines at once.
const COMPARED_AT_ONCE: usize = 256;
/// What is farther away than so many sizes of the mechanism is on its way to infinity.
const FAR: f64 = 1000.0;
/// Bodies may be off by this part of the mechanism's size.
const BODIES: f64 = 2e-5;
/// Lines need not be better than this part of the mechanism's size, or of how far away they are; columns than this part of the range that
/// they are mostly in, or of how far they are from the middle of it.
const OF_SIZE: f64 = 2e-11;
const OF_PLACE: f64 = 1e-10;
const OF_RANGE: f64 = 2e-4;
const OF_VALUE: f64 = 1e-3;

/// What is drawn by a track.
#[derive(Clone, PartialEq, Debug)]
enum Subject {
    /// A body, in a moving picture.
    Body,
    /// The line of a pen.
    Line(Pen),
    /// A column of a plot.
    Column(String),
}

/// A curve that is drawn along the motion, with what it may be off.
struct TrackedCurve {
    subject: Subject,
    track: Track,
    /// What it may be off, and as a part of how far it is from the middle.
    off: [f64; 2],
    /// A place that it is near, and how far from there it is on its way to infinity.
    reach: (Vector, f64),
}

/// What is known of a curve between two neighbouring rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Interval {
    Unresolved,
    Resolved,
    Gap,
}

impl Checked {
    /// Refines a motion that was seen, from its first time to its last one or to where it stops, until curves are within their tolerance;
    /// and draws its scene anew. Returns what there is to say of curves that end before the motion does.
    pub fn refine_motion(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        seen: &mut Seen,
        tolerance: &CurveTolerance,
    ) -> Diagnostics {
        let mut said = Diagnostics::default();
        if seen.motion.rows().is_empty() {
            return said;
        }
        // each pass over the motion begins where this one does
        let (Ok(mut started), _) = compiled.start(Horizon::of(times), options) else { return said };
        // what a run tells of its start looks at the same factors
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let pass_bifurcations = options.pass_bifurcations;
        let refinement = Refinement { compiled, started, pass_bifurcations, times, seen, tolerance };
        let Some((motion, (cut, end))) = refinement.run() else { return said };
        for subject in &cut {
            said.push(seen.ends_early(subject, end, refinement.room()));
        }
        seen.motion = motion;
        if let Some(scene) = self.drawn_anew(seen) {
            seen.scene = scene;
        }
        said
    }
}

impl Seen {
    /// A curve that ends at a time (s) before the motion does.
    fn ends_early(&self, subject: &Subject, t: f64, most: usize) -> Diagnostic {
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
        let declaration = name.and_then(|name| scene.declarations.iter().find(|known| known.name == *name));
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
    seen: &'s Seen,
    tolerance: &'s CurveTolerance,
}

/// The ends of the motion's steps, as far as they are looked at.
struct StepEnds {
    steps: Follower,
    /// Those behind what is refined (s).
    ahead: Vec<f64>,
    /// How many are not.
    passed: usize,
    /// Whether there are no more.
    are_all: bool,
}

impl StepEnds {
    /// Looks so many steps ahead, or as many as there have been, so that all passes over the motion together are no longer than a few times that.
    fn look_ahead(&mut self, least: usize) {
        while !self.are_all && self.ahead.len() < self.passed.max(least) {
            match self.steps.next_stretch() {
                Ok(Some(stretch)) => self.ahead.push(stretch.to.t),
                _ => self.are_all = true,
            }
        }
    }

    /// Leaves those behind that are no later than a time (s).
    fn pass(&mut self, t: f64) {
        let passed = self.ahead.partition_point(|end| *end <= t);
        self.ahead.drain(..passed);
        self.passed += passed;
    }
}

/// The part of a motion that is refined.
struct Refined {
    motion: Motion,
    curves: Vec<TrackedCurve>,
    /// For each curve: for each row but the last, whether it has a gap behind that.
    gaps: Vec<Vec<bool>>,
}

impl Refinement<'_> {
    /// Refines the motion; with the curves that end before it does, and when they end (s).
    fn run(&self) -> Option<(Motion, (Vec<Subject>, f64))> {
        let mut steps = StepEnds { steps: self.steps(), ahead: Vec::new(), passed: 0, are_all: false };
        let mut refined: Option<Refined> = None;
        let first_rows = if self.may_end_early() { FIRST_ROWS } else { self.room() };
        let is_complete = loop {
            let known = refined.as_ref().map(|refined| &refined.motion);
            let before = known.and_then(|known| known.times.last().copied());
            steps.look_ahead(first_rows / ROWS_OF_A_STEP);
            let mut window = self.at(self.times_of_window(&steps, before));
            window.set_whole_span(self.span());
            let Some(&end) = window.times.last() else { break true };
            let mut curves = self.curves(&window, [&window, &self.rows_behind(end)]);
            for (curve, known) in curves.iter_mut().zip(refined.iter().flat_map(|refined| &refined.curves)) {
                // no window says otherwise what is far away, and none that is at rest asks for more
                curve.reach = known.reach;
                curve.off[0] = curve.off[0].max(known.off[0]);
            }
            let rows = known.map_or(0, Motion::len);
            let left = self.room().saturating_sub(rows);
            let room = left.min(rows.max(first_rows));
            let (window, intervals) = self.resolved(window, &curves, room);
            let reached = window.times.last().copied()?;
            let is_whole = steps.are_all && reached >= end;
            let is_full = reached < end && room == left;
            let is_repeated = !is_whole && !is_full && self.draws_nothing_anew(refined.as_ref(), &window);
            refined = Some(Refined::joined(refined, window, curves, &intervals));
            if is_whole || is_full || is_repeated {
                break !is_full;
            }
            steps.pass(reached);
        };
        let refined = refined?;
        let end = refined.motion.times.last().copied()?;
        let cut = if is_complete { Vec::new() } else { self.cut(&refined, end) };
        Some((refined.into_motion(&self.rows_behind(end), self.tolerance.off), (cut, end)))
    }

    /// Whether lines alone are drawn, which may repeat themselves.
    fn may_end_early(&self) -> bool {
        !self.tolerance.is_animated && self.tolerance.columns.is_empty()
    }

    /// The most rows that a refined motion has.
    fn room(&self) -> usize {
        self.tolerance.most_rows.min(MOST_NUMBERS / self.seen.columns.len().max(1))
    }

    /// From the first time to the last one (s).
    fn span(&self) -> f64 {
        self.times.last() - self.times.from()
    }

    /// The motion from its start, a row for each of some times.
    fn motion(&self, times: &Times) -> Follower {
        let mut motion = self.started.clone().into_motion(times);
        if self.pass_bifurcations {
            motion.pass_bifurcations();
        }
        motion
    }

    /// The motion from its start, for its steps.
    fn steps(&self) -> Follower {
        let last = Times::listed(self.times.from(), vec![self.times.last()]);
        self.motion(&last.within_analysis_to(Some(self.times.end())))
    }

    /// The first times of the next window, the end of the one before it among them: the ends of steps, more where these are few, and the
    /// output times; towards where the motion stops closer and closer.
    fn times_of_window(&self, steps: &StepEnds, before: Option<f64>) -> Vec<f64> {
        let (first, last, is_last) = (self.times.from(), self.times.last(), steps.are_all);
        let from = before.unwrap_or(first);
        let mut times: Vec<f64> = before.iter().chain(&steps.ahead).copied().collect();
        let has_stopped = is_last && self.seen.stopped.is_some();
        let reached = times.iter().copied().fold(from, f64::max);
        let to = if is_last && !has_stopped { last } else { reached };
        // of a motion that stops in this window the intervals are those up to there
        let end = if has_stopped && before.is_none() { to } else { last };
        let even = (0..=INTERVALS).map(|k| first + (end - first) * f64::from(k) / f64::from(INTERVALS));
        times.extend(even.filter(|t| (from..=to).contains(t)));
        if self.times.len() <= MOST_OUTPUT_TIMES {
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

    /// The motion at some times, as far as it gets there.
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
        let edges = self.seen.motion.edges.clone();
        Motion::of_rows(&self.compiled.columns_of_poses(), &self.seen.columns, rows, edges)
    }

    /// What was seen of the motion behind a time (s).
    fn rows_behind(&self, t: f64) -> Motion {
        let seen = &self.seen.motion;
        let first = seen.times.partition_point(|known| *known <= t);
        seen.moments(&(first..seen.len()).collect::<Vec<usize>>())
    }

    /// The curves that are drawn: bodies, all pens and columns; with what they may be off, by the rows of some motions.
    fn curves(&self, window: &Motion, known: [&Motion; 2]) -> Vec<TrackedCurve> {
        let scene = &self.seen.scene;
        let [low, high] = scene.extent;
        let size = distance(low, high);
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        let places = |track: &Track| -> Vec<Vector> {
            let rows = known.iter().flat_map(|motion| (0..motion.len()).map(|row| track.in_row(motion, row)));
            rows.filter(|place| is_finite(*place)).collect()
        };
        let bodies = (1..window.frames()).flat_map(|frame| {
            [[0.0; 2], [size, 0.0]].map(|at| TrackedCurve {
                subject: Subject::Body,
                track: window.track(&Pen::Point(Anchor { frame, at })),
                off: [BODIES * size, 0.0],
                reach: (middle, f64::INFINITY),
            })
        });
        let of_pen = |pen: &Pen| {
            let track = window.track(pen);
            let places = places(&track);
            let (far, own) = match pen {
                Pen::Point(_) => (f64::INFINITY, bounds(places).map_or(0.0, |[low, high]| distance(low, high))),
                Pen::Columns { .. } => {
                    let near = median(places.iter().map(|place| distance(*place, middle)).collect());
                    (FAR * near.max(size), near.min(size))
                }
            };
            let off = self.tolerance.off.min(OFF_OF_PICTURE * own).max(OF_SIZE * own.max(size));
            TrackedCurve { subject: Subject::Line(pen.clone()), track, off: [off, OF_PLACE], reach: (middle, far) }
        };
        let of_column = |name: &String| {
            let track = window.track_of_column(name);
            let mut values: Vec<f64> = places(&track).into_iter().map(|[value, _]| value).collect();
            values.sort_by(f64::total_cmp);
            let at = |part: usize| values.get(part * values.len().saturating_sub(1) / 10).copied().unwrap_or(0.0);
            // what runs to infinity has a range, too
            let range = if at(9) > at(1) { at(9) - at(1) } else { at(10) - at(0) };
            let (off, reach) = ([OF_RANGE * range, OF_VALUE], ([at(5), 0.0], f64::INFINITY));
            TrackedCurve { subject: Subject::Column(name.clone()), track, off, reach }
        };
        let pens = scene.traces.iter().map(|trace| &trace.pen).chain(&self.tolerance.pens).map(of_pen);
        bodies.chain(pens).chain(self.tolerance.columns.iter().map(of_column)).collect()
    }

    /// A window with the rows that its curves need, and what is known of its intervals; without its end where there are too many.
    fn resolved(&self, mut window: Motion, curves: &[TrackedCurve], room: usize) -> (Motion, Vec<Vec<Interval>>) {
        let least = SHORTEST * self.span();
        let mut intervals = vec![vec![Interval::Unresolved; curves.len()]; window.len().saturating_sub(1)];
        loop {
            let looked_at: Vec<f64> = window
                .times
                .windows(2)
                .zip(&intervals)
                .filter(|(_, interval)| interval.contains(&Interval::Unresolved))
                .flat_map(|(ends, _)| LOOKED_AT.map(|part| ends[0] + part * (ends[1] - ends[0])))
                .collect();
            if looked_at.is_empty() {
                return (window, intervals);
            }
            if window.len() + looked_at.len() > room {
                intervals.truncate(intervals.len() / 2);
                window.truncate(intervals.len() + 1);
                continue;
            }
            let between = self.at(looked_at);
            (window, intervals) = subdivide(&window, &intervals, &between, curves, least);
        }
    }

    /// Whether a window draws nothing but what is refined already, and all that comes behind it likewise.
    fn draws_nothing_anew(&self, refined: Option<&Refined>, window: &Motion) -> bool {
        let Some(refined) = refined else { return false };
        if !self.may_end_early() {
            return false;
        }
        let is_line = |number: &usize| matches!(refined.curves[*number].subject, Subject::Line(_));
        let numbers = (0..refined.curves.len()).filter(is_line);
        let lines: Vec<(&TrackedCurve, DrawnLine)> = numbers.map(|number| refined.line(number)).collect();
        let are_on =
            |(curve, line): &(&TrackedCurve, DrawnLine)| (0..window.len()).all(|row| curve.is_on(line, window, row));
        lines.iter().all(are_on) && window.times.last().is_some_and(|t| self.keeps_to(&lines, *t))
    }

    /// Whether curves keep to lines that were drawn, at all ends of the steps behind a time (s).
    fn keeps_to(&self, lines: &[(&TrackedCurve, DrawnLine)], from: f64) -> bool {
        let (mut steps, mut started) = (self.steps(), self.started.clone());
        let mut is_last = lines.is_empty();
        while !is_last {
            let mut rows = Vec::new();
            while !is_last && rows.len() < COMPARED_AT_ONCE {
                match steps.next_stretch() {
                    Ok(Some(stretch)) if stretch.to.t > from => {
                        rows.extend(stretch.middle.iter().chain([&stretch.to]).map(|state| started.row_of(state)));
                    }
                    Ok(Some(_)) => {}
                    _ => is_last = true,
                }
            }
            let motion = self.motion_of(rows);
            let keeps_to = |row: usize| lines.iter().all(|(curve, line)| curve.is_on(line, &motion, row));
            if !(0..motion.len()).all(keeps_to) {
                return false;
            }
        }
        true
    }

    /// What ends where the motion is refined to (s), although more of it is to be drawn; of bodies the first one.
    fn cut(&self, refined: &Refined, end: f64) -> Vec<Subject> {
        let is_cut = |number: &usize| match refined.curves[*number].subject {
            Subject::Body => self.tolerance.is_animated,
            Subject::Column(_) => true,
            Subject::Line(_) => !self.keeps_to(&[refined.line(*number)], end),
        };
        let mut cut: Vec<Subject> =
            (0..refined.curves.len()).filter(is_cut).map(|number| refined.curves[number].subject.clone()).collect();
        cut.dedup();
        cut
    }
}

impl Refined {
    /// What is refined, with the next window, which begins with the last row before it.
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

    /// A curve, and the line that it has drawn.
    fn line(&self, number: usize) -> (&TrackedCurve, DrawnLine<'_>) {
        let (curve, motion) = (&self.curves[number], &self.motion);
        let is_there = |row: &usize| {
            !self.gaps[number][*row] && [*row, row + 1].iter().all(|row| is_finite(curve.track.in_row(motion, *row)))
        };
        let rows = (0..self.gaps[number].len()).filter(is_there);
        let pieces = rows.map(|row| [motion.times[row], motion.times[row + 1]]).collect();
        (curve, DrawnLine::new(motion, curve.track.clone(), pieces))
    }

    /// The motion with rows behind it, where no curve is drawn.
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

/// Subdivides the intervals of a motion that are not resolved, after a look between their ends. What is drawn well there stays as it is.
fn subdivide(
    motion: &Motion,
    intervals: &[Vec<Interval>],
    between: &Motion,
    curves: &[TrackedCurve],
    least: f64,
) -> (Motion, Vec<Vec<Interval>>) {
    let (mut kept, mut found) = (Vec::new(), Vec::new());
    let mut next = 0;
    for (row, (ends, before)) in motion.times.windows(2).zip(intervals).enumerate() {
        let first = next;
        while between.times.get(next).is_some_and(|t| *t < ends[1]) {
            next += 1;
        }
        let looked_at = first..next;
        if looked_at.is_empty() {
            // where the motion does not get to, nothing more is to be learnt
            let settle = |known: &Interval| if *known == Interval::Unresolved { Interval::Resolved } else { *known };
            found.push(before.iter().map(settle).collect());
            continue;
        }
        let is_short = ends[1] - ends[0] <= least;
        let judged = curves.iter().zip(before).map(|(curve, before)| match before {
            Interval::Unresolved => curve.judged((motion, row), (between, looked_at.clone()), is_short),
            settled => *settled,
        });
        let judged: Vec<Interval> = judged.collect();
        if judged.contains(&Interval::Unresolved) {
            kept.extend(looked_at.clone());
            found.extend(std::iter::repeat_n(judged, looked_at.len() + 1));
        } else {
            found.push(judged);
        }
    }
    (motion.merged(&between.moments(&kept)), found)
}

impl TrackedCurve {
    /// What it may be off at a place.
    fn off(&self, place: Vector) -> f64 {
        let [off, part] = self.off;
        off.max(part * distance(place, self.reach.0))
    }

    /// Whether the curve is on its way to infinity at a place.
    fn is_far(&self, place: Vector) -> bool {
        distance(place, self.reach.0) > self.reach.1
    }

    /// Whether the curve is on a line in a row, if it is drawn there.
    fn is_on(&self, line: &DrawnLine, motion: &Motion, row: usize) -> bool {
        let place = self.track.in_row(motion, row);
        !is_finite(place) || self.is_far(place) || line.passes(place, RETRACE_TOLERANCE * self.off(place))
    }

    /// What is known of an interval of the motion, behind a row, after a look between its ends.
    fn judged(
        &self,
        (motion, row): (&Motion, usize),
        (between, looked_at): (&Motion, std::ops::Range<usize>),
        is_short: bool,
    ) -> Interval {
        let ends = [row, row + 1].map(|row| self.track.in_row(motion, row));
        let places: Vec<(f64, Vector)> =
            looked_at.map(|row| (between.times[row], self.track.in_row(between, row))).collect();
        // a place that does not exist is not near either
        let is_near = |place: &Vector| distance(*place, self.reach.0) <= self.reach.1;
        if !ends.iter().chain(places.iter().map(|(_, place)| place)).any(is_near) {
            return Interval::Gap;
        }
        let holds = |(t, place): &(f64, Vector)| {
            let drawn = self.track.between(motion, row, *t)[0];
            distance(drawn, *place) <= self.off(*place)
        };
        if ends.iter().copied().all(is_finite) && places.iter().all(holds) {
            return Interval::Resolved;
        }
        let [from, to] = [motion.times[row], motion.times[row + 1]];
        // the end of what has a value is as good as reached
        let is_at_end = ends.iter().any(|end| !is_finite(*end)) && {
            let near = if is_finite(ends[0]) { (row, from) } else { (row + 1, to) };
            let way = length(self.track.between(motion, near.0.min(row), near.1)[1]) * (to - from);
            way <= self.off[0] && !places.iter().any(|(_, place)| is_finite(*place))
        };
        match (is_short, is_at_end) {
            (false, false) => Interval::Unresolved,
            (true, false) if distance(ends[0], ends[1]) <= 4.0 * self.off(ends[0]) => Interval::Resolved,
            _ => Interval::Gap,
        }
    }
}
