//! Gears, ring gears and racks: all members of a train have one pitch, and their teeth mesh along the whole motion.
//!
//! A gear has a whole number of teeth, so a pitch fits a train only if the radii are in a ratio of whole numbers. Where no pitch fits, or a
//! loop of gears cannot be assembled, only pitch circles are drawn: teeth would not mesh.

use super::drawing::{Drawing, Layer, shape};
use super::features::{Disc, Line};
use super::guides::height;
use super::plane::{Contour, Path, Segment, direction, dot, minus, plus, polar};
use super::symbols::Symbols;
use super::teeth::{DEDENDUM, Rack, Wheel, integer_residual, offset};
use super::{Anchor, Look, PitchLine, Shape};
use mechc_expr::math;
use mechc_lang::model::JointFeature;
use mechc_text::vocabulary::JointSymbol;
use std::f64::consts::{PI, TAU};

/// Number of teeth of the smallest gear of a train, at least and at most.
const TEETH: [u32; 2] = [12, 60];
/// Preferred pitch (symbol units).
const PITCH: f64 = 2.0;
/// Gears with more teeth than this are drawn without teeth.
const MOST_TEETH: f64 = 900.0;
/// Tolerance of a tooth from the middle of its gap (pitches).
const TOLERANCE: f64 = 0.012;
/// Number of rows that are checked for it.
const SAMPLED_ROWS: usize = 60;
/// Gears smaller than this are drawn above bodies (symbol units).
const SMALL: f64 = 2.0;

/// Two members that mesh.
#[derive(Clone, Copy, Debug)]
struct Mesh {
    joint: usize,
    /// Indices in [`Trains::all`].
    members: [usize; 2],
    kind: MeshKind,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum MeshKind {
    External,
    Internal,
    Rack,
}

/// A member with teeth.
#[derive(Clone, Copy, Debug)]
struct Member {
    carrier: JointFeature,
    frame: usize,
    is_ring: bool,
    disc: Option<Disc>,
    line: Option<Line>,
}

/// Teeth of a member: the number of teeth, 0 for a rack, and the position of one of them, as an angle (rad) or a length (m).
#[derive(Clone, Copy, Debug, Default)]
struct Teeth {
    count: u32,
    phase: f64,
}

struct Trains {
    all: Vec<Member>,
    meshes: Vec<Mesh>,
}

pub(super) fn draw(drawing: &mut Drawing) {
    let trains = Trains::new(drawing);
    let mut is_drawn = vec![false; trains.all.len()];
    for first in 0..trains.all.len() {
        if is_drawn[first] {
            continue;
        }
        let train = trains.train_of(first);
        for &member in &train {
            is_drawn[member] = true;
        }
        let (pitch, teeth) =
            trains.fit_pitch(drawing, &train).map_or((None, Vec::new()), |(p, teeth)| (Some(p), teeth));
        for (k, &member) in train.iter().enumerate() {
            let part = &trains.all[member];
            match (part.disc, part.line) {
                (Some(disc), _) => wheel(drawing, part, &disc, teeth.get(k)),
                (_, Some(line)) => trains.rack(drawing, member, &line, pitch.zip(teeth.get(k))),
                _ => {}
            }
        }
    }
    trains.pitch_circles(drawing);
}

impl Trains {
    fn new(drawing: &Drawing) -> Trains {
        let (model, features) = (drawing.features.model, &drawing.features);
        let mut trains = Trains { all: Vec::new(), meshes: Vec::new() };
        for (joint, declared) in model.joints.iter().enumerate() {
            let kind = match declared.spec.symbol {
                JointSymbol::Gear => MeshKind::External,
                JointSymbol::RingGear => MeshKind::Internal,
                JointSymbol::Rack => MeshKind::Rack,
                _ => continue,
            };
            let members = declared.features.map(|carrier| trains.member(features, carrier));
            if kind == MeshKind::Internal {
                let [first, second] = members.map(|member| trains.all[member].disc.map_or(0.0, |disc| disc.radius));
                trains.all[members[usize::from(second > first)]].is_ring = true;
            }
            trains.meshes.push(Mesh { joint, members, kind });
        }
        trains
    }

    fn member(&mut self, features: &super::features::Features, carrier: JointFeature) -> usize {
        if let Some(other) = self.all.iter().position(|other| other.carrier == carrier) {
            return other;
        }
        let disc = carrier.circle().map(|circle| features.circle(circle));
        let line = carrier.axis().map(|axis| features.axis(axis));
        let frame = disc.map(|disc| disc.center.frame).or(line.map(|line| line.frame)).unwrap_or(0);
        self.all.push(Member { carrier, frame, is_ring: false, disc, line });
        self.all.len() - 1
    }

    /// Returns the train of a member: all that mesh with it, directly or through others. Each but the first meshes with an earlier one.
    fn train_of(&self, first: usize) -> Vec<usize> {
        let (mut train, mut next) = (vec![first], 0);
        while let Some(&member) = train.get(next) {
            next += 1;
            for mesh in self.meshes.iter().filter(|mesh| mesh.members.contains(&member)) {
                let other = mesh.members[usize::from(mesh.members[0] == member)];
                if !train.contains(&other) {
                    train.push(other);
                }
            }
        }
        train
    }

    /// Returns a pitch (m) that fits a train, with the teeth of its members.
    fn fit_pitch(&self, drawing: &Drawing, train: &[usize]) -> Option<(f64, Vec<Teeth>)> {
        let radii = || train.iter().filter_map(|&member| self.all[member].disc.map(|disc| disc.radius));
        let smallest = radii().fold(f64::INFINITY, f64::min);
        let [least, most] = TEETH;
        #[allow(clippy::cast_sign_loss)] // clamped
        let preferred =
            (TAU * smallest / (PITCH * drawing.unit)).clamp(f64::from(least), 0.75 * f64::from(most)) as u32;
        // more teeth are better than fewer
        (preferred..=most).chain((least..preferred).rev()).find_map(|fewest| {
            let pitch = TAU * smallest / f64::from(fewest);
            if radii().any(|radius| TAU * radius / pitch > MOST_TEETH) {
                return None;
            }
            let teeth = self.mesh_teeth(drawing, train, pitch);
            (self.largest_deviation(drawing, train, pitch, &teeth) <= TOLERANCE).then_some((pitch, teeth))
        })
    }

    /// Returns the teeth of a train, each member meshing with an earlier one in the first row.
    fn mesh_teeth(&self, drawing: &Drawing, train: &[usize], pitch: f64) -> Vec<Teeth> {
        #[allow(clippy::cast_sign_loss)] // radii are positive, and not large
        let count =
            |member: usize| self.all[member].disc.map_or(0, |disc| math::floor(TAU * disc.radius / pitch + 0.5) as u32);
        let mut teeth: Vec<Teeth> = train.iter().map(|&member| Teeth { count: count(member), phase: 0.0 }).collect();
        for k in 1..train.len() {
            let position = |member: usize| train[..k].iter().position(|other| *other == member);
            let mesh = self.meshes.iter().find(|mesh| {
                let [a, b] = mesh.members;
                (a == train[k] && position(b).is_some()) || (b == train[k] && position(a).is_some())
            });
            let Some(mesh) = mesh else { continue };
            let off = self.deviation(drawing, mesh, train, &teeth, pitch, 0);
            // change of the deviation when the own phase changes by one pitch
            let is_second = mesh.members[1] == train[k];
            let sign = match (mesh.kind, is_second) {
                (MeshKind::External, _) | (MeshKind::Internal, false) => 1.0,
                (MeshKind::Internal | MeshKind::Rack, true) => -1.0,
                (MeshKind::Rack, false) => self.side(drawing, mesh, 0),
            };
            let step = if teeth[k].count == 0 { pitch } else { TAU / f64::from(teeth[k].count) };
            teeth[k].phase = -sign * off * step;
        }
        teeth
    }

    /// Returns on which side of a rack its pinion lies: 1 for the left, −1 for the right.
    fn side(&self, drawing: &Drawing, mesh: &Mesh, row: usize) -> f64 {
        let [wheel, rack] = mesh.members.map(|member| &self.all[member]);
        match (wheel.disc, rack.line) {
            (Some(disc), Some(line)) if height(&line, drawing.position_in(disc.center, line.frame, row)) < 0.0 => -1.0,
            _ => 1.0,
        }
    }

    /// Returns the deviation of a tooth from the middle of its gap in a row (pitches).
    fn deviation(
        &self,
        drawing: &Drawing,
        mesh: &Mesh,
        train: &[usize],
        teeth: &[Teeth],
        pitch: f64,
        row: usize,
    ) -> f64 {
        let poses = drawing.motion.poses(row);
        let teeth_of = |member: usize| {
            train.iter().position(|other| *other == member).map_or_else(Teeth::default, |position| teeth[position])
        };
        let wheel = |member: usize| {
            let part = &self.all[member];
            let Teeth { count, phase } = teeth_of(member);
            let disc = part.disc?;
            let position = disc.center.position(poses);
            let wheel = Wheel { at: position, radius: disc.radius, teeth: count.max(1), phase };
            Some((wheel, poses[part.frame].phi))
        };
        let [first, second] = mesh.members;
        let Some((a, turn_a)) = wheel(first) else { return 0.0 };
        let sum = match (mesh.kind, wheel(second)) {
            (MeshKind::External, Some((b, turn_b))) => {
                let angle = direction(minus(b.at, a.at));
                offset(&a, turn_a, angle) + offset(&b, turn_b, angle + PI)
            }
            (MeshKind::Internal, Some((b, turn_b))) => {
                let angle = direction(minus(b.at, a.at));
                let angle = if a.radius < b.radius { angle + PI } else { angle };
                offset(&a, turn_a, angle) - offset(&b, turn_b, angle)
            }
            _ => {
                let rack = &self.all[second];
                let Some(line) = rack.line else { return 0.0 };
                let side = self.side(drawing, mesh, row);
                let foot = dot(line.along, minus(poses[line.frame].inverse_transform(a.at), line.at));
                let angle = direction(poses[line.frame].rotate(line.along)) - side * 0.5 * PI;
                (foot - teeth_of(second).phase) / pitch + side * offset(&a, turn_a, angle)
            }
        };
        integer_residual(sum - 0.5)
    }

    /// Returns the largest deviation of a train along the motion.
    fn largest_deviation(&self, drawing: &Drawing, train: &[usize], pitch: f64, teeth: &[Teeth]) -> f64 {
        let meshes = || self.meshes.iter().filter(|mesh| train.contains(&mesh.members[0]));
        let rows = drawing.motion.sampled(SAMPLED_ROWS);
        rows.flat_map(|row| meshes().map(move |mesh| self.deviation(drawing, mesh, train, teeth, pitch, row).abs()))
            .fold(0.0, f64::max)
    }

    fn rack(&self, drawing: &mut Drawing, member: usize, line: &Line, teeth: Option<(f64, &Teeth)>) {
        let Some(mesh) = self.meshes.iter().find(|mesh| mesh.members[1] == member) else { return };
        let Some(disc) = self.all[mesh.members[0]].disc else { return };
        let range = drawing.range_on(line, disc.center);
        let side = self.side(drawing, mesh, 0);
        let pitch = teeth.map_or(TAU * disc.radius / 12.0, |(pitch, _)| pitch);
        let [from, to] = [range[0] - 2.0 * pitch, range[1] + 2.0 * pitch];
        let declaration = line.frame;
        let outline = if let Some((pitch, teeth)) = teeth {
            let rack = Rack { at: line.at, along: line.along, side, pitch, phase: teeth.phase };
            rack.outline([from, to], 0.5 * pitch)
        } else {
            let position = |x: f64, y: f64| {
                plus(plus(line.at, super::times(x, line.along)), super::times(side * y, super::left(line.along)))
            };
            let corners =
                [position(from, 0.0), position(to, 0.0), position(to, -0.5 * pitch), position(from, -0.5 * pitch)];
            let segments = corners[1..].iter().map(|corner| Segment::Line(*corner)).collect();
            Contour { start: corners[0], segments, is_closed: true }
        };
        let layer = if line.frame == 0 { Layer::Ground } else { Layer::Slots };
        let path = Path::Lines(vec![outline]);
        let ends = [from, to].map(|along| plus(line.at, super::times(along, line.along)));
        drawing.pitch_lines.push(PitchLine { declaration, frame: line.frame, path: Path::line(ends) });
        drawing.add_fixed(layer, declaration, line.frame, vec![shape(Look::Rack, path)]);
        drawing.outlines[line.frame].is_shown = true;
    }

    /// Draws the pitch circles and pitch lines of all joints, each at least once.
    fn pitch_circles(&self, drawing: &mut Drawing) {
        let mut is_drawn = vec![false; self.all.len()];
        for mesh in &self.meshes {
            let declaration = drawing.first.joints + mesh.joint;
            for (k, &member) in mesh.members.iter().enumerate() {
                if std::mem::replace(&mut is_drawn[member], true) && k > 0 {
                    continue;
                }
                let part = &self.all[member];
                if let Some(disc) = part.disc {
                    let circle = shape(Look::Pitch, Path::Circle { at: disc.center.at, radius: disc.radius });
                    drawing.add_fixed(Layer::Slots, declaration, part.frame, vec![circle]);
                } else if let Some(line) = part.line
                    && let Some(other) = self.all[mesh.members[0]].disc
                {
                    let ends = drawing.range_on(&line, other.center);
                    let ends = ends.map(|along| plus(line.at, super::times(along, line.along)));
                    drawing.add_fixed(
                        Layer::Slots,
                        declaration,
                        part.frame,
                        vec![shape(Look::Pitch, Path::line(ends))],
                    );
                }
            }
        }
    }
}

/// Draws a gear or ring gear; without teeth it is a disc with a mark that makes its rotation visible.
fn wheel(drawing: &mut Drawing, part: &Member, disc: &Disc, teeth: Option<&Teeth>) {
    let (unit, at, radius) = (drawing.unit, disc.center.at, disc.radius);
    let shapes: Vec<Shape> = match teeth {
        Some(teeth) => {
            let wheel = Wheel { at, radius, teeth: teeth.count, phase: teeth.phase };
            if part.is_ring {
                let rim = radius + DEDENDUM * wheel.module() + (1.2 * wheel.module()).max(0.6 * unit).min(0.2 * radius);
                vec![Symbols::ring(wheel.inner_outline(), at, rim, Look::Gear)]
            } else {
                vec![shape(Look::Gear, Path::Lines(vec![wheel.outline()]))]
            }
        }
        None if part.is_ring => {
            let half = |to: f64| Segment::Arc { to: plus(at, [to, 0.0]), radius, is_left: true };
            let start = plus(at, [radius, 0.0]);
            let inner = Contour { start, segments: vec![half(-radius), half(radius)], is_closed: true };
            vec![Symbols::ring(inner, at, radius + (0.8 * unit).min(0.2 * radius), Look::Gear)]
        }
        None => disc_with_mark(disc),
    };
    add_wheel(drawing, disc, shapes, part.is_ring);
}

/// Draws a wheel without teeth.
pub(super) fn disc(drawing: &mut Drawing, disc: &Disc) {
    add_wheel(drawing, disc, disc_with_mark(disc), false);
}

/// Returns a disc with a mark that makes its rotation visible.
fn disc_with_mark(&Disc { center: Anchor { at, .. }, radius }: &Disc) -> Vec<Shape> {
    let mark = [plus(at, polar(0.55 * radius, 0.0)), plus(at, polar(0.95 * radius, 0.0))];
    vec![shape(Look::Gear, Path::Circle { at, radius }), shape(Look::Pitch, Path::line(mark))]
}

fn add_wheel(drawing: &mut Drawing, disc: &Disc, shapes: Vec<Shape>, is_ring: bool) {
    let (Anchor { frame, at }, radius) = (disc.center, disc.radius);
    let path = Path::Circle { at, radius };
    drawing.pitch_lines.push(PitchLine { declaration: frame, frame, path });
    let layer = match frame {
        0 => Layer::Ground,
        _ if radius < SMALL * drawing.unit => Layer::Slots,
        _ => Layer::Wheels,
    };
    drawing.add_fixed(layer, frame, frame, shapes);
    let outline = &mut drawing.outlines[frame];
    outline.is_shown = true;
    if !is_ring {
        outline.discs.push((at, radius));
    }
}
