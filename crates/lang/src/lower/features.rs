//! Axes, circles and the attachment points of joints. No equation needs them, but explanations and exports do.

use super::Lowering;
use super::frames::Vector;
use crate::model::{self, Joint, JointId};
use mechc_ir::{Axis, Circle, ConstraintSystem, DeclarationId};

impl Lowering<'_> {
    /// Adds axes, circles and the attachment points of joints to a system. Nothing that is already there changes.
    pub(super) fn add_features(&mut self, system: &mut ConstraintSystem) {
        self.graph = std::mem::take(system.graph_mut());
        let model = self.model;
        let axes = model.axes.iter().map(|axis| self.axis(axis)).collect();
        let circles = model.circles.iter().map(|circle| self.circle(circle)).collect();
        let joints = model
            .joint_ids()
            .filter_map(|joint| Some((super::joint_declaration(joint), self.attachment_point(joint)?)));
        let places: Vec<(DeclarationId, Vector)> = joints.collect();
        *system.graph_mut() = std::mem::take(&mut self.graph);
        system.add_features(axes, circles, places);
    }

    fn axis(&mut self, axis: &model::Axis) -> Axis {
        let local = self.unit_direction(axis);
        let carried = self.in_carrier(axis.frame);
        let direction =
            if self.model.part_of(axis.frame).is_none() { local } else { carried.turned(&mut self.graph, local) };
        let name = format!("{}.{}", self.model.frame_name(axis.frame), axis.name);
        Axis { name, origin: super::ir_point(axis.origin), direction }
    }

    fn circle(&mut self, circle: &model::Circle) -> Circle {
        let name = format!("{}.{}", self.model.frame_name(circle.frame), circle.name);
        Circle { name, center: super::ir_point(circle.center), radius: self.formula(circle.radius) }
    }

    /// Returns the attachment point of a joint (m) in the ground's frame: its second point, the origin of its second axis, the centre of
    /// its second circle, or its contact.
    pub(super) fn attachment_point(&mut self, joint: JointId) -> Option<Vector> {
        let Joint { spec, features, .. } = &self.model[joint];
        if spec.has_contact() {
            return self.contact_position(joint);
        }
        features[1].point(self.model).map(|point| self.position(point))
    }
}
