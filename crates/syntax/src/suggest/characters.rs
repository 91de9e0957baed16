//! Characters of other languages, keyboards and calculators: signs, comments, semicolons.

use super::rules::OPERAND;
use super::{Fault, Suggestion};
use crate::grammar::Rule;
use crate::keywords::begins_declaration;
use crate::lexer::{Lexer, Token, tokens_in};
use mechc_text::diag::{Applicability, Edit, Fix};

/// Unambiguous characters: replacement and what is written with it.
const WRITTEN: [(&str, &str, &str); 5] = [
    ("×", "*", "a product is written with `*`"),
    ("·", "*", "a product is written with `*`"),
    ("÷", "/", "a quotient is written with `/`"),
    ("−", "-", "a minus sign is written `-`"),
    ("–", "-", "a minus sign is written `-`"),
];

const COMMENT: &str = "a comment begins with `//`";

impl Fault<'_> {
    pub(super) fn character(&self) -> Option<Suggestion> {
        // inside of a name the character is no operator
        let is_operator = OPERAND.iter().chain(&[Rule::infix]).any(|rule| self.expects(*rule));
        let written = WRITTEN.iter().find(|(written, ..)| *written == self.found);
        if let Some((_, by, message)) = written.filter(|_| is_operator) {
            return Some(self.everywhere_on_the_line(by, (*message).to_owned()));
        }
        if let Some(ascii) = full_width(self.found) {
            return Some(self.everywhere_on_the_line(&ascii, format!("write `{ascii}` instead of `{}`", self.found)));
        }
        let is_closed = self.behind().lines().next().is_some_and(|line| line.contains('"'));
        Some(match self.found {
            "#" => self.comment(),
            "%" if self.is_on_new_line() => self.comment(),
            "%" => Suggestion::words("a comment begins with `//`; a remainder is `mod(a, b)`"),
            "*" if self.text[..self.at].ends_with('/') => self.block_comment(self.at - 1),
            "/" if self.behind().starts_with('*') => self.block_comment(self.at),
            ";" => self.semicolon(),
            "," if self.rest.len() == 1 && self.is_complete() => self.separator(),
            "\"" if is_closed => {
                Suggestion::words("text in quotes is the file of a `table` or a `use`, and stands nowhere else")
            }
            "\"" => Suggestion::words("a string ends on the line where it begins"),
            _ => return None,
        })
    }

    /// Replaces this character wherever it stands in the rest of the line.
    fn everywhere_on_the_line(&self, by: &str, message: String) -> Suggestion {
        let same = self.rest_of_line(self.at).into_iter().filter(|token| token.text == self.found);
        let edits = same.map(|token| Edit { span: self.span(token.range()), text: by.to_owned() }).collect();
        Suggestion::Fix(Fix { message, edits, applies: Applicability::Always })
    }

    fn rest_of_line(&self, from: usize) -> Vec<Token<'_>> {
        tokens_in(self.text, from..self.here().end + self.behind().lines().next().map_or(0, str::len))
    }

    /// Corrects a comment that begins with `#` or `%`.
    fn comment(&self) -> Suggestion {
        let range = self.at..self.text.len() - self.text[self.at..].trim_start_matches(['#', '%']).len();
        let line = self.behind().lines().next().unwrap_or_default();
        let is_apart = self.text[..self.at].ends_with(char::is_whitespace);
        // an incomplete declaration would continue in the comment
        let is_complete = self.expects(Rule::infix) || self.expects(Rule::close) || self.is_on_new_line();
        // a block that was commented out needs a mark on each of its lines
        let is_sure = is_apart && !line.contains(['{', '}']);
        if !is_complete {
            return Suggestion::Words(format!("a name is made of letters, digits and `_`; {COMMENT}"));
        }
        let applies = if is_sure { Applicability::Always } else { Applicability::Probably };
        self.replaced(range, if is_apart { "//" } else { " //" }, COMMENT, applies)
    }

    /// Turns a comment `/* … */` into line comments.
    fn block_comment(&self, start: usize) -> Suggestion {
        let message = format!("{COMMENT} and ends with its line");
        let end = self.text[start + 2..].find("*/").map(|length| start + 2 + length + 2);
        let is_last = |end: &usize| self.text[*end..].lines().next().unwrap_or_default().trim().is_empty();
        let Some(end) = end.filter(is_last) else { return Suggestion::Words(message) };
        let is_doc = self.text[start..].starts_with("/**");
        let inside = self.text[start + 2..end - 2].trim_matches('*').trim();
        let lines: Vec<&str> = inside.lines().map(|line| line.trim().trim_start_matches('*').trim()).collect();
        let mark = if is_doc { "/// " } else { "// " };
        let gap = format!("{}{}{mark}", self.line_end(), self.indentation(start));
        self.replaced(start..end, &(mark.to_owned() + &lines.join(&gap)), &message, Applicability::Always)
    }

    /// Corrects a `;` behind a declaration, between rows, or between arguments.
    fn semicolon(&self) -> Suggestion {
        let opened = self.opened();
        let Some((start, bracket)) = opened.last().filter(|(_, token)| *token != "{") else { return self.terminator() };
        let mut depth = 0;
        let mut list = Vec::new();
        for token in self.rest_of_line(*start) {
            depth += i32::from(matches!(token.text, "(" | "[")) - i32::from(matches!(token.text, ")" | "]"));
            match token.text {
                _ if depth == 0 => break,
                "," | ";" if depth == 1 => list.push(token),
                _ => {}
            }
        }
        if *bracket == "(" && !(self.expects(Rule::comma) && depth == 0) {
            if self.rest.len() == 1 && self.expects(Rule::comma) {
                let message = "close it with `)`, and leave the `;` out";
                return self.replaced(self.here(), ")", message, Applicability::Probably);
            }
            let words = "what stands in parentheses is separated by commas, and they are closed with `)`";
            return Suggestion::words(words);
        }
        // next to decimal commas a comma would be one more
        let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let is_decimal = |token: &&Token<'_>| {
            let [before, behind] = [&self.text[..token.start], &self.text[token.end()..]];
            token.text == "," && is_digit(before.chars().next_back()) && is_digit(behind.chars().next())
        };
        let commas = list.iter().filter(|token| token.text == ",").count();
        let decimals = list.iter().filter(is_decimal).count();
        let message = match *bracket {
            _ if decimals > 0 => "decimals are written with a point, and lists with commas: `(0.5, 1.5)`",
            "[" => "rows are separated by commas: `(1, 2), (3, 4)`",
            _ => "what stands in parentheses is separated by commas",
        };
        if decimals == 0 {
            // a comma further in may be a decimal one
            let first = opened.iter().find(|(_, token)| *token != "{").map_or(self.at, |(start, _)| *start);
            let is_sure = !self.rest_of_line(first).iter().any(|token| is_decimal(&token));
            let applies = if is_sure { Applicability::Always } else { Applicability::Probably };
            return self.replaced(self.here(), ",", message, applies);
        }
        if decimals < commas {
            return Suggestion::words(message);
        }
        let edit = |token: &Token<'_>| Edit {
            span: self.span(token.range()),
            text: if token.text == "," { "." } else { "," }.to_owned(),
        };
        // the other rows of a table are written alike
        let first = opened.iter().find(|(_, token)| *token != "{").map_or(*start, |(start, _)| *start);
        let (mut open, mut alike) = (Vec::new(), Vec::new());
        for token in self.rest_of_line(first) {
            match token.text {
                "(" | "[" => open.push(Vec::new()),
                ")" | "]" => alike.extend(open.pop().filter(|list: &Vec<Token<'_>>| {
                    list.iter().any(|token| token.text == ";")
                        && list.iter().all(|token| token.text == ";" || is_decimal(&token))
                })),
                "," | ";" => open.iter_mut().last().into_iter().for_each(|list| list.push(token)),
                _ => {}
            }
        }
        let mut edits: Vec<Edit> = alike.iter().flatten().map(edit).collect();
        if edits.is_empty() {
            return Suggestion::words(message);
        }
        edits.sort_by_key(|edit| edit.span.start);
        Suggestion::Fix(Fix { message: message.to_owned(), edits, applies: Applicability::Probably })
    }

    /// Corrects `param a = 3; param b = 4;`.
    fn terminator(&self) -> Suggestion {
        let message = "declarations need no terminator; leave the `;` out";
        let Some(next) =
            self.next().filter(|next| next.lines_before == 0 && begins_declaration(self.text, next.range()))
        else {
            return self.replaced(self.here(), "", message, Applicability::Always);
        };
        // each on its own line, but for what is in braces on one
        let start = self.text[..self.at].rfind('\n').map_or(0, |at| at + 1);
        let is_block = self.text[start..self.at].contains('{');
        let gap = if is_block { " ".to_owned() } else { self.line_end().to_owned() + self.indentation(self.at) };
        self.replaced(self.at..next.start, &gap, message, Applicability::Always)
    }

    /// Corrects a `,` behind a declaration at the end of its line.
    fn separator(&self) -> Suggestion {
        let is_last = self.next().is_none_or(|next| next.text == "}" || begins_declaration(self.text, next.range()));
        let applies = if is_last { Applicability::Always } else { Applicability::Probably };
        self.replaced(self.here(), "", "declarations need nothing between them; leave the `,` out", applies)
    }

    /// Returns whether the declaration before the fault may be complete: all its brackets are closed.
    fn is_complete(&self) -> bool {
        let is_begun = self.declaration().len() > 1 && !["{", "}", ","].contains(&self.word_before(1));
        is_begun && self.opened().iter().all(|(_, token)| *token == "{")
    }

    /// Returns the token behind the fault.
    fn next(&self) -> Option<Token<'_>> {
        Lexer::new(self.text, self.here().end).find(|token| !token.is_comment())
    }
}

/// Returns the ASCII character of a full-width one.
fn full_width(found: &str) -> Option<String> {
    let c = found.chars().next().filter(|c| ('！'..='～').contains(c))?;
    char::from_u32(c as u32 - 0xfee0).map(String::from)
}
