//! Semicolons: behind a declaration, between rows, and next to decimal commas.

use super::{Fault, FixIt};
use crate::grammar::Rule;
use crate::keywords::begins_declaration;
use crate::lexer::{Lexer, Token, tokens_in};
use mechc_text::diag::{Applicability, Edit, Fix};

const ROWS: &str = "rows are separated by commas: `(1, 2), (3, 4)`";
const TERMINATOR: &str = "declarations need no terminator; leave the `;` out";
const PARTS: &str = "what stands in parentheses is separated by commas";

impl Fault<'_> {
    pub(super) fn semicolon(&self, around: &str) -> FixIt {
        match around {
            "" | "{" => self.terminator(),
            _ if self.has_decimal_comma() => self.decimal_commas(),
            "[" => self.replaced(self.here(), ",", ROWS, Applicability::Always),
            // closed on its line, it goes on behind the semicolon
            _ if self.expects(Rule::comma) && self.is_closed_on_the_line() => {
                let is_decimal = |token: &Token<'_>| token.text == "," && self.is_between_digits(token.start);
                let is_open = self.list().iter().any(is_decimal);
                self.replaced(
                    self.here(),
                    ",",
                    PARTS,
                    if is_open { Applicability::Probably } else { Applicability::Always },
                )
            }
            _ => self.unclosed_parenthesis(),
        }
    }

    /// Corrects `param a = 3; param b = 4;`.
    fn terminator(&self) -> FixIt {
        let behind = self.behind().trim_start_matches([' ', '\t']);
        let gap = self.here().end..self.text.len() - behind.len();
        let word = Lexer::new(self.text, gap.end).next().filter(|word| word.lines_before == 0);
        let goes_on = word.is_some_and(|word| begins_declaration(self.text, word.range()));
        if !goes_on {
            return self.left_out(TERMINATOR);
        }
        // each on its own line, but for what is in braces on one
        let start = self.text[..self.at].rfind('\n').map_or(0, |at| at + 1);
        let line = &self.text[start..self.at];
        let text =
            if line.contains('{') { " ".to_owned() } else { self.line_end().to_owned() + self.indentation(self.at) };
        self.replaced(self.at..gap.end, &text, TERMINATOR, Applicability::Always)
    }

    /// Corrects `weld(a.P; b.Q` at the end of a line.
    fn unclosed_parenthesis(&self) -> FixIt {
        let rest = self.rest_of_line();
        let is_complete = self.opened().iter().filter(|(_, token)| *token != "{").count() == 1
            && self.expects(Rule::comma)
            && rest.iter().all(|token| !["(", "[", "{", "}", ";"].contains(&token.text));
        match rest.last() {
            None if is_complete => {
                self.replaced(self.here(), ")", "close it with `)`, and leave the `;` out", Applicability::Probably)
            }
            Some(last) if is_complete => {
                let end = last.end();
                let edits = [(self.here(), ","), (end..end, ")")]
                    .map(|(range, text)| Edit { span: self.span(range), text: text.to_owned() });
                let message = format!("{PARTS}; close it with `)`");
                FixIt::Fix(Fix { message, edits: edits.into(), applies: Applicability::Probably })
            }
            _ => FixIt::words("what stands in parentheses is separated by commas, and they are closed with `)`"),
        }
    }

    /// Returns whether the line closes more parentheses behind the fault than it opens.
    fn is_closed_on_the_line(&self) -> bool {
        let mut depth = 0;
        self.rest_of_line().iter().any(|token| {
            depth += i32::from(token.text == "(") - i32::from(token.text == ")");
            depth < 0
        })
    }

    /// Returns the tokens from the outermost open bracket to the end of the line.
    fn list(&self) -> Vec<Token<'_>> {
        let opened = self.opened();
        let start = opened.iter().find(|(_, token)| *token != "{").map_or(self.at, |(start, _)| *start);
        let end = self.here().end + self.behind().lines().next().unwrap_or_default().len();
        tokens_in(self.text, start..end)
    }

    /// Returns the tokens behind the fault on its line.
    fn rest_of_line(&self) -> Vec<Token<'_>> {
        let end = self.here().end;
        tokens_in(self.text, end..end + self.behind().lines().next().unwrap_or_default().len())
    }

    /// Returns the commas right between digits in brackets with a `;`; `None` for a comma that separates.
    fn commas_in_semicolon_lists(&self) -> Vec<Option<usize>> {
        let list = self.list();
        let mut open: Vec<(bool, Vec<Option<usize>>)> = vec![(false, Vec::new())];
        let mut found = Vec::new();
        for token in &list {
            let around = open.last_mut();
            match (token.text, around) {
                ("(" | "[", _) => open.push((false, Vec::new())),
                (")" | "]", Some(_)) => found.extend(open.pop()),
                (";", Some((has_semicolon, _))) => *has_semicolon = true,
                (",", Some((_, commas))) => commas.push(self.is_between_digits(token.start).then_some(token.start)),
                _ => {}
            }
        }
        found.extend(open);
        found.into_iter().filter(|(has_semicolon, _)| *has_semicolon).flat_map(|(_, commas)| commas).collect()
    }

    /// Returns whether a comma is a decimal point, judging by its neighbors.
    fn is_between_digits(&self, at: usize) -> bool {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let behind = self.text[at + 1..].trim_start_matches(|c: char| c.is_ascii_digit());
        digit(self.text[..at].chars().next_back())
            && digit(self.text[at + 1..].chars().next())
            && !behind.starts_with(',')
    }

    fn has_decimal_comma(&self) -> bool {
        self.commas_in_semicolon_lists().iter().any(Option::is_some)
    }

    /// Explains both readings of `max(1,5; 2)` and chooses neither.
    fn decimal_commas(&self) -> FixIt {
        let commas: Option<Vec<usize>> = self.commas_in_semicolon_lists().into_iter().collect();
        let Some(commas) = commas else {
            return FixIt::words("a list is separated by commas, and decimals are written with a point: `(0.5, 1.5)`");
        };
        let list = self.list();
        let semicolons = list.iter().filter(|token| token.text == ";").map(|token| (token.start, ","));
        let mut edits: Vec<(usize, &str)> = commas.into_iter().map(|at| (at, ".")).chain(semicolons).collect();
        edits.sort_unstable();
        let edits = edits.into_iter().map(|(at, text)| Edit { span: self.span(at..at + 1), text: text.to_owned() });
        let message = "decimals are written with a point, and lists with commas: `(0.5, 1.5)`".to_owned();
        FixIt::Fix(Fix { message, edits: edits.collect(), applies: Applicability::Probably })
    }
}
