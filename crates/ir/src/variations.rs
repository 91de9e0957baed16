//! Derivatives with respect to inputs and parameters at fixed time, along the branch: the *variations* (sensitivities) of `q`, `q̇` and `q̈`.
//!
//! With `F₀ = Φ`, `F₁ = Φ̇`, `F₂ = Φ̈` and `D_p` the total derivative with respect to `p`,
//!
//! - `Φ_q q_p = −D_p F₀`, `Φ_q q̇_p = −D_p F₁`, `Φ_q q̈_p = −D_p F₂`, where each right side omits the variation that is solved for;
//! - `Φ_q q_ab = −D_b D_a F₀`, and correspondingly for the second derivatives of `q̇` and `q̈`.
//!
//! All share the matrix of the position equations. Source: E. J. Haug, K. K. Choi, V. Komkov, *Design Sensitivity Analysis of Structural
//! Systems*, 1986, direct differentiation.

use super::{Check, ConstraintSystem};
use crate::limits::MISSES;
use mechc_expr::{Comparison, ExprId, Graph, Symbol, Unary};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;

/// The variables of differentiation and the variations that the requested derivatives need.
#[derive(Clone, Debug, Default)]
pub struct Variations {
    /// Variables of differentiation, by number.
    pub variables: Vec<Variable>,
    /// The variations, each after those that it depends on.
    list: Vec<Variation>,
    numbers: FxHashMap<(u32, Option<u32>), u32>,
    /// Number of variations whose right sides have been derived.
    written: usize,
    /// Columns of derivatives, after all others of the table.
    pub appended: Vec<DerivativeColumn>,
}

/// An input or parameter that derivatives are taken with respect to.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// The symbol in the formulas that varies.
    pub symbol: Symbol,
    /// SI unit: `m`, `1/s`, `rad`, or `1` for a pure number.
    pub unit: String,
    /// Span of its declaration.
    pub span: Span,
}

/// Derivatives of all coordinates with respect to one or two variables.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The first variable, and the second one for a second derivative.
    pub by: (u32, Option<u32>),
    /// Right sides for `q`, `q̇` and `q̈`, one entry per row of the system [unit of the row, per time, per unit of the variables].
    pub rights: [Vec<ExprId>; 3],
    /// Right sides of the equations for the multipliers, one entry per coordinate, if forces are requested; else empty [unit of the
    /// coordinate's force per unit of the variables].
    pub forces: Vec<ExprId>,
    /// True if a formula contains the variation of a multiplier.
    is_of_forces: bool,
}

/// A derivative with a column of its own.
#[derive(Clone, Debug)]
pub struct DerivativeColumn {
    /// Name of the column, such as `crank.x.d.by.turn`.
    pub name: String,
    /// Value in SI.
    pub value: ExprId,
    /// Index of the variable of differentiation.
    pub variable: u32,
    /// Unit of the printed values.
    pub unit: String,
    /// Factors `[a, b, c]` from SI to the printed unit: `value / a * b / c`.
    pub scale: [f64; 3],
}

impl Variations {
    /// Creates an empty list of variations with respect to some variables.
    #[must_use]
    pub fn of(variables: Vec<Variable>) -> Variations {
        Variations { variables, ..Variations::default() }
    }

    /// Returns the total derivatives of formulas with respect to a variable, through the coordinates too.
    ///
    /// The formulas must not contain third time derivatives of coordinates, nor second variations.
    pub fn derivatives(&mut self, graph: &mut Graph, roots: &[ExprId], variable: u32) -> Vec<ExprId> {
        self.along(graph, roots, variable, &|_| false)
    }

    /// The variations that have right sides, by number.
    pub(super) fn listed(&self) -> &[Variation] {
        &self.list[..self.written]
    }

    /// Returns the derivatives as [`Variations::derivatives`] does, with some symbols held constant.
    fn along(
        &mut self,
        graph: &mut Graph,
        roots: &[ExprId],
        variable: u32,
        stays: &dyn Fn(Symbol) -> bool,
    ) -> Vec<ExprId> {
        let varied = self.variables[variable as usize].symbol;
        graph.variations(roots, |graph, symbol| match symbol {
            _ if stays(symbol) => None,
            _ if symbol == varied => Some(graph.constant(1.0)),
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

    /// Returns the number of a variation; adds it if it is new.
    fn number(&mut self, first: u32, second: Option<u32>) -> u32 {
        // the order of the two variables is irrelevant
        let by = match second {
            Some(second) if second < first => (second, Some(first)),
            _ => (first, second),
        };
        if let Some(&number) = self.numbers.get(&by) {
            return number;
        }
        if let (a, Some(b)) = by {
            self.number(a, None);
            self.number(b, None);
        }
        let number = self.list.len() as u32;
        self.list.push(Variation { by, rights: Default::default(), forces: Vec::new(), is_of_forces: false });
        self.numbers.insert(by, number);
        number
    }

    /// Returns the number of a variation and requests the variation of the multipliers.
    fn number_of_forces(&mut self, first: u32, second: Option<u32>) -> u32 {
        let number = self.number(first, second);
        self.list[number as usize].is_of_forces = true;
        number
    }

    /// Returns how many times a formula has been differentiated with respect to variables.
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

    /// Derives the right sides of all variations that have none yet, from the rows of `Φ`.
    fn write_rights(&mut self, graph: &mut Graph, phi: &[ExprId]) {
        let first_open = std::mem::replace(&mut self.written, self.list.len());
        if first_open == self.list.len() {
            return;
        }
        let orders = with_rates(graph, phi);
        let mut first_derivatives: FxHashMap<(u32, usize), Vec<ExprId>> = FxHashMap::default();
        for number in first_open..self.list.len() {
            let (first, second) = self.list[number].by;
            for (order, roots) in orders.iter().enumerate() {
                let top = order as u8;
                let slopes = match second {
                    None => self.along(graph, roots, first, &|symbol| is_coordinate(symbol, top)),
                    Some(second) => {
                        let inner = self.number(first, None);
                        let roots = first_derivatives
                            .entry((first, order))
                            .or_insert_with(|| self.derivatives(graph, roots, first));
                        let roots = std::mem::take(roots);
                        let is_solved_for = |symbol| match symbol {
                            Symbol::Varied { order, variation, .. } => order == top && variation == inner,
                            _ => false,
                        };
                        let slopes = self.along(graph, &roots, second, &is_solved_for);
                        first_derivatives.insert((first, order), roots);
                        slopes
                    }
                };
                self.list[number].rights[order] = slopes.into_iter().map(|slope| graph.neg(slope)).collect();
            }
        }
    }

    /// Derives the right sides of the equations for varied multipliers that are needed and missing.
    fn write_rights_of_forces(&mut self, graph: &mut Graph, open_forces: &[ExprId]) {
        for number in 0..self.list.len() {
            if self.list[number].forces.is_empty() {
                self.list[number].forces = self.rights_of_forces(graph, open_forces, number);
            }
        }
    }

    /// Returns the right sides for varied multipliers: `D_a (p − Φ_qᵀ λ)` without `λ_a`; for second derivatives `D_b` of the whole, without `λ_ab`.
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

    /// Formulas that may contain multipliers: derivative columns, and right sides for varied multipliers.
    pub(super) fn formulas_with_forces(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let columns = self.appended.iter_mut().map(|column| &mut column.value);
        columns.chain(self.list.iter_mut().flat_map(|variation| &mut variation.forces))
    }

    /// Number of variations.
    pub(super) fn count(&self) -> usize {
        self.list.len()
    }
}

impl Variations {
    /// Keeps only the right sides of the given rows.
    fn keep(&mut self, kept: &[usize]) {
        for rights in self.list.iter_mut().flat_map(|variation| &mut variation.rights) {
            *rights = kept.iter().map(|&row| rights[row]).collect();
        }
    }

    /// Returns a copy without derivative columns.
    #[must_use]
    pub fn without_columns(&self) -> Variations {
        Variations { appended: Vec::new(), ..self.clone() }
    }
}

fn is_coordinate(symbol: Symbol, of: u8) -> bool {
    matches!(symbol, Symbol::Coordinate { order, .. } if order == of)
}

/// Returns `[Φ, Φ̇, Φ̈]`, row by row.
fn with_rates(graph: &mut Graph, phi: &[ExprId]) -> [Vec<ExprId>; 3] {
    let first = ConstraintSystem::time_derivatives(graph, phi, 1);
    let second = ConstraintSystem::time_derivatives(graph, &first, 2);
    [phi.to_vec(), first, second]
}

impl ConstraintSystem {
    /// Returns the variations that measures or columns need.
    #[must_use]
    pub fn variations(&self) -> &[Variation] {
        self.variations.as_ref().map_or(&[], |variations| &variations.list)
    }

    /// Returns the columns of derivatives, which follow all others of the table.
    #[must_use]
    pub fn derivative_columns(&self) -> &[DerivativeColumn] {
        self.variations.as_ref().map_or(&[], |variations| &variations.appended)
    }

    /// Returns the name of a varied quantity: `crank.x` gives `crank.x.by.turn`.
    #[must_use]
    pub(crate) fn variation_name(&self, of: &str, variation: u32) -> String {
        let Some(variations) = &self.variations else { return of.to_owned() };
        let (first, second) = variations.list[variation as usize].by;
        let names = std::iter::once(first).chain(second).map(|by| &variations.variables[by as usize].name);
        names.fold(of.to_owned(), |text, name| format!("{text}.by.{name}"))
    }

    /// Derives the right sides of the variations.
    pub(super) fn derive_variations(&mut self) {
        let phi: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        let open_forces = self.open_forces();
        if let Some(variations) = &mut self.variations {
            variations.write_rights(&mut self.graph, &phi);
            variations.write_rights_of_forces(&mut self.graph, &open_forces);
        }
    }

    /// Derives the right sides of the variations that only results need.
    pub(super) fn derive_variations_of_results(&mut self) {
        let phi: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        let open_forces = self.open_forces();
        if let Some(variations) = &mut self.results.variations {
            variations.write_rights(&mut self.graph, &phi);
            variations.write_rights_of_forces(&mut self.graph, &open_forces);
        }
    }

    /// Restricts the variations to the rows that are kept. A variation along which a left-out equation would cease to hold does not exist,
    /// since the mechanism cannot be assembled nearby: its columns and measures become non-finite there.
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
        self.results.variation_conditions = hold.filter_map(|(number, hold)| Some((number as u32, hold?))).collect();
        self.results.variations = Some(variations);
    }

    /// Returns, by variation, the condition that all left-out equations keep holding; `None` if there is nothing to check.
    fn where_checks_hold(&mut self, variations: &mut Variations) -> Vec<Option<ExprId>> {
        let mut hold: Vec<Option<ExprId>> = Vec::new();
        for number in 0..variations.list.len() {
            let (first, second) = variations.list[number].by;
            let mut all = Vec::new();
            for check in 0..self.checks.len() {
                all.push(self.holds_nearby(variations, check, number as u32));
                if second.is_none() {
                    all.push(self.rate_holds_nearby(variations, check, number as u32));
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

    /// Returns the condition that a left-out equation holds near a position: `|D_p Φ| ≤ ε ‖Φ_q‖ Σ |q_p|`, all scaled; analogously for two variables.
    fn holds_nearby(&mut self, variations: &mut Variations, check: usize, number: u32) -> ExprId {
        let Check { phi, scale, .. } = self.checks[check];
        let (first, second) = variations.list[number as usize].by;
        let slope = variations.derivatives(&mut self.graph, &[phi], first)[0];
        let variation_size = self.size(|index| Symbol::Varied { index, order: 0, variation: number });
        let Some(second) = second else {
            return self.is_negligible(slope, scale, variation_size);
        };
        let bend = variations.derivatives(&mut self.graph, &[slope], second)[0];
        let parts = [first, second].map(|by| variations.numbers[&(by, None)]);
        let [a, b] = parts.map(|variation| self.size(|index| Symbol::Varied { index, order: 0, variation }));
        let product = self.graph.mul(a, b);
        let size = self.graph.add(variation_size, product);
        self.is_negligible(bend, scale, size)
    }

    /// Returns the condition for the rate of a left-out equation, which rejects coincidental zeros of `D_p Φ`: `|D_p Φ̇| ≤ ε ‖Φ_q‖ (Σ |q̇_p| + Σ |q_p| Σ |q̇|)`.
    fn rate_holds_nearby(&mut self, variations: &mut Variations, check: usize, variation: u32) -> ExprId {
        let Check { phi, scale, .. } = self.checks[check];
        let (by, _) = variations.list[variation as usize].by;
        let rate = ConstraintSystem::time_derivatives(&mut self.graph, &[phi], 1)[0];
        let slope = variations.derivatives(&mut self.graph, &[rate], by)[0];
        let [position, speed] = [0, 1].map(|order| self.size(|index| Symbol::Varied { index, order, variation }));
        let motion = self.size(|index| Symbol::Coordinate { index, order: 1 });
        let turned = self.graph.mul(position, motion);
        let size = self.graph.add(speed, turned);
        self.is_negligible(slope, scale, size)
    }

    /// Returns `Σ |x| / s` over all coordinates, where `s` is the scale of each.
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

    fn is_negligible(&mut self, off: ExprId, scale: f64, size: ExprId) -> ExprId {
        let graph = &mut self.graph;
        let part = graph.constant(MISSES * scale);
        let (off, limit) = (graph.unary(Unary::Abs, off), graph.mul(part, size));
        graph.compare(Comparison::LessEqual, off, limit)
    }
}

/// Returns a formula that equals `id` where the conditions of its variations hold, and is not finite elsewhere.
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
