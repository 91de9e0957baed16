//! Too few equations: the motions that are left free.

use super::errors;
use super::evaluator::Evaluator;
use super::free_motion::motion_in_words;
use super::orthonormal::Orthonormal;
use super::proposals::Proposals;
use super::redundancy::basis_of;
use crate::limits::explain::MOST_NAMED;
use crate::limits::redundancy::NO_SHARE;
use mechc_ir::structure::Subsystem;
use mechc_ir::{BodyId, ConstraintSystem, CoordinateKind, DeclarationKind, IdVec};
use nalgebra::DVector;

/// Largest residual of an assembled position; free motions are only reported at one.
const ASSEMBLED: f64 = 1e-8;
/// A coordinate with at least this share is not constrained at all.
const LOOSE: f64 = 1.0 - 1e-9;
/// Free motions are described by angles whose share is at least this part of the largest.
const ANGLE_SHARE: f64 = 0.01;

/// Motion of the bodies in a degree of freedom that equations leave: at whichever speed, and either way.
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
    /// Quantities that a driver could prescribe to take the freedom: `rotation(main)`.
    drivers: Vec<String>,
    /// Joints that may have been forgotten, as text to write.
    joints: Vec<String>,
    /// Sliding joints that may have been forgotten, as text to write.
    guides: Vec<String>,
    /// True if the mechanism has a driver.
    is_driven: bool,
}

impl Freedom {
    /// Returns what the rows of a part leave free of its columns at a time (s); `None` if they cannot be met.
    pub fn new(evaluator: &mut Evaluator<'_>, part: &Subsystem, t: f64) -> Option<Freedom> {
        let linear = evaluator.assemble(&part.rows, &part.columns, None, t)?;
        if linear.residual.iter().any(|open| open.abs() > ASSEMBLED) {
            return None;
        }
        let jacobian = evaluator.linear(&part.rows, &part.columns, None, t)?.jacobian;
        let system = evaluator.system;
        let taken = basis_of(&jacobian, part.columns.len()).span;
        let shares = taken.shares_left();
        let with_share = |least: f64| {
            let mut count = system.bodies().map(|_| 0);
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
        let moving = bodies_where(with_share(NO_SHARE), 1);
        let motions = motions_left(system, part, taken);
        let is_driven = system.declarations().iter().any(|one| one.kind == DeclarationKind::Driver);
        let mut freedom =
            Freedom { motions, loose, moving, drivers: Vec::new(), joints: Vec::new(), guides: Vec::new(), is_driven };
        let proposals = Proposals { evaluator, motions: &freedom.motions, moving: &freedom.moving };
        (freedom.drivers, freedom.joints, freedom.guides) =
            (proposals.drivers(), proposals.joints(), proposals.guides());
        Some(freedom)
    }

    /// Returns the motions of the bodies.
    pub fn motions_of_bodies(&self, system: &ConstraintSystem) -> Vec<FreeMotion> {
        self.motions.iter().map(|motion| of_bodies(system, motion)).collect()
    }

    /// Returns the number of degrees of freedom.
    pub fn degrees(&self) -> usize {
        self.motions.len()
    }

    /// Returns the bodies that can move.
    pub fn moving(&self) -> &[BodyId] {
        &self.moving
    }

    /// Returns the quantities that a driver could prescribe to take the freedom: `rotation(main)`.
    pub fn drives(&self) -> &[String] {
        &self.drivers
    }

    /// Describes the freedom in sentences.
    pub fn in_words(&self, system: &ConstraintSystem) -> Vec<String> {
        let is_loose = |column: usize| system.body_of(column).is_some_and(|body| self.loose.contains(&body));
        let mut sentences: Vec<String> = Vec::new();
        for motion in &self.motions {
            let moves = |k: &usize| motion[*k].abs() > NO_SHARE;
            if !(0..motion.len()).filter(moves).all(is_loose) {
                sentences.push(motion_in_words(system, motion));
            }
        }
        let left_out = sentences.len().saturating_sub(MOST_NAMED);
        sentences.truncate(MOST_NAMED);
        if left_out > 0 {
            sentences.push(format!("and {left_out} more motions"));
        }
        let loose: Vec<String> = self.loose.iter().map(|&body| format!("`{}`", system.bodies()[body].name)).collect();
        if !loose.is_empty() {
            sentences.push(format!("nothing holds {}", errors::cut_list(&loose)));
        }
        sentences
    }

    /// Returns suggestions that take the freedom.
    pub fn helps(&self) -> Vec<String> {
        let mut helps = Vec::new();
        if !self.joints.is_empty() {
            let what = if self.joints.len() == 1 { "a joint is missing?" } else { "joints are missing?" };
            helps.push(format!(
                "{what} These points are drawn onto each other, or nearly so: {}",
                self.joints.join(", ")
            ));
        }
        if !self.guides.is_empty() {
            helps
                .push(format!("a joint is missing? No joint takes these axes of one name: {}", self.guides.join(", ")));
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
        if !self.is_driven {
            helps.push("free motion is not computed: a driver prescribes each degree of freedom over time".to_owned());
        }
        helps
    }
}

/// Returns the motions that the rows of a part leave free where it is drawn, whether or not it can be assembled; `None` if they have no
/// value at that time (s).
pub fn motions_as_drawn(system: &ConstraintSystem, part: &Subsystem, t: f64) -> Option<Vec<FreeMotion>> {
    let jacobian = Evaluator::new(system).linear(&part.rows, &part.columns, None, t)?.jacobian;
    let taken = basis_of(&jacobian, part.columns.len()).span;
    Some(motions_left(system, part, taken).iter().map(|motion| of_bodies(system, motion)).collect())
}

/// Converts a motion of all coordinates, scaled, to one of the bodies.
fn of_bodies(system: &ConstraintSystem, motion: &[f64]) -> FreeMotion {
    let fastest = motion.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let velocity = |body: BodyId| system.pose_of(body).map(|column| (column, motion[column]));
    let moves = |body: &BodyId| velocity(*body).iter().any(|(_, x)| x.abs() > NO_SHARE * fastest);
    let moved = |body: BodyId| {
        let of_rounding = |x: f64| if x.abs() > NO_SHARE * fastest { x / fastest } else { 0.0 };
        (body, velocity(body).map(|(column, x)| of_rounding(x) * system.coordinates()[column].scale))
    };
    FreeMotion { bodies: system.bodies().ids().filter(moves).map(moved).collect() }
}

/// Returns the motions that are left free, by all coordinates, each independent of the others.
fn motions_left(system: &ConstraintSystem, part: &Subsystem, mut taken: Orthonormal) -> Vec<Vec<f64>> {
    let mut motions = Vec::new();
    while let Some(motion) = next_motion(system, part, &mut taken) {
        motions.push(motion);
    }
    apart(motions).iter().map(|motion| spread(motion.as_slice(), part, system.coordinates().len())).collect()
}

/// Returns a free motion of unit norm besides those taken, and takes it: the motion of the angle, or else of the coordinate, that is freest.
fn next_motion(system: &ConstraintSystem, part: &Subsystem, taken: &mut Orthonormal) -> Option<DVector<f64>> {
    let n = part.columns.len();
    if taken.is_whole() {
        return None;
    }
    let shares = taken.shares_left();
    let is_angle = |k: usize| system.coordinates()[part.columns[k] as usize].kind == CoordinateKind::Angle;
    let freest =
        |counts: &dyn Fn(usize) -> bool| (0..n).filter(|&k| counts(k)).max_by(|&a, &b| shares[a].total_cmp(&shares[b]));
    let any = freest(&|_| true)?;
    let of_angle = freest(&is_angle).filter(|&k| shares[k] > ANGLE_SHARE * shares[any]);
    let mut axis = DVector::zeros(n);
    axis[of_angle.unwrap_or(any)] = 1.0;
    let (rest, _) = taken.split(axis);
    taken.take(&rest, 0.0).then(|| taken.last())?
}

/// Subtracts from each motion the leading coordinates of the others, so that each can be described by itself.
fn apart(mut motions: Vec<DVector<f64>>) -> Vec<DVector<f64>> {
    for k in 0..motions.len() {
        let motion = &motions[k];
        let largest = (0..motion.len()).max_by(|&a, &b| motion[a].abs().total_cmp(&motion[b].abs()));
        let Some(leading) = largest else { return motions };
        let reference = motion / motion[leading];
        for (j, other) in motions.iter_mut().enumerate() {
            if j != k {
                other.axpy(-other[leading], &reference, 1.0);
            }
        }
        motions[k] = reference;
    }
    motions
}

/// Converts a motion of a part's coordinates to one of all coordinates.
fn spread(motion: &[f64], part: &Subsystem, n: usize) -> Vec<f64> {
    let mut all = vec![0.0; n];
    for (&column, x) in part.columns.iter().zip(motion) {
        all[column as usize] = *x;
    }
    all
}
