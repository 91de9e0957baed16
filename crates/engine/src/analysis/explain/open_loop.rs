//! Open loops of a mechanism that cannot be assembled: which closed loop stays open, by how much, and which lengths are too short or too long for it.
//!
//! Where the residuals are least they are in balance, like the forces of springs in the joints. So they pull at the links: a link that is
//! drawn apart is too short, one that is pressed together is too long.

use super::errors;
use super::evaluator::Evaluator;
use crate::analysis::state::Linear;
use crate::limits::assembly::AGREES;
use crate::limits::explain::{LARGEST, NAMED, YIELDING};
use mechc_expr::math;
use mechc_ir::structure::{Block, Determined, Subsystem};
use mechc_ir::{BodyId, ConstraintSystem, CoordinateKind, DeclarationId, DeclarationKind, PointId};

/// An equation is part of the loop if its share of the residual exceeds this part of the largest.
const TAKES_PART: f64 = 0.01;
/// A link is too short or too long if at least this part of the force acts along it.
const ALONG: f64 = 0.3;
/// Larger gaps, in sizes of the mechanism, are not shown.
const FAR: f64 = 10.0;
/// A joint may be reported as open if its gap is this part of the widest.
const WIDE: f64 = 0.3;

/// A loop that does not close.
#[derive(Clone, Debug)]
pub struct OpenLoop {
    /// Declaration at which the loop is reported to be open.
    pub at: DeclarationId,
    /// Gap there (m or rad), all else being closed.
    pub by: f64,
    /// Kind of the gap.
    pub kind: CoordinateKind,
    /// All declarations that take part, in order.
    pub declarations: Vec<DeclarationId>,
    /// Lengths that stand in the way.
    pub links: Vec<FaultyLink>,
    /// The largest residual that is left, scaled.
    pub residual: f64,
}

impl OpenLoop {
    /// Returns whether the gap has another order of magnitude than the mechanism.
    #[must_use]
    pub fn is_far(&self, system: &ConstraintSystem) -> bool {
        let far = if self.kind == CoordinateKind::Length { 100.0 * system.length() } else { std::f64::consts::TAU };
        self.by > far
    }

    /// Returns whether no motion brings the two sides of the gap nearer to each other.
    #[must_use]
    pub fn is_unreachable(&self, system: &ConstraintSystem) -> bool {
        let is_joint = matches!(system.declarations()[self.at].kind, DeclarationKind::Joint(_));
        self.is_far(system) && !(is_joint && self.by.is_finite())
    }
}

/// A length that is too short or too long.
#[derive(Clone, Debug)]
pub struct FaultyLink {
    /// Kind of the length.
    pub of: FaultyLinkKind,
    /// The length (m).
    pub length: f64,
    /// True if it is too short, false if too long.
    pub too_short: bool,
}

/// Kind of a length.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FaultyLinkKind {
    /// The distance between two declarations' points on a body; `None` for the ground.
    Body(Option<BodyId>, [DeclarationId; 2]),
    /// The distance that a declaration prescribes.
    Declaration(DeclarationId),
}

/// Returns the loop that does not close, where the nearest position is `q`.
pub fn found(determined: &Determined, q: &[f64], t: f64) -> Option<OpenLoop> {
    locate(determined, q, t).map(|located| located.open)
}

/// Returns the coordinates [m, rad] where all equations hold but those of the reported open loop.
pub fn opened(determined: &Determined, q: &[f64], t: f64) -> Option<Vec<f64>> {
    let LocatedOpenLoop { open, mut evaluator, blocks } = locate(determined, q, t)?;
    // bodies that depend on the loop are shown at their positions then
    for block in determined.blocks()[blocks..].iter().filter(|block| block.rows.len() <= LARGEST) {
        evaluator.assemble(&block.rows, &block.columns, None, t);
    }
    let q = evaluator.q;
    let far = if open.kind == CoordinateKind::Length { FAR * determined.system().length() } else { FAR };
    (open.by <= far && q.iter().all(|x| x.is_finite())).then_some(q)
}

/// An open loop with the position that shows it.
struct LocatedOpenLoop<'s> {
    open: OpenLoop,
    /// Position in which all of the loop holds but one declaration.
    evaluator: Evaluator<'s>,
    /// Number of blocks that are examined with the loop or solved before it.
    blocks: usize,
}

fn locate<'s>(determined: &'s Determined, q: &[f64], t: f64) -> Option<LocatedOpenLoop<'s>> {
    let mut evaluator = Evaluator::new(determined.system());
    evaluator.q.copy_from_slice(q);
    let part = open_part(&mut evaluator, determined, t)?;
    evaluator.q.copy_from_slice(q);
    let open = open_loop(&mut evaluator, &part.equations, t)?;
    Some(LocatedOpenLoop { open, evaluator, blocks: part.blocks })
}

/// Equations that are examined together, and the number of blocks that need no further examination.
struct OpenPart {
    equations: Subsystem,
    blocks: usize,
}

/// Returns the first block that stays open with the blocks that it needs, unless these are large; all blocks if each closes by itself.
fn open_part(evaluator: &mut Evaluator<'_>, determined: &Determined, t: f64) -> Option<OpenPart> {
    let blocks = determined.blocks();
    let closes =
        |linear: Option<Linear>| linear.is_some_and(|linear| linear.residual.iter().all(|open| open.abs() <= AGREES));
    let together = |numbers: &[usize]| Some(in_order(blocks, numbers)).filter(|part| part.rows.len() <= LARGEST);
    evaluator.evaluate(t);
    for (k, block) in blocks.iter().enumerate().filter(|(_, block)| block.rows.len() <= LARGEST) {
        // most are closed where they are
        if !closes(evaluator.linear_there(&block.rows, &block.columns, None))
            && !closes(evaluator.assemble(&block.rows, &block.columns, None, t))
        {
            let equations = together(&determined.needed_by(k)).unwrap_or_else(|| in_order(blocks, &[k]));
            return Some(OpenPart { equations, blocks: k + 1 });
        }
    }
    let all: Vec<usize> = (0..blocks.len()).collect();
    together(&all).map(|equations| OpenPart { equations, blocks: blocks.len() })
}

/// Returns some blocks, by their numbers, as one subsystem in the order of the file, which diagnostics follow.
fn in_order(blocks: &[Block], numbers: &[usize]) -> Subsystem {
    let mut part = Subsystem { rows: Vec::new(), columns: Vec::new() };
    for &number in numbers {
        part.rows.extend(&blocks[number].rows);
        part.columns.extend(&blocks[number].columns);
    }
    part.rows.sort_unstable();
    part.columns.sort_unstable();
    part
}

fn open_loop(evaluator: &mut Evaluator<'_>, part: &Subsystem, t: f64) -> Option<OpenLoop> {
    let system = evaluator.system;
    let linear = evaluator.assemble(&part.rows, &part.columns, None, t)?;
    let largest = linear.residual.iter().fold(0.0, |m: f64, open| m.max(open.abs()));
    if largest < AGREES {
        return None;
    }
    let mut declarations: Vec<DeclarationId> = part
        .rows
        .iter()
        .zip(&linear.residual)
        .filter(|(_, open)| open.abs() > TAKES_PART * largest)
        .map(|(&row, _)| system.rows()[row as usize].declaration)
        .collect();
    declarations.dedup();
    let links = links(evaluator, part, &linear, &declarations);
    let at = weakest(system, part, &linear, &declarations)?;
    let weights: Vec<f64> = part
        .rows
        .iter()
        .zip(&linear.weights)
        .map(|(&row, weight)| if system.rows()[row as usize].declaration == at { weight * YIELDING } else { *weight })
        .collect();
    evaluator.assemble(&part.rows, &part.columns, Some(&weights), t)?;
    let rows = part.rows.iter().map(|&row| row as usize).filter(|&row| system.rows()[row].declaration == at);
    let (kind, by) = widest_gap(evaluator, rows)?;
    Some(OpenLoop { at, by, kind, declarations, links, residual: largest })
}

/// Returns the kind of the gap in some rows, and its size over all of them (m or rad); `None` if they close.
fn widest_gap(evaluator: &Evaluator<'_>, rows: impl Iterator<Item = usize>) -> Option<(CoordinateKind, f64)> {
    let system = evaluator.system;
    let gaps: Vec<(CoordinateKind, f64)> =
        rows.map(|row| (errors::gap_kind(system, row), evaluator.gap(row))).filter(|(_, by)| by.is_finite()).collect();
    if gaps.is_empty() {
        // no motion closes the gap
        return Some((CoordinateKind::Length, f64::INFINITY));
    }
    let of_kind = |kind: CoordinateKind| {
        let squares = gaps.iter().filter(|(gap_kind, _)| *gap_kind == kind).map(|(_, by)| by * by);
        squares.sum::<f64>().sqrt()
    };
    let (length, angle) = (of_kind(CoordinateKind::Length), of_kind(CoordinateKind::Angle));
    // the loop closes from here: the estimates are too far off, and no length is wrong
    if length <= AGREES * system.length() && angle <= AGREES {
        return None;
    }
    let is_length = length / system.length() > NAMED * angle;
    Some(if is_length { (CoordinateKind::Length, length) } else { (CoordinateKind::Angle, angle) })
}

/// Returns the declaration at which the loop is reported to be open: a prescribed length is wrong more often than a driven location, and
/// that more often than a pin.
fn weakest(
    system: &ConstraintSystem,
    part: &Subsystem,
    linear: &Linear,
    declarations: &[DeclarationId],
) -> Option<DeclarationId> {
    let is_about_places = |k: DeclarationId| {
        let first = (0..system.rows().len()).find(|&row| system.rows()[row].declaration == k);
        first.is_some_and(|row| errors::gap_kind(system, row) == CoordinateKind::Length)
    };
    let rank = |k: DeclarationId| match system.declarations()[k].kind {
        DeclarationKind::Joint(joint) if joint.holds_distance() => 2,
        DeclarationKind::Constraint => 1,
        DeclarationKind::Driver if is_about_places(k) => 1,
        _ => 0,
    };
    let open = |k: DeclarationId| {
        let rows =
            part.rows.iter().zip(&linear.residual).filter(|(row, _)| system.rows()[**row as usize].declaration == k);
        rows.map(|(_, open)| open * open).sum::<f64>()
    };
    // if pins are equally open, the last one closes the loop
    let is_no_driver = |k: DeclarationId| system.declarations()[k].kind != DeclarationKind::Driver;
    let largest = declarations.iter().map(|&k| open(k)).fold(0.0, f64::max);
    declarations.iter().copied().filter(|&k| open(k) > WIDE * largest).max_by_key(|&k| (rank(k), is_no_driver(k), k))
}

/// Returns the lengths along which the residuals pull or press.
fn links(
    evaluator: &Evaluator<'_>,
    part: &Subsystem,
    linear: &Linear,
    declarations: &[DeclarationId],
) -> Vec<FaultyLink> {
    let system = evaluator.system;
    let mut links = Vec::new();
    for &k in declarations {
        let link = |[length, found]: [f64; 2]| FaultyLink {
            of: FaultyLinkKind::Declaration(k),
            length,
            too_short: found > length,
        };
        links.extend(evaluator.distance(k).map(link));
    }
    let bodies = std::iter::once(None).chain(system.bodies().ids().map(Some));
    let pulls: Vec<(Option<BodyId>, Vec<Pull>)> =
        bodies.map(|body| (body, pulls(evaluator, part, linear, declarations, body))).collect();
    let largest = pulls.iter().flat_map(|(_, pulls)| pulls).map(Pull::size).fold(0.0, f64::max);
    for (body, pulls) in &pulls {
        let acting: Vec<&Pull> = pulls.iter().filter(|pull| pull.size() > NAMED * largest).collect();
        let &[first, second] = acting.as_slice() else {
            continue;
        };
        let (from, to) = (evaluator.place_of(first.point), evaluator.place_of(second.point));
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = math::hypot(way[0], way[1]);
        let along = (second.force[0] * way[0] + second.force[1] * way[1]) / length;
        if length > AGREES * system.length() && along.abs() > ALONG * f64::max(first.size(), second.size()) {
            let ends = [first.declaration, second.declaration];
            links.push(FaultyLink { of: FaultyLinkKind::Body(*body, ends), length, too_short: along > 0.0 });
        }
    }
    links
}

/// Force of a declaration at a point of a body.
struct Pull {
    declaration: DeclarationId,
    point: PointId,
    force: [f64; 2],
}

impl Pull {
    fn size(&self) -> f64 {
        math::hypot(self.force[0], self.force[1])
    }
}

/// Returns the pulls at a body or the ground.
fn pulls(
    evaluator: &Evaluator<'_>,
    part: &Subsystem,
    linear: &Linear,
    declarations: &[DeclarationId],
    body: Option<BodyId>,
) -> Vec<Pull> {
    let system = evaluator.system;
    let of_body = |declaration: DeclarationId| {
        let mut points = system.declarations()[declaration].points.iter().copied();
        let point = points.find(|&point| system.points()[point].body == body)?;
        Some(Pull { declaration, point, force: force(evaluator, part, linear, declaration, body) })
    };
    declarations.iter().filter_map(|&k| of_body(k)).collect()
}

/// Returns the force of a declaration on a body or the ground, if its residuals were springs.
fn force(
    evaluator: &Evaluator<'_>,
    part: &Subsystem,
    linear: &Linear,
    declaration: DeclarationId,
    body: Option<BodyId>,
) -> [f64; 2] {
    let system = evaluator.system;
    let mut force = [0.0; 2];
    for (k, &row) in part.rows.iter().enumerate() {
        let row = row as usize;
        if system.rows()[row].declaration != declaration {
            continue;
        }
        let pull = linear.residual[k] / linear.weights[k];
        for (column, slope) in evaluator.slopes(row) {
            let Some(of) = system.body_of(column) else { continue };
            let [x, y, _] = system.pose_of(of);
            let Some(axis) = [x, y].iter().position(|&place| place == column) else { continue };
            match body {
                Some(body) if of == body => force[axis] -= pull * slope,
                // the ground takes the reactions of the forces on the bodies
                None => force[axis] += pull * slope,
                Some(_) => {}
            }
        }
    }
    force
}
