//! Masses, gravity and loads with a superfluous name or sign, in another order, or without their target.

use super::{Correction, Foreign, is_name};
use crate::grammar::Rule;
use crate::lexer::Token;
use mechc_text::vocabulary::{QuantityWord, Unit};

impl Foreign<'_> {
    pub(super) fn force_declaration(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        match keyword {
            "mass" | "gravity" if ["=", ":"].contains(&self.found) && self.before.len() == 1 => {
                let value = self.rest.get(1)?.start;
                let written = format!("{keyword} {}", &self.text[value..self.end()]);
                let edit = self.edit(last.end()..value, " ");
                Some(Foreign::change(format!("it is written without `{}`: `{written}`", self.found), vec![edit]))
            }
            "mass" => self.mass_declaration(),
            // `gravity 0, -9.81 m/s^2`
            "gravity" if self.found == "," && self.is_outside_of_brackets() => {
                let (start, end) = (self.before.get(1)?.start, self.end());
                let message = format!("gravity is a pair in parentheses: `gravity ({})`", &self.text[start..end]);
                Some(Foreign::change(message, vec![self.edit(start..start, "("), self.edit(end..end, ")")]))
            }
            "load" => self.load_declaration(),
            _ => None,
        }
    }

    fn mass_declaration(&self) -> Option<Correction> {
        match (self.found, self.rest.get(1)?) {
            // `mass flywheel: 5 kg`
            (":", value) if self.before.len() == 2 => {
                let edit = self.edit(self.before[1].start..value.start, "");
                Some(Foreign::change("a mass has no name".to_owned(), vec![edit]))
            }
            // `mass 5 kg, inertia 1 kg*m^2`
            (",", next) if ["at", "inertia"].contains(&next.text) => {
                let message = "what a mass is said of stands behind it without commas".to_owned();
                Some(Foreign::change(message, vec![self.edit(self.at..self.at + 1, "")]))
            }
            ("at", _) => self.position_behind_inertia(),
            // `mass 5 kg (0, 0)`
            ("(", _) if self.expects(Rule::at) => {
                let message = "the place of a mass stands behind `at`: `mass M at (x, y)`".to_owned();
                Some(Foreign::change(message, vec![self.edit(self.at..self.at, "at ")]))
            }
            (word, _) => {
                let (_, keyword) = WORDS_OF_MASSES.iter().find(|(words, _)| words.contains(&word))?;
                let message = format!("was `{keyword}` meant?");
                Some(Foreign::change(message, vec![self.edit(self.at..self.at + word.len(), keyword)]))
            }
        }
    }

    /// Corrects `mass 5 kg inertia 1 kg*m^2 at (0, 0)`.
    fn position_behind_inertia(&self) -> Option<Correction> {
        let inertia = self.before.iter().find(|token| token.text == "inertia")?;
        // a pair, or a point's name
        let end = match self.rest.iter().position(|token| token.text == ")") {
            Some(end) => self.rest.get(end)?.end(),
            None => self.rest.get(1).filter(|token| is_name(token.text))?.end(),
        };
        let place = &self.text[self.at..end];
        let inertia_only = self.text[inertia.start..self.at].trim_end();
        let edit = self.edit(inertia.start..end, &format!("{place} {inertia_only}"));
        let message = "the place of a mass stands before its inertia: `mass M at (x, y) inertia I`".to_owned();
        Some(Foreign::change(message, vec![edit]))
    }

    fn load_declaration(&self) -> Option<Correction> {
        // `load: 20 N on x(P)`
        if self.found == ":" && self.before.len() == 1 {
            let load = &self.text[self.rest.get(1)?.start..self.end()];
            return Some(Correction::Words(format!("a load needs a name: `load NAME: {load}`")));
        }
        let (colon, first) = self.before.iter().zip(self.before.get(1..)?).find(|(token, _)| token.text == ":")?;
        let written = self.text[colon.end()..self.at].trim();
        // `load push: x(arm.tip) = 20 N`
        if self.found == "=" && QuantityWord::named(first.text).is_some() {
            let value = self.rest.get(1)?.start..self.end();
            let load = format!("{} on {written}", &self.text[value.clone()]);
            let message = format!("a load says how much, and on what it works: `{load}`");
            return Some(Foreign::change(message, vec![self.edit(first.start..value.end, &load)]));
        }
        // `load push: 20 N at arm.tip`
        let is_joined = is_name(self.found) && Unit::named(self.found).is_none() && self.expects(Rule::kw_on);
        (is_joined || self.found == "=").then(|| {
            let on = "what a load works on stands behind `on`: `20 N on x(P)`, `3 N*m on rotation(J)`";
            Correction::Words(on.to_owned())
        })
    }
}

/// Words of other programs for the centre and inertia of a mass.
const WORDS_OF_MASSES: [(&[&str], &str); 2] = [
    (&["center", "centre", "com", "cog", "cg", "CG", "COM", "centroid"], "at"),
    (&["I", "J", "Ixx", "Iyy", "Izz", "izz", "IZZ", "moment", "moment_of_inertia"], "inertia"),
];
