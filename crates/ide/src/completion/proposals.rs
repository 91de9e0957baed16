//! What is missing in a mechanism: joints between points that are drawn onto each other, drivers for what is left free.

use super::cursor::Cursor;
use super::item::{CompletionItem, CompletionItemKind, Template};
use crate::location::FilePosition;
use crate::snapshot::Snapshot;
use mechc_lang::check::name_of;
use mechc_pipeline::{Checked, Drawn};
use mechc_syntax::ast::{ItemKind as Declared, Mechanism};
use mechc_text::vocabulary::KEYWORDS;
use std::f64::consts::PI;

/// In longer texts no joints are proposed: the text would have to be checked without the declaration at the cursor (bytes).
const LONGEST_CHECKED: usize = 65_536;

/// In longer texts no drivers are proposed: that would have to be proven as well (bytes).
const LONGEST_PROVEN: usize = 8_192;

/// Points nearer to each other than this part of the drawing's size are meant to coincide.
const NEAR: f64 = 0.02;

/// So many joints are proposed.
const MOST: usize = 8;

/// A mechanism without the declaration at the cursor.
pub(super) struct OtherDeclarations {
    snapshot: Snapshot,
    position: FilePosition,
    is_quickly_proven: bool,
}

impl OtherDeclarations {
    /// Nothing where the text is long.
    pub fn of(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Option<OtherDeclarations> {
        let text = cursor.text;
        if text.len() > LONGEST_CHECKED {
            return None;
        }
        let end = text[cursor.word.end..].find('\n').map_or(text.len(), |line| cursor.word.end + line);
        let gone: String = text[cursor.start()..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        // what closes a block stays
        let closes = text[cursor.word.end..end].contains('}') && cursor.start() == cursor.word.start;
        let whole = if closes { text.to_owned() } else { [&text[..cursor.start()], &gone, &text[end..]].concat() };
        let position = FilePosition { offset: cursor.start() as u32, ..position.clone() };
        let is_quickly_proven = text.len() <= LONGEST_PROVEN;
        Some(OtherDeclarations { snapshot: snapshot.supposing(&position.path, whole.into()), position, is_quickly_proven })
    }

    fn with<T>(&self, act: impl FnOnce(&Checked) -> Option<T>) -> Option<T> {
        let file = self.snapshot.checked(&self.position.path)?;
        act(file.mechanism_at(self.position.offset)?)
    }

    /// Pairs of points that lie on each other and that no joint holds together, `crank.B` and `coupler.B`.
    pub fn touching(&self) -> Vec<[String; 2]> {
        self.with(|checked| Some(touching(&checked.drawn()?, checked.tree()?))).unwrap_or_default()
    }

    /// What could be driven: the left side of an equation, with one that takes it from where it is.
    pub fn free(&self) -> Vec<(String, String)> {
        if self.is_quickly_proven { free(&self.snapshot, &self.position).unwrap_or_default() } else { Vec::new() }
    }
}

fn touching(drawn: &Drawn, tree: &Mechanism) -> Vec<[String; 2]> {
    let points: Vec<_> = drawn.points.iter().filter(|point| point.at.iter().all(|x| x.is_finite())).collect();
    let largest = |k: usize| points.iter().map(|point| point.at[k]).fold(f64::NEG_INFINITY, f64::max);
    let least = |k: usize| points.iter().map(|point| point.at[k]).fold(f64::INFINITY, f64::min);
    let size = f64::max(largest(0) - least(0), largest(1) - least(1));
    let held: Vec<Vec<String>> = tree.items.iter().filter_map(joined).collect();
    let mut found: Vec<(f64, [String; 2])> = Vec::new();
    for (k, a) in points.iter().enumerate() {
        for b in points[k + 1..].iter().filter(|b| b.body != a.body) {
            let [x, y] = [0, 1].map(|k| a.at[k] - b.at[k]);
            let apart = (x * x + y * y).sqrt();
            if apart > NEAR * size {
                continue;
            }
            let pair = [format!("{}.{}", a.body, a.name), format!("{}.{}", b.body, b.name)];
            if !held.iter().any(|joint| pair.iter().all(|point| joint.contains(point))) {
                found.push((apart, pair));
            }
        }
    }
    found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    found.into_iter().map(|(_, pair)| pair).take(MOST).collect()
}

/// What a joint joins.
fn joined(item: &mechc_syntax::ast::Item) -> Option<Vec<String>> {
    let Declared::Joint { arguments, .. } = &item.kind else { return None };
    Some(arguments.iter().filter_map(crate::occurrences::path_text).collect())
}

/// What the proof says that could be driven in the mechanism at a place, with a formula that begins where it is drawn.
pub(crate) fn free(snapshot: &Snapshot, position: &FilePosition) -> Option<Vec<(String, String)>> {
    let file = snapshot.checked(&position.path)?;
    let at = file
        .mechanisms
        .iter()
        .position(|one| one.span().is_some_and(|span| (span.start..=span.end).contains(&position.offset)))?;
    let (checked, proven) = (file.mechanisms.get(at)?, snapshot.proven(&position.path)?);
    let drawn = checked.drawn()?;
    let driven = proven.get(at)?.said.iter().flat_map(|said| &said.drives);
    Some(driven.map(|driven| (driven.clone(), formula(&drawn, driven))).collect())
}

/// A formula of time that begins where a quantity is drawn.
fn formula(drawn: &Drawn, driven: &str) -> String {
    let (quantity, of) = driven.trim_end_matches(')').split_once('(').unwrap_or_default();
    let point = |k: usize| {
        drawn.points.iter().find(|point| format!("{}.{}", point.body, point.name) == of).map(|point| point.at[k])
    };
    let value = match quantity {
        "x" => point(0),
        "y" => point(1),
        "angle" => drawn.angles.iter().find(|(body, _)| body == of).map(|(_, angle)| *angle),
        quantity => {
            drawn.joints.iter().find(|joint| joint.name == of && joint.quantity == quantity).map(|joint| joint.value)
        }
    };
    let value = value.filter(|value| value.is_finite()).unwrap_or_default();
    let (start, unit, rate) = match quantity {
        "rotation" | "angle" => (value * 180.0 / PI, "deg", "60 deg/s"),
        _ => (value * 1e3, "mm", "10 mm/s"),
    };
    // as exact as a drawing is, which has few digits
    let start = (start * 1e6).round() / 1e6;
    if start == 0.0 { format!("{rate} * t") } else { format!("{start} {unit} + {rate} * t") }
}

/// A name that is free in a mechanism.
pub(crate) fn free_name(tree: &Mechanism, names: &[&str]) -> String {
    let is_free = |name: &str| {
        let is_taken = tree.items.iter().filter_map(name_of).any(|taken| taken.text == name);
        !is_taken && !KEYWORDS.iter().any(|keyword| keyword.word.name == name)
    };
    let plain = names.iter().find(|name| is_free(name)).map(|name| (*name).to_owned());
    plain.unwrap_or_else(|| {
        let base = names.first().copied().unwrap_or("name");
        // more than there are declarations
        (2..tree.items.len() + 3).map(|k| format!("{base}_{k}")).find(|name| is_free(name)).unwrap_or_default()
    })
}

/// Whole declarations of what is missing.
pub(super) fn declarations(whole: &OtherDeclarations, tree: &Mechanism) -> Vec<CompletionItem> {
    let joint = free_name(tree, &["pin", "hinge", "bearing"]);
    let driver = free_name(tree, &["motor", "drive", "feed"]);
    let joints = whole.touching().into_iter().map(|[a, b]| {
        let text = format!("joint {joint}: revolute({a}, {b})");
        let marked = format!("joint «{joint}»: revolute({a}, {b})");
        CompletionItem::new(text, CompletionItemKind::Declaration, 0)
            .detail("these points lie on each other")
            .inserts(Template::marked(&marked))
    });
    let drivers = whole.free().into_iter().map(|(driven, formula)| {
        let text = format!("driver {driver}: {driven} = {formula}");
        let marked = format!("driver «{driver}»: {driven} = «{formula}»");
        CompletionItem::new(text, CompletionItemKind::Declaration, 0)
            .detail("this is left free")
            .inserts(Template::marked(&marked))
    });
    drivers.chain(joints).collect()
}

/// Kinds of joints with what they join: points that lie on each other.
pub(super) fn joints(whole: &OtherDeclarations) -> Vec<CompletionItem> {
    let item = |[a, b]: [String; 2]| {
        CompletionItem::new(format!("revolute({a}, {b})"), CompletionItemKind::Declaration, 0)
            .detail("these points lie on each other")
    };
    whole.touching().into_iter().map(item).collect()
}

/// Equations that take what is left free.
pub(super) fn drivers(whole: &OtherDeclarations) -> Vec<CompletionItem> {
    let item = |(driven, formula): (String, String)| {
        let marked = format!("{driven} = «{formula}»");
        CompletionItem::new(format!("{driven} = {formula}"), CompletionItemKind::Declaration, 0)
            .detail("this is left free")
            .inserts(Template::marked(&marked))
    };
    whole.free().into_iter().map(item).collect()
}
