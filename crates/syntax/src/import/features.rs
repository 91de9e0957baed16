//! The points, axes and circles that a body needs for its constraints.
//!
//! A place of a body is one point, whatever number of constraints speak of it; its name tells what it is for.

use super::build;
use crate::ast::{Expr, Feature, FeatureKind};
use mechc_text::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// The features of one body, in the order in which the constraints ask for them.
#[derive(Default)]
pub(super) struct Features {
    points: Vec<Point>,
    axes: Vec<Axis>,
    circles: Vec<Circle>,
    /// Positions of points, axes and circles in their lists, by their values: models may have many.
    positions: FxHashMap<Key, usize>,
    used: FxHashSet<String>,
    next: FxHashMap<String, u32>,
}

/// Identity of a feature: its kind, the position of its point, and the bits of its numbers.
type Key = (&'static str, usize, [u64; 2]);

/// Purpose of a point.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Purpose {
    /// A joint with another body, of this name.
    Joint(String),
    /// The middle of a pinion.
    Center,
    /// A pitch line goes through it.
    PitchLine,
    /// A coordinate of it is constant.
    Held,
    /// A coordinate of it follows the time.
    Driven,
}

struct Point {
    at: [f64; 2],
    span: Span,
    purposes: Vec<Purpose>,
    name: String,
}

struct Axis {
    origin: usize,
    line: Line,
    span: Span,
    name: String,
}

/// Direction of an axis from its point.
#[derive(Clone)]
pub(super) enum Line {
    /// Direction of an axis.
    Along([f64; 2]),
    /// Second point of an axis; `target` is its formula in the output.
    To { numbers: [f64; 2], target: Expr },
}

struct Circle {
    center: usize,
    radius: f64,
    span: Span,
    name: String,
}

impl Features {
    /// Returns the point at some coordinates, created at its first use.
    pub fn point(&mut self, at: [f64; 2], span: Span, purpose: Purpose) -> usize {
        let count = self.points.len();
        let position = *self.positions.entry(("point", 0, at.map(f64::to_bits))).or_insert(count);
        match self.points.get_mut(position) {
            Some(point) => point.purposes.push(purpose),
            None => self.points.push(Point { at, span, purposes: vec![purpose], name: String::new() }),
        }
        position
    }

    /// Returns an axis from one of the points.
    pub fn axis(&mut self, origin: usize, line: Line, span: Span) -> usize {
        let count = self.axes.len();
        let key = match &line {
            Line::Along(direction) => ("along", origin, direction.map(f64::to_bits)),
            Line::To { numbers, .. } => ("to", origin, numbers.map(f64::to_bits)),
        };
        let position = *self.positions.entry(key).or_insert(count);
        if position == count {
            self.axes.push(Axis { origin, line, span, name: String::new() });
        }
        position
    }

    /// Returns a circle around one of the points.
    pub fn circle(&mut self, center: usize, radius: f64, span: Span) -> usize {
        let count = self.circles.len();
        let position = *self.positions.entry(("circle", center, [radius.to_bits(), 0])).or_insert(count);
        if position == count {
            self.circles.push(Circle { center, radius, span, name: String::new() });
        }
        position
    }

    /// Gives every feature its name; after this, none is added.
    pub fn name(&mut self) {
        for k in 0..self.points.len() {
            let preferred = self.points.get(k).map_or("P".to_owned(), |point| purpose_in_a_word(&point.purposes));
            let name = self.free(&preferred);
            if let Some(point) = self.points.get_mut(k) {
                point.name = name;
            }
        }
        for k in 0..self.axes.len() {
            let is_line = self.axes.get(k).is_some_and(|axis| matches!(axis.line, Line::To { .. }));
            let name = self.free(if is_line { "line" } else { "way" });
            if let Some(axis) = self.axes.get_mut(k) {
                axis.name = name;
            }
        }
        for k in 0..self.circles.len() {
            let name = self.free("pitch");
            if let Some(circle) = self.circles.get_mut(k) {
                circle.name = name;
            }
        }
    }

    fn free(&mut self, name: &str) -> String {
        if self.used.insert(name.to_owned()) {
            return name.to_owned();
        }
        let next = self.next.entry(name.to_owned()).or_insert(2);
        loop {
            let candidate = format!("{name}_{next}");
            *next += 1;
            if self.used.insert(candidate.clone()) {
                return candidate;
            }
        }
    }

    /// Returns the name of a point.
    pub fn point_name(&self, position: usize) -> &str {
        self.points.get(position).map_or("", |point| &point.name)
    }

    /// Returns the name of an axis.
    pub fn axis_name(&self, position: usize) -> &str {
        self.axes.get(position).map_or("", |axis| &axis.name)
    }

    /// Returns the name of a circle.
    pub fn circle_name(&self, position: usize) -> &str {
        self.circles.get(position).map_or("", |circle| &circle.name)
    }

    /// Returns the declarations: points, then axes and circles.
    pub fn declarations(&self) -> Vec<Feature> {
        let feature = |name: &str, span: Span, kind: FeatureKind| Feature {
            docs: Vec::new(),
            span,
            name: build::name(name, span),
            kind,
        };
        let points = self.points.iter().map(|point| {
            let at = build::tuple(point.at.map(|x| build::length(x, point.span)).into(), point.span);
            feature(&point.name, point.span, FeatureKind::Point { at: Some(at) })
        });
        let axes = self.axes.iter().map(|axis| {
            let origin = Box::new(build::word(self.point_name(axis.origin), axis.span));
            let kind = match &axis.line {
                Line::Along(direction) => {
                    let direction = direction.map(|x| build::number(x, axis.span)).into();
                    FeatureKind::AxisAlong { origin, direction: Box::new(build::tuple(direction, axis.span)) }
                }
                Line::To { target, .. } => FeatureKind::AxisTo { origin, target: Box::new(target.clone()) },
            };
            feature(&axis.name, axis.span, kind)
        });
        let circles = self.circles.iter().map(|circle| {
            let center = Box::new(build::word(self.point_name(circle.center), circle.span));
            let radius = Box::new(build::length(circle.radius, circle.span));
            feature(&circle.name, circle.span, FeatureKind::Circle { center, radius })
        });
        points.chain(axes).chain(circles).collect()
    }
}

/// Returns a name for a point, after its first joint or else after its role in constraints.
fn purpose_in_a_word(purposes: &[Purpose]) -> String {
    for purpose in purposes {
        match purpose {
            Purpose::Joint(other) => return format!("to_{other}"),
            Purpose::Center => return "center".to_owned(),
            Purpose::PitchLine => return "Q".to_owned(),
            Purpose::Held | Purpose::Driven => {}
        }
    }
    let word = match purposes {
        [Purpose::Held] => "guided",
        [Purpose::Held, Purpose::Held, ..] => "fixed",
        _ => "driven",
    };
    word.to_owned()
}
