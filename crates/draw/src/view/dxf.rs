//! DXF for cutting: traces, profiles, pitch circles and pins, in millimetres.
//!
//! The format is R12, the oldest one that every program reads; it has polylines and points, which is enough. The writer is our own, since
//! the same input must give the same bytes: libraries write the time and identifiers of their own.

use super::text::decimal;
use crate::scene::{
    Anchor, Motion, Path, Pen, Pin, Pose, Scene, Segment, Vector, bounds, direction, distance, is_finite, minus, plus,
    polar, times,
};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Tolerance of a polyline as it is cut (m).
const TOLERANCE: f64 = 0.25e-6;
/// Positions closer than this part of a line's size are one.
const SAME_POSITION: f64 = 1e-9;
/// Limit of halvings of a piece.
const MOST_HALVINGS: u32 = 14;
/// Tolerance of a very small line as a part of its size.
const TOLERANCE_OF_SIZE: f64 = 5e-5;
/// Largest angle of a circle's chord (rad), however small the circle is.
const WIDEST_CHORD: f64 = 0.02;
/// Decimals of millimetres, and of those of a drawing that is at most a millimetre large.
const DECIMALS: usize = 6;
const SMALL_DECIMALS: usize = 9;
/// Length limit of layer names.
const LONGEST_NAME: usize = 31;

/// An entity on the layer of its declaration.
#[derive(Clone, PartialEq, Debug)]
struct Entity {
    layer: String,
    /// Positions (mm).
    positions: Vec<Vector>,
    kind: EntityKind,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum EntityKind {
    Point,
    Open,
    Closed,
}

/// Writes all contours for cutting, with the frames at `poses`, the traces of the scene and those of some named points along the motion,
/// enlarged by `scale`. Returns `None` if there are none.
#[must_use]
pub fn written(
    scene: &Scene,
    motion: &Motion,
    poses: &[Pose],
    traces: &[(String, Anchor)],
    scale: f64,
) -> Option<String> {
    // an enlarged cut needs a smaller tolerance
    let off = TOLERANCE / scale.max(1.0);
    let mut sheet = Sheet { scene, poses, scale: 1000.0 * scale, off, layers: Vec::new(), entities: Vec::new() };
    sheet.add_profiles();
    sheet.add_pitch_lines();
    sheet.add_traces(motion);
    for (name, anchor) in traces {
        let declaration = scene.point_named(name).map_or(anchor.frame, |point| point.declaration);
        if scene.traces.iter().all(|trace| trace.pen != Pen::Point(*anchor)) {
            sheet.add_trace(declaration, &Pen::Point(*anchor), motion);
        }
    }
    sheet.add_pins();
    (!sheet.entities.is_empty()).then(|| sheet.text())
}

struct Sheet<'s> {
    scene: &'s Scene,
    poses: &'s [Pose],
    /// Millimetres per metre.
    scale: f64,
    /// Tolerance of a polyline before it is enlarged (m).
    off: f64,
    /// Declaration and name of each layer.
    layers: Vec<(usize, String)>,
    entities: Vec<Entity>,
}

impl Sheet<'_> {
    /// Adds an entity at positions of the ground (m) on the layer of a declaration.
    fn add(&mut self, declaration: usize, positions: &[Vector], kind: EntityKind) {
        if positions.is_empty() || !positions.iter().all(|position| is_finite(*position)) {
            return;
        }
        let layer = self.layer(declaration);
        let positions = positions.iter().map(|position| times(self.scale, *position)).collect();
        self.entities.push(Entity { layer, positions, kind });
    }

    /// Returns the layer of a declaration. Its name is the declaration's, as far as DXF allows it, and is unique.
    fn layer(&mut self, declaration: usize) -> String {
        if let Some((_, name)) = self.layers.iter().find(|(other, _)| *other == declaration) {
            return name.clone();
        }
        let name = self.scene.declarations.get(declaration).map_or("0", |declaration| &declaration.name);
        let letter = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '$') { c } else { '_' };
        let plain: String = name.chars().map(letter).take(LONGEST_NAME).collect();
        let is_free = |name: &str| !self.layers.iter().any(|(_, other)| other.eq_ignore_ascii_case(name));
        let numbered = |k: usize| {
            let number = format!("-{k}");
            format!("{}{number}", plain.chars().take(LONGEST_NAME - number.len()).collect::<String>())
        };
        let name = if is_free(&plain) {
            plain.clone()
        } else {
            (2..=self.layers.len() + 2).map(numbered).find(|name| is_free(name)).unwrap_or_default()
        };
        self.layers.push((declaration, name.clone()));
        name
    }

    fn add_profiles(&mut self) {
        let scene = self.scene;
        for profile in &scene.profiles {
            let pose = self.poses[profile.frame];
            let mut positions: Vec<Vector> = profile.samples.first().map(|sample| sample.at).into_iter().collect();
            for pair in profile.samples.windows(2) {
                flatten(&mut |part| pair[0].between(&pair[1], part), self.off, &mut positions);
            }
            if profile.is_closed {
                positions.pop();
            }
            let positions: Vec<Vector> = positions.into_iter().map(|position| pose.transform(position)).collect();
            self.add(
                profile.declaration,
                &positions,
                if profile.is_closed { EntityKind::Closed } else { EntityKind::Open },
            );
        }
    }

    fn add_pitch_lines(&mut self) {
        let scene = self.scene;
        for line in &scene.pitch_lines {
            let pose = self.poses[line.frame];
            for (positions, is_closed) in polylines(&line.path, self.off) {
                let positions: Vec<Vector> = positions.into_iter().map(|position| pose.transform(position)).collect();
                self.add(line.declaration, &positions, if is_closed { EntityKind::Closed } else { EntityKind::Open });
            }
        }
    }

    fn add_traces(&mut self, motion: &Motion) {
        let scene = self.scene;
        for trace in &scene.traces {
            self.add_trace(trace.declaration, &trace.pen, motion);
        }
    }

    /// Adds the strokes of a pen; a pen at rest gives a point.
    fn add_trace(&mut self, declaration: usize, pen: &Pen, motion: &Motion) {
        let track = motion.track(pen);
        let position = |t: f64| track.at(motion, t)[0];
        for stretch in motion.strokes(pen) {
            let ends = || stretch.pieces.iter().flatten().map(|t| position(*t));
            let size = bounds(ends()).map_or(0.0, |[low, high]| distance(low, high));
            let off = self.off.min(TOLERANCE_OF_SIZE * size);
            let mut positions: Vec<Vector> = ends().take(1).collect();
            for [from, to] in &stretch.pieces {
                flatten(&mut |part| position(from + part * (to - from)), off, &mut positions);
            }
            // a line that rests for a while has one corner there
            positions.dedup_by(|next, last| distance(*next, *last) <= SAME_POSITION * size);
            if stretch.is_closed && positions.len() > 2 {
                positions.pop();
                self.add(declaration, &positions, EntityKind::Closed);
            } else if positions.len() > 1 {
                self.add(declaration, &positions, EntityKind::Open);
            } else {
                self.add(declaration, &positions, EntityKind::Point);
            }
        }
    }

    fn add_pins(&mut self) {
        let scene = self.scene;
        for point in scene.points.iter().filter(|point| point.is_pin) {
            let position = self.poses[point.frame].transform(point.at);
            self.add(point.declaration, &[position], EntityKind::Point);
        }
        // a joint may use a point that has no name
        let is_named = |pin: &Pin| {
            let named = scene.points.iter().filter(|point| point.is_pin && point.frame == pin.anchor.frame);
            named.map(|point| distance(point.at, pin.anchor.at)).any(|apart| apart <= SAME_POSITION * scene.unit)
        };
        for pin in scene.pins.iter().filter(|pin| !is_named(pin)) {
            self.add(pin.declaration, &[pin.anchor.position(self.poses)], EntityKind::Point);
        }
    }

    /// Writes the whole file.
    fn text(&self) -> String {
        let all = self.entities.iter().flat_map(|entity| entity.positions.iter().copied());
        let [low, high] = bounds(all).unwrap_or_default();
        let decimals = if distance(low, high) > 1.0 { DECIMALS } else { SMALL_DECIMALS };
        let mut text = String::from("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n");
        for (name, position) in [("$EXTMIN", low), ("$EXTMAX", high)] {
            let _ = write!(text, "9\n{name}\n{}", coordinates(position, decimals));
        }
        text += "0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0.0\n\
                 0\nENDTAB\n";
        let _ = write!(text, "0\nTABLE\n2\nLAYER\n70\n{}\n", self.layers.len() + 1);
        for layer in std::iter::once("0").chain(self.layers.iter().map(|(_, name)| name.as_str())) {
            let _ = write!(text, "0\nLAYER\n2\n{layer}\n70\n0\n62\n7\n6\nCONTINUOUS\n");
        }
        text += "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
        self.entities.iter().for_each(|entity| entity.add_to(&mut text, decimals));
        text + "0\nENDSEC\n0\nEOF\n"
    }
}

impl Entity {
    fn add_to(&self, text: &mut String, decimals: usize) {
        let Entity { layer, positions, kind } = self;
        if *kind == EntityKind::Point {
            for position in positions {
                let _ = write!(text, "0\nPOINT\n8\n{layer}\n{}", coordinates(*position, decimals));
            }
            return;
        }
        let flag = u8::from(*kind == EntityKind::Closed);
        let _ = write!(text, "0\nPOLYLINE\n8\n{layer}\n66\n1\n70\n{flag}\n{}", coordinates([0.0; 2], decimals));
        for position in positions {
            let _ = write!(text, "0\nVERTEX\n8\n{layer}\n{}", coordinates(*position, decimals));
        }
        let _ = write!(text, "0\nSEQEND\n8\n{layer}\n");
    }
}

/// Writes a position as group codes.
fn coordinates([x, y]: Vector, decimals: usize) -> String {
    let coordinate = |value: f64| {
        let text = decimal(value, decimals);
        if text.contains('.') { text } else { text + ".0" }
    };
    format!("10\n{}\n20\n{}\n30\n0.0\n", coordinate(x), coordinate(y))
}

/// Adds the positions of a polyline along a line from part 0 to part 1, without the first one.
fn flatten(of: &mut dyn FnMut(f64) -> Vector, off: f64, positions: &mut Vec<Vector>) {
    let (start, end) = (of(0.0), of(1.0));
    halve(of, [(0.0, start), (1.0, end)], off, 0, positions);
}

fn halve(
    of: &mut dyn FnMut(f64) -> Vector,
    ends: [(f64, Vector); 2],
    off: f64,
    depth: u32,
    positions: &mut Vec<Vector>,
) {
    let [(from, start), (to, end)] = ends;
    let at = [0.25, 0.5, 0.75].map(|part| (from + part * (to - from), of(from + part * (to - from))));
    let is_straight = at.iter().all(|(_, position)| from_chord(*position, [start, end]) <= 0.8 * off);
    if is_straight || depth >= MOST_HALVINGS || !is_finite(start) || !is_finite(end) {
        positions.push(end);
        return;
    }
    halve(of, [ends[0], at[1]], off, depth + 1, positions);
    halve(of, [at[1], ends[1]], off, depth + 1, positions);
}

/// Returns the distance of a position from a chord.
fn from_chord(position: Vector, [start, end]: [Vector; 2]) -> f64 {
    let chord = minus(end, start);
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    let along = minus(position, start);
    let part = if square > 0.0 { ((along[0] * chord[0] + along[1] * chord[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(along, times(part, chord))
}

/// Converts a path to polylines within a tolerance (m), each with whether it is closed.
fn polylines(path: &Path, off: f64) -> Vec<(Vec<Vector>, bool)> {
    match path {
        Path::Circle { at, radius } => {
            let count = steps(*radius, TAU, off);
            let position = |k: u32| plus(*at, polar(*radius, TAU * f64::from(k) / f64::from(count)));
            vec![((0..count).map(position).collect(), true)]
        }
        Path::Lines(contours) => contours
            .iter()
            .map(|contour| {
                let mut positions = vec![contour.start];
                let mut from = contour.start;
                for segment in &contour.segments {
                    if let Segment::Arc { to, radius, is_left } = *segment {
                        add_arc(&mut positions, [from, to], radius, is_left, off);
                    } else {
                        positions.push(segment.end());
                    }
                    from = segment.end();
                }
                // a closed polyline has a flag instead of its last position
                if contour.is_closed && positions.len() > 1 && distance(contour.start, from) < off {
                    positions.pop();
                }
                (positions, contour.is_closed)
            })
            .collect(),
    }
}

/// Adds the positions of an arc of at most a semicircle, without the first one.
fn add_arc(positions: &mut Vec<Vector>, [from, to]: [Vector; 2], radius: f64, is_left: bool, off: f64) {
    let (half, sign) = (0.5 * distance(from, to), if is_left { 1.0 } else { -1.0 });
    let chord = minus(to, from);
    let middle = times(0.5, plus(from, to));
    let height = (radius * radius - half * half).max(0.0).sqrt();
    let across = if half > 0.0 { times(sign * height / (2.0 * half), [-chord[1], chord[0]]) } else { [0.0; 2] };
    let center = plus(middle, across);
    let (first, last) = (direction(minus(from, center)), direction(minus(to, center)));
    let turn = (sign * (last - first)).rem_euclid(TAU);
    let count = steps(radius, turn, off);
    for k in 1..count {
        positions.push(plus(center, polar(radius, first + sign * turn * f64::from(k) / f64::from(count))));
    }
    positions.push(to);
}

/// Returns the number of chords of an arc.
fn steps(radius: f64, turn: f64, off: f64) -> u32 {
    let angle_step = (8.0 * off / radius.max(off)).sqrt().min(WIDEST_CHORD);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let count = mechc_expr::math::floor((turn / angle_step).clamp(1.0, 1e5)) as u32 + 1;
    count.max(3)
}

#[cfg(test)]
mod tests {
    use super::{TOLERANCE, flatten, from_chord, polylines};
    use crate::scene::{Path, distance, polar};

    #[test]
    fn circles_and_arcs_keep_to_their_lines() {
        let circle = Path::Circle { at: [1.0, 2.0], radius: 0.05 };
        let arc = Path::arc([1.0, 2.0], 0.05, 0.3, 3.9);
        for (path, expected) in [(circle, true), (arc, false)] {
            let lines = polylines(&path, TOLERANCE);
            let [(positions, is_closed)] = &lines[..] else { panic!("{lines:?}") };
            assert_eq!(*is_closed, expected);
            for pair in positions.windows(2) {
                let middle = [0, 1].map(|part| 0.5 * (pair[0][part] + pair[1][part]));
                assert!((distance(pair[0], [1.0, 2.0]) - 0.05).abs() < 1e-12);
                assert!((distance(middle, [1.0, 2.0]) - 0.05).abs() < 1.01 * TOLERANCE, "{positions:?}");
            }
        }
    }

    #[test]
    fn curves_take_as_many_pieces_as_they_need() {
        let mut positions = vec![[0.1, 0.0]];
        flatten(&mut |part| polar(0.1, 1.5 * part), TOLERANCE, &mut positions);
        assert!((20..=1000).contains(&positions.len()), "{}", positions.len());
        for k in 0..=1000 {
            let position = polar(0.1, 1.5 * f64::from(k) / 1000.0);
            let nearest = positions.windows(2).map(|pair| from_chord(position, [pair[0], pair[1]])).fold(1.0, f64::min);
            assert!(nearest <= TOLERANCE, "{nearest} off");
        }
        let mut straight = vec![[0.0, 0.0]];
        flatten(&mut |part| [part, 2.0 * part], TOLERANCE, &mut straight);
        assert_eq!(straight.len(), 2);
    }
}
