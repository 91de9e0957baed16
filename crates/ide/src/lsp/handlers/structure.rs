//! Folding ranges and selection ranges.

use crate::lsp::capabilities::Ability;
use crate::lsp::convert::ProtocolContext;
use crate::{self as ide, FoldKind};
use gen_lsp_types as lsp;
use std::ops::Range;

pub(super) fn folds(context: &ProtocolContext, params: &lsp::FoldingRangeParams) -> Option<Vec<lsp::FoldingRange>> {
    let path = context.path(&params.text_document.uri);
    let of = |fold: &ide::Fold| {
        let lsp::Range { start, end } = context.range(&path, &fold.range)?;
        // a client that folds whole lines should still show the closing brace
        let is_cut = context.client.can(Ability::LineFolding) && fold.kind == FoldKind::Block;
        let end_line = end.line - u32::from(is_cut);
        let kind = match fold.kind {
            FoldKind::Block => None,
            FoldKind::Comment => Some(lsp::FoldingRangeKind::Comment),
            FoldKind::Uses => Some(lsp::FoldingRangeKind::Imports),
        };
        let fold = lsp::FoldingRange {
            start_line: start.line,
            start_character: Some(start.character),
            end_line,
            end_character: (!is_cut).then_some(end.character),
            kind,
            collapsed_text: None,
        };
        (start.line < end_line).then_some(fold)
    };
    Some(ide::folds(&context.snapshot, &path)?.iter().filter_map(of).collect())
}

pub(super) fn selections(
    context: &ProtocolContext,
    params: &lsp::SelectionRangeParams,
) -> Option<Vec<lsp::SelectionRange>> {
    let of = |position: &lsp::Position| {
        let text_document = params.text_document.clone();
        let position = context.position(&lsp::TextDocumentPositionParams { text_document, position: *position })?;
        nested(context, &position.path, &ide::selection_ranges(&context.snapshot, &position)?)
    };
    params.positions.iter().map(of).collect()
}

/// Converts nested ranges, innermost first.
fn nested(context: &ProtocolContext, path: &std::path::Path, ranges: &[Range<u32>]) -> Option<lsp::SelectionRange> {
    let mut outer = None;
    for range in ranges.iter().rev() {
        let parent = outer.take().map(Box::new);
        outer = Some(lsp::SelectionRange { range: context.range(path, range)?, parent });
    }
    outer
}
