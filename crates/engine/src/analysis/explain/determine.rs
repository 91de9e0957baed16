//! Proof that a system is determined, or else an explanation: too many equations, coordinates that are too free, or both.
//!
//! `structure` decides by pattern, without values. Here what it refuses is assembled as far as possible and examined with values: which
//! equations are redundant, which contradict each other, and which motions are left.

use super::errors;
use super::evaluator::Evaluator;
use super::freedom::{FreeMotion, Freedom, motions_as_drawn};
use super::redundancy::{Dependent, dependents, times_nearby};
use super::sharing::{along_motion, shared};
use crate::analysis::state::Horizon;
use crate::limits::assembly::AGREES;
use crate::limits::explain::LARGEST;
use mechc_ir::structure::{self, Determined, Refused, Subsystem};
use mechc_ir::{ConstraintSystem, DeclarationKind, Homotopy};
use mechc_text::diag::{Diagnostic, Diagnostics};

/// Largest part if redundant equations are allowed: that takes some seconds.
const LARGEST_ALLOWED: usize = 1500;

/// Shows that a system is determined, where need be without the equations that are redundant.
///
/// # Errors
/// Too few equations, too many, or some that conflict. Redundant ones are refused unless they are allowed.
pub fn determine(
    system: ConstraintSystem,
    allow_redundant: bool,
    horizon: Horizon,
) -> Result<(Determined, Diagnostics), Diagnostics> {
    let refused = match structure::prove(system) {
        Ok(determined) => return Ok((determined, Diagnostics::default())),
        Err(refused) => *refused,
    };
    let limit = if allow_redundant { LARGEST_ALLOWED } else { LARGEST };
    let times = [horizon.from, horizon.span];
    let mut evaluator = Evaluator::new(&refused.system);
    let start = driven(&refused.system, &refused.too_many, horizon.from);
    if let Some(start) = &start {
        evaluator.q.clone_from(start);
    }
    let dependents = surplus_within(&mut evaluator, &refused.too_many, times, limit);
    let is_enough = dependents.len().cast_signed() == -refused.system.ndof();
    let holds = dependents.iter().all(|dependent| dependent.open.is_none());
    if !(allow_redundant && holds && is_enough && refused.too_few.columns.is_empty()) {
        let anatomy = Anatomy::with_dependents(&mut evaluator, dependents, times);
        let size = refused.too_many.rows.len();
        if allow_redundant && size > limit {
            return Err(errors::too_large(refused.diagnostic, size, limit).into());
        }
        return Err(explain(refused, &anatomy));
    }
    let mut system = refused.system;
    let formulas = system.formulas_with_forces();
    let shared = shared(&system, &refused.too_many, dependents.len(), horizon, start.as_deref(), formulas.into_iter());
    system.retain_forces(|value| shared.iter().all(|shared| shared.formula != value));
    if let Some(why) = errors::shared_force(&system, &shared) {
        return Err(why.into());
    }
    let diagnostics = errors::left_out(&system, &dependents);
    let mut rows: Vec<usize> = dependents.iter().map(|dependent| dependent.row).collect();
    rows.sort_unstable();
    match Determined::without(system, rows) {
        Ok(determined) => Ok((determined.with_start(start), diagnostics)),
        Err(refused) => Err(refused.diagnostic.into()),
    }
}

/// Returns the diagnostics of a system that was refused.
fn explain(refused: Refused, anatomy: &Anatomy) -> Diagnostics {
    let Refused { system, diagnostic, too_few, .. } = refused;
    let is_free = !too_few.columns.is_empty() || anatomy.freedom.as_ref().is_some_and(|freedom| freedom.degrees() > 0);
    match (anatomy.dependents.as_slice(), &anatomy.freedom) {
        ([], None) => diagnostic.into(),
        ([], Some(freedom)) => errors::too_few(diagnostic, &system, freedom).into(),
        (dependents, _) if !is_free => errors::too_many(&system, dependents),
        (dependents, freedom) => {
            let first = match freedom {
                Some(freedom) => errors::too_many_and_too_few(&system, dependents, freedom),
                None => diagnostic,
            };
            first.into()
        }
    }
}

/// Returns the diagnostic of a system whose equations depend on each other in every position, though they are as many as the coordinates;
/// `None` where that cannot be decided.
pub fn explain_dependent(system: &ConstraintSystem, horizon: Horizon) -> Option<Diagnostic> {
    let Anatomy { dependents, freedom } = Anatomy::new(system, &everything(system), horizon);
    if let Some(touching) = dependents.iter().find(|dependent| dependent.touches) {
        return Some(errors::touching(system, touching, horizon.from));
    }
    let freedom = freedom.filter(|freedom| freedom.degrees() > 0)?;
    (!dependents.is_empty()).then(|| errors::too_many_and_too_few(system, &dependents, &freedom))
}

/// Returns the motions that an undetermined system leaves free where it is drawn; where it is drawn in a position in which it can move
/// otherwise than elsewhere, those where it is assembled.
#[must_use]
pub fn free_motions(system: &ConstraintSystem, horizon: Horizon) -> Vec<FreeMotion> {
    let rows = everything(system);
    if usize::max(rows.rows.len(), rows.columns.len()) > LARGEST {
        return Vec::new();
    }
    let Anatomy { dependents, freedom } = Anatomy::new(system, &rows, horizon);
    let mut kept = rows;
    kept.rows.retain(|&row| dependents.iter().all(|dependent| dependent.row != row as usize));
    let drawn = motions_as_drawn(system, &kept, horizon.from);
    match (drawn, freedom) {
        (Some(drawn), Some(freedom)) if drawn.len() != freedom.degrees() => freedom.motions_of_bodies(system),
        (Some(drawn), _) => drawn,
        (None, freedom) => freedom.map_or(Vec::new(), |freedom| freedom.motions_of_bodies(system)),
    }
}

/// Dependent equations and free motions of a system, found from values.
struct Anatomy {
    dependents: Vec<Dependent>,
    /// The freedom that is left, where it could be found.
    freedom: Option<Freedom>,
}

impl Anatomy {
    /// Examines a system of which a part has too many equations.
    fn new(system: &ConstraintSystem, too_many: &Subsystem, horizon: Horizon) -> Anatomy {
        let times = [horizon.from, horizon.span];
        let mut evaluator = Evaluator::new(system);
        let dependents = surplus_within(&mut evaluator, too_many, times, LARGEST);
        Anatomy::with_dependents(&mut evaluator, dependents, times)
    }

    /// Builds the anatomy with dependent equations that were found before.
    fn with_dependents(evaluator: &mut Evaluator<'_>, dependents: Vec<Dependent>, times: [f64; 2]) -> Anatomy {
        let mut kept = everything(evaluator.system);
        kept.rows.retain(|&row| dependents.iter().all(|dependent| dependent.row != row as usize));
        let is_small = usize::max(kept.rows.len(), kept.columns.len()) <= LARGEST;
        let freedom = if is_small { Anatomy::freedom(evaluator, &kept, times) } else { None };
        Anatomy { dependents, freedom }
    }
}

/// Returns the position [m, rad] of a part with too many equations after its drivers have moved from where they are drawn to where they are
/// at a time (s); `None` if they are drawn there or do not get there.
fn driven(system: &ConstraintSystem, part: &Subsystem, t: f64) -> Option<Vec<f64>> {
    if part.rows.is_empty() || part.rows.len() > LARGEST {
        return None;
    }
    let mut drawn = Evaluator::new(system);
    drawn.evaluate(t);
    let is_driving = |&row: &usize| system.drives(system.rows()[row].declaration, system.rows()[row].phi);
    let driving: Vec<usize> = part.rows.iter().map(|&row| row as usize).filter(is_driving).collect();
    let is_off = |&row: &usize| {
        drawn.linear_there(&[row as u32], &part.columns, None).is_some_and(|linear| linear.residual[0].abs() > AGREES)
    };
    if !driving.iter().any(is_off) {
        return None;
    }
    let lines = driving.into_iter().map(|row| (row, [drawn.phi(row), 0.0])).collect();
    let way = system.along(&Homotopy::Residuals { t, lines });
    let mut evaluator = Evaluator::new(&way);
    let mut is_there = false;
    along_motion(&mut evaluator, part, Horizon { from: 0.0, span: 1.0 }, |_, _, part| {
        is_there = part >= 1.0;
        false
    });
    is_there.then_some(evaluator.q)
}

/// Returns the [`surplus`] of a part, or nothing if the part is larger than a limit.
fn surplus_within(evaluator: &mut Evaluator<'_>, part: &Subsystem, times: [f64; 2], limit: usize) -> Vec<Dependent> {
    let is_looked_at = !part.rows.is_empty() && part.rows.len() <= limit;
    if is_looked_at { surplus(evaluator, part.clone(), times) } else { Vec::new() }
}

/// Returns the equations of a part that are too many. If one conflicts, its joint is taken away before the others are judged.
fn surplus(evaluator: &mut Evaluator<'_>, mut part: Subsystem, times: [f64; 2]) -> Vec<Dependent> {
    let system = evaluator.system;
    let declaration_of = |row: usize| system.rows()[row].declaration;
    // if joints hold the same, one that formulas reference stays
    let rank = |row: &u32| {
        let declaration = system.declaration_of(*row as usize);
        let kind = match declaration.kind {
            DeclarationKind::Joint(_) => 0,
            DeclarationKind::Constraint => 1,
            DeclarationKind::Driver => 2,
        };
        (kind, !declaration.is_referenced)
    };
    part.rows.sort_by_key(rank);
    let mut found = Vec::new();
    loop {
        let Some(mut dependents) = dependents(evaluator, &part, times) else {
            return found;
        };
        let leaves_none = part.rows.len() - dependents.len() == part.columns.len();
        if let Some(driver) = stuck_driver(system, &dependents).filter(|_| leaves_none) {
            // the joints do not fit together with it: the one that closes the loop is to be named
            part.rows.sort_by_key(|&row| (row as usize != driver, suspicion(system, row as usize)));
            dependents = self::dependents(evaluator, &part, times).unwrap_or(dependents);
        }
        let conflict = dependents.iter().find(|one| one.open.is_some() && !system.is_driver(one.row));
        let Some(conflict) = conflict.map(|one| declaration_of(one.row)) else {
            found.extend(dependents);
            return found;
        };
        found.extend(dependents.into_iter().filter(|one| declaration_of(one.row) == conflict));
        part.rows.retain(|&row| declaration_of(row as usize) != conflict);
    }
}

/// Returns the row of a driver to which joints alone leave no motion, none of them being redundant.
fn stuck_driver(system: &ConstraintSystem, dependents: &[Dependent]) -> Option<usize> {
    let is_stuck = |one: &&Dependent| {
        system.is_driver(one.row) && one.open.is_some() && !one.on.iter().any(|&row| system.is_driver(row))
    };
    let all_drive = dependents.iter().all(|one| system.is_driver(one.row));
    dependents.iter().find(is_stuck).filter(|_| all_drive).map(|one| one.row)
}

/// Ranks how likely a row is wrong rather than one before it: a prescribed length is wrong more often than a pin.
fn suspicion(system: &ConstraintSystem, row: usize) -> u8 {
    match system.declaration_of(row).kind {
        DeclarationKind::Joint(joint) if joint.holds_distance() => 2,
        DeclarationKind::Joint(_) | DeclarationKind::Driver => 0,
        DeclarationKind::Constraint => 1,
    }
}

impl Anatomy {
    /// Returns the freedom at the start, or shortly after it if less is left there: a start may be in a singular position.
    fn freedom(evaluator: &mut Evaluator<'_>, kept: &Subsystem, [t, span]: [f64; 2]) -> Option<Freedom> {
        let least = kept.columns.len().saturating_sub(kept.rows.len());
        let mut best: Option<Freedom> = None;
        for t in times_nearby(t, span) {
            if let Some(found) = Freedom::new(evaluator, kept, t)
                && best.as_ref().is_none_or(|best| found.degrees() < best.degrees())
            {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|best| best.degrees() <= least) {
                break;
            }
            evaluator.nudge(&kept.columns);
        }
        best
    }
}

fn everything(system: &ConstraintSystem) -> Subsystem {
    Subsystem {
        rows: (0..system.rows().len() as u32).collect(),
        columns: (0..system.coordinates().len() as u32).collect(),
    }
}
