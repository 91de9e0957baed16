//! Where formulas stand, as far as that decides which points they may name.

use crate::model::Frame;
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// The two coordinates of a point (m).
pub(super) type Place = [ExprId; 2];

/// A point with a name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub at: Place,
    /// Whether its formula holds a unit, or something that does.
    pub dimensional: bool,
}

/// Where a formula stands, as far as that decides which points it may name.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) enum Site {
    /// Outside all bodies.
    #[default]
    Mechanism,
    /// In the braces of a body or of the ground.
    Inside(Frame),
    /// Behind a body's `at`, where points of other bodies may stand.
    Drawing,
    /// Behind a part's `at`: such points stand there too, and all is in the frame that carries the part.
    Mount(Frame),
}

impl Site {
    /// Whether points of bodies may stand there.
    pub fn takes_drawn_points(self) -> bool {
        matches!(self, Site::Drawing | Site::Mount(_))
    }
}

/// The points that the formula at hand may name, and those it has named.
#[derive(Default)]
pub(super) struct Scope<'a> {
    pub site: Site,
    /// The point whose own formula it is.
    pub defined: Option<&'a str>,
    /// The argument of the curve whose formula it is.
    pub argument: Option<&'a str>,
    /// Where it names a point of the body, and one of the mechanism.
    pub own: Option<Span>,
    pub of_mechanism: Option<Span>,
}
