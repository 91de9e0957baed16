//! Slices of a program for given outputs, and operations as Rust expressions.

use mechc_engine::solver::Instruction;
use mechc_expr::{Binary, Comparison, Unary};
use mechc_ir::program::{Column, Machine, Program, Register, STAGES};
use rustc_hash::FxHashSet;

/// Returns the operations behind some registers, in the order in which the interpreter runs them; `given` registers are not computed.
/// Each output is left in the column of its number.
pub(super) fn slice(program: &Program, outputs: &[Register], given: &FxHashSet<Register>) -> Vec<Instruction> {
    let mut is_read = vec![false; program.registers()];
    for &output in outputs {
        is_read[output as usize] = true;
    }
    let mut needed = Vec::new();
    for stage in STAGES.iter().rev() {
        for &op in program.stage(*stage).iter().rev() {
            if op.writes().iter().any(|register| is_read[*register as usize] && !given.contains(register)) {
                needed.push(Instruction::Compute(op));
                for register in program.reads(op) {
                    is_read[register as usize] = true;
                }
            }
        }
    }
    needed.reverse();
    needed.extend(outputs.iter().enumerate().map(|(k, &a)| Instruction::Store { column: k as u32, a }));
    needed
}

/// Operations as Rust expressions.
pub(super) struct Expression<V> {
    /// Text of a register's value.
    pub value: V,
    /// Borrowed column of a table that the operation reads.
    pub column: String,
    /// Written register, and the expression for its value.
    pub result: Option<(Register, String)>,
}

impl<V: FnMut(Register) -> String> Machine for Expression<V> {
    type Value = String;

    fn read(&mut self, register: Register) -> String {
        (self.value)(register)
    }

    fn write(&mut self, register: Register, value: String) {
        self.result = Some((register, value));
    }

    fn add(&mut self, a: String, b: String) -> String {
        format!("{a} + {b}")
    }

    fn sub(&mut self, a: String, b: String) -> String {
        format!("{a} - {b}")
    }

    fn mul(&mut self, a: String, b: String) -> String {
        format!("{a} * {b}")
    }

    fn div(&mut self, a: String, b: String) -> String {
        format!("{a} / {b}")
    }

    fn neg(&mut self, a: String) -> String {
        format!("-{a}")
    }

    fn recip(&mut self, a: String) -> String {
        format!("1.0 / {a}")
    }

    fn sin_cos(&mut self, a: String) -> [String; 2] {
        [format!("sin_cos({a}).0"), format!("sin_cos({a}).1")]
    }

    fn unary(&mut self, function: Unary, a: String) -> String {
        unary(function, &a)
    }

    fn binary(&mut self, function: Binary, a: String, b: String) -> String {
        binary(function, &a, &b)
    }

    fn compare(&mut self, comparison: Comparison, a: String, b: String) -> String {
        let operator = match comparison {
            Comparison::Less => "<",
            Comparison::LessEqual => "<=",
            Comparison::Equal => "==",
        };
        format!("f64::from({a} {operator} {b})")
    }

    fn and(&mut self, a: String, b: String) -> String {
        format!("f64::from({a} != 0.0 && {b} != 0.0)")
    }

    fn or(&mut self, a: String, b: String) -> String {
        format!("f64::from({a} != 0.0 || {b} != 0.0)")
    }

    fn not(&mut self, a: String) -> String {
        format!("f64::from({a} == 0.0)")
    }

    fn select(&mut self, condition: String, a: String, b: String) -> String {
        format!("select({condition}, {a}, {b})")
    }

    fn either(&mut self, condition: String, a: String, b: String) -> String {
        format!("either({condition}, {a}, {b})")
    }

    fn piece(&mut self, _: u32, a: String) -> String {
        format!("piece({a}, {})", self.column)
    }

    fn pick(&mut self, _: u32, _: Column, piece: String) -> String {
        format!("pick({}, {piece})", self.column)
    }
}

/// Name of a function of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callee {
    /// Sine and cosine, of a function that returns both.
    Sine,
    Cosine,
    /// Function of the runtime files.
    Runtime(&'static str),
    /// Method of `f64` in `core`.
    Core(&'static str),
    /// Function of the crate `libm`.
    Libm(&'static str),
}

/// Returns the name of a function of one argument.
pub(super) fn callee(function: Unary) -> Callee {
    match function {
        Unary::Sin => Callee::Sine,
        Unary::Cos => Callee::Cosine,
        Unary::Abs => Callee::Core("abs"),
        Unary::Sign => Callee::Runtime("sign"),
        Unary::Ln => Callee::Libm("log"),
        _ => Callee::Libm(function.word()),
    }
}

/// Returns the name of a function of two arguments.
pub(super) fn callee_of_two(function: Binary) -> Callee {
    match function {
        Binary::Min => Callee::Runtime("lesser"),
        Binary::Max => Callee::Runtime("greater"),
        _ => Callee::Libm(function.word()),
    }
}

/// Returns a call as Rust.
fn call(callee: Callee, arguments: &str) -> String {
    match callee {
        Callee::Sine => format!("sin_cos({arguments}).0"),
        Callee::Cosine => format!("sin_cos({arguments}).1"),
        Callee::Runtime(name) => format!("{name}({arguments})"),
        Callee::Core(name) => format!("f64::{name}({arguments})"),
        Callee::Libm(name) => format!("libm::{name}({arguments})"),
    }
}

/// Returns a function of one argument as Rust.
fn unary(function: Unary, a: &str) -> String {
    call(callee(function), a)
}

/// Returns a function of two arguments as Rust.
fn binary(function: Binary, a: &str, b: &str) -> String {
    call(callee_of_two(function), &format!("{a}, {b}"))
}
