//! The kind of argument that is expected at the cursor, from the letters of the forms in the vocabulary.

use super::cursor::{Call, Cursor};
use mechc_syntax::ast::FeatureKind;
use mechc_text::vocabulary::{Dimension, Function, Group, JointSpec, QuantityWord, ReductionWord, Word};

/// A kind of argument or formula.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Expected {
    /// A number, with its dimension if the position requires one.
    Number(Option<Dimension>),
    Point,
    Axis,
    Circle,
    /// A circle or curve.
    Profile,
    Body,
    /// A joint that has a quantity.
    Joint(&'static str),
    /// A driver or constraint.
    Equation,
    /// A variable of differentiation.
    Variable,
    /// A side of an axis.
    Side,
    /// The word `crossed`.
    Crossed,
}

impl Expected {
    /// Returns whether a feature is of this kind.
    pub fn matches(self, feature: &FeatureKind) -> bool {
        match feature {
            FeatureKind::Point { .. } => self == Expected::Point,
            FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => self == Expected::Axis,
            FeatureKind::Circle { .. } => matches!(self, Expected::Circle | Expected::Profile),
            FeatureKind::Curve { .. } => self == Expected::Profile,
            FeatureKind::Mass { .. } | FeatureKind::Broken => false,
        }
    }

    /// Returns whether features of a body are of this kind.
    pub fn is_feature(self) -> bool {
        matches!(self, Expected::Point | Expected::Axis | Expected::Circle | Expected::Profile)
    }
}

/// Returns the kinds that may be at the cursor, from the innermost call and the declaration.
pub(super) fn expected(cursor: &Cursor<'_>) -> Vec<Expected> {
    match cursor.call().filter(|call| call.name != "[") {
        Some(call) if !call.name.is_empty() => of_call(cursor, call),
        Some(call) => vec![in_tuple(cursor, call)],
        None => at_top(cursor),
    }
}

fn of_call(cursor: &Cursor<'_>, call: Call<'_>) -> Vec<Expected> {
    if cursor.head() == "joint" {
        return JointSpec::named(call.name)
            .map(|joint| by_forms(&joint.word, call.argument, of_joint))
            .unwrap_or_default();
    }
    if cursor.window(call).is_some() {
        return vec![Expected::Number(Some(Dimension::TIME))];
    }
    let function = Function::named(call.name);
    if let Some(quantity) = QuantityWord::named(call.name).filter(|_| function.is_none()) {
        let name = quantity.word.name;
        return by_forms(&quantity.word, call.argument, |letter| of_quantity(letter, name));
    }
    match function {
        Some(function) if function.word.name == "der" && call.argument == 1 => vec![Expected::Variable],
        Some(function) if function.group == Group::Points => by_forms(&function.word, call.argument, of_points),
        Some(function) if function.group == Group::Pure => vec![Expected::Number(Some(Dimension::PURE))],
        _ => vec![Expected::Number(ReductionWord::named(call.name).and(None))],
    }
}

/// Collects the kinds of an argument in all forms that have it.
fn by_forms(word: &Word, argument: usize, of: impl Fn(&str) -> Expected) -> Vec<Expected> {
    let mut found = Vec::new();
    for form in word.forms {
        let arguments = form.split_once('(').map_or("", |(_, behind)| behind.trim_end_matches(')'));
        if let Some(letters) = arguments.split(',').nth(argument) {
            let kind = of(letters.trim());
            if !found.contains(&kind) {
                found.push(kind);
            }
        }
    }
    found
}

fn of_joint(letters: &str) -> Expected {
    match letters {
        "a" | "b" => Expected::Axis,
        "c" | "d" => Expected::Circle,
        "k" | "m" => Expected::Profile,
        "angle" => Expected::Number(Some(Dimension::PURE)),
        "left" | "right" => Expected::Side,
        "crossed" => Expected::Crossed,
        _ if letters.starts_with(char::is_uppercase) => Expected::Point,
        _ => Expected::Number(Some(Dimension::LENGTH)),
    }
}

fn of_quantity(letters: &str, quantity: &'static str) -> Expected {
    match letters {
        "J" | "joint" => Expected::Joint(quantity),
        "D" => Expected::Equation,
        _ if letters.contains('.') => Expected::Axis,
        _ if letters.starts_with(char::is_uppercase) => Expected::Point,
        _ => Expected::Body,
    }
}

fn of_points(letters: &str) -> Expected {
    match letters {
        "r" => Expected::Number(Some(Dimension::LENGTH)),
        "angle" => Expected::Number(Some(Dimension::PURE)),
        _ => Expected::Point,
    }
}

/// Returns the kind of a coordinate in plain parentheses.
fn in_tuple(cursor: &Cursor<'_>, call: Call<'_>) -> Expected {
    let behind = cursor.declaration().iter().rev().find(|token| matches!(token.text, "along" | "at" | "=" | "radius"));
    let dimension = match (cursor.head(), behind.map(|token| token.text), call.argument) {
        ("point" | "circle" | "curve", ..) | ("axis", Some("="), _) | ("body" | "part", Some("at"), 0 | 1) => {
            Some(Dimension::LENGTH)
        }
        ("body" | "part", Some("at"), 2) => Some(Dimension::PURE),
        ("analysis", ..) => Some(Dimension::TIME),
        ("gravity", ..) => Some(Dimension::ACCELERATION),
        ("mass", Some("at"), _) => Some(Dimension::LENGTH),
        _ => None,
    };
    Expected::Number(dimension)
}

/// Returns the kinds outside parentheses.
fn at_top(cursor: &Cursor<'_>) -> Vec<Expected> {
    match cursor.head() {
        "circle" if cursor.has("radius") => vec![Expected::Number(Some(Dimension::LENGTH))],
        "trace" | "point" | "axis" | "circle" | "curve" | "body" => vec![Expected::Point],
        "part" if cursor.has("on") && !cursor.has("at") => vec![Expected::Body],
        "analysis" => vec![Expected::Number(Some(Dimension::TIME))],
        "gravity" => vec![Expected::Number(Some(Dimension::ACCELERATION))],
        "mass" if cursor.has("inertia") => vec![Expected::Number(Some(Dimension::INERTIA))],
        "mass" if cursor.has("at") => vec![Expected::Point],
        "mass" => vec![Expected::Number(Some(Dimension::MASS))],
        "driver" | "constraint" => vec![Expected::Number(driven(cursor))],
        _ => vec![Expected::Number(None)],
    }
}

/// Returns the dimension of the quantity left of the `=` of an equation, if it is a single one.
fn driven(cursor: &Cursor<'_>) -> Option<Dimension> {
    let tokens = cursor.declaration();
    tokens.iter().position(|token| token.text == "=")?;
    let colon = tokens.iter().position(|token| token.text == ":")?;
    match tokens.get(colon + 1)?.text {
        "rotation" | "angle" => Some(Dimension::PURE),
        "displacement" | "distance" | "x" | "y" => Some(Dimension::LENGTH),
        _ => None,
    }
}
