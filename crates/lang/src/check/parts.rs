//! Parts: each is checked as the mechanism that it is, by a checker of its own that shares the model with those around it.

use super::features::Feature;
use super::instance::Instance;
use super::names::Space;
use super::variables::Variables;
use super::{Checker, Surroundings};
use crate::model::{EquationId, Frame, Named, NamedId, Part, PartId, PointId};
use mechc_syntax::ast::{self, ItemKind};
use mechc_text::source::{Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// What a mechanism and all its parts have in common, beside the model and what is said.
#[derive(Default)]
pub(super) struct Common {
    /// By what they are on: curves, points and so on, by their names.
    pub features: FxHashMap<Frame, Space<Feature>>,
    /// The points whose formulas hold a unit.
    pub dimensional_points: FxHashSet<PointId>,
    /// Bodies whose place in the drawing is not known.
    pub broken_poses: FxHashSet<Frame>,
    /// The graph's named symbols, and how many time derivatives each holds.
    pub named: FxHashMap<Named, NamedId>,
    pub derivative_orders: Vec<u8>,
    /// Values of the graph's nodes, NaN where they are not constant.
    pub values: Vec<f64>,
    /// Those equations whose dimension is not known: a number without a unit scales both sides.
    pub plain_equations: FxHashSet<EquationId>,
    /// The bare numbers beside angles in degrees that have been told.
    pub beside_degrees: FxHashSet<Span>,
    /// What derivatives are taken by.
    pub variables: Variables,
}

/// Where a text stands in the whole mechanism.
pub(super) struct Address {
    /// What its names begin with there: `leg[2].`, or nothing.
    pub path: String,
    /// Of a part: what it is in the model.
    pub part: Option<PartId>,
    /// What its ground is there.
    pub ground: Frame,
    /// Of a part: its name and those of the parts around it, and where they stand.
    pub used_at: Vec<(String, Span)>,
}

impl Default for Address {
    /// That of the whole.
    fn default() -> Address {
        Address { path: String::new(), part: None, ground: Frame::Ground, used_at: Vec::new() }
    }
}

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
        path.clone_into(&mut checker.address.path);
        checker.address.used_at = used_at.to_vec();
        checker.collect(instance.tree());
        let mut parts = instance.parts.iter();
        for item in &instance.tree().items {
            let ItemKind::Part(part) = &item.kind else { continue };
            let Some(inner) = parts.next() else { continue };
            let name = format!("{path}{}", part.name.text);
            let mut used_at = used_at.to_vec();
            used_at.insert(0, (name.clone(), part.name.span));
            let mut child = Checker::of_instance(inner, surroundings, sources, &format!("{name}."), &used_at);
            child.bound.inputs = part.bindings.iter().map(|binding| binding.name.text.as_str()).collect();
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
        std::mem::swap(&mut self.diagnostics, &mut other.diagnostics);
        std::mem::swap(&mut self.model, &mut other.model);
        std::mem::swap(&mut self.common, &mut other.common);
    }

    /// Takes in by what the formulas of all texts are differentiated.
    pub(super) fn ask_for_derivatives(&mut self) {
        self.common.variables.add(self.tree, &self.address.path);
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
            within: self.address.part,
            mount: self.address.ground,
            pose: [zero; 3],
            is_turned_over,
            is_mirrored: self.model.is_mirrored(self.address.part) != is_turned_over,
        });
        self.in_part(part, |child| {
            child.address.part = Some(id);
            child.address.ground = Frame::Part(id);
            child.add_frames();
        });
    }
}
