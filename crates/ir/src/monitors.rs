//! What is looked at beside the equations: what must hold where they are solved, and where a solution begins.

use super::{BodyId, DeclarationId, RowUnit};
use mechc_expr::{ExprId, TableId};
use mechc_text::source::Span;
use std::ops::Range;

/// A formula that must be above zero.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The formula.
    pub positive: ExprId,
    /// What it is about.
    pub kind: ConditionKind,
    /// The formula's place.
    pub span: Span,
    /// The declaration that asks for it.
    pub owner: String,
}

/// What a condition is about.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// A prescribed distance.
    Distance,
    /// The interval of a motion function.
    Interval,
    /// The range of a table.
    Range(TableId),
    /// The times of the samples of an input.
    Samples(TableId),
}

/// An equation that follows from the others.
#[derive(Clone, Debug)]
pub struct Check {
    /// The entry of `Φ`.
    pub phi: ExprId,
    /// What that is measured in.
    pub unit: RowUnit,
    /// The declaration that wrote it.
    pub declaration: DeclarationId,
    /// Its norm in the scaled `Φ_q` at the start.
    pub scale: f64,
}

/// A quantity that keeps its sign along a branch of the motion, and only there.
#[derive(Clone, Debug)]
pub struct Watch {
    /// The quantity.
    pub value: ExprId,
    /// What it is.
    pub kind: WatchKind,
    /// What it is judged against.
    pub scale: f64,
    /// The joint's declaration.
    pub declaration: DeclarationId,
}

/// What a [`Watch`] looks at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WatchKind {
    /// The way from centre to centre along the line of centres; it must be positive.
    LineOfCenters,
    /// One tangent at a contact along the other; zero where a tangent vanishes.
    Tangents,
    /// The relative curvature at a contact; zero where the contact is singular.
    Curvature,
}

/// A distance in the assembled start, and what it should be.
#[derive(Clone, Debug)]
pub struct Fit {
    /// As it is (m).
    pub distance: ExprId,
    /// As the radii have it (m).
    pub wanted: ExprId,
    /// The larger radius (m).
    pub radius: ExprId,
    /// The joint's declaration.
    pub declaration: DeclarationId,
}

/// A contact with arguments that no curve gives an estimate of.
#[derive(Clone, Debug)]
pub struct OpenContact {
    /// The joint's declaration.
    pub declaration: DeclarationId,
    /// These arguments, by the numbers of their coordinates.
    pub arguments: Vec<u32>,
    /// What must be positive for its curves to have a point.
    pub conditions: Vec<ExprId>,
}

/// What the start of a part needs: it is assembled alone, led to what its inputs are, and carried to where its mount is.
#[derive(Clone, Debug)]
pub struct PartStart {
    /// Its name.
    pub name: String,
    /// Where that stands.
    pub span: Span,
    /// The name of its mechanism, in the text of that.
    pub text: Span,
    /// What its params are that are bound (SI), by their names there; a coordinate of a point has its own.
    pub params: Vec<(String, ExprId)>,
    /// What its inputs are (SI), over the coordinates and time.
    pub inputs: Vec<(String, ExprId)>,
    /// Where its ground is: x (m), y (m), phi (rad).
    pub mount: [ExprId; 3],
    /// Whether its text is mirrored.
    pub is_mirrored: bool,
    /// Its bodies.
    pub bodies: Vec<BodyId>,
    /// The coordinates of these.
    pub poses: Range<usize>,
    /// The coordinates that its joints bring along.
    pub own: Range<usize>,
}
