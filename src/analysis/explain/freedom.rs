//! Too few equations: what is left free, told as motions, and what could be written to take the freedom.

use super::errors;
use super::evaluator::Evaluator;
use super::free_motion::motion_in_words;
use super::redundancy::{Basis, orthogonal};
use crate::ir::{BodyId, ConstraintSystem, CoordinateKind, Declaration, DeclarationKind, IdVec, JointKind, PointId};
use crate::math;
use crate::structure::Part;
use crate::tolerances::determinacy::freedom::{
    ANGLE_SHARE, ASSEMBLED, COINCIDE, DANGLING, LOOSE, MOST_POINTS, MOVES, SUGGESTED, TAKEN, TOLD,
};
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// How bodies move in one of the motions that equations leave free: at whichever speed, and either way.
#[derive(Clone, PartialEq, Debug)]
pub struct FreeMotion {
    /// The bodies that move, with the velocities of their frames [m, m, rad]. Of all coordinates, in sizes of
    /// their bodies and in radians, the fastest moves by 1.
    pub bodies: Vec<(BodyId, [f64; 3])>,
}

/// The motions that equations leave free.
#[derive(Clone, Debug)]
pub struct Freedom {
    /// Independent motions, by coordinates, scaled.
    motions: Vec<Vec<f64>>,
    /// Bodies that nothing holds.
    loose: Vec<BodyId>,
    /// Bodies that can move.
    moving: Vec<BodyId>,
    /// What would take them where it is driven: `rotation(main)`.
    drivers: Vec<String>,
    /// Joints that may have been forgotten, as text to write.
    joints: Vec<String>,
}

impl Freedom {
    /// What the rows of a part leave free of its columns at a time (s); none where they cannot be met.
    pub fn of(evaluator: &mut Evaluator<'_>, part: &Part, t: f64) -> Option<Freedom> {
        let linear = evaluator.assemble(&part.rows, &part.columns, None, t)?;
        if linear.residual.iter().any(|open| open.abs() > ASSEMBLED) {
            return None;
        }
        let jacobian = evaluator.linear(&part.rows, &part.columns, None, t)?.jacobian;
        let system = evaluator.system;
        let taken = Basis::of(&jacobian, part.columns.len()).vectors;
        let shares = shares_left(&taken, part.columns.len());
        let with_share = |least: f64| {
            let mut count = system.bodies.map(|_| 0);
            for (&column, &share) in part.columns.iter().zip(&shares) {
                if let Some(body) = system.body_of(column as usize)
                    && share > least
                {
                    count[body] += 1;
                }
            }
            count
        };
        let bodies_where = |counts: IdVec<BodyId, usize>, least: usize| -> Vec<BodyId> {
            counts.ids().filter(|&body| counts[body] >= least).collect()
        };
        let loose = bodies_where(with_share(LOOSE), 3);
        let moving = bodies_where(with_share(MOVES), 1);
        let motions = motions_beside(system, part, taken);
        let mut freedom = Freedom { motions, loose, moving, drivers: Vec::new(), joints: Vec::new() };
        freedom.drivers = freedom.drivers(evaluator);
        freedom.joints = freedom.joints(evaluator);
        Some(freedom)
    }

    /// What its motions do with the bodies.
    pub fn motions_of_bodies(&self, system: &ConstraintSystem) -> Vec<FreeMotion> {
        self.motions.iter().map(|motion| of_bodies(system, motion)).collect()
    }

    /// How many degrees of freedom are left.
    pub fn degrees(&self) -> usize {
        self.motions.len()
    }

    /// The bodies that can move.
    pub fn moving(&self) -> &[BodyId] {
        &self.moving
    }

    /// What could be driven to take the freedom: `rotation(main)`.
    pub fn drives(&self) -> &[String] {
        &self.drivers
    }

    /// What is left free, in sentences.
    pub fn in_words(&self, system: &ConstraintSystem) -> Vec<String> {
        let is_loose = |column: usize| system.body_of(column).is_some_and(|body| self.loose.contains(&body));
        let mut sentences: Vec<String> = Vec::new();
        for motion in &self.motions {
            let moves = |k: &usize| motion[*k].abs() > MOVES;
            if !(0..motion.len()).filter(moves).all(is_loose) {
                sentences.push(motion_in_words(system, motion));
            }
        }
        let left_out = sentences.len().saturating_sub(TOLD);
        sentences.truncate(TOLD);
        if left_out > 0 {
            sentences.push(format!("and {left_out} more motions"));
        }
        let loose: Vec<String> = self.loose.iter().map(|&body| format!("`{}`", system.bodies[body].name)).collect();
        if !loose.is_empty() {
            sentences.push(format!("nothing holds {}", errors::cut_list(&loose)));
        }
        sentences
    }

    /// What could be written to take the freedom.
    pub fn helps(&self) -> Vec<String> {
        let mut helps = Vec::new();
        if !self.joints.is_empty() {
            let what = if self.joints.len() == 1 { "a joint is missing?" } else { "joints are missing?" };
            helps.push(format!(
                "{what} These points are drawn onto each other, or nearly so: {}",
                self.joints.join(", ")
            ));
        }
        let one = if helps.is_empty() { "add" } else { "or add" };
        match (self.drivers.as_slice(), self.degrees()) {
            ([], _) => {}
            (drivers, 1) => {
                let drivers: Vec<String> =
                    drivers.iter().map(|driven| format!("`driver NAME: {driven} = …`")).collect();
                helps.push(format!("{one} a driver: {}", drivers.join(" or ")));
            }
            (drivers, count) => {
                let how_many = if drivers.len() == count { format!("{count} drivers") } else { "drivers".to_owned() };
                let named = |(k, driven): (usize, &String)| format!("`driver NAME_{}: {driven} = …`", k + 1);
                let drivers: Vec<String> = drivers.iter().enumerate().map(named).collect();
                helps.push(format!("{one} {how_many}: {}", errors::cut_list(&drivers)));
            }
        }
        helps
    }

    /// For one degree of freedom some drivers to choose from, else as many as take all degrees together.
    fn drivers(&self, evaluator: &Evaluator<'_>) -> Vec<String> {
        let candidates = self.candidates(evaluator);
        if self.degrees() == 1 {
            let takes = |(_, rates): &(String, Vec<f64>)| rates[0].abs() > TAKEN;
            return candidates.into_iter().filter(takes).map(|(text, _)| text).take(SUGGESTED).collect();
        }
        let mut taken: Vec<Vec<f64>> = Vec::new();
        let mut chosen = Vec::new();
        for (text, rates) in candidates {
            let (rest, _) = orthogonal(&rates, &taken);
            let norm = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm > TAKEN && taken.len() < self.degrees() {
                taken.push(rest.iter().map(|x| x / norm).collect());
                chosen.push(text);
            }
        }
        chosen
    }

    /// What could be driven: of joints first, then of the bodies that move. Each with its rate in every motion.
    fn candidates(&self, evaluator: &Evaluator<'_>) -> Vec<(String, Vec<f64>)> {
        let system = evaluator.system;
        let mut candidates = Vec::new();
        // motors mostly stand on the ground
        let on_ground = |one: &&Declaration| one.points.iter().any(|&point| system.points[point].body.is_none());
        let (grounded, others): (Vec<&Declaration>, Vec<&Declaration>) =
            system.declarations.iter().partition(on_ground);
        for declaration in grounded.into_iter().chain(others) {
            let [Some(&p), Some(&q)] = [0, 1].map(|k| declaration.points.get(k)) else {
                continue;
            };
            let rates: Vec<f64> = match declaration.kind {
                DeclarationKind::Joint(JointKind::Revolute) => {
                    self.motions.iter().map(|motion| turn(system, motion, q) - turn(system, motion, p)).collect()
                }
                DeclarationKind::Joint(JointKind::Translational) => self.slides(evaluator, p, q),
                _ => continue,
            };
            let quantity = if declaration.kind == DeclarationKind::Joint(JointKind::Revolute) {
                "rotation"
            } else {
                "displacement"
            };
            candidates.push((format!("{quantity}({})", declaration.name), rates));
        }
        for &body in &self.moving {
            let name = &system.bodies[body].name;
            let turns = self.motions.iter().map(|motion| motion[system.pose_of(body)[2]]).collect();
            let of_body = |point: &PointId| system.points[*point].body == Some(body);
            let point = system.points.ids().filter(of_body).find_map(|k| Some((k, system.points[k].name.as_ref()?)));
            if let Some((point, point_name)) = point {
                for (part, word) in [(0, "x"), (1, "y")] {
                    let rates =
                        self.motions.iter().map(|motion| velocity(evaluator, motion, point)[part] / system.length);
                    candidates.push((format!("{word}({name}.{point_name})"), rates.collect()));
                }
            }
            candidates.push((format!("angle({name})"), turns));
        }
        candidates
    }

    /// How fast a second point moves away from a first one, along the way it takes.
    fn slides(&self, evaluator: &Evaluator<'_>, p: PointId, q: PointId) -> Vec<f64> {
        let system = evaluator.system;
        let (from, to) = (evaluator.place_of(p), evaluator.place_of(q));
        let relative = |motion: &Vec<f64>| {
            let (vp, vq) = (velocity(evaluator, motion, p), velocity(evaluator, motion, q));
            // seen from the first body
            let turn = turn(system, motion, p);
            [vq[0] - vp[0] + turn * (to[1] - from[1]), vq[1] - vp[1] - turn * (to[0] - from[0])]
        };
        let all: Vec<[f64; 2]> = self.motions.iter().map(relative).collect();
        let size = |v: &[f64; 2]| math::hypot(v[0], v[1]);
        let fastest = all.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or([0.0; 2]);
        let norm = f64::max(size(&fastest), f64::MIN_POSITIVE);
        all.iter().map(|v| (v[0] * fastest[0] + v[1] * fastest[1]) / norm / system.length).collect()
    }

    /// Points of moving bodies that lie on points of others, and that no joint holds together.
    fn joints(&self, evaluator: &Evaluator<'_>) -> Vec<String> {
        let system = evaluator.system;
        // a joint takes two; it may hold what is held already, and leave one
        let is_enough = self.degrees() >= 2 || system.ndof() < self.degrees().cast_signed();
        if !is_enough || system.points.len() > MOST_POINTS {
            return Vec::new();
        }
        let drawn = Evaluator::new(system);
        let pinned = pinned_together(system);
        let held = |p: PointId, q: PointId| {
            let bodies = [system.points[p].body, system.points[q].body];
            let holds = |points: &[PointId]| {
                matches!(points, &[a, b] if [system.points[a].body, system.points[b].body] == bodies
                    || [system.points[b].body, system.points[a].body] == bodies)
            };
            pinned[p] == pinned[q] || system.declarations.iter().any(|declaration| holds(&declaration.points))
        };
        let mut pairs: Vec<(f64, PointId, PointId)> = Vec::new();
        for p in system.points.ids() {
            for q in system.points.ids().skip(p.index() + 1) {
                let bodies = [system.points[p].body, system.points[q].body];
                let moves = bodies.iter().flatten().any(|body| self.moving.contains(body));
                if bodies[0] == bodies[1] || !moves {
                    continue;
                }
                let (a, b) = (drawn.place_of(p), drawn.place_of(q));
                let apart = math::hypot(b[0] - a[0], b[1] - a[1]);
                let is_used = |point: PointId| system.declarations.iter().any(|one| one.points.contains(&point));
                let near = if is_used(p) || is_used(q) { COINCIDE } else { DANGLING };
                if apart < near * system.length && !held(p, q) {
                    pairs.push((apart, p, q));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let text = |&(_, p, q): &(f64, PointId, PointId)| {
            Some(format!("`joint NAME: revolute({}, {})`", system.point_name(p)?, system.point_name(q)?))
        };
        // of points that are pinned together one will do
        let mut told: Vec<[PointId; 2]> = Vec::new();
        pairs.retain(|&(_, p, q)| {
            let mut both = [pinned[p], pinned[q]];
            both.sort_unstable();
            let is_new = !told.contains(&both);
            told.push(both);
            is_new
        });
        pairs.iter().filter_map(text).take(SUGGESTED.min(usize::max(self.degrees() / 2, 1))).collect()
    }
}

/// The motions that the rows of a part leave free where it is drawn, whether or not it can be assembled; none where they have no
/// value at that time (s).
pub fn motions_as_drawn(system: &ConstraintSystem, part: &Part, t: f64) -> Option<Vec<FreeMotion>> {
    let jacobian = Evaluator::new(system).linear(&part.rows, &part.columns, None, t)?.jacobian;
    let taken = Basis::of(&jacobian, part.columns.len()).vectors;
    Some(motions_beside(system, part, taken).iter().map(|motion| of_bodies(system, motion)).collect())
}

/// A motion of all coordinates, scaled, as one of the bodies.
fn of_bodies(system: &ConstraintSystem, motion: &[f64]) -> FreeMotion {
    let fastest = motion.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let velocity = |body: BodyId| system.pose_of(body).map(|column| (column, motion[column]));
    let moves = |body: &BodyId| velocity(*body).iter().any(|(_, x)| x.abs() > MOVES * fastest);
    let moved = |body: BodyId| {
        let of_rounding = |x: f64| if x.abs() > MOVES * fastest { x / fastest } else { 0.0 };
        (body, velocity(body).map(|(column, x)| of_rounding(x) * system.coordinates[column].scale))
    };
    FreeMotion { bodies: system.bodies.ids().filter(moves).map(moved).collect() }
}

/// The motions beside an orthonormal basis of what is held, each told by itself, of all coordinates.
fn motions_beside(system: &ConstraintSystem, part: &Part, mut taken: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut motions = Vec::new();
    while let Some(motion) = next_motion(system, part, &taken) {
        taken.push(motion.clone());
        motions.push(motion);
    }
    apart(motions).iter().map(|motion| spread(motion, part, system.coordinates.len())).collect()
}

/// For each point, one that stands for all that are pinned together with it, also by way of others.
fn pinned_together(system: &ConstraintSystem) -> IdVec<PointId, PointId> {
    let mut stands_for: IdVec<PointId, PointId> = system.points.ids().collect();
    let mut join = |a: PointId, b: PointId| {
        let (from, to) = (stands_for[a], stands_for[b]);
        for point in stands_for.iter_mut() {
            if *point == from {
                *point = to;
            }
        }
    };
    for declaration in &system.declarations {
        if let (DeclarationKind::Joint(JointKind::Revolute | JointKind::Weld), &[a, b]) =
            (declaration.kind, declaration.points.as_slice())
        {
            join(a, b);
        }
    }
    // a point may stand in a body under several names
    let mut first_at: FxHashMap<(Option<BodyId>, [u64; 2]), PointId> = FxHashMap::default();
    for (k, point) in system.points.pairs() {
        let place = point.at.map(|id| (system.value_at(id, &[]) + 0.0).to_bits());
        match first_at.entry((point.body, place)) {
            Entry::Occupied(known) => join(k, *known.get()),
            Entry::Vacant(free) => drop(free.insert(k)),
        }
    }
    stands_for
}

/// How much of each coordinate is free.
fn shares_left(taken: &[Vec<f64>], n: usize) -> Vec<f64> {
    (0..n).map(|k| 1.0 - taken.iter().map(|vector| vector[k] * vector[k]).sum::<f64>()).collect()
}

/// A free motion beside those taken, of unit norm: that of the angle, or else the coordinate, which is freest.
fn next_motion(system: &ConstraintSystem, part: &Part, taken: &[Vec<f64>]) -> Option<Vec<f64>> {
    let n = part.columns.len();
    if taken.len() >= n {
        return None;
    }
    let shares = shares_left(taken, n);
    let is_angle = |k: usize| system.coordinates[part.columns[k] as usize].kind == CoordinateKind::Angle;
    let freest =
        |wanted: &dyn Fn(usize) -> bool| (0..n).filter(|&k| wanted(k)).max_by(|&a, &b| shares[a].total_cmp(&shares[b]));
    let any = freest(&|_| true)?;
    let of_angle = freest(&is_angle).filter(|&k| shares[k] > ANGLE_SHARE * shares[any]);
    let mut unit = vec![0.0; n];
    unit[of_angle.unwrap_or(any)] = 1.0;
    let (rest, _) = orthogonal(&unit, taken);
    let norm = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm > 0.0).then(|| rest.iter().map(|x| x / norm).collect())
}

/// The same motions, each without the leading coordinates of the others: so it can be told by itself.
fn apart(mut motions: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for k in 0..motions.len() {
        let n = motions[k].len();
        let Some(leading) = (0..n).max_by(|&a, &b| motions[k][a].abs().total_cmp(&motions[k][b].abs())) else {
            return motions;
        };
        let pivot = motions[k][leading];
        let reference: Vec<f64> = motions[k].iter().map(|x| x / pivot).collect();
        for (j, other) in motions.iter_mut().enumerate() {
            let share = other[leading];
            if j != k {
                for (x, r) in other.iter_mut().zip(&reference) {
                    *x -= share * r;
                }
            }
        }
        motions[k] = reference;
    }
    motions
}

/// A motion of a part's coordinates as one of all coordinates.
fn spread(motion: &[f64], part: &Part, n: usize) -> Vec<f64> {
    let mut all = vec![0.0; n];
    for (&column, x) in part.columns.iter().zip(motion) {
        all[column as usize] = *x;
    }
    all
}

/// How fast the body of a point turns.
fn turn(system: &ConstraintSystem, motion: &[f64], point: PointId) -> f64 {
    system.points[point].body.map_or(0.0, |body| motion[system.pose_of(body)[2]])
}

/// How fast a point moves (m).
fn velocity(evaluator: &Evaluator<'_>, motion: &[f64], point: PointId) -> [f64; 2] {
    let system = evaluator.system;
    let Some(body) = system.points[point].body else {
        return [0.0; 2];
    };
    let [x, y] = evaluator.place_of(point);
    let along = |k: usize| motion[k] * system.coordinates[k].scale;
    let [origin_x, origin_y, phi] = system.pose_of(body);
    let turn = motion[phi];
    [along(origin_x) - turn * (y - evaluator.q[origin_y]), along(origin_y) + turn * (x - evaluator.q[origin_x])]
}
