//! Features: what joints take hold of, fixed in a body or in the ground, as formulas of parameters in the frame of that body. What is the
//! ground in a part is folded into what carries the part.

use super::{BodyId, PointId};
use mechc_expr::ExprId;

/// A point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its body; none for the ground.
    pub body: Option<BodyId>,
    /// Its name; a literal point has none.
    pub name: Option<String>,
    /// In the frame of its body (m).
    pub at: [ExprId; 2],
}

/// A directed line through a point, of whose body it is.
#[derive(Clone, Debug)]
pub struct Axis {
    /// As it is written, `rod.slot`.
    pub name: String,
    /// A point of it.
    pub origin: PointId,
    /// Its direction in the frame of its body, of length 1.
    pub direction: [ExprId; 2],
}

/// A circle around a point, of whose body it is.
#[derive(Clone, Debug)]
pub struct Circle {
    /// As it is written, `wheel.rim`.
    pub name: String,
    /// Its centre.
    pub center: PointId,
    /// Its radius (m).
    pub radius: ExprId,
}
