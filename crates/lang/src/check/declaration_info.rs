//! Information on single declarations for editors: coordinates, equations, and the values of params. It is available in spite of errors
//! elsewhere, and leaves out what an error makes uncertain.

use super::expansion::{Instance, definitions_of, instance_of};
use super::formulas::{Context, Dim, Formulas, InitialPoint, ParamState};
use super::options::CheckOptions;
use super::scope::{Entity, name_of};
use crate::model::{CompoundUnit, Named};
use mechc_expr::{ExprId, Printer, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, IndexRange, Item, ItemKind, Mechanism};
use mechc_syntax::keywords_in;
use mechc_text::source::{Sources, Span};
use mechc_text::vocabulary::{Dimension, JointSpec, Unit};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The largest size of derivatives that are shown, in graph nodes written out.
const LARGEST_WRITTEN: u64 = 150;

/// Information on a mechanism's declarations.
#[derive(Clone, Debug, Default)]
pub struct DeclarationInfo {
    /// Coordinates minus equations; `None` if a broken declaration may contribute some.
    pub freedom: Option<i64>,
    /// The contribution of each declaration that contributes, in the order of the text.
    pub counts: Vec<DeclarationCount>,
    /// The indices of repeated declarations.
    pub indices: Vec<Index>,
    /// The values of params and of the angles of poses.
    pub values: Vec<Value>,
}

/// The coordinates and equations that a declaration contributes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct DeclarationCount {
    /// The location of the declaration.
    pub declaration: Span,
    /// The location of its name.
    pub name: Span,
    /// True if it is a body.
    pub is_body: bool,
    /// Coordinates minus equations, summed over all copies.
    pub freedom: i64,
    /// The number of copies; `None` if the declaration is not repeated.
    pub copies: Option<usize>,
}

/// The index of a repeated declaration.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Index {
    /// The location of the range.
    pub range: Span,
    /// The name of the index.
    pub name: String,
    /// The first and the last value.
    pub ends: [i64; 2],
}

/// The value of a constant formula.
#[derive(Clone, Debug)]
pub struct Value {
    /// The location of the name, if a param declares it.
    pub name: Option<Span>,
    /// The location of the formula.
    pub formula: Span,
    /// True if the formula is a number with or without a unit, or a point of two such numbers.
    pub is_number: bool,
    /// The value.
    pub amount: Amount,
}

/// A value in SI units.
#[derive(Clone, Debug)]
pub enum Amount {
    /// A number.
    Number {
        /// The number in SI units.
        si: f64,
        /// The dimension.
        dimension: Dimension,
        /// The first unit of this dimension in the formula.
        unit: Option<CompoundUnit>,
    },
    /// A point of the drawing (m).
    Point([f64; 2]),
}

/// Returns information on the declarations of a mechanism.
#[must_use]
pub fn known(tree: &Mechanism, options: &CheckOptions, sources: &Sources) -> DeclarationInfo {
    let (instance, _) = instance_of(tree, options, sources);
    let mut counter = Counter { sources, totals: FxHashMap::default() };
    let freedom = counter.total(&instance);
    let copies = counter.count_each(&instance);
    let counts = tree.items.iter().filter_map(|item| count(item, copies.get(&item.span)?)).collect();
    let definitions = definitions_of(tree);
    let mut formulas = Formulas::new(&definitions, options, sources);
    formulas.scope.collect(&mut formulas.reporter);
    formulas.definitions();
    let mut values = param_values(&mut formulas);
    values.extend(tree.items.iter().filter_map(|item| angle_of_pose(&mut formulas, item)));
    values.sort_by_key(|value| value.formula);
    let indices = tree.items.iter().flat_map(|item| indices(item, &instance)).collect();
    DeclarationInfo { freedom, counts, indices, values }
}

/// Sums the coordinates minus the equations of declarations.
struct Counter<'s> {
    sources: &'s Sources,
    /// The sums of mechanisms with all their parts; copies share one.
    totals: FxHashMap<*const (), Option<i64>>,
}

/// The sum of a declaration's copies, `None` if it is uncertain, and their number.
type Copies = (Option<i64>, usize);

impl Counter<'_> {
    /// Returns the sum of a mechanism with its parts. Their depth is limited elsewhere.
    fn total(&mut self, instance: &Instance<'_>) -> Option<i64> {
        let key = std::ptr::from_ref(instance).cast();
        if let Some(cached) = self.totals.get(&key) {
            return *cached;
        }
        let mut of_items = instance.tree().items.iter().map(|item| self.count_item(item, instance));
        let total = of_items.try_fold(0_i64, |sum, freedom| Some(sum.saturating_add(freedom?)));
        self.totals.insert(key, total);
        total
    }

    fn count_each(&mut self, instance: &Instance<'_>) -> FxHashMap<Span, Copies> {
        let mut all: FxHashMap<Span, Copies> = FxHashMap::default();
        for item in &instance.tree().items {
            let freedom = self.count_item(item, instance);
            let (sum, copies) = all.entry(item.span).or_insert((Some(0), 0));
            *sum = sum.zip(freedom).map(|(sum, freedom)| sum.saturating_add(freedom));
            *copies += 1;
        }
        all
    }

    fn count_item(&mut self, item: &Item, instance: &Instance<'_>) -> Option<i64> {
        match &item.kind {
            ItemKind::Body { .. } => Some(3),
            ItemKind::Equation { .. } => Some(-1),
            ItemKind::Joint { kind, .. } => {
                let word = JointSpec::named(&kind.text)?;
                Some(word.coordinates.len().cast_signed() as i64 - word.rows.len().cast_signed() as i64)
            }
            ItemKind::Part(part) => {
                let part = Rc::clone(instance.part(&part.name.text)?);
                self.total(&part)
            }
            ItemKind::Broken { .. } => has_no_freedom(item, instance.mechanism, self.sources).then_some(0),
            _ => Some(0),
        }
    }
}

/// Returns whether a declaration that cannot be parsed or repeated contributes neither coordinates nor equations.
fn has_no_freedom(item: &Item, text: &Mechanism, sources: &Sources) -> bool {
    let written = text.items.iter().find(|other| other.span == item.span);
    match written.map(|written| &written.kind) {
        None | Some(ItemKind::Broken { .. }) => {
            let first = keywords_in(sources.text(item.span)).next();
            let word = first.filter(|(at, _)| *at == 0).map_or("", |(_, keyword)| keyword.word.name);
            ["param", "fn", "table", "input", "ground", "measure", "trace", "result", "analysis"].contains(&word)
        }
        Some(kind) => !matches!(
            kind,
            ItemKind::Body { .. } | ItemKind::Joint { .. } | ItemKind::Equation { .. } | ItemKind::Part(_)
        ),
    }
}

fn count(item: &Item, &(freedom, copies): &Copies) -> Option<DeclarationCount> {
    let brings = matches!(
        item.kind,
        ItemKind::Body { .. } | ItemKind::Joint { .. } | ItemKind::Equation { .. } | ItemKind::Part(_)
    );
    let copies = (!item.ranges.is_empty()).then_some(copies);
    let is_body = matches!(item.kind, ItemKind::Body { .. });
    let name = name_of(item).filter(|_| brings)?.span;
    Some(DeclarationCount { declaration: item.span, name, is_body, freedom: freedom?, copies })
}

/// Returns the indices of a repeated declaration, each with its least and greatest value.
fn indices(item: &Item, instance: &Instance<'_>) -> Vec<Index> {
    let copies = name_of(item).and_then(|name| instance.copies.get(name.text.as_str()));
    let Some(copies) = copies.filter(|copies| !copies.is_empty() && !item.ranges.is_empty()) else {
        return Vec::new();
    };
    let of_range = |(k, range): (usize, &IndexRange)| {
        let numbers = || copies.iter().filter_map(|numbers| numbers.get(k));
        let ends = [*numbers().min()?, *numbers().max()?];
        let range_span = range.from.span.to(range.to.span);
        Some(Index { range: range_span, name: range.index.text.clone(), ends })
    };
    item.ranges.iter().enumerate().filter_map(of_range).collect()
}

fn param_values(formulas: &mut Formulas<'_>) -> Vec<Value> {
    let values = (0..formulas.params.len()).filter_map(|k| {
        let param = formulas.params[k];
        let (name, formula) = param.written?;
        let amount = amount_of_param(formulas, &param, formula)?;
        Some(Value { name: Some(name.span), formula: formula.span, is_number: is_number(formula), amount })
    });
    values.collect()
}

fn amount_of_param(formulas: &mut Formulas<'_>, param: &ParamState<'_>, formula: &Expr) -> Option<Amount> {
    if let Some(InitialPoint { at: [x, y], .. }) = param.drawn {
        return Some(Amount::Point([formulas.constant_value(x)?, formulas.constant_value(y)?]));
    }
    let value = param.value?;
    let dimension = value.dim.settled();
    let si = formulas.constant_value(value.id)?;
    let unit = unit_in(formula, dimension, |name| formulas.scope.get(name).is_some());
    si.is_finite().then_some(Amount::Number { si, dimension, unit })
}

/// Returns the angle of a pose, unless it is given in degrees.
fn angle_of_pose(formulas: &mut Formulas<'_>, item: &Item) -> Option<Value> {
    let at = match &item.kind {
        ItemKind::Body { pose, .. } if item.ranges.is_empty() => &pose.as_ref()?.at,
        ItemKind::Part(part) if item.ranges.is_empty() => part.at.as_ref()?,
        _ => return None,
    };
    let ExprKind::Tuple(parts) = &at.bare().kind else { return None };
    let phi = parts.last()?;
    if phi.bare_number() == Some(0.0) || is_degrees(phi) {
        return None;
    }
    let si = formulas.any_constant(phi).filter(|si| si.is_finite())?;
    let amount = Amount::Number { si, dimension: Dimension::ANGLE, unit: None };
    Some(Value { name: None, formula: phi.span, is_number: is_number(phi), amount })
}

/// Returns whether a formula is a number with or without a unit and sign, or a point of such numbers.
fn is_number(formula: &Expr) -> bool {
    match &formula.bare().kind {
        ExprKind::Literal { .. } => true,
        ExprKind::Negate(inner) => is_number(inner),
        ExprKind::Tuple(parts) => parts.iter().all(is_number),
        _ => false,
    }
}

fn is_degrees(formula: &Expr) -> bool {
    match &formula.bare().kind {
        ExprKind::Literal { unit: Some((unit, 1)), .. } => unit.text == "deg",
        ExprKind::Negate(inner) => is_degrees(inner),
        _ => false,
    }
}

/// Returns the first unit of a dimension in a formula.
fn unit_in(formula: &Expr, expected: Dimension, is_declared: impl Fn(&str) -> bool) -> Option<CompoundUnit> {
    let mut open = vec![formula];
    while let Some(e) = open.pop() {
        let (name, power) = match &e.kind {
            ExprKind::Literal { unit: Some((name, power)), .. } => (name, *power),
            ExprKind::Name(name) if !is_declared(&name.text) => (name, 1),
            _ => {
                open.extend(e.children().into_iter().rev());
                continue;
            }
        };
        let fits = |unit: &&Unit| unit.dimension.to_the(f64::from(power)).is(expected);
        if let Some(unit) = Unit::named(&name.text).filter(fits) {
            return Some(CompoundUnit::new(vec![(unit, power)]));
        }
    }
    None
}

/// Returns the first two derivatives of a `fn` by its argument as text; `None` if it cannot be read or they are too long.
#[must_use]
pub fn slopes(tree: &Mechanism, function: &str, options: &CheckOptions, sources: &Sources) -> Option<[String; 2]> {
    let definitions = definitions_of(tree);
    let mut formulas = Formulas::new(&definitions, options, sources);
    formulas.scope.collect(&mut formulas.reporter);
    formulas.definitions();
    let Some(Entity::Function(k)) = formulas.scope.get(function) else { return None };
    let (argument, formula, judged) = {
        let function = &formulas.functions[k];
        (function.argument, function.value, function.dimensional)
    };
    let symbol = formulas.name_symbol(Named::Argument, 0);
    let argument_value = super::formulas::Value { id: symbol, dim: Dim::PURE };
    let argument_named = Some((argument.text.as_str(), argument_value));
    let context =
        Context { judged, time: true, inputs: true, argument: argument_named, ..Context::constant("a function") };
    let value = formulas.formula(formula, &context)?;
    let Formulas { model, .. } = formulas;
    let mut graph = model.graph;
    let is_argument = |symbol: Symbol| matches!(symbol, Symbol::Named(k) if model.named[k as usize] == Named::Argument);
    let mut derivative = |of: ExprId| {
        let slopes = graph.derivatives(&[of], |graph, symbol| is_argument(symbol).then(|| graph.constant(1.0)));
        slopes.first().copied()
    };
    let first = derivative(value.id)?;
    let second = derivative(first)?;
    if graph.written_size(&[first, second]) > LARGEST_WRITTEN {
        return None;
    }
    let [first, second] = [first, second].map(|id| graph.tidied(id));
    let printer = Printer::new(&graph, |symbol| match symbol {
        Symbol::Param(k) => model.params[k as usize].declared.name.clone(),
        Symbol::Named(_) => argument.text.clone(),
        Symbol::Time | Symbol::Signal { .. } => "t".to_owned(),
        Symbol::Coordinate { .. }
        | Symbol::Varied { .. }
        | Symbol::Shift(_)
        | Symbol::Multiplier(_)
        | Symbol::VariedMultiplier { .. } => "0".to_owned(),
    });
    Some([printer.text(first), printer.text(second)])
}
