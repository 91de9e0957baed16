//! The features of a mechanism, and where its joints take hold: what others ask for, and no equation needs.

use super::Lowering;
use super::frames::Vector;
use crate::model::{self, JointId, JointKind};
use mechc_ir::{Axis, Circle, ConstraintSystem, DeclarationId};

impl Lowering<'_> {
    /// Gives a system its axes and circles, and its joints the places where they take hold. They change nothing of what is there.
    pub(super) fn add_features(&mut self, system: &mut ConstraintSystem) {
        self.graph = std::mem::take(system.graph_mut());
        let model = self.model;
        let axes = model.axes.iter().map(|axis| self.axis(axis)).collect();
        let circles = model.circles.iter().map(|circle| self.circle(circle)).collect();
        let joints = model.joint_ids().filter_map(|joint| Some((super::of_joint(joint), self.place(joint)?)));
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
        Axis { name, origin: super::same_point(axis.origin), direction }
    }

    fn circle(&mut self, circle: &model::Circle) -> Circle {
        let name = format!("{}.{}", self.model.frame_name(circle.frame), circle.name);
        Circle { name, center: super::same_point(circle.center), radius: self.formula(circle.radius) }
    }

    /// Where a joint takes hold (m), in the ground's frame: of its second point, of the second axis' point, of the second circle's centre,
    /// of the contact.
    pub(super) fn place(&mut self, joint: JointId) -> Option<Vector> {
        let model = self.model;
        let point = match model[joint].kind {
            JointKind::Revolute(_, q) | JointKind::Weld(_, q, _) | JointKind::RevoluteRevolute(_, q, _) => q,
            JointKind::Translational(_, axis)
            | JointKind::RevoluteTranslational(_, axis, _)
            | JointKind::RackPinion { rack: axis, .. } => model[axis].origin,
            JointKind::Gear { circles: [_, second], .. } => model[second].center,
            JointKind::PointFollower(..) | JointKind::Cam(..) | JointKind::FlatFollower(..) => {
                return self.contact_place(joint);
            }
        };
        Some(self.global(point))
    }
}
