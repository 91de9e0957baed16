//! What the client tells: texts that it opens, changes and closes, its folders and files, requests that it takes back.

use super::{Server, State, Task};
use crate as ide;
use crate::lsp::capabilities::Ability;
use crate::lsp::documents::Document;
use crate::lsp::lines::Position;
use crate::lsp::pool::{TaskKind, caught};
use crate::lsp::published::PublishedDiagnostics;
use crate::lsp::uri;
use lsp_server::{ErrorCode, Notification, RequestId};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

impl Server {
    pub(super) fn notification(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        if self.state != State::Running {
            return;
        }
        let done = match method.as_str() {
            "initialized" => {
                self.began();
                Some(())
            }
            "textDocument/didOpen" => self.opened(&params),
            "textDocument/didChange" => self.changed(&params),
            "textDocument/didClose" => self.closed(&params),
            "workspace/didChangeWorkspaceFolders" => {
                self.changed_folders(&params);
                Some(())
            }
            "workspace/didChangeWatchedFiles" => self.changed_behind(&params),
            "$/cancelRequest" => self.cancelled(&params),
            "mechc/cursor" => self.pointed(&params),
            "mechc/view/close" => self.left(&params),
            _ => Some(()),
        };
        if done.is_none() {
            self.log.did(|| format!("`{method}` is not as the protocol says: {params}"));
        }
    }

    fn opened(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let (uri, text) = (given.get("uri")?.as_str()?, given.get("text")?.as_str()?);
        let version = version_of(given);
        let path = self.file_of(uri);
        let mut document = Document::new(uri.to_owned(), version, text);
        if let Some(open) = self.documents.get(&path) {
            // what is shown of it is still shown
            document = Document::clone(open);
            (document.uri, document.version) = (uri.to_owned(), version);
            self.edit(&path, &mut document, None, text);
        }
        self.documents.set(Arc::clone(&path), document);
        let opening = self.revision;
        self.shown.entry(Arc::clone(&path)).or_insert_with(|| PublishedDiagnostics::of_opening(opening));
        self.replace(&path);
        Some(())
    }

    fn changed(&mut self, params: &Value) -> Option<()> {
        let given = params.get("textDocument")?;
        let path = self.file_of(given.get("uri")?.as_str()?);
        let mut document = Document::clone(self.documents.get(&path)?);
        document.version = version_of(given);
        let changes = params.get("contentChanges")?.as_array()?;
        // all of them or none
        for (range, text) in changes.iter().map(change).collect::<Option<Vec<_>>>()? {
            self.edit(&path, &mut document, range, text);
        }
        self.documents.set(Arc::clone(&path), document);
        self.replace(&path);
        Some(())
    }

    /// Edits a text, and moves along what is shown of it.
    fn edit(&mut self, path: &Path, document: &mut Document, range: Option<[Position; 2]>, text: &str) {
        let moved = document.edit(range, text, self.client.encoding);
        for (other, shown) in &mut self.shown {
            if **other == *path {
                shown.edit(path, &moved);
            } else {
                shown.edit_elsewhere(path, &moved);
            }
        }
    }

    fn closed(&mut self, params: &Value) -> Option<()> {
        let uri = params.get("textDocument")?.get("uri")?.as_str()?;
        let path = self.documents.close(uri)?;
        self.shown.remove(&path)?;
        self.answer_pulls(Some(&path));
        if !self.client.pulls_diagnostics {
            self.tell(uri, Value::Null, &[]);
        }
        self.replace(&path);
        Some(())
    }

    /// The session has begun: the files of the client's folders are looked for.
    fn began(&mut self) {
        if self.client.can(Ability::WatchedFiles) {
            let watchers = json!([{ "globPattern": "**/*.mech" }, { "globPattern": "**/*.csv" }]);
            let method = "workspace/didChangeWatchedFiles";
            let registration = json!({ "id": "files", "method": method, "registerOptions": { "watchers": watchers } });
            self.ask_with("client/registerCapability", json!({ "registrations": [registration] }));
        }
        self.look_for_files();
    }

    fn look_for_files(&mut self) {
        let (folders, world, done) = (self.folders.clone(), Arc::clone(self.snapshot.buffers()), self.done.clone());
        std::mem::take(&mut self.search).cancel();
        let cancel = self.search.clone();
        self.pool.begin(TaskKind::Files, move || {
            let files = caught(|| ide::files_in(&folders, &*world, &cancel)).unwrap_or_default();
            if !cancel.is_cancelled() {
                let _ = done.send(Task::Files(files));
            }
        });
    }

    fn changed_folders(&mut self, params: &Value) {
        let paths = |name: &str| {
            let list = params.pointer(&format!("/event/{name}")).and_then(Value::as_array);
            let uris = list.into_iter().flatten().filter_map(|folder| folder.get("uri")?.as_str());
            uris.map(uri::path_of).collect::<Vec<_>>()
        };
        let removed = paths("removed");
        self.folders.retain(|folder| !removed.contains(folder));
        self.folders.extend(paths("added"));
        self.look_for_files();
    }

    /// Files on the disk are others, or gone, or new.
    fn changed_behind(&mut self, params: &Value) -> Option<()> {
        for change in params.get("changes")?.as_array()? {
            let path = self.file_of(change.get("uri")?.as_str()?);
            if self.documents.get(&path).is_none() {
                self.replace(&path);
            }
        }
        Some(())
    }

    fn cancelled(&mut self, params: &Value) -> Option<()> {
        let id: RequestId = serde_json::from_value(params.get("id")?.clone()).ok()?;
        let pull = self.pulls.iter().position(|pull| pull.id == id);
        let is_pending = self.pending.remove(&id).is_some() || pull.map(|at| self.pulls.remove(at)).is_some();
        if is_pending {
            self.refuse(id, ErrorCode::RequestCanceled, "the client cancelled it");
        }
        Some(())
    }
}

/// A change of a text: where, and to what.
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
