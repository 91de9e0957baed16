//! What is said of each open text, stage by stage.
//!
//! A later stage takes longer than a keystroke. What it said of the text before stays until it speaks of the new one, moved along with
//! the edits; it goes at once where an earlier stage finds that there is nothing to prove or to follow.

use super::documents::Moved;
use crate::ide::{Said, Stage};

/// What is said of a text.
#[derive(Default)]
pub(super) struct Shown {
    words: Vec<Said>,
    proof: Vec<Said>,
    motion: Vec<Said>,
    /// The last stage that has spoken of the text as it is.
    reached: Option<Stage>,
    /// Another one whenever what is said has changed, or stands elsewhere.
    version: u64,
    /// That it stands elsewhere is not yet told.
    has_moved: bool,
}

/// What a stage says of a text.
pub(super) struct Found {
    pub said: Vec<Said>,
    /// Whether there is anything for the next stage to look at.
    pub goes_on: bool,
}

impl Shown {
    /// The text was edited.
    pub fn edit(&mut self, moved: &Moved) {
        for said in self.proof.iter_mut().chain(&mut self.motion) {
            said.range = moved.applied(&said.range);
        }
        self.has_moved = true;
        self.reached = None;
    }

    /// What was found before need not hold any more, though the text is the same.
    pub fn begin_again(&mut self) {
        self.reached = None;
    }

    /// Takes in what a stage found; whether there is anything new to tell.
    pub fn take(&mut self, stage: Stage, found: Found) -> bool {
        let before = self.all();
        let Found { said, goes_on } = found;
        match stage {
            Stage::Words => self.words = said,
            Stage::Proof => self.proof = said,
            Stage::Motion => self.motion = said,
        }
        self.reached = Some(stage);
        if !goes_on {
            if stage == Stage::Words {
                self.proof.clear();
            }
            if stage != Stage::Motion {
                self.motion.clear();
            }
            self.reached = Some(Stage::Motion);
        }
        let has_moved = std::mem::take(&mut self.has_moved) && !before.is_empty();
        let is_new = has_moved || before != self.all();
        self.version += u64::from(is_new);
        is_new
    }

    /// The stage that is to be looked at next, if any.
    pub fn next(&self) -> Option<Stage> {
        match self.reached {
            None => Some(Stage::Words),
            Some(Stage::Words) => Some(Stage::Proof),
            Some(Stage::Proof) => Some(Stage::Motion),
            Some(Stage::Motion) => None,
        }
    }

    /// All that is said, by stages.
    pub fn all(&self) -> Vec<Said> {
        [&self.words, &self.proof, &self.motion].into_iter().flatten().cloned().collect()
    }

    /// Tells what is said from what was said before.
    pub fn version(&self) -> u64 {
        self.version
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, Moved, Said, Shown, Stage};
    use crate::ide::Severity;

    fn said(message: &str, start: u32) -> Said {
        Said {
            range: start..start + 1,
            severity: Severity::Error,
            code: "E0401",
            message: message.to_owned(),
            more: Vec::new(),
            related: Vec::new(),
            fixes: Vec::new(),
        }
    }

    fn found(messages: &[(&str, u32)], goes_on: bool) -> Found {
        Found { said: messages.iter().map(|(message, start)| said(message, *start)).collect(), goes_on }
    }

    fn all(shown: &Shown) -> Vec<(String, u32)> {
        shown.all().into_iter().map(|said| (said.message, said.range.start)).collect()
    }

    #[test]
    fn what_a_later_stage_said_stays_until_it_speaks_again() {
        let mut shown = Shown::default();
        assert_eq!(shown.next(), Some(Stage::Words));
        assert!(!shown.take(Stage::Words, found(&[], true)), "nothing is nothing new");
        assert!(shown.take(Stage::Proof, found(&[("free", 10)], false)));
        assert_eq!(shown.next(), None);
        shown.edit(&Moved { range: 2..2, length: 5 });
        assert!(shown.take(Stage::Words, found(&[], true)), "it stands elsewhere");
        assert_eq!(all(&shown), [("free".to_owned(), 15)]);
        assert!(shown.take(Stage::Proof, found(&[], true)));
        assert_eq!((all(&shown), shown.next()), (vec![], Some(Stage::Motion)));
    }

    #[test]
    fn what_cannot_be_proven_any_more_says_nothing_of_the_proof() {
        let mut shown = Shown::default();
        shown.take(Stage::Words, found(&[], true));
        shown.take(Stage::Proof, found(&[("warning", 10)], true));
        shown.take(Stage::Motion, found(&[("lock-up", 20)], false));
        shown.edit(&Moved { range: 2..2, length: 5 });
        assert!(shown.take(Stage::Words, found(&[("unknown", 1)], false)));
        assert_eq!((all(&shown), shown.next()), (vec![("unknown".to_owned(), 1)], None));
    }
}
