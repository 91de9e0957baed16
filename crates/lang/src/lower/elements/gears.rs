//! Gears and racks (H 3.4) and belts: circles that roll. They do not hold the distance of their centres.

use crate::lower::Lowering;
use crate::lower::frames::Vector;
use crate::model::{Joint, JointFeature};
use mechc_expr::{Binary, Dependence, ExprId, Symbol, Unary};
use mechc_ir::{CoordinateKind, Fit, MonitorKind};

/// Returns the rows of a gear: `[−dx sin θ + dy cos θ, R_i(φ_i − θ) + R_j(φ_j − θ) − κ]`, θ the direction of the line of centres.
pub(super) fn gear(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    // Angles and phases of wheels are relative to the part that declares them.
    l.relative_to(joint.part, |l| l.wheels(joint, false, |l, [r, s]| Some(l.graph.add(r, s))))
}

/// Returns the rows of an internal gear: `[−dx sin θ + dy cos θ, R_i(φ_i − θ) − R_j(φ_j − θ) − κ]`.
pub(super) fn internal_gear(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let difference = |l: &mut Lowering<'_>, [r, s]: [ExprId; 2]| {
        let difference = l.graph.sub(r, s);
        Some(l.graph.unary(Unary::Abs, difference))
    };
    l.relative_to(joint.part, |l| l.wheels(joint, true, difference))
}

/// Returns the rows of a belt: `[−dx sin θ + dy cos θ, R_i(φ_i − θ) ∓ R_j(φ_j − θ) − κ]`, with plus for a crossed one. One pulley takes up
/// what the other one lets go.
pub(super) fn belt(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    l.relative_to(joint.part, |l| l.wheels(joint, !joint.has_word("crossed"), |_, _| None))
}

/// Returns the row of a rack: `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j) − κ`.
pub(super) fn rack_pinion(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    l.relative_to(joint.part, |l| l.rack(joint))
}

impl Lowering<'_> {
    /// Returns the rows of two wheels, which turn in the same sense or against each other. `wanted` is the distance of their centres by
    /// their radii, or `None` if it must stay what it is at the start.
    pub(super) fn wheels(
        &mut self,
        joint: &Joint,
        same_sense: bool,
        wanted: impl FnOnce(&mut Self, [ExprId; 2]) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        let circles = joint.features;
        let drawn = self.in_drawn_poses(|l| l.line_of_centers(circles));
        let drawn_theta = self.drawn_direction(drawn);
        let phase = match joint.value() {
            Some(phase) => self.formula(phase),
            None => self.in_drawn_poses(|l| l.rolled(circles, same_sense, drawn_theta)),
        };
        let theta = self.add_coordinate(joint, 0, CoordinateKind::Angle, drawn_theta);
        let [dx, dy] = self.line_of_centers(circles);
        let (cos, sin) = (self.graph.unary(Unary::Cos, theta), self.graph.unary(Unary::Sin, theta));
        let line = [cos, sin];
        let across = self.left_of(line, [dx, dy]);
        let rolled = self.rolled(circles, same_sense, theta);
        let mesh = self.graph.sub(rolled, phase);
        // The first row also holds at θ + π, which this sign excludes.
        let along = self.dot(line, [dx, dy]);
        let scale = joint.frames(self.model).map(|frame| self.size(frame));
        self.add_monitor(along, MonitorKind::LineOfCenters, f64::max(scale[0], scale[1]));
        let radii = circles.map(|circle| self.radius(circle));
        let wanted = wanted(self, radii);
        let distance = self.graph.binary(Binary::Hypot, dx, dy);
        let radius = self.graph.binary(Binary::Max, radii[0], radii[1]);
        self.fits.push(Fit { distance, wanted, radius, declaration: self.declarations.next_id() });
        vec![across, mesh]
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

    /// Returns the vector from centre to centre (m).
    fn line_of_centers(&mut self, circles: [JointFeature; 2]) -> Vector {
        let [from, to] = circles.map(|circle| self.place(circle));
        self.difference(to, from)
    }

    /// Returns `R_i(φ_i − θ) ± R_j(φ_j − θ)` (m), with minus for wheels that turn in the same sense.
    fn rolled(&mut self, circles: [JointFeature; 2], same_sense: bool, theta: ExprId) -> ExprId {
        let [first, second] = circles.map(|circle| {
            let phi = self.frame_coordinate(circle.frame(self.model), 2);
            let turn = self.graph.sub(phi, theta);
            let radius = self.radius(circle);
            self.graph.mul(radius, turn)
        });
        if same_sense { self.graph.sub(first, second) } else { self.graph.add(first, second) }
    }

    fn rack(&mut self, joint: &Joint) -> Vec<ExprId> {
        let [pinion, rack] = joint.features;
        let sigma = if joint.has_word("left") {
            self.graph.constant(1.0)
        } else if joint.has_word("right") {
            self.graph.constant(-1.0)
        } else {
            let left = self.in_drawn_poses(|l| l.height(pinion, rack));
            self.graph.unary(Unary::Sign, left)
        };
        let phase = match joint.value() {
            Some(phase) => self.formula(phase),
            None => self.in_drawn_poses(|l| l.rolled_on(pinion, rack, sigma)),
        };
        let rolled = self.rolled_on(pinion, rack, sigma);
        let height = self.height(pinion, rack);
        // The distance is negative on the other side of the rack.
        let distance = self.graph.mul(sigma, height);
        let radius = self.radius(pinion);
        self.fits.push(Fit { distance, wanted: Some(radius), radius, declaration: self.declarations.next_id() });
        vec![self.graph.sub(rolled, phase)]
    }

    /// Returns the vector from the rack's origin to the pinion's centre (m).
    fn pinion_offset(&mut self, pinion: JointFeature, rack: JointFeature) -> Vector {
        let (origin, center) = (self.place(rack), self.place(pinion));
        self.difference(center, origin)
    }

    /// Returns the signed distance of the pinion's centre to the left of the rack's axis (m).
    fn height(&mut self, pinion: JointFeature, rack: JointFeature) -> ExprId {
        let (v, d) = (self.along(rack), self.pinion_offset(pinion, rack));
        self.left_of(v, d)
    }

    /// Returns `v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j)` (m).
    fn rolled_on(&mut self, pinion: JointFeature, rack: JointFeature, sigma: ExprId) -> ExprId {
        let (v, d) = (self.along(rack), self.pinion_offset(pinion, rack));
        let along = self.dot(v, d);
        let [phi_i, phi_j] = [pinion, rack].map(|feature| self.frame_coordinate(feature.frame(self.model), 2));
        let turn = self.graph.sub(phi_i, phi_j);
        let radius = self.radius(pinion);
        let signed = self.graph.mul(sigma, radius);
        let rolled = self.graph.mul(signed, turn);
        self.graph.add(along, rolled)
    }
}
