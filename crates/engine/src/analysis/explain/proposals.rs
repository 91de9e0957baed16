//! Proposals to take a freedom: drivers, and joints that may have been forgotten.

use super::evaluator::Evaluator;
use super::orthonormal::Orthonormal;
use crate::limits::explain::{MOST_NAMED, SEEN};
use mechc_expr::math;
use mechc_ir::{
    Axis, AxisId, BodyId, ConstraintSystem, Declaration, DeclarationKind, IdVec, JointSpec, Point, PointId,
};
use mechc_text::vocabulary::JointMotion;
use nalgebra::DVector;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// Points that are drawn closer than this, in sizes of the mechanism, may be intended to coincide.
const COINCIDE: f64 = 0.02;
/// Distance within which two points that no joint uses may be intended to coincide, in sizes of the mechanism.
const DANGLING: f64 = 0.15;
/// Maximum number of points that are compared with each other.
const MOST_POINTS: usize = 1000;

/// Data from which proposals are made.
pub struct Proposals<'p, 's> {
    /// The assembled position.
    pub evaluator: &'p Evaluator<'s>,
    /// The independent motions that are free, by coordinates, scaled.
    pub motions: &'p [Vec<f64>],
    /// Bodies that can move.
    pub moving: &'p [BodyId],
}

impl Proposals<'_, '_> {
    /// Returns drivers: for one degree of freedom some to choose from, else as many as take all degrees together.
    pub fn drivers(&self) -> Vec<String> {
        let candidates = self.candidates();
        if self.motions.len() == 1 {
            let takes = |(_, rates): &(String, Vec<f64>)| rates[0].abs() > SEEN;
            return candidates.into_iter().filter(takes).map(|(text, _)| text).take(MOST_NAMED).collect();
        }
        let mut taken = Orthonormal::of_dimension(self.motions.len());
        let mut chosen = Vec::new();
        for (text, rates) in candidates {
            let (rest, _) = taken.split(DVector::from_vec(rates));
            if taken.take(&rest, SEEN) {
                chosen.push(text);
            }
        }
        chosen
    }

    /// Returns quantities that could be driven, of joints first, then of the bodies that move. Each has its rate in every motion.
    fn candidates(&self) -> Vec<(String, Vec<f64>)> {
        let (evaluator, system) = (self.evaluator, self.evaluator.system);
        let mut candidates = Vec::new();
        // motors mostly stand on the ground
        let on_ground = |one: &&Declaration| one.points.iter().any(|&point| system.points()[point].body.is_none());
        let (grounded, others): (Vec<&Declaration>, Vec<&Declaration>) =
            system.declarations().iter().partition(on_ground);
        for declaration in grounded.into_iter().chain(others) {
            let [Some(&p), Some(&q)] = [0, 1].map(|k| declaration.points.get(k)) else {
                continue;
            };
            let DeclarationKind::Joint(JointSpec { motion: Some(motion), .. }) = declaration.kind else { continue };
            let rates: Vec<f64> = match motion {
                JointMotion::Rotation => {
                    self.motions.iter().map(|motion| turn(system, motion, q) - turn(system, motion, p)).collect()
                }
                JointMotion::Displacement => self.slides(p, q),
            };
            candidates.push((format!("{}({})", motion.quantity(), declaration.name), rates));
        }
        for &body in self.moving {
            let name = &system.bodies()[body].name;
            let turns = self.motions.iter().map(|motion| motion[system.pose_of(body)[2]]).collect();
            let of_body = |point: &PointId| system.points()[*point].body == Some(body);
            let point =
                system.points().ids().filter(of_body).find_map(|k| Some((k, system.points()[k].name.as_ref()?)));
            if let Some((point, point_name)) = point {
                for (part, word) in [(0, "x"), (1, "y")] {
                    let rates =
                        self.motions.iter().map(|motion| velocity(evaluator, motion, point)[part] / system.length());
                    candidates.push((format!("{word}({name}.{point_name})"), rates.collect()));
                }
            }
            candidates.push((format!("angle({name})"), turns));
        }
        candidates
    }

    /// Returns how fast a second point moves away from a first one in every motion, along its path relative to the first body.
    fn slides(&self, p: PointId, q: PointId) -> Vec<f64> {
        let (evaluator, system) = (self.evaluator, self.evaluator.system);
        let (from, to) = (evaluator.place_of(p), evaluator.place_of(q));
        let relative = |motion: &Vec<f64>| {
            let (vp, vq) = (velocity(evaluator, motion, p), velocity(evaluator, motion, q));
            // relative to the first body
            let turn = turn(system, motion, p);
            [vq[0] - vp[0] + turn * (to[1] - from[1]), vq[1] - vp[1] - turn * (to[0] - from[0])]
        };
        let all: Vec<[f64; 2]> = self.motions.iter().map(relative).collect();
        let size = |v: &[f64; 2]| math::hypot(v[0], v[1]);
        let fastest = all.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or([0.0; 2]);
        let norm = f64::max(size(&fastest), f64::MIN_POSITIVE);
        all.iter().map(|v| (v[0] * fastest[0] + v[1] * fastest[1]) / norm / system.length()).collect()
    }

    /// Points of moving bodies that lie on points of others, and that no joint holds together.
    pub fn joints(&self) -> Vec<String> {
        let system = self.evaluator.system;
        // a joint takes two degrees of freedom; it may be redundant in one of them
        let is_enough = self.motions.len() >= 2 || system.ndof() < self.motions.len().cast_signed();
        if !is_enough || system.points().len() > MOST_POINTS {
            return Vec::new();
        }
        let pinned = pinned_together(system);
        let mut pairs = self.pairs_drawn_together(&pinned);
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let text = |&(_, p, q): &(f64, PointId, PointId)| {
            Some(format!("`joint NAME: revolute({}, {})`", system.point_name(p)?, system.point_name(q)?))
        };
        // points that are pinned together need only one suggestion
        let mut suggested: Vec<[PointId; 2]> = Vec::new();
        pairs.retain(|&(_, p, q)| {
            let mut both = [pinned[p], pinned[q]];
            both.sort_unstable();
            let is_new = !suggested.contains(&both);
            suggested.push(both);
            is_new
        });
        pairs.iter().filter_map(text).take(MOST_NAMED.min(usize::max(self.motions.len() / 2, 1))).collect()
    }

    /// Axes of one name that no joint takes, of bodies that move on each other: a slider's way is missing.
    pub fn guides(&self) -> Vec<String> {
        let system = self.evaluator.system;
        let is_free = |axis: AxisId| !system.declarations().iter().any(|one| one.axes.contains(&axis));
        let free: Vec<&Axis> = system.axes().pairs().filter(|&(id, _)| is_free(id)).map(|(_, axis)| axis).collect();
        let body_of = |axis: &Axis| system.points()[axis.origin].body;
        let local_name = |axis: &Axis| axis.name.rsplit('.').next().map(str::to_owned);
        let mut suggested = Vec::new();
        for (k, one) in free.iter().enumerate() {
            let moves = |other: &&&Axis| {
                let bodies = [body_of(one), body_of(other)];
                bodies[0] != bodies[1] && bodies.iter().flatten().any(|body| self.moving.contains(body))
            };
            let fits = |other: &&&Axis| local_name(one) == local_name(other) && moves(other);
            let others = free[k + 1..].iter().filter(fits);
            suggested.extend(others.map(|other| format!("`joint NAME: translational({}, {})`", one.name, other.name)));
        }
        suggested.truncate(MOST_NAMED);
        suggested
    }

    /// Returns whether the drawing shows where a point is: the origin of a body without a pose has no location in it.
    fn has_place(&self, point: PointId) -> bool {
        let system = self.evaluator.system;
        let Point { body, at, .. } = &system.points()[point];
        let is_origin = || at.iter().all(|&id| system.value_at(id, &[]) == 0.0);
        body.is_none_or(|body| system.bodies()[body].pose_span.is_some() || !is_origin())
    }

    /// Returns pairs of points that are drawn together and not held, with their distance (m).
    fn pairs_drawn_together(&self, pinned: &IdVec<PointId, PointId>) -> Vec<(f64, PointId, PointId)> {
        let system = self.evaluator.system;
        let drawn = Evaluator::new(system);
        let bodies_of = |p: PointId, q: PointId| [p, q].map(|point| system.points()[point].body);
        let held = |p: PointId, q: PointId| {
            let bodies = bodies_of(p, q);
            let holds = |points: &[PointId]| matches!(points, &[a, b] if bodies_of(a, b) == bodies || bodies_of(b, a) == bodies);
            pinned[p] == pinned[q] || system.declarations().iter().any(|declaration| holds(&declaration.points))
        };
        let is_used = |point: PointId| system.declarations().iter().any(|one| one.points.contains(&point));
        let mut pairs = Vec::new();
        for p in system.points().ids() {
            for q in system.points().ids().skip(p.index() + 1) {
                let bodies = bodies_of(p, q);
                let moves = bodies.iter().flatten().any(|body| self.moving.contains(body));
                let is_drawn =
                    self.has_place(p) && self.has_place(q) || system.points()[p].name == system.points()[q].name;
                if bodies[0] == bodies[1] || !moves || !is_drawn {
                    continue;
                }
                let (a, b) = (drawn.place_of(p), drawn.place_of(q));
                let apart = math::hypot(b[0] - a[0], b[1] - a[1]);
                let near = if is_used(p) || is_used(q) { COINCIDE } else { DANGLING };
                if apart < near * system.length() && !held(p, q) {
                    pairs.push((apart, p, q));
                }
            }
        }
        pairs
    }
}

/// Returns, for each point, one that stands for all that are pinned together with it, directly or through others.
fn pinned_together(system: &ConstraintSystem) -> IdVec<PointId, PointId> {
    let mut stands_for: IdVec<PointId, PointId> = system.points().ids().collect();
    let mut join = |a: PointId, b: PointId| {
        let (from, to) = (stands_for[a], stands_for[b]);
        for point in stands_for.iter_mut() {
            if *point == from {
                *point = to;
            }
        }
    };
    for declaration in system.declarations() {
        if let (DeclarationKind::Joint(joint), &[a, b]) = (declaration.kind, declaration.points.as_slice())
            && joint.holds_points_together()
        {
            join(a, b);
        }
    }
    // a point may stand in a body under several names
    let mut first_at: FxHashMap<(Option<BodyId>, [u64; 2]), PointId> = FxHashMap::default();
    for (k, point) in system.points().pairs() {
        let place = point.at.map(|id| (system.value_at(id, &[]) + 0.0).to_bits());
        match first_at.entry((point.body, place)) {
            Entry::Occupied(entry) => join(k, *entry.get()),
            Entry::Vacant(free) => drop(free.insert(k)),
        }
    }
    stands_for
}

/// Returns how fast the body of a point turns in a motion.
fn turn(system: &ConstraintSystem, motion: &[f64], point: PointId) -> f64 {
    system.points()[point].body.map_or(0.0, |body| motion[system.pose_of(body)[2]])
}

/// Returns the velocity of a point in a motion (m).
fn velocity(evaluator: &Evaluator<'_>, motion: &[f64], point: PointId) -> [f64; 2] {
    let system = evaluator.system;
    let Some(body) = system.points()[point].body else {
        return [0.0; 2];
    };
    let [x, y] = evaluator.place_of(point);
    let along = |k: usize| motion[k] * system.coordinates()[k].scale;
    let [origin_x, origin_y, phi] = system.pose_of(body);
    let turn = motion[phi];
    [along(origin_x) - turn * (y - evaluator.q[origin_y]), along(origin_y) + turn * (x - evaluator.q[origin_x])]
}
