//! Forces that are not determined because equations are left out.
//!
//! If rows of `Φ_q` depend on each other, `Φ_qᵀ λ = p` also holds for `λ + w`, with `w` any left null vector of all rows, including those
//! that are left out. A force is determined if no such vector changes it. Single positions mislead: with cranks in line or upright a
//! dependency weighs nothing in equations that it holds elsewhere. So the motion is followed, and a force that is open anywhere is open.

use super::evaluator::Evaluator;
use super::orthonormal::Basis;
use super::redundancy::basis_of;
use crate::analysis::state::{Horizon, Linear, aslant};
use crate::limits::assembly::LARGEST_STEP;
use crate::limits::redundancy::{LARGEST_OPENING, NO_SHARE};
use crate::limits::step_control::FEWEST_STEPS;
use mechc_expr::{Dependence, ExprId, Graph, Node, Symbol};
use mechc_ir::ConstraintSystem;
use mechc_ir::limits::DEFAULT_SPAN;
use mechc_ir::structure::Subsystem;
use rustc_hash::FxHashSet;

/// First step along the motion, as a part of the span.
const FIRST_STEP: f64 = 1e-3;
/// Largest deviation of the end of a step from its prediction, scaled; beyond it the step is on another branch.
const APART: f64 = 0.1;
/// Distance between the examined positions, scaled.
const FRESH: f64 = 0.03;
/// Maximum number of steps: enough for the whole motion of something that turns once or twice.
const MOST_STEPS: usize = 200;
/// Maximum work of all steps, as rows times the square of coordinates: about a second.
const MOST_WORK: usize = 1_000_000_000;

/// A formula whose forces are not determined, with the rows that share what they exert in any way.
#[derive(Clone, Debug)]
pub struct Shared {
    pub formula: ExprId,
    pub rows: Vec<usize>,
}

/// Returns the formulas that hold undetermined forces, in order. `part` holds all rows that depend on each other, `surplus` of them
/// redundant. The motion begins from the estimates, or from `start` [m, rad].
pub fn shared(
    system: &ConstraintSystem,
    part: &Subsystem,
    surplus: usize,
    horizon: Horizon,
    start: Option<&[f64]>,
    formulas: impl Iterator<Item = ExprId>,
) -> Vec<Shared> {
    let graph = system.graph();
    let is_of_part =
        |id: &ExprId| graph.symbols(*id).iter().filter_map(multiplier).any(|row| part.rows.binary_search(&row).is_ok());
    let mut queried: Vec<ExprId> = formulas.filter(is_of_part).collect();
    queried.sort_unstable();
    queried.dedup();
    if queried.is_empty() {
        return Vec::new();
    }
    let mut open: Vec<Open> = queried.into_iter().map(|formula| Open::new(graph, formula)).collect();
    let mut evaluator = Evaluator::new(system);
    if let Some(start) = start {
        evaluator.q.copy_from_slice(start);
    }
    let places = along_motion(&mut evaluator, part, horizon, |evaluator, linear, t| {
        let basis = basis_of(&linear.jacobian, part.columns.len());
        // a singular position frees what is determined near it
        let is_generic = basis.dependent.len() == surplus;
        if is_generic {
            let dependencies = dependencies(&basis, part, linear, system.rows().len());
            let place = Place { evaluator, t, dependencies: &dependencies };
            open.iter_mut().filter(|open| open.rows.is_none()).for_each(|open| open.rows = place.sharing(&open.forms));
        }
        is_generic
    });
    let all = || part.rows.iter().map(|&row| row as usize).collect();
    let shared = |open: Open| {
        let rows = if places == 0 { Some(all()) } else { open.rows };
        rows.map(|rows| Shared { formula: open.formula, rows })
    };
    open.into_iter().filter_map(shared).collect()
}

/// A formula that is determined in all positions so far.
struct Open {
    formula: ExprId,
    forms: Vec<Form>,
    /// Rows that share it, once it is not determined.
    rows: Option<Vec<usize>>,
}

/// A part of a formula that is linear in forces.
struct Form {
    /// Its terms, each with its sign.
    terms: Vec<(ExprId, f64)>,
    rows: Vec<u32>,
    /// True if it holds derivatives of forces with respect to anything but time, so that each force has to be determined by itself.
    is_varied: bool,
}

impl Open {
    fn new(graph: &Graph, formula: ExprId) -> Open {
        let (mut forms, mut visited, mut left) = (Vec::new(), FxHashSet::default(), vec![formula]);
        while let Some(root) = left.pop() {
            if !holds_forces(graph, root) || !visited.insert(root) {
                continue;
            }
            let linear = linear_terms(graph, root, &mut left);
            if !linear.is_empty() {
                let terms: Vec<ExprId> = linear.iter().map(|&(term, _)| term).collect();
                let symbols = graph.symbols_of_all(&terms);
                let rows = symbols.iter().filter_map(multiplier).collect();
                let is_varied = symbols.iter().any(|symbol| matches!(symbol, Symbol::VariedMultiplier { .. }));
                forms.push(Form { terms: linear, rows, is_varied });
            }
        }
        Open { formula, forms, rows: None }
    }
}

/// Returns the terms of a sum that are linear in forces, each with its sign. The operands of other terms are added to `left`, the formulas
/// still to be examined.
fn linear_terms(graph: &Graph, sum: ExprId, left: &mut Vec<ExprId>) -> Vec<(ExprId, f64)> {
    let (mut linear, mut open, mut linear_terms) = (Vec::new(), vec![(sum, 1.0)], FxHashSet::default());
    while let Some((term, sign)) = open.pop() {
        if !holds_forces(graph, term) {
            continue;
        }
        if is_linear(graph, term, &mut linear_terms) {
            linear.push((term, sign));
            continue;
        }
        match graph.node(term) {
            Node::Add(a, b) => open.extend([(a, sign), (b, sign)]),
            Node::Sub(a, b) => open.extend([(a, sign), (b, -sign)]),
            Node::Neg(a) => open.push((a, -sign)),
            node => left.extend_from_slice(node.children().as_slice()),
        }
    }
    linear
}

fn holds_forces(graph: &Graph, id: ExprId) -> bool {
    graph.dependence(id).on(Dependence::FORCES)
}

fn multiplier(symbol: &Symbol) -> Option<u32> {
    match *symbol {
        Symbol::Multiplier(row) | Symbol::VariedMultiplier { row, .. } => Some(row),
        _ => None,
    }
}

/// Returns whether a formula that holds forces is linear in them; `linear_terms` caches formulas that are.
fn is_linear(graph: &Graph, id: ExprId, linear_terms: &mut FxHashSet<ExprId>) -> bool {
    if linear_terms.contains(&id) {
        return true;
    }
    let mut is_free_or_linear = |id: ExprId| !holds_forces(graph, id) || is_linear(graph, id, linear_terms);
    let is_linear = match graph.node(id) {
        Node::Symbol(_) => true,
        Node::Neg(a) => is_free_or_linear(a),
        Node::Add(a, b) | Node::Sub(a, b) => is_free_or_linear(a) && is_free_or_linear(b),
        Node::Mul(a, b) => {
            (!holds_forces(graph, a) || !holds_forces(graph, b)) && is_free_or_linear(a) && is_free_or_linear(b)
        }
        Node::Div(a, b) => !holds_forces(graph, b) && is_free_or_linear(a),
        _ => false,
    };
    if is_linear {
        linear_terms.insert(id);
    }
    is_linear
}

/// A left null vector of all rows, by row of the system.
struct Dependency {
    /// Scaled, of unit length.
    scaled: Vec<f64>,
    /// Divisors of the scaled rows.
    weights: Vec<f64>,
}

fn dependencies(basis: &Basis, part: &Subsystem, linear: &Linear, rows: usize) -> Vec<Dependency> {
    let vector = |(row, on): &(usize, Vec<(usize, f64)>)| {
        let (mut scaled, mut weights) = (vec![0.0; rows], vec![1.0; rows]);
        let shares = on.iter().map(|&(k, weight)| (k, -weight)).chain([(*row, 1.0)]);
        let norm = on.iter().map(|(_, weight)| weight * weight).sum::<f64>() + 1.0;
        for (k, weight) in shares {
            let row = part.rows[k] as usize;
            (scaled[row], weights[row]) = (weight / norm.sqrt(), linear.weights[k]);
        }
        Dependency { scaled, weights }
    };
    basis.dependent.iter().map(vector).collect()
}

/// A position of the motion with all dependencies there.
struct Place<'p, 's> {
    evaluator: &'p Evaluator<'s>,
    t: f64,
    dependencies: &'p [Dependency],
}

impl Place<'_, '_> {
    /// Returns the rows that share a force in one of some forms; `None` if all are determined.
    fn sharing(&self, forms: &[Form]) -> Option<Vec<usize>> {
        let (_, dependency) = forms
            .iter()
            .flat_map(|form| self.dependencies.iter().map(move |dependency| (form, dependency)))
            .find(|(form, dependency)| self.changes(form, dependency))?;
        let takes_part = |row: &usize| dependency.scaled[*row].abs() > NO_SHARE;
        Some((0..dependency.scaled.len()).filter(takes_part).collect())
    }

    /// Returns whether a form changes with a dependency.
    fn changes(&self, form: &Form, dependency: &Dependency) -> bool {
        let weight = |row: u32| dependency.scaled[row as usize];
        if form.is_varied || form.rows.len() == 1 {
            return form.rows.iter().any(|&row| weight(row).abs() > NO_SHARE);
        }
        if form.rows.iter().all(|&row| weight(row).abs() <= NO_SHARE) {
            return false;
        }
        let nothing = self.value(form, None);
        // by scaled multipliers
        let slopes: Vec<f64> = form
            .rows
            .iter()
            .map(|&row| (self.value(form, Some(row)) - nothing) / dependency.weights[row as usize])
            .collect();
        let largest = slopes.iter().fold(0.0, |largest: f64, slope| largest.max(slope.abs()));
        let change: f64 = form.rows.iter().zip(&slopes).map(|(&row, slope)| weight(row) * slope).sum();
        change.abs() > NO_SHARE * largest
    }

    /// Returns the value of a form where one multiplier is 1 and the others vanish.
    fn value(&self, form: &Form, row: Option<u32>) -> f64 {
        form.terms.iter().map(|&(term, sign)| sign * self.value_of_term(term, row)).sum()
    }

    fn value_of_term(&self, term: ExprId, row: Option<u32>) -> f64 {
        let system = self.evaluator.system;
        system.graph().value(term, |symbol| match symbol {
            Symbol::Param(k) => system.params()[k as usize].value,
            Symbol::Time => self.t,
            Symbol::Coordinate { index, order: 0 } => self.evaluator.q[index as usize],
            // the speed does not matter: any value will do
            Symbol::Coordinate { index, .. } | Symbol::Varied { index, .. } => aslant(index as usize),
            Symbol::Multiplier(index) => f64::from(u8::from(row == Some(index))),
            Symbol::Shift(_) | Symbol::VariedMultiplier { .. } => 0.0,
            Symbol::Signal { .. } | Symbol::Named(_) => 1.0,
        })
    }
}

/// Follows the motion from its start on by least squares, which dead points and change points do not stop, and calls `look` at positions
/// that are apart; returns how often that returned true.
pub(super) fn along_motion(
    evaluator: &mut Evaluator<'_>,
    part: &Subsystem,
    Horizon { from, span }: Horizon,
    mut look: impl FnMut(&Evaluator<'_>, &Linear, f64) -> bool,
) -> usize {
    let system = evaluator.system;
    let scale = |column: u32| system.coordinates()[column as usize].scale;
    let moved = |a: &[f64], b: &[f64]| {
        let moved = part.columns.iter().map(|&k| (a[k as usize] - b[k as usize]).abs() / scale(k));
        moved.fold(0.0, f64::max)
    };
    let assembled = |evaluator: &mut Evaluator<'_>, t: f64| {
        let met = evaluator.assemble(&part.rows, &part.columns, None, t)?;
        let is_met = met.residual.iter().all(|open| open.abs() <= LARGEST_OPENING.sqrt());
        let there = evaluator.linear(&part.rows, &part.columns, None, t);
        there.filter(|_| is_met)
    };
    let span = if span > 0.0 { span } else { DEFAULT_SPAN };
    let Some(start) = assembled(evaluator, from) else {
        return 0;
    };
    let mut found = usize::from(look(evaluator, &start, from));
    let (mut looked_at, mut before, mut h) = (evaluator.q.clone(), (from, evaluator.q.clone()), FIRST_STEP * span);
    let (mut t, mut speed) = (from, vec![0.0; evaluator.q.len()]);
    let work = part.rows.len() * part.columns.len() * part.columns.len();
    for _ in 0..usize::min(MOST_STEPS, MOST_WORK / work.max(1)) {
        let next = f64::min(t + h, from + span);
        if next <= t {
            break;
        }
        for &k in &part.columns {
            evaluator.q[k as usize] += (next - t) * speed[k as usize];
        }
        let predicted = evaluator.q.clone();
        let linear = assembled(evaluator, next);
        let is_near = moved(&evaluator.q, &predicted) < APART && moved(&evaluator.q, &before.1) < LARGEST_STEP;
        let Some(linear) = linear.filter(|_| is_near) else {
            evaluator.q.copy_from_slice(&before.1);
            h *= 0.5;
            continue;
        };
        for (speed, (now, before)) in speed.iter_mut().zip(evaluator.q.iter().zip(&before.1)) {
            *speed = (now - before) / (next - t);
        }
        (t, h) = (next, f64::min(1.5 * h, span / FEWEST_STEPS));
        before = (t, evaluator.q.clone());
        if found == 0 || moved(&evaluator.q, &looked_at) > FRESH {
            found += usize::from(look(evaluator, &linear, t));
            looked_at.copy_from_slice(&evaluator.q);
        }
    }
    found
}
