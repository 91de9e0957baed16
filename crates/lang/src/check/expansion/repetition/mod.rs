//! Repetition: repeated declarations are expanded into copies, and paths like `link[k - 1].pin` become the names of copies. All other
//! modules of `check` only know plain declarations.

mod copies;
mod paths;

use super::instance::{Copies, Instance};
use crate::check::errors;
use crate::check::formulas::Formulas;
use crate::check::scope::is_constant;
use crate::check::scope::name_of;
use crate::model::Dimension;
use mechc_syntax::ast::{self, Expr, ExprKind, Factor, Item, ItemKind, Mechanism, Name, Sign};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, Unit};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// The largest number of declarations of a mechanism with its parts, after expansion.
pub(in crate::check) const MOST: usize = 1_000_000;

/// The largest number of indices of a declaration, all of which stand in the names of its copies.
const MOST_INDICES: usize = 16;

/// The allowed distance of an index from an integer, because of rounding.
const WHOLE: f64 = 1e-9;

/// Returns whether a mechanism has repetitions or parts.
pub(in crate::check) fn needs_expansion(tree: &Mechanism) -> bool {
    tree.items.iter().any(|item| !item.ranges.is_empty() || matches!(item.kind, ItemKind::Part(_)))
}

/// The indices of a copy with their names.
pub(in crate::check) type Numbers<'t> = Vec<(&'t str, i64)>;

/// The expansion of one mechanism.
pub(in crate::check) struct Expander<'t, 'c> {
    tree: &'t Mechanism,
    /// The params, functions and tables that ranges may use.
    definitions: Formulas<'c>,
    /// The names of the mechanism.
    names: FxHashSet<&'t str>,
    /// The indices of the copies of repeated declarations.
    copies: FxHashMap<&'t str, Copies>,
    /// The parts; `None` for one that cannot be instantiated, which has been reported.
    parts: FxHashMap<String, Option<Rc<Instance<'t>>>>,
    /// The paths into parts that formulas use.
    paths: FxHashSet<String>,
    /// The number of declarations so far.
    count: usize,
    /// True if the excess of declarations has been reported.
    is_too_large: bool,
    /// The locations of reported errors. An error in every copy is reported once.
    reported: FxHashSet<Span>,
}

/// A mechanism with all repetitions expanded, and the diagnostics.
type ExpandedMechanism = (Mechanism, Diagnostics);

/// A formula or declaration that cannot be expanded, which has been reported.
pub(in crate::check) struct NotExpandable;

type Expanded<T> = Result<T, NotExpandable>;

impl<'t, 'c> Expander<'t, 'c> {
    /// Returns the expansion of a mechanism; `definitions` are those that ranges may use.
    pub fn new(tree: &'t Mechanism, definitions: Formulas<'c>) -> Expander<'t, 'c> {
        Expander {
            tree,
            definitions,
            names: tree.items.iter().filter_map(name_of).map(|name| name.text.as_str()).collect(),
            copies: FxHashMap::default(),
            parts: FxHashMap::default(),
            paths: FxHashSet::default(),
            count: 0,
            is_too_large: false,
            reported: FxHashSet::default(),
        }
    }

    /// Returns the number of declarations after expansion.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the diagnostics so far.
    pub fn into_diagnostics(self) -> Diagnostics {
        self.definitions.reporter.diagnostics
    }

    /// Returns whether there are too many declarations.
    pub fn is_too_large(&self) -> bool {
        self.is_too_large
    }

    /// Returns the indices of the copies of each declaration; `None` if they cannot be determined.
    pub fn all_copies(&mut self, tree: &'t Mechanism) -> Vec<Option<Vec<Numbers<'t>>>> {
        let named = self.unique_names(tree);
        let items = tree.items.iter().zip(named);
        let copies: Vec<_> = items.map(|(item, is_named)| if is_named { self.copies(item) } else { None }).collect();
        for (item, copies) in tree.items.iter().zip(&copies) {
            if let (Some(name), Some(copies)) = (name_of(item).filter(|_| !item.ranges.is_empty()), copies) {
                let numbers = copies.iter().map(|numbers| numbers.iter().map(|(_, k)| *k).collect());
                self.copies.insert(&name.text, Rc::new(numbers.collect()));
            }
        }
        copies
    }

    /// Returns the value of a binding that determines a range; `None` if it is broken. This is reported here, as the declarations that
    /// could report it do not exist.
    pub fn number(&mut self, e: &Expr, numbers: &Numbers<'_>) -> Option<f64> {
        let formula = self.formula(e, numbers).ok()?;
        let before = self.definitions.reporter.diagnostics.len();
        let value = self.definitions.any_constant(&formula);
        if value.is_none() {
            self.report_part_dependence(e, "a binding that decides a range", before);
        }
        value
    }

    /// Returns the expanded mechanism, with its parts by their names, the copies' indices, and the paths into parts.
    pub fn written(
        mut self,
        tree: &'t Mechanism,
        copies: &[Option<Vec<Numbers<'t>>>],
        parts: FxHashMap<String, Option<Rc<Instance<'t>>>>,
    ) -> (ExpandedMechanism, FxHashMap<&'t str, Copies>, Vec<String>) {
        self.parts = parts;
        let mut items = Vec::new();
        for (item, copies) in tree.items.iter().zip(copies) {
            match copies {
                Some(copies) => items.extend(copies.iter().map(|numbers| self.copy(item, numbers))),
                None => items.push(broken(item, &Vec::new())),
            }
        }
        let written = Mechanism { items, docs: tree.docs.clone(), name: tree.name.clone(), span: tree.span };
        let mut paths: Vec<String> = self.paths.into_iter().collect();
        paths.sort_unstable();
        ((written, self.definitions.reporter.diagnostics), self.copies, paths)
    }

    fn report_once(&mut self, diagnostic: Diagnostic) {
        let span = diagnostic.labels.first().map(|label| label.span);
        if span.is_none_or(|span| self.reported.insert(span)) {
            self.definitions.reporter.report(diagnostic);
        }
    }

    /// Returns which declarations have a unique name. The check reports those that are not repeated.
    fn unique_names(&mut self, tree: &'t Mechanism) -> Vec<bool> {
        let mut first: FxHashMap<&str, (Span, bool)> = FxHashMap::default();
        let mut is_unique_index = |item: &'t Item| {
            let Some(name) = name_of(item) else { return true };
            let is_repeated = !item.ranges.is_empty();
            if is_repeated && is_constant(name) {
                self.report_once(errors::reserved(name, None, &[]));
                return false;
            }
            let (span, other) = *first.entry(&name.text).or_insert((name.span, is_repeated));
            let is_twice = span != name.span && (is_repeated || other);
            if is_twice {
                self.report_once(errors::declared_twice(name, span));
            }
            !is_twice
        };
        tree.items.iter().map(&mut is_unique_index).collect()
    }

    /// Returns the indices of each copy of a declaration; one copy without indices if it is not repeated, `None` if they cannot be
    /// determined.
    fn copies(&mut self, item: &'t Item) -> Option<Vec<Numbers<'t>>> {
        let mut copies: Vec<Numbers<'t>> = vec![Vec::new()];
        if let Some(range) = item.ranges.get(MOST_INDICES) {
            self.report_once(errors::too_many_indices(range.index.span, MOST_INDICES));
            return None;
        }
        for range in &item.ranges {
            if !self.is_unique_index(range, &item.ranges) {
                return None;
            }
            let mut longer = Vec::new();
            for numbers in copies {
                let [from, to] = self.bounds(range, &numbers)?;
                let more = usize::try_from(to.saturating_sub(from)).unwrap_or(0);
                let count = self.count.saturating_add(longer.len()).saturating_add(more);
                if count > MOST {
                    self.report_once(errors::too_many_declarations(range.index.span, MOST, "too large a range"));
                    self.is_too_large = true;
                    return None;
                }
                longer.extend((from..to).map(|k| {
                    let mut numbers = numbers.clone();
                    numbers.push((range.index.text.as_str(), k));
                    numbers
                }));
            }
            copies = longer;
        }
        self.count += copies.len();
        Some(copies)
    }

    /// Returns whether an index has a unique name.
    fn is_unique_index(&mut self, range: &ast::IndexRange, all: &[ast::IndexRange]) -> bool {
        let name = &range.index;
        let before = all.iter().take_while(|other| other.index.span != name.span);
        let is_duplicate = before.into_iter().any(|other| other.index.text == name.text);
        // An index stands for its number before formulas are read: beside a unit of its name it would be silently a divisor.
        let is_word = |name: &str| Constant::named(name).is_some() || Unit::named(name).is_some();
        let is_unique_index = !is_word(&name.text) && !self.names.contains(name.text.as_str()) && !is_duplicate;
        if !is_unique_index {
            let is_free = |word: &&&str| {
                let is_index = all.iter().any(|other| other.index.text == **word);
                !is_index && !is_word(word) && !self.names.contains(**word)
            };
            let free: Vec<&str> = ["i", "j", "k", "n", "p", "q"].iter().filter(is_free).take(3).copied().collect();
            self.report_once(errors::index_is_taken(name, &free));
        }
        is_unique_index
    }

    /// Returns the first index, and the one after the last.
    fn bounds(&mut self, range: &ast::IndexRange, numbers: &Numbers<'_>) -> Option<[i64; 2]> {
        let from = self.whole_number(&range.from, numbers, "a bound of a range").ok()?;
        let to = self.whole_number(&range.to, numbers, "a bound of a range").ok()?;
        Some([from, if range.is_closed { to.saturating_add(1) } else { to }])
    }

    fn whole_number(&mut self, e: &Expr, numbers: &Numbers<'_>, place: &str) -> Expanded<i64> {
        let value = if let Some(value) = simple(e, numbers) {
            value
        } else {
            let formula = self.formula(e, numbers)?;
            let before = self.definitions.reporter.diagnostics.len();
            match self.definitions.constant(&formula, place, Dimension::PURE) {
                Some((_, value)) => value,
                None => return Err(self.report_part_dependence(e, place, before)),
            }
        };
        let whole = value.round();
        if !value.is_finite() || (value - whole).abs() > WHOLE || whole.abs() > 1e15 {
            self.report_once(errors::not_whole(place, e.span, value, numbers));
            return Err(NotExpandable);
        }
        Ok(whole as i64)
    }

    /// Reports that a number depends on a declaration in a part, in place of the diagnostics from `before` on, if it does.
    pub fn report_part_dependence(&mut self, e: &Expr, place: &str, before: usize) -> NotExpandable {
        if let Some(path) = path_into_part(self.tree, e) {
            self.definitions.reporter.diagnostics.truncate(before);
            let text = self.definitions.reporter.text(path);
            let diagnostic = errors::decided_by_a_part(place, text, e.span, path);
            self.report_once(diagnostic);
        }
        NotExpandable
    }
}

/// Returns a declaration, or a copy of it, that cannot be expanded, which has been reported.
pub(in crate::check) fn broken(item: &Item, numbers: &Numbers<'_>) -> Item {
    let names = name_of(item).map(|name| named(name, numbers)).into_iter().collect();
    Item { docs: Vec::new(), span: item.span, ranges: Vec::new(), kind: ItemKind::Broken { names } }
}

/// Returns the name of a copy.
pub(in crate::check) fn named(name: &Name, numbers: &Numbers<'_>) -> Name {
    if numbers.is_empty() {
        return name.clone();
    }
    let numbers: Vec<i64> = numbers.iter().map(|(_, k)| *k).collect();
    Name { text: indexed(&name.text, &numbers), span: name.span }
}

/// Returns a name such as `grid[1,3]`.
fn indexed(name: &str, numbers: &[i64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(i64::to_string).collect();
    format!("{name}[{}]", numbers.join(","))
}

/// Returns the location of a path into a part in a formula, also through other definitions.
fn path_into_part(tree: &Mechanism, formula: &Expr) -> Option<Span> {
    let item = |name: &Name| tree.items.iter().find(|item| name_of(item).is_some_and(|other| other.text == name.text));
    let is_part = |name: &Name| item(name).is_some_and(|item| matches!(item.kind, ItemKind::Part(_)));
    let (mut open, mut visited) = (vec![formula], FxHashSet::default());
    while let Some(e) = open.pop() {
        let (owner, is_path) = match &e.kind {
            ExprKind::Name(name) | ExprKind::Call { name, .. } => (Some(name), false),
            ExprKind::Member { owner, .. } => (Some(owner), true),
            ExprKind::Path(segments) => (segments.first().map(|first| &first.name), true),
            _ => (None, false),
        };
        if let Some(name) = owner {
            if is_path && is_part(name) {
                return Some(e.span);
            }
            if visited.insert(&name.text) {
                open.extend(item(name).map(Item::formulas).unwrap_or_default());
            }
        }
        open.extend(e.children());
    }
    None
}

/// Returns the value of a formula of numbers alone, as most indices are.
fn simple(e: &Expr, numbers: &Numbers<'_>) -> Option<f64> {
    Some(match &e.kind {
        ExprKind::Literal { value, unit: None } => *value,
        ExprKind::Name(name) => numbers.iter().find(|(index, _)| *index == name.text)?.1 as f64,
        ExprKind::Paren(inner) => simple(inner, numbers)?,
        ExprKind::Negate(inner) => -simple(inner, numbers)?,
        ExprKind::Sum(first, rest) => rest.iter().try_fold(simple(first, numbers)?, |sum, (sign, term)| {
            let term = simple(term, numbers)?;
            Some(if *sign == Sign::Plus { sum + term } else { sum - term })
        })?,
        ExprKind::Product(first, rest) => {
            rest.iter().try_fold(simple(first, numbers)?, |product, (kind, factor)| {
                let factor = simple(factor, numbers)?;
                (*kind == Factor::Times).then_some(product * factor)
            })?
        }
        _ => return None,
    })
}
