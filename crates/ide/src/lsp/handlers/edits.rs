//! Code actions and formatting.

use crate::lsp::convert::ProtocolContext;
use crate::{self as ide, ActionKind, FormatScope};
use gen_lsp_types as lsp;
use serde_json::Value;

pub(super) fn actions(
    context: &ProtocolContext,
    params: &lsp::CodeActionParams,
) -> Option<Vec<lsp::CodeActionResponse>> {
    let path = context.path(&params.text_document.uri);
    let range = context.bytes(&params.text_document, &params.range)?;
    let of = |action: ide::Action| {
        let kind = match action.kind {
            ActionKind::Fix => lsp::CodeActionKind::QuickFix,
            ActionKind::FixAll => lsp::CodeActionKind::SourceFixAll,
            ActionKind::Extract => lsp::CodeActionKind::RefactorExtract,
            ActionKind::Drive => lsp::CodeActionKind::RefactorRewrite,
        };
        if !is_requested(params.context.only.as_deref(), &kind) {
            return None;
        }
        let action = lsp::CodeAction {
            diagnostics: action
                .fixes
                .and_then(|fixed| context.diagnostic(&path, &fixed))
                .map(|diagnostic| vec![diagnostic]),
            is_preferred: action.is_preferred.then_some(true),
            edit: Some(context.edit(&action.changes)?),
            title: action.title,
            kind: Some(kind),
            ..lsp::CodeAction::default()
        };
        Some(action.into())
    };
    Some(ide::actions(&context.snapshot, &path, &range)?.into_iter().filter_map(of).collect())
}

/// Returns whether a kind of action is requested, directly or by a parent: `source` includes `source.fixAll`.
fn is_requested(only: Option<&[lsp::CodeActionKind]>, kind: &lsp::CodeActionKind) -> bool {
    let name = |kind: &lsp::CodeActionKind| match serde_json::to_value(kind) {
        Ok(Value::String(name)) => name,
        _ => String::new(),
    };
    let kind = name(kind);
    only.is_none_or(|only| {
        only.iter().map(name).any(|only| only.is_empty() || kind == only || kind.starts_with(&format!("{only}.")))
    })
}

pub(super) fn formatting(
    context: &ProtocolContext,
    params: &lsp::DocumentFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    formatted(context, &params.text_document, &FormatScope::Whole)
}

pub(super) fn range_formatting(
    context: &ProtocolContext,
    params: &lsp::DocumentRangeFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    let range = context.bytes(&params.text_document, &params.range)?;
    formatted(context, &params.text_document, &FormatScope::Lines(range))
}

pub(super) fn brace_formatting(
    context: &ProtocolContext,
    params: &lsp::DocumentOnTypeFormattingParams,
) -> Option<Vec<lsp::TextEdit>> {
    let (text_document, position) = (params.text_document.clone(), params.position);
    let position = context.position(&lsp::TextDocumentPositionParams { text_document, position })?;
    formatted(context, &params.text_document, &FormatScope::AtBrace(position.offset))
}

fn formatted(
    context: &ProtocolContext,
    document: &lsp::TextDocumentIdentifier,
    scope: &FormatScope,
) -> Option<Vec<lsp::TextEdit>> {
    let path = context.path(&document.uri);
    let changes = ide::formatting(&context.snapshot, &path, scope)?;
    Some(changes.iter().filter_map(|change| context.text_edit(change)).collect())
}
