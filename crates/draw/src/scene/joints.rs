//! Dispatch of joints to their symbols; each kind is drawn in a file of its own.

use super::drawing::Drawing;
use super::{contacts, guides, pins};
use mechc_lang::model::JoinedFeatures;

/// Draws all joints but gears and racks.
pub(super) fn draw(drawing: &mut Drawing) {
    let model = drawing.features.model;
    for (number, joint) in model.joints.iter().enumerate() {
        let declaration = drawing.first.joints + number;
        match joint.features {
            JoinedFeatures::Revolute(p, q) => pins::revolute(drawing, declaration, [p, q]),
            JoinedFeatures::Weld(p, q, _) => pins::weld(drawing, declaration, [p, q]),
            JoinedFeatures::RevoluteRevolute(p, q, length) => {
                let length = drawing.features.value(length);
                pins::massless_link(drawing, declaration, [p, q], length);
            }
            JoinedFeatures::Translational(a, b) => guides::translational(drawing, declaration, [a, b]),
            JoinedFeatures::RevoluteTranslational(p, axis, offset) => {
                let offset = drawing.features.value(offset);
                let offset = if model.is_mirrored(joint.part) { -offset } else { offset };
                guides::slot(drawing, declaration, p, axis, offset);
            }
            JoinedFeatures::PointFollower(p, profile) => contacts::point_follower(drawing, number, p, profile),
            JoinedFeatures::Cam(k, m) => contacts::cam(drawing, number, [k, m]),
            JoinedFeatures::FlatFollower(profile, face) => contacts::flat_follower(drawing, number, profile, face),
            JoinedFeatures::Gear { .. } | JoinedFeatures::RackPinion { .. } => {}
        }
    }
}
