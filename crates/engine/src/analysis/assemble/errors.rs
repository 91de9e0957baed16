//! Warnings about an assembled position that may not be the intended one.

use super::assembly::Moved;
use super::branches::{Doubt, FarBody, Off};
use crate::analysis::explain::errors::{at, degrees, length};
use crate::limits::assembly::AGREES;
use crate::limits::printed::NOTHING;
use mechc_ir::ConstraintSystem;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix};

/// Returns a warning about the doubt that the assembled position is the intended one.
///
/// `from` are the estimates, `to` the assembled position.
pub fn far_estimates(system: &ConstraintSystem, doubt: Doubt, [from, to]: [&[f64]; 2], t: f64) -> Diagnostic {
    const NEARER: &str = "give estimates in `at` that are nearer to the position meant";
    let (message, place, label, help) = match doubt {
        Doubt::Perturbed => (
            format!("the estimates do not say which way the mechanism is assembled at {}", at(t)),
            system.span(),
            "one of several positions was taken",
            NEARER,
        ),
        Doubt::DriversLeftOut => (
            format!("the mechanism does not close as it is drawn at {}", at(t)),
            system.span(),
            "closed with its drivers left out, which then led it to where they begin",
            NEARER,
        ),
        Doubt::ShortestWay => (
            format!("the drivers cannot turn as far as from where they are drawn to where they begin at {}", at(t)),
            system.span(),
            "the way ends at a singular position: they were turned the shortest way, so that what turns with them may lack whole turns",
            "draw it less than half a turn from where its drivers begin",
        ),
        Doubt::Passed => (
            format!(
                "a bifurcation was passed on the way from the drawn position to where the drivers begin at {}",
                at(t)
            ),
            system.span(),
            "went on along the branch that continues smoothly",
            "draw it beyond the bifurcation, with poses in `at`",
        ),
        Doubt::NotDriven => (
            format!("no way leads from the drawn position to where the drivers begin at {}", at(t)),
            system.span(),
            "assembled from the estimates with the drivers there, which may mean another branch",
            "draw it where its drivers begin, with poses in `at`",
        ),
        Doubt::Far(FarBody { body, off }) => {
            let body = &system.bodies()[body];
            let how = match off {
                Off::Moved(by) => format!("moved by {}", length(by)),
                Off::Turned(by) => format!("turned by {}", degrees(by)),
            };
            (
                format!("body `{}` was {how} by the assembly at {}", body.name, at(t)),
                body.span,
                "far from its estimate",
                "if this is not the branch meant, give better estimates in `at`",
            )
        }
    };
    Diagnostic::new(Code::N0601, message).at(place, label).help(help).change(assembled_poses(system, from, to))
}

/// Suggests the assembled poses as estimates of the bodies that assembly has moved by more than rounding.
fn assembled_poses(system: &ConstraintSystem, from: &[f64], to: &[f64]) -> Option<Fix> {
    let mut edits = Vec::new();
    for (id, body) in system.bodies().pairs() {
        let pose @ [x, y, phi] = system.pose_of(id);
        let has_moved =
            |&column: &usize| (to[column] - from[column]).abs() > AGREES * system.coordinates()[column].scale;
        if !pose.iter().any(has_moved) {
            continue;
        }
        let nine = |value: f64| format!("{value:.8e}").parse().unwrap_or(value) + 0.0;
        let [x, y] = [x, y].map(|column| if to[column].abs() < NOTHING { 0.0 } else { nine(1e3 * to[column]) });
        let phi = if to[phi].abs() < NOTHING { 0.0 } else { nine(to[phi].to_degrees()) };
        let pose = format!("({x} mm, {y} mm, {phi} deg)");
        let written = match body.pose_span {
            Some(span) => Fix::replace(span, pose, "", Applicability::Probably),
            None => Fix::append(body.span, format!(" at {pose}"), "", Applicability::Probably),
        };
        edits.extend(written.edits);
    }
    let message = "write the assembled position into `at`".to_owned();
    (!edits.is_empty()).then_some(Fix { message, edits, applies: Applicability::Probably })
}

impl Moved {
    /// Describes the displacement in a sentence.
    #[must_use]
    pub fn in_words(&self, system: &ConstraintSystem) -> String {
        format!(
            "assembled: moved by at most {} (`{}`) and {} (`{}`) from the estimates",
            length(self.length),
            system.bodies()[self.length_body].name,
            degrees(self.angle),
            system.bodies()[self.angle_body].name,
        )
    }
}
