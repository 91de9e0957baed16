//! Joints.

use super::{AxisId, CircleId, CurveId, Declared, Frame, Mechanism, PartId, PointId, Profile, Side};
use mechc_expr::ExprId;
use mechc_text::vocabulary;

/// A joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The part in whose text it is declared.
    pub part: Option<PartId>,
    /// Its name.
    pub declared: Declared,
    /// What it holds together, and how.
    pub kind: JointKind,
}

/// The joints, with the features they join.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum JointKind {
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
    /// Two circles roll on each other, with a phase (m) that the drawing gives if nothing else does.
    Gear {
        /// Of the first and of the second body.
        circles: [CircleId; 2],
        /// One is a ring around the other.
        internal: bool,
        /// `κ`
        phase: Option<ExprId>,
    },
    /// A circle rolls on an axis.
    RackPinion {
        /// Of the first body.
        pinion: CircleId,
        /// Of the second body.
        rack: AxisId,
        /// `κ` (m)
        phase: Option<ExprId>,
        /// Where the pinion lies, if the drawing is not to say it.
        side: Option<Side>,
    },
    /// A point stays on a line.
    PointFollower(PointId, Profile),
    /// Two lines touch.
    Cam(Profile, Profile),
    /// A line touches a straight face.
    FlatFollower(Profile, AxisId),
}

impl JointKind {
    /// The kind alone, without its features.
    #[must_use]
    pub fn plain(self) -> vocabulary::JointKind {
        use vocabulary::JointKind as Plain;
        match self {
            JointKind::Revolute(..) => Plain::Revolute,
            JointKind::Translational(..) => Plain::Translational,
            JointKind::Weld(..) => Plain::Weld,
            JointKind::RevoluteRevolute(..) => Plain::RevoluteRevolute,
            JointKind::RevoluteTranslational(..) => Plain::RevoluteTranslational,
            JointKind::Gear { internal: false, .. } => Plain::Gear,
            JointKind::Gear { internal: true, .. } => Plain::InternalGear,
            JointKind::RackPinion { .. } => Plain::RackPinion,
            JointKind::PointFollower(..) => Plain::PointFollower,
            JointKind::Cam(..) => Plain::Cam,
            JointKind::FlatFollower(..) => Plain::FlatFollower,
        }
    }

    /// The word of the language.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.plain().word()
    }

    /// The names of the coordinates that it brings along.
    #[must_use]
    pub fn own_coordinates(self) -> &'static [&'static str] {
        match self {
            JointKind::Gear { .. } => &["theta"],
            JointKind::PointFollower(..) | JointKind::FlatFollower(..) => &["u"],
            JointKind::Cam(..) => &["u", "w"],
            _ => &[],
        }
    }

    /// The points where it takes hold of its bodies; a curve has none.
    #[must_use]
    pub fn points(self, mechanism: &Mechanism) -> Vec<PointId> {
        let on_profile = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(mechanism[circle].center),
            Profile::Curve(_) => None,
        };
        let (first, second) = match self {
            JointKind::Revolute(p, q) | JointKind::Weld(p, q, _) | JointKind::RevoluteRevolute(p, q, _) => {
                (Some(p), Some(q))
            }
            JointKind::Translational(a, b) => (Some(mechanism[a].origin), Some(mechanism[b].origin)),
            JointKind::RevoluteTranslational(p, a, _) => (Some(p), Some(mechanism[a].origin)),
            JointKind::Gear { circles: [c, d], .. } => (Some(mechanism[c].center), Some(mechanism[d].center)),
            JointKind::RackPinion { pinion, rack, .. } => {
                (Some(mechanism[pinion].center), Some(mechanism[rack].origin))
            }
            JointKind::PointFollower(p, profile) => (Some(p), on_profile(profile)),
            JointKind::Cam(k, m) => (on_profile(k), on_profile(m)),
            JointKind::FlatFollower(profile, a) => (on_profile(profile), Some(mechanism[a].origin)),
        };
        first.into_iter().chain(second).collect()
    }

    /// The axes that it joins.
    #[must_use]
    pub fn axes(self) -> Vec<AxisId> {
        match self {
            JointKind::Translational(a, b) => vec![a, b],
            JointKind::RevoluteTranslational(_, a, _)
            | JointKind::RackPinion { rack: a, .. }
            | JointKind::FlatFollower(_, a) => vec![a],
            _ => Vec::new(),
        }
    }

    /// The lines that a contact runs along.
    fn profiles(self) -> Vec<Profile> {
        match self {
            JointKind::PointFollower(_, profile) | JointKind::FlatFollower(profile, _) => vec![profile],
            JointKind::Cam(first, second) => vec![first, second],
            _ => Vec::new(),
        }
    }

    /// The circles that it joins, those that a contact runs along too.
    #[must_use]
    pub fn circles(self) -> Vec<CircleId> {
        let on_circle = |profile: Profile| match profile {
            Profile::Circle(circle) => Some(circle),
            Profile::Curve(_) => None,
        };
        match self {
            JointKind::Gear { circles, .. } => circles.to_vec(),
            JointKind::RackPinion { pinion, .. } => vec![pinion],
            _ => self.profiles().into_iter().filter_map(on_circle).collect(),
        }
    }

    /// The curves that a contact runs along.
    #[must_use]
    pub fn curves(self) -> Vec<CurveId> {
        let on_curve = |profile: Profile| match profile {
            Profile::Curve(curve) => Some(curve),
            Profile::Circle(_) => None,
        };
        self.profiles().into_iter().filter_map(on_curve).collect()
    }

    /// The frames of its first and of its second feature.
    #[must_use]
    pub fn frames(self, mechanism: &Mechanism) -> [Frame; 2] {
        match self {
            JointKind::Revolute(p, q) | JointKind::Weld(p, q, _) | JointKind::RevoluteRevolute(p, q, _) => {
                [mechanism[p].frame, mechanism[q].frame]
            }
            JointKind::Translational(a, b) => [mechanism[a].frame, mechanism[b].frame],
            JointKind::RevoluteTranslational(p, a, _) => [mechanism[p].frame, mechanism[a].frame],
            JointKind::Gear { circles: [c, d], .. } => [mechanism[c].frame, mechanism[d].frame],
            JointKind::RackPinion { pinion, rack, .. } => [mechanism[pinion].frame, mechanism[rack].frame],
            JointKind::PointFollower(p, profile) => [mechanism[p].frame, profile.frame(mechanism)],
            JointKind::Cam(k, m) => [k.frame(mechanism), m.frame(mechanism)],
            JointKind::FlatFollower(profile, a) => [profile.frame(mechanism), mechanism[a].frame],
        }
    }
}
