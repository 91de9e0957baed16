//! The declared things of a system, each with its name and source span.

use super::{AxisId, BodyId, CircleId, DeclarationId, JointSpec, PointId};
use mechc_expr::{ExprId, Symbol, TIME_SIGNAL};
use mechc_text::source::Span;
use mechc_text::vocabulary::Dimension;

/// A parameter with its value in SI.
#[derive(Clone, Debug)]
pub struct Param {
    /// Name.
    pub name: String,
    /// Length in bytes of the part's path in `name`, with the last dot; 0 for a parameter of the mechanism itself.
    pub part: usize,
    /// Value in SI.
    pub value: f64,
    /// Dimension of the value; that of a plain number is pure.
    pub dimension: Dimension,
    /// Span of the name.
    pub span: Span,
}

impl Param {
    /// Returns the SI unit: `m`, `1/s`, or `1` for a pure number.
    #[must_use]
    pub fn unit(&self) -> String {
        self.dimension.unit()
    }
}

/// An input signal.
#[derive(Clone, Debug)]
pub struct Input {
    /// Name.
    pub name: String,
    /// Number of its signal symbol.
    pub index: u32,
    /// Dimension of the value; that of a plain number is pure.
    pub dimension: Dimension,
    /// Span of the name.
    pub span: Span,
    /// Default value, rate and acceleration from the text, as formulas of time.
    pub formulas: [ExprId; 3],
}

impl Input {
    /// Returns the SI unit: `m`, `1/s`, or `1` for a pure number.
    #[must_use]
    pub fn unit(&self) -> String {
        self.dimension.unit()
    }

    /// Returns the symbol of its value.
    #[must_use]
    pub fn symbol(&self) -> Symbol {
        Symbol::Signal { index: self.index, order: 0 }
    }

    /// Returns whether this is time, which is an input where formulas contain input signals.
    #[must_use]
    pub fn is_time(&self) -> bool {
        self.index == TIME_SIGNAL
    }
}

/// A body with its source span.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Span of its pose, if the text gives one.
    pub pose_span: Option<Span>,
    /// Coordinates: x, y, phi.
    pub pose: [usize; 3],
}

/// Kinds of coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CoordinateKind {
    /// A length in metres.
    Length,
    /// An angle in radians.
    Angle,
    /// A pure number: the curve parameter of a contact, or the angle on a circle that serves as one.
    Argument,
}

impl CoordinateKind {
    /// Returns the SI unit; empty for a pure number.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            CoordinateKind::Length => "m",
            CoordinateKind::Angle => "rad",
            CoordinateKind::Argument => "",
        }
    }
}

/// The owner of a coordinate.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Owner {
    /// A body.
    Body(BodyId),
    /// A joint, by its declaration.
    Joint(DeclarationId),
}

/// A generalized coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// Name, such as `crank.phi`.
    pub name: String,
    /// The body or joint that it belongs to.
    pub owner: Owner,
    /// Kind.
    pub kind: CoordinateKind,
    /// Starting value for assembly; a formula of parameters alone.
    pub estimate: ExprId,
    /// Scale of its changes: the size of its body (m), or 1 (rad).
    pub scale: f64,
}

/// Kinds of declarations that write rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DeclarationKind {
    /// A joint.
    Joint(&'static JointSpec),
    /// A constraint.
    Constraint,
    /// A driver.
    Driver,
}

impl DeclarationKind {
    /// Returns `joint`, `constraint` or `driver`.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            DeclarationKind::Joint(_) => "joint",
            DeclarationKind::Constraint => "constraint",
            DeclarationKind::Driver => "driver",
        }
    }
}

/// A joint, constraint or driver.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Kind.
    pub kind: DeclarationKind,
    /// Number of rows that it wrote.
    pub rows: usize,
    /// The points that a joint connects, one for each of its two bodies, if it has such points.
    pub points: Vec<PointId>,
    /// All points that its equations refer to.
    pub features: Vec<PointId>,
    /// The axes that it joins.
    pub axes: Vec<AxisId>,
    /// The circles that it joins.
    pub circles: Vec<CircleId>,
    /// Location of a joint (m) in the frame of the ground, as formulas of the coordinates: its second point, the point of its second axis,
    /// the center of its second circle, or the contact.
    pub at: Option<[ExprId; 2]>,
    /// Span of both sides of the equation.
    pub written: Option<Span>,
    /// True if formulas refer to the rotation or displacement of this joint.
    pub is_referenced: bool,
}

/// A number to tabulate, with its time derivatives.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Name.
    pub name: String,
    /// Value.
    pub value: ExprId,
    /// First time derivative, unless it would need a fourth derivative of `q`.
    pub first: Option<ExprId>,
    /// Second time derivative, unless it would need a fourth derivative of `q`.
    pub second: Option<ExprId>,
    /// Span of the name.
    pub span: Span,
    /// Units for printing.
    pub units: Units,
}

impl Measure {
    /// Returns its value (order 0), or its first or second time derivative if available.
    #[must_use]
    pub fn derivative(&self, order: usize) -> Option<ExprId> {
        [Some(self.value), self.first, self.second][order]
    }

    /// Returns whether the derivative of an order (0 to 2) is available.
    #[must_use]
    pub fn has(&self, order: usize) -> bool {
        self.derivative(order).is_some()
    }
}

/// Units of a measure and its derivatives.
#[derive(Clone, Debug)]
pub struct Units {
    /// The SI unit of its value: `m`, `rad/s`, or `1` for a pure number.
    pub si: String,
    /// Units in which the value and its first and second time derivatives are printed.
    pub printed: [String; 3],
    /// Factors `[a, b, c]` from SI to the printed units: `value / a * b / c`.
    pub scale: [f64; 3],
}
