//! What is said of texts: diagnostics, pushed or for those who ask, and what the client is to ask for again.

use super::{Pull, Server};
use crate::lsp::capabilities::Refreshes;
use crate::lsp::pool::{TaskKind, caught};
use crate::lsp::published::{StageResult, PublishedDiagnostics};
use crate::{self as ide, DiagnosticStage};
use lsp_server::{ErrorCode, Notification, RequestId};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

impl Server {
    /// Takes in what a stage found of a text, shows it, and begins the next one.
    pub(super) fn take(&mut self, path: &Arc<Path>, stage: DiagnosticStage, found: Result<Option<StageResult>, String>) {
        let found = found.unwrap_or_else(|why| {
            self.log.did(|| format!("{stage:?} of {} panicked: {why}", path.display()));
            None
        });
        // a motion that took too long, a file that cannot be read, a mistake of ours: of that nothing is said
        let found = found.unwrap_or(StageResult { said: Vec::new(), goes_on: false });
        let Some(shown) = self.shown.get_mut(path) else { return };
        let is_new = shown.take(stage, found);
        self.refresh(path, stage);
        if stage == DiagnosticStage::Words {
            self.answer_pulls(Some(path));
        }
        // for the words of the text that was edited it asks by itself
        let is_asked_for = stage == DiagnosticStage::Words && self.edited.as_ref() == Some(path);
        match self.client.pulls_diagnostics {
            true if is_new && !is_asked_for => self.ask("workspace/diagnostic/refresh"),
            false if is_new => self.push(path),
            _ => {}
        }
        self.look(path);
        if stage == DiagnosticStage::Words {
            self.index_names(path);
        }
    }

    /// Makes the list of a text's names, which most requests ask for, before anybody does.
    fn index_names(&self, path: &Arc<Path>) {
        let (path, snapshot) = (Arc::clone(path), self.snapshot.clone());
        self.pool.begin(TaskKind::Request, move || {
            // a mistake of ours is met again, and told, by who asks
            let _ = caught(|| ide::index_names(&snapshot, &path));
        });
    }

    /// Has the client ask again for what a stage has changed, and it would not by itself.
    fn refresh(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let Refreshes { hints, lenses, tokens } = self.client.refreshes;
        // of the text that was edited it asks for hints and tokens by itself
        let is_of_another = stage == DiagnosticStage::Words && self.edited.as_ref() != Some(path);
        let wanted = [
            (hints && is_of_another, "workspace/inlayHint/refresh"),
            (tokens && is_of_another, "workspace/semanticTokens/refresh"),
            // results are known with the motion
            (lenses && stage == DiagnosticStage::Motion, "workspace/codeLens/refresh"),
        ];
        for (_, method) in wanted.into_iter().filter(|(is_wanted, _)| *is_wanted) {
            self.ask(method);
        }
    }

    pub(super) fn pull(&mut self, id: RequestId, params: &Value) {
        let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
        let Some(uri) = uri else {
            self.refuse(id, ErrorCode::InvalidParams, "it names no text");
            return;
        };
        let path = self.file_of(uri);
        let known = params.get("previousResultId").and_then(Value::as_str).map(str::to_owned);
        let pull = Pull { id, path, known };
        match self.shown.get(&pull.path).map(PublishedDiagnostics::next) {
            // until its words are known
            Some(Some(DiagnosticStage::Words)) => self.pulls.push(pull),
            _ => self.answer_pull(pull),
        }
    }

    /// Answers those who wait for the words of a text, or of all.
    pub(super) fn answer_pulls(&mut self, path: Option<&Path>) {
        let is_it = |pull: &mut Pull| path.is_none_or(|path| *pull.path == *path);
        let answered: Vec<Pull> = self.pulls.extract_if(.., is_it).collect();
        for pull in answered {
            self.answer_pull(pull);
        }
    }

    fn answer_pull(&self, pull: Pull) {
        let Some(shown) = self.shown.get(&pull.path) else {
            self.answer(pull.id, json!({ "kind": "full", "items": [] }));
            return;
        };
        let version = shown.version();
        let report = if pull.known.as_ref() == Some(&version) {
            json!({ "kind": "unchanged", "resultId": version })
        } else {
            json!({ "kind": "full", "resultId": version, "items": self.diagnostics(&pull.path) })
        };
        self.answer(pull.id, report);
    }

    fn diagnostics(&self, path: &Path) -> Vec<Value> {
        let context = self.context();
        let said = self.shown.get(path).map(PublishedDiagnostics::all).unwrap_or_default();
        let said = said.iter().filter_map(|said| context.diagnostic(path, said));
        said.filter_map(|said| serde_json::to_value(said).ok()).collect()
    }

    fn push(&self, path: &Path) {
        if let Some(document) = self.documents.get(path) {
            self.tell(&document.uri, json!(document.version), &self.diagnostics(path));
        }
    }

    pub(super) fn tell(&self, uri: &str, version: Value, diagnostics: &[Value]) {
        let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
        if !version.is_null() {
            params["version"] = version;
        }
        self.send(Notification { method: "textDocument/publishDiagnostics".to_owned(), params });
    }
}
