//! The entries of `Φ`, each with what it is measured in.

use super::DeclarationId;
use mechc_expr::ExprId;
use mechc_text::vocabulary::Dimension;

/// An equation.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The declaration that wrote it.
    pub declaration: DeclarationId,
    /// The entry of `Φ`.
    pub phi: ExprId,
    /// What that is measured in.
    pub unit: RowUnit,
}

/// What an entry of `Φ` is measured in, in SI. It comes from what the row is, or from what `check` knows of an equation of the text: a
/// graph in which plain numbers may stand for lengths does not tell it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RowUnit {
    /// Its dimension; angles are pure numbers.
    pub dimension: Dimension,
    /// Whether an angle is a factor: what has no length is told in radians then.
    pub is_angle: bool,
}

impl RowUnit {
    /// m
    pub const LENGTH: RowUnit = RowUnit { dimension: Dimension::LENGTH, is_angle: false };
    /// m², of a squared distance or of the product of two tangents.
    pub const AREA: RowUnit = RowUnit { dimension: Dimension::AREA, is_angle: false };
    /// rad
    pub const ANGLE: RowUnit = RowUnit { dimension: Dimension::PURE, is_angle: true };
    /// A pure number, as the sine between two axes.
    pub const NUMBER: RowUnit = RowUnit { dimension: Dimension::PURE, is_angle: false };
}

/// `m`, `m^2`, `rad`, `1`.
impl std::fmt::Display for RowUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.dimension.unit_of(self.is_angle))
    }
}
