//! Who declares a name, and who uses it: every name of a mechanism with the declaration or the word of the language that it
//! stands for.
//!
//! By the tree alone: so it is there for a text with mistakes too, and costs nothing where nobody asks.

use super::meaning::{Alone, alone};
use crate::source::{FileId, Span};
use crate::syntax::ast::{
    Expr, ExprKind, Feature, FeatureKind, Item, ItemKind, Mechanism, Name, TableRows, WrittenUnit,
};
use crate::syntax::keywords_in;
use crate::vocabulary::{Constant, Function, JointWord, Keyword, QuantityWord, Role, StandsFor, Unit, Word};
use rustc_hash::{FxHashMap, FxHashSet};

/// A declaration, by its number in the order of the text.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct NameId(u32);

impl NameId {
    /// Its number.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a declaration declares.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum NameKind {
    /// `mechanism`
    Mechanism,
    /// `param`
    Param,
    /// `fn`
    Function,
    /// The argument of a `fn` or `curve`.
    Argument,
    /// `table`
    Table,
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
    /// `measure`
    Measure,
    /// `trace`
    Trace,
    /// What cannot be read.
    Broken,
}

/// A declared name.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DeclaredName {
    /// Its name, in NFC.
    pub name: String,
    /// What it is.
    pub kind: NameKind,
    /// Where its name stands.
    pub span: Span,
    /// The whole declaration.
    pub declaration: Span,
    /// What it belongs to: the body of a point, the function of an argument.
    pub owner: Option<NameId>,
}

/// What a name or word stands for.
#[derive(Clone, Copy, Debug)]
pub enum Meaning {
    /// A declaration of the mechanism.
    Declared(NameId),
    /// A word of the language.
    Word(&'static Word),
}

/// A place where a name or word stands.
#[derive(Clone, Copy, Debug)]
pub struct Use {
    /// Where.
    pub span: Span,
    /// What it stands for.
    pub meaning: Meaning,
    /// Whether it is the declaration itself.
    pub declares: bool,
}

/// The names of a mechanism, by place and by declaration.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    symbols: Vec<DeclaredName>,
    /// By place.
    uses: Vec<Use>,
}

impl Symbols {
    /// The names of a mechanism; the text is that of its file, where its keywords stand.
    #[must_use]
    pub fn of(tree: &Mechanism, text: &str) -> Symbols {
        let mut walk = Walk::default();
        walk.mechanism(tree);
        let mut symbols = walk.symbols;
        symbols.add_keywords(tree.span, text);
        symbols.uses.sort_by_key(|used| used.span);
        symbols
    }

    /// All declarations, in the order of the text.
    pub fn iter(&self) -> impl Iterator<Item = (NameId, &DeclaredName)> {
        self.symbols.iter().enumerate().map(|(k, symbol)| (NameId(k as u32), symbol))
    }

    /// A declaration.
    #[must_use]
    pub fn get(&self, id: NameId) -> &DeclaredName {
        &self.symbols[id.index()]
    }

    /// What stands at a byte of a file, or ends there.
    #[must_use]
    pub fn at(&self, file: FileId, offset: u32) -> Option<Use> {
        let end = self.uses.partition_point(|used| (used.span.file, used.span.start) <= (file, offset));
        let holds = |used: &&Use| used.span.file == file && offset <= used.span.end;
        self.uses[..end].iter().rev().take(2).find(holds).copied()
    }

    /// Every place of a declaration's name, itself included, in the order of the text.
    pub fn uses_of(&self, id: NameId) -> impl Iterator<Item = Span> {
        let is_it = move |used: &&Use| matches!(used.meaning, Meaning::Declared(of) if of == id);
        self.uses.iter().filter(is_it).map(|used| used.span)
    }

    /// Every name and word, by place.
    pub fn uses(&self) -> impl Iterator<Item = Use> {
        self.uses.iter().copied()
    }

    /// The words of the language that are no names, as far as the parts of declarations and formulas go.
    fn add_keywords(&mut self, within: Span, text: &str) {
        let known: FxHashSet<u32> = self.uses.iter().map(|used| used.span.start).collect();
        let inside = &text[within.start as usize..within.end as usize];
        for (at, keyword) in keywords_in(inside) {
            let start = within.start + at as u32;
            let span = Span { file: within.file, start, end: start + keyword.word.name.len() as u32 };
            if !known.contains(&start) {
                self.uses.push(Use { span, meaning: Meaning::Word(&keyword.word), declares: false });
            }
        }
    }
}

/// A walk over a tree, with the names that are declared.
#[derive(Default)]
struct Walk {
    symbols: Symbols,
    /// The mechanism's space.
    names: FxHashMap<String, NameId>,
    ground: Option<NameId>,
    /// The spaces of the bodies and of the ground.
    features: FxHashMap<(NameId, String), NameId>,
}

/// What a formula may name beside the mechanism's names.
#[derive(Clone, Copy, Default)]
struct Scope<'a> {
    /// The argument of the function or curve around it.
    argument: Option<(&'a str, NameId)>,
    /// The body whose feature it belongs to, where a point of it may be named alone.
    body: Option<NameId>,
}

impl Walk {
    fn mechanism(&mut self, tree: &Mechanism) {
        self.declare(&tree.name, NameKind::Mechanism, tree.span, None);
        let items: Vec<Option<NameId>> = tree.items.iter().map(|item| self.item(item)).collect();
        for (item, id) in tree.items.iter().zip(items) {
            self.uses_in(item, id);
        }
    }

    fn declare(&mut self, name: &Name, kind: NameKind, declaration: Span, owner: Option<NameId>) -> NameId {
        let id = NameId(self.symbols.symbols.len() as u32);
        self.symbols.symbols.push(DeclaredName { name: name.text.clone(), kind, span: name.span, declaration, owner });
        self.symbols.uses.push(Use { span: name.span, meaning: Meaning::Declared(id), declares: true });
        id
    }

    /// Declares what an item does; a name that is taken twice keeps its first meaning.
    fn item(&mut self, item: &Item) -> Option<NameId> {
        let (name, kind) = match &item.kind {
            ItemKind::Param { name, .. } => (name, NameKind::Param),
            ItemKind::Function { name, .. } => (name, NameKind::Function),
            ItemKind::Table { name, .. } => (name, NameKind::Table),
            ItemKind::Body { name, .. } => (name, NameKind::Body),
            ItemKind::Joint { name, .. } => (name, NameKind::Joint),
            ItemKind::Equation { name, driver: true, .. } => (name, NameKind::Driver),
            ItemKind::Equation { name, .. } => (name, NameKind::Constraint),
            ItemKind::Measure { name, .. } => (name, NameKind::Measure),
            ItemKind::Trace { name, .. } => (name, NameKind::Trace),
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
            ItemKind::Analysis { .. } => return None,
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
                FeatureKind::Broken => NameKind::Broken,
            };
            let id = self.declare(&feature.name, kind, feature.span, Some(owner));
            // two grounds are one, for those who look for a point
            let space =
                if self.symbols.get(owner).kind == NameKind::Ground { self.ground.unwrap_or(owner) } else { owner };
            self.features.entry((space, feature.name.text.clone())).or_insert(id);
        }
    }

    fn uses_in(&mut self, item: &Item, id: Option<NameId>) {
        let plain = Scope::default();
        match &item.kind {
            ItemKind::Param { value, .. } => self.formula(value, plain),
            ItemKind::Measure { value: formula, unit, .. } | ItemKind::Trace { point: formula, unit, .. } => {
                self.formula(formula, plain);
                if let Some(unit) = unit {
                    self.compound(unit);
                }
            }
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
            ItemKind::Ground { features } => self.uses_in_features(features, self.ground),
            ItemKind::Body { pose, features, .. } => {
                if let Some(pose) = pose {
                    self.formula(pose, plain);
                }
                self.uses_in_features(features, id);
            }
            ItemKind::Joint { kind, arguments, .. } => {
                if let Some(joint) = JointWord::named(&kind.text) {
                    self.word(kind, &joint.word);
                }
                for argument in arguments {
                    self.formula(argument, plain);
                }
            }
            ItemKind::Equation { left, right, .. } => {
                self.formula(left, plain);
                self.formula(right, plain);
            }
            ItemKind::Analysis { from, to, every } => {
                for time in [from, to, every] {
                    self.formula(time, plain);
                }
            }
            ItemKind::Broken { .. } => {}
        }
    }

    fn uses_in_features(&mut self, features: &[Feature], body: Option<NameId>) {
        let (plain, own) = (Scope::default(), Scope { body, ..Scope::default() });
        for feature in features {
            match &feature.kind {
                FeatureKind::Point { at } => self.formula(at, plain),
                FeatureKind::AxisAlong { origin, direction } => {
                    self.formula(origin, own);
                    self.formula(direction, plain);
                }
                FeatureKind::AxisTo { origin, target } => {
                    self.formula(origin, own);
                    self.formula(target, own);
                }
                FeatureKind::Circle { center, radius } => {
                    self.formula(center, own);
                    self.formula(radius, plain);
                }
                FeatureKind::Curve { argument, at, estimate } => {
                    let curve = body.and_then(|body| self.features.get(&(body, feature.name.text.clone())).copied());
                    let declared = self.declare(argument, NameKind::Argument, feature.span, curve);
                    self.formula(at, Scope { argument: Some((&argument.text, declared)), ..plain });
                    if let Some(estimate) = estimate {
                        self.formula(estimate, plain);
                    }
                }
                FeatureKind::Broken => {}
            }
        }
    }

    fn formula(&mut self, formula: &Expr, scope: Scope<'_>) {
        let mut open = vec![formula];
        while let Some(e) = open.pop() {
            match &e.kind {
                ExprKind::Literal { unit: Some((unit, _)), .. } => self.unit(unit),
                ExprKind::Name(name) => self.name(name, scope, std::ptr::eq(e, formula)),
                ExprKind::Member { owner, feature } => self.member(owner, feature),
                ExprKind::Call { name, .. } => self.called(name),
                _ => {}
            }
            open.extend(e.children());
        }
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

    /// A name in a formula; where it stands for a place, a point of its own body comes first.
    fn name(&mut self, name: &Name, scope: Scope<'_>, is_alone: bool) {
        let body = scope.body.filter(|_| is_alone);
        if let Some(&id) = body.and_then(|body| self.features.get(&(body, name.text.clone()))) {
            self.declared(name, id);
            return;
        }
        let argument = scope.argument.map(|(argument, _)| argument);
        match alone(&name.text, argument, self.names.get(&name.text).copied()) {
            Alone::Argument => scope.argument.into_iter().for_each(|(_, id)| self.declared(name, id)),
            Alone::Constant(Constant { stands_for: StandsFor::Ground, .. }) if self.ground.is_some() => {
                self.ground.into_iter().for_each(|id| self.declared(name, id));
            }
            Alone::Constant(constant) => self.word(name, &constant.word),
            Alone::Unit(unit) => self.word(name, &unit.word),
            Alone::Declared(id) => self.declared(name, id),
            Alone::Unknown => {
                if let Some(side) = Keyword::named(&name.text).filter(|keyword| keyword.role == Role::Side) {
                    self.word(name, &side.word);
                }
            }
        }
    }

    fn member(&mut self, owner: &Name, feature: &Name) {
        let of = if owner.text == "ground" { self.ground } else { self.names.get(&owner.text).copied() };
        let Some(of) = of else { return };
        self.declared(owner, of);
        if let Some(&id) = self.features.get(&(of, feature.text.clone())) {
            self.declared(feature, id);
        }
    }

    /// What is called: the language's own functions before the user's, but for quantities that give way.
    fn called(&mut self, name: &Name) {
        let declared = self.names.get(&name.text);
        let is_callable = |id: &NameId| matches!(self.symbols.get(*id).kind, NameKind::Function | NameKind::Table);
        let hides = declared.is_some_and(is_callable);
        let quantity = QuantityWord::named(&name.text).filter(|quantity| !quantity.gives_way || !hides);
        let function = Function::named(&name.text).map(|function| &function.word);
        let word = function.or_else(|| quantity.map(|quantity| &quantity.word));
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
    use crate::source::Sources;
    use crate::syntax;
    use std::collections::BTreeSet;

    const TEXT: &str = include_str!("../../examples/slider_crank.mech");

    fn symbols(text: &str) -> (Sources, Symbols) {
        let mut sources = Sources::default();
        let file = sources.add("a.mech", text);
        let parsed = syntax::parse(&sources, file);
        let symbols = Symbols::of(&parsed.tree.mechanisms[0], text);
        (sources, symbols)
    }

    /// Every place of the name that stands at the first `‸` of a text, as the lines that hold it.
    fn places(text: &str) -> Vec<String> {
        let at = text.find('‸').expect("a cursor");
        let text = text.replacen('‸', "", 1);
        let (sources, symbols) = symbols(&text);
        let file = sources.end_of(symbols.get(super::NameId(0)).span.file).file;
        let Some(Meaning::Declared(id)) = symbols.at(file, at as u32).map(|used| used.meaning) else {
            return Vec::new();
        };
        let line = |span: crate::source::Span| text.lines().nth(sources.get(file).line_index(span.start as usize));
        symbols.uses_of(id).filter_map(line).map(|line| line.trim().to_owned()).collect()
    }

    #[test]
    fn every_word_of_an_example_is_known() {
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
    fn a_name_is_found_from_its_use_and_from_its_declaration() {
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
    fn traces_units_and_quantities_have_their_meanings() {
        let text = "mechanism m {\n param Hz = 3\n body b { point ‸P = (2, 0) }\n trace trace = b.P in mm\n measure speed = speed(b.P) in mm/Hz\n measure in_it = speed / 2 in mm/s\n}";
        assert_eq!(places(text).len(), 3);
        // a unit behind `in` is one, whatever else is called so
        assert_eq!(places(&text.replace('‸', "").replace("Hz =", "‸Hz =")).len(), 1);
        assert_eq!(places(&text.replace('‸', "").replace("measure speed", "measure ‸speed")).len(), 2);
        assert_eq!(places(&text.replace('‸', "").replace("trace trace", "trace ‸trace")).len(), 1);
        let called =
            text.replace('‸', "").replace(" param", " fn slip(u) = u\n param").replace("speed(b.P)", "‸slip(1)");
        assert_eq!(places(&called).len(), 2);
    }

    #[test]
    fn names_are_known_beside_a_fault() {
        let text = "mechanism m {\n param ‸r = 3 mm\n body b { point P = (r, 0) }\n joint j revolute(b.P, ground.O)\n measure k = r\n}";
        assert_eq!(places(text).len(), 3);
    }
}
