//! Parameters, and time, on their way from one value to another: in the equations of a mechanism that is led a straight line stands for each.
//! Its ends are parameters, so that one mechanism serves for every way from where its own values have it.

use super::{Lowering, inputs, needs_jerk};
use crate::model::{Dimension, Mechanism};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_ir::{ConstraintSystem, Param, Written};
use rustc_hash::FxHashMap;

/// Time while a mechanism is led.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Clock {
    /// It stands still (s).
    Still(f64),
    /// It goes as well.
    Goes,
}

/// The equations of a mechanism on its way: what stands in the place of time goes from 0, where its parameters are its own, to 1, where
/// those that are led, as its model says, are others. Behind its own parameters it has one more for each of these, which is what it comes
/// to; and where time goes two more, from when to when.
#[must_use]
pub fn lower_on_its_way(model: &Mechanism, clock: Clock) -> ConstraintSystem {
    let mut model = model.clone();
    model.leave_what_leads();
    model.by.clear();
    (model.reactions, model.pictures_forces) = (false, false);
    let mut lowering = Lowering::of(&model);
    let mut written = lowering.written();
    Lines::add(&model, clock, &mut written.params).stand_for_all(&mut written);
    let with_jerk = needs_jerk(&model, &written);
    let mut system = ConstraintSystem::of(written, with_jerk);
    inputs::add(&model, &mut system);
    lowering.add_features(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// The parameters that are the ends of lines.
struct Lines {
    clock: Clock,
    /// Of each parameter that is led, the number of the one that it comes to.
    ends: FxHashMap<u32, u32>,
    /// Those that are the first time and the last.
    times: [u32; 2],
}

impl Lines {
    /// Adds them to the others.
    fn add(model: &Mechanism, clock: Clock, params: &mut Vec<Param>) -> Lines {
        let span = model.declared.span;
        let mut add = |name: &str, value: f64, dimension: Dimension| {
            params.push(Param { name: format!("{name} on the way"), part: 0, value, dimension, span });
            params.len() as u32 - 1
        };
        let led = model.led.iter().filter_map(|led| Some((led.param?, led)));
        let ends = led.map(|(param, led)| (param, add(&led.declared.name, led.line[1], led.dimension))).collect();
        let times = match clock {
            Clock::Still(_) => [0; 2],
            Clock::Goes => ["the first time", "the last time"].map(|name| add(name, 0.0, Dimension::TIME)),
        };
        Lines { clock, ends, times }
    }

    /// In all that holds on the way. Estimates keep the values with which it begins, and so do tables, whose cells are numbers.
    fn stand_for_all(&self, written: &mut Written) {
        written.substitute(|graph, symbol| match symbol {
            Symbol::Param(from) if self.ends.contains_key(&from) => line(graph, [from, self.ends[&from]]),
            Symbol::Time => match self.clock {
                Clock::Still(t) => graph.constant(t),
                Clock::Goes => line(graph, self.times),
            },
            other => graph.symbol(other),
        });
    }
}

/// From the value of one parameter to that of another.
fn line(graph: &mut Graph, ends: [u32; 2]) -> ExprId {
    let (ends, time) = (ends.map(|end| graph.symbol(Symbol::Param(end))), graph.symbol(Symbol::Time));
    graph.line(ends, time)
}
