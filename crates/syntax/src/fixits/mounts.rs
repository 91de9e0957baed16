//! Placement of a part with its words in another order, or repeated.

use super::{Fault, FixIt};
use crate::keywords::begins_declaration;
use crate::lexer::tokens;

/// Words behind the bindings of a part, in their order.
const WORDS: [&str; 3] = ["on", "at", "mirrored"];

impl Fault<'_> {
    /// Corrects `part leg: jansen_leg() at (0, 0, 0) on chassis`.
    pub(super) fn mount_order(&self) -> Option<FixIt> {
        if !WORDS.contains(&self.found) {
            return None;
        }
        let before = tokens(&self.text[..self.at]);
        let is_part = |k: usize| {
            before[k].text == "part" && before.get(k + 2).is_some_and(|token| [":", "["].contains(&token.text))
        };
        let declaration =
            (0..before.len()).rfind(|&k| is_part(k) || begins_declaration(self.text, before[k].range()))?;
        let inside = &before[declaration..];
        let count = |bracket: &str| inside.iter().filter(|token| token.text == bracket).count();
        let is_behind_bindings = count("(") > 0 && count("(") == count(")");
        (inside[0].text == "part" && is_behind_bindings).then(|| {
            FixIt::words("`on`, `at` and `mirrored` stand in this order, each once: `on BODY at (x, y, phi) mirrored`")
        })
    }
}
