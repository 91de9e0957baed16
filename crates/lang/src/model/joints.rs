//! Joints and the features that they join.

use super::{AxisId, CircleId, CurveId, Declared, Frame, Mechanism, PartId, PointId, Profile};
use mechc_expr::ExprId;
use mechc_text::vocabulary::{JointMotion, JointSpec};

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// The joint's name.
    pub declared: Declared,
    /// The kind, whose signature decides the kinds of features and arguments.
    pub spec: &'static JointSpec,
    /// The feature of the first body and that of the second body.
    pub features: [JointFeature; 2],
    /// The arguments that follow the features, in order. Those that are zero by default are always there.
    pub arguments: Vec<Argument>,
}

/// A feature that a joint joins.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum JointFeature {
    /// A point.
    Point(PointId),
    /// An axis.
    Axis(AxisId),
    /// A circle or curve.
    Profile(Profile),
}

/// An argument of a joint that is not a feature.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Argument {
    /// An angle (rad) or a length (m).
    Value(ExprId),
    /// A word that makes a difference.
    Word(&'static str),
}

impl JointFeature {
    /// Returns the frame to which the feature is fixed.
    #[must_use]
    pub fn frame(self, mechanism: &Mechanism) -> Frame {
        match self {
            JointFeature::Point(point) => mechanism[point].frame,
            JointFeature::Axis(axis) => mechanism[axis].frame,
            JointFeature::Profile(profile) => profile.frame(mechanism),
        }
    }

    /// Returns the point, the origin of the axis, or the centre of the circle; a curve has none.
    #[must_use]
    pub fn point(self, mechanism: &Mechanism) -> Option<PointId> {
        match self {
            JointFeature::Point(point) => Some(point),
            JointFeature::Axis(axis) => Some(mechanism[axis].origin),
            JointFeature::Profile(Profile::Circle(circle)) => Some(mechanism[circle].center),
            JointFeature::Profile(Profile::Curve(_)) => None,
        }
    }

    /// Returns the profile, if it is one.
    #[must_use]
    pub fn profile(self) -> Option<Profile> {
        if let JointFeature::Profile(profile) = self { Some(profile) } else { None }
    }

    /// Returns the circle, if it is one.
    #[must_use]
    pub fn circle(self) -> Option<CircleId> {
        if let JointFeature::Profile(Profile::Circle(circle)) = self { Some(circle) } else { None }
    }

    /// Returns the axis, if it is one.
    #[must_use]
    pub fn axis(self) -> Option<AxisId> {
        if let JointFeature::Axis(axis) = self { Some(axis) } else { None }
    }
}

impl Joint {
    /// Returns the frames of the first and the second feature.
    #[must_use]
    pub fn frames(&self, mechanism: &Mechanism) -> [Frame; 2] {
        self.features.map(|feature| feature.frame(mechanism))
    }

    /// Returns the points by which the joint holds its bodies; a curve has none.
    #[must_use]
    pub fn points(&self, mechanism: &Mechanism) -> Vec<PointId> {
        self.features.iter().filter_map(|feature| feature.point(mechanism)).collect()
    }

    /// Returns the joined axes.
    pub fn axes(&self) -> impl Iterator<Item = AxisId> {
        self.features.iter().filter_map(|feature| feature.axis())
    }

    /// Returns the joined circles and curves.
    pub fn profiles(&self) -> impl Iterator<Item = Profile> {
        self.features.iter().filter_map(|feature| feature.profile())
    }

    /// Returns the joined circles, including the profiles of contacts.
    pub fn circles(&self) -> impl Iterator<Item = CircleId> {
        self.features.iter().filter_map(|feature| feature.circle())
    }

    /// Returns the curves among the profiles of a contact.
    pub fn curves(&self) -> impl Iterator<Item = CurveId> {
        self.profiles().filter_map(|profile| match profile {
            Profile::Curve(curve) => Some(curve),
            Profile::Circle(_) => None,
        })
    }

    /// Returns the points about which the joint lets its bodies turn, if it has a `rotation`.
    #[must_use]
    pub fn pin(&self) -> Option<[PointId; 2]> {
        match self.features {
            [JointFeature::Point(p), JointFeature::Point(q)] if self.spec.motion == Some(JointMotion::Rotation) => {
                Some([p, q])
            }
            _ => None,
        }
    }

    /// Returns the axes along which the joint lets its bodies slide, if it has a `displacement`.
    #[must_use]
    pub fn guide(&self) -> Option<[AxisId; 2]> {
        match self.features {
            [JointFeature::Axis(a), JointFeature::Axis(b)] if self.spec.motion == Some(JointMotion::Displacement) => {
                Some([a, b])
            }
            _ => None,
        }
    }

    /// Returns the argument that is an angle (rad) or a length (m), if it is given or 0 by default.
    #[must_use]
    pub fn value(&self) -> Option<ExprId> {
        self.arguments.iter().find_map(|argument| if let Argument::Value(id) = argument { Some(*id) } else { None })
    }

    /// Returns whether a word is among the arguments.
    #[must_use]
    pub fn has_word(&self, word: &str) -> bool {
        self.arguments.iter().any(|argument| matches!(argument, Argument::Word(other) if *other == word))
    }
}
