//! Publishes diagnostics, pushed or on request, and asks the client to refresh what depends on them.

use super::{Pull, Server};
use crate::lsp::capabilities::Refreshes;
use crate::lsp::pool::{TaskKind, catch_panic};
use crate::lsp::published::{PublishedDiagnostics, StageResult};
use crate::{self as ide, DiagnosticStage};
use lsp_server::{ErrorCode, Notification, RequestId};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

impl Server {
    /// Publishes the result of a stage and starts the next one.
    pub(super) fn finish_stage(
        &mut self,
        path: &Arc<Path>,
        stage: DiagnosticStage,
        result: Result<Option<StageResult>, String>,
    ) {
        let result = result.unwrap_or_else(|why| {
            self.log.action(|| format!("{stage:?} of {} panicked: {why}", path.display()));
            None
        });
        // a motion that took too long, an unreadable file and a panic have no diagnostics
        let result = result.unwrap_or(StageResult { diagnostics: Vec::new(), has_next: false });
        let Some(published) = self.published.get_mut(path) else { return };
        let is_new = published.update(stage, result);
        self.refresh(path, stage);
        if stage == DiagnosticStage::Words {
            self.answer_pulls(Some(path));
        }
        // the client requests the first stage of the text that it edits by itself
        let is_requested = stage == DiagnosticStage::Words && self.edited.as_ref() == Some(path);
        match self.client.pulls_diagnostics {
            true if is_new && !is_requested => self.send_plain_request("workspace/diagnostic/refresh"),
            false if is_new => self.push(path),
            _ => {}
        }
        self.schedule(path);
        if stage == DiagnosticStage::Words {
            self.index_names(path);
        }
    }

    /// Builds the list of a text's names ahead of the requests that need it.
    fn index_names(&self, path: &Arc<Path>) {
        let (path, snapshot) = (Arc::clone(path), self.snapshot.clone());
        self.pool.start(TaskKind::Request, move || {
            // a panic occurs again in a request, which reports it
            let _ = catch_panic(|| ide::index_names(&snapshot, &path));
        });
    }

    /// Asks the client to refresh what a stage has changed and the client does not request by itself.
    fn refresh(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let Refreshes { hints, lenses, tokens } = self.client.refreshes;
        // the client requests hints and tokens of the text that it edits by itself
        let is_other_text = stage == DiagnosticStage::Words && self.edited.as_ref() != Some(path);
        let refreshes = [
            (hints && is_other_text, "workspace/inlayHint/refresh"),
            (tokens && is_other_text, "workspace/semanticTokens/refresh"),
            // lenses show results, which come with the motion
            (lenses && stage == DiagnosticStage::Motion, "workspace/codeLens/refresh"),
        ];
        for (_, method) in refreshes.into_iter().filter(|(is_needed, _)| *is_needed) {
            self.send_plain_request(method);
        }
    }

    pub(super) fn pull(&mut self, id: RequestId, params: &Value) {
        let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
        let Some(uri) = uri else {
            self.refuse(id, ErrorCode::InvalidParams, "it names no text");
            return;
        };
        let path = self.file_of(uri);
        let client_version = params.get("previousResultId").and_then(Value::as_str).map(str::to_owned);
        let pull = Pull { id, path, client_version };
        match self.published.get(&pull.path).map(PublishedDiagnostics::next) {
            // the response waits for the first stage
            Some(Some(DiagnosticStage::Words)) => self.pulls.push(pull),
            _ => self.answer_pull(pull),
        }
    }

    /// Answers the requests that wait for the first stage of a text, or of all texts.
    pub(super) fn answer_pulls(&mut self, path: Option<&Path>) {
        let is_waiting = |pull: &mut Pull| path.is_none_or(|path| *pull.path == *path);
        let answered: Vec<Pull> = self.pulls.extract_if(.., is_waiting).collect();
        for pull in answered {
            self.answer_pull(pull);
        }
    }

    fn answer_pull(&self, pull: Pull) {
        let Some(published) = self.published.get(&pull.path) else {
            self.answer(pull.id, json!({ "kind": "full", "items": [] }));
            return;
        };
        let version = published.version();
        let report = if pull.client_version.as_ref() == Some(&version) {
            json!({ "kind": "unchanged", "resultId": version })
        } else {
            json!({ "kind": "full", "resultId": version, "items": self.diagnostics(&pull.path) })
        };
        self.answer(pull.id, report);
    }

    fn diagnostics(&self, path: &Path) -> Vec<Value> {
        let context = self.context();
        let all = self.published.get(path).map(PublishedDiagnostics::all).unwrap_or_default();
        let converted = all.iter().filter_map(|diagnostic| context.diagnostic(path, diagnostic));
        converted.filter_map(|diagnostic| serde_json::to_value(diagnostic).ok()).collect()
    }

    fn push(&self, path: &Path) {
        if let Some(document) = self.documents.get(path) {
            self.publish(&document.uri, json!(document.version), &self.diagnostics(path));
        }
    }

    pub(super) fn publish(&self, uri: &str, version: Value, diagnostics: &[Value]) {
        let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
        if !version.is_null() {
            params["version"] = version;
        }
        self.send(Notification { method: "textDocument/publishDiagnostics".to_owned(), params });
    }
}
