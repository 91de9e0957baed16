//! `Φ`, `Φ_q`, `Φ_t`, `ν`, `γ` and what else the program evaluates, as functions of the coordinates.

use super::code::{Code, CodeContext, Function, Input, Out};
use super::names::{MULTIPLIERS, Names, VARIED};
use super::operand::{Arguments, Operand};
use super::operations::slice;
use super::print::Page;
use super::runtime_files::RuntimeDeps;
use super::tables::{self, Tables};
use mechc_engine::solver::{Instruction, Segment};
use mechc_ir::program::{Column, Program, Register};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::RefCell;

/// Source of the functions of the equations.
pub(super) struct Equations<'e> {
    pub program: &'e Program,
    pub names: &'e Names,
    pub tables: &'e Tables,
    pub constants: FxHashMap<Register, f64>,
    /// The results of switches, by their places among the sides.
    pub sides: FxHashMap<Register, usize>,
    /// True for a mechanism that follows its inputs, which are given as a `Path`.
    pub is_input_driven: bool,
    /// Runtime dependencies of the functions.
    pub deps: RefCell<RuntimeDeps>,
}

/// A function to write.
#[allow(clippy::struct_excessive_bools)] // what it is given and what it gives are said one by one
pub(super) struct FunctionSpec<'f> {
    pub name: &'f str,
    pub docs: &'f str,
    pub is_public: bool,
    /// Number of arrays of coordinates that it is given, from the coordinates to their highest derivative: 0 for none.
    pub orders: usize,
    pub has_time: bool,
    /// True if it is also given the derivatives by inputs and parameters, of a mechanism that has such.
    pub varied: bool,
    /// True if it is also given the multipliers, of a mechanism whose forces are requested.
    pub multipliers: bool,
    /// Outputs, and the length of the array that holds them.
    pub outputs: &'f [Register],
    pub length: &'f str,
    pub negated: bool,
    /// Switches that the function takes as arguments instead of computing them.
    pub given: Given,
}

impl<'f> FunctionSpec<'f> {
    /// Creates the specification of a private function of time on given branches.
    pub fn new(name: &'f str, docs: &'f str, outputs: &'f [Register], length: &'f str) -> FunctionSpec<'f> {
        let (is_public, has_time, negated) = (false, true, false);
        let (orders, varied, multipliers, given) = (0, false, false, Given::All);
        FunctionSpec { name, docs, is_public, orders, has_time, varied, multipliers, outputs, length, negated, given }
    }
}

/// Switches that a function takes as arguments.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Given {
    None,
    OfTime,
    All,
}

/// The arrays of the coordinates and their derivatives.
pub(super) const ARRAYS: [&str; 4] = ["q", "qd", "qdd", "qddd"];
const OF_ARRAYS: [Arguments; 4] = [&["q"], &["qd"], &["qdd"], &["qddd"]];

/// Expressions by which a function reaches its arguments.
pub(super) struct Access {
    /// Expression for the parameters or the input path: `p`, `m.params`.
    pub given: String,
    /// Argument to which `given` refers.
    pub names: Arguments,
    /// Arguments to which `given` refers, and the time.
    pub names_with_time: Arguments,
    /// Index that selects a lane.
    pub lane: &'static str,
}

impl Equations<'_> {
    /// Prints a function with its documentation.
    pub fn function(&self, spec: &FunctionSpec<'_>, page: &mut Page) {
        let given: FxHashSet<Register> = match spec.given {
            Given::None => FxHashSet::default(),
            Given::All => self.sides.keys().copied().collect(),
            Given::OfTime => {
                let of_time = self.program.switches().iter().filter(|switch| switch.on_time);
                of_time.map(|switch| switch.to).collect()
            }
        };
        let instructions = slice(self.program, spec.outputs, &given);
        let mut arguments: Vec<(&'static str, String)> =
            ARRAYS[..spec.orders].iter().map(|name| (*name, "&[f64; N]".to_owned())).collect();
        if spec.varied && self.has_varied() {
            arguments.push((VARIED, "&[f64; VARIED]".to_owned()));
        }
        if spec.multipliers && self.has_forces() {
            arguments.push((MULTIPLIERS, "&[f64; N]".to_owned()));
        }
        if spec.has_time {
            arguments.push(("t", "f64".to_owned()));
        }
        arguments.push(("p", if self.is_input_driven { "&Path" } else { "&Params" }.to_owned()));
        if spec.given != Given::None && !self.sides.is_empty() {
            arguments.push(("sides", "&Sides".to_owned()));
        }
        self.deps.borrow_mut().instructions(&instructions, false);
        let segments = [Segment::Once(0..instructions.len())];
        let code = Code { instructions: &instructions, segments: &segments, registers: self.program.registers() };
        let (result, first) = (format!("[f64; {}]", spec.length), format!("[0.0; {}]", spec.length));
        let function = Function {
            name: spec.name,
            docs: format!("{}\n\n{} operations.", spec.docs, code.count()),
            is_public: spec.is_public,
            arguments,
            out: Out::List { of: &result, first: &first },
            margin: 0,
        };
        page.text(&code.print(&EquationContext { equations: self, negated: spec.negated, given }, &function));
    }

    /// Returns the source of a register that no operation of the function writes.
    pub fn input(&self, register: Register, access: &Access) -> Input {
        let inputs = &self.program.inputs;
        if let Some(&value) = self.constants.get(&register) {
            return Input::Is(Operand::Number(value));
        }
        if let Some(side) = self.sides.get(&register) {
            return Input::Is(Operand::new(format!("sides{}[{side}]", access.lane), &["sides"]));
        }
        if register == inputs.time {
            return Input::Is(Operand::new("t".to_owned(), &["t"]));
        }
        let given = &access.given;
        if let Some(k) = register.checked_sub(inputs.params).filter(|&k| register < inputs.time && k < inputs.time) {
            let name = &self.names.params[k as usize];
            let of = if self.is_input_driven { ".params" } else { "" };
            return Input::Bound {
                name: self.names.param_variables[k as usize].clone(),
                value: Operand::new(format!("{given}{of}.{name}"), access.names),
            };
        }
        if inputs.all_signals().contains(&register) {
            let place = register - inputs.signals;
            let (signal, order) = ((place / 3) as usize, (place % 3) as usize);
            let value = match order {
                0 => Operand::new(format!("{given}.value({signal}, t)"), access.names_with_time),
                1 => Operand::new(format!("{given}.rates[{signal}]"), access.names),
                _ => Operand::new(format!("{given}.accelerations[{signal}]"), access.names),
            };
            return Input::Bound { name: self.names.signal(signal, order).to_owned(), value };
        }
        if let Some(place) = self.varied(register) {
            return Input::Is(Operand::new(format!("{VARIED}[{place}]"), &[VARIED]));
        }
        if let Some(place) = self.multiplier(register) {
            return Input::Is(Operand::new(format!("{MULTIPLIERS}[{place}]"), &[MULTIPLIERS]));
        }
        for (order, (array, of)) in ARRAYS.iter().zip(OF_ARRAYS).enumerate() {
            let first = inputs.coordinates[order];
            if (first..first + inputs.n).contains(&register) {
                let k = (register - first) as usize;
                let value = Operand::new(format!("{array}[{k}]"), of);
                return Input::Bound { name: self.names.coordinate(order, k), value };
            }
        }
        Input::Is(Operand::Number(f64::NAN))
    }

    /// Returns whether measures hold derivatives by inputs or parameters.
    pub fn has_varied(&self) -> bool {
        !self.program.outputs.variations.is_empty()
    }

    /// Returns the index of a register among the derivatives by inputs and parameters.
    fn varied(&self, register: Register) -> Option<usize> {
        let (first, count) = (self.program.inputs.varied, self.program.outputs.variations.len() as u32);
        let is_varied = (first..first + 3 * count * self.program.inputs.n).contains(&register);
        is_varied.then(|| (register - first) as usize)
    }

    /// Returns whether forces are requested.
    pub fn has_forces(&self) -> bool {
        !self.program.outputs.forces.is_empty()
    }

    /// Returns the index of a register among the multipliers.
    fn multiplier(&self, register: Register) -> Option<usize> {
        let (first, count) = (self.program.inputs.multipliers, self.program.outputs.forces.len() as u32);
        (first..first + count).contains(&register).then(|| (register - first) as usize)
    }

    /// Returns the name of a column of a table: a constant, or a variable if it depends on parameters.
    pub fn table(&self, table: u32, column: Column) -> String {
        let name = self.tables.of(table, column);
        if self.is_constant(table, column) { name.to_owned() } else { name.to_lowercase() }
    }

    /// Returns whether a column of a table holds only numbers.
    pub fn is_constant(&self, table: u32, column: Column) -> bool {
        tables::numbers(self.program, &self.constants, table, column).is_some()
    }
}

struct EquationContext<'s, 'e> {
    equations: &'s Equations<'e>,
    negated: bool,
    given: FxHashSet<Register>,
}

impl CodeContext for EquationContext<'_, '_> {
    fn input(&self, register: Register) -> Input {
        debug_assert!(!self.equations.sides.contains_key(&register) || self.given.contains(&register));
        let access = Access { given: "p".to_owned(), names: &["p"], names_with_time: &["p", "t"], lane: "" };
        self.equations.input(register, &access)
    }

    fn load(&self, register: Register) -> Operand {
        debug_assert!(false, "register {register} is loaded by solvers alone");
        Operand::Number(f64::NAN)
    }

    fn place(&self, column: u32) -> Operand {
        Operand::new(format!("out[{column}]"), &["out"])
    }

    fn name(&self, _: u32) -> Option<String> {
        None
    }

    fn table(&self, table: u32, column: Column) -> Operand {
        Operand::local(self.equations.table(table, column))
    }

    fn cells(&self, table: u32, column: Column) -> Vec<Register> {
        if self.equations.is_constant(table, column) {
            return Vec::new();
        }
        self.equations.program.tables()[table as usize].column(column).collect()
    }

    fn store(&self, column: u32, value: &Operand) -> Option<(String, Arguments)> {
        let value = if self.negated { value.negated() } else { value.clone() };
        let is_zero = matches!(value, Operand::Number(value) if value == 0.0);
        (!is_zero).then(|| (format!("out[{column}] = {value};"), &["out"][..]))
    }

    fn act(&self, instruction: Instruction, _: &Operand) -> (String, Arguments) {
        debug_assert!(false, "{instruction:?} is of solvers alone");
        (String::new(), &[])
    }

    fn watch(&self, weight: u32, _: &Operand) -> (String, Arguments) {
        debug_assert!(false, "weight {weight} is of solvers alone");
        (String::new(), &[])
    }
}
