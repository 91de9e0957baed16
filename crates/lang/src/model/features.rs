//! Bodies, and what is on them: points, axes, circles, curves.

use super::{BodyId, CircleId, Condition, CurveId, Declared, Mechanism, PartId, PointId};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// What a feature is fixed to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Frame {
    /// The body without coordinates.
    Ground,
    /// A moving body.
    Body(BodyId),
    /// What is the ground in a part; fixed on what carries the part.
    Part(PartId),
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The pose as written: x (m), y (m), phi (rad), in the frame of the part that declares it.
    pub pose: [ExprId; 3],
    /// Where the pose is written, if it is.
    pub pose_span: Option<Span>,
}

/// A point fixed in a frame.
#[derive(Clone, Debug)]
pub struct Point {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name; a literal point has none.
    pub name: Option<String>,
    /// Where it is written.
    pub span: Span,
    /// In the frame (m).
    pub at: [ExprId; 2],
}

/// A directed line fixed in a frame.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// A point of it.
    pub origin: PointId,
    /// Its direction in the frame, of any length but zero.
    pub direction: [ExprId; 2],
}

/// A circle fixed in a frame.
#[derive(Clone, Debug)]
pub struct Circle {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// Its centre.
    pub center: PointId,
    /// Its radius (m), positive.
    pub radius: ExprId,
}

/// A curve fixed in a frame.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is fixed to.
    pub frame: Frame,
    /// Its name.
    pub name: String,
    /// Where it is written.
    pub span: Span,
    /// The name of its argument, a pure number.
    pub argument: String,
    /// Its points in the frame (m), with `Named::Argument` for the argument.
    pub at: [ExprId; 2],
    /// First estimate of the argument at a contact.
    pub estimate: Option<ExprId>,
    /// Formulas of the argument that must stay positive for the points to have a meaning.
    pub conditions: Vec<Condition>,
}

/// A line that a contact runs along.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Profile {
    /// A curve, by its argument.
    Curve(CurveId),
    /// A circle, by the angle from the x axis of its body.
    Circle(CircleId),
}

impl Profile {
    /// What it is fixed to.
    #[must_use]
    pub fn frame(self, mechanism: &Mechanism) -> Frame {
        match self {
            Profile::Curve(curve) => mechanism[curve].frame,
            Profile::Circle(circle) => mechanism[circle].frame,
        }
    }

    /// Its own name.
    #[must_use]
    pub fn name(self, mechanism: &Mechanism) -> &str {
        match self {
            Profile::Curve(curve) => &mechanism[curve].name,
            Profile::Circle(circle) => &mechanism[circle].name,
        }
    }
}

/// On which side of a rack its pinion lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// Left of the axis' direction.
    Left,
    /// Right of it.
    Right,
}
