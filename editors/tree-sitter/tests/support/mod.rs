//! The texts of the project, and what its own reader finds in them.

#![allow(dead_code)] // each test file uses its part

use mechc::{Sources, Span};
use mechc_syntax::ast::{Feature, FeatureKind, File, Item, ItemKind};
use mechc_syntax::parse;
use std::collections::BTreeSet;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use tree_sitter::{Node, Parser, Tree};

/// A text with its name.
pub struct Text {
    pub name: String,
    pub text: String,
}

/// A declaration: its rule, and where it stands.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Declaration {
    pub kind: &'static str,
    pub start: usize,
    /// None of what holds something broken: where that ends is not to be told.
    pub end: Option<usize>,
}

/// What the project's own reader finds in a text.
pub struct Read {
    pub is_valid: bool,
    /// Those that are whole.
    pub declarations: Vec<Declaration>,
}

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All `.mech` files of the project, and the code blocks of its pages.
pub fn texts() -> Vec<Text> {
    let mut texts = Vec::new();
    for folder in ["examples", "tests", "fuzz", "editors"] {
        collect(&root().join(folder), &mut texts);
    }
    for folder in ["", "docs", "src/diag/explain", "src/vocabulary/topics", "editors"] {
        for page in files(&root().join(folder)).iter().filter(|path| has_ending(path, "md")) {
            texts.extend(blocks(page));
        }
    }
    texts
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found == ending)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    files
}

fn collect(folder: &Path, texts: &mut Vec<Text>) {
    for path in files(folder) {
        let is_made = path.ends_with("target") || path.ends_with("node_modules");
        if path.is_dir() && !is_made {
            collect(&path, texts);
        } else if has_ending(&path, "mech")
            && let Ok(text) = fs::read_to_string(&path)
        {
            // places are counted without the byte-order mark
            let text = text.trim_start_matches('\u{feff}').to_owned();
            texts.push(Text { name: path.display().to_string(), text });
        }
    }
}

fn blocks(page: &Path) -> Vec<Text> {
    let text = fs::read_to_string(page).expect("a page");
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.starts_with("```mech") {
            let text = lines.by_ref().take_while(|line| *line != "```").map(|line| line.to_owned() + "\n").collect();
            blocks.push(Text { name: format!("{}, block {}", page.display(), blocks.len() + 1), text });
        }
    }
    blocks
}

/// Reads a text as `mechc` does.
pub fn read(text: &str) -> Read {
    let mut sources = Sources::default();
    let file = sources.add("text", text);
    let parsed = parse(&sources, file);
    let mut declarations = Vec::new();
    add_file(&parsed.tree, &mut declarations);
    declarations.sort();
    Read { is_valid: !parsed.faults.has_errors(), declarations }
}

fn add_file(file: &File, into: &mut Vec<Declaration>) {
    into.extend(file.uses.iter().filter(|one| !one.is_broken).map(|one| whole("use", one.span)));
    for mechanism in &file.mechanisms {
        for item in &mechanism.items {
            add_item(item, into);
        }
    }
}

fn add_item(item: &Item, into: &mut Vec<Declaration>) {
    let Some(kind) = rule_of(&item.kind) else { return };
    let features: &[Feature] = match &item.kind {
        ItemKind::Body { features, .. } | ItemKind::Ground { features } => features,
        _ => &[],
    };
    let is_whole = !features.iter().any(|feature| feature.kind == FeatureKind::Broken);
    let declaration = whole(kind, item.span);
    into.push(if is_whole { declaration } else { Declaration { end: None, ..declaration } });
    for feature in features {
        into.extend(rule_of_feature(&feature.kind).map(|kind| whole(kind, feature.span)));
    }
}

fn whole(kind: &'static str, span: Span) -> Declaration {
    Declaration { kind, start: span.start as usize, end: Some(span.end as usize) }
}

fn rule_of(kind: &ItemKind) -> Option<&'static str> {
    Some(match kind {
        ItemKind::Param { .. } => "param",
        ItemKind::Function { .. } => "function",
        ItemKind::Table { .. } => "table",
        ItemKind::Input { .. } => "input",
        ItemKind::Part(_) => "part",
        ItemKind::Ground { .. } => "ground",
        ItemKind::Body { .. } => "body",
        ItemKind::Joint { .. } => "joint",
        ItemKind::Equation { driver: true, .. } => "driver",
        ItemKind::Equation { driver: false, .. } => "constraint",
        ItemKind::Gravity { .. } => "gravity",
        ItemKind::Load { .. } => "load",
        ItemKind::Measure { .. } => "measure",
        ItemKind::Trace { .. } => "trace",
        ItemKind::Result { .. } => "result",
        ItemKind::Requirement(_) => "require",
        ItemKind::Analysis { .. } => "analysis",
        ItemKind::Broken { .. } => return None,
    })
}

fn rule_of_feature(kind: &FeatureKind) -> Option<&'static str> {
    Some(match kind {
        FeatureKind::Point { .. } => "point",
        FeatureKind::AxisAlong { .. } | FeatureKind::AxisTo { .. } => "axis",
        FeatureKind::Circle { .. } => "circle",
        FeatureKind::Curve { .. } => "curve",
        FeatureKind::Mass { .. } => "mass",
        FeatureKind::Broken => return None,
    })
}

/// A parser of the grammar.
pub fn parser() -> Parser {
    let mut parser = Parser::new();
    parser.set_language(&tree_sitter_mech::LANGUAGE.into()).expect("a grammar of this version");
    parser
}

/// The tree of a text.
pub fn tree(text: &str) -> Tree {
    parser().parse(text, None).expect("nothing cancels it")
}

/// Every node that has a name, from the root on.
pub fn nodes(tree: &Tree) -> Vec<Node<'_>> {
    let mut found = vec![tree.root_node()];
    let mut next = 0;
    while let Some(node) = found.get(next).copied() {
        next += 1;
        found.extend((0..node.named_child_count()).filter_map(|index| node.named_child(index as u32)));
    }
    found
}

/// Which of the declarations a tree has: of the same kind, at the same place, with no error within unless something within is broken.
pub fn kept(tree: &Tree, wanted: &[Declaration]) -> usize {
    let nodes = nodes(tree);
    let whole: BTreeSet<(&str, usize, usize)> = nodes
        .iter()
        .filter(|node| !node.has_error())
        .map(|node| (node.kind(), node.start_byte(), node.end_byte()))
        .collect();
    let begun: BTreeSet<(&str, usize)> = nodes.iter().map(|node| (node.kind(), node.start_byte())).collect();
    let is_kept = |one: &&Declaration| match one.end {
        Some(end) => whole.contains(&(one.kind, one.start, end)),
        None => begun.contains(&(one.kind, one.start)),
    };
    wanted.iter().filter(is_kept).count()
}

/// Where the words, numbers and signs of a stretch of text stand; comments and white space are none.
pub fn tokens(text: &str, stretch: Range<usize>) -> Vec<Range<usize>> {
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut at = stretch.start;
    while let Some(first) = text[at..stretch.end].chars().next() {
        let rest = &text[at..stretch.end];
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if is_word(first) {
            rest.find(|c| !is_word(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        if !first.is_whitespace() && !rest.starts_with("//") {
            tokens.push(at..at + length);
        }
        at += length;
    }
    tokens
}
