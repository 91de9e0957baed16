//! What may stand at a place: by the letters with which the vocabulary writes what a word is called with.

use super::cursor::{Call, Cursor};
use mechc_syntax::ast::FeatureKind;
use mechc_text::vocabulary::{Dimension, Function, Group, JointWord, QuantityWord, ReductionWord, Word};

/// What an argument or formula may be.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Wanted {
    /// A number, of a dimension where that is known.
    Number(Option<Dimension>),
    Point,
    Axis,
    Circle,
    /// A circle or curve.
    Profile,
    Body,
    /// A joint that the quantity is about.
    Joint(&'static str),
    /// A driver or constraint.
    Equation,
    /// What derivatives are taken by.
    Variable,
    /// On which side of an axis.
    Side,
}

impl Wanted {
    /// Whether a feature is that.
    pub fn is(self, feature: &FeatureKind) -> bool {
        match feature {
            FeatureKind::Point { .. } => self == Wanted::Point,
            FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => self == Wanted::Axis,
            FeatureKind::Circle { .. } => matches!(self, Wanted::Circle | Wanted::Profile),
            FeatureKind::Curve { .. } => self == Wanted::Profile,
            FeatureKind::Mass { .. } | FeatureKind::Broken => false,
        }
    }

    /// Whether it is one of the features of a body.
    pub fn is_feature(self) -> bool {
        matches!(self, Wanted::Point | Wanted::Axis | Wanted::Circle | Wanted::Profile)
    }
}

/// What may stand at the cursor, as far as the innermost call and the declaration tell.
pub(super) fn wanted(cursor: &Cursor<'_>) -> Vec<Wanted> {
    match cursor.call().filter(|call| call.name != "[") {
        Some(call) if !call.name.is_empty() => of_call(cursor, call),
        Some(call) => vec![in_tuple(cursor, call)],
        None => at_top(cursor),
    }
}

fn of_call(cursor: &Cursor<'_>, call: Call<'_>) -> Vec<Wanted> {
    if cursor.head() == "joint" {
        return JointWord::named(call.name)
            .map(|joint| by_forms(&joint.word, call.argument, of_joint))
            .unwrap_or_default();
    }
    if cursor.window(call).is_some() {
        return vec![Wanted::Number(Some(Dimension::TIME))];
    }
    let function = Function::named(call.name);
    if let Some(quantity) = QuantityWord::named(call.name).filter(|_| function.is_none()) {
        let name = quantity.word.name;
        return by_forms(&quantity.word, call.argument, |letter| of_quantity(letter, name));
    }
    match function {
        Some(function) if function.word.name == "der" && call.argument == 1 => vec![Wanted::Variable],
        Some(function) if function.group == Group::Points => by_forms(&function.word, call.argument, of_points),
        Some(function) if function.group == Group::Pure => vec![Wanted::Number(Some(Dimension::PURE))],
        _ => vec![Wanted::Number(ReductionWord::named(call.name).and(None))],
    }
}

/// The letters of an argument in all forms that have it.
fn by_forms(word: &Word, argument: usize, of: impl Fn(&str) -> Wanted) -> Vec<Wanted> {
    let mut found = Vec::new();
    for form in word.forms {
        let arguments = form.split_once('(').map_or("", |(_, behind)| behind.trim_end_matches(')'));
        if let Some(letters) = arguments.split(',').nth(argument) {
            let wanted = of(letters.trim());
            if !found.contains(&wanted) {
                found.push(wanted);
            }
        }
    }
    found
}

fn of_joint(letters: &str) -> Wanted {
    match letters {
        "a" | "b" => Wanted::Axis,
        "c" | "d" => Wanted::Circle,
        "k" | "m" => Wanted::Profile,
        "angle" => Wanted::Number(Some(Dimension::PURE)),
        "left" | "right" => Wanted::Side,
        _ if letters.starts_with(char::is_uppercase) => Wanted::Point,
        _ => Wanted::Number(Some(Dimension::LENGTH)),
    }
}

fn of_quantity(letters: &str, quantity: &'static str) -> Wanted {
    match letters {
        "J" | "joint" => Wanted::Joint(quantity),
        "D" => Wanted::Equation,
        _ if letters.contains('.') => Wanted::Axis,
        _ if letters.starts_with(char::is_uppercase) => Wanted::Point,
        _ => Wanted::Body,
    }
}

fn of_points(letters: &str) -> Wanted {
    match letters {
        "r" => Wanted::Number(Some(Dimension::LENGTH)),
        "angle" => Wanted::Number(Some(Dimension::PURE)),
        _ => Wanted::Point,
    }
}

/// Within parentheses that nothing is called with.
fn in_tuple(cursor: &Cursor<'_>, call: Call<'_>) -> Wanted {
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
    Wanted::Number(dimension)
}

/// Outside of all parentheses.
fn at_top(cursor: &Cursor<'_>) -> Vec<Wanted> {
    match cursor.head() {
        "circle" if cursor.has("radius") => vec![Wanted::Number(Some(Dimension::LENGTH))],
        "trace" | "point" | "axis" | "circle" | "curve" | "body" => vec![Wanted::Point],
        "part" if cursor.has("on") && !cursor.has("at") => vec![Wanted::Body],
        "analysis" => vec![Wanted::Number(Some(Dimension::TIME))],
        "gravity" => vec![Wanted::Number(Some(Dimension::ACCELERATION))],
        "mass" if cursor.has("inertia") => vec![Wanted::Number(Some(Dimension::INERTIA))],
        "mass" if cursor.has("at") => vec![Wanted::Point],
        "mass" => vec![Wanted::Number(Some(Dimension::MASS))],
        "driver" | "constraint" => vec![Wanted::Number(driven(cursor))],
        _ => vec![Wanted::Number(None)],
    }
}

/// The dimension of what stands left of the `=` of an equation, where one quantity does.
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
