//! The linear systems of one state: `Φ_q x = b`, block by block.
//!
//! Everything is scaled: lengths by the size of their body, rows to unit norm; nearness to a singular position is judged
//! by other scales (`equilibration`). Within a block the order of elimination is
//! fixed (`sparse`); where that loses digits a small block is factored densely with partial pivoting, and a large one gets
//! another order. Between blocks the solution is substituted forward, so that cost grows with the number of blocks.

/// Number of coordinates of a block that is no chain yet.
const A_FEW: f64 = 24.0;

/// The factors, borrowed separately from the workspace.
macro_rules! factors {
    ($lu:expr) => {
        Factors {
            values: &$lu.values,
            inside: &$lu.inside,
            dense: &$lu.dense,
            pivots: &$lu.pivots,
            rows: &$lu.rows,
            columns: &$lu.columns,
            row_norm: &$lu.row_norm,
            size: &$lu.column_scale,
            equilibration: &$lu.equilibration,
            is_judging: $lu.equilibration.is_measured(),
        }
    };
}

mod factor;
mod factors;
mod nearness;
mod solve;

use super::determinant::Determinant;
use super::equilibration::Equilibration;
use super::sparse::Plan;
use crate::limits::solver::LARGEST_BLOCK;
use factors::Factors;
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_ir::structure::Block;
use mechc_ir::{ConstraintSystem, CoordinateKind};
pub use nearness::Singular;
use std::ops::Range;

/// Irreducible block with its position in the common storage.
#[derive(Clone)]
struct Part {
    /// Offset of its rows and columns in the lists below.
    at: usize,
    size: usize,
    explicit: bool,
    /// Offset of its dense matrix, which a large block does not have.
    matrix: usize,
    /// Its entries in `inside`.
    inside: Range<usize>,
    /// Smallest pivot as nearness is judged.
    smallest_pivot: f64,
    /// Orders of elimination.
    plans: Vec<Plan>,
    /// The values of the order that is in use.
    slots: Vec<f64>,
    form: Form,
}

/// Method by which a block is factored.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    /// A single equation.
    Single,
    /// By one of its orders.
    Planned(usize),
    Dense,
}

impl Part {
    /// Returns a block whose rows and columns begin at `at`, and its dense matrix at `matrix`.
    fn new(block: &Block, at: usize, matrix: usize) -> Part {
        let size = block.rows.len();
        Part {
            at,
            size,
            explicit: block.explicit,
            matrix,
            inside: 0..0,
            smallest_pivot: 0.0,
            plans: Vec::new(),
            slots: Vec::new(),
            form: if size == 1 { Form::Single } else { Form::Dense },
        }
    }

    /// Returns how much smaller the singular values of a chain of so many coordinates are than those of a few bodies.
    fn length_of_chain(&self) -> f64 {
        let length = self.size as f64 / A_FEW;
        f64::max(length * length, 1.0)
    }

    fn is_small(&self) -> bool {
        self.size <= LARGEST_BLOCK
    }
}

/// An entry of `Φ_q`: its position in the pattern, and where it goes.
#[derive(Clone, Copy)]
struct Entry {
    position: u32,
    column: u32,
    /// Row and column within its block; `None` if it is outside.
    place: Option<(u32, u32)>,
}

/// The entries of `Φ_q` by row in block order, and which of them are within their blocks.
struct Pattern {
    starts: Vec<usize>,
    entries: Vec<Entry>,
    inside: Vec<u32>,
}

impl Pattern {
    /// Returns the pattern of some blocks, and records in each the range of its entries; `place_of` gives the block and place of a column.
    fn new(
        system: &ConstraintSystem,
        parts: &mut [Part],
        rows: &[u32],
        place_of: impl Fn(usize) -> (u32, u32),
    ) -> Pattern {
        let (mut starts, mut entries, mut inside) = (vec![0], Vec::new(), Vec::new());
        for (k, part) in parts.iter_mut().enumerate() {
            part.inside.start = inside.len();
            for (place, &row) in rows[part.at..part.at + part.size].iter().enumerate() {
                let row = row as usize;
                for (position, &(column, _)) in system.phi_q().range(row).zip(system.phi_q().row(row)) {
                    let (block, column_place) = place_of(column as usize);
                    let is_inside = block == k as u32;
                    if is_inside {
                        inside.push(entries.len() as u32);
                    }
                    let place = is_inside.then_some((place as u32, column_place));
                    entries.push(Entry { position: position as u32, column, place });
                }
                starts.push(entries.len());
            }
            part.inside.end = inside.len();
        }
        Pattern { starts, entries, inside }
    }
}

/// The factors of `Φ_q`, and the workspace to compute and use them.
#[derive(Clone)]
pub struct BlockLu {
    parts: Vec<Part>,
    /// Rows of Φ in block order.
    rows: Vec<u32>,
    /// Coordinates in block order.
    columns: Vec<u32>,
    /// Entries by row in block order: `starts[k]..starts[k + 1]`.
    starts: Vec<usize>,
    entries: Vec<Entry>,
    /// Scale of each coordinate: the size of its body, or 1 rad.
    column_scale: Vec<f64>,
    /// Coordinates that a step is judged by, and those of them that need iteration.
    judged: Vec<u32>,
    judged_implicit: Vec<u32>,
    /// Divisor of each scaled row: its norm, or the least norm if that is larger.
    row_norm: Vec<f64>,
    /// By row; 0 if only the norm counts.
    least_norm: Vec<f64>,
    /// Scaled values of the entries.
    values: Vec<f64>,
    /// Indices of the entries within their blocks, block by block.
    inside: Vec<u32>,
    dense: Vec<f64>,
    pivots: Vec<u32>,
    work: Vec<f64>,
    /// Scales by which nearness to a singular position is judged.
    equilibration: Equilibration,
}

/// Outcome of a factorisation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Factored {
    Regular,
    /// A pivot or a whole row vanishes.
    Singular,
}

impl BlockLu {
    pub fn new(system: &ConstraintSystem, blocks: &[Block]) -> BlockLu {
        let n = system.coordinates().len();
        let mut place_of_column = vec![0_u32; n];
        let mut part_of_column = vec![0_u32; n];
        let (mut parts, mut rows, mut columns) = (Vec::new(), Vec::new(), Vec::new());
        let mut matrix = 0;
        for (k, block) in blocks.iter().enumerate() {
            let part = Part::new(block, rows.len(), matrix);
            for (place, &column) in block.columns.iter().enumerate() {
                place_of_column[column as usize] = place as u32;
                part_of_column[column as usize] = k as u32;
            }
            rows.extend_from_slice(&block.rows);
            columns.extend_from_slice(&block.columns);
            matrix += if part.is_small() { part.size * part.size } else { 0 };
            parts.push(part);
        }
        let Pattern { starts, entries, inside } =
            Pattern::new(system, &mut parts, &rows, |column| (part_of_column[column], place_of_column[column]));
        let column_scale = system.coordinates().iter().map(|coordinate| coordinate.scale).collect();
        let judged = judged_coordinates(system);
        let is_implicit = |column: &u32| !parts[part_of_column[*column as usize] as usize].explicit;
        let judged_implicit = judged.iter().copied().filter(is_implicit).collect();
        BlockLu {
            parts,
            rows,
            columns,
            starts,
            values: vec![0.0; entries.len()],
            inside,
            entries,
            column_scale,
            judged,
            judged_implicit,
            row_norm: vec![1.0; n],
            least_norm: vec![0.0; n],
            dense: vec![0.0; matrix],
            pivots: vec![0; n],
            work: vec![0.0; 3 * n],
            equilibration: Equilibration::new(system, blocks),
        }
    }

    /// Returns the scales by which nearness to a singular position is judged.
    pub fn equilibration(&mut self) -> &mut Equilibration {
        &mut self.equilibration
    }

    pub fn column_scale(&self, column: usize) -> f64 {
        self.column_scale[column]
    }

    /// Sets the least divisor of a row, so that a formula whose slope vanishes is noticed.
    pub fn set_least_norm(&mut self, row: usize, norm: f64) {
        self.least_norm[row] = norm;
    }

    /// Returns the least norm of a row; 0 if none was set.
    pub fn least_norm(&self, row: usize) -> f64 {
        self.least_norm[row]
    }

    /// Returns a row whose slope, scaled, was less than `least` where `Φ_q` was factored.
    pub fn row_without_slope(&self, least: f64) -> Option<usize> {
        let slope =
            |k: usize| self.values[self.starts[k]..self.starts[k + 1]].iter().map(|x| x * x).sum::<f64>().sqrt();
        (0..self.rows.len()).find(|&k| slope(k) < least).map(|k| self.rows[k] as usize)
    }

    /// Returns the divisor of a row of the scaled `Φ_q`, mostly its norm.
    pub fn row_norm(&self, row: usize) -> f64 {
        self.row_norm[row]
    }

    /// Writes each block's determinant.
    pub fn determinants(&self, determinants: &mut [Determinant]) {
        for (block, determinant) in determinants.iter_mut().enumerate() {
            *determinant = self.determinant(block);
        }
    }

    /// Returns the determinant of a block. The matching fixes the order of columns, so that a sign means the same at every state.
    pub fn determinant(&self, block: usize) -> Determinant {
        let part = &self.parts[block];
        let mut determinant = Determinant::ONE;
        match part.form {
            Form::Single => determinant.multiply(self.values[self.inside[part.inside.start] as usize]),
            Form::Planned(plan) => {
                part.plans[plan].signed_pivots(&part.slots).for_each(|pivot| determinant.multiply(pivot));
            }
            Form::Dense => {
                for (k, &swapped) in self.pivots[part.at..part.at + part.size].iter().enumerate() {
                    let pivot = self.dense[part.matrix + k * (part.size + 1)];
                    determinant.multiply(if swapped as usize == k { pivot } else { -pivot });
                }
            }
        }
        determinant
    }

    /// Returns the smallest pivot of all blocks: little more than the nearness to a singular position, and without cost.
    pub fn smallest_pivot(&self) -> f64 {
        self.parts.iter().map(|part| part.smallest_pivot).fold(1.0, f64::min)
    }

    /// Returns the block with the smallest pivot.
    pub fn worst_block(&self) -> Option<usize> {
        let pivot = |k: usize| self.parts[k].smallest_pivot;
        (0..self.parts.len()).min_by(|&a, &b| pivot(a).total_cmp(&pivot(b)))
    }

    /// Returns whether all coordinates follow without iteration.
    pub fn is_explicit(&self) -> bool {
        self.parts.iter().all(|part| part.explicit)
    }

    pub fn blocks(&self) -> usize {
        self.parts.len()
    }

    fn factors(&self) -> Factors<'_> {
        factors!(self)
    }
}

/// Returns the coordinates that a step is judged by: those that `Φ_q` depends on, those that an equation of time speaks of, and all angles.
/// The places that are left follow from these, however far they go.
fn judged_coordinates(system: &ConstraintSystem) -> Vec<u32> {
    let slopes: Vec<ExprId> = system.phi_q().entries().iter().map(|&(_, slope)| slope).collect();
    let mut is_judged: Vec<bool> = system.coordinates().iter().map(|c| c.kind != CoordinateKind::Length).collect();
    for symbol in system.graph().symbols_of_all(&slopes) {
        if let Symbol::Coordinate { index, .. } = symbol {
            is_judged[index as usize] = true;
        }
    }
    for (k, row) in system.rows().iter().enumerate() {
        if system.graph().dependence(row.phi).on(Dependence::TIME) {
            system.phi_q().row(k).iter().for_each(|&(column, _)| is_judged[column as usize] = true);
        }
    }
    (0..is_judged.len() as u32).filter(|&column| is_judged[column as usize]).collect()
}
