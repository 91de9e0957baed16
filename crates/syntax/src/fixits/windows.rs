//! Windows of reductions in other forms than `max(e, from A to B)`.

use super::{Fault, FixIt};
use crate::grammar::Rule;
use crate::lexer::{Token, tokens, tokens_in};
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::ReductionWord;

impl<'a> Fault<'a> {
    pub(super) fn reduction_window(&self) -> Option<FixIt> {
        let last = self.last_argument()?;
        let word = |k: usize| last.get(k).map_or("", |token| token.text);
        let is_window = |word: &str| matches!(word, "from" | "to");
        // a comma behind the window was read as the one behind the last argument
        if last.is_empty() && self.before().ends_with(',') && !self.expects(Rule::infix) {
            if self.found == "to" {
                let comma = self.before().len() - 1..self.before().len();
                let words = "no comma stands in a window: `from A to B`";
                return Some(FixIt::Fix(Fix::replace(self.span(comma), "", words, Applicability::Always)));
            }
            return self.expects(Rule::right).then(|| FixIt::words("a window stands behind all arguments"));
        }
        if !self.expects(Rule::infix) || !self.expects(Rule::comma) {
            return None;
        }
        if is_window(word(0)) && word(1) == "(" && self.found == "to" {
            let bracket = last[1].start;
            let words = "a bracket behind `from` stands apart from it: otherwise `from` is called";
            return Some(self.replaced(bracket..bracket, " ", words, Applicability::Always));
        }
        if is_window(word(0)) && is_window(self.found) {
            return Some(FixIt::words("a time that begins with a sign stands in parentheses: `from (-1 s)`"));
        }
        if is_window(word(0)) && last.len() == 1 {
            return Some(FixIt::words("a window stands behind a formula: `max(e, from A to B)`"));
        }
        let end = self.before().len();
        let words = "a window stands behind a comma: `max(e, from A to B)`";
        is_window(self.found).then(|| self.replaced(end..end, ",", words, Applicability::Always))
    }

    /// Returns the tokens of the last argument of the innermost open call, if it is a reduction; none behind a comma.
    fn last_argument(&self) -> Option<Vec<Token<'a>>> {
        let (open, _) = self.opened().pop().filter(|(_, bracket)| *bracket == "(")?;
        let called = tokens(&self.text[..open]).pop()?;
        ReductionWord::named(called.text)?;
        let (mut depth, mut last) = (0_usize, Vec::new());
        for token in tokens_in(self.text, open + 1..self.at) {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth = depth.saturating_sub(1),
                "," if depth == 0 => {
                    last.clear();
                    continue;
                }
                _ => {}
            }
            last.push(token);
        }
        Some(last)
    }
}
