//! Equations of a continuation of parameters: they move from one value to another on straight lines. The ends of the lines are parameters,
//! so that one system serves for every target.

use super::TimeOnPath;
use crate::model::{Dimension, Mechanism};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_ir::{Param, Written};
use rustc_hash::FxHashMap;

/// Replaces parameters and time by lines along the path. For each of the model's continued parameters, its target value is appended to the
/// parameters; if time moves, its first and its last value follow.
pub(super) fn put_on_path(model: &Mechanism, clock: TimeOnPath, written: &mut Written) {
    PathLines::append(model, clock, &mut written.params).substitute(written);
}

/// The appended parameters, which are ends of lines.
struct PathLines {
    clock: TimeOnPath,
    /// The number of the target value of each continued parameter.
    ends: FxHashMap<u32, u32>,
    /// The numbers of the first and the last time.
    times: [u32; 2],
}

impl PathLines {
    /// Appends the parameters.
    fn append(model: &Mechanism, clock: TimeOnPath, params: &mut Vec<Param>) -> PathLines {
        let span = model.declared.span;
        let mut add = |name: &str, value: f64, dimension: Dimension| {
            params.push(Param { name: format!("{name} on the way"), part: 0, value, dimension, span });
            params.len() as u32 - 1
        };
        let continued = model.continued.iter().filter_map(|led| Some((led.param?, led)));
        let ends = continued.map(|(param, led)| (param, add(&led.declared.name, led.line[1], led.dimension))).collect();
        let times = match clock {
            TimeOnPath::Still(_) => [0; 2],
            TimeOnPath::Moving => ["the first time", "the last time"].map(|name| add(name, 0.0, Dimension::TIME)),
        };
        PathLines { clock, ends, times }
    }

    /// Replaces parameters and time by their lines. Estimates and table cells keep the values at the start, as table cells are numbers.
    fn substitute(&self, written: &mut Written) {
        written.substitute(|graph, symbol| match symbol {
            Symbol::Param(from) if self.ends.contains_key(&from) => line(graph, [from, self.ends[&from]]),
            Symbol::Time => match self.clock {
                TimeOnPath::Still(t) => graph.constant(t),
                TimeOnPath::Moving => line(graph, self.times),
            },
            other => graph.symbol(other),
        });
    }
}

/// Returns the line from the value of one parameter to that of another.
fn line(graph: &mut Graph, ends: [u32; 2]) -> ExprId {
    let (ends, time) = (ends.map(|end| graph.symbol(Symbol::Param(end))), graph.symbol(Symbol::Time));
    graph.line(ends, time)
}
