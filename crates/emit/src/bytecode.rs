//! Operations as numbers, for mechanisms so large that straight lines of Rust would take minutes to compile.
//!
//! A short loop in the emitted code reads them (`runtime/tables.rs`). Registers are shared, so that a large mechanism does not ask
//! for a large stack.

use super::operations::{binary, callee, callee_of_two, unary};
use super::print::{Head, Page};
use super::runtime_files::RuntimeDeps;
use super::text::literal;
use mechc_engine::limits::solver::LARGEST_MULTIPLIER;
use mechc_engine::solver::{Instruction, Segment, from_bits};
use mechc_expr::{Binary, Unary};
use mechc_ir::program::{Column, Op, Register, codes};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Operations that rustc compiles as straight lines in seconds.
pub const LARGEST_STRAIGHT: usize = 100_000;

/// Words of a list on a line.
const WORDS_ON_A_LINE: usize = 16;

/// The array in which the time is given.
const TIME: u32 = 3;

const UNUSED: Register = Register::MAX;

/// Operations after register allocation.
pub(super) struct Shared {
    pub instructions: Vec<Instruction>,
    pub segments: Vec<Segment>,
    pub registers: usize,
}

/// Inserts loads of inputs, the registers that no operation writes, each before its first use.
pub(super) fn with_loads(instructions: &[Instruction], registers: usize) -> Vec<Instruction> {
    let mut is_written = vec![false; registers];
    let mut all = Vec::with_capacity(instructions.len());
    for &instruction in instructions {
        for register in instruction.reads() {
            if !is_written[register as usize] {
                is_written[register as usize] = true;
                all.push(Instruction::Load { to: register, from: register });
            }
        }
        for register in instruction.writes() {
            is_written[register as usize] = true;
        }
        all.push(instruction);
    }
    all
}

/// Allocates registers anew so that values with disjoint live ranges share one. Exactly one instruction must write each register.
pub(super) fn share(instructions: &[Instruction], segments: &[Segment], registers: usize) -> Shared {
    let last = last_uses(instructions, segments, registers);
    let mut place = vec![UNUSED; registers];
    let mut ends: Vec<Vec<Register>> = vec![Vec::new(); instructions.len() + 1];
    let (mut free, mut next) = (Vec::new(), 0);
    let mut shared = Vec::with_capacity(instructions.len());
    for (at, &instruction) in instructions.iter().enumerate() {
        let with_reads = instruction.renumbered(|register| place[register as usize], |register| register);
        for register in instruction.writes() {
            let slot = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
            place[register as usize] = slot;
            ends[last[register as usize].max(at)].push(slot);
        }
        shared.push(with_reads.renumbered(|register| register, |register| place[register as usize]));
        free.append(&mut ends[at]);
    }
    let segments = segments.iter().cloned().map(|segment| segment.renumbered(|register| place[register as usize]));
    Shared { instructions: shared, segments: segments.collect(), registers: next as usize }
}

/// Returns, for each register, the index of the last instruction that needs it.
fn last_uses(instructions: &[Instruction], segments: &[Segment], registers: usize) -> Vec<usize> {
    let (mut last, mut written) = (vec![0; registers], vec![0; registers]);
    for segment in segments {
        let range = segment.range();
        for at in range.clone() {
            for register in instructions[at].reads() {
                // a value from before a loop is needed again in its next round
                let is_from_before = !segment.tears().is_empty() && written[register as usize] < range.start;
                let until = if is_from_before { range.end - 1 } else { at };
                last[register as usize] = last[register as usize].max(until);
            }
            for register in instructions[at].writes() {
                written[register as usize] = at;
            }
        }
        for register in segment.tears().iter().flat_map(|tear| [tear.x, tear.delta]) {
            last[register as usize] = last[register as usize].max(range.end.saturating_sub(1));
        }
    }
    last
}

/// Encoded operations.
#[derive(Default)]
pub(super) struct Bytecode {
    pub words: Vec<u32>,
    /// Index at which each operation begins, and the end of the last one.
    pub starts: Vec<u32>,
}

/// Numbers to which operations refer by index, without duplicates.
#[derive(Default)]
pub(super) struct Numbers {
    pub values: Vec<f64>,
    indices: FxHashMap<u64, u32>,
}

impl Numbers {
    fn of(&mut self, value: f64) -> u32 {
        let next = self.values.len() as u32;
        let place = *self.indices.entry(value.to_bits()).or_insert(next);
        if place == next {
            self.values.push(value);
        }
        place
    }
}

/// Source of a register's value if no operation of the list writes it.
pub(super) enum Loaded {
    Number(f64),
    /// An element of one of the arrays that operations read.
    Input {
        array: u32,
        index: u32,
    },
}

/// Context of a list of operations: registers of the program, and the subjects of the solver's notes.
pub(super) struct Notes<'n> {
    pub loaded: &'n dyn Fn(Register) -> Loaded,
    /// Maps the number of a pivot to its turn and its weight.
    pub pivot: &'n dyn Fn(u32) -> (u32, f64),
    /// Maps the number of a multiplier to its weight.
    pub weight: &'n dyn Fn(u32) -> f64,
    /// Maps a row to its largest admissible residual.
    pub bound: &'n dyn Fn(u32) -> f64,
}

/// Constants that all lists of operations share.
#[derive(Default)]
pub(super) struct ConstantPool {
    numbers: Numbers,
    /// Functions that operations call, by number.
    unary: BTreeMap<u32, Unary>,
    binary: BTreeMap<u32, Binary>,
}

impl ConstantPool {
    /// Encodes operations.
    pub fn encode(&mut self, instructions: &[Instruction], notes: &Notes<'_>) -> Bytecode {
        let mut tape = Bytecode::default();
        for &instruction in instructions {
            tape.starts.push(tape.words.len() as u32);
            self.write(instruction, &mut tape.words, notes);
        }
        tape.starts.push(tape.words.len() as u32);
        tape
    }

    /// Writes one instruction down.
    fn write(&mut self, instruction: Instruction, words: &mut Vec<u32>, notes: &Notes<'_>) {
        let numbers = &mut self.numbers;
        match instruction {
            Instruction::Compute(op) => self.write_operation(op, words),
            Instruction::Number { to, bits } => words.extend([codes::NUMBER, to, numbers.of(from_bits(bits))]),
            Instruction::Load { to, from } => match (notes.loaded)(from) {
                Loaded::Number(value) => words.extend([codes::NUMBER, to, numbers.of(value)]),
                Loaded::Input { array, index } => words.extend([codes::INPUT, to, array, index]),
            },
            Instruction::Time { to } => words.extend([codes::INPUT, to, TIME, 0]),
            Instruction::Column { to, column } => words.extend([codes::STORED, to, column]),
            Instruction::Curve { to, tear } => words.extend([codes::GUESS, to, tear]),
            Instruction::Store { column, a } => words.extend([codes::STORE, column, a]),
            Instruction::Multiplier { to, a, b, weight } => {
                let most = numbers.of((notes.weight)(weight) / LARGEST_MULTIPLIER);
                self.write_operation(Op::Mul { to, a, b }, words);
                words.extend([codes::MULTIPLIER, to, most]);
            }
            Instruction::Residual { a, row } => words.extend([codes::RESIDUAL, a, numbers.of((notes.bound)(row))]),
            Instruction::Pivot { a, pivot } => {
                let (turn, weight) = (notes.pivot)(pivot);
                words.extend([codes::PIVOT, a, turn, numbers.of(weight)]);
            }
        }
    }

    fn write_operation(&mut self, op: Op, words: &mut Vec<u32>) {
        match op {
            Op::Unary { function, .. } => drop(self.unary.insert(function as u32, function)),
            Op::Binary { function, .. } => drop(self.binary.insert(function as u32, function)),
            _ => {}
        }
        let (code, about) = op.code();
        words.push(code);
        words.extend(op.writes());
        words.extend(op.reads());
        words.extend(about);
    }

    /// Prints lookups by number of the constants, the functions and the columns of `tables` tables. `called` returns the name of a column.
    pub fn print(
        &self,
        tables: usize,
        called: impl Fn(u32, Column) -> String,
        deps: &mut RuntimeDeps,
        page: &mut Page,
    ) {
        deps.name("bytecode_interpreter", "ConstantPool");
        let values: Vec<String> = self.numbers.values.iter().copied().map(literal).collect();
        page.docs("The numbers among the operations.");
        page.line("#[rustfmt::skip]");
        page.list(&format!("static NUMBERS: [f64; {}] = [", values.len()), &values, "];");
        page.blank();
        page.docs("What operations name by numbers.");
        page.line("struct Numbers;\n");
        let mut unary_arms = Vec::new();
        for (number, of) in &self.unary {
            deps.callee(callee(*of));
            unary_arms.push((*number, unary(*of, "a")));
        }
        let mut binary_arms = Vec::new();
        for (number, of) in &self.binary {
            deps.callee(callee_of_two(*of));
            binary_arms.push((*number, binary(*of, "a", "b")));
        }
        let mut column_arms = Vec::new();
        for table in 0..tables as u32 {
            for column in Column::ALL {
                let number = table * Column::ALL.len() as u32 + column.number();
                column_arms.push((number, format!("&{}", called(table, column))));
            }
        }
        page.line("#[rustfmt::skip]");
        page.item("impl ConstantPool for Numbers", |page| {
            let number = Head { kind: "fn", name: "number", arguments: &[("number", "usize")], result: "f64" };
            page.function(&number, |page| page.line("NUMBERS.get(number).copied().unwrap_or(f64::NAN)"));
            choice(page, "unary", &["a"], "f64", &unary_arms);
            choice(page, "binary", &["a", "b"], "f64", &binary_arms);
            choice(page, "column", &[], "&'static [f64]", &column_arms);
        });
    }
}

/// Prints a function that looks up one of several items by number.
fn choice(page: &mut Page, name: &str, arguments: &[&str], result: &str, arms: &[(u32, String)]) {
    let none = if result == "f64" { "f64::NAN" } else { "&[]" };
    let mark = |name: &str| if arms.is_empty() { format!("_{name}") } else { name.to_owned() };
    let names: Vec<String> = std::iter::once(&"number").chain(arguments).map(|name| mark(name)).collect();
    let types = std::iter::once("usize").chain(std::iter::repeat("f64"));
    let arguments: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(types).collect();
    page.function(&Head { kind: "fn", name, arguments: &arguments, result }, |page| {
        if arms.is_empty() {
            return page.line(none);
        }
        page.block("match number", |page| {
            for (number, value) in arms {
                page.line(&format!("{number} => {value},"));
            }
            page.line(&format!("_ => {none},"));
        });
    });
}

/// Prints a static array of words.
pub(super) fn list(docs: &str, name: &str, words: &[u32], page: &mut Page) {
    page.docs(docs);
    page.line("#[rustfmt::skip]");
    page.line(&format!("static {name}: [u32; {}] = [", words.len()));
    page.indented(|page| {
        for line in words.chunks(WORDS_ON_A_LINE) {
            let words: Vec<String> = line.iter().map(u32::to_string).collect();
            page.line(&format!("{},", words.join(",")));
        }
    });
    page.line("];");
    page.blank();
}

#[cfg(test)]
mod tests {
    use super::{ConstantPool, Loaded, Notes};
    use crate::runtime::bytecode_interpreter::{self, Results, run};
    use mechc_engine::solver::Instruction;
    use mechc_expr::{Binary, Comparison, Unary, binary_value, unary_value};
    use mechc_ir::program::{Column, LaneMachine, LaneValues, Op, Program, codes};
    use mechc_pipeline::{Choice, Parsed, Redundant};
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;
    use std::collections::BTreeSet;
    use std::sync::{Arc, OnceLock};

    const BINARY: [Binary; 6] = [Binary::Atan2, Binary::Hypot, Binary::Min, Binary::Max, Binary::Pow, Binary::Mod];

    /// Constants of the program, in order.
    const NUMBERS: [f64; 3] = [2.5, 0.125, 7.0];

    /// Columns of the tables of [`program`], by number.
    static COLUMNS: OnceLock<Vec<Vec<f64>>> = OnceLock::new();

    struct Named;

    impl bytecode_interpreter::ConstantPool for Named {
        fn number(number: usize) -> f64 {
            NUMBERS[number]
        }

        fn unary(number: usize, a: f64) -> f64 {
            unary_value(Unary::ALL[number], a)
        }

        fn binary(number: usize, a: f64, b: f64) -> f64 {
            binary_value(BINARY[number], a, b)
        }

        fn column(number: usize) -> &'static [f64] {
            &COLUMNS.get().expect("they are known")[number]
        }
    }

    /// Returns a program with tables, and its parameters.
    fn program() -> (Arc<Program>, Vec<f64>) {
        let text = include_str!("../../../tests/cases/table_list.mech");
        let checked = Parsed::new("table_list.mech", text).check(&Choice::default(), &Memory::default());
        let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
        let compiled = compiled.expect("it is determined");
        let params = compiled.system().params().iter().map(|param| param.value);
        (Arc::clone(compiled.program()), params.collect())
    }

    /// Returns one of each operation, from registers 0, 1, 2 to 3, and 4.
    fn operations() -> Vec<Op> {
        let (to, a, b, c, condition) = (3, 0, 1, 2, 0);
        let mut all = vec![
            Op::Add { to, a, b },
            Op::Sub { to, a, b },
            Op::Mul { to, a, b },
            Op::Div { to, a, b },
            Op::MulAdd { to, a, b, c },
            Op::MulLess { to, a, b, c },
            Op::LessMul { to, a, b, c },
            Op::ProductOfThree { to, a, b, c },
            Op::SumOfProducts { to, a, b, c, d: a },
            Op::DifferenceOfProducts { to, a, b, c, d: a },
            Op::SumOfProductsTimes { to, a, b, c, d: a, e: b },
            Op::DifferenceOfProductsTimes { to, a, b, c, d: a, e: c },
            Op::Turn { to_sin: to, to_cos: 4, sin: a, cos: b, half: c, delta: b },
            Op::Neg { to, a },
            Op::Recip { to, a },
            Op::SinCos { sin: to, cos: 4, a },
            Op::And { to, a, b },
            Op::Or { to, a, b },
            Op::Not { to, a },
            Op::Select { to, condition, a: b, b: c },
            Op::Either { to, condition, a: b, b: c },
            Op::Copy { to, a },
            Op::Piece { to, table: 0, a },
        ];
        all.extend(Unary::ALL.map(|function| Op::Unary { function, to, a }));
        all.extend(BINARY.map(|function| Op::Binary { function, to, a, b }));
        let comparisons = [Comparison::Less, Comparison::LessEqual, Comparison::Equal];
        all.extend(comparisons.map(|comparison| Op::Compare { comparison, to, a, b }));
        all.extend(Column::ALL.map(|column| Op::Pick { to, table: 0, column, piece: a }));
        all
    }

    fn no_notes() -> Notes<'static> {
        Notes { loaded: &|_| Loaded::Number(0.125), pivot: &|_| (5, 7.0), weight: &|_| 16.0 * 7.0, bound: &|_| 0.125 }
    }

    /// Each opcode, and the positions of its operands, are those of the interpreter.
    #[test]
    fn encoded_operations_match_the_interpreter() {
        let (program, params) = program();
        let scalars = program.start(&params);
        let columns = program.tables().iter().flat_map(|table| Column::ALL.map(|column| table.column(column)));
        let values = columns.map(|registers| registers.map(|register| scalars.get(register)).collect());
        COLUMNS.get_or_init(|| values.collect());
        let numbers = [0.0, -0.0, 0.3, 1.5, -2.25, 3.0, 1e9, f64::INFINITY, f64::NAN];
        for op in operations() {
            let tape = ConstantPool::default().encode(&[Instruction::Compute(op)], &no_notes());
            for n in 0..numbers.len().pow(3) {
                let [mut a, b, c] =
                    [n, n / numbers.len(), n / numbers.len().pow(2)].map(|k| numbers[k % numbers.len()]);
                if matches!(op, Op::Pick { .. }) && !a.is_nan() {
                    a = (n % 4) as f64; // a piece that there is
                }
                let mut lanes = [a, b, c, -7.0, -8.0].map(|value| LaneValues([value]));
                op.run(&mut LaneMachine::<1, 1>::new(&mut lanes, 1, (&program, &scalars)));
                let mut v = [a, b, c, -7.0, -8.0];
                run::<Named>(&tape.words, &[], &[&[]; 10], &mut v, &mut [0.0; 0]);
                for (written, LaneValues([single])) in v.into_iter().zip(lanes) {
                    let is_same = written.to_bits() == single.to_bits() || written.is_nan() && single.is_nan();
                    assert!(is_same, "{op:?} of {a}, {b}, {c}: {written} instead of {single}");
                }
            }
        }
    }

    /// Results that a list of operations left behind.
    #[derive(Default)]
    struct Left {
        stored: Vec<(usize, f64)>,
        bounded: Vec<[f64; 2]>,
        pivoted: Vec<(usize, [f64; 2])>,
    }

    impl Results for Left {
        fn store(&mut self, column: usize, value: f64) {
            self.stored.push((column, value));
        }

        fn stored(&self, column: usize) -> f64 {
            100.0 + column as f64
        }

        fn bounded(&mut self, size: f64, bound: f64) {
            self.bounded.push([size, bound]);
        }

        fn pivoted(&mut self, turn: usize, inverse: f64, weight: f64) {
            self.pivoted.push((turn, [inverse, weight]));
        }
    }

    /// Checks the instructions that load and store values.
    #[test]
    fn encoded_instructions_match_the_interpreter() {
        let input = |_| Loaded::Input { array: 1, index: 2 };
        let mut pool = ConstantPool::default();
        let mut tape = pool.encode(
            &[
                Instruction::number(0, 2.5),
                Instruction::Load { to: 1, from: 9 },
                Instruction::Time { to: 2 },
                Instruction::Column { to: 3, column: 6 },
                Instruction::Curve { to: 4, tear: 1 },
                Instruction::Store { column: 8, a: 2 },
                Instruction::Multiplier { to: 5, a: 0, b: 1, weight: 0 },
                Instruction::Residual { a: 0, row: 0 },
                Instruction::Pivot { a: 0, pivot: 0 },
            ],
            &no_notes(),
        );
        let more = pool.encode(&[Instruction::Load { to: 6, from: 9 }], &Notes { loaded: &input, ..no_notes() });
        tape.words.extend(more.words);
        assert_eq!(pool.numbers.values, NUMBERS);
        let (mut v, mut left) = ([f64::NAN; 7], Left::default());
        let mut inputs: bytecode_interpreter::Arrays<'_> = [&[]; 10];
        (inputs[1], inputs[super::TIME as usize]) = (&[0.0, 0.0, 42.0], &[0.75]);
        run::<Named>(&tape.words, &[10.0, 11.0], &inputs, &mut v, &mut left);
        assert_eq!(v.to_vec(), [2.5, 0.125, 0.75, 106.0, 11.0, 0.3125, 42.0]);
        assert_eq!(left.stored, [(8, 0.75)]);
        assert_eq!(left.bounded, [[0.3125 * 7.0, 1.0], [2.5, 0.125]]);
        assert_eq!(left.pivoted, [(5, [2.5, 7.0])]);
    }

    #[test]
    fn opcodes_match_operations() {
        let codes = operations().into_iter().map(|op| op.code().0);
        let joining = [
            codes::NUMBER,
            codes::INPUT,
            codes::STORED,
            codes::GUESS,
            codes::STORE,
            codes::MULTIPLIER,
            codes::RESIDUAL,
            codes::PIVOT,
        ];
        let all: BTreeSet<u32> = codes.chain(joining).collect();
        assert_eq!(all, (0..=codes::TURN).collect(), "and nothing else is there");
        let text = mechc_ir::program::CODES;
        assert_eq!(text.matches("pub const ").count(), all.len());
    }
}
