//! Doubts about the assembled position where estimates are far off.
//!
//! Most loops can be assembled in more than one way, and assembly takes the one that it comes to. If it had to move a
//! body of a loop far, other ways are sought; if one of them is not clearly farther from the estimates, a warning
//! says so. Coordinates that follow from drivers and joints without iteration are right however far off their estimates are.

use super::search::{Noise, levenberg_marquardt};
use crate::analysis::state::{Kinematics, State};
use crate::limits::assembly::{LARGEST_DENSE, SAME};
use mechc_ir::structure::Determined;
use mechc_ir::{BodyId, ConstraintSystem, CoordinateKind};
use std::f64::consts::{PI, TAU};

/// A body of a loop that turns by more than this (rad) during assembly was drawn in the other orientation.
const TURNED_OVER: f64 = std::f64::consts::FRAC_PI_2;
/// Another position is an alternative if it is at most this many times as far from the estimates as the chosen one.
const AS_NEAR: f64 = 2.0;
/// Largest number of coordinates of a loop whose alternatives are searched for.
const LARGEST_LOOP: usize = 60;
/// Maximum number of loops in which alternatives are searched for.
const MOST_LOOPS: usize = 8;
/// Number of random starts of the search.
const RANDOM_STARTS: usize = 8;

/// Reason why the assembled position may not be the intended one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Doubt {
    /// The estimates led nowhere, and others near them were tried.
    Perturbed,
    /// The equations do not close with the drivers where the estimates have them. They were closed without the drivers, which then moved to
    /// where they begin.
    DriversLeftOut,
    /// No way leads through all turns between where the drivers are drawn and where they begin: the drivers took the shortest way.
    ShortestWay,
    /// A bifurcation was passed on the way from where the drivers are drawn to where they begin.
    Passed,
    /// No way leads from the drawn position to where the drivers begin: the equations were closed from the estimates with the drivers there.
    NotDriven,
    /// The estimate of a body is far off.
    Far(FarBody),
}

/// A body whose estimate is far off.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FarBody {
    /// The body.
    pub body: BodyId,
    /// Distance.
    pub off: Off,
}

/// Distance of a body's estimate from its position.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Off {
    /// Rotation (rad).
    Turned(f64),
    /// Displacement (m), where the loop can be assembled otherwise, hardly farther from the estimates, or is too
    /// large to look.
    Moved(f64),
}

/// Equations that have to be solved by iteration, with those that follow from them one after the other.
#[derive(Default)]
struct Loop {
    rows: Vec<u32>,
    columns: Vec<u32>,
}

/// Returns the body whose estimate in `from` leaves in doubt that the assembled state is the intended one.
pub fn doubt(kinematics: &mut Kinematics, from: &[f64], state: &State) -> Option<FarBody> {
    let determined = kinematics.determined();
    let system = determined.system();
    // most estimates are near
    farthest(system, 0..from.len(), from, &state.q)?;
    let is_large = |found: &Loop| from.len() > LARGEST_DENSE || found.columns.len() > LARGEST_LOOP;
    let loops = loops(&determined);
    let far = loops.iter().filter_map(|found| Some((found, farthest(system, found.columns(), from, &state.q)?)));
    let doubt = far.take(MOST_LOOPS).find(|(found, doubt)| {
        matches!(doubt.off, Off::Turned(_)) || is_large(found) || is_another_as_near(kinematics, found, from, &state.q)
    });
    kinematics.restore(state);
    doubt.map(|(_, doubt)| doubt)
}

/// Returns the largest scaled displacement of the coordinates that iteration solves for, and of those that follow from them.
pub fn moved_in_loops(determined: &Determined, from: &[f64], to: &[f64]) -> f64 {
    let system = determined.system();
    let of_bodies = |column: &usize| system.body_of(*column).is_some();
    let way = |column: usize| {
        let coordinate = &system.coordinates()[column];
        distance_of(coordinate.kind, from[column], to[column]) / coordinate.scale
    };
    let loops = loops(determined);
    loops.iter().flat_map(Loop::columns).filter(of_bodies).map(way).fold(0.0, f64::max)
}

/// Returns the first body that turned over, or else the one that moved farthest, if that is far.
fn farthest(
    system: &ConstraintSystem,
    columns: impl Iterator<Item = usize>,
    from: &[f64],
    to: &[f64],
) -> Option<FarBody> {
    let (mut farthest, mut moved) = (system.length(), None);
    for column in columns {
        let Some(body) = system.body_of(column) else { continue };
        let kind = system.coordinates()[column].kind;
        let way = distance_of(kind, from[column], to[column]);
        match kind {
            CoordinateKind::Angle if way > TURNED_OVER => return Some(FarBody { body, off: Off::Turned(way) }),
            CoordinateKind::Length if way > farthest => {
                (farthest, moved) = (way, Some(FarBody { body, off: Off::Moved(way) }));
            }
            _ => {}
        }
    }
    moved
}

/// Returns the loops in their order of solution, each with the explicit blocks that follow from it. Blocks that depend on no loop are in none.
fn loops(determined: &Determined) -> Vec<Loop> {
    let system = determined.system();
    let mut loops: Vec<Loop> = Vec::new();
    let mut loop_of: Vec<Option<usize>> = vec![None; system.coordinates().len()];
    for block in determined.blocks() {
        let used = block.rows.iter().flat_map(|&row| system.phi_q().row(row as usize));
        let found = if block.explicit {
            used.filter_map(|&(column, _)| loop_of[column as usize]).max()
        } else {
            loops.push(Loop::default());
            Some(loops.len() - 1)
        };
        let Some(k) = found else { continue };
        block.columns.iter().for_each(|&column| loop_of[column as usize] = Some(k));
        loops[k].rows.extend(&block.rows);
        loops[k].columns.extend(&block.columns);
    }
    loops
}

impl Loop {
    fn columns(&self) -> impl Iterator<Item = usize> {
        self.columns.iter().map(|&column| column as usize)
    }
}

/// Returns whether a loop can be assembled in another position that is as near to the estimates.
fn is_another_as_near(kinematics: &mut Kinematics, within: &Loop, from: &[f64], to: &[f64]) -> bool {
    let most = AS_NEAR * distance(kinematics, within, from, to);
    starts(kinematics, within, from, to).into_iter().any(|mut q| {
        if kinematics.is_cancelled() {
            return false;
        }
        levenberg_marquardt(kinematics, &mut q, &within.rows, &within.columns);
        let is_assembled = kinematics.set_position(&q).is_ok()
            && kinematics.factor().is_ok()
            && kinematics.hold(&within.rows)
            && kinematics.turned_lines().is_empty();
        is_assembled && distance(kinematics, within, to, &q) > SAME && distance(kinematics, within, from, &q) <= most
    })
}

/// Returns starts for the search of other branches: on the other side of the estimates, with one body after the other turned round, and at random.
fn starts(kinematics: &Kinematics, within: &Loop, from: &[f64], to: &[f64]) -> Vec<Vec<f64>> {
    let system = kinematics.system();
    let mut mirrored = to.to_vec();
    within.columns().for_each(|column| mirrored[column] = 2.0 * from[column] - to[column]);
    let mut starts = vec![mirrored];
    for column in within.columns().filter(|&column| system.coordinates()[column].kind == CoordinateKind::Angle) {
        let mut turned = to.to_vec();
        turned[column] += PI;
        starts.push(turned);
    }
    let mut noise = Noise::new();
    starts.extend((0..RANDOM_STARTS).map(|_| {
        let mut start = to.to_vec();
        within.columns().for_each(|column| {
            start[column] = match system.coordinates()[column].kind {
                CoordinateKind::Angle | CoordinateKind::Argument => to[column] + PI * noise.next(),
                CoordinateKind::Length => from[column] + system.length() * noise.next(),
            }
        });
        start
    }));
    starts
}

/// Returns the distance between two positions of a loop's bodies, in lengths of the mechanism and radians.
fn distance(kinematics: &Kinematics, within: &Loop, a: &[f64], b: &[f64]) -> f64 {
    let system = kinematics.system();
    let squares = within.columns().filter(|&c| system.body_of(c).is_some()).map(|c| {
        let kind = system.coordinates()[c].kind;
        let unit = if kind == CoordinateKind::Length { system.length() } else { 1.0 };
        let way = distance_of(kind, a[c], b[c]) / unit;
        way * way
    });
    squares.sum::<f64>().sqrt()
}

/// Returns the distance between two values of a coordinate; whole turns do not count.
fn distance_of(kind: CoordinateKind, a: f64, b: f64) -> f64 {
    match kind {
        CoordinateKind::Length | CoordinateKind::Argument => (a - b).abs(),
        CoordinateKind::Angle => {
            let way = (a - b).abs() % TAU;
            way.min(TAU - way)
        }
    }
}
