//! The published diagnostics of each open text, by stage.
//!
//! A later stage takes longer than a keystroke. Its diagnostics of the previous text stay published, shifted with the edits, until it has
//! analysed the new text. They are hidden while an earlier stage finds nothing to prove or to run.

use super::documents::Splice;
use crate::{Change, DiagnosticStage, EditorDiagnostic, FileRange};
use std::ops::Range;
use std::path::Path;

/// The published diagnostics of a text.
#[derive(Default)]
pub(super) struct PublishedDiagnostics {
    words: Vec<EditorDiagnostic>,
    proof: Vec<EditorDiagnostic>,
    motion: Vec<EditorDiagnostic>,
    /// By the last results, true if the text can be proven, and true if it can be run.
    has_next: [bool; 2],
    /// The last finished stage of the current text.
    reached: Option<DiagnosticStage>,
    /// A number that changes whenever the diagnostics or their positions change.
    version: u64,
    /// A number that distinguishes this opening of the text from earlier ones.
    opening: u64,
    /// True if positions have shifted since the last update.
    has_shifted: bool,
}

/// The result of a stage of a text.
pub(super) struct StageResult {
    pub diagnostics: Vec<EditorDiagnostic>,
    /// True if the next stage has anything to analyse.
    pub has_next: bool,
}

impl PublishedDiagnostics {
    /// Creates the empty list of a text that is opened.
    pub fn new(opening: u64) -> PublishedDiagnostics {
        PublishedDiagnostics { opening, ..PublishedDiagnostics::default() }
    }

    /// Shifts the diagnostics with an edit of their own text.
    pub fn edit(&mut self, file: &Path, splice: &Splice) {
        for diagnostic in self.late() {
            diagnostic.range = splice.shift(&diagnostic.range);
        }
        self.edit_elsewhere(file, splice);
        self.has_shifted = true;
        self.reached = None;
    }

    /// Shifts the locations in another file with an edit of it, and drops fixes that would change the edited text.
    pub fn edit_elsewhere(&mut self, file: &Path, splice: &Splice) {
        let mut has_shifted = false;
        for diagnostic in self.late() {
            for related in diagnostic.related.iter_mut().filter(|related| *related.location.path == *file) {
                shift(&mut related.location, splice);
                has_shifted = true;
            }
            let is_there = |change: &Change| *change.location.path == *file;
            let is_outdated = |c: &Change| is_there(c) && splice.touches(&c.location.range());
            diagnostic.fixes.retain(|fix| !fix.changes.iter().any(is_outdated));
            let changes = diagnostic.fixes.iter_mut().flat_map(|fix| &mut fix.changes);
            changes.filter(|change| is_there(change)).for_each(|change| shift(&mut change.location, splice));
        }
        self.has_shifted |= has_shifted;
    }

    /// Returns the diagnostics of the stages that may lag behind the text.
    fn late(&mut self) -> impl Iterator<Item = &mut EditorDiagnostic> {
        self.proof.iter_mut().chain(&mut self.motion)
    }

    /// Starts again with the first stage, after another file has changed.
    pub fn restart(&mut self) {
        self.reached = None;
    }

    /// Stores the result of a stage; returns whether the published list changes.
    pub fn update(&mut self, stage: DiagnosticStage, result: StageResult) -> bool {
        let before = self.all();
        let StageResult { diagnostics, has_next } = result;
        match stage {
            DiagnosticStage::Words => (self.words, self.has_next[0]) = (diagnostics, has_next),
            DiagnosticStage::Proof => (self.proof, self.has_next[1]) = (diagnostics, has_next),
            DiagnosticStage::Motion => self.motion = diagnostics,
        }
        self.reached = Some(if has_next { stage } else { DiagnosticStage::Motion });
        let has_shifted = std::mem::take(&mut self.has_shifted) && !before.is_empty();
        let is_new = has_shifted || before != self.all();
        self.version += u64::from(is_new);
        is_new
    }

    /// Returns the next stage to run, if any.
    pub fn next(&self) -> Option<DiagnosticStage> {
        match self.reached {
            None => Some(DiagnosticStage::Words),
            Some(DiagnosticStage::Words) => Some(DiagnosticStage::Proof),
            Some(DiagnosticStage::Proof) => Some(DiagnosticStage::Motion),
            Some(DiagnosticStage::Motion) => None,
        }
    }

    /// Returns all diagnostics, in the order of stages.
    pub fn all(&self) -> Vec<EditorDiagnostic> {
        let [is_proven, is_run] = self.has_next;
        let proof = self.proof.iter().filter(|_| is_proven);
        let motion = self.motion.iter().filter(|_| is_proven && is_run);
        self.words.iter().chain(proof).chain(motion).cloned().collect()
    }

    /// Returns an id of the list that is unique across edits and openings of the text.
    pub fn version(&self) -> String {
        format!("{}.{}", self.opening, self.version)
    }
}

fn shift(location: &mut FileRange, splice: &Splice) {
    let Range { start, end } = splice.shift(&location.range());
    (location.start, location.end) = (start, end);
}

#[cfg(test)]
mod tests {
    use super::{DiagnosticStage, EditorDiagnostic, PublishedDiagnostics, Splice, StageResult};
    use crate::{Change, FileRange, ProposedFix, Related, Severity};
    use std::path::Path;

    fn diagnostic(message: &str, start: u32) -> EditorDiagnostic {
        EditorDiagnostic {
            range: start..start + 1,
            severity: Severity::Error,
            code: "E0401",
            message: message.to_owned(),
            details: Vec::new(),
            related: Vec::new(),
            fixes: Vec::new(),
        }
    }

    fn result(messages: &[(&str, u32)], has_next: bool) -> StageResult {
        let diagnostics = messages.iter().map(|(message, start)| diagnostic(message, *start)).collect();
        StageResult { diagnostics, has_next }
    }

    fn all(published: &PublishedDiagnostics) -> Vec<(String, u32)> {
        published.all().into_iter().map(|diagnostic| (diagnostic.message, diagnostic.range.start)).collect()
    }

    #[test]
    fn diagnostics_of_a_later_stage_stay_until_it_is_run_again() {
        let mut published = PublishedDiagnostics::default();
        assert_eq!(published.next(), Some(DiagnosticStage::Words));
        assert!(!published.update(DiagnosticStage::Words, result(&[], true)), "nothing is nothing new");
        assert!(published.update(DiagnosticStage::Proof, result(&[("free", 10)], false)));
        assert_eq!(published.next(), None);
        published.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 5 });
        assert!(published.update(DiagnosticStage::Words, result(&[], true)), "it stands elsewhere");
        assert_eq!(all(&published), [("free".to_owned(), 15)]);
        assert!(published.update(DiagnosticStage::Proof, result(&[], true)));
        assert_eq!((all(&published), published.next()), (vec![], Some(DiagnosticStage::Motion)));
    }

    #[test]
    fn diagnostics_of_the_proof_are_hidden_while_it_cannot_run() {
        let mut published = PublishedDiagnostics::default();
        published.update(DiagnosticStage::Words, result(&[], true));
        published.update(DiagnosticStage::Proof, result(&[("warning", 10)], true));
        published.update(DiagnosticStage::Motion, result(&[("lock-up", 20)], false));
        published.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 5 });
        assert!(published.update(DiagnosticStage::Words, result(&[("unknown", 1)], false)));
        assert_eq!((all(&published), published.next()), (vec![("unknown".to_owned(), 1)], None));
        published.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 1 });
        assert!(published.update(DiagnosticStage::Words, result(&[], true)));
        assert_eq!(all(&published), [("warning".to_owned(), 16), ("lock-up".to_owned(), 26)], "never an empty list");
        assert!(published.update(DiagnosticStage::Proof, result(&[("free", 3)], false)));
        assert_eq!(all(&published), [("free".to_owned(), 3)]);
    }

    #[test]
    fn related_locations_and_fixes_shift_with_their_texts() {
        let location = |path: &str, start| FileRange { path: Path::new(path).into(), start, end: start + 4 };
        let related = |path: &str| Related { location: location(path, 20), text: String::new() };
        let fix = |path: &str, start| ProposedFix {
            message: format!("{path} {start}"),
            is_certain: true,
            changes: vec![Change { location: location(path, start), text: String::new() }],
        };
        let mut free = diagnostic("free", 30);
        free.related = vec![related("a.mech"), related("b.mech")];
        free.fixes = vec![fix("a.mech", 2), fix("a.mech", 30), fix("b.mech", 2)];
        let mut published = PublishedDiagnostics::default();
        published.update(DiagnosticStage::Words, result(&[], true));
        published.update(DiagnosticStage::Proof, StageResult { diagnostics: vec![free], has_next: false });
        published.edit(Path::new("a.mech"), &Splice { range: 4..5, length: 2 });
        let shifted = published.all().remove(0);
        assert_eq!(shifted.related.iter().map(|related| related.location.start).collect::<Vec<_>>(), [21, 20]);
        let fixes = shifted.fixes.iter().map(|fix| (fix.message.as_str(), fix.changes[0].location.start));
        assert_eq!(fixes.collect::<Vec<_>>(), [("a.mech 30", 31), ("b.mech 2", 2)]);
        published.edit_elsewhere(Path::new("b.mech"), &Splice { range: 0..0, length: 7 });
        let shifted = published.all().remove(0);
        assert_eq!(
            (shifted.range.start, shifted.related[1].location.start, shifted.fixes[1].changes[0].location.start),
            (31, 27, 9)
        );
        assert!(published.update(DiagnosticStage::Words, result(&[], true)), "that is told, though it says the same");
    }
}
