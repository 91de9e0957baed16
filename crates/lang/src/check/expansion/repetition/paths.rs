//! Paths such as `link[k - 1].pin` and `leg[0].foot.toe`, resolved to the names of copies.

use super::{Expanded, Expander, NotExpandable, Numbers, indexed};
use crate::check::errors;
use crate::check::expansion::instance::Instance;
use crate::check::scope::name_of;
use mechc_syntax::ast::{self, Expr, ExprKind, Item, ItemKind, Name};
use mechc_text::source::Span;
use rustc_hash::FxHashSet;
use std::rc::Rc;

impl<'t> Expander<'t, '_> {
    pub(in crate::check) fn must_not_be_repeated(&mut self, name: &Name) -> Expanded<()> {
        let Some(copies) = self.copies.get(name.text.as_str()) else { return Ok(()) };
        let first = copies.iter().min().map(|numbers| indexed(&name.text, numbers));
        self.report_once(errors::which_copy(name, first.as_deref()));
        Err(NotExpandable)
    }

    /// Resolves `link[2].pin`.
    pub(in crate::check) fn path(
        &mut self,
        span: Span,
        segments: &[ast::PathSegment],
        numbers: &Numbers<'_>,
    ) -> Expanded<ExprKind> {
        let [first, rest @ ..] = segments else { return Err(NotExpandable) };
        let owner = self.copy_named(first, numbers)?;
        if let Some(part) = self.parts.get(&owner.text).cloned()
            && !rest.is_empty()
        {
            return self.inside(span, &owner.text, part, rest, numbers);
        }
        match rest {
            [] => Ok(ExprKind::Name(owner)),
            [feature] if feature.indices.is_empty() => Ok(ExprKind::Member { owner, feature: feature.name.clone() }),
            _ => {
                let diagnostic = if self.names.contains(first.name.text.as_str()) || first.name.text == "ground" {
                    errors::invalid_path(span, segments, true)
                } else {
                    errors::unknown_owner(&first.name, self.tree)
                };
                self.report_once(diagnostic);
                Err(NotExpandable)
            }
        }
    }

    /// Resolves a path into a part: `leg[0].foot.toe` is the feature `toe` of the body that is called `leg[0].foot` here.
    pub(in crate::check) fn inside(
        &mut self,
        span: Span,
        path: &str,
        part: Option<Rc<Instance<'t>>>,
        segments: &[ast::PathSegment],
        numbers: &Numbers<'_>,
    ) -> Expanded<ExprKind> {
        // A part that cannot be instantiated has been reported.
        let mut part = part.ok_or(NotExpandable)?;
        let mut path = path.to_owned();
        for (k, segment) in segments.iter().enumerate() {
            let name = self.copy_in(&part, &path, segment, numbers)?;
            let longer = format!("{path}.{name}");
            let rest = &segments[k + 1..];
            if let Some(inner) = part.part(&name).cloned()
                && !rest.is_empty()
            {
                (part, path) = (inner, longer);
                continue;
            }
            self.paths.insert(longer.clone());
            let owner = Name { text: longer, span: if rest.is_empty() { span } else { segment.name.span } };
            return match rest {
                [] => Ok(ExprKind::Name(owner)),
                [feature] if feature.indices.is_empty() => {
                    Ok(ExprKind::Member { owner, feature: feature.name.clone() })
                }
                // A part that cannot be instantiated has been reported.
                _ if part.is_a_part(&segment.name.text) => Err(NotExpandable),
                _ => {
                    self.report_once(errors::path_too_long(span));
                    Err(NotExpandable)
                }
            };
        }
        Err(NotExpandable)
    }

    /// Returns the name of a copy in a part.
    fn copy_in(
        &mut self,
        part: &Instance<'t>,
        path: &str,
        segment: &ast::PathSegment,
        numbers: &Numbers<'_>,
    ) -> Expanded<String> {
        let ast::PathSegment { name, indices } = segment;
        let copies = part.copies.get(name.text.as_str());
        let diagnostic = match (copies, indices.is_empty()) {
            _ if !part.declares(&name.text) => {
                let candidates: Vec<&str> = part.names().collect();
                errors::unknown_in_part(path, part.mechanism_name(), name, &candidates)
            }
            (None, true) => return Ok(name.text.clone()),
            (None, false) => errors::not_repeated(name),
            (Some(copies), true) => {
                let first = copies.iter().min().map(|numbers| format!("{path}.{}", indexed(&name.text, numbers)));
                errors::which_copy(name, first.as_deref())
            }
            (Some(copies), false) => {
                let copies = Rc::clone(copies);
                return self.one_of(&copies, segment, numbers);
            }
        };
        self.report_once(diagnostic);
        Err(NotExpandable)
    }

    /// Returns the name of a copy.
    fn copy_named(&mut self, segment: &ast::PathSegment, numbers: &Numbers<'_>) -> Expanded<Name> {
        let ast::PathSegment { name, indices } = segment;
        if indices.is_empty() {
            self.must_not_be_repeated(name)?;
            return Ok(name.clone());
        }
        match self.copies.get(name.text.as_str()).cloned() {
            Some(copies) => {
                let text = self.one_of(&copies, segment, numbers)?;
                Ok(Name { text, span: name.span })
            }
            // A declaration that could not be repeated or parsed has been reported.
            None if self.is_repeated(name) || self.is_unread(name) => Err(NotExpandable),
            None if self.names.contains(name.text.as_str()) => {
                self.report_once(errors::not_repeated(name));
                Err(NotExpandable)
            }
            // An unknown name is reported where it is resolved.
            None => Ok(Name { text: indexed(&name.text, &self.values(indices, numbers)?), span: name.span }),
        }
    }

    fn is_repeated(&self, name: &Name) -> bool {
        let is_it = |item: &Item| name_of(item).is_some_and(|other| other.text == name.text);
        self.tree.items.iter().any(|item| !item.ranges.is_empty() && is_it(item))
    }

    /// Returns whether a broken declaration may have this name, perhaps for several copies.
    fn is_unread(&self, name: &Name) -> bool {
        let gives_it = |item: &Item| match &item.kind {
            ItemKind::Broken { names } => names.iter().any(|other| other.text == name.text),
            _ => false,
        };
        self.tree.items.iter().any(gives_it)
    }

    fn values(&mut self, indices: &[Expr], numbers: &Numbers<'_>) -> Expanded<Vec<i64>> {
        indices.iter().map(|e| self.whole_number(e, numbers, "an index")).collect()
    }

    /// Returns the name of one copy, whose indices must exist.
    fn one_of(
        &mut self,
        copies: &FxHashSet<Vec<i64>>,
        segment: &ast::PathSegment,
        numbers: &Numbers<'_>,
    ) -> Expanded<String> {
        let ast::PathSegment { name, indices } = segment;
        let values = self.values(indices, numbers)?;
        let copy = indexed(&name.text, &values);
        if copies.contains(&values) {
            return Ok(copy);
        }
        let ends = [copies.iter().min(), copies.iter().max()].map(|end| end.map(|end| indexed(&name.text, end)));
        let span = indices.iter().fold(name.span, |span, index| span.to(index.span));
        self.report_once(errors::no_such_copy(&copy, span, ends, numbers));
        Err(NotExpandable)
    }
}
