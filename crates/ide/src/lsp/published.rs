//! What is said of each open text, stage by stage.
//!
//! A later stage takes longer than a keystroke. What it said of the text before stays until it speaks of the new one, moved along with
//! the edits. While an earlier stage finds that there is nothing to prove or to follow it is not shown, and comes back where that passes.

use super::documents::Splice;
use crate::{Change, DiagnosticStage, EditorDiagnostic, FileRange};
use std::ops::Range;
use std::path::Path;

/// What is said of a text.
#[derive(Default)]
pub(super) struct PublishedDiagnostics {
    words: Vec<EditorDiagnostic>,
    proof: Vec<EditorDiagnostic>,
    motion: Vec<EditorDiagnostic>,
    /// There is something to prove, and something to follow, as far as was last known.
    goes_on: [bool; 2],
    /// The last stage that has spoken of the text as it is.
    reached: Option<DiagnosticStage>,
    /// Another one whenever what is said has changed, or stands elsewhere.
    version: u64,
    /// Tells the text's opening from earlier ones.
    opening: u64,
    /// That it stands elsewhere is not yet told.
    has_moved: bool,
}

/// What a stage says of a text.
pub(super) struct StageResult {
    pub said: Vec<EditorDiagnostic>,
    /// Whether there is anything for the next stage to look at.
    pub goes_on: bool,
}

impl PublishedDiagnostics {
    /// Nothing yet, of a text that is opened.
    pub fn of_opening(opening: u64) -> PublishedDiagnostics {
        PublishedDiagnostics { opening, ..PublishedDiagnostics::default() }
    }

    /// The text was edited, which is that of a file.
    pub fn edit(&mut self, file: &Path, moved: &Splice) {
        for said in self.late() {
            said.range = moved.applied(&said.range);
        }
        self.edit_elsewhere(file, moved);
        self.has_moved = true;
        self.reached = None;
    }

    /// A text was edited that may be spoken of here: places in it move along, and a change of what is not the same any more is no
    /// longer proposed.
    pub fn edit_elsewhere(&mut self, file: &Path, moved: &Splice) {
        let mut has_moved = false;
        for said in self.late() {
            for related in said.related.iter_mut().filter(|related| *related.location.path == *file) {
                move_along(&mut related.location, moved);
                has_moved = true;
            }
            let is_there = |change: &Change| *change.location.path == *file;
            said.fixes.retain(|fix| !fix.changes.iter().any(|c| is_there(c) && moved.meets(&c.location.range())));
            let changes = said.fixes.iter_mut().flat_map(|fix| &mut fix.changes);
            changes.filter(|change| is_there(change)).for_each(|change| move_along(&mut change.location, moved));
        }
        self.has_moved |= has_moved;
    }

    /// What the stages said that may not have seen the text as it is.
    fn late(&mut self) -> impl Iterator<Item = &mut EditorDiagnostic> {
        self.proof.iter_mut().chain(&mut self.motion)
    }

    /// What was found before need not hold any more, though the text is the same.
    pub fn begin_again(&mut self) {
        self.reached = None;
    }

    /// Takes in what a stage found; whether there is anything new to tell.
    pub fn take(&mut self, stage: DiagnosticStage, found: StageResult) -> bool {
        let before = self.all();
        let StageResult { said, goes_on } = found;
        match stage {
            DiagnosticStage::Words => (self.words, self.goes_on[0]) = (said, goes_on),
            DiagnosticStage::Proof => (self.proof, self.goes_on[1]) = (said, goes_on),
            DiagnosticStage::Motion => self.motion = said,
        }
        self.reached = Some(if goes_on { stage } else { DiagnosticStage::Motion });
        let has_moved = std::mem::take(&mut self.has_moved) && !before.is_empty();
        let is_new = has_moved || before != self.all();
        self.version += u64::from(is_new);
        is_new
    }

    /// The stage that is to be looked at next, if any.
    pub fn next(&self) -> Option<DiagnosticStage> {
        match self.reached {
            None => Some(DiagnosticStage::Words),
            Some(DiagnosticStage::Words) => Some(DiagnosticStage::Proof),
            Some(DiagnosticStage::Proof) => Some(DiagnosticStage::Motion),
            Some(DiagnosticStage::Motion) => None,
        }
    }

    /// All that is said, by stages.
    pub fn all(&self) -> Vec<EditorDiagnostic> {
        let [is_proven, is_followed] = self.goes_on;
        let proof = self.proof.iter().filter(|_| is_proven);
        let motion = self.motion.iter().filter(|_| is_proven && is_followed);
        self.words.iter().chain(proof).chain(motion).cloned().collect()
    }

    /// Tells what is said from what was said before, in this opening of the text or another one.
    pub fn version(&self) -> String {
        format!("{}.{}", self.opening, self.version)
    }
}

fn move_along(position: &mut FileRange, moved: &Splice) {
    let Range { start, end } = moved.applied(&position.range());
    (position.start, position.end) = (start, end);
}

#[cfg(test)]
mod tests {
    use super::{DiagnosticStage, StageResult, Splice, EditorDiagnostic, PublishedDiagnostics};
    use crate::{Change, ProposedFix, Related, Severity, FileRange};
    use std::path::Path;

    fn said(message: &str, start: u32) -> EditorDiagnostic {
        EditorDiagnostic {
            range: start..start + 1,
            severity: Severity::Error,
            code: "E0401",
            message: message.to_owned(),
            more: Vec::new(),
            related: Vec::new(),
            fixes: Vec::new(),
        }
    }

    fn found(messages: &[(&str, u32)], goes_on: bool) -> StageResult {
        StageResult { said: messages.iter().map(|(message, start)| said(message, *start)).collect(), goes_on }
    }

    fn all(shown: &PublishedDiagnostics) -> Vec<(String, u32)> {
        shown.all().into_iter().map(|said| (said.message, said.range.start)).collect()
    }

    #[test]
    fn what_a_later_stage_said_stays_until_it_speaks_again() {
        let mut shown = PublishedDiagnostics::default();
        assert_eq!(shown.next(), Some(DiagnosticStage::Words));
        assert!(!shown.take(DiagnosticStage::Words, found(&[], true)), "nothing is nothing new");
        assert!(shown.take(DiagnosticStage::Proof, found(&[("free", 10)], false)));
        assert_eq!(shown.next(), None);
        shown.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 5 });
        assert!(shown.take(DiagnosticStage::Words, found(&[], true)), "it stands elsewhere");
        assert_eq!(all(&shown), [("free".to_owned(), 15)]);
        assert!(shown.take(DiagnosticStage::Proof, found(&[], true)));
        assert_eq!((all(&shown), shown.next()), (vec![], Some(DiagnosticStage::Motion)));
    }

    #[test]
    fn what_cannot_be_proven_for_a_while_says_nothing_of_the_proof_and_then_the_same() {
        let mut shown = PublishedDiagnostics::default();
        shown.take(DiagnosticStage::Words, found(&[], true));
        shown.take(DiagnosticStage::Proof, found(&[("warning", 10)], true));
        shown.take(DiagnosticStage::Motion, found(&[("lock-up", 20)], false));
        shown.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 5 });
        assert!(shown.take(DiagnosticStage::Words, found(&[("unknown", 1)], false)));
        assert_eq!((all(&shown), shown.next()), (vec![("unknown".to_owned(), 1)], None));
        shown.edit(Path::new("a.mech"), &Splice { range: 2..2, length: 1 });
        assert!(shown.take(DiagnosticStage::Words, found(&[], true)));
        assert_eq!(all(&shown), [("warning".to_owned(), 16), ("lock-up".to_owned(), 26)], "never an empty list");
        assert!(shown.take(DiagnosticStage::Proof, found(&[("free", 3)], false)));
        assert_eq!(all(&shown), [("free".to_owned(), 3)]);
    }

    #[test]
    fn related_places_and_fixes_move_with_what_they_belong_to() {
        let position = |path: &str, start| FileRange { path: Path::new(path).into(), start, end: start + 4 };
        let related = |path: &str| Related { location: position(path, 20), text: String::new() };
        let fix = |path: &str, start| ProposedFix {
            message: format!("{path} {start}"),
            is_certain: true,
            changes: vec![Change { location: position(path, start), text: String::new() }],
        };
        let mut told = said("free", 30);
        told.related = vec![related("a.mech"), related("b.mech")];
        told.fixes = vec![fix("a.mech", 2), fix("a.mech", 30), fix("b.mech", 2)];
        let mut shown = PublishedDiagnostics::default();
        shown.take(DiagnosticStage::Words, found(&[], true));
        shown.take(DiagnosticStage::Proof, StageResult { said: vec![told], goes_on: false });
        shown.edit(Path::new("a.mech"), &Splice { range: 4..5, length: 2 });
        let told = shown.all().remove(0);
        assert_eq!(told.related.iter().map(|related| related.location.start).collect::<Vec<_>>(), [21, 20]);
        let fixes = told.fixes.iter().map(|fix| (fix.message.as_str(), fix.changes[0].location.start));
        assert_eq!(fixes.collect::<Vec<_>>(), [("a.mech 30", 31), ("b.mech 2", 2)]);
        shown.edit_elsewhere(Path::new("b.mech"), &Splice { range: 0..0, length: 7 });
        let told = shown.all().remove(0);
        assert_eq!((told.range.start, told.related[1].location.start, told.fixes[1].changes[0].location.start), (31, 27, 9));
        assert!(shown.take(DiagnosticStage::Words, found(&[], true)), "that is told, though it says the same");
    }
}
