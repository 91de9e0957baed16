//! What is proposed, and what comes into the text.

use mechc_text::vocabulary::{Category, Keyword, Word};
use std::ops::Range;

/// What is proposed.
#[derive(Clone, PartialEq, Debug)]
pub struct CompletionItem {
    /// What is shown, and what the letters typed are looked for in.
    pub label: String,
    /// What is shown right behind that: arguments.
    pub signature: String,
    /// What it is, in short.
    pub detail: String,
    /// More about it, in Markdown.
    pub docs: String,
    /// What it is.
    pub kind: CompletionItemKind,
    /// What comes.
    pub insert: Template,
    /// What goes.
    pub replaces: Range<u32>,
    /// The better it fits the smaller.
    pub rank: u8,
}

/// What a proposal is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CompletionItemKind {
    /// A word of a declaration or formula.
    Keyword,
    /// A whole declaration.
    Declaration,
    /// What is called with numbers, points, bodies, or joints.
    Function,
    /// A kind of joint.
    Joint,
    /// A unit.
    Unit,
    /// What always has the same value.
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

/// A text with places that are to be filled in.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Template {
    /// As it stands with nothing filled in.
    pub text: String,
    /// The places, in bytes, in their order.
    pub holes: Vec<Range<usize>>,
}

impl Template {
    /// Without places.
    pub fn plain(text: impl Into<String>) -> Template {
        Template { text: text.into(), holes: Vec::new() }
    }

    /// Places stand between `«` and `»`.
    #[must_use]
    pub fn marked(marked: &str) -> Template {
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

    /// By a form of the vocabulary, `revolute(P, Q)`: all words are places but its first one, and keywords outside of parentheses.
    #[must_use]
    pub fn of_form(form: &str) -> Template {
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
            let is_own = depth == 0 && Keyword::named(word).is_some() || word == "mech";
            let is_place = is_part(first) && !marked.is_empty() && !is_own;
            marked += &if is_place { format!("«{word}»") } else { word.to_owned() };
            rest = behind;
        }
        Template::marked(
            &marked.replace("{ «…» }", "{\n    «»\n}").replace("«BINDING», «…»", "«»").replace("«…»", "«»"),
        )
    }

    /// With another one behind it.
    pub(super) fn followed_by(mut self, other: Template) -> Template {
        let before = self.text.len();
        self.text += &other.text;
        self.holes.extend(other.holes.into_iter().map(|hole| hole.start + before..hole.end + before));
        self
    }

    /// What can be written where no places can be filled in: all up to the first one.
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

    /// A word of the language, with what belongs to it.
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
            item.insert = Template::of_form(form);
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
