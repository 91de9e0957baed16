//! Followers and cams (H 3.4): contacts along profiles. The arguments of the profiles are coordinates of the joint.

use crate::lower::Lowering;
use crate::lower::frames::Vector;
use crate::model::{Joint, JointFeature, Named, Profile};
use mechc_expr::{ExprId, Node, Symbol, Unary};
use mechc_ir::{CoordinateKind, MonitorKind, OpenContact};
use rustc_hash::FxHashMap;

/// A point of a profile at one argument, in its body's frame.
pub(in crate::lower) struct ProfilePoint {
    pub at: Vector,
    pub tangent: Vector,
    /// The derivative of the tangent by the argument.
    pub bend: Vector,
}

/// Returns the rows of a point follower: `r_j + A_j k(u) − r_i^P`.
pub(super) fn point_follower(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [point, JointFeature::Profile(profile)] = joint.features else { return Vec::new() };
    let first_condition = l.conditions.len();
    let u = l.argument(joint, 0, profile);
    let local = l.constrained_point(profile, u);
    let (on_curve, point) = (l.transform_point(profile.frame(l.model), local.at), l.place(point));
    let rows = l.difference(on_curve, point).to_vec();
    l.record_open_arguments(&[(u, profile)], first_condition);
    rows
}

/// Returns the rows of a cam: `[r_i + A_i k(u) − r_j − A_j m(w), (A_i k'(u))^⊥ᵀ (A_j m'(w))]`. Arguments are pure numbers, so that
/// tangents are lengths.
pub(super) fn cam(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [JointFeature::Profile(first), JointFeature::Profile(second)] = joint.features else { return Vec::new() };
    let first_condition = l.conditions.len();
    let (u, w) = (l.argument(joint, 0, first), l.argument(joint, 1, second));
    let (k, m) = (l.constrained_point(first, u), l.constrained_point(second, w));
    let frames = joint.frames(l.model);
    let (p, q) = (l.transform_point(frames[0], k.at), l.transform_point(frames[1], m.at));
    let [x, y] = l.difference(p, q);
    let (s, t) = (l.transform_vector(frames[0], k.tangent), l.transform_vector(frames[1], m.tangent));
    let parallel = l.left_of(s, t);
    let together = l.dot(s, t);
    let scale = l.size(frames[0]) * l.size(frames[1]);
    l.add_monitor(together, MonitorKind::Tangents, scale);
    // Along the contact dw = du (sᵀt)/(tᵀt); the tangents separate at the rate of the relative curvature.
    let (bend_k, bend_m) = (l.transform_vector(frames[0], k.bend), l.transform_vector(frames[1], m.bend));
    let (of_k, of_m) = (l.left_of(bend_k, t), l.left_of(s, bend_m));
    let square = l.dot(t, t);
    let (of_k, of_m) = (l.graph.mul(of_k, square), l.graph.mul(of_m, together));
    let curvature = l.graph.add(of_k, of_m);
    l.add_monitor(curvature, MonitorKind::Curvature, scale * scale);
    l.record_open_arguments(&[(u, first), (w, second)], first_condition);
    vec![x, y, parallel]
}

/// Returns the rows of a flat follower: `[v_j^⊥ᵀ(r_i + A_i k(u) − r_j^a), v_j^⊥ᵀ A_i k'(u)]`.
pub(super) fn flat_follower(l: &mut Lowering<'_>, joint: &Joint) -> Vec<ExprId> {
    let [JointFeature::Profile(profile), face] = joint.features else { return Vec::new() };
    let first_condition = l.conditions.len();
    let u = l.argument(joint, 0, profile);
    let local = l.constrained_point(profile, u);
    let frame = profile.frame(l.model);
    let (on_curve, origin) = (l.transform_point(frame, local.at), l.place(face));
    let d = l.difference(on_curve, origin);
    let v = l.along(face);
    let (tangent, bend) = (l.transform_vector(frame, local.tangent), l.transform_vector(frame, local.bend));
    let rows = vec![l.left_of(v, d), l.left_of(v, tangent)];
    let along = l.dot(v, tangent);
    let scale = l.size(frame);
    l.add_monitor(along, MonitorKind::Tangents, scale);
    let curvature = l.left_of(v, bend);
    l.add_monitor(curvature, MonitorKind::Curvature, scale);
    l.record_open_arguments(&[(u, profile)], first_condition);
    rows
}

impl Lowering<'_> {
    /// Records the arguments of the current contact whose curves give no estimate.
    fn record_open_arguments(&mut self, arguments: &[(ExprId, Profile)], first_condition: usize) {
        let is_open = |profile| !matches!(profile, Profile::Curve(curve) if self.model[curve].estimate.is_some());
        let index = |u: ExprId| match self.graph.node(u) {
            Node::Symbol(Symbol::Coordinate { index, .. }) => Some(index),
            _ => None,
        };
        let open = arguments.iter().filter(|(_, profile)| is_open(*profile));
        let arguments: Vec<u32> = open.filter_map(|&(u, _)| index(u)).collect();
        if !arguments.is_empty() {
            let conditions = self.conditions[first_condition..].iter().map(|condition| condition.positive).collect();
            self.open_contacts.push(OpenContact { declaration: self.declarations.next_id(), arguments, conditions });
        }
    }

    /// Adds a contact's coordinate on a profile. Its estimate is that of the curve; without one it is 0 until `estimates` has searched for
    /// it.
    fn argument(&mut self, joint: &Joint, k: usize, profile: Profile) -> ExprId {
        let estimate = match profile {
            Profile::Curve(curve) => self.model[curve].estimate,
            Profile::Circle(_) => None,
        };
        let estimate = match estimate {
            Some(estimate) => self.formula(estimate),
            None => self.graph.constant(0.0),
        };
        self.add_coordinate(joint, k, CoordinateKind::Argument, estimate)
    }

    /// Returns the point of a profile at an argument, and adds the conditions of the curve's formula at this argument.
    fn constrained_point(&mut self, profile: Profile, u: ExprId) -> ProfilePoint {
        let local = self.profile_point(profile, u);
        if let Profile::Curve(curve) = profile {
            let conditions = &self.model[curve].conditions;
            let roots: Vec<ExprId> = conditions.iter().map(|condition| condition.positive).collect();
            let carried = self.import_at_argument(&roots, u);
            for (condition, &positive) in conditions.iter().zip(&carried) {
                self.condition(condition, positive);
            }
        }
        local
    }

    /// Returns the point of a profile at an argument.
    pub(in crate::lower) fn profile_point(&mut self, profile: Profile, u: ExprId) -> ProfilePoint {
        let at = match profile {
            Profile::Circle(circle) => {
                let center = self.model[self.model[circle].center].at.map(|id| self.formula(id));
                let radius = self.formula(self.model[circle].radius);
                let (cos, sin) = (self.graph.unary(Unary::Cos, u), self.graph.unary(Unary::Sin, u));
                let (x, y) = (self.graph.mul(radius, cos), self.graph.mul(radius, sin));
                [self.graph.add(center[0], x), self.graph.add(center[1], y)]
            }
            Profile::Curve(curve) => {
                let carried = self.import_at_argument(&self.model[curve].at, u);
                [carried[0], carried[1]]
            }
        };
        let tangent = self.derivative_by_argument(at, u);
        let bend = self.derivative_by_argument(tangent, u);
        ProfilePoint { at, tangent, bend }
    }

    /// Imports formulas of a curve, evaluated at an argument.
    fn import_at_argument(&mut self, roots: &[ExprId], u: ExprId) -> Vec<ExprId> {
        let mut imported: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let model = self.model;
        self.graph.import(&model.graph, roots, &mut imported, |graph, symbol| match symbol {
            Symbol::Named(k) if model.named[k as usize] == Named::Argument => u,
            other => graph.symbol(other),
        });
        roots.iter().map(|root| imported[root]).collect()
    }

    fn derivative_by_argument(&mut self, at: Vector, u: ExprId) -> Vector {
        let slopes =
            self.graph.derivatives(&at, |graph, symbol| (graph.symbol(symbol) == u).then(|| graph.constant(1.0)));
        [slopes[0], slopes[1]]
    }
}
