//! Derivatives by inputs and parameters, at fixed time and along the branch: the *variations* of `q`, `q̇` and `q̈`.
//!
//! With `F₀ = Φ`, `F₁ = Φ̇`, `F₂ = Φ̈` and `D_p` the derivative by `p` through all that depends on it,
//!
//! - `Φ_q q_p = −D_p F₀`, `Φ_q q̇_p = −D_p F₁`, `Φ_q q̈_p = −D_p F₂`, each right side without the variation that is solved for;
//! - `Φ_q q_ab = −D_b D_a F₀`, and so on, likewise.
//!
//! All have the matrix of the position. Source: E. J. Haug, K. K. Choi, V. Komkov, *Design Sensitivity Analysis of Structural
//! Systems*, 1986, by direct differentiation.

use super::scopes::{Leaf, Scope, as_leaf, without_leaves};
use super::{Check, ConstraintSystem};
use crate::tolerances::checks::MISSES;
use mechc_expr::{Comparison, ExprId, Graph, Symbol, Unary};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// What derivatives are taken by, and the variations that this needs.
#[derive(Clone, Debug, Default)]
pub struct Variations {
    /// What derivatives may be taken by, by its number.
    pub variables: Vec<Variable>,
    /// Each behind those that it needs.
    list: Vec<Variation>,
    numbers: FxHashMap<(u32, Option<u32>), u32>,
    /// So many have their right sides.
    written: usize,
    /// Parts whose own equations derivatives are taken by, and what these hold.
    pub scopes: Vec<Scope>,
    /// Inputs of these parts, by the number of their leaf.
    pub leaves: Vec<Leaf>,
    /// Columns of derivatives, behind all others of the table.
    pub appended: Vec<Appended>,
}

/// An input or parameter.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// What of the formulas changes.
    pub symbol: Symbol,
    /// Its SI unit: `m`, `1/s`, `rad`, or `1` for a pure number.
    pub unit: String,
    /// The place of its declaration.
    pub span: Span,
    /// The part whose equations alone it is by, by its number among the scopes.
    pub scope: Option<u32>,
}

/// How all coordinates, or those of a part, change by one variable, or by two.
#[derive(Clone, Debug)]
pub struct Variation {
    /// By what, and by what again.
    pub by: (u32, Option<u32>),
    /// The part whose equations alone it follows, by its number among the scopes: that of the first variable.
    pub scope: Option<u32>,
    /// The right sides for `q`, `q̇` and `q̈`, one entry per row, of the part if it is of one [unit of the row, per time, per unit of the
    /// variables].
    pub rights: [Vec<ExprId>; 3],
    /// The right sides of the equations for the multipliers, one entry per coordinate, where somebody asks for these [unit of the
    /// coordinate's force per unit of the variables].
    pub forces: Vec<ExprId>,
    /// Whether a formula holds how multipliers change by it.
    is_of_forces: bool,
}

/// A derivative that is a column of its own.
#[derive(Clone, Debug)]
pub struct Appended {
    /// The name of the column: `crank.x.d.by.turn`.
    pub name: String,
    /// Its value in SI.
    pub value: ExprId,
    /// By which variable.
    pub variable: u32,
    /// The unit that it is printed in.
    pub unit: String,
    /// What SI is divided by, multiplied with and divided by to be in this unit.
    pub scale: [f64; 3],
}

impl Variations {
    /// None yet, by some variables.
    #[must_use]
    pub fn of(variables: Vec<Variable>) -> Variations {
        Variations { variables, ..Variations::default() }
    }

    /// The derivatives of formulas by a variable, through the coordinates too.
    ///
    /// The formulas hold no third derivative of a coordinate, and nothing that has been differentiated by two variables.
    pub fn derivatives(&mut self, graph: &mut Graph, roots: &[ExprId], variable: u32) -> Vec<ExprId> {
        self.along(graph, roots, variable, &|_| false)
    }

    /// A formula with what leaves are bound to in their places.
    pub fn without_leaves(&self, graph: &mut Graph, root: ExprId) -> ExprId {
        without_leaves(graph, &self.leaves, &[root])[0]
    }

    /// The number of a variable within a part whose equations alone it is by.
    pub fn within(&mut self, variable: u32, scope: u32) -> u32 {
        let of = self.variables[variable as usize].clone();
        let is_it = |known: &Variable| known.symbol == of.symbol && known.scope == Some(scope);
        let known = self.variables.iter().position(is_it);
        known.unwrap_or_else(|| {
            self.variables.push(Variable { scope: Some(scope), ..of });
            self.variables.len() - 1
        }) as u32
    }

    /// Those that have their right sides, by their numbers.
    pub(super) fn listed(&self) -> &[Variation] {
        &self.list[..self.written]
    }

    fn scope_of(&self, variable: u32) -> Option<u32> {
        self.variables[variable as usize].scope
    }

    /// The same, as if some symbols did not change.
    fn along(
        &mut self,
        graph: &mut Graph,
        roots: &[ExprId],
        variable: u32,
        stays: &dyn Fn(Symbol) -> bool,
    ) -> Vec<ExprId> {
        let own = self.variables[variable as usize].symbol;
        let scope = self.scope_of(variable);
        graph.variations(roots, |graph, symbol| match symbol {
            _ if stays(symbol) => None,
            _ if symbol == own => Some(graph.constant(1.0)),
            Symbol::Coordinate { index, .. }
                if scope.is_some_and(|scope| !self.scopes[scope as usize].varies(index)) =>
            {
                None
            }
            Symbol::Signal { .. } => {
                let (number, order) = as_leaf(symbol)?;
                let leaf = &self.leaves[number];
                let is_held = scope == Some(leaf.scope);
                let bound = leaf.over_leaves[order];
                (!is_held).then(|| self.along(graph, &[bound], variable, &|_| false)[0])
            }
            Symbol::Coordinate { index, order } => {
                let variation = self.number(variable, None);
                Some(graph.symbol(Symbol::Varied { index, order, variation }))
            }
            Symbol::Varied { index, order, variation } => {
                let (first, _) = self.list[variation as usize].by;
                let variation = self.number(first, Some(variable));
                Some(graph.symbol(Symbol::Varied { index, order, variation }))
            }
            Symbol::Multiplier(row) => {
                let variation = self.number_of_forces(variable, None);
                Some(graph.symbol(Symbol::VariedMultiplier { row, variation }))
            }
            Symbol::VariedMultiplier { row, variation } => {
                let (first, _) = self.list[variation as usize].by;
                let variation = self.number_of_forces(first, Some(variable));
                Some(graph.symbol(Symbol::VariedMultiplier { row, variation }))
            }
            _ => None,
        })
    }

    /// The number of a variation, which is asked for.
    fn number(&mut self, first: u32, second: Option<u32>) -> u32 {
        // by one set of equations it means nothing which comes first
        let by = match second {
            Some(second) if second < first && self.scope_of(first) == self.scope_of(second) => (second, Some(first)),
            _ => (first, second),
        };
        if let Some(&known) = self.numbers.get(&by) {
            return known;
        }
        if let (a, Some(b)) = by {
            self.number(a, None);
            self.number(b, None);
        }
        let number = self.list.len() as u32;
        self.list.push(Variation {
            by,
            scope: self.scope_of(by.0),
            rights: Default::default(),
            forces: Vec::new(),
            is_of_forces: false,
        });
        self.numbers.insert(by, number);
        number
    }

    /// The number of a variation of which it is asked how it changes multipliers.
    fn number_of_forces(&mut self, first: u32, second: Option<u32>) -> u32 {
        let number = self.number(first, second);
        self.list[number as usize].is_of_forces = true;
        number
    }

    /// How many times a formula is differentiated by variables already.
    #[must_use]
    pub fn times(&self, graph: &Graph, formula: ExprId) -> usize {
        if !graph.dependence(formula).is_varied() {
            return 0;
        }
        let times = |symbol| match symbol {
            Symbol::Varied { variation, .. } | Symbol::VariedMultiplier { variation, .. } => {
                1 + usize::from(self.list[variation as usize].by.1.is_some())
            }
            _ => 0,
        };
        graph.symbols(formula).into_iter().map(times).max().unwrap_or(0)
    }

    /// The right sides of all variations that have none yet, for rows of `Φ`.
    fn write_rights(&mut self, graph: &mut Graph, phi: &[ExprId]) {
        for scope in &mut self.scopes {
            scope.derive(graph, &self.leaves);
        }
        let first_open = std::mem::replace(&mut self.written, self.list.len());
        if first_open == self.list.len() {
            return;
        }
        let of_whole = with_rates(graph, phi);
        let of_scopes: Vec<[Vec<ExprId>; 3]> = self.scopes.iter().map(|scope| with_rates(graph, &scope.phi)).collect();
        let mut whole: FxHashMap<(u32, usize), Vec<ExprId>> = FxHashMap::default();
        for number in first_open..self.list.len() {
            let (first, second) = self.list[number].by;
            let orders = self.list[number].scope.map_or(&of_whole, |scope| &of_scopes[scope as usize]);
            for (order, roots) in orders.iter().enumerate() {
                let top = order as u8;
                let slopes = match second {
                    None => self.along(graph, roots, first, &|symbol| is_coordinate(symbol, top)),
                    Some(second) => {
                        let inner = self.number(first, None);
                        let roots =
                            whole.entry((first, order)).or_insert_with(|| self.derivatives(graph, roots, first));
                        let roots = std::mem::take(roots);
                        let is_solved_for = |symbol| match symbol {
                            Symbol::Varied { order, variation, .. } => order == top && variation == inner,
                            _ => false,
                        };
                        let slopes = self.along(graph, &roots, second, &is_solved_for);
                        whole.insert((first, order), roots);
                        slopes
                    }
                };
                let slopes = without_leaves(graph, &self.leaves, &slopes);
                self.list[number].rights[order] = slopes.into_iter().map(|slope| graph.neg(slope)).collect();
            }
        }
    }

    /// The right sides of the equations for how multipliers change, as far as somebody asks for that and they are not there yet.
    fn write_rights_of_forces(&mut self, graph: &mut Graph, open_forces: &[ExprId]) {
        for number in 0..self.list.len() {
            if self.list[number].scope.is_none() && self.list[number].forces.is_empty() {
                self.list[number].forces = self.rights_of_forces(graph, open_forces, number);
            }
        }
    }

    /// The right sides of the equations for how multipliers change: `D_a (p − Φ_qᵀ λ)` without `λ_a`, and by two `D_b` of all that,
    /// without `λ_ab`.
    fn rights_of_forces(&mut self, graph: &mut Graph, open_forces: &[ExprId], number: usize) -> Vec<ExprId> {
        match self.list[number].by {
            (first, None) => self.along(graph, open_forces, first, &|symbol| matches!(symbol, Symbol::Multiplier(_))),
            (first, Some(second)) if self.list[number].is_of_forces => {
                let inner = self.number_of_forces(first, None);
                let once = self.derivatives(graph, open_forces, first);
                let is_solved_for =
                    |symbol| matches!(symbol, Symbol::VariedMultiplier { variation, .. } if variation == inner);
                self.along(graph, &once, second, &is_solved_for)
            }
            (_, Some(_)) => Vec::new(),
        }
    }

    /// Formulas that may hold multipliers: of columns, and of the equations for how multipliers change.
    pub(super) fn formulas_with_forces(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let columns = self.appended.iter_mut().map(|column| &mut column.value);
        columns.chain(self.list.iter_mut().flat_map(|variation| &mut variation.forces))
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.list.len()
    }
}

impl Variations {
    /// Only the right sides of some rows are left.
    fn keep(&mut self, kept: &[usize]) {
        let of_whole = self.list.iter_mut().filter(|variation| variation.scope.is_none());
        for rights in of_whole.flat_map(|variation| &mut variation.rights) {
            *rights = kept.iter().map(|&row| rights[row]).collect();
        }
    }

    /// The same without columns of their own.
    #[must_use]
    pub fn without_columns(&self) -> Variations {
        Variations { appended: Vec::new(), ..self.clone() }
    }
}

fn is_coordinate(symbol: Symbol, of: u8) -> bool {
    matches!(symbol, Symbol::Coordinate { order, .. } if order == of)
}

/// Rows of `Φ`, their first and their second time derivatives.
fn with_rates(graph: &mut Graph, phi: &[ExprId]) -> [Vec<ExprId>; 3] {
    let first = ConstraintSystem::time_derivatives(graph, phi, 1);
    let second = ConstraintSystem::time_derivatives(graph, &first, 2);
    [phi.to_vec(), first, second]
}

impl ConstraintSystem {
    /// The variations that measures or columns need.
    #[must_use]
    pub fn variations(&self) -> &[Variation] {
        self.variations.as_ref().map_or(&[], |variations| &variations.list)
    }

    /// The parts by whose own equations there are variations.
    #[must_use]
    pub fn scopes(&self) -> &[Scope] {
        self.variations.as_ref().map_or(&[], |variations| &variations.scopes)
    }

    /// Columns of derivatives, behind all others of the table.
    #[must_use]
    pub fn appended(&self) -> &[Appended] {
        self.variations.as_ref().map_or(&[], |variations| &variations.appended)
    }

    /// What a variation of a column is called: `crank.x.by.turn`.
    #[must_use]
    pub fn variation_name(&self, of: &str, variation: u32) -> String {
        let Some(variations) = &self.variations else { return of.to_owned() };
        let (first, second) = variations.list[variation as usize].by;
        let names = std::iter::once(first).chain(second).map(|by| &variations.variables[by as usize].name);
        names.fold(of.to_owned(), |text, name| format!("{text}.by.{name}"))
    }

    /// The right sides of the variations.
    pub(super) fn derive_variations(&mut self) {
        let phi: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        let open_forces = self.open_forces();
        if let Some(variations) = &mut self.variations {
            variations.write_rights(&mut self.graph, &phi);
            variations.write_rights_of_forces(&mut self.graph, &open_forces);
        }
    }

    /// The right sides of the variations that only results need.
    pub(super) fn derive_variations_of_results(&mut self) {
        let phi: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        let open_forces = self.open_forces();
        if let Some(variations) = &mut self.results.variations {
            variations.write_rights(&mut self.graph, &phi);
            variations.write_rights_of_forces(&mut self.graph, &open_forces);
        }
    }

    /// Only some rows are left. What is varied in a way in which an equation that was left out would cease to hold has no derivative: the
    /// mechanism cannot be assembled beside where it is.
    pub(super) fn leave_out_of_variations(&mut self, kept: &[usize]) {
        self.leave_out_of_variations_of_results(kept);
        let Some(mut variations) = self.variations.take() else { return };
        variations.keep(kept);
        let hold = self.where_checks_hold(&mut variations);
        for column in &mut variations.appended {
            column.value = only_where(&mut self.graph, &hold, column.value);
        }
        for measure in &mut self.measures {
            measure.value = only_where(&mut self.graph, &hold, measure.value);
            for derivative in [&mut measure.first, &mut measure.second] {
                *derivative = derivative.map(|id| only_where(&mut self.graph, &hold, id));
            }
        }
        self.variations = Some(variations);
    }

    fn leave_out_of_variations_of_results(&mut self, kept: &[usize]) {
        let Some(mut variations) = self.results.variations.take() else { return };
        variations.keep(kept);
        let hold = self.where_checks_hold(&mut variations).into_iter().enumerate();
        self.results.varied_where = hold.filter_map(|(number, hold)| Some((number as u32, hold?))).collect();
        self.results.variations = Some(variations);
    }

    /// By variation: whether all equations that were left out go on to hold.
    fn where_checks_hold(&mut self, variations: &mut Variations) -> Vec<Option<ExprId>> {
        let mut hold: Vec<Option<ExprId>> = Vec::new();
        for number in 0..variations.list.len() {
            let (first, second) = variations.list[number].by;
            let mut all = Vec::new();
            for check in 0..self.checks.len() {
                all.push(self.goes_on_to_hold(variations, check, number as u32));
                if second.is_none() {
                    all.push(self.goes_on_to_hold_for_a_while(variations, check, number as u32));
                }
            }
            if let Some(second) = second {
                let parts = [first, second].map(|by| variations.numbers[&(by, None)] as usize);
                all.extend(parts.into_iter().filter_map(|part| hold[part]));
            }
            hold.push(all.into_iter().reduce(|a, b| self.graph.and(a, b)));
        }
        hold
    }

    /// Whether an equation that was left out holds beside a position: `|D_p Φ| ≤ ε ‖Φ_q‖ Σ |q_p|`, all scaled, and likewise by two.
    fn goes_on_to_hold(&mut self, variations: &mut Variations, check: usize, number: u32) -> ExprId {
        let Check { phi, scale, .. } = self.checks[check];
        let (first, second) = variations.list[number as usize].by;
        let slope = variations.derivatives(&mut self.graph, &[phi], first)[0];
        let own = self.size(|index| Symbol::Varied { index, order: 0, variation: number });
        let Some(second) = second else {
            return self.is_next_to_nothing(slope, scale, own);
        };
        let bend = variations.derivatives(&mut self.graph, &[slope], second)[0];
        let parts = [first, second].map(|by| variations.numbers[&(by, None)]);
        let [a, b] = parts.map(|variation| self.size(|index| Symbol::Varied { index, order: 0, variation }));
        let product = self.graph.mul(a, b);
        let size = self.graph.add(own, product);
        self.is_next_to_nothing(bend, scale, size)
    }

    /// The same of its time derivative, so that it does not hold by chance: `|D_p Φ̇| ≤ ε ‖Φ_q‖ (Σ |q̇_p| + Σ |q_p| Σ |q̇|)`.
    fn goes_on_to_hold_for_a_while(&mut self, variations: &mut Variations, check: usize, variation: u32) -> ExprId {
        let Check { phi, scale, .. } = self.checks[check];
        let (by, _) = variations.list[variation as usize].by;
        let rate = ConstraintSystem::time_derivatives(&mut self.graph, &[phi], 1)[0];
        let slope = variations.derivatives(&mut self.graph, &[rate], by)[0];
        let [place, speed] = [0, 1].map(|order| self.size(|index| Symbol::Varied { index, order, variation }));
        let motion = self.size(|index| Symbol::Coordinate { index, order: 1 });
        let turned = self.graph.mul(place, motion);
        let size = self.graph.add(speed, turned);
        self.is_next_to_nothing(slope, scale, size)
    }

    /// `Σ |x| / s` over all coordinates, s being what a change of each is judged against.
    fn size(&mut self, symbol: impl Fn(u32) -> Symbol) -> ExprId {
        let graph = &mut self.graph;
        let zero = graph.constant(0.0);
        self.coordinates.iter().enumerate().fold(zero, |all, (index, coordinate)| {
            let (x, scale) = (graph.symbol(symbol(index as u32)), graph.constant(coordinate.scale));
            let size = graph.unary(Unary::Abs, x);
            let scaled = graph.div(size, scale);
            graph.add(all, scaled)
        })
    }

    fn is_next_to_nothing(&mut self, off: ExprId, scale: f64, size: ExprId) -> ExprId {
        let graph = &mut self.graph;
        let part = graph.constant(MISSES * scale);
        let (off, limit) = (graph.unary(Unary::Abs, off), graph.mul(part, size));
        graph.compare(Comparison::LessEqual, off, limit)
    }
}

/// A formula where all holds that its variations need, elsewhere nothing finite.
fn only_where(graph: &mut Graph, hold: &[Option<ExprId>], id: ExprId) -> ExprId {
    if !graph.dependence(id).is_varied() {
        return id;
    }
    let mut needed: Vec<u32> = graph
        .symbols(id)
        .into_iter()
        .filter_map(|symbol| match symbol {
            Symbol::Varied { variation, .. } | Symbol::VariedMultiplier { variation, .. } => Some(variation),
            _ => None,
        })
        .collect();
    needed.sort_unstable();
    needed.dedup();
    let holds = needed.into_iter().filter_map(|variation| hold[variation as usize]).reduce(|a, b| graph.and(a, b));
    let Some(holds) = holds else { return id };
    let (one, zero) = (graph.constant(1.0), graph.constant(0.0));
    let none = graph.div(one, zero);
    graph.select(holds, id, none)
}
