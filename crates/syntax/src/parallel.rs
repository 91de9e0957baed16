//! Parallel parsing of a large text without faults, in pieces of whole declarations. The parser's data for a piece fit the caches, and are
//! dropped before the next piece. The tree is that of the whole text.

#![allow(clippy::redundant_closure_for_method_calls)] // a method itself is of one lifetime alone

use super::ast::{Feature, File, Item, Mechanism};
use super::build::{Head, Piece, docs_above};
use super::depth::STACK;
use super::grammar::Rule;
use super::tokens::next_token;
use mechc_parallel::{default_jobs, scoped_chunks};
use mechc_text::source::{FileId, Source, Span};
use mechc_text::vocabulary::is_declaration;
use std::ops::Range;

/// Smallest piece, in bytes.
const PIECE: usize = 1 << 11;
/// Smallest number of pieces that is parsed in parallel.
const FEWEST: usize = 64;
/// Maximum number of threads; more are limited by memory.
const MOST_JOBS: usize = 4;

/// Parses a large text; `None` for a small one, one with anything but a single mechanism, or one with a fault.
pub(super) fn parse_parallel(source: &Source, file: FileId) -> Option<File> {
    if source.text.len() < FEWEST * PIECE {
        return None;
    }
    let cuts = Cuts::of(&source.text)?;
    let piece = |range: &Range<usize>| Piece { source, file, range: range.clone() };
    let Head { name, .. } = piece(&cuts.head).read(Rule::mechanism_head, |reader, pair| reader.head(pair)).ok()?;
    let read = |pieces: Range<usize>| {
        // the share of the first thread also receives those of the others
        let many = if pieces.start == 0 { &cuts.pieces[..] } else { &cuts.pieces[pieces.clone()] };
        let mut share =
            Share { features: Vec::new(), items: Vec::with_capacity(many.iter().map(|cut| cut.most_items).sum()) };
        // each thread has a stack of its own
        stacker::maybe_grow(STACK, STACK, || {
            cuts.pieces[pieces].iter().try_for_each(|cut| share.read(cut, &piece(&cut.range)))
        })?;
        Some(share)
    };
    let shares = scoped_chunks(default_jobs().min(MOST_JOBS), cuts.pieces.len(), read);
    let mut shares = shares.into_iter().collect::<Option<Vec<_>>>()?.into_iter();
    let mut all = shares.next()?;
    for share in shares {
        all.add_features(share.features);
        all.items.extend(share.items);
    }
    let span = Span { file, start: cuts.head.start as u32, end: cuts.end as u32 };
    Some(File {
        uses: Vec::new(),
        mechanisms: vec![Mechanism { docs: docs_above(&source.text, cuts.head.start), name, span, items: all.items }],
    })
}

/// Result of adjacent pieces.
struct Share {
    /// Features of the block that the previous share ends in.
    features: Vec<Feature>,
    items: Vec<Item>,
}

impl Share {
    /// Parses a piece; `None` if it has a fault.
    fn read(&mut self, cut: &Cut, piece: &Piece<'_>) -> Option<()> {
        match cut.kind {
            CutKind::Items => {
                piece.read(Rule::items, |reader, pair| reader.items(pair.into_inner(), &mut self.items)).ok()
            }
            CutKind::Block { head, end } => {
                let span = Span { file: piece.file, start: cut.range.start as u32, end: end as u32 };
                self.items.push(piece.read(head, |reader, pair| reader.empty_block(pair, span)).ok()?);
                Some(())
            }
            CutKind::Features => {
                let features = piece.read(Rule::features, |reader, pair| reader.features(pair.into_inner())).ok()?;
                self.add_features(features);
                Some(())
            }
        }
    }

    /// Adds features to the last block.
    fn add_features(&mut self, features: Vec<Feature>) {
        self.items.last_mut().and_then(|item| item.kind.features_mut()).unwrap_or(&mut self.features).extend(features);
    }
}

/// Position of the mechanism and its pieces in a text, in bytes.
struct Cuts {
    head: Range<usize>,
    pieces: Vec<Cut>,
    /// End of its closing brace.
    end: usize,
}

/// A piece.
struct Cut {
    range: Range<usize>,
    kind: CutKind,
    /// True if it contains only features from here on.
    most_items: usize,
}

/// Contents of a piece.
#[derive(Clone, Copy)]
enum CutKind {
    /// Whole declarations.
    Items,
    /// Head of a large block up to its brace, with the end of the block.
    Block { head: Rule, end: usize },
    /// Whole features of the block whose head precedes.
    Features,
}

/// State of the cutting, on the way through the tokens.
struct Cutting {
    pieces: Vec<Cut>,
    /// Start of the next piece.
    from: usize,
    /// Declarations since then.
    items: usize,
    /// Head of the open block, from its keyword to its brace; outside of blocks where one may begin.
    head: Range<usize>,
    is_ground: bool,
    /// Index of the open block among the pieces, if it is large.
    block: Option<usize>,
}

impl Cutting {
    /// Ends a piece where the next one begins.
    fn cut(&mut self, kind: CutKind, end: usize, next: usize) {
        // one more than there are words for: `ground` may be a block or not
        self.pieces.push(Cut { range: self.from..end, kind, most_items: std::mem::take(&mut self.items) + 1 });
        self.from = next;
    }

    /// Notes the start of a declaration of the mechanism, which may be a block.
    fn declaration(&mut self, start: usize) {
        if start >= self.from + PIECE {
            self.cut(CutKind::Items, start, start);
        }
        self.items += 1;
        self.head.start = start;
    }

    /// Notes the start of a feature: a large block is cut before it.
    fn feature(&mut self, start: usize) {
        let begins = if self.block.is_some() { self.from } else { self.head.end };
        if start < begins + PIECE {
            return;
        }
        if self.block.is_none() {
            let Range { start, end } = self.head;
            self.cut(CutKind::Items, start, start);
            self.block = Some(self.pieces.len());
            let head = if self.is_ground { Rule::ground_head } else { Rule::body_head };
            self.cut(CutKind::Block { head, end }, end, end);
        }
        self.cut(CutKind::Features, start, start);
    }

    /// Notes the brace that ends the open block.
    fn block_end(&mut self, brace: Range<usize>) {
        let Some(block) = self.block.take() else { return };
        self.cut(CutKind::Features, brace.start, brace.end);
        if let CutKind::Block { end, .. } = &mut self.pieces[block].kind {
            *end = brace.end;
        }
    }
}

impl Cuts {
    /// Cuts a text before words that only begin declarations: in the mechanism, and in large blocks inside it.
    fn of(text: &str) -> Option<Cuts> {
        let mut rest = text;
        if next_token(&mut rest)? != "mechanism" {
            return None;
        }
        let start = text.len() - rest.len() - "mechanism".len();
        while next_token(&mut rest)? != "{" {}
        let head = start..text.len() - rest.len();
        let from = head.end;
        let mut cutting = Cutting { pieces: Vec::new(), from, items: 0, head: 0..0, is_ground: false, block: None };
        let (mut depth, mut before) = (1_usize, ("", 0));
        while let Some(token) = next_token(&mut rest) {
            let (start, end) = (text.len() - rest.len() - token.len(), text.len() - rest.len());
            match token {
                "{" => {
                    depth += 1;
                    cutting.head.end = end;
                    cutting.is_ground = before.0 == "ground";
                    if cutting.is_ground {
                        cutting.head.start = before.1;
                    }
                }
                "}" => {
                    depth = depth.checked_sub(1)?;
                    if depth == 1 {
                        cutting.block_end(start..end);
                    }
                    if depth == 0 {
                        cutting.cut(CutKind::Items, start, end);
                        // nothing but white space and comments may follow
                        return next_token(&mut rest).is_none().then_some(Cuts { head, pieces: cutting.pieces, end });
                    }
                }
                // `ground.O` is a point
                _ if token == "ground" || !is_declaration(token) => {}
                _ if depth == 1 => cutting.declaration(start),
                _ => cutting.feature(start),
            }
            before = (token, start);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{CutKind, Cuts, parse_parallel};
    use crate::build::Piece;
    use crate::grammar::Rule;
    use mechc_text::source::Sources;

    /// Returns a large text with an insertion in the middle.
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

    /// Returns the trees of parallel and sequential parsing.
    fn both(text: &str) -> [Option<super::File>; 2] {
        let mut sources = Sources::default();
        let file = sources.add("long.mech", text);
        let source = sources.get(file);
        let whole = Piece { source, file, range: 0..text.len() };
        [parse_parallel(source, file), whole.read(Rule::file, |reader, pair| reader.file(pair)).ok()]
    }

    #[test]
    fn pieces_make_the_tree_of_the_whole() {
        let text = text("").replace("    /* no */\n", "");
        let [pieces, whole] = both(&text);
        assert!(pieces.is_some() && pieces == whole);
        assert_eq!(whole.map(|file| file.mechanisms[0].items.len()), Some(8_001));
    }

    /// Returns a large text with thousands of features in the ground and in a body.
    fn with_large_blocks(middle: &str) -> String {
        let points = |from: usize| {
            (from..from + 2_000)
                .map(|k| format!("        /// Point {k}. {{\n        point P{k} = ({k}, -1) // point\n"))
        };
        let ground: String = points(0).collect::<String>() + "        axis a = P0 along (1, 0)\n" + middle;
        let body: String = points(2_000).collect::<String>() + "        curve c(u) = (u, 1) at 0 mass 1 at (0, 0)\n";
        text(&format!("    /// Late.\n    body late at (ground.O, 0) toward ground.P1 {{\n{body}    }}\n"))
            .replace("    /* no */\n", "")
            .replace("point O = (0, 0) }", &format!("point O = (0, 0) // one\n{ground}    }}"))
    }

    #[test]
    fn large_blocks_are_cut_before_features() {
        let text = with_large_blocks("");
        let cuts = Cuts::of(&text).unwrap();
        let longest = cuts.pieces.iter().map(|cut| cut.range.len()).max();
        assert!(longest < Some(2 * super::PIECE), "{longest:?}");
        let heads = cuts.pieces.iter().filter(|cut| matches!(cut.kind, CutKind::Block { .. }));
        let heads: Vec<&str> = heads.map(|cut| &text[cut.range.clone()]).collect();
        assert_eq!(heads, ["ground {", "body late at (ground.O, 0) toward ground.P1 {"]);
        let [pieces, whole] = both(&text);
        assert!(pieces.is_some() && pieces == whole);
        for middle in ["        joint j: revolute(O, P)\n", "        point\n", "        param p = 1\n", "    } {\n"] {
            let [pieces, whole] = both(&with_large_blocks(middle));
            assert!(pieces.is_none() && whole.is_none(), "{middle}");
        }
    }

    #[test]
    fn invalid_texts_are_not_parsed_in_parallel() {
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
