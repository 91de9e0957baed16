//! What could be written at a place.
//!
//! By the words before the cursor, for the text there is half-typed; what the names are tells the rest of the text, which is whole.

mod cursor;
mod item;
mod proposals;
mod scope;
mod units;
mod wanted;

pub use item::{CompletionItem, CompletionItemKind, Template};
pub(super) use proposals::{free, free_name};

use super::location::FilePosition;
use super::snapshot::{CheckedFile, Snapshot};
use super::workspace::is_mech;
use super::lexical::holds_letters;
use cursor::{Block, Call, Cursor};
use mechc_pipeline::Checked;
use mechc_syntax::ast::Mechanism;
use mechc_text::vocabulary::{
    FUNCTIONS, Group, JOINTS, KEYWORDS, Keyword, QUANTITIES, REDUCTIONS, ReductionWord, Role, Word, is_before_a_name,
};
use mechc_text::world::{World, beside};
use proposals::OtherDeclarations;
use scope::{Scope, NameFilter};
use std::path::Path;
use wanted::{Expected, wanted};

/// More items than these nobody reads.
const MOST: usize = 200;

/// What fits at a place.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Completions {
    /// The best first.
    pub items: Vec<CompletionItem>,
    /// There are more than anybody reads: of those that go with the letters typed the best are here.
    pub is_incomplete: bool,
}

/// What fits at a place. In a comment nothing does, nor where a new name stands.
#[must_use]
pub fn completions(snapshot: &Snapshot, position: &FilePosition) -> Option<Completions> {
    let parsed = snapshot.parsed(&position.path)?;
    let text = &parsed.sources().get(parsed.file()).text;
    let Some(cursor) = Cursor::at(text, position.offset as usize) else { return Some(Completions::default()) };
    let file = snapshot.checked(&position.path)?;
    let checked = around(&file, position.offset);
    let letters = text.get(cursor.word.start..position.offset as usize).unwrap_or_default();
    let sieve = NameFilter::of(checked.and_then(Checked::tree), letters);
    let here = CompletionContext { snapshot, position, checked, cursor, sieve };
    let mut items = here.items();
    items.sort_by_key(|item| item.rank);
    let is_incomplete = here.sieve.is_needed() || items.len() > MOST;
    if is_incomplete {
        items.retain(|item| holds_letters(&item.label, letters));
        items.truncate(MOST);
    }
    let replaces = here.cursor.word.start as u32..here.cursor.word.end as u32;
    let is_behind_comma = here.cursor.text[..here.cursor.word.start].ends_with(',') && !here.cursor.is_in_string;
    for item in &mut items {
        item.replaces = replaces.clone();
        if is_behind_comma {
            item.insert = Template::plain(" ").followed_by(std::mem::take(&mut item.insert));
        }
    }
    Some(Completions { items, is_incomplete })
}

/// The mechanism that a place is in, be its end not written yet.
fn around(file: &CheckedFile, offset: u32) -> Option<&Checked> {
    let begins = |checked: &&Checked| checked.span().is_some_and(|span| span.start <= offset);
    file.mechanisms.iter().rfind(begins)
}

/// A place with what is known there.
struct CompletionContext<'s> {
    snapshot: &'s Snapshot,
    position: &'s FilePosition,
    checked: Option<&'s Checked>,
    cursor: Cursor<'s>,
    sieve: NameFilter<'s>,
}

impl CompletionContext<'_> {
    fn items(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        if cursor.is_in_string {
            return self.files();
        }
        if let Some(path) = cursor.path() {
            return self.inside(&path);
        }
        if let Some(begun) = cursor.unit() {
            return units::going_on(&begun);
        }
        let is_open = cursor.call().is_some();
        if cursor.may_begin() || cursor.is_first_on_line() && cursor.block == Block::File {
            let mut items = self.declarations();
            items.extend(if cursor.head().is_empty() { Vec::new() } else { self.joining() });
            return items;
        }
        if cursor.is_behind_number() && !cursor.has("columns") {
            let mut items = units::behind_number(self.snapshot, self.position, cursor);
            items.extend(if is_open { self.joining_in_window() } else { self.joining() });
            return items;
        }
        if cursor.is_behind_operand() && !is_open && cursor.declaration().len() > 1 {
            return self.joining();
        }
        self.of_declaration()
    }

    /// Whole declarations, those first that the mechanism lacks.
    fn declarations(&self) -> Vec<CompletionItem> {
        let block = self.cursor.block;
        let fits = |keyword: &&Keyword| match (block, keyword.role) {
            (Block::File, Role::Declaration | Role::Opener) => matches!(keyword.word.name, "mechanism" | "use"),
            (Block::Mechanism, Role::Declaration | Role::Opener) => !matches!(keyword.word.name, "mechanism" | "use"),
            (Block::Features, Role::Feature | Role::FeatureOpener) => true,
            _ => false,
        };
        let mut items: Vec<CompletionItem> = KEYWORDS.iter().filter(fits).map(declaration).collect();
        if block == Block::Mechanism
            && let Some((whole, tree)) = self.whole().zip(self.tree())
        {
            items.extend(proposals::declarations(&whole, tree));
        }
        items
    }

    /// What joins the parts of the declaration, where an operand has ended.
    fn joining(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let words: &[&str] = match cursor.head() {
            "use" => &["as"],
            "body" if cursor.has("at") => &["toward"],
            "body" | "curve" => &["at"],
            "axis" if !cursor.has("along") && !cursor.has("to") => &["along", "to"],
            "circle" => &["radius"],
            "mass" if cursor.has("at") => &["inertia"],
            "mass" => &["at", "inertia"],
            "load" if !cursor.has("on") => &["on"],
            "measure" | "trace" | "result" if !cursor.has("in") => &["in"],
            "part" if cursor.has("at") => &["mirrored"],
            "part" if cursor.has("on") => &["at", "mirrored"],
            "part" if cursor.last() == Some(")") => &["on", "at", "mirrored"],
            "table" => &["columns"],
            "analysis" if !cursor.has("from") => &["from"],
            "analysis" if !cursor.has("to") => &["to"],
            "analysis" if !cursor.has("every") => &["every"],
            _ => &[],
        };
        let is_new = |word: &&&str| cursor.word.is_empty() || !cursor.has(word);
        words.iter().filter(is_new).filter_map(|word| Some(joining(Keyword::named(word)?))).collect()
    }

    /// What an unfinished declaration asks for.
    fn of_declaration(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let is_behind_colon = cursor.last() == Some(":");
        match (cursor.head(), cursor.last()) {
            // a new name
            (head, Some(last)) if head == last && cursor.declaration().len() == 1 && is_before_a_name(head) => {
                Vec::new()
            }
            ("analysis", Some("analysis")) => self.joining(),
            ("measure" | "trace" | "result", Some("in")) => units::printed(),
            ("joint", _) if is_behind_colon => self.joints(),
            ("driver", _) if is_behind_colon => {
                let mut items = self.whole().map(|whole| proposals::drivers(&whole)).unwrap_or_default();
                items.extend(self.formula(&[Expected::Number(None)]));
                items
            }
            ("part", _) if is_behind_colon => self.mechanisms(None),
            ("part", Some("(" | ",")) if self.part_call().is_some() => self.bindings(),
            ("table", Some("=" | "periodic")) => {
                ["spline", "periodic"].iter().filter_map(|word| Some(joining(Keyword::named(word)?))).collect()
            }
            ("table", Some("spline")) | ("part", Some("at")) => Vec::new(),
            _ => {
                let mut items = self.formula(&wanted(cursor));
                items.extend(self.joining_in_window());
                items
            }
        }
    }

    /// What begins the window of a reduction, or goes on with it.
    fn joining_in_window(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let takes_window = |call: &Call<'_>| ReductionWord::named(call.name).is_some_and(|word| !word.takes_time());
        let Some(call) = cursor.call().filter(takes_window).filter(|_| cursor.head() == "result") else {
            return Vec::new();
        };
        let words: &[&str] = match cursor.window(call) {
            None if cursor.last() == Some(",") && call.argument == 1 => &["from", "to"],
            Some("from") if cursor.is_behind_operand() => &["to"],
            _ => &[],
        };
        words.iter().filter_map(|word| Some(joining(Keyword::named(word)?))).collect()
    }

    fn tree(&self) -> Option<&Mechanism> {
        self.checked?.tree()
    }

    fn whole(&self) -> Option<OtherDeclarations> {
        OtherDeclarations::of(self.snapshot, self.position, &self.cursor)
    }

    fn scope(&self) -> Option<Scope<'_>> {
        let declared_at = self.cursor.start() as u32;
        Some(Scope { checked: self.checked?, tree: self.tree()?, declared_at, sieve: &self.sieve })
    }

    /// Kinds of joints, and joints between points that lie on each other.
    fn joints(&self) -> Vec<CompletionItem> {
        let mut items = self.whole().map(|whole| proposals::joints(&whole)).unwrap_or_default();
        items.extend(JOINTS.iter().map(|joint| {
            let item = CompletionItem::word(&joint.word, 1);
            // what they join is asked for when they are there
            let plural = if joint.equations == 1 { "" } else { "s" };
            let detail = format!("{} · {} equation{plural}", joint.takes, joint.equations);
            item.detail(detail)
        }));
        items
    }

    /// The name of the mechanism of a part, where the cursor is among what is bound of it.
    fn part_call(&self) -> Option<(Option<&str>, &str)> {
        let tokens = self.cursor.declaration();
        let colon = tokens.iter().position(|token| token.text == ":")?;
        let name = tokens.get(colon + 1)?.text;
        match tokens.get(colon + 2)?.text {
            "." => Some((Some(name), tokens.get(colon + 3)?.text)),
            "(" => Some((None, name)),
            _ => None,
        }
        .filter(|(_, name)| self.cursor.call().is_some_and(|call| call.name == *name))
    }

    /// What can be bound of the part.
    fn bindings(&self) -> Vec<CompletionItem> {
        let (Some(scope), Some((prefix, name))) = (self.scope(), self.part_call()) else { return Vec::new() };
        let taken = self.cursor.call().map(|call| self.cursor.arguments(call)).unwrap_or_default();
        let is_free = |item: &CompletionItem| {
            !taken.iter().any(|bound| bound.split('=').next().map(str::trim) == Some(&item.label))
        };
        scope.bindable(prefix, name).into_iter().filter(is_free).collect()
    }

    fn mechanisms(&self, prefix: Option<&str>) -> Vec<CompletionItem> {
        self.checked.map(|checked| scope::mechanisms(checked, prefix)).unwrap_or_default()
    }

    /// What stands behind the dot of a path.
    fn inside(&self, path: &[&str]) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        if cursor.head() == "part" && cursor.call().is_none() && !cursor.has("on") {
            return self.mechanisms(path.first().copied());
        }
        let Some(scope) = self.scope() else { return Vec::new() };
        let wanted = wanted(cursor);
        let fitting = scope.inside(path, &wanted);
        // a number can begin with a point, as its x
        if fitting.is_empty() || wanted.iter().any(|wanted| matches!(wanted, Expected::Number(_))) {
            return scope.inside(path, &[]);
        }
        fitting
    }

    /// What a formula can go on with.
    fn formula(&self, wanted: &[Expected]) -> Vec<CompletionItem> {
        let Some(scope) = self.scope() else { return Vec::new() };
        let cursor = &self.cursor;
        let mut items = Vec::new();
        let other = cursor.call().map(|call| cursor.arguments(call)).unwrap_or_default();
        for wanted in wanted {
            items.extend(scope.fitting(*wanted, cursor));
            if *wanted == Expected::Side {
                items.extend(
                    ["left", "right"]
                        .iter()
                        .filter_map(|side| Some(CompletionItem::word(&Keyword::named(side)?.word, 1))),
                );
            }
        }
        // on one body nothing is joined
        if cursor.head() == "joint"
            && let Some((body, _)) = other.first().and_then(|first| first.rsplit_once('.'))
        {
            let is_of_it = |item: &CompletionItem| item.label.rsplit_once('.').is_some_and(|(own, _)| own == body);
            items.retain(|item| !is_of_it(item));
            self.prefer_touching(other.first().copied().unwrap_or_default(), &mut items);
        }
        let is_number = wanted.iter().any(|wanted| match wanted {
            Expected::Number(_) => true,
            // points of drawings are calculated with
            Expected::Point => is_drawn(cursor.head()),
            _ => false,
        });
        if is_number && cursor.head() != "joint" {
            items.extend(called(cursor.head()).map(|word| CompletionItem::word(word, 4)));
            items.extend(Keyword::named("if").map(declaration));
        }
        let mut seen = std::collections::BTreeSet::new();
        items.retain(|item| seen.insert((item.label.clone(), item.kind as u8)));
        items
    }

    /// Puts the points first that lie on another one.
    fn prefer_touching(&self, point: &str, items: &mut [CompletionItem]) {
        let touching = self.whole().map(|whole| whole.touching()).unwrap_or_default();
        for item in items {
            let lies_there =
                touching.iter().any(|pair| pair.contains(&item.label) && pair.iter().any(|one| one == point));
            if lies_there {
                item.rank = 0;
                item.detail = format!("lies on `{point}`");
            }
        }
    }

    /// The files beside the text that can stand in a string.
    fn files(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let fits = |name: &str| match cursor.head() {
            "use" => is_mech(name) && Path::new(name).file_name() != self.position.path.file_name(),
            _ => Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")),
        };
        if !matches!(cursor.head(), "use" | "table") {
            return Vec::new();
        }
        let typed = &cursor.text[cursor.word.start..self.position.offset as usize];
        let within = typed.rfind('/').map_or("", |end| &typed[..=end]);
        let folder = beside(&self.position.path.to_string_lossy(), within);
        let world = self.snapshot.buffers();
        let files = world.names_in(&folder).into_iter().filter(|name| fits(name));
        let mut items: Vec<CompletionItem> =
            files.map(|name| CompletionItem::new(format!("{within}{name}"), CompletionItemKind::File, 1)).collect();
        let folders = world.folders_in(&folder).into_iter().filter(|name| !name.starts_with('.'));
        items
            .extend(folders.map(|name| CompletionItem::new(format!("{within}{name}/"), CompletionItemKind::Folder, 2)));
        items
    }
}

/// Whether formulas of points may stand in a declaration.
fn is_drawn(head: &str) -> bool {
    matches!(head, "param" | "point" | "axis" | "circle" | "curve" | "body")
}

/// The words that a formula of a declaration may call.
fn called(head: &str) -> impl Iterator<Item = &'static Word> {
    let has_quantities = matches!(head, "measure" | "trace" | "result" | "driver" | "constraint" | "load" | "part");
    let has_forces = matches!(head, "measure" | "result");
    let has_reductions = head == "result";
    let is_drawn = is_drawn(head);
    let quantities = QUANTITIES.iter().filter(move |quantity| has_quantities && (has_forces || !quantity.is_force));
    let quantities = quantities.map(|quantity| &quantity.word);
    let reductions = REDUCTIONS.iter().filter(move |_| has_reductions).map(|reduction| &reduction.word);
    let is_there = move |function: &&mechc_text::vocabulary::Function| match function.group {
        Group::Points => is_drawn,
        Group::Derivative => !is_drawn,
        _ => true,
    };
    reductions.chain(quantities).chain(FUNCTIONS.iter().filter(is_there).map(|function| &function.word))
}

/// A whole declaration by its keyword.
fn declaration(keyword: &'static Keyword) -> CompletionItem {
    let form = keyword.word.forms.first().copied().unwrap_or(keyword.word.name);
    CompletionItem::word(&keyword.word, 2).inserts(Template::of_form(form))
}

/// A word that joins two parts of a declaration.
fn joining(keyword: &'static Keyword) -> CompletionItem {
    CompletionItem::word(&keyword.word, 1).inserts(Template::plain(format!("{} ", keyword.word.name)))
}

#[cfg(test)]
mod tests;
