//! Parts: each is checked as the mechanism that it is, by a checker of its own that shares the model with those around it.

use super::instance::Instance;
use super::{Checker, Surroundings};
use crate::model::{Frame, Part};
use crate::source::{Sources, Span};
use crate::syntax::ast::{self, ItemKind};

impl<'a> Checker<'a> {
    /// A checker of a mechanism with its parts, which are all there before anything of them is read; each knows its path, and where it is
    /// used.
    pub(super) fn of_instance(
        instance: &'a Instance<'a>,
        surroundings: &'a Surroundings,
        sources: &'a Sources,
        path: &str,
        used_at: &[(String, Span)],
    ) -> Checker<'a> {
        let mut checker = Checker::new(instance.tree(), surroundings, sources);
        checker.deciding = instance.deciding.clone();
        path.clone_into(&mut checker.path);
        checker.used_at = used_at.to_vec();
        checker.collect(instance.tree());
        let mut parts = instance.parts.iter();
        for item in &instance.tree().items {
            let ItemKind::Part(part) = &item.kind else { continue };
            let Some(inner) = parts.next() else { continue };
            let name = format!("{path}{}", part.name.text);
            let mut used_at = used_at.to_vec();
            used_at.insert(0, (name.clone(), part.name.span));
            let mut child = Checker::of_instance(inner, surroundings, sources, &format!("{name}."), &used_at);
            child.bound_inputs = part.bindings.iter().map(|binding| binding.name.text.as_str()).collect();
            // what is shared from now on is not the child's own
            checker.diagnostics.extend(std::mem::take(&mut child.diagnostics));
            checker.parts.push(child);
            checker.imports.push(Vec::new());
            checker.bindings.push(part);
        }
        for path in &instance.paths {
            checker.entity_inside(path);
        }
        checker
    }

    /// Work in a part, on the model that is shared.
    pub(super) fn in_part<T>(&mut self, part: usize, work: impl FnOnce(&mut Checker<'a>) -> T) -> T {
        let mut parts = std::mem::take(&mut self.parts);
        self.share_with(&mut parts[part]);
        let result = work(&mut parts[part]);
        self.share_with(&mut parts[part]);
        self.parts = parts;
        result
    }

    /// Gives what is shared to another checker, and takes what it has.
    fn share_with(&mut self, other: &mut Checker<'a>) {
        use std::mem::swap;
        swap(&mut self.diagnostics, &mut other.diagnostics);
        swap(&mut self.model, &mut other.model);
        swap(&mut self.features, &mut other.features);
        swap(&mut self.named, &mut other.named);
        swap(&mut self.derivative_orders, &mut other.derivative_orders);
        swap(&mut self.values, &mut other.values);
        swap(&mut self.dimensional_points, &mut other.dimensional_points);
        swap(&mut self.broken_poses, &mut other.broken_poses);
        swap(&mut self.variables, &mut other.variables);
    }

    /// Takes in by what the formulas of all texts are differentiated.
    pub(super) fn ask_for_derivatives(&mut self) {
        self.variables.add(self.tree, &self.path);
        self.in_parts(Checker::ask_for_derivatives);
    }

    /// The same work in every part.
    pub(super) fn in_parts(&mut self, work: impl Fn(&mut Checker<'a>)) {
        for part in 0..self.parts.len() {
            self.in_part(part, &work);
        }
    }

    /// The ground of a part, and what stands in it.
    pub(super) fn add_part(&mut self, part: usize, written: &ast::Part) {
        if part >= self.parts.len() {
            return;
        }
        let zero = self.model.graph.constant(0.0);
        let declared = self.declared(&written.name);
        let is_turned_over = written.mirrored.is_some();
        let text = self.parts[part].tree.name.span;
        let id = self.model.add_part(Part {
            text,
            params: self.parts[part].bound_numbers(),
            inputs: Vec::new(),
            ground_name: format!("{}.ground", declared.name),
            declared,
            within: self.part,
            mount: self.ground,
            pose: [zero; 3],
            is_turned_over,
            is_mirrored: self.model.is_mirrored(self.part) != is_turned_over,
        });
        self.in_part(part, |child| {
            child.part = Some(id);
            child.ground = Frame::Part(id);
            child.add_frames();
        });
    }
}
