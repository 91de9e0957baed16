//! Marks of faults: arrows for free motions, gaps of open joints, and rings around what messages name.

use super::features::{Features, Line};
use super::length_marks::{self, Length};
use super::plane::{Path, Pose, Vector, cross, distance, dot, left, length, minus, plus, times, unit as normal};
use super::symbols::Symbols;
use super::{Anchor, Attachment, Look, Motion, Node, Scene, Shape, builder};
use mechc_lang::model::{
    EquationForm,
    JointFeature::{Axis, Point},
    Mechanism,
};
use std::f64::consts::PI;

/// Distance of the halves of an open joint (symbol units), and of one in the pose as drawn.
const OPEN: f64 = 0.5;
const OPEN_AS_DRAWN: f64 = 4.0;
/// Radius of a ring around what messages name, and of those around the halves of an open joint (symbol units).
const RING: f64 = 1.0;
const HALF_RING: f64 = 0.62;
/// Distance from a body's pole within which a position of the body is taken for the pole (symbol units).
const NEAR_POLE: f64 = 1.0;
/// Arrows closer than this are concentric (symbol units).
const CONCENTRIC: f64 = 2.5;
/// Distance of the pole (symbol units) from which on a rotation counts as a translation.
const FAR: f64 = 1e4;
/// Length of a straight arrow, its offset along its direction if a symbol is in its place, and its offset from a parallel arrow (symbol
/// units).
const STRAIGHT: f64 = 3.4;
const SYMBOL_OFFSET: f64 = 1.5;
const PARALLEL_OFFSET: f64 = 1.3;
/// Start and end of the arrow around a position (rad), its radius, and the step to the next one around it (symbol units).
const TURN: [f64; 2] = [0.1 * PI, 0.9 * PI];
const RADIUS: [f64; 2] = [2.1, 0.8];
/// Number of free motions that are shown at most.
const MOST_MOTIONS: usize = 12;
/// Relative difference below which velocities are equal.
const SAME_VELOCITY: f64 = 1e-6;

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
    let features = Features::new(model);
    let (joints, equations) = builder::first_declarations(model);
    let poses = motion.poses(0);
    let mut marks = Marks { unit: scene.unit, features, poses, joints, equations, nodes: Vec::new() };
    let open = match faults.joints {
        Joints::Closed => Vec::new(),
        Joints::Drawn => marks.gaps(OPEN_AS_DRAWN),
        Joints::Open => marks.gaps(OPEN),
    };
    for &declaration in faults.named.iter().filter(|declaration| !open.contains(declaration)) {
        marks.ring(declaration);
    }
    let arrows = scene.nodes.iter().filter(|node| node.shapes.iter().any(|shape| shape.look == Look::Arrow));
    let occupied = arrows.filter_map(|node| match node.attachment {
        Attachment::Upright(anchor) => Some(anchor.position(poses)),
        _ => None,
    });
    Arrows { occupied: occupied.collect(), straight: Vec::new(), positions: positions(&marks.features, motion) }
        .add(&mut marks, &faults.free);
    let Marks { nodes, features, .. } = marks;
    scene.nodes.extend(nodes);
    let marks = length_marks::LengthMarks { features: &features, poses, joints, equations };
    marks.add(scene, &faults.lengths);
    scene.named.clone_from(&faults.named);
    scene.extent = builder::extent(&scene.nodes, motion, scene.unit);
}

/// Returns the positions by frame that joints use; for a frame without any its named points, or its origin.
fn positions(features: &Features, motion: &Motion) -> Vec<Vec<Vector>> {
    let model = features.model;
    let mut positions = vec![Vec::new(); motion.frames().max(1)];
    for Anchor { frame, at } in builder::shape_points(model).into_iter().map(|id| features.point(id)) {
        positions[frame].push(at);
    }
    let is_empty: Vec<bool> = positions.iter().map(Vec::is_empty).collect();
    for point in model.points.iter().filter(|point| point.name.is_some()) {
        let Anchor { frame, at } = features.resolve(point.frame, point.at.map(|part| features.value(part)));
        if is_empty[frame] {
            positions[frame].push(at);
        }
    }
    for list in &mut positions {
        list.retain(|at| super::is_finite(*at));
        if list.is_empty() {
            list.push([0.0; 2]);
        }
    }
    positions
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
        let joints = model.joints.iter().enumerate().map(|(number, _)| (self.joints + number, self.halves(number)));
        let lengths = model.equations.iter().enumerate().map(|(number, equation)| {
            let halves = match equation.form {
                EquationForm::Distance(p, q, length) if !equation.driver => {
                    self.link_gap([self.features.point(p), self.features.point(q)], self.features.value(length))
                }
                _ => None,
            };
            (self.equations + number, halves)
        });
        let halves: Vec<(usize, Option<[Vector; 2]>)> = joints.chain(lengths).collect();
        let mut open = Vec::new();
        for (declaration, halves) in halves {
            let is_open = |[from, to]: &[Vector; 2]| distance(*from, *to) > least * self.unit;
            let Some([from, to]) = halves.filter(is_open) else { continue };
            let ring = |at| Shape {
                path: Path::Circle { at, radius: HALF_RING * self.unit },
                look: Look::GapEnd,
                point: None,
            };
            let inset = times(HALF_RING * self.unit, normal(minus(to, from)));
            let mut shapes = vec![ring(from), ring(to)];
            if distance(from, to) > 2.0 * length(inset) {
                let line = Path::line([plus(from, inset), minus(to, inset)]);
                shapes.push(Shape { path: line, look: Look::Gap, point: None });
            }
            self.nodes.push(Node { declaration, attachment: Attachment::Fixed(0), shapes });
            open.push(declaration);
        }
        open
    }

    /// Returns the two positions that a joint brings together, or `None` if it does not join positions.
    fn halves(&self, number: usize) -> Option<[Vector; 2]> {
        let (features, model) = (&self.features, self.features.model);
        let joint = &model.joints[number];
        let value = features.signed_value(joint);
        let ends = match joint.features {
            [Point(p), Point(q)] => {
                let ends = [p, q].map(|point| features.point(point));
                if joint.spec.holds_distance() {
                    self.link_gap(ends, value.abs())?
                } else {
                    ends.map(|end| end.position(self.poses))
                }
            }
            [Axis(a), Axis(b)] => {
                let [first, second] = [a, b].map(|axis| features.axis(axis));
                let (guide, slider) = if second.frame == 0 { (second, first) } else { (first, second) };
                self.offset_gap(Anchor { frame: slider.frame, at: slider.at }, &guide, 0.0)
            }
            [Point(p), Axis(axis)] => self.offset_gap(features.point(p), &features.axis(axis), value),
            _ => return None,
        };
        ends.iter().all(|position| super::is_finite(*position)).then_some(ends)
    }

    /// Returns where a massless link of a length ends, and where it should end.
    fn link_gap(&self, [p, q]: [Anchor; 2], length: f64) -> Option<[Vector; 2]> {
        let [from, to] = [p, q].map(|anchor| anchor.position(self.poses));
        length.is_finite().then(|| [plus(from, times(length, normal(minus(to, from)))), to])
    }

    /// Returns a position, and the nearest one on a line at an offset to the left.
    fn offset_gap(&self, anchor: Anchor, line: &Line, offset: f64) -> [Vector; 2] {
        let pose = &self.poses[line.frame];
        let (at, along) = (pose.transform(plus(line.at, times(offset, left(line.along)))), pose.rotate(line.along));
        let position = anchor.position(self.poses);
        [position, plus(at, times(dot(along, minus(position, at)), along))]
    }

    /// Adds a ring around a joint.
    fn ring(&mut self, declaration: usize) {
        let model = self.features.model;
        let joint = declaration.checked_sub(self.joints).and_then(|number| model.joints.get(number));
        let points = joint.map_or_else(Vec::new, |joint| joint.points(model));
        let anchors: Vec<Anchor> = points.into_iter().map(|point| self.features.point(point)).collect();
        let Some(anchor) = anchors.iter().find(|anchor| anchor.frame > 0).or(anchors.first()) else { return };
        let path = Path::Circle { at: anchor.at, radius: RING * self.unit };
        let shapes = vec![Shape { path, look: Look::Named, point: None }];
        self.nodes.push(Node { declaration, attachment: Attachment::Fixed(anchor.frame), shapes });
    }
}

/// Arrows under construction.
struct Arrows {
    /// Positions of arrows that turn.
    occupied: Vec<Vector>,
    /// Start and direction of straight arrows.
    straight: Vec<(Vector, Vector)>,
    /// Positions by frame.
    positions: Vec<Vec<Vector>>,
}

impl Arrows {
    fn add(mut self, marks: &mut Marks, free: &[Vec<(usize, Pose)>]) {
        let free: Vec<Vec<(usize, Pose)>> =
            free.iter().map(|motion| distinct_velocities(motion, marks)).take(MOST_MOTIONS).collect();
        for motion in &free {
            for &(frame, velocity) in motion {
                if is_unconstrained(&free, frame) {
                    self.add_unconstrained(marks, frame, velocity);
                } else {
                    self.add_motion(marks, frame, velocity);
                }
            }
        }
    }

    /// Returns the middle of a frame's positions, in the frame.
    fn middle(&self, frame: usize) -> Vector {
        let [low, high] = super::bounds(self.positions[frame].iter().copied()).unwrap_or_default();
        times(0.5, plus(low, high))
    }

    /// Adds the arrow of an unconstrained body: it turns about its middle as well as about any other position.
    fn add_unconstrained(&mut self, marks: &mut Marks, frame: usize, velocity: Pose) {
        let middle = Anchor { frame, at: self.middle(frame) };
        if velocity.phi.abs() > 0.0 {
            self.add_arc(marks, middle, velocity.phi);
        } else {
            self.add_straight(marks, middle, velocity.at);
        }
    }

    fn add_motion(&mut self, marks: &mut Marks, frame: usize, velocity: Pose) {
        let pose = marks.poses[frame];
        let middle = Anchor { frame, at: self.middle(frame) };
        let speed = velocity.velocity(&pose, middle.at);
        let is_rotation = velocity.phi.abs() * FAR * marks.unit > length(speed);
        if is_rotation {
            // pole of the velocities
            let pole = pose.inverse_transform(plus(pose.at, times(1.0 / velocity.phi, left(velocity.at))));
            let positions = self.positions[frame].iter().copied().chain([middle.at]);
            let nearest = positions.min_by(|a, b| distance(*a, pole).total_cmp(&distance(*b, pole)));
            if let Some(at) = nearest.filter(|at| distance(*at, pole) < NEAR_POLE * marks.unit) {
                self.add_arc(marks, Anchor { frame, at }, velocity.phi);
                return;
            }
        }
        self.add_straight(marks, middle, speed);
    }

    fn add_arc(&mut self, marks: &mut Marks, at: Anchor, turn: f64) {
        let position = at.position(marks.poses);
        let count = self.occupied.iter().filter(|other| distance(**other, position) < CONCENTRIC * marks.unit).count();
        self.occupied.push(position);
        let [from, to] = if turn > 0.0 { TURN } else { [TURN[1], TURN[0]] };
        let shapes = marks.symbols().arc_arrow([0.0; 2], RADIUS[0] + RADIUS[1] * count as f64, from, to, false);
        marks.nodes.push(free_motion_node(at, shapes));
    }

    fn add_straight(&mut self, marks: &mut Marks, at: Anchor, speed: Vector) {
        let (unit, along) = (marks.unit, normal(speed));
        let is_busy = self.positions[at.frame].iter().any(|position| distance(*position, at.at) < unit);
        let position = at.position(marks.poses);
        let is_parallel = |other: Vector| cross(along, other).abs() < 0.3;
        let near = |other: &&(Vector, Vector)| distance(other.0, position) < unit && is_parallel(other.1);
        let count = self.straight.iter().filter(near).count();
        self.straight.push((position, along));
        let begin = if is_busy { SYMBOL_OFFSET } else { 0.0 };
        let offset = times(PARALLEL_OFFSET * unit * count as f64, left(along));
        let [from, to] = [begin, begin + STRAIGHT].map(|part| plus(offset, times(part * unit, along)));
        let shapes = marks.symbols().arrow(from, to, false);
        marks.nodes.push(free_motion_node(at, shapes));
    }
}

/// Returns the node of a free motion's arrow, which belongs to the body.
fn free_motion_node(at: Anchor, mut shapes: Vec<Shape>) -> Node {
    for shape in &mut shapes {
        shape.look = if shape.look == Look::ArrowHead { Look::FreeHead } else { Look::Free };
    }
    Node { declaration: at.frame, attachment: Attachment::Upright(at), shapes }
}

/// Returns one frame for each group of frames that move as one.
fn distinct_velocities(motion: &[(usize, Pose)], marks: &Marks) -> Vec<(usize, Pose)> {
    struct FrameMotion {
        frame: usize,
        velocity: Pose,
        /// Velocity of the position that coincides with the ground's origin.
        at_origin: Vector,
    }
    let mut distinct: Vec<FrameMotion> = Vec::new();
    for &(frame, velocity) in motion.iter().filter(|(frame, _)| *frame < marks.poses.len()) {
        let at_origin = velocity.velocity(&marks.poses[frame], marks.poses[frame].inverse_transform([0.0; 2]));
        let is_same = |other: &FrameMotion| {
            let size = length(at_origin) + velocity.phi.abs() * marks.unit;
            let off = distance(other.at_origin, at_origin) + (other.velocity.phi - velocity.phi).abs() * marks.unit;
            off <= SAME_VELOCITY * size
        };
        if !distinct.iter().any(is_same) {
            distinct.push(FrameMotion { frame, velocity, at_origin });
        }
    }
    distinct.into_iter().map(|FrameMotion { frame, velocity, .. }| (frame, velocity)).collect()
}

/// Returns whether a frame has three free motions of its own.
fn is_unconstrained(free: &[Vec<(usize, Pose)>], frame: usize) -> bool {
    free.iter().filter(|motion| matches!(motion.as_slice(), [(only, _)] if *only == frame)).count() == 3
}
