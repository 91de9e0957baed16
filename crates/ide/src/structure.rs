//! The structure of a text: folding ranges and selection ranges.

use super::location::FilePosition;
use super::snapshot::Snapshot;
use mechc_pipeline::Parsed;
use mechc_syntax::ast::{Expr, Feature, Item, ItemKind, Mechanism, TableRows};
use mechc_syntax::{LexemeKind, tokens};
use mechc_text::source::Span;
use std::ops::Range;
use std::path::Path;

/// A folding range.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fold {
    /// The range to hide; it begins and ends on different lines.
    pub range: Range<u32>,
    /// The kind of range.
    pub kind: FoldKind,
}

/// The kinds of folding ranges.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FoldKind {
    /// Text between braces or brackets.
    Block,
    /// Comments on adjacent lines.
    Comment,
    /// The `use` declarations of a file.
    Uses,
}

/// Returns the folding ranges of a file, in order.
#[must_use]
pub fn folds(snapshot: &Snapshot, path: &Path) -> Option<Vec<Fold>> {
    let parsed = snapshot.parsed(path)?;
    let source = parsed.sources().get(parsed.file());
    let mut folds = between_brackets(&source.text);
    folds.extend(comments(&parsed));
    if let [first, .., last] = parsed.tree().uses.as_slice() {
        folds.push(Fold { range: first.span.start..last.span.end, kind: FoldKind::Uses });
    }
    let lines = |fold: &Fold| [fold.range.start, fold.range.end].map(|at| source.line_index(at as usize));
    folds.retain(|fold| lines(fold)[0] < lines(fold)[1]);
    folds.sort_by_key(|fold| (fold.range.start, fold.range.end));
    Some(folds)
}

/// Returns the ranges between braces, brackets and parentheses; the text may have errors.
fn between_brackets(text: &str) -> Vec<Fold> {
    let (mut open, mut folds) = (Vec::new(), Vec::new());
    for token in tokens(text) {
        match token.text {
            "{" | "[" | "(" => open.push((token.text, token.end())),
            "}" | "]" | ")" => {
                let opener = match token.text {
                    "}" => "{",
                    "]" => "[",
                    _ => "(",
                };
                // a closing brace also ends brackets that were left open in its block
                while let Some((text, at)) = open.pop() {
                    if text == opener {
                        folds.push(Fold { range: at as u32..token.start as u32, kind: FoldKind::Block });
                        break;
                    }
                    if opener != "{" {
                        open.push((text, at));
                        break;
                    }
                }
            }
            _ => {}
        }
    }
    folds
}

fn comments(parsed: &Parsed) -> Vec<Fold> {
    let source = parsed.sources().get(parsed.file());
    let line = |at: u32| source.line_index(at as usize);
    let mut folds: Vec<Fold> = Vec::new();
    for comment in parsed.trivia().comments.iter().filter(|comment| !comment.is_trailing) {
        match folds.last_mut() {
            Some(fold) if line(fold.range.end) + 1 == line(comment.span.start) => fold.range.end = comment.span.end,
            _ => folds.push(Fold { range: comment.span.start..comment.span.end, kind: FoldKind::Comment }),
        }
    }
    folds
}

/// Returns the ranges around a position, each within the next: word, formulas, arguments, declaration, body, mechanism, file.
#[must_use]
pub fn selection_ranges(snapshot: &Snapshot, position: &FilePosition) -> Option<Vec<Range<u32>>> {
    let parsed = snapshot.parsed(&position.path)?;
    let text = &parsed.sources().get(parsed.file()).text;
    let whole = 0..text.len() as u32;
    let mut ranges: Vec<Range<u32>> = Vec::from([whole]);
    let mut add = |range: Range<u32>| {
        if range.start <= position.offset && position.offset <= range.end && !range.is_empty() {
            ranges.push(range);
        }
    };
    for token in tokens(text).into_iter().filter(|token| matches!(token.kind, LexemeKind::Word | LexemeKind::Number)) {
        add(token.start as u32..token.end() as u32);
    }
    for fold in between_brackets(text) {
        add(fold.range);
    }
    for mechanism in &parsed.tree().mechanisms {
        spans_of(mechanism, position.offset, &mut |span| add(span.start..span.end));
    }
    ranges.sort_by_key(|range| (range.end - range.start, range.start));
    ranges.dedup();
    let mut nested: Vec<Range<u32>> = Vec::new();
    for range in ranges {
        if nested.last().is_none_or(|inner| range.start <= inner.start && inner.end <= range.end) {
            nested.push(range);
        }
    }
    Some(nested)
}

fn spans_of(mechanism: &Mechanism, offset: u32, add: &mut impl FnMut(Span)) {
    add(mechanism.span);
    let holds = |span: Span| span.start <= offset && offset <= span.end;
    for item in mechanism.items.iter().filter(|item| holds(item.span)) {
        add(item.span);
        spans_of_item(item, add);
    }
}

fn spans_of_item(item: &Item, add: &mut impl FnMut(Span)) {
    item.formulas().into_iter().flat_map(Expr::parts).for_each(|e| add(e.span));
    match &item.kind {
        ItemKind::Joint { call_span, .. } => add(*call_span),
        ItemKind::Part(part) => {
            add(part.call_span);
            for binding in &part.bindings {
                add(binding.span);
            }
        }
        ItemKind::Body { features, pose, .. } => {
            if let Some(pose) = pose {
                add(pose.span());
            }
            for feature in features {
                spans_of_feature(feature, add);
            }
        }
        ItemKind::Ground { features } => {
            for feature in features {
                spans_of_feature(feature, add);
            }
        }
        ItemKind::Table { rows: TableRows::File { path, .. }, .. } => add(path.span),
        _ => {}
    }
}

fn spans_of_feature(feature: &Feature, add: &mut impl FnMut(Span)) {
    add(feature.span);
    feature.formulas().into_iter().flat_map(Expr::parts).for_each(|e| add(e.span));
}

#[cfg(test)]
mod tests {
    use super::{folds, selection_ranges};
    use crate::testing::{FOUR_BAR, at_cursor};

    #[test]
    fn blocks_comments_and_lists_are_folded() {
        let text = "use \"a.mech\"\nuse \"b.mech\" as b\n// one\n// two\n\nmechanism m { // no\n    ground {\n        point A = (0, 0)\n    }\n    table t1 = spline [\n        (0, 0), (1, 1)\n    ]\n    body x { point P = (0, 0) }\n    joint j: revolute(\n        x.P,\n}\n";
        let (snapshot, position) = at_cursor(&format!("{text}$0"));
        let line = |at: u32| text[..at as usize].matches('\n').count() + 1;
        let ranges = folds(&snapshot, &position.path).expect("a file").into_iter();
        let ranges: Vec<_> =
            ranges.map(|fold| format!("{}–{} {:?}", line(fold.range.start), line(fold.range.end), fold.kind)).collect();
        insta::assert_snapshot!(ranges.join("\n"), @r"
        1–2 Uses
        3–4 Comment
        6–16 Block
        7–9 Block
        10–12 Block
        ");
    }

    #[test]
    fn a_selection_grows_from_the_word_to_the_file() {
        let text = FOUR_BAR.replacen("point B = (crank_length, 0)", "point B = (crank_length + 2 * le$0n, 0)", 1);
        let (snapshot, position) = at_cursor(&text);
        let text = text.replacen("$0", "", 1);
        let line = |range: &std::ops::Range<u32>| {
            let text = &text[range.start as usize..range.end as usize];
            if text.len() > 50 {
                format!("{} … {}", &text[..20].trim(), &text[text.len() - 15..].trim())
            } else {
                text.to_owned()
            }
        };
        let ranges: Vec<_> = selection_ranges(&snapshot, &position)
            .expect("a file")
            .iter()
            .map(|range| line(range).replace('\n', " "))
            .collect();
        insta::assert_snapshot!(ranges.join("\n"), @r"
        len
        2 * len
        crank_length + 2 * len
        crank_length + 2 * len, 0
        (crank_length + 2 * len, 0)
        point B = (crank_length + 2 * len, 0)
        point A = ( … * len, 0)
        body crank at (0, 0, … * len, 0)     }
        param crank_len … s every 0.1 s
        mechanism four_bar { … s every 0.1 s }
        mechanism four_bar { … every 0.1 s }
        ");
    }
}
