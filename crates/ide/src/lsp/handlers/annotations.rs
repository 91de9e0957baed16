//! Inlay hints and code lenses.

use crate::lsp::convert::ProtocolContext;
use crate::{self as ide, LensKind};
use gen_lsp_types as lsp;
use serde_json::json;

pub(super) fn hints(context: &ProtocolContext, params: &lsp::InlayHintParams) -> Option<Vec<lsp::InlayHint>> {
    let path = context.path(&params.text_document.uri);
    let range = context.bytes_in(&path, &params.range)?;
    let hint = |hint: ide::Hint| {
        Some(lsp::InlayHint {
            position: context.range(&path, &(hint.offset..hint.offset))?.start,
            label: hint.label.into(),
            kind: None,
            text_edits: None,
            tooltip: Some(hint.meaning.into()),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
    };
    Some(ide::hints(&context.snapshot, &path, &range)?.into_iter().filter_map(hint).collect())
}

/// Returns the code lenses. A result has a title without a command; the commands need clients that have them.
pub(super) fn lenses(context: &ProtocolContext, params: &lsp::CodeLensParams) -> Option<Vec<lsp::CodeLens>> {
    let uri = &params.text_document.uri;
    let path = context.path(uri);
    let lens = |lens: ide::Lens| {
        let of_mechanism = |title: &str, name: String| {
            let arguments = Some(vec![json!(uri), json!(name)]);
            (title.to_owned(), format!("mechc.{title}"), arguments)
        };
        let (title, command, arguments) = match lens.kind {
            LensKind::View(name) => of_mechanism("view", name),
            LensKind::Run(name) => of_mechanism("run", name),
            LensKind::Check(name) => of_mechanism("check", name),
            LensKind::Result(title) => (title, String::new(), None),
        };
        let has_no_command = command.is_empty();
        let can = if command == "mechc.view" { context.client.can_view } else { context.client.can_run };
        if !has_no_command && !can {
            return None;
        }
        let command = lsp::Command { title, tooltip: None, command, arguments };
        Some(lsp::CodeLens { range: context.range(&path, &lens.range)?, command: Some(command), data: None })
    };
    Some(ide::lenses(&context.snapshot, &path)?.into_iter().filter_map(lens).collect())
}
