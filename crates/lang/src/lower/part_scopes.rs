//! Parts whose texts ask for derivatives by their own equations, with these equations.

use super::Lowering;
use crate::model::{Mechanism, Named, PartId};
use mechc_expr::{ExprId, Graph};
use mechc_ir::{ConstraintSystem, DeclarationId, LEAF_ORDERS, Leaf, PartWithDerivatives, Scope, SparseRows, leaf};
use rustc_hash::FxHashMap;

/// Formulas in which the inputs that parts hold fixed are leaves.
#[derive(Default)]
pub(super) struct LeafContext {
    imported: FxHashMap<ExprId, ExprId>,
    named: Vec<ExprId>,
    /// The number of the leaf of a part's input, by the part and the model's formula to which the input is bound.
    leaves: FxHashMap<(PartId, ExprId), usize>,
    /// The parts, by the number of their scope.
    parts: Vec<PartId>,
    /// True while formulas are lowered with leaves.
    is_on: bool,
}

impl LeafContext {
    fn scope(&self, part: PartId) -> Option<u32> {
        self.parts.iter().position(|scope| *scope == part).map(|number| number as u32)
    }
}

/// Returns the parts whose inputs are held fixed, or in which derivatives are taken.
pub(super) fn parts_with_scope(model: &Mechanism) -> Vec<PartId> {
    let mut parts: Vec<PartId> = model
        .named
        .iter()
        .filter_map(|named| match named {
            Named::Held(part, _) | Named::By(_, _, Some(part)) => Some(*part),
            _ => None,
        })
        .collect();
    parts.sort_unstable();
    parts.dedup();
    parts
}

/// Returns whether `part` is or encloses the part `to` in which something is declared.
fn belongs(model: &Mechanism, mut to: Option<PartId>, part: PartId) -> bool {
    while let Some(inner) = to {
        if inner == part {
            return true;
        }
        to = model[inner].within;
    }
    false
}

impl Lowering<'_> {
    /// Runs `work` with the inputs of parts as leaves.
    fn with_leaves<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let swap = |l: &mut Self| {
            std::mem::swap(&mut l.imported, &mut l.leaf_context.imported);
            std::mem::swap(&mut l.named, &mut l.leaf_context.named);
            l.leaf_context.is_on = !l.leaf_context.is_on;
        };
        swap(self);
        let result = work(self);
        swap(self);
        result
    }

    /// Adds the scopes of such parts. Only their coordinates are known yet; only tables have been imported.
    pub(super) fn open_scopes(&mut self) {
        let (model, numbering) = (self.model, &self.numbering);
        let parts = parts_with_scope(model);
        if let Some(variations) = &mut self.variations {
            let scope = |&part: &PartId| Scope {
                name: model[part].declared.name.clone(),
                columns: numbering.of_part(model, |to| belongs(model, to, part)),
                phi: Vec::new(),
                phi_q: SparseRows::new(),
            };
            variations.scopes = parts.iter().map(scope).collect();
        }
        self.leaf_context.imported.clone_from(&self.imported);
        self.leaf_context.parts = parts;
    }

    /// Adds the rows of each scope, with leaves.
    pub(super) fn rows_of_scopes(&mut self) {
        for (number, part) in self.leaf_context.parts.clone().into_iter().enumerate() {
            let phi = self.rows_with_leaves(part);
            if let Some(variations) = &mut self.variations {
                variations.scopes[number].phi = phi;
            }
        }
    }

    fn rows_with_leaves(&mut self, part: PartId) -> Vec<ExprId> {
        let model = self.model;
        let declarations = self.declarations_of(part);
        let mut phi = Vec::new();
        for row in 0..self.rows.len() {
            let declaration = self.rows[row].declaration;
            if !declarations.contains(&declaration) {
                continue;
            }
            let id = match declaration.index().checked_sub(model.joints.len()) {
                // Joints hold no inputs.
                None => self.rows[row].phi,
                Some(number) => self.equation_with_leaves(number),
            };
            phi.push(id);
        }
        phi
    }

    /// Returns the row of an equation with leaves, by its number among the rows: constraints, then drivers.
    fn equation_with_leaves(&mut self, number: usize) -> ExprId {
        let model = self.model;
        let in_order =
            model.equations.iter().filter(|one| !one.driver).chain(model.equations.iter().filter(|e| e.driver));
        let Some(equation) = in_order.into_iter().nth(number) else { return self.graph.constant(0.0) };
        self.resolve_with_leaves_up_to(model.named_before_results);
        self.with_leaves(|l| l.equation_row(equation.form))
    }

    fn resolve_with_leaves_up_to(&mut self, end: usize) {
        self.with_leaves(|l| l.resolve_symbols_up_to(end));
    }

    /// Returns an input of a part: its leaf while formulas are lowered with leaves, else the formula to which it is bound.
    pub(super) fn held_input(&mut self, part: PartId, bound: ExprId) -> ExprId {
        let scope = self.leaf_context.scope(part).filter(|_| self.leaf_context.is_on);
        let id = self.formula(bound);
        let Some(scope) = scope else { return id };
        if let Some(&number) = self.leaf_context.leaves.get(&(part, bound)) {
            return self.graph.symbol(leaf(number));
        }
        let with_leaves = with_rates(&mut self.graph, id);
        let plain = self.with_leaves(|l| l.formula(bound));
        let plain = with_rates(&mut self.graph, plain);
        let Some(variations) = &mut self.variations else { return id };
        let number = variations.leaves.len();
        variations.leaves.push(Leaf { scope, with_leaves, plain });
        self.leaf_context.leaves.insert((part, bound), number);
        self.graph.symbol(leaf(number))
    }

    /// Returns a derivative by a variable; by the equations of `part`, if that moves together with its surroundings. `number` is that of
    /// the derivative's named symbol.
    pub(super) fn derivative_within(
        &mut self,
        number: usize,
        inner: ExprId,
        variable: u32,
        part: Option<PartId>,
    ) -> ExprId {
        if self.leaf_context.parts.is_empty() {
            let inner = self.formula(inner);
            return self.derivative_by(inner, variable);
        }
        if !self.leaf_context.is_on {
            self.resolve_with_leaves_up_to(number + 1);
            let with_leaves = self.leaf_context.named[number];
            return match &self.variations {
                Some(variations) => variations.without_leaves(&mut self.graph, with_leaves),
                None => with_leaves,
            };
        }
        let inner = self.formula(inner);
        let scope = part.and_then(|part| self.leaf_context.scope(part));
        let Some(variations) = &mut self.variations else { return self.graph.constant(0.0) };
        let variable = scope.map_or(variable, |scope| variations.within(variable, scope));
        self.derivative_by(inner, variable)
    }

    /// Returns the parts whose texts ask for derivatives.
    pub(super) fn parts_with_derivatives(&mut self) -> Vec<PartWithDerivatives> {
        let model = self.model;
        let mut asking: Vec<PartId> = model.part_derivatives.iter().map(|derivative| derivative.part).collect();
        asking.sort_unstable();
        asking.dedup();
        asking.into_iter().map(|part| self.asking_part(part)).collect()
    }

    fn asking_part(&mut self, part: PartId) -> PartWithDerivatives {
        let model = self.model;
        let derivatives = || model.part_derivatives.iter().filter(|derivative| derivative.part == part);
        let mut places: Vec<_> = derivatives().map(|derivative| derivative.span).collect();
        places.dedup();
        let of_force = derivatives().find(|derivative| derivative.is_of_force).map(|derivative| derivative.span);
        let around = model.parts_around(Some(part));
        let used_at = around.map(|part| (model[part].declared.name.clone(), model[part].declared.span)).collect();
        let (name, columns) =
            (model[part].declared.name.clone(), self.numbering.of_part(model, |to| belongs(model, to, part)));
        let inputs = model[part].inputs.iter().map(|(_, id)| self.formula(*id)).collect();
        PartWithDerivatives {
            name,
            used_at,
            places,
            of_force,
            columns,
            inputs,
            declarations: self.declarations_of(part),
        }
    }

    /// Returns the joints, constraints and drivers of a part and of the parts in it.
    fn declarations_of(&self, part: PartId) -> Vec<DeclarationId> {
        let model = self.model;
        let path = format!("{}.", model[part].declared.name);
        let is_of_part = |k: &DeclarationId| match model.joints.get(k.index()) {
            Some(joint) => belongs(model, joint.part, part),
            None => self.declarations[*k].name.starts_with(&path),
        };
        self.declarations.ids().filter(is_of_part).collect()
    }
}

/// Returns a formula with its time derivatives.
fn with_rates(graph: &mut Graph, id: ExprId) -> [ExprId; LEAF_ORDERS] {
    let mut orders = [id; LEAF_ORDERS];
    for order in 1..LEAF_ORDERS {
        orders[order] = ConstraintSystem::time_derivatives(graph, &[orders[order - 1]], 3)[0];
    }
    orders
}
