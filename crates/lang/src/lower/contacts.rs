//! Followers and cams (H 3.4): contacts that run along curves, each with the curves' arguments for coordinates.

use super::frames::Vector;
use super::{Entry, Lowering, entries};
use crate::model::{AxisId, Joint, Named, PointId, Profile};
use mechc_expr::{ExprId, Node, Symbol, Unary};
use mechc_ir::{Coordinate, CoordinateKind, OpenContact, Owner, RowUnit, Watch, WatchKind};
use rustc_hash::FxHashMap;

/// A profile at one argument, in its body's frame.
pub(super) struct Local {
    pub at: Vector,
    pub tangent: Vector,
    /// The tangent's derivative by the argument.
    pub bend: Vector,
}

impl Lowering<'_> {
    /// A coordinate that a joint brings along, the k-th of its kind's.
    pub(super) fn own_coordinate(&mut self, joint: &Joint, k: usize, kind: CoordinateKind, estimate: ExprId) -> ExprId {
        let index = self.coordinates.len() as u32;
        self.coordinates.push(Coordinate {
            name: format!("{}.{}", joint.declared.name, joint.kind.own_coordinates()[k]),
            owner: Owner::Joint(self.declarations.next_id()),
            kind,
            estimate,
            scale: 1.0,
        });
        self.graph.symbol(Symbol::Coordinate { index, order: 0 })
    }

    /// Something that keeps its sign along a branch, of the joint that is being lowered.
    pub(super) fn watch(&mut self, value: ExprId, kind: WatchKind, scale: f64) {
        self.watches.push(Watch { value, kind, scale, declaration: self.declarations.next_id() });
    }

    /// `r_j + A_j k(u) − r_i^P`
    pub(super) fn point_follower(&mut self, joint: &Joint, point: PointId, profile: Profile) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let u = self.argument(joint, 0, profile);
        let local = self.along(profile, u);
        let (on_curve, point) = (self.placed(profile.frame(self.model), local.at), self.global(point));
        let rows = entries(RowUnit::LENGTH, self.minus(on_curve, point));
        self.leave_open(&[(u, profile)], first_condition);
        rows
    }

    /// `[r_i + A_i k(u) − r_j − A_j m(w), (A_i k'(u))^⊥ᵀ (A_j m'(w))]`
    pub(super) fn cam(&mut self, joint: &Joint, first: Profile, second: Profile) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let (u, w) = (self.argument(joint, 0, first), self.argument(joint, 1, second));
        let (k, m) = (self.along(first, u), self.along(second, w));
        let frames = [first.frame(self.model), second.frame(self.model)];
        let (p, q) = (self.placed(frames[0], k.at), self.placed(frames[1], m.at));
        let [x, y] = self.minus(p, q);
        let (s, t) = (self.turned(frames[0], k.tangent), self.turned(frames[1], m.tangent));
        let parallel = self.left_of(s, t);
        // arguments are pure numbers, so tangents are lengths
        let rows = vec![(x, RowUnit::LENGTH), (y, RowUnit::LENGTH), (parallel, RowUnit::AREA)];
        let together = self.dot(s, t);
        let scale = self.size(frames[0]) * self.size(frames[1]);
        self.watch(together, WatchKind::Tangents, scale);
        // along the contact dw = du (sᵀt)/(tᵀt); how fast the tangents part is the relative curvature
        let (bend_k, bend_m) = (self.turned(frames[0], k.bend), self.turned(frames[1], m.bend));
        let (of_k, of_m) = (self.left_of(bend_k, t), self.left_of(s, bend_m));
        let square = self.dot(t, t);
        let (of_k, of_m) = (self.graph.mul(of_k, square), self.graph.mul(of_m, together));
        let curvature = self.graph.add(of_k, of_m);
        self.watch(curvature, WatchKind::Curvature, scale * scale);
        self.leave_open(&[(u, first), (w, second)], first_condition);
        rows
    }

    /// `[v_j^⊥ᵀ(r_i + A_i k(u) − r_j^a), v_j^⊥ᵀ A_i k'(u)]`
    pub(super) fn flat_follower(&mut self, joint: &Joint, profile: Profile, face: AxisId) -> Vec<Entry> {
        let first_condition = self.conditions.len();
        let u = self.argument(joint, 0, profile);
        let local = self.along(profile, u);
        let frame = profile.frame(self.model);
        let (on_curve, origin) = (self.placed(frame, local.at), self.global(self.model[face].origin));
        let d = self.minus(on_curve, origin);
        let v = self.direction(face);
        let (tangent, bend) = (self.turned(frame, local.tangent), self.turned(frame, local.bend));
        let rows = entries(RowUnit::LENGTH, [self.left_of(v, d), self.left_of(v, tangent)]);
        let along = self.dot(v, tangent);
        let scale = self.size(frame);
        self.watch(along, WatchKind::Tangents, scale);
        let curvature = self.left_of(v, bend);
        self.watch(curvature, WatchKind::Curvature, scale);
        self.leave_open(&[(u, profile)], first_condition);
        rows
    }

    /// Notes which arguments of the contact that is being lowered have no estimate by their curves.
    fn leave_open(&mut self, arguments: &[(ExprId, Profile)], first_condition: usize) {
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

    /// A contact's coordinate on a profile, with the estimate that the curve gives; 0 until it is searched for.
    fn argument(&mut self, joint: &Joint, k: usize, profile: Profile) -> ExprId {
        let estimate = match profile {
            Profile::Curve(curve) => self.model[curve].estimate,
            Profile::Circle(_) => None,
        };
        let estimate = match estimate {
            Some(estimate) => self.formula(estimate),
            None => self.graph.constant(0.0),
        };
        self.own_coordinate(joint, k, CoordinateKind::Argument, estimate)
    }

    /// A profile at an argument, with its derivatives by it; what its formula asks for is asked there.
    fn along(&mut self, profile: Profile, u: ExprId) -> Local {
        let local = self.local(profile, u);
        if let Profile::Curve(curve) = profile {
            let conditions = &self.model[curve].conditions;
            let roots: Vec<ExprId> = conditions.iter().map(|condition| condition.positive).collect();
            let carried = self.of_argument(&roots, u);
            for (condition, &positive) in conditions.iter().zip(&carried) {
                self.condition(condition, positive);
            }
        }
        local
    }

    /// A profile at an argument, with its derivatives by it.
    pub(super) fn local(&mut self, profile: Profile, u: ExprId) -> Local {
        let at = match profile {
            Profile::Circle(circle) => {
                let center = self.model[self.model[circle].center].at.map(|id| self.formula(id));
                let radius = self.formula(self.model[circle].radius);
                let (cos, sin) = (self.graph.unary(Unary::Cos, u), self.graph.unary(Unary::Sin, u));
                let (x, y) = (self.graph.mul(radius, cos), self.graph.mul(radius, sin));
                [self.graph.add(center[0], x), self.graph.add(center[1], y)]
            }
            Profile::Curve(curve) => {
                let carried = self.of_argument(&self.model[curve].at, u);
                [carried[0], carried[1]]
            }
        };
        let tangent = self.by_argument(at, u);
        let bend = self.by_argument(tangent, u);
        Local { at, tangent, bend }
    }

    /// Formulas of a curve in this graph, at an argument.
    fn of_argument(&mut self, roots: &[ExprId], u: ExprId) -> Vec<ExprId> {
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let model = self.model;
        self.graph.import(&model.graph, roots, &mut known, |graph, symbol| match symbol {
            Symbol::Named(k) if model.named[k as usize] == Named::Argument => u,
            other => graph.symbol(other),
        });
        roots.iter().map(|root| known[root]).collect()
    }

    fn by_argument(&mut self, at: Vector, u: ExprId) -> Vector {
        let slopes =
            self.graph.derivatives(&at, |graph, symbol| (graph.symbol(symbol) == u).then(|| graph.constant(1.0)));
        [slopes[0], slopes[1]]
    }
}
