//! Reuse of the tree before an edit: declarations that the edit does not touch are not parsed again.
//!
//! The text is read declaration by declaration, like one with faults, and the boundaries of declarations are found anew. Only the result of
//! the grammar for unchanged words is reused. A declaration with a fault is always parsed again, since its diagnostic may depend on any
//! other declaration.

use super::ast::{Feature, FeatureKind, File, Item, ItemKind};
use super::build::Head;
use super::shift_spans::Shift;
use mechc_text::source::FileId;
use std::ops::Range;

/// The tree before the edit, by position.
pub(super) struct PreviousTree<'a> {
    file: FileId,
    /// Number of unchanged bytes at the beginning.
    before: usize,
    /// Byte from which on the text is the end of the previous one.
    behind: usize,
    /// Growth of the text in bytes, modulo 2^32, since it may have shrunk.
    grown: u32,
    /// Nodes by their first byte in the previous text.
    nodes: Vec<(u32, Node<'a>)>,
}

#[derive(Clone, Copy)]
enum Node<'a> {
    Item(&'a Item),
    Feature(&'a Feature),
}

impl<'a> PreviousTree<'a> {
    /// Creates the tree of a text that has been edited from `old_text` to `text`.
    pub fn new(old: &'a File, [old_text, text]: [&str; 2], file: FileId) -> PreviousTree<'a> {
        let (before, same) = ends_in_common(old_text.as_bytes(), text.as_bytes());
        let mut nodes = Vec::new();
        for item in old.mechanisms.iter().flat_map(|mechanism| &mechanism.items) {
            nodes.push((item.span.start, Node::Item(item)));
            if let ItemKind::Ground { features } | ItemKind::Body { features, .. } = &item.kind {
                nodes.extend(features.iter().map(|feature| (feature.span.start, Node::Feature(feature))));
            }
        }
        // nearly all are in order
        nodes.sort_by_key(|(start, _)| *start);
        let grown = (text.len() as u32).wrapping_sub(old_text.len() as u32);
        PreviousTree { file, before, behind: text.len() - same, grown, nodes }
    }

    /// Returns the declaration without a block of an unchanged range. The caller checks that it still covers the whole range.
    pub fn item(&self, stretch: &Range<usize>) -> Option<Item> {
        let (node, moved) = self.node(stretch)?;
        let Node::Item(item) = node else { return None };
        let has_block = matches!(item.kind, ItemKind::Ground { .. } | ItemKind::Body { .. });
        if has_block || matches!(item.kind, ItemKind::Broken { .. }) {
            return None;
        }
        let mut item = Item { docs: Vec::new(), ..item.clone() };
        moved.item(&mut item);
        // a declaration that ends beyond the stretch may be cut off in the text
        (item.span.end as usize <= stretch.end).then_some(item)
    }

    /// Returns the feature of an unchanged range.
    pub fn feature(&self, stretch: &Range<usize>) -> Option<Feature> {
        let (node, moved) = self.node(stretch)?;
        let Node::Feature(feature) = node else { return None };
        if feature.kind == FeatureKind::Broken {
            return None;
        }
        let mut feature = Feature { docs: Vec::new(), ..feature.clone() };
        moved.feature(&mut feature);
        (feature.span.end as usize <= stretch.end).then_some(feature)
    }

    /// Returns the head of a body, from its keyword to its brace, that is an unchanged range.
    pub fn head(&self, stretch: &Range<usize>) -> Option<Head> {
        let (node, moved) = self.node(stretch)?;
        let Node::Item(Item { ranges, kind: ItemKind::Body { name, pose, .. }, .. }) = node else { return None };
        // one whose head is at fault has no pose
        let mut head = Head { name: name.clone(), ranges: ranges.clone(), pose: Some(pose.clone()?) };
        moved.head(&mut head);
        Some(head)
    }

    /// Returns the node that began at the start of an unchanged range, and the shift to its new position.
    fn node(&self, stretch: &Range<usize>) -> Option<(Node<'a>, Shift)> {
        let by = match () {
            () if stretch.end <= self.before => 0,
            () if stretch.start >= self.behind => self.grown,
            () => return None,
        };
        let start = (stretch.start as u32).wrapping_sub(by);
        let at = self.nodes.binary_search_by_key(&start, |(start, _)| *start).ok()?;
        Some((self.nodes[at].1, Shift { file: self.file, by }))
    }
}

/// Returns the numbers of equal bytes at the beginning and at the remaining end of two texts.
fn ends_in_common(old: &[u8], new: &[u8]) -> (usize, usize) {
    let before = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let (old, new) = (&old[before..], &new[before..]);
    (before, old.iter().rev().zip(new.iter().rev()).take_while(|(a, b)| a == b).count())
}

#[cfg(test)]
mod tests {
    use super::ends_in_common;
    use crate::{parse, reparse};
    use mechc_text::source::Sources;

    const TEXTS: [&str; 6] = [
        include_str!("../../../examples/table_driven.mech"),
        include_str!("../../../examples/parallel_robot.mech"),
        include_str!("../../../examples/cam_with_dwells.mech"),
        include_str!("../../../tests/stages/everything/input.mech"),
        include_str!("../../../tests/format/everything.mech"),
        "use \"a.mech\" as a\r\nmechanism a-b {\r\n  /// µ 𝛼\r\n  body c-d[k in 0..3] at (0, 0, 𝛼) { point P }\r\n ground { point P }\r\n  param x-y = 3 in\r\n  param z = x-y + 2 // end\r\n  joint body: revolute(c-d[0].P, ground.P)\r\n}",
    ];

    /// Typed texts, some of which change the meaning of the words around them.
    const TYPED: [&str; 28] = [
        "{",
        "}",
        "(",
        ")",
        "\"",
        "//",
        "///",
        "\n",
        "\r\n",
        " ",
        ".",
        ",",
        "=",
        "==",
        ":",
        "3",
        "mm",
        " in ",
        "a",
        "𝛼",
        "body b {",
        "param p = 1",
        "point P = (1, 2)",
        "ground {",
        "joint ",
        "mechanism m {",
        "use \"b.mech\"",
        "if ",
    ];

    /// Returns the next pseudo-random number.
    fn next(state: &mut u64) -> usize {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 33) as usize
    }

    fn boundary(text: &str, at: usize) -> usize {
        (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).expect("0 is one")
    }

    /// Returns a text with a random edit: a deletion, a typed text, or a copy from elsewhere.
    fn edited(text: &str, state: &mut u64) -> String {
        let start = boundary(text, next(state) % (text.len() + 1));
        let longest = [0, 1, 1, 3, 10, 200][next(state) % 6];
        let end = boundary(text, start + next(state) % (longest + 1)).max(start);
        let from = boundary(text, next(state) % (text.len() + 1));
        let elsewhere = &text[from..boundary(text, from + next(state) % 60).max(from)];
        let new = match next(state) % 4 {
            0 => "",
            1 => elsewhere,
            _ => TYPED[next(state) % TYPED.len()],
        };
        format!("{}{new}{}", &text[..start], &text[end..])
    }

    #[test]
    fn edited_texts_parse_as_new_ones() {
        let mut state = 1;
        for k in 0..36 {
            let original = TEXTS[k % TEXTS.len()];
            let mut sources = Sources::default();
            let file = sources.add("text.mech", original);
            let (mut old, mut text) = (parse(&sources, file), original.to_owned());
            for _ in 0..20 {
                // typing makes texts right again, which chance does not
                let new =
                    if next(&mut state).is_multiple_of(8) { original.to_owned() } else { edited(&text, &mut state) };
                let mut sources = Sources::default();
                let file = sources.add("text.mech", new.as_str());
                let (reparse, fresh) = (reparse(&old, &text, &sources, file), parse(&sources, file));
                assert_eq!(reparse, fresh, "from\n{text}\nto\n{new}");
                (old, text) = (reparse, new);
            }
        }
    }

    #[test]
    fn truncated_texts_parse_as_new_ones() {
        for original in TEXTS {
            let mut sources = Sources::default();
            let file = sources.add("text.mech", original);
            let old = parse(&sources, file);
            for cut in (0..original.len()).filter(|&at| original.is_char_boundary(at)).step_by(7) {
                let mut sources = Sources::default();
                let file = sources.add("text.mech", &original[..cut]);
                let (reparse, fresh) = (reparse(&old, original, &sources, file), parse(&sources, file));
                assert_eq!(reparse, fresh, "{}", &original[..cut]);
            }
        }
    }

    #[test]
    fn common_text_is_counted_once() {
        assert_eq!(ends_in_common(b"abab", b"abxab"), (2, 2));
        assert_eq!(ends_in_common(b"aaa", b"aa"), (2, 0));
        assert_eq!(ends_in_common(b"", b""), (0, 0));
    }
}
