//! Masses, loads, and the forces that are asked for: what a mechanism's motion takes and gives.

use super::{BodyId, Condition, Declared, Dimension, EquationId, JointId, Mechanism, PartId, PointId, Quantity};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// A mass of a body; those of one body add up.
#[derive(Clone, Debug)]
pub struct Mass {
    /// Whose it is.
    pub body: BodyId,
    /// How much (kg), not negative; holds parameters only, as all of these do.
    pub amount: ExprId,
    /// Its centre, a point of the body.
    pub at: PointId,
    /// Its moment of inertia about that centre (kg·m²), not negative.
    pub inertia: ExprId,
    /// Where it is written.
    pub span: Span,
}

/// A force or torque of which a formula is known. Its virtual work is `F·δK`.
#[derive(Clone, Debug)]
pub struct Load {
    /// Its name.
    pub declared: Declared,
    /// The part in whose text it is declared, from whose ground `K` is seen.
    pub part: Option<PartId>,
    /// `F`, in SI; as the formula of a measure it may hold time, inputs, quantities and their rates, but no forces.
    pub force: ExprId,
    /// What must be positive for `F` to have a value.
    pub conditions: Vec<Condition>,
    /// `K`, of positions alone.
    pub on: Quantity,
    /// Of `F`: that of an energy over that of `K`.
    pub dimension: Dimension,
    /// Where both are written.
    pub written: Span,
}

/// What comes out of the forces at a time. It stands in measures and results alone.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Force {
    /// What a constraint or driver supplies: it works on the left side less the right side, as both are written.
    Effort(EquationId),
    /// x of what a joint's own equations exert on the body of its second argument (N).
    ReactionX(JointId),
    /// y of the same (N).
    ReactionY(JointId),
    /// Its moment about the point that it is reduced to (N·m), counter-clockwise.
    ReactionTorque(JointId),
}

impl Force {
    /// As the language writes it.
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
    /// The dimension of a force that is asked for.
    #[must_use]
    pub fn dimension_of_force(&self, force: Force) -> Dimension {
        match force {
            Force::Effort(equation) => Dimension::ENERGY.over(self[equation].dimension),
            Force::ReactionX(_) | Force::ReactionY(_) => Dimension::FORCE,
            Force::ReactionTorque(_) => Dimension::ENERGY,
        }
    }

    /// Whether there are forces to draw, and they are to be drawn.
    #[must_use]
    pub fn draws_forces(&self) -> bool {
        self.pictures_forces && !(self.masses.is_empty() && self.loads.is_empty())
    }

    /// Whether anything in it speaks of masses, gravity or loads.
    #[must_use]
    pub fn has_forces(&self) -> bool {
        !self.masses.is_empty() || self.gravity.is_some() || !self.loads.is_empty()
    }
}
