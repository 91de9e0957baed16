//! Inputs and time in the equations: as formulas, as signals, or on a path.

use super::Lowering;
use crate::model::{self, ContinuedParam, Dimension, Mechanism};
use mechc_expr::{ExprId, Graph, Node, Symbol, TIME_SIGNAL};
use mechc_ir::{ConstraintSystem, Input};
use rustc_hash::FxHashMap;

/// The expressions that stand for inputs and time in the equations.
#[derive(Clone, Debug, Default)]
pub enum Inputs {
    /// Inputs are replaced by their formulas of time.
    #[default]
    Inlined,
    /// Inputs and time are signals, whose values come from outside.
    Signals,
    /// A path parameter from 0 to 1 replaces time. Inputs and time move along it on straight lines.
    AlongPath(InputPath),
    /// A path parameter from 0 to 1 replaces time. Parameters move along it on straight lines, and so does time if it moves; inputs follow
    /// time.
    ParamsAlongPath(TimeOnPath),
}

/// Time during a continuation of parameters.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum TimeOnPath {
    /// Time is constant (s).
    Still(f64),
    /// Time moves too.
    Moving,
}

/// A path on which inputs and time move on straight lines from the values of the text to a target.
#[derive(Clone, Debug)]
pub struct InputPath {
    /// The first and the last time (s).
    times: [f64; 2],
    /// The first and the last value of each input (SI).
    lines: Vec<[f64; 2]>,
}

impl InputPath {
    /// Returns the path between two times (s). It begins at the values that the inputs have by the formulas of the text, and ends at the target
    /// values `targets` (SI), by names; other inputs end at the values of their formulas. `None` if an input has no value at an end.
    #[must_use]
    pub fn new(model: &Mechanism, times: [f64; 2], targets: &[(String, f64)]) -> Option<InputPath> {
        let value_at = |formula: &model::TimeFormula, t: f64| {
            let is_defined = formula.conditions.iter().all(|condition| model.value_at(condition.positive, t) > 0.0);
            Some(model.value_at(formula.value, t)).filter(|value| is_defined && value.is_finite())
        };
        let line = |input: &model::Input| {
            let target = targets.iter().find(|(name, _)| *name == input.declared.name);
            let last = match target {
                Some((_, value)) => Some(*value).filter(|value| value.is_finite()),
                None => value_at(&input.formula, times[1]),
            };
            Some([value_at(&input.nominal, times[0])?, last?])
        };
        let lines = model.inputs.iter().map(line).collect::<Option<_>>()?;
        Some(InputPath { times, lines })
    }

    /// Returns the inputs of a model with their lines.
    #[must_use]
    pub fn continued(&self, model: &Mechanism) -> Vec<ContinuedParam> {
        let continued = |(input, &line): (&model::Input, _)| ContinuedParam {
            declared: input.declared.clone(),
            param: None,
            line,
            dimension: input.dimension,
        };
        model.inputs.iter().zip(&self.lines).map(continued).collect()
    }
}

/// The model's formulas that have been imported into the system's graph, with their expressions there.
#[derive(Default)]
pub(super) struct Imported {
    pub formulas: FxHashMap<ExprId, ExprId>,
    /// Those within formulas of inputs.
    of_inputs: FxHashMap<ExprId, ExprId>,
}

impl Imported {
    /// Imports a formula of the model. `named` holds the expressions of its named symbols.
    pub fn formula(
        &mut self,
        graph: &mut Graph,
        model: &Mechanism,
        inputs: &Inputs,
        named: &[ExprId],
        id: ExprId,
    ) -> ExprId {
        let Imported { formulas, of_inputs } = self;
        graph.import(&model.graph, &[id], formulas, |graph, symbol| match symbol {
            Symbol::Named(k) => named[k as usize],
            Symbol::Signal { index, .. } => input(graph, model, inputs, of_inputs, index as usize),
            symbol => outside_inputs(graph, inputs, symbol),
        });
        formulas[&id]
    }
}

/// Returns the expression that stands for an input.
fn input(
    graph: &mut Graph,
    model: &Mechanism,
    inputs: &Inputs,
    imported: &mut FxHashMap<ExprId, ExprId>,
    index: usize,
) -> ExprId {
    match inputs {
        Inputs::Signals => graph.symbol(Symbol::Signal { index: index as u32, order: 0 }),
        Inputs::AlongPath(path) => line(graph, path.lines[index]),
        Inputs::Inlined | Inputs::ParamsAlongPath(_) => {
            let formula = model.inputs[index].formula.value;
            // Tables have the same numbers in both graphs.
            graph.import(&model.graph, &[formula], imported, Graph::symbol);
            imported[&formula]
        }
    }
}

/// Returns the expression that stands for a symbol other than an input or a named one.
fn outside_inputs(graph: &mut Graph, inputs: &Inputs, symbol: Symbol) -> ExprId {
    match (inputs, symbol) {
        (Inputs::Signals, Symbol::Time) => graph.symbol(Symbol::Signal { index: TIME_SIGNAL, order: 0 }),
        (Inputs::AlongPath(path), Symbol::Time) => line(graph, path.times),
        // No derivative is taken along a path.
        (Inputs::AlongPath(_), Symbol::Shift(_)) => graph.constant(0.0),
        (_, symbol) => graph.symbol(symbol),
    }
}

/// Returns the line between two values, by the path parameter.
fn line(graph: &mut Graph, ends: [f64; 2]) -> ExprId {
    let (ends, part) = (ends.map(|end| graph.constant(end)), graph.symbol(Symbol::Time));
    graph.line(ends, part)
}

impl<'m> Lowering<'m> {
    /// Returns whether inputs and time are signals.
    pub(super) fn has_signals(&self) -> bool {
        matches!(self.options.inputs, Inputs::Signals)
    }

    /// Returns the conditions of the formulas that replace inputs.
    pub(super) fn conditions_of_inputs(&self) -> impl Iterator<Item = &'m model::Condition> + use<'m> {
        let are_inlined = matches!(self.options.inputs, Inputs::Inlined | Inputs::ParamsAlongPath(_));
        let inputs = self.model.inputs.iter().filter(move |_| are_inlined);
        inputs.flat_map(|input| &input.formula.conditions)
    }

    /// Adds the inputs to the system, in order of declaration, with their formulas of time. If inputs are signals and a formula holds time,
    /// time is an input too.
    pub(super) fn add_inputs(&self, system: &mut ConstraintSystem) {
        let inputs = (0..self.model.inputs.len()).map(|index| self.lower_input(index, system));
        let mut inputs: Vec<Input> = inputs.collect();
        let time = Node::Symbol(Symbol::Signal { index: TIME_SIGNAL, order: 0 });
        if system.has_signals() && system.graph().nodes().any(|(_, node)| node == time) {
            let value = system.graph_mut().symbol(Symbol::Time);
            let (name, dimension) = ("t".to_owned(), Dimension::TIME);
            let formulas = with_derivatives(value, system);
            inputs.push(Input { name, index: TIME_SIGNAL, dimension, span: system.span(), formulas });
        }
        system.add_inputs(inputs);
    }

    fn lower_input(&self, index: usize, system: &mut ConstraintSystem) -> Input {
        let input = &self.model.inputs[index];
        // Even where an input is a signal, it has a formula of time.
        let inputs = match &self.options.inputs {
            Inputs::Signals => &Inputs::Inlined,
            inputs => inputs,
        };
        let value = self::input(system.graph_mut(), self.model, inputs, &mut FxHashMap::default(), index);
        let formulas = with_derivatives(value, system);
        let (name, span) = (input.declared.name.clone(), input.declared.span);
        Input { name, index: index as u32, dimension: input.dimension, span, formulas }
    }
}

/// Returns a formula of time with its first two derivatives.
fn with_derivatives(value: ExprId, system: &mut ConstraintSystem) -> [ExprId; 3] {
    let rate = ConstraintSystem::time_derivatives(system.graph_mut(), &[value], 0)[0];
    let acceleration = ConstraintSystem::time_derivatives(system.graph_mut(), &[rate], 0)[0];
    [value, rate, acceleration]
}
