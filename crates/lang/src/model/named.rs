//! What the graph's named symbols stand for.

use super::{Force, PartId, Quantity};
use mechc_expr::ExprId;

/// What a named symbol of the graph stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Named {
    /// A kinematic quantity, as it is seen from the ground of a part.
    Quantity(Option<PartId>, Quantity),
    /// The time derivative of a formula, along the motion.
    Derivative(ExprId),
    /// The derivative of a formula by a variable, by its number, at fixed time.
    /// Inside a part that moves together with what is around it, by the equations of that part.
    By(ExprId, u32, Option<PartId>),
    /// An input of such a part, which is held where these derivatives are taken: what it is bound to.
    Held(PartId, ExprId),
    /// Above zero where a quantity of measures exists.
    Exists(Option<PartId>, Quantity),
    /// A number for the whole analysis, by its place among the reductions.
    Reduction(u32),
    /// A force or torque, as it is seen from the ground of a part.
    Force(Option<PartId>, Force),
    /// The argument of a curve; or of a user's function, where its formula is read on its own.
    Argument,
}
