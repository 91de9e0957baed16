//! The site of a formula, which decides which points it may name.

use crate::model::Frame;
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// The two coordinates of a point (m).
pub(in crate::check) type Position = [ExprId; 2];

/// A named point in the drawing.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) struct InitialPoint {
    pub at: Position,
    /// True if its formula holds a unit, directly or through names.
    pub dimensional: bool,
}

/// The site of a formula, which decides which points it may name.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(in crate::check) enum FormulaSite {
    /// Outside all bodies.
    #[default]
    Mechanism,
    /// In the braces of a body or of the ground.
    Inside(Frame),
    /// After a body's `at`, where points of other bodies may stand.
    Drawing,
    /// After a part's `at`, where such points may stand too; coordinates are those of the frame that carries the part.
    Mount(Frame),
}

impl FormulaSite {
    /// Returns whether points of bodies may stand at the site.
    pub fn takes_drawn_points(self) -> bool {
        matches!(self, FormulaSite::Drawing | FormulaSite::Mount(_))
    }
}

/// The points that the current formula may name, and those that it has named.
#[derive(Default)]
pub(super) struct FormulaScope<'a> {
    pub site: FormulaSite,
    /// The point that the formula defines.
    pub defined: Option<&'a str>,
    /// The argument of the curve that the formula defines.
    pub argument: Option<&'a str>,
    /// The locations of a point of the body and of a point of the mechanism, if the formula names one.
    pub of_body: Option<Span>,
    pub of_mechanism: Option<Span>,
}
