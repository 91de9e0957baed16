//! A large text that follows the grammar, read in pieces of whole declarations, by several threads: what the parser notes of a piece
//! fits the caches, and each is forgotten before the next. The tree is that of the whole.

#![allow(clippy::redundant_closure_for_method_calls)] // a method itself is of one lifetime alone

use super::ast::{File, Mechanism};
use super::build::{Head, Piece, docs_above};
use super::depth::STACK;
use super::grammar::Rule;
use super::tokens::next_token;
use crate::crew::{in_shares, usual_jobs};
use crate::source::{FileId, Source, Span};
use crate::vocabulary::is_declaration;
use std::ops::Range;

/// A piece is no smaller than this, in bytes.
const PIECE: usize = 1 << 13;
/// Nor is a text of so few of them read in pieces.
const FEWEST: usize = 16;
/// So many threads read as fast as memory gives what they need.
const MOST_JOBS: usize = 4;

/// Where one mechanism and its pieces stand in a text, in bytes.
struct Cuts {
    head: Range<usize>,
    pieces: Vec<Range<usize>>,
    /// Where the brace that closes it ends.
    end: usize,
}

/// The tree of a large text; nothing of a small one, nor where more than a mechanism is in it, or a piece does not follow the grammar.
pub(super) fn in_pieces(source: &Source, file: FileId) -> Option<File> {
    if source.text.len() < FEWEST * PIECE {
        return None;
    }
    let cuts = Cuts::of(&source.text)?;
    let piece = |range: &Range<usize>| Piece { source, file, range: range.clone() };
    let Head { name, .. } = piece(&cuts.head).read(Rule::mechanism_head, |reader, pair| reader.head(pair)).ok()?;
    let items_of = |range| piece(range).read(Rule::items, |reader, pair| reader.items(pair.into_inner())).ok();
    let read = |shares: Range<usize>| {
        // each thread has a stack of its own
        stacker::maybe_grow(STACK, STACK, || cuts.pieces[shares].iter().map(items_of).collect::<Option<Vec<_>>>())
    };
    let shares = in_shares(usual_jobs().min(MOST_JOBS), cuts.pieces.len(), read);
    let items = shares.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().flatten().collect();
    let span = Span { file, start: cuts.head.start as u32, end: cuts.end as u32 };
    Some(File {
        uses: Vec::new(),
        mechanisms: vec![Mechanism { docs: docs_above(&source.text, cuts.head.start), name, span, items }],
    })
}

impl Cuts {
    /// Cuts a text before words that nothing but a declaration begins with, outside of all blocks but the mechanism's.
    fn of(text: &str) -> Option<Cuts> {
        let mut cuts = Cuts { head: 0..0, pieces: Vec::new(), end: 0 };
        let (mut rest, mut depth, mut from) = (text, 0_usize, 0);
        if next_token(&mut rest)? != "mechanism" {
            return None;
        }
        cuts.head.start = text.len() - rest.len() - "mechanism".len();
        while let Some(token) = next_token(&mut rest) {
            let (start, end) = (text.len() - rest.len() - token.len(), text.len() - rest.len());
            match token {
                "{" if depth == 0 => {
                    (cuts.head.end, from) = (end, end);
                    depth = 1;
                }
                "{" => depth += 1,
                "}" => {
                    depth = depth.checked_sub(1)?;
                    if depth == 0 {
                        cuts.pieces.push(from..start);
                        cuts.end = end;
                        // nothing but white space and comments may follow
                        return next_token(&mut rest).is_none().then_some(cuts);
                    }
                }
                // `ground.O` is a point
                _ if depth == 1 && start >= from + PIECE && is_declaration(token) && token != "ground" => {
                    cuts.pieces.push(from..start);
                    from = start;
                }
                _ => {}
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::in_pieces;
    use crate::source::Sources;
    use crate::syntax::build::Piece;
    use crate::syntax::grammar::Rule;

    /// A large text, with something in its middle.
    fn text(middle: &str) -> String {
        let mut text =
            "// first of all\n/// A long one.\nmechanism long { // here it begins\n    ground { point O = (0, 0) }\n"
                .to_owned();
        for k in 0..4_000 {
            text += &format!(
                "    /// Number {k}.\n    body b{k} at ({k}, 0, 0) {{ point P = (0, 0) }} // joint\n    joint j{k}: revolute(ground.O, b{k}.P)\n"
            );
            if k == 2_000 {
                text += middle;
            }
        }
        text + "    /* no */\n    }\n// behind it\n"
    }

    /// The text read in pieces, and read as a whole.
    fn both(text: &str) -> [Option<super::File>; 2] {
        let mut sources = Sources::default();
        let file = sources.add("long.mech", text);
        let source = sources.get(file);
        let whole = Piece { source, file, range: 0..text.len() };
        [in_pieces(source, file), whole.read(Rule::file, |reader, pair| reader.file(pair)).ok()]
    }

    #[test]
    fn pieces_make_the_tree_of_the_whole() {
        let text = text("").replace("    /* no */\n", "");
        let [pieces, whole] = both(&text);
        assert!(pieces.is_some() && pieces == whole);
        assert_eq!(whole.map(|file| file.mechanisms[0].items.len()), Some(8_001));
    }

    #[test]
    fn what_does_not_follow_the_grammar_is_not_read_in_pieces() {
        for middle in
            ["    joint j: revolute(ground.O\n", "    }\n", "    {\n", "    \"param\n", "    // } param\n    param\n"]
        {
            assert_eq!(both(&text(middle).replace("    /* no */\n", "")), [None, None], "{middle}");
        }
        assert_eq!(both(&text("")), [None, None]);
        let second = text("").replace("    /* no */\n", "") + "mechanism second {}\n";
        let [pieces, whole] = both(&second);
        assert!(pieces.is_none() && whole.is_some());
    }
}
