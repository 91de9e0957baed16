//! Scheduling of the stages of each text. An edit cancels them and starts them anew.

use super::{IDLE, MOTION_CHECK, MOTION_DELAY, Server, Task};
use crate::lsp::parent;
use crate::lsp::pool::{TaskKind, catch_panic};
use crate::lsp::published::{PublishedDiagnostics, StageResult};
use crate::{self as ide, DiagnosticStage, Snapshot};
use mechc_text::cancel::Cancel;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

impl Server {
    /// Replaces the text of a file: cancels work on the old snapshot and analyses all open texts that the file affects.
    pub(super) fn replace(&mut self, path: &Arc<Path>) {
        self.cancel_work();
        self.edited = Some(Arc::clone(path));
        let text = self.documents.get(path).map(|document| Arc::clone(document.text()));
        let before = self.snapshot.clone();
        self.snapshot = self.snapshot.with_text(path, text);
        self.revision += 1;
        self.live_pages.set_buffers(self.snapshot.buffers().clone());
        // the edited text comes first, since the user waits for it
        let others: Vec<Arc<Path>> = self.documents.paths().filter(|other| *other != path).cloned().collect();
        for path in std::iter::once(path).chain(&others) {
            let is_unaffected = self.snapshot.shares_results(&before, path);
            let published = self.published.get_mut(path);
            if let Some(published) = published.filter(|it| !is_unaffected || it.next().is_some()) {
                published.restart();
                self.schedule(path);
            }
        }
    }

    /// Cancels all work on the snapshot.
    pub(super) fn cancel_work(&mut self) {
        self.snapshot.cancel();
        self.motions.drain(..).for_each(|(cancel, _)| cancel.cancel());
        self.due_motions.clear();
    }

    /// Starts the next stage of a text, or schedules it if it is the motion.
    pub(super) fn schedule(&mut self, path: &Arc<Path>) {
        match self.published.get(path).and_then(PublishedDiagnostics::next) {
            Some(DiagnosticStage::Motion) => self.due_motions.push((Arc::clone(path), Instant::now() + MOTION_DELAY)),
            Some(stage) => self.start_stage(path, stage),
            None => {}
        }
    }

    fn start_stage(&mut self, path: &Arc<Path>, stage: DiagnosticStage) {
        let (path, revision, snapshot) = (Arc::clone(path), self.revision, self.snapshot.clone());
        let task_sender = self.task_sender.clone();
        let work = move || {
            let start = Instant::now();
            let motion = || {
                let cancel = Cancel::default();
                let _ = task_sender.send(Task::MotionStarted(revision, cancel.clone()));
                cancel
            };
            let result = catch_panic(|| run_stage(&snapshot, &path, stage, &motion));
            let duration = start.elapsed();
            let _ = task_sender.send(Task::StageFinished { path, revision, stage, result, duration });
        };
        let kind = match stage {
            DiagnosticStage::Words => TaskKind::Words,
            DiagnosticStage::Proof => TaskKind::Proof,
            DiagnosticStage::Motion => TaskKind::Motion,
        };
        self.pool.start(kind, work);
    }

    /// Returns how long the loop may wait for a message.
    pub(super) fn next_wakeup(&self) -> Duration {
        let now = Instant::now();
        let next = self.due_motions.iter().map(|(_, from)| from.saturating_duration_since(now)).min();
        let next = next.unwrap_or(IDLE).min(if self.motions.is_empty() { IDLE } else { MOTION_CHECK });
        if self.parent.is_some() { next.min(parent::CHECK_INTERVAL) } else { next }
    }

    pub(super) fn start_due_motions(&mut self) {
        let now = Instant::now();
        let due: Vec<_> = self.due_motions.extract_if(.., |(_, from)| *from <= now).collect();
        for (path, _) in due {
            self.start_stage(&path, DiagnosticStage::Motion);
        }
    }

    pub(super) fn cancel_long_motions(&mut self) {
        let now = Instant::now();
        self.motions.iter().filter(|(_, end)| *end < now).for_each(|(cancel, _)| cancel.cancel());
        self.motions.retain(|(cancel, _)| !cancel.is_cancelled());
    }
}

/// Runs a stage of a text; `None` if it was cancelled.
fn run_stage(
    snapshot: &Snapshot,
    path: &Path,
    stage: DiagnosticStage,
    motion: &dyn Fn() -> Cancel,
) -> Option<StageResult> {
    let diagnostics = ide::diagnostics(snapshot, path, stage, motion)?;
    let has_next = match stage {
        DiagnosticStage::Words => snapshot.may_be_proven(path)?,
        DiagnosticStage::Proof => snapshot.proofs(path)?.iter().any(|proof| proof.assembly.is_some()),
        DiagnosticStage::Motion => false,
    };
    Some(StageResult { diagnostics, has_next })
}
