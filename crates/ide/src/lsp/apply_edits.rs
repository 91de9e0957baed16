//! Texts that pages write: edits that the client is asked for, each of the version of the text that it has, and what it says to that.

use super::capabilities::Ability;
use super::server::Server;
use super::live_pages::{PendingWrite, difference};
use lsp_server::Response;
use serde_json::json;

/// A byte-order mark, which stands before a file: the client's places do not count it.
const MARK: char = '\u{feff}';

impl Server {
    /// Has the client change what differs between a text and another one, unless it has another one by now.
    pub(super) fn write(&mut self, writing: PendingWrite) {
        let PendingWrite { path, before, text, done } = writing;
        let [before, text] = [&before, &text].map(|text| text.strip_prefix(MARK).unwrap_or(text));
        let Some(document) = self.text_of(&path).filter(|document| **document.text() == *before) else {
            // who does not wait any more need not be told
            let _ = done.send(Ok(false));
            return;
        };
        let (range, new) = difference(document.text(), text);
        let [start, end] = [range.start, range.end].map(|at| self.range_end(&document, at));
        let edit = json!({ "range": { "start": start, "end": end }, "newText": new });
        let uri = document.uri.clone();
        let version = self.documents.get(&path).map(|document| document.version);
        let edit = match version.filter(|_| self.client.can(Ability::VersionedEdits)) {
            Some(version) => {
                let of = json!({ "uri": uri, "version": version });
                json!({ "documentChanges": [{ "textDocument": of, "edits": [edit] }] })
            }
            // a text that it does not have open has no version
            None => json!({ "changes": { uri: [edit] } }),
        };
        let id = self.ask_with("workspace/applyEdit", json!({ "label": "mechc view", "edit": edit }));
        self.edits.insert(id, done);
    }

    /// The client has answered; of an edit that is told to who waits for it.
    pub(super) fn edited(&mut self, response: Response) {
        let Some(done) = self.edits.remove(&response.id) else { return };
        let why = match response.response_result {
            Ok(result) if result["applied"] == true => None,
            Ok(result) => Some(result["failureReason"].as_str().unwrap_or_default().to_owned()),
            Err(error) => Some(error.message),
        };
        let refused = |why: String| {
            let why = if why.is_empty() { why } else { format!(": {why}") };
            format!("nothing was written, for the editor did not take the edit{why}")
        };
        let _ = done.send(why.map_or(Ok(true), |why| Err(refused(why))));
    }
}
