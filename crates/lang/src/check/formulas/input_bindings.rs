//! Bindings of inputs of parts: formulas of time and motion, which may use inputs of other parts. They are read in order of dependence
//! across all parts.

use super::Formulas;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::{DefinitionOrder, Entity, ordered, visit_free_names};
use crate::check::suggest::lost_rate;
use mechc_expr::Symbol;
use mechc_syntax::ast::{Binding, Expr, Name};
use mechc_text::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// The binding of an input.
struct BoundInput<'a> {
    /// The numbers of the enclosing parts, the outermost first.
    around: Vec<usize>,
    /// The number of the part in the mechanism that uses it, and that of its input.
    part: usize,
    input: usize,
    binding: &'a Binding,
    /// The input's full name, with the location of the binding.
    name: Name,
}

impl<'a> Formulas<'a> {
    /// Evaluates the bindings of the inputs of all parts, including nested ones.
    pub(in crate::check) fn bind_inputs(&mut self) {
        let mut bound = Vec::new();
        self.add_bound_inputs(&mut Vec::new(), &mut bound);
        let uses = self.uses_of_bound_inputs(&bound);
        let DefinitionOrder { order, on_cycles } = ordered(&mut self.reporter, &uses);
        for k in order {
            let BoundInput { around, part, input, binding, .. } = &bound[k];
            self.in_nested_part(around, |formulas| formulas.bind_input(*part, *input, binding));
        }
        // Inputs on a cycle have no value, which is reported.
        for k in on_cycles {
            let BoundInput { around, part, input, .. } = &bound[k];
            self.in_nested_part(around, |formulas| formulas.in_part(*part, |child| child.inputs[*input].value = None));
        }
        self.record_part_inputs();
    }

    fn add_bound_inputs(&self, around: &mut Vec<usize>, bound: &mut Vec<BoundInput<'a>>) {
        for (part, child) in self.parts.iter().enumerate() {
            for binding in &self.part_declarations[part].bindings {
                let Some(Entity::Input(input)) = child.scope.get(&binding.name.text) else { continue };
                let name = Name { text: format!("{}{}", child.scope.path, binding.name.text), span: binding.name.span };
                bound.push(BoundInput { around: around.clone(), part, input, binding, name });
            }
            around.push(part);
            child.add_bound_inputs(around, bound);
            around.pop();
        }
    }

    /// Returns the other bound inputs that each one uses.
    fn uses_of_bound_inputs<'b>(&self, bound: &'b [BoundInput<'a>]) -> Vec<(&'b Name, Vec<(usize, Span)>)> {
        let mut positions: FxHashMap<&str, usize> = FxHashMap::default();
        for (k, one) in bound.iter().enumerate() {
            positions.entry(&one.name.text).or_insert(k);
        }
        let uses = |one: &'b BoundInput<'a>| {
            let mut formulas = self;
            for &part in &one.around {
                formulas = &formulas.parts[part];
            }
            let named = formulas.inputs_in(&one.binding.value);
            (&one.name, named.into_iter().filter_map(|(name, span)| Some((*positions.get(&*name)?, span))).collect())
        };
        bound.iter().map(uses).collect()
    }

    /// Returns the full names of the inputs that a formula uses, also through functions.
    fn inputs_in(&self, formula: &Expr) -> Vec<(String, Span)> {
        let (mut open, mut visited, mut found) = (vec![(formula, None)], FxHashSet::default(), Vec::new());
        while let Some((formula, argument)) = open.pop() {
            visit_free_names(
                formula,
                |name| self.scope.hides(name),
                |name, _| match self.scope.entity(name) {
                    _ if argument == Some(name.text.as_str()) => {}
                    Some(Entity::Input(_)) => found.push((format!("{}{}", self.scope.path, name.text), name.span)),
                    Some(Entity::Function(k)) if visited.insert(k) => {
                        let function = self.functions.get(k).filter(|function| function.time.is_some());
                        open.extend(function.map(|function| (function.value, Some(function.argument.text.as_str()))));
                    }
                    _ => {}
                },
            );
        }
        found
    }

    /// Runs `work` in the part that a path of numbers leads to.
    fn in_nested_part(&mut self, around: &[usize], work: impl FnOnce(&mut Formulas<'a>)) {
        match around {
            [] => work(self),
            // Dynamic, so that all levels have one type.
            [part, rest @ ..] => {
                let work: Box<dyn FnOnce(&mut Formulas<'a>) + '_> = Box::new(work);
                self.in_part(*part, |child| child.in_nested_part(rest, work));
            }
        }
    }

    fn bind_input(&mut self, part: usize, input: usize, binding: &'a Binding) {
        let value = self.input_bound(part, input, binding);
        self.in_part(part, |child| {
            let declared = child.scope.declared(&binding.name);
            let value = value.map(|value| child.with_shift(&declared, value));
            if let Some(state) = child.inputs.get_mut(input) {
                state.value = value;
            }
        });
    }

    /// Records the formulas of the inputs of all parts in the model.
    fn record_part_inputs(&mut self) {
        for part in 0..self.parts.len() {
            self.record_inputs(part);
            self.in_part(part, Formulas::record_part_inputs);
        }
    }

    /// Records those of a part, and of nested parts whose inputs are not bound by path.
    fn record_inputs(&mut self, part: usize) {
        let Some(id) = self.parts[part].address.part else { return };
        let child = &self.parts[part];
        let local = child.inputs.iter().filter_map(|input| Some((input.name.text.clone(), input.value?.id)));
        let mut inputs: Vec<_> = local.collect();
        let graph = &mut self.model.graph;
        let deeper = self.model.inputs.iter().zip(0..).filter_map(|(input, index)| {
            let name = input.declared.name.strip_prefix(child.scope.path.as_str())?;
            name.contains('.').then(|| (name.to_owned(), graph.symbol(Symbol::Signal { index, order: 0 })))
        });
        inputs.extend(deeper);
        self.model.parts[id.index()].inputs = inputs;
    }

    fn input_bound(&mut self, part: usize, k: usize, binding: &Binding) -> Option<Value> {
        let expected = self.parts[part].inputs.get(k)?.value?.dim;
        let judged = self.is_dimensional(&binding.value);
        let context = Context {
            judged,
            time: true,
            inputs: true,
            quantities: true,
            ..Context::constant("a binding of an input")
        };
        let conditions = self.model.conditions.len();
        let value = self.formula(&binding.value, &context)?;
        let owner = format!("{}{}", self.scope.path, self.part_declarations[part].name.text);
        for condition in &mut self.model.conditions[conditions..] {
            condition.owner.clone_from(&owner);
        }
        let unlike = match expected {
            Dim::Of(_) => expected.other_than(value.dim).filter(|_| self.counts(value, &context)),
            _ => expected.other_than(value.dim).filter(|_| judged),
        };
        if let Some([expected, found]) = unlike {
            let place = format!("the input `{}` of `{}`", binding.name.text, self.part_declarations[part].name.text);
            let wrong = lost_rate::Part { span: binding.value.span, dimension: found };
            self.reporter.report(errors::wrong_dimension(
                &place,
                expected,
                wrong,
                self.reporter.text(binding.value.span),
            ));
            return None;
        }
        Some(Value { dim: expected, ..value })
    }
}
