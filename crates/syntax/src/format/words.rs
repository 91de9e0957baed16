//! Classification of the tokens of a declaration, which determines the spaces between them.

use crate::keywords::may_begin_a_bound;
use crate::lexer::{LexemeKind, Token};
use crate::sync_points::begins;
use mechc_text::vocabulary::{Constant, Keyword, Position, Role, Synonym, Unit, declares_name};
use rustc_hash::FxHashSet;
use std::ops::Range;

/// Binding strength of an operator, loosest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Level {
    Or,
    And,
    Compare,
    Sum,
    Product,
}

/// Kinds of tokens in a declaration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Class {
    /// Begins a declaration, or joins its parts.
    Keyword,
    /// `if`, `then`, `else`.
    If,
    Then,
    Else,
    /// A name, where one is declared or used.
    Name,
    Number,
    /// A unit behind a number.
    Unit,
    Quoted,
    Open(Bracket),
    Close,
    Comma,
    Colon,
    Equals,
    Operator(Level),
    /// Binds its neighbours so tightly that no space is between: `^`, `.`, `..`, `/` in a unit.
    Tight,
    /// `-` before an operand.
    Sign,
    /// `not`
    Not,
    OpenBrace,
    CloseBrace,
    Comment,
}

/// Contents of a bracket.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Bracket {
    /// Arguments of what stands before it, or indices.
    Arguments,
    /// A formula, or a point.
    Formula,
    /// The bindings of a part.
    Bindings,
    /// The rows of a table.
    Rows,
    /// The units of a table's file.
    Units,
}

impl Bracket {
    fn is_behind_a_name(self) -> bool {
        matches!(self, Bracket::Arguments | Bracket::Bindings)
    }
}

/// A token in its declaration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Word {
    pub class: Class,
    /// The spaces before it, if it does not begin a line.
    pub spaces: usize,
    /// True if a column begins with it.
    pub begins_cell: bool,
    /// A comma behind the last item of a list: it stands only where each item has a line of its own.
    pub is_last_comma: bool,
}

/// Spaces between declarations that share a line.
const BETWEEN_FEATURES: usize = 2;

/// Returns the words that a text declares as names anywhere: in a formula they do not denote units.
pub(super) fn declared<'a>(tokens: &[Token<'a>]) -> FxHashSet<&'a str> {
    let is_keyword =
        |token: &Token<'_>| declares_name(token.text) && Keyword::named(token.text).is_some_and(|k| begins(k.role));
    let behind_keywords = tokens.windows(2).filter(|pair| is_keyword(&pair[0])).map(|pair| pair[1].text);
    let is_argument = |run: &&[Token<'_>]| ["fn", "curve"].contains(&run[0].text) && run[2].text == "(";
    let arguments = tokens.windows(4).filter(is_argument).map(|run| run[3].text);
    behind_keywords.chain(arguments).collect()
}

/// Returns the words of a declaration, or of a block on one line. `printed` is the byte at which the unit behind `in` begins.
pub(super) fn words(
    tokens: &[Token<'_>],
    names: &FxHashSet<&str>,
    range: Range<usize>,
    printed: Option<usize>,
) -> Vec<Word> {
    let mut reading = Classifier {
        tokens,
        names,
        range: range.clone(),
        printed,
        keyword: "",
        brackets: Vec::new(),
        before: None,
        cells: Cells::None,
        quantity: Quantity::No,
        is_in_unit: false,
        takes_name: false,
    };
    range.map(|k| reading.word(k)).collect()
}

/// Returns the columns of a declaration on one line.
pub(super) fn width(words: &[Word], tokens: &[Token<'_>]) -> usize {
    let shown = words.iter().zip(tokens).enumerate().filter(|(_, (word, _))| !word.is_last_comma);
    shown.map(|(k, (word, token))| usize::from(k > 0) * word.spaces + super::width(token.text)).sum()
}

/// Position at which the next cell of aligned columns begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cells {
    None,
    /// The next token begins it.
    Next,
    /// `=` begins it.
    Equals,
    /// It begins behind `:`.
    Colon,
    /// It begins behind `:`, and another with `=`.
    ColonAndEquals,
    /// The next keyword begins it.
    As,
    /// The next keyword begins it, and an opening brace begins another.
    At,
    /// Every keyword begins one.
    Keywords,
    /// The opening brace of a block begins it.
    Brace,
}

/// State of a number with its unit before the token, to which another unit may be joined: `30 deg/s * t`, but not `a / 30 deg/s`,
/// which would look like a / (30 deg/s).
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quantity {
    No,
    /// Behind `/`.
    Under,
    Yes,
}

struct Classifier<'a> {
    tokens: &'a [Token<'a>],
    names: &'a FxHashSet<&'a str>,
    range: Range<usize>,
    printed: Option<usize>,
    /// Keyword of the declaration.
    keyword: &'a str,
    brackets: Vec<Bracket>,
    /// The class of the previous token that is no comment.
    before: Option<Class>,
    cells: Cells,
    quantity: Quantity,
    /// True in the unit behind `in`, and in the units of a table's file.
    is_in_unit: bool,
    takes_name: bool,
}

impl<'a> Classifier<'a> {
    fn word(&mut self, k: usize) -> Word {
        let class = self.class(k);
        let spaces = self.spaces(k, class);
        let begins_cell = self.begins_cell(class);
        let is_last_comma = class == Class::Comma && matches!(self.text_behind(k), ")" | "]");
        match class {
            Class::Open(bracket) => self.brackets.push(bracket),
            Class::Close => drop(self.brackets.pop()),
            _ => {}
        }
        self.quantity = self.quantity_behind(k, class);
        if class != Class::Comment {
            self.before = Some(class);
        }
        Word { class, spaces, begins_cell, is_last_comma }
    }

    /// Returns the token behind one, comments aside.
    fn behind(&self, k: usize) -> Option<&Token<'a>> {
        self.tokens[k + 1..self.range.end].iter().find(|token| !token.is_comment())
    }

    fn text_behind(&self, k: usize) -> &'a str {
        self.behind(k).map_or("", |token| token.text)
    }

    fn ends_operand(&self) -> bool {
        matches!(self.before, Some(Class::Name | Class::Number | Class::Unit | Class::Close | Class::Quoted))
    }

    fn is_in_units(&self) -> bool {
        self.is_in_unit || self.brackets.last() == Some(&Bracket::Units)
    }

    fn class(&mut self, k: usize) -> Class {
        match self.tokens[k].kind {
            LexemeKind::Comment => Class::Comment,
            LexemeKind::Number => Class::Number,
            LexemeKind::String => Class::Quoted,
            LexemeKind::Word => self.class_of_word(k),
            LexemeKind::Sign => self.class_of_sign(k),
        }
    }

    fn class_of_word(&mut self, k: usize) -> Class {
        let text = self.tokens[k].text;
        let keyword = Keyword::named(text);
        if self.before.is_none() || self.is_feature(k) {
            self.begin(text);
            return Class::Keyword;
        }
        if std::mem::take(&mut self.takes_name) {
            return Class::Name;
        }
        match text {
            "if" => Class::If,
            "then" => Class::Then,
            "else" => Class::Else,
            "and" => Class::Operator(Level::And),
            "or" => Class::Operator(Level::Or),
            "not" => Class::Not,
            _ if self.is_unit(k, keyword) => Class::Unit,
            _ if self.ends_operand() => {
                self.is_in_unit = text == "in" && self.brackets.is_empty();
                self.takes_name = text == "as";
                Class::Keyword
            }
            "from" if self.keyword == "analysis" && self.before == Some(Class::Keyword) => Class::Keyword,
            "from" | "to" if self.begins_window(k) => Class::Keyword,
            "periodic" | "spline" if self.keyword == "table" && self.brackets.is_empty() => Class::Keyword,
            _ => Class::Name,
        }
    }

    /// Returns whether `from` or `to` begins the window of a reduction.
    fn begins_window(&self, k: usize) -> bool {
        let is_argument = self.before == Some(Class::Comma) && self.brackets.last() == Some(&Bracket::Arguments);
        let is_apart = |behind: &Token<'_>| behind.start > self.tokens[k].end();
        is_argument && self.behind(k).is_some_and(|behind| may_begin_a_bound(behind.text, is_apart(behind)))
    }

    /// Begins with the keyword of a declaration.
    fn begin(&mut self, keyword: &'a str) {
        let is_first = self.before.is_none();
        self.keyword = keyword;
        self.takes_name = declares_name(keyword) && keyword != "use";
        // declarations in a block on one line have no columns
        if is_first {
            let has_cells = !matches!(keyword, "ground" | "analysis" | "gravity" | "mechanism");
            self.cells = if has_cells { Cells::Next } else { Cells::None };
        }
    }

    fn is_unit(&self, k: usize, keyword: Option<&Keyword>) -> bool {
        let is_printed = || self.behind(k).is_some_and(|token| Some(token.start) == self.printed);
        let may_be =
            |keyword: &Keyword| !keyword.is_reserved() && keyword.role != Role::Separator && !keyword.role.is_opener();
        // an exponent has no unit
        let is_number = self.before == Some(Class::Number) && self.quantity != Quantity::Yes;
        is_number && keyword.is_none_or(may_be) && !(self.tokens[k].text == "in" && is_printed())
    }

    fn class_of_sign(&mut self, k: usize) -> Class {
        match self.tokens[k].text {
            "(" | "[" => Class::Open(self.bracket(self.tokens[k].text)),
            ")" | "]" => Class::Close,
            "{" => Class::OpenBrace,
            "}" => Class::CloseBrace,
            "," => Class::Comma,
            ":" => Class::Colon,
            "=" => Class::Equals,
            "+" | "-" if self.ends_operand() => Class::Operator(Level::Sum),
            "+" | "-" => Class::Sign,
            "/" if self.is_in_units() || self.quantity == Quantity::Yes && self.is_a_unit_behind(k) => Class::Tight,
            "*" if self.is_in_units() => Class::Tight,
            "*" | "/" => Class::Operator(Level::Product),
            "<" | "<=" | ">" | ">=" | "==" | "!=" => Class::Operator(Level::Compare),
            _ => Class::Tight,
        }
    }

    fn bracket(&self, text: &str) -> Bracket {
        match (text, self.before) {
            ("(", Some(Class::Name)) if self.keyword == "part" && self.brackets.is_empty() => Bracket::Bindings,
            ("(", Some(Class::Name)) | ("[", Some(Class::Name | Class::Close)) => Bracket::Arguments,
            ("(", Some(Class::Quoted | Class::Number)) => Bracket::Units,
            ("[", _) => Bracket::Rows,
            _ => Bracket::Formula,
        }
    }

    /// Returns whether a unit stands behind a token, with its power or alone.
    fn is_a_unit_behind(&self, k: usize) -> bool {
        let mut behind = self.tokens[k + 1..self.range.end].iter().filter(|token| !token.is_comment());
        // `min` is no unit, but its author means one; `t` is the time
        let is_synonym = |text: &str| Synonym::of(Position::Unit, text).is_some() && Constant::named(text).is_none();
        let names_one = |text: &str| Unit::named(text).is_some() || is_synonym(text);
        let is_unit = |token: &Token<'_>| names_one(token.text) && !self.names.contains(token.text);
        behind.next().is_some_and(is_unit)
            && match behind.next().map(|token| token.text) {
                Some("(" | "." | "[") => false,
                Some("^") => is_exponent(behind),
                _ => true,
            }
    }

    fn quantity_behind(&self, k: usize, class: Class) -> Quantity {
        match class {
            Class::Unit if self.quantity == Quantity::Under => Quantity::No,
            Class::Unit => Quantity::Yes,
            Class::Operator(Level::Product) if self.tokens[k].text == "/" => Quantity::Under,
            Class::Tight if self.tokens[k].text == "^" => {
                let is_power = is_exponent(self.tokens[k + 1..self.range.end].iter());
                if is_power { self.quantity } else { Quantity::No }
            }
            // a factor, a power, what stands under a unit
            Class::Number | Class::Sign | Class::Tight | Class::Comment => self.quantity,
            Class::Name if self.quantity == Quantity::Yes => self.quantity,
            _ => Quantity::No,
        }
    }

    fn spaces(&self, k: usize, class: Class) -> usize {
        let Some(before) = self.before else { return 0 };
        let is_tight_before = match class {
            Class::Comma | Class::Colon | Class::Close | Class::Tight => true,
            Class::Open(bracket) => bracket.is_behind_a_name(),
            Class::CloseBrace => before == Class::OpenBrace,
            _ => false,
        };
        if is_tight_before {
            return 0;
        }
        match before {
            Class::Tight | Class::Sign | Class::Open(_) => 0,
            Class::OpenBrace => 1,
            _ if class == Class::Keyword && self.cells == Cells::None && self.is_feature(k) => BETWEEN_FEATURES,
            _ => 1,
        }
    }

    fn is_feature(&self, k: usize) -> bool {
        match Keyword::named(self.tokens[k].text).map(|keyword| keyword.role) {
            Some(Role::Feature) => true,
            // elsewhere it is a name
            Some(Role::FeatureOpener) => self.before == Some(Class::OpenBrace) || self.ends_operand(),
            _ => false,
        }
    }

    fn begins_cell(&mut self, class: Class) -> bool {
        if class == Class::Comment {
            return false;
        }
        let is_outside = self.brackets.is_empty();
        let (begins, next) = match (self.cells, class) {
            (Cells::Next, Class::Keyword) if self.before.is_none() => (false, Cells::Next),
            (Cells::Next, _) if self.before == Some(Class::Keyword) => (true, cells_of(self.keyword)),
            // behind the colon of an equation its left side begins
            (Cells::Next, _) => (true, Cells::Equals),
            (Cells::Equals, Class::Equals) if is_outside => (true, Cells::None),
            (Cells::Colon, _) if self.before == Some(Class::Colon) => (true, Cells::None),
            (Cells::ColonAndEquals, _) if self.before == Some(Class::Colon) => (true, Cells::Equals),
            (Cells::As | Cells::At, Class::Keyword) if is_outside => {
                (true, if self.cells == Cells::At { Cells::Brace } else { Cells::None })
            }
            (Cells::At | Cells::Brace, Class::OpenBrace) => (true, Cells::None),
            (Cells::Keywords, Class::Keyword) if is_outside => (true, Cells::Keywords),
            (cells, _) => (false, cells),
        };
        self.cells = next;
        begins
    }
}

/// Returns where columns begin behind the name of a declaration.
fn cells_of(keyword: &str) -> Cells {
    match keyword {
        "joint" | "part" | "load" => Cells::Colon,
        "driver" | "constraint" => Cells::ColonAndEquals,
        "use" => Cells::As,
        "body" => Cells::At,
        "mass" => Cells::Keywords,
        _ => Cells::Equals,
    }
}

/// Returns whether the tokens behind a `^` are a whole number, which may be negative.
fn is_exponent<'a>(mut behind: impl Iterator<Item = &'a Token<'a>>) -> bool {
    let mut next = behind.next();
    if next.is_some_and(|token| token.text == "-") {
        next = behind.next();
    }
    next.is_some_and(|token| token.kind == LexemeKind::Number && token.text.bytes().all(|byte| byte.is_ascii_digit()))
}
