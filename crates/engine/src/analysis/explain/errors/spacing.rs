//! Warnings of wheels whose centres are not as far apart as they should be.

use super::at;
use crate::limits::assembly::AGREES;
use crate::limits::printed::NOTHING;
use mechc_ir::{ConstraintSystem, DeclarationKind, Fit, JointSpec};
use mechc_text::diag::{Code, Diagnostic, readable};
use mechc_text::vocabulary::Spacing;

/// Shorter distances are told in millimetres.
const MILLIMETRES_PER_METRE: f64 = 1e3;

/// Returns a warning if the distance between the centres of gears, or of a pinion and its rack, differs from what the radii require.
pub fn misfit(system: &ConstraintSystem, fit: &Fit, q: &[f64], t: f64) -> Option<Diagnostic> {
    let [distance, required, radius] = [fit.distance, fit.wanted?, fit.radius].map(|id| system.value_at(id, q));
    let off = distance - required;
    if off.abs() <= AGREES * radius {
        return None;
    }
    let joint = &system.declarations()[fit.declaration];
    if distance < -AGREES * radius {
        let message =
            format!("the pinion of `{}` is on the other side of its rack than is said at {}", joint.name, at(t));
        return Some(
            Diagnostic::new(Code::W0501, message)
                .at(joint.span, "it turns the other way there")
                .help("left and right are seen along the direction of the rack's axis"),
        );
    }
    let DeclarationKind::Joint(JointSpec { spacing: Some(Spacing { of, wanted, other }), .. }) = joint.kind else {
        return None;
    };
    // the sum of the radii, of gears that take the difference, and the other way round
    let fits_another = (distance - (2.0 * radius - required)).abs() <= AGREES * radius;
    let message = format!(
        "the {of} of `{}` are {} apart at {}, and {wanted} is {}",
        joint.name,
        digits_that_differ(distance, required),
        at(t),
        digits_that_differ(required, distance)
    );
    let label =
        format!("{} too {}", in_one_unit(off.abs(), 2, distance.max(required)), if off < 0.0 { "near" } else { "far" });
    let help = match other.filter(|_| fits_another) {
        Some(other) => format!("was `{other}` meant? its centres would be right"),
        None => format!(
            "set them {} apart by the joints of their bodies, or change a radius: a mesh does not hold its distance",
            digits_that_differ(required, distance)
        ),
    };
    Some(Diagnostic::new(Code::W0501, message).at(joint.span, label).help(help))
}

/// Returns a warning that the centres of a belt's pulleys are at another distance (m), at `t` (s), than at the start.
pub fn spacing_changes(system: &ConstraintSystem, fit: &Fit, [distance, at_start]: [f64; 2], t: f64) -> Diagnostic {
    let joint = &system.declarations()[fit.declaration];
    let off = distance - at_start;
    let message = format!(
        "the centres of `{}` are {} apart at the start, and {} at {}",
        joint.name,
        digits_that_differ(at_start, distance),
        digits_that_differ(distance, at_start),
        at(t)
    );
    let amount = in_one_unit(off.abs(), 2, distance.max(at_start));
    let label = format!("there {amount} {}", if off < 0.0 { "nearer, and slack" } else { "farther apart" });
    Diagnostic::new(Code::W0501, message)
        .at(joint.span, label)
        .help(
            "carry both pulleys by one body, or hold their centres apart by a link: a belt does not hold its distance",
        )
        .datum("t", t)
}

/// Formats a length (m) with as many digits as distinguish it from another.
fn digits_that_differ(value: f64, other: f64) -> String {
    if value.abs() < NOTHING {
        return "0 mm".to_owned();
    }
    let digits = (3..=9).find(|&digits| format!("{value:.digits$e}") != format!("{other:.digits$e}")).unwrap_or(9);
    in_one_unit(value, digits, value.abs().max(other.abs()))
}

/// Formats a length (m) with so many digits behind the first one, in the unit that suits `larger`, the larger of two lengths.
fn in_one_unit(value: f64, digits: usize, larger: f64) -> String {
    let (times, unit) = if larger.abs() < 1.0 { (MILLIMETRES_PER_METRE, "mm") } else { (1.0, "m") };
    let rounded: f64 = format!("{:.digits$e}", value * times).parse().unwrap_or(value);
    format!("{} {unit}", readable(rounded))
}
