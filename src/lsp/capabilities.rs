//! What the client can do, and what the server does.

use crate::source::Encoding;
use serde_json::{Value, json};

/// What the client can do, as far as it matters here. What it does not say it cannot.
#[derive(Clone, Debug)]
pub(super) struct Client {
    /// What columns count.
    pub encoding: Encoding,
    /// Whether it asks for diagnostics, and can be told to ask again; else it is told them.
    pub pulls_diagnostics: bool,
}

impl Client {
    /// By the params of `initialize`.
    pub fn of(params: &Value) -> Client {
        let is =
            |path: &str| params.pointer(path).is_some_and(|value| value != &Value::Bool(false) && !value.is_null());
        let encodings = params.pointer("/capabilities/general/positionEncodings").and_then(Value::as_array);
        let offers = |name: &str| encodings.is_some_and(|list| list.iter().any(|offered| offered == name));
        Client {
            encoding: if offers("utf-8") { Encoding::Utf8 } else { Encoding::Utf16 },
            pulls_diagnostics: is("/capabilities/textDocument/diagnostic")
                && is("/capabilities/workspace/diagnostics/refreshSupport"),
        }
    }
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
        "hoverProvider": true,
        "documentSymbolProvider": true,
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
    use crate::source::Encoding;
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
