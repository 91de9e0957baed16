//! Joints, with the equations of each.

use super::{Category, Example, Word};

/// Kind of joint.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs)] // the entries of `JOINTS` document them
pub enum JointKind {
    Revolute,
    Translational,
    Weld,
    RevoluteRevolute,
    RevoluteTranslational,
    Gear,
    InternalGear,
    RackPinion,
    PointFollower,
    Cam,
    FlatFollower,
}

impl JointKind {
    /// Returns the word of the language.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            JointKind::Revolute => "revolute",
            JointKind::Translational => "translational",
            JointKind::Weld => "weld",
            JointKind::RevoluteRevolute => "revolute_revolute",
            JointKind::RevoluteTranslational => "revolute_translational",
            JointKind::Gear => "gear",
            JointKind::InternalGear => "internal_gear",
            JointKind::RackPinion => "rack_pinion",
            JointKind::PointFollower => "point_follower",
            JointKind::Cam => "cam",
            JointKind::FlatFollower => "flat_follower",
        }
    }

    /// Returns whether a quantity such as `rotation` or `displacement` is defined for the joint. All quantities of reactions are, except
    /// `torque`.
    #[must_use]
    pub fn has_quantity(self, quantity: &str) -> bool {
        match quantity {
            "rotation" => self == JointKind::Revolute,
            "displacement" => self == JointKind::Translational,
            "slip" | "pressure_angle" => self.has_contact(),
            "torque" => self.has_torque(),
            _ => true,
        }
    }

    /// Returns whether the joint is a contact of two outlines, or of a point and an outline.
    #[must_use]
    pub const fn has_contact(self) -> bool {
        match self {
            JointKind::PointFollower | JointKind::Cam | JointKind::FlatFollower => true,
            JointKind::Revolute
            | JointKind::Translational
            | JointKind::Weld
            | JointKind::RevoluteRevolute
            | JointKind::RevoluteTranslational
            | JointKind::Gear
            | JointKind::InternalGear
            | JointKind::RackPinion => false,
        }
    }

    /// Returns whether the joint's reaction can have a moment about its point of action; for the others it is zero.
    #[must_use]
    pub const fn has_torque(self) -> bool {
        match self {
            JointKind::Translational
            | JointKind::Weld
            | JointKind::RevoluteTranslational
            | JointKind::Gear
            | JointKind::InternalGear
            | JointKind::RackPinion => true,
            JointKind::Revolute
            | JointKind::RevoluteRevolute
            | JointKind::PointFollower
            | JointKind::Cam
            | JointKind::FlatFollower => false,
        }
    }
}

/// A kind of joint in the language.
#[derive(Debug)]
pub struct JointWord {
    /// Kind.
    pub kind: JointKind,
    /// Documentation.
    pub word: Word,
    /// Arguments in words.
    pub takes: &'static str,
    /// Number of equations.
    pub equations: usize,
    /// Coordinates of the joint, with descriptions.
    pub coordinates: &'static [(&'static str, &'static str)],
}

impl JointWord {
    /// Returns the joint of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static JointWord> {
        JOINTS.iter().find(|joint| joint.word.name == name)
    }
}

/// Notation of the equations.
pub const NOTATION: &str = "Here i is the body of the first argument and j that of the second, `r` a place in the ground's frame, `d` \
                            from the first argument's point to the second's, `v` the unit direction of an axis, `v^⊥` that turned \
                            by +90°, `φ` a body's angle and `A` its rotation matrix.";

/// All joints.
pub static JOINTS: &[JointWord] = &[
    JointWord {
        kind: JointKind::Revolute,
        word: Word {
            name: JointKind::Revolute.word(),
            category: Category::Joint,
            forms: &["revolute(P, Q)"],
            letters: "",
            meaning: "two points coincide, and the bodies turn about them",
            more: "`Φ = r_i^P − r_j^Q`",
            example: Example::Arm("driver motor: rotation(main) = 60 rpm * t"),
        },
        takes: "two points",
        equations: 2,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::Translational,
        word: Word {
            name: JointKind::Translational.word(),
            category: Category::Joint,
            forms: &["translational(a, b)"],
            letters: "a and b axes",
            meaning: "two axes lie on one line, and the bodies slide along it without turning",
            more: "`Φ = [v_i^⊥ᵀ d, v_i^⊥ᵀ v_j]`. Parallel and antiparallel axes both satisfy it; the poses in `at` decide which.",
            example: Example::Whole(
                "\
ground {
    axis way = (0, 0) along (1, 0)
}
body slide {
    axis way = (0, 0) along (1, 0)
}
joint guide: translational(ground.way, slide.way)
driver piston: displacement(guide) = 50 mm + 20 mm/s * t",
            ),
        },
        takes: "two axes",
        equations: 2,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::Weld,
        word: Word {
            name: JointKind::Weld.word(),
            category: Category::Joint,
            forms: &["weld(P, Q)", "weld(P, Q, angle)"],
            letters: "",
            meaning: "two points coincide, and the bodies do not turn against each other",
            more: "`Φ = [r_i^P − r_j^Q, φ_j − φ_i − φ_0]`, `φ_0` the angle, 0 if it is not given.",
            example: Example::Whole(
                "\
ground {
    point O = (0, 0)
}
body arm {
    point O   = (0, 0)
    point tip = (100 mm, 0)
}
body tool at (100 mm, 0, 30 deg) {
    point O = (0, 0)
}
joint main: revolute(ground.O, arm.O)
joint seat: weld(arm.tip, tool.O, 30 deg)
driver motor: rotation(main) = 60 rpm * t",
            ),
        },
        takes: "two points, and an angle if it is not 0",
        equations: 3,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::RevoluteRevolute,
        word: Word {
            name: JointKind::RevoluteRevolute.word(),
            category: Category::Joint,
            forms: &["revolute_revolute(P, Q, length)"],
            letters: "",
            meaning: "two points stay at a distance, as if a massless link with a pin at both ends joined them",
            more: "`Φ = dᵀd − L²`, L the length, which is positive.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point D = (200 mm, 0)
}
body crank at (0, 0, 90 deg) {
    point A = (0, 0)
    point B = (50 mm, 0)
}
body rocker at (200 mm, 0, 90 deg) {
    point D = (0, 0)
    point C = (120 mm, 0)
}
joint main: revolute(ground.A, crank.A)
joint pivot: revolute(ground.D, rocker.D)
joint rod: revolute_revolute(crank.B, rocker.C, 210 mm)
driver motor: rotation(main) = 90 deg + 60 rpm * t",
            ),
        },
        takes: "two points and a length",
        equations: 1,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::RevoluteTranslational,
        word: Word {
            name: JointKind::RevoluteTranslational.word(),
            category: Category::Joint,
            forms: &["revolute_translational(P, a)", "revolute_translational(P, a, offset)"],
            letters: "",
            meaning: "a point stays on an axis, as a pin in a slot",
            more: "`Φ = v_j^⊥ᵀ (r_i^P − r_j^a) − c`, c the offset to the left of the axis, 0 if it is not given.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point B = (0, -150 mm)
}
body crank {
    point A   = (0, 0)
    point pin = (50 mm, 0)
}
body arm at (0, -150 mm, 70 deg) {
    point B   = (0, 0)
    axis slot = B along (1, 0)
}
joint main: revolute(ground.A, crank.A)
joint pivot: revolute(ground.B, arm.B)
joint guide: revolute_translational(crank.pin, arm.slot)
driver motor: rotation(main) = 60 rpm * t",
            ),
        },
        takes: "a point and an axis, and an offset if it is not 0",
        equations: 1,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::Gear,
        word: Word {
            name: JointKind::Gear.word(),
            category: Category::Joint,
            forms: &["gear(c, d)", "gear(c, d, phase)"],
            letters: "c and d circles",
            meaning: "two circles roll on each other from outside",
            more: "`Φ = [−dx sin θ + dy cos θ, R_i(φ_i − θ) + R_j(φ_j − θ) − κ]`, (dx, dy) from centre to centre. The phase `κ`, a \
                   length, is taken from the poses in `at` if it is not given. Gears do not hold their centres apart: the \
                   bodies' other joints do.",
            example: Example::Whole(
                "\
ground {
    point A = (0, 0)
    point B = (90 mm, 0)
}
body pinion {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body wheel at (90 mm, 0, 0) {
    circle pitch = (0, 0) radius 60 mm
    point O      = (0, 0)
}
joint axle: revolute(ground.A, pinion.O)
joint shaft: revolute(ground.B, wheel.O)
joint mesh: gear(pinion.pitch, wheel.pitch)
driver motor: rotation(axle) = 60 rpm * t",
            ),
        },
        takes: "two circles, and a phase if the drawing does not give it",
        equations: 2,
        coordinates: &[("theta", "the direction of the line of centres")],
    },
    JointWord {
        kind: JointKind::InternalGear,
        word: Word {
            name: JointKind::InternalGear.word(),
            category: Category::Joint,
            forms: &["internal_gear(c, d)", "internal_gear(c, d, phase)"],
            letters: "c and d circles",
            meaning: "two circles roll on each other, one of them a ring around the other",
            more: "`Φ = [−dx sin θ + dy cos θ, R_i(φ_i − θ) − R_j(φ_j − θ) − κ]`, (dx, dy) from centre to centre. The phase `κ`, a \
                   length, is taken from the poses in `at` if it is not given. Gears do not hold their centres apart: the \
                   bodies' other joints do.",
            example: Example::Whole(
                "\
ground {
    point A = (60 mm, 0)
    point B = (0, 0)
}
body pinion at (60 mm, 0, 0) {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body ring {
    circle pitch = (0, 0) radius 90 mm
    point O      = (0, 0)
}
joint axle: revolute(ground.A, pinion.O)
joint shaft: revolute(ground.B, ring.O)
joint mesh: internal_gear(pinion.pitch, ring.pitch)
driver motor: rotation(axle) = 60 rpm * t",
            ),
        },
        takes: "two circles, and a phase if the drawing does not give it",
        equations: 2,
        coordinates: &[("theta", "the direction of the line of centres")],
    },
    JointWord {
        kind: JointKind::RackPinion,
        word: Word {
            name: JointKind::RackPinion.word(),
            category: Category::Joint,
            forms: &["rack_pinion(c, a)", "rack_pinion(c, a, phase)", "rack_pinion(c, a, phase, left)"],
            letters: "c a circle and a an axis",
            meaning: "a circle rolls on an axis",
            more: "`Φ = v_jᵀ(r_i^c − r_j^a) + σ R (φ_i − φ_j) − κ`, σ = +1 if the centre lies to the left of the axis, −1 to the \
                   right. The side and the phase `κ`, a length, are taken from the poses in `at` if they are not given. The \
                   pinion is not held at its distance: the bodies' other joints do that.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 30 mm)
    axis way = (0, 0) along (1, 0)
}
body pinion at (0, 30 mm, 0) {
    circle pitch = (0, 0) radius 30 mm
    point O      = (0, 0)
}
body rack {
    axis way = (0, 0) along (1, 0)
}
joint axle: revolute(ground.O, pinion.O)
joint guide: translational(ground.way, rack.way)
joint mesh: rack_pinion(pinion.pitch, rack.way)
driver motor: rotation(axle) = 30 deg/s * t",
            ),
        },
        takes: "a circle and an axis, and a phase and a side if the drawing does not give them",
        equations: 1,
        coordinates: &[],
    },
    JointWord {
        kind: JointKind::PointFollower,
        word: Word {
            name: JointKind::PointFollower.word(),
            category: Category::Joint,
            forms: &["point_follower(P, k)"],
            letters: "k a curve or circle",
            meaning: "a point stays on a curve",
            more: "`Φ = r_j + A_j k(u) − r_i^P`",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 40 mm, 0) {
    point tip = (0, 0)
    axis way  = tip along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: point_follower(rod.tip, disc.profile)
driver motor: rotation(axle) = 60 rpm * t",
            ),
        },
        takes: "a point and a curve",
        equations: 2,
        coordinates: &[("u", "the argument of the curve at the point")],
    },
    JointWord {
        kind: JointKind::Cam,
        word: Word {
            name: JointKind::Cam.word(),
            category: Category::Joint,
            forms: &["cam(k, m)"],
            letters: "k and m curves or circles",
            meaning: "two curves touch",
            more: "`Φ = [r_i + A_i k(u) − r_j − A_j m(w), (A_i k'(u))^⊥ᵀ (A_j m'(w))]`: the points meet, and the tangents are \
                   parallel.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 50 mm, 0) {
    circle roller = (0, 0) radius 10 mm
    axis way      = (0, 0) along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: cam(disc.profile, rod.roller)
driver motor: rotation(axle) = 60 rpm * t",
            ),
        },
        takes: "two curves",
        equations: 3,
        coordinates: &[
            ("u", "the argument of the first curve at the contact"),
            ("w", "the argument of the second curve there"),
        ],
    },
    JointWord {
        kind: JointKind::FlatFollower,
        word: Word {
            name: JointKind::FlatFollower.word(),
            category: Category::Joint,
            forms: &["flat_follower(k, a)"],
            letters: "k a curve or circle and a an axis",
            meaning: "a curve touches a straight face",
            more: "`Φ = [v_j^⊥ᵀ(r_i + A_i k(u) − r_j^a), v_j^⊥ᵀ A_i k'(u)]`: the point is on the face, and so is the tangent.",
            example: Example::Whole(
                "\
ground {
    point O  = (0, 0)
    axis way = O along (0, 1)
}
body disc {
    point O = (0, 0)
    curve profile(u) = ((40 mm + 10 mm * cos(u)) * cos(u), (40 mm + 10 mm * cos(u)) * sin(u)) at 90 deg
}
body rod at (0, 40 mm, 0) {
    axis face = (0, 0) along (1, 0)
    axis way  = (0, 0) along (0, 1)
}
joint axle: revolute(ground.O, disc.O)
joint guide: translational(ground.way, rod.way)
joint contact: flat_follower(disc.profile, rod.face)
driver motor: rotation(axle) = 60 rpm * t",
            ),
        },
        takes: "a curve and an axis",
        equations: 2,
        coordinates: &[("u", "the argument of the curve at the contact")],
    },
];
