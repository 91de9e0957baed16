//! Completion items and the text that they insert.

use mechc_text::vocabulary::{Category, Keyword, Word};
use std::ops::Range;

/// A completion item.
#[derive(Clone, PartialEq, Debug)]
pub struct CompletionItem {
    /// The text that is shown and matched with the letters typed.
    pub label: String,
    /// The arguments, shown directly after the label.
    pub signature: String,
    /// A short description.
    pub detail: String,
    /// The documentation, in Markdown.
    pub docs: String,
    /// The kind of item.
    pub kind: CompletionItemKind,
    /// The text to insert.
    pub insert: Template,
    /// The range to replace.
    pub replaces: Range<u32>,
    /// The rank; items with smaller ranks fit better.
    pub rank: u8,
}

/// The kinds of completion items.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CompletionItemKind {
    /// A word of a declaration or formula.
    Keyword,
    /// A whole declaration.
    Declaration,
    /// A function, quantity, reduction or motion law.
    Function,
    /// A kind of joint.
    Joint,
    /// A unit.
    Unit,
    /// A constant of the language.
    Constant,
    /// A declared number.
    Value,
    /// A body, a part, or the ground.
    Body,
    /// A point, axis, circle, or curve.
    Feature,
    /// A declared joint.
    DeclaredJoint,
    /// A mechanism.
    Mechanism,
    /// A file.
    File,
    /// A folder.
    Folder,
}

/// A text with holes to fill in.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Template {
    /// The text with its holes unchanged.
    pub text: String,
    /// The ranges of the holes, in bytes and in order.
    pub holes: Vec<Range<usize>>,
}

impl Template {
    /// Creates a template without holes.
    pub fn plain(text: impl Into<String>) -> Template {
        Template { text: text.into(), holes: Vec::new() }
    }

    /// Creates a template from a text with its holes between `«` and `»`.
    #[must_use]
    pub fn from_marked(marked: &str) -> Template {
        let (mut template, mut open) = (Template::default(), 0);
        for c in marked.chars() {
            match c {
                '«' => open = template.text.len(),
                '»' => template.holes.push(open..template.text.len()),
                c => template.text.push(c),
            }
        }
        template
    }

    /// Creates a template from a form of the vocabulary, `revolute(P, Q)`: all words are holes except the first one and keywords outside
    /// parentheses.
    #[must_use]
    pub fn from_form(form: &str) -> Template {
        let mut marked = String::new();
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '…';
        let (mut rest, mut depth) = (form, 0_usize);
        while let Some(first) = rest.chars().next() {
            let length =
                if is_part(first) { rest.find(|c| !is_part(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
            let (word, behind) = rest.split_at(length);
            match first {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let is_fixed = depth == 0 && Keyword::named(word).is_some() || word == "mech";
            let is_hole = is_part(first) && !marked.is_empty() && !is_fixed;
            marked += &if is_hole { format!("«{word}»") } else { word.to_owned() };
            rest = behind;
        }
        Template::from_marked(
            &marked.replace("{ «…» }", "{\n    «»\n}").replace("«BINDING», «…»", "«»").replace("«…»", "«»"),
        )
    }

    /// Appends another template.
    pub(super) fn followed_by(mut self, other: Template) -> Template {
        let before = self.text.len();
        self.text += &other.text;
        self.holes.extend(other.holes.into_iter().map(|hole| hole.start + before..hole.end + before));
        self
    }

    /// Returns the text up to the first hole, for clients without snippets.
    #[must_use]
    pub fn up_to_first_hole(&self) -> &str {
        let end = self.holes.first().map_or(self.text.len(), |hole| hole.start);
        &self.text[..end]
    }
}

impl CompletionItem {
    pub(super) fn new(label: impl Into<String>, kind: CompletionItemKind, rank: u8) -> CompletionItem {
        let label = label.into();
        let insert = Template::plain(&label);
        let (signature, detail, docs) = (String::new(), String::new(), String::new());
        CompletionItem { label, signature, detail, docs, kind, insert, replaces: 0..0, rank }
    }

    /// Creates an item for a word of the language, with its documentation.
    pub(super) fn word(word: &'static Word, rank: u8) -> CompletionItem {
        let kind = match word.category {
            Category::Keyword => CompletionItemKind::Keyword,
            Category::Function | Category::Motion | Category::Quantity | Category::Reduction => {
                CompletionItemKind::Function
            }
            Category::Joint => CompletionItemKind::Joint,
            Category::Unit => CompletionItemKind::Unit,
            Category::Constant => CompletionItemKind::Constant,
        };
        let mut item = CompletionItem::new(word.name, kind, rank);
        word.meaning.clone_into(&mut item.detail);
        item.docs =
            format!("```mech\n{}\n```\n\n{}", word.forms.join("\n"), [word.meaning, word.more].join("\n\n").trim());
        if matches!(kind, CompletionItemKind::Function | CompletionItemKind::Joint)
            && let Some(form) = word.forms.first()
        {
            item.insert = Template::from_form(form);
            form.strip_prefix(word.name).unwrap_or_default().clone_into(&mut item.signature);
        }
        item
    }

    pub(super) fn detail(mut self, detail: impl Into<String>) -> CompletionItem {
        self.detail = detail.into();
        self
    }

    pub(super) fn docs(mut self, docs: impl Into<String>) -> CompletionItem {
        self.docs = docs.into();
        self
    }

    pub(super) fn inserts(mut self, insert: Template) -> CompletionItem {
        self.insert = insert;
        self
    }
}
