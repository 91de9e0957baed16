//! Signature help for the call at the cursor.

use super::lexical::{OpenCall, call_at, is_in_comment};
use super::location::FilePosition;
use super::snapshot::Snapshot;
use mechc_lang::check::NameKind;
use mechc_pipeline::Checked;
use mechc_text::vocabulary::{Category, Word, words};
use std::ops::Range;

/// The signatures of a callee.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signatures {
    /// The signatures, at least one.
    pub forms: Vec<Signature>,
    /// The index of the signature that fits the arguments so far.
    pub active: usize,
    /// The argument at the cursor, if the active signature has it.
    pub argument: Option<usize>,
}

/// A signature.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signature {
    /// The text of the signature: `weld(P, Q, angle)`.
    pub label: String,
    /// The ranges of its arguments in the label.
    pub arguments: Vec<Range<usize>>,
    /// Its documentation, in Markdown.
    pub meaning: String,
}

/// Returns the signatures of the innermost call around a position.
#[must_use]
pub fn signatures(snapshot: &Snapshot, position: &FilePosition) -> Option<Signatures> {
    let file = snapshot.checked(&position.path)?;
    let parsed = snapshot.parsed(&position.path)?;
    let text = &parsed.sources().get(parsed.file()).text;
    let offset = position.offset as usize;
    if !text.is_char_boundary(offset) || is_in_comment(text, offset) {
        return None;
    }
    let call = call_at(text, offset)?;
    let checked = file.mechanism_at(position.offset).or(file.mechanisms.last())?;
    of_part(&call, checked).or_else(|| of_declared_function(&call, checked)).or_else(|| of_words(&call))
}

/// Returns the signature of a part's mechanism: the names that may be bound.
fn of_part(call: &OpenCall, checked: &Checked) -> Option<Signatures> {
    let (prefix, name) = match call.name.rsplit_once('.') {
        Some((prefix, name)) => (Some(prefix), name),
        None => (None, call.name.as_str()),
    };
    let interface = checked.interface(prefix, name).filter(|_| call.is_kind)?;
    let shown: Vec<String> = interface.bindings.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let last = call.inside.rsplit(',').next().unwrap_or_default();
    let named = last.split('=').next().unwrap_or_default().split('.').next().unwrap_or_default().trim();
    let argument = interface.bindings.iter().position(|(name, _)| name == named);
    Some(Signatures { forms: vec![signature(&call.name, &shown, interface.docs.join("\n"))], active: 0, argument })
}

/// Returns the signature of a function or table that the mechanism declares; such a name takes precedence over a word of the language.
fn of_declared_function(call: &OpenCall, checked: &Checked) -> Option<Signatures> {
    let symbols = checked.symbols();
    let is_callable = |kind: NameKind| matches!(kind, NameKind::Function | NameKind::Table);
    let (id, function) = symbols.iter().find(|(_, name)| name.name == call.name && is_callable(name.kind))?;
    let argument = symbols.iter().find(|(_, name)| name.owner == Some(id)).map_or("u", |(_, argument)| &argument.name);
    let text = checked.sources().text(function.declaration);
    let meaning = format!("```mech\n{}\n```", text.trim_end());
    let forms = vec![signature(&call.name, &[argument.to_owned()], meaning)];
    Some(Signatures { forms, active: 0, argument: (call.argument == 0).then_some(0) })
}

fn of_words(call: &OpenCall) -> Option<Signatures> {
    let is_called = |word: &&Word| {
        let category = word.category;
        let is_joint = category == Category::Joint;
        let is_called = !matches!(category, Category::Keyword | Category::Unit | Category::Constant);
        word.name == call.name && is_called && is_joint == call.is_kind
    };
    let forms: Vec<Signature> = words().filter(is_called).flat_map(forms_of).collect();
    let fits = |form: &Signature| call.argument < form.arguments.len() || is_variadic(form);
    let active = forms.iter().position(fits).or(forms.len().checked_sub(1))?;
    let last = forms[active].arguments.len().saturating_sub(1);
    let argument = Some(call.argument).filter(|_| fits(&forms[active])).map(|argument| argument.min(last));
    Some(Signatures { forms, active, argument })
}

fn forms_of(word: &'static Word) -> impl Iterator<Item = Signature> {
    word.forms.iter().map(|form| {
        let inside = form.split_once('(').and_then(|(_, rest)| rest.rsplit_once(')')).map_or("", |(inside, _)| inside);
        let arguments: Vec<String> = inside.split(", ").map(str::to_owned).collect();
        let letters = if word.letters.is_empty() { String::new() } else { format!("\n\n{}", word.letters) };
        signature(word.name, &arguments, format!("{}{letters}", word.meaning))
    })
}

/// Returns whether a signature takes any number of arguments.
fn is_variadic(form: &Signature) -> bool {
    form.arguments.last().is_some_and(|last| &form.label[last.clone()] == "…")
}

fn signature(name: &str, arguments: &[String], meaning: String) -> Signature {
    let mut label = format!("{name}(");
    let mut ranges = Vec::new();
    for (k, argument) in arguments.iter().enumerate() {
        label += if k == 0 { "" } else { ", " };
        ranges.push(label.len()..label.len() + argument.len());
        label += argument;
    }
    Signature { label: label + ")", arguments: ranges, meaning }
}

#[cfg(test)]
mod tests {
    use super::signatures;
    use crate::testing::at_cursor;

    /// Lists the forms, the active one with its argument in brackets.
    fn shown(inside: &str) -> String {
        let (snapshot, position) = at_cursor(&format!(
            "mechanism m {{\n{inside}\n}}\nmechanism lever {{ param reach = 80 mm\n input turn = t\n }}"
        ));
        let Some(found) = signatures(&snapshot, &position) else { return "nothing".to_owned() };
        let form = |(k, form): (usize, &super::Signature)| {
            let mut label = form.label.clone();
            if let Some(range) = found.argument.filter(|_| k == found.active).map(|argument| &form.arguments[argument])
            {
                label.insert(range.end, '›');
                label.insert(range.start, '‹');
            }
            if k == found.active { format!("> {label}") } else { label }
        };
        found.forms.iter().enumerate().map(form).collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn the_argument_at_the_cursor_is_marked() {
        assert_eq!(shown("joint a: revolute(crank.A, $0"), "> revolute(P, ‹Q›)");
        assert_eq!(shown("joint a: weld($0"), "> weld(‹P›, Q)\nweld(P, Q, angle)");
        assert_eq!(shown("joint a: weld(b.P, c.Q, $0"), "weld(P, Q)\n> weld(P, Q, ‹angle›)");
        assert_eq!(shown("driver d: rotation($0) = 3"), "> rotation(‹joint›)\nrotation(joint, b.u, c.v)");
        assert_eq!(shown("driver d: rotation(a) = step(t, 0 s, 2 * (3 + $04), 1, 2)"), "> step(u, u0, ‹v0›, u1, v1)");
        assert_eq!(
            shown("param p = min(1, 2, 3, 4, $0"),
            "min(a, b)\n> min(a, b, c, ‹…›)\nmin(e)\nmin(e, from A to B)"
        );
        assert_eq!(shown("result r = mean(x(b.P), $0"), "mean(e)\n> mean(e, ‹from A to B›)");
        assert_eq!(shown("param p = sin(1, $0"), "> sin(a)");
        assert_eq!(shown("param p = hypot(sin(3), $0"), "> hypot(a, ‹b›)");
        assert_eq!(shown("param p = hypot(sin($0), 2)"), "> sin(‹a›)");
    }

    #[test]
    fn declared_functions_tables_and_parts_have_signatures() {
        assert_eq!(shown("fn swing(v) = v^2\nmeasure k = swing($0"), "> swing(‹v›)");
        assert_eq!(shown("table law = spline [(0, 1), (1, 2)]\nmeasure k = law($0)"), "> law(‹u›)");
        assert_eq!(shown("part p: lever($0)"), "> lever(reach = 80 mm, turn = t)");
        assert_eq!(shown("part p: lever(reach = 3 mm, turn = sin(t) + $0)"), "> lever(reach = 80 mm, ‹turn = t›)");
        assert_eq!(shown("part p: lever(reach = 3 mm, turn = sin($0"), "> sin(‹a›)");
    }

    #[test]
    fn without_a_call_there_is_no_signature() {
        assert_eq!(shown("body b at (0, $0"), "nothing");
        assert_eq!(shown("param p = nothing($0"), "nothing");
        assert_eq!(shown("param p = sin(1) // max($0"), "nothing");
        assert_eq!(shown("param p = sin(1)$0"), "nothing");
    }
}
