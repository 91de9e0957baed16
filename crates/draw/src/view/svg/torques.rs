//! Torques as arcs with heads about their positions, in one scale.

use super::keyframes::{Animation, Key};
use super::picture::{PIXELS, Picture};
use super::vectors::{LEGEND, SAMPLED_ROWS};
use crate::scene::{ForceKind, Motion, Torque, Vector, plus, polar, times};
use crate::view::text::{decimal, escape};
use std::f64::consts::PI;

/// Largest radius as a part of the longest velocity arrow.
const LARGEST: f64 = 0.6;
/// Radius below which an arc is not drawn (px).
const LEAST: f64 = 1.5;
/// Start of the arc and of its head (rad), counter-clockwise.
const TURN: [f64; 2] = [-0.75 * PI, 0.7 * PI];
/// Length and half the width of the head, as parts of the radius.
const HEAD: [f64; 2] = [0.36, 0.16];
/// Radius of the legend's arcs (px).
const LEGEND_RADIUS: f64 = 7.0;
/// Torque from which on the legend has kilonewton metres (N·m).
const KILO: f64 = 1e4;
/// Decimals of an arc with radius 1.
const DECIMALS: usize = 4;

impl Picture<'_> {
    /// Adds the torques of the last moment. Their legend begins at a line, counted from the bottom.
    pub(super) fn add_torques(&mut self, moments: &Motion, motion: &Motion, line: f64) {
        let Some(scale) = self.torque_scale([moments, motion], line) else { return };
        let (scene, row) = (self.scene, moments.len() - 1);
        for torque in &scene.torques {
            let (at, radius) = self.arc(torque, moments, row, scale);
            if radius.abs() >= LEAST {
                self.styles.vectors.insert(torque.kind.word());
                let name = escape(&scene.declarations[torque.declaration].name);
                self.body += &arc_element(torque.kind, &name, &arc_path(at, radius, PIXELS));
            }
        }
    }

    /// Adds the torques of the whole motion: an arc is stretched, and mirrored while its torque is clockwise.
    pub(super) fn add_moving_torques(&mut self, motion: &Motion, line: f64) {
        let Some(scale) = self.torque_scale([motion, motion], line) else { return };
        let scene = self.scene;
        for torque in &scene.torques {
            let arcs: Vec<(Vector, f64)> = (0..motion.len()).map(|row| self.arc(torque, motion, row, scale)).collect();
            if arcs.iter().all(|(_, radius)| radius.abs() < LEAST) {
                continue;
            }
            self.styles.vectors.insert(torque.kind.word());
            let key = |(at, radius): &(Vector, f64)| Key { at: *at, turn: 0.0, stretch: [*radius, radius.abs()] };
            let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
            let animation = Animation::new(arcs.iter().map(key).collect(), &corners, &motion.times, false);
            let attributes = self.add_animation(&animation);
            let name = escape(&scene.declarations[torque.declaration].name);
            let element = arc_element(torque.kind, &name, &arc_path([0.0; 2], 1.0, DECIMALS));
            self.body += &format!("<g{attributes}>{}</g>\n", element.trim_end());
        }
    }

    /// Returns the centre of an arc and its radius (px), negative if it is clockwise and 0 if the table has no value.
    fn arc(&self, torque: &Torque, motion: &Motion, row: usize, scale: f64) -> (Vector, f64) {
        let radius = scale * torque.value(motion, row);
        (self.to_pixels(torque.at.position(motion.poses(row))), if radius.is_finite() { radius } else { 0.0 })
    }

    /// Returns the pixels per newton metre, from the largest torque of two motions, and adds the legend. Returns `None` if all torques are
    /// zero.
    fn torque_scale(&mut self, motions: [&Motion; 2], mut line: f64) -> Option<f64> {
        let scene = self.scene;
        let largest = |kind: ForceKind| {
            let rows =
                || motions.into_iter().flat_map(|motion| motion.sampled(SAMPLED_ROWS).map(move |row| (motion, row)));
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
            self.styles.vectors.insert(kind.word());
            self.body += &arc_element(kind, kind.word(), &arc_path(at, LEGEND_RADIUS, PIXELS));
            self.add_legend_text(&format!("{} torque", kind.word()), value, unit, line);
            line += 1.0;
        }
        Some(LARGEST * self.longest_arrow() / most)
    }
}

fn arc_element(kind: ForceKind, name: &str, d: &str) -> String {
    format!("<path class=\"vector {}\" data-name=\"{name}\" d=\"{d}\"/>\n", kind.word())
}

/// Writes an arc with its head, clockwise for a negative radius. It returns along itself, so that the fill covers only the head.
fn arc_path(at: Vector, radius: f64, decimals: usize) -> String {
    let size = radius.abs();
    // y points down here
    let position = |by: f64, angle: f64| {
        let [x, y] = polar(by, angle);
        plus(at, times(size, [x * radius.signum(), -y]))
    };
    let [long, wide] = HEAD;
    let [from, to] = TURN;
    let pair = |[x, y]: Vector| format!("{} {}", decimal(x, decimals), decimal(y, decimals));
    let radii = format!("{0} {0}", decimal(size, decimals));
    let sweep = u8::from(radius < 0.0);
    format!(
        "M{start}A{radii} 0 1 {sweep} {end}A{radii} 0 1 {back} {start}M{tip}L{outer}L{inner}Z",
        start = pair(position(1.0, from)),
        end = pair(position(1.0, to)),
        back = 1 - sweep,
        tip = pair(position(1.0, to + long)),
        outer = pair(position(1.0 + wide, to)),
        inner = pair(position(1.0 - wide, to)),
    )
}
