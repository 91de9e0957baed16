//! Results: formulas of reductions, each of which takes a formula as in a measure to one number for the whole analysis.

use super::Formulas;
use super::dimensions::require_dimension;
use super::measures::measure_context;
use super::value::{Context, Dim, Value};
use crate::check::errors::{self, Reporter};
use crate::check::scope::Entity;
use crate::model::{Condition, Dimension, GuardKind, Named, Reduction, ReductionKind};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{Expr, Name, Window, WrittenUnit};
use mechc_text::source::Span;
use mechc_text::vocabulary::ReductionWord;

/// The state of a result.
pub(in crate::check) struct ResultState<'a> {
    pub formula: &'a Expr,
    /// The unit in which it is printed, if there is one.
    pub unit: Option<&'a WrittenUnit>,
    /// True if it holds a unit, directly or through names.
    pub dimensional: bool,
    /// `None` before evaluation, and if it is broken.
    pub value: Option<Value>,
}

/// A call that is not a reduction.
pub(super) struct NotAReduction;

/// The option whose condition becomes a further result, and that result's name.
pub const UNTIL: &str = "--until";

impl<'a> ResultState<'a> {
    pub fn new(formula: &'a Expr, unit: Option<&'a WrittenUnit>) -> ResultState<'a> {
        ResultState { formula, unit, dimensional: false, value: None }
    }
}

impl Formulas<'_> {
    /// Evaluates results: those of parts first, then in order of dependence.
    pub(in crate::check) fn result_values(&mut self) {
        self.in_parts(Formulas::result_values);
        for k in std::mem::take(&mut self.result_order) {
            let formula = self.results[k].formula;
            let context = result_context(self.results[k].dimensional);
            let source = self.reporter.sources.get(formula.span.file);
            // A search condition decides nothing about a variant. Where it is not finite, it does not hold.
            self.branch.is_untaken = source.is_option && source.name == UNTIL;
            let value = self.formula(formula, &context);
            self.branch.is_untaken = false;
            self.results[k].value = value;
        }
    }

    /// Evaluates a call if it is a reduction. (A separate function, as nested formulas have no stack for its locals.)
    pub(super) fn call_of_reduction(
        &mut self,
        e: &Expr,
        (name, window): (&Name, Option<&Window>),
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Result<Option<Value>, NotAReduction> {
        let word = self.scope.reduction_word(name, arguments.len()).ok_or(NotAReduction)?;
        if context.results {
            return Ok(self.reduction(e, (word, name), (arguments, window), context));
        }
        // With one argument too few it compares values.
        let compares = self.scope.is_of_language(&name.text) && window.is_none();
        let means_itself = matches!(self.scope.get(&name.text), None | Some(Entity::Param(_) | Entity::Measure(_)));
        if compares || !means_itself {
            return Err(NotAReduction);
        }
        self.reporter.report(errors::reduction_in(context.place, word, e.span));
        Ok(None)
    }

    /// Evaluates `max(e)` or `at(e, T)`: one number for the whole analysis.
    fn reduction(
        &mut self,
        e: &Expr,
        (word, written): (&'static ReductionWord, &Name),
        (arguments, window): (&[Expr], Option<&Window>),
        context: &Context<'_>,
    ) -> Option<Value> {
        if arguments.len() != word.arguments {
            let name = word.word.name;
            self.reporter.report(errors::argument_count(name, Some(&word.word), e.span, word.takes, arguments.len()));
            return None;
        }
        reject_window(&mut self.reporter, written, window.filter(|_| word.takes_time()))?;
        let conditions = self.model.conditions.len();
        let inner = Context { place: "a reduction", results: true, ..measure_context(context.judged) };
        let of = self.number(&arguments[0], &inner);
        let conditions = self.conditions_in_time(conditions, "");
        let at = match arguments.get(1) {
            Some(time) => Some(self.time_in_analysis(time, "the second argument of `at`")?),
            None => None,
        };
        let window = match window {
            Some(window) => self.window(word, window)?,
            None => [None; 2],
        };
        let of = of?;
        let kind = kind(word.word.name, at)?;
        let dim = match kind {
            ReductionKind::ArgMax | ReductionKind::ArgMin => Dim::Of(Dimension::TIME),
            ReductionKind::Integral => of.dim.map(|dimension| dimension.times(Dimension::TIME)),
            _ => of.dim.of_term(),
        };
        Some(Value { id: self.reduction_symbol(kind, of.id, window, e.span, &conditions), dim })
    }

    /// Returns the symbol of a reduction, which is added unless it exists.
    pub(in crate::check) fn reduction_symbol(
        &mut self,
        kind: ReductionKind,
        of: ExprId,
        window: [Option<ExprId>; 2],
        span: Span,
        conditions: &[Condition],
    ) -> ExprId {
        let is_same = |other: &Reduction| other.kind == kind && other.of == of && other.window == window;
        let existing = self.model.reductions.iter().position(is_same);
        let k = existing.unwrap_or_else(|| {
            let (order, conditions) = (self.derivative_order(of), conditions.to_vec());
            self.model.reductions.push(Reduction { kind, span, of, window, order, conditions });
            self.model.reductions.len() - 1
        });
        self.name_symbol(Named::Reduction(k as u32), 0)
    }

    /// Returns whether a formula is one number for the whole analysis: it holds reductions, and nothing else that varies.
    pub(in crate::check) fn is_of_whole_analysis(&self, id: ExprId) -> bool {
        let symbols = self.model.graph.symbols(id);
        let is_reduction = |k: u32| matches!(self.model.named.get(k as usize), Some(Named::Reduction(_)));
        let changes = |symbol: &Symbol| match symbol {
            Symbol::Param(_) | Symbol::Shift(_) => false,
            Symbol::Named(k) => !is_reduction(*k),
            Symbol::Time
            | Symbol::Signal { .. }
            | Symbol::Coordinate { .. }
            | Symbol::Varied { .. }
            | Symbol::Multiplier(_)
            | Symbol::VariedMultiplier { .. } => true,
        };
        !symbols.iter().any(changes)
    }

    /// Returns whether a formula holds a reduction.
    pub(in crate::check) fn holds_reduction(&self, id: ExprId) -> bool {
        self.holds_named(id, |named| matches!(named, Named::Reduction(_)))
    }

    /// Evaluates the bounds of a reduction's window.
    fn window(&mut self, word: &'static ReductionWord, window: &Window) -> Option<[Option<ExprId>; 2]> {
        let mut read = |bound: &Option<Expr>, place: &str| match bound {
            Some(bound) => self.time_in_analysis(bound, place).map(Some),
            None => Some(None),
        };
        let bounds = [read(&window.from, "the `from` of a window"), read(&window.to, "the `to` of a window")];
        let [from, to] = bounds;
        let bounds = [from?, to?];
        if let [Some(from), Some(to)] = bounds {
            let length = self.model.graph.sub(to, from);
            let is_negative = self.decided(length, GuardKind::Sign).is_some_and(|length| length < 0.0);
            let times = [self.number_of(from), self.number_of(to)];
            if let ([Some(from), Some(to)], true, false) = (times, is_negative, self.branch.is_untaken) {
                self.reporter.report(errors::window_ends_early(word, window.span, [from, to]));
                return None;
            }
        }
        Some(bounds)
    }

    /// Evaluates a time within the analysis, over params and other reductions.
    fn time_in_analysis(&mut self, time: &Expr, place: &str) -> Option<ExprId> {
        let judged = self.is_dimensional(time);
        let context = Context { judged, ..result_context(judged) };
        let context = context.at(place, None);
        let value = self.number(time, &context)?;
        // Reductions have dimensions in plain formulas too.
        let judged = self.counts(value, &context);
        require_dimension(
            &mut self.reporter,
            place,
            Dimension::TIME,
            time.span,
            value.dim,
            &Context { judged, ..context },
        )?;
        Some(value.id)
    }
}

fn kind(word: &str, at: Option<ExprId>) -> Option<ReductionKind> {
    Some(match word {
        "max" => ReductionKind::Max,
        "min" => ReductionKind::Min,
        "argmax" => ReductionKind::ArgMax,
        "argmin" => ReductionKind::ArgMin,
        "mean" => ReductionKind::Mean,
        "rms" => ReductionKind::Rms,
        "integral" => ReductionKind::Integral,
        "first" => ReductionKind::First,
        "last" => ReductionKind::Last,
        _ => ReductionKind::At(at?),
    })
}

/// Returns the context in which the formula of a result is read.
fn result_context(judged: bool) -> Context<'static> {
    Context { judged, results: true, ..Context::constant("a result") }
}

/// Reports the window of a call that takes none.
pub(in crate::check) fn reject_window(
    reporter: &mut Reporter<'_>,
    called: &Name,
    window: Option<&Window>,
) -> Option<()> {
    let Some(window) = window else { return Some(()) };
    reporter.report(errors::window_of_no_reduction(called, window.span));
    None
}
