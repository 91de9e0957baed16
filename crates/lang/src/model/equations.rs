//! Constraints, drivers, what is tabulated of a motion, and what must hold on the way.

use super::{CompoundUnit, Declared, Dimension, PartId, PointId};
use mechc_expr::{ExprId, TableId};
use mechc_text::source::Span;

/// A constraint or driver.
#[derive(Clone, Debug)]
pub struct Equation {
    /// Its name.
    pub declared: Declared,
    /// A driver, rather than a constraint.
    pub driver: bool,
    /// What it demands.
    pub form: EquationForm,
    /// Of both sides; as far as that is known where plain numbers stand for anything.
    pub dimension: Dimension,
    /// Whether an angle is a factor of them, as far as their words tell.
    pub is_angle: bool,
    /// Where both sides are written.
    pub written: Span,
}

/// What an equation says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EquationForm {
    /// Two formulas are equal.
    Equality(ExprId, ExprId),
    /// Two points have a distance, which is a formula without kinematic quantities (m).
    Distance(PointId, PointId, ExprId),
}

/// A number to tabulate.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub declared: Declared,
    /// Its formula.
    pub value: ExprId,
    /// What must be positive for it to have a value.
    pub conditions: Vec<Condition>,
    /// In what it is printed.
    pub units: Units,
}

/// The path of a point: two measures, `NAME.x` and `NAME.y`.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Its name.
    pub declared: Declared,
    /// The part in whose text it is declared, and in whose frame its measures are.
    pub part: Option<PartId>,
    /// The point, if it is one that is fixed to a frame.
    pub point: Option<PointId>,
    /// The place of its first measure among the measures.
    pub measure: usize,
}

/// The units of a measure and of its derivatives.
#[derive(Clone, PartialEq, Debug)]
pub struct Units {
    /// The SI unit of its value.
    pub si: String,
    /// Those in which it, its first and its second time derivative are printed.
    pub printed: [String; 3],
    /// What SI is divided by, multiplied with and divided by to be in these.
    pub scale: [f64; 3],
}

impl Units {
    /// SI; angles are told from other pure numbers.
    #[must_use]
    pub fn si(dimension: Dimension, is_angle: bool) -> Units {
        let printed = [0.0, 1.0, 2.0].map(|times| dimension.over(Dimension::TIME.to_the(times)).unit_of(is_angle));
        Units { si: printed[0].clone(), printed, scale: [1.0; 3] }
    }

    /// Another unit.
    #[must_use]
    pub fn of(unit: &CompoundUnit, is_angle: bool) -> Units {
        let printed = [0, 1, 2].map(|times| unit.per_second(times));
        Units { si: unit.dimension().unit_of(is_angle), printed, scale: unit.scale() }
    }
}

/// A formula that must be positive, for others to have a meaning.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Must be above zero.
    pub positive: ExprId,
    /// What it is.
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
    /// A quantity of measures; where it does not exist, they have no value.
    Existence,
    /// The interval of a motion function.
    Interval,
    /// The range of a table.
    Range(TableId),
    /// The times of the samples of an input.
    Samples(TableId),
}

/// Which times to compute.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Analysis {
    /// First time (s).
    pub from: f64,
    /// Last time (s).
    pub to: f64,
    /// Step (s).
    pub every: f64,
    /// The formulas of these three, of parameters alone.
    pub formulas: [ExprId; 3],
    /// The declaration.
    pub span: Span,
}
