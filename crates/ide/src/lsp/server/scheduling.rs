//! What is done of a text, stage after stage, while nobody changes it.

use super::{IDLE, MOTION_DELAY, Server, TICK, Task};
use crate::lsp::parent;
use crate::lsp::pool::{TaskKind, caught};
use crate::lsp::published::{StageResult, PublishedDiagnostics};
use crate::{self as ide, DiagnosticStage, Snapshot};
use mechc_text::cancel::Cancel;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

impl Server {
    /// A file's text is another one: what was begun for the old snapshot ends, and all open texts that this concerns are looked at.
    pub(super) fn replace(&mut self, path: &Arc<Path>) {
        self.end_work();
        self.edited = Some(Arc::clone(path));
        let text = self.documents.get(path).map(|document| Arc::clone(document.text()));
        let before = self.snapshot.clone();
        self.snapshot = self.snapshot.with_text(path, text);
        self.revision += 1;
        self.views.turn_to(self.snapshot.buffers().clone());
        // the edited text first
        let others: Vec<Arc<Path>> = self.documents.paths().filter(|other| *other != path).cloned().collect();
        for path in std::iter::once(path).chain(&others) {
            let is_same = self.snapshot.is_same(&before, path);
            if let Some(shown) = self.shown.get_mut(path).filter(|shown| !is_same || shown.next().is_some()) {
                shown.begin_again();
                self.look(path);
            }
        }
    }

    /// Ends what is being done for the snapshot.
    pub(super) fn end_work(&mut self) {
        self.snapshot.cancel();
        self.motions.drain(..).for_each(|(cancel, _)| cancel.cancel());
        self.due.clear();
    }

    /// Begins the next stage of a text.
    pub(super) fn look(&mut self, path: &Arc<Path>) {
        match self.shown.get(path).and_then(PublishedDiagnostics::next) {
            Some(DiagnosticStage::Motion) => self.due.push((Arc::clone(path), Instant::now() + MOTION_DELAY)),
            Some(stage) => self.begin_stage(path, stage),
            None => {}
        }
    }

    fn begin_stage(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let (path, revision, snapshot) = (Arc::clone(path), self.revision, self.snapshot.clone());
        let done = self.done.clone();
        let work = move || {
            let begin = Instant::now();
            let motion = || {
                let cancel = Cancel::default();
                let _ = done.send(Task::Began(revision, cancel.clone()));
                cancel
            };
            let found = caught(|| found(&snapshot, &path, stage, &motion));
            let _ = done.send(Task::StageResult { path, revision, stage, found, took: begin.elapsed() });
        };
        let kind = match stage {
            DiagnosticStage::Words => TaskKind::Words,
            DiagnosticStage::Proof => TaskKind::Proof,
            DiagnosticStage::Motion => TaskKind::Motion,
        };
        self.pool.begin(kind, work);
    }

    /// How long nothing need be done if nobody says anything.
    pub(super) fn patience(&self) -> Duration {
        let now = Instant::now();
        let next = self.due.iter().map(|(_, from)| from.saturating_duration_since(now)).min();
        let next = next.unwrap_or(IDLE).min(if self.motions.is_empty() { IDLE } else { TICK });
        if self.parent.is_some() { next.min(parent::TICK) } else { next }
    }

    pub(super) fn begin_due_motions(&mut self) {
        let now = Instant::now();
        let due: Vec<_> = self.due.extract_if(.., |(_, from)| *from <= now).collect();
        for (path, _) in due {
            self.begin_stage(&path, DiagnosticStage::Motion);
        }
    }

    pub(super) fn end_long_motions(&mut self) {
        let now = Instant::now();
        self.motions.iter().filter(|(_, end)| *end < now).for_each(|(cancel, _)| cancel.cancel());
        self.motions.retain(|(cancel, _)| !cancel.is_cancelled());
    }
}

/// What a stage finds of a text; nothing where it was cancelled.
fn found(snapshot: &Snapshot, path: &Path, stage: DiagnosticStage, motion: &dyn Fn() -> Cancel) -> Option<StageResult> {
    let said = ide::diagnostics(snapshot, path, stage, motion)?;
    let goes_on = match stage {
        DiagnosticStage::Words => snapshot.may_be_proven(path)?,
        DiagnosticStage::Proof => snapshot.proven(path)?.iter().any(|proven| proven.assembly.is_some()),
        DiagnosticStage::Motion => false,
    };
    Some(StageResult { said, goes_on })
}
