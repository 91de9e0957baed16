//! Where a contact begins whose curve gives no estimate: the best of a search over one turn.
//!
//! A search needs numbers, and so it is made with the parameters' values; what comes out is an estimate and no more.

use super::Lowering;
use crate::expr::{ExprId, Node, Symbol};
use crate::model::Profile;
use std::f64::consts::PI;

/// Places on one turn that are looked at for one argument.
const PLACES: usize = 720;
/// Places on one turn for each of two arguments.
const PLACES_OF_TWO: usize = 120;
/// So many of the best places are refined.
const CANDIDATES: usize = 8;
/// An estimate need not be nearer than this.
const REFINED: f64 = 1e-7;

/// The sum of squares of a joint's rows, as its arguments go, all else being as drawn.
struct Mismatch<'l, 'm> {
    lowering: &'l Lowering<'m>,
    rows: &'l [ExprId],
    /// All that the rows are built of.
    nodes: Vec<ExprId>,
    values: Vec<f64>,
    /// The poses as written, and the arguments' estimates.
    q: Vec<f64>,
}

impl Lowering<'_> {
    /// Sets those estimates of a joint's arguments that its curves do not give to the smallest sum of squares of its rows
    /// in the written poses, over one turn (−π to π).
    pub(super) fn search(&mut self, rows: &[ExprId], arguments: &[(ExprId, Profile)]) {
        let wanted: Vec<usize> =
            arguments.iter().filter(|(_, p)| !self.has_estimate(*p)).map(|&(u, _)| self.index(u)).collect();
        if wanted.is_empty() {
            return;
        }
        let mut mismatch = Mismatch {
            lowering: self,
            rows,
            nodes: self.graph.reachable_with_tables(rows),
            values: vec![f64::NAN; self.graph.len()],
            q: self.coordinates.iter().map(|coordinate| self.number(coordinate.estimate)).collect(),
        };
        let best = mismatch.best(&wanted);
        for (&index, value) in wanted.iter().zip(best) {
            self.coordinates[index].estimate = self.graph.constant(value);
        }
    }

    fn has_estimate(&self, profile: Profile) -> bool {
        matches!(profile, Profile::Curve(curve) if self.model[curve].estimate.is_some())
    }

    fn index(&self, u: ExprId) -> usize {
        match self.graph.node(u) {
            Node::Symbol(Symbol::Coordinate { index, .. }) => index as usize,
            _ => 0,
        }
    }

    /// The value of a formula of parameters.
    fn number(&self, id: ExprId) -> f64 {
        self.graph.value(id, |symbol| match symbol {
            Symbol::Param(k) => self.model.params[k as usize].value,
            _ => f64::NAN,
        })
    }
}

impl Mismatch<'_, '_> {
    fn at(&mut self, wanted: &[usize], place: [f64; 2]) -> f64 {
        for (&index, value) in wanted.iter().zip(place) {
            self.q[index] = value;
        }
        let (graph, model) = (&self.lowering.graph, self.lowering.model);
        for &id in &self.nodes {
            let values = &self.values;
            let value = graph.node_value(
                graph.node(id),
                |child| values[child.index()],
                |symbol| match symbol {
                    Symbol::Param(k) => model.params[k as usize].value,
                    Symbol::Coordinate { index, order: 0 } => self.q[index as usize],
                    _ => f64::NAN,
                },
            );
            self.values[id.index()] = value;
        }
        let sum: f64 = self.rows.iter().map(|row| self.values[row.index()] * self.values[row.index()]).sum();
        // where the rows have no value there is no contact
        if sum.is_finite() { sum } else { f64::INFINITY }
    }

    fn best(&mut self, wanted: &[usize]) -> [f64; 2] {
        let places = if wanted.len() == 1 { PLACES } else { PLACES_OF_TWO };
        let step = 2.0 * PI / places as f64;
        let turn = |k: usize| -PI + k as f64 * step;
        let others = if wanted.len() == 1 { 1 } else { places + 1 };
        let mut found: Vec<(f64, [f64; 2])> = Vec::new();
        for k in 0..=places {
            for m in 0..others {
                let place = [turn(k), turn(m)];
                found.push((self.at(wanted, place), place));
            }
        }
        let is_least = |at: usize| {
            let (k, m) = (at / others, at % others);
            let near = |k: usize, m: usize| found.get(k * others + m).map_or(f64::INFINITY, |f| f.0);
            let here = found[at].0;
            here.is_finite()
                && (k == 0 || near(k - 1, m) >= here)
                && (k == places || near(k + 1, m) >= here)
                && (m == 0 || near(k, m - 1) >= here)
                && (m + 1 == others || near(k, m + 1) >= here)
        };
        let mut least: Vec<(f64, [f64; 2])> = (0..found.len()).filter(|&at| is_least(at)).map(|at| found[at]).collect();
        least.sort_by(|a, b| a.0.total_cmp(&b.0));
        least.truncate(CANDIDATES);
        let mut best = (f64::INFINITY, [0.0; 2]);
        for start in least {
            let refined = self.refined(wanted, start, step);
            // the first one counts where several are as good
            if refined.0 < best.0 - 1e-12 * best.0.min(1.0) {
                best = refined;
            }
        }
        best.1
    }

    /// Goes downhill in ever smaller steps.
    fn refined(&mut self, wanted: &[usize], start: (f64, [f64; 2]), step: f64) -> (f64, [f64; 2]) {
        let (mut best, mut step) = (start, step);
        while step > REFINED {
            let (here, mut stays) = (best.1, true);
            for k in 0..wanted.len() {
                for way in [-step, step] {
                    let mut place = here;
                    place[k] += way;
                    let value = self.at(wanted, place);
                    if value < best.0 {
                        (best, stays) = ((value, place), false);
                    }
                }
            }
            if stays {
                step *= 0.5;
            }
        }
        best
    }
}
