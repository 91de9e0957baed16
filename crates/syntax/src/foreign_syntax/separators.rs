//! Separators of other languages between declarations and inside them.

use super::{Correction, Foreign, is_name};
use crate::grammar::Rule;
use crate::keywords::begins_declaration;
use crate::lexer::{Lexer, Token, tokens};
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::{Unit, is_declaration};

impl Foreign<'_> {
    /// Corrects `param a = 3 mm, b = 4 mm`, `param a = 3 mm,` at the end of its line, `param a = (3 mm))`.
    pub(super) fn declaration_list(&self, keyword: &str) -> Option<Correction> {
        if !is_declaration(keyword)
            || !self.is_outside_of_brackets()
            || !self.expects(Rule::infix) && self.before.last()?.text != ")"
        {
            return None;
        }
        let next: Vec<&str> = self.rest.iter().skip(1).map(|token| token.text).collect();
        let left_out = |message: &str, applies| {
            let edits = vec![self.edit(self.here(), "")];
            Some(Correction::Change(Fix { message: message.to_owned(), edits, applies }))
        };
        match (self.found, &next[..]) {
            (",", []) => {
                left_out("declarations need nothing between them; leave the `,` out", self.applies_before_the_next())
            }
            (",", [name, "=" | ":", ..]) if is_name(name) => {
                let edit = self.edit(self.at..self.rest[1].start, &format!(" {keyword} "));
                Some(Foreign::change(
                    format!("each {keyword} has its own keyword: `{keyword} {name} {} …`", next[1]),
                    vec![edit],
                ))
            }
            (")", _) => left_out("this `)` closes nothing; leave it out", Applicability::Probably),
            _ => None,
        }
    }

    /// Returns the confidence in removing text before the next declaration or the end of the block.
    fn applies_before_the_next(&self) -> Applicability {
        let behind = self.at + self.found.len();
        let next = Lexer::new(self.text, behind).find(|token| !token.is_comment());
        let is_last = next.is_none_or(|next| next.text == "}" || begins_declaration(self.text, next.range()));
        if is_last { Applicability::Always } else { Applicability::Probably }
    }

    /// Corrects `point P = (45, 40) mm`.
    pub(super) fn unit_behind_pair(&self, last: &Token<'_>) -> Option<Correction> {
        let unit = Unit::named(self.found)?.word.name;
        let open = self.before.iter().rposition(|token| token.text == "(").filter(|_| last.text == ")")?;
        let inside = &self.before[open + 1..self.before.len() - 1];
        let is_number = |token: &&Token<'_>| token.text.parse::<f64>().is_ok();
        let is_plain = inside.iter().all(|token| is_number(&token) || [",", "-"].contains(&token.text));
        let before = self.before[..open].iter().map(|token| token.text).collect::<Vec<_>>();
        let is_point = matches!(before.as_slice(), [.., "point", _, "="]);
        if !is_plain || inside.iter().filter(is_number).count() < 2 || self.expects(Rule::infix) && !is_point {
            return None;
        }
        let units =
            inside.iter().filter(is_number).map(|token| self.edit(token.end()..token.end(), &format!(" {unit}")));
        let edits = units.chain([self.edit(last.end()..self.at + self.found.len(), "")]).collect();
        let first = inside.iter().find(is_number)?.text;
        Some(Foreign::change(format!("each number has its own unit: `({first} {unit}, …)`"), edits))
    }

    /// Corrects `'ground.O'`.
    pub(super) fn single_quotes(&self) -> Option<Correction> {
        let quote = self.found.chars().next().filter(|c| ['\'', '‘', '’', '`', '“', '”'].contains(c))?;
        let line = self.text[self.at + quote.len_utf8()..].lines().next()?;
        let end = line.find(['\'', '’', '`', '”'])?;
        let inside = &line[..end];
        let is_plain = tokens(inside).iter().all(|token| token.text == "." || is_name(token.text));
        if !is_plain || inside.is_empty() {
            return None;
        }
        let close = line[end..].chars().next().map_or(1, char::len_utf8);
        let whole = self.at..self.at + quote.len_utf8() + end + close;
        Some(Foreign::change(format!("names stand without quotes: `{inside}`"), vec![self.edit(whole, inside)]))
    }

    /// Corrects `arm->tip`.
    pub(super) fn arrow(&self, last: &Token<'_>) -> Option<Correction> {
        let [.., owner, _] = self.before.as_slice() else { return None };
        let feature = self.rest.get(1).filter(|token| is_name(token.text))?;
        let is_arrow = self.found == ">" && last.text == "-" && last.end() == self.at && is_name(owner.text);
        let message = format!("what belongs to a body is written `{}.{}`", owner.text, feature.text);
        is_arrow.then(|| Foreign::change(message, vec![self.edit(owner.end()..feature.start, ".")]))
    }

    /// Corrects `arm.tip.x`.
    pub(super) fn point_coordinate(&self, last: &Token<'_>) -> Option<Correction> {
        let [.., owner, dot, _] = self.before.as_slice() else { return None };
        let coordinate = self.rest.get(1).filter(|token| ["x", "y"].contains(&token.text))?;
        if self.found != "." || dot.text != "." || !is_name(owner.text) {
            return None;
        }
        let written = format!("{}({})", coordinate.text, &self.text[owner.start..last.end()]);
        let edit = self.edit(owner.start..coordinate.end(), &written);
        Some(Foreign::change(format!("a coordinate of a point is written `{written}`"), vec![edit]))
    }
}
