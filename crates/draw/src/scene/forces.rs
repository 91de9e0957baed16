//! Forces as arrows: reactions of joints, loads and weights. Their values at a time are columns of the table.

use super::drawing::Drawing;
use super::features::{Features, PartFrame};
use super::plane::{Vector, length, minus, polar, times};
use super::{Anchor, Motion};
use mechc_expr::{ExprId, Node, Symbol};
use mechc_lang::model::{EquationForm, Joint, Mechanism, Named, PartId, Quantity};
use std::f64::consts::PI;

/// Origin of a force.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum ForceKind {
    /// Force of a joint on the body of its second argument, or force that keeps or drives a distance.
    Reaction,
    /// Load.
    Load,
    /// Weight of a mass.
    Weight,
}

impl ForceKind {
    /// All kinds.
    pub const ALL: [ForceKind; 3] = [ForceKind::Reaction, ForceKind::Load, ForceKind::Weight];

    /// Returns the name of the kind; style sheets use it as a class.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            ForceKind::Reaction => "reaction",
            ForceKind::Load => "load",
            ForceKind::Weight => "weight",
        }
    }
}

/// A force with its point of action.
#[derive(Clone, PartialEq, Debug)]
pub struct ForceVector {
    /// Index of the declaration.
    pub declaration: usize,
    /// Origin.
    pub kind: ForceKind,
    /// Point of action.
    pub at: Anchor,
    /// Value.
    pub value: ForceValue,
}

/// Value of a force in the directions of the ground (N).
#[derive(Clone, PartialEq, Debug)]
pub enum ForceValue {
    /// Constant.
    Constant(Vector),
    /// Two columns.
    Components([String; 2]),
    /// A column times a direction of a frame.
    Along {
        /// Column.
        column: String,
        /// Index of the frame.
        frame: usize,
        /// Direction in the frame, of length 1.
        direction: Vector,
    },
    /// A column times the direction from one position to another.
    Apart {
        /// Column.
        column: String,
        /// First position.
        from: Anchor,
        /// Second position.
        to: Anchor,
    },
}

impl ForceVector {
    /// Returns the value in a row (N); not finite where the table has no value.
    #[must_use]
    pub fn value(&self, motion: &Motion, row: usize) -> Vector {
        let poses = motion.poses(row);
        let value = |column: &String| motion.value(column, row);
        match &self.value {
            ForceValue::Constant(force) => *force,
            ForceValue::Components(columns) => columns.each_ref().map(value),
            ForceValue::Along { column, frame, direction } => times(value(column), poses[*frame].rotate(*direction)),
            ForceValue::Apart { column, from, to } => {
                let vector = minus(to.position(poses), from.position(poses));
                times(value(column) / length(vector), vector)
            }
        }
    }

    /// Returns the columns that the value depends on.
    fn columns(&self) -> &[String] {
        match &self.value {
            ForceValue::Constant(_) => &[],
            ForceValue::Components(columns) => columns,
            ForceValue::Along { column, .. } | ForceValue::Apart { column, .. } => std::slice::from_ref(column),
        }
    }
}

/// Returns all forces whose columns are in the motion's table, then the weights. Without any such force or torque there are no weights
/// either.
pub(super) fn vectors(drawing: &Drawing, has_torques: bool) -> Vec<ForceVector> {
    let (features, first) = (&drawing.features, drawing.first);
    let model = features.model;
    let mut forces: Vec<ForceVector> = Vec::new();
    for (number, joint) in model.joints.iter().enumerate() {
        let name = &joint.declared.name;
        let columns = [format!("{name}.fx"), format!("{name}.fy")];
        forces.extend(point_of_action(features, joint).map(|at| ForceVector {
            declaration: first.joints + number,
            kind: ForceKind::Reaction,
            at,
            value: ForceValue::Components(columns),
        }));
    }
    for (number, equation) in model.equations.iter().enumerate() {
        let effort = Effort {
            declaration: first.equations + number,
            kind: ForceKind::Reaction,
            column: format!("{}.effort", equation.declared.name),
        };
        match equation.form {
            EquationForm::Distance(p, q, _) => {
                forces.extend(push_apart(&effort, [p, q].map(|point| features.point(point)), 1.0));
            }
            // the effort acts on the left side minus the right side
            EquationForm::Equality(left, right) => {
                for (side, sign) in [(left, 1.0), (right, -1.0)] {
                    let quantity = bare_quantity(model, side);
                    forces.extend(
                        quantity.into_iter().flat_map(|(view, on)| quantity_forces(features, &effort, view, on, sign)),
                    );
                }
            }
        }
    }
    for (number, load) in model.loads.iter().enumerate() {
        let effort = Effort {
            declaration: first.loads + number,
            kind: ForceKind::Load,
            column: format!("{}.load", load.declared.name),
        };
        forces.extend(quantity_forces(features, &effort, load.part, load.on, 1.0));
    }
    forces.retain(|force| force.columns().iter().all(|column| drawing.motion.column(column).is_some()));
    if !forces.is_empty() || has_torques {
        forces.extend(weights(features));
    }
    forces
}

/// Returns the quantity that a side of an equation consists of, with the part that it refers to; `None` for any other formula.
pub(super) fn bare_quantity(model: &Mechanism, side: ExprId) -> Option<(Option<PartId>, Quantity)> {
    match model.graph.node(side) {
        Node::Symbol(Symbol::Named(k)) => match model.named[k as usize] {
            Named::Quantity(view, quantity) => Some((view, quantity)),
            _ => None,
        },
        _ => None,
    }
}

/// Returns the point of action of a joint's reaction, as the language defines it. A force on a circle passes its centre.
pub(super) fn point_of_action(features: &Features, joint: &Joint) -> Option<Anchor> {
    let point = if joint.spec.has_contact() {
        joint
            .features
            .iter()
            .filter(|feature| feature.axis().is_none())
            .find_map(|feature| feature.point(features.model))
    } else {
        joint.features[1].point(features.model)
    };
    point.map(|point| features.point(point))
}

/// An effort or load whose value is a column of the table.
struct Effort {
    declaration: usize,
    kind: ForceKind,
    column: String,
}

/// Returns the two forces that push two positions apart, or pull them together if `sign` is negative.
fn push_apart(Effort { declaration, kind, column }: &Effort, ends: [Anchor; 2], sign: f64) -> [ForceVector; 2] {
    let [p, q] = ends;
    [[p, q], [q, p]].map(|[at, other]| ForceVector {
        declaration: *declaration,
        kind: *kind,
        at,
        value: if sign > 0.0 {
            ForceValue::Apart { column: column.clone(), from: other, to: at }
        } else {
            ForceValue::Apart { column: column.clone(), from: at, to: other }
        },
    })
}

/// Returns the forces of an effort on a quantity of length; an effort on an angle has none.
fn quantity_forces(
    features: &Features,
    effort: &Effort,
    view: Option<PartId>,
    on: Quantity,
    sign: f64,
) -> Vec<ForceVector> {
    let Effort { declaration, kind, column } = effort;
    let along = |at: Anchor, frame: usize, direction: Vector| ForceVector {
        declaration: *declaration,
        kind: *kind,
        at,
        value: ForceValue::Along { column: column.clone(), frame, direction: times(sign, direction) },
    };
    match on {
        Quantity::X(from, to) | Quantity::Y(from, to) => {
            let PartFrame { frame, pose, is_mirrored } = features.part_frame(view);
            let direction = match on {
                Quantity::X(..) => polar(1.0, pose.phi),
                _ if is_mirrored => polar(1.0, pose.phi - 0.5 * PI),
                _ => polar(1.0, pose.phi + 0.5 * PI),
            };
            let from = from.map(|point| along(features.point(point), frame, times(-1.0, direction)));
            from.into_iter().chain([along(features.point(to), frame, direction)]).collect()
        }
        Quantity::Distance(p, q) => push_apart(effort, [p, q].map(|point| features.point(point)), sign).into(),
        Quantity::Displacement(_, a, b) => {
            let (guide, slider) = (features.axis(a), features.axis(b));
            vec![along(Anchor { frame: slider.frame, at: slider.at }, guide.frame, guide.along)]
        }
        _ => Vec::new(),
    }
}

fn weights(features: &Features) -> Vec<ForceVector> {
    let model = features.model;
    let Some(gravity) = model.gravity.map(|gravity| gravity.map(|part| features.value(part))) else {
        return Vec::new();
    };
    let of = |mass: &mechc_lang::model::Mass| ForceVector {
        declaration: mass.body.index() + 1,
        kind: ForceKind::Weight,
        at: features.point(mass.at),
        value: ForceValue::Constant(times(features.value(mass.amount), gravity)),
    };
    model.masses.iter().map(of).collect()
}
