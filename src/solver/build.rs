//! Laying the solution of a system out, component by component and block by block.

use super::finish::finish;
use super::order::{BlockEntry, Order};
use super::tape::{Op, Tape, Value};
use super::tear::tear;
use super::{Component, MOST_OPERATIONS, Pivot, Segment, Solver, Tear, Turn, Values};
use crate::expr::{ExprId, Symbol};
use crate::ir::ConstraintSystem;
use crate::layout::RowLayout;
use crate::math;
use crate::program::{self, Program, Register, Stage};
use crate::structure::{Block, Determined};
use crate::tolerances::solving::build::{CELL, WIDEST_CELL};

use rustc_hash::{FxHashMap, FxHashSet};

/// The width of a cell of a coordinate's grid, by what the coordinate is judged against.
pub(super) fn cell(scale: f64) -> f64 {
    CELL * power_of_two_below(scale)
}

pub(super) fn build(
    determined: &Determined,
    program: &Program,
    values: &impl Values,
    notes_pivots: bool,
) -> Option<Solver> {
    let system = determined.system();
    let groups = Groups::new(determined);
    let (measures, appended) = (groups.measures(system), groups.appended(system));
    let mut builder = Builder::new(determined, program, values, &groups);
    builder.notes_pivots = notes_pivots;
    builder.joined = joined(system, &builder.layout, &measures[groups.blocks.len()], &appended[groups.blocks.len()]);
    let (mut segments, mut registers, mut operations) = (Vec::new(), 0, Vec::new());
    let mut append = |(component, used): (Component, usize), operations: &mut Vec<Op>| {
        let from = operations.len();
        if notes_pivots {
            // every value has a register of its own
            let own = |register: Register| register + registers as Register;
            operations.extend(component.operations.into_iter().map(|op| op.renumbered(own, own)));
            segments.extend(component.segments.into_iter().map(|segment| segment.behind(from).renumbered(own)));
            registers += used;
        } else {
            operations.extend(component.operations);
            segments.extend(component.segments.into_iter().map(|segment| segment.behind(from)));
            registers = registers.max(used);
        }
    };
    for ((group, measures), appended) in groups.blocks.iter().zip(&measures).zip(&appended) {
        builder.begin();
        for &block in group {
            builder.block(&determined.blocks()[block]);
        }
        builder.measures(measures);
        builder.appended(appended);
        append(builder.finish(), &mut operations);
        if operations.len() > MOST_OPERATIONS {
            return None;
        }
    }
    builder.begin();
    builder.is_across = true;
    builder.measures(&measures[groups.blocks.len()]);
    builder.appended(&appended[groups.blocks.len()]);
    append(builder.finish(), &mut operations);
    let Builder { weights, tears, pivots, turns, layout, .. } = builder;
    Some(Solver { operations, segments, registers, weights, tears, pivots, turns, layout })
}

/// Blocks that depend on each other.
struct Groups {
    /// Each group's blocks, in an order of solution.
    blocks: Vec<Vec<usize>>,
    group_of_column: Vec<usize>,
    block_of_column: Vec<usize>,
}

impl Groups {
    fn new(determined: &Determined) -> Groups {
        let (system, blocks) = (determined.system(), determined.blocks());
        let mut block_of_column = vec![0; system.coordinates.len()];
        for (k, block) in blocks.iter().enumerate() {
            for &column in &block.columns {
                block_of_column[column as usize] = k;
            }
        }
        let mut parent: Vec<usize> = (0..blocks.len()).collect();
        for (k, block) in blocks.iter().enumerate() {
            for &row in &block.rows {
                for &(column, _) in system.phi_q.row(row as usize) {
                    let (a, b) = (root(&mut parent, k), root(&mut parent, block_of_column[column as usize]));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
        let mut number = vec![usize::MAX; blocks.len()];
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for k in 0..blocks.len() {
            let root = root(&mut parent, k);
            if number[root] == usize::MAX {
                number[root] = groups.len();
                groups.push(Vec::new());
            }
            groups[number[root]].push(k);
        }
        let group_of_column = block_of_column.iter().map(|&block| number[root(&mut parent, block)]).collect();
        Groups { blocks: groups, group_of_column, block_of_column }
    }

    /// The measures of each group, and behind these the ones that join groups.
    fn measures(&self, system: &ConstraintSystem) -> Vec<Vec<usize>> {
        let mut of_group = vec![Vec::new(); self.blocks.len() + 1];
        for (k, measure) in system.measures.iter().enumerate() {
            let formulas = [Some(measure.value), measure.first, measure.second];
            of_group[self.of(system, formulas.into_iter().flatten())].push(k);
        }
        of_group
    }

    /// The same of the columns of derivatives.
    fn appended(&self, system: &ConstraintSystem) -> Vec<Vec<usize>> {
        let mut of_group = vec![Vec::new(); self.blocks.len() + 1];
        for (k, column) in system.appended().iter().enumerate() {
            of_group[self.of(system, [column.value])].push(k);
        }
        of_group
    }

    /// The group that some formulas speak of; where there are several, the number behind the last one.
    fn of(&self, system: &ConstraintSystem, formulas: impl IntoIterator<Item = ExprId>) -> usize {
        let symbols = formulas.into_iter().flat_map(|id| system.graph.symbols(id));
        let mut groups = symbols.filter_map(|symbol| match symbol {
            Symbol::Coordinate { index, .. } | Symbol::Varied { index, .. } => {
                Some(self.group_of_column[index as usize])
            }
            _ => None,
        });
        let first = groups.next();
        first.filter(|first| groups.all(|group| group == *first)).unwrap_or(self.blocks.len())
    }
}

fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}

/// The columns of what some measures and appended columns need beside accelerations: third derivatives, and variations.
fn joined(system: &ConstraintSystem, layout: &RowLayout, measures: &[usize], appended: &[usize]) -> FxHashSet<u32> {
    let of_measure = |&k: &usize| {
        let measure = &system.measures[k];
        [Some(measure.value), measure.first, measure.second].into_iter().flatten()
    };
    let columns = appended.iter().map(|&k| system.appended()[k].value);
    let formulas: Vec<ExprId> = measures.iter().flat_map(of_measure).chain(columns).collect();
    let n = system.coordinates.len() as u32;
    let column = |symbol| match symbol {
        Symbol::Coordinate { index, order: 3 } => Some(layout.coordinates[3] + index),
        Symbol::Varied { index, order, variation } => {
            Some(layout.varied + (3 * variation + u32::from(order)) * n + index)
        }
        _ => None,
    };
    system.graph.symbols_of_all(&formulas).into_iter().filter_map(column).collect()
}

struct Builder<'s, V> {
    system: &'s ConstraintSystem,
    program: &'s Program,
    values: &'s V,
    groups: &'s Groups,
    layout: RowLayout,
    /// What each register of the program is written by.
    definitions: Vec<Option<(Stage, program::Op)>>,
    literals: FxHashMap<Register, f64>,
    /// By register of the program: its value, and how old that is.
    known: Vec<(u32, Value)>,
    /// Each column's place in its block.
    place_of_column: Vec<u32>,
    tape: Tape,
    segments: Vec<Segment>,
    weights: Vec<f64>,
    tears: Vec<u32>,
    age: u32,
    is_across: bool,
    /// Columns of the third derivatives and variations that join groups.
    joined: FxHashSet<u32>,
    open: Vec<Register>,
    /// Registers whose values hold for this block alone: they depend on coordinates of later blocks, which cancel in what the
    /// block needs.
    passing: Vec<Register>,
    is_passing: Vec<bool>,
    /// Of the block's tears that have one: sine and cosine at the grid point, and from there on the correction.
    pairs: Vec<Pair>,
    notes_pivots: bool,
    pivots: Vec<Pivot>,
    turns: Vec<Turn>,
}

/// A tear with its sine and cosine where Newton has evaluated them last.
struct Pair {
    x: Register,
    sin: Register,
    cos: Register,
    /// From there to the solution; none while Newton goes on.
    delta: Option<Register>,
}

/// The factors of a block's part of `Φ_q`, by places within the block.
struct Factors {
    pivots: Vec<(u32, u32)>,
    inverses: Vec<Value>,
    /// For each pivot the rows below it with their multipliers, and the rest of its row.
    lower: Vec<Vec<(u32, Value)>>,
    upper: Vec<Vec<(u32, Value)>>,
    /// The last two unknowns, where they are found together.
    pair: Option<TwoByTwo>,
}

/// Two equations for two unknowns, by rows, with one over their determinant (G. Cramer, 1750): one division instead of two, one
/// after the other.
struct TwoByTwo {
    rows: [u32; 2],
    columns: [u32; 2],
    entries: [[Value; 2]; 2],
    inverse: Value,
}

impl<'s, V: Values> Builder<'s, V> {
    fn new(determined: &'s Determined, program: &'s Program, values: &'s V, groups: &'s Groups) -> Builder<'s, V> {
        let system = determined.system();
        let n = system.coordinates.len();
        let mut place_of_column = vec![0; n];
        for block in determined.blocks() {
            for (place, &column) in block.columns.iter().enumerate() {
                place_of_column[column as usize] = place as u32;
            }
        }
        Builder {
            system,
            program,
            values,
            groups,
            layout: RowLayout::new(system),
            definitions: program.definitions(),
            literals: program.constants().iter().copied().collect(),
            known: vec![(0, Value::ZERO); program.registers()],
            place_of_column,
            tape: Tape::new(0),
            segments: Vec::new(),
            weights: Vec::new(),
            tears: Vec::new(),
            age: 0,
            is_across: false,
            joined: FxHashSet::default(),
            open: Vec::new(),
            passing: Vec::new(),
            is_passing: vec![false; program.registers()],
            pairs: Vec::new(),
            notes_pivots: false,
            pivots: Vec::new(),
            turns: Vec::new(),
        }
    }

    /// Begins a component: nothing is known.
    fn begin(&mut self) {
        self.age += 2 + self.age % 2;
        self.tape = Tape::new(self.age);
        self.segments = Vec::new();
    }

    fn finish(&mut self) -> (Component, usize) {
        self.close_once();
        let operations = std::mem::take(&mut self.tape.operations);
        finish(operations, std::mem::take(&mut self.segments), self.tape.registers(), !self.notes_pivots)
    }

    /// Ends a run of operations that are done once.
    fn close_once(&mut self) {
        let from = self.segments.last().map_or(0, |segment| match segment {
            Segment::Once(range) | Segment::Newton { operations: range, .. } => range.end,
        });
        self.segments.push(Segment::Once(from..self.tape.operations.len()));
    }

    fn block(&mut self, block: &Block) {
        let factors = if block.explicit { self.explicit(block) } else { self.implicit(block) };
        for &column in &block.columns {
            self.store(0, column);
        }
        if self.notes_pivots {
            self.note_pivots(block, &factors);
        }
        self.derivatives(block, &factors);
        self.pairs.clear();
        for register in std::mem::take(&mut self.passing) {
            self.is_passing[register as usize] = false;
            self.known[register as usize] = (0, Value::ZERO);
        }
    }

    /// Notes the pivots of a block that are no numbers, with what the others and their order make of the determinant's sign.
    fn note_pivots(&mut self, block: &Block, factors: &Factors) {
        let turn = self.turns.len() as u32;
        let mut is_negative = is_odd(&factors.pivots);
        let before = self.pivots.len();
        let weight = |builder: &Self, row: u32, column: u32| {
            let scale = builder.system.coordinates[block.columns[column as usize] as usize].scale;
            builder.values.row_norm(block.rows[row as usize] as usize) / scale
        };
        let singles = factors.pivots.iter().zip(&factors.inverses);
        let mut noted: Vec<(Value, f64)> =
            singles.map(|(&(row, column), &inverse)| (inverse, weight(self, row, column))).collect();
        if let Some(TwoByTwo { rows, columns, inverse, .. }) = factors.pair {
            noted.push((inverse, weight(self, rows[0], columns[0]) * weight(self, rows[1], columns[1])));
        }
        for (inverse, weight) in noted {
            match inverse {
                Value::Number(x) => is_negative ^= x < 0.0,
                Value::Of { at, negative } => {
                    is_negative ^= negative;
                    let pivot = self.pivots.len() as u32;
                    self.pivots.push(Pivot { turn, weight });
                    self.tape.act(Op::Pivot { a: at, pivot });
                }
            }
        }
        if self.pivots.len() > before {
            let block = self.groups.block_of_column[block.columns[0] as usize] as u32;
            self.turns.push(Turn { block, is_negative });
        }
    }

    /// One equation that is linear in its coordinate.
    fn explicit(&mut self, block: &Block) -> Factors {
        let (row, column) = (block.rows[0] as usize, block.columns[0]);
        let slope = self.inside(block)[0][0].1;
        let rest = self.without(self.program.outputs.phi[row], self.coordinate(0, column));
        let value = self.tape.div(rest.negated(), slope);
        self.know(self.coordinate(0, column), value);
        let inverse = self.tape.recip(slope);
        Factors {
            pivots: vec![(0, 0)],
            inverses: vec![inverse],
            lower: vec![Vec::new()],
            upper: vec![Vec::new()],
            pair: None,
        }
    }

    /// Equations that are solved by iteration for some coordinates, the others following from these.
    fn implicit(&mut self, block: &Block) -> Factors {
        let pattern: Vec<Vec<(u32, bool)>> = block.rows.iter().map(|&row| self.assignable(block, row)).collect();
        let tearing = tear(&pattern);
        let order = self.order(block);
        // the loop
        self.age += 1;
        let tears: Vec<Register> = tearing.tears.iter().map(|&tear| self.guess(block.columns[tear as usize])).collect();
        self.assign(block, &tearing.assigned);
        let factors = self.eliminate(block, &order, false);
        let mut right = vec![Value::ZERO; block.rows.len()];
        for &row in &tearing.residuals {
            right[row as usize] = self.value(self.program.outputs.phi[block.rows[row as usize] as usize]).negated();
        }
        let corrections = self.solve(&factors, right);
        let tear = |builder: &mut Self, (&place, &x): (&u32, &Register)| {
            let scale = builder.system.coordinates[block.columns[place as usize] as usize].scale;
            let delta = builder.tape.register(corrections[place as usize]);
            Tear { x, delta, scale, cell: cell(scale) }
        };
        let all: Vec<Tear> = tearing.tears.iter().zip(&tears).map(|pair| tear(self, pair)).collect();
        self.settle_pairs(&all);
        self.close_loop(all);
        // where it has settled
        self.age += 1;
        for (&place, &x) in tearing.tears.iter().zip(&tears) {
            self.tape.set_age(x, self.age);
            self.know(self.coordinate(0, block.columns[place as usize]), Value::Of { at: x, negative: false });
        }
        self.assign(block, &tearing.assigned);
        for &row in &tearing.residuals {
            let row = block.rows[row as usize];
            let value = self.value(self.program.outputs.phi[row as usize]);
            let a = self.tape.register(value);
            self.tape.act(Op::Residual { a, row });
        }
        self.eliminate(block, &order, true)
    }

    /// The entries of a row within its block, and whether the row can be solved for the coordinate of each without losing digits:
    /// its slope is a number, and no other number in the row is larger.
    fn assignable(&self, block: &Block, row: u32) -> Vec<(u32, bool)> {
        let slope = |at: usize| self.literals.get(&self.program.outputs.phi_q[at]).map_or(0.0, |slope| slope.abs());
        let entries = || self.entries_inside(block, row);
        let largest = entries().map(|(_, at)| slope(at)).fold(0.0, f64::max);
        entries().map(|(place, at)| (place, slope(at) > 0.0 && slope(at) >= largest)).collect()
    }

    /// A coordinate that iteration begins with.
    fn guess(&mut self, column: u32) -> Register {
        let x = self.tape.fresh(self.age);
        let tear = self.tears.len() as u32;
        self.tears.push(column);
        self.tape.operations.push(Op::Curve { to: x, tear });
        self.know(self.coordinate(0, column), Value::Of { at: x, negative: false });
        x
    }

    /// Coordinates that follow from those that are known.
    fn assign(&mut self, block: &Block, assigned: &[(u32, u32)]) {
        for &(row, place) in assigned {
            let (row, column) = (block.rows[row as usize], block.columns[place as usize]);
            let register = self.coordinate(0, column);
            if self.is_known(register) {
                continue;
            }
            let slope = self.entries_inside(block, row).find(|(own, _)| *own == place).map(|(_, at)| at);
            let slope = slope.map_or(Value::Number(1.0), |at| self.value(self.program.outputs.phi_q[at]));
            let rest = self.without(self.program.outputs.phi[row as usize], register);
            let value = self.tape.div(rest.negated(), slope);
            self.know(register, value);
        }
    }

    /// From now on sines and cosines of tears are those of the grid point, turned by the correction.
    fn settle_pairs(&mut self, tears: &[Tear]) {
        self.pairs.retain_mut(|pair| {
            let tear = tears.iter().find(|tear| tear.x == pair.x && tear.cell <= WIDEST_CELL);
            pair.delta = tear.map(|tear| tear.delta);
            pair.delta.is_some()
        });
        for pair in &self.pairs {
            for register in [pair.sin, pair.cos].into_iter().chain(pair.delta) {
                self.tape.set_age(register, self.age + 1);
            }
        }
    }

    /// Sine and cosine of a tear that has settled: three terms of Taylor's series are enough.
    fn turned(&mut self, x: Value) -> Option<[Value; 2]> {
        let of = |at: Register| Value::Of { at, negative: false };
        let pair = self.pairs.iter().find(|pair| x == of(pair.x))?;
        let (sin, cos, delta) = (of(pair.sin), of(pair.cos), of(pair.delta?));
        let tape = &mut self.tape;
        let half = tape.mul(Value::Number(0.5), delta);
        let bend = tape.mul(half, sin);
        let slope = tape.sub(cos, bend);
        let way = tape.mul(delta, slope);
        let turned_sin = tape.add(sin, way);
        let bend = tape.mul(half, cos);
        let slope = tape.add(sin, bend);
        let way = tape.mul(delta, slope);
        Some([turned_sin, tape.sub(cos, way)])
    }

    fn close_loop(&mut self, tears: Vec<Tear>) {
        self.close_once();
        let from = self.tape.operations.len();
        self.tape.operations.append(&mut self.tape.inner);
        self.segments.push(Segment::Newton { operations: from..self.tape.operations.len(), tears });
    }

    /// Velocity, acceleration and, where needed, jerk of a block.
    fn derivatives(&mut self, block: &Block, factors: &Factors) {
        let outputs = &self.program.outputs;
        for (order, right) in [(1, &outputs.nu), (2, &outputs.gamma), (3, &outputs.jerk)] {
            if right.is_empty() {
                continue;
            }
            let mut sums = Vec::with_capacity(block.rows.len());
            for &row in &block.rows {
                let mut sum = self.value(right[row as usize]);
                for (at, column) in self.entries_outside(block, row) {
                    let slope = self.value(outputs.phi_q[at]);
                    let rate = self.value(self.coordinate(order, column));
                    let product = self.tape.mul(slope, rate);
                    sum = self.tape.sub(sum, product);
                }
                sums.push(sum);
            }
            let rates = self.solve(factors, sums);
            for (&column, &rate) in block.columns.iter().zip(&rates) {
                self.know(self.coordinate(order, column), rate);
                // code has no use for third derivatives but in its measures
                let is_of_measures = order == 3 && self.notes_pivots;
                if !is_of_measures || self.joined.contains(&(self.layout.coordinates[3] + column)) {
                    self.store(order, column);
                }
            }
        }
        for (number, right) in outputs.by_signal.iter().chain(&outputs.by_param).enumerate() {
            self.derivatives_by(number as u32, right, block, factors);
        }
        self.variations(block, factors);
    }

    /// Each variation of position, velocity and acceleration of a block.
    fn variations(&mut self, block: &Block, factors: &Factors) {
        let program = self.program;
        for (variation, rights) in program.outputs.variations.iter().enumerate() {
            for (order, right) in rights.iter().enumerate() {
                let first = program.inputs.varied(variation as u32, order as u32);
                let mut sums = Vec::with_capacity(block.rows.len());
                for &row in &block.rows {
                    let mut sum = self.value(right[row as usize]);
                    for (at, column) in self.entries_outside(block, row) {
                        let slope = self.value(program.outputs.phi_q[at]);
                        let known = self.value(first + column);
                        let product = self.tape.mul(slope, known);
                        sum = self.tape.sub(sum, product);
                    }
                    sums.push(sum);
                }
                let solution = self.solve(factors, sums);
                for (&column, &value) in block.columns.iter().zip(&solution) {
                    self.know(first + column, value);
                    let column = self.layout.varied + first - program.inputs.varied + column;
                    if self.joined.contains(&column) {
                        let a = self.tape.register(value);
                        self.tape.act(Op::Store { column, a });
                    }
                }
            }
        }
    }

    /// The derivatives of a block's coordinates by a signal or parameter, whose number counts all of these.
    fn derivatives_by(&mut self, number: u32, right: &[Register], block: &Block, factors: &Factors) {
        let outputs = &self.program.outputs;
        let first = self.program.inputs.by_signal + number * self.program.inputs.n;
        let mut sums = Vec::with_capacity(block.rows.len());
        for &row in &block.rows {
            let mut sum = self.value(right[row as usize]);
            for (at, column) in self.entries_outside(block, row) {
                let slope = self.value(outputs.phi_q[at]);
                let rate = self.value(first + column);
                let product = self.tape.mul(slope, rate);
                sum = self.tape.sub(sum, product);
            }
            sums.push(sum);
        }
        let slopes = self.solve(factors, sums);
        for (&column, &slope) in block.columns.iter().zip(&slopes) {
            self.know(first + column, slope);
            let a = self.tape.register(slope);
            let column = self.layout.by_signal + number * self.program.inputs.n + column;
            self.tape.act(Op::Store { column, a });
        }
    }

    fn appended(&mut self, columns: &[usize]) {
        for &k in columns {
            let value = self.value(self.program.outputs.appended[k]);
            let a = self.tape.register(value);
            self.tape.act(Op::Store { column: self.layout.appended + k as u32, a });
        }
    }

    fn measures(&mut self, measures: &[usize]) {
        let (system, outputs) = (self.system, &self.program.outputs);
        for &k in measures {
            let measure = &system.measures[k];
            let before = |has: fn(&crate::ir::Measure) -> bool| system.measures[..k].iter().filter(|m| has(m)).count();
            let mut put = |order: usize, list: &[Register], at: usize| {
                let value = self.value(list[at]);
                let a = self.tape.register(value);
                self.tape.act(Op::Store { column: self.layout.measures[order] + at as u32, a });
            };
            put(0, &outputs.measures, k);
            if measure.first.is_some() {
                put(1, &outputs.measures_d, before(|m| m.first.is_some()));
            }
            if measure.second.is_some() {
                put(2, &outputs.measures_dd, before(|m| m.second.is_some()));
            }
        }
    }

    fn store(&mut self, order: usize, column: u32) {
        let value = self.value(self.coordinate(order, column));
        let a = self.tape.register(value);
        self.tape.act(Op::Store { column: self.layout.coordinates[order] + column, a });
    }

    /// The order of elimination of a block.
    fn order(&self, block: &Block) -> Order {
        let mut entries = Vec::new();
        for (row, &number) in block.rows.iter().enumerate() {
            for (column, at) in self.entries_inside(block, number) {
                let value = self.values.entry(at);
                entries.push(BlockEntry { row: row as u32, column, value, is_number: self.is_number(at) });
            }
        }
        Order::new(block.rows.len(), &entries)
    }

    /// Eliminates a block's part of `Φ_q` in an order.
    fn eliminate(&mut self, block: &Block, order: &Order, is_watched: bool) -> Factors {
        let mut rows = self.inside(block);
        let mut factors = Factors {
            pivots: order.pivots.clone(),
            inverses: Vec::with_capacity(rows.len()),
            lower: Vec::with_capacity(rows.len()),
            upper: Vec::with_capacity(rows.len()),
            pair: None,
        };
        for (&(row, column), below) in order.pivots.iter().zip(&order.below) {
            if factors.inverses.len() + 2 == order.pivots.len() {
                factors.pair = self.two_by_two(order, &rows);
                if factors.pair.is_some() {
                    break;
                }
            }
            let mut line = std::mem::take(&mut rows[row as usize]);
            let pivot = line.iter().position(|(own, _)| *own == column).map(|at| line.swap_remove(at).1);
            let inverse = self.tape.recip(pivot.unwrap_or(Value::ZERO));
            let mut lower = Vec::with_capacity(below.len());
            for &other in below {
                let target = &mut rows[other as usize];
                let Some(at) = target.iter().position(|(own, _)| *own == column) else {
                    continue;
                };
                let entry = target.swap_remove(at).1;
                let multiplier = if is_watched {
                    let weights = &mut self.weights;
                    let norm = |row: u32| self.values.row_norm(block.rows[row as usize] as usize);
                    self.tape.multiplier(entry, inverse, || {
                        weights.push(norm(row) / norm(other));
                        (weights.len() - 1) as u32
                    })
                } else {
                    self.tape.mul(entry, inverse)
                };
                for &(own, value) in &line {
                    let product = self.tape.mul(multiplier, value);
                    match target.iter_mut().find(|(known, _)| *known == own) {
                        Some((_, entry)) => *entry = self.tape.sub(*entry, product),
                        None => target.push((own, product.negated())),
                    }
                }
                lower.push((other, multiplier));
            }
            factors.inverses.push(inverse);
            factors.lower.push(lower);
            factors.upper.push(line);
        }
        factors
    }

    /// The last two unknowns of an elimination, where either equation holds both and no pivot is a number.
    fn two_by_two(&mut self, order: &Order, rows: &[Vec<(u32, Value)>]) -> Option<TwoByTwo> {
        let &[.., (upper, first), (lower, second)] = order.pivots.as_slice() else {
            return None;
        };
        let entry = |row: u32, column: u32| {
            let found = rows[row as usize].iter().find(|(own, _)| *own == column).map(|(_, value)| *value);
            found.filter(|value| matches!(value, Value::Of { .. }))
        };
        let entries = [[entry(upper, first)?, entry(upper, second)?], [entry(lower, first)?, entry(lower, second)?]];
        let tape = &mut self.tape;
        let (down, up) = (tape.mul(entries[0][0], entries[1][1]), tape.mul(entries[0][1], entries[1][0]));
        let determinant = tape.sub(down, up);
        let inverse = tape.recip(determinant);
        Some(TwoByTwo { rows: [upper, lower], columns: [first, second], entries, inverse })
    }

    /// Solves with a block's factors: `right` by its rows becomes the solution by its columns.
    fn solve(&mut self, factors: &Factors, mut right: Vec<Value>) -> Vec<Value> {
        for (&(row, _), lower) in factors.pivots.iter().zip(&factors.lower) {
            let own = right[row as usize];
            for &(other, multiplier) in lower {
                let product = self.tape.mul(multiplier, own);
                right[other as usize] = self.tape.sub(right[other as usize], product);
            }
        }
        let mut solution = vec![Value::ZERO; right.len()];
        if let Some(TwoByTwo { rows, columns, entries: [[a, b], [c, d]], inverse }) = factors.pair {
            let [upper, lower] = rows.map(|row| right[row as usize]);
            for (column, [(x, p), (y, q)]) in
                columns.into_iter().zip([[(d, upper), (b, lower)], [(a, lower), (c, upper)]])
            {
                let (plus, minus) = (self.tape.mul(x, p), self.tape.mul(y, q));
                let difference = self.tape.sub(plus, minus);
                solution[column as usize] = self.tape.mul(difference, inverse);
            }
        }
        for (k, &(row, column)) in factors.pivots[..factors.inverses.len()].iter().enumerate().rev() {
            let mut sum = right[row as usize];
            for &(other, value) in &factors.upper[k] {
                let product = self.tape.mul(value, solution[other as usize]);
                sum = self.tape.sub(sum, product);
            }
            solution[column as usize] = self.tape.mul(sum, factors.inverses[k]);
        }
        solution
    }

    /// The entries of a block's rows within the block.
    fn inside(&mut self, block: &Block) -> Vec<Vec<(u32, Value)>> {
        let mut rows = Vec::with_capacity(block.rows.len());
        for &row in &block.rows {
            let places: Vec<(u32, usize)> = self.entries_inside(block, row).collect();
            let values =
                places.iter().map(|&(place, at)| (place, self.value(self.program.outputs.phi_q[at]))).collect();
            rows.push(values);
        }
        rows
    }

    /// The entries of a row within its block: place of the column, and position in the pattern.
    fn entries_inside(&self, block: &Block, row: u32) -> impl Iterator<Item = (u32, usize)> + use<'s, '_, V> {
        let own = self.groups.block_of_column[block.columns[0] as usize];
        let pattern = &self.system.phi_q;
        let entries = pattern.range(row as usize).zip(pattern.row(row as usize));
        entries
            .filter(move |(_, (column, _))| self.groups.block_of_column[*column as usize] == own)
            .map(|(at, &(column, _))| (self.place_of_column[column as usize], at))
    }

    /// The entries of a row in blocks before its own: position in the pattern, and column.
    fn entries_outside(&self, block: &Block, row: u32) -> Vec<(usize, u32)> {
        let own = self.groups.block_of_column[block.columns[0] as usize];
        let pattern = &self.system.phi_q;
        let entries = pattern.range(row as usize).zip(pattern.row(row as usize));
        entries
            .filter(|(_, (column, _))| self.groups.block_of_column[*column as usize] != own)
            .map(|(at, &(column, _))| (at, column))
            .collect()
    }

    /// Whether an entry of `Φ_q` is a number other than zero.
    fn is_number(&self, position: usize) -> bool {
        self.literals.get(&self.program.outputs.phi_q[position]).is_some_and(|&value| value != 0.0)
    }

    /// The program's register of a coordinate's derivative.
    fn coordinate(&self, order: usize, column: u32) -> Register {
        self.program.inputs.coordinates[order] + column
    }

    fn know(&mut self, register: Register, value: Value) {
        self.known[register as usize] = (self.tape.age(value), value);
    }

    fn is_known(&self, register: Register) -> bool {
        let (age, _) = self.known[register as usize];
        age >= self.tape.least_age && (age % 2 == 0 || age == self.age)
    }

    /// The value of a register of the program; lays out what it needs.
    fn value(&mut self, wanted: Register) -> Value {
        let mut open = std::mem::take(&mut self.open);
        open.push(wanted);
        while let Some(&register) = open.last() {
            if self.is_known(register) {
                open.pop();
            } else if let Some(value) = self.leaf(register) {
                self.know(register, value);
            } else if let Some((_, op)) = self.definitions[register as usize] {
                let (reads, count) = op.reads();
                let waiting = open.len();
                open.extend(reads[..count].iter().filter(|&&read| !self.is_known(read)));
                if open.len() == waiting {
                    let mut operands = [Value::ZERO; 3];
                    for (operand, &read) in operands.iter_mut().zip(&reads[..count]) {
                        *operand = self.known[read as usize].1;
                    }
                    self.learn(op, operands);
                }
            } else {
                // a coordinate of a later block, or a derivative that nothing needs: it cancels, and may be anything
                self.know(register, Value::ZERO);
                self.let_pass(register);
            }
        }
        self.open = open;
        self.known[wanted as usize].1
    }

    fn learn(&mut self, op: program::Op, operands: [Value; 3]) {
        let results = self.sine_and_cosine(op, operands[0]).unwrap_or_else(|| lower(&mut self.tape, op, operands));
        let (reads, count) = op.reads();
        let passes = reads[..count].iter().any(|&read| self.is_passing[read as usize]);
        let (written, many) = op.writes();
        for (&register, value) in written[..many].iter().zip(results) {
            self.know(register, value);
            if passes {
                self.let_pass(register);
            }
        }
    }

    /// Those of a tear, of which they are noted while Newton goes on.
    fn sine_and_cosine(&mut self, op: program::Op, a: Value) -> Option<[Value; 2]> {
        let (program::Op::SinCos { .. }, Value::Of { at, negative: false }) = (op, a) else {
            return None;
        };
        if self.age.is_multiple_of(2) {
            return self.turned(a);
        }
        let results = lower(&mut self.tape, op, [a; 3]);
        if let [Value::Of { at: sin, .. }, Value::Of { at: cos, .. }] = results {
            self.pairs.push(Pair { x: at, sin, cos, delta: None });
        }
        Some(results)
    }

    /// Forgets the value of a register when the block is done.
    fn let_pass(&mut self, register: Register) {
        self.is_passing[register as usize] = true;
        self.passing.push(register);
    }

    /// A value that is not computed from others here.
    fn leaf(&mut self, register: Register) -> Option<Value> {
        let inputs = &self.program.inputs;
        if let Some(&value) = self.literals.get(&register) {
            return Some(Value::Number(value));
        }
        if register < inputs.time || self.is_loaded(register) || self.is_given_signal(register) {
            return Some(self.tape.push(|to| Op::Load { to, from: register }));
        }
        if register == inputs.time {
            return Some(self.tape.push(|to| Op::Time { to }));
        }
        if register >= inputs.varied && register < inputs.varied(self.system.variations().len() as u32, 0) {
            let column = self.layout.varied + (register - inputs.varied);
            return self.is_across.then(|| self.tape.push(|to| Op::Column { to, column }));
        }
        let order = (0..4)
            .find(|&order| (inputs.coordinates[order]..inputs.coordinates[order] + inputs.n).contains(&register))?;
        let column = register - inputs.coordinates[order];
        let column = self.layout.coordinates[order] + column;
        self.is_across.then(|| self.tape.push(|to| Op::Column { to, column }))
    }

    /// Whether a register is of a signal that no operation says.
    fn is_given_signal(&self, register: Register) -> bool {
        self.program.inputs.all_signals().contains(&register) && self.definitions[register as usize].is_none()
    }

    /// Whether a register of the program keeps its value within a step: it depends on parameters alone, or is a switch.
    fn is_loaded(&self, register: Register) -> bool {
        self.definitions[register as usize]
            .is_some_and(|(stage, op)| stage == Stage::Prologue || (op.switched().is_some() && stage.can_switch()))
    }

    /// The value of a sum in which an input, which it is linear in, is left out.
    fn without(&mut self, sum: Register, left_out: Register) -> Value {
        // none: it does not depend on that input
        let mut found: FxHashMap<Register, Option<Value>> = FxHashMap::default();
        found.insert(left_out, Some(Value::ZERO));
        let mut open = vec![sum];
        while let Some(&register) = open.last() {
            let op = self.definitions[register as usize].filter(|_| !self.is_loaded(register));
            let Some((_, op)) = op.filter(|_| !found.contains_key(&register)) else {
                found.entry(register).or_insert(None);
                open.pop();
                continue;
            };
            let (reads, count) = op.reads();
            let waiting = open.len();
            open.extend(reads[..count].iter().filter(|read| !found.contains_key(read)));
            if open.len() > waiting {
                continue;
            }
            let (written, many) = op.writes();
            let results = if reads[..count].iter().all(|read| found[read].is_none()) {
                [None; 2]
            } else {
                let mut operands = [Value::ZERO; 3];
                for (operand, read) in operands.iter_mut().zip(&reads[..count]) {
                    *operand = match found[read] {
                        Some(value) => value,
                        None => self.value(*read),
                    };
                }
                lower(&mut self.tape, op, operands).map(Some)
            };
            for (register, result) in written.into_iter().zip(results).take(many) {
                found.insert(register, result);
            }
        }
        match found[&sum] {
            Some(value) => value,
            None => self.value(sum),
        }
    }
}

/// Lays an operation of a program out for operands some of which are numbers; a sine and cosine have two results.
fn lower(tape: &mut Tape, op: program::Op, [a, b, c]: [Value; 3]) -> [Value; 2] {
    use program::Op as P;
    let result = match op {
        P::Add { .. } => tape.add(a, b),
        P::Sub { .. } => tape.sub(a, b),
        P::Mul { .. } => tape.mul(a, b),
        P::Div { .. } => tape.div(a, b),
        P::Neg { .. } => a.negated(),
        P::Recip { .. } => tape.recip(a),
        P::Copy { .. } => a,
        P::SinCos { .. } => {
            if let Value::Number(x) = a {
                let (sin, cos) = math::sin_cos(x);
                return [Value::Number(sin), Value::Number(cos)];
            }
            let a = tape.register(a);
            return tape.push_pair(|sin, cos| Op::SinCos { sin, cos, a });
        }
        _ => {
            let (reads, count) = op.reads();
            let mut registers = [0; 3];
            for (register, value) in registers.iter_mut().zip([a, b, c]).take(count) {
                *register = tape.register(value);
            }
            let place =
                |read: Register| reads[..count].iter().position(|own| *own == read).map_or(read, |k| registers[k]);
            tape.push(|to| Op::Other(op.renumbered(place, |_| to)))
        }
    };
    [result, Value::ZERO]
}

/// Whether an order of rows with their columns takes an odd number of exchanges to make.
fn is_odd(pivots: &[(u32, u32)]) -> bool {
    let mut column_of = vec![0; pivots.len()];
    for &(row, column) in pivots {
        column_of[row as usize] = column as usize;
    }
    let mut is_odd = false;
    for row in 0..column_of.len() {
        while column_of[row] != row {
            let other = column_of[row];
            column_of.swap(row, other);
            is_odd = !is_odd;
        }
    }
    is_odd
}

/// The largest power of two that is not above a positive number.
fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
}
