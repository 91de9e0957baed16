//! Masses, gravity and loads: with a name or a sign that they have none of, in another order, on what they do not say.

use super::{Intended, Intent, is_name};
use crate::syntax::grammar::Rule;
use crate::syntax::tokens::Token;
use crate::vocabulary::{QuantityWord, Unit};

impl Intent<'_> {
    pub(super) fn of_forces(&self, keyword: &str, last: &Token<'_>) -> Option<Intended> {
        match keyword {
            "mass" | "gravity" if self.found == "=" && self.before.len() == 1 => {
                let value = self.rest.get(1)?.start;
                let written = format!("{keyword} {}", &self.text[value..self.end()]);
                let edit = self.edit(last.end()..value, " ");
                Some(Intent::change(format!("it is written without `=`: `{written}`"), vec![edit]))
            }
            "mass" => self.of_a_mass(),
            "load" => self.of_a_load(),
            _ => None,
        }
    }

    fn of_a_mass(&self) -> Option<Intended> {
        match (self.found, self.rest.get(1)?) {
            // `mass flywheel: 5 kg`
            (":", value) if self.before.len() == 2 => {
                let edit = self.edit(self.before[1].start..value.start, "");
                Some(Intent::change("a mass has no name".to_owned(), vec![edit]))
            }
            // `mass 5 kg, inertia 1 kg*m^2`
            (",", next) if ["at", "inertia"].contains(&next.text) => {
                let message = "what a mass is said of stands behind it without commas".to_owned();
                Some(Intent::change(message, vec![self.edit(self.at..self.at + 1, "")]))
            }
            ("at", _) => self.of_a_place_behind_an_inertia(),
            _ => None,
        }
    }

    /// `mass 5 kg inertia 1 kg*m^2 at (0, 0)`
    fn of_a_place_behind_an_inertia(&self) -> Option<Intended> {
        let inertia = self.before.iter().find(|token| token.text == "inertia")?;
        let place = self.rest.iter().position(|token| token.text == ")").and_then(|end| self.rest.get(..=end))?;
        let (place, end) = (&self.text[self.at..place.last()?.end()], place.last()?.end());
        let inertia_only = self.text[inertia.start..self.at].trim_end();
        let edit = self.edit(inertia.start..end, &format!("{place} {inertia_only}"));
        let message = "the place of a mass stands before its inertia: `mass M at (x, y) inertia I`".to_owned();
        Some(Intent::change(message, vec![edit]))
    }

    fn of_a_load(&self) -> Option<Intended> {
        let (colon, first) = self.before.iter().zip(self.before.get(1..)?).find(|(token, _)| token.text == ":")?;
        let written = self.text[colon.end()..self.at].trim();
        // `load push: x(arm.tip) = 20 N`
        if self.found == "=" && QuantityWord::named(first.text).is_some() {
            let value = self.rest.get(1)?.start..self.end();
            let load = format!("{} on {written}", &self.text[value.clone()]);
            let message = format!("a load says how much, and on what it works: `{load}`");
            return Some(Intent::change(message, vec![self.edit(first.start..value.end, &load)]));
        }
        // `load push: 20 N at arm.tip`
        let is_joined = is_name(self.found) && Unit::named(self.found).is_none() && self.expects(Rule::kw_on);
        (is_joined || self.found == "=").then(|| {
            let on = "what a load works on stands behind `on`: `20 N on x(P)`, `3 N*m on rotation(J)`";
            Intended::Words(on.to_owned())
        })
    }
}
