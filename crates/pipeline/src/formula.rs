//! Formulas of time with their first two derivatives, as text and as numbers.
//!
//! The numbers are those of a driver with this formula. The text is simplified for readers, and differs from them by rounding only.

use mechc_expr::{ExprId, Graph, Printer, Symbol, number};
use mechc_lang::check::{self, FormulaOfTime};
use mechc_lang::model::{Condition, Dimension};
use mechc_syntax as syntax;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error};
use mechc_text::source::{Sources, Span};
use rustc_hash::FxHashMap;

/// Names of the formula and its derivatives.
pub const NAMES: [&str; 3] = ["C", "C'", "C''"];

/// Formulas with more nodes than this are not simplified.
const LARGEST_TIDY: u64 = 5_000;

/// Formulas with more nodes than this name their shared parts.
const LARGEST_WHOLE: u64 = 150;

/// A formula with its first two time derivatives.
#[derive(Clone)]
pub struct Formula {
    graph: Graph,
    roots: [ExprId; 3],
    dimension: Dimension,
    is_dimensional: bool,
    conditions: Vec<Condition>,
    remarks: Diagnostics,
    span: Span,
    /// The texts that `span` and the conditions point into.
    sources: Sources,
}

impl Formula {
    /// Reads a formula of `t`, with the constants, units and functions of the language.
    ///
    /// # Errors
    /// The text does not follow the grammar, or has no meaning.
    pub fn parse(text: &str, sources: &mut Sources) -> Result<Formula, Error> {
        let file = sources.add_option("EXPR", text);
        let refused = |why: Diagnostics| Error::new(why, sources);
        let tree = syntax::parse_expression(sources, file).map_err(refused)?;
        let FormulaOfTime { mut graph, value, dimension, is_dimensional, conditions, remarks } =
            check::formula_of_time(&tree, sources).map_err(refused)?;
        let mut derivative = |formula: ExprId| {
            let slopes =
                graph.derivatives(&[formula], |graph, symbol| (symbol == Symbol::Time).then(|| graph.constant(1.0)));
            slopes.first().copied().unwrap_or(formula)
        };
        let first = derivative(value);
        let second = derivative(first);
        for (order, id) in [value, first, second].into_iter().enumerate() {
            // a constant may be NaN, as the derivative of `t / 0`
            if graph.dependence(id).is_constant() && !graph.value(id, |_| 0.0).is_finite() {
                return Err(refused(not_finite(tree.span, order, graph.value(id, |_| 0.0), None).into()));
            }
        }
        Ok(Formula {
            graph,
            roots: [value, first, second],
            dimension,
            is_dimensional,
            conditions,
            remarks,
            span: tree.span,
            sources: sources.clone(),
        })
    }

    /// Returns warnings of the formula, as of degrees that were probably intended.
    #[must_use]
    pub fn remarks(&self) -> &Diagnostics {
        &self.remarks
    }

    /// Returns the dimension, if numbers without units are pure.
    pub(crate) fn pure_dimension(&self) -> Dimension {
        self.dimension
    }

    /// Returns the dimension; `None` if the formula has no unit of length, time or mass.
    pub(crate) fn known_dimension(&self) -> Option<Dimension> {
        self.is_dimensional.then_some(self.dimension)
    }

    /// Returns the values at a time (s).
    ///
    /// # Errors
    /// A value is not finite, or the formula has no meaning there.
    pub fn values(&self, t: f64) -> Result<[f64; 3], Error> {
        let mut values = Vec::new();
        self.graph.extend_values(&mut values, |_| t);
        let value = |id: ExprId| values.get(id.index()).copied().unwrap_or(f64::NAN);
        for condition in &self.conditions {
            let positive = value(condition.positive);
            if positive.is_nan() || positive <= 0.0 {
                return Err(Error::new(empty_interval(condition.span, t), &self.sources));
            }
        }
        let values = self.roots.map(value);
        match values.iter().position(|value| !value.is_finite()) {
            Some(order) => Err(Error::new(not_finite(self.span, order, values[order], Some(t)), &self.sources)),
            None => Ok(values),
        }
    }

    /// Writes a line for the formula, each derivative, and each shared part.
    #[must_use]
    pub fn text(&self) -> String {
        let (mut graph, mut roots) = (self.graph.clone(), self.roots);
        if graph.written_size(&roots) <= LARGEST_TIDY {
            roots = roots.map(|root| graph.tidied(root));
        }
        let mut printer = Printer::new(&graph, name_of);
        let mut parts = Vec::new();
        if graph.written_size(&roots) > LARGEST_WHOLE {
            parts = named(printer.name_shared(&roots, |_| String::new()), roots[0]);
            let names: FxHashMap<ExprId, String> = parts.iter().map(|(name, id)| (*id, name.clone())).collect();
            printer = Printer::new(&graph, name_of).with_names(&names);
        }
        // the formula is not a part of itself
        let mut texts = vec![printer.definition(roots[0])];
        texts.extend(roots.iter().skip(1).map(|root| printer.text(*root)));
        let mut text = definitions(NAMES.iter().copied().zip(texts));
        parts.retain(|(_, id)| *id != roots[0]);
        if !parts.is_empty() {
            let parts = parts.iter().map(|(name, id)| (name.as_str(), printer.definition(*id)));
            text += &format!("\nwith the parts that stand in several places\n\n{}", definitions(parts));
        }
        text
    }

    /// Describes its dimension and the units of its values; `None` if the formula has no unit.
    #[must_use]
    pub fn dimension(&self) -> Option<String> {
        self.known_dimension().map(dimension_line)
    }
}

/// Names a symbol; the only one is time.
fn name_of(_: Symbol) -> String {
    "t".to_owned()
}

/// Names the shared parts, in their order; the formula itself is `C` if it is among them.
fn named(shared: Vec<(String, ExprId)>, formula: ExprId) -> Vec<(String, ExprId)> {
    let mut count = 0;
    let mut name = |id: ExprId| {
        if id == formula {
            return NAMES[0].to_owned();
        }
        count += 1;
        format!("k{count}")
    };
    shared.into_iter().map(|(_, id)| (name(id), id)).collect()
}

/// Writes `C   = …`, a line each.
fn definitions<'n>(lines: impl Iterator<Item = (&'n str, String)>) -> String {
    let lines: Vec<(&str, String)> = lines.collect();
    let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    lines.iter().fold(String::new(), |all, (name, text)| all + &format!("{name:<width$} = {text}\n"))
}

/// Describes the dimension of the formula, and the units of its values.
fn dimension_line(dimension: Dimension) -> String {
    let words = dimension.in_words();
    // the unit follows
    let words = words.split(" (").next().unwrap_or(&words);
    let mut units = Vec::new();
    let mut of_derivative = dimension;
    for (order, name) in NAMES.iter().enumerate() {
        let pure = of_derivative.is(Dimension::PURE);
        match order {
            0 if pure => {}
            _ if pure => units.push(format!("{name} a pure number")),
            _ => units.push(format!("{name} in {}", of_derivative.unit())),
        }
        of_derivative = of_derivative.over(Dimension::TIME);
    }
    format!("dimension: {words}; {}", units.join(", "))
}

/// Reports a value that is not finite, at a time (s) or at any.
fn not_finite(span: Span, order: usize, value: f64, t: Option<f64>) -> Diagnostic {
    let what = ["the formula", "the first derivative of the formula", "the second derivative of the formula"];
    let (what, name) = (what[order], NAMES[order]);
    let kind = if value.is_nan() { "not a number" } else { "infinite" };
    let when = t.map_or("at any time".to_owned(), |t| format!("at t = {} s", number(t)));
    let diagnostic = Diagnostic::new(Code::E0605, format!("{what} is not finite {when}"));
    let diagnostic = diagnostic.at(span, format!("{name} is {kind}"));
    match t {
        Some(t) => diagnostic.datum("t", t),
        None => diagnostic,
    }
}

fn empty_interval(span: Span, t: f64) -> Diagnostic {
    Diagnostic::new(Code::E0606, format!("the interval of a motion is empty at t = {} s", number(t)))
        .at(span, "not after the start of the interval")
        .help("the arguments are `(u, u0, v0, u1, v1)`, with `u0 < u1`")
        .datum("t", t)
}
