//! Formulas as text in the syntax of the language, with as few parentheses as needed.
//!
//! Printed text reads back to the same expression: the constructors of this crate build the same nodes from it. A graph shares
//! subexpressions and a text does not, so large shared subexpressions can be given names.

use super::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use rustc_hash::FxHashMap;
use std::borrow::Cow;

/// Smaller subexpressions are written out wherever they occur.
const SMALL: u32 = 12;

/// If 15 digits shorten a number by more characters than this, its last digits are rounding.
const ROUNDING: usize = 3;

/// Binding strength of a form; an operand that binds less tightly than its position requires needs parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Tightness {
    Conditional,
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Negation,
    Power,
    Atom,
}

impl Unary {
    /// All functions.
    pub const ALL: [Unary; 16] = [
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Sinh,
        Unary::Cosh,
        Unary::Tanh,
        Unary::Exp,
        Unary::Ln,
        Unary::Log10,
        Unary::Sqrt,
        Unary::Abs,
        Unary::Sign,
        Unary::Floor,
    ];

    /// Returns the function of a word.
    #[must_use]
    pub fn named(word: &str) -> Option<Unary> {
        Self::ALL.into_iter().find(|function| function.word() == word)
    }

    /// Returns the word of the language; `floor`, which the language lacks, is written as `x - mod(x, 1)`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Log10 => "log10",
            Unary::Sqrt => "sqrt",
            Unary::Abs => "abs",
            Unary::Sign => "sign",
            Unary::Floor => "floor",
        }
    }
}

impl Binary {
    /// Returns the word of the language; a power has none there.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Binary::Atan2 => "atan2",
            Binary::Hypot => "hypot",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Pow => "pow",
            Binary::Mod => "mod",
        }
    }
}

/// Printer for the formulas of one graph.
pub struct Printer<'g, S: Fn(Symbol) -> String> {
    graph: &'g Graph,
    symbol: S,
    names: FxHashMap<ExprId, String>,
    /// True for display only: signs are merged, and rounding in the last digits is removed.
    is_for_readers: bool,
}

impl<'g, S: Fn(Symbol) -> String> Printer<'g, S> {
    /// Creates a printer that writes symbols by a function, and all subexpressions in full.
    pub fn new(graph: &'g Graph, symbol: S) -> Printer<'g, S> {
        Printer { graph, symbol, names: FxHashMap::default(), is_for_readers: false }
    }

    /// Returns the printer for display: the text is equivalent, but need not read back to the same expression.
    #[must_use]
    pub fn for_readers(self) -> Printer<'g, S> {
        Printer { is_for_readers: true, ..self }
    }

    /// Returns the printer with names for some subexpressions.
    #[must_use]
    pub fn with_names(mut self, names: &FxHashMap<ExprId, String>) -> Printer<'g, S> {
        self.names.clone_from(names);
        self
    }

    /// Names every large subexpression that occurs several times in the roots. Returns the named subexpressions, each after those whose
    /// names it contains.
    pub fn name_shared(&mut self, roots: &[ExprId], name: impl Fn(usize) -> String) -> Vec<(String, ExprId)> {
        let mut uses: FxHashMap<ExprId, u32> = FxHashMap::default();
        let reachable = self.graph.reachable(roots);
        for root in roots {
            *uses.entry(*root).or_default() += 1;
        }
        for &id in &reachable {
            for child in self.graph.node(id).children().as_slice() {
                *uses.entry(*child).or_default() += self.times_written(id);
            }
        }
        let mut sizes: FxHashMap<ExprId, u32> = FxHashMap::default();
        let mut shared = Vec::new();
        for id in reachable {
            let children = self.graph.node(id).children();
            let size = children.as_slice().iter().map(|child| sizes[child]).fold(1, u32::saturating_add);
            let size = size.saturating_mul(self.times_written(id));
            if size >= SMALL && uses[&id] > 1 {
                let name = name(shared.len());
                shared.push((name.clone(), id));
                self.names.insert(id, name);
                // a name is as short as a symbol
                sizes.insert(id, 1);
            } else {
                sizes.insert(id, size);
            }
        }
        shared
    }

    /// Returns how often the text of an operation contains its operands: twice for `floor`, which the language lacks.
    fn times_written(&self, id: ExprId) -> u32 {
        if matches!(self.graph.node(id), Node::Unary(Unary::Floor, _)) { 2 } else { 1 }
    }

    /// Returns a formula as text.
    #[must_use]
    pub fn text(&self, root: ExprId) -> String {
        self.written(vec![Part::Formula(root, Tightness::Conditional, false)])
    }

    /// Returns the text of a formula that [`Printer::name_shared`] has named, without its own name.
    #[must_use]
    pub fn definition(&self, id: ExprId) -> String {
        let mut parts = Parts::default();
        self.write_node(id, Tightness::Conditional, false, &mut parts);
        parts.0.reverse();
        self.written(parts.0)
    }

    /// Returns the text of some parts; the last part in the list is written first. A sum of many terms nests deeply, so the printer keeps
    /// its own stack instead of recursing.
    fn written(&self, mut open: Vec<Part>) -> String {
        let mut out = String::new();
        let mut parts = Parts::default();
        while let Some(part) = open.pop() {
            match part {
                Part::Text(text) => out.push_str(&text),
                Part::Formula(id, required, is_negated) => {
                    if let Some(name) = self.names.get(&id) {
                        out.push_str(name);
                    } else {
                        self.write_node(id, required, is_negated, &mut parts);
                        open.extend(parts.0.drain(..).rev());
                    }
                }
            }
        }
        out
    }

    /// Writes a formula; with `is_negated`, one that begins with a negative number without its sign.
    fn write_node(&self, id: ExprId, required: Tightness, is_negated: bool, out: &mut Parts) {
        let needs_parentheses = self.tightness(id) < required && !(is_negated && self.graph.as_const(id).is_some());
        if needs_parentheses {
            out.text("(");
        }
        self.write_bare(id, is_negated, out);
        if needs_parentheses {
            out.text(")");
        }
    }

    fn tightness(&self, id: ExprId) -> Tightness {
        match self.graph.node(id) {
            Node::Const(bits) if f64::from_bits(bits) < 0.0 => Tightness::Negation,
            Node::Binary(Binary::Pow, ..) | Node::Power(..) => Tightness::Power,
            Node::Add(..) | Node::Sub(..) | Node::Unary(Unary::Floor, _) => Tightness::Sum,
            Node::Mul(..) | Node::Div(..) => Tightness::Product,
            // the sign of a product is written before its first factor
            Node::Neg(a) if self.takes_sign_in_front(a) => Tightness::Product,
            Node::Neg(_) => Tightness::Negation,
            Node::Const(_) | Node::Symbol(_) | Node::Unary(..) | Node::Binary(..) | Node::Table(..) => Tightness::Atom,
            Node::Compare(..) => Tightness::Comparison,
            Node::And(..) => Tightness::And,
            Node::Or(..) => Tightness::Or,
            Node::Not(_) => Tightness::Not,
            Node::Select(..) => Tightness::Conditional,
        }
    }

    fn write_bare(&self, id: ExprId, is_negated: bool, out: &mut Parts) {
        match self.graph.node(id) {
            Node::Const(bits) => {
                let value = f64::from_bits(bits);
                out.text(self.number(if is_negated { -value } else { value }));
            }
            Node::Symbol(symbol) => out.text((self.symbol)(symbol)),
            Node::Add(a, b) => self.write_sum(a, b, out),
            Node::Sub(a, b) => self.write_difference(a, b, out),
            Node::Mul(a, b) => {
                let (first, second) = self.factors(a, b);
                let is_scaled = self.graph.as_const(first).is_some() && self.is_row_of_products(second);
                let required = if is_scaled { Tightness::Product } else { Tightness::Negation };
                out.signed(first, Tightness::Product, is_negated);
                out.text(" * ");
                out.formula(second, required);
            }
            Node::Div(a, b) => {
                out.signed(a, Tightness::Product, is_negated);
                out.text(" / ");
                out.formula(b, Tightness::Negation);
            }
            Node::Neg(a) => {
                out.text("-");
                let required = if self.takes_sign_in_front(a) { Tightness::Product } else { Tightness::Negation };
                out.formula(a, required);
            }
            Node::Power(a, n) => {
                out.formula(a, Tightness::Atom);
                out.text(format!("^{n}"));
            }
            Node::Binary(Binary::Pow, a, b) => Self::write_pair(a, "^", b, [Tightness::Atom, Tightness::Negation], out),
            Node::Unary(Unary::Floor, a) => {
                out.formula(a, Tightness::Sum);
                out.text(" - mod(");
                out.formula(a, Tightness::Conditional);
                out.text(", 1)");
            }
            Node::Unary(function, a) => Self::write_call(function.word(), &[a], out),
            Node::Binary(function, a, b) => Self::write_call(function.word(), &[a, b], out),
            Node::Table(table, order, a) => {
                let name = &self.graph.tables()[table.index()].name;
                Self::write_call(format!("{name}{}", "'".repeat(usize::from(order))), &[a], out);
            }
            Node::Compare(comparison, a, b) => {
                let operator = match comparison {
                    Comparison::Less => " < ",
                    Comparison::LessEqual => " <= ",
                    Comparison::Equal => " == ",
                };
                Self::write_pair(a, operator, b, [Tightness::Sum, Tightness::Sum], out);
            }
            Node::And(a, b) => Self::write_pair(a, " and ", b, [Tightness::And, Tightness::Not], out),
            Node::Or(a, b) => Self::write_pair(a, " or ", b, [Tightness::Or, Tightness::And], out),
            Node::Not(a) => {
                out.text("not ");
                out.formula(a, Tightness::Not);
            }
            Node::Select(condition, a, b) => {
                out.text("if ");
                out.formula(condition, Tightness::Or);
                out.text(" then ");
                out.formula(a, Tightness::Or);
                out.text(" else ");
                out.formula(b, Tightness::Conditional);
            }
        }
    }

    /// Writes a sum with nested sums first, and a negative number as a subtraction.
    fn write_sum(&self, a: ExprId, b: ExprId, out: &mut Parts) {
        let is_number = |id: ExprId| self.graph.as_const(id).is_some();
        let is_sum = |id: ExprId| self.tightness(id) == Tightness::Sum && !self.names.contains_key(&id);
        let swap = is_number(a) || is_sum(b) && !is_sum(a) && !is_number(b);
        let (first, second) = if swap { (b, a) } else { (a, b) };
        out.formula(first, Tightness::Sum);
        if let Some(value) = self.graph.as_const(second).filter(|value| *value < 0.0) {
            out.text(format!(" - {}", self.number(-value)));
        } else if self.is_for_readers && self.begins_with_a_sign(second) {
            out.text(" - ");
            out.signed(second, Tightness::Product, true);
        } else {
            out.text(" + ");
            out.formula(second, Tightness::Product);
        }
    }

    fn write_difference(&self, a: ExprId, b: ExprId, out: &mut Parts) {
        let is_sum = self.is_for_readers && self.begins_with_a_sign(b);
        out.formula(a, Tightness::Sum);
        out.text(if is_sum { " + " } else { " - " });
        out.signed(b, Tightness::Product, is_sum);
    }

    /// Returns whether a negative number stands alone or is the first factor of a chain.
    fn begins_with_a_sign(&self, id: ExprId) -> bool {
        let mut first = id;
        loop {
            if self.names.contains_key(&first) {
                return false;
            }
            first = match self.graph.node(first) {
                Node::Const(bits) => return f64::from_bits(bits) < 0.0,
                Node::Mul(a, b) => self.factors(a, b).0,
                Node::Div(a, _) => a,
                _ => return false,
            };
        }
    }

    fn number(&self, value: f64) -> String {
        let exact = number(value);
        if !self.is_for_readers {
            return exact;
        }
        let rounded = format!("{value:.14e}").parse().map_or_else(|_| exact.clone(), number);
        if rounded.len() + ROUNDING < exact.len() { rounded } else { exact }
    }

    fn write_pair(a: ExprId, operator: &'static str, b: ExprId, required: [Tightness; 2], out: &mut Parts) {
        out.formula(a, required[0]);
        out.text(operator);
        out.formula(b, required[1]);
    }

    fn write_call(word: impl Into<Cow<'static, str>>, arguments: &[ExprId], out: &mut Parts) {
        out.text(word);
        out.text("(");
        for (k, &argument) in arguments.iter().enumerate() {
            if k > 0 {
                out.text(", ");
            }
            out.formula(argument, Tightness::Conditional);
        }
        out.text(")");
    }

    /// Returns the operands of a product in the order of printing: a number before a chain of products, which merge with it when read; else
    /// a product or quotient first, where it needs no parentheses.
    fn factors(&self, a: ExprId, b: ExprId) -> (ExprId, ExprId) {
        let scaled = self.graph.as_const(a).is_some() && self.is_row_of_products(b);
        if self.is_chain(b) && !self.is_chain(a) && !scaled { (b, a) } else { (a, b) }
    }

    /// Returns whether an operand is printed as a chain of products without quotients.
    fn is_row_of_products(&self, id: ExprId) -> bool {
        let mut first = id;
        while self.is_chain(first) {
            first = match self.graph.node(first) {
                Node::Mul(a, b) => self.factors(a, b).0,
                _ => return false,
            };
        }
        first != id
    }

    /// Returns whether the sign of a chain of factors can be written before the first factor. It cannot before a difference, whose operands
    /// it would exchange, nor before a number, which would absorb it.
    fn takes_sign_in_front(&self, id: ExprId) -> bool {
        let mut first = id;
        while self.is_chain(first) {
            first = match self.graph.node(first) {
                Node::Mul(a, b) if self.graph.as_const(a).is_none() => self.factors(a, b).0,
                Node::Mul(..) => return false,
                Node::Div(a, _) => a,
                _ => break,
            };
        }
        let takes_up_a_sign = match self.graph.node(first) {
            Node::Sub(..) | Node::Const(_) => true,
            // inside a named subexpression
            Node::Mul(a, _) => self.graph.as_const(a).is_some(),
            _ => false,
        };
        first != id && !takes_up_a_sign
    }

    /// Returns whether an operand is printed as a chain of factors.
    fn is_chain(&self, id: ExprId) -> bool {
        self.tightness(id) == Tightness::Product && !self.names.contains_key(&id)
    }
}

/// A piece of text that is still to be written.
enum Part {
    Text(Cow<'static, str>),
    /// A formula in a position that requires some tightness; true if its negative is written.
    Formula(ExprId, Tightness, bool),
}

/// Pieces in the order of the text.
#[derive(Default)]
struct Parts(Vec<Part>);

impl Parts {
    fn text(&mut self, text: impl Into<Cow<'static, str>>) {
        self.0.push(Part::Text(text.into()));
    }

    fn formula(&mut self, id: ExprId, required: Tightness) {
        self.signed(id, required, false);
    }

    fn signed(&mut self, id: ExprId, required: Tightness, is_negated: bool) {
        self.0.push(Part::Formula(id, required, is_negated));
    }
}

/// Returns the shortest decimal that reads back to the same number, without a point for whole numbers.
#[must_use]
pub fn number(value: f64) -> String {
    let text = zmij::Buffer::new().format(value).to_owned();
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
