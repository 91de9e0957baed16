//! Inputs: their formulas in the text, and their overrides.

use super::Formulas;
use super::overrides::override_matches;
use super::samples::{self, Column, ColumnHeader, Samples};
use super::value::{Context, Dim, Value};
use crate::check::errors::{self, Reporter};
use crate::check::suggest::lost_rate::Part;
use crate::model::{Condition, ConditionKind, Dimension, Input, TimeFormula};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{Expr, ItemKind, Name};
use mechc_text::diag::{Diagnostic, nearest};
use mechc_text::source::Span;

/// The state of an input.
pub(super) struct InputState<'a> {
    pub name: &'a Name,
    pub formula: &'a Expr,
    /// `None` before evaluation, and if it is broken.
    pub value: Option<Value>,
}

impl Formulas<'_> {
    /// Reports overrides of unknown parameters, and of parameters that are bound.
    pub(in crate::check) fn check_param_overrides(&mut self) {
        if self.options.settings.is_empty() {
            return;
        }
        let params = self.settable_names(|item| match item {
            ItemKind::Param { name, .. } => Some(name),
            _ => None,
        });
        for setting in &self.options.settings {
            let (path, span) = (&setting.path, setting.value.span);
            let owner = path.rsplit_once('.').filter(|(_, axis)| ["x", "y"].contains(&axis.trim()));
            let is_it = |full: &str| {
                override_matches(full, path) || owner.is_some_and(|(owner, _)| override_matches(full, owner))
            };
            self.check_override_name(Settable::Param, path, span, &params, is_it);
        }
    }

    /// Reports overrides of unknown inputs, and of inputs that are overridden twice.
    pub(in crate::check) fn check_input_overrides(&mut self) {
        let given = &self.options.given;
        if given.formulas.is_empty() {
            return;
        }
        let inputs = self.all_inputs();
        for (path, formula) in &given.formulas {
            self.check_override_name(Settable::Input, path, formula.span, &inputs, |full| override_matches(full, path));
        }
        let twice = inputs.iter().find_map(|(input, _)| {
            let mut formulas = given.formulas.iter().filter(|(path, _)| override_matches(input, path));
            let (first, second) = (formulas.next()?, formulas.next()?);
            Some((input, [second.1.span, first.1.span]))
        });
        if let Some((input, places)) = twice {
            self.reporter.report(errors::duplicate_override(input, places));
        }
    }

    fn all_inputs(&self) -> Vec<(String, Option<Span>)> {
        self.settable_names(|item| match item {
            ItemKind::Input { name, .. } => Some(name),
            _ => None,
        })
    }

    /// Reports an override that names nothing which can be overridden.
    fn check_override_name(
        &mut self,
        what: Settable,
        path: &str,
        span: Span,
        settable: &[(String, Option<Span>)],
        is_it: impl Fn(&str) -> bool,
    ) -> bool {
        let mut found = settable.iter().filter(|(full, _)| is_it(full)).peekable();
        if found.peek().is_none() {
            let names: Vec<&str> = settable.iter().map(|(full, _)| full.as_str()).collect();
            let suggestion = nearest(path, names.iter().copied());
            let diagnostic = errors::no_such_name(what.noun(), &self.scope.tree.name.text, path, &names, suggestion);
            self.reporter.report(diagnostic.at(span, format!("for `{path}`")));
            return false;
        }
        let bound = found.find_map(|(full, binding)| Some((full, (*binding)?)));
        if let Some((full, binding)) = bound {
            self.reporter.report(errors::bound_from_outside(what.noun(), full, span, binding));
        }
        bound.is_none()
    }

    /// Returns the samples, if they are valid.
    pub(in crate::check) fn read_samples(&mut self) -> Option<Samples> {
        let file = self.options.given.samples?;
        let sources = self.reporter.sources;
        let headed = report_faults(&mut self.reporter, samples::header(sources.get(file), file))?;
        let inputs = self.all_inputs();
        let faulty = headed.columns().filter(|head| !self.has_an_input(head, &inputs)).count();
        match headed.rows() {
            // A column of an unknown input may well hold no numbers.
            Err(_) if faulty > 0 => None,
            rows => report_faults(&mut self.reporter, rows),
        }
    }

    /// Returns whether a column names an input that can be overridden.
    fn has_an_input(&mut self, head: &ColumnHeader<'_>, inputs: &[(String, Option<Span>)]) -> bool {
        let path = head.path();
        if let Some(suggestion) = head.suggestion().filter(|_| !inputs.iter().any(|(full, _)| *full == path)) {
            let written = self.reporter.text(head.span).trim_matches('"');
            self.reporter.report(errors::column_of_no_input(
                &self.scope.tree.name.text,
                written,
                head.span,
                &suggestion,
            ));
            return false;
        }
        if !self.check_override_name(Settable::Column, &path, head.span, inputs, |full| full == path) {
            return false;
        }
        let twice = self.options.given.formulas.iter().find(|(full, _)| override_matches(&path, full));
        if let Some((_, formula)) = twice {
            self.reporter.report(errors::duplicate_override(&path, [head.span, formula.span]));
        }
        twice.is_none()
    }

    /// Evaluates an input. If a part's input is bound, its own formula only gives its dimension.
    pub(in crate::check) fn input(&mut self, k: usize) {
        let (name, formula) = (self.inputs[k].name, self.inputs[k].formula);
        let before = self.model.conditions.len();
        let Some(in_file) = self.input_value(name, formula) else { return };
        // Conditions of inputs are kept with the inputs. The own formula of a bound input does not affect the motion.
        let conditions = self.model.conditions.split_off(before);
        if self.bound.inputs.contains(&name.text.as_str()) {
            self.inputs[k].value = Some(in_file);
            return;
        }
        let nominal = TimeFormula { value: in_file.id, conditions };
        let formula = match self.overridden_input(name, in_file.dim) {
            None => nominal.clone(),
            Some(None) => return,
            Some(Some(value)) => TimeFormula { value: value.id, conditions: self.model.conditions.split_off(before) },
        };
        let (declared, dimension) = (self.scope.declared(name), in_file.dim.settled());
        let index = self.model.inputs.len() as u32;
        self.model.inputs.push(Input { declared: declared.clone(), formula, nominal, dimension });
        let id = self.model.graph.symbol(Symbol::Signal { index, order: 0 });
        self.inputs[k].value = Some(self.with_shift(&declared, Value { id, ..in_file }));
    }

    /// Evaluates what an option gives in place of the formula of an input; `None` if no option does, `Some(None)` if it is broken.
    #[allow(clippy::option_option)] // a broken override is not the absence of one
    fn overridden_input(&mut self, name: &Name, expected: Dim) -> Option<Option<Value>> {
        let full = format!("{}{}", self.scope.path, name.text);
        let samples = self.samples.clone();
        let column = samples.as_ref().and_then(|samples| samples.columns.iter().find(|column| column.name == full));
        if let Some((samples, column)) = samples.as_ref().zip(column) {
            return Some(self.sampled(&samples.times, column, expected));
        }
        let formulas = &self.options.given.formulas;
        let (_, given) = formulas.iter().rev().find(|(path, _)| override_matches(&full, path))?;
        Some(self.override_value(name, given, expected))
    }

    fn input_value(&mut self, name: &Name, formula: &Expr) -> Option<Value> {
        let judged = self.is_dimensional(formula);
        let context = Context { judged, time: true, ..Context::constant("an input") };
        let conditions = self.model.conditions.len();
        let value = self.formula(formula, &context)?;
        let owner = self.scope.declared(name).name;
        for condition in &mut self.model.conditions[conditions..] {
            condition.owner.clone_from(&owner);
        }
        // A plain formula of time is a number.
        let is_plain = !judged && !value.dim.of_term().is_a_pure_number();
        let angle = value.dim.settled().angle;
        let dim = if is_plain { Dim::PLAIN.map(|pure| Dimension { angle, ..pure }) } else { value.dim.of_term() };
        Some(Value { dim, ..value })
    }

    /// Returns the value of an override's formula. A plain one is in the unit of the expected dimension.
    fn override_value(&mut self, name: &Name, formula: &Expr, expected: Dim) -> Option<Value> {
        let given = self.input_value(name, formula)?;
        if let Some([expected, found]) = expected.other_than(given.dim).filter(|_| self.is_dimensional(formula)) {
            let part = Part { span: formula.span, dimension: found };
            let place = format!("the input `{}{}`", self.scope.path, name.text);
            self.reporter.report(errors::wrong_dimension(&place, expected, part, self.reporter.text(formula.span)));
            return None;
        }
        Some(Value { dim: expected, ..given })
    }

    /// Returns the natural cubic spline through samples, at time `t`.
    fn sampled(&mut self, times: &[f64], column: &Column, expected: Dim) -> Option<Value> {
        let unlike = column.dimension.and_then(|found| expected.other_than(Dim::Of(found)));
        if let Some([expected, found]) = unlike {
            let part = Part { span: column.span, dimension: found };
            let place = format!("the input `{}`", column.name);
            self.reporter.report(errors::wrong_dimension(&place, expected, part, self.reporter.text(column.span)));
            return None;
        }
        let graph = &mut self.model.graph;
        let points: Vec<[ExprId; 2]> =
            times.iter().zip(&column.values).map(|(&t, &value)| [t, value].map(|x| graph.constant(x))).collect();
        let table = graph.spline(&column.name, false, &points);
        let t = graph.symbol(Symbol::Time);
        let id = graph.table(table, 0, t);
        let (first, last) = (graph.constant(times[0]), graph.constant(times[times.len() - 1]));
        // Both ends are inside in spite of rounding.
        let slack = graph.constant(1e-12 * (times[times.len() - 1] - times[0]));
        for distance in [graph.sub(t, first), graph.sub(last, t)] {
            let positive = self.model.graph.add(distance, slack);
            let owner = column.name.clone();
            let kind = ConditionKind::Samples(table);
            self.model.conditions.push(Condition { positive, kind, span: column.span, owner });
        }
        Some(Value { id, dim: expected })
    }
}

/// The things that can be overridden.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Settable {
    Param,
    Input,
    /// An input, by a column of samples.
    Column,
}

impl Settable {
    fn noun(self) -> &'static str {
        match self {
            Settable::Param => "parameter",
            Settable::Input | Settable::Column => "input",
        }
    }
}

/// Returns a value, or reports the faults.
fn report_faults<T>(reporter: &mut Reporter<'_>, found: Result<T, Vec<Diagnostic>>) -> Option<T> {
    found.map_err(|faults| faults.into_iter().for_each(|fault| reporter.report(fault))).ok()
}
