//! Lengths that do not let a mechanism be assembled: what is said of them stands beside them, and those of the ground, which no body
//! shows, are lines.

use super::features::Features;
use super::plane::{Path, Pose, Vector, is_finite, plus, times};
use super::{Anchor, Look, Node, Place, Remark, Scene, Shape, whole};
use crate::model::{EquationForm, PointId};

/// A length that a message blames, between the places that declarations have on a body.
#[derive(Clone, PartialEq, Debug)]
pub struct Length {
    /// The frame that it is of; none if a declaration prescribes it between its own two places.
    pub frame: Option<usize>,
    /// The declarations that it runs between; one and the same if that prescribes it.
    pub ends: [usize; 2],
    /// What is said of it.
    pub text: String,
}

/// Says beside lengths what is said of them; at rest, which is when they are blamed.
pub(super) fn add(scene: &mut Scene, features: &Features, poses: &[Pose], lengths: &[Length]) {
    for length in lengths {
        let Some(ends) = ends(features, length) else { continue };
        let [from, to] = ends.map(|end| end.placed(poses));
        if !is_finite(from) || !is_finite(to) {
            continue;
        }
        scene.remarks.push(Remark { at: times(0.5, plus(from, to)), text: length.text.clone() });
        if length.frame == Some(0) {
            scene.nodes.push(line_of_ground([from, to]));
        }
    }
}

fn line_of_ground(ends: [Vector; 2]) -> Node {
    let shapes = vec![Shape { path: Path::line(ends), look: Look::Named, point: None }];
    Node { declaration: 0, place: Place::Fixed(0), shapes }
}

/// The places that a length runs between.
fn ends(features: &Features, length: &Length) -> Option<[Anchor; 2]> {
    let [first, second] = length.ends;
    let Some(frame) = length.frame else {
        let points = points(features, first);
        let &[p, q] = points.as_slice() else { return None };
        return Some([p, q].map(|point| features.point(point)));
    };
    let on_frame = |declaration: usize| {
        let anchors = points(features, declaration).into_iter().map(|point| features.point(point));
        anchors.into_iter().find(|anchor| anchor.frame == frame)
    };
    Some([on_frame(first)?, on_frame(second)?])
}

/// The points of a joint, or of a distance that is prescribed.
fn points(features: &Features, declaration: usize) -> Vec<PointId> {
    let model = features.model;
    let (joints, equations) = whole::first_of_joints_and_equations(model);
    if let Some(equation) = declaration.checked_sub(equations).and_then(|number| model.equations.get(number)) {
        return match equation.form {
            EquationForm::Distance(p, q, _) => vec![p, q],
            EquationForm::Equality(..) => Vec::new(),
        };
    }
    let joint = declaration.checked_sub(joints).and_then(|number| model.joints.get(number));
    joint.map_or_else(Vec::new, |joint| joint.kind.points(model))
}
