//! The expression graph: the representation of every formula from the checked model to emitted code.
//!
//! Nodes are hash-consed, so equal formulas are one node. Children have smaller ids than their parents, so a walk by id needs no recursion.
//! Constructors simplify (`build`), derivatives come from one set of rules (`derive`, `table_derivatives`), values from one evaluator
//! (`evaluate`), and formulas to be read are put in order first (`tidy`). The owner of a graph decides what its symbols stand for.

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

/// Id of a node in a [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ExprId(u32);

impl ExprId {
    /// Returns the position in the graph, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A leaf of formulas.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Symbol {
    /// A parameter, by its number.
    Param(u32),
    /// Time, in seconds.
    Time,
    /// An input signal, or its time derivative of the given order.
    Signal {
        /// Number of the signal.
        index: u32,
        /// 0 for its value, 1 for its rate, 2 for its acceleration, 3 for a derivative that is never given.
        order: u8,
    },
    /// A generalized coordinate, or its time derivative of the given order.
    Coordinate {
        /// Number of the coordinate.
        index: u32,
        /// 0 for `q`, 1 for `q̇`, 2 for `q̈`, 3 for `q⃛`.
        order: u8,
    },
    /// A symbol whose meaning the owner of the graph defines.
    Named(u32),
    /// A number that is always 0, by its number; formulas that contain it can be differentiated with respect to it.
    Shift(u32),
    /// The derivative of a coordinate, or of its time derivative of the given order, with respect to a variable other than time.
    Varied {
        /// Number of the coordinate.
        index: u32,
        /// 0 for `q`, 1 for `q̇`, 2 for `q̈`.
        order: u8,
        /// Number of the variation, given by the owner of the graph.
        variation: u32,
    },
    /// The Lagrange multiplier of an equation, by the number of its row.
    Multiplier(u32),
    /// The derivative of a Lagrange multiplier with respect to a variable other than time.
    VariedMultiplier {
        /// Number of the row.
        row: u32,
        /// Number of the variation, given by the owner of the graph.
        variation: u32,
    },
}

/// Signal number of time in systems with input signals. Its rate is 1, except along a path whose parameter replaces time.
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

/// Comparisons; the others are these with operands exchanged or the result negated.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[allow(missing_docs)] // the names are self-explanatory
pub enum Comparison {
    Less,
    LessEqual,
    Equal,
}

/// The outermost operation of a formula.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A number by its bits; always finite, and never −0.
    Const(u64),
    /// A symbol.
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
    /// `aⁿ` for a whole n other than 0 and 1.
    Power(ExprId, i32),
    /// A function of one argument.
    Unary(Unary, ExprId),
    /// A function of two arguments.
    Binary(Binary, ExprId, ExprId),
    /// 1 if the comparison holds, else 0.
    Compare(Comparison, ExprId, ExprId),
    /// 1 if both hold, else 0.
    And(ExprId, ExprId),
    /// 1 if at least one holds, else 0.
    Or(ExprId, ExprId),
    /// 1 if the operand does not hold, else 0.
    Not(ExprId),
    /// The second operand if the first holds, else the third; the other one is not evaluated for its value.
    Select(ExprId, ExprId, ExprId),
    /// A table, or its derivative of order 1 to 3, at an argument. The cells of the table are not among the operands.
    Table(TableId, u8, ExprId),
}

impl Node {
    /// Returns the operands, in order.
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

/// Up to three operands, without allocation.
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

    /// Returns the operands, in order.
    #[must_use]
    pub fn as_slice(&self) -> &[ExprId] {
        &self.list[..self.len]
    }
}

/// Set of kinds of symbols that a formula contains.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Dependence(u16);

impl Dependence {
    /// Parameters.
    pub const PARAMS: Dependence = Dependence(1);
    /// Time and signals.
    pub const TIME: Dependence = Dependence(2);
    /// Named symbols.
    pub const NAMED: Dependence = Dependence(4);
    /// Lagrange multipliers.
    pub const MULTIPLIERS: Dependence = Dependence(1024);
    /// Derivatives of multipliers with respect to variables other than time.
    pub const VARIED_MULTIPLIERS: Dependence = Dependence(2048);
    /// Multipliers and their derivatives.
    pub const FORCES: Dependence = Dependence(1024 | 2048);

    /// Returns the kind of the coordinates' time derivatives of an order.
    #[must_use]
    pub fn coordinates(order: u8) -> Dependence {
        Dependence(8 << order)
    }

    /// Returns the kind of the derivatives of these with respect to variables other than time.
    #[must_use]
    pub fn varied(order: u8) -> Dependence {
        Dependence(128 << order)
    }

    /// Returns the union of both sets.
    #[must_use]
    pub fn or(self, other: Dependence) -> Dependence {
        Dependence(self.0 | other.0)
    }

    /// Returns whether the set contains any of `kinds`.
    #[must_use]
    pub fn on(self, kinds: Dependence) -> bool {
        self.0 & kinds.0 != 0
    }

    /// Returns whether the set contains at most parameters.
    #[must_use]
    pub fn is_constant(self) -> bool {
        self.0 & !Self::PARAMS.0 == 0
    }

    /// Returns the highest order of time derivatives of coordinates in the set.
    #[must_use]
    pub fn highest_order(self) -> Option<u8> {
        (0..4).rev().find(|&order| self.on(Self::coordinates(order)))
    }

    /// Returns the highest order of time derivatives among varied coordinates in the set.
    #[must_use]
    pub fn highest_varied_order(self) -> Option<u8> {
        (0..3).rev().find(|&order| self.on(Self::varied(order)))
    }

    /// Returns whether the set contains derivatives with respect to variables other than time.
    #[must_use]
    pub fn is_varied(self) -> bool {
        self.highest_varied_order().is_some() || self.on(Self::VARIED_MULTIPLIERS)
    }

    fn of(symbol: Symbol) -> Dependence {
        match symbol {
            Symbol::Param(_) | Symbol::Shift(_) => Self::PARAMS,
            // a signal is only known to change with time
            Symbol::Time | Symbol::Signal { .. } => Self::TIME,
            Symbol::Named(_) => Self::NAMED,
            Symbol::Coordinate { order, .. } => Self::coordinates(order),
            Symbol::Varied { order, .. } => Self::varied(order),
            Symbol::Multiplier(_) => Self::MULTIPLIERS,
            Symbol::VariedMultiplier { .. } => Self::VARIED_MULTIPLIERS,
        }
    }
}

/// If a graph has more nodes per root than this, few of them are likely to be reachable.
const SPARSE: usize = 64;

/// An arena of hash-consed formulas.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// All nodes, by id.
    nodes: IndexSet<Node, FxBuildHasher>,
    dependence: Vec<Dependence>,
    tables: Vec<Table>,
}

impl Graph {
    /// Creates an empty graph.
    #[must_use]
    pub fn new() -> Graph {
        Graph::default()
    }

    /// Returns the number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns whether the graph is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the outermost operation of a formula.
    #[must_use]
    pub fn node(&self, id: ExprId) -> Node {
        self.nodes[id.index()]
    }

    /// Iterates over all nodes, children before parents.
    pub fn nodes(&self) -> impl Iterator<Item = (ExprId, Node)> {
        self.nodes.iter().enumerate().map(|(k, node)| (ExprId(k as u32), *node))
    }

    /// Returns the kinds of symbols that a formula contains.
    #[must_use]
    pub fn dependence(&self, id: ExprId) -> Dependence {
        self.dependence[id.index()]
    }

    /// Returns the value of a formula that is a number.
    #[must_use]
    pub fn as_const(&self, id: ExprId) -> Option<f64> {
        match self.node(id) {
            Node::Const(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Returns the node of a function of one argument, if the graph contains it.
    #[must_use]
    pub fn find_unary(&self, function: Unary, argument: ExprId) -> Option<ExprId> {
        let index = self.nodes.get_index_of(&Node::Unary(function, argument));
        index.map(|index| ExprId(index as u32))
    }

    /// Returns the nodes of [`Graph::reachable`] and those in the cells of reachable tables, children before parents.
    #[must_use]
    pub(crate) fn reachable_with_tables(&self, roots: &[ExprId]) -> Vec<ExprId> {
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

    /// Returns every node that the roots depend on, children before parents.
    #[must_use]
    pub fn reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let last = roots.iter().max().map_or(0, |id| id.index() + 1);
        if last / SPARSE <= roots.len() { self.reachable_of_many(roots, last) } else { self.reachable_of_few(roots) }
    }

    /// Marks reachable nodes in an array over all nodes: for roots that need much of the graph.
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

    /// Searches from the roots: for roots that need little of the graph.
    fn reachable_of_few(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let mut visited = FxHashSet::default();
        let mut open: Vec<ExprId> = roots.to_vec();
        while let Some(id) = open.pop() {
            if visited.insert(id) {
                open.extend_from_slice(self.node(id).children().as_slice());
            }
        }
        let mut list: Vec<ExprId> = visited.into_iter().collect();
        list.sort_unstable();
        list
    }

    /// Returns the symbols in a formula and its tables, in order.
    #[must_use]
    pub fn symbols(&self, root: ExprId) -> Vec<Symbol> {
        self.symbols_of_all(&[root])
    }

    /// Returns the symbols in formulas and their tables, each once, in order.
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

    /// Returns the terms of a formula's outermost sum, without signs.
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

    /// Copies formulas of another graph into this one, with symbols replaced.
    ///
    /// `copied` maps nodes that have been copied, so that several calls share their work.
    pub fn import(
        &mut self,
        from: &Graph,
        roots: &[ExprId],
        copied: &mut FxHashMap<ExprId, ExprId>,
        mut replace: impl FnMut(&mut Graph, Symbol) -> ExprId,
    ) {
        let mut open: Vec<(ExprId, bool)> = roots.iter().map(|&id| (id, false)).collect();
        while let Some((id, children_done)) = open.pop() {
            if copied.contains_key(&id) {
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
                _ => self.rebuild(node, |child| copied[&child]),
            };
            copied.insert(id, rebuilt);
        }
    }

    /// Rewrites a formula bottom-up. `rule` gets a node and its operation on rewritten operands, and may return a replacement for the latter.
    pub fn rewritten(
        &mut self,
        root: ExprId,
        mut rule: impl FnMut(&mut Graph, Node, ExprId) -> Option<ExprId>,
    ) -> ExprId {
        let mut rewritten: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        // children come before their parents
        for id in self.reachable(&[root]) {
            let node = self.node(id);
            let plain = self.rebuild(node, |child| rewritten[&child]);
            let result = rule(self, node, plain).unwrap_or(plain);
            rewritten.insert(id, result);
        }
        rewritten[&root]
    }

    /// Replaces symbols in formulas by other formulas of this graph.
    pub fn substituted(&mut self, roots: &[ExprId], with: impl Fn(Symbol) -> Option<ExprId>) -> Vec<ExprId> {
        let mut replaced: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        // children come before their parents
        for id in self.reachable(roots) {
            let node = self.node(id);
            let result = match node {
                Node::Symbol(symbol) => with(symbol).unwrap_or(id),
                _ if node.children().as_slice().iter().all(|child| replaced.get(child) == Some(child)) => id,
                _ => self.rebuild(node, |child| replaced[&child]),
            };
            replaced.insert(id, result);
        }
        roots.iter().map(|root| replaced[root]).collect()
    }

    fn intern(&mut self, node: Node) -> ExprId {
        let (index, is_new) = self.nodes.insert_full(node);
        if is_new {
            let symbol_kinds = match node {
                Node::Symbol(symbol) => Dependence::of(symbol),
                Node::Table(table, ..) => self.tables[table.index()].dependence,
                _ => Dependence::default(),
            };
            let children = node.children();
            let all = children.as_slice().iter().fold(symbol_kinds, |all, &child| all.or(self.dependence(child)));
            self.dependence.push(all);
        }
        ExprId(index as u32)
    }
}
