//! Unclosed brackets, and where their closing brackets belong.

use super::Fault;
use crate::keywords::begins_declaration;
use crate::lexer::Lexer;
use crate::sync_points::is_operator;
use mechc_text::diag::{Applicability, Edit, Fix};

impl<'a> Fault<'a> {
    /// Returns the brackets that are open before the fault, innermost last.
    pub(super) fn opened(&self) -> Vec<(usize, &'a str)> {
        let mut opened: Vec<(usize, &str)> = Vec::new();
        for token in &self.before {
            match token.text {
                "(" | "[" | "{" => opened.push((token.start, token.text)),
                ")" | "]" | "}" => drop(opened.pop()),
                // no parenthesis reaches into the next declaration, and `ground.O` is a point
                _ if begins_declaration(self.text, token.range()) => {
                    opened.retain(|(_, token)| *token == "{");
                }
                _ => {}
            }
        }
        opened
    }

    /// Returns whether a bracket may be missing here: the word at the fault cannot belong to an open one, and none is closed further on.
    fn lacks_a_bracket(&self) -> bool {
        (["", "{", "}"].contains(&self.found) || self.begins_declaration()) && !self.is_closed_behind()
    }

    /// Returns whether more parentheses and square brackets are closed than opened from here to the next declaration or brace.
    fn is_closed_behind(&self) -> bool {
        let mut depth = 0;
        for (k, token) in Lexer::new(self.text, self.at).filter(|token| !token.is_comment()).enumerate() {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth -= 1,
                "{" | "}" => return false,
                _ if k > 0 && begins_declaration(self.text, token.range()) => return false,
                _ => {}
            }
            if depth < 0 {
                return true;
            }
        }
        false
    }

    /// Returns the earlier position that causes a fault, with its explanation.
    pub fn reason(&self) -> Option<(usize, &'static str)> {
        let last = self.before.last().filter(|_| self.lacks_a_bracket())?;
        match self.opened().last() {
            _ if last.text == "=" => Some((last.start, "nothing stands behind this")),
            None if last.text == "}" => Some((last.start, "this `}` ends the mechanism")),
            Some((start, "(")) => Some((*start, "this `(` is not closed")),
            Some((start, "[")) => Some((*start, "this `[` is not closed")),
            Some((start, "{")) if self.found.is_empty() || self.ends_a_body() => {
                Some((*start, "this `{` is not closed"))
            }
            _ => None,
        }
    }

    /// Returns the brackets that are missing before the fault.
    pub(super) fn closing(&self) -> Option<Fix> {
        let opened = self.opened();
        let (innermost, bracket) = opened.last().filter(|_| self.lacks_a_bracket())?;
        match *bracket {
            "{" if self.found.is_empty() => self.braces_at_the_end(&opened),
            "{" if self.found == "mechanism" => {
                let edits = vec![self.brace_before()?];
                // within a line the word may stand in the place of a name
                let is_sure = self.is_on_new_line();
                Some(Fix { message: "close it with `}`".to_owned(), edits, applies: applies(is_sure) })
            }
            "{" => None,
            _ => {
                // behind an operator something else is missing
                let last = self.before.last().filter(|token| !is_operator(token.text))?;
                let open = opened.iter().rev().take_while(|(_, token)| *token != "{");
                let closers: String = open.map(|(_, token)| if *token == "(" { ')' } else { ']' }).collect();
                let inside = self.before.iter().filter(|token| token.start > *innermost).map(|token| token.text);
                let inside: Vec<&str> = inside.collect();
                let is_plain = if *bracket == "(" { is_plain_list(&inside) } else { inside.ends_with(&[")"]) };
                let message = format!("close it with `{closers}`");
                let is_sure = closers.len() == 1 && is_plain;
                Some(Fix::replace(self.span(last.end()..last.end()), closers, message, applies(is_sure)))
            }
        }
    }

    /// Returns the braces that are missing at the end of the text.
    fn braces_at_the_end(&self, opened: &[(usize, &str)]) -> Option<Fix> {
        let line_end = self.line_end();
        let mut text = if self.text.ends_with('\n') { String::new() } else { line_end.to_owned() };
        for (start, token) in opened.iter().rev() {
            if *token != "{" {
                return None;
            }
            text += &format!("{}}}{line_end}", self.indentation(*start));
        }
        // one brace too many at the head of a block leaves one open at the end as well
        let is_doubled = self.before.windows(2).any(|pair| pair[0].text == "{" && pair[1].text == "{");
        let message = format!("close it with `{}`", "}".repeat(opened.len()));
        let end = self.text.len();
        Some(Fix::replace(self.span(end..end), text, message, applies(opened.len() == 1 && !is_doubled)))
    }

    /// Returns a brace that closes the innermost block before the declaration here.
    pub(super) fn brace_before(&self) -> Option<Edit> {
        let (open, _) = self.opened().into_iter().rfind(|(_, token)| *token == "{")?;
        let end = self.end_before();
        let Some(line) = self.text[end..self.at].find('\n') else {
            return Some(Edit { span: self.span(self.at..self.at), text: "} ".to_owned() });
        };
        // behind the comment at the end of the line, if there is one
        let place = end + self.text[end..end + line].trim_end_matches('\r').len();
        let text = format!("{}{}}}", self.line_end(), self.indentation(open));
        Some(Edit { span: self.span(place..place), text })
    }

    /// Returns the line end that the text uses.
    pub(super) fn line_end(&self) -> &'static str {
        if self.text.contains("\r\n") { "\r\n" } else { "\n" }
    }

    /// Returns the white space at the beginning of the line that contains a byte.
    pub(super) fn indentation(&self, byte: usize) -> &'a str {
        let start = self.text[..byte].rfind('\n').map_or(0, |at| at + 1);
        let line = &self.text[start..];
        &line[..line.len() - line.trim_start().len()]
    }
}

fn applies(is_sure: bool) -> Applicability {
    if is_sure { Applicability::Always } else { Applicability::Probably }
}

/// Returns whether tokens are words and numbers with commas; otherwise a part may belong behind the parenthesis, and a string that is not
/// closed may hold it.
fn is_plain_list(tokens: &[&str]) -> bool {
    tokens.iter().enumerate().all(|(k, token)| {
        let is_sign = *token == "-" && (k == 0 || tokens[k - 1] == ",");
        is_sign || !is_operator(token) && *token != "(" && !token.starts_with('"')
    })
}
