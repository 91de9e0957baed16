//! Navigation and renaming.

use super::Failure;
use crate as ide;
use crate::lsp::capabilities::Ability;
use crate::lsp::convert::{ProtocolContext, symbol_kind};
use gen_lsp_types as lsp;

pub(super) fn definition(context: &ProtocolContext, params: &lsp::DefinitionParams) -> Option<lsp::DefinitionResponse> {
    let position = context.position(&params.text_document_position_params)?;
    let link = ide::definition(&context.snapshot, &position)?;
    let to = context.location(&link.to)?;
    if !context.client.can(Ability::Links) {
        return Some(lsp::Definition::from(to).into());
    }
    let from = context.range(&position.path, &link.from.range());
    let link = lsp::LocationLink {
        origin_selection_range: from,
        target_uri: to.uri,
        target_range: to.range,
        target_selection_range: to.range,
    };
    Some(vec![link].into())
}

pub(super) fn references(context: &ProtocolContext, params: &lsp::ReferenceParams) -> Option<Vec<lsp::Location>> {
    let position = context.position(&params.text_document_position_params)?;
    let found = ide::references(&context.snapshot, &position, params.context.include_declaration)?;
    Some(found.iter().filter_map(|position| context.location(position)).collect())
}

pub(super) fn highlights(
    context: &ProtocolContext,
    params: &lsp::DocumentHighlightParams,
) -> Option<Vec<lsp::DocumentHighlight>> {
    let position = context.position(&params.text_document_position_params)?;
    let found = ide::highlights(&context.snapshot, &position)?;
    let of = |one: &ide::Highlight| {
        let kind = if one.declares { lsp::DocumentHighlightKind::Write } else { lsp::DocumentHighlightKind::Read };
        Some(lsp::DocumentHighlight { range: context.range(&position.path, &one.range)?, kind: Some(kind) })
    };
    Some(found.iter().filter_map(of).collect())
}

pub(super) fn links(context: &ProtocolContext, params: &lsp::DocumentLinkParams) -> Option<Vec<lsp::DocumentLink>> {
    let path = context.path(&params.text_document.uri);
    let of = |link: &ide::FileLink| {
        let file = link.file.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        Some(lsp::DocumentLink {
            range: context.range(&path, &link.range)?,
            target: Some(lsp::Uri(context.documents.uri(&link.file))),
            tooltip: Some(format!("open {file}")),
            ..lsp::DocumentLink::default()
        })
    };
    Some(ide::file_links(&context.snapshot, &path)?.iter().filter_map(of).collect())
}

pub(super) fn workspace_symbols(
    context: &ProtocolContext,
    params: &lsp::WorkspaceSymbolParams,
) -> Option<lsp::WorkspaceSymbolResponse> {
    let found = ide::workspace_names(&context.snapshot, &params.query);
    let of = |found: &ide::WorkspaceName| {
        let base_symbol_information = lsp::BaseSymbolInformation {
            name: found.name.clone(),
            kind: symbol_kind(found.kind),
            tags: None,
            container_name: found.within.clone(),
        };
        let location = context.location(&found.location)?;
        Some(lsp::WorkspaceSymbol { location: location.into(), data: None, base_symbol_information })
    };
    (!context.snapshot.is_cancelled()).then(|| found.iter().filter_map(of).collect::<Vec<_>>().into())
}

pub(super) fn prepare_rename(
    context: &ProtocolContext,
    params: &lsp::PrepareRenameParams,
) -> Result<Option<lsp::PrepareRenameResult>, Failure> {
    let Some(position) = context.position(&params.text_document_position_params) else { return Ok(None) };
    let named = ide::prepare_rename(&context.snapshot, &position).map_err(Failure::Refused)?;
    Ok(context.range(&position.path, &named.range()).map(Into::into))
}

pub(super) fn rename(
    context: &ProtocolContext,
    params: &lsp::RenameParams,
) -> Result<Option<lsp::WorkspaceEdit>, Failure> {
    let Some(position) = context.position(&params.text_document_position_params) else { return Ok(None) };
    let changes = ide::rename(&context.snapshot, &position, &params.new_name).map_err(Failure::Refused)?;
    Ok(context.edit(&changes))
}
