//! Parts: each is checked as a mechanism, by its own checker, which shares the model with those that enclose it.

use super::features::Feature;
use super::instance::Instance;
use super::names::Space;
use super::variables::Variables;
use super::{CheckOptions, Checker};
use crate::model::{EquationId, Frame, Named, NamedId, Part, PartId, PointId};
use mechc_syntax::ast::{self, ItemKind};
use mechc_text::source::{Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// The state that a mechanism shares with its parts, besides the model and the diagnostics.
#[derive(Default)]
pub(super) struct SharedState {
    /// The features of each frame by their names.
    pub features: FxHashMap<Frame, Space<Feature>>,
    /// The points whose formulas hold a unit.
    pub dimensional_points: FxHashSet<PointId>,
    /// Frames whose drawn pose is broken.
    pub broken_poses: FxHashSet<Frame>,
    /// The graph's named symbols, and the order of time derivatives in each.
    pub named: FxHashMap<Named, NamedId>,
    pub derivative_orders: Vec<u8>,
    /// The values of the graph's nodes; NaN for those that are not constant.
    pub values: Vec<f64>,
    /// Equations of unknown dimension: a number without a unit scales both sides.
    pub plain_equations: FxHashSet<EquationId>,
    /// The bare numbers next to angles in degrees that have been reported.
    pub reported_radians: FxHashSet<Span>,
    /// The variables of derivatives.
    pub variables: Variables,
}

/// The position of a text in the whole mechanism.
pub(super) struct Address {
    /// The part in the model; `None` for the outermost mechanism.
    pub part: Option<PartId>,
    /// The frame of its ground.
    pub ground: Frame,
}

impl Default for Address {
    /// Returns the address of the outermost mechanism.
    fn default() -> Address {
        Address { part: None, ground: Frame::Ground }
    }
}

impl<'a> Checker<'a> {
    /// Returns the checker of a mechanism with those of all its parts, each with its path and locations.
    pub(super) fn from_instance(
        instance: &'a Instance<'a>,
        options: &'a CheckOptions,
        sources: &'a Sources,
        path: &str,
        used_at: &[(String, Span)],
    ) -> Checker<'a> {
        let mut checker = Checker::new(instance.tree(), options, sources);
        checker.scope.deciding = instance.deciding.clone();
        path.clone_into(&mut checker.scope.path);
        checker.reporter.used_at = used_at.to_vec();
        checker.scope.collect(&mut checker.reporter);
        let mut parts = instance.parts.iter();
        for item in &instance.tree().items {
            let ItemKind::Part(part) = &item.kind else { continue };
            let Some(inner) = parts.next() else { continue };
            let name = format!("{path}{}", part.name.text);
            let mut used_at = used_at.to_vec();
            used_at.insert(0, (name.clone(), part.name.span));
            let mut child = Checker::from_instance(inner, options, sources, &format!("{name}."), &used_at);
            child.bound.inputs = part.bindings.iter().map(|binding| binding.name.text.as_str()).collect();
            // The shared state is that of the outermost checker from here on.
            checker.reporter.diagnostics.extend(std::mem::take(&mut child.reporter.diagnostics));
            checker.parts.push(child);
            checker.scope.imports.push(Vec::new());
            checker.part_declarations.push(part);
        }
        for path in &instance.paths {
            checker.entity_inside(path);
        }
        checker
    }

    /// Runs `work` in the checker of a part, with the shared state.
    pub(super) fn in_part<T>(&mut self, part: usize, work: impl FnOnce(&mut Checker<'a>) -> T) -> T {
        let mut parts = std::mem::take(&mut self.parts);
        self.share_with(&mut parts[part]);
        let result = work(&mut parts[part]);
        self.share_with(&mut parts[part]);
        self.parts = parts;
        result
    }

    /// Swaps the shared state with another checker.
    fn share_with(&mut self, other: &mut Checker<'a>) {
        std::mem::swap(&mut self.reporter.diagnostics, &mut other.reporter.diagnostics);
        std::mem::swap(&mut self.model, &mut other.model);
        std::mem::swap(&mut self.common, &mut other.common);
    }

    /// Collects the variables of derivatives in the formulas of all texts.
    pub(super) fn collect_variables(&mut self) {
        self.common.variables.add(self.scope.tree, &self.scope.path);
        self.in_parts(Checker::collect_variables);
    }

    /// Runs `work` in every part.
    pub(super) fn in_parts(&mut self, work: impl Fn(&mut Checker<'a>)) {
        for part in 0..self.parts.len() {
            self.in_part(part, &work);
        }
    }

    /// Adds a part to the model, with its ground.
    pub(super) fn add_part(&mut self, part: usize, written: &ast::Part) {
        if part >= self.parts.len() {
            return;
        }
        let zero = self.model.graph.constant(0.0);
        let declared = self.scope.declared(&written.name);
        let is_mirrored_in_parent = written.mirrored.is_some();
        let text = self.parts[part].scope.tree.name.span;
        let id = self.model.add_part(Part {
            text,
            params: self.parts[part].bound_numbers(),
            inputs: Vec::new(),
            ground_name: format!("{}.ground", declared.name),
            declared,
            within: self.address.part,
            mount: self.address.ground,
            pose: [zero; 3],
            is_mirrored_in_parent,
            is_mirrored: self.model.is_mirrored(self.address.part) != is_mirrored_in_parent,
        });
        self.in_part(part, |child| {
            child.address.part = Some(id);
            child.address.ground = Frame::Part(id);
            child.add_frames();
        });
    }
}
