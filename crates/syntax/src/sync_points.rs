//! Synchronization points: where declarations begin, judging by words and braces alone. Parsing resumes there after a fault.

use super::lexer::{LexemeKind, Token, hyphenated_at, is_word_char};
use mechc_text::diag::nearest;
use mechc_text::vocabulary::{
    JointSpec, Keyword, Position, Role, Synonym, continues_declaration, declares_name, is_ground,
};
use rustc_hash::FxHashSet;
use std::ops::Range;

/// The tokens of a text with the declarations that they may begin.
pub(super) struct SyncPoints<'a> {
    text: &'a str,
    tokens: Vec<Token<'a>>,
    /// Role of each token that is a keyword in its position.
    roles: Vec<Option<Role>>,
    /// True for tokens in the position of a declaration's name.
    names: Vec<bool>,
    /// Hyphenated names at their declarations; every use of them parses as a difference.
    hyphenated: FxHashSet<&'a str>,
}

impl<'a> SyncPoints<'a> {
    /// Finds the declarations among the tokens of a text, comments left out.
    pub fn new(text: &'a str, tokens: Vec<Token<'a>>) -> SyncPoints<'a> {
        let role = |token: &Token<'_>| Keyword::named(token.text).map(|keyword| keyword.role);
        let mut roles: Vec<Option<Role>> = tokens.iter().map(role).collect();
        for k in 0..tokens.len() {
            // elsewhere it is a name
            if roles[k].is_some_and(Role::is_opener) && !opens(&tokens, &roles, k) {
                roles[k] = None;
            }
        }
        let (mut names, mut is_name, mut takes_name) = (Vec::with_capacity(tokens.len()), false, false);
        for (token, role) in tokens.iter().zip(&roles) {
            is_name = takes_name && !is_name;
            names.push(is_name);
            takes_name = role.is_some_and(begins) && declares_name(token.text);
        }
        let declared = tokens.iter().zip(&names).filter(|(_, is_name)| **is_name);
        let hyphenated = declared.filter_map(|(token, _)| hyphenated_at(text, token.start)).collect();
        SyncPoints { text, tokens, roles, names, hyphenated }
    }

    fn role(&self, k: usize) -> Option<Role> {
        self.roles.get(k).copied().flatten()
    }

    /// Returns whether a token is the keyword of a declaration.
    fn is_declaration(&self, k: usize) -> bool {
        self.role(k).is_some_and(begins)
    }

    /// Returns whether a token is the keyword of a feature.
    pub fn is_feature(&self, k: usize) -> bool {
        matches!(self.role(k), Some(Role::Feature | Role::FeatureOpener))
    }

    /// Returns the index of the first token at or behind a byte.
    pub fn index_at(&self, byte: usize) -> usize {
        self.tokens.partition_point(|token| token.start < byte)
    }

    /// Returns the word of a token; empty behind the last one.
    pub fn word(&self, k: usize) -> &'a str {
        self.tokens.get(k).map_or("", |token| token.text)
    }

    /// Returns where a token begins; the end of the text behind the last one.
    pub fn start(&self, k: usize) -> usize {
        self.tokens.get(k).map_or(self.text.len(), |token| token.start)
    }

    /// Returns where the text before a token ends, without white space and comments.
    pub fn end_before(&self, k: usize) -> usize {
        k.checked_sub(1).and_then(|k| self.tokens.get(k)).map_or(0, Token::end)
    }

    /// Returns the end of a token.
    pub fn end(&self, k: usize) -> usize {
        self.tokens.get(k).map_or(self.text.len(), Token::end)
    }

    /// Returns the tokens of a range of indices, as far as there are any.
    pub fn tokens(&self, range: Range<usize>) -> &[Token<'a>] {
        let end = range.end.min(self.tokens.len());
        &self.tokens[range.start.min(end)..end]
    }

    /// Returns the bytes of the lines that hold a range of tokens, with the line ends around them.
    pub fn lines_of(&self, tokens: Range<usize>) -> Range<usize> {
        let end = self.end(tokens.end.saturating_sub(1));
        let start = self.text[..self.start(tokens.start)].rfind('\n').unwrap_or(0);
        start..self.text[end..].find('\n').map_or(self.text.len(), |at| end + at)
    }

    /// Returns the byte range of a token.
    pub fn range(&self, k: usize) -> Range<usize> {
        self.start(k)..self.end(k)
    }

    /// Returns whether a token begins a `use`: the word, which may also be a name, before a string or at the beginning of a line.
    pub fn begins_use(&self, k: usize) -> bool {
        self.word(k) == "use" && (self.string_behind(k).is_some() || self.is_first_on_its_line(k))
    }

    /// Returns the string right behind a token.
    pub fn string_behind(&self, k: usize) -> Option<Token<'a>> {
        self.tokens.get(k + 1).copied().filter(|token| token.text.starts_with('"'))
    }

    /// Returns where a `use` ends: at the next one, at a mechanism, or with its line, unless the next line continues it.
    pub fn end_of_use(&self, k: usize) -> usize {
        let goes_on = |next: usize| {
            let is_prefix = self.word(next - 1) == "as" && self.string_behind(next).is_none();
            self.word(next) == "as" || self.word(next).starts_with('"') || is_prefix
        };
        let is_next = |next: usize| self.is_first_on_its_line(next) || self.begins_use(next);
        let ends = |&next: &usize| self.word(next) == "mechanism" || is_next(next) && !goes_on(next);
        (k + 1..self.tokens.len()).find(ends).unwrap_or(self.tokens.len())
    }

    pub fn is_behind_the_last(&self, k: usize) -> bool {
        k >= self.tokens.len()
    }

    /// Returns where a declaration without a block ends that begins at a token: at the next keyword that begins one, or at the brace that
    /// closes the enclosing block.
    ///
    /// A declaration that follows the grammar never continues beyond.
    pub fn end_of_plain(&self, k: usize) -> usize {
        let ends = |k: usize| matches!(self.word(k), "{" | "}") || self.is_keyword(k) && !self.is_inside(k);
        (k + 1..self.tokens.len()).find(|&k| ends(k)).unwrap_or(self.tokens.len())
    }

    /// Returns the token at which parsing resumes after a fault in the declaration that begins at a token: the next declaration, or the end
    /// of the enclosing block. Braces in between are skipped.
    pub fn sync_token(&self, k: usize) -> usize {
        let mut depth = 0_usize;
        for next in k..self.tokens.len() {
            match self.word(next) {
                "{" => depth += 1,
                "}" if depth == 0 => return next,
                "}" => depth -= 1,
                _ if depth == 0 && next > k && self.begins_declaration(next) => return next,
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// Returns the brace that opens the block of a declaration whose head has a fault, if it has one.
    pub fn block_behind(&self, k: usize) -> Option<usize> {
        (k + 1..self.tokens.len())
            .take_while(|&next| self.word(next) != "}" && !self.begins_declaration(next))
            .find(|&next| self.word(next) == "{")
    }

    /// Returns where the declarations of the mechanism whose block begins at a token may be parted, every `size` tokens or more.
    pub fn cuts(&self, first: usize, size: usize) -> Vec<usize> {
        let (mut cuts, mut next, mut depth) = (vec![first], first + size, 0_usize);
        for (k, token) in self.tokens.iter().enumerate().skip(first) {
            match token.text {
                "{" => depth += 1,
                "}" if depth == 0 => break,
                "}" => depth -= 1,
                "mechanism" => break,
                _ if depth == 0 && k >= next && self.begins_large_declaration(k) => {
                    cuts.push(k);
                    next = k + size;
                }
                _ => {}
            }
        }
        cuts
    }

    /// Returns how many more braces are opened than closed from a token on; negative if more are closed.
    pub fn braces_from(&self, k: usize) -> isize {
        let weight = |token: &Token<'_>| isize::from(token.text == "{") - isize::from(token.text == "}");
        self.tokens.get(k..).unwrap_or_default().iter().map(weight).sum()
    }

    /// Returns the names that the declaration at a token would define: the word behind its keyword, or the first of two words.
    pub fn names_of(&self, k: usize, end: usize) -> impl Iterator<Item = Token<'a>> {
        let is_name = |token: &&Token<'a>| token.kind == LexemeKind::Word;
        // a word that is no keyword may be a name without one, `r = 3`, or a misspelt keyword before one
        let whole = |token: Token<'a>| Token { text: self.hyphenated_name(&token).unwrap_or(token.text), ..token };
        let head = (k..end.min(k + 2).min(self.tokens.len())).filter(|&k| !self.is_declaration(k));
        head.map(|k| &self.tokens[k]).filter(is_name).copied().map(whole)
    }

    /// Returns whether a token stands where the declaration before it has its name.
    pub fn is_name_of(&self, k: usize) -> bool {
        self.names.get(k).copied().unwrap_or(false)
    }

    /// Returns whether a token is a keyword that begins a declaration wherever the grammar holds.
    fn is_keyword(&self, k: usize) -> bool {
        self.is_declaration(k) && self.word(k + 1) != "."
    }

    /// Returns whether a keyword stands where only a name makes sense: within a line, and not before the continuation of its declaration.
    fn is_inside(&self, k: usize) -> bool {
        let (next, second) = (self.word(k + 1), self.word(k + 2));
        let before = if k > 0 { self.word(k - 1) } else { "" };
        // an argument on a line of its own
        let is_argument = self.word(k) == "ground" && ["(", ","].contains(&before) && next != "{" && second != "{";
        if self.is_first_on_its_line(k) {
            return is_argument;
        }
        // after a bracket or an operator a formula goes on
        let is_operand = ["on", "(", ",", "=", "+", "-", "*", "/", "^", ".", "<", ">"].contains(&before);
        self.is_name_of(k) || is_operand && !continues_declaration(self.word(k), next, second)
    }

    fn is_first_on_its_line(&self, k: usize) -> bool {
        k == 0 || begins_line(&self.tokens, k)
    }

    /// Returns whether a declaration begins at a token: by its keyword, or by a word in its place.
    pub fn begins_declaration(&self, k: usize) -> bool {
        // `ground.O` is a point, and `joint joint: …` has a keyword as its name
        if self.word(k + 1) == "." {
            return false;
        }
        if self.is_declaration(k) {
            return !self.is_inside(k);
        }
        if self.is_name_of(k) {
            return false;
        }
        let is_joining = |k: usize| matches!(self.role(k), Some(Role::Formula | Role::Separator | Role::Place));
        let is_word = |k: usize| self.word(k).starts_with(char::is_alphabetic) && !is_joining(k);
        // `30 mm` and `a.b` go on with a word
        let before = if k > 0 { self.word(k - 1) } else { "" };
        let is_behind_number =
            self.tokens(k.saturating_sub(1)..k).iter().any(|before| before.kind == LexemeKind::Number);
        if !is_word(k) || before.starts_with('.') || is_behind_number && !self.is_first_on_its_line(k) {
            return false;
        }
        let is_equation = self.word(k + 2) == "=";
        let is_block = self.word(k + 1) == "{" && ["{", "}"].contains(&before);
        let is_on_one_line = !self.is_first_on_its_line(k + 1);
        is_block
            || self.begins_without_keyword(k)
            || (is_word(k + 1) && is_on_one_line && (is_equation || [":", "{", "at"].contains(&self.word(k + 2))))
            || self.word(k + 1) == "from"
    }

    /// Returns whether a block begins at a token with a synonym of `ground`: `frame {`.
    pub fn is_ground_by_another_name(&self, k: usize) -> bool {
        let word = self.word(k);
        self.role(k).is_none() && self.word(k + 1) == "{" && (is_ground(word) || nearest(word, ["ground"]).is_some())
    }

    /// Returns whether a line begins like a declaration behind its keyword: `r = 3`, `j: revolute(…)`; or with the kind of a joint.
    fn begins_without_keyword(&self, k: usize) -> bool {
        let [next, second] = [self.word(k + 1), self.word(k + 2)];
        let is_joint = JointSpec::named(self.word(k)).is_some();
        let is_named_joint = second == "(" && (is_joint || Synonym::of(Position::Joint, self.word(k)).is_some());
        self.is_first_on_its_line(k) && (["=", ":", "{"].contains(&next) || is_joint && next == "(" || is_named_joint)
    }

    /// Returns whether a declaration of the mechanism, rather than of a body, begins at a token.
    pub fn begins_large_declaration(&self, k: usize) -> bool {
        self.begins_declaration(k) && matches!(self.role(k), Some(Role::Declaration | Role::Opener))
    }

    /// Returns whether a token is a keyword that was used as a name, or stands right behind one.
    pub fn uses_bad_name(&self, byte: usize, bad_names: &FxHashSet<&str>) -> bool {
        let k = self.index_at(byte);
        // a word that begins a declaration is no name
        let is_used = |k: usize| bad_names.contains(self.word(k)) && (self.is_inside(k) || !self.is_keyword(k));
        [k, k.saturating_sub(1)].iter().any(|&k| !self.is_behind_the_last(k) && is_used(k))
    }

    /// Returns the reserved word in the position of a name, with the keyword of its declaration.
    pub fn word_as_name(&self, byte: usize) -> Option<(&'a str, &'a str)> {
        let k = self.index_at(byte);
        let is_reserved = matches!(self.role(k), Some(Role::Declaration | Role::Feature | Role::Formula));
        (self.start(k) == byte && is_reserved && self.is_name_of(k)).then(|| (self.word(k), self.word(k - 1)))
    }

    /// Returns the hyphenated name that begins with a token.
    fn hyphenated_name(&self, token: &Token<'a>) -> Option<&'a str> {
        let is_declared = |name: &&str| self.hyphenated.contains(name);
        hyphenated_at(self.text, token.start).filter(is_declared)
    }

    /// Returns whether a range of tokens contains a hyphenated name.
    pub fn uses_hyphenated(&self, from: usize, to: usize) -> bool {
        let tokens = self.tokens.get(from..to).unwrap_or_default();
        !self.hyphenated.is_empty() && tokens.iter().any(|token| self.hyphenated_name(token).is_some())
    }

    /// Returns whether a word occurs anywhere in the text.
    pub fn has_word(&self, word: &str) -> bool {
        self.tokens.iter().any(|token| token.text == word)
    }
}

/// Returns whether a word of a role begins a declaration where one can begin.
pub(super) fn begins(role: Role) -> bool {
    matches!(role, Role::Declaration | Role::Feature) || role.is_opener()
}

/// Returns whether a word that may begin a declaration does so at a token: a name stands behind it with its definition, or the line begins here.
fn opens(tokens: &[Token<'_>], roles: &[Option<Role>], k: usize) -> bool {
    if !declares_name(tokens[k].text) {
        return opens_with_a_formula(tokens, roles, k);
    }
    let word = |k: usize| tokens.get(k).map_or("", |token| token.text);
    let is_word = tokens.get(k + 1).is_some_and(|next| next.kind == LexemeKind::Word);
    let is_defined = ["=", "[", ":"].contains(&word(k + 2));
    is_word && (is_defined || begins_line(tokens, k) && roles.get(k + 1).is_some_and(Option::is_none))
}

fn begins_line(tokens: &[Token<'_>], k: usize) -> bool {
    tokens.get(k).is_some_and(|token| token.lines_before > 0)
}

/// Returns whether a word before a formula, such as `mass`, begins a declaration at a token: no name stands between the end of one formula
/// and the beginning of another.
fn opens_with_a_formula(tokens: &[Token<'_>], roles: &[Option<Role>], k: usize) -> bool {
    let word = |k: usize| tokens.get(k).map_or("", |token| token.text);
    // what stands behind an operator or a word before a formula is an operand, whatever it is elsewhere
    let is_operand = |k: usize| {
        let before = k.checked_sub(1);
        let is_joining = |before: usize| roles[before].is_some_and(|role| role == Role::Formula || role.is_opener());
        before.is_some_and(|before| is_operator(word(before)) || is_joining(before))
    };
    let is_behind_an_end = k.checked_sub(1).is_some_and(|before| match roles[before] {
        None => word(before).starts_with(is_word_char) || matches!(word(before), ")" | "]" | "{" | "}"),
        // a name at the end of a line, as far as anyone can tell
        Some(Role::Separator | Role::Place) => {
            word(before) == "mirrored" || begins_line(tokens, k) || is_operand(before)
        }
        Some(role) => role == Role::Side,
    });
    let next = word(k + 1);
    let is_before_a_beginning = match roles.get(k + 1).copied().flatten() {
        Some(role) if role.is_opener() => !matches!(word(k + 2), "=" | ":" | "["),
        // a name, since a formula is missing before it
        Some(Role::Separator | Role::Place | Role::Side) => true,
        Some(_) => matches!(next, "if" | "not" | "ground"),
        None => next.starts_with(|c| is_word_char(c) || matches!(c, '(' | '-' | '.')),
    };
    is_behind_an_end && is_before_a_beginning
}

/// Returns whether a token is an operator between operands, or an equals sign.
pub(super) fn is_operator(word: &str) -> bool {
    matches!(word, "=" | "+" | "-" | "*" | "/" | "^" | "<" | ">" | "<=" | ">=" | "==" | "!=")
}
