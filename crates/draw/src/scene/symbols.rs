//! Shapes of symbols after ISO 3952, around their own origin, in symbol units.

use super::plane::{Contour, Path, Segment, Vector, left, minus, plus, polar, rectangle, times, unit as normal};
use super::{Look, Shape};
use std::f64::consts::PI;

/// Radius of a pin.
pub(super) const PIN: f64 = 0.34;
/// Half the width of a bar.
pub(super) const BAR: f64 = 0.6;
/// Half the width of a bar with a slot.
pub(super) const SLOTTED_BAR: f64 = 0.82;
/// Half the width of a bar that is not a body.
pub(super) const THIN_BAR: f64 = 0.3;
/// Half the width of a slot.
pub(super) const SLOT: f64 = 0.42;
/// Half the length and half the width of a block.
pub(super) const BLOCK: [f64; 2] = [1.25, 0.78];
/// Half the length and half the inner width of a sleeve.
pub(super) const SLEEVE: [f64; 2] = [1.1, 0.78];
/// Depth of hatching, and the distance of its lines.
const HATCHING: [f64; 2] = [0.5, 0.42];
/// Depth of the ground below a supported pin, and half the width of the support.
const SUPPORT: [f64; 2] = [1.45, 0.9];
/// Length and half the width of an arrow's head.
const HEAD: [f64; 2] = [0.85, 0.34];

/// Symbols of one size.
#[derive(Clone, Copy)]
pub(super) struct Symbols {
    /// Symbol unit (m).
    pub unit: f64,
}

impl Symbols {
    /// Returns a pin that shows a point.
    pub fn pin(self, at: Vector, point: Option<usize>) -> Shape {
        Shape { path: Path::Circle { at, radius: PIN * self.unit }, look: Look::Pin, point }
    }

    /// Returns the support of a pin on the ground with its hatching.
    pub fn foot(self, at: Vector) -> Vec<Shape> {
        let [low, half] = SUPPORT.map(|part| part * self.unit);
        let corner = |x: f64| plus(at, [x, -low]);
        let [from, to] = [corner(-1.45 * half), corner(1.45 * half)];
        vec![
            Shape { path: Path::polygon([at, corner(half), corner(-half)]), look: Look::Support, point: None },
            self.hatching(from, to),
            Shape { path: Path::line([from, to]), look: Look::GroundLine, point: None },
        ]
    }

    /// Returns hatching along a line, to its right.
    pub fn hatching(self, from: Vector, to: Vector) -> Shape {
        let [depth, spacing] = HATCHING.map(|part| part * self.unit);
        let vector = minus(to, from);
        let (along, length) = (normal(vector), super::plane::length(vector));
        let back = minus(times(-depth, left(along)), times(0.7 * depth, along));
        let count = mechc_expr::math::floor((length - 0.7 * depth) / spacing).clamp(1.0, 400.0);
        let step = (length - 0.7 * depth) / count;
        #[allow(clippy::cast_sign_loss)] // clamped
        let strokes = (0..=count as u32).map(|k| {
            let start = plus(from, times(0.7 * depth + f64::from(k) * step, along));
            [start, plus(start, back)]
        });
        Shape { path: Path::strokes(strokes), look: Look::Hatching, point: None }
    }

    /// Returns the edge of the ground with its hatching to the right.
    pub fn edge(self, from: Vector, to: Vector) -> [Shape; 2] {
        [self.hatching(from, to), Shape { path: Path::line([from, to]), look: Look::GroundLine, point: None }]
    }

    /// Returns a block that slides along a direction of length 1.
    pub fn block(self, at: Vector, along: Vector) -> Shape {
        let [half, across] = BLOCK.map(|part| part * self.unit);
        Shape { path: rectangle(at, along, half, across), look: Look::Block, point: None }
    }

    /// Returns the head of an arrow with its tip and its direction of length 1.
    pub fn head(self, tip: Vector, along: Vector) -> Shape {
        let [long, wide] = HEAD.map(|part| part * self.unit);
        let base = minus(tip, times(long, along));
        let side = times(wide, left(along));
        Shape { path: Path::polygon([tip, plus(base, side), minus(base, side)]), look: Look::ArrowHead, point: None }
    }

    /// Returns an arrow, with heads at both ends if it is double.
    pub fn arrow(self, from: Vector, to: Vector, is_double: bool) -> Vec<Shape> {
        let along = normal(minus(to, from));
        let inset = times(0.6 * HEAD[0] * self.unit, along);
        let start = if is_double { plus(from, inset) } else { from };
        let line = Shape { path: Path::line([start, minus(to, inset)]), look: Look::Arrow, point: None };
        let mut shapes = vec![line, self.head(to, along)];
        if is_double {
            shapes.push(self.head(from, times(-1.0, along)));
        }
        shapes
    }

    /// Returns an arrow on an arc around a centre between two directions (rad).
    pub fn arc_arrow(self, at: Vector, radius: f64, from: f64, to: f64, is_double: bool) -> Vec<Shape> {
        let radius = radius * self.unit;
        let sign = if to > from { 1.0 } else { -1.0 };
        // the straight head leans inward by half the angle that it covers
        let angle = HEAD[0] * self.unit / radius;
        let head = |end: f64, sign: f64| {
            let tip = plus(at, polar(radius, end));
            self.head(tip, polar(1.0, end + sign * (0.5 * PI - 0.5 * angle)))
        };
        let start = if is_double { from + 0.6 * sign * angle } else { from };
        let line = Path::arc(at, radius, start, to - 0.6 * sign * angle);
        let mut shapes = vec![Shape { path: line, look: Look::Arrow, point: None }, head(to, sign)];
        if is_double {
            shapes.push(head(from, -sign));
        }
        shapes
    }

    /// Returns the outline of everything within a distance of a segment.
    pub fn stadium(self, from: Vector, to: Vector, reach: f64, look: Look) -> Shape {
        let path = super::plane::around(&super::plane::hull(&[from, to], 1e-3 * self.unit), reach * self.unit);
        Shape { path, look, point: None }
    }

    /// Returns a weld at a position.
    pub fn weld(self, at: Vector) -> Vec<Shape> {
        let half = 0.42 * self.unit;
        vec![Shape { path: rectangle(at, polar(1.0, PI / 4.0), half, half), look: Look::Weld, point: None }]
    }

    /// Returns the axes of a body that has nothing but its frame.
    pub fn cross(self) -> Shape {
        let [x, y] = [[1.4 * self.unit, 0.0], [0.0, 0.9 * self.unit]];
        Shape { path: Path::strokes([[[0.0; 2], x], [[0.0; 2], y]]), look: Look::Cross, point: None }
    }

    /// Returns a spring from 0 to 1 along x, which is stretched between its ends.
    pub fn spring(self, coils: u32) -> Shape {
        self.spring_at(coils, 0.0, [0.0, 1.0])
    }

    /// Returns a spring over a range of x from 0 to 1, offset to the left (m).
    pub fn spring_at(self, coils: u32, offset: f64, [from, to]: [f64; 2]) -> Shape {
        let half = 0.6 * self.unit;
        let along = |part: f64| from + part * (to - from);
        let (begin, end) = (along(0.18), along(0.82));
        let step = (end - begin) / f64::from(2 * coils);
        let zigzag = (0..2 * coils).map(|k| {
            let side = if k % 2 == 0 { half } else { -half };
            [begin + (f64::from(k) + 0.5) * step, offset + side]
        });
        let positions =
            [[from, offset], [begin, offset]].into_iter().chain(zigzag).chain([[end, offset], [to, offset]]);
        Shape { path: Path::line(positions), look: Look::Spring, point: None }
    }

    /// Returns a damper over a range of x from 0 to 1, offset to the left (m), which is stretched between its ends.
    pub fn damper(self, offset: f64, [from, to]: [f64; 2]) -> Shape {
        let half = 0.5 * self.unit;
        let position = |part: f64, across: f64| [from + part * (to - from), offset + across * half];
        let (bottom, piston, rim) = (0.36, 0.52, 0.66);
        let strokes = [
            [position(0.0, 0.0), position(bottom, 0.0)],
            [position(bottom, -1.0), position(bottom, 1.0)],
            [position(bottom, -1.0), position(rim, -1.0)],
            [position(bottom, 1.0), position(rim, 1.0)],
            [position(piston, -0.75), position(piston, 0.75)],
            [position(piston, 0.0), position(1.0, 0.0)],
        ];
        Shape { path: Path::strokes(strokes), look: Look::Spring, point: None }
    }

    /// Returns a cylinder along x from its hinge.
    pub fn cylinder(self, length: f64) -> Shape {
        let half = 0.55 * self.unit;
        Shape {
            path: rectangle([0.5 * length, 0.0], [1.0, 0.0], 0.5 * length, half),
            look: Look::Cylinder,
            point: None,
        }
    }

    /// Returns the rod of a cylinder, which ends at its origin.
    pub fn rod(self, length: f64) -> Shape {
        let half = 0.18 * self.unit;
        Shape { path: rectangle([-0.5 * length, 0.0], [1.0, 0.0], 0.5 * length, half), look: Look::Rod, point: None }
    }

    /// Returns a ring between an inner contour and a circle.
    pub fn ring(inner: Contour, at: Vector, radius: f64, look: Look) -> Shape {
        let half = |to: f64| Segment::Arc { to: plus(at, [to, 0.0]), radius, is_left: true };
        let outer =
            Contour { start: plus(at, [radius, 0.0]), segments: vec![half(-radius), half(radius)], is_closed: true };
        Shape { path: Path::Lines(vec![outer, inner]), look, point: None }
    }
}
