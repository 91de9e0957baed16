//! The lexical context of a byte, from the tokens around it. It needs no tree, so it works in an unfinished text.

use mechc_syntax::{LexemeKind, Lexer, is_word_char, tokens};
use mechc_text::vocabulary::Keyword;
use std::ops::Range;

/// Returns whether a name contains letters in their order, regardless of case.
pub(super) fn matches_letters(name: &str, letters: &str) -> bool {
    let mut rest = name.chars().flat_map(char::to_lowercase);
    letters.chars().flat_map(char::to_lowercase).all(|expected| rest.any(|letter| letter == expected))
}

/// Returns the word that contains an offset or ends there.
pub(super) fn word_at(text: &str, offset: usize) -> Option<Range<usize>> {
    let (before, behind) = (text.get(..offset)?, text.get(offset..)?);
    let start = before.len() - before.chars().rev().take_while(|c| is_word_char(*c)).map(char::len_utf8).sum::<usize>();
    let end = offset + behind.chars().take_while(|c| is_word_char(*c)).map(char::len_utf8).sum::<usize>();
    (start < end).then_some(start..end)
}

/// Returns the names of a path up to a word, each with its indices as they are written: `link[0].pin` gives `link` with `[0]`, and `pin`.
/// There is at least one name.
pub(super) fn path_at(text: &str, word: &Range<usize>) -> Vec<(String, String)> {
    let mut path = vec![(text[word.clone()].to_owned(), String::new())];
    let mut rest = &text[..word.start];
    while let Some(before) = rest.trim_end().strip_suffix('.') {
        let (numbers, before) = split_indices(before);
        let name = word_at(before, before.len()).map(|range| before[range.start..].to_owned());
        let Some(name) = name else { break };
        rest = &before[..before.len() - name.len()];
        path.push((name, numbers));
    }
    path.reverse();
    path
}

/// Splits the indices off the end of a text; returns them with their brackets, and the rest.
fn split_indices(text: &str) -> (String, &str) {
    let open = text.ends_with(']').then(|| text.rfind('[')).flatten();
    open.map_or((String::new(), text), |open| (text[open..].to_owned(), &text[..open]))
}

/// The kind of text around a byte.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum LexicalContext {
    Code,
    Comment,
    /// A string, with the byte of its opening quote.
    String(usize),
}

/// Returns the context of a byte from the part of its line before it.
pub(super) fn lexical_context(text: &str, offset: usize) -> LexicalContext {
    let before = &text[..offset];
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    let is_open = |string: &str| string.len() < 2 || !string.ends_with('"');
    match Lexer::new(before, line).last() {
        Some(token) if token.is_comment() => LexicalContext::Comment,
        Some(token) if token.kind == LexemeKind::String && is_open(token.text) => LexicalContext::String(token.start),
        _ => LexicalContext::Code,
    }
}

/// Returns whether a byte is in a comment.
pub(super) fn is_in_comment(text: &str, offset: usize) -> bool {
    lexical_context(text, offset) == LexicalContext::Comment
}

/// A call whose parenthesis is open at the cursor.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct OpenCall {
    /// The name of the callee, with its prefix: `lever`, `legs.lever`.
    pub name: String,
    /// True if the callee follows the colon of a declaration: `joint a: revolute(`.
    pub is_kind: bool,
    /// The text between its parenthesis and the cursor.
    pub inside: String,
    /// The index of the argument at the cursor.
    pub argument: usize,
}

/// Returns the innermost call around a byte.
pub(super) fn call_at(text: &str, offset: usize) -> Option<OpenCall> {
    let start = declaration_before(text, offset);
    let text = text.get(start..offset)?;
    let mut open: Vec<(Option<OpenCall>, usize)> = Vec::new();
    for token in tokens(text) {
        match token.text {
            "(" => open.push((callee(&text[..token.start]), token.end())),
            "[" => open.push((None, token.end())),
            ")" | "]" => drop(open.pop()),
            "{" | "}" => open.clear(),
            "," => {
                if let Some((Some(call), _)) = open.last_mut() {
                    call.argument += 1;
                }
            }
            _ => {}
        }
    }
    open.into_iter().rev().find_map(|(call, from)| Some(OpenCall { inside: text[from..].to_owned(), ..call? }))
}

/// Returns the start of the declaration around a byte: a line that begins with a declaration's keyword, or the start of the text.
fn declaration_before(text: &str, offset: usize) -> usize {
    let mut end = offset.min(text.len());
    loop {
        let start = text[..end].rfind('\n').map_or(0, |end| end + 1);
        let line = &text[start..];
        let first = line.trim_start().split(|c: char| !is_word_char(c)).next().unwrap_or_default();
        let begins =
            Keyword::named(first).is_some_and(|keyword| keyword.begins_declaration() || keyword.role.is_opener());
        if begins || start == 0 {
            return start;
        }
        end = start - 1;
    }
}

/// Returns the call that a parenthesis after the text of a declaration opens; `None` if it groups.
fn callee(before: &str) -> Option<OpenCall> {
    let (declaration, before) = (before.trim_start(), before.trim_end());
    let word = word_at(before, before.len())?;
    let names: Vec<String> = path_at(before, &word).into_iter().map(|(name, _)| name).collect();
    let name = names.join(".");
    let ahead = before[..before.len() - name.len().min(before.len())].trim_end();
    let first = declaration.split(|c: char| !is_word_char(c)).next().unwrap_or_default();
    let is_kind = ahead.ends_with(':') && ["joint", "part"].contains(&first);
    let is_keyword = Keyword::named(&name).is_some_and(Keyword::is_reserved)
        || Keyword::named(&name).is_some_and(Keyword::is_joining);
    // `at (x, y, phi)` is a pose, and `at(e, T)` a call
    let calls =
        !is_keyword || name == "at" && !ahead.is_empty() && ahead.ends_with(['=', '(', '+', '-', '*', '/', ',']);
    calls.then_some(OpenCall { name, is_kind, inside: String::new(), argument: 0 })
}

#[cfg(test)]
mod tests {
    use super::{call_at, is_in_comment, path_at, word_at};

    fn call(text: &str) -> String {
        let at = text.find('‸').expect("a cursor");
        let found = call_at(&text.replacen('‸', "", 1), at);
        found.map_or("none".to_owned(), |call| {
            format!("{}:{}{}", call.name, call.argument, if call.is_kind { " kind" } else { "" })
        })
    }

    #[test]
    fn the_innermost_open_call_is_found() {
        assert_eq!(call("joint a: revolute(crank.A, ‸"), "revolute:1 kind");
        assert_eq!(call("param a = max(1, hypot(2, 3), ‸"), "max:2");
        assert_eq!(call("param a = max(1, hypot(2, ‸"), "hypot:1");
        assert_eq!(call("param a = max(1, (2, ‸"), "max:1");
        assert_eq!(call("param a = max(1, 2)‸"), "none");
        assert_eq!(call("joint a: revolute(crank.A,\n    // two, three, (\n  ‸"), "revolute:1 kind");
        assert_eq!(call("param a = max(1,\nparam b = min(‸"), "min:0");
        assert_eq!(call("param a = max(1,\nparam b = ‸"), "none");
        assert_eq!(call("part p: legs.lever(turn = sin(t), ‸"), "legs.lever:1 kind");
        assert_eq!(call("body b at (1, ‸"), "none");
        assert_eq!(call("result r = at(x(b.P), ‸"), "at:1");
        assert_eq!(call("driver d[k in 0..3]: rotation(pin[max(k, ‸"), "max:1");
        assert_eq!(call("‸"), "none");
    }

    #[test]
    fn paths_are_read_backwards() {
        let path = |text: &str, at: usize| path_at(text, &word_at(text, at).expect("a word"));
        let of =
            |names: &[(&str, &str)]| names.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect::<Vec<_>>();
        assert_eq!(path("x(front.crank.A)", 8), of(&[("front", ""), ("crank", "")]));
        assert_eq!(path("link[k - 1].pin", 13), of(&[("link", "[k - 1]"), ("pin", "")]));
        assert_eq!(path("2.pin", 3), of(&[("2", ""), ("pin", "")]));
        assert_eq!(path(".pin", 3), of(&[("pin", "")]));
        assert_eq!(word_at("a  b", 2), None);
    }

    #[test]
    fn comments_begin_outside_strings() {
        assert!(is_in_comment("use \"a.mech\" // here", 18));
        assert!(!is_in_comment("use \"http://a\" x", 15));
        assert!(!is_in_comment("// a\nb", 6));
    }
}
