//! What may be set from outside, and what derivatives are taken by.

use super::{Declared, Dimension};
use mechc_expr::{ExprId, Symbol};

/// A parameter that depends on no other one.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its name.
    pub declared: Declared,
    /// The text of its `///` lines.
    pub docs: Vec<String>,
    /// In SI.
    pub value: f64,
    /// Of its value.
    pub dimension: Dimension,
}

/// A signal that comes from outside.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub declared: Declared,
    /// Its place among the inputs as they are declared, which is the number of its signal.
    pub number: usize,
    /// What it is, as a formula of time, in SI.
    pub value: ExprId,
    /// Of its value.
    pub dimension: Dimension,
}

/// An input or a parameter on its way from one value to another.
#[derive(Clone, Debug)]
pub struct Led {
    /// Its name.
    pub declared: Declared,
    /// Which of the mechanism's parameters it is, if it is one: its symbol stands for the first value then.
    pub param: Option<u32>,
    /// From and to, in SI.
    pub line: [f64; 2],
    /// Of its value.
    pub dimension: Dimension,
}

/// An input or parameter that derivatives are taken by.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name; of a coordinate of a point `A.x`.
    pub declared: Declared,
    /// What of the formulas changes: its own parameter, or a shift that is added to its formula.
    pub symbol: Symbol,
    /// Of its value.
    pub dimension: Dimension,
    /// Whether it is an angle, as far as its words tell.
    pub is_angle: bool,
}
