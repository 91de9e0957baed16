//! Operations as Rust, `let` by `let`, in functions of a bearable length.
//!
//! Every register is written by one operation. What one function computes and a later one needs is handed on in an array of
//! terms, `w`.

mod instructions;
mod newton_loops;
mod parts;
mod value_locations;

use super::operand::{Arguments, Operand};
use super::text::{documented, signature};
use instructions::Target;
use mechc_engine::solver::{Instruction, Segment};
use mechc_ir::program::{Column, Op, Register};
use parts::{Part, Piece};
use rustc_hash::{FxHashMap, FxHashSet};
use value_locations::{Location, ValueLocations};

/// Indentation of functions of a module within the file.
pub(super) const MODULE: &str = "    ";

/// A loop over lanes is vectorised if it is known that what it writes does not overlap, as what a function is given does not.
const APART: &str = "#[inline(never)]\n";

/// Surroundings of printed operations.
pub(super) trait CodeContext {
    /// Returns the name and the value of a register that no operation writes.
    fn input(&self, register: Register) -> Input;
    /// Returns the operand for a register of the program.
    fn load(&self, register: Register) -> Operand;
    /// Returns the operand of a column of the result.
    fn place(&self, column: u32) -> Operand;
    /// Returns the name for the value of a column, such as `rod_phi`; `None` if it has no name of its own.
    fn name(&self, column: u32) -> Option<String>;
    /// Returns the name of a column of a table.
    fn table(&self, table: u32, column: Column) -> Operand;
    /// Returns the registers from which a function builds a table's column; empty if [`table`](Self::table) names it.
    fn cells(&self, table: u32, column: Column) -> Vec<Register>;
    /// Returns whether a column stores values at all.
    fn stores(&self, _column: u32) -> bool {
        true
    }
    /// Returns the line that stores a value in a column, with the arguments that it uses; `None` if the column already holds it.
    fn store(&self, column: u32, value: &Operand) -> Option<(String, Arguments)>;
    /// Returns the line for an operation without a result, with the arguments that it uses.
    fn act(&self, instruction: Instruction, value: &Operand) -> (String, Arguments);
    /// Returns the line that monitors a multiplier, with the arguments that it uses.
    fn watch(&self, weight: u32, value: &Operand) -> (String, Arguments);
    /// Returns whether every number stands for several lanes, which loops iterate.
    fn has_lanes(&self) -> bool {
        false
    }
}

/// Input value of a function.
pub(super) enum Input {
    /// A number, or an expression as short as a name.
    Is(Operand),
    /// Value that is bound to a name first.
    Bound { name: String, value: Operand },
}

/// Function to print; a long one is split into several.
pub(super) struct Function<'f> {
    pub name: &'f str,
    /// Lines of documentation.
    pub docs: String,
    pub is_public: bool,
    /// Names and types.
    pub arguments: Vec<(&'static str, String)>,
    /// Outputs of the function.
    pub out: Out<'f>,
    /// Columns of later indentation.
    pub margin: usize,
}

/// Destination of the results of a function.
pub(super) enum Out<'f> {
    /// A new array that is returned as `out`, with its type and initial value.
    List { of: &'f str, first: &'f str },
    /// An argument; `begin` is the line that prepares it, `names` the arguments that this line uses.
    Given { begin: &'f str, names: Arguments },
}

/// Instructions to print, with their context.
pub(super) struct Code<'c> {
    pub instructions: &'c [Instruction],
    pub segments: &'c [Segment],
    pub registers: usize,
}

impl Code<'_> {
    /// Returns the text of the functions.
    pub fn print(&self, context: &impl CodeContext, function: &Function<'_>) -> String {
        let parts = self.parts(context.has_lanes());
        let mut printer = Printer::new(self, context, &parts);
        match parts.as_slice() {
            [Part::Straight(pieces)] => printer.alone(function, pieces),
            _ => printer.several(function, &parts),
        }
    }

    /// Returns the number of instructions that compute something.
    pub fn count(&self) -> usize {
        self.instructions.iter().filter(|instruction| is_work(**instruction)).count()
    }
}

/// Returns whether an instruction computes something.
fn is_work(instruction: Instruction) -> bool {
    match instruction {
        Instruction::Compute(op) => !matches!(op, Op::Copy { .. }),
        _ => matches!(instruction, Instruction::Multiplier { .. }),
    }
}

/// Names that the printer itself uses.
const OUT: &str = "out";
const TERMS: &str = "w";
const AT: &str = "at";
const GUESS: &str = "guess";
const T: &str = "t";

struct Printer<'p, S> {
    context: &'p S,
    instructions: &'p [Instruction],
    locations: ValueLocations<'p, S>,
    names: Vec<Option<Operand>>,
    taken: FxHashSet<String>,
    /// Inputs that the function being written has bound.
    bound: FxHashSet<Register>,
    bindings: String,
    /// Arguments that the function uses.
    used: FxHashSet<&'static str>,
    /// True if a blank line precedes the first result.
    is_set_off: bool,
    /// Columns of tables that the function has built.
    built: FxHashSet<(u32, Column)>,
    count: usize,
    /// Registers for which Newton's method solves, with the numbers of their coordinates.
    guessed: FxHashMap<Register, u32>,
}

impl<'p, S: CodeContext> Printer<'p, S> {
    fn new(code: &Code<'p>, context: &'p S, parts: &[Part<'p>]) -> Printer<'p, S> {
        Printer {
            context,
            instructions: code.instructions,
            locations: ValueLocations::of(code, context, parts),
            names: vec![None; code.registers],
            taken: FxHashSet::default(),
            bound: FxHashSet::default(),
            bindings: String::new(),
            used: FxHashSet::default(),
            is_set_off: false,
            built: FxHashSet::default(),
            count: 0,
            guessed: FxHashMap::default(),
        }
    }

    /// Returns the operand of a register.
    fn value(&mut self, register: Register) -> Operand {
        let operand = self.operand(register);
        self.used.extend(operand.arguments());
        operand
    }

    /// Returns the operand of a register without counting a use.
    fn operand(&mut self, register: Register) -> Operand {
        if let Some(operand) = &self.names[register as usize] {
            return operand.clone();
        }
        match self.context.input(register) {
            Input::Is(operand) => operand,
            Input::Bound { name, value } => {
                if self.bound.insert(register) {
                    self.used.extend(value.arguments());
                    self.bindings += &format!("    let {name} = {value};\n");
                }
                Operand::local(name)
            }
        }
    }

    /// Returns the target of an operation, which names its register from now on.
    fn target(&mut self, register: Register, prefix: char) -> Target {
        let (operand, target) = match self.locations.location(register) {
            Location::Term(place) => {
                let term = self.term(place);
                self.used.insert(TERMS);
                (term.clone(), Target::Set(term))
            }
            location => {
                let name = Operand::local(self.fresh(register, prefix));
                let is_declared = matches!(location, Location::BeyondLoop { .. });
                (name.clone(), if is_declared { Target::Set(name) } else { Target::Let(name) })
            }
        };
        self.names[register as usize] = Some(operand);
        target
    }

    /// Returns the operand of a term.
    fn term(&self, place: u32) -> Operand {
        let lane = if self.context.has_lanes() { "[k]" } else { "" };
        Operand::new(format!("{TERMS}[{place}]{lane}"), &[TERMS])
    }

    /// Appends a line and records the arguments that it uses.
    fn line(&mut self, indent: &str, (line, names): (String, Arguments), text: &mut String) {
        self.used.extend(names);
        *text += &format!("{indent}{line}\n");
    }

    fn fresh(&mut self, register: Register, prefix: char) -> String {
        match self.locations.result_names[register as usize].take() {
            Some(name) if self.taken.insert(name.clone()) => name,
            _ => format!("{prefix}{}", self.count),
        }
    }

    /// Prints a function that is not split.
    fn alone(&mut self, function: &Function<'_>, pieces: &[Piece<'_>]) -> String {
        self.is_set_off = matches!(function.out, Out::List { .. });
        let (body, mut used) = self.body(pieces);
        let (body, result) = match function.out {
            Out::Given { begin, names } => {
                used.extend(names);
                (format!("    {begin}\n{body}"), "")
            }
            Out::List { of, first } if used.contains(OUT) => {
                (format!("    let mut out = {first};\n{body}    out\n"), of)
            }
            Out::List { of, first } => {
                debug_assert!(body.is_empty(), "nothing of it is left anywhere");
                (format!("    {first}\n"), of)
            }
        };
        head(function, result, &|name| used.contains(name)) + &body + "}\n\n"
    }

    /// Prints a function that calls its parts in turn, and the parts.
    fn several(&mut self, function: &Function<'_>, parts: &[Part<'_>]) -> String {
        let mut arguments = function.arguments.clone();
        let mut given = names(&function.arguments) + ", ";
        if let Out::List { of, .. } = function.out {
            arguments.push((OUT, format!("&mut {of}")));
            given += "&mut out, ";
        }
        let (of, zero) = if self.context.has_lanes() { ("Each", "[0.0; LANES]") } else { ("f64", "0.0") };
        arguments.push((TERMS, format!("&mut [{of}; {}]", self.locations.terms)));
        let attribute = if self.context.has_lanes() { APART } else { "" };
        let (name, margin) = (function.name, function.margin);
        let mut written = Parts { name, arguments: &arguments, margin, attribute, text: String::new(), count: 0 };
        let mut calls = String::new();
        for part in parts {
            let (body, used) = match part {
                Part::Straight(pieces) => self.body(pieces),
                Part::Loop { bodies, tears } => {
                    let mut inner = String::new();
                    for range in bodies {
                        let (body, used) = self.body(&[Piece { range: range.clone(), tears: None }]);
                        let name = written.add(&body, &used);
                        inner += &format!("        {name}({}, {TERMS});\n", names(&function.arguments));
                    }
                    let body = self.around(tears, &inner);
                    self.used.extend(arguments.iter().map(|(name, _)| *name));
                    (body, std::mem::take(&mut self.used))
                }
            };
            if !body.is_empty() {
                calls += &format!("    {}({given}&mut {TERMS});\n", written.add(&body, &used));
            }
        }
        let terms = format!("    let mut {TERMS} = [{zero}; {}];\n", self.locations.terms);
        let (body, result) = match function.out {
            Out::Given { begin, .. } => (format!("    {begin}\n{terms}{calls}"), ""),
            Out::List { of, first } => (format!("    let mut out = {first};\n{terms}{calls}    out\n"), of),
        };
        // the function passes all arguments on
        let head = head(function, result, &|_| !calls.is_empty());
        head + &body + "}\n\n" + &written.text
    }

    /// Returns the body of a function, bindings of inputs first, and the arguments that it uses.
    fn body(&mut self, pieces: &[Piece<'_>]) -> (String, FxHashSet<&'static str>) {
        self.bound.clear();
        self.bindings.clear();
        self.built.clear();
        self.used.clear();
        let mut text = String::new();
        for piece in pieces {
            match piece.tears {
                Some(tears) if self.context.has_lanes() => self.newton_of_lanes(piece.range.clone(), tears, &mut text),
                Some(tears) => self.newton(piece.range.clone(), tears, &mut text),
                None if self.context.has_lanes() => {
                    let mut body = String::new();
                    for at in piece.range.clone() {
                        self.instruction(self.instructions[at], "        ", &mut body);
                    }
                    if !body.is_empty() {
                        text += &format!("    for k in 0..LANES {{\n{body}    }}\n");
                    }
                }
                None => {
                    for at in piece.range.clone() {
                        self.instruction(self.instructions[at], "    ", &mut text);
                    }
                }
            }
        }
        let mut bindings = std::mem::take(&mut self.bindings);
        if !bindings.is_empty() && !text.is_empty() {
            // a blank line separates bindings from computations
            bindings.push('\n');
        }
        (bindings + &text, std::mem::take(&mut self.used))
    }
}

/// Returns the arguments of a call that passes them on.
fn names(arguments: &[(&'static str, String)]) -> String {
    arguments.iter().map(|(name, _)| *name).collect::<Vec<&str>>().join(", ")
}

/// Returns documentation and head of a function; unused arguments begin with `_`.
fn head(function: &Function<'_>, result: &str, is_used: &dyn Fn(&str) -> bool) -> String {
    let arguments: Vec<(&str, &str)> = function.arguments.iter().map(|(name, of)| (*name, of.as_str())).collect();
    let visibility = if function.is_public { "pub " } else { "" };
    documented(&function.docs, "") + &signature(visibility, function.name, &arguments, result, is_used, function.margin)
}

/// Functions into which a long one is split.
struct Parts<'p> {
    name: &'p str,
    arguments: &'p [(&'static str, String)],
    margin: usize,
    attribute: &'p str,
    text: String,
    count: usize,
}

impl Parts<'_> {
    /// Adds one, which uses some of the arguments, and gives its name.
    fn add(&mut self, body: &str, used: &FxHashSet<&str>) -> String {
        self.count += 1;
        let name = format!("{}_{}", self.name, self.count);
        let types: Vec<(&str, &str)> = self.arguments.iter().map(|(name, of)| (*name, of.as_str())).collect();
        self.text += &format!("/// Part {} of [`{}`].\n{}", self.count, self.name, self.attribute);
        self.text += &(signature("", &name, &types, "", &|name| used.contains(name), self.margin) + body + "}\n\n");
        name
    }
}
