//! Generates the instructions that solve a system, component by component and block by block.

use super::components::{ComponentOutputs, Partition};
use super::elimination::{Factors, Line};
use super::optimize::optimize;
use super::order::{BlockEntry, Order};
use super::symbolic_values::SymbolicValues;
use super::tape::Value;
use super::tear::{Tearing, tear};
use super::{Component, Instruction, MOST_OPERATIONS, PROLOGUE, Pivot, Purpose, Segment, Solver, Tear, Turn, Values};
use crate::limits::solver::CELL;
use mechc_expr::Symbol;
use mechc_expr::math::power_of_two_below;
use mechc_ir::ConstraintSystem;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::{Program, Register};
use mechc_ir::structure::{Block, Determined};
use rustc_hash::FxHashSet;

/// Returns the width of a grid cell for a coordinate (m or rad) with this scale.
pub(super) fn cell(scale: f64) -> f64 {
    CELL * power_of_two_below(scale)
}

/// Generates a solver for a purpose, which stores the columns for which `is_kept` holds. Returns `None` if that takes more than [`MOST_OPERATIONS`].
pub(super) fn build(
    determined: &Determined,
    program: &Program,
    reference: &impl Values,
    purpose: Purpose,
    is_kept: &dyn Fn(u32) -> bool,
) -> Option<Solver> {
    let system = determined.system();
    let partition = Partition::new(determined);
    let outputs = partition.outputs_by_component(system, !program.outputs.reactions.is_empty());
    let shared = partition.blocks.len();
    let mut builder = Builder::new(determined, program, reference, &partition, purpose);
    builder.shared_columns = shared_columns(system, &builder.layout, &outputs[shared]);
    let mut all = Component::default();
    for (component, blocks) in partition.blocks.iter().enumerate() {
        builder.symbolic.begin_component();
        let blocks = blocks.iter().map(|&block| &determined.blocks()[block]);
        let solved: Vec<(&Block, Factors)> = blocks.map(|block| (block, builder.block(block))).collect();
        builder.solve_multipliers(&solved);
        builder.store_outputs(&outputs[component]);
        all.append(builder.finish_component(is_kept), purpose);
        if all.instructions.len() > MOST_OPERATIONS {
            return None;
        }
    }
    builder.symbolic.begin_shared_outputs();
    builder.store_outputs(&outputs[shared]);
    all.append(builder.finish_component(is_kept), purpose);
    let Builder { weights, tears, pivots, turns, layout, .. } = builder;
    let monitors = if purpose == Purpose::Variants { system.monitors().len() } else { 0 };
    let (prologue_len, all) = (all.prologue.len(), all.with_prologue_first());
    let Component { instructions, segments, registers, .. } = all;
    Some(Solver { instructions, prologue_len, segments, registers, weights, tears, pivots, turns, monitors, layout })
}

impl Component {
    /// Appends another component. In lanes, components reuse the same registers; in code, every value has its own.
    fn append(&mut self, other: Component, purpose: Purpose) {
        let from = self.instructions.len();
        let segments = other.segments.into_iter().map(|segment| segment.shifted(from));
        match purpose {
            Purpose::Lanes => {
                self.instructions.extend(other.instructions);
                self.segments.extend(segments);
                self.registers = self.registers.max(other.registers);
            }
            Purpose::Variants => {
                let used = self.prologue_registers as Register;
                let new_register = |register: Register| if register < PROLOGUE { register } else { register + used };
                self.prologue
                    .extend(other.prologue.into_iter().map(|each| each.renumbered(new_register, new_register)));
                self.instructions
                    .extend(other.instructions.into_iter().map(|each| each.renumbered(new_register, new_register)));
                self.segments.extend(segments.map(|segment| segment.renumbered(new_register)));
                self.registers = self.registers.max(other.registers);
                self.prologue_registers += other.prologue_registers;
            }
            Purpose::Code => {
                let used = self.registers as Register;
                let new_register = |register: Register| register + used;
                self.instructions
                    .extend(other.instructions.into_iter().map(|each| each.renumbered(new_register, new_register)));
                self.segments.extend(segments.map(|segment| segment.renumbered(new_register)));
                self.registers += other.registers;
            }
        }
    }

    /// Puts the prologue first, with the first registers.
    fn with_prologue_first(self) -> Component {
        // without a prologue nothing needs new registers, and there may be millions of instructions
        if self.prologue.is_empty() {
            return self;
        }
        let shift = self.prologue_registers as Register;
        let new_register =
            |register: Register| if register < PROLOGUE { register + shift } else { register - PROLOGUE };
        let (prologue_len, prologue_registers) = (self.prologue.len(), self.prologue_registers);
        let all = self.prologue.into_iter().chain(self.instructions);
        Component {
            instructions: all.map(|each| each.renumbered(new_register, new_register)).collect(),
            segments: self
                .segments
                .into_iter()
                .map(|segment| segment.renumbered(new_register).shifted(prologue_len))
                .collect(),
            registers: self.registers + prologue_registers,
            ..Component::default()
        }
    }
}

/// Returns the columns, other than positions, velocities and accelerations, that shared outputs read: third derivatives, variations, multipliers.
fn shared_columns(system: &ConstraintSystem, layout: &RowLayout, outputs: &ComponentOutputs) -> FxHashSet<u32> {
    let column = |symbol| match symbol {
        Symbol::Coordinate { index, order: 3 } => Some(layout.coordinate(index, 3)),
        Symbol::Varied { index, order, variation } => Some(layout.varied(variation, u32::from(order), index)),
        Symbol::Multiplier(row) => Some(layout.multiplier(row)),
        Symbol::VariedMultiplier { row, variation } => Some(layout.varied_multiplier(variation, row)),
        _ => None,
    };
    system.graph().symbols_of_all(&outputs.formulas(system)).into_iter().filter_map(column).collect()
}

/// A solver under construction.
pub(super) struct Builder<'s, V> {
    system: &'s ConstraintSystem,
    pub(super) program: &'s Program,
    reference: &'s V,
    partition: &'s Partition,
    purpose: Purpose,
    pub(super) layout: RowLayout,
    pub(super) symbolic: SymbolicValues<'s>,
    /// By column of `Φ_q`: its index within its block.
    index_in_block: Vec<u32>,
    /// By measure: the number of measures before it that have a first and a second derivative.
    measures_before: Vec<[u32; 2]>,
    segments: Vec<Segment>,
    weights: Vec<f64>,
    tears: Vec<u32>,
    /// The columns of third derivatives, variations and multipliers that shared outputs read.
    shared_columns: FxHashSet<u32>,
    pivots: Vec<Pivot>,
    turns: Vec<Turn>,
}

impl<'s, V: Values> Builder<'s, V> {
    fn new(
        determined: &'s Determined,
        program: &'s Program,
        reference: &'s V,
        partition: &'s Partition,
        purpose: Purpose,
    ) -> Builder<'s, V> {
        let (system, layout) = (determined.system(), RowLayout::new(determined.system()));
        let mut index_in_block = vec![0; system.coordinates().len()];
        for block in determined.blocks() {
            for (index, &column) in block.columns.iter().enumerate() {
                index_in_block[column as usize] = index as u32;
            }
        }
        let before = system.measures().iter().scan([0; 2], |counts, measure| {
            let before = *counts;
            counts[0] += u32::from(measure.first.is_some());
            counts[1] += u32::from(measure.second.is_some());
            Some(before)
        });
        Builder {
            system,
            program,
            reference,
            partition,
            purpose,
            layout,
            symbolic: SymbolicValues::new(system, program, layout, purpose != Purpose::Code),
            index_in_block,
            measures_before: before.collect(),
            segments: Vec::new(),
            weights: Vec::new(),
            tears: Vec::new(),
            shared_columns: FxHashSet::default(),
            pivots: Vec::new(),
            turns: Vec::new(),
        }
    }

    /// Ends a component and optimizes it; it stores the columns for which `is_kept` holds.
    fn finish_component(&mut self, is_kept: &dyn Fn(u32) -> bool) -> Component {
        self.close_once();
        let tape = &mut self.symbolic.tape;
        let instructions = std::mem::take(&mut tape.instructions);
        let component = Component {
            instructions,
            segments: std::mem::take(&mut self.segments),
            registers: tape.registers(),
            ..Component::default()
        };
        let is_live = |instruction: &Instruction| match *instruction {
            Instruction::Store { column, .. } => is_kept(column),
            Instruction::Multiplier { .. } => self.purpose == Purpose::Variants,
            _ => instruction.writes().is_empty(),
        };
        optimize(component, is_live, self.purpose)
    }

    /// Ends a segment of instructions that run once.
    fn close_once(&mut self) {
        let from = self.segments.last().map_or(0, |segment| segment.range().end);
        self.segments.push(Segment::Once(from..self.symbolic.tape.instructions.len()));
    }

    /// Solves a block for position and derivatives; returns its factors.
    fn block(&mut self, block: &Block) -> Factors {
        let factors = if block.explicit { self.explicit(block) } else { self.implicit(block) };
        for &column in &block.columns {
            self.store(0, column);
        }
        if self.purpose != Purpose::Lanes {
            self.emit_pivots(block, &factors);
        }
        self.solve_derivatives(block, &factors);
        self.symbolic.end_block();
        factors
    }

    /// Emits the variable pivots of a block. The constant pivots and the order of elimination determine the sign of the determinant at positive
    /// pivots.
    fn emit_pivots(&mut self, block: &Block, factors: &Factors) {
        let turn = self.turns.len() as u32;
        let mut is_negative = factors.is_odd();
        let before = self.pivots.len();
        for inverse in factors.inverses() {
            match inverse.value {
                Value::Number(x) => is_negative ^= x < 0.0,
                Value::Register { at, negative } => {
                    is_negative ^= negative;
                    let weight =
                        inverse.positions.iter().map(|&(row, column)| self.weight(block, row, column)).product();
                    let pivot = self.pivots.len() as u32;
                    self.pivots.push(Pivot { turn, weight });
                    self.symbolic.tape.emit(Instruction::Pivot { a: at, pivot });
                }
            }
        }
        if self.pivots.len() > before {
            let block = self.partition.block_of_column[block.columns[0] as usize] as u32;
            self.turns.push(Turn { block, is_negative });
        }
    }

    /// Returns the scale that makes an inverse pivot dimensionless.
    fn weight(&self, block: &Block, row: u32, column: u32) -> f64 {
        let scale = self.system.coordinates()[block.columns[column as usize] as usize].scale;
        self.reference.row_norm(block.rows[row as usize] as usize) / scale
    }

    /// Solves one equation that is linear in its coordinate.
    fn explicit(&mut self, block: &Block) -> Factors {
        let (row, column) = (block.rows[0] as usize, block.columns[0]);
        let slope = self.block_rows(block)[0][0].1;
        let rest = self.symbolic.value_without(self.program.outputs.phi[row], self.coordinate(0, column));
        let value = self.symbolic.tape.div(rest.negated(), slope);
        self.symbolic.tape.mark_finite(value);
        self.symbolic.define(self.coordinate(0, column), value);
        Factors::single(&mut self.symbolic.tape, slope)
    }

    /// Solves equations by iterating on the tears; the other coordinates are assigned from these.
    fn implicit(&mut self, block: &Block) -> Factors {
        let pattern: Vec<Vec<(u32, bool)>> = block.rows.iter().map(|&row| self.assignable(block, row)).collect();
        let tearing = tear(&pattern);
        let order = self.order(block);
        self.newton(block, &tearing, &order);
        // at the solution
        self.assign(block, &tearing.assigned);
        for &row in &tearing.residuals {
            let row = block.rows[row as usize];
            let value = self.symbolic.value(self.program.outputs.phi[row as usize]);
            let a = self.symbolic.tape.register(value);
            self.symbolic.tape.emit(Instruction::Residual { a, row });
        }
        self.eliminate(block, &order)
    }

    /// Emits the Newton loop for the tears of a block.
    fn newton(&mut self, block: &Block, tearing: &Tearing, order: &Order) {
        self.symbolic.enter_loop();
        let guesses: Vec<Register> =
            tearing.tears.iter().map(|&tear| self.new_tear(block.columns[tear as usize])).collect();
        self.assign(block, &tearing.assigned);
        let rows = self.block_rows(block);
        let factors = Factors::new(&mut self.symbolic.tape, rows, order, None::<fn(u32, u32) -> u32>);
        let mut right = vec![Value::ZERO; block.rows.len()];
        for &row in &tearing.residuals {
            let phi = self.program.outputs.phi[block.rows[row as usize] as usize];
            right[row as usize] = self.symbolic.value(phi).negated();
        }
        let corrections = factors.solve(&mut self.symbolic.tape, right);
        let mut tears = Vec::with_capacity(guesses.len());
        for (&index, &x) in tearing.tears.iter().zip(&guesses) {
            let scale = self.system.coordinates()[block.columns[index as usize] as usize].scale;
            let delta = self.symbolic.tape.register(corrections[index as usize]);
            tears.push(Tear::new(x, delta, scale));
        }
        self.symbolic.leave_loop(&tears);
        self.close_once();
        let instructions = self.symbolic.tape.close_loop();
        self.segments.push(Segment::Newton { instructions, tears });
        for (&index, &at) in tearing.tears.iter().zip(&guesses) {
            let register = self.coordinate(0, block.columns[index as usize]);
            self.symbolic.define(register, Value::Register { at, negative: false });
        }
    }

    /// Returns the entries of a row within its block: column, and whether the row can be solved for it without losing digits, that is, its slope is a
    /// number, and no other number in the row is larger.
    fn assignable(&self, block: &Block, row: u32) -> Vec<(u32, bool)> {
        let slope = |at: usize| self.symbolic.number(self.program.outputs.phi_q[at]).map_or(0.0, f64::abs);
        let entries = || self.entries_inside(block, row);
        let largest = entries().map(|(_, at)| slope(at)).fold(0.0, f64::max);
        entries().map(|(index, at)| (index, slope(at) > 0.0 && slope(at) >= largest)).collect()
    }

    /// Adds a coordinate that Newton solves for; returns its register.
    fn new_tear(&mut self, column: u32) -> Register {
        let tear = self.tears.len() as u32;
        self.tears.push(column);
        let at = self.symbolic.new_tear(tear);
        self.symbolic.define(self.coordinate(0, column), Value::Register { at, negative: false });
        at
    }

    /// Solves rows, one by one, for the coordinates assigned to them.
    fn assign(&mut self, block: &Block, assigned: &[(u32, u32)]) {
        for &(row, index) in assigned {
            let (row, column) = (block.rows[row as usize], block.columns[index as usize]);
            let register = self.coordinate(0, column);
            if self.symbolic.is_defined(register) {
                continue;
            }
            let slope = self.entries_inside(block, row).find(|(other, _)| *other == index).map(|(_, at)| at);
            let slope = slope.map_or(Value::Number(1.0), |at| self.symbolic.value(self.program.outputs.phi_q[at]));
            let rest = self.symbolic.value_without(self.program.outputs.phi[row as usize], register);
            let value = self.symbolic.tape.div(rest.negated(), slope);
            self.symbolic.tape.mark_finite(value);
            self.symbolic.define(register, value);
        }
    }

    /// Stores the requested outputs of a component: reactions, measures and appended columns; for variants emits its monitors.
    fn store_outputs(&mut self, requested: &ComponentOutputs) {
        let outputs = &self.program.outputs;
        if self.is_for_variants() {
            for &k in &requested.monitors {
                let value = self.symbolic.value(outputs.watches[k]);
                let a = self.symbolic.tape.register(value);
                self.symbolic.tape.emit(Instruction::Monitor { a, monitor: k as u32 });
            }
        }
        for &k in &requested.reactions {
            let value = self.symbolic.value(outputs.reactions[k]);
            self.symbolic.tape.store(self.layout.reactions + k as u32, value);
        }
        for &k in &requested.measures {
            let (measure, [first, second]) = (&self.system.measures()[k], self.measures_before[k]);
            let lists = [
                Some((&outputs.measures, k as u32)),
                measure.first.map(|_| (&outputs.measures_d, first)),
                measure.second.map(|_| (&outputs.measures_dd, second)),
            ];
            for (column, list) in self.layout.measures.into_iter().zip(lists) {
                let Some((list, at)) = list else {
                    continue;
                };
                let value = self.symbolic.value(list[at as usize]);
                self.symbolic.tape.store(column + at, value);
            }
        }
        for &k in &requested.appended {
            let value = self.symbolic.value(outputs.appended[k]);
            self.symbolic.tape.store(self.layout.appended + k as u32, value);
        }
    }

    /// Stores a coordinate, or a derivative of it, in its column.
    fn store(&mut self, order: usize, column: u32) {
        let value = self.symbolic.value(self.coordinate(order, column));
        self.symbolic.tape.store(self.layout.coordinates[order] + column, value);
    }

    /// Returns the order of elimination of a block.
    fn order(&self, block: &Block) -> Order {
        let mut entries = Vec::new();
        for (row, &number) in block.rows.iter().enumerate() {
            for (column, at) in self.entries_inside(block, number) {
                let is_number = self.symbolic.number(self.program.outputs.phi_q[at]).is_some_and(|value| value != 0.0);
                entries.push(BlockEntry { row: row as u32, column, value: self.reference.entry(at), is_number });
            }
        }
        Order::new(block.rows.len(), &entries)
    }

    /// Eliminates a block of `Φ_q` in an order; the multipliers are checked.
    fn eliminate(&mut self, block: &Block, order: &Order) -> Factors {
        let rows = self.block_rows(block);
        let (weights, reference) = (&mut self.weights, self.reference);
        let norm = |row: u32| reference.row_norm(block.rows[row as usize] as usize);
        let weight = |row: u32, other: u32| {
            weights.push(norm(row) / norm(other));
            (weights.len() - 1) as u32
        };
        Factors::new(&mut self.symbolic.tape, rows, order, Some(weight))
    }

    /// Returns the rows of a block, restricted to its columns.
    fn block_rows(&mut self, block: &Block) -> Vec<Line> {
        let mut rows = Vec::with_capacity(block.rows.len());
        for &row in &block.rows {
            let indices: Vec<(u32, usize)> = self.entries_inside(block, row).collect();
            let phi_q = &self.program.outputs.phi_q;
            rows.push(indices.into_iter().map(|(index, at)| (index, self.symbolic.value(phi_q[at]))).collect());
        }
        rows
    }

    /// Returns the entries of a row within its block: column in the block, and position in the pattern.
    fn entries_inside(&self, block: &Block, row: u32) -> impl Iterator<Item = (u32, usize)> + use<'s, '_, V> {
        let this = self.partition.block_of_column[block.columns[0] as usize];
        let pattern = self.system.phi_q();
        let entries = pattern.range(row as usize).zip(pattern.row(row as usize));
        entries
            .filter(move |(_, (column, _))| self.partition.block_of_column[*column as usize] == this)
            .map(|(at, &(column, _))| (self.index_in_block[column as usize], at))
    }

    /// Returns the entries of a row outside its block, in blocks before it: position in the pattern, and column.
    pub(super) fn entries_outside(&self, block: &Block, row: u32) -> Vec<(usize, u32)> {
        let this = self.partition.block_of_column[block.columns[0] as usize];
        let pattern = self.system.phi_q();
        let entries = pattern.range(row as usize).zip(pattern.row(row as usize));
        entries
            .filter(|(_, (column, _))| self.partition.block_of_column[*column as usize] != this)
            .map(|(at, &(column, _))| (at, column))
            .collect()
    }

    /// Returns the program's register of a derivative of a coordinate.
    fn coordinate(&self, order: usize, column: u32) -> Register {
        self.program.inputs.coordinates[order] + column
    }

    /// Returns whether shared outputs read a column. In code only these third derivatives and variations are stored.
    pub(super) fn is_shared(&self, column: u32) -> bool {
        self.shared_columns.contains(&column)
    }

    pub(super) fn is_for_variants(&self) -> bool {
        self.purpose == Purpose::Variants
    }

    pub(super) fn is_for_code(&self) -> bool {
        self.purpose == Purpose::Code
    }
}
