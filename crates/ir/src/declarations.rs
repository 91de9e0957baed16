//! What a system is of, each thing with its name and its place in the text.

use super::{AxisId, BodyId, CircleId, DeclarationId, JointKind, PointId};
use mechc_expr::{ExprId, Symbol, TIME_SIGNAL};
use mechc_text::source::Span;
use mechc_text::vocabulary::Dimension;

/// A parameter with its value in SI.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub name: String,
    /// How many bytes of it are the path of its part, the last dot too; 0 of one of the mechanism's own.
    pub part: usize,
    /// Its value in SI.
    pub value: f64,
    /// Of its value; that of a plain number is pure, whatever it stands for.
    pub dimension: Dimension,
    /// The name's place.
    pub span: Span,
}

impl Param {
    /// Its SI unit: `m`, `1/s`, or `1` for a pure number.
    #[must_use]
    pub fn unit(&self) -> String {
        self.dimension.unit()
    }
}

/// A signal that comes from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// The number of its signal's symbol.
    pub index: u32,
    /// Its SI unit: `m`, `1/s`, or `1` for a pure number.
    pub unit: String,
    /// The name's place.
    pub span: Span,
    /// By the text: its value, rate and acceleration, as formulas of time.
    pub formulas: [ExprId; 3],
}

impl Input {
    /// The symbol of its value.
    #[must_use]
    pub fn symbol(&self) -> Symbol {
        Symbol::Signal { index: self.index, order: 0 }
    }

    /// Whether it is time, which is one where formulas hold it beside inputs.
    #[must_use]
    pub fn is_time(&self) -> bool {
        self.index == TIME_SIGNAL
    }
}

/// A body with its place in the text.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// The name's place.
    pub span: Span,
    /// Where its pose is written, if it is.
    pub pose_span: Option<Span>,
    /// Its coordinates: x, y, phi.
    pub pose: [usize; 3],
}

/// What a coordinate measures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CoordinateKind {
    /// In metres.
    Length,
    /// In radians.
    Angle,
    /// A pure number: the argument of a curve at a contact, or the angle on a circle that serves as one.
    Argument,
}

impl CoordinateKind {
    /// The SI unit; none for a pure number.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            CoordinateKind::Length => "m",
            CoordinateKind::Angle => "rad",
            CoordinateKind::Argument => "",
        }
    }
}

/// Whose a coordinate is.
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
    /// `crank.phi`
    pub name: String,
    /// Whose it is.
    pub owner: Owner,
    /// What it measures.
    pub kind: CoordinateKind,
    /// Where assembly starts; holds parameters only.
    pub estimate: ExprId,
    /// What a change of it is judged against: the size of its body (m), or 1 (rad).
    pub scale: f64,
}

/// What kind of declaration wrote a row.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum DeclarationKind {
    /// A joint.
    Joint(JointKind),
    /// A constraint.
    Constraint,
    /// A driver.
    Driver,
}

impl DeclarationKind {
    /// `joint`, `constraint` or `driver`.
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
    /// Its name.
    pub name: String,
    /// The name's place.
    pub span: Span,
    /// Which kind.
    pub kind: DeclarationKind,
    /// How many rows it wrote.
    pub rows: usize,
    /// Where it takes hold: one point for each of its two bodies where there is one.
    pub points: Vec<PointId>,
    /// All points that its equations speak of.
    pub features: Vec<PointId>,
    /// The axes that it joins.
    pub axes: Vec<AxisId>,
    /// The circles that it joins.
    pub circles: Vec<CircleId>,
    /// Where a joint takes hold (m), in the ground's frame, as a formula of the coordinates: at its second point, the point of its second
    /// axis, the centre of its second circle, or the contact.
    pub at: Option<[ExprId; 2]>,
    /// Where the two sides of an equation are written.
    pub written: Option<Span>,
    /// Whether formulas speak of this joint: of its rotation or displacement.
    pub is_spoken_of: bool,
}

/// A number to tabulate, with the time derivatives that can be had.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: ExprId,
    /// Its first time derivative, if that needs no fourth derivative of `q`.
    pub first: Option<ExprId>,
    /// Its second time derivative, likewise.
    pub second: Option<ExprId>,
    /// The name's place.
    pub span: Span,
    /// In what it is printed.
    pub units: Units,
}

impl Measure {
    /// Its value (order 0), first or second time derivative, if that can be had.
    #[must_use]
    pub fn derivative(&self, order: usize) -> Option<ExprId> {
        [Some(self.value), self.first, self.second][order]
    }

    /// Whether it has a value (0), a first time derivative (1), a second one (2).
    #[must_use]
    pub fn has(&self, order: usize) -> bool {
        self.derivative(order).is_some()
    }
}

/// The units of a measure and of its derivatives.
#[derive(Clone, Debug)]
pub struct Units {
    /// The SI unit of its value: `m`, `rad/s`, or `1` for a pure number.
    pub si: String,
    /// Those in which it, its first and its second time derivative are printed.
    pub printed: [String; 3],
    /// What SI is divided by, multiplied with and divided by to be in these.
    pub scale: [f64; 3],
}
