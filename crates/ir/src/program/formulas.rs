//! Formulas of the motion that are evaluated beside the equations.

use super::compile::Layout;
use super::interval_eval::behind;
use super::{Op, Outputs, Program, Register, Stage};
use mechc_expr::{ExprId, Graph};
use rustc_hash::FxHashMap;

impl Program {
    /// A program of nothing but formulas, over so many parameters, coordinates, variations of these and multipliers, and where each is
    /// left: by the stage [`Stage::Measures`].
    #[must_use]
    pub fn of_formulas(graph: &Graph, counts: [usize; 4], roots: &[ExprId]) -> (Program, Vec<Register>) {
        let (program, registers, _) = Program::of_formulas_and_nodes(graph, counts, roots);
        (program, registers)
    }

    /// As [`Program::of_formulas`], with the register of each node of the graph that the formulas depend on.
    #[must_use]
    pub fn of_formulas_and_nodes(
        graph: &Graph,
        counts: [usize; 4],
        roots: &[ExprId],
    ) -> (Program, Vec<Register>, FxHashMap<Register, ExprId>) {
        let [params, coordinates, variations, multipliers] = counts.map(|count| count as u32);
        let mut layout = Layout::of(graph, [params, coordinates, 0, 0, variations, multipliers]);
        let registers = layout.place(Stage::Measures, roots.iter().copied());
        let nodes = graph.reachable(roots).into_iter().map(|id| (layout.register(id), id)).collect();
        (layout.finish(Outputs::default()), registers, nodes)
    }

    /// The operations of a stage that some registers depend on, in the order in which they run.
    #[must_use]
    pub fn operations_behind(&self, roots: &[Register], stage: Stage) -> Vec<Op> {
        behind(self, roots, &[stage])
    }
}
