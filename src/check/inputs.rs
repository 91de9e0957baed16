//! Inputs: what they are by the text, and what they are told to be from outside.

use super::formula::{Context, Dim, Value};
use super::rates::Part;
use super::samples::{self, Column, Samples};
use super::{Checker, errors};
use crate::diag::nearest;
use crate::expr::{ExprId, Symbol};
use crate::model::{Condition, ConditionKind, Input};
use crate::source::FileId;
use crate::syntax::ast::{Expr, Name};

/// What inputs are told to be.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// By formulas: the name of the input, and the formula, over params, functions, tables and time.
    pub formulas: Vec<(String, Expr)>,
    /// By the samples of a file.
    pub samples: Option<FileId>,
}

impl Checker<'_> {
    /// Says which of the formulas given are of no input, or of one that another one is of too.
    pub(super) fn look_over_given(&mut self) {
        let given = self.given;
        let inputs: Vec<&str> = self.inputs.iter().map(|input| input.name.text.as_str()).collect();
        for (told, formula) in &given.formulas {
            if !inputs.iter().any(|input| is_told_by(input, told)) {
                let meant = nearest(told, inputs.iter().copied());
                let diagnostic = errors::no_such_input(&self.tree.name.text, told, &inputs, meant);
                self.report(diagnostic.at(formula.span, format!("for `{told}`")));
            }
        }
        let twice = inputs.iter().find_map(|input| {
            let mut formulas = given.formulas.iter().filter(|(told, _)| is_told_by(input, told));
            let (first, second) = (formulas.next()?, formulas.next()?);
            Some((*input, [second.1.span, first.1.span]))
        });
        if let Some((input, places)) = twice {
            self.report(errors::input_told_twice(input, places));
        }
    }

    /// The samples given, if they can be used.
    pub(super) fn samples(&mut self) -> Option<Samples> {
        let file = self.given.samples?;
        match samples::read(self.sources.get(file), file) {
            Ok(samples) => {
                for column in &samples.columns {
                    self.has_an_input(column);
                }
                Some(samples)
            }
            Err(faults) => {
                for fault in faults {
                    self.report(fault);
                }
                None
            }
        }
    }

    fn has_an_input(&mut self, column: &Column) {
        let inputs: Vec<&str> = self.inputs.iter().map(|input| input.name.text.as_str()).collect();
        if !inputs.contains(&column.name.as_str()) {
            let meant = nearest(&column.name, inputs.iter().copied());
            let diagnostic = errors::no_such_input(&self.tree.name.text, &column.name, &inputs, meant);
            self.report(diagnostic.at(column.span, "this column"));
        } else if let Some((_, formula)) = self.given.formulas.iter().find(|(told, _)| is_told_by(&column.name, told)) {
            self.report(errors::input_told_twice(&column.name, [column.span, formula.span]));
        }
    }

    /// What an input is.
    pub(super) fn input(&mut self, k: usize, samples: Option<&Samples>) {
        let (name, formula) = (self.inputs[k].name, self.inputs[k].formula);
        let before = self.model.conditions.len();
        let Some(in_file) = self.input_value(formula) else { return };
        let column = samples.and_then(|samples| samples.columns.iter().find(|column| column.name == name.text));
        let formulas = &self.given.formulas;
        let told = formulas.iter().rev().find(|(told, _)| is_told_by(&name.text, told)).map(|(_, formula)| formula);
        let value = match (column, told) {
            (Some(column), _) => samples.and_then(|samples| self.sampled(&samples.times, column, in_file.dim)),
            (None, Some(formula)) => self.told(name, formula, in_file.dim),
            (None, None) => Some(in_file),
        };
        self.inputs[k].value = value;
        if let Some(value) = value {
            let (declared, dimension) = (super::declared(name), value.dim.settled());
            self.model.inputs.push(Input { declared, number: k, value: value.id, dimension });
            if self.model.has_signals {
                // what the formula asks for is no concern of those that take what they are given
                self.model.conditions.truncate(before);
                let id = self.model.graph.symbol(Symbol::Signal { index: k as u32, order: 0 });
                self.inputs[k].value = Some(Value { id, ..value });
            }
        }
    }

    fn input_value(&mut self, formula: &Expr) -> Option<Value> {
        let judged = self.is_dimensional(formula);
        let context = Context { judged, time: true, ..Context::constant("an input") };
        let value = self.formula(formula, &context)?;
        let dim = match value.dim {
            Dim::Of(dimension) if judged => Dim::Of(dimension),
            _ => Dim::PURE,
        };
        Some(Value { dim, ..value })
    }

    /// What a formula from outside says: a plain one is taken in the unit of what is expected.
    fn told(&mut self, name: &Name, formula: &Expr, wanted: Dim) -> Option<Value> {
        let given = self.input_value(formula)?;
        if let (Dim::Of(wanted), Dim::Of(found)) = (wanted, given.dim)
            && self.is_dimensional(formula)
            && !wanted.is(found)
        {
            let part = Part { span: formula.span, dimension: found };
            let place = format!("the input `{}`", name.text);
            self.report(errors::wrong_dimension(&place, wanted, part, self.sources.text(formula.span)));
            return None;
        }
        Some(Value { dim: wanted, ..given })
    }

    /// The natural cubic spline through samples, at time `t`.
    fn sampled(&mut self, times: &[f64], column: &Column, wanted: Dim) -> Option<Value> {
        if let (Some(found), Dim::Of(wanted)) = (column.dimension, wanted)
            && !wanted.is(found)
        {
            let part = Part { span: column.span, dimension: found };
            let place = format!("the input `{}`", column.name);
            self.report(errors::wrong_dimension(&place, wanted, part, self.sources.text(column.span)));
            return None;
        }
        let graph = &mut self.model.graph;
        let points: Vec<[ExprId; 2]> =
            times.iter().zip(&column.values).map(|(&t, &value)| [t, value].map(|x| graph.constant(x))).collect();
        let table = graph.spline(&column.name, false, &points);
        let t = graph.symbol(Symbol::Time);
        let id = graph.table(table, 0, t);
        let (first, last) = (graph.constant(times[0]), graph.constant(times[times.len() - 1]));
        // both ends are within, whatever rounding says
        let slack = graph.constant(1e-12 * (times[times.len() - 1] - times[0]));
        for way in [graph.sub(t, first), graph.sub(last, t)] {
            let positive = self.model.graph.add(way, slack);
            let owner = column.name.clone();
            let kind = ConditionKind::Samples(table);
            self.model.conditions.push(Condition { positive, kind, span: column.span, owner });
        }
        Some(Value { id, dim: wanted })
    }

    /// Says that an input may not stand somewhere.
    pub(super) fn input_in(&mut self, name: &Name, context: &Context<'_>) {
        let diagnostic = errors::input_in(context.place, name, context.time);
        self.report(diagnostic);
    }
}

/// Whether what is told of a name is told of an input: of its own name, or of all copies of a repeated one; spaces count nothing.
pub(super) fn is_told_by(input: &str, told: &str) -> bool {
    let told: String = told.chars().filter(|c| !c.is_whitespace()).collect();
    told == input || input.split_once('[').is_some_and(|(base, _)| base == told)
}
