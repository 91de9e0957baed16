//! Gears and racks (H 3.4): circles that roll, without holding their centres apart.

use super::frames::Vector;
use super::{Entry, Lowering, entries};
use crate::model::{AxisId, CircleId, Joint, Side};
use mechc_expr::{Binary, ExprId, Unary};
use mechc_ir::{CoordinateKind, Fit, RowUnit, WatchKind};

impl Lowering<'_> {
    /// `[−dx sin θ + dy cos θ, R_i(φ_i − θ) ± R_j(φ_j − θ) − κ]`, θ the direction of the line of centres.
    pub(super) fn gear(
        &mut self,
        joint: &Joint,
        circles: [CircleId; 2],
        internal: bool,
        phase: Option<ExprId>,
    ) -> Vec<Entry> {
        let drawn = self.as_drawn(|l| l.line_of_centers(circles));
        let drawn_theta = self.graph.binary(Binary::Atan2, drawn[1], drawn[0]);
        let phase = match phase {
            Some(phase) => self.formula(phase),
            None => self.as_drawn(|l| l.rolled(circles, internal, drawn_theta)),
        };
        let theta = self.own_coordinate(joint, 0, CoordinateKind::Angle, drawn_theta);
        let [dx, dy] = self.line_of_centers(circles);
        let (cos, sin) = (self.graph.unary(Unary::Cos, theta), self.graph.unary(Unary::Sin, theta));
        let line = [cos, sin];
        let across = self.left_of(line, [dx, dy]);
        let rolled = self.rolled(circles, internal, theta);
        let mesh = self.graph.sub(rolled, phase);
        // the first row holds at θ + π too
        let along = self.dot(line, [dx, dy]);
        let scale = circles.map(|circle| self.size(self.model[circle].frame));
        self.watch(along, WatchKind::LineOfCenters, f64::max(scale[0], scale[1]));
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
        entries(RowUnit::LENGTH, [across, mesh])
    }

    fn radius(&mut self, circle: CircleId) -> ExprId {
        self.formula(self.model[circle].radius)
    }

    /// From centre to centre (m).
    fn line_of_centers(&mut self, [c, d]: [CircleId; 2]) -> Vector {
        let (from, to) = (self.global(self.model[c].center), self.global(self.model[d].center));
        self.minus(to, from)
    }

    /// `R_i(φ_i − θ) ± R_j(φ_j − θ)` (m), minus for an internal mesh.
    fn rolled(&mut self, circles: [CircleId; 2], internal: bool, theta: ExprId) -> ExprId {
        let [first, second] = circles.map(|circle| {
            let phi = self.frame_coordinate(self.model[circle].frame, 2);
            let turn = self.graph.sub(phi, theta);
            let radius = self.radius(circle);
            self.graph.mul(radius, turn)
        });
        if internal { self.graph.sub(first, second) } else { self.graph.add(first, second) }
    }

    /// `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j) − κ`
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
                let left = self.as_drawn(|l| l.height(pinion, rack));
                self.graph.unary(Unary::Sign, left)
            }
        };
        let phase = match phase {
            Some(phase) => self.formula(phase),
            None => self.as_drawn(|l| l.rolled_on(pinion, rack, sigma)),
        };
        let rolled = self.rolled_on(pinion, rack, sigma);
        let height = self.height(pinion, rack);
        // on the other side it is below zero
        let distance = self.graph.mul(sigma, height);
        let radius = self.radius(pinion);
        self.fits.push(Fit { distance, wanted: radius, radius, declaration: self.declarations.next_id() });
        entries(RowUnit::LENGTH, [self.graph.sub(rolled, phase)])
    }

    /// From the rack's point to the pinion's centre (m).
    fn way_to_pinion(&mut self, pinion: CircleId, rack: AxisId) -> Vector {
        let (origin, center) = (self.global(self.model[rack].origin), self.global(self.model[pinion].center));
        self.minus(center, origin)
    }

    /// How far the pinion's centre lies to the left of the rack's axis (m).
    fn height(&mut self, pinion: CircleId, rack: AxisId) -> ExprId {
        let (v, d) = (self.direction(rack), self.way_to_pinion(pinion, rack));
        self.left_of(v, d)
    }

    /// `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j)` (m)
    fn rolled_on(&mut self, pinion: CircleId, rack: AxisId, sigma: ExprId) -> ExprId {
        let (v, d) = (self.direction(rack), self.way_to_pinion(pinion, rack));
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
