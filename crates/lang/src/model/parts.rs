//! Parts within a mechanism.

use super::{Declared, Frame, PartId};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// The declarations of another mechanism, once more.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its name, with those of the parts around it.
    pub declared: Declared,
    /// The name of its mechanism, in the text of that.
    pub text: Span,
    /// What is bound of its params, by their names there; a coordinate of a point has its own.
    pub params: Vec<(String, ExprId)>,
    /// What its inputs are.
    pub inputs: Vec<(String, ExprId)>,
    /// What its ground is called.
    pub ground_name: String,
    /// The part in whose text it is declared.
    pub within: Option<PartId>,
    /// What its ground is fixed on.
    pub mount: Frame,
    /// Where its frame is in that of the mount: x (m), y (m), phi (rad), in the handedness of the text that declares it.
    pub pose: [ExprId; 3],
    /// Whether its text is mirrored in the text that declares it.
    pub is_turned_over: bool,
    /// Whether its text is mirrored in the end.
    pub is_mirrored: bool,
}

/// A derivative by an input or parameter that the text of a part asks for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AskedInPart {
    /// The part.
    pub part: PartId,
    /// Where it does.
    pub span: Span,
    /// Whether it is that of a force.
    pub is_of_force: bool,
}
