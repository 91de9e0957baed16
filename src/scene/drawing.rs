//! A scene in the making: what all kinds of symbols share.

use super::features::Features;
use super::plane::{Path, Vector, bounds, distance, minus, plus};
use super::{
    Anchor, Declaration, Look, Motion, Node, Pen, Place, Point, Profile, Sample, Scene, Shape, Trace, bodies, drivers,
    gears, joints, sizes,
};
use crate::model::{self, Frame, Mechanism, Named, PointId, Quantity};
use std::f64::consts::PI;

/// What is drawn above what, from below.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Layer {
    Ground,
    Wheels,
    /// What holds pins on the ground, which is seen before a wheel.
    Feet,
    Bodies,
    Slots,
    Links,
    Blocks,
    Pins,
    Arrows,
}

/// The radius of a dot, in units.
pub(super) const DOT: f64 = 0.17;
/// Rows that are looked at to learn how far something goes.
pub(super) const LOOKED_AT: usize = 400;
/// Rows that are looked at for the extent of everything.
const LOOKED_AT_FOR_EXTENT: usize = 100;
/// Places on a profile.
const PLACES_ON_PROFILE: u32 = 360;
/// A profile is closed if its ends are no farther apart than this part of its size.
const CLOSED: f64 = 1e-6;

/// What is to become the outline of a body.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    /// Places in its frame that it holds (m).
    pub places: Vec<Vector>,
    /// Whether something else shows the body, if it is no more than a place.
    pub is_shown: bool,
    /// Whether there is a slot in it, for which it has to be wider.
    pub is_slotted: bool,
    /// Discs that are drawn of it, with their centres and radii (m): what lies in one of them needs no link.
    pub discs: Vec<(Vector, f64)>,
}

pub(super) struct Drawing<'m> {
    pub features: Features<'m>,
    pub motion: &'m Motion,
    pub unit: f64,
    /// By frame.
    pub outlines: Vec<Outline>,
    /// Where pins stand on the ground (m).
    pub feet: Vec<Vector>,
    pub profiles: Vec<Profile>,
    /// The number of each model point among the points of the scene.
    numbers: Vec<Option<usize>>,
    /// The declarations of the first joint, equation, circle and curve.
    pub first: First,
    nodes: Vec<(Layer, Node)>,
}

/// Where the declarations of a kind begin.
#[derive(Clone, Copy, Default)]
pub(super) struct First {
    pub circles: usize,
    pub curves: usize,
    pub joints: usize,
    pub equations: usize,
    traces: usize,
}

pub(super) fn scene(model: &Mechanism, motion: &Motion) -> Scene {
    let features = Features::of(model);
    let (declarations, first) = declarations(model);
    let (points, numbers) = points(&features);
    let mut outlines = vec![Outline::default(); motion.frames().max(1)];
    for id in places_of_bodies(model) {
        let Anchor { frame, at } = features.point(id);
        if frame > 0 && super::is_finite(at) {
            outlines[frame].places.push(at);
        }
    }
    let unit = sizes::unit(&features, motion, &outlines);
    let (feet, profiles, nodes) = (Vec::new(), Vec::new(), Vec::new());
    let mut drawing = Drawing { features, motion, unit, outlines, feet, profiles, numbers, first, nodes };
    gears::draw(&mut drawing);
    joints::draw(&mut drawing);
    drivers::draw(&mut drawing);
    bodies::draw(&mut drawing);
    let traces = drawing.traces();
    drawing.mark_pens(&traces);
    let Drawing { mut nodes, profiles, .. } = drawing;
    nodes.sort_by_key(|(layer, _)| *layer);
    let nodes: Vec<Node> = nodes.into_iter().map(|(_, node)| node).collect();
    let extent = extent(&nodes, motion, unit);
    let frames = (0..motion.frames().max(1)).collect();
    let (name, docs) = (model.declared.name.clone(), model.docs.clone());
    Scene { name, docs, declarations, frames, points, nodes, traces, profiles, unit, extent }
}

impl Drawing<'_> {
    pub fn add(&mut self, layer: Layer, node: Node) {
        self.nodes.push((layer, node));
    }

    /// Adds shapes that move with a frame.
    pub fn add_fixed(&mut self, layer: Layer, declaration: usize, frame: usize, shapes: Vec<Shape>) {
        self.add(layer, Node { declaration, place: Place::Fixed(frame), shapes });
    }

    /// The number of a point in the scene; of a joint's two the first that has a name and is on a body.
    pub fn shown(&self, points: &[PointId]) -> Option<usize> {
        let on_body = points.iter().find(|id| self.features.frame(self.features.model[**id].frame) > 0);
        let named = |id: &PointId| self.numbers[id.index()];
        on_body.and_then(named).or_else(|| points.iter().find_map(named))
    }

    /// What a number is along the motion at least and at most, in some rows.
    pub fn range(&self, of: impl Fn(usize) -> f64) -> [f64; 2] {
        let values = self.motion.sampled(LOOKED_AT).map(of).filter(|value| value.is_finite());
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    }

    /// A place of a frame, in another one, in a row.
    pub fn seen(&self, anchor: Anchor, frame: usize, row: usize) -> Vector {
        let poses = self.motion.poses(row);
        poses[frame].located(anchor.placed(poses))
    }

    /// The own coordinate of a joint, row by row: its `u`, `w` or `theta`.
    pub fn own_coordinate(&self, joint: usize, part: &str) -> Option<Vec<f64>> {
        let name = &self.features.model.joints[joint].declared.name;
        Some(self.motion.column(&format!("{name}.{part}"))?.collect())
    }

    /// A profile that a contact runs along, with arguments between these at least if it is open; its number.
    pub fn profile(&mut self, profile: model::Profile, used: Option<[f64; 2]>) -> usize {
        let declaration = match profile {
            model::Profile::Curve(id) => self.first.curves + id.index(),
            model::Profile::Circle(id) => self.first.circles + id.index(),
        };
        if let Some(known) = self.profiles.iter().position(|known| known.declaration == declaration) {
            return known;
        }
        let frame = self.features.frame(profile.frame(self.features.model));
        let sampled = |from: f64, to: f64| -> Vec<Sample> {
            let place = |k: u32| from + (to - from) * f64::from(k) / f64::from(PLACES_ON_PROFILE);
            let samples = (0..=PLACES_ON_PROFILE).map(|k| self.features.sample(profile, place(k)));
            samples.filter(|sample| super::is_finite(sample.at)).collect()
        };
        let turn = sampled(-PI, PI);
        let size = bounds(turn.iter().map(|sample| sample.at)).map_or(0.0, |[low, high]| distance(low, high));
        let is_closed = turn.len() == PLACES_ON_PROFILE as usize + 1
            && distance(turn[0].at, turn[PLACES_ON_PROFILE as usize].at) <= CLOSED * size;
        let samples = match used {
            Some([from, to]) if !is_closed => {
                let beyond = (0.05 * (to - from)).max(1e-3);
                sampled(from - beyond, to + beyond)
            }
            _ => turn,
        };
        self.profiles.push(Profile { declaration, frame, is_closed, samples });
        self.profiles.len() - 1
    }

    /// A dot at what draws a trace.
    fn mark_pens(&mut self, traces: &[Trace]) {
        for trace in traces {
            let Pen::Point(Anchor { frame, at }) = trace.pen else { continue };
            let model = self.features.model;
            let number = trace.declaration - self.first.traces;
            let point = model.traces.get(number).and_then(|trace| self.shown(&[trace.point?]));
            let path = Path::Circle { at, radius: DOT * self.unit };
            self.add_fixed(Layer::Pins, trace.declaration, frame, vec![Shape { path, look: Look::Dot, point }]);
        }
    }

    /// Whether a frame has a node of a declaration.
    pub fn has_node(&self, declaration: usize) -> bool {
        self.nodes.iter().any(|(_, node)| node.declaration == declaration)
    }

    /// Says of the first block of a frame that it is the body itself; whether there is one.
    pub fn declare_block(&mut self, frame: usize) -> bool {
        let is_block = |node: &Node| {
            node.place == Place::Fixed(frame) && node.shapes.iter().any(|shape| shape.look == Look::Block)
        };
        match self.nodes.iter_mut().find(|(_, node)| is_block(node)) {
            Some((_, node)) => {
                node.declaration = frame;
                true
            }
            None => false,
        }
    }

    /// How many arrows there are around a place.
    pub fn arrows_at(&self, anchor: Anchor) -> usize {
        let poses = self.motion.poses(0);
        let at = anchor.placed(poses);
        let is_there = |node: &Node| match node.place {
            Place::Upright(other) => distance(other.placed(poses), at) < 0.5 * self.unit,
            _ => false,
        };
        self.nodes.iter().filter(|(layer, node)| *layer == Layer::Arrows && is_there(node)).count()
    }

    fn traces(&self) -> Vec<Trace> {
        let model = self.features.model;
        let pen = |trace: &model::Trace| match trace.point {
            Some(point) => Pen::Point(self.features.point(point)),
            None => {
                let (frame, pose, is_mirrored) = self.features.text_of(trace.part);
                Pen::Columns { name: trace.declared.name.clone(), frame, pose, is_mirrored }
            }
        };
        let numbered = model.traces.iter().enumerate();
        numbered.map(|(k, trace)| Trace { declaration: self.first.traces + k, pen: pen(trace) }).collect()
    }
}

/// All that can be pointed at: frames first, then points, circles, curves, joints, equations, measures, traces.
fn declarations(model: &Mechanism) -> (Vec<Declaration>, First) {
    let mut all = vec![Declaration { name: "ground".to_owned(), kind: "ground", span: model.declared.span }];
    let of = |declared: &model::Declared, kind| Declaration { name: declared.name.clone(), kind, span: declared.span };
    let feature = |frame: Frame, name: &str, kind, span| Declaration {
        name: format!("{}.{name}", model.frame_name(frame)),
        kind,
        span,
    };
    all.extend(model.bodies.iter().map(|body| of(&body.declared, "body")));
    let named = model.points.iter().filter_map(|point| Some((point, point.name.as_ref()?)));
    all.extend(named.map(|(point, name)| feature(point.frame, name, "point", point.span)));
    let mut first = First { circles: all.len(), ..First::default() };
    all.extend(model.circles.iter().map(|circle| feature(circle.frame, &circle.name, "circle", circle.span)));
    first.curves = all.len();
    all.extend(model.curves.iter().map(|curve| feature(curve.frame, &curve.name, "curve", curve.span)));
    first.joints = all.len();
    all.extend(model.joints.iter().map(|joint| of(&joint.declared, "joint")));
    first.equations = all.len();
    let word = |equation: &model::Equation| if equation.driver { "driver" } else { "constraint" };
    all.extend(model.equations.iter().map(|equation| of(&equation.declared, word(equation))));
    all.extend(model.measures.iter().map(|measure| of(&measure.declared, "measure")));
    first.traces = all.len();
    all.extend(model.traces.iter().map(|trace| of(&trace.declared, "trace")));
    (all, first)
}

/// The points that have a name, and by model point its number among them.
fn points(features: &Features) -> (Vec<Point>, Vec<Option<usize>>) {
    let model = features.model;
    let mut is_pin = vec![false; model.points.len()];
    for joint in &model.joints {
        joint.kind.points(model).into_iter().for_each(|point| is_pin[point.index()] = true);
    }
    for equation in &model.equations {
        if let model::EquationForm::SquaredDistance(p, q, _) = equation.form {
            [p, q].into_iter().for_each(|point| is_pin[point.index()] = true);
        }
    }
    let (mut points, mut numbers) = (Vec::new(), Vec::new());
    for (point, is_pin) in model.points.iter().zip(is_pin) {
        numbers.push(point.name.as_ref().map(|name| {
            let Anchor { frame, at } = features.placed(point.frame, point.at.map(|part| features.value(part)));
            let (name, number) = (format!("{}.{name}", model.frame_name(point.frame)), points.len());
            points.push(Point { declaration: 1 + model.bodies.len() + number, name, frame, at, is_pin });
            number
        }));
    }
    (points, numbers)
}

/// The points that show what a body is: where joints and drivers take hold, what is traced and measured.
fn places_of_bodies(model: &Mechanism) -> Vec<PointId> {
    let mut points: Vec<PointId> = model.joints.iter().flat_map(|joint| joint.kind.points(model)).collect();
    for equation in &model.equations {
        if let model::EquationForm::SquaredDistance(p, q, _) = equation.form {
            points.extend([p, q]);
        }
    }
    points.extend(model.traces.iter().filter_map(|trace| trace.point));
    for named in &model.named {
        let Named::Quantity(_, quantity) = named else { continue };
        match *quantity {
            Quantity::X(from, to) | Quantity::Y(from, to) => points.extend(from.into_iter().chain([to])),
            Quantity::Distance(p, q) => points.extend([p, q]),
            Quantity::Speed(p) | Quantity::Curvature(p) => points.push(p),
            Quantity::Corner(corners) => points.extend(corners),
            _ => {}
        }
    }
    points
}

/// The least and greatest coordinates of all nodes along the motion.
fn extent(nodes: &[Node], motion: &Motion, unit: f64) -> [Vector; 2] {
    let mut all: Option<[Vector; 2]> = None;
    let places: Vec<Vec<Vector>> =
        nodes.iter().map(|node| node.shapes.iter().flat_map(|shape| shape.path.places()).collect()).collect();
    let corners: Vec<Vec<Vector>> = places.iter().map(|places| super::plane::hull(places, 1e-3 * unit)).collect();
    for row in motion.sampled(LOOKED_AT_FOR_EXTENT) {
        for (node, corners) in nodes.iter().zip(&corners) {
            let (pose, stretch) = node.place.pose(motion.poses(row));
            let placed = corners.iter().map(|[x, y]| pose.placed([stretch * x, *y]));
            if let Some([low, high]) = bounds(placed) {
                let [least, greatest] = all.unwrap_or([low, high]);
                all = Some([
                    [least[0].min(low[0]), least[1].min(low[1])],
                    [greatest[0].max(high[0]), greatest[1].max(high[1])],
                ]);
            }
        }
    }
    let margin = [0.5 * unit; 2];
    all.map_or([[-unit; 2], [unit; 2]], |[low, high]| [minus(low, margin), plus(high, margin)])
}

/// A shape that shows no point.
pub(super) fn shape(look: Look, path: Path) -> Shape {
    Shape { path, look, point: None }
}
