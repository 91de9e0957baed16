//! Where a contact begins whose curve gives no estimate: the best of a search over one turn.
//!
//! A search needs numbers, and so it is made with the parameters' values; what comes out is an estimate and no more.

use mechc_expr::{ExprId, Graph, Node, Symbol};
use mechc_ir::tolerances::assembly::estimates::{CANDIDATES, MOST_STEPS, PLACES, PLACES_OF_TWO, REFINED, SAME};
use mechc_ir::{ConstraintSystem, OpenContact};
use std::f64::consts::PI;

/// The sum of squares of a joint's rows, as its arguments go, all else being as drawn.
struct Mismatch<'l> {
    graph: &'l Graph,
    rows: &'l [ExprId],
    /// What must be positive for a curve to have a point there.
    conditions: &'l [ExprId],
    /// The arguments' coordinates.
    wanted: &'l [u32],
    /// What depends on the last argument, and what depends only on the others.
    inner: Vec<ExprId>,
    outer: Vec<ExprId>,
    /// The numbers of the graph with all coordinates at their estimates.
    values: &'l mut [f64],
}

/// Sets the estimates of contacts' arguments that nobody gave: each joint's to the smallest sum of squares of its rows in the written
/// poses, over one turn (−π to π), where the conditions of its curves hold.
pub fn complete(system: &mut ConstraintSystem) {
    if system.open_contacts().is_empty() {
        return;
    }
    let mut values = values_as_drawn(system);
    for OpenContact { declaration, arguments, conditions } in system.take_open_contacts() {
        let own = system.rows().iter().filter(|row| row.declaration == declaration);
        let rows: Vec<ExprId> = own.map(|row| row.phi).collect();
        let best = Mismatch::new(system.graph(), &rows, &conditions, &arguments, &mut values).best();
        for (&argument, value) in arguments.iter().zip(best) {
            system.set_estimate(argument as usize, value);
        }
    }
}

/// The numbers of the graph with all coordinates at their estimates, which are of no use where they hold an argument that is open.
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
        wanted: &'l [u32],
        values: &'l mut [f64],
    ) -> Mismatch<'l> {
        let roots: Vec<ExprId> = rows.iter().chain(conditions).copied().collect();
        let (mut inner, mut outer) = (Vec::new(), Vec::new());
        // by node: nothing, an outer argument, the last argument
        let mut depends = rustc_hash::FxHashMap::default();
        for id in graph.reachable(&roots) {
            let node = graph.node(id);
            let level = match node {
                Node::Symbol(Symbol::Coordinate { index, order: 0 }) => {
                    wanted.iter().position(|&w| w == index).map_or(0, |k| if k + 1 == wanted.len() { 2 } else { 1 })
                }
                _ => node.children().as_slice().iter().map(|child| depends[child]).max().unwrap_or(0),
            };
            depends.insert(id, level);
            match level {
                2 => inner.push(id),
                1 => outer.push(id),
                _ => {}
            }
        }
        Mismatch { graph, rows, conditions, wanted, inner, outer, values }
    }

    fn run(&mut self, is_inner: bool, place: [f64; 2]) {
        let nodes = if is_inner { &self.inner } else { &self.outer };
        for &id in nodes {
            let values = &*self.values;
            let symbol = |symbol: Symbol| match symbol {
                Symbol::Coordinate { index, .. } => {
                    self.wanted.iter().position(|&w| w == index).map_or(f64::NAN, |k| place[k])
                }
                _ => f64::NAN,
            };
            self.values[id.index()] = self.graph.node_value(self.graph.node(id), |child| values[child.index()], symbol);
        }
    }

    fn sum(&self) -> f64 {
        let value = |id: &ExprId| self.values[id.index()];
        let sum: f64 = self.rows.iter().map(|row| value(row) * value(row)).sum();
        // where the rows have no value, or the curves no point, there is no contact
        if sum.is_finite() && self.conditions.iter().all(|c| value(c) > 0.0) { sum } else { f64::INFINITY }
    }

    fn at(&mut self, place: [f64; 2]) -> f64 {
        self.run(false, place);
        self.run(true, place);
        self.sum()
    }

    /// The mismatch all over one turn, place by place, the last argument going first.
    fn everywhere(&mut self, places: usize) -> Vec<(f64, [f64; 2])> {
        let turn = |k: usize| -PI + k as f64 * (2.0 * PI / places as f64);
        let mut found = Vec::new();
        if let [_] = self.wanted {
            for k in 0..=places {
                let place = [turn(k), 0.0];
                found.push((self.at(place), place));
            }
            return found;
        }
        for k in 0..=places {
            self.run(false, [turn(k), 0.0]);
            for m in 0..=places {
                let place = [turn(k), turn(m)];
                self.run(true, place);
                found.push((self.sum(), place));
            }
        }
        found
    }

    /// The arguments of the smallest mismatch; of several that are as good, the first.
    fn best(&mut self) -> [f64; 2] {
        let is_single = self.wanted.len() == 1;
        let places = if is_single { PLACES } else { PLACES_OF_TWO };
        let others = if is_single { 1 } else { places + 1 };
        let found = self.everywhere(places);
        let near = |k: usize, m: usize| found.get(k * others + m).map_or(f64::INFINITY, |f| f.0);
        let is_least = |at: &usize| {
            let (k, m, here) = (at / others, at % others, found[*at].0);
            here.is_finite()
                && (k == 0 || near(k - 1, m) >= here)
                && (k == places || near(k + 1, m) >= here)
                && (m == 0 || near(k, m - 1) >= here)
                && (m + 1 == others || near(k, m + 1) >= here)
        };
        let mut least: Vec<usize> = (0..found.len()).filter(is_least).collect();
        least.sort_by(|&a, &b| found[a].0.total_cmp(&found[b].0));
        least.truncate(CANDIDATES);
        least.sort_unstable();
        let step = 2.0 * PI / places as f64;
        let refined: Vec<(f64, [f64; 2])> = least.into_iter().map(|at| self.refined(found[at], step)).collect();
        let smallest = refined.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
        let widest = found.iter().map(|f| f.0).filter(|sum| sum.is_finite()).fold(0.0, f64::max);
        let as_good = |f: &&(f64, [f64; 2])| f.0 <= smallest + SAME * widest;
        refined.iter().find(as_good).map_or([0.0; 2], |f| f.1)
    }

    /// Goes downhill in ever smaller steps, within the turn.
    fn refined(&mut self, start: (f64, [f64; 2]), step: f64) -> (f64, [f64; 2]) {
        let (mut best, mut step) = (start, step);
        for _ in 0..MOST_STEPS {
            let (here, mut stays) = (best.1, true);
            for k in 0..self.wanted.len() {
                for way in [-step, step] {
                    let mut place = here;
                    place[k] = (place[k] + way).clamp(-PI, PI);
                    let value = self.at(place);
                    if value < best.0 {
                        (best, stays) = ((value, place), false);
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
