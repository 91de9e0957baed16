//! Instructions, line by line.

use super::value_locations::Location;
use super::{AT, CodeContext, GUESS, MODULE, Printer, T, TERMS};
use crate::operand::Operand;
use crate::operations::Expression;
use crate::text::{LONGEST_LINE, lines, literal};
use mechc_engine::solver::{Instruction, from_bits};
use mechc_expr::math::A_MILLION;
use mechc_ir::program::{Column, Op, Register};
use std::fmt::{self, Display, Formatter};

/// Target of an assignment.
pub(super) enum Target {
    /// New variable.
    Let(Operand),
    /// Existing operand.
    Set(Operand),
    /// Unused value.
    Discard,
}

impl Target {
    /// Returns its name in a pattern.
    fn name(&self) -> String {
        match self {
            Target::Let(name) | Target::Set(name) => name.to_string(),
            Target::Discard => "_".to_owned(),
        }
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Target::Let(name) => write!(f, "let {name}"),
            Target::Set(name) => write!(f, "{name}"),
            Target::Discard => f.write_str("let _"),
        }
    }
}

impl<S: CodeContext> Printer<'_, S> {
    /// Returns the name of a column of a table, and builds the column first if necessary.
    fn column(&mut self, table: u32, column: Column, indent: &str, text: &mut String) -> String {
        let (name, cells) = (self.context.table(table, column), self.context.cells(table, column));
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

    pub(super) fn instruction(&mut self, instruction: Instruction, indent: &str, text: &mut String) {
        match instruction {
            Instruction::Compute(op) => self.operation(op, indent, text),
            Instruction::Multiplier { to, a, b, weight } => {
                self.operation(Op::Mul { to, a, b }, indent, text);
                let value = self.value(to);
                self.line(indent, self.context.watch(weight, &value), text);
            }
            Instruction::Number { to, bits } => self.names[to as usize] = Some(Operand::Number(from_bits(bits))),
            Instruction::Load { to, from } => self.load(to, from, indent, text),
            Instruction::Time { to } => {
                let lane = if self.context.has_lanes() { "[k]" } else { "" };
                self.names[to as usize] = Some(Operand::new(format!("{T}{lane}"), &[T]));
            }
            Instruction::Column { to, column } => self.names[to as usize] = Some(self.context.place(column)),
            Instruction::Curve { to, tear } => self.guess(to, tear, indent, text),
            Instruction::Residual { a, .. } | Instruction::Pivot { a, .. } => {
                let value = self.value(a);
                self.line(indent, self.context.act(instruction, &value), text);
            }
            Instruction::Store { column, a } => self.store(column, a, indent, text),
            // code monitors branches by itself
            Instruction::Monitor { .. } => {}
        }
    }

    fn store(&mut self, column: u32, a: Register, indent: &str, text: &mut String) {
        if !self.context.stores(column) {
            return;
        }
        let value = self.operand(a);
        if let Some(line) = self.context.store(column, &value) {
            self.used.extend(value.arguments());
            // a blank line separates computations from results
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

    /// Appends the load of an input, bound to a name if its text is long.
    fn load(&mut self, to: Register, from: Register, indent: &str, text: &mut String) {
        let value = self.context.load(from);
        if value.is_short() {
            self.names[to as usize] = Some(value);
        } else {
            self.count += 1;
            self.used.extend(value.arguments());
            let target = self.target(to, 'v');
            *text += &format!("{indent}{target} = {value};\n");
        }
    }

    /// Returns an assignment, on two lines if it is too long for one.
    fn assigned(&self, indent: &str, target: &str, expression: &str) -> String {
        let line = format!("{indent}{target} = {expression};\n");
        let margin = if self.context.has_lanes() { MODULE.len() } else { 0 };
        if line.len() + margin <= LONGEST_LINE + 1 {
            return line;
        }
        format!("{indent}{target} =\n{indent}    {expression};\n")
    }

    /// Appends a copy of a value: an alias, or an assignment to a term if a later function needs it.
    fn copy(&mut self, to: Register, a: Register, indent: &str, text: &mut String) {
        if let Location::Term(_) = self.locations.location(to) {
            let value = self.value(a);
            let target = self.target(to, 'v');
            *text += &format!("{indent}{target} = {value};\n");
        } else {
            self.names[to as usize] = Some(self.operand(a));
        }
    }

    /// Prints the initial guess of Newton's method for a coordinate.
    fn guess(&mut self, to: Register, tear: u32, indent: &str, text: &mut String) {
        self.guessed.insert(to, tear);
        self.used.insert(GUESS);
        let lane = if self.context.has_lanes() { "[k]" } else { "" };
        if let Location::Term(place) = self.locations.location(to) {
            let term = self.term(place);
            self.used.insert(TERMS);
            *text += &format!("{indent}{term} = {GUESS}[{tear}]{lane};\n");
            self.names[to as usize] = Some(term);
        } else {
            let name = format!("x{}", self.guessed.len());
            *text += &format!("{indent}let mut {name} = {GUESS}[{tear}];\n");
            self.names[to as usize] = Some(Operand::local(name));
        }
    }

    fn pair(&mut self, sin: Register, cos: Register, a: Register, indent: &str, text: &mut String) {
        let a = self.value(a);
        self.count += 1;
        if self.context.has_lanes() {
            self.used.insert(AT);
            // times this, rounded, it is above 1 from a million itself on
            let per_million = (1.0 / A_MILLION).next_up();
            *text += &format!("{indent}at.watch(k, {a}, {});\n", literal(per_million));
        }
        let sin_cos = if self.context.has_lanes() { "sin_cos_below_a_million" } else { "sin_cos" };
        let target = |printer: &mut Self, register: Register, prefix: char| {
            if printer.locations.is_read(register) { printer.target(register, prefix) } else { Target::Discard }
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
