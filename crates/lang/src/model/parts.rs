//! Parts: instances of other mechanisms.

use super::{Declared, Frame, PartId};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// An instance of another mechanism.
#[derive(Clone, Debug)]
pub struct Part {
    /// The part's name, prefixed with those of the parts that enclose it.
    pub declared: Declared,
    /// The name of the instantiated mechanism, in that mechanism's text.
    pub text: Span,
    /// The bound parameters, by their names in the part; each coordinate of a point has its own entry.
    pub params: Vec<(String, ExprId)>,
    /// The formulas of the inputs, by their names in the part.
    pub inputs: Vec<(String, ExprId)>,
    /// The name of the part's ground.
    pub ground_name: String,
    /// The part in whose text it is declared.
    pub within: Option<PartId>,
    /// The frame to which the part's ground is fixed.
    pub mount: Frame,
    /// The pose of the part's ground in the mount: x (m), y (m), phi (rad), in the handedness of the text that declares the part.
    pub pose: [ExprId; 3],
    /// True if the part's text is mirrored relative to the text that declares the part.
    pub is_mirrored_in_parent: bool,
    /// True if the part's text is mirrored relative to the ground.
    pub is_mirrored: bool,
}

/// A derivative by an input or parameter in the text of a part.
#[derive(Clone, Debug)]
pub struct PartDerivative {
    /// The part.
    pub part: PartId,
    /// The location of the derivative.
    pub span: Span,
    /// The derivative as the outermost mechanism can write it; `None` if it cannot.
    pub from_outside: Option<String>,
}
