//! Parts: each is built as a mechanism and shares the model with those that enclose it.

use super::Builder;
use crate::check::expansion::Instance;
use crate::check::formulas::Formulas;
use crate::check::options::CheckOptions;
use crate::model::{Frame, Part};
use mechc_syntax::ast::{self, ItemKind};
use mechc_text::source::{Sources, Span};

impl Builder<'_, '_> {
    /// Adds a part to the model, with its ground.
    pub(super) fn add_part(&mut self, part: usize, written: &ast::Part) {
        if part >= self.formulas.parts.len() {
            return;
        }
        let zero = self.formulas.model.graph.constant(0.0);
        let declared = self.formulas.scope.declared(&written.name);
        let is_mirrored_in_parent = written.mirrored.is_some();
        let text = self.formulas.parts[part].scope.tree.name.span;
        let id = self.formulas.model.add_part(Part {
            text,
            params: self.formulas.parts[part].bound_numbers(),
            inputs: Vec::new(),
            ground_name: format!("{}.ground", declared.name),
            declared,
            within: self.formulas.address.part,
            mount: self.formulas.address.ground,
            pose: [zero; 3],
            is_mirrored_in_parent,
            is_mirrored: self.formulas.model.is_mirrored(self.formulas.address.part) != is_mirrored_in_parent,
        });
        self.in_part(part, |child| {
            child.formulas.address.part = Some(id);
            child.formulas.address.ground = Frame::Part(id);
            child.add_frames();
        });
    }
}

/// Returns the formulas of a mechanism with those of all its parts, each with its path and locations.
pub(in crate::check) fn formulas_of_instance<'a>(
    instance: &'a Instance<'a>,
    options: &'a CheckOptions,
    sources: &'a Sources,
    path: &str,
    used_at: &[(String, Span)],
) -> Formulas<'a> {
    let mut formulas = Formulas::new(instance.tree(), options, sources);
    formulas.scope.deciding = instance.deciding.clone();
    path.clone_into(&mut formulas.scope.path);
    formulas.reporter.used_at = used_at.to_vec();
    formulas.scope.collect(&mut formulas.reporter);
    let mut parts = instance.parts.iter();
    for item in &instance.tree().items {
        let ItemKind::Part(part) = &item.kind else { continue };
        let Some(inner) = parts.next() else { continue };
        let name = format!("{path}{}", part.name.text);
        let mut used_at = used_at.to_vec();
        used_at.insert(0, (name.clone(), part.name.span));
        let mut child = formulas_of_instance(inner, options, sources, &format!("{name}."), &used_at);
        child.bound.inputs = part.bindings.iter().map(|binding| binding.name.text.as_str()).collect();
        // The shared state is that of the outermost formulas from here on.
        formulas.reporter.diagnostics.extend(std::mem::take(&mut child.reporter.diagnostics));
        formulas.parts.push(child);
        formulas.scope.imports.push(Vec::new());
        formulas.part_declarations.push(part);
    }
    for path in &instance.paths {
        formulas.entity_inside(path);
    }
    formulas
}
