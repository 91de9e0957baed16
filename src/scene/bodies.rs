//! Bodies as links: a disc, a bar, a rounded plate around what joints take hold of; the cross of a frame where nothing does.

use super::Look;
use super::drawing::{Drawing, Layer, shape};
use super::plane::{around, hull};
use super::symbols::{BAR, Symbols};

/// Places of a body that are nearer to each other than this, in units, are one.
const NEAR: f64 = 0.02;

pub(super) fn draw(drawing: &mut Drawing) {
    for frame in 1..drawing.outlines.len() {
        let outline = &drawing.outlines[frame];
        let corners = hull(&outline.places, NEAR * drawing.unit);
        let shapes = match corners.as_slice() {
            [] if outline.is_shown => continue,
            [] => vec![Symbols { unit: drawing.unit }.cross()],
            [_] if outline.is_shown => continue,
            corners => vec![shape(Look::Link, around(corners, BAR * drawing.unit))],
        };
        drawing.add_fixed(Layer::Bodies, frame, frame, shapes);
    }
}
