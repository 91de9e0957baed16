//! A start that cannot be assembled, or not as it is drawn.

use super::{at, cut_list, degrees, length, named, three_digits, with_places};
use crate::analysis::assembly::Moved;
use crate::analysis::branches::{Doubt, Off};
use crate::analysis::open_loop::{Link, LinkOf, OpenLoop};
use crate::diag::{Applies, Code, Diagnostic, Fix, readable};
use crate::ir::{ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind, Fit, JointKind};
use crate::math;
use crate::tolerances::determinacy::fits::LARGEST_MISFIT;
use serde_json::{Value, json};

/// Where a gap has another order of magnitude than the mechanism.
const FAR_OFF: &str =
    "that is far more than the mechanism's size: look for a length whose unit is missing or another one";

/// A loop that does not close.
pub fn open_loop(system: &ConstraintSystem, open: &OpenLoop, t: f64) -> Diagnostic {
    let declaration = &system.declarations[open.at];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let far = if open.kind == CoordinateKind::Length { 100.0 * system.length } else { std::f64::consts::TAU };
    let is_joint = matches!(declaration.kind, DeclarationKind::Joint(_));
    if open.by > far && !(is_joint && open.by.is_finite()) {
        return without_value(system, open, t);
    }
    let by = if open.kind == CoordinateKind::Length { length(open.by) } else { degrees(open.by) };
    // loops stay open, and what is asked of a body is missed
    let open_word = if is_joint { "open" } else { "off" };
    let message = format!("the mechanism cannot be assembled at {}: {noun} `{name}` stays {open_word} by {by}", at(t));
    let mut diagnostic = Diagnostic::new(Code::E0601, message)
        .at(declaration.span, format!("{open_word} by {by}"))
        .datum("t", t)
        .datum("residual", open.residual)
        .datum("lengths", open.links.iter().map(|link| link_as_data(system, link)).collect::<Vec<_>>());
    let others: Vec<DeclarationId> = open.declarations.iter().copied().filter(|&k| k != open.at).collect();
    diagnostic = with_places(diagnostic, system, &others, ["beside this", "the loop goes through these"]);
    for (too_short, what) in [(true, "too short"), (false, "too long")] {
        let links = open.links.iter().filter(|link| link.too_short == too_short);
        let names: Vec<String> = links.map(|link| link_in_words(system, link)).collect();
        if !names.is_empty() {
            diagnostic = diagnostic.note(format!("{what}: {}", cut_list(&names)));
        }
    }
    if open.by > far {
        return diagnostic.help(FAR_OFF);
    }
    let driver = open.declarations.iter().find(|&&k| system.declarations[k].kind == DeclarationKind::Driver);
    let driver = driver
        .map_or(String::new(), |&k| format!(", or begin with another value of `{}`", system.declarations[k].name));
    let mend = if open.links.is_empty() {
        format!(
            "look at what these joints hold{driver}; estimates in `at` that are nearer to the position meant may help too"
        )
    } else {
        let least = at_least(open.by);
        let least = if open.kind == CoordinateKind::Length { length(least) } else { degrees(least) };
        format!("change one of these lengths, by {least} at least, and by more where it stands across the gap{driver}")
    };
    diagnostic.help(mend)
}

/// An equation that no motion brings nearer to what it is to be.
fn without_value(system: &ConstraintSystem, open: &OpenLoop, t: f64) -> Diagnostic {
    let declaration = &system.declarations[open.at];
    let (noun, name) = (declaration.kind.noun(), &declaration.name);
    let message =
        format!("the mechanism cannot be assembled at {}: {noun} `{name}` does not hold in any position", at(t));
    let (label, help) = match declaration.kind {
        DeclarationKind::Joint(_) => ("no motion brings its bodies nearer to each other", FAR_OFF),
        _ => (
            "no motion brings its two sides nearer to each other",
            "look at the values that its two sides can have, and at their units",
        ),
    };
    Diagnostic::new(Code::E0601, message)
        .at(declaration.span, label)
        .help(help)
        .datum("t", t)
        .datum("residual", open.residual)
}

/// Rounded up to three digits.
fn at_least(value: f64) -> f64 {
    let digit = math::pow(10.0, math::log10(value).floor() - 2.0);
    (value / digit).ceil() * digit
}

/// What a length is of, and between which declarations it is.
fn link_as_data(system: &ConstraintSystem, link: &Link) -> Value {
    let is = if link.too_short { "too short" } else { "too long" };
    match link.of {
        LinkOf::Declaration(k) => json!({ "of": system.declarations[k].name, "length": link.length, "is": is }),
        LinkOf::Body(body, ends) => {
            let of = body.map_or("ground", |body| &system.bodies[body].name);
            let [from, to] = ends.map(|k| &system.declarations[k].name);
            json!({ "of": of, "from": from, "to": to, "length": link.length, "is": is })
        }
    }
}

/// `coupler` (40 mm from `front` to `back`)
fn link_in_words(system: &ConstraintSystem, link: &Link) -> String {
    let length = length(link.length);
    match link.of {
        LinkOf::Declaration(k) => format!("`{}` ({length})", system.declarations[k].name),
        LinkOf::Body(body, [from, to]) => {
            let body = body.map_or("the ground".to_owned(), |body| format!("`{}`", system.bodies[body].name));
            let [from, to] = [from, to].map(|k| &system.declarations[k].name);
            format!("{body} ({length} from `{from}` to `{to}`)")
        }
    }
}

/// A position that does not come, for no reason that can be told.
pub fn cannot_assemble(system: &ConstraintSystem, row: usize, residual: f64, t: f64) -> Diagnostic {
    let message = format!("the mechanism cannot be assembled at {}: {} stays open", at(t), named(system, row));
    Diagnostic::new(Code::E0601, message)
        .at(system.declaration_of(row).span, format!("is not met, by {} of the mechanism's size", three_digits(residual)))
        .help("give estimates in `at` that are nearer to the position meant; or check the lengths and the driver's first value")
        .datum("t", t)
        .datum("residual", residual)
}

/// A remark where the estimates leave in doubt that the position taken is the one meant.
///
/// From the estimates to the assembled position.
pub fn far_estimates(
    system: &ConstraintSystem,
    perturbed: bool,
    doubt: Option<Doubt>,
    [from, to]: [&[f64]; 2],
    t: f64,
) -> Option<Diagnostic> {
    let assembled = || assembled_poses(system, from, to);
    if perturbed {
        let message = format!("the estimates do not say which way the mechanism is assembled at {}", at(t));
        return Some(
            Diagnostic::new(Code::N0601, message)
                .at(system.span, "one of several positions was taken")
                .help("give estimates in `at` that are nearer to the position meant")
                .change(assembled()),
        );
    }
    let doubt = doubt?;
    let body = &system.bodies[doubt.body];
    let how = match doubt.off {
        Off::Moved(by) => format!("moved by {}", length(by)),
        Off::Turned(by) => format!("turned by {}", degrees(by)),
    };
    Some(
        Diagnostic::new(Code::N0601, format!("body `{}` was {how} by the assembly at {}", body.name, at(t)))
            .at(body.span, "far from its estimate")
            .help("if this is not the branch meant, give better estimates in `at`")
            .change(assembled()),
    )
}

/// The assembled poses as the estimates of those bodies that assembly has moved by more than rounding.
fn assembled_poses(system: &ConstraintSystem, from: &[f64], to: &[f64]) -> Option<Fix> {
    let mut edits = Vec::new();
    for (id, body) in system.bodies.pairs() {
        let pose @ [x, y, phi] = system.pose_of(id);
        let has_moved = |&column: &usize| (to[column] - from[column]).abs() > 1e-6 * system.coordinates[column].scale;
        if !pose.iter().any(has_moved) {
            continue;
        }
        let nine = |value: f64| format!("{value:.8e}").parse().unwrap_or(value) + 0.0;
        let [x, y] = [x, y].map(|column| if to[column].abs() < 1e-12 { 0.0 } else { nine(1e3 * to[column]) });
        let phi = if to[phi].abs() < 1e-12 { 0.0 } else { nine(to[phi].to_degrees()) };
        let pose = format!("({x} mm, {y} mm, {phi} deg)");
        let written = match body.pose_span {
            Some(span) => Fix::replace(span, pose, "", Applies::Probably),
            None => Fix::append(body.span, format!(" at {pose}"), "", Applies::Probably),
        };
        edits.extend(written.edits);
    }
    let message = "write the assembled position into `at`".to_owned();
    (!edits.is_empty()).then_some(Fix { message, edits, applies: Applies::Probably })
}

/// A warning where the centres of gears, or of a pinion and its rack, are not as far apart as the radii have it.
pub fn misfit(system: &ConstraintSystem, fit: &Fit, q: &[f64], t: f64) -> Option<Diagnostic> {
    let [distance, wanted, radius] = [fit.distance, fit.wanted, fit.radius].map(|id| system.value_at(id, q));
    let off = distance - wanted;
    if off.abs() <= LARGEST_MISFIT * radius {
        return None;
    }
    let joint = &system.declarations[fit.declaration];
    if distance < -LARGEST_MISFIT * radius {
        let message =
            format!("the pinion of `{}` is on the other side of its rack than is said at {}", joint.name, at(t));
        return Some(
            Diagnostic::new(Code::W0501, message)
                .at(joint.span, "it turns the other way there")
                .help("left and right are seen along the direction of the rack's axis"),
        );
    }
    let (what, why, other) = match joint.kind {
        DeclarationKind::Joint(JointKind::Gear) => ("centres", "the sum of the radii", Some("internal_gear")),
        DeclarationKind::Joint(JointKind::InternalGear) => ("centres", "the difference of the radii", Some("gear")),
        _ => ("centre and axis", "the radius", None),
    };
    // the sum of the radii, of gears whose difference was asked for, and the other way round
    let fits_another = (distance - (2.0 * radius - wanted)).abs() <= LARGEST_MISFIT * radius;
    let message = format!(
        "the {what} of `{}` are {} apart at {}, and {why} is {}",
        joint.name,
        digits_that_differ(distance, wanted),
        at(t),
        digits_that_differ(wanted, distance)
    );
    let label =
        format!("{} too {}", in_one_unit(off.abs(), 2, distance.max(wanted)), if off < 0.0 { "near" } else { "far" });
    let help = match other.filter(|_| fits_another) {
        Some(other) => format!("was `{other}` meant? its centres would be right"),
        None => format!(
            "set them {} apart by the joints of their bodies, or change a radius: a mesh does not hold its distance",
            digits_that_differ(wanted, distance)
        ),
    };
    Some(Diagnostic::new(Code::W0501, message).at(joint.span, label).help(help))
}

/// A length (m) with as many digits as tell it from another.
fn digits_that_differ(value: f64, other: f64) -> String {
    if value.abs() < 1e-12 {
        return "0 mm".to_owned();
    }
    let digits = (3..=9).find(|&digits| format!("{value:.digits$e}") != format!("{other:.digits$e}")).unwrap_or(9);
    in_one_unit(value, digits, value.abs().max(other.abs()))
}

/// A length (m) with so many digits behind the first one, in the unit that suits the larger length beside it.
fn in_one_unit(value: f64, digits: usize, beside: f64) -> String {
    let (times, unit) = if beside.abs() < 1.0 { (1e3, "mm") } else { (1.0, "m") };
    let rounded: f64 = format!("{:.digits$e}", value * times).parse().unwrap_or(value);
    format!("{} {unit}", readable(rounded))
}

impl Moved {
    /// In a sentence.
    #[must_use]
    pub fn in_words(&self, system: &ConstraintSystem) -> String {
        format!(
            "assembled: moved by at most {} (`{}`) and {} (`{}`) from the estimates",
            length(self.length),
            system.bodies[self.length_body].name,
            degrees(self.angle),
            system.bodies[self.angle_body].name,
        )
    }
}
