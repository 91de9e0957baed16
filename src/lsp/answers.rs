//! Requests, and what answers them: params to a feature of `ide`, and its answer to the protocol's words.

use super::convert::{Texts, markdown, symbol_kind};
use crate::ide;
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
    /// The server has a mistake.
    Panicked(String),
}

/// How a method is answered.
pub(super) struct Method {
    /// Its name in the protocol.
    pub name: &'static str,
    /// Whether its answer is worth as much for a later text: what names no position.
    pub is_retried: bool,
    /// From its params to its answer.
    pub answer: fn(&Texts, Value) -> Result<Value, Failure>,
}

/// Every request that is answered from a snapshot alone, by name.
pub(super) const TABLE: &[Method] = &[
    method::<lsp::DocumentSymbolRequest>(true, |texts, params| {
        answered::<lsp::DocumentSymbolRequest>(texts, params, symbols)
    }),
    method::<lsp::HoverRequest>(false, |texts, params| answered::<lsp::HoverRequest>(texts, params, hover)),
];

const fn method<R: Request>(is_retried: bool, answer: fn(&Texts, Value) -> Result<Value, Failure>) -> Method {
    Method { name: R::METHOD.as_str(), is_retried, answer }
}

/// Reads the params, and writes the answer; what a snapshot gives that was cancelled is none.
fn answered<R: Request>(
    texts: &Texts,
    params: Value,
    answer: fn(&Texts, &R::Params) -> R::Result,
) -> Result<Value, Failure> {
    let params = serde_json::from_value(params).map_err(|error| Failure::Params(error.to_string()))?;
    let answer = answer(texts, &params);
    if texts.snapshot.is_cancelled() {
        return Err(Failure::Modified);
    }
    serde_json::to_value(answer).map_err(|error| Failure::Panicked(error.to_string()))
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
