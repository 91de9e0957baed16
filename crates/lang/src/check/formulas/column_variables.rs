//! The names of `--by`, and the params and inputs of parts that have no derivatives because they are bound.

use super::Formulas;
use super::overrides::override_matches;
use crate::check::errors;
use mechc_syntax::ast::{ItemKind, Name};
use mechc_text::diag::nearest;
use mechc_text::source::Span;

/// The binding of a param or input, and the full names that its formula uses.
pub(super) struct PathBinding {
    pub span: Span,
    /// True if it binds one coordinate of a point only.
    is_of_coordinate: bool,
    pub made_of: Vec<String>,
}

impl Formulas<'_> {
    /// Resolves the names of `--by` in their order. Repeated names count once.
    pub(in crate::check) fn resolve_column_variables(&mut self) {
        for name in &self.options.by {
            if let Some((path, params)) = self.part_named(name) {
                self.reporter.report(errors::column_by_part(&path, &params));
                continue;
            }
            if let Some(bound) = self.binding_of(name) {
                self.reporter.report(errors::column_by_bound(name, bound.span, &bound.made_of));
                continue;
            }
            let found = self.variables_named(name);
            if found.is_empty() {
                self.no_column_by(name);
            }
            for variable in found {
                if !self.model.by.contains(&variable) {
                    self.model.by.push(variable);
                }
            }
        }
    }

    /// Returns the variables of a name: one, the coordinates of a point, or all copies of a repeated input.
    fn variables_named(&self, path: &str) -> Vec<u32> {
        let number_of = |name: String| self.common.variables.numbers.get(&name).copied();
        if let Some(one) = number_of(path.to_owned()) {
            return vec![one];
        }
        let of_point: Vec<u32> =
            ["x", "y"].into_iter().filter_map(|axis| number_of(format!("{path}.{axis}"))).collect();
        if !of_point.is_empty() {
            return of_point;
        }
        let matches = |name: &str| {
            let whole = name.rsplit_once('.').map(|(point, _)| point);
            override_matches(name, path) || whole.is_some_and(|whole| override_matches(whole, path))
        };
        let mut copies: Vec<u32> =
            self.common.variables.numbers.iter().filter(|(name, _)| matches(name)).map(|(_, number)| *number).collect();
        copies.sort_unstable();
        copies
    }

    fn no_column_by(&mut self, path: &str) {
        let settable_names = self.settable_names(settable);
        let is_settable = |path: &str| settable_names.iter().any(|(name, _)| override_matches(name, path));
        let names = settable_names.iter().map(|(name, _)| name.as_str());
        let free: Vec<&str> =
            names.filter(|name| !self.scope.deciding.contains(*name) && self.binding_of(name).is_none()).collect();
        let whole = path.rsplit_once('.').map(|(point, _)| point).filter(|point| is_settable(point));
        let mechanism = &self.scope.tree.name.text;
        let diagnostic = if is_settable(path) {
            if self.reporter.diagnostics.has_errors() && !self.scope.deciding.contains(path) {
                return;
            }
            // All other names have variables.
            errors::column_by_deciding(path)
        } else if whole.is_some() {
            errors::no_column_by(mechanism, path, None, whole, &free)
        } else if let Some(entity) = self.scope.get(path) {
            errors::no_column_by(mechanism, path, Some(entity.noun()), None, &free)
        } else {
            let meant = nearest(path, free.iter().copied());
            errors::no_column_by(mechanism, path, None, meant, &free)
        };
        self.reporter.report(diagnostic);
    }

    /// Returns the part that a name refers to, alone or with all copies, and its params and inputs that have derivatives.
    fn part_named(&self, query: &str) -> Option<(String, Vec<String>)> {
        for child in &self.parts {
            let path = child.scope.path.strip_suffix('.')?;
            if override_matches(path, query) {
                let settable_names = child.settable_names(settable).into_iter().map(|(name, _)| name);
                let numbers = settable_names.filter(|name| !child.scope.deciding.contains(name));
                let free = numbers.flat_map(|name| self.unbound_names(format!("{}{name}", child.scope.path)));
                return Some((path.to_owned(), free.collect()));
            }
            if let Some(found) = child.part_named(query) {
                return Some(found);
            }
        }
        None
    }

    /// Returns the name of a param or input, or the names of its coordinates, without those that are bound.
    fn unbound_names(&self, path: String) -> Vec<String> {
        match self.binding_of(&path) {
            None => vec![path],
            Some(bound) if bound.is_of_coordinate => {
                let coordinates = ["x", "y"].into_iter().map(|axis| format!("{path}.{axis}"));
                coordinates.filter(|path| self.binding_of(path).is_none()).collect()
            }
            Some(_) => Vec::new(),
        }
    }

    /// Returns the binding of a path into a part.
    pub(super) fn binding_of(&self, path: &str) -> Option<PathBinding> {
        for (child, part) in self.parts.iter().zip(&self.part_declarations) {
            for binding in &part.bindings {
                let name = format!("{}{}", child.scope.path, binding.name.text);
                let axes = ["x", "y"]
                    .into_iter()
                    .filter(|axis| binding.coordinate.as_ref().is_none_or(|bound| bound.text == *axis));
                let mut coordinates = axes.map(|axis| format!("{name}.{axis}"));
                let is_point = child.scope.is_point_name(&binding.name.text);
                if override_matches(&name, path) || is_point && coordinates.any(|name| override_matches(&name, path)) {
                    let made_of = self.scope.free_names_in(&binding.value);
                    return Some(PathBinding {
                        span: binding.span,
                        is_of_coordinate: binding.coordinate.is_some(),
                        made_of,
                    });
                }
            }
            if let Some(found) = child.binding_of(path) {
                return Some(found);
            }
        }
        None
    }
}

fn settable(item: &ItemKind) -> Option<&Name> {
    match item {
        ItemKind::Param { name, .. } | ItemKind::Input { name, .. } => Some(name),
        _ => None,
    }
}
