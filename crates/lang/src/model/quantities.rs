//! Kinematic quantities: scalar functions of the coordinates and of their rates.

use super::{AxisId, Dimension, Frame, JointId, PointId};
use mechc_text::vocabulary::{MOST_ARGUMENTS, MeasuredQuantity, QuantityWord};

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
    /// The angle at the second of three points, from the first to the third, in (−π, π] (rad). Only measures may hold it.
    Corner([PointId; 3]),
    /// A quantity of the motion, which only measures may hold.
    Measured(Measured),
}

/// A quantity of the motion with its arguments.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Measured {
    /// The word.
    pub word: &'static QuantityWord,
    /// The arguments in their order, followed by `None`.
    pub arguments: [Option<MeasuredArgument>; MOST_ARGUMENTS],
}

/// An argument of a quantity of the motion.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum MeasuredArgument {
    /// A point.
    Point(PointId),
    /// A body or a ground.
    Frame(Frame),
    /// A joint.
    Joint(JointId),
}

impl Measured {
    /// Returns the arguments.
    pub fn arguments(&self) -> impl Iterator<Item = MeasuredArgument> {
        self.arguments.into_iter().flatten()
    }

    /// Returns the points among the arguments.
    pub fn points(&self) -> impl Iterator<Item = PointId> {
        self.arguments().filter_map(|argument| match argument {
            MeasuredArgument::Point(point) => Some(point),
            _ => None,
        })
    }

    /// Returns the bodies and grounds among the arguments.
    pub fn frames(&self) -> impl Iterator<Item = Frame> {
        self.arguments().filter_map(|argument| match argument {
            MeasuredArgument::Frame(frame) => Some(frame),
            _ => None,
        })
    }

    /// Returns the joints among the arguments.
    pub fn joints(&self) -> impl Iterator<Item = JointId> {
        self.arguments().filter_map(|argument| match argument {
            MeasuredArgument::Joint(joint) => Some(joint),
            _ => None,
        })
    }

    fn spec(&self) -> Option<MeasuredQuantity> {
        self.word.measured()
    }
}

impl Quantity {
    /// Returns the highest order of time derivatives of the coordinates in the quantity.
    #[must_use]
    pub fn order(self) -> u8 {
        match self {
            Quantity::Measured(measured) => measured.spec().map_or(0, |spec| spec.order),
            _ => 0,
        }
    }

    /// Returns whether the quantity has no value at some positions or velocities.
    #[must_use]
    pub fn may_not_exist(self) -> bool {
        match self {
            Quantity::Measured(measured) => measured.spec().is_some_and(|spec| spec.may_not_exist),
            _ => matches!(self, Quantity::Corner(_)),
        }
    }

    /// Returns the quantity's dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Angle(..) | Quantity::Rotation(..) | Quantity::Corner(_) => Dimension::ANGLE,
            Quantity::X(..) | Quantity::Y(..) | Quantity::Distance(..) | Quantity::Displacement(..) => {
                Dimension::LENGTH
            }
            Quantity::Measured(measured) => measured.spec().map_or(Dimension::PURE, |spec| spec.dimension),
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
