//! Formulas of the motion that are evaluated beside the equations.

use super::compile::Layout;
use super::{Outputs, Program, Register, Stage};
use crate::expr::{ExprId, Graph};

impl Program {
    /// A program of nothing but formulas, over so many parameters, coordinates, variations of these and multipliers, and where each is
    /// left: by the stage [`Stage::Measures`].
    #[must_use]
    pub fn of_formulas(graph: &Graph, counts: [usize; 4], roots: &[ExprId]) -> (Program, Vec<Register>) {
        let [params, coordinates, variations, multipliers] = counts.map(|count| count as u32);
        let mut layout = Layout::of(graph, [params, coordinates, 0, 0, variations, multipliers]);
        let registers = layout.place(Stage::Measures, roots.iter().copied());
        (layout.finish(Outputs::default()), registers)
    }
}
