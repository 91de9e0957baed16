//! Estimates for the arguments of contacts whose curves give none: the best of a search over one turn.
//!
//! The search uses the values of parameters. Its result is an estimate, which does not enter the equations.

use mechc_expr::{ExprId, Graph, Node, Symbol};
use mechc_ir::{ConstraintSystem, OpenContact};
use std::f64::consts::PI;

/// Samples of one argument over one turn.
const PLACES: usize = 720;
/// Samples of each of two arguments over one turn.
const PLACES_OF_TWO: usize = 120;
/// Number of the best samples that are refined.
const CANDIDATES: usize = 8;
/// Accuracy of a refined estimate.
const REFINED: f64 = 1e-7;
/// Maximum number of descent steps.
const MOST_STEPS: usize = 1000;
/// Mismatches that differ by less than this part of the largest are equal.
const SAME: f64 = 1e-12;

/// The sum of squares of a joint's rows as a function of its arguments, with all other coordinates at their estimates.
struct Mismatch<'l> {
    graph: &'l Graph,
    rows: &'l [ExprId],
    /// Formulas that must be positive for the curves to have a point.
    conditions: &'l [ExprId],
    /// The coordinates of the arguments.
    arguments: &'l [u32],
    /// The nodes that depend on the last argument; `outer` are those that depend on other arguments only.
    inner: Vec<ExprId>,
    outer: Vec<ExprId>,
    /// The values of the graph's nodes with all coordinates at their estimates.
    values: &'l mut [f64],
}

/// Sets the estimates of open contacts' arguments: for each joint to the minimum of the sum of squares of its rows in the declared poses,
/// over one turn (−π to π), where the conditions of its curves hold.
pub fn complete(system: &mut ConstraintSystem) {
    if system.open_contacts().is_empty() {
        return;
    }
    let mut values = values_as_drawn(system);
    for OpenContact { declaration, arguments, conditions } in system.take_open_contacts() {
        let rows = system.rows().iter().filter(|row| row.declaration == declaration);
        let rows: Vec<ExprId> = rows.map(|row| row.phi).collect();
        let best = Mismatch::new(system.graph(), &rows, &conditions, &arguments, &mut values).best();
        for (&argument, value) in arguments.iter().zip(best) {
            system.set_estimate(argument as usize, value);
        }
    }
}

/// Returns the values of the graph's nodes with all coordinates at their estimates. Nodes that hold an open argument are not meaningful.
fn values_as_drawn(system: &ConstraintSystem) -> Vec<f64> {
    let estimates = system.coordinates().iter().map(|coordinate| system.value_at(coordinate.estimate, &[]));
    let q: Vec<f64> = estimates.collect();
    let mut values = Vec::new();
    system.graph().extend_values(&mut values, |symbol| match symbol {
        Symbol::Param(k) => system.params()[k as usize].value,
        Symbol::Shift(_) => 0.0,
        Symbol::Coordinate { index, order: 0 } => q[index as usize],
        _ => f64::NAN,
    });
    values
}

impl<'l> Mismatch<'l> {
    fn new(
        graph: &'l Graph,
        rows: &'l [ExprId],
        conditions: &'l [ExprId],
        arguments: &'l [u32],
        values: &'l mut [f64],
    ) -> Mismatch<'l> {
        let roots: Vec<ExprId> = rows.iter().chain(conditions).copied().collect();
        let (mut inner, mut outer) = (Vec::new(), Vec::new());
        // Level of each node: 0 without arguments, 1 with outer arguments only, 2 with the last argument.
        let mut depends = rustc_hash::FxHashMap::default();
        for id in graph.reachable(&roots) {
            let node = graph.node(id);
            let level = match node {
                Node::Symbol(Symbol::Coordinate { index, order: 0 }) => arguments
                    .iter()
                    .position(|&w| w == index)
                    .map_or(0, |k| if k + 1 == arguments.len() { 2 } else { 1 }),
                _ => node.children().as_slice().iter().map(|child| depends[child]).max().unwrap_or(0),
            };
            depends.insert(id, level);
            match level {
                2 => inner.push(id),
                1 => outer.push(id),
                _ => {}
            }
        }
        Mismatch { graph, rows, conditions, arguments, inner, outer, values }
    }

    fn run(&mut self, is_inner: bool, point: [f64; 2]) {
        let nodes = if is_inner { &self.inner } else { &self.outer };
        for &id in nodes {
            let values = &*self.values;
            let symbol = |symbol: Symbol| match symbol {
                Symbol::Coordinate { index, .. } => {
                    self.arguments.iter().position(|&w| w == index).map_or(f64::NAN, |k| point[k])
                }
                _ => f64::NAN,
            };
            self.values[id.index()] = self.graph.node_value(self.graph.node(id), |child| values[child.index()], symbol);
        }
    }

    fn sum(&self) -> f64 {
        let value = |id: &ExprId| self.values[id.index()];
        let sum: f64 = self.rows.iter().map(|row| value(row) * value(row)).sum();
        // There is no contact if the rows have no value or the curves no point.
        if sum.is_finite() && self.conditions.iter().all(|c| value(c) > 0.0) { sum } else { f64::INFINITY }
    }

    fn value_at(&mut self, point: [f64; 2]) -> f64 {
        self.run(false, point);
        self.run(true, point);
        self.sum()
    }

    /// Returns the mismatch on a grid over one turn; the last argument varies first.
    fn on_grid(&mut self, steps: usize) -> Vec<(f64, [f64; 2])> {
        let turn = |k: usize| -PI + k as f64 * (2.0 * PI / steps as f64);
        let mut grid = Vec::new();
        if let [_] = self.arguments {
            for k in 0..=steps {
                let point = [turn(k), 0.0];
                grid.push((self.value_at(point), point));
            }
            return grid;
        }
        for k in 0..=steps {
            self.run(false, [turn(k), 0.0]);
            for m in 0..=steps {
                let point = [turn(k), turn(m)];
                self.run(true, point);
                grid.push((self.sum(), point));
            }
        }
        grid
    }

    /// Returns the arguments of the smallest mismatch; the first of several equally good ones.
    fn best(&mut self) -> [f64; 2] {
        let is_single = self.arguments.len() == 1;
        let steps = if is_single { PLACES } else { PLACES_OF_TWO };
        let others = if is_single { 1 } else { steps + 1 };
        let grid = self.on_grid(steps);
        let near = |k: usize, m: usize| grid.get(k * others + m).map_or(f64::INFINITY, |f| f.0);
        let is_least = |at: &usize| {
            let (k, m, here) = (at / others, at % others, grid[*at].0);
            here.is_finite()
                && (k == 0 || near(k - 1, m) >= here)
                && (k == steps || near(k + 1, m) >= here)
                && (m == 0 || near(k, m - 1) >= here)
                && (m + 1 == others || near(k, m + 1) >= here)
        };
        let mut least: Vec<usize> = (0..grid.len()).filter(is_least).collect();
        least.sort_by(|&a, &b| grid[a].0.total_cmp(&grid[b].0));
        least.truncate(CANDIDATES);
        least.sort_unstable();
        let step = 2.0 * PI / steps as f64;
        let refined: Vec<(f64, [f64; 2])> = least.into_iter().map(|at| self.refine(grid[at], step)).collect();
        let smallest = refined.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
        let widest = grid.iter().map(|f| f.0).filter(|sum| sum.is_finite()).fold(0.0, f64::max);
        let as_good = |f: &&(f64, [f64; 2])| f.0 <= smallest + SAME * widest;
        refined.iter().find(as_good).map_or([0.0; 2], |f| f.1)
    }

    /// Descends in decreasing steps, within the turn.
    fn refine(&mut self, start: (f64, [f64; 2]), step: f64) -> (f64, [f64; 2]) {
        let (mut best, mut step) = (start, step);
        for _ in 0..MOST_STEPS {
            let (here, mut stays) = (best.1, true);
            for k in 0..self.arguments.len() {
                for change in [-step, step] {
                    let mut point = here;
                    point[k] = (point[k] + change).clamp(-PI, PI);
                    let value = self.value_at(point);
                    if value < best.0 {
                        (best, stays) = ((value, point), false);
                    }
                }
            }
            if stays {
                step *= 0.5;
            }
            if step < REFINED {
                break;
            }
        }
        best
    }
}
