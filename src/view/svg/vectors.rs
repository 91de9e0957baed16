//! Velocities and accelerations at the pins, as arrows.

use super::nodes::PIXELS;
use super::picture::Picture;
use crate::scene::{Motion, Point, Vector, length, minus, plus, times};
use crate::view::text::{escaped, number};

/// How long the longest arrow of a kind is, as a part of the picture's shorter side.
const LONGEST: f64 = 0.2;
/// What is shorter than this (px) is not drawn.
const LEAST: f64 = 2.0;
/// The head of an arrow: its length and half its width (px), at most.
const HEAD: [f64; 2] = [9.0, 3.4];

impl Picture<'_> {
    /// At the last of some moments; arrows are to scale with the longest of the whole motion.
    pub fn add_vectors(&mut self, moments: &Motion, motion: &Motion) {
        let scene = self.scene;
        let pins: Vec<&Point> = scene.points.iter().filter(|point| point.is_pin && point.frame > 0).collect();
        let longest = |of: fn(&Motion, usize, &Point) -> Vector| {
            let all = motion.sampled(200).flat_map(|row| pins.iter().map(move |pin| length(of(motion, row, pin))));
            all.filter(|way| way.is_finite()).fold(0.0, f64::max)
        };
        let row = moments.len() - 1;
        let reach = LONGEST * self.size[0].min(self.size[1]);
        for (word, of) in [("velocity", velocity as fn(&Motion, usize, &Point) -> Vector), ("acceleration", acceleration)] {
            let longest = longest(of).max(pins.iter().map(|pin| length(of(moments, row, pin))).fold(0.0, f64::max));
            if !(longest.is_finite() && longest > 0.0) {
                continue;
            }
            let mut drawn: Vec<Vector> = Vec::new();
            for pin in &pins {
                let from = self.placed(moments.poses(row)[pin.frame].placed(pin.at));
                // bodies share their pins
                if drawn.iter().any(|known| length(minus(*known, from)) < 0.5) {
                    continue;
                }
                drawn.push(from);
                let [x, y] = times(reach / longest, of(moments, row, pin));
                self.add_vector(word, &pin.name, from, [x, -y]);
            }
        }
    }

    fn add_vector(&mut self, word: &'static str, name: &str, from: Vector, way: Vector) {
        let far = length(way);
        if far < LEAST {
            return;
        }
        self.used.vectors.insert(word);
        let along = times(1.0 / far, way);
        let [long, wide] = HEAD.map(|part| part * (far / 18.0).min(1.0));
        let tip = plus(from, way);
        let base = minus(tip, times(long, along));
        let side = times(wide, [-along[1], along[0]]);
        let pair = |[x, y]: Vector| format!("{} {}", number(x, PIXELS), number(y, PIXELS));
        self.body += &format!(
            "<path class=\"vector {word}\" data-name=\"{}\" d=\"M{}L{}M{}L{}L{}Z\"/>\n",
            escaped(name),
            pair(from),
            pair(base),
            pair(tip),
            pair(plus(base, side)),
            pair(minus(base, side)),
        );
    }
}

fn velocity(motion: &Motion, row: usize, point: &Point) -> Vector {
    motion.rates(row)[point.frame].velocity(&motion.poses(row)[point.frame], point.at)
}

fn acceleration(motion: &Motion, row: usize, point: &Point) -> Vector {
    let (pose, rate) = (&motion.poses(row)[point.frame], &motion.rates(row)[point.frame]);
    motion.accelerations(row)[point.frame].acceleration(rate, pose, point.at)
}
