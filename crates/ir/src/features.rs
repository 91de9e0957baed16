//! Features that joints connect: points, axes and circles, fixed in a body or the ground, as formulas of parameters in the frame of that
//! body. The ground of a part is folded into the body that carries the part.

use super::{BodyId, PointId};
use mechc_expr::ExprId;

/// A point of a body or the ground.
#[derive(Clone, Debug)]
pub struct Point {
    /// Body; `None` for the ground.
    pub body: Option<BodyId>,
    /// Name; `None` for an unnamed point.
    pub name: Option<String>,
    /// Coordinates in the frame of its body (m).
    pub at: [ExprId; 2],
}

/// A directed line through a point, fixed in the body of that point.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Full name, such as `rod.slot`.
    pub name: String,
    /// A point of the axis.
    pub origin: PointId,
    /// Unit direction in the frame of its body.
    pub direction: [ExprId; 2],
}

/// A circle around a point, fixed in the body of that point.
#[derive(Clone, Debug)]
pub struct Circle {
    /// Full name, such as `wheel.rim`.
    pub name: String,
    /// Centre.
    pub center: PointId,
    /// Radius (m).
    pub radius: ExprId,
}
