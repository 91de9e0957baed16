//! Scopes: derivatives inside parts that move together with their surroundings, taken by a part's own equations, relative to its own
//! ground, with its inputs held.
//!
//! While derivatives are formed, an input that a part may hold is a symbol of its own, a *leaf* ([`leaf`]). A held leaf is constant; any
//! other varies as the formula that it is bound to. Afterwards each leaf is replaced by that formula. With `F` the rows of the part, over
//! its leaves, and `q` its own coordinates, `F_q q_p = −D_p F`.

use super::{DeclarationId, SparseRows};
use mechc_expr::{ExprId, Graph, Symbol};
use mechc_text::source::Span;

/// Signal numbers from this one on denote leaves.
const FIRST_LEAF: u32 = 1 << 30;

/// Number of time derivatives of a leaf that may occur, with order 0.
pub const LEAF_ORDERS: usize = 4;

/// An input of a part, as a symbol of its own while derivatives are formed.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// Index of the scope that holds it.
    pub scope: u32,
    /// Binding and its time derivatives, as formulas that may contain leaves.
    pub with_leaves: [ExprId; LEAF_ORDERS],
    /// Binding and time derivatives with all leaves replaced.
    pub plain: [ExprId; LEAF_ORDERS],
}

/// Returns the symbol of a leaf.
#[must_use]
pub fn leaf(number: usize) -> Symbol {
    Symbol::Signal { index: FIRST_LEAF + number as u32, order: 0 }
}

/// Returns the number of the leaf that a symbol denotes, and the order of its time derivative.
pub(super) fn as_leaf(symbol: Symbol) -> Option<(usize, usize)> {
    match symbol {
        Symbol::Signal { index, order } if (FIRST_LEAF..u32::MAX).contains(&index) => {
            Some(((index - FIRST_LEAF) as usize, order as usize))
        }
        _ => None,
    }
}

/// The equations of a part, which derivatives follow on their own.
#[derive(Clone, Debug)]
pub struct Scope {
    /// Name of the part.
    pub name: String,
    /// The coordinates that vary, ascending.
    pub columns: Vec<u32>,
    /// The part's entries of `Φ`, which may contain leaves.
    pub phi: Vec<ExprId>,
    /// Derivatives of the rows with respect to `columns`, without leaves; columns are coordinate numbers.
    pub phi_q: SparseRows,
}

impl Scope {
    /// Derives `phi_q`.
    pub(super) fn derive(&mut self, graph: &mut Graph, leaves: &[Leaf]) {
        self.phi_q = SparseRows::new();
        for &row in &self.phi {
            let varying = graph.slopes(row, 0).filter(|&(column, _)| self.varies(column));
            let (columns, slopes): (Vec<u32>, Vec<ExprId>) = varying.unzip();
            let slopes = without_leaves(graph, leaves, &slopes);
            self.phi_q.push(columns.into_iter().zip(slopes));
        }
    }

    /// Returns whether a coordinate varies.
    pub(super) fn varies(&self, column: u32) -> bool {
        self.columns.binary_search(&column).is_ok()
    }
}

/// Replaces leaves in formulas by their bindings.
pub(super) fn without_leaves(graph: &mut Graph, leaves: &[Leaf], roots: &[ExprId]) -> Vec<ExprId> {
    if leaves.is_empty() {
        return roots.to_vec();
    }
    graph.substituted(roots, |symbol| as_leaf(symbol).map(|(number, order)| leaves[number].plain[order]))
}

/// A part whose text requests derivatives by its own equations.
#[derive(Clone, Debug)]
pub struct PartWithDerivatives {
    /// Name.
    pub name: String,
    /// Names of the part and the parts around it, innermost first, with the spans of their declarations.
    pub used_at: Vec<(String, Span)>,
    /// Spans in its text that request derivatives.
    pub places: Vec<Span>,
    /// First span that requests the derivative of a force.
    pub of_force: Option<Span>,
    /// Coordinates, ascending.
    pub columns: Vec<u32>,
    /// Bindings of its inputs.
    pub inputs: Vec<ExprId>,
    /// Joints, constraints and drivers of the part, ascending.
    pub declarations: Vec<DeclarationId>,
}
