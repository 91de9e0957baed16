//! Joints and the features that they join.

use super::{AxisId, CircleId, CurveId, Declared, Frame, Mechanism, PartId, PointId, Profile, Side};
use mechc_expr::ExprId;
use mechc_text::vocabulary;

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// The joint's name.
    pub declared: Declared,
    /// The joined features.
    pub features: JoinedFeatures,
}

/// The features that a joint joins, by its kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum JoinedFeatures {
    /// Two points coincide.
    Revolute(PointId, PointId),
    /// Two axes lie on one line.
    Translational(AxisId, AxisId),
    /// Two points coincide, and the second body keeps an angle (rad) to the first.
    Weld(PointId, PointId, ExprId),
    /// Two points keep a distance (m).
    RevoluteRevolute(PointId, PointId, ExprId),
    /// A point stays on an axis, or at an offset (m) to its left.
    RevoluteTranslational(PointId, AxisId, ExprId),
    /// Two circles roll on each other.
    Gear {
        /// The circle of the first body and that of the second body.
        circles: [CircleId; 2],
        /// True if one circle is a ring around the other.
        internal: bool,
        /// The phase `κ` (m); by default that of the drawn poses.
        phase: Option<ExprId>,
    },
    /// A circle rolls on an axis.
    RackPinion {
        /// The circle of the first body.
        pinion: CircleId,
        /// The axis of the second body.
        rack: AxisId,
        /// The phase `κ` (m); by default that of the drawn poses.
        phase: Option<ExprId>,
        /// The side on which the pinion lies; by default that of the drawn poses.
        side: Option<Side>,
    },
    /// A point stays on a profile.
    PointFollower(PointId, Profile),
    /// Two profiles touch.
    Cam(Profile, Profile),
    /// A profile touches a straight face.
    FlatFollower(Profile, AxisId),
}

impl JoinedFeatures {
    /// Returns the kind without its features.
    #[must_use]
    pub fn kind(self) -> vocabulary::JointKind {
        use vocabulary::JointKind;
        match self {
            JoinedFeatures::Revolute(..) => JointKind::Revolute,
            JoinedFeatures::Translational(..) => JointKind::Translational,
            JoinedFeatures::Weld(..) => JointKind::Weld,
            JoinedFeatures::RevoluteRevolute(..) => JointKind::RevoluteRevolute,
            JoinedFeatures::RevoluteTranslational(..) => JointKind::RevoluteTranslational,
            JoinedFeatures::Gear { internal: false, .. } => JointKind::Gear,
            JoinedFeatures::Gear { internal: true, .. } => JointKind::InternalGear,
            JoinedFeatures::RackPinion { .. } => JointKind::RackPinion,
            JoinedFeatures::PointFollower(..) => JointKind::PointFollower,
            JoinedFeatures::Cam(..) => JointKind::Cam,
            JoinedFeatures::FlatFollower(..) => JointKind::FlatFollower,
        }
    }

    /// Returns the keyword of the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.kind().word()
    }

    /// Returns the names of the coordinates that the joint adds.
    #[must_use]
    pub fn coordinate_names(self) -> &'static [&'static str] {
        match self {
            JoinedFeatures::Gear { .. } => &["theta"],
            JoinedFeatures::PointFollower(..) | JoinedFeatures::FlatFollower(..) => &["u"],
            JoinedFeatures::Cam(..) => &["u", "w"],
            _ => &[],
        }
    }

    /// Returns the points by which the joint holds its bodies; a curve has none.
    #[must_use]
    pub fn points(self, mechanism: &Mechanism) -> Vec<PointId> {
        let on_profile = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(mechanism[circle].center),
            Profile::Curve(_) => None,
        };
        let (first, second) = match self {
            JoinedFeatures::Revolute(p, q)
            | JoinedFeatures::Weld(p, q, _)
            | JoinedFeatures::RevoluteRevolute(p, q, _) => (Some(p), Some(q)),
            JoinedFeatures::Translational(a, b) => (Some(mechanism[a].origin), Some(mechanism[b].origin)),
            JoinedFeatures::RevoluteTranslational(p, a, _) => (Some(p), Some(mechanism[a].origin)),
            JoinedFeatures::Gear { circles: [c, d], .. } => (Some(mechanism[c].center), Some(mechanism[d].center)),
            JoinedFeatures::RackPinion { pinion, rack, .. } => {
                (Some(mechanism[pinion].center), Some(mechanism[rack].origin))
            }
            JoinedFeatures::PointFollower(p, profile) => (Some(p), on_profile(profile)),
            JoinedFeatures::Cam(k, m) => (on_profile(k), on_profile(m)),
            JoinedFeatures::FlatFollower(profile, a) => (on_profile(profile), Some(mechanism[a].origin)),
        };
        first.into_iter().chain(second).collect()
    }

    /// Returns the joined axes.
    #[must_use]
    pub fn axes(self) -> Vec<AxisId> {
        match self {
            JoinedFeatures::Translational(a, b) => vec![a, b],
            JoinedFeatures::RevoluteTranslational(_, a, _)
            | JoinedFeatures::RackPinion { rack: a, .. }
            | JoinedFeatures::FlatFollower(_, a) => vec![a],
            _ => Vec::new(),
        }
    }

    /// Returns the profiles of a contact.
    fn profiles(self) -> Vec<Profile> {
        match self {
            JoinedFeatures::PointFollower(_, profile) | JoinedFeatures::FlatFollower(profile, _) => vec![profile],
            JoinedFeatures::Cam(first, second) => vec![first, second],
            _ => Vec::new(),
        }
    }

    /// Returns the joined circles, including the profiles of contacts.
    #[must_use]
    pub fn circles(self) -> Vec<CircleId> {
        let on_circle = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(circle),
            Profile::Curve(_) => None,
        };
        match self {
            JoinedFeatures::Gear { circles, .. } => circles.to_vec(),
            JoinedFeatures::RackPinion { pinion, .. } => vec![pinion],
            _ => self.profiles().into_iter().filter_map(on_circle).collect(),
        }
    }

    /// Returns the curves among the profiles of a contact.
    #[must_use]
    pub fn curves(self) -> Vec<CurveId> {
        let on_curve = |profile: Profile| match profile {
            Profile::Curve(curve) => Some(curve),
            Profile::Circle(_) => None,
        };
        self.profiles().into_iter().filter_map(on_curve).collect()
    }

    /// Returns the frames of the first and the second feature.
    #[must_use]
    pub fn frames(self, mechanism: &Mechanism) -> [Frame; 2] {
        match self {
            JoinedFeatures::Revolute(p, q)
            | JoinedFeatures::Weld(p, q, _)
            | JoinedFeatures::RevoluteRevolute(p, q, _) => [mechanism[p].frame, mechanism[q].frame],
            JoinedFeatures::Translational(a, b) => [mechanism[a].frame, mechanism[b].frame],
            JoinedFeatures::RevoluteTranslational(p, a, _) => [mechanism[p].frame, mechanism[a].frame],
            JoinedFeatures::Gear { circles: [c, d], .. } => [mechanism[c].frame, mechanism[d].frame],
            JoinedFeatures::RackPinion { pinion, rack, .. } => [mechanism[pinion].frame, mechanism[rack].frame],
            JoinedFeatures::PointFollower(p, profile) => [mechanism[p].frame, profile.frame(mechanism)],
            JoinedFeatures::Cam(k, m) => [k.frame(mechanism), m.frame(mechanism)],
            JoinedFeatures::FlatFollower(profile, a) => [profile.frame(mechanism), mechanism[a].frame],
        }
    }
}
