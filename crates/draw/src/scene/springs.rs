//! Springs and dampers: loads that depend on their own quantity or on its rate. The formula decides, not the name.

use super::drawing::{Drawing, Layer, shape};
use super::plane::{Path, distance, polar};
use super::symbols::Symbols;
use super::{Anchor, Held, Look, Node, Place, Shape, drivers};
use mechc_expr::{ExprId, Symbol};
use mechc_lang::model::{JointKind, Load, Mechanism, Named, PartId, Quantity};
use std::f64::consts::TAU;

/// Number of coils of a zigzag spring.
const COILS: u32 = 6;
/// Turns of a spiral spring, and its least and greatest radius (symbol units).
const TURNS: f64 = 2.25;
const RADII: [f64; 2] = [0.75, 1.5];
/// Number of intervals of a spiral.
const PLACES: u32 = 48;
/// Least distance of the ends of a spring (symbol units); shorter ones are not drawn.
const SHORTEST: f64 = 1.5;

/// Dependencies of a load.
#[derive(Clone, Copy, Default)]
struct Depends {
    on_place: bool,
    on_rate: bool,
}

/// Symbol of all loads on one quantity.
struct Element {
    on: Quantity,
    part: Option<PartId>,
    declaration: usize,
    depends: Depends,
}

pub(super) fn draw(drawing: &mut Drawing) {
    let model = drawing.features.model;
    let mut elements: Vec<Element> = Vec::new();
    for (number, load) in model.loads.iter().enumerate() {
        let (on, part, depends) = (load.on, load.part, depends(model, load));
        if let Some(known) = elements.iter_mut().find(|known| known.on == on && known.part == part) {
            known.depends.on_place |= depends.on_place;
            known.depends.on_rate |= depends.on_rate;
        } else if depends.on_place || depends.on_rate {
            elements.push(Element { on, part, declaration: drawing.first.loads + number, depends });
        }
    }
    for element in elements {
        draw_element(drawing, &element);
    }
}

fn draw_element(drawing: &mut Drawing, Element { on, declaration, depends, .. }: &Element) {
    let model = drawing.features.model;
    match *on {
        Quantity::Distance(p, q) => {
            let ends = [p, q].map(|point| drawing.features.point(point));
            between(drawing, *declaration, ends, *depends);
        }
        Quantity::Displacement(_, a, b) => {
            let ends = [a, b].map(|axis| drawing.features.point(model[axis].origin));
            between(drawing, *declaration, ends, *depends);
        }
        Quantity::Rotation(joint, _) if depends.on_place => {
            if let JointKind::Revolute(p, _) = model[joint].kind {
                let at = drawing.features.point(p);
                spiral(drawing, *declaration, at);
            }
        }
        Quantity::Angle(from, to) if depends.on_place => {
            let at = drivers::pivot_of(drawing, from, to);
            spiral(drawing, *declaration, at);
        }
        _ => {}
    }
}

/// Adds a spring, a damper or both side by side, stretched between two anchors that stay apart.
fn between(drawing: &mut Drawing, declaration: usize, [from, to]: [Anchor; 2], depends: Depends) {
    let apart = drawing.range(|row| {
        let poses = drawing.motion.poses(row);
        distance(from.placed(poses), to.placed(poses))
    });
    if apart[0] < SHORTEST * drawing.unit {
        return;
    }
    let shapes = stretched(Symbols { unit: drawing.unit }, depends);
    let place = Place::Between { from, to, held: Held::Stretched };
    drawing.add(Layer::Links, Node { declaration, place, shapes });
}

fn stretched(symbols: Symbols, depends: Depends) -> Vec<Shape> {
    match depends {
        Depends { on_place: true, on_rate: false } => vec![symbols.spring(COILS)],
        Depends { on_place: false, .. } => vec![symbols.damper(0.0, [0.0, 1.0])],
        Depends { on_place: true, on_rate: true } => {
            let aside = 0.8 * symbols.unit;
            let forks = [[0.0, 0.12], [1.0, 0.88]].map(|[end, fork]| {
                let path = Path::strokes([[[end, 0.0], [fork, 0.0]], [[fork, -aside], [fork, aside]]]);
                shape(Look::Spring, path)
            });
            let [first, second] = forks;
            vec![first, second, symbols.spring_beside(COILS, aside, [0.12, 0.88]), symbols.damper(-aside, [0.12, 0.88])]
        }
    }
}

/// Adds a spiral spring about an anchor.
fn spiral(drawing: &mut Drawing, declaration: usize, at: Anchor) {
    let [least, greatest] = RADII.map(|part| part * drawing.unit);
    let place = |k: u32| {
        let part = f64::from(k) / f64::from(PLACES);
        polar(least + part * (greatest - least), TURNS * TAU * part)
    };
    let shapes = vec![shape(Look::Spring, Path::line((0..=PLACES).map(place)))];
    drawing.add(Layer::Arrows, Node { declaration, place: Place::Upright(at), shapes });
}

/// Returns how a load's formula depends on its own quantity.
fn depends(model: &Mechanism, load: &Load) -> Depends {
    let own = Named::Quantity(load.part, load.on);
    let mut found = Depends::default();
    for named in named_in(model, load.force) {
        match named {
            Named::Derivative(inner) => found.on_rate |= holds(model, *inner, &own),
            named => found.on_place |= *named == own,
        }
    }
    found
}

fn holds(model: &Mechanism, formula: ExprId, wanted: &Named) -> bool {
    named_in(model, formula).any(|named| match named {
        Named::Derivative(inner) => holds(model, *inner, wanted),
        named => named == wanted,
    })
}

fn named_in(model: &Mechanism, formula: ExprId) -> impl Iterator<Item = &Named> {
    model.graph.symbols(formula).into_iter().filter_map(|symbol| match symbol {
        Symbol::Named(k) => Some(&model.named[k as usize]),
        _ => None,
    })
}
