//! Sliders: blocks on guides, bars in sleeves, pins in slots. Guides are as long as the motion requires.

use super::drawing::{DOT, Drawing, Layer, Outline, shape};
use super::features::Line;
use super::plane::{Path, Vector, cross, distance, dot, left, minus, plus, rectangle, times};
use super::symbols::{BLOCK, SLEEVE, SLOT, Symbols};
use super::{Anchor, Look};
use mechc_lang::model::{AxisId, JointFeature, PointId};
use mechc_text::vocabulary::JointSymbol;

/// Length of a guide beyond the slider (symbol units).
const BEYOND: f64 = 0.5;
/// Shortest stroke that a guide shows (symbol units).
const LEAST_STROKE: f64 = 1.2;
/// Distance of a sleeve from what its bar carries (symbol units).
const TO_SLEEVE: f64 = 3.2;

/// Returns the position at a coordinate of a line.
fn point_on(line: &Line, along: f64) -> Vector {
    plus(line.at, times(along, line.along))
}

/// Widens a range about its middle to at least a length.
fn widen([low, high]: [f64; 2], least: f64) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [-0.5 * least, 0.5 * least];
    }
    let short = (0.5 * (least - (high - low))).max(0.0);
    [low - short, high + short]
}

impl Drawing<'_> {
    /// Returns the range of an anchor's coordinate along a line.
    pub fn range_on(&self, line: &Line, anchor: Anchor) -> [f64; 2] {
        self.range(|row| dot(line.along, minus(self.position_in(anchor, line.frame, row), line.at)))
    }
}

pub(super) fn translational(drawing: &mut Drawing, declaration: usize, [a, b]: [AxisId; 2]) {
    let [first, second] = [a, b].map(|axis| drawing.features.axis(axis));
    // the ground is the guide, otherwise the first of the two
    let (guide, slider, axis) = if second.frame == 0 { (second, first, a) } else { (first, second, b) };
    let origin = Anchor { frame: slider.frame, at: slider.at };
    let stroke = drawing.range_on(&guide, origin);
    match obstruction(drawing, axis) {
        Some(obstruction) => draw_in_sleeve(drawing, declaration, &guide, &slider, stroke, obstruction),
        None if guide.frame == 0 => draw_on_ground(drawing, declaration, &guide, &slider, stroke),
        None => draw_on_bar(drawing, declaration, &guide, &slider, stroke),
    }
    let pin = drawing.features.model[axis].origin;
    if let Some(point) = drawing.point_index(&[pin]).filter(|_| drawing.features.model[pin].name.is_some()) {
        // the slider's point belongs to a joint and may have no pin
        let dot = Path::Circle { at: slider.at, radius: DOT * drawing.unit };
        let dot = super::Shape { path: dot, look: Look::Dot, point: Some(point) };
        drawing.add_fixed(Layer::Blocks, declaration, slider.frame, vec![dot]);
    }
}

/// Draws a block on the edge of the ground.
fn draw_on_ground(drawing: &mut Drawing, declaration: usize, guide: &Line, slider: &Line, stroke: [f64; 2]) {
    let (unit, symbols) = (drawing.unit, Symbols { unit: drawing.unit });
    let [low, high] = widen(stroke, LEAST_STROKE * unit);
    let beyond = (BLOCK[0] + BEYOND) * unit;
    // the ground is below the slider, or to its right
    let [x, y] = guide.along;
    let is_forward = if x.abs() > 1e-3 { x > 0.0 } else { y > 0.0 };
    let side = if is_forward { 1.0 } else { -1.0 };
    let down = times(-side * BLOCK[1] * unit, left(guide.along));
    let ends = [point_on(guide, low - beyond), point_on(guide, high + beyond)].map(|end| plus(end, down));
    let [from, to] = if is_forward { ends } else { [ends[1], ends[0]] };
    drawing.add_fixed(Layer::Ground, declaration, 0, symbols.edge(from, to).to_vec());
    let block = symbols.block(slider.at, slider.along);
    drawing.add_fixed(Layer::Blocks, declaration, slider.frame, vec![block]);
    drawing.outlines[slider.frame].is_shown = true;
}

/// Draws a block on a bar of another body.
fn draw_on_bar(drawing: &mut Drawing, declaration: usize, guide: &Line, slider: &Line, stroke: [f64; 2]) {
    let (unit, symbols) = (drawing.unit, Symbols { unit: drawing.unit });
    let [low, high] = widen(stroke, LEAST_STROKE * unit);
    let beyond = (BLOCK[0] + BEYOND) * unit;
    let ends = [point_on(guide, low - beyond), point_on(guide, high + beyond)];
    drawing.outlines[guide.frame].positions.extend(ends);
    let block = symbols.block(slider.at, slider.along);
    drawing.add_fixed(Layer::Blocks, declaration, slider.frame, vec![block]);
    drawing.outlines[slider.frame].is_shown = true;
}

/// A contact in the place of a block.
#[derive(Clone, Copy)]
struct Obstruction {
    /// Anchor from which the bar leads away.
    away_from: Option<Anchor>,
    /// Extent of the contact (m).
    reach: f64,
}

/// Returns the contact at the origin of a slider's axis, if there is one.
fn obstruction(drawing: &Drawing, axis: AxisId) -> Option<Obstruction> {
    let model = drawing.features.model;
    let slider = drawing.features.axis(axis);
    let near = |anchor: Anchor| anchor.frame == slider.frame && distance(anchor.at, slider.at) < 2.5 * drawing.unit;
    // a plate usually turns about its origin
    let middle = |feature: JointFeature| match feature.point(model) {
        Some(point) => drawing.features.point(point),
        None => drawing.features.resolve(feature.frame(model), [0.0, 0.0]),
    };
    let obstruction_at = |feature: JointFeature, other: JointFeature| {
        let reach = feature.circle().map_or(0.0, |circle| drawing.features.circle(circle).radius);
        near(middle(feature)).then(|| Obstruction { away_from: Some(middle(other)), reach })
    };
    model.joints.iter().find_map(|joint| {
        let [first, second] = joint.features;
        match (joint.spec.symbol, first.profile(), second.profile()) {
            // a profile obstructs nothing but another one
            (JointSymbol::Contact, None, _) => obstruction_at(first, second),
            (JointSymbol::Contact, _, None) => obstruction_at(second, first),
            (JointSymbol::Contact, ..) => obstruction_at(first, second).or_else(|| obstruction_at(second, first)),
            (JointSymbol::Rack, ..) => near(middle(second)).then_some(Obstruction { away_from: None, reach: 0.0 }),
            _ => None,
        }
    })
}

/// Draws a bar of the sliding body in a sleeve of the other body.
fn draw_in_sleeve(
    drawing: &mut Drawing,
    declaration: usize,
    guide: &Line,
    slider: &Line,
    stroke: [f64; 2],
    obstruction: Obstruction,
) {
    let (unit, symbols) = (drawing.unit, Symbols { unit: drawing.unit });
    let poses = drawing.motion.poses(0);
    let ahead = poses[guide.frame].rotate(guide.along);
    let has_same_sense = dot(ahead, poses[slider.frame].rotate(slider.along)) >= 0.0;
    let sign = match obstruction.away_from {
        Some(other) => {
            let origin = Anchor { frame: slider.frame, at: slider.at };
            if dot(ahead, minus(origin.position(poses), other.position(poses))) < 0.0 { -1.0 } else { 1.0 }
        }
        None => 1.0,
    };
    let [low, high] = widen(stroke, 0.0);
    let (near, far) = if sign > 0.0 { (low, high) } else { (-high, -low) };
    let to_sleeve = obstruction.reach + TO_SLEEVE * unit;
    let along = sign * (far + to_sleeve);
    let middle = point_on(guide, along);
    if guide.frame == 0 {
        let across = times(SLEEVE[1] * unit, left(guide.along));
        let half = times(SLEEVE[0] * unit, guide.along);
        let mut shapes = Vec::new();
        shapes.extend(
            symbols.edge(plus(minus(middle, half), minus([0.0; 2], across)), minus(plus(middle, half), across)),
        );
        shapes.extend(symbols.edge(plus(plus(middle, half), across), plus(minus(middle, half), across)));
        drawing.add_fixed(Layer::Feet, declaration, 0, shapes);
    } else {
        let sleeve = rectangle(middle, guide.along, SLEEVE[0] * unit, 1.3 * SLEEVE[1] * unit);
        drawing.add_fixed(Layer::Blocks, declaration, guide.frame, vec![shape(Look::Sleeve, sleeve)]);
        drawing.outlines[guide.frame].positions.push(middle);
    }
    // the bar reaches through the sleeve in every position
    let long = (far - near) + to_sleeve + (SLEEVE[0] + 0.4) * unit;
    let outward = if has_same_sense { sign } else { -sign };
    let Outline { positions, .. } = &mut drawing.outlines[slider.frame];
    positions.extend([slider.at, plus(slider.at, times(outward * long, slider.along))]);
    if obstruction.away_from.is_none() {
        // a rack is held on both sides
        positions.push(plus(slider.at, times(-outward * long, slider.along)));
    }
}

/// Draws a pin in a slot.
pub(super) fn slot(drawing: &mut Drawing, declaration: usize, p: PointId, axis: AxisId, offset: f64) {
    let (unit, symbols) = (drawing.unit, Symbols { unit: drawing.unit });
    let line = drawing.features.axis(axis);
    let line = Line { at: plus(line.at, times(offset, left(line.along))), ..line };
    let pin = drawing.features.point(p);
    let [low, high] = widen(drawing.range_on(&line, pin), LEAST_STROKE * unit);
    let ends = [point_on(&line, low), point_on(&line, high)];
    let stadium = symbols.stadium(ends[0], ends[1], SLOT, Look::Slot);
    if line.frame == 0 {
        let [x, y] = line.along;
        let is_forward = if x.abs() > 1e-3 { x > 0.0 } else { y > 0.0 };
        let down = times(if is_forward { -SLOT * unit } else { SLOT * unit }, left(line.along));
        let [from, to] = if is_forward { ends } else { [ends[1], ends[0]] };
        let hatching = symbols.hatching(plus(from, down), plus(to, down));
        drawing.add_fixed(Layer::Ground, declaration, 0, vec![hatching, stadium]);
    } else {
        let outline = &mut drawing.outlines[line.frame];
        outline.positions.extend(ends);
        outline.is_slotted = true;
        drawing.add_fixed(Layer::Slots, declaration, line.frame, vec![stadium]);
    }
    if pin.frame == 0 {
        super::pins::single_pin(drawing, declaration, p);
    } else {
        let point = drawing.point_index(&[p]);
        let pin_shape = symbols.pin(pin.at, point);
        drawing.add_fixed(Layer::Pins, declaration, pin.frame, vec![pin_shape]);
    }
}

/// Returns the signed distance of a position from a line (m), positive on its left.
pub(super) fn height(line: &Line, position: Vector) -> f64 {
    cross(line.along, minus(position, line.at))
}
