//! Diagnostics of parts, and of the bindings and overrides of their params and inputs.

use super::nearest_name;
use mechc_syntax::ast::{Binding, ItemKind, Mechanism, MechanismName, Name};
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::Span;

pub fn contains_itself(expected: &MechanismName, circle: &[&str]) -> Diagnostic {
    let name = &expected.name.text;
    let mut cycle: Vec<String> = circle.iter().map(|name| format!("`{name}`")).collect();
    cycle.push(format!("`{name}`"));
    let diagnostic = Diagnostic::new(Code::E0206, format!("the mechanism `{name}` contains itself"));
    diagnostic.at(expected.span(), "a part of itself").note(format!("the way round: {}", cycle.join(" → ")))
}

pub fn too_many_levels(expected: &MechanismName, most: usize) -> Diagnostic {
    Diagnostic::new(Code::E0209, format!("parts stand in parts on more than {most} levels"))
        .at(expected.span(), "too deep")
}

/// `front.foo`
pub fn unknown_in_part(path: &str, mechanism: &str, name: &Name, candidates: &[&str]) -> Diagnostic {
    Diagnostic::new(Code::E0201, format!("there is no `{}` in the part `{path}`", name.text))
        .at(name.span, format!("`{mechanism}` declares nothing of that name"))
        .fix_if(nearest_name(name, candidates))
}

/// A bound of a range that depends on a param of a part; `path` as it is written, and its location.
pub fn decided_by_a_part(place: &str, path: &str, span: Span, written: Span) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0208, format!("{place} cannot be made of `{path}`, which is in a part"));
    let diagnostic = diagnostic.at(span, "decides which declarations there are");
    let is_inside = span.file == written.file && span.start <= written.start && written.end <= span.end;
    let diagnostic = if is_inside { diagnostic } else { diagnostic.also(written, "comes in here") };
    diagnostic.help("parts are there when all ranges are known: make both of a param, and bind that of the part to it")
}

/// `b.arm.tip` without a `b`.
pub fn unknown_owner(name: &Name, tree: &Mechanism) -> Diagnostic {
    let candidates: Vec<&str> = tree
        .items
        .iter()
        .filter_map(|item| match &item.kind {
            ItemKind::Part(part) => Some(part.name.text.as_str()),
            ItemKind::Body { name, .. } => Some(name.text.as_str()),
            _ => None,
        })
        .collect();
    super::unknown("part or body", name, &candidates)
}

/// A trace where a number or point is expected; `point` is the text of its point.
pub fn trace_in_a_formula(span: Span, expected: &str, name: &Name, point: Option<&str>) -> Diagnostic {
    let diagnostic = super::wrong_kind(span, expected, "a trace");
    match (expected, point) {
        ("a number", Some(point)) => diagnostic.help(format!(
            "`{0}.x` and `{0}.y` are columns; in a formula the place of the point is `x({point})` and `y({point})`",
            name.text
        )),
        (_, Some(point)) => diagnostic.help(format!("name the point: `{point}`")),
        _ => diagnostic.help("name the point that it is of"),
    }
}

pub fn path_too_long(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0208, "a path ends with a body and a feature of it, or with another declaration of a part")
        .at(span, "goes on")
}

pub fn bound_twice(binding: &Binding, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0209, format!("`{}` is bound twice", binding.name.text))
        .at(binding.span, "bound again")
        .also(first, "first bound here")
}

pub fn no_name_to_bind(
    mechanism: &str,
    binding: &Binding,
    found: Option<&str>,
    candidates: &[&str],
    nearest: Option<&str>,
) -> Diagnostic {
    let name = &binding.name.text;
    let label = match found {
        Some(found) => format!("this is {found}"),
        None => "not declared there".to_owned(),
    };
    let listed = match candidates {
        [] => format!("`{mechanism}` has no params and no inputs"),
        _ => format!("its params and inputs are {}", super::list(candidates)),
    };
    let diagnostic = Diagnostic::new(Code::E0209, format!("`{mechanism}` has no param or input `{name}`"));
    let diagnostic = diagnostic.at(binding.name.span, label);
    match nearest {
        Some(_) => diagnostic.fix_if(nearest_name(&binding.name, candidates)),
        None => diagnostic.help(listed),
    }
}

pub fn no_coordinate_to_bind(binding: &Binding, coordinate: &Name, is_point: bool) -> Diagnostic {
    let name = &binding.name.text;
    let (message, label) = if is_point {
        (format!("a point has no `{}`", coordinate.text), format!("`{name}.x` or `{name}.y`"))
    } else {
        (format!("the param `{name}` is a number and has no coordinates"), "of a number".to_owned())
    };
    Diagnostic::new(Code::E0209, message).at(coordinate.span, label)
}

pub fn number_for_point(binding: &Binding) -> Diagnostic {
    Diagnostic::new(Code::E0209, format!("the param `{}` is a point", binding.name.text))
        .at(binding.value.span, "a number")
        .help("a point is written `(x, y)`")
}

/// Parts that carry each other, or one itself: each with the location of its `on`, and whether that names a ground.
pub fn carries_itself(parts: &[(&Name, Span, bool)]) -> Diagnostic {
    let Some((&(first, on, is_ground), rest)) = parts.split_first() else {
        return Diagnostic::new(Code::E0209, "parts are carried by themselves");
    };
    if rest.is_empty() {
        let label = if is_ground { "this stands on its own ground" } else { "this is a body of the part itself" };
        return Diagnostic::new(Code::E0209, format!("the part `{}` is carried by itself", first.text)).at(on, label);
    }
    let cycle: Vec<String> = rest.iter().chain([&parts[0]]).map(|(part, ..)| format!("`{}`", part.text)).collect();
    let message = format!("parts carry each other: `{}` stands on {}", first.text, cycle.join(", which stands on "));
    let diagnostic = Diagnostic::new(Code::E0209, message).at(on, "on the circle");
    rest.iter().fold(diagnostic, |diagnostic, (_, on, _)| diagnostic.also(*on, "on the circle"))
}

/// `--set front.reach=…` with `front: lever(reach = …)`.
pub fn bound_from_outside(noun: &str, path: &str, at: Span, binding: Span) -> Diagnostic {
    Diagnostic::new(Code::E0708, format!("the {noun} `{path}` is bound where its mechanism is used"))
        .at(at, "told from outside")
        .also(binding, "bound here")
        .help("tell what the binding is made of, or take the binding away")
}
