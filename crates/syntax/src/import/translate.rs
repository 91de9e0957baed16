//! A model to the declarations of a mechanism.
//!
//! Bodies come first, then joints, constraints and drivers, each in the order of the model. An equation whose formula
//! has no time in it is a constraint, any other a driver.

use super::adm::{Body, Constraint, Coordinate, Kind, Model, RackPinion};
use super::build;
use super::errors;
use super::features::{Features, Line, Purpose};
use super::fields::Vector;
use super::matlab::Formula;
use super::names::{self, NameRequest, Names};
use crate::ast::{DrawnPose, Expr, ExprKind, Factor, Item, ItemKind, Mechanism, Sign};
use mechc_text::diag::Diagnostics;
use mechc_text::source::Span;
use std::f64::consts::PI;

/// Longest number that replaces the formula with its value.
const SHORT: usize = 10;

/// Returns the mechanism that a model describes; `None` after a mistake, which has been reported.
pub(super) fn mechanism(model: &Model<'_>, file: &str, diagnostics: &mut Diagnostics) -> Option<Mechanism> {
    let (stem, origin) = origin(file);
    let name = names::mechanism_name(model.name, model.place, &stem, diagnostics);
    let requests: Vec<NameRequest<'_>> = model
        .bodies
        .iter()
        .map(|body| NameRequest { what: "body", name: body.name, place: body.place })
        .chain(model.constraints.iter().map(|one| NameRequest { what: "constraint", name: one.name, place: one.place }))
        .collect();
    let (list, names) = names::assign(&requests, diagnostics);
    let (bodies, constraints) = list.split_at_checked(model.bodies.len())?;
    if diagnostics.has_errors() {
        return None;
    }
    let features = bodies.iter().map(|_| Features::default()).collect();
    let mut translator = Translator { bodies, features, names };
    let planned: Vec<Plan<'_>> = model
        .constraints
        .iter()
        .zip(constraints)
        .filter_map(|(constraint, name)| translator.plan(&constraint.kind, name, diagnostics))
        .collect();
    if diagnostics.has_errors() {
        return None;
    }
    for features in &mut translator.features {
        features.name();
    }
    let mut items: Vec<Item> =
        model.bodies.iter().zip(bodies).enumerate().map(|(k, (body, name))| translator.body(k, body, name)).collect();
    let mut rest: Vec<Item> = Vec::new();
    for ((plan, constraint), name) in planned.iter().zip(&model.constraints).zip(constraints) {
        rest.extend(translator.items(plan, constraint, name));
    }
    rest.sort_by_key(|item| match item.kind {
        ItemKind::Equation { driver: false, .. } => 1,
        ItemKind::Equation { driver: true, .. } => 2,
        _ => 0,
    });
    items.extend(rest);
    let docs = vec![format!("Imported from {origin}.")];
    Some(Mechanism { docs, name: build::name(&name, model.place), span: model.place, items })
}

/// Returns a name for a model without one, and where it comes from, in words.
fn origin(file: &str) -> (String, String) {
    if file == "<stdin>" {
        return ("imported".to_owned(), "standard input".to_owned());
    }
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let stem = name.split('.').next().unwrap_or(name).to_owned();
    let shown: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    (stem, format!("`{shown}`"))
}

struct Translator<'a> {
    /// Names of the bodies.
    bodies: &'a [String],
    /// Features of each body.
    features: Vec<Features>,
    /// Names of the mechanism's space.
    names: Names,
}

/// A constraint with the features that it uses, by their positions on their bodies.
enum Plan<'a> {
    Point { coordinate: Coordinate, body: usize, point: usize, formula: &'a Formula },
    Angle { body: usize, formula: &'a Formula },
    Revolute { bodies: [usize; 2], points: [usize; 2] },
    Translational { bodies: [usize; 2], axes: [usize; 2] },
    RackPinion { parts: &'a RackPinion, line: usize, center: usize, circle: usize, distance: String },
}

impl Translator<'_> {
    fn name_of(&self, body: usize) -> &str {
        self.bodies.get(body).map_or("", String::as_str)
    }

    fn point(&mut self, body: usize, at: Vector<2>, purpose: Purpose) -> usize {
        self.features.get_mut(body).map_or(0, |features| features.point(at.values, at.span, purpose))
    }

    /// Returns the points where two bodies are joined, each named after the other body.
    fn joint_points(&mut self, bodies: [usize; 2], points: [Vector<2>; 2]) -> [usize; 2] {
        let [first, second] = bodies;
        let purpose = |other: usize, this: &Self| Purpose::Joint(this.name_of(other).to_owned());
        let (of_first, of_second) = (purpose(second, self), purpose(first, self));
        let [p, q] = points;
        [self.point(first, p, of_first), self.point(second, q, of_second)]
    }

    /// Makes the features that a constraint of this name needs.
    fn plan<'m>(&mut self, kind: &'m Kind, name: &str, diagnostics: &mut Diagnostics) -> Option<Plan<'m>> {
        Some(match kind {
            Kind::Angle { body, formula } => Plan::Angle { body: *body, formula },
            Kind::Point { coordinate, body, point, formula } => {
                let purpose = if formula.uses_time { Purpose::Driven } else { Purpose::Held };
                let point = self.point(*body, *point, purpose);
                Plan::Point { coordinate: *coordinate, body: *body, point, formula }
            }
            Kind::Revolute { bodies, points } => {
                Plan::Revolute { bodies: *bodies, points: self.joint_points(*bodies, *points) }
            }
            Kind::Translational { bodies, points, directions } => {
                let origins = self.joint_points(*bodies, *points);
                let mut axes = [0, 0];
                for (axis, ((&body, origin), along)) in axes.iter_mut().zip(bodies.iter().zip(origins).zip(directions))
                {
                    let line = Line::Along(along.values);
                    *axis = self.features.get_mut(body).map_or(0, |features| features.axis(origin, line, along.span));
                }
                Plan::Translational { bodies: *bodies, axes }
            }
            Kind::RackPinion(parts) => self.plan_rack(parts, name, diagnostics)?,
        })
    }

    fn plan_rack<'m>(&mut self, parts: &'m RackPinion, name: &str, diagnostics: &mut Diagnostics) -> Option<Plan<'m>> {
        let (p, q) = (parts.p, parts.q);
        let [[px, py], [qx, qy]] = [p.values, q.values];
        let far = [2.0 * qx - px, 2.0 * qy - py];
        let [theta1, theta2] = parts.phases.map(|phase| phase.value);
        let offset = parts.radius.value * (theta1 - theta2 + 3.0 * PI / 2.0);
        if !(far.iter().all(|x| x.is_finite()) && offset.is_finite()) {
            diagnostics.push(errors::fault(q.span, "the rack's measures are too large", "not finite"));
            return None;
        }
        let span = q.span;
        let target = build::tuple(vec![beyond(px, qx, span), beyond(py, qy, span)], span);
        let origin = self.point(parts.rack, q, Purpose::PitchLine);
        let line = Line::To { numbers: p.values, target };
        let line = self.features.get_mut(parts.rack).map_or(0, |features| features.axis(origin, line, span));
        let center = self.point(parts.pinion, parts.center, Purpose::Center);
        let radius = parts.radius;
        let circle = self
            .features
            .get_mut(parts.pinion)
            .map_or(0, |features| features.circle(center, radius.value, radius.span));
        let distance = self.names.free(&format!("{name}_distance"));
        Some(Plan::RackPinion { parts, line, center, circle, distance })
    }

    fn body(&self, k: usize, body: &Body<'_>, name: &str) -> Item {
        let span = body.pose.span;
        let [x, y, phi] = body.pose.values;
        let pose = vec![build::length(x, span), build::length(y, span), build::angle(phi, span)];
        let features = self.features.get(k).map_or(Vec::new(), Features::declarations);
        let name = build::name(name, body.name.map_or(body.place, |name| name.span));
        let pose = Some(DrawnPose { at: build::tuple(pose, span), toward: None });
        Item { docs: Vec::new(), span: body.place, ranges: Vec::new(), kind: ItemKind::Body { name, pose, features } }
    }

    fn point_expr(&self, body: usize, point: usize, span: Span) -> Expr {
        let name = self.features.get(body).map_or("", |features| features.point_name(point));
        build::member(self.name_of(body), name, span)
    }

    fn axis_expr(&self, body: usize, axis: usize, span: Span) -> Expr {
        let name = self.features.get(body).map_or("", |features| features.axis_name(axis));
        build::member(self.name_of(body), name, span)
    }

    fn items(&self, plan: &Plan<'_>, constraint: &Constraint<'_>, name: &str) -> Vec<Item> {
        let span = constraint.place;
        match plan {
            Plan::Point { coordinate, body, point, formula } => {
                let function = if *coordinate == Coordinate::X { "x" } else { "y" };
                let left = build::call(function, vec![self.point_expr(*body, *point, span)], span);
                vec![equation(name, left, formula, build::length, span)]
            }
            Plan::Angle { body, formula } => {
                let left = build::call("angle", vec![build::word(self.name_of(*body), span)], span);
                vec![equation(name, left, formula, build::angle, span)]
            }
            Plan::Revolute { bodies: [i, j], points: [p, q] } => {
                let arguments = vec![self.point_expr(*i, *p, span), self.point_expr(*j, *q, span)];
                vec![joint(name, "revolute", arguments, span)]
            }
            Plan::Translational { bodies: [i, j], axes: [a, b] } => {
                let arguments = vec![self.axis_expr(*i, *a, span), self.axis_expr(*j, *b, span)];
                vec![joint(name, "translational", arguments, span)]
            }
            Plan::RackPinion { parts, line, center, circle, distance } => {
                let circle = self.features.get(parts.pinion).map_or("", |features| features.circle_name(*circle));
                let circle = build::member(self.name_of(parts.pinion), circle, span);
                let line = self.axis_expr(parts.rack, *line, span);
                let center = self.point_expr(parts.pinion, *center, span);
                let radius = build::length(parts.radius.value, parts.radius.span);
                let mesh = vec![circle, line.clone(), mesh_offset(parts), build::word("left", span)];
                let mut hold = joint(distance, "revolute_translational", vec![center, line, radius], span);
                hold.docs.push(format!("Holds the distance, which `{name}` alone does not."));
                vec![joint(name, "rack_pinion", mesh, span), hold]
            }
        }
    }
}

fn joint(name: &str, kind: &str, arguments: Vec<Expr>, span: Span) -> Item {
    let (name, kind) = (build::name(name, span), build::name(kind, span));
    Item {
        docs: Vec::new(),
        span,
        ranges: Vec::new(),
        kind: ItemKind::Joint { name, kind, arguments, call_span: span },
    }
}

/// `left = formula`; a constant that is a number alone gets its unit.
fn equation(name: &str, left: Expr, formula: &Formula, unit: fn(f64, Span) -> Expr, span: Span) -> Item {
    let driver = formula.uses_time;
    let right = match formula.expression.bare_number() {
        Some(value) => unit(value, formula.expression.span),
        None => formula.expression.clone(),
    };
    let name = build::name(name, span);
    Item { docs: Vec::new(), span, ranges: Vec::new(), kind: ItemKind::Equation { driver, name, left, right } }
}

/// Returns a coordinate of `2Q − P`, the point as far beyond Q as P is before it: as a number where that is exact, else as a formula.
fn beyond(p: f64, q: f64, span: Span) -> Expr {
    let doubled = 2.0 * q;
    let far = doubled - p;
    // the rounding error (Knuth's two-sum) is zero if both differences reproduce the operands
    let taken = far - doubled;
    let exact = (doubled - (far - taken)).abs() + (-p - taken).abs() <= 0.0;
    // `2 * 0.1 m - 0.3 m` reads better than its 17 digits
    if exact && far.abs().to_string().len() <= SHORT {
        return build::length(far, span);
    }
    let twice = ExprKind::Product(Box::new(build::number(2.0, span)), vec![(Factor::Times, build::length(q, span))]);
    let (sign, p) = if p < 0.0 { (Sign::Plus, -p) } else { (Sign::Minus, p) };
    let kind = ExprKind::Sum(Box::new(Expr { kind: twice, span }), vec![(sign, build::length(p, span))]);
    Expr { kind, span }
}

/// `R2 * (theta1 - theta2 + 3 * pi / 2)`, without the angles that are zero.
fn mesh_offset(parts: &RackPinion) -> Expr {
    let span = parts.radius.span;
    let quarter_turns = ExprKind::Product(
        Box::new(build::number(3.0, span)),
        vec![(Factor::Times, build::word("pi", span)), (Factor::Divide, build::number(2.0, span))],
    );
    let quarter_turns = Expr { kind: quarter_turns, span };
    let [theta1, theta2] = parts.phases;
    let mut terms: Vec<(Sign, Expr)> = Vec::new();
    for (value, at) in [(theta1.value, theta1.span), (-theta2.value, theta2.span)] {
        if value.abs() > 0.0 {
            let sign = if value < 0.0 { Sign::Minus } else { Sign::Plus };
            terms.push((sign, build::number(value.abs(), at)));
        }
    }
    terms.push((Sign::Plus, quarter_turns));
    let mut terms = terms.into_iter();
    let sum = terms.next().map(|(sign, first)| {
        let first = match sign {
            Sign::Plus => first,
            Sign::Minus => Expr { span: first.span, kind: ExprKind::Negate(Box::new(first)) },
        };
        let rest: Vec<(Sign, Expr)> = terms.collect();
        if rest.is_empty() { first } else { Expr { kind: ExprKind::Sum(Box::new(first), rest), span } }
    });
    let radius = build::length(parts.radius.value, span);
    let factors = sum.map(|sum| (Factor::Times, sum)).into_iter().collect();
    Expr { kind: ExprKind::Product(Box::new(radius), factors), span }
}
