//! The names in scope at a position, by kind.

use super::MAX_ITEMS;
use super::cursor::{Block, Cursor};
use super::expected::Expected;
use super::item::{CompletionItem, CompletionItemKind, Template};
use crate::lexical::matches_letters;
use crate::occurrences::{find_mechanism, item_named};
use mechc_lang::check::{LibraryMechanism, NameKind, name_of};
use mechc_pipeline::Checked;
use mechc_syntax::ast::{ExprKind, Feature, Item as Declaration, ItemKind as Declared, Mechanism, MechanismName, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{CONSTANTS, JointSpec};
use std::cell::Cell;

/// A mechanism with its names.
pub(super) struct Scope<'s> {
    pub checked: &'s Checked,
    pub tree: &'s Mechanism,
    /// The start of the declaration around the cursor, whose name is not in scope in itself.
    pub declared_at: u32,
    /// The filter for mechanisms with very many names.
    pub filter: &'s NameFilter<'s>,
}

/// A filter that limits the work for very many names: it keeps those that match the letters typed, and only the first get a description.
pub(super) struct NameFilter<'s> {
    letters: Option<&'s str>,
    described: Cell<usize>,
}

impl<'s> NameFilter<'s> {
    /// Creates a filter for a mechanism and the letters typed.
    pub fn new(tree: Option<&Mechanism>, letters: &'s str) -> NameFilter<'s> {
        let has_many = tree.is_some_and(|tree| tree.items.len() > MAX_ITEMS);
        NameFilter { letters: has_many.then_some(letters), described: Cell::new(0) }
    }

    /// Returns whether names may have been left out.
    pub fn is_needed(&self) -> bool {
        self.letters.is_some()
    }

    fn admits(&self, label: &str) -> bool {
        self.letters.is_none_or(|letters| matches_letters(label, letters))
    }

    fn admits_description(&self) -> bool {
        self.described.set(self.described.get() + 1);
        self.letters.is_none() || self.described.get() <= MAX_ITEMS
    }
}

/// The target of a path.
enum PathTarget<'s> {
    Features(&'s str, &'s [Feature]),
    Part(&'s Mechanism),
    Coordinates,
}

impl Scope<'_> {
    /// Returns items for the names of the expected kind.
    pub fn fitting(&self, expected: Expected, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        let items = self.tree.items.iter().filter(|item| item.span.start != self.declared_at);
        match expected {
            _ if expected.is_feature() => {
                let mut found = self.local_features(expected, cursor);
                found.extend(items.clone().flat_map(|item| self.features_of(item, expected)));
                if expected == Expected::Point {
                    found.extend(items.filter(|item| is_point(item)).filter_map(|item| self.named(item, 2)));
                }
                found
            }
            Expected::Body => items.filter_map(|item| self.body(item)).collect(),
            Expected::Joint(quantity) => items.filter_map(|item| self.joint(item, quantity)).collect(),
            Expected::Equation => items.filter_map(|item| self.equation(item)).collect(),
            Expected::Variable => {
                let is_variable =
                    |item: &&Declaration| matches!(item.kind, Declared::Param { .. } | Declared::Input { .. });
                items.filter(is_variable).filter_map(|item| self.named(item, 1)).collect()
            }
            Expected::Number(_) => self.numbers(items, cursor),
            _ => Vec::new(),
        }
    }

    /// Returns items for the features of the body around the cursor, by their names alone.
    fn local_features(&self, expected: Expected, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        if cursor.block != Block::Features {
            return Vec::new();
        }
        let at = cursor.start() as u32;
        let around = self.tree.items.iter().find(|item| item.span.start <= at && at <= item.span.end);
        let features = around.map(features).unwrap_or_default();
        let others = features.iter().filter(|feature| feature.span.start != at && expected.matches(&feature.kind));
        others.map(|feature| self.feature(feature, "this body", 1)).collect()
    }

    fn text(&self, span: Span) -> &str {
        self.checked.sources().text(span)
    }

    /// Returns an item for a declared name, described by its declaration.
    fn named(&self, item: &Declaration, rank: u8) -> Option<CompletionItem> {
        let name = name_of(item).filter(|name| self.filter.admits(&name.text))?;
        let kind = match NameKind::of(item) {
            NameKind::Function | NameKind::Table => CompletionItemKind::Function,
            NameKind::Body | NameKind::Ground | NameKind::Part => CompletionItemKind::Body,
            NameKind::Joint => CompletionItemKind::DeclaredJoint,
            _ => CompletionItemKind::Value,
        };
        let mut found = CompletionItem::new(&name.text, kind, rank);
        if self.filter.admits_description() {
            found = found.detail(self.head(item)).docs(self.docs(item));
        }
        if kind == CompletionItemKind::Function {
            let argument = match &item.kind {
                Declared::Function { argument, .. } => argument.text.as_str(),
                _ => "u",
            };
            found.signature = format!("({argument})");
            found.insert = Template::from_marked(&format!("{}(«{argument}»)", name.text));
        } else if !item.ranges.is_empty() {
            found.insert = Template::from_marked(&with_indices(item, &name.text));
            "[…]".clone_into(&mut found.signature);
        }
        Some(found)
    }

    /// Returns the declaration without its block, on one line.
    fn head(&self, item: &Declaration) -> String {
        let text = self.text(item.span);
        let text = text.split('{').next().unwrap_or(text);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn docs(&self, item: &Declaration) -> String {
        let text = self.text(item.span);
        let head = text.split('{').next().unwrap_or(text).trim_end();
        [item.docs.join("\n"), format!("```mech\n{head}\n```")].join("\n\n").trim().to_owned()
    }

    fn feature(&self, feature: &Feature, of: &str, rank: u8) -> CompletionItem {
        let found = CompletionItem::new(&feature.name.text, CompletionItemKind::Feature, rank);
        if !self.filter.admits_description() {
            return found;
        }
        let text = self.text(feature.span);
        let docs = [feature.docs.join("\n"), format!("```mech\n{text}\n```")].join("\n\n").trim().to_owned();
        found.detail(format!("{text}, of {of}")).docs(docs)
    }

    /// Returns items for the features of a body or the ground, by their paths; for a part, an item for its name.
    fn features_of(&self, item: &Declaration, expected: Expected) -> Vec<CompletionItem> {
        if let Declared::Part(part) = &item.kind {
            let marked = format!("{}.", with_indices(item, &part.name.text));
            return vec![
                CompletionItem::new(format!("{}.", part.name.text), CompletionItemKind::Body, 3)
                    .detail(self.head(item))
                    .inserts(Template::from_marked(&marked)),
            ];
        }
        let owner = name_of(item).map_or("ground", |name| name.text.as_str());
        let fitting = features(item).iter().filter(|feature| expected.matches(&feature.kind));
        let path = |feature: &Feature| {
            let label = format!("{owner}.{}", feature.name.text);
            if !self.filter.admits(&label) {
                return None;
            }
            let marked = format!("{}.{}", with_indices(item, owner), feature.name.text);
            Some(CompletionItem { label, insert: Template::from_marked(&marked), ..self.feature(feature, owner, 1) })
        };
        fitting.filter_map(path).collect()
    }

    fn body(&self, item: &Declaration) -> Option<CompletionItem> {
        match &item.kind {
            Declared::Body { .. } => self.named(item, 1),
            Declared::Ground { .. } => {
                Some(CompletionItem::new("ground", CompletionItemKind::Body, 2).detail("the body that does not move"))
            }
            Declared::Part(_) => self.features_of(item, Expected::Point).pop(),
            _ => None,
        }
    }

    fn joint(&self, item: &Declaration, quantity: &str) -> Option<CompletionItem> {
        match &item.kind {
            Declared::Joint { kind, .. } if has_quantity(kind, quantity) => self.named(item, 1),
            Declared::Part(_) => self.features_of(item, Expected::Point).pop(),
            _ => None,
        }
    }

    fn equation(&self, item: &Declaration) -> Option<CompletionItem> {
        match &item.kind {
            Declared::Equation { .. } => self.named(item, 1),
            Declared::Part(_) => self.features_of(item, Expected::Point).pop(),
            _ => None,
        }
    }

    /// Returns items for the numbers that the declaration around the cursor may use.
    fn numbers<'i>(&self, items: impl Iterator<Item = &'i Declaration>, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        let head = cursor.head();
        let has_time = matches!(
            head,
            "input" | "driver" | "load" | "measure" | "trace" | "result" | "require" | "constraint" | "part" | "fn"
        );
        let has_measures = matches!(head, "measure" | "trace" | "result" | "require");
        let rank = |item: &Declaration| match NameKind::of(item) {
            NameKind::Param => Some(1),
            NameKind::Input => has_time.then_some(1),
            NameKind::Measure => has_measures.then_some(2),
            NameKind::Result => matches!(head, "result" | "require").then_some(2),
            NameKind::Function | NameKind::Table => Some(3),
            _ => None,
        };
        let mut found: Vec<CompletionItem> = items.filter_map(|item| self.named(item, rank(item)?)).collect();
        found.extend(arguments(cursor));
        for constant in CONSTANTS.iter().filter(|constant| constant.word.name != "ground") {
            if constant.word.name != "t" || has_time {
                found.push(CompletionItem::word(&constant.word, 3));
            }
        }
        found
    }

    /// Returns items for the members after a path; for all of them if `expected` is empty.
    pub fn members(&self, path: &[&str], expected: &[Expected]) -> Vec<CompletionItem> {
        match self.resolve(path) {
            None => Vec::new(),
            Some(PathTarget::Coordinates) => ["x", "y"]
                .iter()
                .filter(|_| expected.is_empty())
                .map(|name| CompletionItem::new(*name, CompletionItemKind::Value, 1).detail("coordinate of the point"))
                .collect(),
            Some(PathTarget::Features(owner, features)) => {
                let fits =
                    |feature: &&Feature| expected.is_empty() || expected.iter().any(|kind| kind.matches(&feature.kind));
                features.iter().filter(fits).map(|feature| self.feature(feature, owner, 1)).collect()
            }
            Some(PathTarget::Part(tree)) => {
                let scope = Scope { tree, declared_at: u32::MAX, ..*self };
                tree.items.iter().filter_map(|item| scope.of_part(item, expected)).collect()
            }
        }
    }

    /// Returns an item for a name of a part, as seen from outside the part.
    fn of_part(&self, item: &Declaration, expected: &[Expected]) -> Option<CompletionItem> {
        let has_members = |kind: &Expected| match item.kind {
            Declared::Part(_) => {
                kind.is_feature() || matches!(kind, Expected::Joint(_) | Expected::Equation | Expected::Body)
            }
            Declared::Body { .. } | Declared::Ground { .. } => kind.is_feature(),
            _ => false,
        };
        let fits = |kind: &Expected| match (kind, &item.kind) {
            (Expected::Joint(quantity), Declared::Joint { kind: joint, .. }) => has_quantity(joint, quantity),
            (Expected::Body, Declared::Body { .. } | Declared::Ground { .. })
            | (Expected::Equation, Declared::Equation { .. })
            | (Expected::Number(_), Declared::Measure { .. } | Declared::Result { .. })
            | (Expected::Number(_) | Expected::Variable, Declared::Param { .. } | Declared::Input { .. }) => true,
            (Expected::Point, Declared::Param { .. }) => is_point(item),
            _ => false,
        };
        if !expected.is_empty() && !expected.iter().any(|kind| fits(kind) || has_members(kind)) {
            return None;
        }
        match &item.kind {
            Declared::Ground { .. } => {
                Some(CompletionItem::new("ground", CompletionItemKind::Body, 3).detail("what is fixed in the part"))
            }
            Declared::Function { .. }
            | Declared::Table { .. }
            | Declared::Equation { .. }
            | Declared::Analysis { .. } => None,
            _ => self.named(item, 1),
        }
    }

    fn resolve(&self, path: &[&str]) -> Option<PathTarget<'_>> {
        let (first, mut rest) = path.split_first()?;
        let mut item = item_named(self.tree, first)?;
        loop {
            match (&item.kind, rest) {
                (Declared::Body { features, .. } | Declared::Ground { features }, []) => {
                    let owner = name_of(item).map_or("ground", |name| name.text.as_str());
                    return Some(PathTarget::Features(owner, features));
                }
                (Declared::Part(part), []) => return Some(PathTarget::Part(self.mechanism(&part.mechanism)?)),
                (Declared::Part(part), [next, behind @ ..]) => {
                    item = item_named(self.mechanism(&part.mechanism)?, next)?;
                    rest = behind;
                }
                (Declared::Param { .. }, []) if is_point(item) => return Some(PathTarget::Coordinates),
                (Declared::Body { .. } | Declared::Ground { .. }, [_]) => return Some(PathTarget::Coordinates),
                _ => return None,
            }
        }
    }

    fn mechanism(&self, name: &MechanismName) -> Option<&Mechanism> {
        find_mechanism(self.checked.library(), name, self.checked).map(|id| self.checked.library().tree(id))
    }

    /// Returns items for the names of a part's mechanism that can be bound.
    pub fn bindable(&self, prefix: Option<&str>, name: &str) -> Vec<CompletionItem> {
        let library = self.checked.library();
        let found =
            all_mechanisms(self.checked).find(|(before, id)| *before == prefix && library.tree(*id).name.text == name);
        let Some(tree) = found.map(|(_, id)| library.tree(id)) else { return Vec::new() };
        let is_bindable = |item: &&Declaration| matches!(item.kind, Declared::Param { .. } | Declared::Input { .. });
        let item = |item: &Declaration| {
            let found = self.named(item, 1)?;
            let insert = Template::from_marked(&format!("{} = «»", found.label));
            Some(CompletionItem { signature: String::new(), ..found }.inserts(insert))
        };
        tree.items.iter().filter(is_bindable).filter_map(item).collect()
    }
}

/// Returns items for the argument of the function or curve and the indices of the repetition around the cursor.
fn arguments(cursor: &Cursor<'_>) -> Vec<CompletionItem> {
    let tokens = cursor.declaration();
    let is_called = matches!(cursor.head(), "fn" | "curve");
    let argument = tokens.get(3).filter(|_| is_called && tokens.get(2).is_some_and(|token| token.text == "("));
    let indices = tokens
        .windows(2)
        .filter(|pair| matches!(pair[0].text, "[" | ",") && tokens.get(2).is_some_and(|token| token.text == "["));
    let behind = tokens.iter().position(|token| matches!(token.text, ":" | "=")).unwrap_or(tokens.len());
    let indices = indices.filter(|pair| tokens[..behind].iter().any(|token| token.start == pair[1].start));
    let names = argument.into_iter().copied().chain(indices.map(|pair| pair[1]));
    names
        .map(|token| CompletionItem::new(token.text, CompletionItemKind::Value, 0).detail("of this declaration"))
        .collect()
}

/// Returns the features of a body or the ground.
fn features(item: &Declaration) -> &[Feature] {
    match &item.kind {
        Declared::Body { features, .. } | Declared::Ground { features } => features,
        _ => &[],
    }
}

/// Returns whether a param is evidently a point: a tuple, or a call that returns a point.
fn is_point(item: &Declaration) -> bool {
    match &item.kind {
        Declared::Param { value, .. } => match &value.bare().kind {
            ExprKind::Tuple(_) => true,
            ExprKind::Call { name, .. } => matches!(name.text.as_str(), "polar" | "mid"),
            _ => false,
        },
        _ => false,
    }
}

/// Returns a name with holes for its indices, marked with `«` and `»`.
fn with_indices(item: &Declaration, name: &str) -> String {
    if item.ranges.is_empty() {
        return name.to_owned();
    }
    let indices: Vec<String> = item.ranges.iter().map(|range| format!("«{}»", range.index.text)).collect();
    format!("{name}[{}]", indices.join(", "))
}

/// Returns all mechanisms that can be parts in the text, each with its prefix.
fn all_mechanisms(checked: &Checked) -> impl Iterator<Item = (Option<&str>, LibraryMechanism)> {
    let files = checked.library().files();
    let this_file = files.first();
    let of = move |file: usize| {
        let count = files.get(file).map_or(0, |file| file.read.tree.mechanisms.len());
        (0..count).map(move |number| LibraryMechanism { file, number })
    };
    let used = this_file.into_iter().flat_map(|file| file.read.tree.uses.iter().zip(&file.uses));
    let used =
        used.filter_map(|(used, number)| Some((used.prefix.as_ref().map(|prefix| prefix.text.as_str()), (*number)?)));
    let local = of(0).map(|id| (None, id));
    local.chain(used.flat_map(move |(prefix, file)| of(file).map(move |id| (prefix, id))))
}

/// Returns whether a joint of a given kind has a quantity.
fn has_quantity(joint: &Name, quantity: &str) -> bool {
    JointSpec::named(&joint.text).is_some_and(|joint| joint.has_quantity(quantity))
}

/// Returns items for the mechanisms that can be parts; after a prefix, for those of its file.
pub(super) fn mechanisms(checked: &Checked, prefix: Option<&str>) -> Vec<CompletionItem> {
    let this = checked.tree().map(|tree| tree.name.span);
    let library = checked.library();
    let others = all_mechanisms(checked).filter(|(_, id)| Some(library.tree(*id).name.span) != this);
    let item = |(before, id): (Option<&str>, LibraryMechanism)| {
        let tree = library.tree(id);
        let label = match before.filter(|_| prefix.is_none()) {
            Some(before) => format!("{before}.{}", tree.name.text),
            None => tree.name.text.clone(),
        };
        let is_here = prefix.is_none() || prefix == before;
        let insert = Template::from_marked(&format!("{label}(«»)"));
        is_here.then(|| {
            CompletionItem::new(label, CompletionItemKind::Mechanism, 1).docs(tree.docs.join("\n")).inserts(insert)
        })
    };
    others.filter_map(item).collect()
}
