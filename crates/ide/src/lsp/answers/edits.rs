//! Changes of texts that a client can ask for: fixes, refactorings, formatting.

use crate::lsp::convert::Texts;
use crate::{self as ide, ActionKind, Formatted};
use gen_lsp_types as lsp;
use serde_json::Value;

pub(super) fn actions(texts: &Texts, params: &lsp::CodeActionParams) -> Option<Vec<lsp::CodeActionResponse>> {
    let path = texts.path(&params.text_document.uri);
    let range = texts.bytes(&params.text_document, &params.range)?;
    let of = |action: ide::Action| {
        let kind = match action.kind {
            ActionKind::Fix => lsp::CodeActionKind::QuickFix,
            ActionKind::FixAll => lsp::CodeActionKind::SourceFixAll,
            ActionKind::Extract => lsp::CodeActionKind::RefactorExtract,
            ActionKind::Drive => lsp::CodeActionKind::RefactorRewrite,
        };
        if !is_asked(params.context.only.as_deref(), &kind) {
            return None;
        }
        let action = lsp::CodeAction {
            diagnostics: action.mends.and_then(|said| texts.diagnostic(&path, &said)).map(|said| vec![said]),
            is_preferred: action.is_preferred.then_some(true),
            edit: Some(texts.edit(&action.changes)?),
            title: action.title,
            kind: Some(kind),
            ..lsp::CodeAction::default()
        };
        Some(action.into())
    };
    Some(ide::actions(&texts.snapshot, &path, &range)?.into_iter().filter_map(of).collect())
}

/// Whether a kind is one of those that are asked for, or is a part of one: `source` holds `source.fixAll`.
fn is_asked(only: Option<&[lsp::CodeActionKind]>, kind: &lsp::CodeActionKind) -> bool {
    let name = |kind: &lsp::CodeActionKind| match serde_json::to_value(kind) {
        Ok(Value::String(name)) => name,
        _ => String::new(),
    };
    let kind = name(kind);
    only.is_none_or(|only| {
        only.iter().map(name).any(|asked| asked.is_empty() || kind == asked || kind.starts_with(&format!("{asked}.")))
    })
}

pub(super) fn formatting(texts: &Texts, params: &lsp::DocumentFormattingParams) -> Option<Vec<lsp::TextEdit>> {
    formatted(texts, &params.text_document, &Formatted::Whole)
}

pub(super) fn range_formatting(
    texts: &Texts,
    params: &lsp::DocumentRangeFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    let range = texts.bytes(&params.text_document, &params.range)?;
    formatted(texts, &params.text_document, &Formatted::In(range))
}

pub(super) fn brace_formatting(
    texts: &Texts,
    params: &lsp::DocumentOnTypeFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    let (text_document, position) = (params.text_document.clone(), params.position);
    let place = texts.place(&lsp::TextDocumentPositionParams { text_document, position })?;
    formatted(texts, &params.text_document, &Formatted::AtBrace(place.offset))
}

fn formatted(texts: &Texts, document: &lsp::TextDocumentIdentifier, what: &Formatted) -> Option<Vec<lsp::TextEdit>> {
    let path = texts.path(&document.uri);
    let changes = ide::formatting(&texts.snapshot, &path, what)?;
    Some(changes.iter().filter_map(|change| texts.text_edit(change)).collect())
}
