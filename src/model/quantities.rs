//! Named symbols of formulas: kinematic quantities, derivatives, forces.

use super::{AxisId, Dimension, Force, Frame, JointId, PartId, PointId};
use crate::expr::ExprId;

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

/// A scalar function of the coordinates (`elements.md`, "Kinematic quantities").
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Quantity {
    /// Global x of a point, or from one point to another (m).
    X(Option<PointId>, PointId),
    /// Global y of a point, or from one point to another (m).
    Y(Option<PointId>, PointId),
    /// Direction of a body or axis, or the angle from one to another (rad).
    Angle(Option<Direction>, Direction),
    /// Distance of two points (m).
    Distance(PointId, PointId),
    /// Angle of a revolute joint (rad), between axes if given.
    Rotation(JointId, Option<(AxisId, AxisId)>),
    /// Way of a translational joint along its first axis, to its second (m).
    Displacement(JointId, AxisId, AxisId),
    /// The angle at the second of three points, from the first to the third, in (−π, π] (rad); this and the following stand in measures
    /// alone.
    Corner([PointId; 3]),
    /// Curvature of a point's path, positive to the left (1/m).
    Curvature(PointId),
    /// x (part 0) or y (part 1) of the instant centre of a frame relative to another (m).
    Pole(Frame, Frame, u32),
    /// Length of a point's velocity (m/s).
    Speed(PointId),
    /// Between the common normal at a contact and the velocity of a frame's point there, 0 to π/2 (rad).
    PressureAngle(JointId, Frame),
    /// Sliding speed at a contact (m/s).
    Slip(JointId),
}

impl Quantity {
    /// How many time derivatives of the coordinates it holds.
    #[must_use]
    pub fn order(self) -> u8 {
        match self {
            Quantity::Curvature(_) => 2,
            Quantity::Pole(..) | Quantity::Speed(_) | Quantity::PressureAngle(..) | Quantity::Slip(_) => 1,
            _ => 0,
        }
    }

    /// Whether there are positions or velocities at which it has no value.
    #[must_use]
    pub fn may_not_exist(self) -> bool {
        matches!(self, Quantity::Corner(_) | Quantity::Curvature(_) | Quantity::Pole(..) | Quantity::PressureAngle(..))
    }

    /// Its dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Angle(..) | Quantity::Rotation(..) | Quantity::Corner(_) | Quantity::PressureAngle(..) => {
                Dimension::PURE
            }
            Quantity::Curvature(_) => Dimension::PURE.over(Dimension::LENGTH),
            Quantity::Speed(_) | Quantity::Slip(_) => Dimension::LENGTH.over(Dimension::TIME),
            Quantity::X(..)
            | Quantity::Y(..)
            | Quantity::Distance(..)
            | Quantity::Displacement(..)
            | Quantity::Pole(..) => Dimension::LENGTH,
        }
    }
}

/// A body's x axis, or an axis.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Direction {
    /// The x axis of a frame.
    Frame(Frame),
    /// An axis.
    Axis(AxisId),
}
