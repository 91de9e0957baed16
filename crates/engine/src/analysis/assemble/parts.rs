//! Starts of parts: each part is solved alone and carried to its mount.
//!
//! The inputs of a part and the pose of its mount must be resolved first. So equations of the mechanism around are solved block by block,
//! as far as parts need them, and a part is placed once all that it follows is resolved. A part in a cycle is placed without having been
//! continued to its inputs.

use super::search::levenberg_marquardt;
use crate::analysis::state::{Horizon, Kinematics};
use crate::limits::assembly::LARGEST_DENSE;
use mechc_expr::math;
use mechc_expr::{ExprId, Symbol};
use mechc_ir::PartStart;
use mechc_ir::program::Program;
use mechc_ir::structure::{Block, Determined};
use mechc_text::cancel::Cancel;
use std::sync::Arc;

/// Request for the coordinates of a part that is solved alone.
pub struct Request {
    /// Its number.
    pub part: usize,
    /// Target values of its inputs (SI), if its inputs are continued.
    pub inputs: Option<Vec<f64>>,
}

/// Returns the coordinates of parts, in one call for all parts that can be solved at once.
pub type Leader<'l> = dyn FnMut(&[Request]) -> Vec<Option<Vec<f64>>> + 'l;

/// Returns the estimates of a mechanism at a time (s) [m, rad], with its parts at their starts.
#[must_use]
pub fn with_parts(
    determined: &Arc<Determined>,
    program: &Arc<Program>,
    horizon: Horizon,
    estimates: Vec<f64>,
    leader: &mut Leader<'_>,
    cancel: &Cancel,
) -> Vec<f64> {
    let kinematics =
        Kinematics::new(Arc::clone(determined), Arc::clone(program), horizon.span, f64::INFINITY, cancel.clone());
    let mut placing = Placing::new(kinematics, determined, horizon.from, estimates);
    while !placing.open.is_empty() && !cancel.is_cancelled() {
        let (resolved, open): (Vec<usize>, Vec<usize>) =
            placing.open.iter().partition(|&&part| placing.is_resolved(part));
        if !resolved.is_empty() {
            placing.open = open;
            placing.place(&resolved, true, leader);
        } else if !placing.solve_what_is_needed() {
            // the part depends on itself
            let part = placing.open.remove(0);
            placing.place(&[part], false, leader);
        }
    }
    placing.q
}

struct Placing<'d> {
    kinematics: Kinematics,
    determined: &'d Determined,
    parts: &'d [PartStart],
    t: f64,
    q: Vec<f64>,
    /// By coordinate.
    is_settled: Vec<bool>,
    /// By coordinate.
    is_of_an_open_part: Vec<bool>,
    block_of: Vec<usize>,
    /// By part: the coordinates that it follows.
    needs: Vec<Vec<u32>>,
    /// Parts that are not placed yet.
    open: Vec<usize>,
}

impl<'d> Placing<'d> {
    fn new(mut kinematics: Kinematics, determined: &'d Determined, t: f64, q: Vec<f64>) -> Placing<'d> {
        kinematics.set_time(t);
        let system = determined.system();
        let needs = |part: &PartStart| {
            let formulas: Vec<ExprId> = part.inputs.iter().map(|(_, id)| *id).chain(part.mount).collect();
            let symbols = system.graph().symbols_of_all(&formulas).into_iter();
            symbols.filter_map(coordinate).collect::<Vec<u32>>()
        };
        let parts = system.parts();
        let mut is_of_an_open_part = vec![false; q.len()];
        for part in parts {
            is_of_an_open_part[part.poses.clone()].fill(true);
            is_of_an_open_part[part.own.clone()].fill(true);
        }
        Placing {
            kinematics,
            determined,
            parts,
            t,
            is_settled: vec![false; q.len()],
            is_of_an_open_part,
            q,
            block_of: determined.block_of_columns(),
            needs: parts.iter().map(needs).collect(),
            open: (0..parts.len()).collect(),
        }
    }

    fn is_resolved(&self, part: usize) -> bool {
        self.needs[part].iter().all(|&k| self.is_settled[k as usize])
    }

    fn value(&self, id: ExprId) -> f64 {
        let system = self.determined.system();
        system.graph().value(id, |symbol| match symbol {
            Symbol::Param(k) => system.params()[k as usize].value,
            Symbol::Time => self.t,
            Symbol::Coordinate { index, order: 0 } => self.q[index as usize],
            _ => f64::NAN,
        })
    }

    /// Places parts that were solved alone on their mounts.
    fn place(&mut self, parts: &[usize], are_continued: bool, leader: &mut Leader<'_>) {
        let mounts: Vec<[f64; 3]> = parts.iter().map(|&part| self.parts[part].mount.map(|id| self.value(id))).collect();
        let request = |(&part, mount): (&usize, &[f64; 3])| {
            let inputs: Vec<f64> = self.parts[part].inputs.iter().map(|(_, id)| self.value(*id)).collect();
            let is_whole = inputs.iter().chain(mount).all(|value| value.is_finite());
            Request { part, inputs: Some(inputs).filter(|_| are_continued && is_whole) }
        };
        let requests: Vec<Request> = parts.iter().zip(&mounts).map(request).collect();
        for ((&part, mount), alone) in parts.iter().zip(&mounts).zip(leader(&requests)) {
            self.set_on_its_mount(part, *mount, alone);
        }
    }

    fn set_on_its_mount(&mut self, part: usize, [x, y, phi]: [f64; 3], alone: Option<Vec<f64>>) {
        let start = &self.parts[part];
        let (poses, local) = (start.poses.clone(), start.own.clone());
        poses.clone().chain(local.clone()).for_each(|column| self.is_of_an_open_part[column] = false);
        let is_whole = [x, y, phi].iter().all(|value| value.is_finite());
        let Some(alone) = alone.filter(|q| q.len() == poses.len() + local.len() && is_whole) else {
            return;
        };
        let (sin, cos) = math::sin_cos(phi);
        let side = if start.is_mirrored { -1.0 } else { 1.0 };
        for &body in &start.bodies {
            let pose = self.determined.system().pose_of(body);
            let [along, across, turn] = pose.map(|column| alone[column - poses.start]);
            let across = side * across;
            let placed = [x + along * cos - across * sin, y + along * sin + across * cos, phi + side * turn];
            pose.into_iter().zip(placed).for_each(|(column, value)| self.q[column] = value);
        }
        self.q[local.clone()].copy_from_slice(&alone[poses.len()..]);
        self.is_settled[poses].fill(true);
        self.is_settled[local].fill(true);
    }

    /// Solves blocks that parts need, each once those before it are settled; returns whether it solved any.
    fn solve_what_is_needed(&mut self) -> bool {
        let mut required: Vec<u32> = self.open.iter().flat_map(|&part| self.needs[part].iter().copied()).collect();
        let mut numbers: Vec<usize> = Vec::new();
        let mut is_needed = vec![false; self.determined.blocks().len()];
        while let Some(column) = required.pop() {
            let number = self.block_of[column as usize];
            if self.is_settled[column as usize] || std::mem::replace(&mut is_needed[number], true) {
                continue;
            }
            numbers.push(number);
            required.extend(self.behind(&self.determined.blocks()[number]));
        }
        numbers.sort_unstable();
        let mut was_solved = false;
        for number in numbers {
            let block = &self.determined.blocks()[number];
            let holds_open_part = block.columns.iter().any(|&column| self.is_of_an_open_part[column as usize]);
            let is_ready = self.behind(block).all(|column| self.is_settled[column as usize]);
            if is_ready && !holds_open_part && block.columns.len() <= LARGEST_DENSE {
                levenberg_marquardt(&mut self.kinematics, &mut self.q, &block.rows, &block.columns);
                block.columns.iter().for_each(|&column| self.is_settled[column as usize] = true);
                was_solved = true;
            }
        }
        was_solved
    }

    /// Returns the coordinates of other blocks that the equations of a block hold.
    fn behind(&self, block: &'d Block) -> impl Iterator<Item = u32> + use<'d> {
        let system = self.determined.system();
        let columns = &block.columns;
        let of_row = move |&row: &'d u32| system.phi_q().row(row as usize).iter().map(|&(column, _)| column);
        block.rows.iter().flat_map(of_row).filter(move |column| !columns.contains(column))
    }
}

fn coordinate(symbol: Symbol) -> Option<u32> {
    match symbol {
        Symbol::Coordinate { index, .. } => Some(index),
        _ => None,
    }
}
