//! Bodies and their features: points, axes, circles and curves.

use super::{BodyId, CircleId, Condition, CurveId, Declared, Mechanism, PartId, PointId};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// A frame of reference to which features are fixed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Frame {
    /// The body without coordinates.
    Ground,
    /// A moving body.
    Body(BodyId),
    /// The ground of a part, fixed to the frame that carries the part.
    Part(PartId),
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// The body's name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The declared pose: x (m), y (m), phi (rad), in the frame of the part that declares the body.
    pub pose: [ExprId; 3],
    /// The location of the declared pose, if there is one.
    pub pose_span: Option<Span>,
}

/// A point fixed in a frame.
#[derive(Clone, Debug)]
pub struct Point {
    /// The frame to which the point is fixed.
    pub frame: Frame,
    /// The point's name; `None` for a literal point.
    pub name: Option<String>,
    /// The location of the declaration.
    pub span: Span,
    /// The coordinates in the frame (m).
    pub at: [ExprId; 2],
}

/// A directed line fixed in a frame.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The frame to which the axis is fixed.
    pub frame: Frame,
    /// The axis' name.
    pub name: String,
    /// The location of the declaration.
    pub span: Span,
    /// A point on the axis.
    pub origin: PointId,
    /// The direction in the frame, of any length except zero.
    pub direction: [ExprId; 2],
}

/// A circle fixed in a frame.
#[derive(Clone, Debug)]
pub struct Circle {
    /// The frame to which the circle is fixed.
    pub frame: Frame,
    /// The circle's name.
    pub name: String,
    /// The location of the declaration.
    pub span: Span,
    /// The centre.
    pub center: PointId,
    /// The radius (m), positive.
    pub radius: ExprId,
}

/// A curve fixed in a frame.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The frame to which the curve is fixed.
    pub frame: Frame,
    /// The curve's name.
    pub name: String,
    /// The location of the declaration.
    pub span: Span,
    /// The name of the curve's argument, a pure number.
    pub argument: String,
    /// The curve's point in the frame (m) as a formula of `Named::Argument`.
    pub at: [ExprId; 2],
    /// The estimate of the argument at a contact.
    pub estimate: Option<ExprId>,
    /// Formulas of the argument that must be positive for the point to be defined.
    pub conditions: Vec<Condition>,
}

/// A curve or circle along which a contact runs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Profile {
    /// A curve; its parameter is the curve's argument.
    Curve(CurveId),
    /// A circle; its parameter is the angle from the x axis of its body.
    Circle(CircleId),
}

impl Profile {
    /// Returns the frame to which the profile is fixed.
    #[must_use]
    pub fn frame(self, mechanism: &Mechanism) -> Frame {
        match self {
            Profile::Curve(curve) => mechanism[curve].frame,
            Profile::Circle(circle) => mechanism[circle].frame,
        }
    }

    /// Returns the profile's name without that of its frame.
    #[must_use]
    pub fn name(self, mechanism: &Mechanism) -> &str {
        match self {
            Profile::Curve(curve) => &mechanism[curve].name,
            Profile::Circle(circle) => &mechanism[circle].name,
        }
    }
}
