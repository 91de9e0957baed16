//! A model file as typed data: bodies and constraints, with everything checked that can be checked without the language that it goes to.

use super::errors;
use super::fields::{Fields, Number, Vector, location_of, name_of, objects};
use super::matlab::{self, Formula};
use super::value::{Kind as Json, Quoted, Value};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::Span;

/// A model.
pub(super) struct Model<'a> {
    pub name: Option<&'a Quoted>,
    pub place: Span,
    pub bodies: Vec<Body<'a>>,
    pub constraints: Vec<Constraint<'a>>,
}

/// A body with its estimated pose: x, y, φ.
pub(super) struct Body<'a> {
    pub name: Option<&'a Quoted>,
    pub place: Span,
    pub pose: Vector<3>,
}

/// A constraint.
pub(super) struct Constraint<'a> {
    pub name: Option<&'a Quoted>,
    pub place: Span,
    pub kind: Kind,
}

/// A coordinate in the global frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Coordinate {
    X,
    Y,
}

/// Kinds of constraints; bodies are positions in the list.
pub(super) enum Kind {
    Point { coordinate: Coordinate, body: usize, point: Vector<2>, formula: Formula },
    Angle { body: usize, formula: Formula },
    Revolute { bodies: [usize; 2], points: [Vector<2>; 2] },
    Translational { bodies: [usize; 2], points: [Vector<2>; 2], directions: [Vector<2>; 2] },
    RackPinion(RackPinion),
}

/// A rack, whose pitch line goes from P to Q, and a pinion.
pub(super) struct RackPinion {
    pub rack: usize,
    pub pinion: usize,
    pub p: Vector<2>,
    pub q: Vector<2>,
    pub center: Vector<2>,
    pub radius: Number,
    /// `theta1` of the rack and `theta2` of the pinion.
    pub phases: [Number; 2],
}

const TYPES: &[&str] =
    &["AbsoluteX", "AbsoluteY", "AbsoluteAngle", "RevoluteJoint", "TranslationalJoint", "RackPinion"];

/// Reads a model; `None` if the file is not a model. Reports every mistake that it finds.
pub(super) fn read<'a>(value: &'a Value, diagnostics: &mut Diagnostics) -> Option<Model<'a>> {
    let Json::Object(members) = &value.kind else {
        let message = format!("a model must be an object, found {}", value.describe());
        diagnostics.push(errors::fault(value.span, message, "expected `{`"));
        return None;
    };
    // an object without keys is short enough to be shown whole
    let place = members.first().map_or(value.span, |(key, _)| key.span);
    let fields = Fields::new(value, "the model", place);
    let name = name_of(value, diagnostics);
    let bodies = fields.list("bodies", diagnostics);
    let constraints = fields.list("constraints", diagnostics);
    let (bodies, constraints) = (bodies?, constraints?);
    if bodies.is_empty() {
        let span = value.get("bodies").map_or(place, |list| list.span);
        diagnostics.push(errors::fault(span, "the model has no bodies", "an empty list"));
    }
    let count = bodies.len();
    let bodies =
        objects("bodies", bodies, diagnostics).into_iter().filter_map(|object| body(object, diagnostics)).collect();
    let constraints = objects("constraints", constraints, diagnostics)
        .into_iter()
        .filter_map(|object| Reader::new(object, count).constraint(diagnostics))
        .collect();
    Some(Model { name, place, bodies, constraints })
}

fn body<'a>(object: &'a Value, diagnostics: &mut Diagnostics) -> Option<Body<'a>> {
    let place = location_of(object);
    let name = name_of(object, diagnostics);
    let what = name.map_or("the body".to_owned(), |name| format!("body `{}`", name.text));
    let pose = Fields::new(object, what, place).vector("q0", "[0, 0, 0]", diagnostics)?;
    Some(Body { name, place, pose })
}

/// Reads one constraint.
struct Reader<'a> {
    object: &'a Value,
    fields: Fields<'a>,
    place: Span,
    /// Number of bodies.
    bodies: usize,
}

impl<'a> Reader<'a> {
    fn new(object: &'a Value, bodies: usize) -> Reader<'a> {
        let place = location_of(object);
        let name = match object.get("name").map(|name| &name.kind) {
            Some(Json::Text(name)) => format!("constraint `{}`", name.text),
            _ => "the constraint".to_owned(),
        };
        Reader { object, fields: Fields::new(object, name, place), place, bodies }
    }

    fn constraint(&self, diagnostics: &mut Diagnostics) -> Option<Constraint<'a>> {
        let name = name_of(self.object, diagnostics);
        let kind = self.fields.text("type", &format!("`\"type\": \"{}\"`, say", TYPES[3]), diagnostics)?;
        let kind = match kind.text.as_str() {
            "AbsoluteX" => self.point(Coordinate::X, diagnostics),
            "AbsoluteY" => self.point(Coordinate::Y, diagnostics),
            "AbsoluteAngle" => {
                let body = self.body("body1", diagnostics);
                let formula = self.formula(diagnostics);
                body.zip(formula).map(|(body, formula)| Kind::Angle { body, formula })
            }
            "RevoluteJoint" => {
                let (bodies, points) = (self.two_bodies(diagnostics), self.two_points(diagnostics));
                bodies.zip(points).map(|(bodies, points)| Kind::Revolute { bodies, points })
            }
            "TranslationalJoint" => self.translational(diagnostics),
            "RackPinion" => self.rack_pinion(diagnostics),
            unknown => {
                diagnostics.push(errors::unknown_type(unknown, kind.span, TYPES));
                None
            }
        };
        Some(Constraint { name, place: self.place, kind: kind? })
    }

    fn point(&self, coordinate: Coordinate, diagnostics: &mut Diagnostics) -> Option<Kind> {
        let body = self.body("body1", diagnostics);
        let point = self.fields.vector("sP1", "[0, 0]", diagnostics);
        let formula = self.formula(diagnostics);
        Some(Kind::Point { coordinate, body: body?, point: point?, formula: formula? })
    }

    fn translational(&self, diagnostics: &mut Diagnostics) -> Option<Kind> {
        let (bodies, points) = (self.two_bodies(diagnostics), self.two_points(diagnostics));
        let (first, second) = (self.direction("vP1", diagnostics), self.direction("vP2", diagnostics));
        Some(Kind::Translational { bodies: bodies?, points: points?, directions: [first?, second?] })
    }

    fn rack_pinion(&self, diagnostics: &mut Diagnostics) -> Option<Kind> {
        let bodies = self.two_bodies(diagnostics);
        let p: Option<Vector<2>> = self.fields.vector("sP1", "[0, 0]", diagnostics);
        let q: Option<Vector<2>> = self.fields.vector("sQ1", "[1, 0]", diagnostics);
        let center = self.fields.vector("sP2", "[0, 0]", diagnostics);
        let radius = self.fields.number_with("R2", (|r| r > 0.0, "positive"), diagnostics);
        let (theta1, theta2) = (self.fields.number("theta1", diagnostics), self.fields.number("theta2", diagnostics));
        if let (Some(p), Some(q)) = (p, q)
            && p.values.iter().zip(q.values).all(|(&p, q)| same(p, q))
        {
            let message = "the pitch line needs two points, and `sP1` and `sQ1` are one";
            diagnostics.push(errors::fault(q.span, message, "the same point").also(p.span, "this point"));
            return None;
        }
        let [rack, pinion] = bodies?;
        let phases = [theta1?, theta2?];
        Some(Kind::RackPinion(RackPinion { rack, pinion, p: p?, q: q?, center: center?, radius: radius?, phases }))
    }

    fn direction(&self, key: &str, diagnostics: &mut Diagnostics) -> Option<Vector<2>> {
        let direction: Vector<2> = self.fields.vector(key, "[1, 0]", diagnostics)?;
        if direction.values.iter().all(|&x| same(x, 0.0)) {
            diagnostics.push(errors::fault(
                direction.span,
                format!("`{key}` is a direction of length zero"),
                "no direction",
            ));
            return None;
        }
        Some(direction)
    }

    fn two_points(&self, diagnostics: &mut Diagnostics) -> Option<[Vector<2>; 2]> {
        let (first, second) =
            (self.fields.vector("sP1", "[0, 0]", diagnostics), self.fields.vector("sP2", "[0, 0]", diagnostics));
        Some([first?, second?])
    }

    fn two_bodies(&self, diagnostics: &mut Diagnostics) -> Option<[usize; 2]> {
        let (first, second) = (self.body("body1", diagnostics), self.body("body2", diagnostics));
        let (first, second) = (first?, second?);
        if first == second {
            let span = |key| self.object.get(key).map_or(self.place, |value| value.span);
            let name = self.object.get("name").map_or("", |name| match &name.kind {
                Json::Text(name) => &name.text,
                _ => "",
            });
            diagnostics.push(errors::with_itself(name, span("body1"), span("body2")));
            return None;
        }
        Some([first, second])
    }

    /// Returns a body by its position from 1, as a position from 0.
    fn body(&self, key: &str, diagnostics: &mut Diagnostics) -> Option<usize> {
        let number = self.fields.number(key, diagnostics)?;
        // a whole number prints without a point, and nothing else reads back as one
        let position = number.value.to_string().parse().ok().filter(|k| (1..=self.bodies).contains(k));
        if position.is_none() {
            diagnostics.push(errors::no_such_body(key, number.value, number.span, self.bodies));
        }
        position.map(|position| position - 1)
    }

    fn formula(&self, diagnostics: &mut Diagnostics) -> Option<Formula> {
        let text = self.fields.text("fun", "`\"fun\": \"0\"`, say", diagnostics)?;
        matlab::translate(text).map_err(|fault| diagnostics.push(*fault)).ok()
    }
}

/// Returns whether two numbers are equal.
fn same(a: f64, b: f64) -> bool {
    a.partial_cmp(&b).is_some_and(std::cmp::Ordering::is_eq)
}

/// Returns a note on the content that a kinematic model cannot represent, if there is any.
pub(super) fn left_behind(model: &Value) -> Option<Diagnostic> {
    let items = |key: &str| match model.get(key).map(|value| &value.kind) {
        Some(Json::List(list)) => list.as_slice(),
        _ => &[],
    };
    let mut what = Vec::new();
    let forces: Vec<&Value> =
        items("forces").iter().filter(|force| !matches!(&force.kind, Json::Object(keys) if keys.is_empty())).collect();
    match forces.len() {
        0 => {}
        1 => what.push("1 force".to_owned()),
        count => what.push(format!("{count} forces")),
    }
    let mut places: Vec<Span> = forces.into_iter().map(location_of).collect();
    let has = |key: &str| model.get(key).is_some();
    let of_a_body = |key: &str| items("bodies").iter().any(|body| body.get(key).is_some());
    for (there, name) in [
        (has("gravity"), "gravity"),
        (of_a_body("mass"), "masses"),
        (of_a_body("jbar"), "moments of inertia"),
        (of_a_body("qd0"), "initial velocities"),
        (has("vis") || of_a_body("vis"), "drawing data"),
    ] {
        if there {
            what.push(name.to_owned());
        }
    }
    let unused: Vec<Span> = items("constraints").iter().filter_map(unused_formula).collect();
    if !unused.is_empty() {
        what.push("formulas of joints".to_owned());
        places.extend(unused);
    }
    (!what.is_empty()).then(|| errors::left_behind(&what, places))
}

/// Returns the span of a joint's nonempty `fun`, for which a joint has no use.
fn unused_formula(constraint: &Value) -> Option<Span> {
    let text = |key: &str| match constraint.get(key).map(|value| &value.kind) {
        Some(Json::Text(text)) => Some(text),
        _ => None,
    };
    let is_joint = matches!(text("type")?.text.as_str(), "RevoluteJoint" | "TranslationalJoint" | "RackPinion");
    let fun = text("fun")?;
    let says_nothing = matches!(fun.text.trim(), "" | "0" | "NONE");
    (is_joint && !says_nothing).then_some(fun.span)
}
