//! Uses of other files: a path without quotes, a word of another program, a misplaced `use`.

use super::{Fault, FixIt};
use crate::grammar::Rule;
use crate::lexer::tokens;
use mechc_text::diag::Applicability;

/// Words of other programs for `use`.
const OTHER_WORDS: [&str; 4] = ["import", "include", "require", "from"];

impl Fault<'_> {
    pub(super) fn file_use(&self) -> Option<FixIt> {
        let is_at_the_next = self.found.is_empty() || self.is_on_new_line();
        let is_prefix = self.expects(Rule::use_prefix) || self.expects(Rule::name);
        // comments may stand between
        let last = || tokens(&self.text[..self.at]).last().map(|token| token.text);
        if is_prefix && is_at_the_next && last() == Some("as") {
            return Some(FixIt::words("a name stands behind `as`: `use \"FILE.mech\" as legs`"));
        }
        let is_before_a_string = self.behind().trim_start_matches([' ', '\t']).starts_with('"');
        if self.expects(Rule::string) && self.word_before() == "use" {
            return self.unquoted_path();
        }
        if !is_before_a_string {
            return None;
        }
        if self.found == "use" && !self.expects(Rule::use_prefix) {
            return Some(FixIt::words("a `use` stands at the top of the file, above the first `mechanism`"));
        }
        let is_top = self.expects(Rule::kw_use) || self.expects(Rule::kw_mechanism);
        (is_top && OTHER_WORDS.contains(&self.found)).then(|| {
            self.replaced(self.here(), "use", "a file is used by `use \"FILE.mech\"`", Applicability::Probably)
        })
    }

    /// Puts the path of a `use` in quotes: `use leg.mech`.
    fn unquoted_path(&self) -> Option<FixIt> {
        if self.found.is_empty() || self.is_on_new_line() || self.found == "\"" {
            return None;
        }
        let rest = &self.text[self.at..];
        let taken = rest.split([' ', '\t', '\r', '\n', ';', '"']).next()?;
        let path = format!("\"{}\"", taken.trim_matches(['\'', '<', '>']));
        let words = "the path of a file stands in quotes";
        Some(self.replaced(self.at..self.at + taken.len(), &path, words, Applicability::Probably))
    }
}
