//! Partitions the blocks of a system into independent components, and assigns outputs to them.

use mechc_expr::{ExprId, Symbol};
use mechc_ir::ConstraintSystem;
use mechc_ir::structure::Determined;

/// The components of a system: blocks that depend on each other.
pub(super) struct Partition {
    /// By component: its blocks, in an order of solution.
    pub blocks: Vec<Vec<usize>>,
    component_of_column: Vec<usize>,
    pub block_of_column: Vec<usize>,
    component_of_row: Vec<usize>,
}

/// The outputs of a component other than its motion, as indices.
#[derive(Clone, Default)]
pub(super) struct ComponentOutputs {
    /// Columns of joint reactions and driver efforts.
    pub reactions: Vec<usize>,
    pub measures: Vec<usize>,
    /// Columns of appended derivatives.
    pub appended: Vec<usize>,
    /// Monitors of the branch, which have no columns.
    pub monitors: Vec<usize>,
}

impl ComponentOutputs {
    /// Returns the formulas of all outputs with columns.
    pub fn formulas(&self, system: &ConstraintSystem) -> Vec<ExprId> {
        let reactions = self.reactions.iter().map(|&k| system.reactions()[k].value);
        let measures = self.measures.iter().flat_map(|&k| {
            let measure = &system.measures()[k];
            [Some(measure.value), measure.first, measure.second].into_iter().flatten()
        });
        reactions.chain(measures).chain(self.appended.iter().map(|&k| system.derivative_columns()[k].value)).collect()
    }
}

impl Partition {
    pub fn new(determined: &Determined) -> Partition {
        let (system, blocks) = (determined.system(), determined.blocks());
        let block_of_column = determined.block_of_columns();
        let mut parent: Vec<usize> = (0..blocks.len()).collect();
        let mut join = |a: usize, b: usize| {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b)] = a.min(b);
        };
        let mut block_of_row = vec![0; system.rows().len()];
        for (k, block) in blocks.iter().enumerate() {
            for &row in &block.rows {
                block_of_row[row as usize] = k;
                for &(column, _) in system.phi_q().row(row as usize) {
                    join(k, block_of_column[column as usize]);
                }
            }
        }
        // a load on one component may depend on coordinates of another
        for (&block, &needed) in block_of_column.iter().zip(system.required_forces()) {
            for symbol in system.graph().symbols(needed) {
                if let Symbol::Coordinate { index, .. } = symbol {
                    join(block, block_of_column[index as usize]);
                }
            }
        }
        let mut number = vec![usize::MAX; blocks.len()];
        let mut components: Vec<Vec<usize>> = Vec::new();
        for k in 0..blocks.len() {
            let root = root(&mut parent, k);
            if number[root] == usize::MAX {
                number[root] = components.len();
                components.push(Vec::new());
            }
            components[number[root]].push(k);
        }
        let mut component_of_block = |block: &usize| number[root(&mut parent, *block)];
        let component_of_column = block_of_column.iter().map(&mut component_of_block).collect();
        let component_of_row = block_of_row.iter().map(&mut component_of_block).collect();
        Partition { blocks: components, component_of_column, block_of_column, component_of_row }
    }

    /// Returns the outputs of each component, with or without reactions, and last the shared outputs, which depend on several components.
    pub fn outputs_by_component(&self, system: &ConstraintSystem, with_reactions: bool) -> Vec<ComponentOutputs> {
        let mut outputs = vec![ComponentOutputs::default(); self.blocks.len() + 1];
        let reactions = if with_reactions { system.reactions() } else { &[] };
        for (k, reaction) in reactions.iter().enumerate() {
            outputs[self.component_of(system, [reaction.value])].reactions.push(k);
        }
        for (k, measure) in system.measures().iter().enumerate() {
            let formulas = [Some(measure.value), measure.first, measure.second];
            outputs[self.component_of(system, formulas.into_iter().flatten())].measures.push(k);
        }
        for (k, column) in system.derivative_columns().iter().enumerate() {
            outputs[self.component_of(system, [column.value])].appended.push(k);
        }
        for (k, monitor) in system.monitors().iter().enumerate() {
            outputs[self.component_of(system, [monitor.value])].monitors.push(k);
        }
        outputs
    }

    /// Returns the component that formulas depend on, or the number of components if there are several or none.
    fn component_of(&self, system: &ConstraintSystem, formulas: impl IntoIterator<Item = ExprId>) -> usize {
        let symbols = formulas.into_iter().flat_map(|id| system.graph().symbols(id));
        let mut components = symbols.filter_map(|symbol| match symbol {
            Symbol::Coordinate { index, .. } | Symbol::Varied { index, .. } => {
                Some(self.component_of_column[index as usize])
            }
            Symbol::Multiplier(row) | Symbol::VariedMultiplier { row, .. } => Some(self.component_of_row[row as usize]),
            _ => None,
        });
        let first = components.next();
        first.filter(|first| components.all(|component| component == *first)).unwrap_or(self.blocks.len())
    }
}

/// Returns the root of an element in a union-find forest, and shortens its path.
fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}
