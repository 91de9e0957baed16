//! The syntactic context of the cursor, from the tokens before it: the text is unfinished and need not follow the grammar.

use crate::lexical::{LexicalContext, lexical_context};
use mechc_syntax::{LexemeKind, Token, begins_declaration, is_word_char, tokens};
use mechc_text::vocabulary::{Dimension, Keyword, Unit, is_feature};
use std::ops::Range;

/// The kind of block around the cursor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Block {
    File,
    Mechanism,
    Features,
}

/// A call that is open before the cursor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Call<'t> {
    /// The name of the callee; empty for plain parentheses and `[` for brackets.
    pub name: &'t str,
    /// The index of the argument at the cursor.
    pub argument: usize,
    /// The index of the token of its parenthesis.
    pub open: usize,
}

/// An unfinished compound unit: `90 deg/`.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct PartialUnit {
    /// The dimensions of its units, last one first.
    pub dimensions: Vec<Dimension>,
}

/// The cursor with the tokens before it.
pub(super) struct Cursor<'t> {
    pub text: &'t str,
    /// The word under the cursor, which may be empty; in a string its whole content.
    pub word: Range<usize>,
    pub is_in_string: bool,
    /// The tokens before the word.
    tokens: Vec<Token<'t>>,
    /// The index of the declaration's first token.
    first: usize,
    pub block: Block,
}

impl<'t> Cursor<'t> {
    /// Analyses the text before an offset; `None` in a comment.
    pub fn new(text: &'t str, offset: usize) -> Option<Cursor<'t>> {
        let context = lexical_context(text.get(..offset)?, offset);
        let mut word = word_at(text, offset);
        let mut end = word.start;
        match context {
            LexicalContext::Code => {}
            LexicalContext::Comment => return None,
            LexicalContext::String(quote) => {
                let rest = &text[offset..];
                word = quote + 1..offset + rest.find(['"', '\n', '\r']).unwrap_or(rest.len());
                end = quote;
            }
        }
        let tokens = tokens(&text[..end]);
        let (first, block) = declaration(&text[..end], &tokens);
        Some(Cursor { text, word, is_in_string: matches!(context, LexicalContext::String(_)), tokens, first, block })
    }

    /// Returns the tokens of the declaration.
    pub fn declaration(&self) -> &[Token<'t>] {
        &self.tokens[self.first..]
    }

    /// Returns the start of the declaration; that of the word, if the word may begin a new one.
    pub fn start(&self) -> usize {
        let first = self.declaration().first().filter(|_| !self.may_begin());
        first.map_or(self.word.start, |token| token.start)
    }

    /// Returns whether the word may begin a declaration, because the one before can end there.
    pub fn may_begin(&self) -> bool {
        let can_end = || self.is_first_on_line() && self.is_behind_operand() && self.call().is_none();
        self.head().is_empty() || can_end()
    }

    /// Returns the keyword of the declaration.
    pub fn head(&self) -> &'t str {
        self.declaration().first().map_or("", |token| token.text)
    }

    /// Returns the last token of the declaration before the cursor.
    pub fn last(&self) -> Option<&'t str> {
        self.declaration().last().map(|token| token.text)
    }

    /// Returns whether the declaration contains a word outside parentheses.
    pub fn has(&self, word: &str) -> bool {
        let mut depth = 0_usize;
        self.declaration().iter().any(|token| {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0 && token.text == word
        })
    }

    /// Returns whether an operand ends before the cursor, so that only an operator or keyword may follow.
    pub fn is_behind_operand(&self) -> bool {
        self.declaration().last().is_some_and(|last| {
            let joins = Keyword::named(last.text).is_some_and(|keyword| keyword.is_joining() || keyword.is_reserved());
            matches!(last.text, ")" | "]") || last.kind != LexemeKind::Sign && !joins
        })
    }

    /// Returns whether the last token is a number.
    pub fn is_behind_number(&self) -> bool {
        self.declaration().last().is_some_and(|last| last.kind == LexemeKind::Number)
    }

    /// Returns whether the word is the first of its line or block.
    pub fn is_first_on_line(&self) -> bool {
        let before = self.text[..self.word.start].trim_end_matches([' ', '\t']);
        before.is_empty() || before.ends_with(['\n', '{', '}'])
    }

    /// Returns the innermost open parenthesis or bracket.
    pub fn call(&self) -> Option<Call<'t>> {
        let (mut depth, mut argument) = (0_usize, 0);
        for at in (self.first..self.tokens.len()).rev() {
            match self.tokens[at].text {
                ")" | "]" => depth += 1,
                "(" | "[" if depth > 0 => depth -= 1,
                "[" => return Some(Call { name: "[", argument, open: at }),
                "(" => {
                    let before =
                        at.checked_sub(1).filter(|before| *before >= self.first).map(|at| self.tokens[at].text);
                    let is_name = |name: &&str| name.starts_with(|c: char| c.is_alphabetic() || c == '_');
                    let name =
                        before.filter(is_name).filter(|name| Keyword::named(name).is_none_or(|it| !it.is_joining()));
                    return Some(Call { name: name.unwrap_or_default(), argument, open: at });
                }
                "," if depth == 0 => argument += 1,
                _ => {}
            }
        }
        None
    }

    /// Returns the last `from` or `to` in the window of a call before the cursor.
    pub fn window(&self, call: Call<'_>) -> Option<&'t str> {
        let (mut depth, mut found, mut before) = (0_usize, None, "");
        for token in self.tokens.get(call.open + 1..).unwrap_or_default() {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth = depth.saturating_sub(1),
                "," if depth == 0 => found = None,
                "from" if depth == 0 && before == "," => found = Some(token.text),
                "to" if depth == 0 && (before == "," || found.is_some()) => found = Some(token.text),
                _ => {}
            }
            before = token.text;
        }
        found
    }

    /// Returns the unfinished unit at the cursor, after a number or after the `in` of a printed quantity. A `/` after a space divides
    /// formulas instead.
    pub fn unit(&self) -> Option<PartialUnit> {
        let tokens = self.declaration();
        let mut at = tokens.len().checked_sub(1)?;
        let has_space = self.text[..self.word.start].ends_with(char::is_whitespace)
            || self.text[..tokens[at].start].ends_with(char::is_whitespace);
        let mut dimensions = Vec::new();
        while matches!(tokens[at].text, "/" | "*") {
            at = at.checked_sub(1)?;
            if at > 1 && tokens[at - 1].text == "^" {
                at -= 2;
            }
            match tokens[at].text {
                // as in `in 1/s`
                "1" => at = at.checked_sub(1)?,
                unit => {
                    dimensions.push(Unit::named(unit)?.dimension);
                    at = at.checked_sub(1)?;
                }
            }
        }
        let is_printed = tokens[at].text == "in" && matches!(self.head(), "measure" | "trace" | "result");
        let is_of_number = tokens[at].kind == LexemeKind::Number && self.last() == Some("/");
        let begins =
            !dimensions.is_empty() && (is_printed || is_of_number && !has_space) || is_printed && at + 1 < tokens.len();
        begins.then_some(PartialUnit { dimensions })
    }

    /// Returns the names before the dot at the cursor, without indices; `None` without a dot.
    pub fn path(&self) -> Option<Vec<&'t str>> {
        let tokens = self.declaration();
        let mut at = tokens.len().checked_sub(1).filter(|last| tokens[*last].text == ".")?;
        let mut names = Vec::new();
        loop {
            at = at.checked_sub(1)?;
            if tokens[at].text == "]" {
                at = tokens[..at].iter().rposition(|token| token.text == "[")?.checked_sub(1)?;
            }
            names.push(tokens[at].text);
            match at.checked_sub(1).filter(|before| tokens[*before].text == ".") {
                Some(before) => at = before,
                None => break,
            }
        }
        names.reverse();
        Some(names)
    }

    /// Returns the complete arguments of a call before the cursor.
    pub fn arguments(&self, call: Call<'t>) -> Vec<&'t str> {
        let (mut depth, mut from, mut found) = (0_usize, self.tokens[call.open].end(), Vec::new());
        for token in &self.tokens[call.open + 1..] {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth = depth.saturating_sub(1),
                "," if depth == 0 => {
                    found.push(self.text[from..token.start].trim());
                    from = token.end();
                }
                _ => {}
            }
        }
        found
    }

    /// Returns the token at a distance before the cursor; 1 is the last one.
    pub fn back(&self, count: usize) -> Option<&'t str> {
        let tokens = self.declaration();
        tokens.len().checked_sub(count).map(|at| tokens[at].text)
    }
}

/// Returns the word around an offset; digits before it are a number and not part of it.
pub(super) fn word_at(text: &str, offset: usize) -> Range<usize> {
    let is_part = |c: &char| is_word_char(*c);
    let before = text[..offset].chars().rev().take_while(is_part).map(char::len_utf8).sum::<usize>();
    let behind = text[offset..].chars().take_while(is_part).map(char::len_utf8).sum::<usize>();
    let digits = text[offset - before..offset].chars().take_while(char::is_ascii_digit).count();
    let start = offset - before + digits;
    start..if digits == before && digits > 0 { offset } else { offset + behind }
}

/// Returns the index of the first token of the last declaration, and the block that it is in.
fn declaration(text: &str, tokens: &[Token<'_>]) -> (usize, Block) {
    let (mut blocks, mut first, mut head) = (Vec::new(), 0, "");
    for (at, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => {
                blocks.push(if head == "mechanism" { Block::Mechanism } else { Block::Features });
                (first, head) = (at + 1, "");
            }
            "}" => {
                blocks.pop();
                (first, head) = (at + 1, "");
            }
            word if begins(text, tokens, at) => {
                match blocks.last() {
                    _ if word == "mechanism" || word == "use" => blocks.clear(),
                    // the declaration cannot be in a body, so the brace of that is missing
                    Some(Block::Features) if !is_feature(word) => drop(blocks.pop()),
                    _ => {}
                }
                (first, head) = (at, word);
            }
            _ => {}
        }
    }
    (first, blocks.last().copied().unwrap_or(Block::File))
}

fn begins(text: &str, tokens: &[Token<'_>], at: usize) -> bool {
    let token = tokens[at];
    if begins_declaration(text, token.range()) {
        return true;
    }
    let is_opener = Keyword::named(token.text).is_some_and(|keyword| keyword.role.is_opener());
    let before = text[..token.start].trim_end_matches([' ', '\t']);
    let is_operand =
        at > 0 && tokens[at - 1].text.ends_with(['(', '[', ',', '=', '+', '-', '*', '/', '^', '<', '>', ':']);
    is_opener && !is_operand && (before.is_empty() || before.ends_with(['\n', '{', '}']))
}

#[cfg(test)]
mod tests {
    use super::{Block, Cursor};

    #[test]
    fn the_declaration_around_a_cursor_is_found() {
        let of = |text: &str| {
            let at = text.find('‸').expect("a cursor");
            let text = text.replacen('‸', "", 1);
            let cursor = Cursor::new(&text, at)?;
            Some((
                cursor.head().to_owned(),
                cursor.block,
                text[cursor.word.clone()].to_owned(),
                cursor.declaration().len(),
            ))
        };
        let some = |head: &str, block, word: &str, count| Some((head.to_owned(), block, word.to_owned(), count));
        assert_eq!(of("mechanism m { param l = 5 ‸"), some("param", Block::Mechanism, "", 4));
        assert_eq!(of("mechanism m { param l = 5m‸m"), some("param", Block::Mechanism, "mm", 4));
        assert_eq!(of("mechanism m {\n body b { point P = (1, ‸"), some("point", Block::Features, "", 6));
        assert_eq!(of("mechanism m {\n body b {\n joint j: rev‸\n"), some("joint", Block::Mechanism, "rev", 3));
        assert_eq!(of("mechanism m {\n ground { point O = ground‸"), some("point", Block::Features, "ground", 3));
        assert_eq!(of("mechanism m { // param ‸"), None);
        assert_eq!(of("use \"le‸v\""), some("use", Block::File, "lev", 1));
        assert_eq!(of("mech‸"), some("", Block::File, "mech", 0));
    }

    #[test]
    fn calls_and_paths_are_those_before_the_cursor() {
        let text = "mechanism m { measure x1 = max(a, rotation(k[1, 2].b.";
        let cursor = Cursor::new(text, text.len()).expect("no comment");
        assert_eq!(cursor.path(), Some(vec!["k", "b"]));
        assert_eq!(cursor.call().map(|call| (call.name, call.argument)), Some(("rotation", 0)));
        let text = "mechanism m { joint j: revolute(a.B, b";
        let cursor = Cursor::new(text, text.len()).expect("no comment");
        let call = cursor.call().expect("a call");
        assert_eq!((call.argument, cursor.arguments(call)), (1, vec!["a.B"]));
    }
}
