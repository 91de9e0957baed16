//! Operations as numbers, for mechanisms so large that straight lines of Rust would take minutes to compile.
//!
//! A short loop in the emitted code reads them (`runtime/tables.rs`). Registers are shared, so that a large mechanism does not ask
//! for a large stack.

use super::goods::Uses;
use super::operations::{binary, callee, callee_of_two, unary};
use super::print::{Head, Page};
use super::text::literal;
use crate::expr::{Binary, Unary};
use crate::program::{Column, Op, Register, codes};
use crate::solver::{Instruction, Segment, from_bits};
use crate::tolerances::solving::solver::LARGEST_MULTIPLIER;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Operations that rustc compiles as straight lines in seconds.
pub const LARGEST_STRAIGHT: usize = 100_000;

/// Words of a list on a line.
const WORDS_ON_A_LINE: usize = 16;

/// The array in which the time is given.
const TIME: u32 = 3;

const UNUSED: Register = Register::MAX;

/// Operations with their registers shared.
pub(super) struct Shared {
    pub instructions: Vec<Instruction>,
    pub segments: Vec<Segment>,
    pub registers: usize,
}

/// Puts what is given into registers where it is first read: these are written by no operation.
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

/// Gives registers out anew, each to several values one after the other. Every register must be written by one instruction.
pub(super) fn share(instructions: &[Instruction], segments: &[Segment], registers: usize) -> Shared {
    let last = last_uses(instructions, segments, registers);
    let mut place = vec![UNUSED; registers];
    let mut ends: Vec<Vec<Register>> = vec![Vec::new(); instructions.len() + 1];
    let (mut free, mut next) = (Vec::new(), 0);
    let mut shared = Vec::with_capacity(instructions.len());
    for (at, &instruction) in instructions.iter().enumerate() {
        let with_reads = instruction.renumbered(|register| place[register as usize], |register| register);
        for register in instruction.writes() {
            let own = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
            place[register as usize] = own;
            ends[last[register as usize].max(at)].push(own);
        }
        shared.push(with_reads.renumbered(|register| register, |register| place[register as usize]));
        free.append(&mut ends[at]);
    }
    let segments = segments.iter().cloned().map(|segment| segment.renumbered(|register| place[register as usize]));
    Shared { instructions: shared, segments: segments.collect(), registers: next as usize }
}

/// By register, the instruction after which nothing needs it.
fn last_uses(instructions: &[Instruction], segments: &[Segment], registers: usize) -> Vec<usize> {
    let (mut last, mut written) = (vec![0; registers], vec![0; registers]);
    for segment in segments {
        let range = segment.range();
        for at in range.clone() {
            for register in instructions[at].reads() {
                // what comes from before a loop is needed again in its next round
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

/// The words of operations, and the numbers among them.
#[derive(Default)]
pub(super) struct Tape {
    pub words: Vec<u32>,
    /// Where each operation begins, and where the last one ends.
    pub starts: Vec<u32>,
}

/// Numbers that operations name, each once.
#[derive(Default)]
pub(super) struct Numbers {
    pub values: Vec<f64>,
    known: FxHashMap<u64, u32>,
}

impl Numbers {
    fn of(&mut self, value: f64) -> u32 {
        let next = self.values.len() as u32;
        let place = *self.known.entry(value.to_bits()).or_insert(next);
        if place == next {
            self.values.push(value);
        }
        place
    }
}

/// Where a register of the program gets its value that no operation of a list writes.
pub(super) enum Loaded {
    Number(f64),
    /// An array of those that operations read, and the place there.
    Input {
        array: u32,
        index: u32,
    },
}

/// What operations name that is not among them: registers of the program, and what notes of the solver are about.
pub(super) struct Notes<'n> {
    pub loaded: &'n dyn Fn(Register) -> Loaded,
    /// By number: the turn of a pivot, and its weight.
    pub pivot: &'n dyn Fn(u32) -> (u32, f64),
    /// By number: the weight of a multiplier.
    pub weight: &'n dyn Fn(u32) -> f64,
    /// By row: what may be left of it.
    pub bound: &'n dyn Fn(u32) -> f64,
}

/// What all lists of operations share.
#[derive(Default)]
pub(super) struct Book {
    numbers: Numbers,
    /// The functions that they call, by their number.
    unary: BTreeMap<u32, Unary>,
    binary: BTreeMap<u32, Binary>,
}

impl Book {
    /// Writes operations down.
    pub fn encode(&mut self, instructions: &[Instruction], notes: &Notes<'_>) -> Tape {
        let mut tape = Tape::default();
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

    /// The numbers, the functions and the columns of so many tables, by their numbers; a column is called by its name.
    pub fn print(&self, tables: usize, called: impl Fn(u32, Column) -> String, uses: &mut Uses, page: &mut Page) {
        uses.name("tables", "Book");
        let values: Vec<String> = self.numbers.values.iter().copied().map(literal).collect();
        page.docs("The numbers among the operations.");
        page.line("#[rustfmt::skip]");
        page.list(&format!("static NUMBERS: [f64; {}] = [", values.len()), &values, "];");
        page.blank();
        page.docs("What operations name by numbers.");
        page.line("struct Numbers;\n");
        let mut unary_arms = Vec::new();
        for (number, of) in &self.unary {
            uses.callee(callee(*of));
            unary_arms.push((*number, unary(*of, "a")));
        }
        let mut binary_arms = Vec::new();
        for (number, of) in &self.binary {
            uses.callee(callee_of_two(*of));
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
        page.item("impl Book for Numbers", |page| {
            let number = Head { kind: "fn", name: "number", arguments: &[("number", "usize")], result: "f64" };
            page.function(&number, |page| page.line("NUMBERS.get(number).copied().unwrap_or(f64::NAN)"));
            choice(page, "unary", &["a"], "f64", &unary_arms);
            choice(page, "binary", &["a", "b"], "f64", &binary_arms);
            choice(page, "column", &[], "&'static [f64]", &column_arms);
        });
    }
}

/// A function that gives one of several things by its number.
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

/// A list of words.
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
