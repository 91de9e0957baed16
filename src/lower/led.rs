//! Parameters on their way from one value to another: in the equations of a mechanism that is led a straight line of time stands for each.

use crate::expr::{ExprId, Symbol};
use crate::ir::Written;
use crate::model::Mechanism;
use rustc_hash::FxHashMap;

/// Lets the parameters that are led go their way in all that holds on it. Estimates keep the values with which the way begins, and so do
/// tables, whose cells are numbers.
pub(super) fn lead_params(model: &Mechanism, written: &mut Written) {
    let lines: FxHashMap<u32, [f64; 2]> = model.led.iter().filter_map(|led| Some((led.param?, led.line))).collect();
    if lines.is_empty() {
        return;
    }
    let (before, mut known) = (written.graph.clone(), FxHashMap::default());
    let graph = &mut written.graph;
    let mut led = |id: &mut ExprId| {
        graph.import(&before, &[*id], &mut known, |graph, symbol| match symbol {
            Symbol::Param(k) if lines.contains_key(&k) => {
                let [from, to] = lines[&k];
                let (from, way, time) = (graph.constant(from), graph.constant(to - from), graph.symbol(Symbol::Time));
                let gone = graph.mul(way, time);
                graph.add(from, gone)
            }
            other => graph.symbol(other),
        });
        *id = known[id];
    };
    written.rows.iter_mut().for_each(|row| led(&mut row.phi));
    written.conditions.iter_mut().for_each(|condition| led(&mut condition.positive));
    written.watches.iter_mut().for_each(|watch| led(&mut watch.value));
}
