//! Proposals for declarations that a mechanism lacks: joints between coincident points, and drivers for free quantities.

use super::cursor::Cursor;
use super::item::{CompletionItem, CompletionItemKind, Template};
use crate::location::FilePosition;
use crate::snapshot::Snapshot;
use mechc_lang::check::name_of;
use mechc_pipeline::{Checked, InitialPose};
use mechc_syntax::ast::{ItemKind as Declared, Mechanism};
use mechc_text::vocabulary::KEYWORDS;
use std::f64::consts::PI;

/// The maximum length of a text for which joints are proposed (bytes), since it must be checked without the declaration at the cursor.
const MAX_CHECKED: usize = 65_536;

/// The maximum length of a text for which drivers are proposed (bytes), since it must be proven too.
const MAX_PROVEN: usize = 8_192;

/// The distance below which points count as coincident, as a fraction of the drawing's size.
const COINCIDENCE: f64 = 0.02;

/// The maximum number of joints to propose.
const MAX_JOINTS: usize = 8;

/// A mechanism without the declaration at the cursor.
pub(super) struct OtherDeclarations {
    snapshot: Snapshot,
    position: FilePosition,
    is_quickly_proven: bool,
}

impl OtherDeclarations {
    /// Removes the declaration at the cursor from the text; `None` if the text is too long.
    pub fn new(snapshot: &Snapshot, position: &FilePosition, cursor: &Cursor<'_>) -> Option<OtherDeclarations> {
        let text = cursor.text;
        if text.len() > MAX_CHECKED {
            return None;
        }
        let end = text[cursor.word.end..].find('\n').map_or(text.len(), |line| cursor.word.end + line);
        let blank: String = text[cursor.start()..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        // a brace that closes the block stays
        let closes = text[cursor.word.end..end].contains('}') && cursor.start() == cursor.word.start;
        let rest = if closes { text.to_owned() } else { [&text[..cursor.start()], &blank, &text[end..]].concat() };
        let position = FilePosition { offset: cursor.start() as u32, ..position.clone() };
        let is_quickly_proven = text.len() <= MAX_PROVEN;
        Some(OtherDeclarations {
            snapshot: snapshot.with_trial_text(&position.path, rest.into()),
            position,
            is_quickly_proven,
        })
    }

    fn with<T>(&self, act: impl FnOnce(&Checked) -> Option<T>) -> Option<T> {
        let file = self.snapshot.checked(&self.position.path)?;
        act(file.mechanism_at(self.position.offset)?)
    }

    /// Returns pairs of coincident points that no joint connects, such as `crank.B` and `coupler.B`.
    pub fn coincident_points(&self) -> Vec<[String; 2]> {
        self.with(|checked| Some(coincident_points(&checked.initial_pose()?, checked.tree()?))).unwrap_or_default()
    }

    /// Returns quantities that could be driven, each with a formula that starts at its drawn value.
    pub fn free_quantities(&self) -> Vec<(String, String)> {
        if self.is_quickly_proven {
            free_quantities(&self.snapshot, &self.position).unwrap_or_default()
        } else {
            Vec::new()
        }
    }
}

fn coincident_points(drawn: &InitialPose, tree: &Mechanism) -> Vec<[String; 2]> {
    let points: Vec<_> = drawn.points.iter().filter(|point| point.at.iter().all(|x| x.is_finite())).collect();
    let largest = |k: usize| points.iter().map(|point| point.at[k]).fold(f64::NEG_INFINITY, f64::max);
    let least = |k: usize| points.iter().map(|point| point.at[k]).fold(f64::INFINITY, f64::min);
    let size = f64::max(largest(0) - least(0), largest(1) - least(1));
    let joined_points: Vec<Vec<String>> = tree.items.iter().filter_map(joint_arguments).collect();
    let mut found: Vec<(f64, [String; 2])> = Vec::new();
    for (k, a) in points.iter().enumerate() {
        for b in points[k + 1..].iter().filter(|b| b.body != a.body) {
            let [x, y] = [0, 1].map(|k| a.at[k] - b.at[k]);
            let distance = (x * x + y * y).sqrt();
            if distance > COINCIDENCE * size {
                continue;
            }
            let pair = [format!("{}.{}", a.body, a.name), format!("{}.{}", b.body, b.name)];
            if !joined_points.iter().any(|joint| pair.iter().all(|point| joint.contains(point))) {
                found.push((distance, pair));
            }
        }
    }
    found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    found.into_iter().map(|(_, pair)| pair).take(MAX_JOINTS).collect()
}

/// Returns the paths that a joint connects.
fn joint_arguments(item: &mechc_syntax::ast::Item) -> Option<Vec<String>> {
    let Declared::Joint { arguments, .. } = &item.kind else { return None };
    Some(arguments.iter().filter_map(crate::occurrences::path_text).collect())
}

/// Returns the quantities that could be driven in the mechanism at a position according to its proof, each with a formula that starts at
/// its drawn value.
pub(crate) fn free_quantities(snapshot: &Snapshot, position: &FilePosition) -> Option<Vec<(String, String)>> {
    let file = snapshot.checked(&position.path)?;
    let at = file
        .mechanisms
        .iter()
        .position(|one| one.span().is_some_and(|span| (span.start..=span.end).contains(&position.offset)))?;
    let (checked, proofs) = (file.mechanisms.get(at)?, snapshot.proofs(&position.path)?);
    let drawn = checked.initial_pose()?;
    let driven = proofs.get(at)?.diagnostics.iter().flat_map(|diagnostic| &diagnostic.drives);
    Some(driven.map(|driven| (driven.clone(), formula(&drawn, driven))).collect())
}

/// Returns a formula of time that starts at the drawn value of a quantity.
fn formula(drawn: &InitialPose, driven: &str) -> String {
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
    // six decimals are more than a drawing is accurate to
    let start = (start * 1e6).round() / 1e6;
    if start == 0.0 { format!("{rate} * t") } else { format!("{start} {unit} + {rate} * t") }
}

/// Returns a name that a mechanism does not use yet.
pub(crate) fn free_name(tree: &Mechanism, names: &[&str]) -> String {
    let is_free = |name: &str| {
        let is_taken = tree.items.iter().filter_map(name_of).any(|taken| taken.text == name);
        !is_taken && !KEYWORDS.iter().any(|keyword| keyword.word.name == name)
    };
    let plain = names.iter().find(|name| is_free(name)).map(|name| (*name).to_owned());
    plain.unwrap_or_else(|| {
        let base = names.first().copied().unwrap_or("name");
        // one more name than declarations, so one of them is free
        (2..tree.items.len() + 3).map(|k| format!("{base}_{k}")).find(|name| is_free(name)).unwrap_or_default()
    })
}

/// Proposes whole declarations that are missing.
pub(super) fn declarations(others: &OtherDeclarations, tree: &Mechanism) -> Vec<CompletionItem> {
    let joint = free_name(tree, &["pin", "hinge", "bearing"]);
    let driver = free_name(tree, &["motor", "drive", "feed"]);
    let joints = others.coincident_points().into_iter().map(|[a, b]| {
        let text = format!("joint {joint}: revolute({a}, {b})");
        let marked = format!("joint «{joint}»: revolute({a}, {b})");
        CompletionItem::new(text, CompletionItemKind::Declaration, 0)
            .detail("these points lie on each other")
            .inserts(Template::from_marked(&marked))
    });
    let drivers = others.free_quantities().into_iter().map(|(driven, formula)| {
        let text = format!("driver {driver}: {driven} = {formula}");
        let marked = format!("driver «{driver}»: {driven} = «{formula}»");
        CompletionItem::new(text, CompletionItemKind::Declaration, 0)
            .detail("this is left free")
            .inserts(Template::from_marked(&marked))
    });
    drivers.chain(joints).collect()
}

/// Proposes joints between coincident points.
pub(super) fn joints(others: &OtherDeclarations) -> Vec<CompletionItem> {
    let item = |[a, b]: [String; 2]| {
        CompletionItem::new(format!("revolute({a}, {b})"), CompletionItemKind::Declaration, 0)
            .detail("these points lie on each other")
    };
    others.coincident_points().into_iter().map(item).collect()
}

/// Proposes driver equations for free quantities.
pub(super) fn drivers(others: &OtherDeclarations) -> Vec<CompletionItem> {
    let item = |(driven, formula): (String, String)| {
        let marked = format!("{driven} = «{formula}»");
        CompletionItem::new(format!("{driven} = {formula}"), CompletionItemKind::Declaration, 0)
            .detail("this is left free")
            .inserts(Template::from_marked(&marked))
    };
    others.free_quantities().into_iter().map(item).collect()
}
