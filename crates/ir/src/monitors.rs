//! Quantities that are monitored in addition to the solved equations: conditions, redundant equations, branch monitors, and the starts of contacts
//! and parts.

use super::{BodyId, DeclarationId};
use mechc_expr::{ExprId, TableId};
use mechc_text::source::Span;
use mechc_text::vocabulary::Dimension;
use std::ops::Range;

/// A formula that must stay above zero.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The formula.
    pub positive: ExprId,
    /// Reason for the condition.
    pub kind: ConditionKind,
    /// Span of the formula.
    pub span: Span,
    /// Name of the declaration that requires it.
    pub owner: String,
}

/// Reasons for a condition.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// A prescribed distance must be positive.
    Distance,
    /// The interval of a motion function must not be empty.
    Interval,
    /// The argument of a table must be within its range.
    Range(TableId),
    /// Time must be within the samples of an input.
    Samples(TableId),
}

/// A redundant equation, which is checked instead of solved.
#[derive(Clone, Debug)]
pub struct Check {
    /// The entry of `Φ`.
    pub phi: ExprId,
    /// Unit of `phi`.
    pub unit: Dimension,
    /// The declaration that wrote it.
    pub declaration: DeclarationId,
    /// Norm of its row in the scaled `Φ_q` at the estimates.
    pub scale: f64,
}

/// A quantity that keeps its sign along one branch of the motion, and changes it on another.
#[derive(Clone, Debug)]
pub struct Monitor {
    /// The quantity.
    pub value: ExprId,
    /// Meaning of the quantity.
    pub kind: MonitorKind,
    /// Scale for the value.
    pub scale: f64,
    /// Declaration of the joint.
    pub declaration: DeclarationId,
}

/// Meanings of a monitored quantity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MonitorKind {
    /// Directed distance of the centers along the line of centers; it must stay positive.
    LineOfCenters,
    /// Component of one tangent at a contact along the other; zero where a tangent vanishes.
    Tangents,
    /// Relative curvature at a contact; zero where the contact is singular.
    Curvature,
}

/// A center distance, and its nominal value.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Actual distance (m).
    pub distance: ExprId,
    /// Nominal distance from the radii (m), which the assembled start must have; `None` if the distance must stay what it is there.
    pub wanted: Option<ExprId>,
    /// Larger radius (m).
    pub radius: ExprId,
    /// Declaration of the joint.
    pub declaration: DeclarationId,
}

/// A contact whose curve arguments have no estimate.
#[derive(Clone, Debug)]
pub struct OpenContact {
    /// Declaration of the joint.
    pub declaration: DeclarationId,
    /// Coordinate numbers of these arguments.
    pub arguments: Vec<u32>,
    /// Formulas that must be positive for its curves to have a point.
    pub conditions: Vec<ExprId>,
}

/// Everything needed to start a part: it is assembled alone, its inputs are continued to their bound values, and it is moved to its mount.
#[derive(Clone, Debug)]
pub struct PartStart {
    /// Name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Span of the mechanism's name in the source of the part.
    pub text: Span,
    /// Bound parameters by their names in the part (SI); each coordinate of a point is listed separately.
    pub params: Vec<(String, ExprId)>,
    /// Bound inputs (SI), as formulas of coordinates and time.
    pub inputs: Vec<(String, ExprId)>,
    /// Pose of its ground: x (m), y (m), phi (rad).
    pub mount: [ExprId; 3],
    /// True if the part is mirrored.
    pub is_mirrored: bool,
    /// Bodies.
    pub bodies: Vec<BodyId>,
    /// The coordinates of these bodies.
    pub poses: Range<usize>,
    /// The coordinates that its joints add.
    pub own: Range<usize>,
}

/// A part whose text differentiates by inputs or parameters. It must be determined alone.
#[derive(Clone, Debug)]
pub struct PartWithDerivatives {
    /// Name.
    pub name: String,
    /// Names of the part and the parts around it, innermost first, with the spans of their declarations.
    pub used_at: Vec<(String, Span)>,
    /// Spans of the derivatives in its text.
    pub places: Vec<Span>,
    /// The first derivative as the outermost mechanism can write it; `None` if it cannot.
    pub from_outside: Option<String>,
    /// Coordinates, ascending.
    pub columns: Vec<u32>,
    /// Bindings of its inputs.
    pub inputs: Vec<ExprId>,
    /// Joints, constraints and drivers of the part, ascending.
    pub declarations: Vec<DeclarationId>,
}
