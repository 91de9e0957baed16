//! The capabilities of the client and of the server.

use crate::TokenKind;
use mechc_text::source::Encoding;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The capabilities of the client, as far as the server uses them.
#[derive(Clone, Debug)]
pub(super) struct Client {
    /// The unit of columns.
    pub encoding: Encoding,
    /// True if it requests diagnostics and supports refreshes; otherwise the server pushes them.
    pub pulls_diagnostics: bool,
    /// Further capabilities.
    abilities: Vec<Ability>,
    /// True if it has the commands `mechc.run` and `mechc.check`, which take a URI and the name of a mechanism.
    pub can_run: bool,
    /// True if it has the command that shows a page.
    pub can_view: bool,
    /// The features that it can be asked to refresh.
    pub refreshes: Refreshes,
}

/// The features that a client can be asked to refresh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refreshes {
    pub hints: bool,
    pub lenses: bool,
    pub tokens: bool,
}

/// A capability that a client may have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Ability {
    /// Folding of whole lines only.
    LineFolding,
    /// Location links, which also hold the range of the name.
    Links,
    /// Snippets in completions.
    Snippets,
    /// Notifications of changed files.
    WatchedFiles,
    /// Edits with the version of a text.
    VersionedEdits,
}

/// The paths of abilities in the params of `initialize`.
const ABILITIES: &[(Ability, &str)] = &[
    (Ability::LineFolding, "/capabilities/textDocument/foldingRange/lineFoldingOnly"),
    (Ability::Links, "/capabilities/textDocument/definition/linkSupport"),
    (Ability::Snippets, "/capabilities/textDocument/completion/completionItem/snippetSupport"),
    (Ability::WatchedFiles, "/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration"),
    (Ability::VersionedEdits, "/capabilities/workspace/workspaceEdit/documentChanges"),
];

impl Client {
    /// Reads the capabilities from the params of `initialize`.
    pub fn from_params(params: &Value) -> Client {
        let is =
            |path: &str| params.pointer(path).is_some_and(|value| value != &Value::Bool(false) && !value.is_null());
        let encodings = params.pointer("/capabilities/general/positionEncodings").and_then(Value::as_array);
        let offers = |name: &str| encodings.is_some_and(|list| list.iter().any(|offered| offered == name));
        // commands of clients are not in the protocol: they are given as an option, or as for rust-analyzer
        let lists = ["/initializationOptions/commands", "/capabilities/experimental/commands/commands"];
        let commands: Vec<&Value> =
            lists.iter().filter_map(|list| params.pointer(list)?.as_array()).flatten().collect();
        let has_command = |name: &str| commands.iter().any(|command| *command == name);
        Client {
            encoding: if offers("utf-8") { Encoding::Utf8 } else { Encoding::Utf16 },
            pulls_diagnostics: is("/capabilities/textDocument/diagnostic")
                && is("/capabilities/workspace/diagnostics/refreshSupport"),
            abilities: ABILITIES.iter().filter(|(_, path)| is(path)).map(|(ability, _)| *ability).collect(),
            can_view: has_command("mechc.view"),
            can_run: has_command("mechc.run") && has_command("mechc.check"),
            refreshes: Refreshes {
                hints: is("/capabilities/workspace/inlayHint/refreshSupport"),
                lenses: is("/capabilities/workspace/codeLens/refreshSupport"),
                tokens: is("/capabilities/workspace/semanticTokens/refreshSupport"),
            },
        }
    }

    /// Returns whether the client has an ability.
    pub fn can(&self, ability: Ability) -> bool {
        self.abilities.contains(&ability)
    }
}

/// Returns the folders that the client has open, from the params of `initialize`.
pub(super) fn folders(params: &Value) -> Vec<PathBuf> {
    let listed = params.get("workspaceFolders").and_then(Value::as_array).filter(|list| !list.is_empty());
    let uris: Vec<&str> = match listed {
        Some(list) => list.iter().filter_map(|folder| folder.get("uri")?.as_str()).collect(),
        None => params.get("rootUri").and_then(Value::as_str).into_iter().collect(),
    };
    uris.into_iter().map(super::uri::path_of).collect()
}

/// Returns the response to `initialize`.
pub(super) fn initialize_result(client: &Client) -> Value {
    let encoding = match client.encoding {
        Encoding::Utf8 => "utf-8",
        Encoding::Utf16 => "utf-16",
        Encoding::Characters => "utf-32",
    };
    let mut capabilities = json!({
        "positionEncoding": encoding,
        // 2: incremental
        "textDocumentSync": { "openClose": true, "change": 2 },
        "codeActionProvider": {
            "codeActionKinds": ["quickfix", "refactor.extract", "refactor.rewrite", "source.fixAll"],
        },
        "codeLensProvider": {},
        // no space: a list after every one would be in the way
        "completionProvider": { "triggerCharacters": [".", "(", ",", "\"", "/"] },
        "definitionProvider": true,
        "documentFormattingProvider": true,
        "documentHighlightProvider": true,
        "documentLinkProvider": {},
        "documentOnTypeFormattingProvider": { "firstTriggerCharacter": "}" },
        "documentRangeFormattingProvider": true,
        "documentSymbolProvider": true,
        "foldingRangeProvider": true,
        "hoverProvider": true,
        "inlayHintProvider": true,
        "referencesProvider": true,
        "renameProvider": { "prepareProvider": true },
        "selectionRangeProvider": true,
        "semanticTokensProvider": {
            "legend": { "tokenTypes": token_types(), "tokenModifiers": TOKEN_MODIFIERS },
            "full": true,
            "range": true,
        },
        "signatureHelpProvider": { "triggerCharacters": ["(", ","], "retriggerCharacters": [")"] },
        "workspace": { "workspaceFolders": { "supported": true, "changeNotifications": true } },
        "workspaceSymbolProvider": true,
    });
    if client.pulls_diagnostics {
        capabilities["diagnosticProvider"] =
            json!({ "identifier": "mechc", "interFileDependencies": true, "workspaceDiagnostics": false });
    }
    json!({ "capabilities": capabilities, "serverInfo": { "name": "mechc", "version": env!("CARGO_PKG_VERSION") } })
}

/// Returns the types of the legend.
fn token_types() -> Vec<&'static str> {
    TOKEN_TYPES.iter().map(|(_, name)| *name).collect()
}

/// The modifiers of the legend, in the order of their bits.
const TOKEN_MODIFIERS: [&str; 3] = ["declaration", "readonly", "defaultLibrary"];

/// The protocol's types of tokens for the kinds of names and words, in the order of the legend.
pub(super) const TOKEN_TYPES: &[(TokenKind, &str)] = &[
    (TokenKind::Mechanism, "class"),
    (TokenKind::Part, "namespace"),
    (TokenKind::Body, "struct"),
    (TokenKind::Feature, "property"),
    (TokenKind::Equation, "event"),
    (TokenKind::Function, "function"),
    (TokenKind::Argument, "parameter"),
    (TokenKind::Value, "variable"),
    (TokenKind::JointKind, "type"),
    (TokenKind::Unit, "enumMember"),
    (TokenKind::Keyword, "keyword"),
];

#[cfg(test)]
mod tests {
    use super::Client;
    use mechc_text::source::Encoding;
    use serde_json::json;

    #[test]
    fn utf_8_is_preferred() {
        let of = |encodings: serde_json::Value| {
            Client::from_params(&json!({ "capabilities": { "general": { "positionEncodings": encodings } } })).encoding
        };
        assert_eq!(of(json!(["utf-16", "utf-8"])), Encoding::Utf8);
        assert_eq!(of(json!(["utf-32"])), Encoding::Utf16);
        assert_eq!(Client::from_params(&json!(null)).encoding, Encoding::Utf16);
    }
}
