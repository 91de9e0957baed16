//! Parts that move together with what is around them, and derivatives inside them: by a part's own equations, seen from its own ground,
//! with its inputs held.
//!
//! Where derivatives are made, an input that a part may hold is a symbol of its own, a *leaf* ([`leaf`]). Held, it does not change; else it
//! changes as what it is bound to. When all is made, each stands again for that. With `F` the rows of the part, over its leaves, and `q` its
//! coordinates alone, `F_q q_p = −D_p F`.

use super::{DeclarationId, SparseRows};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_text::source::Span;

/// The signals from this number on are leaves.
const FIRST_LEAF: u32 = 1 << 30;

/// The orders in time of a leaf that are ever met.
pub const LEAF_ORDERS: usize = 4;

/// An input of a part, as a symbol of its own while derivatives are made.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The number of the scope that holds it.
    pub scope: u32,
    /// What it is bound to, with time derivatives, over leaves.
    pub over_leaves: [ExprId; LEAF_ORDERS],
    /// The same without leaves.
    pub plain: [ExprId; LEAF_ORDERS],
}

/// The symbol of a leaf.
#[must_use]
pub fn leaf(number: usize) -> Symbol {
    Symbol::Signal { index: FIRST_LEAF + number as u32, order: 0 }
}

/// The number of the leaf that a symbol is, and its order in time.
pub(super) fn as_leaf(symbol: Symbol) -> Option<(usize, usize)> {
    match symbol {
        Symbol::Signal { index, order } if (FIRST_LEAF..u32::MAX).contains(&index) => {
            Some(((index - FIRST_LEAF) as usize, order as usize))
        }
        _ => None,
    }
}

/// Equations that stand for themselves where derivatives are taken: those of a part.
#[derive(Clone, Debug)]
pub struct Scope {
    /// The part's name.
    pub name: String,
    /// The coordinates that vary, ascending.
    pub columns: Vec<u32>,
    /// The part's entries of `Φ`, over leaves.
    pub phi: Vec<ExprId>,
    /// Their derivatives by the coordinates that vary; the columns are these coordinates' numbers. Without leaves.
    pub phi_q: SparseRows,
}

impl Scope {
    /// Finds the derivatives of the rows by what varies.
    pub(super) fn derive(&mut self, graph: &mut Graph, leaves: &[Leaf]) {
        self.phi_q = SparseRows::new();
        for &row in &self.phi {
            let own = graph.slopes(row, 0).filter(|&(column, _)| self.varies(column));
            let (columns, slopes): (Vec<u32>, Vec<ExprId>) = own.unzip();
            let slopes = without_leaves(graph, leaves, &slopes);
            self.phi_q.push(columns.into_iter().zip(slopes));
        }
    }

    /// Whether a coordinate varies.
    pub(super) fn varies(&self, column: u32) -> bool {
        self.columns.binary_search(&column).is_ok()
    }
}

/// Formulas with what leaves are bound to in their places.
pub(super) fn without_leaves(graph: &mut Graph, leaves: &[Leaf], roots: &[ExprId]) -> Vec<ExprId> {
    if leaves.is_empty() {
        return roots.to_vec();
    }
    graph.substituted(roots, |symbol| as_leaf(symbol).map(|(number, order)| leaves[number].plain[order]))
}

/// A part whose text asks for derivatives by its own equations.
#[derive(Clone, Debug)]
pub struct AskingPart {
    /// Its name.
    pub name: String,
    /// The names of it and of the parts around it, from the inside out, and where they are used.
    pub used_at: Vec<(String, Span)>,
    /// Where derivatives are asked for, in its text.
    pub places: Vec<Span>,
    /// The first place where that is the derivative of a force.
    pub of_force: Option<Span>,
    /// Its coordinates, ascending.
    pub columns: Vec<u32>,
    /// What its inputs are bound to.
    pub inputs: Vec<ExprId>,
    /// Its joints, constraints and drivers, ascending.
    pub declarations: Vec<DeclarationId>,
}
