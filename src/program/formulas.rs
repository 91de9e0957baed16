//! Formulas of the motion that are evaluated beside the equations.

use super::compile::Layout;
use super::{Outputs, Program, Register, Stage};
use crate::expr::{ExprId, Graph};

impl Program {
    /// A program of nothing but formulas, over so many parameters and coordinates, and where each is left: by the stage
    /// [`Stage::Measures`].
    #[must_use]
    pub fn of_formulas(graph: &Graph, params: usize, coordinates: usize, roots: &[ExprId]) -> (Program, Vec<Register>) {
        let mut layout = Layout::of(graph, [params, coordinates, 0, 0, 0].map(|count| count as u32));
        let registers = layout.place(Stage::Measures, roots.iter().copied());
        (layout.finish(Outputs::default()), registers)
    }
}
