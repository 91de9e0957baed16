//! The equations, with their units.

use super::DeclarationId;
use mechc_expr::ExprId;
use mechc_text::vocabulary::Dimension;

/// An equation.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Declaration that wrote the row.
    pub declaration: DeclarationId,
    /// Entry of `Φ`.
    pub phi: ExprId,
    /// Dimension of `phi`. It comes from the element that writes the row, or is the one that `check` found for an equation of the text; the
    /// graph cannot tell it, since plain numbers may stand for lengths.
    pub unit: Dimension,
}
