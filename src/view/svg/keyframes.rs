//! The motion as keyframes: each frame that moves has a track, with no more keys than it takes to keep all its places where they belong,
//! between the keys too.

use super::nodes::{DEGREES, PIXELS, degrees};
use super::picture::Picture;
use crate::scene::{Held, Motion, Node, Place, Pose, Vector, distance, times};
use crate::view::text::number;
use rustc_hash::FxHashMap;

/// How long one run takes at first (s).
const SECONDS: f64 = 6.0;
/// What a place may be off (px), the rounding of what is written included.
const OFF: f64 = 0.36;
/// Rows and moments between them at which places are looked at.
const LOOKED_AT: usize = 2400;
/// Moments from row to row at most.
const MOST_BETWEEN: usize = 16;
/// The motion ends as it begins if nothing is farther away than this (px).
const CLOSES: f64 = 1.5;
/// Moments at which labels must not lie on each other.
const LABELLED_AT: usize = 48;
/// Decimals of a percentage of the run.
const PERCENT: usize = 3;

/// Where a group is, in pixels and degrees, and what x is stretched by (px).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    at: Vector,
    turn: f64,
    stretch: f64,
}

impl Key {
    fn between(&self, other: &Key, part: f64) -> Key {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Key {
            at: [mix(self.at[0], other.at[0]), mix(self.at[1], other.at[1])],
            turn: mix(self.turn, other.turn),
            stretch: mix(self.stretch, other.stretch),
        }
    }

    fn placed(&self, [x, y]: Vector) -> Vector {
        let pose = Pose { at: self.at, phi: self.turn.to_radians() };
        pose.placed([x * self.stretch, y])
    }

    /// As it is written.
    fn rounded(&self) -> Key {
        let round = |value: f64, steps: f64| crate::math::floor(value * steps + 0.5) / steps;
        let [cent, mille] = [100.0, 1000.0];
        Key {
            at: self.at.map(|part| round(part, cent)),
            turn: round(self.turn, mille),
            stretch: round(self.stretch, cent),
        }
    }
}

/// What moves together, with the place (m) that its transforms are about.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Mover {
    place: Place,
    origin: Vector,
}

/// The moments at which places are looked at: times (s), and the poses of all frames at each.
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

    /// The part of the run that has passed at a moment.
    fn part(&self, moment: usize) -> f64 {
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        if last > first { (self.times[moment] - first) / (last - first) } else { 0.0 }
    }
}

impl Picture<'_> {
    /// All nodes, moving.
    pub fn add_motion(&mut self, motion: &Motion) {
        let moments = Moments::of(motion);
        let closes = self.closes(motion);
        let direction = if closes { "" } else { " alternate" };
        let mut tracks: Vec<(Mover, Option<String>, Key)> = Vec::new();
        let mut by_frame: FxHashMap<usize, usize> = FxHashMap::default();
        let scene = self.scene;
        for node in &scene.nodes {
            if node.place == Place::Fixed(0) {
                self.add_group(node, [0.0; 2], "", true);
                continue;
            }
            let known = match node.place {
                Place::Fixed(frame) => by_frame.get(&frame).copied(),
                _ => tracks.iter().position(|(mover, ..)| mover.place == node.place),
            };
            let number = known.unwrap_or_else(|| {
                let mover = self.mover(node, motion);
                let (keyframes, first) = self.track(&mover, &moments);
                if let Place::Fixed(frame) = node.place {
                    by_frame.insert(frame, tracks.len());
                }
                tracks.push((mover, keyframes, first));
                tracks.len() - 1
            });
            let (mover, keyframes, first) = &tracks[number];
            // what stands still needs no keys; where nothing may move, all stay where they begin
            let class = if keyframes.is_some() { format!(" class=\"m m{number}\"") } else { String::new() };
            let attributes = format!(" transform=\"{}\"{class}", attribute(first, mover));
            let origin = mover.origin;
            self.add_group(node, origin, &attributes, true);
        }
        if self.options.labels {
            let some: Vec<&[Pose]> = motion.sampled(LABELLED_AT).map(|row| motion.poses(row)).collect();
            for label in self.labels(&some) {
                let mover = Mover { place: Place::Upright(label.anchor), origin: [0.0; 2] };
                let (keyframes, first) = self.track(&mover, &moments);
                let class = keyframes.as_ref().map_or(String::new(), |_| format!(" class=\"m m{}\"", tracks.len()));
                self.add_label(&label, [0.0; 2], Some(&format!(" transform=\"{}\"{class}", attribute(&first, &mover))));
                tracks.push((mover, keyframes, first));
            }
        }
        self.rules += &format!(".m{{animation:{}s linear infinite{direction}}}\n", number(SECONDS, 1));
        for (k, (_, keyframes, _)) in tracks.iter().enumerate() {
            if let Some(keyframes) = keyframes {
                self.rules += &format!(".m{k}{{animation-name:k{k}}}\n@keyframes k{k}{{{keyframes}}}\n");
            }
        }
        self.rules += "@media (prefers-reduced-motion:reduce){.m{animation:none}}\n";
    }

    /// Whether the mechanism ends as it begins.
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

    /// About which place a node's transforms are: of those that it shows in its frame, the one that moves least.
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

    /// Where a mover is at a moment.
    fn key(&self, mover: &Mover, poses: &[Pose]) -> Key {
        let (pose, stretch) = mover.place.pose(poses);
        let at = self.placed(pose.placed(mover.origin));
        let is_stretched = matches!(mover.place, Place::Between { held: Held::Stretched, .. });
        Key { at, turn: degrees(pose.phi), stretch: if is_stretched { stretch * self.scale } else { 1.0 } }
    }

    /// Places that a mover shows, before its transform (px).
    fn shown_by(&self, mover: &Mover) -> Vec<Vector> {
        let is_stretched = matches!(mover.place, Place::Between { held: Held::Stretched, .. });
        let own = self.scene.nodes.iter().filter(|node| node.place == mover.place);
        let places = own.flat_map(|node| &node.shapes).flat_map(|shape| shape.path.places());
        let local = places.map(|[x, y]| {
            if is_stretched {
                return [x, -self.scale * y];
            }
            let [x, y] = times(self.scale, [x - mover.origin[0], y - mover.origin[1]]);
            [x, -y]
        });
        // the corners of the hull tell how far all else is off
        crate::scene::hull(&local.collect::<Vec<_>>(), 0.5)
    }

    /// The keyframes of a mover, and where it begins; none if it stays there.
    fn track(&self, mover: &Mover, moments: &Moments) -> (Option<String>, Key) {
        let mut keys: Vec<Key> = moments.poses.iter().map(|poses| self.key(mover, poses)).collect();
        if !matches!(mover.place, Place::Fixed(_)) {
            unwrap(&mut keys);
        }
        let shown = self.shown_by(mover);
        let chosen = chosen(&keys, &shown, moments);
        let first = keys[0].rounded();
        if chosen.iter().all(|&k| keys[k].rounded() == first) {
            return (None, first);
        }
        let turns = chosen.iter().any(|&k| keys[k].rounded().turn != 0.0);
        let stretches = matches!(mover.place, Place::Between { held: Held::Stretched, .. });
        let mut text = String::new();
        for &k in &chosen {
            let Key { at: [x, y], turn, stretch } = keys[k];
            let percent = number(100.0 * moments.part(k), PERCENT);
            let (x, y) = (number(x, PIXELS), number(y, PIXELS));
            text += &format!("{percent}%{{transform:translate({x}px,{y}px)");
            if turns {
                text += &format!(" rotate({}deg)", number(turn, DEGREES));
            }
            if stretches {
                text += &format!(" scale({},1)", number(stretch, PIXELS));
            }
            text += "}";
        }
        (Some(text), first)
    }
}

/// The attribute that puts a mover where it begins.
fn attribute(key: &Key, mover: &Mover) -> String {
    let Key { at: [x, y], turn, stretch } = *key;
    let mut text = format!("translate({} {})", number(x, PIXELS), number(y, PIXELS));
    if turn != 0.0 {
        text += &format!(" rotate({})", number(turn, DEGREES));
    }
    if matches!(mover.place, Place::Between { held: Held::Stretched, .. }) {
        text += &format!(" scale({} 1)", number(stretch, PIXELS));
    }
    text
}

/// Directions that come from places jump by a turn; here none does.
fn unwrap(keys: &mut [Key]) {
    for k in 1..keys.len() {
        let turns = crate::math::floor((keys[k].turn - keys[k - 1].turn) / 360.0 + 0.5);
        keys[k].turn -= 360.0 * turns;
    }
}

/// Which moments are keys: so few that all places are where they belong at each other one.
fn chosen(keys: &[Key], shown: &[Vector], moments: &Moments) -> Vec<usize> {
    let last = keys.len() - 1;
    let held = |from: usize, to: usize| {
        let (a, b) = (keys[from].rounded(), keys[to].rounded());
        let length = moments.times[to] - moments.times[from];
        (from + 1..to).all(|k| {
            let part = if length > 0.0 { (moments.times[k] - moments.times[from]) / length } else { 0.0 };
            let guess = a.between(&b, part);
            distance(guess.at, keys[k].at) <= OFF
                && shown.iter().all(|place| distance(guess.placed(*place), keys[k].placed(*place)) <= OFF)
        })
    };
    let (mut chosen, mut from) = (vec![0], 0);
    while from < last {
        let (mut good, mut step) = (from + 1, 1);
        // as far as it goes by doubling, then by halves
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

/// Where a place that a frame shows is at a part of a run, as the keyframes of a file put it: for tests, which read them back.
#[cfg(test)]
pub(super) fn read_back(file: &str, point: &str, part: f64) -> Option<Vector> {
    let mark = format!("data-point=\"{point}\"");
    let at = file.find(&mark)?;
    let group = file[..at].rfind("<g ")?;
    let opening = &file[group..group + file[group..].find('>')?];
    let element = &file[at..at + file[at..].find("/>")?];
    let attribute = |text: &str, name: &str| -> Option<f64> {
        let (_, behind) = text.split_once(&format!(" {name}=\""))?;
        behind.split('"').next()?.parse().ok()
    };
    let local = [attribute(element, "cx").unwrap_or(0.0), attribute(element, "cy").unwrap_or(0.0)];
    let numbers = |text: &str| -> Vec<f64> {
        let is_part = |c: char| c.is_ascii_digit() || matches!(c, '-' | '.');
        text.split(|c| !is_part(c)).filter_map(|word| word.parse().ok()).collect()
    };
    let key = |numbers: &[f64]| Key {
        at: [numbers[0], numbers[1]],
        turn: numbers.get(2).copied().unwrap_or(0.0),
        stretch: 1.0,
    };
    let Some((_, class)) = opening.split_once(" m m") else {
        let Some((_, transform)) = opening.split_once("transform=\"") else { return Some(local) };
        return Some(key(&numbers(transform.split('"').next()?)).placed(local));
    };
    let number: usize = class.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()?;
    let (_, rules) = file.split_once(&format!("@keyframes k{number}{{"))?;
    let rules = rules.split("}}").next()?;
    let keys: Vec<(f64, Key)> = rules
        .split('}')
        .filter_map(|rule| {
            let (percent, transform) = rule.split_once("%{")?;
            Some((percent.parse::<f64>().ok()? / 100.0, key(&numbers(transform))))
        })
        .collect();
    let behind = keys.iter().position(|(at, _)| *at >= part)?.max(1);
    let ((from, a), (to, b)) = (keys[behind - 1], keys[behind]);
    Some(a.between(&b, (part - from) / (to - from)).placed(local))
}
