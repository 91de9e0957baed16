//! The names that are known at a place, by what they are.

use super::MOST;
use super::cursor::{Block, Cursor};
use super::item::{CompletionItem, CompletionItemKind, Template};
use super::expected::Expected;
use crate::occurrences::{item_named, known};
use crate::lexical::holds_letters;
use mechc_lang::check::{KnownMechanism, NameKind, name_of};
use mechc_pipeline::Checked;
use mechc_syntax::ast::{ExprKind, Feature, Item as Declaration, ItemKind as Declared, Mechanism, MechanismName, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{CONSTANTS, JointWord};
use std::cell::Cell;

/// A mechanism with its names.
pub(super) struct Scope<'s> {
    pub checked: &'s Checked,
    pub tree: &'s Mechanism,
    /// Where the declaration around the cursor begins: it is not known in itself.
    pub declared_at: u32,
    /// What is left out where there are very many names.
    pub sieve: &'s NameFilter<'s>,
}

/// Keeps very many names from taking long: those are left out that do not go with the letters typed, and the first ones alone described.
pub(super) struct NameFilter<'s> {
    letters: Option<&'s str>,
    described: Cell<usize>,
}

impl<'s> NameFilter<'s> {
    /// For a mechanism, with the letters typed.
    pub fn of(tree: Option<&Mechanism>, letters: &'s str) -> NameFilter<'s> {
        let has_many = tree.is_some_and(|tree| tree.items.len() > MOST);
        NameFilter { letters: has_many.then_some(letters), described: Cell::new(0) }
    }

    /// Whether anything may have been left out.
    pub fn is_needed(&self) -> bool {
        self.letters.is_some()
    }

    fn lets_pass(&self, label: &str) -> bool {
        self.letters.is_none_or(|letters| holds_letters(label, letters))
    }

    fn is_described(&self) -> bool {
        self.described.set(self.described.get() + 1);
        self.letters.is_none() || self.described.get() <= MOST
    }
}

/// What a path leads to.
enum Inside<'s> {
    Features(&'s str, &'s [Feature]),
    Part(&'s Mechanism),
    Coordinates,
}

impl Scope<'_> {
    /// What fits of a mechanism's names.
    pub fn fitting(&self, wanted: Expected, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        let items = self.tree.items.iter().filter(|item| item.span.start != self.declared_at);
        match wanted {
            _ if wanted.is_feature() => {
                let mut found = self.own_features(wanted, cursor);
                found.extend(items.clone().flat_map(|item| self.features_of(item, wanted)));
                if wanted == Expected::Point {
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

    /// The points of the body around the cursor, by their names alone.
    fn own_features(&self, wanted: Expected, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        if cursor.block != Block::Features {
            return Vec::new();
        }
        let at = cursor.start() as u32;
        let around = self.tree.items.iter().find(|item| item.span.start <= at && at <= item.span.end);
        let features = around.map(features).unwrap_or_default();
        let others = features.iter().filter(|feature| feature.span.start != at && wanted.is(&feature.kind));
        others.map(|feature| self.feature(feature, "this body", 1)).collect()
    }

    fn text(&self, span: Span) -> &str {
        self.checked.sources().text(span)
    }

    /// A declared name with its declaration.
    fn named(&self, item: &Declaration, rank: u8) -> Option<CompletionItem> {
        let name = name_of(item).filter(|name| self.sieve.lets_pass(&name.text))?;
        let kind = match NameKind::of(item) {
            NameKind::Function | NameKind::Table => CompletionItemKind::Function,
            NameKind::Body | NameKind::Ground | NameKind::Part => CompletionItemKind::Body,
            NameKind::Joint => CompletionItemKind::DeclaredJoint,
            _ => CompletionItemKind::Value,
        };
        let mut found = CompletionItem::new(&name.text, kind, rank);
        if self.sieve.is_described() {
            found = found.detail(self.head(item)).docs(self.docs(item));
        }
        if kind == CompletionItemKind::Function {
            let argument = match &item.kind {
                Declared::Function { argument, .. } => argument.text.as_str(),
                _ => "u",
            };
            found.signature = format!("({argument})");
            found.insert = Template::marked(&format!("{}(«{argument}»)", name.text));
        } else if !item.ranges.is_empty() {
            found.insert = Template::marked(&with_indices(item, &name.text));
            "[…]".clone_into(&mut found.signature);
        }
        Some(found)
    }

    /// The declaration without what stands in its braces, on one line.
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
        if !self.sieve.is_described() {
            return found;
        }
        let text = self.text(feature.span);
        let docs = [feature.docs.join("\n"), format!("```mech\n{text}\n```")].join("\n\n").trim().to_owned();
        found.detail(format!("{text}, of {of}")).docs(docs)
    }

    /// Those of a body or the ground, by their paths; of a part its name.
    fn features_of(&self, item: &Declaration, wanted: Expected) -> Vec<CompletionItem> {
        if let Declared::Part(part) = &item.kind {
            let marked = format!("{}.", with_indices(item, &part.name.text));
            return vec![
                CompletionItem::new(format!("{}.", part.name.text), CompletionItemKind::Body, 3)
                    .detail(self.head(item))
                    .inserts(Template::marked(&marked)),
            ];
        }
        let owner = name_of(item).map_or("ground", |name| name.text.as_str());
        let fitting = features(item).iter().filter(|feature| wanted.is(&feature.kind));
        let path = |feature: &Feature| {
            let label = format!("{owner}.{}", feature.name.text);
            if !self.sieve.lets_pass(&label) {
                return None;
            }
            let marked = format!("{}.{}", with_indices(item, owner), feature.name.text);
            Some(CompletionItem { label, insert: Template::marked(&marked), ..self.feature(feature, owner, 1) })
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

    /// What is a number where the declaration around the cursor stands.
    fn numbers<'i>(&self, items: impl Iterator<Item = &'i Declaration>, cursor: &Cursor<'_>) -> Vec<CompletionItem> {
        let head = cursor.head();
        let has_time =
            matches!(head, "input" | "driver" | "load" | "measure" | "trace" | "result" | "constraint" | "part" | "fn");
        let has_measures = matches!(head, "measure" | "trace" | "result");
        let rank = |item: &Declaration| match NameKind::of(item) {
            NameKind::Param => Some(1),
            NameKind::Input => has_time.then_some(1),
            NameKind::Measure => has_measures.then_some(2),
            NameKind::Result => (head == "result").then_some(2),
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

    /// What stands behind a path with a dot; all of it where nothing is wanted.
    pub fn inside(&self, path: &[&str], wanted: &[Expected]) -> Vec<CompletionItem> {
        match self.lead(path) {
            None => Vec::new(),
            Some(Inside::Coordinates) => ["x", "y"]
                .iter()
                .filter(|_| wanted.is_empty())
                .map(|name| CompletionItem::new(*name, CompletionItemKind::Value, 1).detail("coordinate of the point"))
                .collect(),
            Some(Inside::Features(owner, features)) => {
                let fits =
                    |feature: &&Feature| wanted.is_empty() || wanted.iter().any(|wanted| wanted.is(&feature.kind));
                features.iter().filter(fits).map(|feature| self.feature(feature, owner, 1)).collect()
            }
            Some(Inside::Part(tree)) => {
                let scope = Scope { tree, declared_at: u32::MAX, ..*self };
                tree.items.iter().filter_map(|item| scope.of_part(item, wanted)).collect()
            }
        }
    }

    /// A name of a part, as it is seen from outside.
    fn of_part(&self, item: &Declaration, wanted: &[Expected]) -> Option<CompletionItem> {
        let leads_on = |wanted: &Expected| match item.kind {
            Declared::Part(_) => {
                wanted.is_feature() || matches!(wanted, Expected::Joint(_) | Expected::Equation | Expected::Body)
            }
            Declared::Body { .. } | Declared::Ground { .. } => wanted.is_feature(),
            _ => false,
        };
        let fits = |wanted: &Expected| match (wanted, &item.kind) {
            (Expected::Joint(quantity), Declared::Joint { kind, .. }) => has_quantity(kind, quantity),
            (Expected::Body, Declared::Body { .. } | Declared::Ground { .. })
            | (Expected::Equation, Declared::Equation { .. })
            | (Expected::Number(_), Declared::Measure { .. } | Declared::Result { .. })
            | (Expected::Number(_) | Expected::Variable, Declared::Param { .. } | Declared::Input { .. }) => true,
            (Expected::Point, Declared::Param { .. }) => is_point(item),
            _ => false,
        };
        if !wanted.is_empty() && !wanted.iter().any(|wanted| fits(wanted) || leads_on(wanted)) {
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

    fn lead(&self, path: &[&str]) -> Option<Inside<'_>> {
        let (first, mut rest) = path.split_first()?;
        let mut item = item_named(self.tree, first)?;
        loop {
            match (&item.kind, rest) {
                (Declared::Body { features, .. } | Declared::Ground { features }, []) => {
                    let owner = name_of(item).map_or("ground", |name| name.text.as_str());
                    return Some(Inside::Features(owner, features));
                }
                (Declared::Part(part), []) => return Some(Inside::Part(self.mechanism(&part.mechanism)?)),
                (Declared::Part(part), [next, behind @ ..]) => {
                    item = item_named(self.mechanism(&part.mechanism)?, next)?;
                    rest = behind;
                }
                (Declared::Param { .. }, []) if is_point(item) => return Some(Inside::Coordinates),
                (Declared::Body { .. } | Declared::Ground { .. }, [_]) => return Some(Inside::Coordinates),
                _ => return None,
            }
        }
    }

    fn mechanism(&self, name: &MechanismName) -> Option<&Mechanism> {
        known(self.checked.library(), name, self.checked).map(|known| self.checked.library().tree(known))
    }

    /// What can be bound of a mechanism as a part.
    pub fn bindable(&self, prefix: Option<&str>, name: &str) -> Vec<CompletionItem> {
        let library = self.checked.library();
        let found = all_mechanisms(self.checked)
            .find(|(before, known)| *before == prefix && library.tree(*known).name.text == name);
        let Some(tree) = found.map(|(_, known)| library.tree(known)) else { return Vec::new() };
        let is_bindable = |item: &&Declaration| matches!(item.kind, Declared::Param { .. } | Declared::Input { .. });
        let item = |item: &Declaration| {
            let found = self.named(item, 1)?;
            let insert = Template::marked(&format!("{} = «»", found.label));
            Some(CompletionItem { signature: String::new(), ..found }.inserts(insert))
        };
        tree.items.iter().filter(is_bindable).filter_map(item).collect()
    }
}

/// The argument of the function or curve, and the numbers of the repetition around the cursor.
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

/// The features of a body or of the ground.
fn features(item: &Declaration) -> &[Feature] {
    match &item.kind {
        Declared::Body { features, .. } | Declared::Ground { features } => features,
        _ => &[],
    }
}

/// Whether a param is a point, as far as its own words tell.
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

/// A name with places for the numbers of what is repeated.
fn with_indices(item: &Declaration, name: &str) -> String {
    if item.ranges.is_empty() {
        return name.to_owned();
    }
    let indices: Vec<String> = item.ranges.iter().map(|range| format!("«{}»", range.index.text)).collect();
    format!("{name}[{}]", indices.join(", "))
}

/// All mechanisms that can be parts in the text, each with the prefix before it.
fn all_mechanisms(checked: &Checked) -> impl Iterator<Item = (Option<&str>, KnownMechanism)> {
    let files = checked.library().files();
    let own = files.first();
    let of = move |file: usize| {
        let count = files.get(file).map_or(0, |file| file.read.tree.mechanisms.len());
        (0..count).map(move |number| KnownMechanism { file, number })
    };
    let used = own.into_iter().flat_map(|own| own.read.tree.uses.iter().zip(&own.uses));
    let used =
        used.filter_map(|(used, number)| Some((used.prefix.as_ref().map(|prefix| prefix.text.as_str()), (*number)?)));
    let own = of(0).map(|known| (None, known));
    own.chain(used.flat_map(move |(prefix, file)| of(file).map(move |known| (prefix, known))))
}

/// Whether a joint, by the word that it is declared with, has a quantity.
fn has_quantity(joint: &Name, quantity: &str) -> bool {
    JointWord::named(&joint.text).is_some_and(|joint| joint.kind.has_quantity(quantity))
}

/// Mechanisms that can be parts; behind a prefix those of its file.
pub(super) fn mechanisms(checked: &Checked, prefix: Option<&str>) -> Vec<CompletionItem> {
    let own = checked.tree().map(|tree| tree.name.span);
    let library = checked.library();
    let others = all_mechanisms(checked).filter(|(_, known)| Some(library.tree(*known).name.span) != own);
    let item = |(before, known): (Option<&str>, KnownMechanism)| {
        let tree = library.tree(known);
        let label = match before.filter(|_| prefix.is_none()) {
            Some(before) => format!("{before}.{}", tree.name.text),
            None => tree.name.text.clone(),
        };
        let is_here = prefix.is_none() || prefix == before;
        let insert = Template::marked(&format!("{label}(«»)"));
        is_here.then(|| {
            CompletionItem::new(label, CompletionItemKind::Mechanism, 1).docs(tree.docs.join("\n")).inserts(insert)
        })
    };
    others.filter_map(item).collect()
}
