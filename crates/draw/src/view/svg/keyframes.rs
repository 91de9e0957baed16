//! Motion as keyframes: each moving frame has a track, with as few keys as keep all its positions within a tolerance, between the keys too.

use super::nodes::degrees;
use super::picture::Picture;
use super::picture::{DEGREES, PIXELS};
use crate::scene::{Motion, Node, Place, Pose, Vector, distance, times};
use crate::view::text::number;
use rustc_hash::FxHashMap;

/// Duration of one run (s).
const SECONDS: f64 = 6.0;
/// Tolerance of positions (px), rounding included.
const OFF: f64 = 0.36;
/// Number of moments at which positions are checked, as far as rows allow.
const LOOKED_AT: usize = 2400;
/// Limit of moments from row to row.
const MOST_BETWEEN: usize = 16;
/// Distance of all positions within which the motion ends as it begins (px).
const CLOSES: f64 = 1.5;
/// Number of moments at which labels must not overlap.
const LABELLED_AT: usize = 48;
/// Decimals of a percentage of the run.
const PERCENT: usize = 3;

/// Transform of a group: position (px), rotation (degrees) and scale along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub at: Vector,
    pub turn: f64,
    pub stretch: Vector,
}

/// Parts of a transform that a group needs.
#[derive(Clone, Copy, Debug)]
struct Needs {
    turns: bool,
    stretches: bool,
}

impl Needs {
    fn of<'k>(keys: impl Iterator<Item = &'k Key>) -> Needs {
        keys.fold(Needs { turns: false, stretches: false }, |needs, key| Needs {
            turns: needs.turns || key.rounded().turn != 0.0,
            stretches: needs.stretches || key.stretch.iter().any(|part| (part - 1.0).abs() > 0.0),
        })
    }
}

impl Key {
    fn between(&self, other: &Key, part: f64) -> Key {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Key {
            at: [mix(self.at[0], other.at[0]), mix(self.at[1], other.at[1])],
            turn: mix(self.turn, other.turn),
            stretch: [mix(self.stretch[0], other.stretch[0]), mix(self.stretch[1], other.stretch[1])],
        }
    }

    /// Returns the function that applies the transform.
    fn placing(&self) -> impl Fn(Vector) -> Vector + use<> {
        let (sin, cos) = mechc_expr::math::sin_cos(self.turn.to_radians());
        let Key { at, stretch, .. } = *self;
        move |[x, y]| {
            let [x, y] = [x * stretch[0], y * stretch[1]];
            [at[0] + x * cos - y * sin, at[1] + x * sin + y * cos]
        }
    }

    /// Returns the key as it is written.
    fn rounded(&self) -> Key {
        let round = |value: f64, steps: f64| mechc_expr::math::floor(value * steps + 0.5) / steps;
        let [cent, mille] = [100.0, 1000.0];
        Key {
            at: self.at.map(|part| round(part, cent)),
            turn: round(self.turn, mille),
            stretch: self.stretch.map(|part| round(part, cent)),
        }
    }
}

/// Shapes that move together, with the origin (m) of their transforms.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Mover {
    place: Place,
    origin: Vector,
}

/// Moments at which positions are checked: times (s), and the poses of all frames at each.
struct Moments {
    times: Vec<f64>,
    poses: Vec<Vec<Pose>>,
}

impl Moments {
    fn of(motion: &Motion) -> Moments {
        let steps = motion.len() - 1;
        let between = (LOOKED_AT / steps.max(1)).clamp(1, MOST_BETWEEN);
        let mut times = Vec::with_capacity(steps * between + 1);
        for pair in motion.times.windows(2) {
            times.extend((0..between).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / between as f64));
        }
        times.extend(motion.times.last());
        let mut poses = Vec::with_capacity(times.len());
        for t in &times {
            let mut moment = Vec::new();
            motion.write_poses(*t, &mut moment);
            poses.push(moment);
        }
        Moments { times, poses }
    }
}

impl Picture<'_> {
    /// Adds all nodes, moving.
    pub fn add_motion(&mut self, motion: &Motion) {
        let moments = Moments::of(motion);
        let direction = if self.closes(motion) { "" } else { " alternate" };
        self.rules += &format!(".m{{animation:{}s linear infinite{direction}}}\n", number(SECONDS, 1));
        let mut known: Vec<(Mover, String)> = Vec::new();
        let mut by_frame: FxHashMap<usize, usize> = FxHashMap::default();
        let scene = self.scene;
        for node in &scene.nodes {
            if node.place == Place::Fixed(0) {
                self.add_group(node, [0.0; 2], "", true);
                continue;
            }
            let found = match node.place {
                Place::Fixed(frame) => by_frame.get(&frame).copied(),
                _ => known.iter().position(|(mover, _)| mover.place == node.place),
            };
            let number = found.unwrap_or_else(|| {
                let mover = self.mover(node, motion);
                let track = self.track(&mover, &moments);
                known.push((mover, self.add_track(&track)));
                if let Place::Fixed(frame) = node.place {
                    by_frame.insert(frame, known.len() - 1);
                }
                known.len() - 1
            });
            let (mover, attributes) = &known[number];
            self.add_group(node, mover.origin, attributes, true);
        }
        self.add_traces(motion);
        if self.options.vectors {
            self.add_moving_vectors(motion);
        }
        if self.options.forces {
            self.add_moving_forces(motion);
        }
        if self.options.labels {
            let some: Vec<&[Pose]> = motion.sampled(LABELLED_AT).map(|row| motion.poses(row)).collect();
            for label in self.labels(&some) {
                let mover = Mover { place: Place::Upright(label.anchor), origin: [0.0; 2] };
                let track = self.track(&mover, &moments);
                let attributes = self.add_track(&track);
                self.add_label(&label, [0.0; 2], Some(&attributes));
            }
        }
        self.rules += "@media (prefers-reduced-motion:reduce){.m{animation:none}}\n";
    }

    /// Returns whether the mechanism ends as it begins.
    fn closes(&self, motion: &Motion) -> bool {
        let (first, last) = (motion.poses(0), motion.poses(motion.len() - 1));
        self.scene.nodes.iter().all(|node| {
            let [(from, stretch), (to, other)] = [first, last].map(|poses| node.place.pose(poses));
            let places = node.shapes.iter().flat_map(|shape| shape.path.places());
            places.take(64).all(|[x, y]| {
                let way = distance(from.placed([stretch * x, y]), to.placed([other * x, y]));
                way * self.scale <= CLOSES
            })
        })
    }

    /// Returns the mover of a node. Its origin is the circle centre of its frame that moves least.
    fn mover(&self, node: &Node, motion: &Motion) -> Mover {
        let Place::Fixed(frame) = node.place else { return Mover { place: node.place, origin: [0.0; 2] } };
        let own = self.scene.nodes.iter().filter(|other| other.place == node.place);
        let centers = own.flat_map(|other| &other.shapes).filter_map(|shape| match &shape.path {
            crate::scene::Path::Circle { at, .. } => Some(*at),
            crate::scene::Path::Lines(_) => None,
        });
        let way = |place: Vector| -> f64 {
            let path: Vec<Vector> = motion.sampled(100).map(|row| motion.poses(row)[frame].placed(place)).collect();
            path.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
        };
        let least = centers.take(12).map(|place| (way(place), place)).min_by(|a, b| a.0.total_cmp(&b.0));
        Mover { place: node.place, origin: least.map_or([0.0; 2], |(_, place)| place) }
    }

    /// Returns the key of a mover at a moment.
    fn key(&self, mover: &Mover, poses: &[Pose]) -> Key {
        let (pose, stretch) = mover.place.pose(poses);
        let at = self.placed(pose.placed(mover.origin));
        let is_stretched = mover.place.is_stretched();
        Key { at, turn: degrees(pose.phi), stretch: if is_stretched { [stretch * self.scale, 1.0] } else { [1.0; 2] } }
    }

    /// Returns the positions that a mover shows, before its transform (px).
    fn shown_by(&self, mover: &Mover) -> Vec<Vector> {
        let is_stretched = mover.place.is_stretched();
        let own = self.scene.nodes.iter().filter(|node| node.place == mover.place);
        let places = own.flat_map(|node| &node.shapes).flat_map(|shape| shape.path.places());
        let local = places.map(|[x, y]| {
            if is_stretched {
                return [x, -self.scale * y];
            }
            let [x, y] = times(self.scale, [x - mover.origin[0], y - mover.origin[1]]);
            [x, -y]
        });
        // the corners of the hull bound the deviation of all others
        crate::scene::hull(&local.collect::<Vec<_>>(), 0.5)
    }

    /// Returns the track of a mover.
    fn track(&self, mover: &Mover, moments: &Moments) -> Track {
        let keys: Vec<Key> = moments.poses.iter().map(|poses| self.key(mover, poses)).collect();
        let is_fixed = matches!(mover.place, Place::Fixed(_));
        Track::of(keys, &self.shown_by(mover), &moments.times, is_fixed)
    }

    /// Adds a track to the style sheet and returns the attributes of the groups that follow it.
    pub(super) fn add_track(&mut self, track: &Track) -> String {
        let first = format!(" transform=\"{}\"", track.first);
        let Some(keyframes) = &track.keyframes else { return first };
        let number = self.tracks;
        self.tracks += 1;
        self.rules += &format!(".m{number}{{animation-name:k{number}}}\n@keyframes k{number}{{{keyframes}}}\n");
        // a reader who prefers reduced motion sees the first key
        format!("{first} class=\"m m{number}\"")
    }
}

/// Animation of a group.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// Keyframes, or `None` if the group stays where it begins.
    keyframes: Option<String>,
    /// Transform attribute of the first key.
    first: String,
}

impl Track {
    /// Creates a track with keys at some times (s), for a group that shows some positions. Without `has_turns` the angles are directions,
    /// which may jump by a turn.
    pub(super) fn of(mut keys: Vec<Key>, shown: &[Vector], times: &[f64], has_turns: bool) -> Track {
        if !has_turns {
            unwrap(&mut keys);
        }
        let needs = Needs::of(keys.iter());
        let first = attribute(&keys[0], needs);
        let chosen = chosen(&keys, shown, times);
        if chosen.iter().all(|&k| keys[k].rounded() == keys[0].rounded()) {
            return Track { keyframes: None, first };
        }
        let (begin, end) = (times[0], times[times.len() - 1]);
        let mut text = String::new();
        for &k in &chosen {
            let Key { at: [x, y], turn, stretch } = keys[k];
            let percent = number(100.0 * (times[k] - begin) / (end - begin), PERCENT);
            text += &format!("{percent}%{{transform:translate({}px,{}px)", number(x, PIXELS), number(y, PIXELS));
            if needs.turns {
                text += &format!(" rotate({}deg)", number(turn, DEGREES));
            }
            if needs.stretches {
                let [x, y] = stretch.map(|part| number(part, PIXELS));
                text += &format!(" scale({x},{y})");
            }
            text += "}";
        }
        Track { keyframes: Some(text), first }
    }
}

/// Returns the transform attribute of a key.
fn attribute(key: &Key, needs: Needs) -> String {
    let Key { at: [x, y], turn, stretch } = *key;
    let mut text = format!("translate({} {})", number(x, PIXELS), number(y, PIXELS));
    if needs.turns && key.rounded().turn != 0.0 {
        text += &format!(" rotate({})", number(turn, DEGREES));
    }
    if needs.stretches {
        let [x, y] = stretch.map(|part| number(part, PIXELS));
        text += &format!(" scale({x} {y})");
    }
    text
}

/// Removes jumps by a full turn, which directions have.
fn unwrap(keys: &mut [Key]) {
    for k in 1..keys.len() {
        let turns = mechc_expr::math::floor((keys[k].turn - keys[k - 1].turn) / 360.0 + 0.5);
        keys[k].turn -= 360.0 * turns;
    }
}

/// Chooses the moments that become keys: as few as keep all positions within the tolerance at the other moments.
fn chosen(keys: &[Key], shown: &[Vector], times: &[f64]) -> Vec<usize> {
    let last = keys.len() - 1;
    let wanted: Vec<Vector> = keys.iter().flat_map(|key| shown.iter().copied().map(key.placing())).collect();
    let held = |from: usize, to: usize| {
        let (a, b) = (keys[from].rounded(), keys[to].rounded());
        let length = times[to] - times[from];
        (from + 1..to).all(|k| {
            let part = if length > 0.0 { (times[k] - times[from]) / length } else { 0.0 };
            let guess = a.between(&b, part);
            let wanted = wanted[k * shown.len()..].iter();
            let mut places = shown.iter().copied().map(guess.placing()).zip(wanted);
            distance(guess.at, keys[k].at) <= OFF && places.all(|(found, wanted)| distance(found, *wanted) <= OFF)
        })
    };
    let (mut chosen, mut from) = (vec![0], 0);
    while from < last {
        let (mut good, mut step) = (from + 1, 1);
        // doubling steps, then bisection
        while good < last {
            let next = (good + step).min(last);
            if !held(from, next) {
                break;
            }
            (good, step) = (next, 2 * step);
        }
        while step > 1 {
            step /= 2;
            let next = (good + step).min(last);
            if next > good && held(from, next) {
                good = next;
            }
        }
        chosen.push(good);
        from = good;
    }
    chosen
}
