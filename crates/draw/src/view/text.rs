//! Numbers and words in marked-up text.

use std::borrow::Cow;

/// Formats a number with at most `decimals` decimals, without trailing zeros.
#[must_use]
pub fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Escapes a text for use between tags and in attributes, and removes characters that XML forbids.
#[must_use]
pub fn escape(text: &str) -> Cow<'_, str> {
    let is_plain = |c: char| !matches!(c, '&' | '<' | '>' | '"' | '\'') && !is_forbidden(c);
    if text.chars().all(is_plain) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars().filter(|c| !is_forbidden(*c)) {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    Cow::Owned(escaped)
}

/// Splits a text into its first sentence and the rest. A full stop after an initial, as in `D. Stewart`, ends no sentence.
#[must_use]
pub fn first_sentence(text: &str) -> (&str, &str) {
    let text = text.trim();
    let ends = text.char_indices().filter(|(_, c)| matches!(c, '.' | '!' | '?')).map(|(at, _)| at + 1);
    let is_end = |end: &usize| {
        let word = text[..end - 1].rsplit(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
        let is_initial = word.chars().count() == 1 && word.chars().all(char::is_uppercase);
        text[*end..].starts_with(char::is_whitespace) && !is_initial
    };
    let (first, rest) = text.split_at(ends.into_iter().find(is_end).unwrap_or(text.len()));
    (first, rest.trim_start())
}

fn is_forbidden(c: char) -> bool {
    (c < ' ' && !matches!(c, '\t' | '\n' | '\r')) || matches!(c, '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::{decimal, escape, first_sentence};

    #[test]
    fn sentences_end_at_full_stops() {
        for (text, expected) in [
            ("A crank. It turns.", ("A crank.", "It turns.")),
            (" One of D. Stewart's, at 0.5 m/s.\nMore. ", ("One of D. Stewart's, at 0.5 m/s.", "More.")),
            ("no end", ("no end", "")),
            ("Does it turn? Yes", ("Does it turn?", "Yes")),
            ("", ("", "")),
        ] {
            assert_eq!(first_sentence(text), expected, "{text}");
        }
    }

    #[test]
    fn numbers_are_short() {
        for (value, decimals, expected) in [
            (1.0, 2, "1"),
            (-0.001, 2, "0"),
            (0.5, 3, "0.5"),
            (1234.5678, 2, "1234.57"),
            (100.0, 0, "100"),
            (-0.25, 1, "-0.2"),
        ] {
            assert_eq!(decimal(value, decimals), expected);
        }
    }

    #[test]
    fn nothing_of_a_text_is_mark_up() {
        assert_eq!(
            escape("<script>\"a\" & 'b'</script>\u{1}"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;"
        );
        assert_eq!(escape("leg[2].föt"), "leg[2].föt");
    }
}
