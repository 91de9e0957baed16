//! Catalogue of all symbols in one picture, for the documentation.

use super::drawing::shape;
use super::plane::{Path, Pose, Vector, around, hull, plus, polar};
use super::symbols::{BAR, SLOT, SLOTTED_BAR, Symbols};
use super::teeth::{Rack, Wheel};
use super::{Alignment, Anchor, Attachment, Declaration, Look, Motion, Node, Scene, Shape};
use mechc_text::source::Span;
use std::f64::consts::{PI, TAU};

/// Distance from one symbol to the next (symbol units).
const CELL: Vector = [8.4, 7.6];
/// Number of symbols in a row.
const COLUMNS: usize = 4;

/// A symbol with its name: shapes by frame (the ground and two bodies), bottom first, and the ends of a spring.
struct Entry {
    name: &'static str,
    shapes: Vec<(usize, Shape)>,
    spring: Option<[Vector; 2]>,
}

/// All symbols with their names.
#[derive(Debug)]
pub struct Catalogue {
    /// Scene of the symbols.
    pub scene: Scene,
    /// Motion in which they rest.
    pub motion: Motion,
    /// Captions with their positions (m).
    pub captions: Vec<(Vector, String)>,
}

/// Returns the catalogue of all symbols, whose declarations have a span.
#[must_use]
pub fn catalogue(span: Span) -> Catalogue {
    let symbols = Symbols { unit: 1.0 };
    let entries = [
        pivot(symbols),
        fixed_pivot(symbols),
        slider(symbols),
        slot(symbols),
        weld(symbols),
        gears(symbols),
        rack(symbols),
        cam(symbols),
        flat_follower(symbols),
        spring(symbols),
        driver(symbols),
        ground(symbols),
    ];
    let named = |name: &str, kind| Declaration { name: name.to_owned(), kind, span };
    let mut declarations = vec![named("ground", "ground"), named("first body", "body"), named("second body", "body")];
    let (mut nodes, mut captions) = (Vec::new(), Vec::new());
    for (k, entry) in entries.into_iter().enumerate() {
        let at = [CELL[0] * (k % COLUMNS) as f64, -CELL[1] * (k / COLUMNS) as f64];
        let pose = Pose { at, phi: 0.0 };
        declarations.push(named(entry.name, "symbol"));
        let declaration = declarations.len() - 1;
        if let Some([from, to]) = entry.spring {
            let [from, to] = [from, to].map(|end| Anchor { frame: 0, at: plus(at, end) });
            let attachment = Attachment::Between { from, to, alignment: Alignment::Stretch };
            nodes.push(Node { declaration, attachment, shapes: vec![symbols.spring(5)] });
        }
        for (frame, part) in entry.shapes {
            let shapes = vec![Shape { path: part.path.transform(&pose), ..part }];
            nodes.push(Node { declaration, attachment: Attachment::Fixed(frame), shapes });
        }
        captions.push((plus(at, [0.0, -3.5]), entry.name.to_owned()));
    }
    let rows = captions.len().div_ceil(COLUMNS) as f64;
    let extent = [[-4.2, -CELL[1] * (rows - 1.0) - 4.2], [CELL[0] * (COLUMNS - 1) as f64 + 4.2, 3.4]];
    let scene = Scene {
        name: "symbols".to_owned(),
        docs: vec!["The symbols of joints, drivers and the ground.".to_owned()],
        declarations,
        frames: vec![0, 1, 2],
        points: Vec::new(),
        pins: Vec::new(),
        nodes,
        traces: Vec::new(),
        profiles: Vec::new(),
        contacts: Vec::new(),
        forces: Vec::new(),
        torques: Vec::new(),
        pitch_lines: Vec::new(),
        unit: 1.0,
        extent,
        named: Vec::new(),
        remarks: Vec::new(),
    };
    Catalogue { scene, motion: Motion::still(vec![Pose::default(); 3]), captions }
}

fn bar(ends: &[Vector], reach: f64) -> Shape {
    shape(Look::Link, around(&hull(ends, 1e-9), reach))
}

fn entry(name: &'static str, shapes: Vec<(usize, Shape)>) -> Entry {
    Entry { name, shapes, spring: None }
}

fn pivot(symbols: Symbols) -> Entry {
    let (first, second) = (bar(&[[-2.6, -0.9], [0.0, 0.6]], BAR), bar(&[[0.0, 0.6], [2.6, -0.9]], BAR));
    entry("pivot", vec![(1, first), (2, second), (2, symbols.pin([0.0, 0.6], None))])
}

fn fixed_pivot(symbols: Symbols) -> Entry {
    let mut shapes: Vec<(usize, Shape)> = symbols.foot([-0.8, -0.4]).into_iter().map(|part| (0, part)).collect();
    shapes.extend([(1, bar(&[[-0.8, -0.4], [2.0, 1.4]], BAR)), (1, symbols.pin([-0.8, -0.4], None))]);
    entry("fixed pivot", shapes)
}

fn slider(symbols: Symbols) -> Entry {
    let mut shapes: Vec<(usize, Shape)> = symbols.edge([-3.0, -0.78], [3.0, -0.78]).map(|part| (0, part)).to_vec();
    shapes.push((1, symbols.block([0.4, 0.0], [1.0, 0.0])));
    entry("slider in its guide", shapes)
}

fn slot(symbols: Symbols) -> Entry {
    let body = bar(&[[-2.6, 0.0], [2.6, 0.0]], SLOTTED_BAR);
    let opening = symbols.stadium([-1.8, 0.0], [1.8, 0.0], SLOT, Look::Slot);
    let other = bar(&[[0.7, 0.0], [1.6, -1.7]], BAR);
    entry("pin in a slot", vec![(1, body), (1, opening), (2, other), (2, symbols.pin([0.7, 0.0], None))])
}

fn weld(symbols: Symbols) -> Entry {
    let (first, second) = (bar(&[[-2.4, -1.0], [1.0, -1.0]], BAR), bar(&[[1.0, -1.0], [1.0, 1.6]], BAR));
    let mut shapes = vec![(1, first), (2, second)];
    shapes.extend(symbols.weld([1.0, -1.0]).into_iter().map(|part| (2, part)));
    entry("weld", shapes)
}

fn toothed(wheel: &Wheel) -> Shape {
    shape(Look::Gear, Path::Lines(vec![wheel.outline()]))
}

fn gears(symbols: Symbols) -> Entry {
    let radii = [1.2, 1.9];
    let [left, right] = [[-1.95, 0.0], [1.15, 0.0]];
    let first = Wheel { at: left, radius: radii[0], teeth: 12, phase: 0.0 };
    let second = Wheel { at: right, radius: radii[1], teeth: 19, phase: PI + PI / 19.0 };
    let pitch = |wheel: &Wheel| shape(Look::Pitch, Path::Circle { at: wheel.at, radius: wheel.radius });
    let shapes = vec![
        (1, toothed(&first)),
        (2, toothed(&second)),
        (1, pitch(&first)),
        (2, pitch(&second)),
        (1, symbols.pin(left, None)),
        (2, symbols.pin(right, None)),
    ];
    entry("pair of gears", shapes)
}

fn rack(symbols: Symbols) -> Entry {
    let wheel = Wheel { at: [0.0, 0.7], radius: 1.5, teeth: 14, phase: -0.5 * PI };
    let pitch = TAU * wheel.radius / f64::from(wheel.teeth);
    let rack = Rack { at: [0.0, -0.8], along: [1.0, 0.0], side: 1.0, pitch, phase: 0.5 * pitch };
    let row = shape(Look::Rack, Path::Lines(vec![rack.outline([-2.4, 2.4], 0.6)]));
    let circle = shape(Look::Pitch, Path::Circle { at: wheel.at, radius: wheel.radius });
    let line = shape(Look::Pitch, Path::line([[-2.6, -0.8], [2.6, -0.8]]));
    let pin = symbols.pin(wheel.at, None);
    entry("rack and pinion", vec![(1, toothed(&wheel)), (2, row), (1, circle), (2, line), (1, pin)])
}

/// Returns an egg-shaped cam around a position.
fn egg(at: Vector) -> Shape {
    let radius = |angle: f64| 1.3 + 0.45 * mechc_expr::math::cos(angle - 0.5 * PI);
    let position = |k: u32| {
        let angle = TAU * f64::from(k) / 72.0;
        plus(at, polar(radius(angle), angle))
    };
    shape(Look::Cam, Path::polygon((0..72).map(position)))
}

fn cam(symbols: Symbols) -> Entry {
    let at = [0.0, -0.9];
    let tip = plus(at, [0.0, 1.75]);
    let shapes = vec![
        (1, egg(at)),
        (1, symbols.pin(at, None)),
        (2, bar(&[tip, plus(tip, [0.0, 1.9])], 0.4)),
        (2, shape(Look::Roller, Path::Circle { at: tip, radius: 0.34 })),
    ];
    entry("cam with a point", shapes)
}

fn flat_follower(symbols: Symbols) -> Entry {
    let at = [0.0, -0.9];
    let face = plus(at, [0.0, 1.75]);
    let ends = [plus(face, [-1.5, 0.0]), plus(face, [1.5, 0.0])];
    let shapes = vec![
        (1, egg(at)),
        (1, symbols.pin(at, None)),
        (2, bar(&[plus(face, [0.0, 0.45]), plus(face, [0.0, 1.9])], 0.4)),
        (2, shape(Look::Face, Path::line(ends))),
    ];
    entry("cam with a flat face", shapes)
}

fn spring(symbols: Symbols) -> Entry {
    let ends = [[-2.6, 0.0], [2.6, 0.0]];
    let pins = ends.map(|end| (1, symbols.pin(end, None))).to_vec();
    Entry { name: "spring", shapes: pins, spring: Some(ends) }
}

fn driver(symbols: Symbols) -> Entry {
    let mut shapes: Vec<(usize, Shape)> = symbols.foot([-0.9, -0.4]).into_iter().map(|part| (0, part)).collect();
    shapes.extend([(1, bar(&[[-0.9, -0.4], [2.0, 0.5]], BAR)), (1, symbols.pin([-0.9, -0.4], None))]);
    let arrow = symbols.arc_arrow([-0.9, -0.4], 1.75, 0.2 * PI, 0.85 * PI, false);
    shapes.extend(arrow.into_iter().map(|part| (0, part)));
    entry("driver", shapes)
}

fn ground(symbols: Symbols) -> Entry {
    entry("ground", symbols.edge([-2.4, 0.0], [2.4, 0.0]).map(|part| (0, part)).to_vec())
}
