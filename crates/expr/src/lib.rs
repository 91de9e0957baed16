//! The expression graph: the one representation of every formula, from the checked model to emitted code.
//!
//! Nodes are hash-consed, so that equal formulas are one node and sharing costs nothing; children have smaller ids
//! than their parents, so that a walk by id needs no recursion. Constructors simplify (`build`), derivatives come
//! from one set of rules (`derive`), values from one evaluator (`evaluate`); what is to be read is put in order first
//! (`tidy`). What a symbol stands for is decided by the crate that owns the graph.

mod build;
mod derive;
mod evaluate;
pub mod math;
mod motion;
mod print;
mod table;
mod table_derivatives;
mod tidy;

pub use evaluate::{binary_value, compare, unary_value};
pub use motion::MotionLaw;
pub use print::{Printer, number};
pub use table::{Table, TableId, piece};
pub use table_derivatives::VARIED_TABLE;

use indexmap::IndexSet;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};

/// A node of a [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ExprId(u32);

impl ExprId {
    /// Position in the graph, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a formula is about.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Symbol {
    /// A parameter, by its number.
    Param(u32),
    /// Time, in seconds.
    Time,
    /// A signal, or its time derivative of the given order: an input that is not inlined.
    Signal {
        /// Number of the signal.
        index: u32,
        /// 0 for its value, 1 for its rate, 2 for its acceleration, 3 for what nobody gives.
        order: u8,
    },
    /// A generalized coordinate, or its time derivative of the given order.
    Coordinate {
        /// Number of the coordinate.
        index: u32,
        /// 0 for `q`, 1 for `q̇`, 2 for `q̈`, 3 for `q⃛`.
        order: u8,
    },
    /// Something that the owner of the graph has given a meaning to.
    Named(u32),
    /// A number that is always 0, by its number: what it is added to can be differentiated by.
    Shift(u32),
    /// The derivative of a coordinate, or of its time derivative of the given order, by something else than time.
    Varied {
        /// Number of the coordinate.
        index: u32,
        /// 0 for `q`, 1 for `q̇`, 2 for `q̈`.
        order: u8,
        /// By what; the owner of the graph gives these numbers.
        variation: u32,
    },
    /// The Lagrange multiplier of an equation, by the number of its row.
    Multiplier(u32),
    /// Its derivative by something else than time.
    VariedMultiplier {
        /// Number of the row.
        row: u32,
        /// By what; the owner of the graph gives these numbers.
        variation: u32,
    },
}

/// The number of the signal that time is where inputs are signals: its rate is 1, but along a way on which it is one of them.
pub const TIME_SIGNAL: u32 = u32::MAX;

/// Functions of one argument.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[allow(missing_docs)] // each is named as in the language
pub enum Unary {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Sign,
    Floor,
}

/// Functions of two arguments.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[allow(missing_docs)] // each is named as in the language
pub enum Binary {
    Atan2,
    Hypot,
    Min,
    Max,
    /// A power whose exponent is not a small whole number.
    Pow,
    /// `a − b·⌊a/b⌋`
    Mod,
}

/// Comparisons; the other four are these with sides exchanged or negated.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[allow(missing_docs)] // each says itself
pub enum Comparison {
    Less,
    LessEqual,
    Equal,
}

/// A formula's outermost operation.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A number, by its bits; always finite, and never −0.
    Const(u64),
    /// A leaf.
    Symbol(Symbol),
    /// `a + b`
    Add(ExprId, ExprId),
    /// `a − b`
    Sub(ExprId, ExprId),
    /// `a · b`
    Mul(ExprId, ExprId),
    /// `a / b`
    Div(ExprId, ExprId),
    /// `−a`
    Neg(ExprId),
    /// `aⁿ`, n a whole number but 0 and 1.
    Power(ExprId, i32),
    /// A function of one argument.
    Unary(Unary, ExprId),
    /// A function of two arguments.
    Binary(Binary, ExprId, ExprId),
    /// 1 if it holds, else 0.
    Compare(Comparison, ExprId, ExprId),
    /// 1 if both hold.
    And(ExprId, ExprId),
    /// 1 if one holds.
    Or(ExprId, ExprId),
    /// 1 if it does not hold.
    Not(ExprId),
    /// The second if the first holds, else the third; only that one counts.
    Select(ExprId, ExprId, ExprId),
    /// A table's derivative of some order, 0 to 3, at an argument. What the table is made of is not among the operands.
    Table(TableId, u8, ExprId),
}

impl Node {
    /// The operands, in order.
    #[must_use]
    pub fn children(self) -> Children {
        match self {
            Node::Const(_) | Node::Symbol(_) => Children::new(&[]),
            Node::Neg(a) | Node::Power(a, _) | Node::Unary(_, a) | Node::Not(a) | Node::Table(_, _, a) => {
                Children::new(&[a])
            }
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Binary(_, a, b)
            | Node::Compare(_, a, b)
            | Node::And(a, b)
            | Node::Or(a, b) => Children::new(&[a, b]),
            Node::Select(c, a, b) => Children::new(&[c, a, b]),
        }
    }
}

/// At most three operands, without an allocation.
#[derive(Clone, Copy, Debug)]
pub struct Children {
    list: [ExprId; 3],
    len: usize,
}

impl Children {
    fn new(ids: &[ExprId]) -> Children {
        let mut list = [ExprId(0); 3];
        list[..ids.len()].copy_from_slice(ids);
        Children { list, len: ids.len() }
    }

    /// In order.
    #[must_use]
    pub fn as_slice(&self) -> &[ExprId] {
        &self.list[..self.len]
    }
}

/// Which kinds of symbols a formula holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Dependence(u16);

impl Dependence {
    /// On parameters.
    pub const PARAMS: Dependence = Dependence(1);
    /// On time.
    pub const TIME: Dependence = Dependence(2);
    /// On named symbols.
    pub const NAMED: Dependence = Dependence(4);
    /// On multipliers.
    pub const MULTIPLIERS: Dependence = Dependence(1024);
    /// On what multipliers are differentiated to.
    pub const VARIED_MULTIPLIERS: Dependence = Dependence(2048);
    /// Of forces: multipliers, or their derivatives.
    pub const FORCES: Dependence = Dependence(1024 | 2048);

    /// On the coordinates' derivatives of one order.
    #[must_use]
    pub fn coordinates(order: u8) -> Dependence {
        Dependence(8 << order)
    }

    /// On what coordinates' derivatives of one order are differentiated to by something else than time.
    #[must_use]
    pub fn varied(order: u8) -> Dependence {
        Dependence(128 << order)
    }

    /// On either.
    #[must_use]
    pub fn or(self, other: Dependence) -> Dependence {
        Dependence(self.0 | other.0)
    }

    /// Whether any of `kinds` is among these.
    #[must_use]
    pub fn on(self, kinds: Dependence) -> bool {
        self.0 & kinds.0 != 0
    }

    /// Whether only parameters are, if anything.
    #[must_use]
    pub fn is_constant(self) -> bool {
        self.0 & !Self::PARAMS.0 == 0
    }

    /// The highest order of coordinates among these.
    #[must_use]
    pub fn highest_order(self) -> Option<u8> {
        (0..4).rev().find(|&order| self.on(Self::coordinates(order)))
    }

    /// The highest time derivative among those that are differentiated by something else too.
    #[must_use]
    pub fn highest_varied_order(self) -> Option<u8> {
        (0..3).rev().find(|&order| self.on(Self::varied(order)))
    }

    /// Whether anything among these is differentiated by something else than time.
    #[must_use]
    pub fn is_varied(self) -> bool {
        self.highest_varied_order().is_some() || self.on(Self::VARIED_MULTIPLIERS)
    }

    fn of(symbol: Symbol) -> Dependence {
        match symbol {
            Symbol::Param(_) | Symbol::Shift(_) => Self::PARAMS,
            // of what it is nothing is known but that it changes with time
            Symbol::Time | Symbol::Signal { .. } => Self::TIME,
            Symbol::Named(_) => Self::NAMED,
            Symbol::Coordinate { order, .. } => Self::coordinates(order),
            Symbol::Varied { order, .. } => Self::varied(order),
            Symbol::Multiplier(_) => Self::MULTIPLIERS,
            Symbol::VariedMultiplier { .. } => Self::VARIED_MULTIPLIERS,
        }
    }
}

/// Where a graph has more nodes than this for each root, few of them are likely to be needed.
const SPARSE: usize = 64;

/// An arena of formulas.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Each once, by its number.
    nodes: IndexSet<Node, FxBuildHasher>,
    dependence: Vec<Dependence>,
    tables: Vec<Table>,
}

impl Graph {
    /// An empty one.
    #[must_use]
    pub fn new() -> Graph {
        Graph::default()
    }

    /// How many nodes there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A formula's outermost operation.
    #[must_use]
    pub fn node(&self, id: ExprId) -> Node {
        self.nodes[id.index()]
    }

    /// All nodes, children before parents.
    pub fn nodes(&self) -> impl Iterator<Item = (ExprId, Node)> {
        self.nodes.iter().enumerate().map(|(k, node)| (ExprId(k as u32), *node))
    }

    /// Which kinds of symbols a formula holds.
    #[must_use]
    pub fn dependence(&self, id: ExprId) -> Dependence {
        self.dependence[id.index()]
    }

    /// The number that a formula is, if it is one.
    #[must_use]
    pub fn as_const(&self, id: ExprId) -> Option<f64> {
        match self.node(id) {
            Node::Const(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The node of a function of one argument, if the graph has it.
    #[must_use]
    pub fn find_unary(&self, function: Unary, argument: ExprId) -> Option<ExprId> {
        let known = self.nodes.get_index_of(&Node::Unary(function, argument));
        known.map(|index| ExprId(index as u32))
    }

    /// As [`Graph::reachable`], with all that the tables among them are made of.
    #[must_use]
    pub fn reachable_with_tables(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let list = self.reachable(roots);
        let mut tables: Vec<TableId> = list
            .iter()
            .filter_map(|&id| match self.node(id) {
                Node::Table(table, ..) => Some(table),
                _ => None,
            })
            .collect();
        if tables.is_empty() {
            return list;
        }
        tables.sort_unstable();
        tables.dedup();
        let mut roots = roots.to_vec();
        roots.extend(tables.iter().flat_map(|table| self.tables[table.index()].cells()));
        self.reachable(&roots)
    }

    /// Every node that the roots are built of, children before parents.
    #[must_use]
    pub fn reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let last = roots.iter().max().map_or(0, |id| id.index() + 1);
        if last / SPARSE <= roots.len() { self.reachable_of_many(roots, last) } else { self.reachable_of_few(roots) }
    }

    /// Of roots that need much of the graph: all nodes are gone through, parents before children.
    fn reachable_of_many(&self, roots: &[ExprId], last: usize) -> Vec<ExprId> {
        let mut is_needed = vec![false; last];
        for root in roots {
            is_needed[root.index()] = true;
        }
        for k in (0..last).rev() {
            if !is_needed[k] {
                continue;
            }
            for child in self.nodes[k].children().as_slice() {
                is_needed[child.index()] = true;
            }
        }
        (0..last).filter(|&k| is_needed[k]).map(|k| ExprId(k as u32)).collect()
    }

    /// Of roots that need little of it.
    fn reachable_of_few(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let mut seen = FxHashSet::default();
        let mut open: Vec<ExprId> = roots.to_vec();
        while let Some(id) = open.pop() {
            if seen.insert(id) {
                open.extend_from_slice(self.node(id).children().as_slice());
            }
        }
        let mut list: Vec<ExprId> = seen.into_iter().collect();
        list.sort_unstable();
        list
    }

    /// The symbols that a formula holds, in their order.
    #[must_use]
    pub fn symbols(&self, root: ExprId) -> Vec<Symbol> {
        self.symbols_of_all(&[root])
    }

    /// The symbols in some formulas and the tables that they hold, each once, ordered.
    #[must_use]
    pub fn symbols_of_all(&self, roots: &[ExprId]) -> Vec<Symbol> {
        let mut list: Vec<Symbol> = self
            .reachable_with_tables(roots)
            .into_iter()
            .filter_map(|id| match self.node(id) {
                Node::Symbol(symbol) => Some(symbol),
                _ => None,
            })
            .collect();
        list.sort_unstable();
        list
    }

    /// The terms of a formula's outermost sum, signs left out.
    #[must_use]
    pub fn terms(&self, root: ExprId) -> Vec<ExprId> {
        let mut terms = Vec::new();
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            match self.node(id) {
                Node::Add(a, b) | Node::Sub(a, b) => open.extend([b, a]),
                Node::Neg(a) => open.push(a),
                _ => terms.push(id),
            }
        }
        terms
    }

    /// Rebuilds formulas of another graph in this one, its symbols replaced.
    ///
    /// `known` keeps what has been rebuilt already, so that several calls share their work.
    pub fn import(
        &mut self,
        from: &Graph,
        roots: &[ExprId],
        known: &mut FxHashMap<ExprId, ExprId>,
        mut replace: impl FnMut(&mut Graph, Symbol) -> ExprId,
    ) {
        let mut open: Vec<(ExprId, bool)> = roots.iter().map(|&id| (id, false)).collect();
        while let Some((id, children_done)) = open.pop() {
            if known.contains_key(&id) {
                continue;
            }
            let node = from.node(id);
            if !children_done {
                open.push((id, true));
                open.extend(node.children().as_slice().iter().map(|&child| (child, false)));
                continue;
            }
            let rebuilt = match node {
                Node::Symbol(symbol) => replace(self, symbol),
                _ => self.rebuild(node, |child| known[&child]),
            };
            known.insert(id, rebuilt);
        }
    }

    /// A formula with something else in the place of some operations: what a rule makes of an operation as it stands, and as it is once its
    /// operands have been rewritten.
    pub fn rewritten(
        &mut self,
        root: ExprId,
        mut rule: impl FnMut(&mut Graph, Node, ExprId) -> Option<ExprId>,
    ) -> ExprId {
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        // children come before their parents
        for id in self.reachable(&[root]) {
            let node = self.node(id);
            let plain = self.rebuild(node, |child| known[&child]);
            let found = rule(self, node, plain).unwrap_or(plain);
            known.insert(id, found);
        }
        known[&root]
    }

    /// Formulas with other formulas of this graph in the place of some symbols.
    pub fn substituted(&mut self, roots: &[ExprId], with: impl Fn(Symbol) -> Option<ExprId>) -> Vec<ExprId> {
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        // children come before their parents
        for id in self.reachable(roots) {
            let node = self.node(id);
            let found = match node {
                Node::Symbol(symbol) => with(symbol).unwrap_or(id),
                _ if node.children().as_slice().iter().all(|child| known.get(child) == Some(child)) => id,
                _ => self.rebuild(node, |child| known[&child]),
            };
            known.insert(id, found);
        }
        roots.iter().map(|root| known[root]).collect()
    }

    fn intern(&mut self, node: Node) -> ExprId {
        let (index, is_new) = self.nodes.insert_full(node);
        if is_new {
            let own = match node {
                Node::Symbol(symbol) => Dependence::of(symbol),
                Node::Table(table, ..) => self.tables[table.index()].dependence,
                _ => Dependence::default(),
            };
            let children = node.children();
            self.dependence.push(children.as_slice().iter().fold(own, |all, &child| all.or(self.dependence(child))));
        }
        ExprId(index as u32)
    }
}
