//! Inlay hints.

use crate as ide;
use crate::lsp::convert::Texts;
use gen_lsp_types as lsp;

pub(super) fn hints(texts: &Texts, params: &lsp::InlayHintParams) -> Option<Vec<lsp::InlayHint>> {
    let path = texts.path(&params.text_document.uri);
    let range = texts.stretch(&path, &params.range)?;
    let hint = |hint: ide::Hint| {
        Some(lsp::InlayHint {
            position: texts.range(&path, &(hint.offset..hint.offset))?.start,
            label: hint.label.into(),
            kind: None,
            text_edits: None,
            tooltip: Some(hint.meaning.into()),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
    };
    Some(ide::hints(&texts.snapshot, &path, &range)?.into_iter().filter_map(hint).collect())
}
