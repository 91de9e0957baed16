//! Torques as arcs with heads: reactions of joints, loads on angles and efforts of drivers.

use super::drawing::Drawing;
use super::{Anchor, ForceKind, Motion, drivers, forces};
use mechc_lang::model::{EquationForm, PartId, Quantity};

/// A torque about a position, on the second of two bodies that turn against each other, or on the first if the second is the ground.
#[derive(Clone, PartialEq, Debug)]
pub struct Torque {
    /// Index of the declaration.
    pub declaration: usize,
    /// Origin.
    pub kind: ForceKind,
    /// Position of the arc.
    pub at: Anchor,
    /// Column of the value.
    pub column: String,
    /// Sign of the column: 1 if its positive values are counter-clockwise, −1 if they are clockwise.
    pub sign: f64,
}

impl Torque {
    /// Returns the value in a row (N·m), counter-clockwise positive; not finite where the table has no value.
    #[must_use]
    pub fn value(&self, motion: &Motion, row: usize) -> f64 {
        self.sign * motion.value(&self.column, row)
    }
}

/// Returns all torques whose columns are in the motion's table.
pub(super) fn torques(drawing: &Drawing) -> Vec<Torque> {
    let (model, first) = (drawing.features.model, drawing.first);
    let mut torques: Vec<Torque> = Vec::new();
    for (number, joint) in model.joints.iter().enumerate().filter(|(_, joint)| joint.spec.has_torque()) {
        let (declaration, kind) = (first.joints + number, ForceKind::Reaction);
        let column = format!("{}.torque", joint.declared.name);
        torques.extend(forces::point_of_action(&drawing.features, joint).map(|at| Torque {
            declaration,
            kind,
            at,
            column,
            sign: 1.0,
        }));
    }
    for (number, equation) in model.equations.iter().enumerate() {
        let EquationForm::Equality(left, right) = equation.form else { continue };
        for (side, sign) in [(left, 1.0), (right, -1.0)] {
            let Some((view, quantity)) = forces::bare_quantity(model, side) else { continue };
            torques.extend(torque_site(drawing, view, quantity).map(|(at, sign_of_site)| Torque {
                declaration: first.equations + number,
                kind: ForceKind::Reaction,
                at,
                column: format!("{}.effort", equation.declared.name),
                sign: sign * sign_of_site,
            }));
        }
    }
    for (number, load) in model.loads.iter().enumerate() {
        torques.extend(torque_site(drawing, load.part, load.on).map(|(at, sign)| Torque {
            declaration: first.loads + number,
            kind: ForceKind::Load,
            at,
            column: format!("{}.load", load.declared.name),
            sign,
        }));
    }
    torques.retain(|torque| drawing.motion.column(&torque.column).is_some());
    torques
}

/// Returns the position and the sign of a torque on an angle, or `None` if the quantity is not an angle of bodies.
fn torque_site(drawing: &Drawing, view: Option<PartId>, quantity: Quantity) -> Option<(Anchor, f64)> {
    let model = drawing.features.model;
    let (at, second) = match quantity {
        Quantity::Rotation(joint, _) => {
            let [p, q] = model[joint].pin()?.map(|point| drawing.features.point(point));
            (p, q.frame)
        }
        Quantity::Angle(from, to) => (drivers::angle_pivot(drawing, from, to), drivers::frame_of(drawing, to)),
        _ => return None,
    };
    let is_reversed = model.is_mirrored(view) != (second == 0);
    Some((at, if is_reversed { -1.0 } else { 1.0 }))
}
