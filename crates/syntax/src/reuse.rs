//! Reuse of the tree before an edit: declarations that the edit does not touch are not parsed again.
//!
//! The boundaries of declarations are found anew, and only the result of the grammar for unchanged words is reused. A declaration with a
//! fault is always parsed again, since its diagnostic may depend on any other declaration.

use super::ast::{File, Item};
use super::shift_spans::{Shift, Spans};
use super::sync_points::SyncPoints;
use mechc_text::source::FileId;
use rustc_hash::FxHashSet;

/// Number of tokens on both sides of a declaration that decide, with its own, where it begins and ends.
const AROUND: usize = 3;

/// The tree before the edit.
pub(super) struct PreviousTree<'a> {
    file: FileId,
    /// Number of unchanged bytes at the beginning.
    before: usize,
    /// Byte from which on the text is the end of the previous one.
    behind: usize,
    /// Growth of the text in bytes, modulo 2^32, since it may have shrunk.
    grown: u32,
    /// Declarations of mechanisms, in order.
    items: Vec<&'a Item>,
    /// First bytes of the declarations that have a fault.
    faulty: &'a FxHashSet<u32>,
}

impl<'a> PreviousTree<'a> {
    /// Creates the tree of a text that has been edited from `old_text` to `text`.
    pub fn new(
        old: &'a File,
        faulty: &'a FxHashSet<u32>,
        [old_text, text]: [&str; 2],
        file: FileId,
    ) -> PreviousTree<'a> {
        let (before, same) = ends_in_common(old_text.as_bytes(), text.as_bytes());
        let mut items: Vec<&Item> = old.mechanisms.iter().flat_map(|mechanism| &mechanism.items).collect();
        items.sort_by_key(|item| item.span.start);
        let grown = (text.len() as u32).wrapping_sub(old_text.len() as u32);
        PreviousTree { file, before, behind: text.len() - same, grown, items, faulty }
    }

    /// Returns the declaration without faults that begins at a token, and the token behind it, if neither it nor its surroundings changed.
    pub fn item(&self, sync: &SyncPoints<'_>, first: usize) -> Option<(Item, usize)> {
        let start = sync.start(first);
        let by = if start < self.before { 0 } else { self.grown };
        let old_start = (start as u32).wrapping_sub(by);
        let at = self.items.binary_search_by_key(&old_start, |item| item.span.start).ok()?;
        let next = sync.index_at(self.items[at].span.end.wrapping_add(by) as usize);
        let around = sync.lines_of(first.saturating_sub(AROUND)..next + AROUND);
        let is_unchanged = around.end < self.before || around.start >= self.behind;
        if !is_unchanged || self.faulty.contains(&old_start) || sync.uses_hyphenated(first, next) {
            return None;
        }
        let mut item = self.items[at].clone();
        item.shift(Shift { file: self.file, by });
        Some((item, next))
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
    use crate::{ParsedText, parse, reparse};
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
    const TYPED: &str = "{ } ( ) \" // /// . , = == : 3 mm in a 𝛼 joint if gravity mass body_b_{ param_p_=_1 point_P_=_(1,_2) ground_{ mechanism_m_{ use_\"b.mech\"";

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
        let typed: Vec<&str> = TYPED.split(' ').chain(["\n", "\r\n", " "]).collect();
        let new = match next(state) % 4 {
            0 => "",
            1 => elsewhere,
            _ => typed[next(state) % typed.len()],
        };
        format!("{}{}{}", &text[..start], new.replace('_', " "), &text[end..])
    }

    /// Checks that an edited text parses like a new one. Each edit is of the text before it.
    fn check(edits: impl Iterator<Item = String>) {
        let mut before: Option<(ParsedText, String)> = None;
        for text in edits {
            let mut sources = Sources::default();
            let file = sources.add("text.mech", text.as_str());
            let new = parse(&sources, file);
            if let Some((old, old_text)) = &before {
                assert_eq!(reparse(old, old_text, &sources, file), new, "from\n{old_text}\nto\n{text}");
            }
            before = Some((new, text));
        }
    }

    #[test]
    fn edited_texts_parse_as_new_ones() {
        for (k, original) in TEXTS.into_iter().enumerate() {
            let (mut state, mut text) = (k as u64, original.to_owned());
            check((0..120).map(|_| {
                // typing makes texts right again, which chance does not
                let is_reset = next(&mut state).is_multiple_of(8);
                text = if is_reset { original.to_owned() } else { edited(&text, &mut state) };
                text.clone()
            }));
        }
    }

    #[test]
    fn truncated_texts_parse_as_new_ones() {
        for text in TEXTS {
            let cuts = (0..text.len()).filter(|&at| text.is_char_boundary(at)).step_by(7);
            check(cuts.flat_map(|at| [text.to_owned(), text[..at].to_owned()]));
        }
    }

    #[test]
    fn common_text_is_counted_once() {
        assert_eq!(ends_in_common(b"abab", b"abxab"), (2, 2));
        assert_eq!(ends_in_common(b"aaa", b"aa"), (2, 0));
        assert_eq!(ends_in_common(b"", b""), (0, 0));
    }
}
