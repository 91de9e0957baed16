//! Bodies as links: a disc, a bar or a rounded plate around the positions of joints, or the axes of the frame if there are none.

use super::Look;
use super::drawing::{DOT, Drawing, Layer, Outline, shape};
use super::plane::{Path, Vector, around, distance, hull, plus};
use super::symbols::{BAR, SLOTTED_BAR, Symbols};

/// Positions of a body closer than this are one (symbol units).
const SAME_POSITION: f64 = 0.02;
/// Length of a body with a single position (symbol units).
const STUB: f64 = 1.6;

/// Returns whether all corners lie in one disc of the body.
fn is_covered(outline: &Outline, corners: &[Vector]) -> bool {
    outline
        .discs
        .iter()
        .any(|(center, radius)| corners.iter().all(|corner| distance(*corner, *center) <= 1.001 * radius))
}

/// Makes sure that a body which other shapes show has a node of its own.
fn add_missing_node(drawing: &mut Drawing, frame: usize) {
    if drawing.has_node(frame) || drawing.declare_block(frame) {
        return;
    }
    let positions = &drawing.outlines[frame].positions;
    let at = positions.first().copied().unwrap_or([0.0; 2]);
    let dot = Path::Circle { at, radius: DOT * drawing.unit };
    drawing.add_fixed(Layer::Bodies, frame, frame, vec![shape(Look::Dot, dot)]);
}

pub(super) fn draw(drawing: &mut Drawing) {
    for frame in 1..drawing.outlines.len() {
        let outline = &drawing.outlines[frame];
        let corners = hull(&outline.positions, SAME_POSITION * drawing.unit);
        let shapes = match corners.as_slice() {
            [] | [_] if outline.is_shown => {
                add_missing_node(drawing, frame);
                continue;
            }
            corners if !corners.is_empty() && is_covered(outline, corners) => continue,
            [] => vec![Symbols { unit: drawing.unit }.cross()],
            [at] => {
                // a stub makes the rotation visible
                let stub = [*at, plus(*at, [STUB * drawing.unit, 0.0])];
                vec![shape(Look::Link, around(&stub, BAR * drawing.unit))]
            }
            corners => {
                let reach = if outline.is_slotted { SLOTTED_BAR } else { BAR };
                vec![shape(Look::Link, around(corners, reach * drawing.unit))]
            }
        };
        drawing.add_fixed(Layer::Bodies, frame, frame, shapes);
    }
}
