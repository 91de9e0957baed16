//! Rust that evaluates `Φ`, `Φ_q`, `Φ_t`, `ν` and `γ`.

use super::names::Namer;
use super::slice::slice;
use super::tables::{self, COLUMNS};
use crate::expr::{Binary, Comparison, Unary};
use crate::ir::ConstraintSystem;
use crate::program::{Column, Op, Program, Register};
use rustc_hash::FxHashMap;

/// The sine-cosine pair, word for word as the interpreter runs it.
const SIN_COS: &str = include_str!("../math/sin_cos.rs");

/// Systems up to this many coordinates get their Jacobian as a full matrix too.
const LARGEST_DENSE: usize = 64;

/// Input names longer than this would make lines that a formatter breaks.
const LONGEST_NAME: usize = 20;

/// One Rust module, self-contained but for the `libm` crate where a formula asks for it.
///
/// `file` is the name of the source for the header.
#[must_use]
pub fn rust(system: &ConstraintSystem, program: &Program, file: &str) -> String {
    let writer = Writer::new(system, program);
    let functions = writer.functions();
    let mut text = writer.header(file, functions.contains("libm::"));
    text += &writer.params();
    text += &writer.indices();
    text += &writer.tables();
    text += &functions;
    text += &helpers(&functions);
    text.trim_end().to_owned() + "\n"
}

struct Writer<'s> {
    system: &'s ConstraintSystem,
    program: &'s Program,
    constants: FxHashMap<Register, f64>,
    params: Vec<String>,
    tables: tables::Names,
}

/// What a function is given, and what it gives back.
struct Function<'f> {
    name: &'f str,
    docs: &'f str,
    velocities: bool,
    length: &'f str,
    outputs: &'f [Register],
    negated: bool,
}

impl<'s> Writer<'s> {
    fn new(system: &'s ConstraintSystem, program: &'s Program) -> Writer<'s> {
        let mut namer = Namer::default();
        Writer {
            params: system.params.iter().map(|param| namer.snake(&param.name)).collect(),
            constants: program.constants().iter().copied().collect(),
            tables: tables::Names::new(program),
            system,
            program,
        }
    }

    fn header(&self, file: &str, needs_libm: bool) -> String {
        let (n, entries) = (self.system.coordinates.len(), self.system.phi_q.entries().len());
        let mut text = format!(
            "//! Constraint system of mechanism `{}`, written by mechc {} from `{}`.\n//!\n",
            one_line(&self.system.name),
            env!("CARGO_PKG_VERSION"),
            one_line(file),
        );
        text += &format!("//! - coordinates `q`: {n} (m, rad), equations `phi = 0`: {}\n", self.system.rows.len());
        text += &format!("//! - `phi_q`: {entries} entries that do not vanish, see [`PHI_Q_PATTERN`]\n");
        text +=
            &format!("//! - parameters: {}; those that follow from others are worked out\n", self.system.params.len());
        text += if needs_libm {
            "//! - needs the crate `libm`, for elementary functions with the same bits on every platform\n"
        } else {
            "//! - needs no other crate\n"
        };
        // a parameter of 3.14 is no approximation of pi, and a formula may hold what the parameters make trivial
        text + "\n#![allow(clippy::approx_constant, clippy::eq_op)]\n#![allow(clippy::excessive_precision, clippy::large_const_arrays)]\n\n"
    }

    fn params(&self) -> String {
        if self.params.is_empty() {
            return "/// The mechanism has no parameters.\n#[derive(Clone, Copy, Debug, Default, PartialEq)]\npub struct Params;\n\n"
                .to_owned();
        }
        let mut text = "/// The parameters, in SI; those of the file by default.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Params {\n".to_owned();
        for (name, param) in self.params.iter().zip(&self.system.params) {
            text += &format!("    /// `{}` ({})\n    pub {name}: f64,\n", one_line(&param.name), param.unit);
        }
        text += "}\n\nimpl Default for Params {\n    #[rustfmt::skip]\n    fn default() -> Self {\n        Self {\n";
        for (name, param) in self.params.iter().zip(&self.system.params) {
            text += &format!("            {name}: {},\n", literal(param.value));
        }
        text + "        }\n    }\n}\n\n"
    }

    fn indices(&self) -> String {
        let (n, entries) = (self.system.coordinates.len(), self.system.phi_q.entries().len());
        let mut text = format!(
            "/// Number of coordinates, and of equations.\npub const N: usize = {n};\n\n\
             /// Number of entries of `phi_q` that do not vanish.\npub const ENTRIES: usize = {entries};\n\n\
             /// Where each coordinate stands in `q`.\npub mod coordinate {{\n"
        );
        let mut namer = Namer::default();
        for (k, coordinate) in self.system.coordinates.iter().enumerate() {
            let unit = match coordinate.kind.unit() {
                "" => "a pure number",
                unit => unit,
            };
            let name = namer.constant(&coordinate.name);
            text += &format!("    /// `{}` ({unit})\n    pub const {name}: usize = {k};\n", coordinate.name);
        }
        text += "}\n\n/// Which equation each joint, constraint or driver wrote.\npub mod row {\n";
        let mut namer = Namer::default();
        for k in 0..self.system.rows.len() {
            let row = self.system.row_name(k);
            let name = namer.constant(&row);
            let kind = self.system.declaration_of(k).kind.noun();
            text += &format!("    /// {kind} `{row}`\n    pub const {name}: usize = {k};\n");
        }
        text += "}\n\n/// Row and column of each value that [`phi_q`] gives.\n#[rustfmt::skip]\n";
        text += "pub const PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [\n";
        for row in 0..self.system.rows.len() {
            for (column, _) in self.system.phi_q.row(row) {
                text += &format!("    ({row}, {column}),\n");
            }
        }
        text + "];\n\n"
    }

    /// The tables' columns that hold numbers alone.
    fn tables(&self) -> String {
        let mut text = String::new();
        for (number, table) in self.program.tables().iter().enumerate() {
            for column in COLUMNS {
                let number = number as u32;
                let Some(values) = tables::numbers(self.program, &self.constants, number, column) else {
                    continue;
                };
                let what = match column {
                    Column::Knots => "where its pieces begin, and where the last one ends".to_owned(),
                    Column::Coefficient(order) => format!("coefficient {order} of each piece"),
                };
                let values: Vec<String> = values.into_iter().map(literal).collect();
                text += &format!(
                    "/// Table `{}`: {what}.\n#[rustfmt::skip]\nstatic {}: [f64; {}] = [\n{}];\n\n",
                    one_line(&table.name),
                    self.tables.of(number, column),
                    values.len(),
                    tables::lines(&values, ""),
                );
            }
        }
        text
    }

    fn functions(&self) -> String {
        let outputs = &self.program.outputs;
        let function = |name, docs, velocities, length, outputs, negated| {
            self.function(&Function { name, docs, velocities, length, outputs, negated })
        };
        let mut text =
            function("phi", "The residual of the equations (m, m^2 or rad).", false, "N", &outputs.phi, false);
        let docs = "The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`].";
        text += &function("phi_q", docs, false, "ENTRIES", &outputs.phi_q, false);
        text += &function("phi_t", "The partial derivative of `phi` by time.", false, "N", &outputs.nu, true);
        text += &function("nu", "Right side of the velocity equation `phi_q qd = nu`.", false, "N", &outputs.nu, false);
        let docs = "Right side of the acceleration equation `phi_q qdd = gamma`.";
        text += &function("gamma", docs, true, "N", &outputs.gamma, false);
        if self.system.coordinates.len() <= LARGEST_DENSE {
            text += "/// The Jacobian as a full matrix, row by row.\n\
                pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {\n    \
                let mut full = [[0.0; N]; N];\n    \
                for ((row, column), value) in PHI_Q_PATTERN.into_iter().zip(phi_q(q, t, p)) {\n        \
                full[row][column] = value;\n    }\n    full\n}\n\n";
        }
        text
    }

    fn function(&self, function: &Function<'_>) -> String {
        let (ops, read) = slice(self.program, function.outputs);
        let mut body = Body {
            writer: self,
            read: &read,
            names: FxHashMap::default(),
            arrays: FxHashMap::default(),
            text: String::new(),
            count: 0,
        };
        let used = body.inputs();
        for op in &ops {
            body.operation(*op);
        }
        let mark = |used: bool, name: &str| if used { name.to_owned() } else { format!("_{name}") };
        let [q, qd, t, p] = used;
        let mut arguments = vec![format!("{}: &[f64; N]", mark(q, "q"))];
        if function.velocities {
            arguments.push(format!("{}: &[f64; N]", mark(qd, "qd")));
        }
        arguments.push(format!("{}: f64", mark(t, "t")));
        arguments.push(format!("{}: &Params", mark(p, "p")));
        let mut text = format!(
            "/// {}\n///\n/// {} operations.\npub fn {}({}) -> [f64; {}] {{\n",
            function.docs,
            ops.len(),
            function.name,
            arguments.join(", "),
            function.length
        );
        text += &body.text;
        let results: Vec<(usize, String)> = function
            .outputs
            .iter()
            .enumerate()
            .map(|(k, &register)| (k, body.result(register, function.negated)))
            .filter(|(_, value)| value != "0.0")
            .collect();
        text += if results.is_empty() { "    [0.0; " } else { "    let mut out = [0.0; " };
        text += function.length;
        text += if results.is_empty() { "]\n" } else { "];\n" };
        for (k, value) in &results {
            text += &format!("    out[{k}] = {value};\n");
        }
        if !results.is_empty() {
            text += "    out\n";
        }
        text + "}\n\n"
    }
}

/// The body of one function, let by let.
struct Body<'w, 's> {
    writer: &'w Writer<'s>,
    /// Which registers are read at all.
    read: &'w [bool],
    names: FxHashMap<Register, String>,
    /// Columns of parameters that have been built.
    arrays: FxHashMap<(u32, Column), String>,
    text: String,
    count: usize,
}

impl Body<'_, '_> {
    /// Binds the inputs that are read; says whether any is of `q`, of `q̇`, is `t`, is a parameter.
    fn inputs(&mut self) -> [bool; 4] {
        let read = self.read;
        let (system, inputs) = (self.writer.system, self.writer.program.inputs);
        let mut namer = Namer::default();
        for taken in
            ["q", "qd", "t", "p", "out", "sin_cos", "select", "either", "sign", "lesser", "greater", "piece", "pick"]
        {
            namer.snake(taken);
        }
        let mut used = [false; 4];
        let mut bind = |body: &mut Self, register: Register, wanted: &str, short: String, value: String| {
            if !read[register as usize] {
                return false;
            }
            // what begins like a temporary could be mistaken for one
            let is_plain = wanted.len() <= LONGEST_NAME && !wanted.starts_with(['v', 's', 'c']);
            let name = namer.snake(if is_plain { wanted } else { &short });
            body.text += &format!("    let {name} = {value};\n");
            body.names.insert(register, name);
            true
        };
        for (k, name) in self.writer.params.iter().enumerate() {
            used[3] |= bind(self, inputs.params + k as u32, name, format!("p{k}"), format!("p.{name}"));
        }
        for (order, array) in [(0, "q"), (1, "qd")] {
            for (k, coordinate) in system.coordinates.iter().enumerate() {
                let end = if order == 0 { "" } else { "_d" };
                let name = Namer::default().snake(&format!("{}{end}", coordinate.name));
                let register = inputs.coordinates[order] + k as u32;
                used[order] |= bind(self, register, &name, format!("{array}{k}"), format!("{array}[{k}]"));
            }
        }
        if read[inputs.time as usize] {
            used[2] = true;
            self.names.insert(inputs.time, "t".to_owned());
        }
        used
    }

    fn value(&self, register: Register) -> String {
        match self.writer.constants.get(&register) {
            Some(&value) => literal(value),
            None => self.names.get(&register).cloned().unwrap_or_default(),
        }
    }

    /// An output, or its opposite.
    fn result(&self, register: Register, negated: bool) -> String {
        match (self.writer.constants.get(&register), negated) {
            (Some(&value), true) => literal(-value + 0.0),
            (None, true) => format!("-{}", self.value(register)),
            (_, false) => self.value(register),
        }
    }

    /// What a column of a table is called here; one that holds parameters is built at its first use.
    fn column(&mut self, table: u32, column: Column) -> String {
        let writer = self.writer;
        let name = writer.tables.of(table, column);
        if tables::numbers(writer.program, &writer.constants, table, column).is_some() {
            return name.to_owned();
        }
        if let Some(name) = self.arrays.get(&(table, column)) {
            return name.clone();
        }
        let local = name.to_lowercase();
        let cells = writer.program.tables()[table as usize].column(column);
        let values: Vec<String> = cells.map(|register| self.value(register)).collect();
        self.text += &format!("    #[rustfmt::skip]\n    let {local} = [\n{}    ];\n", tables::lines(&values, "    "));
        self.arrays.insert((table, column), local.clone());
        local
    }

    fn operation(&mut self, op: Op) {
        match op {
            // another name for the same value
            Op::Copy { to, a } => {
                let value = self.value(a);
                self.names.insert(to, value);
                return;
            }
            Op::Piece { table, .. } => {
                self.column(table, Column::Knots);
            }
            Op::Pick { table, column, .. } => {
                self.column(table, column);
            }
            _ => {}
        }
        let column = |table: u32, column: Column| {
            self.arrays.get(&(table, column)).map_or(self.writer.tables.of(table, column), String::as_str)
        };
        let v = |register: Register| self.value(register);
        let value = match op {
            Op::Add { a, b, .. } => format!("{} + {}", v(a), v(b)),
            Op::Sub { a, b, .. } => format!("{} - {}", v(a), v(b)),
            Op::Mul { a, b, .. } => format!("{} * {}", v(a), v(b)),
            Op::Div { a, b, .. } => format!("{} / {}", v(a), v(b)),
            Op::Neg { a, .. } => format!("-{}", v(a)),
            Op::Recip { a, .. } => format!("1.0 / {}", v(a)),
            Op::SinCos { a, .. } => format!("sin_cos({})", v(a)),
            Op::Unary { function, a, .. } => unary(function, &v(a)),
            Op::Binary { function, a, b, .. } => binary(function, &v(a), &v(b)),
            Op::Compare { comparison, a, b, .. } => {
                let operator = match comparison {
                    Comparison::Less => "<",
                    Comparison::LessEqual => "<=",
                    Comparison::Equal => "==",
                };
                format!("f64::from({} {operator} {})", v(a), v(b))
            }
            Op::And { a, b, .. } => format!("f64::from({} != 0.0 && {} != 0.0)", v(a), v(b)),
            Op::Or { a, b, .. } => format!("f64::from({} != 0.0 || {} != 0.0)", v(a), v(b)),
            Op::Not { a, .. } => format!("f64::from({} == 0.0)", v(a)),
            Op::Select { condition, a, b, .. } => format!("select({}, {}, {})", v(condition), v(a), v(b)),
            Op::Either { condition, a, b, .. } => format!("either({}, {}, {})", v(condition), v(a), v(b)),
            Op::Copy { a, .. } => v(a),
            Op::Piece { table, a, .. } => format!("piece({}, &{})", v(a), column(table, Column::Knots)),
            Op::Pick { table, column: of, piece, .. } => format!("pick(&{}, {})", column(table, of), v(piece)),
        };
        self.count += 1;
        let k = self.count;
        if let Op::SinCos { sin, cos, .. } = op {
            let name = |letter: char, register: Register| {
                if self.read[register as usize] { format!("{letter}{k}") } else { "_".to_owned() }
            };
            let (sin_name, cos_name) = (name('s', sin), name('c', cos));
            self.text += &format!("    let ({sin_name}, {cos_name}) = {value};\n");
            self.names.insert(sin, sin_name);
            self.names.insert(cos, cos_name);
        } else {
            self.text += &format!("    let v{k} = {value};\n");
            for register in self.writer.program.operands(op).1 {
                self.names.insert(register, format!("v{k}"));
            }
        }
    }
}

fn unary(function: Unary, a: &str) -> String {
    match function {
        Unary::Sin => format!("sin_cos({a}).0"),
        Unary::Cos => format!("sin_cos({a}).1"),
        Unary::Sqrt | Unary::Abs | Unary::Floor => format!("f64::{}({a})", function.word()),
        Unary::Sign => format!("sign({a})"),
        Unary::Ln => format!("libm::log({a})"),
        _ => format!("libm::{}({a})", function.word()),
    }
}

fn binary(function: Binary, a: &str, b: &str) -> String {
    match function {
        Binary::Min => format!("lesser({a}, {b})"),
        Binary::Max => format!("greater({a}, {b})"),
        _ => format!("libm::{}({a}, {b})", function.word()),
    }
}

/// The functions of our own that the others call.
fn helpers(functions: &str) -> String {
    const HELPERS: [(&str, &str); 7] = [
        (
            "select(",
            "/// The second if the first is not 0, else the third.\nfn select(condition: f64, a: f64, b: f64) -> f64 {\n    if condition == 0.0 { b } else { a }\n}\n\n",
        ),
        (
            "either(",
            "/// As `select`, but not a number if either is not.\nfn either(condition: f64, a: f64, b: f64) -> f64 {\n    if a.is_nan() || b.is_nan() {\n        f64::NAN\n    } else if condition == 0.0 {\n        b\n    } else {\n        a\n    }\n}\n\n",
        ),
        (
            "piece(",
            "/// The piece of a table that `x` lies in, counted from 0.\nfn piece(x: f64, knots: &[f64]) -> f64 {\n    if x.is_nan() {\n        return x;\n    }\n    let (mut low, mut high) = (0, knots.len() - 1);\n    while high - low > 1 {\n        let middle = low + (high - low) / 2;\n        if knots.get(middle).is_some_and(|knot| *knot <= x) {\n            low = middle;\n        } else {\n            high = middle;\n        }\n    }\n    low as f64\n}\n\n",
        ),
        (
            "pick(",
            "/// The entry of a column for a piece.\nfn pick(column: &[f64], piece: f64) -> f64 {\n    if piece.is_nan() {\n        return piece;\n    }\n    column.get(piece as usize).copied().unwrap_or(f64::NAN)\n}\n\n",
        ),
        (
            "sign(",
            "/// -1, 0 or 1; 0 at 0.\nfn sign(x: f64) -> f64 {\n    if x > 0.0 {\n        1.0\n    } else if x < 0.0 {\n        -1.0\n    } else {\n        x\n    }\n}\n\n",
        ),
        (
            "lesser(",
            "/// The smaller one; not a number if either is not.\nfn lesser(a: f64, b: f64) -> f64 {\n    if a.is_nan() || a < b { a } else { b }\n}\n\n",
        ),
        (
            "greater(",
            "/// The larger one; not a number if either is not.\nfn greater(a: f64, b: f64) -> f64 {\n    if a.is_nan() || a > b { a } else { b }\n}\n\n",
        ),
    ];
    let mut text: String =
        HELPERS.iter().filter(|(call, _)| functions.contains(&format!(" {call}"))).map(|(_, text)| *text).collect();
    if functions.contains("sin_cos(") {
        // as the interpreter has it, to the letter
        text += "use sine_and_cosine::sin_cos;\n\n#[rustfmt::skip]\nmod sine_and_cosine {\n\n";
        text += SIN_COS;
        text += "\n}\n";
    }
    text
}

/// A number that reads back to the same bits.
fn literal(value: f64) -> String {
    format!("{value:?}")
}

fn one_line(text: &str) -> String {
    text.replace(['\n', '`'], " ")
}
