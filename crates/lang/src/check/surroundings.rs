//! What a mechanism is checked with, beside its own text.

use super::{Given, Lead, Library, SetInputs, TableFiles};
use mechc_syntax::ast::Expr;

/// What a mechanism is checked with, beside its own text.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Parameters set from outside.
    pub settings: Vec<Setting>,
    /// The files that it uses.
    pub library: Library,
    /// The files that its tables name.
    pub files: TableFiles,
    /// What inputs are told to be.
    pub given: Given,
    /// Of a part that stands alone: what is bound of its params (SI).
    pub bound: Vec<(String, f64)>,
    /// Where it is led, if that is all that is asked for.
    pub lead: Option<Lead>,
    /// The paths of parameters that may be set elsewhere than the text has them: they are symbols, also where they follow from others
    /// there, and the model says which they are.
    pub open: Vec<String>,
    /// Names by which all columns are differentiated.
    pub by: Vec<String>,
    /// Whether results are differentiated by these too, as further results; and if so, whether the first and the last time of the analysis
    /// are what the text says, which may go with parameters.
    pub slopes: Option<[bool; 2]>,
    /// Whether what all joints exert and all drivers supply is tabulated.
    pub reactions: bool,
    /// Whether pictures are to show forces.
    pub pictures_forces: bool,
    /// Whether inputs stay signals in the model, rather than being replaced by what they are.
    pub has_signals: bool,
    /// Inputs that are numbers which may be set.
    pub set_inputs: Option<SetInputs>,
    /// The paths of parts whose derivatives are by their own equations alone, though they move together with what is around them.
    pub coupled: Vec<String>,
}

/// A parameter's value from outside the file: `--set crank_length=60mm`.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The parameter, or a coordinate of one that is a point, with the parts before it; without a number it is meant in all copies.
    pub path: String,
    /// Its formula, which names nothing of the file.
    pub value: Expr,
}
