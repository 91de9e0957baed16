//! Followers and cams (H 3.4): contacts along profiles. The arguments of the profiles are coordinates of the joint.

use super::frames::Vector;
use super::{Entry, Lowering, entries};
use crate::model::{AxisId, Joint, Named, PointId, Profile};
use mechc_expr::{ExprId, Node, Symbol, Unary};
use mechc_ir::{Coordinate, CoordinateKind, Monitor, MonitorKind, OpenContact, Owner};
use mechc_text::vocabulary::Dimension;
use rustc_hash::FxHashMap;

/// A point of a profile at one argument, in its body's frame.
pub(super) struct ProfilePoint {
    pub at: Vector,
    pub tangent: Vector,
    /// The derivative of the tangent by the argument.
    pub bend: Vector,
}

impl Lowering<'_> {
    /// Adds the k-th coordinate of a joint.
    pub(super) fn add_coordinate(&mut self, joint: &Joint, k: usize, kind: CoordinateKind, estimate: ExprId) -> ExprId {
        let index = self.coordinates.len() as u32;
        self.coordinates.push(Coordinate {
            name: format!("{}.{}", joint.declared.name, joint.features.coordinate_names()[k]),
            owner: Owner::Joint(self.declarations.next_id()),
            kind,
            estimate,
            scale: 1.0,
        });
        self.graph.symbol(Symbol::Coordinate { index, order: 0 })
    }

    /// Adds a monitor to the joint that is being lowered: a value that keeps its sign along a branch.
    pub(super) fn add_monitor(&mut self, value: ExprId, kind: MonitorKind, scale: f64) {
        self.watches.push(Monitor { value, kind, scale, declaration: self.declarations.next_id() });
    }

    /// Returns the rows of a point follower: `r_j + A_j k(u) − r_i^P`.
    pub(super) fn point_follower(&mut self, joint: &Joint, point: PointId, profile: Profile) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let u = self.argument(joint, 0, profile);
        let local = self.constrained_point(profile, u);
        let (on_curve, point) = (self.transform_point(profile.frame(self.model), local.at), self.position(point));
        let rows = entries(Dimension::LENGTH, self.difference(on_curve, point));
        self.record_open_arguments(&[(u, profile)], first_condition);
        rows
    }

    /// Returns the rows of a cam: `[r_i + A_i k(u) − r_j − A_j m(w), (A_i k'(u))^⊥ᵀ (A_j m'(w))]`.
    pub(super) fn cam(&mut self, joint: &Joint, first: Profile, second: Profile) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let (u, w) = (self.argument(joint, 0, first), self.argument(joint, 1, second));
        let (k, m) = (self.constrained_point(first, u), self.constrained_point(second, w));
        let frames = [first.frame(self.model), second.frame(self.model)];
        let (p, q) = (self.transform_point(frames[0], k.at), self.transform_point(frames[1], m.at));
        let [x, y] = self.difference(p, q);
        let (s, t) = (self.transform_vector(frames[0], k.tangent), self.transform_vector(frames[1], m.tangent));
        let parallel = self.left_of(s, t);
        // Arguments are pure numbers, so that tangents are lengths.
        let rows = vec![(x, Dimension::LENGTH), (y, Dimension::LENGTH), (parallel, Dimension::AREA)];
        let together = self.dot(s, t);
        let scale = self.size(frames[0]) * self.size(frames[1]);
        self.add_monitor(together, MonitorKind::Tangents, scale);
        // Along the contact dw = du (sᵀt)/(tᵀt); the tangents separate at the rate of the relative curvature.
        let (bend_k, bend_m) = (self.transform_vector(frames[0], k.bend), self.transform_vector(frames[1], m.bend));
        let (of_k, of_m) = (self.left_of(bend_k, t), self.left_of(s, bend_m));
        let square = self.dot(t, t);
        let (of_k, of_m) = (self.graph.mul(of_k, square), self.graph.mul(of_m, together));
        let curvature = self.graph.add(of_k, of_m);
        self.add_monitor(curvature, MonitorKind::Curvature, scale * scale);
        self.record_open_arguments(&[(u, first), (w, second)], first_condition);
        rows
    }

    /// Returns the rows of a flat follower: `[v_j^⊥ᵀ(r_i + A_i k(u) − r_j^a), v_j^⊥ᵀ A_i k'(u)]`.
    pub(super) fn flat_follower(&mut self, joint: &Joint, profile: Profile, face: AxisId) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let u = self.argument(joint, 0, profile);
        let local = self.constrained_point(profile, u);
        let frame = profile.frame(self.model);
        let (on_curve, origin) = (self.transform_point(frame, local.at), self.position(self.model[face].origin));
        let d = self.difference(on_curve, origin);
        let v = self.direction(face);
        let (tangent, bend) = (self.transform_vector(frame, local.tangent), self.transform_vector(frame, local.bend));
        let rows = entries(Dimension::LENGTH, [self.left_of(v, d), self.left_of(v, tangent)]);
        let along = self.dot(v, tangent);
        let scale = self.size(frame);
        self.add_monitor(along, MonitorKind::Tangents, scale);
        let curvature = self.left_of(v, bend);
        self.add_monitor(curvature, MonitorKind::Curvature, scale);
        self.record_open_arguments(&[(u, profile)], first_condition);
        rows
    }

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
    pub(super) fn profile_point(&mut self, profile: Profile, u: ExprId) -> ProfilePoint {
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
