//! Normal forces of contacts. A contact only pushes: where it would have to pull, the bodies separate.

use super::Lowering;
use super::frames::Vector;
use crate::model::{JointFeature, JointId, Named, Profile};
use mechc_expr::{ExprId, Symbol, Unary};
use mechc_ir::ContactForce;
use std::f64::consts::PI;

/// A profile is closed if the squared distance of its ends is at most this part of twice its area.
const CLOSED: f64 = 1e-12;
/// Samples of a profile that determine its orientation.
const PLACES: u32 = 90;

impl Lowering<'_> {
    /// Returns the normal forces of all contacts.
    pub(super) fn contact_forces(&mut self) -> Vec<ContactForce> {
        let mut presses = Vec::new();
        for id in self.model.joint_ids() {
            if self.model[id].spec.has_contact() {
                let on_second = self.reaction_on_second(id);
                let force = self.relative_to(None, |l| l.contact_force(id, on_second));
                let press =
                    |(force, is_sided)| ContactForce { declaration: super::joint_declaration(id), force, is_sided };
                presses.extend(force.map(press));
            }
        }
        presses
    }

    /// Returns the normal force (N) from the force that the contact exerts on its second body, negative where it pulls; and whether the
    /// side on which the bodies lie is determined, which it is not for an open curve.
    fn contact_force(&mut self, joint: JointId, on_second: Vector) -> Option<(ExprId, bool)> {
        let arguments = self.numbering.of_joint(joint);
        let start = arguments.start;
        let argument = |l: &mut Self, k: u32| l.graph.symbol(Symbol::Coordinate { index: start + k, order: 0 });
        match self.model[joint].features {
            // The curve's body is inside the curve.
            [JointFeature::Point(_), JointFeature::Profile(profile)] => {
                let round = self.orientation(profile);
                let u = argument(self, 0);
                let is_closed = round.is_some();
                let (tangent, _) = self.tangent_and_bend(profile, u);
                let frame = profile.frame(self.model);
                let [x, y] = [[1.0, 0.0], [0.0, 1.0]].map(|axis| axis.map(|part| self.graph.constant(part)));
                let (x, y) = (self.transform_vector(frame, x), self.transform_vector(frame, y));
                let (parity, round) = (self.left_of(x, y), self.graph.constant(round.unwrap_or(1.0)));
                let side = self.graph.mul(parity, round);
                Some((self.normal_component(side, tangent, on_second), is_closed))
            }
            // A curve bends away from the face.
            [JointFeature::Profile(profile), JointFeature::Axis(face)] => {
                let u = argument(self, 0);
                let (_, bend) = self.tangent_and_bend(profile, u);
                let face = self.direction(face);
                let curvature = self.left_of(face, bend);
                let on_first = on_second.map(|part| self.graph.neg(part));
                Some((self.normal_component(curvature, face, on_first), true))
            }
            // A curve bends away from the other curve more than that curve bends towards it, on either side.
            [JointFeature::Profile(first), JointFeature::Profile(second)] => {
                let (u, w) = (argument(self, 0), argument(self, 1));
                let ((s, bend_k), (t, bend_m)) = (self.tangent_and_bend(first, u), self.tangent_and_bend(second, w));
                let (of_k, of_m, together) = (self.left_of(t, bend_k), self.left_of(t, bend_m), self.dot(s, s));
                let square = self.dot(t, t);
                let (of_k, of_m) = (self.graph.mul(of_k, square), self.graph.mul(of_m, together));
                let curvature = self.graph.sub(of_k, of_m);
                let on_first = on_second.map(|part| self.graph.neg(part));
                Some((self.normal_component(curvature, t, on_first), true))
            }
            _ => None,
        }
    }

    /// Returns the component of a force to the left of a tangent, or to its right if `side` is negative.
    fn normal_component(&mut self, side: ExprId, tangent: Vector, force: Vector) -> ExprId {
        let (side, across, length) =
            (self.graph.unary(Unary::Sign, side), self.left_of(tangent, force), self.length(tangent));
        let across = self.graph.div(across, length);
        self.graph.mul(side, across)
    }

    fn tangent_and_bend(&mut self, profile: Profile, u: ExprId) -> (Vector, Vector) {
        let local = self.profile_point(profile, u);
        let frame = profile.frame(self.model);
        (self.transform_vector(frame, local.tangent), self.transform_vector(frame, local.bend))
    }

    /// Returns 1 if a closed profile runs counter-clockwise in its frame, −1 if clockwise; `None` for an open one.
    fn orientation(&self, profile: Profile) -> Option<f64> {
        let Profile::Curve(curve) = profile else { return Some(1.0) };
        let model = self.model;
        let place = |k: u32| {
            let u = PI * (2.0 * f64::from(k) / f64::from(PLACES) - 1.0);
            model[curve].at.map(|part| {
                model.graph.value(part, |symbol| match symbol {
                    Symbol::Param(k) => model.params[k as usize].value,
                    Symbol::Named(k) if model.named[k as usize] == Named::Argument => u,
                    _ => 0.0,
                })
            })
        };
        let places: Vec<[f64; 2]> = (0..=PLACES).map(place).collect();
        let twice_area: f64 = places.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[0][1] * pair[1][0]).sum();
        let (first, last) = (places[0], places[PLACES as usize]);
        let gap = (last[0] - first[0]) * (last[0] - first[0]) + (last[1] - first[1]) * (last[1] - first[1]);
        (gap <= CLOSED * twice_area.abs()).then(|| twice_area.signum())
    }
}
