//! Equations of a continuation: parameters, inputs and time move from one value to another on straight lines. The ends of the lines are
//! parameters, so that one system serves for every target.

use super::{Lowering, inputs, needs_jerk};
use crate::model::{Dimension, Mechanism};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_ir::{ConstraintSystem, Param, Written};
use rustc_hash::FxHashMap;

/// Time during a continuation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum TimeOnPath {
    /// Time is constant (s).
    Still(f64),
    /// Time moves too.
    Moving,
}

/// Returns the equations of a continuation. Time is replaced by the path parameter: at 0 the continued parameters have their nominal
/// values, at 1 those of the target. For each of them one parameter is appended to those of the model, its target value; if time moves, two
/// more, its first and last value.
#[must_use]
pub fn lower_continuation(model: &Mechanism, clock: TimeOnPath) -> ConstraintSystem {
    let mut model = model.clone();
    model.strip_outputs();
    model.by.clear();
    (model.reactions, model.pictures_forces) = (false, false);
    let mut lowering = Lowering::new(&model);
    let mut written = lowering.build();
    PathLines::append(&model, clock, &mut written.params).substitute(&mut written);
    let with_jerk = needs_jerk(&model, &written);
    let mut system = ConstraintSystem::of(written, with_jerk);
    inputs::add(&model, &mut system);
    lowering.add_features(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
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
