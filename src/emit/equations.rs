//! `Φ`, `Φ_q`, `Φ_t`, `ν`, `γ` and what else the program evaluates, as functions of the coordinates.

use super::code::{Code, Function, Input, Out, Scene};
use super::goods::Uses;
use super::names::{Names, VARIED};
use super::operations::slice;
use super::tables::{self, Tables};
use super::tape::{self, Book, Notes};
use super::text::{documented, literal, signature};
use crate::program::{Column, Program, Register};
use crate::solver::{Instruction, Segment};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::RefCell;

/// What the functions of the equations are written from.
pub(super) struct Equations<'e> {
    pub program: &'e Program,
    pub names: &'e Names,
    pub tables: &'e Tables,
    pub constants: FxHashMap<Register, f64>,
    /// The results of switches, by their places among the sides.
    pub sides: FxHashMap<Register, usize>,
    /// Whether they are those of a mechanism that is led by its inputs: these are given, as a `Way`.
    pub is_led: bool,
    /// What operations written as numbers share; none where they are written as lines.
    pub book: Option<RefCell<Book>>,
    /// What the functions use.
    pub uses: RefCell<Uses>,
}

/// Where a register of the program gets its value that no operation of a function writes.
pub(super) enum Loaded {
    Number(f64),
    /// An array of those that operations read, and the place there.
    Input {
        array: u32,
        index: u32,
    },
}

/// A function to write.
#[allow(clippy::struct_excessive_bools)] // what it is given and what it gives are said one by one
pub(super) struct Wanted<'f> {
    pub name: &'f str,
    pub docs: &'f str,
    pub is_public: bool,
    /// How many derivatives of the coordinates it is given, itself counted: 0 for none.
    pub orders: usize,
    pub has_time: bool,
    /// Whether it is given the derivatives by inputs and parameters too, of a mechanism that has such.
    pub varied: bool,
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
        let instructions = slice(self.program, wanted.outputs, &given);
        let mut arguments: Vec<(&str, String)> =
            ARRAYS[..wanted.orders].iter().map(|name| (*name, "&[f64; N]".to_owned())).collect();
        if wanted.varied && self.has_varied() {
            arguments.push((VARIED, "&[f64; VARIED]".to_owned()));
        }
        if wanted.has_time {
            arguments.push(("t", "f64".to_owned()));
        }
        arguments.push(("p", if self.is_led { "&Way" } else { "&Params" }.to_owned()));
        if wanted.given != Given::None && !self.sides.is_empty() {
            arguments.push(("sides", "&Sides".to_owned()));
        }
        if let Some(book) = &self.book {
            return self.as_numbers(wanted, &instructions, &arguments, &mut book.borrow_mut());
        }
        self.uses.borrow_mut().instructions(&instructions, false);
        let segments = [Segment::Once(0..instructions.len())];
        let code = Code { instructions: &instructions, segments: &segments, registers: self.program.registers() };
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

    /// A function that reads its operations from a list of numbers.
    fn as_numbers(
        &self,
        wanted: &Wanted<'_>,
        instructions: &[Instruction],
        arguments: &[(&str, String)],
        book: &mut Book,
    ) -> String {
        let count = instructions.iter().filter(|each| !matches!(each, Instruction::Store { .. })).count();
        let instructions = tape::with_loads(instructions, self.program.registers());
        let segments = [Segment::Once(0..instructions.len())];
        let shared = tape::share(&instructions, &segments, self.program.registers());
        let notes = Notes { pivot: &|_| (0, 0.0), weight: &|_| 0.0, bound: &|_| 0.0 };
        let words = book.encode(&shared.instructions, self, &FxHashMap::default(), &notes).words;
        let name = wanted.name.to_uppercase();
        let params = match (self.names.params.is_empty(), self.is_led) {
            (true, _) => "&[]",
            (false, false) => "&p.list()",
            (false, true) => "&p.params.list()",
        };
        let mut lists: Vec<String> = vec![params.to_owned()];
        lists.push("&[]".to_owned());
        let given = |argument: &str| arguments.iter().any(|(name, _)| *name == argument);
        lists.push(if given("sides") { "sides" } else { "&[]" }.to_owned());
        let time = if self.is_led { "&p.list::<{ 3 * SIGNALS }>(t)" } else { "&[t]" };
        lists.push(if given("t") { time } else { "&[]" }.to_owned());
        lists.extend(ARRAYS.map(|array| if given(array) { array } else { "&[]" }.to_owned()));
        lists.push(if given(VARIED) { VARIED } else { "&[]" }.to_owned());
        let mut uses = self.uses.borrow_mut();
        uses.name("tables", "Arrays");
        uses.name("tables", "run");
        if self.is_led {
            uses.file("way_list");
        }
        let turned = if wanted.negated { "    out = out.map(|value| -value);\n" } else { "" };
        let body = format!(
            "    let inputs: Arrays<'_> = [{}];\n    let mut out = [0.0; {}];\n    let mut v = [0.0; {}];\n    \
             run::<Numbers>(&{name}_CODE, &[], &inputs, &mut v, &mut out);\n{turned}    out\n",
            lists.join(", "),
            wanted.length,
            shared.registers,
        );
        let types: Vec<(&str, &str)> = arguments.iter().map(|(name, of)| (*name, of.as_str())).collect();
        let visibility = if wanted.is_public { "pub " } else { "" };
        let docs = format!("{}\n\n{count} operations, in [`{name}_CODE`].", wanted.docs);
        documented(&docs, "")
            + &signature(visibility, wanted.name, &types, &format!("[f64; {}]", wanted.length), &body, 0)
            + &body
            + "}\n\n"
            + &tape::list(&format!("The operations of [`{}`].", wanted.name), &format!("{name}_CODE"), &words)
    }

    /// Where a register of the program gets its value.
    pub fn loaded(&self, register: Register, known: &FxHashMap<Register, usize>) -> Loaded {
        let inputs = &self.program.inputs;
        let input = |array: u32, index: usize| Loaded::Input { array, index: index as u32 };
        if let Some(&value) = self.constants.get(&register) {
            return Loaded::Number(value);
        }
        if let Some(&place) = known.get(&register) {
            return input(1, place);
        }
        if let Some(&side) = self.sides.get(&register) {
            return input(2, side);
        }
        if register == inputs.time {
            return input(3, 0);
        }
        if inputs.all_signals().contains(&register) {
            return input(3, (register - inputs.signals) as usize);
        }
        if register < inputs.time {
            return input(0, (register - inputs.params) as usize);
        }
        if let Some(place) = self.varied(register) {
            return input(4 + ARRAYS.len() as u32, place);
        }
        let order =
            (0..4).find(|&order| (inputs.coordinates[order]..inputs.coordinates[order] + inputs.n).contains(&register));
        order.map_or(Loaded::Number(f64::NAN), |order| {
            input(4 + order as u32, (register - inputs.coordinates[order]) as usize)
        })
    }

    /// A register of the program that no operation of a function writes; what it is given, the parameters or a way, is reached as
    /// `given`, and of sides those of a lane are picked.
    pub fn input(&self, register: Register, given: &str, lane: &str) -> Input {
        let inputs = &self.program.inputs;
        if let Some(&value) = self.constants.get(&register) {
            return Input::Text(literal(value));
        }
        if let Some(side) = self.sides.get(&register) {
            return Input::Text(format!("sides{lane}[{side}]"));
        }
        if register == inputs.time {
            return Input::Text("t".to_owned());
        }
        if let Some(k) = register.checked_sub(inputs.params).filter(|&k| register < inputs.time && k < inputs.time) {
            let name = &self.names.params[k as usize];
            let of = if self.is_led { ".params" } else { "" };
            return Input::Bound {
                name: self.names.param_variables[k as usize].clone(),
                value: format!("{given}{of}.{name}"),
            };
        }
        if inputs.all_signals().contains(&register) {
            let place = register - inputs.signals;
            let (signal, order) = ((place / 3) as usize, (place % 3) as usize);
            let value = match order {
                0 => format!("{given}.value({signal}, t)"),
                1 => format!("{given}.rates[{signal}]"),
                _ => format!("{given}.accelerations[{signal}]"),
            };
            return Input::Bound { name: self.names.signal(signal, order).to_owned(), value };
        }
        if let Some(place) = self.varied(register) {
            return Input::Text(format!("{VARIED}[{place}]"));
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

    /// Whether measures hold derivatives by inputs or parameters.
    pub fn has_varied(&self) -> bool {
        !self.program.outputs.variations.is_empty()
    }

    /// The place of a register among the derivatives by inputs and parameters.
    fn varied(&self, register: Register) -> Option<usize> {
        let (first, count) = (self.program.inputs.varied, self.program.outputs.variations.len() as u32);
        let is_varied = (first..first + 3 * count * self.program.inputs.n).contains(&register);
        is_varied.then(|| (register - first) as usize)
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
        self.equations.input(register, "p", "")
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

    fn act(&self, _: Instruction, _: &str) -> String {
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
