//! Operations as Rust, `let` by `let`, in functions of a bearable length.
//!
//! Every register is written by one operation. What one function computes and a later one needs is handed on in an array of
//! terms, `w`.

use super::operand::{Arguments, Operand};
use super::operations::Expression;
use super::text::{LONGEST_LINE, documented, lines, literal, signature};
use crate::math::A_MILLION;
use crate::program::{Column, Op, Register};
use crate::solver::{Instruction, Segment, Tear, from_bits};
use rustc_hash::{FxHashMap, FxHashSet};
use std::fmt::{self, Display, Formatter};
use std::ops::Range;

/// Operations of a function at most: rustc takes more than proportionally longer for longer ones.
const LONGEST_FUNCTION: usize = 2000;
/// Of a loop over lanes, which is to become vector instructions.
const LONGEST_LOOP: usize = 400;

/// What functions of a module within the file are indented by.
pub(super) const MODULE: &str = "    ";

/// A loop over lanes is vectorised if it is known that what it writes does not overlap, as what a function is given does not.
const APART: &str = "#[inline(never)]\n";

/// What operations are printed among.
pub(super) trait Scene {
    /// The name and the value of a register that no operation writes.
    fn input(&self, register: Register) -> Input;
    /// What stands in a register of the program.
    fn load(&self, register: Register) -> Operand;
    /// A column of a result.
    fn place(&self, column: u32) -> Operand;
    /// The name of a value that is left in a column, `rod_phi`; none where it is no name of its own.
    fn name(&self, column: u32) -> Option<String>;
    /// What a column of a table is called.
    fn table(&self, table: u32, column: Column) -> Operand;
    /// The registers that a function has to build a column from; none where it is known by its name.
    fn cells(&self, table: u32, column: Column) -> Vec<Register>;
    /// Whether values are left in a column at all.
    fn stores(&self, _column: u32) -> bool {
        true
    }
    /// The line that leaves a value in a column, with what it names; none where that holds it already.
    fn store(&self, column: u32, value: &Operand) -> Option<(String, Arguments)>;
    /// The line that is written for an operation without a result, with what it names.
    fn act(&self, instruction: Instruction, value: &Operand) -> (String, Arguments);
    /// The line that watches a multiplier, with what it names.
    fn watch(&self, weight: u32, value: &Operand) -> (String, Arguments);
    /// Whether every number stands for several lanes, which loops go over.
    fn has_lanes(&self) -> bool {
        false
    }
}

/// A value that a function is given.
pub(super) enum Input {
    /// A number, or what is as short as a name.
    Is(Operand),
    /// What is bound to a name first.
    Bound { name: String, value: Operand },
}

/// A function, or several that follow one another.
pub(super) struct Function<'f> {
    pub name: &'f str,
    /// Lines of documentation.
    pub docs: String,
    pub is_public: bool,
    /// Names and types.
    pub arguments: Vec<(&'static str, String)>,
    /// What is written and returned.
    pub out: Out<'f>,
    /// Columns that it will be indented by.
    pub margin: usize,
}

/// Where a function leaves its results.
pub(super) enum Out<'f> {
    /// In a list, by its type and its first value, that it returns as `out`.
    List { of: &'f str, first: &'f str },
    /// In what it is given; the line that makes that ready, with what it names.
    Given { begin: &'f str, names: Arguments },
}

/// What is to be printed.
pub(super) struct Code<'c> {
    pub instructions: &'c [Instruction],
    pub segments: &'c [Segment],
    pub registers: usize,
}

/// A run of operations in a function of its own.
enum Part<'c> {
    Straight(Vec<Piece<'c>>),
    /// A loop whose body is so long that it is made of several functions.
    Loop {
        bodies: Vec<Range<usize>>,
        tears: &'c [Tear],
    },
}

struct Piece<'c> {
    range: Range<usize>,
    /// Of a loop.
    tears: Option<&'c [Tear]>,
}

impl<'c> Code<'c> {
    /// The functions as text.
    pub fn print(&self, scene: &impl Scene, function: &Function<'_>) -> String {
        let parts = self.parts(scene.has_lanes());
        let mut printer = Printer::new(self, scene, &parts);
        match parts.as_slice() {
            [Part::Straight(pieces)] => printer.alone(function, pieces),
            _ => printer.several(function, &parts),
        }
    }

    /// How many instructions compute something.
    pub fn count(&self) -> usize {
        self.instructions.iter().filter(|instruction| is_work(**instruction)).count()
    }

    /// Cuts the segments into parts that are short enough; with lanes each loop is a part of its own.
    fn parts(&self, has_lanes: bool) -> Vec<Part<'c>> {
        let longest = if has_lanes { LONGEST_LOOP } else { LONGEST_FUNCTION };
        let mut cut = Cut { parts: Vec::new(), pieces: Vec::new(), length: 0, longest };
        for segment in self.segments {
            match segment {
                Segment::Once(range) => cut.straight(range.clone()),
                Segment::Newton { instructions, tears } if has_lanes => cut.push(instructions.clone(), Some(tears)),
                Segment::Newton { instructions, tears } => cut.newton(instructions.clone(), tears),
            }
            if has_lanes {
                cut.close();
            }
        }
        cut.close();
        if cut.parts.is_empty() {
            cut.parts.push(Part::Straight(Vec::new()));
        }
        cut.parts
    }
}

/// Parts in the making.
struct Cut<'c> {
    parts: Vec<Part<'c>>,
    pieces: Vec<Piece<'c>>,
    length: usize,
    longest: usize,
}

impl<'c> Cut<'c> {
    fn straight(&mut self, range: Range<usize>) {
        let mut from = range.start;
        while from < range.end {
            let to = range.end.min(from + self.longest - self.length);
            self.push(from..to, None);
            from = to;
        }
    }

    fn newton(&mut self, range: Range<usize>, tears: &'c [Tear]) {
        if self.length + range.len() > self.longest {
            self.close();
        }
        if range.len() > LONGEST_FUNCTION {
            let starts = range.clone().step_by(LONGEST_FUNCTION);
            let bodies = starts.map(|from| from..range.end.min(from + LONGEST_FUNCTION)).collect();
            self.parts.push(Part::Loop { bodies, tears });
        } else {
            self.push(range, Some(tears));
        }
    }

    fn push(&mut self, range: Range<usize>, tears: Option<&'c [Tear]>) {
        self.length += range.len();
        self.pieces.push(Piece { range, tears });
        if self.length >= self.longest {
            self.close();
        }
    }

    fn close(&mut self) {
        if !self.pieces.is_empty() {
            self.parts.push(Part::Straight(std::mem::take(&mut self.pieces)));
        }
        self.length = 0;
    }
}

/// Whether an instruction computes something.
fn is_work(instruction: Instruction) -> bool {
    match instruction {
        Instruction::Compute(op) => !matches!(op, Op::Copy { .. }),
        _ => matches!(instruction, Instruction::Multiplier { .. }),
    }
}

/// Arguments that the printer names itself.
const OUT: &str = "out";
const TERMS: &str = "w";
const AT: &str = "at";
const GUESS: &str = "guess";
const T: &str = "t";

/// What a value is assigned to.
enum Target {
    /// A variable of its own.
    Let(Operand),
    /// What is there already.
    Set(Operand),
    /// Nobody asks for it.
    Nobody,
}

impl Target {
    /// What it is called in a pattern.
    fn name(&self) -> String {
        match self {
            Target::Let(name) | Target::Set(name) => name.to_string(),
            Target::Nobody => "_".to_owned(),
        }
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Target::Let(name) => write!(f, "let {name}"),
            Target::Set(name) => write!(f, "{name}"),
            Target::Nobody => f.write_str("let _"),
        }
    }
}

/// Where a value lives.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Home {
    /// Written by no operation.
    Given,
    /// In its function, and there in its loop if it is in one.
    Local { function: u32, of_loop: u32 },
    /// In its function, beyond its loop.
    BeyondLoop { function: u32 },
    /// Among the terms that functions hand on.
    Term(u32),
}

/// No loop.
const STRAIGHT: u32 = 0;
/// No function in particular.
const OTHERS: u32 = u32::MAX;

struct Printer<'p, S> {
    scene: &'p S,
    instructions: &'p [Instruction],
    homes: Vec<Home>,
    is_read: Vec<bool>,
    terms: u32,
    names: Vec<Option<Operand>>,
    /// Names that values shall have.
    wanted: Vec<Option<String>>,
    taken: FxHashSet<String>,
    /// Inputs that the function being written has bound.
    bound: FxHashSet<Register>,
    bindings: String,
    /// The arguments that it names.
    used: FxHashSet<&'static str>,
    /// Whether a blank line comes before the first result.
    is_set_off: bool,
    /// Columns of tables that it has built.
    built: FxHashSet<(u32, Column)>,
    count: usize,
    /// By register: the number of the coordinate that Newton solves for there.
    guessed: FxHashMap<Register, u32>,
}

impl<'p, S: Scene> Printer<'p, S> {
    fn new(code: &Code<'p>, scene: &'p S, parts: &[Part<'p>]) -> Printer<'p, S> {
        let mut printer = Printer {
            scene,
            instructions: code.instructions,
            homes: vec![Home::Given; code.registers],
            is_read: vec![false; code.registers],
            terms: 0,
            names: vec![None; code.registers],
            wanted: vec![None; code.registers],
            taken: FxHashSet::default(),
            bound: FxHashSet::default(),
            bindings: String::new(),
            used: FxHashSet::default(),
            is_set_off: false,
            built: FxHashSet::default(),
            count: 0,
            guessed: FxHashMap::default(),
        };
        printer.find_homes(parts);
        printer
    }

    /// Finds out which values go beyond their loop or function.
    fn find_homes(&mut self, parts: &[Part<'_>]) {
        let (mut function, mut loops) = (0, STRAIGHT);
        for part in parts {
            match part {
                Part::Straight(pieces) => {
                    for piece in pieces {
                        loops += u32::from(piece.tears.is_some());
                        let of_loop = if piece.tears.is_some() { loops } else { STRAIGHT };
                        self.settle_in(piece.range.clone(), function, of_loop);
                        for tear in piece.tears.unwrap_or(&[]) {
                            // in lanes loops beside its own have the corrections too
                            let reader = if self.scene.has_lanes() { OTHERS } else { function };
                            self.read(tear.x, function, STRAIGHT);
                            self.read(tear.delta, reader, STRAIGHT);
                        }
                    }
                }
                Part::Loop { bodies, tears } => {
                    for body in bodies {
                        self.settle_in(body.clone(), function, STRAIGHT);
                        function += 1;
                    }
                    for register in tears.iter().flat_map(|tear| [tear.x, tear.delta]) {
                        self.read(register, function, STRAIGHT);
                    }
                }
            }
            function += 1;
        }
    }

    fn settle_in(&mut self, range: Range<usize>, function: u32, of_loop: u32) {
        for at in range {
            let instruction = self.instructions[at];
            for register in instruction.reads() {
                self.read(register, function, of_loop);
            }
            if let Some((table, column)) = instruction.column() {
                self.scene.cells(table, column).into_iter().for_each(|cell| self.read(cell, function, of_loop));
            }
            for register in instruction.writes() {
                self.homes[register as usize] = Home::Local { function, of_loop };
            }
            if let Instruction::Store { column, a } = instruction
                && self.wanted[a as usize].is_none()
            {
                self.wanted[a as usize] = self.scene.name(column);
            }
        }
    }

    fn read(&mut self, register: Register, reader: u32, reading_loop: u32) {
        self.is_read[register as usize] = true;
        let home = &mut self.homes[register as usize];
        match *home {
            Home::Local { function, .. } | Home::BeyondLoop { function } if function != reader => {
                *home = Home::Term(self.terms);
                self.terms += 1;
            }
            Home::Local { function, of_loop } if of_loop != STRAIGHT && of_loop != reading_loop => {
                *home = Home::BeyondLoop { function };
            }
            _ => {}
        }
    }

    /// A register's value, for a line that holds it.
    fn value(&mut self, register: Register) -> Operand {
        let operand = self.known(register);
        self.used.extend(operand.arguments());
        operand
    }

    /// The same, for nobody yet.
    fn known(&mut self, register: Register) -> Operand {
        if let Some(operand) = &self.names[register as usize] {
            return operand.clone();
        }
        match self.scene.input(register) {
            Input::Is(operand) => operand,
            Input::Bound { name, value } => {
                if self.bound.insert(register) {
                    self.used.extend(value.arguments());
                    self.bindings += &format!("    let {name} = {value};\n");
                }
                Operand::own(name)
            }
        }
    }

    /// What an operation writes to, the register being named so from now on.
    fn target(&mut self, register: Register, prefix: char) -> Target {
        let (operand, target) = match self.homes[register as usize] {
            Home::Term(place) => {
                let term = self.term(place);
                self.used.insert(TERMS);
                (term.clone(), Target::Set(term))
            }
            home => {
                let name = Operand::own(self.fresh(register, prefix));
                let is_declared = matches!(home, Home::BeyondLoop { .. });
                (name.clone(), if is_declared { Target::Set(name) } else { Target::Let(name) })
            }
        };
        self.names[register as usize] = Some(operand);
        target
    }

    /// A place among the terms.
    fn term(&self, place: u32) -> Operand {
        let lane = if self.scene.has_lanes() { "[k]" } else { "" };
        Operand::of(format!("{TERMS}[{place}]{lane}"), &[TERMS])
    }

    /// A line, with what it names.
    fn line(&mut self, indent: &str, (line, names): (String, Arguments), text: &mut String) {
        self.used.extend(names);
        *text += &format!("{indent}{line}\n");
    }

    fn fresh(&mut self, register: Register, prefix: char) -> String {
        match self.wanted[register as usize].take() {
            Some(name) if self.taken.insert(name.clone()) => name,
            _ => format!("{prefix}{}", self.count),
        }
    }

    /// A function that is not cut.
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

    /// A function that calls others in turn, and these.
    fn several(&mut self, function: &Function<'_>, parts: &[Part<'_>]) -> String {
        let mut arguments = function.arguments.clone();
        let mut given = names(&function.arguments) + ", ";
        if let Out::List { of, .. } = function.out {
            arguments.push((OUT, format!("&mut {of}")));
            given += "&mut out, ";
        }
        let (of, zero) = if self.scene.has_lanes() { ("Each", "[0.0; LANES]") } else { ("f64", "0.0") };
        arguments.push((TERMS, format!("&mut [{of}; {}]", self.terms)));
        let attribute = if self.scene.has_lanes() { APART } else { "" };
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
        let terms = format!("    let mut {TERMS} = [{zero}; {}];\n", self.terms);
        let (body, result) = match function.out {
            Out::Given { begin, .. } => (format!("    {begin}\n{terms}{calls}"), ""),
            Out::List { of, first } => (format!("    let mut out = {first};\n{terms}{calls}    out\n"), of),
        };
        // it hands all on
        let head = head(function, result, &|_| !calls.is_empty());
        head + &body + "}\n\n" + &written.text
    }

    /// The body of a function: what it is given, and then its lines; with the arguments that it names.
    fn body(&mut self, pieces: &[Piece<'_>]) -> (String, FxHashSet<&'static str>) {
        self.bound.clear();
        self.bindings.clear();
        self.built.clear();
        self.used.clear();
        let mut text = String::new();
        for piece in pieces {
            match piece.tears {
                Some(tears) if self.scene.has_lanes() => self.newton_of_lanes(piece.range.clone(), tears, &mut text),
                Some(tears) => self.newton(piece.range.clone(), tears, &mut text),
                None if self.scene.has_lanes() => {
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
            // what is given, and what is made of it
            bindings.push('\n');
        }
        (bindings + &text, std::mem::take(&mut self.used))
    }

    fn newton(&mut self, range: Range<usize>, tears: &[Tear], text: &mut String) {
        let mut body = String::new();
        for at in range.clone() {
            self.instruction(self.instructions[at], "        ", &mut body);
        }
        for at in range {
            for register in self.instructions[at].writes() {
                if let (Home::BeyondLoop { .. }, Some(name)) =
                    (self.homes[register as usize], &self.names[register as usize])
                {
                    *text += &format!("    let mut {name} = 0.0;\n");
                }
            }
        }
        *text += &self.around(tears, &body);
    }

    /// Newton in all lanes.
    fn newton_of_lanes(&mut self, range: Range<usize>, tears: &[Tear], text: &mut String) {
        let mut places = Vec::new();
        let (mut begin, mut before) = (String::new(), String::new());
        for (number, tear) in tears.iter().enumerate() {
            let (place, name) = (self.value(tear.x), format!("x{}", number + 1));
            begin += &format!("        {place} = on_grid({place}, {});\n", literal(tear.cell));
            before += &format!("            let {name} = {place};\n");
            self.used.extend(place.arguments());
            places.push(place);
            self.names[tear.x as usize] = Some(Operand::own(name));
        }
        let mut body = String::new();
        for at in range {
            self.instruction(self.instructions[at], "            ", &mut body);
        }
        let (mut after, mut go_on, mut end) = (String::new(), String::new(), String::new());
        for (tear, place) in tears.iter().zip(places) {
            let delta = self.value(tear.delta);
            let number = self.guessed.get(&tear.x).copied().unwrap_or(0);
            let (cell, scale) = (format!("TEAR_CELLS[{number}]"), format!("TEAR_SCALES[{number}]"));
            after += &format!("            newton.see(k, {delta}, {cell}, {scale});\n");
            go_on += &format!("            {place} = newton.next(k, {place}, {delta}, {cell});\n");
            end += &format!("        {place} += {delta};\n");
            self.names[tear.x as usize] = Some(place);
        }
        self.used.insert(AT);
        let lanes = "for k in 0..LANES {\n";
        *text += &format!(
            "    {lanes}{begin}    }}\n    let mut newton = Settling::new();\n    for _ in 0..ITERATIONS {{\n        \
             {lanes}{before}{body}{after}        }}\n        if newton.is_done() {{\n            break;\n        }}\n        \
             {lanes}{go_on}        }}\n    }}\n    newton.note(at);\n    {lanes}{end}    }}\n"
        );
    }

    /// A loop around a body.
    fn around(&mut self, tears: &[Tear], body: &str) -> String {
        let (mut begin, mut after, mut go_on, mut end) = (String::new(), String::new(), String::new(), String::new());
        for tear in tears {
            let (x, delta) = (self.value(tear.x), self.value(tear.delta));
            let (cell, scale) = (literal(tear.cell), literal(tear.scale));
            begin += &format!("    {x} = on_grid({x}, {cell});\n");
            after += &format!("        newton.see({delta}, {cell}, {scale});\n");
            go_on += &format!("        {x} = newton.next({x}, {delta}, {cell});\n");
            end += &format!("    {x} += {delta};\n");
        }
        self.used.insert(AT);
        format!(
            "{begin}    let mut newton = Newton::new();\n    for _ in 0..ITERATIONS {{\n{body}{after}        \
             if newton.is_done() {{\n            break;\n        }}\n{go_on}    }}\n    at.note(&newton);\n{end}"
        )
    }

    /// What a column of a table is called, after it has been built where that is needed.
    fn column(&mut self, table: u32, column: Column, indent: &str, text: &mut String) -> String {
        let (name, cells) = (self.scene.table(table, column), self.scene.cells(table, column));
        self.used.extend(name.arguments());
        if cells.is_empty() {
            return format!("&{name}");
        }
        if self.built.insert((table, column)) {
            let values: Vec<String> = cells.into_iter().map(|cell| self.value(cell).to_string()).collect();
            *text +=
                &format!("{indent}#[rustfmt::skip]\n{indent}let {name} = [\n{}{indent}];\n", lines(&values, indent));
        }
        format!("&{name}")
    }

    fn instruction(&mut self, instruction: Instruction, indent: &str, text: &mut String) {
        match instruction {
            Instruction::Compute(op) => self.operation(op, indent, text),
            Instruction::Multiplier { to, a, b, weight } => {
                self.operation(Op::Mul { to, a, b }, indent, text);
                let value = self.value(to);
                self.line(indent, self.scene.watch(weight, &value), text);
            }
            Instruction::Number { to, bits } => self.names[to as usize] = Some(Operand::Number(from_bits(bits))),
            Instruction::Load { to, from } => self.load(to, from, indent, text),
            Instruction::Time { to } => {
                let lane = if self.scene.has_lanes() { "[k]" } else { "" };
                self.names[to as usize] = Some(Operand::of(format!("{T}{lane}"), &[T]));
            }
            Instruction::Column { to, column } => self.names[to as usize] = Some(self.scene.place(column)),
            Instruction::Curve { to, tear } => self.guess(to, tear, indent, text),
            Instruction::Residual { a, .. } | Instruction::Pivot { a, .. } => {
                let value = self.value(a);
                self.line(indent, self.scene.act(instruction, &value), text);
            }
            Instruction::Store { column, a } => self.store(column, a, indent, text),
        }
    }

    fn store(&mut self, column: u32, a: Register, indent: &str, text: &mut String) {
        if !self.scene.stores(column) {
            return;
        }
        let value = self.known(a);
        if let Some(line) = self.scene.store(column, &value) {
            self.used.extend(value.arguments());
            // what is worked out, and what comes of it
            if std::mem::take(&mut self.is_set_off) && !text.is_empty() {
                text.push('\n');
            }
            self.line(indent, line, text);
        }
    }

    fn operation(&mut self, op: Op, indent: &str, text: &mut String) {
        if let Op::SinCos { sin, cos, a } = op {
            return self.pair(sin, cos, a, indent, text);
        }
        if let Op::Copy { to, a } = op {
            return self.copy(to, a, indent, text);
        }
        let column = op.column().map(|(table, column)| self.column(table, column, indent, text)).unwrap_or_default();
        let mut expression = Expression { value: |register| self.value(register).to_string(), column, result: None };
        op.run(&mut expression);
        let Some((to, expression)) = expression.result else {
            return;
        };
        self.count += 1;
        let target = self.target(to, 'v');
        *text += &self.assigned(indent, &target.to_string(), &expression);
    }

    /// A value of the program, by a name of its own if it is long.
    fn load(&mut self, to: Register, from: Register, indent: &str, text: &mut String) {
        let value = self.scene.load(from);
        if value.is_short() {
            self.names[to as usize] = Some(value);
        } else {
            self.count += 1;
            self.used.extend(value.arguments());
            let target = self.target(to, 'v');
            *text += &format!("{indent}{target} = {value};\n");
        }
    }

    /// An assignment, on two lines if it is too long for one.
    fn assigned(&self, indent: &str, target: &str, expression: &str) -> String {
        let line = format!("{indent}{target} = {expression};\n");
        let margin = if self.scene.has_lanes() { MODULE.len() } else { 0 };
        if line.len() + margin <= LONGEST_LINE + 1 {
            return line;
        }
        format!("{indent}{target} =\n{indent}    {expression};\n")
    }

    /// Another name for the same value; where a later function needs it, a place among the terms.
    fn copy(&mut self, to: Register, a: Register, indent: &str, text: &mut String) {
        if let Home::Term(_) = self.homes[to as usize] {
            let value = self.value(a);
            let target = self.target(to, 'v');
            *text += &format!("{indent}{target} = {value};\n");
        } else {
            self.names[to as usize] = Some(self.known(a));
        }
    }

    /// Where Newton begins with a coordinate.
    fn guess(&mut self, to: Register, tear: u32, indent: &str, text: &mut String) {
        self.guessed.insert(to, tear);
        self.used.insert(GUESS);
        let lane = if self.scene.has_lanes() { "[k]" } else { "" };
        if let Home::Term(place) = self.homes[to as usize] {
            let term = self.term(place);
            self.used.insert(TERMS);
            *text += &format!("{indent}{term} = {GUESS}[{tear}]{lane};\n");
            self.names[to as usize] = Some(term);
        } else {
            let name = format!("x{}", self.guessed.len());
            *text += &format!("{indent}let mut {name} = {GUESS}[{tear}];\n");
            self.names[to as usize] = Some(Operand::own(name));
        }
    }

    fn pair(&mut self, sin: Register, cos: Register, a: Register, indent: &str, text: &mut String) {
        let a = self.value(a);
        self.count += 1;
        if self.scene.has_lanes() {
            self.used.insert(AT);
            // times this, rounded, it is above 1 from a million itself on
            let per_million = (1.0 / A_MILLION).next_up();
            *text += &format!("{indent}at.watch(k, {a}, {});\n", literal(per_million));
        }
        let sin_cos = if self.scene.has_lanes() { "sin_cos_below_a_million" } else { "sin_cos" };
        let target = |printer: &mut Self, register: Register, prefix: char| {
            if printer.is_read[register as usize] { printer.target(register, prefix) } else { Target::Nobody }
        };
        let targets = [target(self, sin, 's'), target(self, cos, 'c')];
        *text += &match &targets {
            [Target::Set(sin), Target::Set(cos)] => format!("{indent}({sin}, {cos}) = {sin_cos}({a});\n"),
            [Target::Set(_), _] | [_, Target::Set(_)] => {
                let name = format!("pair{}", self.count);
                let [sin, cos] = &targets;
                format!("{indent}let {name} = {sin_cos}({a});\n{indent}{sin} = {name}.0;\n{indent}{cos} = {name}.1;\n")
            }
            [sin, cos] => format!("{indent}let ({}, {}) = {sin_cos}({a});\n", sin.name(), cos.name()),
        };
    }
}

/// The names of arguments, as they are handed on.
fn names(arguments: &[(&'static str, String)]) -> String {
    arguments.iter().map(|(name, _)| *name).collect::<Vec<&str>>().join(", ")
}

/// Documentation and head of a function; an argument that is not used is marked.
fn head(function: &Function<'_>, result: &str, is_used: &dyn Fn(&str) -> bool) -> String {
    let arguments: Vec<(&str, &str)> = function.arguments.iter().map(|(name, of)| (*name, of.as_str())).collect();
    let visibility = if function.is_public { "pub " } else { "" };
    documented(&function.docs, "") + &signature(visibility, function.name, &arguments, result, is_used, function.margin)
}

/// The functions that a long one is cut into.
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
