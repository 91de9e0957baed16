//! Signature help.

use crate as ide;
use crate::lsp::convert::{ProtocolContext, markdown};
use gen_lsp_types as lsp;
use mechc_text::source::Encoding;

pub(super) fn signatures(context: &ProtocolContext, params: &lsp::SignatureHelpParams) -> Option<lsp::SignatureHelp> {
    let position = context.position(&params.text_document_position_params)?;
    let found = ide::signatures(&context.snapshot, &position)?;
    let signatures = found.forms.into_iter().map(signature).collect();
    let argument = found.argument.map(|argument| (argument as u32).into());
    Some(lsp::SignatureHelp { signatures, active_signature: Some(found.active as u32), active_parameter: argument })
}

/// Converts a signature. Ranges in labels are in UTF-16, whatever encoding the client uses for texts.
fn signature(form: ide::Signature) -> lsp::SignatureInformation {
    let at = |byte: usize| Encoding::Utf16.length(&form.label[..byte]) as u32;
    let argument = |range: &std::ops::Range<usize>| lsp::ParameterInformation {
        label: lsp::ParameterInformationLabel::Tuple((at(range.start), at(range.end))),
        documentation: None,
    };
    lsp::SignatureInformation {
        parameters: Some(form.arguments.iter().map(argument).collect()),
        documentation: Some(markdown(form.meaning).into()),
        active_parameter: None,
        label: form.label,
    }
}
