//! Diagnostics of points.

use super::{list, nearest_name, unknown, wrong_kind};
use mechc_syntax::ast::Name;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix};
use mechc_text::source::Span;

/// `candidates` are the points of its body and of the mechanism.
pub fn unknown_point(name: &Name, candidates: &[&str]) -> Diagnostic {
    let diagnostic = unknown("point", name, candidates);
    if !diagnostic.help.is_empty() {
        return diagnostic;
    }
    let written = format!("a point of the mechanism is a param: `param {} = (x, y)`", name.text);
    match candidates {
        [] => diagnostic.help(written),
        _ => diagnostic.help(format!("the points here are {}", list(candidates))).help(written),
    }
}

/// A lone `point A` without a point `A` of the mechanism.
pub fn no_point_to_take(name: &Name, other: Option<&str>, candidates: &[&str]) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0201, format!("the mechanism has no point `{}`", name.text));
    let diagnostic = match other {
        Some(noun) => diagnostic.at(name.span, format!("`{}` is {noun}", name.text)),
        None => diagnostic.at(name.span, "not declared").fix_if(nearest_name(name, candidates)),
    };
    diagnostic.help(format!("say where it lies: `point {} = (x, y)`", name.text))
}

/// `at A` without an angle.
pub fn no_angle_of_pose(span: Span, text: &str) -> Diagnostic {
    let fix = Fix::replace(
        span,
        format!("({text}, 0 deg)"),
        format!("a pose has an angle too: `at ({text}, 0 deg)`"),
        Applicability::Probably,
    );
    Diagnostic::new(Code::E0301, "a pose is a point and an angle, and this is a point alone")
        .at(span, "no angle")
        .fix(fix)
        .help(format!("or let the body go from there to another point: `at {text} toward Q`"))
}

/// A point where a number is expected.
pub fn point_as_number(name: &Name) -> Diagnostic {
    let diagnostic = wrong_kind(name.span, "a number", "a point");
    diagnostic.help(format!("its coordinates are `{0}.x` and `{0}.y`", name.text))
}

/// `A.x` where a point is expected.
pub fn redundant_owner(span: Span, owner: &str, feature: &str) -> Diagnostic {
    let fix = Fix::replace(span, feature, format!("within `{owner}` it is `{feature}`"), Applicability::Always);
    Diagnostic::new(Code::E0302, format!("a feature of `{owner}` is named alone in the braces of `{owner}`"))
        .at(span, "with its owner")
        .fix(fix)
}

pub fn coordinate_as_point(span: Span, owner: &Name) -> Diagnostic {
    let diagnostic = wrong_kind(span, "a point", "a number");
    diagnostic.help(format!("the point is `{}`", owner.text))
}

/// `A.z`
pub fn no_coordinate(owner: &Name, feature: &Name) -> Diagnostic {
    Diagnostic::new(Code::E0201, format!("a point has no `{}`", feature.text))
        .at(feature.span, "not a coordinate")
        .help(format!("the coordinates of `{0}` are `{0}.x` and `{0}.y`", owner.text))
}

/// `crank.pin` in a formula of points that is not after `at`.
pub fn moving_point(span: Span, owner: &str, feature: &str) -> Diagnostic {
    let help = "a point of the drawing is a param: `param A = (x, y)`";
    let diagnostic = wrong_kind(span, "a point of the drawing", &format!("a point of `{owner}`"));
    match owner {
        "ground" => diagnostic.help(format!("{help}, which `point {feature} = A` takes to the ground")),
        _ => diagnostic.help(help),
    }
}

/// `length` of points of bodies, with the texts of its arguments.
pub fn length_of_moving(name: &Name, member: Span, arguments: [&str; 2]) -> Diagnostic {
    let [p, q] = arguments;
    let message = format!("how far points of bodies are from each other is `distance({p}, {q})`");
    wrong_kind(member, "a point of the drawing", "a point of a body").fix(Fix::replace(
        name.span,
        "distance",
        message,
        Applicability::Probably,
    ))
}

/// A product of two points, or a division by a point.
pub fn product_of_points(span: Span, is_divisor: bool) -> Diagnostic {
    let (message, label) = if is_divisor {
        ("a point cannot be divided by", "the divisor is a point")
    } else {
        ("a point cannot be multiplied by a point", "another point")
    };
    Diagnostic::new(Code::E0302, message)
        .at(span, label)
        .help("points are added and subtracted, and multiplied and divided by numbers")
}

/// Reports points of different frames in one formula.
pub fn two_frames(body: &str, of_body: Span, other: Span) -> Diagnostic {
    Diagnostic::new(Code::E0318, format!("this formula takes a point of `{body}` and one of the mechanism"))
        .at(other, "a point of the mechanism, as it is drawn")
        .also(of_body, format!("a point of `{body}`, in its own frame"))
        .help(format!(
            "`{body}` is placed with `at`, so its frame is another one: give a length or angle of the mechanism's points a name with \
             `param`, or draw the body in place, without `at`"
        ))
}

/// Reports a direction between two points that coincide; `what` names what needs it.
pub fn points_coincide(what: &str, span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0405, format!("{what} needs two points that differ, and these coincide"))
        .at(span, "no direction")
        .help("a direction is that of the way from the first point to the second")
}

/// Reports `--set A=5mm` for a point.
pub fn point_set_to_number(name: &Name, span: Span) -> Diagnostic {
    let name = &name.text;
    wrong_kind(span, "a point", "a number")
        .help(format!("`{name}` is a point: `--set {name}=(12mm,0)`, or one of its coordinates: `--set {name}.x=12mm`"))
}

/// Reports `--set r.x=5mm` for a number.
pub fn coordinate_of_number(name: &Name, k: usize, span: Span) -> Diagnostic {
    let (name, coordinate) = (&name.text, ["x", "y"][k.min(1)]);
    Diagnostic::new(Code::E0703, format!("the parameter `{name}` is a number, and has no `{coordinate}`"))
        .at(span, format!("`{name}` is no point"))
        .help(format!("set the number itself: `--set {name}=…`"))
}
