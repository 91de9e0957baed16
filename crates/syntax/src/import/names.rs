//! Names that the language takes, unique, and as near to the model's own as can be.

use super::errors;
use super::value::Quoted;
use crate as syntax;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, Unit};
use rustc_hash::{FxHashMap, FxHashSet};

/// Namespace.
#[derive(Default)]
pub(super) struct Names {
    used: FxHashSet<String>,
    /// Number to try next for each stem: the cost of many items with one name must not be quadratic.
    next: FxHashMap<String, u32>,
}

/// Something of the model that needs a name.
pub(super) struct NameRequest<'a> {
    /// Kind of thing: "body".
    pub what: &'static str,
    /// Name in the model.
    pub name: Option<&'a Quoted>,
    /// Span for the message that it has no name.
    pub place: Span,
}

/// Assigns unique names in one namespace. Valid names are kept, and take precedence over changed ones. Reports every change.
pub(super) fn assign(requests: &[NameRequest<'_>], diagnostics: &mut Diagnostics) -> (Vec<String>, Names) {
    let mut names = Names::default();
    let kept: Vec<Option<String>> = requests
        .iter()
        .map(|one| {
            let name = syntax::normalized(&one.name?.text);
            (why_not(&name).is_none() && names.used.insert(name.clone())).then_some(name)
        })
        .collect();
    let list = requests.iter().zip(kept).map(|(one, kept)| {
        kept.unwrap_or_else(|| {
            let Some(old) = one.name else {
                let new = names.free(&format!("{}_1", one.what));
                diagnostics.push(errors::named(one.what, &new, one.place));
                return new;
            };
            let new = names.free(&valid(&old.text, &format!("{}_1", one.what)));
            let why = why_not(&syntax::normalized(&old.text)).unwrap_or("this name is taken");
            diagnostics.push(errors::renamed(one.what, &old.text, &new, old.span, why));
            new
        })
    });
    (list.collect(), names)
}

impl Names {
    /// Returns an unused name: this one, or this one with a number.
    pub fn free(&mut self, name: &str) -> String {
        if why_not(name).is_none() && self.used.insert(name.to_owned()) {
            return name.to_owned();
        }
        // `body_1` goes on with `body_2`, not with `body_1_1`
        let (stem, from) = match name.rsplit_once('_').map(|(stem, digits)| (stem, digits.parse::<u32>())) {
            Some((stem, Ok(number))) if !stem.is_empty() && number < 1000 => (stem, number + 1),
            _ => (name, 1),
        };
        let next = self.next.entry(stem.to_owned()).or_insert(from);
        loop {
            let candidate = format!("{stem}_{next}");
            *next += 1;
            if self.used.insert(candidate.clone()) {
                return candidate;
            }
        }
    }
}

/// Returns the name of the mechanism, which has a separate namespace.
pub(super) fn mechanism_name(name: Option<&Quoted>, place: Span, file: &str, diagnostics: &mut Diagnostics) -> String {
    let Some(old) = name else {
        let new = valid(file, "imported");
        diagnostics.push(errors::named("model", &new, place));
        return new;
    };
    let name = syntax::normalized(&old.text);
    if syntax::is_name(&name) {
        return name;
    }
    let new = valid(&old.text, "imported");
    let new = if syntax::is_name(&new) { new } else { format!("{new}_1") };
    let why = why_not(&name).unwrap_or("this is no name");
    diagnostics.push(errors::renamed("model", &old.text, &new, old.span, why));
    new
}

/// Returns why a text cannot be a name in the mechanism's namespace; `None` if it can.
fn why_not(name: &str) -> Option<&'static str> {
    if name.is_empty() {
        Some("the name is empty")
    } else if Constant::named(name).is_some() {
        Some("this name has a meaning in the language")
    } else if Unit::named(name).is_some() {
        Some("this is a unit")
    } else if syntax::is_name(name) {
        None
    } else if syntax::is_name(&format!("{name}_1")) {
        Some("this is a keyword")
    } else {
        Some("a name has letters, digits and `_`, and does not begin with a digit")
    }
}

/// Returns the text with `_` for characters that names cannot contain; it may still be a keyword.
fn valid(text: &str, fallback: &str) -> String {
    let mut name = String::new();
    for c in syntax::normalized(text).chars() {
        if pest::unicode::XID_CONTINUE(c) {
            name.push(c);
        } else if !name.ends_with('_') {
            name.push('_');
        }
    }
    let name = if pest::unicode::XID_CONTINUE(text.chars().next().unwrap_or(' ')) {
        name.trim_end_matches('_')
    } else {
        name.trim_matches('_')
    };
    match name.chars().next() {
        None => fallback.to_owned(),
        Some(c) if c == '_' || pest::unicode::XID_START(c) => syntax::normalized(name),
        Some(_) => syntax::normalized(&format!("_{name}")),
    }
}
