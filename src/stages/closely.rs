//! The motion as closely as pictures and cut lines need it, whatever the output times are: at so many times that what is drawn between two of
//! them is what the mechanism does.
//!
//! The times at which it begins are the ends of the motion's own steps. A stretch between two times is looked at in three places; where what
//! is drawn of it is off there, it is parted in four. So nothing is drawn that was not looked at, and lines end where a formula goes to
//! infinity, jumps or has no value.

use super::options::RunOptions;
use super::seen::Seen;
use super::{Checked, Compiled};
use crate::analysis::{Follower, Horizon, Started, Times};
use crate::scene::{Motion, Pen, Track, Vector, bounds, distance, is_finite, length};

/// What is looked at, and how closely.
#[derive(Clone, Debug, Default)]
pub struct Closely {
    /// Points beside the traces of the text.
    pub pens: Vec<Pen>,
    /// What lines may be off (m).
    pub off: f64,
    /// Columns that are plotted.
    pub columns: Vec<String>,
}

impl Closely {
    /// As closely as a picture of what was seen needs it.
    #[must_use]
    pub fn of_picture(seen: &Seen, pens: Vec<Pen>) -> Closely {
        let [low, high] = seen.scene.extent;
        Closely { pens, off: OFF_OF_PICTURE * distance(low, high), columns: Vec::new() }
    }

    /// As closely as what is cut needs it, where a length of 1 becomes `scale`.
    #[must_use]
    pub fn to_cut(scale: f64, pens: Vec<Pen>) -> Closely {
        Closely { pens, off: OFF_TO_CUT / scale.max(1.0), columns: Vec::new() }
    }
}

/// How far what is drawn may be off the motion: what is cut (m of paper), and a picture, as a part of its size.
const OFF_TO_CUT: f64 = 1e-7;
const OFF_OF_PICTURE: f64 = 1e-5;
/// Where a stretch is looked at, as parts of it: not evenly, so that what repeats itself is not met in one place again and again.
const LOOKED_AT: [f64; 3] = [0.23, 0.52, 0.76];
/// The motion is looked at in so many stretches at least.
const STRETCHES: u32 = 96;
/// Stretches are no shorter than this part of the motion.
const SHORTEST: f64 = 1e-13;
/// How often they are parted at most.
const DEEPEST: u32 = 24;
/// So many times are looked at together, with so many numbers at most.
const MOST_TIMES: usize = 200_000;
const MOST_NUMBERS: usize = 20_000_000;
/// Rows of the table that are looked at, too.
const MOST_ROWS: u64 = 2000;
/// What is farther away than so many sizes of the mechanism is on its way to infinity.
const FAR: f64 = 1000.0;
/// Bodies may be off by this part of the mechanism's size.
const BODIES: f64 = 2e-5;
/// Lines need not be better than this part of their size, or of how far away they are; columns than this part of the range that they are
/// mostly in, or of how far they are from the middle of it.
const OF_SIZE: f64 = 2e-11;
const OF_PLACE: f64 = 1e-10;
const OF_RANGE: f64 = 2e-4;
const OF_VALUE: f64 = 1e-3;

/// What is followed between two times.
struct Followed {
    track: Track,
    /// What it may be off, and as a part of how far it is from the middle.
    off: [f64; 2],
    /// What is farther from the middle than this is on its way to infinity.
    far: f64,
    middle: Vector,
    /// Its name, if it can have gaps.
    name: Option<String>,
}

/// What is known of one that is followed, in a stretch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Known {
    Open,
    Held,
    Gap,
}

impl Checked {
    /// Has a motion that was seen as closely as it is wanted, from its first time to its last one or to where it stops; and what is drawn of
    /// it made for that motion. The rows of the table are given up for it.
    pub fn look_closely(
        &self,
        compiled: &Compiled,
        times: &Times,
        options: &RunOptions,
        seen: &mut Seen,
        closely: &Closely,
    ) {
        if seen.motion.rows().is_empty() {
            return;
        }
        // each look at the motion begins where this one does
        let (Ok(mut started), _) = compiled.start(Horizon::of(times), options) else { return };
        // what a run tells of its start looks at the same factors
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let pass_bifurcations = options.pass_bifurcations;
        let search = Search { compiled, started, pass_bifurcations, times, seen, closely };
        let Some(motion) = search.found() else { return };
        seen.motion = motion;
        if let Some(scene) = self.drawn_anew(seen) {
            seen.scene = scene;
        }
    }
}

struct Search<'s> {
    compiled: &'s Compiled,
    started: Started,
    pass_bifurcations: bool,
    times: &'s Times,
    seen: &'s Seen,
    closely: &'s Closely,
}

impl Search<'_> {
    fn found(&self) -> Option<Motion> {
        let first = self.first_times();
        let mut motion = self.at(first)?;
        let [from, to] = [*motion.times.first()?, *motion.times.last()?];
        let followed = self.followed(&motion);
        let least = SHORTEST * (to - from);
        let most = MOST_NUMBERS / self.seen.columns.len().max(1);
        let mut known = vec![vec![Known::Open; followed.len()]; motion.len().saturating_sub(1)];
        for _ in 0..DEEPEST {
            let is_open = |known: &[Known]| known.contains(&Known::Open);
            let asked: Vec<f64> = motion
                .times
                .windows(2)
                .zip(&known)
                .filter(|(_, known)| is_open(known))
                .flat_map(|(ends, _)| LOOKED_AT.map(|part| ends[0] + part * (ends[1] - ends[0])))
                .collect();
            if asked.is_empty() || motion.len() + asked.len() > most.min(MOST_TIMES) {
                break;
            }
            let Some(between) = self.at(asked) else { break };
            (motion, known) = parted(&motion, &known, &between, &followed, least);
        }
        for (number, one) in followed.iter().enumerate() {
            let Some(name) = &one.name else { continue };
            let gaps = motion.times.iter().zip(&known).filter(|(_, known)| known[number] == Known::Gap);
            let gaps = gaps.map(|(t, _)| *t).collect();
            motion.set_gaps(name.clone(), gaps);
        }
        motion.off = self.closely.off;
        Some(motion)
    }

    /// The motion from its start, a row for each of some times.
    fn motion(&self, times: &Times) -> Follower {
        let mut motion = self.started.clone().into_motion(times);
        if self.pass_bifurcations {
            motion.pass_bifurcations();
        }
        motion
    }

    /// The ends of the motion's steps, more where these are few, and the output times; towards where it stops closer and closer.
    fn first_times(&self) -> Vec<f64> {
        let (from, last) = (self.times.from(), self.times.last());
        let whole = Times::listed(from, vec![last]).within_analysis_to(Some(self.times.end()));
        let (mut steps, mut times) = (self.motion(&whole), Vec::new());
        while let Ok(Some(stretch)) = steps.next_stretch() {
            times.push(stretch.to.t);
        }
        let end = if self.seen.stopped.is_none() { last } else { times.iter().copied().fold(from, f64::max) };
        times.extend((0..=STRETCHES).map(|k| from + (end - from) * f64::from(k) / f64::from(STRETCHES)));
        if self.times.len() <= MOST_ROWS {
            times.extend(self.times.iter().filter(|t| *t <= end));
        }
        if end < last {
            let before = times.iter().copied().filter(|t| *t < end).fold(from, f64::max);
            let mut left = end - before;
            for _ in 0..DEEPEST {
                left *= 0.25;
                times.push(end - left);
            }
        }
        times
    }

    /// The motion at some times, as far as it gets there.
    fn at(&self, mut times: Vec<f64>) -> Option<Motion> {
        let asked = times.clone();
        times.push(self.times.last());
        let listed = Times::listed(self.times.from(), times).within_analysis_to(Some(self.times.end()));
        let (mut motion, mut rows) = (self.motion(&listed), Vec::new());
        while let Some(Ok(row)) = motion.next_row() {
            rows.push(row.to_vec());
        }
        if !asked.iter().any(|t| t.total_cmp(&self.times.last()).is_eq()) {
            rows.retain(|row| row[0] < self.times.last());
        }
        let edges = self.seen.motion.edges.clone();
        let found = Motion::of_rows(&self.compiled.columns_of_poses(), &self.seen.columns, rows, edges);
        (!found.is_empty()).then_some(found)
    }

    /// What is followed: the bodies, all pens and columns.
    fn followed(&self, motion: &Motion) -> Vec<Followed> {
        let scene = &self.seen.scene;
        let [low, high] = scene.extent;
        let size = distance(low, high);
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        let bodies = (1..motion.frames()).flat_map(|frame| {
            let reach = [[0.0; 2], [size, 0.0]];
            reach.map(|at| Pen::Point(crate::scene::Anchor { frame, at }))
        });
        let of_body = |pen: Pen| Followed {
            track: motion.track(&pen),
            off: [BODIES * size, 0.0],
            far: f64::INFINITY,
            middle,
            name: None,
        };
        let of_pen = |pen: &Pen| {
            let track = motion.track(pen);
            let places: Vec<Vector> =
                (0..motion.len()).map(|row| track.in_row(motion, row)).filter(|place| is_finite(*place)).collect();
            let (far, own) = match pen {
                Pen::Point(_) => (f64::INFINITY, bounds(places).map_or(0.0, |[low, high]| distance(low, high))),
                Pen::Columns { .. } => {
                    let near = median(places.iter().map(|place| distance(*place, middle)).collect());
                    (FAR * near.max(size), near.min(size))
                }
            };
            let name = match pen {
                Pen::Point(_) => None,
                Pen::Columns { name, .. } => Some(name.clone()),
            };
            Followed {
                track,
                off: [self.closely.off.min(OFF_OF_PICTURE * own).max(OF_SIZE * own), OF_PLACE],
                far,
                middle,
                name,
            }
        };
        let of_column = |name: &String| {
            let track = motion.track_of_column(name);
            let mut values: Vec<f64> =
                (0..motion.len()).map(|row| track.in_row(motion, row)[0]).filter(|value| value.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            let at = |part: usize| values.get(part * values.len().saturating_sub(1) / 10).copied().unwrap_or(0.0);
            // what runs to infinity has a range, too
            let range = if at(9) > at(1) { at(9) - at(1) } else { at(10) - at(0) };
            let (middle, name) = ([at(5), 0.0], Some(name.clone()));
            Followed { track, off: [OF_RANGE * range, OF_VALUE], far: f64::INFINITY, middle, name }
        };
        let pens = scene.traces.iter().map(|trace| &trace.pen).chain(&self.closely.pens).map(of_pen);
        bodies.map(of_body).chain(pens).chain(self.closely.columns.iter().map(of_column)).collect()
    }
}

/// The middle one of some numbers, in their order.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// A motion with what is known of its stretches, after a look between the ends of those that are open. What is drawn well there stays as it
/// is, so that only others are parted.
fn parted(
    motion: &Motion,
    known: &[Vec<Known>],
    between: &Motion,
    followed: &[Followed],
    least: f64,
) -> (Motion, Vec<Vec<Known>>) {
    let (mut kept, mut found) = (Vec::new(), Vec::new());
    let mut next = 0;
    for (row, (ends, before)) in motion.times.windows(2).zip(known).enumerate() {
        let first = next;
        while between.times.get(next).is_some_and(|t| *t < ends[1]) {
            next += 1;
        }
        let looked_at = first..next;
        if looked_at.is_empty() {
            // where the motion does not get to, nothing more is to be learnt
            let settle = |known: &Known| if *known == Known::Open { Known::Held } else { *known };
            found.push(before.iter().map(settle).collect());
            continue;
        }
        let is_short = ends[1] - ends[0] <= least;
        let judged = followed.iter().zip(before).map(|(one, before)| match before {
            Known::Open => one.judged((motion, row), (between, looked_at.clone()), is_short),
            settled => *settled,
        });
        let judged: Vec<Known> = judged.collect();
        if judged.contains(&Known::Open) {
            kept.extend(looked_at.clone());
            found.extend(std::iter::repeat_n(judged, looked_at.len() + 1));
        } else {
            found.push(judged);
        }
    }
    (motion.merged(&between.moments(&kept)), found)
}

impl Followed {
    /// What it may be off at a place.
    fn off(&self, place: Vector) -> f64 {
        let [off, part] = self.off;
        off.max(part * distance(place, self.middle))
    }

    /// What is known of a stretch of the motion, behind a row, after a look between its ends.
    fn judged(
        &self,
        (motion, row): (&Motion, usize),
        (between, looked_at): (&Motion, std::ops::Range<usize>),
        is_short: bool,
    ) -> Known {
        let ends = [row, row + 1].map(|row| self.track.in_row(motion, row));
        let places: Vec<(f64, Vector)> =
            looked_at.map(|row| (between.times[row], self.track.in_row(between, row))).collect();
        let is_near = |place: &Vector| distance(*place, self.middle) <= self.far;
        if !ends.iter().chain(places.iter().map(|(_, place)| place)).any(is_near) {
            return Known::Gap;
        }
        let holds = |(t, place): &(f64, Vector)| {
            let drawn = self.track.between(motion, row, *t)[0];
            distance(drawn, *place) <= self.off(*place)
        };
        if ends.iter().copied().all(is_finite) && places.iter().all(holds) {
            return Known::Held;
        }
        let [from, to] = [motion.times[row], motion.times[row + 1]];
        // the end of what has a value is as good as reached
        let is_at_end = ends.iter().any(|end| !is_finite(*end)) && {
            let near = if is_finite(ends[0]) { (row, from) } else { (row + 1, to) };
            let way = length(self.track.between(motion, near.0.min(row), near.1)[1]) * (to - from);
            way <= self.off[0] && !places.iter().any(|(_, place)| is_finite(*place))
        };
        match (is_short, is_at_end) {
            (false, false) => Known::Open,
            (true, false) if distance(ends[0], ends[1]) <= 4.0 * self.off(ends[0]) => Known::Held,
            _ => Known::Gap,
        }
    }
}
