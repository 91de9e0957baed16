//! What the registers of a program are worth while its system is being solved: known, given, or laid out when first asked for.

use super::age::Age;
use super::folding::{Folding, Results};
use super::tape::{Tape, Value};
use super::{Instruction, RowLayout, Tear};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Op, Program, Register, Stage};
use mechc_ir::tolerances::solving::build::WIDEST_CELL;
use rustc_hash::FxHashMap;

/// The values of a program's registers, and the instructions that they take.
pub(super) struct Terms<'s> {
    program: &'s Program,
    layout: RowLayout,
    /// The registers of variations, and of multipliers.
    varied: std::ops::Range<Register>,
    multipliers: std::ops::Range<Register>,
    /// What each register of the program is written by.
    definitions: Vec<Option<(Stage, Op)>>,
    literals: FxHashMap<Register, f64>,
    /// By register of the program: its value, and how old that is.
    known: Vec<(Age, Value)>,
    pub tape: Tape,
    age: Age,
    /// Whether what components have left in columns may be asked for.
    is_across: bool,
    open: Vec<Register>,
    /// Registers whose values hold for this block alone: they depend on coordinates of later blocks, which cancel in what the
    /// block needs.
    passing: Vec<Register>,
    is_passing: Vec<bool>,
    /// Of the block's tears that have one: sine and cosine at the grid point, and from there on the correction.
    pairs: Vec<Pair>,
    /// Whether these are turned by an instruction of their own.
    turns_at_once: bool,
}

/// A tear with its sine and cosine where Newton has evaluated them last.
struct Pair {
    x: Register,
    sin: Register,
    cos: Register,
    /// From there to the solution; none while Newton goes on.
    delta: Option<Register>,
}

impl<'s> Terms<'s> {
    pub fn new(system: &ConstraintSystem, program: &'s Program, layout: RowLayout, turns_at_once: bool) -> Terms<'s> {
        let variations = system.variations().len() as u32;
        let has_forces = !program.outputs.forces.is_empty();
        let last_multipliers = if has_forces { variations + 1 } else { 0 };
        let multipliers = program.inputs.multipliers;
        Terms {
            program,
            layout,
            varied: program.inputs.varied..program.inputs.varied(variations, 0),
            multipliers: multipliers..multipliers + last_multipliers * program.inputs.n,
            definitions: program.definitions(),
            literals: program.constants().iter().copied().collect(),
            known: vec![(Age::NEVER, Value::ZERO); program.registers()],
            tape: Tape::new(Age::NEVER),
            age: Age::NEVER,
            is_across: false,
            open: Vec::new(),
            passing: Vec::new(),
            is_passing: vec![false; program.registers()],
            pairs: Vec::new(),
            turns_at_once,
        }
    }

    /// Begins a component: nothing is known.
    pub fn begin(&mut self) {
        self.age = self.age.after();
        self.tape = Tape::new(self.age);
    }

    /// Begins what joins components: all that they have stored may be asked for.
    pub fn begin_across(&mut self) {
        self.begin();
        self.is_across = true;
    }

    /// From now on what depends on tears changes from one iteration to the next.
    pub fn enter_loop(&mut self) {
        self.age = self.age.in_loop();
    }

    /// From now on tears are what they are.
    pub fn leave_loop(&mut self, tears: &[Tear]) {
        self.age = self.age.after();
        self.settle_pairs(tears);
        for tear in tears {
            self.tape.set_age(tear.x, self.age);
        }
    }

    /// Forgets what holds for a block alone, which is done.
    pub fn end_block(&mut self) {
        self.pairs.clear();
        for register in std::mem::take(&mut self.passing) {
            self.is_passing[register as usize] = false;
            self.known[register as usize] = (Age::NEVER, Value::ZERO);
        }
    }

    /// A register of its own for a tear, which is written by the curve at first.
    pub fn guess(&mut self, tear: u32) -> Register {
        let to = self.tape.fresh(self.age);
        self.tape.instructions.push(Instruction::Curve { to, tear });
        to
    }

    pub fn know(&mut self, register: Register, value: Value) {
        self.known[register as usize] = (self.tape.age(value), value);
    }

    pub fn is_known(&self, register: Register) -> bool {
        let (age, _) = self.known[register as usize];
        age >= self.tape.first() && (!age.is_in_loop() || age == self.age)
    }

    /// The number that a register always holds.
    pub fn number(&self, register: Register) -> Option<f64> {
        self.literals.get(&register).copied()
    }

    /// The value of a register of the program; lays out what it needs.
    pub fn value(&mut self, wanted: Register) -> Value {
        let mut open = std::mem::take(&mut self.open);
        open.push(wanted);
        while let Some(&register) = open.last() {
            if self.is_known(register) {
                open.pop();
            } else if let Some(value) = self.leaf(register) {
                self.know(register, value);
            } else if let Some((_, op)) = self.definitions[register as usize] {
                let waiting = open.len();
                open.extend(op.reads().into_iter().filter(|&read| !self.is_known(read)));
                if open.len() == waiting {
                    self.learn(op);
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

    /// `sum − slope · known`
    pub fn less_product(&mut self, sum: Value, slope: Register, known: Register) -> Value {
        let (slope, known) = (self.value(slope), self.value(known));
        let product = self.tape.mul(slope, known);
        self.tape.sub(sum, product)
    }

    /// The value of a sum in which an input, which it is linear in, is left out.
    pub fn without(&mut self, sum: Register, left_out: Register) -> Value {
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
            let (reads, waiting) = (op.reads(), open.len());
            open.extend(reads.into_iter().filter(|read| !found.contains_key(read)));
            if open.len() > waiting {
                continue;
            }
            if reads.iter().all(|read| found[read].is_none()) {
                found.extend(op.writes().into_iter().map(|register| (register, None)));
                continue;
            }
            let mut operands = [(sum, Value::ZERO); 3];
            for (operand, read) in operands.iter_mut().zip(reads) {
                *operand = (read, found[&read].unwrap_or_else(|| self.value(read)));
            }
            let of =
                |read: Register| operands.iter().find(|(own, _)| *own == read).map_or(Value::ZERO, |found| found.1);
            let results = folded(&mut self.tape, op, of);
            found.extend(results.into_iter().flatten().map(|(register, value)| (register, Some(value))));
        }
        match found[&sum] {
            Some(value) => value,
            None => self.value(sum),
        }
    }

    /// Lays an operation out whose operands are known.
    fn learn(&mut self, op: Op) {
        let results = self.turned(op).unwrap_or_else(|| self.laid_out(op));
        let passes = op.reads().iter().any(|&read| self.is_passing[read as usize]);
        for (register, value) in results.into_iter().flatten() {
            self.know(register, value);
            if passes {
                self.let_pass(register);
            }
        }
    }

    fn laid_out(&mut self, op: Op) -> Results {
        let known = &self.known;
        let results = folded(&mut self.tape, op, |register| known[register as usize].1);
        if let (Op::SinCos { a, .. }, true) = (op, self.age.is_in_loop())
            && let Value::Of { at: x, negative: false } = known[a as usize].1
            && let [Some((_, Value::Of { at: sin, .. })), Some((_, Value::Of { at: cos, .. }))] = results
        {
            self.pairs.push(Pair { x, sin, cos, delta: None });
        }
        results
    }

    /// Sine and cosine of a tear that has settled: three terms of Taylor's series are enough.
    fn turned(&mut self, op: Op) -> Option<Results> {
        let Op::SinCos { sin: to_sin, cos: to_cos, a } = op else {
            return None;
        };
        let x = self.known[a as usize].1;
        let of = |at: Register| Value::Of { at, negative: false };
        let pair = self.pairs.iter().find(|pair| x == of(pair.x))?;
        let delta = pair.delta?;
        let half = self.tape.mul(Value::Number(0.5), of(delta));
        let half = self.tape.register(half);
        let (sin, cos) = (pair.sin, pair.cos);
        let turn = |[to_sin, to_cos]: [Register; 2]| Op::Turn { to_sin, to_cos, sin, cos, half, delta };
        if !self.turns_at_once {
            return Some(folded(&mut self.tape, turn([to_sin, to_cos]), of));
        }
        let [sin, cos] = self.tape.compute_two(turn);
        Some([Some((to_sin, sin)), Some((to_cos, cos))])
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
                self.tape.set_age(register, self.age);
            }
        }
    }

    /// Forgets the value of a register when the block is done.
    fn let_pass(&mut self, register: Register) {
        self.is_passing[register as usize] = true;
        self.passing.push(register);
    }

    /// A value that is not computed from others here.
    fn leaf(&mut self, register: Register) -> Option<Value> {
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
        self.is_across.then(|| self.tape.push(|to| Instruction::Column { to, column }))
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
}

fn folded(tape: &mut Tape, op: Op, read: impl Fn(Register) -> Value) -> Results {
    let mut folding = Folding { tape, read, results: [None; 2] };
    op.run(&mut folding);
    folding.results
}
