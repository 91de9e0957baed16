//! Diagnostics of masses, gravity, loads and computed forces.

use super::format_value;
use crate::check::suggest::edits::with_unit;
use crate::check::suggest::lost_rate::Part;
use crate::model::Dimension;
use mechc_syntax::ast::Name;
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::Span;

/// The reason why a load does not work on one quantity of positions.
pub enum LoadTargetError<'n> {
    /// A sum of several.
    Sum,
    /// A joint, body or point, with suitable quantities as formulas.
    Suggested(Vec<String>),
    /// Not a quantity.
    Other,
    /// `der(…)`
    Rate,
    /// A quantity that only measures may hold, by its word.
    OfMeasures(&'n str),
}

const QUANTITIES: &str = "a load works on `x`, `y`, `angle`, `distance`, `rotation` and `displacement`";

pub fn mass_of_the_ground(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0312, "the ground has no mass")
        .at(span, "nothing moves it")
        .help("a mass belongs to a body: leave this one out, or give it to the body that carries it")
}

pub fn negative_mass(span: Span, value: f64, dimension: Dimension) -> Diagnostic {
    Diagnostic::new(Code::E0418, format!("{} is below zero", dimension.in_words().trim_end_matches(" (kg*m^2)")))
        .at(span, format!("this is {}", format_value(value, dimension)))
        .help("what is cut out of a body is not declared: give the body the mass, centre and inertia that are left")
}

pub fn gravity_of_one_number(span: Span, found: &str) -> Diagnostic {
    super::wrong_kind(span, "an acceleration `(gx, gy)`", found)
        .help("where y points up it is `gravity (0, -9.81 m/s^2)`")
}

/// Warns that the gravity of a part does not count, at the part in the enclosing text.
pub fn gravity_of_a_part(part: &Name, mechanism: &str, gravity: Span) -> Diagnostic {
    Diagnostic::new(Code::W0403, format!("the gravity of `{mechanism}` does not count here"))
        .at(part.span, "a part of a mechanism without `gravity`")
        .also(gravity, "counts when it runs alone")
        .help("gravity is that of the outermost mechanism: say `gravity (gx, gy)` there, `gravity (0, 0)` where there is none")
}

pub fn load_of_a_pair(name: &Name, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("load `{}` is one number, found a pair", name.text))
        .at(span, "two numbers")
        .help("a force on a point is two loads: `FX on x(P)` and `FY on y(P)`")
}

pub fn load_on_no_quantity(name: &Name, span: Span, fault: &LoadTargetError<'_>) -> Diagnostic {
    let suggestion: String;
    let (label, help) = match fault {
        LoadTargetError::Suggested(quantities) => {
            let each: Vec<String> = quantities.iter().map(|quantity| format!("`… on {quantity}`")).collect();
            suggestion = format!("say what of it moves: {}", each.join(" or "));
            ("this is none", suggestion.as_str())
        }
        LoadTargetError::Sum => ("a sum", "a force on a sum of quantities is a load on each of them"),
        LoadTargetError::Other => ("this is none", QUANTITIES),
        LoadTargetError::Rate => {
            ("a rate", "a damper is a load on the quantity whose rate is in its formula: `load d: -c * der(K) on K`")
        }
        LoadTargetError::OfMeasures(_) => ("for measures alone", QUANTITIES),
    };
    let what = match fault {
        LoadTargetError::OfMeasures("angle") => format!("load `{}` cannot work on `angle(P, Q, R)`", name.text),
        LoadTargetError::OfMeasures(word) => format!("load `{}` cannot work on `{word}`", name.text),
        _ => format!("load `{}` works on one kinematic quantity", name.text),
    };
    Diagnostic::new(Code::E0313, what).at(span, label).help(help)
}

pub fn load_on_no_body(name: &Name, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0313, format!("load `{}` works on no body", name.text))
        .at(span, "all of this is fixed in the ground")
        .help("say what it moves: `on rotation(joint)`, `on x(body.point)`")
}

/// Reports a load whose dimension times that of its place is no energy; `text` is the formula of the force.
pub fn load_of_no_energy(name: &Name, [force, on]: [Part; 2], expected: Dimension, text: &str) -> Diagnostic {
    let fix =
        force.dimension.is(Dimension::PURE).then(|| with_unit(force.span, text, unit_of_force(expected))).flatten();
    let headline =
        format!("load `{}` on {} must be {}", name.text, words_of_place(on.dimension), words_of_force(expected));
    Diagnostic::new(Code::E0419, headline)
        .at(force.span, force.dimension.in_words())
        .also(on.span, words_of_place(on.dimension))
        .help("a force works on a length, a torque on an angle: their product is an energy")
        .change(fix)
}

/// Reports a load without any unit where one is needed; `text` is the formula of the force.
pub fn plain_load(name: &Name, span: Span, text: &str, on: Part, expected: Dimension) -> Diagnostic {
    let help =
        "a number without a unit is a torque where it works on an angle; a force says its unit: `20 N`, `1800 N/m`";
    Diagnostic::new(Code::E0419, format!("load `{}` on {} holds no unit", name.text, words_of_place(on.dimension)))
        .at(span, "no unit in it")
        .also(on.span, words_of_place(on.dimension))
        .help(help)
        .change(with_unit(span, text, unit_of_force(expected)))
}

/// Returns what a load works on, in words; an angle is a pure number.
fn words_of_place(dimension: Dimension) -> &'static str {
    if dimension.is(Dimension::PURE) { "an angle" } else { "a length" }
}

fn unit_of_force(expected: Dimension) -> &'static str {
    if expected.is(Dimension::FORCE) { "N" } else { "N*m" }
}

fn words_of_force(expected: Dimension) -> &'static str {
    if expected.is(Dimension::FORCE) { "a force (N)" } else { "a torque (N*m)" }
}

pub fn force_in(place: &str, what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0312, format!("{what} may not stand in {place}"))
        .at(span, "comes out of the motion, when that is known")
        .help("efforts and reactions stand in measures and results")
}

pub fn derivative_of_force(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "a force has no time derivative")
        .at(span, "comes out of accelerations")
        .help("`der(e, NAME)`, by an input or parameter, has a value")
}

/// Reports `effort` of something that is no driver or constraint; `joint` is the joint of that name, and `driver` the driver that refers to it.
pub fn effort_of_no_equation(name: &Name, found: &str, joint: Option<&str>, driver: Option<&str>) -> Diagnostic {
    let help = match (joint, driver) {
        (_, Some(driver)) => Some(format!("what drives it supplies `effort({driver})`")),
        (Some(joint), None) => Some(format!("what a joint exerts is `force_x({joint})`, `force_y({joint})`")),
        (None, None) if found == "a load" => Some(
            "a load gives what its formula says; an effort is what a driver or constraint has to supply".to_owned(),
        ),
        (None, None) => None,
    };
    super::wrong_kind(name.span, "a driver or constraint", found).help_if(help)
}

/// Reports the torque of a joint that has none; `driver` is the driver that refers to the joint.
pub fn no_torque(joint: &str, kind: &str, span: Span, declared: Span, driver: Option<&str>) -> Diagnostic {
    let help = match driver {
        Some(driver) => format!("what the driver supplies is `effort({driver})`"),
        None => "what a driver supplies is `effort(DRIVER)`; a load says itself what it is".to_owned(),
    };
    Diagnostic::new(Code::E0304, format!("the torque of a `{kind}` is zero"))
        .at(span, format!("`{joint}` is `{kind}`"))
        .also(declared, "declared here")
        .help(help)
}

pub fn no_force(joint: &str, kind: &str, span: Span, declared: Span) -> Diagnostic {
    Diagnostic::new(Code::E0304, format!("the force of a `{kind}` is not known"))
        .at(span, format!("`{joint}` is `{kind}`"))
        .also(declared, "declared here")
        .note("it pulls along the line of centres as hard as it was tightened, which no motion tells")
        .help(format!("its torque is known: `torque({joint})`"))
}

/// Reports a torque in a unit of energy.
pub fn torque_in_joules(span: Span, formula: Span) -> Diagnostic {
    Diagnostic::new(Code::E0402, "a torque is in newton metres, not in joules")
        .at(span, "a unit of work")
        .also(formula, "a torque")
        .help("write `in N*m`; the work of a torque is its product with an angle")
}
