//! Parts: each is checked as the mechanism that it is, by a checker of its own that shares the model with those around it.

use super::instance::Instance;
use super::sites::Site;
use super::{Checker, Surroundings, errors};
use crate::expr::{ExprId, Graph};
use crate::model::{Frame, Part, Placement};
use crate::source::{Sources, Span};
use crate::syntax::ast::{self, Expr, ExprKind, ItemKind};

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

    /// What carries each part, and where.
    pub(super) fn mount_parts(&mut self) {
        for k in 0..self.parts.len() {
            let written = self.bindings[k];
            let mount = written.on.as_ref().map(|on| self.carrier_of(on));
            let pose = written.at.as_ref().map(|at| self.at_site(Site::Drawing, None, |c| c.pose_of_part(at)));
            let Some(id) = self.parts[k].part else { continue };
            let own = Frame::Part(id);
            if let Some(Some(mount)) = mount {
                if self.model.carrier_chain(mount).any(|frame| frame == own) {
                    self.report(errors::carries_itself(
                        &written.name,
                        written.on.as_ref().map_or(written.name.span, |on| on.span),
                    ));
                } else {
                    self.model.parts[id.index()].mount = mount;
                }
            }
            if let Some(Some(pose)) = pose {
                self.model.parts[id.index()].pose = pose;
            }
        }
        self.in_parts(Checker::mount_parts);
    }

    fn carrier_of(&mut self, on: &Expr) -> Option<Frame> {
        if let ExprKind::Name(name) = &on.kind {
            return self.body(name);
        }
        self.wrong_kind(on.span, "a body", Self::describe(on));
        None
    }

    /// A part's frame: those of the poses of bodies that need no body.
    fn pose_of_part(&mut self, at: &Expr) -> Option<[ExprId; 3]> {
        let (place, phi) = self.place_and_angle(at)?;
        let ([x, y], phi) = (place?, phi?);
        Some([x, y, phi])
    }

    /// Where a frame is drawn in that of this text.
    pub(super) fn drawn_frame(&mut self, frame: Frame) -> Placement {
        let mut graph = std::mem::replace(&mut self.model.graph, Graph::new());
        let placement = self.model.drawn(&mut graph, &mut |_, id| id, self.part, frame);
        self.model.graph = graph;
        placement
    }

    /// Whether a frame moves, as this text sees it.
    pub(super) fn moves(&self, frame: Frame) -> bool {
        let mut chain = self.model.carrier_chain(frame);
        chain.find_map(|frame| match frame {
            _ if frame == self.ground => Some(false),
            Frame::Body(_) => Some(true),
            Frame::Ground => Some(false),
            Frame::Part(_) => None,
        }) == Some(true)
    }
}
