//! Builder of the whole scene: declarations, then all symbols, then the extent.

use super::drawing::{Drawing, First, Layer, Outline};
use super::features::Features;
use super::plane::{Vector, bounds, distance, minus, plus};
use super::{
    Anchor, Declaration, Motion, Node, Point, Scene, bodies, contacts, drivers, forces, gears, joints, sizes, springs,
    torques,
};
use mechc_lang::model::{self, Frame, Mechanism, Named, PointId, Quantity};

/// Number of rows that are sampled for the extent.
const SAMPLED_ROWS: usize = 100;

/// Builds a scene, with symbols of a given size (m) if there is one.
pub(super) fn build(model: &Mechanism, motion: &Motion, size: Option<f64>) -> Scene {
    let features = Features::new(model);
    let (declarations, first) = declarations(model);
    let (points, point_indices) = points(&features);
    let mut outlines = vec![Outline::default(); motion.frames().max(1)];
    for id in shape_points(model) {
        let Anchor { frame, at } = features.point(id);
        if frame > 0 && super::is_finite(at) {
            outlines[frame].positions.push(at);
        }
    }
    add_idle_points(&features, &mut outlines);
    let unit = size.unwrap_or_else(|| sizes::unit(&features, motion, &outlines));
    let (feet, pins, profiles, pitch_lines, nodes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let contacts = contacts::contacts(&features, first.joints);
    let mut drawing =
        Drawing { features, motion, unit, outlines, feet, pins, profiles, pitch_lines, point_indices, first, nodes };
    gears::draw(&mut drawing);
    joints::draw(&mut drawing);
    drivers::draw(&mut drawing);
    springs::draw(&mut drawing);
    bodies::draw(&mut drawing);
    let traces = drawing.traces();
    let torques = torques::torques(&drawing);
    let forces = forces::vectors(&drawing, !torques.is_empty());
    drawing.mark_pens(&traces);
    let Drawing { mut nodes, pins, profiles, pitch_lines, .. } = drawing;
    nodes.sort_by_key(|(layer, _): &(Layer, Node)| *layer);
    let nodes: Vec<Node> = nodes.into_iter().map(|(_, node)| node).collect();
    let extent = extent(&nodes, motion, unit);
    let frames = (0..motion.frames().max(1)).collect();
    let (name, docs) = (model.declared.name.clone(), model.docs.clone());
    let (named, remarks) = (Vec::new(), Vec::new());
    Scene {
        name,
        docs,
        declarations,
        frames,
        points,
        pins,
        nodes,
        traces,
        profiles,
        contacts,
        forces,
        torques,
        pitch_lines,
        unit,
        extent,
        named,
        remarks,
    }
}

/// Adds the named points of bodies that joints hold at one position at most: one of them may be the purpose of the body.
fn add_idle_points(features: &Features, outlines: &mut [Outline]) {
    let has_one_position =
        |outline: &Outline| outline.positions.windows(2).all(|pair| distance(pair[0], pair[1]) <= 0.0);
    let is_idle: Vec<bool> = outlines.iter().map(has_one_position).collect();
    let named = features.model.points.iter().filter(|point| point.name.is_some());
    for point in named {
        let Anchor { frame, at } = features.resolve(point.frame, point.at.map(|part| features.value(part)));
        if frame > 0 && is_idle[frame] && super::is_finite(at) {
            outlines[frame].positions.push(at);
        }
    }
}

/// Lists all declarations: frames, then points, circles, curves, joints, equations, measures, traces, loads.
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
    first.loads = all.len();
    all.extend(model.loads.iter().map(|load| of(&load.declared, "load")));
    (all, first)
}

/// Returns the indices of the declarations of the first joint and of the first equation.
pub(super) fn first_declarations(model: &Mechanism) -> (usize, usize) {
    let (_, first) = declarations(model);
    (first.joints, first.equations)
}

/// Returns the named points, and for each point of the model its index among them.
fn points(features: &Features) -> (Vec<Point>, Vec<Option<usize>>) {
    let model = features.model;
    let mut is_pin = vec![false; model.points.len()];
    for joint in &model.joints {
        joint.points(model).into_iter().for_each(|point| is_pin[point.index()] = true);
    }
    for equation in &model.equations {
        if let model::EquationForm::Distance(p, q, _) = equation.form {
            for point in [p, q] {
                is_pin[point.index()] = true;
            }
        }
    }
    let (mut points, mut indices) = (Vec::new(), Vec::new());
    for (point, is_pin) in model.points.iter().zip(is_pin) {
        indices.push(point.name.as_ref().map(|name| {
            let Anchor { frame, at } = features.resolve(point.frame, point.at.map(|part| features.value(part)));
            let (name, number) = (format!("{}.{name}", model.frame_name(point.frame)), points.len());
            points.push(Point { declaration: 1 + model.bodies.len() + number, name, frame, at, is_pin });
            number
        }));
    }
    (points, indices)
}

/// Returns the points that show the shape of bodies: those of joints and drivers, traces, measures and masses.
pub(super) fn shape_points(model: &Mechanism) -> Vec<PointId> {
    let mut points: Vec<PointId> = model.joints.iter().flat_map(|joint| joint.points(model)).collect();
    for equation in &model.equations {
        if let model::EquationForm::Distance(p, q, _) = equation.form {
            points.extend([p, q]);
        }
    }
    points.extend(model.traces.iter().filter_map(|trace| trace.point));
    points.extend(model.masses.iter().map(|mass| mass.at).filter(|at| model[*at].name.is_some()));
    for named in &model.named {
        let Named::Quantity(_, quantity) = named else { continue };
        match *quantity {
            Quantity::X(from, to) | Quantity::Y(from, to) => points.extend(from.into_iter().chain([to])),
            Quantity::Distance(p, q) => points.extend([p, q]),
            Quantity::Measured(measured) => points.extend(measured.points()),
            Quantity::Corner(corners) => points.extend(corners),
            _ => {}
        }
    }
    points
}

/// Returns the bounding box of all nodes along the motion, with a margin.
pub(super) fn extent(nodes: &[Node], motion: &Motion, unit: f64) -> [Vector; 2] {
    let margin = [0.5 * unit; 2];
    reach(nodes, motion, unit).map_or([[-unit; 2], [unit; 2]], |[low, high]| [minus(low, margin), plus(high, margin)])
}

/// Returns the bounding box of all nodes along the motion, or `None` if nothing is drawn.
pub(super) fn reach(nodes: &[Node], motion: &Motion, unit: f64) -> Option<[Vector; 2]> {
    let mut all: Option<[Vector; 2]> = None;
    let positions: Vec<Vec<Vector>> =
        nodes.iter().map(|node| node.shapes.iter().flat_map(|shape| shape.path.positions()).collect()).collect();
    let corners: Vec<Vec<Vector>> =
        positions.iter().map(|positions| super::plane::hull(positions, 1e-3 * unit)).collect();
    for row in motion.sampled(SAMPLED_ROWS) {
        for (node, corners) in nodes.iter().zip(&corners) {
            let (pose, stretch) = node.attachment.pose(motion.poses(row));
            let transformed = corners.iter().map(|[x, y]| pose.transform([stretch * x, *y]));
            if let Some([low, high]) = bounds(transformed) {
                let [least, greatest] = all.unwrap_or([low, high]);
                all = Some([
                    [least[0].min(low[0]), least[1].min(low[1])],
                    [greatest[0].max(high[0]), greatest[1].max(high[1])],
                ]);
            }
        }
    }
    all
}
