//! Gears and racks (H 3.4): circles that roll. They do not hold the distance of their centres.

use super::frames::Vector;
use super::{Entry, Lowering, entries};
use crate::model::{AxisId, CircleId, Joint, Side};
use mechc_expr::{Binary, Dependence, ExprId, Symbol, Unary};
use mechc_ir::{CoordinateKind, Fit, MonitorKind};
use mechc_text::vocabulary::Dimension;

impl Lowering<'_> {
    /// Returns the rows of a gear: `[−dx sin θ + dy cos θ, R_i(φ_i − θ) ± R_j(φ_j − θ) − κ]`, θ the direction of the line of centres.
    pub(super) fn gear(
        &mut self,
        joint: &Joint,
        circles: [CircleId; 2],
        internal: bool,
        phase: Option<ExprId>,
    ) -> Vec<Entry> {
        let drawn = self.in_drawn_poses(|l| l.line_of_centers(circles));
        let drawn_theta = self.drawn_direction(drawn);
        let phase = match phase {
            Some(phase) => self.formula(phase),
            None => self.in_drawn_poses(|l| l.rolled(circles, internal, drawn_theta)),
        };
        let theta = self.add_coordinate(joint, 0, CoordinateKind::Angle, drawn_theta);
        let [dx, dy] = self.line_of_centers(circles);
        let (cos, sin) = (self.graph.unary(Unary::Cos, theta), self.graph.unary(Unary::Sin, theta));
        let line = [cos, sin];
        let across = self.left_of(line, [dx, dy]);
        let rolled = self.rolled(circles, internal, theta);
        let mesh = self.graph.sub(rolled, phase);
        // The first row also holds at θ + π, which this sign excludes.
        let along = self.dot(line, [dx, dy]);
        let scale = circles.map(|circle| self.size(self.model[circle].frame));
        self.add_monitor(along, MonitorKind::LineOfCenters, f64::max(scale[0], scale[1]));
        let radii = circles.map(|circle| self.radius(circle));
        let wanted = if internal {
            let difference = self.graph.sub(radii[0], radii[1]);
            self.graph.unary(Unary::Abs, difference)
        } else {
            self.graph.add(radii[0], radii[1])
        };
        let distance = self.graph.binary(Binary::Hypot, dx, dy);
        let radius = self.graph.binary(Binary::Max, radii[0], radii[1]);
        self.fits.push(Fit { distance, wanted, radius, declaration: self.declarations.next_id() });
        entries(Dimension::LENGTH, [across, mesh])
    }

    /// Returns the direction of a drawn vector, in (−π, π]. Along a continuation it goes on from there, without a jump up to half a turn away.
    fn drawn_direction(&mut self, [dx, dy]: Vector) -> ExprId {
        let direction = self.graph.binary(Binary::Atan2, dy, dx);
        let model = self.model;
        if model.continued.is_empty() || !self.graph.dependence(direction).on(Dependence::PARAMS) {
            return direction;
        }
        let first_value = |k: u32| {
            let continued = model.continued.iter().find(|continued| continued.param == Some(k));
            continued.map_or(model.params[k as usize].value, |continued| continued.line[0])
        };
        let [x, y, first] = [dx, dy, direction].map(|id| {
            let value = self.graph.value(id, |symbol| match symbol {
                Symbol::Param(k) => first_value(k),
                Symbol::Shift(_) => 0.0,
                _ => f64::NAN,
            });
            self.graph.constant(value)
        });
        let across = self.left_of([x, y], [dx, dy]);
        let along = self.dot([x, y], [dx, dy]);
        let turn = self.graph.binary(Binary::Atan2, across, along);
        self.graph.add(first, turn)
    }

    fn radius(&mut self, circle: CircleId) -> ExprId {
        self.formula(self.model[circle].radius)
    }

    /// Returns the vector from centre to centre (m).
    fn line_of_centers(&mut self, [c, d]: [CircleId; 2]) -> Vector {
        let (from, to) = (self.position(self.model[c].center), self.position(self.model[d].center));
        self.difference(to, from)
    }

    /// Returns `R_i(φ_i − θ) ± R_j(φ_j − θ)` (m), with minus for an internal gear.
    fn rolled(&mut self, circles: [CircleId; 2], internal: bool, theta: ExprId) -> ExprId {
        let [first, second] = circles.map(|circle| {
            let phi = self.frame_coordinate(self.model[circle].frame, 2);
            let turn = self.graph.sub(phi, theta);
            let radius = self.radius(circle);
            self.graph.mul(radius, turn)
        });
        if internal { self.graph.sub(first, second) } else { self.graph.add(first, second) }
    }

    /// Returns the row of a rack: `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j) − κ`.
    pub(super) fn rack_pinion(
        &mut self,
        pinion: CircleId,
        rack: AxisId,
        phase: Option<ExprId>,
        side: Option<Side>,
    ) -> Vec<Entry> {
        let sigma = match side {
            Some(Side::Left) => self.graph.constant(1.0),
            Some(Side::Right) => self.graph.constant(-1.0),
            None => {
                let left = self.in_drawn_poses(|l| l.height(pinion, rack));
                self.graph.unary(Unary::Sign, left)
            }
        };
        let phase = match phase {
            Some(phase) => self.formula(phase),
            None => self.in_drawn_poses(|l| l.rolled_on(pinion, rack, sigma)),
        };
        let rolled = self.rolled_on(pinion, rack, sigma);
        let height = self.height(pinion, rack);
        // The distance is negative on the other side of the rack.
        let distance = self.graph.mul(sigma, height);
        let radius = self.radius(pinion);
        self.fits.push(Fit { distance, wanted: radius, radius, declaration: self.declarations.next_id() });
        entries(Dimension::LENGTH, [self.graph.sub(rolled, phase)])
    }

    /// Returns the vector from the rack's origin to the pinion's centre (m).
    fn pinion_offset(&mut self, pinion: CircleId, rack: AxisId) -> Vector {
        let (origin, center) = (self.position(self.model[rack].origin), self.position(self.model[pinion].center));
        self.difference(center, origin)
    }

    /// Returns the signed distance of the pinion's centre to the left of the rack's axis (m).
    fn height(&mut self, pinion: CircleId, rack: AxisId) -> ExprId {
        let (v, d) = (self.direction(rack), self.pinion_offset(pinion, rack));
        self.left_of(v, d)
    }

    /// Returns `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j)` (m).
    fn rolled_on(&mut self, pinion: CircleId, rack: AxisId, sigma: ExprId) -> ExprId {
        let (v, d) = (self.direction(rack), self.pinion_offset(pinion, rack));
        let along = self.dot(v, d);
        let frames = [self.model[pinion].frame, self.model[rack].frame];
        let [phi_i, phi_j] = frames.map(|frame| self.frame_coordinate(frame, 2));
        let turn = self.graph.sub(phi_i, phi_j);
        let radius = self.radius(pinion);
        let signed = self.graph.mul(sigma, radius);
        let rolled = self.graph.mul(signed, turn);
        self.graph.add(along, rolled)
    }
}
