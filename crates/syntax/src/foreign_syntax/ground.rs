//! `ground` in place of one of its features.

use super::{Correction, Foreign, is_name};
use crate::keywords::begins_declaration;
use crate::lexer::{Token, tokens};
use mechc_text::vocabulary::is_feature;

impl Foreign<'_> {
    /// Corrects `x(ground)`, `ground O`, `ground->O`.
    pub(super) fn ground_feature(&self) -> Option<Correction> {
        let ground = self.here();
        if self.found != "ground" || begins_declaration(self.text, ground.clone()) {
            return None;
        }
        let words: Vec<&str> = self.rest.iter().map(|token| token.text).take(4).collect();
        let feature = match words[..] {
            [_, "-", ">", feature, ..] | [_, ":", ":", feature] => Some((feature, 3)),
            [_, feature, ..] => Some((feature, 1)),
            _ => None,
        };
        if let Some((feature, k)) = feature.filter(|(feature, _)| is_name(feature)) {
            let dot = self.edit(ground.end..self.rest[k].start, ".");
            return Some(Foreign::change(
                format!("what belongs to the ground is written `ground.{feature}`"),
                vec![dot],
            ));
        }
        let features = self.features_of_the_ground();
        Some(match features[..] {
            [] => Correction::Words("name one of its features: `ground.…`".to_owned()),
            [only] => {
                let edit = self.edit(self.at..ground.end, &format!("ground.{only}"));
                Foreign::change(format!("name one of its features: `ground.{only}`"), vec![edit])
            }
            _ => {
                let names: Vec<String> = features.iter().take(4).map(|name| format!("`ground.{name}`")).collect();
                Correction::Words(format!("name one of its features: {}", names.join(", ")))
            }
        })
    }

    /// Returns the names of the ground's features, in order.
    fn features_of_the_ground(&self) -> Vec<&str> {
        let all = tokens(self.text);
        let is_head = |pair: &[Token<'_>]| pair[0].text == "ground" && pair[1].text == "{";
        let Some(start) = all.windows(2).position(is_head) else { return Vec::new() };
        let inside: Vec<&str> =
            all[start + 2..].iter().map(|token| token.text).take_while(|word| *word != "}").collect();
        inside.windows(2).filter(|pair| is_feature(pair[0]) && is_name(pair[1])).map(|pair| pair[1]).collect()
    }
}
