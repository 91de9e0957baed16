//! Semantic tokens.

use crate::lsp::convert::Texts;
use crate::lsp::legend::OF_KINDS;
use crate::{self as ide, SemanticToken};
use gen_lsp_types as lsp;
use std::ops::Range;

pub(super) fn all(texts: &Texts, params: &lsp::SemanticTokensParams) -> Option<lsp::SemanticTokens> {
    encoded(texts, &params.text_document.uri, &(0..u32::MAX))
}

pub(super) fn in_range(texts: &Texts, params: &lsp::SemanticTokensRangeParams) -> Option<lsp::SemanticTokens> {
    let uri = &params.text_document.uri;
    encoded(texts, uri, &texts.stretch(&texts.path(uri), &params.range)?)
}

fn encoded(texts: &Texts, uri: &lsp::Uri, range: &Range<u32>) -> Option<lsp::SemanticTokens> {
    let path = texts.path(uri);
    let mut before = lsp::Position { line: 0, character: 0 };
    let mut token = |token: &SemanticToken| {
        let lsp::Range { start, end } = texts.range(&path, &token.range)?;
        let is_same_line = start.line == before.line;
        let delta_start = start.character - if is_same_line { before.character } else { 0 };
        let kind = OF_KINDS.iter().position(|(kind, _)| *kind == token.kind)?;
        let marks = [token.declares, token.is_constant, token.is_of_language];
        let marks = marks.iter().enumerate().fold(0, |bits, (k, is)| bits | (u32::from(*is) << k));
        let encoded = lsp::SemanticToken {
            delta_line: start.line - before.line,
            delta_start,
            length: end.character.saturating_sub(start.character),
            token_type: kind as u32,
            token_modifiers_bitset: marks,
        };
        before = start;
        Some(encoded)
    };
    let data = ide::tokens(&texts.snapshot, &path, range)?.iter().filter_map(&mut token).collect();
    Some(lsp::SemanticTokens { result_id: None, data })
}
