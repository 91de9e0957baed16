//! Options of the command line in messages. A message names an option between backticks, as it is typed: `` `--set rod=80mm` ``. A front end
//! that takes options in another form, such as keyword arguments, spells them in its own words.

use super::{Diagnostic, Fix};

/// An option that a message names.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct OptionText<'t> {
    /// Its name without hyphens before it: `set`.
    pub name: &'t str,
    /// Its value, without quotes of the shell: `rod=80mm`; empty if the message names the option alone.
    pub value: &'t str,
}

impl Diagnostic {
    /// Replaces the options in all texts, each group of options between backticks by what `spell` returns for it.
    #[must_use]
    pub fn with_options_spelled(mut self, spell: impl Fn(&[OptionText<'_>]) -> String) -> Diagnostic {
        let labels = self.labels.iter_mut().map(|label| &mut label.text);
        let fixes = self.fixes.iter_mut().map(|Fix { message, .. }| message);
        let texts = labels.chain(fixes).chain(&mut self.notes).chain(&mut self.help).chain([&mut self.message]);
        for text in texts.filter(|text| text.contains("`--")) {
            let mut parts: Vec<String> = text.split('`').map(str::to_owned).collect();
            // every second part is between backticks
            for part in parts.iter_mut().skip(1).step_by(2).filter(|part| part.starts_with("--")) {
                *part = spell(&options_in(part));
            }
            *text = parts.join("`");
        }
        self
    }
}

/// Splits a command line's options, which begins with one: `--from T --set 'A=(1mm, 0)'`.
fn options_in(text: &str) -> Vec<OptionText<'_>> {
    let is_start = |&(at, _): &(usize, &str)| {
        let is_separate = at == 0 || text[..at].ends_with(char::is_whitespace);
        is_separate
            && text[..at].matches('\'').count().is_multiple_of(2)
            && text[at + 2..].starts_with(|c: char| c.is_ascii_lowercase())
    };
    let starts: Vec<usize> = text.match_indices("--").filter(is_start).map(|(at, _)| at).collect();
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    let option = |(start, end): (&usize, usize)| {
        let option = text[start + 2..end].trim_end();
        let length = option.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(option.len());
        let (name, value) = option.split_at(length);
        let value = value.trim_start_matches(['=', ' ']);
        OptionText { name, value: value.strip_prefix('\'').and_then(|value| value.strip_suffix('\'')).unwrap_or(value) }
    };
    starts.iter().zip(ends).map(option).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Code;

    fn spelled(text: &str) -> String {
        let spell = |options: &[OptionText<'_>]| {
            options.iter().map(|option| format!("{}({})", option.name, option.value)).collect::<Vec<_>>().join(" ")
        };
        Diagnostic::new(Code::E0706, text).with_options_spelled(spell).message
    }

    #[test]
    fn options_between_backticks_are_spelled_anew() {
        for (text, expected) in [
            ("run it with `--lead`", "run it with `lead()`"),
            ("`--from T --to 2 s`, or `--at T`", "`from(T) to(2 s)`, or `at(T)`"),
            ("`--set 'A=(1mm, 0)'` moves `A`", "`set(A=(1mm, 0))` moves `A`"),
            ("`--vary=rod=1mm..2mm:3`", "`vary(rod=1mm..2mm:3)`"),
            ("`--result 'd = a --b' --to 1`", "`result(d = a --b) to(1)`"),
            ("`a --b` and --set stay", "`a --b` and --set stay"),
            ("an open ` and `--to", "an open ` and `--to"),
        ] {
            assert_eq!(spelled(text), expected);
        }
    }
}
