//! Parts whose texts ask for derivatives by their own equations, and what these are taken from.

use super::Lowering;
use crate::model::{Mechanism, Named, PartId};
use mechc_expr::{ExprId, Graph};
use mechc_ir::{AskingPart, ConstraintSystem, DeclarationId, LEAF_ORDERS, Leaf, Scope, SparseRows, leaf};
use rustc_hash::FxHashMap;

/// Formulas in which the inputs that parts may hold are leaves.
#[derive(Default)]
pub(super) struct OverLeaves {
    known: FxHashMap<ExprId, ExprId>,
    named: Vec<ExprId>,
    /// By the model's formula of what an input is bound to, and its part: the number of its leaf.
    leaves: FxHashMap<(PartId, ExprId), usize>,
    /// The parts, by the number of their scope.
    parts: Vec<PartId>,
    /// Whether formulas are lowered in this way now.
    is_on: bool,
}

impl OverLeaves {
    fn scope(&self, part: PartId) -> Option<u32> {
        self.parts.iter().position(|known| *known == part).map(|number| number as u32)
    }
}

/// The parts whose inputs are held somewhere, or within which derivatives are taken.
pub(super) fn parts_that_stand_alone(model: &Mechanism) -> Vec<PartId> {
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

/// Whether something that is declared in a part belongs to another one, which it is or which is around it.
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
    /// Work in which inputs that parts may hold are leaves.
    fn over_leaves<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let swap = |l: &mut Self| {
            std::mem::swap(&mut l.known, &mut l.over_leaves.known);
            std::mem::swap(&mut l.named, &mut l.over_leaves.named);
            l.over_leaves.is_on = !l.over_leaves.is_on;
        };
        swap(self);
        let result = work(self);
        swap(self);
        result
    }

    /// The parts that stand alone, of which only the coordinates are known yet; of formulas only tables have been lowered.
    pub(super) fn open_scopes(&mut self) {
        let (model, numbering) = (self.model, &self.numbering);
        let parts = parts_that_stand_alone(model);
        if let Some(variations) = &mut self.variations {
            let scope = |&part: &PartId| Scope {
                name: model[part].declared.name.clone(),
                columns: numbering.of_part(model, |to| belongs(model, to, part)),
                phi: Vec::new(),
                phi_q: SparseRows::new(),
            };
            variations.scopes = parts.iter().map(scope).collect();
        }
        self.over_leaves.known.clone_from(&self.known);
        self.over_leaves.parts = parts;
    }

    /// The rows of each part that stands alone, over leaves.
    pub(super) fn rows_of_scopes(&mut self) {
        for (number, part) in self.over_leaves.parts.clone().into_iter().enumerate() {
            let phi = self.rows_over_leaves(part);
            if let Some(variations) = &mut self.variations {
                variations.scopes[number].phi = phi;
            }
        }
    }

    fn rows_over_leaves(&mut self, part: PartId) -> Vec<ExprId> {
        let model = self.model;
        let own = self.declarations_of(part);
        let mut phi = Vec::new();
        for row in 0..self.rows.len() {
            let declaration = self.rows[row].declaration;
            if !own.contains(&declaration) {
                continue;
            }
            let id = match declaration.index().checked_sub(model.joints.len()) {
                // joints hold no inputs
                None => self.rows[row].phi,
                Some(number) => self.equation_over_leaves(number),
            };
            phi.push(id);
        }
        phi
    }

    /// The row of an equation, by its number among those that were lowered: constraints, then drivers.
    fn equation_over_leaves(&mut self, number: usize) -> ExprId {
        let model = self.model;
        let in_order =
            model.equations.iter().filter(|one| !one.driver).chain(model.equations.iter().filter(|e| e.driver));
        let Some(equation) = in_order.into_iter().nth(number) else { return self.graph.constant(0.0) };
        self.named_over_leaves_up_to(model.named_before_results);
        self.over_leaves(|l| l.equation_row(equation.form))
    }

    fn named_over_leaves_up_to(&mut self, end: usize) {
        self.over_leaves(|l| l.named_up_to(end));
    }

    /// What an input of a part is: where leaves are wanted one of them, else what it is bound to.
    pub(super) fn held(&mut self, part: PartId, bound: ExprId) -> ExprId {
        let scope = self.over_leaves.scope(part).filter(|_| self.over_leaves.is_on);
        let id = self.formula(bound);
        let Some(scope) = scope else { return id };
        if let Some(&number) = self.over_leaves.leaves.get(&(part, bound)) {
            return self.graph.symbol(leaf(number));
        }
        let over_leaves = with_rates(&mut self.graph, id);
        let plain = self.over_leaves(|l| l.formula(bound));
        let plain = with_rates(&mut self.graph, plain);
        let Some(variations) = &mut self.variations else { return id };
        let number = variations.leaves.len();
        variations.leaves.push(Leaf { scope, over_leaves, plain });
        self.over_leaves.leaves.insert((part, bound), number);
        self.graph.symbol(leaf(number))
    }

    /// A derivative by a variable, of the part that asks for it if that moves together with what is around it; its number is that of a
    /// named symbol.
    pub(super) fn derivative_within(
        &mut self,
        number: usize,
        inner: ExprId,
        variable: u32,
        part: Option<PartId>,
    ) -> ExprId {
        if self.over_leaves.parts.is_empty() {
            let inner = self.formula(inner);
            return self.derivative_by(inner, variable);
        }
        if !self.over_leaves.is_on {
            self.named_over_leaves_up_to(number + 1);
            let over_leaves = self.over_leaves.named[number];
            return match &self.variations {
                Some(variations) => variations.without_leaves(&mut self.graph, over_leaves),
                None => over_leaves,
            };
        }
        let inner = self.formula(inner);
        let scope = part.and_then(|part| self.over_leaves.scope(part));
        let Some(variations) = &mut self.variations else { return self.graph.constant(0.0) };
        let variable = scope.map_or(variable, |scope| variations.within(variable, scope));
        self.derivative_by(inner, variable)
    }

    /// The parts that ask for derivatives in their own texts.
    pub(super) fn asking_parts(&mut self) -> Vec<AskingPart> {
        let model = self.model;
        let mut asking: Vec<PartId> = model.asked_in_parts.iter().map(|asked| asked.part).collect();
        asking.sort_unstable();
        asking.dedup();
        asking.into_iter().map(|part| self.asking_part(part)).collect()
    }

    fn asking_part(&mut self, part: PartId) -> AskingPart {
        let model = self.model;
        let asked = || model.asked_in_parts.iter().filter(|asked| asked.part == part);
        let mut places: Vec<_> = asked().map(|asked| asked.span).collect();
        places.dedup();
        let of_force = asked().find(|asked| asked.is_of_force).map(|asked| asked.span);
        let around = model.parts_around(Some(part));
        let used_at = around.map(|part| (model[part].declared.name.clone(), model[part].declared.span)).collect();
        let (name, columns) =
            (model[part].declared.name.clone(), self.numbering.of_part(model, |to| belongs(model, to, part)));
        let inputs = model[part].inputs.iter().map(|(_, id)| self.formula(*id)).collect();
        AskingPart { name, used_at, places, of_force, columns, inputs, declarations: self.declarations_of(part) }
    }

    /// The joints, constraints and drivers of a part, and of those within it.
    fn declarations_of(&self, part: PartId) -> Vec<DeclarationId> {
        let model = self.model;
        let path = format!("{}.", model[part].declared.name);
        let is_own = |k: &DeclarationId| match model.joints.get(k.index()) {
            Some(joint) => belongs(model, joint.part, part),
            None => self.declarations[*k].name.starts_with(&path),
        };
        self.declarations.ids().filter(is_own).collect()
    }
}

/// A formula with its time derivatives.
fn with_rates(graph: &mut Graph, id: ExprId) -> [ExprId; LEAF_ORDERS] {
    let mut orders = [id; LEAF_ORDERS];
    for order in 1..LEAF_ORDERS {
        orders[order] = ConstraintSystem::time_derivatives(graph, &[orders[order - 1]], 3)[0];
    }
    orders
}
