//! Springs and dampers: loads that depend on their own quantity or on its rate. The formula decides, not the name.

use super::drawing::{Drawing, Layer, shape};
use super::plane::{Path, distance, polar};
use super::symbols::Symbols;
use super::{Alignment, Anchor, Attachment, Look, Node, Shape, drivers};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{Load, Mechanism, Named, PartId, Quantity};
use std::f64::consts::TAU;

/// Number of coils of a zigzag spring.
const COILS: u32 = 6;
/// Turns of a spiral spring, and its least and greatest radius (symbol units).
const TURNS: f64 = 2.25;
const RADII: [f64; 2] = [0.75, 1.5];
/// Number of intervals of a spiral.
const INTERVALS: u32 = 48;
/// Least distance of the ends of a spring (symbol units); shorter ones are not drawn.
const SHORTEST: f64 = 1.5;

/// Dependencies of a load.
#[derive(Clone, Copy, Default)]
struct Dependencies {
    on_position: bool,
    on_rate: bool,
}

/// Symbol of all loads on one quantity.
struct Element {
    on: Quantity,
    part: Option<PartId>,
    declaration: usize,
    dependencies: Dependencies,
}

pub(super) fn draw(drawing: &mut Drawing) {
    let model = drawing.features.model;
    let mut elements: Vec<Element> = Vec::new();
    for (number, load) in model.loads.iter().enumerate() {
        let (on, part, dependencies) = (load.on, load.part, dependencies(model, load));
        if let Some(element) = elements.iter_mut().find(|element| element.on == on && element.part == part) {
            element.dependencies.on_position |= dependencies.on_position;
            element.dependencies.on_rate |= dependencies.on_rate;
        } else if dependencies.on_position || dependencies.on_rate {
            elements.push(Element { on, part, declaration: drawing.first.loads + number, dependencies });
        }
    }
    for element in elements {
        draw_element(drawing, &element);
    }
}

fn draw_element(drawing: &mut Drawing, Element { on, declaration, dependencies, .. }: &Element) {
    let model = drawing.features.model;
    match *on {
        Quantity::Distance(p, q) => {
            let ends = [p, q].map(|point| drawing.features.point(point));
            add_between(drawing, *declaration, ends, *dependencies);
        }
        Quantity::Displacement(_, a, b) => {
            let ends = [a, b].map(|axis| drawing.features.point(model[axis].origin));
            add_between(drawing, *declaration, ends, *dependencies);
        }
        Quantity::Rotation(joint, _) if dependencies.on_position => {
            if let Some([p, _]) = model[joint].pin() {
                let at = drawing.features.point(p);
                spiral(drawing, *declaration, at);
            }
        }
        Quantity::Angle(from, to) if dependencies.on_position => {
            let at = drivers::angle_pivot(drawing, from, to);
            spiral(drawing, *declaration, at);
        }
        _ => {}
    }
}

/// Adds a spring, a damper or both side by side, stretched between two anchors that stay apart.
fn add_between(drawing: &mut Drawing, declaration: usize, [from, to]: [Anchor; 2], dependencies: Dependencies) {
    let distances = drawing.range(|row| {
        let poses = drawing.motion.poses(row);
        distance(from.position(poses), to.position(poses))
    });
    if distances[0] < SHORTEST * drawing.unit {
        return;
    }
    let shapes = shapes_between(Symbols { unit: drawing.unit }, dependencies);
    let attachment = Attachment::Between { from, to, alignment: Alignment::Stretch };
    drawing.add(Layer::Links, Node { declaration, attachment, shapes });
}

fn shapes_between(symbols: Symbols, dependencies: Dependencies) -> Vec<Shape> {
    match dependencies {
        Dependencies { on_position: true, on_rate: false } => vec![symbols.spring(COILS)],
        Dependencies { on_position: false, .. } => vec![symbols.damper(0.0, [0.0, 1.0])],
        Dependencies { on_position: true, on_rate: true } => {
            let offset = 0.8 * symbols.unit;
            let forks = [[0.0, 0.12], [1.0, 0.88]].map(|[end, fork]| {
                let path = Path::strokes([[[end, 0.0], [fork, 0.0]], [[fork, -offset], [fork, offset]]]);
                shape(Look::Spring, path)
            });
            let [first, second] = forks;
            vec![first, second, symbols.spring_at(COILS, offset, [0.12, 0.88]), symbols.damper(-offset, [0.12, 0.88])]
        }
    }
}

/// Adds a spiral spring about an anchor.
fn spiral(drawing: &mut Drawing, declaration: usize, at: Anchor) {
    let [least, greatest] = RADII.map(|part| part * drawing.unit);
    let position = |k: u32| {
        let part = f64::from(k) / f64::from(INTERVALS);
        polar(least + part * (greatest - least), TURNS * TAU * part)
    };
    let shapes = vec![shape(Look::Spring, Path::line((0..=INTERVALS).map(position)))];
    drawing.add(Layer::Arrows, Node { declaration, attachment: Attachment::Upright(at), shapes });
}

/// Returns how a load's formula depends on its own quantity.
fn dependencies(model: &Mechanism, load: &Load) -> Dependencies {
    let quantity = Named::Quantity(load.part, load.on);
    let mut dependencies = Dependencies::default();
    for named in named_symbols(model, load.force) {
        match named {
            Named::Derivative(inner) => dependencies.on_rate |= contains(model, *inner, &quantity),
            named => dependencies.on_position |= *named == quantity,
        }
    }
    dependencies
}

fn contains(model: &Mechanism, formula: ExprId, quantity: &Named) -> bool {
    named_symbols(model, formula).any(|named| match named {
        Named::Derivative(inner) => contains(model, *inner, quantity),
        named => named == quantity,
    })
}

fn named_symbols(model: &Mechanism, formula: ExprId) -> impl Iterator<Item = &Named> {
    model.graph.symbols(formula).into_iter().filter_map(|symbol| match symbol {
        Symbol::Named(k) => Some(&model.named[k as usize]),
        _ => None,
    })
}
