//! Requests, and what answers them: params to a feature of `ide`, and its answer to the protocol's words.

mod completion;
mod edits;
mod hints;
mod lenses;
mod navigate;
mod signature;
mod structure;
mod tokens;

use super::convert::{Texts, markdown, symbol_kind};
use super::pool::Kind;
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
    pub kind: Kind,
    /// From its params to its answer.
    pub answer: fn(&Texts, Value) -> Result<Value, Failure>,
}

/// Every request that is answered from a snapshot alone, by name.
pub(super) const TABLE: &[Method] = &[
    weighed::<lsp::CodeActionRequest>(|texts, params| {
        answered::<lsp::CodeActionRequest>(texts, params, edits::actions)
    }),
    method::<lsp::CodeLensRequest>(true, |texts, params| {
        answered::<lsp::CodeLensRequest>(texts, params, lenses::lenses)
    }),
    method::<lsp::CompletionRequest>(false, |texts, params| {
        answered::<lsp::CompletionRequest>(texts, params, completion::completion)
    }),
    method::<lsp::DefinitionRequest>(false, |texts, params| {
        answered::<lsp::DefinitionRequest>(texts, params, navigate::definition)
    }),
    method::<lsp::DocumentFormattingRequest>(false, |texts, params| {
        answered::<lsp::DocumentFormattingRequest>(texts, params, edits::formatting)
    }),
    method::<lsp::DocumentHighlightRequest>(false, |texts, params| {
        answered::<lsp::DocumentHighlightRequest>(texts, params, navigate::highlights)
    }),
    method::<lsp::DocumentLinkRequest>(true, |texts, params| {
        answered::<lsp::DocumentLinkRequest>(texts, params, navigate::links)
    }),
    method::<lsp::DocumentOnTypeFormattingRequest>(false, |texts, params| {
        answered::<lsp::DocumentOnTypeFormattingRequest>(texts, params, edits::brace_formatting)
    }),
    method::<lsp::DocumentRangeFormattingRequest>(false, |texts, params| {
        answered::<lsp::DocumentRangeFormattingRequest>(texts, params, edits::range_formatting)
    }),
    method::<lsp::DocumentSymbolRequest>(true, |texts, params| {
        answered::<lsp::DocumentSymbolRequest>(texts, params, symbols)
    }),
    method::<lsp::FoldingRangeRequest>(true, |texts, params| {
        answered::<lsp::FoldingRangeRequest>(texts, params, structure::folds)
    }),
    method::<lsp::HoverRequest>(false, |texts, params| answered::<lsp::HoverRequest>(texts, params, hover)),
    method::<lsp::InlayHintRequest>(false, |texts, params| {
        answered::<lsp::InlayHintRequest>(texts, params, hints::hints)
    }),
    method::<lsp::PrepareRenameRequest>(false, |texts, params| {
        tried::<lsp::PrepareRenameRequest>(texts, params, navigate::prepare_rename)
    }),
    method::<lsp::ReferencesRequest>(false, |texts, params| {
        answered::<lsp::ReferencesRequest>(texts, params, navigate::references)
    }),
    weighed::<lsp::RenameRequest>(|texts, params| tried::<lsp::RenameRequest>(texts, params, navigate::rename)),
    method::<lsp::SelectionRangeRequest>(false, |texts, params| {
        answered::<lsp::SelectionRangeRequest>(texts, params, structure::selections)
    }),
    method::<lsp::SemanticTokensRangeRequest>(false, |texts, params| {
        answered::<lsp::SemanticTokensRangeRequest>(texts, params, tokens::in_range)
    }),
    method::<lsp::SemanticTokensRequest>(true, |texts, params| {
        answered::<lsp::SemanticTokensRequest>(texts, params, tokens::all)
    }),
    method::<lsp::SignatureHelpRequest>(false, |texts, params| {
        answered::<lsp::SignatureHelpRequest>(texts, params, signature::signatures)
    }),
    method::<lsp::WorkspaceSymbolRequest>(true, |texts, params| {
        answered::<lsp::WorkspaceSymbolRequest>(texts, params, navigate::workspace_symbols)
    }),
];

const fn method<R: Request>(is_retried: bool, answer: fn(&Texts, Value) -> Result<Value, Failure>) -> Method {
    Method { name: R::METHOD.as_str(), is_retried, kind: Kind::Request, answer }
}

/// One that takes a proof, or checks of what would be: others do not wait for it.
const fn weighed<R: Request>(answer: fn(&Texts, Value) -> Result<Value, Failure>) -> Method {
    Method { kind: Kind::Weighed, ..method::<R>(false, answer) }
}

/// Reads the params, and writes the answer; what a snapshot gives that was cancelled is none.
fn answered<R: Request>(
    texts: &Texts,
    params: Value,
    answer: fn(&Texts, &R::Params) -> R::Result,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    written::<R>(texts, Ok(answer(texts, &params)))
}

/// The same of what may be refused.
fn tried<R: Request>(
    texts: &Texts,
    params: Value,
    answer: fn(&Texts, &R::Params) -> Result<R::Result, Failure>,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    written::<R>(texts, answer(texts, &params))
}

fn written<R: Request>(texts: &Texts, answer: Result<R::Result, Failure>) -> Result<Value, Failure> {
    if texts.snapshot.is_cancelled() {
        return Err(Failure::Modified);
    }
    serde_json::to_value(answer?).map_err(|error| Failure::Panicked(error.to_string()))
}

fn hover(texts: &Texts, params: &lsp::HoverParams) -> Option<lsp::Hover> {
    let place = texts.place(&params.text_document_position_params)?;
    let hover = ide::hover(&texts.snapshot, &place)?;
    let range = texts.range(&place.path, &hover.place.range());
    Some(lsp::Hover { contents: markdown(hover.text).into(), range })
}

fn symbols(texts: &Texts, params: &lsp::DocumentSymbolParams) -> Option<lsp::DocumentSymbolResponse> {
    let path = texts.path(&params.text_document.uri);
    let entries = ide::outline(&texts.snapshot, &path)?;
    Some(symbols_of(texts, &path, &entries).into())
}

fn symbols_of(texts: &Texts, path: &Path, entries: &[ide::Entry]) -> Vec<lsp::DocumentSymbol> {
    let symbol = |entry: &ide::Entry| {
        Some(lsp::DocumentSymbol::new(
            entry.name.clone(),
            None,
            symbol_kind(entry.kind),
            None,
            None,
            texts.range(path, &entry.range)?,
            texts.range(path, &entry.name_range)?,
            Some(symbols_of(texts, path, &entry.inside)),
        ))
    };
    entries.iter().filter_map(symbol).collect()
}
