//! Edits on behalf of live pages: `workspace/applyEdit` requests to the client, and its responses.

use super::capabilities::Ability;
use super::live_pages::{PendingWrite, difference};
use super::server::Server;
use lsp_server::Response;
use serde_json::json;

/// The byte-order mark, which positions of the client do not count.
const BYTE_ORDER_MARK: char = '\u{feff}';

impl Server {
    /// Asks the client to change the text of a file, unless the text differs from the one that the page shows.
    pub(super) fn apply_edit(&mut self, write: PendingWrite) {
        let PendingWrite { path, before, text, outcome } = write;
        let [before, text] = [&before, &text].map(|text| text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text));
        let Some(document) = self.text_of(&path).filter(|document| **document.text() == *before) else {
            // the page may have stopped waiting
            let _ = outcome.send(Ok(false));
            return;
        };
        let (range, new) = difference(document.text(), text);
        let [start, end] = [range.start, range.end].map(|at| self.position_json(&document, at));
        let edit = json!({ "range": { "start": start, "end": end }, "newText": new });
        let uri = document.uri.clone();
        let version = self.documents.get(&path).map(|document| document.version);
        let edit = match version.filter(|_| self.client.can(Ability::VersionedEdits)) {
            Some(version) => {
                let document = json!({ "uri": uri, "version": version });
                json!({ "documentChanges": [{ "textDocument": document, "edits": [edit] }] })
            }
            // a text that is not open has no version
            None => json!({ "changes": { uri: [edit] } }),
        };
        let id = self.send_request("workspace/applyEdit", json!({ "label": "mechc view", "edit": edit }));
        self.edits.insert(id, outcome);
    }

    /// Handles the client's response to an edit.
    pub(super) fn finish_edit(&mut self, response: Response) {
        let Some(outcome) = self.edits.remove(&response.id) else { return };
        let why = match response.response_result {
            Ok(result) if result["applied"] == true => None,
            Ok(result) => Some(result["failureReason"].as_str().unwrap_or_default().to_owned()),
            Err(error) => Some(error.message),
        };
        let refused = |why: String| {
            let why = if why.is_empty() { why } else { format!(": {why}") };
            format!("nothing was written, for the editor did not take the edit{why}")
        };
        let _ = outcome.send(why.map_or(Ok(true), |why| Err(refused(why))));
    }
}
