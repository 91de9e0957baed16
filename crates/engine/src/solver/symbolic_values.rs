//! Symbolic values of a program's registers while its system is being solved: solved, given, or emitted on first use.

use super::constant_folding::{ConstantFolder, Results};
use super::schedule::EvalTime;
use super::tape::{Tape, Value};
use super::{Instruction, RowLayout, Tear};
use crate::limits::solver::CELL;
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Op, Program, Register, Stage};
use rustc_hash::FxHashMap;

/// Widest cell within which the sine is a parabola up to rounding.
const WIDEST_CELL: f64 = 8.0 * CELL;

/// The values of a program's registers, and the instructions that compute them.
pub(super) struct SymbolicValues<'s> {
    program: &'s Program,
    layout: RowLayout,
    /// The registers of variations, and of multipliers.
    varied: std::ops::Range<Register>,
    multipliers: std::ops::Range<Register>,
    /// By register of the program: the operation that writes it.
    definitions: Vec<Option<(Stage, Op)>>,
    literals: FxHashMap<Register, f64>,
    /// By register of the program: its value, and the time at which that was defined.
    values: Vec<(EvalTime, Value)>,
    pub tape: Tape,
    time: EvalTime,
    /// True if values may be read from the stored columns of components.
    reads_columns: bool,
    stack: Vec<Register>,
    /// Registers whose values are valid in this block only: they depend on coordinates of later blocks, which cancel where the block uses them.
    block_local: Vec<Register>,
    is_block_local: Vec<bool>,
    /// The block's tears with sine and cosine.
    sin_cos_of_tears: Vec<TearSinCos>,
    /// True if their correction is one instruction, [`Op::Turn`].
    has_rotation_op: bool,
}

/// A tear with its sine and cosine at the last iterate of Newton.
struct TearSinCos {
    x: Register,
    sin: Register,
    cos: Register,
    /// The correction from there to the solution; `None` inside the loop.
    delta: Option<Register>,
}

impl<'s> SymbolicValues<'s> {
    pub fn new(
        system: &ConstraintSystem,
        program: &'s Program,
        layout: RowLayout,
        has_rotation_op: bool,
    ) -> SymbolicValues<'s> {
        let variations = system.variations().len() as u32;
        let has_forces = !program.outputs.forces.is_empty();
        let last_multipliers = if has_forces { variations + 1 } else { 0 };
        let multipliers = program.inputs.multipliers;
        SymbolicValues {
            program,
            layout,
            varied: program.inputs.varied..program.inputs.varied(variations, 0),
            multipliers: multipliers..multipliers + last_multipliers * program.inputs.n,
            definitions: program.definitions(),
            literals: program.constants().iter().copied().collect(),
            values: vec![(EvalTime::NEVER, Value::ZERO); program.registers()],
            tape: Tape::new(EvalTime::NEVER),
            time: EvalTime::NEVER,
            reads_columns: false,
            stack: Vec::new(),
            block_local: Vec::new(),
            is_block_local: vec![false; program.registers()],
            sin_cos_of_tears: Vec::new(),
            has_rotation_op,
        }
    }

    /// Begins a component: no value is defined.
    pub fn begin_component(&mut self) {
        self.time = self.time.after();
        self.tape = Tape::new(self.time);
    }

    /// Begins the shared outputs, which read the stored columns of components.
    pub fn begin_shared_outputs(&mut self) {
        self.begin_component();
        self.reads_columns = true;
    }

    /// Enters a Newton loop: values that depend on tears are computed in each iteration from now on.
    pub fn enter_loop(&mut self) {
        self.time = self.time.in_loop();
    }

    /// Leaves a Newton loop: the tears are final from now on.
    pub fn leave_loop(&mut self, tears: &[Tear]) {
        self.time = self.time.after();
        self.settle_sin_cos(tears);
        for tear in tears {
            self.tape.set_time(tear.x, self.time);
        }
    }

    /// Undefines the values that are valid in the finished block only.
    pub fn end_block(&mut self) {
        self.sin_cos_of_tears.clear();
        for register in std::mem::take(&mut self.block_local) {
            self.is_block_local[register as usize] = false;
            self.values[register as usize] = (EvalTime::NEVER, Value::ZERO);
        }
    }

    /// Returns a new register for a tear, which holds the initial guess.
    pub fn new_tear(&mut self, tear: u32) -> Register {
        let to = self.tape.new_register(self.time);
        self.tape.instructions.push(Instruction::Curve { to, tear });
        to
    }

    pub fn define(&mut self, register: Register, value: Value) {
        self.values[register as usize] = (self.tape.eval_time(value), value);
    }

    pub fn is_defined(&self, register: Register) -> bool {
        let (time, _) = self.values[register as usize];
        time >= self.tape.start() && (!time.is_in_loop() || time == self.time)
    }

    /// Returns the number that a register always holds, if it is a literal.
    pub fn number(&self, register: Register) -> Option<f64> {
        self.literals.get(&register).copied()
    }

    /// Returns the value of a register of the program, and emits the instructions that it needs.
    pub fn value(&mut self, requested: Register) -> Value {
        let mut stack = std::mem::take(&mut self.stack);
        stack.push(requested);
        while let Some(&register) = stack.last() {
            if self.is_defined(register) {
                stack.pop();
            } else if let Some(value) = self.input_value(register) {
                self.define(register, value);
            } else if let Some((_, op)) = self.definitions[register as usize] {
                let depth = stack.len();
                stack.extend(op.reads().into_iter().filter(|&read| !self.is_defined(read)));
                if stack.len() == depth {
                    self.emit(op);
                }
            } else {
                // a coordinate of a later block, or an unused derivative: it cancels, so any value will do
                self.define(register, Value::ZERO);
                self.mark_block_local(register);
            }
        }
        self.stack = stack;
        self.values[requested as usize].1
    }

    /// Returns `sum − slope · factor`.
    pub fn minus_product(&mut self, sum: Value, slope: Register, factor: Register) -> Value {
        let (slope, factor) = (self.value(slope), self.value(factor));
        let product = self.tape.mul(slope, factor);
        self.tape.sub(sum, product)
    }

    /// Returns the value of a sum without the term of an input that it is linear in.
    pub fn value_without(&mut self, sum: Register, left_out: Register) -> Value {
        // `None` for registers that do not depend on that input
        let mut values_without: FxHashMap<Register, Option<Value>> = FxHashMap::default();
        values_without.insert(left_out, Some(Value::ZERO));
        let mut stack = vec![sum];
        while let Some(&register) = stack.last() {
            let op = self.definitions[register as usize].filter(|_| !self.is_loaded(register));
            let Some((_, op)) = op.filter(|_| !values_without.contains_key(&register)) else {
                values_without.entry(register).or_insert(None);
                stack.pop();
                continue;
            };
            let (reads, depth) = (op.reads(), stack.len());
            stack.extend(reads.into_iter().filter(|read| !values_without.contains_key(read)));
            if stack.len() > depth {
                continue;
            }
            if reads.iter().all(|read| values_without[read].is_none()) {
                values_without.extend(op.writes().into_iter().map(|register| (register, None)));
                continue;
            }
            let mut operands = [(sum, Value::ZERO); 3];
            for (operand, read) in operands.iter_mut().zip(reads) {
                *operand = (read, values_without[&read].unwrap_or_else(|| self.value(read)));
            }
            let operand = |read: Register| {
                operands.iter().find(|(register, _)| *register == read).map_or(Value::ZERO, |(_, value)| *value)
            };
            let results = fold(&mut self.tape, op, operand);
            values_without.extend(results.into_iter().flatten().map(|(register, value)| (register, Some(value))));
        }
        match values_without[&sum] {
            Some(value) => value,
            None => self.value(sum),
        }
    }

    /// Emits an operation whose operands are defined.
    fn emit(&mut self, op: Op) {
        let results = self.rotate(op).unwrap_or_else(|| self.emit_folded(op));
        let reads_block_local = op.reads().iter().any(|&read| self.is_block_local[read as usize]);
        for (register, value) in results.into_iter().flatten() {
            self.define(register, value);
            if reads_block_local {
                self.mark_block_local(register);
            }
        }
    }

    fn emit_folded(&mut self, op: Op) -> Results {
        let values = &self.values;
        let results = fold(&mut self.tape, op, |register| values[register as usize].1);
        if let (Op::SinCos { a, .. }, true) = (op, self.time.is_in_loop())
            && let Value::Register { at: x, negative: false } = values[a as usize].1
            && let [Some((_, Value::Register { at: sin, .. })), Some((_, Value::Register { at: cos, .. }))] = results
        {
            self.sin_cos_of_tears.push(TearSinCos { x, sin, cos, delta: None });
        }
        results
    }

    /// Returns sine and cosine of a solved tear, rotated from the last grid point: three terms of the Taylor series are enough.
    fn rotate(&mut self, op: Op) -> Option<Results> {
        let Op::SinCos { sin: to_sin, cos: to_cos, a } = op else {
            return None;
        };
        let x = self.values[a as usize].1;
        let register = |at: Register| Value::Register { at, negative: false };
        let pair = self.sin_cos_of_tears.iter().find(|pair| x == register(pair.x))?;
        let delta = pair.delta?;
        let half = self.tape.mul(Value::Number(0.5), register(delta));
        let half = self.tape.register(half);
        let (sin, cos) = (pair.sin, pair.cos);
        let rotation = |[to_sin, to_cos]: [Register; 2]| Op::Turn { to_sin, to_cos, sin, cos, half, delta };
        if !self.has_rotation_op {
            return Some(fold(&mut self.tape, rotation([to_sin, to_cos]), register));
        }
        let [sin, cos] = self.tape.compute_two(rotation);
        Some([Some((to_sin, sin)), Some((to_cos, cos))])
    }

    /// Makes sines and cosines of solved tears those of the last grid point, rotated by the correction.
    fn settle_sin_cos(&mut self, tears: &[Tear]) {
        self.sin_cos_of_tears.retain_mut(|pair| {
            let tear = tears.iter().find(|tear| tear.x == pair.x && tear.cell <= WIDEST_CELL);
            pair.delta = tear.map(|tear| tear.delta);
            pair.delta.is_some()
        });
        for pair in &self.sin_cos_of_tears {
            for register in [pair.sin, pair.cos].into_iter().chain(pair.delta) {
                self.tape.set_time(register, self.time);
            }
        }
    }

    /// Marks a register whose value is undefined at the end of the block.
    fn mark_block_local(&mut self, register: Register) {
        self.is_block_local[register as usize] = true;
        self.block_local.push(register);
    }

    /// Returns the value of a register that is an input here: a number, a parameter, a switch, the time, or a stored column.
    fn input_value(&mut self, register: Register) -> Option<Value> {
        let inputs = &self.program.inputs;
        if let Some(value) = self.number(register) {
            return Some(Value::Number(value));
        }
        if register < inputs.time || self.is_loaded(register) || self.is_given_signal(register) {
            return Some(self.tape.push(|to| Instruction::Load { to, from: register }));
        }
        if register == inputs.time {
            return Some(self.tape.push(|to| Instruction::Time { to }));
        }
        let column = if self.varied.contains(&register) {
            self.layout.varied + (register - self.varied.start)
        } else if self.multipliers.contains(&register) {
            self.layout.multipliers + (register - self.multipliers.start)
        } else {
            let runs = inputs.coordinates.into_iter().zip(self.layout.coordinates);
            let mut columns = runs.filter(|(first, _)| (*first..first + inputs.n).contains(&register));
            columns.next().map(|(first, column)| column + (register - first))?
        };
        self.reads_columns.then(|| self.tape.push(|to| Instruction::Column { to, column }))
    }

    /// Returns whether a register belongs to a signal without an operation.
    fn is_given_signal(&self, register: Register) -> bool {
        self.program.inputs.all_signals().contains(&register) && self.definitions[register as usize].is_none()
    }

    /// Returns whether a register of the program is constant within a step: it depends on parameters alone, or is a switch.
    fn is_loaded(&self, register: Register) -> bool {
        self.definitions[register as usize]
            .is_some_and(|(stage, op)| stage == Stage::Prologue || (op.switched().is_some() && stage.can_switch()))
    }
}

fn fold(tape: &mut Tape, op: Op, read: impl Fn(Register) -> Value) -> Results {
    let mut folder = ConstantFolder { tape, read, results: [None; 2] };
    op.run(&mut folder);
    folder.results
}
