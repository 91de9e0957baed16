//! The meanings of the graph's named symbols.

use super::{Force, PartId, Quantity};
use mechc_expr::ExprId;

/// The meaning of a named symbol of the graph.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Named {
    /// A kinematic quantity, relative to the ground of a part.
    Quantity(Option<PartId>, Quantity),
    /// The time derivative of a formula along the motion.
    Derivative(ExprId),
    /// The derivative of a formula by the variable of this number, at fixed time.
    By(ExprId, u32),
    /// A formula that is greater than zero where a quantity of measures exists.
    Exists(Option<PartId>, Quantity),
    /// A number of the whole analysis, by its index among the reductions.
    Reduction(u32),
    /// A force or torque, relative to the ground of a part.
    Force(Option<PartId>, Force),
    /// The argument of a curve, or of a user's function that is checked on its own.
    Argument,
}
