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
    /// Unit of `phi`.
    pub unit: RowUnit,
}

/// SI unit of an entry of `Φ`. It comes from the element that writes the row, or from the dimensions that `check` found for an equation of
/// the text; the graph cannot tell it, since plain numbers may stand for lengths.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RowUnit {
    /// Dimension; angles are pure numbers.
    pub dimension: Dimension,
    /// True if an angle is a factor; a unit without length is then printed in radians.
    pub is_angle: bool,
}

impl RowUnit {
    /// Metres.
    pub const LENGTH: RowUnit = RowUnit { dimension: Dimension::LENGTH, is_angle: false };
    /// Square metres, of a squared distance or of the product of two tangents.
    pub const AREA: RowUnit = RowUnit { dimension: Dimension::AREA, is_angle: false };
    /// Radians.
    pub const ANGLE: RowUnit = RowUnit { dimension: Dimension::PURE, is_angle: true };
    /// A pure number, such as the sine of the angle between two axes.
    pub const NUMBER: RowUnit = RowUnit { dimension: Dimension::PURE, is_angle: false };
}

/// `m`, `m^2`, `rad`, `1`.
impl std::fmt::Display for RowUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.dimension.unit_of(self.is_angle))
    }
}
