//! Comments on their way into a formatted text: each is handed out once, in order, to what it stood beside.

use crate::source::Span;
use crate::syntax::ast::{File, Item, ItemKind};
use crate::syntax::trivia::{Comment, Trivia};

/// The comments that have not been printed yet.
pub(super) struct Comments<'a> {
    text: &'a str,
    /// Last one first; without those that document a declaration, which the tree has.
    left: Vec<Comment>,
}

impl<'a> Comments<'a> {
    pub fn none() -> Comments<'a> {
        Comments { text: "", left: Vec::new() }
    }

    pub fn of(file: &File, trivia: &Trivia, text: &'a str) -> Comments<'a> {
        let mut is_doc_of_tree = vec![false; trivia.comments.len()];
        let mut take = |docs: &[String], span: Span| {
            let before = trivia.comments.partition_point(|comment| comment.span.start < span.start);
            let docs_before =
                (0..before).rev().filter(|&k| trivia.comments[k].is_doc && !trivia.comments[k].is_trailing);
            docs_before.take(docs.len()).for_each(|k| is_doc_of_tree[k] = true);
        };
        for used in &file.uses {
            take(&used.docs, used.span);
        }
        for mechanism in &file.mechanisms {
            take(&mechanism.docs, mechanism.span);
            for item in &mechanism.items {
                take(&item.docs, item.span);
                if let ItemKind::Ground { features } | ItemKind::Body { features, .. } = &item.kind {
                    for feature in features {
                        take(&feature.docs, feature.span);
                    }
                }
            }
        }
        let others = trivia.comments.iter().zip(is_doc_of_tree).filter(|(_, is_doc)| !is_doc);
        let mut left: Vec<Comment> = others.map(|(comment, _)| *comment).collect();
        left.reverse();
        Comments { text, left }
    }

    fn next(&mut self) -> Option<String> {
        let span = self.left.pop()?.span;
        self.text.get(span.start as usize..span.end as usize).map(str::to_owned)
    }

    /// Those that begin before a byte.
    pub fn before(&mut self, end: u32) -> Vec<String> {
        let mut found = Vec::new();
        while self.left.last().is_some_and(|comment| comment.span.start < end) {
            found.extend(self.next());
        }
        found
    }

    /// The one behind what ends at a byte, on its line.
    pub fn behind(&mut self, end: u32) -> Option<String> {
        let comment = self.left.last().filter(|comment| comment.is_trailing)?;
        let between = self.text.get(end as usize..comment.span.start as usize)?;
        if between.contains('\n') || !between.trim().is_empty() {
            return None;
        }
        self.next()
    }

    /// Those before a declaration without a block, and within it.
    pub fn around(&mut self, item: &Item) -> Vec<String> {
        self.before(item.span.end)
    }

    /// All that are left.
    pub fn rest(&mut self) -> Vec<String> {
        self.before(u32::MAX)
    }
}

/// A line for each.
pub(super) fn lines(comments: &[String], indent: &str) -> String {
    comments.iter().flat_map(|comment| [indent, comment.as_str(), "\n"]).collect()
}
