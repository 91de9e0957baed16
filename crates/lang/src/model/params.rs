//! Parameters, inputs, and the variables of derivatives.

use super::{Condition, Declared, Dimension};
use mechc_expr::{ExprId, Symbol};

/// A parameter that depends on no other parameter.
#[derive(Clone, Debug)]
pub struct Param {
    /// The parameter's name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// The value, in SI units.
    pub value: f64,
    /// The dimension of the value.
    pub dimension: Dimension,
}

/// A signal whose values may come from outside. Formulas of the model hold its symbol, whose number is its position in the list of inputs.
#[derive(Clone, Debug)]
pub struct Input {
    /// The input's name.
    pub declared: Declared,
    /// The formula in force: that of an option, or else of the text.
    pub formula: TimeFormula,
    /// The formula of the text.
    pub nominal: TimeFormula,
    /// The dimension of the value.
    pub dimension: Dimension,
}

/// A formula of time and parameters.
#[derive(Clone, Debug)]
pub struct TimeFormula {
    /// The value, in SI units.
    pub value: ExprId,
    /// The conditions under which it is defined.
    pub conditions: Vec<Condition>,
}

/// A parameter or input that moves from one value to another along a continuation path.
#[derive(Clone, Debug)]
pub struct ContinuedParam {
    /// The name of the parameter or input.
    pub declared: Declared,
    /// The index of the parameter, whose symbol then stands for the first value; `None` for an input.
    pub param: Option<u32>,
    /// The first and the last value, in SI units.
    pub line: [f64; 2],
    /// The dimension of the value.
    pub dimension: Dimension,
}

/// An input or parameter by which derivatives are taken.
#[derive(Clone, Debug)]
pub struct Variable {
    /// The name; `A.x` for a coordinate of a point.
    pub declared: Declared,
    /// The symbol by which formulas are differentiated: the parameter, or a shift that is added to its formula.
    pub symbol: Symbol,
    /// The value (SI): the parameter, or its formula with the shift.
    pub value: ExprId,
    /// The dimension of the value.
    pub dimension: Dimension,
}
