//! Dispatch of joints to their symbols; each symbol is drawn in a file of its own.

use super::drawing::Drawing;
use super::{belts, contacts, guides, pins};
use mechc_lang::model::JointFeature::{Axis, Point};
use mechc_text::vocabulary::JointSymbol;

/// Draws all joints but gears and racks.
pub(super) fn draw(drawing: &mut Drawing) {
    let model = drawing.features.model;
    for (number, joint) in model.joints.iter().enumerate() {
        let declaration = drawing.first.joints + number;
        let value = drawing.features.signed_value(joint);
        match (joint.spec.symbol, joint.features) {
            (JointSymbol::Pin, [Point(p), Point(q)]) => pins::revolute(drawing, declaration, [p, q]),
            (JointSymbol::Weld, [Point(p), Point(q)]) => pins::weld(drawing, declaration, [p, q]),
            (JointSymbol::Link, [Point(p), Point(q)]) => pins::massless_link(drawing, declaration, [p, q], value.abs()),
            (JointSymbol::Slider, [Axis(a), Axis(b)]) => guides::translational(drawing, declaration, [a, b]),
            (JointSymbol::Slot, [Point(p), Axis(axis)]) => guides::slot(drawing, declaration, p, axis, value),
            (JointSymbol::Belt, _) => belts::draw(drawing, number),
            (JointSymbol::Contact, features) => contacts::draw(drawing, number, features),
            _ => {}
        }
    }
}
