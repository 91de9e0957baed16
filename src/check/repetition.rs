//! Repetition: declarations that stand for one for each whole number are written out, and paths like `link[k - 1].pin` become the
//! names that the copies have. All else of `check` knows plain declarations alone.

use super::instance::{Copies, Instance};
use super::mentions::name_of;
use super::{Checker, errors};
use crate::diag::{Diagnostic, Diagnostics};
use crate::model::Dimension;
use crate::source::Span;
use crate::syntax::ast::{
    self, DrawnPose, Expr, ExprKind, Factor, Feature, FeatureKind, Item, ItemKind, Mechanism, Name, Sign, TableRows,
};
use crate::vocabulary::is_taken;
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// Declarations that a mechanism may have, written out, with those of its parts.
pub(super) const MOST: usize = 1_000_000;

/// Indices that a declaration may have: all of them stand in the names of its copies.
const MOST_INDICES: usize = 16;

/// How far a number may be from a whole one: rounding.
const WHOLE: f64 = 1e-9;

/// Whether something of a mechanism is repeated, or a part.
pub(super) fn needs_writing(tree: &Mechanism) -> bool {
    tree.items.iter().any(|item| !item.ranges.is_empty() || matches!(item.kind, ItemKind::Part(_)))
}

/// The numbers of a copy, each with what it is called.
pub(super) type Numbers<'t> = Vec<(&'t str, i64)>;

/// Writes out one mechanism.
pub(super) struct Writer<'t, 'c> {
    tree: &'t Mechanism,
    /// Knows the params.
    checker: Checker<'c>,
    /// The mechanism's names.
    names: FxHashSet<&'t str>,
    /// Of what is repeated: the numbers of its copies.
    copies: FxHashMap<&'t str, Copies>,
    /// Its parts; nothing where one cannot be, which has been said.
    parts: FxHashMap<String, Option<Rc<Instance<'t>>>>,
    /// What its formulas name in its parts.
    paths: FxHashSet<String>,
    /// Declarations so far.
    count: usize,
    /// Which has been said.
    is_too_large: bool,
    /// Where something was told already: what is wrong in every copy is told once.
    told: FxHashSet<Span>,
}

/// A mechanism with every repeated declaration written out, and what is wrong with the repetition.
type WrittenOut = (Mechanism, Diagnostics);

/// A formula or declaration that cannot be written out, which has been said.
pub(super) struct Unwritten;

type Written<T> = Result<T, Unwritten>;

impl<'t, 'c> Writer<'t, 'c> {
    /// With a reader of formulas that knows the mechanism's params.
    pub fn new(tree: &'t Mechanism, checker: Checker<'c>) -> Writer<'t, 'c> {
        Writer {
            tree,
            checker,
            names: tree.items.iter().filter_map(name_of).map(|name| name.text.as_str()).collect(),
            copies: FxHashMap::default(),
            parts: FxHashMap::default(),
            paths: FxHashSet::default(),
            count: 0,
            is_too_large: false,
            told: FxHashSet::default(),
        }
    }

    /// Declarations, written out.
    pub fn count(&self) -> usize {
        self.count
    }

    /// What is wrong so far.
    pub fn said(self) -> Diagnostics {
        self.checker.diagnostics
    }

    /// Whether there are too many.
    pub fn is_too_large(&self) -> bool {
        self.is_too_large
    }

    /// The numbers of the copies of each declaration; nothing where they cannot be told.
    pub fn all_copies(&mut self, tree: &'t Mechanism) -> Vec<Option<Vec<Numbers<'t>>>> {
        let named = self.have_names_of_their_own(tree);
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

    /// The value of what is bound of a param that decides a range; nothing where it is broken, which is told here: what it decides is
    /// never there to tell it.
    pub fn number(&mut self, e: &Expr, numbers: &Numbers<'_>) -> Option<f64> {
        let formula = self.formula(e, numbers).ok()?;
        let said = self.checker.diagnostics.len();
        let value = self.checker.any_constant(&formula);
        if value.is_none() {
            self.is_of_a_part(e, "a binding that decides a range", said);
        }
        value
    }

    /// The mechanism written out, with its parts by their names; the numbers of what is repeated; what its formulas name in its parts.
    pub fn written(
        mut self,
        tree: &'t Mechanism,
        copies: &[Option<Vec<Numbers<'t>>>],
        parts: FxHashMap<String, Option<Rc<Instance<'t>>>>,
    ) -> (WrittenOut, FxHashMap<&'t str, Copies>, Vec<String>) {
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
        ((written, self.checker.diagnostics), self.copies, paths)
    }

    fn tell(&mut self, diagnostic: Diagnostic) {
        let span = diagnostic.labels.first().map(|label| label.span);
        if span.is_none_or(|span| self.told.insert(span)) {
            self.checker.report(diagnostic);
        }
    }

    /// Which declarations have a name that is free; of those that are not repeated the rest of `check` says it.
    fn have_names_of_their_own(&mut self, tree: &'t Mechanism) -> Vec<bool> {
        let mut first: FxHashMap<&str, (Span, bool)> = FxHashMap::default();
        let mut is_free = |item: &'t Item| {
            let Some(name) = name_of(item) else { return true };
            let is_repeated = !item.ranges.is_empty();
            if is_repeated && is_taken(&name.text) {
                self.tell(errors::reserved(name, None, &[]));
                return false;
            }
            let (span, other) = *first.entry(&name.text).or_insert((name.span, is_repeated));
            let is_twice = span != name.span && (is_repeated || other);
            if is_twice {
                self.tell(errors::declared_twice(name, span));
            }
            !is_twice
        };
        tree.items.iter().map(&mut is_free).collect()
    }

    /// The numbers of each copy of a declaration; of one that is not repeated there is one, without numbers. None where that cannot
    /// be told.
    fn copies(&mut self, item: &'t Item) -> Option<Vec<Numbers<'t>>> {
        let mut copies: Vec<Numbers<'t>> = vec![Vec::new()];
        if let Some(range) = item.ranges.get(MOST_INDICES) {
            self.tell(errors::too_many_indices(range.index.span, MOST_INDICES));
            return None;
        }
        for range in &item.ranges {
            if !self.is_free(range, &item.ranges) {
                return None;
            }
            let mut longer = Vec::new();
            for numbers in copies {
                let [from, to] = self.bounds(range, &numbers)?;
                let more = usize::try_from(to.saturating_sub(from)).unwrap_or(0);
                let count = self.count.saturating_add(longer.len()).saturating_add(more);
                if count > MOST {
                    self.tell(errors::too_many_declarations(range.index.span, MOST, "too large a range"));
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

    /// Whether an index has a name of its own.
    fn is_free(&mut self, range: &ast::IndexRange, all: &[ast::IndexRange]) -> bool {
        let name = &range.index;
        let before = all.iter().take_while(|other| other.index.span != name.span);
        let is_again = before.into_iter().any(|other| other.index.text == name.text);
        let is_free = !is_taken(&name.text) && !self.names.contains(name.text.as_str()) && !is_again;
        if !is_free {
            self.tell(errors::index_is_taken(name));
        }
        is_free
    }

    /// The first number, and the one behind the last.
    fn bounds(&mut self, range: &ast::IndexRange, numbers: &Numbers<'_>) -> Option<[i64; 2]> {
        let from = self.whole_number(&range.from, numbers, "a bound of a range").ok()?;
        let to = self.whole_number(&range.to, numbers, "a bound of a range").ok()?;
        Some([from, if range.is_closed { to.saturating_add(1) } else { to }])
    }

    fn whole_number(&mut self, e: &Expr, numbers: &Numbers<'_>, place: &str) -> Written<i64> {
        let value = if let Some(value) = simple(e, numbers) {
            value
        } else {
            let formula = self.formula(e, numbers)?;
            let said = self.checker.diagnostics.len();
            match self.checker.constant(&formula, place, Dimension::PURE) {
                Some((_, value)) => value,
                None => return Err(self.is_of_a_part(e, place, said)),
            }
        };
        let whole = value.round();
        if !value.is_finite() || (value - whole).abs() > WHOLE || whole.abs() > 1e15 {
            self.tell(errors::not_whole(place, e.span, value, numbers));
            return Err(Unwritten);
        }
        Ok(whole as i64)
    }

    /// Says of a number that cannot be told that it is made of what a part has, if it is, rather than what was said of it.
    pub fn is_of_a_part(&mut self, e: &Expr, place: &str, said: usize) -> Unwritten {
        if let Some(path) = path_into_part(self.tree, e) {
            self.checker.diagnostics.truncate(said);
            let text = self.checker.sources.text(path);
            let diagnostic = errors::decided_by_a_part(place, text, e.span, path);
            self.tell(diagnostic);
        }
        Unwritten
    }

    /// A copy of a declaration; as broken, where something in it cannot be written out.
    fn copy(&mut self, item: &Item, numbers: &Numbers<'_>) -> Item {
        match self.kind(&item.kind, numbers) {
            Ok(kind) => Item { docs: item.docs.clone(), span: item.span, ranges: Vec::new(), kind },
            Err(Unwritten) => broken(item, numbers),
        }
    }

    fn kind(&mut self, kind: &ItemKind, numbers: &Numbers<'_>) -> Written<ItemKind> {
        let own = |name: &Name| named(name, numbers);
        Ok(match kind {
            ItemKind::Param { name, value } => {
                ItemKind::Param { name: name.clone(), value: self.formula(value, numbers)? }
            }
            ItemKind::Function { name, argument, value } => {
                let value = self.formula_over(argument, value)?;
                ItemKind::Function { name: name.clone(), argument: argument.clone(), value }
            }
            ItemKind::Table { name, periodic, rows: TableRows::Listed(rows) } => {
                let rows = TableRows::Listed(self.formulas(rows, numbers)?);
                ItemKind::Table { name: name.clone(), periodic: *periodic, rows }
            }
            ItemKind::Analysis { from, to, every } => ItemKind::Analysis {
                from: self.formula(from, numbers)?,
                to: self.formula(to, numbers)?,
                every: self.formula(every, numbers)?,
            },
            ItemKind::Input { name, value } => {
                ItemKind::Input { name: own(name), value: self.formula(value, numbers)? }
            }
            ItemKind::Measure { name, value, unit } => {
                ItemKind::Measure { name: own(name), value: self.formula(value, numbers)?, unit: unit.clone() }
            }
            ItemKind::Trace { name, point, unit } => {
                ItemKind::Trace { name: own(name), point: self.formula(point, numbers)?, unit: unit.clone() }
            }
            ItemKind::Result { name, value, unit } => {
                ItemKind::Result { name: own(name), value: self.formula(value, numbers)?, unit: unit.clone() }
            }
            ItemKind::Ground { features } => ItemKind::Ground { features: self.features(features, numbers)? },
            ItemKind::Body { name, pose, features } => ItemKind::Body {
                name: own(name),
                pose: pose.as_ref().map(|pose| self.pose(pose, numbers)).transpose()?,
                features: self.features(features, numbers)?,
            },
            ItemKind::Joint { name, kind, arguments, call_span } => ItemKind::Joint {
                name: own(name),
                kind: kind.clone(),
                arguments: self.formulas(arguments, numbers)?,
                call_span: *call_span,
            },
            ItemKind::Equation { driver, name, left, right } => ItemKind::Equation {
                driver: *driver,
                name: own(name),
                left: self.formula(left, numbers)?,
                right: self.formula(right, numbers)?,
            },
            ItemKind::Gravity { acceleration } => {
                ItemKind::Gravity { acceleration: self.formula(acceleration, numbers)? }
            }
            ItemKind::Load { name, force, on } => {
                ItemKind::Load { name: own(name), force: self.formula(force, numbers)?, on: self.formula(on, numbers)? }
            }
            ItemKind::Part(part) => ItemKind::Part(Box::new(self.part(part, numbers)?)),
            other => other.clone(),
        })
    }

    /// A part is broken where its mechanism is not known, which has been said.
    fn part(&mut self, part: &ast::Part, numbers: &Numbers<'_>) -> Written<ast::Part> {
        let name = named(&part.name, numbers);
        if self.parts.get(&name.text).is_none_or(Option::is_none) {
            return Err(Unwritten);
        }
        let binding = |binding: &ast::Binding| {
            Ok(ast::Binding { value: self.formula(&binding.value, numbers)?, ..binding.clone() })
        };
        let bindings = part.bindings.iter().map(binding).collect::<Written<_>>()?;
        let mut place = |e: &Option<Expr>| e.as_ref().map(|e| self.formula(e, numbers)).transpose();
        Ok(ast::Part { name, bindings, on: place(&part.on)?, at: place(&part.at)?, ..part.clone() })
    }

    fn features(&mut self, features: &[Feature], numbers: &Numbers<'_>) -> Written<Vec<Feature>> {
        let copy = |feature: &Feature| {
            let mut of = |e: &Expr| self.formula(e, numbers).map(Box::new);
            let kind = match &feature.kind {
                FeatureKind::Broken => FeatureKind::Broken,
                FeatureKind::Point { at } => {
                    FeatureKind::Point { at: at.as_ref().map(|e| self.formula(e, numbers)).transpose()? }
                }
                FeatureKind::AxisAlong { origin, direction } => {
                    FeatureKind::AxisAlong { origin: of(origin)?, direction: of(direction)? }
                }
                FeatureKind::AxisTo { origin, target } => {
                    FeatureKind::AxisTo { origin: of(origin)?, target: of(target)? }
                }
                FeatureKind::Circle { center, radius } => {
                    FeatureKind::Circle { center: of(center)?, radius: of(radius)? }
                }
                FeatureKind::Curve { argument, at, estimate } => FeatureKind::Curve {
                    argument: argument.clone(),
                    at: of(at)?,
                    estimate: estimate.as_deref().map(of).transpose()?,
                },
                FeatureKind::Mass { mass, at, inertia } => FeatureKind::Mass {
                    mass: of(mass)?,
                    at: at.as_deref().map(&mut of).transpose()?,
                    inertia: inertia.as_deref().map(of).transpose()?,
                },
            };
            Ok(Feature { docs: feature.docs.clone(), span: feature.span, name: feature.name.clone(), kind })
        };
        features.iter().map(copy).collect()
    }

    fn pose(&mut self, pose: &DrawnPose, numbers: &Numbers<'_>) -> Written<DrawnPose> {
        let toward = pose.toward.as_ref().map(|toward| self.formula(toward, numbers)).transpose()?;
        Ok(DrawnPose { at: self.formula(&pose.at, numbers)?, toward })
    }

    /// The formula of a function: its argument hides what is repeated.
    fn formula_over(&mut self, argument: &Name, formula: &Expr) -> Written<Expr> {
        let hidden = self.copies.remove_entry(argument.text.as_str());
        let written = self.formula(formula, &Vec::new());
        self.copies.extend(hidden);
        written
    }

    fn formulas(&mut self, list: &[Expr], numbers: &Numbers<'_>) -> Written<Vec<Expr>> {
        list.iter().map(|e| self.formula(e, numbers)).collect()
    }

    /// A formula with its numbers in the place of what they are called, and paths as names.
    fn formula(&mut self, e: &Expr, numbers: &Numbers<'_>) -> Written<Expr> {
        let mut boxed = |e: &Expr| self.formula(e, numbers).map(Box::new);
        let kind = match &e.kind {
            ExprKind::Literal { .. } => e.kind.clone(),
            ExprKind::Name(name) => {
                if let Some(&(_, k)) = numbers.iter().find(|(index, _)| *index == name.text) {
                    ExprKind::Literal { value: k as f64, unit: None }
                } else {
                    self.must_not_be_repeated(name)?;
                    e.kind.clone()
                }
            }
            ExprKind::Member { owner, feature } => {
                self.must_not_be_repeated(owner)?;
                match self.parts.get(&owner.text).cloned() {
                    Some(part) => {
                        let segment = ast::PathSegment { name: feature.clone(), indices: Vec::new() };
                        self.inside(e.span, &owner.text, part, &[segment], numbers)?
                    }
                    None => e.kind.clone(),
                }
            }
            ExprKind::Path(segments) => self.path(e.span, segments, numbers)?,
            ExprKind::Call { name, arguments } => {
                ExprKind::Call { name: name.clone(), arguments: self.formulas(arguments, numbers)? }
            }
            ExprKind::Paren(inner) => ExprKind::Paren(boxed(inner)?),
            ExprKind::Negate(inner) => ExprKind::Negate(boxed(inner)?),
            ExprKind::Not(inner) => ExprKind::Not(boxed(inner)?),
            ExprKind::Power(a, b) => ExprKind::Power(boxed(a)?, boxed(b)?),
            ExprKind::Compare(a, relation, b) => ExprKind::Compare(boxed(a)?, *relation, boxed(b)?),
            ExprKind::Tuple(list) => ExprKind::Tuple(self.formulas(list, numbers)?),
            ExprKind::And(list) => ExprKind::And(self.formulas(list, numbers)?),
            ExprKind::Or(list) => ExprKind::Or(self.formulas(list, numbers)?),
            ExprKind::Sum(first, rest) => {
                let terms = rest.iter().map(|(sign, term)| Ok((*sign, self.formula(term, numbers)?)));
                let rest = terms.collect::<Written<_>>()?;
                ExprKind::Sum(Box::new(self.formula(first, numbers)?), rest)
            }
            ExprKind::Product(first, rest) => {
                let factors = rest.iter().map(|(kind, factor)| Ok((*kind, self.formula(factor, numbers)?)));
                let rest = factors.collect::<Written<_>>()?;
                ExprKind::Product(Box::new(self.formula(first, numbers)?), rest)
            }
            ExprKind::If { arms, otherwise } => {
                let arms = arms
                    .iter()
                    .map(|(condition, value)| Ok((self.formula(condition, numbers)?, self.formula(value, numbers)?)));
                let arms = arms.collect::<Written<_>>()?;
                ExprKind::If { arms, otherwise: Box::new(self.formula(otherwise, numbers)?) }
            }
        };
        Ok(Expr { kind, span: e.span })
    }

    fn must_not_be_repeated(&mut self, name: &Name) -> Written<()> {
        let Some(copies) = self.copies.get(name.text.as_str()) else { return Ok(()) };
        let first = copies.iter().min().map(|numbers| indexed(&name.text, numbers));
        self.tell(errors::which_copy(name, first.as_deref()));
        Err(Unwritten)
    }

    /// `link[2].pin`
    fn path(&mut self, span: Span, segments: &[ast::PathSegment], numbers: &Numbers<'_>) -> Written<ExprKind> {
        let [first, rest @ ..] = segments else { return Err(Unwritten) };
        let owner = self.copy_named(first, numbers)?;
        if let Some(part) = self.parts.get(&owner.text).cloned()
            && !rest.is_empty()
        {
            return self.inside(span, &owner.text, part, rest, numbers);
        }
        match rest {
            [] => Ok(ExprKind::Name(owner)),
            [feature] if feature.indices.is_empty() => Ok(ExprKind::Member { owner, feature: feature.name.clone() }),
            _ => {
                let diagnostic = if self.names.contains(first.name.text.as_str()) || first.name.text == "ground" {
                    errors::path_of_nothing(span, segments, true)
                } else {
                    errors::unknown_owner(&first.name, self.tree)
                };
                self.tell(diagnostic);
                Err(Unwritten)
            }
        }
    }

    /// What a path names in a part: `leg[0].foot.toe` is the feature `toe` of the body that is called `leg[0].foot` here.
    fn inside(
        &mut self,
        span: Span,
        path: &str,
        part: Option<Rc<Instance<'t>>>,
        segments: &[ast::PathSegment],
        numbers: &Numbers<'_>,
    ) -> Written<ExprKind> {
        // of a part that cannot be, that has been said
        let mut part = part.ok_or(Unwritten)?;
        let mut path = path.to_owned();
        for (k, segment) in segments.iter().enumerate() {
            let name = self.copy_in(&part, &path, segment, numbers)?;
            let longer = format!("{path}.{name}");
            let rest = &segments[k + 1..];
            if let Some(inner) = part.part(&name).cloned()
                && !rest.is_empty()
            {
                (part, path) = (inner, longer);
                continue;
            }
            self.paths.insert(longer.clone());
            let owner = Name { text: longer, span: if rest.is_empty() { span } else { segment.name.span } };
            return match rest {
                [] => Ok(ExprKind::Name(owner)),
                [feature] if feature.indices.is_empty() => {
                    Ok(ExprKind::Member { owner, feature: feature.name.clone() })
                }
                // of a part that cannot be, that has been said
                _ if part.is_a_part(&segment.name.text) => Err(Unwritten),
                _ => {
                    self.tell(errors::path_goes_on(span));
                    Err(Unwritten)
                }
            };
        }
        Err(Unwritten)
    }

    /// The name that something has in a part.
    fn copy_in(
        &mut self,
        part: &Instance<'t>,
        path: &str,
        segment: &ast::PathSegment,
        numbers: &Numbers<'_>,
    ) -> Written<String> {
        let ast::PathSegment { name, indices } = segment;
        let copies = part.copies.get(name.text.as_str());
        let diagnostic = match (copies, indices.is_empty()) {
            _ if !part.declares(&name.text) => {
                let known: Vec<&str> = part.names().collect();
                errors::nothing_in_part(path, part.mechanism_name(), name, &known)
            }
            (None, true) => return Ok(name.text.clone()),
            (None, false) => errors::not_repeated(name),
            (Some(copies), true) => {
                let first = copies.iter().min().map(|numbers| format!("{path}.{}", indexed(&name.text, numbers)));
                errors::which_copy(name, first.as_deref())
            }
            (Some(copies), false) => {
                let copies = Rc::clone(copies);
                return self.one_of(&copies, segment, numbers);
            }
        };
        self.tell(diagnostic);
        Err(Unwritten)
    }

    /// The name that a copy has.
    fn copy_named(&mut self, segment: &ast::PathSegment, numbers: &Numbers<'_>) -> Written<Name> {
        let ast::PathSegment { name, indices } = segment;
        if indices.is_empty() {
            self.must_not_be_repeated(name)?;
            return Ok(name.clone());
        }
        match self.copies.get(name.text.as_str()).cloned() {
            Some(copies) => {
                let text = self.one_of(&copies, segment, numbers)?;
                Ok(Name { text, span: name.span })
            }
            // of what could not be repeated, or be read, that has been said
            None if self.is_repeated(name) || self.is_unread(name) => Err(Unwritten),
            None if self.names.contains(name.text.as_str()) => {
                self.tell(errors::not_repeated(name));
                Err(Unwritten)
            }
            // nothing of that name is told by whoever asks for it
            None => Ok(Name { text: indexed(&name.text, &self.values(indices, numbers)?), span: name.span }),
        }
    }

    fn is_repeated(&self, name: &Name) -> bool {
        let is_it = |item: &Item| name_of(item).is_some_and(|own| own.text == name.text);
        self.tree.items.iter().any(|item| !item.ranges.is_empty() && is_it(item))
    }

    /// Whether a declaration that could not be read gives this name, perhaps to several.
    fn is_unread(&self, name: &Name) -> bool {
        let gives_it = |item: &Item| match &item.kind {
            ItemKind::Broken { names } => names.iter().any(|own| own.text == name.text),
            _ => false,
        };
        self.tree.items.iter().any(gives_it)
    }

    fn values(&mut self, indices: &[Expr], numbers: &Numbers<'_>) -> Written<Vec<i64>> {
        indices.iter().map(|e| self.whole_number(e, numbers, "an index")).collect()
    }

    /// The name of one of some copies.
    fn one_of(
        &mut self,
        copies: &FxHashSet<Vec<i64>>,
        segment: &ast::PathSegment,
        numbers: &Numbers<'_>,
    ) -> Written<String> {
        let ast::PathSegment { name, indices } = segment;
        let values = self.values(indices, numbers)?;
        let copy = indexed(&name.text, &values);
        if copies.contains(&values) {
            return Ok(copy);
        }
        let ends = [copies.iter().min(), copies.iter().max()].map(|end| end.map(|end| indexed(&name.text, end)));
        let span = indices.iter().fold(name.span, |span, index| span.to(index.span));
        self.tell(errors::no_such_copy(&copy, span, ends, numbers));
        Err(Unwritten)
    }
}

/// A declaration, or one of its copies, that cannot be written out, which has been said.
pub(super) fn broken(item: &Item, numbers: &Numbers<'_>) -> Item {
    let names = name_of(item).map(|name| named(name, numbers)).into_iter().collect();
    Item { docs: Vec::new(), span: item.span, ranges: Vec::new(), kind: ItemKind::Broken { names } }
}

/// What a copy is called.
pub(super) fn named(name: &Name, numbers: &Numbers<'_>) -> Name {
    if numbers.is_empty() {
        return name.clone();
    }
    let numbers: Vec<i64> = numbers.iter().map(|(_, k)| *k).collect();
    Name { text: indexed(&name.text, &numbers), span: name.span }
}

/// `grid[1,3]`
fn indexed(name: &str, numbers: &[i64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(i64::to_string).collect();
    format!("{name}[{}]", numbers.join(","))
}

/// The place of what a formula names in a part, also by way of other definitions.
fn path_into_part(tree: &Mechanism, formula: &Expr) -> Option<Span> {
    let item = |name: &Name| tree.items.iter().find(|item| name_of(item).is_some_and(|own| own.text == name.text));
    let is_part = |name: &Name| item(name).is_some_and(|item| matches!(item.kind, ItemKind::Part(_)));
    let (mut open, mut seen) = (vec![formula], FxHashSet::default());
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
            if seen.insert(&name.text) {
                open.extend(item(name).map(Item::formulas).unwrap_or_default());
            }
        }
        open.extend(e.children());
    }
    None
}

/// The value of a formula of numbers alone, as most indices are.
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
