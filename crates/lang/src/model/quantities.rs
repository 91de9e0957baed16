//! Kinematic quantities: scalar functions of the coordinates and of their rates.

use super::{AxisId, Dimension, Frame, JointId, PointId};

/// A kinematic quantity (`elements.md`, "Kinematic quantities").
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
    /// Displacement of a translational joint along its first axis, from there to its second axis (m).
    Displacement(JointId, AxisId, AxisId),
    /// The angle at the second of three points, from the first to the third, in (−π, π] (rad). Only measures may hold this and the
    /// following quantities.
    Corner([PointId; 3]),
    /// Curvature of a point's path, positive to the left (1/m).
    Curvature(PointId),
    /// x (part 0) or y (part 1) of the instant centre of a frame relative to another (m).
    Pole(Frame, Frame, u32),
    /// Length of a point's velocity (m/s).
    Speed(PointId),
    /// The angle between the common normal at a contact and the velocity of a frame's point there, 0 to π/2 (rad).
    PressureAngle(JointId, Frame),
    /// Sliding speed at a contact (m/s).
    Slip(JointId),
}

impl Quantity {
    /// Returns the highest order of time derivatives of the coordinates in the quantity.
    #[must_use]
    pub fn order(self) -> u8 {
        match self {
            Quantity::Curvature(_) => 2,
            Quantity::Pole(..) | Quantity::Speed(_) | Quantity::PressureAngle(..) | Quantity::Slip(_) => 1,
            _ => 0,
        }
    }

    /// Returns whether the quantity has no value at some positions or velocities.
    #[must_use]
    pub fn may_not_exist(self) -> bool {
        matches!(self, Quantity::Corner(_) | Quantity::Curvature(_) | Quantity::Pole(..) | Quantity::PressureAngle(..))
    }

    /// Returns the quantity's dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Angle(..) | Quantity::Rotation(..) | Quantity::Corner(_) | Quantity::PressureAngle(..) => {
                Dimension::ANGLE
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

/// The direction of an axis, or of a frame's x axis.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Direction {
    /// The x axis of a frame.
    Frame(Frame),
    /// The direction of an axis.
    Axis(AxisId),
}
