//! Code lenses.

use crate::lsp::convert::Texts;
use crate::{self as ide, LensKind};
use gen_lsp_types as lsp;
use serde_json::json;

/// A result has no command, and its title stands alone; to run and to check is for clients that say that they can.
pub(super) fn lenses(texts: &Texts, params: &lsp::CodeLensParams) -> Option<Vec<lsp::CodeLens>> {
    let uri = &params.text_document.uri;
    let path = texts.path(uri);
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
        let is_for_all = command.is_empty();
        let can = if command == "mechc.view" { texts.client.can_view } else { texts.client.can_run };
        if !is_for_all && !can {
            return None;
        }
        let command = lsp::Command { title, tooltip: None, command, arguments };
        Some(lsp::CodeLens { range: texts.range(&path, &lens.range)?, command: Some(command), data: None })
    };
    Some(ide::lenses(&texts.snapshot, &path)?.into_iter().filter_map(lens).collect())
}
