//! Completion at a position.
//!
//! The words before the cursor decide what fits, since the text there is unfinished; the names come from the checked rest of the text.

mod cursor;
mod expected;
mod item;
mod proposals;
mod scope;
mod units;

pub use item::{CompletionItem, CompletionItemKind, Template};
pub(super) use proposals::{free_name, free_quantities};

use super::lexical::matches_letters;
use super::location::FilePosition;
use super::snapshot::{CheckedFile, Snapshot};
use super::workspace::is_mech;
use cursor::{Block, Call, Cursor};
use expected::{Expected, expected};
use mechc_pipeline::Checked;
use mechc_syntax::ast::Mechanism;
use mechc_text::vocabulary::{
    FUNCTIONS, Group, JOINTS, KEYWORDS, Keyword, QUANTITIES, REDUCTIONS, ReductionWord, Role, Word, declares_name,
};
use mechc_text::world::{World, beside};
use proposals::OtherDeclarations;
use scope::{NameFilter, Scope};
use std::path::Path;

/// The maximum number of items in a list.
const MAX_ITEMS: usize = 200;

/// The completions at a position.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Completions {
    /// The items, best first.
    pub items: Vec<CompletionItem>,
    /// True if items were left out: the list then holds the best of those that match the letters typed.
    pub is_incomplete: bool,
}

/// Returns the completions at a position. There are none in a comment or where a new name is declared.
#[must_use]
pub fn completions(snapshot: &Snapshot, position: &FilePosition) -> Option<Completions> {
    let parsed = snapshot.parsed(&position.path)?;
    let text = &parsed.sources().get(parsed.file()).text;
    let Some(cursor) = Cursor::new(text, position.offset as usize) else { return Some(Completions::default()) };
    let file = snapshot.checked(&position.path)?;
    let checked = mechanism_before(&file, position.offset);
    let letters = text.get(cursor.word.start..position.offset as usize).unwrap_or_default();
    let filter = NameFilter::new(checked.and_then(Checked::tree), letters);
    let context = CompletionContext { snapshot, position, checked, cursor, filter };
    let mut items = context.items();
    items.sort_by_key(|item| item.rank);
    let is_incomplete = context.filter.is_needed() || items.len() > MAX_ITEMS;
    if is_incomplete {
        items.retain(|item| matches_letters(&item.label, letters));
        items.truncate(MAX_ITEMS);
    }
    let replaces = context.cursor.word.start as u32..context.cursor.word.end as u32;
    let is_behind_comma =
        context.cursor.text[..context.cursor.word.start].ends_with(',') && !context.cursor.is_in_string;
    for item in &mut items {
        item.replaces = replaces.clone();
        if is_behind_comma {
            item.insert = Template::plain(" ").followed_by(std::mem::take(&mut item.insert));
        }
    }
    Some(Completions { items, is_incomplete })
}

/// Returns the mechanism at an offset; its end need not be written yet.
fn mechanism_before(file: &CheckedFile, offset: u32) -> Option<&Checked> {
    let begins = |checked: &&Checked| checked.span().is_some_and(|span| span.start <= offset);
    file.mechanisms.iter().rfind(begins)
}

/// The cursor with the snapshot and the mechanism around it.
struct CompletionContext<'s> {
    snapshot: &'s Snapshot,
    position: &'s FilePosition,
    checked: Option<&'s Checked>,
    cursor: Cursor<'s>,
    filter: NameFilter<'s>,
}

impl CompletionContext<'_> {
    fn items(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        if cursor.is_in_string {
            return self.files();
        }
        if let Some(path) = cursor.path() {
            return self.members(&path);
        }
        if let Some(partial) = cursor.unit() {
            return units::continuations(&partial);
        }
        let is_open = cursor.call().is_some();
        if cursor.may_begin() || cursor.is_first_on_line() && cursor.block == Block::File {
            let mut items = self.declarations();
            items.extend(if cursor.head().is_empty() { Vec::new() } else { self.joining() });
            return items;
        }
        if cursor.is_behind_number() && !cursor.has("columns") {
            let mut items = units::after_number(self.snapshot, self.position, cursor);
            items.extend(if is_open { self.joining_in_window() } else { self.joining() });
            return items;
        }
        if cursor.is_behind_operand() && !is_open && cursor.declaration().len() > 1 {
            return self.joining();
        }
        self.in_declaration()
    }

    /// Proposes whole declarations, first those that the mechanism lacks.
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
            && let Some((others, tree)) = self.other_declarations().zip(self.tree())
        {
            items.extend(proposals::declarations(&others, tree));
        }
        items
    }

    /// Proposes the keywords that may follow an operand in the declaration.
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

    /// Proposes what may continue an unfinished declaration.
    fn in_declaration(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let is_behind_colon = cursor.last() == Some(":");
        match (cursor.head(), cursor.last()) {
            // a new name is declared here
            (head, Some(last)) if head == last && cursor.declaration().len() == 1 && declares_name(head) => Vec::new(),
            ("analysis", Some("analysis")) => self.joining(),
            ("measure" | "trace" | "result", Some("in")) => units::printed(),
            ("joint", _) if is_behind_colon => self.joints(),
            ("driver", _) if is_behind_colon => {
                let mut items = self.other_declarations().map(|others| proposals::drivers(&others)).unwrap_or_default();
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
                let mut items = self.formula(&expected(cursor));
                items.extend(self.joining_in_window());
                items
            }
        }
    }

    /// Proposes the keywords of the window of a reduction.
    fn joining_in_window(&self) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        let takes_window = |call: &Call<'_>| ReductionWord::named(call.name).is_some_and(|word| !word.takes_time());
        let Some(call) = cursor.call().filter(takes_window).filter(|_| matches!(cursor.head(), "result" | "require"))
        else {
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

    fn other_declarations(&self) -> Option<OtherDeclarations> {
        OtherDeclarations::new(self.snapshot, self.position, &self.cursor)
    }

    fn scope(&self) -> Option<Scope<'_>> {
        let declared_at = self.cursor.start() as u32;
        Some(Scope { checked: self.checked?, tree: self.tree()?, declared_at, filter: &self.filter })
    }

    /// Proposes kinds of joints, and joints between coincident points.
    fn joints(&self) -> Vec<CompletionItem> {
        let mut items = self.other_declarations().map(|others| proposals::joints(&others)).unwrap_or_default();
        items.extend(JOINTS.iter().map(|joint| {
            let item = CompletionItem::word(&joint.word, 1);
            // the arguments are proposed one by one after the parenthesis
            let plural = if joint.rows.len() == 1 { "" } else { "s" };
            let detail = format!("{} · {} equation{plural}", joint.takes, joint.rows.len());
            item.detail(detail)
        }));
        items
    }

    /// Returns the mechanism of a part as prefix and name, if the cursor is among its bindings.
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

    /// Proposes the names of the part that can be bound.
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

    /// Proposes the members after the dot of a path.
    fn members(&self, path: &[&str]) -> Vec<CompletionItem> {
        let cursor = &self.cursor;
        if cursor.head() == "part" && cursor.call().is_none() && !cursor.has("on") {
            return self.mechanisms(path.first().copied());
        }
        let Some(scope) = self.scope() else { return Vec::new() };
        let expected = expected(cursor);
        let fitting = scope.members(path, &expected);
        // a number may be a coordinate of a point
        if fitting.is_empty() || expected.iter().any(|kind| matches!(kind, Expected::Number(_))) {
            return scope.members(path, &[]);
        }
        fitting
    }

    /// Proposes what may continue a formula.
    fn formula(&self, expected: &[Expected]) -> Vec<CompletionItem> {
        let Some(scope) = self.scope() else { return Vec::new() };
        let cursor = &self.cursor;
        let mut items = Vec::new();
        let other = cursor.call().map(|call| cursor.arguments(call)).unwrap_or_default();
        for kind in expected {
            items.extend(scope.fitting(*kind, cursor));
            let words: &[&str] = match kind {
                Expected::Side => &["left", "right"],
                Expected::Crossed => &["crossed"],
                _ => &[],
            };
            items.extend(words.iter().filter_map(|word| Some(CompletionItem::word(&Keyword::named(word)?.word, 1))));
        }
        // a joint connects two different bodies
        if cursor.head() == "joint"
            && let Some((body, _)) = other.first().and_then(|first| first.rsplit_once('.'))
        {
            let is_of_it = |item: &CompletionItem| item.label.rsplit_once('.').is_some_and(|(owner, _)| owner == body);
            items.retain(|item| !is_of_it(item));
            self.prefer_coincident(other.first().copied().unwrap_or_default(), &mut items);
        }
        let is_number = expected.iter().any(|kind| match kind {
            Expected::Number(_) => true,
            // a point may be a formula of points in a declaration that is drawn
            Expected::Point => is_drawn(cursor.head()),
            _ => false,
        });
        if is_number && cursor.head() != "joint" {
            items.extend(callable_words(cursor.head()).map(|word| CompletionItem::word(word, 4)));
            items.extend(Keyword::named("if").map(declaration));
        }
        let mut unique = std::collections::BTreeSet::new();
        items.retain(|item| unique.insert((item.label.clone(), item.kind as u8)));
        items
    }

    /// Ranks the points first that coincide with a given one.
    fn prefer_coincident(&self, point: &str, items: &mut [CompletionItem]) {
        let pairs = self.other_declarations().map(|others| others.coincident_points()).unwrap_or_default();
        for item in items {
            let coincides = pairs.iter().any(|pair| pair.contains(&item.label) && pair.iter().any(|one| one == point));
            if coincides {
                item.rank = 0;
                item.detail = format!("lies on `{point}`");
            }
        }
    }

    /// Proposes the files in the folder of the text that a string may name.
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

/// Returns whether a declaration may contain formulas of points.
fn is_drawn(head: &str) -> bool {
    matches!(head, "param" | "point" | "axis" | "circle" | "curve" | "body")
}

/// Returns the words that a formula of a declaration may call.
fn callable_words(head: &str) -> impl Iterator<Item = &'static Word> {
    let has_quantities =
        matches!(head, "measure" | "trace" | "result" | "require" | "driver" | "constraint" | "load" | "part");
    let has_forces = matches!(head, "measure" | "result" | "require");
    let has_reductions = matches!(head, "result" | "require");
    let is_drawn = is_drawn(head);
    let quantities = QUANTITIES.iter().filter(move |quantity| has_quantities && (has_forces || !quantity.is_force()));
    let quantities = quantities.map(|quantity| &quantity.word);
    let reductions = REDUCTIONS.iter().filter(move |_| has_reductions).map(|reduction| &reduction.word);
    let is_available = move |function: &&mechc_text::vocabulary::Function| match function.group {
        Group::Points => is_drawn,
        Group::Derivative => !is_drawn,
        _ => true,
    };
    reductions.chain(quantities).chain(FUNCTIONS.iter().filter(is_available).map(|function| &function.word))
}

/// Returns an item that inserts a whole declaration.
fn declaration(keyword: &'static Keyword) -> CompletionItem {
    let form = keyword.word.forms.first().copied().unwrap_or(keyword.word.name);
    CompletionItem::word(&keyword.word, 2).inserts(Template::from_form(form))
}

/// Returns an item for a keyword within a declaration.
fn joining(keyword: &'static Keyword) -> CompletionItem {
    CompletionItem::word(&keyword.word, 1).inserts(Template::plain(format!("{} ", keyword.word.name)))
}

#[cfg(test)]
mod tests;
