//! Forces as arrows in one scale.

use super::picture::Picture;
use super::vectors::SAMPLED_ROWS;
use crate::scene::{ForceKind, ForceVector, Motion, Vector, length, times};

/// Length of the longest arrow as a part of that of a velocity: forces may point away from everything else.
const LONGEST: f64 = 0.8;
/// Force from which on the legend has kilonewtons (N).
const KILO: f64 = 1e4;

impl Picture<'_> {
    /// Adds the forces of the last moment.
    pub fn add_forces(&mut self, moments: &Motion, motion: &Motion) {
        let mut line = self.legend_lines();
        if let Some(scale) = self.force_scale([moments, motion], &mut line) {
            let (scene, row) = (self.scene, moments.len() - 1);
            for force in &scene.forces {
                let [from, vector] = self.arrow(force, moments, row, scale);
                self.add_vector(force.kind.word(), &scene.declarations[force.declaration].name, from, vector);
            }
        }
        self.add_torques(moments, motion, line);
    }

    /// Adds the forces of the whole motion.
    pub fn add_moving_forces(&mut self, motion: &Motion) {
        let mut line = self.legend_lines();
        if let Some(scale) = self.force_scale([motion, motion], &mut line) {
            let scene = self.scene;
            for force in &scene.forces {
                let arrows: Vec<[Vector; 2]> =
                    (0..motion.len()).map(|row| self.arrow(force, motion, row, scale)).collect();
                let name = &scene.declarations[force.declaration].name;
                self.add_moving_vector(force.kind.word(), name, &arrows, &motion.times);
            }
        }
        self.add_moving_torques(motion, line);
    }

    /// Returns the number of lines in the legend of velocities and accelerations.
    fn legend_lines(&self) -> f64 {
        if self.options.vectors { 2.0 } else { 0.0 }
    }

    /// Returns the start and the vector of an arrow (px); the vector is zero if the table has no value.
    fn arrow(&self, force: &ForceVector, motion: &Motion, row: usize, scale: f64) -> [Vector; 2] {
        let [x, y] = times(scale, force.value(motion, row));
        let vector = if x.is_finite() && y.is_finite() { [x, -y] } else { [0.0; 2] };
        [self.to_pixels(force.at.position(motion.poses(row))), vector]
    }

    /// Returns the pixels per newton, from the largest force of two motions, and adds the legend with the largest force of each kind at
    /// `line`, which it advances. Returns `None` if all forces are zero.
    fn force_scale(&mut self, motions: [&Motion; 2], line: &mut f64) -> Option<f64> {
        let scene = self.scene;
        let largest = |kind: ForceKind| {
            let rows =
                || motions.into_iter().flat_map(|motion| motion.sampled(SAMPLED_ROWS).map(move |row| (motion, row)));
            let forces = scene.forces.iter().filter(|force| force.kind == kind);
            let sizes = forces.flat_map(|force| rows().map(|(motion, row)| length(force.value(motion, row))));
            sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
        };
        let all = ForceKind::ALL.map(|kind| (kind, largest(kind)));
        let longest = all.iter().map(|(_, largest)| *largest).fold(0.0, f64::max);
        if longest <= 0.0 {
            return None;
        }
        for (kind, largest) in all.into_iter().rev().filter(|(_, largest)| *largest > 0.0) {
            let (value, unit) = if longest >= KILO { (largest / 1e3, "kN") } else { (largest, "N") };
            self.add_legend(kind.word(), value, unit, *line);
            *line += 1.0;
        }
        Some(LONGEST * self.longest_arrow() / longest)
    }
}
