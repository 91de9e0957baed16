//! What the client can do, and what the server does.

use super::handlers::tokens::{MODIFIERS, types};
use mechc_text::source::Encoding;
use serde_json::{Value, json};
use std::path::PathBuf;

/// What the client can do, as far as it matters here. What it does not say it cannot.
#[derive(Clone, Debug)]
pub(super) struct Client {
    /// What columns count.
    pub encoding: Encoding,
    /// Whether it asks for diagnostics, and can be told to ask again; else it is told them.
    pub pulls_diagnostics: bool,
    /// What else.
    abilities: Vec<Ability>,
    /// Whether it has the commands `mechc.run` and `mechc.check`, each called with a URI and the name of a mechanism.
    pub can_run: bool,
    /// Whether it has the command that shows a page.
    pub can_view: bool,
    /// What it can be told to ask for again.
    pub refreshes: Refreshes,
}

/// What a client can be told to ask for again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refreshes {
    pub hints: bool,
    pub lenses: bool,
    pub tokens: bool,
}

/// What a client may be able to do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Ability {
    /// It folds whole lines alone.
    LineFolding,
    /// It shows from where a name leads to its declaration.
    Links,
    /// What is completed may have places to fill in.
    Snippets,
    /// It can be asked to tell which files have changed.
    WatchedFiles,
    /// An edit may say of which version of a text it is.
    VersionedEdits,
}

/// Where a client says it.
const ABILITIES: &[(Ability, &str)] = &[
    (Ability::LineFolding, "/capabilities/textDocument/foldingRange/lineFoldingOnly"),
    (Ability::Links, "/capabilities/textDocument/definition/linkSupport"),
    (Ability::Snippets, "/capabilities/textDocument/completion/completionItem/snippetSupport"),
    (Ability::WatchedFiles, "/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration"),
    (Ability::VersionedEdits, "/capabilities/workspace/workspaceEdit/documentChanges"),
];

impl Client {
    /// By the params of `initialize`.
    pub fn of(params: &Value) -> Client {
        let is =
            |path: &str| params.pointer(path).is_some_and(|value| value != &Value::Bool(false) && !value.is_null());
        let encodings = params.pointer("/capabilities/general/positionEncodings").and_then(Value::as_array);
        let offers = |name: &str| encodings.is_some_and(|list| list.iter().any(|offered| offered == name));
        // its own commands a client tells as it likes: as an option, or as rust-analyzer's do
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

    /// Whether it can do something.
    pub fn can(&self, ability: Ability) -> bool {
        self.abilities.contains(&ability)
    }
}

/// The folders that the client has open, by the params of `initialize`.
pub(super) fn folders(params: &Value) -> Vec<PathBuf> {
    let listed = params.get("workspaceFolders").and_then(Value::as_array).filter(|list| !list.is_empty());
    let uris: Vec<&str> = match listed {
        Some(list) => list.iter().filter_map(|folder| folder.get("uri")?.as_str()).collect(),
        None => params.get("rootUri").and_then(Value::as_str).into_iter().collect(),
    };
    uris.into_iter().map(super::uri::path_of).collect()
}

/// The answer to `initialize`.
pub(super) fn of_server(client: &Client) -> Value {
    let encoding = match client.encoding {
        Encoding::Utf8 => "utf-8",
        Encoding::Utf16 => "utf-16",
        Encoding::Characters => "utf-32",
    };
    let mut capabilities = json!({
        "positionEncoding": encoding,
        // incremental
        "textDocumentSync": { "openClose": true, "change": 2 },
        "codeActionProvider": {
            "codeActionKinds": ["quickfix", "refactor.extract", "refactor.rewrite", "source.fixAll"],
        },
        "codeLensProvider": {},
        // not a space: a list at every one would be in the way
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
            "legend": { "tokenTypes": types(), "tokenModifiers": MODIFIERS },
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

#[cfg(test)]
mod tests {
    use super::Client;
    use mechc_text::source::Encoding;
    use serde_json::json;

    #[test]
    fn utf_8_is_taken_where_it_is_offered() {
        let of = |encodings: serde_json::Value| {
            Client::of(&json!({ "capabilities": { "general": { "positionEncodings": encodings } } })).encoding
        };
        assert_eq!(of(json!(["utf-16", "utf-8"])), Encoding::Utf8);
        assert_eq!(of(json!(["utf-32"])), Encoding::Utf16);
        assert_eq!(Client::of(&json!(null)).encoding, Encoding::Utf16);
    }
}
