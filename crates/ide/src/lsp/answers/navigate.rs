//! Where names lead, and what new name they can have.

use super::Failure;
use crate as ide;
use crate::lsp::capabilities::Ability;
use crate::lsp::convert::{Texts, symbol_kind};
use gen_lsp_types as lsp;

pub(super) fn definition(texts: &Texts, params: &lsp::DefinitionParams) -> Option<lsp::DefinitionResponse> {
    let place = texts.place(&params.text_document_position_params)?;
    let link = ide::definition(&texts.snapshot, &place)?;
    let to = texts.location(&link.to)?;
    if !texts.client.can(Ability::Links) {
        return Some(lsp::Definition::from(to).into());
    }
    let from = texts.range(&place.path, &link.from.range());
    let link = lsp::LocationLink {
        origin_selection_range: from,
        target_uri: to.uri,
        target_range: to.range,
        target_selection_range: to.range,
    };
    Some(vec![link].into())
}

pub(super) fn references(texts: &Texts, params: &lsp::ReferenceParams) -> Option<Vec<lsp::Location>> {
    let place = texts.place(&params.text_document_position_params)?;
    let found = ide::references(&texts.snapshot, &place, params.context.include_declaration)?;
    Some(found.iter().filter_map(|place| texts.location(place)).collect())
}

pub(super) fn highlights(texts: &Texts, params: &lsp::DocumentHighlightParams) -> Option<Vec<lsp::DocumentHighlight>> {
    let place = texts.place(&params.text_document_position_params)?;
    let found = ide::highlights(&texts.snapshot, &place)?;
    let of = |one: &ide::Highlight| {
        let kind = if one.declares { lsp::DocumentHighlightKind::Write } else { lsp::DocumentHighlightKind::Read };
        Some(lsp::DocumentHighlight { range: texts.range(&place.path, &one.range)?, kind: Some(kind) })
    };
    Some(found.iter().filter_map(of).collect())
}

pub(super) fn links(texts: &Texts, params: &lsp::DocumentLinkParams) -> Option<Vec<lsp::DocumentLink>> {
    let path = texts.path(&params.text_document.uri);
    let of = |link: &ide::FileLink| {
        let file = link.file.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        Some(lsp::DocumentLink {
            range: texts.range(&path, &link.range)?,
            target: Some(lsp::Uri(texts.documents.uri(&link.file))),
            tooltip: Some(format!("open {file}")),
            ..lsp::DocumentLink::default()
        })
    };
    Some(ide::file_links(&texts.snapshot, &path)?.iter().filter_map(of).collect())
}

pub(super) fn workspace_symbols(
    texts: &Texts,
    params: &lsp::WorkspaceSymbolParams,
) -> Option<lsp::WorkspaceSymbolResponse> {
    let found = ide::workspace_names(&texts.snapshot, &params.query);
    let of = |found: &ide::Found| {
        let base_symbol_information = lsp::BaseSymbolInformation {
            name: found.name.clone(),
            kind: symbol_kind(found.kind),
            tags: None,
            container_name: found.within.clone(),
        };
        let location = texts.location(&found.place)?;
        Some(lsp::WorkspaceSymbol { location: location.into(), data: None, base_symbol_information })
    };
    (!texts.snapshot.is_cancelled()).then(|| found.iter().filter_map(of).collect::<Vec<_>>().into())
}

pub(super) fn prepare_rename(
    texts: &Texts,
    params: &lsp::PrepareRenameParams,
) -> Result<Option<lsp::PrepareRenameResult>, Failure> {
    let Some(place) = texts.place(&params.text_document_position_params) else { return Ok(None) };
    let named = ide::prepare_rename(&texts.snapshot, &place).map_err(Failure::Refused)?;
    Ok(texts.range(&place.path, &named.range()).map(Into::into))
}

pub(super) fn rename(texts: &Texts, params: &lsp::RenameParams) -> Result<Option<lsp::WorkspaceEdit>, Failure> {
    let Some(place) = texts.place(&params.text_document_position_params) else { return Ok(None) };
    let changes = ide::rename(&texts.snapshot, &place, &params.new_name).map_err(Failure::Refused)?;
    Ok(texts.edit(&changes))
}
