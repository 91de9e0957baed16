//! Masses, loads, and the forces that outputs use.

use super::{BodyId, Condition, Declared, Dimension, EquationId, JointId, Mechanism, PartId, PointId, Quantity};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// A mass of a body. The masses of one body add up.
#[derive(Clone, Debug)]
pub struct Mass {
    /// The body.
    pub body: BodyId,
    /// The mass (kg), not negative; like all formulas here it holds parameters only.
    pub amount: ExprId,
    /// The centre of mass, a point of the body.
    pub at: PointId,
    /// The moment of inertia about the centre of mass (kg·m²), not negative.
    pub inertia: ExprId,
    /// The location of the declaration.
    pub span: Span,
}

/// An applied force or torque `F` that works on a quantity `K`: its virtual work is `F·δK`.
#[derive(Clone, Debug)]
pub struct Load {
    /// The load's name.
    pub declared: Declared,
    /// The part in whose text it is declared; `K` is relative to that part's ground.
    pub part: Option<PartId>,
    /// `F`, in SI units: a formula as in a measure, of time, inputs, quantities and their rates, but without forces.
    pub force: ExprId,
    /// Formulas that must be positive for `F` to have a value.
    pub conditions: Vec<Condition>,
    /// `K`, a function of positions only.
    pub on: Quantity,
    /// The dimension of `F`: energy over the dimension of `K`.
    pub dimension: Dimension,
    /// The location of both formulas.
    pub written: Span,
}

/// A force that the analysis computes. Only measures and results may hold it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Force {
    /// The effort of a constraint or driver: it works on the left side minus the right side of the declared equation.
    Effort(EquationId),
    /// The x component of the force that a joint's equations exert on the body of its second argument (N).
    ReactionX(JointId),
    /// The y component of that force (N).
    ReactionY(JointId),
    /// The moment of that force about the joint's reference point (N·m), counter-clockwise.
    ReactionTorque(JointId),
}

impl Force {
    /// Returns the force as source text.
    #[must_use]
    pub fn written(self, mechanism: &Mechanism) -> String {
        match self {
            Force::Effort(equation) => format!("effort({})", mechanism[equation].declared.name),
            Force::ReactionX(joint) => format!("force_x({})", mechanism[joint].declared.name),
            Force::ReactionY(joint) => format!("force_y({})", mechanism[joint].declared.name),
            Force::ReactionTorque(joint) => format!("torque({})", mechanism[joint].declared.name),
        }
    }
}

impl Mechanism {
    /// Returns the dimension of a computed force.
    #[must_use]
    pub fn dimension_of_force(&self, force: Force) -> Dimension {
        match force {
            Force::Effort(equation) => Dimension::ENERGY.over(self[equation].dimension),
            Force::ReactionX(_) | Force::ReactionY(_) => Dimension::FORCE,
            Force::ReactionTorque(_) => Dimension::ENERGY,
        }
    }

    /// Returns whether the mechanism declares masses, gravity or loads.
    #[must_use]
    pub fn has_forces(&self) -> bool {
        !self.masses.is_empty() || self.gravity.is_some() || !self.loads.is_empty()
    }
}
