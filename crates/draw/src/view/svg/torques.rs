//! Torques as arcs with heads about where they take hold, all to one scale.

use super::keyframes::{Key, Track};
use super::picture::{PIXELS, Picture};
use super::vectors::{LEGEND, LOOKED_AT};
use crate::scene::{ForceKind, Motion, Torque, Vector, plus, polar, times};
use crate::view::text::{escaped, number};
use std::f64::consts::PI;

/// The largest radius, as a part of the longest arrow of a velocity.
const LARGEST: f64 = 0.6;
/// What has a smaller radius (px) is not drawn.
const LEAST: f64 = 1.5;
/// Where an arc begins and where its head does (rad), counter-clockwise.
const TURN: [f64; 2] = [-0.75 * PI, 0.7 * PI];
/// The head: its length and half its width, as parts of the radius.
const HEAD: [f64; 2] = [0.36, 0.16];
/// The radius of the legend's arcs (px).
const LEGEND_RADIUS: f64 = 7.0;
/// From this torque on it is told in kilonewton metres (N·m).
const KILO: f64 = 1e4;
/// Decimals of an arc of radius 1.
const DECIMALS: usize = 4;

impl Picture<'_> {
    /// At the last of some moments; the legend begins so many lines above the last.
    pub(super) fn add_torques(&mut self, moments: &Motion, motion: &Motion, line: f64) {
        let Some(scale) = self.scaled_torques([moments, motion], line) else { return };
        let (scene, row) = (self.scene, moments.len() - 1);
        for torque in &scene.torques {
            let (at, radius) = self.arc(torque, moments, row, scale);
            if radius.abs() >= LEAST {
                self.used.vectors.insert(torque.kind.word());
                let name = escaped(&scene.declarations[torque.declaration].name);
                self.body += &path(torque.kind, &name, &arc(at, radius, PIXELS));
            }
        }
    }

    /// At all times: an arc is stretched, and turned over where its torque is clockwise.
    pub(super) fn add_moving_torques(&mut self, motion: &Motion, line: f64) {
        let Some(scale) = self.scaled_torques([motion, motion], line) else { return };
        let scene = self.scene;
        for torque in &scene.torques {
            let arcs: Vec<(Vector, f64)> = (0..motion.len()).map(|row| self.arc(torque, motion, row, scale)).collect();
            if arcs.iter().all(|(_, radius)| radius.abs() < LEAST) {
                continue;
            }
            self.used.vectors.insert(torque.kind.word());
            let key = |(at, radius): &(Vector, f64)| Key { at: *at, turn: 0.0, stretch: [*radius, radius.abs()] };
            let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
            let track = Track::of(arcs.iter().map(key).collect(), &corners, &motion.times, false);
            let attributes = self.add_track(&track);
            let name = escaped(&scene.declarations[torque.declaration].name);
            let path = path(torque.kind, &name, &arc([0.0; 2], 1.0, DECIMALS));
            self.body += &format!("<g{attributes}>{}</g>\n", path.trim_end());
        }
    }

    /// The middle of an arc, and its radius (px), below zero where it goes clockwise; none where the table does not tell the torque.
    fn arc(&self, torque: &Torque, motion: &Motion, row: usize, scale: f64) -> (Vector, f64) {
        let radius = scale * torque.value(motion, row);
        (self.placed(torque.at.placed(motion.poses(row))), if radius.is_finite() { radius } else { 0.0 })
    }

    /// Pixels of a newton metre, by the largest torque of two motions, which the legend tells of each kind. Nothing where there are none.
    fn scaled_torques(&mut self, motions: [&Motion; 2], mut line: f64) -> Option<f64> {
        let scene = self.scene;
        let largest = |kind: ForceKind| {
            let rows =
                || motions.into_iter().flat_map(|motion| motion.sampled(LOOKED_AT).map(move |row| (motion, row)));
            let torques = scene.torques.iter().filter(|torque| torque.kind == kind);
            let sizes = torques.flat_map(|torque| rows().map(|(motion, row)| torque.value(motion, row).abs()));
            sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
        };
        let all = ForceKind::ALL.map(|kind| (kind, largest(kind)));
        let most = all.iter().map(|(_, largest)| *largest).fold(0.0, f64::max);
        if most <= 0.0 {
            return None;
        }
        for (kind, largest) in all.into_iter().rev().filter(|(_, largest)| *largest > 0.0) {
            let (value, unit) = if most >= KILO { (largest / 1e3, "kN·m") } else { (largest, "N·m") };
            let size = self.letters();
            let at = [LEGEND + LEGEND_RADIUS, self.legend_line(line) - 0.35 * size];
            self.used.vectors.insert(kind.word());
            self.body += &path(kind, kind.word(), &arc(at, LEGEND_RADIUS, PIXELS));
            self.add_legend_text(&format!("{} torque", kind.word()), value, unit, line);
            line += 1.0;
        }
        Some(LARGEST * self.longest_arrow() / most)
    }
}

fn path(kind: ForceKind, name: &str, d: &str) -> String {
    format!("<path class=\"vector {}\" data-name=\"{name}\" d=\"{d}\"/>\n", kind.word())
}

/// An arc with its head, clockwise where the radius is below zero. It goes back on itself, so that nothing is between it and its chord.
fn arc(at: Vector, radius: f64, decimals: usize) -> String {
    let size = radius.abs();
    // up is down here
    let place = |by: f64, angle: f64| {
        let [x, y] = polar(by, angle);
        plus(at, times(size, [x * radius.signum(), -y]))
    };
    let [long, wide] = HEAD;
    let [from, to] = TURN;
    let pair = |[x, y]: Vector| format!("{} {}", number(x, decimals), number(y, decimals));
    let radii = format!("{0} {0}", number(size, decimals));
    let sweep = u8::from(radius < 0.0);
    format!(
        "M{start}A{radii} 0 1 {sweep} {end}A{radii} 0 1 {back} {start}M{tip}L{outer}L{inner}Z",
        start = pair(place(1.0, from)),
        end = pair(place(1.0, to)),
        back = 1 - sweep,
        tip = pair(place(1.0, to + long)),
        outer = pair(place(1.0 + wide, to)),
        inner = pair(place(1.0 - wide, to)),
    )
}
