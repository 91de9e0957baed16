//! `Φ`, `Φ_q`, `Φ_t`, `ν`, `γ` and what else the program evaluates, as functions of the coordinates.

use super::code::{Code, Function, Input, Out, Scene};
use super::names::Names;
use super::operations::slice;
use super::tables::{self, Tables};
use super::text::literal;
use crate::program::{Column, Program, Register};
use crate::solver::{Op, Segment};
use rustc_hash::{FxHashMap, FxHashSet};

/// What the functions of the equations are written from.
pub(super) struct Equations<'e> {
    pub program: &'e Program,
    pub names: &'e Names,
    pub tables: &'e Tables,
    pub constants: FxHashMap<Register, f64>,
    /// The results of switches, by their places among the sides.
    pub sides: FxHashMap<Register, usize>,
}

/// A function to write.
pub(super) struct Wanted<'f> {
    pub name: &'f str,
    pub docs: &'f str,
    pub is_public: bool,
    /// How many derivatives of the coordinates it is given, itself counted: 0 for none.
    pub orders: usize,
    pub has_time: bool,
    /// Its outputs, and the length of the array that they make.
    pub outputs: &'f [Register],
    pub length: &'f str,
    pub negated: bool,
    /// Which switches are given instead of computed.
    pub given: Given,
}

/// Which switches a function is given.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Given {
    None,
    OfTime,
    All,
}

/// The arrays of the coordinates and their derivatives.
pub(super) const ARRAYS: [&str; 4] = ["q", "qd", "qdd", "qddd"];

impl Equations<'_> {
    /// A function with its documentation.
    pub fn function(&self, wanted: &Wanted<'_>) -> String {
        let given: FxHashSet<Register> = match wanted.given {
            Given::None => FxHashSet::default(),
            Given::All => self.sides.keys().copied().collect(),
            Given::OfTime => {
                let of_time = self.program.switches().iter().filter(|switch| switch.on_time);
                of_time.map(|switch| switch.to).collect()
            }
        };
        let operations = slice(self.program, wanted.outputs, &given);
        let mut arguments: Vec<(&str, String)> =
            ARRAYS[..wanted.orders].iter().map(|name| (*name, "&[f64; N]".to_owned())).collect();
        if wanted.has_time {
            arguments.push(("t", "f64".to_owned()));
        }
        arguments.push(("p", "&Params".to_owned()));
        if wanted.given != Given::None && !self.sides.is_empty() {
            arguments.push(("sides", "&Sides".to_owned()));
        }
        let segments = [Segment::Once(0..operations.len())];
        let code = Code { operations: &operations, segments: &segments, registers: self.program.registers() };
        let (result, first) = (format!("[f64; {}]", wanted.length), format!("[0.0; {}]", wanted.length));
        let function = Function {
            name: wanted.name,
            docs: format!("{}\n\n{} operations.", wanted.docs, code.count()),
            is_public: wanted.is_public,
            arguments,
            out: Out::List { of: &result, first: &first },
            margin: 0,
        };
        code.print(&EquationScene { equations: self, negated: wanted.negated, given }, &function)
    }

    /// A register of the program that no operation of a function writes.
    pub fn input(&self, register: Register) -> Input {
        let inputs = &self.program.inputs;
        if let Some(&value) = self.constants.get(&register) {
            return Input::Text(literal(value));
        }
        if let Some(side) = self.sides.get(&register) {
            return Input::Text(format!("sides[{side}]"));
        }
        if register == inputs.time {
            return Input::Text("t".to_owned());
        }
        if let Some(k) = register.checked_sub(inputs.params).filter(|&k| register < inputs.time && k < inputs.time) {
            let name = &self.names.params[k as usize];
            return Input::Bound { name: self.names.param_variables[k as usize].clone(), value: format!("p.{name}") };
        }
        for (order, array) in ARRAYS.iter().enumerate() {
            let first = inputs.coordinates[order];
            if (first..first + inputs.n).contains(&register) {
                let k = (register - first) as usize;
                return Input::Bound { name: self.names.coordinate(order, k), value: format!("{array}[{k}]") };
            }
        }
        Input::Text("f64::NAN".to_owned())
    }

    /// What a column of a table is called: a constant, or a variable where it depends on parameters.
    pub fn table(&self, table: u32, column: Column) -> String {
        let name = self.tables.of(table, column);
        if self.is_constant(table, column) { name.to_owned() } else { name.to_lowercase() }
    }

    /// Whether a column of a table holds numbers alone.
    pub fn is_constant(&self, table: u32, column: Column) -> bool {
        tables::numbers(self.program, &self.constants, table, column).is_some()
    }
}

struct EquationScene<'s, 'e> {
    equations: &'s Equations<'e>,
    negated: bool,
    given: FxHashSet<Register>,
}

impl Scene for EquationScene<'_, '_> {
    fn input(&self, register: Register) -> Input {
        debug_assert!(!self.equations.sides.contains_key(&register) || self.given.contains(&register));
        self.equations.input(register)
    }

    fn load(&self, _: Register) -> String {
        String::new()
    }

    fn place(&self, column: u32) -> String {
        format!("out[{column}]")
    }

    fn name(&self, _: u32) -> Option<String> {
        None
    }

    fn table(&self, table: u32, column: Column) -> String {
        self.equations.table(table, column)
    }

    fn cells(&self, table: u32, column: Column) -> Vec<Register> {
        if self.equations.is_constant(table, column) {
            return Vec::new();
        }
        self.equations.program.tables()[table as usize].column(column).collect()
    }

    fn store(&self, column: u32, value: &str) -> Option<String> {
        let value = if self.negated { negated(value) } else { value.to_owned() };
        (value != "0.0" && value != "-0.0").then(|| format!("out[{column}] = {value};"))
    }

    fn act(&self, _: Op, _: &str) -> String {
        String::new()
    }

    fn watch(&self, _: u32, _: &str) -> String {
        String::new()
    }
}

/// The opposite of a value.
fn negated(value: &str) -> String {
    match value.strip_prefix('-') {
        Some(value) => value.to_owned(),
        None if value == "0.0" => value.to_owned(),
        None => format!("-{value}"),
    }
}
