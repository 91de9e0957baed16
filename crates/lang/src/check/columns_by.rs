//! The names of `--by`, and what of parts no derivative is taken by: what is bound where they are used.

use super::entity::Entity;
use super::mentions::mentioned;
use super::told::is_told_by;
use super::{Checker, errors};
use mechc_syntax::ast::{Expr, ItemKind, Name};
use mechc_text::diag::nearest;
use mechc_text::source::Span;

/// A binding of a param or input, and what it is made of, by its names in the whole mechanism.
pub(super) struct Bound {
    pub span: Span,
    /// Whether it is of one coordinate of a point alone.
    is_of_coordinate: bool,
    pub made_of: Vec<String>,
}

impl Checker<'_> {
    /// Looks the names of `--by` up, in the order given; what is named twice counts once.
    pub(super) fn look_over_by(&mut self) {
        for told in &self.around.by {
            if let Some((path, params)) = self.part_told(told) {
                self.report(errors::column_by_part(&path, &params));
                continue;
            }
            if let Some(bound) = self.binding_of(told) {
                self.report(errors::column_by_bound(told, bound.span, &bound.made_of));
                continue;
            }
            let found = self.variables_named(told);
            if found.is_empty() {
                self.no_column_by(told);
            }
            for variable in found {
                if !self.model.by.contains(&variable) {
                    self.model.by.push(variable);
                }
            }
        }
    }

    /// One of that name; the coordinates of a point; or all copies of a repeated input.
    fn variables_named(&self, told: &str) -> Vec<u32> {
        let known = |name: String| self.common.variables.known.get(&name).copied();
        if let Some(one) = known(told.to_owned()) {
            return vec![one];
        }
        let of_point: Vec<u32> = ["x", "y"].into_iter().filter_map(|axis| known(format!("{told}.{axis}"))).collect();
        if !of_point.is_empty() {
            return of_point;
        }
        let is_told = |name: &str| {
            let whole = name.rsplit_once('.').map(|(point, _)| point);
            is_told_by(name, told) || whole.is_some_and(|whole| is_told_by(whole, told))
        };
        let mut copies: Vec<u32> =
            self.common.variables.known.iter().filter(|(name, _)| is_told(name)).map(|(_, number)| *number).collect();
        copies.sort_unstable();
        copies
    }

    fn no_column_by(&mut self, told: &str) {
        let known = self.settable_names(settable);
        let is_known = |told: &str| known.iter().any(|(name, _)| is_told_by(name, told));
        let names = known.iter().map(|(name, _)| name.as_str());
        let free: Vec<&str> =
            names.filter(|name| !self.deciding.contains(*name) && self.binding_of(name).is_none()).collect();
        let whole = told.rsplit_once('.').map(|(point, _)| point).filter(|point| is_known(point));
        let mechanism = &self.tree.name.text;
        let diagnostic = if is_known(told) {
            if self.diagnostics.has_errors() && !self.deciding.contains(told) {
                return;
            }
            // all others have their columns
            errors::column_by_deciding(told)
        } else if whole.is_some() {
            errors::no_column_by(mechanism, told, None, whole, &free)
        } else if let Some(entity) = self.space.get(told) {
            errors::no_column_by(mechanism, told, Some(entity.noun()), None, &free)
        } else {
            let meant = nearest(told, free.iter().copied());
            errors::no_column_by(mechanism, told, None, meant, &free)
        };
        self.report(diagnostic);
    }

    /// A part that a name is told of, itself or with all copies, and what of it derivatives are taken by.
    fn part_told(&self, told: &str) -> Option<(String, Vec<String>)> {
        for child in &self.parts {
            let path = child.address.path.strip_suffix('.')?;
            if is_told_by(path, told) {
                let known = child.settable_names(settable).into_iter().map(|(name, _)| name);
                let numbers = known.filter(|name| !child.deciding.contains(name));
                let free = numbers.flat_map(|name| self.free_of(format!("{}{name}", child.address.path)));
                return Some((path.to_owned(), free.collect()));
            }
            if let Some(found) = child.part_told(told) {
                return Some(found);
            }
        }
        None
    }

    /// What is not bound of a param or input: itself, or coordinates of it.
    fn free_of(&self, path: String) -> Vec<String> {
        match self.binding_of(&path) {
            None => vec![path],
            Some(bound) if bound.is_of_coordinate => {
                let coordinates = ["x", "y"].into_iter().map(|axis| format!("{path}.{axis}"));
                coordinates.filter(|path| self.binding_of(path).is_none()).collect()
            }
            Some(_) => Vec::new(),
        }
    }

    /// The binding of what a path from the outermost mechanism is told of, which is in a part.
    pub(super) fn binding_of(&self, told: &str) -> Option<Bound> {
        for (child, part) in self.parts.iter().zip(&self.bindings) {
            for binding in &part.bindings {
                let name = format!("{}{}", child.address.path, binding.name.text);
                let axes = ["x", "y"]
                    .into_iter()
                    .filter(|axis| binding.coordinate.as_ref().is_none_or(|bound| bound.text == *axis));
                let mut coordinates = axes.map(|axis| format!("{name}.{axis}"));
                let is_point = child.is_point_name(&binding.name.text);
                if is_told_by(&name, told) || is_point && coordinates.any(|name| is_told_by(&name, told)) {
                    let made_of = self.free_names_in(&binding.value);
                    return Some(Bound { span: binding.span, is_of_coordinate: binding.coordinate.is_some(), made_of });
                }
            }
            if let Some(found) = child.binding_of(told) {
                return Some(found);
            }
        }
        None
    }

    /// The params and inputs that a formula names, by their paths.
    fn free_names_in(&self, formula: &Expr) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        mentioned(
            formula,
            |name| self.hidden.contains(name),
            |name, _| {
                let path = format!("{}{}", self.address.path, name.text);
                if matches!(self.entity(name), Some(Entity::Param(_) | Entity::Input(_))) && !found.contains(&path) {
                    found.push(path);
                }
            },
        );
        found
    }
}

fn settable(item: &ItemKind) -> Option<&Name> {
    match item {
        ItemKind::Param { name, .. } | ItemKind::Input { name, .. } => Some(name),
        _ => None,
    }
}
