//! A mechanism on its way from its own inputs to others: each of them, and time, on a straight line. And what its parameters are by the
//! text, where it is to be led from there to others (`lower`).
//!
//! The model that comes out has no time of its own: what stands in the place of time goes from 0, where inputs are what the text says, to
//! 1, where they are what they are told to be. Its motion is no motion of the mechanism, but leads from one start to another.

use super::formula::Value;
use super::told::is_told_by;
use super::{Checker, errors};
use crate::model::{Condition, Declared, Dimension, Led};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::Name;

/// Where a mechanism is led.
#[derive(Clone, Debug, Default)]
pub struct Lead {
    /// From the first time to the last (s).
    pub times: [f64; 2],
    /// The inputs that are led to a number (SI), by their names; the others are led to what they are at the last time.
    pub inputs: Vec<(String, f64)>,
}

/// What an input may need to have a value: conditions of the text's own formula, and of what it is told to be.
pub(super) struct Needs {
    /// How many conditions there were before its own formula was read.
    pub before: usize,
    /// How many there were behind it.
    pub behind_own: usize,
}

impl Checker<'_> {
    /// Time as formulas see it (s).
    pub(super) fn time(&mut self) -> ExprId {
        let time = self.model.graph.symbol(Symbol::Time);
        let Some(Lead { times, .. }) = &self.around.lead else { return time };
        self.along_a_line(*times)
    }

    /// What an input is while the mechanism is led; else what it is anyway.
    pub(super) fn led_input(&mut self, name: &Name, own: Value, told: Option<Value>, needs: &Needs) -> Option<Value> {
        let Some(lead) = &self.around.lead else { return told };
        // they hold at both ends or not, and say nothing of the way
        let of_told = self.model.conditions.split_off(needs.behind_own);
        let of_own = self.model.conditions.split_off(needs.before);
        let told = told?;
        let declared = self.declared(name);
        let target = lead.inputs.iter().find(|(input, _)| *input == declared.name).map(|(_, value)| *value);
        let is_told_nothing = told.id == own.id;
        let holds = self.hold_at(&of_own, 0.0)
            && (target.is_some() || self.hold_at(if is_told_nothing { &of_own } else { &of_told }, 1.0));
        let line = [self.value_on_the_way(own.id, 0.0), target.unwrap_or_else(|| self.value_on_the_way(told.id, 1.0))];
        if let Some(value) = line.into_iter().find(|value| !value.is_finite() || !holds) {
            self.report(errors::not_finite(name.span, value));
            return None;
        }
        let dimension = told.dim.settled();
        self.model.led.push(Led { declared, param: None, line, dimension });
        Some(Value { id: self.along_a_line(line), ..told })
    }

    /// Whether a parameter, or a coordinate of one that is a point, may be set elsewhere than it is: then it is none that follows.
    pub(super) fn is_open(&self, declared: &Declared, name: &str) -> bool {
        if self.around.open.is_empty() {
            return false;
        }
        let full = format!("{}{name}", self.address.path);
        self.around.open.iter().any(|path| is_told_by(&full, path) || is_told_by(&declared.name, path))
    }

    /// Notes that the next parameter of the model may be set elsewhere than it is (SI).
    pub(super) fn open_param(&mut self, declared: &Declared, own: f64, dimension: Dimension) {
        let param = Some(self.model.params.len() as u32);
        self.model.led.push(Led { declared: declared.clone(), param, line: [own; 2], dimension });
    }

    /// Leaves of a mechanism that is led what leads it: its analysis is of another time, and forces have no part in it.
    pub(super) fn strip_outputs(&mut self) {
        if self.around.lead.is_some() {
            self.model.strip_outputs();
        }
    }

    fn along_a_line(&mut self, ends: [f64; 2]) -> ExprId {
        let graph = &mut self.model.graph;
        let (ends, time) = (ends.map(|end| graph.constant(end)), graph.symbol(Symbol::Time));
        graph.line(ends, time)
    }

    /// The value of a formula of time, at a part of the way.
    fn value_on_the_way(&self, id: ExprId, part: f64) -> f64 {
        let params = &self.model.params;
        self.model.graph.value(id, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Time => part,
            _ => f64::NAN,
        })
    }

    fn hold_at(&self, conditions: &[Condition], part: f64) -> bool {
        conditions.iter().all(|condition| self.value_on_the_way(condition.positive, part) > 0.0)
    }
}
