//! Formulas in LaTeX.
//!
//! TeX breaks a formula of a paragraph by itself, but only between the terms of its outermost group: never in a fraction, under
//! a root or in a row of `cases`. So every piece is written with an estimate of its width, and one that is too wide for a
//! place of that kind becomes a *term*, `𝒯₃`, which is written out on its own. The same goes for large parts that stand in
//! several places: a formula shares its parts and a page does not, and so the size of the whole stays that of the graph.

use super::letters::{Set, numeral};
use super::pieces::{Factor, Level, Piece, Rank, WIDEST_FRACTION, call, quotient, rank};
use super::symbols::{coordinate, param, table_name};
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::ConstraintSystem;
use rustc_hash::FxHashMap;

/// Number of operations from which a shared part becomes a term.
const SHARED: u32 = 24;

/// Largest size of a formula that is simplified first.
const LARGEST_TIDIED: u64 = 600;

/// Width beyond which a part of a formula becomes a term: more than a line (em).
const WIDEST_PART: f64 = 60.0;

/// Largest width of a part in other positions that cannot be broken (em).
const WIDEST_ROOT: f64 = 24.0;
const WIDEST_HALF_ROOT: f64 = 15.0;
const WIDEST_CASE: f64 = 17.0;
const WIDEST_CONDITION: f64 = 14.0;
const WIDEST_EXPONENT: f64 = 8.0;

/// Largest number of rows of `cases` on a page.
const MOST_CASES: usize = 16;

/// Largest nesting depth of operations in one formula.
const DEEPEST: u32 = 50;

/// Term, defined below the formula that first uses it.
#[derive(Debug)]
pub(super) struct Term {
    pub name: String,
    /// `=`, or the sign of a comparison.
    pub relation: &'static str,
    pub text: String,
}

/// Writes the formulas of one system.
pub(super) struct Formulas<'s> {
    system: &'s ConstraintSystem,
    /// The system's formulas, with a symbol for each shared part.
    graph: Graph,
    /// Expressions in `graph` for the roots.
    roots: FxHashMap<ExprId, ExprId>,
    /// Shared parts.
    shared: Vec<ExprId>,
    /// Numbers of the terms used so far.
    terms: FxHashMap<ExprId, usize>,
    /// Terms whose definitions are pending.
    open: Vec<Open>,
}

/// Term whose definition is pending.
enum Open {
    Shared { number: usize, definition: ExprId },
    Wide { number: usize, piece: Piece },
}

impl<'s> Formulas<'s> {
    /// Creates a writer for some formulas of a system.
    pub fn new(system: &'s ConstraintSystem, roots: &[ExprId]) -> Formulas<'s> {
        let mut graph = Graph::new();
        let mut imported = FxHashMap::default();
        let leaf = |graph: &mut Graph, symbol: Symbol| graph.symbol(symbol);
        graph.import_tables(system.graph(), &mut imported, leaf);
        imported.clear();
        let mut shared = Vec::new();
        for id in shared_parts(system.graph(), roots) {
            graph.import(system.graph(), &[id], &mut imported, leaf);
            shared.extend(imported.get(&id));
            let name = graph.symbol(Symbol::Named(shared.len() as u32 - 1));
            imported.insert(id, name);
        }
        graph.import(system.graph(), roots, &mut imported, leaf);
        let (terms, open) = (FxHashMap::default(), Vec::new());
        Formulas { system, graph, roots: imported, shared, terms, open }
    }

    /// Returns one of the formulas, which TeX may break if it is long.
    pub fn text(&mut self, root: ExprId) -> String {
        let id = self.tidied(root);
        self.cut(id);
        self.outermost(id).signed().text
    }

    /// Returns one of the formulas without line breaks, with its width.
    pub fn confined(&mut self, root: ExprId, widest: f64) -> Set {
        let id = self.tidied(root);
        self.cut(id);
        let piece = self.within(id, widest, 1).signed();
        Set { text: piece.text, width: piece.width }
    }

    /// Returns the terms used since the last call, and those that these use.
    pub fn terms(&mut self) -> Vec<Term> {
        let mut list = Vec::new();
        while !self.open.is_empty() {
            for open in std::mem::take(&mut self.open) {
                let (number, piece) = match open {
                    Open::Wide { number, piece } => (number, piece),
                    Open::Shared { number, definition } => {
                        let definition = self.in_order(definition);
                        self.cut(definition);
                        (number, self.outermost(definition))
                    }
                };
                let relation = if piece.level < Level::Sum { r"\Leftrightarrow" } else { "=" };
                list.push(Term { name: name(number), relation, text: piece.signed().text });
            }
        }
        list
    }

    fn tidied(&mut self, root: ExprId) -> ExprId {
        // a root must have been passed to `new`
        let id = self.roots.get(&root).copied().unwrap_or_else(|| self.graph.constant(0.0));
        self.in_order(id)
    }

    fn in_order(&mut self, id: ExprId) -> ExprId {
        if self.graph.written_size(&[id]) <= LARGEST_TIDIED { self.graph.tidied(id) } else { id }
    }

    /// Returns a displayed formula; only such formulas contain `cases`.
    fn outermost(&mut self, id: ExprId) -> Piece {
        match self.graph.node(id) {
            _ if self.terms.contains_key(&id) => self.part(id),
            Node::Select(..) => self.cases(id),
            _ => self.piece(id),
        }
    }

    /// Returns a part of a formula in a position that can be broken.
    fn part(&mut self, id: ExprId) -> Piece {
        self.within(id, WIDEST_PART, 2)
    }

    /// Returns a part of a formula, or a term if it is too wide or too tall.
    fn within(&mut self, id: ExprId, widest: f64, tallest: u32) -> Piece {
        if let Some(&number) = self.terms.get(&id) {
            return reference(number);
        }
        let is_cases = matches!(self.graph.node(id), Node::Select(..));
        let piece = if is_cases { self.cases(id) } else { self.piece(id) };
        if piece.width <= widest && piece.tall <= tallest && !is_cases {
            return piece;
        }
        self.term(id, piece)
    }

    /// Returns the symbol of a term that replaces a piece.
    fn term(&mut self, id: ExprId, piece: Piece) -> Piece {
        let number = self.terms.len() + 1;
        self.terms.insert(id, number);
        self.open.push(Open::Wide { number, piece });
        reference(number)
    }

    /// Makes terms of parts of a formula that is nested very deep, so that writing it does not recurse deeper than [`DEEPEST`].
    fn cut(&mut self, root: ExprId) {
        for id in self.graph.cuts(root, DEEPEST) {
            if !self.terms.contains_key(&id) {
                let piece = self.outermost(id);
                self.term(id, piece);
            }
        }
    }

    fn piece(&mut self, id: ExprId) -> Piece {
        match self.graph.node(id) {
            Node::Symbol(symbol) => self.symbol(id, symbol),
            Node::Add(..) | Node::Sub(..) => self.sum(id),
            Node::Const(_) | Node::Mul(..) | Node::Div(..) | Node::Neg(_) => self.product(id),
            Node::Power(_, n) if n < 0 => self.product(id),
            Node::Power(a, n) => {
                let exponent = n.to_string();
                let width = 0.4 * exponent.len() as f64;
                self.raised(a, &Piece::new(exponent, width, Level::Atom))
            }
            Node::Binary(Binary::Pow, a, b) => {
                let exponent = self.within(b, WIDEST_EXPONENT, 0).signed();
                self.raised(a, &exponent)
            }
            Node::Unary(function, a) => self.unary(function, a),
            Node::Binary(Binary::Hypot, a, b) => self.hypotenuse(a, b),
            Node::Binary(function, a, b) => self.binary(function, id, [a, b]),
            Node::Table(table, order, a) => {
                let name = table_name(self.system, table);
                let argument = self.part(a);
                let marks = "'".repeat(usize::from(order));
                call(&format!("{}{marks}", name.text), name.width + 0.3 * f64::from(order), vec![argument], false)
            }
            Node::Compare(comparison, a, b) => self.comparison(comparison, a, b),
            Node::And(a, b) => self.both(a, r"\text{ and }", 2.4, b, Level::And),
            Node::Or(a, b) => self.both(a, r"\text{ or }", 1.9, b, Level::Or),
            Node::Not(a) => {
                let piece = self.part(a).at_least(Level::Sum);
                Piece::new(format!(r"\text{{not }}{}", piece.text), piece.width + 2.0, Level::Relation).tall(piece.tall)
            }
            Node::Select(..) => self.part(id),
        }
    }

    fn symbol(&mut self, id: ExprId, symbol: Symbol) -> Piece {
        match symbol {
            // the typeset system has formulas of time instead of signals
            Symbol::Time | Symbol::Signal { .. } => Piece::new("t", 0.45, Level::Atom),
            Symbol::Param(k) => {
                let name = param(self.system, k as usize);
                Piece::new(name.text, name.width, Level::Atom)
            }
            Symbol::Coordinate { index, order } => {
                let name = coordinate(self.system, index as usize, order);
                Piece::new(name.text, name.width, Level::Atom)
            }
            Symbol::Shift(_) => Piece::new("0", 0.5, Level::Atom),
            Symbol::Multiplier(row) => Piece::new(format!(r"\lambda_{{{}}}", row + 1), 1.0, Level::Atom),
            Symbol::Varied { .. } | Symbol::VariedMultiplier { .. } => {
                let name = self.system.symbol_name(symbol);
                Piece::new(format!(r"\mathtt{{{}}}", name.replace('_', r"\_")), 0.6 * name.len() as f64, Level::Atom)
            }
            Symbol::Named(k) => {
                let number = self.terms.len() + 1;
                self.terms.insert(id, number);
                self.open.extend(self.shared.get(k as usize).map(|&definition| Open::Shared { number, definition }));
                reference(number)
            }
        }
    }

    fn sum(&mut self, root: ExprId) -> Piece {
        let mut terms = Vec::new();
        let mut open = vec![(root, false)];
        while let Some((id, is_negative)) = open.pop() {
            match self.graph.node(id) {
                _ if id != root && self.terms.contains_key(&id) => terms.push((id, is_negative)),
                Node::Add(a, b) => open.extend([(b, is_negative), (a, is_negative)]),
                Node::Sub(a, b) => open.extend([(b, !is_negative), (a, is_negative)]),
                Node::Neg(a) => open.push((a, !is_negative)),
                _ => terms.push((id, is_negative)),
            }
        }
        let mut pieces: Vec<Piece> = Vec::new();
        for (id, is_negative) in terms {
            let mut piece = self.part(id);
            if piece.level < Level::Product {
                piece = piece.in_parentheses();
            }
            piece.is_negative ^= is_negative;
            pieces.push(piece);
        }
        let mut sum = Piece::new("", 0.0, Level::Sum);
        for piece in pieces {
            sum.width += if sum.text.is_empty() { 0.0 } else { 2.2 };
            sum.text += match (sum.text.is_empty(), piece.is_negative) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            sum.text += &piece.text;
            sum.width += piece.width;
            sum.tall = sum.tall.max(piece.tall);
        }
        sum
    }

    /// Returns products and quotients as one fraction, with wide factors next to it.
    fn product(&mut self, root: ExprId) -> Piece {
        let (mut above, mut below, mut is_negative) = (Vec::new(), Vec::new(), false);
        let mut open = vec![(root, true)];
        while let Some((id, is_above)) = open.pop() {
            match self.graph.node(id) {
                _ if id != root && self.terms.contains_key(&id) => self.factor(id, is_above, &mut above, &mut below),
                Node::Mul(a, b) => open.extend([(b, is_above), (a, is_above)]),
                Node::Div(a, b) => open.extend([(b, !is_above), (a, is_above)]),
                Node::Neg(a) => {
                    is_negative = !is_negative;
                    open.push((a, is_above));
                }
                Node::Const(bits) => {
                    let value = f64::from_bits(bits);
                    is_negative ^= value < 0.0;
                    let list = if is_above { &mut above } else { &mut below };
                    if id == root || value.abs().to_bits() != 1.0_f64.to_bits() {
                        list.push((Rank::Number, constant(value.abs())));
                    }
                }
                Node::Power(a, n) if n < 0 => {
                    let size = n.unsigned_abs().to_string();
                    let width = 0.4 * size.len() as f64;
                    let piece = match n {
                        -1 => self.part(a).signed(),
                        _ => self.raised(a, &Piece::new(size, width, Level::Atom)),
                    };
                    let list = if is_above { &mut below } else { &mut above };
                    list.push((rank(&piece), piece));
                }
                _ => self.factor(id, is_above, &mut above, &mut below),
            }
        }
        let mut piece = quotient(above, below);
        if is_negative && piece.level < Level::Product {
            piece = piece.in_parentheses();
        }
        piece.is_negative ^= is_negative;
        piece
    }

    fn factor(&mut self, id: ExprId, is_above: bool, above: &mut Vec<Factor>, below: &mut Vec<Factor>) {
        let piece = if is_above { self.within(id, WIDEST_PART, 2) } else { self.within(id, WIDEST_FRACTION - 4.0, 1) };
        let list = if is_above { above } else { below };
        list.push((rank(&piece), piece));
    }

    fn raised(&mut self, base: ExprId, exponent: &Piece) -> Piece {
        let is_plain = exponent.text.chars().all(|c| c.is_ascii_digit());
        if let Node::Unary(function, a) = self.graph.node(base)
            && let Some(word) = elementary(function)
            && is_plain
            && function != Unary::Exp
            && !self.terms.contains_key(&base)
        {
            let argument = self.part(a);
            return call(&format!("{word}^{{{}}}", exponent.text), 2.0 + exponent.width, vec![argument], true);
        }
        let base = self.part(base).at_least(Level::Atom);
        let tall = base.tall.max(exponent.tall);
        Piece::new(format!("{}^{{{}}}", base.text, exponent.text), base.width + 0.75 * exponent.width, Level::Power)
            .tall(tall)
    }

    fn unary(&mut self, function: Unary, a: ExprId) -> Piece {
        match function {
            Unary::Sqrt => {
                let piece = self.within(a, WIDEST_ROOT, 1).signed();
                Piece::new(format!(r"\sqrt{{{}}}", piece.text), piece.width + 1.2, Level::Atom).tall(piece.tall)
            }
            Unary::Abs => self.part(a).enclosed([r"\lvert ", r"\rvert "]),
            Unary::Floor => self.part(a).enclosed([r"\lfloor ", r"\rfloor "]),
            _ => {
                let argument = self.part(a);
                let word = elementary(function).unwrap_or(r"\operatorname{sgn}");
                let is_operator = elementary(function).is_some();
                call(word, 0.5 * function.word().len() as f64 + 0.4, vec![argument], is_operator)
            }
        }
    }

    fn hypotenuse(&mut self, a: ExprId, b: ExprId) -> Piece {
        let [a, b] = [a, b].map(|id| {
            let piece = self.within(id, WIDEST_HALF_ROOT, 1).at_least(Level::Atom);
            (format!("{}^{{2}}", piece.text), piece.width, piece.tall)
        });
        let text = format!(r"\sqrt{{{} + {}}}", a.0, b.0);
        Piece::new(text, a.1 + b.1 + 4.5, Level::Atom).tall(a.2.max(b.2))
    }

    fn binary(&mut self, function: Binary, id: ExprId, arguments: [ExprId; 2]) -> Piece {
        let (word, width) = match function {
            Binary::Min => (r"\min", 2.0),
            Binary::Max => (r"\max", 2.0),
            Binary::Atan2 => (r"\operatorname{atan2}", 2.8),
            _ => (r"\operatorname{mod}", 2.2),
        };
        let mut ids = arguments.to_vec();
        if matches!(function, Binary::Min | Binary::Max) {
            // the smallest of the smallest is the smallest of all
            let mut open = vec![id];
            ids.clear();
            while let Some(next) = open.pop() {
                match self.graph.node(next) {
                    Node::Binary(inner, a, b)
                        if inner == function && (next == id || !self.terms.contains_key(&next)) =>
                    {
                        open.extend([b, a]);
                    }
                    _ => ids.push(next),
                }
            }
        }
        let pieces = ids.into_iter().map(|id| self.part(id)).collect();
        call(word, width, pieces, false)
    }

    fn comparison(&mut self, comparison: Comparison, a: ExprId, b: ExprId) -> Piece {
        let sign = match comparison {
            Comparison::Less => "<",
            Comparison::LessEqual => r"\le",
            Comparison::Equal => "=",
        };
        let [a, b] = [a, b].map(|id| self.part(id).signed());
        let text = format!("{} {sign} {}", a.text, b.text);
        Piece::new(text, a.width + b.width + 1.9, Level::Relation).tall(a.tall.max(b.tall))
    }

    fn both(&mut self, a: ExprId, word: &str, width: f64, b: ExprId, level: Level) -> Piece {
        let [a, b] = [a, b].map(|id| {
            let piece = self.part(id);
            if piece.level == level { piece } else { piece.at_least(Level::Relation) }
        });
        let text = format!(r"{}{word}\allowbreak {}", a.text, b.text);
        Piece::new(text, a.width + b.width + width, level).tall(a.tall.max(b.tall))
    }

    /// Returns a chain of conditions as `cases`, with a row for each.
    fn cases(&mut self, root: ExprId) -> Piece {
        let (mut rows, mut id) = (Vec::new(), root);
        while let Node::Select(condition, value, rest) = self.graph.node(id) {
            if rows.len() == MOST_CASES || id != root && self.terms.contains_key(&id) {
                break;
            }
            let condition = self.within(condition, WIDEST_CONDITION, 1).signed();
            let value = self.within(value, WIDEST_CASE, 1).signed();
            rows.push((value, format!(r"\text{{if }} {}", condition.text), condition.width + 1.2));
            id = rest;
        }
        let rest = self.within(id, WIDEST_CASE, 1).signed();
        rows.push((rest, r"\text{otherwise}".to_owned(), 4.2));
        let widest = |widths: &mut dyn Iterator<Item = f64>| widths.fold(0.0, f64::max);
        let width = widest(&mut rows.iter().map(|row| row.0.width)) + widest(&mut rows.iter().map(|row| row.2)) + 3.0;
        let lines: Vec<String> =
            rows.iter().map(|(value, condition, _)| format!("{} & {condition}", value.text)).collect();
        let text = format!(r"\begin{{cases}} {} \end{{cases}}", lines.join(r" \\ "));
        Piece::new(text, width, Level::Sum).tall(2)
    }
}

/// Returns the LaTeX command of an elementary function.
fn elementary(function: Unary) -> Option<&'static str> {
    Some(match function {
        Unary::Sin => r"\sin",
        Unary::Cos => r"\cos",
        Unary::Tan => r"\tan",
        Unary::Asin => r"\arcsin",
        Unary::Acos => r"\arccos",
        Unary::Atan => r"\arctan",
        Unary::Sinh => r"\sinh",
        Unary::Cosh => r"\cosh",
        Unary::Tanh => r"\tanh",
        Unary::Exp => r"\exp",
        Unary::Ln => r"\ln",
        Unary::Log10 => r"\log_{10}",
        Unary::Sqrt | Unary::Abs | Unary::Sign | Unary::Floor => return None,
    })
}

/// Returns a number without its sign.
fn constant(size: f64) -> Piece {
    let set = numeral(size);
    let is_single = set.text.bytes().all(|c| c.is_ascii_digit() || c == b'.') || set.text == r"\pi";
    Piece::new(set.text, set.width, if is_single { Level::Atom } else { Level::Product })
}

fn name(number: usize) -> String {
    format!(r"\mathcal{{T}}_{{{number}}}")
}

fn reference(number: usize) -> Piece {
    Piece::new(name(number), 0.9 + 0.4 * number.to_string().len() as f64, Level::Atom)
}

/// Returns the large shared parts, inner ones first.
fn shared_parts(graph: &Graph, roots: &[ExprId]) -> Vec<ExprId> {
    let reachable = graph.reachable(roots);
    let mut uses: FxHashMap<ExprId, u32> = FxHashMap::default();
    let children = reachable.iter().flat_map(|&id| graph.node(id).children().as_slice().to_vec());
    for id in roots.iter().copied().chain(children) {
        *uses.entry(id).or_default() += 1;
    }
    let mut sizes: FxHashMap<ExprId, u32> = FxHashMap::default();
    let mut shared = Vec::new();
    for id in reachable {
        let children = graph.node(id).children();
        let size = children.as_slice().iter().map(|child| sizes[child]).fold(1, u32::saturating_add);
        let is_shared = size >= SHARED && uses[&id] > 1;
        if is_shared {
            shared.push(id);
        }
        sizes.insert(id, if is_shared { 1 } else { size });
    }
    shared
}
