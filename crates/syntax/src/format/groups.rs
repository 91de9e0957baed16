//! Groups of a declaration's words that may be broken into lines: those that bind more loosely are broken first.

use super::layout::{Node, Style};
use super::words::{Bracket, Class, Level, Word};
use crate::lexer::Token;

/// A declaration as nodes, each with the number of the token that it stands for or before.
pub(super) struct Grouped {
    pub nodes: Vec<Node>,
    /// Token of each node.
    pub tokens: Vec<usize>,
    /// Lists that may have a line for each item.
    pub lists: Vec<List>,
}

/// A list in its brackets.
pub(super) struct List {
    /// The node that opens it.
    pub node: usize,
    /// Last token that is neither a comment nor the comma behind the last item.
    pub last: usize,
    /// The comma behind the last item, if there is one.
    pub comma: Option<usize>,
}

/// Spaces before a comment that stands behind something on its line.
pub(super) const BEFORE_COMMENT: usize = 3;

/// An open bracket, conditional or operator.
enum Frame {
    Bracket {
        bracket: Bracket,
        first: usize,
        has_commas: bool,
    },
    /// `if C then A else B`; how much of it has been read.
    Conditional {
        first: usize,
        read: Class,
    },
    Operators {
        first: usize,
        level: Level,
    },
}

/// The groups that begin and end at each token of a declaration.
#[derive(Default)]
struct Groups {
    /// Groups that begin with each token, inner ones first.
    begin: Vec<Vec<Style>>,
    /// Number of groups that end with each token.
    end: Vec<usize>,
    /// True for tokens before which a line may end.
    is_gap: Vec<bool>,
    /// True for brackets whose list may have a line for each item.
    is_list: Vec<bool>,
}

struct Grouping<'a> {
    words: &'a [Word],
    /// End of the text before each token, and of the whole, without comments and without a comma that is left out.
    ends: Vec<usize>,
    groups: Groups,
    frames: Vec<Frame>,
    /// Start of the last operand, by open bracket or conditional.
    operands: Vec<Option<usize>>,
}

fn groups(words: &[Word]) -> Groups {
    let count = words.len();
    let groups = Groups {
        begin: vec![Vec::new(); count],
        end: vec![0; count],
        is_gap: vec![false; count + 1],
        is_list: vec![false; count],
    };
    let mut ends = vec![0];
    for (k, word) in words.iter().enumerate() {
        let is_nothing = word.class == Class::Comment || word.is_last_comma;
        ends.push(if is_nothing { ends[k] } else { k + 1 });
    }
    let mut grouping = Grouping { words, ends, groups, frames: Vec::new(), operands: vec![None] };
    for k in 0..count {
        grouping.take(k);
    }
    grouping.end_part(count);
    grouping.groups
}

impl Grouping<'_> {
    fn take(&mut self, k: usize) {
        let words = self.words;
        match words[k].class {
            Class::Comment => return,
            Class::Operator(level) => return self.operator(level, k),
            Class::Open(bracket) => {
                self.operand(k);
                self.frames.push(Frame::Bracket { bracket, first: k + 1, has_commas: false });
                self.operands.push(None);
                return;
            }
            Class::Close => return self.close(k),
            // a comma that is left out ends its part only
            Class::Comma if words[k].is_last_comma => return self.end_part(k),
            Class::Comma => {
                self.end_part(k);
                if let Some(Frame::Bracket { has_commas, .. }) = self.frames.last_mut() {
                    *has_commas = true;
                }
                self.groups.is_gap[k + 1] = true;
                self.forget_operand();
                return;
            }
            Class::Equals | Class::Colon | Class::OpenBrace | Class::CloseBrace => {
                self.end_part(k);
                self.forget_operand();
                return;
            }
            Class::Keyword => {
                self.end_part(k);
                self.groups.is_gap[k] = k > 0 && self.begins_clause(k);
                self.forget_operand();
                return;
            }
            Class::If => return self.condition(k),
            Class::Then | Class::Else => return self.arm(k),
            Class::Not | Class::Sign | Class::Name | Class::Number | Class::Quoted | Class::Unit | Class::Tight => {}
        }
        self.operand(k);
    }

    /// Returns whether a line may end before a keyword: where it joins two parts of a declaration, other than a formula and its unit.
    fn begins_clause(&self, k: usize) -> bool {
        let is_behind_operand =
            matches!(self.words[k - 1].class, Class::Name | Class::Number | Class::Unit | Class::Close | Class::Quoted);
        is_behind_operand && self.frames.is_empty() && !self.words[k].begins_cell
    }

    fn operand(&mut self, k: usize) {
        if let Some(operand) = self.operands.last_mut() {
            operand.get_or_insert(k);
        }
    }

    fn forget_operand(&mut self) {
        if let Some(operand) = self.operands.last_mut() {
            *operand = None;
        }
    }

    /// A comment behind a group is not in it: where a comma is put before the comment, it would not be either.
    fn end_group(&mut self, first: usize, behind: usize, style: Style) {
        let behind = self.ends[behind];
        if first < behind {
            self.groups.begin[first].push(style);
            self.groups.end[behind - 1] += 1;
        }
    }

    /// Ends the operators that bind more tightly than one, and gives where the last of them began.
    fn end_operators(&mut self, behind: usize, looser: Option<Level>) -> Option<usize> {
        let mut start = None;
        while let Some(&Frame::Operators { first, level }) = self.frames.last() {
            if looser.is_some_and(|looser| level <= looser) {
                break;
            }
            self.end_group(first, behind, Style::Filled);
            self.frames.pop();
            start = Some(first);
        }
        start
    }

    fn operator(&mut self, level: Level, k: usize) {
        let ended = self.end_operators(k, Some(level));
        let operand = self.operands.last().copied().flatten();
        let is_open = matches!(self.frames.last(), Some(Frame::Operators { level: open, .. }) if *open == level);
        if !is_open {
            let first = ended.or(operand).unwrap_or(k);
            self.frames.push(Frame::Operators { first, level });
        }
        self.groups.is_gap[k + 1] = true;
        self.forget_operand();
    }

    /// Ends what ends with the part of a bracket or declaration: operators, conditionals.
    fn end_part(&mut self, behind: usize) {
        loop {
            self.end_operators(behind, None);
            let Some(&Frame::Conditional { first, .. }) = self.frames.last() else { return };
            self.end_group(first, behind, Style::Stacked);
            self.frames.pop();
            self.operands.pop();
        }
    }

    fn close(&mut self, k: usize) {
        self.end_part(k);
        let Some(Frame::Bracket { bracket, first, has_commas }) = self.frames.pop() else { return };
        // comments alone are no list
        let has_items = self.operands.pop().flatten().is_some() || has_commas;
        if matches!(bracket, Bracket::Bindings | Bracket::Rows) && has_items {
            self.groups.is_list[first - 1] = true;
            self.groups.is_list[k] = true;
        } else if has_commas {
            self.end_group(first, k, Style::Filled);
        }
    }

    fn condition(&mut self, k: usize) {
        let is_else_if = k > 0 && self.words[k - 1].class == Class::Else;
        if let (true, Some(Frame::Conditional { read, .. })) = (is_else_if, self.frames.last_mut()) {
            *read = Class::If;
            return;
        }
        self.operand(k);
        self.frames.push(Frame::Conditional { first: k, read: Class::If });
        self.operands.push(None);
    }

    /// Goes on with the innermost conditional whose condition, or first arm, is what was read last.
    fn arm(&mut self, k: usize) {
        let class = self.words[k].class;
        let awaited = if class == Class::Then { Class::If } else { Class::Then };
        loop {
            self.end_operators(k, None);
            match self.frames.last_mut() {
                Some(Frame::Conditional { read, .. }) if *read == awaited => {
                    *read = class;
                    break;
                }
                Some(&mut Frame::Conditional { first, .. }) => {
                    self.end_group(first, k, Style::Stacked);
                    self.frames.pop();
                    self.operands.pop();
                }
                _ => break,
            }
        }
        self.groups.is_gap[k] = class == Class::Else;
        self.forget_operand();
    }
}

/// The text before the last column of a declaration breaks only if it is wider than this.
const WIDEST_HEAD: usize = 60;

/// Returns the first token before which a line may end.
fn breakable(words: &[Word], tokens: &[Token<'_>], keyword: &str) -> usize {
    if matches!(keyword, "body" | "ground" | "mechanism") {
        return words.len();
    }
    let head = words.iter().rposition(|word| word.begins_cell).unwrap_or(0);
    if super::words::width(&words[..head], &tokens[..head]) > WIDEST_HEAD { 0 } else { head }
}

/// Returns the nodes of a declaration; `spaces` are those before each of its tokens, the first one's not counted.
pub(super) fn grouped(words: &[Word], tokens: &[Token<'_>], spaces: &[usize]) -> Grouped {
    let mut groups = groups(words);
    let breakable = breakable(words, tokens, tokens.first().map_or("", |token| token.text));
    groups.is_gap[..breakable].fill(false);
    let mut made = Grouped { nodes: Vec::with_capacity(4 * words.len()), tokens: Vec::new(), lists: Vec::new() };
    for (k, word) in words.iter().enumerate() {
        if k > 0 {
            made.gap(k, (words, tokens, spaces), &groups);
        }
        if groups.is_list[k] && word.class == Class::Close {
            made.end_list(k, words);
        }
        for style in groups.begin[k].iter().rev() {
            made.push(Node::Open(*style), k);
        }
        if !word.is_last_comma {
            // a comment breaks no formula
            let wide = if word.class == Class::Comment { 0 } else { super::width(tokens[k].text) };
            made.push(Node::Text(wide), k);
        }
        for _ in 0..groups.end[k] {
            made.push(Node::Close, k);
        }
        if groups.is_list[k] && word.class != Class::Close {
            made.lists.push(List { node: made.nodes.len(), last: k, comma: None });
            made.push(Node::Open(Style::Listed), k);
        }
    }
    made
}

impl Grouped {
    fn push(&mut self, node: Node, token: usize) {
        self.nodes.push(node);
        self.tokens.push(token);
    }

    /// Ends the list before its bracket. It is the last one that was opened: none holds another.
    fn end_list(&mut self, k: usize, words: &[Word]) {
        let mut inside = (0..k).rev().filter(|&k| words[k].class != Class::Comment);
        if let Some(list) = self.lists.last_mut() {
            list.comma = inside.next().filter(|&k| words[k].is_last_comma);
            list.last = list.comma.map_or(k - 1, |comma| comma - 1);
            while words[list.last].class == Class::Comment {
                list.last -= 1;
            }
        }
        self.push(Node::Close, k);
    }

    /// Adds the gap before a token.
    fn gap(&mut self, k: usize, (words, tokens, spaces): (&[Word], &[Token<'_>], &[usize]), groups: &Groups) {
        let is_at_list = groups.is_list[k - 1] && words[k - 1].class != Class::Close
            || groups.is_list[k] && words[k].class == Class::Close;
        // a comma that is left out does not end the line of a comment before it
        let before = if words[k - 1].is_last_comma { k.checked_sub(2) } else { k.checked_sub(1) };
        let is_behind_comment = before.is_some_and(|before| words[before].class == Class::Comment);
        let node = if is_behind_comment || tokens[k].is_comment() && tokens[k].lines_before > 0 {
            Node::Line
        } else if tokens[k].is_comment() {
            Node::Space(BEFORE_COMMENT)
        } else if words[k].is_last_comma {
            Node::Space(0)
        } else if groups.is_gap[k] || is_at_list {
            Node::Gap(spaces[k])
        } else {
            Node::Space(spaces[k])
        };
        self.push(node, k);
    }
}
