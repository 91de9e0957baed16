//! Operations as numbers, for mechanisms so large that straight lines of Rust would take minutes to compile.
//!
//! A short loop in the emitted code reads them (`runtime/tables.rs`). Registers are shared, so that a large mechanism does not ask
//! for a large stack.

use super::equations::{Equations, Loaded};
use super::operations::{binary, callee, callee_of_two, unary};
use super::print::{Head, Page};
use super::tables::COLUMNS;
use super::text::literal;
use crate::expr::{Binary, Comparison, Unary};
use crate::program::{self, Register};
use crate::solver::{Op, Segment};
use crate::tolerances::solving::solver::LARGEST_MULTIPLIER;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Operations that rustc compiles as straight lines in seconds.
pub const LARGEST_STRAIGHT: usize = 100_000;

/// Words of a list on a line.
const WORDS_ON_A_LINE: usize = 16;

const UNUSED: Register = Register::MAX;

/// Operations with their registers shared.
pub(super) struct Shared {
    pub operations: Vec<Op>,
    pub segments: Vec<Segment>,
    pub registers: usize,
}

/// Puts what is given into registers where it is first read: these are written by no operation.
pub(super) fn with_loads(operations: &[Op], registers: usize) -> Vec<Op> {
    let mut is_written = vec![false; registers];
    let mut all = Vec::with_capacity(operations.len());
    for &op in operations {
        let (reads, count) = op.reads();
        for &register in &reads[..count] {
            if !is_written[register as usize] {
                is_written[register as usize] = true;
                all.push(Op::Load { to: register, from: register });
            }
        }
        let (writes, count) = op.writes();
        for &register in &writes[..count] {
            is_written[register as usize] = true;
        }
        all.push(op);
    }
    all
}

/// Gives registers out anew, each to several values one after the other. Every register must be written by one operation.
pub(super) fn share(operations: &[Op], segments: &[Segment], registers: usize) -> Shared {
    let last = last_uses(operations, segments, registers);
    let mut place = vec![UNUSED; registers];
    let mut ends: Vec<Vec<Register>> = vec![Vec::new(); operations.len() + 1];
    let (mut free, mut next) = (Vec::new(), 0);
    let mut shared = Vec::with_capacity(operations.len());
    for (at, &op) in operations.iter().enumerate() {
        let (writes, count) = op.writes();
        let op = op.renumbered(|register| place[register as usize], |register| register);
        for &register in &writes[..count] {
            let own = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
            place[register as usize] = own;
            ends[last[register as usize].max(at)].push(own);
        }
        shared.push(op.renumbered(|register| register, |register| place[register as usize]));
        free.append(&mut ends[at]);
    }
    let segments = segments.iter().cloned().map(|mut segment| {
        if let Segment::Newton { tears, .. } = &mut segment {
            for tear in tears {
                (tear.x, tear.delta) = (place[tear.x as usize], place[tear.delta as usize]);
            }
        }
        segment
    });
    Shared { operations: shared, segments: segments.collect(), registers: next as usize }
}

/// By register, the operation after which nothing needs it.
fn last_uses(operations: &[Op], segments: &[Segment], registers: usize) -> Vec<usize> {
    let (mut last, mut written) = (vec![0; registers], vec![0; registers]);
    for segment in segments {
        let (range, tears) = match segment {
            Segment::Once(range) => (range.clone(), &[][..]),
            Segment::Newton { operations, tears } => (operations.clone(), tears.as_slice()),
        };
        let is_loop = !tears.is_empty();
        for at in range.clone() {
            let (reads, count) = operations[at].reads();
            for &register in &reads[..count] {
                // what comes from before a loop is needed again in its next round
                let is_from_before = is_loop && written[register as usize] < range.start;
                let until = if is_from_before { range.end - 1 } else { at };
                last[register as usize] = last[register as usize].max(until);
            }
            let (writes, count) = operations[at].writes();
            for &register in &writes[..count] {
                written[register as usize] = at;
            }
        }
        for register in tears.iter().flat_map(|tear| [tear.x, tear.delta]) {
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

/// What notes of the solver are about.
pub(super) struct Notes<'n> {
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
    pub fn encode(
        &mut self,
        operations: &[Op],
        equations: &Equations<'_>,
        known: &FxHashMap<Register, usize>,
        notes: &Notes<'_>,
    ) -> Tape {
        for op in operations {
            match op {
                Op::Other(program::Op::Unary { function, .. }) => {
                    self.unary.insert(*function as u32, *function);
                }
                Op::Other(program::Op::Binary { function, .. }) => {
                    self.binary.insert(*function as u32, *function);
                }
                _ => {}
            }
        }
        encode(operations, equations, known, notes, &mut self.numbers)
    }

    /// The numbers, the functions and the columns of tables by their numbers.
    pub fn print(&self, equations: &Equations<'_>, page: &mut Page) {
        let mut uses = equations.uses.borrow_mut();
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
        for table in 0..equations.program.tables().len() as u32 {
            for (k, &column) in COLUMNS.iter().enumerate() {
                let number = table * COLUMNS.len() as u32 + k as u32;
                column_arms.push((number, format!("&{}", equations.table(table, column))));
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
            arms.iter().for_each(|(number, value)| page.line(&format!("{number} => {value},")));
            page.line(&format!("_ => {none},"));
        });
    });
}

/// A list of words.
pub(super) fn list(docs: &str, name: &str, words: &[u32]) -> String {
    let mut text = format!("/// {docs}\n#[rustfmt::skip]\nstatic {name}: [u32; {}] = [\n", words.len());
    for line in words.chunks(WORDS_ON_A_LINE) {
        text += "    ";
        for word in line {
            text += &word.to_string();
            text += ",";
        }
        text += "\n";
    }
    text + "];\n\n"
}

/// Writes operations down.
fn encode(
    operations: &[Op],
    equations: &Equations<'_>,
    known: &FxHashMap<Register, usize>,
    notes: &Notes<'_>,
    numbers: &mut Numbers,
) -> Tape {
    let mut tape = Tape::default();
    for &op in operations {
        tape.starts.push(tape.words.len() as u32);
        let words = &mut tape.words;
        match op {
            Op::Number { to, bits: [low, high] } => {
                let value = f64::from_bits(u64::from(low) | (u64::from(high) << 32));
                words.extend([0, to, numbers.of(value)]);
            }
            Op::Load { to, from } => match equations.loaded(from, known) {
                Loaded::Number(value) => words.extend([0, to, numbers.of(value)]),
                Loaded::Input { array, index } => words.extend([1, to, array, index]),
            },
            Op::Time { to } => words.extend([1, to, 3, 0]),
            Op::Column { to, column } => words.extend([2, to, column]),
            Op::Curve { to, tear } => words.extend([3, to, tear]),
            Op::Store { column, a } => words.extend([4, column, a]),
            Op::Add { to, a, b } => words.extend([5, to, a, b]),
            Op::Sub { to, a, b } => words.extend([6, to, a, b]),
            Op::Mul { to, a, b } => words.extend([7, to, a, b]),
            Op::Div { to, a, b } => words.extend([8, to, a, b]),
            Op::MulAdd { to, a, b, c } => words.extend([9, to, a, b, c]),
            Op::MulLess { to, a, b, c } => words.extend([10, to, a, b, c]),
            Op::LessMul { to, a, b, c } => words.extend([11, to, a, b, c]),
            Op::Neg { to, a } => words.extend([12, to, a]),
            Op::Recip { to, a } => words.extend([13, to, a]),
            Op::SinCos { sin, cos, a } => words.extend([14, sin, cos, a]),
            Op::Multiplier { to, a, b, weight } => {
                words.extend([7, to, a, b, 15, to, numbers.of((notes.weight)(weight) / LARGEST_MULTIPLIER)]);
            }
            Op::Residual { a, row } => words.extend([16, a, numbers.of((notes.bound)(row))]),
            Op::Pivot { a, pivot } => {
                let (turn, weight) = (notes.pivot)(pivot);
                words.extend([17, a, turn, numbers.of(weight)]);
            }
            Op::Other(op) => encode_other(op, words),
        }
    }
    tape.starts.push(tape.words.len() as u32);
    tape
}

fn encode_other(op: program::Op, words: &mut Vec<u32>) {
    use program::Op as P;
    match op {
        P::Unary { function, to, a } => words.extend([18, to, a, function as u32]),
        P::Binary { function, to, a, b } => words.extend([19, to, a, b, function as u32]),
        P::Compare { comparison: Comparison::Less, to, a, b } => words.extend([20, to, a, b]),
        P::Compare { comparison: Comparison::LessEqual, to, a, b } => words.extend([21, to, a, b]),
        P::Compare { comparison: Comparison::Equal, to, a, b } => words.extend([22, to, a, b]),
        P::And { to, a, b } => words.extend([23, to, a, b]),
        P::Or { to, a, b } => words.extend([24, to, a, b]),
        P::Not { to, a } => words.extend([25, to, a]),
        P::Select { to, condition, a, b } => words.extend([26, to, condition, a, b]),
        P::Either { to, condition, a, b } => words.extend([27, to, condition, a, b]),
        P::Copy { to, a } => words.extend([28, to, a]),
        P::Piece { to, table, a } => words.extend([29, to, a, table * COLUMNS.len() as u32]),
        P::Pick { to, table, column, piece } => {
            let column = COLUMNS.iter().position(|own| *own == column).unwrap_or(0) as u32;
            words.extend([30, to, piece, table * COLUMNS.len() as u32 + column]);
        }
        P::Add { to, a, b } => words.extend([5, to, a, b]),
        P::Sub { to, a, b } => words.extend([6, to, a, b]),
        P::Mul { to, a, b } => words.extend([7, to, a, b]),
        P::Div { to, a, b } => words.extend([8, to, a, b]),
        P::Neg { to, a } => words.extend([12, to, a]),
        P::Recip { to, a } => words.extend([13, to, a]),
        P::SinCos { sin, cos, a } => words.extend([14, sin, cos, a]),
    }
}
