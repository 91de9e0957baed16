//! Marks of faults: arrows for free motions, gaps of open joints, and rings around what messages name.

use super::features::{Features, Line};
use super::lengths::{self, Length};
use super::plane::{Path, Pose, Vector, cross, distance, dot, left, length, minus, plus, times, unit as normal};
use super::symbols::Symbols;
use super::{Anchor, Look, Motion, Node, Place, Scene, Shape, whole};
use mechc_lang::model::{EquationForm, JointKind, Mechanism};
use std::f64::consts::PI;

/// Distance of the halves of an open joint (symbol units), and of one in the pose as drawn.
const OPEN: f64 = 0.5;
const DRAWN_APART: f64 = 4.0;
/// Radius of a ring around what messages name, and of those around the halves of an open joint (symbol units).
const RING: f64 = 1.0;
const HALF_RING: f64 = 0.62;
/// Distance from a body's pole within which a position of the body is taken for the pole (symbol units).
const NEAR: f64 = 1.0;
/// Arrows closer than this are concentric (symbol units).
const SAME_PLACE: f64 = 2.5;
/// Distance of the pole (symbol units) from which on a rotation counts as a translation.
const FAR: f64 = 1e4;
/// Length of a straight arrow, its offset along its direction if a symbol is in its place, and its offset from a parallel arrow (symbol
/// units).
const STRAIGHT: f64 = 3.4;
const BEHIND_SYMBOL: f64 = 1.5;
const BESIDE: f64 = 1.3;
/// Start and end of the arrow around a position (rad), its radius, and the step to the next one around it (symbol units).
const TURN: [f64; 2] = [0.1 * PI, 0.9 * PI];
const RADIUS: [f64; 2] = [2.1, 0.8];
/// Number of free motions that are shown at most.
const MOST: usize = 12;
/// Relative difference below which velocities are equal.
const SAME: f64 = 1e-6;

/// Faults of a mechanism that can be drawn.
#[derive(Clone, Debug, Default)]
pub struct Faults {
    /// Declarations that messages name.
    pub named: Vec<usize>,
    /// Free motions: for each the moving frames with their velocities [m, rad], in a common scale.
    pub free: Vec<Vec<(usize, Pose)>>,
    /// State of the joints.
    pub joints: Joints,
    /// Lengths that prevent the assembly.
    pub lengths: Vec<Length>,
}

/// State of a mechanism's joints.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Joints {
    /// All joints are closed.
    #[default]
    Closed,
    /// Joints are as drawn, more or less closed.
    Drawn,
    /// Joints are as nearly closed as possible.
    Open,
}

pub(super) fn add(scene: &mut Scene, model: &Mechanism, motion: &Motion, faults: &Faults) {
    let features = Features::of(model);
    let (joints, equations) = whole::first_of_joints_and_equations(model);
    let poses = motion.poses(0);
    let mut marks = Marks { unit: scene.unit, features, poses, joints, equations, nodes: Vec::new() };
    let open = match faults.joints {
        Joints::Closed => Vec::new(),
        Joints::Drawn => marks.gaps(DRAWN_APART),
        Joints::Open => marks.gaps(OPEN),
    };
    for &declaration in faults.named.iter().filter(|declaration| !open.contains(declaration)) {
        marks.ring(declaration);
    }
    let arrows = scene.nodes.iter().filter(|node| node.shapes.iter().any(|shape| shape.look == Look::Arrow));
    let taken = arrows.filter_map(|node| match node.place {
        Place::Upright(anchor) => Some(anchor.placed(poses)),
        _ => None,
    });
    Arrows { taken: taken.collect(), straight: Vec::new(), places: places(&marks.features, motion) }
        .add(&mut marks, &faults.free);
    let Marks { nodes, features, .. } = marks;
    scene.nodes.extend(nodes);
    let blamed = lengths::Blamed { features: &features, poses, joints, equations };
    blamed.add(scene, &faults.lengths);
    scene.named.clone_from(&faults.named);
    scene.extent = whole::extent(&scene.nodes, motion, scene.unit);
}

/// Returns the positions by frame that joints use; for a frame without any its named points, or its origin.
fn places(features: &Features, motion: &Motion) -> Vec<Vec<Vector>> {
    let model = features.model;
    let mut places = vec![Vec::new(); motion.frames().max(1)];
    for Anchor { frame, at } in whole::places_of_bodies(model).into_iter().map(|id| features.point(id)) {
        places[frame].push(at);
    }
    let is_empty: Vec<bool> = places.iter().map(Vec::is_empty).collect();
    for point in model.points.iter().filter(|point| point.name.is_some()) {
        let Anchor { frame, at } = features.placed(point.frame, point.at.map(|part| features.value(part)));
        if is_empty[frame] {
            places[frame].push(at);
        }
    }
    for of_frame in &mut places {
        of_frame.retain(|at| super::is_finite(*at));
        if of_frame.is_empty() {
            of_frame.push([0.0; 2]);
        }
    }
    places
}

/// Marks under construction.
struct Marks<'m> {
    unit: f64,
    features: Features<'m>,
    poses: &'m [Pose],
    /// Indices of the declarations of the first joint and of the first equation.
    joints: usize,
    equations: usize,
    nodes: Vec<Node>,
}

impl Marks<'_> {
    fn symbols(&self) -> Symbols {
        Symbols { unit: self.unit }
    }

    /// Marks the joints that are open by more than `least` symbol units, and returns their declarations.
    fn gaps(&mut self, least: f64) -> Vec<usize> {
        let model = self.features.model;
        let of_joints = model.joints.iter().enumerate().map(|(number, _)| (self.joints + number, self.halves(number)));
        let of_lengths = model.equations.iter().enumerate().map(|(number, equation)| {
            let halves = match equation.form {
                EquationForm::Distance(p, q, wanted) if !equation.driver => {
                    self.end_of_link([self.features.point(p), self.features.point(q)], self.features.value(wanted))
                }
                _ => None,
            };
            (self.equations + number, halves)
        });
        let halves: Vec<(usize, Option<[Vector; 2]>)> = of_joints.chain(of_lengths).collect();
        let mut open = Vec::new();
        for (declaration, halves) in halves {
            let is_open = |[from, to]: &[Vector; 2]| distance(*from, *to) > least * self.unit;
            let Some([from, to]) = halves.filter(is_open) else { continue };
            let ring = |at| Shape {
                path: Path::Circle { at, radius: HALF_RING * self.unit },
                look: Look::GapEnd,
                point: None,
            };
            let way = times(HALF_RING * self.unit, normal(minus(to, from)));
            let mut shapes = vec![ring(from), ring(to)];
            if distance(from, to) > 2.0 * length(way) {
                let line = Path::line([plus(from, way), minus(to, way)]);
                shapes.push(Shape { path: line, look: Look::Gap, point: None });
            }
            self.nodes.push(Node { declaration, place: Place::Fixed(0), shapes });
            open.push(declaration);
        }
        open
    }

    /// Returns the two positions that a joint brings together, or `None` if it does not join positions.
    fn halves(&self, number: usize) -> Option<[Vector; 2]> {
        let (features, model) = (&self.features, self.features.model);
        let joint = &model.joints[number];
        let found = match joint.kind {
            JointKind::Revolute(p, q) | JointKind::Weld(p, q, _) => {
                [p, q].map(|point| features.point(point).placed(self.poses))
            }
            JointKind::RevoluteRevolute(p, q, wanted) => {
                self.end_of_link([features.point(p), features.point(q)], features.value(wanted))?
            }
            JointKind::Translational(a, b) => {
                let [first, second] = [a, b].map(|axis| features.axis(axis));
                let (guide, slider) = if second.frame == 0 { (second, first) } else { (first, second) };
                self.beside_line(Anchor { frame: slider.frame, at: slider.at }, &guide, 0.0)
            }
            JointKind::RevoluteTranslational(p, axis, offset) => {
                let offset = features.value(offset);
                let offset = if model.is_mirrored(joint.part) { -offset } else { offset };
                self.beside_line(features.point(p), &features.axis(axis), offset)
            }
            _ => return None,
        };
        found.iter().all(|place| super::is_finite(*place)).then_some(found)
    }

    /// Returns where a massless link of a length ends, and where it should end.
    fn end_of_link(&self, [p, q]: [Anchor; 2], wanted: f64) -> Option<[Vector; 2]> {
        let [from, to] = [p, q].map(|anchor| anchor.placed(self.poses));
        wanted.is_finite().then(|| [plus(from, times(wanted, normal(minus(to, from)))), to])
    }

    /// Returns a position, and the nearest one on a line at an offset to the left.
    fn beside_line(&self, of: Anchor, line: &Line, offset: f64) -> [Vector; 2] {
        let pose = &self.poses[line.frame];
        let (at, along) = (pose.placed(plus(line.at, times(offset, left(line.along)))), pose.turned(line.along));
        let place = of.placed(self.poses);
        [place, plus(at, times(dot(along, minus(place, at)), along))]
    }

    /// Adds a ring around a joint.
    fn ring(&mut self, declaration: usize) {
        let model = self.features.model;
        let joint = declaration.checked_sub(self.joints).and_then(|number| model.joints.get(number));
        let points = joint.map_or_else(Vec::new, |joint| joint.kind.points(model));
        let anchors: Vec<Anchor> = points.into_iter().map(|point| self.features.point(point)).collect();
        let Some(anchor) = anchors.iter().find(|anchor| anchor.frame > 0).or(anchors.first()) else { return };
        let path = Path::Circle { at: anchor.at, radius: RING * self.unit };
        let shapes = vec![Shape { path, look: Look::Named, point: None }];
        self.nodes.push(Node { declaration, place: Place::Fixed(anchor.frame), shapes });
    }
}

/// Arrows under construction.
struct Arrows {
    /// Positions of arrows that turn.
    taken: Vec<Vector>,
    /// Start and direction of straight arrows.
    straight: Vec<(Vector, Vector)>,
    /// Positions by frame.
    places: Vec<Vec<Vector>>,
}

impl Arrows {
    fn add(mut self, marks: &mut Marks, free: &[Vec<(usize, Pose)>]) {
        let free: Vec<Vec<(usize, Pose)>> = free.iter().map(|motion| each_once(motion, marks)).take(MOST).collect();
        for motion in &free {
            for &(frame, velocity) in motion {
                if is_loose(&free, frame) {
                    self.add_loose(marks, frame, velocity);
                } else {
                    self.add_one(marks, frame, velocity);
                }
            }
        }
    }

    /// Returns the middle of a frame's positions, in the frame.
    fn middle(&self, frame: usize) -> Vector {
        let [low, high] = super::bounds(self.places[frame].iter().copied()).unwrap_or_default();
        times(0.5, plus(low, high))
    }

    /// Adds the arrow of an unconstrained body: it turns about its middle as well as about any other position.
    fn add_loose(&mut self, marks: &mut Marks, frame: usize, velocity: Pose) {
        let middle = Anchor { frame, at: self.middle(frame) };
        if velocity.phi.abs() > 0.0 {
            self.add_turning(marks, middle, velocity.phi);
        } else {
            self.add_straight(marks, middle, velocity.at);
        }
    }

    fn add_one(&mut self, marks: &mut Marks, frame: usize, velocity: Pose) {
        let pose = marks.poses[frame];
        let middle = Anchor { frame, at: self.middle(frame) };
        let speed = velocity.velocity(&pose, middle.at);
        let turns = velocity.phi.abs() * FAR * marks.unit > length(speed);
        if turns {
            // pole of the velocities
            let pole = pose.located(plus(pose.at, times(1.0 / velocity.phi, left(velocity.at))));
            let places = self.places[frame].iter().copied().chain([middle.at]);
            let nearest = places.min_by(|a, b| distance(*a, pole).total_cmp(&distance(*b, pole)));
            if let Some(at) = nearest.filter(|at| distance(*at, pole) < NEAR * marks.unit) {
                self.add_turning(marks, Anchor { frame, at }, velocity.phi);
                return;
            }
        }
        self.add_straight(marks, middle, speed);
    }

    fn add_turning(&mut self, marks: &mut Marks, at: Anchor, turn: f64) {
        let place = at.placed(marks.poses);
        let count = self.taken.iter().filter(|known| distance(**known, place) < SAME_PLACE * marks.unit).count();
        self.taken.push(place);
        let [from, to] = if turn > 0.0 { TURN } else { [TURN[1], TURN[0]] };
        let shapes = marks.symbols().turning([0.0; 2], RADIUS[0] + RADIUS[1] * count as f64, from, to, false);
        marks.nodes.push(free(at, shapes));
    }

    fn add_straight(&mut self, marks: &mut Marks, at: Anchor, speed: Vector) {
        let (unit, along) = (marks.unit, normal(speed));
        let is_busy = self.places[at.frame].iter().any(|place| distance(*place, at.at) < unit);
        let place = at.placed(marks.poses);
        let is_parallel = |other: Vector| cross(along, other).abs() < 0.3;
        let near = |known: &&(Vector, Vector)| distance(known.0, place) < unit && is_parallel(known.1);
        let count = self.straight.iter().filter(near).count();
        self.straight.push((place, along));
        let begin = if is_busy { BEHIND_SYMBOL } else { 0.0 };
        let beside = times(BESIDE * unit * count as f64, left(along));
        let [from, to] = [begin, begin + STRAIGHT].map(|part| plus(beside, times(part * unit, along)));
        let shapes = marks.symbols().arrow(from, to, false);
        marks.nodes.push(free(at, shapes));
    }
}

/// Returns the node of a free motion's arrow, which belongs to the body.
fn free(at: Anchor, mut shapes: Vec<Shape>) -> Node {
    for shape in &mut shapes {
        shape.look = if shape.look == Look::ArrowHead { Look::FreeHead } else { Look::Free };
    }
    Node { declaration: at.frame, place: Place::Upright(at), shapes }
}

/// Returns one frame for each group of frames that move as one.
fn each_once(motion: &[(usize, Pose)], marks: &Marks) -> Vec<(usize, Pose)> {
    let mut told: Vec<(usize, Pose, Vector)> = Vec::new();
    for &(frame, velocity) in motion.iter().filter(|(frame, _)| *frame < marks.poses.len()) {
        // velocity of the position that coincides with the ground's origin
        let common = velocity.velocity(&marks.poses[frame], marks.poses[frame].located([0.0; 2]));
        let is_same = |other: &(usize, Pose, Vector)| {
            let size = length(common) + velocity.phi.abs() * marks.unit;
            let off = distance(other.2, common) + (other.1.phi - velocity.phi).abs() * marks.unit;
            off <= SAME * size
        };
        if !told.iter().any(is_same) {
            told.push((frame, velocity, common));
        }
    }
    told.into_iter().map(|(frame, velocity, _)| (frame, velocity)).collect()
}

/// Returns whether a frame has three free motions of its own.
fn is_loose(free: &[Vec<(usize, Pose)>], frame: usize) -> bool {
    free.iter().filter(|motion| matches!(motion.as_slice(), [(only, _)] if *only == frame)).count() == 3
}
