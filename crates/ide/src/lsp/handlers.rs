//! Requests, and what answers them: params to a feature of `ide`, and its answer to the protocol's words.

mod annotations;
mod completion;
mod edits;
mod navigate;
mod signature;
mod structure;
pub(super) mod tokens;

use super::convert::{ProtocolContext, markdown, symbol_kind};
use super::pool::TaskKind;
use crate as ide;
use gen_lsp_types::{self as lsp, Request};
use serde_json::Value;
use std::path::Path;

/// Why a request has no answer.
#[derive(Clone, Debug)]
pub(super) enum Failure {
    /// Its params are not those of its method.
    Params(String),
    /// A later edit made it pointless.
    Modified,
    /// It cannot be done; this is to be told.
    Refused(String),
    /// The server has a mistake.
    Panicked(String),
}

/// How a method is answered.
pub(super) struct Method {
    /// Its name in the protocol.
    pub name: &'static str,
    /// Whether its answer is worth as much for a later text: what names no position.
    pub is_retried: bool,
    /// On which threads.
    pub kind: TaskKind,
    /// From its params to its answer.
    pub answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>,
}

/// Every request that is answered from a snapshot alone, by name.
pub(super) const TABLE: &[Method] = &[
    weighed::<lsp::CodeActionRequest>(|context, params| {
        answered::<lsp::CodeActionRequest>(context, params, edits::actions)
    }),
    method::<lsp::CodeLensRequest>(true, |context, params| {
        answered::<lsp::CodeLensRequest>(context, params, annotations::lenses)
    }),
    method::<lsp::CompletionRequest>(false, |context, params| {
        answered::<lsp::CompletionRequest>(context, params, completion::completion)
    }),
    method::<lsp::DefinitionRequest>(false, |context, params| {
        answered::<lsp::DefinitionRequest>(context, params, navigate::definition)
    }),
    method::<lsp::DocumentFormattingRequest>(false, |context, params| {
        answered::<lsp::DocumentFormattingRequest>(context, params, edits::formatting)
    }),
    method::<lsp::DocumentHighlightRequest>(false, |context, params| {
        answered::<lsp::DocumentHighlightRequest>(context, params, navigate::highlights)
    }),
    method::<lsp::DocumentLinkRequest>(true, |context, params| {
        answered::<lsp::DocumentLinkRequest>(context, params, navigate::links)
    }),
    method::<lsp::DocumentOnTypeFormattingRequest>(false, |context, params| {
        answered::<lsp::DocumentOnTypeFormattingRequest>(context, params, edits::brace_formatting)
    }),
    method::<lsp::DocumentRangeFormattingRequest>(false, |context, params| {
        answered::<lsp::DocumentRangeFormattingRequest>(context, params, edits::range_formatting)
    }),
    method::<lsp::DocumentSymbolRequest>(true, |context, params| {
        answered::<lsp::DocumentSymbolRequest>(context, params, symbols)
    }),
    method::<lsp::FoldingRangeRequest>(true, |context, params| {
        answered::<lsp::FoldingRangeRequest>(context, params, structure::folds)
    }),
    method::<lsp::HoverRequest>(false, |context, params| answered::<lsp::HoverRequest>(context, params, hover)),
    method::<lsp::InlayHintRequest>(false, |context, params| {
        answered::<lsp::InlayHintRequest>(context, params, annotations::hints)
    }),
    method::<lsp::PrepareRenameRequest>(false, |context, params| {
        tried::<lsp::PrepareRenameRequest>(context, params, navigate::prepare_rename)
    }),
    method::<lsp::ReferencesRequest>(false, |context, params| {
        answered::<lsp::ReferencesRequest>(context, params, navigate::references)
    }),
    weighed::<lsp::RenameRequest>(|context, params| tried::<lsp::RenameRequest>(context, params, navigate::rename)),
    method::<lsp::SelectionRangeRequest>(false, |context, params| {
        answered::<lsp::SelectionRangeRequest>(context, params, structure::selections)
    }),
    method::<lsp::SemanticTokensRangeRequest>(false, |context, params| {
        answered::<lsp::SemanticTokensRangeRequest>(context, params, tokens::in_range)
    }),
    method::<lsp::SemanticTokensRequest>(true, |context, params| {
        answered::<lsp::SemanticTokensRequest>(context, params, tokens::all)
    }),
    method::<lsp::SignatureHelpRequest>(false, |context, params| {
        answered::<lsp::SignatureHelpRequest>(context, params, signature::signatures)
    }),
    method::<lsp::WorkspaceSymbolRequest>(true, |context, params| {
        answered::<lsp::WorkspaceSymbolRequest>(context, params, navigate::workspace_symbols)
    }),
];

const fn method<R: Request>(is_retried: bool, answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>) -> Method {
    Method { name: R::METHOD.as_str(), is_retried, kind: TaskKind::Request, answer }
}

/// One that takes a proof, or checks of what would be: others do not wait for it.
const fn weighed<R: Request>(answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>) -> Method {
    Method { kind: TaskKind::Slow, ..method::<R>(false, answer) }
}

/// Reads the params, and writes the answer; what a snapshot gives that was cancelled is none.
fn answered<R: Request>(
    context: &ProtocolContext,
    params: Value,
    answer: fn(&ProtocolContext, &R::Params) -> R::Result,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    written::<R>(context, Ok(answer(context, &params)))
}

/// The same of what may be refused.
fn tried<R: Request>(
    context: &ProtocolContext,
    params: Value,
    answer: fn(&ProtocolContext, &R::Params) -> Result<R::Result, Failure>,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    written::<R>(context, answer(context, &params))
}

fn written<R: Request>(context: &ProtocolContext, answer: Result<R::Result, Failure>) -> Result<Value, Failure> {
    if context.snapshot.is_cancelled() {
        return Err(Failure::Modified);
    }
    serde_json::to_value(answer?).map_err(|error| Failure::Panicked(error.to_string()))
}

fn hover(context: &ProtocolContext, params: &lsp::HoverParams) -> Option<lsp::Hover> {
    let position = context.position(&params.text_document_position_params)?;
    let hover = ide::hover(&context.snapshot, &position)?;
    let range = context.range(&position.path, &hover.location.range());
    Some(lsp::Hover { contents: markdown(hover.text).into(), range })
}

fn symbols(context: &ProtocolContext, params: &lsp::DocumentSymbolParams) -> Option<lsp::DocumentSymbolResponse> {
    let path = context.path(&params.text_document.uri);
    let entries = ide::outline(&context.snapshot, &path)?;
    Some(symbols_of(context, &path, &entries).into())
}

fn symbols_of(context: &ProtocolContext, path: &Path, entries: &[ide::OutlineEntry]) -> Vec<lsp::DocumentSymbol> {
    let symbol = |entry: &ide::OutlineEntry| {
        Some(lsp::DocumentSymbol::new(
            entry.name.clone(),
            None,
            symbol_kind(entry.kind),
            None,
            None,
            context.range(path, &entry.range)?,
            context.range(path, &entry.name_range)?,
            Some(symbols_of(context, path, &entry.inside)),
        ))
    };
    entries.iter().filter_map(symbol).collect()
}
