//! Constraints, drivers, measures, and the conditions of formulas.

use super::{CompoundUnit, Declared, Dimension, PartId, PointId};
use mechc_expr::{ExprId, TableId};
use mechc_text::source::Span;

/// A constraint or driver.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The equation's name.
    pub declared: Declared,
    /// True for a driver, false for a constraint.
    pub driver: bool,
    /// The equation's content.
    pub form: EquationForm,
    /// The dimension of both sides, as far as plain numbers leave it determined.
    pub dimension: Dimension,
    /// The location of both sides.
    pub written: Span,
}

/// The form of an equation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EquationForm {
    /// Two formulas are equal.
    Equality(ExprId, ExprId),
    /// Two points have a distance (m), given by a formula without kinematic quantities.
    Distance(PointId, PointId, ExprId),
}

/// A tabulated number.
#[derive(Clone, Debug)]
pub struct Measure {
    /// The measure's name.
    pub declared: Declared,
    /// The measure's formula.
    pub value: ExprId,
    /// Formulas that must be positive for the measure to have a value.
    pub conditions: Vec<Condition>,
    /// The units in which the measure is printed.
    pub units: Units,
}

/// The path of a point: two measures, `NAME.x` and `NAME.y`.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The trace's name.
    pub declared: Declared,
    /// The part in whose text it is declared; its measures are relative to that part's ground.
    pub part: Option<PartId>,
    /// The point, if it is fixed to a frame.
    pub point: Option<PointId>,
    /// The index of its first measure.
    pub measure: usize,
}

/// The units of a measure and of its derivatives.
#[derive(Clone, PartialEq, Debug)]
pub struct Units {
    /// The SI unit of its value.
    pub si: String,
    /// The printed units of the value and of its first and second time derivative.
    pub printed: [String; 3],
    /// The factors from SI to the printed units: divide by the first, multiply with the second, divide by the third.
    pub scale: [f64; 3],
}

impl Units {
    /// Returns SI units; an angle has its own unit, unlike other pure numbers.
    #[must_use]
    pub fn si(dimension: Dimension) -> Units {
        let printed = [0.0, 1.0, 2.0].map(|times| dimension.over(Dimension::TIME.to_the(times)).display_unit());
        Units { si: printed[0].clone(), printed, scale: [1.0; 3] }
    }

    /// Returns the units that belong to a unit of the language, in which values of a dimension are printed.
    #[must_use]
    pub fn of(unit: &CompoundUnit, dimension: Dimension) -> Units {
        let printed = [0, 1, 2].map(|times| unit.per_second(times));
        Units {
            si: Dimension { angle: dimension.angle, ..unit.dimension() }.display_unit(),
            printed,
            scale: unit.scale(),
        }
    }
}

/// A formula that must be positive for others to be defined.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The formula, which must be greater than zero.
    pub positive: ExprId,
    /// The subject of the condition.
    pub kind: ConditionKind,
    /// The location of the formula.
    pub span: Span,
    /// The name of the declaration that requires the condition.
    pub owner: String,
}

/// The subject of a condition.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConditionKind {
    /// A prescribed distance.
    Distance,
    /// A quantity of measures exists; where it does not, the measures have no value.
    Existence,
    /// An argument lies within the interval of a motion function.
    Interval,
    /// An argument lies within the range of a table.
    Range(TableId),
    /// Time lies within the samples of an input.
    Samples(TableId),
}

/// The times to compute.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Analysis {
    /// First time (s).
    pub from: f64,
    /// Last time (s).
    pub to: f64,
    /// Time between rows (s).
    pub every: f64,
    /// The formulas of these three times, over parameters only.
    pub formulas: [ExprId; 3],
    /// The location of the declaration.
    pub span: Span,
}
