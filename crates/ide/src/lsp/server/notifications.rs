//! Notifications of the client: texts that it opens, edits and closes, changes of folders and files, cancelled requests.

use super::{Server, State, Task};
use crate as ide;
use crate::lsp::capabilities::Ability;
use crate::lsp::documents::Document;
use crate::lsp::lines::Position;
use crate::lsp::pool::{TaskKind, catch_panic};
use crate::lsp::published::PublishedDiagnostics;
use crate::lsp::uri;
use lsp_server::{ErrorCode, Notification, RequestId};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

impl Server {
    pub(super) fn handle_notification(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        if self.state != State::Running {
            return;
        }
        let done = match method.as_str() {
            "initialized" => {
                self.initialized();
                Some(())
            }
            "textDocument/didOpen" => self.text_opened(&params),
            "textDocument/didChange" => self.text_changed(&params),
            "textDocument/didClose" => self.text_closed(&params),
            "workspace/didChangeWorkspaceFolders" => {
                self.folders_changed(&params);
                Some(())
            }
            "workspace/didChangeWatchedFiles" => self.files_changed(&params),
            "$/cancelRequest" => self.cancel_request(&params),
            "mechc/cursor" => self.cursor_moved(&params),
            "mechc/view/close" => self.panel_closed(&params),
            _ => Some(()),
        };
        if done.is_none() {
            self.log.action(|| format!("`{method}` is not as the protocol says: {params}"));
        }
    }

    fn text_opened(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let (uri, text) = (given.get("uri")?.as_str()?, given.get("text")?.as_str()?);
        let version = version_of(given);
        let path = self.file_of(uri);
        let mut document = Document::new(uri.to_owned(), version, text);
        if let Some(open) = self.documents.get(&path) {
            // published diagnostics of an open text stay
            document = Document::clone(open);
            (document.uri, document.version) = (uri.to_owned(), version);
            self.edit(&path, &mut document, None, text);
        }
        self.documents.set(Arc::clone(&path), document);
        let opening = self.revision;
        self.published.entry(Arc::clone(&path)).or_insert_with(|| PublishedDiagnostics::new(opening));
        self.replace(&path);
        Some(())
    }

    fn text_changed(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let path = self.file_of(given.get("uri")?.as_str()?);
        let mut document = Document::clone(self.documents.get(&path)?);
        document.version = version_of(given);
        let changes = params.get("contentChanges")?.as_array()?;
        // a malformed change rejects all of them
        for (range, text) in changes.iter().map(change).collect::<Option<Vec<_>>>()? {
            self.edit(&path, &mut document, range, text);
        }
        self.documents.set(Arc::clone(&path), document);
        self.replace(&path);
        Some(())
    }

    /// Edits a text and shifts the published diagnostics.
    fn edit(&mut self, path: &Path, document: &mut Document, range: Option<[Position; 2]>, text: &str) {
        let splice = document.edit(range, text, self.client.encoding);
        for (other, published) in &mut self.published {
            if **other == *path {
                published.edit(path, &splice);
            } else {
                published.edit_elsewhere(path, &splice);
            }
        }
    }

    fn text_closed(&mut self, params: &Value) -> Option<()> {
        let uri = params.get("textDocument")?.get("uri")?.as_str()?;
        let path = self.documents.close(uri)?;
        self.published.remove(&path)?;
        self.answer_pulls(Some(&path));
        if !self.client.pulls_diagnostics {
            self.publish(uri, Value::Null, &[]);
        }
        self.replace(&path);
        Some(())
    }

    /// Starts the session: registers for changes of files and searches the client's folders.
    fn initialized(&mut self) {
        if self.client.can(Ability::WatchedFiles) {
            let watchers = json!([{ "globPattern": "**/*.mech" }, { "globPattern": "**/*.csv" }]);
            let method = "workspace/didChangeWatchedFiles";
            let registration = json!({ "id": "files", "method": method, "registerOptions": { "watchers": watchers } });
            self.send_request("client/registerCapability", json!({ "registrations": [registration] }));
        }
        self.search_files();
    }

    fn search_files(&mut self) {
        let (folders, world) = (self.folders.clone(), Arc::clone(self.snapshot.buffers()));
        let task_sender = self.task_sender.clone();
        std::mem::take(&mut self.search).cancel();
        let cancel = self.search.clone();
        self.pool.start(TaskKind::Files, move || {
            let files = catch_panic(|| ide::files_in(&folders, &*world, &cancel)).unwrap_or_default();
            if !cancel.is_cancelled() {
                let _ = task_sender.send(Task::Files(files));
            }
        });
    }

    fn folders_changed(&mut self, params: &Value) {
        let paths = |name: &str| {
            let list = params.pointer(&format!("/event/{name}")).and_then(Value::as_array);
            let uris = list.into_iter().flatten().filter_map(|folder| folder.get("uri")?.as_str());
            uris.map(uri::path_of).collect::<Vec<_>>()
        };
        let removed = paths("removed");
        self.folders.retain(|folder| !removed.contains(folder));
        self.folders.extend(paths("added"));
        self.search_files();
    }

    /// Handles changes of files on disk.
    fn files_changed(&mut self, params: &Value) -> Option<()> {
        for change in params.get("changes")?.as_array()? {
            let path = self.file_of(change.get("uri")?.as_str()?);
            if self.documents.get(&path).is_none() {
                self.replace(&path);
            }
        }
        Some(())
    }

    fn cancel_request(&mut self, params: &Value) -> Option<()> {
        let id: RequestId = serde_json::from_value(params.get("id")?.clone()).ok()?;
        let pull = self.pulls.iter().position(|pull| pull.id == id);
        let is_pending = self.pending.remove(&id).is_some() || pull.map(|at| self.pulls.remove(at)).is_some();
        if is_pending {
            self.refuse(id, ErrorCode::RequestCanceled, "the client cancelled it");
        }
        Some(())
    }
}

/// Parses a change of a text: its range, or `None` for the whole text, and the new text.
fn change(given: &Value) -> Option<(Option<[Position; 2]>, &str)> {
    let range = match given.get("range").filter(|range| !range.is_null()) {
        None => None,
        Some(range) => Some([position(range.get("start")?)?, position(range.get("end")?)?]),
    };
    Some((range, given.get("text")?.as_str()?))
}

fn version_of(document: &Value) -> i32 {
    document.get("version").and_then(Value::as_i64).and_then(|version| version.try_into().ok()).unwrap_or_default()
}

pub(super) fn position(given: &Value) -> Option<Position> {
    let number = |name: &str| given.get(name)?.as_u64().map(|number| number.min(u64::from(u32::MAX)) as u32);
    Some((number("line")?, number("character")?))
}
