//! Differentiated equations: they share the matrix `Φ_q` and differ in their right sides.

use super::{ConstraintSystem, Input};
use mechc_expr::{ExprId, Graph, Symbol};

/// The variables by which `Φ = 0` is differentiated.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum With {
    /// Time, by the order: 1 gives `ν`, 2 gives `γ`, 3 the right side of the jerk equation.
    Time(u8),
    /// An input, by its position among the inputs.
    Input(usize),
    /// A parameter, by its number.
    Param(usize),
}

/// Right side of the equations for one derivative of `q`.
#[derive(Clone, Debug)]
pub struct RightSide {
    /// Variable of differentiation.
    pub with: With,
    /// One entry per row [unit of the row / unit of the variable].
    pub entries: Vec<ExprId>,
}

impl RightSide {
    /// Keeps only the entries of the given rows.
    pub(super) fn keep(&mut self, rows: &[usize]) {
        self.entries = rows.iter().map(|&row| self.entries[row]).collect();
    }
}

impl ConstraintSystem {
    /// Returns `ν`, one entry per row [unit of the row / s].
    #[must_use]
    pub fn nu(&self) -> &[ExprId] {
        self.right_side(With::Time(1)).unwrap_or_default()
    }

    /// Returns `γ`, one entry per row [unit of the row / s²].
    #[must_use]
    pub fn gamma(&self) -> &[ExprId] {
        self.right_side(With::Time(2)).unwrap_or_default()
    }

    /// Returns the right side of the jerk equation, if a measure needs it [unit of the row / s³].
    #[must_use]
    pub fn jerk(&self) -> Option<&[ExprId]> {
        self.right_side(With::Time(3))
    }

    /// Returns `−Φ_u` for each input, if the equations contain inputs as signals [unit of the row / unit of the input].
    #[must_use]
    pub fn by_inputs(&self) -> impl ExactSizeIterator<Item = &[ExprId]> {
        self.all_with(|with| matches!(with, With::Input(_)))
    }

    /// Returns `−Φ_p` for each parameter, if requested [unit of the row / unit of the parameter].
    #[must_use]
    pub fn by_params(&self) -> impl ExactSizeIterator<Item = &[ExprId]> {
        self.all_with(|with| matches!(with, With::Param(_)))
    }

    /// Returns the variables other than time that `q` is differentiated by: inputs, then parameters.
    #[must_use]
    pub fn slopes(&self) -> Vec<With> {
        let all = self.right_sides.iter().map(|side| side.with);
        all.filter(|with| !matches!(with, With::Time(_))).collect()
    }

    /// Returns all right sides, in the order of [`With`].
    #[must_use]
    pub fn right_sides(&self) -> &[RightSide] {
        &self.right_sides
    }

    fn right_side(&self, with: With) -> Option<&[ExprId]> {
        self.right_sides.iter().find(|side| side.with == with).map(|side| side.entries.as_slice())
    }

    fn all_with(&self, is_selected: impl Fn(With) -> bool) -> impl ExactSizeIterator<Item = &[ExprId]> {
        let entries = self.right_sides.iter().filter(|side| is_selected(side.with)).map(|side| side.entries.as_slice());
        entries.collect::<Vec<&[ExprId]>>().into_iter()
    }

    /// Replaces right sides; all stay in the order of [`With`].
    fn set_right_sides(&mut self, is_replaced: impl Fn(With) -> bool, sides: impl IntoIterator<Item = RightSide>) {
        self.right_sides.retain(|side| !is_replaced(side.with));
        self.right_sides.extend(sides);
        self.right_sides.sort_by_key(|side| side.with);
    }

    /// Derives `ν`, `γ`, and with `with_jerk` the right side of the jerk equation.
    pub(super) fn derive_by_time(&mut self, with_jerk: bool) {
        let phi = self.phi();
        let graph = &mut self.graph;
        let phi_t = Self::time_derivatives(graph, &phi, 0);
        let mut sides = vec![negated(graph, With::Time(1), phi_t)];
        // Φ̇ holds q̇; what remains of Φ̈ when q̈ is left out is −γ
        let first = Self::time_derivatives(graph, &phi, 1);
        let second = Self::time_derivatives(graph, &first, 1);
        sides.push(negated(graph, With::Time(2), second));
        if with_jerk {
            let second = Self::time_derivatives(graph, &first, 2);
            let third = Self::time_derivatives(graph, &second, 2);
            sides.push(negated(graph, With::Time(3), third));
        }
        self.set_right_sides(|with| matches!(with, With::Time(_)), sides);
    }

    /// Derives the right sides for the derivatives of `q` with respect to each input signal.
    pub(super) fn derive_by_inputs(&mut self) {
        let signals: Vec<Symbol> = self.inputs.iter().map(Input::symbol).collect();
        let sides = signals.into_iter().enumerate().map(|(k, symbol)| self.by(With::Input(k), symbol));
        let sides: Vec<RightSide> = sides.collect();
        self.set_right_sides(|with| matches!(with, With::Input(_)), sides);
    }

    /// Derives the right sides for the derivatives of `q` with respect to each parameter, through tables too.
    pub fn derive_by_params(&mut self) {
        let sides = (0..self.params.len()).map(|k| self.by(With::Param(k), Symbol::Param(k as u32)));
        let sides: Vec<RightSide> = sides.collect();
        self.set_right_sides(|with| matches!(with, With::Param(_)), sides);
        self.derive_checks();
    }

    /// Returns the negated partial derivatives of `Φ` with respect to a symbol.
    fn by(&mut self, with: With, symbol: Symbol) -> RightSide {
        let phi = self.phi();
        let slopes = slopes_by(&mut self.graph, &phi, symbol);
        negated(&mut self.graph, with, slopes)
    }
}

/// Returns the partial derivatives of formulas with respect to a symbol, through tables too.
pub(super) fn slopes_by(graph: &mut Graph, formulas: &[ExprId], variable: Symbol) -> Vec<ExprId> {
    graph.variations(formulas, |graph, symbol| (symbol == variable).then(|| graph.constant(1.0)))
}

fn negated(graph: &mut Graph, with: With, slopes: Vec<ExprId>) -> RightSide {
    RightSide { with, entries: slopes.into_iter().map(|id| graph.neg(id)).collect() }
}
