//! Teeth: involutes of 25°, a little shorter than standard ones, so that gears with twelve teeth need no undercut.

use super::plane::{Contour, Segment, Vector, left, plus, polar, times};
use mechc_expr::math;
use std::f64::consts::{PI, TAU};

/// Pressure angle (rad).
const PRESSURE: f64 = 25.0 * PI / 180.0;
/// Height of teeth above the pitch circle, and depth of gaps below it (modules).
pub(super) const ADDENDUM: f64 = 0.8;
pub(super) const DEDENDUM: f64 = 1.0;
/// Part of a pitch by which a tooth is thinner than a gap.
const BACKLASH: f64 = 0.03;
/// Points on a flank.
const FLANK_POINTS: u32 = 4;

/// A gear with its teeth.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Wheel {
    pub at: Vector,
    /// Radius of the pitch circle (m).
    pub radius: f64,
    pub teeth: u32,
    /// Direction of the middle of a tooth in the gear's frame (rad).
    pub phase: f64,
}

/// One bump per tooth between two radii: the teeth of a gear, or the gaps of a ring gear.
struct Bumps {
    /// Inner and outer radius (m).
    radii: [f64; 2],
    /// Thickness on the pitch circle as a part of half a pitch.
    thickness: f64,
    /// Direction of the middle of one bump (rad).
    phase: f64,
}

impl Wheel {
    /// Returns the pitch diameter divided by the number of teeth (m).
    pub fn module(&self) -> f64 {
        2.0 * self.radius / f64::from(self.teeth)
    }

    /// Returns the outline of the teeth, which point outward.
    pub fn outline(&self) -> Contour {
        self.bumps(&self.teeth_of_wheel())
    }

    /// Returns the inner outline of a ring gear, whose teeth point inward: its gaps have the shape of a gear's teeth.
    pub fn inner_outline(&self) -> Contour {
        self.bumps(&self.gaps_of_ring())
    }

    fn teeth_of_wheel(&self) -> Bumps {
        let module = self.module();
        let radii = [self.radius - DEDENDUM * module, self.radius + ADDENDUM * module];
        Bumps { radii, thickness: 1.0 - 2.0 * BACKLASH, phase: self.phase }
    }

    fn gaps_of_ring(&self) -> Bumps {
        let module = self.module();
        let radii = [self.radius - ADDENDUM * module, self.radius + DEDENDUM * module];
        Bumps { radii, thickness: 1.0 + 2.0 * BACKLASH, phase: self.phase + PI / f64::from(self.teeth) }
    }

    fn bumps(&self, bumps: &Bumps) -> Contour {
        let Bumps { radii: [low, high], thickness, phase } = *bumps;
        let base = self.radius * math::cos(PRESSURE);
        let involute = |radius: f64| {
            let angle = math::acos((base / radius).min(1.0));
            math::tan(angle) - angle
        };
        let half = thickness * PI / (2.0 * f64::from(self.teeth)) + involute(self.radius);
        let from = low.max(base);
        let radius = |k: u32| from + (high - from) * f64::from(k) / f64::from(FLANK_POINTS - 1);
        // radius and angle from the tooth's middle, from the root to the tip
        let mut flank: Vec<[f64; 2]> = (0..FLANK_POINTS).map(|k| [radius(k), half - involute(radius(k))]).collect();
        if low < from {
            flank.insert(0, [low, flank[0][1]]);
        }
        let mut positions = Vec::with_capacity(2 * flank.len() * self.teeth as usize);
        for tooth in 0..self.teeth {
            let middle = phase + TAU * f64::from(tooth) / f64::from(self.teeth);
            let position = |[radius, angle]: [f64; 2]| plus(self.at, polar(radius, angle));
            positions.extend(flank.iter().map(|[radius, off]| position([*radius, middle - off])));
            positions.extend(flank.iter().rev().map(|[radius, off]| position([*radius, middle + off])));
        }
        closed_polygon(positions)
    }
}

/// A straight row of teeth along a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rack {
    /// Point of the pitch line (m), and its direction, of length 1.
    pub at: Vector,
    pub along: Vector,
    /// 1 if the teeth point to the left, −1 if to the right.
    pub side: f64,
    /// Distance from one tooth to the next (m).
    pub pitch: f64,
    /// Coordinate of the middle of a tooth on the line (m).
    pub phase: f64,
}

impl Rack {
    /// Returns the outline of the teeth over a range of the line (m), on a bar of a thickness (m).
    pub fn outline(&self, [from, to]: [f64; 2], bar: f64) -> Contour {
        let module = self.pitch / PI;
        let position =
            |x: f64, y: f64| plus(plus(self.at, times(x, self.along)), times(self.side * y, left(self.along)));
        let slope = math::tan(PRESSURE);
        let half = 0.25 * self.pitch * (1.0 - 2.0 * BACKLASH);
        let flank = [
            [half + slope * DEDENDUM * module, -DEDENDUM * module],
            [half - slope * ADDENDUM * module, ADDENDUM * module],
        ];
        let first = math::floor((from - self.phase) / self.pitch);
        let last = -math::floor(-(to - self.phase) / self.pitch);
        let count = (last - first).clamp(0.0, 2000.0);
        #[allow(clippy::cast_sign_loss)] // clamped
        let middles = (0..=count as u32).map(|k| self.phase + (first + f64::from(k)) * self.pitch);
        let mut positions = Vec::new();
        let ends = [self.phase + (first - 0.5) * self.pitch, self.phase + (first + count + 0.5) * self.pitch];
        let depth = -(DEDENDUM * module + bar);
        positions.extend([position(ends[0], depth), position(ends[0], flank[0][1])]);
        for middle in middles {
            let [[wide, foot], [narrow, tip]] = flank;
            positions.extend([
                position(middle - wide, foot),
                position(middle - narrow, tip),
                position(middle + narrow, tip),
                position(middle + wide, foot),
            ]);
        }
        positions.extend([position(ends[1], flank[0][1]), position(ends[1], depth)]);
        closed_polygon(positions)
    }
}

fn closed_polygon(positions: Vec<Vector>) -> Contour {
    let mut positions = positions.into_iter();
    let start = positions.next().unwrap_or([0.0; 2]);
    Contour { start, segments: positions.map(Segment::Line).collect(), is_closed: true }
}

/// Returns how far a gear at an angle (rad) has its next tooth from where it meshes in a direction (rad), along the pitch circle (pitches).
pub(super) fn offset(wheel: &Wheel, angle: f64, direction: f64) -> f64 {
    f64::from(wheel.teeth) * (angle + wheel.phase - direction) / TAU
}

/// Returns the difference of a number from the nearest whole number.
pub(super) fn integer_residual(value: f64) -> f64 {
    value - math::floor(value + 0.5)
}

/// Returns whether a position lies inside a closed polygon.
#[cfg(test)]
pub(super) fn is_inside(position: Vector, corners: &[Vector]) -> bool {
    let mut is_inside = false;
    for (k, b) in corners.iter().enumerate() {
        let a = corners[(k + corners.len() - 1) % corners.len()];
        if (a[1] > position[1]) != (b[1] > position[1]) {
            let x = a[0] + (position[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            is_inside ^= position[0] < x;
        }
    }
    is_inside
}

/// Returns the depth of a position inside a closed polygon; 0 outside.
#[cfg(test)]
pub(super) fn depth(position: Vector, corners: &[Vector]) -> f64 {
    if !is_inside(position, corners) {
        return 0.0;
    }
    let edge = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let edge_vector = super::plane::minus(b, a);
        let part = (super::plane::dot(super::plane::minus(position, a), edge_vector)
            / super::plane::dot(edge_vector, edge_vector))
        .clamp(0.0, 1.0);
        super::plane::distance(position, plus(a, times(part, edge_vector)))
    };
    (0..corners.len()).map(edge).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::plane::{Path, Pose};

    fn corners(contour: Contour, pose: &Pose) -> Vec<Vector> {
        Path::Lines(vec![contour]).transform(pose).positions()
    }

    #[test]
    fn teeth_of_two_wheels_do_not_overlap() {
        for [z, other] in [[12, 12], [12, 40], [17, 23]] {
            let radii = [z, other].map(|z| f64::from(z) * 0.5);
            let wheel = Wheel { at: [0.0; 2], radius: radii[0], teeth: z, phase: 0.0 };
            // a tooth of one faces a gap of the other
            let facing = Wheel { at: [0.0; 2], radius: radii[1], teeth: other, phase: PI + PI / f64::from(other) };
            for step in 0..40 {
                let turn = f64::from(step) * 0.02;
                let first = corners(wheel.outline(), &Pose { at: [0.0; 2], phi: turn });
                let phi = -turn * radii[0] / radii[1];
                let second = corners(facing.outline(), &Pose { at: [radii[0] + radii[1], 0.0], phi });
                let overlap = first.iter().map(|p| depth(*p, &second)).chain(second.iter().map(|p| depth(*p, &first)));
                let deepest = overlap.fold(0.0, f64::max);
                assert!(deepest < 0.02, "{z} and {other}: {deepest} modules at {turn}");
            }
        }
    }

    #[test]
    fn teeth_of_a_wheel_stay_in_the_gaps_of_a_ring() {
        let [z, other] = [12, 36];
        let ring = Wheel { at: [0.0; 2], radius: 18.0, teeth: other, phase: PI / f64::from(other) };
        let wheel = Wheel { at: [0.0; 2], radius: 6.0, teeth: z, phase: 0.0 };
        for step in 0..40 {
            let turn = f64::from(step) * 0.02;
            let first = corners(wheel.outline(), &Pose { at: [12.0, 0.0], phi: turn });
            let gap = corners(ring.inner_outline(), &Pose { at: [0.0; 2], phi: turn / 3.0 });
            // points outside the gaps lie in the ring
            let out = first.iter().filter(|p| !is_inside(**p, &gap)).map(|p| {
                let away = gap.iter().map(|q| super::super::plane::distance(*p, *q)).fold(f64::INFINITY, f64::min);
                away.min(1.0)
            });
            let worst = out.fold(0.0, f64::max);
            assert!(worst < 0.05, "{worst} modules at {turn}");
        }
    }

    #[test]
    fn teeth_of_a_wheel_and_a_rack_do_not_overlap() {
        let wheel = Wheel { at: [0.0; 2], radius: 6.0, teeth: 12, phase: -PI / 2.0 };
        let rack = Rack { at: [0.0; 2], along: [1.0, 0.0], side: 1.0, pitch: PI, phase: 0.5 * PI };
        let teeth = corners(rack.outline([-12.0, 12.0], 2.0), &Pose::default());
        for step in 0..40 {
            let turn = f64::from(step) * 0.02;
            let first = corners(wheel.outline(), &Pose { at: [-turn * 6.0, 6.0], phi: turn });
            let overlap = first.iter().map(|p| depth(*p, &teeth)).chain(teeth.iter().map(|p| depth(*p, &first)));
            let deepest = overlap.fold(0.0, f64::max);
            assert!(deepest < 0.02, "{deepest} modules at {turn}");
        }
    }
}
