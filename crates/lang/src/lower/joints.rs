//! The joints' rows of `Φ` (H 3.3).

use super::{Entry, Lowering, entries};
use crate::model::{JoinedFeatures, Joint, PointId};
use mechc_expr::ExprId;
use mechc_text::vocabulary::Dimension;

impl Lowering<'_> {
    pub(super) fn joint(&mut self, joint: &Joint) -> Vec<Entry> {
        match joint.features {
            // r_i^P − r_j^Q
            JoinedFeatures::Revolute(p, q) => {
                let (p, q) = (self.position(p), self.position(q));
                entries(Dimension::LENGTH, self.difference(p, q))
            }
            // [v_i^⊥ᵀ d, v_i^⊥ᵀ v_j]
            JoinedFeatures::Translational(a, b) => {
                let (origin, other) = (self.position(self.model[a].origin), self.position(self.model[b].origin));
                let d = self.difference(other, origin);
                let (v, w) = (self.direction(a), self.direction(b));
                vec![(self.left_of(v, d), Dimension::LENGTH), (self.left_of(v, w), Dimension::PURE)]
            }
            // [r_i^P − r_j^Q, φ_j − φ_i − φ_0]
            JoinedFeatures::Weld(p, q, angle) => {
                let frames = [self.model[p].frame, self.model[q].frame];
                let [phi_i, phi_j] = frames.map(|frame| self.frame_coordinate(frame, 2));
                let angle = self.formula(angle);
                let turn = self.graph.sub(phi_j, phi_i);
                let turn = self.with_handedness(joint.part, turn);
                let turn = self.graph.sub(turn, angle);
                let (p, q) = (self.position(p), self.position(q));
                let [x, y] = self.difference(p, q);
                vec![(x, Dimension::LENGTH), (y, Dimension::LENGTH), (turn, Dimension::ANGLE)]
            }
            // dᵀd − L²
            JoinedFeatures::RevoluteRevolute(p, q, length) => {
                let length = self.formula(length);
                entries(Dimension::AREA, [self.squared_distance_row(p, q, length)])
            }
            // v_j^⊥ᵀ (r_i^P − r_j^a) − c
            JoinedFeatures::RevoluteTranslational(p, a, offset) => {
                let (point, origin) = (self.position(p), self.position(self.model[a].origin));
                let d = self.difference(point, origin);
                let v = self.direction(a);
                let offset = self.formula(offset);
                let left = self.left_of(v, d);
                let left = self.with_handedness(joint.part, left);
                entries(Dimension::LENGTH, [self.graph.sub(left, offset)])
            }
            // Angles and phases of gears are relative to the part that declares them.
            JoinedFeatures::Gear { circles, internal, phase } => {
                self.relative_to(joint.part, |l| l.gear(joint, circles, internal, phase))
            }
            JoinedFeatures::RackPinion { pinion, rack, phase, side } => {
                self.relative_to(joint.part, |l| l.rack_pinion(pinion, rack, phase, side))
            }
            JoinedFeatures::PointFollower(point, profile) => self.point_follower(joint, point, profile),
            JoinedFeatures::Cam(k, m) => self.cam(joint, k, m),
            JoinedFeatures::FlatFollower(profile, face) => self.flat_follower(joint, profile, face),
        }
    }

    /// Returns `dᵀd − C²`, which has no square root and no singularity at the solution.
    pub(super) fn squared_distance_row(&mut self, p: PointId, q: PointId, distance: ExprId) -> ExprId {
        let (p, q) = (self.position(p), self.position(q));
        let d = self.difference(q, p);
        let square = self.dot(d, d);
        let square_of_distance = self.graph.power(distance, 2);
        self.graph.sub(square, square_of_distance)
    }
}
