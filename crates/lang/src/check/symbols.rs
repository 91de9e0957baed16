//! The symbol table: every name of a mechanism with the declaration or the word of the language that it stands for.
//!
//! It uses the tree alone, so that it is also available for texts with errors.

use super::scope::{BareName, Expected, coordinate, point_kinds, resolve_bare_name};
use mechc_syntax::ast::{
    DrawnPose, Expr, ExprKind, Feature, FeatureKind, Item, ItemKind, Mechanism, Name, PathSegment, TableRows, UsedFile,
    WrittenUnit,
};
use mechc_syntax::keywords_in;
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::{
    Constant, Function, JointSpec, Keyword, NamedConstant, QuantityWord, ReductionWord, Role, Unit, Word,
};
use rustc_hash::{FxHashMap, FxHashSet};

/// A declaration, by its number in the order of the text.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct NameId(u32);

impl NameId {
    /// Returns its number.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The kind of a declaration.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum NameKind {
    /// `mechanism`
    Mechanism,
    /// The name after `as`, and before those of a used file's mechanisms.
    Prefix,
    /// `param`
    Param,
    /// `fn`
    Function,
    /// The argument of a `fn` or `curve`.
    Argument,
    /// `table`
    Table,
    /// `input`
    Input,
    /// `ground`
    Ground,
    /// `body`
    Body,
    /// `point`
    Point,
    /// `axis`
    Axis,
    /// `circle`
    Circle,
    /// `curve`
    Curve,
    /// `joint`
    Joint,
    /// `constraint`
    Constraint,
    /// `driver`
    Driver,
    /// `load`
    Load,
    /// `measure`
    Measure,
    /// `trace`
    Trace,
    /// `part`
    Part,
    /// `result`
    Result,
    /// `require`
    Requirement,
    /// A declaration that cannot be parsed.
    Broken,
}

impl NameKind {
    /// Returns the kind of a declaration.
    #[must_use]
    pub fn of(item: &Item) -> NameKind {
        match &item.kind {
            ItemKind::Param { .. } => NameKind::Param,
            ItemKind::Function { .. } => NameKind::Function,
            ItemKind::Table { .. } => NameKind::Table,
            ItemKind::Input { .. } => NameKind::Input,
            ItemKind::Part(_) => NameKind::Part,
            ItemKind::Ground { .. } => NameKind::Ground,
            ItemKind::Body { .. } => NameKind::Body,
            ItemKind::Joint { .. } => NameKind::Joint,
            ItemKind::Equation { driver: true, .. } => NameKind::Driver,
            ItemKind::Equation { .. } => NameKind::Constraint,
            ItemKind::Load { .. } => NameKind::Load,
            ItemKind::Measure { .. } => NameKind::Measure,
            ItemKind::Trace { .. } => NameKind::Trace,
            ItemKind::Result { .. } => NameKind::Result,
            ItemKind::Requirement(_) => NameKind::Requirement,
            ItemKind::Broken { .. } | ItemKind::Gravity { .. } | ItemKind::Analysis { .. } => NameKind::Broken,
        }
    }
}

/// A declared name.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DeclaredName {
    /// The name, in Unicode normalization form NFC.
    pub name: String,
    /// The kind of its declaration.
    pub kind: NameKind,
    /// The location of the name.
    pub span: Span,
    /// The location of the whole declaration.
    pub declaration: Span,
    /// The owner: the body of a point, or the function of an argument.
    pub owner: Option<NameId>,
}

/// The meaning of a name or word.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// A declaration of the mechanism.
    Declared(NameId),
    /// A word of the language.
    Word(&'static Word),
}

/// The occurrence of a name or word.
#[derive(Clone, Copy, Debug)]
pub struct Use {
    /// The location.
    pub span: Span,
    /// The meaning.
    pub meaning: Meaning,
    /// True for the declaration itself.
    pub declares: bool,
}

/// The names of a mechanism, by location and by declaration.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    symbols: Vec<DeclaredName>,
    /// Sorted by location.
    uses: Vec<Use>,
}

impl Symbols {
    /// Returns the names of a mechanism and of the `use`s of its file. `text` is that of the file, for its keywords.
    #[must_use]
    pub fn of(tree: &Mechanism, uses: &[UsedFile], text: &str) -> Symbols {
        let point_params = point_kinds::point_params(tree);
        let mut walk = Walk { point_params, hidden: point_kinds::hiding_functions(tree), ..Walk::default() };
        walk.mechanism(tree);
        walk.prefixes(uses);
        let mut symbols = walk.symbols;
        for span in uses.iter().map(|used| used.span).chain([tree.span]) {
            symbols.add_keywords(span, text);
        }
        // If a name is a declaration and a use of another one, `at` finds the declaration.
        symbols.uses.sort_by_key(|used| (used.span, used.declares));
        symbols
    }

    /// Returns all declarations in the order of the text; the prefixes of used files follow.
    pub fn iter(&self) -> impl Iterator<Item = (NameId, &DeclaredName)> {
        self.symbols.iter().enumerate().map(|(k, symbol)| (NameId(k as u32), symbol))
    }

    /// Returns a declaration.
    #[must_use]
    pub fn get(&self, id: NameId) -> &DeclaredName {
        &self.symbols[id.index()]
    }

    /// Returns the name or word that contains a byte offset or ends there.
    #[must_use]
    pub fn at(&self, file: FileId, offset: u32) -> Option<Use> {
        let end = self.uses.partition_point(|used| (used.span.file, used.span.start) <= (file, offset));
        let holds = |used: &&Use| used.span.file == file && offset <= used.span.end;
        self.uses[..end].iter().rev().take(2).find(holds).copied()
    }

    /// Returns every occurrence of a declaration's name, including the declaration, in the order of the text.
    pub fn uses_of(&self, id: NameId) -> impl Iterator<Item = Span> {
        let is_it = move |used: &&Use| matches!(used.meaning, Meaning::Declared(of) if of == id);
        self.uses.iter().filter(is_it).map(|used| used.span)
    }

    /// Returns every name and word, by location.
    pub fn uses(&self) -> impl Iterator<Item = Use> {
        self.uses.iter().copied()
    }

    /// Adds the keywords within declarations and formulas.
    fn add_keywords(&mut self, within: Span, text: &str) {
        let used: FxHashSet<u32> = self.uses.iter().map(|used| used.span.start).collect();
        let inside = &text[within.start as usize..within.end as usize];
        for (at, keyword) in keywords_in(inside) {
            let start = within.start + at as u32;
            let span = Span { file: within.file, start, end: start + keyword.word.name.len() as u32 };
            if !used.contains(&start) {
                self.uses.push(Use { span, meaning: Meaning::Word(&keyword.word), declares: false });
            }
        }
    }
}

/// A traversal of a tree with the declared names.
#[derive(Default)]
struct Walk<'t> {
    /// The params that are points.
    point_params: FxHashSet<&'t str>,
    /// The functions and tables that hide a function of the language.
    hidden: FxHashSet<&'t str>,
    symbols: Symbols,
    /// The name space of the mechanism.
    names: FxHashMap<String, NameId>,
    ground: Option<NameId>,
    /// The name spaces of the bodies and of the ground.
    features: FxHashMap<(NameId, String), NameId>,
}

/// The names that are in scope besides those of the mechanism.
#[derive(Clone, Copy, Default)]
struct Scope<'a> {
    /// The argument of the function or curve.
    argument: Option<(&'a str, NameId)>,
    /// The indices of a repeated declaration.
    indices: &'a [(&'a str, NameId)],
    /// The body to whose features the formula belongs.
    body: Option<NameId>,
    /// The point that the formula defines.
    defined: Option<&'a str>,
}

impl Walk<'_> {
    fn mechanism(&mut self, tree: &Mechanism) {
        self.declare(&tree.name, NameKind::Mechanism, tree.span, None);
        let items: Vec<Option<NameId>> = tree.items.iter().map(|item| self.item(item)).collect();
        for (item, id) in tree.items.iter().zip(items) {
            self.uses_in(item, id);
        }
    }

    fn prefixes(&mut self, uses: &[UsedFile]) {
        for used in uses {
            if let Some(prefix) = &used.prefix {
                self.declare(prefix, NameKind::Prefix, used.span, None);
            }
        }
    }

    fn declare(&mut self, name: &Name, kind: NameKind, declaration: Span, owner: Option<NameId>) -> NameId {
        let id = NameId(self.symbols.symbols.len() as u32);
        self.symbols.symbols.push(DeclaredName { name: name.text.clone(), kind, span: name.span, declaration, owner });
        self.symbols.uses.push(Use { span: name.span, meaning: Meaning::Declared(id), declares: true });
        id
    }

    /// Declares the name of an item. A duplicate keeps its first meaning.
    fn item(&mut self, item: &Item) -> Option<NameId> {
        let (name, kind) = match &item.kind {
            ItemKind::Param { name, .. } => (name, NameKind::Param),
            ItemKind::Function { name, .. } => (name, NameKind::Function),
            ItemKind::Table { name, .. } => (name, NameKind::Table),
            ItemKind::Input { name, .. } => (name, NameKind::Input),
            ItemKind::Body { name, .. } => (name, NameKind::Body),
            ItemKind::Joint { name, .. } => (name, NameKind::Joint),
            ItemKind::Equation { name, driver: true, .. } => (name, NameKind::Driver),
            ItemKind::Equation { name, .. } => (name, NameKind::Constraint),
            ItemKind::Load { name, .. } => (name, NameKind::Load),
            ItemKind::Measure { name, .. } => (name, NameKind::Measure),
            ItemKind::Trace { name, .. } => (name, NameKind::Trace),
            ItemKind::Part(part) => (&part.name, NameKind::Part),
            ItemKind::Result { name, .. } => (name, NameKind::Result),
            ItemKind::Requirement(requirement) => (requirement.name.as_ref()?, NameKind::Requirement),
            ItemKind::Ground { features } => {
                let word = Span { end: item.span.start + "ground".len() as u32, ..item.span };
                let name = Name { text: "ground".to_owned(), span: word };
                let id = self.declare(&name, NameKind::Ground, item.span, None);
                self.ground.get_or_insert(id);
                self.features_of(id, features);
                return Some(id);
            }
            ItemKind::Broken { names } => {
                for name in names {
                    let id = self.declare(name, NameKind::Broken, item.span, None);
                    self.names.entry(name.text.clone()).or_insert(id);
                }
                return None;
            }
            ItemKind::Gravity { .. } | ItemKind::Analysis { .. } => return None,
        };
        let id = self.declare(name, kind, item.span, None);
        self.names.entry(name.text.clone()).or_insert(id);
        if let ItemKind::Body { features, .. } = &item.kind {
            self.features_of(id, features);
        }
        Some(id)
    }

    fn features_of(&mut self, owner: NameId, features: &[Feature]) {
        for feature in features.iter().filter(|feature| !feature.name.text.is_empty()) {
            let kind = match feature.kind {
                FeatureKind::Point { .. } => NameKind::Point,
                FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => NameKind::Axis,
                FeatureKind::Circle { .. } => NameKind::Circle,
                FeatureKind::Curve { .. } => NameKind::Curve,
                FeatureKind::Broken | FeatureKind::Mass { .. } => NameKind::Broken,
            };
            let id = self.declare(&feature.name, kind, feature.span, Some(owner));
            // Two `ground` declarations share one name space.
            let space =
                if self.symbols.get(owner).kind == NameKind::Ground { self.ground.unwrap_or(owner) } else { owner };
            self.features.entry((space, feature.name.text.clone())).or_insert(id);
        }
    }

    fn uses_in(&mut self, item: &Item, id: Option<NameId>) {
        let mut indices: Vec<(&str, NameId)> = Vec::new();
        for range in &item.ranges {
            let before = indices.clone();
            let scope = Scope { indices: &before, ..Scope::default() };
            self.formula(&range.from, scope);
            self.formula(&range.to, scope);
            indices.push((&range.index.text, self.declare(&range.index, NameKind::Argument, item.span, id)));
        }
        let plain = Scope { indices: &indices, ..Scope::default() };
        match &item.kind {
            ItemKind::Param { value, .. } | ItemKind::Input { value, .. } => self.formula(value, plain),
            ItemKind::Measure { value: formula, unit, .. }
            | ItemKind::Trace { point: formula, unit, .. }
            | ItemKind::Result { value: formula, unit, .. } => {
                self.formula(formula, plain);
                if let Some(unit) = unit {
                    self.compound(unit);
                }
            }
            ItemKind::Requirement(requirement) => requirement.formulas().for_each(|side| self.formula(side, plain)),
            ItemKind::Function { argument, value, .. } => {
                let declared = self.declare(argument, NameKind::Argument, item.span, id);
                self.formula(value, Scope { argument: Some((&argument.text, declared)), ..plain });
            }
            ItemKind::Table { rows: TableRows::Listed(rows), .. } => {
                for row in rows {
                    self.formula(row, plain);
                }
            }
            ItemKind::Table { rows: TableRows::File { units, .. }, .. } => {
                units.iter().flatten().for_each(|unit| self.compound(unit));
            }
            ItemKind::Ground { features } => self.uses_in_features(features, self.ground, plain),
            ItemKind::Body { pose, features, .. } => {
                for part in pose.iter().flat_map(DrawnPose::parts) {
                    self.read(part, plain, Expected::Either);
                }
                self.uses_in_features(features, id, plain);
            }
            ItemKind::Part(part) => {
                let bindings = part.bindings.iter().map(|binding| &binding.value);
                for formula in bindings.chain(&part.on).chain(&part.at) {
                    self.read(formula, plain, Expected::Either);
                }
            }
            ItemKind::Joint { kind, arguments, .. } => {
                if let Some(joint) = JointSpec::named(&kind.text) {
                    self.word(kind, &joint.word);
                }
                for argument in arguments {
                    self.formula(argument, plain);
                }
            }
            ItemKind::Equation { left, right, .. } | ItemKind::Load { force: left, on: right, .. } => {
                self.formula(left, plain);
                self.formula(right, plain);
            }
            ItemKind::Gravity { acceleration } => self.formula(acceleration, plain),
            ItemKind::Analysis { from, to, every } => {
                for time in [from, to, every] {
                    self.formula(time, plain);
                }
            }
            ItemKind::Broken { .. } => {}
        }
    }

    fn uses_in_features(&mut self, features: &[Feature], body: Option<NameId>, plain: Scope<'_>) {
        let in_body = Scope { body, ..plain };
        for feature in features {
            match &feature.kind {
                FeatureKind::Point { at } => {
                    let name = &feature.name;
                    match at {
                        Some(at) => self.read(at, Scope { defined: Some(&name.text), ..in_body }, Expected::Point),
                        None => self.point_taken(name),
                    }
                }
                FeatureKind::AxisAlong { origin, direction } => {
                    self.read(origin, in_body, Expected::Point);
                    self.formula(direction, in_body);
                }
                FeatureKind::AxisTo { origin, target } => {
                    self.read(origin, in_body, Expected::Point);
                    self.read(target, in_body, Expected::Point);
                }
                FeatureKind::Circle { center, radius } => {
                    self.read(center, in_body, Expected::Point);
                    self.formula(radius, in_body);
                }
                FeatureKind::Curve { argument, at, estimate } => {
                    let curve = body.and_then(|body| self.features.get(&(body, feature.name.text.clone())).copied());
                    let declared = self.declare(argument, NameKind::Argument, feature.span, curve);
                    self.read(at, Scope { argument: Some((&argument.text, declared)), ..in_body }, Expected::Point);
                    if let Some(estimate) = estimate {
                        self.formula(estimate, in_body);
                    }
                }
                FeatureKind::Mass { mass, at, inertia } => {
                    self.formula(mass, in_body);
                    if let Some(at) = at {
                        self.read(at, in_body, Expected::Point);
                    }
                    if let Some(inertia) = inertia {
                        self.formula(inertia, in_body);
                    }
                }
                FeatureKind::Broken => {}
            }
        }
    }

    fn formula(&mut self, formula: &Expr, scope: Scope<'_>) {
        self.read(formula, scope, Expected::Number);
    }

    /// Adds the names in a formula of numbers or of points.
    fn read(&mut self, formula: &Expr, scope: Scope<'_>, expected: Expected) {
        let mut open = vec![(formula, expected)];
        while let Some((e, expected)) = open.pop() {
            match &e.kind {
                ExprKind::Literal { unit: Some((unit, _)), .. } => self.unit(unit),
                ExprKind::Name(name) => self.name(name, scope, expected),
                ExprKind::Member { owner, feature } => self.member(owner, feature, scope, expected),
                ExprKind::Path(segments) => self.path(segments, scope, expected),
                ExprKind::Call { name, arguments, .. } => self.called(name, arguments.len()),
                _ => {}
            }
            open.extend(point_kinds::inside(e, expected, |name| self.hidden.contains(name)));
        }
    }

    /// Adds a lone `point A`, which refers to the mechanism's point.
    fn point_taken(&mut self, name: &Name) {
        if self.point_params.contains(name.text.as_str())
            && let Some(&id) = self.names.get(&name.text)
        {
            self.declared(name, id);
        }
    }

    /// Looks a name up among the features of the body around a formula, by the rule of the formula reader.
    fn feature(&self, name: &Name, scope: Scope<'_>, expected: Expected) -> Option<NameId> {
        let body = scope.body.filter(|_| expected != Expected::Number && scope.defined != Some(&name.text))?;
        let &id = self.features.get(&(body, name.text.clone()))?;
        let is_point = matches!(self.symbols.get(id).kind, NameKind::Point | NameKind::Broken);
        let declared = self.names.get(&name.text).map(|&id| self.symbols.get(id).kind);
        let is_point_param = declared == Some(NameKind::Param) && self.point_params.contains(name.text.as_str());
        let is_number = match declared {
            Some(kind) => kind == NameKind::Param && !is_point_param,
            None if scope.argument.is_some_and(|(argument, _)| argument == name.text) => true,
            None => Constant::named(&name.text).is_some() || Unit::named(&name.text).is_some(),
        };
        let is_feature = match expected {
            Expected::Number => false,
            // A feature that is not a point is reported by its name if a point is expected.
            Expected::Point => is_point || !is_point_param,
            Expected::Either => is_point && !is_number,
        };
        is_feature.then_some(id)
    }

    fn word(&mut self, name: &Name, word: &'static Word) {
        self.symbols.uses.push(Use { span: name.span, meaning: Meaning::Word(word), declares: false });
    }

    fn declared(&mut self, name: &Name, id: NameId) {
        self.symbols.uses.push(Use { span: name.span, meaning: Meaning::Declared(id), declares: false });
    }

    fn compound(&mut self, written: &WrittenUnit) {
        written.factors.iter().for_each(|factor| self.unit(&factor.name));
    }

    fn unit(&mut self, name: &Name) {
        if let Some(unit) = Unit::named(&name.text) {
            self.word(name, &unit.word);
        }
    }

    /// Adds a name in a formula. Where it may be a point, those of its own body take precedence.
    fn name(&mut self, name: &Name, scope: Scope<'_>, expected: Expected) {
        if let Some(id) = self.feature(name, scope, expected) {
            self.declared(name, id);
            return;
        }
        if let Some(&(_, id)) = scope.indices.iter().find(|(index, _)| *index == name.text) {
            self.declared(name, id);
            return;
        }
        let argument = scope.argument.map(|(argument, _)| argument);
        match resolve_bare_name(&name.text, argument, self.names.get(&name.text).copied()) {
            BareName::Argument => scope.argument.into_iter().for_each(|(_, id)| self.declared(name, id)),
            BareName::Constant(Constant { stands_for: NamedConstant::Ground, .. }) if self.ground.is_some() => {
                self.ground.into_iter().for_each(|id| self.declared(name, id));
            }
            BareName::Constant(constant) => self.word(name, &constant.word),
            BareName::Unit(unit) => self.word(name, &unit.word),
            BareName::Declared(id) => self.declared(name, id),
            BareName::Unknown => {
                if let Some(side) = Keyword::named(&name.text).filter(|keyword| keyword.role == Role::Side) {
                    self.word(name, &side.word);
                }
            }
        }
    }

    /// Adds a path such as `link[2].pin` with the formulas of its indices.
    fn path(&mut self, segments: &[PathSegment], scope: Scope<'_>, expected: Expected) {
        match segments {
            [owner, feature, ..] => self.member(&owner.name, &feature.name, scope, expected),
            [resolve_bare_name] => {
                if let Some(&id) = self.names.get(&resolve_bare_name.name.text) {
                    self.declared(&resolve_bare_name.name, id);
                }
            }
            [] => {}
        }
    }

    fn member(&mut self, owner: &Name, feature: &Name, scope: Scope<'_>, expected: Expected) {
        let is_coordinate = expected != Expected::Point && coordinate(feature).is_some();
        if let Some(id) = self.feature(owner, scope, Expected::Point).filter(|_| is_coordinate) {
            self.declared(owner, id);
            return;
        }
        let of = if owner.text == "ground" { self.ground } else { self.names.get(&owner.text).copied() };
        let Some(of) = of else { return };
        self.declared(owner, of);
        if let Some(&id) = self.features.get(&(of, feature.text.clone())) {
            self.declared(feature, id);
        }
    }

    /// Adds a call: the language's own functions take precedence, unless they give way.
    fn called(&mut self, name: &Name, arguments: usize) {
        let declared = self.names.get(&name.text);
        let is_callable = |id: &NameId| matches!(self.symbols.get(*id).kind, NameKind::Function | NameKind::Table);
        let hides = declared.is_some_and(is_callable);
        let quantity = QuantityWord::named(&name.text).filter(|quantity| !quantity.gives_way() || !hides);
        let function = Function::named(&name.text).map(|function| &function.word);
        // With more arguments `max` and `min` compare.
        let reduces = |_: &&ReductionWord| !hides && (function.is_none() || arguments == 1);
        let reduction = ReductionWord::named(&name.text).filter(reduces).map(|reduction| &reduction.word);
        let word = reduction.or(function).or_else(|| quantity.map(|quantity| &quantity.word));
        let word = word.filter(|_| !self.hidden.contains(name.text.as_str()));
        match (word, declared) {
            (Some(word), _) => self.word(name, word),
            (None, Some(&id)) => self.declared(name, id),
            (None, None) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Meaning, Symbols};
    use mechc_syntax as syntax;
    use mechc_text::source::Sources;
    use std::collections::BTreeSet;

    const TEXT: &str = include_str!("../../../../examples/slider_crank.mech");

    fn symbols(text: &str) -> (Sources, Symbols) {
        let mut sources = Sources::default();
        let file = sources.add("a.mech", text);
        let parsed = syntax::parse(&sources, file);
        let symbols = Symbols::of(&parsed.tree.mechanisms[0], &parsed.tree.uses, text);
        (sources, symbols)
    }

    /// Returns the lines of every occurrence of the name at the first `‸` of a text.
    fn places(text: &str) -> Vec<String> {
        let at = text.find('‸').expect("a cursor");
        let text = text.replacen('‸', "", 1);
        let (sources, symbols) = symbols(&text);
        let file = sources.end_of(symbols.get(super::NameId(0)).span.file).file;
        let Some(Meaning::Declared(id)) = symbols.at(file, at as u32).map(|used| used.meaning) else {
            return Vec::new();
        };
        let line = |span: mechc_text::source::Span| text.lines().nth(sources.get(file).line_index(span.start as usize));
        symbols.uses_of(id).filter_map(line).map(|line| line.trim().to_owned()).collect()
    }

    #[test]
    fn every_word_of_an_example_resolves() {
        let (sources, symbols) = symbols(TEXT);
        let starts: BTreeSet<u32> = symbols.uses().map(|used| used.span.start).collect();
        let file = symbols.get(super::NameId(0)).span.file;
        let within = symbols.get(super::NameId(0)).declaration;
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        for line in 0.. {
            let Some(range) = sources.get(file).line_range(line) else { break };
            let code = TEXT[range.clone()].split("//").next().unwrap_or_default();
            for word in code.split(|c| !is_word(c)).filter(|word| word.starts_with(char::is_alphabetic)) {
                let start = (range.start + (word.as_ptr() as usize - code.as_ptr() as usize)) as u32;
                assert!(start < within.start || starts.contains(&start), "`{word}` in {code}");
            }
        }
    }

    #[test]
    fn uses_and_declaration_find_the_name() {
        let text = "mechanism m {\n param r = 3 mm\n fn f(r2) = r2 * r\n ground { point O = (0, 0) }\n body b { point O = (r, 0)\n axis a = O along (1, 0) }\n joint j: revolute(ground.O, b.O)\n driver d: rotation(j) = f(t)\n measure m2 = x(b.O) + r\n}";
        let of = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            places(&text.replacen(from, to, 1))
        };
        assert_eq!(of("param r", "param ‸r").len(), 4);
        assert_eq!(of("* r\n", "* ‸r\n"), of("param r", "param ‸r"));
        assert_eq!(of("fn f(r2)", "fn f(‸r2)").len(), 2);
        assert_eq!(of("axis a = O", "axis a = ‸O"), of("x(b.O)", "x(b.‸O)"));
        assert_eq!(of("x(b.O)", "x(b.‸O)").len(), 4);
        assert_eq!(of("ground.O", "ground.‸O").len(), 2);
        assert_eq!(of("ground.O", "‸ground.O"), ["ground { point O = (0, 0) }", "joint j: revolute(ground.O, b.O)"]);
        assert_eq!(of("rotation(j)", "rotation(‸j)").len(), 2);
        assert_eq!(of("= f(t)", "= ‸f(t)").len(), 2);
    }

    #[test]
    fn a_declared_name_wins_over_a_unit_that_gives_way() {
        let text = "mechanism m {\n param ‸Hz = 3\n body b { point P = (2 / Hz, 0) }\n measure k = 5 Hz * Hz\n}";
        assert_eq!(places(text).len(), 3);
    }

    #[test]
    fn a_point_of_the_body_comes_before_that_of_the_mechanism() {
        let text = "mechanism m {\n param A = (1 mm, 2 mm)\n param r = 3 mm\n ground {\n point A\n point P = mid(A, A)\n point r = (r, A.x)\n point Q = r + 2 * A - 2 * (r / 1 mm) * P\n }\n body b at (A, r / 1 m) { point O = A + (A.y, 0) }\n}";
        let of = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            places(&text.replacen(from, to, 1))
        };
        let body = "body b at (A, r / 1 m) { point O = A + (A.y, 0) }";
        assert_eq!(of("param A", "param ‸A"), ["param A = (1 mm, 2 mm)", "point A", body, body, body]);
        let (second, last) = ("point r = (r, A.x)", "point Q = r + 2 * A - 2 * (r / 1 mm) * P");
        assert_eq!(of("mid(A", "mid(‸A"), ["point A", "point P = mid(A, A)", "point P = mid(A, A)", second, last]);
        assert_eq!(of("point A", "point ‸A"), of("mid(A", "mid(‸A"));
        assert_eq!(of("(r, A.x)", "(‸r, A.x)"), ["param r = 3 mm", second, last, body]);
        assert_eq!(of("Q = r", "Q = ‸r"), [second, last]);
        assert_eq!(of("(r, A.x)", "(r, ‸A.x)"), of("mid(A", "mid(‸A"));
    }

    #[test]
    fn traces_units_and_quantities_have_their_meanings() {
        let text = "mechanism m {\n param Hz = 3\n body b { point ‸P = (2, 0) }\n trace trace = b.P in mm\n measure speed = speed(b.P) in mm/Hz\n measure in_it = speed / 2 in mm/s\n}";
        assert_eq!(places(text).len(), 3);
        // The word after `in` is a unit, even if a declaration has its name.
        assert_eq!(places(&text.replace('‸', "").replace("Hz =", "‸Hz =")).len(), 1);
        assert_eq!(places(&text.replace('‸', "").replace("measure speed", "measure ‸speed")).len(), 2);
        assert_eq!(places(&text.replace('‸', "").replace("trace trace", "trace ‸trace")).len(), 1);
        let called =
            text.replace('‸', "").replace(" param", " fn slip(u) = u\n param").replace("speed(b.P)", "‸slip(1)");
        assert_eq!(places(&called).len(), 2);
    }

    #[test]
    fn prefixes_of_used_files_are_names() {
        let text = "use \"a.mech\"\nuse \"b.mech\" as ‸use // one\nmechanism m {\n body as { point use = (0, 0) }\n}";
        assert_eq!(places(text), ["use \"b.mech\" as use // one"]);
        let (_, symbols) = symbols(&text.replace('‸', ""));
        let words = symbols.uses().filter(|used| matches!(used.meaning, Meaning::Word(_)));
        let starts: Vec<u32> = words.map(|used| used.span.start).filter(|start| *start < 40).collect();
        assert_eq!(starts, [0, 13, 26], "`use`, `use` and `as`, and not the prefix");
    }

    #[test]
    fn names_resolve_next_to_a_fault() {
        let text = "mechanism m {\n param ‸r = 3 mm\n body b { point P = (r, 0) }\n joint j revolute(b.P, ground.O)\n measure k = r\n}";
        assert_eq!(places(text).len(), 3);
    }
}
