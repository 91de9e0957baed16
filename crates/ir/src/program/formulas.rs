//! Programs of formulas that are evaluated separately from the equations.

use super::compile::Layout;
use super::interval_eval::backward_slice;
use super::{Op, Outputs, Program, Register, Stage};
use mechc_expr::{ExprId, Graph};
use rustc_hash::FxHashMap;

impl Program {
    /// Compiles formulas alone, for given numbers of parameters, coordinates, variations and multipliers. Returns the program, which
    /// evaluates them in [`Stage::Measures`], and their registers.
    #[must_use]
    pub fn of_formulas(graph: &Graph, counts: [usize; 4], roots: &[ExprId]) -> (Program, Vec<Register>) {
        let (program, registers, _) = Program::from_formulas_with_nodes(graph, counts, roots);
        (program, registers)
    }

    /// Compiles formulas as [`Program::of_formulas`] does; also returns the node of each register that the formulas depend on.
    #[must_use]
    pub fn from_formulas_with_nodes(
        graph: &Graph,
        counts: [usize; 4],
        roots: &[ExprId],
    ) -> (Program, Vec<Register>, FxHashMap<Register, ExprId>) {
        let [params, coordinates, variations, multipliers] = counts.map(|count| count as u32);
        let mut layout = Layout::of(graph, [params, coordinates, 0, 0, variations, multipliers]);
        let registers = layout.emit_all(Stage::Measures, roots.iter().copied());
        let nodes = graph.reachable(roots).into_iter().map(|id| (layout.register(id), id)).collect();
        (layout.finish(Outputs::default()), registers, nodes)
    }

    /// Returns the operations of a stage that some registers depend on, in order of evaluation.
    #[must_use]
    pub fn operations_behind(&self, roots: &[Register], stage: Stage) -> Vec<Op> {
        backward_slice(self, roots, &[stage])
    }
}
