//! Diagnostics of words that are not allowed where they stand.

use super::{list, some_of};
use mechc_syntax::ast::Name;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix};
use mechc_text::source::Span;
use mechc_text::vocabulary::{JOINTS, JointMotion, JointSpec};

pub fn not_callable(name: &Name, noun: &str) -> Diagnostic {
    Diagnostic::new(Code::E0302, format!("`{}` is {noun}, and cannot be called", name.text))
        .at(name.span, "called here")
        .fix(Fix::append(name.span, " * ", "a product is written with `*`", Applicability::Probably))
}

pub fn joint_with_itself(joint: &Name, frame: &str, spans: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0303, format!("joint `{}` joins `{frame}` with itself", joint.text))
        .at(spans[1], format!("this is on `{frame}` too"))
        .also(spans[0], format!("on `{frame}`"))
        .help("a joint needs features of two different bodies, or of a body and the ground")
}

pub fn joint_without(quantity: &str, joint: &str, kind: &JointSpec, span: Span, declared: Span) -> Diagnostic {
    let is_motion = |spec: &JointSpec| spec.motion.is_some_and(|motion| motion.quantity() == quantity);
    let expected: Vec<&str> = JOINTS.iter().filter(|spec| spec.has_quantity(quantity)).map(JointSpec::name).collect();
    let other = kind.motion.filter(|_| JOINTS.iter().any(is_motion)).map(JointMotion::quantity);
    let expected = if let [only] = expected[..] { only.to_owned() } else { list(&expected) };
    Diagnostic::new(Code::E0304, format!("only {expected} joints have a `{quantity}`"))
        .at(span, format!("`{joint}` is `{}`", kind.name()))
        .also(declared, "declared here")
        .help_if(other.map(|other| format!("was `{other}({joint})` meant?")))
}

pub fn axes_elsewhere(joint: &str, axis: &str, span: Span, expected: &str) -> Diagnostic {
    Diagnostic::new(Code::E0305, format!("axis `{axis}` is not on `{expected}`, which joint `{joint}` asks for here"))
        .at(span, format!("an axis of `{expected}` is wanted"))
        .help(format!("the first axis is of the first body of `{joint}`, the second of its second"))
}

pub fn time_in(place: &str, span: Span, through: Option<(&str, Span)>) -> Diagnostic {
    let diagnostic = match through {
        None => Diagnostic::new(Code::E0306, format!("time `t` may not stand in {place}")).at(span, "depends on time"),
        Some((function, at)) => {
            Diagnostic::new(Code::E0306, format!("`{function}` depends on time, which may not stand in {place}"))
                .at(span, "brings time in")
                .also(at, "time comes in here")
        }
    };
    match place {
        "a constraint" => diagnostic.help("an equation that holds time is a `driver`"),
        "`gravity`" => diagnostic.help("where it changes it is a load on each body: `load pull: … on y(P)`"),
        "the second argument of `at`" => diagnostic.help("it is a constant, as `0.5 s`"),
        _ => diagnostic.help("what moves with time is prescribed by a `driver`, of a joint, a body or a point"),
    }
}

/// Time is allowed where an input is not only in the formula of an input.
pub fn input_in(place: &str, name: &Name, in_an_input: bool) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0306, format!("the input `{}` may not stand in {place}", name.text))
        .at(name.span, "changes with time");
    match (in_an_input, place) {
        (true, _) => diagnostic.help("an input is a signal of its own; what several hold in common is an `fn` of `t`"),
        (false, "a constraint") => diagnostic.help("an equation that holds an input is a `driver`"),
        (false, _) => diagnostic.help("an input may stand in drivers, loads and measures; a constant is a `param`"),
    }
}

/// An override of an unknown param or input.
pub fn no_such_name(
    noun: &str,
    mechanism: &str,
    name: &str,
    candidates: &[&str],
    suggestion: Option<&str>,
) -> Diagnostic {
    let listed = match candidates {
        [] => format!("it has no {noun}s"),
        _ => format!("its {noun}s are {}", some_of(candidates)),
    };
    Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no {noun} `{name}`"))
        .help(suggestion.map_or(listed, |name| format!("was `{name}` meant?")))
}

/// A column of samples whose header is not an input, but was probably intended as one with a unit.
pub fn column_of_no_input(mechanism: &str, header: &str, span: Span, suggestion: &str) -> Diagnostic {
    Diagnostic::new(Code::E0703, format!("mechanism `{mechanism}` has no input `{header}`"))
        .at(span, "the header of a column")
        .help(suggestion)
}

pub fn duplicate_override(name: &str, places: [Span; 2]) -> Diagnostic {
    Diagnostic::new(Code::E0706, format!("the input `{name}` is told twice"))
        .at(places[0], "told here")
        .also(places[1], "and here")
        .help("an input is what one of `--input` and `--samples` says")
}

pub fn quantity_in(place: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0307, format!("the kinematic quantity `{name}` may not stand in {place}"))
        .at(span, "depends on the motion")
        .help("kinematic quantities stand in constraints, drivers, loads and measures")
}

/// A quantity that only measures and traces may hold.
pub fn quantity_of_measures(place: &str, name: &str, span: Span) -> Diagnostic {
    let what = if name == "angle" { "angle(P, Q, R)" } else { name };
    Diagnostic::new(Code::E0307, format!("the kinematic quantity `{what}` may not stand in {place}"))
        .at(span, "for measures and traces alone")
        .help(match place {
            "a load" => "loads are made of `x`, `y`, `angle`, `distance`, `rotation`, `displacement` and their `der`",
            _ => "drivers and constraints are made of `x`, `y`, `angle`, `distance`, `rotation` and `displacement`",
        })
}

pub fn no_quantity(driver: bool, name: &Name, span: Span) -> Diagnostic {
    let what = if driver { "driver" } else { "constraint" };
    Diagnostic::new(Code::E0308, format!("{what} `{}` holds no kinematic quantity", name.text))
        .at(span, "an equation about no body")
        .help("say what it is about: `rotation(joint) = …`, `x(body.point) = …`")
}

pub fn no_moving_body(driver: bool, name: &Name, span: Span) -> Diagnostic {
    let what = if driver { "driver" } else { "constraint" };
    Diagnostic::new(Code::E0311, format!("no body takes part in {what} `{}`", name.text))
        .at(span, "nothing in it moves, or all that moves cancels")
        .help("an equation needs a point, axis or angle of a body")
}

pub fn condition_as_number(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0309, "a condition cannot stand where a number is wanted")
        .at(span, "true or false")
        .help("choose a number by it: `if … then 1 else 0`")
}

pub fn number_as_condition(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0309, "a number cannot stand where a condition is wanted")
        .at(span, "expected a comparison")
        .help("compare it: `… > 0`")
}

pub fn derivative_in(place: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("`der` may not stand in {place}"))
        .at(span, "a time derivative along the motion")
        .help("`der` stands in measures, results and loads; a driver prescribes a speed by its formula: `rotation(joint) = 2 rad/s * t`")
}

pub fn derivative_by_in(place: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, format!("`der(e, NAME)` may not stand in {place}"))
        .at(span, "a derivative by an input or parameter")
        .help("it stands in measures, traces and results")
}

pub fn derivative_too_high(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0310, "`der` is nested deeper than three")
        .at(span, "a fourth time derivative")
        .help("the third derivative (jerk) is the last that is computed")
}
