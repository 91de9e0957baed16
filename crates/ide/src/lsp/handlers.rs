//! Handlers of requests: each converts the params, calls a feature of `ide` and converts its result.

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

/// The reason why a request has no result.
#[derive(Clone, Debug)]
pub(super) enum Failure {
    /// The params are invalid.
    Params(String),
    /// A later edit has cancelled the request.
    Modified,
    /// The request cannot be fulfilled; the text is for the user.
    Refused(String),
    /// The handler has panicked.
    Panicked(String),
}

/// A method of the protocol with its handler.
pub(super) struct Method {
    /// The name in the protocol.
    pub name: &'static str,
    /// True if the request is retried on a later text; it must name no position.
    pub is_retried: bool,
    /// The threads that it runs on.
    pub kind: TaskKind,
    /// The handler.
    pub answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>,
}

/// The methods that are answered from a snapshot alone, by name.
pub(super) const TABLE: &[Method] = &[
    slow_method::<lsp::CodeActionRequest>(|context, params| {
        run::<lsp::CodeActionRequest>(context, params, edits::actions)
    }),
    method::<lsp::CodeLensRequest>(true, |context, params| {
        run::<lsp::CodeLensRequest>(context, params, annotations::lenses)
    }),
    method::<lsp::CompletionRequest>(false, |context, params| {
        run::<lsp::CompletionRequest>(context, params, completion::completion)
    }),
    method::<lsp::DefinitionRequest>(false, |context, params| {
        run::<lsp::DefinitionRequest>(context, params, navigate::definition)
    }),
    method::<lsp::DocumentFormattingRequest>(false, |context, params| {
        run::<lsp::DocumentFormattingRequest>(context, params, edits::formatting)
    }),
    method::<lsp::DocumentHighlightRequest>(false, |context, params| {
        run::<lsp::DocumentHighlightRequest>(context, params, navigate::highlights)
    }),
    method::<lsp::DocumentLinkRequest>(true, |context, params| {
        run::<lsp::DocumentLinkRequest>(context, params, navigate::links)
    }),
    method::<lsp::DocumentOnTypeFormattingRequest>(false, |context, params| {
        run::<lsp::DocumentOnTypeFormattingRequest>(context, params, edits::brace_formatting)
    }),
    method::<lsp::DocumentRangeFormattingRequest>(false, |context, params| {
        run::<lsp::DocumentRangeFormattingRequest>(context, params, edits::range_formatting)
    }),
    method::<lsp::DocumentSymbolRequest>(true, |context, params| {
        run::<lsp::DocumentSymbolRequest>(context, params, symbols)
    }),
    method::<lsp::FoldingRangeRequest>(true, |context, params| {
        run::<lsp::FoldingRangeRequest>(context, params, structure::folds)
    }),
    method::<lsp::HoverRequest>(false, |context, params| run::<lsp::HoverRequest>(context, params, hover)),
    method::<lsp::InlayHintRequest>(false, |context, params| {
        run::<lsp::InlayHintRequest>(context, params, annotations::hints)
    }),
    method::<lsp::PrepareRenameRequest>(false, |context, params| {
        try_run::<lsp::PrepareRenameRequest>(context, params, navigate::prepare_rename)
    }),
    method::<lsp::ReferencesRequest>(false, |context, params| {
        run::<lsp::ReferencesRequest>(context, params, navigate::references)
    }),
    slow_method::<lsp::RenameRequest>(|context, params| {
        try_run::<lsp::RenameRequest>(context, params, navigate::rename)
    }),
    method::<lsp::SelectionRangeRequest>(false, |context, params| {
        run::<lsp::SelectionRangeRequest>(context, params, structure::selections)
    }),
    method::<lsp::SemanticTokensRangeRequest>(false, |context, params| {
        run::<lsp::SemanticTokensRangeRequest>(context, params, tokens::in_range)
    }),
    method::<lsp::SemanticTokensRequest>(true, |context, params| {
        run::<lsp::SemanticTokensRequest>(context, params, tokens::all)
    }),
    method::<lsp::SignatureHelpRequest>(false, |context, params| {
        run::<lsp::SignatureHelpRequest>(context, params, signature::signatures)
    }),
    method::<lsp::WorkspaceSymbolRequest>(true, |context, params| {
        run::<lsp::WorkspaceSymbolRequest>(context, params, navigate::workspace_symbols)
    }),
];

const fn method<R: Request>(is_retried: bool, answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>) -> Method {
    Method { name: R::METHOD.as_str(), is_retried, kind: TaskKind::Request, answer }
}

/// Creates a method that needs a proof or checks changed texts, on a thread of its own.
const fn slow_method<R: Request>(answer: fn(&ProtocolContext, Value) -> Result<Value, Failure>) -> Method {
    Method { kind: TaskKind::Slow, ..method::<R>(false, answer) }
}

/// Parses the params, calls a handler and encodes its result; the result of a cancelled snapshot is discarded.
fn run<R: Request>(
    context: &ProtocolContext,
    params: Value,
    answer: fn(&ProtocolContext, &R::Params) -> R::Result,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    encode::<R>(context, Ok(answer(context, &params)))
}

/// Runs a handler that may refuse the request.
fn try_run<R: Request>(
    context: &ProtocolContext,
    params: Value,
    answer: fn(&ProtocolContext, &R::Params) -> Result<R::Result, Failure>,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    encode::<R>(context, answer(context, &params))
}

fn encode<R: Request>(context: &ProtocolContext, answer: Result<R::Result, Failure>) -> Result<Value, Failure> {
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
