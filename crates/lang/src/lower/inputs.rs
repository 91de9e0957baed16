//! Inputs as formulas of time, with their derivatives.

use crate::model::{self, Mechanism};
use mechc_expr::{ExprId, Graph, Node, Symbol, TIME_SIGNAL};
use mechc_ir::{ConstraintSystem, Input};
use rustc_hash::FxHashMap;

/// Adds the inputs of a model to its system, in order of declaration. If inputs are signals and a formula holds time, time is an input too.
pub(super) fn add(model: &Mechanism, system: &mut ConstraintSystem) {
    let mut inputs: Vec<&model::Input> = model.inputs.iter().collect();
    inputs.sort_by_key(|input| input.number);
    let mut inputs: Vec<Input> = inputs.into_iter().map(|input| lower_input(model, input, system)).collect();
    let time = Node::Symbol(Symbol::Signal { index: TIME_SIGNAL, order: 0 });
    if system.has_signals() && system.graph().nodes().any(|(_, node)| node == time) {
        let value = system.graph_mut().symbol(Symbol::Time);
        let (name, unit) = ("t".to_owned(), "s".to_owned());
        let formulas = with_derivatives(value, system);
        inputs.push(Input { name, index: TIME_SIGNAL, unit, span: system.span(), formulas });
    }
    system.add_inputs(inputs);
}

fn lower_input(model: &Mechanism, input: &model::Input, system: &mut ConstraintSystem) -> Input {
    let mut imported = FxHashMap::default();
    // Time is time here, even if it is a signal in the equations. Tables have the same numbers in both graphs.
    system.graph_mut().import(&model.graph, &[input.value], &mut imported, Graph::symbol);
    let formulas = with_derivatives(imported[&input.value], system);
    let (name, span) = (input.declared.name.clone(), input.declared.span);
    Input { name, index: input.number as u32, unit: input.dimension.unit(), span, formulas }
}

/// Returns a formula of time with its first two derivatives.
fn with_derivatives(value: ExprId, system: &mut ConstraintSystem) -> [ExprId; 3] {
    let rate = ConstraintSystem::time_derivatives(system.graph_mut(), &[value], 0)[0];
    let acceleration = ConstraintSystem::time_derivatives(system.graph_mut(), &[rate], 0)[0];
    [value, rate, acceleration]
}
