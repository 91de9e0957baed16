//! Declarations with a missing or a wrong keyword.

use super::{Correction, Foreign, holds_quantity, is_name};
use crate::grammar::Rule;
use mechc_text::vocabulary::{JointSpec, Keyword, Position, Role, Synonym};

impl Foreign<'_> {
    /// Suggests the keyword of a declaration without one: `a = 30 mm`, `j: revolute(…)`, `revolute j: (…)`.
    pub(super) fn missing_keyword(&self) -> Option<Correction> {
        if self.found == "inertia" && self.begins_feature() {
            return Some(Correction::Words("an inertia stands behind its mass: `mass M inertia I`".to_owned()));
        }
        let is_free = |token: &str| is_name(token) && Keyword::named(token).is_none();
        let is_expected = self.begins_large() || self.begins_feature();
        if !is_free(self.found) || !is_expected || !self.is_first_on_its_line() {
            return None;
        }
        let words: Vec<&str> = self.rest.iter().map(|token| token.text).collect();
        match words[..] {
            [kind, name, ":", "(", ..] | [kind, name, "(", ..] if is_joint(kind) && is_name(name) => {
                let end = self.rest[if words[2] == ":" { 3 } else { 2 }].start;
                let kind = kind_of_joint(kind);
                let edit = self.edit(self.at..end, &format!("joint {name}: {kind}"));
                Some(Foreign::change(format!("a joint is declared by `joint {name}: {kind}(…)`"), vec![edit]))
            }
            [kind, "(", ..] if JointSpec::named(kind).is_some() => {
                Some(Correction::Words(format!("a joint is declared by `joint NAME: {kind}(…)`")))
            }
            [_, ":" | "=", _, ..] => self.keyword_by_value(&words),
            [name, "{"] | [name, "{", ..] if self.begins_large() => {
                let edit = self.edit(self.at..self.at, "body ");
                Some(Foreign::change(format!("a body is declared by `body {name} {{`"), vec![edit]))
            }
            [_, _] => {
                let synonym = Synonym::of(Position::Declaration, self.found)?;
                synonym.means.is_empty().then(|| Correction::Words(synonym.message(&[])))
            }
            _ => None,
        }
    }

    /// Suggests the keyword of a named value by what follows the name.
    fn keyword_by_value(&self, words: &[&str]) -> Option<Correction> {
        let [name, separator, first, behind @ ..] = words else { return None };
        let has_value = *separator == "=";
        let keyword = match self.begins_large() {
            false if has_value && *first == "(" => "point",
            true if has_value && ["spline", "periodic"].contains(first) => "table",
            true if has_value && holds_quantity(&self.rest) => "measure",
            true if has_value => "param",
            true if behind.contains(&"=") && behind.contains(&"t") => "driver",
            true if behind.contains(&"=") => "constraint",
            true if is_joint(first) => "joint",
            _ => return None,
        };
        let separator = if has_value { " =" } else { ":" };
        let edit = self.edit(self.at..self.at, &format!("{keyword} "));
        Some(Foreign::change(format!("a {keyword} is declared by `{keyword} {name}{separator} …`"), vec![edit]))
    }

    /// Suggests a kind for a joint without one, or `driver`/`constraint` for an equation: `joint j: (…)`, `joint j: distance(…) = …`.
    pub(super) fn missing_joint_kind(&self, keyword: &str) -> Option<Correction> {
        let [joint, name, colon, ..] = self.before.as_slice() else { return None };
        if keyword != "joint" || colon.text != ":" {
            return None;
        }
        if self.found == "(" && self.before.len() == 3 {
            let message =
                format!("a joint has a kind: `joint {}: revolute(…)`; `mechc explain joints` has them all", name.text);
            return Some(Correction::Words(message));
        }
        if self.found != "=" || self.before.len() == 3 {
            return None;
        }
        let has_time = self.rest.iter().any(|token| token.text == "t");
        let instead = if has_time { "driver" } else { "constraint" };
        let edit = self.edit(joint.start..joint.end(), instead);
        Some(Foreign::change(format!("an equation is a `{instead}`: `{instead} {}: …`", name.text), vec![edit]))
    }

    fn begins_large(&self) -> bool {
        [Rule::param, Rule::kw_param].iter().any(|rule| self.expects(*rule))
    }

    fn begins_feature(&self) -> bool {
        [Rule::point, Rule::kw_point].iter().any(|rule| self.expects(*rule))
    }

    fn is_first_on_its_line(&self) -> bool {
        let before = self.text[..self.at].trim_end();
        before.ends_with(['{', '}']) || self.text[before.len()..self.at].contains('\n')
    }

    /// Returns the form of the declaration if a word of it is expected outside of all brackets.
    pub(super) fn form(&self) -> Option<String> {
        let keyword = Keyword::named(self.before.first()?.text)
            .filter(|keyword| keyword.begins_declaration() || keyword.role == Role::Opener)?;
        let is_of_the_form = |rule: &Rule| {
            matches!(
                rule,
                Rule::equals | Rule::colon | Rule::open | Rule::left | Rule::at | Rule::along | Rule::to | Rule::radius
            ) || matches!(rule, Rule::from | Rule::every | Rule::spline | Rule::periodic)
        };
        let is_block = keyword.role == Role::Declaration && self.before.iter().any(|token| token.text == "{");
        let is_wanted = self.expected.iter().any(is_of_the_form)
            && self.is_outside_of_brackets()
            && !is_block
            && (self.before.len() > 1 || keyword.word.name == "analysis");
        (is_wanted && !self.found.is_empty()).then(|| format!("it is written {}", keyword.word.written()))
    }
}

fn is_joint(word: &str) -> bool {
    JointSpec::named(word).is_some() || Synonym::of(Position::Joint, word).is_some()
}

/// Returns the language's name for a kind of joint.
fn kind_of_joint(word: &str) -> &str {
    Synonym::of(Position::Joint, word).and_then(|synonym| synonym.means.first().copied()).unwrap_or(word)
}
