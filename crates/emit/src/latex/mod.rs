//! The constraint system as a LaTeX document: `Φ`, `Φ_q`, `ν` and `γ` element by element, for a report.
//!
//! It needs `amsmath` and nothing else, and is set with pdflatex. Formulas are in paragraphs, where TeX breaks them by
//! itself; what it cannot break is kept narrower than a line (`formula`). What is written is rounded and put in order for a
//! reader: for the bits there are the other writers.

mod formula;
mod letters;
mod pieces;
mod symbols;

use super::not_written;
use formula::Formulas;
use letters::{Set, Style, numeral, symbol, words};
use mechc_expr::{ExprId, Node, Table};
use mechc_ir::{ConstraintSystem, CoordinateKind, Declaration, DeclarationId, DeclarationKind, IdVec, Mechanics};
use symbols::{coordinate, param};

/// Largest width of the matrix of an element (em).
const WIDEST_MATRIX: f64 = 40.0;

/// Largest width of a matrix entry (em); a wider one becomes a term `T_k` of its own.
const WIDEST_ENTRY: f64 = 15.0;

/// Largest number of points of a table; of larger ones only the first and the last are written.
const MOST_POINTS: usize = 24;

/// Preamble of the document. `\entry` sets the left side of an equation in a separate column if it has room, and
/// `\columns` the rows of a matrix below it; `\by` stands between factors, where a line had better not be broken.
const PREAMBLE: &str = r"\documentclass[a4paper,10pt,fleqn]{article}
\usepackage{amsmath}
\setlength{\textwidth}{16cm}
\setlength{\textheight}{24.5cm}
\setlength{\oddsidemargin}{0pt}
\setlength{\topmargin}{-1.5cm}
\setlength{\mathindent}{2em}
\newcommand{\entry}[2]{\par\hangindent=6.5em\hangafter=1\leavevmode\setbox0\hbox{$#1$}%
  \ifdim\wd0<5.5em\hbox to 5.5em{\hfil\box0}\else\box0\fi${}\displaystyle #2$\par}
\newcommand{\columns}[2]{\par\addvspace{5pt}\hspace*{5.5em}$\renewcommand{\arraystretch}{1.2}%
  \begin{array}{@{}r|#1} \llap{$\Phi_q$} #2 \end{array}$\par\addvspace{5pt}}
\newcommand{\row}[1]{\llap{$\Phi_{#1}$}}
\newcommand{\tall}{\rule[-2ex]{0pt}{5.2ex}}
\newcommand{\by}{\,\penalty 900\relax}
\newcommand{\element}[2]{\par\addvspace{14pt plus 4pt}\textbf{#1}\quad #2\par\nopagebreak}

\begin{document}
\raggedright
\setlength{\parskip}{3pt plus 1pt}
\setlength{\lineskip}{4pt}
\setlength{\lineskiplimit}{2pt}
";

/// Returns one document; `file` is the name of the source for its head. With `mechanics` it also has the masses, loads and reactions;
/// `is_determined` false adds a remark.
#[must_use]
pub fn latex(system: &ConstraintSystem, mechanics: Option<&Mechanics>, is_determined: bool, file: &str) -> String {
    let mut writer = Writer { system, formulas: Formulas::new(system, &roots(system, mechanics)), text: String::new() };
    writer.head(file, is_determined);
    writer.coordinates();
    writer.params();
    writer.inputs();
    writer.tables();
    writer.equations();
    if let Some(mechanics) = mechanics {
        writer.forces(mechanics);
    }
    writer.measures();
    writer.text + "\n\\end{document}\n"
}

/// Returns a measure's formula, without the condition under which it has a value: a reader sees from a table where that ends.
fn without_condition(system: &ConstraintSystem, measure: ExprId) -> ExprId {
    let is_none =
        |id: ExprId| system.graph().dependence(id).is_constant() && !system.graph().value(id, |_| 0.0).is_finite();
    match system.graph().node(measure) {
        Node::Select(_, value, otherwise) if is_none(otherwise) => value,
        _ => measure,
    }
}

/// Returns all formulas that are emitted.
fn roots(system: &ConstraintSystem, mechanics: Option<&Mechanics>) -> Vec<ExprId> {
    let mut roots: Vec<ExprId> = system.rows().iter().map(|row| row.phi).collect();
    roots.extend(system.phi_q().entries().iter().map(|&(_, id)| id));
    roots.extend(system.nu().iter().chain(system.gamma()));
    roots.extend(system.inputs().iter().map(|input| input.formulas[0]));
    let measures = system.measures().iter().filter(|measure| not_written(system, measure.value).is_none());
    roots.extend(measures.map(|measure| without_condition(system, measure.value)));
    if let Some(Mechanics { mass_matrix, applied }) = mechanics {
        roots.extend(mass_matrix.entries().iter().map(|&(_, id)| id).chain(applied.iter().copied()));
        roots.extend(system.reactions().iter().map(|of| of.value));
    }
    roots.extend(system.graph().tables().iter().flat_map(|table| table.knots.iter().chain(&table.values).copied()));
    roots
}

struct Writer<'s> {
    system: &'s ConstraintSystem,
    formulas: Formulas<'s>,
    text: String,
}

impl Writer<'_> {
    fn head(&mut self, file: &str, is_determined: bool) {
        let system = self.system;
        let (n, m) = (system.coordinates().len(), system.rows().len());
        self.text += &format!("% Written by mechc {}; pdflatex sets it.\n{PREAMBLE}\n", env!("CARGO_PKG_VERSION"));
        self.text += &format!(
            "\\section*{{Constraint system of {}}}\n\nWritten by mechc {} from \\texttt{{{}}}. \
             {n} coordinates $q$, {m} equations:\n",
            words(system.name()),
            env!("CARGO_PKG_VERSION"),
            words(file),
        );
        self.text += r"\[ \Phi(q, t) = 0, \qquad \Phi_q\,\dot q = \nu = -\Phi_t, \qquad ";
        self.text += r"\Phi_q\,\ddot q = \gamma = -(\Phi_q\,\dot q)_q\,\dot q - 2\,\Phi_{qt}\,\dot q - \Phi_{tt}. \]";
        self.text += "\nAll is in SI: metres, radians, seconds. Numbers are rounded to twelve digits. ";
        self.text += "Of $\\Phi_q$ the columns are given that do not vanish.\n";
        self.text +=
            "Each $\\mathcal{T}_k$ stands for a part of a formula, and is written out where it is met first.\n";
        if !is_determined {
            self.text += "The equations do not determine the mechanism.\n";
        }
        let left_out = system.checks().chunk_by(|a, b| a.declaration == b.declaration).map(|of| {
            let name = words(&system.declarations()[of[0].declaration].name);
            format!("{} of \\textbf{{{name}}}", of.len())
        });
        let left_out: Vec<String> = left_out.collect();
        if !left_out.is_empty() {
            self.text += &format!("Equations that follow from the others are left out: {}.\n", left_out.join(", "));
        }
    }

    fn section(&mut self, title: &str) {
        self.text += &format!("\n\\subsection*{{{title}}}\n\n");
    }

    /// The coordinates of each body and joint in a paragraph.
    fn coordinates(&mut self) {
        self.section("Coordinates");
        let mut last = None;
        for (k, of) in self.system.coordinates().iter().enumerate() {
            let start = if last == Some(of.owner) {
                ",\n".to_owned()
            } else {
                let end = if last.is_some() { "\n\n" } else { "" };
                let kind = if self.system.body_of(k).is_some() { "body" } else { "joint" };
                format!("{end}{kind} \\textbf{{{}}}:\n", words(self.system.owner_name(k)))
            };
            last = Some(of.owner);
            let unit = if of.kind == CoordinateKind::Argument { "1" } else { of.kind.unit() };
            let symbol = coordinate(self.system, k, 0).text;
            self.text += &format!("{start}$q_{{{}}} = {symbol}$~({unit})", k + 1);
        }
        self.text += "\n";
    }

    fn params(&mut self) {
        if !self.system.params().is_empty() {
            self.section("Parameters");
        }
        for (k, of) in self.system.params().iter().enumerate() {
            let sign = if of.value < 0.0 { "-" } else { "" };
            let value = format!("{sign}{}", numeral(of.value.abs()).text);
            let unit = unit(&of.unit());
            self.entry(&param(self.system, k).text, &format!("{value}{unit}"));
        }
    }

    /// Writes the formulas of the inputs, which the equations hold.
    fn inputs(&mut self) {
        if !self.system.inputs().is_empty() {
            self.section("Inputs");
            self.text +=
                "What each is as long as nobody says otherwise; the equations hold these formulas in its place.\n\n";
        }
        for (k, input) in self.system.inputs().iter().enumerate() {
            let text = self.formulas.text(input.formulas[0]);
            self.entry(&symbol(&input.name, Style::Italic, k).text, &text);
            self.terms();
        }
    }

    fn tables(&mut self) {
        let tables = self.system.graph().tables();
        if !tables.is_empty() {
            self.section("Tables");
            self.text += "A table is a cubic spline through its points, natural or periodic; \
                a prime is its derivative by its argument.\n\n";
        }
        for (k, table) in tables.iter().enumerate() {
            let name = symbol(&table.name, Style::Upright, k).text;
            let points = self.points(table);
            let kind = if table.periodic { "periodic" } else { "natural" };
            self.entry(&name, &format!(r"\text{{{kind}: }}{points}"));
            self.terms();
        }
    }

    fn points(&mut self, table: &Table) -> String {
        let count = table.knots.len().min(table.values.len());
        let mut texts = Vec::new();
        for (k, (&x, &y)) in table.knots.iter().zip(&table.values).enumerate() {
            if count > MOST_POINTS && k == MOST_POINTS - 2 {
                texts.push(r"\ldots".to_owned());
            }
            if count <= MOST_POINTS || k < MOST_POINTS - 2 || k == count - 1 {
                let [x, y] = [x, y].map(|id| self.formulas.confined(id, WIDEST_ENTRY).text);
                texts.push(format!(r"({x},\,{y})"));
            }
        }
        texts.join(",\\allowbreak\\ ")
    }

    /// Element by element, in the order of declaration.
    fn equations(&mut self) {
        self.section("Equations");
        let mut rows: IdVec<DeclarationId, Vec<usize>> = self.system.declarations().map(|_| Vec::new());
        for (k, row) in self.system.rows().iter().enumerate() {
            rows[row.declaration].push(k);
        }
        for (declaration, rows) in self.system.declarations().iter().zip(&rows) {
            if !rows.is_empty() {
                self.element(declaration, rows);
            }
        }
    }

    fn element(&mut self, declaration: &Declaration, rows: &[usize]) {
        let kind = match declaration.kind {
            DeclarationKind::Joint(kind) => format!("joint, {}", words(kind.name())),
            other => other.noun().to_owned(),
        };
        self.text += &format!("\n\\element{{{}}}{{{kind}}}\n", words(&declaration.name));
        for &row in rows {
            let phi = self.formulas.text(self.system.rows()[row].phi);
            self.entry(&format!(r"\Phi_{{{}}}", row + 1), &phi);
        }
        self.terms();
        self.matrix(rows);
        self.right_sides(r"\nu", rows, self.system.nu());
        self.right_sides(r"\gamma", rows, self.system.gamma());
        self.terms();
    }

    /// The right sides of an element's rows; those that vanish in one equation.
    fn right_sides(&mut self, letter: &str, rows: &[usize], of: &[ExprId]) {
        let is_zero = |row: &usize| of.get(*row).and_then(|&id| self.system.graph().as_const(id)) == Some(0.0);
        let (zero, others): (Vec<usize>, Vec<usize>) = rows.iter().copied().partition(is_zero);
        let names: Vec<String> = zero.iter().map(|row| format!("{letter}_{{{}}}", row + 1)).collect();
        if let Some((first, rest)) = names.split_first() {
            let rest: Vec<String> = rest.iter().map(|name| format!("{name} = ")).collect();
            self.entry(first, &format!("{}0", rest.concat()));
        }
        for row in others {
            let text = of.get(row).map(|&id| self.formulas.text(id)).unwrap_or_default();
            self.entry(&format!("{letter}_{{{}}}", row + 1), &text);
        }
    }

    /// The columns of `Φ_q` in which an element's rows do not vanish, as many side by side as the line has room for.
    fn matrix(&mut self, rows: &[usize]) {
        let mut columns: Vec<u32> =
            rows.iter().flat_map(|&row| self.system.phi_q().row(row)).map(|&(column, _)| column).collect();
        columns.sort_unstable();
        columns.dedup();
        let mut group: Vec<Vec<Set>> = Vec::new();
        let mut width = 0.0;
        for column in columns {
            let cells = self.column(column, rows);
            let widest = cells.iter().map(|cell| cell.width).fold(0.0, f64::max) + 1.0;
            if width + widest > WIDEST_MATRIX && !group.is_empty() {
                self.side_by_side(rows, &std::mem::take(&mut group));
                width = 0.0;
            }
            width += widest;
            group.push(cells);
        }
        if !group.is_empty() {
            self.side_by_side(rows, &group);
        }
        self.terms();
    }

    /// Returns a column with its coordinate on top.
    fn column(&mut self, column: u32, rows: &[usize]) -> Vec<Set> {
        let system = self.system;
        let mut cells = vec![coordinate(system, column as usize, 0)];
        for &row in rows {
            let entries = system.phi_q().row(row);
            let entry = entries.binary_search_by_key(&column, |&(column, _)| column).ok().and_then(|k| entries.get(k));
            cells.push(match entry {
                Some(&(_, id)) => self.formulas.confined(id, WIDEST_ENTRY),
                None => Set { text: "0".to_owned(), width: 0.5 },
            });
        }
        cells
    }

    fn side_by_side(&mut self, rows: &[usize], columns: &[Vec<Set>]) {
        let line = |k: usize| -> String {
            let cells = columns.iter().filter_map(|cells| cells.get(k));
            cells.fold(String::new(), |line, cell| line + " & " + &cell.text)
        };
        let columns = "c".repeat(columns.len());
        self.text += &format!("\\columns{{{columns}}}{{{} \\\\ \\hline\n", line(0));
        for (k, row) in rows.iter().enumerate() {
            let cells = line(k + 1);
            let strut = if cells.contains(r"\frac") { r"\tall " } else { "" };
            self.text += &format!("{strut}\\row{{{}}}{cells} \\\\\n", row + 1);
        }
        self.text += "}\n";
    }

    /// Writes the equations of the multipliers, and the forces that they exert.
    fn forces(&mut self, Mechanics { mass_matrix, applied }: &Mechanics) {
        self.section("Forces");
        self.text += r"The multipliers $\lambda$, one for each equation, hold what inertia asks for and what weights and loads do not give:";
        self.text += "\n\\[ \\Phi_q^{\\mathsf T}\\,\\lambda = M\\,\\ddot q - Q. \\]\n";
        self.text += "In SI: kilograms, newtons. Entries that are not written vanish.\n\n";
        for row in 0..mass_matrix.rows() {
            for &(column, mass) in mass_matrix.row(row).iter().filter(|(column, _)| *column as usize >= row) {
                let text = self.formulas.text(mass);
                let twin =
                    if column as usize == row { String::new() } else { format!(" = M_{{{},{}}}", column + 1, row + 1) };
                self.entry(&format!("M_{{{},{}}}{twin}", row + 1, column + 1), &text);
            }
        }
        for (k, &of) in applied.iter().enumerate() {
            if self.system.graph().as_const(of) != Some(0.0) {
                let text = self.formulas.text(of);
                self.entry(&format!("Q_{{{}}}", k + 1), &text);
            }
        }
        self.terms();
        if !self.system.reactions().is_empty() {
            self.text += "\nWhat joints exert on their second bodies, and what drivers supply:\n\n";
        }
        for reaction in self.system.reactions() {
            let text = self.formulas.text(reaction.value);
            self.entry(&format!(r"\text{{{}}}", words(&reaction.name)), &text);
            self.terms();
        }
    }

    fn measures(&mut self) {
        if !self.system.measures().is_empty() {
            self.section("Measures");
        }
        for (k, measure) in self.system.measures().iter().enumerate() {
            let name = symbol(&measure.name, Style::Italic, k).text;
            if let Some(reason) = not_written(self.system, measure.value) {
                self.entry(&name, &format!("\\text{{{reason}}}"));
                continue;
            }
            let text = self.formulas.text(without_condition(self.system, measure.value));
            self.entry(&name, &text);
            self.terms();
        }
    }

    /// Writes out the terms that have been met.
    fn terms(&mut self) {
        for term in self.formulas.terms() {
            self.related(&term.name, term.relation, &term.text);
        }
    }

    fn entry(&mut self, left: &str, right: &str) {
        self.related(left, "=", right);
    }

    fn related(&mut self, left: &str, relation: &str, right: &str) {
        // without a break behind the sign
        self.text += &format!("\\entry{{{left}}}{{{relation}\\nobreak {right}}}\n");
    }
}

/// Returns an SI unit behind a number, from `m`, `1/s` or `m^2/s`; nothing for a pure number.
fn unit(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut text = String::new();
    let mut chars = unit.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '^' => {
                let mut power = String::new();
                while let Some(c) = chars.next_if(|c| c.is_ascii_digit() || matches!(c, '.' | '-')) {
                    power.push(c);
                }
                text += &format!("^{{{power}}}");
            }
            '*' => text += r"\,",
            c if c.is_ascii_alphabetic() => text += &format!(r"\mathrm{{{c}}}"),
            c => text.push(c),
        }
    }
    format!(r"\,{text}")
}
