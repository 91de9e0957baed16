//! Lengths that prevent the assembly of a mechanism: their messages stand next to them, and lengths on the ground, which no body shows, are
//! lines.

use super::features::Features;
use super::plane::{Path, Pose, Vector, is_finite, plus, times};
use super::{Anchor, Attachment, Look, Node, Remark, Scene, Shape};
use mechc_lang::model::{EquationForm, PointId};

/// A length that a message blames.
#[derive(Clone, PartialEq, Debug)]
pub struct Length {
    /// Frame that has the length, or `None` if a declaration prescribes it between its own two points.
    pub frame: Option<usize>,
    /// Declarations at its two ends; the same one twice if that prescribes the length.
    pub ends: [usize; 2],
    /// Text of the message.
    pub text: String,
}

/// A mechanism at rest, in which lengths are blamed.
pub(super) struct LengthMarks<'m> {
    pub features: &'m Features<'m>,
    pub poses: &'m [Pose],
    /// Indices of the declarations of the first joint and of the first equation.
    pub joints: usize,
    pub equations: usize,
}

impl LengthMarks<'_> {
    /// Adds the texts of lengths next to them.
    pub fn add(&self, scene: &mut Scene, lengths: &[Length]) {
        for length in lengths {
            let Some(ends) = self.ends(length) else { continue };
            let [from, to] = ends.map(|end| end.position(self.poses));
            if !is_finite(from) || !is_finite(to) {
                continue;
            }
            scene.remarks.push(Remark { at: times(0.5, plus(from, to)), text: length.text.clone() });
            if length.frame == Some(0) {
                scene.nodes.push(ground_line([from, to]));
            }
        }
    }

    /// Returns the ends of a length.
    fn ends(&self, length: &Length) -> Option<[Anchor; 2]> {
        let [first, second] = length.ends;
        let anchors = |declaration| self.points(declaration).into_iter().map(|point| self.features.point(point));
        let Some(frame) = length.frame else { return anchors(first).collect::<Vec<_>>().try_into().ok() };
        let on_frame = |declaration| anchors(declaration).find(|anchor| anchor.frame == frame);
        Some([on_frame(first)?, on_frame(second)?])
    }

    /// Returns the points of a joint or of a prescribed distance.
    fn points(&self, declaration: usize) -> Vec<PointId> {
        let model = self.features.model;
        if let Some(equation) = declaration.checked_sub(self.equations).and_then(|number| model.equations.get(number)) {
            return match equation.form {
                EquationForm::Distance(p, q, _) => vec![p, q],
                EquationForm::Equality(..) => Vec::new(),
            };
        }
        let joint = declaration.checked_sub(self.joints).and_then(|number| model.joints.get(number));
        joint.map_or_else(Vec::new, |joint| joint.points(model))
    }
}

fn ground_line(ends: [Vector; 2]) -> Node {
    let shapes = vec![Shape { path: Path::line(ends), look: Look::Named, point: None }];
    Node { declaration: 0, attachment: Attachment::Fixed(0), shapes }
}
