//! Completion.

use crate::lsp::capabilities::Ability;
use crate::lsp::convert::{ProtocolContext, markdown};
use crate::{self as ide, CompletionItemKind, Template};
use gen_lsp_types as lsp;

pub(super) fn completion(context: &ProtocolContext, params: &lsp::CompletionParams) -> Option<lsp::CompletionResponse> {
    let position = context.position(&params.text_document_position_params)?;
    let ide::Completions { items, is_incomplete } = ide::completions(&context.snapshot, &position)?;
    // all items replace the same range
    let range = context.range(&position.path, &items.first().map_or(0..0, |item| item.replaces.clone()))?;
    let items = items.into_iter().enumerate().map(|(number, item)| item_of(context, number, item, range));
    let items: Vec<lsp::CompletionItem> = items.collect();
    Some(if is_incomplete {
        // the client requests the list again for other letters
        lsp::CompletionList { is_incomplete, items, ..lsp::CompletionList::default() }.into()
    } else {
        items.into()
    })
}

fn item_of(
    context: &ProtocolContext,
    number: usize,
    item: ide::CompletionItem,
    range: lsp::Range,
) -> lsp::CompletionItem {
    let has_snippets = context.client.can(Ability::Snippets);
    let is_snippet = has_snippets && !item.insert.holes.is_empty();
    let new_text = match has_snippets {
        true if is_snippet => snippet(&item.insert),
        true => item.insert.text.clone(),
        false => item.insert.up_to_first_hole().to_owned(),
    };
    let or_none = |text: String| (!text.is_empty()).then_some(text);
    let format = if is_snippet { lsp::InsertTextFormat::Snippet } else { lsp::InsertTextFormat::PlainText };
    lsp::CompletionItem {
        kind: Some(kind(item.kind)),
        label_details: or_none(item.signature)
            .map(|signature| lsp::CompletionItemLabelDetails { detail: Some(signature), description: None }),
        detail: or_none(item.detail),
        documentation: or_none(item.docs).map(|docs| markdown(docs).into()),
        preselect: (item.rank == 0).then_some(true),
        sort_text: Some(format!("{number:05}")),
        filter_text: Some(item.label.clone()),
        insert_text_format: Some(format),
        text_edit: Some(lsp::TextEdit { range, new_text }.into()),
        label: item.label,
        ..lsp::CompletionItem::default()
    }
}

/// Converts a template to a snippet of the protocol.
fn snippet(template: &Template) -> String {
    let plain = |text: &str| text.replace('\\', "\\\\").replace('$', "\\$").replace('}', "\\}");
    let (mut snippet, mut end) = (String::new(), 0);
    for (number, hole) in template.holes.iter().enumerate() {
        let [before, inside] =
            [end..hole.start, hole.clone()].map(|range| plain(template.text.get(range).unwrap_or_default()));
        snippet += &format!("{before}${{{}:{inside}}}", number + 1);
        end = hole.end;
    }
    snippet + &plain(template.text.get(end..).unwrap_or_default())
}

fn kind(kind: CompletionItemKind) -> lsp::CompletionItemKind {
    match kind {
        CompletionItemKind::Keyword => lsp::CompletionItemKind::Keyword,
        CompletionItemKind::Declaration => lsp::CompletionItemKind::Snippet,
        CompletionItemKind::Function => lsp::CompletionItemKind::Function,
        CompletionItemKind::Joint => lsp::CompletionItemKind::Constructor,
        CompletionItemKind::Unit => lsp::CompletionItemKind::Unit,
        CompletionItemKind::Constant => lsp::CompletionItemKind::Constant,
        CompletionItemKind::Value => lsp::CompletionItemKind::Variable,
        CompletionItemKind::Body => lsp::CompletionItemKind::Class,
        CompletionItemKind::Feature => lsp::CompletionItemKind::Field,
        CompletionItemKind::DeclaredJoint => lsp::CompletionItemKind::Interface,
        CompletionItemKind::Mechanism => lsp::CompletionItemKind::Module,
        CompletionItemKind::File => lsp::CompletionItemKind::File,
        CompletionItemKind::Folder => lsp::CompletionItemKind::Folder,
    }
}

#[cfg(test)]
mod tests {
    use super::snippet;
    use crate::Template;

    #[test]
    fn special_characters_of_snippets_are_escaped() {
        let template = Template::from_marked("body «a$b» {\n    «»\n}");
        assert_eq!(snippet(&template), "body ${1:a\\$b} {\n    ${2:}\n\\}");
    }
}
