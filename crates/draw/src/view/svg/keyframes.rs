//! Motion as keyframes: each moving frame has a track, with as few keys as keep all its positions within a tolerance, between the keys too.

use super::nodes::degrees;
use super::picture::Picture;
use super::picture::{DEGREES, PIXELS};
use crate::scene::{Attachment, Motion, Node, Pose, Vector, distance, times};
use crate::view::text::decimal;
use rustc_hash::FxHashMap;

/// Duration of one run (s).
const SECONDS: f64 = 6.0;
/// Tolerance of positions (px), rounding included.
const TOLERANCE: f64 = 0.36;
/// Number of moments at which positions are checked, as far as rows allow.
const CHECKED_MOMENTS: usize = 2400;
/// Limit of moments from row to row.
const MOST_BETWEEN: usize = 16;
/// Distance of all positions within which the motion ends as it begins (px).
const CLOSING_DISTANCE: f64 = 1.5;
/// Number of moments at which labels must not overlap.
const LABELLED_MOMENTS: usize = 48;
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
struct TransformParts {
    turns: bool,
    stretches: bool,
}

impl TransformParts {
    fn new<'k>(keys: impl Iterator<Item = &'k Key>) -> TransformParts {
        keys.fold(TransformParts { turns: false, stretches: false }, |parts, key| TransformParts {
            turns: parts.turns || key.rounded().turn != 0.0,
            stretches: parts.stretches || key.stretch.iter().any(|part| (part - 1.0).abs() > 0.0),
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
    fn transform(&self) -> impl Fn(Vector) -> Vector + use<> {
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
    attachment: Attachment,
    origin: Vector,
}

/// Moments at which positions are checked: times (s), and the poses of all frames at each.
struct Moments {
    times: Vec<f64>,
    poses: Vec<Vec<Pose>>,
}

impl Moments {
    fn new(motion: &Motion) -> Moments {
        let steps = motion.len() - 1;
        let between = (CHECKED_MOMENTS / steps.max(1)).clamp(1, MOST_BETWEEN);
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
        let moments = Moments::new(motion);
        let direction = if self.closes(motion) { "" } else { " alternate" };
        self.rules += &format!(".m{{animation:{}s linear infinite{direction}}}\n", decimal(SECONDS, 1));
        let mut animations: Vec<(Mover, String)> = Vec::new();
        let mut by_frame: FxHashMap<usize, usize> = FxHashMap::default();
        let scene = self.scene;
        for node in &scene.nodes {
            if node.attachment == Attachment::Fixed(0) {
                self.add_group(node, [0.0; 2], "", true);
                continue;
            }
            let index = match node.attachment {
                Attachment::Fixed(frame) => by_frame.get(&frame).copied(),
                _ => animations.iter().position(|(mover, _)| mover.attachment == node.attachment),
            };
            let number = index.unwrap_or_else(|| {
                let mover = self.mover(node, motion);
                let animation = self.animation(&mover, &moments);
                animations.push((mover, self.add_animation(&animation)));
                if let Attachment::Fixed(frame) = node.attachment {
                    by_frame.insert(frame, animations.len() - 1);
                }
                animations.len() - 1
            });
            let (mover, attributes) = &animations[number];
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
            let sampled: Vec<&[Pose]> = motion.sampled(LABELLED_MOMENTS).map(|row| motion.poses(row)).collect();
            for label in self.labels(&sampled) {
                let mover = Mover { attachment: Attachment::Upright(label.anchor), origin: [0.0; 2] };
                let animation = self.animation(&mover, &moments);
                let attributes = self.add_animation(&animation);
                self.add_label(&label, [0.0; 2], Some(&attributes));
            }
        }
        self.rules += "@media (prefers-reduced-motion:reduce){.m{animation:none}}\n";
    }

    /// Returns whether the mechanism ends as it begins.
    fn closes(&self, motion: &Motion) -> bool {
        let (first, last) = (motion.poses(0), motion.poses(motion.len() - 1));
        self.scene.nodes.iter().all(|node| {
            let [(from, stretch), (to, other)] = [first, last].map(|poses| node.attachment.pose(poses));
            let positions = node.shapes.iter().flat_map(|shape| shape.path.positions());
            positions.take(64).all(|[x, y]| {
                let distance = distance(from.transform([stretch * x, y]), to.transform([other * x, y]));
                distance * self.scale <= CLOSING_DISTANCE
            })
        })
    }

    /// Returns the mover of a node. Its origin is the circle centre of its frame that moves least.
    fn mover(&self, node: &Node, motion: &Motion) -> Mover {
        let Attachment::Fixed(frame) = node.attachment else {
            return Mover { attachment: node.attachment, origin: [0.0; 2] };
        };
        let nodes = self.scene.nodes.iter().filter(|other| other.attachment == node.attachment);
        let centers = nodes.flat_map(|other| &other.shapes).filter_map(|shape| match &shape.path {
            crate::scene::Path::Circle { at, .. } => Some(*at),
            crate::scene::Path::Lines(_) => None,
        });
        let travel = |position: Vector| -> f64 {
            let path: Vec<Vector> =
                motion.sampled(100).map(|row| motion.poses(row)[frame].transform(position)).collect();
            path.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
        };
        let least = centers.take(12).map(|position| (travel(position), position)).min_by(|a, b| a.0.total_cmp(&b.0));
        Mover { attachment: node.attachment, origin: least.map_or([0.0; 2], |(_, position)| position) }
    }

    /// Returns the key of a mover at a moment.
    fn key(&self, mover: &Mover, poses: &[Pose]) -> Key {
        let (pose, stretch) = mover.attachment.pose(poses);
        let at = self.to_pixels(pose.transform(mover.origin));
        let is_stretched = mover.attachment.is_stretched();
        Key { at, turn: degrees(pose.phi), stretch: if is_stretched { [stretch * self.scale, 1.0] } else { [1.0; 2] } }
    }

    /// Returns the positions that a mover shows, before its transform (px).
    fn shown_positions(&self, mover: &Mover) -> Vec<Vector> {
        let is_stretched = mover.attachment.is_stretched();
        let nodes = self.scene.nodes.iter().filter(|node| node.attachment == mover.attachment);
        let positions = nodes.flat_map(|node| &node.shapes).flat_map(|shape| shape.path.positions());
        let local = positions.map(|[x, y]| {
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
    fn animation(&self, mover: &Mover, moments: &Moments) -> Animation {
        let keys: Vec<Key> = moments.poses.iter().map(|poses| self.key(mover, poses)).collect();
        let is_fixed = matches!(mover.attachment, Attachment::Fixed(_));
        Animation::new(keys, &self.shown_positions(mover), &moments.times, is_fixed)
    }

    /// Adds a track to the style sheet and returns the attributes of the groups that follow it.
    pub(super) fn add_animation(&mut self, animation: &Animation) -> String {
        let first = format!(" transform=\"{}\"", animation.first);
        let Some(keyframes) = &animation.keyframes else { return first };
        let number = self.tracks;
        self.tracks += 1;
        self.rules += &format!(".m{number}{{animation-name:k{number}}}\n@keyframes k{number}{{{keyframes}}}\n");
        // a reader who prefers reduced motion sees the first key
        format!("{first} class=\"m m{number}\"")
    }
}

/// Animation of a group.
#[derive(Clone, Debug)]
pub(super) struct Animation {
    /// Keyframes, or `None` if the group stays where it begins.
    keyframes: Option<String>,
    /// Transform attribute of the first key.
    first: String,
}

impl Animation {
    /// Creates a track with keys at some times (s), for a group that shows some positions. Without `has_turns` the angles are directions,
    /// which may jump by a turn.
    pub(super) fn new(mut keys: Vec<Key>, shown: &[Vector], times: &[f64], has_turns: bool) -> Animation {
        if !has_turns {
            unwrap(&mut keys);
        }
        let parts = TransformParts::new(keys.iter());
        let first = attribute(&keys[0], parts);
        let chosen = choose_keys(&keys, shown, times);
        if chosen.iter().all(|&k| keys[k].rounded() == keys[0].rounded()) {
            return Animation { keyframes: None, first };
        }
        let (begin, end) = (times[0], times[times.len() - 1]);
        let mut text = String::new();
        for &k in &chosen {
            let Key { at: [x, y], turn, stretch } = keys[k];
            let percent = decimal(100.0 * (times[k] - begin) / (end - begin), PERCENT);
            text += &format!("{percent}%{{transform:translate({}px,{}px)", decimal(x, PIXELS), decimal(y, PIXELS));
            if parts.turns {
                text += &format!(" rotate({}deg)", decimal(turn, DEGREES));
            }
            if parts.stretches {
                let [x, y] = stretch.map(|part| decimal(part, PIXELS));
                text += &format!(" scale({x},{y})");
            }
            text += "}";
        }
        Animation { keyframes: Some(text), first }
    }
}

/// Returns the transform attribute of a key.
fn attribute(key: &Key, parts: TransformParts) -> String {
    let Key { at: [x, y], turn, stretch } = *key;
    let mut text = format!("translate({} {})", decimal(x, PIXELS), decimal(y, PIXELS));
    if parts.turns && key.rounded().turn != 0.0 {
        text += &format!(" rotate({})", decimal(turn, DEGREES));
    }
    if parts.stretches {
        let [x, y] = stretch.map(|part| decimal(part, PIXELS));
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
fn choose_keys(keys: &[Key], shown: &[Vector], times: &[f64]) -> Vec<usize> {
    let last = keys.len() - 1;
    let expected: Vec<Vector> = keys.iter().flat_map(|key| shown.iter().copied().map(key.transform())).collect();
    let is_within_tolerance = |from: usize, to: usize| {
        let (a, b) = (keys[from].rounded(), keys[to].rounded());
        let length = times[to] - times[from];
        (from + 1..to).all(|k| {
            let part = if length > 0.0 { (times[k] - times[from]) / length } else { 0.0 };
            let guess = a.between(&b, part);
            let expected = expected[k * shown.len()..].iter();
            let mut positions = shown.iter().copied().map(guess.transform()).zip(expected);
            distance(guess.at, keys[k].at) <= TOLERANCE
                && positions.all(|(actual, expected)| distance(actual, *expected) <= TOLERANCE)
        })
    };
    let (mut chosen, mut from) = (vec![0], 0);
    while from < last {
        let (mut good, mut step) = (from + 1, 1);
        // doubling steps, then bisection
        while good < last {
            let next = (good + step).min(last);
            if !is_within_tolerance(from, next) {
                break;
            }
            (good, step) = (next, 2 * step);
        }
        while step > 1 {
            step /= 2;
            let next = (good + step).min(last);
            if next > good && is_within_tolerance(from, next) {
                good = next;
            }
        }
        chosen.push(good);
        from = good;
    }
    chosen
}
