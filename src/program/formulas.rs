//! Formulas of the motion that are evaluated beside the equations.

use super::compile::Layout;
use super::{Outputs, Program, Register, Stage};
use crate::expr::{ExprId, Graph};

impl Program {
    /// A program of nothing but formulas, over so many parameters, coordinates and variations of these, and where each is
    /// left: by the stage [`Stage::Measures`].
    #[must_use]
    pub fn of_formulas(graph: &Graph, counts: [usize; 3], roots: &[ExprId]) -> (Program, Vec<Register>) {
        let [params, coordinates, variations] = counts.map(|count| count as u32);
        let mut layout = Layout::of(graph, [params, coordinates, 0, 0, variations, 0]);
        let registers = layout.place(Stage::Measures, roots.iter().copied());
        (layout.finish(Outputs::default()), registers)
    }
}
